/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Contact between bodies in the steps of a solver (mpm_body_contact.h). In explicit steps each node that bodies share is in contact by
// itself: its velocities are those of both bodies, also one and two layers of nodes inside, so that the strain of a soft body next to
// a hard one is that of the hard one. In the balance of forces, this would make a soft body about half a cell thinner. Here, nodes are
// tied together along lines through the interface, by a single condition
//
//    sum_k a_k n_k . (u_a,k - u_b,k) = g,   sum_k a_k = 1
//
// with the areas a_k of the interface at these nodes, and normals n_k: a_k n_k is the integral of the gradients of their functions over
// the bodies. For a plane interface, a_k = N_k at its position, so that the condition holds for the motion there, and a pressure on it
// is in balance with uniform stress, node by node, for any position between nodes and any direction of the plane.
//
// The gap g is the volume that both bodies lack along the line, over the area of the interface. Where a body covers only the
// share c of the cross-section of the line, next to its edge, its volumes are divided by c (fix_mpm_contact_edges.cpp):
//
//    g = h |n_axis| sum_k (1 - V_a,k/c_a - V_b,k/c_b)
//
// Bodies that touch are held along the normal without any penalty, as long as this does not need a pull. With law stick, and law
// coulomb while they stick, they are also held along the mean plane of the interface of the line, with law coulomb as long as
// friction can bear it.

#include "contact/fix_mpm_contact.h"

#include "base/mpm_options.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "math_extra.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double COVERED = 1.0e-3;    // least share of the cross-section of a line
static constexpr double SAME = 1.0e-6;       // relative difference of shares that count as equal
// gap, in node spacings, at which bodies touch as they are if others do, and at which statics tries whether they touch
static constexpr double NEXT_TO = 0.08, NEARBY = 0.4;
static constexpr double TOUCHED = 1.0e-6;    // node spacings; a smaller gap is none
static constexpr double TURNS =
    1.0e-2;    // slip, in node spacings, that turns friction into its direction
static constexpr double MOST_TURN = 0.5;    // least cosine of the turn of friction in one iteration
static constexpr double SOONER = 0.3;       // factor on that length in each iteration
static constexpr double WRONG =
    1.0e-9;    // least pull to let go, relative to the largest push; least overlap, in node spacings
static constexpr double OVERLAP = 1.4, OVERLAP_EACH = 0.25;    // see fix_mpm_contact.cpp
static constexpr double ROOM = 1.1;    // factor on the overlap at the start of a run, for later
static constexpr double STILL_RIGHT = 1.0e-4;    // the same in later rounds
static constexpr double ERRORS =
    10.0;    // factor between the relative imbalance of all forces and errors of single ones
static constexpr double ALONG_AXIS = 0.99;    // least cosine between a normal and an axis
static constexpr double HELD = 1.0e-12;    // motion of a held row, relative to that without walls
// changes between sliding and sticking of a tie in a step before it may bear more friction; relative to the largest force, the increase
// for each later change, and the limit
static constexpr int FREE_CHANGES = 2;
static constexpr double MORE_EACH = 1.0e-2, MOST_MORE = 0.05;
static constexpr int MOST_PARTED = 3,
                     MOST_PARTED_RUBBING = 6;    // times that a tie parts in a step before it slips
// rounds in which everything wrong is changed, and the worst half; in later ones, only the worst
static constexpr int AT_ONCE = 6, HALF = 18;

/* ---------------------------------------------------------------------- */

void FixMPMContact::refuse_trials() const
{
  const char *what = nullptr, *instead = nullptr;
  if (law == ADHESIVE) {
    what = "law adhesive";
    instead = "use law stick";
  } else if (static_friction > kinetic_friction) {
    what = "a coefficient of static friction";
    instead = "use one coefficient";
  } else if (normal_by != COLINEAR) {
    what = "normal mass, volume, and logistic, as they take the one of the interface itself";
    instead = "remove normal";
  } else if (heating) {
    what = "heat";
    instead = "remove it";
  } else if (on_several_lattices) {
    what = "bodies on several lattices (fix mpm/refine)";
    instead = "use one lattice";
  }
  if (what)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/contact {}: implicit steps (fix mpm/implicit) do not know {}: {}, or "
               "explicit steps",
               id, what, instead);
}

