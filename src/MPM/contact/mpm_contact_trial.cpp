/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* In explicit steps each node that bodies share is in contact by itself: its velocities are those
   of both bodies, also one and two layers of nodes inside. In the balance of forces, this would
   make a soft body next to a hard one about half a cell thinner. Here, nodes are tied together
   along lines through the interface, by a single condition

     sum_k a_k n_k . (u_a,k - u_b,k) = g,   sum_k a_k = 1

   with the areas a_k of the interface at these nodes, normals n_k, and the gap g of the line
   (MPMContactLines). For a plane interface, a_k = N_k at its position, so that the condition holds
   for the motion there, and a pressure on it is in balance with uniform stress, node by node.

   Bodies that touch are held along the normal without any penalty, as long as this does not need a
   pull. With law stick, and law coulomb while they stick, they are also held along the mean plane
   of the interface of the line, with law coulomb as long as friction can hold them. */

#include "contact/mpm_contact_trial.h"

#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "fix.h"
#include "math_extra.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// gap, in node spacings, at which bodies touch as they are if others do, and at which statics
// tries whether they touch; a smaller gap than TOUCHED is none
static constexpr double NEXT_TO = 0.08, NEARBY = 0.4, TOUCHED = 1.0e-6;
// slip, in node spacings, that turns friction into its direction, its factor in each iteration, and
// the least cosine of the turn of friction in one iteration
static constexpr double TURNS = 1.0e-2, SOONER = 0.3, MOST_TURN = 0.5;
// least pull to let go, relative to the largest push; least overlap, in node spacings; the same in
// later rounds; factor between the relative imbalance of all forces and errors of single ones
static constexpr double WRONG = 1.0e-9, STILL_RIGHT = 1.0e-4, ERRORS = 10.0;
// factor on the overlap at the start of a run, for later
static constexpr double LATER = 1.1;
// least cosine between a normal and an axis
static constexpr double ALONG_AXIS = 0.99;
// motion of a held row, relative to that without walls
static constexpr double HELD = 1.0e-12;
// changes between sliding and sticking of a tie in a step before it may take more friction;
// relative to the largest force, the increase for each later change, and the limit
static constexpr int FREE_CHANGES = 2;
static constexpr double MORE_EACH = 1.0e-2, MOST_MORE = 0.05;
// times that a tie parts in a step before it slips
static constexpr int MOST_RELEASES = 3, MOST_RELEASES_SLIDING = 6;
// rounds in which everything wrong is changed, and the worst half; in later ones, only the worst
static constexpr int AT_ONCE = 6, HALF = 18;

MPMContactTrial::MPMContactTrial(LAMMPS *lmp, const Fix &fix,
                                 const MPMContactSearchOptions &options, const MPMContactLaw &law,
                                 MPMContactBodies &bodies, MPMContactSearch &search,
                                 MPMContacts &contacts) :
    Pointers(lmp),
    fix(fix), options(options), law(law), bodies(bodies), search(search), contacts(contacts),
    lines(bodies, search)
{
}

void MPMContactTrial::begin_run()
{
  is_first_step = true;
  warned_of_released = false;
}

/** Number of rows of a tie: along the normals and, with friction, also along the interface. */
int MPMContactTrial::rows_of_tie() const
{
  return law.law == MPMContactLaw::STICK || has_friction() ? bodies.dim() : 1;
}

/** Finds directions along the interface in which bodies can move against each other; none along
 *  components that walls hold in both bodies (held). */
void MPMContactTrial::find_tangents(Tie &tie, int held) const
{
  const int dim = bodies.dim();
  MathExtra::zero3(tie.along[0]);
  MathExtra::zero3(tie.along[1]);
  int axis = -1, nheld = 0, least = 0;
  for (int d = 0; d < dim; d++) {
    if (std::fabs(tie.n[d]) < std::fabs(tie.n[least])) least = d;
    if (!(held >> d & 1) || std::fabs(tie.n[d]) > ALONG_AXIS) continue;
    axis = d;
    nheld++;
  }
  if (dim == 2) {
    if (nheld) return;
    tie.along[0][0] = -tie.n[1];
    tie.along[0][1] = tie.n[0];
    return;
  }
  if (nheld > 1) return;
  double e[3] = {0.0, 0.0, 0.0};
  e[nheld ? axis : least] = 1.0;
  MathExtra::cross3(tie.n, e, tie.along[0]);
  MathExtra::norm3(tie.along[0]);
  if (!nheld) MathExtra::cross3(tie.n, tie.along[0], tie.along[1]);
}

