/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Contact between the sides of a node. The gap of a new crack is a small part of a node spacing,
 *  which the volumes of points cannot tell. Points on surfaces therefore remember how far the crack
 *  is open, the integral of the velocity at which sides part, and sides touch when it is closed. If
 *  it is open by more than half a spacing, as surfaces are that have never been together, sides
 *  touch when they fill the volume of the node, as in fix mpm/contact gap yes. */

#include "fracture/fix_mpm_fracture.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "force.h"
#include "fracture/mpm_free_surface.h"
#include "group.h"
#include "material/material.h"
#include "math_extra.h"
#include "modify.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

// openings [node spacings]: from which on volumes tell more; of free surfaces at the start, of
// which two may be those of a corner that goes into a body; of what has been apart, and most
static constexpr double FAR = 0.5, FREE = 0.75, APART = 0.9, MOST = 1.0;
// share of the volume of a node that must not decide whether surfaces touch
static constexpr double ROUNDING = 1.0e-8;
// component of a unit vector before the first run
static constexpr double UNKNOWN = 2.0;

/** fix ID all mpm/fracture keyword values ... */
Options MPMFractureOptions::declare()
{
  using namespace option;
  Options o("fix mpm/fracture");
  o.add("separable",
        {number(separable, "D", {0.0, 1.0, false, true}, "",
                "damage of points from which on a crack between them is open")});
  o.add("surface",
        {word(surface,
              {{"no", NONE, "only what is damaged is a surface"},
               {"yes", FREE_ONES, "surfaces that bodies have at their start can meet, too"},
               {"group",
                OF_GROUP,
                "the same for surfaces of a group and of the rest, which may touch each other",
                {text(surface_group, "ID", "group of points on one side")}}})});
  declare_law(o, false);
  o.refuse([=] {
    return OptionRules{coefficients()};
  });
  return o;
}

FixMPMFracture::FixMPMFracture(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), openings(nullptr)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/fracture acts on nodes, which have no group: use group all");
  Options declared = declare();
  read_options(lmp, declared, narg, arg, 3);
  complete();
  pressure_unit = force->ftm2v / force->nktv2p;
  scalar_flag = vector_flag = 1;
  size_vector = 2;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  if (surface != NONE)
    state.declare(normals, "mpm/fracture:normal", 3, [](int, double *row) {
      row[0] = UNKNOWN;
      row[1] = row[2] = 0.0;
    });
  state.declare(openings, "mpm/fracture:opening");
  keep_arrays();
}

void FixMPMFracture::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this, "one acts on all bodies");
  if (surface == OF_GROUP && group->find(surface_group) < 0)
    error->all(FLERR, Error::NOLASTLINE, "Group {} for fix mpm/fracture {} does not exist",
               surface_group, id);
  for (const char *style : {"implicit", "incompressible", "mixture", "pore", "refine", "handshake"})
    if (!modify->get_fix_by_style(std::string("^mpm/") + style + "$").empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/fracture {} cannot be used with fix mpm/{}, which knows no sides of "
                 "nodes: remove it, and give pieces that shall part fields of their own, with fix "
                 "mpm/contact",
                 id, style);
}

void FixMPMFracture::init_physics(MPMPlan &plan)
{
  const auto materials = find_fixes<FixMPMMaterial>(lmp);
  if (surface == NONE && comm->me == 0 &&
      std::none_of(materials.begin(), materials.end(), [](const auto *material) {
        return material->damage >= 0;
      }))
    error->warning(
        FLERR,
        "Fix mpm/fracture {} finds no surfaces, as no material has a damage: give one to "
        "what may break, or use surface yes",
        id);
  walls = find_fixes<FixMPMBoundary>(lmp);
  bodies.clear();
  for (auto *field : plan.fields) {
    const auto &o = field->options;
    refuse_field(
        lmp, *this, *field,
        {{o.scheme != MPMFieldOptions::USL, "this scheme", "use scheme usl"},
         {o.total, "frame total", "use frame updated"},
         {o.axisymmetric, "axisymmetric", "use a sector in 3d"},
         {has_domain(o.shape) || o.shape == BERNSTEIN, "this shape", "use shape quadratic"},
         {o.polypic || o.has_xpic() || o.has_fmpm(), "this transfer", "use transfer apic"},
         {o.averages_strain() || o.averages_stress(), "locking", "use locking none"},
         {o.smooths_volumes(), "smooth", "it is for fluids, which have no cracks: drop it"},
         {o.heats(), "heat", "drop it"},
         {o.has_light_nodes(), "light", "use light 0"},
         {o.modified_edges, "edges modified", "use edges plain"}});
    field->stretching.push_back(this);
    bodies.push_back(
        std::make_unique<Body>(Body{field, MPMSplitNodes(lmp, *field), {}, {}, false, 0.0, {}}));
    bodies.back()->inside.find(*field, *domain);
    bodies.back()->surface.separable = separable;
    bodies.back()->surface.apart = APART * field->lattice.h;
  }
}

