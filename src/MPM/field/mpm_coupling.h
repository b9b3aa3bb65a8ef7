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
  /** Bits of the group of atoms, no points, that it couples to the matter of the fix with this ID;
   *  0: none. */
  virtual int atoms_coupled_to(const std::string & /*one*/) const { return 0; }

 protected:
  ~MPMCoupling() = default;    // owned and deleted as a Fix
};

/** A body without points, which acts on some kinds of matter only. Implemented by a fix. */
class MPMSolidBody {
 public:
  /** Does it act on the matter of the fix with this ID? Settings of the input decide. */
  virtual bool acts_on(const std::string &id) const = 0;
  /** Is x inside of it? Also if it is so for an image of x. */
  virtual bool has_inside(const double *x) const = 0;

 protected:
  ~MPMSolidBody() = default;    // owned and deleted as a Fix
};

/** Warns of matter that meets and goes through each other, as nothing couples it: points of two
 *  fixes mpm, of fix mpm/incompressible, of fix mpm/mesh, nodes of fix mpm/elements that no fix mpm
 *  moves; and each of these and grains, or the body of a fix mpm/rigid. What never comes near is no
 *  reason. */
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
  enum Kind { FIELD, FLOW, MESH, ELEMENTS, GRAINS, RIGID };
  /** What one fix moves, or several fixes mpm whose points are one body. Grains are atoms that are
   *  no points, of a fix of LAMMPS. */
  struct Matter {
    const Fix *fix;
    Kind kind;
    std::vector<std::string> ids;    // of the fixes
    int bits;                        // of their groups
    double h;                        // margin of its extent: node spacing; 0: none
    const MPMSolidBody *body = nullptr;
  };
  std::vector<Matter> list;
  std::vector<std::array<int, 2>> pairs;                   // that nothing couples
  std::set<std::pair<std::string, std::string>> warned;    // IDs
  const Fix *mine = nullptr;
  bool is_new = false;    // in this run
  int countdown = 0;

  bool has(const Matter &, int i) const;
  void find_matter();
  void find_pairs();
  bool are_coupled(const Matter &, const Matter &) const;
  bool feel_pairs(const Matter &, const Matter &) const;
  std::vector<int> types_of(const Matter &) const;
  std::vector<int> free_grains(const Matter &, const Matter &grains) const;
  bool reach(const Matter &, const Matter &grains) const;
  bool is_inside(const Matter &, const Matter &body) const;
  bool meet(const Matter &, const Matter &) const;
  void compare();
  std::string remedy(const Matter &, const Matter &) const;
  std::string remedy_for_grains(const Matter &) const;
};

}    // namespace LAMMPS_NS
#endif
