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

#include "fix.h"
#include "mpm_node_action.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPM;

/** Drag and buoyancy between grains smaller than the node spacing and the fluid of a field
 *  (fix mpm), exchanged at the nodes around each grain. */
class FixMPMImmersed : public Fix, public MPMNodeAction {
 public:
  FixMPMImmersed(class LAMMPS *, int, char **);
  int setmask() override;
  void init() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  void init_action() override;
  void couple_topology() override;
  void extend_topology(FixMPM &) override;
  void act(double dt, Stage) override;

 private:
  enum Law { NONE, STOKES, SCHILLER, ERGUN, GIDASPOW, DIFELICE };

  struct Mover {    // a fix that integrates grains
    int groupbit;
    double ahead;    // share of a step that forces still act before the grain moves
  };
  struct Grain {
    int i, first;          // atom, and its first stencil entry
    double mass;           // infinite: held
    double immersed;       // share of it that is in the fluid
    double velocity[3];    // with forces, before drag
    double coefficient;    // force of drag / velocity [mass/time]
    double buoyancy[3];    // impulse
  };
  struct Entry {    // a node next to a grain
    int64_t node;
    double w, share;    // shape function; share of the impulse
  };

  std::string field_id;
  double density, viscosity;    // [mass/distance^3], [mass/(distance time)]
  Law law;
  double gravity[3];
  FixMPM *field;
  std::vector<Mover> movers;
  std::vector<Grain> grains;
  std::vector<Entry> entries;
  std::vector<double> sums;    // [node][8] volume of grains; buoyancy; coefficients; drag
  double force_now[6];         // drag and buoyancy on the grains of this rank, impulses
  int count;
  double dt_last;

  bool is_grain(int i) const;
  template <class F> bool visit(int i, const F &) const;
  void find_grains(double dt);
  void sum_nodes(int lane, int nlane);
  double drag_coefficient(double diameter, double slip, double solid) const;
};

}    // namespace LAMMPS_NS
#endif
#endif
