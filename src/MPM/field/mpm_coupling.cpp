/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_coupling.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_pair_styles.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_setup_checks.h"
#include "fix.h"
#include "force.h"
#include "modify.h"
#include "pair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace LAMMPS_NS;

/** Fields of one body, on lattices of several spacings, are one. */
void MPMUncoupled::find_matter()
{
  list.clear();
  const auto bodies = find_fixes<MPMRefinedBody>(lmp);
  const std::vector<Fix *> fixes = modify->get_fix_list();    // a copy, as each call makes it anew
  for (const auto *fix : fixes) {
    const std::string style = fix->style, id = fix->id;
    if (style == "mpm") {
      const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const MPMRefinedBody *one) {
        return one->has(id);
      });
      const auto same = body == bodies.end()
          ? list.end()
          : std::find_if(list.begin(), list.end(), [&](const Matter &other) {
              return other.kind == FIELD && (*body)->has(other.ids[0]);
            });
      const double h = MPMField::find(lmp, id)->lattice.h;
      if (same == list.end()) {
        list.push_back({fix, FIELD, {id}, fix->groupbit, h});
      } else {
        same->ids.push_back(id);
        same->bits |= fix->groupbit;
        same->h = std::max(same->h, h);
      }
    } else if (const auto *fluid = dynamic_cast<const MPMFluid *>(fix)) {
      list.push_back({fix, FLOW, {id}, fix->groupbit, fluid->spacing()});
    } else if (style == "mpm/mesh") {
      list.push_back({fix, MESH, {id}, fix->groupbit, 0.0});
    } else if (dynamic_cast<const MPMInternalForce *>(fix)) {
      const auto fields = MPMField::all(lmp);
      const bool on_lattice = std::any_of(fields.begin(), fields.end(), [&](const MPMField *field) {
        return points_in_both(lmp, fix->groupbit, field->fix.groupbit) > 0;
      });
      if (!on_lattice) list.push_back({fix, ELEMENTS, {id}, fix->groupbit, 0.0});
    }
  }
  if (list.empty()) return;
  // last, as the first of the list looks, and these do not
  for (const auto *fix : fixes)
    if (fix->time_integrate && !utils::strmatch(fix->style, "^mpm"))
      list.push_back({fix, GRAINS, {fix->id}, fix->groupbit, 0.0});
  for (const auto *fix : fixes)
    if (const auto *body = dynamic_cast<const MPMSolidBody *>(fix))
      list.push_back({fix, RIGID, {fix->id}, 0, 0.0, body});
}

/** Does this atom belong to the matter? */
bool MPMUncoupled::has(const Matter &matter, int i) const
{
  return (atom->mask[i] & matter.bits) && (atom->vfrac[i] > 0.0) == (matter.kind != GRAINS);
}

/** [type] Are there atoms of this type? Collective. */
std::vector<int> MPMUncoupled::types_of(const Matter &matter) const
{
  const int n = atom->ntypes + 1;
  std::vector<int> mine(n, 0), all(n);
  for (int i = 0; i < atom->nlocal; i++)
    if (has(matter, i)) mine[atom->type[i]] = 1;
  MPI_Allreduce(mine.data(), all.data(), n, MPI_INT, MPI_MAX, world);
  return all;
}

/** Is there a pair force between points of both, or between these and grains? Styles of this
 *  package act between some kinds only, and style zero between none. */
static bool can_feel_pairs(const Force &force, bool fields, bool elements)
{
  const auto styles = MPMPairStyle::all(force);
  return std::any_of(styles.begin(), styles.end(), [&](const MPMPairStyle &style) {
    if (style.name == "mpm/penalty") return fields;
    if (style.name == "mpm/sheet") return elements;
    return style.name != "zero";
  });
}

bool MPMUncoupled::feel_pairs(const Matter &a, const Matter &b) const
{
  if (!can_feel_pairs(*force, a.kind == FIELD && b.kind == FIELD,
                      a.kind == ELEMENTS || b.kind == ELEMENTS))
    return false;
  const auto of_a = types_of(a), of_b = types_of(b);
  for (int i = 1; i <= atom->ntypes; i++)
    for (int j = 1; j <= atom->ntypes; j++)
      if (of_a[i] && of_b[j] && force->pair->cutsq[i][j] > 0.0) return true;
  return false;
}

