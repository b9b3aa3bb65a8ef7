/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   A face with a prescribed temperature is a constraint on the equations of the nodes, C dT/dt = R,
   and the heat through it is the multiplier: dT_k = lambda w_k/C_k changes sum_k w_k T_k with the
   least sum of C dT^2. Rates are treated in the same way, so that the temperature at the face
   stays. This is a projection, symmetric in the norm of capacities: it leaves explicit steps as
   stable as they were. Where lines along several axes meet, they take turns, forward and backward,
   which is symmetric, too.

   Weights are those of the sums over points (mpm_heat_body.cpp). In material that is too thin for
   these, they are those of the functions at the face. These would give finite heat to a node
   outside of the box without capacity. Hence the weight of a node counts in full only if the node
   has at least half of the volume that it has where material fills the box, and in proportion below
   that.

   Convection and radiation: the temperature at a face follows that outside with the rate r = R
   dP/dT of a line, with its response R and the power P. As at other surfaces (mpm_heat_surface.cpp)
   this rate is limited to l: the line gets

     P = F - a D/R,   a = r/l - 1,

   F: the power without a limit, D: the rate of its temperature by all heat, P included, which is
   zero when nothing changes. With a projection Pi to the temperature of each line, this is (1 + sum
   a Pi)^-1 times the rates without limits. In the norm of capacities it is symmetric, and for any
   amplitude y of the line in a mode r y/(1 + a y) <= l: what follows at edges and corners is at
   most as fast as the sum of the rates of all axes. Lines of several faces have nodes in common
   there. With sum_k w_k w'_k/C_k between two lines, a matrix G with R on its diagonal, the
   equations are

     (R/a) P + sum G P' = (R/a) F - D_0,   D_0: by all other heat.

   Lines with a prescribed temperature are included, with a very small R/a and without F. At edges,
   r is at most some times the rate of conduction, by a smaller area. Temperatures of the faces
   there then differ from those outside by a small part of their difference from those a cell
   further inside. Lines that took turns would not be symmetric. Between different temperatures, a
   weak dependence on the time step is left.

   How near is material? Along a line, the ratio of sum_k w_k V_k to its value where material fills
   the box up to the face is 1 without a gap, 0.7 with a gap of a quarter of a cell, and 0.46 with
   half a cell (quadratic). At the sides of a body, the fullest node of a line shows how many points
   the line has.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_faces.h"

#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_stencil.h"
#include "heat/mpm_heat_body.h"
#include "math/sets.h"
#include "math_special.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// least sum of weights by the surface, over the area
static constexpr double THICK = 0.9;
static constexpr double ENOUGH = 0.5;    // share of the volume of a node for its full weight
// volume of a node inside of the box, in cells, below which it does not show how full a line is
static constexpr double LIGHT = 0.1;
// fullness from which on material touches a face, and from which on all of it is at the face
static constexpr double TOUCHES = 0.6, IS_AT_FACE = 0.75;
// greatest rate of lines at edges, over that of conduction
static constexpr double FIGHTS = 4.0;
// stiffness of equations that stands for a prescribed temperature
static constexpr double STIFFEST = 1.0e9;

void MPMHeatFaces::init(double sigma_of_units)
{
  sigma = sigma_of_units;
  std::fill_n(last, 3, 0.0);
  groups.clear();
  faces.clear();
  const MPMStencil stencil(field);
  const auto &lattice = field.lattice;
  int held = 0;
  for (int face = 0; face < NFACE; face++) {
    if (conditions[face].kind == MPMHeatCondition::INSULATED) continue;
    Face f = {};
    f.face = face;
    f.axis = face / 2;
    const double x = f.x = face % 2 ? domain->boxhi[f.axis] : domain->boxlo[f.axis];
    const double at = (x - lattice.origin[f.axis]) / lattice.h;
    f.n = stencil.weights(at, f.first, f.weight);

    // integrals of functions over the inside, by the midpoint rule

    constexpr int SAMPLES = 1024, REACH = 4;
    for (int k = 0; k < REACH * SAMPLES; k++) {
      const double depth = (k + 0.5) / SAMPLES;
      int first;
      double w[NodeLine::MOST];
      const int n = stencil.weights(face % 2 ? at - depth : at + depth, first, w);
      for (int j = 0; j < n; j++)
        if (first + j >= f.first && first + j < f.first + f.n)
          f.full[first + j - f.first] += w[j] / SAMPLES;
    }
    if (conditions[face].kind == MPMHeatCondition::TEMPERATURE) held |= 1 << f.axis;
    faces.push_back(f);
  }
  crossing = (held & (held - 1)) != 0;
}

