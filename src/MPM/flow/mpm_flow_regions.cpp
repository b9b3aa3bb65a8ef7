/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_regions.h"

#include "base/mpm_image.h"
#include "base/mpm_options.h"
#include "contact/fix_mpm_rigid.h"
#include "field/mpm_physics.h"
#include "flow/mpm_flow_cut_cell.h"
#include "walls/mpm_region_surface.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "math_extra.h"
#include "region.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// distance up to which closed faces have the normal velocity of a wall, in spacings
static constexpr double HELD = 3.5;
// open share of a face that is only rounding
static constexpr double NO_SHARE = 1.0e-9;
// distance from a surface that is none, in spacings
static constexpr double IN_SURFACE = 1.0e-9;
// distance that points are kept outside of walls, in spacings
static constexpr double MARGIN = 1.0e-6;
// distance between two regions from which on there is a gap, in spacings
static constexpr double LEAST_GAP = 0.05;

/* ---------------------------------------------------------------------- */

MPMFlowRegions::MPMFlowRegions(LAMMPS *lmp, const MPMFlowLattice &cells,
                               const std::vector<std::string> &ids) :
    Pointers(lmp),
    cells(cells), dim(cells.lattice.dim), ids(ids)
{
  walls.resize(ids.size());
}

void MPMFlowRegions::init(const std::string &name)
{
  any_moves = any_bodies = false;
  for (int w = 0; w < n(); w++) {
    auto &wall = walls[w];
    wall.id = ids[w];
    wall.region = domain->get_region_by_id(wall.id);
    if (!wall.region)
      error->all(FLERR, Error::NOLASTLINE, "{} region {} does not exist: define it before", name,
                 wall.id);
    wall.surface = std::make_unique<MPMRegionSurface>(wall.region, dim);
    if (wall.surface->is_open())
      error->all(FLERR, Error::NOLASTLINE, "{} cannot use region {}: open faces have no inside",
                 name, wall.id);
    wall.moves = wall.region->dynamic_check();
    if (wall.region->varshape)
      error->all(FLERR, Error::NOLASTLINE,
                 "{} cannot use region {}: its shape must not change; move or rotate it", name,
                 wall.id);
    if (wall.moves && wall.region->nregion > 1)
      error->all(FLERR, Error::NOLASTLINE,
                 "{} cannot use region {}: a union or intersection must not move; give each "
                 "member as a region of its own",
                 name, wall.id);
    wall.body = nullptr;
    for (auto *fix : find_fixes<FixMPMRigid>(lmp))
      if (fix->has_region(wall.id)) wall.body = fix;
    any_bodies = any_bodies || wall.body;
    any_moves = any_moves || wall.moves || wall.body;
  }
  known = false;
}

void MPMFlowRegions::start_run()
{
  evaluate_in_step(lmp, any_moves, [&] {
    for (auto &wall : walls) wall.region->prematch();
  });
  for (int w = 0; w < n(); w++) {
    auto &wall = walls[w];
    for (int k = 0; k < 4; k++) wall.before[k] = *MPMRegionMotion::of(wall.region)[k];
    if (wall.body) wall.body->motion(wall.center, wall.shift, wall.spin);
  }
  met.clear();
  known = false;
}

/* ---------------------------------------------------------------------- */

void MPMFlowRegions::find(double duration)
{
  if (known && !any_moves && nbuild == cells.nbuild) return;

  duration_of_motion = duration;

  // other commands may have looked at regions since the last step

  for (auto &wall : walls) {
    if (!wall.moves) continue;    // those of bodies are at rest
    if (duration > 0.0)
      evaluate_in_step(lmp, true, [&] {
        wall.region->prematch();
      });
    const auto motion = MPMRegionMotion::of(wall.region);
    double end[4];
    for (int k = 0; k < 4; k++) {
      end[k] = *motion[k];
      *motion[k] = wall.before[k];
    }
    std::fill_n(wall.shift, 3, 0.0);
    std::fill_n(wall.spin, 3, 0.0);
    if (!(duration > 0.0)) continue;
    for (int d = 0; d < 3; d++) wall.shift[d] = (end[d] - wall.before[d]) / duration;
    if (wall.region->rotateflag) {
      MathExtra::add3(MPMRegionMotion::point_of(wall.region), wall.before, wall.center);
      const double rate = (end[3] - wall.before[3]) / duration;
      for (int d = 0; d < 3; d++) wall.spin[d] = rate * MPMRegionMotion::axis_of(wall.region)[d];
    }
    std::copy_n(end, 4, wall.before);
    std::copy_n(wall.last, 9, wall.older);
    std::copy_n(wall.shift, 3, wall.last);
    std::copy_n(wall.spin, 3, wall.last + 3);
    std::copy_n(wall.center, 3, wall.last + 6);
    // as if it had moved like that before
    if (!wall.has_last) std::copy_n(wall.last, 9, wall.older);
    wall.has_last = true;
  }
  find_apertures();
  find_cuts();
  if (any_bodies) warn_of_bodies();
  for (auto &wall : walls)
    if (wall.moves)
      for (int k = 0; k < 4; k++) *MPMRegionMotion::of(wall.region)[k] = wall.before[k];
  known = true;
  nbuild = cells.nbuild;
}

