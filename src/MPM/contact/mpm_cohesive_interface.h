/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_COHESIVE_INTERFACE_H
#define LMP_MPM_COHESIVE_INTERFACE_H

#include "contact/mpm_contact_search.h"
#include "contact/mpm_node_contact.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Bonds between bodies. Points on both sides of an interface remember how far it is open, which
 *  the volumes of bodies cannot tell, and the damage of the bond. */
class MPMCohesiveInterface : protected Pointers {
 public:
  /** Reals of a point: damage, or NO_BOND; opening, from the body of the point to the other one, in
   *  axes that turn with the material. */
  enum Row { DAMAGE, OPENING, WIDTH = OPENING + 3 };
  static constexpr double NO_BOND = -1.0;

  /** rows: [point][WIDTH] of the fix. */
  MPMCohesiveInterface(class LAMMPS *lmp, const Fix &fix, const MPMContactLaw &law,
                       MPMContactBodies &bodies, const MPMContactSearch &search, double **&rows) :
      Pointers(lmp),
      fix(fix), law(law), bodies(bodies), search(search), rows(rows)
  {
  }

  /** Bonds points of bodies that touch, if a region is given only there; points elsewhere along the
   *  interface get bonds that are broken. Collective. */
  void join(const MPMContacts &, const std::string &region);
  /** Finds the bonds of pairs, and removes the pairs that neither touch nor are bonded.
   *  Collective. */
  void find(MPMContacts &);
  /** Updates points by what the final velocities of the nodes do to the bonds. */
  void open(const MPMContacts &, double dt);
  /** Area of the interface, without the damaged share of it. Collective. */
  double bonded_area(const MPMContacts &) const;
  double memory_usage() const;

 private:
  const Fix &fix;
  const MPMContactLaw &law;
  MPMContactBodies &bodies;
  const MPMContactSearch &search;
  double **&rows;
  /** What a point finds at a node in its reach. */
  struct Place {
    int pair;
    double sign;      ///< -1: the point is of the second body
    double weight;    ///< shape function
  };
  /** A point at the interface. */
  struct Point {
    int i;
    std::size_t first, last;    ///< of its places
    double R[9];                ///< rotation of the material

    /** A vector in axes of space from one in those of the material, and the reverse. */
    void spatial(const double *from, double *to) const;
    void material(const double *from, double *to) const;
  };
  std::vector<Point> points;
  std::vector<Place> places;
  std::vector<int> number;    ///< of each pair, among those that are kept; -1: none
  std::vector<MPMNodeBond> bonds;
  std::vector<double> sums;

  template <class Which, class Use>
  void visit(const MPMContacts &, int body, const Which &, const Use &);
  void warn_coarse() const;
  bool find_area(MPMNodeContact &, const double *opening) const;
};

}    // namespace LAMMPS_NS
#endif
