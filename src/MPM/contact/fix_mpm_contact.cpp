/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Each body has its own velocity field. Where two of them have mass at a node, their velocities
   after the momentum equation show whether they approach each other along the normal of the
   interface. If so, equal and opposite impulses remove the approach, and in the plane of the
   interface as much of the sliding as the law of friction allows:

     n from a to b,  m = m_a m_b/(m_a + m_b),  u = v_a - v_b
     J_n = max(0, m u.n),   J_t = m (u - (u.n) n) scaled down to at most mu J_n

   (S.G. Bardenhagen, J.U. Brackbill, D. Sulsky, Comput. Methods Appl. Mech. Eng. 187 (2000) 529;
   with a normal that both bodies share: J.A. Nairn, CMES 92 (2013) 271.) Momentum is conserved to
   round-off as impulses come in pairs. With more than two bodies at a node all pairs are treated
   alike: projected Jacobi iterations on the impulses of all pairs, so that the order in which the
   bodies are named has no influence.

   Normals. The sum over the points of a body at the node, sum_p V_p grad N, points out of it and
   its length is the area of the interface that belongs to the node. The normal of two bodies is the
   difference of their gradients, either as they are (the body with more volume, or mass, at the node has
   more weight) or after each was made a unit vector (colinear).

   Gap. Shape functions reach one or two cells beyond a body, so that bodies would feel each other
   at that distance, and the mass that a wall sends beyond the end of a block that slides on it
   would stand in its way. The volumes of all bodies at a node, as a share of the volume that belongs
   to a node, add up to one where they touch, whatever the position of the interface relative to the
   nodes, and to less while there is a gap or beyond the end of one of them. The part of this volume that is
   outside of fixed faces of the box does not count (Room).

   Water in pores bears a part of J_n, dt int N p n over the surface of a body, as on walls (mpm_wall_contact.cpp). The rest
   is between grains and gives friction: J_t <= mu (J_n - J_w). Where J_n would be below J_w, grains part, and the water alone
   pushes. For two bodies with water, which do not exchange any, the mean counts.
------------------------------------------------------------------------- */

#include "contact/fix_mpm_contact.h"

#include "atom.h"
#include "base/mpm_image.h"
#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "domain.h"
#include "elements/fix_mpm_elements.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_node_sums.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_map.h"
#include "field/mpm_refined_body.h"
#include "field/mpm_stencil.h"
#include "force.h"
#include "math_extra.h"
#include "modify.h"
#include "update.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int MAX_ITERATIONS = 200;      // of impulses of pairs that depend on each other
static constexpr double CONVERGED = 1.0e-12;    // change of the impulses, relative to them
static constexpr double ROUNDED = 1.0e-2;       // or to this part of the momentum, if that is more
static constexpr double UNSOLVED = 1.0e-6;      // the same at the end: too much to be silent
static constexpr int LOOK_EVERY = 50;    // steps after which ranks compare what they have seen

// sum of shares of volume from which on bodies overlap, by half a cell to a cell, depending on their position in
// the cell; points at the ends of regions that are no multiple of their spacing reach 1.37. Second: the least share
// of each body there

static constexpr double OVERLAP = 1.4, OVERLAP_EACH = 0.25;

// bodies that are placed next to each other fill the nodes between them up to round-off, which must not
// decide whether they touch

static constexpr double ROUNDING = 1.0e-8;

// the same for points as boxes, which do not fill space exactly where they are strained

static constexpr double BOX_ROUNDING = 1.0e-3;

// with pore water, each node between bodies bears a part of its force. Bodies then touch at sums of shares down to this far
// below one; from NEARLY on, a warning counts the force at nodes where they do not touch

static constexpr double SLACK = 0.02, NEARLY = 0.8;

// the approach of bodies that slide along each other is round-off, which must not decide whether
// they stick: it must be at least this part of their speeds

static constexpr double APPROACH = 1.0e-12;

/* ----------------------------------------------------------------------
   fix ID all mpm/contact FIELD FIELD ...  law ... normal ... gap ...
------------------------------------------------------------------------- */

Options MPMContactOptions::declare()
{
  using namespace option;
  Options o("fix mpm/contact");
  o.add("law",
        {word(law,
              {{"frictionless", FRICTIONLESS, "bodies slide freely"},
               {"coulomb",
                COULOMB,
                "bodies slide with friction",
                {number(kinetic_friction, "mu", NOT_NEGATIVE, "1", "coefficient of friction"),
                 optional(number(static_friction, "mu_s", NOT_NEGATIVE, "1",
                                 "coefficient of static friction, not below mu; default: mu"))}},
               {"stick", STICK, "bodies do not slide while they press on each other"},
               {"adhesive",
                ADHESIVE,
                "bodies that touch resist separation and sliding",
                {number(normal_strength, "sn", NOT_NEGATIVE, "pressure", "normal strength"),
                 number(shear_strength, "ss", NOT_NEGATIVE, "pressure", "shear strength"),
                 number(release_work, "work", NOT_NEGATIVE, "pressure*distance",
                        "work to separate the bodies, per area"),
                 optional(number(kinetic_friction, "mu", NOT_NEGATIVE, "1",
                                 "coefficient of additional friction; default: 0"))}}})})
      .standard("frictionless");
  o.add(
      "normal",
      {word(normal_by,
            {{"colinear", COLINEAR}, {"volume", VOLUME}, {"mass", MASS}, {"logistic", LOGISTIC}})},
      "how the normal of the interface is computed from the bodies");
  o.add("gap",
        {word(gap,
              {{"no", false, "bodies are in contact as soon as they have nodes in common"},
               {"yes",
                true,
                "bodies are in contact when they touch",
                {optional(number(full, "share", {0.5, 1.0, true}, "",
                                 "share of the volume of a node that bodies fill when they touch; "
                                 "default: 1"))}}})});
  heat.declare(
      o,
      "the energy lost by friction becomes heat, which two bodies share in the ratio of their "
      "effusivities :math:`\\sqrt{k \\rho c}`",
      "share of this energy for the body that is named first; the other body gets the rest");
  o.refuse([=] {
    const bool slides = law == ADHESIVE || (law == COULOMB && kinetic_friction > 0.0);
    return OptionRules{
        {heat.heats() && !slides, "heat",
         "is that of friction: use law coulomb or adhesive, or drop the keyword"},
        {law == COULOMB && static_friction >= 0.0 && static_friction < kinetic_friction, "law",
         "coulomb: the coefficient of static friction must not be below that of friction: {law}"},
        {law == ADHESIVE && (normal_strength == 0.0 || release_work == 0.0), "law",
         "adhesive needs a positive normal strength and work of release: use frictionless or "
         "coulomb for bodies that do not adhere"},
        {law == ADHESIVE && !gap, "law",
         "adhesive must know how far bodies are apart: drop gap no"},
        {law == ADHESIVE && normal_by == MASS, "law",
         "adhesive needs the area of the interface: use normal volume or colinear"}};
  });
  return o;
}

FixMPMContact::FixMPMContact(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/contact acts on nodes, which have no group: use group all; the bodies are "
               "the fields that are named");

  Options options = declare();
  int iarg = 3;
  while (iarg < narg && !options.has(arg[iarg])) {
    if (std::count(names.begin(), names.end(), arg[iarg]))
      error->all(FLERR, iarg, "Fix mpm/contact field {} is named twice", arg[iarg]);
    names.emplace_back(arg[iarg++]);
  }
  if (names.size() < 2)
    error->all(FLERR, MIN(3, narg - 1),
               "Fix mpm/contact needs the IDs of two or more fix mpm, one for each body");
  if (names.size() > MAX_FIELDS)
    error->all(FLERR, 3 + MAX_FIELDS, "Fix mpm/contact takes at most {} bodies: use several",
               MAX_FIELDS);

  read_options(lmp, options, narg, arg, iarg);
  if (static_friction < 0.0 || law == ADHESIVE) static_friction = kinetic_friction;

  if (heat.heats()) heating = std::make_unique<MPMFrictionHeat>(lmp, heat);

  scalar_flag = array_flag = 1;
  size_array_rows = (int) (names.size() * (names.size() - 1) / 2);
  size_array_cols = 5;
  global_freq = 1;
  extscalar = extarray = 1;
  restart_global = 1;
}

