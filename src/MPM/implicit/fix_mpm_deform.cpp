/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   A cell of a periodic body, in the total frame. With the mean deformation gradient Fm, and the velocity v of points and
   nodes without the mean motion,

     F <- F + dt (dv/dX + dFm/dt),   f_i = -sum V0 P dN_i/dX

   Periodic v do no work against the mean stress, so that (R. Hill, J. Mech. Phys. Solids 11 (1963) 357)

     <P> : dFm/dt = <P : dF/dt>,   <.> = sum over points, with V0, over the volume of the cell

   up to the inertia of v, and the work of the mean motion is that of the mean stress <P>. Empty places have no stress. The inertia
   of the mean motion itself, which in a cell of a large body is that of the whole body, is left out.

   A component with a stress s* moves like a mass of the inertia rho L^2 for each volume, with the mean density rho and the longest
   edge L of the cell,

     rho L^2 de/dt = s* - s

   so that it swings 2 pi times slower than the slowest wave in the cell, whatever its stiffness is. Whenever it passes s*, it goes on with the mean
   speed since it has done so before: a swing about a stress at rest ends at once, one about a stress or another strain that goes on keeps up with it. As
   with kinetic damping (fix mpm/relax), no coefficient has to be chosen.
------------------------------------------------------------------------- */

#include "implicit/fix_mpm_deform.h"

#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "implicit/fix_mpm_relax.h"
#include "math/matrix.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

static constexpr int ROW[6] = {0, 1, 2, 0, 0, 1}, COLUMN[6] = {0, 1, 2, 1, 2, 2};
static constexpr double STRAINED = 1.0e-6;    // mean strain that is more than round-off
static constexpr const char *PART_NAME[6] = {"x", "y", "z", "xy", "xz", "yz"};

/* ----------------------------------------------------------------------
   fix ID all mpm/deform x|y|z|xy|xz|yz erate|trate|strain|stress value ...
------------------------------------------------------------------------- */

Options MPMDeformOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/deform");
  for (int k = 0; k < NPART; k++) {
    if (dim == 2 && (ROW[k] == 2 || COLUMN[k] == 2)) continue;
    const auto value = [&](const char *name, const char *unit) {
      return std::vector<OptionValue>{variables(&wanted[k], 1, name, unit, "")};
    };
    const bool shear = k > 2;
    std::vector<OptionWord> ways = {{"erate", ERATE,
                                     shear ? "rate of the angle of shear, R = d(gamma)/dt"
                                           : "rate of the engineering strain, R = d(L/L0)/dt",
                                     value("R", "1/time")}};
    if (!shear)
      ways.push_back(
          {"trate", TRATE, "rate of the true strain, R = d(ln L)/dt", value("R", "1/time")});
    ways.push_back({"strain", STRAIN,
                    shear ? "angle of shear at the end of the step"
                          : "engineering strain L/L0 - 1 at the end of the step",
                    value("e", "")});
    ways.push_back({"stress", STRESS,
                    "target of the mean true stress in the cell, tension positive",
                    value("s", "pressure")});
    o.add(PART_NAME[k], {word(drive[k], ways, "way")}).standard("kept as it is").once();
  }
  return o;
}

FixMPMDeform::FixMPMDeform(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/deform strains all of a periodic cell: use group all");
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  std::copy_n(past.F, 9, next);
  std::fill_n(rate, 9, 0.0);
  scalar_flag = vector_flag = 1;
  size_vector = 18;
  global_freq = 1;
  extscalar = 1;
  extvector = 0;
  restart_global = 1;
  dynamic_group_allow = 1;
}

/** Components in another way from now on: what the cell has, stays. */
int FixMPMDeform::modify_param(int narg, char **arg)
{
  Options options = declare(domain->dimension);
  if (narg == 0 || !options.has(arg[0])) return 0;
  for (int k = 0; k < NPART; k++)
    if (drive[k] != STRESS) past.speed[k] = past.lack[k] = past.way[k] = past.time[k] = 0.0;
  return read_options(lmp, options, narg, arg, 0);
}

FixMPMDeform::~FixMPMDeform()
{
  for (auto *field : MPMField::all(lmp))
    if (field->frame->mean_rate == rate) field->frame->mean_rate = nullptr;
}

/* ---------------------------------------------------------------------- */

void FixMPMDeform::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this, "give all components to one of them");
  for (int k = 0; k < NPART; k++)
    find_variable(lmp, wanted[k], fmt::format("fix mpm/deform {}", PART_NAME[k]));
  for (int d = 0; d < domain->dimension; d++)
    if (!domain->periodicity[d])
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/deform {} strains a cell that is periodic along all axes, but {} is not: use "
          "boundary p, or pull with walls (fix mpm/boundary ... velocity)",
          id, (char) ('x' + d));
  refuse_combinations();
}

