/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The sum g_i = sum_p V_p grad N_ip of a node is the integral of its function over the surface of
   the soil, times the normal: zero inside, and at the surface the area that belongs to the node.
   The volume at the node over this area gives the depth of the node below the surface
   (MPMNodeProfile). Of the nodes on a line through the surface, those within a node spacing
   represent it, with shares 1 - |depth|, whose sum is one; where a node lacks area, at the sides of
   a body, its share is smaller by as much.

   The place of a node is s = half a node spacing below the surface, where

     q = k (p(s) - p_s - rho_f g . (x(s) - x_s))/s

   is the flow from the pressure p_s at the surface, where it leaves the nodes: with it, a pressure
   that is linear up to the surface is a solution on nodes, too. To hold p = p_s at the surface
   itself, as heat does, would let the water of a whole cell out at once, and pressures would
   oscillate into soil through which water had no time to flow. Here, the permeability bounds the
   flow.

   With a k that changes with the depth, 1/k is its mean from the surface to s. Nodes have means of
   k over some node spacings, those of soil deeper than s. So a line through the means of the nodes,
   at the depths of the soil that they see, gives k at both ends of s, and between these it is
   linear.

   Each place belongs to the rank that owns its node; sums over ranks follow.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_surface.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "force.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

enum { VOLUME = 3, GRADIENT = 4 };    // reals of a record

static constexpr double INSET = 0.5;    // depth of places below the surface, in node spacings
// gaps between material and a face of the box, in node spacings, up to which they touch, and from
// which on they are apart
static constexpr double TOUCHES = 0.25, IS_APART = 0.5;
// gaps that may be noise of sums over points, and gaps from which on the soil ends there and not at
// the face
static constexpr double AT_FACE = 0.05, OFF_FACE = 0.1;
// limits of permeabilities on the line through those of nodes, relative to the least and the
// greatest of these: means of a permeability that changes within a cell hide its extremes
static constexpr double LOW = 0.25, HIGH = 2.0;
static constexpr double LEAK = 0.5;     // share of the flow of a step from rest, with inertia
static constexpr double FULL = 0.97;    // share of a cell; sums over points are not exact integrals
static constexpr double ENOUGH = 0.01;    // share of a cell at a node, for its whole weight
// share of the area at a node that its normals keep, unless surfaces face each other there
static constexpr double ONE_SIDED = 0.8;
static constexpr double MOSTLY = 0.5;    // share of a place that has water, for its whole area
// share of the area of a cell below which there is no surface, but an error of sums
static constexpr double NOISE = 0.1;

MPMPoreSurface::MPMPoreSurface(LAMMPS *lmp, MPMField &field, const Conditions &conditions,
                               const MPMPoreWater &water, const double *gravity) :
    Pointers(lmp),
    field(field), conditions(conditions), water(water), gravity(gravity)
{
}

bool MPMPoreSurface::any() const
{
  return std::any_of(conditions.begin(), conditions.end(), [](const auto &c) {
    return c.kind != MPMPoreCondition::CLOSED;
  });
}

void MPMPoreSurface::init(bool soil_dries, bool permeability_varies)
{
  dries = soil_dries;
  varies = permeability_varies;
  profile = std::make_unique<MPMNodeProfile>(field);
}

void MPMPoreSurface::extend_topology()
{
  if (any()) activate_blocks_around(field);
}

/** Finds blocks that are not full of material, and those next to them. The part of a block on one
 *  rank is not enough to decide: if one of the ranks that share it finds it near, all must add
 *  their points. */
