/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Points are sorted into cells of the size of those of the lattice, and pairs in cells next to each
 *  other are looked at. As soon as all points of two cells are of one piece, no pair of these is
 *  looked at again: inside of a body, few are. A rank has the points of other ranks in cells in
 *  reach of its own points, which are all that decide on pairs with one of these. */

#include "output/mpm_pieces.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "fracture/fix_mpm_fracture.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// reach of a point over its size: in arrays that are up to twice as long as wide, and in irregular
// ones, points next to each other are closer; a row that is missing is two sizes wide
static constexpr double REACH = 1.8;
// in node spacings: points that are this far apart hardly know of each other, however long they are
static constexpr int MOST = 2;
// cosine of the angle to the normal of a surface, up to which a direction leads out of the body
static constexpr double OUTWARD = 0.5;
// of squared distances that are alike in regular arrays
static constexpr double ROUNDING = 1.0e-6;
// norm of C - 1 of points that are hardly deformed, and bounds of their stretches
static constexpr double SMALL = 0.04, SMALL_STRETCH[2] = {0.979, 1.02};
static constexpr double FARTHEST = 4.0e6;    // cell with a number
static constexpr int TAG = 4713;

MPMPieces::MPMPieces(LAMMPS *lmp) :
    Pointers(lmp), dim(domain->dimension), grid({dim, 1.0, {}, {}, {}}), halo(lmp)
{
}

void MPMPieces::find(const std::vector<MPMField *> &body, const FixMPMFracture *of_surfaces,
                     int groupbit, double separable, double *piece)
{
  fracture = of_surfaces;
  grid.clear();
  grid.lattice = body.front()->lattice;    // the coarsest one
  for (int d = 0; d < dim; d++)
    period[d] = grid.lattice.periodic[d] ? grid.lattice.ncell[d] * grid.lattice.h : INFINITY;
  collect(body, groupbit, separable);
  find_cells();
  sort();
  if (comm->nprocs > 1) {
    exchange();
    sort();
  }
  mark_cells();
  find_offsets();

  sets.begin(points.size());
  left = (int) std::count_if(points.begin(), points.end(), [](const Point &p) {
    return !p.damaged;
  });
  for (const int cell : filled) join_inside(cell);
  for (const bool faces : {true, false})    // after faces, there is little left to do
    for (const int cell : filled) {
      if (left <= 1) break;
      int index[3];
      grid.node_index(cell, index);
      const auto &block = grid.blocks[cell / NODES_PER_BLOCK];
      for (const auto &o : offsets) {
        if (o.is_face != faces || o.level > range[cell]) continue;
        const int at[3] = {index[0] + o.cells[0], index[1] + o.cells[1], index[2] + o.cells[2]};
        int64_t next = grid.locate_near(block, at);
        if (next < 0) continue;
        if (!canonical.empty()) next = canonical[next];
        // the cell over there does it, if it reaches this one
        if (!o.is_positive && range[next] >= o.level) continue;
        join_cells(cell, (int) next);
      }
    }

  find_labels();
  for (std::size_t k = 0; k < points.size() && points[k].field; k++)
    if (!points[k].damaged) piece[points[k].source] = (double) label[sets.root((int) k)];
}

/** det(F)^(1/dim). */
static double mean_stretch(const double F[3][3], int dim)
{
  const double det = MathExtra::det3(F);
  return dim == 3 ? std::cbrt(det) : std::sqrt(det);
}

/** Bounds of the mean stretch, from below, and of the largest one, from above. Most points are
 *  hardly deformed and get them at little cost. */
static void stretches(const double F[3][3], int dim, double &mean, double &most)
{
  double trace = 0.0, square = 0.0;    // of C = F^T F, and of C^2
  for (int a = 0; a < dim; a++)
    for (int b = 0; b <= a; b++) {
      const double C = F[0][a] * F[0][b] + F[1][a] * F[1][b] + F[2][a] * F[2][b];
      if (a == b) trace += C;
      square += (a == b ? 1.0 : 2.0) * C * C;
    }
  if (square - 2.0 * trace + dim < SMALL * SMALL) {    // of C - 1
    mean = SMALL_STRETCH[0];
    most = SMALL_STRETCH[1];
    return;
  }
  const double middle = trace / dim;
  const double deviation = std::sqrt(std::max(0.0, square / dim - middle * middle));
  most = std::sqrt(middle + deviation * std::sqrt(dim - 1.0));
  mean = mean_stretch(F, dim);
}

