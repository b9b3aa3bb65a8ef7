/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_field.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_mpm.h"
#include "fix_mpm_elements.h"
#include "fix_mpm_material.h"
#include "force.h"
#include "material/batch.h"
#include "modify.h"
#include "mpm_affine.h"
#include "mpm_cpdi.h"
#include "mpm_edges.h"
#include "mpm_every.h"
#include "mpm_frame.h"
#include "mpm_guard.h"
#include "mpm_halo.h"
#include "mpm_locking.h"
#include "mpm_plan.h"
#include "mpm_point_map.h"
#include "mpm_points.h"
#include "mpm_state.h"
#include "mpm_stencil.h"
#include "mpm_time_limit.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// node numbers of an axis, and those of blocks, must fit into 21 bits with their sign
static constexpr double MAX_NODE = 4.0e6;

static MPM_NS::Lattice lattice_of(const Domain &domain, double h, const MPMFieldOptions &options)
{
  MPM_NS::Lattice lattice;
  lattice.dim = domain.dimension;
  lattice.h = h;
  for (int d = 0; d < 3; d++) {
    lattice.origin[d] = d < lattice.dim ? options.origin[d] : domain.boxlo[d];
    lattice.periodic[d] = false;
    lattice.ncell[d] = 1;
  }
  if (lattice.dim == 2) lattice.origin[2] = 0.0;
  return lattice;
}

/* ---------------------------------------------------------------------- */

MPMField::MPMField(LAMMPS *lmp, Fix &fix, double h, const Options &options, MPMPointState &state) :
    Pointers(lmp), fix(fix), options(options), grid(lattice_of(*domain, h, options)),
    lattice(grid.lattice), halo(new MPMHalo(lmp)), points(MPMPoints::get(atom)), plan(nullptr),
    kernels(nullptr), batch_kernels(nullptr), batch(new Batch()), ledger(lmp, *this),
    keep_old(false), running(false), counts({0, 0.0, 0.0, 0.0}), state(state)
{
  if (options.modified_edges) edges.reset(new MPMEdges(lmp, *this));
  check_box();
  frame = MPMFrame::create(lmp, *this, state);
  if (is_affine(options.transfer)) affine.reset(new MPMAffine(lmp, *this, state));
  if (options.every > 1) every.reset(new MPMEvery(lmp, *this, state));
  if (options.shape == GIMP || options.shape == CPGIMP) boxes.reset(new MPMBoxes(lmp, *this));
  if (has_domain(options.shape)) domains.reset(new MPMCpdi(lmp, *this, state));
  if (options.locking != Options::NO_CURE) locking.reset(new MPMLocking(lmp, *this));
  guard.reset(new MPMGuard(lmp, *this));
  time_limit.reset(new MPMTimeLimit(lmp, *this));
  map.reset(new MPMPointMap(lmp, *this));
}

MPMField::~MPMField() = default;

/* ---------------------------------------------------------------------- */

std::vector<MPMField *> MPMField::all(LAMMPS *lmp)
{
  std::vector<MPMField *> list;
  for (auto *ifix : lmp->modify->get_fix_by_style("^mpm$"))
    list.push_back(dynamic_cast<FixMPM *>(ifix)->field.get());
  return list;
}

MPMField *MPMField::find(LAMMPS *lmp, const std::string &id)
{
  auto *ifix = dynamic_cast<FixMPM *>(lmp->modify->get_fix_by_id(id));
  return ifix ? ifix->field.get() : nullptr;
}

/* ----------------------------------------------------------------------
   the lattice must fit the box
------------------------------------------------------------------------- */

