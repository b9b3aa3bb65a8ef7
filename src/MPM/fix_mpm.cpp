/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_mpm.h"

#include "atom.h"
#include "comm.h"
#include "compute_mpm_energy.h"
#include "domain.h"
#include "error.h"
#include "fix_mpm_elements.h"
#include "fix_mpm_material.h"
#include "fix_mpm_surface.h"
#include "force.h"
#include "group.h"
#include "material/batch.h"
#include "memory.h"
#include "modify.h"
#include "mpm_halo.h"
#include "mpm_node_action.h"
#include "mpm_points.h"
#include "neighbor.h"
#include "output.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;
using namespace MPM_NS;

// node numbers of an axis, and those of blocks, must fit into 21 bits with their sign
static constexpr double MAX_NODE = 4.0e6;

/* ----------------------------------------------------------------------
   fix ID group mpm H keyword value ...
------------------------------------------------------------------------- */

FixMPM::FixMPM(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), shape(QUADRATIC), bernstein(false), extent(NO_SIZE), aspect{1.0, 1.0, 1.0},
    transfer(APIC), flip(0.0), poly(false), refinement(LUMPED), order(1), total(false),
    most_distorted(0.0), axisymmetric(false), scheme(USL), stress(DEFAULT_STRESS), locking(NO_CURE),
    light(0.0), policy(ERROR), delete_failed(false), modified_edges(false), every(1),
    dt_check(true), watch_volume(false), keep_old(false), grid(nullptr), C(nullptr), Q(nullptr),
    corners(nullptr), X(nullptr), R(nullptr), waiting(nullptr), ledger_on(false),
    volume_rate({0.0, 0}), points(nullptr), halo(nullptr), kernels(nullptr), batch_kernels(nullptr),
    driver(false), topology_valid(false), watch_drift(false), drifted(0), refer_anew(false),
    want_sort(false), switches(0), switches_sorted(0), tile(nullptr), tile_load(nullptr), waited(0),
    elapsed(0.0), batch(nullptr), kinetic_points(0.0), nbad_total(0), next_dt_check(0), clock(0.0),
    running(false), velocities(0), velocities_known(false)
{
  points = MPMPoints::get(atom);
  if (!points)
    error->all(FLERR, "Fix mpm requires material points: use atom_style mpm, or hybrid with mpm");
  if (!domain->box_exist)
    error->all(FLERR, "Fix mpm needs the simulation box: define it with create_box before");

  process_options(narg, arg);

  time_integrate = 1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = 11;
  global_freq = 1;
  extscalar = 1;
  extvector = 0;
  restart_global = 1;
  memset(&report, 0, sizeof(Report));
  memset(&ledger, 0, sizeof(MPMLedger));
  memset(&deleted, 0, sizeof(deleted));

  if (may_delete() || most_distorted > 0.0) {
    force_reneighbor = 1;
    next_reneighbor = -1;
  }
  if (is_affine(transfer) || total || every > 1 || extent == CORNERS) {
    FixMPM::grow_arrays(atom->nmax);
    atom->add_callback(Atom::GROW);
    atom->add_callback(Atom::RESTART);
    restart_peratom = 1;
    create_attribute = 1;
    maxexchange = own_size();
    for (int i = 0; i < atom->nlocal; i++) FixMPM::set_arrays(i);
  }

  grid = new Grid(lattice);
  halo = new MPMHalo(lmp);
  batch = new Batch();    // zero, see material/batch.h
  tile = (double *) memory->smalloc(tile_reals() * sizeof(double), "mpm:tile");
  tile_load = (double *) memory->smalloc(tile_reals() * sizeof(double), "mpm:tile");
  memset(tile, 0, tile_reals() * sizeof(double));
  memset(tile_load, 0, tile_reals() * sizeof(double));
}

/* ---------------------------------------------------------------------- */

