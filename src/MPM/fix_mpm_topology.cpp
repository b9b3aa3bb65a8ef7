/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Topology of fix mpm: which blocks have points, and the order of points in memory.

#include "fix_mpm.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "error.h"
#include "fix_mpm_material.h"
#include "group.h"
#include "material/batch.h"
#include "modify.h"
#include "mpm_halo.h"
#include "mpm_node_action.h"
#include "mpm_points.h"
#include "neighbor.h"
#include "platform.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double MAX_SIZE = 0.5;    // of points with GIMP, in node spacings

// base node of a point relative to its cell, in cells
static constexpr double BASE_SHIFT[4] = {0.0, 0.0, 0.5, 1.0};

/* ----------------------------------------------------------------------
   base node of a position and its coordinate t in cells; false: not a usable position
------------------------------------------------------------------------- */

bool FixMPM::base_node(const double *x, int base[3], double t[3]) const
{
  base[2] = 0;
  t[2] = 0.0;
  for (int d = 0; d < lattice.dim; d++) {
    t[d] = (x[d] - lattice.origin[d]) / lattice.h - (bernstein ? 0.0 : BASE_SHIFT[shape]);
    if (!(fabs(t[d]) < 4.0e6)) return false;
    base[d] = bernstein ? 2 * (int) std::floor(0.5 * t[d]) : (int) std::floor(t[d]);
  }
  return true;
}

/* ----------------------------------------------------------------------
   stage 1, for all fields that need it: when points have migrated, were sorted or have drifted
------------------------------------------------------------------------- */

void FixMPM::update_topology()
{
  for (auto *field : fields) field->update_domains();
  for (auto *action : actions) action->couple_topology();
  for (auto *field : fields) field->find_blocks();
  for (auto *action : actions) action->blocks_found();
  for (auto *field : fields) field->finish_topology();
  for (auto *field : fields) field->update_sizes();
}

/* ----------------------------------------------------------------------
   the same apart from the step: of all fields, by the one that drives them
------------------------------------------------------------------------- */

void FixMPM::find_topology()
{
  if (!topology_valid || has_domains())    // of which corners may have left what is in reach
    dynamic_cast<FixMPM *>(modify->get_fix_by_style("^mpm$")[0])->update_topology();
}

/* ----------------------------------------------------------------------
   GIMP: half sizes of the points along the axes, which stay the same throughout a step. At the start
   a point is a box of its volume. A contiguous one follows F: what was a box of half sizes l has the
   second moments F diag(l^2) F^T/3, along axis d those of an interval with the half size
   [sum_e (F_de l_e)^2]^1/2. Without shear and rotation this is F_dd l_d, and a cube that just turns
   keeps its size. Half a cell is the limit: beyond, a point would reach more nodes than the stencil
   has.
------------------------------------------------------------------------- */

void FixMPM::update_sizes()
{
  if (!has_boxes()) return;
  sizes.resize(3 * (std::size_t) atom->nmax, MAX_SIZE);
  for (const auto &run : runs)
    for (int i = run.first; i < run.last; i++) box_sizes(i, &sizes[3 * (std::size_t) i]);
}

void FixMPM::box_sizes(int i, double *size) const
{
  constexpr double MIN_SIZE = 1.0e-4;
  const double half = half_size(i), *F = points->F[i];
  for (int d = 0; d < lattice.dim; d++, F += 3) {
    double edge = aspect[d];
    if (extent == CONTIGUOUS) {
      double square = 0.0;
      for (int e = 0; e < lattice.dim; e++) square += F[e] * F[e] * aspect[e] * aspect[e];
      edge = sqrt(square);
    }
    size[d] = std::max(MIN_SIZE, std::min(MAX_SIZE, half * edge));
  }
}

/** Half of the edge of a cube (2d: square) with the initial volume of the point, in node spacings. */
double FixMPM::half_size(int i) const
{
  if (axisymmetric) return 0.5 * sqrt(atom->vfrac[i] / circle(reference_radius(i))) / lattice.h;
  return 0.5 * (lattice.dim == 3 ? cbrt(atom->vfrac[i]) : sqrt(atom->vfrac[i])) / lattice.h;
}

/* ----------------------------------------------------------------------
   runs of points of one block, and blocks within reach
------------------------------------------------------------------------- */