/** Adds a link for each of these pairs, and finds the diagonal of the rows. */
void MPMContactTrial::add_links(Tie &tie, const std::vector<int> &pairs, double area)
{
  const int dim = bodies.dim();
  const MPMContactBody &a = bodies[tie.a], &b = bodies[tie.b];
  tie.first = (int) links.size();
  for (const int place : pairs) {
    const MPMNodeContact &pair = contacts.pairs[place];
    Link link = {place_of(*a.field) + a.node_of(pair.ra),
                 place_of(*b.field) + b.node_of(pair.rb),
                 pair.ra,
                 pair.rb,
                 pair.area / area,
                 {pair.n[0], pair.n[1], pair.n[2]}};
    double mobility[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++)
      for (int body = 0; body < 2; body++) {
        const auto &walls = body ? pair.walls_b : pair.walls_a;
        if (walls.held >> d & 1) continue;
        mobility[d] +=
            1.0 / (walls.mirrored >> d & 1 ? walls.mass[d] : (body ? pair.rb : pair.ra)[3]);
      }
    for (int r = 0; r < rows_of_tie(); r++) {
      const double *const e = row_direction(tie, link, r);
      for (int d = 0; d < dim; d++)
        tie.diagonal[r] += link.weight * link.weight * mobility[d] * e[d] * e[d];
    }
    links.push_back(link);
  }
  tie.last = (int) links.size();
  double free = 0.0;
  for (int k = tie.first; k < tie.last; k++)
    free += links[k].weight * links[k].weight * (1.0 / links[k].ra[3] + 1.0 / links[k].rb[3]);
  for (double &diagonal : tie.diagonal)
    if (diagonal < HELD * free) diagonal = 0.0;
}

/** Does this rank know the nodes next to the ends of these lines? It may have a part of a line that
 *  no point of it reaches. */
bool MPMContactTrial::knows_ends(const Tie &tie, const std::vector<int> &parts) const
{
  for (const int part : parts) {
    const MPMContactLines::Line &line = lines.list[part];
    int at[3] = {line.index[0], line.index[1], line.index[2]};
    for (const int end : {line.low() - 1, line.high() + 1}) {
      at[line.axis] = end;
      if (!bodies[tie.a].knows(at) || !bodies[tie.b].knows(at)) return false;
    }
  }
  return true;
}

/** Ties the bodies together along a line, parts[0], and the lines that join it. */
void MPMContactTrial::add_tie(const std::vector<int> &parts)
{
  Tie tie = {};
  const MPMContactLines::Line &line = lines.list[parts[0]];
  std::copy(line.key.begin(), line.key.end(), tie.key.begin());
  tie.key[6] = line.low();
  tie.a = line.key[0];
  tie.b = line.key[1];
  tie.owned = owned_pairs[line.places[0].second];
  double area = 0.0;
  int held = (1 << bodies.dim()) - 1;    // components that walls hold, or mirror, in both bodies
  std::vector<int> pairs;
  for (const int part : parts)
    for (const auto &place : lines.list[part].places) pairs.push_back(place.second);
  for (const int place : pairs) {
    const MPMNodeContact &pair = contacts.pairs[place];
    area += pair.area;
    for (int d = 0; d < 3; d++) tie.n[d] += pair.area * pair.n[d];
    const auto &wa = pair.walls_a, &wb = pair.walls_b;
    held &= (wa.held | wa.outside) & (wb.held | wb.outside);
  }
  const double length = MathExtra::len3(tie.n);
  if (length == 0.0) return;
  MathExtra::scale3(1.0 / length, tie.n);
  if (!knows_ends(tie, parts)) return;
  if (options.gap && !lines.measure_gap(line, tie.n, options.full, tie.gap)) return;
  if (options.gap) tie.gap = std::max(tie.gap, 0.0);
  find_tangents(tie, held);
  add_links(tie, pairs, area);
  ties.push_back(tie);
}

