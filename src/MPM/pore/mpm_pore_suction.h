/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_SUCTION_H
#define LMP_MPM_PORE_SUCTION_H

#include "base/mpm_rows.h"
#include "diffusion/mpm_node_scalar.h"
#include "lattice/grid.h"
#include "pointers.h"
#include "pore/mpm_pore_soil.h"
#include "pore/mpm_pore_surface.h"

#include <cmath>
#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** State of pores that hold the volume of water w per volume of pores, at the pressure p,
 *
 *    w = S(p) exp(p/K)   (p < 0),    w = S_s (1 + p/K)   (p >= 0),
 *
 *  and w n per volume of soil. Full pores of water without pressure have w = 1. */
struct MPMPoreMoisture {
  double filling;     ///< w
  double storage;     ///< n dw/dp [1/pressure]
  double relative;    ///< k_r, ratio of the permeability to that of full pores
  double bishop;      ///< share of the pressure in the effective stress

  /** State at the ratio of volumes J and the pressure p. */
  static MPMPoreMoisture at(const MPMPoreSoil &, double J, double p, const MPMPoreWater &);
  /** The pressure at which pores have this filling w. before: the last pressure; guess: a value
   *  near the solution. Soil with less water than at the suction 100/alpha gets that suction, or
   *  the suction it had before. */
  static double pressure(const MPMPoreSoil &, double filling, double before, double guess,
                         const MPMPoreWater &);
  /** Energy stored in a volume of soil: the integral of p times the storage, from zero
   *  [pressure]. */
  static double energy(const MPMPoreSoil &, double J, double p, const MPMPoreWater &);
};

/** Partly saturated soil in one field: the water of points besides its pressure, and the changes
 *  that this makes in the sums over points. See mpm_pore_suction.cpp. */
class MPMPoreSuction : protected Pointers {
 public:
  /** content: [n] volume of water of each point, negative where it is not yet known. */
  MPMPoreSuction(class LAMMPS *, MPMField &, const MPMPoreWater &, double *const &content);

  /** If the water of a point is not yet known, sets it from the pressure, and subtracts the mass of
   *  the water that its pores lack. */
  void weigh(int i, const MPMPoreSoil &, double p) const;

  /** Start of a step, or of one more sum over points. usual, waves: rate at which points with full
   *  pores take the pressure of nodes [1/time], and the part of it that is due to waves. */
  void begin(int nmax, double usual, double waves);
  /** Call for all points of soils. Changes the values for full pores into those at the pressure p:
   *  capacity, conductance, conductance through the surface (it differs from the former where drag
   *  has a quadratic term), and the pressure in forces. V: volume of the point. */
  void begin_point(int i, const MPMPoreSoil &, double J, double V, double p, double &capacity,
                   double &conductance, double &through, double &in_forces);
  /** Limits the gradient by which the pressure of a point with suction goes to nodes at fronts, see
   *  mpm_pore_suction.cpp. p, g: pressure and gradient of the point; g is changed in place.
   *  at_rest: the gradient of water at rest [pressure/length]. */
  static void limit_slope(const MPMPoreSoil &, double p, const double *at_rest,
                          const MPM_NS::Lattice &, double *g);
  /** Sets by how much the pressure of point i is above that of the nodes. */
  void set_lag(int i, double lag) { of[i].lag = lag; }
  /** For surfaces: sums over the soil at nodes, with its permeability at the pressure outside. */
  using Soils = std::function<const MPMPoreSoil *(const MPMPointMap::Run &)>;
  void find_conductances(MPMNodeScalar &, const MPMPoreSurface &, const Soils &);
  const MPMPoreSurface::Wet &at_surface() const { return wet; }

  /** The motion increases the volume of point i by more. Returns the share of this volume that is
   *  water. */
  double take_motion(int i, double more, double dt);
  /** Call when the rates at which points take the pressure of nodes are known. Collective. */
  void take_rates(double dt);
  /** Rate that nodes get in return, so that water is conserved although the rates of points
   *  differ. */
  double regained(int i, double capacity, double dt) const
  {
    return capacity * (longest - of[i].keep) * of[i].lag / dt;
  }
  /** Limits the flow of a point to a share of its water per crossing of a cell in a step. flow:
   *  volume times velocity of the point; speed: one cell per step. */
  void limit_flow(int i, double speed, double *flow) const
  {
    const double most = MOST_FLOW * of[i].filling * of[i].full * speed;
    const double square = flow[0] * flow[0] + flow[1] * flow[1] + flow[2] * flow[2];
    if (square <= most * most) return;
    for (int d = 0; d < 3; d++) flow[d] *= most / sqrt(square);
  }
  /** The greatest share of the lag of any point that stays in this step. */
  double kept_share() const { return longest; }
  double kept_lag(int i) const { return of[i].keep * of[i].lag; }
  /** Point i has received the volume more of water. guess: its pressure if its capacity had not
   *  changed. Returns its pressure. */
  double take_water(int i, const MPMPoreSoil &, double before, double guess, double more);

  double memory_usage() const;

 private:
  struct Point {
    double filling, full;    // volume of water over volume of pores; volume of pores
    double keep;             // rate, and then factor, by which the lag decays in this step
    double lag;
    double capacity;
    double most, conductance;    // capacity of full pores; conductance through the surface
  };
  static constexpr double MOST_FLOW = 0.2;
  MPMField &field;
  const MPMPoreWater &water;
  double *const &content;
  std::vector<Point> of;
  double usual = 0.0, waves = 0.0, slowest = 0.0;    // rates
  double longest = 1.0;                              // greatest factor keep on all ranks
  MPMPoreSurface::Wet wet;
  bool warned = false;    // has the warning of very stiff water been printed?

  void tell_of_stiff_water(int i, const MPMPoreSoil &, double p);
};

}    // namespace LAMMPS_NS
#endif
