// clang-format off
/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Entry point of mpmplugin.so.  The styles come from the lists mpm_style_*.h
   that CMake writes from the headers of this package, so a new style needs no
   change here.
------------------------------------------------------------------------- */

#include "lammpsplugin.h"

#include "accelerator_kokkos.h"
#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "command.h"
#include "domain.h"
#include "error.h"
#include "input.h"
#include "label_map.h"
#include "lammps.h"
#include "memory.h"
#include "output.h"
#include "special.h"
#include "version.h"

// the classes

#include "mpm_style_atom.h"
#include "mpm_style_command.h"
#include "mpm_style_compute.h"
#include "mpm_style_dump.h"
#include "mpm_style_fix.h"
#include "mpm_style_pair.h"
#include "mpm_style_region.h"
#include "base/mpm_version.h"

#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

namespace {

// creators as LAMMPS's maps store them

template <class Base, class T> Base *create1(LAMMPS *lmp)
{
  return new T(lmp);
}

template <class Base, class T> Base *create3(LAMMPS *lmp, int narg, char **arg)
{
  return new T(lmp, narg, arg);
}

// kinds that the API does not know go straight into the public maps

void add_atom_styles(Atom *atom)
{
#define ATOM_CLASS
#define AtomStyle(key, Class) (*atom->avec_map)[#key] = &create1<AtomVec, Class>
#include "mpm_style_atom.h"
#undef AtomStyle
#undef ATOM_CLASS
}

// registration through the plugin API, which knows some kinds of styles only

struct Registrar {
  void *lmp, *handle;
  lammpsplugin_regfunc regfunc;

  template <class Base, class... Args>
  void add(const char *style, const char *name, Base *(*creator)(LAMMPS *, Args...)) const
  {
    lammpsplugin_t plugin = {LAMMPS_VERSION, style, name, "material point method " MPM_VERSION,
                             "the authors of the MPM package", {}, handle};
    if constexpr (sizeof...(Args) == 0)
      plugin.creator.v1 = (lammpsplugin_factory1 *) creator;
    else
      plugin.creator.v2 = (lammpsplugin_factory2 *) creator;
    (*regfunc)(&plugin, lmp);
  }
};
}    // namespace

/* ----------------------------------------------------------------------
   LAMMPS's replicate creates a second Atom, whose map of atom styles has the
   built-in ones only.  Here the source file of the host's own version is
   compiled once more with an Atom that knows ours.  All that it includes must
   have been included before the renaming.
------------------------------------------------------------------------- */

namespace LAMMPS_NS {
class AtomMPMPlugin : public Atom {
 public:
  AtomMPMPlugin(LAMMPS *lmp) : Atom(lmp) { add_atom_styles(this); }
};
}    // namespace LAMMPS_NS

#define Replicate ReplicateMPM
#include "replicate.h"
#define Atom AtomMPMPlugin
#include "replicate.cpp"
#undef Atom
#undef Replicate

/* ----------------------------------------------------------------------
   called at every 'plugin load' and, with LAMMPS_PLUGIN_PATH, at the start
   and at every 'clear'
------------------------------------------------------------------------- */

extern "C" void lammpsplugin_init(void *ptr, void *handle, void *regfunc)
{
  auto *lmp = (LAMMPS *) ptr;

  if (strcmp(lmp->version, LAMMPS_VERSION) != 0)
    lmp->error->all(FLERR,
                    "mpmplugin was compiled for LAMMPS {}, but this is LAMMPS {}: "
                    "compile it again with the sources of this version",
                    LAMMPS_VERSION, lmp->version);

  const Registrar registrar{ptr, handle, (lammpsplugin_regfunc) regfunc};

  add_atom_styles(lmp->atom);

#define DUMP_CLASS
#define DumpStyle(key, Class) (*lmp->output->dump_map)[#key] = &create3<Dump, Class>
#include "mpm_style_dump.h"

  // commands directly, too: they outlive 'clear', after which the API would warn of overriding
  // them, and 'plugin unload' would remove LAMMPS's own replicate together with ours

  (*lmp->input->command_map)["replicate"] = &create1<Command, ReplicateMPM>;

#define COMMAND_CLASS
#define CommandStyle(key, Class) (*lmp->input->command_map)[#key] = &create1<Command, Class>
#include "mpm_style_command.h"

#define COMPUTE_CLASS
#define ComputeStyle(key, Class) registrar.add("compute", #key, &create3<Compute, Class>)
#include "mpm_style_compute.h"

#define FIX_CLASS
#define FixStyle(key, Class) registrar.add("fix", #key, &create3<Fix, Class>)
#include "mpm_style_fix.h"

#define PAIR_CLASS
#define PairStyle(key, Class) registrar.add("pair", #key, &create1<Pair, Class>)
#include "mpm_style_pair.h"

#define REGION_CLASS
#define RegionStyle(key, Class) registrar.add("region", #key, &create3<Region, Class>)
#include "mpm_style_region.h"
}
