/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_H
#define LMP_MPM_PORE_H

#include "base/mpm_rows.h"
#include "diffusion/mpm_layer_mean.h"
#include "diffusion/mpm_node_scalar.h"
#include "field/mpm_forces.h"
#include "pointers.h"
#include "pore/mpm_pore_motion.h"
#include "pore/mpm_pore_soil.h"
#include "pore/mpm_pore_suction.h"
#include "pore/mpm_pore_surface.h"

#include <limits>
#include <memory>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;

/** Pore water in the points of one field: the pressures of nodes, their rates from the motion of
 *  the soil and from flow, and the pressure in internal forces.
 *
 *  Points keep rows of 1 + dim reals: the pressure (relative to that of the air, compression
 *  positive) and its gradient. */
class MPMPore : public MPMNodePressure, protected Pointers {
 public:
  MPMField &field;
  MPMNodeScalar nodes;
  MPMPoreSurface surface;
  std::unique_ptr<MPMPoreMotion>
      motion;    ///< null: water has no inertia relative to the soil (u-p)

  /** gravity: force per mass, which acts on the water, too. */
  MPMPore(class LAMMPS *, MPMField &, const MPMPoreWater &, const MPMPoreSurface::Conditions &,
          const double *gravity, double relax, bool moves);

  /** Start of a run: set the soils of the points of this field. content: water of points, used if a
   *  soil can dry (MPMPoreSuction). warmth: temperatures up to which the water of points has
   *  expanded, used if a soil warms. Collective. */
  void init(const std::vector<MPMPoreSoil> &, double *const &content, double *const &warmth);
  /** Marks a temperature that is not known yet. */
  static constexpr double UNKNOWN = -1.0e300;
  /** Are there soils in this field? */
  bool has_water() const { return !soils.empty(); }

  /** Let water flow only in one of several steps, for the duration of all of them
   *  (mpm_pore_wait.cpp). ratios: [n] J after the last flow, 0 where it is not known. Without this
   *  call water flows in each step. Call before init(). */
  void wait_with(double *const &ratios) { waiting = &ratios; }
  /** In a step without flow, before points go to nodes: find the pressure in forces. */
  void begin_wait(const MPMRows &state);
  /** Change of the pressure of a point since the last flow, by deformation while no water left
   *  it. */
  double undrained(int i) const;

  /** Sets the water of points of soils that can dry, where it is not yet known. */
  void weigh_points(const MPMRows &state) const;
  /** Finds the gradients of points for which only pressures were given. Those of a linear pressure
   *  are exact. Collective. */
  void find_gradients(const MPMRows &state, const double *formula);
  /** Before points go to nodes: find the pressures of nodes, and the pressure in forces. formula:
   *  [n] permeabilities of points, or null. waited: this flow stands for several steps. */
  void begin_step(const MPMRows &state, const MPMRows &flow, const double *formula, bool waited);
  /** [n] J times the pressure in internal forces; null: there is none. */
  const double *pressure_in_forces() const { return has_water() ? in_forces.data() : nullptr; }
  /** See MPMPorePressure::surface_force(). */
  void find_surface_force(const MPMRows &state, const std::vector<char> &near,
                          std::vector<double> &force) const;
  /** Forces of points on nodes, [node][3], at nodes of blocks marked in near: of the water alone,
   *  and of soil and water together. Where the free surface is open to a pressure outside, the
   *  water has this pressure in of_water: it is the pressure at the surface. Collective. */
  void find_forces_below_surface(const std::vector<char> &near, std::vector<double> &of_water,
                                 std::vector<double> &of_all) const;
  /** Call when the velocities of a step with flow are known. duration: of the flow. */
  void take_motion(double duration);
  /** Does take_motion() also move and strain the points? Then the rest of the flow of the step does
   *  not use their deformation. */
  bool moves_first() const;
  /** Only if the water has inertia: call when nodes have mass, momentum, and forces, summed over
   *  ranks. */
  void separate_water();
  /** Only if the water has inertia: call after take_motion(). */
  void move_water();
  /** Finds the rates of the pressures of nodes. Adds to inflow the volumes of water that come in
   *  per time, and the power of this water and of the weight of water that flows. */
  void find_rates(std::vector<double> &inflow);
  /** Updates the pressures of points after a flow of this duration, and their mass by the water
   *  that they got. */
  void end_step(const MPMRows &state, double duration);

