/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LATTICE_RANKS_H
#define LMP_MPM_LATTICE_RANKS_H

#include "lmptype.h"
#include "solve/lattice_ranks.h"

namespace LAMMPS_NS {
class MPMHalo;

/** Ranks of LAMMPS for solves on a lattice. Sums at nodes use a halo that is set up for the
 *  grid. */
class MPMLatticeRanks : public MPM_NS::LatticeRanks {
 public:
  MPMLatticeRanks(class LAMMPS *lmp, const MPM_NS::Grid &grid, MPMHalo &halo) :
      lmp(lmp), grid(grid), halo(halo)
  {
  }

  int number() const override;
  int me() const override;
  void sum(double *values, int width) override;
  /** Stops with an error if the total size exceeds the range of an int. */
  const std::vector<char> &gather_bytes(const void *mine, std::size_t bytes) override;
  const std::vector<char> &gather_sizes(const void *mine, const std::vector<int> &sizes) override;

 private:
  class LAMMPS *const lmp;
  const MPM_NS::Grid &grid;
  MPMHalo &halo;
  std::vector<bigint> bytes_of_ranks;
  std::vector<int> counts, first;
  std::vector<char> all;

  const std::vector<char> &gather_counts(const void *mine);
};

}    // namespace LAMMPS_NS
#endif