double MPMHeatFaces::limit(double cap, double conduction, const double rates[3])
{
  fastest = cap;
  for (auto &group : groups) {
    slow_down(group, conduction);
    set_up(group);
  }
  double sum = 0.0;
  for (int axis = 0; axis < 3; axis++) sum += std::min(cap, last[axis] = rates[axis]);
  return sum;
}

/** Expected rate of exchange. Where material fills the box, the response of a line times its area
 *  and h is up to 1.9/capacity, and up to twice that in lines whose nodes have only half of their
 *  volume. A rate that is not known is the limit. */
double MPMHeatFaces::expected_rate(double cap, double capacity) const
{
  static constexpr double MOST = 5.0;
  double rates[3] = {0.0, 0.0, 0.0};
  for (const auto &face : faces) {
    const auto &condition = conditions[face.face];
    if (condition.kind <= MPMHeatCondition::FLUX) continue;
    const auto &H = condition.value[0];
    const bool known =
        condition.kind == MPMHeatCondition::CONVECTION && H.variable.empty() && capacity > 0.0;
    const double rate =
        known ? std::max(last[face.axis], MOST * H.value / (capacity * field.lattice.h)) : cap;
    rates[face.axis] = std::max(rates[face.axis], std::min(cap, rate));
  }
  return rates[0] + rates[1] + rates[2];
}

int MPMHeatFaces::axes_that_follow() const
{
  bool follows[3] = {false, false, false};
  for (const auto &face : faces)
    if (conditions[face.face].kind > MPMHeatCondition::FLUX) follows[face.axis] = true;
  return follows[0] + follows[1] + follows[2];
}

void MPMHeatFaces::extend_topology()
{
  Grid &grid = field.grid;
  // blocks that are added in this loop are visited, too: for lines along another axis
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++)
    for (const auto &face : faces) {
      int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
      const int low = b[face.axis] * grid.side, last = face.first + face.n - 1;
      if (low > last || low + grid.side <= face.first) continue;
      for (const int k : {face.first, last}) {
        b[face.axis] = k >> grid.shift_bits;
        grid.activate(b);
      }
    }
}

void MPMHeatFaces::topology_changed()
{
  const Grid &grid = field.grid;
  for (auto &face : faces) {
    face.lines.clear();
    for (const auto &block : grid.blocks) {
      const int low = block.b[face.axis] * grid.side;
      if (face.first < low || face.first >= low + grid.side) continue;
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        if (block.alias >> n & 1) continue;
        int index[3];
        grid.node_index(block, n, index);
        if (index[face.axis] != face.first) continue;
        Line line = {};
        line.axis = face.axis;
        line.n = face.n;
        bool all = true;
        for (int k = 0; k < face.n; k++) {
          line.node[k] = grid.locate(index);
          all = all && line.node[k] >= 0;
          index[face.axis]++;
        }
        if (all) face.lines.push_back(line);
      }
    }
  }
  find_groups();
  find_crossing();
}

/** A line that crosses no other one has its temperature after the first pass of visit_held(). */
void MPMHeatFaces::find_crossing()
{
  if (!crossing) return;
  std::vector<int> lines(field.grid.nnodes(), 0);    // of a node
  const auto each_node = [&](const auto &use) {
    for (auto &face : faces)
      for (std::size_t k = 0; is_held(face) && k < face.lines.size(); k++)
        for (int j = 0; j < face.n; j++) use(face, (int) k, lines[face.lines[k].node[j]]);
  };
  each_node([](const Face &, int, int &count) {
    count++;
  });
  for (auto &face : faces) face.crossing.clear();
  each_node([](Face &face, int line, int count) {
    if (count < 2) return;
    if (face.crossing.empty() || face.crossing.back() != line) face.crossing.push_back(line);
  });
}