void MPMPoreSurface::find_blocks_near()
{
  const auto &blocks = field.grid.blocks;
  std::vector<double> filled(blocks.size(), 0.0);
  double buffer[BATCH];
  each_point_batch(field, [&](const auto &run, int first, int n) {
    const double *const J = field.jacobians.get(field, first, n, buffer);
    for (int p = 0; p < n; p++) filled[run.slot] += field.atom->vfrac[first + p] * J[p];
  });
  const double full = NODES_PER_BLOCK * field.lattice.cell_volume();
  near.assign(blocks.size(), 0);
  for (std::size_t ib = 0; ib < blocks.size(); ib++)
    near[ib] = std::any_of(blocks[ib].slot, blocks[ib].slot + 27, [&](int slot) {
      return slot >= 0 && filled[slot] < FULL * full;
    });
  if (comm->nprocs == 1) return;
  nodes.assign(blocks.size() * NODES_PER_BLOCK, 0.0);
  for (std::size_t ib = 0; ib < blocks.size(); ib++)
    for (int n = 0; near[ib] && n < NODES_PER_BLOCK; n++)
      if (!(blocks[ib].alias >> n & 1)) nodes[ib * NODES_PER_BLOCK + n] = 1.0;
  field.nodes.sum(nodes.data(), 1, 0, 1);
  field.nodes.complete(nodes.data(), 1, 1);
  for (std::size_t ib = 0; ib < blocks.size(); ib++) {
    const double *const flag = nodes.data() + ib * NODES_PER_BLOCK;
    near[ib] = std::any_of(flag, flag + NODES_PER_BLOCK, [](double f) {
      return f > 0.0;
    });
  }
}

bool MPMPoreSurface::is_near(int slot) const
{
  const int *const around = field.grid.blocks[slot].slot;
  return std::any_of(around, around + 27, [&](int other) {
    return other >= 0 && near[other];
  });
}

/** Maps volumes of nodes, and minus the force of the stress -I, with the gradients of the
 *  functions: the replacements of moving least squares would see a surface elsewhere. */
void MPMPoreSurface::map_volume()
{
  const auto &pic = field.pic;
  auto &work = field.work;
  const std::size_t nmax = field.atom->nmax;
  clear_points(work.vectors, field.atom, 3);
  work.weights.resize(std::max(work.weights.size(), nmax));
  work.stress.resize(6 * nmax);
  PointRows rows = field.rows_at_rest(work.vectors.data(), work.weights.data());
  rows.tau = work.stress.data();
  // read, and multiplied by zero: the means that steps of every K store here do not exist before
  // the first such step
  rows.f = &field.atom->f[0][0];
  TransferStep step = field.step_data(1.0);
  step.force_scale = 0.0;
  step.stress_scale = 1.0;
  points_to(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    if (!is_near(run.slot)) return;
    for (int i = run.first; i < run.last; i++) {
      const double J = field.points->jacobian(i);
      work.weights[i] = J * field.atom->vfrac[i];
      for (int c = 0; c < 6; c++) rows.tau[6 * (std::size_t) i + c] = c < 3 ? -J : 0.0;
    }
    pic.p2g(rows, step, run.first, run.last, base, field.map->tile, box);
  });
  field.nodes.sum(nodes.data(), pic.nreal, VOLUME, GRADIENT - VOLUME + field.lattice.dim);
  field.nodes.complete(nodes.data(), pic.nreal, pic.nreal);
}

/** Value of the function of a node at the surface, along the normal. */
double MPMPoreSurface::function(double depth) const
{
  constexpr double STEP = 1.0 / 128;
  return (profile->volume(depth + STEP) - profile->volume(depth - STEP)) / (2.0 * STEP);
}

double MPMPoreSurface::pressure_outside(const MPMPoreCondition &c, const double *x) const
{
  if (c.kind == MPMPoreCondition::SEEPAGE || c.kind == MPMPoreCondition::RAIN) return 0.0;
  if (c.kind != MPMPoreCondition::HEAD) return c.now;
  double size = 0.0, along = 0.0;
  for (int d = 0; d < 3; d++) {
    size += gravity[d] * gravity[d];
    along += gravity[d] * x[d];
  }
  const double p = water.density * force->nktv2p * (sqrt(size) * c.now + along);
  return std::max(0.0, p);    // above the water table there is air
}

/** Adds a place; at: on the surface, normal: out of the soil. */
void MPMPoreSurface::add_place(MPMStencil &stencil, int part, double area, double touch,
                               const double *at, const double *normal, double open)
{
  const auto &condition = conditions[part];
  Place place = {};
  place.part = part;
  place.area = area;
  place.outside = place.outside_at = pressure_outside(condition, at);
  place.touch = touch;
  place.open = open;
  std::copy_n(at, 3, place.at);
  std::copy_n(normal, 3, place.normal);
  place.most = std::numeric_limits<double>::max();
  if (condition.kind == MPMPoreCondition::RAIN) place.most = condition.now;
  const bool air = condition.kind == MPMPoreCondition::HEAD && dries && place.outside == 0.0;
  if (condition.kind == MPMPoreCondition::SEEPAGE || air) place.most = 0.0;
  double x[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < field.lattice.dim; d++) {
    const double step = -INSET * field.lattice.h * normal[d];
    x[d] = at[d] + step;
    place.outside += water.density * force->nktv2p * gravity[d] * step;
  }
  place.inside = add_nodes(stencil, x);
  place.top = add_nodes(stencil, at);
  if (place.inside.last > place.inside.first && place.top.last > place.top.first)
    places.push_back(place);
}

