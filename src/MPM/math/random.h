/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_RANDOM_H
#define MPM_MATH_RANDOM_H

// Random numbers that depend only on the object for which they are drawn, not on the number of
// processes or the order of points.

#include <cstdint>

namespace MPM_NS {

/** Increment from one state to the next; also a good first state. */
constexpr uint64_t RANDOM_STEP = 0x9e3779b97f4a7c15;

/** Finalizer of splitmix64 (G.L. Steele, D. Lea, C.H. Flood, OOPSLA 2014; D. Stafford's variant 13
 *  of a mix of 64 bits): one-to-one, and all bits of the result depend on all bits of z. */
[[gnu::always_inline]] inline uint64_t mix_bits(uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}    // namespace MPM_NS
#endif
