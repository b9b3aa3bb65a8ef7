/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Which nodes are between two surfaces. The steps, each a sum over points at the nodes:

     seeds       points on surfaces whose vectors u converge: cov(u, r) < 0
     candidates  nodes that points next to seeds reach, with vectors of different directions
     sides       points by the sign of u along an axis of the node; both have surfaces, their mean
                 vectors are against each other, and each is where those of the other one point
     extension   nodes next to these, where a side has a corner or hardly reaches the node: points
                 are on the side that they have there
     normals     means over nodes nearby; those of contact, of the side that is more even */

#include "fracture/mpm_surface_gaps.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "base/mpm_points.h"
#include "field/mpm_halo.h"
#include "field/mpm_nodes.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "math_extra.h"

#include <Eigen/Dense>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// limits are no values that regular arrays of points have, where round-off would decide

// a gradient of s below this one, per node spacing, has no direction
static constexpr double FLAT = 0.02;
// strength of a normal that is known, as a gradient per node spacing; that from which on a vector
// decides on the side of a point as much as half a spacing of distance from the middle does
static constexpr double TYPICAL = 0.35, STEEP = 0.1;
// covariance of vectors and places below which vectors converge [node spacings]; that of vectors
// below which they have the same direction
static constexpr double CONVERGING = -0.0031, ALIKE = 1.0e-6;
// component of a vector along the axis of a node that it must have to count for a side
static constexpr double ALONG = 0.21;
// largest component along the mean vector of a point that is in front of the mean place by at least
// this distance [node spacings], and so on the other side
static constexpr double ASIDE = 0.51, IN_FRONT = 0.53;
// sides have surfaces where the volume of points on the surface is at least this share of that of
// the smaller side
static constexpr double SURFACE = 0.107;
// cosine of the angle between the mean vectors of two sides that are against each other; and of
// sides that have been apart, and between which there is nothing, as the squared distance of their
// places over the mean squared distances from these is at least this large. Both sides of a corner
// that goes into a body look like this, too
static constexpr double AGAINST = -0.51, AGAINST_IF_APART = 0.69, APART = 12.3;
static constexpr int ROUNDS = 2;    // of extension
// distance of split nodes along the direction out of a body from which on this is no end of their
// gap
static constexpr double OUTWARD = 0.27;
static constexpr double ROUNDING = 1.0e-9;    // of distances and vectors that may be zero
// what the mean of unit vectors of a side lacks to 1, up to which the side is even
static constexpr double UNEVEN = 0.001;
// sums of a side over its points, on the surface but for the volume: weight, opening, place, its
// square, vector
enum { COUNT, OPEN, PLACE, SQUARE = PLACE + 3, NORMAL, VOLUME = NORMAL + 3, WIDTH };

MPMSurfaceGaps::MPMSurfaceGaps(LAMMPS *lmp, MPMField &field) :
    Pointers(lmp), field(field), dim(field.lattice.dim)
{
}

double MPMSurfaceGaps::volume(int i) const
{
  return field.atom->vfrac[i] * field.points->jacobian(i);
}

void MPMSurfaceGaps::sum(std::vector<double> &of, int width) const
{
  field.nodes.sum(of.data(), width, 0, width);
  field.nodes.complete(of.data(), width, width);
}

/** Sums are made, and nodes looked at, in these blocks and those next to them within two blocks,
 *  and where values of other ranks come to; all, if there are periodic images. */
void MPMSurfaceGaps::look_at(std::vector<char> &near)
{
  const Grid &grid = field.grid;
  for (int round = 0; round < 2; round++) {
    const auto last = near;
    for (std::size_t slot = 0; slot < near.size(); slot++)
      if (last[slot])
        for (const int next : grid.blocks[slot].slot)
          if (next >= 0) near[next] = 1;
  }
  const auto &halo = *field.nodes.halo;
  for (int k = 0; k < halo.sharers(); k++)
    for (const int node : halo.shared_with(k)) near[node / NODES_PER_BLOCK] = 1;
  const bool *const periodic = field.lattice.periodic;
  const bool all = std::any_of(periodic, periodic + dim, [](bool is) {
    return is;
  });
  region.clear();
  for (std::size_t slot = 0; slot < near.size(); slot++)
    if (near[slot] || all) region.push_back((int) slot);
}

