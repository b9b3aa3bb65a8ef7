/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/fix_mpm_elements.h"

#include "atom.h"
#include "base/mpm_image.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "group.h"
#include "material/material.h"
#include "math_extra.h"
#include "mesh/curved_surface.h"
#include "mesh/rims.h"
#include "modify.h"
#include "neighbor.h"
#include "pair.h"
#include "step/mpm_grains.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// bending: share of rough triangles from which on a warning is due
static constexpr double MANY_ROUGH = 0.1;

// number of nodes from which the owner of an element is chosen
static int number_of_corners(const MeshElement &element)
{
  return element.type == ElementType::PATCH ? 3 : element_nodes(element.type);
}

/* ----------------------------------------------------------------------
   fix ID group mpm/elements FILE keyword value ...
------------------------------------------------------------------------- */

FixMPMElements::FixMPMElements(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), dim(domain->dimension), points(MPMPoints::get(atom))
{
  Options options = declare(dim);
  read_options(lmp, options, narg, arg, 3);
  const int along = thin.dimension(dim);
  if (!points)
    error->all(FLERR,
               "Fix mpm/elements requires material points: use atom_style mpm, or hybrid with mpm");
  if (!atom->tag_enable) error->all(FLERR, "Fix mpm/elements requires atom IDs");

  restart_global = 1;
  scalar_flag = vector_flag = 1;
  size_vector = 3;
  global_freq = 1;
  extscalar = extvector = 1;

  Mesh mesh = read_body(lmp, file, part, along, "Fix mpm/elements", 3);
  SurfaceKind kind = {};
  if (along == dim - 1) kind = mesh.orient_surface();
  nelements = mesh.elements.size();
  try {
    if (bending) mesh.add_bending();
  } catch (const std::runtime_error &e) {
    error->all(FLERR, "Fix mpm/elements bending: {}", e.what());
  }
  try {
    if (curved && !bending) add_edges(mesh, find_rims(mesh));
  } catch (const std::runtime_error &e) {
    error->all(FLERR, "Fix mpm/elements curved: {}", e.what());
  }
  if (curved && !kind.closed)
    error->all(FLERR,
               "Fix mpm/elements curved is for closed surfaces, and that of {} has a rim: use "
               "curved no",
               file);
  body = std::make_unique<ElementBody>(dim, along, thin.across(), bending, curved);
  body->count_nodes_and_points(mesh);
  if (fbar && body->maxpoint == 1)
    error->all(FLERR,
               "Fix mpm/elements locking fbar is for quadrangles and hexahedra: elements with "
               "one integration point have no other volume to average with");

  // ghosts are found by their IDs

  if (atom->map_style == Atom::MAP_NONE) {
    atom->map_user = Atom::MAP_YES;
    atom->map_init();
    atom->map_set();
  }

  material = find_material();
  variables = names_of_history();
  body->set_history(material->nhistory);
  width = 18 + body->nhistory;
  comm_reverse = width;
  surface = std::make_unique<ElementSurface>(lmp, *body, kind);
  const MPMElementsOptions &given = *this;
  internal = std::make_unique<ElementForces>(lmp, id, given, *body);
  internal->define(material);
  state.declare(first, "mpm/elements:first");
  state.declare(count, "mpm/elements:count");
  make_elements(mesh);
  maxexchange = 1 + max_of_node * body->stride;
}

FixMPMElements::~FixMPMElements() = default;

/* ----------------------------------------------------------------------
   the material of the nodes must be that of the elements
------------------------------------------------------------------------- */

