/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Surfaces are where a number at the nodes changes its sign between two nodes along an axis: the
   distance from a region, or, for free surfaces, the depth in the body by the share of the volume
   of a node (inside of the box) that the body fills. Lines of nodes through these places have the
   temperature T = sum_k w_k T_k of the surface, and get the heat (mpm_heat_body.cpp).

   With the power P = f (T_out - T) of a line, f = area * coefficient, T would follow the
   temperature outside with the rate r = f R/s, where R is its response to heat and s the share of
   the area that the line has. As for contacts, this rate is limited to l: where r is
   larger,

     P = (l/r) f (T_out - T) - (1 - l/r) s D/R,   D: rate of T by all other heat,

   which is f (T_out - T) when nothing changes, and with r -> infinity prescribes the temperature.

   D contains no heat of other lines of surfaces and contacts. Along a surface, lines of several
   axes through it share the area, and together count as one. At edges, lines of surfaces with other
   normals have nodes in common with a line, and its power in the steady state would depend on l,
   and thus on the time step: with the heat D' of the other lines in D, P = F + (r/l - 1) D'/R.
   Equations for all lines that cross, as at faces of the box (mpm_heat_faces.cpp), would couple all
   of an inclined surface. Instead, lines at edges get so little area that r is at most the rate of
   conduction. They are then never limited, P = F, and in these few cells the temperature of the
   surface is that of a place about a quarter of a cell beyond it.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_surface.h"

#include "comm.h"
#include "domain.h"
#include "field/mpm_field.h"
#include "heat/mpm_conduction.h"
#include "heat/mpm_heat_body.h"
#include "math_extra.h"
#include "region.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double FAR = 4.0;    // node spacings: larger distances from regions are not needed
// free surfaces this near to a region, in node spacings, are not free
static constexpr double COVERED = 0.5;
static constexpr double ALL_IN_BOX = 0.999;
static constexpr int INSIDE = 3;                // nodes inwards that show how full a body is
static constexpr double LEAST_FILLED = 0.02;    // least fullness of a line with a surface
static constexpr double LEAST_IN_BOX = 0.02;    // least share of a line of nodes inside of the box
// shares of other bodies at a free surface up to which it is open, and from which on it is hidden
static constexpr double OPEN = 0.15, HIDDEN = 0.4;

MPMHeatSurfaces::MPMHeatSurfaces(LAMMPS *lmp, MPMHeatBody &body, const Conditions &conditions,
                                 double sigma) :
    Pointers(lmp),
    body(body), conditions(conditions), sigma(sigma)
{
  for (const auto &c : conditions) {
    wall_of.push_back(c.region.empty() ? -1 : (int) walls.size());
    if (c.region.empty()) {
      has_free = true;
      continue;
    }
    Region *const region = domain->get_region_by_id(c.region);
    walls.push_back({region, MPMRegionSurface(region, domain->dimension), {}});
  }
}

bool MPMHeatSurfaces::Wall::moves() const
{
  return region->dynamic_check() || region->varshape;
}

/** Can points of this block reach the surface of a region? */
bool MPMHeatSurfaces::near_wall(Wall &wall, const int *b) const
{
  const auto &lattice = body.field.lattice;
  const int side = body.field.grid.side;
  const int first[3] = {b[0] * side, b[1] * side, b[2] * side};
  const double reach = (0.5 * side * std::sqrt((double) lattice.dim) + FAR) * lattice.h;
  double middle[3];
  lattice.node_position(first, middle);
  for (int d = 0; d < lattice.dim; d++) middle[d] += 0.5 * (side - 1) * lattice.h;
  return std::fabs(wall.surface.distance(middle, 2.0 * reach)) <= reach;
}

