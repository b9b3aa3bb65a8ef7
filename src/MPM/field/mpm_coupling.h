/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_COUPLING_H
#define LMP_MPM_COUPLING_H

#include "pointers.h"

#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {
class Fix;

/** Makes two kinds of matter feel each other: those that two fixes move. Implemented by a fix. */
class MPMCoupling {
 public:
  /** Does it act between the matter of the fixes with these IDs? Settings of the input decide, not
   *  where the matter is. */
  virtual bool couples(const std::string &one, const std::string &other) const = 0;

 protected:
  ~MPMCoupling() = default;    // owned and deleted as a Fix
};

/** Warns of matter that meets and goes through each other, as nothing couples it: points of two
 *  fixes mpm, of fix mpm/incompressible, of fix mpm/mesh, nodes of fix mpm/elements that no fix mpm
 *  moves. What never comes near is no reason. */
class MPMUncoupled : protected Pointers {
 public:
  explicit MPMUncoupled(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Start of a run, called by each fix that moves matter. */
  void begin_run(const Fix &caller)
  {
    mine = &caller;
    is_new = true;
    pairs.clear();
  }
  /** Once in each step, called by each of these: the first of them looks, and warns once of each
   *  pair, when the extents of both meet. Collective. */
  void look()
  {
    if (is_new) find_pairs();
    if (!pairs.empty() && --countdown <= 0) compare();
  }

 private:
  static constexpr int STEPS = 16;    // from one look to the next: points pass a few cells
  enum Kind { FIELD, FLOW, MESH, ELEMENTS };
  /** What one fix moves, or several fixes mpm whose points are one body. */
  struct Matter {
    const Fix *fix;
    Kind kind;
    std::vector<std::string> ids;    // of the fixes
    int bits;                        // of their groups
    double h;                        // margin of its extent: node spacing; 0: none
  };
  std::vector<Matter> list;
  std::vector<std::array<int, 2>> pairs;                   // that nothing couples
  std::set<std::pair<std::string, std::string>> warned;    // IDs
  const Fix *mine = nullptr;
  bool is_new = false;    // in this run
  int countdown = 0;

  void find_matter();
  void find_pairs();
  bool are_coupled(const Matter &, const Matter &) const;
  bool feel_pairs(const Matter &, const Matter &) const;
  void compare();
  std::string remedy(const Matter &, const Matter &) const;
};

}    // namespace LAMMPS_NS
#endif