/** Number of rows of a tie: along the normals and, with friction, also along the interface. */
int FixMPMContact::rows_of_tie() const
{
  return law == STICK || has_friction() ? bodies[0].field->lattice.dim : 1;
}

/* ----------------------------------------------------------------------
   ties
------------------------------------------------------------------------- */

/** Makes the pair of two bodies at a node, with the area and normal of their interface there. Returns false if there is none. */
bool FixMPMContact::make_trial_pair(const Common &c, int n, int a, int b, Pair &pair)
{
  constexpr double SMALL = 1.0e-10;
  const MPMField &field = *bodies[a].field;
  int index[3];
  field.grid.node_index(field.grid.blocks[c.slot[a]], n, index);
  interface_at(a, b, index, pair.n);
  pair.area = MathExtra::len3(pair.n);
  if (!(pair.area > SMALL * field.lattice.cell_volume() / field.lattice.h)) return false;
  MathExtra::scale3(1.0 / pair.area, pair.n);
  pair.a = a;
  pair.b = b;
  pair.ra = bodies[a].field->grid.record(c.slot[a], n);
  pair.rb = bodies[b].field->grid.record(c.slot[b], n);
  pair.fade = pair.water = 0.0;
  pair.state = OPEN;
  return true;
}

/** Do walls determine both bodies at this node by those inside? Also finds the action of walls. */
bool FixMPMContact::is_beyond_walls(Pair &pair)
{
  const int all = (1 << bodies[0].field->lattice.dim) - 1;
  pair.walls_a = bodies[pair.a].find_walls(pair.ra);
  pair.walls_b = bodies[pair.b].find_walls(pair.rb);
  const auto follows = [all](const Pair::Walls &walls) {
    return ((walls.outside | walls.held) & all) == all;
  };
  return follows(pair.walls_a) && follows(pair.walls_b);
}

/** Node of a body by its index; -1: the body has none there. */
int64_t FixMPMContact::node_at(const Body &body, const int *index) const
{
  int at[3];
  for (int d = 0; d < 3; d++) at[d] = body.field->lattice.wrap(d, index[d]);
  return body.field->grid.locate(at);
}

/** Share of the volume of a node, as far as it is inside the box, that a body fills. */
double FixMPMContact::share_of(const Body &body, const int *index) const
{
  int at[3] = {index[0], index[1], index[2]};
  bool image = false;
  const double most = room.at(at, body.field->lattice.dim, image);
  const int64_t node = node_at(body, at);
  return node >= 0 && most > 0.0 ? body.share[node] / most : 0.0;
}

/** Does this rank know the share of the body at a node? */
bool FixMPMContact::is_known(const Body &body, const int *index) const
{
  const Grid &grid = body.field->grid;
  if (node_at(body, index) >= 0) return true;
  bool inside = true;
  for (int d = 0; d < grid.lattice.dim; d++) {
    const int b = body.field->lattice.wrap(d, index[d]) >> grid.shift_bits;
    inside = inside && b >= body.reach.extent[d] && b <= -body.reach.extent[3 + d];
  }
  return !inside;
}

/** Finds the gap of a line of nodes; negative: bodies overlap. Returns false where a body hardly covers the line. */
bool FixMPMContact::measure_gap(const Tie &tie, const Line &line, double &gap) const
{
  const double h = bodies[tie.a].field->lattice.h, slope = std::fabs(tie.n[line.axis]);
  if (std::min(line.seen[0].share, line.seen[1].share) < COVERED) return false;
  std::vector<std::array<double, 2>> shares;
  int at[3] = {line.index[0], line.index[1], line.index[2]};
  for (int i = line.low() - AROUND; i <= line.high() + AROUND; i++) {
    at[line.axis] = i;
    shares.push_back({share_of(bodies[tie.a], at), share_of(bodies[tie.b], at)});
  }
  // the sum goes from the fullest place of one body to that of the other: other surfaces of the bodies lie beyond. Among equally full
  // places it takes the nearest ones, as round-off would choose differently for each number of ranks
  double most[2] = {0.0, 0.0};
  for (const auto &share : shares)
    for (int k = 0; k < 2; k++) most[k] = std::max(most[k], share[k]);
  const int n = (int) shares.size();
  const auto is_fullest = [&](int i, int k) {
    return shares[i][k] >= (1.0 - SAME) * most[k];
  };
  int from = 0, to = n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      if (is_fullest(i, 0) && is_fullest(j, 1) && std::abs(i - j) < to - from) {
        from = std::min(i, j);
        to = std::max(i, j);
      }
  double missing = 0.0;
  for (int i = from; i <= to; i++)
    missing += 1.0 - shares[i][0] / line.seen[0].share - shares[i][1] / line.seen[1].share;
  gap = h * (slope * missing - (1.0 - full));
  return true;
}