/* ---------------------------------------------------------------------- */

void FixMPMContact::init()
{
  bodies.clear();
  for (const auto &name : names) {
    auto *field = MPMField::find(lmp, name);
    if (!field)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {}: {} is not the ID of a fix mpm: define one fix mpm for each "
                 "body",
                 id, name);
    bodies.emplace_back();
    bodies.back().field = field;
  }
  const MPMField &first = *bodies[0].field;
  on_several_lattices = false;
  for (auto &body : bodies) {
    check_refined(body);
    const MPMField *field = body.field;
    const auto &lattice = field->lattice;
    if (lattice.h != first.lattice.h || field->options.shape != first.options.shape ||
        !std::equal(lattice.origin, lattice.origin + 3, first.lattice.origin))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {}: fields {} and {} must have the same lattice (node spacing "
                 "and origin) and shape function; bodies on different lattices meet through a pair "
                 "style",
                 id, first.id(), field->id());
    refuse_field(lmp, *this, *field,
                 {{field->options.total, "frame total",
                   "its nodes are not where the body is: let bodies meet through a pair style"},
                  {field->options.stress_before(), "scheme usf and usavg",
                   "these need the contact before it is known: use usl or musl"}});
  }
  for (auto *other : modify->get_fix_by_style("^mpm/contact$")) {
    if (other == this) continue;
    int shared = 0;
    for (const auto &name : names) {
      const auto &theirs = dynamic_cast<FixMPMContact *>(other)->names;
      shared += std::count(theirs.begin(), theirs.end(), name);
    }
    if (shared > 1)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {} and {} have two bodies in common: contact between them would "
                 "be counted twice",
                 id, other->id);
  }
  if (law == ADHESIVE && 2.0 * release_work / normal_strength > first.lattice.h)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/contact {}: adhesion ends at a gap of 2 * work / strength = {}, which is "
               "more than the node spacing {}: raise the strength or the node spacing",
               id, 2.0 * release_work / normal_strength, first.lattice.h);

  if (tries) refuse_trials();

  room.find(first, *domain);
  lists_valid = false;
  look = true;
  steps = 0;
  unsolved.begin();
  told_of_water = told_of_torn = false;
  std::fill_n(water_sums, 2, 0.0);
}

/* ----------------------------------------------------------------------
   The nodes of a field that is a part of a body also carry the momentum of the points of finer fields (fix_mpm_refine.cpp)
------------------------------------------------------------------------- */

void FixMPMContact::check_refined(Body &body)
{
  body.refined = nullptr;
  const std::string name = body.field->id();
  for (auto *fix : find_fixes<MPMRefinedBody>(lmp))
    if (fix->has(name)) body.refined = fix;
  if (!body.refined) return;
  body.finer = body.refined->finer_than(name);
  if (body.finer.empty()) return;
  on_several_lattices = true;
  refuse_field(
      lmp, *this, *body.field,
      {{law == ADHESIVE, "fix mpm/refine",
        "adhesion needs the area of the interface, which nodes share with those of finer "
        "lattices: use another law"},
       {normal_by == LOGISTIC, "fix mpm/refine",
        "normal logistic does not see the points of finer lattices: use colinear or volume"}});
}

/** Called by fix mpm, whose init() may come before this one; a missing field is found here. */
void FixMPMContact::init_action()
{
  tries = !modify->get_fix_by_style("^mpm/implicit$").empty();
  if (!heating) return;
  FixMPMContact::init();
  std::vector<MPMField *> fields;
  for (const auto &body : bodies) fields.push_back(body.field);
  heating->begin_run(*this, fields);
  const auto musl = std::find_if(fields.begin(), fields.end(), [](const MPMField *field) {
    return field->options.scheme == MPMFieldOptions::MUSL;
  });
  if (musl != fields.end() && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {} heat: with scheme musl of fix mpm {}, contact takes energy "
                   "from the motion that does not become heat, up to 38 % in one case: use scheme "
                   "usl, or look at the entries contact and transfer of compute mpm/energy",
                   id, (*musl)->id());
}

/* ---------------------------------------------------------------------- */

bool FixMPMContact::couples(const std::string &a, const std::string &b) const
{
  return a != b && std::count(names.begin(), names.end(), a) &&
      std::count(names.begin(), names.end(), b);
}

bool FixMPMContact::touches(const std::string &name) const
{
  return std::count(names.begin(), names.end(), name) > 0;
}

bool FixMPMContact::has_law_of(const FixMPMContact &other) const
{
  return law == other.law && normal_by == other.normal_by && gap == other.gap &&
      full == other.full && kinetic_friction == other.kinetic_friction &&
      static_friction == other.static_friction && normal_strength == other.normal_strength &&
      shear_strength == other.shear_strength && release_work == other.release_work;
}

bool FixMPMContact::decides_contact(const MPMField &field) const
{
  return touches(field.id());
}

int FixMPMContact::pair_index(int a, int b, int n)
{
  return a * n - a * (a + 1) / 2 + b - a - 1;
}

/* ---------------------------------------------------------------------- */

template <class F>
void FixMPMContact::Room::images(const Grid &grid, const int *block, const F &f) const
{
  for (int d = 0; d < grid.lattice.dim; d++)
    for (const auto &near : sides[d]) {
      if (!near.mirror) continue;
      const int first = std::max(block[d] * grid.side, near.plane - REACH);
      const int last = std::min(block[d] * grid.side + grid.side - 1, near.plane + REACH);
      if (first > last) continue;
      for (const int node : {first, last}) {
        int image[3] = {block[0], block[1], block[2]};
        image[d] = (2 * near.plane - node) >> grid.shift_bits;
        f(image);
      }
    }
}

/* ----------------------------------------------------------------------
   each field has blocks that others need: all are renewed together
------------------------------------------------------------------------- */

bool FixMPMContact::stale() const
{
  return std::any_of(bodies.begin(), bodies.end(), [](const Body &body) {
    return !body.field->map->valid;
  });
}

void FixMPMContact::couple_topology()
{
  if (stale())
    for (const auto &body : bodies) body.field->map->valid = false;
}

/* ----------------------------------------------------------------------
   blocks in reach of each body, and the range of these over all ranks
------------------------------------------------------------------------- */

/** The boxes of points, see map_boxes(), reach farther than these blocks. */
static void activate_around(Grid &grid)
{
  const std::size_t known = grid.blocks.size();
  for (std::size_t slot = 0; slot < known; slot++) {
    if (!grid.blocks[slot].reached) continue;
    int b[3], low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (int d = 0; d < grid.lattice.dim; d++) {
      low[d] = grid.blocks[slot].b[d] - 1;
      high[d] = low[d] + 2;
    }
    for (b[0] = low[0]; b[0] <= high[0]; b[0]++)
      for (b[1] = low[1]; b[1] <= high[1]; b[1]++)
        for (b[2] = low[2]; b[2] <= high[2]; b[2]++) grid.activate(b);
  }
}

void FixMPMContact::blocks_found()
{
  if (!stale()) return;
  lists_valid = false;

  for (auto &body : bodies) {
    if (body.refined) body.refined->extend_for_finer(*body.field);
    if (on_several_lattices || tries) activate_around(body.field->grid);
    body.reach.find(body.field->grid, world);
  }
}

