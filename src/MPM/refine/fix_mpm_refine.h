/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/refine,FixMPMRefine);
// clang-format on
#else

#ifndef LMP_FIX_MPM_REFINE_H
#define LMP_FIX_MPM_REFINE_H

#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "field/mpm_physics.h"
#include "field/mpm_reach.h"
#include "fix.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMContact;
class MPMTwoScale;

/** Joins the points of several fields (fix mpm) to one body. Each field has half the node spacing of the previous one; see
 *  MPMTwoScale for each pair of them. */
class FixMPMRefine : public Fix, public MPMPhysics, public MPMNodeAction, public MPMRefinedBody {
 public:
  FixMPMRefine(class LAMMPS *, int, char **);
  ~FixMPMRefine() override;
  int setmask() override { return 0; }    // called by fix mpm
  void post_run() override;

  std::vector<MPMField *> finer_than(const std::string &name) const override;
  void extend_for_finer(const MPMField &) const override;
  /** Pairs of successive lattices, from the coarsest on. Valid after init_action(). */
  const std::vector<std::unique_ptr<MPMTwoScale>> &lattices() const { return pairs; }
  bool has(const std::string &name) const override { return level(name) < (int) ids.size(); }
  void init() override;
  double compute_vector(int) override;
  double memory_usage() override;

  // of both MPMPhysics and MPMNodeAction

  void extend_topology(MPMField &) override;
  void topology_changed(MPMField &) override;
  bool looks_beyond_points() const override { return true; }    // parents of nodes in reach

  Turn turn() const override { return TIED_NODES; }
  void init_action() override;
  void couple_topology() override;
  void blocks_found() override;
  bool decides_contact(const MPMField &) const override;
  /** Where the body touches others, any of its lattices may be needed. */
  bool may_be_empty(const MPMField &field) const override { return decides_contact(field); }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override { return false; }
  void act(double dt, Stage) override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;

 private:
  std::vector<std::string> ids;    // IDs of the fixes mpm, from the coarsest on
  std::vector<MPMField *> fields;
  std::vector<std::unique_ptr<MPMTwoScale>> pairs;    // each field and the next finer one
  struct
      Neighbor {    // a field of another body that may touch this body, on the lattice of a field that is not the finest
    MPMField *field;
    int level;
    MPMReach reach;
  };
  std::vector<Neighbor> neighbors;
  std::vector<MPMReach> reaches;    // of the fields
  bool warned = false, told_of_cracks = false;

  void check(MPMField &coarse, MPMField &fine) const;
  void check_others(const MPMPlan &) const;
  void check_contact(const MPMPlan &, const FixMPMContact &) const;
  void check_contact_with(const MPMPlan &, const FixMPMContact &, int mine,
                          const std::string &theirs) const;
  void find_neighbors(const MPMPlan &);
  void find_tied();
  bigint cracked_at_rim(const MPMTwoScale &) const;
  int level(const std::string &name) const;
  int level(const MPMField &) const;
  bool is_stale() const;
};

}    // namespace LAMMPS_NS
#endif
#endif
