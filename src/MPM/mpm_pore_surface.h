/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_SURFACE_H
#define LMP_MPM_PORE_SURFACE_H

#include "declare/option.h"
#include "mpm_node_profile.h"
#include "mpm_node_scalar.h"
#include "mpm_pore_soil.h"
#include "pointers.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** What pore water has outside of a face of the box, or of the free surface of the soil. Where there is air
 *  (SEEPAGE, RAIN, and HEAD above the table of soils that can dry) water leaves by its pressure, but none
 *  comes in, or not more than falls there. */
struct MPMPoreCondition {
  enum Kind { CLOSED, PRESSURE, HEAD, FLUX, SEEPAGE, RAIN };

  Kind kind = CLOSED;
  MPM_NS::NumberOrVariable
      value;    ///< pressure; height of a water table; volume of water that comes in, or falls, per area
  double now = 0.0;    ///< in this step
};

/** Water through the surface of the soil in one field: at faces of the box, and where it is free.
 *
 *  Each node next to the surface stands for a share of its area. Water flows out there as it is driven by the
 *  difference of the pressure half a node spacing below the surface from that at the surface. */
class MPMPoreSurface : protected Pointers {
 public:
  static constexpr int NFACE = 6, FREE = 6, NPART = 7;    ///< parts: xlo ... zhi, free surface
  static constexpr int ENERGY = NPART;    ///< place of the energy of water behind them
  using Conditions = std::array<MPMPoreCondition, NPART>;

  /** Of each node, of soils that can dry: sums over points of the capacity that full pores have, and of that
   *  times the mobility, by the permeabilities at the pressure zero, and for parts that have a suction outside at
   *  that. */
  struct Wet {
    std::vector<double> capacity;
    std::array<std::vector<double>, 1 + NPART> conductance;
  };

  MPMPoreSurface(class LAMMPS *, MPMField &, const Conditions &, const MPMPoreWater &,
                 const double *gravity);

  /** Does water go through any part? If not, nothing else needs to be called. */
  bool any() const;
  /** Start of a run. dries: is there soil that can dry? varies: does the permeability change smoothly? */
  void init(bool dries, bool varies);
  /** Places are in reach of the points, and may have nodes beyond these. */
  void extend_topology();
  /** Where the surface is. Before MPMNodeScalar::points_to_nodes(). Collective. */
  void find_places();
  /** The pressure outside of a part where it is given and below that of the air; otherwise zero. */
  double suction_outside(int part) const;
  /** Distance of bodies that close the free surface where they touch it: distance(x, far), far where it is more. */
  std::function<double(const double *, double)> distance_to_seals;
  /** Where the free surface is open to a pressure outside, and no body closes it, p is that, times a factor. */
  void replace_by_outside(const double *x, double factor, double &p) const;
  /** What flows there, from the nodes' capacities and, as volume, conductances: sums of capacity times mobility. least_storage: the smallest
   *  of a soil; wet: of soils that can dry, or null. Returns a bound of the rates of exchange at this rank's
   *  nodes [1/time]. Collective. */
  double prepare(const MPMNodeScalar &, double least_storage, const Wet *wet);
  /** For water with inertia, after prepare(): which nodes the surface belongs to. Collective. */
  void share_area(const MPMNodeScalar &);
  /** Water with inertia: [node][8] what drives it, gradients of pressure, by pressures of nodes. For
   *  MPMPoreMotion. */
  void find_push(const MPMNodeScalar &, std::vector<double> &of_nodes) const;
  /** What then flows out, [node][8]: sums of volume times flow, instead of what pressures drive. */
  void take_flow(const std::vector<double> &of_nodes);
  /** Can points of a block have to do with the surface? */
  bool is_near(int slot) const;
  /** Adds this rank's share to the rates times capacity of nodes, and of the volumes of water that come in
   *  for each time, with the energy that this brings. */
  void add_rates(MPMNodeScalar &, std::vector<double> &inflow);
  /** Values of nodes are small changes around those of the last add_rates(): the changes of these rates. Not for water with inertia. */
  void add_changes(MPMNodeScalar &) const;
  /** Terms of minus these times dt, as symmetric ones: n nodes with numbers by which their values make one, and what multiplies that. */
  template <class Use> void each_term(double dt, const Use &use) const
  {
    for (const auto &place : places) {
      const double stiffness = dt * place.slope;
      if (stiffness > 0.0) use(place.n, &node[place.first], 1, &weight[place.first], &stiffness);
    }
  }

  double memory_usage() const;

 private:
  struct Place {
    int part;
    double area, outside;    // pressure at which nothing flows
    double in, out;          // conductances: volume of water for a difference in pressure, and time
    int first, n;            // nodes of the place where the pressure is taken
    int first_at, n_at;      // nodes of the surface next to it, where water comes in
    double at[3], normal[3];    // on the surface, out of the soil
    double touch;               // part of the surface there that is of this place
    double open;                // part of it that no body closes
    double outside_at;          // pressure outside at the surface itself
    double inflow;              // of water with inertia, volume for each time
    double most;                // volume of water that can come in for each area and time
    double slope;               // of what comes in, by minus the pressure
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
  std::vector<double>
      rows;    // [2*node] sums of conductances where pressures are taken, and where water comes in
  std::vector<char> near;        // [block]
  bool flow_is_given = false;    // by take_flow()

  void find_blocks_near();
  void map_volume();
  double function(double depth) const;
  double open_part(const double *x) const;
  /** Where the soil ends next to a face of the box. */
  struct End {
    double gap;      ///< before the face, in node spacings, negative: beyond it
    double share;    ///< of the area of the line that is soil
  };
  End end_at_face(const int *index, int face, double wall) const;
  double pressure_outside(const MPMPoreCondition &, const double *x) const;
  int add_nodes(class MPMStencil &, const double *x);
  void add_place(class MPMStencil &, int part, double area, double touch, const double *at,
                 const double *normal, double open = 1.0);
  /** Does the area of the free surface tell how much water comes in? */
  bool by_area() const;
  void find_areas();
  double at_surface(const MPMNodeScalar &, const Place &) const;
  double mobility_to_surface(const Place &, const std::vector<double> &conductance,
                             const std::vector<double> &capacity) const;
  double normalize(int first, int n, double enough, const std::vector<double> &capacity);
};

}    // namespace LAMMPS_NS
#endif
