/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_THIN_H
#define LMP_MPM_HEAT_THIN_H

#include "mpm_first_note.h"

#include <array>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatBody;

/** Looks out for bodies so thin that nodes see both of their surfaces, of which heat through one is lost then.
 *
 *  Entries are conditions and contacts, in any order. The same calls with the same entries on all ranks. */
class MPMHeatThin {
 public:
  struct Found {
    int entry;
    double x[3];    ///< the first place in space
  };

  /** Begins a step. Is it one in which to look? */
  bool looks(int nentries);
  /** A place with this area of surface, in node spacings from the origin of the lattice; into: the unit normal into the body. */
  void take(int entry, const MPMHeatBody &, const double *at, const double *into, double area);
  /** Collective, after a look: true once, when much of the area of an entry belongs to thin bodies. */
  bool tell(MPI_Comm, Found &);

 private:
  int steps = 0;
  bool is_told = false;
  std::vector<std::array<double, 2>> areas;    // of an entry: of thin bodies, and of all
  std::vector<MPMFirstNote<4>>
      notes;    // of an entry: a number that is always the same, and the place
};

}    // namespace LAMMPS_NS
#endif
