/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_points.h"

#include "atom.h"

#include <list>

using namespace LAMMPS_NS;

MPMPoints *MPMPoints::get(Atom *atom, bool create)
{
  for (auto &field : atom->peratom)
    if (field.name == "mpm_F") return reinterpret_cast<MPMPoints *>(field.address);
  if (!create) return nullptr;

  static std::list<MPMPoints> pool;    // addresses stay valid, and stay reachable for leak checkers
  pool.emplace_back();
  auto *points = &pool.back();
  atom->add_peratom("mpm_F", &points->F, Atom::DOUBLE, 9);
  atom->add_peratom("mpm_tau", &points->tau, Atom::DOUBLE, 6);
  return points;
}