/** Also of points that have come since the last run. */
void FixMPMFracture::setup_points()
{
  for (const auto &body : bodies) mark_surfaces(*body->field);
}

void FixMPMFracture::mark_surfaces(MPMField &field)
{
  if (surface == NONE) return;
  int mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++) mine |= field.is_point(i) && normals[i][0] == UNKNOWN;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, world);
  if (!all) return;
  const int bit = surface == OF_GROUP ? group->bitmask[group->find(surface_group)] : 0;
  std::vector<double> found(3 * (std::size_t) atom->nmax, 0.0);
  for (const bool inside : {true, false})
    find_free_surface(
        field,
        [&](int i) {
          const auto *const material = field.material_of(i);
          return material && material->material->is_solid() &&
              inside == ((atom->mask[i] & bit) == bit);
        },
        found);
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    if (normals[i][0] != UNKNOWN) return;
    const double *const n = &found[3 * (std::size_t) i];
    const double *const F = field.points->F[i];
    for (int d = 0; d < 3; d++) normals[i][d] = F[d] * n[0] + F[3 + d] * n[1] + F[6 + d] * n[2];
    if (is_marked(i)) openings[i] = FREE * field.lattice.h;
  });
}

bool FixMPMFracture::is_marked(int i) const
{
  return surface != NONE && normals[i][0] != UNKNOWN && MathExtra::len3(normals[i]) > 0.0;
}

double FixMPMFracture::surface_of(const FixMPMMaterial *material, int i) const
{
  if (is_marked(i)) return 1.0;
  return material && material->crack >= 0 ? material->history[i][material->crack] : 0.0;
}

double FixMPMFracture::quantity(int k, int i) const
{
  if (k == 1) return openings[i];
  for (const auto &body : bodies)
    if (body->field->is_point(i)) return surface_of(body->field->material_of(i), i);
  return 0.0;
}

void FixMPMFracture::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  const Data points = {Data::POSITION, Data::VELOCITY, Data::AFFINE, Data::DEFORMATION,
                       Data::STRESS,   Data::HISTORY,  Data::MASS,   Data::FORCE};
  const Data all = points + Data{Data::NODES, Data::BLOCKS, Data::OWN}, own = {Data::OWN};
  const auto of_each = [this](void (FixMPMFracture::*stage)(Body &)) {
    return [this, stage] {
      for (auto &body : bodies) (this->*stage)(*body);
    };
  };
  if (place == MPMPlan::AFTER_MOMENTUM) {
    plan.together("sides of nodes", all, own, of_each(&FixMPMFracture::split));
    plan.together("contact of sides", all, own, of_each(&FixMPMFracture::touch));
  }
  if (place == MPMPlan::BEFORE_STRAIN)
    plan.together("sides to points", all, own, of_each(&FixMPMFracture::follow));
  if (place == MPMPlan::POINTS_HAVE_MOVED)
    plan.together("sides to points", own, points, [this] {
      for (auto &body : bodies)
        if (body->is_split) body->split.set_motion();
    });
}

/** The normal of a surface that moves with the material, F^-T N. */
void FixMPMFracture::find_normal(const MPMField &field, int i, double *n) const
{
  MathExtra::zero3(n);
  if (!is_marked(i)) return;
  const double *const F = field.points->F[i], *const N = normals[i];
  double of_rows[3];
  for (int k = 0; k < 3; k++) {    // columns of the cofactors are products of columns of F
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const double one[3] = {F[a], F[3 + a], F[6 + a]}, two[3] = {F[b], F[3 + b], F[6 + b]};
    MathExtra::cross3(one, two, of_rows);
    for (int d = 0; d < 3; d++) n[d] += of_rows[d] * N[k];
  }
  const double length = MathExtra::len3(n);
  for (int d = 0; d < 3; d++) n[d] = length > 0.0 ? n[d] / length : 0.0;
}

void FixMPMFracture::split(Body &body)
{
  auto &value = body.surface.value, &normal = body.surface.normal;
  value.resize(atom->nmax);
  if (surface != NONE) normal.resize(3 * (std::size_t) atom->nmax);
  each_point(*body.field, [&](const MPMPointMap::Run &run, int i) {
    value[i] = surface_of(run.material, i);
    if (surface != NONE) find_normal(*body.field, i, &normal[3 * (std::size_t) i]);
  });
  body.surface.opening = openings;
  body.is_split = body.split.find(body.surface);
}