void FixMPMDeform::refuse_combinations() const
{
  static const std::pair<const char *, const char *> others[] = {
      {"mpm/boundary", "walls would hold nodes that have only a part of the motion"},
      {"mpm/rigid", "it would meet points at places without the mean motion"},
      {"mpm/contact", "bodies would meet at places without the mean motion"},
      {"mpm/traction", "its work is that of a part of the motion"},
      {"mpm/dashpot", "it would see a part of the motion"},
      {"mpm/surface", "grains would meet points at places without the mean motion"},
      {"mpm/handshake", "atoms would meet points at places without the mean motion"},
      {"mpm/elements", "elements do not know the mean strain"},
      {"mpm/heat", "temperatures spread in a cell that does not strain"},
      {"mpm/pore", "water spreads in a cell that does not strain"},
      {"mpm/mixture", "water spreads in a cell that does not strain"},
      {"mpm/implicit", "its solver does not know the mean strain"}};
  for (const auto &[style, why] : others)
    for (const auto *other : modify->get_fix_list())
      if (strcmp(other->style, style) == 0)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/deform {} cannot be used with fix {} (style {}): {}", id, other->id,
                   style, why);
  if (std::none_of(drive, drive + NPART, [](Drive d) {
        return d == STRESS;
      }))
    return;
  for (const auto *rest : find_fixes<FixMPMRelax>(lmp))
    if (rest->ends_runs())
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/relax {} would end the run before the mean stress of fix mpm/deform {} is "
          "reached: use stop no",
          rest->id, id);
}

void FixMPMDeform::init_physics(MPMPlan &plan)
{
  fields = plan.fields;
  for (auto *field : fields) {
    const auto &options = field->options;
    refuse_field(
        lmp, *this, *field,
        {{!options.total, "frame updated",
          "the lattice does not strain, so that it must be that of the body before: use frame "
          "total"},
         {options.most_distorted > 0.0, "reference update",
          "the new reference would lack the mean strain: use reference fixed, the default"},
         {options.axisymmetric, "geometry axisymmetric", "a ring is no periodic cell"},
         {options.stress_before(), "scheme usf or usavg",
          "they strain points by the motion of the step before: use scheme usl or musl"},
         {options.every > 1, "every", "use every 1"}});
    field->frame->mean_rate = rate;
  }
}

void FixMPMDeform::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place == MPMPlan::BEFORE_POINTS_TO_NODES)
    plan.together("mean strain", {Data::POSITION, Data::DEFORMATION, Data::STRESS, Data::OWN},
                  {Data::OWN}, [this]() {
                    find_motion();
                  });
  if (place == MPMPlan::AFTER_MOTION)
    plan.together("mean stress", {Data::POSITION, Data::DEFORMATION, Data::STRESS, Data::OWN},
                  {Data::OWN}, [this]() {
                    end_motion();
                  });
}

/* ---------------------------------------------------------------------- */

/** Of the cell before deformation; 2d: for a thickness of 1. */
double FixMPMDeform::volume() const
{
  return domain->xprd * domain->yprd * (domain->dimension == 3 ? domain->zprd : 1.0);
}

/** Mean Cauchy stress. */
double FixMPMDeform::stress(int part) const
{
  return past.tau[part] / determinant(past.F);
}

