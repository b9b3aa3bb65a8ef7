/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Where both bodies have the same share of the volume of a node along a line of nodes, their
   surfaces are next to each other. Each has its own weights there (mpm_heat_body.cpp), which also
   show the distance of its surface. The area is the smaller one of the two, so that a small body on
   a large one exchanges heat through its own area.

   The exchange at such a place, with the temperatures T_a, T_b of both surfaces, their responses R
   to heat, the rates D of their temperatures by all other heat, and the area A of which the line
   has the share s,

     d(T_a - T_b)/dt = D_a - D_b - r (T_a - T_b),   r = h_c A (R_a + R_b)/s,

   is stiff for a large h_c: then T_a - T_b follows D_a - D_b at once. Hence the difference of T_a -
   T_b from (D_a - D_b)/r is made to decay with the rate l = min(r, limit) instead of r:

     P = (l/r) h_c A (T_a - T_b) + (1 - l/r) s (D_a - D_b)/(R_a + R_b)

   is the power from a to b. It is h_c A (T_a - T_b) if r is below the limit, and in any case when
   nothing changes, and tends to perfect contact with h_c. With the projections Pi to the
   differences (in the norm of capacities, in which conduction is symmetric), and S = 1 - sum (1 -
   l/r) s Pi, the matrix of all rates is S K - sum l s Pi = S (K - sum r s Pi'), similar to a
   symmetric one whose eigenvalues are not below those of the conduction K less the limit: steps
   that are stable with the sum of both are stable whatever h_c is.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_contact.h"

#include "comm.h"
#include "field/mpm_field.h"
#include "heat/mpm_conduction.h"
#include "heat/mpm_heat_thin.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMHeatContact::MPMHeatContact(LAMMPS *lmp, MPMHeatBody &a, MPMHeatBody &b,
                               const MPMHeatPair &pair) :
    Pointers(lmp),
    body{&a, &b}, pair(pair)
{
}

/* ---------------------------------------------------------------------- */

void MPMHeatContact::extend_topology(const MPMField &field)
{
  if (comm->nprocs == 1) return;
  for (auto *one : body) {
    if (&one->field != &field) continue;
    const auto nblocks = (int) field.grid.blocks.size();
    for (int ib = 0; ib < nblocks; ib++) {
      const int b[3] = {field.grid.blocks[ib].b[0], field.grid.blocks[ib].b[1],
                        field.grid.blocks[ib].b[2]};
      one->activate_around(b);
    }
  }
}

void MPMHeatContact::list_common_blocks()
{
  common.clear();
  const Grid &first = body[0]->field.grid, &second = body[1]->field.grid;
  for (std::size_t slot = 0; slot < first.blocks.size(); slot++) {
    const auto &block = first.blocks[slot];
    const int other = second.find(block.b);
    if (other >= 0) common.push_back({{(int) slot, other}, ~block.alias});
  }
  listed = true;
}

/* ----------------------------------------------------------------------
   Finds blocks with nodes that both bodies have, and those around them.
------------------------------------------------------------------------- */

void MPMHeatContact::mark_near()
{
  if (!listed) list_common_blocks();
  const auto has_mass = [&](int k, int slot, int n) {
    return body[k]->field.grid.record(slot, n)[3] > 0.0;
  };
  for (const auto &c : common)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(c.canonical >> n & 1) || !has_mass(0, c.slot[0], n) || !has_mass(1, c.slot[1], n))
        continue;
      for (int k = 0; k < 2; k++)
        for (const int next : body[k]->field.grid.blocks[c.slot[k]].slot)
          if (next >= 0) body[k]->near[next] = 1;
      break;
    }
}

/* ----------------------------------------------------------------------
   Finds a contact between the nodes a (of the first body) and b, next to it along an axis.
------------------------------------------------------------------------- */

bool MPMHeatContact::make_place(int axis, const int *index, int64_t a, int64_t b, Place &place,
                                MPMHeatThin *thin, int entry) const
{
  const auto &lattice = body[0]->field.lattice;
  int next[3] = {index[0], index[1], index[2]};
  next[axis] = lattice.wrap(axis, next[axis] + 1);
  const int64_t here[2] = {a, body[1]->field.grid.locate(index)};
  const int64_t there[2] = {b, body[1]->field.grid.locate(next)};
  if (here[1] < 0 || there[0] < 0 || there[1] < 0) return false;
  double more[2] = {0.0, 0.0};
  for (int k = 0; k < 2; k++) {
    const double sign = k ? -1.0 : 1.0;
    more[0] += sign * body[k]->share[here[k]];
    more[1] += sign * body[k]->share[there[k]];
  }
  if ((more[0] < 0.0) == (more[1] < 0.0)) return false;
  const double part = more[0] / (more[0] - more[1]);
  double normal[3] = {0.0, 0.0, 0.0};    // from the first body to the second one
  for (int d = 0; d < lattice.dim; d++)
    for (int k = 0; k < 2; k++) {
      const double sign = k ? -1.0 : 1.0;
      normal[d] += sign *
          ((1.0 - part) * body[k]->gradient[3 * here[k] + d] +
           part * body[k]->gradient[3 * there[k] + d]);
    }
  const double length = MathExtra::len3(normal);
  if (!(length > 0.0)) return false;
  for (double &x : normal) x /= length;
  place.share = heat_share_of_axis(normal, lattice.dim, axis);
  if (place.share == 0.0) return false;
  const double back[3] = {-normal[0], -normal[1], -normal[2]};
  for (int k = 0; k < 2; k++)
    if (!body[k]->make_line(axis, index, index[axis] + part, k ? normal : back, place.line[k]))
      return false;
  const double gap = (place.line[1].place - place.line[0].place) * normal[axis];
  const double near = body[0]->touches(gap);
  if (!(near > 0.0)) return false;
  place.area = place.share * near * std::min(place.line[0].area, place.line[1].area) /
      std::fabs(normal[axis]);
  std::copy_n(normal, 3, place.normal);
  place.key = a * lattice.dim + axis;
  if (thin) {
    double at[3] = {(double) index[0], (double) index[1], (double) index[2]};
    at[axis] += part;
    for (int k = 0; k < 2; k++) thin->take(entry, *body[k], at, k ? normal : back, place.area);
  }
  return true;
}

