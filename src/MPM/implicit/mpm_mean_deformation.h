/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MEAN_DEFORMATION_H
#define LMP_MPM_MEAN_DEFORMATION_H

namespace LAMMPS_NS {

/** The mean deformation gradient F of a periodic cell, an upper triangular matrix, along a path of
 *  strain or stress of each of its components xx yy zz xy xz yz; with the mean stress of the cell
 *  (see mpm_mean_deformation.cpp). */
struct MPMMeanDeformation {
  enum Drive { HELD, ERATE, TRATE, STRAIN, STRESS };
  static constexpr int NPART = 6;
  static constexpr int ROW[NPART] = {0, 1, 2, 0, 0, 1}, COLUMN[NPART] = {0, 1, 2, 1, 2, 2};

  /** State at the end of the last step, which restart files have. */
  struct State {
    double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};    ///< row-major
    /** Components with a given stress: rate of the deformation [1/time]; lack of stress in the last
     *  step; deformation and time since the last change of sign of that lack. */
    double speed[NPART] = {}, lack[NPART] = {}, way[NPART] = {}, time[NPART] = {};
    double tau[6] = {};    ///< mean Kirchhoff stress over the cell before deformation [pressure]
    double P[9] = {};      ///< first Piola-Kirchhoff stress, the same mean
    double work = 0.0;     ///< work of the mean deformation so far [energy]
    double known = 0.0;    ///< 1: the stress is known
  };
  static constexpr int NREAL = 9 + 4 * NPART + 6 + 9 + 2;
  State past;
  double *reals() { return past.F; }

  double next[9];    ///< F at the end of the step
  double rate[9];    ///< rate of F in the step

  MPMMeanDeformation();
  /** Mean Cauchy stress. */
  double stress(int part) const;
  /** Finds next and rate of a step of duration dt. wanted: rates, strains, or stresses of the
   *  components; inertia: that of components with a given stress [pressure time^2]. Returns the
   *  part x, y, or z whose length is not positive; -1: all are. */
  int advance(double dt, const Drive *drive, const double *wanted, double inertia);
  /** Ends the step with these stresses. Returns the work of the step for each volume, with the mean
   *  of the stress before and after. */
  double end_step(const double *tau, const double *P);
  /** Components are driven in another way from now on: those without a given stress forget their
   *  speed. */
  void forget_speeds(const Drive *drive);
};

}    // namespace LAMMPS_NS
#endif
