/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The field is the mixture: its velocity U is the flux of volume of fluid and grains together,
   which is what a field of nearly constant volume has without sources,

     div [eps u + (1 - eps) v] = 0,    U - v = eps (u - v)

   for the velocity u of the fluid in the pores, v of the grains, and the porosity eps. So laws of
   drag are written for the superficial slip U - v, with the force K (U - v) that remains when the
   fluid does not accelerate and does not weigh: that of the gradient of pressure along a bed
   included ("model B", Z.Y. Zhou, S.B. Kuang, K.W. Chu, A.B. Yu, J. Fluid Mech. 661 (2010) 482).

   To this comes the force of Archimedes in fluid that accelerates,

     F = K (U - v) + rho V (dU/dt - g).

   dU/dt follows from the internal forces, which nodes know, and from the forces -F of the grains,
   whose share phi of the volume is that of all fluid, since the field has the mass of full space:
   dU/dt = A - phi F/(rho V) with the acceleration A before these, so that

     F = [K (U - v) + rho V (A - g)]/(1 + phi),

   which takes phi as nodes mix the forces. All of these are impulses between a grain and the
   nodes around it, in proportion to N_i m_i: opposite to round-off, and the same change of velocity
   for nodes that are nearly empty.

   In 2d all is per unit of depth, and a grain is a disc of that depth, with the volume pi d^2/4:
   for Archimedes, and for porosity. Its drag per volume is that of spheres of its diameter, so that
   a bed has the pressure drop of one of spheres with its porosity. That is not far from what discs,
   which are cylinders across the flow, have: for square arrays in slow flow (A.S. Sangani, A.
   Acrivos, Int. J. Multiphase Flow 8 (1982) 193) 1.12, 1.00, 1.00, 1.13 of Ergun's law at the
   shares of volume 0.2, 0.3, 0.4, 0.5.
------------------------------------------------------------------------- */

#include "grains/fix_mpm_immersed.h"

#include "atom.h"
#include "base/mpm_gravity.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"
#include "field/mpm_halo.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_point_map.h"
#include "force.h"
#include "math_const.h"
#include "math_extra.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using MathConst::MY_PI;

static constexpr int SPLIT = 8;    // reals of a node: with the old velocity
enum { INNER = 1, OUTER };         // nodes, see has_fluid_around()
// relative difference of gravity that counts as none, and buoyancy over weight that does, as in air
static constexpr double SAME_GRAVITY = 0.01, NO_BUOYANCY = 0.01;

/** fix ID group mpm/immersed FIELD DENSITY VISCOSITY keyword values ... */
Options MPMImmersedOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/immersed");
  o.argument(text(field_id, "fix-ID"));
  o.argument(number(density, "density of the fluid", POSITIVE));
  o.argument(number(viscosity, "viscosity", NOT_NEGATIVE));
  o.add("drag",
        {word(law,
              {{"gidaspow", SphereDrag::GIDASPOW},
               {"difelice", SphereDrag::DIFELICE},
               {"ergun", SphereDrag::ERGUN},
               {"schiller", SphereDrag::SCHILLER},
               {"stokes", SphereDrag::STOKES},
               {"none", SphereDrag::NONE}})},
        "drag law");
  o.add("gravity",
        {numbers(gravity, 3, "gx gy gz", ANY_NUMBER, "velocity/time",
                 "acceleration of gravity for buoyancy, which fluid and grains must get from other "
                 "commands")});
  o.add("displace", {yes_no(displace)},
        "remove the mass and the weight of an incompressible flow where grains are");
  o.refuse([=] {
    return OptionRules{
        {law != SphereDrag::NONE && viscosity == 0.0, "",
         "needs a positive viscosity for its drag: use drag none without"},
        {dim == 2 && gravity[2] != 0.0, "gravity", "must be along x and y in 2d: {gravity}"}};
  });
  return o;
}

