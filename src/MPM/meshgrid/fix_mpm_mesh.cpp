/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/fix_mpm_mesh.h"

#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_integrators.h"
#include "field/mpm_physics.h"
#include "field/mpm_time_limit.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "math/matrix.h"
#include "mesh/element.h"
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
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// a point that is farther outside, in widths of the next cell, has left the mesh

static constexpr double OUTSIDE = 0.1;

// Poisson ratio from which on linear cells are far too stiff
static constexpr double LOCKS = 0.48;

static constexpr int CHECK_EVERY = 10;    // steps between looks at the time step

/* ----------------------------------------------------------------------
   fix ID group mpm/mesh FILE keyword values ...
------------------------------------------------------------------------- */

Options MPMMeshOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/mesh");
  o.argument(text(file, "file"));
  o.add("part",
        {text(
            part, "name",
            "name or tag of a physical group of the mesh, or a set, whose elements are the cells")})
      .standard("all elements of the dimension of the simulation");
  o.add("frame",
        {word(total,
              {{"updated", false, "nodes are fixed in space, and points move through the mesh"},
               {"total", true, "nodes are fixed in the undeformed body"}})})
      .keep();
  o.add("scheme",
        {word(musl,
              {{"usl", false, "strain from the velocities after the momentum equation"},
               {"musl", true,
                "strain from the new velocities of the points, mapped back to the nodes"}})})
      .keep();
  o.add(
       "transfer",
       {word(transfer,
             {{"flip",
               FLIP,
               "velocities of points get the change of the nodes",
               {number(flip, "share", FRACTION, "1", "1: FLIP, 0: PIC")}},
              {"apic", APIC, "velocities of points come with the velocity gradient of the cell"}})})
      .keep();
  o.add("locking",
        {word(fbar,
              {{"none", false, "nothing"},
               {"fbar", true, "changes of volume and the mean stress, over the points around"}})},
        "quantity that is averaged to prevent volumetric locking")
      .keep();
  const auto condition = [&](const std::string &keyword, MPMMeshCondition::Kind kind,
                             const std::string &names, const std::string &unit,
                             const std::string &meaning, int n, bool null) {
    std::vector<OptionValue> values;
    values.push_back(text(next.group, "name", meaning));
    if (n)
      values.push_back(variables(next.value, n, names, unit,
                                 null ? "components, can be variables; NULL leaves a component free"
                                      : "value of the load, can be a variable",
                                 null));
    o.add(keyword, values)
        .then([this, kind] {
          next.kind = kind;
          conditions.push_back(next);
          next = {};
        })
        .standard("none");
  };
  condition("velocity", MPMMeshCondition::VELOCITY, dim == 3 ? "vx vy vz" : "vx vy", "velocity",
            "name of a physical group or set whose nodes have this velocity", dim, true);
  condition("slip", MPMMeshCondition::SLIP, "", "",
            "name of sides whose nodes have no velocity along the normals", 0, false);
  condition("pressure", MPMMeshCondition::PRESSURE, "p", "pressure",
            "name of sides of the mesh, which are fixed in space (frame updated) or move with the "
            "body (frame total)",
            1, false);
  condition("traction", MPMMeshCondition::TRACTION, dim == 3 ? "tx ty tz" : "tx ty", "pressure",
            "name of sides of the mesh, with their area in the file", dim, false);
  o.refuse([this, dim] {
    OptionRules rules;
    const std::pair<MPMMeshCondition::Kind, const char *> kinds[] = {
        {MPMMeshCondition::VELOCITY, "velocity"},
        {MPMMeshCondition::SLIP, "slip"},
        {MPMMeshCondition::PRESSURE, "pressure"},
        {MPMMeshCondition::TRACTION, "traction"}};
    for (const auto &[kind, keyword] : kinds) {
      const std::string group =
          group_given_twice(conditions, kind, kind == MPMMeshCondition::VELOCITY ? dim : 1);
      const bool loads = kind == MPMMeshCondition::PRESSURE || kind == MPMMeshCondition::TRACTION;
      rules.push_back({!group.empty(), keyword,
                       "is given twice for group " + group +
                           (loads ? ": give the sum once" : ": give it once")});
    }
    return rules;
  });
  return o;
}

FixMPMMesh::FixMPMMesh(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), ranks(lmp), batch(new Batch())
{
  const int dim = domain->dimension;
  Options options = declare(dim);
  read_options(lmp, options, narg, arg, 3);
  points = MPMPoints::get(atom);
  if (!points)
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
  shortest = std::numeric_limits<double>::max();
  for (const auto &one : mesh->cells) shortest = std::min(shortest, one.height);
  if (total) positions = mesh->nodes;
  if (fbar) means = std::make_unique<MPMMeshMeans>(*mesh, ranks);
  if (comm->me == 0)
    utils::logmesg(lmp,
                   "Fix mpm/mesh {}: {} cells, {} nodes, the smallest height of a cell is {:.6g}\n",
                   id, mesh->cells.size(), mesh->nodes.size(), shortest);

  state.declare(cell, "mpm/mesh:cell");
  if (total)
    state.declare(X, "mpm/mesh:X", 3, [this](int i, double *row) {
      std::copy_n(atom->x[i], 3, row);
    });
  if (transfer == APIC) state.declare(C, "mpm/mesh:C", 9);

  time_integrate = 1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = 4 + 3 * (int) forces->size();
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  keep_arrays();
}

