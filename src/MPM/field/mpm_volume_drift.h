/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_VOLUME_DRIFT_H
#define LMP_MPM_VOLUME_DRIFT_H

#include "base/mpm_lists.h"
#include "field/mpm_free_room.h"
#include "field/mpm_point_map.h"
#include "pointers.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class MPMField;

/** Compares the volumes of points with the room that they fill, which differ more and more where
 *  points are strained without end, and makes the volumes of liquids follow the room (keyword drift
 *  of fix mpm).
 *
 *  Volumes V_p = J V0 are integrals of velocity gradients at points, and places are integrals of
 *  velocities. With the functions N of the lattice, the filling of a node is
 *
 *    f_i = sum_p N_ip V_p / integral of N_i over the box
 *
 *  It is one inside a body, and larger where points are too close together for their volumes. A
 *  node is inside if all nodes around all of its points are at least half full; all others are next
 *  to a surface, a wall, or another body, and tell nothing. */
class MPMVolumeDrift : protected Pointers {
 public:
  MPMVolumeDrift(class LAMMPS *lmp, MPMField &field) :
      Pointers(lmp), field(field), free_room(lmp, field)
  {
  }

  /** Start of a run. */
  void init();
  /** Start of a step of the cycle, when the map of points is valid. Collective. */
  void step();
  /** The part of a step of duration dt in the change of the volumes of n points from first on, of
   *  which these are the deformation gradients [n][9], before the strain of the step. */
  void change_volumes(const FixMPMMaterial *, int first, int n, double dt, double *F) const;
  /** A line for the summary of the run; empty if the field has no nodes inside of bodies. */
  std::string report() const;

  double memory_usage() const
  {
    return bytes_of(fill, part, share, circles, change) + free_room.memory_usage();
  }

 private:
  MPMField &field;
  MPMFreeRoom free_room;
  bool has_liquid = false;
  bool corrects = false, warned = false, cleared = false;
  /** Nodes inside of bodies, of all ranks. */
  struct {
    double nodes = 0.0, mean = 0.0, rms = 0.0;    // mean filling, and rms difference from one
    double lasting = 0.0;                         // mean over some time
  } inside;
  /** Points of gases: difference of pressures from the means around them. */
  struct {
    double spread = 0.0;
    bool warned = false;
  } gas;
  std::set<const FixMPMMaterial *> gases;
  std::vector<double> fill;    // [node] filling
  std::vector<double>
      part;    // [node] share of its function that is in the box, and outside of regions
  std::vector<double> share;      // [node] of part that regions leave
  std::vector<double> circles;    // [node] of mean_circle(); empty: no axis of symmetry
  std::vector<double> change;     // [n] strain since the last look
  std::map<const FixMPMMaterial *, double> stiffness;    // at rest, of liquids [pressure]

  int looks_every() const;    // 0: never
  double part_along(int axis, int node) const;
  double part_in_box(int64_t node) const;
  bool is_in_wall(std::size_t node) const;
  double mean_circle(int64_t node) const;
  void sum_at_nodes();
  void interpolate();
  void find_filling();
  void find_strain();
  void mark_points_at_surfaces();
  void find_inside();
  void find_spread();
  void note(int every);
  void note_spread();
  double *rates(const FixMPMMaterial *) const;
  void find_rates();
  void clear_rates();
};

}    // namespace LAMMPS_NS
#endif
