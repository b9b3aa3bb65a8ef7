/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_MOTION_H
#define LMP_MPM_PORE_MOTION_H

#include "base/mpm_rows.h"
#include "pointers.h"
#include "pore/mpm_pore_soil.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Pore water with a velocity of its own in the points of one field (u-v-p): its inertia in the
 *  momentum equation of soil and water, and its motion relative to the soil.
 *
 *  Points keep rows of dim reals: J w, where the flow w is the volume of water that passes an area
 *  of the soil per time [velocity], and J is the ratio of volumes. The momentum of soil and water
 *  of a point is mass times velocity of the point, plus the density of the water times the initial
 *  volume of the point times this row. */
class MPMPoreMotion : protected Pointers {
 public:
  /** Is a block needed? Null: all blocks are. */
  using Wanted = std::function<bool(int slot)>;

  /** State of the pores of a point. */
  struct Pores {
    double volume, J;    ///< volume of the point, and its ratio to the initial volume
    double porosity;
    double resistance;    ///< gradient of pressure per flow w, for small w [pressure time/area]
    double quadratic;     ///< gradient of pressure per square of w
  };

  /** density: of the water; gravity: force per mass. */
  MPMPoreMotion(class LAMMPS *, MPMField &, double density, const double *gravity);

  /** Start of a step: no point has water until begin_point() is called for it. flow: rows of the
   *  points. */
  void begin_step(const MPMRows &flow);
  /** Sets the gradient of the pressure in a point. */
  void set_gradient(int i, const double *gradient);
  /** Call when nodes have mass, and before begin_point(). of_nodes: [node][8] gradients of pressure
   *  that drive the water to the surface, and 0. */
  void add_gradients(std::vector<double> &of_nodes, const Wanted &);
  /** r, normal: for a point at an interface of soils, the resistance there and the normal, in place
   *  of the resistance of the pores. */
  void begin_point(int i, const Pores &, const MPMPoreResistance *r = nullptr,
                   const double *normal = nullptr);
  /** Flow per gradient of pressure that a step produces in point i from rest: the mobility, or less
   *  if the step is too short for the water to speed up. */
  double response(int i, const Pores &) const;
  /** Call when nodes have mass, momentum, and forces, summed over ranks. Subtracts from these the
   *  part of the water that moves relative to the soil. */
  void separate();
  /** Call when nodes have their final velocities. Restores their mass, and finds the new flows. */
  void move();
  /** Volume times flow of a point [volume*velocity]. */
  void discharge(int i, double *q) const;
  /** [node][8] sums of volume times flow, 0, and sum of volume. */
  void flow_at_nodes(const Wanted &, std::vector<double> &of_nodes);

  /** Speed of the fastest wave in a material whose own wave speed is c, where soil and water move
   *  without drag. biot, storage [1/pressure]: of the soil; of_both: density of soil and water
   *  together. */
  double wave_speed(double c, double of_both, double biot, double storage, double porosity) const;
  double memory_usage() const;

 private:
  MPMField &field;
  const double density;
  const double *const gravity;
  MPMRows flow;

  // of points in this step

  std::vector<double>
      share;    // [n] mass that moves relative to the soil: 0 where drag takes all that it gains
  std::vector<double>
      lead;    // [n][3] acceleration of this mass; the gradient of the pressure until begin_point()
  std::vector<double> nodes;     // [node][8] sums of share times lead, 0, and sum of share
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
