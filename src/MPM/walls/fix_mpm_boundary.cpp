/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Mirror planes: see "Mirrored boundaries" in Developer_mpm.rst, which derives the projection; for faces
   between planes of nodes see fix_mpm_boundary_cut.cpp. The impulse of this projection on the body is
     -m(k0) w(k0) - sum_j 2 m1 m2/(m1 + m2) (w1 + w2)
   with w1, w2 the velocities relative to the wall that the momentum equation gave to the nodes k0 + j
   and to their images k0 - j, which for an unconstrained component is minus the mean velocity at the
   wall times a mass. Stick prescribes all components, slip the normal one. At edges, a node and its
   images in all faces of the fix that prescribe a component form an orbit with signs.

   Friction scales the tangential projection of a column of nodes so that its impulse is at most mu
   times the normal one (return mapping of Coulomb's law). With MUSL, the velocity that is mapped back
   for the gradient must follow the decision of the column: otherwise, a block that bounced had 1.4 times
   its energy.

   FLIP. Points change their velocity by the sum of N (v_new - v_old). Stick, and slip along the
   normal, hold the material for good: they constrain v_old like v_new, which is to constrain both
   momentum and force of the nodes (Sulsky, Chen, Schreyer 1994), so that the increment at a wall at
   rest is zero, as it is when the body is continued by its mirror image. With an unchanged v_old, the
   prescribed component would be updated as in PIC, because the velocity that a node at the wall
   gets from the points on one side of it is a mean over some distance, not zero; a bar of 16 cells
   lost 2.3 % of its energy in 10 periods. A point that arrives at the wall would keep its velocity
   for good, as the nodes that could change it do not change themselves; a block of water that fell on
   the floor kept four times the energy. Hence v_old relative to the wall counts as consistent with the
   wall, in each component, only up to the value at the first node inside (a field that rises from the
   wall has less at the wall than there); any excess remains in v_old, and the points lose it.
   v_old relative to the wall means relative to its velocity in the last step. In its first step, a wall
   counts as having moved like this before. Separating walls, walls that turn, and friction leave v_old
   alone. So do regions, except those that stick or slip at their surface (act_on_crossing()); next to
   them, the components that they prescribe are updated as in PIC. PIC and APIC have no use for v_old.

   AFLIP leaves v_old alone, too. With affine matrices, the nodes at the wall get the velocity that the
   field has there, not a mean over some distance, so that a vibration loses nothing: the bar above
   keeps its energy to the same five digits. A constraint on v_old would create energy: a point at a distance
   y from a wall that sticks would keep its velocity v along it, while its affine matrix, for which the
   nodes at the wall are at rest, becomes v/y, again in each step. One grain that slid on a rough floor
   within a tenth of a cell spent 70 times its kinetic energy by friction and did not slow down. With an
   unchanged v_old, velocity and affine matrix are together projected on the fields that vanish at the wall,
   which leaves v (y^2/D)/(1 + y^2/D) of a single point (D: h^2/4 quadratic, h^2/3 cubic).

   Rotation. The velocity given to a node at x is the chord ((R(dt) - I)(x - o))/dt and not the
   tangent omega x (x - o): positions are updated by x += dt v, so that the tangent would carry
   every point outward by a factor sqrt(1 + (omega dt)^2) per step, and the chord puts it back on
   its circle exactly, since splines reproduce linear fields. USF asks for velocities first, to find
   how the material has moved to its present position: then the chord is that of the step that has
   ended, (I - R^-1)(x - o)/dt, whose matrix is minus the transpose of the other one.
------------------------------------------------------------------------- */

#include "walls/fix_mpm_boundary.h"

#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_physics.h"
#include "force.h"
#include "math_extra.h"
#include "math_special.h"
#include "modify.h"
#include "region.h"
#include "update.h"
#include "walls/mpm_region_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <tuple>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using MathSpecial::cube;

static const char *const FACE_NAME[6] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
static constexpr const char *PERIODIC =
    "Fix mpm/boundary face {} belongs to a periodic axis: use boundary f there";
static constexpr double ON_SURFACE = 1.0e-6;    // in node spacings
static constexpr double FAR = 1.0e8;            // in node spacings
static constexpr double HAND_OVER = 0.5;        // in node spacings, see list_region_nodes()
static constexpr double SMOOTH = 0.9;           // least cosine between normals of a smooth surface
static constexpr double FELT_THROUGH =
    3.0;    // node spacings: material on one side is not felt on the other
static constexpr double ALONG = 1.0e-3;    // sine of the angle of a motion along the surface
static constexpr double EQUAL = 1.0e-6;    // difference of equal components of normals
static constexpr double RESOLVED = 1.5;    // node spacings; nodes cannot resolve smaller widths

/* ----------------------------------------------------------------------
   fix ID all mpm/boundary faces|region REG  stick|slip|separate  keyword values
------------------------------------------------------------------------- */

Options MPMBoundaryOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/boundary");
  o.argument(word(kind, {{"stick", STICK}, {"slip", SLIP}, {"separate", SEPARATE}}, "kind"));
  o.add("friction",
        {number(friction, "mu", NOT_NEGATIVE, "1",
                "coefficient of Coulomb friction, for *slip* and *separate*")});
  heat.declare(o, "the energy lost by friction becomes heat of the material",
               "share of this energy that becomes heat of the material");
  o.add("velocity",
        {variables(velocity, 3, "vx vy vz", "velocity",
                   "velocity of the wall, can be variables (see below); with *stick*, NULL leaves "
                   "a component free",
                   true)})
      .once();
  o.add("displacement",
        {variables(velocity, 3, "ux uy uz", "distance",
                   "displacement of the wall since this fix was defined, instead of its velocity; "
                   "can be variables; with "
                   "*stick*, NULL leaves a component free",
                   true)})
      .then([this] {
        by_displacement = true;
      })
      .once()
      .standard("none");
  o.add("rotate",
        {numbers(center, 3, "ox oy oz", ANY_NUMBER, "distance", "a point on the axis of rotation"),
         numbers(axis, 3, "ax ay az", ANY_NUMBER, "", "direction of the axis"),
         variables(&rate, 1, "rate", "radians/time",
                   "angular velocity, can be a variable (see below)")})
      .once()
      .standard("none");
  o.add("field",
        {text(field_id, "fix-ID", "ID of the :doc:`fix mpm <fix_mpm>` on which this fix acts")})
      .standard("all");
  o.refuse([=] {
    return OptionRules{
        {kind == STICK, "friction", "needs kind slip or separate"},
        {heat.heats() && friction == 0.0, "heat", "is that of friction, which needs a coefficient"},
        {kind != STICK && !all_given(), "velocity", "allows NULL only with kind stick"},
        {!velocity[0].given && !velocity[1].given && (dim == 2 || !velocity[2].given), "velocity",
         "leaves all components free"},
        {dim == 2 && (!velocity[2].variable.empty() || velocity[2].value != 0.0), "velocity",
         "must have the component 0 along z in 2d: {velocity}"},
        {kind != STICK && !all_given(), "displacement", "allows NULL only with kind stick"},
        {!velocity[0].given && !velocity[1].given && (dim == 2 || !velocity[2].given),
         "displacement", "leaves all components free"},
        {dim == 2 && (!velocity[2].variable.empty() || velocity[2].value != 0.0), "displacement",
         "must have the component 0 along z in 2d: {displacement}"},
        {MathExtra::len3(axis) == 0.0, "rotate", "needs an axis of non-zero length"},
        {dim == 2 && (axis[0] != 0.0 || axis[1] != 0.0), "rotate", "needs an axis along z in 2d"},
        {!all_given(), "rotate", "prescribes all components of the velocity"}};
  });
  return o;
}

FixMPMBoundary::FixMPMBoundary(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/boundary acts on nodes, which have no group: use group all, and "
               "keyword field to act on one of several fields");

  // arguments: where the wall is

  if (narg < 5) utils::missing_cmd_args(FLERR, "fix mpm/boundary", error);
  int iarg = 3;
  if (strcmp(arg[iarg], "region") == 0) {
    region_id = arg[iarg + 1];
    iarg += 2;
  } else {
    for (; iarg < narg; iarg++) {
      const auto *const name = std::find(FACE_NAME, FACE_NAME + 6, std::string(arg[iarg]));
      const int face = (int) (name - FACE_NAME);
      if (face == 6) break;
      if (std::count(face_list.begin(), face_list.end(), face))
        error->all(FLERR, iarg, "Fix mpm/boundary face {} is given twice", arg[iarg]);
      if (face >= 4 && domain->dimension == 2)
        error->all(FLERR, iarg, "Fix mpm/boundary face {} does not exist in 2d", arg[iarg]);
      if (domain->periodicity[face / 2]) error->all(FLERR, iarg, PERIODIC, arg[iarg]);
      face_list.push_back(face);
    }
    if (face_list.empty())
      error->all(FLERR, iarg,
                 "Unknown fix mpm/boundary wall {}: must be region or one or more of "
                 "xlo xhi ylo yhi zlo zhi",
                 arg[iarg]);
  }

  // arguments: what the wall does

  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, iarg);
  if (options.given("velocity") && options.given("displacement"))
    error->all(FLERR, options.where("displacement"),
               "Fix mpm/boundary takes a velocity or a displacement: use one of them");
  const double length = MathExtra::len3(axis);
  for (int d = 0; d < 3 && rotating(); d++) axis[d] /= length;

  if (!region_id.empty()) {
    region = domain->get_region_by_id(region_id);
    if (!region)
      error->all(FLERR, 4, "Region {} for fix mpm/boundary does not exist: define it before",
                 region_id);
    const bool driven = options.given("rotate") || options.given("velocity") ||
        options.given("displacement");
    if (driven && region->dynamic)
      error->all(FLERR,
                 "Fix mpm/boundary takes the velocity of region {} from its own motion: "
                 "drop velocity, displacement, and rotate, or the motion of the region",
                 region_id);
  }

  if (heat.heats()) heating = std::make_unique<MPMFrictionHeat>(lmp, heat);

  scalar_flag = vector_flag = 1;
  size_vector = 6;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
}

