/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/compute_mpm_energy.h"

#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_physics.h"
#include "force.h"
#include "material/material.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;

ComputeMPMEnergy::ComputeMPMEnergy(LAMMPS *lmp, int narg, char **arg) : Compute(lmp, narg, arg)
{
  if (narg > 3) error->all(FLERR, 3, "Unknown compute mpm/energy argument: {}", arg[3]);
  if (igroup != 0)
    error->all(FLERR, 1,
               "Compute mpm/energy requires group all, since work cannot be told apart "
               "by group; for the stored energy of a group use compute mpm/atom energy with "
               "compute reduce");

  accounts = find_accounts();
  scalar_flag = vector_flag = 1;
  extscalar = extvector = 1;
  size_vector = NENTRY + (int) accounts.size();
  entries.assign(size_vector, 0.0);
  vector = entries.data();
}

void ComputeMPMEnergy::init()
{
  if (modify->get_fix_by_style("^mpm$").empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Compute {} of style mpm/energy requires a fix mpm; fix mpm/mesh has its "
               "energies in its own vector, as has fix mpm/incompressible",
               id);
  if (find_accounts() != accounts)
    error->all(FLERR, Error::NOLASTLINE,
               "Compute {} of style mpm/energy does not have the entries of all physics: define it "
               "after the fixes, and again when one of them was removed",
               id);
  forget_lost_parts();
}

/** A fix that was removed, or defined again, takes what it has kept of the ledger with it: of
 *  the rest there is no balance, and the ledger starts anew. */
void ComputeMPMEnergy::forget_lost_parts()
{
  std::vector<int> now;
  for (const auto *ifix : find_fixes<FixMPMState>(lmp))
    if (utils::strmatch(ifix->style, "^mpm$") || dynamic_cast<const FixMPMMaterial *>(ifix) ||
        dynamic_cast<const MPMPhysics *>(ifix))
      now.push_back(ifix->instance());
  std::sort(now.begin(), now.end());
  if (!std::includes(now.begin(), now.end(), contributors.begin(), contributors.end())) {
    start.clear();
    if (comm->me == 0)
      utils::logmesg(lmp,
                     "Compute {}: the ledger starts anew, as a fix that kept a part of it was "
                     "removed or defined again\n",
                     id);
  }
  contributors = now;
}

/** The ledger starts with the first run after the definition, or goes on from a restart file. */
void ComputeMPMEnergy::begin()
{
  forget_lost_parts();
  if (!start.empty()) return;
  start = evaluate();
  for (const auto *field : MPMField::all(lmp))
    if (field->ledger.start.size() == start.size()) {
      start = field->ledger.start;
      return;
    }
}

/** Accounts of other physics, each with a letter: S for stored energy, C for energy that came to
 *  the bodies, T for thermoelastic work, which is one of the sums; I: it is in the entry of time
 *  integration, too. */
std::vector<std::string> ComputeMPMEnergy::find_accounts() const
{
  std::vector<std::string> names;
  for (const auto *other : find_fixes<MPMPhysics>(lmp))
    for (const auto &account : other->accounts())
      names.push_back((account.stored ? "S" : "C") +
                      std::string(account.in_integration ? "I " : " ") + account.name);
  for (const auto *material : find_fixes<FixMPMMaterial>(lmp))
    if (material->material->is_thermoelastic()) {
      names.push_back("T thermoelastic");
      break;
    }
  return names;
}

std::vector<double> ComputeMPMEnergy::evaluate() const
{
  Sums mine = {};
  static_cast<MPMPointEnergies &>(mine) = point_energies(lmp);
  for (const auto *field : MPMField::all(lmp)) {
    mine.external += field->ledger.external;
    mine.boundary += field->ledger.boundary;
    mine.contact += field->ledger.contact;
    mine.transfer += field->ledger.transfer;
    mine.internal += field->ledger.internal;
    mine.deleted_kinetic += field->ledger.deleted_kinetic;
    mine.deleted_stored += field->ledger.deleted_stored;
  }

  for (const auto *material : find_fixes<FixMPMMaterial>(lmp))
    mine.stress_work += material->stress_work / force->nktv2p;

  std::vector<double> local(NSUMS), all(NSUMS + accounts.size());
  memcpy(local.data(), &mine, sizeof(Sums));
  // between runs there can be others than in init()
  for (const auto *other : find_fixes<MPMPhysics>(lmp)) {
    const std::size_t next = local.size();
    local.resize(next + other->accounts().size());
    other->account(local.data() + next);
  }
  local.resize(all.size());
  MPI_Allreduce(local.data(), all.data(), (int) all.size(), MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double ComputeMPMEnergy::compute_scalar()
{
  if (invoked_vector != update->ntimestep) compute_vector();
  invoked_scalar = update->ntimestep;
  scalar = vector[KINETIC] + vector[STORED] + vector[PLASTIC] + vector[VISCOUS] + vector[FRACTURE];
  for (std::size_t k = 0; k < accounts.size(); k++)
    if (accounts[k][0] != 'C') scalar += vector[NENTRY + k];
  return scalar;
}

void ComputeMPMEnergy::compute_vector()
{
  invoked_vector = update->ntimestep;
  begin();
  const auto present = evaluate();
  Sums now, old;
  memcpy(&now, present.data(), sizeof(Sums));
  memcpy(&old, start.data(), sizeof(Sums));

  vector[KINETIC] = now.kinetic;
  vector[STORED] = now.stored;
  vector[PLASTIC] = now.plastic;
  vector[VISCOUS] = now.viscous;
  vector[HEAT] = now.heat;
  vector[FRACTURE] = now.fracture;
  vector[EXTERNAL] = now.external - old.external;
  vector[BOUNDARY] = now.boundary - old.boundary;
  vector[CONTACT] = now.contact - old.contact;
  vector[TRANSFER] = now.transfer - old.transfer;

  // the law's account of the energy that internal forces took, against that energy

  const double stored = now.deleted_stored - old.deleted_stored;
  vector[DELETED] = now.deleted_kinetic - old.deleted_kinetic + stored;
  vector[INTEGRATION] = now.taken() - old.taken() - stored - (now.internal - old.internal);
  vector[LAWS] = now.taken() - old.taken() - stored - (now.stress_work - old.stress_work);
  vector[RESIDUAL] = now.total() - old.total() - vector[DELETED];
  for (int k = EXTERNAL; k < RESIDUAL; k++) vector[RESIDUAL] -= vector[k];

  for (std::size_t k = 0; k < accounts.size(); k++) {
    if (accounts[k][0] == 'T') {
      vector[NENTRY + k] = now.thermoelastic;
      continue;
    }
    const bool stored = accounts[k][0] == 'S';
    const double value = present[NSUMS + k], change = value - start[NSUMS + k];
    vector[NENTRY + k] = stored ? value : change;
    if (accounts[k][1] != 'I') vector[RESIDUAL] += stored ? change : -change;
  }
}