/** Local indices of the grains that neither pair forces nor a fix couple to the points. They may
 *  come later, and be of several kinds. Collective. */
std::vector<int> MPMUncoupled::free_grains(const Matter &points, const Matter &grains) const
{
  int coupled = 0;
  for (const auto *coupling : find_fixes<MPMCoupling>(lmp))
    for (const auto &id : points.ids) coupled |= coupling->atoms_coupled_to(id);
  std::vector<char> feels(atom->ntypes + 1, 0);
  if (can_feel_pairs(*force, false, false)) {
    const auto types = types_of(points);
    for (int i = 1; i <= atom->ntypes; i++)
      for (int j = 1; j <= atom->ntypes; j++)
        if (types[i] && force->pair->cutsq[i][j] > 0.0) feels[j] = 1;
  }
  std::vector<int> found;
  for (int i = 0; i < atom->nlocal; i++)
    if (has(grains, i) && !(atom->mask[i] & coupled) && !feels[atom->type[i]]) found.push_back(i);
  return found;
}

/** Is a point inside of a grain that does not feel it, or in its half of a cell? Only those of one
 *  rank are compared: a grain that goes through a body has points on its own rank sooner or later.
 *  Collective. */
bool MPMUncoupled::reach(const Matter &points, const Matter &grains) const
{
  const auto found = free_grains(points, grains);
  const int dim = domain->dimension;
  const auto reach_of = [&](int i) {
    return std::max(atom->radius_flag ? atom->radius[i] : 0.0, 0.5 * points.h);
  };
  double cell = 0.0, lo[3] = {0.0, 0.0, 0.0}, hi[3] = {0.0, 0.0, 0.0};
  for (const int i : found) {
    const bool first = i == found[0];
    cell = std::max(cell, reach_of(i));
    for (int d = 0; d < dim; d++) {
      lo[d] = first ? atom->x[i][d] : std::min(lo[d], atom->x[i][d]);
      hi[d] = first ? atom->x[i][d] : std::max(hi[d], atom->x[i][d]);
    }
  }

  // grains in the order of their cells

  using Cell = std::array<int64_t, 3>;
  const auto cell_of = [&](const double *x) {
    Cell k = {0, 0, 0};
    for (int d = 0; d < dim; d++) k[d] = (int64_t) std::floor((x[d] - lo[d]) / cell);
    return k;
  };
  std::vector<std::pair<Cell, int>> order;
  for (const int i : found)
    if (cell > 0.0) order.emplace_back(cell_of(atom->x[i]), i);
  std::sort(order.begin(), order.end());
  const auto touches = [&](const double *x) {
    for (int d = 0; d < dim; d++)
      if (!(x[d] > lo[d] - cell && x[d] < hi[d] + cell)) return false;
    const Cell at = cell_of(x);
    for (int64_t dx = -1; dx <= 1; dx++)
      for (int64_t dy = -1; dy <= 1; dy++) {
        const int64_t dz = dim == 3 ? 1 : 0;    // these are one after the other
        auto one = std::lower_bound(order.begin(), order.end(),
                                    std::pair<Cell, int>{{at[0] + dx, at[1] + dy, at[2] - dz}, -1});
        for (; one != order.end() && one->first <= Cell{at[0] + dx, at[1] + dy, at[2] + dz};
             ++one) {
          double squared = 0.0;
          for (int d = 0; d < dim; d++) {
            const double r = x[d] - atom->x[one->second][d];
            squared += r * r;
          }
          const double far = reach_of(one->second);
          if (squared < far * far) return true;
        }
      }
    return false;
  };
  int mine = 0, all;
  for (int i = 0; i < atom->nlocal && !mine && !order.empty(); i++)
    mine = has(points, i) && touches(atom->x[i]);
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, world);
  return all;
}

