/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/contact,FixMPMContact);
// clang-format on
#else

#ifndef LMP_FIX_MPM_CONTACT_H
#define LMP_FIX_MPM_CONTACT_H

#include "base/mpm_first_note.h"
#include "declare/option.h"
#include "field/mpm_body_contact.h"
#include "field/mpm_friction_heat.h"
#include "field/mpm_node_action.h"
#include "field/mpm_reach.h"
#include "fix.h"
#include "math/aitken.h"
#include "math/sets.h"
#include "walls/fix_mpm_boundary.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace MPM_NS {
class Grid;
}

namespace LAMMPS_NS {
class MPMRefinedBody;
class MPMField;

/** Keywords of fix mpm/contact. */
struct MPMContactOptions {
  enum Law { FRICTIONLESS, COULOMB, STICK, ADHESIVE };
  enum Normal { MASS, VOLUME, COLINEAR, LOGISTIC };

  Law law = FRICTIONLESS;
  Normal normal_by = COLINEAR;
  double kinetic_friction = 0.0;
  double static_friction = -1.0;    ///< negative: equal to kinetic_friction
  double normal_strength = 0.0, shear_strength = 0.0, release_work = 0.0;
  bool gap = true;
  double full = 1.0;    ///< with gap: filled share of the volume of a node at which bodies touch
  MPMFrictionHeatOptions heat;