FixMPM::~FixMPM()
{
  if ((C || X || waiting || corners) && modify) {
    atom->delete_callback(id, Atom::GROW);
    atom->delete_callback(id, Atom::RESTART);
  }
  memory->destroy(C);
  memory->destroy(Q);
  memory->destroy(X);
  memory->destroy(R);
  memory->destroy(corners);
  memory->destroy(waiting);
  memory->sfree(tile);
  memory->sfree(tile_load);
  delete grid;
  delete halo;
  delete batch;
}

/* ---------------------------------------------------------------------- */

void FixMPM::process_options(int narg, char **arg)
{
  if (narg < 4) utils::missing_cmd_args(FLERR, "fix mpm", error);

  lattice.dim = domain->dimension;
  lattice.h = utils::numeric(FLERR, arg[3], false, lmp);
  if (!(lattice.h > 0.0) || !std::isfinite(lattice.h))
    error->all(FLERR, 3, "Fix mpm node spacing must be positive: {}", arg[3]);
  for (int d = 0; d < 3; d++) lattice.origin[d] = domain->boxlo[d];
  if (lattice.dim == 2) lattice.origin[2] = 0.0;

  bool has_aspect = false;
  int iarg = 4;
  while (iarg < narg) {
    const std::string keyword = arg[iarg];
    auto need = [&](int n) {
      if (iarg + n >= narg) utils::missing_cmd_args(FLERR, "fix mpm " + keyword, error);
    };
    auto choose = [&](const std::vector<std::string> &names) {
      need(1);
      for (std::size_t k = 0; k < names.size(); k++)
        if (names[k] == arg[iarg + 1]) return (int) k;
      std::string known;
      for (const auto &name : names) known += " " + name;
      error->all(FLERR, iarg + 1, "Unknown fix mpm {} {}: must be one of{}", keyword, arg[iarg + 1],
                 known);
      return -1;
    };
    if (keyword == "shape") {
      const int kind =
          choose({"linear", "quadratic", "cubic", "gimp", "cpgimp", "cpdi", "cpdi2", "bernstein"});
      bernstein = kind == 7;
      extent = kind < 3 || bernstein ? NO_SIZE : (Extent) (UNIFORM + kind - 3);
      shape = kind < 3 ? (Shape) (1 + kind) : (kind < 5 || bernstein ? QUADRATIC : LINEAR);
      iarg += 2;
    } else if (keyword == "aspect") {
      need(lattice.dim);
      double product = 1.0;
      for (int d = 0; d < lattice.dim; d++) {
        aspect[d] = utils::numeric(FLERR, arg[iarg + 1 + d], false, lmp);
        if (!(aspect[d] > 0.0 && std::isfinite(aspect[d])))
          error->all(FLERR, iarg + 1 + d, "Fix mpm aspect must be positive: {}", arg[iarg + 1 + d]);
        product *= aspect[d];
      }
      for (int d = 0; d < lattice.dim; d++) aspect[d] /= pow(product, 1.0 / lattice.dim);
      has_aspect = true;
      iarg += 1 + lattice.dim;
    } else if (keyword == "transfer") {
      const int kind = choose({"pic", "flip", "apic", "aflip", "tpic", "xpic", "fmpm", "polypic"});
      poly = kind == 7;
      transfer = kind < 5 ? (Transfer) kind : (poly ? APIC : FLIP);
      refinement = kind == 5 ? XPIC : (kind == 6 ? FMPM : LUMPED);
      flip = 0.0;
      if (refinement != LUMPED) {
        need(2);
        order = utils::inumeric(FLERR, arg[iarg + 2], false, lmp);
        if (order < 1 || order > 100)
          error->all(FLERR, iarg + 2, "Fix mpm transfer {} order must be within 1 and 100: {}",
                     arg[iarg + 1], arg[iarg + 2]);
        flip = refinement == XPIC ? 1.0 : 0.0;
        iarg++;
      } else if (adds_change(transfer)) {
        need(2);
        flip = utils::numeric(FLERR, arg[iarg + 2], false, lmp);
        if (!(flip >= 0.0 && flip <= 1.0))
          error->all(FLERR, iarg + 2, "Fix mpm transfer {} share must be within 0 and 1: {}",
                     arg[iarg + 1], arg[iarg + 2]);
        iarg++;
      }
      iarg += 2;
    } else if (keyword == "scheme") {
      scheme = (Scheme) choose({"usl", "usf", "musl", "usavg"});
      iarg += 2;
    } else if (keyword == "frame") {
      total = choose({"updated", "total"}) == 1;
      iarg += 2;
    } else if (keyword == "stress") {
      stress = (Stress) (1 + choose({"mls", "gradient"}));
      iarg += 2;
    } else if (keyword == "reference") {
      most_distorted = 0.0;
      if (choose({"fixed", "update"}) == 1) {
        need(2);
        most_distorted = utils::numeric(FLERR, arg[iarg + 2], false, lmp);
        if (!(most_distorted > 1.0 && std::isfinite(most_distorted)))
          error->all(FLERR, iarg + 2,
                     "Fix mpm reference update needs a ratio of stretches above 1: {}",
                     arg[iarg + 2]);
        iarg++;
      }
      iarg += 2;
    } else if (keyword == "axisymmetric") {
      need(1);
      axisymmetric = utils::logical(FLERR, arg[iarg + 1], false, lmp);
      if (axisymmetric && lattice.dim != 2)
        error->all(FLERR, iarg, "Fix mpm axisymmetric needs dimension 2");
      iarg += 2;
    } else if (keyword == "locking") {
      locking = (Locking) choose({"none", "fbar", "pressure", "both"});
      iarg += 2;
    } else if (keyword == "light") {
      need(1);
      light = utils::numeric(FLERR, arg[iarg + 1], false, lmp);
      if (!(light >= 0.0 && light <= 1.0))
        error->all(FLERR, iarg + 1, "Fix mpm light share must be within 0 and 1: {}",
                   arg[iarg + 1]);
      iarg += 2;
    } else if (keyword == "origin") {
      need(lattice.dim);
      for (int d = 0; d < lattice.dim; d++)
        lattice.origin[d] = utils::numeric(FLERR, arg[iarg + 1 + d], false, lmp);
      iarg += 1 + lattice.dim;
    } else if (keyword == "bad") {
      policy = (Policy) choose({"error", "warn", "delete"});
      iarg += 2;
    } else if (keyword == "failed") {
      delete_failed = choose({"keep", "delete"}) == 1;
      iarg += 2;
    } else if (keyword == "edges") {
      modified_edges = choose({"plain", "modified"}) == 1;
      iarg += 2;
    } else if (keyword == "every") {
      need(1);
      every = utils::inumeric(FLERR, arg[iarg + 1], false, lmp);
      if (every < 1)
        error->all(FLERR, iarg + 1, "Fix mpm every must be at least 1: {}", arg[iarg + 1]);
      iarg += 2;
    } else if (keyword == "dtcheck") {
      need(1);
      dt_check = utils::logical(FLERR, arg[iarg + 1], false, lmp);
      iarg += 2;
    } else if (keyword == "kernels") {
      static const char *const name[] = {"", "reference", "baseline", "avx2", "avx512"};
      isa = name[choose({"auto", "reference", "baseline", "avx2", "avx512"})];
      iarg += 2;
    } else
      error->all(FLERR, iarg, "Unknown fix mpm keyword: {}", keyword);
  }

  if (most_distorted > 0.0 && !total)
    error->all(FLERR,
               "Fix mpm reference update is for frame total: in the updated frame, the reference "
               "is the present configuration in each step");
  if (has_aspect && extent == NO_SIZE)
    error->all(FLERR,
               "Fix mpm aspect is for points of finite size: use shape gimp, cpgimp, cpdi "
               "or cpdi2");
  if (total && (extent != NO_SIZE || transfer == AFLIP || transfer == TPIC))
    error->all(FLERR,
               "Fix mpm frame total cannot be used with shape gimp, cpgimp, cpdi and cpdi2, "
               "which points that cross no cells do not need, and transfer aflip and tpic: use "
               "B-splines with "
               "transfer apic or flip");
  if (poly && (total || !is_mls(kernel_shape(), transfer)))
    error->all(FLERR, "Fix mpm transfer polypic needs shape quadratic or cubic and frame updated");
  if (stress == MLS_STRESS && !is_mls(kernel_shape(), transfer))
    error->all(FLERR,
               "Fix mpm stress mls needs shape quadratic or cubic with transfer apic or aflip: "
               "other ones have the gradients of the shape functions");
  if (strains_apart() && total)
    error->all(FLERR,
               "Fix mpm stress gradient with frame total needs transfer flip or pic: that of "
               "transfer apic is stress mls");

  if (modified_edges &&
      (shape == LINEAR || bernstein || extent != NO_SIZE || refinement != LUMPED ||
       is_affine(transfer)))
    error->all(FLERR,
               "Fix mpm edges modified is for shape quadratic and cubic with transfer pic and "
               "flip: use edges plain");

  if (bernstein && !total)
    error->all(FLERR,
               "Fix mpm shape bernstein has gradients that jump where points cross cells: it "
               "needs frame total, where they do not, or use shape quadratic");
  if (bernstein && poly)
    error->all(FLERR,
               "Fix mpm shape bernstein cannot be used with transfer polypic: use shape quadratic");

  check_box();
}