void MPMHeatContact::find_contacts(MPMHeatThin *thin, int entry)
{
  places.clear();
  const Grid &grid = body[0]->field.grid;
  for (const auto &c : common)
    for (int n = 0; body[0]->near[c.slot[0]] && n < NODES_PER_BLOCK; n++) {
      if (!(c.canonical >> n & 1)) continue;
      const auto &block = grid.blocks[c.slot[0]];
      int index[3];
      grid.node_index(block, n, index);
      for (int a = 0; a < grid.lattice.dim; a++) {
        int next[3] = {index[0], index[1], index[2]};
        next[a] = grid.lattice.wrap(a, next[a] + 1);
        Place place;
        if (make_place(a, index, (int64_t) c.slot[0] * NODES_PER_BLOCK + n, grid.locate(next),
                       place, thin, entry))
          places.push_back(place);
      }
    }
  if (comm->nprocs == 1) return;
  shares.begin(*body[0]);
  for (const auto &place : places) shares.count(place.key);
  shares.sum(*body[0]);
  for (auto &place : places) {
    place.share *= shares.of(place.key);
    place.area *= shares.of(place.key);
  }
}

/* ---------------------------------------------------------------------- */

double MPMHeatContact::begin_step()
{
  double most = 0.0;
  for (auto &place : places) {
    place.rate = 0.0;
    if (!body[0]->find_response(place.line[0]) || !body[1]->find_response(place.line[1])) continue;
    const double conducting = std::min(place.line[0].conducting, place.line[1].conducting);
    place.area *= conducting;
    place.share *= conducting;
    place.response = place.line[0].response + place.line[1].response;
    place.rate = pair.now * place.area * place.response / place.share;
    most = std::max(most, place.rate);
  }
  return most;
}

void MPMHeatContact::note_edges() const
{
  for (const auto &place : places) {
    if (!(place.rate > 0.0)) continue;
    double into[3];
    for (int k = 0; k < 2; k++) {
      for (int d = 0; d < 3; d++) into[d] = k ? place.normal[d] : -place.normal[d];
      body[k]->note(place.line[k], into, place.share);
    }
  }
}

void MPMHeatContact::limit(double cap)
{
  fastest = cap;
  const double conduction =
      std::min(body[0]->conduction->bound_of_rates(), body[1]->conduction->bound_of_rates());
  for (auto &place : places) {
    if (!(place.rate > conduction)) continue;
    if (!body[0]->is_edge(place.line[0]) && !body[1]->is_edge(place.line[1])) continue;
    place.area *= conduction / place.rate;
    place.rate = conduction;
  }
}

bool MPMHeatContact::is_symmetric() const
{
  for (const auto &place : places)
    if (place.rate > fastest) return false;
  return true;
}

void MPMHeatContact::each_term(const MPMHeatBody &of, const MPMDiffusion::Term &use) const
{
  for (const auto &place : places) {
    if (!(place.rate > 0.0)) continue;
    const auto &line = place.line[body[1] == &of];
    const double stiffness = std::min(1.0, fastest / place.rate) * pair.now * place.area;
    line.add_term(stiffness, use);
  }
}

void MPMHeatContact::exchange(double &power) const
{
  for (const auto &place : places) {
    if (!(place.rate > 0.0)) continue;
    const auto &[a, b] = place.line;
    const double slower = std::min(1.0, fastest / place.rate);
    double P = slower * pair.now * place.area * (body[0]->temperature(a) - body[1]->temperature(b));
    if (slower < 1.0)
      P += (1.0 - slower) * place.share * (body[0]->drift(a) - body[1]->drift(b)) / place.response;
    body[0]->give(a, -P);
    body[1]->give(b, P);
    power += P;
  }
}

double MPMHeatContact::memory_usage() const
{
  return places.capacity() * sizeof(Place) + common.capacity() * sizeof(Common);
}
