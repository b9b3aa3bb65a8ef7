/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_watch.h"

#include "atom.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "contact/mpm_leaks.h"
#include "contact/pair_mpm_penalty.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "pore/mpm_pore_flow.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// factor within which times are equal on paper, as sums of ranks differ by round-off
static constexpr double NEARLY = 1.0 + 1.0e-6;

MPMPoreWatch::MPMPoreWatch(LAMMPS *lmp, const MPMPoreOptions &options, const MPMPorePoints &points,
                           const MPMPoreFlow &flow, const std::string &id) :
    Pointers(lmp),
    options(options), points(points), flow(flow), id(id)
{
}

void MPMPoreWatch::start(bool neglects_inertia)
{
  watched.points = -1;    // velocities may have been set since the last run
  watched.flows = 0;
  measures_inertia = neglects_inertia && !inertia_known;
}

/** Warns of materials without water that are thinner than the reach of nodes, at the first step,
 *  once. */
void MPMPoreWatch::look_for_leaks()
{
  if (leaks_known) return;
  leaks_known = true;
  for (auto *mine : flow.wet) {
    const auto &all = mine->field.materials;
    if (std::all_of(all.begin(), all.end(), [&](const auto *material) {
          return options.has(material->id);
        }))
      continue;
    const auto leaks = find_leaks(mine->field, world, [&](const FixMPMMaterial *material) {
      return options.has(material->id);
    });
    if (leaks.nodes && comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/pore: material without water is so thin that water leaks through it, at {} "
          "nodes "
          "of fix mpm {}, one of them at {:.6g} {:.6g} {:.6g}: let it have three node spacings",
          leaks.nodes, mine->field.id(), leaks.first[0], leaks.first[1], leaks.first[2]);
  }
}

/** Warns once of pores that are shut, where the equations hold neither for the soil nor for its
 *  water. */
void MPMPoreWatch::look_for_shut_pores()
{
  if (shut_known) return;
  tagint mine = MAXTAGINT, lowest;
  for (const auto *field : flow.wet) mine = std::min(mine, field->shut_point());
  MPI_Allreduce(&mine, &lowest, 1, MPI_LMP_TAGINT, MPI_MIN, world);
  if (lowest == MAXTAGINT) return;
  shut_known = true;
  double here[2] = {0.0, 0.0}, worst[2];
  for (int i = 0; mine == lowest && i < atom->nlocal; i++)
    if (atom->tag[i] == lowest) {
      here[0] = MPMPoints::get(atom)->jacobian(i);
      here[1] = flow.soil_of(i)->shut();
    }
  MPI_Allreduce(here, worst, 2, MPI_DOUBLE, MPI_MAX, world);
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/pore: the pores of point {} are shut: it has {:.4g} of its initial volume, while "
        "the "
        "grains alone have {:.4g}, 1 - n0: use a law that becomes stiff before pores close, or "
        "check n0, the stiffness of the soil, and its load",
        lowest, worst[0], worst[1]);
}

/** Warns once of flow through a surface that is not a face of the box, in a lump that one stage
 *  cannot take. */
void MPMPoreWatch::look_for_long_flow(double duration, double limit, double steps)
{
  if (long_known || options.every == MPMPoreOptions::AUTO || steps == 0.0 ||
      duration <= limit * NEARLY ||
      options.conditions[MPMPoreSurface::FREE].kind == MPMPoreCondition::CLOSED)
    return;
  long_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/pore every {}: {} steps have one flow, for {:.3g} times its explicit "
                   "limit: curved surfaces of soft soil drain too fast then, by 1 to 2 % of the "
                   "pressure: use every auto",
                   options.every, steps + 1.0, duration / limit);
}

/** Warns once of pressures that vary over some cells and that points have lost to nodes in long
 *  runs, where the flow itself is too slow for that. */
