/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* The equations are those of fix mpm/heat with the transfer relax (mpm_conduction.cpp), with the
   functions of the cells in place of those of a lattice. In the total frame points stay in their
   cells, so that no node has next to no capacity, and flow goes by

     C_i dT_i/dt = - sum_p V_p (F^-1 k F^-T sum_j T_j grad N_jp) . grad N_ip + sides,

   with gradients in the reference configuration and the present volume V_p. Nodes are on the
   boundary: their temperatures are those that groups prescribe, and the heat for it is what comes
   through the group. That of sides is lumped at their nodes, as capacities are. A step is made of
   stages, so many that the rate of no node times their duration is above one: the rows of the
   matrix bound its eigenvalues. */

#include "meshgrid/fix_mpm_mesh_heat.h"

#include "base/mpm_lists.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_physics.h"
#include "heat/mpm_conduction.h"
#include "material/material.h"
#include "math/matrix.h"
#include "meshgrid/fix_mpm_mesh.h"
#include "meshgrid/fix_mpm_mesh_contact.h"
#include "meshgrid/mpm_mesh_conditions.h"
#include "meshgrid/mpm_mesh_ranks.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int MOST_STAGES = 100;    // of a step

// conductivities in a cell that differ by a larger factor lead to a warning
static constexpr double SAME = 2.0;

// sums at nodes: capacity, that times temperature, row of the matrix
static constexpr int WIDTH = 3;

/** fix ID all mpm/mesh/heat MESH keyword values ... */
Options MPMMeshHeatOptions::declare()
{
  using namespace option;
  Options o("fix mpm/mesh/heat");
  const auto condition = [&](const std::string &keyword, MPMHeatCondition::Kind kind,
                             const std::string &names, const std::string &unit,
                             const std::string &meaning, int n) {
    add_condition(o, keyword,
                  {text(next.group, "name", meaning),
                   variables(next.value, n, names, unit,
                             n > 1 ? "values, can be variables" : "value, can be a variable")},
                  kind, next, conditions);
  };
  condition("temperature", MPMHeatCondition::TEMPERATURE, "T", "temperature",
            "name of a physical group or set whose nodes have this temperature", 1);
  condition("flux", MPMHeatCondition::FLUX, "q", "energy/(time area)",
            "name of sides through which this heat flows into the body", 1);
  condition(
      "convection", MPMHeatCondition::CONVECTION, "H T",
      "energy/(time area temperature), temperature",
      "name of sides through which heat flows: H times the difference to the temperature T outside",
      2);
  o.refuse([this] {
    OptionRules rules;
    const auto once = "give it once";
    refuse_twice(rules, conditions, MPMHeatCondition::TEMPERATURE, "temperature", once);
    refuse_twice(rules, conditions, MPMHeatCondition::FLUX, "flux", once);
    refuse_twice(rules, conditions, MPMHeatCondition::CONVECTION, "convection", once);
    for (const auto &c : conditions)
      rules.push_back({c.kind == MPMHeatCondition::CONVECTION && c.value[0].variable.empty() &&
                           !(c.value[0].value >= 0.0),
                       "convection", "needs a coefficient that is not negative: {convection}"});
    return rules;
  });
  return o;
}

FixMPMMeshHeat::FixMPMMeshHeat(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(
        FLERR, 1,
        "Fix mpm/mesh/heat acts on all points of a fix mpm/mesh whose material conducts: use "
        "group all");
  if (narg < 4) error->all(FLERR, narg - 1, "Fix mpm/mesh/heat needs the ID of a fix mpm/mesh");
  mesh_id = arg[3];
  Options options = declare();
  read_options(lmp, options, narg, arg, 4);
  heat.assign(conditions.size(), 0.0);
  power = heat;
  scalar_flag = 1;
  vector_flag = !conditions.empty();
  size_vector = 2 * (int) conditions.size();
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  dynamic_group_allow = 0;
  state.declare(gradients, "mpm/mesh/heat:gradient", 3);
  keep_arrays();
}

