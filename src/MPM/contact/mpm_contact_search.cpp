/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Normals. The sum over the points of a body at the node, sum_p V_p grad N, points out of it and
   its length is the area of the interface that belongs to the node. The normal of two bodies is the
   difference of their gradients, either as they are (the body with more volume, or mass, at the
   node has more weight) or after each was made a unit vector (colinear).

   Gap. Shape functions reach one or two cells beyond a body, so that bodies would feel each other
   at that distance, and the mass that a wall sends beyond the end of a block that slides on it
   would stand in its way. The volumes of all bodies at a node, over the volume that belongs to a
   node, add up to one where they touch, whatever the position of the interface relative to the
   nodes, and to less while there is a gap or beyond the end of one of them. The part of this volume
   that is outside of fixed faces of the box does not count (MPMInsideFraction).

   Water. For two bodies with water, which do not exchange any, the mean counts. */

#include "contact/mpm_contact_search.h"

#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_halo.h"
#include "field/mpm_node_sums.h"
#include "field/mpm_physics.h"
#include "fix.h"
#include "math/plane_between.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// bodies that are placed next to each other fill the nodes between them up to round-off, which must
// not decide whether they touch; BOX: the same for points as boxes, which do not fill space exactly
// where they are strained

static constexpr double ROUNDING = 1.0e-8, BOX_ROUNDING = 1.0e-3;

// a gradient below this share of that of the other body counts in proportion to its length: at
// nodes inside of a body it is round-off, and has no direction

static constexpr double FLAT = 1.0e-3;

// with pore water, each node between bodies has a part of its force. Bodies then touch at sums of
// fractions down to this far below one; from NEARLY on, a warning counts the force at nodes where
// they do not touch

static constexpr double SLACK = 0.02, NEARLY = 0.8;

int MPMContacts::Node::count_bodies(int n) const
{
  return (int) (n - std::count(record, record + n, (double *) nullptr));
}

void MPMContacts::clear()
{
  nodes.clear();
  pairs.clear();
}

void MPMContacts::keep(const std::function<bool(MPMNodeContact &)> &keep)
{
  std::size_t npairs = 0, nnodes = 0;
  for (Node node : nodes) {
    const int first = (int) npairs;
    for (int p = node.first; p < node.last; p++)
      if (keep(pairs[p])) pairs[npairs++] = pairs[p];
    if ((int) npairs == first) continue;
    node.first = first;
    node.last = (int) npairs;
    nodes[nnodes++] = node;
  }
  pairs.resize(npairs);
  nodes.resize(nnodes);
}

std::vector<int> MPMContacts::index_of_nodes(MPMContactBodies &bodies, int k) const
{
  const Grid &grid = bodies[k].field->grid;
  std::vector<int> index(grid.nnodes(), -1);
  for (std::size_t m = 0; m < nodes.size(); m++)
    if (nodes[m].record[k]) index[bodies[k].node_of(nodes[m].record[k])] = (int) m;
  for (const int slot : bodies[k].images)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(grid.blocks[slot].alias >> n & 1)) continue;
      int at[3];
      grid.node_index(grid.blocks[slot], n, at);
      for (int d = 0; d < grid.lattice.dim; d++) at[d] = grid.lattice.wrap(d, at[d]);
      const int64_t canonical = grid.locate(at);
      if (canonical >= 0) index[(int64_t) slot * NODES_PER_BLOCK + n] = index[canonical];
    }
  return index;
}

