/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/fix_mpm_elements.h"

#include "atom.h"
#include "base/mpm_ghosts.h"
#include "base/mpm_image.h"
#include "base/mpm_input.h"
#include "base/mpm_lists.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_setup_checks.h"
#include "force.h"
#include "material/material.h"
#include "math_extra.h"
#include "mesh/curved_surface.h"
#include "mesh/rims.h"
#include "step/mpm_grains.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// bending: share of rough triangles from which on a warning is due
static constexpr double MANY_ROUGH = 0.1;

/** fix ID group mpm/elements FILE keyword value ... */
FixMPMElements::FixMPMElements(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), dim(domain->dimension), nodes(lmp, *this), uncoupled(lmp),
    points(MPMPoints::get(atom))
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

  material = nodes.find_material();
  variables = names_of_history();
  body->set_history(material->nhistory);
  width = 18 + body->nhistory;
  comm_reverse = width;
  surface = std::make_unique<ElementSurface>(lmp, *body, kind);
  const MPMElementsOptions &given = *this;
  internal = std::make_unique<ElementForces>(lmp, id, given, *body);
  tangents = std::make_unique<ElementTangents>(*body, *internal, *surface);
  internal->define(material);
  state.declare(first, "mpm/elements:first");
  state.declare(count, "mpm/elements:count");
  make_elements(mesh);
  maxexchange = 1 + max_of_node * body->stride;
}

std::string FixMPMElements::names_of_history() const
{
  std::string text;
  for (const auto &variable : material->material->history()) text += " " + variable.name;
  return text.empty() ? " none" : text;
}

/** Elements from the mesh, whose nodes are the points of the group in order of their IDs; the
 *  reference configuration is where these are now. */
void FixMPMElements::make_elements(const Mesh &mesh)
{
  std::vector<double> x;
  std::vector<int> local;
  nodes.define((bigint) mesh.nodes.size(), x, local);
  const auto owners = ElementBody::choose_owners(mesh, max_of_node);
  std::vector<std::pair<int, int>> here;    // (atom, element)
  for (int e = 0; e < (int) owners.size(); e++)
    if (local[owners[e]] >= 0) here.emplace_back(local[owners[e]], e);
  std::sort(here.begin(), here.end());
  body->pool.assign(here.size() * body->stride, 0.0);
  bigint rough = 0, all_rough;
  for (std::size_t k = 0; k < here.size(); k++)
    internal->make_row(body->row(k), mesh.elements[here[k].second], x.data(), nodes.ids.low, rough);
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
  nodes.check_volume(internal->volume);

  keep_arrays();
  for (std::size_t k = 0; k < here.size(); k++)
    if (count[here[k].first]++ == 0.0) first[here[k].first] = (double) k;
}

void FixMPMElements::init()
{
  set_up.remember(lmp);
  nodes.check();
  has_lattice = field_of_nodes() != nullptr;
  uncoupled.begin_run(*this);
  // without cutoffs there are no bins to sort by: LAMMPS would say so in each run
  if (!force->pair && atom->userbinsize == 0.0) atom->sortfreq = 0;
  warned_slack = false;
  surface->pressure = nullptr;
  comm_reverse = width = 18 + body->nhistory;
  comm_forward = 3;

  // the fix mpm/material at the time of definition may have been removed or redefined since
  material = nodes.find_material();
  if (names_of_history() != variables)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/elements {}: its elements have the history variables{}, but the present "
               "fix mpm/material {} of its points has{}: elements cannot go on with such a law, "
               "define this fix after their material",
               id, variables, material->id, names_of_history());

  internal->define(material);
  sort_rows();    // rows of a restart file take the place of those of the mesh
  if (bending) internal->find_bending_frequency(groupbit, nodes.ids);

  // nodes of elements may be ghosts; elements that have stretched since need comm_modify
  need_ghosts_within(lmp, largest_extent() + reached_from);
  reached_from = 0.0;    // the pair style may be another one in the next run
}

std::vector<NearNodes::Edge> FixMPMElements::edges() const
{
  return gather_on_all(body->edges(nodes.ids.low), world);
}

/** An upper bound for the distance of nodes of an element on all ranks, with room for more
 *  deformation: the Frobenius norm of F is sqrt(dim) without deformation. Collective. */
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

/** Sorts rows in the order of atoms, and finds their nodes. */
void FixMPMElements::sort_rows()
{
  std::vector<double> sorted;
  sorted.reserve(body->pool.size());
  for (int i = 0; i < atom->nlocal; i++) {
    if (count[i] == 0) continue;
    const double *const r = body->row(first[i]);
    first[i] = (double) (sorted.size() / body->stride);
    sorted.insert(sorted.end(), r, r + (int) count[i] * body->stride);
  }
  body->pool.swap(sorted);
}

/** The image of atom j that is nearest to atom i; -1 if only others are here. */
int FixMPMElements::find_image(int i, int j) const
{
  const int image = domain->closest_image(i, j);
  double here[3], nearest[3];
  MathExtra::sub3(atom->x[image], atom->x[i], here);
  MathExtra::copy3(here, nearest);
  nearest_image(*domain, nearest);
  return MathExtra::lensq3(nearest) < 0.999 * MathExtra::lensq3(here) ? -1 : image;
}