FixMPMMaterial *FixMPMElements::find_material() const
{
  const auto all = modify->get_fix_by_style("^mpm/material$");
  int mine = -1, index;
  for (int i = 0; i < atom->nlocal; i++)
    for (int k = 0; k < (int) all.size() && (atom->mask[i] & groupbit); k++)
      if (atom->mask[i] & all[k]->groupbit) mine = k;
  MPI_Allreduce(&mine, &index, 1, MPI_INT, MPI_MAX, world);
  if (index < 0)
    error->all(FLERR,
               "Fix mpm/elements {}: the points of group {} have no material: define a fix "
               "mpm/material for them before",
               id, group->names[igroup]);
  bigint other = 0, others;
  for (int i = 0; i < atom->nlocal; i++)
    other += (atom->mask[i] & groupbit) && !(atom->mask[i] & all[index]->groupbit);
  MPI_Allreduce(&other, &others, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (others)
    error->all(FLERR,
               "Fix mpm/elements {}: the points of group {} must have one material: use a "
               "fix mpm/elements and a mesh for each",
               id, group->names[igroup]);
  return dynamic_cast<FixMPMMaterial *>(all[index]);
}

std::string FixMPMElements::names_of_history() const
{
  std::string text;
  for (const auto &variable : material->material->history()) text += " " + variable.name;
  return text.empty() ? " none" : text;
}

/* ---------------------------------------------------------------------- */

FixMPMElements::IDs FixMPMElements::count_nodes() const
{
  IDs mine = {0, MAXTAGINT, 0}, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    mine.n++;
    mine.low = std::min(mine.low, atom->tag[i]);
    mine.high = std::max(mine.high, atom->tag[i]);
  }
  MPI_Allreduce(&mine.n, &all.n, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&mine.low, &all.low, 1, MPI_LMP_TAGINT, MPI_MIN, world);
  MPI_Allreduce(&mine.high, &all.high, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  return all;
}

/* ----------------------------------------------------------------------
   elements from the mesh, whose nodes are the points of the group in order of their IDs; the
   reference configuration is where these are now
------------------------------------------------------------------------- */

void FixMPMElements::make_elements(const Mesh &mesh)
{
  const auto nnodes = (bigint) mesh.nodes.size();
  ids = count_nodes();
  if (ids.n != nnodes || (bigint) ids.high - ids.low + 1 != nnodes)
    error->all(FLERR,
               "Fix mpm/elements {}: group {} has {} atoms with IDs from {} to {}, the mesh has "
               "{} nodes: its group must be the points that one create_points ... mesh made from "
               "the same mesh",
               id, group->names[igroup], ids.n, ids.n ? ids.low : 0, ids.high, nnodes);

  std::vector<double> mine(3 * nnodes, 0.0), x(3 * nnodes);
  std::vector<int> local(nnodes, -1);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    const tagint k = atom->tag[i] - ids.low;
    local[k] = i;
    for (int d = 0; d < 3; d++) mine[3 * k + d] = atom->x[i][d];
  }
  MPI_Allreduce(mine.data(), x.data(), (int) (3 * nnodes), MPI_DOUBLE, MPI_SUM, world);

  // each element belongs to the node that owns fewest so far

  std::vector<int> owned(nnodes, 0);
  std::vector<std::pair<int, int>> here;    // (atom, element)
  for (int e = 0; e < (int) mesh.elements.size(); e++) {
    const auto &element = mesh.elements[e];
    int owner = element.node[0];
    for (int k = 1; k < number_of_corners(element); k++)
      if (owned[element.node[k]] < owned[owner]) owner = element.node[k];
    max_of_node = std::max(max_of_node, ++owned[owner]);
    if (local[owner] >= 0) here.emplace_back(local[owner], e);
  }
  std::sort(here.begin(), here.end());
  body->pool.assign(here.size() * body->stride, 0.0);
  bigint rough = 0, all_rough;
  for (std::size_t k = 0; k < here.size(); k++)
    make_row(k, mesh.elements[here[k].second], x.data(), rough);
  if (curved) {
    const auto swells = curved_areas(dim, mesh, [&](int a, int b, double *to) {
      MathExtra::sub3(&x[3 * (std::size_t) b], &x[3 * (std::size_t) a], to);
      nearest_image(*domain, to);
    });
    for (std::size_t k = 0; k < here.size(); k++)
      if (double *const r = body->row(k); !body->bends(r))
        r[body->stride - 1] = swells[here[k].second];
  }
  const double least = internal->shortest;
  MPI_Allreduce(&least, &internal->shortest, 1, MPI_DOUBLE, MPI_MIN, world);
  MPI_Allreduce(&rough, &all_rough, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (comm->me == 0 && (double) all_rough > MANY_ROUGH * (double) nelements)
    error->warning(FLERR,
                   "Fix mpm/elements {} bending: {} of {} triangles know too few nodes around them "
                   "to tell curvatures apart, and are too stiff: use a mesh whose inner nodes have "
                   "five to seven triangles each",
                   id, all_rough, nelements);

  internal->set_initial_stress();
  check_volume();

  keep_arrays();
  for (std::size_t k = 0; k < here.size(); k++)
    if (count[here[k].first]++ == 0.0) first[here[k].first] = (double) k;
}

/** Fills the row of an element. x: positions of all nodes of the mesh. */
void FixMPMElements::make_row(std::size_t row, const MeshElement &element, const double *x,
                              bigint &rough)
{
  double *const r = body->row(row);
  r[0] = (double) element.label;
  r[1] = (double) static_cast<int>(element.type);
  double X[PATCH_NODES][3];
  for (int m = 0; m < body->rule_of(r).nnode; m++) {
    MathExtra::sub3(x + 3 * (std::size_t) element.node[m], x + 3 * (std::size_t) element.node[0],
                    X[m]);
    nearest_image(*domain, X[m]);
    r[2 + m] = (double) (ids.low + element.node[m]);
    for (int d = 0; d < dim && !body->bends(r); d++) r[2 + body->maxnode + m * dim + d] = X[m][d];
  }
  if (!body->bends(r)) {
    internal->define_points(r, X, x + 3 * (std::size_t) element.node[0]);
  } else if (!body->define_bending(r, X, element.inside, rough)) {
    error->one(
        FLERR,
        "Fix mpm/elements {}: element {} of the mesh and the next one make an angle: bending "
        "is for lines that are straight when this fix is defined",
        id, (bigint) r[0]);
  }
}

/** The elements must have the volume of their nodes. */
void FixMPMElements::check_volume() const
{
  double volume[2] = {internal->volume, 0.0}, volumes[2];
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit) volume[1] += atom->vfrac[i];
  MPI_Allreduce(volume, volumes, 2, MPI_DOUBLE, MPI_SUM, world);
  if (!modify->nfix_restart_peratom && !(fabs(volumes[0] - volumes[1]) <= 1.0e-6 * volumes[0]))
    error->all(
        FLERR,
        "Fix mpm/elements {}: the elements have a volume of {:.8g}, their nodes of {:.8g}: "
        "points that create_points ... mesh made must not be deformed before, and thickness or "
        "section must be the same",
        id, volumes[0], volumes[1]);
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::init()
{
  check_nodes();
  check_fields();
  has_lattice = field_of_nodes() != nullptr;
  warned_slack = false;
  surface->pressure = nullptr;
  comm_reverse = width = 18 + body->nhistory;
  comm_forward = 3;

  // the fix mpm/material at the time of definition may have been removed or redefined since

  material = find_material();
  if (names_of_history() != variables)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/elements {}: its elements have the history variables{}, but the present "
               "fix mpm/material {} of its points has{}: elements cannot go on with such a law, "
               "define this fix after their material",
               id, variables, material->id, names_of_history());

  internal->define(material);
  if (bending) bending_frequency = largest_bending_frequency();

  // nodes of elements may be ghosts; elements that have stretched since need comm_modify

  // one that is less than that of a pair style is a warning of LAMMPS
  const double extent = largest_extent();
  if (!force->pair || extent > force->pair->cutforce + neighbor->skin)
    comm->cutghostuser = std::max(comm->cutghostuser, extent);
}

