/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LOCKING_H
#define LMP_MPM_LOCKING_H

#include "field/mpm_field.h"

namespace LAMMPS_NS {

/** Cures for volumetric locking: averages over the points around each point. */
class MPMLocking : protected Pointers {
 public:
  MPMLocking(class LAMMPS *, MPMField &, class MPMPointState &);

  /** Room [n][dim*dim] for velocity gradients of all points. */
  double *room_for_gradients();
  /** F-bar method: updates strain and stress of all points from velocity gradients L in which the
   *  change of volume is replaced by its average. */
  void strain(const double *L, double dt);

  /** Finds the stress for internal forces, with averaged pressure. */
  void average_pressure();
  /** Kirchhoff stress with averaged pressure, [n][6]. */
  double *stress() { return tau.data(); }
  /** Elastic energy of points that these forces do not give back, which is that of the pressure
   *  they have left out, p - S p: V p (p - S p) / 2K at a point, with ln J for p/K. S keeps the sum
   *  of V p, so that a strain without stress, such as that of heat, does not count. This rank's
   *  share, as of the last average [energy]. */
  double unseen_energy() const { return unseen; }

  double memory_usage() const { return (gradients.capacity() + tau.capacity()) * sizeof(double); }

 private:
  MPMField &field;
  double *J = nullptr;    // [n] volume ratio by the motion of the point alone, 0: not yet known
  std::vector<double> gradients, tau;
  double unseen = 0.0;

  template <class Value> void average_around_points(const Value &);
};

}    // namespace LAMMPS_NS
#endif
