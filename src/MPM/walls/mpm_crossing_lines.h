/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CROSSING_LINES_H
#define LMP_MPM_CROSSING_LINES_H

#include "walls/mpm_coupled_lines.h"
#include "walls/mpm_crossing.h"
#include "walls/mpm_wall_gap.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMWall;

/** Lines of nodes of a field through the surface of a region, along the axis that is nearest to the
 *  normal. */
class MPMCrossingLines {
 public:
  /** Node spacings; nodes cannot resolve smaller widths. */
  static constexpr double RESOLVED = 1.5;

  MPMCrossingLines(MPMWall &wall, MPMField &field) : wall(wall), field(field) {}

  std::vector<MPMCrossing> lines;
  /** Lines that do not act but show where a region is too thin for the nodes: at blades and
   *  wires. */
  std::vector<MPMCrossing> at_blades;
  /** Nodes inside whose nearest face is not that of the line that holds them, after act(). */
  std::vector<int64_t> held_nodes;

  /** Forgets all lines. */
  void clear();
  /** Lists the lines for the present state of the region. nodes: those inside; outside: those next
   *  to it. */
  void list(const std::vector<MPMWallNode> &nodes, const std::vector<MPMWallNode> &outside);
  /** Takes from the list the nodes that are on lines, which do not act on their own. */
  void take_nodes(std::vector<MPMWallNode> &);
  /** Activates the blocks of the nodes of lines. */
  void extend_topology();
  /** Has a moving region left the place around which there are blocks? */
  bool needs_topology() const;

  /** Changes the velocities of the nodes. first: number of the constraint of the first line. */
  void act(MPMWallContact &, std::size_t first);

  /** Mean distance of material that touches the surface at a line, by its index. slope: cosine
   *  between line and normal; place: of the surface on the line [node spacings], growing towards
   *  the material. */
  int contact_index(double slope, double place);
  const MPMContactDistance &contact(int index) const { return crossed[index]; }
  /** The same for a node at this depth in the region [node spacings]. */
  const MPMContactDistance &contact_at_depth(double depth);

  void mark_blocks(std::vector<char> &) const;
  void list_ties(std::vector<int64_t> &ties) const;

 private:
  MPMWall &wall;
  MPMField &field;
  std::vector<MPMCoupledLines> coupled;
  std::vector<MPMContactDistance> by_depth;    // for nodes
  std::vector<MPMContactDistance> crossed;     // for lines, computed when first needed
  std::vector<char> crossed_known;
  double blocks_at[4] = {};    // shift and angle of the region when the blocks around it were found
  bool blocks_known = false;

  bool find(const MPMWallNode &, MPMCrossing &);
  bool find_surface(const MPMWallNode &, MPMCrossing &, double *x, double &way) const;
  bool find_blade(const MPMWallNode &, MPMCrossing &) const;
  bool is_narrow(const MPMWallNode &, const double *x) const;
  void leave_alone();
  bool decide(const MPMWallContact &, MPMCrossing &);
  bool holds(const MPMCrossing &) const;
  void act_on_line(MPMWallContact &, MPMCrossing &);
  void change_old(const MPMLineConstraint &, const double *normal,
                  double change[3][NodeLine::MOST]) const;
};

}    // namespace LAMMPS_NS

#endif
