/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Stress mls has the integral of N (x_i - x)/D over a body in the place of that of the gradient of
   N. Both are along the normal of a surface that is along the lattice; next to an inclined one that
   of mls is not, so that stress along a free surface pulls at its nodes. Points move to undo that,
   come to other places, and the skin of a body loses stress in each static step, and on the whole
   way of a dynamic relaxation, which takes many more steps for it. The rotation is the mean over
   points by their equivalent stress: fluids, and what has failed, have none.
------------------------------------------------------------------------- */

#include "implicit/mpm_mls_rotation.h"

#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "transfer/kernels.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "lammps.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
static constexpr double LARGE = 0.02;    // rotation of which it is warned [rad]

double LAMMPS_NS::mls_rotation(const MPMField &field)
{
  const auto &options = field.options;
  if (field.frame->is_total() || !is_mls(options.shape, options.transfer) ||
      options.strains_by_gradient())
    return 0.0;
  double mine[2] = {0.0, 0.0}, all[2];
  for (int i = 0; i < field.atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const double *const F = field.points->F[i];
    double s[6];
    field.points->cauchy(i, s);
    const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0],
                 shear = std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) +
                                   3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])),
                 wx = F[7] - F[5], wy = F[2] - F[6], wz = F[3] - F[1],
                 turn =
                     std::atan2(std::sqrt(wx * wx + wy * wy + wz * wz), F[0] + F[4] + F[8] - 1.0);
    mine[0] += field.atom->vfrac[i] * shear * turn;
    mine[1] += field.atom->vfrac[i] * shear;
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, field.lmp->world);
  return all[1] > 0.0 ? all[0] / all[1] : 0.0;
}

bool LAMMPS_NS::warn_of_mls_rotation(const Fix &fix, const std::vector<MPMField *> &fields)
{
  for (const auto *field : fields) {
    const double turn = mls_rotation(*field);
    if (!(turn > LARGE)) continue;
    if (field->lmp->comm->me == 0)
      field->lmp->error->warning(
          FLERR,
          "Fix {} {}: points have turned by {:.2g} on average, and with stress mls in the updated "
          "frame bodies whose surfaces are inclined to the lattice give way a little "
          "more in each step: a beam of 4 cells bends 6 to 16 % too far. Use frame total "
          "or shape cpdi2 of fix mpm {}, or stress gradient, which does so less",
          fix.style, fix.id, turn, field->id());
    return true;
  }
  return false;
}
