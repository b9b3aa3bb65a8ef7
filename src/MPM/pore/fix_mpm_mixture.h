/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/mixture,FixMPMMixture);
// clang-format on
#else

#ifndef LMP_FIX_MPM_MIXTURE_H
#define LMP_FIX_MPM_MIXTURE_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_node_action.h"
#include "field/mpm_physics.h"
#include "field/mpm_reach.h"
#include "grains/mpm_drag.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

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

  /** Drag per volume of soil and velocity difference [mass/(volume time)]. porosity: of the soil; here: porosity at
   *  the node, which differs at the end of the soil and belongs to the velocity difference. */
  double drag_coefficient(double porosity, double here, double water_density,
                          double difference) const;
  /** Is the drag coefficient independent of the velocity difference? */
  bool drag_is_linear() const;
};

/** Shares of soil and water in the volume at a node, from the volumes there of the grains, of the soil with its pores,
 *  and of the water. */
struct MPMMixtureShares {
  double here;        ///< porosity
  double porosity;    ///< porosity of the soil itself, which differs at its end
  double filled;      ///< share of the pores that is filled with water
  double of_soil;     ///< share of the pressure that the soil bears

  /** Volumes at a node. */
  MPMMixtureShares(double grains, double with_pores, double water);
};

/** Soil and water at the same place, each a field (fix mpm) with its own points and velocity. They share the volume and
 *  the gradient of the water pressure, and exchange momentum by drag. */
class FixMPMMixture :
    public FixMPMState,
    public MPMPhysics,
    public MPMNodeAction,
    private MPMMixtureOptions {
 public:
  FixMPMMixture(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  void init() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double memory_usage() override;

  // of both MPMPhysics and MPMNodeAction

  void extend_topology(MPMField &) override;
  void topology_changed(MPMField &) override;

  Turn turn() const override { return PHASES; }
  void init_action() override;
  void couple_topology() override;
  void blocks_found() override;
  void act(double dt, Stage) override;
  void has_acted(MPMNodeAction &other, Stage) override;

  void init_physics(MPMPlan &) override {}
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  double stable_dt(const MPMField &, tagint &tag) const override;
  std::vector<Account> accounts() const override;
  void account(double *values) const override { values[0] += dissipated; }

  /** Is this field (ID) the soil or the water? */
  bool has(const std::string &field) const { return field == soil_id || field == water_id; }
  const char *soil_field() const { return soil_id.c_str(); }    ///< its ID
  const char *water_field() const { return water_id.c_str(); }
  double density_of_grains() const { return grain_density; }

 private:
  struct Phase {
    MPMField *field = nullptr;
    MPMReach reach;
    std::vector<char>
        reaches;    // [block] do its points reach nodes that the other phase may have?
    std::vector<double> volumes;    // [node][8] sums over points: see find_shares()
  };
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

  Phase soil, water;
  std::vector<Common> common;
  std::vector<Node> nodes;
  std::vector<Push> pushes;      // of this step
  std::vector<double> stress;    // [soil node][8] mean stress of the water in filled pores
  std::vector<double> by_grains, by_water;    // [node][8] forces of the pressure in these volumes
  std::vector<double> flux, lead;    // [node][8] U at nodes of soil, U - u at nodes of water
  std::vector<double> rates;         // [n] div U at points of soil
  bool lists_valid = false;
  bool boxes_meet = false;    // do the boxes around both phases overlap?
  bool may_meet = false;      // do both have a block in common on any rank?
  bool meets = false;         // do soil and water meet in this step?
  double dt_last = 0.0;
  bool slow_told = false;    // did warn_of_slow_flow() print its warning?
  void warn_of_slow_flow();
  bool pores_known = false;    // was look_for_overfull_pores() called?
  void look_for_overfull_pores();
  double dissipated = 0.0;    // energy dissipated by drag so far, this rank's share

  bool stale() const;
  void list_blocks();
  void find_near(Phase &, const std::vector<std::array<int, 3>> &keys) const;
  double grains(int i) const;
  double volume(const Phase &, int i) const;
  const double *water_stress() const;
  template <class Volumes> void sum_volumes(Phase &, std::vector<double> &to, const Volumes &);
  template <class Stress> void sum_forces(Phase &, std::vector<double> &to, const Stress &);
  template <class Gather> void from_nodes(const Phase &, double *nodes, const Gather &);
  bool find_shares();
  void share_pressure();
  void correct_drag_at_walls();
  bool is_held(const Node &, const double *normal) const;
  void share_strain();
  void account_for_work();
  bool shares_points(const class FixMPMMaterial &) const;
  /** Raises most (wave speed) and speed (of points) to the maxima on this rank. Returns the point with the fastest
   *  wave, or -1 if none is faster than most. */
  int fastest_wave(const Phase &, double &most, double &speed) const;
};

}    // namespace LAMMPS_NS
#endif
#endif