/** Open share of the free surface at a place next to bodies that close it. */
double MPMPoreSurface::open_part(const double *x) const
{
  if (!distance_to_seals) return 1.0;
  const double h = field.lattice.h, gap = distance_to_seals(x, IS_APART * h) / h;
  return std::clamp((gap - TOUCHES) / (IS_APART - TOUCHES), 0.0, 1.0);
}

void MPMPoreSurface::replace_by_outside(const double *x, double factor, double &p) const
{
  const auto &c = conditions[FREE];
  if (c.kind == MPMPoreCondition::CLOSED || c.kind == MPMPoreCondition::FLUX || distance_to_seals)
    return;
  p = factor * pressure_outside(c, x);
}

/** Adds the nodes that a position reaches; none, if some of them do not exist. */
MPMPoreSurface::Range MPMPoreSurface::add_nodes(MPMStencil &stencil, const double *x)
{
  const int first = (int) node.size();
  const bool there = stencil.visit_around(x, [&](int64_t number, double w, const double *) {
    node.push_back(number);
    weight.push_back(w);
  });
  return {first, there ? (int) node.size() : first};
}

/** Value at a position of what nodes have. */
double MPMPoreSurface::value(const Range &range, const std::vector<double> &of_nodes) const
{
  double sum = 0.0;
  for (int k = range.first; k < range.last; k++) sum += weight[k] * of_nodes[node[k]];
  return sum;
}

/** Spreads an amount at a position over its nodes: the transpose of value(). */
void MPMPoreSurface::spread(const Range &range, double amount, std::vector<double> &of_nodes,
                            int width, int component) const
{
  for (int k = range.first; k < range.last; k++)
    of_nodes[width * node[k] + component] += weight[k] * amount;
}

/** End of the material on the line of nodes through this one and a face of the box. sum_i x_i
 *  g_i/sum_i g_i is the place of a surface, and sum_i g_i its share of the area of the line. Both
 *  are exact for evenly spaced points, while those of one node have errors of up to 5 %. A gap that
 *  may be noise is 0. */
MPMPoreSurface::End MPMPoreSurface::end_at_face(const int *index, int face, double wall) const
{
  const auto &lattice = field.lattice;
  const int axis = face / 2;
  const double sign = face % 2 ? 1.0 : -1.0, far = profile->reach() + IS_APART;
  const double first = sign * (wall - lattice.origin[axis]) / lattice.h - sign * index[axis];
  const double side = lattice.cell_volume() / lattice.h;
  double area = 0.0, moment = 0.0;
  int at[3] = {index[0], index[1], index[2]};
  for (int k = (int) std::ceil(first - far); k <= (int) std::floor(first + far); k++) {
    at[axis] = index[axis] + (sign > 0.0 ? k : -k);
    const int64_t number = field.grid.locate(at);
    if (number < 0) continue;
    const double out =
        std::max(0.0, sign * nodes[number * field.pic.nreal + GRADIENT + axis] / side);
    area += out;
    moment += out * (first - k);
  }
  if (!(area > 0.0)) return {0.0, 0.0};
  const double gap = moment / area;
  return {gap * std::clamp((fabs(gap) - AT_FACE) / (OFF_FACE - AT_FACE), 0.0, 1.0),
          std::min(1.0, area)};
}

