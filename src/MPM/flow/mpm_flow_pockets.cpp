/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_pockets.h"

#include "flow/mpm_flow_pressure.h"
#include "flow/mpm_flow_regions.h"

#include "domain.h"
#include "error.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// places along each axis of a cell cut by a wall at which its open share is sampled
static constexpr int SAMPLES = 8;
// largest number of cells of a box for a rank
static constexpr double MOST_CELLS = 2.0e9;

MPMFlowPockets::MPMFlowPockets(LAMMPS *lmp, const MPMFlowLattice &of) : Pointers(lmp), cells(of)
{
  double all = 1.0;
  for (int d = 0; d < 3; d++) {
    ncell[d] = d < cells.lattice.dim ? cells.lattice.ncell[d] : 1;
    all *= ncell[d];
  }
  if (all > MOST_CELLS)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/incompressible gas: the box has {:.3g} cells, which are more than {:.3g}: use "
        "a smaller box, or a larger node spacing",
        all, MOST_CELLS);
  size = (int64_t) all;
}

void MPMFlowPockets::index_of(int64_t place, int *index) const
{
  index[2] = (int) (place % ncell[2]);
  index[1] = (int) (place / ncell[2] % ncell[1]);
  index[0] = (int) (place / ncell[2] / ncell[1]);
}

/** Moves index to another cell along an axis; false if there is a wall. */
bool MPMFlowPockets::step(int *index, int axis, int by) const
{
  index[axis] += by;
  if (cells.lattice.periodic[axis]) index[axis] = cells.lattice.wrap(axis, index[axis]);
  return index[axis] >= 0 && index[axis] < ncell[axis];
}

/** Label of a pocket next to a cell. */
int MPMFlowPockets::next_to(const int *index) const
{
  int pocket = NONE;
  for (int d = 0; d < cells.lattice.dim; d++)
    for (int s = 0; s < 2; s++) {
      int next[3] = {index[0], index[1], index[2]};
      if (step(next, d, 2 * s - 1)) pocket = std::max(pocket, labels[place(next)]);
    }
  return pocket;
}

/** Labels all cells that faces join with the first one. */
void MPMFlowPockets::fill(int64_t first, int label)
{
  Info info;
  labels[first] = label;
  stack.assign(1, first);
  while (!stack.empty()) {
    const int64_t here = stack.back();
    stack.pop_back();
    int index[3];
    index_of(here, index);
    info.cells++;
    const double volume = volume_fractions.empty() ? 1.0 : volume_fractions[here];
    info.volume += volume;
    for (int d = 0; d < cells.lattice.dim; d++)
      for (int s = 0; s < 2; s++) {
        int next[3] = {index[0], index[1], index[2]};
        if (!step(next, d, 2 * s - 1)) {
          info.at[d][s] += volume;
          info.open = info.open || open[d][s];
          continue;
        }
        const int64_t other = place(next);
        if (labels[other] != NONE || (closed[other >> 6] >> (other & 63) & 1)) continue;
        labels[other] = label;
        stack.push_back(other);
      }
  }
  infos.push_back(info);
}

void MPMFlowPockets::number()
{
  labels.assign(size, NONE);
  infos.clear();
  for (int64_t k = 0; k < size; k++)
    if (labels[k] == NONE && !(closed[k >> 6] >> (k & 63) & 1)) fill(k, n());
  for (const int64_t k : cut) {
    if (wet[k >> 6] >> (k & 63) & 1) continue;
    int index[3];
    index_of(k, index);
    const int pocket = next_to(index);
    if (pocket != NONE) infos[pocket].volume += volume_fractions[k];
  }
}

bool MPMFlowPockets::find(const MPMFlowPressure &water)
{
  wet.assign((size + 63) / 64, 0);
  for (const auto &cell : cells.cells)
    if (water.is_wet(cell.number)) {
      const int64_t k = place(cell.index);
      wet[k >> 6] |= uint64_t(1) << (k & 63);
    }
  MPI_Allreduce(MPI_IN_PLACE, wet.data(), (int) wet.size(), MPI_UINT64_T, MPI_BOR, world);
  closed = wet;
  for (std::size_t k = 0; k < solid.size(); k++) closed[k] |= solid[k];
  const bool same = !infos.empty() && closed == closed_before;
  if (!same) {
    labels_before.swap(labels);
    nbefore = n();
    number();
    compare();
    closed_before = closed;
  }
  find_lattice(water);
  return !same;
}

/** Pockets nearest to the place of a pocket that is no longer there, through whatever is in
 *  between, and numbers of their cells there. */