void FixMPMElements::find_nodes()
{
  sort_rows();
  body->nodes.clear();
  body->owner.clear();
  for (int i = 0; i < atom->nlocal; i++) {
    const double *r = body->row(first[i]);
    for (int k = 0; k < count[i]; k++, r += body->stride) {
      body->nodes.emplace_back();
      body->owner.push_back(i);
      const int nnode = body->nodes_of(r);
      for (int m = 0; m < nnode; m++) {
        const int j = atom->map((tagint) r[2 + m]), image = j < 0 ? j : find_image(i, j);
        if (image < 0)
          error->one(
              FLERR,
              "Fix mpm/elements {}: node {} of element {} is out of reach at step {}: "
              "it has left the box, or the element was stretched and needs a larger comm_modify "
              "cutoff than the present {:.6g}",
              id, (tagint) r[2 + m], (bigint) r[0], update->ntimestep, comm->get_comm_cutoff());
        body->nodes.back()[m] = image;
      }
    }
  }
}

/** Forces of the elements on their nodes, and means of their state for output. */
void FixMPMElements::compute(bool starting)
{
  sums.assign(((std::size_t) atom->nlocal + atom->nghost) * width, 0.0);
  const auto strain = [&]() {
    internal->strain(starting, sums.data(), width);
  };
  if (has_lattice)
    strain();
  else
    keep_spent(strain);
  if (surface->pressure) surface->add_pressure(starting, sums.data(), width);
  comm->reverse_comm(this);

  give_means_to_nodes();
}

/** Adds forces of elements to those of their nodes, which show means of their state. */
void FixMPMElements::give_means_to_nodes()
{
  clear_points(force_on, atom, 3);
  double **const f = atom->f;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!nodes.has(i)) continue;
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

std::vector<ElementBody::NumberedFace> FixMPMElements::all_faces() const
{
  std::vector<ElementBody::NumberedFace> mine;
  for (int i = 0; i < atom->nlocal; i++)    // other rows may be from before a restart
    for (int k = 0; k < count[i]; k++)
      body->add_numbered_faces((std::size_t) first[i] + k, nodes.ids.low, mine);
  return gather_on_all(mine, world);
}

/** Energy that a body without a lattice spends is not in the balance of the lattices, which has
 *  neither its kinetic energy nor the forces that move it: the material returns it, and this fix
 *  keeps it. */
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
  return sum;
}

/** Bending and the gas add stiffness, so that squares of frequencies add. */
double FixMPMElements::stable_dt(tagint &tag, double &speed) const
{
  // 1 % of the time step, less than what the bound has to spare
  constexpr double LITTLE_GAS = 0.14;
  const double smallest = internal->stable_dt(tag, speed);
  const double gas = gas_frequency();
  if (tag == 0) return smallest;    // no elements here: other ranks know the limit
  const double others = hypot(2.0 / smallest, bending ? internal->bending_frequency : 0.0);
  if (gas < LITTLE_GAS * others) return 2.0 / others;
  if (gas > others) speed = 0.0;
  return 2.0 / hypot(others, gas);
}

double FixMPMElements::gas_frequency() const
{
  if (!surface->has_gas()) return 0.0;
  double volume = 0.0;
  std::vector<double> gradient(3 * (std::size_t) atom->nlocal, 0.0);
  auto &self = const_cast<FixMPMElements &>(*this);    // for messages
  self.add_over_ranks(gradient.data(), [&](double *to) {
    volume = surface->volume_gradient(to);
  });
  return surface->gas_frequency(volume, gradient.data(), groupbit);
}

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
        "the stiffness of the gas in it (fix mpm/airbag): {}",
        update->dt, limit, id, update->ntimestep, remedy_of_step(lmp));
  error->one(FLERR,
             "Time step {:.6g} is above the limit {:.6g} of fix mpm/elements {} at step {}: "
             "element with node {}, wave speed {:.6g}; {}, or a mesh without small elements",
             update->dt, limit, id, update->ntimestep, tag, speed, remedy_of_step(lmp));
}

/** Where a slack element becomes taut its stiffness jumps, and Verlet steps that are not small then
 *  gain energy each time. A bag that unfolds has 33 times its energy after 500 steps of 0.8 of the
 *  limit, 1.011 with half and 0.997 with a quarter of it after the same time as 5500 steps. */
