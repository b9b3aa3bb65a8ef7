/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FRICTION_HEAT_H
#define LMP_MPM_FRICTION_HEAT_H

#include "declare/option.h"
#include "material/material.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class Fix;
class MPMField;
class MPMHeatSink;

/** Principal conductivities k of a material at a point with the deformation gradient F [9,
 *  row-major]. The rows of n are their axes, unit vectors in space. All k are the same if the
 *  material is isotropic. */
void principal_conductivities(const MPM_NS::Conduction &, const double *F, double k[3],
                              double n[3][3]);

/** Use of the energy that friction dissipates: keyword heat of contact, walls, and rigid bodies. */
struct MPMFrictionHeatOptions {
  enum Kind { NO, YES, SHARE };

  Kind kind = NO;
  bool said = false;     ///< is the keyword given?
  double share = 1.0;    ///< with SHARE: share of the first body, or of the material at a wall

  /** Does the energy become heat? */
  bool heats() const { return kind != NO; }
  /** Declares the keyword. yes, first: what these words do, for the manual. */
  void declare(MPM_NS::Options &, const char *yes, const char *first);
};

/** Interface of a fix that may have friction. */
class MPMRubbing {
 public:
  /** Coefficient of friction between what it lets touch. */
  virtual double coefficient() const = 0;
  /** Does it dissipate energy by friction although its input does not say what happens with the
   *  energy? */
  virtual bool loses_heat() const = 0;
  /** Does it give this energy to nodes as heat? */
  virtual bool gives_heat() const = 0;

 protected:
  ~MPMRubbing() = default;
};

/** Heat of friction at nodes, which fix mpm/heat conducts into the material.
 *
 *  Fields are identified by their index in the list of begin_run(). Energies are totals over all
 *  bodies at a node. Every rank that has a node adds the same heat to it; only owned nodes are
 *  counted. */
class MPMFrictionHeat : protected Pointers {
 public:
  MPMFrictionHeat(class LAMMPS *, const MPMFrictionHeatOptions &);

  /** Start of a run, in init_action(). Stops with an error if nothing can take up the heat. From
   *  now on, fields keep the old velocities of their nodes. */
  void begin_run(const Fix &user, const std::vector<MPMField *> &);
  /** Collective, in each step before heat is given, with the nodes of this step. */
  void begin_step();

  /** Adds heat [energy] at a node of two bodies. ra, rb: records of the node in both fields;
   *  normal: unit normal of their surface. By default, the bodies share the heat as if their
   *  surfaces had the same temperature, q_a : q_b = e_a : e_b with the effusivities e = sqrt(k rho
   *  c) (H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids (1959), 2.15), where k is the
   *  conductivity along the normal. */
  void between(int a, const double *ra, int b, const double *rb, const double *normal, double heat,
               bool owned);
  /** Adds heat [energy] at a node of a wall. The wall takes what the share leaves. Heat that goes
   *  to material without conduction is lost. */
  void at_wall(int field, const double *record, double heat, bool owned);

  /** Heat [energy] of a sliding impulse J [mass velocity] on a body whose velocity relative to the
   *  other is old before the step and now after it. This is the kinetic energy that the nodes lose
   *  by J in this step. Negative in a step in which sliding reverses. */
  double made(const double *J, const double *old, const double *now, int dim) const;

  double memory_usage() const;

 private:
  struct Body {
    MPMField *field;
    bool conducts;        // does any of its materials conduct?
    bool mixed;           // effusivities differ from point to point
    bool orthotropic;     // and with the direction
    double effusivity;    // unless mixed
    // one number, or the components of a symmetric tensor, see map_tensor()
    std::vector<double> at_node;
  };
  const MPMFrictionHeatOptions &options;
  MPMHeatSink *sink = nullptr;
  std::vector<Body> bodies;
  std::vector<double> values, weights;    // of points

  template <class F> void map_means(Body &, int first, int nvalue, int width, const F &);
  void map_effusivity(Body &);
  void map_tensor(Body &);
  std::size_t node_of(const Body &, const double *record) const;
  double effusivity(const Body &, const double *record, const double *normal) const;
  void give(Body &, const double *record, double heat, bool owned);
};

}    // namespace LAMMPS_NS
#endif