void MPMPoreSurface::find_places()
{
  places.clear();
  node.clear();
  weight.clear();
  find_blocks_near();
  map_volume();
  const auto &grid = field.grid;
  const auto &lattice = field.lattice;
  const int dim = lattice.dim;
  const double h = lattice.h, cell = lattice.cell_volume(), side = cell / h;
  MPMStencil stencil(field);
  if (by_area()) free_normals.assign(dim * grid.nnodes(), 0.0);
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    const auto &block = grid.blocks[ib];
    for (int n = 0; near[ib] && n < NODES_PER_BLOCK; n++) {
      if ((block.alias >> n & 1) || !(block.owned >> n & 1)) continue;
      const int64_t number = (int64_t) ib * NODES_PER_BLOCK + n;
      const double V = nodes[number * field.pic.nreal + VOLUME] / cell;
      if (!(V > 0.0)) continue;
      int index[3] = {0, 0, 0};
      grid.node_index(block, n, index);
      double x[3] = {0.0, 0.0, 0.0}, g[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < dim; d++) {
        x[d] = lattice.origin[d] + index[d] * h;
        g[d] = nodes[number * field.pic.nreal + GRADIENT + d] / side;
      }

      // the part of the surface at a face of the box is not free

      for (int face = 0; face < 2 * dim; face++) {
        const int axis = face / 2;
        if (domain->periodicity[axis]) continue;
        const double sign = face % 2 ? 1.0 : -1.0;
        const double wall = face % 2 ? domain->boxhi[axis] : domain->boxlo[axis];
        const double depth = sign * (wall - x[axis]) / h, out = sign * g[axis];
        if (fabs(depth) >= profile->reach() || !(out > 0.0)) continue;
        const double gap = depth - profile->depth(V / out);
        const double touch = std::min(1.0, (IS_APART - fabs(gap)) / (IS_APART - TOUCHES));
        if (!(touch > 0.0)) continue;
        g[axis] *= 1.0 - touch;
        if (conditions[face].kind == MPMPoreCondition::CLOSED) continue;
        const End end = end_at_face(index, face, wall);
        const double below = depth - end.gap;
        if (fabs(below) >= 1.0) continue;
        double at[3] = {x[0], x[1], x[2]}, normal[3] = {0.0, 0.0, 0.0};
        at[axis] = wall - sign * end.gap * h;
        normal[axis] = sign;
        // a flux is proportional to its area, that of the line; with pressures the resistance of
        // the soil decides, of which each node has its own part
        const bool is_flux = conditions[face].kind == MPMPoreCondition::FLUX;
        const double part = is_flux ? end.share : std::min(1.0, out / function(below));
        add_place(stencil, face, touch * part * (1.0 - fabs(below)) * side, touch, at, normal);
      }
      if (conditions[FREE].kind == MPMPoreCondition::CLOSED) continue;
      for (int d = 0; d < dim && by_area(); d++) free_normals[dim * number + d] = side * g[d];
      const double length = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
      if (length < NOISE) continue;
      const double depth = profile->depth(V / length);
      if (fabs(depth) >= 1.0) continue;
      double at[3] = {0.0, 0.0, 0.0}, normal[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < dim; d++) {
        normal[d] = g[d] / length;
        at[d] = x[d] + depth * h * normal[d];
      }
      const double open = open_part(at);
      if (!(open > 0.0 || by_area())) continue;
      const double part = std::min(1.0, length / function(depth));
      add_place(stencil, FREE, part * (1.0 - fabs(depth)) * side, 1.0, at, normal, open);
    }
  }
  if (by_area()) find_areas();
  for (auto &place : places) place.area *= place.open;
}

bool MPMPoreSurface::by_area() const
{
  const auto kind = conditions[FREE].kind;
  return kind == MPMPoreCondition::FLUX || kind == MPMPoreCondition::RAIN;
}

/** Area of the free surface at places with a given volume of water per area and time. It is the
 *  area of the nodes next to a place, which is the integral of their functions over the surface,
 *  relative to the area that the places give them so far. Where surfaces face each other, normals
 *  cancel at nodes between these, which then have less weight than others. */