/* ----------------------------------------------------------------------
   the nodes must be those of the definition, and of no other mesh, whose forces would be added
------------------------------------------------------------------------- */

void FixMPMElements::check_nodes() const
{
  const IDs now = count_nodes();
  if (now.n != ids.n || now.low != ids.low || now.high != ids.high)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: group {} has {} atoms with IDs from {} to {}, but had {} from {} "
        "on: nodes of elements must not be added, deleted or renumbered; unfix it before",
        id, group->names[igroup], now.n, now.n ? now.low : 0, now.high, ids.n, ids.low);

  for (const auto *other : modify->get_fix_by_style("^mpm/elements$"))
    if (other != this && has_points_of(other->groupbit))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/elements {} and {} have points in common, which would feel the forces of "
                 "both: give them disjoint groups, or unfix one of them",
                 id, other->id);
}

bool FixMPMElements::has_points_of(int other_groupbit) const
{
  int mine = 0, any;
  for (int i = 0; i < atom->nlocal; i++)
    mine |= (atom->mask[i] & groupbit) && (atom->mask[i] & other_groupbit);
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any != 0;
}

const char *FixMPMElements::field_of_nodes() const
{
  for (const auto *field : MPMField::all(lmp))
    if (has_points_of(field->fix.groupbit)) return field->id();
  return nullptr;
}

