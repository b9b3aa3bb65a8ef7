/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/fix_mpm_material.h"

#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "field/mpm_doubts.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "material/material_point.h"
#include "material/phase_field.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int RESTART_VERSION = 2;

FixMPMMaterial::FixMPMMaterial(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  static_assert(NWORK <= sizeof(work) / sizeof(double), "room for all kinds of work");
  require_arguments(lmp, "fix mpm/material", narg, 3, {"density or file"});
  if (!atom->rmass || !atom->vfrac)
    error->all(FLERR,
               "Fix mpm/material needs material points: use atom_style mpm, alone or in a hybrid");

  material = read_material(lmp, "Fix mpm/material", 3, narg, arg);

  // initial values of history depend on units
  material->configure(nullptr, force->mvv2e * force->nktv2p, force->nktv2p);

  restart_global = 1;
  nhistory = material->history().size();
  damage = find_history("damage");
  crack = find_history("phase");
  if (crack < 0) crack = damage;
  if (nhistory > 0)
    state.declare(history, "mpm/material:history", nhistory, [this](int i, double *row) {
      try {
        material->initialize(atom->x[i], row);
      } catch (const std::runtime_error &e) {
        error->one(FLERR, Error::NOLASTLINE, "Fix mpm/material {}: {}", id, e.what());
      }
    });
  // the pressure of other materials depends on their history, too, which a change of volume would
  // change for good: shocks in gases would be wrong by 3 to 10 % in density
  if (material->is_barotropic()) state.declare(volume_rate, "mpm/material:volume_rate");
  keep_arrays();

  exits.assign(material->ranges().size(), {false, MAXBIGINT, 0, 0.0});
  watching = !exits.empty();

  if (comm->me == 0) utils::logmesg(lmp, "Material {}: {}\n", id, material->describe());
  assign_mass();
}

FixMPMMaterial::~FixMPMMaterial() = default;

/** The energy of an ideal gas is that of its temperature with one specific heat alone. */
static void check_gas(LAMMPS *lmp, const FixMPMMaterial &fix)
{
  constexpr double SAME = 0.02;
  const Material &material = *fix.material;
  if (!material.conducts() || !is_ideal_gas(material)) return;
  const MaterialPoint point(material);
  const double T = point.batch.history[fix.temperature()][0],
               E = point.batch.history[fix.find_history("energy")][0],
               has = material.conduction(nullptr).capacity,
               needs = E / (material.density() * lmp->force->nktv2p * T);
  if (T > 0.0 && std::fabs(has / needs - 1.0) <= SAME) return;
  const std::string remedy = T > 0.0
      ? fmt::format("use {:.6g}, or another initial temperature", needs)
      : "its initial temperature must be absolute";
  if (lmp->comm->me == 0)
    lmp->error->warning(
        FLERR,
        "Fix mpm/material {}: with the specific heat {:.6g} the pressure of this ideal gas is not "
        "in proportion to its temperature: {}",
        fix.id, has, remedy);
}

void FixMPMMaterial::init()
{
  material->initialized();
  if (material->conducts() && modify->get_fix_by_style("^mpm/heat$").empty() &&
      modify->get_fix_by_style("^mpm/mesh/heat$").empty() && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/material {} has thermal conducting, but there is no fix mpm/{}heat, "
                   "which conducts: define one, or use thermal adiabatic",
                   id, modify->get_fix_by_style("^mpm/mesh$").empty() ? "" : "mesh/");
  if (phase_field_cracks(*material) && modify->get_fix_by_style("^mpm/phasefield$").empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/material {} has damage phasefield, but no cracks would grow without fix "
               "mpm/phasefield: define one, or use damage rankine with soften energy",
               id);
  counts_stress = !modify->get_compute_by_style("^mpm/energy$").empty();
  if (material->is_of_surfaces()) check_surfaces();
  check_gas(lmp, *this);
  if (!has_begun) check_history();
  has_begun = true;
  assign_mass();

  // a mass that create_atoms left, together with a volume that was set, is easily overlooked
  if (mass_varies) return;
  bigint n = 0, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || !(atom->vfrac[i] > 0.0)) continue;
    const double mass = density(i) * atom->vfrac[i];
    if (fabs(atom->rmass[i] - mass) > 1.0e-3 * mass) n++;
  }
  MPI_Allreduce(&n, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all && comm->me == 0)
    error->warning(FLERR,
                   "{} material points keep a mass that is not the density of fix mpm/material {} "
                   "times their volume",
                   all, id);
}

