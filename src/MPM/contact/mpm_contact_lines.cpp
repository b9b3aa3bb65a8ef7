/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* At the edge of a body on a wider one, the free side of the wider one continues the interface, and
   that of the other one is at an angle to it: with the area vectors A of
   MPMContactSearch::interface_at(), normals would be inclined there, most of all at nodes beyond
   the edge. The wider body covers more of the cross-section of a line of nodes through the
   interface. Its direction n along the line is taken instead, with A = (g.n) n and g of the other
   body. Where the edges of two bodies cross, each covers another part of the cross-section, and n
   is that of the lines around, with most weight for lines that both bodies cover.

   The gap is the volume that both bodies lack along the line, over the area of the interface. Where
   a body covers only the part c of the cross-section of the line, next to its edge, its volumes are
   divided by c:

      g = h |n_axis| sum_k (1 - V_a,k/c_a - V_b,k/c_b) */

#include "contact/mpm_contact_lines.h"

#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double STEEPER = 1.0e-6;    // relative difference that decides alike on all ranks
static constexpr double OWN = 3.0;           // weight of a node relative to those around
static constexpr double WIDER = 0.02;       // difference of fractions from which on a body is wider
static constexpr double LIGHT = 0.1;        // largest cover of a line that joins the one next to it
static constexpr double DIAGONAL = 0.25;    // weight of a line diagonally next to this one
// free sides, relative to the cross-section of a line. CROSSING: of both bodies where they cross
// (interfaces of lattices of points have up to about a tenth, against each other); SIDE: of the
// wider body, from which on lines follow others
static constexpr double CROSSING = 0.15, SIDE = 0.1;
static constexpr double COVERED = 1.0e-3;    // least fraction of the cross-section of a line
static constexpr double ALONG = 1.0e-8;    // component of the normal of a side that is along a line
static constexpr double SAME = 1.0e-6;     // relative difference of fractions that count as equal

void MPMContactLines::find(MPMContacts &of)
{
  contacts = &of;
  list.clear();
  find_lines();
  find_edges();
}

/** Do walls determine both bodies at this node by those inside? Also finds the action of walls. */
bool MPMContactLines::is_beyond_walls(MPMNodeContact &pair) const
{
  const int all = (1 << bodies.dim()) - 1;
  pair.walls_a = bodies[pair.a].walls_at(pair.ra);
  pair.walls_b = bodies[pair.b].walls_at(pair.rb);
  const auto follows = [all](const MPMNodeWalls &walls) {
    return ((walls.outside | walls.held) & all) == all;
  };
  return follows(pair.walls_a) && follows(pair.walls_b);
}

/** Finds the axis of the line of a pair, the sign of its normal along it, and the index of its
 *  node. The nodes around are included, as nodes beyond edges have hardly any interface. */
int MPMContactLines::axis_at(const MPMNodeContact &pair, int *index, double &sign) const
{
  const int dim = bodies.dim();
  const MPMContactBody &body = bodies[pair.a];
  body.field->grid.node_index(body.node_of(pair.ra), index);
  double n[3] = {0.0, 0.0, 0.0};
  const int across = dim == 3 ? 1 : 0;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++)
      for (int k = -across; k <= across; k++) {
        const int at[3] = {index[0] + i, index[1] + j, index[2] + k};
        double there[3];
        search.interface_at(pair.a, pair.b, at, there);
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
void MPMContactLines::find_lines()
{
  auto &pairs = contacts->pairs;
  std::map<Key, std::vector<std::pair<int, int>>> all;
  const MPM_NS::Lattice &lattice = bodies[0].field->lattice;
  for (std::size_t p = 0; p < pairs.size(); p++) {
    MPMNodeContact &pair = pairs[p];
    if (is_beyond_walls(pair)) continue;
    int index[3];
    double sign;
    const int axis = axis_at(pair, index, sign), at = index[axis];
    index[axis] = 0;
    all[{pair.a, pair.b, 2 * axis + (sign > 0.0), index[0], index[1], index[2]}].emplace_back(
        at, (int) p);
  }
  for (auto &entry : all) {    // no structured binding: C++17 has none in lambdas
    const Key &key = entry.first;
    auto &places = entry.second;
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
      list.push_back(line);
    }
  }
}

