/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/boundary,FixMPMBoundary);
// clang-format on
#else

#ifndef LMP_FIX_MPM_BOUNDARY_H
#define LMP_FIX_MPM_BOUNDARY_H

#include "base/mpm_first_note.h"
#include "declare/option.h"
#include "field/mpm_friction_heat.h"
#include "field/mpm_line_ties.h"
#include "field/mpm_node_action.h"
#include "field/mpm_trial_contact.h"
#include "field/node_line.h"
#include "fix.h"
#include "walls/mpm_region_surface.h"
#include "walls/mpm_wall_gap.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
class Grid;
}

namespace LAMMPS_NS {
class MPMField;
class Region;

/** Keywords of fix mpm/boundary. */
struct MPMBoundaryOptions {
  enum Kind { STICK, SLIP, SEPARATE };

  Kind kind = STICK;
  double friction = 0.0;
  MPM_NS::NumberOrVariable velocity[3], rate;    ///< components that are not given are free
  bool by_displacement = false;                  ///< velocity[] holds displacements
  double center[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 0.0};    ///< of the rotation
  std::string field_id;                                             ///< empty: all fields
  MPMFrictionHeatOptions heat;

  bool all_given() const { return velocity[0].given && velocity[1].given && velocity[2].given; }
  /** Does the impulse decide whether there is contact, or whether it slides? */
  bool decides() const { return kind == SEPARATE || friction > 0.0; }
  bool rotating() const { return axis[0] != 0.0 || axis[1] != 0.0 || axis[2] != 0.0; }
  MPM_NS::Options declare(int dimension);
};

/** Walls that act on the nodes of the fields: faces of the box, or a region.
 *
 *  A face is a mirror: nodes beyond it are images of nodes inside of the box. A region acts on lines
 *  of nodes through its surface, or on each of the nodes inside of it, see acts_across().
 */
class FixMPMBoundary :
    public Fix,
    public MPMNodeAction,
    public MPMRubbing,
    public MPMLineTies,
    private MPMTrialContact,
    private MPMBoundaryOptions {
 public:
  Turn turn() const override { return WALLS; }
  FixMPMBoundary(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  void init() override;
  void init_action() override;
  void setup(int) override;
  void post_run() override { report_width(); }
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  void couple_topology() override;
  void extend_topology(MPMField &) override;
  void topology_changed(MPMField &) override;
  bool looks_beyond_points() const override { return false; }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override;
  bool decides_contact(const MPMField &) const override;
  bool is_projection() const override { return !decides(); }
  void list_ties(const MPMField &, std::vector<int64_t> &, std::vector<int64_t> &) const override;
  MPMTrialContact *trial_contact() override { return decides() || follows ? this : nullptr; }
  void act(double dt, Stage) override;

  bool loses_heat() const override { return friction > 0.0 && !heat.said; }
  bool gives_heat() const override { return heat.heats(); }
  /** Is the wall a region? Otherwise it is one or more faces of the box. */
  bool is_region() const { return !region_id.empty(); }
  /** Do the walls have a velocity, now or later in the run? */
  bool moves() const;
  /** Signed distance of x from the surface of the region, negative inside; far if it is larger. Only during a run. */
  double distance(const double *x, double far) const { return surface->distance(x, far); }
  bool holds_axis(const MPMField &) const override;

  /** Velocities that walls will give to nodes. */
  struct Foreseen {
    struct Mirror {              // a node and its images
      double mass;               // sum over all of these nodes
      double wall[3], odd[3];    // velocity of the wall; odd part of velocities relative to it
    };
    std::vector<double> held;     // [3*node+d] velocities of nodes that are held
    std::vector<int> mirrored;    // [3*node+d] index in mirrors + 1, negative for an image; 0: none
    std::vector<Mirror> mirrors;

    /** Empties all lists, for this number of nodes. */
    void reset(int64_t nnodes);
  };
  /** Corrects the impulse that the wall counted for a node when it acted in this step: adds push, an impulse on
   *  the body [mass velocity], to the reaction, its moment, and the work, with the present velocities. */
  void bear(MPMField &, int64_t node, const double *push);

  /** Marks the velocity components of nodes that this wall always prescribes: sets bit d of
   *  held[node], with one entry per node, and bit 3 + d where the wall mirrors a node outside. */
  void mark_held(const MPMField &, std::vector<char> &held) const;
  /** Finds the velocities that this wall will give to nodes, from their present velocities. near: [block]. */
  void foresee(MPMField &, const std::vector<char> &near, Foreseen &);

 private:
  static constexpr int DEPTH = 3;    // paired nodes on either side of a mirror plane
  // node spacings: largest distance from which material may reach a wall in an implicit step; range of nodes needed for it
  static constexpr double COMES_FROM = 2.5;
  static constexpr int SOUGHT = 6;
  static constexpr double DEEPEST =
      1.25;    // depth in a region [node spacings] up to which contact is known

  struct Face {    // a face of the box on the lattice of a field
    int axis;
    int inward;          // direction from the face into the box along the axis: 1 or -1
    int plane;           // index of its plane of nodes, or the nearest one
    bool cut = false;    // lies between planes: nweight nodes from first on make its velocity
    int first = 0, nweight = 0;
    double weight[4];
    MPMWallContact contact;    // of material that touches it

    Face(const MPMField &, const Domain &, int face);
    // range of nodes along the axis that are treated together
    int begin() const { return cut ? first : plane - DEPTH; }
    int end() const { return cut ? first + nweight - 1 : plane + DEPTH; }
    int length() const { return cut ? nweight : 1 + 2 * DEPTH; }    // nodes in a line
    void cut_weights(const MPMField &, double x);
    MPMWallContact contact_of(const MPMField &, double x) const;
  };
  using Faces = std::vector<Face>;
  enum Contact { FREE, SLIDING, STUCK };    // what a wall does to a line or node

  // nodes along the normal of a face: if it cuts cells, from its first node on; else, with friction
  // or separation, in the plane, inside, and their images; -1: out of reach of points
  struct Line {
    int face;    // index into faces
    Contact contact;
    bool touched;    // separate: the surface of the material touches it in this step
    int64_t node[1 + 2 * DEPTH];
  };
  struct Member {
    int64_t node;
    int sign;
  };
  struct Orbit {           // a node with all its images: in one face, in two at an edge, ...
    int64_t wall;          // node at the wall where the velocity of the wall is taken
    int64_t inner;         // first node inside; -1: out of reach of points, or also held by a wall
    int first, last;       // range in members
    bool prescribed[3];    // components
    bool fixed;            // lies in the plane of a face
  };
  struct Single {    // a node on its own
    int64_t node;
    double normal[3] = {0.0, 0.0, 0.0};    // from the wall to the body; zero: unknown
    double growth = 0.0;      // speed of the surface of a region that changes its shape
    double distance = 0.0;    // from the surface at the start of the step; for growth and gaps
    double share = 1.0;       // share of the change to the velocity of the wall that the node takes
    Contact contact = FREE;
    bool touched = true;    // separate: the surface of the material touches it in this step
  };
  // a line of nodes along an axis, from the inside of a region through its surface to the outside
  struct Crossing : NodeLine {
    int64_t base;        // node of the line from which the line was found
    int64_t behind;      // next node in the region, which only material inside reaches
    double surface;      // position of the surface on the line
    double normal[3];    // of the surface at the crossing
    int full;            // index of its contact
    int inside;          // number of nodes behind the surface, which come first
    int place;           // coordinate of the first node on the line, growing outward
    double depth;        // depth of the first node behind the surface [node spacings]
    Contact contact = FREE;
    bool touched = true;    // the surface of the material touches it in this step
    // SOUND: always acts; THIN_PLACE (another face is near): acts unless the material is behind; NEAR_OTHERS (nodes of the
    // line are nearer to another face, or beyond it): acts only if the material is in front
    enum Front { SOUND, THIN_PLACE, NEAR_OTHERS } front = SOUND;
    bool acts = true, in_plate = false;    // in_plate: in a plate thinner than RESOLVED
    bool alone = false;                    // grips: shares no node with another line
    bool in_knot = false;
  };
  // lines that share nodes and prescribe nearly the same there; they act together, see fix_mpm_boundary_knot.cpp
  struct Knot {
    std::vector<int> lines;             // indices of crossings
    std::vector<int64_t> node;          // all of their nodes
    std::vector<double> mass, share;    // masses of nodes and shares of lines (0: does not act)
    std::vector<double> inverse;        // [row][row], valid for this mass and share
  };
  // in trials: a line of nodes through the surface of material that is not at the wall yet, in the
  // direction from the wall to the material, see fix_mpm_boundary_approach.cpp
  struct Approach : NodeLine {
    double normal[3];    // of the wall
    double gap;          // between wall and material [distance]
  };
  struct FieldNodes {
    MPMField *field;
    Faces faces;
    std::vector<Line> lines;
    std::vector<Member> members;
    std::vector<Orbit> orbits;
    std::vector<Single> singles;
    std::vector<Crossing> crossings = {};
    std::vector<Knot> knots = {};
    // lines that do not act but show where a region is too thin for the nodes: at blades and wires
    std::vector<Crossing> looked_at = {};
    std::vector<MPMWallContact> contacts = {};    // for nodes by their depth in a region
    std::vector<MPMWallContact> crossed = {};     // for crossings, computed when first needed
    std::vector<char> crossed_known = {};
    std::vector<Approach> approaches = {};
    struct Around {
      double at[4] = {};    // shift and angle of the region when the blocks around it were found
      bool known = false;
    } around = {};

    void list_line(int face, const int *index);
    void list_orbits(const bool *prescribed, int axis);
  };
  // nodes of a line that have mass, from the outside of the material to the inside, see fix_mpm_boundary_cut.cpp
  struct Chain {
    int m = 0;
    int inner = 0;    // index of the node whose old velocity FLIP takes as that near the wall
    int64_t node[4];
    const double *r[4];    // node records
    double A[4], B[4] = {0.0, 0.0, 0.0, 0.0}, V[4][3], total = 0.0;
    bool straight = false;    // B is used

    void prepare(bool all);
    bool is_straight() const { return straight; }
    double solve(const double *relative, double *change) const;

   private:
    double inverse[4], heaviest = 0.0;    // inverse masses, 1 for the heaviest node
    double AA = 0.0, det = 0.0;

    double D(int j, int k) const { return A[j] * B[k] - A[k] * B[j]; }
  };
  struct Wall {    // motion of the wall in a step: velocity = shift + gradient (x - origin)
    double shift[3], gradient[3][3], origin[3];
    double before[3];                                  // shift in the last step
    double gradient_before[3][3], origin_before[3];    // at its end, see at_end_of_step()
    bool uniform;
    bool changes;                     // may the velocity differ from that in the last step?
    double turned[3][3], moved[3];    // nodes of the total frame at X are at X + turned X + moved

    void rotate(double angle, const double *axis, const double *center, double dt);
    void refer();
    Wall at_end_of_step(double dt) const;
    void velocity(const MPMField &, int64_t node, double *v) const;
    void velocity(const double *x, double *v) const;
    void half_change(const MPMField &, int64_t node, double *v) const;
    double old_relative(const double *record, int d, double limit) const;
  };
  struct Prescribed {    // velocity that a wall gives to nodes
    double V[3];
    double share[3];    // share of the change to V that nodes take
    double limit[3];    // bound of constrained old velocities, relative to the wall
    bool hold[3];       // are the old velocities constrained?
  };
  struct Past {     // state of previous steps, as kept in restart files, without padding
    double work;    // on the body, this rank's share; in files as energy, of all ranks
    double shift[3], gradient[3][3],
        origin[3];                    // velocity of the wall at the end of the last step
    double region[4];                 // shift and angle of the region at the end of the last step
    double displaced[3];              // displacement at that time
    double turned[3][3], moved[3];    // as in Wall, at that time
    int64_t acted;                    // was there a last step?
  };

  std::vector<int> face_list;    // 2 * axis + (0: lo, 1: hi)
  std::string region_id;
  Region *region = nullptr;
  std::unique_ptr<MPMRegionSurface> surface;    // of the region

  std::vector<FieldNodes> nodes;    // one entry for each field to act on
  Wall wall = {};                   // in this step
  Past past = {};
  bigint motion_step = -1;    // step for which the motion of the wall is known
  double impulse[6] = {};     // on the body, and its moment, in the last step; this rank's share
  double dt_last = 0.0;
  bool reaction_known = true;
  bool placed = false;    // is past.region valid in this run?
  std::vector<int64_t>
      held_by_lines;    // nodes inside whose nearest face is not that of their line
  MPMWallGap gap;
  bool warned = false;            // about a region that is too fast
  bigint steps = 0;               // number of steps of this fix in this run
  MPMFirstNote<5> too_thin;       // region: step, index of the field, place
  MPMFirstNote<5> not_touched;    // follows: step, minus mean distance, place
  double reaction[6] = {};        // force and torque

  // contact decided by a solver, see mpm_trial_contact.h: one entry for each line, crossing, single, and approach, in this order
  struct Touch {
    bool open;             // the material touches the wall, or may touch it in this step
    bool active = true;    // the material is held at the wall
    double gap = 0.0;      // between material and wall at the start of the step [distance]
    double push = 0.0, base = 0.0, force = 0.0;    // impulse; part by motion of walls; N
    double slip[3] = {0.0, 0.0, 0.0}, rubs[3] = {0.0, 0.0, 0.0};    // slip s; friction force
    double dual[3] = {0.0, 0.0, 0.0};                               // w, see add_friction_change()
    explicit Touch(bool open) : open(open), active(open) {}
  };
  struct {                      // state of act() while it treats the nodes of a field
    bool counting;              // reactions and work are counted
    bool decided;               // contact was decided before in this step (MUSL)
    class MPMLedger *ledger;    // null: none; else old velocities are in reals 4..6
    double old_share;           // FLIP share when old velocities are constrained, too; otherwise 0
    double kinetic;             // kinetic energy gained by the nodes
    double driven;              // part of it that is work by the motion of the wall
    double collided;         // ledger: kinetic energy lost where nodes cannot keep their velocity
    int place;               // index of the field in the list
    const double *normal;    // of a wall on which nodes slide and become warm; null: no such wall
    Touch *touch;            // contact decided by a solver; null: decided here
    double unit;             // unit of pushes, as an impulse
  } now;

  struct Held {    // a node, and its share in the motion of the surface
    int64_t node;
    double share;
  };
  std::vector<Touch> touches;
  bool in_trials = false;
  MPMField *tried = nullptr;
  const double *motion = nullptr;    // velocities of nodes at the end of the step
  double trial_dt = 0.0, trial_slip_time = 0.0, eps = 0.0, soft = 0.0;
  double rub_share = 1.0;    // share of the friction that nodes get
  int rounds = 0;            // rounds of decisions in this step
  bool in_implicit_steps = false;
  bool seeks = false;       // looks for material that comes to the wall in implicit steps
  bool follows = false;     // a moving region holds material by lines in implicit steps
  bool carrying = false;    // a grip for the material inside, see fix_mpm_boundary_carry.cpp
  bool closes =
      false;    // lines that are held move to the wall now; else they are at rest relative to it
  std::vector<double> clear;    // [point][face] distance from the wall at the start of the step

  void begin_trials(MPMField &, double dt, double slip_time, double eps, bool rests) override;
  bool close_gaps(bool yes) override;
  void check_arrival() override;
  bool find_carried(MPMField &, std::vector<double> &) override;
  void bear_carried(MPMField &, double *force) override;
  void find_lines_alone(FieldNodes &) const;
  static bool goes_through(MPM_NS::Grid &, const Crossing &);
  bool has_friction() const override { return friction > 0.0; }
  void forget_pushes() override;
  void take_base() override;
  void take_forces(double scale) override;
  void add_friction(const double *u, double *force) override;
  void add_friction_change(const double *du, double scale, double *dforce) override;
  void add_friction_blocks(double *blocks) override;
  void add_friction_stiffness(double *stiffness) override;
  void correct(const double *du) override;
  bool decide(const double *u, double unbalanced) override;
  void soften(double by) override { soft = by; }
  void foresee_velocities(const double *v, double share) override
  {
    motion = v;
    rub_share = share;
  }
  FieldNodes &tried_nodes();
  void find_approaches(FieldNodes &, double dt);
  void find_clear(const FieldNodes &, double dt);
  bool is_deep(const FieldNodes &, std::size_t single) const;
  void extend_to_approaches(MPMField &) const;
  void act_on_approach(const FieldNodes &, const Approach &, Touch &);
  template <class Use> void visit_touches(const Use &use);
  int find_held(const FieldNodes &, int k, Held *held, double *normal) const;
  void change_of_direction(const Touch &, const double *slip, double *change) const;
  void find_slip(const Held *, int n, const double *normal, const double *u, double time,
                 double *slip, double &away) const;
  void rub_nodes(MPM_NS::Grid &);
  std::vector<double>
      water;    // [node][3] impulse of pore water on the surface of the body; empty: none
  std::unique_ptr<MPMFrictionHeat> heating;    // null: not requested

  bool region_moves() const;
  /** Does a region act on lines of nodes through its surface? Otherwise it acts on each node inside. */
  bool acts_across() const;
  bool is_driven() const;
  bool holds_surface() const;
  bool keeps_distance() const;
  bool is_foreseen() const;
  bool holds(const double *normal, int d) const;
  bool acts_on(const MPMField &) const;
  Faces faces_on_lattice(const MPMField &) const;
  static bool faces_are_near(const Faces &, int axis);
  void list_face_nodes(FieldNodes &);
  void list_region_nodes(FieldNodes &);
  bool knows_place() const;
  double way_since(const double *then) const;
  void extend_across(MPMField &);
  void list_crossings(FieldNodes &, const std::vector<Single> &outside);
  void list_knots(FieldNodes &) const;
  void act_on_knot(const FieldNodes &, Knot &);
  void take_off_lines(FieldNodes &);
  bool find_crossing(FieldNodes &, const Single &, Crossing &);
  bool looks_at_blade(const MPMField &, const Single &, Crossing &) const;
  static bool is_in_front(MPM_NS::Grid &, const Crossing &);
  static bool is_behind(MPM_NS::Grid &, const Crossing &, double share);
  static bool is_inside(MPM_NS::Grid &, const Crossing &);
  bool holds_line(MPM_NS::Grid &, const Crossing &) const;
  bool looks_at_width() const;
  void check_width(const FieldNodes &);
  void report_width();
  static int crossed_contact(FieldNodes &, double slope, double place);
  void update_motion(double dt);
  void find_gaps(FieldNodes &, double dt);
  void find_region_gaps(FieldNodes &, double dt);
  void map_region_gaps(FieldNodes &, double dt);
  void note_gaps(FieldNodes &, double dt);
  std::function<double(const double *)> distance_from_region(const MPMField &, double dt,
                                                             double more = 0.0) const;
  void check_speed(double dt);
  double slide_share(Contact &, double push, double water, double needed) const;
  void find_water(const FieldNodes &, double dt);
  double water_on(const int64_t *node, int n, const double *normal) const;
  void push_by_water(MPM_NS::Grid &, int64_t node, const double *normal);
  void set_velocity(MPM_NS::Grid &, int64_t node, const double *V, const double *v,
                    const double *old, const double *whole = nullptr);
  void heat_if_sliding(Contact, const double *normal);
  double slip_work(MPM_NS::Grid &, int64_t node, const double *V, const double *change,
                   const double *v, const double *counted);
  void add_moment(const MPM_NS::Grid &, int64_t node, const double *push);
  static bool is_constrained(MPM_NS::Grid &, const Member *, int n, bool fixed);
  void project(MPM_NS::Grid &, const Member *, int n, bool fixed, const Prescribed &);
  void act_on_column(const FieldNodes &, Line &);
  static int weights_at(const MPMField &, int axis, int inward, double x, int &first,
                        double *weight);
  bool find_chain(const FieldNodes &, const int64_t *node, const double *weight, int n, int inward,
                  Chain &, double least = 0.0) const;
  void act_on_cut(const FieldNodes &, Line &, bool last);
  void act_on_crossing(const FieldNodes &, Crossing &);
  bool decide_line(MPM_NS::Grid &, Crossing &);
  void act_on_orbit(const FieldNodes &, const Orbit &);
  void act_on_single(const FieldNodes &, Single &);
};

}    // namespace LAMMPS_NS
#endif
#endif
