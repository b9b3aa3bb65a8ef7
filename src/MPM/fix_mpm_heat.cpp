/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_mpm_heat.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "input.h"
#include "modify.h"
#include "mpm_field.h"
#include "mpm_options.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static const char *const FACE_NAME[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};

/* ----------------------------------------------------------------------
   fix ID all mpm/heat keyword values ...
------------------------------------------------------------------------- */

Options MPMHeatOptions::declare(int dim)
{
  using namespace option;
  using Condition = MPMHeatCondition;
  Options o("fix mpm/heat");
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) {
    Condition &c = conditions[face];
    const auto values = [&c](int n, const std::string &names, const std::string &unit,
                             const std::string &meaning, int first = 0) {
      return variables(c.value + first, n, names, unit, meaning + ", can be a variable");
    };
    const OptionValue outside = values(1, "Tout", "temperature", "temperature outside", 1);
    o.add(
        FACE_NAME[face],
        {word(c.kind,
              {{"insulated", Condition::INSULATED, "no heat goes through this face of the box"},
               {"temperature",
                Condition::TEMPERATURE,
                "",
                {values(1, "T", "temperature", "temperature of the material at the face")}},
               {"flux",
                Condition::FLUX,
                "",
                {values(1, "q", "power/area", "heat that comes in through the face")}},
               {"convection",
                Condition::CONVECTION,
                "",
                {values(1, "H", "power/(area temperature)", "heat transfer coefficient"), outside}},
               {"radiation",
                Condition::RADIATION,
                "",
                {values(1, "EPS", "1", "emissivity"), outside}}})});
  }
  o.add("source", {text(source, "v_name", "power per volume, an equal- or atom-style variable")})
      .standard("none");
  o.add(
      "transfer",
      {word(transfer.kind,
            {{"relax",
              MPMHeatTransfer::RELAX,
              "points get the change of the nodes",
              {number(transfer.relax, "R", NOT_NEGATIVE, "1",
                      "rate at which they take the temperature of the nodes, in the rate at which "
                      "heat crosses a cell")}},
             {"pic", MPMHeatTransfer::PIC, "points get the temperature of the nodes"},
             {"affine", MPMHeatTransfer::AFFINE,
              "points get the temperature of the nodes, and its gradient"}})});
  o.add("stages",
        {integer(most_stages, "N", POSITIVE, "most stages of the conduction in a time step")});
  o.refuse([=] {
    OptionRules rules = {{!source.empty() && source.compare(0, 2, "v_") != 0, "source",
                          "must be a variable, v_name: {source}"}};
    for (int face = 0; face < MPMHeatFaces::NFACE; face++) {
      const auto &c = conditions[face];
      const auto below = [&](int k, double least) {
        return k < c.nvalue() && c.value[k].variable.empty() && !(c.value[k].value >= least);
      };
      rules.push_back({dim == 2 && face >= 4, FACE_NAME[face], "does not exist in 2d"});
      rules.push_back({c.kind >= Condition::CONVECTION && below(0, 0.0), FACE_NAME[face],
                       "needs a coefficient that is not negative"});
      rules.push_back(
          {c.kind == Condition::RADIATION && c.value[0].variable.empty() && c.value[0].value > 1.0,
           FACE_NAME[face], "needs an emissivity that is not above 1"});
      rules.push_back({c.kind == Condition::RADIATION && below(1, 0.0), FACE_NAME[face],
                       "needs an absolute temperature outside, not below 0"});
    }
    return rules;
  });
  return o;
}

FixMPMHeat::FixMPMHeat(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/heat acts on all points whose material has a part thermal conducting: use "
               "group all");
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = NCAME + NGIVER;
  for (auto *heats : {&came, &in_step, &present, &power}) heats->assign(size_vector, 0.0);
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  if (transfer.kind != MPMHeatTransfer::PIC)
    state.declare(gradients, "mpm/heat:gradient", domain->dimension);
  keep_arrays();
}

/* ----------------------------------------------------------------------
   in the units of the input; 0 where these have no kelvins
------------------------------------------------------------------------- */

double FixMPMHeat::sigma() const
{
  struct {
    const char *name;
    double energy, time, length;    // in SI units
  } const units[] = {{"si", 1.0, 1.0, 1.0},
                     {"cgs", 1.0e-7, 1.0, 1.0e-2},
                     {"micro", 1.0e-15, 1.0e-6, 1.0e-6},
                     {"nano", 1.0e-21, 1.0e-9, 1.0e-9},
                     {"metal", 1.602176634e-19, 1.0e-12, 1.0e-10},
                     {"real", 4184.0 / 6.02214076e23, 1.0e-15, 1.0e-10}};
  for (const auto &u : units)
    if (!strcmp(update->unit_style, u.name))
      return 5.670374419e-8 * u.time * u.length * u.length / u.energy;
  return 0.0;
}

