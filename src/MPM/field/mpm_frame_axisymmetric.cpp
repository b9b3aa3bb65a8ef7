/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Bodies of revolution in 2d: x is the distance r from the axis, points are rings, and zz is the
 *  direction around it (D. Sulsky, H.L. Schreyer, Comput. Methods Appl. Mech. Eng. 139 (1996) 409;
 *  points of finite size: J.A. Nairn, J.E. Guilkey, Int. J. Numer. Methods Eng. 101 (2015) 127).
 *  Beyond plane strain there are a strain rate and a force, conjugate to each other,
 *
 *    L_zz = sum_i N_ip v_ir / r_p,   f_ir = ... - sum_p V_p sigma_zz N_ip / r_p */

#include "base/mpm_find_fixes.h"
#include "base/mpm_points.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_frame.h"
#include "field/mpm_node_action.h"
#include "field/mpm_point_map.h"
#include "force.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// a box that begins nearer than this to the axis, in node spacings, has the axis for a face
static constexpr double AT_AXIS = 1.0e-6;

namespace {

/** An axis of symmetry in a frame of plane strain. */
template <class Plane> class MPMFrameAxisymmetric : public Plane {
 public:
  using Plane::Plane;

  /** Nodes beyond the axis mirror those inside. */
  void check() const override
  {
    Plane::check();
    if (domain->boxlo[0] > AT_AXIS * field.lattice.h) return;
    for (const auto *action : find_fixes<MPMNodeAction>(this->lmp))
      if (action->holds_axis(field)) return;
    this->error->all(FLERR,
                     "Fix mpm {} axisymmetric: the face of the box at x = 0 is the axis of "
                     "symmetry, where nothing moves along x: use fix mpm/boundary xlo slip",
                     field.id());
  }

  /** External forces of the points, and what hoop stress adds, in units of force. */
  bool changes_forces() const override { return true; }
  void forces(PointRows &rows, int first, int n, MPMFrame::ForceRows &room) const override
  {
    Plane::forces(rows, first, n, room);
    const double unit = 1.0 / this->force->nktv2p;
    std::copy_n(rows.f, 3 * n, room.f);
    for (int p = 0; p < n; p++) {
      const double radius = this->radius(first + p, rows.x[3 * p]);
      room.f[3 * p] -= unit * rows.vol0[p] * rows.tau[6 * p + 2] / radius;
    }
    rows.f = room.f;
  }

  // strain around the axis in this step from the motion, exactly that of the radius. Total frame:
  // dv of F_zz = r/R is relative to R

  void begin_strain() override { hoop.resize(atom->nmax); }
  void before_motion(int first, int last) override
  {
    for (int i = first; i < last; i++) hoop[i] = atom->x[i][0];
  }
  void after_motion(const PointRows &rows, int first, int last) override
  {
    for (bigint i = first; i < last; i++)
      hoop[i] = (rows.xnew[3 * i] - hoop[i]) / this->radius((int) i, hoop[i]);
  }

  /** The same from the velocities of the nodes, for the schemes that update stress apart from the
   *  motion; shift: see MPMFrame::shift_gradients(). */
  void strain_of_nodes(const PointRows &r, int first, int last, const int *base, double dt,
                       double shift) override
  {
    field.work.vectors.resize(3 * (std::size_t) atom->nmax);
    const PointRows rows = field.rows_at_rest(field.work.vectors.data(), r.mass);
    field.pic.g2p(rows, field.step_data(0.0), first, last, base, field.map->tile_load, nullptr);
    if (this->is_total()) shift = 0.0;
    for (bigint i = first; i < last; i++) {
      const double rate = field.work.vectors[3 * i] / this->radius((int) i, atom->x[i][0]);
      hoop[i] = dt * rate / (1.0 - shift * rate);
    }
  }

  double volume_change(int i, const double *L, double dt) const override
  {
    const double plane = Plane::volume_change(i, L, dt);
    return plane + hoop[i] + plane * hoop[i];
  }
  void stretch(int i, double more, double dt, double *L) override
  {
    Plane::stretch(i, more, dt, L);
    hoop[i] += more * (1.0 + hoop[i]);
  }

  /** Hoop stress can raise the greatest frequency where no wall makes v_r odd: that of a ring alone
   *  is c/r, that of the lattice in the plane 2c/h, and squares add up. */
  double speed(int i, double &c, double known) const override
  {
    const double h = field.lattice.h;
    if (domain->boxlo[0] > AT_AXIS * h) {
      const double ratio = 0.5 * h / field.frame->places()[i][0];
      c *= sqrt(1.0 + ratio * ratio);
    }
    return Plane::speed(i, c, known);
  }

  double circle(double r) const override { return 6.28318530717958647693 * r; }
  double node_circle(int slot, int node) const override
  {
    const auto &grid = field.grid;
    const int index = grid.side * grid.blocks[slot].b[0] + node / grid.side;
    return circle(std::max(0.25 * grid.lattice.h, grid.lattice.origin[0] + index * grid.lattice.h));
  }
  /** The distance from the axis before deformation is x/F_zz. */
  double section(int i) const override
  {
    return atom->vfrac[i] / circle(atom->x[i][0] / field.points->F[i][8]);
  }

  double memory_usage() const override { return hoop.capacity() * sizeof(double); }
  double bytes_per_point() const override { return sizeof(double); }

 protected:
  const double *hoop_strain(int first) const override { return &hoop[first]; }

 private:
  using Plane::atom, Plane::domain, Plane::field;
  std::vector<double> hoop;    // [n] strain around the axis in this step
};

}    // namespace

std::unique_ptr<MPMFrame> MPMFrame::create(LAMMPS *lmp, MPMField &field, MPMPointState &state)
{
  const auto &options = field.options;
  if (options.axisymmetric && options.total)
    return std::make_unique<MPMFrameAxisymmetric<MPMFrameTotal>>(lmp, field, state);
  if (options.axisymmetric) return std::make_unique<MPMFrameAxisymmetric<MPMFrame>>(lmp, field);
  if (options.total) return std::make_unique<MPMFrameTotal>(lmp, field, state);
  return std::make_unique<MPMFrame>(lmp, field);
}
