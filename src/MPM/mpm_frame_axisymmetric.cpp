/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_frame_axisymmetric.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "fix_mpm_boundary.h"
#include "force.h"
#include "material/batch.h"
#include "modify.h"
#include "mpm_field.h"
#include "mpm_point_map.h"
#include "mpm_points.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// a box that begins nearer than this to the axis, in node spacings, has the axis for a face
static constexpr double AT_AXIS = 1.0e-6;

/* ----------------------------------------------------------------------
   nodes beyond the axis mirror those inside
------------------------------------------------------------------------- */

template <class Plane> void MPMFrameAxisymmetric<Plane>::check() const
{
  Plane::check();
  const auto *domain = this->domain;
  if (domain->boxlo[0] > AT_AXIS * this->field.lattice.h) return;
  for (auto *ifix : this->modify->get_fix_by_style("^mpm/boundary$"))
    if (dynamic_cast<FixMPMBoundary *>(ifix)->holds_axis(this->field)) return;
  this->error->all(FLERR,
                   "Fix mpm {} axisymmetric: the face of the box at x = 0 is the axis of symmetry, "
                   "where nothing moves along x: use fix mpm/boundary xlo slip",
                   this->field.id());
}

/* ----------------------------------------------------------------------
   external forces of the points, and what hoop stress adds, in units of force
------------------------------------------------------------------------- */

template <class Plane>
void MPMFrameAxisymmetric<Plane>::forces(PointRows &rows, int first, int n,
                                         MPMFrame::ForceRows &room) const
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

/* ----------------------------------------------------------------------
   strain around the axis in this step from the motion, exactly that of the radius. Total frame:
   dv of F_zz = r/R is relative to R
------------------------------------------------------------------------- */

template <class Plane> void MPMFrameAxisymmetric<Plane>::begin_strain()
{
  hoop.resize(this->atom->nmax);
}

template <class Plane> void MPMFrameAxisymmetric<Plane>::before_motion(int first, int last)
{
  for (int i = first; i < last; i++) hoop[i] = this->atom->x[i][0];
}

template <class Plane>
void MPMFrameAxisymmetric<Plane>::after_motion(const PointRows &rows, int first, int last)
{
  for (bigint i = first; i < last; i++)
    hoop[i] = (rows.xnew[3 * i] - hoop[i]) / this->radius((int) i, hoop[i]);
}

/* ----------------------------------------------------------------------
   the same from the velocities of the nodes, for the schemes that update stress apart from the
   motion; shift: see MPMFrame::shift_gradients()
------------------------------------------------------------------------- */

template <class Plane>
void MPMFrameAxisymmetric<Plane>::strain_of_nodes(const PointRows &r, const TransferStep &step,
                                                  int first, int last, const int *base, double dt,
                                                  double shift)
{
  auto &field = this->field;
  field.work.vectors.resize(3 * (std::size_t) this->atom->nmax);
  const PointRows rows = field.rows_at_rest(field.work.vectors.data(), r.mass);
  TransferStep s = step;
  s.dt = 0.0;
  field.pic.g2p(rows, s, first, last, base, field.map->tile_load, nullptr);
  if (this->is_total()) shift = 0.0;
  for (bigint i = first; i < last; i++) {
    const double rate = field.work.vectors[3 * i] / this->radius((int) i, this->atom->x[i][0]);
    hoop[i] = dt * rate / (1.0 - shift * rate);
  }
}

template <class Plane>
void MPMFrameAxisymmetric<Plane>::load(Batch &b, int first, int n, double dt, const double *L,
                                       const double *F, const double *tau, const double *vol0) const
{
  const auto &kernels = *this->field.batch_kernels;
  (this->is_total() ? kernels.load_total : kernels.load)(b, n, dt, L, F, tau, vol0, &hoop[first]);
}

template <class Plane>
double MPMFrameAxisymmetric<Plane>::volume_change(int i, const double *L, double dt) const
{
  const double plane = Plane::volume_change(i, L, dt);
  return plane + hoop[i] + plane * hoop[i];
}

template <class Plane>
void MPMFrameAxisymmetric<Plane>::stretch(int i, double more, double dt, double *L)
{
  Plane::stretch(i, more, dt, L);
  hoop[i] += more * (1.0 + hoop[i]);
}

/* ----------------------------------------------------------------------
   hoop stress can raise the greatest frequency where no wall makes v_r odd: that of a ring alone is
   c/r, that of the lattice in the plane 2c/h, and squares add up
------------------------------------------------------------------------- */

template <class Plane> double MPMFrameAxisymmetric<Plane>::speed(int i, double &c) const
{
  const double h = this->field.lattice.h;
  if (this->domain->boxlo[0] > AT_AXIS * h) {
    const double ratio = 0.5 * h / this->field.frame->places()[i][0];
    c *= sqrt(1.0 + ratio * ratio);
  }
  return Plane::speed(i, c);
}

template <class Plane> double MPMFrameAxisymmetric<Plane>::node_circle(int slot, int node) const
{
  const auto &grid = this->field.grid;
  const int index = grid.side * grid.blocks[slot].b[0] + node / grid.side;
  return circle(std::max(0.25 * grid.lattice.h, grid.lattice.origin[0] + index * grid.lattice.h));
}

/** The distance from the axis before deformation is x/F_zz. */
template <class Plane> double MPMFrameAxisymmetric<Plane>::section(int i) const
{
  return this->atom->vfrac[i] / circle(this->atom->x[i][0] / this->field.points->F[i][8]);
}

template <class Plane> double MPMFrameAxisymmetric<Plane>::memory_usage() const
{
  return Plane::memory_usage() + hoop.capacity() * sizeof(double);
}

template class LAMMPS_NS::MPMFrameAxisymmetric<MPMFrame>;
template class LAMMPS_NS::MPMFrameAxisymmetric<MPMFrameTotal>;
