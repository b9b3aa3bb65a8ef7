/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   A face with a prescribed temperature is a constraint of the equations of the nodes, C dT/dt = R, and the
   heat through it the multiplier: dT_k = lambda w_k/C_k changes sum_k w_k T_k with the least sum of C dT^2.
   Rates of temperatures are treated in the same way, so that the temperature at the face stays. This is a
   projection, symmetric in the norm of capacities: it leaves explicit steps as stable as they were. Where
   lines along several axes meet, they take turns, forward and backward, which is symmetric, too.

   Weights are those of the sums over points (mpm_heat_body.cpp), with which temperatures that vary linearly are exact
   wherever the face is in a cell, and in material that is too thin for these those of the functions at the face. Nodes outside
   of the box may have next to no points, and the latter do not know of that: finite heat in a node without
   capacity. Hence the weight of a node counts in full only if half of the volume is there that it has where
   material fills the box, and in proportion to it below.

   Convection and radiation: the temperature at a face follows that outside with the rate r = R dP/dT of a line, with its
   response R and the power P. As at other surfaces (mpm_heat_surface.cpp) this rate is limited to l. Lines of faces normal to
   several axes take turns, each with the rates that the one before has left: (1 - (1 - l/r_1) Pi_1) (1 - (1 - l/r_2) Pi_2)
   in terms of the projections to their temperatures, which commute at the edges and corners of a block. What
   follows there is at most as fast as the sum of the rates of all axes.

   How near is material? Along a line, sum_k w_k V_k over what it is where material fills the box up to the
   face, is 1 without a gap, 0.7 with one of a quarter of a cell, and 0.46 with half a cell (quadratic). At the
   sides of a body, lines have points on one side only; the fullest of the nodes of a line tells how many.
------------------------------------------------------------------------- */

#include "mpm_heat_faces.h"

#include "domain.h"
#include "math_special.h"
#include "mpm_field.h"
#include "mpm_frame.h"
#include "mpm_heat_body.h"
#include "mpm_stencil.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// sum of weights by the surface, of the area
static constexpr double THICK = 0.9;
static constexpr double ENOUGH = 0.5;    // of the volume of a node, for its whole weight
// from how near on material touches a face, and is all at it
static constexpr double TOUCHES = 0.6, IS_AT_FACE = 0.75;
// sums over points are not exactly integrals: a line from here on is full, and what is between
static constexpr double FULL = 0.95, NOT_FULL = 0.8;

/* ---------------------------------------------------------------------- */

/** Weights of nodes at a place along an axis. Functions of points of finite size depend on the point: a face has the linear
 *  ones, which they are made of. */
static int weights_at(const MPMField &field, const MPMStencil &stencil, double t, int &first,
                      double *w)
{
  if (!field.boxes) return stencil.weights(t, first, w);
  first = static_cast<int>(std::floor(t));
  w[1] = t - first;
  w[0] = 1.0 - w[1];
  return 2;
}

void MPMHeatFaces::init(double sigma_of_units)
{
  sigma = sigma_of_units;
  std::fill_n(last, 3, 0.0);
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
    f.n = weights_at(field, stencil, at, f.first, f.weight);

    // integrals of functions over the inside, by the midpoint rule

    constexpr int SAMPLES = 1024, REACH = 4;
    for (int k = 0; k < REACH * SAMPLES; k++) {
      const double depth = (k + 0.5) / SAMPLES;
      int first;
      double w[MOST];
      const int n = weights_at(field, stencil, face % 2 ? at - depth : at + depth, first, w);
      for (int j = 0; j < n; j++)
        if (first + j >= f.first && first + j < f.first + f.n)
          f.full[first + j - f.first] += w[j] / SAMPLES;
    }
    if (conditions[face].kind == MPMHeatCondition::TEMPERATURE) held |= 1 << f.axis;
    faces.push_back(f);
  }
  crossing = (held & (held - 1)) != 0;
}

