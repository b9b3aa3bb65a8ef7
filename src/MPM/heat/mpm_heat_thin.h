/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_THIN_H
#define LMP_MPM_HEAT_THIN_H

#include "base/mpm_first_note.h"

#include <array>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatBody;

/** Detects bodies so thin that nodes see both of their surfaces; the heat through one of these is
 *  then lost.
 *
 *  Entries are conditions and contacts, in any order. All ranks must make the same calls with the
 *  same entries. */
class MPMHeatThin {
 public:
  struct Found {
    int entry;
    double x[3];    ///< the first place in space
  };

  /** Begins a step. Returns true if bodies are checked in this step. */
  bool looks(int nentries);
  /** Adds a place with this area of surface. at: position in node spacings from the origin of the
   *  lattice; into: unit normal into the body. */
  void take(int entry, const MPMHeatBody &, const double *at, const double *into, double area);
  /** Called after a check: returns true once, if thin bodies make up much of the area of an entry.
   *  Collective. */
  bool report(MPI_Comm, Found &);

 private:
  int steps = 0;
  bool warned = false;
  std::vector<std::array<double, 2>> areas;    // [entry] area of thin bodies, and of all bodies
  std::vector<MPMFirstNote<4>> notes;          // [entry] a constant number, and the place
};

}    // namespace LAMMPS_NS
#endif
