/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Each node inside of the body that moves into it gets an impulse, and the body the opposite one,
   such that afterwards the node moves like the material of the body there, V + Omega x r: in all
   directions (stick), or along the normal (slip, separate; separate: no impulse may pull). With the
   mass m_i of the nodes and their velocities v_i before, all of these together make a linear system
   for V and Omega of 6 equations,

     M V + sum_i m_i N_i (V + Omega x r_i)             = M V' + sum_i m_i N_i v_i
     I Omega + sum_i r_i x m_i N_i (V + Omega x r_i)   = L'   + sum_i r_i x m_i N_i v_i

   with N_i = 1 where a node sticks and (n_i + mu t_i) n_i^T where it slides, where t_i is the
   direction of friction. Which nodes take part, which of them stick (those that friction is able to
   hold), and t_i follow from the solution, so that it is repeated until they stay the same.
------------------------------------------------------------------------- */

#include "contact/fix_mpm_rigid.h"

#include "base/mpm_image.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_physics.h"
#include "force.h"
#include "math/coulomb.h"
#include "math_extra.h"
#include "mesh/surface_mesh.h"
#include "modify.h"
#include "update.h"
#include "walls/mpm_patch_sums.h"
#include "walls/mpm_region_cut.h"
#include "walls/region_mpm_mesh.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   fix ID all mpm/rigid REGION density|mass VALUE stick|slip|separate keyword values ...
------------------------------------------------------------------------- */

Options MPMRigidOptions::declare()
{
  using namespace option;
  Options o("fix mpm/rigid");
  const auto value = number(amount, "", POSITIVE);
  o.argument(text(region_id, "region-ID"));
  o.argument(
      word(by_mass, {{"density", false, "", {value}}, {"mass", true, "", {value}}}, "option"));
  o.argument(word(kind, {{"stick", STICK}, {"slip", SLIP}, {"separate", SEPARATE}}, "contact"));
  o.add("friction",
        {number(friction, "mu", NOT_NEGATIVE, "1",
                "coefficient of friction, for *slip* and *separate*")});
  heat.declare(o, "the energy lost by friction becomes heat of the material, not of the body",
               "share of this energy that becomes heat of the material");
  o.add("velocity",
        {numbers(v, 3, "vx vy vz", ANY_NUMBER, "velocity", "velocity of the center at the start")})
      .once();
  o.add("omega",
        {numbers(omega, 3, "wx wy wz", ANY_NUMBER, "1/time", "angular velocity at the start")})
      .once();
  o.add("gravity",
        {numbers(gravity, 3, "gx gy gz", ANY_NUMBER, "velocity/time", "acceleration of the body")})
      .once();
  o.add("force", {variables(load, 3, "fx fy fz", "force", "force on the center, can be variables")})
      .once();
  o.add("torque",
        {variables(moment, 3, "tx ty tz", "force*distance",
                   "torque about the center, can be variables")})
      .once();
  o.add("hold",
        {any_of(fixed, {"x", "y", "z", "rx", "ry", "rz"},
                "components of the velocity and of the angular velocity that stay zero")})
      .standard("nothing");
  o.refuse([=] {
    OptionRules rules = {{kind == STICK, "friction", "is for slip and separate"},
                         {heat.heats() && friction == 0.0, "heat",
                          "is that of friction, which needs a coefficient"}};
    for (int a = 0; a < 3; a++) {
      const std::string axis(1, "xyz"[a]);
      rules.push_back(
          {fixed[a] && v[a] != 0.0, "", "cannot hold " + axis + " and give it a velocity"});
      rules.push_back({fixed[3 + a] && omega[a] != 0.0, "",
                       "cannot hold r" + axis + " and give it an angular velocity"});
    }
    return rules;
  });
  return o;
}

