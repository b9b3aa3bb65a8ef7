/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// The four schemes: each is one list of stages, in the order of the book (V.P. Nguyen, A. de
// Vaucorbeil, S. Bordas, The Material Point Method, Springer 2023, chapter 2). Stages that no field
// needs are not in the list of a run.

#include "field/mpm_affine.h"
#include "field/mpm_every.h"
#include "field/mpm_field.h"
#include "field/mpm_locking.h"
#include "field/mpm_plan.h"
#include "field/mpm_smoothing.h"
#include "field/mpm_transfer_heat.h"
#include "field/mpm_volume_drift.h"
#include "step/mpm_stages.h"

using namespace LAMMPS_NS;
using namespace MPMStages;

namespace {

using Field = const MPMField &;
using Options = MPMFieldOptions;

// what stages read and write
using Data = MPMStageData;
const Data MOTION = {Data::POSITION, Data::VELOCITY, Data::AFFINE};
const Data STATE = {Data::DEFORMATION, Data::STRESS, Data::HISTORY};
const Data STATE_IN_BLOCKS = Data{Data::POSITION} + STATE + Data{Data::BLOCKS};
const Data AT_NODES = {Data::NODES, Data::BLOCKS};
const Data NODES_AND_OWN = {Data::NODES, Data::OWN};

/** An option of the field as the condition of a stage. */
template <bool (MPMFieldOptions::*OPTION)() const> bool with(Field field)
{
  return (field.options.*OPTION)();
}
bool has_ledger(Field field)
{
  return field.ledger.on;
}
bool takes_long_steps(Field field)
{
  return field.options.every > 1;
}
bool takes_torques(Field field)
{
  return field.affine && field.affine->takes_torques();
}

/** Positions that have waited for this. */
void late_motion(MPMPlan &plan, MPMPlan::Wanted wanted = nullptr)
{
  plan.each("motion of points", {Data::BLOCKS, Data::OWN}, {Data::POSITION, Data::OWN}, move_points,
            std::move(wanted));
}

void points_to_nodes(MPMPlan &plan, const char *name, Content content)
{
  const Data forces = {Data::DEFORMATION, Data::STRESS, Data::MASS, Data::FORCE, Data::BLOCKS};
  const Data reads = content == MOMENTUM ? MOTION + Data{Data::MASS, Data::BLOCKS}
      : content == FORCE
      ? Data{Data::POSITION, Data::DEFORMATION, Data::STRESS, Data::FORCE} + AT_NODES
      : MOTION + forces;
  plan.each(name, reads, {Data::NODES}, [content](MPMField &field) {
    MPMStages::points_to_nodes(field, content);
  });
  plan.place(MPMPlan::AFTER_POINTS_TO_NODES);
  plan.each("sum over ranks", AT_NODES, {Data::NODES}, [content](MPMField &field) {
    sum_nodes(field, content);
  });
}

void nodes_to_points(MPMPlan &plan, const char *name, Strain strain, MPMPlan::Wanted wanted)
{
  const auto move = [strain](MPMField &field) {
    MPMStages::nodes_to_points(field, strain);
  };
  const bool strains = strain == GRADIENTS || strain == STRESS;
  const Data changed = strains ? MOTION + STATE : MOTION;
  plan.each(name, changed + AT_NODES, changed + NODES_AND_OWN, move, std::move(wanted));
}

/** Strain of the motion of this step, and the motion. */
void gradients_with_material(MPMPlan &plan, double share, double shift)
{
  const auto strain = [=](MPMField &field) {
    strain_from_nodes(field, field.step_dt(), share, shift, true);
  };
  plan.each("gradients with material", MOTION + STATE + AT_NODES, STATE + NODES_AND_OWN, strain);
}

/** Strain of the motion of the step before: that has brought the points to where they are. Where
 *  the time step changes, the deformation gradient would not be that of the motion with another
 *  duration. */
void gradients_of_last_motion(MPMPlan &plan, double share, double shift)
{
  const auto strain = [=](MPMField &field) {
    strain_from_nodes(field, field.step_dt_before(), share, shift);
  };
  plan.each("gradients with material", MOTION + STATE + AT_NODES, STATE + NODES_AND_OWN, strain);
}

void average_pressure(MPMPlan &plan)
{
  const auto average = [](MPMField &field) {
    field.locking->average_pressure();
  };
  plan.each("averaged pressure", STATE_IN_BLOCKS, {Data::OWN}, average,
            with<&Options::averages_stress>);
}

/** What all schemes begin with. */
void begin(MPMPlan &plan)
{
  const auto watch = [&plan]() {
    plan.watch->step();
  };
  plan.together("energy watch", MOTION + STATE + Data{Data::FORCE}, {Data::OWN}, watch,
                with<&Options::watches_gain>);
  const Data found = AT_NODES + Data{Data::OWN};
  plan.together("topology", {Data::POSITION, Data::DEFORMATION}, found, [&plan]() {
    plan.find_blocks();
  });
  const auto drift = [](MPMField &field) {
    field.drift->step();
  };
  plan.each("volume drift", MOTION + STATE + Data{Data::BLOCKS}, STATE + Data{Data::OWN}, drift);
  plan.place(MPMPlan::BEFORE_POINTS_TO_NODES);
  const auto add_torques = [](MPMField &field) {
    field.affine->add_torques();
  };
  plan.each("torques on points", {Data::AFFINE, Data::MASS, Data::FORCE}, {Data::AFFINE},
            add_torques, takes_torques);
}

/** Mass, momentum and velocity of the start of the step, which USF and USAVG strain points with. */
void begin_with_stress(MPMPlan &plan, double share, double shift)
{
  begin(plan);
  points_to_nodes(plan, "points to nodes", MOMENTUM);
  plan.place(MPMPlan::BEFORE_SOLVE);
  plan.each("momentum equation", AT_NODES, {Data::NODES}, velocities);
  plan.node_actions(MPMNodeAction::START);
  gradients_of_last_motion(plan, share, shift);
  plan.each("momentum equation", AT_NODES, {Data::NODES}, back_to_momentum);
  average_pressure(plan);
  points_to_nodes(plan, "points to nodes", FORCE);
}

/** Mass, momentum and force of the nodes. */
void begin_with_forces(MPMPlan &plan)
{
  begin(plan);
  average_pressure(plan);
  points_to_nodes(plan, "points to nodes", ALL);
  plan.place(MPMPlan::BEFORE_SOLVE);
}

/** The momentum equation, what else changes the velocities of the nodes, and the energy of that. */
void solve(MPMPlan &plan)
{
  plan.each("momentum equation", AT_NODES, {Data::NODES}, momentum_equation);
  plan.place(MPMPlan::AFTER_MOMENTUM);
  plan.node_actions(MPMNodeAction::STEP);
  const auto refine = [&plan]() {
    fmpm(plan);
  };
  plan.together("FMPM", Data{Data::POSITION, Data::MASS} + AT_NODES, NODES_AND_OWN, refine,
                with<&Options::has_fmpm>);
  plan.place(MPMPlan::AFTER_ACTIONS);
  const auto account = [](MPMField &field) {
    field.ledger.account_for_nodes();
  };
  plan.each("energy of nodes", MOTION + STATE + Data{Data::FORCE} + AT_NODES, NODES_AND_OWN,
            account, has_ledger);
  plan.each("XPIC", Data{Data::POSITION, Data::MASS} + AT_NODES, {Data::VELOCITY, Data::NODES},
            xpic, with<&Options::has_xpic>);
  const auto smooth = [](MPMField &field) {
    field.smoothing->smooth();
  };
  plan.each("smoother volumes", STATE_IN_BLOCKS, STATE, smooth, with<&Options::smooths_volumes>);
  plan.place(MPMPlan::AFTER_SOLVE);
  const auto heat = [](MPMField &field) {
    field.heating->before_motion();
  };
  plan.each("heat of transfers", MOTION + AT_NODES, NODES_AND_OWN, heat, with<&Options::heats>);
}

/** The other way to affine matrices, and with stress also to that, where nodes may be light. */
void add_light_nodes(MPMPlan &plan, bool stress)
{
  const auto gradients = [stress](MPMField &field) {
    gradients_with_light_nodes(field, stress);
  };
  plan.each("light nodes", AT_NODES, {Data::NODES}, blend_light_nodes,
            with<&Options::has_light_nodes>);
  plan.node_actions(MPMNodeAction::MAPPED_BACK, with<&Options::has_light_nodes>);
  const Data changed = stress ? MOTION + STATE : MOTION;
  plan.each("gradients with light nodes", changed + AT_NODES, changed + NODES_AND_OWN, gradients,
            with<&Options::has_light_nodes>);
}

/** The momentum equation and new velocities of the points; stress is made before or after this. */
void solve_and_move(MPMPlan &plan)
{
  solve(plan);
  nodes_to_points(plan, "nodes to points", ELSEWHERE, nullptr);
  add_light_nodes(plan, false);
}

/** The velocities of the points once more to the nodes, at the old positions. An affine matrix is
 *  that of this step, never the old one. */
void map_back(MPMPlan &plan)
{
  points_to_nodes(plan, "velocities back to nodes", MOMENTUM);
  plan.each("momentum equation", AT_NODES, {Data::NODES}, velocities);
  plan.node_actions(MPMNodeAction::MAPPED_BACK);
}

void end(MPMPlan &plan)
{
  plan.place(MPMPlan::POINTS_HAVE_MOVED);
  const auto watch = [&plan]() {
    plan.watch->moved();
  };
  plan.together("energy watch", MOTION + STATE + Data{Data::FORCE}, {Data::OWN}, watch,
                with<&Options::watches_gain>);
  plan.place(MPMPlan::AFTER_MOTION);
  const auto look = [](MPMField &field) {
    field.fracture_watch->step();
  };
  plan.each("fracture watch", STATE_IN_BLOCKS, {Data::OWN}, look, with<&Options::watches_fracture>);
  plan.each("checks", MOTION + STATE + AT_NODES, {Data::OWN}, checks);
  const auto finish = [](MPMField &field) {
    field.every->finish();
  };
  plan.each("end of a long step", MOTION + Data{Data::OWN}, {Data::POSITION, Data::OWN}, finish,
            takes_long_steps);
}

}    // namespace

