/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The surface is that of the first run, and goes with the material: each point below it has an area
   A and a normal N. A dead traction t is the force A t for ever. Pressure acts on the area da = J
   F^-T A N (Nanson), that is T = -p cof(F) N for each A, with the F of the point. What points give
   to the nodes are forces A T (atom->f, with shares of the area that sum to all of it) and a stress
   with the traction T on the present area cof(F) N = a n, which moves the force to the surface, see
   MPMFace:

     tau = -W J/a [T n + n T - (T.n) n n]

   It is symmetric, and so has no torque, that of its traction along the surface being in the place
   of the forces.

   Pressure p on all of the surface of a body is, by the theorem of Gauss, a stress, too,

     -int p N_i n da = -int p grad N_i dv = -p sum_p V_p grad N_i(x_p)

   The resultant is zero as sum_i grad N_i is, and so is the torque. A body with the stress -p is in
   equilibrium, wherever its points are (the virtual stress boundary of J. Given, Y. Liang, Z. Zeng,
   X. Zhang, K. Soga, Comput. Mech. 75 (2025)).
------------------------------------------------------------------------- */

#include "loads/fix_mpm_traction.h"

#include "base/mpm_image.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_time_limit.h"
#include "math/matrix.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "input.h"
#include "math_extra.h"
#include "modify.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <memory>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

/** fix ID group mpm/traction surface values keyword values ... */
Options MPMTractionOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/traction");
  o.argument(word(surface,
                  {{"region", REGION, "", {text(region, "REG", "")}},
                   {"points",
                    POINTS,
                    "",
                    {number(points_area, "A", POSITIVE, "", ""),
                     numbers(points_normal, 3, "nx ny nz", ANY_NUMBER, "", "")}},
                   {"free", FREE}},
                  "surface"));
  o.add("traction",
        {variables(traction, 3, "tx ty tz", "pressure",
                   "dead load: force per area before deformation, can be variables")})
      .then([this] {
        has_traction = true;
      })
      .once()
      .standard("none");
  o.add("pressure",
        {variables(&pressure, 1, "p", "pressure",
                   "pressure that follows the surface as it deforms, can be a variable")})
      .then([this] {
        has_pressure = true;
      })
      .once()
      .standard("none");
  o.add("moment",
        {variables(moment, 3, "Mx My Mz", "force*distance",
                   "moment on the surface as a whole, by tractions that turn with it, can be "
                   "equal-style variables")})
      .then([this] {
        has_moment = true;
      })
      .once()
      .standard("none");
  MPMFace::declare(o, spacing, area);
  o.refuse([=] {
    const bool of_region = surface == REGION;
    return OptionRules{
        {!has_traction && !has_pressure && !has_moment, "",
         "has no load: use traction, pressure, or moment"},
        {surface == FREE && has_moment, "moment",
         "must not be on all of the free surface: use region or points"},
        {dim == 2 && has_moment &&
             (moment[0].value != 0.0 || moment[1].value != 0.0 || !moment[0].variable.empty() ||
              !moment[1].variable.empty()),
         "moment", "must be along z in 2d: {moment}"},
        {surface == FREE && has_traction, "traction",
         "must not be on all of the free surface, whose resultant is zero: use region or points"},
        {!of_region && spacing > 0.0, "spacing", "is for layers below the surface of a region"},
        {!of_region && area > 0.0, "area", "is for the surface of a region"},
        {surface == POINTS && dot(points_normal, points_normal) == 0.0, "",
         "points has a normal of length zero"},
        {dim == 2 && surface == POINTS && points_normal[2] != 0.0, "",
         "points has a normal that must be along x and y in 2d"},
        {dim == 2 && has_traction && (traction[2].value != 0.0 || !traction[2].variable.empty()),
         "traction", "must be along x and y in 2d: {traction}"}};
  });
  return o;
}