FixMPMRigid::FixMPMRigid(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/rigid acts on nodes, which have no group: use group all");
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);
  if (heat.heats()) heating = std::make_unique<MPMFrictionHeat>(lmp, heat);
  const int dim = domain->dimension;
  auto *const any = domain->get_region_by_id(region_id);
  if (!any) error->all(FLERR, 3, "Fix mpm/rigid region {} does not exist", region_id);
  if (dim == 2 && dynamic_cast<RegMPMMesh *>(any))
    error->all(FLERR, 3,
               "Fix mpm/rigid region {} of style mpm/mesh is for 3d: in 2d, move a region with fix "
               "mpm/boundary, or let another one "
               "float in a flow of fix mpm/incompressible",
               region_id);
  double volume, lo[3], hi[3];
  constexpr int VOIGT[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  if (auto *region = dim == 3 ? dynamic_cast<RegMPMMesh *>(any) : nullptr) {
    region->need_distance();
    mesh = &region->surface_mesh();
    volume = mesh->volume;
    for (int d = 0; d < 3; d++) {
      first[d] = mesh->center[d];
      lo[d] = mesh->lo[d];
      hi[d] = mesh->hi[d];
      for (int e = 0; e < 3; e++) body_inertia[d][e] = mesh->inertia[VOIGT[d][e]];
    }
  } else {
    if (any->dynamic_check() || !any->interior || any->openflag ||
        !MPMRegionBody::is_bounded(*any, dim))
      error->all(
          FLERR, 3,
          "Fix mpm/rigid needs a region of style mpm/mesh: {}; in a flow of fix mpm/incompressible "
          "also another one that is bounded, at rest, with side in, and without open faces",
          region_id);
    any->init();
    const MPMRegionBody shape(*any, dim);
    if (!(shape.volume > 0.0))
      error->all(FLERR, 3, "Region {} of fix mpm/rigid is empty", region_id);
    volume = shape.volume;
    for (int d = 0; d < 3; d++) {
      first[d] = shape.center[d];
      lo[d] = shape.lo[d];
      hi[d] = shape.hi[d];
      for (int e = 0; e < 3; e++) body_inertia[d][e] = shape.inertia[d][e];
    }
  }
  double far[3];
  for (int d = 0; d < 3; d++) far[d] = std::max(hi[d] - first[d], first[d] - lo[d]);
  farthest = MathExtra::len3(far);
  const double density = by_mass ? amount / volume : amount;
  mass = density * volume;
  for (int d = 0; d < 3; d++) {
    x[d] = first[d];
    for (int e = 0; e < 3; e++) {
      Q[d][e] = d == e;
      body_inertia[d][e] *= density;
    }
  }
  if (dim == 2) {
    if (v[2] != 0.0 || omega[0] != 0.0 || omega[1] != 0.0 || fixed[2] || fixed[3] || fixed[4])
      error->all(FLERR,
                 "Fix mpm/rigid {}: in 2d a body moves in the plane: leave out what is about z, "
                 "and rotations "
                 "but that about z",
                 id);
    fixed[2] = fixed[3] = fixed[4] = true;
  }
  hold();
  MathExtra::matvec(body_inertia, omega, L);
  spin();

  scalar_flag = vector_flag = 1;
  size_vector = 24;
  global_freq = 1;
  extscalar = 1;
  extvector = 0;
  restart_global = 1;
  if (comm->me == 0)
    utils::logmesg(lmp, "Rigid body {}: mass {:.8g}, center {:.8g} {:.8g} {:.8g}\n", id, mass, x[0],
                   x[1], x[2]);
}

/* ---------------------------------------------------------------------- */