/* ---------------------------------------------------------------------- */

bool FixMPMBoundary::region_moves() const
{
  return region && region->dynamic_check();
}

bool FixMPMBoundary::moves() const
{
  const bool driven = std::any_of(velocity, velocity + 3, [](const NumberOrVariable &v) {
    return v.value != 0.0 || !v.variable.empty();
  });
  return driven || rotating() || region_moves();
}

/* ----------------------------------------------------------------------
   Nodes inside hold only the points of a body in front of the surface that they reach. The body would creep into the
   wall, and stresses next to it would be wrong by an amount that depends on where the surface is in a cell. Lines hold
   the surface. Nodes hold material inside a region, as in a grip, which has no surface there: see act_on_crossing().
------------------------------------------------------------------------- */

bool FixMPMBoundary::acts_across() const
{
  if (region->varshape) return false;
  return follows || decides() || holds_surface();
}

/** Does the wall hold material that is near, whether or not that has reached it? */
bool FixMPMBoundary::keeps_distance() const
{
  return region ? holds_surface() : !decides();
}

/** Does the wall have a velocity without moving, so that material at the surface of a region leaves the region? */
bool FixMPMBoundary::is_driven() const
{
  return rotating() || std::any_of(velocity, velocity + 3, [](const auto &v) {
           return !v.variable.empty() || v.value != 0.0;
         });
}

/** Do lines hold material in front of the surface? They do with stick and slip on a region in explicit steps, and with slip at
 *  rest in implicit ones; nodes act on material inside. Nodes hold for good what sticks to a region that is driven. */
bool FixMPMBoundary::holds_surface() const
{
  const bool sticks = !is_driven() && !in_implicit_steps;
  return (kind == STICK ? sticks : kind == SLIP && friction == 0.0) && !follows;
}

bool FixMPMBoundary::acts_on(const MPMField &field) const
{
  return field_id.empty() || field_id == field.id();
}

bool FixMPMBoundary::decides_contact(const MPMField &field) const
{
  return kind == SEPARATE && acts_on(field);
}

bool FixMPMBoundary::holds_axis(const MPMField &field) const
{
  return acts_on(field) && std::count(face_list.begin(), face_list.end(), 0) && !decides() &&
      !rotating() && velocity[0].given && velocity[0].variable.empty() && velocity[0].value == 0.0;
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::init()
{
  // fields, in the order of their definition

  require_field(lmp, *this);
  const auto fields = MPMField::all(lmp);
  const bool moves = rotating() ||
      std::any_of(velocity, velocity + 3, [](const NumberOrVariable &v) {
                       return !v.variable.empty() || v.value != 0.0;
                     });
  nodes.clear();    // listed with the topology
  in_implicit_steps = !modify->get_fix_by_style("^mpm/implicit$").empty();
  seeks = kind == SEPARATE && in_implicit_steps;
  follows = kind != SEPARATE && in_implicit_steps && !region_id.empty() &&
      domain->get_region_by_id(region_id) && domain->get_region_by_id(region_id)->dynamic_check();
  for (auto *field : fields) {
    if (!acts_on(*field)) continue;
    nodes.push_back({field, faces_on_lattice(*field), {}, {}, {}, {}});
    const std::string keeps = "its nodes keep to the same material wherever it goes: instead of ";
    refuse_field(
        lmp, *this, *field,
        {{field->options.total && kind == SEPARATE, "frame total",
          keeps + "separate, use fix wall/gran or a pair style"},
         {field->options.total && region_moves(), "frame total",
          keeps + "a moving region, use stick velocity with variables, displacement, or rotate"},
         {field->options.total && rotating() && kind != STICK, "frame total",
          keeps + "slip on a wall that turns, use stick"},
         {field->options.total && rotating() && field->options.stress_before(),
          "scheme usf and usavg", "they ask for the rotation of the step before: use usl or musl"},
         {field->options.total != nodes[0].field->options.total && rotating(), "frame total",
          "the wall also turns fields of frame updated, whose nodes are elsewhere: use a fix "
          "mpm/boundary with "
          "keyword field for each"},
         {field->options.most_distorted > 0.0 && moves, "reference update",
          "the material that a wall with velocity holds would leave it with the first "
          "update: use reference fixed"},
         {field->options.stress_before() && decides(), "scheme usf and usavg",
          "separate and friction need the contact before it is known: use usl or musl"}});
  }
  if (nodes.empty())
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/boundary field {} is not the ID of a fix mpm",
               field_id);

  for (auto &v : velocity) find_variable(lmp, v, "fix mpm/boundary velocity");
  find_variable(lmp, rate, "fix mpm/boundary rotate");

  if (!region_id.empty()) {
    region = domain->get_region_by_id(region_id);
    if (!region)
      error->all(FLERR, Error::NOLASTLINE, "Region {} for fix mpm/boundary does not exist",
                 region_id);
    surface = std::make_unique<MPMRegionSurface>(region, domain->dimension);
    if (surface->is_open())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/boundary cannot use region {}: open faces have no inside", region_id);
    if (region->dynamic_check() && region->nregion > 1)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/boundary cannot use region {}: a union or intersection must not move; "
                 "use one fix mpm/boundary for each member",
                 region_id);
  }

  // one master of each face

  for (int face : face_list) {
    if (domain->periodicity[face / 2])
      error->all(FLERR, Error::NOLASTLINE, PERIODIC, FACE_NAME[face]);
    for (auto *ifix : modify->get_fix_by_style("^mpm/boundary$")) {
      auto *other = dynamic_cast<FixMPMBoundary *>(ifix);
      if (other == this) continue;
      if (!field_id.empty() && !other->field_id.empty() && field_id != other->field_id) continue;
      if (std::count(other->face_list.begin(), other->face_list.end(), face))
        error->all(FLERR, Error::NOLASTLINE,
                   "Face {} belongs to fix mpm/boundary {} and {}: remove one, or give them "
                   "different fields",
                   FACE_NAME[face], id, other->id);

      // opposite face

      if (!std::count(other->face_list.begin(), other->face_list.end(), face ^ 1)) continue;
      for (const auto &list : nodes) {
        const auto &field = *list.field;
        if (other->acts_on(field) &&
            faces_are_near({{field, *domain, face}, {field, *domain, face ^ 1}}, face / 2))
          error->all(FLERR, Error::NOLASTLINE,
                     "Faces {} and {} are less than 3 cells apart, or 5 when they are not in "
                     "planes of nodes: they must be in the same fix mpm/boundary",
                     FACE_NAME[face], FACE_NAME[face ^ 1]);
      }
    }
    for (const auto &list : nodes) {
      if (!faces_are_near(list.faces, face / 2)) continue;
      if (decides())
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/boundary separate and friction need at least 3 cells between opposite "
                   "faces, or 5 when they are not in planes of nodes");
      for (const auto &f : list.faces)
        if (f.cut && f.axis == face / 2)
          error->all(FLERR, Error::NOLASTLINE,
                     "Fix mpm/boundary faces that are not in planes of nodes of fix mpm {} must be "
                     "at least 5 cells apart: change its spacing or origin",
                     list.field->id());
    }
  }
  motion_step = -1;
  placed = false;
  for (auto &list : nodes) list.around.known = false;
  in_trials = false;
  steps = 0;
  too_thin.begin();
  not_touched.begin();
}

/* ----------------------------------------------------------------------
   regions: their state at the start of the first step. A run may start between two steps of the cycle
   (keyword every of fix mpm); then it is the state at the last step of the cycle
------------------------------------------------------------------------- */

void FixMPMBoundary::setup(int)
{
  if (!region_moves()) return;
  evaluate_in_step(lmp, true, [&] {
    region->prematch();
  });
  const auto *field = MPMField::all(lmp)[0];
  if (!past.acted || field->steps_to_next() == field->options.every)
    for (int k = 0; k < 4; k++) past.region[k] = *MPMRegionMotion::of(region)[k];
  placed = true;
}

/* ----------------------------------------------------------------------
   faces of the box in terms of nodes
------------------------------------------------------------------------- */

FixMPMBoundary::Face::Face(const MPMField &field, const Domain &box, int face) :
    axis(face / 2), inward(face % 2 ? -1 : 1)
{
  const double x = face % 2 ? box.boxhi[axis] : box.boxlo[axis];
  const double h = field.lattice.h, origin = field.lattice.origin[axis];
  plane = (int) std::lround((x - origin) / h);
  const double plane_x = origin + plane * h;
  if (fabs(x - plane_x) > ON_SURFACE * h) cut_weights(field, x);
  contact = contact_of(field, x);
}

