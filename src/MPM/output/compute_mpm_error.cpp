/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/compute_mpm_error.h"

#include "arg_info.h"
#include "atom.h"
#include "base/mpm_options.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "input.h"
#include "modify.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

/** compute ID group mpm/error  value exact  value exact ... */
ComputeMPMError::ComputeMPMError(LAMMPS *lmp, int narg, char **arg) : Compute(lmp, narg, arg)
{
  require_arguments(lmp, "compute mpm/error", narg, 3, {"value", "exact"});
  if (!atom->rmass || !atom->vfrac)
    error->all(FLERR,
               "Compute mpm/error needs material points: use atom_style mpm, alone or in a hybrid");
  if ((narg - 3) % 2)
    error->all(
        FLERR, narg - 1,
        "Compute mpm/error: value {} has no exact solution next to it: values and atom-style "
        "variables come in pairs",
        arg[narg - 1]);
  for (int iarg = 3; iarg < narg; iarg++) values.push_back(parse(arg[iarg], iarg, (iarg - 3) % 2));

  scalar_flag = vector_flag = 1;
  size_vector = NVALUES;
  extscalar = extvector = 0;
  vector = norms;
}

ComputeMPMError::Value ComputeMPMError::parse(const char *text, int iarg, bool is_exact)
{
  static const std::vector<std::string> of_atoms = {"x", "y", "z", "vx", "vy", "vz"};
  const int k = std::find(of_atoms.begin(), of_atoms.end(), text) - of_atoms.begin();
  if (!is_exact && k < 6) return {k < 3 ? ArgInfo::X : ArgInfo::V, k % 3, "", -1, iarg};
  const ArgInfo info(
      text, is_exact ? ArgInfo::VARIABLE : ArgInfo::COMPUTE | ArgInfo::FIX | ArgInfo::VARIABLE);
  if (info.get_type() == ArgInfo::UNKNOWN || info.get_type() == ArgInfo::NONE ||
      info.get_dim() > 1 || (info.get_type() == ArgInfo::VARIABLE && info.get_dim() > 0)) {
    if (is_exact)
      error->all(FLERR, iarg,
                 "Compute mpm/error: exact solution {} must be an atom-style variable, v_NAME",
                 text);
    error->all(FLERR, iarg,
               "Compute mpm/error: value {} must be x, y, z, vx, vy, vz, or a per-atom c_ID, "
               "c_ID[i], f_ID, f_ID[i] or v_NAME",
               text);
  }
  Value value = {info.get_type(), info.get_index1(), info.get_name(), -1, iarg};
  check(value);
  return value;
}

/** Does what a value refers to exist, and is it per atom? */
void ComputeMPMError::check(Value &value)
{
  const auto check_source = [&](const char *what, const auto *source) {
    if (!source)
      error->all(FLERR, value.iarg, "Compute mpm/error: {} {} does not exist", what, value.id);
    if (!source->peratom_flag)
      error->all(FLERR, value.iarg, "Compute mpm/error: {} {} is not per atom", what, value.id);
    const int columns = source->size_peratom_cols;
    if (value.component == 0 && columns > 0)
      error->all(FLERR, value.iarg, "Compute mpm/error: {} {} has {} columns: choose one with [i]",
                 what, value.id, columns);
    if (value.component > columns)
      error->all(FLERR, value.iarg, "Compute mpm/error: {} {} has no column {}", what, value.id,
                 value.component);
  };
  if (value.type == ArgInfo::COMPUTE) {
    check_source("compute", modify->get_compute_by_id(value.id));
  } else if (value.type == ArgInfo::FIX) {
    check_source("fix", modify->get_fix_by_id(value.id));
  } else if (value.type == ArgInfo::VARIABLE) {
    value.variable = input->variable->find(value.id.c_str());
    if (value.variable < 0)
      error->all(FLERR, value.iarg, "Compute mpm/error: variable {} does not exist", value.id);
    if (!input->variable->atomstyle(value.variable))
      error->all(FLERR, value.iarg, "Compute mpm/error: variable {} is not atom-style", value.id);
  }
}

