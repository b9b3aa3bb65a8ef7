/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_CONTACT_SEARCH_H
#define LMP_MPM_WALL_CONTACT_SEARCH_H

#include "base/mpm_first_note.h"
#include "pointers.h"
#include "walls/mpm_wall_gap.h"

#include <array>
#include <functional>
#include <map>
#include <vector>

namespace LAMMPS_NS {
class MPMWall;
class MPMWallNodes;
struct MPMApproach;
struct MPMBoxFace;
struct NodeLine;

/** Finds the material that touches a wall, or approaches it, by mean distances of points
 *  (MPMWallGap). */
class MPMWallContactSearch : protected Pointers {
 public:
  MPMWallContactSearch(class LAMMPS *lmp, MPMWall &wall) : Pointers(lmp), wall(wall) {}

  /** Start of a run. */
  void begin_run() { first_gap.begin(); }
  /** Finds which lines and nodes the material touches in this step, which has the duration dt.
   *  tolerance: distance in node spacings at which it counts as touching. Collective. */
  void find_contacts(MPMWallNodes &, double dt, double tolerance);
  /** Finds lines of nodes through the surface of material in front of the wall, except those on
   *  which the wall acts already. Collective. */
  void find_approaches(MPMWallNodes &, double dt);
  /** Warns where a region that holds material does so across a gap. Collective. */
  void check_gaps(MPMWallNodes &, double dt);

 private:
  struct NearestNode {    // to the wall on a line
    double distance;
    int index[3];
    double normal[3];
  };
  // by axis, direction, and lateral place
  using Key = std::array<int, 4>;
  using Lines = std::map<Key, NearestNode>;
  using Distance = std::function<double(const double *)>;

  MPMWall &wall;
  MPMWallGap gap;
  MPMFirstNote<5> first_gap;    // step, minus mean distance, place

  void map_region(MPMWallNodes &, double dt);
  void find_region_contacts(MPMWallNodes &, double dt, double tolerance);
  MPMWallGap::Sums sums(const NodeLine &) const;

  static Key key_of(int axis, bool up, const int *index);
  MPMDistanceFrom distance_from(const MPMBoxFace *, double dt) const;
  Lines lines_in_front(const MPMWallNodes &, const MPMBoxFace *, const Distance &,
                       std::vector<char> &near) const;
  void leave_out_acting(MPMWallNodes &, MPMBoxFace *, Lines &) const;
  double beyond(MPMWallNodes &, const Key &, const NearestNode &, double place, double distance,
                MPMApproach &) const;
  bool find_surface(MPMWallNodes &, const Key &, const NearestNode &, const Distance &, double *x,
                    MPMApproach &) const;
};

}    // namespace LAMMPS_NS

#endif