FixMPMImmersed::FixMPMImmersed(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  viscosity *= force->ftm2v / force->nktv2p;
  if (!atom->radius_flag || !atom->rmass_flag)
    error->all(FLERR,
               "Fix mpm/immersed needs the radius of grains: use atom_style hybrid sphere mpm");

  scalar_flag = vector_flag = 1;
  size_vector = 6;
  global_freq = 1;
  extscalar = extvector = 1;
  dynamic_group_allow = 1;
  state.declare(later, "mpm/immersed:later", 3);
  keep_arrays(false);
}

/** Stops with an error if the fluid is missing. With a field, that calls init_action(). */
void FixMPMImmersed::init()
{
  field = MPMField::find(lmp, field_id);
  if (field && displace)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/immersed {}: displace yes needs a fluid of fix mpm/incompressible: leave it "
        "out, or use that for the fluid",
        id);
  if (field) return;
  const auto *const driver = modify->get_fix_by_id(field_id);
  const auto *const flow = dynamic_cast<const MPMFluid *>(driver);
  if (!flow)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/immersed {}: there is no fix mpm {}, nor a fix mpm/incompressible: define the "
        "fluid before the run by one of these",
        id, field_id);
  flow->check_density(density, fmt::format("Fix mpm/immersed {}", id));
  check_grains(driver, flow->spacing());
}

/** What runs on this field and these grains. */
void FixMPMImmersed::init_action()
{
  FixMPMImmersed::init();
  if (!field) return;
  refuse_field(lmp, *this, *field,
               {{field->options.total, "frame total",
                 "its nodes are not where the grains are: use frame updated"},
                {field->options.axisymmetric, "axisymmetric",
                 "a grain would be a ring: use a sector in 3d, or 2d"},
                {field->options.modified_edges, "edges modified", "use edges plain"},
                {field->options.series == MPMFieldOptions::FMPM, "transfer fmpm", "use xpic"}});

  field->keep_old_velocities();    // for the acceleration of the fluid
  check_grains(modify->get_fix_by_style("^mpm$")[0], field->lattice.h);
}

/** driver: the fix that moves the fluid; h: its node spacing. */
void FixMPMImmersed::check_grains(const Fix *driver, double h)
{
  const auto count_all = [&](const auto &counts) {
    bigint mine = 0, all;
    for (int i = 0; i < atom->nlocal; i++) mine += counts(i);
    MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    return all;
  };

  // Who moves the grains, and which of the two half steps with forces are still to come? Where both
  // are, grains get their impulses in two halves, as they do their forces

  movers.clear();
  const bool halves = !field || field->options.every == 1;
  const int place = modify->find_fix(driver->id);
  for (int k = 0; k < modify->nfix; k++) {
    const Fix *ifix = modify->fix[k];
    if (utils::strmatch(ifix->style, "^rigid")) {
      const bigint n = count_all([&](int i) {
        return is_grain(i) && (atom->mask[i] & ifix->groupbit);
      });
      if (n)
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/immersed {}: {} grains of fix {} ({}) have no velocity of their own: use "
            "single spheres",
            id, n, ifix->id, ifix->style);
    }
    if (!ifix->time_integrate || utils::strmatch(ifix->style, "^mpm")) continue;
    movers.push_back(
        {ifix->groupbit, halves || k < place ? 1.0 : 0.5, halves && k > place ? 0.5 : 1.0});
    const bool late = k < place && count_all([&](int i) {
                                     return is_grain(i) && (atom->mask[i] & ifix->groupbit);
                                   }) > 0;
    if (late && comm->me == 0 && !told_of_order)
      error->warning(
          FLERR,
          "Fix mpm/immersed {}: fix {} moves grains before fix {} acts on them, so that "
          "their velocities in output differ from their displacement per step by half of "
          "what forces give to them in a step: define fix {} after fix {}",
          id, ifix->id, driver->id, ifix->id, driver->id);
    told_of_order = told_of_order || late;
  }

  const bigint points = count_all([&](int i) {
    return (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0;
  });
  if (points)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/immersed {}: {} atoms of its group are material points: use a group of grains", id,
        points);
  for (const auto *other : modify->get_fix_by_style("^mpm/immersed$")) {
    if (other == this || dynamic_cast<const FixMPMImmersed *>(other)->field_id != field_id)
      continue;
    const bigint twice = count_all([&](int i) {
      return is_grain(i) && (atom->mask[i] & other->groupbit);
    });
    if (twice)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/immersed {} and {} have {} grains and the field in common: drag and "
                 "buoyancy would be counted twice",
                 id, other->id, twice);
  }
  const bigint large = count_all([&](int i) {
    return is_grain(i) && 2.0 * atom->radius[i] > 2.0 * h;
  });
  if (large && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/immersed {}: {} grains are larger than two node spacings: for "
                   "them, contact through a pair style resolves the flow",
                   id, large);
}