void FixMPMRigid::init()
{
  auto *const any = domain->get_region_by_id(region_id);
  auto *const region = dynamic_cast<RegMPMMesh *>(any);
  const bool flows = spacing_of_flow() > 0.0;
  if (!any || any->dynamic_check() || !any->interior || (mesh && !region))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/rigid {} needs its region {} at rest and with side in: the fix moves a "
               "copy of it",
               id, region_id);
  if (mesh) {
    region->need_distance();
    mesh = &region->surface_mesh();
  } else if (!flows) {
    if (domain->dimension == 2)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/rigid {} requires 3d, as surfaces are of triangles: in 2d, move a region with "
          "fix mpm/boundary, use a thin 3d box that is periodic, or a flow of fix "
          "mpm/incompressible that has region {}",
          id, region_id);
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/rigid {} needs a region of style mpm/mesh: {}; others are bodies in a flow of fix "
        "mpm/incompressible that has this region",
        id, region_id);
  }
  for (const auto *other : modify->get_fix_by_style("^mpm/rigid$"))
    if (other != this && dynamic_cast<const FixMPMRigid *>(other)->region_id == region_id)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/rigid {} and {} have the same region {}: they would be two bodies in the "
                 "same place, which do not feel each other",
                 id, other->id, region_id);
  const auto fields = MPMField::all(lmp);
  if (flows) {
    if (kind != SLIP || friction > 0.0)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/rigid {}: a body in a flow of fix mpm/incompressible has no friction and does "
          "not part from it: use slip",
          id);
    if (!fields.empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/rigid {} is a body in a flow of fix mpm/incompressible, and cannot touch "
                 "points of fix mpm {}: remove one of them",
                 id, fields[0]->id());
  } else
    require_field(lmp, *this);
  for (const auto *field : fields)
    refuse_field(lmp, *this, *field,
                 {{field->options.total, "frame total",
                   "its nodes are not where the body is: use frame updated"},
                  {field->options.stress_before(), "scheme usf and usavg",
                   "these need the contact before it is known: use usl or musl"}});
  for (int d = 0; d < 3; d++) {
    find_variable(lmp, load[d], "fix mpm/rigid force");
    find_variable(lmp, moment[d], "fix mpm/rigid torque");
  }
}

void FixMPMRigid::init_action()
{
  if (heating) heating->begin_run(*this, MPMField::all(lmp));
}

/* ----------------------------------------------------------------------
   forces that the input gives
------------------------------------------------------------------------- */

void FixMPMRigid::load_impulse(double dt)
{
  bool variables = false;
  for (int d = 0; d < 3; d++)
    variables = variables || !load[d].variable.empty() || !moment[d].variable.empty();
  evaluate_in_step(lmp, variables, [&] {
    for (int d = 0; d < 3; d++) {
      v[d] += dt * (gravity[d] + evaluate(lmp, load[d]) * force->ftm2v / mass);
      L[d] += dt * evaluate(lmp, moment[d]) * force->ftm2v;
    }
  });
}

/** Of the fastest point of the body. */
double FixMPMRigid::speed() const
{
  return MathExtra::len3(v) + farthest * MathExtra::len3(omega);
}

double FixMPMRigid::stable_dt(tagint &tag) const
{
  tag = 0;
  double h = HUGE_VAL;
  int every = 1;
  for (const auto *field : MPMField::all(lmp)) {
    h = std::min(h, field->lattice.h);
    every = field->options.every;
  }
  const double flow_spacing = spacing_of_flow();
  if (flow_spacing > 0.0) h = flow_spacing;
  return h / (speed() * every);
}

/** Zero: the body is in none. */
double FixMPMRigid::spacing_of_flow() const
{
  for (const auto *flow : find_fixes<MPMFluid>(lmp)) {
    const double h = flow->spacing_around(region_id);
    if (h > 0.0) return h;
  }
  return 0.0;
}

/* ----------------------------------------------------------------------
   A body touches material where nodes are inside of it at the start of a step. One that crosses
   more than a cell in a step can pass through a body without touching it. All ranks have the same
   motion.
------------------------------------------------------------------------- */

void FixMPMRigid::check_motion(double dt) const
{
  double sum = 0.0;
  for (int d = 0; d < 3; d++) sum += fabs(x[d]) + fabs(v[d]) + fabs(L[d]) + fabs(omega[d]);
  if (!std::isfinite(sum))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/rigid {}: position or velocity of the body is not finite at step {}: see "
               "its force, torque, and gravity, and the material that it touches",
               id, update->ntimestep);
  for (const auto *field : MPMField::all(lmp))
    if (field->options.dt_check && speed() * dt > field->lattice.h)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/rigid {}: the body crosses {:.3g} cells of fix mpm {} in step {} and can "
                 "pass through material without touching it: use a smaller timestep, fix mpm/dt, "
                 "or fix mpm ... dtcheck no",
                 id, speed() * dt / field->lattice.h, field->id(), update->ntimestep);
}

/* ----------------------------------------------------------------------
   nodes with mass inside of the body, and where its surface is
------------------------------------------------------------------------- */

