/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* The traction at a node is the mean of those of the points nearby, with the weights V_p N_ip. A
   point opens by the mean of the velocities at which the nodes in reach open, with the weights
   A_i N_ip, where A_i is the area of the interface that belongs to the node: what light nodes
   behind the interface do must not count. The damage of a point follows from its own opening.
   Nothing else is transferred, so that bonds do not fade. Where points with whole and broken bonds
   are near, the part that holds has its own opening and damage: else, it would be soft. */

#include "contact/mpm_cohesive_interface.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_doubts.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "fix.h"
#include "math/matrix.h"
#include "math_extra.h"
#include "region.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// share of the other bodies in the volume around a point from which on it is at the interface: the
// first layer of points with one to four of them per cell, at any place in the cell
static constexpr double NEAR = 0.1;
// opening of broken bonds, in node spacings, from which on the volumes of bodies tell more
static constexpr double FAR = 0.1;
// length of the zone that softens, in node spacings, below which a crack is not resolved
static constexpr double COARSE = 2.0;
// weight of points with a broken bond in the opening: where no other ones are near, it is theirs
static constexpr double LEAST = 1.0e-6;
// mean damage of broken bonds, but for round-off
static constexpr double BROKEN = 1.0 - 1.0e-12;

/** The rotation R of F = R U, by Newton's method. */
static void find_rotation(const double *F, double *R)
{
  constexpr int MOST = 20;
  std::copy_n(F, 9, R);
  for (int k = 0; k < MOST; k++) {
    const double cofactors[9] = MPM_COFACTORS(R), inverse = 1.0 / determinant(R);
    double change = 0.0;
    for (int e = 0; e < 9; e++) {
      const double next = 0.5 * (R[e] + inverse * cofactors[e]);
      change = std::max(change, std::fabs(next - R[e]));
      R[e] = next;
    }
    if (change < 1.0e-14) return;
  }
}

void MPMCohesiveInterface::Point::spatial(const double *from, double *to) const
{
  for (int d = 0; d < 3; d++) to[d] = MathExtra::dot3(R + 3 * d, from);
}

void MPMCohesiveInterface::Point::material(const double *from, double *to) const
{
  for (int d = 0; d < 3; d++) to[d] = R[d] * from[0] + R[3 + d] * from[1] + R[6 + d] * from[2];
}

/** Calls f(point, places) for points of a body for which which(point) is true, with all pairs of
 *  the body at the nodes in reach. */
template <class Which, class Use>
void MPMCohesiveInterface::visit(const MPMContacts &contacts, int body, const Which &which,
                                 const Use &f)
{
  const MPMField &field = *bodies[body].field;
  const MPMStencil stencil(field);
  const auto index = contacts.index_of_nodes(bodies, body);
  std::vector<Place> here;
  each_point(field, [&](const MPMPointMap::Run &run, int i) {
    if (!which(i)) return;
    here.clear();
    stencil.visit(field.grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
      const int m = index[node.number];
      if (m < 0 || node.weight == 0.0) return;
      for (int p = contacts.nodes[m].first; p < contacts.nodes[m].last; p++) {
        const auto &pair = contacts.pairs[p];
        if (pair.a == body || pair.b == body)
          here.push_back({p, pair.a == body ? 1.0 : -1.0, node.weight});
      }
    });
    if (!here.empty()) f(i, here);
  });
}

/** Ends of bodies, where nodes are not full, belong to the interface if nodes next to them touch;
 *  others that are as near do not, which is said. */