void FixMPM::find_blocks()
{
  if (topology_valid) return;
  clock = platform::walltime();

  grid->clear();
  runs.clear();
  active.clear();
  switches = 0;

  // runs, and the range of base coordinates of each block

  struct Range {
    double lo[3], hi[3];
  };
  std::vector<Range> ranges;
  int last_base[3] = {INT_MAX, INT_MAX, INT_MAX}, last_block[3] = {INT_MAX, INT_MAX, INT_MAX};
  const int nlocal = atom->nlocal;
  for (int i = 0; i < nlocal; i++) {
    if (!is_point(i)) continue;
    int base[3], b[3];
    double t[3];
    if (!base_node(place(i), base, t)) {
      point_is_bad(i, "is far out of reach of the lattice");
      continue;
    }
    for (int d = 0; d < 3; d++) b[d] = base[d] >> grid->shift_bits;
    if (base[0] != last_base[0] || base[1] != last_base[1] || base[2] != last_base[2]) switches++;
    FixMPMMaterial *material = is_node(i) ? nullptr : material_of(i);
    const bool same_block = b[0] == last_block[0] && b[1] == last_block[1] && b[2] == last_block[2];
    if (same_block && runs.back().last == i && runs.back().material == material) {
      runs.back().last++;
    } else {
      const int slot = same_block ? runs.back().slot : grid->activate(b);
      if (slot == (int) ranges.size()) {
        Range r;
        for (int d = 0; d < 3; d++) {
          r.lo[d] = t[d];
          r.hi[d] = t[d];
        }
        ranges.push_back(r);
      }
      runs.push_back({i, i + 1, slot, material});
    }
    Range &r = ranges[runs.back().slot];
    double reach_lo[3] = {0.0, 0.0, 0.0}, reach_hi[3] = {0.0, 0.0, 0.0};
    if (has_domains()) domain_reach(i, reach_lo, reach_hi);
    for (int d = 0; d < 3; d++) {
      r.lo[d] = std::min(r.lo[d], t[d] + reach_lo[d]);
      r.hi[d] = std::max(r.hi[d], t[d] + reach_hi[d]);
      last_base[d] = base[d];
      last_block[d] = b[d];
    }
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Run &a, const Run &b) {
    return a.slot < b.slot;
  });

  for (int k = 0, end; k < (int) runs.size(); k = end) {
    ActiveBlock a;
    for (end = k; end < (int) runs.size() && runs[end].slot == runs[k].slot;) end++;
    a.slot = runs[k].slot;
    a.first_run = k;
    a.last_run = end;
    for (int d = 0; d < 3; d++) {
      a.box[d] = 127;
      a.box[3 + d] = -127;
    }
    active.push_back(a);
  }

  // blocks that the points can reach before the next update, which comes when a point leaves its tile
  // at the latest: all around the block, if nothing else bounds the drift

  const double least = has_domains() ? 1.0e-6 : 0.0;    // see update_domains()
  const double drift = total ? 0.0
      : watch_drift          ? grid->side
                             : std::max(least, std::min(1.0, 0.5 * neighbor->skin / lattice.h));
  const int nactive = active.size();
  for (int k = 0; k < nactive; k++) {
    const Range &r = ranges[k];
    int b[3], lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0};
    for (int d = 0; d < 3; d++) b[d] = grid->blocks[k].b[d];
    for (int d = 0; d < lattice.dim; d++) {
      const int first = b[d] * grid->side;
      if ((int) std::floor(r.lo[d] - drift) < first) lo[d] = -1;
      if ((int) std::floor(r.hi[d] + drift) + shape >= first + grid->side) hi[d] = 1;
    }
    for (int d = 0; d < 3; d++) {
      active[k].low[d] = lo[d];
      active[k].high[d] = hi[d];
    }
    for (int dx = lo[0]; dx <= hi[0]; dx++)
      for (int dy = lo[1]; dy <= hi[1]; dy++)
        for (int dz = lo[2]; dz <= hi[2]; dz++) {
          const int neighbor_block[3] = {b[0] + dx, b[1] + dy, b[2] + dz};
          grid->activate(neighbor_block);
        }
  }
  lap(report.t_topology);
}

/* ----------------------------------------------------------------------
   blocks that node actions need, and which of all other ranks have, too
------------------------------------------------------------------------- */

void FixMPM::finish_topology()
{
  if (topology_valid) return;
  clock = platform::walltime();

  auto *master = dynamic_cast<FixMPM *>(modify->get_fix_by_style("^mpm$")[0]);
  for (auto *action : master->actions) action->extend_topology(*this);
  grid->close_periodic();
  grid->finish();
  grid->allocate(kernel.nreal);
  halo->setup(*grid);
  if (modified_edges) list_edges(edges, false);
  for (auto *action : master->actions) action->topology_changed(*this);

  topology_valid = true;
  drifted = 0;
  int nhistory = 1;
  for (auto *material : materials) nhistory = std::max(nhistory, material->nhistory);
  history_batch.resize((std::size_t) nhistory * BATCH);
  report.topologies++;

  if (switches_sorted < 0) switches_sorted = switches;
  want_sort = switches > 1.6 * switches_sorted + 100;
  lap(report.t_topology);
}

