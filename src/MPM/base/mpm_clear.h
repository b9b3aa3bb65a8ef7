/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CLEAR_H
#define LMP_MPM_CLEAR_H

#include "atom.h"

#include <algorithm>
#include <vector>

namespace LAMMPS_NS {

/** Gives a list room for all points, with zeros for those of this rank and its ghosts. LAMMPS has
 *  room for 16384 points or more: to clear all of it would take a fifth of the step of a small
 *  body. */
inline void clear_points(std::vector<double> &list, const Atom *atom, int width = 1)
{
  const std::size_t w = width;
  list.resize(w * atom->nmax);
  std::fill_n(list.begin(), w * (atom->nlocal + atom->nghost), 0.0);
}

}    // namespace LAMMPS_NS
#endif
