/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The material in the inlet is rigid: its nodes, and those upstream of it and around it that its
   points reach, have the velocity of the flow. Points there neither strain nor slow down, whatever
   the pressure behind the inlet is, so that layers keep their distance up to the end of the inlet.
   Were they free, a pressure at the inlet would slow them down, and new layers would come on top of
   those.
------------------------------------------------------------------------- */

#include "loads/fix_mpm_emit.h"

#include "base/mpm_options.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_physics.h"
#include "field/mpm_strain.h"
#include "loads/mpm_inlet.h"
#include "material/material.h"
#include "math/matrix.h"
#include "transfer/shape.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "modify.h"
#include "region.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;
using namespace MPM_NS;

static constexpr double SAME_DIRECTION =
    1.0e-6;    // part of a velocity across the flow that is round-off
static constexpr int MOST_PPC = 1000;

/** fix ID group mpm/emit TYPE region REG velocity VX VY VZ keyword value ... */
Options MPMEmitOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/emit");
  o.add("region",
        {text(region_id, "region-ID", "region of the inlet, through which material flows in")})
      .once()
      .standard("none, must be given");
  o.add("velocity",
        {variables(velocity, 3, "vx vy vz", "velocity",
                   "velocity of the inflowing material, can be variables")})
      .then([this] {
        has_velocity = true;
      })
      .once()
      .standard("none, must be given");
  o.add("normal",
        {numbers(normal, 3, "nx ny nz", ANY_NUMBER, "",
                 "vector of any length in the direction of the flow")})
      .standard("direction of the velocity at the start");
  o.add("ppc",
        {integer(ppc, "N", {1, MOST_PPC, true},
                 "number of points along each edge of a cell of fix mpm")});
  o.add("spacing",
        {number(spacing, "D", POSITIVE, "distance", "distance between points, instead of ppc")})
      .standard("by ppc");
  o.add("area",
        {number(area, "A", POSITIVE, "distance^2 (2d: distance)",
                "area of the cross section of the inlet, if it is known; around an axis of "
                "symmetry, area of the annulus")})
      .standard("found from the region");
  o.add("temperature",
        {number(temperature, "T", ANY_NUMBER, "temperature", "temperature of the new points")})
      .then([this] {
        has_temperature = true;
      })
      .standard("temperature of the material");
  o.add("move",
        {variables(move, 3, "wx wy wz", "velocity",
                   "velocity of the inlet, can be variables; the velocity of the material is "
                   "relative to it")})
      .once()
      .standard("0 0 0");
  o.refuse([=] {
    const bool across = velocity[2].value != 0.0 || !velocity[2].variable.empty() ||
        move[2].value != 0.0 || !move[2].variable.empty() || normal[2] != 0.0;
    return OptionRules{
        {region_id.empty(), "", "needs an inlet: use the keyword region"},
        {!has_velocity, "", "needs the velocity of the flow: use the keyword velocity"},
        {spacing > 0.0 && ppc != 2, "spacing",
         "and ppc cannot be given together: use either of them"},
        {dim == 2 && across, "", "must have no velocity and no normal along z in 2d"}};
  });
  return o;
}

FixMPMEmit::FixMPMEmit(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  require_arguments(lmp, "fix mpm/emit", narg, 3, {"TYPE"});
  if (!atom->style_match("mpm"))
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/emit needs atom_style mpm, alone or in atom_style hybrid, but the atom style "
        "is {}",
        atom->atom_style);
  if (!domain->box_exist)
    error->all(FLERR, "Fix mpm/emit needs the simulation box: define it with create_box before");
  if (domain->triclinic) error->all(FLERR, "Fix mpm/emit needs an orthogonal simulation box");
  if (!atom->tag_enable)
    error->all(FLERR, "Fix mpm/emit gives points IDs: remove atom_modify id no");
  type = utils::expand_type_int(FLERR, arg[3], Atom::ATOM, lmp);
  if (type < 1 || type > atom->ntypes)
    error->all(FLERR, 3, "Invalid atom type {} in fix mpm/emit, the box has {} type{}", arg[3],
               atom->ntypes, atom->ntypes > 1 ? "s" : "");
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 4);
  if (options.given("normal") && dot(normal, normal) == 0.0)
    error->all(FLERR, options.where("normal"), "Fix mpm/emit normal has the length zero");

  force_reneighbor = 1;
  next_reneighbor = -1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = 13;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
}

