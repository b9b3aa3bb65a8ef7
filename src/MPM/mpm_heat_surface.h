/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_SURFACE_H
#define LMP_MPM_HEAT_SURFACE_H

#include "mpm_diffusion_solver.h"
#include "mpm_heat_body.h"
#include "mpm_heat_faces.h"
#include "mpm_region_surface.h"
#include "pointers.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatThin;
class Region;

/** What the surface of a region does to the heat of what touches it, or, without a region, the
 *  surface of bodies that touches nothing. */
struct MPMHeatSurfaceCondition {
  std::string region;    ///< ID, empty: free surfaces
  MPMHeatCondition condition;
};

/** Heat through surfaces of regions and free surfaces, at the nodes of one field. */
class MPMHeatSurfaces : protected Pointers {
 public:
  MPMHeatBody &body;
  /** Bodies that hide free surfaces of this one: their fields have a fix mpm/contact with it, by which all ranks know the
   *  nodes of both where they may meet. */
  std::vector<const MPMHeatBody *> neighbors;

  using Conditions = std::vector<MPMHeatSurfaceCondition>;
  /** sigma: the constant of Stefan and Boltzmann. */
  MPMHeatSurfaces(class LAMMPS *, MPMHeatBody &, const Conditions &, double sigma);

  /** Ranks need the nodes around those that their points reach. */
  void extend_topology();
  void topology_changed();
  /** Marks blocks with surfaces. */
  void mark_near();
  /** Where surfaces are in this step, when those of this body and its neighbors are known. thin: null, or gets all places,
   *  with the condition as entry. Collective. */
  void find_lines(MPMHeatThin *thin);
  /** What the capacities and temperatures of nodes make of them. Returns the largest rate of this rank at which temperatures
   *  follow those outside [1/time]. */
  double begin_step();
  void note_edges() const;
  /** They follow with this rate at the most, and at edges with that of conduction. */
  void limit(double cap, double conduction);
  /** Gives heat to the body, whose rates have all other heat already; adds the power of this rank, one value for each
   *  condition. */
  void exchange(double *power) const;
  /** From here on exchange_changes() is for small changes of the present temperatures. Is all of it symmetric on this rank? */
  bool linearize();
  void exchange_changes() const;
  /** What this rank adds to the matrix of conduction. */
  void each_term(const MPMDiffusion::Term &) const;

  double memory_usage() const;

 private:
  struct Place {
    int condition;
    int64_t key;
    MPMHeatBody::Line line;
    double share, area;    // of this axis, and of this rank
    double rate;           // at which the temperature follows that outside
    double slope;          // fall of the heat per area with the temperature, of exchange_changes()
    double into[3];        // unit normal into the body
  };
  struct Wall {
    Region *region;    // null: free surface
    MPMRegionSurface surface;
    std::vector<double> distance;    // of nodes, in node spacings

    bool moves() const;
  };

  const Conditions &conditions;
  const double sigma;
  double fastest = 0.0;
  std::vector<Wall> walls;
  std::vector<int> wall_of;    // of each condition, -1: free surface
  bool has_free = false;
  /** Share of the room of a node that the body fills, and that its neighbors fill, this at nodes that the body reaches. */
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
  double room(int64_t node) const;
};

}    // namespace LAMMPS_NS
#endif
