/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_point_map.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_halo.h"
#include "field/mpm_passes.h"
#include "field/mpm_plan.h"
#include "group.h"
#include "lammps.h"
#include "memory.h"
#include "neighbor.h"
#include "platform.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstring>
#include <map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// what a step takes longer for a point whose neighbor in memory is in another block, relative to
// one in another cell
static constexpr int SWITCH_OF_BLOCK = 20;
// with fewer changes of cell than that times those of sorted points, nothing is to be gained
static constexpr double DECAYED = 1.6;
// what a sort takes for each point, in the same unit: from 5 to 60 scenes take the same time within
// 3 %
static constexpr double COST_OF_SORT = 40.0;

MPMPointMap::MPMPointMap(LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field)
{
  for (double **memory_of : {&tile, &tile_load}) {
    *memory_of = (double *) memory->smalloc(tile_reals() * sizeof(double), "mpm:tile");
    memset(*memory_of, 0, tile_reals() * sizeof(double));
  }
}

MPMPointMap::~MPMPointMap()
{
  memory->sfree(tile);
  memory->sfree(tile_load);
}

/** Reals of a tile, of which there are two. */
std::size_t MPMPointMap::tile_reals() const
{
  return 8 * (field.domains ? domain_tile_nodes(field.lattice.dim) : MAX_TILE_NODES);
}

/** Points drift at most half a skin between rebuilds when LAMMPS checks distances each step; a tile
 *  has room for a drift of one cell. */
void MPMPointMap::setup()
{
  watch_drift = !field.frame->is_total() && !field.domains &&
      (field.every || neighbor->includegroup || neighbor->skin > 2.0 * field.lattice.h ||
       neighbor->delay > 0 || neighbor->every > 1 || !neighbor->dist_check || neighbor->build_once);
}

void MPMPointMap::check_drift()
{
  if (field.domains) drifted = 0;    // looked at by themselves, see MPMCpdi::update()
  if (!watch_drift) return;
  int all;
  MPI_Allreduce(&drifted, &all, 1, MPI_INT, MPI_BOR, world);
  if (all) valid = false;
  drifted = 0;
}

/** A sort is worth it when the disorder since the last one is more than what little there always
 *  is, and has cost as much: whatever comes next, this takes at most twice the time of the best
 *  choice. */
bool MPMPointMap::wants_sort() const
{
  return switches > DECAYED * sorted_switches + 100 && extra_disorder > COST_OF_SORT * npoints();
}

namespace {
/** Base node of a position and its coordinates there, in cells; relative to the lattice. */
struct BaseNode {
  double origin[3], h, shift;
  double cell, per_cell;    // cells between base nodes: 1 or 2, so that this is exact
  int dim;

  explicit BaseNode(const MPMField &field) :
      h(field.lattice.h), shift(shape_constants[field.options.shape].shift),
      cell(shape_constants[field.options.shape].cell), per_cell(1.0 / cell), dim(field.lattice.dim)
  {
    std::copy_n(field.lattice.origin, 3, origin);
  }

  bool operator()(const double *x, int base[3], double t[3]) const
  {
    base[2] = 0;
    t[2] = 0.0;
    for (int d = 0; d < dim; d++) {
      t[d] = (x[d] - origin[d]) / h - shift;
      if (!(fabs(t[d]) < 4.0e6)) return false;
      base[d] = (int) (cell * std::floor(per_cell * t[d]));
    }
    return true;
  }
};
}    // namespace

bool MPMPointMap::base_node(const double *x, int base[3], double t[3]) const
{
  return BaseNode(field)(x, base, t);
}

void MPMPointMap::tile_base(const ActiveBlock &a, int base[3]) const
{
  const Grid &grid = field.grid;
  for (int d = 0; d < 3; d++) base[d] = grid.side * grid.blocks[a.slot].b[d] - field.kernel.margin;
}

/** The nodes of the next block go towards the cache: in a large run they are not there, and nothing
 *  else would hide that. */
