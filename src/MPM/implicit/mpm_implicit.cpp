/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_implicit.h"

#include "contact/mpm_ties.h"
#include "field/mpm_body_contact.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_line_ties.h"
#include "field/mpm_node_action.h"
#include "field/mpm_plan.h"
#include "field/mpm_stencil.h"
#include "field/mpm_trial_contact.h"
#include "force.h"
#include "implicit/mpm_implicit_pressure.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double PROJECTED = 1.0e-12;    // relative change by one more action
static constexpr int MOST_REPEATS = 200;
// nodes in a group tied by lines of walls, up to which each has its own unit vector
static constexpr int MOST_TIED = 48;
// in larger groups, spacings between nodes that share a unit vector
static constexpr int APART = 7;
static constexpr double ENOUGH = 0.9;    // share of the slope that may be left, with the other sign
static constexpr int MOST_CUTS = 12;
static constexpr double MOST_ACCURATE = 1.0e-10;    // linear solution
static constexpr double SYMMETRIC =
    1.0e-3;    // greatest asymmetry of tangents, for conjugate gradients
static constexpr double ROUND_OFF = 2.0e-16;    // of strains, which limits the accuracy of forces
static constexpr int TURN = 1000;               // iterations in which GMRES must gain something
// Newton iterations in a part of a step that failed as a whole
static constexpr int IN_A_PART = 15;
// iterations up to which levels are kept for the next tangents
static constexpr int DO_WELL = 15;
static constexpr int TOO_OLD = 300;    // iterations with old levels, after which new ones are tried
static constexpr double SLIP = 1.0e-5;    // of friction, in node spacings
// the slip at first, and the factor by which it decreases
static constexpr double SOFT = 0.1, HARDER = 0.1;
static constexpr double NEARLY = 1.0e-3;    // residual over all forces at which the slip decreases
// growth of the residual that is accepted where lines of nodes begin to stick or slip
static constexpr double MAY_GROW = 100.0;
// share of the residual left after an iteration that counts as slow
static constexpr double STALLS = 0.5;
// such iterations, until bodies decide what touches and slides
static constexpr int MOST_SLOW = 2;
static constexpr double AT_ONCE = 0.1;    // node spacings up to which walls move their nodes alone
static constexpr int ROUNDS = 2;    // in which friction of walls that press on each other is found
static constexpr double LOST = 1.0e12;    // growth over the first residual at which an attempt ends
// in points: nodes with less reach count as without points
static constexpr double REACHED = 1.0e-9;
// largest system, by dimension, that is factorized as a whole, which is faster than levels
static constexpr int WHOLE[] = {0, 0, 12000, 8500};
// the same with averages of the pressure, for which levels need many iterations
static constexpr int WHOLE_WITH_AVERAGES[] = {0, 0, 60000, 15000};

/* ---------------------------------------------------------------------- */

MPMImplicitOptions::Coefficients MPMImplicitOptions::coefficients() const
{
  double m = 0.0, f = 0.0, end = gamma;
  if (keeps_acceleration()) {
    f = time == ALPHA ? rho / (1.0 + rho) : (1.0 - rho) / (1.0 + rho);
    m = time == ALPHA ? (2.0 * rho - 1.0) / (1.0 + rho) : 0.0;
    end = 0.5 - m + f;
  }
  return {0.25 * (end + 0.5) * (end + 0.5), end, m, f};
}

/* ---------------------------------------------------------------------- */

MPMImplicit::Member::Member(LAMMPS *lmp, MPMField &field) : field(field), tangent(lmp, field) {}

std::vector<std::unique_ptr<MPMImplicit::Member>>
MPMImplicit::make_members(LAMMPS *lmp, const std::vector<MPMField *> &fields)
{
  std::vector<std::unique_ptr<Member>> list;
  for (auto *one : fields) list.push_back(std::make_unique<Member>(lmp, *one));
  return list;
}

MPMImplicit::MPMImplicit(LAMMPS *lmp, const std::vector<MPMField *> &fields,
                         const MPMImplicitOptions &options, Accelerations &kept) :
    MPMNodeSystem(lmp, fields[0]->grid, fields[0]->lattice.dim),
    field(*fields[0]), options(options), kept(kept), stabilize(options.stabilize),
    members(make_members(lmp, fields)), tangent(members[0]->tangent),
    ranks(lmp, field.grid, *field.nodes.halo)
{
  if (options.preconditioner == MPMImplicitOptions::MULTIGRID)
    multigrid = std::make_unique<SplineMultigrid>(
        field.grid, ranks, width, stencil_order(field.options.shape), 0,
        (averages() ? WHOLE_WITH_AVERAGES : WHOLE)[width]);
}

MPMImplicit::~MPMImplicit() = default;

void MPMImplicit::init()
{
  by_reach = field.domains || !field.elements.empty();
  for (auto &member : members) member->tangent.init();
  joint.reset();
  for (auto *water : field.plan->pore_pressures)
    if (auto *const pressure = water->node_pressure(field))
      joint = std::make_unique<Joint>(*this, *pressure);
}

/** Calls use(member, n, record) for all nodes, where n is their place in vectors. */
template <class Use> void MPMImplicit::each_record(const Use &use)
{
  for (auto &member : members) {
    double *record = member->field.grid.nodes();
    const int64_t end = member->end();
    for (int64_t n = member->first; n < end; n++, record += 8) use(*member, n, record);
  }
}

/** Calls use(n) for all nodes with a mass that this rank owns. */
template <class Use> void MPMImplicit::each_owned(const Use &use) const
{
  for (std::size_t k = 0; k < heavy_owned; k++) use(heavy[k]);
}

/** Calls use(n, k) for all entries k of vectors that belong to nodes n with a mass. The width is a constant
 *  in the innermost loop. */
template <class Use> void MPMImplicit::each_entry(const Use &use) const
{
  const auto all = [&](auto dim) {
    constexpr int W = decltype(dim)::value;
    for (const int64_t n : heavy)
      for (int d = 0; d < W; d++) use(n, W * n + d);
  };
  if (width == 2)
    all(std::integral_constant<int, 2>());
  else
    all(std::integral_constant<int, 3>());
}

void MPMImplicit::find_heavy()
{
  heavy.clear();
  heavy_records.clear();
  for (const bool owned : {true, false}) {
    each_record([&](const Member &member, int64_t n, double *record) {
      if (!(mass[n] > 0.0) || member.owns(n) != owned) return;
      heavy.push_back(n);
      heavy_records.push_back(record);
    });
    if (owned) heavy_owned = heavy.size();
  }
}

/* ----------------------------------------------------------------------
   masses and velocities of the nodes from their records
------------------------------------------------------------------------- */

void MPMImplicit::take_nodes()
{
  int64_t nnodes = 0;
  for (auto &member : members) {
    member->first = nnodes;
    nnodes += member->field.grid.nnodes();
  }
  if (by_reach) find_reach();
  mass.resize(nnodes);
  for (auto *list : {&before, &explicit_velocity, &outer, &inner, &from, &residual, &free, &trial,
                     &change, &correction, &room})
    list->assign(nreals(), 0.0);
  each_record([&](const Member &, int64_t n, double *record) {
    mass[n] = record[3] > 0.0 ? record[3] : 0.0;
    if (field.domains && reach[n] < REACHED) {    // as if no point reached it
      std::fill_n(record, 8, 0.0);
      mass[n] = 0.0;
    }
    if (mass[n] == 0.0) return;
    for (int d = 0; d < width; d++) {
      explicit_velocity[width * n + d] = record[d];
      before[width * n + d] = record[4 + d];
    }
  });
  find_heavy();
}

/** Restores the records of nodes, which hold trial motions during the step, to the start of the step. */
void MPMImplicit::give_back_start()
{
  each_record([&](const Member &, int64_t n, double *record) {
    record[3] = mass[n];
    for (int d = 0; d < width; d++) {
      record[d] = explicit_velocity[width * n + d];
      record[4 + d] = before[width * n + d];
    }
  });
}