/** Distance from the nearest wall, positive in the flow and at most far. */
double MPMFlowRegions::distance(const double *x, double far, int &nearest) const
{
  double least = far;
  nearest = 0;
  for (int w = 0; w < n(); w++) {
    const double d = distance_from(walls[w], x, far);
    if (d < least) {
      least = d;
      nearest = w;
    }
  }
  // a plane of nodes that is a surface has no side that round-off chooses
  if (std::fabs(least) < IN_SURFACE * cells.lattice.h) return 0.0;
  return std::max(-far, least);
}

double MPMFlowRegions::distance_from(const Wall &wall, const double *x, double far) const
{
  if (!wall.body) return wall.surface->distance(x, far);
  double place[3];
  wall.body->place_in_region(x, place);
  return wall.surface->distance(place, far);
}

void MPMFlowRegions::normal_at(int wall, const double *x, double *n) const
{
  const double h = cells.lattice.h;
  const auto *const body = walls[wall].body;
  if (!body) return walls[wall].surface->normal(x, FAR * h, 1.0e-4 * h, n);
  double place[3], there[3];
  body->place_in_region(x, place);
  walls[wall].surface->normal(place, FAR * h, 1.0e-4 * h, there);
  body->turn_to_space(there, n);
}

void MPMFlowRegions::velocity_at(int wall, const double *x, double *v) const
{
  double arm[3], turn[3];
  MathExtra::sub3(x, walls[wall].center, arm);
  if (walls[wall].body) nearest_image(*domain, arm);
  MathExtra::cross3(walls[wall].spin, arm, turn);
  MathExtra::add3(walls[wall].shift, turn, v);
}

void MPMFlowRegions::face_middle(int64_t cell, int axis, double *x) const
{
  int index[3];
  double offset[3] = {0.5, 0.5, 0.5};
  offset[axis] = 0.0;
  cells.grid.node_index(cell, index);
  place(index, offset, x);
}

double MPMFlowRegions::level_of_face(int64_t cell, int axis, double far, double &velocity) const
{
  const double reach = levels[cell] - 0.51 * cells.lattice.h;
  velocity = 0.0;
  if (reach > far) return far;
  double x[3], v[3];
  int wall;
  face_middle(cell, axis, x);
  const double level = distance(x, far, wall);
  if (level >= far || !any_moves) return level;
  velocity_at(wall, x, v);
  velocity = v[axis];
  return level;
}

double MPMFlowRegions::plane_at(int64_t cell, const double *offset, double far, double *normal,
                                int &wall) const
{
  int index[3];
  double x[3];
  cells.grid.node_index(cell, index);
  place(index, offset, x);
  const double level = distance(x, far, wall);
  if (std::fabs(level) < far) normal_at(wall, x, normal);
  return level;
}

double MPMFlowRegions::velocity_at_face(int wall, int64_t cell, int axis) const
{
  double x[3], v[3];
  face_middle(cell, axis, x);
  velocity_at(wall, x, v);
  return v[axis];
}

double MPMFlowRegions::find_way_out(const MPMFlowLattice::Cell &cell, double *out) const
{
  double x[3];
  int wall;
  place(cell.index, MIDDLE, x);
  const double level = distance(x, FAR * cells.lattice.h, wall);
  normal_at(wall, x, out);
  return -level;
}

double MPMFlowRegions::closed_by(int wall, int64_t cell, int axis, double *arm) const
{
  const int64_t face = cell * dim + axis;
  if (body_faces[face] != wall) return 0.0;
  double x[3];
  face_middle(cell, axis, x);
  MathExtra::sub3(x, walls[wall].center, arm);
  nearest_image(*domain, arm);
  return 1.0 - apertures[face];
}

