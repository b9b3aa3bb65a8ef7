/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Each node inside of the body that moves into it gets an impulse, and the body the opposite one,
   such that afterwards the node moves like the material of the body there, V + Omega x r: in all
   directions (stick), or along the normal (slip, separate; separate: no impulse may pull). With the
   mass m_i of the nodes and their velocities v_i before, all of these together make a linear system
   for V and Omega of 6 equations,

     M V + sum_i m_i N_i (V + Omega x r_i)             = M V' + sum_i m_i N_i v_i
     I Omega + sum_i r_i x m_i N_i (V + Omega x r_i)   = L'   + sum_i r_i x m_i N_i v_i

   with N_i = 1 where a node sticks and (n_i + mu t_i) n_i^T where it slides, where t_i is the
   direction of friction. Which nodes take part, which of them stick (those that friction is able to
   hold), and t_i follow from the solution, so that it is repeated until they stay the same. */

#include "contact/mpm_rigid_contact.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_image.h"
#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "force.h"
#include "math/coulomb.h"
#include "math_extra.h"
#include "mesh/surface_mesh.h"
#include "mesh/surface_points.h"
#include "walls/mpm_patch_sums.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double PATCH = 2.5;    // radius of sums along the surface, in node spacings
static constexpr double LAYER_FROM = 1.0, LAYER_TO = 3.0;    // of the surface, in node spacings

MPMRigidContact::MPMRigidContact(LAMMPS *lmp, MPMRigidOptions &body) : Pointers(lmp), body(body) {}

MPMRigidContact::~MPMRigidContact() = default;

void MPMRigidContact::begin()
{
  find_contacts();
  if (body.friction > 0.0) find_water();
  if (heating) heating->begin_step();
}

void MPMRigidContact::act()
{
  constexpr int MAX_ROUNDS = 30;
  double u[6];
  begin();
  for (int round = 0; round < MAX_ROUNDS; round++) {
    find_motion(u, nullptr);
    if (!decide(u)) break;
  }
  end(u);
}

bool MPMRigidContact::decide(const double *u)
{
  const int changed = decide_contacts(u);
  int changed_all;
  MPI_Allreduce(&changed, &changed_all, 1, MPI_INT, MPI_MAX, world);
  return changed_all;
}

void MPMRigidContact::end(const double *u)
{
  push_nodes(u);
  body.push(body.impulse);
}

void MPMRigidContact::repeat()
{
  for (const auto &c : contacts) {
    if (c.state == Contact::APART) continue;
    double w[3];
    MathExtra::cross3(body.omega, c.r, w);
    for (int d = 0; d < 3; d++) w[d] += body.v[d] - c.record[d];
    const double normal = MathExtra::dot3(w, c.n);
    for (int d = 0; d < 3; d++) c.record[d] += body.sticks() ? w[d] : normal * c.n[d];
  }
}

/** Vector from the center of the body. */
void MPMRigidContact::from_center(const double *at, double *r) const
{
  MathExtra::sub3(at, body.x, r);
  nearest_image(*domain, r);
}

/** Can a node of this block be that near to the body? */
bool MPMRigidContact::is_near(const Grid &grid, std::size_t slot, double reach) const
{
  const double half = 0.5 * (grid.side - 1) * grid.lattice.h;
  double at[3], r[3];
  grid.node_position((int64_t) slot * NODES_PER_BLOCK, at);
  for (double &x : at) x += half;
  from_center(at, r);
  return MathExtra::len3(r) <= farthest + reach + 1.8 * half;
}