void FixMPMMeshHeat::init()
{
  const auto *mesh = modify->get_fix_by_id(mesh_id);
  if (!mesh || !dynamic_cast<const FixMPMMesh *>(mesh))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh/heat {}: {} is not the ID of a fix mpm/mesh; for bodies on lattices "
               "use fix mpm/heat",
               id, mesh_id);
  for (auto &c : conditions)
    for (auto &value : c.value) find_variable(lmp, value, fmt::format("fix mpm/mesh/heat {}", id));
}

void FixMPMMeshHeat::begin_run(const BackgroundMesh &mesh)
{
  points = MPMPoints::get(atom);
  thermals.clear();
  relaxed = std::numeric_limits<double>::max();
  double least = std::numeric_limits<double>::max(), greatest = 0.0;    // capacity for each volume
  for (const auto *fix : find_fixes<FixMPMMaterial>(lmp)) {
    const auto &material = *fix->material;
    if (!material.conducts()) continue;
    const Conduction c = material.conduction(nullptr);
    const double volumetric = material.density() * c.capacity;
    const double slowest = c.orthotropic
        ? std::min(c.conductivity, std::min(c.across[0], c.across[1]))
        : c.conductivity;
    thermals.push_back({fix, fix->temperature(), fix->molten(), material.conduction_varies(),
                        fix->molten() >= 0 && conductivity_varies_with_temperature(material), c,
                        slowest / volumetric});
    relaxed = std::min(relaxed, slowest / volumetric);
    least = std::min(least, volumetric);
    greatest = std::max(greatest, volumetric);
  }
  if (thermals.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh/heat {}: no fix mpm/material has a part thermal conducting", id);
  layers_known = false;
  relaxed *= least / greatest;    // see the top of mpm_conduction.cpp
  for (auto &t : thermals)
    t.diffusivity =
        std::max(relaxed, MPMConduction::share_of_own_rate(greatest / least) * t.diffusivity);
  largest = 0.0;
  for (const auto &cell : mesh.cells) largest = std::max(largest, cell.height);

  conditions_at_nodes.clear();
  held.assign(mesh.nodes.size(), 0);
  for (std::size_t c = 0; c < conditions.size(); c++) {
    const auto &given = conditions[c];
    const int condition = (int) c;
    if (given.kind == MPMHeatCondition::TEMPERATURE) {
      for (const int node : mesh.nodes_of(given.group)) {
        conditions_at_nodes.push_back({node, condition, 0.0});
        held[node] = 1;
      }
      continue;
    }
    std::vector<double> area(mesh.nodes.size(), 0.0);
    for (const auto &face : mesh.faces_of(given.group)) {
      double normal[3], share[4];
      mesh.area(face, mesh.nodes, normal, share);
      const double size = std::sqrt(dot(normal, normal));
      for (int k = 0; k < face.nnode; k++) area[face.node[k]] += share[k] * size;
    }
    for (std::size_t node = 0; node < area.size(); node++)
      if (area[node] > 0.0) conditions_at_nodes.push_back({(int) node, condition, area[node]});
  }
  const std::size_t n = mesh.nodes.size();
  for (auto *values : {&capacity, &value, &before, &rate}) values->assign(n, 0.0);
  sums.assign(WIDTH * n, 0.0);
}

const FixMPMMeshHeat::Thermal *FixMPMMeshHeat::thermal(int i) const
{
  for (const auto &t : thermals)
    if (atom->mask[i] & t.fix->groupbit) return &t;
  return nullptr;
}

void FixMPMMeshHeat::conduct(MPMMeshBody &of, double dt)
{
  const bool varies = std::any_of(conditions.begin(), conditions.end(), [](const auto &c) {
    return !c.value[0].variable.empty() || !c.value[1].variable.empty();
  });
  evaluate_in_step(lmp, varies, [this] {
    for (auto &c : conditions) {
      for (int k = 0; k < c.nvalue(); k++) c.now[k] = LAMMPS_NS::evaluate(lmp, c.value[k]);
      if (c.kind == MPMHeatCondition::CONVECTION && !(c.now[0] >= 0.0))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/mesh/heat {} convection {}: variable {} = {:.6g}, but it must not be "
                   "negative",
                   id, c.group, c.value[0].variable, c.now[0]);
    }
  });
  std::fill(power.begin(), power.end(), 0.0);
  find_layers(of);
  find_points(of, false);
  double fastest = fill_nodes(of);
  if (std::any_of(thermals.begin(), thermals.end(), [](const auto &t) {
        return t.jumps;
      })) {
    find_points(of, true);
    fastest = fill_nodes(of);
  }
  double mine = fastest;
  MPI_Allreduce(&mine, &fastest, 1, MPI_DOUBLE, MPI_MAX, world);
  const double stages = std::max(1.0, std::ceil(dt * fastest));
  if (!(stages <= MOST_STAGES))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh/heat {}: heat crosses the smallest cells in {:.3g}, too fast for "
               "{} stages in the time step {:.3g}: use a smaller time step, or larger cells",
               id, 1.0 / fastest, MOST_STAGES, dt);
  hold(of);
  for (int k = 0; k < (int) stages; k++) advance(of, dt / stages);
  take(of, dt);
  for (std::size_t c = 0; c < heat.size(); c++) {
    heat[c] += power[c];
    power[c] /= dt;
  }
}