/* ----------------------------------------------------------------------
   where bodies may meet, a rank must know the mass of all bodies at the nodes of any of them
------------------------------------------------------------------------- */

void FixMPMContact::extend_topology(MPMField &field)
{
  for (const auto &body : bodies) {
    if (body.field != &field) continue;
    for (const auto &other : bodies)
      if (&other != &body) body.reach.activate_those_of(other.reach, field.grid);

    // and also their mirror images at fixed faces. Blocks that are added are visited, too, which gives images
    // of images

    for (std::size_t ib = 0; ib < field.grid.blocks.size(); ib++) {
      int b[3];
      std::copy_n(field.grid.blocks[ib].b, 3, b);
      room.images(field.grid, b, [&](const int *image) {
        field.grid.activate(image);
      });
    }
  }
}

/* ---------------------------------------------------------------------- */

void FixMPMContact::list_common_blocks()
{
  common.clear();
  const int n = (int) bodies.size();
  for (int k = 0; k < n; k++) {
    const Grid &grid = bodies[k].field->grid;
    bodies[k].images.clear();
    for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
      if (grid.blocks[slot].alias) bodies[k].images.push_back((int) slot);
    for (const auto &block : grid.blocks) {
      Common c = {{}, ~block.alias, block.owned};
      for (int j = 0; j < n; j++) c.slot[j] = bodies[j].field->grid.find(block.b);
      const auto has = [](int slot) {
        return slot >= 0;
      };
      const bool listed = std::any_of(c.slot, c.slot + k, has);
      if (!listed && std::any_of(c.slot + k + 1, c.slot + n, has)) common.push_back(c);
    }
  }

  // the action of walls on the nodes, after contact

  for (auto &body : bodies) {
    body.held.assign(body.field->grid.nnodes(), 0);
    for (auto *fix : modify->get_fix_by_style("^mpm/boundary$"))
      dynamic_cast<FixMPMBoundary *>(fix)->mark_prescribed(*body.field, body.held);
  }
  int any = !common.empty(), all;
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  may_touch = all;
  lists_valid = true;
}

/* ----------------------------------------------------------------------
   marks a block whose nodes are needed, and those that hold periodic images of its nodes
------------------------------------------------------------------------- */

void FixMPMContact::Body::mark_near(int slot)
{
  near[slot] = 1;
  const Grid &grid = field->grid;
  const int *const b = grid.blocks[slot].b;
  for (const int image : images)
    for (int corner = 0; corner < 8 && !near[image]; corner++) {
      const auto canonical = canonical_block(grid, grid.blocks[image], corner);
      near[image] = std::equal(canonical.begin(), canonical.end(), b);
    }
}

/* ----------------------------------------------------------------------
   gradients and volumes of the bodies at the nodes; returns false if no node has two bodies
------------------------------------------------------------------------- */

bool FixMPMContact::map_bodies()
{
  for (auto &body : bodies) body.near.assign(body.field->grid.blocks.size(), tries);
  int any = 0, all;
  double *record[MAX_FIELDS];
  for (const auto &c : common) {
    bool meet = false;
    for (int n = 0; n < NODES_PER_BLOCK && !meet; n++)
      meet = (c.canonical >> n & 1) && records(c, n, record) > 1;
    if (!meet) continue;
    any = 1;
    for (std::size_t k = 0; k < bodies.size(); k++)
      if (c.slot[k] >= 0) bodies[k].mark_near(c.slot[k]);
  }
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  if (!all) return false;

  for (auto &body : bodies) {
    const Grid &grid = body.field->grid;
    for (bool more = true; more;) {    // at edges of the box, images of images, too
      more = false;
      for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
        if (body.near[slot])
          room.images(grid, grid.blocks[slot].b, [&](const int *image) {
            const int found = grid.find(image);
            if (found < 0 || body.near[found]) return;
            body.mark_near(found);
            more = true;
          });
    }
    foresee_walls(body);
    map_content(body);
    body.water.clear();
    if (pore_pressure(*body.field)) pore_surface_force(*body.field, body.near, body.water);
  }
  return true;
}

/* ----------------------------------------------------------------------
   Gradient and share of a body at the nodes. On several lattices, everything that the function of a node reaches decides what
   touches, including points of finer lattices; the momentum of the node has only points without a free node between. Sums
   of a part of a function over small points differ from those over large ones, but with points as boxes they are the same
------------------------------------------------------------------------- */

void FixMPMContact::map_content(Body &body)
{
  const Weight weight = normal_by == MASS ? Weight::MASS : Weight::VOLUME;
  if (on_several_lattices) {
    std::vector<MPMField *> all = body.finer;
    all.push_back(body.field);
    map_boxes(*body.field, all, weight, body.near, body.gradient, body.share);
    return;
  }
  map_gradient(*body.field, weight, body.near, body.gradient);
  if (gap || look || tries) map_volume(*body.field, body.near, body.share);
}

/** Finds the records of the bodies at node n of a block; null: no mass there. Returns how many bodies have mass. */
int FixMPMContact::records(const Common &c, int n, double *record[MAX_FIELDS])
{
  int massive = 0;
  for (std::size_t k = 0; k < bodies.size(); k++) {
    record[k] = c.slot[k] < 0 ? nullptr : bodies[k].field->grid.record(c.slot[k], n);
    if (record[k] && !(record[k][3] > 0.0)) record[k] = nullptr;
    massive += record[k] != nullptr;
  }
  return massive;
}

/* ----------------------------------------------------------------------
   first step of a run: warns of bodies that share space. Contact removes their approach, but does not part
   them. Names the node with the largest overlap, and the nearest point of each of the two bodies.
------------------------------------------------------------------------- */

void FixMPMContact::warn_overlap()
{
  struct {
    double value;
    int rank;
  } mine = {0.0, comm->me}, worst;
  double place[5] = {0.0};    // position of the node, and two bodies
  for (const auto &c : common)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(c.canonical >> n & 1)) continue;
      double sum = 0.0;
      struct {
        double share;
        int body;
      } most = {0.0, -1}, next = most;
      for (int k = 0; k < (int) bodies.size(); k++) {
        if (c.slot[k] < 0) continue;
        const double s = bodies[k].share[(int64_t) c.slot[k] * NODES_PER_BLOCK + n];
        sum += s;
        if (s > most.share) {
          next = most;
          most = {s, k};
        } else if (s > next.share)
          next = {s, k};
      }
      if (next.share < OVERLAP_EACH || sum < OVERLAP || sum <= mine.value) continue;
      mine.value = sum;
      const int64_t node = (int64_t) c.slot[most.body] * NODES_PER_BLOCK + n;
      bodies[most.body].field->grid.node_position(node, place);
      place[3] = most.body;
      place[4] = next.body;
    }
  MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, world);
  if (worst.value == 0.0) return;
  MPI_Bcast(place, 5, MPI_DOUBLE, worst.rank, world);

  tagint tags[2];
  const char *ids[2];
  for (int b = 0; b < 2; b++) {
    const MPMField &field = *bodies[(int) place[3 + b]].field;
    ids[b] = field.id();
    mine.value = 1.0e300;
    tags[b] = 0;
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field.is_point(i)) continue;
      double r[3] = {0.0, 0.0, 0.0};
      for (int k = 0; k < field.lattice.dim; k++) r[k] = atom->x[i][k] - place[k];
      nearest_image(*domain, r);
      const double rsq = MathExtra::lensq3(r);
      if (rsq >= mine.value) continue;
      mine.value = rsq;
      tags[b] = atom->tag[i];
    }
    MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE_INT, MPI_MINLOC, world);
    MPI_Bcast(&tags[b], 1, MPI_LMP_TAGINT, worst.rank, world);
  }
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {}: bodies {} and {} overlap at the start of the run, for "
                   "instance points {} and {} near {:.6g} {:.6g} {:.6g}: contact keeps bodies from "
                   "approaching each other, but does not part them",
                   id, ids[0], ids[1], tags[0], tags[1], place[0], place[1], place[2]);
}

