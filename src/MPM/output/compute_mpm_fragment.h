/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(mpm/fragment,ComputeMPMFragment);
// clang-format on
#else

#ifndef LMP_COMPUTE_MPM_FRAGMENT_H
#define LMP_COMPUTE_MPM_FRAGMENT_H

#include "compute.h"
#include "declare/option.h"
#include "output/mpm_pieces.h"

namespace LAMMPS_NS {

/** Keywords of compute mpm/fragment. */
struct MPMFragmentOptions {
  double separable = 0.99;    ///< damage of points that are of no piece

  MPM_NS::Options declare();
};

/** IDs of the pieces that material points belong to, and their number. */
class ComputeMPMFragment : public Compute, private MPMFragmentOptions {
 public:
  ComputeMPMFragment(class LAMMPS *, int, char **);
  ~ComputeMPMFragment() override;
  void init() override;
  void compute_peratom() override;
  double compute_scalar() override;
  double memory_usage() override;

 private:
  MPMPieces pieces;
  int nmax = 0;
};

}    // namespace LAMMPS_NS
#endif
#endif