/** A rank that has a node of a line has all nodes of it, and so all lines of a group. */
void MPMHeatFaces::find_groups()
{
  groups.clear();
  if (axes_that_follow() == 0 || faces.size() < 2) return;
  std::vector<Line *> lines;
  std::vector<const Face *> face_of;
  std::vector<std::pair<int64_t, int>> touched;    // node, line
  for (auto &face : faces) {
    if (conditions[face.face].kind == MPMHeatCondition::FLUX) continue;
    for (auto &line : face.lines) {
      for (int k = 0; k < face.n; k++) touched.emplace_back(line.node[k], (int) lines.size());
      lines.push_back(&line);
      face_of.push_back(&face);
    }
  }
  std::sort(touched.begin(), touched.end());
  Sets sets(lines.size());
  std::vector<int> size(lines.size(), 0), group_of(lines.size(), -1);
  for (std::size_t k = 1; k < touched.size(); k++)
    if (touched[k].first == touched[k - 1].first)
      sets.join(touched[k].second, touched[k - 1].second);
  for (std::size_t k = 0; k < lines.size(); k++) size[sets.root((int) k)]++;
  for (std::size_t k = 0; k < lines.size(); k++) {
    const int r = sets.root((int) k);
    if (size[r] < 2) continue;
    if (group_of[r] < 0) {
      group_of[r] = (int) groups.size();
      groups.emplace_back();
    }
    groups[group_of[r]].all.push_back({face_of[k], lines[k]});
  }
}

/** Limits the rates of faces that meet at an edge. With different temperatures, these would
 *  exchange heat through the nodes of the edge in proportion to their coefficients, and not to what
 *  conduction lets through. The two sides of a thin body also have nodes in common, but no edge:
 *  heat between them has a length to go. */
void MPMHeatFaces::slow_down(Group &group, double conduction) const
{
  int axes = 0;
  for (const auto &member : group.all)
    if (member.line->response > 0.0) axes |= 1 << member.face->axis;
  if ((axes & (axes - 1)) == 0) return;
  for (const auto &member : group.all) {
    Line &line = *member.line;
    const double most = FIGHTS * conduction;
    if (!(line.rate > most)) continue;
    line.area *= most / line.rate;
    line.rate = most;
  }
}

void MPMHeatFaces::note_edges(MPMHeatBody &body) const
{
  for (const auto &face : faces)
    for (const auto &line : face.lines)
      for (int k = 0; line.response > 0.0 && k < face.n; k++)
        if (line.weight[k] > 0.0 && field.grid.owns(line.node[k]))
          body.note_face(line.node[k], face.axis, face.face % 2 ? -line.weight[k] : line.weight[k]);
}

void MPMHeatFaces::slow_down_at_edges(const MPMHeatBody &body, double conduction)
{
  for (auto &face : faces)
    for (auto &line : face.lines) {
      if (!(line.response > 0.0) || !(line.rate > conduction)) continue;
      bool at_edge = false;
      for (int k = 0; k < face.n; k++)
        at_edge = at_edge || body.is_edge(line.node[k], line.weight[k]);
      if (!at_edge) continue;
      line.area *= conduction / line.rate;
      line.rate = conduction;
    }
}

/** Lists the lines of a group that are limited or held, if any is limited, and finds the factors L
 *  L^T of the matrix of their equations. */
void MPMHeatFaces::set_up(Group &group) const
{
  auto &lines = group.lines;
  auto &L = group.factor;
  lines.clear();
  bool any = false;
  for (const auto &member : group.all) {
    member.line->joint = false;
    const bool held = is_held(*member.face);
    if (!(member.line->response > 0.0) || (!held && !is_limited(*member.line))) continue;
    lines.push_back(member);
    any = any || !held;
  }
  if (!any) lines.clear();
  const std::size_t n = lines.size();
  L.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; i++) {
    const auto &[face, line] = lines[i];
    line->joint = true;
    for (std::size_t j = 0; j <= i; j++) {
      double sum = i == j ? softness(*face, *line) : 0.0;
      for (int a = 0; a < face->n; a++)
        for (int b = 0; b < lines[j].face->n; b++)
          if (line->node[a] == lines[j].line->node[b])
            sum += line->weight[a] * lines[j].line->change[b];
      for (std::size_t k = 0; k < j; k++) sum -= L[n * i + k] * L[n * j + k];
      L[n * i + j] = i == j ? std::sqrt(sum) : sum / L[n * j + j];
    }
  }
}