/** Grains that fix gravity pulls down need the same gravity for their buoyancy, which is easily
 *  forgotten. One that varies cannot be that of the keyword, which is constant. */
void FixMPMImmersed::setup(int)
{
  if (told_of_weight) return;
  std::vector<std::pair<int, const double *>> pulls;    // groups, and their force per mass
  for (auto *other : modify->get_fix_by_style("^gravity")) {
    int width;
    if (MPMGravity::varies(other)) return;
    pulls.emplace_back(other->groupbit, (const double *) other->extract("gvec", width));
  }
  struct {
    double off;
    int rank;
  } mine = {0.0, comm->me}, worst;
  double weight[3] = {0.0, 0.0, 0.0};    // of the grain of which it is most different
  for (int i = 0; i < atom->nlocal; i++) {
    const int mask = atom->mask[i];
    if (!is_grain(i) || !(density * volume(i) > NO_BUOYANCY * atom->rmass[i]) ||
        std::none_of(movers.begin(), movers.end(), [&](const Mover &mover) {
          return mask & mover.groupbit;
        }))
      continue;
    double here[3] = {0.0, 0.0, 0.0}, off = 0.0, most = 0.0;
    for (const auto &[group, vector] : pulls)
      for (int d = 0; d < 3 && (mask & group); d++) here[d] += vector[d] * force->ftm2v;
    for (int d = 0; d < domain->dimension; d++) {
      off = std::max(off, fabs(here[d] - gravity[d]));
      most = std::max(most, fabs(here[d]));
    }
    if (most == 0.0 || off <= SAME_GRAVITY * most || off <= mine.off) continue;
    mine.off = off;
    std::copy_n(here, 3, weight);
  }
  MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, world);
  if (worst.off == 0.0) return;
  told_of_weight = true;
  MPI_Bcast(weight, 3, MPI_DOUBLE, worst.rank, world);
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/immersed {}: fix gravity gives grains the acceleration {:.6g} {:.6g} "
        "{:.6g}, but their buoyancy is that of keyword gravity, {:.6g} {:.6g} {:.6g}: give "
        "it the same",
        id, weight[0], weight[1], weight[2], gravity[0], gravity[1], gravity[2]);
}

bool FixMPMImmersed::is_grain(int i) const
{
  return (atom->mask[i] & groupbit) && atom->radius[i] > 0.0 && atom->vfrac[i] == 0.0;
}

double FixMPMImmersed::volume(int i) const
{
  const double r = atom->radius[i];
  return domain->dimension == 3 ? 4.0 / 3.0 * MY_PI * r * r * r : MY_PI * r * r;
}

