/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/fix_mpm_mesh.h"

#include "base/mpm_input.h"
#include "base/mpm_integrator.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_physics.h"
#include "field/mpm_setup_checks.h"
#include "field/mpm_time_limit.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "math/matrix.h"
#include "meshgrid/fix_mpm_mesh_contact.h"
#include "meshgrid/fix_mpm_mesh_heat.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// Poisson ratio from which on linear cells are far too stiff
static constexpr double LOCKS = 0.48;

static constexpr int CHECK_EVERY = 10;    // steps between looks at the time step

FixMPMMesh::FixMPMMesh(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), uncoupled(lmp)
{
  const int dim = domain->dimension;
  Options options = declare(dim);
  read_options(lmp, options, narg, arg, 3);
  if (!MPMPoints::get(atom))
    error->all(FLERR,
               "Fix mpm/mesh requires material points: use atom_style mpm, or hybrid with mpm");
  if (!atom->tag_enable)
    error->all(FLERR,
               "Fix mpm/mesh tells points from each other by their IDs: remove atom_modify id no");
  try {
    mesh =
        std::make_unique<BackgroundMesh>(read_whole_mesh(lmp, file, "Fix mpm/mesh", 3), dim, part);
    forces = std::make_unique<MPMMeshForces>(lmp, *mesh, conditions);
  } catch (const std::runtime_error &e) {
    error->all(FLERR, 3, "Fix mpm/mesh: {}: {}", file, e.what());
  }
  const MPMMeshOptions &mine = *this;
  body = std::make_unique<MPMMeshBody>(lmp, *this, mine, *mesh, *forces);
  if (comm->me == 0)
    utils::logmesg(lmp,
                   "Fix mpm/mesh {}: {} cells, {} nodes, the smallest height of a cell is {:.6g}\n",
                   id, mesh->cells.size(), mesh->nodes.size(), body->shortest);

  state.declare(body->cell, "mpm/mesh:cell");
  if (total)
    state.declare(body->X, "mpm/mesh:X", 3, [this](int i, double *row) {
      std::copy_n(atom->x[i], 3, row);
    });
  if (transfer == APIC) state.declare(body->C, "mpm/mesh:C", 9);

  time_integrate = 1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = 4 + 3 * (int) forces->size();
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  keep_arrays();
}

void FixMPMMesh::init()
{
  check_integrator(lmp, "Fix mpm/mesh");
  set_up.remember(lmp);
  if (domain->triclinic)
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/mesh requires an orthogonal box");
  for (int d = 0; d < mesh->dim; d++)
    if (domain->periodicity[d])
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/mesh has no periodic images of its mesh: use boundary f, s, or m along {}",
          (char) ('x' + d));
  if (domain->box_change_size || domain->box_change_shape)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/mesh requires a box of constant size and shape: remove the fix that changes it");
  for (const auto *other : modify->get_fix_by_style("^mpm$"))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh {} and fix mpm {} cannot be in one run, as the energies of materials "
               "would be those of both: give all "
               "bodies meshes, or all of them lattices",
               id, other->id);
  for (const auto *other : find_fixes<MPMPhysics>(lmp)) {
    const auto *ifix = dynamic_cast<const Fix *>(other);
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {} acts on points of a fix mpm only, not on those of fix mpm/mesh {}: {}",
               ifix->style, ifix->id, id,
               utils::strmatch(ifix->style, "^mpm/heat$") ? "use fix mpm/mesh/heat"
                   : utils::strmatch(ifix->style, "^mpm/traction$")
                   ? "use its keywords pressure and traction"
                   : "remove it, or give the points a fix mpm");
  }

  time_integrate = seen_as_integrator(lmp, *this);
  find_contact();
  find_heat();
  uncoupled.begin_run(*this);
  const auto &materials = body->materials;
  const bool solid = std::any_of(materials.begin(), materials.end(), [](const auto *material) {
    return material->material->is_solid();
  });
  if (transfer == APIC && !total && solid && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mesh {}: with transfer apic and frame updated, solids with a free "
                   "surface gain energy: use transfer flip, or frame total",
                   id);
  bool can_run = body->kernels != nullptr;
  for (auto *material : materials)
    can_run = can_run &&
        material->material->configure(nullptr, force->mvv2e * force->nktv2p, force->nktv2p);
  if (!can_run)
    error->all(FLERR, Error::NOLASTLINE,
               "Kernels named by the environment variable MPM_ISA cannot run on this CPU or were "
               "not compiled");
  forces->init(fmt::format("fix mpm/mesh {}", id));

  allow_no_ghosts(lmp, body->shortest);
  atom->sortfreq = 0;
  make_plan();
}

