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

/** Quantities of material points by name: one column per name, 0 for other atoms.
 *
 *  A name is in the table of compute_mpm_atom.cpp, or it is a quantity of other physics, or a
 *  history variable of a material. A name that is not in the table is checked only in init(),
 *  because materials may be defined later than this compute.
 */
class ComputeMPMAtom : public Compute {
 public:
  ComputeMPMAtom(class LAMMPS *, int, char **);
  ~ComputeMPMAtom() override;
  void init() override;
  void compute_peratom() override;
  double memory_usage() override;

  /** Names that a wildcard such as stress/<star> stands for, or only the name itself. */
  static std::vector<std::string> expand(const std::string &name);

  struct Quantity;

  std::string owner;    ///< style that errors name in place of this internal compute; empty: none

 private:
  struct Column {
    std::string name;
    const Quantity *quantity;               // null: history variable, or quantity of other physics
    int component;                          // of the quantity
    const MPMPhysics *physics = nullptr;    // that has the quantity; null: none
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
