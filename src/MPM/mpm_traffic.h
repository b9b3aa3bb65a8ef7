/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TRAFFIC_H
#define LMP_MPM_TRAFFIC_H

#include <functional>

namespace LAMMPS_NS {
class LAMMPS;
class MPMField;

/** Points that come or go during a run, and what they bring or take: reals only, for sums and restart files. */
struct MPMTraffic {
  double points = 0.0, mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};
  double kinetic = 0.0, stored = 0.0;    ///< [energy]

  static constexpr int NREAL = 7;
  double *reals() { return &points; }
  const double *reals() const { return &points; }
  void add(const MPMTraffic &);
};

/** What point i has; stored energy is that of a point of a field, of others 0. field: its own, or null. */
MPMTraffic traffic_of(LAMMPS *, MPMField *field, int i);
/** The field of point i, null: of none. */
MPMField *field_of(LAMMPS *, int i);

/** Ghosts, which new atoms overwrite and which do not follow those that move in memory, are forgotten, and whoever changes
 *  atoms outside of an exchange does so between these two. Collective; only where an exchange follows. */
void begin_traffic(LAMMPS *);
void end_traffic(LAMMPS *);

/** Deletes the points for which leaves(i) is true; collective, where an exchange follows. The ledger of their fields and the number of
 *  atoms know; meant: who watches the number of points of a field is told. Returns sums over all processes. */
MPMTraffic remove_points(LAMMPS *, const std::function<bool(int i)> &leaves, bool meant);

/** Does a fix bring points into this field during runs? Then it may be empty at the start. */
bool emits_points(const MPMField &);

}    // namespace LAMMPS_NS
#endif
