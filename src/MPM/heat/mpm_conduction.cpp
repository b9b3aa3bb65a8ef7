/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   With the capacities C_p = m_p c_p and volumes V_p of points, their gradients g_p (not with the
   transfers pic and xpic), and sources s_p,

     C_i = sum_p C_p N_ip,  T_i = sum_p C_p N_ip [T_p + g_p (x_i - x_p)]/C_i,
     C_i dT_i/dt = - sum_p V_p k_p (sum_j T_j grad N_jp) . grad N_ip + sum_p V_p s_p N_ip + faces,

     T_p = sum_i N_ip T_i                                                  (pic, affine)
     T_p = sum_i N_ip T_i + e (T_p - sum_i N_ip T_i of the start)          (relax)
     T_p = sum_i N_ip (T_i - T_i of the start + u_i)                       (xpic)
     g_p = D^-1 sum_i N_ip T_i (x_i - x_p),  D = sum_i N_ip (x_i - x_p) (x_i - x_p)^T

   with the terms u of MPMNodeScalar::add_terms() (XPIC, C.C. Hammerquist, J.A. Nairn, Comput.
   Methods Appl. Mech. Eng. 318 (2017) 724). All transfers keep sum_p C_p T_p, because weights have
   the sum one and sum_i N_ip (x_i - x_p) = 0. Without g_p, nodes at faces, whose points are all on
   one side, would have the temperature of another place: an error of first order in the flow.

   The part of the temperatures of points that nodes do not see decays by conduction in about the
   time h^2 rho c/k. With relax a share 1 - e of it goes in a step, e = exp(-R dt k/(rho c h^2)), so
   that the smoothing does not depend on the time step. Heat is kept without more if e is the same
   for all points, e0 of the material that conducts least, with R reduced by the ratio of the
   capacities. Where materials differ, points have their own e_p below e0, and give the heat that
   they lose faster to their nodes, which give it back to all their points:

     T_p = sum_i N_ip [T_i + q_i/C_i] + e_p d_p,  q_i = sum_p N_ip C_p (e0 - e_p) d_p

   with d_p = T_p - sum_i N_ip T_i of the start. Nothing grows: with the mean P over nodes and back,
   d becomes [1 - (1 - P)(1 - e)] d, a product of two symmetric matrices between 0 and 1 in the norm
   of capacities. With e0 for all, points with little capacity next to others with much kept their
   initial temperatures: two touching bars, 300 and 100 K, capacities 15 to 1, were wrong by 112 K
   when heat had crossed three of their cells, and have an error of 12 K. But nodes that are
   dominated by others also smooth the kink of a steady temperature at an interface: the heat
   through three cells of a material with 1/100 of the capacity and conductivity of what is around
   was 22 % too large in short steps (1/15: 2.8 %; with e0 for all 3.0 and 1.7 %). Above a ratio of
   16 the own rates are therefore reduced by its third power. No rate is right there: a node within
   1.5 spacings of much capacity has one temperature for both sides, so that with their own rate,
   too, three cells from the interface 4 % of a jump are missing with a ratio of 100, and 12 % with
   1000. Two fields have two temperatures there, and errors of 0.8 % with any ratio.

   Stability. The matrix of conduction is a sum over points of V_p k_p grad N grad N^T, and that of
   capacities one of C_p diag(N). The greatest eigenvalue is not above the greatest one of the
   parts,

     V_p k_p/C_p max_d sum_i (dN_ip/dx_d)^2/N_ip,

   as functions are products along the axes, for which sum_i grad N grad N^T/N is diagonal. The sum
   is at most 6/h^2 for quadratic B-splines and 3.2/h^2 for cubic ones. With a tensor k its greatest
   eigenvalue counts. A function of GIMP of a point with the half size s (in cells, at most 1/2) has
   at most 2/s + 1/(1 - s), and with domains, N_ip = sum_c w_c N_i(x_c) over corners c, grad N_ip =
   sum_c g_c N_i(x_c), and by Cauchy and Schwarz sum_i grad N grad N^T/N <= sum_c g_c g_c^T/w_c.

   Linear functions and Bernstein polynomials have no such bound. For them the greatest rate is at
   most the greatest sum of absolute values of a row of C^-1 K, which is not above

     sum_p V_p sum_d |dN_ip/dx_d| sum_e |k_de| (2/h)/C_i,

   4 d k/(rho c h^2) inside of a body in d dimensions. At its surface, nodes with next to no
   capacity can have any rate. Points that reach such a node conduct less, by the factor that makes
   the sum of the node four times the usual one: the matrix stays symmetric, and heat is kept.

   Bernstein polynomials: a point whose domain is divided by a side of cells conducts with its parts
   in each cell (mpm_cut_domains.cpp). Parts with a node whose rate is more than 1.4 times what is
   allowed conduct nothing, because a little conduction would make an insulating layer at a surface.
   These nodes, and those with less than a quarter of their conduction left, are idle: no heat comes
   in there, so that the body ends at the side of the cell.

   Melting. Where the conductivity jumps, heat flows along the gradient of the integral of k over
   the temperature. The mean of k over the temperatures of nodes within a quarter of a node spacing
   of a point is its difference over a distance (V.R. Voller, C.R. Swaminathan, Numer. Heat Transfer
   B 24 (1993) 161, at faces of cells). Partly molten points alone would have the conductivity of
   one phase, and the front would be up to 0.8 node spacings off.

   Total frame. Nodes are places X of the reference configuration, where the conductivity is J F^-1
   k F^-T and the volume V_p/J: the same sums with V_p F^-1 k F^-T. Around an axis of symmetry,
   points are rings with their whole volume and capacity.