void MPMFlowRegions::find_wall(int wall, const MPMFlowLattice::Cell &cell, double *way) const
{
  const double far = FAR * cells.lattice.h;
  double x[3], normal[3];
  place(cell.index, MIDDLE, x);
  normal_at(wall, x, normal);
  const double d = distance_from(walls[wall], x, far);
  for (int k = 0; k < 3; k++) way[k] = -d * normal[k];
}

void MPMFlowRegions::set_velocity(int w, const double *u)
{
  auto &wall = walls[w];
  double old[3];
  wall.body->motion(wall.center, old, old);
  std::copy_n(u, 3, wall.shift);
  std::copy_n(u + 3, 3, wall.spin);
  double x[3], v[3];
  for (int64_t face = 0; face < (int64_t) body_faces.size(); face++) {
    if (body_faces[face] != w) continue;
    face_middle(face / dim, face % dim, x);
    velocity_at(w, x, v);
    fluxes[face] = (1.0 - apertures[face]) * v[face % dim];
  }
  for (auto &held : helds)
    if (held.wall == w) velocity_at(w, held.x, held.velocity);
}

/** Place in a cell; offset: from its lower corner, in spacings. */
void MPMFlowRegions::place(const int *index, const double *offset, double *x) const
{
  const auto &lattice = cells.lattice;
  for (int d = 0; d < 3; d++) {
    x[d] = 0.0;
    if (d < dim) x[d] = lattice.origin[d] + (lattice.wrap(d, index[d]) + offset[d]) * lattice.h;
  }
}

/* ----------------------------------------------------------------------
   This is done for all cells that this rank has, so that nothing has to be communicated.
------------------------------------------------------------------------- */

void MPMFlowRegions::find_apertures()
{
  const auto &lattice = cells.lattice;
  const double h = lattice.h, far = FAR * h, near = 1.01 * std::sqrt((double) dim) * h;
  const int64_t size = cells.size();
  const int ncorner = 1 << dim;
  int nearest;
  apertures.assign(size * dim, 1.0);
  volume_fractions.assign(size, 1.0);
  levels.assign(size, far);
  if (any_moves) fluxes.assign(size * dim, 0.0);
  if (any_bodies) body_faces.assign(size * dim, -1);
  for (int64_t number = 0; number < size; number++) {
    int index[3];
    double x[3];
    cells.grid.node_index(number, index);
    place(index, MIDDLE, x);
    const double level = levels[number] = distance(x, far, nearest);
    if (level > near) continue;
    if (level < -near) {
      volume_fractions[number] = 0.0;
      std::fill_n(apertures.begin() + number * dim, dim, 0.0);
    } else {
      double corner[8], slope[3] = {0.0, 0.0, 0.0};
      corner_levels(index, corner);
      for (int k = 0; k < ncorner; k++)
        for (int d = 0; d < dim; d++) slope[d] += (k >> d & 1 ? 1.0 : -1.0) * corner[k];
      for (int d = 0; d < dim; d++) {
        const int e = d == 0 ? 2 : 1, f = d == 2 ? 2 : 4;    // the other axes
        const double share = dim == 2
            ? MPMFlowCutCell::positive(corner[0], corner[e])
            : MPMFlowCutCell::positive(corner[0], corner[e], corner[e | f], corner[f]);
        apertures[number * dim + d] = share < NO_SHARE ? 0.0 : share;
        slope[d] /= ncorner / 2;
      }

      // the surroundings, with the plane that is nearest to these distances
      volume_fractions[number] = MPMFlowCutCell::positive_in_hat(dim, level, slope);
    }
    for (int d = 0; any_moves && d < dim; d++) {
      const int64_t face = number * dim + d;
      if (apertures[face] == 1.0) continue;
      double y[3], v[3];
      int wall;
      face_middle(number, d, y);
      distance(y, far, wall);
      velocity_at(wall, y, v);
      fluxes[face] = (1.0 - apertures[face]) * v[d];
      if (walls[wall].body) body_faces[face] = wall;
    }
  }
  speed = 0.0;
  for (const double f : fluxes) speed = std::max(speed, std::fabs(f));
}

