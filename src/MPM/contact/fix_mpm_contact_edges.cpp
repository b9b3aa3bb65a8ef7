/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Interfaces of bodies at nodes, and at their edges, for steps of a solver (fix_mpm_contact_trial.cpp).
//
// The integrals of the gradients of a function over two bodies are g_a = A + L_a and g_b = -A + L_b. A is the integral of the function
// over the interface, as area and normal, and L_a and L_b are those over the free sides. Inside an interface, and where the side of one
// body continues that of the other, also at walls, L_a and L_b are in proportion to the volumes V that the bodies have at the node. (With
// images, as in explicit steps, an inclined interface would not be in balance next to a wall, where nodes and images move along it
// independently.) L_a + L_b is g_a + g_b, so that
//
//    A = [g_a - g_b - (g_a + g_b) (V_a - V_b)/(V_a + V_b)]/2                                                     (1)
//
// At the edge of a body on a wider one, the free side of the wider one continues the interface, and that of the other one is at an
// angle to it: with (1), normals would be inclined there, most of all at nodes beyond the edge. The wider body covers more of the
// cross-section of a line of nodes through the interface. Its direction n along the line is taken instead, with A = (g.n) n and g of
// the other body. Where the edges of two bodies cross, each covers another part of the cross-section, and n is that of the lines
// around, with most weight for lines that both bodies cover.

#include "contact/fix_mpm_contact.h"

#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double STEEPER = 1.0e-6;    // relative difference that decides alike on all ranks
static constexpr double OWN = 3.0;           // weight of a node relative to those around
static constexpr double WIDER = 0.02;        // difference of shares from which on a body is wider
static constexpr double LIGHT = 0.1;        // largest share of a line that joins the one next to it
static constexpr double DIAGONAL = 0.25;    // weight of a line diagonally next to this one
// free sides, relative to the cross-section of a line. CROSSING: of both bodies where they cross (interfaces of lattices of points
// have up to about a tenth, against each other); SIDE: of the wider body, from which on lines follow others
static constexpr double CROSSING = 0.15, SIDE = 0.1;

/** Finds A of (1) at the node with this index, if both bodies have it; otherwise zero. */
void FixMPMContact::interface_at(int a, int b, const int *index, double *area) const
{
  const Body &first = bodies[a], &second = bodies[b];
  MathExtra::zero3(area);
  const int64_t na = node_at(first, index), nb = node_at(second, index);
  if (na < 0 || nb < 0) return;
  const double Va = share_of(first, index), Vb = share_of(second, index);
  if (!(Va + Vb > 0.0)) return;
  const double r = (Va - Vb) / (Va + Vb);
  const double *const ga = &first.gradient[3 * na], *const gb = &second.gradient[3 * nb];
  for (int d = 0; d < first.field->lattice.dim; d++)
    area[d] = 0.5 * (ga[d] - gb[d] - r * (ga[d] + gb[d]));
}

/** Finds the axis of the line of a pair, the sign of its normal along it, and the index of its node. The nodes around are included,
 *  as nodes beyond edges have hardly any interface. */
int FixMPMContact::axis_at(const Pair &pair, int *index, double &sign) const
{
  MPMField &field = *bodies[pair.a].field;
  const int dim = field.lattice.dim;
  field.grid.node_index((pair.ra - field.grid.nodes()) / field.grid.nreal, index);
  double n[3] = {0.0, 0.0, 0.0};
  const int across = dim == 3 ? 1 : 0;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++)
      for (int k = -across; k <= across; k++) {
        const int at[3] = {index[0] + i, index[1] + j, index[2] + k};
        double there[3];
        interface_at(pair.a, pair.b, at, there);
        const double weight = i || j || k ? 1.0 : OWN;
        for (int d = 0; d < dim; d++) n[d] += weight * there[d];
      }
  int axis = 0;
  for (int d = 1; d < dim; d++)
    if (std::fabs(n[d]) > std::fabs(n[axis]) * (1.0 + STEEPER)) axis = d;
  sign = n[axis] > 0.0 ? 1.0 : -1.0;
  return axis;
}

