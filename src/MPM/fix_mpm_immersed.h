/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/immersed,FixMPMImmersed);
// clang-format on
#else

#ifndef LMP_FIX_MPM_IMMERSED_H
#define LMP_FIX_MPM_IMMERSED_H

#include "declare/option.h"
#include "fix.h"
#include "mpm_node_action.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

struct MPMImmersedOptions {
  enum Law { NONE, STOKES, SCHILLER, ERGUN, GIDASPOW, DIFELICE };

  std::string field_id;
  double density = 0.0, viscosity = 0.0;    ///< viscosity: in units of pressure, then of mass
  Law law = GIDASPOW;
  double gravity[3] = {0.0, 0.0, 0.0};

  MPM_NS::Options declare(int dimension);
};

/** Drag and buoyancy between grains smaller than the node spacing and the fluid of a field
 *  (fix mpm), exchanged at the nodes around each grain. */
class FixMPMImmersed : public Fix, public MPMNodeAction, private MPMImmersedOptions {
 public:
  FixMPMImmersed(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  void init() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  void init_action() override;
  void couple_topology() override;
  void extend_topology(MPMField &) override;
  void act(double dt, Stage) override;

 private:
  struct Mover {    // a fix that integrates grains
    int groupbit;
    double ahead;    // steps that forces still act before the grain moves
  };
  struct Grain {
    int i, first, last;    // atom, and its stencil entries
    double mass;           // infinite: held
    double immersed;       // share of it that is in the fluid
    double gain[3];        // of the velocity of the fluid in this step
    double velocity[3];    // with forces, before drag
    double part;           // 1/(1 + share of volume of the grains)
    double coefficient;    // part of the force of drag / velocity [mass/time]
    double buoyancy[3];    // impulse, part of it
  };
  struct Entry {    // a node next to a grain
    int64_t node;
    double w, share;    // shape function; share of the impulse
    double r[3];        // to the grain, in node spacings
    bool inner;         // there is fluid around the node
  };

  MPMField *field = nullptr;
  std::vector<Mover> movers;
  std::vector<Grain> grains;
  std::vector<Entry> entries;
  std::vector<char> inner;     // [node] of is_inner(): 0 as long as it was not asked
  std::vector<double> sums;    // [node][8] volume of grains; buoyancy; coefficients; drag
  double force_now[6] = {};    // drag and buoyancy on the grains of this rank, impulses
  int count = 0;
  double dt_last = 0.0;

  bool is_grain(int i) const;
  double volume(int i) const;
  bool is_inner(int64_t node);
  void find_grains(double dt);
  double end_of_bed(double solid, const double *moment, double own) const;
  double drag_after_step(double diameter, double slip, double solid, double slowing) const;
  double drag_on_sphere(double diameter, double slip, double solid) const;
};

}    // namespace LAMMPS_NS
#endif
#endif
