/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/region_mpm_mesh.h"

#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "math_const.h"
#include "math_extra.h"
#include "mesh/surface_cells.h"
#include "mesh/surface_mesh.h"
#include "mesh/terrain_file.h"
#include "table/regular_file.h"
#include "utils.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <string>
#include <utility>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int MAX_TOUCHES = 6;

Options MPMRegionMeshOptions::declare()
{
  using namespace option;
  Options o("region mpm/mesh");
  o.add("surface",
        {word(surface,
              {{"closed", CLOSED, "each edge belongs to two triangles with the same orientation"},
               {"open", OPEN, "may have a rim, as of terrain: the inside is behind the triangles"},
               {"leaky", LEAKY, "fill holes: the inside is what the surface winds around"}})});
  o.add("turn",
        {number(angle, "angle", ANY_NUMBER, "", "rotation of the file about its origin (degrees)"),
         numbers(axis, 3, "Rx Ry Rz", ANY_NUMBER, "", "axis of this rotation")})
      .standard("none");
  o.refuse([=] {
    return OptionRules{{axis[0] == 0.0 && axis[1] == 0.0 && axis[2] == 0.0, "turn",
                        "needs an axis that is not zero"}};
  });
  return o;
}

/** The bytes of a file, which one rank reads. */
static std::string read_bytes(LAMMPS *lmp, const char *file)
{
  std::string bytes, problem;
  if (lmp->comm->me == 0) {
    FILE *const fp = is_no_file(file) ? nullptr : fopen(file, "rb");
    if (fp) {
      char buffer[65536];
      for (std::size_t n; (n = fread(buffer, 1, sizeof(buffer), fp)) > 0;) bytes.append(buffer, n);
    }
    if (is_no_file(file))
      problem = "it is no file";
    else if (!fp || ferror(fp))
      problem = utils::getsyserror();
    if (fp) fclose(fp);
  }
  broadcast(problem, lmp->world);
  if (!problem.empty())
    lmp->error->all(FLERR, 2, "Cannot open file {} of region mpm/mesh: {}", file, problem);
  broadcast(bytes, lmp->world);
  return bytes;
}

/** Region ID mpm/mesh file scale x y z keyword value ... keywords of this style come before those
 *  of all regions. */