/** Lists the owned cells and faces that walls cut or hold. */
void MPMFlowRegions::find_cuts()
{
  const double h = cells.lattice.h, far = FAR * h, face_area = std::pow(h, dim - 1);
  closed.assign(cells.size(), 0);
  std::vector<double> flag(cells.size(), 0.0);
  cuts.clear();
  helds.clear();
  int nthin = 0, ngaps = 0;

  for (int k = 0; k < (int) cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    Cut cut = {};
    cut.cell = k;
    double most = 0.0;
    bool whole = true;
    for (int d = 0; d < dim; d++) {
      const double low = aperture(cell.number, d), high = aperture(cell.near[2 * d + 1], d);
      if (!(cell.walls >> 2 * d & 1)) most = std::max(most, low);
      if (!(cell.walls >> 2 * d & 2)) most = std::max(most, high);
      whole = whole && low == 1.0 && high == 1.0;
      cut.area[d] = (low - high) * face_area;
    }
    if (most == 0.0) flag[cell.number] = 1.0;
    if (!warned_of_thin && levels[cell.number] < 0.5 * h) nthin += is_thin(cell);
    if (!warned_of_thin && std::fabs(levels[cell.number]) < 0.5 * h) ngaps += is_gap(cell);
    double x[3];
    if (!whole && most > 0.0) {
      place(cell.index, MIDDLE, x);
      distance(x, far, cut.wall);
      find_moments(cut);
      find_change(cut, x);
      cuts.push_back(cut);
    }
    if (levels[cell.number] > 2.0 * h || levels[cell.number] <= -HELD * h) continue;
    for (int d = 0; d < dim; d++) {
      if (aperture(cell.number, d) > 0.0 || cell.walls >> 2 * d & 1) continue;
      double offset[3] = {0.5, 0.5, 0.5};
      offset[d] = 0.0;
      place(cell.index, offset, x);
      Held held = {};
      held.cell = k;
      held.axis = d;
      std::copy_n(x, 3, held.x);
      distance(x, far, held.wall);
      normal_at(held.wall, x, held.normal);
      velocity_at(held.wall, x, held.velocity);
      helds.push_back(held);
    }
  }
  cells.publish(flag.data(), 1);
  for (int64_t number = 0; number < cells.size(); number++) closed[number] = flag[number] > 0.0;
  if (!warned_of_thin) warn_of_thin(nthin, ngaps);
}

/** Distances of the corners of a cell from walls; bit d of the number of a corner is its side along
 *  an axis. */
void MPMFlowRegions::corner_levels(const int *index, double *level) const
{
  for (int k = 0; k < 1 << dim; k++) {
    const double offset[3] = {(double) (k & 1), (double) (k >> 1 & 1), (double) (k >> 2 & 1)};
    double x[3];
    int any;
    place(index, offset, x);
    level[k] = distance(x, FAR * cells.lattice.h, any);
  }
}

/* ----------------------------------------------------------------------
   Integrals of the normal times the place over the part of a wall that is in a cell. They are the
   integrals over the whole surface of the open part, which are its volume, less those over the open
   faces.
------------------------------------------------------------------------- */

void MPMFlowRegions::find_moments(Cut &cut) const
{
  const auto &cell = cells.cells[cut.cell];
  const double h = cells.lattice.h, volume = cells.lattice.cell_volume();
  double level[8];
  double face_areas[3][2][3] = {};    // [axis][side]: area, and moments along the other axes
  corner_levels(cell.index, level);
  double faces = 0.0, square = 0.0;
  for (int d = 0; d < dim; d++) {
    const int e = d == 0 ? 2 : 1, f = d == 2 ? 2 : 4;
    for (int s = 0; s < 2; s++) {
      const int at = s ? 1 << d : 0;
      if (dim == 2)
        MPMFlowCutCell::add_positive(level[at], level[at | e], face_areas[d][s]);
      else
        MPMFlowCutCell::add_positive(level[at], level[at | e], level[at | e | f], level[at | f],
                                     face_areas[d][s]);
      faces += 0.5 * face_areas[d][s][0];
    }
    square += cut.area[d] * cut.area[d];
  }
  // open share of the cell
  const double open = (faces + levels[cell.number] / h * std::sqrt(square) * h / volume) / dim;
  for (int d = 0; d < dim; d++)
    for (int e = 0; e < dim; e++) {
      const int k = 1 + (e > (d == 0 ? 1 : 0));    // index of e among the axes other than d
      const auto *const low = face_areas[d][0], *const high = face_areas[d][1];
      cut.moment[d][e] = volume * (d == e ? open - 0.5 * (low[0] + high[0]) : low[k] - high[k]);
    }
}