/* ----------------------------------------------------------------------
   first step of a run: warns of bodies that consist of surfaces or lines of fix mpm/elements
------------------------------------------------------------------------- */

void FixMPMContact::warn_thin()
{
  std::vector<const Fix *> meshes;
  for (Fix *ifix : modify->get_fix_list()) {
    const auto *mesh = dynamic_cast<FixMPMElements *>(ifix);
    if (mesh && mesh->is_thin()) meshes.push_back(ifix);
  }
  if (meshes.empty()) return;
  std::vector<bigint> mine(2 * bodies.size(), 0),
      all(mine.size());    // points of such meshes, others
  for (int i = 0; i < atom->nlocal; i++)
    for (std::size_t k = 0; k < bodies.size(); k++) {
      if (!bodies[k].field->is_point(i)) continue;
      const bool is_thin = std::any_of(meshes.begin(), meshes.end(), [&](const Fix *mesh) {
        return atom->mask[i] & mesh->groupbit;
      });
      mine[2 * k + (is_thin ? 0 : 1)]++;
    }
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_LMP_BIGINT, MPI_SUM, world);
  std::vector<int> thin, others;
  for (int k = 0; k < (int) bodies.size(); k++)
    if (all[2 * k + 1] > 0)
      others.push_back(k);
    else if (all[2 * k] > 0)
      thin.push_back(k);
  if (!thin.empty() && !others.empty()) warn_of_thin_body(thin[0], others[0]);
  if (thin.size() > 1) warn_of_thin_pair(thin);
}

/* ----------------------------------------------------------------------
   A thin body fills no volume, so that the nodes between it and another one are not full. And it has gradients on both of
   its sides: on the side away from the other body, its normal is the wrong one, and contact with the
   mean of both normals pulls the other body through. With weights by volume the normal is that of the other body.
------------------------------------------------------------------------- */

void FixMPMContact::warn_of_thin_body(int thin, int other)
{
  if (comm->me || (normal_by != COLINEAR && (!gap || full <= 0.5))) return;
  error->warning(FLERR,
                 "Fix mpm/contact {}: {} is a surface or line of fix mpm/elements, and {} is not, "
                 "which can pass through what is so thin: use gap no normal volume",
                 id, bodies[thin].field->id(), bodies[other].field->id());
}

/* ----------------------------------------------------------------------
   Two thin bodies never touch where nodes must be full, however near they are. Without this condition, only nodes that both
   reach hold them: the other nodes fall freely in each step, as nothing joins the rows of nodes around a single row of points.
   FLIP then sinks with g dt times the ratio of the shares of both kinds of nodes, and affine velocities keep falling at all nodes
------------------------------------------------------------------------- */

void FixMPMContact::warn_of_thin_pair(const std::vector<int> &thin)
{
  const double enough = gap ? full : 1.0;
  std::vector<double> most;
  for (const int k : thin) most.push_back(most_filled(bodies[k]));
  for (std::size_t a = 0; a < thin.size(); a++)
    for (std::size_t b = a + 1; b < thin.size(); b++) {
      if (most[a] + most[b] >= enough) continue;
      if (comm->me) return;
      const char *const ids[] = {bodies[thin[a]].field->id(), bodies[thin[b]].field->id()};
      if (gap)
        error->warning(FLERR,
                       "Fix mpm/contact {}: {} and {} are surfaces or lines of fix mpm/elements, "
                       "and never touch: where they meet they fill {:.2g} of the volume of a node, "
                       "and gap yes waits for {:.2g}; move them with fix nve, not fix mpm, and use "
                       "pair_style mpm/sheet, or leave one of them out",
                       id, ids[0], ids[1], most[a] + most[b], full);
      else
        error->warning(FLERR,
                       "Fix mpm/contact {}: {} and {} are surfaces or lines of fix mpm/elements, "
                       "which gap no holds apart for a short time only: under a load that stays "
                       "they go through each other, slowly with transfer flip, and at once with "
                       "apic; move them with fix nve, not fix mpm, and use pair_style mpm/sheet",
                       id, ids[0], ids[1]);
      return;
    }
}

/** Returns the largest share of the volume of a node, as far as it is inside the box, that a body fills now. Collective. */
double FixMPMContact::most_filled(Body &body)
{
  const Grid &grid = body.field->grid;
  body.near.assign(grid.blocks.size(), 1);
  map_content(body);
  double most = 0.0, all;
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      int index[3];
      bool image = false;
      grid.node_index(grid.blocks[slot], n, index);
      const double inside = room.at(index, grid.lattice.dim, image);
      if (!image && inside > 0.0)
        most = std::max(most, body.share[slot * NODES_PER_BLOCK + n] / inside);
    }
  MPI_Allreduce(&most, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}

/* ----------------------------------------------------------------------
   Nodes next to fixed faces of the box, and to an axis of symmetry, have no points in a part of their volume:
   bodies that touch there fill the rest. A node in the plane of a face has room for half of its volume. Nodes
   outside are images of those inside (mpm_mirror_nodes.cpp), and in contact when these are.
------------------------------------------------------------------------- */

void FixMPMContact::Room::find(const MPMField &field, const Domain &box)
{
  constexpr int FIXED = 1, SAMPLES = 48;    // boundary f; places per cell
  for (int d = 0; d < field.lattice.dim; d++) {
    double face[2] = {-1.0e300, 1.0e300};    // in node spacings
    const double h = field.lattice.h, origin = field.lattice.origin[d];
    if (box.boundary[d][0] == FIXED) face[0] = (box.boxlo[d] - origin) / h;
    if (box.boundary[d][1] == FIXED) face[1] = (box.boxhi[d] - origin) / h;

    // share of the function of a node that is between the faces. Points with a size fill the cells, and
    // have the mean of the linear function

    const auto inside = [&](int node) {
      int first;
      double w[4], sum = 0.0;
      for (int k = -REACH * SAMPLES; k < REACH * SAMPLES; k++) {
        const double t = node + (k + 0.5) / SAMPLES;
        if (t < face[0] || t > face[1]) continue;
        if (field.options.has_size()) {
          sum += std::max(0.0, 1.0 - std::fabs(t - node)) / SAMPLES;
          continue;
        }
        const int n = MPMStencil(field).weights(t, first, w);
        if (node >= first && node < first + n) sum += w[node - first] / SAMPLES;
      }
      return sum;
    };
    for (int side = 0; side < 2; side++) {
      Side &near = sides[d][side];
      near.fixed = box.boundary[d][side] == FIXED;
      near.mirror = false;
      if (!near.fixed) continue;
      near.plane = (int) std::lround(face[side]);
      // an axis of symmetry is no mirror: volumes at its nodes are those of rings
      near.mirror =
          std::fabs(face[side] - near.plane) < 1.0e-6 && !(field.options.axisymmetric && d == 0);
      const int inward = side ? -1 : 1;
      for (int k = 0; k <= REACH; k++) near.share[k] = inside(near.plane + inward * k);
      if (!field.options.modified_edges) continue;
      const double outside = inside(near.plane - inward);    // see MPMEdges::fold()
      near.share[0] += 2.0 * outside;
      near.share[1] -= outside;
    }
  }
}

/* ----------------------------------------------------------------------
   share of the volume of a node that is inside the box. A node outside is replaced by its image, in
   index
------------------------------------------------------------------------- */