void MPMHeatSurfaces::extend_topology()
{
  // also with one rank, for lines through the surface of a region next to the last nodes that
  // points reach
  const bool all = has_free && comm->nprocs > 1;
  if (!all && walls.empty()) return;
  for (auto &wall : walls)
    if (!wall.moves()) wall.region->prematch();
  activate_blocks_around(body.field, [&](const int *b) {
    // a moving region may come here before blocks are found again
    return all || std::any_of(walls.begin(), walls.end(), [&](Wall &wall) {
             return wall.moves() || near_wall(wall, b);
           });
  });
}

/** Also finds the distances of nodes from regions. */
void MPMHeatSurfaces::mark_near()
{
  const Grid &grid = body.field.grid;
  const double h = grid.lattice.h;
  for (auto &wall : walls) {
    const bool fresh = wall.moves() || wall.distance.empty();
    if (fresh) {
      wall.region->prematch();
      wall.distance.assign(grid.nnodes(), FAR);
    }
    for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
      if (!fresh) {
        for (int n = 0; !body.near[slot] && n < NODES_PER_BLOCK; n++)
          body.near[slot] = std::fabs(wall.distance[slot * NODES_PER_BLOCK + n]) < FAR;
        continue;
      }
      if (!near_wall(wall, grid.blocks[slot].b)) continue;
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        const std::size_t node = slot * NODES_PER_BLOCK + n;
        double x[3];
        grid.node_position((int64_t) node, x);
        wall.distance[node] = wall.surface.distance(x, FAR * h) / h;
        if (std::fabs(wall.distance[node]) < FAR) body.near[slot] = 1;
      }
    }
  }
  if (has_free) body.want_all();
}

/** Calls f(axis, index, node, next) for pairs of neighbors, none of them a periodic image; next: -1
 *  if it has no block. */
template <class F> void MPMHeatSurfaces::each_pair(const F &f) const
{
  const Grid &grid = body.field.grid;
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
    const auto &block = grid.blocks[slot];
    if (!body.near[slot]) continue;
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (block.alias >> n & 1) continue;
      int index[3];
      grid.node_index(block, n, index);
      for (int a = 0; a < grid.lattice.dim; a++) {
        const int here = index[a];
        index[a] = grid.lattice.wrap(a, here + 1);
        const int64_t next = index[a] > here ? grid.locate_near(block, index) : grid.locate(index);
        index[a] = here;
        f(a, index, (int64_t) (slot * NODES_PER_BLOCK + n), next);
      }
    }
  }
}

/** Surface of a region: material is where the distance is not negative. */
void MPMHeatSurfaces::find_wall(int condition, Wall &wall, MPMHeatThin *thin)
{
  const auto &lattice = body.field.lattice;
  const double h = lattice.h;
  const auto &distance = wall.distance;
  each_pair([&](int a, const int *index, int64_t node, int64_t next) {
    if (next < 0 || (distance[node] < 0.0) == (distance[next] < 0.0)) return;
    const double part = distance[node] / (distance[node] - distance[next]);
    double x[3], into[3];
    lattice.node_position(index, x);
    // on the surface itself, rounding would decide on the side
    x[a] += (part + (distance[next] < 0.0 ? -0.05 : 0.05)) * h;
    wall.surface.normal(x, FAR * h, 1.0e-4 * h, into);
    Place place;
    place.share = heat_share_of_axis(into, lattice.dim, a);
    const double at = index[a] + part;
    if (place.share == 0.0 || !body.make_line(a, index, at, into, place.line)) return;
    const double gap = (place.line.place - at) * into[a];
    const double touches = body.touches(gap);
    if (!(touches > 0.0)) return;
    place.area = place.share * touches * place.line.area / std::fabs(into[a]);
    std::copy_n(into, 3, place.into);
    place.condition = condition;
    place.key = node * lattice.dim + a;
    if (thin) thin->take(condition, body, index, a, part, into, place.area);
    keep(place, index);
  });
}

/** Adds a place or, where lines of the field share it, their places: heat goes to the end of the
 *  body, and not to a region some way off, see MPMConduction::find_ends(). */