void MPMPointMap::load_tile(const ActiveBlock &a, int base[3], bool mean)
{
  Grid &grid = field.grid;
  tile_base(a, base);
  const auto load = mean ? field.kernel.load_mean : field.kernel.load;
  load(tile_load, grid.nodes(), grid.blocks[a.slot].slot, a.box);
  const ActiveBlock *next = &a + 1;
  if (next < active.data() + active.size())
    field.kernel.prefetch(tile_load, grid.nodes(), grid.blocks[next->slot].slot, next->box);
}

bigint MPMPointMap::npoints() const
{
  bigint n = 0;
  for (const auto &run : runs) n += run.last - run.first;
  return n;
}

double MPMPointMap::memory_usage() const
{
  return 2.0 * tile_reals() * sizeof(double) + runs.capacity() * sizeof(Run) +
      active.capacity() * sizeof(ActiveBlock);
}

void MPMPointMap::find_blocks()
{
  if (sorted_disorder >= 0) extra_disorder += disorder - sorted_disorder;
  if (valid) return;
  Grid &grid = field.grid;

  grid.clear();
  runs.clear();
  active.clear();
  switches = 0;

  // runs, and the range of base coordinates of each block
  struct Range {
    double lo[3], hi[3];
  };
  std::vector<Range> ranges;
  std::array<int, 3> last_base = {INT_MAX, INT_MAX, INT_MAX}, last_block = last_base;
  const int nlocal = atom->nlocal, groupbit = field.fix.groupbit, *const mask = atom->mask;
  const double *const volume = atom->vfrac;
  const MPMRows places = field.frame->places();
  const BaseNode base_node(field);
  FixMPMMaterial *material = nullptr;
  int mask_of_material = 0;    // that of no point, which is in the group of the field
  for (int i = 0; i < nlocal; i++) {
    if (!(mask[i] & groupbit) || !(volume[i] > 0.0)) continue;
    std::array<int, 3> base;
    double t[3], reach_lo[3] = {0.0, 0.0, 0.0}, reach_hi[3] = {0.0, 0.0, 0.0};
    if (!base_node(places[i], base.data(), t)) {
      field.guard->point_is_bad(i, "is far out of reach of the lattice");
      continue;
    }
    if (base != last_base) switches++;
    if (mask[i] != mask_of_material) {
      mask_of_material = mask[i];
      material = field.is_element_node(i) ? nullptr : field.material_of(i);
    }
    const std::array<int, 3> b = {base[0] >> grid.shift_bits, base[1] >> grid.shift_bits,
                                  base[2] >> grid.shift_bits};
    const bool same_block = b == last_block;
    if (same_block && runs.back().last == i && runs.back().material == material) {
      runs.back().last++;
    } else {
      const int slot = same_block ? runs.back().slot : grid.activate(b.data());
      if (slot == (int) ranges.size()) ranges.push_back({{t[0], t[1], t[2]}, {t[0], t[1], t[2]}});
      runs.push_back({i, i + 1, slot, material});
    }
    if (field.domains) field.domains->reach(i, reach_lo, reach_hi);
    Range &r = ranges[runs.back().slot];
    for (int d = 0; d < 3; d++) {
      r.lo[d] = std::min(r.lo[d], t[d] + reach_lo[d]);
      r.hi[d] = std::max(r.hi[d], t[d] + reach_hi[d]);
    }
    last_base = base;
    last_block = b;
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Run &a, const Run &b) {
    return a.slot < b.slot;
  });

  for (int k = 0, end; k < (int) runs.size(); k = end) {
    for (end = k; end < (int) runs.size() && runs[end].slot == runs[k].slot;) end++;
    active.push_back({runs[k].slot, k, end, {}, {}, {}, {}});
    reset_box(active.back().box);
  }

  // blocks that the points can reach before the next update, which comes when a point leaves its
  // tile at the latest: all around the block, if nothing else bounds the drift
  const double least = field.domains ? 1.0e-6 : 0.0;    // see MPMCpdi::update()
  constexpr double ROUNDING =
      1.0e-6;    // of places, in cells; kernels may see them in the next cell
  const double drift = field.frame->is_total() ? ROUNDING
      : watch_drift                            ? grid.side
                    : std::max(least, std::min(1.0, 0.5 * neighbor->skin / grid.lattice.h));
  const int nactive = active.size(), order = stencil_order(field.options.shape),
            cell = shape_constants[field.options.shape].cell;
  int nodes_low[3] = {INT_MAX, INT_MAX, INT_MAX}, nodes_high[3] = {INT_MIN, INT_MIN, INT_MIN};
  for (int k = 0; k < nactive; k++) {
    const Range &r = ranges[k];
    int b[3], *const lo = active[k].low, *const hi = active[k].high;
    std::copy_n(grid.blocks[k].b, 3, b);
    int from[3], to[3];    // nodes in reach
    for (int d = 0; d < grid.lattice.dim; d++) {
      const int first = b[d] * grid.side, low = (int) std::floor(r.lo[d] - drift),
                high = (int) std::floor(r.hi[d] + drift) + order;
      if (low < first) lo[d] = -1;
      if (high >= first + grid.side) hi[d] = 1;
      nodes_low[d] = std::min(nodes_low[d], low);
      nodes_high[d] = std::max(nodes_high[d], high);
      from[d] = cell * (int) std::floor((r.lo[d] - drift - ROUNDING) / cell);
      to[d] = (int) std::floor(r.hi[d] + drift + ROUNDING) + order;
      if (field.domains) {    // corners may go anywhere in these blocks, see MPMCpdi::update()
        from[d] = first - grid.side;
        to[d] = first + 2 * grid.side - 1;
      }
    }
    for (int dx = lo[0]; dx <= hi[0]; dx++)
      for (int dy = lo[1]; dy <= hi[1]; dy++)
        for (int dz = lo[2]; dz <= hi[2]; dz++) {
          const int neighbor_block[3] = {b[0] + dx, b[1] + dy, b[2] + dz};
          Grid::Block &block = grid.blocks[grid.activate(neighbor_block)];
          block.reached |= grid.nodes_between(block, from, to);
        }
  }

  if (!field.plan->keeps_all_images())
    for (int d = 0; d < grid.lattice.dim; d++) {
      grid.reach_low[d] = nodes_low[d] - 1;
      grid.reach_high[d] = nodes_high[d] + 1;
    }
}

