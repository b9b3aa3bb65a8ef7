/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/fix_mpm_deform.h"

#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
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
    if (dim == 2 && (MPMMeanDeformation::ROW[k] == 2 || MPMMeanDeformation::COLUMN[k] == 2))
      continue;
    const auto value = [&](const char *name, const char *unit) {
      return std::vector<OptionValue>{variables(&wanted[k], 1, name, unit, "")};
    };
    const bool shear = k > 2;
    std::vector<OptionWord> ways = {{"erate", MPMMeanDeformation::ERATE,
                                     shear ? "rate of the angle of shear, R = d(gamma)/dt"
                                           : "rate of the engineering strain, R = d(L/L0)/dt",
                                     value("R", "1/time")}};
    if (!shear)
      ways.push_back({"trate", MPMMeanDeformation::TRATE, "rate of the true strain, R = d(ln L)/dt",
                      value("R", "1/time")});
    ways.push_back({"strain", MPMMeanDeformation::STRAIN,
                    shear ? "angle of shear at the end of the step"
                          : "engineering strain L/L0 - 1 at the end of the step",
                    value("e", "")});
    ways.push_back({"stress", MPMMeanDeformation::STRESS,
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
  cell.forget_speeds(drive);
  return read_options(lmp, options, narg, arg, 0);
}

FixMPMDeform::~FixMPMDeform()
{
  for (auto *field : MPMField::all(lmp))
    if (field->frame->mean_rate == cell.rate) field->frame->mean_rate = nullptr;
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
  if (!std::count(drive, drive + NPART, MPMMeanDeformation::STRESS)) return;
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
    field->frame->mean_rate = cell.rate;
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

/** The mean deformation gradient at the end of this step. */
void FixMPMDeform::find_motion()
{
  if (cell.past.known == 0.0) {
    warn_of_strain();
    find_stress(cell.past.tau, cell.past.P);
    cell.past.known = 1.0;
  }
  bool any = false;
  for (const auto &w : wanted) any = any || !w.variable.empty();
  double now[NPART] = {};
  evaluate_in_step(lmp, any, [&]() {
    for (int k = 0; k < NPART; k++)
      if (drive[k] != MPMMeanDeformation::HELD) now[k] = evaluate(lmp, wanted[k]);
  });

  const double dt = fields[0]->step_dt();
  double inertia = 0.0;    // [pressure time^2]
  if (std::count(drive, drive + NPART, MPMMeanDeformation::STRESS)) {
    double mine = 0.0, mass, edge = 0.0;
    for (const auto *field : fields)
      for (int i = 0; i < atom->nlocal; i++)
        if (field->is_point(i)) mine += atom->rmass[i];
    MPI_Allreduce(&mine, &mass, 1, MPI_DOUBLE, MPI_SUM, world);
    for (int d = 0; d < domain->dimension; d++)
      edge = std::max(edge, domain->prd[d] * cell.past.F[4 * d]);
    inertia =
        mass / (volume() * determinant(cell.past.F)) * edge * edge * force->nktv2p / force->ftm2v;
  }

  const int k = cell.advance(dt, drive, now, inertia);
  if (k >= 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/deform {}: the cell has the length {:.6g} along {} at step {}", id,
               cell.next[4 * k] * domain->prd[k], PART_NAME[k], update->ntimestep);
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

/** Mean stress of the points, mean_tau [6] and mean_P [9], P = tau F^-T. */
void FixMPMDeform::find_stress(double *mean_tau, double *mean_P)
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
  std::copy_n(all, 6, mean_tau);
  std::copy_n(all + 6, 9, mean_P);
}

/** Work is that of the mean of the stress before and after. */
void FixMPMDeform::end_motion()
{
  double tau[6], P[9];
  find_stress(tau, P);
  const double work = cell.end_step(tau, P) * (volume() / force->nktv2p);
  cell.past.work += work;
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
  write_state(fp, cell.reals(), MPMMeanDeformation::NREAL * sizeof(double));
}

void FixMPMDeform::restart(char *buf)
{
  constexpr std::size_t SIZE = MPMMeanDeformation::NREAL * sizeof(double);
  memcpy(cell.reals(), read_state(lmp, id, buf, SIZE), SIZE);
  std::copy_n(cell.past.F, 9, cell.next);
}

/* ----------------------------------------------------------------------
   mean deformation gradient, mean true stress, and mean nominal stress, at the end of the last
   step: xx yy zz xy xz yz
------------------------------------------------------------------------- */

double FixMPMDeform::compute_vector(int n)
{
  const int k = n % NPART, entry = 3 * MPMMeanDeformation::ROW[k] + MPMMeanDeformation::COLUMN[k];
  return n < NPART ? cell.past.F[entry] : n < 2 * NPART ? cell.stress(k) : cell.past.P[entry];
}
