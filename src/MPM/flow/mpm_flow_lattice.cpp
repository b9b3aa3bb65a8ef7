/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_lattice.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_point_map.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double FARTHEST = 4.0e6;    // largest index that a block can have, see MPMField
// data is moved for the sake of the cache only: each move costs a third of a step
static constexpr int SORTS_PER_MOVE = 20;

MPMFlowLattice::MPMFlowLattice(LAMMPS *lmp, const MPM_NS::Lattice &of, int groupbit) :
    Pointers(lmp), grid(of), lattice(grid.lattice), groupbit(groupbit), halo(lmp)
{
}

/* ---------------------------------------------------------------------- */

void MPMFlowLattice::check_box(const char *style)
{
  if (domain->triclinic)
    error->all(FLERR, Error::NOLASTLINE, "Fix {} requires an orthogonal box", style);
  for (int d = 0; d < lattice.dim; d++) {
    const char axis = 'x' + d;
    if (domain->boundary[d][0] > 1 || domain->boundary[d][1] > 1)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix {} requires periodic or fixed boundaries (p or f), but axis {} is shrink-wrapped",
          style, axis);
    const double length = domain->prd[d], n = std::round(length / lattice.h);
    if (!(n >= 1.0) || std::fabs(n * lattice.h - length) > 1.0e-10 * length)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix {}: the length {} of the box along {} must be a multiple of the node spacing "
                 "{}, as faces of cells are walls or meet their periodic images: the nearest valid "
                 "spacing is {:.16g}",
                 style, length, axis, lattice.h, length / std::max(n, 1.0));
    if (!(n < FARTHEST))
      error->all(FLERR, Error::NOLASTLINE, "Fix {}: node spacing {} is too small for the box",
                 style, lattice.h);
    lattice.origin[d] = domain->boxlo[d];
    lattice.ncell[d] = (int) n;
    lattice.periodic[d] = domain->periodicity[d] != 0;
    for (auto &wall : walls[d]) wall.is = !lattice.periodic[d];
  }
}

bool MPMFlowLattice::is_point(int i) const
{
  return (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0;
}

void MPMFlowLattice::base_of(const double *x, int base[3]) const
{
  base[2] = 0;
  for (int d = 0; d < lattice.dim; d++) {
    const double t = (x[d] - lattice.origin[d]) / lattice.h - 0.5;
    if (!(std::fabs(t) < FARTHEST))
      error->one(FLERR, "A point of an incompressible flow is at the impossible place {} along {}",
                 x[d], (char) ('x' + d));
    base[d] = (int) std::floor(t);
  }
}
std::array<int, 3> MPMFlowLattice::block_of(const int base[3]) const
{
  return {base[0] >> grid.shift_bits, base[1] >> grid.shift_bits, base[2] >> grid.shift_bits};
}

/* ---------------------------------------------------------------------- */

void MPMFlowLattice::sort(bool move)
{
  std::map<std::array<int, 3>, int> blocks;    // ordered
  std::vector<int> key(atom->nlocal, -1);
  const int mask = grid.side - 1;
  std::array<int, 3> last = {INT_MAX, INT_MAX, INT_MAX};
  int index = 0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    int base[3];
    base_of(atom->x[i], base);
    const auto b = block_of(base);
    if (b != last) {
      index = blocks.emplace(b, (int) blocks.size()).first->second;
      last = b;
    }
    int cell = 0;
    for (int d = 0; d < lattice.dim; d++) cell = cell * grid.side + (base[d] & mask);
    key[i] = index * NODES_PER_BLOCK + cell;
  }
  std::vector<int> rank(blocks.size());
  int n = 0;
  for (const auto &block : blocks) rank[block.second] = n++;
  for (auto &k : key)
    if (k >= 0) k = rank[k / NODES_PER_BLOCK] * NODES_PER_BLOCK + k % NODES_PER_BLOCK;
  points = order_by_keys(lmp, key, n * NODES_PER_BLOCK);
  if (move || ++sorts == SORTS_PER_MOVE) {
    sorts = 0;
    put_in_order(lmp, points);
    std::iota(points.begin(), points.end(), 0);
  }
  points.erase(std::remove_if(points.begin(), points.end(),
                              [this](int i) {
                                return !is_point(i);
                              }),
               points.end());
  valid = false;
}

