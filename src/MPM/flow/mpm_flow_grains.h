/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_GRAINS_H
#define LMP_MPM_FLOW_GRAINS_H

#include "flow/mpm_flow_lattice.h"
#include "lattice/staggered.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMImmersed;

/** Grains smaller than a cell in an incompressible flow, with the laws of fix mpm/immersed. The
 *  flow is the flux of volume of fluid and grains together, which has no divergence, and a grain
 *  feels the force F = K (U - v) + rho V (dU/dt - g).
 *
 *  The forces are found together with the pressure. F0 is the force if the flow does not change in
 *  the step. With the velocity v at the end of the step, F is linear in the change of the flow in
 *  the step,
 *
 *    F = F0 + b sum_f W_f (U'_f - U_f),    sum_f W_f = 1,
 *
 *  with U at the start of the step, U' at its end, and faces f. A face gets the force -W_f [F0 + b
 *  (U'_f - U_f)]. The sum over faces is opposite to F for any velocities, and each face has an
 *  equation of its own: the resistance of the grains around it is a factor of the gradient of the
 *  pressure there (mobility). So a step may be of any length, and a steady flow has the same forces
 *  for any step. The difference to sharing F by W_f alone is only due to changes of the velocity in
 *  a step that differ from their mean at the grain.
 *
 *  W_f are the shape functions of the velocity, so that a grain sees the flow with which points
 *  move, times the share of the face that is filled, where this is less than a half. */
class MPMFlowGrains : protected Pointers {
 public:
  /** flow: ID of the fix of the fluid; density: of the fluid. */
  MPMFlowGrains(class LAMMPS *, MPMFlowLattice &, const std::string &flow, double density);
  bool any() const { return !fixes.empty(); }
  /** Lists the grains of this rank, around which cells are needed, in the order of tags, so that
   *  sums do not depend on the order of atoms. To be called before cells are found. */
  void list();
  /** Start of a step. sums: of give_to_cells(). share: [cell] share that is filled. before:
   *  [cell][dim] velocities at the start of the step. velocity: the same after viscosity and other
   *  forces; gets the part of the force of the grains that does not depend on the pressure. */
  void begin(double duration, const std::vector<double> &sums, const std::vector<double> &share,
             const std::vector<double> &before, std::vector<double> &velocity);
  /** [cell][dim] share of the gradient of the pressure, as a change of the velocity, that
   *  accelerates a face. */
  const std::vector<double> &mobility() const { return face_mobility; }
  /** End of a step: applies the forces to the grains. velocity: [cell][dim] at the end of the
   *  step. */
  void end(const std::vector<double> &velocity);
  /** Force of grains on the faces in a wall of the box, positive outwards [mass velocity/time],
   *  less the part of the force on the next faces that counts twice when the pressure is
   *  extrapolated linearly to the wall; the share of this rank. before, velocity: at the start and
   *  end of the step. */
  double at_wall(int axis, int side, const std::vector<double> &before,
                 const std::vector<double> &velocity) const;

  double memory_usage() const
  {
    return MPM_NS::bytes_of(filled, solid, sums, face_mobility, grains, kind_of);
  }

 private:
  struct Kind {
    int count;
    double impulses[6];    // of drag and of buoyancy
  };
  struct Grain {
    int i, kind, slot;
    MPM_NS::StaggeredWeights w;
    double weight_sums[3];    // sums of weights, by component
    double before[3];         // velocity of the flow at the start of the step
    double immersed;          // share of the grain that is in the fluid
    double mass;              // infinite: the grain is held
    double least[3];          // force F0
    double rate;              // b
    double displaced;         // mass of fluid
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
  std::vector<double> face_mobility;
  double duration = 0.0;

  template <int dim> bool find(Grain &, const std::vector<double> &share) const;
  template <int dim> void add_volume(const Grain &);
  template <int dim> double share_around(const Grain &, double *moment) const;
  template <int dim> void find_force(Grain &);
  template <int dim>
  void find_all(const std::vector<double> &share, const std::vector<double> &before);
  template <int dim> void go_on(const std::vector<double> &velocity);
  template <int dim> void interpolate(const Grain &, const double *values, double *v) const;
  void find_filled(const std::vector<double> &point_sums);
};

}    // namespace LAMMPS_NS
#endif