/** Impulses between sides, which do not change the velocity of the node. */
void FixMPMFracture::touch(Body &body)
{
  body.lost = 0.0;
  if (!body.is_split) return;
  const MPMField &field = *body.field;
  const int dim = field.lattice.dim;
  const double dt = field.step_dt(), far = FAR * field.lattice.h;
  auto &split = body.split;
  for (int k = 0; k < (int) split.list().size(); k++) {
    auto &node = split.list()[k];
    MPMNodeContact pair = {};
    pair.ra = split.record(k, 0);
    pair.rb = split.record(k, 1);
    for (int d = 0; d < 3; d++) pair.n[d] = node.push[d];
    const auto parting = [&] {
      double speed = 0.0;
      for (int d = 0; d < dim; d++) speed += (pair.rb[d] - pair.ra[d]) * pair.n[d];
      return speed;
    };
    int index[3];
    field.grid.node_index(field.grid.blocks[node.number / NODES_PER_BLOCK],
                          (int) (node.number % NODES_PER_BLOCK), index);
    bool mirrored;
    const double inside = body.inside.at(index, dim, mirrored);
    const bool is_far = node.opening >= far, is_full = node.filled >= inside * (1.0 - ROUNDING);
    const bool touches = is_far ? is_full : node.opening + dt * parting() <= 0.0;
    if (touches) {
      // work of the impulses, along the mean of the velocities at the start and at the end
      double energy = 0.0, before[2][3];
      std::copy_n(pair.ra, 3, before[0]);
      std::copy_n(pair.rb, 3, before[1]);
      pair.begin({}, {});
      pair.iterate(*this, dim, 1, dt, false);
      pair.push(dim);
      for (const int side : {0, 1}) {
        const double *const r = split.record(k, side);
        for (int d = 0; d < dim; d++)
          energy -= r[3] * (r[d] - before[side][d]) * 0.5 * (r[4 + d] + r[d]);
      }
      if (node.owned) body.lost += energy;
    }
    node.held = touches;
    // what is far apart once is so for ever
    node.change = is_far ? MOST * field.lattice.h - node.opening
                         : std::max(-node.opening, dt * parting());
  }
  lost += body.lost;
  split.remember();
}

/** The relative motion of sides is in no account of the nodes: what transfers do to it, what
 *  contact takes, and what stress and the rest of it have done. */
void FixMPMFracture::account_for_sides(Body &body) const
{
  auto &ledger = body.field->ledger;
  if (!ledger.on) return;
  double gained = 0.0;    // by relative motion in this step
  for (int k = 0; k < (int) body.split.list().size(); k++) {
    if (!body.split.list()[k].owned) continue;
    const double *const both = body.field->grid.record(body.split.list()[k].number);
    for (const int lane : {0, 4})
      for (int d = lane; d < lane + body.field->lattice.dim; d++) {
        double energy = -0.5 * both[3] * both[d] * both[d];
        for (const int side : {0, 1}) {
          const double *const r = body.split.record(k, side);
          energy += 0.5 * r[3] * r[d] * r[d];
        }
        gained += lane == 0 ? energy : -energy;
      }
  }
  gained *= force->mvv2e;
  const double taken = body.lost * force->mvv2e;
  ledger.transfer -= gained;
  ledger.contact -= taken;
  ledger.internal -= gained + taken;
}

/** What walls and other bodies have done since. */
void FixMPMFracture::follow(Body &body)
{
  if (!body.is_split) return;
  body.held.clear();
  if (!walls.empty()) body.held.assign(body.field->grid.nnodes(), 0);
  for (auto *wall : walls) wall->mark_prescribed(*body.field, body.held);
  body.split.follow(body.held);
  account_for_sides(body);
  body.split.open_points(openings, MOST * body.field->lattice.h);
  body.split.find_motion();
}

bool FixMPMFracture::stretches(int first, int n) const
{
  return std::any_of(bodies.begin(), bodies.end(), [=](const auto &body) {
    return body->is_split && body->split.has_points(first, n);
  });
}

void FixMPMFracture::stretch_gradients(MPMField &field, int first, int n, double, double *L)
{
  for (const auto &body : bodies)
    if (body->field == &field) body->split.set_gradients(first, n, L);
}

/** Number of nodes with two sides. */
double FixMPMFracture::compute_scalar()
{
  double mine = 0.0, all;
  for (const auto &body : bodies)
    for (const auto &node : body->split.list()) mine += node.owned;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

/** Nodes whose sides touch; energy that contact of sides has taken. */
double FixMPMFracture::compute_vector(int k)
{
  double mine[2] = {0.0, lost * force->mvv2e}, all[2];
  for (const auto &body : bodies)
    for (const auto &node : body->split.list()) mine[0] += node.owned && node.held;
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  return all[k];
}

void FixMPMFracture::write_restart(FILE *fp)
{
  std::vector<double> totals = {lost};
  write_totals(fp, world, totals);
  lost = totals[0];
}

void FixMPMFracture::restart(char *buf)
{
  lost = 0.0;
  const char *const all = read_state(lmp, id, buf, sizeof(double));
  if (comm->me == 0) lost = *(const double *) all;
}

double FixMPMFracture::memory_usage()
{
  double bytes = FixMPMState::memory_usage();
  for (const auto &body : bodies) bytes += body->split.memory_usage();
  return bytes;
}
