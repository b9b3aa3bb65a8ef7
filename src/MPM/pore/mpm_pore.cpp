/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Soil and its pore water as one set of points with the velocity v of the soil (u-p). With the
   pressure p of the water, compression positive,

     rho dv/dt = div(sigma' - alpha p I) + rho g,
     S dp/dt = - alpha div v - div w,   w = - k (grad p - rho_f g),   S = n/K_f + (alpha - n)/K_s,

   sigma' is the stress of the material, w the volume of water that flows through a unit of area,
   and k the mobility. The acceleration of the water relative to that of the soil is neglected;
   mpm_pore_motion.cpp has it (u-v-p). With Forchheimer's term, -(grad p - rho_f g) = w/k + b |w| w.

   On nodes, with C_p = S_p V_p, and D the matrix of sum_p alpha V_p N_ip grad N_jp,

     p_i = sum_p C_p N_ip (p_p + g_p . (x_i - x_p))/C_i,
     M dv/dt = ... + D^T p,    C dp/dt = - D v - ...,

   so that the pressure sum_i N_ip p_i of each point acts in forces, and the volume that the motion
   squeezes out goes to nodes with the same weights: the water stores the work that the pressure
   takes from the motion. If points had their own pressures in forces, several points per cell would
   ask for more constraints than the velocities of the nodes can satisfy (locking). As D maps onto
   what D^T sees, motion never excites pressures that make no force on nodes, such as one that
   alternates from node to node. Only drained faces do, see mpm_pore_surface.cpp.

   Time. The update of p uses the new v: symplectic Euler, stable up to 2/omega of undrained waves
   without flow. An explicit step of the flow multiplies a pressure by a = 1 - lambda dt; together
   they are stable up to (omega dt)^2 < 2 (1 + a): not at all near the explicit limit a = -1. Stages
   of RKL2 have a > 0 whatever their number is. Hence stages begin at half of that limit, and waves
   and flow do not reduce each other's limit. A flow for several steps has one stage up to the full
   limit: this is the limit of nodes at a corner that hardly see a point, and of points in the
   middle of cells, where alternating pressures make no force.

   The motion changes the volume of a point by exactly det(I + dt L) - 1, and water fills the
   change.
------------------------------------------------------------------------- */

#include "pore/mpm_pore.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_node_sums.h"
#include "field/mpm_passes.h"
#include "force.h"
#include "material/material.h"
#include "material/material_point.h"
#include "math/matrix.h"
#include "step/mpm_stages.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMPore::MPMPore(LAMMPS *lmp, MPMField &field, const MPMPoreWater &water,
                 const MPMPoreSurface::Conditions &conditions, const double *gravity, double relax,
                 bool moves) :
    Pointers(lmp),
    field(field), nodes(field), surface(lmp, field, conditions, water, gravity), water(water),
    gravity(gravity), relax(relax)
{
  if (moves) motion = std::make_unique<MPMPoreMotion>(lmp, field, water.density, gravity);
}

void MPMPore::init(const std::vector<MPMPoreSoil> &all, double *const &content,
                   double *const &of_points)
{
  warmth = nullptr;
  soils.clear();
  quadratic.clear();
  bool dries = false;
  const std::vector<signed char> here = field.present_materials();
  slowest = waves = least_storage = std::numeric_limits<double>::max();
  of_storage = 0.0;
  for (std::size_t k = 0; k < here.size(); k++)
    for (const auto &one : all) {
      const auto *const fix = field.materials[k];
      if (here[k] && one.material == fix->id) {
        const double storage = one.storage_at(1.0, water);
        const double unit = force->mvv2e * force->nktv2p;
        soils.push_back({fix, one, one.warms ? fix->temperature() : -1});
        if (one.warms) warmth = &of_points;
        if (!one.is_linear()) quadratic.resize(1);
        least_storage = std::min(least_storage, storage);
        slowest = std::min(slowest, one.permeability / (water.resistance * storage));
        waves = std::min(waves, one.biot / sqrt(storage * fix->material->density() * unit));
        const double c = MaterialPoint(*fix->material).wave_speed(),
                     M = unit * fix->material->density() * c * c;
        if (M > 0.0)
          of_storage = std::max(of_storage, storage / (storage + one.biot * one.biot / M));
        dries = dries || one.retention.can_dry();
      }
    }
  nodes.init(true, surface.any());
  suction.reset();
  if (dries) suction = std::make_unique<MPMPoreSuction>(lmp, field, water, content);
  init_layers();
  // with interfaces, a line through the values of nodes does not give the permeability next to the
  // surface
  const bool varies = !layers && std::any_of(soils.begin(), soils.end(), [](const auto &s) {
    return s.of.law != MPMPoreSoil::CONSTANT;
  });
  if (surface.any()) surface.init(dries, varies);
  steepest = steepest_function(field);
}