/* ---------------------------------------------------------------------- */

std::vector<NearNodes::Edge> FixMPMElements::edges() const
{
  return gather(body->edges(ids.low));
}

/** Gathers the values of all ranks on all ranks, in the order of ranks. */
template <class T> std::vector<T> FixMPMElements::gather(const std::vector<T> &mine) const
{
  const int size = (int) (mine.size() * sizeof(T));
  std::vector<int> sizes(comm->nprocs), starts(comm->nprocs, 0);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, world);
  for (int p = 1; p < comm->nprocs; p++) starts[p] = starts[p - 1] + sizes[p - 1];
  std::vector<T> all((starts.back() + sizes.back()) / sizeof(T));
  MPI_Allgatherv(mine.data(), size, MPI_BYTE, all.data(), sizes.data(), starts.data(), MPI_BYTE,
                 world);
  return all;
}

void FixMPMElements::check_fields() const
{
  for (const auto *field : MPMField::all(lmp)) {
    if (!has_points_of(field->fix.groupbit)) continue;
    const auto refuse = [&](bool broken, const std::string &what, const std::string &why) {
      if (broken)
        error->all(FLERR, "Fix mpm {} {} fix mpm/elements {}{}", field->id(), what, id, why);
    };
    const auto &given = field->options;
    refuse(given.locking != MPMFieldOptions::NO_CURE, "locking is not for nodes of elements: use",
           " locking fbar");
    refuse(given.bad == MPMFieldOptions::DELETE || given.delete_failed,
           "bad delete and failed delete cannot be used with",
           ", whose nodes must not be deleted: give them a fix mpm of their own");
    refuse(given.axisymmetric, "axisymmetric cannot be used with",
           ", whose elements are of plane strain: use create_points elements with shape cpdi2");
    refuse(given.every > 1, "every cannot be used with",
           ", which strains elements in each step: use every 1");
  }
}

/* ----------------------------------------------------------------------
   an upper bound for the distance of nodes of an element, with room for more deformation: the
   Frobenius norm of F is sqrt(dim) without deformation
------------------------------------------------------------------------- */

