/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_field.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_affine.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_every.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_locking.h"
#include "field/mpm_node_action.h"
#include "field/mpm_nodes.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_map.h"
#include "field/mpm_setup_checks.h"
#include "field/mpm_smoothing.h"
#include "field/mpm_time_limit.h"
#include "field/mpm_transfer_heat.h"
#include "field/mpm_volume_drift.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// node numbers of an axis, and those of blocks, must fit into 21 bits with their sign
static constexpr double MAX_NODE = 4.0e6;
// mass of a node over that of a full cell; functions that end in its plane give it 1e-32 by
// round-off
static constexpr double NEGLIGIBLE = 1.0e-20;

static MPM_NS::Lattice lattice_of(const Domain &domain, double h, const MPMFieldOptions &options)
{
  MPM_NS::Lattice lattice = {domain.dimension, h, {0.0, 0.0, 0.0}, {}, {1, 1, 1}};
  std::copy_n(options.origin, lattice.dim, lattice.origin);
  return lattice;
}

MPMField::MPMField(LAMMPS *lmp, Fix &fix, double h, const Options &options, MPMPointState &state) :
    Pointers(lmp), chosen(options), fix(fix), grid(lattice_of(*domain, h, options)),
    lattice(grid.lattice), nodes(lmp, *this, grid), points(MPMPoints::get(atom)),
    batch(new Batch()), ledger(lmp, *this)
{
  check_box();
  frame = MPMFrame::create(lmp, *this, state);
  if (is_affine(options.transfer)) affine.reset(new MPMAffine(lmp, *this, state));
  if (options.every > 1) every.reset(new MPMEvery(lmp, *this, state));
  if (options.shape == GIMP || options.shape == CPGIMP) boxes.reset(new MPMBoxes(lmp, *this));
  if (has_domain(options.shape)) domains.reset(new MPMCpdi(lmp, *this, state));
  if (options.smooths_volumes()) smoothing.reset(new MPMSmoothing(lmp, *this));
  if (options.heat) heating.reset(new MPMTransferHeat(lmp, *this));
  if (options.locking != Options::NO_CURE) locking.reset(new MPMLocking(lmp, *this, state));
  guard.reset(new MPMGuard(lmp, *this));
  time_limit.reset(new MPMTimeLimit(lmp, *this));
  map.reset(new MPMPointMap(lmp, *this));
  drift.reset(new MPMVolumeDrift(lmp, *this));
}

MPMField::~MPMField() = default;

std::vector<MPMField *> MPMField::all(LAMMPS *lmp)
{
  std::vector<MPMField *> list;
  for (auto *ifix : find_fixes<MPMFieldOwner>(lmp)) list.push_back(ifix->field.get());
  return list;
}

MPMField *MPMField::find(LAMMPS *lmp, const std::string &id)
{
  auto *ifix = dynamic_cast<MPMFieldOwner *>(lmp->modify->get_fix_by_id(id));
  return ifix ? ifix->field.get() : nullptr;
}

void MPMField::check_box()
{
  if (domain->triclinic) error->all(FLERR, "Fix mpm requires an orthogonal box");
  for (int d = 0; d < lattice.dim; d++) {
    const char axis = 'x' + d;
    if (domain->boundary[d][0] > 1 || domain->boundary[d][1] > 1)
      error->all(
          FLERR,
          "Fix mpm requires periodic or fixed boundaries (p or f), but axis {} is shrink-wrapped",
          axis);
    const double length = domain->prd[d];
    if (lattice.h > length * (1.0 + 1.0e-10))
      error->all(FLERR, "Fix mpm node spacing {} is larger than the box length {} along {}",
                 lattice.h, length, axis);
    const double far =
        MAX(fabs(domain->boxlo[d] - lattice.origin[d]), fabs(domain->boxhi[d] - lattice.origin[d]));
    if (!(far < MAX_NODE * lattice.h))
      error->all(FLERR,
                 "Fix mpm node spacing {} is too small for the box length {} along {}, or its "
                 "origin {} is too far away: there can be {:.0f} nodes between them",
                 lattice.h, length, axis, lattice.origin[d], MAX_NODE);
    lattice.periodic[d] = domain->periodicity[d] != 0;
    lattice.ncell[d] = MAX(1, (int) std::lround(length / lattice.h));
    if (lattice.periodic[d] && fabs(lattice.ncell[d] * lattice.h - length) > 1.0e-10 * length)
      error->all(FLERR,
                 "Length {} of the box along periodic axis {} must be a multiple of the node "
                 "spacing {}: the nearest valid spacing is {:.16g}",
                 length, axis, lattice.h, length / lattice.ncell[d]);
    if (options.shape == BERNSTEIN && lattice.periodic[d] && lattice.ncell[d] % 2)
      error->all(
          FLERR,
          "Fix mpm shape bernstein has cells of two node spacings, but there are {} spacings along "
          "periodic axis {}: use an even number, for instance a spacing of {:.16g}",
          lattice.ncell[d], axis, length / (lattice.ncell[d] + 1));
  }
  if (options.axisymmetric && (domain->boxlo[0] < 0.0 || domain->periodicity[0]))
    error->all(FLERR,
               "Fix mpm axisymmetric: x is the distance from the axis: the box must not reach "
               "below x = 0 or be periodic along x");
  if (nodes.edges) nodes.edges->check();
}