/** R/a of a line, see the top of this file. */
double MPMHeatFaces::softness(const Face &face, const Line &line) const
{
  const bool held = is_held(face);
  return line.response *
      (held ? 1.0 / STIFFEST
            : std::clamp(fastest / (line.rate - fastest), 1.0 / STIFFEST, STIFFEST));
}

void MPMHeatFaces::solve(const Group &group, bool changes, const std::vector<double> &temperature,
                         std::vector<double> &rate, Heats &power) const
{
  const auto &lines = group.lines;
  const auto &L = group.factor;
  const std::size_t n = lines.size();
  auto &P = group.power;
  P.assign(n, 0.0);
  for (std::size_t i = 0; i < n; i++) {
    const auto &[face, line] = lines[i];
    const auto &condition = conditions[face->face];
    const double T = line->value(temperature.data());
    for (int k = 0; k < line->n; k++) P[i] -= line->weight[k] * rate[line->node[k]];
    if (condition.kind != MPMHeatCondition::TEMPERATURE)
      P[i] += softness(*face, *line) * std::min(1.0, STIFFEST * fastest / line->rate) * line->area *
          flux(changes, *face, *line, T);
    for (std::size_t k = 0; k < i; k++) P[i] -= L[n * i + k] * P[k];
    P[i] /= L[n * i + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; k++) P[i] -= L[n * k + i] * P[k];
    P[i] /= L[n * i + i];
  }
  for (std::size_t i = 0; i < n; i++) {
    const auto &[face, line] = lines[i];
    for (int k = 0; k < face->n; k++) rate[line->node[k]] += P[i] * line->change[k];
    power[face->face] += P[i] * line->owned;
  }
}

/** Length of the circle of a node around an axis of symmetry; 1 without one. */
double MPMHeatFaces::circle(int64_t node) const
{
  return field.frame->node_circle((int) (node / NODES_PER_BLOCK), (int) (node % NODES_PER_BLOCK));
}

/** Cross section of a line of nodes along an axis, over that of a cell: 1, except that with
 *  Bernstein polynomials a node at the side of a cell has 4/3 of a spacing along an axis, and one
 *  in the middle 2/3. */
double MPMHeatFaces::width(int64_t node, int axis) const
{
  if (field.options.shape != BERNSTEIN) return 1.0;
  int index[3];
  double width = 1.0;
  field.grid.node_index(node, index);
  for (int d = 0; d < field.lattice.dim; d++)
    if (d != axis) width *= (index[d] & 1 ? 2.0 : 4.0) / 3.0;
  return width;
}

void MPMHeatFaces::prepare(const Face &face, Line &line, const std::vector<double> &capacity,
                           const std::vector<double> &volume, const MPMHeatBody *body,
                           const std::vector<double> &ends) const
{
  const Grid &grid = field.grid;
  const double cell = width(line.node[0], face.axis) * grid.lattice.cell_volume();
  std::fill_n(line.weight, NodeLine::MOST, 0.0);
  double part[NodeLine::MOST] = {}, most = 0.0, there = 0.0, full = 0.0;
  for (int k = 0; k < face.n; k++) {
    const double V = volume[line.node[k]] / (cell * circle(line.node[k]));
    there += face.weight[k] * V;
    full += face.weight[k] * face.full[k];
    if (!(face.full[k] > 0.0) || !(capacity[line.node[k]] > 0.0)) continue;
    part[k] = V / face.full[k];
    if (face.weight[k] > 0.0 && face.full[k] > LIGHT) most = std::max(most, part[k]);
  }
  if (!(most > 0.0)) return;
  const double near = there / (full * most);
  if (!(near > TOUCHES)) return;

  const double aside = is_level ? most : heat_area_share(most);
  line.area = std::min(1.0, aside) * cell / grid.lattice.h *
      (face.axis ? circle(line.node[0]) : field.frame->circle(face.x)) *
      std::min(1.0, (near - TOUCHES) / (IS_AT_FACE - TOUCHES));
  const auto conducting = [&](int64_t node) {
    return body ? body->conducting(node) : capacity[node] > 0.0 ? 1.0 : 0.0;
  };
  if ((!body && ends.empty()) ||
      !weigh_by_surface(face, line, body ? body->gradient : ends, conducting)) {
    double sum = 0.0;
    for (int k = 0; k < face.n; k++) {
      line.weight[k] = face.weight[k] * std::min(1.0, part[k] / (ENOUGH * most));
      sum += line.weight[k];
    }
    for (int k = 0; k < face.n; k++) line.weight[k] /= sum;
  }
  line.owned = line.response = 0.0;
  for (int k = 0; k < face.n; k++) {
    line.change[k] = line.weight[k] > 0.0 ? line.weight[k] / capacity[line.node[k]] : 0.0;
    line.response += line.weight[k] * line.change[k];
    if (grid.owns(line.node[k])) line.owned += line.weight[k];
  }
}