void MPMSurfaceGaps::clear(std::vector<double> &of, int width) const
{
  of.resize(std::max(of.size(), (std::size_t) width * field.grid.nnodes()));
  const std::size_t block = (std::size_t) width * NODES_PER_BLOCK;
  for (const int slot : region) std::fill_n(of.begin() + slot * block, block, 0.0);
}

/** Calls f(n) for all nodes that are looked at. */
template <class F> void MPMSurfaceGaps::each_node(const F &f) const
{
  for (const int slot : region)
    for (int n = 0; n < NODES_PER_BLOCK; n++) f((std::size_t) slot * NODES_PER_BLOCK + n);
}

namespace {
/** A node as a point sees it. r: from the node to the point [node spacings]. */
struct Near {
  int64_t number;
  double weight, r[3];
};
}    // namespace

/** Calls f(Near) for the nodes of point i, which is in the block: as MPMStencil::visit(), without
 *  gradients. */
template <class F>
static void visit_nodes(const MPMField &field, const Grid::Block &block, int i, const F &f)
{
  MPMStencil::Axes axes;
  MPMStencil(field).find_axes(block, i, axes);
  for (int k0 = 0; k0 < axes.count[0]; k0++)
    for (int k1 = 0; k1 < axes.count[1]; k1++)
      for (int k2 = 0; k2 < axes.count[2]; k2++)
        f(Near{axes.number(k0, k1, k2),
               axes.w[0][k0] * axes.w[1][k1] * axes.w[2][k2],
               {axes.r[0][k0], axes.r[1][k1], axes.r[2][k2]}});
}

/** Sets the unit vector of a point towards the gap, and returns its strength, as a gradient per
 *  node spacing; 0: it has none. */
double MPMSurfaceGaps::direction(int i, double *u) const
{
  const std::size_t at = 3 * (std::size_t) i;
  const bool known = !surface->normal.empty() && MathExtra::len3(&surface->normal[at]) > 0.0;
  if (!known && !has_gradients) return 0.0;
  const double *const from = known ? &surface->normal[at] : &gradient[at];
  const double length = MathExtra::len3(from);
  for (int d = 0; d < 3; d++) u[d] = length > 0.0 ? from[d] / length : 0.0;
  return known ? TYPICAL : length * field.lattice.h;
}

void MPMSurfaceGaps::find(const Surface &of_points)
{
  surface = &of_points;
  list.clear();
  on_surface.clear();
  int mine[2] = {0, 0}, any[2];    // points on surfaces; those without a normal
  each_point(field, [&](const MPMPointMap::Run &run, int i) {
    if (!is_on_surface(i)) return;
    on_surface.push_back({i, run.slot});
    mine[0] = 1;
    if (surface->normal.empty() || MathExtra::len3(&surface->normal[3 * (std::size_t) i]) == 0.0)
      mine[1] = 1;
  });
  MPI_Allreduce(mine, any, 2, MPI_INT, MPI_MAX, world);
  has_gradients = any[1];
  if (!any[0]) return;
  std::vector<char> near(field.grid.blocks.size(), 0);
  for (const auto &point : on_surface) near[point.slot] = 1;
  look_at(near);
  at.assign(field.grid.nnodes(), -1);
  if (has_gradients) find_gradients();
  if (!find_seeds()) return;
  find_sides(find_candidates());
  for (int round = 0; round < ROUNDS && extend(); round++) {}
  mark(at);
  smooth_normals();
  find_push();
}

/** Of points near surfaces, by the fast kernels. The nodes of s are its means by volume.
 *  Collective. */
