/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(mpm/atom,ComputeMPMAtom);
// clang-format on
#else

#ifndef LMP_COMPUTE_MPM_ATOM_H
#define LMP_COMPUTE_MPM_ATOM_H

#include "compute.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMPhysics;
struct MPMPoints;

/** Quantities of material points by name: one column for each name, 0 for other atoms.
 *
 *  The names are those of the table in compute_mpm_atom.cpp, those of other physics, and the history variables of
 *  the materials. A name that is not in the table is taken for a history variable until init(),
 *  because materials may be defined later than this compute.
 */
class ComputeMPMAtom : public Compute {
 public:
  ComputeMPMAtom(class LAMMPS *, int, char **);
  ~ComputeMPMAtom() override;
  void init() override;
  void compute_peratom() override;
  double memory_usage() override;

  /** The names that a wildcard (stress/<star>) stands for, or the name itself. */
  static std::vector<std::string> expand(const std::string &name);

  struct Quantity;

  std::string owner;    ///< what errors name in place of this compute, if it is a part of that

 private:
  struct Column {
    std::string name;
    const Quantity *quantity;               // null: history variable, or one of other physics
    int component;                          // of the quantity
    const MPMPhysics *physics = nullptr;    // which has it
  };

  MPMPoints *points;
  std::vector<Column> columns;
  int nmax = 0;

  static Column find_column(const std::string &name);
  void find_owners();
  std::string known_names() const;
  std::string whose() const;
};

}    // namespace LAMMPS_NS
#endif
#endif
