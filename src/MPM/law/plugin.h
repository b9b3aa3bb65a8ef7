/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_PLUGIN_H
#define MPM_LAW_PLUGIN_H

// For laws that are compiled outside of this package, as a plugin that LAMMPS loads after it. The
// file of a law includes this header first, then the header of a base class if it uses one, such as
// law/eos.h, and ends with the line
//
//   MPM_LAW_PLUGIN(MPM_LAW(EOS, EosQuadratic))
//
// with one MPM_LAW(PART, STRUCT) for each law of the plugin, separated by commas. The laws are
// compiled once, for the instruction set in the options of the compiler (-march=native
// -fopenmp-simd).

#ifndef MPM_ISA
#define MPM_ISA plugin
#endif

#include "law/law.h"

namespace MPM_NS {

/** Adds the laws of a plugin to the LAMMPS that loads it; stops with an error of LAMMPS if they do
 *  not fit the package. */
void register_laws(void *lmp, const LawVersion &, const PluginLaw *, int n);

}    // namespace MPM_NS

/** Entry of one law: its place in a material and its struct. */
#define MPM_LAW(PART, STRUCT)                                      \
  {                                                                \
    MPM_NS::PART, MPM_NS::law::declaration<MPM_NS::law::STRUCT>(), \
        MPM_NS::law::kernels<MPM_NS::law::STRUCT>()                \
  }

/** Defines the function that LAMMPS calls when it loads the plugin. */
#define MPM_LAW_PLUGIN(...)                                                          \
  extern "C" void lammpsplugin_init(void *lmp, void *, void *)                       \
  {                                                                                  \
    static const MPM_NS::PluginLaw laws[] = {__VA_ARGS__};                           \
    MPM_NS::register_laws(lmp, MPM_NS::law_version, laws, MPM_NS::law::count(laws)); \
  }

#endif
