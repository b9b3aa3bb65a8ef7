/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MIXTURE_H
#define LMP_MPM_MIXTURE_H

#include "declare/option.h"
#include "field/mpm_reach.h"
#include "grains/mpm_drag.h"
#include "pointers.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMNodeAction;

/** Keywords of fix mpm/mixture. */
struct MPMMixtureOptions {
  enum Drag { NO_DRAG, DARCY, SPHERES };

  std::string soil_id, water_id;
  double grain_density = 0.0, viscosity = 0.0;    ///< viscosity: read as pressure, kept as mass
  Drag drag = NO_DRAG;
  double permeability = 0.0;          ///< intrinsic [area]
  double reference_porosity = 0.0;    ///< porosity of that permeability; 0: it holds for any
  double diameter = 0.0;              ///< of the grains
  MPM_NS::SphereDrag::Law spheres = MPM_NS::SphereDrag::NONE;

  MPM_NS::Options declare();
  /** Is this field (ID) the soil or the water? */
  bool has(const std::string &field) const { return field == soil_id || field == water_id; }

  /** Drag per volume of soil and velocity difference [mass/(volume time)]. porosity: of the soil;
   *  here: porosity at the node, which differs at the end of the soil and belongs to the velocity
   *  difference. */
  double drag_coefficient(double porosity, double here, double water_density,
                          double difference) const;
  /** Is the drag coefficient independent of the velocity difference? */
  bool drag_is_linear() const { return drag != SPHERES; }
};

/** Shares of soil and water in the volume at a node, from the volumes there of the grains, of the
 *  soil with its pores, and of the water. */
struct MPMMixtureShares {
  double here;          ///< porosity
  double porosity;      ///< porosity of the soil itself, which differs at its end
  double filled;        ///< share of the pores that is filled with water
  double soil_share;    ///< share of the pressure that the soil bears

  /** Volumes at a node. */
  MPMMixtureShares(double grains, double with_pores, double water);
};

/** Soil and water at the same place: what they share at nodes in a step, in the order of the
 *  functions. */
class MPMMixture : protected Pointers {
 public:
  struct Phase {
    MPMField *field = nullptr;
    MPMReach reach;
    // [block] do its points reach nodes that the other phase may have?
    std::vector<char> reaches;
    std::vector<double> volumes;    // [node][8] sums over points: see find_shares()
  };
  Phase soil, water;
  bool lists_valid = false;
  bool meets = false;                      ///< do soil and water meet in this step?
  bool pores_known = false;                ///< was look_for_overfull_pores() called?
  double dissipated = 0.0;                 ///< energy dissipated by drag so far, this rank's share
  static constexpr double LEAST = 0.05;    ///< porosity, where soil is compressed beyond all grains

  /** id: of the fix, for messages. */
  MPMMixture(class LAMMPS *lmp, const MPMMixtureOptions &options, const std::string &id) :
      Pointers(lmp), options(options), id(id)
  {
  }

  // each field has blocks for the sake of the other one, see MPMNodeAction

  void couple_topology();
  void blocks_found();
  void extend_topology(MPMField &);
  void topology_changed(MPMField &);

  // in a step

  void share_pressure();       ///< adds the forces of the pressure of the water to nodes of both
  void add_drag(double dt);    ///< changes the velocities of nodes by drag
  void note_action(MPMNodeAction &);    ///< after another action on nodes
  void correct_drag_at_walls();         ///< where walls hold the soil alone
  void account_for_work();              ///< when nodes have their final velocities
  void share_strain();                  ///< changes the volume of the water by the flux of both

  /** Volume of the grains of a point of soil. */
  double grains(int i) const;
  /** Has a point of soil or water, on any rank, this material? Collective. */
  bool shares_points(const class FixMPMMaterial &) const;
  double stable_dt(const MPMField &, tagint &tag) const;    ///< see MPMPhysics
  /** Drag (0 to 2) and pressure (3 to 5) on the soil in the last step [force]. Collective. */
  double force_on_soil(int i) const;
  double memory_usage() const;

 private:
  const MPMMixtureOptions &options;
  const std::string id;
  struct Common {    // a block of nodes that both phases may have
    int slot_soil, slot_water;
    uint64_t canonical;
  };
  struct Node {               // a node with soil near water
    int64_t soil, water;      // water: -1 where there is none
    double share;             // share of the pressure that the soil bears
    double here;              // porosity at the node
    double porosity;          // porosity of the soil itself, see MPMMixtureShares
    double filled;            // share of the pores that is filled
    double volume;            // volume of the filled share of the soil
    double wet;               // volume of water
    double density;           // of the water
    double force[3];          // on the soil, by the pressure of the water [mass*acceleration]
    double on_water[3];       // force on the water in addition to that by its own volume
    double impulse[3];        // of drag on the soil
    double rate;              // coefficient of drag [mass/time]
    double free_water[3];     // velocity of the water without drag and walls
    double after_water[3];    // velocity of the water before walls act
    double held[3];           // change of that velocity by walls
    double seen[3];           // velocity of the soil before the next wall acts
    bool owned;
  };
  struct Push {    // action of a wall on the soil
    std::size_t node;
    class FixMPMBoundary *wall;
    double change[3];    // of the velocity
  };

  std::vector<Common> common;
  std::vector<Node> nodes;
  std::vector<Push> pushes;      // of this step
  std::vector<double> stress;    // [soil node][8] mean stress of the water in filled pores
  std::vector<double> by_grains, by_water;    // [node][8] forces of the pressure in these volumes
  std::vector<double> flux, lead;    // [node][8] U at nodes of soil, U - u at nodes of water
  std::vector<double> rates;         // [n] div U at points of soil
  bool boxes_meet = false;           // do the boxes around both phases overlap?
  bool may_meet = false;             // do both have a block in common on any rank?
  double dt_last = 0.0;
  bool warned_of_slow_flow = false;    // did warn_of_slow_flow() print its warning?
  void warn_of_slow_flow();
  void look_for_overfull_pores();

  bool stale() const;
  void list_blocks();
  void find_near(Phase &, const std::vector<std::array<int, 3>> &keys) const;
  double volume(const Phase &, int i) const;
  const double *water_stress() const;
  template <class Volumes> void sum_volumes(Phase &, std::vector<double> &to, const Volumes &);
  template <class Stress> void sum_forces(Phase &, std::vector<double> &to, const Stress &);
  template <class Gather> void from_nodes(const Phase &, double *nodes, const Gather &);
  bool find_shares();
  bool is_held(const Node &, const double *normal) const;
  /** Raises most (wave speed) and speed (of points) to the maxima on this rank. Returns the point
   *  with the fastest wave, or -1 if none is faster than most. */
  int fastest_wave(const Phase &, double &most, double &speed) const;
};

}    // namespace LAMMPS_NS
#endif
