/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Heat q per area through a flat surface with the normal n is in equilibrium with a constant flux
   in the material if each node i gets q n.G_i, where G_i = sum_p V_p grad N_ip is the actual sum
   over the points. With these weights, a temperature that varies linearly stays as it is wherever
   points and nodes are, also at nodes that points hardly reach. At edges, G_i also has a part of
   the other surface, which n.G_i does not have if that surface is at a right angle. And

     sum_i n.G_i x_i/sum_i n.G_i

   along a line of nodes is the place at which the volume of the points ends. Because |G|^2 <= C_i
   sum_p V_p^2 |grad N|^2/(N C_p), the response to heat of the temperature of the surface, sum_i w_i
   T_i with w_i = n.G_i/sum n.G, is bounded, too.

   Where some points do not conduct, a node may have next to no capacity. |G|^2 then has the bound
   above with V_i = sum_p V_p N instead of C_i, and a factor min(1, 2 f), with the share f of V_i
   that conducts, makes w^2/C_i bounded again. The part of the weights that these factors leave is
   the share of the area through which heat goes.

   Linear functions have no such bound: a point just inside of a cell gives the node behind it a
   gradient, but next to no capacity. There the factor is min(1, 2 V_i/V), where V is the volume of
   a node with this surface, as at faces of the box (mpm_heat_faces.cpp). The place at which a
   temperature is taken is then wrong by a part of a cell.

   Bernstein polynomials have no such bound, either, and their nodes at the sides and in the middle
   of cells see a surface differently. The place, normal, and area of the surface are those of lines
   of quadratic B-splines on the same nodes, from sums over boxes, because points may be anywhere in
   a cell. Across such a line, nodes of the field have the integrals 4/3 and 2/3. The line gives its
   area to these, and the part that a line of the field gets has the weights of the functions where
   the surface crosses it, with the factor above.

   The area of a line is that of the whole line where the body fills all that is behind its surface,
   and less at the sides of the body and of the box. A surface that is inclined crosses lines of
   nodes along several axes. The lines along the axis a count with the share s_a = n_a^4/sum_b n_b^4
   of the area, each h^(d-1)/|n_a|.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_body.h"

#include "comm.h"
#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_node_sums.h"
#include "field/mpm_stencil.h"
#include "heat/mpm_conduction.h"
#include "math_extra.h"
#include "math_special.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using MathSpecial::square;

// least sum of weights of a line that has a surface, over that of a full line
static constexpr double LEAST = 0.01;
// share of the volume of a node that has to conduct for its full weight
static constexpr double ENOUGH = 0.5;
// length of the mean of unit normals from which on a surface is no
// edge: that of two normals that differ by 36 degrees
static constexpr double STRAIGHT = 0.95;
// node spacings before the end of functions in which the weight of a node goes to zero: next to an
// edge it has the gradient of the other surface, and where a place reaches as far on one side as on
// the other, round-off decides which of two nodes is the last one
static constexpr double END = 0.05;
// gaps up to which all heat goes through, and from which on none does, in node spacings
static constexpr double TOUCHES = 0.2, IS_APART = 0.4, MORE_WITH_LINEAR = 0.1;

MPMHeatBody::MPMHeatBody(LAMMPS *lmp, MPMField &field, MPMConduction *conduction) :
    Pointers(lmp), field(field), conduction(conduction), profile(field)
{
}

void MPMHeatBody::list_images()
{
  const Grid &grid = field.grid;
  images.clear();
  listed = true;
  if (std::none_of(grid.blocks.begin(), grid.blocks.end(), [](const Grid::Block &block) {
        return block.alias;
      }))
    return;
  const auto canonical = grid.canonical();
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(grid.blocks[slot].alias >> n & 1)) continue;
      const int of = (int) (canonical[slot * NODES_PER_BLOCK + n] / NODES_PER_BLOCK);
      const std::array<int, 2> image = {(int) slot, of};
      if (images.empty() || images.back() != image) images.push_back(image);
    }
}

void MPMHeatBody::begin_step()
{
  if (!listed) list_images();
  near.assign(field.grid.blocks.size(), 0);
}