/** Sets up means next to interfaces for soils of different permeability in one field
 *  (mpm_layer_mean.cpp). A single soil whose permeability depends on its porosity needs none: the
 *  permeability varies as smoothly as the strain, and MPMPoreSurface::mobility_to_surface() covers
 *  the flow through a crust at a drained surface. In soil that dries, the means are those of full
 *  pores, and each point has its own relative permeability: this changes by orders of magnitude
 *  within a front, and with means across the front, water would not get into dry soil. The square
 *  of the flow has a mean across interfaces, too; along them points then keep their own resistance,
 *  as flows with one gradient and different laws have no common one. */
void MPMPore::init_layers()
{
  layers.reset();
  bool differ = false;
  double greatest = 0.0, fastest_soil = 0.0;
  for (const auto &s : soils) {
    const auto &first = soils.front().of;
    differ = differ || s.of.law == MPMPoreSoil::FORMULA || s.of.law != first.law ||
        s.of.permeability != first.permeability || s.of.quadratic != first.quadratic ||
        s.of.diameter != first.diameter;
    greatest = std::max(greatest, s.of.permeability);
    fastest_soil = std::max(fastest_soil, s.of.permeability / s.of.storage_at(1.0, water));
  }
  if (!differ) return;
  // with formulas the permeabilities are not known, while capacities hardly differ
  const bool along =
      !motion && quadratic.empty() && greatest <= MPMLayerMean::MOST * fastest_soil * least_storage;
  layers = std::make_unique<MPMLayerMean>(field, along);
  layers->init();
}

void MPMPore::weigh_points(const MPMRows &state) const
{
  if (!suction) return;
  for (int i = 0; i < atom->nlocal; i++)
    if (field.is_point(i))
      if (const auto *const s = soil_of(i)) suction->weigh(i, *s, state[i][0]);
}

const MPMPore::Soil *MPMPore::soil(const FixMPMMaterial *fix) const
{
  for (const auto &s : soils)
    if (s.fix == fix) return &s;
  return nullptr;
}

const MPMPoreSoil *MPMPore::soil_of(int i) const
{
  const Soil *const s = soil(field.material_of(i));
  return s ? &s->of : nullptr;
}

double MPMPore::mobility(const Soil &s, int i, double J, const double *formula) const
{
  const bool given = s.of.law == MPMPoreSoil::FORMULA;
  return (given ? formula[i] : s.of.permeability_at(J)) / water.resistance;
}

/** Weight of the water, in pressure per length. */
std::array<double, 3> MPMPore::weight() const
{
  std::array<double, 3> along = {};
  for (int d = 0; d < field.lattice.dim; d++) along[d] = water.density * gravity[d] * force->nktv2p;
  return along;
}

/** Magnitude of a gradient of pressure less that of water at rest. */
double MPMPore::push(const double *gradient) const
{
  const auto at_rest = weight();
  double square = 0.0;
  for (int d = 0; d < field.lattice.dim; d++)
    square += (gradient[d] - at_rest[d]) * (gradient[d] - at_rest[d]);
  return sqrt(square);
}

MPMPoreMotion::Pores MPMPore::pores(const Soil &s, int i, double J, double mobility) const
{
  return {J * atom->vfrac[i], J, s.of.pores_at(J), 1.0 / mobility,
          quadratic.empty() ? 0.0 : quadratic[i]};
}

/** Mobility for the flow through the surface. The flow there is not known yet, so the gradient of
 *  the step before is used. */
double MPMPore::at_surface(const Soil &s, int i, double J, double mobility, const double *row) const
{
  if (motion) return motion->response(i, pores(s, i, J, mobility));
  if (quadratic.empty()) return mobility;
  return secant_mobility(mobility, quadratic[i], push(row + 1));
}

