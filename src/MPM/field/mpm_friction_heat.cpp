/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_friction_heat.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_points.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_passes.h"
#include "fix.h"
#include "force.h"
#include "material/material.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* A tangential impulse J_t between bodies of relative velocity u takes the kinetic energy
 *  J_t . (u_old + u_new)/2 from the nodes, which is the heat where the bodies slide. */

void MPMFrictionHeatOptions::declare(Options &o, const char *yes, const char *first)
{
  using namespace option;
  o.add("heat",
        {word(kind,
              {{"no", NO, "the energy lost by friction is not converted into heat"},
               {"yes", YES, yes},
               {"share", SHARE, "", {number(share, "S", FRACTION, "1", first)}}})},
        "heat of friction for :doc:`fix mpm/heat <fix_mpm_heat>`")
      .then([this] {
        said = true;
      });
}

MPMFrictionHeat::MPMFrictionHeat(LAMMPS *lmp, const MPMFrictionHeatOptions &options) :
    Pointers(lmp), options(options)
{
}

/** Is an axis neither in the plane nor normal to it? */
static bool leaves_plane(const Conduction &c)
{
  constexpr double SAME = 1.0e-9;
  const double I[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  double k[3], n[3][3];
  principal_conductivities(c, I, k, n);
  return std::any_of(n, n + 3, [](const double *axis) {
    return std::fabs(axis[2]) > SAME && std::hypot(axis[0], axis[1]) > SAME;
  });
}

void MPMFrictionHeat::begin_run(const Fix &user, const std::vector<MPMField *> &fields)
{
  const auto sinks = find_fixes<MPMHeatSink>(lmp);
  if (sinks.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {} heat: nothing conducts the heat of friction: define a fix mpm/heat, or "
               "drop the keyword",
               user.style, user.id);
  sink = sinks[0];
  bodies.clear();
  bool any = false, points = false;
  for (auto *field : fields) {
    Body body = {field, false, false, false, 0.0, {}};
    const std::vector<signed char> here = field->present_materials();
    int nhere = 0, nconducting = 0;
    for (std::size_t k = 0; k < here.size(); k++) {
      if (!here[k]) continue;
      nhere++;
      points = true;
      const auto &material = *field->materials[k]->material;
      if (!material.conducts()) continue;
      const Conduction c = material.conduction(nullptr);
      if (c.orthotropic && domain->dimension == 2 && leaves_plane(c))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix {} {} heat: in 2d, an axis of the conductivity of fix mpm/material {} must "
                   "be normal to the plane: choose other axes",
                   user.style, user.id, field->materials[k]->id);
      nconducting++;
      body.orthotropic = body.orthotropic || c.orthotropic;
      body.mixed = body.mixed || material.conduction_varies();
      body.effusivity = std::sqrt(c.conductivity * material.density() * c.capacity);
    }
    body.mixed = nconducting > 0 && (body.mixed || body.orthotropic || nhere > 1);
    any = any || nconducting > 0;
    field->keep_old_velocities();
    bodies.push_back(body);
  }
  if (points && !any)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {} heat: no material of its bodies conducts heat: give a fix mpm/material "
               "the part 'thermal conducting', or drop the keyword",
               user.style, user.id);
}

void MPMFrictionHeat::begin_step()
{
  for (auto &body : bodies) {
    body.conducts = sink->conducts(*body.field);
    if (body.orthotropic)
      map_tensor(body);
    else if (body.mixed)
      map_effusivity(body);
  }
}

/** Means over points, weighted with their volumes, of numbers that value(i, c, values) gives for a
 *  point and what it conducts; points that do not conduct count as 0. To at_node, of so many reals,
 *  from one of them on. */
template <class F>
void MPMFrictionHeat::map_means(Body &body, int first, int nvalue, int width, const F &value)
{
  MPMField &field = *body.field;
  const auto &pic = field.pic;
  const std::size_t nmax = atom->nmax;
  clear_points(values, atom, 3);
  weights.resize(nmax);
  const PointRows r = field.rows_at_rest(values.data(), weights.data());
  const TransferStep still = field.step_data(0.0);
  auto &nodes = field.work.nodes;
  points_to(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    for (int i = run.first; i < run.last; i++) {
      weights[i] = atom->vfrac[i] * field.points->jacobian(i);
      if (run.material && run.material->material->conducts())
        value(i, run.material->material->conduction(run.material->history[i]),
              &values[3 * (std::size_t) i]);
    }
    pic.p2g_momentum(r, still, run.first, run.last, base, field.map->tile, box);
  });
  field.nodes.sum(nodes.data(), pic.nreal, 0, 4);
  body.at_node.resize(width * field.grid.nnodes());
  const double *node = nodes.data();
  for (std::size_t n = 0; n < (std::size_t) field.grid.nnodes(); n++, node += pic.nreal)
    for (int k = 0; k < nvalue; k++)
      body.at_node[width * n + first + k] = node[3] > 0.0 ? node[k] / node[3] : 0.0;
}

void MPMFrictionHeat::map_effusivity(Body &body)
{
  map_means(body, 0, 1, 1, [&](int i, const Conduction &c, double *e) {
    *e = std::sqrt(c.conductivity * atom->rmass[i] / weights[i] * c.capacity);
  });
}

