/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_plan.h"

#include "comm.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_every.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_halo.h"
#include "field/mpm_nodes.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_map.h"
#include "field/mpm_volume_drift.h"
#include "platform.h"

#include <algorithm>

using namespace LAMMPS_NS;

void MPMPlan::make(const std::function<void(MPMPlan &)> &scheme)
{
  fields = MPMField::all(lmp);
  actions = find_fixes<MPMNodeAction>(lmp);
  physics = find_fixes<MPMPhysics>(lmp);
  added_stresses = find_fixes<MPMAddedStress>(lmp);
  loads = find_fixes<MPMLoad>(lmp);
  pore_pressures = find_fixes<MPMPorePressure>(lmp);
  std::stable_sort(actions.begin(), actions.end(), [](auto *a, auto *b) {
    return a->turn() < b->turn();
  });
  std::stable_partition(physics.begin(), physics.end(), [](const auto *other) {
    return !other->needs_others();
  });

  for (auto *field : fields) field->choose_stress(physics);
  for (auto *field : fields) field->init(this);
  for (auto *action : actions) action->init_action();
  for (auto *other : physics) other->init_physics(*this);

  clear();
  scheme(*this);
}

void MPMPlan::each(const std::string &name, const Data &reads, const Data &writes, Each run,
                   Wanted wanted)
{
  std::vector<Part> parts;
  for (auto *field : fields)
    if (!wanted || wanted(*field))
      parts.push_back({fields.size() > 1 ? field->id() : "", [run, field] {
                         run(*field);
                       }});
  if (!parts.empty()) add(name, reads, writes, std::move(parts));
}

void MPMPlan::together(const std::string &name, const Data &reads, const Data &writes,
                       const std::function<void()> &run, Wanted wanted)
{
  const auto wants = [&wanted](const MPMField *field) {
    return !wanted || wanted(*field);
  };
  if (std::any_of(fields.begin(), fields.end(), wants)) add(name, reads, writes, run);
}

void MPMPlan::node_actions(MPMNodeAction::Stage stage, Wanted wanted)
{
  if (actions.empty()) return;
  const auto act = [this, stage]() {
    act_on_nodes(stage);
  };
  together("node actions",
           {Data::POSITION, Data::VELOCITY, Data::DEFORMATION, Data::STRESS, Data::MASS,
            Data::FORCE, Data::NODES, Data::BLOCKS, Data::OWN},
           {Data::FORCE, Data::NODES, Data::OWN}, act, std::move(wanted));
}

void MPMPlan::place(Place at)
{
  for (auto *other : physics) other->add_stages(*this, at);
}

void MPMPlan::act_on_nodes(MPMNodeAction::Stage stage)
{
  const double dt = fields[0]->step_dt();
  for (auto *action : actions) {
    action->act(dt, stage);
    for (auto *other : actions)
      if (other != action) other->has_acted(*action, stage);
  }
}

/** Each stage for all fields before the next one. */
void MPMPlan::step()
{
  bool waits = false;
  for (auto *field : fields)
    if (field->every) waits = field->every->wait() || waits;
  if (waits) return;
  for (auto *field : fields) field->ledger.begin_step();
  run();
}

/** Blocks of points first, then those that node actions need next to these. */
void MPMPlan::find_blocks()
{
  for (auto *field : fields)
    if (field->domains) field->domains->update();
  const auto valid = [this]() {
    return std::count_if(fields.begin(), fields.end(), [](const auto *field) {
      return field->map->valid;
    });
  };
  for (auto before = valid(), now = before - 1; now != before;) {    // chains of them
    before = valid();
    for (auto *action : actions) action->couple_topology();
    now = valid();
  }
  for (auto *field : fields) field->map->find_blocks();
  for (auto *action : actions) action->blocks_found();
  for (auto *field : fields) {
    if (field->map->valid) continue;
    for (auto *action : actions) action->extend_topology(*field);
    for (auto *other : physics) other->extend_topology(*field);
    field->map->finish_blocks();
    if (field->nodes.edges) field->nodes.edges->find(false);
    for (auto *action : actions) action->topology_changed(*field);
    for (auto *other : physics) other->topology_changed(*field);
  }
  for (auto *field : fields)
    if (field->boxes) field->boxes->update();
}

bool MPMPlan::physics_looks_beyond() const
{
  return std::any_of(physics.begin(), physics.end(), [](const auto *other) {
    return other->looks_beyond_points();
  });
}

bool MPMPlan::keeps_all_images() const
{
  return physics_looks_beyond() ||
      std::any_of(actions.begin(), actions.end(), [](const auto *action) {
           return action->looks_beyond_points();
         });
}

bool MPMPlan::looks_at_all(const MPMField &field, const MPM_NS::Grid::Block &block) const
{
  return physics_looks_beyond() ||
      std::any_of(actions.begin(), actions.end(), [&](const auto *action) {
           return action->looks_at_all(field, block);
         });
}

void MPMPlan::find_blocks_now()
{
  // corners of domains may have left what is in reach
  if (std::any_of(fields.begin(), fields.end(), [](auto *field) {
        return !field->map->valid || field->domains;
      }))
    find_blocks();
}