  MPM_NS::Options declare();
};

/** Contact between bodies, each a field (fix mpm), at the nodes that they share on one lattice. */
class FixMPMContact :
    public Fix,
    public MPMNodeAction,
    public MPMRubbing,
    public MPMBodyContact,
    private MPMContactOptions {
 public:
  Turn turn() const override { return BETWEEN_BODIES; }
  FixMPMContact(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  bool loses_heat() const override { return kinetic_friction > 0.0 && !heat.said; }
  bool gives_heat() const override { return heat.heats(); }
  void init() override;
  void init_action() override;
  void post_run() override { report_unsolved(); }
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override;
  double compute_array(int, int) override;
  double memory_usage() override;

  void couple_topology() override;
  void blocks_found() override;
  void extend_topology(MPMField &) override;
  bool decides_contact(const MPMField &) const override;
  void act(double dt, Stage) override;
  MPMTrialContact *trial_contact() override { return tries ? this : nullptr; }

  /** Does this fix treat contact between these two fields (IDs)? */
  bool couples(const std::string &a, const std::string &b) const;
  /** Is this field (ID) one of the bodies? */
  bool touches(const std::string &name) const override;
  /** Does this fix have the same contact law and parameters as another one? */
  bool has_law_of(const FixMPMContact &) const;

  static constexpr int MAX_FIELDS = 8;

 private:
  static constexpr int MAX_PAIRS = MAX_FIELDS * (MAX_FIELDS - 1) / 2;
  /** Row of the output for fields a < b of n: (0,1), (0,2), ..., (1,2), ... */
  static int pair_index(int a, int b, int n);

  enum State : char { OPEN, SLIDING, STUCK };

  struct Common {            // a block of nodes that several fields have
    int slot[MAX_FIELDS];    // of the block in each field; -1: none
    uint64_t canonical, owned;
  };
  struct Pair {              // two bodies at one node
    int a, b;                // indices in bodies
    double *ra, *rb;         // node records
    double n[3];             // unit normal from a to b
    double area;             // of the interface at the node
    double fade;             // share of the adhesive strength that remains at this gap
    double water;            // part of the impulse on b along n that pore water bears
    struct Walls {           // what walls will do to a body after contact
      char held;             // bits: components to which walls give their velocity
      char mirrored;         // bits: components that move with those of the images of the node
      char outside;          // bits: mirrored components of a node outside of the mirror
      double velocity[3];    // velocity that walls will give to these components
      double mass[3];        // of the node and its images
      double start[3];       // present velocity of the node

      bool moves_with_images(const double *record) const;
      /** Component d of the velocity of this record, or the velocity that walls will give to it. */
      double velocity_of(const double *record, int d) const;
    } walls_a, walls_b;
    bool alike;    // walls act on the same components of both bodies
    char left;     // bits: components left to the walls, or to contact at the image of the node
    State state;
    double normal, tangential[3];    // impulses on b so far, along n and in the tangential plane

    double impulse(int d) const { return left >> d & 1 ? 0.0 : normal * n[d] + tangential[d]; }
  };
  struct Node {         // a node where bodies are in contact
    int first, last;    // range in pairs
    bool owned;
    double *record[MAX_FIELDS];    // null: the body has no mass here
  };
  using Velocities = std::array<std::array<double, 3>, MAX_FIELDS>;
  struct Meeting {
    Node *node;
    Velocities start;    // before contact
    int group;           // number of its group of nodes that depend on each other
  };
  struct Room {    // for nodes near fixed faces: share of their volume inside of the box
    static constexpr int REACH = 2;    // reach of the function of a node [node spacings]
    struct Side {
      int plane;                  // index of the plane of nodes at the face
      bool fixed;                 // is the face fixed? else it does not count
      bool mirror;                // does a fixed face lie in that plane?
      double share[REACH + 1];    // of the nodes from the plane inward
    } sides[3][2];                // [axis][side]

    void find(const MPMField &, const Domain &);
    double at(int *index, int dim, bool &image) const;
    /** Calls f(block) for each block with mirror images of the nodes of a block. */
    template <class F> void images(const MPM_NS::Grid &, const int *block, const F &f) const;
  };
  struct Body {
    MPMField *field;
    MPMReach reach;
    std::vector<int> images;    // blocks with periodic images
    MPMRefinedBody *refined;    // body on several lattices to which this field belongs, or null
    std::vector<MPMField *> finer;    // parts of that body on finer lattices
    std::vector<char> near;           // [slot] do bodies share nodes of this block?
    std::vector<double> gradient;     // of the volume (or mass) at the nodes
    std::vector<double> share;        // volume at the nodes / node volume
    std::vector<double> water;        // [node][3] of MPMPorePressure::surface_force(); empty: none
    std::vector<char> held;           // bits, FixMPMBoundary::mark_prescribed()
    MPMPredictedVelocities foreseen;

    Pair::Walls find_walls(const double *record) const;
    void move_mirrors(const double *record, const std::array<double, 3> &before);

    void mark_near(int slot);
    const double *gradient_of(int slot, int n) const
    {
      return &gradient[3 * ((int64_t) slot * MPM_NS::NODES_PER_BLOCK + n)];
    }
  };

  // contact decided by a solver (fix_mpm_contact_trial.cpp)

  struct Link {            // a node of a tie
    int64_t a, b;          // indices of the node of each body in vectors of the solver
    double *ra, *rb;       // node records
    double share, n[3];    // share of the interface, and its normal at the node
  };
  struct Covers {       // how a body covers the cross-section of a line of nodes
    double g[3];        // sum of the gradients of its surface on the line, over the cross-section
    double alone[3];    // the same without images
    double share;       // covered share of the cross-section
  };
  struct Line {                                 // of nodes through an interface
    std::array<int, 6> key;                     // bodies, axis and direction, indices across
    std::vector<std::pair<int, int>> places;    // index along the axis and pair, of each node
    int axis, index[3];                         // axis; index of any node of the line
    double sign;                                // of the normal along the axis
    int joins;                                  // line of which this one is a part; -1: none
    Covers seen[2];                             // of both bodies
    double n[3];                                // direction of the interface normal, from a to b

    int low() const { return places.front().first; }
    int high() const { return low() + (int) places.size() - 1; }
  };
  using LinesByKey = std::map<std::array<int, 6>, std::vector<int>>;    // indices of lines
  static constexpr int AROUND = 2;    // nodes of a line beyond those that both bodies reach
  struct Tie {          // two bodies at a line of nodes through their interface, with joined lines
    int first, last;    // range in links
    int a, b;           // indices in bodies
    bool owned;         // does this rank count the tie in sums?
    Key key;            // the same on all ranks
    bool active;        // do the bodies touch?
    bool sticks;        // by friction or law stick
    int parted;         // number of releases in the step; with law stick: while it stuck
    int changes;        // number of changes between sliding and sticking in the step
    double n[3];        // mean normal from a to b
    double along[2][3];    // unit vectors along the interface, or zero
    double gap;            // gap that is to be closed [distance]
    // diagonal of C P_w M^-1 C^T; rows of C are along the normals and, where the tie sticks, along the interface
    double diagonal[3];
    double push[3], base[3];    // [row] impulse so far; impulse by the motion of walls alone
    double force[3];            // [row] force of a on b
    double stop[3];             // [row] impulse at the end of the step
    // sliding ties: slip of a on b in the step, its direction in the previous iteration, friction force on a
    double slip[3], way[3], rubs[3];
    double turns;    // weight d of the previous direction [distance], see find_way()
  };

  struct Account {        // of two bodies, this rank's share
    double impulse[3];    // on the second body in the last step
    double count;         // nodes in contact
    double work;          // of friction so far
  };

  std::vector<std::string> names;
  Room room;
  bool on_several_lattices = false;    // is a body on several lattices?

  std::vector<Body> bodies;
  std::vector<Common> common;
  bool lists_valid = false, may_touch = false;
  bool look = true;    // check for bodies that overlap, in the first step of a run
  std::vector<Node> nodes;
  std::vector<Meeting> meetings;    // where walls move one body with its images, but not another
  std::vector<Pair> pairs;

  // for nodes that are solved together

  std::vector<double> impulses;
  std::vector<char> states;
  MPM_NS::Aitken series;

  bigint steps = 0;            // number of steps of this fix in this run
  MPMFirstNote<4> unsolved;    // step and place
  double water_sums[2] = {
      0.0, 0.0};    // impulse of water at nodes in contact, and at nodes nearly in contact
  bool told_of_water = false;

  // for group_meetings()

  MPM_NS::Sets dependent;
  std::vector<int> first_with_mirror;

  // in trials

  bool tries = false;    // does a solver do the steps of this run?
  std::vector<Tie> ties;
  std::vector<Link> links;
  std::vector<char> owned_pairs;    // [pair] does this rank count the node?
  std::function<int64_t(const MPMField &)> place_of;
  double trial_dt = 0.0;
  double of_forces = 1.0;    // share of the impulse of forces that changes the momentum in a step
  bool closes = false;
  int rounds = 0;    // rounds of decisions in this step
  bool told_of_torn = false;
  double shared_at_start =
      0.0;    // largest share of the volume of a node that two bodies fill together, see check_overlap()

  double dt_last = 0.0;
  Account accounts[MAX_PAIRS] = {};
  std::unique_ptr<MPMFrictionHeat> heating;    // null: not requested
  double array[MAX_PAIRS][5] = {};
  bigint array_step = -1;

  void check_refined(Body &);
  void map_content(Body &);
  bool stale() const;
  double filled(const Common &, int n) const;
  void list_common_blocks();
  int records(const Common &, int n, double *record[MAX_FIELDS]);
  bool map_bodies();
  void foresee_walls(Body &);
  void gradient_at(const Body &, int slot, int n, double *g) const;
  void warn_overlap();
  void warn_thin();
  void warn_of_thin_body(int thin, int other);
  void warn_of_thin_pair(const std::vector<int> &thin);
  double most_filled(Body &);
  void find_contacts();
  void separate_points();
  bool make_pair(const Common &, int n, int a, int b, double volume_share, Pair &);
  bool is_wet(const Pair &pair) const
  {
    return !bodies[pair.a].water.empty() || !bodies[pair.b].water.empty();
  }
  double water_between(const Pair &) const;
  void report_missed_water();
  bool begin(Node &, Velocities &start);
  int count_bodies(const Node &) const;
  void set_velocities(const Meeting &);
  double iterate(const Meeting &, double dt, bool decided);
  void solve(const Meeting *first, const Meeting *last, bool mirrored, double dt, bool decided);
  void note_unsolved(const Meeting *first, const Meeting *last);
  void report_unsolved();
  void group_meetings();
  void resolve_all(double dt, bool decided);
  void apply(Pair &, int nothers, double &largest, double dt, bool decided);
  void account(const Node &, const Velocities &start);
  double heat_of(const Pair &, bool owned);

  void refuse_trials() const;
  int rows_of_tie() const;
  bool make_trial_pair(const Common &, int n, int a, int b, Pair &);
  bool is_beyond_walls(Pair &);
  double share_of(const Body &, const int *index) const;
  bool is_known(const Body &, const int *index) const;
  int64_t node_at(const Body &, const int *index) const;
  void interface_at(int a, int b, const int *index, double *area) const;
  int axis_at(const Pair &, int *index, double &sign) const;
  void find_lines(std::vector<Line> &);
  Covers look_along(const Body &, const Line &, double sign) const;
  double turn_to_wider(Line &) const;
  void for_lines_around(const std::vector<Line> &, const LinesByKey &, const Line &,
                        const std::function<void(int k)> &use) const;
  double follows_others(const Line &, double turned, const double *around) const;
  void turn(Pair &, const Line &, double turned, double follows, const double *around) const;
  void join_lines(std::vector<Line> &, const LinesByKey &) const;
  void find_edges(std::vector<Line> &);
  bool measure_gap(const Tie &, const Line &, double &gap) const;
  void add_tie(const std::vector<Line> &, const std::vector<int> &parts);
  void find_tangents(Tie &, int held) const;
  static bool can_slide(const Tie &tie)
  {
    return tie.along[0][0] != 0.0 || tie.along[0][1] != 0.0 || tie.along[0][2] != 0.0;
  }
  /** Does this row constrain the motion? */
  bool acts(const Tie &tie, int row) const
  {
    return tie.active && tie.diagonal[row] > 0.0 && (row == 0 || tie.sticks);
  }
  bool slides(const Tie &tie) const
  {
    return has_friction() && tie.active && !tie.sticks && can_slide(tie);
  }
  const double *direction(const Tie &tie, const Link &link, int row) const
  {
    return row == 0 ? link.n : tie.along[row - 1];
  }
  bool is_torn(const Tie &) const;
  double friction_of(const Tie &) const;
  void find_ties();
  void warn_of_torn();
  void check_overlap();
  void find_slip(const Tie &, const double *u, double *slip) const;
  double find_way(const Tie &, double *way) const;
  void change_of_way(const Tie &, const double *slip, double *way, double *change) const;
  double wrong_friction(const Tie &, double largest) const;
  void change_friction(Tie &) const;
  void begin_touch(Tie &, const double *u, double approach) const;
  void rub(const Tie &, const double *on_a, double *force) const;
  void add_force(const Tie &, const Link &, const double *rows, double *force) const;
  void act_after_trials();

  // MPMBodyContact
  void place_bodies(const std::function<int64_t(const MPMField &)> &first) override
  {
    place_of = first;
  }
  std::size_t nrows() const override { return ties.size() * rows_of_tie(); }
  int rows_of_group() const override { return rows_of_tie(); }
  Key key_of(std::size_t group) const override { return ties[group].key; }
  bool owns(std::size_t group) const override { return ties[group].owned; }
  bool holds(std::size_t row) const override
  {
    return acts(ties[row / rows_of_tie()], (int) (row % rows_of_tie()));
  }
  void visit_row(std::size_t row,
                 const std::function<void(int64_t k, double c)> &use) const override;
  bool touches() const override;
  void find_approach(const double *v, bool with_gaps, double *rows) const override;
  void add_squares(const double *rows, const double *v, double *sums) const override;
  void add_friction_turn(const double *du, double *dforce) override;
  void push(double factor, const double *rows) override;

  // MPMTrialContact
  void begin_trials(MPMField &, double dt, double slip_time, double eps, bool rests) override;
  bool find_carried(MPMField &, std::vector<double> &) override { return false; }
  void bear_carried(MPMField &, double *) override {}
  bool close_gaps(bool yes) override;
  void check_arrival() override {}
  bool has_friction() const override { return law == COULOMB && kinetic_friction > 0.0; }
  bool is_regularised() const override { return false; }
  bool rubs() const override;
  void forget_pushes() override;
  void take_base() override;
  void take_forces(double scale) override;
  void add_friction(const double *u, double *force) override;
  void add_friction_change(const double *du, double scale, double *dforce) override;
  void add_friction_blocks(double *blocks) override;
  void add_friction_stiffness(double *) override {}    // levels are of one field
  void correct(const double *du) override;
  bool decide(const double *u, double unbalanced) override;
  void soften(double) override {}
  void take_stop() override;
  void foresee_velocities(const double *, double share) override { of_forces = share; }
};

}    // namespace LAMMPS_NS
#endif
#endif
