/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_H
#define LMP_MPM_WALL_H

#include "declare/option.h"
#include "field/mpm_friction_heat.h"
#include "lattice/grid.h"
#include "pointers.h"
#include "walls/mpm_region_surface.h"
#include "walls/mpm_wall_gap.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class Region;

/** Keywords of fix mpm/boundary. */
struct MPMBoundaryOptions {
  enum Kind { STICK, SLIP, SEPARATE };

  Kind kind = STICK;
  double friction = 0.0;
  /** Another coefficient of friction where the wall is in a region; of several that have a place,
   *  the last one counts. */
  struct Patch {
    std::string region_id;
    double friction = 0.0;
    Region *region = nullptr;
  };
  std::vector<Patch> patches;
  Patch patch;                                   ///< the one that is read
  MPM_NS::NumberOrVariable velocity[3], rate;    ///< components that are not given are free
  bool by_displacement = false;                  ///< velocity[] holds displacements
  double center[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 0.0};    ///< of the rotation
  std::string field_id;                                             ///< empty: all fields
  MPMFrictionHeatOptions heat;

  bool all_given() const { return velocity[0].given && velocity[1].given && velocity[2].given; }
  /** Does the impulse decide whether there is contact, or whether it slides? */
  bool decides() const { return kind == SEPARATE || rubs(); }
  /** The least coefficient that is not zero; zero if all are. */
  double least_friction() const;
  /** Has the wall friction anywhere? */
  bool rubs() const { return friction > 0.0 || !patches.empty(); }
  bool rotating() const { return axis[0] != 0.0 || axis[1] != 0.0 || axis[2] != 0.0; }
  /** Is the wall given a velocity? If it is a region, material at its surface may leave the
   *  region. */
  bool is_driven() const;
  /** Is one of the quantities that give the motion a variable? */
  bool has_variables() const;
  MPM_NS::Options declare(int dimension);
};

/** State of a wall after the last step, as kept in restart files, without padding. */
struct MPMWallState {
  double work;    ///< on the body, this rank's share; in files as energy, of all ranks
  double shift[3], gradient[3][3], origin[3];    ///< velocity at the end of the last step
  double region[4];                 ///< shift and angle of the region at the end of the last step
  double displaced[3];              ///< displacement at that time
  double turned[3][3], moved[3];    ///< as in MPMWallMotion, at that time
  int64_t acted;                    ///< was there a last step?
};

/** Motion of a wall in a step: its velocity at x is shift + gradient (x - origin). */
class MPMWallMotion {
 public:
  double shift[3], gradient[3][3], origin[3];
  double before[3];    ///< shift in the last step
  bool uniform;        ///< no gradient
  bool changes;        ///< may the velocity differ from that in the last step?

  /** Start of a step that follows this state: the wall is at rest. */
  void begin(const MPMWallState &);
  /** Turns by an angle about a unit axis through a center in the time dt. */
  void rotate(double angle, const double *axis, const double *center, double dt);
  /** For the total frame, whose nodes keep the positions X of the start: from now on, the velocity
   *  is a function of X. The state is that before this step, and becomes that after it. */
  void refer_to_start(MPMWallState &, double dt);
  /** The same motion as a function of the positions at the end of the step. */
  MPMWallMotion at_end_of_step(double dt) const;
  /** Notes the velocity at the end of the step. */
  void end(MPMWallState &) const;

  void velocity(const double *x, double *v) const;
  void velocity(const MPM_NS::Grid &, int64_t node, double *v) const;
  /** Half of the change of the velocity since the last step, for the work on a node. */
  void half_change(const MPM_NS::Grid &, int64_t node, double *v) const;
  /** Component d of the old velocity in a node record relative to the wall, but at most limit. */
  double old_relative(const double *record, int d, double limit) const;
  /** Present position of the material at X, where nodes of the total frame are. */
  void position(const double *X, double *x) const;

 private:
  double gradient_before[3][3], origin_before[3];    // at its end, see at_end_of_step()
  double turned[3][3], moved[3];    // nodes of the total frame at X are at X + turned X + moved
};

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
  /** Do distances tell in this step where material is, and not the masses of outer nodes? */
  bool by_distance = false;
  bool looks_for_thin_places = true;    ///< no such place has been reported yet
  bool is_grip =
      false;    ///< the material inside moves with the region, see MPMWallTrial::find_carried()

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
  bool keeps_distance() const { return region ? holds_surface() : !decides(); }
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
  /** Coefficient of friction at x, on the surface of the wall. */
  double friction_at(const double *x) const;
  /** The same at n nodes of a line, of which those with -1 do not count. */
  double friction_at(const MPM_NS::Grid &, const int64_t *node, int n) const;
  /** Unit normal of the region at x; zero: not known. */
  void normal(const MPMField &, const double *x, double *n) const;
  /** The distance from the region for a position at the start of the step. The region is already
   *  where it will be at the end, so the position is moved with it. */
  MPMDistanceFrom distance_from_region(double dt) const;

 private:
  bigint motion_step = -1;    // step for which the motion of the wall is known
  bool warned = false;        // about a region that is too fast

  void check_speed(double dt);
  void find_patches();
  bool may_meet(const Region &) const;
};

}    // namespace LAMMPS_NS
#endif