/** A law that bears nothing across a plane would let points, and elements that are no surfaces,
 *  fall apart; the latter are refused by fix mpm/elements. */
void FixMPMMaterial::check_surfaces() const
{
  int nodes = 0;
  for (const auto *ifix : modify->get_fix_by_style("^mpm/elements$")) nodes |= ifix->groupbit;
  bigint n = 0, all;
  for (int i = 0; i < atom->nlocal; i++)
    n += (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0 && !(atom->mask[i] & nodes);
  MPI_Allreduce(&n, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/material {}: its law bears nothing across a surface, and {} of its points "
               "are no nodes of one: use fix mpm/elements with thickness and axes for them",
               id, all);
}

void FixMPMMaterial::unpack_restart(int i, int nth)
{
  FixMPMState::unpack_restart(i, nth);
  is_restored = true;
}

/** The history of points goes with the fix that it belongs to. Collective: a rank without points
 *  has nothing from a restart file. */
void FixMPMMaterial::check_history() const
{
  static const double UNIT[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  constexpr double ROUND_OFF = 1.0e-9;
  if (nhistory == 0) return;
  const MPMPoints &points = *MPMPoints::get(atom);
  bigint n = 0, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (is_restored || !(atom->mask[i] & groupbit) || !(atom->vfrac[i] > 0.0)) continue;
    bool is_deformed = false;
    for (int k = 0; k < 9; k++) is_deformed |= fabs(points.F[i][k] - UNIT[k]) > ROUND_OFF;
    for (int k = 0; k < 6; k++) is_deformed |= points.tau[i][k] != 0.0;
    n += is_deformed;
  }
  MPI_Allreduce(&n, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (!all || comm->me != 0) return;
  error->warning(FLERR,
                 "Fix mpm/material {}: {} points were deformed before it was defined, and what it "
                 "keeps for them begins anew:{}. To go on from the state of a fix with the same ID "
                 "that was removed, write a restart file before, read it, and define the material "
                 "there",
                 id, all, names());
}

/** Ranges of validity: each rank notes the first step in which one of its points is outside; ranks
 *  compare notes only when they talk to each other anyway. */
void FixMPMMaterial::watch_ranges(const Batch &b, int first)
{
  double value[BATCH];
  const auto &ranges = material->ranges();
  for (std::size_t k = 0; k < ranges.size(); k++) {
    Exit &e = exits[k];
    if (e.reported || e.step < update->ntimestep || !material->outside(b, k, value)) continue;
    for (int i = 0; i < b.n; i++) {
      const tagint tag = atom->tag[first + i];
      if (value[i] >= ranges[k].low && value[i] <= ranges[k].high) continue;
      if (e.step == update->ntimestep && e.tag < tag) continue;
      e = {false, update->ntimestep, tag, value[i]};
    }
  }
}

/** One warning for each range that was left, the same for any number of ranks. */
void FixMPMMaterial::report_exits()
{
  if (!watching) return;
  const int n = exits.size();
  std::vector<bigint> mine(n), step(n), tag(n);
  for (int k = 0; k < n; k++) mine[k] = exits[k].reported ? MAXBIGINT : exits[k].step;
  MPI_Allreduce(mine.data(), step.data(), n, MPI_LMP_BIGINT, MPI_MIN, world);
  if (*std::min_element(step.begin(), step.end()) == MAXBIGINT) return;

  for (int k = 0; k < n; k++) mine[k] = exits[k].step == step[k] ? exits[k].tag : MAXBIGINT;
  MPI_Allreduce(mine.data(), tag.data(), n, MPI_LMP_BIGINT, MPI_MIN, world);
  std::vector<double> here(n, 0.0), value(n);
  for (int k = 0; k < n; k++)
    if (exits[k].step == step[k] && exits[k].tag == tag[k]) here[k] = exits[k].value;
  MPI_Allreduce(here.data(), value.data(), n, MPI_DOUBLE, MPI_SUM, world);

  watching = false;
  for (int k = 0; k < n; k++) {
    if (step[k] < MAXBIGINT && !exits[k].reported) {
      exits[k].reported = true;
      const auto &range = material->ranges()[k];
      if (comm->me == 0)
        error->warning(FLERR,
                       "Fix mpm/material {}: {} {:.6g} of point {} at step {} is out of the range "
                       "of this material, {:.6g} to {:.6g}; this is said only once",
                       id, range.quantity, value[k], tag[k], step[k], range.low, range.high);
    }
    watching = watching || !exits[k].reported;
  }
}

/** Mass of the points that have none yet; masses that were set or read stay. */
void FixMPMMaterial::assign_mass()
{
  const double *const vfrac = atom->vfrac;
  double *const rmass = atom->rmass;
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & groupbit) && vfrac[i] > 0.0 && !(rmass[i] > 0.0))
      rmass[i] = density(i) * vfrac[i];
}