/* ----------------------------------------------------------------------
   the lattice must fit the box: called again in init(), since boundary and box may have changed
------------------------------------------------------------------------- */

void FixMPM::check_box()
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
    if (bernstein && lattice.periodic[d] && lattice.ncell[d] % 2)
      error->all(FLERR,
                 "Fix mpm shape bernstein has cells of two node spacings, but there are {} "
                 "spacings along periodic axis {}: use an even number, for instance a spacing of "
                 "{:.16g}",
                 lattice.ncell[d], axis, length / (lattice.ncell[d] + 1));
  }
  if (axisymmetric && (domain->boxlo[0] < 0.0 || domain->periodicity[0]))
    error->all(FLERR,
               "Fix mpm axisymmetric: x is the distance from the axis: the box must not reach "
               "below x = 0 or be periodic along x");
  if (lattice.dim == 2) {
    lattice.periodic[2] = false;
    lattice.ncell[2] = 1;
  }
  if (modified_edges) check_edges();
  if (grid) grid->lattice = lattice;
}

/* ---------------------------------------------------------------------- */

int FixMPM::setmask()
{
  return INITIAL_INTEGRATE | PRE_EXCHANGE | PRE_NEIGHBOR;
}

/* ---------------------------------------------------------------------- */

void FixMPM::init()
{
  if (utils::strmatch(update->integrate_style, "^respa"))
    error->all(FLERR, "Fix mpm requires run_style verlet");
  if (update->whichflag == 2)
    error->all(FLERR,
               "Fix mpm cannot be used with minimize, which would move material points like "
               "atoms: minimize before the fix is defined");
  check_box();
  if (domain->box_change_size || domain->box_change_shape)
    error->all(FLERR,
               "Fix mpm requires a box of constant size and shape: remove the fix that "
               "changes it");

  running = watch_volume = false;
  ledger_on = !modify->get_compute_by_style("^mpm/energy$").empty();
  if (axisymmetric) check_axis();

  if (refinement == FMPM && scheme != USL)
    error->all(FLERR,
               "Fix mpm {}: transfer fmpm moves points with refined velocities, which the "
               "gradients of scheme usf, musl and usavg do not follow: use scheme usl, or transfer "
               "xpic",
               id);
  if (refinement == XPIC && order > 1 && scheme != USL && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {}: a body that turns loses its spin with transfer xpic and scheme "
                   "usf, musl and usavg: use scheme usl, or transfer flip or apic",
                   id);

  check_light_nodes();

  // all fields step together, driven by the first one

  auto all = modify->get_fix_by_style("^mpm$");
  driver = all[0] == this;
  fields.clear();
  actions.clear();
  if (driver) {
    for (auto *ifix : all) fields.push_back(dynamic_cast<FixMPM *>(ifix));
    for (auto *ifix : modify->get_fix_list())
      if (auto *action = dynamic_cast<MPMNodeAction *>(ifix)) actions.push_back(action);
    std::stable_sort(actions.begin(), actions.end(), [](auto *a, auto *b) {
      return a->turn() < b->turn();
    });
    for (auto *field : fields)
      if (field->every != every)
        error->all(FLERR, "All fix mpm instances must have the same every: {} and {} differ", id,
                   field->id);
    for (auto *field : fields)
      if (field->scheme != scheme)
        error->all(FLERR, "All fix mpm instances must have the same scheme: {} and {} differ", id,
                   field->id);
    for (auto *field : fields)
      if (field->axisymmetric != axisymmetric)
        error->all(FLERR, "All fix mpm instances must be axisymmetric, or none: {} and {} differ",
                   id, field->id);
    for (auto *field : fields) field->keep_old = false;
    for (auto *action : actions) action->init_action();
    if (neighbor->includegroup) {
      bool known = false;
      for (auto *ifix : modify->get_fix_by_style("^mpm/surface$"))
        known = known || dynamic_cast<FixMPMSurface *>(ifix)->keeps_group(neighbor->includegroup);
      if (!known)
        error->all(FLERR,
                   "Neigh_modify include {} leaves the forces of other material points as they "
                   "are: use fix mpm/surface with keyword group {}",
                   group->names[neighbor->includegroup], group->names[neighbor->includegroup]);
    }
  }

  materials.clear();
  for (auto *ifix : modify->get_fix_by_style("^mpm/material$"))
    materials.push_back(dynamic_cast<FixMPMMaterial *>(ifix));
  elements.clear();
  for (auto *ifix : modify->get_fix_by_style("^mpm/elements$"))
    elements.push_back(dynamic_cast<FixMPMElements *>(ifix));
  if (materials.empty())
    error->all(FLERR, "Fix mpm found no material: define one with fix mpm/material");

  // the same instruction set for transfers, batches and laws

  const char *wanted = isa.empty() ? nullptr : isa.c_str();
  kernels = MPMKernels::select(wanted);
  batch_kernels = BatchKernels::select(lattice.dim, wanted, axisymmetric);
  bool can_run = kernels && batch_kernels;
  for (auto *material : materials)
    can_run = can_run &&
        material->material->configure(wanted, force->mvv2e * force->nktv2p, force->nktv2p);
  if (!can_run)
    error->all(FLERR, "Fix mpm kernels {} cannot run on this CPU or were not compiled",
               wanted ? wanted : "named by the environment variable MPM_ISA");

  // LAMMPS warns when the groups of two integrators overlap, but atoms of this group that are not
  // material points may well be moved by others; check_integrators() looks at the points

  time_integrate = 1;
  for (auto *other : modify->get_fix_list())
    if (other != this && other->time_integrate) time_integrate = 0;

  // points need no ghosts; a cutoff that is next to nothing spares LAMMPS's warning about none

  if (!force->pair && comm->cutghostuser == 0.0) comm->cutghostuser = 1.0e-8 * lattice.h;

  // points are kept in order of blocks and cells here

  atom->sortfreq = 0;
}