void MPMHeatBody::find_surface()
{
  int any = std::count(near.begin(), near.end(), 1) > 0, all;
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  if (!all) {
    share.assign(field.grid.nnodes(), 0.0);
    gradient.assign(3 * field.grid.nnodes(), 0.0);
    if (spreads()) held = share;
    return;
  }
  for (const auto &[image, of] : images)
    if (near[of]) near[image] = 1;
  if (spreads()) {
    map_volume(field, near, held);
    map_boxes(field, {&field}, Weight::VOLUME, near, gradient, share);
  } else {
    map_surface(field, near, gradient);
    map_volume(field, near, share);
  }
  if (!field.options.axisymmetric) return;
  for (int64_t node = 0; node < field.grid.nnodes(); node++)
    for (int d = 0; d < field.lattice.dim; d++) gradient[3 * node + d] /= node_circle(node);
}

double MPMHeatBody::node_circle(int64_t node) const
{
  return field.frame->node_circle((int) (node / NODES_PER_BLOCK), (int) (node % NODES_PER_BLOCK));
}

/** Length of the circle around the axis of symmetry. Lines along this axis have that of their
 *  nodes, which next to the axis have a mean radius. */
double MPMHeatBody::circle(int axis, const int *index, double at) const
{
  if (!field.options.axisymmetric) return 1.0;
  const auto &lattice = field.lattice;
  const double r = lattice.origin[0] + (axis == 0 ? at : index[0]) * lattice.h;
  return field.frame->circle(std::max(r, axis == 0 ? 0.0 : 0.25 * lattice.h));
}

bool MPMHeatBody::make_line(int axis, const int *base, double at, const double *into,
                            Line &line) const
{
  const Grid &grid = field.grid;
  const auto &lattice = field.lattice;
  const double full_area = lattice.cell_volume() / lattice.h;
  int first, index[3] = {base[0], base[1], base[2]};
  double w[NodeLine::MOST], sum = 0.0, moment = 0.0;
  line.axis = axis;
  line.n = spreads() ? MPMStencil::quadratic(at, first, w)
                     : MPMStencil(field).weights(at, first, w);
  const double reach = 0.5 * line.n;
  for (int k = 0; k < line.n; k++) {
    index[axis] = lattice.wrap(axis, first + k);
    const int64_t node = line.node[k] = grid.locate(index);
    if (node < 0 && !knows_all()) return false;
    const double *const G = node < 0 ? nullptr : &gradient[3 * node];
    line.weight[k] = G ? std::max(0.0, -MathExtra::dot3(into, G)) : 0.0;
    line.weight[k] *= std::clamp((reach - std::fabs(first + k - at)) / END, 0.0, 1.0);
    sum += line.weight[k];
    moment += line.weight[k] * (first + k);
  }
  if (!(sum > LEAST * full_area)) return false;
  line.place = moment / sum;
  double there = 0.0, full = 0.0, full_at = 0.0;
  for (int k = 0; k < line.n; k++) {
    line.weight[k] /= sum;
    if (line.node[k] >= 0) there += w[k] * share[line.node[k]];
    full += w[k] * profile.volume((first + k - line.place) * into[axis]);
    full_at += w[k] * profile.volume((first + k - at) * into[axis]);
  }
  const bool linear = field.options.shape == LINEAR;
  const double part = there / (linear ? std::min(full, full_at) : full);
  line.part = std::min(1.0, part);
  line.area = full_area * circle(axis, base, at) * std::min(1.0, heat_area_share(part));
  return !linear || weigh_by_functions(first, at, part, into[axis], w, line);
}

/** Weights w of the functions at the surface. The weight of a node is reduced in proportion to its
 *  volume if this is less than half of what it is where material fills this part of the line. */
bool MPMHeatBody::weigh_by_functions(int first, double at, double part, double into,
                                     const double *w, Line &line) const
{
  double sum = 0.0;
  for (int k = 0; k < line.n; k++) {
    line.weight[k] = 0.0;
    if (line.node[k] < 0 || !(share[line.node[k]] > 0.0)) continue;
    const double whole = std::min(1.0, part) * profile.volume((first + k - at) * into);
    line.weight[k] = w[k] * std::min(1.0, share[line.node[k]] / (ENOUGH * whole));
    sum += line.weight[k];
  }
  for (int k = 0; k < line.n; k++) line.weight[k] /= sum;
  return sum > LEAST;
}