void MPMHeatSurfaces::keep(const Place &whole, const int *index)
{
  if (!body.spreads()) {
    places.push_back(whole);
    return;
  }
  if (!body.spread(index, whole.line.place, whole.into, whole.line, parts)) return;
  for (const auto &part : parts) {
    Place place = whole;
    place.line = part.line;
    place.share *= part.share;
    place.area *= part.area;
    places.push_back(place);
  }
}

/** Share of the volume of a node that fixed faces of the box leave. */
double MPMHeatSurfaces::volume_fraction(int64_t node) const
{
  int index[3];
  body.field.grid.node_index(node, index);
  double fraction = 1.0;
  for (int d = 0; d < body.field.lattice.dim; d++) fraction *= body.fraction_in_box(d, index[d]);
  return fraction;
}

void MPMHeatSurfaces::find_filled()
{
  const int64_t nnodes = body.field.grid.nnodes();
  filled.assign(nnodes, 0.0);
  for (int64_t node = 0; node < nnodes; node++) {
    if (!(body.share[node] > 0.0)) continue;
    const double all = volume_fraction(node);
    filled[node] = all > 0.0 ? body.share[node] / all : 0.0;
  }
  body.field.nodes.complete(filled.data(), 1, 1);
}

/** The rank that counts a node of a neighbor has points of the neighbor there, and hence, in reach
 *  of this body, also the node of this body. Other ranks may have only the node of this body, and
 *  get the share of the neighbor from that rank. */
void MPMHeatSurfaces::find_covered()
{
  if (neighbors.empty()) return;
  const Grid &grid = body.field.grid;
  covered.assign(grid.nnodes(), 0.0);
  for (const auto *other : neighbors) {
    const Grid &theirs = other->field.grid;
    for (std::size_t slot = 0; slot < theirs.blocks.size(); slot++) {
      const auto &block = theirs.blocks[slot];
      const int64_t mine = grid.find(block.b);
      for (int n = 0; mine >= 0 && block.owned && n < NODES_PER_BLOCK; n++)
        if (block.owned >> n & 1)
          covered[mine * NODES_PER_BLOCK + n] += other->share[slot * NODES_PER_BLOCK + n];
    }
  }
  body.field.nodes.sum(covered.data(), 1, 0, 1);
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (covered[node] == 0.0) continue;
    const double all = body.share[node] > MPMHeatBody::ROUND_OFF ? volume_fraction(node) : 0.0;
    covered[node] = all > 0.0 ? covered[node] / all : 0.0;
  }
  body.field.nodes.complete(covered.data(), 1, 1);
}

