/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_geostatic_command.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_gravity.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_point_batches.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "modify.h"
#include "pore/fix_mpm_mixture.h"
#include "pore/mpm_geostatic.h"
#include "step/fix_mpm.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Part = MPMGeostatic::Part;
using Matrix = Eigen::MatrixXd;

/** mpm_geostatic fix-ID K0. */
void MPMGeostaticCommand::command(int narg, char **arg)
{
  const int iarg = 0;
  std::string id;
  double K0 = 0.0;
  Options options("mpm_geostatic");
  options.argument(option::text(id, "fix-ID"));
  options.argument(option::number(K0, "K0", NOT_NEGATIVE));
  read_options(lmp, options, narg, arg, 0);

  MPMField *const field = MPMField::find(lmp, id);
  if (!field)
    error->all(FLERR, iarg, "Mpm_geostatic: there is no fix mpm with the ID {}: define it first",
               id);
  check_fixes();
  check_field(*field);
  lmp->init();

  double gravity[3];
  MPMGravity(lmp, "Mpm_geostatic").find(gravity);
  const auto *const mixture = mixture_of(*field);
  MPMGeostatic ground(lmp, *field, gravity, "Mpm_geostatic");
  std::vector<double> carried;
  if (mixture) carried = MPMGeostaticWater(lmp, ground, *mixture, "Mpm_geostatic").set_pressure();
  const auto none = [](int) {
    return 0.0;
  };
  ground.set_stress(K0, none, carried);
  dynamic_cast<FixMPM *>(modify->get_fix_by_id(id))->rests_dry =
      true;    // fix mpm/pore may come later
  const auto &where = ground.ground();
  if (comm->me == 0)
    utils::logmesg(lmp, "Level ground at rest: {:.6g} high, weight {:.6g} per mass, K0 {:.6g}\n",
                   where.top - where.floor, where.weight, K0);
}