double FixMPMElements::largest_extent() const
{
  const auto extents = body->extents();
  double largest = extents.nodes, all;
  double mine[2] = {extents.bent, extents.stretch}, all_of[2];
  if (bending || curved) {
    MPI_Allreduce(mine, all_of, 2, MPI_DOUBLE, MPI_MAX, world);
    largest = std::max(largest, sqrt(all_of[0] * all_of[1]));
  }
  MPI_Allreduce(&largest, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}

/* ----------------------------------------------------------------------
   sorts rows in the order of atoms, and finds their nodes
------------------------------------------------------------------------- */

void FixMPMElements::find_nodes()
{
  const int nlocal = atom->nlocal;
  std::vector<double> sorted;
  sorted.reserve(body->pool.size());
  body->nodes.clear();
  body->owner.clear();
  for (int i = 0; i < nlocal; i++) {
    if (count[i] == 0) continue;
    const double *r = body->row(first[i]);
    first[i] = (double) body->nodes.size();
    sorted.insert(sorted.end(), r, r + (int) count[i] * body->stride);
    for (int k = 0; k < count[i]; k++, r += body->stride) {
      body->nodes.emplace_back();
      body->owner.push_back(i);
      const int nnode = body->nodes_of(r);
      for (int m = 0; m < nnode; m++) {
        const int j = atom->map((tagint) r[2 + m]);
        if (j < 0)
          error->one(
              FLERR,
              "Fix mpm/elements {}: node {} of element {} is out of reach at step {}: "
              "it has left the box, or the element was stretched and needs a larger comm_modify "
              "cutoff than the present {:.6g}",
              id, (tagint) r[2 + m], (bigint) r[0], update->ntimestep, comm->get_comm_cutoff());
        body->nodes.back()[m] = domain->closest_image(i, j);
      }
    }
  }
  body->pool.swap(sorted);
}

/* ----------------------------------------------------------------------
   forces of the elements on their nodes, and means of their state for output
------------------------------------------------------------------------- */

void FixMPMElements::compute(bool starting)
{
  const int nlocal = atom->nlocal, nall = nlocal + atom->nghost;
  sums.assign((std::size_t) nall * width, 0.0);
  const auto strain = [&]() {
    internal->strain(starting, sums.data(), width);
  };
  if (has_lattice)
    strain();
  else
    keep_spent(strain);
  if (bending) {
    const double scale = 1.0 / force->nktv2p;
    body->for_bending(atom->x, [&](double, std::size_t e, int nnode, const double(*f)[3]) {
      for (int m = 0; m < nnode; m++)
        for (int d = 0; d < dim; d++)
          sums[(std::size_t) body->nodes[e][m] * width + d] += scale * f[m][d];
    });
  }
  if (surface->pressure) surface->add_pressure(starting, sums.data(), width);
  comm->reverse_comm(this);

  give_means_to_nodes();
}

/** Adds forces of elements to those of their nodes, which show means of their state. */
void FixMPMElements::give_means_to_nodes()
{
  const int nlocal = atom->nlocal;
  clear_points(force_on, atom, 3);
  double **const f = atom->f;
  for (int i = 0; i < nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    const double *const s = &sums[(std::size_t) i * width], inverse = 1.0 / atom->vfrac[i];
    for (int d = 0; d < dim; d++) {
      force_on[3 * (std::size_t) i + d] = s[d];
      f[i][d] += s[d];
      if (!surface->pressure) continue;
      f[i][d] += s[width - 3 + d];
      if (surface->kind.closed) force_on[3 * (std::size_t) i + d] += s[width - 3 + d];
    }
    for (int c = 0; c < 9; c++) points->F[i][c] = inverse * s[3 + c];
    if (thin) {
      for (int c = 0; c < 9; c++) points->F[i][c] = 0.0;
      const double stretch = dim == 2 ? sqrt(inverse * s[3]) : cbrt(inverse * s[3]);
      for (int d = 0; d < 3; d++) points->F[i][4 * d] = d < dim ? stretch : 1.0;
    }
    for (int c = 0; c < 6; c++) points->tau[i][c] = inverse * s[12 + c];
    for (int k = 0; k < body->nhistory; k++) material->history[i][k] = inverse * s[18 + k];
  }
}

/* ---------------------------------------------------------------------- */

std::vector<ElementBody::NumberedFace> FixMPMElements::all_faces() const
{
  std::vector<ElementBody::NumberedFace> mine;
  for (int i = 0; i < atom->nlocal; i++)    // other rows may be from before a restart
    for (int k = 0; k < count[i]; k++)
      body->add_numbered_faces((std::size_t) first[i] + k, ids.low, mine);
  return gather(mine);
}

void FixMPMElements::set_pressure(MPMElementsPressure *who, bool closed)
{
  if (body->along != dim - 1)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/elements {} has no surface for a pressure: use the keyword thickness", id);
  if (surface->pressure)
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/elements {} has more than one fix mpm/airbag",
               id);
  if (!surface->kind.oriented)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: its surface has no two sides: more than two elements meet at an "
        "edge, or it is a Moebius strip",
        id);
  if (closed && !surface->kind.closed)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: its surface has a rim, and encloses no gas: use a closed mesh, whose "
        "elements share their nodes, or fix mpm/airbag pressure",
        id);
  surface->pressure = who;
  comm_reverse = width = 21 + body->nhistory;    // before LAMMPS makes room for messages
}