void MPMSurfaceGaps::find_gradients()
{
  // blocks with points on surfaces, blocks that these reach, and blocks next to these
  std::vector<char> near(field.grid.blocks.size(), 0), reached(near.size(), 0);
  const auto &pic = field.pic;
  MPMPointMap &map = *field.map;
  auto &nodes = field.work.nodes;
  const auto nmax = (std::size_t) field.atom->nmax;
  auto &values = field.work.vectors, &weights = field.work.weights;
  values.assign(3 * nmax, 0.0);
  weights.assign(nmax, 0.0);
  const PointRows r = field.rows_at_rest(values.data(), weights.data());
  const TransferStep s = field.step_data(0.0);
  const auto to_nodes = [&] {
    each_point(field, [&](const MPMPointMap::Run &run, int i) {
      if (!near[run.slot]) return;
      values[3 * (std::size_t) i] = surface->value[i];
      weights[i] = volume(i);
    });
    points_to(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
      if (near[run.slot]) pic.p2g_momentum(r, s, run.first, run.last, base, map.tile, box);
    });
    field.nodes.sum(nodes.data(), pic.nreal, 0, 4);
    field.nodes.complete(nodes.data(), pic.nreal, 4);
  };

  for (const auto &point : on_surface) near[point.slot] = 1;
  to_nodes();
  for (int64_t n = 0; n < field.grid.nnodes(); n++)
    if (nodes[pic.nreal * n + 3] > 0.0) reached[n / NODES_PER_BLOCK] = 1;
  for (std::size_t b = 0; b < near.size(); b++) {
    const auto &block = field.grid.blocks[b];
    near[b] = std::any_of(block.slot, block.slot + 27, [&](int slot) {
      return slot >= 0 && reached[slot];
    });
  }
  to_nodes();
  for (int64_t n = 0; n < field.grid.nnodes(); n++) {
    double *const node = &nodes[pic.nreal * n];
    node[0] = node[3] > 0.0 ? node[0] / node[3] : 0.0;
  }

  gradient.assign(3 * nmax, 0.0);
  double L[9 * BATCH];
  points_from(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base) {
    if (!near[run.slot]) return;
    for (int i = run.first; i < run.last; i += BATCH) {
      const int n = std::min(BATCH, run.last - i);
      pic.g2p_gradient(r, s, i, i + n, base, map.tile_load, L);
      for (int k = 0; k < n; k++)
        for (int d = 0; d < dim; d++)
          gradient[3 * (std::size_t)(i + k) + d] = L[dim * dim * k + dim * d];
    }
  });
}

/** The first principal axis of a symmetric matrix xx yy zz xy xz yz. Where several are alike, as in
 *  regular arrays of points, small differences of the coordinate axes decide, and not round-off. */
static std::array<double, 3> principal_axis(const double *t)
{
  constexpr double SMALL = 1.0e-6, DIFFERENT[3] = {3.0, 2.0, 1.0};
  const double part = SMALL * (t[0] + t[1] + t[2]);
  Eigen::Matrix3d dyads;
  dyads << t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2];
  for (int d = 0; d < 3; d++) dyads(d, d) += part * DIFFERENT[d];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(dyads);
  const Eigen::Vector3d axis = principal.eigenvectors().col(2);
  // the sign is of no importance, but must be the same on all ranks
  const double large = axis.cwiseAbs().maxCoeff() - SMALL;
  int first = 0;
  while (std::fabs(axis[first]) < large) first++;
  const double sign = axis[first] < 0.0 ? -1.0 : 1.0;
  return {sign * axis[0], sign * axis[1], sign * axis[2]};
}

/** Marks the cells whose points may reach these nodes: all but those with -1. */
void MPMSurfaceGaps::mark(const std::vector<int> &which)
{
  const int below = -2, above = 1, deep = dim == 3;    // cells around a node
  close.assign(which.size(), 0);
  has_close.assign(field.grid.blocks.size(), 0);
  each_node([&](std::size_t n) {
    if (which[n] < 0) return;
    const auto &block = field.grid.blocks[n / NODES_PER_BLOCK];
    int index[3];
    field.grid.node_index((int64_t) n, index);
    for (int x = below; x <= above; x++)
      for (int y = below; y <= above; y++)
        for (int z = deep * below; z <= deep * above; z++) {
          const int cell[3] = {index[0] + x, index[1] + y, index[2] + z};
          const int64_t node = field.grid.locate_near(block, cell);
          if (node < 0) continue;
          close[node] = 1;
          has_close[node / NODES_PER_BLOCK] = 1;
        }
  });
}

/** Nodes where the vectors of points on surfaces converge. Returns whether any rank has one.
 *  Collective. */
