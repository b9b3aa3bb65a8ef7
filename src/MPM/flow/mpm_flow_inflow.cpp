/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_inflow.h"

#include "flow/mpm_flow_regions.h"
#include "loads/fix_mpm_emit.h"
#include "loads/mpm_inlet.h"

#include "error.h"
#include "fix.h"
#include "modify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// ends of inlets this close to a face, in spacings, are at the face
static constexpr double AT_FACE = 1.0e-6;
// least component of the direction of a flow that counts as along an axis of the lattice
static constexpr double ALONG = 1.0 - 1.0e-9;
// differences of shares of faces, and of squares of distances in spacings, that count as none;
// relative difference of velocities in inlets that is small
static constexpr double ALIKE = 1.0e-6, LIKE_POINTS = 0.05;
// least open part of a face over the share of a section in it: that of a corner into which columns
// of points just fit
static constexpr double LEAST_OPEN = 0.25;

MPMFlowInflow::MPMFlowInflow(LAMMPS *lmp, const MPMFlowLattice &cells, int groupbit) :
    Pointers(lmp), cells(cells)
{
  for (auto *ifix : modify->get_fix_by_style("^mpm/emit$")) {
    auto *const fix = dynamic_cast<FixMPMEmit *>(ifix);
    if (!fix || !fix->emits_into(groupbit)) continue;
    inlets.emplace_back();
    inlets.back().fix = fix;
  }
}

/** Finds the faces across an inlet, and the share of each that is in its section, from the columns
 *  of its points. */
void MPMFlowInflow::find_section(Inlet &one) const
{
  const int dim = cells.lattice.dim;
  const double h = cells.lattice.h;
  const MPMInlet &inlet = one.fix->shape();
  one.axis = -1;
  for (int d = 0; d < dim; d++)
    if (std::fabs(inlet.normal[d]) > ALONG) one.axis = d;
  if (one.axis < 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: into an incompressible flow points must come along an axis of the box, "
               "not along {:.6g} {:.6g} {:.6g}: use such a normal and inlet",
               one.fix->style, one.fix->id, inlet.normal[0], inlet.normal[1], inlet.normal[2]);
  one.side = inlet.normal[one.axis] > 0.0 ? 1 : 0;
  const double middle = (inlet.middle()[one.axis] - cells.lattice.origin[one.axis]) / h,
               half = 0.5 * inlet.length / h;
  one.first = (int) std::ceil(middle - half - AT_FACE);
  one.last = (int) std::floor(middle + half + AT_FACE);
  if (!cells.lattice.periodic[one.axis]) {    // walls hold their own faces
    one.first = std::max(one.first, 1);
    one.last = std::min(one.last, cells.lattice.ncell[one.axis] - 1);
  }
  if (one.first > one.last)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: the inlet ends in the first cell at a wall: make its region longer",
               one.fix->style, one.fix->id);

  std::map<std::array<int, 2>, double> areas;
  for (const auto &column : inlet.columns) {
    std::array<int, 2> index = {0, 0};
    for (int d = 0, k = 0; d < dim; d++) {
      if (d == one.axis) continue;
      const int i = (int) std::floor((column.x[d] - cells.lattice.origin[d]) / h);
      index[k++] = cells.lattice.wrap(d, i);
    }
    areas[index] += column.area;
  }
  const double face = dim == 3 ? h * h : h;
  one.section.clear();
  for (const auto &[index, area] : areas)
    one.section.push_back({{index[0], index[1]}, area / face});
}

/** Replaces the section by whole cells with the same flow: the cells of which it has most, as many
 *  as its area amounts to. Cells that are alike by symmetry are taken or left out together, if the
 *  velocity is then about that of the points. */
void MPMFlowInflow::round_off(Inlet &one) const
{
  auto &section = one.section;
  double all = 0.0;
  for (const auto &part : section) all += part.share;
  // square of the distance from the middle of the inlet, in spacings
  const auto away = [&](const Section &part) {
    double sum = 0.0;
    for (int d = 0, k = 0; d < cells.lattice.dim; d++) {
      if (d == one.axis) continue;
      const double middle = one.fix->shape().middle()[d];
      const double x = part.index[k++] + 0.5 - (middle - cells.lattice.origin[d]) / cells.lattice.h,
                   around = cells.lattice.periodic[d] ? cells.lattice.ncell[d] : 0.0;
      sum += around > 0.0 ? std::pow(std::remainder(x, around), 2) : x * x;
    }
    return sum;
  };
  std::vector<std::array<double, 3>> order;    // largest shares first, then the nearest ones
  for (std::size_t k = 0; k < section.size(); k++)
    order.push_back(
        {-std::round(section[k].share / ALIKE), std::round(away(section[k]) / ALIKE), (double) k});
  std::sort(order.begin(), order.end());
  std::size_t many = 0;
  for (std::size_t end = 0; end < order.size();) {
    const auto first = order[end];
    while (end < order.size() && order[end][0] == first[0] && order[end][1] == first[1]) end++;
    if (std::fabs((double) end - all) < std::fabs((double) many - all)) many = end;
  }
  if (std::fabs((double) many - all) > LIKE_POINTS * all)
    many = std::min(section.size(), (std::size_t) std::max(1.0, std::round(all)));
  std::vector<Section> whole;
  for (std::size_t k = 0; k < many; k++) whole.push_back(section[(std::size_t) order[k][2]]);
  for (auto &part : whole) part.share = all / (double) many;
  section.swap(whole);
}

