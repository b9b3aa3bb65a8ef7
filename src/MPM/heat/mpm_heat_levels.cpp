/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The equations of mpm_conduction.cpp with the functions of free nodes,

     N_j + sum_i w_ij N_i over tied nodes i of the next lattice,

   which are not negative and have the sum one. What a point gives to a tied node (capacity, heat,
   flow, volume) goes to the parents of the node with the weights w_ij, and temperatures of tied
   nodes follow by the transpose: the matrix of conduction stays symmetric, and heat is kept. With
   the gradient g_p of a point, the share of N_ip C_p [T_p + g_p . (x_i - x_p)] changes by w_ij N_ip
   C_p g_p . (x_j - x_i) at the place of the parent. The sum of this over parents is zero, and
   temperatures that are linear in space are exact at the rim.

   Stability: by Cauchy and Schwarz, (sum_i w_ij grad N_i)^2/(sum_i w_ij N_i) is at most sum_i w_ij
   (grad N_i)^2/N_i, and as the weights w_ij of all parents j have the sum one, the bound for the
   points of a lattice by itself holds for them here. A row of absolute values (shape linear) is at
   most the same mean of rows of parents.

   Points of all lattices approach the temperature of their nodes at one rate, that of the largest
   cells, because heat is kept in the sum over all points, and not for each lattice.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_levels.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "heat/mpm_heat_body.h"
#include "refine/mpm_two_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

using namespace LAMMPS_NS;

/** Materials of different conductivity get means next to their interface where they share a field
 *  (MPMLayerMean), but not where the rim between two lattices is at the interface. Does this occur
 *  on this rank, with points of both in cells of the coarse lattice that touch? */
static bool has_layers_at_rim(const MPMField &coarse, const MPMField &fine)
{
  static constexpr double DIFFERENT = 1.2;
  const auto &lattice = coarse.lattice;
  const Atom &atom = *coarse.atom;
  struct Range {
    double least = std::numeric_limits<double>::max(), most = 0.0;
  };
  using Cell = std::array<int, 3>;
  const auto visit = [&](const MPMField &field, const auto &f) {
    for (int i = 0; i < atom.nlocal; i++) {
      const auto *const fix = field.is_point(i) ? field.material_of(i) : nullptr;
      if (!fix || !fix->material->conducts()) continue;
      Cell cell = {0, 0, 0};
      for (int d = 0; d < lattice.dim; d++)
        cell[d] = (int) std::floor((atom.x[i][d] - lattice.origin[d]) / lattice.h);
      f(cell, fix->material->conduction(fix->history[i]).conductivity);
    }
  };
  std::map<Cell, Range> cells;
  visit(coarse, [&](const Cell &cell, double k) {
    Range &range = cells[cell];
    range.least = std::min(range.least, k);
    range.most = std::max(range.most, k);
  });
  bool any = false;
  visit(fine, [&](const Cell &cell, double k) {
    for (int n = 0; !any && n <= 2 * lattice.dim; n++) {
      Cell next = cell;
      if (n < 2 * lattice.dim) next[n / 2] += n % 2 ? 1 : -1;
      const auto at = cells.find(next);
      if (at == cells.end()) continue;
      any = at->second.most > DIFFERENT * k || k > DIFFERENT * at->second.least;
    }
  });
  return any;
}

MPMHeatLevels::MPMHeatLevels(LAMMPS *lmp, const std::vector<Pair> &list) :
    Pointers(lmp), pairs(list)
{
  for (const auto &pair : pairs) {
    int mine = has_layers_at_rim(pair.coarse->field, pair.fine->field), all;
    MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, world);
    if (all && comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/heat: materials of different conductivity meet where the lattices of fix mpm {} "
          "and {} do: too much heat goes through, by 3 % where one conducts 10 times as well, and "
          "by 11 % for 100 times: let one lattice go on for a coarse cell in the other material",
          pair.coarse->field.id(), pair.fine->field.id());
  }
  levels.push_back(pairs[0].coarse);
  for (const auto &pair : pairs) levels.push_back(pair.fine);
  for (auto *level : levels) level->scalar.is_level = level->faces.is_level = true;
}

/** Calls f(pair, the pair after it or null), beginning with the finest lattice. */
template <class F> void MPMHeatLevels::to_parents(const F &f)
{
  for (std::size_t k = pairs.size(); k-- > 0;) f(pairs[k], after(k));
}