bool MPMSurfaceGaps::find_seeds()
{
  // sums of vectors, places, their products, and weights
  enum { MEAN = 0, AT = 3, PRODUCT = 6, WEIGHT, ALL };
  clear(sums, ALL);
  for (const auto &point : on_surface) {
    double u[3];
    const double strength = direction(point.i, u);
    if (strength < FLAT) continue;
    const double V = volume(point.i) * strength;
    visit_nodes(field, field.grid.blocks[point.slot], point.i, [&](const Near &node) {
      double *const t = &sums[ALL * node.number];
      const double weight = V * node.weight;
      for (int d = 0; d < 3; d++) {
        t[MEAN + d] += weight * u[d];
        t[AT + d] += weight * node.r[d];
      }
      t[PRODUCT] += weight * MathExtra::dot3(u, node.r);
      t[WEIGHT] += weight;
    });
  }
  sum(sums, ALL);
  wanted.assign(field.grid.nnodes(), -1);
  std::vector<char> near(field.grid.blocks.size(), 0);
  int mine = 0, any;
  each_node([&](std::size_t n) {
    const double *const t = &sums[ALL * n];
    if (!(t[WEIGHT] > 0.0)) return;
    const double covariance =
        (t[PRODUCT] - MathExtra::dot3(t + MEAN, t + AT) / t[WEIGHT]) / t[WEIGHT];
    if (covariance < CONVERGING) wanted[n] = near[n / NODES_PER_BLOCK] = mine = 1;
  });
  look_at(near);
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any;
}

/** Nodes near seeds, with axes along which vectors may be against each other: the first principal
 *  axis of their covariance, which is the difference of both sides where each has many points, and
 *  their mean, which is that of one side where the other one has few; and their mean place.
 *  Collective. */