/** Change, since the last step, of the velocity of what is at a place of a wall. */
void MPMFlowRegions::find_change(Cut &cut, const double *x) const
{
  const auto &wall = walls[cut.wall];
  if (!wall.moves) return;
  double now[3], arm[3], turn[3];
  velocity_at(cut.wall, x, now);
  MathExtra::sub3(x, wall.older + 6, arm);
  MathExtra::cross3(wall.older + 3, arm, turn);
  for (int d = 0; d < 3; d++) cut.change[d] = now[d] - wall.older[d] - turn[d];
  MathExtra::cross3(wall.spin, now, turn);    // by the motion of the wall along its way
  for (int d = 0; d < 3; d++) cut.change[d] += duration_of_motion * turn[d];
}

std::vector<double> MPMFlowRegions::motion() const
{
  std::vector<double> all;
  for (const auto &wall : walls) {
    all.push_back(wall.has_last ? 1.0 : 0.0);
    all.insert(all.end(), wall.last, wall.last + 9);
  }
  return all;
}

void MPMFlowRegions::set_motion(const std::vector<double> &all)
{
  if (all.size() != 10 * walls.size()) return;    // these are other regions
  for (int w = 0; w < n(); w++) {
    walls[w].has_last = all[10 * w] > 0.0;
    std::copy_n(&all[10 * w + 1], 9, walls[w].last);
  }
}

/* ---------------------------------------------------------------------- */

double MPMFlowRegions::keep_outside(double *x, double *v) const
{
  const double h = cells.lattice.h, margin = MARGIN * h;
  double before = 0.0;
  for (int pass = 0; pass < 3; pass++) {
    int wall;
    const double d = distance(x, FAR * h, wall);
    if (pass == 0) before = d;
    if (d >= margin) break;
    double n[3], wall_velocity[3];
    normal_at(wall, x, n);
    velocity_at(wall, x, wall_velocity);
    double into = 0.0;
    for (int k = 0; k < dim; k++) into += n[k] * (v[k] - wall_velocity[k]);
    for (int k = 0; k < dim; k++) {
      x[k] += (2.0 * margin - d) * n[k];
      if (into < 0.0) v[k] -= into * n[k];
    }
  }
  return before;
}

double MPMFlowRegions::depth(const double *x, double far) const
{
  int wall;
  return -distance(x, far, wall);
}

/* ----------------------------------------------------------------------
   places where regions are too thin, too near to each other, or in the way of bodies
------------------------------------------------------------------------- */

/** Is a place in a wall, and has it come there by the motion of the last two steps? */
MPMFlowRegions::Meets MPMFlowRegions::meets(int wall, const double *x) const
{
  const double far = FAR * cells.lattice.h;
  if (distance_from(walls[wall], x, far) >= 0.0) return AWAY;
  double v[3], before[3];    // the place that was as far from the wall as x is now
  velocity_at(wall, x, v);
  for (int d = 0; d < 3; d++) before[d] = x[d] + 2.0 * duration_of_motion * v[d];
  return distance_from(walls[wall], before, far) >= 0.0 ? COMES : INSIDE;
}

/** Warns of bodies that have come into walls or regions. Bodies touch nothing, so that a stone
 *  would go on through the floor unnoticed. Overlap at the start of a run is intended, also where
 *  water, and with it the cells in which overlap is seen, comes later. */
void MPMFlowRegions::warn_of_bodies()
{
  constexpr int FACES = 6;
  const double h = cells.lattice.h;
  std::vector<int> mine((FACES + 1) * n(), 0), all(mine.size());
  for (const auto &cell : cells.cells) {
    if (levels[cell.number] > h || levels[cell.number] < -h) continue;
    for (int w = 0; w < n(); w++) {
      if (!walls[w].body) continue;
      int *const here = &mine[(FACES + 1) * w];
      double offset[3] = {0.5, 0.5, 0.5}, x[3];
      for (int k = 0; k < 2 * dim; k++) {
        if (!(cell.walls >> k & 1) || here[k] == COMES) continue;
        offset[k / 2] = k % 2;
        place(cell.index, offset, x);
        offset[k / 2] = 0.5;
        here[k] = std::max<int>(here[k], meets(w, x));
      }
      if (here[FACES] == COMES || !(levels[cell.number] < 0.0)) continue;
      place(cell.index, offset, x);
      const int own = meets(w, x);
      for (int other = 0; other < n() && own != AWAY; other++) {
        const int its = other == w ? AWAY : meets(other, x);
        if (its != AWAY) here[FACES] = std::max({here[FACES], own, its});
      }
    }
  }
  MPI_Allreduce(mine.data(), all.data(), (int) all.size(), MPI_INT, MPI_MAX, world);
  const bool first = met.empty();
  met.resize(all.size());
  for (int k = 0; k < (int) all.size(); k++) {
    if (all[k] == AWAY || met[k]) continue;
    met[k] = 1;
    if (all[k] != COMES || first) continue;
    const int face = k % (FACES + 1);
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/incompressible: the body of fix {} goes through {}, as bodies in a "
                     "flow touch neither each other nor walls: end the run before, or hold it",
                     walls[k / (FACES + 1)].body->id,
                     face == FACES ? std::string("another region")
                                   : fmt::format("wall {}{}", (char) ('x' + face / 2),
                                                 face % 2 ? "hi" : "lo"));
  }
}

