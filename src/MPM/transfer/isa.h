/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_ISA_H
#define MPM_TRANSFER_ISA_H

// Which instruction set runs. The files *_isa.cpp are compiled once for each set with MPM_ISA =
// base, v3 or v4, the levels of x86-64; MPM_HAVE_V3 and MPM_HAVE_V4 tell which the build has. A
// file provides a function under a name that ends with the set: define it as MPM_OF_ISA(name), and
// declare and call those of all sets with MPM_DECLARE_ISA and MPM_ALL_ISA.

namespace MPM_NS {

enum InstructionSet { BASE, V3, V4, REFERENCE };

/** Selects the instruction set with this name: reference, baseline, avx2, avx512. Without a name,
 *  the environment variable MPM_ISA gives it; without both, it is the best set that runs here.
 *  Returns false for an unknown name, and for a set that was not built or that the CPU lacks. */
bool select_isa(const char *name, InstructionSet &set);

}    // namespace MPM_NS

#define MPM_CONCAT_(a, b) a##_##b
#define MPM_CONCAT(a, b) MPM_CONCAT_(a, b)
#define MPM_OF_ISA(name) MPM_CONCAT(name, MPM_ISA)

#if defined(MPM_HAVE_NO_BASE)    // the demonstration, see cmake/mpm_sources.cmake
#define MPM_IF_BASE(function) nullptr
#else
#define MPM_IF_BASE(function) function
#endif
#if defined(MPM_HAVE_V3)
#define MPM_IF_V3(function) function
#else
#define MPM_IF_V3(function) nullptr
#endif
#if defined(MPM_HAVE_V4)
#define MPM_IF_V4(function) function
#else
#define MPM_IF_V4(function) nullptr
#endif

/** Declares the functions name_base, name_v3 and name_v4. */
#define MPM_DECLARE_ISA(result, name, ...) \
  result name##_base(__VA_ARGS__);         \
  result name##_v3(__VA_ARGS__);           \
  result name##_v4(__VA_ARGS__);
/** Pointers to them, by InstructionSet; null for a set that was not built, and name_base in the
 *  place of plain loops. */
// clang-format off
#define MPM_ALL_ISA(name) \
  {MPM_IF_BASE(name##_base), MPM_IF_V3(name##_v3), MPM_IF_V4(name##_v4), MPM_IF_BASE(name##_base)}
// clang-format on

#endif
