/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_force_balance.h"

#include "solve/spline_multigrid.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMForceBalance::MPMForceBalance(MPMSolvedNodes &nodes, const MPMTimeMethod &time) :
    nodes(nodes), time(time)
{
  for (const auto &body : nodes.bodies)
    tangents.push_back(std::make_unique<MPMTangent>(nodes.lmp, body.field));
}

void MPMForceBalance::init()
{
  for (auto &tangent : tangents) tangent->init();
}

void MPMForceBalance::begin_step(double step_dt)
{
  dt = step_dt;
  share = time.displacement_share();
  end_share = time.force_share();
  inertia_factor = time.inertia_factor(dt);
  for (auto *list : {&external, &internal, &predictor}) list->assign(nodes.nreals(), 0.0);
}

void MPMForceBalance::find_external_forces()
{
  for (std::size_t k = 0; k < tangents.size(); k++)
    tangents[k]->external_forces(external.data() + first(k));
}

void MPMForceBalance::stabilize(double factor)
{
  std::vector<double> moduli;
  for (std::size_t k = 0; k < tangents.size(); k++) {
    auto &field = nodes.bodies[k].field;
    if (k == stabilizations.size())
      stabilizations.push_back(std::make_unique<MPMNodeStabilization>(nodes.lmp, field));
    const std::vector<double> still(nodes.width * field.grid.nnodes(), 0.0);
    tangents[k]->linearize(still.data(), time_of_forces());
    tangents[k]->find_moduli(moduli);
    stabilizations[k]->begin_step(factor, moduli);
  }
}

void MPMForceBalance::find_start_forces()
{
  if (!(end_share < 1.0)) return;
  const double alpha_f = time.coefficients().alpha_f;
  start_forces.resize(nodes.nreals());
  for (int64_t k = 0; k < nodes.nreals(); k++)
    start_forces[k] = alpha_f *
        (nodes.mass[k / nodes.width] * (nodes.explicit_velocity[k] - nodes.start_velocity[k]) / dt -
         external[k]);
}

const double *MPMForceBalance::scaled(const std::vector<double> &u)
{
  if (share == 1.0) return u.data();
  partial.resize(u.size());
  for (std::size_t k = 0; k < u.size(); k++) partial[k] = share * u[k];
  return partial.data();
}

bool MPMForceBalance::find_residual(const std::vector<double> &u, std::vector<double> &residual,
                                    std::vector<double> &inertia_forces, double &stress)
{
  const double *const motion = scaled(u);
  bool good = true;
  stress = 0.0;
  for (std::size_t k = 0; k < tangents.size(); k++) {
    const double *const mine = motion + first(k);
    double *const force = internal.data() + first(k), sum;
    good = tangents[k]->forces(mine, time_of_forces(), force, sum) && good;
    if (good && is_stabilized()) stabilizations[k]->add_forces(mine, force);
    stress += sum;
  }
  if (!good) return false;
  nodes.each_entry([&](int64_t n, int64_t k) {
    const double pull = inertia(n) * (u[k] - predictor[k]);
    residual[k] = external[k] + end_share * internal[k] - pull;
    inertia_forces[k] = pull;
  });
  if (end_share < 1.0)
    nodes.each_entry([&](int64_t, int64_t k) {
      residual[k] += start_forces[k];
    });
  return true;
}

double MPMForceBalance::linearize(const std::vector<double> &u, double &asymmetry)
{
  const double *const motion = scaled(u);
  double stiffness = 0.0;
  asymmetry = 0.0;
  for (std::size_t k = 0; k < tangents.size(); k++) {
    stiffness += tangents[k]->linearize(motion + first(k), time_of_forces());
    asymmetry = std::max(asymmetry, tangents[k]->asymmetry());
  }
  return stiffness;
}

void MPMForceBalance::change_of_forces(const double *du, double *dforce)
{
  for (std::size_t k = 0; k < tangents.size(); k++) {
    tangents[k]->change_of_forces(du + first(k), dforce + first(k));
    if (is_stabilized()) stabilizations[k]->add_forces(du + first(k), dforce + first(k));
  }
}

