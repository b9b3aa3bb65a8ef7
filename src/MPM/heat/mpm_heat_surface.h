/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_SURFACE_H
#define LMP_MPM_HEAT_SURFACE_H

#include "declare/option.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "heat/mpm_heat_body.h"
#include "heat/mpm_heat_faces.h"
#include "pointers.h"
#include "walls/mpm_region_surface.h"

#include <array>
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

  /** Activates the blocks around those next to surfaces. */
  void extend_topology();
  /** The blocks of the field are new. */
  void topology_changed()
  {
    for (auto &wall : walls) wall.distance.clear();
  }
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
  /** Gives heat to the body, whose rates must include all other heat already. changes: temperatures
   *  are small changes from those of linearize(). power: the power on this rank is added, one value
   *  for each condition. */
  void exchange(bool changes, double *power) const;
  /** Linearizes the conditions around the present temperatures. Returns true if the result is
   *  symmetric on this rank. */
  bool linearize();
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
    double slope;          // decrease of the flux per unit of temperature
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
  /** Shares of the volume of a node that the body fills, and that its neighbors fill; the latter at
   *  nodes that the body reaches. */
  std::vector<double> filled, covered;
  std::vector<Place> places;
  std::vector<MPMHeatBody::Part> parts;    // of one place
  std::vector<double> counts;              // of divide_among_ranks()

  bool near_wall(Wall &, const int *block) const;
  template <class F> void each_pair(const F &f) const;
  void find_wall(int condition, Wall &, MPMHeatThin *);
  void find_filled();
  void find_covered();
  void find_free(int condition, MPMHeatThin *);
  void keep(const Place &, const int *index);
  double volume_fraction(int64_t node) const;
};

/** Two bodies that exchange heat where they touch. */
struct MPMHeatPair {
  std::string field[2];                    ///< IDs of the fix mpm of both bodies
  MPM_NS::NumberOrVariable conductance;    ///< heat per area, time, and difference of temperature
  double now = 0.0;                        ///< conductance in this step
};

/** Heat exchange between two fields on one lattice where they touch: q = h_c (T_a - T_b) per
 *  area. */
class MPMHeatContact : protected Pointers {
 public:
  /** The fields must have a fix mpm/contact, which gives all ranks the nodes of both fields where
   *  they may meet. */
  MPMHeatContact(class LAMMPS *, MPMHeatBody &a, MPMHeatBody &b, const MPMHeatPair &);

  /** Activates the blocks around those of a field, if it is one of the two. */
  void extend_topology(const MPMField &);
  /** The blocks of a field are new. */
  void topology_changed() { listed = false; }
  /** Marks blocks in which the bodies may meet. */
  void mark_near();
  /** Finds the places where the bodies touch, once their surfaces are known. thin: null, or
   *  receives all places of this entry. Collective. */
  void find_contacts(MPMHeatThin *thin, int entry);
  /** Updates the exchange for the capacities of nodes. Returns the largest rate of exchange on this
   *  rank [1/time]. */
  double begin_step();
  /** Notes the lines of this contact for edges of both bodies. */
  void note_edges() const;
  /** Limits the rate at which the difference of temperatures decays: to cap, the rate of the
   *  fastest other change. At edges, the limit is the rate of conduction. */
  void limit(double cap);
  /** Gives heat to both bodies, whose rates must include all other heat already. Adds the power
   *  from a to b on this rank. */
  void exchange(double &power) const;
  /** Is the exchange symmetric on this rank? */
  bool is_symmetric() const;
  /** Passes on the terms that this rank adds to the matrix of conduction of a body, as if the other
   *  body had the same temperature. */
  void each_term(const MPMHeatBody &, const MPMDiffusion::Term &) const;

  double memory_usage() const;

 private:
  struct Common {    // a block of nodes that both fields have
    int slot[2];
    uint64_t canonical;
  };
  struct Place {
    int64_t key;
    MPMHeatBody::Line line[2];
    double area, share;    // area and share that belong to this axis and this rank
    double response;
    double rate;         // rate at which the difference of temperatures decays
    double normal[3];    // unit normal from the first body to the second one
  };

  const std::array<MPMHeatBody *, 2> body;
  const MPMHeatPair &pair;
  bool listed = false;
  double fastest = 0.0;    // upper limit of the rate
  std::vector<Common> common;
  std::vector<Place> places;
  std::vector<double> counts;    // of divide_among_ranks()

  void list_common_blocks();
  bool make_place(int axis, const int *index, int64_t a, int64_t b, Place &, MPMHeatThin *,
                  int entry) const;
};

}    // namespace LAMMPS_NS
#endif