------------------------------------------------------------------------- */

#include "heat/mpm_conduction.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "heat/mpm_heat_body.h"
#include "material/material.h"
#include "math_extra.h"
#include "solve/bytes_of.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// conductance of a contact, in units of the conductivity over the node spacing, above which nothing
// changes any more
static constexpr double PERFECT = 1000.0;

MPMConduction::MPMConduction(LAMMPS *lmp, MPMField &field, const MPMHeatTransfer &transfer,
                             const MPMHeatCondition *conditions) :
    Pointers(lmp),
    field(field), faces(lmp, field, conditions), scalar(field), transfer(transfer), cuts(field)
{
}

void MPMConduction::init(double sigma, bool surfaces, bool &warned_of_layers)
{
  warned = &warned_of_layers;
  thermals.clear();
  for (const auto *fix : field.materials) {
    const auto &material = *fix->material;
    if (!material.conducts()) continue;
    const int T = fix->temperature(), molten = fix->molten();
    const Conduction all = material.conduction(nullptr);
    const double least = all.orthotropic
        ? std::min(all.conductivity, std::min(all.across[0], all.across[1]))
        : all.conductivity;
    thermals.push_back({fix, T, molten, material.conduction_varies(),
                        molten >= 0 && conductivity_varies_with_temperature(material), all,
                        least / (material.density() * all.capacity)});
  }
  active = !thermals.empty();
  total = field.frame->is_total();
  steepest = 0.0;
  if (field.options.shape == QUADRATIC || field.options.shape == CUBIC)
    steepest = steepest_function(field) / (field.lattice.h * field.lattice.h);
  conducted = 0.0;
  present.clear();
  keep_present(field.present_materials());
  faces.init(sigma);
  wants_volumes = faces.any() || (surfaces && thermals.size() < field.materials.size());
  scalar.init(transfer.has_slopes(), wants_volumes);
}

/** Updates what depends on the materials of which any rank has points. Materials of other fields,
 *  and unused ones, change nothing. */
void MPMConduction::keep_present(const std::vector<signed char> &all)
{
  if (all == present) return;
  present = all;
  slowest = std::numeric_limits<double>::max();
  least_capacity = 0.0;
  double greatest_capacity = 0.0, most = 0.0;
  for (const auto &t : thermals) {
    if (!is_present(t)) continue;
    most = std::max(most, t.all.most());
    const double capacity = t.fix->material->density() * t.all.capacity;
    slowest = std::min(slowest, t.diffusivity);
    least_capacity = greatest_capacity > 0.0 ? std::min(least_capacity, capacity) : capacity;
    greatest_capacity = std::max(greatest_capacity, capacity);
  }
  if (greatest_capacity > 0.0) {
    slowest *= least_capacity / greatest_capacity;
    own_share = share_of_own_rate(greatest_capacity / least_capacity);
  }
  if (own_share < 1.0 && transfer.kind == MPMHeatTransfer::RELAX && !*warned) {
    *warned = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/heat: heat capacities of materials in fix mpm {} have a ratio of "
                     "{:.3g}: where their temperature jumps at first, points next to the interface "
                     "keep a part of the jump for long: use a fix mpm for each material, fix "
                     "mpm/contact between them, and keyword contact with a conductance of {:.1g} "
                     "or more",
                     field.id(), greatest_capacity / least_capacity,
                     PERFECT * most / field.lattice.h);
  }
  init_layers();
}

