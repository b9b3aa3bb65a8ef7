/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_GRAINS_H
#define LMP_MPM_FLOW_GRAINS_H

#include "lattice/staggered.h"
#include "mpm_flow_lattice.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMImmersed;

/** Grains smaller than a cell in an incompressible flow, with the laws of fix mpm/immersed: the flow is the flux of volume of
 *  fluid and grains together, which has no divergence, and a grain feels the force F = K (U - v) + rho V (dU/dt - g).
 *
 *  This is solved for together with the pressure. A grain that no flow changes in the step feels F0, and with the velocity v of
 *  the end of the step F is linear in what the step changes of the flow,
 *
 *    F = F0 + b sum_f W_f (U'_f - U_f),    sum_f W_f = 1,
 *
 *  with U at the start of the step, U' at its end, and faces f. A face gets -W_f [F0 + b (U'_f - U_f)], which is opposite to F in the sum
 *  over faces, whatever velocities do, and leaves each face an equation of its own: what the grains around it resist is a factor of
 *  the gradient of the pressure there (mobility). A step is as long as one likes, and a steady flow has the same forces for any step: the
 *  difference to a force that is shared by W_f alone is that of changes of the velocity in a step, around their mean at the grain.
 *
 *  W_f are the functions of the velocity, so that a grain sees the flow that points move with, times the share of the face that is
 *  filled, where this is less than a half. */
class MPMFlowGrains : protected Pointers {
 public:
  /** flow: ID of the fix of the fluid, of which this is the density. */
  MPMFlowGrains(class LAMMPS *, MPMFlowLattice &, const std::string &flow, double density);
  bool any() const { return !fixes.empty(); }
  /** Grains of this rank, around which there are to be cells; before these are found. */
  void list();
  /** sums: of give_to_cells(). share: of cells that is filled. before: velocities at the start of the step. velocity: these
   *  with viscosity and other forces; gets the force of the grains, as far as it does not depend on the pressure. */
  void begin(double duration, const std::vector<double> &sums, const std::vector<double> &share,
             const std::vector<double> &before, std::vector<double> &velocity);
  /** Share of the gradient of the pressure, as a change of the velocity, that accelerates a face [cell][dim]. */
  const std::vector<double> &mobility() const { return share_of_gradient; }
  /** Velocities at the end of the step: grains get what is theirs. */
  void end(const std::vector<double> &velocity);
  /** Force of grains on the fluid that walls hold, outwards, in units of mass, less what of the force on the fluid next to these comes twice
   *  into a pressure that goes on linearly to the wall; the share of this rank. velocity: at the end of the step. */
  double at_wall(int axis, int side, const std::vector<double> &before,
                 const std::vector<double> &velocity) const;

  double memory_usage() const;

 private:
  struct Kind {
    int count;
    double impulses[6];    // of drag and of buoyancy
  };
  struct Grain {
    int i, kind, slot;
    MPM_NS::StaggeredWeights w;
    double of_weights[3];    // their sums
    double before[3];        // velocity of the flow at the start of the step
    double immersed;         // share of it that is in the fluid
    double mass;             // infinite: held
    double least[3];         // force F0
    double rate;             // b
    double displaced;        // mass of fluid
  };
  const double density;
  MPMFlowLattice &cells;
  std::vector<Kind> kinds;
  std::vector<FixMPMImmersed *> fixes;
  std::vector<int> kind_of;    // of the visitors of the lattice
  std::vector<Grain> grains;
  std::vector<double> filled;    // [cell][dim] factor of weights
  std::vector<double> solid;     // [cell] share of its volume that grains take up
  std::vector<double> sums;      // [cell][3 dim + 1] -, b, and F0 at faces, volume of grains
  std::vector<double> share_of_gradient;
  double duration = 0.0;

  template <int dim> bool find(Grain &, const std::vector<double> &share) const;
  template <int dim> void add_volume(const Grain &);
  template <int dim> double share_around(const Grain &, double *moment) const;
  template <int dim> void find_force(Grain &);
  template <int dim>
  void find_all(const std::vector<double> &share, const std::vector<double> &before);
  template <int dim> void go_on(const std::vector<double> &velocity);
  template <int dim> void interpolate(const Grain &, const double *values, double *v) const;
  void find_filled(const std::vector<double> &of_points);
};

}    // namespace LAMMPS_NS
#endif
