/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FRAME_AXISYMMETRIC_H
#define LMP_MPM_FRAME_AXISYMMETRIC_H

/* ----------------------------------------------------------------------
   Bodies of revolution in 2d: x is the distance r from the axis, y the place along it, zz the
   direction around it. A point is a ring; its volume, mass, forces, and energies are those of the
   whole ring (D. Sulsky, H.L. Schreyer, Comput. Methods Appl. Mech. Eng. 139 (1996) 409; for
   points of finite size J.A. Nairn, J.E. Guilkey, Int. J. Numer. Methods Eng. 101 (2015) 127).

   Beyond plane strain there are a strain rate and a force, which are conjugate to each other,

     L_zz = sum_i N_ip v_ir / r_p,   f_ir = ... - sum_p V_p sigma_zz N_ip / r_p

   The force is distributed like an external one, so that the kernels of plane strain serve. As
   shape functions reproduce linear fields, v_r = a r gives the strain rate a in all directions at
   any place, also next to the axis. With points on a regular array that fills whole cells, a
   uniform stress makes no force on the nodes inside, sum_p [r_p dN/dr + N] = 0, for B-splines
   of any order; next to the axis this holds for linear functions and GIMP, while for the others
   the sum over points has the error of the midpoint rule there, as r N is a cubic of r.

   At the axis, v_r is odd and v_r / r no larger than the slope of v_r: the wall there holds the
   velocities of nodes beyond the axis to minus those inside. The greatest frequency of the lattice
   with it is at most 3 % above that in the plane, less than what the limit h/c has to spare.
------------------------------------------------------------------------- */

#include "mpm_frame_total.h"

#include <vector>

namespace LAMMPS_NS {

/** An axis of symmetry in a frame of plane strain. */
template <class Plane> class MPMFrameAxisymmetric : public Plane {
 public:
  using Plane::Plane;

  void check() const override;
  bool changes_forces() const override { return true; }
  void forces(MPM_NS::PointRows &, int first, int n, MPMFrame::ForceRows &) const override;
  void begin_strain() override;
  void before_motion(int first, int last) override;
  void after_motion(const MPM_NS::PointRows &, int first, int last) override;
  void strain_of_nodes(const MPM_NS::PointRows &, const MPM_NS::TransferStep &, int first, int last,
                       const int *base, double dt, double shift) override;
  void load(MPM_NS::Batch &, int first, int n, double dt, const double *L, const double *F,
            const double *tau, const double *vol0) const override;
  double volume_change(int i, const double *L, double dt) const override;
  void stretch(int i, double more, double dt, double *L) override;
  bool is_plane() const override { return false; }
  double speed(int i, double &c) const override;
  double circle(double r) const override { return 6.28318530717958647693 * r; }
  double node_circle(int slot, int node) const override;
  double section(int i) const override;
  double memory_usage() const override;
  double bytes_per_point() const override { return Plane::bytes_per_point() + sizeof(double); }

 private:
  std::vector<double> hoop;    // [n] strain around the axis in this step
};

}    // namespace LAMMPS_NS
#endif
