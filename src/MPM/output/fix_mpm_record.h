/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/record,FixMPMRecord);
// clang-format on
#else

#ifndef LMP_FIX_MPM_RECORD_H
#define LMP_FIX_MPM_RECORD_H

#include "declare/option.h"

#include "fix.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

struct MPMRecordOptions {
  double start = 0.0;
  bool hold = true;

  MPM_NS::Options declare();
};

/** Values from a file at the present time, for use in variables: each column, and its integral over
 *  time. */
class FixMPMRecord : public Fix, private MPMRecordOptions {
 public:
  FixMPMRecord(class LAMMPS *, int, char **);
  int setmask() override { return 0; }
  double compute_scalar() override { return compute_vector(0); }
  double compute_vector(int) override;

 private:
  std::vector<double> rows;         // time and values
  std::vector<double> integrals;    // integrals of the values up to each row
  int ncolumn;                      // number of columns of values

  std::size_t nrow() const { return rows.size() / (1 + ncolumn); }
  double at(std::size_t row, int column) const { return rows[row * (1 + ncolumn) + column]; }
  void read(const std::string &file);
};

}    // namespace LAMMPS_NS
#endif
#endif
