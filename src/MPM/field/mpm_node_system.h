/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_SYSTEM_H
#define LMP_MPM_NODE_SYSTEM_H

#include "lattice/grid.h"
#include "lmptype.h"
#include "solve/lattice_ranks.h"
#include "solve/linear_system.h"

#include <vector>

namespace LAMMPS_NS {
class MPMHalo;

/** Adds this rank's part of a[k] . b[k] to sum[k], for n pairs of vectors with width reals for each
 *  node of a grid, from index offset on. Each node counts once, on the rank that owns it. */
void add_products(const MPM_NS::Grid &, int width, int n, const double *const *a,
                  const double *const *b, int64_t offset, double *sum);
/** Sets value[k] to the sum of mine [n] over all ranks, added in the order of ranks. room: for the
 *  values of all ranks. Collective. */
void sum_in_order(class LAMMPS *, int n, const double *mine, std::vector<double> &room,
                  double *value);

/** System of equations for values at the nodes of a lattice: width reals for each node of a Grid,
 *  in the order of its blocks. Each node counts once in products, on the rank that owns it. Derived
 *  classes provide the operator, whose result must be the same on all ranks that share a node, and
 *  at periodic images (MPMNodes::sum(), complete()). */
class MPMNodeSystem : public MPM_NS::LinearSystem {
 public:
  MPMNodeSystem(class LAMMPS *lmp, const MPM_NS::Grid &grid, int width) :
      lmp(lmp), grid(grid), width(width)
  {
  }

  int64_t size() const override { return grid.nnodes() * width; }
  void products(int n, const double *const *a, const double *const *b, double *value) override;

 protected:
  class LAMMPS *const lmp;
  const MPM_NS::Grid &grid;
  const int width;

 private:
  std::vector<double> mine, sums_of_ranks;    // sums of this rank, and of all ranks
};

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