void MPMPointMap::finish_blocks()
{
  field.grid.close_periodic();
  field.grid.finish();
  field.nodes.allocate(field.kernel.nreal);
  field.nodes.halo->setup(field.grid, [this](const Grid::Block &block) {
    return field.plan->looks_at_all(field, block);
  });

  field.jacobians.forget();
  valid = true;
  drifted = 0;
  nbuild++;
  disorder = switches + SWITCH_OF_BLOCK * (bigint) runs.size();
  if (sorted_disorder < 0) {
    sorted_switches = switches;
    sorted_disorder = disorder;
  }
}

/** Order the points by block, material, cell and tag, the data itself moved; other atoms follow.
 *  Tags make the order, and with it all sums, independent of what happened before. */
void MPMPointMap::sort()
{
  const double start = platform::walltime();
  const int nlocal = atom->nlocal;

  // key of a point: (block in order of first appearance, material, cell)
  const int nmaterials = std::max(1, (int) field.materials.size());
  const int keys_per_block = nmaterials * NODES_PER_BLOCK;
  const int mask = field.grid.side - 1;
  std::map<std::array<int, 3>, int> index_of_block;    // ordered: gives the order of blocks
  std::vector<int> key(nlocal, -1);
  std::array<int, 3> last = {INT_MAX, INT_MAX, INT_MAX};
  int index = 0;
  for (int i = 0; i < nlocal; i++) {
    int base[3];
    double t[3];
    if (!field.is_point(i) || !base_node(field.frame->places()[i], base, t)) continue;
    std::array<int, 3> block;
    for (int d = 0; d < 3; d++) block[d] = base[d] >> field.grid.shift_bits;
    if (block != last) {
      index = index_of_block.emplace(block, (int) index_of_block.size()).first->second;
      last = block;
    }
    const int cell = field.lattice.dim == 3
        ? ((base[0] & mask) << 2 | (base[1] & mask)) << 2 | (base[2] & mask)
        : (base[0] & mask) << 3 | (base[1] & mask);
    int m = 0;
    while (m < nmaterials - 1 && !(atom->mask[i] & field.materials[m]->groupbit)) m++;
    key[i] = index * keys_per_block + m * NODES_PER_BLOCK + cell;
  }

  // blocks in order of their coordinates
  std::vector<int> rank(index_of_block.size());
  int nblocks = 0;
  for (const auto &entry : index_of_block) rank[entry.second] = nblocks++;
  for (auto &k : key)
    if (k >= 0) k = rank[k / keys_per_block] * keys_per_block + k % keys_per_block;
  put_in_order(lmp, order_by_keys(lmp, key, nblocks * keys_per_block));

  sorted_disorder = -1;    // to be counted with the next topology
  extra_disorder = 0;
  valid = false;
  nsort++;
  sort_time += platform::walltime() - start;
}