double FixMPMContact::Room::at(int *index, int dim, bool &image) const
{
  double most = 1.0;
  for (int d = 0; d < dim; d++) {
    double least = 1.0;    // a narrow box: two faces are near
    for (int side = 0; side < 2; side++) {
      const Side &near = sides[d][side];
      if (!near.fixed) continue;
      int depth = (side ? -1 : 1) * (index[d] - near.plane);
      if (depth < 0) {
        index[d] = 2 * near.plane - index[d];
        depth = -depth;
        image = true;
      }
      if (depth <= REACH) least = std::min(least, near.share[depth]);
    }
    most *= least;
  }
  return most;
}

/** Share of the volume of node n, as far as it is inside the box, that all bodies fill. */
double FixMPMContact::filled(const Common &c, int n) const
{
  int any = 0, index[3];
  while (c.slot[any] < 0) any++;
  const Grid &grid = bodies[any].field->grid;
  grid.node_index(grid.blocks[c.slot[any]], n, index);
  bool image = false;
  const double most = room.at(index, grid.lattice.dim, image);
  double sum = 0.0;
  for (std::size_t k = 0; k < bodies.size(); k++) {
    int64_t node = c.slot[k] < 0 ? -1 : (int64_t) c.slot[k] * NODES_PER_BLOCK + n;
    if (image) node = bodies[k].field->grid.locate(index);
    if (node >= 0) sum += bodies[k].share[node];
  }
  return most > 0.0 ? sum / most : 0.0;
}

/* ----------------------------------------------------------------------
   Gradient of a body at node n of a block. A body that reaches a fixed face has no surface there that
   others could touch: it continues as its mirror image. Without that, its normal would be inclined towards
   the face, and bodies that lie on each other would be pushed along the face.
------------------------------------------------------------------------- */

void FixMPMContact::gradient_at(const Body &body, int slot, int n, double *g) const
{
  const Grid &grid = body.field->grid;
  const int dim = grid.lattice.dim;
  int index[3], axis[3], plane[3], naxis = 0;
  grid.node_index(grid.blocks[slot], n, index);
  for (int d = 0; d < dim; d++)
    for (const auto &near : room.sides[d]) {
      if (!near.mirror || std::abs(index[d] - near.plane) > Room::REACH) continue;
      axis[naxis] = d;
      plane[naxis++] = near.plane;
      break;    // in a narrow box, one of the two
    }
  std::copy_n(&body.gradient[3 * ((int64_t) slot * NODES_PER_BLOCK + n)], 3, g);
  for (int images = 1; images < 1 << naxis; images++) {
    int image[3] = {index[0], index[1], index[2]};
    double sign[3] = {1.0, 1.0, 1.0};
    for (int k = 0; k < naxis; k++) {
      if (!(images >> k & 1)) continue;
      image[axis[k]] = 2 * plane[k] - index[axis[k]];
      sign[axis[k]] = -1.0;
    }
    const int64_t node = grid.locate(image);
    if (node < 0) continue;
    for (int d = 0; d < dim; d++) g[d] += sign[d] * body.gradient[3 * node + d];
  }
}

/** Finds the effect of walls on the present velocities of the nodes, which a stage may have changed since the last call. */
void FixMPMContact::foresee_walls(Body &body)
{
  body.foreseen.reset((int64_t) body.held.size());
  for (auto *fix : modify->get_fix_by_style("^mpm/boundary$"))
    dynamic_cast<FixMPMBoundary *>(fix)->predict(*body.field, body.near, body.foreseen);
}

FixMPMContact::Pair::Walls FixMPMContact::Body::find_walls(const double *record) const
{
  Grid &grid = field->grid;
  const int64_t node = (record - grid.nodes()) / grid.nreal;
  constexpr int ALL = 7;
  Pair::Walls walls = {};
  walls.held = (char) (held[node] & ALL);
  for (int d = 0; d < 3; d++) {
    walls.start[d] = record[d];
    walls.velocity[d] = foreseen.held[3 * node + d];
    const int place = foreseen.mirrored[3 * node + d];
    if (place == 0 || walls.held >> d & 1) continue;
    walls.mirrored |= 1 << d;
    const auto &mirror = foreseen.mirrors[std::abs(place) - 1];
    walls.velocity[d] = mirror.wall[d] + (place > 0 ? mirror.odd[d] : -mirror.odd[d]);
    walls.mass[d] = mirror.mass;
  }
  walls.outside = (char) (held[node] >> 3 & walls.mirrored);
  return walls;
}

/** Updates what walls will give to the images of a node, whose velocity has changed. */
void FixMPMContact::Body::move_mirrors(const double *record, const std::array<double, 3> &before)
{
  Grid &grid = field->grid;
  const int64_t node = (record - grid.nodes()) / grid.nreal;
  for (int d = 0; d < grid.lattice.dim; d++) {
    const int place = foreseen.mirrored[3 * node + d];
    if (place == 0) continue;
    auto &mirror = foreseen.mirrors[std::abs(place) - 1];
    const double change = (record[d] - before[d]) * record[3] / mirror.mass;
    mirror.odd[d] += place > 0 ? change : -change;
  }
}

/* ----------------------------------------------------------------------
   makes the pair with its normal; returns whether the bodies are near enough to touch
------------------------------------------------------------------------- */

bool FixMPMContact::make_pair(const Common &c, int n, int a, int b, double volume_share, Pair &pair)
{
  if (tries) return make_trial_pair(c, n, a, b, pair);
  MPMField &field = *bodies[a].field;
  double ga[3], gb[3];
  gradient_at(bodies[a], c.slot[a], n, ga);
  gradient_at(bodies[b], c.slot[b], n, gb);
  const double la = MathExtra::len3(ga), lb = MathExtra::len3(gb);
  if (la == 0.0 && lb == 0.0) return false;
  const double wa = normal_by == COLINEAR ? (la > 0.0 ? 1.0 / la : 0.0) : 1.0;
  const double wb = normal_by == COLINEAR ? (lb > 0.0 ? 1.0 / lb : 0.0) : 1.0;
  for (int d = 0; d < 3; d++) pair.n[d] = d < field.lattice.dim ? wa * ga[d] - wb * gb[d] : 0.0;
  const double length = MathExtra::len3(pair.n);
  if (!(length > 1.0e-10 * (wa * la + wb * lb))) return false;
  for (double &x : pair.n) x /= length;

  pair.a = a;
  pair.b = b;
  pair.ra = field.grid.record(c.slot[a], n);
  pair.rb = bodies[b].field->grid.record(c.slot[b], n);

  // gradients of the bodies at this node itself; its images have their own

  const auto own = [&](int body, int slot) {
    return std::fabs(MathExtra::dot3(
        &bodies[body].gradient[3 * ((int64_t) slot * NODES_PER_BLOCK + n)], pair.n));
  };
  pair.area = 0.5 * (own(a, c.slot[a]) + own(b, c.slot[b]));
  pair.fade = 0.0;
  pair.state = OPEN;
  if (law == ADHESIVE && pair.area > 0.0) {
    const double cell = field.lattice.cell_volume() * field.frame->node_circle(c.slot[a], n);
    const double opening = std::max(0.0, full - volume_share) * cell / pair.area;
    pair.fade = std::max(0.0, 1.0 - opening * normal_strength / (2.0 * release_work));
  }
  pair.water = 0.0;
  const bool wet = is_wet(pair);
  const double slack = wet ? SLACK : on_several_lattices ? BOX_ROUNDING : ROUNDING;
  const bool touches = !gap || volume_share >= full * (1.0 - slack) || pair.fade > 0.0;
  if (wet) {
    pair.water = water_between(pair);
    if ((touches || volume_share > NEARLY * full) && (c.owned >> n & 1))
      water_sums[touches ? 0 : 1] += std::fabs(pair.water);
  }
  return touches;
}