std::map<int, bigint> MPMFlowPockets::nearest(int before) const
{
  std::map<int, bigint> found;
  std::vector<char> seen(size, 0);
  std::vector<int64_t> layer, next_layer;
  for (int64_t k = 0; k < size; k++)
    if (labels_before[k] == before) {
      layer.push_back(k);
      seen[k] = 1;
    }
  while (!layer.empty() && found.empty()) {
    next_layer.clear();
    for (const int64_t here : layer) {
      int index[3];
      index_of(here, index);
      for (int d = 0; d < cells.lattice.dim; d++)
        for (int s = 0; s < 2; s++) {
          int next[3] = {index[0], index[1], index[2]};
          if (!step(next, d, 2 * s - 1)) continue;
          const int64_t other = place(next);
          if (seen[other]) continue;
          seen[other] = 1;
          next_layer.push_back(other);
          if (labels[other] != NONE) found[labels[other]]++;
        }
    }
    layer.swap(next_layer);
  }
  return found;
}

/** Finds what became of the pockets before: those with which they have cells in common. */
void MPMFlowPockets::compare()
{
  std::map<std::pair<int, int>, bigint> common;
  std::vector<char> is_there(nbefore, 0);
  if (labels_before.empty()) labels_before.assign(size, NONE);
  for (int64_t k = 0; k < size; k++) {
    const int from = labels_before[k], to = labels[k];
    if (from == NONE || to == NONE) continue;
    common[{from, to}]++;
    is_there[from] = 1;
  }
  for (int from = 0; from < nbefore; from++)
    if (!is_there[from])
      for (const auto &[to, many] : nearest(from)) common[{from, to}] = many;
  common_cells.clear();
  for (const auto &[pair, many] : common) common_cells.push_back({pair.first, pair.second, many});
}

/** Finds the pockets of cells of the lattice. A dry cell with its middle in a wall belongs to a
 *  pocket next to it. */
void MPMFlowPockets::find_lattice(const MPMFlowPressure &water)
{
  pocket_of_cell.assign(cells.size(), NONE);
  const int dim = cells.lattice.dim;
  for (int64_t k = 0; k < cells.size(); k++) {
    int index[3];
    cells.grid.node_index(k, index);
    bool in = true;
    for (int d = 0; d < dim; d++) in = step(index, d, 0) && in;
    if (!in) continue;
    pocket_of_cell[k] = labels[place(index)];
    if (pocket_of_cell[k] != NONE || solid.empty() || water.is_wet(k)) continue;
    pocket_of_cell[k] = next_to(index);
  }
}

void MPMFlowPockets::find_solid(const MPMFlowRegions *regions)
{
  solid.clear();
  cut.clear();
  volume_fractions.clear();
  if (!regions) return;
  const int dim = cells.lattice.dim;
  const double h = cells.lattice.h;
  solid.assign((size + 63) / 64, 0);
  volume_fractions.assign(size, 1.0f);
  for (int64_t k = 0; k < size; k++) {
    int index[3];
    index_of(k, index);
    double corner[3] = {0.0, 0.0, 0.0}, x[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) corner[d] = cells.lattice.origin[d] + index[d] * h;
    const auto is_in = [&](double a, double b, double c) {
      const double at[3] = {a, b, c};
      for (int d = 0; d < dim; d++) x[d] = corner[d] + at[d] * h;
      return regions->depth(x, h) > 0.0;
    };
    const bool middle = is_in(0.5, 0.5, 0.5);
    if (middle) solid[k >> 6] |= uint64_t(1) << (k & 63);
    bool all_alike = true;
    for (int corners = 0; corners < 1 << dim && all_alike; corners++)
      all_alike = is_in(corners & 1, corners >> 1 & 1, corners >> 2 & 1) == middle;
    if (all_alike) {
      if (middle) volume_fractions[k] = 0.0f;
      continue;
    }
    int out = 0, all = 0;
    for (int a = 0; a < SAMPLES; a++)
      for (int b = 0; b < SAMPLES; b++)
        for (int c = 0; c < (dim == 3 ? SAMPLES : 1); c++) {
          all++;
          if (!is_in((a + 0.5) / SAMPLES, (b + 0.5) / SAMPLES, (c + 0.5) / SAMPLES)) out++;
        }
    volume_fractions[k] = (float) out / (float) all;
    if (middle && out > 0) cut.push_back(k);
  }
}

std::vector<double> MPMFlowPockets::runs() const
{
  std::vector<double> all;
  for (const int label : labels) {
    if (all.empty() || (int) all[all.size() - 2] != label) {
      all.push_back(label);
      all.push_back(0.0);
    }
    all.back() += 1.0;
  }
  return all;
}

bool MPMFlowPockets::set_runs(const double *from, std::size_t n)
{
  labels.clear();
  for (std::size_t k = 0; k < n; k += 2) {
    if (from[k + 1] > (double) (size - (int64_t) labels.size())) return false;
    labels.insert(labels.end(), (std::size_t) from[k + 1], (int) from[k]);
  }
  if ((int64_t) labels.size() != size) return false;
  infos.assign(labels.empty() ? 0 : 1 + *std::max_element(labels.begin(), labels.end()), Info());
  closed_before.clear();
  return true;
}