/** Finds lines of nodes that are next to each other along their axis. */
void FixMPMContact::find_lines(std::vector<Line> &lines)
{
  std::map<std::array<int, 6>, std::vector<std::pair<int, int>>> all;
  const Lattice &lattice = bodies[0].field->lattice;
  for (std::size_t p = 0; p < pairs.size(); p++) {
    Pair &pair = pairs[p];
    if (is_beyond_walls(pair)) continue;
    int index[3];
    double sign;
    const int axis = axis_at(pair, index, sign), at = index[axis];
    index[axis] = 0;
    all[{pair.a, pair.b, 2 * axis + (sign > 0.0), index[0], index[1], index[2]}].emplace_back(
        at, (int) p);
  }
  for (auto &[key, places] : all) {
    const int axis = key[2] / 2;
    std::sort(places.begin(), places.end());
    const std::size_t n = places.size();
    const auto joined = [&](std::size_t k) {    // is this node next to the one before?
      const int before = places[(k + n - 1) % n].first, now = places[k % n].first;
      if (k % n) return now == before + 1;
      return n > 1 && lattice.periodic[axis] && now == 0 && before == lattice.ncell[axis] - 1;
    };
    std::size_t begin = 0;
    while (begin < n && joined(begin)) begin++;
    if (begin == n) begin = 0;    // the line goes all around a periodic box
    for (std::size_t first = begin, last; first < begin + n; first = last) {
      Line line = {};
      line.key = key;
      line.axis = axis;
      std::copy_n(&key[3], 3, line.index);
      line.sign = key[2] % 2 ? 1.0 : -1.0;
      for (last = first; last == first || (last < begin + n && joined(last)); last++)
        line.places.push_back(places[last % n]);
      lines.push_back(line);
    }
  }
}

/** Share and gradient of a body along a line, of the nodes where its gradient has this sign. */
FixMPMContact::Covers FixMPMContact::look_along(const Body &body, const Line &line,
                                                double sign) const
{
  const Lattice &lattice = body.field->lattice;
  const double cross = lattice.cell_volume() / lattice.h;
  Covers seen = {};
  int at[3] = {line.index[0], line.index[1], line.index[2]};
  for (int i = line.low() - AROUND; i <= line.high() + AROUND; i++) {
    at[line.axis] = i;
    const int64_t node = node_at(body, at);
    if (node < 0) continue;
    seen.share = std::max(seen.share, share_of(body, at));
    const int slot = (int) (node / NODES_PER_BLOCK), n = (int) (node % NODES_PER_BLOCK);
    const double circle = body.field->frame->node_circle(slot, n);
    double g[3];
    gradient_at(body, slot, n, g);
    // skip the other surface of a thin body
    if (!(circle > 0.0 && sign * g[line.axis] > 0.0)) continue;
    for (int d = 0; d < lattice.dim; d++) {
      seen.g[d] += g[d] / (cross * circle);
      seen.alone[d] += body.gradient[3 * node + d] / (cross * circle);
    }
  }
  seen.share = std::min(std::max(seen.share, std::fabs(seen.g[line.axis])), 1.0);
  return seen;
}

/** Finds the direction of a line, by its interface or by that of the wider body. Returns the weight of the latter, from 0 to 1. */
double FixMPMContact::turn_to_wider(Line &line) const
{
  double n[3] = {0.0, 0.0, 0.0}, wide[3];
  for (const auto &place : line.places)
    for (int d = 0; d < 3; d++) n[d] += pairs[place.second].area * pairs[place.second].n[d];
  const double wider = line.seen[0].share - line.seen[1].share,
               turned = std::min(std::fabs(wider) / WIDER, 1.0);
  MathExtra::copy3(line.seen[wider > 0.0 ? 0 : 1].g, wide);
  const double length = MathExtra::len3(n), of_wide = MathExtra::len3(wide);
  MathExtra::zero3(line.n);    // the two sides of a thin body may cancel
  if (length > 0.0) MathExtra::scale3(1.0 / length, n, line.n);
  if (of_wide == 0.0) return 0.0;
  MathExtra::scale3((wider > 0.0 ? 1.0 : -1.0) / of_wide, wide);
  for (int d = 0; d < 3; d++) line.n[d] += turned * (wide[d] - line.n[d]);
  const double size = MathExtra::len3(line.n);
  if (size > 0.0) MathExtra::scale3(1.0 / size, line.n);
  return turned;
}

/** Calls use(k) for a line and its neighbors. */
void FixMPMContact::for_lines_around(const std::vector<Line> &lines, const LinesByKey &by_key,
                                     const Line &line, const std::function<void(int k)> &use) const
{
  const Lattice &lattice = bodies[0].field->lattice;
  const int first = line.axis == 0 ? 1 : 0, second = line.axis == 2 ? 1 : 2,
            across = lattice.dim == 3 ? 1 : 0;
  for (int i = -1; i <= 1; i++)
    for (int j = -across; j <= across; j++) {
      auto key = line.key;
      key[3 + first] = lattice.wrap(first, key[3 + first] + i);
      key[3 + second] = lattice.wrap(second, key[3 + second] + j);
      const auto found = by_key.find(key);
      if (found == by_key.end()) continue;
      for (const int k : found->second)
        if (lines[k].low() <= line.high() + 1 && lines[k].high() >= line.low() - 1) use(k);
    }
}

