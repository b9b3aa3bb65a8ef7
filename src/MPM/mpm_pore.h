/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_H
#define LMP_MPM_PORE_H

#include "mpm_layer_mean.h"
#include "mpm_node_pressure.h"
#include "mpm_node_scalar.h"
#include "mpm_pore_motion.h"
#include "mpm_pore_soil.h"
#include "mpm_pore_suction.h"
#include "mpm_pore_surface.h"
#include "mpm_rows.h"
#include "pointers.h"

#include <limits>
#include <memory>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;

/** Pore water in the points of one field: the pressures of nodes, their rates by the motion of the soil and
 *  by flow, and the pressure in internal forces.
 *
 *  Points keep rows of 1 + dim reals: the pressure (above that of the air, compression is positive) and
 *  its gradient. */
class MPMPore : public MPMNodePressure, protected Pointers {
 public:
  MPMField &field;
  MPMNodeScalar nodes;
  MPMPoreSurface surface;
  std::unique_ptr<MPMPoreMotion>
      motion;    ///< null: water has no inertia relative to the soil (u-p)

  /** gravity: force per mass that the water has, too. */
  MPMPore(class LAMMPS *, MPMField &, const MPMPoreWater &, const MPMPoreSurface::Conditions &,
          const double *gravity, double relax, bool moves);

  /** Start of a run: the soils that points of this field have. content: of points, if there is a soil that
   *  can dry (MPMPoreSuction). warmth: temperatures of points up to which their water has expanded, if there is a soil that warms.
   *  Collective. */
  void init(const std::vector<MPMPoreSoil> &, double *const &content, double *const &warmth);
  /** A temperature that is not known yet. */
  static constexpr double UNKNOWN = -1.0e300;
  bool has_water() const { return !soils.empty(); }

  /** Water flows in one of several steps, for the time of all of them (mpm_pore_wait.cpp). ratios: [n] J after the last flow, 0 where it
   *  is not known; without this call it flows in each. Before init(). */
  void wait_with(double *const &ratios) { waiting = &ratios; }
  /** Before points go to nodes in a step without flow: what forces have. */
  void begin_wait(const MPMRows &state);
  /** What the pressure of a point has changed since the last flow, as no water left it. */
  double undrained(int i) const;

  /** The water of points of soils that can dry, where it is not yet known. */
  void weigh_points(const MPMRows &state) const;
  /** Gradients of points whose pressures alone were given; those of a linear pressure are exact.
   *  Collective. */
  void find_gradients(const MPMRows &state, const double *formula);
  /** Before points go to nodes: pressures of nodes, and what forces have of them. formula: [n]
   *  permeabilities of points, or null. waited: it is the flow for several steps. */
  void begin_step(const MPMRows &state, const MPMRows &flow, const double *formula, bool waited);
  /** [n] J times the pressure in internal forces; null: there is none. */
  const double *pressure_in_forces() const { return has_water() ? in_forces.data() : nullptr; }
  /** See MPMPhysics::surface_force(). */
  void find_surface_force(const MPMRows &state, const std::vector<char> &near,
                          std::vector<double> &force) const;
  /** Forces of points on nodes, [node][3], where marked in near, of the water and of soil and water together. For the former the
   *  water has the pressure outside where the free surface is open to one: it is that at the surface. Collective. */
  void find_forces_below_surface(const std::vector<char> &near, std::vector<double> &of_water,
                                 std::vector<double> &of_all) const;
  /** The velocities of a step with flow are known; duration: of the flow. */
  void take_motion(double duration);
  /** Does that move and strain the points, too? Nothing in the flow of the step looks at their deformation after it then. */
  bool moves_first() const;
  /** If the water has inertia: nodes have mass, momentum, and forces, summed over ranks. */
  void take_off();
  /** The same: after take_motion(). */
  void move_water();
  /** Rates of the pressures of nodes; adds the volumes of water that come in for each time, and the power
   *  of what comes in and of the weight of water that flows. */
  void find_rates(std::vector<double> &inflow);
  /** Pressures of points after a flow of this duration, and the mass of the water that they got. */
  void end_step(const MPMRows &state, double duration);

  /** Implicit steps of soil and water together (mpm_pore_implicit.cpp): in the place of stages of find_rates(), when the velocities that
   *  were solved for are those of nodes. Adds the volumes of water that come in for each time, as find_rates(). Collective. */
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

