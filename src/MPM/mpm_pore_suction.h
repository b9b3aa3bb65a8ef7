/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_SUCTION_H
#define LMP_MPM_PORE_SUCTION_H

#include "lattice/grid.h"
#include "mpm_node_scalar.h"
#include "mpm_pore_soil.h"
#include "mpm_pore_surface.h"
#include "mpm_rows.h"
#include "pointers.h"

#include <cmath>
#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Pores of a soil that hold the volume of water w for each volume of pores, at the pressure p,
 *
 *    w = S(p) exp(p/K)   (p < 0),    w = S_s (1 + p/K)   (p >= 0),
 *
 *  and w n for each volume of soil: w is one for full pores of water without pressure. */
struct MPMPoreMoisture {
  double filling;     ///< w
  double storage;     ///< n dw/dp [1/pressure]
  double relative;    ///< permeability in that of full pores
  double bishop;      ///< share of the pressure in the effective stress

  static MPMPoreMoisture at(const MPMPoreSoil &, double J, double p, const MPMPoreWater &);
  /** The pressure of water that fills the pores so far. before: the last one; guess: near it. Soil that has
   *  less water than at 100/alpha has that suction, or what it had before. */
  static double pressure(const MPMPoreSoil &, double filling, double before, double guess,
                         const MPMPoreWater &);
  /** What a volume of soil stores: the integral of p times its storage, from zero [pressure]. */
  static double energy(const MPMPoreSoil &, double J, double p, const MPMPoreWater &);
};

/** Partly saturated soil in one field: what points have of water besides its pressure, and what this changes
 *  in the sums over points. See mpm_pore_suction.cpp. */
class MPMPoreSuction : protected Pointers {
 public:
  /** content: [n] volume of water of each point, negative where it is not yet known. */
  MPMPoreSuction(class LAMMPS *, MPMField &, const MPMPoreWater &, double *const &content);

  /** Points whose water is not yet known get it from their pressure, and lose the mass of what is missing in
   *  their pores. */
  void weigh(int i, const MPMPoreSoil &, double p) const;

  /** A step, or one more sum over points. Rates at which points with full pores take the pressure of nodes
   *  [1/time]: usual, of which waves make this part. */
  void begin(int nmax, double usual, double waves);
  /** For all points of soils: capacity, conductance, that through the surface (which differs from it where
   *  drag has the square of the flow), and what forces have of the pressure in full pores become those at p.
   *  V: volume of the point. */
  void begin_point(int i, const MPMPoreSoil &, double J, double V, double p, double &capacity,
                   double &conductance, double &through, double &in_forces);
  /** At fronts the pressure of a point with suction goes to nodes by a gradient that is less steep, see mpm_pore_suction.cpp. p, g: of the
   *  point, g in place; at_rest: the gradient of water at rest [pressure/length]. */
  static void limit_slope(const MPMPoreSoil &, double p, const double *at_rest,
                          const MPM_NS::Lattice &, double *g);
  /** The pressure of point i is this much above that of the nodes. */
  void set_lag(int i, double lag) { of[i].lag = lag; }
  /** At surfaces: sums of the soil at nodes, by the permeability that it has with the pressure outside. */
  using Soils = std::function<const MPMPoreSoil *(const MPMPointMap::Run &)>;
  void find_conductances(MPMNodeScalar &, const MPMPoreSurface &, const Soils &);
  const MPMPoreSurface::Wet &at_surface() const { return wet; }

  /** The motion increases the volume of a point by this, of which it returns the share that is water. */
  double take_motion(int i, double more, double dt);
  /** The rates at which points take the pressure of nodes are known. Collective. */
  void take_rates(double dt);
  /** Rate of what nodes get, so that water is kept although these rates differ. */
  double regained(int i, double capacity, double dt) const
  {
    return capacity * (longest - of[i].keep) * of[i].lag / dt;
  }
  /** Not more flows than a share of the water of the point through a cell in a step. flow: of the point,
   *  volume times velocity; speed: of a cell in a step. */
  void limit_flow(int i, double speed, double *flow) const
  {
    const double most = MOST_FLOW * of[i].filling * of[i].full * speed;
    const double square = flow[0] * flow[0] + flow[1] * flow[1] + flow[2] * flow[2];
    if (square <= most * most) return;
    for (int d = 0; d < 3; d++) flow[d] *= most / sqrt(square);
  }
  /** The share of the lag that stays in this step, where most of it does. */
  double kept_share() const { return longest; }
  double kept_lag(int i) const { return of[i].keep * of[i].lag; }
  /** Point i has got a volume of water. guess: its pressure if its capacity had not changed. Returns its
   *  pressure. */
  double take_water(int i, const MPMPoreSoil &, double before, double guess, double more);

  double memory_usage() const;

 private:
  struct Point {
    double filling, full;    // volume of water over that of pores; volume of pores
    double keep;             // rate, and then factor of the lag in this step
    double lag;
    double capacity;
    double most, conductance;    // capacity of full pores, and conductance through the surface
  };
  static constexpr double MOST_FLOW = 0.2;
  MPMField &field;
  const MPMPoreWater &water;
  double *const &content;
  std::vector<Point> of;
  double usual = 0.0, waves = 0.0, slowest = 0.0;    // rates
  double longest = 1.0;                              // greatest factor of all ranks
  MPMPoreSurface::Wet wet;
  bool told = false;    // of water that is very stiff

  void tell_of_stiff_water(int i, const MPMPoreSoil &, double p);
};

}    // namespace LAMMPS_NS
#endif