double MPMConduction::share_of_own_rate(double ratio)
{
  constexpr double LARGEST = 16.0;
  return ratio > LARGEST ? std::pow(LARGEST / ratio, 3) : 1.0;
}

bool MPMConduction::conducts_in_part() const
{
  if (!conducts()) return false;
  for (std::size_t k = 0; k < present.size(); k++)
    if (present[k] && !thermal(field.materials[k])) return true;
  return false;
}

void MPMConduction::find_points(bool may_rest)
{
  if (thermals.empty()) return;
  int any = 0, all = 1;
  std::vector<signed char> mine(field.materials.size(), 0), here(mine.size());
  each_point_batch(field, [&](const auto &run, int, int) {
    any |= thermal(run.material) != nullptr;
    if (run.material) mine[index_of(run.material)] = 1;
  });
  // with a single material, what depends on it changes only when its first points come
  if (mine.size() > 1 || !present[0]) {
    MPI_Allreduce(mine.data(), here.data(), (int) mine.size(), MPI_SIGNED_CHAR, MPI_MAX, world);
    keep_present(here);
  }
  if (any) field.jacobians.ask();
  if (all && may_rest) MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_BOR, world);
  active = all;
  if (active) return;
  temperature.clear();
  rate.clear();
}

const MPMConduction::Thermal *MPMConduction::thermal(const FixMPMMaterial *fix) const
{
  for (const auto &t : thermals)
    if (t.fix == fix) return &t;
  return nullptr;
}

double MPMConduction::capacity_of(int i) const
{
  const Thermal *const t = thermal(field.material_of(i));
  Conduction buffer;
  return t ? atom->rmass[i] * t->at(i, buffer).capacity : 0.0;
}

double MPMConduction::heat_of_points() const
{
  double heat = 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const Thermal *const t = thermal(field.material_of(i));
    if (t) heat += capacity_of(i) * fabs(t->fix->history[i][t->temperature]);
  }
  return heat;
}

bool MPMConduction::melts() const
{
  return std::any_of(thermals.begin(), thermals.end(), [](const Thermal &t) {
    return t.molten >= 0;
  });
}

bool MPMConduction::has_front() const
{
  for (int i = 0; i < atom->nlocal; i++) {
    const Thermal *const t = field.is_point(i) ? thermal(field.material_of(i)) : nullptr;
    if (!t || t->molten < 0) continue;
    const double f = t->fix->history[i][t->molten];
    if (f > 0.0 && f < 1.0) return true;
  }
  return false;
}

double MPMConduction::volume_of(int i) const
{
  return atom->vfrac[i] * field.points->jacobian(i);
}

void MPMConduction::extend_topology()
{
  faces.extend_topology();
  if (looks_beyond_points() && has_materials()) activate_blocks_around(field);
}

const std::vector<double> &MPMConduction::face_capacity()
{
  if (idle.empty()) return scalar.capacity;
  capacity_at_faces = scalar.capacity;
  for (std::size_t k = 0; k < idle.size(); k++)
    if (idle[k]) capacity_at_faces[k] = 0.0;
  return capacity_at_faces;
}

/** Calls loop(plain) with plain as a constant: loops over points then have neither branches nor
 *  calls for what is the same for all points. */
template <class Loop> static void if_plain(bool plain, const Loop &loop)
{
  if (plain)
    loop(std::true_type());
  else
    loop(std::false_type());
}

/** Copies the first DIM reals of n rows of four. */
template <int DIM> static void copy_rows(int n, const double *from, double *to)
{
  for (int p = 0; p < n; p++)
    for (int d = 0; d < DIM; d++) to[DIM * p + d] = from[4 * p + d];
}

/** Temperatures of the nodes. */
double MPMConduction::points_to_nodes(const MPMRows &gradients, bool starts)
{
  add_points(gradients, starts);
  const double most = end_nodes();
  if (!is_bounded_by_rows()) return most;
  if (looks_beyond_points())
    cuts.find([this](const MPMPointMap::Run &run) {
      return thermal(run.material) != nullptr;
    });
  add_rows();
  const double most_by_rows = bound_by_rows(most_of_rows());
  if (looks_beyond_points() && faces.any()) find_ends();
  return most_by_rows;
}

