/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_BYTES_OF_H
#define MPM_SOLVE_BYTES_OF_H

namespace MPM_NS {

/** Memory of vectors, for messages about it [bytes]. */
template <class... Vectors> double bytes_of(const Vectors &...list)
{
  return (0.0 + ... + (double) (list.capacity() * sizeof(typename Vectors::value_type)));
}

}    // namespace MPM_NS
#endif
