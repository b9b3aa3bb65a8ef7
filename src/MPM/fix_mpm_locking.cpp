/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Cures for volumetric locking of fix mpm: averages over the points around each point.

#include "fix_mpm.h"

#include "atom.h"
#include "fix_mpm_material.h"
#include "fix_mpm_passes.h"
#include "mpm_points.h"
#include "platform.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   Each point asks for constant volume when a material is all but incompressible, and several
   points per cell ask for more than the velocities of the nodes can give. Averages through the
   lattice leave about one such condition for each node. With volumes V and functions N of points,

     S q_p = sum_i N_ip  [sum_q N_iq V_q q_q] / [sum_q N_iq V_q]

   keeps constants and the integral sum V q, and V S is symmetric. F-bar puts S(dJ/J) for the
   relative change of volume of a step, in the manner of E.A. de Souza Neto et al., Int. J. Solids
   Struct. 33 (1996) 3277, and, for points, W.M. Coombs et al., Comput. Methods Appl. Mech. Eng. 333
   (2018) 466; "pressure" puts S p for the pressure in the internal force B^T V sigma.

   With either, the stiffness of the volume is B^T V K S B: symmetric and not negative where the
   bulk modulus K is uniform, with the energy (B u)^T V K S (B u)/2. What laws account for is
   (S B u)^T V K (S B u)/2 (F-bar) or (B u)^T V K (B u)/2 (pressure); the ledger has the difference
   in its integration entry. With both, force and strain belong together whatever the law is and
   wherever the points are on the lattice: p V S B u is the power of the force and of the law. The
   stiffness is B^T V S K S B then.

   Averages are taken over the points of one material only, as others have another pressure or
   another change of volume next to them for good reasons.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   q <- S q with q = v_apart[3*i] and V = rows_apart[i], for all points of this field, at the
   positions in rows(): the transfers of PIC with volumes for masses
------------------------------------------------------------------------- */

void FixMPM::average_around_points()
{
  const PointRows r = rows_at_rest(v_apart.data(), rows_apart.data());
  TransferStep s = step_data();
  s.dt = 0.0;
  lap(report.t_g2p);

  for (auto *material : materials) {
    map_apart(pic, [&](const Run &run, const int *base, int *box) {
      if (run.material == material) pic.p2g_momentum(r, s, run.first, run.last, base, tile, box);
    });
    lap(report.t_p2g);
    sum_copies(nodes_apart.data(), pic.nreal, 0, 4);
    lap(report.t_halo);
    kernels->solve_nodes(nodes_apart.data(), grid->nnodes(), pic.nreal, 0.0);
    grid->copy_aliases(nodes_apart.data(), pic.nreal);
    extend_edges(nodes_apart.data(), pic.nreal, 0, 1);
    lap(report.t_nodes);
    gather_apart(pic, [&](const Run &run, const int *base) {
      if (run.material == material) pic.g2p(r, s, run.first, run.last, base, tile_load, nullptr);
    });
    lap(report.t_g2p);
  }
}

/* ----------------------------------------------------------------------
   det(I + A) - 1 without the loss of digits of that difference
------------------------------------------------------------------------- */

static double dilatation(int dim, const double *A)
{
  if (dim == 2) return A[0] + A[3] + (A[0] * A[3] - A[1] * A[2]);
  const double minors =
      A[0] * A[4] - A[1] * A[3] + A[0] * A[8] - A[2] * A[6] + A[4] * A[8] - A[5] * A[7];
  return A[0] + A[4] + A[8] + minors + MPMPoints::det(A);
}

/* ----------------------------------------------------------------------
   relative change of the volume of a point in a step with velocity gradient L (column-major), in
   the total frame that with respect to the reference: I + A = (F + dt L) F^-1 there
------------------------------------------------------------------------- */