/** By pairs of bodies, on the nodes of the first of them. */
void MPMContacts::sum(MPMContactBodies &bodies, int width, std::vector<double> &rows) const
{
  const MPI_Comm world = bodies[0].field->lmp->world;
  const int nbodies = bodies.size();
  int nprocs;
  MPI_Comm_size(world, &nprocs);
  if (nprocs == 1) return;
  std::vector<char> meet(nbodies * nbodies, 0);    // pairs of bodies, on any rank
  for (const auto &pair : pairs) meet[pair.a * nbodies + pair.b] = 1;
  MPI_Allreduce(MPI_IN_PLACE, meet.data(), nbodies * nbodies, MPI_CHAR, MPI_MAX, world);
  std::vector<double> shared;
  for (int a = 0; a < nbodies; a++)
    for (int b = a + 1; b < nbodies; b++) {
      if (!meet[a * nbodies + b]) continue;
      shared.assign(bodies[a].field->grid.nnodes() * width, 0.0);
      for (const bool summed : {false, true}) {
        if (summed) bodies[a].field->nodes.halo->sum(shared.data(), width, 0, width);
        for (std::size_t p = 0; p < pairs.size(); p++) {
          if (pairs[p].a != a || pairs[p].b != b) continue;
          double *const mine = &rows[p * width],
                        *const node = &shared[bodies[a].node_of(pairs[p].ra) * width];
          std::copy_n(summed ? node : mine, width, summed ? mine : node);
        }
      }
    }
}

void MPMContactSearch::begin_run()
{
  is_first_step = true;
  warned_of_water = false;
  std::fill_n(water_sums, 2, 0.0);
}

bool MPMContactSearch::begin_step()
{
  const bool may_touch = bodies.find_shared(), is_first = is_first_step;
  is_first_step = false;
  if (is_first) checks.warn_thin();
  if (!may_touch || !bodies.map(options.gap || is_first || bodies.all_near)) return false;
  if (is_first) checks.warn_overlap();
  return true;
}

/** Nodes where two bodies have mass and make(block, n, pair) finds contact. */
template <class Make> void MPMContactSearch::visit_nodes(MPMContacts &contacts, const Make &make)
{
  const int nbodies = bodies.size();
  contacts.clear();
  for (const auto &block : bodies.shared)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(block.canonical >> n & 1)) continue;
      MPMContacts::Node node;
      if (bodies.records(block, n, node.record) < 2) continue;
      node.first = (int) contacts.pairs.size();
      node.owned = block.owned >> n & 1;
      MPMNodeContact pair;
      for (pair.a = 0; pair.a < nbodies; pair.a++)
        for (pair.b = pair.a + 1; pair.b < nbodies; pair.b++) {
          pair.ra = node.record[pair.a];
          pair.rb = node.record[pair.b];
          if (!pair.ra || !pair.rb) continue;
          pair.adhesion = pair.water = 0.0;
          pair.state = MPMNodeContact::OPEN;
          if (!make(block, n, pair)) continue;
          pair.water /= node.count_bodies(nbodies) - 1;    // neighbors share the water of a body
          contacts.pairs.push_back(pair);
        }
      node.last = (int) contacts.pairs.size();
      if (node.last > node.first) contacts.nodes.push_back(node);
    }
}

void MPMContactSearch::find(double dt, MPMContacts &contacts)
{
  visit_nodes(contacts, [&](const MPMSharedBlock &block, int n, MPMNodeContact &pair) {
    return find_normal(block, n, pair) && is_in_contact(block, n, dt, pair);
  });
  if (options.normal_by == MPMContactSearchOptions::LOGISTIC) separate_points(contacts);
}