/** The mean deformation gradient at the end of this step. */
void FixMPMDeform::find_motion()
{
  if (past.known == 0.0) {
    warn_of_strain();
    find_stress();
    past.known = 1.0;
  }
  bool any = false;
  for (const auto &w : wanted) any = any || !w.variable.empty();
  double now[NPART] = {};
  evaluate_in_step(lmp, any, [&]() {
    for (int k = 0; k < NPART; k++)
      if (drive[k] != HELD) now[k] = evaluate(lmp, wanted[k]);
  });

  const double dt = fields[0]->step_dt();
  double inertia = 0.0;    // [pressure time^2]
  if (std::any_of(drive, drive + NPART, [](Drive d) {
        return d == STRESS;
      })) {
    double mine = 0.0, mass, edge = 0.0;
    for (const auto *field : fields)
      for (int i = 0; i < atom->nlocal; i++)
        if (field->is_point(i)) mine += atom->rmass[i];
    MPI_Allreduce(&mine, &mass, 1, MPI_DOUBLE, MPI_SUM, world);
    for (int d = 0; d < domain->dimension; d++)
      edge = std::max(edge, domain->prd[d] * past.F[4 * d]);
    inertia = mass / (volume() * determinant(past.F)) * edge * edge * force->nktv2p / force->ftm2v;
  }

  std::copy_n(past.F, 9, next);
  for (int k = 0; k < NPART; k++) {
    double &F = next[3 * ROW[k] + COLUMN[k]], &speed = past.speed[k];
    const double unit = k > 2 ? 0.0 : 1.0;
    switch (drive[k]) {
      case HELD:
        break;
      case ERATE:
        F += dt * now[k];
        break;
      case TRATE:
        F *= std::exp(dt * now[k]);
        break;
      case STRAIN:
        F = unit + now[k];
        break;
      case STRESS: {
        const double lack = now[k] - stress(k);
        if (lack * past.lack[k] < 0.0) {
          speed = past.way[k] / past.time[k];
          past.way[k] = past.time[k] = 0.0;
        }
        past.lack[k] = lack;
        speed += dt * lack / inertia;
        past.way[k] += dt * speed;
        past.time[k] += dt;
        F += dt * speed * past.F[4 * COLUMN[k]];
        break;
      }
    }
    if (k < 3 && !(F > 0.0))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/deform {}: the cell has the length {:.6g} along {} at step {}", id,
                 F * domain->prd[k], PART_NAME[k], update->ntimestep);
  }
  for (int c = 0; c < 9; c++) rate[c] = (next[c] - past.F[c]) / dt;
}

/** Is there a mean deformation that this fix does not know of? */
void FixMPMDeform::warn_of_strain() const
{
  double mine[10] = {}, all[10], most = 0.0;
  for (const auto *field : fields)
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i)) continue;
      mine[9] += atom->vfrac[i];
      for (int c = 0; c < 9; c++)
        mine[c] += atom->vfrac[i] * (field->points->F[i][c] - (c % 4 == 0 ? 1.0 : 0.0));
    }
  MPI_Allreduce(mine, all, 10, MPI_DOUBLE, MPI_SUM, world);
  for (int c = 0; c < 9; c++) most = std::max(most, std::fabs(all[c]));
  if (most > STRAINED * all[9] && comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/deform {}: points are strained already, by {:.3g} on average, which the mean "
        "deformation does not count: define this fix before their first run, and use fix_modify "
        "to go on in another way",
        id, most / all[9]);
}

/** Mean stress of the points, tau and P = tau F^-T. */
void FixMPMDeform::find_stress()
{
  double mine[15] = {}, all[15];
  for (const auto *field : fields)
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i)) continue;
      const double *const F = field->points->F[i], *const t = field->points->tau[i];
      const double cofactors[9] = MPM_COFACTORS(F), V = atom->vfrac[i], J = determinant(F);
      const double tau[9] = {t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2]};
      for (int c = 0; c < 6; c++) mine[c] += V * t[c];
      for (int c = 0; c < 9; c++) mine[6 + c] += V / J * product(tau, cofactors, c / 3, c % 3);
    }
  MPI_Allreduce(mine, all, 15, MPI_DOUBLE, MPI_SUM, world);
  for (double &sum : all) sum /= volume();
  std::copy_n(all, 6, past.tau);
  std::copy_n(all + 6, 9, past.P);
}

/** Work is that of the mean of the stress before and after. */
void FixMPMDeform::end_motion()
{
  double P[9], work = 0.0;
  std::copy_n(past.P, 9, P);
  find_stress();
  for (int c = 0; c < 9; c++) work += 0.5 * (P[c] + past.P[c]) * (next[c] - past.F[c]);
  work *= volume() / force->nktv2p;
  past.work += work;
  std::copy_n(next, 9, past.F);
  if (comm->me) return;
  // stress takes this from the mean motion, besides what it takes from that of nodes
  auto &ledger = fields[0]->ledger;
  ledger.boundary += work;
  ledger.internal += work;
  ledger.driven += work;
}

/* ---------------------------------------------------------------------- */

void FixMPMDeform::write_restart(FILE *fp)
{
  if (comm->me) return;
  const int size = NREAL * (int) sizeof(double);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(reals(), sizeof(double), NREAL, fp);
}

void FixMPMDeform::restart(char *buf)
{
  memcpy(reals(), buf, NREAL * sizeof(double));
  std::copy_n(past.F, 9, next);
}

/* ----------------------------------------------------------------------
   mean deformation gradient, mean true stress, and mean nominal stress, at the end of the last step: xx yy zz xy xz yz
------------------------------------------------------------------------- */

double FixMPMDeform::compute_vector(int n)
{
  const int k = n % NPART, entry = 3 * ROW[k] + COLUMN[k];
  return n < NPART ? past.F[entry] : n < 2 * NPART ? stress(k) : past.P[entry];
}