/* ----------------------------------------------------------------------
   A node that corners of domains, or nodes of elements, reach with a small share e has forces of the order e
   and a stiffness of the order e^2: it moves 1/e times as far as these corners do. Its forces divided by e
   show how well the forces of the corners are in balance. Where e is only round-off of the places of corners,
   which may lie on a plane of nodes, the node is left alone: corners then do not move by this share.
------------------------------------------------------------------------- */

void MPMImplicit::find_reach()
{
  const MPMStencil stencil(field);
  reach.assign(grid.nnodes(), 0.0);
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++)
      stencil.visit(grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
        reach[node.number] += node.weight;
      });
  field.nodes.sum(reach.data(), 1, 0, 1);
  for (double &number : reach) number = std::min(number, 1.0);
}

/* ----------------------------------------------------------------------
   Constraints. Walls that meet act one after the other, and the last one may undo part of what the first one
   did. When they are repeated, orthogonal projections converge to the projection onto what all of them leave
   free (J. von Neumann, 1933).
------------------------------------------------------------------------- */

void MPMImplicit::act(double *velocities)
{
  for (auto *contact : contacts) contact->forget_pushes();
  act_by_walls(velocities);
  if (touching) ties->close(velocities);
}

void MPMImplicit::act_by_walls(double *velocities)
{
  const std::size_t n = heavy.size();
  for (std::size_t i = 0; i < n; i++)
    for (int d = 0; d < width; d++) heavy_records[i][d] = velocities[width * heavy[i] + d];
  for (int k = 0; k < repeats; k++) field.plan->act_on_nodes(MPMNodeAction::TRIAL);
  for (std::size_t i = 0; i < n; i++)
    for (int d = 0; d < width; d++) velocities[width * heavy[i] + d] = heavy_records[i][d];
}

void MPMImplicit::find_constraints()
{
  constrained = !field.plan->actions.empty();
  wall.assign(nreals(), 0.0);
  closing.clear();
  wall_speed = 0.0;
  if (!constrained) return;
  if (has_friction) {
    int mine = 0, any;
    for (const auto *contact : contacts)
      if (contact->rubs()) mine = 1;
    MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, lmp->world);
    rubs = any;
  }

  // is P P = P for an arbitrary vector, and the same on all ranks?

  std::vector<double> once(nreals()), twice;
  for (repeats = 1; repeats <= MOST_REPEATS; repeats *= 2) {
    find_touching();
    std::fill(wall.begin(), wall.end(), 0.0);
    act(wall.data());
    for (auto *contact : contacts) contact->take_base();
    wall_speed = std::sqrt(product(wall.data(), wall.data()));
    int index[3];
    for (std::size_t k = 0; k < members.size(); k++)
      for (const int64_t n : heavy) {
        if (n < members[k]->first || n >= members[k]->end()) continue;
        members[k]->field.grid.node_index(n - members[k]->first, index);
        for (int d = 0; d < width; d++)
          once[width * n + d] =
              std::sin(1.0 + 3.1 * index[0] + 5.3 * index[1] + 7.7 * index[2] + 2.3 * d + 4.1 * k);
      }
    project(once.data());
    twice = once;
    project(twice.data());
    const double size = std::sqrt(product(once.data(), once.data()));
    for (int64_t k = 0; k < nreals(); k++) twice[k] -= once[k];
    if (std::sqrt(product(twice.data(), twice.data())) <= PROJECTED * size) return find_closing();
  }
  now.failure =
      "walls that meet contradict each other: give them the same velocity, or move faces of "
      "regions to planes of nodes";
}

/* ----------------------------------------------------------------------
   bodies that touch each other
------------------------------------------------------------------------- */

/** Finds whether anything touches, and what the walls do by themselves. */
void MPMImplicit::find_touching()
{
  touching = false;
  if (!tied) return;
  int mine = tied->touches(), any;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, lmp->world);
  touching = any;
  const int acts = repeats;
  of_walls.assign(nreals(), 0.0);
  act_by_walls(of_walls.data());
  speed_of_walls = std::sqrt(product(of_walls.data(), of_walls.data()));
  if (!touching) return;
  if (!ties->known_for(acts))
    ties->begin(*tied, mass, width, acts, field.plan->actions.size() > 1, [this](double *v) {
      take_by_walls(v);
    });
  ties->factorize();
}

/** v <- P_w v with the projection of the walls alone, scaled as in project(). */
void MPMImplicit::take_by_walls(double *v)
{
  double scale = 1.0;
  if (speed_of_walls > 0.0) {
    const double size = std::sqrt(product(v, v));
    if (size > 0.0) scale = speed_of_walls / size;
    for (int64_t k = 0; k < nreals(); k++) v[k] *= scale;
  }
  act_by_walls(v);
  if (speed_of_walls > 0.0)
    for (int64_t k = 0; k < nreals(); k++) v[k] = (v[k] - of_walls[k]) / scale;
}

/** Displacements that bring nodes to the walls that hold them, where they were not at the start of the step. */
void MPMImplicit::find_closing()
{
  int mine = 0, any = 0;
  if (contacts.empty()) return;
  for (auto *contact : contacts)
    if (contact->close_gaps(true)) mine = 1;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, lmp->world);
  if (any) {
    closing.assign(nreals(), 0.0);
    act(closing.data());
    for (int64_t k = 0; k < nreals(); k++) closing[k] = dt * (closing[k] - wall[k]);
  }
  for (auto *contact : contacts) contact->close_gaps(false);
}

/** x <- P x. Where walls move, x is scaled to the size of their velocity, so that the difference keeps its
 *  digits. */
void MPMImplicit::project(double *x)
{
  if (!constrained) return;
  double scale = 1.0;
  if (wall_speed > 0.0) {
    const double size = std::sqrt(product(x, x));
    if (size > 0.0) scale = wall_speed / size;
    each_entry([&](int64_t, int64_t k) {
      x[k] *= scale;
    });
  }
  of_pushes = scale;
  act(x);
  if (wall_speed > 0.0)
    each_entry([&](int64_t, int64_t k) {
      x[k] = (x[k] - wall[k]) / scale;
    });
}

/** f <- P^T f = M P M^-1 f */
void MPMImplicit::project_forces(double *f)
{
  if (!constrained) return;
  each_entry([&](int64_t n, int64_t k) {
    f[k] /= mass[n];
  });
  project(f);
  each_entry([&](int64_t n, int64_t k) {
    f[k] *= mass[n];
  });
}

/** Friction after the motion u, from the pressing forces in the residual, which contains the friction of
 *  other walls. */
void MPMImplicit::find_friction(const std::vector<double> &u)
{
  friction.assign(nreals(), 0.0);
  for (int round = 0; round < ROUNDS; round++) {
    for (int64_t k = 0; k < nreals(); k++) free[k] = residual[k] + friction[k];
    project_forces(free.data());
    std::fill(friction.begin(), friction.end(), 0.0);
    for (auto *contact : contacts) {
      contact->take_forces(of_pushes);
      // bodies that stick have no slip in u, so the slip of sliding ones has to be measured in the same way
      contact->add_friction(contact->is_regularised() ? slide_of(u) : u.data(), friction.data());
    }
    for (double &force : friction) force *= rub_share;
  }
}

/** Do the linear systems keep the pressing forces fixed, so that sliding bodies leave them symmetric? The
 *  balance of forces has friction by the present pressing forces. The iterations converge to it if friction
 *  changes these forces by less than they change friction. */
bool MPMImplicit::holds_bounds() const
{
  return tied && now.asymmetry <= SYMMETRIC;
}

/** Moves u to what walls allow after this share of their way. If that is far, u stays as it is and the way is
 *  added to held: true, on all ranks. */
bool MPMImplicit::meet_walls(std::vector<double> &u, double share)
{
  trial = u;
  project(trial.data());
  for (int64_t k = 0; k < nreals(); k++) trial[k] += share * dt * wall[k];
  if (!closing.empty())
    for (int64_t k = 0; k < nreals(); k++) trial[k] += closing[k];
  double most = 0.0, way;
  for (int64_t k = 0; k < nreals(); k++) most = std::max(most, std::fabs(trial[k] - u[k]));
  MPI_Allreduce(&most, &way, 1, MPI_DOUBLE, MPI_MAX, lmp->world);
  if (way <= AT_ONCE * field.lattice.h) {
    u = trial;
    return false;
  }
  for (int64_t k = 0; k < nreals(); k++) held[k] += trial[k] - u[k];
  return true;
}