void MPMPoreWatch::look_for_smoothing(double duration)
{
  constexpr double MUCH = 0.02, OF_FLOW = 0.2;
  if (smooth_known) return;
  MPMPore::Smoothing most = {0.0, 0.0};
  for (const auto *mine : flow.wet) {
    const auto here = mine->smoothing(duration);
    if (here.share * here.over_flow > most.share * most.over_flow) most = here;
  }
  smoothed += most.share;
  if (smoothed < MUCH || most.over_flow < OF_FLOW) return;
  smooth_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/pore {}: pressures that vary over {} node spacings have lost {:.0f} % "
                   "to {}, {:.2g} times what flow has taken, and become too even in a long run: "
                   "use {}, a smaller spacing, or fix mpm/implicit",
                   id, MPMPore::Smoothing::WAVELENGTH, 100.0 * smoothed,
                   options.waits() ? "every" : "relax", most.over_flow,
                   options.waits() ? "every 1 and a small relax" : "a smaller relax");
}

/** Measures the neglected acceleration between every fourth flow, see MPMPore::inertia(): relevant
 *  motion is slower than waves of the lattice. */
void MPMPoreWatch::watch_inertia()
{
  constexpr int EACH = 4;
  if (!measures_inertia || watched.flows++ % EACH) return;
  MPMPore::Inertia mine, all;
  for (const auto *field : flow.wet) mine.add(field->inertia(points.pressure));
  const double here[4] = {mine.velocity, mine.flow, mine.gradient, mine.kinetic};
  double sum[4];
  MPI_Allreduce(here, sum, 4, MPI_DOUBLE, MPI_SUM, world);
  all = {sum[0], sum[1], sum[2], sum[3]};
  const double now = update->atime + (update->ntimestep - update->atimestep) * update->dt,
               passed = now - watched.time;
  if (watched.points == atom->natoms && passed > 0.0) {
    const double rate = (sqrt(all.velocity) - sqrt(watched.last.velocity)) / passed;
    watched.left_out += rate * rate * passed;
    watched.flow += 0.5 * (all.flow + watched.last.flow) * passed;
    watched.gradient += 0.5 * (all.gradient + watched.last.gradient) * passed;
    watched.exchanged += fabs(all.kinetic - watched.last.kinetic);
  }
  watched.most = std::max(watched.most, all.kinetic);
  watched.last = all;
  watched.time = now;
  watched.points = atom->natoms;
}

/* ----------------------------------------------------------------------
   does the acceleration matter that u-p neglects? It does if its part in the energy that the flow
   has dissipated is not small, and not small relative to the energy of the motion. Waves of a load
   that comes at once satisfy the latter, too, but slow flow then dissipates far more in the end.
   Ground that nearly rests has small accelerations relative to that of its weight, and runs that
   end before the motion has come to rest for the first time do not allow a judgment yet. Warns once
------------------------------------------------------------------------- */

void MPMPoreWatch::look_at_inertia()
{
  constexpr double OF_FLOW = 0.03, OF_MOTION = 0.02, OF_WEIGHT = 1.0e-4, UP_AND_DOWN = 1.5,
                   FALLEN = 0.5;
  const double part = watched.left_out;
  const bool has_swung = watched.exchanged > UP_AND_DOWN * watched.most ||
      watched.last.kinetic < FALLEN * watched.most;
  if (inertia_known || !has_swung || !(part > OF_FLOW * watched.flow) ||
      !(part > OF_MOTION * watched.exchanged) || !(part > OF_WEIGHT * watched.gradient))
    return;
  inertia_known = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/pore {}: formulation u-p leaves out the acceleration of the water, which in these "
        "runs is {:.0f} % of what drives its flow, in the root of the mean square: waves fade too "
        "fast, and fast flow is wrong: use formulation u-v-p",
        id, std::min(999.0, 100.0 * sqrt(part / watched.flow)));
}

/** Warns of pair styles between points, which do not know the share of the water in a contact. */
void MPMPoreWatch::warn_of_contact() const
{
  if (comm->me || flow.wet.empty()) return;
  for (const auto &style : MPMPairStyle::all(*force)) {
    const auto *const penalty = dynamic_cast<const PairMPMPenalty *>(style.pair);
    if (penalty ? penalty->has_friction() : style.name.compare(0, 4, "gran") == 0)
      error->warning(
          FLERR,
          "Pair style {}: any friction on soils of fix mpm/pore {} is that of the total stress, "
          "with "
          "the pressure of the water: use fix mpm/contact, fix mpm/boundary with a region, or fix "
          "mpm/rigid, which know what water bears",
          style.name, id);
  }
}