/* ----------------------------------------------------------------------
   Cells that points can reach are known to all ranks that share them. With one more layer around
   these, an owner has the neighbors of its cells.
------------------------------------------------------------------------- */

void MPMFlowLattice::find_cells()
{
  if (valid) return;
  grid.clear();
  runs.clear();
  ranges.clear();
  std::array<int, 3> last = {INT_MAX, INT_MAX, INT_MAX};
  for (int k = 0; k < (int) points.size(); k++) {
    int base[3];
    base_of(atom->x[points[k]], base);
    const auto b = block_of(base);
    if (b == last) {
      runs.back().last++;
    } else {
      const int slot = grid.activate(b.data());
      if (slot == (int) ranges.size())
        ranges.push_back({{base[0], base[1], base[2]}, {base[0], base[1], base[2]}});
      runs.push_back({k, k + 1, slot});
      last = b;
    }
    Range &r = ranges[runs.back().slot];
    for (int d = 0; d < 3; d++) {
      r.low[d] = std::min(r.low[d], base[d]);
      r.high[d] = std::max(r.high[d], base[d]);
    }
  }

  // ranks share what they reach and the layers around it; where there are periodic images, all of
  // their blocks

  std::vector<uint64_t> shared;
  constexpr int STENCIL = 2, LOWER = 1;    // of points that have a width
  const int margin_of_all = DRIFT + HALF + wants_more;
  const auto cover = [&](const Range &r, int margin, bool reached) {
    int low[3] = {0, 0, 0}, high[3] = {0, 0, 0}, b[3];
    for (int d = 0; d < lattice.dim; d++) {
      low[d] = r.low[d] - LOWER - margin;
      high[d] = r.high[d] + STENCIL + margin;
      if (lattice.periodic[d]) continue;
      low[d] = std::max(low[d], -1);
      high[d] = std::min(high[d], lattice.ncell[d] + 1);
    }
    const int bits = grid.shift_bits;
    for (b[0] = low[0] >> bits; b[0] <= high[0] >> bits; b[0]++)
      for (b[1] = low[1] >> bits; b[1] <= high[1] >> bits; b[1]++)
        for (b[2] = low[2] >> bits; b[2] <= high[2] >> bits; b[2]++) {
          const int slot = grid.activate(b);
          const uint64_t nodes = grid.nodes_between(grid.blocks[slot], low, high);
          shared.resize(std::max(shared.size(), (std::size_t) slot + 1), 0);
          shared[slot] |= nodes;
          if (reached) grid.blocks[slot].reached |= nodes;
        }
  };
  for (const auto &range : ranges) {
    cover(range, margin_of_all, true);
    cover(range, margin_of_all + overlap, false);
  }
  visitor_ranges.clear();
  for (const int i : visitors) {
    Range r;
    base_of(atom->x[i], r.low);
    std::copy_n(r.low, 3, r.high);
    visitor_ranges.push_back(r);
    cover(r, margin_of_all, true);
    cover(r, margin_of_all + overlap, false);
  }
  grid.close_periodic();
  grid.finish();
  shared.resize(grid.blocks.size(), 0);
  const bool *const periodic = lattice.periodic;
  if (std::any_of(periodic, periodic + lattice.dim, [](bool is) {
        return is;
      }))
    std::fill(shared.begin(), shared.end(), ~uint64_t(0));
  if (comm->nprocs > 1) comm->coord2proc_setup();
  halo.setup(grid, shared, [this](int number) {
    return rank_around(number);
  });
  borrowed.clear();
  for (int p = 0; p < halo.sharers(); p++)
    for (const int number : halo.shared_with(p))
      if (!grid.owns(number)) borrowed.push_back(number);
  list_cells();
  list_images();
  valid = true;
  nbuild++;
}

/** Rank whose part of the box has the middle of a cell: ranks then own about equally many of the
 *  cells that several reach. */
int MPMFlowLattice::rank_around(int number) const
{
  int index[3], unused[3];
  double x[3];
  grid.node_index(number, index);
  lattice.node_position(index, x);
  for (int d = 0; d < lattice.dim; d++) x[d] += 0.5 * lattice.h;
  return comm->coord2proc(x, unused[0], unused[1], unused[2]);
}