/** The water of these changes what is in equilibrium. */
void MPMGeostaticCommand::check_fixes()
{
  if (!modify->get_fix_by_style("^mpm/pore$").empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Mpm_geostatic does not know pore water: use keyword geostatic of fix mpm/pore");
}

/** That of which the field is the soil, or null. */
const FixMPMMixture *MPMGeostaticCommand::mixture_of(const MPMField &field)
{
  for (auto *fix : modify->get_fix_by_style("^mpm/mixture$")) {
    const auto *const mixture = dynamic_cast<FixMPMMixture *>(fix);
    if (!mixture->has(field.id())) continue;
    if (strcmp(mixture->soil_field(), field.id()) != 0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Mpm_geostatic: fix mpm {} is the water of fix mpm/mixture {}: name that of the "
                 "soil, {}, and the water gets its pressure, too",
                 field.id(), fix->id, mixture->soil_field());
    check_field(*MPMField::find(lmp, mixture->water_field()));
    return mixture;
  }
  return nullptr;
}

/** Of a refined body, one lattice has a part of the points, and nodes at its rim belong to both. */
void MPMGeostaticCommand::check_field(const MPMField &field)
{
  for (const auto *body : find_fixes<MPMRefinedBody>(lmp))
    if (body->has(field.id()))
      error->all(FLERR, Error::NOLASTLINE,
                 "Mpm_geostatic: fix mpm {} has only a part of the points of fix {} (style {}), "
                 "and the weight of the others would be missing: let the ground come to rest under "
                 "its weight with fix mpm/relax, or use one lattice",
                 field.id(), dynamic_cast<const Fix *>(body)->id,
                 dynamic_cast<const Fix *>(body)->style);
  const auto &o = field.options;
  refuse_field(
      lmp, "Mpm_geostatic", field,
      {{o.shape != QUADRATIC && o.shape != CUBIC, "this shape", "use shape quadratic or cubic"},
       {o.total, "frame total", "use frame updated"},
       {o.axisymmetric, "axisymmetric", "use a plane or 3d"},
       {o.modified_edges, "edges modified", "use edges plain"},
       {o.averages_stress() || o.averages_volume() || o.averages_strain(), "locking",
        "its averages have other forces: use locking none"}});
}

/* ----------------------------------------------------------------------
   Soil and water of fix mpm/mixture are at rest if at each plane of nodes j

     (1 - s_j) P_j = sum_w m_w g N_jw,
     sum_s V_s s'_s N'_js + s_j P_j = - sum_s m_s g N_js   (stress s', tension positive),

   with the force of the pressure in the volumes of water and grains, and the share s_j of it that
   soil bears (fix_mpm_mixture.cpp),

     P_j = sum_w V_w p_w N'_jw + sum_s V_g,s p_s N'_js,
     p_s = sum_i N_is c_i sum_w N_iw V_w p_w / sum_w N_iw V_w.

   The first equation is one for the pressures alone: with

     p_w = rho g (top - y_w) + sum_k lambda_k psi_k'(y_w)

   and the functions psi_k of the height that nodes can have as velocities (mpm_geostatic.cpp), it
   is linear in lambda, and of its solutions the smallest is taken. What the second one then has of
   P_j, the water carries. Points have their pressure by the change of their volume, with which V_w
   changes a little, so that this is repeated until it stays the same.
------------------------------------------------------------------------- */

static constexpr int BAND = MPMGeostatic::BAND;
static constexpr int ROUNDS = 8;
static constexpr double AT_REST = 1.0e-9;    // forces that are left over, in parts of the weight
static constexpr double SAME = 1.0e-6;       // differences of pressures, of the largest one

MPMGeostaticWater::MPMGeostaticWater(LAMMPS *lmp, const MPMGeostatic &ground,
                                     const FixMPMMixture &mixture, const std::string &who) :
    Pointers(lmp),
    ground(ground), mixture(mixture), soil(*MPMField::find(lmp, mixture.soil_field())),
    water(*MPMField::find(lmp, mixture.water_field())), who(who)
{
  find_water();
}

/** Its surface and density, and the planes of nodes that soil and water see. */
void MPMGeostaticWater::find_water()
{
  double mine[2] = {0.0, 0.0}, sums[2], most[2] = {-1.0e300, 0.0},
         all[2];    // mass, volume; surface, planes
  Part list[BAND];
  for (int i = 0; i < atom->nlocal; i++) {
    const bool wet = water.is_point(i);
    if (!wet && !soil.is_point(i)) continue;
    const int n = ground.planes(wet ? water : soil, i, list);
    most[1] = std::max(most[1], (double) list[n - 1].k);
    if (!wet) continue;
    mine[0] += atom->rmass[i];
    mine[1] += atom->vfrac[i];
    most[0] =
        std::max(most[0], ground.height(i) + 0.5 * pow(atom->vfrac[i], 1.0 / water.lattice.dim));
  }
  MPI_Allreduce(mine, sums, 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(most, all, 2, MPI_DOUBLE, MPI_MAX, world);
  if (!(sums[1] > 0.0))
    error->all(FLERR, Error::NOLASTLINE, "{}: fix mpm {} has no points of water", who, water.id());
  density = sums[0] / sums[1];
  surface = all[0];
  nplanes = (int) all[1] + 1;
}

/** [3][nplanes] volumes of grains, of soil with its pores, and of water. */
void MPMGeostaticWater::find_volumes(std::vector<double> &volumes) const
{
  std::vector<double> mine(3 * nplanes, 0.0);
  volumes.resize(mine.size());
  Part list[BAND];
  for (int i = 0; i < atom->nlocal; i++) {
    const bool wet = water.is_point(i);
    if (!wet && !soil.is_point(i)) continue;
    const MPMField &field = wet ? water : soil;
    const double V = atom->vfrac[i] * field.points->jacobian(i);
    const int n = ground.planes(field, i, list);
    for (int j = 0; j < n; j++) {
      const auto at = [&](int row) -> double & {
        return mine[row * nplanes + std::max(0, list[j].k)];
      };
      if (wet) {
        at(2) += list[j].value * V;
      } else {
        at(0) += list[j].value * atom->rmass[i] / mixture.density_of_grains();
        at(1) += list[j].value * V;
      }
    }
  }
  MPI_Allreduce(mine.data(), volumes.data(), (int) mine.size(), MPI_DOUBLE, MPI_SUM, world);
}

/** Volumes of points of water with which their law gives these pressures [n], by Newton's method. A
 *  law without stiffness, as of water that has come apart, is strained towards where it may have
 *  some. Returns by how much pressures differ at the most. */
double MPMGeostaticWater::strain(const std::vector<double> &pressure) const
{
  constexpr int TURNS = 30;
  constexpr double DIFFERENCE = 1.0e-6, MOST = 0.1, CLOSE = 1.0e-14;
  Batch &batch = *water.batch;
  double now[2][BATCH], worst = 0.0;
  each_material_batch(water, [&](const std::vector<int> &list, const FixMPMMaterial *material) {
    const auto evaluate = [&](double shift, double *p) {
      load_state(water, batch, list.data(), (int) list.size(), material);
      batch.dt = 1.0;
      for (auto &row : batch.A) std::fill(row, row + batch.n, 0.0);
      for (int k = 0; k < batch.n; k++) {
        batch.J[k] *= 1.0 + shift;
        batch.Jold[k] = batch.J[k];
        batch.heat[k] = batch.plastic[k] = 0.0;
      }
      material->material->update(batch);
      for (int k = 0; k < batch.n; k++)
        p[k] = -(batch.stress[0][k] + batch.stress[1][k] + batch.stress[2][k]) / 3.0;
    };
    const int axis = ground.ground().axis;
    for (int turn = 0; turn < TURNS; turn++) {
      evaluate(0.0, now[0]);
      evaluate(-DIFFERENCE, now[1]);
      bool same = true;
      for (std::size_t k = 0; k < list.size(); k++) {
        const double stiffness = (now[1][k] - now[0][k]) / DIFFERENCE,
                     more = now[0][k] - pressure[list[k]];
        double change = 0.0;
        if (stiffness > 0.0)
          change = std::clamp(more / stiffness, -MOST, MOST);
        else if (more != 0.0)
          change = std::copysign(MOST, more);
        same = same && fabs(change) <= CLOSE;
        water.points->F[list[k]][4 * axis] *= 1.0 + change;
      }
      if (same) break;
    }
    evaluate(0.0, now[0]);
    for (std::size_t k = 0; k < list.size(); k++) {
      for (int c = 0; c < 6; c++)
        water.points->tau[list[k]][c] = c < 3 ? -batch.J[k] * now[0][k] : 0.0;
      const double differs = fabs(now[0][k] - pressure[list[k]]);
      worst = differs <= worst ? worst : differs;    // also if it is not a number
    }
  });
  return worst;
}

void MPMGeostaticWater::check_rest(const std::vector<double> &pressure, double differs,
                                   double left) const
{
  double mine[2] = {0.0, std::isfinite(differs) ? differs : 1.0e300}, most[2];
  for (int i = 0; i < atom->nlocal; i++)
    if (water.is_point(i)) mine[0] = std::max(mine[0], fabs(pressure[i]));
  MPI_Allreduce(mine, most, 2, MPI_DOUBLE, MPI_MAX, world);
  if (!(most[1] <= SAME * most[0]))
    error->all(
        FLERR, Error::NOLASTLINE,
        "{}: the material of the water of fix mpm {} does not have the pressure at rest at any "
        "volume, up to {:.4g} at its bottom: use a larger bulk modulus",
        who, water.id(), most[0]);
  if (!(left <= AT_REST))
    error->all(FLERR, Error::NOLASTLINE,
               "{}: no pressure of the water of fix mpm {} is at rest, as {:.2g} of its weight is "
               "left over: it needs a level surface, at or above that of the soil",
               who, water.id(), left);
}

std::vector<double> MPMGeostaticWater::set_pressure()
{
  const double h = water.lattice.h, g = ground.ground().weight * force->nktv2p;
  const int n = nplanes;
  std::vector<double> pressure(atom->nmax, 0.0), volumes, lambda(n, 0.0), carried;
  Part list[BAND];
  double differs = 0.0;
  const auto lump = [&](int plane, double &value) {
    return ground.function_of(plane, value);
  };
  const auto set = [&]() {
    for (int i = 0; i < atom->nlocal; i++) {
      if (!water.is_point(i)) continue;
      pressure[i] = density * g * (surface - ground.height(i));
      const int m = ground.planes(water, i, list);
      for (int j = 0; j < m; j++) {
        double value;
        const int k = lump(list[j].k, value);
        pressure[i] += lambda[k] * value * list[j].slope;
      }
    }
    differs = strain(pressure);
  };

  double left = 1.0;
  for (int round = 0; round < ROUNDS && left > 0.01 * AT_REST; round++) {
    set();
    find_volumes(volumes);

    // sums over water: V N'_j N'_m, V N_i N'_m, V N'_j p, V N_i p, m g N_j; over grains: V N'_j N_i

    const int size = 3 * n * n + 3 * n;
    std::vector<double> mine(size, 0.0), all(size);
    double *const A = mine.data(), *const B = A + n * n, *const G = B + n * n, *const a = G + n * n,
                  *const b = a + n, *const weight = b + n;
    for (int i = 0; i < atom->nlocal; i++) {
      const bool wet = water.is_point(i);
      if (!wet && !soil.is_point(i)) continue;
      const int m = ground.planes(wet ? water : soil, i, list);
      const double V = wet ? atom->vfrac[i] * water.points->jacobian(i)
                           : atom->rmass[i] / mixture.density_of_grains();
      for (int p = 0; p < m; p++) {
        const int j = std::max(0, list[p].k);
        if (wet) {
          a[j] += V * pressure[i] * list[p].slope;
          b[j] += V * pressure[i] * list[p].value;
          weight[j] += atom->rmass[i] * g * h * list[p].value;
        }
        for (int q = 0; q < m; q++) {
          const int k = std::max(0, list[q].k);
          if (wet) {
            A[n * j + k] += V * list[p].slope * list[q].slope;
            B[n * j + k] += V * list[p].value * list[q].slope;
          } else {
            G[n * j + k] += V * list[p].slope * list[q].value;
          }
        }
      }
    }
    MPI_Allreduce(mine.data(), all.data(), size, MPI_DOUBLE, MPI_SUM, world);
    using Rows = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
    using Column = Eigen::Map<Eigen::VectorXd>;
    double *const from = all.data();
    const Rows AA(from, n, n), BB(from + n * n, n, n), GG(from + 2 * n * n, n, n);
    const Column aa(from + 3 * n * n, n), bb(from + 3 * n * n + n, n),
        ww(from + 3 * n * n + 2 * n, n);

    // of planes, then of functions of the height

    Eigen::VectorXd mean = Eigen::VectorXd::Zero(n), share = Eigen::VectorXd::Zero(n);
    for (int j = 0; j < n; j++) {
      const double solid = volumes[j], with_pores = volumes[n + j], wet = volumes[2 * n + j];
      if (solid > 0.0 && !(wet > 0.0)) share[j] = 1.0;
      if (!(solid > 0.0 && wet > 0.0)) continue;
      const MPMMixtureShares of(solid, with_pores, wet);
      share[j] = of.soil_share;
      mean[j] = of.filled / wet;
    }
    Matrix to = Matrix::Zero(n, n);
    for (int j = 0; j < n; j++) {
      double value;
      const int k = lump(j, value);
      to(k, j) = value;
    }
    const Matrix whole = AA + GG * mean.asDiagonal() * BB;
    const Eigen::VectorXd now = aa + GG * mean.asDiagonal() * bb;
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n), of_water = ones - share;
    const Eigen::VectorXd missing = to * (ww - of_water.asDiagonal() * now);
    left = missing.cwiseAbs().maxCoeff() / ww.sum();
    const Eigen::VectorXd of_soil = to * (share.asDiagonal() * now);
    carried.assign(of_soil.data(), of_soil.data() + n);
    const Matrix system = to * of_water.asDiagonal() * whole * to.transpose();
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
    solver.setThreshold(1.0e-10);
    solver.compute(system);
    const Eigen::VectorXd change = solver.solve(missing);
    for (int k = 0; k < n && left > 0.01 * AT_REST; k++) lambda[k] += change[k];
  }
  check_rest(pressure, differs, left);
  return carried;
}