void MPMPoreSurface::find_areas()
{
  const int dim = field.lattice.dim, width = 1 + dim;
  std::vector<double> sums(width * field.grid.nnodes(), 0.0);    // of areas, and times normals
  const auto visit = [&](const Place &place, const auto &f) {
    for (int k = place.top.first; k < place.top.last && place.part == FREE; k++)
      f(node[k], weight[k]);
  };
  for (const auto &place : places)
    visit(place, [&](int64_t i, double w) {
      sums[width * i] += place.area * w;
      for (int d = 0; d < dim; d++) sums[width * i + 1 + d] += place.area * w * place.normal[d];
    });
  field.nodes.sum(sums.data(), width, 0, width);
  field.nodes.complete(sums.data(), width, width);
  field.nodes.sum(free_normals.data(), dim, 0, dim);    // each rank has the normals of its nodes
  field.nodes.complete(free_normals.data(), dim, dim);
  for (auto &place : places) {
    double area = 0.0, known = 0.0;
    visit(place, [&](int64_t i, double w) {
      const double all = sums[width * i];
      double square = 0.0, has = 0.0;
      for (int d = 0; d < dim; d++) {
        const double along = sums[width * i + 1 + d];
        square += along * along;
        has += along * free_normals[dim * i + d];
      }
      if (!(square > 0.0)) return;
      area += w * std::max(0.0, has / std::sqrt(square)) / all;
      known += w * std::min(1.0, std::sqrt(square) / (ONE_SIDED * all));
    });
    if (known > 0.0) place.area *= area / known;
  }
}

/** Scales the weights to the sum one; enough: capacity from which on a node has its whole weight.
 *  Returns the sum before.
 *
 *  A point in the middle of a cell gives almost no capacity to a node that is out of reach of all
 *  others. Conduction bounds the stored C p^2 of a node, so p there may be as large as 1/sqrt(C):
 *  such nodes must not have their whole weight, neither for water nor for their pressure. */
double MPMPoreSurface::normalize(const Range &range, double enough,
                                 const std::vector<double> &capacity)
{
  double sum = 0.0;
  for (int k = range.first; k < range.last; k++) {
    const double C = capacity[node[k]];
    weight[k] *= C > 0.0 ? std::min(1.0, C / enough) : 0.0;
    sum += weight[k];
  }
  for (int k = range.first; k < range.last && sum > 0.0; k++) weight[k] /= sum;
  return sum;
}

double MPMPoreSurface::suction_outside(int part) const
{
  const auto &c = conditions[part];
  return c.kind == MPMPoreCondition::PRESSURE ? std::min(0.0, c.now) : 0.0;
}

/** Mean of the mobilities between the surface and a place, with the resistances of both in series.
 *  The mobility is linear in the depth, by the sums over points of capacity times mobility
 *  (conductance) and of capacity at its nodes. */
double MPMPoreSurface::mobility_to_surface(const Place &place,
                                           const std::vector<double> &conductance,
                                           const std::vector<double> &capacity) const
{
  constexpr double SPREAD = 1.0e-3;    // spread of depths that is too small for a slope
  constexpr double SAME = 1.0e-4;      // relative change of the mobility that counts as none
  const auto &grid = field.grid;
  const auto &lattice = field.lattice;
  double z = 0.0, zz = 0.0, mean = 0.0, zk = 0.0;
  double least = std::numeric_limits<double>::max(), most = 0.0;
  for (int j = place.inside.first; j < place.inside.last; j++) {
    if (!(weight[j] > 0.0)) continue;
    int index[3] = {0, 0, 0};
    grid.node_index(grid.blocks[node[j] / NODES_PER_BLOCK], node[j] % NODES_PER_BLOCK, index);
    double of_node = 0.0;
    for (int d = 0; d < lattice.dim; d++)
      of_node += place.normal[d] * ((place.at[d] - lattice.origin[d]) / lattice.h - index[d]);
    const double depth = profile->mean_depth(of_node), k = conductance[node[j]] / capacity[node[j]];
    z += weight[j] * depth;
    zz += weight[j] * depth * depth;
    mean += weight[j] * k;
    zk += weight[j] * depth * k;
    least = std::min(least, k);
    most = std::max(most, k);
  }
  const double variance = zz - z * z;
  if (!(variance > SPREAD && least > 0.0)) return mean;
  const double slope = (zk - z * mean) / variance;
  const double top = std::clamp(mean - slope * z, LOW * least, HIGH * most),
               inside = std::clamp(mean - slope * (z - INSET), LOW * least, HIGH * most);
  if (fabs(inside - top) < SAME * top) return 0.5 * (inside + top);
  return (inside - top) / log(inside / top);
}

/** With the weights a_k for the inflow of water and b_k for the pressure, the exchange is the
 *  matrix sum_k c_k a_k b_k^T, which is not symmetric. As conduction is added to it, its norm
 *  counts, not its eigenvalues. In the norm of the capacities it is at most the geometric mean of
 *  the norms of sum_k c_k a_k a_k^T and sum_k c_k b_k b_k^T, and these are at most their greatest
 *  sum of a row, (sum_k c_k a_ki)/C_i, as weights have the sum one. */
