/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_momentum.h"

#include "atom.h"
#include "base/mpm_gravity.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "math_extra.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// residuals that are as small as this share of speed/spacing are rounding
static constexpr double ROUNDING = 1.0e-14;
// longest explicit step with several viscosities, over that of fraction 1: drops of a few points in
// a fluid that is a thousand times lighter were stable at 1.8 and unstable at 1.9, where one liquid
// is stable up to 2
static constexpr double MOST_OF_SEVERAL = 1.5;
// filled shares of cells: with the first, the surface is in the side of a cell, and dual cells of
// its faces are below the surface as a whole; from the second down, only the part counts that is
static constexpr double ALL_BELOW = 0.875, PART_BELOW = 0.82;
// share of the inflow that may have no room, because of the tolerance of the pressure
static constexpr double NOT_IN = 0.05;

MPMFlowMomentum::MPMFlowMomentum(LAMMPS *lmp, const MPMIncompressibleOptions &options,
                                 const MPMFlowLiquids &liquids, MPMFlowParts &parts,
                                 MPMFlowFields &fields, MPMFlowResults &results,
                                 const std::string &who) :
    Pointers(lmp),
    options(options), liquids(liquids), parts(parts), fields(fields), results(results), who(who)
{
}

/** dt p/density of free surfaces by their tension and by gas; null: they have none. */
const std::vector<double> *MPMFlowMomentum::surface_psi() const
{
  if (parts.gas) return &parts.gas_rows->at_surface();
  return parts.tension ? &at_surface : nullptr;
}

/* ----------------------------------------------------------------------
   Velocities at the end of a duration, from those that are predicted, and the pressure.

   Where implicit viscosity does not converge, the duration is halved, because its equations contain
   dt nu/h^2. The rest is done in parts of this length, each from the velocities at the end of the
   part before. Points and the lattice stay as they are until the last part is done, and then move
   with its velocities. All other equations are independent of the duration: if these do not
   converge, parts would not help. Potentials add up to those of the mean pressure.
------------------------------------------------------------------------- */

void MPMFlowMomentum::solve(double duration)
{
  double done = 0.0, part = 1.0;    // sums of powers of 1/2, which are exact
  results.parts = 0.0;
  while (done < 1.0) {
    if (parts.stress) start_of_part = fields.predicted;
    const auto report = solve_part(part * duration);
    if (!report.converged()) {
      part *= 0.5;
      if (report.outcome == SolveReport::NOT_FINITE || part * options.most_parts < 1.0)
        error->all(FLERR, Error::NOLASTLINE,
                   "{}: the implicit viscosity {} at step {}{}; allow more iterations, a "
                   "larger tolerance, or take smaller time steps",
                   who, report.describe(), update->ntimestep,
                   part < 0.5 ? fmt::format(", in parts of 1/{} of it, too", (int) (0.5 / part))
                              : "");
      results.halvings++;
      fields.predicted = start_of_part;
      continue;
    }
    if (part < 1.0) {
      if (done == 0.0) psi_of_parts.assign(parts.pressure->psi.size(), 0.0);
      for (std::size_t k = 0; k < psi_of_parts.size(); k++)
        psi_of_parts[k] += parts.pressure->psi[k];
      fields.predicted = fields.velocity;
    }
    done += part;
    results.parts++;
  }
  if (part == 1.0) return;
  parts.pressure->psi = psi_of_parts;
  if (parts.tension) find_tension(duration);
}

void MPMFlowMomentum::strike()
{
  fields.shift.assign(fields.predicted.size(), 0.0);
  by_solids.assign(parts.solids ? fields.predicted.size() : 0, 0.0);
  hold();
  results.iterations = project(0.0, rounding()).iterations;
  if (parts.bodies) parts.bodies->strike();
  if (parts.inflow) fields.predicted.swap(without_hold);
  extend_into_air();
  if (parts.inflow) parts.inflow->hold(fields.velocity, nullptr);
}

/** The same for a duration in one part. Returns the outcome of the implicit viscosity; if it has
 *  not converged, the velocities are of no use. */
SolveReport MPMFlowMomentum::solve_part(double duration)
{
  if (parts.grains) before_forces = fields.predicted;
  if (parts.viscosity) add_viscosity(duration);
  add_forces(duration * force->ftm2v);
  hold_and_resist(duration);

  const double rounding = this->rounding();
  const auto report = project(duration, rounding);
  SolveReport viscous;
  if (parts.stress) {
    viscous = find_stress(duration, rounding);
    if (!viscous.converged()) return viscous;
  }
  // next to inlets, held velocities do not fall, either
  if (parts.inflow) fields.predicted.swap(without_hold);
  extend_into_air();
  if (parts.inflow) {
    parts.inflow->hold(fields.velocity, nullptr);
    check_inflow();
  }
  results.iterations = std::max(results.iterations, (double) report.iterations);
  results.residual = report.right_side > 0.0 ? report.residuals.back() / report.right_side : 0.0;
  results.divergence = parts.pressure->largest_divergence(fields.velocity.data());
  return viscous;
}