/** Finds lines of nodes with their two bodies, and their gaps. */
void MPMContactTrial::find_ties()
{
  owned_pairs.assign(contacts.pairs.size(), 0);
  for (const auto &node : contacts.nodes)
    for (int p = node.first; p < node.last; p++) owned_pairs[p] = node.owned;
  lines.find(contacts);
  const auto &list = lines.list;
  std::vector<std::vector<int>> parts(list.size());
  for (int l = 0; l < (int) list.size(); l++) {
    const int place = list[l].joins < 0 ? l : list[l].joins;
    parts[place].insert(list[l].joins < 0 ? parts[place].begin() : parts[place].end(), l);
  }
  for (const auto &lines_of_tie : parts)
    if (!lines_of_tie.empty()) add_tie(lines_of_tie);
  check_overlap();
}

/** Ends with an error if bodies share more of the volume of a node than at the start of the run,
 *  beyond the limit of the warning there. Collective. */
void MPMContactTrial::check_overlap()
{
  double mine = 0.0, most;
  for (std::size_t p = 0; p < contacts.pairs.size(); p++) {
    if (!owned_pairs[p]) continue;
    const MPMNodeContact &pair = contacts.pairs[p];
    const MPMContactBody &body = bodies[pair.a];
    int index[3];
    body.field->grid.node_index(body.node_of(pair.ra), index);
    const double Va = bodies.fraction(bodies[pair.a], index),
                 Vb = bodies.fraction(bodies[pair.b], index);
    if (std::min(Va, Vb) >= MPMContactChecks::OVERLAP_EACH) mine = std::max(mine, Va + Vb);
  }
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, world);
  if (is_first_step) filled_at_start = most;
  if (most < std::max(MPMContactChecks::OVERLAP, LATER * filled_at_start)) return;
  error->all(FLERR, Error::NOLASTLINE,
             "Fix mpm/contact {}: bodies have come into each other in the implicit steps of this "
             "run, so that they fill {:.3g} of the volume of a node: contact sees bodies that are "
             "up to about a node spacing away from each other when a step begins: use smaller "
             "steps",
             fix.id, most);
}

void MPMContactTrial::begin_trials(MPMField &, double dt, double, double, bool rests)
{
  trial_dt = dt;
  closes = false;
  rounds = 0;
  contacts.clear();
  ties.clear();
  links.clear();
  if (search.begin_step()) {
    search.find_interfaces(contacts);
    find_ties();
  }
  is_first_step = false;

  const double h = bodies.spacing();
  int mine = 0, any;
  for (const auto &tie : ties)
    if (tie.owned && tie.gap <= TOUCHED * h) mine = 1;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  for (auto &tie : ties) {
    if (any && tie.gap <= NEXT_TO * h) tie.gap = 0.0;
    tie.active = any ? tie.gap == 0.0 : rests && tie.gap < NEARBY * h;
    tie.sticks = law.law == MPMContactLaw::STICK || has_friction();
  }
}

bool MPMContactTrial::touches() const
{
  return std::any_of(ties.begin(), ties.end(), [](const Tie &tie) {
    return tie.active && tie.owned;
  });
}

bool MPMContactTrial::close_gaps(bool yes)
{
  closes = yes;
  return yes && std::any_of(ties.begin(), ties.end(), [](const Tie &tie) {
           return tie.active && tie.gap > 0.0;
         });
}

void MPMContactTrial::find_approach(const double *v, bool with_gaps, double *rows) const
{
  const int dim = bodies.dim(), nrow = rows_of_tie();
  for (const auto &tie : ties) {
    double u[3] = {0.0, 0.0, 0.0};
    for (int k = tie.first; k < tie.last; k++) {
      const Link &link = links[k];
      for (int r = 0; r < nrow; r++) {
        const double *const e = row_direction(tie, link, r);
        for (int d = 0; d < dim; d++)
          u[r] += link.weight * e[d] * (v[dim * link.a + d] - v[dim * link.b + d]);
      }
    }
    const double closing = with_gaps && closes ? tie.gap / trial_dt : 0.0;
    for (int r = 0; r < nrow; r++, rows++)
      *rows = acts(tie, r) ? u[r] - (r == 0 ? closing : 0.0) : 0.0;
  }
}