void ComputeMPMError::init()
{
  for (auto &value : values) check(value);
}

/** A quantity of all atoms of this rank. */
void ComputeMPMError::get(const Value &value, std::vector<double> &out)
{
  const int nlocal = atom->nlocal;
  out.resize(nlocal);
  const auto take = [&](const auto *source) {
    for (int i = 0; i < nlocal; i++)
      out[i] = value.component ? source->array_atom[i][value.component - 1]
                               : source->vector_atom[i];
  };
  if (value.type == ArgInfo::X) {
    for (int i = 0; i < nlocal; i++) {
      double unwrapped[3];
      domain->unmap(atom->x[i], atom->image[i], unwrapped);
      out[i] = unwrapped[value.component];
    }
  } else if (value.type == ArgInfo::V) {
    for (int i = 0; i < nlocal; i++) out[i] = atom->v[i][value.component];
  } else if (value.type == ArgInfo::VARIABLE) {
    double unused;
    input->variable->compute_atom(value.variable, igroup, nlocal ? out.data() : &unused, 1, 0);
  } else if (value.type == ArgInfo::COMPUTE) {
    auto *compute = modify->get_compute_by_id(value.id);
    if (!(compute->invoked_flag & Compute::INVOKED_PERATOM)) {
      compute->compute_peratom();
      compute->invoked_flag |= Compute::INVOKED_PERATOM;
    }
    take(compute);
  } else {
    const auto *fix = modify->get_fix_by_id(value.id);
    if (update->ntimestep % fix->peratom_freq)
      error->all(FLERR, Error::NOLASTLINE, "Compute mpm/error: fix {} is not computed at this time",
                 value.id);
    take(fix);
  }
}

void ComputeMPMError::compute_vector()
{
  invoked_vector = update->ntimestep;
  const int nlocal = atom->nlocal;
  difference2.assign(nlocal, 0.0);
  exact2.assign(nlocal, 0.0);
  for (std::size_t k = 0; k < values.size(); k += 2) {
    get(values[k], computed);
    get(values[k + 1], wanted);
    for (int i = 0; i < nlocal; i++) {
      difference2[i] += (computed[i] - wanted[i]) * (computed[i] - wanted[i]);
      exact2[i] += wanted[i] * wanted[i];
    }
  }

  double mine[3] = {0.0, 0.0, 0.0}, sum[3], largest = 0.0, all;
  for (int i = 0; i < nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || !(atom->vfrac[i] > 0.0)) continue;
    mine[0] += atom->vfrac[i];
    mine[1] += atom->vfrac[i] * difference2[i];
    mine[2] += atom->vfrac[i] * exact2[i];
    largest = std::max(largest, difference2[i]);    // leaves out what is not a number
  }
  MPI_Allreduce(mine, sum, 3, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&largest, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  if (std::isnan(sum[1])) all = sum[1];    // NaN stays, whichever point and rank has it
  const double volume = sum[0] > 0.0 ? sum[0] : 1.0;
  vector[L2] = sqrt(sum[1] / volume);
  vector[LARGEST] = sqrt(all);
  vector[EXACT] = sqrt(sum[2] / volume);
  for (const int k : {L2, LARGEST})    // written so that NaN stays
    if (!(norms[k] <= norms[L2_SO_FAR + k])) norms[L2_SO_FAR + k] = norms[k];
  scalar = vector[L2];
}

double ComputeMPMError::compute_scalar()
{
  if (invoked_vector != update->ntimestep) compute_vector();
  invoked_scalar = update->ntimestep;
  return scalar;
}

double ComputeMPMError::memory_usage()
{
  return (computed.capacity() + wanted.capacity() + difference2.capacity() + exact2.capacity()) *
      sizeof(double);
}