/** Rows and columns of the components of a symmetric tensor, those in the plane of 2d first. */
static constexpr int ROW[2][6] = {{0, 1, 0}, {0, 1, 2, 0, 0, 1}};
static constexpr int COLUMN[2][6] = {{0, 1, 1}, {0, 1, 2, 1, 2, 2}};

/** The square roots of the tensors K rho c: with their mean E the effusivity along a normal is |E
 *  n|, which is sqrt(n.K.n rho c) for a single material, and the mean of sqrt(K rho c) for several
 *  isotropic ones. */
void MPMFrictionHeat::map_tensor(Body &body)
{
  const int dim = domain->dimension, width = dim == 3 ? 6 : 3;
  for (int first = 0; first < width; first += dim)
    map_means(body, first, std::min(dim, width - first), width,
              [&](int i, const Conduction &c, double *e) {
                double k[3], n[3][3];
                principal_conductivities(c, body.field->points->F[i], k, n);
                for (int j = 0; j < dim && first + j < width; j++)
                  for (int a = 0; a < 3; a++)
                    e[j] += std::sqrt(k[a] * atom->rmass[i] / weights[i] * c.capacity) *
                        n[a][ROW[dim - 2][first + j]] * n[a][COLUMN[dim - 2][first + j]];
              });
}

std::size_t MPMFrictionHeat::node_of(const Body &body, const double *record) const
{
  const Grid &grid = body.field->grid;
  return (record - body.field->grid.nodes()) / grid.nreal;
}

/** Along a unit normal; without one, something that is 0 only if nothing conducts there. */
double MPMFrictionHeat::effusivity(const Body &body, const double *record,
                                   const double *normal) const
{
  if (!body.mixed) return body.effusivity;
  const std::size_t node = node_of(body, record);
  if (!body.orthotropic) return body.at_node[node];
  const int dim = domain->dimension, width = dim == 3 ? 6 : 3;
  const double *const e = &body.at_node[width * node];
  if (!normal) return e[0];
  double en[3] = {0.0, 0.0, 0.0}, sum = 0.0;
  for (int j = 0; j < width; j++) {
    const int a = ROW[dim - 2][j], b = COLUMN[dim - 2][j];
    en[a] += e[j] * normal[b];
    if (a != b) en[b] += e[j] * normal[a];
  }
  for (const double x : en) sum += x * x;
  return std::sqrt(sum);
}

double MPMFrictionHeat::made(const double *J, const double *old, const double *now, int dim) const
{
  double work = 0.0;
  for (int d = 0; d < dim; d++) work += 0.5 * J[d] * (old[d] + now[d]);
  return -work * force->mvv2e;
}

void MPMFrictionHeat::give(Body &body, const double *record, double energy, bool owned)
{
  // among points of several materials a node may have none that conducts
  if (!body.conducts || energy == 0.0 || effusivity(body, record, nullptr) == 0.0) return;
  sink->give(*body.field, node_of(body, record), energy, owned);
}

void MPMFrictionHeat::between(int a, const double *ra, int b, const double *rb,
                              const double *normal, double energy, bool owned)
{
  double share = options.share;
  if (options.kind == MPMFrictionHeatOptions::YES) {
    const double ea = effusivity(bodies[a], ra, normal), eb = effusivity(bodies[b], rb, normal);
    share = ea + eb > 0.0 ? ea / (ea + eb) : 0.0;
  }
  give(bodies[a], ra, share * energy, owned);
  give(bodies[b], rb, (1.0 - share) * energy, owned);
}

void MPMFrictionHeat::at_wall(int field, const double *record, double energy, bool owned)
{
  give(bodies[field], record, options.share * energy, owned);
}

double MPMFrictionHeat::memory_usage() const
{
  double bytes = (values.capacity() + weights.capacity()) * sizeof(double);
  for (const auto &body : bodies) bytes += body.at_node.capacity() * sizeof(double);
  return bytes;
}

/** The rotation R of F = R U, by R <- (R + R^-T)/2 (N.J. Higham, SIAM J. Sci. Stat. Comput. 7
 *  (1986) 1160). */
static void rotation(const double *F, double R[3][3])
{
  static constexpr int MOST = 30;
  memcpy(R, F, 9 * sizeof(double));
  for (int k = 0; k < MOST; k++) {
    double inverse[3][3], change = 0.0;
    MathExtra::invert3(R, inverse);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        const double next = 0.5 * (R[a][b] + inverse[b][a]);
        change = std::max(change, fabs(next - R[a][b]));
        inverse[b][a] = next;
      }
    MathExtra::transpose3(inverse, R);
    if (change < 1.0e-14) return;
  }
}

void LAMMPS_NS::principal_conductivities(const Conduction &c, const double *F, double k[3],
                                         double n[3][3])
{
  k[0] = c.conductivity;
  for (int a = 1; a < 3; a++) k[a] = c.orthotropic ? c.across[a - 1] : c.conductivity;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) n[a][b] = a == b;
  if (!c.orthotropic) return;
  double R[3][3];
  rotation(F, R);
  MathExtra::times3_transpose(c.axis, R, n);
}