void MPMContactTrial::add_squares(const double *rows, const double *v, double *sums) const
{
  const int dim = bodies.dim(), nrow = rows_of_tie();
  sums[0] = sums[1] = 0.0;
  for (const auto &tie : ties) {
    double speed = 0.0;
    for (int k = tie.first; k < tie.last && v && tie.owned && tie.active; k++)
      for (int d = 0; d < dim; d++)
        speed += links[k].weight *
            (std::fabs(v[dim * links[k].a + d]) + std::fabs(v[dim * links[k].b + d]));
    if (closes) speed += tie.gap / trial_dt;
    for (int r = 0; r < nrow; r++, rows++) {
      if (!tie.owned || !acts(tie, r)) continue;
      sums[0] += *rows * *rows / tie.diagonal[r];
      sums[1] += speed * speed / tie.diagonal[r];
    }
  }
}

/** Adds to force[dim] the forces of these rows of a tie on the bodies at a link; a has the sign of
 *  the row. */
void MPMContactTrial::add_row_forces(const Tie &tie, const Link &link, const double *rows,
                                     double *force) const
{
  const int dim = bodies.dim();
  for (int r = 0; r < rows_of_tie(); r++) {
    const double *const e = row_direction(tie, link, r);
    for (int d = 0; d < dim; d++) force[d] += link.weight * rows[r] * e[d];
  }
}

void MPMContactTrial::visit_row(std::size_t row,
                                const std::function<void(int64_t k, double c)> &use) const
{
  const int dim = bodies.dim(), nrow = rows_of_tie();
  const Tie &tie = ties[row / nrow];
  for (int k = tie.first; k < tie.last; k++) {
    const Link &link = links[k];
    const double *const e = row_direction(tie, link, (int) (row % nrow));
    for (int d = 0; d < dim; d++) {
      use(dim * link.a + d, link.weight * e[d]);
      use(dim * link.b + d, -link.weight * e[d]);
    }
  }
}

void MPMContactTrial::clear_impulses()
{
  for (auto &tie : ties) MathExtra::zero3(tie.push);
}

void MPMContactTrial::push(double factor, const double *rows)
{
  const int nrow = rows_of_tie();
  for (auto &tie : ties)
    for (int r = 0; r < nrow; r++, rows++)
      if (tie.active) tie.push[r] += factor * *rows;
}

void MPMContactTrial::take_base()
{
  for (auto &tie : ties) MathExtra::copy3(tie.push, tie.base);
}

void MPMContactTrial::take_forces(double scale)
{
  for (auto &tie : ties)
    for (int r = 0; r < 3; r++) tie.force[r] = (tie.push[r] - tie.base[r]) / scale;
}

void MPMContactTrial::take_stop()
{
  for (auto &tie : ties) MathExtra::copy3(tie.push, tie.stop);
}

/** Coulomb's law, without any regularization. A tie that sticks has rows along the interface, whose
 *  forces show when friction cannot hold them. A tie that slides has friction mu N against the
 *  direction w of its slip, on the nodes of both bodies in their shares of the interface, and
 *  sticks again if it would slide back. This is Newton's method for the projection of P. Alart, A.
 *  Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353, with an exact condition for ties that
 *  stick. With the slip s in the step,
 *
 *     w = (s + d w0)/|s + d w0|
 *
 *  where w0 is the direction of the previous iteration, or of the force with which the tie stuck:
 *  friction does not jump when a tie begins to slide, and w is that of s in the end. As d becomes a
 *  small part of s, iterations converge to that direction fast, also in short steps: with a
 *  constant d, each one would leave d/(d + |s|) of the error. In 2d, w is w0, and friction changes
 *  with N alone. N may be negative until it is decided which ties part: as long as the sets stay,
 *  forces have no kinks. */
bool MPMContactTrial::rubs() const
{
  return has_friction() && std::any_of(ties.begin(), ties.end(), [this](const Tie &tie) {
           return tie.owned && slides(tie);
         });
}

/** Motion of a on b along the interface. */
void MPMContactTrial::find_slip(const Tie &tie, const double *u, double *slip) const
{
  const int dim = bodies.dim();
  MathExtra::zero3(slip);
  for (int k = tie.first; k < tie.last; k++)
    for (int d = 0; d < dim; d++)
      slip[d] += links[k].weight * (u[dim * links[k].a + d] - u[dim * links[k].b + d]);
  const double along = MathExtra::dot3(slip, tie.n);
  for (int d = 0; d < 3; d++) slip[d] -= along * tie.n[d];
}

