/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/compute_mpm_atom.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_batches.h"
#include "force.h"
#include "material/material.h"
#include "math_eigen.h"
#include "memory.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

namespace {

/** State of one point, and its quantities, some of which have several components. */
struct Point {
  int i;
  const MPMField *field;    // that it belongs to, null: none
  const double *F;          // row-major
  const double *sigma;      // Cauchy stress, xx yy zz xy xz yz
  const double *v;
  double m, V, V0;

  double deformation(int component) const { return F[component]; }
  double jacobian(int) const { return MPMPoints::det(F); }
  double stress(int component) const { return sigma[component]; }
  double pressure(int) const { return -(sigma[0] + sigma[1] + sigma[2]) / 3.0; }
  double vonmises(int) const
  {
    const double xy = sigma[0] - sigma[1], yz = sigma[1] - sigma[2], zx = sigma[2] - sigma[0];
    return sqrt(0.5 * (xy * xy + yz * yz + zx * zx) +
                3.0 * (sigma[3] * sigma[3] + sigma[4] * sigma[4] + sigma[5] * sigma[5]));
  }
  double triaxiality(int) const
  {
    const double shear = vonmises(0);
    return shear > 0.0 ? -pressure(0) / shear : 0.0;
  }
  double principal(int rank) const
  {
    const double matrix[3][3] = {{sigma[0], sigma[3], sigma[4]},
                                 {sigma[3], sigma[1], sigma[5]},
                                 {sigma[4], sigma[5], sigma[2]}};
    double value[3], vector[3][3];
    MathEigen::jacobi3(matrix, value, vector);    // sorts in decreasing order
    return value[rank];
  }
  double volume(int) const { return V; }
  double volume0(int) const { return V0; }
  double mass(int) const { return m; }
  double density(int) const { return m / V; }
  double speed(int) const { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
  double angmom(int component) const
  {
    double L[3] = {0.0, 0.0, 0.0};
    if (field && field->affine) field->affine->angular_momentum(i, L);
    return L[component];
  }
};

void energy(const Material &material, const Batch &batch, double pressure_to_energy, double *value)
{
  material.stored_energy(batch, value);
  for (int k = 0; k < batch.n; k++) value[k] *= batch.vol0[k] * pressure_to_energy;
}

void wavespeed(const Material &material, const Batch &batch, double, double *value)
{
  material.wave_speed(batch, value);
}

}    // namespace

/** Quantities of the table: functions of one point, or of a batch of one material. */
struct ComputeMPMAtom::Quantity {
  std::string name;
  double (Point::*of_point)(int component) const;
  std::vector<std::string> components = {""};    // what follows the name
  void (*evaluate)(const Material &, const Batch &, double pressure_to_energy, double *) = nullptr;
};

// customize by adding a line: names of the form group/component can be asked for as group/*

static const ComputeMPMAtom::Quantity quantities[] = {
    {"stress", &Point::stress, {"/xx", "/yy", "/zz", "/xy", "/xz", "/yz"}},
    {"principal", &Point::principal, {"/1", "/2", "/3"}},
    {"pressure", &Point::pressure},
    {"vonmises", &Point::vonmises},
    {"triaxiality", &Point::triaxiality},
    {"F", &Point::deformation, {"/xx", "/xy", "/xz", "/yx", "/yy", "/yz", "/zx", "/zy", "/zz"}},
    {"J", &Point::jacobian},
    {"volume", &Point::volume},
    {"volume0", &Point::volume0},
    {"mass", &Point::mass},
    {"density", &Point::density},
    {"speed", &Point::speed},
    {"energy", nullptr, {""}, energy},
    {"wavespeed", nullptr, {""}, wavespeed},
    {"angmom", &Point::angmom, {"/x", "/y", "/z"}},
};

std::vector<std::string> ComputeMPMAtom::expand(const std::string &name)
{
  std::vector<std::string> names;
  for (const auto &quantity : quantities)
    if (quantity.components.size() > 1 && name == quantity.name + "/*")
      for (const auto &component : quantity.components) names.push_back(quantity.name + component);
  if (names.empty()) names.push_back(name);
  return names;
}

/** The column of a name, one of the table or else of a history variable. */
ComputeMPMAtom::Column ComputeMPMAtom::find_column(const std::string &name)
{
  for (const auto &quantity : quantities)
    for (std::size_t k = 0; k < quantity.components.size(); k++)
      if (name == quantity.name + quantity.components[k]) return {name, &quantity, (int) k};
  return {name, nullptr, 0};
}

ComputeMPMAtom::ComputeMPMAtom(LAMMPS *lmp, int narg, char **arg) :
    Compute(lmp, narg, arg), points(MPMPoints::get(atom))
{
  require_arguments(lmp, "compute mpm/atom", narg, 3, {"name"});
  if (!points)
    error->all(FLERR, 2, "Compute mpm/atom requires material points: use atom_style mpm");

  for (int iarg = 3; iarg < narg; iarg++)
    for (const auto &name : expand(arg[iarg])) {
      columns.push_back(find_column(name));
      if (!columns.back().quantity && name.find('*') != std::string::npos)
        error->all(FLERR, iarg,
                   "Unknown compute mpm/atom quantities {}: wildcards are F/*, "
                   "stress/*, principal/*, and angmom/*",
                   name);
    }

  peratom_flag = 1;
  size_peratom_cols = columns.size() == 1 ? 0 : (int) columns.size();
}

ComputeMPMAtom::~ComputeMPMAtom()
{
  memory->destroy(array_atom);
}

std::string ComputeMPMAtom::known_names() const
{
  std::string text;
  for (const auto &quantity : quantities)
    for (const auto &component : quantity.components) text += " " + quantity.name + component;

  for (const auto *physics : find_fixes<MPMPhysics>(lmp))
    for (const auto &name : physics->quantities()) text += " " + name;

  std::set<std::string> history;
  for (const auto &fix : modify->get_fix_by_style("^mpm/material$"))
    for (const auto &variable : dynamic_cast<FixMPMMaterial *>(fix)->material->history())
      history.insert(variable.name);
  text += history.empty() ? "; the materials have no history variables"
                          : "; history variables of the materials:";
  for (const auto &name : history) text += " " + name;
  return text;
}

void ComputeMPMAtom::init()
{
  points = MPMPoints::get(atom);
  if (!points)
    error->all(FLERR, Error::NOLASTLINE, "No material points for {}: use atom_style mpm", whose());
  find_owners();
}

std::string ComputeMPMAtom::whose() const
{
  return owner.empty() ? fmt::format("compute {} of style mpm/atom", id) : owner;
}

/** A name that is none of the table must be one of other physics or a history variable of a
 *  material that there are now. */
void ComputeMPMAtom::find_owners()
{
  for (auto &column : columns) {
    if (column.quantity) continue;
    column.physics = nullptr;
    for (const auto *physics : find_fixes<MPMPhysics>(lmp)) {
      const auto names = physics->quantities();
      const auto at = std::find(names.begin(), names.end(), column.name);
      if (at == names.end()) continue;
      column.physics = physics;
      column.component = (int) (at - names.begin());
    }
    bool found = column.physics != nullptr;
    for (const auto &fix : modify->get_fix_by_style("^mpm/material$"))
      found |= dynamic_cast<FixMPMMaterial *>(fix)->find_history(column.name) >= 0;
    if (!found)
      error->all(FLERR, Error::NOLASTLINE, "Unknown quantity {} in {}; known are:{}", column.name,
                 whose(), known_names());
  }
}

void ComputeMPMAtom::compute_peratom()
{
  invoked_peratom = update->ntimestep;
  find_owners();    // between runs there can be other materials than in init()

  const int ncolumn = (int) columns.size();
  if (atom->nmax > nmax) {
    nmax = atom->nmax;
    memory->destroy(array_atom);
    memory->create(array_atom, nmax, ncolumn, "mpm/atom:array");
    if (size_peratom_cols == 0) vector_atom = array_atom[0];
  }

  const auto fields = MPMField::all(lmp);
  std::vector<int> of_points, of_physics;    // columns
  for (int n = 0; n < ncolumn; n++) {
    if (columns[n].quantity && columns[n].quantity->of_point) of_points.push_back(n);
    if (columns[n].physics) of_physics.push_back(n);
  }
  for (int i = 0; i < atom->nlocal; i++) {
    std::fill_n(array_atom[i], ncolumn, 0.0);
    if (!(atom->mask[i] & groupbit) || !(atom->vfrac[i] > 0.0)) continue;
    for (const int n : of_physics)
      array_atom[i][n] = columns[n].physics->quantity(columns[n].component, i);
    if (of_points.empty()) continue;
    const MPMField *field = nullptr;
    for (const auto *each : fields)
      if (each->is_point(i)) field = each;
    double sigma[6];
    points->cauchy(i, sigma);
    const double V0 = atom->vfrac[i], V = points->jacobian(i) * V0;
    const Point p = {i, field, points->F[i], sigma, atom->v[i], atom->rmass[i], V, V0};
    for (const int n : of_points)
      array_atom[i][n] = (p.*columns[n].quantity->of_point)(columns[n].component);
  }

  if ((int) (of_points.size() + of_physics.size()) < ncolumn)
    visit_point_batches(
        lmp, groupbit, [&](const Batch &batch, const int *list, const FixMPMMaterial &material) {
          double value[BATCH];
          for (int n = 0; n < ncolumn; n++) {
            const auto *quantity = columns[n].quantity;
            const int index =
                quantity || columns[n].physics ? -1 : material.find_history(columns[n].name);
            if (quantity && quantity->evaluate)
              quantity->evaluate(*material.material, batch, 1.0 / force->nktv2p, value);
            else if (index >= 0)
              std::copy_n(batch.history[index], batch.n, value);
            else
              continue;
            for (int k = 0; k < batch.n; k++) array_atom[list[k]][n] = value[k];
          }
        });
}

double ComputeMPMAtom::memory_usage()
{
  return (double) nmax * columns.size() * sizeof(double);
}