/** Resistance of grains to the flow, and the velocities in inlets, with the mobility of faces for
 *  both. */
void MPMFlowMomentum::hold_and_resist(double duration)
{
  if (parts.grains) {
    parts.grains->begin(duration, fields.sums, fields.filled, before_forces, fields.predicted);
    mobility = parts.grains->mobility();
  }
  hold();
}

/** Velocities in inlets. */
void MPMFlowMomentum::hold()
{
  if (parts.inflow) {
    if (!parts.grains) mobility.assign(fields.predicted.size(), 1.0);
    without_hold = fields.predicted;
    parts.inflow->hold(fields.predicted, &mobility);
  }
  if (parts.grains || parts.inflow) parts.pressure->set_mobility(&mobility);
}

/** Magnitude of velocities that is rounding. */
double MPMFlowMomentum::rounding() const
{
  double mine = 0.0, most;
  for (const double v : fields.predicted) mine = std::max(mine, std::fabs(v));
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, world);
  return ROUNDING * most * std::sqrt((double) atom->natoms);
}

/** Velocities of faces without divergence, from those that are predicted, with tension, gas, and
 *  bodies. */
SolveReport MPMFlowMomentum::project(double duration, double rounding)
{
  fields.velocity.assign(fields.predicted.size(), 0.0);
  fields.known.assign(fields.predicted.size(), 0.0);
  if (parts.tension) {
    check_tension();
    find_tension(duration);
  }
  if (parts.gas)
    parts.gas_rows->begin(duration, duration * liquids.acceleration_per_stress(),
                          parts.tension ? &at_surface : nullptr);
  if (parts.bodies) {
    double g[3];
    MPMGravity{lmp}.find(g);
    MathExtra::scale3(force->ftm2v, g);
    parts.bodies->begin(duration, g, *parts.pressure);
  }
  const auto report =
      parts.pressure->project(fields.predicted.data(), fields.velocity.data(), fields.known.data(),
                              {options.tolerance, rounding / options.h, options.most_iterations},
                              surface_psi(), parts.gas_rows.get());
  if (!report.converged())
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the pressure {} at step {}; allow more iterations, or a larger tolerance: "
               "its equations are those of any time step",
               who, report.describe(), update->ntimestep);
  if (parts.bodies) parts.bodies->end(parts.pressure->psi.data());
  return report;
}

void MPMFlowMomentum::check_tension() const
{
  const double most =
      MPMFlowTension::stable_dt(options.tension * liquids.acceleration_per_stress(), options.h);
  if (update->dt > most * (1.0 + 1.0e-9))
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the time step {:.6g} is too large for the surface tension, which "
               "allows {:.6g}; reduce it, or let fix mpm/dt set it",
               who, update->dt, most);
}

/** dt p/density of surfaces by their tension. */
void MPMFlowMomentum::find_tension(double duration)
{
  parts.tension->find(fields.filled, duration * liquids.acceleration_per_stress() * options.tension,
                      at_surface);
}

/* ----------------------------------------------------------------------
   Viscous stresses, with what they add to the pressure, at the end of a step without them. The
   effect of the place of a surface is left to the pressure alone, so that a fluid at rest stays at
   rest.
------------------------------------------------------------------------- */

SolveReport MPMFlowMomentum::find_stress(double dt, double rounding)
{
  potentials = parts.pressure->psi;
  const auto report = parts.stress->step(
      dt * liquids.largest_viscosity * liquids.acceleration_per_stress() / (options.h * options.h),
      fields.velocity, potentials, {options.tolerance, rounding, options.most_iterations});
  if (!report.converged()) return report;
  results.viscous_iterations = report.iterations;
  viscous_velocity.swap(fields.velocity);
  fields.velocity.assign(viscous_velocity.size(), 0.0);
  const auto again =
      parts.pressure->project(viscous_velocity.data(), fields.velocity.data(), fields.known.data(),
                              {options.tolerance, rounding / options.h, options.most_iterations});
  if (!again.converged())
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the pressure after implicit viscosity {} at step {}; allow more "
               "iterations, or a larger tolerance: its equations are those of any time step",
               who, again.describe(), update->ntimestep);
  for (std::size_t k = 0; k < potentials.size(); k++) parts.pressure->psi[k] += potentials[k];
  return report;
}