void FixMPMRigid::find_contacts()
{
  contacts.clear();
  int place = -1;
  for (auto *field : MPMField::all(lmp)) {
    place++;
    auto &grid = field->grid;
    const double half = 0.5 * (grid.side - 1) * field->lattice.h;
    for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
      const auto &block = grid.blocks[slot];
      const int64_t first = (int64_t) slot * NODES_PER_BLOCK;
      double at[3];
      field->grid.node_position(first, at);
      for (int d = 0; d < 3; d++) at[d] += half - x[d];
      nearest_image(*domain, at);
      if (MathExtra::len3(at) > farthest + 1.8 * half) continue;
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        if (block.alias >> n & 1) continue;
        Contact c;
        c.record = grid.record(first + n);
        if (!(c.record[3] > 0.0)) continue;
        field->grid.node_position(first + n, c.r);
        for (int d = 0; d < 3; d++) c.r[d] -= x[d];
        nearest_image(*domain, c.r);
        SurfaceMesh::Point p;
        place_in_body(c.r, p);
        // a node that sticks needs no normal: far from the surface there is nothing to search for
        if (kind == STICK ? !mesh->inside(p) : mesh->bound(p) > 0.0) continue;
        MathExtra::copy3(c.record, c.v);
        if (kind != STICK && !find_normal(p, c)) continue;
        c.field = field;
        c.place = place;
        c.owned = block.owned >> n & 1;
        c.state = kind == STICK ? Contact::STICKS : Contact::SLIDES;
        contacts.push_back(c);
      }
    }
  }
}

/** In the frame of the mesh; r: from the center of the body. */
void FixMPMRigid::place_in_body(const double *r, std::array<double, 3> &p) const
{
  double local[3];
  MathExtra::transpose_matvec(Q, r, local);
  for (int d = 0; d < 3; d++) p[d] = mesh->center[d] + local[d];
}

/** False: the point is outside, or has no normal. */
bool FixMPMRigid::find_normal(const std::array<double, 3> &p, Contact &c) const
{
  SurfaceMesh::Point out;
  const double distance = mesh->distance_and_normal(p, out);
  if (distance > 0.0) return false;
  c.depth = -distance;
  MathExtra::matvec(Q, out.data(), c.n);
  if (MathExtra::lensq3(c.n) > 0.0) return true;
  // no way out is shorter: along the motion of the body
  const double u[6] = {v[0], v[1], v[2], omega[0], omega[1], omega[2]};
  c.relative_velocity(u, c.n);
  if (!(MathExtra::lensq3(c.n) > 0.0)) return false;
  MathExtra::norm3(c.n);
  return true;
}

/* ---------------------------------------------------------------------- */

void FixMPMRigid::Contact::relative_velocity(const double *u, double *w) const
{
  MathExtra::cross3(u + 3, r, w);
  for (int d = 0; d < 3; d++) w[d] += u[d] - v[d];
}

/* ----------------------------------------------------------------------
   velocities of the body after the contact
------------------------------------------------------------------------- */

void FixMPMRigid::solve()
{
  constexpr int MAX_ROUNDS = 30;
  double u[6];
  for (int round = 1;; round++) {
    solve_system(u);
    const int changed = decide_contacts(u);
    int changed_all;
    MPI_Allreduce(&changed, &changed_all, 1, MPI_INT, MPI_MAX, world);
    if (!changed_all || round == MAX_ROUNDS) break;
  }
  push_nodes(u);
  push(impulse);
}

