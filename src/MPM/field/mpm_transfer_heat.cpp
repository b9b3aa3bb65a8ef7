/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* A point of PIC and APIC has the velocity field u_p(d) = v_p + C_p d around it (PIC: C = 0), with
 *  the kinetic energy m_p (v_p^2 + C_p D C_p^T)/2, D being the second moment of its functions.
 *  Transfers are least squares, and lose the squares of what is left over (F.H. Harlow, Methods
 *  Comput. Phys. 3 (1964) 319; J.U. Brackbill, H.M. Ruppel, J. Comput. Phys. 65 (1986) 314). With
 *  <.> = sum_i N_ip . at the point, and the fit w + B d to the old velocities of the nodes, they
 *  are twice the heat over the mass,
 *
 *    <v_old^2> - w^2 - |B|_D^2 + (v_p - w)^2 + |C_p - B|_D^2  and  <v_new^2> - v_p^2 - |C_p|_D^2 */

#include "field/mpm_transfer_heat.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_affine.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "force.h"
#include "math/matrix.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMTransferHeat::init() const
{
  const bool taken =
      std::any_of(field.materials.begin(), field.materials.end(), [](auto *material) {
        return material->find_history("heat") >= 0 || material->temperature() >= 0;
      });
  if (!taken && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {} heat yes: no material has an internal energy or a temperature: heat "
                   "is only counted as viscous work, and changes nothing",
                   field.id());
}

/** Of functions along each axis, in PIC without use. */
double MPMTransferHeat::second_moment() const
{
  const double h = field.lattice.h;
  return field.affine ? h * h / shape_constants[field.options.shape].inv_moment : 0.0;
}

static double square(const double *a, int n)
{
  double sum = 0.0;
  for (int k = 0; k < n; k++) sum += a[k] * a[k];
  return sum;
}

void MPMTransferHeat::before_motion()
{
  const int dim = field.lattice.dim, nC = field.affine ? dim * dim : 0;
  const double D = second_moment();
  const TransferKernels &pic = field.pic;
  const TransferKernels fit = field.affine ? field.frame->kernels(field.options.transfer, true)
                                           : pic;
  auto &nodes = field.work.nodes;
  const std::size_t nnodes = field.grid.nnodes();
  const TransferStep still = field.step_data(0.0);
  const double *const tile = field.map->tile_load;

  energy.resize(atom->nmax);
  C.resize(nC * (std::size_t) atom->nmax);
  field.work.vectors.resize(3 * (std::size_t) atom->nmax);
  double *const values = field.work.vectors.data();
  PointRows rows = field.rows_at_rest(values, atom->rmass);
  const double *const own = rows.C;
  rows.C = C.data();

  // with these nodes in the reals 0 to 2 of records to all points
  const auto gather = [&](const TransferKernels &with, const auto &use) {
    field.nodes.complete(nodes.data(), 8, 3);
    for (auto &a : field.map->active) std::copy_n(a.box, 6, a.other_box);
    points_from(nodes, field, with, [&](const MPMPointMap::Run &run, const int *base) {
      with.g2p(rows, still, run.first, run.last, base, tile, nullptr);
      for (bigint i = run.first; i < run.last; i++) use(i, values + 3 * i);
    });
  };
  field.nodes.complete_velocities();
  const auto fill = [&](const auto &set) {
    nodes.assign(8 * nnodes, 0.0);
    const double *record = field.grid.nodes();
    for (double *node = nodes.data(); node < nodes.data() + nodes.size(); node += 8, record += 8)
      set(node, record);
  };

  fill([dim](double *node, const double *record) {
    std::copy_n(record + 4, dim, node);
  });
  gather(fit, [&](bigint i, const double *w) {
    double left = -square(w, dim);
    for (int d = 0; d < dim; d++) {
      const double change = atom->v[i][d] - w[d];
      left += change * change;
    }
    for (int k = 0; k < nC; k++) {
      const double B = C[nC * i + k], change = own[nC * i + k] - B;
      left += D * (change * change - B * B);
    }
    energy[i] = left;
  });

  fill([dim](double *node, const double *record) {
    node[0] = square(record, dim) + square(record + 4, dim);
  });
  gather(pic, [&](bigint i, const double *squares) {
    energy[i] += squares[0];
  });
}

void MPMTransferHeat::give(int first, int n, double *heat)
{
  const int dim = field.lattice.dim, nC = field.affine ? dim * dim : 0;
  const double D = second_moment();
  const double *const own = nC ? field.affine->rows() : nullptr;
  double sum = 0.0;
  for (int p = 0; p < n; p++) {
    const bigint i = first + p;
    const double left =
        energy[i] - square(atom->v[i], dim) - (nC ? D * square(own + nC * i, nC) : 0.0);
    const double given = 0.5 * force->mvv2e * atom->rmass[i] * left;
    heat[p] = given * force->nktv2p / atom->vfrac[i];
    sum += given;
  }
  field.ledger.transfer += sum;
  field.ledger.internal += sum;
}