void MPMPlan::start()
{
  watch->start();
  clear_costs();
  wall_start = platform::walltime();
  cpu_start = platform::cputime();
  for (auto *field : fields) {
    field->start_counting();
    field->nodes.halo->bytes_sent = field->nodes.halo->messages_sent = 0;
    field->map->nbuild = field->map->nsort = 0;
    field->map->sort_time = 0.0;
    field->frame->start_counting();
    if (field->fracture_watch) field->fracture_watch->start();
  }

  const bool prints = std::any_of(fields.begin(), fields.end(), [](auto *field) {
    return field->options.plan;
  });
  if (prints && comm->me == 0) utils::logmesg(lmp, "MPM plan of a step:\n" + text());
}

/** A stage costs what it costs the slowest rank; stages of all fields count for the first one.
 *  Sorts come before the step. Without keyword plan, stages of the same name are one entry. */
std::vector<MPMPlan::Cost> MPMPlan::costs(const MPMField &field, double scale) const
{
  std::vector<Cost> list = {{"sort", field.map->sort_time}};
  for (const auto &stage : MPMStageList::list())
    for (const auto &part : stage.parts)
      if (part.owner == field.id() || (part.owner.empty() && &field == fields[0]))
        list.push_back({stage.name, part.seconds});
  for (auto &cost : list) {
    double slowest;
    MPI_Allreduce(&cost.time, &slowest, 1, MPI_DOUBLE, MPI_MAX, world);
    cost.time = scale * slowest;
  }
  if (field.options.plan) return list;
  std::vector<Cost> sums;
  for (const auto &cost : list) {
    const auto same = std::find_if(sums.begin(), sums.end(), [&](const Cost &c) {
      return c.stage == cost.stage;
    });
    if (same == sums.end())
      sums.push_back(cost);
    else
      same->time += cost.time;
  }
  std::stable_sort(sums.begin(), sums.end(), [](const Cost &a, const Cost &b) {
    return a.time > b.time;
  });
  return sums;
}

void MPMPlan::report(const MPMField &field, double bytes_per_point, const std::string &state) const
{
  constexpr double IDLE = 0.9;      // of the time is the processor's, or else others have taken it
  constexpr double SMALL = 0.05;    // share of a stage that is not worth a word
  const auto &counts = field.counts();
  const double wall = platform::walltime() - wall_start;
  double use = wall > 0.0 ? (platform::cputime() - cpu_start) / wall : 1.0, least_use;
  MPI_Allreduce(&use, &least_use, 1, MPI_DOUBLE, MPI_MIN, world);
  double local[5] = {counts.point_steps, (double) field.map->active.size(),
                     (double) field.grid.blocks.size(),
                     (double) field.nodes.halo->bytes_sent / counts.steps,
                     (double) field.nodes.halo->messages_sent / counts.steps},
         sum[5];
  MPI_Allreduce(local, sum, 5, MPI_DOUBLE, MPI_SUM, world);
  const double npoints = sum[0] / counts.steps;
  const std::vector<Cost> list = costs(field, 1.0e9 * comm->nprocs / sum[0]);
  if (comm->me) return;

  if (sum[0] == 0.0) {    // of a field that is there for contact, or has not got any yet
    utils::logmesg(lmp, "MPM {}: no points\n", field.id());
    if (&field == fields[0]) utils::logmesg(lmp, watch->report());
    return;
  }
  double total = 0.0;
  for (const auto &cost : list) total += cost.time;
  std::string text =
      fmt::format("MPM {}: {:.0f} points, {} kernels, {:.2f} ns per point-step and core\n",
                  field.id(), npoints, field.kernels->isa, total);
  if (field.options.plan) {
    text += "  plan of the step:\n";
    for (const auto &cost : list)
      text += fmt::format("    {:<40} {:8.2f}\n", cost.stage, cost.time);
  } else {
    text += "  most of it for";
    for (const auto &cost : list)
      if (cost.time > SMALL * total)
        text += fmt::format("{} {} {:.0f} %", &cost == &list[0] ? "" : ",", cost.stage,
                            100.0 * cost.time / total);
    text += "\n";
  }
  text += fmt::format("  {:.0f} bytes per point", bytes_per_point);
  if (field.options.plan)
    text += fmt::format(
        "; {:.0f} blocks with points of {:.0f} active, {:.1f} points per block\n  {} updates of "
        "the topology, {} sorts, {:.0f} halo bytes per step in {:.0f} messages",
        sum[1], sum[2], npoints / std::max(1.0, sum[1]), field.map->nbuild, field.map->nsort,
        sum[3], sum[4]);
  const auto least = fmt::format("{:.6g}", counts.dt_min),
             most = fmt::format("{:.6g}", counts.dt_max);
  text += fmt::format("\n  {} steps, time step {}{}\n", counts.steps,
                      least == most ? least : least + " to " + most, state);
  if (&field == fields[0]) text += watch->report();
  utils::logmesg(lmp, text);
  if (least_use < IDLE && &field == fields.back())
    utils::logmesg(lmp,
                   "  the machine was busy: these times are from a run with {:.0f} % CPU use\n",
                   100.0 * least_use);
  const auto &deleted = field.guard->deleted;
  if (deleted.points > 0.0)
    utils::logmesg(
        lmp, "  {:.0f} points deleted so far, mass {:.10g}, momentum {:.10g} {:.10g} {:.10g}\n",
        deleted.points, deleted.mass, deleted.momentum[0], deleted.momentum[1],
        deleted.momentum[2]);
  utils::logmesg(lmp, field.frame->report());
  utils::logmesg(lmp, field.drift->report());
  if (field.guard->nbad())
    utils::logmesg(lmp, "  {} bad point updates so far (policy {})\n", field.guard->nbad(),
                   field.options.bad == MPMFieldOptions::WARN ? "warn" : "delete");
}