/** Upper bound of the mobility of a point with layers; k: its own mobility. */
double MPMPore::most_of_layers(int i, double k) const
{
  return quadratic.empty() ? layers->most(i) : std::max(k, 1.0 / linear_mean[i]);
}

/** Finds interfaces. With drag by the square of the flow, they are where the resistance changes, at
 *  the flow that points have by their gradient. */
void MPMPore::find_layers(const MPMRows &state, const double *formula)
{
  const double density = inertial_density();
  volumes.resize(atom->nmax);
  // value(soil, point, J, permeability) of points, and their volumes
  const auto each = [&](const auto &value) {
    return [&, value](const MPMPointMap::Run &run, int first, int n, double *values, double *V) {
      const Soil *const s = soil(run.material);
      if (!s) return false;
      double buffer[BATCH];
      const double *const ratios = field.jacobians.get(field, first, n, buffer);
      for (int p = 0; p < n; p++) {
        const int i = first + p;
        V[p] = volumes[i] = ratios[p] * atom->vfrac[i];
        values[p] = value(s->of, i, ratios[p], mobility(*s, i, ratios[p], formula));
      }
      return true;
    };
  };
  if (quadratic.empty()) {
    layers->find(each([](const MPMPoreSoil &, int, double, double k) {
      return k;
    }));
    return;
  }
  layers->find(each([&](const MPMPoreSoil &s, int i, double J, double k) {
    return secant_mobility(k, s.quadratic_at(J, density), push(state[i] + 1));
  }));
  layers->find_means(each([](const MPMPoreSoil &, int, double, double k) {
                       return 1.0 / std::max(k, MPMLayerMean::LEAST);
                     }),
                     linear_mean);
  layers->find_means(each([&](const MPMPoreSoil &s, int, double J, double) {
                       return s.quadratic_at(J, density);
                     }),
                     quadratic_mean);
}

MPMPoreResistance MPMPore::at_interface(int i) const
{
  // across to soil without pores there is no flow; the result must be neither infinite nor, by
  // differences, negative
  const auto least = MPMLayerMean::LEAST;
  if (quadratic.empty())
    return {{1.0 / std::max(layers->across(i), least), 1.0 / std::max(layers->along(i), least)},
            {0.0, 0.0}};
  return {{linear_mean[i], volumes[i] / conductance[i]}, {quadratic_mean[i], quadratic[i]}};
}

/** Limits gradients and pressures of points whose soil can dry, see
 *  MPMPoreSuction::limit_slope(). */
void MPMPore::limit_slopes(const Soil &s, int first, int n, const MPMRows &state,
                           MPMNodeScalar::Rows row) const
{
  const int dim = field.lattice.dim;
  const auto along = weight();
  for (int p = 0; p < n; p++) {
    std::copy_n(state[first + p] + 1, dim, row[p]);
    row[p][3] = state[first + p][0];
    MPMPoreSuction::limit_slope(s.of, row[p][3], along.data(), field.lattice, row[p]);
  }
}

/** Changes the volume of grains and water of points by the change of temperatures after the step
 *  before. */
void MPMPore::expand(const Soil &s, int first, int n, const double *J, const double *V)
{
  for (int p = 0; p < n && s.temperature >= 0; p++) {
    const int i = first + p;
    warm[i] = s.fix->history[i][s.temperature];
    const double before = (*warmth)[i];
    if (before != UNKNOWN) grown[i] = V[p] * s.of.growth_at(J[p]) * (warm[i] - before);
  }
}

void MPMPore::find_shut(const MPMPoreSoil &s, int first, int n, const double *J)
{
  const double grains = s.shut();
  int count = 0;
  for (int p = 0; p < n; p++) count += J[p] <= grains;
  for (int p = 0; count && p < n; p++)
    if (J[p] <= grains) shut = std::min(shut, atom->tag[first + p]);
}