/** Is a point or grain inside of the body? Collective. */
bool MPMUncoupled::is_inside(const Matter &matter, const Matter &body) const
{
  int mine = 0, all;
  for (int i = 0; i < atom->nlocal && !mine; i++)
    mine = has(matter, i) && body.body->has_inside(atom->x[i]);
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, world);
  return all;
}

bool MPMUncoupled::are_coupled(const Matter &a, const Matter &b) const
{
  // rigid bodies tell of each other, and grains among them are left to LAMMPS
  if (a.kind >= GRAINS && a.kind == b.kind) return true;
  if (b.kind == RIGID) return b.body->acts_on(a.ids[0]);
  if (b.kind == GRAINS) return false;    // they may still come, see free_grains()
  for (const auto *coupling : find_fixes<MPMCoupling>(lmp))
    for (const auto &one : a.ids)
      for (const auto &other : b.ids)
        if (coupling->couples(one, other)) return true;
  // elements that have nodes in both hold them together, as the seam of a bag does
  for (const auto *body : find_fixes<MPMInternalForce>(lmp))
    if (points_in_both(lmp, body->group_of_points(), a.bits) > 0 &&
        points_in_both(lmp, body->group_of_points(), b.bits) > 0)
      return true;
  return feel_pairs(a, b);
}

/** In the first step, when all fixes know what they move: pairs that nothing couples. */
void MPMUncoupled::find_pairs()
{
  is_new = false;
  countdown = 0;
  find_matter();
  if (list.empty() || list[0].fix != mine) return;
  const int n = (int) list.size();
  for (int a = 0; a < n; a++)
    for (int b = a + 1; b < n; b++)
      if (!warned.count({list[a].ids[0], list[b].ids[0]}) && !are_coupled(list[a], list[b]))
        pairs.push_back({a, b});
}

/** Have the extents of points of both a part in common? Those along periodic axes are of all
 *  images. Collective. */
bool MPMUncoupled::meet(const Matter &a, const Matter &b) const
{
  constexpr double FAR = std::numeric_limits<double>::max();
  double mine[12], all[12];    // minus the lowest place, the highest one
  std::fill_n(mine, 12, -FAR);
  for (int i = 0; i < atom->nlocal; i++)
    for (int k = 0; k < 2; k++) {
      if (!has(k ? b : a, i)) continue;
      for (int d = 0; d < 3; d++) {
        mine[6 * k + d] = std::max(mine[6 * k + d], -atom->x[i][d]);
        mine[6 * k + 3 + d] = std::max(mine[6 * k + 3 + d], atom->x[i][d]);
      }
    }
  MPI_Allreduce(mine, all, 12, MPI_DOUBLE, MPI_MAX, world);
  const double margin = std::max(a.h, b.h);
  for (int d = 0; d < domain->dimension; d++) {
    if (all[d] == -FAR || all[6 + d] == -FAR) return false;    // no points
    if (domain->periodicity[d]) continue;
    if (-all[d] > all[9 + d] + margin || -all[6 + d] > all[3 + d] + margin) return false;
  }
  return true;
}

static std::string text_of(const Fix &fix, const char *what)
{
  return fmt::format("{} fix {} (style {})", what, fix.id, fix.style);
}

void MPMUncoupled::compare()
{
  countdown = STEPS;
  const auto is_known = [&](const std::array<int, 2> &pair) {
    const Matter &a = list[pair[0]], &b = list[pair[1]];
    const bool found = b.kind == RIGID ? is_inside(a, b)
        : b.kind == GRAINS             ? reach(a, b)
                                       : meet(a, b);
    if (!found) return false;
    warned.insert({a.ids[0], b.ids[0]});
    if (comm->me == 0)
      error->warning(FLERR,
                     "{} and {} meet, and go through each other, as nothing couples them: {}",
                     text_of(*a.fix, a.kind == GRAINS ? "Grains of" : "Points of"),
                     text_of(*b.fix,
                             b.kind == RIGID        ? "the body of"
                                 : b.kind == GRAINS ? "grains of"
                                                    : "of"),
                     remedy(a, b));
    return true;
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_known), pairs.end());
}