bool MPMFlowLattice::visitors_in_reach() const
{
  bool in = true;
  for (std::size_t k = 0; k < visitors.size(); k++) {
    int base[3];
    base_of(atom->x[visitors[k]], base);
    for (int d = 0; d < lattice.dim; d++)
      in = in && std::abs(base[d] - visitor_ranges[k].low[d]) <= DRIFT;
  }
  return in;
}

int MPMFlowLattice::find_block(const double *x, int base[3]) const
{
  base_of(x, base);
  const int64_t number = grid.locate(base);
  return number < 0 ? -1 : (int) (number / NODES_PER_BLOCK);
}

int MPMFlowLattice::canonical(const int index[3]) const
{
  int wrapped[3] = {0, 0, 0};
  for (int d = 0; d < lattice.dim; d++) wrapped[d] = lattice.wrap(d, index[d]);
  return (int) grid.locate(wrapped);
}

void MPMFlowLattice::list_cells()
{
  cells.clear();
  around.clear();
  const int dim = lattice.dim;
  for (int slot = 0; slot < (int) grid.blocks.size(); slot++) {
    const auto &block = grid.blocks[slot];
    for (uint64_t left = block.owned & block.reached; left; left &= left - 1) {
      Cell cell;
      const int n = __builtin_ctzll(left);
      cell.number = slot * NODES_PER_BLOCK + n;
      cell.walls = 0;
      grid.node_index(block, n, cell.index);
      bool inside = true;
      for (int d = 0; d < dim; d++) {
        if (lattice.periodic[d]) continue;
        inside = inside && cell.index[d] >= 0 && cell.index[d] < lattice.ncell[d];
        if (cell.index[d] == 0) cell.walls |= 1 << 2 * d;
        if (cell.index[d] == lattice.ncell[d] - 1) cell.walls |= 2 << 2 * d;
      }
      if (!inside) continue;
      for (int d = 0; d < dim; d++)
        for (int s = 0; s < 2; s++) {
          int other[3] = {cell.index[0], cell.index[1], cell.index[2]};
          other[d] += 2 * s - 1;
          cell.near[2 * d + s] = canonical(other);
        }
      cells.push_back(cell);
      if (!wants_around) continue;
      for (int a = -1; a <= 1; a++)
        for (int b = -1; b <= 1; b++)
          for (int c = dim == 3 ? -1 : 0; c <= (dim == 3 ? 1 : 0); c++) {
            const int other[3] = {cell.index[0] + a, cell.index[1] + b, cell.index[2] + c};
            around.push_back(canonical(other));
          }
    }
  }
}

/* ----------------------------------------------------------------------
   Images beyond several walls have the rules of all of these at once, so that no axis comes first.
   Behind a wall without slip the velocity along it is odd about that of the wall also for faces
   that are in or beyond another wall: a lid has its velocity up to the edge. Beyond two walls
   without slip, which may have different velocities, the velocity along both is the mean of the
   images of images in either order, and so that of the source.
------------------------------------------------------------------------- */

void MPMFlowLattice::list_images()
{
  images.clear();
  face_images.clear();
  path_images.clear();
  for (int slot = 0; slot < (int) grid.blocks.size(); slot++)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      int index[3];
      grid.node_index(grid.blocks[slot], n, index);
      bool is_near = true;
      for (int d = 0; d < lattice.dim; d++)
        is_near = is_near &&
            (lattice.periodic[d] || (index[d] >= -1 && index[d] <= lattice.ncell[d] + 1));
      if (!is_near) continue;
      const int number = slot * NODES_PER_BLOCK + n;
      if (beyond(index)) add_image(number, index);
      for (int c = 0; c < lattice.dim; c++) add_face_image(number, index, c);
    }
  // sums then do not depend on the order of blocks: a source has one image beyond the same walls
  const auto by_walls = [](const auto &a, const auto &b) {
    return a.walls < b.walls;
  };
  std::stable_sort(images.begin(), images.end(), by_walls);
  std::stable_sort(face_images.begin(), face_images.end(), by_walls);
}

