/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/dashpot,FixMPMDashpot);
// clang-format on
#else

#ifndef LMP_FIX_MPM_DASHPOT_H
#define LMP_FIX_MPM_DASHPOT_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "field/mpm_nodes.h"
#include "field/mpm_physics.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMColumn;

/** Keywords of fix mpm/dashpot. */
struct MPMDashpotOptions {
  enum Surface { REGION };

  Surface surface = REGION;
  std::string region;
  double speed_p = 0.0, speed_s = 0.0;
  double density = 0.0;    ///< 0: density of the points
  MPM_NS::NumberOrVariable incoming[3];
  bool has_incoming = false, support = true;
  double relax = 0.0, spacing = 0.0, area = 0.0;    ///< 0: not given
  std::string column;    ///< ID of the fix mpm/column with the motion of the far side; empty: none

  MPM_NS::Options declare(int dimension);
};

/** Surfaces of bodies behind which the body continues to infinity. Dashpots absorb the waves that
 *  arrive (Lysmer and Kuhlemeyer) and send in others, and a static support keeps the traction that
 *  the far side bears at the start. The far side is at rest or moves like a column of ground. */
class FixMPMDashpot :
    public FixMPMState,
    public MPMNodeAction,
    public MPMPhysics,
    public MPMAddedStress,
    public MPMRegionUser,
    private MPMDashpotOptions {
 public:
  FixMPMDashpot(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::POST_FORCE; }
  void init() override;
  void setup(int) override;
  void post_force(int) override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  bool uses_region(const std::string &name) const override { return name == region; }

  void extend_topology(MPMField &) override;
  void topology_changed(MPMField &) override;
  bool looks_beyond_points() const override { return false; }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override;
  void act(double dt, Stage) override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool adds_stress(const MPMField &, int first, int last) const override;
  void add_stress(const MPMField &, int first, int n, double *tau) const override;

 private:
  // For each point: area of the surface of its dashpot, vector from the point to this surface [3],
  // normal out of the body [3], density of the far side; shares in the static support (MPMFace):
  // area and stress, traction [3]; motion of the surface so far [3]; traction at the mark that the
  // support lacks [3]. All of them move with the point as they were found and do not rotate.
  MPMRows rows;
  enum {
    AREA,
    WAY,
    NORMAL = WAY + 3,
    DENSITY = NORMAL + 3,
    SHARE,
    STRESS,
    HELD,
    MOTION = HELD + 3,
    LACK = MOTION + 3,
    WIDTH = LACK + 3,
    // with a column: initial traction of the support without that of the column [3]; HELD is the
    // present sum of both
    REST = WIDTH,
    WIDTH_COLUMN = REST + 3
  };

  struct Node {
    int64_t number;     // canonical
    double function,    // function of the node at the surface
        weight;         // weight of the node for the dashpot
    double r[3];        // from the surface to the node, in node spacings
  };
  struct Mark {                // a place on the surface
    int point, first, last;    // range in nodes
  };
  struct Body {
    MPMField *field;
    MPM_NS::NodeField *rates, *pushes;
    std::vector<int64_t> canonical;
    // with marks; valid until the topology is renewed, when points move in memory
    std::vector<int> points;
    std::vector<uint64_t> blocks;    // keys of the blocks that marks reach, sorted
    struct Stressed {
      int i, slot;
    };
    std::vector<Stressed> stressed;    // points with a stress of the support
    std::vector<Mark> marks;
    std::vector<Node> nodes;
  };
  std::vector<Body> bodies;
  bool defined = false;     // is it known where the surface is?
  double known = 0.0;       // number of points with a part of the surface
  bool supports = false;    // is there a stress that the support holds?
  bool fresh = false;       // the traction that the support lacks is not known yet
  double work = 0.0;    // on the bodies, without the support, this rank's share [mass velocity^2]
  // force on nodes by marks [3], force on points by the support [3], area, force that the support
  // lacked [3]
  static constexpr int NSUM = 10;
  double sums[NSUM] = {}, all_sums[NSUM] = {};
  bool sums_known = true;
  double arriving[3] = {};               // velocity of incoming waves in this step
  FixMPMColumn *free_field = nullptr;    // motion of the far side, or null

  void define();
  void find_column();
  void warn_about_others() const;
  void warn_of_light_nodes(const MPMField &) const;
  void check_column(double lowest, double highest, double steepest) const;
  void column_traction(int i, double t[3]) const;
  Body &body_of(const MPMField &);
  template <class F> void visit_marks(const Body &, const F &f) const;
  void place_marks(Body &);
  bool weigh(Body &, const Mark &, double dt, double *damping) const;
  void find_rates(Body &);
  template <class F> void visit_below(const Body &, const F &f) const;
  void complete_supports(double dt);
  void push(Body &, double dt);
  void apply(Body &, double dt);
  void tell_watch(const Body &);
};

}    // namespace LAMMPS_NS
#endif
#endif