FixMPMTraction::FixMPMTraction(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = NSUM;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  dynamic_group_allow = 0;
  if (surface == FREE)
    state.declare(inside, "pressure", INSIDE_WIDTH);
  else
    state.declare(rows, "area", WIDTH);
  if (has_moment)
    turn = std::make_unique<MPMMoment>(lmp, "Fix mpm/traction " + std::string(id), [this](int i) {
      return rows[i][AREA];
    });
  grows = surface == REGION && has_pressure;
  if (grows) state.declare(growth, "growth", GROWTH_WIDTH);
  keep_arrays();
}

void FixMPMTraction::find_load(int k)
{
  auto &v = load(k);
  if (v.variable.empty()) return;
  auto *const variables = input->variable;
  v.index = variables->find(v.variable.c_str());
  const bool known = v.index >= 0, of_points = k < 4;
  if (known && (variables->equalstyle(v.index) || (of_points && variables->atomstyle(v.index))))
    return;
  error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/traction {} {}", v.variable,
             k < 3           ? "traction"
                 : of_points ? "pressure"
                             : "moment",
             !known          ? "does not exist"
                 : of_points ? "is not equal-style or atom-style"
                             : "is not equal-style");
}

void FixMPMTraction::init()
{
  require_field(lmp, *this);
  for (int k = 0; k < NLOAD; k++) find_load(k);
  if (surface == REGION && !defined && !domain->get_region_by_id(region))
    error->all(FLERR, Error::NOLASTLINE, "Region {} for fix mpm/traction {} does not exist", region,
               id);
}

void FixMPMTraction::init_physics(MPMPlan &plan)
{
  fields = plan.fields;
  for (const auto *field : fields)
    if (has_moment && field->options.axisymmetric)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/traction {} moment cannot be around an axis of symmetry, where surfaces "
                 "are rings: use traction or pressure, or remove axisymmetric of fix mpm {}",
                 id, field->id());
}

bool FixMPMTraction::belongs(const MPMField &field, int i) const
{
  return (atom->mask[i] & groupbit) && field.is_point(i) && !field.is_element_node(i);
}

// Pressure acts on the area that the surface has by where points are, in the updated frame. It
// changes slowly in explicit steps.
static constexpr int EVERY = 10;    // explicit steps

void FixMPMTraction::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (!grows || place != MPMPlan::BEFORE_POINTS_TO_NODES) return;
  plan.each(
      "area of surfaces", {Data::POSITION, Data::DEFORMATION, Data::BLOCKS, Data::OWN}, {Data::OWN},
      [this](MPMField &field) {
        if (!field.time_limit->bound || update->ntimestep % EVERY == 0) find_growth(field);
      },
      [](const MPMField &field) {
        return !field.frame->is_total();
      });
}

void FixMPMTraction::find_growth(MPMField &field)
{
  const auto member = [&](int i) -> MPMFaceGrowth::Member {
    const double *const row = growth[i];
    const bool is = belongs(field, i) && row[LAYER] > 0.0;
    return {is ? (int) row[LAYER] - 1 : -1, row + MOVED, row + FACING};
  };
  face_growth.find(field, member, [&](int i, double area) {
    double now[3];
    present_area(i, field.points->F[i], now);
    const double change = area / std::sqrt(dot(now, now));
    growth[i][RATIO] *= change;
    rows[i][HEIGHT] /= change;    // which is no work
  });
}

/** What this run starts with: the surface, and loads of the first step. */
void FixMPMTraction::setup(int vflag)
{
  if (!warned_of_nodes) note_nodes();
  if (surface != FREE && !defined) define();
  note_lost();
  evenness_at_start = evenness();
  post_force(vflag);
}