/** Impulse along the normal that water bears in this step, positive if it pushes. */
double FixMPMContact::water_between(const Pair &pair) const
{
  double sum = 0.0;
  int wet = 0;
  for (const int k : {pair.a, pair.b}) {
    const Body &body = bodies[k];
    if (body.water.empty()) continue;
    Grid &grid = body.field->grid;
    const double *const record = k == pair.a ? pair.ra : pair.rb;
    const int64_t node = (record - grid.nodes()) / grid.nreal;
    const double along = MathExtra::dot3(&body.water[3 * node], pair.n);
    sum += k == pair.a ? along : -along;
    wet++;
  }
  return wet ? dt_last * sum / wet : 0.0;
}

/** One warning if part of the force of the water is at nodes where bodies are not in contact, though they nearly fill
 *  them. Collective, where bodies have water. */
void FixMPMContact::report_missed_water()
{
  constexpr double MOST = 0.05;
  if (told_of_water || std::all_of(bodies.begin(), bodies.end(), [](const Body &body) {
        return !pore_pressure(*body.field);
      }))
    return;
  double all[2];
  MPI_Allreduce(water_sums, all, 2, MPI_DOUBLE, MPI_SUM, world);
  std::fill_n(water_sums, 2, 0.0);
  if (!(all[0] > 0.0 && all[1] > MOST * all[0])) return;
  told_of_water = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {}: {:.2g} of the force of pore water between bodies is at "
                   "nodes that these fill nearly, but where they are not in contact, so that it "
                   "counts as one of grains: use gap yes with a smaller share; this is said only "
                   "once",
                   id, all[1] / (all[0] + all[1]));
}

/* ---------------------------------------------------------------------- */

void FixMPMContact::find_contacts()
{
  const int nfields = (int) bodies.size();
  for (const auto &c : common)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(c.canonical >> n & 1)) continue;
      Node node;
      if (records(c, n, node.record) < 2) continue;
      const double volume_share = gap ? filled(c, n) : full;
      node.first = (int) pairs.size();
      node.owned = c.owned >> n & 1;
      Pair pair;
      for (int a = 0; a < nfields; a++)
        for (int b = a + 1; b < nfields; b++)
          if (node.record[a] && node.record[b] && make_pair(c, n, a, b, volume_share, pair)) {
            pair.water /= count_bodies(node) - 1;    // several neighbors share the water of a body
            pairs.push_back(pair);
          }
      node.last = (int) pairs.size();
      if (node.last > node.first) nodes.push_back(node);
    }
}

/* ----------------------------------------------------------------------
   one iteration of a pair: the impulse for its present velocities, within the limits of the law.
   nothers: number of bodies that one body may meet, by which the mass is divided.
   decided (MUSL, second field of velocities): the state of the pair stays
------------------------------------------------------------------------- */

void FixMPMContact::apply(Pair &pair, int nothers, double &largest, double dt, bool decided)
{
  const int dim = bodies[pair.a].field->lattice.dim;
  double u[3] = {0.0, 0.0, 0.0}, un = 0.0;
  for (int d = 0; d < dim; d++) {
    u[d] = pair.ra[d] - pair.rb[d];
    un += u[d] * pair.n[d];
  }
  double m = pair.ra[3] * pair.rb[3] / (pair.ra[3] + pair.rb[3]) / nothers;

  // A body that a wall holds does not yield: the wall takes the impulse of contact. If it were treated as free,
  // the other body would move on into it, a little in each step.
  //
  // At a mirror, a node moves with its image, and both have the mass of both; contact pushes on each. Components
  // that are mirrored in both bodies are the same at both nodes: contact at the node inside determines them.

  if (!pair.alike) {
    double inverse = 0.0, square = 0.0;
    const int away = pair.walls_a.outside & pair.walls_b.outside;
    MathExtra::zero3(u);
    for (int k = 0; k < 2; k++) {
      const Pair::Walls &walls = k ? pair.walls_b : pair.walls_a;
      const double *const r = k ? pair.rb : pair.ra;
      for (int d = 0; d < dim; d++) {
        if (pair.left >> d & 1) continue;
        double v = r[d], mass = r[3];
        if (walls.held >> d & 1) {
          u[d] += k ? -walls.velocity[d] : walls.velocity[d];
          continue;
        }
        if (walls.mirrored >> d & 1) {
          v = walls.velocity[d] + (r[d] - walls.start[d]) * r[3] / walls.mass[d];
          mass = walls.mass[d];
        }
        u[d] += k ? -v : v;
        inverse += pair.n[d] * pair.n[d] / mass;
      }
    }
    un = 0.0;
    for (int d = 0; d < dim; d++) {
      un += u[d] * pair.n[d];
      if (!(away >> d & 1)) square += pair.n[d] * pair.n[d];
    }
    m = inverse * std::max(pair.ra[3], pair.rb[3]) > 1.0e-6 ? square / inverse / nothers : 0.0;
  }

  double normal = pair.normal + m * un, t[3] = {0.0, 0.0, 0.0}, length = 0.0;
  for (int d = 0; d < dim; d++) {
    t[d] = pair.tangential[d] + m * (u[d] - un * pair.n[d]);
    length += t[d] * t[d];
  }
  length = sqrt(length);

  double keep;
  if (decided) {
    keep = pair.state == STUCK ? 1.0 : 0.0;
    if (pair.state == OPEN) normal = 0.0;
  } else {
    const double unit = force->ftm2v / force->nktv2p * pair.area * pair.fade * dt;
    const double by_water = std::max(pair.water, 0.0);
    normal = std::max(normal, by_water - (law == ADHESIVE ? normal_strength * unit : 0.0));
    if (law == STICK) {
      double speeds[2] = {0.0, 0.0};
      for (int d = 0; d < dim; d++) {
        speeds[0] += pair.ra[d] * pair.ra[d];
        speeds[1] += pair.rb[d] * pair.rb[d];
      }
      if (normal - by_water <= APPROACH * m * (sqrt(speeds[0]) + sqrt(speeds[1])))
        normal = by_water;
    }
    const double push = normal > by_water ? normal - pair.water : 0.0;
    const double bond = shear_strength * unit;
    const double limit = static_friction * push + bond;
    keep = 1.0;
    if (law == STICK)
      keep = push > 0.0 ? 1.0 : 0.0;
    else if (limit == 0.0)
      keep = 0.0;    // also where there is no tangential velocity, up to rounding
    else if (length > limit)
      keep = (kinetic_friction * push + bond) / length;
    pair.state = normal == 0.0 && keep == 0.0 ? OPEN : (keep == 1.0 ? STUCK : SLIDING);
  }

  double change = fabs(normal - pair.normal), rounding = 0.0;
  pair.normal = normal;
  for (int d = 0; d < dim; d++) {
    change += fabs(keep * t[d] - pair.tangential[d]);
    pair.tangential[d] = keep * t[d];
    rounding += ROUNDED * m * (fabs(pair.ra[d]) + fabs(pair.rb[d]));
  }
  largest = std::max(largest, change / (fabs(normal) + length + rounding + 1.0e-300));
}

/** Does a node move with images that have mass? */
bool FixMPMContact::Pair::Walls::moves_with_images(const double *record) const
{
  bool moves = false;
  for (int d = 0; d < 3; d++) moves = moves || (mirrored >> d & 1 && mass[d] > record[3]);
  return moves;
}

/* ----------------------------------------------------------------------
   velocities of the bodies at a node before contact, and the action of walls on them; returns whether walls
   move one body with its images and another not
------------------------------------------------------------------------- */