/** Weights from the sums over points, see mpm_heat_body.cpp. Around an axis of symmetry, a flux in
 *  proportion to 1/r is in equilibrium. Where material is too thin, the sums of its other side
 *  reduce these sums. */
bool MPMHeatFaces::weigh_by_surface(const Face &face, Line &line,
                                    const std::vector<double> &gradient,
                                    const std::function<double(int64_t)> &conducting) const
{
  double weight[NodeLine::MOST], sum = 0.0;
  for (int k = 0; k < face.n; k++) {
    const double G = gradient[3 * line.node[k] + face.axis];
    weight[k] = std::max(0.0, face.face % 2 ? G : -G) * conducting(line.node[k]);
    sum += weight[k];
  }
  const double length = face.axis ? circle(line.node[0]) : field.frame->circle(face.x);
  if (!(length * sum > THICK * line.area)) return false;
  for (int k = 0; k < face.n; k++) line.weight[k] = weight[k] / sum;
  return true;
}

bool MPMHeatFaces::is_near(const double *place, double distance) const
{
  return std::any_of(faces.begin(), faces.end(), [&](const Face &face) {
    return std::fabs(place[face.axis] - face.x) <= distance;
  });
}

/** Does a line of a face have some nodes that are taken, but not all? Nodes with a small weight at
 *  the face may be out of reach of points, and do not count. */
bool MPMHeatFaces::has_part_of_line(const std::function<bool(int64_t)> &taken) const
{
  static constexpr double SEEN = 0.25;
  for (const auto &face : faces)
    for (const auto &line : face.lines) {
      int count = 0, all = 0;
      for (int k = 0; k < face.n; k++) {
        if (face.weight[k] < SEEN) continue;
        all++;
        count += taken(line.node[k]);
      }
      if (count > 0 && count < all) return true;
    }
  return false;
}

void MPMHeatFaces::mark_near(std::vector<char> &near) const
{
  for (const auto &face : faces)
    for (const auto &line : face.lines) line.mark_blocks(near);
}

void MPMHeatFaces::begin_step(const std::vector<double> &capacity,
                              const std::vector<double> &volume, const MPMHeatBody *body,
                              const std::vector<double> &ends,
                              const std::vector<double> &temperature, double rates[3])
{
  for (auto &face : faces) {
    const auto &condition = conditions[face.face];
    for (auto &line : face.lines) {
      line.response = line.area = line.rate = 0.0;
      line.joint = false;
      prepare(face, line, capacity, volume, body, ends);
      if (condition.kind <= MPMHeatCondition::FLUX) continue;
      const double T = line.value(temperature.data());
      line.rate = line.area * line.response * condition.slope(T, sigma);
      rates[face.axis] = std::max(rates[face.axis], line.rate);
    }
  }
}

double MPMHeatCondition::flux(double T, double sigma) const
{
  using MathSpecial::square;
  if (kind == INSULATED) return 0.0;
  if (kind == FLUX) return now[0];
  if (kind == CONVECTION) return now[0] * (now[1] - T);
  return now[0] * sigma * (square(square(now[1])) - square(square(T)));
}

double MPMHeatCondition::derivative(double T, double sigma) const
{
  if (kind <= FLUX) return 0.0;
  if (kind == CONVECTION) return now[0];
  return 4.0 * now[0] * sigma * MathSpecial::cube(T);
}

double MPMHeatCondition::slope(double T, double sigma) const
{
  if (kind <= FLUX) return 0.0;
  if (kind == CONVECTION) return now[0];
  return 4.0 * now[0] * sigma * MathSpecial::cube(std::max(T, now[1]));
}