/** Nodes of finite elements have no surface of their own, and their F is no deformation of it. */
void FixMPMTraction::note_nodes()
{
  bigint mine[2] = {0, 0}, all[2];    // nodes, and other points of the group
  for (const auto *field : fields)
    for (int i = 0; i < atom->nlocal; i++) {
      if (!(atom->mask[i] & groupbit) || !field->is_point(i)) continue;
      mine[field->is_element_node(i) ? 0 : 1]++;
    }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all[0] == 0) return;
  static const std::string remedy =
      "loads on these are fix mpm/airbag pressure, for surfaces, and fix addforce";
  if (all[1] == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/traction {}: all points of group {} are nodes of fix mpm/elements, which "
               "have no surface: {}",
               id, group->names[igroup], remedy);
  warned_of_nodes = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/traction {}: {} points of group {} are nodes of fix mpm/elements, and "
                   "do not bear its load: {}",
                   id, all[0], group->names[igroup], remedy);
}

void FixMPMTraction::post_run()
{
  note_lost();
  look_for_curls();
  look_for_stretch();
}

/** Size of the sum of the areas of a surface, with their normals, over the area: 1 for a plane.
 *  Collective. */
double FixMPMTraction::evenness() const
{
  if (surface == FREE) return 1.0;
  const auto *const points = MPMPoints::get(atom);
  double mine[4] = {0.0, 0.0, 0.0, 0.0}, all[4];
  for (int i = 0; i < atom->nlocal; i++) {
    if (rows[i][AREA] == 0.0) continue;
    double area[3];
    present_area(i, points->F[i], area);
    for (int d = 0; d < 3; d++) mine[d] += rows[i][AREA] * area[d];
    mine[3] += rows[i][AREA] * std::sqrt(dot(area, area));
  }
  if (fields[0]->options.axisymmetric) mine[0] = 0.0;    // of rings
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
  return all[3] > 0.0 ? std::sqrt(dot(all, all)) / all[3] : 1.0;
}

/** A pressure that pulls turns with a rim that curls, and holds it there, at rest under a part of
 *  its load. Collective. */
void FixMPMTraction::look_for_curls()
{
  constexpr double MUCH = 0.75, PLANE = 0.5;    // of the evenness at the start of the run, and that
  const bool pulls = has_pressure && now[3].of_points.empty() && now[3].value < 0.0;
  if (!pulls || evenness_at_start < PLANE) return;
  const double now_even = evenness();
  if (comm->me == 0 && now_even < MUCH * evenness_at_start)
    error->warning(FLERR,
                   "Fix mpm/traction {}: the resultant of the pressure, which pulls, is {:.2g} of "
                   "pressure times area, and was {:.2g} at the start of the run: where the "
                   "surface should not bulge by so much, its rim has curled: use frame total",
                   id, now_even, evenness_at_start);
}

/** In the updated frame, points that move from cell to cell next to a surface cut by the lattice
 *  lose stress, and the area that is found of where they are falls behind: radii of a tube and a
 *  sphere under pressure inside are right to 1 % up to stretches of 1.5 of the bore as this finds
 *  it, and not beyond. Mean over the surface of the largest stretch in it. Collective. */
double FixMPMTraction::mean_stretch() const
{
  const auto *const points = MPMPoints::get(atom);
  const bool flat = domain->dimension == 2 && !fields[0]->options.axisymmetric;
  double mine[2] = {0.0, 0.0}, all[2];
  for (int i = 0; i < atom->nlocal; i++) {
    if (rows[i][AREA] == 0.0) continue;
    const double *const F = points->F[i], *const N = rows[i] + NORMAL;
    // two directions in the surface, before and after
    double s[3] = {0.0, 0.0, 1.0}, t[3], now[2][3];
    if (std::fabs(N[2]) > 0.5) std::swap(s[0], s[2]);
    MathExtra::cross3(N, s, t);
    MathExtra::norm3(t);
    MathExtra::cross3(t, N, s);
    MathExtra::norm3(s);
    for (int d = 0; d < 3; d++) {
      now[0][d] = dot(F + 3 * d, s);
      now[1][d] = dot(F + 3 * d, t);
    }
    const double a = dot(now[0], now[0]), b = dot(now[1], now[1]), c = dot(now[0], now[1]),
                 square = flat ? b : 0.5 * (a + b) + std::hypot(0.5 * (a - b), c),
                 ratio = growth[i][RATIO];
    mine[0] += rows[i][AREA] * std::sqrt(square) * (flat ? ratio : std::sqrt(ratio));
    mine[1] += rows[i][AREA];
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  return all[1] > 0.0 ? all[0] / all[1] : 1.0;
}

void FixMPMTraction::look_for_stretch()
{
  constexpr double MUCH = 1.5;
  if (!grows || warned_of_stretch || fields[0]->frame->is_total()) return;
  const double stretch = mean_stretch();
  if (!(stretch > MUCH)) return;
  warned_of_stretch = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/traction {}: the surface is stretched by a factor of {:.3g}; in the "
                   "updated frame radii of tubes and spheres under pressure are right to 1 % up to "
                   "{}, and several percent too small beyond: use frame total for solids that keep "
                   "their neighbors",
                   id, stretch, MUCH);
}

