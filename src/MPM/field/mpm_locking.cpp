/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_locking.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_strain.h"
#include "force.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** With volumes V and functions N of the points of one material,
 *
 *    S q_p = sum_i N_ip  [sum_q N_iq V_q q_q] / [sum_q N_iq V_q]
 *
 *  F-bar gives laws S of the change of volume, or of the volume, of points (E.A. de Souza Neto et
 *  al., Int. J. Solids Struct. 33 (1996) 3277; points: W.M. Coombs et al., Comput. Methods Appl.
 *  Mech. Eng. 333 (2018) 466), and pressure puts S p into the internal force. Why: see
 *  DECISIONS.md. */
MPMLocking::MPMLocking(LAMMPS *lmp, MPMField &field, MPMPointState &state) :
    Pointers(lmp), field(field)
{
  if (field.options.averages_volume()) state.declare(J, "mpm:J");
}

double *MPMLocking::room_for_gradients()
{
  gradients.resize(field.lattice.dim * field.lattice.dim * (std::size_t) atom->nmax);
  return gradients.data();
}

/** Q <- S q with q = vectors[3*i] and V = weights[i], which value(i, q, V) sets, for all points of
 *  this field, at the positions in rows(): the transfers of PIC with volumes for masses. */
template <class Value> void MPMLocking::average_around_points(const Value &value)
{
  auto &work = field.work;
  work.vectors.resize(3 * (std::size_t) atom->nmax);
  work.weights.resize(std::max(work.weights.size(), (std::size_t) atom->nmax));
  each_point(field, [&](const MPMPointMap::Run &, bigint i) {
    value(i, work.vectors[3 * i], work.weights[i]);
    work.vectors[3 * i + 1] = work.vectors[3 * i + 2] = 0.0;
  });

  const auto &pic = field.pic;
  const PointRows r = field.rows_at_rest(work.vectors.data(), work.weights.data());
  const TransferStep s = field.step_data(0.0);

  for (auto *material : field.materials) {
    points_to(work.nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
      if (run.material == material)
        pic.p2g_momentum(r, s, run.first, run.last, base, field.map->tile, box);
    });
    field.nodes.sum(work.nodes.data(), pic.nreal, 0, 4);
    field.kernels->solve_nodes(work.nodes.data(), (int) field.grid.nnodes(), pic.nreal, 0.0,
                               LEAST_MASS);
    field.nodes.complete(work.nodes.data(), pic.nreal, 1);
    points_from(work.nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base) {
      if (run.material == material)
        pic.g2p(r, s, run.first, run.last, base, field.map->tile_load, nullptr);
    });
  }
}

/** I + dt L (total frame: F + dt L) is multiplied by a number, so that laws see a motion like any
 *  other. What points keep is this F. The sum of V0 J is that of the true volumes; with averages of
 *  dJ/J, it follows the sum of the true changes of volume. */
void MPMLocking::strain(const double *L, double dt)
{
  MPMFrame &frame = *field.frame;
  const auto &average = field.work.vectors, &volume = field.work.weights;
  const int nL = field.lattice.dim * field.lattice.dim;
  const bool plane = frame.is_plane();

  average_around_points([&](bigint i, double &q, double &V) {
    const double mine = frame.volume_change((int) i, L + nL * i, dt);
    const bool good = mine > -1.0 && std::isfinite(mine);    // or else it is a bad point
    const double last = field.points->jacobian((int) i);
    if (J) {
      if (J[i] == 0.0) J[i] = last;
      if (good) J[i] *= 1.0 + mine;
    }
    q = !good ? 0.0 : J ? J[i] : mine;
    V = !good ? 0.0 : J ? atom->vfrac[i] : atom->vfrac[i] * last;
  });

  const PointRows r = field.rows();
  double averaged[9 * BATCH];
  each_point_batch(field, [&](const MPMPointMap::Run &run, int i, int n) {
    std::copy_n(L + nL * (bigint) i, nL * n, averaged);
    for (int p = 0; p < n; p++) {
      const double mine = frame.volume_change(i + p, averaged + nL * p, dt);
      double more = 0.0;    // scale - 1
      if (volume[i + p] > 0.0) {
        const double mean = average[3 * (bigint) (i + p)];
        const double change = J ? mean / field.points->jacobian(i + p) - 1.0 : mean;
        const double q = (change - mine) / (1.0 + mine);
        const double root = plane ? std::sqrt(1.0 + q) : std::cbrt(1.0 + q);
        more = q / (plane ? root + 1.0 : root * (root + 1.0) + 1.0);
      }
      frame.stretch(i + p, more, dt, averaged + nL * p);
    }
    update_stress(field, r, run, i, n, averaged, dt);
  });
}

/** The stress of internal forces, with averaged pressure. The points keep theirs, or else the
 *  pressure would spread further with every step. */
void MPMLocking::average_pressure()
{
  const auto &pressure = field.work.vectors, &volume = field.work.weights;
  tau.resize(6 * (std::size_t) atom->nmax);
  const auto mean = [](const double *t) {
    return (t[0] + t[1] + t[2]) / 3.0;
  };
  const MPMRows own = field.points->tau;

  average_around_points([&](bigint i, double &q, double &V) {
    const double J = field.points->jacobian((int) i);
    q = mean(own[i]) / J;
    V = atom->vfrac[i] * J;
  });

  unseen = 0.0;
  each_point(field, [&](const MPMPointMap::Run &, bigint i) {
    const double J = volume[i] / atom->vfrac[i], more = J * pressure[3 * i] - mean(own[i]);
    for (int c = 0; c < 6; c++) tau[6 * i + c] = own[i][c] + (c < 3 ? more : 0.0);
    if (J > 0.0) unseen -= 0.5 * atom->vfrac[i] * more * std::log(J);
  });
  unseen /= force->nktv2p;
}