void MPMPore::points_to_nodes(const MPMRows &state, const double *formula)
{
  if (layers) find_layers(state, formula);
  const int dim = field.lattice.dim;
  for (auto *list : {&in_forces, &capacity, &conductance, &mean, &squeezed})
    list->resize(atom->nmax);
  const bool open = surface.any(), plain = !suction && !open && quadratic.empty();
  if (!quadratic.empty()) quadratic.resize(atom->nmax);
  const double density = inertial_density();
  if (warmth)
    for (auto *list : {&grown, &warm}) clear_points(*list, atom);
  if (suction) suction->begin(atom->nmax, rate_of_lag(), rate_of_waves());
  fastest = exchange = largest = 0.0;
  if (waiting) lie.assign(soils.size(), {});
  shut = MAXTAGINT;
  nodes.points_to_nodes(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Points &points) {
        const Soil *const s = soil(run.material);
        if (!s) {
          std::fill(&in_forces[run.first], &in_forces[run.first] + (run.last - run.first), 0.0);
          return false;
        }
        double *const C = capacity.data() + first, *const K = conductance.data() + first,
                      *const part = in_forces.data() + first;
        double buffer[BATCH], *const V = squeezed.data() + first;
        const double *const J = field.jacobians.get(field, first, n, buffer),
                            *const initial = atom->vfrac + first;
        for (int p = 0; p < n; p++) V[p] = J[p] * initial[p];
        find_shut(s->of, first, n, J);
        s->of.storage_at(n, J, water, C);
        for (int p = 0; p < n; p++) C[p] *= initial[p];
        if (s->of.law == MPMPoreSoil::CONSTANT) {
          const double k = s->of.permeability / water.resistance;
          for (int p = 0; p < n; p++) K[p] = V[p] * k;
        } else {
          for (int p = 0; p < n; p++) K[p] = V[p] * mobility(*s, first + p, J[p], formula);
        }
        for (int p = 0; p < n; p++) part[p] = s->of.biot * J[p];
        if (waiting) gather(*s, first, n, J, state);
        if (warmth) expand(*s, first, n, J, V);
        for (int p = 0; p < n && !plain; p++) {
          const int i = first + p;
          const double *const mine = state[i];
          if (!quadratic.empty()) quadratic[i] = s->of.quadratic_at(J[p], density);
          double through =
              open ? C[p] * at_surface(*s, i, J[p], mobility(*s, i, J[p], formula), mine) : 0.0;
          if (suction)
            suction->begin_point(i, s->of, J[p], V[p], mine[0], C[p], K[p], through, part[p]);
          if (open) points.volume[p] = through;
        }
        const double *greatest = K;
        for (int p = 0; layers && p < n; p++) {
          const int i = first + p;
          const double k = mobility(*s, i, J[p], formula);
          if (k > 0.0) volumes[i] = K[p] / k;
          buffer[p] = volumes[i] * most_of_layers(i, k);
          greatest = buffer;
        }
        raise_ratio(fastest, n, greatest, C);
        points.at = {state[first] + 1, 1 + dim, state[first], 1 + dim, C};
        if (suction && s->of.retention.can_dry()) {
          limit_slopes(*s, first, n, state, points.row);
          points.at = {points.row[0], 4, points.row[0] + 3, 4, C};
        }
        return true;
      },
      false);
}

/** Alternates between the best fit of nodes to values and gradients, and of gradients to nodes.
 *  Inside a body a linear pressure is found at once; next to surfaces, where nodes have points on
 *  one side, the error falls with each iteration. */
void MPMPore::find_gradients(const MPMRows &state, const double *formula)
{
  constexpr int TURNS = 100;
  constexpr double SAME = 1.0e-12;
  const int dim = field.lattice.dim;
  double change = 1.0, most = 0.0;
  for (int turn = 0; turn < TURNS && change > SAME * most; turn++) {
    points_to_nodes(state, formula);
    double mine[2] = {0.0, 0.0}, all[2];
    nodes.nodes_to_points(
        [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q, const double *) {
          for (int p = 0; p < n; p++)
            for (int d = 0; d < dim; d++) {
              double &slope = state[first + p][1 + d];
              mine[0] = std::max(mine[0], fabs(q[p][d] - slope));
              mine[1] = std::max(mine[1], fabs(q[p][d]));
              slope = q[p][d];
            }
        },
        false);
    MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
    change = all[0];
    most = all[1];
  }
}

