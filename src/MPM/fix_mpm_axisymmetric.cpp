/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

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

#include "fix_mpm.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "fix_mpm_boundary.h"
#include "force.h"
#include "material/batch.h"
#include "modify.h"
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

void FixMPM::check_axis()
{
  if (domain->boxlo[0] > AT_AXIS * lattice.h) return;
  for (auto *ifix : modify->get_fix_by_style("^mpm/boundary$"))
    if (dynamic_cast<FixMPMBoundary *>(ifix)->holds_axis(*this)) return;
  error->all(FLERR,
             "Fix mpm {} axisymmetric: the face of the box at x = 0 is the axis of symmetry, "
             "where nothing moves along x: use fix mpm/boundary xlo slip",
             id);
}

/* ----------------------------------------------------------------------
   distance from the axis before deformation
------------------------------------------------------------------------- */

double FixMPM::reference_radius(int i) const
{
  return atom->x[i][0] / points->F[i][8];
}

/** Distance from the axis in the total frame, as the deformation gradient has it. */
double FixMPM::total_radius(int i) const
{
  return X[i][0] * points->F[i][8] / (R ? R[i][8] : 1.0);
}

/* ---------------------------------------------------------------------- */

double FixMPM::node_circle(int slot, int node) const
{
  if (!axisymmetric) return 1.0;
  const int index = grid->side * grid->blocks[slot].b[0] + node / grid->side;
  return circle(std::max(0.25 * lattice.h, lattice.origin[0] + index * lattice.h));
}

/* ----------------------------------------------------------------------
   the factor by which hoop stress can raise the greatest frequency where no wall makes v_r odd:
   that of a ring alone is c/r, that of the lattice in the plane 2c/h, and squares add up
------------------------------------------------------------------------- */

double FixMPM::hoop_stiffening(int i) const
{
  if (domain->boxlo[0] <= AT_AXIS * lattice.h) return 1.0;
  const double ratio = 0.5 * lattice.h / place(i)[0];
  return sqrt(1.0 + ratio * ratio);
}

/* ----------------------------------------------------------------------
   strain around the axis in this step from the motion, exactly that of the radius. Total frame:
   dv of F_zz = r/R is relative to R
------------------------------------------------------------------------- */

void FixMPM::note_radii(int first, int last)
{
  for (int i = first; i < last; i++) hoop[i] = atom->x[i][0];
}

void FixMPM::hoop_of_motion(const PointRows &r, int first, int last)
{
  for (bigint i = first; i < last; i++) {
    const double radius = total ? total_radius(i) : hoop[i];
    hoop[i] = (r.xnew[3 * i] - hoop[i]) / radius;
  }
}

/* ----------------------------------------------------------------------
   the same from the velocities of the nodes, for the schemes that update stress apart from the
   motion; shift: see shift_gradient()
------------------------------------------------------------------------- */

void FixMPM::hoop_of_nodes(const PointRows &r, const TransferStep &step, int first, int last,
                           const int base[3], double dt, double shift)
{
  const PointRows rows = rows_at_rest(v_apart.data(), r.mass);
  TransferStep s = step;
  s.dt = 0.0;
  pic.g2p(rows, s, first, last, base, tile_load, nullptr);
  for (bigint i = first; i < last; i++) {
    const double rate = v_apart[3 * i] / (total ? total_radius(i) : atom->x[i][0]);
    hoop[i] = dt * rate / (1.0 - shift * rate);
  }
}

/* ----------------------------------------------------------------------
   external forces of the points, and what hoop stress adds, in units of force
------------------------------------------------------------------------- */

void FixMPM::add_hoop_force(const PointRows &r, bigint first, int n, double *f) const
{
  const double unit = 1.0 / force->nktv2p;
  std::copy_n(r.f + 3 * first, 3 * n, f);
  for (int p = 0; p < n; p++) {
    const bigint i = first + p;
    const double radius = total ? total_radius(i) : r.x[3 * i];
    f[3 * p] -= unit * r.vol0[i] * r.tau[6 * i + 2] / radius;
  }
}
