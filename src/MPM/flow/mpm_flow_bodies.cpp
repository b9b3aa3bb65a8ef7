/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_bodies.h"

#include "contact/fix_mpm_rigid.h"
#include "flow/mpm_flow_pressure.h"
#include "flow/mpm_flow_regions.h"

#include "comm.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

void MPMFlowBodies::init()
{
  bodies.clear();
  for (int wall = 0; wall < regions.n(); wall++)
    if (auto *fix = regions.body(wall)) bodies.push_back({fix, wall, {}, {}, {}, {}, {}});
}

void MPMFlowBodies::find_rows(Body &body, const MPMFlowPressure &pressure) const
{
  const int dim = cells.lattice.dim;
  body.rows.clear();
  for (const auto &cell : cells.cells) {
    if (!pressure.is_wet(cell.number)) continue;
    Row row = {cell.number, {}, 1.0, {}};
    bool any = false;
    for (int d = 0; d < dim; d++)
      for (int s = 0; s < 2; s++) {
        double arm[3];
        const double closed =
            regions.closed_by(body.wall, s ? cell.near[2 * d + 1] : cell.number, d, arm);
        if (closed == 0.0) continue;
        any = true;
        const double out = s ? closed : -closed;
        row.w[d] += out;
        for (int e = 0; e < 3; e++) {    // r x e_d
          if (e == d) continue;
          const int other = 3 - d - e;
          row.w[3 + e] += ((e + 1) % 3 == other ? 1.0 : -1.0) * out * arm[other];
        }
      }
    if (!any) continue;
    regions.find_wall(body.wall, cell, row.to_wall);
    row.heavy = pressure.density_in(cell);
    body.rows.push_back(row);
  }
}

void MPMFlowBodies::begin(double duration, const double *gravity, const MPMFlowPressure &pressure)
{
  for (auto &body : bodies) {
    find_rows(body, pressure);
    body.fix->predict(duration, body.u, body.inverse);
    body.impulse = {};
    push(body, sum(body, [&](const Row &row) {
           return row.heavy * (duration * MathExtra::dot3(gravity, row.to_wall));
         }));
  }
}

/** Impulse on a body of the potentials value(row), over the density; the same on all ranks. */
template <class Value>
MPMFlowBodies::Six MPMFlowBodies::sum(const Body &body, const Value &value) const
{
  const int nprocs = lmp->comm->nprocs;
  Six mine = {}, all = {};
  for (const auto &row : body.rows) {
    const double psi = value(row);
    for (int k = 0; k < 6; k++) mine[k] += row.w[k] * psi;
  }
  rank_sums.resize(6 * (std::size_t) nprocs);
  MPI_Allgather(mine.data(), 6, MPI_DOUBLE, rank_sums.data(), 6, MPI_DOUBLE, lmp->world);
  const double area = std::pow(cells.lattice.h, cells.lattice.dim - 1);
  for (int k = 0; k < 6; k++)
    for (int rank = 0; rank < nprocs; rank++) all[k] += area * rank_sums[6 * rank + k];
  return all;
}

/** Changes the velocities of a body by an impulse over the density, and gives them to its walls. */
void MPMFlowBodies::push(Body &body, const Six &impulse) const
{
  for (int i = 0; i < 6; i++) body.impulse[i] += density * impulse[i];
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) body.u[i] += density * body.inverse[6 * i + j] * impulse[j];
  regions.set_velocity(body.wall, body.u);
}

void MPMFlowBodies::add(const double *x, double *y) const
{
  for (const auto &body : bodies) {
    const Six impulse = sum(body, [&](const Row &row) {
      return x[row.cell];
    });
    double change[6];
    for (int i = 0; i < 6; i++) {
      change[i] = 0.0;
      for (int j = 0; j < 6; j++)
        change[i] += density / cells.lattice.h * body.inverse[6 * i + j] * impulse[j];
    }
    for (const auto &row : body.rows)
      for (int k = 0; k < 6; k++) y[row.cell] += row.w[k] * change[k];
  }
}

void MPMFlowBodies::end(const double *psi)
{
  for (auto &body : bodies)
    push(body, sum(body, [&](const Row &row) {
           return psi[row.cell];
         }));
}

void MPMFlowBodies::strike()
{
  for (auto &body : bodies) {
    body.fix->strike(body.impulse.data());
    body.struck = body.impulse;
  }
}

void MPMFlowBodies::move(double dt, double kick, double half_kick_share)
{
  for (auto &body : bodies) {
    body.fix->go_on(dt, kick, half_kick_share, body.impulse.data(), body.struck.data());
    body.struck = {};
    regions.set_velocity(body.wall, body.u);
  }
}

bool MPMFlowBodies::any_new() const
{
  return std::any_of(bodies.begin(), bodies.end(), [](const Body &body) {
    return body.fix->is_new();
  });
}

void MPMFlowBodies::forget()
{
  for (auto &body : bodies) body.fix->forget();
}
