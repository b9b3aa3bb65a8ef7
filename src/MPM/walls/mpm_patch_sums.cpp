/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_patch_sums.h"

#include "math_extra.h"

#include <cmath>

using namespace LAMMPS_NS;

void MPMPatchSums::gather(const std::vector<Place> &mine)
{
  int nprocs;
  MPI_Comm_size(world, &nprocs);
  constexpr int REALS = sizeof(Place) / sizeof(double);
  const int n = REALS * (int) mine.size();
  std::vector<int> counts(nprocs), first(nprocs);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  int total = 0;
  for (int rank = 0; rank < nprocs; rank++) {
    first[rank] = total;
    total += counts[rank];
  }
  std::vector<Place> all(total / REALS);
  MPI_Allgatherv(mine.data(), n, MPI_DOUBLE, all.data(), counts.data(), first.data(), MPI_DOUBLE,
                 world);
  cells.clear();
  for (const auto &place : all) cells[cell_of(place.at)].push_back(place);
}

MPMPatchSums::Cell MPMPatchSums::cell_of(const double *at) const
{
  Cell cell;
  for (int d = 0; d < 3; d++) cell[d] = (int) std::floor(at[d] / radius);
  return cell;
}

std::array<double, 2> MPMPatchSums::around(double part, const double *at,
                                           const double *normal) const
{
  const Cell middle = cell_of(at);
  std::array<double, 2> sums = {0.0, 0.0};
  for (int k = 0; k < 27; k++) {
    const auto found =
        cells.find({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1});
    if (found == cells.end()) continue;
    for (const auto &place : found->second) {
      const double same = MathExtra::dot3(place.normal, normal);
      if (place.part != part || !(same > 0.0)) continue;
      double apart[3];
      MathExtra::sub3(place.at, at, apart);
      const double fall = 1.0 - MathExtra::lensq3(apart) / (radius * radius);
      if (!(fall > 0.0)) continue;
      for (int v = 0; v < 2; v++) sums[v] += same * fall * fall * place.value[v];
    }
  }
  return sums;
}
