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

#include "fix.h"
#include "mpm_node_action.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** A body that is a column of level ground: all nodes at the same height have one velocity, so that it moves as if
 *  it went on at its sides without end, whatever its width is. Fix mpm/dashpot takes the motion and the stress of the free field
 *  from it. */
class FixMPMColumn : public Fix, public MPMNodeAction {
 public:
  FixMPMColumn(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::POST_FORCE; }
  void init() override;
  void setup(int) override;
  void post_force(int) override;
  double memory_usage() override;

  Turn turn() const override { return PHASES; }    // who shakes it sees the motion of the column
  void init_action() override;
  bool looks_beyond_points() const override { return false; }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override { return false; }
  void topology_changed(MPMField &) override;
  void act(double, Stage stage) override { level(stage); }
  void has_acted(MPMNodeAction &, Stage stage) override { level(stage); }

  // for who has this column at its side, all the same on all ranks

  int axis = 0;    ///< along which it stands
  /** Its field, in this run. */
  MPMField &ground() const;
  /** Stress [pressure] xx yy zz xy xz yz at a height, on the lattice, in the present state: linear between layers of points and on to
   *  half of their distance beyond the lowest and the highest. */
  void stress(double height, double sigma[6]) const;
  /** Velocities in this step, after it has acted: before the momentum equation, and what that has changed. */
  void motion(double height, double old[3], double change[3]) const;
  /** Heights of the lowest and the highest layer, and the largest distance of layers. */
  double lowest() const { return layers.front().height; }
  double highest() const { return layers.back().height; }
  double apart() const { return most_apart; }

 private:
  std::string of;    // ID of the fix mpm
  MPMField *field = nullptr;

  struct Layer {
    double volume, height, sigma[6];
  };
  std::vector<Layer> layers;    // upwards
  double most_apart = 0.0;

  bool fresh = true;    // the nodes are new
  int first_row = 0;    // number of the lowest plane of nodes
  // of planes of nodes: mass, momentum, and, in a step, momentum before the momentum equation
  static constexpr int WIDTH = 7;
  std::vector<double> mine, rows;

  void level(Stage);
  void find_rows();
  void find_layers();
};

}    // namespace LAMMPS_NS
#endif
#endif