/** Calls f(face, line) for lines whose temperature is prescribed. */
template <class F> void MPMHeatFaces::visit_held(const F &f) const
{
  for (const auto &face : faces)
    for (std::size_t k = 0; is_held(face) && k < face.lines.size(); k++)
      if (face.lines[k].response > 0.0) f(face, face.lines[k]);
  if (!crossing) return;
  const auto visit = [&](const Face &face) {
    for (const int k : face.crossing)
      if (face.lines[k].response > 0.0) f(face, face.lines[k]);
  };
  for (int turn = 0; turn < turns; turn++) {
    for (std::size_t k = 0; turn && k < faces.size(); k++) visit(faces[k]);
    for (auto face = faces.rbegin() + 1; face < faces.rend(); ++face) visit(*face);
  }
}

void MPMHeatFaces::hold(std::vector<double> &temperature, Heats &heat) const
{
  visit_held([&](const Face &face, const Line &line) {
    const double T = line.value(temperature.data());
    const double needed = (conditions[face.face].now[0] - T) / line.response;
    for (int k = 0; k < face.n; k++) temperature[line.node[k]] += needed * line.change[k];
    heat[face.face] += needed * line.owned;
  });
}

bool MPMHeatFaces::linearize(const std::vector<double> &temperature)
{
  bool symmetric = true;
  for (auto &face : faces)
    for (auto &line : face.lines) {
      if (!(line.area > 0.0)) continue;
      const double T = line.value(temperature.data());
      line.slope = conditions[face.face].derivative(T, sigma);
      symmetric = symmetric && !is_limited(line);
    }
  return symmetric;
}

/** Visits the terms of lines. Ranks that have a node of a line have the line; it belongs to the
 *  owner of the first of its nodes with a capacity. */
void MPMHeatFaces::each_term(double least, const MPMDiffusion::Term &use) const
{
  static constexpr double STIFF = 100.0;
  for (const auto &face : faces) {
    const bool held = is_held(face);
    for (const auto &line : face.lines) {
      if (!(line.response > 0.0)) continue;
      int k = 0;
      while (k < face.n && !(line.change[k] > 0.0)) k++;
      if (k == face.n || !field.grid.owns(line.node[k])) continue;
      const double stiffness = held ? STIFF * least / line.response
                                    : std::min(line.area * line.slope, fastest / line.response);
      if (stiffness > 0.0) use(line.n, line.node, 1, line.weight, &stiffness);
    }
  }
}

void MPMHeatFaces::add_rates(bool changes, const std::vector<double> &temperature,
                             std::vector<double> &rate, Heats &power) const
{
  const auto visit = [&](bool limited, const auto &power_of) {
    for (const auto &face : faces) {
      if (is_held(face)) continue;
      for (const auto &line : face.lines) {
        if (!(line.area > 0.0) || line.joint || is_limited(line) != limited) continue;
        const double T = line.value(temperature.data());
        const double more = power_of(line, line.area * flux(changes, face, line, T));
        for (int k = 0; k < face.n; k++) rate[line.node[k]] += more * line.change[k];
        power[face.face] += more * line.owned;
      }
    }
  };
  visit(false, [](const Line &, double P) {
    return P;
  });
  // these lines have no nodes in common with others that are limited or held
  visit(true, [&](const Line &line, double P) {
    const double drift = line.value(rate.data());
    const double slower = fastest / line.rate;
    return slower * P - (1.0 - slower) * drift / line.response;
  });
  for (const auto &group : groups) solve(group, changes, temperature, rate, power);
  hold_rates(rate, power);
}

void MPMHeatFaces::hold_rates(std::vector<double> &rate, Heats &power) const
{
  visit_held([&](const Face &face, const Line &line) {
    const double drift = line.value(rate.data());
    const double needed = -drift / line.response;
    for (int k = 0; k < face.n; k++) rate[line.node[k]] += needed * line.change[k];
    power[face.face] += needed * line.owned;
  });
}

double MPMHeatFaces::memory_usage() const
{
  double bytes = 0.0;
  for (const auto &face : faces) bytes += face.lines.capacity() * sizeof(Line);
  for (const auto &group : groups)
    bytes += (group.all.capacity() + group.lines.capacity()) * sizeof(Member) +
        (group.factor.capacity() + group.power.capacity()) * sizeof(double);
  return bytes;
}
