/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Velocities of the nodes by more terms of the inverse of the full mass matrix: XPIC and FMPM.

#include "fix_mpm.h"

#include "atom.h"
#include "mpm_halo.h"
#include "platform.h"
#include "update.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   With S from nodes to points, S+ = m^-1 S^T M back, and u the velocity p/m of the nodes, the full
   mass matrix gives (S+ S)^-1 u, of which m terms of the Neumann series are

     u* = sum_j (-1)^(j+1) u_j,   u_1 = m u,   u_j = (m - j + 1)/j S+ S u_(j-1)

   so that S u* = [I - (I - S S+)^m] v for u = S+ v: of the velocities of the points, only what
   (I - S S+)^m leaves is removed, noise that the nodes do not see. m = 1 is PIC.

   XPIC(m) (C.C. Hammerquist, J.A. Nairn, Comput. Methods Appl. Mech. Eng. 318 (2017) 724) does
   this to the velocity of the start of the step and adds the increment of the lumped solve;
   positions move with the lumped velocity. FMPM(m) (J.A. Nairn, C.C. Hammerquist, Comput. Methods
   Appl. Mech. Eng. 380 (2021) 113794) does it to the new velocity, which then also moves positions.

   The transfer that follows is v_p = S v_new + flip (v_p - S v_old). XPIC clears v_p and leaves
   v_new - (u* + v_new - v_old) in the place of v_old; FMPM leaves u* in that of v_new, with flip = 0.
------------------------------------------------------------------------- */

void FixMPM::refine_velocities()
{
  clock = platform::walltime();
  constexpr int NREAL = 8;
  const int64_t nnodes = grid->nnodes();
  const int lane = refinement == XPIC ? 4 : 0;
  double *const record = grid->nodes();
  const double before = ledger_on ? nodal_kinetic_energy(0) : 0.0;

  const auto pic = kernels->transfer(lattice.dim, shape, PIC, true);
  const std::size_t nrows = 3 * (std::size_t) atom->nmax;
  v_apart.assign(nrows, 0.0);
  xnew.resize(nrows);
  PointRows r = rows();
  r.v = v_apart.data();
  r.xnew = xnew.data();    // not used
  TransferStep s = step_data();
  s.dt = 0.0;

  nodes_apart.assign(nnodes * NREAL, 0.0);
  refined.resize(3 * nnodes);
  for (int64_t n = 0; n < nnodes; n++)
    for (int d = 0; d < 3; d++)
      refined[3 * n + d] = nodes_apart[NREAL * n + d] = order * record[NREAL * n + lane + d];

  for (int j = 2; j <= order; j++) {
    grid->copy_aliases(nodes_apart.data(), NREAL);
    for (const auto &a : active) {
      const auto &block = grid->blocks[a.slot];
      int base[3];
      for (int d = 0; d < 3; d++) base[d] = grid->side * block.b[d] - 1;
      pic.load(tile_load, nodes_apart.data(), block.slot, a.box);
      for (int k = a.first_run; k < a.last_run; k++)
        pic.g2p(r, s, runs[k].first, runs[k].last, base, tile_load, nullptr);
    }
    nodes_apart.assign(nnodes * NREAL, 0.0);
    for (auto &a : active) {
      const auto &block = grid->blocks[a.slot];
      int base[3], box[6] = {127, 127, 127, -127, -127, -127};
      for (int d = 0; d < 3; d++) base[d] = grid->side * block.b[d] - 1;
      for (int k = a.first_run; k < a.last_run; k++)
        pic.p2g_momentum(r, s, runs[k].first, runs[k].last, base, tile, box);
      pic.flush(tile, nodes_apart.data(), block.slot, box);
    }
    grid->fold_aliases(nodes_apart.data(), NREAL, 0, 3);
    halo->sum(nodes_apart.data(), NREAL, 0, 3);
    const double factor = (order - j + 1.0) / j, sign = j % 2 ? 1.0 : -1.0;
    for (int64_t n = 0; n < nnodes; n++) {
      const double m = record[NREAL * n + 3], scale = m > 0.0 ? factor / m : 0.0;
      for (int d = 0; d < 3; d++) {
        nodes_apart[NREAL * n + d] *= scale;
        refined[3 * n + d] += sign * nodes_apart[NREAL * n + d];
      }
    }
  }

  for (int64_t n = 0; n < nnodes; n++)
    for (int d = 0; d < 3; d++) {
      double *const v = record + NREAL * n + d;
      if (refinement == XPIC)
        v[4] -= refined[3 * n + d];
      else
        v[0] = refined[3 * n + d];
    }
  if (refinement == XPIC)
    for (const auto &run : runs)
      memset(&atom->v[run.first][0], 0, 3 * sizeof(double) * (run.last - run.first));
  if (ledger_on) ledger.transfer += nodal_kinetic_energy(0) - before;
  lap(report.t_nodes);
}