/** Finds directions along the interface in which bodies can move against each other; none along components that walls hold in both
 *  bodies (held). */
void FixMPMContact::find_tangents(Tie &tie, int held) const
{
  const int dim = bodies[tie.a].field->lattice.dim;
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

/** Ties the bodies together along a line and the lines that join it. */
void FixMPMContact::add_tie(const std::vector<Line> &lines, const std::vector<int> &parts)
{
  Tie tie = {};
  const Line &line = lines[parts[0]];
  std::copy(line.key.begin(), line.key.end(), tie.key.begin());
  tie.key[6] = line.low();
  const Pair &begin = pairs[line.places[0].second];
  const int dim = bodies[begin.a].field->lattice.dim;
  tie.a = begin.a;
  tie.b = begin.b;
  tie.owned = owned_pairs[line.places[0].second];
  tie.first = (int) links.size();
  double area = 0.0;
  int held = (1 << dim) - 1;    // components that walls hold, or mirror, in both bodies
  std::vector<int> places;
  for (const int part : parts)
    for (const auto &place : lines[part].places) places.push_back(place.second);
  for (const int place : places) {
    const Pair &pair = pairs[place];
    area += pair.area;
    for (int d = 0; d < 3; d++) tie.n[d] += pair.area * pair.n[d];
    const auto &wa = pair.walls_a, &wb = pair.walls_b;
    held &= (wa.held | wa.outside) & (wb.held | wb.outside);
  }
  const double length = MathExtra::len3(tie.n);
  if (length == 0.0) return;
  MathExtra::scale3(1.0 / length, tie.n);
  find_tangents(tie, held);
  const auto number = [&](const Body &body, const double *record) {
    return (record - body.field->grid.nodes()) / body.field->grid.nreal;
  };
  const Body &a = bodies[tie.a], &b = bodies[tie.b];
  for (const int place : places) {
    const Pair &pair = pairs[place];
    Link link = {place_of(*a.field) + number(a, pair.ra),
                 place_of(*b.field) + number(b, pair.rb),
                 pair.ra,
                 pair.rb,
                 pair.area / area,
                 {pair.n[0], pair.n[1], pair.n[2]}};
    double soft[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++)
      for (int body = 0; body < 2; body++) {
        const auto &walls = body ? pair.walls_b : pair.walls_a;
        if (walls.held >> d & 1) continue;
        soft[d] += 1.0 / (walls.mirrored >> d & 1 ? walls.mass[d] : (body ? pair.rb : pair.ra)[3]);
      }
    for (int r = 0; r < rows_of_tie(); r++) {
      const double *const e = direction(tie, link, r);
      for (int d = 0; d < dim; d++)
        tie.diagonal[r] += link.share * link.share * soft[d] * e[d] * e[d];
    }
    links.push_back(link);
  }
  tie.last = (int) links.size();
  double free = 0.0;
  for (int k = tie.first; k < tie.last; k++)
    free += links[k].share * links[k].share * (1.0 / links[k].ra[3] + 1.0 / links[k].rb[3]);
  for (double &diagonal : tie.diagonal)
    if (diagonal < HELD * free) diagonal = 0.0;

  for (const int part : parts) {
    int at[3] = {lines[part].index[0], lines[part].index[1], lines[part].index[2]};
    for (const int end : {lines[part].low() - 1, lines[part].high() + 1}) {
      // a rank may have a part of a line that no point of it reaches
      at[line.axis] = end;
      if (is_known(a, at) && is_known(b, at)) continue;
      links.resize(tie.first);
      return;
    }
  }
  if (gap) {
    if (!measure_gap(tie, line, tie.gap)) {
      links.resize(tie.first);
      return;
    }
    tie.gap = std::max(tie.gap, 0.0);
  }
  ties.push_back(tie);
}

/** Finds lines of nodes with their two bodies, and their gaps. */
void FixMPMContact::find_ties()
{
  owned_pairs.assign(pairs.size(), 0);
  for (const auto &node : nodes)
    for (int p = node.first; p < node.last; p++) owned_pairs[p] = node.owned;
  std::vector<Line> lines;
  find_lines(lines);
  find_edges(lines);
  std::vector<std::vector<int>> parts(lines.size());
  for (int l = 0; l < (int) lines.size(); l++) {
    const int place = lines[l].joins < 0 ? l : lines[l].joins;
    parts[place].insert(lines[l].joins < 0 ? parts[place].begin() : parts[place].end(), l);
  }
  for (const auto &of_tie : parts)
    if (!of_tie.empty()) add_tie(lines, of_tie);
  check_overlap();
}

/** Ends with an error if bodies share more of the volume of a node than at the start of the run, beyond the limit of the warning
 *  there. Collective. */
void FixMPMContact::check_overlap()
{
  double mine = 0.0, most;
  for (std::size_t p = 0; p < pairs.size(); p++) {
    if (!owned_pairs[p]) continue;
    const Pair &pair = pairs[p];
    Grid &grid = bodies[pair.a].field->grid;
    int index[3];
    grid.node_index((pair.ra - grid.nodes()) / grid.nreal, index);
    const double Va = share_of(bodies[pair.a], index), Vb = share_of(bodies[pair.b], index);
    if (std::min(Va, Vb) >= OVERLAP_EACH) mine = std::max(mine, Va + Vb);
  }
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, world);
  if (look) shared_at_start = most;
  if (most < std::max(OVERLAP, ROOM * shared_at_start)) return;
  error->all(FLERR, Error::NOLASTLINE,
             "Fix mpm/contact {}: bodies have come into each other in the implicit steps of this "
             "run, so that they fill {:.3g} of the volume of a node: contact sees bodies that are "
             "up to about a node spacing away from each other when a step begins: use smaller "
             "steps",
             id, most);
}