/** Points that are partly molten have the conductivity of neither phase if it jumps there: as
 *  mpm_conduction.cpp, with the temperatures that nodes have within an eighth of their range in the
 *  cell on either side, with which fronts are nearer to their places than with a quarter. */
Conduction FixMPMMeshHeat::conduction_of(MPMMeshBody &of, const Thermal &t, int i,
                                         bool nodes_known) const
{
  constexpr double HALF_RANGE = 0.125;
  const double *const history = t.fix->history[i];
  if (!t.varies) return t.all;
  if (!nodes_known || !t.jumps) return t.fix->material->conduction(history);
  const auto &place = of.places[i];
  const auto &cell = of.mesh.cells[place.cell];
  double T = 0.0, low = std::numeric_limits<double>::max(), high = -low;
  for (int k = 0; k < cell.nnode; k++) {
    const double here = value[cell.node[k]];
    T += place.N[k] * here;
    low = std::min(low, here);
    high = std::max(high, here);
  }
  const double reach = HALF_RANGE * (high - low);
  return mean_conduction(*t.fix->material, history, T - reach, T + reach);
}

/** V F^-1 k F^-T of a conductivity across and along an interface, whose normal in the deformed body
 *  is along F^-T N. */
void FixMPMMeshHeat::set_layers(const Cut &cut, const double *cofactors, double J, double V,
                                double *k)
{
  double inverse[9], across[3] = {0.0, 0.0, 0.0};    // C^-1, and that times N
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) {
      double sum = 0.0;
      for (int a = 0; a < 3; a++) sum += cofactors[3 * a + d] * cofactors[3 * a + e];
      inverse[3 * d + e] = sum / (J * J);
      across[d] += inverse[3 * d + e] * cut.normal[e];
    }
  const double size = dot(cut.normal, across);
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++)
      k[3 * d + e] = V *
          (cut.along * inverse[3 * d + e] +
           (cut.across - cut.along) * across[d] * across[e] / size);
}

/** Points that conduct, with V F^-1 k F^-T. */
void FixMPMMeshHeat::find_points(MPMMeshBody &of, bool nodes_known)
{
  conducting.clear();
  for (const int i : of.order) {
    const Thermal *const t = thermal(i);
    if (!t) continue;
    const Conduction c = conduction_of(of, *t, i, nodes_known);
    const double *const F = points->F[i], cofactors[9] = MPM_COFACTORS(F), J = dot(F, cofactors);
    Point p = {i, t, atom->rmass[i] * c.capacity, {}};
    const int cut = cut_of[of.places[i].cell];
    if (cut >= 0) {
      set_layers(cuts[cut], cofactors, J, atom->vfrac[i] * J, p.k);
      conducting.push_back(p);
      continue;
    }
    double along[3], n[3][3];
    principal_conductivities(c, F, along, n);
    for (int a = 0; a < 3; a++) {
      // a principal axis, in the reference configuration: the inverse is cof^T/J
      double N[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < 3; d++)
        for (int e = 0; e < 3; e++) N[d] += cofactors[3 * e + d] / J * n[a][e];
      for (int d = 0; d < 3; d++)
        for (int e = 0; e < 3; e++) p.k[3 * d + e] += atom->vfrac[i] * J * along[a] * N[d] * N[e];
    }
    conducting.push_back(p);
  }
}

