/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CROSSING_LINES_H
#define LMP_MPM_CROSSING_LINES_H

#include "field/node_line.h"
#include "walls/mpm_wall_contact.h"
#include "walls/mpm_wall_gap.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMLineConstraint;
class MPMWall;
class MPMWallReaction;

/** A line of nodes from the inside of a region through its surface to the outside. */
struct MPMCrossing : NodeLine {
  /** SOUND: always acts; THIN_PLACE (another face is near): acts unless the material is behind;
   *  NEAR_OTHERS (nodes of the line are nearer to another face, or beyond it): acts only if the
   *  material is in front. */
  enum Front { SOUND, THIN_PLACE, NEAR_OTHERS };

  int64_t base;        ///< node of the line from which the line was found
  int64_t behind;      ///< next node in the region, which only material inside reaches
  double surface;      ///< position of the surface on the axis
  double normal[3];    ///< of the surface at the crossing
  int contact;         ///< index of MPMCrossingLines::contact()
  int inside;          ///< number of nodes behind the surface, which come first
  int place;           ///< coordinate of the first node on the line, growing outward
  double depth;        ///< depth of the first node behind the surface [node spacings]
  MPMContactState state = MPMContactState::OPEN;
  bool touched = true;    ///< the surface of the material touches it in this step
  Front front = SOUND;
  bool acts = true;
  bool in_plate = false;    ///< in a plate thinner than what nodes resolve, no corner
  bool alone = false;       ///< grips: shares no node with another line
  bool coupled = false;     ///< acts together with others, see MPMCoupledLines
  bool at_edge = false;     ///< nodes act in its place, see MPMWallNodes::hold_at_edges()

  // where is the material, judged by the masses of nodes?

  /** Is it in front of the surface alone? */
  bool is_in_front(MPM_NS::Grid &) const;
  /** Is the mass of nodes in front at most this share of that of nodes behind? */
  bool is_behind(MPM_NS::Grid &, double share) const;
  /** Is there material in the region, about a spacing below the surface or deeper? */
  bool has_material_inside(MPM_NS::Grid &) const;
  /** Is there material on both sides of the surface, and can the line hold it? */
  bool goes_through(MPM_NS::Grid &) const;
};

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
  bool is_plate(const double *surface, const double *normal) const;
  void leave_alone();
  bool decide(const MPMWallContact &, MPMCrossing &);
  bool holds(const MPMCrossing &) const;
  void act_on_line(MPMWallContact &, MPMCrossing &);
  void change_old(const MPMLineConstraint &, const double *normal,
                  double change[3][NodeLine::MOST]) const;
};

}    // namespace LAMMPS_NS
#endif