/* ---------------------------------------------------------------------- */

void FixMPM::setup_pre_neighbor()
{
  // the ledger and some node actions need forces and old velocities on the nodes, USF and USAVG sum
  // forces alone; the kernel that interpolates the hoop rate knows long records only

  const bool split = ledger_on || keep_old || stress_before() || (axisymmetric && scheme != USL);
  const auto choose = total ? kernels->transfer_total : kernels->transfer;
  kernel = choose(lattice.dim, kernel_shape(), transfer, split);
  if (strains_apart()) {
    // to the nodes, TPIC differs in nothing but the stress; back, it has the gradient
    const auto tpic = choose(lattice.dim, kernel_shape(), TPIC, kernel.nreal == 8);
    kernel.p2g = tpic.p2g;
    kernel.p2g_force = tpic.p2g_force;
    kernel.g2p_gradient = tpic.g2p_gradient;
    kernel.gradient_in_C = false;
  }
  if (poly) modes = PolyKernels::select(*kernels, lattice.dim, shape, kernel.nreal);
  pic = kernels->transfer(lattice.dim, kernel_shape(), PIC, true);
  batch->h = lattice.h;

  // points drift at most half a skin between rebuilds when LAMMPS checks distances each step;
  // a tile has room for a drift of one cell

  watch_drift = !total && !has_domains() &&
      (every > 1 || neighbor->includegroup || neighbor->skin > 2.0 * lattice.h ||
       neighbor->delay > 0 || neighbor->every > 1 || !neighbor->dist_check);

  check_integrators();
  check_points();
  if (force->pair) check_radii();
  if (driver && force->pair) check_neighbors();
  set_reference();
  give_initial_stress();
  sort_points();
  topology_valid = false;
}