/* ---------------------------------------------------------------------- */

void FixMPMContact::begin_trials(MPMField &, double dt, double, double, bool rests)
{
  trial_dt = dt;
  closes = false;
  rounds = 0;
  nodes.clear();
  pairs.clear();
  ties.clear();
  links.clear();
  if (!lists_valid) list_common_blocks();
  if (look) warn_thin();
  if (may_touch && map_bodies()) {
    if (look) warn_overlap();
    find_contacts();
    find_ties();
  }
  look = false;

  const double h = bodies[0].field->lattice.h;
  int mine = 0, any;
  for (const auto &tie : ties)
    if (tie.owned && tie.gap <= TOUCHED * h) mine = 1;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  for (auto &tie : ties) {
    if (any && tie.gap <= NEXT_TO * h) tie.gap = 0.0;
    tie.active = any ? tie.gap == 0.0 : rests && tie.gap < NEARBY * h;
    tie.sticks = law == STICK || has_friction();
  }
}

/* ----------------------------------------------------------------------
   the projection
------------------------------------------------------------------------- */

bool FixMPMContact::touches() const
{
  return std::any_of(ties.begin(), ties.end(), [](const Tie &tie) {
    return tie.active && tie.owned;
  });
}

bool FixMPMContact::close_gaps(bool yes)
{
  closes = yes;
  return yes && std::any_of(ties.begin(), ties.end(), [](const Tie &tie) {
           return tie.active && tie.gap > 0.0;
         });
}

void FixMPMContact::find_approach(const double *v, bool with_gaps, double *rows) const
{
  const int dim = bodies[0].field->lattice.dim, nrow = rows_of_tie();
  for (const auto &tie : ties) {
    double u[3] = {0.0, 0.0, 0.0};
    for (int k = tie.first; k < tie.last; k++) {
      const Link &link = links[k];
      for (int r = 0; r < nrow; r++) {
        const double *const e = direction(tie, link, r);
        for (int d = 0; d < dim; d++)
          u[r] += link.share * e[d] * (v[dim * link.a + d] - v[dim * link.b + d]);
      }
    }
    const double closing = with_gaps && closes ? tie.gap / trial_dt : 0.0;
    for (int r = 0; r < nrow; r++, rows++)
      *rows = acts(tie, r) ? u[r] - (r == 0 ? closing : 0.0) : 0.0;
  }
}