/** Adds what forces change; walls take their share. */
void MPMFlowMomentum::add_forces(double dt)
{
  const int dim = parts.cells.lattice.dim, width = 3 * dim + 1;
  for (int64_t k = 0; k < parts.cells.size(); k++) {
    const double *const from = fields.sums.data() + k * width;
    for (int c = 0; c < dim; c++)
      if (from[dim + c] > 0.0)
        fields.predicted[k * dim + c] += dt * from[2 * dim + c] / from[dim + c];
  }
  if (parts.solids) add_stress(dt);
  parts.cells.reflect_velocities(fields.predicted.data());
}

/* ----------------------------------------------------------------------
   Stresses accelerate the volume that the pressure accelerates, so that the pressure can take a
   part of them: the dual cell of a face, or the part of it that is below the surface. The splines
   that give momentum to faces reach farther.
------------------------------------------------------------------------- */

void MPMFlowMomentum::add_stress(double dt)
{
  const int dim = parts.cells.lattice.dim;
  const double cell_volume = parts.cells.lattice.cell_volume();
  by_solids.assign(fields.predicted.size(), 0.0);
  for (const auto &cell : parts.cells.cells)
    for (int c = 0; c < dim; c++) {
      const int64_t k = cell.number, lower = cell.near[2 * c], face = k * dim + c;
      if (fields.solid_forces[face] == 0.0 || cell.walls >> 2 * c & 1) continue;
      double open = 1.0;
      if (parts.regions)
        open = 0.5 * (parts.regions->volume_fraction(k) + parts.regions->volume_fraction(lower));
      const double filled = std::min(fields.filled[k], fields.filled[lower]),
                   near = std::clamp((ALL_BELOW - filled) / (ALL_BELOW - PART_BELOW), 0.0, 1.0);
      const double volume =
          near * parts.solids->volume_around(k, c) + (1.0 - near) * open * cell_volume;
      double density = options.density;
      if (liquids.has_several_densities) density /= fields.inverse_density[face];
      if (volume > 0.0) by_solids[face] = dt * fields.solid_forces[face] / (density * volume);
    }
  parts.cells.publish(by_solids.data(), dim);
  for (std::size_t k = 0; k < by_solids.size(); k++) fields.predicted[k] += by_solids[k];
}

void MPMFlowMomentum::add_viscosity(double dt)
{
  const int dim = parts.cells.lattice.dim;
  const double nu = liquids.largest_viscosity * liquids.acceleration_per_stress(),
               most = (parts.viscosities ? MOST_OF_SEVERAL : 2.0) *
      MPMFlowViscosity::stable_dt(liquids.largest_kinematic_viscosity(), options.h, dim);
  if (update->dt > most * (1.0 + 1.0e-9))
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the time step {:.6g} is too large for the viscosity, which allows "
               "{:.6g}; reduce it, or let fix mpm/dt set it",
               who, update->dt, most);
  fields.shift.assign(fields.predicted.size(), 0.0);
  parts.viscosity->add(dt * nu, fields.predicted, fields.shift);
  parts.cells.publish(fields.shift.data(), dim);
  for (std::size_t k = 0; k < fields.shift.size() && liquids.has_several_densities; k++)
    fields.shift[k] *= fields.inverse_density[k];
  for (std::size_t k = 0; k < fields.predicted.size(); k++) fields.predicted[k] += fields.shift[k];
  parts.cells.reflect_velocities(fields.predicted.data());
}

/* ----------------------------------------------------------------------
   Forces on walls, and pressures for points, such that these interpolate zero at the surface and
   the pressure of walls at walls.
------------------------------------------------------------------------- */

void MPMFlowMomentum::find_pressures(double pressure_to_psi)
{
  for (int d = 0; d < parts.cells.lattice.dim; d++)
    for (int s = 0; s < 2; s++) {
      results.walls[d][s] = parts.pressure->at_wall(d, s) / (pressure_to_psi * force->nktv2p);
      if (parts.gas && comm->me == 0)
        results.walls[d][s] += parts.gas_rows->at_wall(d, s) / (pressure_to_psi * force->nktv2p);
      if (parts.grains)
        results.walls[d][s] +=
            parts.grains->at_wall(d, s, before_forces, fields.velocity) / force->ftm2v;
    }
  if (parts.regions) find_forces_on_regions(pressure_to_psi);
  parts.pressure->extend_into_air(fields.pressures, surface_psi(), parts.gas_rows.get());
  for (double &p : fields.pressures) p /= pressure_to_psi;
  parts.cells.extrapolate_cells(fields.pressures.data(), [this](int64_t number) {
    return parts.pressure->is_wet(number);
  });
}