/** Is there a wall between the middles of opposite faces that are both open? */
bool MPMFlowRegions::is_thin(const MPMFlowLattice::Cell &cell) const
{
  constexpr double OPEN = 0.75, TOWARDS = 0.5;
  const double h = cells.lattice.h;
  for (int d = 0; d < dim; d++) {
    if (aperture(cell.number, d) < OPEN || aperture(cell.near[2 * d + 1], d) < OPEN) continue;
    double from_wall[2], sum = 0.0;
    for (int s = 0; s < 2; s++) {
      double offset[3] = {0.5, 0.5, 0.5}, x[3], n[3];
      offset[d] = s;
      place(cell.index, offset, x);
      int wall;
      sum += distance(x, FAR * h, wall);
      normal_at(wall, x, n);
      from_wall[s] = n[d];
    }
    if (sum < 1.001 * h && from_wall[0] < -TOWARDS && from_wall[1] > TOWARDS && !is_corner(cell, d))
      return true;
  }
  return false;
}

/** A corner of a wall that ends in the cell is as thin there, but lets nothing through: next to the
 *  cell, the wall is thicker than a cell. */
bool MPMFlowRegions::is_corner(const MPMFlowLattice::Cell &cell, int axis) const
{
  // cells up to which a corner of 60 degrees gets that thick, wherever it ends in the cell
  constexpr int NEAR = 2;
  for (int e = 0; e < dim; e++) {
    if (e == axis) continue;
    for (int along = -NEAR; along <= NEAR; along++) {
      int index[3] = {cell.index[0], cell.index[1], cell.index[2]}, wall;
      index[e] += along;
      bool solid = along != 0;
      for (int s = 0; s < 2 && solid; s++) {
        double offset[3] = {0.5, 0.5, 0.5}, x[3];
        offset[axis] = s;
        place(index, offset, x);
        solid = distance(x, FAR * cells.lattice.h, wall) < 0.0;
      }
      if (solid) return true;
    }
  }
  return false;
}

/** Less than a spacing between two regions that face each other: a cell has only a part of one
 *  wall, so that forces on the other wall would count as forces on this one. */
bool MPMFlowRegions::is_gap(const MPMFlowLattice::Cell &cell) const
{
  constexpr double AGAINST = -0.5;
  const double h = cells.lattice.h, far = FAR * h;
  double x[3], normal[2][3];
  int wall;
  place(cell.index, MIDDLE, x);
  const double first = distance(x, far, wall);
  normal_at(wall, x, normal[0]);
  for (int w = 0; w < n(); w++) {
    const double sum = w == wall ? 0.0 : first + distance_from(walls[w], x, far);
    if (!(sum > LEAST_GAP * h && sum < 0.999 * h)) continue;
    normal_at(w, x, normal[1]);
    if (MathExtra::dot3(normal[0], normal[1]) < AGAINST) return true;
  }
  return false;
}

/** Warns of regions through which the flow goes, and of gaps between regions. */
void MPMFlowRegions::warn_of_thin(int nthin, int ngaps)
{
  const int mine[2] = {nthin, ngaps};
  int all[2];
  MPI_Allreduce(mine, all, 2, MPI_INT, MPI_SUM, world);
  if (!all[0] && !all[1]) return;
  warned_of_thin = true;
  if (comm->me) return;
  if (all[0])
    error->warning(
        FLERR,
        "Fix mpm/incompressible: regions are thinner than a node spacing in {} cells, so that "
        "the flow goes through: use a smaller node spacing, or thicker walls",
        all[0]);
  if (all[1])
    error->warning(
        FLERR,
        "Fix mpm/incompressible: regions leave gaps of less than a node spacing in {} cells, in "
        "which the flow, its pressure, and the forces on either region are wrong: use a smaller "
        "node spacing, or close the gap",
        all[1]);
}