/** Share and gradient of a body along a line, of the nodes where its gradient has this sign. */
MPMContactLines::Coverage MPMContactLines::coverage(const MPMContactBody &body, const Line &line,
                                                    double sign) const
{
  const MPM_NS::Lattice &lattice = body.field->lattice;
  const double cross = lattice.cell_volume() / lattice.h;
  Coverage covered = {};
  int at[3] = {line.index[0], line.index[1], line.index[2]};
  for (int i = line.low() - AROUND; i <= line.high() + AROUND; i++) {
    at[line.axis] = i;
    const int64_t node = body.node_at(at);
    if (node < 0) continue;
    covered.fraction = std::max(covered.fraction, bodies.fraction(body, at));
    const int slot = (int) (node / NODES_PER_BLOCK), n = (int) (node % NODES_PER_BLOCK);
    const double circle = body.field->frame->node_circle(slot, n);
    double g[3];
    bodies.gradient_with_mirrors(body, slot, n, g);
    // skip the other surface of a thin body, and sides along the line
    if (!(circle > 0.0 && sign * g[line.axis] > ALONG * MathExtra::len3(g))) continue;
    for (int d = 0; d < lattice.dim; d++) {
      covered.g[d] += g[d] / (cross * circle);
      covered.alone[d] += body.gradient[3 * node + d] / (cross * circle);
    }
  }
  covered.fraction = std::min(std::max(covered.fraction, std::fabs(covered.g[line.axis])), 1.0);
  return covered;
}

/** Finds the direction of a line, by its interface or by that of the wider body. Returns the weight
 *  of the latter, from 0 to 1. */
double MPMContactLines::turn_to_wider(Line &line) const
{
  double n[3] = {0.0, 0.0, 0.0}, wide[3];
  for (const auto &place : line.places)
    for (int d = 0; d < 3; d++)
      n[d] += contacts->pairs[place.second].area * contacts->pairs[place.second].n[d];
  const double wider = line.covered[0].fraction - line.covered[1].fraction,
               turned = std::min(std::fabs(wider) / WIDER, 1.0);
  MathExtra::copy3(line.covered[wider > 0.0 ? 0 : 1].g, wide);
  const double length = MathExtra::len3(n), wide_length = MathExtra::len3(wide);
  MathExtra::zero3(line.n);    // the two sides of a thin body may cancel
  if (length > 0.0) MathExtra::scale3(1.0 / length, n, line.n);
  if (wide_length == 0.0) return 0.0;
  MathExtra::scale3((wider > 0.0 ? 1.0 : -1.0) / wide_length, wide);
  for (int d = 0; d < 3; d++) line.n[d] += turned * (wide[d] - line.n[d]);
  const double size = MathExtra::len3(line.n);
  if (size > 0.0) MathExtra::scale3(1.0 / size, line.n);
  return turned;
}

/** Calls use(k) for a line and its neighbors. */
void MPMContactLines::visit_neighbors(const LinesByKey &by_key, const Line &line,
                                      const std::function<void(int k)> &use) const
{
  const MPM_NS::Lattice &lattice = bodies[0].field->lattice;
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
        if (list[k].low() <= line.high() + 1 && list[k].high() >= line.low() - 1) use(k);
    }
}

/** Weight, from 0 to 1, with which a line takes the direction of the lines around it: where sides
 *  of both bodies cross, and where the wider body, whose direction has the weight turned, has a
 *  side, too. */
double MPMContactLines::weight_of_neighbors(const Line &line, double turned,
                                            const double *around) const
{
  double side[2][3], length[2];
  for (int k = 0; k < 2; k++) {
    const double along = MathExtra::dot3(line.covered[k].alone, around);
    for (int d = 0; d < 3; d++) side[k][d] = line.covered[k].alone[d] - along * around[d];
    length[k] = MathExtra::len3(side[k]);
  }
  const int wider = line.covered[0].fraction > line.covered[1].fraction ? 0 : 1;
  const double by_wider = turned * std::min(length[wider] / SIDE, 1.0);
  const double shorter = std::min(length[0], length[1]);
  if (shorter <= CROSSING) return by_wider;
  double sine[3];
  MathExtra::cross3(side[0], side[1], sine);
  const double crosses = std::min(shorter / CROSSING - 1.0, 1.0) * MathExtra::lensq3(sine) /
      (length[0] * length[0] * length[1] * length[1]);
  return std::max(crosses, by_wider);
}

/** Turns the interface of a pair of this line, with these weights, to the direction of the line and
 *  to that around it. */
