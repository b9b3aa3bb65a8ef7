/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LEAKS_H
#define LMP_MPM_LEAKS_H

#include <cstdint>
#include <functional>
#include <mpi.h>

namespace LAMMPS_NS {
class MPMField;
class FixMPMMaterial;

/** Nodes inside of impermeable material at which points of other materials meet from both sides:
 *  what these exchange at the nodes leaks through the material. */
struct MPMLeaks {
  int64_t nodes = 0;
  double first[3];    ///< place of one of them, if there are any
};

/** conducts(material): is the material permeable? The map of points must be known. Collective. */
MPMLeaks find_leaks(MPMField &, MPI_Comm world,
                    const std::function<bool(const FixMPMMaterial *)> &conducts);

}    // namespace LAMMPS_NS
#endif