RegMPMMesh::RegMPMMesh(LAMMPS *lmp, int narg, char **arg) : Region(lmp, narg, arg)
{
  require_arguments(lmp, "region mpm/mesh", narg, 2, {"file", "scale", "x", "y", "z"});
  int own = 7;
  const auto is_of_all = [](const char *word) {
    for (const char *keyword : {"side", "units", "move", "rotate", "open"})
      if (strcmp(word, keyword) == 0) return true;
    return false;
  };
  // the value of keyword surface can be open, which is a keyword of all regions, too
  while (own < narg && !is_of_all(arg[own])) own += strcmp(arg[own], "surface") == 0 ? 2 : 1;
  own = std::min(own, narg);
  MPMRegionMeshOptions given;
  Options keywords = given.declare();
  read_options(lmp, keywords, own, arg, 7);
  for (int i = own; i < narg; i++)
    if (keywords.has(arg[i]))
      error->all(FLERR, i, "Region mpm/mesh keyword {} must come before the keyword {}", arg[i],
                 arg[own]);
  options(narg - own, &arg[own]);
  const double scale = utils::numeric(FLERR, arg[3], false, lmp);
  if (!(scale > 0.0) || !std::isfinite(scale))
    error->all(FLERR, 3, "Region mpm/mesh scale must be positive: {}", arg[3]);
  const double unit[3] = {xscale, yscale, zscale};
  SurfaceMesh::Point shift;
  for (int d = 0; d < 3; d++) shift[d] = unit[d] * utils::numeric(FLERR, arg[4 + d], false, lmp);

  SurfaceOptions how;
  how.leaky = leaky = given.surface == given.LEAKY;
  how.open = given.surface == given.OPEN;
  if (is_terrain(arg[2])) {
    if (keywords.given("surface") && !how.open)
      error->all(FLERR, 2, "Region mpm/mesh file {} has heights, whose surface is open", arg[2]);
    how.open = true;
  }
  if (keywords.given("turn")) {
    double axis[3] = {given.axis[0], given.axis[1], given.axis[2]}, quat[4];
    MathExtra::norm3(axis);
    MathExtra::axisangle_to_quat(axis, given.angle * MathConst::DEG2RAD, quat);
    MathExtra::quat_to_mat(quat, how.turn);
  }
  const std::string bytes = read_bytes(lmp, arg[2]);
  try {
    mesh = std::make_unique<SurfaceMesh>(bytes, arg[2], scale, shift, how);
  } catch (const std::exception &problem) {
    error->all(FLERR, 2, std::string(problem.what()));
  }

  if (interior && !dynamic && !mesh->open) {
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
  if (comm->me == 0 && mesh->open)
    utils::logmesg(lmp,
                   "Region {}: {} triangles, open: it is behind them; x {:.6g} to {:.6g}, y {:.6g} "
                   "to {:.6g}, z {:.6g} to {:.6g}\n",
                   id, mesh->size(), mesh->lo[0], mesh->hi[0], mesh->lo[1], mesh->hi[1],
                   mesh->lo[2], mesh->hi[2]);
  else if (comm->me == 0)
    utils::logmesg(lmp, "Region {}: {} triangles, volume {:.8g}, center {:.8g} {:.8g} {:.8g}\n", id,
                   mesh->size(), mesh->volume, mesh->center[0], mesh->center[1], mesh->center[2]);
  if (leaky && comm->me == 0) report(arg[2]);
}

/** What is wrong with a leaky surface. */
void RegMPMMesh::report(const char *file) const
{
  const SurfaceHoles &found = mesh->holes;
  if (found.none() && !mesh->overlaps) {
    utils::logmesg(lmp, "  its surface is closed\n");
    return;
  }
  if (found.turned + found.repeated)
    utils::logmesg(lmp, "  {} triangles turned, {} left out that were there twice\n", found.turned,
                   found.repeated);
  if (found.edges) {
    const double size = std::sqrt(MathExtra::distsq3(mesh->lo.data(), mesh->hi.data()));
    utils::logmesg(
        lmp,
        "  {} open edges around {} hole{}, the widest with {:.4g} ({:.3g} % of the body) at {:.6g} "
        "{:.6g} {:.6g}, patches with {:.3g} % of the area of the surface\n",
        found.edges, found.holes, found.holes > 1 ? "s" : "", found.widest,
        100.0 * found.widest / size, found.at[0], found.at[1], found.at[2], 100.0 * found.area);
  }
  if (mesh->overlaps)
    utils::logmesg(lmp, "  parts overlap: the volume above has what they share several times\n");
  error->warning(
      FLERR,
      "The surface of file {} is leaky: look at the region that it fills before you trust it",
      file);
}

void RegMPMMesh::need_distance() const
{
  if (leaky)
    error->all(FLERR, Error::NOLASTLINE,
               "Region {} has surface leaky, so that only what is inside of it is known and it "
               "cannot be a wall or a rigid body: repair its mesh and use surface closed",
               id);
}

void RegMPMMesh::need_body() const
{
  need_distance();
  if (mesh->open)
    error->all(FLERR, Error::NOLASTLINE,
               "Region {} has an open surface, which is a wall and no body: close its mesh", id);
}

/** Beyond its rim, an open surface goes on as planes, which a user may not have meant. */
void RegMPMMesh::init()
{
  Region::init();
  if (!mesh->open || warned || dynamic || comm->me != 0) return;
  const double *const lo = domain->boxlo, *const hi = domain->boxhi;
  for (int d = 0; d < domain->dimension; d++) {
    const double from = mesh->lo[d], to = mesh->hi[d];
    if (from <= hi[d] && to >= lo[d]) continue;
    warned = true;
    error->warning(
        FLERR,
        "The open surface of region {} is outside of the box: along {} it goes from "
        "{:.8g} to {:.8g}, and the box from {:.8g} to {:.8g}. Look at its scale and origin, "
        "which in a map can be far away",
        id, "xyz"[d], from, to, lo[d], hi[d]);
    return;
  }
  for (const auto &x : mesh->rim) {
    bool in_box = true;
    for (int d = 0; d < domain->dimension; d++) {
      const double margin = 1.0e-3 * (hi[d] - lo[d]);
      in_box = in_box && x[d] > lo[d] + margin && x[d] < hi[d] - margin;
    }
    if (!in_box) continue;
    warned = true;
    error->warning(
        FLERR,
        "The open surface of region {} ends in the box, near {:.6g} {:.6g} {:.6g}: beyond "
        "its rim it goes on as the planes of the triangles there; make it as wide as the "
        "box",
        id, x[0], x[1], x[2]);
    return;
  }
}

RegMPMMesh::~RegMPMMesh()
{
  if (!copymode) delete[] contact;
}

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

/** Where x is in the coordinates of the mesh: match() takes it back to where the surface was
 *  read. */
void RegMPMMesh::find_place(const double *x)
{
  if (!dynamic) return MathExtra::copy3(x, place);
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

SurfaceCells &RegMPMMesh::cells_of_size(double size)
{
  return cells.try_emplace(size, *mesh, size, domain->dimension == 2).first->second;
}

bool RegMPMMesh::distance_in_cells(SurfaceCells &known, const double *x, double cutoff,
                                   double &distance, double *gradient)
{
  find_place(x);
  SurfaceMesh::Point up;
  const auto answer =
      known.find({place[0], place[1], place[2]}, distance, gradient ? &up : nullptr);
  if (answer == SurfaceCells::UNKNOWN) return false;
  const bool too_far = std::fabs(distance) >= cutoff;
  if (answer == SurfaceCells::FAR && (gradient || !too_far)) return false;
  if (!interior) distance = -distance;
  if (too_far) distance = std::copysign(cutoff, distance);
  if (!gradient) return true;
  if (!interior)
    for (double &component : up) component = -component;
  MathExtra::copy3(up.data(), gradient);
  if (!rotateflag) return true;
  double from[3] = {place[0], place[1], place[2]}, to[3];
  MathExtra::add3(from, gradient, to);
  forward_transform(from[0], from[1], from[2]);
  forward_transform(to[0], to[1], to[2]);
  MathExtra::sub3(to, from, gradient);
  return true;
}

/** The closest point of each part of the surface, if x is on the given side and it is within the
 *  cutoff. */
int RegMPMMesh::touch(const double *x, double cutoff, double side)
{
  if (leaky)
    error->one(FLERR, Error::NOLASTLINE,
               "Region {} has surface leaky, so that only what is inside of it is known and it "
               "cannot be a wall: repair its mesh and use surface closed",
               id);
  const SurfaceMesh::Point here = {x[0], x[1], x[2]};
  const double known = mesh->bound(here);
  if (known * side < 0.0 || std::fabs(known) >= cutoff) return 0;
  SurfaceMesh::ClosestPoint closest[MAX_TOUCHES];
  const int n = mesh->closest_points(here, cutoff, closest, tmax);
  if (n == 0 || side * closest[0].distance < 0.0) return 0;
  // the same order in every step, as other regions have it
  for (int i = 1; i < n; i++)
    for (int j = i; j > 0 && closest[j].part < closest[j - 1].part; j--)
      std::swap(closest[j], closest[j - 1]);
  for (int i = 0; i < n; i++) {
    const auto &one = closest[i];
    contact[i].r = std::fabs(one.distance);
    contact[i].delx = x[0] - one.point[0];
    contact[i].dely = x[1] - one.point[1];
    contact[i].delz = x[2] - one.point[2];
    contact[i].radius = 0.0;
    contact[i].iwall = one.part;
    contact[i].varflag = 0;
  }
  return n;
}