double FixMPM::current_time() const
{
  return update->atime + (update->ntimestep - update->atimestep) * update->dt;
}

/* ----------------------------------------------------------------------
   points without any stress get the pressure of their equation of state, so that the first step
   begins with that of a gas; for points that have come to zero stress this changes nothing;
   points that have failed keep it
------------------------------------------------------------------------- */

void FixMPM::give_initial_stress()
{
  std::vector<double> history;
  std::vector<int> list;
  const FixMPMMaterial *material = nullptr;
  const auto flush = [&]() {
    if (list.empty()) return;
    load_state(*batch, list.data(), list.size(), material, history);
    batch->time = current_time();
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

void FixMPM::setup(int)
{
  memset(&report, 0, sizeof(Report));
  halo->bytes_sent = 0;
  report.dt_min = report.dt_max = step_dt();
  if (update->dt <= 0.0) error->all(FLERR, "Fix mpm requires a positive time step: {}", update->dt);
  running = true;
  fit_affine();
  if (waited) topology_valid = false;
  if (ledger_on) kinetic_points = point_kinetic_energy();
  next_dt_check = update->ntimestep;
  if (update->nsteps > 0) {
    check_dt();
    warn_dt();
  }
}

/* ---------------------------------------------------------------------- */

void FixMPM::setup_pre_exchange()
{
  check_velocities();
  check_inside_box();
}

void FixMPM::pre_exchange()
{
  check_inside_box();
}

/* ----------------------------------------------------------------------
   after exchange and borders: restore the order of points when it has decayed.
   At steps with a restart file the order must not depend on history, so that a run that
   continues from the file sums in the same order.
------------------------------------------------------------------------- */

void FixMPM::pre_neighbor()
{
  int flag = want_sort, flag_all;
  MPI_Allreduce(&flag, &flag_all, 1, MPI_INT, MPI_MAX, world);
  if (refer_anew) {
    update_reference();
    flag_all = 1;
  }
  if (flag_all || restart_step()) sort_points();
  topology_valid = false;
}

bool FixMPM::restart_step() const
{
  return output->restart_flag && output->next_restart == update->ntimestep;
}

/* ---------------------------------------------------------------------- */

bool FixMPM::is_point(int i) const
{
  return (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0;
}

const double *FixMPM::place(int i) const
{
  return X ? X[i] : atom->x[i];
}

FixMPMMaterial *FixMPM::material_of(int i) const
{
  for (auto *material : materials)
    if (atom->mask[i] & material->groupbit) return material;
  return nullptr;
}

bool FixMPM::is_node(int i) const
{
  for (auto *ifix : elements)
    if (atom->mask[i] & ifix->groupbit) return true;
  return false;
}

int FixMPM::npoints_local() const
{
  int n = 0;
  for (int i = 0; i < atom->nlocal; i++) n += is_point(i);
  return n;
}

/* ---------------------------------------------------------------------- */

PointRows FixMPM::rows() const
{
  PointRows r;
  r.x = X ? &X[0][0] : &atom->x[0][0];
  r.from = &atom->x[0][0];
  r.v = &atom->v[0][0];
  r.f = waiting ? mean_force.data() : &atom->f[0][0];
  r.C = C ? &C[0][0] : nullptr;
  r.tau = &points->tau[0][0];
  r.vol0 = atom->vfrac;
  r.F = &points->F[0][0];
  r.mass = atom->rmass;
  r.guarded = atom->nmax - 1;
  r.size = has_boxes() ? sizes.data() : nullptr;
  if (has_domains()) r.domain = corners ? &corners[0][0] : domains.data();
  r.xnew = moves_late() ? const_cast<double *>(xnew.data()) : &atom->x[0][0];
  return r;
}

/** Rows for transfers of other values and weights, in which points stay (the time step is zero). */
PointRows FixMPM::rows_at_rest(double *values, const double *weights) const
{
  PointRows r = rows();
  r.v = values;
  r.mass = weights;
  r.xnew = r.x;
  r.from = r.x;
  r.F = nullptr;
  return r;
}

TransferStep FixMPM::step_data() const
{
  TransferStep s;
  s.h = lattice.h;
  s.inv_h = 1.0 / lattice.h;
  for (int d = 0; d < 3; d++) s.origin[d] = lattice.origin[d];
  s.dt = step_dt();
  s.flip = flip;
  s.force_scale = force->ftm2v;
  s.stress_scale = force->ftm2v / force->nktv2p;
  return s;
}

/* ---------------------------------------------------------------------- */

void FixMPM::load_state(Batch &b, const int *list, int n, const FixMPMMaterial *material,
                        std::vector<double> &history) const
{
  b.n = n;
  b.dt = step_dt();
  b.h = lattice.h;
  history.resize((std::size_t) MAX(1, material->nhistory) * BATCH);
  b.history = reinterpret_cast<double(*)[BATCH]>(history.data());
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
   affine matrix of APIC and reference position: per-atom arrays that migrate and restart with the
   atom
------------------------------------------------------------------------- */

void FixMPM::grow_arrays(int nmax)
{
  if (is_affine(transfer)) memory->grow(C, nmax, affine_size(), "mpm:C");
  if (poly) memory->grow(Q, nmax, modes_size(), "mpm:Q");
  if (total) memory->grow(X, nmax, 3, "mpm:X");
  if (most_distorted > 0.0) memory->grow(R, nmax, 9, "mpm:R");
  if (every > 1) memory->grow(waiting, nmax, waiting_size(), "mpm:waiting");
  if (extent == CORNERS) memory->grow(corners, nmax, domain_size(), "mpm:corners");
}

void FixMPM::copy_arrays(int i, int j, int)
{
  if (C) memcpy(C[j], C[i], affine_size() * sizeof(double));
  if (Q) memcpy(Q[j], Q[i], modes_size() * sizeof(double));
  if (X) memcpy(X[j], X[i], 3 * sizeof(double));
  if (R) memcpy(R[j], R[i], 9 * sizeof(double));
  if (waiting) memcpy(waiting[j], waiting[i], waiting_size() * sizeof(double));
  if (corners) memcpy(corners[j], corners[i], domain_size() * sizeof(double));
}

void FixMPM::set_arrays(int i)
{
  if (C) {
    memset(C[i], 0, affine_size() * sizeof(double));
    if (!running) C[i][0] = NAN;    // not known, for fit_affine()
  }
  if (Q) memset(Q[i], 0, modes_size() * sizeof(double));
  if (X) {
    memcpy(X[i], atom->x[i], 3 * sizeof(double));
    if (!running) X[i][0] = NAN;    // not known, for set_reference()
  }
  for (int c = 0; c < 9 && R; c++) R[i][c] = c % 4 == 0;
  if (waiting) memset(waiting[i], 0, waiting_size() * sizeof(double));
  if (corners) corners[i][0] = NAN;    // not known, for update_domains()
}

int FixMPM::pack_exchange(int i, double *buf)
{
  const int own[3] = {C ? affine_size() : 0, waiting_size(), X ? 3 : 0};
  if (C) memcpy(buf, C[i], own[0] * sizeof(double));
  if (waiting) memcpy(buf + own[0], waiting[i], own[1] * sizeof(double));
  if (X) memcpy(buf + own[0] + own[1], X[i], own[2] * sizeof(double));
  if (R) memcpy(buf + own[0] + own[1] + own[2], R[i], 9 * sizeof(double));
  if (Q) memcpy(buf + own_size() - modes_size(), Q[i], modes_size() * sizeof(double));
  if (corners) memcpy(buf + own_size() - domain_size(), corners[i], domain_size() * sizeof(double));
  return own_size();
}

int FixMPM::unpack_exchange(int i, double *buf)
{
  const int own[3] = {C ? affine_size() : 0, waiting_size(), X ? 3 : 0};
  if (C) memcpy(C[i], buf, own[0] * sizeof(double));
  if (waiting) memcpy(waiting[i], buf + own[0], own[1] * sizeof(double));
  if (X) memcpy(X[i], buf + own[0] + own[1], own[2] * sizeof(double));
  if (R) memcpy(R[i], buf + own[0] + own[1] + own[2], 9 * sizeof(double));
  if (Q) memcpy(Q[i], buf + own_size() - modes_size(), modes_size() * sizeof(double));
  if (corners) memcpy(corners[i], buf + own_size() - domain_size(), domain_size() * sizeof(double));
  return own_size();
}

int FixMPM::pack_restart(int i, double *buf)
{
  buf[0] = 1 + own_size();
  pack_exchange(i, buf + 1);
  return 1 + own_size();
}

void FixMPM::unpack_restart(int i, int nth)
{
  double **extra = atom->extra;
  int m = 0;
  for (int k = 0; k < nth; k++) m += static_cast<int>(extra[i][m]);
  if (static_cast<int>(extra[i][m]) != 1 + own_size())
    error->one(
        FLERR,
        "The restart file has {} numbers per point for fix mpm {}, not {}: give the "
        "fix the shape, transfer, frame, reference and every with which the file was written",
        static_cast<int>(extra[i][m]) - 1, id, own_size());
  unpack_exchange(i, extra[i] + m + 1);
}

int FixMPM::size_restart(int)
{
  return 1 + own_size();
}

int FixMPM::maxsize_restart()
{
  return 1 + own_size();
}

/* ----------------------------------------------------------------------
   totals of the ledger, what was deleted, and which velocities the affine matrices belong to
------------------------------------------------------------------------- */

namespace {
struct Saved {
  double ledger[7], deleted[5], elapsed;
  uint64_t velocities;
  int velocities_known, waited, nstart;    // nstart reals follow
};
}    // namespace

void FixMPM::write_restart(FILE *fp)
{
  if (running) remember_velocities();
  Saved saved;
  memset(&saved, 0, sizeof(Saved));
  saved.velocities = velocities;
  saved.velocities_known = velocities_known;
  saved.waited = waited;
  saved.elapsed = elapsed;
  static_assert(sizeof(MPMLedger) == sizeof(saved.ledger), "MPMLedger holds 7 doubles");
  static_assert(sizeof(deleted) == sizeof(saved.deleted), "deleted holds 5 doubles");
  memcpy(saved.deleted, &deleted, sizeof(deleted));
  MPI_Reduce(&ledger, saved.ledger, 7, MPI_DOUBLE, MPI_SUM, 0, world);
  std::vector<double> start = ledger_start;
  for (auto *compute : modify->get_compute_by_style("^mpm/energy$"))
    if (start.empty()) start = dynamic_cast<ComputeMPMEnergy *>(compute)->start_sums();
  saved.nstart = (int) start.size();
  if (comm->me) return;
  const int size = (int) (sizeof(Saved) + start.size() * sizeof(double));
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(&saved, sizeof(Saved), 1, fp);
  fwrite(start.data(), sizeof(double), start.size(), fp);
}

void FixMPM::restart(char *buf)
{
  Saved saved;
  memcpy(&saved, buf, sizeof(Saved));
  if (comm->me == 0) memcpy(&ledger, saved.ledger, sizeof(saved.ledger));
  memcpy(&deleted, saved.deleted, sizeof(deleted));
  velocities = saved.velocities;
  velocities_known = saved.velocities_known != 0;
  waited = saved.waited;
  elapsed = saved.elapsed;
  ledger_start.resize(saved.nstart);
  memcpy(ledger_start.data(), buf + sizeof(Saved), saved.nstart * sizeof(double));
}