/** Finds where material ends at faces. A last cell with a single layer of points conducts only
 *  along one combination of its nodes, that of the functions at the end of the layer. Heat with
 *  other weights, as at a face some way off, would stay in these nodes. */
void MPMConduction::find_ends()
{
  static constexpr double REACH = 5.0;    // node spacings: the cell of a face and the next one
  const MPMFrame &frame = *field.frame;
  const double reach = REACH * field.lattice.h;
  const auto add = [&](const MPMCutDomains::Part &part) {
    const int i = part.point;
    const double V = part.volume * atom->vfrac[i] * frame.lattice_jacobian(i) /
        frame.circle(frame.places()[i][0]);
    cuts.each_node(part, [&](int node, const double *slope) {
      for (int d = 0; d < 3; d++) ends[3 * node + d] += V * slope[d];
    });
  };
  ends.assign(3 * field.grid.nnodes(), 0.0);
  for (const auto &part : cuts.parts)
    if (faces.is_near(frame.places()[part.point], reach)) add(part);
  each_point(field, [&](const auto &run, int i) {
    MPMCutDomains::Part whole;
    if (thermal(run.material) && !cuts.is_cut[i] && faces.is_near(frame.places()[i], reach) &&
        cuts.make_whole(i, run, whole))
      add(whole);
  });
  field.nodes.sum(ends.data(), 3, 0, 3);
  field.nodes.complete(ends.data(), 3, 3);
}

void MPMConduction::add_points(const MPMRows &gradients, bool starts)
{
  const int dim = field.lattice.dim;
  const bool relaxes = transfer.kind == MPMHeatTransfer::RELAX;
  ranges.clear();
  wanted = made = false;
  at_start = relaxes && starts && !faces.any() ? TO_BE_SEEN : OF_NODES;
  if (at_start == TO_BE_SEEN) seen.resize(atom->nmax);
  simple = !total && steepest > 0.0;
  keeps = relaxes && at_start == OF_NODES;
  double most = 0.0;
  volumes.resize(atom->nmax);
  if (layers)
    layers->find([&](const MPMPointMap::Run &run, int first, int n, double *k, double *V) {
      const Thermal *const t = thermal(run.material);
      if (!t) return false;
      Conduction buffer;
      for (int p = 0; p < n; p++) {
        k[p] = t->at(first + p, buffer).conductivity;
        V[p] = volume_of(first + p);
      }
      return true;
    });
  scalar.points_to_nodes(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Points &points) {
        const Thermal *const t = thermal(run.material);
        if (!t) return false;
        const double *const rmass = atom->rmass + first, *const vfrac = atom->vfrac + first;
        double *const V = volumes.data() + first;
        double buffer[BATCH];
        const double *const J = field.jacobians.get(field, first, n, buffer);
        for (int p = 0; p < n; p++) V[p] = vfrac[p] * J[p];
        Conduction c = t->all;
        double greatest = c.most();
        const double *const history = t->fix->history[first];
        const int width = t->fix->nhistory;
        points.at.values = history + t->temperature;
        points.at.value_width = width;
        if (gradients) {
          points.at.slopes = gradients[first];
          points.at.slope_width = dim;
        }
        if (simple && !t->varies && !layers) {
          for (int p = 0; p < n; p++) points.capacity[p] = rmass[p] * c.capacity;
          for (int p = 0; p < n; p++) buffer[p] = greatest * V[p];
        } else {
          for (int p = 0; p < n; p++) {
            if (t->varies) {
              c = t->fix->material->conduction(history + width * p);
              greatest = c.most();
            }
            if (layers) greatest = layers->most(first + p);
            if (!simple) most = std::max(most, bound(*t, first + p, V[p]));
            points.capacity[p] = rmass[p] * c.capacity;
            buffer[p] = greatest * V[p];
          }
        }
        if (simple) raise_ratio(most, n, buffer, points.capacity);
        for (int p = 0; wants_volumes && p < n; p++)
          points.volume[p] = total ? vfrac[p] * field.frame->lattice_jacobian(first + p) : V[p];
        return true;
      },
      false);
  fastest_point = most;
}