void FixMPMElements::check_free_dt()
{
  constexpr double SLACK = 0.5;    // largest share of the limit without a warning
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

/** A surface shares the velocities of the lattice at its nodes only. Where these are farther apart
 *  than those of the lattice, other points of the lattice go through between them. A balloon that
 *  is blown up, swings, and comes to rest loses no gas in 2000 steps if its edges are then up to
 *  1.02 spacings long, and some if they are 1.07; with 1.13 gas is 3 % of the radius outside, with
 *  1.25 it flies away. */
void FixMPMElements::look_for_gaps(bool starting)
{
  constexpr double WIDEST = 0.65;    // node spacings; 0.577 in triangles with edges of one spacing
  if (starting) {
    may_leak = is_thin() && body->along == dim - 1;
    if (!may_leak) return;
    const MPMField *const field = MPMField::find(lmp, field_of_nodes());
    bigint others = 0, all;
    for (int i = 0; i < atom->nlocal; i++) others += field->is_point(i) && !nodes.has(i);
    MPI_Allreduce(&others, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    may_leak = all > 0;
    spacing_of_field = field->lattice.h;
  }
  if (!may_leak) return;
  const double gap = surface->widest_gap() / spacing_of_field;
  if (!(gap > WIDEST)) return;
  may_leak = false;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/elements {}: places of the surface are up to {:.2f} node spacings from "
                   "its nodes at step {}, and other points of the same fix mpm can go through it "
                   "there: use a mesh whose edges are not longer than the spacing, also when it is "
                   "stretched",
                   id, gap, update->ntimestep);
}

double FixMPMElements::memory_usage()
{
  return FixMPMState::memory_usage() + bytes_of(body->nodes, body->pool, sums, force_on) +
      internal->memory_usage();
}

/** Elements move with their atom. sort_rows() drops rows that no atom owns any more. */
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

void FixMPMElements::write_restart(FILE *fp)
{
  keep_totals(world, &spent, 1);
  if (comm->me) return;
  const double list[] = {internal->shortest, surface->work, spent};
  write_state(fp, list, sizeof(list));
}

void FixMPMElements::restart(char *buf)
{
  double list[3];
  memcpy(list, read_state(lmp, id, buf, sizeof(list)), sizeof(list));
  internal->shortest = list[0];
  surface->work = list[1];
  spent = comm->me == 0 ? list[2] : 0.0;
}

int FixMPMElements::pack_reverse_comm(int n, int start, double *buf)
{
  if (!sent.empty()) {    // see add_over_ranks()
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

/** Stores the trial displacements, also of nodes that are points of other ranks. */
void FixMPMElements::take_motion(const double *u)
{
  motion.assign(3 * ((std::size_t) atom->nlocal + atom->nghost), 0.0);
  std::copy_n(u, 3 * (std::size_t) atom->nlocal, motion.data());
  comm->forward_comm(this, 3);
}

int FixMPMElements::pack_forward_comm(int n, int *list, double *buf, int, int *)
{
  for (int k = 0; k < n; k++) std::copy_n(&motion[3 * (std::size_t) list[k]], 3, buf + 3 * k);
  return 3 * n;
}

void FixMPMElements::unpack_forward_comm(int n, int first_one, double *buf)
{
  std::copy_n(buf, 3 * (std::size_t) n, &motion[3 * (std::size_t) first_one]);
}

/** Adds to the array to the sums over ranks of the values of nodes [local and ghost][3] that
 *  add(sent) adds to zeros. */
template <class Add> void FixMPMElements::add_over_ranks(double *to, const Add &add)
{
  sent.assign(3 * ((std::size_t) atom->nlocal + atom->nghost), 0.0);
  add(sent.data());
  comm->reverse_comm(this, 3);
  for (std::size_t k = 0; k < 3 * (std::size_t) atom->nlocal; k++) to[k] += sent[k];
  sent.clear();
}

bool FixMPMElements::forces_after(const double *u, double *f, double &carried)
{
  take_motion(u);
  bool good = false;
  std::fill_n(f, 3 * (std::size_t) atom->nlocal, 0.0);
  add_over_ranks(f, [&](double *to) {
    ElementForces::Trial trial{motion.data()};
    good = internal->try_motion(trial, [&](std::size_t e, int nnode, const double(*on)[3]) {
      for (int m = 0; m < nnode; m++) {
        double square = 0.0;
        for (int d = 0; d < dim; d++) {
          to[3 * (std::size_t) body->nodes[e][m] + d] += on[m][d];
          square += on[m][d] * on[m][d];
        }
        carried += std::sqrt(square);
      }
    });
    // forces() does not include the pressure on open surfaces at the start
    if (surface->pressure) surface->add_pressure_after(motion.data(), 1.0, to);
    if (surface->pressure && !surface->kind.closed) surface->add_pressure_after(nullptr, -1.0, to);
  });
  return good;
}

double FixMPMElements::differentiate(const double *u)
{
  take_motion(u);
  return tangents->find(motion.data());
}

void FixMPMElements::add_change(const double *du, double *dforce)
{
  take_motion(du);
  add_over_ranks(dforce, [this](double *to) {
    tangents->add_change(motion.data(), to);
  });
}

void FixMPMElements::add_blocks(double *blocks)
{
  for (int b = 0; b < dim; b++) {
    std::vector<double> column(3 * (std::size_t) atom->nlocal, 0.0);
    add_over_ranks(column.data(), [&](double *to) {
      tangents->add_stiffness(b, to);
    });
    for (int i = 0; i < atom->nlocal; i++)
      for (int d = 0; d < dim; d++)
        blocks[(std::size_t) i * dim * dim + dim * d + b] += column[3 * (std::size_t) i + d];
  }
}