FixMPMMesh::~FixMPMMesh() = default;

/* ---------------------------------------------------------------------- */

void FixMPMMesh::init()
{
  if (utils::strmatch(update->integrate_style, "^respa"))
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/mesh requires run_style verlet");
  if (update->whichflag == 2)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh cannot be used with minimize: minimize before the fix is defined");
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
               utils::strmatch(ifix->style, "^mpm/heat$") ? "use fix mpm/mesh/heat" : "remove it");
  }

  points = MPMPoints::get(atom);
  find_contact();
  find_heat();
  find_materials();
  const bool solid = std::any_of(materials.begin(), materials.end(), [](const auto *material) {
    return material->material->is_solid();
  });
  if (C && !total && solid && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mesh {}: with transfer apic and frame updated, solids with a free "
                   "surface gain energy: use transfer flip, or frame total",
                   id);
  kernels = BatchKernels::select(mesh->dim);
  bool can_run = kernels != nullptr;
  for (auto *material : materials)
    can_run = can_run &&
        material->material->configure(nullptr, force->mvv2e * force->nktv2p, force->nktv2p);
  if (!can_run)
    error->all(FLERR, Error::NOLASTLINE,
               "Kernels named by the environment variable MPM_ISA cannot run on this CPU or were "
               "not compiled");
  forces->init(fmt::format("fix mpm/mesh {}", id));

  // points need no ghosts, see FixMPM::init()

  const double nothing = 1.0e-8 * shortest;
  if (!force->pair && comm->cutghostuser == 0.0) comm->cutghostuser = nothing;
  if (force->pair && comm->cutghostuser == nothing) comm->cutghostuser = 0.0;
  atom->sortfreq = 0;
}

/** Bodies with their own velocities at the nodes. */
void FixMPMMesh::find_contact()
{
  contact = nullptr;
  for (auto *other : modify->get_fix_by_style("^mpm/mesh/contact$")) {
    auto *mine = dynamic_cast<FixMPMMeshContact *>(other);
    if (mine->of_mesh() != id) continue;
    if (contact)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/mesh/contact {} and {} are of the same fix mpm/mesh {}: name all bodies in "
          "one of them",
          contact->id, mine->id, id);
    contact = mine;
  }
  if (contact && total)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh/contact {} cannot be used with frame total of fix mpm/mesh {}, whose "
               "nodes are not where the bodies are: use frame updated",
               contact->id, id);
  if (contact && C)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/mesh/contact {} cannot be used with transfer apic of fix mpm/mesh {}, in which "
        "elastic bodies gain energy with frame updated: use transfer flip",
        contact->id, id);
  const std::size_t rows = count_bodies() * mesh->nodes.size();
  sums.resize(rows);
  before.resize(rows);
  after.resize(rows);
  if (musl) mapped.resize(rows);
  if (contact) contact->begin_run(*mesh);
}

void FixMPMMesh::find_heat()
{
  heat = nullptr;
  for (auto *other : modify->get_fix_by_style("^mpm/mesh/heat$")) {
    auto *mine = dynamic_cast<FixMPMMeshHeat *>(other);
    if (mine->of_mesh() != id) continue;
    if (heat)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/mesh/heat {} and {} are of the same fix mpm/mesh {}: give all conditions "
                 "in one of them",
                 heat->id, mine->id, id);
    heat = mine;
  }
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

int FixMPMMesh::count_bodies() const
{
  return contact ? contact->count() : 1;
}

/** The row of the first node of the body of a point. */
std::size_t FixMPMMesh::rows_of(int i) const
{
  return contact ? contact->body_of(atom->mask[i]) * mesh->nodes.size() : 0;
}

MPMMeshBodies FixMPMMesh::bodies()
{
  return {*mesh, ranks, *forces, order, places, &sums[0].mass, WIDTH};
}

void FixMPMMesh::find_materials()
{
  materials = find_fixes<FixMPMMaterial>(lmp);
  int nhistory = 1;
  for (const auto *material : materials) nhistory = std::max(nhistory, material->nhistory);
  history.resize((std::size_t) nhistory * BATCH);
}