void MPMContactLines::turn(MPMNodeContact &pair, const Line &line, double turned, double weight,
                           const double *around) const
{
  const bool first_is_wider = line.covered[0].fraction > line.covered[1].fraction;
  const MPMContactBody &narrow = bodies[first_is_wider ? pair.b : pair.a];
  const double *const record = first_is_wider ? pair.rb : pair.ra;
  const double outward = MathExtra::dot3(narrow.gradient_at(record), line.n),
               own = std::max(first_is_wider ? -outward : outward, 0.0);
  double area[3];
  for (int d = 0; d < 3; d++) {
    area[d] = pair.area * pair.n[d];
    area[d] += turned * (own * line.n[d] - area[d]);
  }
  const double along = std::max(MathExtra::dot3(area, around), 0.0);
  for (int d = 0; d < 3; d++) area[d] += weight * (along * around[d] - area[d]);
  pair.area = MathExtra::len3(area);
  MathExtra::copy3(area, pair.n);
  if (pair.area > 0.0) MathExtra::scale3(1.0 / pair.area, pair.n);
}

/** Joins lines that a body hardly covers to a neighbor, preferably straight across its edge:
 *  separate conditions on nodes with hardly any mass would make the iterations oscillate. */
void MPMContactLines::join_lines(const LinesByKey &by_key)
{
  for (auto &line : list) {
    line.joins = -1;
    if (std::min(line.covered[0].fraction, line.covered[1].fraction) >= LIGHT) continue;
    double most = 0.0;
    visit_neighbors(by_key, line, [&](int k) {
      const Line &other = list[k];
      double weight = std::min(other.covered[0].fraction, other.covered[1].fraction);
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
void MPMContactLines::find_edges()
{
  std::vector<double> turned;
  LinesByKey by_key;
  for (auto &line : list) {
    line.covered[0] = coverage(bodies[line.key[0]], line, line.sign);
    line.covered[1] = coverage(bodies[line.key[1]], line, -line.sign);
    by_key[line.key].push_back((int) turned.size());
    turned.push_back(turn_to_wider(line));
  }
  for (std::size_t l = 0; l < list.size(); l++) {
    const Line &line = list[l];
    double around[3] = {0.0, 0.0, 0.0};
    visit_neighbors(by_key, line, [&](int k) {
      const double both = list[k].covered[0].fraction * list[k].covered[1].fraction;
      for (int d = 0; d < 3; d++) around[d] += both * both * list[k].n[d];
    });
    const double length = MathExtra::len3(around);
    double weight = 0.0;
    if (length > 0.0) {
      MathExtra::scale3(1.0 / length, around);
      weight = weight_of_neighbors(line, turned[l], around);
    }
    if (turned[l] == 0.0 && weight == 0.0) continue;
    for (const auto &place : line.places)
      turn(contacts->pairs[place.second], line, turned[l], weight, around);
  }
  join_lines(by_key);
}

bool MPMContactLines::measure_gap(const Line &line, const double *n, double full, double &gap) const
{
  const double h = bodies.spacing(), slope = std::fabs(n[line.axis]);
  if (std::min(line.covered[0].fraction, line.covered[1].fraction) < COVERED) return false;
  std::vector<std::array<double, 2>> fractions;
  int at[3] = {line.index[0], line.index[1], line.index[2]};
  for (int i = line.low() - AROUND; i <= line.high() + AROUND; i++) {
    at[line.axis] = i;
    fractions.push_back(
        {bodies.fraction(bodies[line.key[0]], at), bodies.fraction(bodies[line.key[1]], at)});
  }
  // the sum goes from the fullest place of one body to that of the other: other surfaces of the
  // bodies lie beyond. Among equally full places it takes the nearest ones, as round-off would
  // choose differently for each number of ranks
  double most[2] = {0.0, 0.0};
  for (const auto &filled : fractions)
    for (int k = 0; k < 2; k++) most[k] = std::max(most[k], filled[k]);
  const int count = (int) fractions.size();
  const auto is_fullest = [&](int i, int k) {
    return fractions[i][k] >= (1.0 - SAME) * most[k];
  };
  int from = 0, to = count;
  for (int i = 0; i < count; i++)
    for (int j = 0; j < count; j++)
      if (is_fullest(i, 0) && is_fullest(j, 1) && std::abs(i - j) < to - from) {
        from = std::min(i, j);
        to = std::max(i, j);
      }
  double missing = 0.0;
  for (int i = from; i <= to; i++)
    missing += 1.0 - fractions[i][0] / line.covered[0].fraction -
        fractions[i][1] / line.covered[1].fraction;
  gap = h * (slope * missing - (1.0 - full));
  return true;
}