/** Largest frequency of free nodes, by the theorem of Gerschgorin: its square is at most the
 *  largest sum of a row of the stiffness over its mass. */
double FixMPMElements::largest_bending_frequency() const
{
  std::vector<double> sum(ids.n, 0.0), all(ids.n);
  body->add_bending_sums(ids.low, sum);
  MPI_Allreduce(sum.data(), all.data(), (int) ids.n, MPI_DOUBLE, MPI_SUM, world);
  double largest = 0.0, square;
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit)
      largest = std::max(largest, all[atom->tag[i] - ids.low] / atom->rmass[i]);
  MPI_Allreduce(&largest, &square, 1, MPI_DOUBLE, MPI_MAX, world);
  return sqrt(square * force->ftm2v / force->nktv2p);
}

/* ----------------------------------------------------------------------
   Energy that a body without a lattice spends is not in the balance of the lattices, which has
   neither its kinetic energy nor the forces that move it: the material returns it, and this fix
   keeps it
------------------------------------------------------------------------- */

void FixMPMElements::keep_spent(const std::function<void()> &strain)
{
  double work_before[NWORK];
  std::copy_n(material->work, (int) NWORK, work_before);
  const double stress_before = material->stress_work;
  strain();
  for (const int k : {MPM_NS::Work::PLASTIC, MPM_NS::Work::VISCOUS, MPM_NS::Work::FRACTURE})
    spent += material->work[k] - work_before[k];
  std::copy_n(work_before, (int) NWORK, material->work);
  material->stress_work = stress_before;
}

double FixMPMElements::compute_vector(int k)
{
  const double to_energy = 1.0 / force->nktv2p;
  if (k == 2) return surface->work * to_energy;
  const double mine = k == 0 ? stored_energy() : spent;
  double all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return (k == 0 ? all + surface->work : all) * to_energy;
}

double FixMPMElements::stored_energy() const
{
  double sum = comm->me == 0 ? -surface->work : 0.0;
  internal->add_stored_energy(sum);
  if (bending)
    body->for_bending(atom->x, [&](double stored, std::size_t, int, const double(*)[3]) {
      sum += stored;
    });
  return sum;
}

/* ----------------------------------------------------------------------
   bending and the gas add stiffness, so that squares of frequencies add
------------------------------------------------------------------------- */

double FixMPMElements::stable_dt(tagint &tag, double &speed) const
{
  // 1 % of the time step, less than what the bound has to spare
  constexpr double LITTLE_GAS = 0.14;
  const double smallest = internal->stable_dt(tag, speed);
  const double gas = gas_frequency();
  if (tag == 0) return smallest;    // no elements here: other ranks know the limit
  const double others = hypot(2.0 / smallest, bending ? bending_frequency : 0.0);
  if (gas < LITTLE_GAS * others) return 2.0 / others;
  if (gas > others) speed = 0.0;
  return 2.0 / hypot(others, gas);
}

