/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/fix_mpm_airbag.h"

#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "elements/fix_mpm_elements.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// of the gas, as much as sound could carry through vents, in one part of a time step; and most
// parts
static constexpr double PART = 0.003, MOST_PARTS = 1.0e5;

/** fix ID group mpm/airbag ELEMENTS keyword values ... */
Options MPMAirbagOptions::declare()
{
  using namespace option;
  Options o("fix mpm/airbag");
  o.argument(text(elements_id, "elements-ID"));
  o.add("pressure",
        {variables(&pressure, 1, "p", "pressure",
                   "excess over the pressure outside, can be a variable")})
      .then([this] {
        has_pressure = true;
      })
      .once()
      .standard("pressure of the gas");
  o.add("gas",
        {number(p, "p", POSITIVE, "pressure", "pressure of the gas when this fix is first used"),
         number(gamma, "gamma", AT_LEAST_ONE, "",
                "ratio of the specific heats of the gas; 1: constant temperature")})
      .then([this] {
        has_gas = true;
      })
      .once()
      .standard("none");
  o.add("outside", {number(outside, "p", NOT_NEGATIVE, "pressure", "pressure outside")}).once();
  o.add("temperature",
        {number(temperature, "T", POSITIVE, "temperature",
                "temperature of the gas when this fix is first used, and of the outside"),
         number(R, "R", POSITIVE, "energy/(mass temperature)", "specific gas constant")})
      .once()
      .standard("unknown: inflow and vent cannot be used");
  o.add("inflow",
        {variables(inflow, 2, "rate T", "mass/time, temperature",
                   "mass of gas that flows in per time, and its temperature, can be variables")})
      .then([this] {
        has_inflow = true;
      })
      .once()
      .standard("none");
  o.add("vent",
        {number(vent, "A", POSITIVE, "distance^2", "area of holes to the outside"),
         number(coefficient, "C", POSITIVE, "", "discharge coefficient of these holes")})
      .once()
      .standard("none");
  o.add("opens",
        {number(opens, "p", NOT_NEGATIVE, "pressure",
                "excess over the pressure outside at which the vents open for good")})
      .once();
  o.refuse([this] {
    return OptionRules{
        {has_pressure == has_gas, "", "needs either pressure or gas"},
        {has_pressure && (has_inflow || vent > 0.0 || temperature > 0.0 || outside > 0.0),
         "pressure",
         "is above that outside, and of no gas: outside, temperature, inflow, and vent are for "
         "gas"},
        {(has_inflow || vent > 0.0) && temperature == 0.0, "",
         "inflow and vent need the temperature and the constant of the gas: use temperature T R"},
        {opens > 0.0 && vent == 0.0, "opens", "needs vent"}};
  });
  return o;
}

FixMPMAirbag::FixMPMAirbag(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/airbag acts on the elements of a fix mpm/elements: use group all");
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);
  if (coefficient > 1.0 && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/airbag {}: a vent has the discharge coefficient {:.6g}, above 1: more "
                   "gas flows out than through a nozzle without losses",
                   id, coefficient);
  scalar_flag = vector_flag = 1;
  size_vector = 8;
  global_freq = 1;
  extscalar = extvector = 0;
  restart_global = 1;
  gas.gamma = gamma;
  gas.temperature = temperature > 0.0 ? temperature : 1.0;
  gas.R = (R > 0.0 ? R : 1.0) * force->nktv2p;
}

void FixMPMAirbag::init()
{
  elements = dynamic_cast<FixMPMElements *>(modify->get_fix_by_id(elements_id));
  if (!elements)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/airbag {}: there is no fix mpm/elements with ID {}; define it before", id,
               elements_id);
  int place = 0;
  for (const Fix *ifix : modify->get_fix_list()) {
    if (ifix == this) place++;
    if (ifix == elements && place)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/airbag {} must be defined after fix mpm/elements {}", id, elements_id);
  }
  elements->set_pressure(this, has_gas);
  find_variable(lmp, pressure, "fix mpm/airbag pressure");
  for (auto &v : inflow) find_variable(lmp, v, "fix mpm/airbag inflow");
}

