/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TANGENT_H
#define LMP_MPM_TANGENT_H

#include "diffusion/mpm_node_scalar.h"
#include "implicit/mpm_trial_motion.h"

#include <functional>
#include <memory>
#include <vector>

namespace MPM_NS {
struct Tangent;
}

namespace LAMMPS_NS {
class MPMTrialForces;

/** Stress of the points of a field after a motion that is only tried (MPMTrialMotion), and its
 *  derivative with respect to that motion. Material laws work on copies of the state of points:
 *  nothing is kept until the step itself moves them. */
class MPMTangent : public MPMTrialMotion {
 public:
  MPMTangent(class LAMMPS *lmp, MPMField &field);
  ~MPMTangent() noexcept override;

  /** Start of a run. */
  void init();
  /** External forces of all points in this step, from atom->f. Must be called first in each step.
   *  Collective. */
  void external_forces(double *force);
  /** A point of which only a share has stress and loads that follow: walls carry the rest in this
   *  step. */
  struct CarriedPoint {
    bigint point;
    double share;
  };
  /** Sets these points for the present step. */
  void set_carried(std::vector<CarriedPoint> list) { carried = std::move(list); }
  /** External forces on the rest of these points, from atom->f. Collective. */
  void forces_on_carried(double *force);
  /** Forces of the stress after the motion u. size: sum of V |P| / h over the points of this
   *  rank, the size of the forces that cancel in equilibrium [mass acceleration]. Returns false, on
   *  all ranks, if a point is turned inside out or has a stress that is not finite. Collective. */
  bool forces(const double *u, double dt, double *force, double &size);

  /** Finds dP/dH of all points at the motion u, from the tangents of materials that have one, and
   *  from central differences for the others. Returns the sum of V |dP/dH| / h over all points,
   *  with the largest entry of each: a uniform strain e makes forces of e times this sum, which
   *  cancel. Collective. */
  double linearize(const double *u, double dt);
  /** Change of the forces for a small change du of that motion. Collective. */
  void change_of_forces(const double *du, double *dforce)
  {
    change_of_forces(du, dforce, nullptr, nullptr);
  }
  /** The same with the changes dp [n] of a pressure that points have besides their stress. It also
   *  finds the changes dV [n] of their volumes. */
  void change_of_forces(const double *du, double *dforce, const double *dp, double *dV);
  /** A pressure in the forces of points besides their stress, [n], compression positive; null:
   *  none. As a Cauchy stress, it acts on the points as they are after the motion. Set it before
   *  forces() and linearize(). */
  void set_pressure(const double *of_points) { pressure = of_points; }
  /** Should linearize() also keep the tangents of the stress without this pressure? */
  void keep_without_pressure(bool keeps) { keeps_stress = keeps; }
  /** Should products, blocks, and points be those of the stress without this pressure from now on?
   *  These tangents must have been kept. Otherwise they include the pressure. */
  void leave_out_pressure(bool leaves) { of_stress = leaves; }
  /** Changes of the volumes of points by the motion u, [n], as for points with such a pressure. In
   *  the plane and in space only. Collective. */
  void volume_changes(const double *u, double *dV);
  /** [n] Moduli of points for compression without lateral strain, from their tangents, averaged
   *  over the axes [pressure]. */
  void find_moduli(std::vector<double> &moduli) const;
  /** Minus the change of the force on each node due to its own motion alone: [node][dim][dim].
   *  Collective. */
  void diagonal(std::vector<double> &blocks);
  /** Forces of loads that follow the deformation after the motion u, minus those in atom->f.
   *  Collective. */
  void loads(const double *u, double *force);
  /** Are there such loads on any rank? Known after external_forces(). */
  bool has_loads() const { return loaded; }
  /** Contribution of one point to the system: the n nodes that it reaches, [n][ngrad] gradients of
   *  their functions, and [dim ngrad][dim ngrad] minus the change of its force with H, with row and
   *  column l*dim + a for H_al, in the units of forces. */
  using UsePoint = std::function<void(int n, const int64_t *nodes, int ngrad,
                                      const double *gradient, const double *stiffness)>;
  /** Calls a function for all points of this rank, those of a block one after the other. With an
   *  axis of symmetry ngrad is dim + 1, and the last entry is that of H_zz, which depends on the
   *  first component alone. */
  void each_point(const UsePoint &) const;
  /** Averages of the pressure (locking pressure) resist the changes b of the volume around nodes.
   *  These are the sums of this rank's points for SplineMultigrid::add_mean(); each_point() leaves
   *  them out. around: the node; material: its number; changes: [n][dim]. */
  using UseMean = std::function<void(int64_t around, int material, const double sums[3], int n,
                                     const int64_t *nodes, const double *changes)>;
  void each_mean(const UseMean &) const;
  /** Asymmetry of the system: largest |dP_k/dH_l - dP_l/dH_k| of all points over their largest
   *  entry, that of forces between points, or the largest derivative with respect to H of forces on
   *  points over the largest V |dP/dH| / h. The largest of these is returned. Collective. */
  double asymmetry() const;

  double memory_usage() const;

 private:
  std::unique_ptr<MPM_NS::Tangent> tangent;    // of the batch
  std::vector<double> history, tangents, no_force, sum_forces, point_forces;
  std::vector<CarriedPoint> carried;
  bool loaded = false;    // do any points have loads that follow them?
  // [point][3] forces of these loads in addition to atom->f, and [point][nH][3] their derivatives
  // with respect to H, if there are any
  std::vector<double> load_forces, load_tangents;

  // step of the central differences of a gradient: with it, the error by the third derivatives of a
  // law and the round-off of its stress are both some 1e-10 of its tangent
  static constexpr double DIFFERENCE = 6.0e-6;

  // forces between points, see MPMTrialForces: of elements, then of loads
  std::vector<MPMTrialForces *> between;
  std::size_t nelements = 0;

  // pressures besides the stress: averages around points, or that of nodes. Mean stress of points
  // and, after linearize(), its derivatives with respect to H [point][nH]; what is added to it; J G
  // [point][nH] with G = F^-T of the places
  std::vector<double> mean_stress, mean_tangents, added, volume_gradients;
  std::vector<double> volumes;    // of points at the start of the step, weights of averages
  MPMNodeScalar means;
  const bool averages;
  const double *pressure = nullptr;
  bool keeps_stress = false, of_stress = false;
  std::vector<double> stress_tangents;    // without the pressure

  const std::vector<double> &present() const { return of_stress ? stress_tangents : tangents; }
  bool stress(const MPMPointMap::Run &, int first, int n, const double *H, double dt, double *P,
              MPM_NS::Tangent *tangent = nullptr);
  void keep_stress(int first, int n, const double *stresses);
  bool add_between(std::size_t from, const double *u, double &size);
  void reduce_carried();
  void differentiate(const MPMPointMap::Run &, int first, int n, const double *H, double dt);
  void take_differences(const MPMPointMap::Run &, int first, int n, const double *H, double dt);
  bool adds() const { return averages || pressure; }
  void find_volume_gradient(const double *F, double *g) const;
  void add_averages(const double *u);
  void add_to_stress(const double *u);
  void differentiate_added(int first, int n, const double *H);
  void average(const MPMNodeScalar::TakeValues &take);
  void average_changes();

  void find_loads();
  bool follows(int first, int n) const;
  void load_points(int first, int n, const double *H, double *P);
  void differentiate_loads(int first, int n, const double *H);
  double asymmetry_of_loads() const;
};

}    // namespace LAMMPS_NS
#endif