double MPMConduction::end_nodes()
{
  if (keeps) scalar.keep();
  if (transfer.kind == MPMHeatTransfer::XPIC) find_unseen();
  find_ranges();
  return simple ? fastest_point * steepest : fastest_point;
}

/** XPIC: before becomes the difference of the temperatures from those of the series, so that points
 *  get the new temperature less this difference. */
void MPMConduction::find_unseen()
{
  std::vector<double> &unseen = scalar.before;
  unseen = temperature;
  scalar.add_terms(
      transfer.order,
      [this](const MPMPointMap::Run &run, int first, int n, double *C) {
        const Thermal *const t = thermal(run.material);
        Conduction buffer;
        for (int p = 0; p < n; p++)
          C[p] = atom->rmass[first + p] * t->at(first + p, buffer).capacity;
      },
      unseen);
  for (std::size_t k = 0; k < unseen.size(); k++) unseen[k] = temperature[k] - unseen[k];
}

/** Are fluxes along gradients, with one number for each material? */
bool MPMConduction::is_plain() const
{
  return !total && !layers && shares.empty() &&
      std::none_of(thermals.begin(), thermals.end(), [](const Thermal &t) {
        return t.varies || t.all.orthotropic;
      });
}

/** Turns gradients of n points into fluxes times volumes, and values into 0. */
void MPMConduction::conduct(const Thermal &t, int first, int n, MPMNodeScalar::Rows q,
                            Left left) const
{
  Conduction buffer;
  for (int p = 0; p < n; p++) {
    const double conducting = conducting_volume(first + p, left);
    if (total || t.all.orthotropic) {
      double k[3][3], flux[3];
      tensor(t, first + p, k);
      MathExtra::matvec(k, q[p], flux);
      for (int d = 0; d < 3; d++) q[p][d] = -conducting * flux[d];
    } else if (layers) {
      double times = -conducting;
      if (t.jumps && !ranges.empty()) {
        const double mean = conduction_of(t, first + p, buffer).conductivity;
        times *= mean / t.at(first + p, buffer).conductivity;
      }
      layers->multiply(first + p, q[p]);
      for (int d = 0; d < 3; d++) q[p][d] *= times;
    } else {
      const double factor = -conducting * conduction_of(t, first + p, buffer).conductivity;
      for (int d = 0; d < 3; d++) q[p][d] *= factor;
    }
    q[p][3] = 0.0;
  }
}

/** Adds the conduction of points whose domains are in several cells. */
void MPMConduction::conduct_parts()
{
  for (const auto &part : cuts.parts) {
    double q[1][4] = {};
    cuts.gradient(part, temperature, q[0]);
    conduct(*thermal(field.material_of(part.point)), part.point, 1, q, ALL);
    for (int d = 0; d < 3; d++) q[0][d] *= part.volume * part.share;
    cuts.add(part, q[0], rate);
  }
}

/** Visits the terms of points. A node that a point sees from several corners of its domain counts
 *  once. */
void MPMConduction::each_term(const MPMDiffusion::Term &use) const
{
  const MPMStencil stencil(field);
  const int dim = field.lattice.dim;
  std::vector<int64_t> nodes;
  std::vector<double> gradients;
  const auto give = [&](const Thermal &t, int i, double times, Left left) {
    double k[3][3], stiffness[9];
    if (total || t.all.orthotropic) {
      times *= conducting_volume(i, left);
      tensor(t, i, k);
    } else {
      double q[3][4] = {};
      for (int column = 0; column < dim; column++) {
        q[column][column] = -1.0;
        conduct(t, i, 1, q + column, left);
        for (int d = 0; d < dim; d++) k[d][column] = q[column][d];
      }
    }
    for (int d = 0; d < dim; d++)
      for (int e = 0; e < dim; e++) stiffness[dim * d + e] = times * k[d][e];
    use((int) nodes.size(), nodes.data(), dim, gradients.data(), stiffness);
  };
  each_point(field, [&](const auto &run, int i) {
    const Thermal *const t = thermal(run.material);
    if (!t || (cuts.any() && cuts.is_cut[i])) return;
    const auto &block = field.grid.blocks[run.slot];
    if (field.domains) {
      nodes.clear();
      gradients.clear();
      stencil.visit(block, i, [&](const MPMStencil::Node &node) {
        const std::size_t k = std::find(nodes.begin(), nodes.end(), node.number) - nodes.begin();
        if (k == nodes.size()) {
          nodes.push_back(node.number);
          gradients.resize(gradients.size() + dim, 0.0);
        }
        for (int d = 0; d < dim; d++) gradients[dim * k + d] += node.gradient[d];
      });
    } else {
      stencil.find_gradients(block, i, nodes, gradients);
    }
    give(*t, i, 1.0, AS_SHARES);
  });
  for (const auto &part : cuts.parts) {
    nodes.clear();
    gradients.clear();
    cuts.each_node(part, [&](int node, const double *slope) {
      nodes.push_back(node);
      gradients.insert(gradients.end(), slope, slope + dim);
    });
    give(*thermal(field.material_of(part.point)), part.point, part.volume * part.share, ALL);
  }
}