void MPMCohesiveInterface::join(const MPMContacts &contacts, const std::string &region_id)
{
  Region *const region = region_id.empty() ? nullptr : domain->get_region_by_id(region_id);
  if (region) region->prematch();
  std::vector<double> touching(contacts.pairs.size(), 0.0), next;
  for (std::size_t p = 0; p < contacts.pairs.size(); p++) touching[p] = contacts.pairs[p].touches;
  enum { BONDED, NEARBY, NCOUNTS };    // points that ought to be bonded
  bigint mine[NCOUNTS] = {0, 0}, all[NCOUNTS];
  const auto not_yet = [&](int i) {
    return rows[i][DAMAGE] == NO_BOND;
  };
  enum Round { AT_NODES_THAT_TOUCH, NEXT_TO_THEM, OTHERS };
  for (const Round round : {AT_NODES_THAT_TOUCH, NEXT_TO_THEM, OTHERS}) {
    next.assign(contacts.pairs.size(), 0.0);
    for (int k = 0; k < bodies.size(); k++)
      visit(contacts, k, not_yet, [&](int i, const std::vector<Place> &here) {
        double other = 0.0, both = 0.0;
        bool touches = false;
        for (const auto &at : here) {
          const auto &pair = contacts.pairs[at.pair];
          const double a = bodies[pair.a].fraction_at(pair.ra),
                       b = bodies[pair.b].fraction_at(pair.rb);
          other += at.weight * (pair.a == k ? b : a);
          both += at.weight * (a + b);
          touches = touches || touching[at.pair] > 0.0;
        }
        if (!(other > NEAR * both)) return;
        const double *const x = atom->x[i];
        const bool holds = !region || region->match(x[0], x[1], x[2]);
        if (round == OTHERS) mine[NEARBY] += holds;
        if (round == OTHERS || !touches) return;
        rows[i][DAMAGE] = holds ? 0.0 : 1.0;
        mine[BONDED] += holds;
        for (const auto &at : here) next[at.pair] = 1.0;
      });
    contacts.sum(bodies, 1, next);
    touching.swap(next);
  }
  MPI_Allreduce(mine, all, NCOUNTS, MPI_LMP_BIGINT, MPI_SUM, world);
  const std::string where = region ? " in region " + region_id : "";
  if (all[BONDED] == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/contact {}: law cohesive bonds no points, as bodies fill no node{} between "
               "them: place them side by side, use a smaller share of gap yes if one is less than "
               "four cells wide, or use another law",
               fix.id, where);
  if (all[NEARBY] > 0 && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {}: law cohesive bonds {} points{}, but not {} that are as "
                   "near to another body where nodes are not full: use a smaller share of gap yes "
                   "if they ought to be bonded",
                   fix.id, all[BONDED], where, all[NEARBY]);
  warn_coarse();
}

/** A crack that runs has a zone ahead of its end in which the bond softens, about modulus energy /
 *  strength^2 long. */
void MPMCohesiveInterface::warn_coarse() const
{
  const double h = bodies.spacing(), s = law.cohesion.strength(0.0);
  double modulus = 0.0;
  for (const auto &body : bodies.list)
    for (const auto *of : body.field->materials) {
      if (!of->material->is_solid()) continue;
      const double compression = MPMRestModuli(*of->material).compression;
      modulus = modulus > 0.0 ? std::min(modulus, compression) : compression;
    }
  const double length = modulus * law.cohesion.energy(0.0) / (s * s);
  if (length < COARSE * h && comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/contact {}: the zone at the end of a crack in which bonds soften is {:.3g} "
        "long (modulus energy / strength^2), but the node spacing is {}: a crack needs "
        "more force to run than it should; use a smaller spacing, or less strength",
        fix.id, length, h);
}