/** Sum of forces that counts as round-off: that of a strain, and of the part of the strain that comes from
 *  motions larger than a node spacing. The motion is a mean over the mass, because nodes at the very end of
 *  the functions of points have next to no mass and move far. */
double MPMImplicit::negligible_forces(const std::vector<double> &u, double stiffness) const
{
  double mine[2] = {0.0, 0.0}, all[2];
  each_owned([&](int64_t n) {
    double square = 0.0;
    for (int d = 0; d < width; d++) square += u[width * n + d] * u[width * n + d];
    if (by_reach) square *= reach[n] * reach[n];
    mine[0] += mass[n] * square;
    mine[1] += mass[n];
  });
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, lmp->world);
  const double way = all[1] > 0.0 ? std::sqrt(all[0] / all[1]) : 0.0;
  return ROUND_OFF * stiffness * std::max(1.0, 4.0 * way / field.lattice.h);
}

/** Gives nodes that points barely reach a stiffness by the moduli at the start of the step. Collective. */
void MPMImplicit::begin_loose()
{
  std::vector<double> moduli;
  for (auto &member : members) {
    if (!member->loose) member->loose = std::make_unique<MPMLooseNodes>(lmp, member->field);
    const std::vector<double> still(width * member->field.grid.nnodes(), 0.0);
    member->tangent.linearize(still.data(), part * dt);
    member->tangent.find_moduli(moduli);
    member->loose->begin(stabilize, moduli);
  }
}

/** Decides what touches when forces are in balance. False, on all ranks, if nothing changes. */
bool MPMImplicit::decide_contact(std::vector<double> &u, double unbalanced)
{
  int changed = 0, any;
  for (auto *contact : contacts)
    if (contact->decide(u.data(), unbalanced)) changed = 1;
  MPI_Allreduce(&changed, &any, 1, MPI_INT, MPI_MAX, lmp->world);
  if (!any) return false;
  find_constraints();
  by_levels = false;
  return true;
}

/** Moves what is held along its way, and all the rest with it, by the largest of the shares 1, 1/2, ... after
 *  which no point is inside out. False if there is none. */
bool MPMImplicit::close(std::vector<double> &u, const std::vector<double> &du, double &size,
                        double &share)
{
  const std::vector<double> begin = u, way = du;
  share = 1.0;
  for (int cut = 0; cut <= MOST_CUTS; cut++, now.cuts++, share *= 0.5) {
    for (int64_t k = 0; k < nreals(); k++) u[k] = begin[k] + share * (held[k] + way[k]);
    if (find_residual(u, size)) return true;
  }
  u = begin;
  return false;
}

/** Finds points that walls carry as a whole; true if there may be any, on any rank. There are none with
 *  averages of stress, a pressure of nodes, or forces of the start of the step, which do not account for
 *  them. */
bool MPMImplicit::find_carried()
{
  std::vector<MPMTangent::Part> parts;
  bool any = false;
  if (!joint && !field.options.averages_stress() &&
      (options.time == MPMImplicitOptions::STATIC || options.time == MPMImplicitOptions::EULER)) {
    std::vector<double> left;
    for (auto *contact : contacts)
      if (contact->find_carried(field, left)) any = true;
    for (std::size_t i = 0; i < left.size(); i++)
      if (left[i] < 1.0) parts.push_back({(bigint) i, left[i]});
  }
  tangent.set_parts(std::move(parts));
  return any;
}

/** Moves the loads on these points from the nodes to the walls. Collective. */
void MPMImplicit::bear_carried()
{
  std::vector<double> on_them(nreals());
  tangent.forces_on_rest(on_them.data());
  for (int64_t k = 0; k < nreals(); k++) outer[k] -= on_them[k];
  for (auto *contact : contacts) contact->bear_carried(field, on_them.data());
  for (int64_t k = 0; k < nreals(); k++) outer[k] += on_them[k];
}

void MPMImplicit::check_contacts()
{
  for (auto *contact : contacts) contact->check_arrival();
}

/** Sum of the sizes of the vectors of the nodes of this rank. of_corners: sizes as seen by corners of
 *  domains, see find_reach(). */
double MPMImplicit::size_of(const std::vector<double> &f, bool of_corners) const
{
  double mine = 0.0;
  if (of_corners && field.domains)
    each_owned([&](int64_t n) {
      double square = 0.0;
      for (int d = 0; d < width; d++) square += f[width * n + d] * f[width * n + d];
      mine += std::sqrt(square) / reach[n];
    });
  else if (width == 2)
    each_owned([&](int64_t n) {
      mine += std::sqrt(f[2 * n] * f[2 * n] + f[2 * n + 1] * f[2 * n + 1]);
    });
  else
    each_owned([&](int64_t n) {
      const double *const of = &f[3 * n];
      mine += std::sqrt(of[0] * of[0] + of[1] * of[1] + of[2] * of[2]);
    });
  return mine;
}

/* ----------------------------------------------------------------------
   The linear system: P^T (c m + K) P with K = -df_int/du
------------------------------------------------------------------------- */

void MPMImplicit::apply(const double *x, double *y)
{
  // levels know what walls leave free only node by node: their vectors are not quite in the range of P
  if (by_levels) {
    allowed.assign(x, x + nreals());
    project(allowed.data());
    x = allowed.data();
  }
  change_of_forces(x, y);
  for (int64_t n = 0, k = 0; n < (int64_t) mass.size(); n++)
    for (int d = 0; d < width; d++, k++)
      y[k] = mass[n] > 0.0 ? inertia * mass[n] * x[k] - late * part * y[k] : 0.0;
  if (rubs && holds_bounds()) {
    friction.assign(nreals(), 0.0);
    tied->add_friction_turn(x, friction.data());
    for (int64_t k = 0; k < nreals(); k++) y[k] -= rub_share * friction[k];
  } else if (rubs) {
    friction.assign(nreals(), 0.0);
    for (int round = 0; round < ROUNDS; round++) {
      for (int64_t k = 0; k < nreals(); k++) room[k] = friction[k] - y[k];
      project_forces(room.data());
      std::fill(friction.begin(), friction.end(), 0.0);
      for (auto *contact : contacts) contact->add_friction_change(x, of_pushes, friction.data());
      for (double &force : friction) force *= rub_share;
    }
    for (int64_t k = 0; k < nreals(); k++) y[k] -= friction[k];
  }
  project_forces(y);
}

/** Applies the preconditioner: levels, or the inverted blocks of nodes. */
void MPMImplicit::precondition(const double *r, double *z)
{
  if (by_levels) {
    multigrid->precondition(r, z);
    // nodes that are left alone, see find_reach(), have a stiffness but no mass
    for (int64_t k = 0; by_reach && k < nreals(); k++)
      if (!(mass[k / width] > 0.0)) z[k] = 0.0;
    project(z);
    return;
  }
  std::fill_n(z, nreals(), 0.0);
  each_entry([&](int64_t n, int64_t k) {
    const double *const row = &blocks[width * k];
    double sum = 0.0;
    for (int b = 0; b < width; b++) sum += row[b] * r[width * n + b];
    z[k] = sum;
  });
  project(z);
}

/** Inverts a symmetric matrix in place, by its Cholesky factors or, where it has none, by its diagonal. */
static void invert(int n, double *A)
{
  double L[3][3] = {{0.0}}, inverse[3][3] = {{0.0}};
  bool good = true;
  for (int i = 0; i < n && good; i++)
    for (int j = 0; j <= i && good; j++) {
      double sum = 0.5 * (A[n * i + j] + A[n * j + i]);
      for (int k = 0; k < j; k++) sum -= L[i][k] * L[j][k];
      if (i == j) good = sum > 1.0e-12 * A[n * i + i] && A[n * i + i] > 0.0;
      if (good) L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
    }
  if (!good) {
    double most = 0.0;
    for (int i = 0; i < n; i++) most = std::max(most, std::fabs(A[n * i + i]));
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        A[n * i + j] =
            i != j || most == 0.0 ? 0.0 : 1.0 / std::max(std::fabs(A[n * i + i]), 1.0e-6 * most);
    return;
  }
  for (int c = 0; c < n; c++)
    for (int i = c; i < n; i++) {
      double sum = i == c;
      for (int k = c; k < i; k++) sum -= L[i][k] * inverse[k][c];
      inverse[i][c] = sum / L[i][i];
    }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      A[n * i + j] = 0.0;
      for (int k = 0; k < n; k++) A[n * i + j] += inverse[k][i] * inverse[k][j];
    }
}

