/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_MOTION_H
#define LMP_MPM_PORE_MOTION_H

#include "mpm_pore_soil.h"
#include "mpm_rows.h"
#include "pointers.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Pore water with a velocity of its own in the points of one field (u-v-p): its inertia in the momentum
 *  equation of soil and water, and its motion relative to the soil.
 *
 *  Points keep rows of dim reals: J times the flow w, the volume of water that goes through an area of the
 *  soil for each time [velocity], with the ratio J of volumes. Mass times velocity of a point, plus the
 *  density of the water times the initial volume of the point times this row, is the momentum of its soil and
 *  water together. */
class MPMPoreMotion : protected Pointers {
 public:
  /** Is a block looked at? Null: all are. */
  using Wanted = std::function<bool(int slot)>;

  /** What the pores of a point are like. */
  struct Pores {
    double volume, J;    ///< of the point now, and over the initial one
    double porosity;
    double
        resistance;      ///< gradient of pressure per flow w, where w is small [pressure time/area]
    double quadratic;    ///< the same per square of w
  };

  /** density: of the water; gravity: force per mass. */
  MPMPoreMotion(class LAMMPS *, MPMField &, double density, const double *gravity);

  /** A step begins: no point has water until begin_point(). flow: of the points. */
  void begin_step(const MPMRows &flow);
  /** Gradient of the pressure in a point. */
  void set_gradient(int i, const double *gradient);
  /** Nodes have mass. [node][8] gradients of pressure that drive the water to the surface, 0. Before
   *  begin_point(). */
  void add_gradients(std::vector<double> &of_nodes, const Wanted &);
  /** r, normal: at an interface of soils, instead of the resistance of the pores. */
  void begin_point(int i, const Pores &, const MPMPoreResistance *r = nullptr,
                   const double *normal = nullptr);
  /** Flow per gradient of pressure that a step makes in point i from rest: the mobility, or less where there
   *  is no time to speed up. */
  double response(int i, const Pores &) const;
  /** Nodes have mass, momentum, and forces, summed over ranks: takes off them what moves by itself. */
  void take_off();
  /** Nodes have their final velocities, and get back their mass: new flows. */
  void move();
  /** Volume times flow of a point [volume*velocity]. */
  void discharge(int i, double *q) const;
  /** [node][8] sums of volume times flow, 0, and of the volume. */
  void flow_at_nodes(const Wanted &, std::vector<double> &of_nodes);

  /** Speed of the fastest wave in a material whose own wave speed is c: both phases move, without drag. biot,
   *  storage [1/pressure]: of the soil; of_both: density of soil and water. */
  double wave_speed(double c, double of_both, double biot, double storage, double porosity) const;
  double memory_usage() const;

 private:
  MPMField &field;
  const double density;
  const double *const gravity;
  MPMRows flow;

  // of points in this step

  std::vector<double>
      share;    // [n] mass that moves by itself: 0 where drag takes all that it gains
  std::vector<double>
      lead;    // [n][3] acceleration of this mass; until begin_point() gradient of the pressure
  std::vector<double> nodes;     // [node][8] sums of share times lead, 0, and of share
  std::vector<double> change;    // [node][8] acceleration of the soil

  double acceleration() const;
  double fading(const Pores &, double resistance) const;
  void begin_at_interface(int i, const Pores &, const MPMPoreResistance &, const double *normal,
                          const double *w, const double *free);
  void to_points(std::vector<double> &of_nodes, const Wanted &);
  template <class Weigh> void sum(std::vector<double> &to, const Wanted &, const Weigh &);
};

}    // namespace LAMMPS_NS
#endif