  /** Implicit steps of soil and water together (mpm_pore_implicit.cpp). take_solution() replaces
   *  the stages of find_rates() when nodes have the velocities of the solution. Like find_rates(),
   *  it adds to inflow the volumes of water that come in per time. Collective. */
  void take_solution(std::vector<double> &inflow);
  void begin_solve(double dt, bool inertial) override;
  const std::vector<double> &values_at_start() const override { return solve->start; }
  const std::vector<double> &capacities() const override { return solve->capacity; }
  void to_points(const std::vector<double> &p, double *of_points) override;
  double find_residual(const std::vector<double> &p, const double *dV, double *r) override;
  double response() const override;
  void find_changes(const double *p, const double *dV, double *y) override;
  void find_softness(const std::vector<double> &moduli, std::vector<double> &softness) override;
  void each_term(const std::vector<double> &softness, const Term &) override;
  void end_solve(const std::vector<double> &p) override { nodes.value = p; }

  /** Bounds of the eigenvalues of minus the rates in this step [1/time], on this rank:
   *  conduction_rate() of the flow between points, exchange_rate() of the flow through the
   *  surface. */
  double conduction_rate() const;
  double exchange_rate() const { return exchange; }
  /** The greatest spacing of this rank's points (the root of their volume) in the last step, in
   *  node spacings. Only if water waits, see wait_with(). */
  double widest_spacing() const;
  /** Positions of the points of a soil between the nodes. */
  struct Layers {
    double volume = 0.0;
    /** volume times the square of the slope of an alternating velocity, in cells, along each
     *  axis */
    double steep[3] = {};
  };
  /** Of this rank's points in the last step, by soil. Only if water waits. */
  const std::vector<Layers> &layers_of_points() const { return lie; }
  /** Bound of the rate by flow between points at present; -1 if no point has water. Points whose
   *  permeability is a formula, which is evaluated only in steps, count as 0. tag: ID of the point
   *  that limits it. */
  double conduction_rate(const MPMRows &state, tagint &tag) const;
  /** Wave speed of a point whose water cannot flow. c: wave speed of the soil alone; p: pressure of
   *  its water. */
  double wave_speed(int i, double p, double c) const;
  /** The soil of point i, or null if it has no water. */
  const MPMPoreSoil *soil_of(int i) const;
  /** The lowest tag of this rank's points whose pores were shut in the last begin_step(); MAXTAGINT
   *  if there are none. */
  tagint shut_point() const { return shut; }

  /** How much of smooth pressures of points a flow of this duration removes because nodes do not
   *  see all of them. */
  struct Smoothing {
    static constexpr double WAVELENGTH = 12.0;    ///< of a pressure, in node spacings
    double share;        ///< share of the amplitude of such a pressure that is lost
    double over_flow;    ///< ratio of this loss to what flow removes; 0: not known
  };
  Smoothing smoothing(double duration) const;

  /** Pressures of points after a flow: the square of the slope that drives the flow times the
   *  diffusivity, the highest pressure, and less, minus the lowest pressure. */
  struct Slopes {
    double steepest = 0.0, highest = -std::numeric_limits<double>::max(), less = highest;
  };
  void add_slopes(const MPMRows &state, Slopes &sum) const;

  /** Sums over this rank's points at the start of a step with flow. They show whether the
   *  acceleration counts that u-p neglects. */
  struct Inertia {
    /** power below if v were the acceleration, times its unit: sum of K (rho_f v)^2 */
    double velocity = 0.0;
    double flow = 0.0;    ///< power that the resistance to the flow takes
    /** power that it would take if only the gradient of the pressure drove water, not its weight */
    double gradient = 0.0;
    double kinetic = 0.0;    ///< kinetic energy of soil and water
    void add(const Inertia &more)
    {
      velocity += more.velocity;
      flow += more.flow;
      gradient += more.gradient;
      kinetic += more.kinetic;
    }
  };
  /** Call after begin_step(). */
  Inertia inertia(const MPMRows &state) const;