double MPMCohesiveInterface::bonded_area(const MPMContacts &contacts) const
{
  double mine = 0.0, all;
  for (const auto &node : contacts.nodes)
    for (int p = node.first; p < node.last && node.owned; p++) {
      const auto &pair = contacts.pairs[p];
      if (pair.bond) mine += pair.area * (1.0 - pair.bond->damage);
    }
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void MPMCohesiveInterface::find(MPMContacts &contacts)
{
  enum { WEIGHT = WIDTH, HOLDING, REACHED, ALL };
  sums.assign(ALL * contacts.pairs.size(), 0.0);
  points.clear();
  places.clear();
  for (int k = 0; k < bodies.size(); k++)
    visit(
        contacts, k,
        [&](int i) {
          return rows[i][DAMAGE] != NO_BOND;
        },
        [&](int i, const std::vector<Place> &here) {
          Point point;
          point.i = i;
          point.first = places.size();
          places.insert(places.end(), here.begin(), here.end());
          point.last = places.size();
          find_rotation(bodies[k].field->points->F[i], point.R);
          points.push_back(point);
          double opening[3];
          point.spatial(rows[i] + OPENING, opening);
          for (const auto &at : here) {
            double *const sum = &sums[ALL * at.pair];
            const double weight = atom->vfrac[i] * at.weight;
            const double damage = rows[i][DAMAGE], holding = weight * (1.0 - damage + LEAST);
            sum[WEIGHT] += weight;
            sum[DAMAGE] += weight * damage;
            sum[HOLDING] += holding;
            sum[REACHED] += holding * damage;
            for (int d = 0; d < 3; d++) sum[OPENING + d] += holding * at.sign * opening[d];
          }
        });
  contacts.sum(bodies, ALL, sums);

  const double far = FAR * bodies.spacing();
  bonds.clear();
  bonds.reserve(contacts.pairs.size());    // pairs point to them
  const auto holds = [&](MPMNodeContact &pair, const double *sum) {
    if (!(sum[WEIGHT] > 0.0)) return pair.touches;
    MPMNodeBond bond;
    bond.damage = std::min(sum[DAMAGE] / sum[WEIGHT], 1.0);
    bond.reached = std::min(sum[REACHED] / sum[HOLDING], bond.damage);
    for (int d = 0; d < 3; d++) bond.opening[d] = sum[OPENING + d] / sum[HOLDING];
    if (bond.damage >= BROKEN && MathExtra::len3(bond.opening) > far) return pair.touches;
    if (!find_area(pair, bond.opening)) return false;
    bonds.push_back(bond);
    pair.bond = &bonds.back();
    return true;
  };
  number.assign(contacts.pairs.size(), -1);
  int p = 0, kept = 0;
  contacts.keep([&](MPMNodeContact &pair) {
    const bool holding = holds(pair, &sums[(std::size_t) ALL * p]);
    if (holding) number[p] = kept++;
    p++;
    return holding;
  });
}

/** Of the interface itself: at its ends, gradients of bodies are also those of their free sides.
 *  These are found by the sum of both gradients, which is not zero where the interface is open,
 *  either: with the gap g, a part g int N^2 dx of the area would be missing, where int N^2 dx is
 *  2/3, 11/20, and 151/315 over h for the B-splines. The share r = (V_a - V_b)/(V_a + V_b) of the
 *  volumes at the node is where this part is; the mean of r^2 over the interface is 1/3. */
bool MPMCohesiveInterface::find_area(MPMNodeContact &pair, const double *opening) const
{
  constexpr double SMALL = 1.0e-10, MISSING[3] = {2.0, 33.0 / 20.0, 151.0 / 105.0};
  const MPMContactBody &a = bodies[pair.a], &b = bodies[pair.b];
  const MPMField &field = *a.field;
  const int64_t node = a.node_of(pair.ra);
  int index[3];
  field.grid.node_index(field.grid.blocks[node / NODES_PER_BLOCK], (int) (node % NODES_PER_BLOCK),
                        index);
  search.interface_at(pair.a, pair.b, index, pair.n);
  pair.area = MathExtra::len3(pair.n);
  if (!(pair.area > SMALL * field.lattice.cell_volume() / field.lattice.h)) return false;
  MathExtra::scale3(1.0 / pair.area, pair.n);
  const double Va = bodies.fraction(a, index), Vb = bodies.fraction(b, index),
               r = (Va - Vb) / (Va + Vb),
               gap = std::max(0.0, MathExtra::dot3(opening, pair.n)) / field.lattice.h;
  pair.area *= 1.0 + MISSING[stencil_order(field.options.shape) - 1] * r * r * gap;
  return true;
}

void MPMCohesiveInterface::open(const MPMContacts &contacts, double dt)
{
  const int dim = bodies.dim();
  for (const auto &point : points) {
    double change[3] = {0.0, 0.0, 0.0}, n[3] = {0.0, 0.0, 0.0}, weights = 0.0;
    for (std::size_t k = point.first; k < point.last; k++) {
      const Place &at = places[k];
      if (number[at.pair] < 0) continue;
      const auto &pair = contacts.pairs[number[at.pair]];
      if (!pair.bond) continue;
      const double weight = at.weight * pair.area;
      weights += weight;
      for (int d = 0; d < dim; d++) {
        n[d] += weight * at.sign * pair.n[d];
        change[d] += weight * at.sign * dt *
            (pair.walls_b.velocity_of(pair.rb, d) - pair.walls_a.velocity_of(pair.ra, d));
      }
    }
    if (!(weights > 0.0 && MathExtra::len3(n) > 0.0)) continue;
    MathExtra::norm3(n);
    double *const row = rows[point.i];
    double opening[3];
    point.spatial(row + OPENING, opening);
    for (int d = 0; d < 3; d++) opening[d] += change[d] / weights;
    point.material(opening, row + OPENING);
    const double along = MathExtra::dot3(opening, n);
    const double shear = std::sqrt(std::max(MathExtra::lensq3(opening) - along * along, 0.0));
    const double damage = law.cohesion.damage(std::hypot(std::max(along, 0.0), shear),
                                              MPMCohesiveLaw::share_of_shear(along, shear));
    row[DAMAGE] = std::max(row[DAMAGE], damage);
  }
}

double MPMCohesiveInterface::memory_usage() const
{
  return bytes_of(bonds, sums, points, places, number);
}