/** The walls beyond which a cell is: bit 2 d + s for the lower (s = 0) or upper one of axis d. */
int MPMFlowLattice::beyond(const int index[3]) const
{
  int all = 0;
  for (int d = 0; d < lattice.dim; d++)
    if (!lattice.periodic[d] && (index[d] < 0 || index[d] >= lattice.ncell[d]))
      all |= (index[d] < 0 ? 1 : 2) << 2 * d;
  return all;
}

/** Cell within walls whose image along an axis of n cells is cell i. */
static int source_of_cell(int i, int n)
{
  return i < 0 ? std::min(-1 - i, n - 1) : i < n ? i : std::max(0, 2 * n - 1 - i);
}

void MPMFlowLattice::add_image(int number, const int index[3])
{
  Image image = {number, -1, beyond(index), {-1, -1, -1}};
  int source[3] = {index[0], index[1], index[2]};
  for (int d = 0; d < lattice.dim; d++)
    if (image.walls >> 2 * d & 3) source[d] = source_of_cell(index[d], lattice.ncell[d]);
  image.source = (int) grid.locate(source);
  if (image.source < 0) return;
  for (int d = 0; d < lattice.dim; d++) {
    int next[3] = {source[0], source[1], source[2]};
    next[d] += image.walls >> 2 * d & 1 ? 1 : -1;
    const auto behind = (int) grid.locate(next);
    image.behind[d] = behind < 0 ? image.source : behind;
  }
  images.push_back(image);
}

void MPMFlowLattice::add_face_image(int number, const int index[3], int axis)
{
  const int i = index[axis], last = lattice.ncell[axis], all = beyond(index);
  const bool has_wall = !lattice.periodic[axis], in_wall = has_wall && (i == 0 || i == last);
  if (!in_wall && !all) return;
  int source[3] = {index[0], index[1], index[2]}, nstick = 0;
  double factor = 1.0, shift = 0.0;
  for (int d = 0; d < lattice.dim; d++) {
    if (d == axis || !(all >> 2 * d & 3)) continue;
    source[d] = source_of_cell(index[d], lattice.ncell[d]);
    const auto &wall = walls[d][all >> 2 * d & 1 ? 0 : 1];
    if (!wall.sticks) continue;
    factor = -factor;
    shift = ++nstick == 1 ? 2.0 * wall.v[axis] : 0.0;
  }
  const auto add = [&](std::vector<FaceImage> &faces, double normal) {
    const auto from = (int) grid.locate(source);
    const bool none = from < 0 || (has_wall && source[axis] % last == 0);
    if (none) normal = 0.0;
    if (from >= 0 || in_wall)
      faces.push_back(
          {number, axis, from < 0 ? number : from, all, normal * factor, shift, normal});
  };
  const auto &wall = walls[axis][i > 0 ? 1 : 0];
  if (has_wall && i < 0) source[axis] = std::min(-i, last);
  if (has_wall && i > last) source[axis] = std::max(2 * last - i, 0);
  const bool outside = source[axis] != i;
  add(face_images, outside ? -1.0 : 1.0);
  if (in_wall && wall.sticks) source[axis] += i == 0 ? 1 : -1;
  add(path_images, !wall.sticks && outside ? -1.0 : in_wall ? -1.0 / 3.0 : 1.0);
}

/* ---------------------------------------------------------------------- */

void MPMFlowLattice::sum(double *values, int width, bool moving) const
{
  const int dim = lattice.dim;
  for (const auto &image : face_images) {
    if (image.source == image.number) continue;    // a face in a wall
    double *const from = values + (int64_t) image.number * width,
                  *const to = values + (int64_t) image.source * width;
    const int c = image.axis;
    if (moving) from[c] -= image.shift * from[dim + c];
    from[c] *= image.factor;
    for (int k = c; k < std::min(3 * dim, width); k += dim) {
      to[k] += from[k];
      from[k] = 0.0;
    }
  }
  for (const auto &image : images)
    for (int k = 3 * dim; k < width; k++) {
      double *const from = values + (int64_t) image.number * width + k;
      values[(int64_t) image.source * width + k] += *from;
      *from = 0.0;
    }
  sum_freely(values, width);
}

void MPMFlowLattice::sum_freely(double *values, int width) const
{
  grid.fold_aliases(values, width, 0, width);
  halo.sum(values, width, 0, width);
  grid.copy_aliases(values, width);
}