/** The cell of a place, which becomes active. Most points are in that of the point before. Returns
 *  -1 if the place is not usable. */
int MPMPieces::find_cell(const double *x)
{
  const MPM_NS::Lattice &lattice = grid.lattice;
  int index[3];
  for (int d = 0; d < 3; d++) {
    const double t = (x[d] - lattice.origin[d]) * per_spacing;
    if (!(std::fabs(t) < FARTHEST)) return -1;
    index[d] = (int) t - (t < (int) t);    // round down
  }
  if (last.cell >= 0 && std::equal(index, index + 3, last.index)) return last.cell;
  std::copy_n(index, 3, last.index);
  int block[3] = {0, 0, 0};
  for (int d = 0; d < dim; d++) {
    index[d] = lattice.wrap(d, index[d]);
    block[d] = index[d] >> grid.shift_bits;
  }
  const int slot = grid.activate(block);
  if (3 * slot == (int) low.size()) {
    low.insert(low.end(), index, index + 3);
    high.insert(high.end(), index, index + 3);
  }
  for (int d = 0; d < dim; d++) {
    low[3 * slot + d] = std::min(low[3 * slot + d], index[d]);
    high[3 * slot + d] = std::max(high[3 * slot + d], index[d]);
  }
  last.cell = slot * NODES_PER_BLOCK + grid.number(index);
  return last.cell;
}