/** Finds the velocity and angular velocity u of the body, for contacts in their present states. */
void FixMPMRigid::solve_system(double *u) const
{
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  double I[3][3];
  inertia(I);
  double mine[42] = {0.0}, all[42];    // matrix, right-hand side
  for (const auto &c : contacts) {
    if (!c.owned || c.state == Contact::APART) continue;
    const double m = c.record[3];
    // N_i as sum of products of a direction of the impulse and one of the velocity: each with r x
    // it
    const int products = c.state == Contact::STICKS ? 3 : 1;
    for (int k = 0; k < products; k++) {
      double row[6], column[6];
      for (int d = 0; d < 3; d++) {
        row[d] = c.state == Contact::STICKS ? (double) (d == k) : c.n[d];
        column[d] = c.state == Contact::STICKS ? row[d] : c.n[d] + c.pull[d];
      }
      MathExtra::cross3(c.r, row, row + 3);
      MathExtra::cross3(c.r, column, column + 3);
      const double known = m * MathExtra::dot3(row, c.v);
      for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) mine[6 * i + j] += m * column[i] * row[j];
        mine[36 + i] += known * column[i];
      }
    }
  }
  MPI_Allreduce(mine, all, 42, MPI_DOUBLE, MPI_SUM, world);
  Matrix6 A = Eigen::Map<Matrix6>(all).transpose();    // by rows
  Vector6 b = Eigen::Map<Vector6>(all + 36);
  for (int d = 0; d < 3; d++) {
    A(d, d) += mass;
    b(d) += mass * v[d];
    b(3 + d) += L[d];
    for (int e = 0; e < 3; e++) A(3 + d, 3 + e) += I[d][e];
  }
  for (int i = 0; i < 6; i++) {
    if (!fixed[i]) continue;
    A.row(i).setZero();
    A.col(i).setZero();
    A(i, i) = 1.0;
    b(i) = 0.0;
  }
  const Vector6 solution = A.partialPivLu().solve(b);
  std::copy_n(solution.data(), 6, u);
}

/** Finds the states of contacts with the motion u of the body. Returns whether these are not the
 *  states of which u is the solution. */
bool FixMPMRigid::decide_contacts(const double *u)
{
  bool changed = false;
  for (auto &c : contacts) {
    if (kind == STICK) break;
    double w[3], slide[3];
    c.relative_velocity(u, w);
    const double normal = MathExtra::dot3(w, c.n);
    MathExtra::scaleadd3(-normal, c.n, w, slide);
    const double held = friction * (1.0 - c.water_share);    // by what is between grains and body
    const double length = MathExtra::len3(slide);
    const Contact before = c;
    MathExtra::zero3(c.pull);
    if (kind == SEPARATE && !(normal > 0.0))
      c.state = Contact::APART;
    else if (friction > 0.0 && !CoulombFriction{held, held}.slides(length, fabs(normal)))
      c.state = Contact::STICKS;
    else {
      c.state = Contact::SLIDES;
      if (friction > 0.0)
        for (int d = 0; d < 3; d++) c.pull[d] = std::copysign(held, normal) * slide[d] / length;
    }
    if (c.state != before.state) changed = true;
    for (int d = 0; d < 3; d++)
      if (fabs(c.pull[d] - before.pull[d]) > 1.0e-10 * friction) changed = true;
  }
  return changed;
}

/** Applies the impulses to nodes, with the friction of the last round, and finds their sum on the
 *  body: opposite to round-off even if the rounds have not converged. */
void FixMPMRigid::push_nodes(const double *u)
{
  double sum[6] = {0.0};
  for (const auto &c : contacts) {
    if (c.state == Contact::APART) continue;
    double w[3], J[3], torque[3];
    c.relative_velocity(u, w);
    const double m = c.record[3], normal = MathExtra::dot3(w, c.n);
    for (int d = 0; d < 3; d++)
      J[d] = m * (c.state == Contact::STICKS ? w[d] : normal * (c.n[d] + c.pull[d]));
    MathExtra::cross3(c.r, J, torque);
    if (c.owned)
      for (int d = 0; d < 3; d++) {
        sum[d] -= J[d];
        sum[3 + d] -= torque[d];
      }
    c.field->ledger.push_node(c.record, c.owned, J);
    if (heating && c.state == Contact::SLIDES) heat_node(c, m * normal, u);
  }
  MPI_Allreduce(sum, impulse, 6, MPI_DOUBLE, MPI_SUM, world);
}

/* ----------------------------------------------------------------------
   Water in pores takes a part of what pushes the body. Nodes outside of it are free, so that soil
   within a cell of its surface is pressed together by more than the load where nodes are off that,
   grains and water alike. So the share is that in what crosses a layer below it: with w = 1 next to
   the surface, and falling to 0 across the layer, minus the forces of points on nodes have the sum
   w_i f_i = -int sigma grad w dV, the mean of the stress across the layer. What crosses it acts on
   the body.
------------------------------------------------------------------------- */

static constexpr double PATCH = 2.5;    // radius of sums along the surface, in node spacings
static constexpr double LAYER_FROM = 1.0, LAYER_TO = 3.0;    // of the surface, in node spacings