/** Weight, from 0 to 1, with which a line takes the direction of the lines around it: where sides of both bodies cross, and where the
 *  wider body, whose direction has the weight turned, has a side, too. */
double FixMPMContact::follows_others(const Line &line, double turned, const double *around) const
{
  double side[2][3], length[2];
  for (int k = 0; k < 2; k++) {
    const double along = MathExtra::dot3(line.seen[k].alone, around);
    for (int d = 0; d < 3; d++) side[k][d] = line.seen[k].alone[d] - along * around[d];
    length[k] = MathExtra::len3(side[k]);
  }
  const int wider = line.seen[0].share > line.seen[1].share ? 0 : 1;
  const double by_wider = turned * std::min(length[wider] / SIDE, 1.0);
  const double shorter = std::min(length[0], length[1]);
  if (shorter <= CROSSING) return by_wider;
  double sine[3];
  MathExtra::cross3(side[0], side[1], sine);
  const double crosses = std::min(shorter / CROSSING - 1.0, 1.0) * MathExtra::lensq3(sine) /
      (length[0] * length[0] * length[1] * length[1]);
  return std::max(crosses, by_wider);
}

/** Turns the interface of a pair of this line, with these weights, to the direction of the line and to that around it. */
void FixMPMContact::turn(Pair &pair, const Line &line, double turned, double follows,
                         const double *around) const
{
  const bool first_is_wider = line.seen[0].share > line.seen[1].share;
  const Body &narrow = bodies[first_is_wider ? pair.b : pair.a];
  const double *const record = first_is_wider ? pair.rb : pair.ra;
  const int64_t node = (record - narrow.field->grid.nodes()) / narrow.field->grid.nreal;
  const double outward = MathExtra::dot3(&narrow.gradient[3 * node], line.n),
               own = std::max(first_is_wider ? -outward : outward, 0.0);
  double area[3];
  for (int d = 0; d < 3; d++) {
    area[d] = pair.area * pair.n[d];
    area[d] += turned * (own * line.n[d] - area[d]);
  }
  const double along = std::max(MathExtra::dot3(area, around), 0.0);
  for (int d = 0; d < 3; d++) area[d] += follows * (along * around[d] - area[d]);
  pair.area = MathExtra::len3(area);
  MathExtra::copy3(area, pair.n);
  if (pair.area > 0.0) MathExtra::scale3(1.0 / pair.area, pair.n);
}

/** Joins lines that a body hardly covers to a neighbor, preferably straight across its edge: separate conditions on nodes with hardly
 *  any mass would make the iterations oscillate. */
void FixMPMContact::join_lines(std::vector<Line> &lines, const LinesByKey &by_key) const
{
  for (auto &line : lines) {
    line.joins = -1;
    if (std::min(line.seen[0].share, line.seen[1].share) >= LIGHT) continue;
    double most = 0.0;
    for_lines_around(lines, by_key, line, [&](int k) {
      const Line &other = lines[k];
      double weight = std::min(other.seen[0].share, other.seen[1].share);
      if (weight < LIGHT) return;
      int ways = 0;
      for (int d = 0; d < 3; d++) ways += other.key[3 + d] != line.key[3 + d];
      if (ways > 1) weight *= DIAGONAL;
      if (weight <= most * (1.0 + STEEPER)) return;
      most = weight;
      line.joins = k;
    });
  }
}

/** Finds edges of bodies along lines, and turns the interfaces of their pairs there. */
void FixMPMContact::find_edges(std::vector<Line> &lines)
{
  std::vector<double> turned;
  LinesByKey by_key;
  for (auto &line : lines) {
    line.seen[0] = look_along(bodies[line.key[0]], line, line.sign);
    line.seen[1] = look_along(bodies[line.key[1]], line, -line.sign);
    by_key[line.key].push_back((int) turned.size());
    turned.push_back(turn_to_wider(line));
  }
  for (std::size_t l = 0; l < lines.size(); l++) {
    const Line &line = lines[l];
    double around[3] = {0.0, 0.0, 0.0};
    for_lines_around(lines, by_key, line, [&](int k) {
      const double both = lines[k].seen[0].share * lines[k].seen[1].share;
      for (int d = 0; d < 3; d++) around[d] += both * both * lines[k].n[d];
    });
    const double length = MathExtra::len3(around);
    double follows = 0.0;
    if (length > 0.0) {
      MathExtra::scale3(1.0 / length, around);
      follows = follows_others(line, turned[l], around);
    }
    if (turned[l] == 0.0 && follows == 0.0) continue;
    for (const auto &place : line.places)
      turn(pairs[place.second], line, turned[l], follows, around);
  }
  join_lines(lines, by_key);
}