/** The fix of this class that belongs to this one, or null. advice: what to do with several. */
template <class F> F *FixMPMMesh::find_attached(const char *advice) const
{
  F *found = nullptr;
  for (auto *mine : find_fixes<F>(lmp)) {
    if (mine->mesh_fix() != id) continue;
    if (found)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix {} {} and {} are of the same fix mpm/mesh {}: {} in one of them", mine->style,
                 found->id, mine->id, id, advice);
    found = mine;
  }
  return found;
}

/** Bodies with their own velocities at the nodes. */
void FixMPMMesh::find_contact()
{
  contact = find_attached<FixMPMMeshContact>("name all bodies");
  if (contact && total)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh/contact {} cannot be used with frame total of fix mpm/mesh {}, whose "
               "nodes are not where the bodies are: use frame updated",
               contact->id, id);
  if (contact && transfer == APIC)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/mesh/contact {} cannot be used with transfer apic of fix mpm/mesh {}, in which "
        "elastic bodies gain energy with frame updated: use transfer flip",
        contact->id, id);
  body->begin_run(contact);
  if (contact) contact->begin_run(*mesh);
}

void FixMPMMesh::find_heat()
{
  heat = find_attached<FixMPMMeshHeat>("give all conditions");
  if (!heat) return;
  if (!total)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh/heat {} cannot be used with frame updated of fix mpm/mesh {}, where "
               "groups of the mesh are not surfaces of the body: use frame total, or a lattice "
               "with fix mpm/heat",
               heat->id, id);
  try {
    heat->begin_run(*mesh);
  } catch (const std::runtime_error &e) {
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/mesh/heat {}: {}: {}", heat->id, file, e.what());
  }
}

void FixMPMMesh::setup_pre_neighbor()
{
  refuse_other_integrators(lmp, *this);
  check_points();
  pre_neighbor();
  give_initial_stress();
}

void FixMPMMesh::check_points()
{
  bigint mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!body->is_point(i)) continue;
    mine++;
    if (contact && contact->body_of(atom->mask[i]) < 0)
      error->one(FLERR, Error::NOLASTLINE,
                 "Material point {} of fix mpm/mesh {} is in {} of the groups of fix "
                 "mpm/mesh/contact {}: each point must be of one body",
                 atom->tag[i], id, contact->body_of(atom->mask[i]) == -1 ? "none" : "several",
                 contact->id);
    if (!body->material_of(i))
      error->one(FLERR, Error::NOLASTLINE,
                 "Material point {} of fix mpm/mesh {} has no material: define a fix mpm/material "
                 "for its group",
                 atom->tag[i], id);
    for (int d = 0; d < mesh->dim; d++)
      if (!std::isfinite(atom->v[i][d]) || !std::isfinite(atom->x[i][d]))
        error->one(FLERR, Error::NOLASTLINE,
                   "Fix mpm/mesh: point {} has a position or velocity that is not a number",
                   atom->tag[i]);
    if (mesh->dim == 2 && atom->v[i][2] != 0.0)
      error->one(FLERR, Error::NOLASTLINE,
                 "Fix mpm/mesh: point {} has a velocity along z in 2d: use fix enforce2d, or set "
                 "it to zero",
                 atom->tag[i]);
  }
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh {} has no material points in its group: make some with create_points",
               id);
}

/** Points without any stress get the pressure of their equation of state, as those of fix mpm;
 *  those that have failed keep none. */
void FixMPMMesh::give_initial_stress()
{
  body->for_batches(body->order, [&](const int *list, int n, const FixMPMMaterial *material) {
    body->load_state(list, n, material);
    body->batch->time = elapsed_time(*update);
    material->material->initial_stress(*body->batch);
    for (int p = 0; p < n; p++) {
      double *const tau = MPMPoints::get(atom)->tau[list[p]];
      const bool none = std::all_of(tau, tau + 6, [](double s) {
        return s == 0.0;
      });
      if (material->damage >= 0 && material->history[list[p]][material->damage] >= 1.0) continue;
      if (!none) continue;
      for (int c = 0; c < 6; c++) tau[c] = body->batch->J[p] * body->batch->stress[c][p];
      for (std::size_t m = 0; m < material->material->history().size(); m++)
        material->history[list[p]][m] = body->batch->history[m][p];
    }
  });
}

void FixMPMMesh::setup(int)
{
  if (!(update->dt > 0.0))
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/mesh requires a positive time step: {}",
               update->dt);
  steps = 0;
  warn_of_locking();
  warn_of_sides();
}

/** Strain jumps at sides of cells. Where points begin on these, rounding decides whose strain they
 *  have, and as many cells have none. */