/** Have points of the surface been deleted? */
void FixMPMTraction::note_lost()
{
  if (surface == FREE) return;
  int here = 0;
  for (int i = 0; i < atom->nlocal; i++) here += rows[i][AREA] != 0.0 || rows[i][STRESS] != 0.0;
  MPMFace::note_lost(lmp, "Fix mpm/traction " + std::string(id), here, known);
}

void FixMPMTraction::define()
{
  double mine[2] = {0.0, 0.0}, all[2];    // area (volume of points), how many
  const auto *const points = MPMPoints::get(atom);
  const auto add = [&](int i, const MPMFace::Share &share) {
    double *const row = rows[i];
    const double *const F = points->F[i], *const n = share.normal;
    row[AREA] = share.area;
    row[STRESS] = share.stress;
    for (int d = 0; d < 3; d++) {
      // normal and area were found in the present state: N = F^T n/J
      row[NORMAL + d] = (F[d] * n[0] + F[3 + d] * n[1] + F[6 + d] * n[2]) / determinant(F);
      row[PLACE + d] = atom->x[i][d];
    }
    row[HEIGHT] = determinant(F);
    if (grows) {
      growth[i][RATIO] = 1.0;
      growth[i][LAYER] = 1.0 + std::min((int) share.layer, MPMFaceGrowth::LAYERS - 1);
      std::fill_n(growth[i] + MOVED, 3, 0.0);
      std::copy_n(n, 3, growth[i] + FACING);
    }
    mine[0] += share.area;
    mine[1] += 1.0;
  };
  std::unique_ptr<MPMFace> face;
  double given = area;
  if (surface == REGION) {
    face = std::make_unique<MPMFace>(lmp, domain->get_region_by_id(region), spacing);
    for (const auto *field : fields) face->find(*field, groupbit, add);
  } else {
    given = points_area;
    const double length = std::sqrt(dot(points_normal, points_normal));
    MPMFace::Share share = {};
    for (int d = 0; d < 3; d++) share.normal[d] = points_normal[d] / length;
    for (const auto *field : fields)
      for (int i = 0; i < atom->nlocal; i++) {
        if (!belongs(*field, i)) continue;
        share.area = atom->vfrac[i];
        add(i, share);
      }
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  if (all[1] == 0.0 && !face)
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/traction {} has no points in group {}", id,
               group->names[igroup]);
  if (face) face->check("Fix mpm/traction " + std::string(id), igroup, area);
  const double scale = given > 0.0 ? given / all[0] : 1.0;
  for (int i = 0; i < atom->nlocal; i++) {
    rows[i][AREA] *= scale;
    rows[i][STRESS] *= surface == REGION ? scale : 0.0;
  }
  defined = true;
  if (comm->me == 0)
    utils::logmesg(lmp, "Fix mpm/traction {}: area {:.8g} of {:.0f} points\n", id, all[0] * scale,
                   all[1]);
}