/** In cells that an interface of materials cuts, functions of nodes have no kink, and too much heat
 *  would go through: their points have the harmonic mean of the conductivities across the interface
 *  and the arithmetic one along it, of which the places of points tell the normal. In the total
 *  frame points stay in their cells. Not with conductivities that vary or have axes, of which a
 *  warning tells, once. */
void FixMPMMeshHeat::find_layers(MPMMeshBody &of)
{
  if (layers_known) return;
  layers_known = true;
  enum { VOLUME, RESISTANCE, CONDUCTANCE, PLACE, MOMENT = PLACE + 3, NSUM = MOMENT + 3 };
  const std::size_t n = of.mesh.cells.size();
  cuts.clear();
  cut_of.assign(n, -1);
  std::vector<double> range(2 * n, -std::numeric_limits<double>::max()), all(2 * n);
  std::vector<double> mine(NSUM * n, 0.0), sum(NSUM * n);
  bool plain = true;
  for (const auto &t : thermals) plain = plain && !t.varies && !t.all.orthotropic;
  for (const int i : of.order) {
    const Thermal *const t = thermal(i);
    if (!t) continue;
    const auto &place = of.places[i];
    const auto &cell = of.mesh.cells[place.cell];
    const double k = t->all.conductivity, V = atom->vfrac[i];
    double *const extreme = &range[2 * place.cell];    // the greatest, and minus the least
    extreme[0] = std::max(extreme[0], k);
    extreme[1] = std::max(extreme[1], -k);
    double *const to = &mine[NSUM * place.cell];
    to[VOLUME] += V;
    to[RESISTANCE] += V / k;
    to[CONDUCTANCE] += V * k;
    for (int d = 0; d < 3; d++) {
      double x = 0.0;
      for (int j = 0; j < cell.nnode; j++) x += place.N[j] * of.mesh.nodes[cell.node[j]][d];
      to[PLACE + d] += V * x;
      to[MOMENT + d] += V * k * x;
    }
  }
  MPI_Allreduce(range.data(), all.data(), static_cast<int>(2 * n), MPI_DOUBLE, MPI_MAX, world);
  MPI_Allreduce(mine.data(), sum.data(), static_cast<int>(NSUM * n), MPI_DOUBLE, MPI_SUM, world);
  int layered = 0;
  double most = 1.0;
  for (std::size_t c = 0; c < n; c++) {
    const double greatest = all[2 * c], least = -all[2 * c + 1], *const s = &sum[NSUM * c];
    if (greatest < 0.0 || greatest == least) continue;
    if (!plain) {
      layered += greatest > SAME * least;
      most = std::max(most, greatest / least);
      continue;
    }
    Cut cut = {s[VOLUME] / s[RESISTANCE], s[CONDUCTANCE] / s[VOLUME], {}};
    for (int d = 0; d < 3; d++)
      cut.normal[d] = s[MOMENT + d] / s[CONDUCTANCE] - s[PLACE + d] / s[VOLUME];
    constexpr double EVEN = 1.0e-6;    // materials in turns have no interface
    if (!(dot(cut.normal, cut.normal) > pow(EVEN * of.mesh.cells[c].height, 2))) continue;
    cut_of[c] = static_cast<int>(cuts.size());
    cuts.push_back(cut);
  }
  if (!layered || warned_of_layers) return;
  warned_of_layers = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mesh/heat {}: {} cells have points of materials whose conductivities "
                   "differ by a factor of up to {:.3g}, and one of which varies or is orthotropic: "
                   "too much heat goes through interfaces that are not along sides of cells",
                   id, layered, most);
}