double MPMPoreSurface::prepare(const MPMNodeScalar &scalar, double least_storage, const Wet *wet)
{
  const double cell = field.lattice.cell_volume(), enough = ENOUGH * least_storage * cell;
  const auto &capacity = wet ? wet->capacity : scalar.capacity;
  const auto &conductance = wet ? wet->conductance[0] : scalar.volume;    // of full pores
  rows.assign(2 * scalar.capacity.size(), 0.0);
  for (auto &place : places) {
    bool has_water = false;
    for (int k = place.inside.first; k < place.inside.last; k++) {
      const double V = nodes[node[k] * field.pic.nreal + VOLUME];
      has_water = has_water || (V > ENOUGH * cell && capacity[node[k]] > 0.0);
    }
    // the surface may belong to another material, without water
    const double inside = normalize(place.inside, enough, capacity);
    const double at = normalize(place.top, enough, capacity);
    has_water = has_water && inside > 0.0 && at > 0.0;
    place.area *= has_water ? std::min(1.0, std::min(inside, at) / MOSTLY) : 0.0;
    const std::vector<double> *outer = nullptr;
    if (wet) outer = &wet->conductance[suction_outside(place.part) < 0.0 ? 1 + place.part : 0];
    double K = 0.0, K_in = 0.0, C = 0.0, full = 0.0;    // full pores, if it varies
    if (has_water) {
      K = value(place.inside, scalar.volume);
      C = value(place.inside, capacity);
      if (varies) full = value(place.inside, conductance);
    }
    for (int k = place.inside.first; k < place.inside.last && has_water; k++) {
      const double inner = scalar.volume[node[k]];
      K_in += weight[k] * (outer ? 0.5 * (inner + (*outer)[node[k]]) : inner);
    }
    double factor = C > 0.0 ? place.area / (C * INSET * field.lattice.h) : 0.0;
    if (full > 0.0 && C > 0.0)
      factor *= mobility_to_surface(place, conductance, capacity) * C / full;
    place.out = factor * K;
    place.in = factor * K_in;
    if (conditions[place.part].kind == MPMPoreCondition::FLUX) continue;
    const double most = std::max(place.in, place.out);
    spread(place.inside, most, rows, 2, 0);
    spread(place.top, most, rows, 2, 1);
  }
  field.nodes.sum(rows.data(), 2, 0, 2);
  double taken = 0.0, given = 0.0;
  for (std::size_t k = 0; k < scalar.capacity.size(); k++) {
    const double C = scalar.capacity[k];
    if (!(C > 0.0)) continue;
    taken = std::max(taken, rows[2 * k] / C);
    given = std::max(given, rows[2 * k + 1] / C);
  }
  return sqrt(taken * given);
}

/** The flow that a uniform gradient brings to a node by its sum over points, w . g_i, must go
 *  through the surface there: otherwise pressures of nodes beyond the surface grow until they stop
 *  the flow next to it. So each place takes from its nodes their g_i instead of the values of their
 *  functions, shared with other places by these. The pressure outside counts at the mean position
 *  of these nodes. */