FixMPMEmit::~FixMPMEmit() = default;

bool FixMPMEmit::moves() const
{
  return std::any_of(move, move + 3, [](const NumberOrVariable &v) {
    return !v.variable.empty() || v.value != 0.0;
  });
}

bool FixMPMEmit::emits_into(const MPMField &one) const
{
  return (one.fix.groupbit & (1 | groupbit)) != 0;
}

double FixMPMEmit::spacing_of_nodes() const
{
  return fluid ? fluid->spacing() : field->lattice.h;
}

double FixMPMEmit::largest_spacing(const MPMField &of) const
{
  return (spacing > 0.0 ? spacing : of.lattice.h / ppc) * (area > 0.0 ? 1.3 : 1.0 + 1.0e-9);
}

void FixMPMEmit::velocity_now(double *v)
{
  update_motion();
  std::copy_n(flow, 3, v);
}

/** The only field and the only material that new points will have: they are in group all and that
 *  of this fix. */
void FixMPMEmit::find_field()
{
  const auto only = [&](const char *style) {
    Fix *found = nullptr;
    for (auto *ifix : modify->get_fix_by_style(style)) {
      if (!(ifix->groupbit & (1 | groupbit))) continue;
      if (found)
        error->all(FLERR, Error::NOLASTLINE,
                   "Points of fix mpm/emit {} in group {} would belong to fix {} and fix {}: give "
                   "these disjoint groups",
                   id, group->names[igroup], found->id, ifix->id);
      found = ifix;
    }
    return found;
  };
  field = nullptr;
  material = nullptr;
  fluid = dynamic_cast<const MPMFluid *>(only("^mpm/incompressible$"));
  if (fluid) return;
  Fix *const grid = only("^mpm$");
  if (!grid)
    error->all(FLERR, Error::NOLASTLINE,
               "Points of fix mpm/emit {} would belong to no fix mpm or mpm/incompressible: give "
               "it and one of "
               "these the same group, or group all",
               id);
  field = MPMField::find(lmp, grid->id);
  material = dynamic_cast<FixMPMMaterial *>(only("^mpm/material$"));
  if (!material)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Points of fix mpm/emit {} would have no material: give it and a fix mpm/material the "
        "same group, or group all",
        id);
}

void FixMPMEmit::refuse_combinations() const
{
  if (fluid) {
    const char *const wrong = moves() ? "move" : has_temperature ? "temperature" : nullptr;
    if (wrong)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/emit {}: {} cannot be used with fix {} (style {}): remove it", id, wrong,
                 dynamic_cast<const Fix *>(fluid)->id, dynamic_cast<const Fix *>(fluid)->style);
    return;
  }
  const auto &options = field->options;
  refuse_field(
      lmp, *this, *field,
      {{options.total, "frame total",
        "new points would have no place in the reference configuration: use frame updated"},
       {options.every > 1, "every",
        "points would come in between two steps of the cycle: use every 1"}});
  static const std::pair<const char *, const char *> others[] = {
      {"mpm/pore", "new points would have no water in their pores"},
      {"mpm/mixture", "one of the two phases would come alone"},
      {"mpm/handshake", "its weights are those of the points at the start"},
      {"mpm/implicit", "its solver does not know the nodes of the inlet"},
      {"mpm/relax", "a flow does not come to rest"}};
  for (const auto &[style, why] : others)
    for (const auto *other : modify->get_fix_list())
      if (strcmp(other->style, style) == 0)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/emit {} cannot be used with fix {} (style {}): {}", id, other->id,
                   style, why);
  for (const auto *other : modify->get_fix_by_style("^mpm/elements$"))
    if (other->groupbit & (1 | groupbit))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/emit {} cannot bring points into the group of fix {} (style {}), whose "
                 "points are nodes of a mesh: give them disjoint groups",
                 id, other->id, other->style);
  if (has_temperature && !material->material->conducts())
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/emit {} temperature needs a material that conducts heat (thermal conducting): "
        "others have the temperature of their definition",
        id);
}