/** Capacities and temperatures of nodes; returns the greatest rate of those of this rank. */
double FixMPMMeshHeat::fill_nodes(MPMMeshBody &of)
{
  for (const int node : of.ranks.nodes) std::fill_n(&sums[WIDTH * (std::size_t) node], WIDTH, 0.0);
  for (const auto &p : conducting) {
    const auto &place = of.places[p.i];
    const auto &cell = of.mesh.cells[place.cell];
    const double *const slope = gradients[p.i],
                        T = p.thermal->fix->history[p.i][p.thermal->temperature];
    double x[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < cell.nnode; k++)
      for (int d = 0; d < 3; d++) x[d] += place.N[k] * of.mesh.nodes[cell.node[k]][d];
    for (int k = 0; k < cell.nnode; k++) {
      double here = T, row = 0.0;
      for (int d = 0; d < 3; d++) here += slope[d] * (of.mesh.nodes[cell.node[k]][d] - x[d]);
      for (int j = 0; j < cell.nnode; j++) {
        double product = 0.0;
        for (int d = 0; d < 3; d++)
          for (int e = 0; e < 3; e++) product += place.g[k][d] * p.k[3 * d + e] * place.g[j][e];
        row += std::fabs(product);
      }
      double *const to = &sums[WIDTH * (std::size_t) cell.node[k]];
      to[0] += p.capacity * place.N[k];
      to[1] += p.capacity * place.N[k] * here;
      to[2] += row;
    }
  }
  of.ranks.sum(sums.data(), WIDTH);
  for (const auto &mine : conditions_at_nodes)
    if (conditions[mine.condition].kind == MPMHeatCondition::CONVECTION)
      sums[WIDTH * (std::size_t) mine.node + 2] += mine.area * conditions[mine.condition].now[0];
  double fastest = 0.0;
  for (const int node : of.ranks.nodes) {
    const double *const sum = &sums[WIDTH * (std::size_t) node];
    capacity[node] = sum[0];
    value[node] = before[node] = sum[0] > 0.0 ? sum[1] / sum[0] : 0.0;
    if (sum[0] > 0.0 && !held[node]) fastest = std::max(fastest, sum[2] / sum[0]);
  }
  return fastest;
}

/** Nodes take the temperatures that are prescribed, the last one in the input where groups meet. */
void FixMPMMeshHeat::hold(MPMMeshBody &of)
{
  for (const auto &mine : conditions_at_nodes) {
    if (conditions[mine.condition].kind != MPMHeatCondition::TEMPERATURE) continue;
    if (!(capacity[mine.node] > 0.0)) continue;
    const double T = conditions[mine.condition].now[0];
    if (of.ranks.first[mine.node])
      power[mine.condition] += capacity[mine.node] * (T - value[mine.node]);
    value[mine.node] = T;
  }
}

/** A stage. Heat that a node would get whose temperature is prescribed leaves through the group
 *  that does so. */
void FixMPMMeshHeat::advance(MPMMeshBody &of, double dt)
{
  for (const int node : of.ranks.nodes) rate[node] = 0.0;
  for (const auto &p : conducting) {
    const auto &place = of.places[p.i];
    const auto &cell = of.mesh.cells[place.cell];
    double slope[3] = {0.0, 0.0, 0.0}, flow[3];
    for (int k = 0; k < cell.nnode; k++)
      for (int d = 0; d < 3; d++) slope[d] += value[cell.node[k]] * place.g[k][d];
    for (int d = 0; d < 3; d++) flow[d] = dot(p.k + 3 * d, slope);
    for (int k = 0; k < cell.nnode; k++) rate[cell.node[k]] -= dot(place.g[k], flow);
  }
  of.ranks.sum(rate.data(), 1);
  for (const auto &mine : conditions_at_nodes) {
    const MPMHeatCondition &given = conditions[mine.condition];
    if (given.kind == MPMHeatCondition::TEMPERATURE || !(capacity[mine.node] > 0.0)) continue;
    const double flow = mine.area * given.flux(value[mine.node], 0.0);    // there is no radiation
    rate[mine.node] += flow;
    if (of.ranks.first[mine.node]) power[mine.condition] += dt * flow;
  }
  for (auto mine = conditions_at_nodes.rbegin(); mine != conditions_at_nodes.rend(); ++mine) {
    if (conditions[mine->condition].kind != MPMHeatCondition::TEMPERATURE) continue;
    if (!(capacity[mine->node] > 0.0)) continue;
    if (of.ranks.first[mine->node]) power[mine->condition] -= dt * rate[mine->node];
    rate[mine->node] = 0.0;
  }
  for (const int node : of.ranks.nodes)
    if (capacity[node] > 0.0) value[node] += dt * rate[node] / capacity[node];
}

