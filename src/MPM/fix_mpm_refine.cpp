/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Velocities of the nodes by more terms of the inverse of the full mass matrix: XPIC and FMPM.

#include "fix_mpm.h"

#include "atom.h"
#include "fix_mpm_passes.h"
#include "platform.h"
#include "update.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   With S from nodes to points, S+ = m^-1 S^T M back, and u the velocity p/m of the nodes, the full
   mass matrix gives (S+ S)^-1 u, of which m terms of the Neumann series are

     u_1 = u,   u_(n+1) = u_n + (u - S+ S u_n)

   so that S u_m = [I - (I - S S+)^m] v for u = S+ v: of the velocities of the points, only what
   (I - S S+)^m leaves is removed, noise that the nodes do not see. m = 1 is PIC.

   XPIC(m) (C.C. Hammerquist, J.A. Nairn, Comput. Methods Appl. Mech. Eng. 318 (2017) 724) does
   this to the velocity of the start of the step and adds the increment of the lumped solve;
   positions move with the lumped velocity. FMPM(m) (J.A. Nairn, C.C. Hammerquist, Comput. Methods
   Appl. Mech. Eng. 380 (2021) 113794) does it to the new velocity, which then also moves positions.
   There the node actions follow each term: with P the projection of a wall, orthogonal in the norm
   of the kinetic energy, P S+ S P has its eigenvalues between 0 and 1 as S+ S has, and the series
   converges; a wall that acts after the last term only puts energy into the body.

   The transfer that follows is v_p = S v_new + flip (v_p - S v_old). XPIC clears v_p and leaves
   v_old - u_m in the place of v_old; FMPM leaves u_m in that of v_new, with flip = 0.
------------------------------------------------------------------------- */

void FixMPM::refine_velocities()
{
  int terms = 1;
  for (auto *field : fields) {
    if (field->refinement == XPIC) field->filter_old_velocities();
    if (field->refinement == FMPM) {
      field->save_velocities(0);
      terms = std::max(terms, field->order);
    }
  }
  for (int n = 2; n <= terms; n++) {
    for (auto *field : fields)
      if (field->refinement == FMPM && n <= field->order) field->add_term(0);
    act_on_nodes(MPMNodeAction::AGAIN);
  }
}

/* ---------------------------------------------------------------------- */

void FixMPM::filter_old_velocities()
{
  save_velocities(4);
  for (int n = 2; n <= order; n++) add_term(4);
  double *record = grid->nodes() + 4;
  const double *old = lumped.data();
  for (int64_t n = grid->nnodes(); n > 0; n--, record += 8, old += 3)
    for (int d = 0; d < 3; d++) record[d] = old[d] - record[d];
  for (const auto &run : runs)
    memset(&atom->v[run.first][0], 0, 3 * sizeof(double) * (run.last - run.first));
}

/* ----------------------------------------------------------------------
   old velocities of the nodes and what XPIC has put in their place change places: the ledger needs
   the former for a moment
------------------------------------------------------------------------- */

void FixMPM::swap_old_velocities()
{
  double *record = grid->nodes() + 4;
  for (std::size_t k = 0; k < lumped.size(); k += 3, record += 8)
    for (int d = 0; d < 3; d++) std::swap(record[d], lumped[k + d]);
}

/* ---------------------------------------------------------------------- */

void FixMPM::save_velocities(int lane)
{
  lumped.resize(3 * grid->nnodes());
  const double *record = grid->nodes() + lane;
  for (std::size_t k = 0; k < lumped.size(); k += 3, record += 8)
    for (int d = 0; d < 3; d++) lumped[k + d] = record[d];
}

/* ----------------------------------------------------------------------
   u <- u + (saved - S+ S u) for the velocities u at a place of the records
------------------------------------------------------------------------- */

void FixMPM::add_term(int lane)
{
  clock = platform::walltime();
  const int NREAL = pic.nreal;
  const int64_t nnodes = grid->nnodes();
  double *const record = grid->nodes();
  const double before = ledger_on ? nodal_kinetic_energy(0) : 0.0;
  v_apart.assign(3 * (std::size_t) atom->nmax, 0.0);
  const PointRows r = rows_at_rest(v_apart.data(), atom->rmass);
  TransferStep s = step_data();
  s.dt = 0.0;

  nodes_apart.assign(nnodes * NREAL, 0.0);
  for (int64_t n = 0; n < nnodes; n++)
    for (int d = 0; d < 3; d++) nodes_apart[NREAL * n + d] = record[NREAL * n + lane + d];
  grid->copy_aliases(nodes_apart.data(), NREAL);
  for (auto &a : active) std::copy_n(a.box, 6, a.box_apart);    // points are where they were
  gather_apart(pic, [&](const Run &run, const int *base) {
    pic.g2p(r, s, run.first, run.last, base, tile_load, nullptr);
  });
  map_apart(pic, [&](const Run &run, const int *base, int *box) {
    pic.p2g_momentum(r, s, run.first, run.last, base, tile, box);
  });
  sum_copies(nodes_apart.data(), NREAL, 0, 3);

  for (int64_t n = 0; n < nnodes; n++) {
    const double m = record[NREAL * n + 3];
    if (!(m > 0.0)) continue;
    for (int d = 0; d < 3; d++)
      record[NREAL * n + lane + d] += lumped[3 * n + d] - nodes_apart[NREAL * n + d] / m;
  }
  if (ledger_on) ledger.transfer += nodal_kinetic_energy(0) - before;
  lap(report.t_nodes);
}