static double width(int index)
{
  return index % 2 ? 2.0 / 3.0 : 4.0 / 3.0;
}

/** Integral of the polynomial of a node from outside up to this depth, all in node spacings. */
static double volume_at_depth(int index, double depth)
{
  if (index % 2) {
    const double x = std::clamp(depth, -1.0, 1.0);
    return (1.0 + x) * (1.0 + x) * (2.0 - x) / 6.0;
  }
  const double rest = std::max(0.0, 1.0 - 0.5 * std::fabs(depth)),
               tail = 2.0 / 3.0 * rest * rest * rest;
  return depth < 0.0 ? tail : width(index) - tail;
}

bool MPMHeatBody::spread(const int *base, double at, const double *into, const Line &whole,
                         std::vector<Part> &parts) const
{
  static constexpr double BESIDE = 1.0 / 6.0, FARTHEST = 2.0;
  const auto &lattice = field.lattice;
  const int dim = lattice.dim, axis = whole.axis, side[2] = {(axis + 1) % dim, (axis + 2) % dim};
  const MPMStencil stencil(field);
  double all = 0.0;
  parts.clear();
  for (int n = 0; n < (dim == 3 ? 9 : 3); n++) {
    int index[3] = {base[0], base[1], base[2]};
    double fraction = 1.0, across = 1.0, shift = 0.0;
    for (int k = 0; k < dim - 1; k++) {
      const int d = side[k], step = (k ? n / 3 : n % 3) - 1;
      if (base[d] % 2)
        fraction *= step ? BESIDE : 1.0 - 2.0 * BESIDE;
      else if (step)
        fraction = 0.0;
      across *= width(base[d] + step);
      shift -= step * into[d] / into[axis];
      index[d] = lattice.wrap(d, base[d] + step);
    }
    if (fraction == 0.0) continue;
    const double place = at + std::clamp(shift, -FARTHEST, FARTHEST);
    Part part = {whole, fraction, fraction / across};
    Line &line = part.line;
    int first;
    double sum = 0.0;
    line.n = stencil.weights(place, first, line.weight);
    for (int k = 0; k < line.n; k++) {
      index[axis] = lattice.wrap(axis, first + k);
      const int64_t node = line.node[k] = field.grid.locate(index);
      if (node < 0 && !knows_all()) return false;
      const double there = node < 0 ? 0.0 : held[node],
                   full = whole.part * across *
          volume_at_depth(first + k, (first + k - place) * into[axis]);
      line.weight[k] *= there > 0.0 ? std::min(1.0, there / (ENOUGH * full)) : 0.0;
      sum += line.weight[k];
    }
    if (!(sum > LEAST)) continue;
    for (int k = 0; k < line.n; k++) line.weight[k] /= sum;
    const double has = std::min(1.0, sum / ENOUGH);
    part.area *= has;
    part.share *= has;
    all += part.area;
    parts.push_back(part);
  }
  // shares of a line are not scaled: they bound its rate, with a sum over places of at most one
  for (auto &part : parts) part.area /= all;
  return !parts.empty();
}

double MPMHeatBody::touches(double gap) const
{
  const double more = field.options.shape == LINEAR ? MORE_WITH_LINEAR : 0.0;
  return std::clamp((IS_APART + more - gap) / (IS_APART - TOUCHES), 0.0, 1.0);
}

double MPMHeatBody::conducting(int64_t node) const
{
  if (!conduction->conducts_in_part()) return 1.0;
  const double all = volume_of(node) * field.lattice.cell_volume() * node_circle(node);
  return all > 0.0 ? std::min(1.0, conduction->node_volume()[node] / (ENOUGH * all)) : 0.0;
}