double MPMHeatFaces::limit(double cap, const double rates[3])
{
  fastest = cap;
  double sum = 0.0;
  for (int axis = 0; axis < 3; axis++) sum += std::min(cap, last[axis] = rates[axis]);
  return sum;
}

/** Where material fills the box, the response of a line times its area and h is up to 1.9/capacity, and up to twice that in lines
 *  whose nodes have only half of their volume. A rate that is not known is the limit. */
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

/* ---------------------------------------------------------------------- */

void MPMHeatFaces::extend_topology()
{
  Grid &grid = field.grid;
  // blocks that are added are looked at, too: lines along another axis
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
}

/** Length of the circle of a node around an axis of symmetry; 1 without one. */
double MPMHeatFaces::circle(int64_t node) const
{
  return field.frame->node_circle((int) (node / NODES_PER_BLOCK), (int) (node % NODES_PER_BLOCK));
}

/* ---------------------------------------------------------------------- */

void MPMHeatFaces::prepare(const Face &face, Line &line, const std::vector<double> &capacity,
                           const std::vector<double> &volume, const MPMHeatBody *body) const
{
  const Grid &grid = field.grid;
  const double cell = grid.lattice.cell_volume();
  std::fill_n(line.weight, MOST, 0.0);
  double part[MOST] = {}, most = 0.0, there = 0.0, full = 0.0;
  for (int k = 0; k < face.n; k++) {
    const double V = volume[line.node[k]] / (cell * circle(line.node[k]));
    there += face.weight[k] * V;
    full += face.weight[k] * face.full[k];
    if (!(face.full[k] > 0.0) || !(capacity[line.node[k]] > 0.0)) continue;
    part[k] = V / face.full[k];
    if (face.weight[k] > 0.0) most = std::max(most, part[k]);
  }
  if (!(most > 0.0)) return;
  const double near = there / (full * most);
  if (!(near > TOUCHES)) return;

  const double aside =
      most < NOT_FULL ? most : NOT_FULL + (most - NOT_FULL) * (1.0 - NOT_FULL) / (FULL - NOT_FULL);
  line.area = std::min(1.0, aside) * cell / grid.lattice.h *
      (face.axis ? circle(line.node[0]) : field.frame->circle(face.x)) *
      std::min(1.0, (near - TOUCHES) / (IS_AT_FACE - TOUCHES));
  if (!weigh_by_surface(face, line, body)) {
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

/* ----------------------------------------------------------------------
   Weights of the sums over points, see mpm_heat_body.cpp. Around an axis of symmetry it is a flux in proportion to 1/r
   that is in equilibrium. Where material is too thin, that of the other side of it reduces these sums.
------------------------------------------------------------------------- */

bool MPMHeatFaces::weigh_by_surface(const Face &face, Line &line, const MPMHeatBody *body) const
{
  if (!body) return false;
  double weight[MOST], sum = 0.0;
  for (int k = 0; k < face.n; k++) {
    const double G = body->gradient[3 * line.node[k] + face.axis] / circle(line.node[k]);
    weight[k] = std::max(0.0, face.face % 2 ? G : -G) * body->conducting(line.node[k]);
    sum += weight[k];
  }
  const double length = face.axis ? circle(line.node[0]) : field.frame->circle(face.x);
  if (!(length * sum > THICK * line.area)) return false;
  for (int k = 0; k < face.n; k++) line.weight[k] = weight[k] / sum;
  return true;
}

void MPMHeatFaces::mark_near(std::vector<char> &near) const
{
  for (const auto &face : faces)
    for (const auto &line : face.lines)
      for (int k = 0; k < face.n; k++) near[line.node[k] / NODES_PER_BLOCK] = 1;
}

void MPMHeatFaces::begin_step(const std::vector<double> &capacity,
                              const std::vector<double> &volume, const MPMHeatBody *body,
                              const std::vector<double> &temperature, double rates[3])
{
  for (auto &face : faces) {
    const auto &condition = conditions[face.face];
    for (auto &line : face.lines) {
      line.response = line.area = line.rate = 0.0;
      prepare(face, line, capacity, volume, body);
      if (condition.kind <= MPMHeatCondition::FLUX) continue;
      double T = 0.0;
      for (int k = 0; k < face.n; k++) T += line.weight[k] * temperature[line.node[k]];
      line.rate = line.area * line.response * condition.slope(T, sigma);
      rates[face.axis] = std::max(rates[face.axis], line.rate);
    }
  }
}

/* ---------------------------------------------------------------------- */

double MPMHeatCondition::flux(double T, double sigma) const
{
  using MathSpecial::square;
  if (kind == INSULATED) return 0.0;
  if (kind == FLUX) return now[0];
  if (kind == CONVECTION) return now[0] * (now[1] - T);
  return now[0] * sigma * (square(square(now[1])) - square(square(T)));
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
  const auto visit = [&](const Face &face) {
    if (conditions[face.face].kind != MPMHeatCondition::TEMPERATURE) return;
    for (const auto &line : face.lines)
      if (line.response > 0.0) f(face, line);
  };
  for (const auto &face : faces) visit(face);
  if (!crossing) return;
  for (auto face = faces.rbegin() + 1; face < faces.rend(); ++face) visit(*face);
}

void MPMHeatFaces::hold(std::vector<double> &temperature, Heats &heat) const
{
  visit_held([&](const Face &face, const Line &line) {
    double T = 0.0;
    for (int k = 0; k < face.n; k++) T += line.weight[k] * temperature[line.node[k]];
    const double needed = (conditions[face.face].now[0] - T) / line.response;
    for (int k = 0; k < face.n; k++) temperature[line.node[k]] += needed * line.change[k];
    heat[face.face] += needed * line.owned;
  });
}

void MPMHeatFaces::add_rates(const std::vector<double> &temperature, std::vector<double> &rate,
                             Heats &power) const
{
  const auto visit = [&](bool follows, const auto &power_of) {
    bool any = false;
    for (const auto &face : faces) {
      const auto &condition = conditions[face.face];
      if (condition.kind == MPMHeatCondition::TEMPERATURE ||
          (condition.kind != MPMHeatCondition::FLUX) != follows)
        continue;
      any = true;
      for (const auto &line : face.lines) {
        if (!(line.area > 0.0)) continue;
        const double more = power_of(condition, line, face.n);
        for (int k = 0; k < face.n; k++) rate[line.node[k]] += more * line.change[k];
        power[face.face] += more * line.owned;
      }
    }
    return any;
  };
  visit(false, [&](const auto &condition, const Line &line, int) {
    return line.area * condition.flux(0.0, sigma);
  });
  hold_rates(rate, power);
  const bool any = visit(true, [&](const auto &condition, const Line &line, int n) {
    double T = 0.0, drift = 0.0;
    for (int k = 0; k < n; k++) {
      T += line.weight[k] * temperature[line.node[k]];
      drift += line.weight[k] * rate[line.node[k]];
    }
    const double P = line.area * condition.flux(T, sigma);
    if (line.rate <= fastest) return P;
    const double slower = fastest / line.rate;
    return slower * P - (1.0 - slower) * drift / line.response;
  });
  if (any) hold_rates(rate, power);
}

void MPMHeatFaces::hold_rates(std::vector<double> &rate, Heats &power) const
{
  visit_held([&](const Face &face, const Line &line) {
    double drift = 0.0;
    for (int k = 0; k < face.n; k++) drift += line.weight[k] * rate[line.node[k]];
    const double needed = -drift / line.response;
    for (int k = 0; k < face.n; k++) rate[line.node[k]] += needed * line.change[k];
    power[face.face] += needed * line.owned;
  });
}

double MPMHeatFaces::memory_usage() const
{
  double bytes = 0.0;
  for (const auto &face : faces) bytes += face.lines.capacity() * sizeof(Line);
  return bytes;
}