void MPMField::check_box()
{
  if (domain->triclinic) error->all(FLERR, "Fix mpm requires an orthogonal box");
  for (int d = 0; d < lattice.dim; d++) {
    const char axis = 'x' + d;
    if (domain->boundary[d][0] > 1 || domain->boundary[d][1] > 1)
      error->all(FLERR,
                 "Fix mpm requires periodic or fixed boundaries (p or f), "
                 "but axis {} is shrink-wrapped",
                 axis);
    const double length = domain->prd[d];
    if (lattice.h > length * (1.0 + 1.0e-10))
      error->all(FLERR, "Fix mpm node spacing {} is larger than the box length {} along {}",
                 lattice.h, length, axis);
    const double far =
        MAX(fabs(domain->boxlo[d] - lattice.origin[d]), fabs(domain->boxhi[d] - lattice.origin[d]));
    if (!(far < MAX_NODE * lattice.h))
      error->all(FLERR,
                 "Fix mpm node spacing {} is too small for the box length {} along {}, or "
                 "its origin {} is too far away: there can be {:.0f} nodes between them",
                 lattice.h, length, axis, lattice.origin[d], MAX_NODE);
    lattice.periodic[d] = domain->periodicity[d] != 0;
    lattice.ncell[d] = MAX(1, (int) std::lround(length / lattice.h));
    if (lattice.periodic[d] && fabs(lattice.ncell[d] * lattice.h - length) > 1.0e-10 * length)
      error->all(FLERR,
                 "Length {} of the box along periodic axis {} must be a multiple of the "
                 "node spacing {}: the nearest valid spacing is {:.16g}",
                 length, axis, lattice.h, length / lattice.ncell[d]);
    if (options.shape == BERNSTEIN && lattice.periodic[d] && lattice.ncell[d] % 2)
      error->all(FLERR,
                 "Fix mpm shape bernstein has cells of two node spacings, but there are {} "
                 "spacings along periodic axis {}: use an even number, for instance a spacing of "
                 "{:.16g}",
                 lattice.ncell[d], axis, length / (lattice.ncell[d] + 1));
  }
  if (options.axisymmetric && (domain->boxlo[0] < 0.0 || domain->periodicity[0]))
    error->all(FLERR,
               "Fix mpm axisymmetric: x is the distance from the axis: the box must not reach "
               "below x = 0 or be periodic along x");
  if (lattice.dim == 2) {
    lattice.periodic[2] = false;
    lattice.ncell[2] = 1;
  }
  if (edges) edges->check();
}

/* ---------------------------------------------------------------------- */

void MPMField::init(MPMPlan *plan_of_all)
{
  plan = plan_of_all;
  running = time_limit->watch_volume = keep_old = false;
  check_box();
  frame->check();
  ledger.on = !modify->get_compute_by_style("^mpm/energy$").empty();
  node_fields.clear();

  materials.clear();
  for (auto *ifix : modify->get_fix_by_style("^mpm/material$"))
    materials.push_back(dynamic_cast<FixMPMMaterial *>(ifix));
  elements.clear();
  for (auto *ifix : modify->get_fix_by_style("^mpm/elements$"))
    elements.push_back(dynamic_cast<FixMPMElements *>(ifix));
  if (materials.empty())
    error->all(FLERR, "Fix mpm found no material: define one with fix mpm/material");

  // the same instruction set for transfers, batches and laws

  const char *wanted = options.kernels.empty() ? nullptr : options.kernels.c_str();
  kernels = MPMKernels::select(wanted);
  batch_kernels = BatchKernels::select(lattice.dim, wanted, options.axisymmetric);
  bool can_run = kernels && batch_kernels;
  int nhistory = 1;
  for (auto *material : materials) {
    can_run = can_run &&
        material->material->configure(wanted, force->mvv2e * force->nktv2p, force->nktv2p);
    nhistory = std::max(nhistory, material->nhistory);
  }
  if (!can_run)
    error->all(FLERR, "Fix mpm kernels {} cannot run on this CPU or were not compiled",
               wanted ? wanted : "named by the environment variable MPM_ISA");
  history.resize((std::size_t) nhistory * BATCH);
}

/* ----------------------------------------------------------------------
   Long records of nodes keep forces and old velocities apart: the ledger and some node actions need
   them, USF and USAVG sum forces alone; the kernel that interpolates the hoop rate knows long records
   only
------------------------------------------------------------------------- */

void MPMField::choose_kernels()
{
  const bool split = ledger.on || keep_old || options.stress_before() ||
      (options.axisymmetric && options.scheme != Options::USL);
  kernel = frame->kernels(*kernels, options.transfer, split);
  if (options.strains_apart()) {
    // to the nodes, TPIC differs in nothing but the stress; back, it has the gradient
    const auto tpic = frame->kernels(*kernels, TPIC, kernel.nreal == 8);
    kernel.p2g = tpic.p2g;
    kernel.p2g_force = tpic.p2g_force;
    kernel.g2p_gradient = tpic.g2p_gradient;
    kernel.gradient_in_C = false;
  }
  if (options.polypic) affine->modes = kernels->poly(lattice.dim, options.shape, kernel.nreal);
  pic = kernels->transfer(lattice.dim, options.shape, PIC, true);
  batch->h = lattice.h;
}

/* ---------------------------------------------------------------------- */

const char *MPMField::id() const
{
  return fix.id;
}