void FixMPMEmit::init()
{
  find_field();
  refuse_combinations();
  region = domain->get_region_by_id(region_id);
  if (!region)
    error->all(FLERR, Error::NOLASTLINE, "Region {} for fix mpm/emit {} does not exist", region_id,
               id);
  region->init();
  if (region->dynamic_check())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/emit {} region {} must not move by itself: use the keyword move", id,
               region_id);
  region->prematch();
  for (auto &v : velocity) find_variable(lmp, v, "fix mpm/emit velocity");
  for (auto &v : move) find_variable(lmp, v, "fix mpm/emit move");
  motion_step = -1;
}

/** Fields are known here, which they need not be in init(). At the very start the inlet is
 *  filled. */
void FixMPMEmit::setup_pre_exchange()
{
  if (!update->setupflag) return;    // write_data asks without a run
  make_inlet();
  note_ids();
  if (past.started != 0.0) return;
  past.started = 1.0;
  tagint mine = 0, there;
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->vfrac[i] > 0.0 && region->match(atom->x[i][0], atom->x[i][1], atom->x[i][2]))
      mine = std::max(mine, atom->tag[i]);
  MPI_Allreduce(&mine, &there, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (there)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/emit {}: point {} is in the inlet at the start, which this fix fills: leave "
        "region {} out when points are made",
        id, there, region_id);
  past.travel = inlet->length;
  emit();
}

void FixMPMEmit::make_inlet()
{
  evaluate_velocities();
  if (dot(past.direction, past.direction) == 0.0)
    std::copy_n(dot(normal, normal) > 0.0 ? normal : flow, 3, past.direction);
  if (dot(past.direction, past.direction) == 0.0)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/emit {}: the velocity is zero at the start, and does not tell where the flow "
        "goes: use the keyword normal",
        id);
  const double h = spacing_of_nodes();
  layer = spacing > 0.0 ? spacing : h / ppc;
  inlet =
      std::make_unique<MPMInlet>(lmp, fmt::format("Fix mpm/emit {}", id), region, past.direction,
                                 layer, area, field && field->options.axisymmetric);
  std::copy_n(inlet->normal, 3, past.direction);
  section = 0.0;
  for (const auto &column : inlet->columns)
    section += column.area * (field ? field->frame->circle(column.x[0]) : 1.0);
  const Fix &grid = fluid ? dynamic_cast<const Fix &>(*fluid) : field->fix;
  if (inlet->length < h)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/emit {}: the inlet is {:.6g} long along the flow, less than a cell of fix "
               "{} {} ({:.6g}): make region {} longer",
               id, inlet->length, grid.style, grid.id, h, region_id);
  if (layer > h * (1.0 + 1.0e-9) && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/emit {}: points are {:.6g} apart, more than the cells of fix {} {} "
                   "({:.6g}): there will be cells without points",
                   id, layer, grid.style, grid.id, h);
  if (field && !moves()) list_nodes();    // of blocks that other fixes have found before
}

/** Velocities of now: of the flow relative to the inlet, and of the inlet. */
void FixMPMEmit::evaluate_velocities()
{
  const auto varies = [](const NumberOrVariable &v) {
    return !v.variable.empty();
  };
  const bool any = std::any_of(velocity, velocity + 3, varies) ||
      std::any_of(move, move + 3, varies);
  evaluate_in_step(lmp, any, [this] {
    for (int d = 0; d < 3; d++) {
      flow[d] = evaluate(lmp, velocity[d]);
      drift[d] = evaluate(lmp, move[d]);
    }
  });
  std::copy_n(flow, 3, at_end);
}

