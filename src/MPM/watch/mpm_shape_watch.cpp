/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_shape_watch.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

using namespace LAMMPS_NS;

static constexpr int PAIRS[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

MPMShapeWatch::Shapes MPMShapeWatch::find() const
{
  Shapes mine;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double x[3];
    domain->unmap(atom->x[i], atom->image[i], x);
    for (int d = 0; d < 3; d++) x[d] -= 0.5 * (domain->boxlo[d] + domain->boxhi[d]);
    auto &sums = mine[atom->mask[i]];
    sums[COUNT] += 1.0;
    sums[TAGS] += (double) atom->tag[i];
    for (int d = 0; d < 3; d++) sums[PLACE + d] += x[d];
    for (int p = 0; p < 6; p++) sums[SQUARE + p] += x[PAIRS[p][0]] * x[PAIRS[p][1]];
  }

  // the same groups in the same order on all ranks
  std::vector<int> bits;
  for (const auto &[mask, sums] : mine) bits.push_back(mask);
  const auto of_all = gather_on_all(bits, world);
  Shapes all;
  for (const int mask : std::set<int>(of_all.begin(), of_all.end()))
    MPI_Allreduce(mine[mask].data(), all[mask].data(), NSUMS, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

/** Points that came, left, or changed their groups are no reason: then nothing is known. */
void MPMShapeWatch::check()
{
  // displacements of this share of a body are told, and not round-off of sums
  constexpr double SHARE = 1.0e-9, ROUND_OFF = 1.0e-13;
  if (before.empty() || warned) return;
  const Shapes now = find();
  for (const auto &[mask, then] : before) {
    const auto found = now.find(mask);
    if (found == now.end()) continue;
    const auto &sums = found->second;
    if (sums[COUNT] != then[COUNT] || sums[TAGS] != then[TAGS]) continue;
    // what turns do not change of the second moments about the center: sum and squares
    double trace[2] = {0.0, 0.0}, square[2] = {0.0, 0.0}, far = 0.0;
    for (const auto *s : {&then, &sums}) {
      const int k = (s == &sums);
      for (int p = 0; p < 6; p++) {
        const auto [a, b] = PAIRS[p];
        const double moment = (*s)[SQUARE + p] - (*s)[PLACE + a] * (*s)[PLACE + b] / (*s)[COUNT];
        if (a == b) trace[k] += moment;
        square[k] += (a == b ? 1.0 : 2.0) * moment * moment;
        if (a == b) far += (*s)[SQUARE + p];
      }
    }
    const double least = SHARE * trace[0] + ROUND_OFF * far;
    if (fabs(trace[1] - trace[0]) <= least && fabs(sqrt(square[1]) - sqrt(square[0])) <= least)
      continue;
    warned = true;
    if (comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm {}: a command has moved {:.0f} points relative to each other since "
          "the last run, and their deformation is as it was, so that no stress follows "
          "from it: strain bodies by walls, by velocity, or by fix mpm/deform, and place "
          "points before the first run",
          field.id(), sums[COUNT]);
    return;
  }
}