void MPMPore::begin_step(const MPMRows &state, const MPMRows &flow, const double *formula,
                         bool waited)
{
  after_wait = waited;
  if (surface.any()) surface.find_places();
  if (motion) motion->begin_step(flow);
  points_to_nodes(state, formula);
  const auto take = [&](int i, double value) {
    mean[i] = value;
    in_forces[i] *= value;
    if (suction) suction->set_lag(i, state[i][0] - value);
  };
  if (motion)
    nodes.gradients_to_points(
        [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q) {
          for (int p = 0; p < n; p++) {
            motion->set_gradient(first + p, q[p]);
            take(first + p, q[p][3]);
          }
        });
  if (solve) {
    unseen.clear();
    nodes.values_to_points([&](const MPMPointMap::Run &, int first, int n, const double *values) {
      for (int p = 0; p < n; p++) take(first + p, values[p]);
    });
  } else {
    nodes.values_to_points_and_back(
        [&](const MPMPointMap::Run &, int first, int n, double *values) {
          for (int p = 0; p < n; p++) {
            const int i = first + p;
            if (!motion && !after_wait) take(i, values[p]);
            values[p] = capacity[i] * (state[i][0] - values[p]);
          }
        },
        unseen);
    for (std::size_t k = 0; k < unseen.size(); k++)
      if (nodes.capacity[k] > 0.0) unseen[k] /= nodes.capacity[k];
  }
  if (!surface.any()) return;
  // places at surfaces also use nodes of periodic images
  field.nodes.complete(nodes.capacity.data(), 1, 1);
  field.nodes.complete(nodes.volume.data(), 1, 1);
  if (suction)
    suction->find_conductances(nodes, surface, [this](const MPMPointMap::Run &run) {
      return &soil(run.material)->of;
    });
  exchange = surface.prepare(nodes, least_storage, suction ? &suction->at_surface() : nullptr);
  if (motion) surface.share_area(nodes);
}

void MPMPore::separate_water()
{
  if (surface.any()) {
    surface.find_push(nodes, of_flow);
    motion->add_gradients(of_flow, [this](int slot) {
      return surface.is_near(slot);
    });
  }
  each_point(field, [&](const auto &run, int i) {
    const Soil *const s = soil(run.material);
    if (!s) return;
    const double J = field.points->jacobian(i);
    const auto here = pores(*s, i, J, conductance[i] / (J * atom->vfrac[i]));
    if (layers && layers->at_interface(i)) {
      const auto r = at_interface(i);
      motion->begin_point(i, here, &r, layers->normal(i));
    } else {
      motion->begin_point(i, here);
    }
  });
  motion->separate();
}

/** The surface force int N p n dA = int (p grad N + N grad p) dV, where the first term is the force
 *  of the pressure on nodes: nothing is left inside the soil, and at the surface it is the force of
 *  the water. */
void MPMPore::find_surface_force(const MPMRows &state, const std::vector<char> &near,
                                 std::vector<double> &force) const
{
  const int dim = field.lattice.dim;
  map_forces(
      field, near,
      [&](int i, double *tau, double *f) {
        const MPMPoreSoil *const s = soil_of(i);
        for (int c = 0; c < 6; c++) tau[c] = c < 3 ? -in_forces[i] : 0.0;
        double volume = s ? s->biot * field.points->jacobian(i) * atom->vfrac[i] : 0.0;
        if (s) volume *= s->retention.borne(state[i][0]);
        for (int d = 0; d < 3; d++) f[d] = d < dim ? volume * state[i][1 + d] : 0.0;
      },
      force);
}

void MPMPore::find_forces_below_surface(const std::vector<char> &near,
                                        std::vector<double> &of_water,
                                        std::vector<double> &of_all) const
{
  const auto map = [&](bool all, std::vector<double> &force) {
    map_forces(
        field, near,
        [&](int i, double *tau, double *f) {
          const MPMPoreSoil *const s = soil_of(i);
          double p = in_forces[i];
          if (!all && s)
            surface.replace_by_outside(atom->x[i], s->biot * field.points->jacobian(i), p);
          for (int c = 0; c < 6; c++)
            tau[c] = (all ? field.points->tau[i][c] : 0.0) - (c < 3 ? p : 0.0);
          for (int d = 0; d < 3; d++) f[d] = 0.0;
        },
        force);
  };
  map(false, of_water);
  map(true, of_all);
}

bool MPMPore::moves_first() const
{
  return has_water() && !motion && !suction && quadratic.empty() &&
      MPMStages::can_move_first(field);
}