/** The flow through a face that a region cuts is its velocity times its open share. This part gets
 *  the flow of all of the section. */
void MPMFlowInflow::find(const MPMFlowRegions *regions)
{
  const int dim = cells.lattice.dim;
  const double h = cells.lattice.h;
  held.clear();
  source.assign(cells.size(), 0.0);
  for (auto &one : inlets) {
    if (!found) find_section(one);
    if (!found && clamps && !regions) round_off(one);
    one.fix->velocity_now(one.velocity);
    const double v = one.velocity[one.axis];
    const int upstream = one.side ? one.first - 1 : one.last;    // the cell
    const auto visit = [&](int at, const Section &part, const auto &set) {
      int index[3];
      find_index(one, at, part, index);
      const int64_t number = cells.grid.locate(index);
      if (number >= 0) set(number);
    };
    for (const auto &part : one.section) {
      for (int face = one.first; face <= one.last; face++)
        visit(face, part, [&](int64_t number) {
          const double open = regions ? regions->aperture(number, one.axis) : 1.0;
          held.push_back(
              {number * dim + one.axis, part.share * v / std::max(open, LEAST_OPEN * part.share)});
        });
      visit(upstream, part, [&](int64_t number) {
        source[number] += part.share * std::fabs(v) / h;
      });
      // cells from the upstream one to the one before the last face
      const int before = one.side ? 1 : 0;
      for (int at = one.first - before; clamps && at <= one.last - before; at++)
        clamp(one, at, part);
    }
  }
  found = true;
}

/** Index of the cell of a section that is at this place along the axis. */
void MPMFlowInflow::find_index(const Inlet &inlet, int at, const Section &part, int *index) const
{
  std::fill_n(index, 3, 0);
  for (int d = 0, k = 0; d < cells.lattice.dim; d++)
    index[d] = d == inlet.axis ? cells.lattice.wrap(d, at) : part.index[k++];
}
/** Holds all faces of a cell that are along an inlet. */
void MPMFlowInflow::clamp(const Inlet &inlet, int at, const Section &part)
{
  const int dim = cells.lattice.dim;
  int index[3];
  find_index(inlet, at, part, index);
  for (int d = 0; d < dim; d++)
    for (int s = 0; d != inlet.axis && s < 2; s++) {
      int next[3] = {index[0], index[1], index[2]};
      next[d] += s;
      if (cells.lattice.periodic[d])
        next[d] = cells.lattice.wrap(d, next[d]);
      else if (next[d] == cells.lattice.ncell[d])
        continue;    // this face is a wall
      const int64_t number = cells.grid.locate(next);
      if (number >= 0) held.push_back({number * dim + d, inlet.velocity[d]});
    }
}

void MPMFlowInflow::hold(std::vector<double> &velocity, std::vector<double> *mobility) const
{
  for (const auto &one : held) {
    velocity[one.face] = one.velocity;
    if (mobility) (*mobility)[one.face] = 0.0;
  }
  cells.grid.copy_aliases(velocity.data(), cells.lattice.dim);
  if (mobility) cells.grid.copy_aliases(mobility->data(), cells.lattice.dim);
  cells.reflect_velocities(velocity.data());
}

bool MPMFlowInflow::carry(double *x, double *v, double *half_kick, double dt) const
{
  for (const auto &one : inlets) {
    if (!one.fix->shape().holds(x, 0.0)) continue;
    for (int d = 0; d < 3; d++) {
      v[d] = one.fix->velocity_at_end()[d];
      x[d] += dt * one.velocity[d];
    }
    for (int d = 0; d < cells.lattice.dim; d++) half_kick[d] = v[d] - one.velocity[d];
    return true;
  }
  return false;
}