/** What points of a material that conducts faster than others lose of their own temperature goes to
 *  their nodes, see the top of mpm_conduction.cpp. */
void FixMPMMeshHeat::let_faster_points_go(MPMMeshBody &of, double dt)
{
  if (std::none_of(thermals.begin(), thermals.end(), [this](const Thermal &t) {
        return t.diffusivity > relaxed;
      }))
    return;
  for (const int node : of.ranks.nodes) rate[node] = 0.0;
  for (const auto &p : conducting) {
    const auto &place = of.places[p.i];
    const auto &cell = of.mesh.cells[place.cell];
    double hidden = p.thermal->fix->history[p.i][p.thermal->temperature];
    for (int k = 0; k < cell.nnode; k++) hidden -= place.N[k] * before[cell.node[k]];
    const double heat =
        p.capacity * hidden * (kept(relaxed, dt) - kept(p.thermal->diffusivity, dt));
    for (int k = 0; k < cell.nnode; k++) rate[cell.node[k]] += place.N[k] * heat;
  }
  of.ranks.sum(rate.data(), 1);
  for (const int node : of.ranks.nodes)
    if (capacity[node] > 0.0) value[node] += rate[node] / capacity[node];
}

/** Share of a difference over a cell that is left after a time. */
double FixMPMMeshHeat::kept(double diffusivity, double dt) const
{
  return std::exp(-dt * diffusivity / (largest * largest));
}

/** Temperatures of points. */
void FixMPMMeshHeat::take(MPMMeshBody &of, double dt)
{
  let_faster_points_go(of, dt);
  for (const auto &p : conducting) {
    const auto &place = of.places[p.i];
    const auto &cell = of.mesh.cells[place.cell];
    const double keep = kept(p.thermal->diffusivity, dt);
    double *const history = p.thermal->fix->history[p.i], &T = history[p.thermal->temperature];
    double *const slope = gradients[p.i], now = keep * T;
    std::fill_n(slope, 3, 0.0);
    for (int k = 0; k < cell.nnode; k++) {
      const int node = cell.node[k];
      now += place.N[k] * (value[node] - keep * before[node]);
      for (int d = 0; d < 3; d++) slope[d] += value[node] * place.g[k][d];
    }
    const double more = p.capacity * (now - T);
    got += more;
    const Conduction c = p.thermal->varies ? p.thermal->fix->material->conduction(history)
                                           : p.thermal->all;
    if (c.by_enthalpy) {
      p.thermal->fix->material->warm(history, more / atom->rmass[p.i]);
    } else {
      T = now;
      if (p.thermal->molten >= 0) c.melting.settle(T, history[p.thermal->molten]);
    }
  }
}

/** Scalar: heat that points have taken so far; vector: for each condition its power in the last
 *  step, and heat so far. */
double FixMPMMeshHeat::compute_scalar()
{
  double all;
  MPI_Allreduce(&got, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMMeshHeat::compute_vector(int k)
{
  double all;
  MPI_Allreduce(k % 2 ? &heat[k / 2] : &power[k / 2], &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMMeshHeat::memory_usage()
{
  return FixMPMState::memory_usage() +
      bytes_of(conducting, conditions_at_nodes, capacity, value, before, rate, sums);
}

void FixMPMMeshHeat::write_restart(FILE *fp)
{
  std::vector<double> totals = {comm->me == 0 ? (double) heat.size() : 0.0, got};
  totals.insert(totals.end(), heat.begin(), heat.end());
  write_totals(fp, world, totals);
  got = totals[1];
  std::copy(totals.begin() + 2, totals.end(), heat.begin());
}

void FixMPMMeshHeat::restart(char *buf)
{
  const auto state = read_state(lmp, id, buf);
  const auto *const list = (const double *) state.data();
  if (state.size() != (2 + heat.size()) * sizeof(double))
    error->all(FLERR, Error::NOPOINTER,
               "Fix mpm/mesh/heat {} had another number of conditions when the restart file was "
               "written: give as many, or give the fix another ID to begin anew",
               id);
  if (comm->me) return;
  got = list[1];
  std::copy_n(list + 2, heat.size(), heat.begin());
}