/** Finds w of tie.slip, a unit vector. Returns |s + d w0|, or 0 where w is not the direction of
 *  that. A tie that slides back keeps its direction until it sticks. */
double MPMContactTrial::find_direction(const Tie &tie, double *direction) const
{
  if (bodies.dim() == 2) {
    MathExtra::copy3(tie.direction, direction);
    return 0.0;
  }
  for (int d = 0; d < 3; d++) direction[d] = tie.slip[d] + tie.inertia * tie.direction[d];
  const double length = MathExtra::len3(direction),
               ahead = MathExtra::dot3(direction, tie.direction);
  if (ahead > MOST_TURN * length) {
    MathExtra::scale3(1.0 / length, direction);
    return length;
  }
  if (ahead > 0.0) {
    // the largest turn in one iteration
    const double across = std::sqrt(length * length - ahead * ahead),
                 sine = std::sqrt(1.0 - MOST_TURN * MOST_TURN);
    for (int d = 0; d < 3; d++)
      direction[d] =
          MOST_TURN * tie.direction[d] + sine * (direction[d] - ahead * tie.direction[d]) / across;
  } else {
    MathExtra::copy3(tie.direction, direction);
  }
  return 0.0;
}

/** Adds a force on a, and the reaction on b. */
void MPMContactTrial::add_pair_force(const Tie &tie, const double *on_a, double *force) const
{
  const int dim = bodies.dim();
  for (int k = tie.first; k < tie.last; k++)
    for (int d = 0; d < dim; d++) {
      force[dim * links[k].a + d] += links[k].weight * on_a[d];
      force[dim * links[k].b + d] -= links[k].weight * on_a[d];
    }
}

/** Has this tie been let go so often in the step that it now goes on without anything that holds it
 *  along the interface? */
bool MPMContactTrial::is_released(const Tie &tie) const
{
  return tie.releases >= (law.law == MPMContactLaw::STICK ? MOST_RELEASES : MOST_RELEASES_SLIDING);
}

/** Coefficient of friction. */
double MPMContactTrial::friction_of(const Tie &tie) const
{
  return is_released(tie) ? 0.0 : law.friction.kinetic;
}

void MPMContactTrial::add_friction(const double *u, double *force)
{
  for (auto &tie : ties) {
    MathExtra::zero3(tie.friction);
    if (!slides(tie)) continue;
    find_slip(tie, u, tie.slip);
    double direction[3];
    find_direction(tie, direction);
    for (int d = 0; d < 3; d++) tie.friction[d] = -friction_of(tie) * tie.force[0] * direction[d];
    add_pair_force(tie, tie.friction, force);
  }
}

/** Change of w for a change of the slip. */
void MPMContactTrial::direction_change(const Tie &tie, const double *slip, double *direction,
                                       double *change) const
{
  const double length = find_direction(tie, direction), along = MathExtra::dot3(direction, slip);
  for (int d = 0; d < 3; d++)
    change[d] = length > 0.0 ? (slip[d] - along * direction[d]) / length : 0.0;
}

void MPMContactTrial::add_friction_change(const double *du, double scale, double *dforce)
{
  for (auto &tie : ties) {
    if (!slides(tie)) continue;
    double slip[3], direction[3], turn[3], change[3];
    find_slip(tie, du, slip);
    direction_change(tie, slip, direction, turn);
    const double more = (tie.push[0] - tie.base[0]) / scale;
    for (int d = 0; d < 3; d++)
      change[d] = -friction_of(tie) * (more * direction[d] + std::max(tie.force[0], 0.0) * turn[d]);
    add_pair_force(tie, change, dforce);
  }
}

void MPMContactTrial::add_friction_turn(const double *du, double *dforce)
{
  for (auto &tie : ties) {
    if (!slides(tie) || !(tie.force[0] > 0.0)) continue;
    double slip[3], direction[3], turn[3];
    find_slip(tie, du, slip);
    direction_change(tie, slip, direction, turn);
    for (double &t : turn) t *= -friction_of(tie) * tie.force[0];
    add_pair_force(tie, turn, dforce);
  }
}