/** Free surfaces: where half of the volume of a node that is inside of the box is filled. */
void MPMHeatSurfaces::find_free(int condition, MPMHeatThin *thin)
{
  const Grid &grid = body.field.grid;
  const auto &lattice = grid.lattice;
  const int dim = lattice.dim;
  const double h = lattice.h;
  find_filled();
  find_covered();
  bool known =
      true;    // were all nodes known? A rank with points next to a surface knows all that it needs
  const auto at = [&](const int *index) {
    int64_t node = grid.locate(index);
    if (node < 0) {
      int inside[3];
      for (int d = 0; d < 3; d++) inside[d] = lattice.wrap(d, index[d]);
      node = grid.locate(inside);
    }
    known = known && (node >= 0 || body.knows_all());
    return node < 0 ? 0.0 : filled[node];
  };
  each_pair([&](int a, const int *index, int64_t node, int64_t next) {
    const double here = filled[node], there = next < 0 ? 0.0 : filled[next];
    known = next >= 0 || body.knows_all();
    // lines at the side of a body have only a part of the volume, also inside of it: each node is
    // compared with the fullest of those further inside
    const int inward = here < there ? 1 : -1;
    double full[2], part_full[2];
    for (int k = 0; k < 2; k++) {
      int inside[3] = {index[0], index[1], index[2]};
      inside[a] += k;
      full[k] = k ? there : here;
      for (int j = 0; j < INSIDE; j++) {
        inside[a] += inward;
        full[k] = std::max(full[k], at(inside));
      }
      full[k] = std::min(full[k], 1.0);
      part_full[k] = full[k] > LEAST_FILLED ? (k ? there : here) / full[k] : 0.0;
    }
    if ((part_full[0] < 0.5) == (part_full[1] < 0.5)) return;
    const double depth = body.profile.depth_of_volume(part_full[0]),
                 depth_next = body.profile.depth_of_volume(part_full[1]);
    const double part = depth / (depth - depth_next);
    // for a surface at a node, round-off decides which of the two pairs of this node has it: both
    // must then give it the same area
    const double most = full[0] + part * (full[1] - full[0]);
    double x[3], into[3] = {0.0, 0.0, 0.0}, side = 1.0;
    lattice.node_position(index, x);
    x[a] += part * h;
    if (!lattice.periodic[a] && (x[a] < domain->boxlo[a] || x[a] > domain->boxhi[a])) return;
    for (int d = 0; d < dim; d++)
      if (d != a) side *= body.fraction_in_box(d, index[d]);
    if (side < LEAST_IN_BOX) return;
    for (int k = 0; k < 2; k++) {
      int here_k[3] = {index[0], index[1], index[2]};
      here_k[a] += k;
      const int64_t which = k ? next : node;
      const double weight = k ? part : 1.0 - part, cell = lattice.cell_volume();
      for (int d = 0; d < dim; d++) {
        int up[3] = {here_k[0], here_k[1], here_k[2]}, down[3] = {here_k[0], here_k[1], here_k[2]};
        up[d]++;
        down[d]--;
        // a body that touches a face of the box has no free surface there
        if (body.fraction_in_box(d, here_k[d]) < ALL_IN_BOX)
          into[d] += weight * 0.5 * (at(up) - at(down));
        else if (which >= 0)
          into[d] -= weight * body.gradient[3 * which + d] * h / cell;
      }
    }
    const double length = MathExtra::len3(into);
    if (!known || !(length > 0.0)) return;
    for (double &component : into) component /= length;
    Place place;
    place.share = heat_share_of_axis(into, dim, a);
    if (place.share == 0.0) return;

    for (const auto &wall : walls)
      if (std::fabs(wall.surface.distance(x, FAR * h)) < COVERED * h) return;
    double hidden = 0.0;
    if (!neighbors.empty())
      hidden = (1.0 - part) * covered[node] + (next < 0 ? 0.0 : part * covered[next]);
    const double open = std::min(1.0, (HIDDEN - hidden) / (HIDDEN - OPEN));
    if (!(open > 0.0) || !body.make_line(a, index, index[a] + part, into, place.line)) return;
    place.share *= open;
    place.area = place.share * most * side * body.circle(a, index, index[a] + part) *
        lattice.cell_volume() / (h * std::fabs(into[a]));
    std::copy_n(into, 3, place.into);
    place.condition = condition;
    place.key = node * dim + a;
    if (thin) thin->take(condition, body, index, a, part, into, place.area);
    keep(place, index);
  });
}

void MPMHeatSurfaces::find_lines(MPMHeatThin *thin)
{
  places.clear();
  for (auto &wall : walls)
    if (wall.moves()) wall.region->prematch();
  for (int k = 0; k < (int) conditions.size(); k++) {
    if (conditions[k].condition.kind == MPMHeatCondition::INSULATED) continue;
    const std::size_t begin = places.size();
    if (wall_of[k] < 0)
      find_free(k, thin);
    else
      find_wall(k, walls[wall_of[k]], thin);
    divide_among_ranks(body, places.data() + begin, places.data() + places.size(), counts);
  }
}