FixMPMBoundary::Faces FixMPMBoundary::faces_on_lattice(const MPMField &field) const
{
  Faces faces;
  for (int face : face_list) faces.emplace_back(field, *domain, face);
  return faces;
}

/* ----------------------------------------------------------------------
   true when the planes of both faces of an axis have images inside that are the same nodes
------------------------------------------------------------------------- */

bool FixMPMBoundary::faces_are_near(const Faces &faces, int axis)
{
  const Face *lo = nullptr, *hi = nullptr;
  for (const auto &f : faces)
    if (f.axis == axis) (f.inward > 0 ? lo : hi) = &f;
  if (!lo || !hi) return false;
  return hi->plane - lo->plane < (lo->cut || hi->cut ? 5 : 3);
}

/* ----------------------------------------------------------------------
   a rank with nodes near a mirror plane needs the plane and the images
------------------------------------------------------------------------- */

void FixMPMBoundary::extend_topology(MPMField &field)
{
  if (!acts_on(field)) return;
  if (seeks || follows) extend_to_approaches(field);
  if (region) return extend_across(field);
  Grid &grid = field.grid;
  const auto faces = faces_on_lattice(field);
  for (auto &list : nodes)
    if (list.field == &field) list.faces = faces;

  // blocks that are added are looked at, too: images of images at edges, and narrow channels

  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++)
    for (const auto &face : faces) {
      int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
      const int first = std::max(b[face.axis] * grid.side, face.begin());
      const int last = std::min(b[face.axis] * grid.side + grid.side - 1, face.end());
      if (first > last) continue;
      std::array<int, 3> needed = {2 * face.plane - last, 2 * face.plane - first, face.plane};
      if (face.cut) needed = {face.begin(), face.end(), face.end()};
      for (const int k : needed) {
        b[face.axis] = k >> grid.shift_bits;
        grid.activate(b);
      }
    }
}

/** Does the wall need this block? Mirrors and cut faces need both sides, regions need blocks along several axes. */
bool FixMPMBoundary::looks_at_all(const MPMField &field, const Grid::Block &block) const
{
  if (!acts_on(field)) return false;
  if (region) return true;
  const int side = field.grid.side;
  for (const auto &list : nodes)
    for (const auto &face : list.faces) {
      const int first = block.b[face.axis] * side;
      int begin = face.begin(), end = face.end();
      if (seeks) (face.inward > 0 ? end : begin) += face.inward * SOUGHT;
      if (list.field == &field && first <= end && first + side > begin) return true;
    }
  return false;
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::topology_changed(MPMField &field)
{
  for (auto &list : nodes) {
    if (list.field != &field) continue;
    const auto around = list.around;
    list = {&field, faces_on_lattice(field), {}, {}, {}, {}};
    list.around = around;
    if (!region)
      list_face_nodes(list);
    else if (!region_moves())
      list_region_nodes(list);
  }
}

/* ----------------------------------------------------------------------
   orbits or columns at the faces, and single nodes deep behind them
------------------------------------------------------------------------- */

void FixMPMBoundary::list_face_nodes(FieldNodes &list)
{
  const Grid &grid = list.field->grid;
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    const auto &block = grid.blocks[ib];
    for (std::size_t f = 0; f < list.faces.size(); f++) {
      const Face &face = list.faces[f];
      const int last = face.plane - face.inward * (DEPTH + 1);
      const int lo = block.b[face.axis] * grid.side, hi = lo + grid.side - 1;
      const int start = face.cut ? face.first : face.plane;
      const bool line = (face.cut || decides()) && start >= lo && start <= hi;
      const bool beyond = !face.cut && (face.inward > 0 ? lo <= last : hi >= last);
      if (!line && !beyond) continue;
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        if (block.alias >> n & 1) continue;
        int index[3];
        grid.node_index(block, n, index);
        if (line && index[face.axis] == start) list.list_line(f, index);
        if (beyond && (last - index[face.axis]) * face.inward >= 0) {
          Single s = {(int64_t) ib * NODES_PER_BLOCK + n};
          s.normal[face.axis] = face.inward;
          list.singles.push_back(s);
        }
      }
    }
  }

  // lines of one face share no nodes, lines of two faces do at edges: the same order on all ranks

  std::stable_sort(list.lines.begin(), list.lines.end(), [](const Line &a, const Line &b) {
    return a.face < b.face;
  });

  // stick: each component is odd about all faces; slip: the normal component is odd about its own face

  if (kind == STICK) {
    const bool prescribed[3] = {velocity[0].given, velocity[1].given, velocity[2].given};
    list.list_orbits(prescribed, -1);
  } else if (!decides()) {
    for (int d = 0; d < grid.lattice.dim; d++) {
      const bool prescribed[3] = {d == 0, d == 1, d == 2};
      list.list_orbits(prescribed, d);
    }
  }
}

/* ----------------------------------------------------------------------
   the line of nodes along the normal through this node: the first node of a cut face, or one in the mirror plane
------------------------------------------------------------------------- */

void FixMPMBoundary::FieldNodes::list_line(int f, const int *index)
{
  const Face &face = faces[f];
  auto at = [&](int along) {
    int k[3] = {index[0], index[1], index[2]};
    k[face.axis] = along;
    return field->grid.locate(k);
  };
  Line line = {f, FREE, true, {}};
  if (face.cut) {
    for (int j = 0; j < face.nweight; j++) {
      line.node[j] = at(face.first + j);
      if (line.node[j] < 0) return;    // out of reach of points, as is the face then
    }
  } else {
    line.node[0] = at(face.plane);
    for (int j = 1; j <= DEPTH; j++) {
      int64_t &inside = line.node[j], &image = line.node[DEPTH + j];
      inside = at(face.plane + face.inward * j);
      image = at(face.plane - face.inward * j);
      if (inside < 0 || image < 0) inside = image = -1;    // both out of reach of points
    }
  }
  lines.push_back(line);
}

/* ----------------------------------------------------------------------
   nodes between the mirrors of this axis, or of all axes (-1), each with all its images in these mirrors
------------------------------------------------------------------------- */

void FixMPMBoundary::FieldNodes::list_orbits(const bool *prescribed, int axis)
{
  const Grid &grid = field->grid;
  const Face *mirror[3][2] = {};    // [axis][side], null: none
  for (const auto &face : faces)
    if (!face.cut && (axis < 0 || axis == face.axis)) mirror[face.axis][face.inward < 0] = &face;

  struct Image {
    int index, sign;
  };
  std::vector<Image> images[3];
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    const auto &block = grid.blocks[ib];
    const bool near = std::any_of(faces.begin(), faces.end(), [&](const Face &face) {
      const int lo = block.b[face.axis] * grid.side;
      return &face == mirror[face.axis][face.inward < 0] && lo <= face.plane + DEPTH &&
          lo + grid.side > face.plane - DEPTH;
    });
    if (!near) continue;
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (block.alias >> n & 1) continue;
      int index[3], wall[3], inner[3];
      grid.node_index(block, n, index);
      bool inside = true, fixed = false, held = false;
      for (int d = 0; d < 3; d++) {
        images[d].assign(1, {index[d], 1});
        wall[d] = inner[d] = index[d];
        for (int side = 0; side < 2; side++) {
          const Face *const face = mirror[d][side], *const opposite = mirror[d][1 - side];
          if (!face) continue;
          const int depth = face->inward * (index[d] - face->plane);
          inside = inside && depth >= 0;
          fixed = fixed || depth == 0;
          if (depth == 0) inner[d] += face->inward;
          held = held || (depth == 0 && opposite && inner[d] == opposite->plane);
          if (depth <= DEPTH) wall[d] = face->plane;
        }
        // images of images are included: the list grows
        for (std::size_t k = 0; inside && k < images[d].size(); k++)
          for (const Face *face : mirror[d]) {
            if (!face) continue;
            const Image image = {2 * face->plane - images[d][k].index, -images[d][k].sign};
            const int depth = face->inward * (face->plane - image.index);
            bool skip = depth > DEPTH || depth <= 0;
            for (const auto &known : images[d]) skip = skip || known.index == image.index;
            if (!skip) images[d].push_back(image);
          }
      }
      if (!inside) continue;

      Orbit orbit;
      orbit.first = (int) members.size();
      orbit.fixed = fixed;
      std::copy_n(prescribed, 3, orbit.prescribed);
      for (const auto &x : images[0])
        for (const auto &y : images[1])
          for (const auto &z : images[2]) {
            const int k[3] = {x.index, y.index, z.index};
            const int64_t node = grid.locate(k);
            if (node >= 0)    // else out of reach of points
              members.push_back({node, x.sign * y.sign * z.sign});
          }
      orbit.last = (int) members.size();
      orbit.inner = held ? -1 : grid.locate(inner);
      orbit.wall = grid.locate(wall);
      if (orbit.wall < 0) orbit.wall = members[orbit.first].node;
      if (fixed || orbit.last > orbit.first + 1)
        orbits.push_back(orbit);
      else
        members.pop_back();
    }
  }
}