/** Update stress last, with the velocities that move the points. */
static void make_usl(MPMPlan &plan)
{
  begin_with_forces(plan);
  solve(plan);
  plan.place(MPMPlan::BEFORE_STRAIN);
  nodes_to_points(plan, "nodes to points with material", STRESS,
                  with<&Options::strains_while_moving>);
  nodes_to_points(plan, "nodes to points with averaged strain", GRADIENTS,
                  with<&Options::strains_after_motion>);
  nodes_to_points(plan, "nodes to points", FRAME, with<&Options::has_light_nodes>);
  add_light_nodes(plan, true);
  end(plan);
}

/** Update stress first, with the velocities of the start of the step. */
static void make_usf(MPMPlan &plan)
{
  begin_with_stress(plan, 1.0, 1.0);
  solve_and_move(plan);
  late_motion(plan, with<&Options::has_light_nodes>);
  end(plan);
}

/** Modified update stress last, with the new velocities of the points mapped back. */
static void make_musl(MPMPlan &plan)
{
  begin_with_forces(plan);
  solve_and_move(plan);
  map_back(plan);
  plan.place(MPMPlan::BEFORE_STRAIN);
  gradients_with_material(plan, 1.0, 0.0);
  late_motion(plan);
  end(plan);
}

/** Average of the first and the modified last: half of the strain with each. */
static void make_usavg(MPMPlan &plan)
{
  begin_with_stress(plan, 0.5, 0.75);
  solve_and_move(plan);
  map_back(plan);
  gradients_with_material(plan, 0.5, -0.25);
  late_motion(plan);
  end(plan);
}

void MPMStages::make_scheme(MPMPlan &plan)
{
  static void (*const make_list[])(MPMPlan &) = {make_usl, make_usf, make_musl, make_usavg};
  make_list[plan.fields[0]->options.scheme](plan);    // in the order of MPMFieldOptions::Scheme
}