void MPMPoreSurface::share_area(const MPMNodeScalar &scalar)
{
  const auto &grid = field.grid;
  const auto &lattice = field.lattice;
  const int nreal = field.pic.nreal;
  std::vector<double> all(grid.nnodes(), 0.0);
  const auto visit = [&](const auto &f) {
    for (auto &place : places) {
      if (!(place.area > 0.0)) continue;
      for (int k = place.top.first; k < place.top.last; k++)
        if (scalar.capacity[node[k]] > 0.0)
          f(place, k);
        else
          weight[k] = 0.0;
    }
  };
  visit([&](Place &place, int k) {
    all[node[k]] += place.area * weight[k];
  });
  field.nodes.sum(all.data(), 1, 0, 1);
  field.nodes.complete(all.data(), 1, 1);
  visit([&](Place &place, int k) {
    double out = 0.0;
    for (int d = 0; d < lattice.dim; d++)
      out += nodes[nreal * node[k] + GRADIENT + d] * place.normal[d];
    const double share = all[node[k]] > 0.0 ? place.area * weight[k] / all[node[k]] : 0.0;
    weight[k] = std::max(0.0, out) * place.touch * share;
  });
  for (auto &place : places) {
    if (!(place.area > 0.0)) continue;
    double area = 0.0;
    for (int k = place.top.first; k < place.top.last; k++) area += weight[k];
    // a flux keeps its area, unless its nodes lack it: the surface is then that of another material
    const bool is_flux = conditions[place.part].kind == MPMPoreCondition::FLUX;
    place.area = is_flux ? std::min(place.area, area / MOSTLY) : area;
    for (int k = place.top.first; k < place.top.last && area > 0.0; k++) {
      weight[k] /= area;
      int index[3] = {0, 0, 0};
      grid.node_index(grid.blocks[node[k] / NODES_PER_BLOCK], node[k] % NODES_PER_BLOCK, index);
      for (int d = 0; d < lattice.dim; d++)
        place.outside_at += weight[k] * water.density * force->nktv2p * gravity[d] *
            (lattice.origin[d] + index[d] * lattice.h - place.at[d]);
    }
  }
}

void MPMPoreSurface::find_push(const MPMNodeScalar &scalar, std::vector<double> &of_nodes) const
{
  const int nreal = field.pic.nreal;
  of_nodes.assign(nreal * field.grid.nnodes(), 0.0);
  for (const auto &place : places) {
    if (conditions[place.part].kind == MPMPoreCondition::FLUX) continue;
    const double ahead = place.area * (value(place.top, scalar.value) - place.outside_at);
    for (int k = place.top.first; k < place.top.last; k++) {
      const double V = nodes[nreal * node[k] + VOLUME];
      if (!(weight[k] > 0.0 && V > 0.0)) continue;
      // the gradient corresponds to a drop to the pressure outside
      for (int d = 0; d < 3; d++)
        of_nodes[nreal * node[k] + d] -= weight[k] * ahead / V * place.normal[d];
    }
  }
  field.nodes.sum(of_nodes.data(), nreal, 0, 3);
}

void MPMPoreSurface::take_flow(const std::vector<double> &of_nodes)
{
  const int nreal = field.pic.nreal;
  flow_is_given = true;
  for (auto &place : places) {
    double out = 0.0;
    for (int k = place.top.first; k < place.top.last; k++) {
      const double V = nodes[nreal * node[k] + VOLUME], *const q = &of_nodes[nreal * node[k]];
      if (!(weight[k] > 0.0 && V > 0.0)) continue;
      for (int d = 0; d < 3; d++) out += weight[k] * q[d] / V * place.normal[d];
    }
    place.inflow = -place.area * out;
  }
}

void MPMPoreSurface::add_rates(MPMNodeScalar &scalar, std::vector<double> &inflow)
{
  for (auto &place : places) {
    const auto &condition = conditions[place.part];
    double Q = place.area * condition.now;
    const double p = value(place.top, scalar.value);
    // where a pressure is given, water comes and goes with it, and the difference to p is
    // dissipated
    double behind = p;
    if (condition.kind != MPMPoreCondition::FLUX) {
      const double drop = place.outside - value(place.inside, scalar.value);
      const double driven = (drop > 0.0 ? place.in : place.out) * drop,
                   most = place.area * place.most;
      Q = flow_is_given ? place.inflow + LEAK * place.out * (place.outside_at - p)
                        : std::min(driven, most);
      place.slope = driven > most ? 0.0 : drop > 0.0 ? place.in : place.out;
      if (flow_is_given || driven <= most) behind = place.outside_at;
    }
    spread(place.top, Q, scalar.rate);
    inflow[place.part] += Q;
    inflow[ENERGY] += Q * behind;
  }
}

void MPMPoreSurface::add_changes(MPMNodeScalar &scalar) const
{
  for (const auto &place : places) {
    const double inside = value(place.inside, scalar.value);
    for (int k = place.top.first; k < place.top.last; k++)
      scalar.rate[node[k]] -= weight[k] * place.slope * inside;
  }
}

double MPMPoreSurface::memory_usage() const
{
  return places.capacity() * sizeof(Place) + node.capacity() * sizeof(int64_t) +
      (weight.capacity() + nodes.capacity() + rows.capacity() + free_normals.capacity()) *
      sizeof(double) +
      near.capacity();
}