void MPMConduction::expect_rates(int number)
{
  // with more, the matrix and rates from it take less time than rates from points
  const int few = field.lattice.dim == 3 ? 16 : 8;
  wanted = number > few && !field.domains && !scalar.is_level;
}

/** Conductivities, places, and sources of points do not change in a step. Collective. */
void MPMConduction::make_matrix(const double *source)
{
  matrix.begin(field.grid, stencil_order(field.options.shape));
  each_term([this](int n, const int64_t *nodes, int ngrad, const double *G, const double *K) {
    matrix.add_point(n, nodes, ngrad, G, K);
  });
  matrix.finish();
  made = true;
  power_of_sources = 0.0;
  if (!source) return;
  scalar.add_up(
      [&](const MPMPointMap::Run &, int first, int n, double *of_points) {
        double sum = 0.0;
        for (int p = 0; p < n; p++) sum += of_points[p] = volumes[first + p] * source[first + p];
        power_of_sources += sum;
      },
      rate_by_sources);
  scalar.divide(rate_by_sources);
}

void MPMConduction::find_rates(const double *source, Heats &power)
{
  if (wanted && at_start != TO_BE_SEEN) {
    if (!made) make_matrix(source);
    field.nodes.complete(temperature.data(), 1, 1);
    matrix.multiply(temperature.data(), rate.data());
    for (double &r : rate) r = -r;
    scalar.sum_rates();
    if (!source) return;
    for (std::size_t k = 0; k < rate.size(); k++) rate[k] += rate_by_sources[k];
    power[SOURCES] += power_of_sources;
    return;
  }
  const auto see = [&](int first, int n, const MPMNodeScalar::Rows q) {
    for (int p = 0; at_start == TO_BE_SEEN && p < n; p++) seen[first + p] = q[p][3];
  };
  if (!source && is_plain())
    scalar.find_rates_along([&](const MPMPointMap::Run &run, int first, int n,
                                const MPMNodeScalar::Rows q, double *factors) {
      see(first, n, q);
      const double k = thermal(run.material)->all.conductivity, *const V = volumes.data() + first;
      for (int p = 0; p < n; p++) factors[p] = -k * V[p];
    });
  else
    scalar.find_rates(
        [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q) {
          see(first, n, q);
          conduct(*thermal(run.material), first, n, q);
          if (!source) return;
          const double *const V = volumes.data() + first;
          double sum = 0.0;
          for (int p = 0; p < n; p++) sum += q[p][3] = V[p] * source[first + p];
          power[SOURCES] += sum;
        },
        [this]() {
          conduct_parts();
        });
  if (at_start == TO_BE_SEEN) at_start = SEEN;
}

void MPMConduction::add_given()
{
  for (std::size_t k = 0; k < given.size(); k++)
    if (scalar.capacity[k] > 0.0) rate[k] += given[k] / (duration * scalar.capacity[k]);
}

void MPMConduction::give(std::vector<double> &energy)
{
  const auto &pic = field.pic;
  clear_points(at_rest, atom, 3);
  const PointRows r = field.rows_at_rest(at_rest.data(), energy.data());
  const TransferStep still = field.step_data(0.0);
  auto &nodes = field.work.nodes;
  points_to(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    if (std::any_of(energy.begin() + run.first, energy.begin() + run.last, [](double e) {
          return e != 0.0;
        }))
      pic.p2g_momentum(r, still, run.first, run.last, base, field.map->tile, box);
  });
  field.nodes.sum(nodes.data(), pic.nreal, 3, 1);
  given.resize(field.grid.nnodes(), 0.0);
  for (std::size_t n = 0; n < given.size(); n++) given[n] += nodes[n * pic.nreal + 3];
}