void MPMPore::take_motion(double duration)
{
  const int nL = field.lattice.dim * field.lattice.dim;
  const double dt = field.step_dt();
  const auto take = [&](const Soil &s, int first, int n, const double *L) {
    double *const out = squeezed.data() + first, change[BATCH];
    if (nL == 9)
      for (int p = 0; p < n; p++) change[p] = MPMFrame::growth<3>(L + 9 * p, dt);
    else
      for (int p = 0; p < n; p++) change[p] = MPMFrame::growth<2>(L + 4 * p, dt);
    for (int p = 0; p < n && waiting; p++)
      (*waiting)[first + p] = out[p] * (1.0 + change[p]) / atom->vfrac[first + p];
    for (int p = 0; p < n; p++) change[p] *= out[p];
    const double rate = -s.of.biot / duration;
    for (int p = 0; p < n; p++) out[p] = rate * change[p];
    for (int p = 0; p < n && warmth; p++) out[p] += grown[first + p] / duration;
    for (int p = 0; p < n && suction; p++) out[p] *= suction->take_motion(first + p, change[p], dt);
  };
  if (moves_first()) {
    MPMStages::nodes_to_points(field, MPMStages::STRESS,
                               [&](const MPMPointMap::Run &run, int first, int n, const double *L) {
                                 if (const Soil *const s = soil(run.material))
                                   take(*s, first, n, L);
                               });
  } else {
    const TransferStep step = field.step_data();
    const PointRows rows = field.rows();
    double L[9 * BATCH];
    field.nodes.complete_velocities();
    points_from_step(field, [&](const MPMPointMap::Run &run, int first, int n, const int *base) {
      const Soil *const s = soil(run.material);
      if (!s) return;
      field.kernel.g2p_gradient(rows, step, first, first + n, base, field.map->tile_load, L);
      take(*s, first, n, L);
    });
  }
  if (suction) suction->take_rates(dt);
}

void MPMPore::move_water()
{
  if (!motion) return;
  motion->move();
  if (!surface.any()) return;
  motion->flow_at_nodes(
      [this](int slot) {
        return surface.is_near(slot);
      },
      of_flow);
  surface.take_flow(of_flow);
}

/** Flow from the gradient that drives it, in place. */
static void flow_at_interface(const MPMPoreResistance &r, const double *normal, double *q)
{
  const double across = MPM_NS::dot(q, normal);
  double along[3], push[2] = {fabs(across), 0.0};
  for (int d = 0; d < 3; d++) along[d] = q[d] - across * normal[d];
  push[1] = sqrt(MPM_NS::dot(along, along));
  const double w = r.flow(push, 0.0);
  for (int d = 0; d < 3; d++) q[d] = across * normal[d] / r.at(0, w) + along[d] / r.at(1, w);
}

void MPMPore::find_rates(std::vector<double> &inflow)
{
  const double dt = field.step_dt(), cell_in_step = field.lattice.h / dt;
  const int dim = field.lattice.dim;
  const auto weights = weight();
  const double *const along = weights.data();
  const bool plain = !motion && !layers && !suction && quadratic.empty();
  const auto flow = [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q) {
    double power[3] = {0.0, 0.0, 0.0};
    const double *const out = squeezed.data() + first;
    if (plain) {
      const double *const K = conductance.data() + first;
      for (int p = 0; p < n; p++) {
        for (int d = 0; d < 3; d++) {
          q[p][d] = K[p] * (along[d] - q[p][d]);
          power[d] += q[p][d];
        }
        q[p][3] = out[p];
      }
      inflow[MPMPoreSurface::ENERGY] += MPM_NS::dot(power, along);
      return;
    }
    for (int p = 0; p < n; p++) {
      const int i = first + p;
      if (motion) {
        motion->discharge(i, q[p]);
      } else {
        double K = layers ? volumes[i] : conductance[i];
        for (int d = 0; d < 3; d++) q[p][d] = along[d] - q[p][d];
        const bool between = layers && layers->at_interface(i);
        if (between && !quadratic.empty()) {
          flow_at_interface(at_interface(i), layers->normal(i), q[p]);
        } else if (layers && quadratic.empty()) {
          layers->multiply(i, q[p]);
        } else if (!quadratic.empty() && conductance[i] > 0.0) {
          const double V = field.points->jacobian(i) * atom->vfrac[i];
          const double size = sqrt(MPM_NS::dot(q[p], q[p]));
          K = V * secant_mobility(conductance[i] / V, quadratic[i], size);
        } else if (layers) {
          K = 0.0;
        }
        for (int d = 0; d < 3; d++) q[p][d] *= K;
      }
      if (suction) suction->limit_flow(i, cell_in_step, q[p]);
      for (int d = 0; d < dim; d++) power[d] += q[p][d] * along[d];
      q[p][3] = out[p];
      if (suction) q[p][3] += suction->regained(first + p, capacity[first + p], dt);
    }
    inflow[MPMPoreSurface::ENERGY] += power[0] + power[1] + power[2];
  };
  std::function<void()> more;
  if (surface.any())
    more = [&] {
      surface.add_rates(nodes, inflow);
    };
  if (!solve) {
    nodes.find_rates(flow, more);
    return;
  }
  solve->carried = 0.0;
  const double weight_of_water = sqrt(MPM_NS::dot(along, along)) / field.lattice.h;
  nodes.find_rates(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q) {
        double gradient[BATCH][3];
        for (int p = 0; p < n; p++)
          for (int d = 0; d < 3; d++) gradient[p][d] = d < dim ? q[p][d] : 0.0;
        flow(run, first, n, q);
        for (int p = 0; p < n; p++) {
          const int i = first + p;
          solve->carried += fabs(q[p][3]) +
              conductance[i] *
                  (sqrt(MPM_NS::dot(gradient[p], gradient[p])) / field.lattice.h + weight_of_water);
          for (int d = 0; d < dim; d++)
            q[p][d] -= solve->smoothing[i] / dt * (gradient[p][d] - solve->gradient[3 * i + d]);
        }
      },
      more);
}