void FixMPMContact::add_squares(const double *rows, const double *v, double *sums) const
{
  const int dim = bodies[0].field->lattice.dim, nrow = rows_of_tie();
  sums[0] = sums[1] = 0.0;
  for (const auto &tie : ties) {
    double speed = 0.0;
    for (int k = tie.first; k < tie.last && v && tie.owned && tie.active; k++)
      for (int d = 0; d < dim; d++)
        speed += links[k].share *
            (std::fabs(v[dim * links[k].a + d]) + std::fabs(v[dim * links[k].b + d]));
    if (closes) speed += tie.gap / trial_dt;
    for (int r = 0; r < nrow; r++, rows++) {
      if (!tie.owned || !acts(tie, r)) continue;
      sums[0] += *rows * *rows / tie.diagonal[r];
      sums[1] += speed * speed / tie.diagonal[r];
    }
  }
}

/** Adds to force[dim] the forces of these rows of a tie on the bodies at a link; a has the sign of the row. */
void FixMPMContact::add_force(const Tie &tie, const Link &link, const double *rows,
                              double *force) const
{
  const int dim = bodies[tie.a].field->lattice.dim;
  for (int r = 0; r < rows_of_tie(); r++) {
    const double *const e = direction(tie, link, r);
    for (int d = 0; d < dim; d++) force[d] += link.share * rows[r] * e[d];
  }
}

void FixMPMContact::visit_row(std::size_t row,
                              const std::function<void(int64_t k, double c)> &use) const
{
  const int dim = bodies[0].field->lattice.dim, nrow = rows_of_tie();
  const Tie &tie = ties[row / nrow];
  for (int k = tie.first; k < tie.last; k++) {
    const Link &link = links[k];
    const double *const e = direction(tie, link, (int) (row % nrow));
    for (int d = 0; d < dim; d++) {
      use(dim * link.a + d, link.share * e[d]);
      use(dim * link.b + d, -link.share * e[d]);
    }
  }
}

void FixMPMContact::forget_pushes()
{
  for (auto &tie : ties) MathExtra::zero3(tie.push);
}

void FixMPMContact::push(double factor, const double *rows)
{
  const int nrow = rows_of_tie();
  for (auto &tie : ties)
    for (int r = 0; r < nrow; r++, rows++)
      if (tie.active) tie.push[r] += factor * *rows;
}

void FixMPMContact::take_base()
{
  for (auto &tie : ties) MathExtra::copy3(tie.push, tie.base);
}

void FixMPMContact::take_forces(double scale)
{
  for (auto &tie : ties)
    for (int r = 0; r < 3; r++) tie.force[r] = (tie.push[r] - tie.base[r]) / scale;
}

void FixMPMContact::take_stop()
{
  for (auto &tie : ties) MathExtra::copy3(tie.push, tie.stop);
}

/* ----------------------------------------------------------------------
   Coulomb's law, without any regularization. A tie that sticks has rows along the interface, whose forces show when friction cannot
   bear them. A tie that slides has friction mu N against the direction w of its slip, on the nodes of both bodies in their shares of
   the interface, and sticks again if it would slide back. This is Newton's method for the projection of P. Alart, A. Curnier, Comput.
   Methods Appl. Mech. Eng. 92 (1991) 353, with an exact condition for ties that stick. With the slip s in the step,

      w = (s + d w0)/|s + d w0|

   where w0 is the direction of the previous iteration, or of the force with which the tie stuck: friction does not jump when a tie begins
   to slide, and w is that of s in the end. As d becomes a small part of s, iterations converge to that direction fast, also in short
   steps: with a constant d, each one would leave d/(d + |s|) of the error. In 2d, w is w0, and friction changes with N alone. N may be
   negative until it is decided which ties part: as long as the sets stay, forces have no kinks
------------------------------------------------------------------------- */

bool FixMPMContact::rubs() const
{
  return has_friction() && std::any_of(ties.begin(), ties.end(), [this](const Tie &tie) {
           return tie.owned && slides(tie);
         });
}

