/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_COUPLED_LINES_H
#define LMP_MPM_COUPLED_LINES_H

#include "walls/mpm_crossing.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMLineConstraint;
class MPMWall;
class MPMWallReaction;

/** Lines of nodes that share nodes and prescribe nearly the same there: they act together. */
class MPMCoupledLines {
 public:
  std::vector<int> lines;        ///< indices of crossings
  std::vector<int64_t> nodes;    ///< all of their nodes, in order

  /** Finds the groups of lines that share nodes, along different axes and in front of the same
   *  material. */
  static std::vector<MPMCoupledLines> find(std::vector<MPMCrossing> &, bool sticks);

  /** Changes the velocities of the nodes. acts(line): does it act in this step? */
  template <class Acts>
  void act(MPMWallReaction &reaction, const MPMWall &wall, MPMField &field,
           std::vector<MPMCrossing> &crossings, const Acts &acts)
  {
    if (!begin(field)) return;
    for (std::size_t k = 0; k < lines.size(); k++)
      if (acts(crossings[lines[k]])) add_rows(k, reaction, wall, field, crossings[lines[k]]);
    solve(reaction, wall, field);
  }

 private:
  struct Row {    // an equation for the velocities of nodes
    int n;
    int node[NodeLine::MOST];    // indices in nodes
    double c[NodeLine::MOST];    // coefficients
    double normal[3];
    // velocity that the row removes: of components that stick, or along the normal (first one)
    double sum[3], old[3];
  };
  std::vector<Row> rows;
  std::vector<double> mass, active;    // masses of nodes; lines: 1 if it acts
  double heaviest = 0.0;
  std::vector<double> inverse;    // [row][row], valid for known_mass and known_active
  std::vector<double> known_mass, known_active;

  bool begin(MPMField &);
  void add_rows(std::size_t line, const MPMWallReaction &, const MPMWall &, MPMField &,
                MPMCrossing &);
  void find_inverse(bool sticks);
  void solve(MPMWallReaction &, const MPMWall &, MPMField &);
};

}    // namespace LAMMPS_NS

#endif