void MPMForceBalance::apply(const double *x, double *y)
{
  change_of_forces(x, y);
  for (int64_t n = 0, k = 0; n < nodes.nnodes(); n++)
    for (int d = 0; d < nodes.width; d++, k++)
      y[k] = nodes.mass[n] > 0.0 ? inertia(n) * x[k] - end_share * share * y[k] : 0.0;
}

void MPMForceBalance::find_blocks(std::vector<double> &blocks)
{
  const int width = nodes.width;
  if (tangents.size() == 1) {
    tangents[0]->diagonal(blocks);
  } else {
    blocks.clear();
    for (auto &tangent : tangents) {
      tangent->diagonal(blocks_of_body);
      blocks.insert(blocks.end(), blocks_of_body.begin(), blocks_of_body.end());
    }
  }
  for (std::size_t k = 0; k < stabilizations.size(); k++) {
    const auto &stiffness = stabilizations[k]->diagonal();
    for (std::size_t n = 0; n < stiffness.size(); n++)
      for (int d = 0; d < width; d++)
        blocks[width * width * (nodes.bodies[k].first + n) + (width + 1) * d] += stiffness[n];
  }
  for (double &entry : blocks) entry *= end_share * share;
  for (int64_t n = 0; n < nodes.nnodes(); n++)
    for (int d = 0; d < width; d++) blocks[width * width * n + (width + 1) * d] += inertia(n);
}

void MPMForceBalance::add_stiffness(SplineMultigrid &levels)
{
  std::vector<double> scaled;
  const double factor = end_share * share;
  const auto add = [&](int n, const int64_t *points, int ngrad, const double *gradient,
                       const double *stiffness) {
    if (factor != 1.0) {
      scaled.assign(stiffness, stiffness + (std::size_t) nodes.width * ngrad * nodes.width * ngrad);
      for (double &entry : scaled) entry *= factor;
      stiffness = scaled.data();
    }
    levels.add_point(n, points, ngrad, gradient, stiffness);
  };
  tangents[0]->each_point(add);
  tangents[0]->each_mean([&](int64_t around, int material, const double sums[3], int n,
                             const int64_t *points, const double *changes) {
    const double of_part[] = {factor * sums[0], sums[1], sums[2]};
    levels.add_mean(around, material, of_part, n, points, changes);
  });
  if (is_stabilized()) stabilizations[0]->each_term(add);
}

/** That of a strain, and of the part of the strain that comes from motions larger than a node
 *  spacing. The motion is a mean over the mass, because nodes at the very end of the functions of
 *  points have next to no mass and move far. */
double MPMForceBalance::negligible_forces(const std::vector<double> &u, double stiffness) const
{
  return ROUND_OFF * stiffness * std::max(1.0, 4.0 * nodes.mean_size(u) / nodes.spacing());
}

void MPMForceBalance::find_loads(const std::vector<double> &u)
{
  loads.assign(nodes.nreals(), 0.0);
  load_changes = loads;
  for (std::size_t k = 0; k < tangents.size(); k++) {
    auto &tangent = *tangents[k];
    if (!tangent.has_loads()) continue;
    tangent.loads(loads.data() + first(k), load_changes.data() + first(k));    // without any motion
    std::swap_ranges(loads.begin() + first(k), loads.begin() + nodes.width * nodes.bodies[k].end(),
                     load_changes.begin() + first(k));
    tangent.loads(scaled(u) + first(k), load_changes.data() + first(k));
  }
  for (int64_t k = 0; k < nodes.nreals(); k++) load_changes[k] -= loads[k];
}

double MPMForceBalance::find_stabilizing_forces(const std::vector<double> &u)
{
  double mine = 0.0, all;
  stabilizing_forces.assign(nodes.nreals(), 0.0);
  for (std::size_t k = 0; k < stabilizations.size(); k++) {
    stabilizations[k]->add_forces(u.data() + first(k), stabilizing_forces.data() + first(k));
    mine += 0.5 * stabilizations[k]->twice_energy();
  }
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, nodes.lmp->world);
  return all;
}

double MPMForceBalance::memory_usage() const
{
  double bytes = bytes_of(external, predictor, loads, load_changes, stabilizing_forces, internal,
                          partial, blocks_of_body, start_forces);
  for (const auto &tangent : tangents) bytes += tangent->memory_usage();
  for (const auto &stabilization : stabilizations) bytes += stabilization->memory_usage();
  return bytes;
}
