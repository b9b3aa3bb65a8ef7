/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// The four schemes: each is one list of stages, in the order of the book (V.P. Nguyen, A. de Vaucorbeil,
// S. Bordas, The Material Point Method, Springer 2023, chapter 2). Stages that no field needs are not in
// the list of a run.

#include "mpm_affine.h"
#include "mpm_field.h"
#include "mpm_frame.h"
#include "mpm_locking.h"
#include "mpm_plan.h"
#include "mpm_stages.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPMStages;

namespace {

using Field = const MPMField &;

bool has_light_nodes(Field field)
{
  return field.options.light > 0.0;
}
bool averages_pressure(Field field)
{
  return field.options.averages_stress();
}
bool averages_strain(Field field)
{
  return field.options.averages_strain();
}

/** Nodes after the momentum equation: what else changes their velocities, and the energy of that. */
void finish_nodes(MPMPlan &plan)
{
  plan.node_actions(MPMNodeAction::STEP);
  const auto is_fmpm = [](const MPMField *f) {
    return f->options.series == MPMFieldOptions::FMPM;
  };
  if (std::any_of(plan.fields.begin(), plan.fields.end(), is_fmpm))
    plan.together("FMPM", [&plan]() {
      fmpm(plan);
    });
  plan.each(
      "energy of nodes",
      [](MPMField &f) {
        f.ledger.account_for_nodes();
      },
      [](Field f) {
        return f.ledger.on;
      });
  plan.each("XPIC", xpic, [](Field f) {
    return f.options.series == MPMFieldOptions::XPIC;
  });
  plan.place(MPMPlan::AFTER_SOLVE);
}

/** The other way to affine matrices where nodes may be light; stress is made elsewhere. */
void add_light_nodes(MPMPlan &plan, MPMPlan::Each gradients)
{
  if (std::none_of(plan.fields.begin(), plan.fields.end(), [](const MPMField *f) {
        return has_light_nodes(*f);
      }))
    return;
  plan.each("light nodes", blend_light_nodes, has_light_nodes);
  plan.node_actions(MPMNodeAction::MAPPED_BACK);
  plan.each("gradients with light nodes", gradients, has_light_nodes);
}

/** The velocities of the points once more to the nodes, at the old positions. An affine matrix is that of
 *  this step, never the old one. */
void map_back(MPMPlan &plan)
{
  plan.each("velocities back to nodes", momentum_to_nodes);
  plan.each("sum over ranks", sum_momentum);
  plan.each("momentum equation", velocities);
  plan.node_actions(MPMNodeAction::MAPPED_BACK);
}

/** What all schemes begin with. */
void begin(MPMPlan &plan)
{
  plan.together("topology", [&plan]() {
    plan.find_blocks();
  });
  plan.place(MPMPlan::BEFORE_POINTS_TO_NODES);
  plan.each(
      "torques on points",
      [](MPMField &f) {
        f.affine->add_torques();
      },
      [](Field f) {
        return f.affine && f.affine->takes_torques();
      });
}

void end(MPMPlan &plan)
{
  plan.place(MPMPlan::AFTER_MOTION);
  plan.each("checks", checks);
}

/** Mass, momentum and velocity of the start of the step, which USF and USAVG strain points with. */
void begin_with_stress(MPMPlan &plan, double share, double shift)
{
  begin(plan);
  plan.each("points to nodes", momentum_to_nodes);
  plan.each("sum over ranks", sum_momentum);
  plan.place(MPMPlan::BEFORE_SOLVE);
  plan.each("momentum equation", velocities);
  plan.node_actions(MPMNodeAction::START);
  plan.each("gradients with material", [=](MPMField &f) {
    strain_from_nodes(f, share, shift);
  });
  plan.each("momentum equation", back_to_momentum);
  plan.each(
      "averaged pressure",
      [](MPMField &f) {
        f.locking->average_pressure();
      },
      averages_pressure);
  plan.each("points to nodes", forces_to_nodes);
  plan.each("sum over ranks", sum_forces);
}

/** Mass, momentum and force of the nodes. */
void begin_with_forces(MPMPlan &plan)
{
  begin(plan);
  plan.each(
      "averaged pressure",
      [](MPMField &f) {
        f.locking->average_pressure();
      },
      averages_pressure);
  plan.each("points to nodes", points_to_nodes);
  plan.each("sum over ranks", sum_all);
  plan.place(MPMPlan::BEFORE_SOLVE);
}

}    // namespace

/* ----------------------------------------------------------------------
   update stress last, with the velocities that move the points
------------------------------------------------------------------------- */

void LAMMPS_NS::make_usl(MPMPlan &plan)
{
  begin_with_forces(plan);
  plan.each("momentum equation", momentum_equation);
  finish_nodes(plan);
  plan.each(
      "nodes to points with material",
      [](MPMField &f) {
        nodes_to_points(f, STRESS);
      },
      [](Field f) {
        return !has_light_nodes(f) && !averages_strain(f);
      });
  plan.each(
      "nodes to points with averaged strain",
      [](MPMField &f) {
        nodes_to_points(f, GRADIENTS);
      },
      [](Field f) {
        return !has_light_nodes(f) && averages_strain(f);
      });
  plan.each(
      "nodes to points",
      [](MPMField &f) {
        nodes_to_points(f, FRAME);
      },
      has_light_nodes);
  add_light_nodes(plan, stress_with_light_nodes);
  end(plan);
}

/* ----------------------------------------------------------------------
   update stress first, with the velocities of the start of the step
------------------------------------------------------------------------- */

void LAMMPS_NS::make_usf(MPMPlan &plan)
{
  begin_with_stress(plan, 1.0, 1.0);
  plan.each("momentum equation", momentum_equation);
  finish_nodes(plan);
  plan.each("nodes to points", [](MPMField &f) {
    nodes_to_points(f, ELSEWHERE);
  });
  add_light_nodes(plan, affine_with_light_nodes);
  plan.each("motion of points", move_points, has_light_nodes);
  end(plan);
}

/* ----------------------------------------------------------------------
   modified update stress last, with the new velocities of the points mapped back
------------------------------------------------------------------------- */

void LAMMPS_NS::make_musl(MPMPlan &plan)
{
  begin_with_forces(plan);
  plan.each("momentum equation", momentum_equation);
  finish_nodes(plan);
  plan.each("nodes to points", [](MPMField &f) {
    nodes_to_points(f, ELSEWHERE);
  });
  add_light_nodes(plan, affine_with_light_nodes);
  map_back(plan);
  plan.each("gradients with material", [](MPMField &f) {
    strain_from_nodes(f, 1.0, 0.0, true);
  });
  plan.each("motion of points", move_points);
  end(plan);
}

/* ----------------------------------------------------------------------
   average of the first and the modified last: half of the strain with each
------------------------------------------------------------------------- */

void LAMMPS_NS::make_usavg(MPMPlan &plan)
{
  begin_with_stress(plan, 0.5, 0.75);
  plan.each("momentum equation", momentum_equation);
  finish_nodes(plan);
  plan.each("nodes to points", [](MPMField &f) {
    nodes_to_points(f, ELSEWHERE);
  });
  add_light_nodes(plan, affine_with_light_nodes);
  map_back(plan);
  plan.each("gradients with material", [](MPMField &f) {
    strain_from_nodes(f, 0.5, -0.25);
  });
  plan.each("motion of points", move_points);
  end(plan);
}
