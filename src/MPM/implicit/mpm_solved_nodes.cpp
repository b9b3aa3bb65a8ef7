/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_solved_nodes.h"

#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// in points: nodes with less reach count as without points
static constexpr double REACHED = 1.0e-9;

MPMSolvedNodes::MPMSolvedNodes(LAMMPS *lmp, const std::vector<MPMField *> &fields) :
    lmp(lmp), field(*fields[0]), width(field.lattice.dim)
{
  for (auto *one : fields) bodies.push_back({*one});
}

void MPMSolvedNodes::begin_step()
{
  int64_t nnodes = 0;
  for (auto &body : bodies) {
    body.first = nnodes;
    nnodes += body.field.grid.nnodes();
  }
  if (by_reach) find_reach();
  mass.resize(nnodes);
  start_velocity.assign(nreals(), 0.0);
  explicit_velocity.assign(nreals(), 0.0);
  double heaviest = 0.0;
  each_record([&](const Body &, int64_t, double *record) {
    heaviest = std::max(heaviest, record[3]);
  });
  const double least = MPMStencil::ROUND_OFF * largest(heaviest);
  each_record([&](const Body &, int64_t n, double *record) {
    mass[n] = record[3] > 0.0 ? record[3] : 0.0;
    if (mass[n] <= least || (field.domains && reach[n] < REACHED)) {    // as if no point reached it
      std::fill_n(record, 8, 0.0);
      mass[n] = 0.0;
    }
    if (mass[n] == 0.0) return;
    for (int d = 0; d < width; d++) {
      explicit_velocity[width * n + d] = record[d];
      start_velocity[width * n + d] = record[4 + d];
    }
  });
  find_active();
}

void MPMSolvedNodes::find_active()
{
  active.clear();
  active_records.clear();
  for (const bool owned : {true, false}) {
    each_record([&](const Body &body, int64_t n, double *record) {
      if (!(mass[n] > 0.0) || body.owns(n) != owned) return;
      active.push_back(n);
      active_records.push_back(record);
    });
    if (owned) nowned = active.size();
  }
}

/* ----------------------------------------------------------------------
   A node that corners of domains, or nodes of elements, reach with a small share e has forces of
   the order e and a stiffness of the order e^2: it moves 1/e times as far as these corners do. Its
   forces divided by e show how well the forces of the corners are in balance. Where e is only
   round-off of the places of corners, which may lie on a plane of nodes, the node is left alone:
   corners then do not move by this share.
------------------------------------------------------------------------- */

void MPMSolvedNodes::find_reach()
{
  const MPMStencil stencil(field);
  reach.assign(field.grid.nnodes(), 0.0);
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++)
      stencil.visit(field.grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
        reach[node.number] += node.weight;
      });
  field.nodes.sum(reach.data(), 1, 0, 1);
  for (double &number : reach) number = std::min(number, 1.0);
}

void MPMSolvedNodes::restore_records()
{
  each_record([&](const Body &, int64_t n, double *record) {
    record[3] = mass[n];
    for (int d = 0; d < width; d++) {
      record[d] = explicit_velocity[width * n + d];
      record[4 + d] = start_velocity[width * n + d];
    }
  });
}

int64_t MPMSolvedNodes::first_of(const MPMField &of) const
{
  for (const auto &body : bodies)
    if (&body.field == &of) return body.first;
  return -1;
}

LatticeIndex MPMSolvedNodes::index_of(int64_t n) const
{
  int at[3];
  field.grid.node_index(n, at);
  LatticeIndex index{0, 0, 0};
  for (int d = 0; d < width; d++) index[d] = field.grid.lattice.wrap(d, at[d]);
  return index;
}

void MPMSolvedNodes::products(int n, const double *const *a, const double *const *b, double *value)
{
  sums.assign(n, 0.0);
  for (const auto &body : bodies)
    add_products(body.field.grid, width, n, a, b, width * body.first, sums.data());
  sum_in_order(n, sums.data(), value);
}

double MPMSolvedNodes::product(const double *a, const double *b)
{
  double value;
  products(1, &a, &b, &value);
  return value;
}

bool MPMSolvedNodes::any(bool mine) const
{
  int is = mine, all;
  MPI_Allreduce(&is, &all, 1, MPI_INT, MPI_MAX, lmp->world);
  return all;
}

double MPMSolvedNodes::largest(double mine) const
{
  double all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, lmp->world);
  return all;
}

double MPMSolvedNodes::sum_of_lengths(const std::vector<double> &f) const
{
  double mine = 0.0;
  if (width == 2)
    each_owned([&](int64_t n) {
      mine += std::sqrt(f[2 * n] * f[2 * n] + f[2 * n + 1] * f[2 * n + 1]);
    });
  else
    each_owned([&](int64_t n) {
      const double *const of = &f[3 * n];
      mine += std::sqrt(of[0] * of[0] + of[1] * of[1] + of[2] * of[2]);
    });
  return mine;
}

double MPMSolvedNodes::sum_of_residuals(const std::vector<double> &f) const
{
  if (!field.domains) return sum_of_lengths(f);
  double mine = 0.0;
  each_owned([&](int64_t n) {
    double square = 0.0;
    for (int d = 0; d < width; d++) square += f[width * n + d] * f[width * n + d];
    mine += std::sqrt(square) / reach[n];
  });
  return mine;
}

double MPMSolvedNodes::mean_size(const std::vector<double> &u) const
{
  double mine[2] = {0.0, 0.0}, all[2];
  each_owned([&](int64_t n) {
    double square = 0.0;
    for (int d = 0; d < width; d++) square += u[width * n + d] * u[width * n + d];
    if (by_reach) square *= reach[n] * reach[n];
    mine[0] += mass[n] * square;
    mine[1] += mass[n];
  });
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, lmp->world);
  return all[1] > 0.0 ? std::sqrt(all[0] / all[1]) : 0.0;
}
