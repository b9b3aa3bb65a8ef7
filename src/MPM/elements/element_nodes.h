/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_ELEMENT_NODES_H
#define LMP_ELEMENT_NODES_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/** The points that are the nodes of a body of elements: those of the group of a fix, whose IDs
 *  follow each other. Functions are collective, and stop with an error if the points cannot be
 *  nodes. */
class ElementNodes : protected Pointers {
 public:
  struct IDs {    ///< number and range
    bigint n;
    tagint low, high;
  };
  IDs ids = {};

  ElementNodes(class LAMMPS *lmp, const class Fix &fix) : Pointers(lmp), fix(fix) {}

  bool has(int i) const;
  /** Finds the IDs, which must be as many as the nodes of a mesh, in their order. x: receives the
   *  positions of all of them [nnode][3], local: their local indices, or -1. */
  void define(bigint nnode, std::vector<double> &x, std::vector<int> &local);
  /** The one material of all nodes. */
  class FixMPMMaterial *find_material() const;
  /** The elements, with this volume, must have that of their nodes. */
  void check_volume(double volume) const;
  /** Start of a run: are the nodes those of the definition, and of no other mesh, whose forces
   *  would be added? Can fields that move them have elements? */
  void check() const;
  /** ID of a fix mpm that moves nodes, or null. */
  const char *field() const;

 private:
  const Fix &fix;

  IDs count() const;
  bool has_points_of(int other_groupbit) const;
};

}    // namespace LAMMPS_NS
#endif