/** What makes points feel grains. */
std::string MPMUncoupled::remedy_for_grains(const Matter &points) const
{
  if (points.kind == FLOW)
    return fmt::format("use fix mpm/immersed with {} for grains smaller than its cells; for larger "
                       "ones a fix mpm with eos tait for the fluid, pair_style granular, and fix "
                       "mpm/surface",
                       points.fix->id);
  if (points.kind != FIELD) return "use pair_style granular, and set ... diameter for the points";
  if (MPMField::find(lmp, points.fix->id)->options.axisymmetric)
    return "around an axis of symmetry grains would be rings: use 3d";
  return fmt::format("use pair_style granular and fix mpm/surface; fix mpm/immersed with {} for "
                     "grains in a fluid that are smaller than its cells",
                     points.fix->id);
}

/** What makes them feel each other. */
std::string MPMUncoupled::remedy(const Matter &first, const Matter &second) const
{
  const bool in_order = first.kind <= second.kind;
  const Matter &a = in_order ? first : second, &b = in_order ? second : first;
  if (b.kind == RIGID && a.kind == GRAINS)
    return "use fix rigid with spheres for the body, or a stiff body of fix mpm and fix "
           "mpm/surface";
  if (b.kind == RIGID && a.kind == FLOW)
    return fmt::format("use a fix mpm with eos tait in place of {}", a.fix->id);
  if (b.kind == RIGID)
    return "use a fix mpm for these points, in place of the fix that moves them: bodies of fix "
           "mpm/rigid act on its nodes";
  if (b.kind == GRAINS) return remedy_for_grains(a);
  if (a.kind == FIELD && b.kind == FIELD) {
    for (const auto &one : a.ids)
      for (const auto &other : b.ids) {
        const auto *const f = MPMField::find(lmp, one), *const g = MPMField::find(lmp, other);
        const bool alike = f->lattice.h == g->lattice.h && f->options.shape == g->options.shape &&
            std::equal(f->lattice.origin, f->lattice.origin + 3, g->lattice.origin);
        const bool fit = !f->options.total && !g->options.total && !f->options.stress_before() &&
            !g->options.stress_before();
        if (alike && fit)
          return fmt::format(
              "use fix mpm/contact with {} and {}, or one fix mpm for both, in which "
              "they stick together",
              one, other);
      }
    const double ratio = a.h / b.h, finer = std::max(ratio, 1.0 / ratio);
    return std::string("use pair_style mpm/penalty") +
        (fabs(finer - 2.0) < 1.0e-6
             ? fmt::format(", or fix mpm/refine with {} and {} if they are one body",
                           ratio > 1.0 ? a.fix->id : b.fix->id, ratio > 1.0 ? b.fix->id : a.fix->id)
             : "");
  }
  if (a.kind == FIELD && b.kind == ELEMENTS)
    return fmt::format("use a fix mpm on the same lattice for the nodes of {} in place of the fix "
                       "that moves them, and fix mpm/contact with gap no normal volume",
                       b.fix->id);
  if (a.kind == FIELD && b.kind == FLOW)
    return fmt::format("give the points of {} to {} and to its keyword solid, or use a fix mpm "
                       "with eos tait for the fluid, and fix mpm/contact",
                       a.fix->id, b.fix->id);
  if (a.kind == FLOW && b.kind == MESH)
    return fmt::format("give the points of {} to {} and to its keyword solid", b.fix->id,
                       a.fix->id);
  if (a.kind == FLOW && b.kind == ELEMENTS)
    return "use a fix mpm with eos tait for the fluid and a second one for the nodes in place of "
           "the fix that moves them, and fix mpm/contact with gap no normal volume";
  if (a.kind == MESH && b.kind == MESH)
    return "use one fix mpm/mesh for both, and fix mpm/mesh/contact";
  if (a.kind == MESH && b.kind == ELEMENTS)
    return "use a fix mpm for each of them, in place of the mesh and of the fix that moves the "
           "nodes, and fix mpm/contact with gap no normal volume";
  return "use pair_style mpm/sheet for surfaces and lines, or a fix mpm for each of them in place "
         "of the fix that moves them, and fix mpm/contact";
}