/* ----------------------------------------------------------------------
   Nodes inside the region or on its surface, for the state of the region that it has now.

   When the surface of a moving region crosses a plane of nodes, the nodes are not taken or let go at
   once, but over half a node spacing outside: a node there goes (1 - s^3)^3 of the way to the velocity
   of the wall in each step, s = 1 at the end. Material in a grip had no part in the strain of the rest of
   the body; if it is let go at once, it is not in equilibrium and makes waves as high as the force
   itself. A node that is taken at once gets the missing momentum in one step. With slow
   motion the node slips behind the wall before it is let go: by (1 - share)/share of the change that its
   acceleration gives in each step, which is little at first because of the power of s.

   Implicit steps have no hand-over (follows): to go a part of the way is no projection, and in equilibrium a node that goes
   half the way in each step lags as much as one that is not held. Lines through the surface hold the material in front of it,
   as for separate. Where there is also material behind, in a grip, single nodes up to half a spacing outside act, fully.
------------------------------------------------------------------------- */

void FixMPMBoundary::list_region_nodes(FieldNodes &list)
{
  const MPMField &field = *list.field;
  Grid &grid = list.field->grid;
  const int dim = field.lattice.dim;
  const double h = field.lattice.h;
  const bool moves = region_moves(), hands_over = moves && kind != SEPARATE, across = acts_across();
  const double taken = (hands_over ? HAND_OVER : ON_SURFACE) * h;
  const double far = FAR * h, next = across ? 1.001 * h : taken;
  const bool box_known = region->bboxflag && !moves;
  const double lo[3] = {region->extent_xlo, region->extent_ylo, region->extent_zlo};
  const double hi[3] = {region->extent_xhi, region->extent_yhi, region->extent_zhi};
  const double radius = 0.5 * (grid.side - 1) * h * sqrt((double) dim);
  const double beyond = across ? h : ON_SURFACE * h;
  std::vector<Single> outside;    // next to the surface

  list.singles.clear();
  if (!moves) region->prematch();
  const auto has_mass = [&](std::size_t block) {
    const double *record = grid.record((int64_t) block * NODES_PER_BLOCK);
    double mass = 0.0;
    for (int n = 0; n < NODES_PER_BLOCK; n++, record += grid.nreal) mass += record[3];
    return mass > 0.0;
  };
  const bool looks_for_mass = moves && holds_surface();
  std::vector<char> massive;
  for (std::size_t ib = 0; looks_for_mass && ib < grid.blocks.size(); ib++)
    massive.push_back(has_mass(ib));
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    // most blocks are out of reach, and blocks around a moving region that is away from the body have nothing to hold

    const int *const around = grid.blocks[ib].slot;
    if (looks_for_mass && std::none_of(around, around + 27, [&](int block) {
          return block >= 0 && massive[block];
        }))
      continue;
    const int64_t first_node = (int64_t) ib * NODES_PER_BLOCK;
    double first[3], last[3], mid[3];
    grid.node_position(first_node, first);
    grid.node_position(first_node + NODES_PER_BLOCK - 1, last);
    bool near = true;
    for (int d = 0; d < 3; d++) {
      mid[d] = 0.5 * (first[d] + last[d]);
      if (box_known && (last[d] < lo[d] - beyond || first[d] > hi[d] + beyond)) near = false;
    }
    if (near && region->nregion == 1) {
      const double distance = surface->distance(mid, far);
      near = distance <= radius + h || distance >= far;
    }
    if (!near) continue;

    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (grid.blocks[ib].alias >> n & 1) continue;
      double x[3];
      grid.node_position(first_node + n, x);
      Single s = {first_node + n};
      if (!region->match(x[0], x[1], x[2])) {
        const double gap = surface->distance(x, next);
        if (across && gap > ON_SURFACE * h && gap < next) {
          s.distance = gap;
          outside.push_back(s);
        }
        if (gap >= taken) continue;
        if (gap > ON_SURFACE * h && !follows) s.share = cube(1.0 - cube(gap / taken));
      }
      if (kind != STICK || !follows) surface->normal(x, far, 1.0e-4 * h, s.normal);
      if (region->varshape || across) s.distance = surface->distance(x, far);
      list.singles.push_back(s);
    }
  }
  if (!across) return;
  list_crossings(list, outside);
  if ((!hands_over || follows) && !holds_surface()) take_off_lines(list);
}

/* ----------------------------------------------------------------------
   Lines of nodes through the surface of a region that separates, along the axis that is nearest to the
   normal. Nodes inside that are on such a line do not act on their own.

   Next to edges, and where the region is thin, nodes of a line may be nearer to another face, or beyond it.
   There, whether a line acts depends on where the material is, see is_in_front(). Such lines are found from the
   nodes outside, which are nearest to the face that they look at.
------------------------------------------------------------------------- */

void FixMPMBoundary::list_crossings(FieldNodes &list, const std::vector<Single> &outside)
{
  list.crossings.clear();
  list.knots.clear();
  list.looked_at.clear();
  const MPMField &field = *list.field;
  const double h = field.lattice.h;
  std::vector<int64_t> ahead;
  for (const auto &single : list.singles) {
    if (!(single.distance <= ON_SURFACE * h && single.distance >= -h)) continue;
    Crossing c = {};
    if (!find_crossing(list, single, c)) continue;
    if (follows) c.front = Crossing::NEAR_OTHERS;
    if (c.inside < c.n) ahead.push_back(c.node[c.inside]);
    list.crossings.push_back(c);
  }
  std::sort(ahead.begin(), ahead.end());
  for (Single single : outside) {
    if (std::binary_search(ahead.begin(), ahead.end(), single.node)) continue;
    double x[3];
    field.grid.node_position(single.node, x);
    surface->normal(x, FAR * h, 1.0e-4 * h, single.normal);
    Crossing c = {};
    if (find_crossing(list, single, c)) list.crossings.push_back(c);
    if (!too_thin.told() && looks_at_blade(field, single, c)) list.looked_at.push_back(c);
  }

  // lines along one axis share no nodes; lines along two axes do, and so do lines through both faces of a thin plate:
  // the same order on all ranks

  std::stable_sort(list.crossings.begin(), list.crossings.end(),
                   [](const Crossing &a, const Crossing &b) {
                     if (a.front != b.front || a.axis != b.axis || a.front == Crossing::SOUND)
                       return std::tie(a.front, a.axis) < std::tie(b.front, b.axis);
                     const bool up[2] = {a.normal[a.axis] > 0.0, b.normal[b.axis] > 0.0};
                     return std::tie(up[0], a.place) < std::tie(up[1], b.place);
                   });
  if (follows && kind == STICK) find_lines_alone(list);
  if (holds_surface()) list_knots(list);
}

/* ----------------------------------------------------------------------
   Nodes that are on lines do not act on their own. With slip and friction, a surface that moves across the lattice hands
   nodes over, see list_region_nodes(). Lines cannot do this, and there are none in that case
------------------------------------------------------------------------- */

void FixMPMBoundary::take_off_lines(FieldNodes &list)
{
  const MPMField &field = *list.field;
  auto &crossings = list.crossings;
  const bool hands_over = region_moves() && kind == SLIP && !follows;
  if (hands_over)
    crossings.erase(std::remove_if(crossings.begin(), crossings.end(),
                                   [&](const Crossing &c) {
                                     double x[3], v[3];
                                     field.grid.node_position(c.base, x);
                                     x[c.axis] = c.surface;
                                     wall.velocity(x, v);
                                     return fabs(MathExtra::dot3(v, c.normal)) >
                                         ALONG * MathExtra::len3(v);
                                   }),
                    crossings.end());
  std::vector<int64_t> on_lines;
  for (const auto &c : crossings)
    if (c.front != Crossing::NEAR_OTHERS)
      on_lines.insert(on_lines.end(), c.node, c.node + (hands_over ? c.n : c.inside));
  std::sort(on_lines.begin(), on_lines.end());
  auto &singles = list.singles;
  singles.erase(std::remove_if(singles.begin(), singles.end(),
                               [&](const Single &single) {
                                 return std::binary_search(on_lines.begin(), on_lines.end(),
                                                           single.node);
                               }),
                singles.end());
}

/* ----------------------------------------------------------------------
   The line with this node as the last one inside or, if the node is outside, as the first one outside. False if there is
   none, or if it has nodes where the surface is not smooth
------------------------------------------------------------------------- */

