/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// What fix mpm tells: energy ledger, thermo values, report at the end of a run.

#include "fix_mpm.h"

#include "atom.h"
#include "comm.h"
#include "fix_mpm_elements.h"
#include "fix_mpm_material.h"
#include "fix_mpm_passes.h"
#include "force.h"
#include "mpm_halo.h"
#include "mpm_points.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   kinetic energy of the nodes that this rank owns, velocity in the reals from lane on
------------------------------------------------------------------------- */

double FixMPM::nodal_kinetic_energy(int lane) const
{
  double sum = 0.0;
  for (std::size_t s = 0; s < grid->blocks.size(); s++) {
    const uint64_t owned = grid->blocks[s].owned;
    const double *record = grid->record(s, 0);
    for (int n = 0; n < NODES_PER_BLOCK; n++, record += grid->nreal) {
      if (!(owned >> n & 1)) continue;
      const double *v = record + lane;
      sum += record[3] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
  }
  return 0.5 * force->mvv2e * sum;
}

/* ---------------------------------------------------------------------- */

double FixMPM::point_kinetic_energy() const
{
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    const double *v = atom->v[i];
    sum += atom->rmass[i] * (v[0] * v[0] + v[1] * v[1] + (lattice.dim == 3 ? v[2] * v[2] : 0.0));
  }
  return 0.5 * force->mvv2e * sum;
}

/* ----------------------------------------------------------------------
   ledger: what forces and node actions have done to the nodes, which points are about to get
------------------------------------------------------------------------- */

void FixMPM::account_for_nodes()
{
  // node actions may have changed old velocities, too

  if (refinement == XPIC) swap_old_velocities();
  double external = external_work(rows().f);
  for (auto *ifix : elements) external -= external_work(ifix->forces());    // is internal
  const double old = nodal_kinetic_energy(4), kinetic = nodal_kinetic_energy(0);
  if (refinement == XPIC) swap_old_velocities();
  ledger.external += external;
  ledger.internal += external + ledger.boundary + ledger.contact + ledger.transfer -
      before_actions - (kinetic - old);
  ledger.transfer += old - kinetic_points;
  kinetic_points = kinetic;
}

/* ----------------------------------------------------------------------
   work of forces on points (atom->f, or a part of it) in the momentum equation: nodal external
   forces times the mean of the old and the final velocity of the node. The forces alone are mapped
   once more, with zero volumes.
------------------------------------------------------------------------- */

double FixMPM::external_work(const double *force_on)
{
  const double dt = step_dt();
  zero_volume.assign(atom->nmax, 0.0);
  PointRows r = rows();
  r.vol0 = zero_volume.data();
  r.f = force_on;
  const TransferStep s = step_data();
  map_apart(kernel, [&](const Run &run, const int *base, int *box) {
    map_run(kernel.p2g_force, r, s, run, base, box);
  });
  sum_copies(nodes_apart.data(), kernel.nreal, 4, 3);

  double work = 0.0;
  for (std::size_t b = 0; b < grid->blocks.size(); b++)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(grid->blocks[b].owned >> n & 1)) continue;
      const double *record = grid->record(b, n);    // v m | v old
      const double *f = &nodes_apart[(b * NODES_PER_BLOCK + n) * kernel.nreal + 4];
      if (record[3] <= 0.0) continue;
      for (int d = 0; d < 3; d++) work += dt * f[d] * 0.5 * (record[d] + record[4 + d]);
    }
  return force->mvv2e * work;    // nodal forces are mass * acceleration
}

/* ----------------------------------------------------------------------
   scalar: number of points; vector: blocks with points, active blocks, points per block,
   updates of the topology and sorts in this run, halo bytes sent per step; points, mass and
   momentum deleted so far
------------------------------------------------------------------------- */