void MPMPore::end_step(const MPMRows &state, double dt)
{
  const int dim = field.lattice.dim;
  const double keep = solve ? solve->keep
      : after_wait          ? 0.0
      : suction             ? suction->kept_share()
                            : exp(-rate_of_lag() * dt);
  for (std::size_t k = 0; k < unseen.size(); k++) nodes.value[k] += (1.0 - keep) * unseen[k];
  nodes.nodes_to_points(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q, const double *) {
        for (int i = first; i < first + n && warmth; i++) (*warmth)[i] = warm[i];
        if (!suction) {
          const double *const C = capacity.data() + first, *const m = mean.data() + first,
                              *const out = squeezed.data() + first;
          double *const mass = atom->rmass + first;
          const double density = water.density;
          const auto take = [&](auto axes) {
            constexpr int DIM = decltype(axes)::value;
            double *mine = state[first];
            for (int p = 0; p < n; p++, mine += 1 + DIM) {
              const double now = q[p][3] + keep * (mine[0] - m[p]);
              mass[p] += density * (C[p] * (now - mine[0]) - out[p] * dt);
              mine[0] = now;
              for (int d = 0; d < DIM; d++) mine[1 + d] = q[p][d];
            }
          };
          if (dim == 3)
            take(std::integral_constant<int, 3>());
          else
            take(std::integral_constant<int, 2>());
          if (solve)
            for (int p = 0; p < n; p++) mass[p] += density * C[p] * solve->more[first + p];
          return;
        }
        const MPMPoreSoil &dries = soil(run.material)->of;
        for (int p = 0; p < n; p++) {
          const int i = first + p;
          double *const mine = state[i];
          double now = q[p][3] + suction->kept_lag(i);
          const double more = capacity[i] * (now - mine[0]) - squeezed[i] * dt;
          atom->rmass[i] += water.density * more;
          now = suction->take_water(i, dries, mine[0], now, more);
          mine[0] = now;
          for (int d = 0; d < dim; d++) mine[1 + d] = q[p][d];
        }
      },
      false);
}

double MPMPore::memory_usage() const
{
  double bytes =
      nodes.memory_usage() + surface.memory_usage() + (motion ? motion->memory_usage() : 0.0);
  if (suction) bytes += suction->memory_usage();
  if (layers) bytes += layers->memory_usage();
  for (const auto *list : {&in_forces, &capacity, &conductance, &mean, &squeezed, &quadratic,
                           &volumes, &linear_mean, &quadratic_mean, &of_flow, &unseen})
    bytes += list->capacity() * sizeof(double);
  if (!solve) return bytes;
  for (const auto *list : {&solve->start, &solve->capacity, &solve->biot, &solve->gradient,
                           &solve->smoothing, &solve->more})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}