void FixMPMRigid::find_water()
{
  const auto pores = find_fixes<MPMPorePressure>(lmp);
  if (pores.empty()) return;
  std::vector<MPMPatchSums::Place> places;
  std::vector<double> by_water, by_all;
  double h = 0.0;
  int part = -1;
  for (auto *field : MPMField::all(lmp)) {
    part++;
    if (!pores[0]->pressure_in_forces(*field)) continue;
    const auto &grid = field->grid;
    h = std::max(h, field->lattice.h);
    const double half = 0.5 * (grid.side - 1) * field->lattice.h,
                 reach = LAYER_TO * field->lattice.h;
    std::vector<char> near(grid.blocks.size(), 0);
    for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
      double at[3];
      grid.node_position((int64_t) slot * NODES_PER_BLOCK, at);
      for (int d = 0; d < 3; d++) at[d] += half - x[d];
      nearest_image(*domain, at);
      near[slot] = MathExtra::len3(at) <= farthest + reach + 1.8 * half;
    }
    pores[0]->find_forces_below_surface(*field, near, by_water, by_all);
    for (std::size_t slot = 0; slot < near.size(); slot++)
      for (int n = 0; near[slot] && n < NODES_PER_BLOCK; n++) {
        const auto &block = grid.blocks[slot];
        if ((block.alias >> n & 1) || !(block.owned >> n & 1)) continue;
        const int64_t node = (int64_t) slot * NODES_PER_BLOCK + n;
        const double *const of[2] = {&by_water[3 * node], &by_all[3 * node]};
        if (!(MathExtra::lensq3(of[1]) > 0.0)) continue;
        MPMPatchSums::Place place;
        grid.node_position(node, place.at);
        for (int d = 0; d < 3; d++) place.at[d] -= x[d];
        nearest_image(*domain, place.at);
        SurfaceMesh::Point p, out;
        place_in_body(place.at, p);
        if (mesh->bound(p) > reach) continue;
        const double distance = mesh->distance_and_normal(p, out),
                     depth = distance / field->lattice.h;
        if (depth >= LAYER_TO) continue;
        const double w = std::min(1.0, (LAYER_TO - depth) / (LAYER_TO - LAYER_FROM));
        MathExtra::matvec(Q, out.data(), place.normal);
        for (int d = 0; d < 3; d++) place.at[d] -= distance * place.normal[d];
        place.part = part;
        for (int k = 0; k < 2; k++) place.value[k] = -w * MathExtra::dot3(of[k], place.normal);
        places.push_back(place);
      }
  }
  if (h == 0.0) return;
  MPMPatchSums sums(world, PATCH * h);
  sums.gather(places);
  for (auto &c : contacts) {
    double at[3];
    MathExtra::scaleadd3(c.depth, c.n, c.r, at);
    const auto [water, all] = sums.around(c.place, at, c.n);
    c.water_share = all > 0.0 ? std::min(1.0, water / all) : water > 0.0 ? 1.0 : 0.0;
  }
}

double FixMPMRigid::distance(const double *at, double far) const
{
  double r[3];
  MathExtra::sub3(at, x, r);
  nearest_image(*domain, r);
  SurfaceMesh::Point p, closest;
  place_in_body(r, p);
  return mesh->bound(p) > far ? far : mesh->distance(p, closest);
}

/* ----------------------------------------------------------------------
   heat of friction at a node that slides, and the work that goes with it, which the ledger has with
   the new velocity; u: velocity and angular velocity of the body after the contact
------------------------------------------------------------------------- */

void FixMPMRigid::heat_node(const Contact &c, double normal_impulse, const double *u)
{
  double J[3], old[3], now[3], work = 0.0;
  MathExtra::cross3(omega, c.r, old);
  MathExtra::cross3(u + 3, c.r, now);
  for (int d = 0; d < 3; d++) {
    J[d] = normal_impulse * c.pull[d];
    old[d] = c.record[4 + d] - old[d] - v[d];
    now[d] = c.record[d] - now[d] - u[d];
    work += J[d] * now[d];
  }
  const double made = heating->made(J, old, now, 3);
  heating->at_wall(c.place, c.record, made, c.owned);
  if (!c.owned) return;
  const double more = -made - work * force->mvv2e;
  c.field->ledger.contact += more;
  c.field->ledger.transfer -= more;
}

