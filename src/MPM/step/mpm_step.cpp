/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// The four schemes: each is one list of stages, in the order of the book (V.P. Nguyen, A. de Vaucorbeil,
// S. Bordas, The Material Point Method, Springer 2023, chapter 2). Stages that no field needs are not in
// the list of a run.

#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_locking.h"
#include "field/mpm_plan.h"
#include "field/mpm_smoothing.h"
#include "field/mpm_transfer_heat.h"
#include "step/mpm_stages.h"

using namespace LAMMPS_NS;
using namespace MPMStages;

namespace {

using Field = const MPMField &;
using Options = MPMFieldOptions;

/** An option of the field as the condition of a stage. */
template <bool (MPMFieldOptions::*OPTION)() const> bool with(Field field)
{
  return (field.options.*OPTION)();
}
bool has_ledger(Field field)
{
  return field.ledger.on;
}
bool takes_torques(Field field)
{
  return field.affine && field.affine->takes_torques();
}

void points_to_nodes(MPMPlan &plan, const char *name, Content content)
{
  plan.each(name, [content](MPMField &field) {
    MPMStages::points_to_nodes(field, content);
  });
  plan.place(MPMPlan::AFTER_POINTS_TO_NODES);
  plan.each("sum over ranks", [content](MPMField &field) {
    sum_nodes(field, content);
  });
}

void nodes_to_points(MPMPlan &plan, const char *name, Strain strain, MPMPlan::Wanted wanted)
{
  const auto move = [strain](MPMField &field) {
    MPMStages::nodes_to_points(field, strain);
  };
  plan.each(name, move, std::move(wanted));
}

/** Strain of the motion of this step, and the motion. */
void gradients_with_material(MPMPlan &plan, double share, double shift)
{
  plan.each("gradients with material", [=](MPMField &field) {
    strain_from_nodes(field, field.step_dt(), share, shift, true);
  });
}

/** Strain of the motion of the step before: that has brought the points to where they are. Where the time
 *  step changes, the deformation gradient would not be that of the motion with another duration. */
void gradients_of_last_motion(MPMPlan &plan, double share, double shift)
{
  plan.each("gradients with material", [=](MPMField &field) {
    strain_from_nodes(field, field.step_dt_before(), share, shift);
  });
}

void average_pressure(MPMPlan &plan)
{
  const auto average = [](MPMField &field) {
    field.locking->average_pressure();
  };
  plan.each("averaged pressure", average, with<&Options::averages_stress>);
}

/** What all schemes begin with. */
void begin(MPMPlan &plan)
{
  const auto watch = [&plan]() {
    plan.watch->step();
  };
  plan.together("energy watch", watch, with<&Options::watches_gain>);
  plan.together("topology", [&plan]() {
    plan.find_blocks();
  });
  const auto smooth = [](MPMField &field) {
    field.smoothing->smooth();
  };
  plan.each("smoother volumes", smooth, with<&Options::smooths_volumes>);
  plan.place(MPMPlan::BEFORE_POINTS_TO_NODES);
  const auto add_torques = [](MPMField &field) {
    field.affine->add_torques();
  };
  plan.each("torques on points", add_torques, takes_torques);
}

/** Mass, momentum and velocity of the start of the step, which USF and USAVG strain points with. */
void begin_with_stress(MPMPlan &plan, double share, double shift)
{
  begin(plan);
  points_to_nodes(plan, "points to nodes", MOMENTUM);
  plan.place(MPMPlan::BEFORE_SOLVE);
  plan.each("momentum equation", velocities);
  plan.node_actions(MPMNodeAction::START);
  gradients_of_last_motion(plan, share, shift);
  plan.each("momentum equation", back_to_momentum);
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
  plan.each("momentum equation", momentum_equation);
  plan.place(MPMPlan::AFTER_MOMENTUM);
  plan.node_actions(MPMNodeAction::STEP);
  const auto refine = [&plan]() {
    fmpm(plan);
  };
  plan.together("FMPM", refine, with<&Options::has_fmpm>);
  plan.place(MPMPlan::AFTER_ACTIONS);
  const auto account = [](MPMField &field) {
    field.ledger.account_for_nodes();
  };
  plan.each("energy of nodes", account, has_ledger);
  plan.each("XPIC", xpic, with<&Options::has_xpic>);
  plan.place(MPMPlan::AFTER_SOLVE);
  const auto heat = [](MPMField &field) {
    field.heating->before_motion();
  };
  plan.each("heat of transfers", heat, with<&Options::heats>);
}

/** The other way to affine matrices, and with stress also to that, where nodes may be light. */
void add_light_nodes(MPMPlan &plan, bool stress)
{
  const auto gradients = [stress](MPMField &field) {
    gradients_with_light_nodes(field, stress);
  };
  plan.each("light nodes", blend_light_nodes, with<&Options::has_light_nodes>);
  plan.node_actions(MPMNodeAction::MAPPED_BACK, with<&Options::has_light_nodes>);
  plan.each("gradients with light nodes", gradients, with<&Options::has_light_nodes>);
}

/** The momentum equation and new velocities of the points; stress is made before or after this. */
void solve_and_move(MPMPlan &plan)
{
  solve(plan);
  nodes_to_points(plan, "nodes to points", ELSEWHERE, nullptr);
  add_light_nodes(plan, false);
}

/** The velocities of the points once more to the nodes, at the old positions. An affine matrix is that of
 *  this step, never the old one. */
void map_back(MPMPlan &plan)
{
  points_to_nodes(plan, "velocities back to nodes", MOMENTUM);
  plan.each("momentum equation", velocities);
  plan.node_actions(MPMNodeAction::MAPPED_BACK);
}

void end(MPMPlan &plan)
{
  const auto watch = [&plan]() {
    plan.watch->moved();
  };
  plan.together("energy watch", watch, with<&Options::watches_gain>);
  plan.place(MPMPlan::AFTER_MOTION);
  const auto look = [](MPMField &field) {
    field.fracture_watch->step();
  };
  plan.each("fracture watch", look, with<&Options::watches_fracture>);
  plan.each("checks", checks);
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
  plan.each("motion of points", move_points, with<&Options::has_light_nodes>);
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
  plan.each("motion of points", move_points);
  end(plan);
}

/** Average of the first and the modified last: half of the strain with each. */
static void make_usavg(MPMPlan &plan)
{
  begin_with_stress(plan, 0.5, 0.75);
  solve_and_move(plan);
  map_back(plan);
  gradients_with_material(plan, 0.5, -0.25);
  plan.each("motion of points", move_points);
  end(plan);
}

void MPMStages::make_scheme(MPMPlan &plan)
{
  static void (*const make_list[])(MPMPlan &) = {make_usl, make_usf, make_musl, make_usavg};
  make_list[plan.fields[0]->options.scheme](plan);    // in the order of MPMFieldOptions::Scheme
}
