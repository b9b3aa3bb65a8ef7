/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(mpm/error,ComputeMPMError);
// clang-format on
#else

#ifndef LMP_COMPUTE_MPM_ERROR_H
#define LMP_COMPUTE_MPM_ERROR_H

#include "compute.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Norms over material points of the difference between a quantity and its exact solution. */
class ComputeMPMError : public Compute {
 public:
  ComputeMPMError(class LAMMPS *, int, char **);
  void init() override;
  double compute_scalar() override;
  void compute_vector() override;
  double memory_usage() override;

 private:
  enum { L2, LARGEST, EXACT, L2_SO_FAR, LARGEST_SO_FAR, NVALUES };

  struct Value {      // a per-atom quantity
    int type;         // ArgInfo::X, V, COMPUTE, FIX, or VARIABLE
    int component;    // of x or v; column of a compute or fix, 0: per-atom vector
    std::string id;
    int variable;
    int iarg;
  };

  std::vector<Value> values;    // each followed by its exact solution
  std::vector<double> computed, wanted, difference2, exact2;
  double norms[NVALUES] = {0.0};

  Value parse(const char *, int iarg, bool exact);
  void check(Value &);
  void get(const Value &, std::vector<double> &out);
};

}    // namespace LAMMPS_NS
#endif
#endif
