/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_LATTICE_KEY_H
#define MPM_SOLVE_LATTICE_KEY_H

#include <array>
#include <cstdint>

namespace MPM_NS {

using LatticeIndex = std::array<int, 3>;

/** One number for the index of a node or cell, each component of which is from -2^20 to 2^20 - 1.
 *  Keys have the same order as indices. */
inline uint64_t lattice_key(const LatticeIndex &index)
{
  uint64_t key = 0;
  for (const int i : index) key = key << 21 | (uint64_t) (i + (1 << 20));
  return key;
}

/** The index of a key. */
inline LatticeIndex lattice_index(uint64_t key)
{
  LatticeIndex index;
  for (int d = 0; d < 3; d++)
    index[d] = (int) (key >> (21 * (2 - d)) & ((1 << 21) - 1)) - (1 << 20);
  return index;
}

}    // namespace MPM_NS
#endif