/** Finds normal and area of the interface. Returns false if the gradients cancel. */
bool MPMContactSearch::find_normal(const MPMSharedBlock &block, int n, MPMNodeContact &pair) const
{
  const int a = block.slot[pair.a], b = block.slot[pair.b];
  const bool colinear = options.normal_by == MPMContactSearchOptions::COLINEAR;
  double ga[3], gb[3];
  bodies.gradient_with_mirrors(bodies[pair.a], a, n, ga);
  bodies.gradient_with_mirrors(bodies[pair.b], b, n, gb);
  const double la = MathExtra::len3(ga), lb = MathExtra::len3(gb);
  if (la == 0.0 && lb == 0.0) return false;
  const double least = FLAT * std::max(la, lb);
  const double wa = colinear ? 1.0 / std::max(la, least) : 1.0;
  const double wb = colinear ? 1.0 / std::max(lb, least) : 1.0;
  for (int d = 0; d < 3; d++) pair.n[d] = d < bodies.dim() ? wa * ga[d] - wb * gb[d] : 0.0;
  const double length = MathExtra::len3(pair.n);
  if (!(length > 1.0e-10 * (wa * la + wb * lb))) return false;
  for (double &x : pair.n) x /= length;

  // gradients of the bodies at this node itself; its mirror nodes have their own
  const auto own = [&](int body, const double *record) {
    return std::fabs(MathExtra::dot3(bodies[body].gradient_at(record), pair.n));
  };
  pair.area = 0.5 * (own(pair.a, pair.ra) + own(pair.b, pair.rb));
  return true;
}

/** Are the bodies near enough to touch at node n of a block? Also finds adhesion and water. */
bool MPMContactSearch::is_in_contact(const MPMSharedBlock &block, int n, double dt,
                                     MPMNodeContact &pair)
{
  const double filled = options.gap ? bodies.filled(block, n) : options.full;
  if (law.law == MPMContactLaw::ADHESIVE && pair.area > 0.0) {
    const MPMField &field = *bodies[pair.a].field;
    const double cell =
        field.lattice.cell_volume() * field.frame->node_circle(block.slot[pair.a], n);
    pair.adhesion = law.adhesion_at(std::max(0.0, options.full - filled) * cell / pair.area);
  }
  const bool wet = !bodies[pair.a].water.empty() || !bodies[pair.b].water.empty();
  const double slack = wet ? SLACK : bodies.on_several_lattices ? BOX_ROUNDING : ROUNDING;
  const bool touches = !options.gap || filled >= options.full * (1.0 - slack) ||
      pair.adhesion > 0.0;
  if (wet) {
    pair.water = dt * water_between(pair);
    if ((touches || filled > NEARLY * options.full) && (block.owned >> n & 1))
      water_sums[touches ? 0 : 1] += std::fabs(pair.water);
  }
  pair.touches = touches;
  return touches || law.law == MPMContactLaw::COHESIVE;
}

/** Force along the normal that water takes, positive if it pushes. */
double MPMContactSearch::water_between(const MPMNodeContact &pair) const
{
  double sum = 0.0;
  int wet = 0;
  for (const int k : {pair.a, pair.b}) {
    const MPMContactBody &body = bodies[k];
    if (body.water.empty()) continue;
    const int64_t node = body.node_of(k == pair.a ? pair.ra : pair.rb);
    const double along = MathExtra::dot3(&body.water[3 * node], pair.n);
    sum += k == pair.a ? along : -along;
    wet++;
  }
  return wet ? sum / wet : 0.0;
}

void MPMContactSearch::report_missed_water()
{
  constexpr double MOST = 0.05;
  if (warned_of_water ||
      std::all_of(bodies.list.begin(), bodies.list.end(), [](const MPMContactBody &body) {
        return !pore_pressure(*body.field);
      }))
    return;
  double all[2];
  MPI_Allreduce(water_sums, all, 2, MPI_DOUBLE, MPI_SUM, world);
  std::fill_n(water_sums, 2, 0.0);
  if (!(all[0] > 0.0 && all[1] > MOST * all[0])) return;
  warned_of_water = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {}: {:.2g} of the force of pore water between bodies is at "
                   "nodes that these fill nearly, but where they are not in contact, so that it "
                   "counts as one of grains: use gap yes with a smaller share; this is said only "
                   "once",
                   fix.id, all[1] / (all[0] + all[1]));
}