bool FixMPMMesh::is_point(int i) const
{
  return (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0;
}

const double *FixMPMMesh::position(int i) const
{
  return total ? X[i] : atom->x[i];
}

FixMPMMaterial *FixMPMMesh::material_of(int i) const
{
  for (auto *material : materials)
    if (atom->mask[i] & material->groupbit) return material;
  return nullptr;
}

/* ---------------------------------------------------------------------- */

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
    if (!is_point(i)) continue;
    mine++;
    if (contact && contact->body_of(atom->mask[i]) < 0)
      error->one(FLERR, Error::NOLASTLINE,
                 "Material point {} of fix mpm/mesh {} is in {} of the groups of fix "
                 "mpm/mesh/contact {}: each point must be of one body",
                 atom->tag[i], id, contact->body_of(atom->mask[i]) == -1 ? "none" : "several",
                 contact->id);
    if (!material_of(i))
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

/** Points without any stress get the pressure of their equation of state, as those of fix mpm. */
void FixMPMMesh::give_initial_stress()
{
  for_batches(order, [&](const int *list, int n, const FixMPMMaterial *material) {
    load_state(list, n, material);
    batch->time = elapsed_time(*update);
    material->material->initial_stress(*batch);
    for (int p = 0; p < n; p++) {
      double *const tau = points->tau[list[p]];
      const bool none = std::all_of(tau, tau + 6, [](double s) {
        return s == 0.0;
      });
      for (int c = 0; c < 6 && none; c++) tau[c] = batch->J[p] * batch->stress[c][p];
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

/** Strain jumps at sides of cells. Where points begin on these, rounding decides whose strain they have, and as many cells have none. */
void FixMPMMesh::warn_of_sides() const
{
  constexpr double ON_SIDE = 1.0e-9, MANY = 0.05;    // of a function of a node; of all points
  enum { ALL, ON_SIDES, NCOUNTS };
  bigint mine[NCOUNTS] = {(bigint) order.size(), 0}, all[NCOUNTS];
  tagint example = 0, example_all;
  for (const int i : order) {
    const auto &place = places[i];
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

/* ----------------------------------------------------------------------
   of cells with one quadrangle or hexahedron a point each, points keep their volume without more; fluids are not asked, as flows of
   few points in a cell are near to what they should be
------------------------------------------------------------------------- */

void FixMPMMesh::warn_of_locking()
{
  if (means) return;
  const bool simplices = std::any_of(mesh->cells.begin(), mesh->cells.end(), [this](const auto &c) {
    return c.nnode == mesh->dim + 1;
  });
  if (!simplices && compute_scalar() <= (double) mesh->cells.size()) return;
  double mine = 0.0, all;
  auto tangent = std::make_unique<Tangent>();
  for_batches(order, [&](const int *list, int n, const FixMPMMaterial *material) {
    if (!material->material->is_solid() || !material->material->has_tangent()) return;
    load_state(list, n, material);
    Batch &b = *batch;
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
  for_batches(order, [&](const int *, int, const FixMPMMaterial *material) {
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

/* ----------------------------------------------------------------------
   after exchange and borders: sums go over points in the order of their IDs, which does not depend on what was before
------------------------------------------------------------------------- */

void FixMPMMesh::pre_neighbor()
{
  order.clear();
  for (int i = 0; i < atom->nlocal; i++)
    if (is_point(i)) order.push_back(i);
  std::sort(order.begin(), order.end(), [this](int a, int b) {
    return atom->tag[a] < atom->tag[b];
  });
  places.resize(atom->nlocal);
  for (const int i : order) places[i].cell = (int) cell[i] - 1;
  find_places();
  find_ranks();
}

/** Cells of all points. */
void FixMPMMesh::find_places()
{
  const int ncell = (int) mesh->cells.size();
  for (const int i : order) {
    auto &place = places[i];
    const int hint = place.cell < ncell ? place.cell : -1;
    mesh->find(position(i), hint, place);
    if (place.cell < 0 || place.outside > OUTSIDE)
      error->one(FLERR,
                 "Point {} of fix mpm/mesh {} is outside of the mesh at step {}: position {:.6g} "
                 "{:.6g} {:.6g}, "
                 "velocity {:.6g} {:.6g} {:.6g}; use a larger mesh, or conditions at its rim",
                 atom->tag[i], id, update->ntimestep, atom->x[i][0], atom->x[i][1], atom->x[i][2],
                 atom->v[i][0], atom->v[i][1], atom->v[i][2]);
    cell[i] = place.cell + 1;
  }
}

/* ----------------------------------------------------------------------
   nodes of cells with points, and, as points go to others, of those around these
------------------------------------------------------------------------- */

void FixMPMMesh::find_ranks()
{
  std::vector<char> wanted(mesh->nodes.size(), 0), with_points(mesh->cells.size(), 0);
  for (const int i : order) with_points[places[i].cell] = 1;
  for (std::size_t c = 0; c < mesh->cells.size(); c++)
    if (with_points[c])
      for (int k = 0; k < mesh->cells[c].nnode; k++) wanted[mesh->cells[c].node[k]] = 1;
  if (!total) {
    const auto touched = wanted;
    for (const auto &one : mesh->cells) {
      const bool near = std::any_of(one.node, one.node + one.nnode, [&](int node) {
        return touched[node];
      });
      for (int k = 0; k < one.nnode && near; k++) wanted[one.node[k]] = 1;
    }
  }
  if (total) share_positions();
  has_node.swap(wanted);
  ranks.find(has_node);
  if (!total || !forces->has_pressure()) return;
  std::vector<int> lowest(mesh->cells.size(), comm->nprocs);
  for (std::size_t c = 0; c < lowest.size(); c++)
    if (with_points[c]) lowest[c] = comm->me;
  MPI_Allreduce(MPI_IN_PLACE, lowest.data(), (int) lowest.size(), MPI_INT, MPI_MIN, world);
  counts_cell.resize(lowest.size());
  for (std::size_t c = 0; c < lowest.size(); c++) counts_cell[c] = lowest[c] == comm->me;
}

/** Those of all nodes to all ranks. */
void FixMPMMesh::share_positions()
{
  if (ranks.first.empty()) return;                         // nothing has moved
  std::vector<double> known(4 * positions.size(), 0.0);    // and does any rank know it?
  for (const int node : ranks.nodes) {
    if (!ranks.first[node]) continue;
    std::copy_n(positions[node].data(), 3, &known[4 * (std::size_t) node]);
    known[4 * (std::size_t) node + 3] = 1.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, known.data(), (int) known.size(), MPI_DOUBLE, MPI_SUM, world);
  for (std::size_t node = 0; node < positions.size(); node++)
    if (known[4 * node + 3] > 0.0) std::copy_n(&known[4 * node], 3, positions[node].data());
}

/** Are there points in cells whose nodes this rank has not? Collective. */
bool FixMPMMesh::lacks_nodes() const
{
  int mine = 0, any;
  for (const int i : order) {
    const auto &one = mesh->cells[places[i].cell];
    for (int k = 0; k < one.nnode; k++) mine |= !has_node[one.node[k]];
  }
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any != 0;
}

/* ---------------------------------------------------------------------- */

void FixMPMMesh::initial_integrate(int)
{
  if (!total) {
    find_places();
    if (lacks_nodes()) find_ranks();
  }
  check_dt();
  forces->evaluate();
  forces->clear_sums();
  if (total && forces->has_pressure()) forces->follow(counts_cell, positions, ranks);
  if (heat) heat->conduct(bodies(), update->dt);
  points_to_nodes();
  if (steps == 0 && forces->has_loads())
    forces->warn_of_lost_loads(fmt::format("Fix mpm/mesh {}", id), [this](int node) {
      return has_node[node] && ranks.first[node] && mass_of_all(node) > 0.0;
    });
  find_velocities();
  nodes_to_points();
  if (musl) map_back();
  move_and_strain();
  steps++;
}

/* ----------------------------------------------------------------------
   In the total frame forces are of the first Piola-Kirchhoff stress tau F^-T on gradients in the reference configuration
------------------------------------------------------------------------- */

void FixMPMMesh::points_to_nodes()
{
  const std::size_t nnode = mesh->nodes.size();
  for (int body = 0; body < count_bodies(); body++)
    for (const int node : ranks.nodes) sums[body * nnode + node] = {};
  const int dim = mesh->dim;
  const double unit = 1.0 / force->nktv2p;
  if (means) find_mean_stress();
  for (const int i : order) {
    const auto &place = places[i];
    const auto &one = mesh->cells[place.cell];
    const double *const t = points->tau[i], *const f = atom->f[i], *const v = atom->v[i];
    const double m = atom->rmass[i], V = unit * atom->vfrac[i];
    double P[9] = {t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2]};
    if (means) {
      const double mean = (t[0] + t[1] + (dim == 3 ? t[2] : 0.0)) / dim;
      for (int d = 0; d < dim; d++) P[4 * d] += volumetric[i].stress - mean;
    }
    if (total) {
      double F[9];
      std::copy_n(points->F[i], 9, F);
      if (means) motion_of_nodes(place, F);
      const double cofactors[9] = MPM_COFACTORS(F),
                   inv = 1.0 / (F[0] * cofactors[0] + F[1] * cofactors[1] + F[2] * cofactors[2]);
      double product[9];
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          product[3 * a + b] = 0.0;
          for (int c = 0; c < 3; c++)
            product[3 * a + b] += P[3 * a + c] * inv * cofactors[3 * c + b];
        }
      std::copy_n(product, 9, P);
    }
    const std::size_t rows = rows_of(i);
    for (int k = 0; k < one.nnode; k++) {
      Node &node = sums[rows + one.node[k]];
      const double w = m * place.N[k], *const g = place.g[k];
      double u[3] = {v[0], v[1], v[2]};
      if (C) {
        double r[3];
        for (int d = 0; d < 3; d++) r[d] = mesh->nodes[one.node[k]][d] - position(i)[d];
        for (int d = 0; d < dim; d++)
          for (int e = 0; e < dim; e++) u[d] += C[i][3 * d + e] * r[e];
      }
      node.mass += w;
      for (int d = 0; d < dim; d++) {
        node.momentum[d] += w * u[d];
        node.load[d] += place.N[k] * f[d];
        node.force[d] -= V * dot(P + 3 * d, g);
      }
    }
  }
  for (int body = 0; body < count_bodies(); body++) ranks.sum(&sums[body * nnode].mass, WIDTH);
}

/* ----------------------------------------------------------------------
   F-bar (E.A. de Souza Neto, D. Peric, M. Dutko, D.R.J. Owen, Int. J. Solids Struct. 33 (1996) 3277) with means <> over the points around,
   which are symmetric: the sum over points of w a <b> is that of w <a> b. In the total frame the strain of a point has the volume ratio <J>
   with the J that the motion of its nodes has there, weighted by initial volumes. The change of the stored energy is the sum of V0 tau : D
   with the dilatation d<J>/<J>, so that the force has the mean stress J <p> of Cauchy stresses p, and gradients with the motion of
   the nodes. In the updated frame it is the change of volume in the step that is averaged, by present volumes. In 2d these are changes in
   the plane, and p is the mean of the stresses there
------------------------------------------------------------------------- */

/** The plane, or all, of the deformation gradient of the nodes at a place. */
void FixMPMMesh::motion_of_nodes(const BackgroundMesh::Place &place, double F[9]) const
{
  const int dim = mesh->dim;
  const auto &one = mesh->cells[place.cell];
  for (int d = 0; d < dim; d++)
    for (int e = 0; e < dim; e++) {
      F[3 * d + e] = 0.0;
      for (int k = 0; k < one.nnode; k++) F[3 * d + e] += positions[one.node[k]][d] * place.g[k][e];
    }
}

/** Of a matrix whose third row and column are those of identity in 2d. */
static double determinant_in(int dim, const double *F)
{
  return dim == 3 ? determinant(F) : F[0] * F[4] - F[1] * F[3];
}

void FixMPMMesh::find_mean_stress()
{
  const int dim = mesh->dim, ngroup = count_bodies() * (int) materials.size();
  means->clear(ngroup, 2);
  volumetric.resize(atom->nlocal);
  for (const int i : order) {
    Volumetric &mine = volumetric[i];
    const auto material = std::find(materials.begin(), materials.end(), material_of(i));
    mine.group = (int) (material - materials.begin()) * count_bodies() +
        (int) (rows_of(i) / mesh->nodes.size());
    const double *const t = points->tau[i], J = points->jacobian(i);
    double F[9];
    if (total) motion_of_nodes(places[i], F);
    mine.own = total ? determinant_in(dim, F) : 1.0;
    mine.weight = atom->vfrac[i] * (total ? 1.0 : J);
    const double values[2] = {(t[0] + t[1] + (dim == 3 ? t[2] : 0.0)) / (dim * J), mine.own};
    means->add(mine.group, places[i], mine.weight, values);
  }
  means->sum();
  for (const int i : order) {
    Volumetric &mine = volumetric[i];
    mine.stress = (total ? mine.own : points->jacobian(i)) * means->mean(mine.group, places[i], 0);
    mine.all = total ? means->mean(mine.group, places[i], 1) : 1.0;
  }
}

/** Nodes of the total frame have moved. */
void FixMPMMesh::find_mean_strain(const std::vector<MeshVector> &velocities)
{
  const int dim = mesh->dim;
  const auto own_now = [&](int i) {
    const auto &place = places[i];
    double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    if (total) {
      motion_of_nodes(place, F);
    } else {
      const auto &one = mesh->cells[place.cell];
      for (int k = 0; k < one.nnode; k++) {
        const auto &v = velocities[rows_of(i) + one.node[k]];
        for (int d = 0; d < dim; d++)
          for (int e = 0; e < dim; e++) F[3 * d + e] += update->dt * v[d] * place.g[k][e];
      }
    }
    return determinant_in(dim, F);
  };
  means->clear(count_bodies() * (int) materials.size(), 1);
  for (const int i : order) {
    Volumetric &mine = volumetric[i];
    const double own = own_now(i);
    means->add(mine.group, places[i], mine.weight, &own);
    mine.scale = mine.own / (mine.all * own);
  }
  means->sum();
  for (const int i : order) {
    Volumetric &mine = volumetric[i];
    const double change = mine.scale * means->mean(mine.group, places[i], 0);
    mine.scale =
        std::pow(std::fabs(change), 1.0 / dim);    // what is inside out stays so, and is told
  }
}

/* ----------------------------------------------------------------------
   The velocity gradient of a point, column-major, becomes that of the motion with the mean change of volume. In the total frame it is the
   change of F in the step, where the nodes have moved on already
------------------------------------------------------------------------- */

void FixMPMMesh::scale_motion(int i, double *L) const
{
  const int dim = mesh->dim;
  const double dt = update->dt, scale = volumetric[i].scale;
  if (!total) {
    for (int d = 0; d < dim; d++)
      for (int e = 0; e < dim; e++)
        L[dim * e + d] = scale * L[dim * e + d] + (d == e ? (scale - 1.0) / dt : 0.0);
    return;
  }
  double now[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, old[9], step[9];
  motion_of_nodes(places[i], now);
  std::copy_n(now, 9, old);
  for (int d = 0; d < dim; d++)
    for (int e = 0; e < dim; e++) old[3 * d + e] -= dt * L[dim * e + d];
  const double cofactors[9] = MPM_COFACTORS(old), inv = 1.0 / determinant(old);
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) {
      step[3 * d + e] = 0.0;
      for (int c = 0; c < 3; c++) step[3 * d + e] += now[3 * d + c] * inv * cofactors[3 * e + c];
    }
  const double *const F = points->F[i];
  for (int d = 0; d < dim; d++)
    for (int e = 0; e < dim; e++)
      L[dim * e + d] = (scale * product(step, F, d, e) - F[3 * d + e]) / dt;
}

/** Of all bodies at a node. */
double FixMPMMesh::mass_of_all(int node) const
{
  double mass = 0.0;
  for (int body = 0; body < count_bodies(); body++)
    mass += sums[body * mesh->nodes.size() + node].mass;
  return mass;
}

/* ----------------------------------------------------------------------
   The work of a force is that at the mean of the velocities before and after the step, which is what it does to the kinetic
   energy of the node. A load is of the body that is there; where two bodies meet at a loaded side, each has the share of its mass at
   the node, so that the load neither presses them on each other nor parts them
------------------------------------------------------------------------- */

void FixMPMMesh::find_velocities()
{
  const int dim = mesh->dim;
  const double dt = update->dt, impulse = dt * force->ftm2v;
  const auto each = [&](auto f) {
    for (int body = 0; body < count_bodies(); body++)
      for (const int node : ranks.nodes) f(node, body * mesh->nodes.size() + node);
  };
  each([&](int node, std::size_t row) {
    Node &mine = sums[row];
    before[row] = after[row] = {0.0, 0.0, 0.0};
    if (!(mine.mass > 0.0)) return;
    forces->add_load(node, mine.mass / mass_of_all(node), ranks.first[node], mine.load);
    for (int d = 0; d < dim; d++) {
      before[row][d] = mine.momentum[d] / mine.mass;
      after[row][d] = before[row][d] + impulse * (mine.force[d] + mine.load[d]) / mine.mass;
    }
  });
  if (contact) contact->act(bodies(), after, false);
  each([&](int node, std::size_t row) {
    const Node &mine = sums[row];
    if (!(mine.mass > 0.0)) return;
    const bool counts = ranks.first[node];
    MeshVector &v = after[row];
    const MeshVector free = v;
    forces->constrain(node, counts ? mine.mass / impulse : 0.0, v.data());
    for (int d = 0; d < dim && counts; d++)
      load_work += 0.5 * (before[row][d] + v[d]) *
          (dt * mine.load[d] + mine.mass * (v[d] - free[d]) / force->ftm2v);
  });
}

/** Velocities of points. */
void FixMPMMesh::nodes_to_points()
{
  const int dim = mesh->dim;
  for (const int i : order) {
    const auto &place = places[i];
    const auto &one = mesh->cells[place.cell];
    const std::size_t rows = rows_of(i);
    double v[3] = {0.0, 0.0, 0.0}, change[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < one.nnode; k++) {
      const double N = place.N[k], *const a = after[rows + one.node[k]].data(),
                   *const b = before[rows + one.node[k]].data();
      for (int d = 0; d < dim; d++) {
        v[d] += N * a[d];
        change[d] += N * (a[d] - b[d]);
      }
    }
    const double share = transfer == FLIP ? flip : 0.0;
    for (int d = 0; d < dim; d++)
      atom->v[i][d] = share * (atom->v[i][d] + change[d]) + (1.0 - share) * v[d];
  }
}

/** MUSL: the velocities of points, once more on the nodes, for the strain. */
void FixMPMMesh::map_back()
{
  const int dim = mesh->dim;
  const std::size_t nnode = mesh->nodes.size();
  for (int body = 0; body < count_bodies(); body++)
    for (const int node : ranks.nodes) mapped[body * nnode + node] = {0.0, 0.0, 0.0};
  for (const int i : order) {
    const auto &place = places[i];
    const auto &one = mesh->cells[place.cell];
    const std::size_t rows = rows_of(i);
    for (int k = 0; k < one.nnode; k++) {
      double u[3] = {atom->v[i][0], atom->v[i][1], atom->v[i][2]}, r[3];
      if (C) {
        for (int d = 0; d < 3; d++) r[d] = mesh->nodes[one.node[k]][d] - position(i)[d];
        for (int d = 0; d < dim; d++)
          for (int e = 0; e < dim; e++) u[d] += C[i][3 * d + e] * r[e];
      }
      for (int d = 0; d < dim; d++)
        mapped[rows + one.node[k]][d] += atom->rmass[i] * place.N[k] * u[d];
    }
  }
  for (int body = 0; body < count_bodies(); body++) ranks.sum(mapped[body * nnode].data(), 3);
  const auto each = [&](auto f) {
    for (int body = 0; body < count_bodies(); body++)
      for (const int node : ranks.nodes)
        if (sums[body * nnode + node].mass > 0.0) f(node, body * nnode + node);
  };
  each([&](int, std::size_t row) {
    for (double &v : mapped[row]) v /= sums[row].mass;
  });
  if (contact) contact->act(bodies(), mapped, true);
  each([&](int node, std::size_t row) {
    forces->constrain(node, 0.0, mapped[row].data());
  });
}

/* ----------------------------------------------------------------------
   In the updated frame points move with the velocities that strain them. Nodes that points barely reach can have any velocity
   after the momentum equation, whose gradient would be that of the points: it is that of the mapped velocities, too. In the total frame forces do not depend on where
   points are
------------------------------------------------------------------------- */

template <class Visit> void FixMPMMesh::for_batches(const std::vector<int> &of, Visit visit) const
{
  for (auto *material : materials) {
    int list[BATCH], n = 0;
    for (const int i : of) {
      if (material_of(i) != material) continue;
      list[n++] = i;
      if (n < BATCH) continue;
      visit(list, n, material);
      n = 0;
    }
    if (n) visit(list, n, material);
  }
}

void FixMPMMesh::move_and_strain()
{
  const int dim = mesh->dim, nL = dim * dim;
  const double dt = update->dt;
  const auto &strains = musl ? mapped : after;
  const auto &moves = musl && !total ? mapped : after;
  if (total)
    for (const int node : ranks.nodes)
      for (int d = 0; d < dim; d++) positions[node][d] += dt * strains[node][d];
  if (means) find_mean_strain(strains);
  Batch &b = *batch;
  for_batches(order, [&](const int *list, int n, FixMPMMaterial *material) {
    double L[9 * BATCH] = {}, F[9 * BATCH], tau[6 * BATCH], vol0[BATCH];
    for (int p = 0; p < n; p++) {
      const int i = list[p];
      const auto &place = places[i];
      const auto &one = mesh->cells[place.cell];
      const std::size_t rows = rows_of(i);
      for (int k = 0; k < one.nnode; k++) {
        const auto &u = strains[rows + one.node[k]], &v = moves[rows + one.node[k]];
        for (int d = 0; d < dim; d++) {
          atom->x[i][d] += dt * place.N[k] * v[d];
          for (int e = 0; e < dim; e++) L[nL * p + dim * e + d] += u[d] * place.g[k][e];
        }
      }
      for (int d = 0; d < dim && C; d++)
        for (int e = 0; e < dim; e++) C[i][3 * d + e] = L[nL * p + dim * e + d];
      if (means) scale_motion(i, L + nL * p);
      std::copy_n(points->F[i], 9, F + 9 * p);
      std::copy_n(points->tau[i], 6, tau + 6 * p);
      vol0[p] = atom->vfrac[i];
    }
    b.n = n;
    b.h = shortest;
    b.time = elapsed_time(*update);
    b.history = reinterpret_cast<double(*)[BATCH]>(history.data());
    (total ? kernels->load_total : kernels->load)(b, n, dt, L, F, tau, vol0, nullptr);
    for (int k = 0; k < material->nhistory; k++)
      for (int p = 0; p < n; p++) b.history[k][p] = material->history[list[p]][k];
    material->update_batch(b, *kernels);
    if (!total && !material->material->uses_F()) kernels->forget_shape(b);
    const int bad = kernels->store(b, F, tau);
    for (int p = 0; p < n; p++) {
      const int i = list[p];
      if (bad && !(b.J[p] > 0.0))
        error->one(FLERR,
                   "Point {} of fix mpm/mesh {} has a deformation gradient of determinant {} at "
                   "step {}: position {:.6g} "
                   "{:.6g} {:.6g}, velocity {:.6g} {:.6g} {:.6g}; use a smaller time step, or a "
                   "finer mesh",
                   atom->tag[i], id, b.J[p], update->ntimestep, atom->x[i][0], atom->x[i][1],
                   atom->x[i][2], atom->v[i][0], atom->v[i][1], atom->v[i][2]);
      std::copy_n(F + 9 * p, 9, points->F[i]);
      std::copy_n(tau + 6 * p, 6, points->tau[i]);
      for (int k = 0; k < material->nhistory; k++) material->history[i][k] = b.history[k][p];
    }
  });
}

void FixMPMMesh::load_state(const int *list, int n, const FixMPMMaterial *material) const
{
  Batch &b = *batch;
  b.n = n;
  b.dt = update->dt;
  b.h = shortest;
  b.history = reinterpret_cast<double(*)[BATCH]>(const_cast<double *>(history.data()));
  for (int p = 0; p < n; p++) {
    const int i = list[p];
    for (int c = 0; c < 9; c++) b.F[c][p] = points->F[i][c];
    b.J[p] = points->jacobian(i);
    for (int c = 0; c < 6; c++) b.stress[c][p] = points->tau[i][c] / b.J[p];
    b.vol0[p] = atom->vfrac[i];
    for (int k = 0; k < material->nhistory; k++) b.history[k][p] = material->history[i][k];
  }
}

void FixMPMMesh::visit_batches(int group_bits, const BatchVisitor &visit)
{
  find_materials();
  std::vector<int> of;
  for (int i = 0; i < atom->nlocal; i++)
    if (is_point(i) && (atom->mask[i] & group_bits)) of.push_back(i);
  for_batches(of, [&](const int *list, int n, const FixMPMMaterial *material) {
    load_state(list, n, material);
    visit(*batch, list, *material);
  });
}

/* ----------------------------------------------------------------------
   h/(c + |v|) with the height of the cell; in the total frame it shrinks with the smallest stretch, and points stay in their
   cells
------------------------------------------------------------------------- */

double FixMPMMesh::stable_dt(tagint &tag) const
{
  // at the end of a step points have moved since their cells were found, unless there was a new neighbor list

  const auto cell_now = [this](int i) {
    BackgroundMesh::Place place = places[i];
    if (!total) mesh->find(position(i), places[i].cell, place);
    return place.cell < 0 ? places[i].cell : place.cell;
  };

  double smallest = std::numeric_limits<double>::max(), c[BATCH];
  tag = 0;
  for_batches(order, [&](const int *list, int n, const FixMPMMaterial *material) {
    load_state(list, n, material);
    material->material->wave_speed(*batch, c);
    for (int p = 0; p < n; p++) {
      const int i = list[p];
      double h = mesh->cells[cell_now(i)].height, speed = c[p];
      if (total) {
        const double *const F = points->F[i];
        const double cofactors[9] = MPM_COFACTORS(F), inv = 1.0 / dot(F, cofactors);
        double rows[3][3];
        for (int k = 0; k < 9; k++) rows[k / 3][k % 3] = inv * cofactors[k];
        h /= std::sqrt(ElementRule::of(ElementType::TRIANGLE).largest_eigenvalue(rows));
      } else {
        speed += std::sqrt(dot(atom->v[i], atom->v[i]));
      }
      const double dt = speed > 0.0 ? h / speed : std::numeric_limits<double>::max();
      if (std::isnan(smallest) || dt >= smallest) continue;    // NaN does not pass unseen
      smallest = dt;
      tag = atom->tag[i];
    }
  });
  return smallest;
}

void FixMPMMesh::check_dt()
{
  if (steps % CHECK_EVERY) return;
  tagint tag;
  const double limit = stable_dt(tag);
  if (!(update->dt <= limit))
    error->one(FLERR,
               "Time step {:.6g} is above the limit {:.6g} of fix mpm/mesh {} at step {}, height "
               "of a cell over the speed of "
               "waves and of point {}; use timestep, fix mpm/dt, or a mesh without small cells",
               update->dt, limit, id, update->ntimestep, tag);
}

/* ----------------------------------------------------------------------
   scalar: number of points; vector: kinetic and stored energy, work of forces from outside, points that are outside of
   the mesh by less than OUTSIDE; forces of the conditions on the body
------------------------------------------------------------------------- */

double FixMPMMesh::compute_scalar()
{
  double n = 0.0, all;
  for (int i = 0; i < atom->nlocal; i++) n += is_point(i);
  MPI_Allreduce(&n, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMMesh::compute_vector(int k)
{
  double mine = 0.0, all;
  if (k == 0) {
    for (const int i : order)
      mine += 0.5 * force->mvv2e * atom->rmass[i] * dot(atom->v[i], atom->v[i]);
  } else if (k == 1) {
    double energy[BATCH];
    for_batches(order, [&](const int *list, int n, const FixMPMMaterial *material) {
      load_state(list, n, material);
      material->material->stored_energy(*batch, energy);
      for (int p = 0; p < n; p++) mine += atom->vfrac[list[p]] * energy[p] / force->nktv2p;
    });
  } else if (k == 2) {
    mine = load_work;
  } else if (k == 3) {
    for (const int i : order) mine += places[i].outside > 0.0;
  } else {
    mine = forces->sum((k - 4) / 3, (k - 4) % 3);
  }
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void FixMPMMesh::write_restart(FILE *fp)
{
  std::vector<double> totals = {load_work};
  std::vector<double> same = {(double) positions.size()};
  if (total) share_positions();
  for (const auto &x : positions) same.insert(same.end(), x.begin(), x.end());
  write_totals(fp, world, totals, same);
  load_work = totals[0];
}

void FixMPMMesh::restart(char *buf)
{
  const auto *list = (const double *) buf;
  load_work = comm->me == 0 ? list[0] : 0.0;
  if (list[1] != (double) positions.size())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh {} has another frame or mesh than in the restart file, where {} nodes "
               "have moved, and not {}: give it those of the file",
               id, list[1], positions.size());
  list += 2;
  for (auto &x : positions) {
    std::copy_n(list, 3, x.data());
    list += 3;
  }
}

double FixMPMMesh::memory_usage()
{
  return FixMPMState::memory_usage() + ranks.memory_usage() +
      (double) (places.capacity() * sizeof(BackgroundMesh::Place) + sums.capacity() * sizeof(Node) +
                (before.capacity() + after.capacity() + mapped.capacity()) * sizeof(MeshVector) +
                volumetric.capacity() * sizeof(Volumetric)) +
      (means ? means->memory_usage() : 0.0);
}