/** How often heat crosses a cell in this step, in the material that conducts least, or in another
 *  one. */
double MPMConduction::crossings() const
{
  return duration * (slowest_crossing > 0.0 ? slowest_crossing : crossing_rate());
}

double MPMConduction::crossings_of(const Thermal &t) const
{
  const double h = widest_cell > 0.0 ? widest_cell : field.lattice.h;
  return std::max(crossings(), duration * (own_share * t.diffusivity / (h * h)));
}

bool MPMConduction::has_faster() const
{
  constexpr double SAME = 1.0 + 1.0e-9;
  return transfer.kind == MPMHeatTransfer::RELAX && transfer.relax > 0.0 &&
      std::any_of(thermals.begin(), thermals.end(), [&](const Thermal &t) {
           return is_present(t) && crossings_of(t) > SAME * crossings();
         });
}

void MPMConduction::find_faster()
{
  if (at_start != SEEN) {    // nodes have kept their temperatures of the start
    seen.resize(atom->nmax);
    temperature.swap(scalar.before);
    scalar.values_to_points(
        [this](const MPMPointMap::Run &, int first, int n, const double *values) {
          std::copy_n(values, n, seen.data() + first);
        });
    temperature.swap(scalar.before);
    at_start = SEEN;
  }
  const double keep = exp(-transfer.relax * crossings());
  scalar.add_up(
      [&](const MPMPointMap::Run &run, int first, int n, double *heat) {
        const Thermal *const t = thermal(run.material);
        const double less = keep - exp(-transfer.relax * crossings_of(*t));
        Conduction buffer;
        for (int p = 0; p < n; p++) {
          const int i = first + p;
          heat[p] = atom->rmass[i] * t->at(i, buffer).capacity * less *
              (t->fix->history[i][t->temperature] - seen[i]);
        }
      },
      rate);
  for (std::size_t k = 0; !scalar.is_level && k < rate.size(); k++)
    rate[k] = scalar.capacity[k] > 0.0 ? rate[k] / scalar.capacity[k] : 0.0;
}

double MPMConduction::nodes_to_points(const MPMRows &gradients)
{
  const int dim = field.lattice.dim;
  const bool relaxes = transfer.kind == MPMHeatTransfer::RELAX,
             xpic = transfer.kind == MPMHeatTransfer::XPIC, faster = has_faster();
  double got = 0.0;
  change = 0.0;
  scalar.nodes_to_points(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q,
          const double *before) {
        if (at_start == SEEN) before = seen.data() + first;
        const Thermal *const t = thermal(run.material);
        Conduction c = t->all;
        const double keep =
            relaxes ? exp(-transfer.relax * (faster ? crossings_of(*t) : crossings())) : 0.0;
        double sum = 0.0, most = change, *const rows = t->fix->history[first];
        const double *const rmass = atom->rmass + first;
        const int width = t->fix->nhistory;
        if_plain(relaxes && !t->varies && !c.by_enthalpy && t->molten < 0, [&](auto plain) {
          for (int p = 0; p < n; p++) {
            double *const history = rows + width * p, &T = history[t->temperature];
            if (!plain && t->varies) c = t->fix->material->conduction(history);
            double now = q[p][3];
            if (plain || relaxes) now += keep * (T - before[p]);
            if (!plain && xpic) now -= before[p];
            sum += rmass[p] * c.capacity * (now - T);
            most = std::max(most, fabs(now - T));
            if (!plain && c.by_enthalpy) {
              t->fix->material->warm(history, c.capacity * (now - T));
            } else {
              T = now;
              if (!plain && t->molten >= 0) c.melting.settle(T, history[t->molten]);
            }
          }
        });
        if (gradients && dim == 3)
          copy_rows<3>(n, q[0], gradients[first]);
        else if (gradients)
          copy_rows<2>(n, q[0], gradients[first]);
        got += sum;
        change = most;
      },
      (relaxes && at_start == OF_NODES) || xpic);
  ranges.clear();
  return got;
}

double MPMConduction::memory_usage() const
{
  return faces.memory_usage() + scalar.memory_usage() + (layers ? layers->memory_usage() : 0.0) +
      cuts.memory_usage() + matrix.memory_usage() +
      bytes_of(rate_by_sources, idle, ends, capacity_at_faces, volumes, seen, shares, given);
}