void MPMField::init(MPMPlan *plan_of_all)
{
  plan = plan_of_all;
  running = motion_is_done = time_limit->watch_volume = keep_old = keep_old_now = false;
  time_limit->bound = true;
  check_box();
  frame->check();
  ledger.on = !modify->get_compute_by_style("^mpm/energy$").empty();
  nodes.clear_fields();
  slopes.clear();
  stretching.clear();
  shares_room = false;
  frame->mean_rate = nullptr;
  jacobians.init();

  find_materials();
  elements = find_fixes<MPMInternalForce>(lmp);
  if (materials.empty()) {
    refuse_other_integrators(lmp, fix);    // a second fix by mistake needs no material
    error->all(FLERR, "Fix mpm found no material: define one with fix mpm/material");
  }

  double density = materials[0]->material->density();
  for (const auto *one : materials) density = std::min(density, one->material->density());
  least_node_mass = std::max(LEAST_MASS, NEGLIGIBLE * density * lattice.cell_volume());

  if (heating) heating->init();

  // the same instruction set for transfers, batches and laws
  static const char *const sets[] = {nullptr, "reference", "baseline", "avx2", "avx512"};
  const char *wanted = sets[options.kernels];
  kernels = MPMKernels::select(wanted);
  batch_kernels = BatchKernels::select(lattice.dim, wanted, options.changes_thickness());
  bool can_run = kernels && batch_kernels;
  for (auto *material : materials)
    can_run = can_run &&
        material->material->configure(wanted, force->mvv2e * force->nktv2p, force->nktv2p);
  if (!can_run)
    error->all(FLERR, "Fix mpm kernels {} cannot run on this CPU or were not compiled",
               wanted ? wanted : "named by the environment variable MPM_ISA");
  if (smoothing) smoothing->init();
  drift->init();
}

void MPMField::find_materials()
{
  materials = find_fixes<FixMPMMaterial>(lmp);
  int nhistory = 1;
  for (const auto *material : materials) nhistory = std::max(nhistory, material->nhistory);
  work.history.resize((std::size_t) nhistory * BATCH);
}

/** Velocities that were mapped back have contact decided by those of the step, and no impulse of
 *  their own: points that moved with them felt wrong forces (step/DECISIONS.md). */
static bool is_in_contact(const MPMField &field)
{
  const auto actions = find_fixes<MPMNodeAction>(field.lmp);
  return std::any_of(actions.begin(), actions.end(), [&](const auto *action) {
    return action->decides_contact(field);
  });
}

/** Long records of nodes keep forces and old velocities apart: the ledger and some node actions
 *  need them, USF and USAVG sum forces alone; the kernel that interpolates the hoop rate, and moves
 *  domains with velocities that were mapped back, knows long records only. */
