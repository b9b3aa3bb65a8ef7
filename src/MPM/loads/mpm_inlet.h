/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INLET_H
#define LMP_MPM_INLET_H

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class Region;

/** Inlet through which material flows in: a region that is a straight piece of a pipe along the
 *  flow, with any cross section.
 *
 *  Points enter at its upstream end in layers across the flow, each with the same columns of
 *  points. Columns share the area of the section, so that the flow rate is that of the section and
 *  not that of a lattice that happens to fit into it. In a rectangular section (2d: any), columns
 *  are evenly spaced from edge to edge; in other sections, they are the places of a square lattice
 *  that lie inside.
 *
 *  Coordinates are those of the region as it was defined. If the inlet moves, the caller shifts
 *  positions before asking. */
class MPMInlet : protected Pointers {
 public:
  struct Column {
    double x[3];    ///< place where the column crosses the upstream end
    double area;    ///< its share of the section; around an axis of symmetry, in the half plane
  };
  std::vector<Column> columns;
  double normal[3];    ///< unit vector along the flow
  double length;       ///< length of the inlet along the flow
  double area;         ///< area of the section; around an axis of symmetry, in the half plane

  /** Finds the inlet of a region. user: the caller, for messages. direction: of the flow, of any
   *  length. spacing: desired distance of columns. known_area: area of the section, if it is an
   *  annulus around an axis of symmetry; 0: to be found. axisymmetric: x is the distance from an
   *  axis. Stops with an error if the region is not a straight piece of a pipe. Collective. */
  MPMInlet(class LAMMPS *, const std::string &user, Region *, const double *direction,
           double spacing, double known_area, bool axisymmetric);

  /** Is a place in the inlet, or less than reach away from it but not downstream? Periodic images
   *  of the inlet count. */
  bool holds(const double *x, double reach) const;
  /** Is a place, given relative to middle(), less than this distance away from the sphere around
   *  the inlet? */
  bool is_near(const double *from_middle, double distance) const;
  /** Center of the inlet. */
  const double *middle() const { return center; }

 private:
  Region *region;
  double center[3];                // center of the inlet
  double across[2][3];             // unit vectors across the flow, in 2d only the first one
  double width[2] = {0.0, 0.0};    // widths of the section along these

  bool inside(const double *x) const;
  bool inside(double along, double a, double b) const;
  double reach_of(const double *direction, double most) const;
  void choose_axes();
  bool find_section(const std::string &user, const double *low, const double *high);
  void check_prism(const std::string &user) const;
};

}    // namespace LAMMPS_NS
#endif