bool MPMHeatBody::find_response(Line &line) const
{
  line.response = line.conducting = 0.0;
  // round-off can leave a gradient at a node that has no capacity, next to a surface in its plane
  const auto &capacity = conduction->node_capacity();
  double awake = 0.0;
  bool idle = false;
  for (int k = 0; k < line.n; k++) {
    if (!(line.weight[k] > 0.0)) continue;
    if (!(capacity[line.node[k]] > 0.0) || conduction->is_idle(line.node[k])) {
      line.weight[k] = 0.0;
      idle = true;
    }
    awake += line.weight[k];
  }
  if (!(awake > LEAST)) return false;
  for (int k = 0; idle && k < line.n; k++) line.weight[k] /= awake;
  for (int k = 0; k < line.n; k++)
    if (line.weight[k] > 0.0) line.conducting += line.weight[k] *= conducting(line.node[k]);
  if (!(line.conducting > LEAST)) return false;
  for (int k = 0; k < line.n; k++) {
    line.weight[k] /= line.conducting;
    if (line.weight[k] > 0.0)
      line.response += square(line.weight[k]) / conduction->node_capacity()[line.node[k]];
  }
  return true;
}

/** Nodes without weight are left out: they may have no capacity, and are not in the system. */
void MPMHeatBody::Line::add_term(double stiffness, const MPMDiffusion::Term &use) const
{
  if (!(stiffness > 0.0)) return;
  int64_t nodes[NodeLine::MOST];
  double weights[NodeLine::MOST];
  int count = 0;
  for (int k = 0; k < n; k++)
    if (weight[k] > 0.0) {
      nodes[count] = node[k];
      weights[count++] = weight[k];
    }
  use(count, nodes, 1, weights, &stiffness);
}

double MPMHeatBody::temperature(const Line &line) const
{
  return line.value(conduction->temperature.data());
}

double MPMHeatBody::drift(const Line &line) const
{
  return line.value(conduction->rate.data());
}

void MPMHeatBody::note(const Line &line, const double *into, double part)
{
  for (int k = 0; k < line.n; k++) {
    if (!(line.weight[k] > 0.0)) continue;
    double *const at = &noted[NOTED * line.node[k]];
    for (int d = 0; d < 3; d++) at[NORMAL + d] += part * line.weight[k] * into[d];
    at[PARTS] += part * line.weight[k];
    at[OF_SURFACES] += part * line.weight[k];
  }
}

void MPMHeatBody::note_face(int64_t node, int axis, double weight)
{
  noted[NOTED * node + NORMAL + axis] += weight;
  noted[NOTED * node + PARTS] += std::fabs(weight);
}

bool MPMHeatBody::is_edge(int64_t node, double weight) const
{
  if (!(weight > ROUND_OFF)) return false;
  const double *const at = &noted[NOTED * node];
  return at[OF_SURFACES] > 0.0 && MathExtra::len3(at + NORMAL) < STRAIGHT * at[PARTS];
}

bool MPMHeatBody::is_edge(const Line &line) const
{
  for (int k = 0; k < line.n; k++)
    if (is_edge(line.node[k], line.weight[k])) return true;
  return false;
}

void MPMHeatBody::end_stage()
{
  field.nodes.sum(heat.data(), 1, 0, 1);
  const auto &C = conduction->node_capacity();
  auto &rate = conduction->rate;
  for (std::size_t k = 0; k < rate.size(); k++)
    if (C[k] > 0.0) rate[k] += heat[k] / C[k];
}

double MPMHeatBody::fraction_in_box(int axis, int index) const
{
  constexpr int FIXED = 1;
  const auto &lattice = field.lattice;
  double part = 1.0;
  for (int side = 0; side < 2; side++) {
    if (domain->boundary[axis][side] != FIXED) continue;
    const double x = side ? domain->boxhi[axis] : domain->boxlo[axis];
    const double depth = index - (x - lattice.origin[axis]) / lattice.h;
    part -= 1.0 - profile.volume(side ? -depth : depth);
  }
  return std::max(part, 0.0);
}

bool MPMHeatBody::knows_all() const
{
  return comm->nprocs == 1;
}

double MPMHeatBody::memory_usage() const
{
  return (share.capacity() + gradient.capacity() + held.capacity() + heat.capacity()) *
      sizeof(double);
}

double LAMMPS_NS::heat_area_share(double part)
{
  static constexpr double FULL = 0.95, NOT_FULL = 0.8;
  if (part < NOT_FULL) return part;
  return NOT_FULL + (part - NOT_FULL) * (1.0 - NOT_FULL) / (FULL - NOT_FULL);
}

double LAMMPS_NS::heat_share_of_axis(const double *normal, int dim, int axis)
{
  constexpr double GRAZES = 0.1;
  if (std::fabs(normal[axis]) < GRAZES) return 0.0;
  double all = 0.0;
  for (int d = 0; d < dim; d++)
    if (std::fabs(normal[d]) >= GRAZES) all += square(square(normal[d]));
  return square(square(normal[axis])) / all;
}