void FixMPMTraction::evaluate_loads()
{
  bool any = false;
  for (int k = 0; k < NLOAD; k++) any = any || !load(k).variable.empty();
  if (any) modify->clearstep_compute();
  for (int k = 0; k < NLOAD; k++) {
    const double unit = k < 4 ? 1.0 / force->nktv2p : 1.0;
    const auto &v = load(k);
    const bool of_points = !v.variable.empty() && input->variable->atomstyle(v.index);
    if (!of_points) {
      now[k].of_points.clear();
      now[k].value = unit * evaluate(lmp, v);
      continue;
    }
    now[k].of_points.assign(atom->nmax, 0.0);
    input->variable->compute_atom(v.index, igroup, now[k].of_points.data(), 1, 0);
    for (int i = 0; i < atom->nlocal; i++) {
      double &value = now[k].of_points[i];
      if ((surface == FREE || rows[i][AREA] != 0.0) && !std::isfinite(value))
        error->one(FLERR, "Variable {} for fix mpm/traction {} is {} at point {}", v.variable, id,
                   value, atom->tag[i]);
      value *= unit;
    }
  }
  if (any) modify->addstep_compute(update->ntimestep + 1);
  const double torque[3] = {now[4].value, now[5].value, now[6].value};
  if (turn) turn->set(torque);
}

/** cof(F) N: the present area for each one before deformation, times its normal. */
void FixMPMTraction::present_area(int i, const double *F, double *area) const
{
  const double cofactors[9] = MPM_COFACTORS(F);
  const double ratio = grows ? growth[i][RATIO] : 1.0;
  for (int d = 0; d < 3; d++) area[d] = ratio * dot(cofactors + 3 * d, rows[i] + NORMAL);
}

void FixMPMTraction::load_on(int i, const double *F, double *load) const
{
  for (int d = 0; d < 3; d++) load[d] = now[d].at(i);
  if (turn) {
    double of_moment[3];
    turn->load(i, of_moment);
    for (int d = 0; d < 3; d++) load[d] += of_moment[d];
  }
  if (!has_pressure) return;
  double area[3];
  present_area(i, F, area);
  for (int d = 0; d < 3; d++) load[d] -= now[3].at(i) * area[d];
}

void FixMPMTraction::post_force(int)
{
  evaluate_loads();
  std::fill_n(sums, size_vector, 0.0);
  sums_known = false;
  if (surface == FREE)
    press();
  else
    add_forces();
}

/** Work is that of the mean of the loads before and after each motion of a point. The stress -W J/a
 *  T n has the power W V T.n d(J/a)/dt in a load along the normal; that of a traction along the
 *  surface, whose sum over layers is next to nothing, is left out here. */
void FixMPMTraction::add_forces()
{
  const auto *const points = MPMPoints::get(atom);
  for (int i = 0; i < atom->nlocal; i++) {
    double *const row = rows[i], *const last = row + LOAD;
    if (row[AREA] == 0.0 && row[STRESS] == 0.0) continue;
    const double *const x = atom->x[i], *const F = points->F[i];
    double load[3], moved[3], area[3], torque[3], place[3];
    load_on(i, F, load);
    present_area(i, F, area);
    const double size = std::sqrt(dot(area, area)), height = determinant(F) / size;
    work[1] += 0.5 * (dot(last, area) + dot(load, area)) / size * atom->vfrac[i] * row[STRESS] *
        (height - row[HEIGHT]);
    for (int d = 0; d < 3; d++) moved[d] = x[d] - row[PLACE + d];
    nearest_image(*domain, moved);
    for (int d = 0; d < 3; d++) {
      const double force = row[AREA] * load[d];
      work[0] += 0.5 * (row[AREA] * last[d] + force) * moved[d];
      atom->f[i][d] += force;
      sums[d] += force;
      last[d] = load[d];
      row[PLACE + d] = x[d];
      if (grows) growth[i][MOVED + d] += moved[d];
    }
    sums[3] += row[AREA] * size;
    row[HEIGHT] = height;
    row[PRESSED] = has_pressure ? now[3].at(i) : 0.0;
    domain->unmap(x, atom->image[i], place);
    cross(place, load, torque);
    for (int d = 0; d < 3; d++) sums[4 + d] += row[AREA] * torque[d];
  }
}