/** Blocks around the grains of this rank, and when they need others. */
void FixMPMImmersed::couple_topology()
{
  if (!field) return;
  immersed.clear();
  for (int i = 0; i < atom->nlocal; i++)
    if (is_grain(i)) immersed.push_back(i);
  int missing = 0, any;
  MPMStencil stencil(*field);
  if (field->map->valid)
    missing = std::any_of(immersed.begin(), immersed.end(), [&](int i) {
      return !stencil.reaches_blocks(atom->x[i]);
    });
  MPI_Allreduce(&missing, &any, 1, MPI_INT, MPI_MAX, world);
  if (any) field->map->valid = false;
}

void FixMPMImmersed::extend_topology(MPMField &extended)
{
  if (&extended != field) return;
  auto &grid = field->grid;
  for (const int i : immersed) {
    for (int d = 0; d < field->lattice.dim; d++)
      if (!(fabs((atom->x[i][d] - grid.lattice.origin[d]) / grid.lattice.h) < 4.0e6))
        error->one(FLERR, Error::NOLASTLINE,
                   "Fix mpm/immersed {}: grain {} is far out of reach of the lattice", id,
                   atom->tag[i]);
    // one more node on each side: grains move
    blocks_around(*field, atom->x[i], 0.0, 1, [&](const int *b) {
      grid.activate(b);
    });
  }
}

void FixMPMImmersed::topology_changed(MPMField &changed)
{
  if (&changed == field) canonical = field->grid.canonical();
}

/** Share of space that grains take up around one of them, of the volume V = own, from the mapped
 *  share and its first moment sum N r. Both mappings smooth it over a width s, s^2 = (p+1)/6 h^2
 *  for splines of degree p, so that at a distance x inside of the end of a bed is left the part A =
 *  Phi(x/s), the normal distribution. Its logarithmic slope tells where that is: q = s |grad A|/A =
 *  Phi'/Phi falls from 0.8 at the end to none inside, and A = 1 - 0.64 q^1.12 within 0.01. What the
 *  slope would be by chance, for grains at random places, int |grad K|^2 V/phi with the kernel K of
 *  the width s, is no end: the integral is (n/2)/(s^2 (4 pi s^2)^(n/2)) in n dimensions. */
double FixMPMImmersed::end_of_bed(double solid, const double *moment, double own, int order,
                                  double cell) const
{
  if (!(solid > 0.0)) return solid;
  const double p1 = order + 1.0, width = sqrt(p1 / 6.0), n = domain->dimension;
  const double slope = width * 12.0 / p1 / solid;    // sum N r^2 = (p+1)/12, of moment
  const double spread = 4.0 * MY_PI * width * width;
  const double chance = 0.5 * n / (n == 3.0 ? spread * sqrt(spread) : spread) * own / cell;
  const double q2 = slope * slope * MathExtra::lensq3(moment) - chance / solid;
  if (!(q2 > 0.0)) return solid;
  return solid / (1.0 - 0.64 * pow(std::min(q2, 2.0 / MY_PI), 0.56));
}

/** Drag on a sphere / superficial slip, by the share of space that grains take up. For a single
 *  sphere, L. Schiller, A. Naumann, Z. Ver. Dtsch. Ing. 77 (1935) 318; for a bed, S. Ergun, Chem.
 *  Eng. Prog. 48 (1952) 89; Ergun below the porosity 0.8 and C.Y. Wen, Y.H. Yu, Chem. Eng. Prog.
 *  Symp. Ser. 62 (1966) 100 above: D. Gidaspow, Multiphase Flow and Fluidization (1994); R. Di
 *  Felice, Int. J. Multiphase Flow 20 (1994) 153. Those that exclude the gradient of pressure along
 *  the bed are divided by the porosity. */
double FixMPMImmersed::porosity(double solid) const
{
  // densest packing of equal spheres, of equal discs
  const double least = domain->dimension == 3 ? 0.26 : 1.0 - MY_PI / sqrt(12.0);
  return std::max(least, 1.0 - solid);
}

/** Drag / slip at the slip which is left at the end of the step: w = slip/(1 + slowing K(w)). Laws
 *  are between K = a and K = b w: a line through two of their values, exact for that of Ergun. */
