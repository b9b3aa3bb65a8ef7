/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TRIAL_MOTION_H
#define LMP_MPM_TRIAL_MOTION_H

#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "material/batch_kernels.h"
#include "pointers.h"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <vector>

namespace LAMMPS_NS {

/** A motion of the nodes of a field that is only tried: what points see of it, and what their
 *  stress brings to nodes.
 *
 *  A motion is a vector u [node][dim] of displacements in the step. A point has their gradient H_ij
 *  = du_i/dX_j with respect to the places of the lattice, and H_zz = u_r/r if there is an axis of
 *  symmetry. Conjugate to these is the first Piola-Kirchhoff stress P = tau (F + H)^-T per unit of
 *  the initial volume, where F is the deformation of the places of the lattice at the start of the
 *  step: unity in the updated frame. Entries of H and P are column-major, with the entry around the
 *  axis at the end. Forces on nodes are in units of mass times acceleration. */
class MPMTrialMotion : protected Pointers {
 public:
  MPMTrialMotion(class LAMMPS *, MPMField &);
  ~MPMTrialMotion() noexcept override;

  /** Should the deformation of points be kept from now on? */
  void keep_deformations(bool keeps);
  /** [k][dim][dim] Rotations of the places of the lattice around the nodes of a list, from the mean
   *  deformation of the points there after the last motion that was kept; unity where there are no
   *  points. Collective. */
  void mean_rotations(const std::vector<int64_t> &of, std::vector<double> &rotations);

 protected:
  MPMField &field;
  const int dim, nL, nH;    // entries of a gradient without the axis of symmetry, and of H
  std::unique_ptr<MPM_NS::Batch> batch;
  std::vector<double> P, hoop_stress;    // [point][nL], and what belongs to H_zz
  std::vector<double> point_motion;      // [point][3] of move_points()
  bool keeps_deformations = false;

  /** Start of a run: choose the transfers. */
  void init();
  /** Calls use(run, first, n, H) with the gradients H [n][nH] of the motion u for up to BATCH
   *  points from first on. Collective. */
  template <class Use> void gather(const double *u, const Use &use);
  /** From points to nodes: P and hoop_stress, and other forces on points [force]. Collective. */
  void scatter(const double *forces_of_points, double *force);
  /** Finds displacements of points by the motion u. Collective. */
  void move_points(const double *u);
  void clear_stress();
  /** Deformation of the places of the lattice after H of n points from first on, as in MPMFrame. */
  void lattice_F(int first, int n, const double *H, double *F) const;
  /** Kinematics of n points from first on after H, in the batch. */
  void deform(int first, int n, const double *H);
  /** P [n][nH] of the Kirchhoff stress tau [n][6] after H. */
  void find_piola(int first, int n, const double *H, const double *tau, double *stress) const;
  void keep_deformations(int first, int n, const double *H);
  /** Gradient along d of the function of a node at a point. */
  double gradient(const MPMStencil::Node &node, int d) const
  {
    return mls ? -mls_moment * node.weight * node.r[d] : node.gradient[d];
  }
  /** 1/r of point i around an axis of symmetry, else 0. */
  double turn_of(bigint i) const
  {
    return nH > nL ? 1.0 / field.frame->radius((int) i, field.frame->places()[i][0]) : 0.0;
  }
  double memory_usage() const;

 private:
  MPM_NS::TransferKernels with;    // points to nodes by P
  bool mls = false;                // do gradients use moving least squares?
  // gradients of moving least squares are weights times distances [node spacings] times minus this
  double mls_moment = 0.0;
  std::vector<double> nodes, motion_nodes, forces_on_points, deformations;
};

template <class Use> void MPMTrialMotion::gather(const double *u, const Use &use)
{
  // all but the motion stays zero
  const std::size_t nreals = field.grid.nnodes() * with.nreal;
  if (motion_nodes.size() != nreals) motion_nodes.assign(nreals, 0.0);
  const auto give = [&](auto constant) {
    constexpr int D = decltype(constant)::value;
    double *record = motion_nodes.data();
    const int64_t end = D * field.grid.nnodes();
    for (int64_t k = 0; k < end; k += D, record += with.nreal) std::copy_n(u + k, D, record);
  };
  if (dim == 2)
    give(std::integral_constant<int, 2>());
  else
    give(std::integral_constant<int, 3>());
  field.nodes.complete(motion_nodes.data(), with.nreal, 3);
  MPM_NS::PointRows rows = field.rows();
  rows.P = P.data();
  rows.F = nullptr;
  const MPM_NS::TransferStep step = field.step_data();
  double L[9 * MPM_NS::BATCH], H[10 * MPM_NS::BATCH], motion[3 * MPM_NS::BATCH];
  points_from(motion_nodes, field, with, [&](const MPMPointMap::Run &run, const int *base) {
    for (int i = run.first; i < run.last; i += MPM_NS::BATCH) {
      const int n = std::min(MPM_NS::BATCH, run.last - i);
      MPM_NS::PointRows b = rows_from(field, rows, i);
      b.P = P.data() + (bigint) nL * i;
      if (nH > nL) b.velocity = motion;
      with.g2p_gradient(b, step, 0, n, base, field.map->tile_load, L);
      if (nH == nL) {
        use(run, i, n, L);
        continue;
      }
      for (int p = 0; p < n; p++) {
        std::copy_n(L + nL * p, nL, H + nH * p);
        H[nH * p + nL] = motion[3 * p] / field.frame->radius(i + p, b.x[3 * p]);
      }
      use(run, i, n, H);
    }
  });
}

}    // namespace LAMMPS_NS
#endif