void MPMField::choose_kernels()
{
  const bool split = ledger.on || keep_old || keep_old_now || options.heat ||
      options.stress_before() || (options.axisymmetric && options.scheme != Options::USL) ||
      (has_domain(options.shape) && options.stress_after());
  kernel = frame->kernels(options.transfer, split);
  if (options.strains_by_gradient()) {
    // to the nodes, TPIC differs in nothing but the stress; back, it has the gradient
    const auto tpic = frame->kernels(TPIC, kernel.nreal == 8);
    kernel.p2g = tpic.p2g;
    kernel.p2g_force = tpic.p2g_force;
    kernel.g2p_gradient = tpic.g2p_gradient;
    kernel.gradient_in_C = false;
  }
  if (options.polypic) affine->modes = kernels->poly(lattice.dim, options.shape, kernel.nreal);
  pic = kernels->transfer(lattice.dim, options.shape, PIC, true);
  mapped = {};
  if (options.moves_mapped() && (has_domain(options.shape) || !is_in_contact(*this))) {
    // what interpolates velocities as they are and has the gradient of the transfer
    const auto affine = options.strains_by_gradient() || options.transfer == TPIC ? TPIC : APIC;
    mapped = is_affine(options.transfer) && !has_domain(options.shape)
        ? kernels->transfer(lattice.dim, options.shape, affine, kernel.nreal == 8)
        : pic;
  }
  batch->h = lattice.h;
}

void MPMField::keep_old_velocities_now(bool yes)
{
  if (keep_old_now == yes) return;
  keep_old_now = yes;
  choose_kernels();
}

void MPMField::count_step()
{
  auto &counts = counts_of_run;
  last_dt = step_dt();
  counts.dt_min = std::min(counts.dt_min, last_dt);
  counts.dt_max = std::max(counts.dt_max, last_dt);
  counts.steps++;
  counts.point_steps += map->npoints();
}

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
  for (const auto *body : elements)
    if (atom->mask[i] & body->group_of_points()) return true;
  return false;
}

FixMPMMaterial *MPMField::material_of(int i) const
{
  for (auto *material : materials)
    if (atom->mask[i] & material->groupbit) return material;
  return nullptr;
}

std::vector<signed char> MPMField::present_materials() const
{
  std::vector<signed char> mine(materials.size(), 0), all(mine.size());
  const auto note = [&](const FixMPMMaterial *material) {
    for (std::size_t k = 0; k < mine.size() && material; k++)
      if (materials[k] == material) mine[k] = 1;
  };
  for (int i = 0; i < atom->nlocal; i++)
    if (is_point(i)) note(material_of(i));
  for (const auto *inlet : modify->get_fix_by_style("^mpm/emit$")) {
    const int groups = 1 | inlet->groupbit;    // of its points
    const auto has = [groups](const FixMPMMaterial *material) {
      return (material->groupbit & groups) != 0;
    };
    const auto its = std::find_if(materials.begin(), materials.end(), has);
    if ((fix.groupbit & groups) && its != materials.end()) note(*its);
  }
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_SIGNED_CHAR, MPI_MAX, world);
  return all;
}

void MPMField::refuse_element_nodes(const Fix &user, const std::string &what,
                                    const std::function<bool(const FixMPMMaterial *)> &wants) const
{
  int mine = -1, any;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i) || !is_element_node(i)) continue;
    const auto *const material = material_of(i);
    for (std::size_t k = 0; k < materials.size(); k++)
      if (materials[k] == material && wants(material)) mine = (int) k;
  }
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (any >= 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: points of fix mpm/material {} are nodes of fix mpm/elements, {}",
               user.style, user.id, materials[any]->id, what);
}

double MPMField::step_dt() const
{
  return every ? every->step_dt() : update->dt;
}

int MPMField::steps_to_next() const
{
  return every ? every->steps_to_next() : 1;
}

void MPMField::outer_force(const double *forces, int i, double *f) const
{
  const bigint row = 3 * (bigint) i;
  std::copy_n(forces + row, 3, f);
  for (const auto *ifix : elements)
    for (int d = 0; d < 3; d++) f[d] -= ifix->forces()[row + d];
}

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
  r.xnew = options.moves_late() ? const_cast<double *>(late_positions.data()) : &atom->x[0][0];
  return r;
}

PointRows MPMField::rows_at_rest(double *values, const double *weights)
{
  // a value of a node that is not finite moves points even in no time, and the next transfer would
  // look for their nodes; they stay where they are until the guard has seen the velocity
  work.places.resize(3 * (std::size_t) atom->nmax);
  PointRows r = rows();
  r.v = values;
  r.mass = weights;
  r.xnew = work.places.data();
  r.from = r.x;
  r.F = nullptr;
  return r;
}

TransferStep MPMField::step_data(double dt) const
{
  TransferStep s;
  s.h = lattice.h;
  s.inv_h = 1.0 / lattice.h;
  for (int d = 0; d < 3; d++) s.origin[d] = lattice.origin[d];
  s.dt = dt;
  s.flip = options.flip;
  s.force_scale = force->ftm2v;
  s.stress_scale = force->ftm2v / force->nktv2p;
  return s;
}