double FixMPMImmersed::drag_after_step(double diameter, double slip, double solid,
                                       double slowing) const
{
  // a disc of unit depth has the drag of a sphere times its volume over that of the sphere
  const double share = domain->dimension == 2 ? 1.5 / diameter : 1.0;
  const SphereDrag drag = {law, density, viscosity};
  const double eps = porosity(solid), hindered = drag.hindrance(eps);
  const double most = share * drag.on_sphere(diameter, slip, eps, hindered);
  if (!(slowing * most > 0.0)) return most;
  const double low = slip / (1.0 + slowing * most),
               least = share * drag.on_sphere(diameter, low, eps, hindered);
  const double rise = slip > low ? (most - least) / (slip - low) : 0.0;
  const double linear = 1.0 + slowing * (least - rise * low);
  const double w = 2.0 * slip / (linear + sqrt(linear * linear + 4.0 * slowing * rise * slip));
  return least + rise * (w - low);
}

/** Is there fluid on all sides of a node? If not, a wall may hold it, or the node next to it
 *  together with its image. Walls act later, and what the momentum equation gives such nodes now is
 *  the unbalanced pressure on the wall. */
bool FixMPMImmersed::has_fluid_around(int64_t node) const
{
  const auto &grid = field->grid;
  const double *const records = field->grid.nodes();
  const double least = 0.6 * density * field->lattice.cell_volume();
  const auto full = [&](int64_t n) {
    return records[SPLIT * n + 3] > least;
  };
  const auto &block = grid.blocks[node / NODES_PER_BLOCK];
  int index[3];
  grid.node_index(block, (int) (node % NODES_PER_BLOCK), index);
  bool all = full(node);
  for (int k = 0; k < 2 * field->lattice.dim && all; k++) {
    int next[3] = {index[0], index[1], index[2]};
    int &moved = next[k / 2];
    moved += 2 * (k % 2) - 1;
    const int beyond = moved;
    moved = field->lattice.wrap(k / 2, beyond);
    const int64_t neighbor = moved == beyond ? grid.locate_near(block, next) : grid.locate(next);
    all = neighbor >= 0 && full(neighbor);
  }
  return all;
}

/** f(node, weight, numbers along the axes) for the nodes around a grain. */
template <class F> void FixMPMImmersed::around(const Grain &g, const F &f) const
{
  const auto loop = [&](const int *count) {
    const int64_t *node = &nodes[g.first];
    for (int k0 = 0; k0 < count[0]; k0++)
      for (int k1 = 0; k1 < count[1]; k1++) {
        const double w01 = g.w[0][k0] * g.w[1][k1];
        for (int k2 = 0; k2 < count[2]; k2++) f(*node++, w01 * g.w[2][k2], k0, k1, k2);
      }
  };
  static constexpr int QUADRATIC[3] = {3, 3, 3};
  if (std::equal(count_along, count_along + 3, QUADRATIC))
    loop(QUADRATIC);    // the compiler knows these
  else
    loop(count_along);
}

/** Grains with fluid around them, and the volume of these at the nodes. In half a cell above the
 *  surface, buoyancy and drag fall to zero. */