/** The integrals of the gradients of a function over two bodies are g_a = A + L_a and g_b = -A +
 *  L_b. A is the integral of the function over the interface, as area and normal, and L_a and L_b
 *  are those over the free sides. Inside an interface, and where the side of one body continues
 *  that of the other, also at walls, L_a and L_b are in proportion to the volumes V that the bodies
 *  have at the node. (With images, as in explicit steps, an inclined interface would not be in
 *  balance next to a wall, where nodes and images move along it independently.) L_a + L_b is g_a +
 *  g_b, so that
 *
 *     A = [g_a - g_b - (g_a + g_b) (V_a - V_b)/(V_a + V_b)]/2 */
void MPMContactSearch::interface_at(int a, int b, const int *index, double *area) const
{
  const MPMContactBody &first = bodies[a], &second = bodies[b];
  MathExtra::zero3(area);
  const int64_t na = first.node_at(index), nb = second.node_at(index);
  if (na < 0 || nb < 0) return;
  const double Va = bodies.fraction(first, index), Vb = bodies.fraction(second, index);
  if (!(Va + Vb > 0.0)) return;
  const double r = (Va - Vb) / (Va + Vb);
  const double *const ga = &first.gradient[3 * na], *const gb = &second.gradient[3 * nb];
  for (int d = 0; d < bodies.dim(); d++) area[d] = 0.5 * (ga[d] - gb[d] - r * (ga[d] + gb[d]));
}

void MPMContactSearch::find_interfaces(MPMContacts &contacts)
{
  constexpr double SMALL = 1.0e-10;
  const Lattice &lattice = bodies[0].field->lattice;
  visit_nodes(contacts, [&](const MPMSharedBlock &block, int n, MPMNodeContact &pair) {
    const Grid &grid = bodies[pair.a].field->grid;
    int index[3];
    grid.node_index(grid.blocks[block.slot[pair.a]], n, index);
    interface_at(pair.a, pair.b, index, pair.n);
    pair.area = MathExtra::len3(pair.n);
    if (!(pair.area > SMALL * lattice.cell_volume() / lattice.h)) return false;
    MathExtra::scale3(1.0 / pair.area, pair.n);
    return true;
  });
}

/** Normals by logistic regression, with the weights of the shape functions. */
void MPMContactSearch::separate_points(MPMContacts &contacts) const
{
  constexpr int NREAL = PlaneBetween::NREAL;
  const int dim = bodies.dim(), nfields = bodies.size();
  const auto &nodes = contacts.nodes;
  auto &pairs = contacts.pairs;

  std::vector<std::vector<int>> wanted(nfields);
  for (int k = 0; k < nfields; k++) wanted[k] = contacts.index_of_nodes(bodies, k);

  std::vector<PlaneBetween> planes(pairs.size());
  std::vector<double> sums(pairs.size() * NREAL);
  for (int round = 0; round < PlaneBetween::ROUNDS; round++) {
    sums.assign(sums.size(), 0.0);
    for (int k = 0; k < nfields; k++)
      visit_points(*bodies[k].field, wanted[k],
                   [&](int, int which, double weight, const double *r) {
                     const MPMContacts::Node &node = nodes[which];
                     for (int p = node.first; p < node.last; p++) {
                       const MPMNodeContact &pair = pairs[p];
                       if (pair.a != k && pair.b != k) continue;
                       planes[p].add(weight, r, pair.b == k, &sums[(std::size_t) p * NREAL]);
                     }
                   });

    contacts.sum(bodies, NREAL, sums);
    for (std::size_t p = 0; p < pairs.size(); p++) planes[p].advance(&sums[p * NREAL], dim);
  }

  for (std::size_t p = 0; p < pairs.size(); p++) {
    const double *const phi = planes[p].phi;
    double n[3] = {phi[0], phi[1], dim == 3 ? phi[2] : 0.0};
    const double length = MathExtra::len3(n);
    // points that lie on a line do not say more than the gradient
    if (!(length > 0.0) || MathExtra::dot3(n, pairs[p].n) < 0.5 * length) continue;
    for (int d = 0; d < 3; d++) pairs[p].n[d] = n[d] / length;
  }
}
