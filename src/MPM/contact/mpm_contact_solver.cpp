/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Momentum is conserved to round-off as impulses come in pairs. With more than two bodies at a node
   all pairs are treated alike: projected Jacobi iterations on the impulses of all pairs, so that
   the order in which the bodies are named has no influence.

   Where walls mirror one body and not the other, contact at a node changes the velocity of this
   body at the mirror nodes of the node, too: these nodes are solved together. If they were solved
   one after the other, they would leave an approach in each step: water went into the clamped end
   of a plate. */

#include "contact/mpm_contact_solver.h"

#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int MAX_ITERATIONS = 200;      // of impulses of pairs that depend on each other
static constexpr double CONVERGED = 1.0e-12;    // change of the impulses, relative to them
static constexpr double UNSOLVED = 1.0e-6;      // the same at the end: too much to be silent

void MPMContactSolver::solve(MPMContacts &of, double step, bool are_decided, const Count &count)
{
  contacts = &of;
  dt = step;
  decided = are_decided;
  coupled.clear();
  for (auto &node : of.nodes) {
    Problem problem;    // velocities of bodies that are not here stay unset
    problem.node = &node;
    problem.group = 0;
    if (begin(node, problem.start)) {
      coupled.push_back(problem);
      continue;
    }
    if (node.count_bodies(bodies.size()) == 2)    // needs one iteration
      iterate(problem);
    else
      solve_group(&problem, &problem + 1, false);
    if (!decided) count(node, problem.start);
  }
  find_groups();
  const Problem *const end = coupled.data() + coupled.size();
  for (const Problem *first = coupled.data(), *last; first < end; first = last) {
    for (last = first + 1; last < end && last->group == first->group;) last++;
    solve_group(first, last, true);
  }
  if (!decided)
    for (const auto &problem : coupled) count(*problem.node, problem.start);
}

/** Sets the velocities of the bodies at a node before contact, and the action of walls on them.
 *  Returns whether walls move one body with its mirror nodes and another not. */
bool MPMContactSolver::begin(const MPMContacts::Node &node, Velocities &start)
{
  const int nfields = bodies.size();
  for (int k = 0; k < nfields; k++)
    if (node.record[k]) std::copy_n(node.record[k], 3, start[k].begin());
  bool mirrors = false;
  for (int p = node.first; p < node.last; p++) {
    MPMNodeContact &pair = contacts->pairs[p];
    pair.begin(bodies[pair.a].walls_at(pair.ra), bodies[pair.b].walls_at(pair.rb));
    mirrors = mirrors ||
        (!pair.alike &&
         (pair.walls_a.moves_with_mirrors(pair.ra) || pair.walls_b.moves_with_mirrors(pair.rb)));
  }
  return mirrors;
}

/** Sets the velocities of the bodies at a node by the impulses of its pairs; walls will move its
 *  mirror nodes with it. */
void MPMContactSolver::set_velocities(const Problem &problem)
{
  const MPMContacts::Node &node = *problem.node;
  const int nfields = bodies.size(), dim = bodies.dim();
  Velocities before;
  for (int k = 0; k < nfields; k++)
    for (int d = 0; d < dim && node.record[k]; d++) {
      before[k][d] = node.record[k][d];
      node.record[k][d] = problem.start[k][d];
    }
  for (int p = node.first; p < node.last; p++) contacts->pairs[p].push(dim);
  for (int k = 0; k < nfields; k++)
    if (node.record[k]) bodies[k].move_mirrors(node.record[k], before[k]);
}

/** An iteration at a node. Impulses of all pairs follow from the same velocities, so that their
 *  order does not matter. Returns the change of the impulses. */
double MPMContactSolver::iterate(const Problem &problem)
{
  const MPMContacts::Node &node = *problem.node;
  const int neighbors = node.count_bodies(bodies.size()) - 1;
  double largest = 0.0;
  for (int p = node.first; p < node.last; p++)
    largest =
        std::max(largest, contacts->pairs[p].iterate(law, bodies.dim(), neighbors, dt, decided));
  set_velocities(problem);
  return largest;
}

/** Gauss-Seidel iterations for nodes that depend on each other; mirrored: by walls that move a body
 *  with its mirror nodes. Where masses differ much, these converge slowly, and are accelerated. */