double FixMPM::compute_scalar()
{
  double n = npoints_local(), all;
  MPI_Allreduce(&n, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPM::compute_vector(int k)
{
  if (k == 6) return deleted.points;
  if (k == 7) return deleted.mass;
  if (k > 7) return deleted.momentum[k - 8];
  double mine[4] = {(double) active.size(), (double) grid->blocks.size(), 0.0,
                    (double) halo->bytes_sent / std::max((bigint) 1, report.steps)};
  for (const auto &run : runs) mine[2] += run.last - run.first;
  double all[4];
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
  switch (k) {
    case 0:
      return all[0];
    case 1:
      return all[1];
    case 2:
      return all[0] > 0.0 ? all[2] / all[0] : 0.0;
    case 3:
      return report.topologies;
    case 4:
      return report.sorts;
    default:
      return all[3];
  }
}

/* ----------------------------------------------------------------------
   per-point state: what LAMMPS keeps of any atom, atom style mpm, affine matrix, history
------------------------------------------------------------------------- */

double FixMPM::bytes_per_point() const
{
  double bytes = 9 * sizeof(double) + sizeof(tagint) + 2 * sizeof(int) + sizeof(imageint);
  bytes += (1 + 1 + 9 + 6) * sizeof(double);    // mass, V0, F, stress
  bytes += own_size() * sizeof(double);
  if (has_boxes()) bytes += 3 * sizeof(double);
  if (extent == PARALLELEPIPED) bytes += domain_size() * sizeof(double);
  if (axisymmetric) bytes += sizeof(double);
  int nhistory = 0;
  for (auto *material : materials) nhistory += material->nhistory;
  return bytes + nhistory * sizeof(double);
}

/* ---------------------------------------------------------------------- */

void FixMPM::post_run()
{
  running = false;
  ledger_start.clear();
  remember_velocities();
  if (report.steps == 0) return;

  enum { TOPOLOGY, SORT, P2GRID, HALO, NODES, G2POINTS, NTIMES };
  double t[NTIMES] = {report.t_topology, report.t_sort,  report.t_p2g,
                      report.t_halo,     report.t_nodes, report.t_g2p};
  double t_max[NTIMES], sum[4], mine[4];
  MPI_Allreduce(t, t_max, NTIMES, MPI_DOUBLE, MPI_MAX, world);
  mine[0] = report.point_steps;
  mine[1] = active.size();
  mine[2] = grid->blocks.size();
  mine[3] = (double) halo->bytes_sent / report.steps;
  MPI_Allreduce(mine, sum, 4, MPI_DOUBLE, MPI_SUM, world);
  if (comm->me) return;

  const double scale = 1.0e9 * comm->nprocs / sum[0];
  double total = 0.0;
  for (double stage : t_max) total += stage;
  const double npoints = sum[0] / report.steps;
  utils::logmesg(lmp,
                 "MPM {}: {:.0f} points, {} kernels, {:.2f} ns per point-step and core\n"
                 "  of these: topology and checks {:.2f}, sort {:.2f}, points to grid {:.2f}, "
                 "halo {:.2f}, nodes {:.2f}, grid to points with material {:.2f}\n"
                 "  {:.0f} bytes per point; {:.0f} blocks with points of {:.0f} active, "
                 "{:.1f} points per block\n"
                 "  {} updates of the topology, {} sorts, {:.0f} halo bytes per step, "
                 "time step {:.6g} to {:.6g}\n",
                 id, npoints, kernels->isa, total * scale, t_max[TOPOLOGY] * scale,
                 t_max[SORT] * scale, t_max[P2GRID] * scale, t_max[HALO] * scale,
                 t_max[NODES] * scale, t_max[G2POINTS] * scale, bytes_per_point(), sum[1], sum[2],
                 npoints / std::max(1.0, sum[1]), report.topologies, report.sorts, sum[3],
                 report.dt_min, report.dt_max);
  if (deleted.points > 0.0)
    utils::logmesg(lmp,
                   "  {:.0f} points deleted so far, mass {:.10g}, momentum {:.10g} {:.10g} "
                   "{:.10g}\n",
                   deleted.points, deleted.mass, deleted.momentum[0], deleted.momentum[1],
                   deleted.momentum[2]);
  if (report.references)
    utils::logmesg(lmp, "  {} updates of the reference configuration\n", report.references);
  if (nbad_total)
    utils::logmesg(lmp, "  {} bad point updates so far (policy {})\n", nbad_total,
                   policy == WARN ? "warn" : "delete");
}

/* ---------------------------------------------------------------------- */

double FixMPM::memory_usage()
{
  double bytes = grid->memory_usage() + halo->memory_usage();
  bytes += (double) own_size() * atom->nmax * sizeof(double) + 2.0 * tile_reals() * sizeof(double);
  bytes += runs.capacity() * sizeof(Run) + active.capacity() * sizeof(ActiveBlock);
  for (const auto &list : edges) bytes += list.capacity() * sizeof(EdgeNodes);
  for (const auto *list :
       {&xnew, &v_apart, &lumped, &mean_force, &mean_torque, &gradients, &tau_averaged, &hoop,
        &domains, &corners_late, &sizes, &history_batch, &nodes_apart, &rows_apart, &zero_volume})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}