/* ----------------------------------------------------------------------
   A node whose function reaches both surfaces of a body gets parts of V grad N of both, which
   cancel: what is left belongs to a smaller area. That happens where the body is thinner than the
   functions are wide, 3 node spacings for quadratic functions and 4 for cubic ones. It is found by
   looking that deep along the normal: in a thin body, there is no material just behind this depth.
   At edges and corners there is, as far as they are not sharper than a right angle. The area of the
   lines would not show the difference, because it is small at edges, too.
------------------------------------------------------------------------- */

static constexpr int LOOK_EVERY = 50;    // steps
// node spacings behind the width of the functions at which material is looked for
static constexpr double BEHIND = 0.3;
// greatest filled share of the volume of nodes at an empty place
static constexpr double EMPTY = 0.2;
static constexpr double KNOWN = 0.5;           // least share of the nodes there that are known
static constexpr double LEAST_IN_BOX = 0.1;    // least share of the nodes there that is in the box
// share of the area that is too thin: less would not change the sum by 3 %
static constexpr double MUCH = 0.05;

/** Is the place empty of material? 1: yes, 0: no, -1: unknown. Nothing is known where no points
 *  have been summed up; with one rank, nodes that have no block have no points. */
static int is_empty(const MPMHeatBody &body, const double *at)
{
  const auto &lattice = body.field.lattice;
  int first[3] = {0, 0, 0};
  for (int d = 0; d < lattice.dim; d++) first[d] = (int) std::floor(at[d]);
  double known = 0.0, share = 0.0, in_box = 0.0;
  for (int k = 0; k < (1 << lattice.dim); k++) {
    int index[3] = {0, 0, 0};
    double w = 1.0, inside = 1.0;
    for (int d = 0; d < lattice.dim; d++) {
      const int up = k >> d & 1;
      const double part = at[d] - first[d];
      w *= up ? part : 1.0 - part;
      inside *= body.fraction_in_box(d, first[d] + up);
      index[d] = lattice.wrap(d, first[d] + up);
    }
    const int64_t node = body.field.grid.locate(index);
    if (node < 0 ? !body.knows_all() : !body.near[node / NODES_PER_BLOCK]) continue;
    known += w;
    in_box += w * inside;
    if (node >= 0) share += w * body.share[node];
  }
  if (known < KNOWN) return -1;
  // material at a face of the box goes on behind it
  return in_box > LEAST_IN_BOX && share < EMPTY * in_box;
}

bool MPMHeatThin::looks(int nentries)
{
  if (warned || steps++ % LOOK_EVERY) return false;
  areas.assign(nentries, {0.0, 0.0});
  notes.assign(nentries, {});
  return true;
}

void MPMHeatThin::take(int entry, const MPMHeatBody &body, const int *node, int axis, double part,
                       const double *into, double area)
{
  const auto &lattice = body.field.lattice;
  double at[3] = {(double) node[0], (double) node[1], (double) node[2]};
  at[axis] += part;
  const double deep = 2.0 * body.profile.reach() + BEHIND;
  double behind[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < lattice.dim; d++) behind[d] = at[d] + deep * into[d];
  const int empty = is_empty(body, behind);
  if (empty < 0) return;
  areas[entry][1] += area;
  if (!empty) return;
  areas[entry][0] += area;
  double x[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < lattice.dim; d++) x[d] = lattice.origin[d] + at[d] * lattice.h;
  notes[entry].take({0.0, x[0], x[1], x[2]});
}

bool MPMHeatThin::report(MPI_Comm world, Found &found)
{
  std::vector<std::array<double, 2>> all(areas.size());
  MPI_Allreduce(areas.data(), all.data(), 2 * (int) areas.size(), MPI_DOUBLE, MPI_SUM, world);
  for (std::size_t k = 0; k < all.size(); k++) {
    std::array<double, 4> first;
    if (!(all[k][0] > MUCH * all[k][1]) || !notes[k].report(world, first)) continue;
    found = {(int) k, {first[1], first[2], first[3]}};
    return warned = true;
  }
  return false;
}
