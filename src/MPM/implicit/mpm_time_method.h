/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TIME_METHOD_H
#define LMP_MPM_TIME_METHOD_H

namespace LAMMPS_NS {

/** Methods of time integration of implicit steps. With the displacement u of a step of duration dt,
 *  they all balance forces f with
 *
 *    c m (u - u*) = f(s u),   u* = dt v0 + p a0
 *
 *  where v0 and a0 are the velocity and the acceleration at the start of the step. This class has
 *  the coefficients, and knows neither nodes nor forces. The methods with an acceleration are
 *
 *    u = dt v0 + dt^2 [(1/2 - beta) a0 + beta a1],   v1 = v0 + dt [(1 - gamma) a0 + gamma a1],
 *    (1 - alpha_m) m a1 + alpha_m m a0 = (1 - alpha_f) f1 + alpha_f f0
 *
 *  namely Newmark's method, where a0 is f0/m; the generalized alpha method (J. Chung, G.M. Hulbert,
 *  J. Appl. Mech. 60 (1993) 371); and, with alpha_m = 0, that of H.M. Hilber, T.J.R. Hughes, R.L.
 *  Taylor, Earthquake Eng. Struct. Dyn. 5 (1977) 283. */
struct MPMTimeMethod {
  enum Kind { STATIC, EULER, NEWMARK, MIDPOINT, ALPHA, HHT };
  Kind kind = STATIC;
  double gamma = 0.5;    ///< of Newmark's method
  double rho = 0.8;      ///< of alpha and hht: spectral radius for the highest frequencies

  bool is_static() const { return kind == STATIC; }
  /** Does the method keep accelerations from step to step, in balance with a mean of the forces of
   *  both ends of a step? */
  bool keeps_acceleration() const { return kind == ALPHA || kind == HHT; }
  /** Does the displacement depend on the acceleration at the start? */
  bool uses_acceleration() const { return kind == NEWMARK || keeps_acceleration(); }
  /** Does the velocity of points at the end of a step differ from the velocity that they move
   *  with? */
  bool moves_by_mean() const { return kind != STATIC && kind != EULER; }

  struct Coefficients {
    double beta, gamma, alpha_m, alpha_f;

    /** p: factor of a0 in the predictor u*. */
    double predictor_factor(double dt) const { return dt * dt * (0.5 - beta / (1.0 - alpha_m)); }
    /** a1 from c (u - u*) and a0. */
    double end_acceleration(double inertia, double a0) const
    {
      return (inertia - alpha_m * a0) / (1.0 - alpha_m);
    }
    /** v1 - v0. */
    double velocity_change(double dt, double a0, double a1) const
    {
      return dt * ((1.0 - gamma) * a0 + gamma * a1);
    }
  };
  Coefficients coefficients() const;
  /** s: share of the displacement after which forces enter the balance. */
  double displacement_share() const { return kind == MIDPOINT ? 0.5 : 1.0; }
  /** 1 - alpha_f: share in the balance of the forces after s u. */
  double force_share() const { return uses_acceleration() ? 1.0 - coefficients().alpha_f : 1.0; }
  /** c [1/time^2]; 0 in statics. */
  double inertia_factor(double dt) const;
  /** Ratio of a change of u to the change of dt times the velocity at the end of the step, to which
   *  contact forces belong. */
  double end_velocity_share() const;
  /** Share of the reactions in the balance of forces that changes the momentum in the step, where
   *  reactions are those of the end of the step alone. */
  double reaction_share() const;
};

}    // namespace LAMMPS_NS
#endif