void FixMPMImmersed::find_grains(double dt)
{
  grains.clear();
  nodes.clear();
  inner.assign(field->grid.nnodes(), 0);
  sums.resize(NREAL * field->grid.nnodes());
  used.assign(field->grid.blocks.size(), 0);
  slots.clear();
  if (comm->nprocs > 1)    // whole blocks are summed over ranks
    for (int slot = 0; slot < (int) used.size(); slot++) use(slot);
  MPMStencil stencil(*field);
  MPMStencil::Axes axes;
  for (const int i : immersed) {
    stencil.find_axes(atom->x[i], axes);
    std::copy_n(axes.count, 3, count_along);
    const std::size_t first = nodes.size();
    nodes.resize(first + axes.count[0] * axes.count[1] * axes.count[2]);
    int64_t *node = &nodes[first];
    for (int k0 = 0; k0 < axes.count[0]; k0++)
      for (int k1 = 0; k1 < axes.count[1]; k1++)
        for (int k2 = 0; k2 < axes.count[2]; k2++) {
          const int64_t n = canonical[axes.number(k0, k1, k2)];
          if (!inner[n]) {
            inner[n] = has_fluid_around(n) ? INNER : OUTER;
            use((int) (n / NODES_PER_BLOCK));
          }
          *node++ = n;
        }
    grains.emplace_back();
    Grain &g = grains.back();
    g.i = i;
    g.first = first;
    memcpy(g.w, axes.w, sizeof(g.w));
    for (int d = 0; d < 3; d++) g.r[d] = axes.r[d][0];
    if (!find_fluid(g)) {
      nodes.resize(first);
      grains.pop_back();
      continue;
    }
    move_by_forces(g, dt);
    const double share = volume(i) / field->lattice.cell_volume();
    double *const sum = sums.data() + SOLID;
    around(g, [&](int64_t n, double w, int, int, int) {
      sum[NREAL * n] += w * share;
    });
  }
}

/** Sums of a block begin with zero. */
void FixMPMImmersed::use(int slot)
{
  if (used[slot]) return;
  used[slot] = 1;
  slots.push_back(slot);
  std::fill_n(&sums[(std::size_t) NREAL * NODES_PER_BLOCK * slot], NREAL * NODES_PER_BLOCK, 0.0);
}

template <class F> void FixMPMImmersed::each_used_node(const F &f) const
{
  for (const int slot : slots)
    for (int n = 0; n < NODES_PER_BLOCK; n++) f((int64_t) slot * NODES_PER_BLOCK + n);
}

/** The velocity of the fluid is that after the momentum equation at inner nodes, elsewhere the old
 *  one with the mean gain. */
bool FixMPMImmersed::find_fluid(Grain &g)
{
  const double full = density * field->lattice.cell_volume();
  const double *const records = field->grid.nodes();
  const char *const is_inner = inner.data();
  double inside = 0.0, outside = 0.0, gain[4] = {}, fluid[4] = {};    // a fourth entry is faster
  around(g, [&](int64_t node, double w, int, int, int) {
    const double *const record = records + SPLIT * node;    // vx vy vz m, old velocity
    const double m = w * record[3];
    const bool in = is_inner[node] == INNER;
    const double m_in = in ? m : 0.0;
    const double *const v = in ? record : record + 4;
    inside += m_in;
    outside += m - m_in;
    for (int k = 0; k < 4; k++) gain[k] += m_in * (record[k] - record[4 + k]);
    for (int k = 0; k < 4; k++) fluid[k] += m * v[k];
  });
  g.around = inside + outside;
  if (!(g.around > 1.0e-10 * full)) return false;
  g.part = inside > 0.0 ? 0.0 : 1.0;    // without an acceleration its term is left out
  for (int d = 0; d < 3; d++) {
    g.gain[d] = inside > 0.0 ? gain[d] / inside : 0.0;
    g.fluid[d] = (fluid[d] + outside * g.gain[d]) / g.around;
  }
  g.immersed = std::min(1.0, 2.0 * g.around / full);
  return true;
}

double FixMPMImmersed::steps_ahead(int i, double &mass) const
{
  mass = HUGE_VAL;
  double ahead = 0.0;
  for (const auto &mover : movers)
    if (atom->mask[i] & mover.groupbit) {
      mass = atom->rmass[i];
      ahead = mover.ahead;
    }
  return ahead;
}

/** A grain under a constant force then has the velocity of its displacement per step. With the
 *  whole impulse before it moves, its velocity at the end of a step would be off by half of what
 *  forces give to it in a step. */
