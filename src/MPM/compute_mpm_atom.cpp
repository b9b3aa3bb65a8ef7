/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "compute_mpm_atom.h"

#include "atom.h"
#include "error.h"
#include "fix_mpm_material.h"
#include "force.h"
#include "material/material.h"
#include "math_eigen.h"
#include "memory.h"
#include "modify.h"
#include "mpm_affine.h"
#include "mpm_field.h"
#include "mpm_point_batches.h"
#include "mpm_points.h"
#include "update.h"

#include <cmath>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

namespace {

/** State of one point, as its quantities need it. */
struct Point {
  const double *F;         // row-major
  const double *stress;    // Cauchy, xx yy zz xy xz yz
  const double *v;
  double mass, volume, volume0;
};

double deformation(const Point &p, int component)
{
  return p.F[component];
}

double jacobian(const Point &p, int)
{
  return MPMPoints::det(p.F);
}

double stress(const Point &p, int component)
{
  return p.stress[component];
}

double pressure(const Point &p, int)
{
  return -(p.stress[0] + p.stress[1] + p.stress[2]) / 3.0;
}

double vonmises(const Point &p, int)
{
  const double *s = p.stress;
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return sqrt(0.5 * (xy * xy + yz * yz + zx * zx) +
              3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

double triaxiality(const Point &p, int)
{
  const double shear = vonmises(p, 0);
  return shear > 0.0 ? -pressure(p, 0) / shear : 0.0;
}

double principal(const Point &p, int rank)
{
  const double *s = p.stress;
  const double matrix[3][3] = {{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
  double value[3], vector[3][3];
  MathEigen::jacobi3(matrix, value, vector);    // sorts in decreasing order
  return value[rank];
}

double volume(const Point &p, int)
{
  return p.volume;
}

double volume0(const Point &p, int)
{
  return p.volume0;
}

double mass(const Point &p, int)
{
  return p.mass;
}

double density(const Point &p, int)
{
  return p.mass / p.volume;
}

double speed(const Point &p, int)
{
  return sqrt(p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2]);
}

void energy(const Material &material, const Batch &batch, double pressure_to_energy, double *value)
{
  material.stored_energy(batch, value);
  for (int k = 0; k < batch.n; k++) value[k] *= batch.vol0[k] * pressure_to_energy;
}

void wavespeed(const Material &material, const Batch &batch, double, double *value)
{
  material.wave_speed(batch, value);
}

double angmom(const MPMField &field, int i, int component)
{
  double L[3];
  L[0] = L[1] = L[2] = 0.0;
  if (field.affine) field.affine->angular_momentum(i, L);
  return L[component];
}

}    // namespace

/** A quantity of the table: a function of one point, of a batch of one material, or of what fix mpm knows
 *  of a point. */
struct ComputeMPMAtom::Quantity {
  const char *name;
  double (*of_point)(const Point &, int component);
  int component;
  void (*of_batch)(const Material &, const Batch &, double pressure_to_energy, double *);
  double (*of_field)(const MPMField &, int i, int component) = nullptr;
};

// customize by adding a line: names of the form group/component can be asked for as group/*

static const ComputeMPMAtom::Quantity quantities[] = {
    {"stress/xx", stress, 0, nullptr},
    {"stress/yy", stress, 1, nullptr},
    {"stress/zz", stress, 2, nullptr},
    {"stress/xy", stress, 3, nullptr},
    {"stress/xz", stress, 4, nullptr},
    {"stress/yz", stress, 5, nullptr},
    {"principal/1", principal, 0, nullptr},
    {"principal/2", principal, 1, nullptr},
    {"principal/3", principal, 2, nullptr},
    {"pressure", pressure, 0, nullptr},
    {"vonmises", vonmises, 0, nullptr},
    {"triaxiality", triaxiality, 0, nullptr},
    {"F/xx", deformation, 0, nullptr},
    {"F/xy", deformation, 1, nullptr},
    {"F/xz", deformation, 2, nullptr},
    {"F/yx", deformation, 3, nullptr},
    {"F/yy", deformation, 4, nullptr},
    {"F/yz", deformation, 5, nullptr},
    {"F/zx", deformation, 6, nullptr},
    {"F/zy", deformation, 7, nullptr},
    {"F/zz", deformation, 8, nullptr},
    {"J", jacobian, 0, nullptr},
    {"volume", volume, 0, nullptr},
    {"volume0", volume0, 0, nullptr},
    {"mass", mass, 0, nullptr},
    {"density", density, 0, nullptr},
    {"speed", speed, 0, nullptr},
    {"energy", nullptr, 0, energy},
    {"wavespeed", nullptr, 0, wavespeed},
    {"angmom/x", nullptr, 0, nullptr, angmom},
    {"angmom/y", nullptr, 1, nullptr, angmom},
    {"angmom/z", nullptr, 2, nullptr, angmom},
};

static const ComputeMPMAtom::Quantity *find_quantity(const std::string &name)
{
  for (const auto &quantity : quantities)
    if (name == quantity.name) return &quantity;
  return nullptr;
}

/* ---------------------------------------------------------------------- */

bool ComputeMPMAtom::known(const std::string &name)
{
  return find_quantity(expand(name)[0]) != nullptr;
}

std::vector<std::string> ComputeMPMAtom::expand(const std::string &name)
{
  std::vector<std::string> names;
  if (name.size() > 2 && name.compare(name.size() - 2, 2, "/*") == 0) {
    const std::string group = name.substr(0, name.size() - 1);
    for (const auto &quantity : quantities)
      if (group.compare(0, group.size(), quantity.name, 0, group.size()) == 0)
        names.emplace_back(quantity.name);
  }
  if (names.empty()) names.push_back(name);
  return names;
}

/* ---------------------------------------------------------------------- */

ComputeMPMAtom::ComputeMPMAtom(LAMMPS *lmp, int narg, char **arg) :
    Compute(lmp, narg, arg), points(MPMPoints::get(atom)), nmax(0)
{
  if (narg < 4) utils::missing_cmd_args(FLERR, "compute mpm/atom", error);
  if (!points)
    error->all(FLERR, 2, "Compute mpm/atom requires material points: use atom_style mpm");

  for (int iarg = 3; iarg < narg; iarg++)
    for (const auto &name : expand(arg[iarg])) {
      const auto *quantity = find_quantity(name);
      if (!quantity && name.find('*') != std::string::npos)
        error->all(FLERR, iarg,
                   "Unknown compute mpm/atom quantities {}: wildcards are F/*, "
                   "stress/*, principal/*, and angmom/*",
                   name);
      columns.push_back({name, quantity});
    }

  peratom_flag = 1;
  size_peratom_cols = columns.size() == 1 ? 0 : (int) columns.size();
}

/* ---------------------------------------------------------------------- */

ComputeMPMAtom::~ComputeMPMAtom()
{
  memory->destroy(vector_atom);
  memory->destroy(array_atom);
}

/* ---------------------------------------------------------------------- */

std::string ComputeMPMAtom::known_names() const
{
  std::string text;
  for (const auto &quantity : quantities) text += fmt::format(" {}", quantity.name);

  std::set<std::string> history;
  for (const auto &fix : modify->get_fix_by_style("^mpm/material$"))
    for (const auto &variable : dynamic_cast<FixMPMMaterial *>(fix)->material->history())
      history.insert(variable.name);
  text += history.empty() ? "; the materials have no history variables"
                          : "; history variables of the materials:";
  for (const auto &name : history) text += " " + name;
  return text;
}

/* ---------------------------------------------------------------------- */

void ComputeMPMAtom::init()
{
  points = MPMPoints::get(atom);
  if (!points)
    error->all(FLERR, Error::NOLASTLINE,
               "Compute {} of style mpm/atom requires material points: use atom_style mpm", id);

  for (const auto &column : columns) {
    if (column.quantity) continue;
    bool found = false;
    for (const auto &fix : modify->get_fix_by_style("^mpm/material$"))
      found |= dynamic_cast<FixMPMMaterial *>(fix)->find_history(column.name) >= 0;
    if (!found)
      error->all(FLERR, Error::NOLASTLINE,
                 "Unknown quantity {} in compute {} of style mpm/atom; "
                 "known are:{}",
                 column.name, id, known_names());
  }
}

/* ---------------------------------------------------------------------- */

bool ComputeMPMAtom::is_point(int i) const
{
  return (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0;
}

/** First value of column n; the stride from point to point is the number of columns. */
double *ComputeMPMAtom::column(int n)
{
  return size_peratom_cols == 0 ? vector_atom : (nmax > 0 ? &array_atom[0][n] : nullptr);
}

/* ---------------------------------------------------------------------- */

void ComputeMPMAtom::compute_peratom()
{
  invoked_peratom = update->ntimestep;

  if (atom->nmax > nmax) {
    nmax = atom->nmax;
    if (size_peratom_cols == 0) {
      memory->destroy(vector_atom);
      memory->create(vector_atom, nmax, "mpm/atom:vector");
    } else {
      memory->destroy(array_atom);
      memory->create(array_atom, nmax, size_peratom_cols, "mpm/atom:array");
    }
  }

  const int nlocal = atom->nlocal;
  const int stride = (int) columns.size();
  bool batches = false;

  for (int n = 0; n < stride; n++) {
    double *out = column(n);
    const auto *quantity = columns[n].quantity;
    if (quantity && quantity->of_point) {
      for (int i = 0; i < nlocal; i++) {
        double &value = out[(bigint) i * stride];
        if (is_point(i)) {
          double stress[6];
          points->cauchy(i, stress);
          const Point p = {points->F[i],
                           stress,
                           atom->v[i],
                           atom->rmass[i],
                           points->jacobian(i) * atom->vfrac[i],
                           atom->vfrac[i]};
          value = quantity->of_point(p, quantity->component);
        } else {
          value = 0.0;
        }
      }
    } else {
      for (int i = 0; i < nlocal; i++) out[(bigint) i * stride] = 0.0;
      if (quantity && quantity->of_batch)
        batches = true;
      else if (quantity)
        field_column(*quantity, out, stride);
      else
        history_column(columns[n].name, out, stride);
    }
  }

  if (batches)
    visit_point_batches(
        lmp, groupbit, [&](const Batch &batch, const int *list, const FixMPMMaterial &material) {
          double value[BATCH];
          for (int n = 0; n < stride; n++) {
            const auto *quantity = columns[n].quantity;
            if (!quantity || !quantity->of_batch) continue;
            quantity->of_batch(*material.material, batch, 1.0 / force->nktv2p, value);
            double *out = column(n);
            for (int k = 0; k < batch.n; k++) out[(bigint) list[k] * stride] = value[k];
          }
        });
}

/** What fix mpm knows of its points. */
void ComputeMPMAtom::field_column(const Quantity &quantity, double *out, int stride)
{
  for (const auto *each : MPMField::all(lmp)) {
    const auto &field = *each;
    for (int i = 0; i < atom->nlocal; i++)
      if (is_point(i) && field.is_point(i))
        out[(bigint) i * stride] = quantity.of_field(field, i, quantity.component);
  }
}

/** History variable of the points whose material has it; the others keep their value. */
void ComputeMPMAtom::history_column(const std::string &name, double *out, int stride)
{
  for (const auto *field : MPMField::all(lmp)) {
    for (const auto *material : field->materials) {
      const int index = material->find_history(name);
      if (index < 0) continue;
      for (int i = 0; i < atom->nlocal; i++)
        if (is_point(i) && field->is_point(i) && field->material_of(i) == material)
          out[(bigint) i * stride] = material->history[i][index];
    }
  }
}

/* ---------------------------------------------------------------------- */

double ComputeMPMAtom::memory_usage()
{
  return (double) nmax * columns.size() * sizeof(double);
}
