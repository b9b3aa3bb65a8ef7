/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "region_mpm_mesh.h"

#include "comm.h"
#include "domain.h"
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

  cmax = tmax = std::min(mesh->nparts, MAX_TOUCHES);
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
  if (placing) {
    place[0] = x;
    place[1] = y;
    place[2] = z;
    return 0;
  }
  return mesh->inside({x, y, z});
}

/* ---------------------------------------------------------------------- */

/** Where x is in the coordinates of the mesh: match() takes it back to where the surface was read. */
void RegMPMMesh::find_place(const double *x)
{
  placing = true;
  match(x[0], x[1], x[2]);
  placing = false;
}

double RegMPMMesh::distance(const double *x, double cutoff, double &along_z)
{
  find_place(x);
  SurfaceMesh::Point closest = {place[0], place[1], place[2]};
  const double d =
      mesh->distance_within({place[0], place[1], place[2]}, cutoff, closest, last_closest);
  along_z = std::fabs(place[2] - closest[2]);
  return interior ? d : -d;
}

/* ----------------------------------------------------------------------
   In 2d cells are columns at the z of the places, which is the same for all
------------------------------------------------------------------------- */

bool RegMPMMesh::distance_by_cells(const double *x, double cutoff, double exact, double size,
                                   double &distance)
{
  constexpr std::size_t MOST = 1 << 20;    // cells in memory
  constexpr int BITS = 21;                 // of an index
  const bool flat = domain->dimension == 2;
  find_place(x);
  SurfaceMesh::Point center = {0.0, 0.0, place[2]}, closest = center;
  uint64_t key = 0;
  bool in_range = true;
  for (int d = 0; d < (flat ? 2 : 3); d++) {
    const double index = std::floor((place[d] - mesh->lo[d]) / size) + (1 << (BITS - 1));
    in_range = in_range && index >= 0.0 && index < (1 << BITS);
    if (!in_range) break;
    key = key << BITS | (uint64_t) index;
    center[d] = mesh->lo[d] + (index - (1 << (BITS - 1)) + 0.5) * size;
  }
  if (in_range) {
    auto &known = cells[size];
    auto found = known.find(key);
    if (found == known.end()) {
      if (known.size() >= MOST) known.clear();
      Linear linear = {};
      linear.value = mesh->distance_within(center, cutoff, closest, last_closest);
      for (int d = 0; d < 3 && std::fabs(linear.value) < cutoff && linear.value != 0.0; d++)
        linear.gradient[d] = (center[d] - closest[d]) / linear.value;
      found = known.emplace(key, linear).first;
    }
    const Linear &linear = found->second;
    distance = linear.value;
    for (int d = 0; d < 3; d++) distance += linear.gradient[d] * (place[d] - center[d]);
    if (!interior) distance = -distance;
    if (flat && std::fabs(linear.gradient[2]) > 0.5) return false;
    if (std::fabs(distance) > exact) return true;
  }
  double along_z;
  distance = RegMPMMesh::distance(x, cutoff, along_z);
  return !flat || along_z <= 0.5 * std::fabs(distance);
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
  const int n = mesh->touches(here, cutoff, touches, tmax);
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