void FixMPMImmersed::push(int i, double mass, const double *impulse)
{
  double at_once = 1.0;
  for (const auto &mover : movers)
    if (atom->mask[i] & mover.groupbit) at_once = mover.at_once;
  for (int d = 0; d < 3; d++) {
    const double change = impulse[d] / mass;
    atom->v[i][d] += at_once * change;
    later[i][d] = (1.0 - at_once) * change;
  }
}

void FixMPMImmersed::final_integrate()
{
  for (int i = 0; i < atom->nlocal; i++)
    for (int d = 0; d < 3 && atom->vfrac[i] == 0.0; d++) {
      atom->v[i][d] += later[i][d];
      later[i][d] = 0.0;
    }
}

void FixMPMImmersed::was_pushed(int n, const double *impulses, double dt)
{
  count = n;
  std::copy_n(impulses, 6, force_now);
  dt_last = dt;
}

void FixMPMImmersed::move_by_forces(Grain &g, double dt) const
{
  const int i = g.i;
  double ahead = steps_ahead(i, g.mass);
  if (std::isfinite(g.mass))
    ahead += 0.5 * (field->options.every - 1);    // in the mean over the steps to come
  for (int d = 0; d < 3; d++) {
    g.buoyancy[d] = g.immersed * density * volume(i) * (g.gain[d] - dt * gravity[d]);
    g.velocity[d] = atom->v[i][d];
    if (std::isfinite(g.mass))
      g.velocity[d] += ahead * update->dt * force->ftm2v * atom->f[i][d] / g.mass;
  }
}

/** The coefficient is that of the slip which is left at the end of the step. */
void FixMPMImmersed::buoyancy_and_coefficient(Grain &g, double dt)
{
  const double *const sum = sums.data();
  double solid = 0.0, moment[3] = {0.0, 0.0, 0.0}, slip[3];
  around(g, [&](int64_t node, double w, int k0, int k1, int k2) {
    const double share = w * sum[NREAL * node + SOLID];
    solid += share;
    moment[0] += share * k0;
    moment[1] += share * k1;
    moment[2] += share * k2;
  });
  for (int d = 0; d < 3; d++) moment[d] = solid * g.r[d] - moment[d];
  if (g.part != 1.0) g.part = 1.0 / (1.0 + solid);
  const double of_fluid =
      solid / (density * volume(g.i));    // all grains around are taken for equal
  for (int d = 0; d < 3; d++) {
    g.buoyancy[d] *= g.part;
    g.velocity[d] += g.buoyancy[d] / g.mass;
    slip[d] = g.fluid[d] - (g.velocity[d] + of_fluid * g.buoyancy[d]);
  }
  const double part = g.part * g.immersed;
  g.coefficient = part *
      drag_after_step(2.0 * atom->radius[g.i], MathExtra::len3(slip),
                      end_of_bed(solid, moment, volume(g.i), stencil_order(field->options.shape),
                                 field->lattice.cell_volume()),
                      dt * part * (1.0 / g.mass + of_fluid));

  const double push[4] = {-g.buoyancy[0] / g.around, -g.buoyancy[1] / g.around,
                          -g.buoyancy[2] / g.around, g.coefficient / g.around};
  add_to_nodes(g, BUOYANCY, push);
}

/** Weights times four values. */
void FixMPMImmersed::add_to_nodes(const Grain &g, int lane, const double *values)
{
  double *const sum = sums.data() + lane;
  const double add[4] = {values[0], values[1], values[2], values[3]};
  around(g, [&](int64_t node, double w, int, int, int) {
    for (int k = 0; k < 4; k++) sum[NREAL * node + k] += w * add[k];
  });
}

/** The drag itself, with what the coefficients of all grains at the same nodes are now known to
 *  be. */