void FixMPMEmit::update_motion()
{
  if (motion_step == update->ntimestep) return;
  motion_step = update->ntimestep;
  const double before[3] = {at_end[0], at_end[1], at_end[2]};
  evaluate_velocities();
  if (fluid && fluid->is_leapfrog())
    for (int d = 0; d < 3; d++) flow[d] = 0.5 * (before[d] + at_end[d]);
  const double *const n = inlet->normal;
  speed = dot(flow, n);
  double across = 0.0;
  for (int d = 0; d < 3; d++) across += (flow[d] - speed * n[d]) * (flow[d] - speed * n[d]);
  const double size = std::sqrt(dot(flow, flow));
  if (std::sqrt(across) > SAME_DIRECTION * size || speed < -SAME_DIRECTION * size)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/emit {}: the velocity {:.6g} {:.6g} {:.6g} at step {} is not along the "
               "direction {:.6g} {:.6g} {:.6g} of the flow, which it must keep: use the keyword "
               "normal, another fix mpm/emit, or fix mpm/absorb for what flows back",
               id, flow[0], flow[1], flow[2], update->ntimestep, n[0], n[1], n[2]);
}

/** Nodes of the inlet. Upstream and around it as far as its points reach, so that these have its
 *  velocity alone. */
static double reach_in_cells(Shape shape)
{
  switch (shape) {
    case LINEAR:
      return 1.0;
    case QUADRATIC:
    case GIMP:
      return 1.5;
    default:
      return 2.0;
  }
}

void FixMPMEmit::topology_changed(MPMField &one)
{
  // other fixes may look at nodes before this one has its inlet, at the start of the first run
  if (&one == field && inlet && !moves()) list_nodes();
}

void FixMPMEmit::list_nodes()
{
  nodes.clear();
  const Grid &grid = field->grid;
  const double h = field->lattice.h, reach = reach_in_cells(field->options.shape) * h;
  const double size = 0.5 * (grid.side - 1) * h * std::sqrt((double) field->lattice.dim);
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
    const int64_t first = (int64_t) slot * NODES_PER_BLOCK;
    double low[3], high[3], r[3];
    grid.node_position(first, low);
    grid.node_position(first + NODES_PER_BLOCK - 1, high);
    for (int d = 0; d < 3; d++)
      r[d] = 0.5 * (low[d] + high[d]) - past.shift[d] - inlet->middle()[d];
    if (field->lattice.dim == 2) r[2] = 0.0;
    // reach along all axes, which is more than that along one
    if (!inlet->is_near(r, size + 2.0 * reach)) continue;
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (grid.blocks[slot].alias >> n & 1) continue;
      double x[3];
      grid.node_position(first + n, x);
      for (int d = 0; d < 3; d++) x[d] -= past.shift[d];
      if (inlet->holds(x, reach)) nodes.push_back(first + n);
    }
  }
}

/** Work is impulse times the velocity with which points are moved, less half of what this has
 *  changed by since the last step, as that of walls: see MPMWallMotion::half_change() */
void FixMPMEmit::act(double dt, Stage stage)
{
  if (!field) return;
  update_motion();
  if (moves()) list_nodes();
  const bool counts = stage == STEP;
  const int dim = field->lattice.dim;
  Grid &grid = field->grid;
  MPMLedger &ledger = field->ledger;
  double V[3], faster[3], worked = 0.0, collided = 0.0;
  for (int d = 0; d < 3; d++) {
    V[d] = flow[d] + drift[d];
    faster[d] = past.acted != 0.0 ? 0.5 * (V[d] - past.velocity[d]) : 0.0;
  }
  if (counts) {
    std::copy_n(V, 3, past.velocity);
    past.acted = 1.0;
    std::fill_n(impulse, 3, 0.0);
    dt_last = dt;
  }
  for (const int64_t node : nodes) {
    double *const record = grid.record(node);
    if (!(record[3] > 0.0)) continue;
    if (counts && grid.owns(node)) {
      double change[3] = {0.0, 0.0, 0.0}, moved = 0.0, gained = 0.0;
      for (int d = 0; d < dim; d++) {
        change[d] = V[d] - record[d];
        impulse[d] += record[3] * change[d];
        moved += change[d] * (V[d] - faster[d]);
        if (ledger.on) gained += 0.5 * change[d] * (V[d] + record[4 + d]);
      }
      if (ledger.on) ledger.note_push(record, change);
      worked += record[3] * moved;
      collided += record[3] * (gained - moved);
    }
    std::copy_n(V, dim, record);
  }
  if (!counts) return;
  worked *= force->mvv2e;
  past.work += worked;
  ledger.boundary += worked;
  ledger.driven += worked;
  if (ledger.on) ledger.transfer += collided * force->mvv2e;
}

