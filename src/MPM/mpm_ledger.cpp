/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_ledger.h"

#include "atom.h"
#include "fix_mpm_elements.h"
#include "force.h"
#include "math/matrix.h"
#include "mpm_field.h"
#include "mpm_passes.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

double MPMLedger::nodal_kinetic_energy(int lane) const
{
  Grid &grid = field.grid;
  double sum = 0.0;
  for (int64_t n = 0; n < grid.nnodes(); n++) {
    if (!grid.owns(n)) continue;
    const double *record = grid.record(n), *v = record + lane;
    sum += record[3] * dot(v, v);
  }
  return 0.5 * force->mvv2e * sum;
}

double MPMLedger::point_kinetic_energy() const
{
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const double *v = atom->v[i];
    sum +=
        atom->rmass[i] * (v[0] * v[0] + v[1] * v[1] + (field.lattice.dim == 3 ? v[2] * v[2] : 0.0));
  }
  return 0.5 * force->mvv2e * sum;
}

/* ---------------------------------------------------------------------- */

void MPMLedger::account_for_nodes()
{
  double external_now = external_work(field.rows().f);
  for (auto *ifix : field.elements) external_now -= external_work(ifix->forces());    // is internal
  const double old = nodal_kinetic_energy(4), kinetic = nodal_kinetic_energy(0);
  external += external_now;
  internal += external_now + boundary + contact + transfer - before_actions - (kinetic - old);
  transfer += old - kinetic_points;
  kinetic_points = kinetic;
}

void MPMLedger::account_for_points()
{
  const double kinetic = point_kinetic_energy();
  transfer += kinetic - kinetic_points;
  kinetic_points = kinetic;
}

/* ----------------------------------------------------------------------
   work of forces on points (atom->f, or a part of it) in the momentum equation: nodal external
   forces times the mean of the old and the final velocity of the node. The forces alone are mapped
   once more, with zero volumes.
------------------------------------------------------------------------- */

double MPMLedger::external_work(const double *force_on) const
{
  const double dt = field.step_dt();
  auto &nodes = field.work.nodes;
  field.work.no_volume.assign(atom->nmax, 0.0);
  PointRows r = field.rows();
  r.vol0 = field.work.no_volume.data();
  r.f = force_on;
  const TransferStep s = field.step_data();
  points_to(nodes, field, field.kernel,
            [&](const MPMPointMap::Run &run, const int *base, int *box) {
              run_to_tile(field, field.kernel.p2g_force, r, s, run, base, box);
            });
  const int nreal = field.kernel.nreal;
  field.nodes.sum(nodes.data(), nreal, 4, 3);

  Grid &grid = field.grid;
  double work = 0.0;
  for (int64_t n = 0; n < grid.nnodes(); n++) {
    const double *record = grid.record(n), *f = &nodes[n * nreal + 4];    // v m | v old
    if (!grid.owns(n) || record[3] <= 0.0) continue;
    for (int d = 0; d < 3; d++) work += dt * f[d] * 0.5 * (record[d] + record[4 + d]);
  }
  return force->mvv2e * work;    // nodal forces are mass * acceleration
}

/* ---------------------------------------------------------------------- */

void MPMLedger::push_node(double *record, bool owned, const double *impulse)
{
  double change[3];
  if (!(record[3] > 0.0)) return;
  for (int d = 0; d < 3; d++) {
    change[d] = impulse[d] / record[3];
    record[d] += change[d];
  }
  if (owned) count_push(record, change);
}

/* ----------------------------------------------------------------------
   The work of the impulse takes the new velocity: that is what moves points. With the mean of the old
   and the new one it would be the change of kinetic energy; the rest is part of integration
------------------------------------------------------------------------- */

void MPMLedger::count_push(const double *record, const double *change)
{
  double moved = 0.0, lost = 0.0;
  for (int d = 0; d < field.lattice.dim; d++) moved += change[d] * record[d];
  contact += record[3] * moved * force->mvv2e;
  if (!on) return;
  for (int d = 0; d < field.lattice.dim; d++) lost += 0.5 * change[d] * (record[d] - record[4 + d]);
  transfer -= record[3] * lost * force->mvv2e;
}