void FixMPMImmersed::drag(Grain &g, double dt)
{
  double near[4] = {0.0, 0.0, 0.0, 0.0};    // of the velocity of the fluid, and rate of its slip
  const double *const sum = sums.data();
  around(g, [&](int64_t node, double w, int, int, int) {
    for (int k = 0; k < 4; k++) near[k] += w * sum[NREAL * node + k];
  });
  const double slowing = g.coefficient / g.mass + near[3] / g.around;    // rate of the slip
  const double factor = dt * g.coefficient / (1.0 + dt * slowing);
  double on_fluid[4] = {}, impulse[3];
  for (int d = 0; d < 3; d++) {
    const double drag = factor * (g.fluid[d] - g.velocity[d] + near[d] / g.around);
    impulse[d] = drag + g.buoyancy[d];
    force_now[d] += drag / g.part;
    force_now[3 + d] += drag + g.buoyancy[d] - drag / g.part;
    on_fluid[d] = -drag / g.around;
  }
  push(g.i, g.mass, impulse);
  add_to_nodes(g, DRAG, on_fluid);
}

/** No sum is at an image. */
void FixMPMImmersed::sum_nodes(int lane, int nlane)
{
  field->nodes.halo->sum(sums.data(), NREAL, lane, nlane);
}

/** Impulses of this step. That of drag acts on the slip which it leaves: with one grain, by the
 *  implicit Euler method; when grains share nodes, the sum of all coefficients at these is what
 *  their fluid is taken to be slowed down with. That is at least what it is, so that the slip of no
 *  grain changes its sign, however stiff; and it is exact when the motion is steady. The
 *  coefficient is that of the slip which is left, too. Forces of the grain count up to the time
 *  when it moves, so that a grain sinks with its terminal velocity for any time step. */
void FixMPMImmersed::act(double dt, Stage stage)
{
  if (stage != STEP || !field) return;
  auto &grid = field->grid;
  find_grains(dt);
  sum_nodes(SOLID, 1);
  for (Grain &g : grains) buoyancy_and_coefficient(g, dt);
  sum_nodes(BUOYANCY, 4);
  const double *const records = grid.nodes();
  each_used_node([&](int64_t node) {
    for (int k = 0; k < 4; k++) sums[NREAL * node + k] *= records[SPLIT * node + 3];
  });
  std::fill(force_now, force_now + 6, 0.0);
  for (Grain &g : grains) drag(g, dt);
  sum_nodes(DRAG, 3);

  each_used_node([&](int64_t node) {
    const double *sum = &sums[NREAL * node];
    double *record = grid.record(node);
    double push[3];
    for (int d = 0; d < 3; d++) push[d] = sum[BUOYANCY + d] + record[3] * sum[DRAG + d];
    if (push[0] != 0.0 || push[1] != 0.0 || push[2] != 0.0)
      field->ledger.drag_node(record, grid.owns(node), push);
  });
  count = (int) grains.size();
  dt_last = dt;
}

/** Number of grains with fluid around them; drag (1 to 3) and buoyancy (4 to 6) on all of them. */
double FixMPMImmersed::compute_scalar()
{
  bigint mine = count, all;
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  return (double) all;
}

double FixMPMImmersed::compute_vector(int i)
{
  double all;
  MPI_Allreduce(&force_now[i], &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return dt_last > 0.0 ? all / (dt_last * force->ftm2v) : 0.0;
}

double FixMPMImmersed::memory_usage()
{
  return FixMPMState::memory_usage() +
      (double) (inner.capacity() + sums.capacity() * sizeof(double) +
                grains.capacity() * sizeof(Grain) + used.capacity() +
                (immersed.capacity() + slots.capacity()) * sizeof(int) +
                (nodes.capacity() + canonical.capacity()) * sizeof(int64_t));
}

/** Grains in a fluid are the only ones that meet something, unless there are other bodies. */
bool FixMPMImmersed::keeps_group(int number) const
{
  return igroup == number && modify->get_fix_by_style("^mpm/surface$").empty() &&
      MPMField::all(lmp).size() == 1;
}