/** The step has ended: how far has the flow come? New layers are made with the exchange of this
 *  step. */
bigint FixMPMEmit::layers_now() const
{
  return (bigint) std::floor(past.travel / layer + 0.5);
}

void FixMPMEmit::post_integrate()
{
  update_motion();
  past.travel += speed * update->dt;
  for (int d = 0; d < 3; d++) past.shift[d] += drift[d] * update->dt;
  if (layers_now() > (bigint) past.layers) next_reneighbor = update->ntimestep;
}

void FixMPMEmit::pre_exchange()
{
  if (next_reneighbor == update->ntimestep) emit();
}

/** No point has the ID of one that was removed, as files of several steps and what looks for a
 *  point by its ID would take the two for one. Where LAMMPS has no other IDs left, those of now
 *  count alone. */
void FixMPMEmit::note_ids()
{
  past.newest = std::max(past.newest, (double) largest_id());
}

tagint FixMPMEmit::largest_id() const
{
  tagint mine = 0, largest;
  for (int i = 0; i < atom->nlocal; i++) mine = std::max(mine, atom->tag[i]);
  MPI_Allreduce(&mine, &largest, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  return largest;
}

tagint FixMPMEmit::last_id(bigint npoint) const
{
  const tagint largest = largest_id();
  bigint last = largest;
  for (const auto *other : find_fixes<FixMPMEmit>(lmp))
    last = std::max(last, (bigint) other->past.newest);
  if (last + npoint < MAXTAGINT) return (tagint) last;
  if ((bigint) largest + npoint >= MAXTAGINT)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/emit {}: IDs of new points exceed the maximum allowed ID {}: use reset_atoms id "
        "between two runs, or LAMMPS with 64-bit IDs (BIGBIG)",
        id, MAXTAGINT);
  return largest;
}

void FixMPMEmit::emit()
{
  const auto first = (bigint) past.layers, last = layers_now();
  const bigint ncolumn = (bigint) inlet->columns.size(), npoint = ncolumn * (last - first);
  if (npoint <= 0) return;

  tagint tag = last_id(npoint);
  begin_traffic(lmp);
  const int nlocal = atom->nlocal;
  double v[3];
  for (int d = 0; d < 3; d++) v[d] = flow[d] + drift[d];
  if (comm->nprocs > 1) comm->coord2proc_setup();
  for (bigint k = first; k < last; k++)
    for (const auto &column : inlet->columns) {
      const double along = past.travel - ((double) k + 0.5) * layer;
      double x[3];
      for (int d = 0; d < 3; d++) x[d] = column.x[d] + past.shift[d] + along * inlet->normal[d];
      make_point(x, v, column.area * layer, ++tag);
    }
  past.layers = (double) last;
  for (auto *other : find_fixes<FixMPMEmit>(lmp)) other->past.newest = (double) tag;

  const bool runs = field && field->is_running();
  if (runs) give_initial_stress(*field, nlocal);
  MPMTraffic here, all;
  for (int i = nlocal; i < atom->nlocal; i++) {
    const MPMTraffic one = traffic_of(lmp, runs ? field : nullptr, i);
    here.add(one);
    if (runs) field->ledger.remove(-one.kinetic, -one.stored);
  }
  MPI_Allreduce(here.reals(), all.reals(), MPMTraffic::NREAL, MPI_DOUBLE, MPI_SUM, world);
  if (all.points != (double) npoint)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/emit {}: {} of {} new points are outside of the box at step {}: enlarge it, or "
        "stop the inlet before it gets there",
        id, npoint - (bigint) all.points, npoint, update->ntimestep);
  past.total.add(all);
  if (field) field->guard->brought += all.points;
  atom->natoms += npoint;
  if (atom->natoms < 0 || atom->natoms >= MAXBIGINT)
    error->all(FLERR, Error::NOLASTLINE, "Too many total atoms");
  end_traffic(lmp);
}