/** Nodes with mass inside of the body, and where its surface is. */
void MPMRigidContact::find_contacts()
{
  contacts.clear();
  int place = -1;
  for (auto *field : MPMField::all(lmp)) {
    place++;
    auto &grid = field->grid;
    for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
      const auto &block = grid.blocks[slot];
      const int64_t first = (int64_t) slot * NODES_PER_BLOCK;
      if (!is_near(grid, slot, 0.0)) continue;
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        if (block.alias >> n & 1) continue;
        Contact c;
        c.record = grid.record(first + n);
        if (!(c.record[3] > 0.0)) continue;
        double at[3];
        grid.node_position(first + n, at);
        from_center(at, c.r);
        SurfaceMesh::Point p;
        place_in_body(c.r, p);
        // a node that sticks needs no normal: far from the surface there is nothing to search for
        if (body.sticks() ? !mesh->inside(p) : mesh->bound(p) > 0.0) continue;
        MathExtra::copy3(c.record, c.v);
        if (!body.sticks() && !find_normal(p, c)) continue;
        c.field = field;
        c.place = place;
        c.owned = block.owned >> n & 1;
        c.state = body.sticks() ? Contact::STICKS : Contact::SLIDES;
        contacts.push_back(c);
      }
    }
  }
}

/** In the frame of the mesh; r: from the center of the body. */
void MPMRigidContact::place_in_body(const double *r, std::array<double, 3> &p) const
{
  double local[3];
  MathExtra::transpose_matvec(body.Q, r, local);
  for (int d = 0; d < 3; d++) p[d] = mesh->center[d] + local[d];
}

/** False: the point is outside, or has no normal. */
bool MPMRigidContact::find_normal(const std::array<double, 3> &p, Contact &c) const
{
  SurfaceMesh::Point out;
  const double distance = mesh->distance_and_normal(p, out);
  if (distance > 0.0) return false;
  c.depth = -distance;
  MathExtra::matvec(body.Q, out.data(), c.n);
  if (MathExtra::lensq3(c.n) > 0.0) return true;
  // no way out is shorter: along the motion of the body
  const double u[6] = {body.v[0],     body.v[1],     body.v[2],
                       body.omega[0], body.omega[1], body.omega[2]};
  c.relative_velocity(u, c.n);
  if (!(MathExtra::lensq3(c.n) > 0.0)) return false;
  MathExtra::norm3(c.n);
  return true;
}

void MPMRigidContact::Contact::relative_velocity(const double *u, double *w) const
{
  MathExtra::cross3(u + 3, r, w);
  for (int d = 0; d < 3; d++) w[d] += u[d] - v[d];
}

void MPMRigidContact::find_motion(double *u, double (*mobility)[6]) const
{
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  double I[3][3];
  body.inertia(I);
  double mine[42] = {0.0}, all[42];    // matrix, right-hand side
  for (const auto &c : contacts) {
    if (!c.owned || c.state == Contact::APART) continue;
    const double m = c.record[3];
    // N_i as sum of products of a direction of the impulse and one of the velocity, with their
    // moments
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
    A(d, d) += body.mass;
    b(d) += body.mass * body.v[d];
    b(3 + d) += body.L[d];
    for (int e = 0; e < 3; e++) A(3 + d, 3 + e) += I[d][e];
  }
  for (int i = 0; i < 6; i++) {
    if (!body.fixed[i]) continue;
    A.row(i).setZero();
    A.col(i).setZero();
    A(i, i) = 1.0;
    b(i) = 0.0;
  }
  const auto factors = A.partialPivLu();
  const Vector6 solution = factors.solve(b);
  std::copy_n(solution.data(), 6, u);
  for (int j = 0; mobility && j < 6; j++) {
    const Vector6 change = factors.solve(Vector6::Unit(j));
    for (int i = 0; i < 6; i++) mobility[i][j] = body.fixed[j] ? 0.0 : change(i);
  }
}

/** Finds the states of contacts with the motion u of the body. Returns whether these are not the
 *  states of which u is the solution. */
