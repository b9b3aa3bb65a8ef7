/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTACT_REPORT_H
#define LMP_MPM_CONTACT_REPORT_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
struct MPMNodeContact;

/** What each two of several bodies do to each other: the output of a fix with an array of 5 columns
 *  and a scalar. The rows are the pairs (0,1), (0,2), ..., (1,2), ... */
class MPMContactReport : protected Pointers {
 public:
  static constexpr int COLUMNS = 5;
  struct Entry {                            // this rank's share
    double impulse[3] = {0.0, 0.0, 0.0};    ///< on the second body in the last step
    double count = 0.0;                     ///< nodes in contact
    double work = 0.0;                      ///< of friction so far, without the unit of energy

    /** Counts a contact, but not the work of its friction with the velocities that its records have
     *  now, which it returns. */
    double add(const MPMNodeContact &, int dim);
  };

  explicit MPMContactReport(class LAMMPS *lmp) : Pointers(lmp) {}
  void set_bodies(int nbodies);

  std::vector<Entry> entries;

  Entry &of(int a, int b) { return entries[a * nbodies - a * (a + 1) / 2 + b - a - 1]; }
  void begin_step(double dt);
  /** Work of friction so far [energy]. Collective. */
  double work();
  /** Force on the second body in the last step [3], nodes in contact, work of friction so far.
   *  Collective. */
  double at(int row, int column);

 private:
  int nbodies = 0;
  double dt_last = 0.0;
  std::vector<double> sums;
  bigint sums_step = -1;    // of sums
};

}    // namespace LAMMPS_NS
#endif