bool FixMPMContact::begin(Node &node, Velocities &start)
{
  const int nfields = (int) bodies.size();
  for (int k = 0; k < nfields; k++)
    if (node.record[k]) std::copy_n(node.record[k], 3, start[k].begin());
  bool mirrors = false;
  for (int p = node.first; p < node.last; p++) {
    Pair &pair = pairs[p];
    const Pair::Walls &a = pair.walls_a = bodies[pair.a].find_walls(pair.ra);
    const Pair::Walls &b = pair.walls_b = bodies[pair.b].find_walls(pair.rb);
    pair.alike = a.held == b.held && a.mirrored == b.mirrored;
    pair.left = pair.alike ? 0 : ((a.outside & b.outside) | (a.held & b.held));
    pair.normal = 0.0;
    MathExtra::zero3(pair.tangential);
    mirrors = mirrors ||
        (!pair.alike && (a.moves_with_images(pair.ra) || b.moves_with_images(pair.rb)));
  }
  return mirrors;
}

/** Sets the velocities of the bodies at a node by the impulses of its pairs; walls will move its images with it. */
void FixMPMContact::set_velocities(const Meeting &meeting)
{
  const Node &node = *meeting.node;
  const int nfields = (int) bodies.size(), dim = bodies[0].field->lattice.dim;
  Velocities before;
  for (int k = 0; k < nfields; k++)
    for (int d = 0; d < dim && node.record[k]; d++) {
      before[k][d] = node.record[k][d];
      node.record[k][d] = meeting.start[k][d];
    }
  for (int p = node.first; p < node.last; p++) {
    const Pair &pair = pairs[p];
    for (int d = 0; d < dim; d++) {
      pair.ra[d] -= pair.impulse(d) / pair.ra[3];
      pair.rb[d] += pair.impulse(d) / pair.rb[3];
    }
  }
  for (int k = 0; k < nfields; k++)
    if (node.record[k]) bodies[k].move_mirrors(node.record[k], before[k]);
}

int FixMPMContact::count_bodies(const Node &node) const
{
  return (int) (bodies.size() -
                std::count(node.record, node.record + bodies.size(), (double *) nullptr));
}

/* ----------------------------------------------------------------------
   an iteration at a node. Impulses of all pairs follow from the same velocities, so that their order does
   not matter. Returns the change of the impulses
------------------------------------------------------------------------- */

double FixMPMContact::iterate(const Meeting &meeting, double dt, bool decided)
{
  const Node &node = *meeting.node;
  const int nothers = count_bodies(node) - 1;
  double largest = 0.0;
  for (int p = node.first; p < node.last; p++) apply(pairs[p], nothers, largest, dt, decided);
  set_velocities(meeting);
  return largest;
}

/* ----------------------------------------------------------------------
   Gauss-Seidel iterations for nodes that depend on each other; mirrored: by walls that move a body with
   its images. Where masses differ much, these converge slowly, and are accelerated.
------------------------------------------------------------------------- */

void FixMPMContact::solve(const Meeting *first, const Meeting *last, bool mirrored, double dt,
                          bool decided)
{
  std::vector<double> &x = impulses;
  const auto each = [&](auto f) {
    for (const Meeting *m = first; m < last; m++)
      for (int p = m->node->first; p < m->node->last; p++) f(pairs[p]);
  };
  x.clear();
  states.clear();
  each([&](const Pair &pair) {
    x.insert(x.end(), 4, 0.0);
    states.push_back(pair.state);
  });
  series.begin(x);
  double largest = 0.0;
  for (int it = 1; it <= MAX_ITERATIONS; it++) {
    largest = 0.0;
    for (const Meeting *m = first; m < last; m++) {
      for (int p = m->node->first; p < m->node->last && mirrored; p++) {
        pairs[p].walls_a = bodies[pairs[p].a].find_walls(pairs[p].ra);
        pairs[p].walls_b = bodies[pairs[p].b].find_walls(pairs[p].rb);
      }
      largest = std::max(largest, iterate(*m, dt, decided));
    }
    if (largest < CONVERGED) break;
    // extrapolated impulses may pull, or exceed friction: another iteration must follow
    if (it == MAX_ITERATIONS) break;

    bool same = true;
    double *to = x.data();
    char *state = states.data();
    each([&](const Pair &pair) {
      same = same && *state == pair.state;
      *state++ = pair.state;
      *to++ = pair.normal;
      to = std::copy_n(pair.tangential, 3, to);
    });
    if (!series.advance(x, largest, same)) continue;
    const double *from = x.data();
    each([&](Pair &pair) {
      pair.normal = *from++;
      std::copy_n(from, 3, pair.tangential);
      from += 3;
    });
    for (const Meeting *m = first; m < last; m++) set_velocities(*m);
  }
  if (largest > UNSOLVED) note_unsolved(first, last);
}

/* ----------------------------------------------------------------------
   Nodes where iterations have not converged. Each rank notes those that it owns
------------------------------------------------------------------------- */

void FixMPMContact::note_unsolved(const Meeting *first, const Meeting *last)
{
  const auto now = (double) update->ntimestep;
  for (const Meeting *m = first; m < last && !unsolved.knows(now); m++) {
    if (!m->node->owned) continue;
    const Pair &pair = pairs[m->node->first];
    Grid &grid = bodies[pair.a].field->grid;
    double x[3];
    grid.node_position((pair.ra - grid.nodes()) / grid.nreal, x);
    unsolved.take({now, x[0], x[1], x[2]});
  }
}

/** Collective: one warning, the same for any number of ranks. */
void FixMPMContact::report_unsolved()
{
  std::array<double, 4> first;
  if (unsolved.tell(world, first) && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {}: {} iterations were not enough to find what bodies give to "
                   "each other at the node at {:.6g} {:.6g} {:.6g} in step {:.0f}: they approach "
                   "each other, or slide, a little there. This happens where three or more bodies "
                   "meet at a node, or masses differ much: use a smaller node spacing, so that "
                   "fewer of them meet, or densities that differ less; this is said only once",
                   id, MAX_ITERATIONS, first[1], first[2], first[3], first[0]);
}

/* ----------------------------------------------------------------------
   Groups nodes that depend on each other, because walls move a body at them together
------------------------------------------------------------------------- */

void FixMPMContact::group_meetings()
{
  const int n = (int) meetings.size(), nfields = (int) bodies.size();
  if (n < 2) return;
  dependent.begin(n);
  for (int k = 0; k < nfields; k++) {
    const Body &body = bodies[k];
    const Grid &grid = body.field->grid;
    std::vector<int> &first = first_with_mirror;
    first.assign(body.foreseen.mirrors.size(), -1);
    for (int m = 0; m < n; m++) {
      const double *const record = meetings[m].node->record[k];
      for (int d = 0; d < grid.lattice.dim && record; d++) {
        const int64_t node = (record - body.field->grid.nodes()) / grid.nreal;
        const int place = std::abs(body.foreseen.mirrored[3 * node + d]) - 1;
        if (place < 0) continue;
        if (first[place] < 0) first[place] = m;
        dependent.join(m, first[place]);
      }
    }
  }
  for (int m = 0; m < n; m++) meetings[m].group = dependent.root(m);
  std::stable_sort(meetings.begin(), meetings.end(), [](const Meeting &a, const Meeting &b) {
    return a.group < b.group;
  });
}

/* ----------------------------------------------------------------------
   Where walls mirror one body and not the other, contact at a node changes the velocity of this body at the
   images of the node, too: these nodes are solved together. If they were solved one after the other,
   they would leave an approach in each step: water went into the clamped end of a plate.
------------------------------------------------------------------------- */

