/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Heat of the friction at walls (keyword heat). It is made at each node that slides, see mpm_friction_heat.cpp

#include "walls/fix_mpm_boundary.h"

#include "field/mpm_field.h"
#include "force.h"
#include "math_extra.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   called by fix mpm at the start of a run
------------------------------------------------------------------------- */

void FixMPMBoundary::init_action()
{
  if (!heating) return;
  std::vector<MPMField *> fields;
  for (auto *field : MPMField::all(lmp))
    if (acts_on(*field)) fields.push_back(field);
  heating->begin_run(*this, fields);
}

/** From now on, set_velocity() acts along a wall with this normal, on which material slides or not. */
void FixMPMBoundary::heat_if_sliding(Contact contact, const double *normal)
{
  now.normal = heating && now.counting && contact == SLIDING ? normal : nullptr;
}

/* ----------------------------------------------------------------------
   Gives the heat of friction to a node whose velocity changes to v. The work of the tangential impulse was
   counted with another velocity; returns the work per mass that the ledger must add
------------------------------------------------------------------------- */

double FixMPMBoundary::slip_work(Grid &grid, int64_t node, const double *V, const double *change,
                                 const double *v, const double *counted)
{
  const double *const record = grid.record(node);
  const int dim = grid.lattice.dim;
  double along = 0.0, J[3] = {0.0}, old[3] = {0.0}, relative[3] = {0.0};
  double work = 0.0, driven = 0.0;
  for (int d = 0; d < dim; d++) along += change[d] * now.normal[d];
  for (int d = 0; d < dim; d++) {
    const double slide = change[d] - along * now.normal[d];
    J[d] = record[3] * slide;
    old[d] = record[4 + d] - V[d];
    relative[d] = v[d] - V[d];
    work += slide * counted[d];
    driven += slide * V[d];
  }
  const double heat = heating->made(J, old, relative, dim);
  heating->at_wall(now.place, record, heat, grid.owns(node));
  return driven - heat / (record[3] * force->mvv2e) - work;
}