bool FixMPMBoundary::find_crossing(FieldNodes &list, const Single &single, Crossing &c)
{
  const MPMField &field = *list.field;
  const Grid &grid = field.grid;
  const double h = field.lattice.h, far = FAR * h;
  const bool is_outside = single.distance > ON_SURFACE * h;
  int index[3];
  double x[3], at[3];
  grid.node_index(single.node, index);
  field.lattice.node_position(index, x);
  const double *const n = single.normal;
  for (int d = 1; d < field.lattice.dim; d++)    // round-off must not decide
    if (fabs(n[d]) > fabs(n[c.axis]) + EQUAL) c.axis = d;
  const int a = c.axis, outward = n[a] > 0.0 ? 1 : -1;
  const double slope = fabs(n[a]);
  if (slope < 0.5) return false;    // the normal is not known

  // where does the line cross the surface, and is this node the last one before it? On the surface itself, round-off
  // decides on the side, and some regions give no side: look a little outside

  const double outside = 1.0e-3 * h;
  double way = -single.distance / slope + outside, distance = 0.0;
  MathExtra::copy3(x, at);
  bool known = true;
  for (int round = 0; round < 2 && known; round++) {
    at[a] = x[a] + outward * way;
    distance = surface->distance(at, far);
    known = fabs(distance) < far;
    way -= distance / slope - outside;
  }
  if (!known) return false;
  if (is_outside) {    // the line may miss an edge
    if (way - outside > -ON_SURFACE * h || way - outside < -(1.0 + ON_SURFACE) * h) return false;
    at[a] = x[a] + outward * (way + 0.05 * h);    // an edge itself has no normal
    if (fabs(surface->distance(at, far) - 0.05 * h * slope) > 0.02 * h) return false;
  }
  at[a] = x[a] + outward * way;
  way -= outside;
  if (way > (1.0 - ON_SURFACE) * h) return false;
  if (is_outside) at[a] += outward * 0.05 * h;
  surface->normal(at, far, 1.0e-4 * h, c.normal);
  at[a] = x[a] + outward * (is_outside ? way : std::max(way, 0.0));
  const auto along = [&](const double *place) {
    double normal[3];
    surface->normal(place, far, 1.0e-4 * h, normal);
    return MathExtra::dot3(normal, c.normal) > SMOOTH;
  };
  if (!(MathExtra::dot3(n, c.normal) > SMOOTH)) return false;

  int first;
  double weight[4];
  c.n = weights_at(field, a, outward, at[a], first, weight);
  const int last_inside = index[a] - (is_outside ? outward : 0);
  for (int k = 0; k < c.n; k++) {
    const int from = outward > 0 ? k : c.n - 1 - k;
    int node[3] = {index[0], index[1], index[2]};
    double place[3] = {x[0], x[1], x[2]};
    node[a] = first + from;
    place[a] = field.lattice.origin[a] + h * node[a];
    const int ahead = outward * (node[a] - last_inside);
    if (ahead > 0 && region->match(place[0], place[1], place[2])) return false;
    if (!is_outside && ahead < 0 && !(region->match(place[0], place[1], place[2]) && along(place)))
      return false;
    const int at_place = node[a];
    node[a] = field.lattice.wrap(a, node[a]);
    // regions have no periodic images: this node would have material at the other end of the box
    if (ahead <= 0 && node[a] != at_place) return false;
    c.node[k] = grid.locate(node);
    c.weight[k] = weight[from];
    if (ahead <= 0) c.inside = k + 1;
  }
  int behind[3] = {index[0], index[1], index[2]};
  behind[a] = field.lattice.wrap(a, outward > 0 ? first - 1 : first + c.n);
  c.behind = grid.locate(behind);
  c.base = single.node;
  c.surface = at[a];
  const double cosine = fabs(c.normal[a]);
  const double surface_at = outward * ((at[a] - field.lattice.origin[a]) / h);
  c.full = crossed_contact(list, cosine, surface_at);
  c.place = outward > 0 ? first : -first - c.n + 1;
  c.depth = (surface_at - c.place) * cosine;

  // is there another face within reach of the material in front?

  if (is_outside) c.front = Crossing::NEAR_OTHERS;
  const double surface_x = x[a] + outward * way;
  for (const double deep : {RESOLVED, 2.0, FELT_THROUGH}) {
    at[a] = surface_x - outward * deep * h;
    if (region->match(at[0], at[1], at[2])) continue;
    if (deep == RESOLVED) {
      at[a] = surface_x - outward * 0.05 * h;    // a line along the edge of the region is not in it
      c.in_plate = region->match(at[0], at[1], at[2]);
    }
    if (!is_outside) c.front = Crossing::THIN_PLACE;
  }
  return true;
}

/* ----------------------------------------------------------------------
   Is this node outside, in front of the edge of a blade or of a wire? Then c is the line of nodes from it into the
   region
------------------------------------------------------------------------- */

bool FixMPMBoundary::looks_at_blade(const MPMField &field, const Single &single, Crossing &c) const
{
  const double h = field.lattice.h, *const n = single.normal;
  const int dim = field.lattice.dim;
  if (n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0) return false;
  const auto match = [&](const double *x) {
    return region->match(x[0], x[1], x[2]);
  };
  double x[3], middle[3];
  field.grid.node_position(single.node, x);
  for (int d = 0; d < 3; d++) middle[d] = x[d] - (single.distance + RESOLVED * h) * n[d];
  bool narrow = false;
  if (match(middle)) {
    double t[2][3] = {{-n[1], n[0], 0.0}, {0.0, 0.0, 0.0}};
    if (dim == 3) {
      const double axis[3] = {fabs(n[0]) < 0.6 ? 1.0 : 0.0, fabs(n[0]) < 0.6 ? 0.0 : 1.0, 0.0};
      MathExtra::cross3(n, axis, t[0]);
      MathExtra::norm3(t[0]);
      MathExtra::cross3(n, t[0], t[1]);
    }
    const int ndirections = dim == 3 ? 4 : 1;
    for (int k = 0; k < ndirections && !narrow; k++) {
      double side[2][3];
      for (int d = 0; d < 3; d++) {
        const double along = h * 0.5 * RESOLVED *
            (k < 2 ? t[k][d] : sqrt(0.5) * (t[0][d] + (k == 2 ? t[1][d] : -t[1][d])));
        side[0][d] = middle[d] + along;
        side[1][d] = middle[d] - along;
      }
      narrow = !match(side[0]) && !match(side[1]);
    }
  } else if (const Region &part = surface->part_near(x, FAR * h); part.bboxflag) {
    const double size[3] = {part.extent_xhi - part.extent_xlo, part.extent_yhi - part.extent_ylo,
                            part.extent_zhi - part.extent_zlo};
    narrow = std::count_if(size, size + dim, [h](double extent) {
               return extent < RESOLVED * h;
             }) > 1;
  }
  if (!narrow) return false;

  c = {};
  for (int d = 1; d < dim; d++)
    if (fabs(n[d]) > fabs(n[c.axis])) c.axis = d;
  int index[3];
  field.grid.node_index(single.node, index);
  c.base = single.node;
  c.n = 3;
  c.inside = 2;
  c.front = Crossing::NEAR_OTHERS;
  MathExtra::copy3(n, c.normal);
  c.depth = 2.0 * fabs(n[c.axis]) - single.distance / h;
  for (int k = 2; k >= 0; k--) {
    c.node[k] = field.grid.locate(index);
    index[c.axis] = field.lattice.wrap(c.axis, index[c.axis] - (n[c.axis] > 0.0 ? 1 : -1));
  }
  return true;
}

/* ----------------------------------------------------------------------
   returns the distance from the region for a position at the start of the step. The region is already where it will be
   at the end, so the position is moved with it
------------------------------------------------------------------------- */

std::function<double(const double *)>
FixMPMBoundary::distance_from_region(const MPMField &field, double dt, double more) const
{
  const double h = field.lattice.h, far = MPMWallGap::farthest(field, more);
  if (!region_moves())
    return [this, far, h](const double *x) {
      return surface->gap(x, far, h);
    };
  return [this, far, h, dt](const double *x) {
    double y[3], v[3];
    wall.velocity(x, v);
    for (int d = 0; d < 3; d++) y[d] = x[d] + dt * v[d];
    return surface->gap(y, far, h);
  };
}

/* ----------------------------------------------------------------------
   gradient = (R - I)/dt for a rotation about a unit axis through o
------------------------------------------------------------------------- */