/** Lists the points of this rank. */
void MPMPieces::collect(const std::vector<MPMField *> &body, int groupbit, double separable)
{
  const double h = grid.lattice.h;
  points.clear();
  points.reserve(atom->nlocal);
  per_spacing = 1.0 / h;
  low.clear();
  high.clear();
  last.cell = -1;
  most_range = 1;
  for (auto *field : body) {
    field->find_materials();
    const int bits = groupbit | field->fix.groupbit;
    const MPMRows places = field->frame->places();
    const FixMPMMaterial *material = nullptr;
    int mask_of_material = 0;
    bool is_of_elements = false;
    double last_volume = 0.0, size = 0.0;
    for (int i = 0; i < atom->nlocal; i++) {
      const int mask = atom->mask[i];
      if ((mask & bits) != bits || !(atom->vfrac[i] > 0.0)) continue;
      if (mask != mask_of_material) {
        mask_of_material = mask;
        is_of_elements = field->is_element_node(i);
        material = field->material_of(i);
        if (material && material->damage < 0) material = nullptr;
      }
      if (is_of_elements) continue;
      const double *const x = places[i];
      Point p;
      p.x[0] = x[0];
      p.x[1] = x[1];
      p.x[2] = dim == 3 ? x[2] : 0.0;
      p.cell = find_cell(p.x);
      if (p.cell < 0) continue;
      p.field = field;
      p.source = i;
      p.damaged = material && material->history[i][material->damage] >= separable;
      const double volume = field->frame->section(i);
      if (volume != last_volume) size = dim == 3 ? std::cbrt(volume) : std::sqrt(volume);
      last_volume = volume;
      double F[3][3], mean, most;
      deformation_of(p, F);
      stretches(F, dim, mean, most);
      p.reach = REACH * size;
      p.far = std::min(MOST * h, p.reach * most);
      p.near = std::min(p.far, p.reach * mean);
      if (!p.damaged && p.far > h) most_range = MOST;
      points.push_back(p);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &most_range, 1, MPI_INT, MPI_MAX, world);
}

/** The cells that points of this rank reach. */
void MPMPieces::find_cells()
{
  for (std::size_t slot = 0; 3 * slot < low.size(); slot++) {
    int from[3] = {0, 0, 0}, to[3] = {0, 0, 0}, b[3] = {0, 0, 0}, block[3];
    for (int d = 0; d < dim; d++) {
      from[d] = low[3 * slot + d] - most_range;
      to[d] = high[3 * slot + d] + most_range;
      b[d] = grid.shift_bits;
    }
    for (block[0] = from[0] >> b[0]; block[0] <= to[0] >> b[0]; block[0]++)
      for (block[1] = from[1] >> b[1]; block[1] <= to[1] >> b[1]; block[1]++)
        for (block[2] = from[2] >> b[2]; block[2] <= to[2] >> b[2]; block[2]++) {
          auto &near = grid.blocks[grid.activate(block)];
          near.reached |= grid.nodes_between(near, from, to);
        }
  }
  grid.close_periodic();
  grid.finish();
  const bool *const periodic = grid.lattice.periodic;
  canonical.clear();
  if (std::count(periodic, periodic + dim, true)) canonical = grid.canonical();
}

/** Sorts points by cell, and in it by damage. */
void MPMPieces::sort()
{
  const auto key = [](const Point &p) {
    return 2 * p.cell + p.damaged;
  };
  first.assign(2 * grid.nnodes() + 1, 0);
  for (const auto &p : points) first[key(p) + 1]++;
  for (std::size_t k = 1; k < first.size(); k++) first[k] += first[k - 1];
  order.resize(points.size());
  auto &next = filled;    // room for this, before cells are marked
  next.assign(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < points.size(); k++) order[next[key(points[k])]++] = (int) k;
}

/** Sends lists to all sharers, and receives theirs, whose lengths must be right. */
template <class T>
void MPMPieces::swap(std::vector<std::vector<T>> &mine, std::vector<std::vector<T>> &theirs)
{
  const int n = halo.sharers();
  std::vector<MPI_Request> requests(2 * n);
  for (int k = 0; k < n; k++)
    MPI_Irecv(theirs[k].data(), (int) (theirs[k].size() * sizeof(T)), MPI_BYTE, halo.rank_of(k),
              TAG, world, &requests[k]);
  for (int k = 0; k < n; k++)
    MPI_Isend(mine[k].data(), (int) (mine[k].size() * sizeof(T)), MPI_BYTE, halo.rank_of(k), TAG,
              world, &requests[n + k]);
  MPI_Waitall(2 * n, requests.data(), MPI_STATUSES_IGNORE);
}

/** Gets the points of other ranks in cells that points of this rank reach. */
void MPMPieces::exchange()
{
  halo.setup(grid, [](const Grid::Block &) {
    return false;
  });
  const int n = halo.sharers();
  send.assign(n, {});
  sent.assign(n, {});
  others.assign(n, {});
  first_other.assign(n, 0);
  std::vector<std::vector<int>> count(n), their_count(n, std::vector<int>(1));
  for (int k = 0; k < n; k++) {
    const auto &cells = halo.shared_with(k);
    for (std::size_t place = 0; place < cells.size(); place++)
      for (int s = first[2 * cells[place]]; s < first[2 * cells[place] + 2]; s++) {
        Other o;
        o.point = points[order[s]];
        deformation_of(o.point, o.F);
        MathExtra::zero3(o.normal);
        if (fracture) fracture->find_normal(*o.point.field, o.point.source, o.normal);
        o.tag = atom->tag[o.point.source];
        o.place = (int) place;
        send[k].push_back(o);
        sent[k].push_back(order[s]);
      }
    count[k] = {(int) send[k].size()};
  }
  swap(count, their_count);
  for (int k = 0; k < n; k++) others[k].resize(their_count[k][0]);
  swap(send, others);
  for (int k = 0; k < n; k++) {
    first_other[k] = (int) points.size();
    for (auto &o : others[k]) {
      o.point.field = nullptr;
      o.point.source = (int) (&o - others[k].data());
      o.point.cell = halo.shared_with(k)[o.place];
      points.push_back(o.point);
    }
  }
}

const MPMPieces::Other &MPMPieces::other(const Point &p) const
{
  const int at = (int) (&p - points.data());
  const auto sharer = std::upper_bound(first_other.begin(), first_other.end(), at) - 1;
  return others[sharer - first_other.begin()][p.source];
}

/** Calls f(cell) for the cells within this distance of one, and this one. */
template <class F> void MPMPieces::each_cell_near(int cell, int distance, const F &f) const
{
  int index[3];
  grid.node_index(cell, index);
  const auto &block = grid.blocks[cell / NODES_PER_BLOCK];
  const int deep = dim == 3 ? distance : 0;
  for (int x = -distance; x <= distance; x++)
    for (int y = -distance; y <= distance; y++)
      for (int z = -deep; z <= deep; z++) {
        const int at[3] = {index[0] + x, index[1] + y, index[2] + z};
        const int64_t next = grid.locate_near(block, at);
        if (next >= 0) f((int) (canonical.empty() ? next : canonical[next]));
      }
}

/** Which cells have points, how far these reach, and which are close to damage. */
void MPMPieces::mark_cells()
{
  const auto ncell = (std::size_t) grid.nnodes();
  filled.clear();
  range.assign(ncell, 1);
  whole.assign(ncell, 0);
  near_damage.clear();
  for (int cell = 0; cell < (int) ncell; cell++) {
    const int begin = first[2 * cell], damaged = first[2 * cell + 1], end = first[2 * cell + 2];
    if (begin < damaged) filled.push_back(cell);
    for (int s = begin; s < damaged; s++)
      if (points[order[s]].far > grid.lattice.h) range[cell] = MOST;
    if (damaged == end) continue;
    near_damage.resize(ncell, 0);
    each_cell_near(cell, most_range, [this](int next) {
      near_damage[next] = 1;
    });
  }
}

/** Half of the cells next to a cell; of those that are farther away, all. */
void MPMPieces::find_offsets()
{
  offsets.clear();
  const int deep = dim == 3 ? most_range : 0;
  for (int x = -most_range; x <= most_range; x++)
    for (int y = -most_range; y <= most_range; y++)
      for (int z = -deep; z <= deep; z++) {
        const int level = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const bool is_positive = x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
        if (level > 1 || (level == 1 && is_positive))
          offsets.push_back({{x, y, z}, level, x * x + y * y + z * z == 1, is_positive});
      }
}

/** Joins the points of a cell. */
void MPMPieces::join_inside(int cell)
{
  const int *const list = &order[first[2 * cell]], n = first[2 * cell + 1] - first[2 * cell];
  int parts = n;
  for (int b = 1; b < n; b++)    // the last parts are those from b on
    for (int a = b - 1; a >= 0 && parts > n - b; a--)
      if (sets.root(list[a]) != sets.root(list[b]) &&
          are_joined(points[list[a]], points[list[b]])) {
        sets.join(list[a], list[b]);
        parts--;
      }
  left -= n - parts;
  whole[cell] = parts == 1;
}

void MPMPieces::join_cells(int one, int two)
{
  const int *const begin_a = order.data() + first[2 * one],
                   *const end_a = order.data() + first[2 * one + 1];
  const int *const begin_b = order.data() + first[2 * two],
                   *const end_b = order.data() + first[2 * two + 1];
  if (begin_b == end_b) return;
  const bool both = whole[one] && whole[two];
  if (both && sets.root(*begin_a) == sets.root(*begin_b)) return;
  for (const int *a = end_a - 1; a >= begin_a; a--)    // in sorted arrays, those are close to b
    for (const int *b = begin_b; b < end_b; b++) {
      if (!both && sets.root(*a) == sets.root(*b)) continue;
      if (!are_joined(points[*a], points[*b])) continue;
      sets.join(*a, *b);
      left--;
      if (both) return;
    }
}

/** Sets the way from a to b, and returns its squared length. It is the same from b to a, bit by
 *  bit, as two ranks must decide alike. */
double MPMPieces::distance2(const Point &a, const Point &b, double *d) const
{
  for (int k = 0; k < 3; k++) {
    d[k] = b.x[k] - a.x[k];
    if (std::fabs(d[k]) > 0.5 * period[k]) d[k] -= std::copysign(period[k], d[k]);
  }
  return MathExtra::lensq3(d);
}

bool MPMPieces::are_joined(const Point &a, const Point &b) const
{
  double d[3];
  const double r2 = distance2(a, b, d), far = std::max(a.far, b.far);
  if (!(r2 < far * far) || (!a.field && !b.field)) return false;
  const double near = std::max(a.near, b.near);
  if (!(r2 < near * near) && !extends_to(a, d) && !extends_to(b, d)) return false;
  const double r = std::sqrt(r2), back[3] = {-d[0], -d[1], -d[2]};
  if (fracture && (is_behind(a, d, r) || is_behind(b, back, r))) return false;
  const bool is_mine = a.field;    // this rank knows all that is close to its own points
  if (near_damage.empty() || !near_damage[is_mine ? a.cell : b.cell]) return true;
  return !(is_mine ? has_damage_between(a, b, d, r) : has_damage_between(b, a, back, r));
}

void MPMPieces::deformation_of(const Point &p, double F[3][3]) const
{
  if (!p.field) {
    std::copy_n(&other(p).F[0][0], 9, &F[0][0]);
    return;
  }
  // from the start to the places of the lattice
  const auto &frame = *p.field->frame;
  const double *from = p.field->points->F[p.source];
  static const double unit[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  if (frame.is_total()) {
    const auto &R = static_cast<const MPMFrameTotal &>(frame).R;
    from = R ? R[p.source] : unit;
  }
  std::copy_n(from, 9, &F[0][0]);
  if (dim == 2) {
    F[0][2] = F[1][2] = F[2][0] = F[2][1] = 0.0;
    F[2][2] = 1.0;
  }
}

/** Does a point, as it is deformed, reach as far as d from it? */
bool MPMPieces::extends_to(const Point &p, const double *d) const
{
  double F[3][3], back[3][3], undeformed[3];
  deformation_of(p, F);
  MathExtra::invert3(F, back);
  MathExtra::matvec(back, d, undeformed);
  const double r2 = p.reach * p.reach, mean = mean_stretch(F, dim);
  return MathExtra::lensq3(undeformed) < r2 || MathExtra::lensq3(d) < r2 * mean * mean;
}

/** Is d, of length r, on the other side of a surface that this point is on? */
bool MPMPieces::is_behind(const Point &p, const double *d, double r) const
{
  double normal[3];
  if (p.field)
    fracture->find_normal(*p.field, p.source, normal);
  else
    MathExtra::copy3(other(p).normal, normal);
  return MathExtra::dot3(normal, d) > OUTWARD * r;
}

/** Is a damaged point closer to both than they are to each other? d: from a to b, of length r. */
bool MPMPieces::has_damage_between(const Point &a, const Point &b, const double *d, double r) const
{
  const double less = r * r * (1.0 - ROUNDING);
  int index[3], from[3], to[3], at[3];
  grid.node_index(a.cell, index);
  const auto &block = grid.blocks[a.cell / NODES_PER_BLOCK];
  for (int k = 0; k < 3; k++) {    // cells within this distance of both
    const double t = (a.x[k] - grid.lattice.origin[k]) * per_spacing, cell = std::floor(t);
    from[k] = index[k] + (int) (std::floor(t + (std::max(0.0, d[k]) - r) * per_spacing) - cell);
    to[k] = index[k] + (int) (std::floor(t + (std::min(0.0, d[k]) + r) * per_spacing) - cell);
  }
  if (dim == 2) from[2] = to[2] = 0;
  for (at[0] = from[0]; at[0] <= to[0]; at[0]++)
    for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
      for (at[2] = from[2]; at[2] <= to[2]; at[2]++) {
        int64_t cell = grid.locate_near(block, at);
        if (cell < 0) continue;
        if (!canonical.empty()) cell = canonical[cell];
        for (int s = first[2 * cell + 1]; s < first[2 * cell + 2]; s++) {
          double way[3];
          const Point &p = points[order[s]];
          if (distance2(a, p, way) < less && distance2(b, p, way) < less) return true;
        }
      }
  return false;
}

/** The smallest ID in each set, over all ranks: what a rank knows goes to its neighbors until
 *  nothing is new. */
void MPMPieces::find_labels()
{
  label.assign(points.size(), MAXTAGINT);
  for (std::size_t k = 0; k < points.size(); k++) {
    const tagint tag = points[k].field ? atom->tag[points[k].source] : other(points[k]).tag;
    tagint &least = label[sets.root((int) k)];
    least = std::min(least, tag);
  }
  if (comm->nprocs == 1) return;
  const int n = halo.sharers();
  std::vector<std::vector<tagint>> mine(n), theirs(n);
  for (int k = 0; k < n; k++) {
    mine[k].resize(sent[k].size());
    theirs[k].resize(others[k].size());
  }
  for (int is_new = 1; is_new;) {
    is_new = 0;
    for (int k = 0; k < n; k++)
      for (std::size_t m = 0; m < mine[k].size(); m++) mine[k][m] = label[sets.root(sent[k][m])];
    swap(mine, theirs);
    for (int k = 0; k < n; k++)
      for (std::size_t m = 0; m < theirs[k].size(); m++) {
        tagint &least = label[sets.root(first_other[k] + (int) m)];
        if (theirs[k][m] >= least) continue;
        least = theirs[k][m];
        is_new = 1;
      }
    MPI_Allreduce(MPI_IN_PLACE, &is_new, 1, MPI_INT, MPI_MAX, world);
  }
}

double MPMPieces::memory_usage() const
{
  double bytes = grid.memory_usage() + halo.memory_usage() +
      bytes_of(points, canonical, first, order, filled, range, near_damage, whole, label);
  bytes += sets.size() * sizeof(int);
  for (const auto &list : send) bytes += bytes_of(list);
  for (const auto &list : others) bytes += bytes_of(list);
  return bytes;
}