void MPMContactSolver::solve_group(const Problem *first, const Problem *last, bool mirrored)
{
  std::vector<double> &x = impulses;
  auto &pairs = contacts->pairs;
  const auto each = [&](auto f) {
    for (const Problem *m = first; m < last; m++)
      for (int p = m->node->first; p < m->node->last; p++) f(pairs[p]);
  };
  x.clear();
  states.clear();
  each([&](const MPMNodeContact &pair) {
    x.insert(x.end(), 4, 0.0);
    states.push_back(pair.state);
  });
  series.begin(x);
  double largest = 0.0;
  for (int it = 1; it <= MAX_ITERATIONS; it++) {
    largest = 0.0;
    for (const Problem *m = first; m < last; m++) {
      for (int p = m->node->first; p < m->node->last && mirrored; p++) {
        pairs[p].walls_a = bodies[pairs[p].a].walls_at(pairs[p].ra);
        pairs[p].walls_b = bodies[pairs[p].b].walls_at(pairs[p].rb);
      }
      largest = std::max(largest, iterate(*m));
    }
    if (largest < CONVERGED) break;
    // extrapolated impulses may pull, or exceed friction: another iteration must follow
    if (it == MAX_ITERATIONS) break;

    bool same = true;
    double *to = x.data();
    char *state = states.data();
    each([&](const MPMNodeContact &pair) {
      same = same && *state == pair.state;
      *state++ = pair.state;
      *to++ = pair.normal;
      to = std::copy_n(pair.tangential, 3, to);
    });
    if (!series.advance(x, largest, same)) continue;
    const double *from = x.data();
    each([&](MPMNodeContact &pair) {
      pair.normal = *from++;
      std::copy_n(from, 3, pair.tangential);
      from += 3;
    });
    for (const Problem *m = first; m < last; m++) set_velocities(*m);
  }
  if (largest > UNSOLVED) note_unsolved(first, last);
}

/** Groups nodes that depend on each other, because walls move a body at them together. */
void MPMContactSolver::find_groups()
{
  const int n = (int) coupled.size(), nfields = bodies.size();
  if (n < 2) return;
  dependent.begin(n);
  for (int k = 0; k < nfields; k++) {
    const MPMContactBody &body = bodies[k];
    const Grid &grid = body.field->grid;
    std::vector<int> &first = first_with_mirror;
    first.assign(body.predicted.mirrors.size(), -1);
    for (int m = 0; m < n; m++) {
      const double *const record = coupled[m].node->record[k];
      for (int d = 0; d < grid.lattice.dim && record; d++) {
        const int64_t node = body.node_of(record);
        const int place = std::abs(body.predicted.mirrored[3 * node + d]) - 1;
        if (place < 0) continue;
        if (first[place] < 0) first[place] = m;
        dependent.join(m, first[place]);
      }
    }
  }
  for (int m = 0; m < n; m++) coupled[m].group = dependent.root(m);
  std::stable_sort(coupled.begin(), coupled.end(), [](const Problem &a, const Problem &b) {
    return a.group < b.group;
  });
}

/** Each rank notes those nodes that it owns. */
void MPMContactSolver::note_unsolved(const Problem *first, const Problem *last)
{
  const auto now = (double) update->ntimestep;
  for (const Problem *m = first; m < last && !unsolved.knows(now); m++) {
    if (!m->node->owned) continue;
    const MPMNodeContact &pair = contacts->pairs[m->node->first];
    const MPMContactBody &body = bodies[pair.a];
    double x[3];
    body.field->grid.node_position(body.node_of(pair.ra), x);
    unsolved.take({now, x[0], x[1], x[2]});
  }
}

void MPMContactSolver::report_unsolved(const char *id)
{
  std::array<double, 4> first;
  if (unsolved.report(world, first) && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {}: {} iterations were not enough to find what bodies give to "
                   "each other at the node at {:.6g} {:.6g} {:.6g} in step {:.0f}: they approach "
                   "each other, or slide, a little there. This happens where three or more bodies "
                   "meet at a node, or masses differ much: use a smaller node spacing, so that "
                   "fewer of them meet, or densities that differ less; this is said only once",
                   id, MAX_ITERATIONS, first[1], first[2], first[3], first[0]);
}