/* ----------------------------------------------------------------------
   All fields: each one has a part of the vectors
------------------------------------------------------------------------- */

void MPMImplicit::change_of_forces(const double *du, double *dforce)
{
  for (auto &member : members) {
    const int64_t first = width * member->first;
    member->tangent.change_of_forces(du + first, dforce + first);
    if (member->loose) member->loose->add_forces(du + first, dforce + first);
  }
}

MPMImplicit::Clock::Clock(MPMImplicit &of, Part which) :
    of(of), which(which), outer(of.clock), start(platform::walltime())
{
  of.clock = this;
}

MPMImplicit::Clock::~Clock()
{
  const double passed = platform::walltime() - start;
  of.seconds[which] += passed - within;
  if (outer) outer->within += passed;
  of.clock = outer;
}

/** Forces of the stress after the motion u, see MPMTangent::forces(). */
bool MPMImplicit::find_forces(const double *u, double *force, double &carried)
{
  bool good = true;
  carried = 0.0;
  for (auto &member : members) {
    const int64_t first = width * member->first;
    double mine;
    good = member->tangent.forces(u + first, part * dt, force + first, mine) && good;
    if (good && member->loose) member->loose->add_forces(u + first, force + first);
    carried += mine;
  }
  return good;
}

/** Finds the tangents at the motion u and their asymmetry; returns the stiffness. */
double MPMImplicit::linearize(const double *u)
{
  const Clock timed(*this, TANGENTS);
  double stiffness = 0.0;
  now.asymmetry = 0.0;
  for (auto &member : members) {
    stiffness += member->tangent.linearize(u + width * member->first, part * dt);
    now.asymmetry = std::max(now.asymmetry, member->tangent.asymmetry());
  }
  return stiffness;
}

bool MPMImplicit::Member::owns(int64_t n) const
{
  return field.grid.owns(n - first);
}

int64_t MPMImplicit::Member::end() const
{
  return first + field.grid.nnodes();
}

/** The number of the first node of a field. */
int64_t MPMImplicit::first_of(const MPMField &of) const
{
  for (const auto &member : members)
    if (&member->field == &of) return member->first;
  return -1;
}

void MPMImplicit::products(int n, const double *const *a, const double *const *b, double *value)
{
  of_rank.assign(n, 0.0);
  for (const auto &member : members)
    add_products(member->field.grid, width, n, a, b, width * member->first, of_rank.data());
  sum_in_order(lmp, n, of_rank.data(), of_ranks, value);
}

/* ---------------------------------------------------------------------- */

/** The part s u of a motion. */
const double *MPMImplicit::part_of(const std::vector<double> &u)
{
  if (part == 1.0) return u.data();
  partial.resize(u.size());
  for (std::size_t k = 0; k < u.size(); k++) partial[k] = part * u[k];
  return partial.data();
}

/** Finds the residual after the motion u, that is, the forces that are not in balance: all of them in
 *  residual, and without what walls bear in free. size: of all forces. along: product of free with the given
 *  vector, if there is one. False, on all ranks, where points are inside out or anything is not finite.
 *  Collective. */
bool MPMImplicit::find_residual(const std::vector<double> &u, double &size,
                                const std::vector<double> *vector, double *along)
{
  const Clock timed(*this, FORCES);
  double carried;
  if (joint) joint->set_pressure();
  if (!find_forces(part_of(u), inner.data(), carried)) return false;
  each_entry([&](int64_t n, int64_t k) {
    const double pull = inertia * mass[n] * (u[k] - from[k]);
    residual[k] = outer[k] + late * inner[k] - pull;
    change[k] = pull;
  });
  if (late < 1.0)
    each_entry([&](int64_t, int64_t k) {
      residual[k] += early[k];
    });
  each_entry([&](int64_t, int64_t k) {
    free[k] = residual[k];
  });
  if (rubs) {
    find_friction(u);
    each_entry([&](int64_t, int64_t k) {
      free[k] = residual[k] + friction[k];
    });
  }
  project_forces(free.data());
  for (auto *contact : contacts) contact->take_forces(of_pushes);
  // all sums in one message
  double mine[5] = {size_of(free, true), size_of(outer), size_of(change), carried, 0.0}, all[5];
  if (vector)
    for (std::size_t i = 0; i < heavy_owned; i++)
      for (int64_t k = width * heavy[i]; k < width * (heavy[i] + 1); k++)
        mine[4] += (*vector)[k] * free[k];
  sum_in_order(lmp, 5, mine, of_ranks, all);
  now.unbalanced = all[0];
  if (vector) *along = all[4];
  if (joint) now.water = joint->find_residual(u, all[3]);
  size = all[3] + all[1] + all[2];
  now.ratio = now.unbalanced == 0.0 ? 0.0 : now.unbalanced / size;
  return std::isfinite(now.unbalanced) && std::isfinite(now.water);
}

/* ----------------------------------------------------------------------
   u <- u + s du with du in change, whose slope du . free is given. A step is too long if the forces along it
   have changed sign and are as large as before. Forces that grow without a change of sign are accepted: this
   happens where a solid softens first (P2 of the benchmarks).
------------------------------------------------------------------------- */

bool MPMImplicit::search(std::vector<double> &u, double slope, double &size)
{
  const auto &du = correction;
  correction.swap(change);
  const double before = now.unbalanced;
  double s = 1.0, end;
  for (int cut = 0; cut <= MOST_CUTS; cut++, now.cuts++) {
    each_entry([&](int64_t, int64_t k) {
      trial[k] = u[k] + s * du[k];
    });
    double factor = 0.25;
    if (find_residual(trial, size, &du, &end)) {
      if (slope <= 0.0 || end >= -ENOUGH * slope || (rubs && now.unbalanced <= MAY_GROW * before)) {
        u.swap(trial);
        taken = s;
        return true;
      }
      factor = std::max(0.1, std::min(slope / (slope - end), 0.7));
    }
    s *= factor;
  }
  now.failure =
      "no part of the last correction gives points that are not inside out, or forces that "
      "are smaller";
  return false;
}

/** Finds the blocks of the diagonal of the present tangents. */
void MPMImplicit::find_blocks()
{
  const Clock timed(*this, PRECONDITIONERS);
  if (members.size() == 1) {
    tangent.diagonal(blocks);
  } else {
    blocks.clear();
    for (auto &member : members) {
      member->tangent.diagonal(of_member);
      blocks.insert(blocks.end(), of_member.begin(), of_member.end());
    }
  }
  for (auto &member : members) {
    if (!member->loose) continue;
    const auto &stiffness = member->loose->diagonal();
    for (std::size_t n = 0; n < stiffness.size(); n++)
      for (int d = 0; d < width; d++)
        blocks[width * width * (member->first + n) + (width + 1) * d] += stiffness[n];
  }
  for (double &entry : blocks) entry *= late * part;
  for (int64_t n = 0; n < (int64_t) mass.size(); n++)
    for (int d = 0; d < width; d++)
      blocks[width * width * n + (width + 1) * d] += inertia * mass[n];
  for (auto *contact : contacts) contact->add_friction_blocks(blocks.data());
}

/** Inverts these blocks. */
void MPMImplicit::prepare_blocks()
{
  const Clock timed(*this, PRECONDITIONERS);
  for (int64_t n = 0; n < (int64_t) mass.size(); n++) invert(width, &blocks[width * width * n]);
  by_levels = false;
}