void FixMPMMesh::warn_of_sides() const
{
  constexpr double ON_SIDE = 1.0e-9, MANY = 0.05;    // of a function of a node; of all points
  enum { ALL, ON_SIDES, NCOUNTS };
  bigint mine[NCOUNTS] = {(bigint) body->order.size(), 0}, all[NCOUNTS];
  tagint example = 0, example_all;
  for (const int i : body->order) {
    const auto &place = body->places[i];
    if (*std::min_element(place.N, place.N + mesh->cells[place.cell].nnode) > ON_SIDE) continue;
    mine[ON_SIDES]++;
    example = std::max(example, atom->tag[i]);
  }
  MPI_Allreduce(mine, all, NCOUNTS, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&example, &example_all, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (all[ON_SIDES] > MANY * all[ALL] && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mesh {}: {} of {} points are on sides of cells, for instance point {}: "
                   "round-off decides in which cell they are, others are empty, and bodies are too "
                   "soft: use other points (ppc), or another mesh",
                   id, all[ON_SIDES], all[ALL], example_all);
}

/** Of cells with one quadrangle or hexahedron a point each, points keep their volume without more;
 *  fluids are not asked, as flows of few points in a cell are near to what they should be. */
void FixMPMMesh::warn_of_locking()
{
  if (fbar) return;
  const bool simplices = std::any_of(mesh->cells.begin(), mesh->cells.end(), [this](const auto &c) {
    return c.nnode == mesh->dim + 1;
  });
  if (!simplices && compute_scalar() <= (double) mesh->cells.size()) return;
  double mine = 0.0, all;
  auto tangent = std::make_unique<Tangent>();
  body->for_batches(body->order, [&](const int *list, int n, const FixMPMMaterial *material) {
    if (!material->material->is_solid() || !material->material->has_tangent()) return;
    body->load_state(list, n, material);
    Batch &b = *body->batch;
    b.time = elapsed_time(*update);
    std::copy_n(b.J, n, b.Jold);
    for (auto &row : b.A) std::fill_n(row, n, 0.0);
    for (auto *row : {b.heat, b.plastic, b.speed}) std::fill_n(row, n, 0.0);
    material->material->update_with_tangent(b, *tangent);
    for (int p = 0; p < n; p++) {
      const double lambda = tangent->stress[0][4][p], shear = tangent->stress[3][1][p];
      if (lambda > 0.0 && shear > 0.0) mine = std::max(mine, 0.5 * lambda / (lambda + shear));
    }
  });
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  warn_of_flow();
  if (all > LOCKS && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mesh {}: a Poisson ratio of {:.4g}: linear cells lock, and the body is "
                   "too stiff: use locking fbar, or quadrangles or hexahedra with one point each",
                   id, all);
}

/** Plastic flow keeps the volume whatever the Poisson ratio is. */
void FixMPMMesh::warn_of_flow() const
{
  int mine = 0, any;
  body->for_batches(body->order, [&](const int *, int, const FixMPMMaterial *material) {
    const auto &variables = material->material->history();
    mine |= std::any_of(variables.begin(), variables.end(), [](const auto &variable) {
      return variable.name == "eplastic";
    });
  });
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (any && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mesh {}: linear cells lock when the material flows plastically, and "
                   "limit loads come out 7 to 25 % too large: use locking fbar, or quadrangles or "
                   "hexahedra with one point each",
                   id);
}

void FixMPMMesh::pre_neighbor()
{
  body->list_points();
}

void FixMPMMesh::make_plan()
{
  using Data = MPMStageData;
  constexpr Data::Name CELLS = "cells", LOADS = "loads";
  stages.clear();
  if (!total)
    stages.add("cells of points", {Data::POSITION}, {CELLS}, [this] {
      body->find_places();
      if (body->lacks_nodes()) body->find_ranks();
    });
  stages.add("loads", {CELLS, Data::OWN}, {LOADS}, [this] {
    check_dt();
    forces->evaluate();
    forces->clear_sums();
    if (total && forces->has_pressure())
      forces->follow(body->counts_cell, body->positions, body->ranks);
  });
  if (heat)
    stages.add("heat", {Data::POSITION, Data::DEFORMATION, Data::HISTORY, Data::MASS, CELLS},
               {Data::HISTORY, Data::OWN}, [this] {
                 heat->conduct(*body, update->dt);
               });
  stages.add("points to nodes",
             {Data::POSITION, Data::VELOCITY, Data::AFFINE, Data::DEFORMATION, Data::STRESS,
              Data::MASS, Data::FORCE, CELLS},
             {Data::NODES}, [this] {
               body->points_to_nodes();
               if (steps == 0 && forces->has_loads())
                 forces->warn_of_lost_loads(fmt::format("Fix mpm/mesh {}", id), [this](int node) {
                   return body->counts_mass_at(node);
                 });
             });
  stages.add("momentum equation", {Data::NODES, LOADS}, {Data::NODES, Data::OWN}, [this] {
    body->find_velocities();
  });
  stages.add("nodes to points", {Data::VELOCITY, Data::NODES, CELLS}, {Data::VELOCITY}, [this] {
    body->nodes_to_points();
  });
  if (musl)
    stages.add("velocities back to nodes",
               {Data::POSITION, Data::VELOCITY, Data::AFFINE, Data::MASS, Data::NODES, CELLS},
               {Data::NODES}, [this] {
                 body->map_back();
               });
  stages.add(
      "motion and strain",
      {Data::POSITION, Data::DEFORMATION, Data::STRESS, Data::HISTORY, Data::NODES, CELLS},
      {Data::POSITION, Data::AFFINE, Data::DEFORMATION, Data::STRESS, Data::HISTORY, Data::OWN},
      [this] {
        body->move_and_strain();
      });
}

void FixMPMMesh::initial_integrate(int)
{
  set_up.check(lmp, "Fix mpm/mesh");
  uncoupled.look();
  stages.run();
  steps++;
}

void FixMPMMesh::post_run()
{
  if (MPMField::all(lmp).empty()) set_up.finish(lmp);
}

void FixMPMMesh::visit_batches(int group_bits, const BatchVisitor &visit)
{
  body->find_materials();
  std::vector<int> of;
  for (int i = 0; i < atom->nlocal; i++)
    if (body->is_point(i) && (atom->mask[i] & group_bits)) of.push_back(i);
  body->for_batches(of, [&](const int *list, int n, const FixMPMMaterial *material) {
    body->load_state(list, n, material);
    visit(*body->batch, list, *material);
  });
}

void FixMPMMesh::check_dt()
{
  if (steps % CHECK_EVERY) return;
  tagint tag;
  const double limit = body->stable_dt(tag);
  if (!(update->dt <= limit))
    error->one(FLERR,
               "Time step {:.6g} is above the limit {:.6g} of fix mpm/mesh {} at step {}, height "
               "of a cell over the speed of "
               "waves and of point {}; {}, or a mesh without small cells",
               update->dt, limit, id, update->ntimestep, tag, remedy_of_step(lmp));
}

/** Scalar: number of points; vector: kinetic and stored energy, work of forces from outside, points
 *  that are outside of the mesh by less than OUTSIDE; forces of the conditions on the body. */
double FixMPMMesh::compute_scalar()
{
  double n = 0.0, all;
  for (int i = 0; i < atom->nlocal; i++) n += body->is_point(i);
  MPI_Allreduce(&n, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMMesh::compute_vector(int k)
{
  double mine = 0.0, all;
  if (k == 0) {
    for (const int i : body->order)
      mine += 0.5 * force->mvv2e * atom->rmass[i] * dot(atom->v[i], atom->v[i]);
  } else if (k == 1) {
    double energy[BATCH];
    body->for_batches(body->order, [&](const int *list, int n, const FixMPMMaterial *material) {
      body->load_state(list, n, material);
      material->material->stored_energy(*body->batch, energy);
      for (int p = 0; p < n; p++) mine += atom->vfrac[list[p]] * energy[p] / force->nktv2p;
    });
  } else if (k == 2) {
    mine = body->load_work;
  } else if (k == 3) {
    for (const int i : body->order) mine += body->places[i].outside > 0.0;
  } else {
    mine = forces->sum((k - 4) / 3, (k - 4) % 3);
  }
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void FixMPMMesh::write_restart(FILE *fp)
{
  std::vector<double> totals = {body->load_work};
  std::vector<double> same = {(double) body->positions.size()};
  if (total) body->share_positions();
  for (const auto &x : body->positions) same.insert(same.end(), x.begin(), x.end());
  write_totals(fp, world, totals, same);
  body->load_work = totals[0];
}

void FixMPMMesh::restart(char *buf)
{
  const auto state = read_state(lmp, id, buf);
  const auto *list = (const double *) state.data();
  if (state.size() != (2 + 3 * body->positions.size()) * sizeof(double))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh {} has another frame or mesh than in the restart file, where {} nodes "
               "have moved, and not {}: give it those of the file",
               id, state.size() / (3 * sizeof(double)), body->positions.size());
  body->load_work = comm->me == 0 ? list[0] : 0.0;
  list += 2;
  for (auto &x : body->positions) {
    std::copy_n(list, 3, x.data());
    list += 3;
  }
}

double FixMPMMesh::memory_usage()
{
  return FixMPMState::memory_usage() + body->memory_usage();
}