/* ---------------------------------------------------------------------- */

void FixMPMRigid::act(double dt, Stage stage)
{
  if (stage == STEP) {
    const double old[6] = {v[0], v[1], v[2], omega[0], omega[1], omega[2]};
    dt_last = dt;
    load_impulse(dt);
    hold();
    find_contacts();
    if (friction > 0.0) find_water();
    if (heating) heating->begin_step();
    solve();
    move(dt);

    // The nodes were counted with the new velocity of the body. Impulses on it change its kinetic
    // energy with the mean of both: see MPMWallMotion::half_change(). The sum is the same on
    // all ranks

    double faster = 0.0;
    for (int d = 0; d < 3; d++)
      faster -= 0.5 * (impulse[d] * (v[d] - old[d]) + impulse[3 + d] * (omega[d] - old[3 + d]));
    if (comm->me == 0) {
      auto &ledger = MPMField::all(lmp)[0]->ledger;
      ledger.contact -= faster * force->mvv2e;
      ledger.driven -= faster * force->mvv2e;
      if (ledger.on) ledger.transfer += faster * force->mvv2e;
    }
    check_motion(dt);
    return;
  }

  // velocities that serve the gradient alone: those of the body, along what it has decided

  for (const auto &c : contacts) {
    if (c.state == Contact::APART) continue;
    double w[3];
    MathExtra::cross3(omega, c.r, w);
    for (int d = 0; d < 3; d++) w[d] += v[d] - c.record[d];
    const double normal = MathExtra::dot3(w, c.n);
    for (int d = 0; d < 3; d++) c.record[d] += kind == STICK ? w[d] : normal * c.n[d];
  }
}

/* ----------------------------------------------------------------------
   in a flow
------------------------------------------------------------------------- */

void FixMPMRigid::motion(double *center, double *velocity, double *angular) const
{
  MathExtra::copy3(x, center);
  MathExtra::copy3(v, velocity);
  MathExtra::copy3(omega, angular);
}

void FixMPMRigid::place_in_region(const double *at, double *place) const
{
  double r[3];
  MathExtra::sub3(at, x, r);
  nearest_image(*domain, r);
  MathExtra::transpose_matvec(Q, r, place);
  for (int d = 0; d < 3; d++) place[d] += first[d];
}

void FixMPMRigid::predict(double duration, double *u, double *inverse)
{
  const MPMRigidMotion before = *this;
  load_impulse(duration);
  hold();
  spin();
  MathExtra::copy3(v, u);
  MathExtra::copy3(omega, u + 3);
  find_mobility(inverse);
  static_cast<MPMRigidMotion &>(*this) = before;
}

void FixMPMRigid::go_on(double dt, const double *impulse_of_flow)
{
  dt_last = dt;
  std::copy_n(impulse_of_flow, 6, impulse);
  load_impulse(dt);
  hold();
  push(impulse);
  move(dt);
  check_motion(dt);
}

/* ----------------------------------------------------------------------
   kinetic energy
------------------------------------------------------------------------- */

double FixMPMRigid::compute_scalar()
{
  return 0.5 * force->mvv2e * (mass * MathExtra::dot3(v, v) + MathExtra::dot3(L, omega));
}

/* ----------------------------------------------------------------------
   center, velocity, angular velocity, force and torque of the material, rotation matrix by rows
------------------------------------------------------------------------- */

double FixMPMRigid::compute_vector(int i)
{
  if (i < 3) return x[i];
  if (i < 6) return v[i - 3];
  if (i < 9) return omega[i - 6];
  if (i < 15) return dt_last > 0.0 ? impulse[i - 9] / (dt_last * force->ftm2v) : 0.0;
  return Q[(i - 15) / 3][(i - 15) % 3];
}

/* ---------------------------------------------------------------------- */

void FixMPMRigid::write_restart(FILE *fp)
{
  if (comm->me) return;
  const MPMRigidMotion &motion = *this;
  const int size = sizeof(motion);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(&motion, size, 1, fp);
}

void FixMPMRigid::restart(char *buf)
{
  memcpy(static_cast<MPMRigidMotion *>(this), buf, sizeof(MPMRigidMotion));
}
