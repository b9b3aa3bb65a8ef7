/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FIELD_OPTIONS_H
#define LMP_MPM_FIELD_OPTIONS_H

#include "declare/option.h"
#include "transfer/kernels.h"

namespace LAMMPS_NS {

/** The options of fix mpm, as given in the input. */
struct MPMFieldOptions {
  enum Scheme { USL, USF, MUSL, USAVG };    ///< when stress is updated in a step
  enum Series { LUMPED, XPIC, FMPM };       ///< terms of the inverse of the mass matrix
  /** How forces follow from stress, and velocity gradients from nodal velocities. By default as the
   *  shape and the transfer do it, or, if bodies come to rest in the updated frame or with stress
   *  from temperatures, by gradients. */
  enum Stress { DEFAULT_STRESS, MLS_STRESS, GRADIENT_STRESS };
  enum Locking { NO_CURE, FBAR, PRESSURE, BOTH };    ///< cure for volumetric locking
  enum Policy { ERROR, WARN, DELETE };               ///< what to do with a bad point
  enum Gain { GAIN_ERROR, GAIN_WARN, GAIN_IGNORE };

  MPM_NS::Shape shape = MPM_NS::QUADRATIC;
  double aspect[3] = {1.0, 1.0, 1.0};          ///< edges of an undeformed point; their product is 1
  MPM_NS::Transfer transfer = MPM_NS::APIC;    ///< polypic is APIC, xpic and fmpm are FLIP
  double flip = 0.0;                           ///< FLIP share, 0: PIC
  bool polypic = false;                        ///< bilinear modes of the velocity, too
  Series series = LUMPED;
  int order = 1;    ///< terms of the series
  Stress stress = DEFAULT_STRESS;
  bool rests = false;    ///< no option: is it such a body? By MPMField::choose_stress()
  Scheme scheme = USL;
  bool total = false;             ///< nodes are places of the reference configuration
  double most_distorted = 0.0;    ///< ratio of stretches at which a new reference is made, 0: never
  bool axisymmetric = false;      ///< 2d: x is the distance from the axis y, points are rings
  Locking locking = NO_CURE;
  double smooth = 0.0;    ///< share of rough fluid volumes removed in the time h/c; 0: none
  double drift = 4.0;     ///< rate at which volumes of liquids follow the room, per strain; 0: none
  bool heat = false;      ///< kinetic energy that transfers lose becomes heat
  double light = 0.0;     ///< nodes with less than this share of a full cell are light; 0: none
  double origin[3] = {0.0, 0.0, 0.0};    ///< if not given: the lower corner of the box
  Policy bad = ERROR;
  Gain gain = GAIN_WARN;          ///< what to do when numerical errors add energy
  double most_gain = 0.02;        ///< largest allowed gain, as a share of the energy in play
  bool apart = true;              ///< warn when points under tension are too far apart
  bool delete_failed = false;     ///< remove points whose damage is 1
  bool modified_edges = false;    ///< functions next to fixed faces are modified: no nodes outside
  int every = 1;                  ///< steps of LAMMPS in a step of the cycle
  bool dt_check = true;           ///< stop when the time step is above the stable limit
  bool plan = false;              ///< print the plan of the step with the cost of each stage
  int kernels = 0;                ///< requested instruction set, 0: the best

  /** Does the scheme update stress at the start, at the end of the step, or (neither) in
   *  between? */
  bool stress_before() const { return scheme == USF || scheme == USAVG; }
  bool stress_after() const { return scheme == MUSL || scheme == USAVG; }
  bool has_xpic() const { return series == XPIC; }
  bool has_fmpm() const { return series == FMPM; }
  bool has_light_nodes() const { return light > 0.0; }
  /** What does the cure for volumetric locking average: changes of volume, the pressure in
   *  forces? */
  bool averages_strain() const { return locking == FBAR || locking == BOTH; }
  bool averages_stress() const { return locking == PRESSURE || locking == BOTH; }
  bool smooths_volumes() const { return smooth > 0.0; }
  bool heats() const { return heat; }
  /** Are averages of volumes, which points keep, rather than of their changes in a step? */
  bool averages_volume() const { return locking == FBAR && !total; }
  /** In 2d: does F_zz change? */
  bool changes_thickness() const { return axisymmetric || (averages_strain() && !total); }
  /** With scheme usl: is stress updated while points move, or after that? Neither with light
   *  nodes. */
  bool strains_while_moving() const { return !has_light_nodes() && !averages_strain(); }
  bool strains_after_motion() const { return !has_light_nodes() && averages_strain(); }
  /** May points move with the velocities that were mapped back, as they strain? */
  bool moves_mapped() const { return stress_after() && !total; }
  /** Do positions of the end of the step have to wait until stress is known? */
  bool moves_late() const
  {
    return stress_after() || has_light_nodes() || (averages_strain() && !stress_before());
  }
  /** Do points have a size that determines which nodes they reach? */
  bool has_size() const
  {
    return shape == MPM_NS::GIMP || shape == MPM_NS::CPGIMP || MPM_NS::has_domain(shape);
  }
  /** Can a point move to any place in a cell? Not if the reference configuration stays. */
  bool changes_cells() const { return !total || most_distorted > 0.0; }
  /** Do forces and strains use the gradients of the shape functions, unlike the affine matrix? */
  bool strains_by_gradient() const
  {
    return MPM_NS::is_mls(shape, transfer) &&
        (stress == GRADIENT_STRESS || (stress == DEFAULT_STRESS && rests));
  }

  bool watches_gain() const { return gain != GAIN_IGNORE; }

  /** Can a body fracture only because its points are too far apart? Not if domains cover the
   *  body. */
  bool watches_fracture() const { return apart && !total && !MPM_NS::has_domain(shape); }

  /** The declaration of the options; it refers to this object. */
  MPM_NS::Options declare(int dimension);
};

}    // namespace LAMMPS_NS
#endif