double MPMHeatSurfaces::begin_step()
{
  double most = 0.0;
  for (auto &place : places) {
    const auto &condition = conditions[place.condition].condition;
    if (!body.find_response(place.line)) {    // the material does not conduct
      place.share = place.area = 0.0;
      continue;
    }
    place.share *= place.line.conducting;
    place.area *= place.line.conducting;
    place.rate = condition.kind == MPMHeatCondition::TEMPERATURE
        ? std::numeric_limits<double>::max()
        : condition.slope(body.temperature(place.line), sigma) * place.area / place.share *
            place.line.response;
    most = std::max(most, place.rate);
  }
  return most;
}

void MPMHeatSurfaces::note_edges() const
{
  for (const auto &place : places)
    if (place.share > 0.0) body.note(place.line, place.into, place.share);
}

void MPMHeatSurfaces::limit(double cap, double conduction)
{
  fastest = cap;
  for (auto &place : places) {
    if (!(place.share > 0.0) || !(place.rate > conduction) || !body.is_edge(place.line)) continue;
    place.area *= conduction / place.rate;
    place.rate = conduction;
  }
}

bool MPMHeatSurfaces::linearize()
{
  bool symmetric = true;
  for (auto &place : places) {
    if (!(place.share > 0.0)) continue;
    const auto &condition = conditions[place.condition].condition;
    place.slope = condition.derivative(body.temperature(place.line), sigma);
    symmetric = symmetric && !(place.rate > fastest);
  }
  return symmetric;
}

void MPMHeatSurfaces::each_term(const MPMDiffusion::Term &use) const
{
  for (const auto &place : places) {
    if (!(place.share > 0.0)) continue;
    const auto &line = place.line;
    const bool held = conditions[place.condition].condition.kind == MPMHeatCondition::TEMPERATURE;
    const double most = fastest * place.share / line.response,
                 stiffness = held ? most : std::min(most, place.area * place.slope);
    line.add_term(stiffness, use);
  }
}

void MPMHeatSurfaces::exchange(bool changes, double *power) const
{
  for (const auto &place : places) {
    if (!(place.share > 0.0)) continue;
    const auto &condition = conditions[place.condition].condition;
    const auto &line = place.line;
    const double T = body.temperature(line);
    double P;
    const bool limited = place.rate > fastest;
    if (condition.kind == MPMHeatCondition::TEMPERATURE) {
      P = std::min(place.rate, fastest) * ((changes ? 0.0 : condition.now[0]) - T);
      if (limited) P -= body.drift(line);
      P *= place.share / line.response;
    } else {
      const double slower = limited ? fastest / place.rate : 1.0;
      P = slower * place.area * (changes ? -place.slope * T : condition.flux(T, sigma));
      if (slower < 1.0) P -= (1.0 - slower) * place.share * body.drift(line) / line.response;
    }
    body.give(line, P);
    power[place.condition] += P;
  }
}

double MPMHeatSurfaces::memory_usage() const
{
  double bytes =
      places.capacity() * sizeof(Place) + (filled.capacity() + covered.capacity()) * sizeof(double);
  for (const auto &wall : walls) bytes += wall.distance.capacity() * sizeof(double);
  return bytes;
}

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

MPMHeatContact::MPMHeatContact(LAMMPS *lmp, MPMHeatBody &a, MPMHeatBody &b,
                               const MPMHeatPair &pair) :
    Pointers(lmp),
    body{&a, &b}, pair(pair)
{
}

void MPMHeatContact::extend_topology(const MPMField &field)
{
  if (comm->nprocs == 1) return;
  for (auto *one : body)
    if (&one->field == &field) activate_blocks_around(one->field);
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

/** Finds a contact between the nodes a (of the first body) and b, next to it along an axis. */
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
  for (int k = 0; thin && k < 2; k++)
    thin->take(entry, *body[k], index, axis, part, k ? normal : back, place.area);
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
  divide_among_ranks(*body[0], places.data(), places.data() + places.size(), counts);
}

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