/* ---------------------------------------------------------------------- */

void FixMPMHeat::init()
{
  if (modify->get_fix_by_style("^mpm$").empty())
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat needs a fix mpm with the points");
  if (modify->get_fix_by_style("^mpm/heat$").size() > 1)
    error->all(FLERR, Error::NOLASTLINE,
               "There is more than one fix mpm/heat: one acts on all points and faces");
  const auto materials = find_fixes<FixMPMMaterial>(lmp);
  if (std::none_of(materials.begin(), materials.end(), [](auto *fix) {
        return fix->material->conducts();
      }))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat: no material conducts heat: give a fix mpm/material the part "
               "'thermal conducting' with specific heat, temperature, and conductivity");
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) {
    auto &c = conditions[face];
    if (c.kind == MPMHeatCondition::INSULATED) continue;
    const std::string name = std::string("fix mpm/heat ") + FACE_NAME[face];
    if (domain->periodicity[face / 2])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat face {} belongs to a periodic axis: use boundary f there",
                 FACE_NAME[face]);
    if (c.kind == MPMHeatCondition::RADIATION && sigma() == 0.0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat {} radiation needs temperatures in kelvins, which units {} do not "
                 "have: use units si, cgs, micro, nano, metal, or real",
                 FACE_NAME[face], update->unit_style);
    for (int k = 0; k < c.nvalue(); k++) find_variable(lmp, c.value[k], name);
  }
  if (!source.empty()) {
    source_index = input->variable->find(source.c_str() + 2);
    if (source_index < 0 ||
        !(input->variable->equalstyle(source_index) || input->variable->atomstyle(source_index)))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/heat source {}",
                 source.substr(2),
                 source_index < 0 ? "does not exist" : "is not equal-style or atom-style");
  }
}

void FixMPMHeat::init_physics(MPMPlan &plan)
{
  fields.clear();
  steps.clear();
  steps.add(in_step, present);
  for (auto *field : plan.fields) {
    const auto &o = field->options;
    refuse_field(lmp, *this, *field,
                 {{o.modified_edges, "edges modified", "use edges plain"},
                  {o.axisymmetric && domain->boxlo[0] <= 1.0e-6 * field->lattice.h &&
                       conditions[0].kind != MPMHeatCondition::INSULATED,
                   "a condition at xlo, which is the axis of symmetry", "leave xlo insulated"}});
    if (gradients) field->slopes.push_back(&gradients);
    fields.push_back(std::make_unique<MPMConduction>(lmp, *field, transfer, conditions));
    fields.back()->init(sigma());
    if (fields.back()->conducts()) steps.add(fields.back()->temperature, fields.back()->rate);
  }
}

MPMConduction &FixMPMHeat::of(const MPMField &field) const
{
  for (const auto &mine : fields)
    if (&mine->field == &field) return *mine;
  error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat does not know fix mpm {}", field.id());
  return *fields[0];
}

void FixMPMHeat::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place == MPMPlan::AFTER_SOLVE)
    plan.together("conduction of heat", [this]() {
      conduct();
    });
}

/* ---------------------------------------------------------------------- */

void FixMPMHeat::evaluate_variables()
{
  bool any = !source.empty();
  for (const auto &c : conditions)
    for (int k = 0; k < c.nvalue(); k++) any = any || !c.value[k].variable.empty();
  evaluate_in_step(lmp, any, [&] {
    for (auto &c : conditions)
      for (int k = 0; k < c.nvalue(); k++) c.now[k] = evaluate(lmp, c.value[k]);
    if (source.empty()) return;
    source_values.resize(atom->nmax);
    if (input->variable->atomstyle(source_index))
      input->variable->compute_atom(source_index, igroup, source_values.data(), 1, 0);
    else
      std::fill(source_values.begin(), source_values.end(),
                evaluate(lmp, {0.0, source.substr(2), true, source_index}));
  });
}

/* ----------------------------------------------------------------------
   temperatures of nodes, and the stages that all fields need for their step
------------------------------------------------------------------------- */