void FixMPMBoundary::Wall::rotate(double angle, const double *u, const double *o, double dt)
{
  uniform = false;
  MathExtra::copy3(o, origin);
  const double s = sin(angle) / dt, half = sin(0.5 * angle);
  const double c = 2.0 * half * half / dt;    // (1 - cos)/dt
  const double K[3][3] = {{0.0, -u[2], u[1]}, {u[2], 0.0, -u[0]}, {-u[1], u[0], 0.0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      gradient[i][j] = s * K[i][j] + c * (u[i] * u[j] - (i == j ? 1.0 : 0.0));
}

/* ----------------------------------------------------------------------
   for the total frame: nodes have moved from X to x = X + T X + m, so s + G (x - o) becomes
   s + G (m - o) + (G + G T) X
------------------------------------------------------------------------- */

void FixMPMBoundary::Wall::refer()
{
  if (uniform) return;
  double product[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      shift[i] += gradient[i][j] * (moved[j] - origin[j]);
      product[i][j] = gradient[i][j];
      for (int k = 0; k < 3; k++) product[i][j] += gradient[i][k] * turned[k][j];
    }
  std::copy_n(product[0], 9, gradient[0]);
  std::fill_n(origin, 3, 0.0);
}

/* ----------------------------------------------------------------------
   velocity during the step of the material that is at x at its end. It came from y,
   x = y + dt (s + G (y - o)): with R = 1 + dt G, s + G R^T (x - o - dt s), G R^T = -G^T.
------------------------------------------------------------------------- */

FixMPMBoundary::Wall FixMPMBoundary::Wall::at_end_of_step(double dt) const
{
  Wall end = *this;
  for (int i = 0; i < 3; i++) {
    end.origin[i] += dt * shift[i];
    for (int j = 0; j < 3; j++) end.gradient[i][j] = -gradient[j][i];
  }
  return end;
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::Wall::velocity(const MPMField &field, int64_t node, double *v) const
{
  double x[3];
  if (!uniform) field.grid.node_position(node, x);
  velocity(x, v);
}

void FixMPMBoundary::Wall::velocity(const double *x, double *v) const
{
  MathExtra::copy3(shift, v);
  if (uniform) return;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) v[i] += gradient[i][j] * (x[j] - origin[j]);
}

/* ----------------------------------------------------------------------
   half of the change of the velocity of the wall, at the node, since the last step. An impulse R dt of the wall takes its
   node from the velocity u to v, with which points then go from x to x'. It adds R dt (u + v)/2 to the kinetic and stored
   energy, up to terms that the next step cancels, as the forces at x do work on half of the way to x and half of the way
   to x'. R dt v would differ from it by R (v - u) dt/2 in each step, which adds up where a mass is shaken.
------------------------------------------------------------------------- */

void FixMPMBoundary::Wall::half_change(const MPMField &field, int64_t node, double *v) const
{
  double x[3];
  for (int d = 0; d < 3; d++) v[d] = 0.5 * (shift[d] - before[d]);
  if (uniform) return;
  field.grid.node_position(node, x);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      v[i] += 0.5 *
          (gradient[i][j] * (x[j] - origin[j]) - gradient_before[i][j] * (x[j] - origin_before[j]));
}

/* ----------------------------------------------------------------------
   A region acts on nodes that are inside at the start of a step: one that crosses more than a
   cell in a step can pass through a body without touching it. Not all regions give their
   extent, so this checks displacements alone, not rotations.
------------------------------------------------------------------------- */

void FixMPMBoundary::check_speed(double dt)
{
  const double along[3] = {wall.shift[0], wall.shift[1],
                           domain->dimension == 3 ? wall.shift[2] : 0.0};
  const double way = dt * MathExtra::len3(along);
  // LAMMPS of 2025 gives no value to the angle of regions that do not turn
  if (!std::isfinite(way) || (region->rotateflag && !std::isfinite(region->theta)))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/boundary {}: the motion of its region {} is not finite at step {}", id,
               region_id, update->ntimestep);
  for (const auto &list : nodes) {
    const double h = list.field->lattice.h;
    if (warned || !(way > (seeks ? COMES_FROM : 1.0) * h)) continue;
    warned = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/boundary {}: its region crosses {:.3g} cells of fix mpm {} in step "
                     "{} and can pass through material without touching it: use a smaller "
                     "timestep; this is said only once",
                     id, way / h, list.field->id(), update->ntimestep);
  }
}

/* ----------------------------------------------------------------------
   the motion of the wall during this step, and the nodes inside a moving region.
   Nodes of regions are found with the position at the start of the step, to which positions of
   points belong; the motion goes from there to the end of the step.
------------------------------------------------------------------------- */