/** Replaces the symmetric matrix S [n][n] of a node by the nearest projection. */
static void round_projection(int n, double *S)
{
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;
  Eigen::Map<Matrix> of(S, n, n);
  if (of.isIdentity(PROJECTED)) {
    of.setIdentity();
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(of);
  Matrix rounded = Matrix::Zero(n, n);
  for (int k = 0; k < n; k++)
    if (axes.eigenvalues()[k] > 0.5)
      rounded += axes.eigenvectors().col(k) * axes.eigenvectors().col(k).transpose();
  of = rounded;
}

/** Builds the levels of the present tangents from the blocks of the diagonal. Unit vectors show what walls
 *  leave free of each node. Where walls hold nodes together, see find_ties(), this is the freedom of all of
 *  these nodes. Pairs of mirror images at faces, and bodies that touch, do not quite fit this scheme: levels
 *  then take the heavier node of a pair as free, and the lighter one as held. */
void MPMImplicit::prepare_levels()
{
  const Clock timed(*this, PRECONDITIONERS);
  by_levels = false;
  std::vector<double> projection, unit(nreals());
  find_blocks();
  field.nodes.complete(blocks.data(), width * width, width * width);
  for (int column = 0; constrained && column < width; column++) {
    projection.resize(nreals() * width);
    for (int64_t k = 0; k < nreals(); k++)
      unit[k] = k % width == column && mass[k / width] > 0.0 ? 1.0 : 0.0;
    project(unit.data());
    for (int64_t k = 0; k < nreals(); k++) projection[width * k + column] = unit[k];
  }
  std::vector<SplineMultigrid::Tie> ties_of_nodes;
  if (constrained) find_ties(ties_of_nodes);
  for (int64_t n = 0; constrained && n < (int64_t) mass.size(); n++)
    round_projection(width, &projection[width * width * n]);
  multigrid->begin(constrained ? projection.data() : nullptr, blocks.data(), ties_of_nodes);
  fill_levels();
}

/** Finds groups of nodes that walls hold together, along lines through surfaces and faces, and the part of P
 *  within each group, from unit vectors of one node of each group at a time. Where lines of several surfaces
 *  chain many nodes together along edges, each node has the part of the nodes near it. */
void MPMImplicit::find_ties(std::vector<SplineMultigrid::Tie> &of_nodes)
{
  const auto index_of = [&](int64_t node) {
    int at[3];
    grid.node_index(node, at);
    LatticeIndex index{0, 0, 0};
    for (int d = 0; d < grid.lattice.dim; d++) index[d] = grid.lattice.wrap(d, at[d]);
    return index;
  };
  std::vector<int64_t> groups[2];
  for (auto *action : field.plan->actions)
    if (const auto *const holds = dynamic_cast<const MPMLineTies *>(action))
      holds->list_ties(field, groups[0], groups[1]);
  std::vector<LatticeIndex> mine[2], all[2];
  for (int kind = 0; kind < 2; kind++) {
    for (std::size_t k = 0; k < groups[kind].size();) {
      const int64_t number = groups[kind][k++];
      // nodes that have a mass
      const std::size_t head = mine[kind].size();
      mine[kind].push_back({0, 0, 0});
      for (int64_t i = 0; i < number; i++, k++)
        if (const int64_t node = groups[kind][k]; node >= 0 && mass[node] > 0.0)
          mine[kind].push_back(index_of(node));
      mine[kind][head][0] = (int) (mine[kind].size() - head) - 1;
    }
    all[kind] = ranks.gather(mine[kind]);
  }

  // clusters of groups that have nodes in common

  LatticeNodes nodes;
  std::vector<int> parent;
  const auto root = [&](int k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  const auto join = [&](const LatticeIndex *list, int number) {
    int first = -1;
    for (int i = 0; i < number; i++) {
      const int at = nodes.add(list[i]);
      if (at == (int) parent.size()) parent.push_back(at);
      if (first >= 0) parent[root(at)] = root(first);
      first = at;
    }
  };
  for (std::size_t k = 0; k < all[0].size(); k += all[0][k][0] + 1)
    if (all[0][k][0] > 1) join(&all[0][k + 1], all[0][k][0]);
  if (nodes.index.empty()) return;
  for (bool more = true; more;) {
    const std::size_t before = nodes.index.size();
    for (std::size_t k = 0; k < all[1].size(); k += all[1][k][0] + 1) {
      const LatticeIndex *const list = &all[1][k + 1];
      if (std::any_of(list, list + all[1][k][0], [&](const LatticeIndex &index) {
            return nodes.find(index) >= 0;
          }))
        join(list, all[1][k][0]);
    }
    more = nodes.index.size() > before;
  }
  std::vector<std::vector<int>> clusters(nodes.index.size());
  for (int k = 0; k < (int) nodes.index.size(); k++) clusters[root(k)].push_back(k);
  std::vector<int> place(nodes.index.size(), -1);
  int most = 0;
  std::map<LatticeIndex, int> colors;
  for (const auto &cluster : clusters)
    for (int k = 0; k < (int) cluster.size(); k++) {
      int &of = place[cluster[k]];
      of = k;
      if ((int) cluster.size() > MOST_TIED) {
        LatticeIndex color{0, 0, 0};
        for (int d = 0; d < 3; d++) color[d] = (nodes.index[cluster[k]][d] % APART + APART) % APART;
        of = colors.emplace(color, (int) colors.size()).first->second;
      }
      most = std::max(most, of + 1);
    }

  // the part of P between the nodes of a cluster

  struct Local {
    int64_t node;
    int number;
  };
  std::vector<Local> local;
  for (int64_t n = 0; n < (int64_t) mass.size(); n++)
    if (mass[n] > 0.0)
      if (const int number = nodes.find(index_of(n)); number >= 0 && place[number] >= 0)
        local.push_back({n, number});
  std::vector<std::vector<SplineMultigrid::Tie>> rows(local.size());
  std::vector<std::vector<int>> of_rows(local.size());
  for (std::size_t i = 0; i < local.size(); i++) {
    const LatticeIndex &at = nodes.index[local[i].number];
    const auto &cluster = clusters[root(local[i].number)];
    const auto add = [&](int other) {
      rows[i].push_back({local[i].node, nodes.index[other], {}});
      of_rows[i].push_back(other);
    };
    if ((int) cluster.size() <= MOST_TIED)
      for (const int other : cluster) add(other);
    for (int k = 0; (int) cluster.size() > MOST_TIED && k < APART * APART * APART; k++) {
      const LatticeIndex index{at[0] + k % APART - APART / 2, at[1] + k / APART % APART - APART / 2,
                               at[2] + k / (APART * APART) - APART / 2};
      const int other = nodes.find(index);
      if (other >= 0 && root(other) == root(local[i].number)) add(other);
    }
  }
  std::vector<double> unit(nreals());
  for (int k = 0; k < most; k++)
    for (int column = 0; column < width; column++) {
      std::fill(unit.begin(), unit.end(), 0.0);
      for (const auto &at : local)
        if (place[at.number] == k) unit[width * at.node + column] = 1.0;
      project(unit.data());
      for (std::size_t i = 0; i < local.size(); i++)
        for (std::size_t j = 0; j < rows[i].size(); j++)
          for (int a = 0; a < width && place[of_rows[i][j]] == k; a++)
            rows[i][j].P[width * a + column] = unit[width * local[i].node + a];
    }
  // most pairs of nodes have no part of P: they would only cost time in levels and in the rim
  for (std::size_t i = 0; i < local.size(); i++) {
    std::vector<SplineMultigrid::Tie> kept;
    bool held = false;
    for (std::size_t k = 0; k < rows[i].size(); k++) {
      const bool own = of_rows[i][k] == local[i].number;
      double change = 0.0;
      for (int ab = 0; ab < width * width; ab++) {
        const double of_unity = own && ab % (width + 1) == 0;
        change = std::max(change, std::fabs(rows[i][k].P[ab] - of_unity));
      }
      held = held || change > PROJECTED;
      if (own || change > PROJECTED) kept.push_back(rows[i][k]);
    }
    if (held) of_nodes.insert(of_nodes.end(), kept.begin(), kept.end());
  }
}

/** Gives the levels that have begun the values of points and masses. */
void MPMImplicit::fill_levels()
{
  const Clock timed(*this, PRECONDITIONERS);
  by_levels = true;
  std::vector<double> scaled;
  const auto add = [&](int n, const int64_t *nodes, int ngrad, const double *gradient,
                       const double *stiffness) {
    if (late * part != 1.0) {
      scaled.assign(stiffness, stiffness + (std::size_t) width * ngrad * width * ngrad);
      for (double &entry : scaled) entry *= late * part;
      stiffness = scaled.data();
    }
    multigrid->add_point(n, nodes, ngrad, gradient, stiffness);
  };
  tangent.each_point(add);
  tangent.each_mean([&](int64_t around, int material, const double sums[3], int n,
                        const int64_t *nodes, const double *changes) {
    const double of_part[] = {late * part * sums[0], sums[1], sums[2]};
    multigrid->add_mean(around, material, of_part, n, nodes, changes);
  });
  if (const auto *const loose = members[0]->loose.get()) loose->each_term(add);
  std::vector<double> stiff = mass;
  for (double &m : stiff) m *= inertia;
  for (auto *contact : contacts) contact->add_friction_stiffness(stiff.data());
  multigrid->finish(*this, inertia > 0.0 || rubs ? stiff.data() : nullptr);
}

/** The same for tangents that are not symmetric. GMRES with restarts can reach a state in which it gains
 *  nothing any more. */
SolveReport MPMImplicit::solve_general(const double *b, double *x, const SolveGoal &goal)
{
  SolveReport solved;
  for (int done = 0; done < goal.most_iterations;) {
    SolveGoal turn = goal;
    turn.most_iterations = std::min(TURN, goal.most_iterations - done);
    solved = general.solve(*this, b, x, turn);
    solved.iterations = done += solved.iterations;
    if (solved.outcome != SolveReport::TOO_MANY) break;
    if (solved.residuals.back() > ENOUGH * solved.residuals[0]) break;
  }
  return solved;
}

/** Finds the correction x from the forces b, without a change of the pressure. Levels take longer to make
 *  than to use: those of the first tangents of a step serve all of its iterations as long as they do well.
 *  Nothing outlives the step, because a run that continues from a restart file must take the same way. */
SolveReport MPMImplicit::solve(const double *b, double *x, const SolveGoal &goal)
{
  const Clock timed(*this, SYSTEMS);
  const auto attempt = [&](int most) {
    auto within = goal;
    within.most_iterations = std::min(most, goal.most_iterations);
    std::fill_n(x, nreals(), 0.0);
    return now.asymmetry <= SYMMETRIC && (!rubs || holds_bounds()) && !(multigrid && averages())
        ? solver.solve(*this, b, x, within)
        : solve_general(b, x, within);
  };
  for (int again = 0; multigrid && again < 2; again++) {
    const bool made = !by_levels;
    if (made) {
      prepare_levels();
      now.made++;
      if (!multigrid->usable()) break;
    }
    const auto solved = attempt(made ? goal.most_iterations : TOO_OLD);
    if (solved.converged()) {
      if (solved.iterations > DO_WELL) by_levels = false;
      return solved;
    }
    now.linear += solved.iterations;
    by_levels = false;
    if (made)
      break;    // new levels of tangents that are not positive definite are of no use, either
  }
  by_levels = false;
  find_blocks();
  prepare_blocks();
  return attempt(goal.most_iterations);
}

MPMImplicit::Outcome MPMImplicit::newton(std::vector<double> &u, int most_iterations)
{
  double size = 0.0, accuracy = options.least_accuracy, last = 0.0, stiffness = 0.0;
  const int before = now.iterations;
  now.residuals.clear();
  // friction begins soft, so that what slips and what sticks
  // changes little at a time, and walls do not tear what they drag
  double softness = 0.0;
  if (std::any_of(contacts.begin(), contacts.end(), [](const MPMTrialContact *contact) {
        return contact->has_friction() && contact->is_regularised();
      })) {
    double most = SOFT * field.lattice.h;
    for (int64_t k = 0; k < nreals(); k++) most = std::max(most, std::fabs(held[k]));
    MPI_Allreduce(&most, &softness, 1, MPI_DOUBLE, MPI_MAX, lmp->world);
    for (auto *contact : contacts) contact->soften(softness);
  }
  if (options.time != MPMImplicitOptions::STATIC) std::fill(held.begin(), held.end(), 0.0);
  bool closes = !contacts.empty() && meet_walls(u, reached_by_walls);
  if (!find_residual(u, size)) {
    now.failure = "points are inside out or have no finite stress at the start of the step";
    return HOPELESS;
  }
  bool wall_moves = closes || (options.time == MPMImplicitOptions::STATIC && wall_speed > 0.0);
  // the residual when walls have moved, and it is known what touches
  double first = wall_moves ? 0.0 : now.unbalanced;
  int slow = 0;    // iterations with next to no gain since bodies have decided
  while (true) {
    bool changed = false;
    now.residuals.push_back(now.unbalanced);
    const double enough =
        std::max({options.tolerance * size, options.absolute * lmp->force->ftm2v,
                  negligible_forces(u, stiffness), joint ? joint->negligible_forces() : 0.0});
    enough_force = enough;
    // with a pressure, the larger one of the residuals of forces and volumes, relative to what may be left
    const double left = joint ? joint->excess() * enough : now.unbalanced;
    if (softness > 0.0 && !wall_moves && now.unbalanced <= std::max(enough, NEARLY * size)) {
      softness *= HARDER;
      if (softness <= slip) softness = 0.0;
      for (auto *contact : contacts) contact->soften(softness);
      find_residual(u, size);
      last = 0.0;
      continue;
    }
    // bodies decide early what touches and what slides, as long as that changes
    const bool converged = left <= enough;
    const bool stalls = tied && last > 0.0 && left > STALLS * last && ++slow > MOST_SLOW;
    const bool may_decide = converged || stalls || (tied && now.unbalanced <= NEARLY * size);
    if (may_decide && !wall_moves)
      changed = decide_contact(u, converged || stalls ? 0.0 : now.ratio);
    if (changed) slow = 0;
    if (converged && !wall_moves && !changed) return CONVERGED;
    if (may_decide && !wall_moves && changed) {
      last = first = 0.0;
      std::fill(held.begin(), held.end(), 0.0);
      closes = wall_moves = meet_walls(u, aim);
      if (!find_residual(u, size)) {
        now.failure = "points are inside out when they touch walls";
        return FAILED;
      }
      continue;
    }
    if (now.iterations - before == most_iterations) {
      now.failure = "it did not converge";
      return FAILED;
    }
    if (!wall_moves && first == 0.0) first = now.unbalanced;
    if (!joint && now.unbalanced > LOST * first && !wall_moves && first > 0.0) {
      now.failure = "it diverges";
      return FAILED;
    }

    // forcing of S.C. Eisenstat, H.F. Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2: quadratic
    // convergence without linear solutions that are more accurate than the tangent is worth

    if (last > 0.0) {
      const double share = left / last, next = 0.9 * share * share,
                   safe = 0.9 * accuracy * accuracy;
      accuracy = std::min(options.least_accuracy, safe > 0.1 ? std::max(next, safe) : next);
    }
    accuracy = std::max(accuracy, MOST_ACCURATE);
    last = left;

    stiffness = linearize(part_of(u));
    // at first, walls bring what they hold to its place, and all the rest goes with it

    if (wall_moves) {
      if (joint)
        joint->move_walls(held, change.data());
      else
        change_of_forces(held.data(), change.data());
      for (int64_t k = 0; k < nreals(); k++)
        free[k] = mass[k / width] > 0.0
            ? residual[k] + change[k] - inertia * mass[k / width] * held[k]
            : 0.0;
      project_forces(free.data());
    }
    SolveGoal goal;
    goal.relative = accuracy;
    if (left > 0.0) goal.relative = std::max(accuracy, 0.1 * enough / left);
    goal.relative = std::min(goal.relative, options.least_accuracy);
    goal.most_iterations = (int) options.most_linear;
    goal.natural = (bool) field.domains;
    const auto solved = joint ? joint->solve(u, goal) : solve(free.data(), change.data(), goal);
    std::vector<double> &du = change;
    now.linear += solved.iterations;
    now.iterations++;
    if (!solved.converged() && solved.outcome != SolveReport::INDEFINITE) {
      now.failure = "the linear system " + solved.describe();
      if (!multigrid && !tied) now.failure += " (use solver multigrid)";
      return now.iterations == before + 1 ? HOPELESS : FAILED;
    }
    // the energy has no minimum along some direction, for example near an unstable state: the solution goes as
    // far as it had one, and at least down the slope (T. Steihaug, SIAM J. Numer. Anal. 20 (1983) 626)

    if (solved.outcome == SolveReport::INDEFINITE) {
      now.indefinite++;
      if (solved.iterations == 0) precondition(free.data(), du.data());
    }

    for (auto *contact : contacts) contact->correct(du.data());
    const double slope = product(du.data(), free.data());
    if (closes) {
      double share;
      if (!close(u, du, size, share)) {
        now.failure = "points are inside out when they come to walls";
        return FAILED;
      }
      closes = wall_moves = share < 1.0;
      for (int64_t k = 0; k < nreals(); k++) held[k] *= 1.0 - share;
    } else if (wall_moves) {
      wall_moves = false;
      for (int64_t k = 0; k < nreals(); k++) u[k] += held[k] + du[k];
      if (joint) joint->move(1.0);
      if (!find_residual(u, size)) {
        now.failure = "points are inside out when walls have moved";
        return FAILED;
      }
    } else if (!(joint ? search_jointly(u, size) : search(u, slope, size))) {
      return FAILED;
    }
  }
}

/* ----------------------------------------------------------------------
   Where Newton's method does not find the end of the step at once, it goes there in parts: for shares s that
   grow to one, it solves r(u) = (1 - s) r0, where r0 is the residual at the start, and walls go a share of
   their way. Changes by loads, gravity, ramps, and walls then come in small portions. The laws see one step
   from its start to u as always, so that parts lead to the same end where they are not needed.
------------------------------------------------------------------------- */

void MPMImplicit::approach(std::vector<double> &u)
{
  const std::vector<double> whole_outer = outer;
  const bool rests = options.time == MPMImplicitOptions::STATIC;
  std::vector<double> from_here = u, first;
  double part = 1.0, size;
  bool in_parts = false;    // the same on ranks without nodes
  if (joint) joint->keep();
  while (true) {
    aim = std::min(1.0, now.reached + part);
    outer = whole_outer;
    if (aim < 1.0)
      for (int64_t k = 0; k < nreals(); k++) outer[k] -= (1.0 - aim) * first[k];
    if (joint && in_parts) joint->set_part(aim);
    reached_by_walls = rests ? now.reached : 1.0;
    for (int64_t k = 0; k < nreals() && rests; k++) held[k] = (aim - now.reached) * dt * wall[k];
    const int most = (int) options.most_iterations;
    const Outcome outcome =
        newton(u, !in_parts ? most : std::min(most, (has_friction ? 3 : 1) * IN_A_PART));
    by_levels = by_levels && outcome == CONVERGED;
    if (outcome == CONVERGED) {
      now.parts++;
      now.reached = aim;
      now.converged = aim == 1.0;
      if (now.converged) return;
      from_here = u;
      if (joint) joint->keep();
      part *= 2.0;
      continue;
    }
    part = 0.5 * (aim - now.reached);
    if (outcome == HOPELESS || part * options.most_parts < 1.0) return;
    u = from_here;
    if (joint) joint->go_back();
    if (!in_parts) {
      in_parts = true;
      outer = whole_outer;
      find_residual(u, size);
      first = residual;
      if (joint) joint->set_first();
    }
  }
}

/* ---------------------------------------------------------------------- */

std::vector<double> MPMImplicit::step(double step_dt)
{
  dt = step_dt;
  now = Report();
  by_levels = false;
  take_nodes();
  contacts.clear();
  rubs = has_friction = false;
  bool all_hold = true;
  slip = options.slip > 0.0 ? options.slip : SLIP * field.lattice.h;
  const double slip_time = dt * options.share_of_end();
  tied = nullptr;
  touching = false;
  for (auto *action : field.plan->actions)
    if (auto *contact = action->trial_contact()) {
      if (auto *const bodies = dynamic_cast<MPMBodyContact *>(contact)) {
        tied = bodies;
        ties = std::make_unique<MPMTies>(lmp);
        bodies->place_bodies([this](const MPMField &of) {
          return first_of(of);
        });
      }
      contact->begin_trials(field, dt, slip_time, slip, options.time == MPMImplicitOptions::STATIC);
      contacts.push_back(contact);
      all_hold = all_hold && action->is_projection();
      has_friction = has_friction || contact->has_friction();
    }
  impacts = !all_hold && options.moves_by_mean();
  rub_share = accelerates_by_friction() ? share_of_contact() : 1.0;
  const bool carries = find_carried();
  find_constraints();
  if (joint) joint->begin_step();
  for (auto &member : members)
    member->tangent.external_forces(outer.data() + width * member->first);
  if (carries) bear_carried();
  if (stabilize > 0.0) begin_loose();
  if (options.time == MPMImplicitOptions::STATIC && now.failure.empty()) find_free_bodies();
  if (!now.failure.empty()) return std::vector<double>(members.size(), 0.0);

  // u*: where inertia alone would bring nodes, and the first guess

  std::vector<double> u(nreals(), 0.0);
  held.assign(nreals(), 0.0);
  inertia = 0.0;
  part = options.part_of_motion();
  late = 1.0;
  if (options.time == MPMImplicitOptions::STATIC) {
    for (int64_t k = 0; k < nreals(); k++) held[k] = dt * wall[k];
  } else {
    // velocities and accelerations by the forces of the start of the step, with those of walls

    start = before;
    if (constrained && all_hold) act(start.data());
    inertia = 1.0 / (part * dt * dt);
    for (int64_t k = 0; k < nreals(); k++) u[k] = from[k] = dt * start[k];
    if (options.time == MPMImplicitOptions::NEWMARK || options.keeps_acceleration()) {
      const auto with = options.coefficients();
      acceleration = explicit_velocity;
      if (constrained && !impacts) act(acceleration.data());
      for (int64_t k = 0; k < nreals(); k++) acceleration[k] = (acceleration[k] - start[k]) / dt;
      if (options.keeps_acceleration() && kept.known) find_accelerations();
      for (int64_t k = 0; k < nreals(); k++)
        from[k] += dt * dt * (0.5 - with.beta / (1.0 - with.of_inertia)) * acceleration[k];
      inertia *= (1.0 - with.of_inertia) / with.beta;
      late = 1.0 - with.of_forces;
      if (late < 1.0) {
        early.resize(nreals());
        for (int64_t k = 0; k < nreals(); k++)
          early[k] = with.of_forces *
              (mass[k / width] * (explicit_velocity[k] - before[k]) / dt - outer[k]);
      }
    }
    if (impacts) begin_impacts();
  }
  if (!can_keep() || !go_on_from_before(u)) approach(u);
  if (!now.converged && options.stabilize_if_stuck && stabilize == 0.0 && contacts.empty()) {
    const Report alone = now;
    stabilize = MPMImplicitOptions::ENOUGH_TO_STABILIZE;
    forget();
    give_back_start();
    const auto energies = step(step_dt);
    now.stuck = true;
    now.iterations += alone.iterations;
    now.linear += alone.linear;
    now.cuts += alone.cuts;
    now.made += alone.made;
    now.indefinite += alone.indefinite;
    return energies;
  }
  if (can_keep()) remember(u);
  if (joint) joint->end_step();
  if (now.converged) find_loads(u);
  if (stabilize > 0.0) account_loose(u);
  return give_back(u);
}

/* ----------------------------------------------------------------------
   Velocities that node actions turn into those of the step, and with which reactions and works are counted as
   always: the part of the residual that is left is no impulse.

   Points move with the value in the place of the new velocity, u/dt. With FLIP, their velocity changes by the
   difference from the value in the place of the old one. In statics both are the same, so that forces work
   with the displacement. The ledger counts the work of forces with the stress at the start of the step and
   the mean of old and new velocity; account() adds the difference.
------------------------------------------------------------------------- */

std::vector<double> MPMImplicit::give_back(const std::vector<double> &u)
{
  const bool newmark = options.time == MPMImplicitOptions::NEWMARK,
             midpoint = options.time == MPMImplicitOptions::MIDPOINT,
             rests = options.time == MPMImplicitOptions::STATIC,
             keeps = options.keeps_acceleration();
  const auto with = options.coefficients();
  std::vector<double> kinetic;
  if (keeps && !impacts) next.assign(nreals(), 0.0);
  push.assign(nreals(), 0.0);
  velocity.resize(nreals());
  if (impacts) end_impacts(u);
  const double of_contact = impacts ? share_of_contact() : 1.0;
  for (auto *contact : contacts) contact->foresee_velocities(velocity.data(), of_contact);
  each_record([&](const Member &member, int64_t n, double *record) {
    if (n == member.first) kinetic.push_back(0.0);
    for (int d = 0; d < width; d++) {
      const int64_t k = width * n + d;
      const double m = mass[n], v = velocity[k] = u[k] / dt;
      record[d] = m > 0.0 ? v + dt * (residual[k] - free[k]) / m : 0.0;
      record[4 + d] = rests ? v : before[k];
      if (impacts && m > 0.0) {
        const double rubbing = rubs ? friction[k] : 0.0,
                     borne = of_contact * (free[k] - residual[k] - rubbing) +
            of_contact / rub_share * rubbing;
        record[d] = v - dt * borne / m + ending[k] - stopped[k];
        record[4 + d] = v - (stopped[k] - before[k]);
      } else if (newmark && m > 0.0) {
        // with the reactions of the start and the end of the step
        const double end = inertia * (u[k] - from[k]), of_end = options.gamma,
                     of_start = 1.0 - of_end,
                     gained = dt * (of_start * acceleration[k] + of_end * end),
                     reaction = acceleration[k] - (explicit_velocity[k] - before[k]) / dt;
        record[d] = v + of_end * (record[d] - v) - of_start * dt * reaction;
        record[4 + d] = v - (start[k] + gained - before[k]);
      }
      if (midpoint && !impacts && m > 0.0) record[4 + d] = v - (2.0 * v - start[k] - before[k]);
      if (keeps && !impacts && m > 0.0) {
        // momentum also changes by accelerations that are not those of the forces of this step
        const double pull = inertia * (u[k] - from[k]),
                     end = next[k] =
                         (pull - with.of_inertia * acceleration[k]) / (1.0 - with.of_inertia);
        record[4 + d] = v -
            (start[k] - before[k] + dt * ((1.0 - with.gamma) * acceleration[k] + with.gamma * end));
      }
      push[k] = m * (record[d] - record[4 + d] - explicit_velocity[k] + before[k]);
      if (m > 0.0 && rests && member.owns(n)) kinetic.back() += 0.5 * m * v * v;
    }
  });
  kinetic.resize(members.size());    // also of fields without nodes
  return kinetic;
}

/* ----------------------------------------------------------------------
   For a while, the reactions of walls are velocities of the size dt f/m, which can be large in statics with
   its time steps of any length. What node actions make of them is v with a rounding error of that size.
   Points therefore get v itself. So does the ledger in statics: it would have that error times the impulses
   of forces, which are proportional to the length of the step.
------------------------------------------------------------------------- */

void MPMImplicit::set_velocities()
{
  each_record([&](const Member &, int64_t n, double *record) {
    for (int d = 0; d < width && mass[n] > 0.0; d++) record[d] = velocity[width * n + d];
  });
}

void MPMImplicit::finish()
{
  if (field.ledger.on) account();
  set_velocities();
  if (options.time == MPMImplicitOptions::MIDPOINT) find_end_of_motion();
  if (options.keeps_acceleration()) keep_accelerations();
}

/** For the ledger: forces of loads that follow points are external forces. */
void MPMImplicit::find_loads(const std::vector<double> &u)
{
  if (!field.ledger.on) return;
  loads.assign(nreals(), 0.0);
  more_loads = loads;
  for (auto &member : members) {
    if (!member->tangent.has_loads()) continue;
    const int64_t first = width * member->first;
    member->tangent.loads(loads.data() + first, more_loads.data() + first);    // without any motion
    std::swap_ranges(loads.begin() + first, loads.begin() + width * member->end(),
                     more_loads.begin() + first);
    member->tangent.loads(part_of(u) + first, more_loads.data() + first);
  }
  for (int64_t k = 0; k < nreals(); k++) more_loads[k] -= loads[k];
}

/** Counts the forces, and their energy, that nodes which points barely reach have after the motion of the
 *  step. Collective. */
void MPMImplicit::account_loose(const std::vector<double> &u)
{
  double mine = 0.0;
  loose_forces.assign(nreals(), 0.0);
  for (auto &member : members) {
    const int64_t first = width * member->first;
    member->loose->add_forces(u.data() + first, loose_forces.data() + first);
    mine += 0.5 * member->loose->twice_energy();
  }
  MPI_Allreduce(&mine, &now.stabilizing, 1, MPI_DOUBLE, MPI_SUM, lmp->world);
}

void MPMImplicit::account()
{
  const bool by_mean = options.moves_by_mean();
  // share of the forces of the end of the step
  const double share = options.time == MPMImplicitOptions::NEWMARK ? options.gamma : late;
  const double unit = lmp->force->mvv2e;
  each_record([&](const Member &member, int64_t n, const double *record) {
    if (!(mass[n] > 0.0) || !member.owns(n)) return;
    double internal = 0.0, external = 0.0, transfer = 0.0;
    for (int d = 0; d < width; d++) {
      const int64_t k = width * n + d;
      const double v = velocity[k], old = record[4 + d];
      const double of_loads = share * dt * more_loads[k] * 0.5 * (v + old);
      external += of_loads;
      internal -= push[k] * 0.5 * (v + old) - of_loads;
      if (member.loose) {    // this is no energy of points
        const double of_loose = dt * loose_forces[k] * 0.5 * (v + old);
        internal += of_loose;
        transfer += of_loose;
      }
      if (!by_mean) continue;
      // points move with v, which is the mean velocity of the step already
      const double half = 0.5 * (v - old),
                   of_forces = dt * (outer[k] + loads[k] + share * more_loads[k]),
                   of_stress = mass[n] * (explicit_velocity[k] - before[k]) - of_forces + push[k];
      external += of_forces * half;
      internal -= of_stress * half;
      transfer -= (of_forces + of_stress) * half;
    }
    auto &ledger = member.field.ledger;
    ledger.internal += internal * unit;
    ledger.external += external * unit;
    ledger.transfer += transfer * unit;
  });
}

double MPMImplicit::memory_usage() const
{
  double bytes = memory.memory_usage() + solver.memory_usage() + general.memory_usage() +
      (multigrid ? multigrid->memory_usage() : 0.0) + (joint ? joint->memory_usage() : 0.0);
  for (const auto *list : {&mass,      &reach,        &friction,    &before,   &explicit_velocity,
                           &outer,     &inner,        &from,        &wall,     &held,
                           &offset,    &slide,        &mean,        &ending,   &stopped,
                           &start,     &acceleration, &push,        &closing,  &velocity,
                           &loads,     &more_loads,   &residual,    &partial,  &of_nodes,
                           &of_points, &early,        &next,        &free,     &change,
                           &trial,     &blocks,       &room,        &allowed,  &correction,
                           &of_owned,  &of_system,    &turns,       &left,     &moved,
                           &solved,    &corrected,    &of_everyone, &rotations})
    bytes += list->capacity() * sizeof(double);
  bytes += loose_forces.capacity() * sizeof(double);
  for (const auto &member : members)
    bytes += member->tangent.memory_usage() + (member->loose ? member->loose->memory_usage() : 0.0);
  bytes += heavy.capacity() * sizeof(int64_t) + heavy_records.capacity() * sizeof(double *) +
      shared.memory_usage();
  return bytes;
}
