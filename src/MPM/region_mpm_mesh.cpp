/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "region_mpm_mesh.h"

#include "comm.h"
#include "error.h"
#include "mesh/surface_mesh.h"
#include "utils.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   region ID mpm/mesh file scale x y z keyword value ...
------------------------------------------------------------------------- */

static constexpr int MAX_TOUCHES = 6;

RegMPMMesh::RegMPMMesh(LAMMPS *lmp, int narg, char **arg) : Region(lmp, narg, arg)
{
  if (narg < 7) utils::missing_cmd_args(FLERR, "region mpm/mesh", error);
  options(narg - 7, &arg[7]);
  const double scale = utils::numeric(FLERR, arg[3], false, lmp);
  if (!(scale > 0.0) || !std::isfinite(scale))
    error->all(FLERR, 3, "Region mpm/mesh scale must be positive: {}", arg[3]);
  const double unit[3] = {xscale, yscale, zscale};
  SurfaceMesh::Point shift;
  for (int d = 0; d < 3; d++) shift[d] = unit[d] * utils::numeric(FLERR, arg[4 + d], false, lmp);

  // one rank reads

  std::string bytes;
  bigint size = -1;
  if (comm->me == 0) {
    if (FILE *fp = fopen(arg[2], "rb")) {
      char buffer[65536];
      for (std::size_t n; (n = fread(buffer, 1, sizeof(buffer), fp)) > 0;) bytes.append(buffer, n);
      fclose(fp);
      size = (bigint) bytes.size();
    }
  }
  MPI_Bcast(&size, 1, MPI_LMP_BIGINT, 0, world);
  if (size < 0)
    error->all(FLERR, 2, "Cannot open file {} of region mpm/mesh: {}", arg[2],
               utils::getsyserror());
  bytes.resize(size);
  MPI_Bcast(&bytes[0], (int) size, MPI_CHAR, 0, world);
  try {
    mesh = std::make_unique<SurfaceMesh>(bytes, arg[2], scale, shift);
  } catch (const std::exception &problem) {
    error->all(FLERR, 2, std::string(problem.what()));
  }

  if (interior && !dynamic) {
    bboxflag = 1;
    extent_xlo = mesh->lo[0];
    extent_xhi = mesh->hi[0];
    extent_ylo = mesh->lo[1];
    extent_yhi = mesh->hi[1];
    extent_zlo = mesh->lo[2];
    extent_zhi = mesh->hi[2];
  } else
    bboxflag = 0;

  most_touches = cmax = tmax = std::min(mesh->nparts, MAX_TOUCHES);
  contact = new Contact[cmax];
  if (comm->me == 0)
    utils::logmesg(lmp, "Region {}: {} triangles, volume {:.8g}, center {:.8g} {:.8g} {:.8g}\n", id,
                   mesh->size(), mesh->volume, mesh->center[0], mesh->center[1], mesh->center[2]);
}

RegMPMMesh::~RegMPMMesh()
{
  if (!copymode) delete[] contact;
}

/* ---------------------------------------------------------------------- */

int RegMPMMesh::inside(double x, double y, double z)
{
  return mesh->inside({x, y, z});
}

/* ----------------------------------------------------------------------
   the closest point of each part of the surface, if x is on the given side and it is within the cutoff
------------------------------------------------------------------------- */

int RegMPMMesh::touch(const double *x, double cutoff, double side)
{
  const SurfaceMesh::Point here = {x[0], x[1], x[2]};
  const double known = mesh->bound(here);
  if (known * side < 0.0 || std::fabs(known) >= cutoff) return 0;
  SurfaceMesh::Touch touches[MAX_TOUCHES];
  const int n = mesh->touches(here, cutoff, touches, most_touches);
  if (n == 0 || side * touches[0].distance < 0.0) return 0;
  // the same order in every step, as other regions have it
  for (int i = 1; i < n; i++)
    for (int j = i; j > 0 && touches[j].part < touches[j - 1].part; j--)
      std::swap(touches[j], touches[j - 1]);
  for (int i = 0; i < n; i++) {
    const auto &touch = touches[i];
    contact[i].r = std::fabs(touch.distance);
    contact[i].delx = x[0] - touch.point[0];
    contact[i].dely = x[1] - touch.point[1];
    contact[i].delz = x[2] - touch.point[2];
    contact[i].radius = 0.0;
    contact[i].iwall = touch.part;
    contact[i].varflag = 0;
  }
  return n;
}
