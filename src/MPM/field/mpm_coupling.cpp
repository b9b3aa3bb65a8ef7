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
}

/** Is there a pair force between points of both? Styles of this package act between some kinds
 *  only, and style zero between none. */
bool MPMUncoupled::feel_pairs(const Matter &a, const Matter &b) const
{
  if (!force->pair) return false;
  const auto styles = MPMPairStyle::all(*force);
  const bool acts = std::any_of(styles.begin(), styles.end(), [&](const MPMPairStyle &style) {
    if (style.name == "mpm/penalty") return a.kind == FIELD && b.kind == FIELD;
    if (style.name == "mpm/sheet") return a.kind == ELEMENTS || b.kind == ELEMENTS;
    return style.name != "zero";
  });
  if (!acts) return false;
  const int n = atom->ntypes + 1;
  std::vector<int> mine(2 * n, 0), all(2 * n);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    if (atom->mask[i] & a.bits) mine[atom->type[i]] = 1;
    if (atom->mask[i] & b.bits) mine[n + atom->type[i]] = 1;
  }
  MPI_Allreduce(mine.data(), all.data(), 2 * n, MPI_INT, MPI_MAX, world);
  for (int i = 1; i < n; i++)
    for (int j = 1; j < n; j++)
      if (all[i] && all[n + j] && force->pair->cutsq[i][j] > 0.0) return true;
  return false;
}

bool MPMUncoupled::are_coupled(const Matter &a, const Matter &b) const
{
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

/** Extents along periodic axes are those of all images. */
void MPMUncoupled::compare()
{
  countdown = STEPS;
  const int n = (int) list.size();
  constexpr double FAR = std::numeric_limits<double>::max();
  std::vector<double> mine(6 * n, -FAR), all(6 * n);    // minus the lowest place, the highest one
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    for (int k = 0; k < n; k++) {
      if (!(atom->mask[i] & list[k].bits)) continue;
      for (int d = 0; d < 3; d++) {
        mine[6 * k + d] = std::max(mine[6 * k + d], -atom->x[i][d]);
        mine[6 * k + 3 + d] = std::max(mine[6 * k + 3 + d], atom->x[i][d]);
      }
    }
  }
  MPI_Allreduce(mine.data(), all.data(), 6 * n, MPI_DOUBLE, MPI_MAX, world);
  const auto meet = [&](int a, int b) {
    const double margin = std::max(list[a].h, list[b].h);
    for (int d = 0; d < domain->dimension; d++) {
      if (all[6 * a + d] == -FAR || all[6 * b + d] == -FAR) return false;    // no points
      if (domain->periodicity[d]) continue;
      if (-all[6 * a + d] > all[6 * b + 3 + d] + margin ||
          -all[6 * b + d] > all[6 * a + 3 + d] + margin)
        return false;
    }
    return true;
  };
  const auto is_known = [&](const std::array<int, 2> &pair) {
    const Matter &a = list[pair[0]], &b = list[pair[1]];
    if (!meet(pair[0], pair[1])) return false;
    warned.insert({a.ids[0], b.ids[0]});
    if (comm->me == 0)
      error->warning(
          FLERR,
          "Points of fix {} (style {}) and of fix {} (style {}) meet, and go through each "
          "other, as nothing couples them: {}",
          a.fix->id, a.fix->style, b.fix->id, b.fix->style, remedy(a, b));
    return true;
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_known), pairs.end());
}

/** What makes them feel each other. */
std::string MPMUncoupled::remedy(const Matter &first, const Matter &second) const
{
  const bool in_order = first.kind <= second.kind;
  const Matter &a = in_order ? first : second, &b = in_order ? second : first;
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