void MPMContactTrial::correct(const double *)
{
  for (auto &tie : ties) {
    if (!slides(tie)) continue;
    double direction[3];
    const double length = find_direction(tie, direction);
    MathExtra::copy3(direction, tie.direction);
    const double slip = MathExtra::len3(tie.slip);
    if (slip > 0.0 && length > 0.0) tie.inertia = SOONER * std::min(tie.inertia, slip);
  }
}

void MPMContactTrial::add_friction_blocks(double *blocks)
{
  const int dim = bodies.dim();
  for (const auto &tie : ties) {
    if (!slides(tie) || !(tie.force[0] > 0.0)) continue;
    const double slope = friction_of(tie) * tie.force[0];
    for (int e = 0; e < dim; e++) {
      double along[3], direction[3], turn[3];
      for (int d = 0; d < 3; d++) along[d] = (d == e) - tie.n[d] * tie.n[e];
      direction_change(tie, along, direction, turn);
      for (int k = tie.first; k < tie.last; k++)
        for (int d = 0; d < dim; d++) {
          const double stiffness = links[k].weight * links[k].weight * slope * turn[d];
          blocks[dim * dim * links[k].a + dim * d + e] += stiffness;
          blocks[dim * dim * links[k].b + dim * d + e] += stiffness;
        }
    }
  }
}

/** How wrong is the state of a tie in contact with friction, relative to the largest force?
 *  Positive: it changes. */
double MPMContactTrial::friction_error(const Tie &tie, double largest) const
{
  if (!has_friction() || !tie.can_slide() || is_released(tie) || !(largest > 0.0)) return 0.0;
  if (tie.sticks) {
    const double more = std::max(tie.changes - FREE_CHANGES, 0) * MORE_EACH;
    const double excess = law.friction.excess(std::hypot(tie.force[1], tie.force[2]), tie.force[0]);
    return excess / largest - std::min(more, MOST_MORE);
  }
  return -MathExtra::dot3(tie.slip, tie.direction) / bodies.spacing();
}

/** Changes a tie from sticking to sliding, against the force with which it stuck, or back. */
void MPMContactTrial::switch_friction(Tie &tie) const
{
  MathExtra::zero3(tie.slip);
  MathExtra::zero3(tie.friction);
  if (tie.sticks) {
    for (int d = 0; d < 3; d++)
      tie.direction[d] = tie.force[1] * tie.along[0][d] + tie.force[2] * tie.along[1][d];
    MathExtra::norm3(tie.direction);
    tie.inertia = TURNS * bodies.spacing();
  }
  tie.sticks = !tie.sticks;
  tie.changes++;
}

/** Lets a tie touch from now on, after an overlap of this size. A tie with an inclined normal may
 *  be pulled by its own shear while it sticks or rubs, and overlap when it is let go, so that
 *  neither is a solution: after some changes it slips instead. With friction, a tie that has slid
 *  by more than friction could hold at the same stiffness keeps sliding: if it stuck first, its
 *  shear forces could pull it off again along an inclined normal, and so on without end. */
void MPMContactTrial::activate(Tie &tie, const double *u, double approach) const
{
  tie.active = true;
  tie.sticks = (has_friction() || law.law == MPMContactLaw::STICK) && !is_released(tie);
  MathExtra::zero3(tie.friction);
  if (!has_friction() || !tie.can_slide() || is_released(tie)) return;
  find_slip(tie, u, tie.slip);
  const double length = MathExtra::len3(tie.slip);
  if (length < law.friction.kinetic * approach || length == 0.0) return;
  tie.sticks = false;
  tie.inertia = TURNS * bodies.spacing();
  for (int d = 0; d < 3; d++) tie.direction[d] = tie.slip[d] / length;
}

/** Finds how wrong the state of each tie is after the motion u, relative to the largest force or
 *  the node spacing, and whether by its friction. Returns the largest error. Collective. */