bool MPMRigidContact::decide_contacts(const double *u)
{
  bool changed = false;
  for (auto &c : contacts) {
    if (body.sticks()) break;
    double w[3], slide[3];
    c.relative_velocity(u, w);
    const double normal = MathExtra::dot3(w, c.n);
    MathExtra::scaleadd3(-normal, c.n, w, slide);
    const double held =
        body.friction * (1.0 - c.water_share);    // by what is between grains and body
    const double length = MathExtra::len3(slide);
    const Contact before = c;
    MathExtra::zero3(c.pull);
    if (body.kind == MPMRigidOptions::SEPARATE && !(normal > 0.0))
      c.state = Contact::APART;
    else if (body.friction > 0.0 && !CoulombFriction{held, held}.slides(length, fabs(normal)))
      c.state = Contact::STICKS;
    else {
      c.state = Contact::SLIDES;
      if (body.friction > 0.0)
        for (int d = 0; d < 3; d++) c.pull[d] = std::copysign(held, normal) * slide[d] / length;
    }
    if (c.state != before.state) changed = true;
    for (int d = 0; d < 3; d++)
      if (fabs(c.pull[d] - before.pull[d]) > 1.0e-10 * body.friction) changed = true;
  }
  return changed;
}

/** Applies the impulses to nodes, with the friction of the last round, and finds their sum on the
 *  body: opposite to round-off even if the rounds have not converged. */
void MPMRigidContact::push_nodes(const double *u)
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
  MPI_Allreduce(sum, body.impulse, 6, MPI_DOUBLE, MPI_SUM, world);
}

/** Heat of friction at a node that slides, and the work that goes with it, which the ledger has
 *  with the new velocity; u: velocity and angular velocity of the body after the contact. */
void MPMRigidContact::heat_node(const Contact &c, double normal_impulse, const double *u)
{
  double J[3], old[3], now[3], work = 0.0;
  MathExtra::cross3(body.omega, c.r, old);
  MathExtra::cross3(u + 3, c.r, now);
  for (int d = 0; d < 3; d++) {
    J[d] = normal_impulse * c.pull[d];
    old[d] = c.record[4 + d] - old[d] - body.v[d];
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

/** Water in pores takes a part of what pushes the body. Nodes outside of it are free, so that soil
 *  within a cell of its surface is pressed together by more than the load where nodes are off that,
 *  grains and water alike. So the share is that in what crosses a layer below it: with w = 1 next
 *  to the surface, and falling to 0 across the layer, minus the forces of points on nodes have the
 *  sum w_i f_i = -int sigma grad w dV, the mean of the stress across the layer. What crosses it
 *  acts on the body. */
void MPMRigidContact::find_water()
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
    const double reach = LAYER_TO * field->lattice.h;
    std::vector<char> near(grid.blocks.size(), 0);
    for (std::size_t slot = 0; slot < near.size(); slot++) near[slot] = is_near(grid, slot, reach);
    pores[0]->find_forces_below_surface(*field, near, by_water, by_all);
    for (std::size_t slot = 0; slot < near.size(); slot++)
      for (int n = 0; near[slot] && n < NODES_PER_BLOCK; n++) {
        const auto &block = grid.blocks[slot];
        if ((block.alias >> n & 1) || !(block.owned >> n & 1)) continue;
        const int64_t node = (int64_t) slot * NODES_PER_BLOCK + n;
        const double *const of[2] = {&by_water[3 * node], &by_all[3 * node]};
        if (!(MathExtra::lensq3(of[1]) > 0.0)) continue;
        MPMPatchSums::Place place;
        double at[3];
        grid.node_position(node, at);
        from_center(at, place.at);
        SurfaceMesh::Point p, out;
        place_in_body(place.at, p);
        if (mesh->bound(p) > reach) continue;
        const double distance = mesh->distance_and_normal(p, out),
                     depth = distance / field->lattice.h;
        if (depth >= LAYER_TO) continue;
        const double w = std::min(1.0, (LAYER_TO - depth) / (LAYER_TO - LAYER_FROM));
        MathExtra::matvec(body.Q, out.data(), place.normal);
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

double MPMRigidContact::distance(const double *at, double far) const
{
  double r[3];
  from_center(at, r);
  SurfaceMesh::Point p, closest;
  place_in_body(r, p);
  return mesh->bound(p) > far ? far : mesh->distance(p, closest);
}

void MPMRigidContact::normal(const double *at, double *n) const
{
  double r[3];
  from_center(at, r);
  SurfaceMesh::Point p, out;
  place_in_body(r, p);
  mesh->distance_and_normal(p, out);
  MathExtra::matvec(body.Q, out.data(), n);
}