double FixMPMElements::gas_frequency() const
{
  if (!surface->has_gas()) return 0.0;
  auto &self = const_cast<FixMPMElements &>(*this);    // for messages
  self.sent.assign(3 * ((std::size_t) atom->nlocal + atom->nghost), 0.0);
  const double volume = surface->volume_gradient(self.sent.data());
  std::vector<double> gradient(3 * (std::size_t) atom->nlocal, 0.0);
  self.bring_home(gradient.data());
  return surface->gas_frequency(volume, gradient.data(), groupbit);
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::check_dt() const
{
  tagint tag;
  double speed;
  const double limit = stable_dt(tag, speed);
  if (update->dt <= limit) return;
  if (speed == 0.0)
    error->one(
        FLERR,
        "Time step {:.6g} is above the limit {:.6g} of fix mpm/elements {} at step {}, mostly by "
        "the stiffness of the gas in it (fix mpm/airbag): use timestep, or fix mpm/dt",
        update->dt, limit, id, update->ntimestep);
  error->one(FLERR,
             "Time step {:.6g} is above the limit {:.6g} of fix mpm/elements {} at step {}: "
             "element with node {}, wave speed {:.6g}; use timestep, fix mpm/dt, or a mesh without "
             "small elements",
             update->dt, limit, id, update->ntimestep, tag, speed);
}

/* ----------------------------------------------------------------------
   Where a slack element becomes taut its stiffness jumps, and Verlet steps that are not small then
   gain energy each time. A bag that unfolds has 1.29 of its energy after 4000 steps of 0.8 of the
   limit, 1.007 with half and 1.001 with a quarter of it
------------------------------------------------------------------------- */

void FixMPMElements::check_free_dt()
{
  constexpr double SLACK = 0.55;    // largest share of the limit without a warning
  check_dt();
  if (force->pair && update->setupflag)
    warn_of_points_as_grains(lmp, groupbit, fmt::format("Fix mpm/elements {}", id));
  if (compression || warned_slack) return;
  tagint tag;
  double speed, limit;
  const double mine = stable_dt(tag, speed);
  MPI_Allreduce(&mine, &limit, 1, MPI_DOUBLE, MPI_MIN, world);
  if (!(update->dt > SLACK * limit)) return;
  warned_slack = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/elements {}: slack elements without a lattice gain energy when they become taut "
        "with time steps above half of the limit, and this one is {:.2f} of it: use fix mpm/dt "
        "0.25",
        id, update->dt / limit);
}

/* ---------------------------------------------------------------------- */

double FixMPMElements::memory_usage()
{
  return FixMPMState::memory_usage() + (double) body->nodes.capacity() * sizeof(body->nodes[0]) +
      (double) (body->pool.capacity() + sums.capacity() + force_on.capacity()) * sizeof(double) +
      internal->memory_usage();
}

/* ----------------------------------------------------------------------
   elements move with their atom. find_nodes() drops rows that no atom owns any more
------------------------------------------------------------------------- */

int FixMPMElements::pack_exchange(int i, double *buf)
{
  const int n = (int) count[i] * body->stride;
  buf[0] = count[i];
  if (n) std::copy_n(body->row(first[i]), n, buf + 1);
  return 1 + n;
}

int FixMPMElements::unpack_exchange(int i, double *buf)
{
  const int n = (int) buf[0] * body->stride;
  count[i] = buf[0];
  first[i] = (double) (body->size());
  body->pool.insert(body->pool.end(), buf + 1, buf + 1 + n);
  return 1 + n;
}

void FixMPMElements::unpack_restart(int i, int nth)
{
  int n;
  const double *const values = from_restart(i, nth, n);
  if (n != 1 + (int) values[0] * body->stride)
    error->one(
        FLERR,
        "Fix mpm/elements {}: the restart file was written with another mesh or material, or with "
        "other values of bending or curved",
        id);
  unpack_exchange(i, const_cast<double *>(values));
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::write_restart(FILE *fp)
{
  keep_totals(world, &spent, 1);
  if (comm->me) return;
  const double list[] = {internal->shortest, surface->work, spent};
  const int size = sizeof(list);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(list, sizeof(list), 1, fp);
}

void FixMPMElements::restart(char *buf)
{
  double list[3];
  memcpy(list, buf, sizeof(list));
  internal->shortest = list[0];
  surface->work = list[1];
  spent = comm->me == 0 ? list[2] : 0.0;
}

/* ---------------------------------------------------------------------- */

int FixMPMElements::pack_reverse_comm(int n, int start, double *buf)
{
  if (!sent.empty()) {    // see bring_home()
    std::copy_n(&sent[3 * (std::size_t) start], 3 * (std::size_t) n, buf);
    return 3 * n;
  }
  memcpy(buf, sums.data() + (std::size_t) start * width, sizeof(double) * n * width);
  return n * width;
}

void FixMPMElements::unpack_reverse_comm(int n, int *list, double *buf)
{
  for (int k = 0; k < n && !sent.empty(); k++)
    for (int d = 0; d < 3; d++) sent[3 * (std::size_t) list[k] + d] += *buf++;
  for (int k = 0; k < n && sent.empty(); k++) {
    double *const s = &sums[(std::size_t) list[k] * width];
    for (int c = 0; c < width; c++) s[c] += *buf++;
  }
}