double FixMPM::volume_change(int i, const double *L, double dt) const
{
  const int dim = lattice.dim;
  double A[9];
  const auto around = [&](double plane) {    // the third direction, if it is stretched at all
    return axisymmetric ? plane + hoop[i] + plane * hoop[i] : plane;
  };
  if (!total) {
    for (int c = 0; c < dim * dim; c++) A[c] = dt * L[c];
    return around(dilatation(dim, A));
  }
  const double *F = points->F[i];
  if (dim == 2) {
    const double scale = dt / (F[0] * F[4] - F[1] * F[3]);
    for (int r = 0; r < 2; r++) {
      A[r] = scale * (L[r] * F[4] - L[2 + r] * F[3]);
      A[2 + r] = scale * (L[2 + r] * F[0] - L[r] * F[1]);
    }
    return around(dilatation(dim, A));
  }
  const double scale = dt / points->jacobian(i);
  for (int j = 0; j < 3; j++) {
    const int a = (j + 1) % 3, b = (j + 2) % 3;
    double inverse[3];    // column j of F^-1, times det F
    for (int k = 0; k < 3; k++) {
      const int c = (k + 1) % 3, d = (k + 2) % 3;
      inverse[k] = F[3 * a + c] * F[3 * b + d] - F[3 * a + d] * F[3 * b + c];
    }
    for (int r = 0; r < 3; r++)
      A[3 * j + r] = scale * (L[r] * inverse[0] + L[3 + r] * inverse[1] + L[6 + r] * inverse[2]);
  }
  return dilatation(dim, A);
}

/* ----------------------------------------------------------------------
   F-bar: the material update of all points with velocity gradients L whose change of volume is
   averaged. I + dt L (total frame: F + dt L) is multiplied by a number, in plane strain in the plane, so that
   laws see a motion like any other. What points keep is this F: sum V0 J follows the sum of the true changes of volume.
------------------------------------------------------------------------- */

void FixMPM::averaged_material(const double *L, double dt)
{
  const int dim = lattice.dim, nL = affine_size();
  const bool plane = dim == 2 && !axisymmetric;
  v_apart.resize(3 * (std::size_t) atom->nmax);
  rows_apart.resize(std::max(rows_apart.size(), (std::size_t) atom->nmax));

  for (const auto &run : runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double change = volume_change(i, L + nL * i, dt);
      const bool good = change > -1.0 && std::isfinite(change);    // or else it is a bad point
      v_apart[3 * i] = good ? change : 0.0;
      v_apart[3 * i + 1] = v_apart[3 * i + 2] = 0.0;
      rows_apart[i] = good ? atom->vfrac[i] * points->jacobian(i) : 0.0;
    }
  average_around_points();

  const PointRows r = rows();
  double averaged[9 * BATCH];
  for (const auto &run : runs)
    for (int i = run.first; i < run.last; i += BATCH) {
      const int n = std::min(BATCH, run.last - i);
      const double *from = L + nL * (bigint) i;
      for (int p = 0; p < n; p++, from += nL) {
        const double change = volume_change(i + p, from, dt);
        double more = 0.0;    // scale - 1
        if (rows_apart[i + p] > 0.0) {
          const double q = (v_apart[3 * (bigint) (i + p)] - change) / (1.0 + change);
          const double root = plane ? std::sqrt(1.0 + q) : std::cbrt(1.0 + q);
          more = q / (plane ? root + 1.0 : root * (root + 1.0) + 1.0);
        }
        double *to = averaged + nL * p;
        for (int c = 0; c < nL; c++) to[c] = (1.0 + more) * from[c];
        const double *F = points->F[i + p];
        for (int r = 0; r < dim; r++)
          for (int c = 0; c < dim; c++)
            to[dim * c + r] += more / dt * (total ? F[3 * r + c] : r == c);
        if (axisymmetric) hoop[i + p] += more * (1.0 + hoop[i + p]);
      }
      material_update(r, run, i, n, averaged, dt);
    }
  lap(report.t_g2p);
}

/* ----------------------------------------------------------------------
   the stress of internal forces, with averaged pressure. The points keep theirs, or else the
   pressure would spread further with every step.
------------------------------------------------------------------------- */

void FixMPM::average_pressure()
{
  v_apart.resize(3 * (std::size_t) atom->nmax);
  rows_apart.resize(std::max(rows_apart.size(), (std::size_t) atom->nmax));
  tau_averaged.resize(6 * (std::size_t) atom->nmax);
  const auto mean = [](const double *tau) {
    return (tau[0] + tau[1] + tau[2]) / 3.0;
  };

  for (const auto &run : runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double J = points->jacobian(i);
      v_apart[3 * i] = mean(points->tau[i]) / J;
      v_apart[3 * i + 1] = v_apart[3 * i + 2] = 0.0;
      rows_apart[i] = atom->vfrac[i] * J;
    }
  average_around_points();

  for (const auto &run : runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *tau = points->tau[i];
      const double more = rows_apart[i] / atom->vfrac[i] * v_apart[3 * i] - mean(tau);
      for (int c = 0; c < 6; c++) tau_averaged[6 * i + c] = tau[c] + (c < 3 ? more : 0.0);
    }
  lap(report.t_g2p);
}