double MPMHeatLevels::points_to_nodes(const MPMRows &gradients, bool starts)
{
  double slowest = levels[0]->crossing_rate();
  for (const auto *level : levels) slowest = std::min(slowest, level->crossing_rate());
  for (auto *level : levels) {
    level->slowest_crossing = slowest;
    level->widest_cell = levels[0]->field.lattice.h;
    level->add_points(gradients, starts);
  }
  to_parents([&](const Pair &pair, const MPMTwoScale *finer) {
    auto &from = pair.fine->scalar, &to = pair.coarse->scalar;
    pair.nodes->moments_to_parents(
        [&](int i) {
          return pair.fine->capacity_of(i);
        },
        gradients, finer, from.value, to.value);
    pair.nodes->sums_to_parents(from.capacity, to.capacity);
    if (!from.volume.empty()) pair.nodes->sums_to_parents(from.volume, to.volume);
  });
  for (auto *level : levels) level->sum_nodes();
  temperatures_from_parents();
  double most = 0.0;
  for (auto *level : levels) most = std::max(most, level->end_nodes());
  return levels[0]->is_bounded_by_rows() ? bound_by_rows() : most;
}

/** Shape linear: bound by the rows of all lattices. Points next to tied nodes see the greatest row
 *  of the parents. */
double MPMHeatLevels::bound_by_rows()
{
  for (auto *level : levels) level->add_rows();
  to_parents([](const Pair &pair, const MPMTwoScale *) {
    pair.nodes->sums_to_parents(pair.fine->rate, pair.coarse->rate);
  });
  std::vector<double> greatest;
  for (auto *level : levels) greatest.push_back(level->most_of_rows());
  for (const auto &pair : pairs)
    pair.nodes->greatest_from_parents(pair.coarse->rate, pair.fine->rate);
  double most = 0.0;
  for (std::size_t k = 0; k < levels.size(); k++)
    most = std::max(most, levels[k]->bound_by_rows(greatest[k]));
  return most;
}

void MPMHeatLevels::sum_rates()
{
  to_parents([](const Pair &pair, const MPMTwoScale *) {
    pair.nodes->sums_to_parents(pair.fine->rate, pair.coarse->rate);
  });
  for (auto *level : levels) level->scalar.sum_rates();
}

void MPMHeatLevels::temperatures_from_parents()
{
  for (const auto &pair : pairs)
    pair.nodes->values_from_parents(pair.coarse->temperature, pair.fine->temperature);
}

void MPMHeatLevels::rates_from_parents()
{
  for (const auto &pair : pairs)
    pair.nodes->values_from_parents(pair.coarse->rate, pair.fine->rate);
}

/** Sums of mpm_heat_body.cpp, with the points of all lattices that nodes of lines through a face
 *  reach. */
void MPMHeatLevels::find_surface()
{
  if (!pairs[0].coarse_surface) return;
  constexpr double FAR = 4.0;
  const double reach = FAR * levels[0]->field.lattice.h;
  const auto add = [reach](MPMHeatBody &surface) {
    MPMField &field = surface.field;
    const MPMFrame &frame = *field.frame;
    const auto &faces = surface.conduction->faces;
    const double inverse = 1.0 / field.lattice.cell_volume();
    surface.share.assign(field.grid.nnodes(), 0.0);
    surface.gradient.assign(3 * field.grid.nnodes(), 0.0);
    const MPMStencil stencil(field);
    each_point(field, [&](const auto &run, int i) {
      const double *const place = frame.places()[i];
      if (!faces.is_near(place, reach)) return;
      const double V = field.atom->vfrac[i] * frame.lattice_jacobian(i) / frame.circle(place[0]);
      stencil.visit(field.grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
        surface.share[node.number] += inverse * V * node.weight;
        for (int d = 0; d < 3; d++) surface.gradient[3 * node.number + d] += V * node.gradient[d];
      });
    });
  };
  add(*pairs[0].coarse_surface);
  for (const auto &pair : pairs) add(*pair.fine_surface);
  to_parents([](const Pair &pair, const MPMTwoScale *) {
    pair.nodes->sums_to_parents(pair.fine_surface->share, pair.coarse_surface->share);
    pair.nodes->sums_to_parents(pair.fine_surface->gradient, pair.coarse_surface->gradient, 3);
  });
  const auto sum = [](MPMHeatBody &surface) {
    surface.field.nodes.sum(surface.share.data(), 1, 0, 1);
    surface.field.nodes.sum(surface.gradient.data(), 3, 0, 3);
  };
  sum(*pairs[0].coarse_surface);
  for (const auto &pair : pairs) sum(*pair.fine_surface);
}

void MPMHeatLevels::look_for_thin_surfaces()
{
  if (warned) return;
  int mine = 0, all;
  for (std::size_t k = 0; k < pairs.size(); k++)
    if (pairs[k].fine->faces.has_part_of_line([&](int64_t node) {
          return pairs[k].nodes->is_tied(node);
        }))
      mine = (int) k + 1;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, world);
  if (!all) return;
  warned = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/heat: points of fix mpm {} end within a few cells of a face of the box with a "
        "condition, so that the rim of its lattice is there and heat through the face is wrong: "
        "let them go on for four of their cells along the normal of the face",
        pairs[all - 1].fine->field.id());
}