/** On the rank that owns the place. */
void FixMPMEmit::make_point(const double *where, const double *v, double volume, tagint tag)
{
  double x[3] = {where[0], where[1], domain->dimension == 2 ? 0.0 : where[2]};
  imageint image = ((imageint) IMGMAX << IMG2BITS) | ((imageint) IMGMAX << IMGBITS) | IMGMAX;
  domain->remap(x, image);
  for (int d = 0; d < 3; d++)
    if (x[d] < domain->boxlo[d] || x[d] >= domain->boxhi[d]) return;
  int unused[3];
  if (comm->nprocs > 1 && comm->coord2proc(x, unused[0], unused[1], unused[2]) != comm->me) return;

  atom->avec->create_atom(type, x);
  const int i = atom->nlocal - 1;
  atom->tag[i] = tag;
  atom->mask[i] = 1 | groupbit;
  atom->image[i] = image;
  std::copy_n(v, 3, atom->v[i]);
  atom->vfrac[i] = volume * (field ? field->frame->circle(x[0]) : 1.0);
  modify->create_attribute(i);
  if (has_temperature) give_temperature(i);
  atom->rmass[i] =
      (fluid ? fluid->density_of_groups(atom->mask[i]) : material->density(i)) * atom->vfrac[i];
  if (atom->radius_flag)
    atom->radius[i] = 0.5 * (domain->dimension == 3 ? std::cbrt(volume) : std::sqrt(volume));
}

/** As if heat were conducted to the point. Where that melts it, or its specific heat depends on the
 *  temperature, the heat is found step by step. */
void FixMPMEmit::give_temperature(int i)
{
  double *const row = material->history[i];
  const int column = material->temperature(), molten = material->molten();
  const Conduction c = material->material->conduction(row);
  if (!c.by_enthalpy) {
    row[column] = temperature;
    if (molten >= 0) row[molten] = temperature > c.melting.temperature ? 1.0 : 0.0;
    return;
  }
  constexpr int MOST = 10000;
  const double close = 1.0e-12 * std::max(std::fabs(temperature), std::fabs(row[column]));
  for (int pass = 0; pass < MOST && std::fabs(temperature - row[column]) > close; pass++)
    material->material->warm(
        row, material->material->conduction(row).capacity * (temperature - row[column]));
}

void FixMPMEmit::write_restart(FILE *fp)
{
  keep_totals(world, &past.work, 1);
  std::vector<double> list = {past.travel, past.layers, past.started, past.work, past.newest};
  list.insert(list.end(), past.shift, past.shift + 3);
  list.insert(list.end(), past.direction, past.direction + 3);
  list.push_back(past.acted);
  list.insert(list.end(), past.velocity, past.velocity + 3);
  list.insert(list.end(), past.total.reals(), past.total.reals() + MPMTraffic::NREAL);
  if (comm->me) return;
  write_state(fp, list.data(), list.size() * sizeof(double));
}

void FixMPMEmit::restart(char *buf)
{
  double list[NREAL];
  memcpy(list, read_state(lmp, id, buf, sizeof(list)), sizeof(list));
  past.travel = list[0];
  past.layers = list[1];
  past.started = list[2];
  past.work = comm->me == 0 ? list[3] : 0.0;
  past.newest = list[4];
  std::copy_n(list + 5, 3, past.shift);
  std::copy_n(list + 8, 3, past.direction);
  past.acted = list[11];
  std::copy_n(list + 12, 3, past.velocity);
  std::copy_n(list + 15, MPMTraffic::NREAL, past.total.reals());
}

double FixMPMEmit::compute_vector(int k)
{
  const auto &total = past.total;
  if (k == 0) return total.points;
  if (k == 1) return total.mass;
  if (k < 5) return total.momentum[k - 2];
  if (k == 5) return total.kinetic;
  if (k == 6) return total.stored;
  if (k == 7) return speed;
  if (k == 8)
    return speed * section *
        (fluid ? fluid->density_of_groups(1 | groupbit) : material->material->density());
  const double mine = k == 12 ? past.work
      : dt_last > 0.0         ? impulse[k - 9] / (dt_last * force->ftm2v)
                              : 0.0;
  double all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMEmit::memory_usage()
{
  return nodes.capacity() * sizeof(int64_t) +
      (inlet ? inlet->columns.capacity() * sizeof(MPMInlet::Column) : 0.0);
}