void MPMFlowMomentum::find_forces_on_regions(double pressure_to_psi)
{
  std::fill(results.regions.begin(), results.regions.end(), 0.0);
  const double duration = pressure_to_psi / liquids.acceleration_per_stress();
  const int dim = parts.cells.lattice.dim, width = 3 * dim + 1;
  parts.regions->add_forces(
      parts.pressure->psi.data(),
      [this](int64_t number) {
        return parts.pressure->is_wet(number);
      },
      // change by forces, at the faces of the cell
      [&](const MPMFlowLattice::Cell &cell, double *push) {
        for (int c = 0; c < dim; c++) {
          double force_of_points = 0.0, mass = 0.0;
          for (const int64_t k : {(int64_t) cell.number, (int64_t) cell.near[2 * c + 1]}) {
            force_of_points += fields.sums[k * width + 2 * dim + c];
            mass += fields.sums[k * width + dim + c];
          }
          push[c] = mass > 0.0 ? duration * force->ftm2v * force_of_points / mass : 0.0;
        }
        return parts.pressure->density_in(cell);
      },
      1.0 / (1.0 + options.reflect), results.regions.data());
  if (parts.gas && parts.regions->n() == 1) parts.gas_rows->add_to_region(results.regions.data());
  for (double &f : results.regions) f /= pressure_to_psi * force->nktv2p;
}

/* ----------------------------------------------------------------------
   Faces in the air to which points give momentum keep it, together with what the pressure changes
   at the water next to them. Points that are about to fall into the water, or fly off, do not get
   its velocity before, and a drop that spins goes on spinning.
------------------------------------------------------------------------- */

void MPMFlowMomentum::extend_into_air()
{
  const int dim = parts.cells.lattice.dim, width = 3 * dim + 1;
  // changes by viscosity go on into the air, too: otherwise the layer of points at a surface would
  // fall freely
  if (parts.viscosity)
    for (std::size_t k = 0; k < fields.predicted.size(); k++)
      fields.predicted[k] -= fields.shift[k];
  for (std::size_t k = 0; k < fields.velocity.size(); k++)
    if (fields.known[k] > 0.0) fields.velocity[k] -= fields.predicted[k];
  if (parts.solids) extend_stress();
  parts.air->extend(fields.velocity, fields.known);
  for (const auto &cell : parts.cells.cells)
    for (int c = 0; c < dim; c++) {
      const int64_t face = (int64_t) cell.number * dim + c;
      const bool solved = parts.pressure->is_next_to_water(cell, c);
      if (solved ||
          (parts.pressure->aperture(cell.number, c) > 0.0 &&
           fields.sums[(int64_t) cell.number * width + dim + c] > 0.0)) {
        fields.velocity[face] += fields.predicted[face];
        fields.known[face] = 1.0;
      } else
        fields.velocity[face] = fields.known[face] = 0.0;
    }
  parts.cells.keep_owned(fields.velocity.data(), dim);
  parts.cells.keep_owned(fields.known.data(), dim);
  parts.air->extend(fields.velocity, fields.known);
  if (parts.stick)
    parts.stick->hold(fields.velocity);
  else if (parts.regions)
    parts.regions->hold(fields.velocity);
  parts.cells.reflect_velocities(fields.velocity.data());
}

/** Changes by the stress of solids go on into the air, too, as the pressure balances a part of
 *  them: faces that solids do not reach get those of their neighbors. */
void MPMFlowMomentum::extend_stress()
{
  const int dim = parts.cells.lattice.dim;
  auto change = by_solids, known = fields.known;
  for (std::size_t k = 0; k < known.size(); k++) change[k] *= known[k];
  parts.air->extend(change, known);
  for (int64_t k = 0; k < parts.cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      const int64_t face = k * dim + c;
      if (known[face] > 0.0)
        fields.predicted[face] +=
            (1.0 - parts.solids->support_of(k, c)) * (change[face] - by_solids[face]);
    }
}

/** Checks that what comes in has a way out, or a surface that rises: otherwise the pressure has no
 *  solution, and the one found is that of less inflow. */
void MPMFlowMomentum::check_inflow() const
{
  double mine[2] = {0.0, 0.0}, all[2];
  parts.pressure->add_balance(fields.velocity.data(), mine, mine + 1);
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  if (all[1] > 0.0 && std::fabs(all[0]) > NOT_IN * all[1])
    error->all(FLERR, Error::NOLASTLINE,
               "{}: at step {} there is no room for what fix mpm/emit brings: leave a free "
               "surface, or let fix mpm/absorb take as much away",
               who, update->ntimestep);
}