/** Of the pressure at points: differences across a part of a cell, in which points differ from
 *  their neighbors. */
void FixMPMTraction::find_gradient(std::vector<double> &gradient)
{
  if (now[3].of_points.empty()) return;    // the same everywhere
  gradient.assign(3 * (std::size_t) atom->nmax, 0.0);
  const int n = atom->nlocal, dim = domain->dimension;
  double **const x = atom->x;
  const double step = 0.25 * fields[0]->lattice.h, scale = 0.5 / (step * force->nktv2p);
  std::vector<double> values(atom->nmax, 0.0), place(n);
  for (int d = 0; d < dim; d++) {
    for (int i = 0; i < n; i++) place[i] = x[i][d];
    for (const double sign : {1.0, -1.0}) {
      for (int i = 0; i < n; i++) x[i][d] = place[i] + sign * step;
      input->variable->compute_atom(pressure.index, igroup, values.data(), 1, 0);
      for (int i = 0; i < n; i++) gradient[3 * (std::size_t) i + d] += sign * scale * values[i];
    }
    for (int i = 0; i < n; i++) x[i][d] = place[i];
  }
}

/** Pressure on all of the surface: where it depends on the place, there is a force on the volume
 *  besides the stress, -int p N_i n da = -int (p grad N_i + N_i grad p) dv. The work is that on the
 *  volume, and of this force. */
void FixMPMTraction::press()
{
  const auto *const points = MPMPoints::get(atom);
  std::vector<double> gradient;
  find_gradient(gradient);
  for (const auto *field : fields)
    for (int i = 0; i < atom->nlocal; i++) {
      if (!belongs(*field, i)) continue;
      double *const row = inside[i];
      const double *const x = atom->x[i];
      const double p = now[3].at(i), volume = atom->vfrac[i] * points->jacobian(i);
      const bool known = row[VOLUME] > 0.0;
      double moved[3], push[3], torque[3], place[3];
      for (int d = 0; d < 3; d++) {
        push[d] = gradient.empty() ? 0.0 : -volume * gradient[3 * (std::size_t) i + d];
        moved[d] = x[d] - row[AT + d];
      }
      nearest_image(*domain, moved);
      if (known) work[1] -= 0.5 * (row[PRESSURE] + p) * (volume - row[VOLUME]);
      domain->unmap(x, atom->image[i], place);
      cross(place, push, torque);
      for (int d = 0; d < 3; d++) {
        if (known) work[0] += 0.5 * (row[PUSH + d] + push[d]) * moved[d];
        row[PUSH + d] = push[d];
        row[AT + d] = x[d];
        atom->f[i][d] += push[d];
        sums[d] += push[d];
        sums[4 + d] += torque[d];
      }
      row[PRESSURE] = p;
      row[VOLUME] = volume;
    }
}

/** The part of the load that is a stress, of points that the plan may have sorted since the loads
 *  were evaluated. */
bool FixMPMTraction::adds_stress(const MPMField &field, int first, int last) const
{
  for (int i = first; i < last; i++)
    if (surface == FREE ? belongs(field, i) : rows[i][STRESS] != 0.0) return true;
  return false;
}

/** Adds the Kirchhoff stress of a load T = load [3] at point i with the deformation gradient F. */
void FixMPMTraction::add_stress_of_load(int i, const double *F, const double *T, double *tau) const
{
  const double *const row = rows[i];
  if (row[STRESS] == 0.0) return;
  double n[3];
  present_area(i, F, n);
  const double size = std::sqrt(dot(n, n));
  for (double &component : n) component /= size;
  MPMFace::add_stress(T, n, force->nktv2p * row[STRESS] * determinant(F) / size, tau);
}

void FixMPMTraction::add_stress(const MPMField &field, int first, int n, double *tau) const
{
  const double unit = force->nktv2p;
  for (int k = 0; k < n; k++, tau += 6) {
    const int i = first + k;
    if (surface == FREE) {
      const double p = belongs(field, i) ? unit * inside[i][PRESSURE] * field.points->jacobian(i)
                                         : 0.0;
      for (int c = 0; c < 3; c++) tau[c] += p;
      continue;
    }
    add_stress_of_load(i, field.points->F[i], rows[i] + LOAD, tau);
  }
}

