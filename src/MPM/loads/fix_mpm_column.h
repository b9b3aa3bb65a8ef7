/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/column,FixMPMColumn);
// clang-format on
#else

#ifndef LMP_FIX_MPM_COLUMN_H
#define LMP_FIX_MPM_COLUMN_H

#include "field/mpm_coupling.h"
#include "field/mpm_node_action.h"
#include "fix.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** A body that represents a column of level ground. All nodes at the same height have one velocity,
 *  so that the column moves like ground of infinite extent, whatever its width. Fix mpm/dashpot
 *  takes the motion and the stress of the free field from it. */
class FixMPMColumn : public Fix, public MPMNodeAction, public MPMCoupling {
 public:
  FixMPMColumn(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::POST_FORCE; }
  void init() override;
  void setup(int) override;
  void post_force(int) override { find_layers(); }
  double memory_usage() override;

  Turn turn() const override { return PHASES; }    // before walls, which may shake it
  void init_action() override;
  bool looks_beyond_points() const override { return false; }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override { return false; }
  /** Planes of nodes. */
  void topology_changed(MPMField &which) override
  {
    if (&which == field) fresh = true;
  }
  void act(double, Stage stage) override { level(stage); }
  void has_acted(MPMNodeAction &, Stage stage) override { level(stage); }
  /** The free field meets nothing: it stands for ground that is far away. */
  bool couples(const std::string &one, const std::string &other) const override
  {
    return one == of || other == of;
  }

  // for the users of this column, the same on all ranks

  int axis = 0;    ///< axis of the column
  /** Its field. Valid during a run. */
  MPMField &ground() const;
  /** Present stress [pressure] xx yy zz xy xz yz at a height on the lattice: linear between layers
   *  of points, and extrapolated by half of their distance beyond the lowest and the highest
   *  layer. */
  void stress(double height, double sigma[6]) const;
  /** Velocity at a height before the momentum equation, and its change by this equation; after the
   *  column has acted in this step. */
  void motion(double height, double old[3], double change[3]) const;
  /** Heights of the lowest and the highest layer, and the largest distance between layers. */
  double lowest() const { return layers.front().height; }
  double highest() const { return layers.back().height; }
  double apart() const { return most_apart; }

 private:
  std::string of;    // ID of the fix mpm
  MPMField *field = nullptr;

  struct Layer {
    double volume, height, sigma[6];
  };
  std::vector<Layer> layers;    // from the lowest to the highest
  double most_apart = 0.0;

  bool fresh = true;    // the topology has changed
  int first_row = 0;    // index of the lowest plane of nodes
  // for each plane of nodes: mass, momentum, and, in a step, momentum before the momentum equation
  static constexpr int WIDTH = 7;
  std::vector<double> mine, rows;

  void level(Stage);
  void find_rows();
  void find_layers();
};

}    // namespace LAMMPS_NS
#endif
#endif