void FixMPMContact::resolve_all(double dt, bool decided)
{
  meetings.clear();
  for (auto &node : nodes) {
    Meeting meeting = {&node, {}, 0};
    if (begin(node, meeting.start)) {
      meetings.push_back(meeting);
      continue;
    }
    if (count_bodies(node) == 2)    // needs one iteration
      iterate(meeting, dt, decided);
    else
      solve(&meeting, &meeting + 1, false, dt, decided);
    if (!decided) account(node, meeting.start);
  }
  group_meetings();
  const Meeting *const end = meetings.data() + meetings.size();
  for (const Meeting *first = meetings.data(), *last; first < end; first = last) {
    for (last = first + 1; last < end && last->group == first->group;) last++;
    solve(first, last, true, dt, decided);
  }
  if (!decided)
    for (const auto &meeting : meetings) account(*meeting.node, meeting.start);
}

double FixMPMContact::Pair::Walls::velocity_of(const double *record, int d) const
{
  if (held >> d & 1) return velocity[d];
  if (mirrored >> d & 1) return velocity[d] + (record[d] - start[d]) * record[3] / mass[d];
  return record[d];
}

/** Gives the heat of two bodies that slide to their nodes; returns it. */
double FixMPMContact::heat_of(const Pair &pair, bool owned)
{
  const int dim = bodies[0].field->lattice.dim;
  double J[3], old[3], now[3];
  for (int d = 0; d < dim; d++) {
    J[d] = pair.left >> d & 1 ? 0.0 : pair.tangential[d];
    old[d] = pair.rb[4 + d] - pair.ra[4 + d];
    now[d] = pair.rb[d] - pair.ra[d];
    if (pair.alike) continue;
    const auto &a = pair.walls_a, &b = pair.walls_b;
    now[d] = b.velocity_of(pair.rb, d) - a.velocity_of(pair.ra, d);
    old[d] = (b.held >> d & 1 ? b.velocity[d] : pair.rb[4 + d]) -
        (a.held >> d & 1 ? a.velocity[d] : pair.ra[4 + d]);
  }
  const double heat = heating->made(J, old, now, dim);
  heating->between(pair.a, pair.ra, pair.b, pair.rb, pair.n, heat, owned);
  return heat;
}

/* ----------------------------------------------------------------------
   forces between bodies, work of the friction, and the ledgers of the fields
------------------------------------------------------------------------- */

void FixMPMContact::account(const Node &node, const Velocities &start)
{
  const int dim = bodies[0].field->lattice.dim;
  for (int p = node.first; p < node.last; p++) {
    const Pair &pair = pairs[p];
    if (pair.state == OPEN) continue;
    const double heat = heating && pair.state == SLIDING ? heat_of(pair, node.owned) : 0.0;
    if (!node.owned) continue;
    Account &entry = accounts[pair_index(pair.a, pair.b, (int) bodies.size())];
    entry.count += 1.0;
    double work = 0.0;
    for (int d = 0; d < dim; d++) {
      entry.impulse[d] += pair.impulse(d);
      work += pair.tangential[d] * (pair.rb[d] - pair.ra[d]);
    }
    if (heating) {    // the mean of old and new velocities, also for the ledger
      auto &ledger = bodies[pair.a].field->ledger;
      const double more = -heat - work * force->mvv2e;
      ledger.contact += more;
      ledger.transfer -= more;
      work = -heat / force->mvv2e;
    }
    entry.work += work;
  }
  for (std::size_t k = 0; k < bodies.size(); k++) {
    const double *record = node.record[k];
    Grid &grid = bodies[k].field->grid;
    // another rank may own the node in this field: other impulses on it are booked there
    if (!record || !grid.owns((record - grid.nodes()) / grid.nreal)) continue;
    double change[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) change[d] = record[d] - start[k][d];
    bodies[k].field->ledger.count_push(record, change);
  }
}

/* ---------------------------------------------------------------------- */

void FixMPMContact::act(double dt, Stage stage)
{
  const bool count = stage == STEP;
  if (stage == TRIAL) return;
  if (!lists_valid) list_common_blocks();
  if (count) {
    for (auto &entry : accounts) entry = {{0.0, 0.0, 0.0}, 0.0, entry.work};
    dt_last = dt;
    if (tries) return act_after_trials();
    nodes.clear();
    pairs.clear();
    if (look) warn_thin();
    if (may_touch && map_bodies()) {
      if (look) warn_overlap();
      find_contacts();
      if (normal_by == LOGISTIC) separate_points();
      if (heating) heating->begin_step();
    }
    look = false;
  } else if (!nodes.empty()) {
    for (auto &body : bodies) foresee_walls(body);
  }
  resolve_all(dt, !count);
  if (count && ++steps % LOOK_EVERY == 1) {
    report_unsolved();
    report_missed_water();
  }
}

/* ----------------------------------------------------------------------
   work of friction so far
------------------------------------------------------------------------- */

double FixMPMContact::compute_scalar()
{
  double mine = 0.0, all;
  for (const auto &entry : accounts) mine += entry.work;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all * force->mvv2e;
}

/* ----------------------------------------------------------------------
   rows: pairs of bodies; columns: force on the second by the first in the last step, nodes in
   contact, work of friction so far
------------------------------------------------------------------------- */

double FixMPMContact::compute_array(int row, int column)
{
  if (array_step != update->ntimestep) {
    array_step = update->ntimestep;
    double mine[MAX_PAIRS][5];
    for (int p = 0; p < size_array_rows; p++) {
      const auto &[impulse, count, work] = accounts[p];
      for (int d = 0; d < 3; d++)
        mine[p][d] = dt_last > 0.0 ? impulse[d] / (dt_last * force->ftm2v) : 0.0;
      mine[p][3] = count;
      mine[p][4] = work * force->mvv2e;
    }
    MPI_Allreduce(mine, array, 5 * size_array_rows, MPI_DOUBLE, MPI_SUM, world);
  }
  return array[row][column];
}

/* ---------------------------------------------------------------------- */

void FixMPMContact::write_restart(FILE *fp)
{
  std::vector<double> total(1, -size_array_rows);
  for (int p = 0; p < size_array_rows; p++) {
    keep_totals(world, &accounts[p].work, 1);
    total.push_back(accounts[p].work);
  }
  if (comm->me) return;
  const std::string text = utils::join_words(names, " ");
  const int numbers = (int) (total.size() * sizeof(double)), size = numbers + (int) text.size() + 1;
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(total.data(), 1, numbers, fp);
  fwrite(text.c_str(), 1, text.size() + 1, fp);
}

/* ----------------------------------------------------------------------
   rank 0 goes on with the totals. Files of older versions have the number of pairs in place of minus
   this number, and no names of the fields behind the work
------------------------------------------------------------------------- */

void FixMPMContact::restart(char *buf)
{
  const auto *const from = (const double *) buf;
  if (std::abs((int) from[0]) != size_array_rows)
    error->all(FLERR, Error::NOPOINTER,
               "Fix mpm/contact {} had another number of fields when the restart file was written: "
               "name as many, or give the fix another ID to begin anew",
               id);
  const std::string ours = utils::join_words(names, " "),
                    theirs = from[0] < 0.0 ? (const char *) (from + 1 + size_array_rows) : ours;
  if (theirs != ours)
    error->all(FLERR, Error::NOPOINTER,
               "Fix mpm/contact {} was between {} when the restart file was written, not {}: name "
               "them in this order, or give the fix another ID to begin anew",
               id, theirs, ours);
  for (int p = 0; p < size_array_rows; p++) accounts[p].work = comm->me == 0 ? from[1 + p] : 0.0;
}

/* ---------------------------------------------------------------------- */

double FixMPMContact::memory_usage()
{
  double bytes = (heating ? heating->memory_usage() : 0.0) + pairs.capacity() * sizeof(Pair) +
      nodes.capacity() * sizeof(Node) + common.capacity() * sizeof(Common);
  for (const auto &body : bodies)
    bytes += (body.gradient.capacity() + body.share.capacity() + body.foreseen.held.capacity()) *
        sizeof(double);
  return bytes;
}