/** Turns v by the smallest rotation from the direction of a to that of b. */
static void turn_with(const double *a, const double *b, double *v)
{
  double axis[3], first[3], second[3];
  cross(a, b, axis);
  const double size = std::sqrt(dot(a, a) * dot(b, b)), cosine = dot(a, b) / size;
  for (double &component : axis) component /= size;
  if (!(cosine > -0.999)) return;
  cross(axis, v, first);
  cross(axis, first, second);
  for (int d = 0; d < 3; d++) v[d] += first[d] + second[d] / (1.0 + cosine);
}

/** The loads of this step at other deformations: dead ones are those in the rows, which pressure
 *  changes by its area. */
bool FixMPMTraction::follows(const MPMField &field, int first, int last) const
{
  if (surface == FREE) return adds_stress(field, first, last);
  for (int i = first; i < last; i++)
    if (rows[i][STRESS] != 0.0 || (has_pressure && rows[i][AREA] != 0.0)) return true;
  return false;
}

void FixMPMTraction::follow(const MPMField &field, int first, int n, const double *F, double *push,
                            double *tau) const
{
  for (int k = 0; k < n; k++, F += 9, push += 3, tau += 6) {
    const int i = first + k;
    if (surface == FREE) {
      if (!belongs(field, i)) continue;
      const double J = determinant(F), grown = J / field.points->jacobian(i) - 1.0;
      for (int d = 0; d < 3; d++) {
        tau[d] += force->nktv2p * inside[i][PRESSURE] * J;
        push[d] += grown * inside[i][PUSH + d];
      }
      continue;
    }
    const double *const row = rows[i];
    if (row[STRESS] == 0.0 && row[AREA] == 0.0) continue;
    double before[3], after[3], load[3];
    present_area(i, field.points->F[i], before);
    present_area(i, F, after);
    for (int d = 0; d < 3; d++) {
      const double change = -row[PRESSED] * (after[d] - before[d]);
      load[d] = row[LOAD + d] + change;
      push[d] += row[AREA] * change;
    }
    if (turn) {    // its forces are those of MPMMoment; the stress turns with the surface
      double of_moment[3];
      turn->load(i, of_moment);
      for (int d = 0; d < 3; d++) load[d] -= of_moment[d];
      turn_with(before, after, of_moment);
      for (int d = 0; d < 3; d++) load[d] += of_moment[d];
    }
    add_stress_of_load(i, F, load, tau);
  }
}

/** The watch of energies knows the work of atom->f alone. */
std::vector<MPMPhysics::Account> FixMPMTraction::accounts() const
{
  if (surface == POINTS) return {};
  return {{"work of " + std::string(id) + " by stress", false, true}};
}

double FixMPMTraction::compute_scalar()
{
  double mine = work[0] + work[1], all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMTraction::compute_vector(int k)
{
  if (!sums_known) MPI_Allreduce(sums, all_sums, size_vector, MPI_DOUBLE, MPI_SUM, world);
  sums_known = true;
  return all_sums[k];
}

double FixMPMTraction::memory_usage()
{
  double bytes = FixMPMState::memory_usage() + face_growth.memory_usage();
  for (const auto &each : now) bytes += each.of_points.capacity() * sizeof(double);
  return bytes;
}

void FixMPMTraction::write_restart(FILE *fp)
{
  std::vector<double> totals(work, work + 2);
  write_totals(fp, world, totals, {defined ? 1.0 : 0.0, known});
  std::copy_n(totals.begin(), 2, work);
}

void FixMPMTraction::restart(char *buf)
{
  const auto *const list = (const double *) read_state(lmp, id, buf, 4 * sizeof(double));
  if (comm->me == 0) std::copy_n(list, 2, work);
  defined = list[2] != 0.0;
  known = list[3];
}