/** Motion of a on b along the interface. */
void FixMPMContact::find_slip(const Tie &tie, const double *u, double *slip) const
{
  const int dim = bodies[tie.a].field->lattice.dim;
  MathExtra::zero3(slip);
  for (int k = tie.first; k < tie.last; k++)
    for (int d = 0; d < dim; d++)
      slip[d] += links[k].share * (u[dim * links[k].a + d] - u[dim * links[k].b + d]);
  const double along = MathExtra::dot3(slip, tie.n);
  for (int d = 0; d < 3; d++) slip[d] -= along * tie.n[d];
}

/** Finds w of tie.slip, a unit vector. Returns |s + d w0|, or 0 where w is not the direction of that. A tie that slides back keeps its
 *  direction until it sticks. */
double FixMPMContact::find_way(const Tie &tie, double *way) const
{
  if (bodies[0].field->lattice.dim == 2) {
    MathExtra::copy3(tie.way, way);
    return 0.0;
  }
  for (int d = 0; d < 3; d++) way[d] = tie.slip[d] + tie.turns * tie.way[d];
  const double length = MathExtra::len3(way), ahead = MathExtra::dot3(way, tie.way);
  if (ahead > MOST_TURN * length) {
    MathExtra::scale3(1.0 / length, way);
    return length;
  }
  if (ahead > 0.0) {
    // the largest turn in one iteration
    const double across = std::sqrt(length * length - ahead * ahead),
                 sine = std::sqrt(1.0 - MOST_TURN * MOST_TURN);
    for (int d = 0; d < 3; d++)
      way[d] = MOST_TURN * tie.way[d] + sine * (way[d] - ahead * tie.way[d]) / across;
  } else {
    MathExtra::copy3(tie.way, way);
  }
  return 0.0;
}

/** Adds a force on a, and the reaction on b. */
void FixMPMContact::rub(const Tie &tie, const double *on_a, double *force) const
{
  const int dim = bodies[tie.a].field->lattice.dim;
  for (int k = tie.first; k < tie.last; k++)
    for (int d = 0; d < dim; d++) {
      force[dim * links[k].a + d] += links[k].share * on_a[d];
      force[dim * links[k].b + d] -= links[k].share * on_a[d];
    }
}

/** Has this tie been let go so often in the step that it now goes on without anything that holds it along the interface? */
bool FixMPMContact::is_torn(const Tie &tie) const
{
  return tie.parted >= (law == STICK ? MOST_PARTED : MOST_PARTED_RUBBING);
}

/** Coefficient of friction. */
double FixMPMContact::friction_of(const Tie &tie) const
{
  return is_torn(tie) ? 0.0 : kinetic_friction;
}

void FixMPMContact::add_friction(const double *u, double *force)
{
  for (auto &tie : ties) {
    MathExtra::zero3(tie.rubs);
    if (!slides(tie)) continue;
    find_slip(tie, u, tie.slip);
    double way[3];
    find_way(tie, way);
    for (int d = 0; d < 3; d++) tie.rubs[d] = -friction_of(tie) * tie.force[0] * way[d];
    rub(tie, tie.rubs, force);
  }
}

/** Change of w for a change of the slip. */
void FixMPMContact::change_of_way(const Tie &tie, const double *slip, double *way,
                                  double *change) const
{
  const double length = find_way(tie, way), along = MathExtra::dot3(way, slip);
  for (int d = 0; d < 3; d++) change[d] = length > 0.0 ? (slip[d] - along * way[d]) / length : 0.0;
}

void FixMPMContact::add_friction_change(const double *du, double scale, double *dforce)
{
  for (auto &tie : ties) {
    if (!slides(tie)) continue;
    double slip[3], way[3], turn[3], change[3];
    find_slip(tie, du, slip);
    change_of_way(tie, slip, way, turn);
    const double more = (tie.push[0] - tie.base[0]) / scale;
    for (int d = 0; d < 3; d++)
      change[d] = -friction_of(tie) * (more * way[d] + std::max(tie.force[0], 0.0) * turn[d]);
    rub(tie, change, dforce);
  }
}

void FixMPMContact::add_friction_turn(const double *du, double *dforce)
{
  for (auto &tie : ties) {
    if (!slides(tie) || !(tie.force[0] > 0.0)) continue;
    double slip[3], way[3], turn[3];
    find_slip(tie, du, slip);
    change_of_way(tie, slip, way, turn);
    for (double &t : turn) t *= -friction_of(tie) * tie.force[0];
    rub(tie, turn, dforce);
  }
}