double MPMField::memory_usage() const
{
  double bytes =
      nodes.memory_usage() + map->memory_usage() + frame->memory_usage() + jacobians.memory_usage();
  if (locking) bytes += locking->memory_usage();
  if (smoothing) bytes += smoothing->memory_usage();
  bytes += drift->memory_usage();
  if (heating) bytes += heating->memory_usage();
  if (domains) bytes += domains->memory_usage();
  if (boxes) bytes += boxes->sizes.capacity() * sizeof(double);
  if (every)
    bytes += (every->mean_force.capacity() + every->mean_torque.capacity()) * sizeof(double);
  for (const auto *list :
       {&work.nodes, &work.node_velocities, &work.vectors, &work.weights, &work.places,
        &work.stress, &work.no_volume, &late_positions, &work.history})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

void LAMMPS_NS::refuse_field(LAMMPS *lmp, const Fix &user, const MPMField &field,
                             const OptionRules &rules)
{
  refuse_field(lmp, fmt::format("Fix {} {}", user.style, user.id), field, rules);
}

void LAMMPS_NS::refuse_field(LAMMPS *lmp, const std::string &user, const MPMField &field,
                             const OptionRules &rules)
{
  for (const auto &rule : rules)
    if (rule.broken)
      lmp->error->all(FLERR, Error::NOLASTLINE, "{} cannot be used with {} of fix mpm {}: {}", user,
                      rule.keyword, field.id(), rule.text);
}

// What makes forces of stress where the input leaves it open (keyword stress of fix mpm)

/** Does it, or another lattice of the same body, touch other bodies by a node action? */
bool MPMField::has_contact() const
{
  const auto contacts = find_fixes<MPMNodeAction>(lmp);
  const auto bodies = find_fixes<MPMRefinedBody>(lmp);
  const auto list = MPMField::all(lmp);
  return std::any_of(list.begin(), list.end(), [&](const MPMField *field) {
    const bool mine = field == this || std::any_of(bodies.begin(), bodies.end(), [&](auto *body) {
                        return body->has(id()) && body->has(field->id());
                      });
    return mine && std::any_of(contacts.begin(), contacts.end(), [field](auto *contact) {
             return contact->touches(field->id());
           });
  });
}

/** Fixes can be defined in any order, and come and go between runs: this is found anew for each
 *  run. In the total frame, gradients are better only at curved surfaces with stress from
 *  temperatures, at rest; waves have smaller errors without. Where bodies touch, edges give way
 *  more with gradients, and pressures of pore water scatter more. */
void MPMField::choose_stress(const std::vector<MPMPhysics *> &all)
{
  const bool alone = !has_contact() && find_fixes<MPMPorePressure>(lmp).empty();
  const auto who = std::find_if(all.begin(), all.end(), [&](const auto *physics) {
    return alone && physics->brings_to_rest();
  });
  const auto laws = find_fixes<FixMPMMaterial>(lmp);
  const bool matters = !options.total || std::any_of(laws.begin(), laws.end(), [](const auto *law) {
    return law->material->is_thermoelastic();
  });
  const bool before = options.strains_by_gradient();
  chosen.rests = who != all.end() && matters;
  if (options.strains_by_gradient() == before || comm->me) return;
  if (before) {
    utils::logmesg(lmp, "Fix mpm {}: stress mls again, the default {}\n", id(),
                   alone ? "of steps that do not bring bodies to rest"
                         : "with fix mpm/contact and fix mpm/pore");
    return;
  }
  const auto *const other = dynamic_cast<Fix *>(*who);
  utils::logmesg(lmp, "Fix mpm {}: stress gradient, the default with fix {} {}\n", id(),
                 other->style, other->id);
}

void MPMJacobians::keep(const BatchKernels &kernels, const Batch &batch, int first, int nmax)
{
  if (J.size() < (std::size_t) nmax) J.resize(nmax);
  kernels.jacobians(batch.F, batch.n, J.data() + first);
  known = true;
}

void MPMJacobians::find(const MPMField &field, int first, int n, double *J)
{
  double F[9][BATCH];
  for (int p = 0; p < n; p++)
    for (int c = 0; c < 9; c++) F[c][p] = field.points->F[first + p][c];
  field.batch_kernels->jacobians(F, n, J);
}
