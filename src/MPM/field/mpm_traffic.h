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

/** Points that come or go during a run, and the quantities that they bring or take. All members are
 *  reals, for sums and restart files. */
struct MPMTraffic {
  double points = 0.0, mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};
  double kinetic = 0.0, stored = 0.0;    ///< [energy]

  static constexpr int NREAL = 7;
  /** The NREAL members in order. */
  double *reals() { return &points; }
  const double *reals() const { return &points; }
  void add(const MPMTraffic &);
};

/** Quantities of point i. field: its field, or null. The stored energy is 0 for points without a
 *  field. */
MPMTraffic traffic_of(LAMMPS *, MPMField *field, int i);
/** The field of point i, or null if it belongs to none. */
MPMField *field_of(LAMMPS *, int i);

/** Atoms may be changed outside of an exchange only between these two calls. Ghosts are dropped,
 *  because new atoms overwrite them, and because they do not follow atoms that move in memory.
 *  Collective; an exchange must follow. */
void begin_traffic(LAMMPS *);
void end_traffic(LAMMPS *);

/** Deletes the points for which leaves(i) is true. The ledgers of their fields and the number of
 *  atoms are updated. meant: the deletion is intended, so that the check of the number of points
 *  expects it. Returns the sums over all processes. Collective; an exchange must follow. */
MPMTraffic remove_points(LAMMPS *, const std::function<bool(int i)> &leaves, bool meant);

}    // namespace LAMMPS_NS
#endif