void FixMPMContact::correct(const double *)
{
  for (auto &tie : ties) {
    if (!slides(tie)) continue;
    double way[3];
    const double length = find_way(tie, way);
    MathExtra::copy3(way, tie.way);
    const double slip = MathExtra::len3(tie.slip);
    if (slip > 0.0 && length > 0.0) tie.turns = SOONER * std::min(tie.turns, slip);
  }
}

void FixMPMContact::add_friction_blocks(double *blocks)
{
  const int dim = bodies[0].field->lattice.dim;
  for (const auto &tie : ties) {
    if (!slides(tie) || !(tie.force[0] > 0.0)) continue;
    const double slope = friction_of(tie) * tie.force[0];
    for (int e = 0; e < dim; e++) {
      double along[3], way[3], turn[3];
      for (int d = 0; d < 3; d++) along[d] = (d == e) - tie.n[d] * tie.n[e];
      change_of_way(tie, along, way, turn);
      for (int k = tie.first; k < tie.last; k++)
        for (int d = 0; d < dim; d++) {
          const double stiffness = links[k].share * links[k].share * slope * turn[d];
          blocks[dim * dim * links[k].a + dim * d + e] += stiffness;
          blocks[dim * dim * links[k].b + dim * d + e] += stiffness;
        }
    }
  }
}

/** How wrong is the state of a tie in contact with friction, relative to the largest force? Positive: it changes. */
double FixMPMContact::wrong_friction(const Tie &tie, double largest) const
{
  if (!has_friction() || !can_slide(tie) || is_torn(tie) || !(largest > 0.0)) return 0.0;
  if (tie.sticks) {
    const double more = std::max(tie.changes - FREE_CHANGES, 0) * MORE_EACH;
    return (std::hypot(tie.force[1], tie.force[2]) -
            kinetic_friction * std::max(tie.force[0], 0.0)) /
        largest -
        std::min(more, MOST_MORE);
  }
  return -MathExtra::dot3(tie.slip, tie.way) / bodies[0].field->lattice.h;
}

/** Changes a tie from sticking to sliding, against the force with which it stuck, or back. */
void FixMPMContact::change_friction(Tie &tie) const
{
  MathExtra::zero3(tie.slip);
  MathExtra::zero3(tie.rubs);
  if (tie.sticks) {
    for (int d = 0; d < 3; d++)
      tie.way[d] = tie.force[1] * tie.along[0][d] + tie.force[2] * tie.along[1][d];
    MathExtra::norm3(tie.way);
    tie.turns = TURNS * bodies[0].field->lattice.h;
  }
  tie.sticks = !tie.sticks;
  tie.changes++;
}

/** Lets a tie touch from now on, after an overlap of this size. A tie with an inclined normal may be pulled by its own shear while it
 *  sticks or rubs, and overlap when it is let go, so that neither is a solution: after some changes it slips instead. With
 *  friction, a tie that has slid by more than friction could hold at the same stiffness keeps sliding: if it stuck first, its shear forces
 *  could pull it off again along an inclined normal, and so on without end. */
void FixMPMContact::begin_touch(Tie &tie, const double *u, double approach) const
{
  tie.active = true;
  tie.sticks = (has_friction() || law == STICK) && !is_torn(tie);
  MathExtra::zero3(tie.rubs);
  if (!has_friction() || !can_slide(tie) || is_torn(tie)) return;
  find_slip(tie, u, tie.slip);
  const double length = MathExtra::len3(tie.slip);
  if (length < kinetic_friction * approach || length == 0.0) return;
  tie.sticks = false;
  tie.turns = TURNS * bodies[0].field->lattice.h;
  for (int d = 0; d < 3; d++) tie.way[d] = tie.slip[d] / length;
}

/* ----------------------------------------------------------------------
   At first, everything that is wrong is changed. If this oscillates, only the worst is, and what is almost right stays. While forces are
   not in balance yet, errors that are not larger than the imbalance stay, too
------------------------------------------------------------------------- */