  /** Bounds of the eigenvalues of minus the rates [1/time] on this rank: by flow between points, and
   *  through the surface, in this step. */
  double conduction_rate() const;
  double exchange_rate() const { return exchange; }
  /** The greatest spacing of this rank's points, the root of their volume, in node spacings; where water waits, of the last step. */
  double widest_spacing() const;
  /** How points of a soil lie between nodes. */
  struct Layers {
    double volume = 0.0;
    double steep[3] =
        {};    ///< volume times the square of the slope of an alternating velocity, in cells, along each axis
  };
  /** Of this rank's points in the last step, by soil, where water waits. */
  const std::vector<Layers> &layers_of_points() const { return lie; }
  /** By flow between points at present; -1 without any that have water. Those with a formula, which is
   *  evaluated in steps, count as 0. tag: of the point that limits it. */
  double conduction_rate(const MPMRows &state, tagint &tag) const;
  /** Wave speed of a point where water cannot flow, c: of the soil alone; p: pressure of its water. */
  double wave_speed(int i, double p, double c) const;
  const MPMPoreSoil *soil_of(int i) const;
  /** The lowest tag of this rank's points whose pores were shut in the last begin_step(), MAXTAGINT: there are none. */
  tagint shut_point() const { return shut; }

  /** What a flow for this time takes from smooth pressures of points, as nodes do not see all of them. */
  struct Smoothing {
    static constexpr double WAVELENGTH = 12.0;    ///< of a pressure, in node spacings
    double share;                                 ///< of its amplitude that is lost
    double over_flow;                             ///< that over what flow takes; 0: not known
  };
  Smoothing smoothing(double duration) const;

  /** Of pressures of points after a flow: the square of the slope that drives it times the diffusivity, and the range of pressures. */
  struct Slopes {
    double steepest = 0.0, highest = -std::numeric_limits<double>::max(), less = highest;
  };
  void add_slopes(const MPMRows &state, Slopes &sum) const;

  /** Of this rank's points at the start of a step with flow, what tells whether the acceleration counts that u-p leaves out. */
  struct Inertia {
    double velocity =
        0.0;    ///< the power below if the square of the velocity of points were that of their acceleration, times its unit
    double flow = 0.0;    ///< power that the resistance to the flow takes
    double gradient =
        0.0;    ///< what it would take if nothing but the gradient of the pressure drove water, not its weight
    double kinetic = 0.0;    ///< energy of the motion of soil and water
    void add(const Inertia &more)
    {
      velocity += more.velocity;
      flow += more.flow;
      gradient += more.gradient;
      kinetic += more.kinetic;
    }
  };
  /** After begin_step(). */
  Inertia inertia(const MPMRows &state) const;

  double memory_usage() const;

 private:
  struct Soil {
    const FixMPMMaterial *fix;
    MPMPoreSoil of;
    int temperature;    // column of the history of its material, -1: it does not expand
  };
  const MPMPoreWater &water;
  const double *const gravity;
  const double relax;                  // of points, in the rate at which waves cross a cell
  double *const *waiting = nullptr;    // J after the last flow; null: water flows in each step
  bool after_wait = false;             // is the flow of this step for several steps?
  std::vector<Soil> soils;
  double steepest =
      0.0;                 // of the shape functions: greatest sum of N'^2/N along an axis, in cells
  double slowest = 0.0;    // smallest mobility over storage of a soil
  double least_storage = 0.0;
  double of_storage =
      0.0;    // greatest share of the storage of water and grains in that with an elastic soil
  double waves = 0.0;      // smallest wave speed by the stiffness of the water in a soil
  double fastest = 0.0;    // largest of the points in the last step
  tagint shut = MAXTAGINT;
  double exchange = 0.0;    // rate of exchange through the surface in the last step
  double largest = 0.0;     // volume of the points in the last step, where water waits
  std::vector<Layers> lie;
  std::unique_ptr<MPMPoreSuction> suction;    // of soils that can dry
  std::unique_ptr<MPMLayerMean>
      layers;    // soils differ in permeability; null: points have their own

  // of points in this step

  std::vector<double> in_forces;      // [n]
  std::vector<double> capacity;       // [n] storage times volume
  std::vector<double> conductance;    // [n] mobility times volume
  std::vector<double> mean;           // [n] pressure by the nodes, at the start
  std::vector<double> grown, warm;    // [n] by warmth in this step, volume; its temperature
  double *const *warmth = nullptr;    // null: no soil warms
  std::vector<double>
      squeezed;    // [n] volume; after take_motion() rate at which this drives water out
  std::vector<double> quadratic;    // [n] of the resistance, if there is any
  std::vector<double> volumes;      // [n] with layers, times the relative permeability
  std::vector<double> linear_mean,
      quadratic_mean;             // [n] with layers: resistances across interfaces
  std::vector<double> of_flow;    // [node][8] next to the surface
  std::vector<double> unseen;     // [node] by points, what nodes do not see of their pressures

  // of an implicit step

  struct Solve {
    double dt;
    double keep;    // share of what nodes do not see of points that is left after the step
    std::vector<double> start, capacity;    // [node], also of images
    std::vector<double> biot;               // [n]
    std::vector<double> gradient;           // [n][3] of the pressure at the start
    std::vector<double> smoothing;    // [n] volume times what keeps pressures from alternating
    std::vector<double> more;    // [n] pressure that water left over from the solution would have
    double carried;              // by flow, for each time
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