double FixMPMMaterial::density(int i) const
{
  return material->density(history ? history[i] : nullptr);
}

int FixMPMMaterial::find_history(const std::string &name) const
{
  const auto &variables = material->history();
  for (int k = 0; k < nhistory; k++)
    if (variables[k].name == name) return k;
  return -1;
}

/** Names of the history variables, for the comparison with those of a restart file. */
std::string FixMPMMaterial::names() const
{
  std::string text;
  for (const auto &variable : material->history()) text += " " + variable.name;
  return text.empty() ? " none" : text;
}

/** The ledger wants to know the work of the stress. Laws have their own account of the energy; the
 *  two agree to third order in the strain of a step. */
void FixMPMMaterial::update_batch(Batch &b, const BatchKernels &kernels, const double *heat)
{
  for (int p = 0; p < b.n; p++) b.heat[p] = heat ? heat[p] : 0.0;
  double twice_tau[6][BATCH];
  if (counts_stress) {
    memset(twice_tau, 0, sizeof(twice_tau));
    kernels.add_kirchhoff(b, b.Jold, twice_tau);
    for (int p = 0; p < b.n; p++) stress_work += b.vol0[p] * b.heat[p];
  }
  material->update(b);
  for (int k = 0; k < NWORK; k++) work[k] += b.work[k];
  if (counts_stress) {
    kernels.add_kirchhoff(b, b.J, twice_tau);
    stress_work += kernels.stress_work(b, twice_tau);
  }
}

/** Work so far, summed over ranks, and what the history variables are. */
void FixMPMMaterial::write_restart(FILE *fp)
{
  double list[3 + NWORK];
  list[0] = RESTART_VERSION;
  list[1] = NWORK;
  keep_totals(world, work, NWORK);
  keep_totals(world, &stress_work, 1);
  std::copy(work, work + NWORK, list + 2);
  list[2 + NWORK] = stress_work;
  if (comm->me) return;
  const std::string text = names();
  write_state(fp, (std::string((const char *) list, sizeof(list)) + text).c_str(),
              sizeof(list) + text.size() + 1);
}

/** Rank 0 goes on with the total. */
void FixMPMMaterial::restart(char *buf)
{
  double list[3 + NWORK];
  const auto state = read_state(lmp, id, buf);
  if (state.size() <= sizeof(list)) refuse_state(lmp, id);
  memcpy(list, state.data(), sizeof(list));
  if (list[0] != RESTART_VERSION || list[1] != NWORK)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/material {}: the restart file was written by another version of this package", id);
  const std::string text(state.data() + sizeof(list), state.size() - sizeof(list) - 1);
  if (text != names())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/material {}: the points of the restart file have the history variables{}, "
               "those of this material are{}: give the laws with which the file was written",
               id, text, names());
  for (int k = 0; k < NWORK; k++) work[k] = comm->me == 0 ? list[2 + k] : 0.0;
  stress_work = comm->me == 0 ? list[2 + NWORK] : 0.0;
}