int FixMPMHeat::count_stages()
{
  std::vector<double> mine, all;
  for (auto &field : fields) {
    const auto limits = field->conducts() ? field->points_to_nodes(gradients)
                                          : MPMConduction::Limits{0.0, 0.0};
    mine.push_back(limits.conduction);
    mine.push_back(limits.exchange);
  }
  all.resize(mine.size());
  MPI_Allreduce(mine.data(), all.data(), (int) all.size(), MPI_DOUBLE, MPI_MAX, world);
  double greatest = 0.0;
  for (std::size_t k = 0; k < fields.size(); k++)
    greatest = std::max(greatest, fields[k]->greatest_rate({all[2 * k], all[2 * k + 1]}));

  const double dt = fields[0]->field.step_dt(), limit = MPMSuperStep::explicit_limit(greatest);
  const int stages = MPMSuperStep::count(dt, limit, most_stages);
  if (stages > most_stages)
    error->all(FLERR, Error::NOLASTLINE,
               "The time step {:.6g} is {:.4g} times the explicit limit {:.4g} of the conduction "
               "of heat, which needs more than {} stages: use fix mpm/dt, a smaller timestep, or "
               "fix mpm/heat ... stages",
               dt, dt / limit, limit, most_stages);
  return stages;
}

void FixMPMHeat::find_rates()
{
  std::fill(present.begin(), present.end(), 0.0);
  for (auto &field : fields) {
    if (!field->conducts()) continue;
    field->find_rates(source.empty() ? nullptr : source_values.data(), present);
    field->faces.add_rates(field->temperature, field->rate, present);
    field->faces.hold_rates(field->rate, present);
  }
}

void FixMPMHeat::conduct()
{
  evaluate_variables();
  std::fill(in_step.begin(), in_step.end(), 0.0);
  const int stages = count_stages();
  for (auto &field : fields)
    if (field->conducts()) field->faces.hold(field->temperature, in_step);
  dt_last = fields[0]->field.step_dt();
  steps.advance(stages, dt_last, [this]() {
    find_rates();
  });
  for (auto &field : fields) {
    if (field->conducts()) got += field->nodes_to_points(gradients);
    field->given.clear();
  }
  std::copy_n(booked, NGIVER, in_step.begin() + NCAME);
  std::fill_n(booked, NGIVER, 0.0);
  for (std::size_t k = 0; k < came.size(); k++) came[k] += in_step[k];
  power_known = false;
}

double FixMPMHeat::stable_dt(const MPMField &field, tagint &tag) const
{
  return MPMSuperStep::reach(most_stages) *
      MPMSuperStep::explicit_limit(of(field).greatest_rate_of_points(tag));
}

/* ----------------------------------------------------------------------
   heat that has come in so far, and the power in the last step
------------------------------------------------------------------------- */

double FixMPMHeat::compute_scalar()
{
  double mine = 0.0, all;
  for (const double heat : came) mine += heat;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMHeat::compute_vector(int i)
{
  if (!power_known) {
    MPI_Allreduce(in_step.data(), power.data(), size_vector, MPI_DOUBLE, MPI_SUM, world);
    for (double &p : power) p /= dt_last;
    power_known = true;
  }
  return power[i];
}

/* ----------------------------------------------------------------------
   entries of compute mpm/energy. What points have got is a sum over points, apart from what nodes were given
------------------------------------------------------------------------- */

std::vector<MPMPhysics::Account> FixMPMHeat::accounts() const
{
  return {{"conducted heat", true},
          {"heat through faces", false},
          {"heat of sources", false},
          {"heat of friction", false}};
}

void FixMPMHeat::account(double *values) const
{
  values[0] += got;
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) values[1] += came[face];
  values[2] += came[MPMConduction::SOURCES];
  for (int k = 0; k < NGIVER; k++) values[3 + k] += came[NCAME + k];
}

/* ---------------------------------------------------------------------- */

void FixMPMHeat::write_restart(FILE *fp)
{
  keep_totals(world, came.data(), size_vector);
  keep_totals(world, &got, 1);
  if (comm->me) return;
  const int size = (size_vector + 1) * (int) sizeof(double);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(came.data(), sizeof(double), came.size(), fp);
  fwrite(&got, sizeof(double), 1, fp);
}

void FixMPMHeat::restart(char *buf)
{
  if (comm->me) return;
  const double *const values = (double *) buf;
  std::copy_n(values, came.size(), came.begin());
  got = values[came.size()];
}

double FixMPMHeat::memory_usage()
{
  double bytes = FixMPMState::memory_usage() + steps.memory_usage() +
      source_values.capacity() * sizeof(double);
  for (const auto &field : fields) bytes += field->memory_usage();
  return bytes;
}
