/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/boundary,FixMPMBoundary);
// clang-format on
#else

#ifndef LMP_FIX_MPM_BOUNDARY_H
#define LMP_FIX_MPM_BOUNDARY_H

#include "field/mpm_doubts.h"
#include "field/mpm_friction_heat.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "field/mpm_trial_contact.h"
#include "fix.h"
#include "walls/mpm_obstacle.h"
#include "walls/mpm_thin_regions.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_contact.h"
#include "walls/mpm_wall_contact_search.h"
#include "walls/mpm_wall_nodes.h"
#include "walls/mpm_wall_reaction.h"
#include "walls/mpm_wall_trial.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Walls that act on the nodes of the fields: faces of the box, or a region.
 *
 *  A face is a mirror: nodes beyond it are images of nodes inside of the box. A region acts on
 *  lines of nodes through its surface, or on each of the nodes inside of it, see
 *  MPMWall::acts_across(). */
class FixMPMBoundary :
    public Fix,
    public MPMNodeAction,
    public MPMRubbing,
    public MPMLineTies,
    public MPMBarrier,
    public MPMRegionUser {
 public:
  FixMPMBoundary(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  void init() override;
  void init_action() override { reaction.begin_run(*this); }
  void setup(int) override;
  void post_run() override { thin_regions.report(); }
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override { return reaction.work(); }
  double compute_vector(int i) override { return reaction.force_on_wall(i); }
  double memory_usage() override;

  bool uses_region(const std::string &) const override;

  Turn turn() const override { return WALLS; }
  void couple_topology() override;
  void extend_topology(MPMField &) override;
  void topology_changed(MPMField &) override;
  bool looks_beyond_points() const override { return false; }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override;
  bool decides_contact(const MPMField &field) const override
  {
    return wall.kind == MPMWall::SEPARATE && wall.acts_on(field);
  }
  bool is_projection() const override { return !wall.decides(); }
  void list_ties(const MPMField &, std::vector<int64_t> &, std::vector<int64_t> &) const override;
  MPMTrialContact *trial_contact() override;
  void act(double dt, Stage) override;

  double coefficient() const override { return wall.least_friction(); }
  bool loses_heat() const override { return wall.rubs() && !wall.heat.said; }
  bool gives_heat() const override { return wall.heat.heats(); }
  /** Is the wall a region? Otherwise it is one or more faces of the box. */
  bool is_region() const { return !wall.region_id.empty(); }
  /** Is this face of the box a wall? */
  bool has_face(int face) const
  {
    return std::count(wall.face_list.begin(), wall.face_list.end(), face) > 0;
  }
  /** Do the walls have a velocity, now or later in the run? */
  bool moves() const { return wall.moves(); }
  /** Signed distance of x from the surface of the region, negative inside; far if it is larger.
   *  Only during a run. */
  double distance(const double *x, double far) const { return wall.surface->distance(x, far); }
  bool keeps_out(const MPMField &field) const override
  {
    return is_region() && wall.acts_on(field);
  }
  bool changes_place() const override { return wall.region_moves(); }
  void go_to_start() override;
  double gap(const double *x, double far) const override
  {
    return wall.surface->distance_in_cells(x, far);
  }
  bool acts_inside() const override { return is_region(); }
  bool holds_axis(const MPMField &field) const override { return wall.holds_axis(field); }
  /** Adds the faces, or the region, to what rigid bodies can meet in a step. */
  void list_obstacles(double dt, std::vector<std::unique_ptr<MPMObstacle>> &);
  /** Counts an impulse on a rigid body at x [mass velocity] in the force on the wall in this step;
   *  to be called on all ranks, before the wall acts on nodes. */
  void add_body_impulse(const double *x, const double *impulse)
  {
    reaction.add_body_impulse(x, impulse);
  }

  /** Adds an impulse on a node [mass velocity] to the reaction that the wall counted for it in this
   *  step, with its moment and work. */
  void add_reaction(MPMField &field, int64_t node, const double *impulse)
  {
    reaction.add(field, node, impulse);
  }
  /** Marks the velocity components of nodes that this wall always prescribes: sets bit d of
   *  held[node], with one entry per node, and bit 3 + d where the wall mirrors a node outside. */
  void mark_prescribed(const MPMField &, std::vector<char> &held) const;
  /** Finds the velocities that this wall will give to nodes, from their present velocities. near:
   *  [block]. */
  void predict(MPMField &, const std::vector<char> &near, MPMPredictedVelocities &);

 private:
  MPMWall wall;
  std::vector<MPMWallNodes> nodes;    // one entry for each field to act on
  MPMWallReaction reaction;
  MPMWallContact contact;
  MPMWallContactSearch search;
  MPMThinRegions thin_regions;
  MPMWallTrial trial;
  MPMDoubts doubts;
  std::vector<FixMPMBoundary *> rubbing;    // walls with friction
  bool has_rubbed = false;                  // was rub() called in this step?

  void rub(double dt);
  bool slides_in_vain() const;
  int read_place(int narg, char **arg);
  void check_field(const MPMField &) const;
  void check_faces() const;
  void check_master(int face) const;
  const MPMWallNodes *nodes_of(const MPMField &) const;
  MPMWallNodes *nodes_of(const MPMField &);
};

}    // namespace LAMMPS_NS
#endif
#endif