void MPMFlowLattice::publish(double *values, int width) const
{
  halo.sum(values, width, 0, width);
  grid.copy_aliases(values, width);
}

void MPMFlowLattice::renew(double *values, int width) const
{
  for (const int number : borrowed) std::fill_n(values + (int64_t) number * width, width, 0.0);
  publish(values, width);
}

void MPMFlowLattice::keep_owned(double *values, int width) const
{
  kept.clear();
  for (const auto &cell : cells)
    kept.insert(kept.end(), values + (int64_t) cell.number * width,
                values + ((int64_t) cell.number + 1) * width);
  std::fill_n(values, size() * width, 0.0);
  const double *from = kept.data();
  for (const auto &cell : cells) {
    std::copy_n(from, width, values + (int64_t) cell.number * width);
    from += width;
  }
}

void MPMFlowLattice::reflect(double *values, const std::vector<FaceImage> &faces) const
{
  const int dim = lattice.dim;
  for (const auto &image : faces)
    values[(int64_t) image.number * dim + image.axis] =
        image.factor * values[(int64_t) image.source * dim + image.axis] + image.shift;
}

void MPMFlowLattice::reflect_velocities(double *values, bool sticks) const
{
  if (sticks) {
    reflect(values, face_images);
    return;
  }
  const int dim = lattice.dim;
  for (const auto &image : face_images)
    values[(int64_t) image.number * dim + image.axis] =
        image.slip * values[(int64_t) image.source * dim + image.axis];
}

void MPMFlowLattice::reflect_paths(double *values) const
{
  reflect(values, path_images);
}

void MPMFlowLattice::reflect_faces(double *values, int width) const
{
  for (const auto &image : face_images)
    for (int k = image.axis; k < width; k += lattice.dim)
      values[(int64_t) image.number * width + k] = values[(int64_t) image.source * width + k];
}

void MPMFlowLattice::reflect_cells(double *values) const
{
  for (const auto &image : images) values[image.number] = values[image.source];
}

double MPMFlowLattice::memory_usage() const
{
  return grid.memory_usage() + halo.memory_usage() +
      bytes_of(points, runs, kept, cells, around, ranges, visitor_ranges, visitors, images,
               face_images, path_images);
}

/* ----------------------------------------------------------------------
   Velocities and flags go in one message, [cell][velocity, known]. A layer is added to the faces
   that are still unknown, which are few, once all of it is found.
------------------------------------------------------------------------- */

void MPMFlowAir::extend(std::vector<double> &velocity, std::vector<double> &known)
{
  const int dim = cells.lattice.dim, width = 2 * dim;
  unknown.clear();
  for (int k = 0; k < (int) cells.cells.size(); k++)
    for (int c = 0; c < dim; c++)
      if (!(known[(int64_t) cells.cells[k].number * dim + c] > 0.0) &&
          !(cells.cells[k].walls >> 2 * c & 1))
        unknown.push_back({k, c});
  all.resize(velocity.size() * 2);
  for (int64_t k = 0; k < cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      all[k * width + c] = velocity[k * dim + c];
      all[k * width + dim + c] = known[k * dim + c];
    }
  cells.publish(all.data(), width);
  for (int layer = 0; layer < LAYERS; layer++) {
    found.clear();
    std::size_t left = 0;
    for (const auto &face : unknown) {
      const auto &cell = cells.cells[face.cell];
      double sum = 0.0, n = 0.0;
      for (int s = 0; s < 2 * dim; s++) {
        // nothing is beyond a wall, and the face in the wall itself does not count
        if (cells.ends_at_wall(cell, face.axis, s)) continue;
        const double *const other = &all[(int64_t) cell.near[s] * width + face.axis];
        sum += other[dim] * other[0];
        n += other[dim];
      }
      if (n == 0.0)
        unknown[left++] = face;
      else
        found.push_back({(int64_t) cell.number * width + face.axis, sum / n});
    }
    unknown.resize(left);
    for (const auto &[place, value] : found) {
      all[place] = value;
      all[place + dim] = 1.0;
    }
    cells.renew(all.data(), width);
  }
  for (int64_t k = 0; k < cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      velocity[k * dim + c] = all[k * width + c];
      known[k * dim + c] = all[k * width + dim + c];
    }
}