bool FixMPMContact::decide(const double *u, double unbalanced)
{
  const double h = bodies[0].field->lattice.h;
  const int dim = bodies[0].field->lattice.dim;
  std::vector<double> along(ties.size(), 0.0), wrong(ties.size(), 0.0);
  std::vector<char> by_friction(ties.size(), 0);
  double mine = 0.0, largest, worst;
  for (std::size_t k = 0; k < ties.size(); k++) {
    const Tie &tie = ties[k];
    if (!tie.active) continue;
    along[k] = tie.force[0];
    if (tie.owned) mine = std::max(mine, std::fabs(along[k]));
  }
  MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  mine = 0.0;
  for (std::size_t k = 0; k < ties.size(); k++) {
    const Tie &tie = ties[k];
    if (tie.active) {
      wrong[k] = largest > 0.0 ? -along[k] / largest : 0.0;
      const double friction = wrong_friction(tie, largest);
      by_friction[k] = friction > wrong[k] && wrong[k] <= WRONG;
      if (by_friction[k]) wrong[k] = friction;
    } else {
      double approach = -tie.gap;
      for (int j = tie.first; j < tie.last; j++)
        for (int d = 0; d < dim; d++)
          approach +=
              links[j].share * links[j].n[d] * (u[dim * links[j].a + d] - u[dim * links[j].b + d]);
      wrong[k] = approach / h;
    }
    if (tie.owned) mine = std::max(mine, wrong[k]);
  }
  MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE, MPI_MAX, world);
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
      change_friction(ties[k]);
    } else if (ties[k].active) {
      ties[k].active = false;
      ties[k].parted += has_friction() || ties[k].sticks;
      MathExtra::zero3(ties[k].rubs);
    } else {
      begin_touch(ties[k], u, wrong[k] * h);
    }
  }
  return changed;
}

/** Warns of lines that slip because they were let go too often, once in a run. Collective. */
void FixMPMContact::warn_of_torn()
{
  if ((law != STICK && !has_friction()) || told_of_torn) return;
  bigint mine[2] = {0, 0}, all[2];
  for (const auto &tie : ties) {
    if (!tie.owned || !tie.active) continue;
    mine[0]++;
    mine[1] += is_torn(tie);
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all[1] == 0) return;
  told_of_torn = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/contact {}: {} of {} lines of nodes between bodies slip without friction in step "
        "{}: they would be pulled while they stick or rub, and go into the other body when they "
        "are let go, as lines with inclined normals at edges may; this is said only once in a run",
        id, all[1], all[0], update->ntimestep);
}

/* ----------------------------------------------------------------------
   Adds the forces of contact to the nodes, which have all other forces except those of walls; walls act after this
------------------------------------------------------------------------- */

void FixMPMContact::act_after_trials()
{
  warn_of_torn();
  const int dim = bodies[0].field->lattice.dim;
  std::vector<Velocities> before(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); n++)
    for (std::size_t k = 0; k < bodies.size(); k++)
      if (nodes[n].record[k]) std::copy_n(nodes[n].record[k], 3, before[n][k].begin());
  for (const auto &tie : ties) {
    Account &entry = accounts[pair_index(tie.a, tie.b, (int) bodies.size())];
    for (int k = tie.first; k < tie.last && tie.active; k++) {
      const Link &link = links[k];
      double impulse[3] = {0.0, 0.0, 0.0}, stop[3] = {0.0, 0.0, 0.0};
      add_force(tie, link, tie.force, impulse);
      add_force(tie, link, tie.stop, stop);
      for (int d = 0; d < dim; d++) {
        impulse[d] = trial_dt * of_forces * (impulse[d] - link.share * tie.rubs[d]) + stop[d];
        link.ra[d] -= impulse[d] / link.ra[3];
        link.rb[d] += impulse[d] / link.rb[3];
        if (tie.owned) entry.impulse[d] += impulse[d];
      }
      if (tie.owned) entry.count += 1.0;
    }
    if (tie.owned && tie.active) entry.work += of_forces * MathExtra::dot3(tie.rubs, tie.slip);
  }
  for (std::size_t n = 0; n < nodes.size(); n++)
    for (std::size_t k = 0; k < bodies.size(); k++) {
      const double *const record = nodes[n].record[k];
      Grid &grid = bodies[k].field->grid;
      // another rank may own the node in this field: other impulses on it are booked there
      if (!record || !grid.owns((record - grid.nodes()) / grid.nreal)) continue;
      double change[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < dim; d++) change[d] = record[d] - before[n][k][d];
      bodies[k].field->ledger.count_push(record, change);
    }
}