double MPMContactTrial::find_errors(const double *u, std::vector<double> &wrong,
                                    std::vector<char> &by_friction) const
{
  const int dim = bodies.dim();
  wrong.assign(ties.size(), 0.0);
  by_friction.assign(ties.size(), 0);
  double mine = 0.0, largest, worst;
  for (const auto &tie : ties)
    if (tie.active && tie.owned) mine = std::max(mine, std::fabs(tie.force[0]));
  MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  mine = 0.0;
  for (std::size_t k = 0; k < ties.size(); k++) {
    const Tie &tie = ties[k];
    if (tie.active) {
      wrong[k] = largest > 0.0 ? -tie.force[0] / largest : 0.0;
      const double friction = friction_error(tie, largest);
      by_friction[k] = friction > wrong[k] && wrong[k] <= WRONG;
      if (by_friction[k]) wrong[k] = friction;
    } else {
      double approach = -tie.gap;
      for (int j = tie.first; j < tie.last; j++)
        for (int d = 0; d < dim; d++)
          approach +=
              links[j].weight * links[j].n[d] * (u[dim * links[j].a + d] - u[dim * links[j].b + d]);
      wrong[k] = approach / bodies.spacing();
    }
    if (tie.owned) mine = std::max(mine, wrong[k]);
  }
  MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE, MPI_MAX, world);
  return worst;
}

/** At first, everything that is wrong is changed. If this oscillates, only the worst is, and what
 *  is almost right stays. While forces are not in balance yet, errors that are not larger than the
 *  imbalance stay, too. */
bool MPMContactTrial::decide(const double *u, double unbalanced)
{
  std::vector<double> wrong;
  std::vector<char> by_friction;
  const double worst = find_errors(u, wrong, by_friction);
  const bool all = rounds < AT_ONCE;
  const double right = std::max(all ? WRONG : STILL_RIGHT, ERRORS * unbalanced);
  if (worst <= right) return false;
  const double least = all ? right : std::max(right, (rounds < HALF ? 0.5 : 0.999) * worst);
  rounds++;
  bool changed = false;
  for (std::size_t k = 0; k < ties.size(); k++) {
    if (wrong[k] <= least) continue;
    changed = true;
    if (by_friction[k]) {
      switch_friction(ties[k]);
    } else if (ties[k].active) {
      ties[k].active = false;
      ties[k].releases += has_friction() || ties[k].sticks;
      MathExtra::zero3(ties[k].friction);
    } else {
      activate(ties[k], u, wrong[k] * bodies.spacing());
    }
  }
  return changed;
}

/** Warns of lines that slip because they were let go too often, once in a run. Collective. */
void MPMContactTrial::warn_of_released()
{
  if ((law.law != MPMContactLaw::STICK && !has_friction()) || warned_of_released) return;
  bigint mine[2] = {0, 0}, all[2];
  for (const auto &tie : ties) {
    if (!tie.owned || !tie.active) continue;
    mine[0]++;
    mine[1] += is_released(tie);
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all[1] == 0) return;
  warned_of_released = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/contact {}: {} of {} lines of nodes between bodies slip without friction in step "
        "{}: they would be pulled while they stick or rub, and go into the other body when they "
        "are let go, as lines with inclined normals at edges may; this is said only once in a run",
        fix.id, all[1], all[0], update->ntimestep);
}

void MPMContactTrial::act(MPMContactReport &report)
{
  warn_of_released();
  const int dim = bodies.dim(), nbodies = bodies.size();
  std::vector<MPMContactBodies::Velocities> before(contacts.nodes.size());
  for (std::size_t n = 0; n < contacts.nodes.size(); n++)
    for (int k = 0; k < nbodies; k++)
      if (const double *const record = contacts.nodes[n].record[k])
        std::copy_n(record, 3, before[n][k].begin());
  for (const auto &tie : ties) {
    auto &entry = report.of(tie.a, tie.b);
    for (int k = tie.first; k < tie.last && tie.active; k++) {
      const Link &link = links[k];
      double impulse[3] = {0.0, 0.0, 0.0}, stop[3] = {0.0, 0.0, 0.0};
      add_row_forces(tie, link, tie.force, impulse);
      add_row_forces(tie, link, tie.stop, stop);
      for (int d = 0; d < dim; d++) {
        impulse[d] =
            trial_dt * force_share * (impulse[d] - link.weight * tie.friction[d]) + stop[d];
        link.ra[d] -= impulse[d] / link.ra[3];
        link.rb[d] += impulse[d] / link.rb[3];
        if (tie.owned) entry.impulse[d] += impulse[d];
      }
      if (tie.owned) entry.count += 1.0;
    }
    if (tie.owned && tie.active)
      entry.work += force_share * MathExtra::dot3(tie.friction, tie.slip);
  }
  for (std::size_t n = 0; n < contacts.nodes.size(); n++)
    bodies.book(contacts.nodes[n].record, before[n]);
}
