/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_SURFACE_H
#define LMP_MPM_HEAT_SURFACE_H

#include "diffusion/mpm_diffusion_solver.h"
#include "heat/mpm_heat_body.h"
#include "heat/mpm_heat_faces.h"
#include "pointers.h"
#include "walls/mpm_region_surface.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatThin;
class Region;

/** Heat condition at the surface of a region or, without a region, at the free surface of bodies,
 *  which touches nothing. */
struct MPMHeatSurfaceCondition {
  std::string region;    ///< ID, empty: free surfaces
  MPMHeatCondition condition;
};

/** Heat through surfaces of regions and free surfaces, at the nodes of one field. */
class MPMHeatSurfaces : protected Pointers {
 public:
  MPMHeatBody &body;
  /** Bodies that hide free surfaces of this one. Their fields have a fix mpm/contact with it, by
   *  which all ranks know the nodes of both fields where they may meet. */
  std::vector<const MPMHeatBody *> neighbors;

  using Conditions = std::vector<MPMHeatSurfaceCondition>;
  /** sigma: the Stefan-Boltzmann constant. */
  MPMHeatSurfaces(class LAMMPS *, MPMHeatBody &, const Conditions &, double sigma);

  /** Activates further blocks: ranks need the nodes around those that their points reach. */
  void extend_topology();
  /** The blocks of the field are new. */
  void topology_changed();
  /** Marks blocks with surfaces. */
  void mark_near();
  /** Finds the surfaces in this step, once those of this body and its neighbors are known. thin:
   *  null, or receives all places, with the condition as entry. Collective. */
  void find_lines(MPMHeatThin *thin);
  /** Updates the exchange for the capacities and temperatures of nodes. Returns the largest rate on
   *  this rank at which temperatures follow the outside temperature [1/time]. */
  double begin_step();
  /** Notes the lines of these surfaces for edges of the body. */
  void note_edges() const;
  /** Limits the rate at which temperatures follow to cap, and at edges to the rate of
   *  conduction. */
  void limit(double cap, double conduction);
  /** Gives heat to the body, whose rates must include all other heat already. power: the power on
   *  this rank is added, one value for each condition. */
  void exchange(double *power) const;
  /** Linearizes the conditions around the present temperatures for exchange_changes(). Returns true
   *  if the result is symmetric on this rank. */
  bool linearize();
  void exchange_changes() const;
  /** Passes on the terms that this rank adds to the matrix of conduction. */
  void each_term(const MPMDiffusion::Term &) const;

  double memory_usage() const;

 private:
  struct Place {
    int condition;
    int64_t key;
    MPMHeatBody::Line line;
    double share, area;    // share and area that belong to this axis and this rank
    double rate;           // rate at which the temperature follows the outside temperature
    double slope;          // decrease of the flux per unit of temperature, for exchange_changes()
    double into[3];        // unit normal into the body
  };
  struct Wall {
    Region *region;    // null: free surface
    MPMRegionSurface surface;
    std::vector<double> distance;    // distance of nodes, in node spacings

    bool moves() const;
  };

  const Conditions &conditions;
  const double sigma;
  double fastest = 0.0;
  std::vector<Wall> walls;
  std::vector<int> wall_of;    // index of the wall of each condition, -1: free surface
  bool has_free = false;
  /** Shares of the room of a node that the body fills, and that its neighbors fill; the latter at
   *  nodes that the body reaches. */
  std::vector<double> filled, covered;
  std::vector<Place> places;
  std::vector<MPMHeatBody::Part> parts;    // of one place
  MPMHeatShares shares;

  void exchange(bool changes, double *power) const;
  bool near_wall(Wall &, const int *block) const;
  template <class F> void each_pair(const F &f) const;
  void find_wall(int condition, Wall &, MPMHeatThin *);
  void find_filled();
  void find_covered();
  void find_free(int condition, MPMHeatThin *);
  void keep(const Place &, const int *index);
  void look_behind(MPMHeatThin &, const Place &, const int *index, double part,
                   const double *into) const;
  double volume_fraction(int64_t node) const;
};

}    // namespace LAMMPS_NS
#endif
