// clang-format off
/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Plugin only.  LAMMPS's replicate creates a second Atom, whose map of atom
   styles has the built-in ones only.  Here the source file of the host's own
   version is compiled once more with an Atom that knows ours.
------------------------------------------------------------------------- */

// everything that replicate.h and replicate.cpp include, before the renaming

#include "accelerator_kokkos.h"
#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "command.h"
#include "domain.h"
#include "error.h"
#include "label_map.h"
#include "memory.h"
#include "special.h"

#include "mpm_style_atom.h"

#include <cmath>
#include <cstring>

namespace LAMMPS_NS {

template <class T> static AtomVec *create_atom_vec(LAMMPS *lmp)
{
  return new T(lmp);
}

class AtomMPMPlugin : public Atom {
 public:
  AtomMPMPlugin(LAMMPS *lmp) : Atom(lmp)
  {
#define ATOM_CLASS
#define AtomStyle(key, Class) (*avec_map)[#key] = &create_atom_vec<Class>
#include "mpm_style_atom.h"
#undef AtomStyle
#undef ATOM_CLASS
  }
};
}    // namespace LAMMPS_NS

#define Replicate ReplicateMPM
#include "replicate.h"
#define Atom AtomMPMPlugin
#include "replicate.cpp"
#undef Atom
#undef Replicate

namespace LAMMPS_NS {
Command *mpm_replicate_creator(LAMMPS *lmp)
{
  return new ReplicateMPM(lmp);
}
}    // namespace LAMMPS_NS