bool MPMField::is_point(int i) const
{
  return (atom->mask[i] & fix.groupbit) && atom->vfrac[i] > 0.0;
}

bool MPMField::is_element_node(int i) const
{
  for (auto *ifix : elements)
    if (atom->mask[i] & ifix->groupbit) return true;
  return false;
}

FixMPMMaterial *MPMField::material_of(int i) const
{
  for (auto *material : materials)
    if (atom->mask[i] & material->groupbit) return material;
  return nullptr;
}

int MPMField::npoints_local() const
{
  int n = 0;
  for (int i = 0; i < atom->nlocal; i++) n += is_point(i);
  return n;
}

int MPMField::nmax() const
{
  return atom->nmax;
}

double **MPMField::positions() const
{
  return atom->x;
}

const double *MPMField::place(int i) const
{
  return frame->places()[i];
}

double MPMField::volume(int i) const
{
  return atom->vfrac[i] * points->jacobian(i);
}

/* ---------------------------------------------------------------------- */

double MPMField::step_dt() const
{
  return every ? every->step_dt() : update->dt;
}

double MPMField::end_of_step() const
{
  return update->atime + (update->ntimestep - update->atimestep) * update->dt;
}

int MPMField::steps_to_next() const
{
  return every ? every->steps_to_next() : 1;
}

int MPMField::weights(double t, int &first, double w[4]) const
{
  return MPMStencil(*this).weights(t, first, w);
}

bool MPMField::moves_late() const
{
  return options.stress_after() || options.light > 0.0 ||
      (locking && locking->averages_strain() && !options.stress_before());
}

/* ---------------------------------------------------------------------- */

PointRows MPMField::rows() const
{
  PointRows r;
  r.x = &frame->places()[0][0];
  r.from = &atom->x[0][0];
  r.v = &atom->v[0][0];
  r.f = every ? every->mean_force.data() : &atom->f[0][0];
  r.C = affine ? affine->rows() : nullptr;
  r.tau = &points->tau[0][0];
  r.vol0 = atom->vfrac;
  r.F = &points->F[0][0];
  r.mass = atom->rmass;
  r.guarded = atom->nmax - 1;
  r.size = boxes ? boxes->sizes.data() : nullptr;
  if (domains) r.domain = domains->rows();
  r.xnew = moves_late() ? const_cast<double *>(work.xnew.data()) : &atom->x[0][0];
  return r;
}

PointRows MPMField::rows_at_rest(double *values, const double *weights) const
{
  PointRows r = rows();
  r.v = values;
  r.mass = weights;
  r.xnew = r.x;
  r.from = r.x;
  r.F = nullptr;
  return r;
}

TransferStep MPMField::step_data() const
{
  TransferStep s;
  s.h = lattice.h;
  s.inv_h = 1.0 / lattice.h;
  for (int d = 0; d < 3; d++) s.origin[d] = lattice.origin[d];
  s.dt = step_dt();
  s.flip = options.flip;
  s.force_scale = force->ftm2v;
  s.stress_scale = force->ftm2v / force->nktv2p;
  return s;
}

int MPMField::domain_size() const
{
  return domains ? domains->size() : 0;
}

double (*MPMField::history_batch())[BATCH]
{
  return reinterpret_cast<double(*)[BATCH]>(history.data());
}

/* ---------------------------------------------------------------------- */

void MPMField::load_state(Batch &b, const int *list, int n, const FixMPMMaterial *material,
                          std::vector<double> &room) const
{
  b.n = n;
  b.dt = step_dt();
  b.h = lattice.h;
  room.resize((std::size_t) MAX(1, material->nhistory) * BATCH);
  b.history = reinterpret_cast<double(*)[BATCH]>(room.data());
  for (int p = 0; p < n; p++) {
    const int i = list[p];
    const double *F = points->F[i];
    for (int c = 0; c < 9; c++) b.F[c][p] = F[c];
    b.J[p] = points->jacobian(i);
    for (int c = 0; c < 6; c++) b.stress[c][p] = points->tau[i][c] / b.J[p];
    b.vol0[p] = atom->vfrac[i];
    for (int k = 0; k < material->nhistory; k++) b.history[k][p] = material->history[i][k];
  }
}

/* ----------------------------------------------------------------------
   points without any stress get the pressure of their equation of state, so that the first step
   begins with that of a gas; for points that have come to zero stress this changes nothing;
   points that have failed keep it
------------------------------------------------------------------------- */

