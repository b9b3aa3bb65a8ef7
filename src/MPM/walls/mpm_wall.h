/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_H
#define LMP_MPM_WALL_H

#include "pointers.h"
#include "walls/mpm_boundary_options.h"
#include "walls/mpm_region_surface.h"
#include "walls/mpm_wall_motion.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class Region;

/** A wall, which is one or more faces of the box, or a region: what it does, and how it moves. */
class MPMWall : protected Pointers, public MPMBoundaryOptions {
 public:
  static constexpr double FAR = 1.0e8;             ///< node spacings
  static constexpr double ON_SURFACE = 1.0e-6;     ///< node spacings
  static constexpr double NORMAL_STEP = 1.0e-4;    ///< node spacings, for differences
  /** Node spacings: largest distance from which material may reach a wall in an implicit step. */
  static constexpr double COMES_FROM = 2.5;
  /** Depth in a region [node spacings] up to which contact is known. */
  static constexpr double DEEPEST = 1.25;

  std::string id;                ///< of the fix, for messages
  std::vector<int> face_list;    ///< 2 * axis + (0: lo, 1: hi)
  std::string region_id;         ///< empty: faces
  Region *region = nullptr;
  std::unique_ptr<MPMRegionSurface> surface;    ///< of the region
  std::vector<MPMField *> fields;               ///< on which it acts, in the order of definition

  MPMWallMotion motion = {};    ///< in this step
  MPMWallState state = {};      ///< after the last step
  bool placed = false;          ///< is state.region valid in this run?
  bigint steps = 0;             ///< number of steps in this run

  bool in_implicit_steps = false;
  bool looks_ahead = false;        ///< looks for material that comes to the wall in implicit steps
  bool moves_and_holds = false;    ///< a moving region holds material by lines in implicit steps
  bool looks_for_thin_places = true;    ///< no such place has been reported yet
  bool is_grip = false;    ///< the material inside moves with the region, see mpm_wall_grip.cpp

  MPMWall(class LAMMPS *lmp, const std::string &id) : Pointers(lmp), id(id) {}

  /** Start of a run, before fields are listed, and after. */
  void init();
  void init_region();
  /** Start of a run, when regions have the state of the first step. */
  void setup();

  bool acts_on(const MPMField &) const;
  bool has_several_ranks() const;
  bool region_moves() const;
  /** Does the wall have a velocity, now or later in the run? */
  bool moves() const { return is_driven() || region_moves(); }
  /** Does a region act on lines of nodes through its surface? Otherwise it acts on each node
   *  inside. */
  bool acts_across() const;
  /** Do lines hold material in front of the surface? */
  bool holds_surface() const;
  /** Does the wall hold material that is near, whether or not that has reached it? */
  bool keeps_distance() const;
  /** Is the action of the wall known before a step? It is not where it depends on the impulses that
   *  the wall gets, or where the region moves and takes other nodes. */
  bool is_predictable() const { return !decides() && !region_moves(); }
  /** Does a wall with this normal always prescribe component d of the velocity? */
  bool prescribes(const double *normal, int d) const;
  /** Does this wall keep nodes at the face xlo, an axis of symmetry, from moving along x? */
  bool holds_axis(const MPMField &) const;

  /** Starts the motion of this step. A region has the state of the start of the step then. Returns
   *  false if the motion is known already. */
  bool begin_motion();
  /** Finds the motion of this step. A region has the state of the end of the step then. */
  void find_motion(double dt);

  /** Puts a moving region where it was at the end of the last step: others may have evaluated it
   *  since then. */
  void restore_region();
  /** Is the place of the region known, so that blocks far from it can be left out? */
  bool knows_place() const;
  /** Upper bound of the distance that parts of the region in the box have moved since the state
   *  then. */
  double way_since(const double *then) const;
  /** Unit normal of the region at x; zero: not known. */
  void normal(const MPMField &, const double *x, double *n) const;
  /** The distance from the region for a position at the start of the step, up to what nodes at the
   *  wall see and more (node spacings). The region is already where it will be at the end, so the
   *  position is moved with it. */
  std::function<double(const double *)> distance_from_region(const MPMField &, double dt,
                                                             double more = 0.0) const;

 private:
  bigint motion_step = -1;    // step for which the motion of the wall is known
  bool warned = false;        // about a region that is too fast

  void check_speed(double dt);
};

}    // namespace LAMMPS_NS

#endif