std::vector<int> LAMMPS_NS::order_by_keys(LAMMPS *lmp, std::vector<int> &key, int nkeys)
{
  const Atom *const atom = lmp->atom;
  const int nlocal = atom->nlocal;
  const int firstbit = atom->firstgroupname ? lmp->group->bitmask[atom->firstgroup] : 0;
  const int others = firstbit ? nkeys + 1 : 0;
  const int all_keys = others + nkeys + 1;
  std::vector<int> start_of_key(all_keys + 1, 0);
  for (int i = 0; i < nlocal; i++) {
    if (key[i] < 0) key[i] = nkeys;
    if (!(atom->mask[i] & firstbit)) key[i] += others;
    start_of_key[key[i] + 1]++;
  }
  for (int k = 0; k < all_keys; k++) start_of_key[k + 1] += start_of_key[k];
  std::vector<int> order(nlocal), next(start_of_key.begin(), start_of_key.end() - 1);
  for (int i = 0; i < nlocal; i++) order[next[key[i]]++] = i;
  const tagint *tag = atom->tag;
  for (int k = 0; k < all_keys - 1; k++)    // of the last key, and of nkeys, are no points
    if (k != nkeys && start_of_key[k + 1] - start_of_key[k] > 1)
      std::sort(order.begin() + start_of_key[k], order.begin() + start_of_key[k + 1],
                [tag](int i, int j) {
                  return tag[i] < tag[j];
                });
  return order;
}

void LAMMPS_NS::put_in_order(LAMMPS *lmp, const std::vector<int> &order)
{
  Atom *const atom = lmp->atom;
  Comm *const comm = lmp->comm;
  const int nlocal = atom->nlocal;

  // ghosts refer to the old order, and the first of them is in the free place that is used below:
  // the map must forget them before
  const bool mapped = atom->map_style != Atom::MAP_NONE;
  const bool moves = !std::is_sorted(order.begin(), order.end());
  bigint renew = atom->nghost + (moves && mapped), renew_all;
  MPI_Allreduce(&renew, &renew_all, 1, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  if (renew_all) {
    if (mapped) atom->map_clear();    // as in exchange(), for borders()
    atom->nghost = 0;                 // else borders() appends to them
    atom->avec->clear_bonus();
  }

  // move the atoms, cycle by cycle, through the free place at the end
  if (nlocal == atom->nmax) atom->avec->grow(0);
  std::vector<int> current(nlocal);
  for (int i = 0; i < nlocal; i++) current[i] = i;
  for (int i = 0; i < nlocal; i++) {
    if (current[i] == order[i]) continue;
    atom->avec->copy(i, nlocal, 0);
    int empty = i;
    while (order[empty] != i) {
      atom->avec->copy(order[empty], empty, 0);
      empty = current[empty] = order[empty];
    }
    atom->avec->copy(nlocal, empty, 0);
    current[empty] = order[empty];
  }

  if (renew_all) comm->borders();
}
