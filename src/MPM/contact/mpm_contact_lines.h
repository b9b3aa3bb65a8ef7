/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTACT_LINES_H
#define LMP_MPM_CONTACT_LINES_H

#include "contact/mpm_contact_bodies.h"
#include "contact/mpm_contact_search.h"

#include <array>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/** Lines of nodes through the interfaces of bodies, for steps of a solver. At edges of bodies, it
 *  turns the interfaces. */
class MPMContactLines {
 public:
  struct Coverage {     // of the cross-section of a line by a body
    double g[3];        // sum of the gradients of its surface on the line, over the cross-section
    double alone[3];    // the same without mirror images
    double fraction;    // covered part of the cross-section
  };
  using Key = std::array<int, 6>;    // bodies, axis and direction, indices across
  struct Line {
    Key key;
    std::vector<std::pair<int, int>> places;    // index along the axis and pair, of each node
    int axis, index[3];                         // axis; index of any node of the line
    double sign;                                // of the normal along the axis
    int joins;                                  // line of which this one is a part; -1: none
    Coverage covered[2];                        // by both bodies
    double n[3];                                // direction of the interface normal, from a to b

    int low() const { return places.front().first; }
    int high() const { return low() + (int) places.size() - 1; }
  };

  MPMContactLines(MPMContactBodies &bodies, const MPMContactSearch &search) :
      bodies(bodies), search(search)
  {
  }

  std::vector<Line> list;

  /** Finds lines of interfaces and edges of the bodies along them. Turns interfaces at edges, and
   *  finds what walls do there. */
  void find(MPMContacts &);
  /** Finds the gap [distance] of a line between bodies of normal n that fill this fraction where
   *  they touch; negative: bodies overlap. Returns false where a body hardly covers the line. */
  bool measure_gap(const Line &, const double *n, double full, double &gap) const;

 private:
  using LinesByKey = std::map<Key, std::vector<int>>;    // indices of lines
  static constexpr int AROUND = 2;    // nodes of a line beyond those that both bodies reach

  MPMContactBodies &bodies;
  const MPMContactSearch &search;
  MPMContacts *contacts = nullptr;

  bool is_beyond_walls(MPMNodeContact &) const;
  int axis_at(const MPMNodeContact &, int *index, double &sign) const;
  void find_lines();
  Coverage coverage(const MPMContactBody &, const Line &, double sign) const;
  double turn_to_wider(Line &) const;
  void visit_neighbors(const LinesByKey &, const Line &,
                       const std::function<void(int k)> &use) const;
  double weight_of_neighbors(const Line &, double turned, const double *around) const;
  void turn(MPMNodeContact &, const Line &, double turned, double weight,
            const double *around) const;
  void join_lines(const LinesByKey &);
  void find_edges();
};

}    // namespace LAMMPS_NS
#endif
