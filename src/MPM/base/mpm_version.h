/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_VERSION_H
#define LMP_MPM_VERSION_H

// Version of the package. It is defined only here; CMake and the manual read it. CONTRIBUTING.md
// describes how to make a new one.

#define MPM_VERSION "0.1.0"

#endif