  double memory_usage() const;

 private:
  struct Soil {
    const FixMPMMaterial *fix;
    MPMPoreSoil of;
    int temperature;    // column in the history of its material, -1: it does not expand
  };
  const MPMPoreWater &water;
  const double *const gravity;
  const double relax;    // relaxation of points, in units of the rate at which waves cross a cell
  double *const *waiting = nullptr;    // J after the last flow; null: water flows in each step
  bool after_wait = false;             // does the flow of this step stand for several steps?
  std::vector<Soil> soils;
  double steepest = 0.0;    // greatest sum of N'^2/N of the shape functions along an axis, in cells
  double slowest = 0.0;     // smallest ratio of mobility and storage of a soil
  double least_storage = 0.0;
  // greatest ratio of the storage of water and grains to the storage with an elastic soil
  double of_storage = 0.0;
  double waves = 0.0;    // smallest wave speed of a soil from the stiffness of its water
  // greatest ratio of conductance and capacity of the points in the last step
  double fastest = 0.0;
  tagint shut = MAXTAGINT;
  double exchange = 0.0;    // rate of exchange through the surface in the last step
  double largest = 0.0;     // largest volume of a point in the last step, if water waits
  std::vector<Layers> lie;
  std::unique_ptr<MPMPoreSuction> suction;    // of soils that can dry
  std::unique_ptr<MPMLayerMean>
      layers;    // if soils differ in permeability; null: each point uses its own

  // of points in this step

  std::vector<double> in_forces;      // [n]
  std::vector<double> capacity;       // [n] storage times volume
  std::vector<double> conductance;    // [n] mobility times volume
  std::vector<double> mean;           // [n] pressure interpolated from the nodes, at the start
  std::vector<double> grown, warm;    // [n] growth of volume by warmth in this step; temperature
  double *const *warmth = nullptr;    // null: no soil warms
  std::vector<double>
      squeezed;    // [n] volume; after take_motion() rate at which deformation drives water out
  std::vector<double> quadratic;    // [n] of the resistance, if any point has such a term
  std::vector<double> volumes;      // [n] with layers, times the relative permeability
  std::vector<double> linear_mean,
      quadratic_mean;             // [n] with layers: resistances across interfaces
  std::vector<double> of_flow;    // [node][8] at nodes next to the surface
  std::vector<double> unseen;     // [node] mean of what nodes do not see of the pressures of points

  // of an implicit step

  struct Solve {
    double dt;
    double keep;    // share of the pressure of points not seen by nodes that is left after the step
    std::vector<double> start, capacity;    // [node], also of images
    std::vector<double> biot;               // [n]
    std::vector<double> gradient;           // [n][3] of the pressure at the start
    std::vector<double> smoothing;    // [n] volume times what keeps pressures from alternating
    std::vector<double> more;         // [n] pressure of the water that the solution leaves over
    double carried;                   // volume that flow moves, per time
  };
  std::unique_ptr<Solve> solve;    // null: explicit steps

  void conduct(int i, double *q) const;
  double undrained(const Soil &, int i, double J) const;
  void gather(const Soil &, int first, int n, const double *J, const MPMRows &state);
  void look_at_layers(Layers &, int first, int n, const double *V) const;
  void find_shut(const MPMPoreSoil &, int first, int n, const double *J);
  void init_layers();
  void find_layers(const MPMRows &state, const double *formula);
  void expand(const Soil &, int first, int n, const double *J, const double *V);
  void limit_slopes(const Soil &, int first, int n, const MPMRows &state,
                    MPMNodeScalar::Rows) const;
  void points_to_nodes(const MPMRows &state, const double *formula);
  const Soil *soil(const FixMPMMaterial *) const;
  double rate_of_waves() const;
  double rate_of_lag() const;
  double mobility(const Soil &, int i, double J, const double *formula) const;
  double weight(int d) const;
  MPMPoreResistance at_interface(int i) const;
  double most_of_layers(int i, double k) const;
  MPMPoreMotion::Pores pores(const Soil &, int i, double J, double mobility) const;
  double at_surface(const Soil &, int i, double J, double mobility, const double *row) const;
};

}    // namespace LAMMPS_NS
#endif