/* ----------------------------------------------------------------------
   order the points by block, material, cell and tag, the data itself moved; other atoms follow.
   Tags make the order, and with it all sums, independent of what happened before.
------------------------------------------------------------------------- */

void FixMPM::sort_points()
{
  const double start = platform::walltime();
  const int nlocal = atom->nlocal;

  // key of a point: (block in order of first appearance, material, cell)

  const int nmaterials = MAX(1, (int) materials.size());
  const int keys_per_block = nmaterials * NODES_PER_BLOCK;
  const int mask = grid->side - 1;
  std::map<std::array<int, 3>, int> index_of_block;    // ordered: gives the order of blocks
  std::vector<int> key(nlocal, -1);
  std::array<int, 3> last = {INT_MAX, INT_MAX, INT_MAX};
  int index = 0;
  for (int i = 0; i < nlocal; i++) {
    int base[3];
    double t[3];
    if (!is_point(i) || !base_node(place(i), base, t)) continue;
    std::array<int, 3> block;
    for (int d = 0; d < 3; d++) block[d] = base[d] >> grid->shift_bits;
    if (block != last) {
      index = index_of_block.emplace(block, (int) index_of_block.size()).first->second;
      last = block;
    }
    const int cell = lattice.dim == 3
        ? ((base[0] & mask) << 2 | (base[1] & mask)) << 2 | (base[2] & mask)
        : (base[0] & mask) << 3 | (base[1] & mask);
    int m = 0;
    if (nmaterials > 1)
      while (m < nmaterials - 1 && !(atom->mask[i] & materials[m]->groupbit)) m++;
    key[i] = index * keys_per_block + m * NODES_PER_BLOCK + cell;
  }

  // blocks in order of their coordinates; atoms that are no points come last. A group that LAMMPS
  // wants to be first (atom_modify first) stays so, and has the same order in itself

  std::vector<int> rank(index_of_block.size());
  int nblocks = 0;
  for (const auto &entry : index_of_block) rank[entry.second] = nblocks++;
  const int nkeys = nblocks * keys_per_block;
  const int firstbit = atom->firstgroupname ? group->bitmask[atom->firstgroup] : 0;
  const int others = firstbit ? nkeys + 1 : 0;
  const int all_keys = others + nkeys + 1;
  std::vector<int> start_of_key(all_keys + 1, 0);
  for (int i = 0; i < nlocal; i++) {
    if (key[i] < 0)
      key[i] = nkeys;
    else
      key[i] = rank[key[i] / keys_per_block] * keys_per_block + key[i] % keys_per_block;
    if (!(atom->mask[i] & firstbit)) key[i] += others;
    start_of_key[key[i] + 1]++;
  }
  for (int k = 0; k < all_keys; k++) start_of_key[k + 1] += start_of_key[k];
  std::vector<int> permute(nlocal), next(start_of_key.begin(), start_of_key.end() - 1);
  for (int i = 0; i < nlocal; i++) permute[next[key[i]]++] = i;
  const tagint *tag = atom->tag;
  for (int k = 0; k < all_keys; k++)
    if (k != nkeys && k != others + nkeys && start_of_key[k + 1] - start_of_key[k] > 1)
      std::sort(permute.begin() + start_of_key[k], permute.begin() + start_of_key[k + 1],
                [tag](int i, int j) {
                  return tag[i] < tag[j];
                });

  // ghosts refer to the old order, and the first of them is in the free place that is used below: the
  // map must forget them before

  const bool mapped = atom->map_style != Atom::MAP_NONE;
  bool moves = false;
  for (int i = 0; i < nlocal; i++) moves = moves || permute[i] != i;
  bigint renew = atom->nghost + (moves && mapped), renew_all;
  MPI_Allreduce(&renew, &renew_all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (renew_all) {
    if (mapped) atom->map_clear();    // as in exchange(), for borders()
    atom->nghost = 0;                 // else borders() appends to them
    atom->avec->clear_bonus();
  }

  // move the atoms, cycle by cycle, through the free place at the end

  if (nlocal == atom->nmax) atom->avec->grow(0);
  std::vector<int> &current = key;
  for (int i = 0; i < nlocal; i++) current[i] = i;
  for (int i = 0; i < nlocal; i++) {
    if (current[i] == permute[i]) continue;
    atom->avec->copy(i, nlocal, 0);
    int empty = i;
    while (permute[empty] != i) {
      atom->avec->copy(permute[empty], empty, 0);
      empty = current[empty] = permute[empty];
    }
    atom->avec->copy(nlocal, empty, 0);
    current[empty] = permute[empty];
  }

  if (renew_all) comm->borders();

  switches_sorted = -1;    // to be counted with the next topology
  want_sort = false;
  topology_valid = false;
  report.sorts++;
  report.t_sort += platform::walltime() - start;
}