void MPMField::give_initial_stress()
{
  std::vector<double> room;
  std::vector<int> list;
  const FixMPMMaterial *material = nullptr;
  const auto flush = [&]() {
    if (list.empty()) return;
    load_state(*batch, list.data(), list.size(), material, room);
    batch->time = end_of_step();
    material->material->initial_stress(*batch);
    for (std::size_t k = 0; k < list.size(); k++)
      for (int c = 0; c < 6; c++) points->tau[list[k]][c] = batch->J[k] * batch->stress[c][k];
    list.clear();
  };

  for (int i = 0; i < atom->nlocal; i++) {
    const double *s = points->tau[i];
    if (!is_point(i) || s[0] != 0.0 || s[1] != 0.0 || s[2] != 0.0 || s[3] != 0.0 || s[4] != 0.0 ||
        s[5] != 0.0)
      continue;
    const auto *mine = material_of(i);
    if (mine != material || list.size() == BATCH) flush();
    material = mine;
    const bool failed = mine && mine->damage >= 0 && mine->history[i][mine->damage] >= 1.0;
    if (mine && !failed) list.push_back(i);
  }
  flush();
}

/* ---------------------------------------------------------------------- */

NodeField &MPMField::add_node_field(const std::string &name, int width)
{
  node_fields.push_back({name, width, {}});
  return node_fields.back();
}

void MPMField::allocate_nodes()
{
  grid.allocate(kernel.nreal);
  for (auto &nodes : node_fields) nodes.values.assign(grid.nnodes() * nodes.width, 0.0);
}

void MPMField::sum(double *nodes, int nreal, int lane, int nlane) const
{
  if (edges) edges->fold(nodes, nreal, lane, nlane);
  grid.fold_aliases(nodes, nreal, lane, nlane);
  halo->sum(nodes, nreal, lane, nlane);
}

void MPMField::sum(NodeField &nodes) const
{
  sum(nodes.values.data(), nodes.width, 0, nodes.width);
}

void MPMField::complete(NodeField &nodes) const
{
  grid.copy_aliases(nodes.values.data(), nodes.width);
  if (edges) edges->extend(nodes.values.data(), nodes.width, 0, nodes.width);
}

void MPMField::complete_velocities()
{
  grid.copy_aliases();
  if (!edges) return;
  edges->extend(grid.nodes(), kernel.nreal, 0, 3);
  if (kernel.nreal == 8) edges->extend(grid.nodes(), kernel.nreal, 4, 3);
}

/* ---------------------------------------------------------------------- */

void MPMField::start_counting()
{
  counts = {0, 0.0, step_dt(), step_dt()};
  halo->bytes_sent = 0;
  map->nbuild = map->nsort = 0;
  map->sort_time = 0.0;
  frame->start_counting();
}

void MPMField::count_step()
{
  const double dt = step_dt();
  counts.dt_min = std::min(counts.dt_min, dt);
  counts.dt_max = std::max(counts.dt_max, dt);
  counts.steps++;
  counts.point_steps += map->npoints();
}

/* ----------------------------------------------------------------------
   per-point state: what LAMMPS keeps of any atom, atom style mpm, affine matrix, history
------------------------------------------------------------------------- */

double MPMField::bytes_per_point() const
{
  double bytes = 9 * sizeof(double) + sizeof(tagint) + 2 * sizeof(int) + sizeof(imageint);
  bytes += (1 + 1 + 9 + 6) * sizeof(double);    // mass, V0, F, stress
  bytes += state.size() * sizeof(double) + frame->bytes_per_point();
  if (boxes) bytes += 3 * sizeof(double);
  if (domains) bytes += domains->bytes_per_point();
  for (auto *material : materials) bytes += material->nhistory * sizeof(double);
  return bytes;
}

double MPMField::memory_usage() const
{
  double bytes = grid.memory_usage() + halo->memory_usage() + map->memory_usage() +
      frame->memory_usage() + history.capacity() * sizeof(double);
  if (edges) bytes += edges->memory_usage();
  if (locking) bytes += locking->memory_usage();
  if (domains) bytes += domains->memory_usage();
  if (boxes) bytes += boxes->sizes.capacity() * sizeof(double);
  if (every)
    bytes += (every->mean_force.capacity() + every->mean_torque.capacity()) * sizeof(double);
  for (const auto &nodes : node_fields) bytes += nodes.values.capacity() * sizeof(double);
  for (const auto *list : {&work.nodes, &work.node_velocities, &work.vectors, &work.weights,
                           &work.stress, &work.no_volume, &work.xnew})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}
