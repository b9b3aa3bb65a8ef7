/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Nodes with next to no mass: velocity gradients that they do not spoil.

#include "fix_mpm.h"
#include "fix_mpm_visit.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_mpm_passes.h"
#include "material/batch.h"
#include "mpm_points.h"
#include "platform.h"

#include <algorithm>
#include <cmath>

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
   node; with an axis of symmetry areas in the plane, as the ring of a node far from the axis is heavy
   whatever share of its cells is full, and so is the force on it. Strain around the axis needs no
   cure: v_i has the weight N/r there, not 1/h, and stays that of the motion.

   With the averages against locking, force and strain are further from belonging together. Where the affine
   matrix feeds the difference back in the same step, USL, points at the edge gain energy in bursts, by 1000 times
   in 6000 steps at half of the limit of the time step; MUSL, and FLIP, damp as without. The same is seen of USF
   in axisymmetric runs.
------------------------------------------------------------------------- */

/** Is the option of use, and if not given, is it needed? */
void FixMPM::check_light_nodes()
{
  const bool needed =
      !total && shape == LINEAR && extent == NO_SIZE && (scheme == USL || is_affine(transfer));
  if (light > 0.0 && !needed)
    error->all(FLERR,
               "Fix mpm {}: light is of no use with this shape, transfer and scheme: remove "
               "light, which is for shape linear with scheme usl or transfer apic, aflip, tpic",
               id);
  if (light > 0.0 && locking != NO_CURE && scheme == USL && is_affine(transfer))
    error->all(
        FLERR,
        "Fix mpm {}: light and locking together are unstable with scheme usl and transfer apic, "
        "aflip, tpic: use scheme musl, or transfer flip",
        id);
  if (light > 0.0 && axisymmetric && scheme == USF)
    error->all(
        FLERR,
        "Fix mpm {}: light and axisymmetric together are unstable with scheme usf: use scheme "
        "usl or musl",
        id);
  if (light == 0.0 && needed && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {}: linear shape functions with scheme usl or transfer apic "
                   "amplify round-off at nodes of tiny mass: use transfer flip with scheme musl, "
                   "quadratic functions, or light 0.5",
                   id);
}

bool FixMPM::any_light() const
{
  return std::any_of(fields.begin(), fields.end(), [](auto *field) {
    return field->light > 0.0;
  });
}

/* ----------------------------------------------------------------------
   The total frame has no cure, but its lattice does not change: the largest stable time step in h/c is
   known. A node with the stiffness k = sum_p V_p E |grad N_ip|^2 and the mass m = sum_p m_p N_ip is stable
   for dt < (m/k)^1/2 with USL; this is what trials give within 15 %, and 1.6 times as much with affine
   matrices. Bernstein functions of the middle of a cell begin like linear ones.
------------------------------------------------------------------------- */

double FixMPM::light_share()
{
  if (!total || !(scheme == USL || is_affine(transfer)) || !(shape == LINEAR || bernstein))
    return 1.0;
  find_topology();
  constexpr int NREAL = 2;
  std::vector<double> sums(grid->nnodes() * NREAL, 0.0);
  for (const auto &run : runs)
    for (int i = run.first; i < run.last; i++)
      visit_nodes(grid->blocks[run.slot], i, [&](int64_t node, double weight, const double *r) {
        if (weight <= 0.0) return;
        double slope = 0.0;    // square of grad N / N
        int index[3];
        grid->node_index(grid->blocks[node / NODES_PER_BLOCK], (int) (node % NODES_PER_BLOCK),
                         index);
        for (int d = 0; d < lattice.dim; d++) {
          const double a = fabs(r[d]);
          if (!bernstein)
            slope += 1.0 / ((1.0 - a) * (1.0 - a));
          else if (index[d] % 2)
            slope += 4.0 * a * a / ((1.0 - a * a) * (1.0 - a * a));
          else
            slope += 1.0 / ((1.0 - 0.5 * a) * (1.0 - 0.5 * a));
        }
        sums[node * NREAL] += atom->vfrac[i] * weight;
        sums[node * NREAL + 1] += atom->vfrac[i] * weight * weight * slope;
      });
  sum_copies(sums.data(), NREAL, 0, NREAL);
  double mine = 0.0, all;
  for (std::size_t k = 0; k < sums.size(); k += NREAL)
    if (sums[k] > 0.0) mine = std::max(mine, sums[k + 1] / sums[k]);
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all > 1.0 ? 1.0 / sqrt(all) : 1.0;
}

/* ----------------------------------------------------------------------
   after G2P, with points still where they were: velocities of light nodes, for gradients only
------------------------------------------------------------------------- */

void FixMPM::blend_light_nodes()
{
  if (light == 0.0) return;
  clock = platform::walltime();
  rows_apart.resize(std::max(rows_apart.size(), (std::size_t) atom->nmax));
  for (const auto &run : runs)
    for (int i = run.first; i < run.last; i++)
      rows_apart[i] = atom->vfrac[i] * points->jacobian(i) / circle(atom->x[i][0]);
  PointRows r = rows();
  r.mass = rows_apart.data();
  const TransferStep s = step_data();
  map_apart(pic, [&](const Run &run, const int *base, int *box) {
    pic.p2g_momentum(r, s, run.first, run.last, base, tile, box);
  });
  lap(report.t_p2g);
  sum_copies(nodes_apart.data(), pic.nreal, 0, 4);
  lap(report.t_halo);

  const double h = lattice.h, full = light * (lattice.dim == 3 ? h * h * h : h * h);
  double *record = grid->nodes();
  const double *mapped = nodes_apart.data();
  for (int64_t n = grid->nnodes(); n > 0; n--, record += kernel.nreal, mapped += pic.nreal) {
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
  const bool fbar = scheme == USL && averages_strain();
  if (fbar && !C) gradients.resize(affine_size() * (std::size_t) atom->nmax);
  double *const of_all = C ? &C[0][0] : (fbar ? gradients.data() : nullptr);
  const PointRows r = rows();
  visit_gradients(of_all, [&](const Run &run, int i, int n, const int *, const double *L) {
    if (scheme == USL && !fbar) material_update(r, run, i, n, L, step_dt());
  });
  if (fbar) averaged_material(of_all, step_dt());
  if (!stress_after()) move_points();
  lap(report.t_g2p);
}
