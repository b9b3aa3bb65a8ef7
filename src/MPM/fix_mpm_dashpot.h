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

#include "declare/option.h"
#include "mpm_node_action.h"
#include "mpm_nodes.h"
#include "mpm_physics.h"
#include "mpm_state.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMColumn;

struct MPMDashpotOptions {
  enum Surface { REGION };

  Surface surface = REGION;
  std::string region;
  double speed_p = 0.0, speed_s = 0.0;
  double density = 0.0;    ///< 0: that of the points
  MPM_NS::NumberOrVariable incoming[3];
  bool has_incoming = false, support = true;
  double relax = 0.0, spacing = 0.0, area = 0.0;    ///< 0: not given
  std::string column;    ///< ID of a fix mpm/column that the far side moves like; empty: none

  MPM_NS::Options declare(int dimension);
};

/** Surfaces of bodies behind which the body goes on without end: dashpots take the waves that arrive (Lysmer and
 *  Kuhlemeyer), bring others in, and what the far side bears at the start is held. It can be at rest, or move like a column of
 *  ground. */
class FixMPMDashpot :
    public FixMPMState,
    public MPMNodeAction,
    public MPMPhysics,
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
  // Of a point: area of the surface that its dashpot stands for and the way from the point to that [3], normal out of the body [3],
  // density of the far side; shares in the static support (MPMFace): area and stress, traction [3]; motion of the surface so far [3].
  // traction at the mark that the support lacks [3]. All of them go with the point as they were found, without a turn.
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
    // with a column: traction of the support that is not of the column at the start [3]; HELD is the present sum of both
    REST = WIDTH,
    WIDTH_COLUMN = REST + 3
  };

  struct Node {
    int64_t number;     // canonical
    double function,    // of the lattice, at the surface
        weight;         // that of the dashpot
    double r[3];        // from the surface to the node, in node spacings
  };
  struct Mark {                // a place on the surface
    int point, first, last;    // range in nodes
  };
  struct Body {
    MPMField *field;
    MPM_NS::NodeField *rates, *pushes;
    std::vector<int64_t> canonical;
    std::vector<int>
        points;    // with marks, until the topology is renewed, which is when points move in memory
    std::vector<uint64_t> blocks;    // that marks reach, by their keys, sorted
    struct Stressed {
      int i, slot;
    };
    std::vector<Stressed> stressed;    // points with a stress of the support
    std::vector<Mark> marks;
    std::vector<Node> nodes;
  };
  std::vector<Body> bodies;
  bool defined = false;     // where the surface is
  double known = 0.0;       // how many points have a part in it
  bool supports = false;    // there is a stress to hold
  bool fresh = false;       // what it lacks is not known yet
  double work = 0.0;    // on the bodies, without the support, this rank's share [mass velocity^2]
  // force of nodes on which marks act [3], of the support on points [3], area, what the support lacked [3]
  static constexpr int NSUM = 10;
  double sums[NSUM] = {}, all_sums[NSUM] = {};
  bool sums_known = true;
  double arriving[3] = {};               // velocity of the waves that come in, in this step
  FixMPMColumn *free_field = nullptr;    // what moves at the far side, or null

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
