/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_SURFACE_H
#define LMP_MPM_PORE_SURFACE_H

#include "declare/option.h"
#include "diffusion/mpm_node_profile.h"
#include "diffusion/mpm_node_scalar.h"
#include "pointers.h"
#include "pore/mpm_pore_soil.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Condition of pore water at a face of the box, or at the free surface of the soil. Where there is
 *  air outside (SEEPAGE, RAIN, and HEAD above the water table for soils that can dry), pressure
 *  drives water out, but no water comes in, or not more than falls there. */
struct MPMPoreCondition {
  enum Kind { CLOSED, PRESSURE, HEAD, FLUX, SEEPAGE, RAIN };

  Kind kind = CLOSED;
  /** Pressure; height of a water table; volume of water per area that comes in, or falls. */
  MPM_NS::NumberOrVariable value;
  double now = 0.0;    ///< the value in this step
};

/** Flow of water through the surface of the soil in one field: at faces of the box, and where it is
 *  free.
 *
 *  Each node next to the surface stands for a share of its area. The difference between the
 *  pressure half a node spacing below the surface and the pressure at the surface drives the flow
 *  out. */
class MPMPoreSurface : protected Pointers {
 public:
  static constexpr int NFACE = 6, FREE = 6, NPART = 7;    ///< parts: xlo ... zhi, free surface
  static constexpr int ENERGY = NPART;    ///< index of the energy of water, behind the parts
  using Conditions = std::array<MPMPoreCondition, NPART>;

  /** Of each node, for soils that can dry: sums over points of the capacity of full pores, and of
   *  this capacity times the mobility. conductance[0] has the permeability at zero pressure,
   *  conductance[1 + part] that at the suction outside, for parts that have one. */
  struct Wet {
    std::vector<double> capacity;
    std::array<std::vector<double>, 1 + NPART> conductance;
  };

  MPMPoreSurface(class LAMMPS *, MPMField &, const Conditions &, const MPMPoreWater &,
                 const double *gravity);

  /** Does water pass any part? If not, no other function needs to be called. */
  bool any() const;
  /** Start of a run. dries: is there soil that can dry? varies: does the permeability change
   *  smoothly? */
  void init(bool dries, bool varies);
  /** The places of the surface are in reach of the points, and may have nodes beyond these. */
  void extend_topology();
  /** Finds where the surface is. Call before MPMNodeScalar::points_to_nodes(). Collective. */
  void find_places();
  /** The pressure outside of a part if it is given and below that of the air; otherwise zero. */
  double suction_outside(int part) const;
  /** distance(x, far): distance of x from bodies that close the free surface where they touch it,
   *  or far if it is greater. */
  std::function<double(const double *, double)> distance_to_seals;
  /** If the free surface is open to a pressure outside, sets p to this pressure at x times a
   *  factor. Does nothing if there are bodies that can close the surface. */
  void replace_by_outside(const double *x, double factor, double &p) const;
  /** Prepares the flow from the capacities of nodes and, as their volume, the conductances, which
   *  are sums of capacity times mobility. least_storage: the smallest storage of a soil; wet: sums
   *  for soils that can dry, or null. Returns a bound of the rates of exchange at this rank's nodes
   *  [1/time]. Collective. */
  double prepare(const MPMNodeScalar &, double least_storage, const Wet *wet);
  /** For water with inertia, after prepare(): finds the nodes that the surface belongs to.
   *  Collective. */
  void share_area(const MPMNodeScalar &);
  /** For water with inertia: [node][8] gradients of pressure that drive it, from the pressures of
   *  nodes, for MPMPoreMotion. */
  void find_push(const MPMNodeScalar &, std::vector<double> &of_nodes) const;
  /** For water with inertia: takes the flow that results, in place of the flow that pressures
   *  drive. of_nodes: [node][8] sums of volume times flow, 0, and sum of volume. */
  void take_flow(const std::vector<double> &of_nodes);
  /** Can points of this block be affected by the surface? */
  bool is_near(int slot) const;
  /** Adds this rank's contribution to the rates of nodes times their capacity, and to inflow: the
   *  volumes of water that come in per time, and the energy that this water brings. */
  void add_rates(MPMNodeScalar &, std::vector<double> &inflow);
  /** For values of nodes that are small changes from those of the last add_rates(): adds the
   *  changes of these rates. Not for water with inertia. */
  void add_changes(MPMNodeScalar &) const;
  /** Terms of minus these changes times dt, in symmetric form. use(): n nodes, the weights with
   *  which their values are summed, and the factor of this sum. */
  template <class Use> void each_term(double dt, const Use &use) const
  {
    for (const auto &place : places) {
      const auto &[first, last] = place.inside;
      const double stiffness = dt * place.slope;
      if (stiffness > 0.0) use(last - first, &node[first], 1, &weight[first], &stiffness);
    }
  }

  double memory_usage() const;

 private:
  struct Range {    // nodes around a position, with their weights
    int first, last;
  };
  struct Place {
    int part;
    double area, outside;       // outside: pressure at which nothing flows
    double in, out;             // conductances: volume of water per difference in pressure and time
    Range inside;               // where the pressure is taken
    Range top;                  // on the surface next to it, where water comes in
    double at[3], normal[3];    // on the surface, out of the soil
    double touch;               // share of the surface there that belongs to this place
    double open;                // share of it that no body closes
    double outside_at;          // pressure outside at the surface itself
    double inflow;              // of water with inertia, volume per time
    double most;                // greatest volume of water that can come in per area and time
    double slope;               // derivative of the inflow with respect to minus the pressure
  };
  MPMField &field;
  const Conditions &conditions;
  const MPMPoreWater &water;
  const double *const gravity;
  bool dries = false, varies = false;
  std::unique_ptr<MPMNodeProfile> profile;
  std::vector<Place> places;
  std::vector<int64_t> node;    // of all places
  std::vector<double> weight;
  std::vector<double> nodes;           // records with volume and its gradient
  std::vector<double> free_normals;    // [node][dim] of the free surface, times its area
  // [2*node] sums of conductances: where pressures are taken, and where water comes in
  std::vector<double> rows;
  std::vector<char> near;        // [block]
  bool flow_is_given = false;    // by take_flow()

  void find_blocks_near();
  void map_volume();
  double function(double depth) const;
  double open_part(const double *x) const;
  /** End of the soil next to a face of the box. */
  struct End {
    double gap;      ///< distance before the face, in node spacings; negative: beyond it
    double share;    ///< share of the area of the line that is soil
  };
  End end_at_face(const int *index, int face, double wall) const;
  double pressure_outside(const MPMPoreCondition &, const double *x) const;
  Range add_nodes(class MPMStencil &, const double *x);
  double value(const Range &, const std::vector<double> &of_nodes) const;
  void spread(const Range &, double amount, std::vector<double> &of_nodes, int width = 1,
              int component = 0) const;
  void add_place(class MPMStencil &, int part, double area, double touch, const double *at,
                 const double *normal, double open = 1.0);
  /** Does the area of the free surface determine how much water comes in? */
  bool by_area() const;
  void find_areas();
  double mobility_to_surface(const Place &, const std::vector<double> &conductance,
                             const std::vector<double> &capacity) const;
  double normalize(const Range &, double enough, const std::vector<double> &capacity);
};

}    // namespace LAMMPS_NS
#endif