/** Once in each step, before forces. */
double FixMPMAirbag::on_surface(double its_volume, double its_area, bool starting)
{
  volume = its_volume;
  area = its_area;
  if (has_pressure) {
    evaluate_in_step(lmp, !pressure.variable.empty(), [this]() {
      over = evaluate(lmp, pressure);
    });
    if (!std::isfinite(over))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/airbag {} is {} at step {}",
                 pressure.variable, id, over, update->ntimestep);
    return over;
  }
  if (!(volume > 0.0))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/airbag {}: the bag has the volume {:.6g} at step {}; it has turned inside "
               "out: use a smaller "
               "time step, or more gas",
               id, volume, update->ntimestep);
  if (!filled) {
    filled = true;
    gas.volume = volume;
    gas.mass = p * volume / (gas.R * gas.temperature);
  }
  gas.expand(volume);
  if (!starting) flow(update->dt);
  over = gas.pressure() - outside;
  return over;
}

/** Of the gas; without heat, or at constant temperature with gamma 1. */
double FixMPMAirbag::stiffness(double its_volume) const
{
  if (has_pressure || !(its_volume > 0.0)) return 0.0;
  BagGas there = gas;
  if (filled) there.expand(its_volume);
  return gamma * (filled ? there.pressure() : p) / its_volume;
}

/** Gas that comes in and goes out in a step, by the midpoint rule in one or more parts of it. */
void FixMPMAirbag::flow(double dt)
{
  if (!has_inflow && vent == 0.0) return;
  double rate[2] = {0.0, 0.0};
  evaluate_in_step(lmp, !inflow[0].variable.empty() || !inflow[1].variable.empty(), [&]() {
    for (int k = 0; k < 2; k++) rate[k] = evaluate(lmp, inflow[k]);
  });
  if (has_inflow && !(rate[0] >= 0.0 && rate[1] > 0.0))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/airbag {}: inflow must have a rate that is not negative, and a temperature "
               "above zero: {} and {} at step {}",
               id, rate[0], rate[1], update->ntimestep);
  open = open || opens == 0.0 || gas.pressure() - outside >= opens;

  const double to_mass = coefficient * vent * force->ftm2v / force->nktv2p,
               to_square = 1.0 / (force->nktv2p * force->mvv2e);
  const auto through_vent = [&](const BagGas &g) {    // out, per time
    if (!open || vent == 0.0) return 0.0;
    const double now = g.pressure();
    if (now >= outside)
      return to_mass * BagGas::flow(now, outside, g.R * g.temperature * to_square, g.gamma);
    return -to_mass * BagGas::flow(outside, now, g.R * temperature * to_square, g.gamma);
  };
  const auto advance = [&](BagGas g, const BagGas &at, double time) {
    const double goes = through_vent(at) * time;
    if (!(goes < g.mass))
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/airbag {}: all of the gas would leave the bag in step {}: use a smaller time "
          "step or smaller vents",
          id, update->ntimestep);
    g.add(-goes, goes > 0.0 ? at.temperature : temperature);
    if (has_inflow) g.add(rate[0] * time, rate[1]);
    return g;
  };
  // the flow goes like the root of the difference of pressures: a step in which it could pass a
  // large part of the gas would go far past the pressure outside, and back in the next one
  const double passes = coefficient * vent * dt / gas.volume *
      std::sqrt(gas.gamma * gas.R * std::max({gas.temperature, temperature, rate[1]}) * to_square);
  const int parts = open ? (int) std::clamp(std::ceil(passes / PART), 1.0, MOST_PARTS) : 1;
  const double time = dt / parts;
  for (int k = 0; k < parts; k++) {
    const BagGas middle = advance(gas, gas, 0.5 * time);
    const double goes = through_vent(middle) * time;
    gas = advance(gas, middle, time);
    (goes > 0.0 ? out : in) += std::fabs(goes);
    in += rate[0] * time;
  }
}

/** Pressure, volume, area, mass, temperature, mass that has come and gone, energy. */
double FixMPMAirbag::compute_vector(int k)
{
  const bool known = has_gas && temperature > 0.0;
  const double list[] = {over + outside,
                         volume,
                         area,
                         known ? gas.mass : 0.0,
                         known ? gas.temperature : 0.0,
                         in,
                         out,
                         has_gas && filled ? gas.energy() / force->nktv2p : 0.0};
  return list[k];
}

void FixMPMAirbag::write_restart(FILE *fp)
{
  if (comm->me) return;
  const double list[] = {
      filled ? 1.0 : 0.0, open ? 1.0 : 0.0, gas.mass, gas.volume, gas.temperature, in, out};
  write_state(fp, list, sizeof(list));
}

void FixMPMAirbag::restart(char *buf)
{
  double list[7];
  memcpy(list, read_state(lmp, id, buf, sizeof(list)), sizeof(list));
  filled = list[0] != 0.0;
  open = list[1] != 0.0;
  gas.mass = list[2];
  gas.volume = list[3];
  gas.temperature = list[4];
  in = list[5];
  out = list[6];
}