std::vector<MPMSurfaceGaps::Axes> MPMSurfaceGaps::find_candidates()
{
  std::vector<double> reached;
  clear(reached, 1);
  mark(wanted);
  each_point_near([&](const MPMPointMap::ActiveBlock &a, int, int i) {
    const auto &block = field.grid.blocks[a.slot];
    int64_t numbers[64];
    int n = 0;
    bool is_next = false;
    visit_nodes(field, block, i, [&](const Near &node) {
      numbers[n++] = node.number;
      is_next = is_next || wanted[node.number] >= 0;
    });
    if (is_next)
      for (int k = 0; k < n; k++) reached[numbers[k]] = 1.0;
  });
  sum(reached, 1);

  // sums of dyads, vectors and weights that count points of little weight, too; of vectors, places,
  // and weights
  enum { DYADS = 0, EVEN = 6, MEAN = 10, AT = 13, WEIGHT = 16, ALL };
  constexpr int OF[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  clear(sums, ALL);
  for (const auto &point : on_surface) {
    double u[3];
    const double strength = direction(point.i, u);
    if (strength < FLAT) continue;
    const double V = volume(point.i) * strength;
    visit_nodes(field, field.grid.blocks[point.slot], point.i, [&](const Near &node) {
      if (!(reached[node.number] > 0.0)) return;
      double *const t = &sums[ALL * node.number];
      const double weight = V * node.weight, even = V * std::sqrt(std::sqrt(node.weight));
      for (int k = 0; k < 6; k++) t[DYADS + k] += even * u[OF[k][0]] * u[OF[k][1]];
      for (int d = 0; d < 3; d++) {
        t[EVEN + d] += even * u[d];
        t[MEAN + d] += weight * u[d];
        t[AT + d] += weight * node.r[d];
      }
      t[EVEN + 3] += even;
      t[WEIGHT] += weight;
    });
  }
  sum(sums, ALL);
  std::vector<Axes> axes;
  wanted.assign(wanted.size(), -1);
  each_node([&](std::size_t n) {
    double *const t = &sums[ALL * n];
    if (!(t[WEIGHT] > 0.0)) return;
    for (int k = 0; k < 6; k++)
      t[DYADS + k] -= t[EVEN + OF[k][0]] * t[EVEN + OF[k][1]] / t[EVEN + 3];
    if (t[DYADS] + t[DYADS + 1] + t[DYADS + 2] < ALIKE * t[EVEN + 3]) return;
    wanted[n] = (int) axes.size();
    axes.push_back({principal_axis(t + DYADS)});
    const double length = MathExtra::len3(t + MEAN);
    for (int d = 0; d < 3; d++) {
      axes.back()[1][d] = length > 0.0 ? t[MEAN + d] / length : 0.0;
      axes.back()[2][d] = t[AT + d] / t[WEIGHT];
    }
  });
  mark(wanted);
  return axes;
}

/** Which candidates are split, with normals and middles. */
void MPMSurfaceGaps::find_sides(const std::vector<Axes> &axes)
{
  constexpr int NAXES = 2;
  clear(sums, 2 * WIDTH * NAXES);
  each_point_near([&](const MPMPointMap::ActiveBlock &a, int, int i) {
    double u[3];
    if (direction(i, u) < FLAT) return;
    const double V = volume(i);
    visit_nodes(field, field.grid.blocks[a.slot], i, [&](const Near &node) {
      const int k = wanted[node.number];
      if (k < 0) return;
      const double weight = V * node.weight;
      for (int axis = 0; axis < NAXES; axis++) {
        double along = MathExtra::dot3(u, axes[k][axis].data());
        if (axis == 1 && along < ASIDE) {
          double in_front = 0.0;
          for (int d = 0; d < dim; d++) in_front += (node.r[d] - axes[k][2][d]) * axes[k][1][d];
          if (in_front > IN_FRONT) along = -1.0;
        }
        if (!(std::fabs(along) > ALONG)) continue;
        double *const side =
            &sums[2 * WIDTH * (NAXES * node.number + axis) + (along > 0.0 ? 0 : WIDTH)];
        side[VOLUME] += weight;
        if (!is_on_surface(i)) continue;
        side[COUNT] += weight;
        side[OPEN] += weight * surface->opening[i];
        for (int d = 0; d < 3; d++) {
          side[PLACE + d] += weight * node.r[d];
          side[SQUARE] += weight * node.r[d] * node.r[d];
          side[NORMAL + d] += weight * u[d];
        }
      }
    });
  });
  sum(sums, 2 * WIDTH * NAXES);

  const auto look = [&](std::size_t n, const double *a) {
    const double *const b = a + WIDTH;
    Node node = {};
    if (!face_each_other(a, b, node) || !node.against) return false;
    const double la = MathExtra::len3(a + NORMAL), lb = MathExtra::len3(b + NORMAL);
    for (int d = 0; d < 3; d++) node.normal[d] = a[NORMAL + d] / la - b[NORMAL + d] / lb;
    MathExtra::norm3(node.normal);
    add((int64_t) n, node);
    return true;
  };
  each_node([&](std::size_t n) {
    if (wanted[n] < 0) return;
    const double *const axis = &sums[2 * WIDTH * NAXES * n];
    if (!look(n, axis)) look(n, axis + 2 * WIDTH);
  });
}

void MPMSurfaceGaps::add(int64_t n, Node &node)
{
  node.number = n;
  node.owned = field.grid.owns(n);
  at[n] = (int) list.size();
  list.push_back(node);
}

/** Do two sides, of which the sums are known, have surfaces that are towards each other? Sets the
 *  middle of the node, and whether their vectors are against each other. The two surfaces of a thin
 *  body are not one for each other. */
bool MPMSurfaceGaps::face_each_other(const double *a, const double *b, Node &node) const
{
  if (!(std::min(a[COUNT], b[COUNT]) > SURFACE * std::min(a[VOLUME], b[VOLUME]))) return false;
  const double la = MathExtra::len3(a + NORMAL), lb = MathExtra::len3(b + NORMAL);
  const double cosine = MathExtra::dot3(a + NORMAL, b + NORMAL) / (la * lb);
  double towards = 0.0, distance = 0.0, spread = a[SQUARE] / a[COUNT] + b[SQUARE] / b[COUNT];
  for (int d = 0; d < 3; d++) {
    const double xa = a[PLACE + d] / a[COUNT], xb = b[PLACE + d] / b[COUNT];
    node.middle[d] = 0.5 * (xa + xb);
    towards += (a[NORMAL + d] / la - b[NORMAL + d] / lb) * (xb - xa);
    distance += (xb - xa) * (xb - xa);
    spread -= xa * xa + xb * xb;
  }
  node.weight = std::min(a[COUNT], b[COUNT]);
  const double known = surface->apart;
  const bool apart = a[OPEN] > known * a[COUNT] && b[OPEN] > known * b[COUNT] &&
      distance > APART * std::max(spread, 0.0);
  node.against = cosine < (apart ? AGAINST_IF_APART : AGAINST);
  return towards > 0.0;
}

/** At the ends of a gap, sides have corners, whose vectors are not against each other, as on both
 *  sides of a corner that goes into a body; and a side may hardly reach a node. There, points are
 *  on the side that they have at nodes that are split, if the gap between the sides is towards
 *  these. Returns whether there are new ones on this rank or another. Collective. */
bool MPMSurfaceGaps::extend()
{
  enum { TOWARDS = 2 * WIDTH, FACING = TOWARDS + 3, ALL = FACING + 3 };
  int mine = !list.empty(), any;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (!any) return false;

  // of points next to split nodes: the normal away from their side, and the way to these nodes
  struct Facing {
    int i, slot;
    double normal[3], way[3];
  };
  std::vector<Facing> facing;
  each_point_near([&](const MPMPointMap::ActiveBlock &a, int, int i) {
    Facing f = {i, a.slot, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    double weights = 0.0;
    bool is_open = false;    // is there a node to decide on?
    visit_nodes(field, field.grid.blocks[a.slot], i, [&](const Near &node) {
      if (at[node.number] < 0) {
        is_open = is_open || wanted[node.number] >= 0;
        return;
      }
      const Node &split = list[at[node.number]];
      const double sign = side_of(split, i, node.r) == 0 ? 1.0 : -1.0;
      weights += node.weight;
      for (int d = 0; d < dim; d++) {
        f.normal[d] += node.weight * sign * split.normal[d];
        f.way[d] -= node.weight * node.r[d];
      }
    });
    if (!(is_open && weights > 0.0 && MathExtra::len3(f.normal) > 0.0)) return;
    MathExtra::norm3(f.normal);
    for (double &component : f.way) component /= weights;
    facing.push_back(f);
  });

  clear(sums, 6);
  const auto each = [&](const auto &use) {
    for (const auto &f : facing)
      visit_nodes(field, field.grid.blocks[f.slot], f.i, [&](const Near &node) {
        if (wanted[node.number] >= 0 && at[node.number] < 0)
          use(f, node, volume(f.i) * node.weight);
      });
  };
  each([&](const Facing &f, const Near &node, double weight) {
    double *const t = &sums[6 * node.number];
    for (int d = 0; d < 3; d++) t[d] += weight * f.normal[d] * f.normal[d];
    t[3] += weight * f.normal[0] * f.normal[1];
    t[4] += weight * f.normal[0] * f.normal[2];
    t[5] += weight * f.normal[1] * f.normal[2];
  });
  sum(sums, 6);
  std::vector<int> which(wanted.size(), -1);
  std::vector<std::array<double, 3>> axes;
  each_node([&](std::size_t n) {
    if (wanted[n] >= 0 && at[n] < 0 && sums[6 * n] + sums[6 * n + 1] + sums[6 * n + 2] > 0.0) {
      which[n] = (int) axes.size();
      axes.push_back(principal_axis(&sums[6 * n]));
    }
  });

  clear(sums, ALL);
  each([&](const Facing &f, const Near &node, double weight) {
    const double along = MathExtra::dot3(f.normal, axes[which[node.number]].data());
    const double sign = along > ROUNDING ? 1.0 : -1.0;
    double *const both = &sums[ALL * node.number],
                  *const side = along > ROUNDING ? both : both + WIDTH;
    double u[3];
    const double strength = direction(f.i, u);
    side[VOLUME] += weight;
    for (int d = 0; d < 3; d++) {
      both[TOWARDS + d] += weight * (f.way[d] + node.r[d]);
      both[FACING + d] += weight * sign * f.normal[d];
    }
    if (!(is_on_surface(f.i) && strength > 0.0)) return;
    side[COUNT] += weight;
    side[OPEN] += weight * surface->opening[f.i];
    for (int d = 0; d < 3; d++) {
      side[PLACE + d] += weight * node.r[d];
      side[SQUARE] += weight * node.r[d] * node.r[d];
      side[NORMAL + d] += weight * u[d];
    }
  });
  sum(sums, ALL);
  const std::size_t before = list.size();
  each_node([&](std::size_t n) {
    if (which[n] < 0) return;
    const double *const a = &sums[ALL * n], *const b = a + WIDTH;
    Node node = {};
    if (!face_each_other(a, b, node)) return;
    // out of the body, as both surfaces are on the average
    double out[3], along = 0.0;
    for (int d = 0; d < 3; d++)
      out[d] =
          a[NORMAL + d] / MathExtra::len3(a + NORMAL) + b[NORMAL + d] / MathExtra::len3(b + NORMAL);
    for (int d = 0; d < dim; d++) along += a[TOWARDS + d] / (a[VOLUME] + b[VOLUME]) * out[d];
    if (!node.against && along > OUTWARD * MathExtra::len3(out)) return;
    MathExtra::copy3(a + FACING, node.normal);
    MathExtra::norm3(node.normal);
    add((int64_t) n, node);
  });
  mine = list.size() > before;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any;
}

/** Normals are means over nodes nearby, by the surfaces that both sides have there: one side may
 *  hardly reach a node, or other surfaces of it may be near. Collective. */
void MPMSurfaceGaps::smooth_normals()
{
  clear(sums, 3);
  each_point_near([&](const MPMPointMap::ActiveBlock &a, int, int i) {
    if (!is_on_surface(i)) return;
    const auto &block = field.grid.blocks[a.slot];
    double normal[3] = {0.0, 0.0, 0.0};
    bool any = false;
    visit_nodes(field, block, i, [&](const Near &node) {
      if (at[node.number] < 0) return;
      const Node &split = list[at[node.number]];
      const double weight =
          node.weight * split.weight * (side_of(split, i, node.r) == 0 ? 1.0 : -1.0);
      for (int d = 0; d < dim; d++) normal[d] += weight * split.normal[d];
      any = true;
    });
    if (!any) return;
    visit_nodes(field, block, i, [&](const Near &node) {
      if (at[node.number] < 0) return;
      const double weight =
          volume(i) * node.weight * (side_of(list[at[node.number]], i, node.r) == 0 ? 1.0 : -1.0);
      for (int d = 0; d < dim; d++) sums[3 * node.number + d] += weight * normal[d];
    });
  });
  sum(sums, 3);
  for (auto &node : list) {
    double *const n = &sums[3 * node.number];
    const double length = MathExtra::len3(n);
    if (length > 0.0)
      for (int d = 0; d < 3; d++) node.normal[d] = n[d] / length;
  }
}

/** Normals of contact are those of the side that is more even: the other one may have an edge at
 *  the node, or the node may be so deep in it that it has other surfaces there. Collective. */
void MPMSurfaceGaps::find_push()
{
  enum { OF_SIDE = 4 };    // sum of unit vectors, and of weights
  clear(sums, 2 * OF_SIDE);
  each_point_near([&](const MPMPointMap::ActiveBlock &a, int, int i) {
    double u[3];
    if (!is_on_surface(i) || direction(i, u) < FLAT) return;
    visit_nodes(field, field.grid.blocks[a.slot], i, [&](const Near &node) {
      if (at[node.number] < 0) return;
      double *const side =
          &sums[OF_SIDE * (2 * node.number) + OF_SIDE * side_of(list[at[node.number]], i, node.r)];
      const double weight = volume(i) * node.weight;
      for (int d = 0; d < dim; d++) side[d] += weight * u[d];
      side[3] += weight;
    });
  });
  sum(sums, 2 * OF_SIDE);
  for (auto &node : list) {
    double normal[3] = {0.0, 0.0, 0.0};
    for (const int side : {0, 1}) {
      const double *const of = &sums[OF_SIDE * (2 * node.number + side)];
      const double length = MathExtra::len3(of);
      if (!(length > 0.0)) continue;
      const double weight = (side == 0 ? 1.0 : -1.0) / (1.0 - length / of[3] + UNEVEN);
      for (int d = 0; d < 3; d++) normal[d] += weight * of[d] / length;
    }
    const double length = MathExtra::len3(normal);
    for (int d = 0; d < 3; d++) node.push[d] = length > 0.0 ? normal[d] / length : node.normal[d];
  }
}

/** By its place, and by its vector where the place does not tell. */
int MPMSurfaceGaps::side_of(const Node &node, int i, const double *r) const
{
  double beyond = 0.0, u[3];
  for (int d = 0; d < dim; d++) beyond += 2.0 * (r[d] - node.middle[d]) * node.normal[d];
  const double strength = direction(i, u);
  if (strength > 0.0) beyond -= std::min(1.0, strength / STEEP) * MathExtra::dot3(u, node.normal);
  return beyond < ROUNDING ? 0 : 1;
}

double MPMSurfaceGaps::memory_usage() const
{
  return bytes_of(list, at, on_surface, gradient, region, wanted, close, has_close, sums);
}