void FixMPMBoundary::update_motion(double dt)
{
  if (motion_step == update->ntimestep) return;
  motion_step = update->ntimestep;
  steps++;

  wall = {};
  wall.uniform = true;
  MathExtra::copy3(past.shift, wall.before);
  std::copy_n(past.gradient[0], 9, wall.gradient_before[0]);
  MathExtra::copy3(past.origin, wall.origin_before);
  const bool variables = region_moves() || !velocity[0].variable.empty() ||
      !velocity[1].variable.empty() || !velocity[2].variable.empty() || !rate.variable.empty();
  double *const old = past.region;
  if (region_moves()) {
    // other users may have evaluated the region since then
    for (int k = 0; k < 4; k++) *MPMRegionMotion::of(region)[k] = old[k];
    for (auto &list : nodes) list_region_nodes(list);
  }

  evaluate_in_step(lmp, variables, [&] {
    if (region_moves()) region->prematch();
    for (int d = 0; d < 3; d++) {
      const double value = evaluate(lmp, velocity[d]);
      wall.shift[d] = by_displacement ? (value - past.displaced[d]) / dt : value;
      past.displaced[d] = value;
    }
    if (rotating()) wall.rotate(evaluate(lmp, rate) * dt, axis, center, dt);
  });
  if (nodes[0].field->options.total) {
    std::copy_n(past.turned[0], 9, wall.turned[0]);
    MathExtra::copy3(past.moved, wall.moved);
    wall.refer();
    for (int i = 0; i < 3; i++) {
      past.moved[i] += dt * wall.shift[i];
      for (int j = 0; j < 3; j++) past.turned[i][j] += dt * wall.gradient[i][j];
    }
  }
  if (region_moves()) {
    const auto motion = MPMRegionMotion::of(region);
    for (int d = 0; d < 3; d++) wall.shift[d] = (*motion[d] - old[d]) / dt;
    check_speed(dt);
    if (region->rotateflag) {
      double origin[3];
      MathExtra::add3(MPMRegionMotion::point_of(region), old, origin);
      wall.rotate(region->theta - old[3], MPMRegionMotion::axis_of(region), origin, dt);
    }
    if (region->varshape)
      for (auto &list : nodes)
        for (auto &s : list.singles) {
          const MPMField &field = *list.field;
          const double far = FAR * field.lattice.h;
          double x[3];
          field.grid.node_position(s.node, x);
          const double distance = surface->distance(x, far);
          s.growth = 0.0;
          if (std::max(fabs(distance), fabs(s.distance)) >= far) continue;

          // the normal speed of the surface replaces that of the rigid motion

          double v[3];
          wall.velocity(field, s.node, v);
          s.growth = (s.distance - distance) / dt - MathExtra::dot3(v, s.normal);
        }
    for (int k = 0; k < 4; k++) old[k] = *motion[k];
    const bool hands_over = kind == SLIP && !follows && !holds_surface();
    if (hands_over && acts_across())
      for (auto &list : nodes) take_off_lines(list);
  }
  if (!past.acted) MathExtra::copy3(wall.shift, wall.before);
  // solvers evaluate forces and motion of the same time, and nodes of the total frame are the material
  wall.changes = past.acted && !in_implicit_steps;
  const bool follow = !wall.uniform && !nodes[0].field->options.total;
  const Wall end = follow ? wall.at_end_of_step(dt) : wall;
  MathExtra::copy3(end.shift, past.shift);
  std::copy_n(end.gradient[0], 9, past.gradient[0]);
  MathExtra::copy3(end.origin, past.origin);
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::act(double dt, Stage stage)
{
  const bool count = stage == STEP;
  update_motion(dt);
  if (count) {
    std::fill_n(impulse, 6, 0.0);
    dt_last = dt;
    reaction_known = false;
  }
  if (heating && count) heating->begin_step();
  const Wall in_step = wall;
  if (stage == START && !wall.uniform) wall = wall.at_end_of_step(dt);
  for (auto &list : nodes) {
    const auto &faces = list.faces;
    auto &ledger = list.field->ledger;
    if (count && kind == SEPARATE && !in_trials) find_gaps(list, dt);
    if (count && decides()) find_water(list, dt);
    now = {count,
           stage == MAPPED_BACK || stage == AGAIN,
           ledger.on ? &ledger : nullptr,
           0.0,
           0.0,
           0.0,
           0.0,
           (int) (&list - nodes.data()),
           nullptr,
           nullptr,
           1.0};
    if (count && wall.uniform && !list.field->kernel.affine)
      now.old_share = list.field->options.flip;

    // cuts: at edges, tangential components of one face are normal ones of another: these come last, so
    // that no material gets out

    // in trials: the contact of this line or node
    const bool tries = in_trials && (decides() || follows) && list.field == tried;
    const auto touch = [&](std::size_t k) {
      now.touch = tries ? &touches[k] : nullptr;
    };
    const std::size_t nlines = list.lines.size(), ncrossings = list.crossings.size();
    if (tries && count) rub_nodes(list.field->grid);
    for (const bool last : {false, true})
      for (std::size_t k = 0; k < nlines; k++)
        if (faces[list.lines[k].face].cut && (!last || kind == STICK || friction > 0.0)) {
          touch(k);
          act_on_cut(list, list.lines[k], last);
        }
    for (std::size_t k = 0; k < nlines; k++)
      if (!faces[list.lines[k].face].cut) {
        touch(k);
        act_on_column(list, list.lines[k]);
      }
    now.touch = nullptr;
    for (const auto &orbit : list.orbits) act_on_orbit(list, orbit);
    held_by_lines.clear();
    if (count) check_width(list);
    for (std::size_t k = 0; k < ncrossings; k++) {
      touch(nlines + k);
      if (!list.crossings[k].in_knot) act_on_crossing(list, list.crossings[k]);
    }
    for (auto &knot : list.knots) act_on_knot(list, knot);
    if (tries && follows)
      for (std::size_t k = 0; k < list.approaches.size(); k++) {
        const auto &line = list.approaches[k];
        if (touches[nlines + ncrossings + list.singles.size() + k].active)
          held_by_lines.insert(held_by_lines.end(), line.node, line.node + line.n);
      }
    std::sort(held_by_lines.begin(), held_by_lines.end());
    for (std::size_t k = 0; k < list.singles.size(); k++) {
      Single &single = list.singles[k];
      if (!held_by_lines.empty() &&
          std::binary_search(held_by_lines.begin(), held_by_lines.end(), single.node))
        continue;
      touch(nlines + ncrossings + k);
      now.unit = list.field->grid.record(single.node)[3];
      act_on_single(list, single);
    }
    now.touch = nullptr;
    if (tries) {
      const std::size_t first = nlines + ncrossings + list.singles.size();
      for (std::size_t k = 0; k < list.approaches.size(); k++)
        act_on_approach(list, list.approaches[k], touches[first + k]);
    }
    if (count) ledger.boundary += now.kinetic * force->mvv2e;
    if (count) ledger.driven += now.driven * force->mvv2e;
    if (count && ledger.on) ledger.transfer += now.collided * force->mvv2e;
  }
  wall = in_step;
  if (count) past.acted = 1;
  if (count && looks_at_width()) report_width();
}

/* ----------------------------------------------------------------------
   reaction of the wall at nodes. push: impulse along the normal, of_water: the part that water bears, needed: the
   impulse along the wall for the material to stick. Returns the share of the last one that friction gives, and the
   contact
------------------------------------------------------------------------- */

double FixMPMBoundary::slide_share(Contact &contact, double push, double of_water,
                                   double needed) const
{
  if (kind == STICK) {
    contact = STUCK;
    if (now.touch && !now.counting) now.touch->push += now.unit * push;
    return 1.0;
  }
  if (now.touch) {
    contact = now.touch->active ? SLIDING : FREE;
    if (!now.counting) now.touch->push += now.unit * push;
    return 0.0;
  }
  if (!now.decided) {
    contact = SLIDING;
    const double grains = push - of_water;
    if (kind == SEPARATE && push <= std::max(of_water, 0.0)) {
      contact = FREE;
    } else if (friction > 0.0 && grains > 0.0) {
      if (needed > friction * grains) return friction * grains / needed;
      contact = STUCK;
    }
  }
  return contact == STUCK ? 1.0 : 0.0;
}

/* ----------------------------------------------------------------------
   Water in pores presses on walls, too, and bears a part of the impulse of the wall. Only the rest acts between grains
   and wall: friction is proportional to it, and where it would be negative, grains leave a separating wall, pushed by
   the water. Water does not pull at a separating wall.
------------------------------------------------------------------------- */

void FixMPMBoundary::find_water(const FieldNodes &list, double dt)
{
  water.clear();
  if (!pore_pressure(*list.field)) return;
  std::vector<char> near(list.field->grid.blocks.size(), 0);
  const auto mark = [&](int64_t node) {
    if (node >= 0) near[node / NODES_PER_BLOCK] = 1;
  };
  for (const auto &line : list.lines)
    for (int k = 0, n = list.faces[line.face].length(); k < n; k++) mark(line.node[k]);
  for (const auto &crossing : list.crossings) crossing.mark_blocks(near);
  for (const auto &single : list.singles) mark(single.node);
  if (pore_surface_force(*list.field, near, water))
    for (double &w : water) w *= dt;
}

/** Impulse of the water on the wall at n nodes, -1: none; normal: from the wall to the body. */
double FixMPMBoundary::water_on(const int64_t *node, int n, const double *normal) const
{
  double sum = 0.0;
  if (now.decided || water.empty()) return sum;
  for (int k = 0; k < n; k++)
    for (int d = 0; d < 3 && node[k] >= 0; d++) sum -= water[3 * node[k] + d] * normal[d];
  return sum;
}

/** Applies the impulse of the water to the body at a node that the wall has let go: the water does work on the body that it
 *  lifts, as does a wall that moves with it. */
void FixMPMBoundary::push_by_water(Grid &grid, int64_t node, const double *normal)
{
  if (node < 0) return;
  const double *const record = grid.record(node);
  if (!(record[3] > 0.0)) return;
  double v[3] = {0.0, 0.0, 0.0}, along = 0.0;
  for (int d = 0; d < 3; d++) along += water[3 * node + d] * normal[d];
  for (int d = 0; d < grid.lattice.dim; d++) v[d] = record[d] - along * normal[d] / record[3];
  set_velocity(grid, node, v, v, nullptr);
}

/* ----------------------------------------------------------------------
   sets the velocity of a node, also the old one unless null, next to a wall with the velocity V, and books the effect.
   Work is impulse times the velocity with which points are then moved, less half of the change of the velocity of the
   wall, so that a wall at rest works only by friction. The kinetic energy of the nodes changes by the change of velocity
   times the mean of old and new one; the part that is not work is lost, most of it energy that forces had given to nodes
   that cannot move. A node that goes only part of the way slips: its work is that of the velocity for all of it (whole).
------------------------------------------------------------------------- */

void FixMPMBoundary::set_velocity(Grid &grid, int64_t node, const double *V, const double *v,
                                  const double *old, const double *whole)
{
  double *const record = grid.record(node);
  const int dim = grid.lattice.dim;
  double change[3] = {0.0}, more = 0.0;
  for (int d = 0; d < dim; d++) change[d] = v[d] - record[d];
  if (now.normal) more = slip_work(grid, node, V, change, v, whole ? whole : v);
  if (now.counting && grid.owns(node)) {
    double moved = more, driven = 0.0, gained = 0.0, change_old[3] = {0.0}, push[3] = {0.0};
    double faster[3] = {0.0};
    if (wall.changes) wall.half_change(*nodes[now.place].field, node, faster);
    for (int d = 0; d < dim; d++) {
      if (old) change_old[d] = old[d] - record[4 + d];
      const double given = change[d] - now.old_share * change_old[d];
      push[d] = record[3] * given;
      impulse[d] += push[d];
      moved += given * ((whole ? whole : v)[d] - faster[d]);
      driven += given * (V[d] - faster[d]);
      if (now.ledger)
        gained += 0.5 * (change[d] - change_old[d]) * (v[d] + (old ? old[d] : record[4 + d]));
    }
    add_moment(grid, node, push);
    if (now.ledger) now.ledger->note_push(record, change, change_old);
    past.work += record[3] * moved;
    now.kinetic += record[3] * moved;
    now.driven += record[3] * driven;
    now.collided += record[3] * (gained - moved);
  }
  std::copy_n(v, dim, record);
  if (old) std::copy_n(old, dim, record + 4);
}

/* ----------------------------------------------------------------------
   the part of old velocities relative to the wall that counts as consistent with it, see FLIP above
------------------------------------------------------------------------- */

static void first_inside(const double *record, const double *wall, int dim, double *limit)
{
  for (int d = 0; d < dim; d++) limit[d] = record[3] > 0.0 ? fabs(record[4 + d] - wall[d]) : 0.0;
}

double FixMPMBoundary::Wall::old_relative(const double *record, int d, double limit) const
{
  return std::max(-limit, std::min(record[4 + d] - before[d], limit));
}

/* ----------------------------------------------------------------------
   Do the node and its images have mass, and more than one of them? A single one is free unless it is in the plane of the
   wall. For most nodes near walls this is false
------------------------------------------------------------------------- */

bool FixMPMBoundary::is_constrained(Grid &grid, const Member *members, int n, bool fixed)
{
  int massive = 0;
  for (int k = 0; k < n; k++) massive += grid.record(members[k].node)[3] > 0.0;
  return massive > (fixed ? 0 : 1);
}

/* ----------------------------------------------------------------------
   sets the prescribed velocities of a node and its images: odd about the wall, and equal to the wall in its
   plane (fixed)
------------------------------------------------------------------------- */

void FixMPMBoundary::project(Grid &grid, const Member *members, int n, bool fixed,
                             const Prescribed &p)
{
  const int dim = grid.lattice.dim;
  const bool hold = p.hold[0] || p.hold[1] || p.hold[2];
  double mass = 0.0, w[3] = {0.0, 0.0, 0.0}, w_old[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < n; k++) {
    const int sign = members[k].sign;
    const double *r = grid.record(members[k].node);
    if (r[3] <= 0.0) continue;
    mass += r[3];
    for (int d = 0; d < dim; d++) {
      w[d] += sign * r[3] * (r[d] - p.V[d]);
      if (hold) w_old[d] += sign * r[3] * wall.old_relative(r, d, p.limit[d]);
    }
  }
  for (int d = 0; d < dim; d++) {
    w[d] = fixed ? 0.0 : w[d] / mass;
    w_old[d] = fixed ? 0.0 : w_old[d] / mass;
  }

  for (int k = 0; k < n; k++) {
    const int sign = members[k].sign;
    const double *r = grid.record(members[k].node);
    double v[3], old[3];
    for (int d = 0; d < dim; d++) {
      const double odd = p.V[d] + sign * w[d];
      v[d] = p.share[d] == 1.0 ? odd : r[d] + p.share[d] * (odd - r[d]);
      if (!hold) continue;
      old[d] = r[4 + d];
      if (p.hold[d]) old[d] += sign * w_old[d] - wall.old_relative(r, d, p.limit[d]);
    }
    set_velocity(grid, members[k].node, p.V, v, hold ? old : nullptr);
  }
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::act_on_column(const FieldNodes &list, Line &column)
{
  Grid &grid = list.field->grid;
  const Face &face = list.faces[column.face];
  const int dim = grid.lattice.dim, a = face.axis;
  const Member plane = {column.node[0], 1};
  const double *r = grid.record(plane.node);
  Prescribed prescribed = {};
  const double *V = prescribed.V, *limit = prescribed.limit;
  wall.velocity(*list.field, plane.node, prescribed.V);

  struct {
    Member members[2];         // inside, image
    const double *in, *out;    // their records
    double mass;
  } pairs[DEPTH];
  int npairs = 0;
  for (int j = 1; j <= DEPTH; j++) {
    const int64_t inside = column.node[j], image = column.node[DEPTH + j];
    if (inside < 0) continue;
    const double *in = grid.record(inside), *out = grid.record(image);
    if (in[3] <= 0.0 || out[3] <= 0.0) continue;
    const double mass = 2.0 * in[3] * out[3] / (in[3] + out[3]);
    pairs[npairs++] = {{{inside, 1}, {image, -1}}, in, out, mass};
  }

  if (npairs == 0 && !(r[3] > 0.0)) return;

  // impulse that would bring all components to the velocity of the wall

  double to_stick[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < dim; d++) {
    to_stick[d] = -r[3] * (r[d] - V[d]);
    for (int k = 0; k < npairs; k++)
      to_stick[d] -= pairs[k].mass * (pairs[k].in[d] + pairs[k].out[d] - 2.0 * V[d]);
  }

  // slip: the old normal velocity is constrained, too, which is no impulse

  if (kind == SLIP && now.old_share > 0.0) {
    prescribed.hold[a] = true;
    if (column.node[1] >= 0)
      first_inside(grid.record(column.node[1]), wall.before, dim, prescribed.limit);
    to_stick[a] += now.old_share * r[3] * wall.old_relative(r, a, limit[a]);
    for (int k = 0; k < npairs; k++)
      to_stick[a] += now.old_share * pairs[k].mass *
          (wall.old_relative(pairs[k].in, a, limit[a]) +
           wall.old_relative(pairs[k].out, a, limit[a]));
  }

  double needed = 0.0;
  for (int d = 0; d < dim; d++)
    if (d != a) needed += to_stick[d] * to_stick[d];
  double inward[3] = {0.0, 0.0, 0.0};
  inward[a] = face.inward;
  const double push = column.touched ? face.inward * to_stick[a] : 0.0;
  const double of_water = column.touched ? water_on(column.node, face.length(), inward) : 0.0;
  const double slide = slide_share(column.contact, push, of_water, sqrt(needed));
  if (column.contact == FREE) {
    for (int k = 0; k < face.length() && of_water > 0.0; k++)
      push_by_water(grid, column.node[k], inward);
    return;
  }
  for (int d = 0; d < dim; d++) prescribed.share[d] = d == a ? 1.0 : slide;
  const double normal[3] = {(double) (a == 0), (double) (a == 1), (double) (a == 2)};
  heat_if_sliding(column.contact, normal);
  if (r[3] > 0.0) project(grid, &plane, 1, true, prescribed);
  for (int k = 0; k < npairs; k++) project(grid, pairs[k].members, 2, false, prescribed);
  now.normal = nullptr;
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::act_on_orbit(const FieldNodes &list, const Orbit &orbit)
{
  Grid &grid = list.field->grid;
  const int dim = grid.lattice.dim;
  const Member *const members = &list.members[orbit.first];
  const int n = orbit.last - orbit.first;
  if (!is_constrained(grid, members, n, orbit.fixed)) return;
  Prescribed prescribed = {};
  wall.velocity(*list.field, orbit.wall, prescribed.V);
  const bool hold = now.old_share > 0.0;
  if (hold && orbit.inner >= 0)
    first_inside(grid.record(orbit.inner), wall.before, dim, prescribed.limit);
  for (int d = 0; d < dim; d++) {
    prescribed.share[d] = orbit.prescribed[d] ? 1.0 : 0.0;
    prescribed.hold[d] = hold && orbit.prescribed[d];
  }
  project(grid, members, n, orbit.fixed, prescribed);
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::act_on_single(const FieldNodes &list, Single &single)
{
  Grid &grid = list.field->grid;
  const int dim = grid.lattice.dim;
  const double *r = grid.record(single.node), *n = single.normal;
  if (r[3] <= 0.0) return;

  double V[3], v[3];
  wall.velocity(*list.field, single.node, V);
  for (int d = 0; d < dim; d++) V[d] += single.growth * n[d];

  if (kind == STICK || (n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0)) {
    for (int d = 0; d < dim; d++) v[d] = velocity[d].given ? V[d] : r[d];
  } else {
    double normal = 0.0;    // speed of the node away from the wall
    for (int d = 0; d < dim; d++) normal += (r[d] - V[d]) * n[d];
    double slide[3], length = 0.0;
    for (int d = 0; d < dim; d++) {
      slide[d] = r[d] - V[d] - normal * n[d];
      length += slide[d] * slide[d];
    }
    const double push = single.touched ? -normal : 0.0;
    const double of_water = single.touched ? water_on(&single.node, 1, n) / r[3] : 0.0;
    const double keep = 1.0 - slide_share(single.contact, push, of_water, sqrt(length));
    if (single.contact == FREE) {
      if (of_water > 0.0) push_by_water(grid, single.node, n);
      return;
    }
    for (int d = 0; d < dim; d++) v[d] = V[d] + keep * slide[d];
    heat_if_sliding(single.contact, n);
  }
  const double whole[3] = {v[0], v[1], v[2]};
  for (int d = 0; d < dim && single.share < 1.0; d++) v[d] = r[d] + single.share * (v[d] - r[d]);
  set_velocity(grid, single.node, V, v, nullptr, whole);
  now.normal = nullptr;
}

/** Moment about the origin of an impulse on a node. */
void FixMPMBoundary::add_moment(const Grid &grid, int64_t node, const double *push)
{
  double X[3], x[3], moment[3];
  grid.node_position(node, X);
  for (int i = 0; i < 3; i++) x[i] = X[i] + wall.moved[i] + MathExtra::dot3(wall.turned[i], X);
  MathExtra::cross3(x, push, moment);
  for (int d = 0; d < 3; d++) impulse[3 + d] += moment[d];
}

/* ----------------------------------------------------------------------
   impulse on a node, counted like any other, see set_velocity()
------------------------------------------------------------------------- */

void FixMPMBoundary::bear(MPMField &field, int64_t node, const double *push)
{
  Grid &grid = field.grid;
  if (!grid.owns(node)) return;
  const double *const record = grid.record(node);
  double V[3], faster[3] = {0.0}, moved = 0.0, driven = 0.0, gained = 0.0;
  wall.velocity(field, node, V);
  if (wall.changes) wall.half_change(field, node, faster);
  for (int d = 0; d < grid.lattice.dim; d++) {
    impulse[d] += push[d];
    moved += push[d] * (record[d] - faster[d]);
    driven += push[d] * (V[d] - faster[d]);
    if (field.ledger.on) gained += 0.5 * push[d] * (record[d] + record[4 + d]);
  }
  add_moment(grid, node, push);
  reaction_known = false;
  past.work += moved;
  field.ledger.boundary += moved * force->mvv2e;
  field.ledger.driven += driven * force->mvv2e;
  if (field.ledger.on) field.ledger.transfer += (gained - moved) * force->mvv2e;
}

/* ----------------------------------------------------------------------
   work of the wall on the body so far
------------------------------------------------------------------------- */

double FixMPMBoundary::compute_scalar()
{
  double all;
  MPI_Allreduce(&past.work, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all * force->mvv2e;
}

/* ----------------------------------------------------------------------
   force of the body on the wall in the last step (sign as of fix wall)
------------------------------------------------------------------------- */

double FixMPMBoundary::compute_vector(int i)
{
  if (!reaction_known) {
    MPI_Allreduce(impulse, reaction, size_vector, MPI_DOUBLE, MPI_SUM, world);
    for (double &r : reaction) r /= -dt_last * force->ftm2v;
    reaction_known = true;
  }
  return reaction[i];
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::write_restart(FILE *fp)
{
  keep_totals(world, &past.work, 1);
  Past all = past;
  all.work *= force->mvv2e;
  past.work = all.work / force->mvv2e;    // with the precision of the file
  if (comm->me) return;
  const int size = sizeof(Past);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(&all, size, 1, fp);
}

void FixMPMBoundary::restart(char *buf)
{
  memcpy(&past, buf, sizeof(Past));
  past.work = comm->me == 0 ? past.work / force->mvv2e : 0.0;
}

/* ---------------------------------------------------------------------- */

double FixMPMBoundary::memory_usage()
{
  double bytes = heating ? heating->memory_usage() : 0.0;
  for (const auto &list : nodes)
    bytes += list.lines.capacity() * sizeof(Line) + list.members.capacity() * sizeof(Member) +
        list.orbits.capacity() * sizeof(Orbit) + list.singles.capacity() * sizeof(Single) +
        list.crossings.capacity() * sizeof(Crossing) +
        list.approaches.capacity() * sizeof(Approach);
  return bytes + clear.capacity() * sizeof(double) + touches.capacity() * sizeof(Touch);
}
