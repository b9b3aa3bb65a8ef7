/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Nodes with next to no mass: velocity gradients that they do not spoil.

#include "fix_mpm.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "mpm_batch.h"
#include "mpm_halo.h"
#include "mpm_points.h"
#include "platform.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   A point at the distance e h from a face of its cell gives the nodes beyond it the mass e m and,
   with linear functions, the force V sigma/h: an acceleration sigma/(rho h e) without bound. The
   momentum m_i a_i of such a node is bounded, and so is what points get of it. The velocity
   gradient is not: it takes v_i with the weight 1/h. If it makes the stress (USL) or is stored in the
   affine matrix, then such a node is a mass e m on a spring E V/h^2, and the limit of the time step
   is of the order of e^1/2 h/c. B-splines of higher order and GIMP have gradients that vanish with
   the function (N = e^2/2 and h grad N = e), the ratio of stiffness and mass stays what it is.

   The cure: for the gradient (and the affine matrix), and for nothing else, a node that has the
   share s < light of the material of a full cell moves with

     (s/light) v_i + (1 - s/light) <v>_i,    <v>_i = sum_p V_p N_ip v_p / sum_p V_p N_ip

   with the new velocities v_p of the points, as all nodes do in MUSL. The spring then has at least
   the mass of a node with the share light. Momenta, of nodes and of points, are not touched, so
   that linear momentum is conserved exactly; angular momentum is as without, but for the affine
   matrices of the points next to light nodes. The work of the internal force on the light nodes
   differs from that of the stress; the ledger has the difference in its integration entry. Volumes
   rather than masses are what tells how full a cell is, because bodies of any density may meet at a
   node.
------------------------------------------------------------------------- */

/** Is the option of use, and if not given, is it needed? */
void FixMPM::check_light_nodes()
{
  const bool needed =
      !total && shape == LINEAR && extent == NO_SIZE && (scheme == USL || is_affine(transfer));
  if (light > 0.0 && !needed)
    error->all(FLERR, "Fix mpm {}: light is of no use with this shape, transfer and scheme: remove "
               "light, which is for shape linear with scheme usl or transfer apic, aflip, tpic", id);
  if (light > 0.0 && locking != NO_CURE)
    error->all(FLERR, "Fix mpm {}: light cannot be used together with locking: use shape quadratic",
               id);
  if (light > 0.0 && axisymmetric)
    error->all(FLERR, "Fix mpm {}: light cannot be used together with axisymmetric: use shape "
               "quadratic", id);
  if (light == 0.0 && needed && comm->me == 0)
    error->warning(FLERR, "Fix mpm {}: linear shape functions with scheme usl or transfer apic "
                   "amplify round-off at nodes of tiny mass: use transfer flip with scheme musl, "
                   "quadratic functions, or light 0.5", id);
}

/* ----------------------------------------------------------------------
   after G2P, with points still where they were: velocities of light nodes, for gradients only
------------------------------------------------------------------------- */

void FixMPM::blend_light_nodes()
{
  if (light == 0.0) return;
  clock = platform::walltime();
  constexpr int NREAL = 8;
  const auto pic = kernels->transfer(lattice.dim, kernel_shape(), PIC, true);
  rows_apart.resize(6 * (std::size_t) atom->nmax);
  for (const auto &run : runs)
    for (int i = run.first; i < run.last; i++)
      rows_apart[i] = atom->vfrac[i] * points->jacobian(i);
  PointRows r = rows();
  r.mass = rows_apart.data();
  const TransferStep s = step_data();

  nodes_apart.assign(grid->nnodes() * NREAL, 0.0);
  for (const auto &a : active) {
    const auto &block = grid->blocks[a.slot];
    int base[3], box[6] = {127, 127, 127, -127, -127, -127};
    tile_base(a, base);
    for (int k = a.first_run; k < a.last_run; k++)
      pic.p2g_momentum(r, s, runs[k].first, runs[k].last, base, tile, box);
    pic.flush(tile, nodes_apart.data(), block.slot, box);
  }
  lap(report.t_p2g);
  grid->fold_aliases(nodes_apart.data(), NREAL, 0, 4);
  halo->sum(nodes_apart.data(), NREAL, 0, 4);
  lap(report.t_halo);

  const double h = lattice.h, full = light * (lattice.dim == 3 ? h * h * h : h * h);
  double *record = grid->nodes();
  const double *mapped = nodes_apart.data();
  for (int64_t n = grid->nnodes(); n > 0; n--, record += kernel.nreal, mapped += NREAL) {
    const double volume = mapped[3];
    if (!(volume > 0.0) || volume >= full) continue;
    const double own = volume / full;
    for (int d = 0; d < 3; d++) record[d] = own * record[d] + (1.0 - own) * mapped[d] / volume;
  }
  lap(report.t_nodes);
}

/* ----------------------------------------------------------------------
   the gradient of these velocities: affine matrix, with USL stress; then points move
------------------------------------------------------------------------- */

void FixMPM::gradient_with_light_nodes()
{
  if (light == 0.0) return;
  clock = platform::walltime();
  grid->copy_aliases();
  const PointRows r = rows();
  const TransferStep s = step_data();
  double L[9 * BATCH];
  for (const auto &a : active) {
    int base[3];
    load_tile(a, base);
    for (int k = a.first_run; k < a.last_run; k++)
      for (int i = runs[k].first; i < runs[k].last; i += BATCH) {
        const int last = std::min(i + BATCH, runs[k].last);
        kernel.g2p_gradient(r, s, i, last, base, tile_load, L);
        if (C) memcpy(C[i], L, sizeof(double) * affine_size() * (last - i));
        if (scheme == USL) material_update(r, runs[k], i, last - i, L, step_dt());
      }
  }
  if (!stress_after()) move_points();
  lap(report.t_g2p);
}
