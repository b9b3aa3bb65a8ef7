/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Stages: nodes with next to no mass, and velocity gradients that they do not spoil.

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_locking.h"
#include "field/mpm_passes.h"
#include "field/mpm_strain.h"
#include "step/mpm_stages.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** For the velocity gradient and the affine matrix alone, a node that has the share s < light of
 *  the material of a full cell moves with
 *
 *    (s/light) v_i + (1 - s/light) <v>_i,    <v>_i = sum_p V_p N_ip v_p / sum_p V_p N_ip
 *
 *  with the new velocities v_p of the points. Momenta are not touched. Volumes tell how full a cell
 *  is, as bodies of any density may meet at a node; with an axis of symmetry, areas in the
 *  plane. */
void MPMStages::blend_light_nodes(MPMField &field)
{
  auto &nodes = field.work.nodes, &volumes = field.work.weights;
  MPMPointMap &map = *field.map;
  const MPMFrame &frame = *field.frame;
  const MPMRows places = frame.places();
  volumes.resize(field.atom->nmax);
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    volumes[i] = field.atom->vfrac[i] * frame.lattice_jacobian(i) / frame.circle(places[i][0]);
  });
  PointRows r = field.rows();
  r.mass = volumes.data();
  const TransferStep s = field.step_data();
  points_to(nodes, field, field.pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    field.pic.p2g_momentum(r, s, run.first, run.last, base, map.tile, box);
  });
  field.nodes.sum(nodes.data(), field.pic.nreal, 0, 4);

  const double full = field.options.light * field.lattice.cell_volume();
  double *record = field.grid.nodes();
  const double *mapped = nodes.data();
  for (int64_t n = field.grid.nnodes(); n > 0;
       n--, record += field.kernel.nreal, mapped += field.pic.nreal) {
    const double volume = mapped[3];
    if (!(volume > 0.0) || volume >= full) continue;
    const double own = volume / full;
    for (int d = 0; d < 3; d++) record[d] = own * record[d] + (1.0 - own) * mapped[d] / volume;
  }
}

/** Gradients go to the affine matrices of transfers that have them, as they are; what stress needs
 *  may refer to another configuration. */
void MPMStages::gradients_with_light_nodes(MPMField &field, bool stress)
{
  field.grid.copy_aliases();
  const bool fbar = stress && field.options.averages_strain();
  double *const of_all = field.affine ? field.affine->rows()
      : fbar                          ? field.locking->room_for_gradients()
                                      : nullptr;
  const PointRows r = field.rows();
  const TransferStep s = field.step_data();
  const int nL = field.lattice.dim * field.lattice.dim;
  const bool refers = stress && field.frame->refers();
  double batch_gradients[9 * BATCH];
  points_from_step(field, [&](const MPMPointMap::Run &run, int i, int n, const int *base) {
    double *L = of_all ? of_all + (bigint) nL * i : batch_gradients;
    field.kernel.g2p_gradient(r, s, i, i + n, base, field.map->tile_load, L);
    if (refers && field.affine) {
      std::copy_n(L, nL * n, batch_gradients);
      L = batch_gradients;
    }
    if (refers) field.frame->refer_gradients(i, n, L);
    if (stress && !fbar) update_stress(field, r, run, i, n, L, field.step_dt());
  });
  if (fbar) field.locking->strain(of_all, field.step_dt());
  if (stress) move_points(field);
}
