/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* The velocities of two bodies at a node after the momentum equation show whether they approach
   each other along the normal of the interface. If so, equal and opposite impulses remove the
   approach, and in the plane of the interface as much of the sliding as the law of friction allows:

     n from a to b,  m = m_a m_b/(m_a + m_b),  u = v_a - v_b
     J_n = max(0, m u.n),   J_t = m (u - (u.n) n) scaled down to at most mu J_n

   (S.G. Bardenhagen, J.U. Brackbill, D. Sulsky, Comput. Methods Appl. Mech. Eng. 187 (2000) 529;
   with a normal that both bodies share: J.A. Nairn, CMES 92 (2013) 271.)

   Pore water takes a part J_w of J_n, dt int N p n over the surface of a body, as on walls. The
   rest is between grains and gives friction: J_t <= mu (J_n - J_w). Where J_n would be below J_w,
   grains part, and the water alone pushes.

   A bond with the opening d at the start of the step and the compliance f is a spring. Its impulse

     J = -A dt (d + theta dt w)/f,   theta = c/(f + c),  c = A dt^2/m

   with the velocity w = -u at which it opens at the end of the step, is that of the opening at the
   start where the spring is soft, which keeps energy, and at the end where it is stiff, which is
   stable. The largest J is that of the strength that is left. */

#include "contact/mpm_node_contact.h"

#include "force.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <mpi.h>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// the approach of bodies that slide along each other is round-off, which must not decide whether
// they stick, or touch in the second part of a step of musl: it must be at least this part of their
// speeds

static constexpr double APPROACH = 1.0e-12;

void MPMContactLaw::declare_law(Options &o, bool bonds)
{
  using namespace option;
  std::vector<OptionWord> laws = {
      {"frictionless", FRICTIONLESS, "bodies slide freely"},
      {"coulomb",
       COULOMB,
       "bodies slide with friction",
       {number(friction.kinetic, "mu", NOT_NEGATIVE, "1", "coefficient of friction"),
        optional(number(friction.still, "mu_s", NOT_NEGATIVE, "1",
                        "coefficient of static friction, not below mu; default: mu"))}},
      {"stick", STICK, "bodies do not slide while they press on each other"}};
  if (bonds) {
    const auto additional = optional(number(friction.kinetic, "mu", NOT_NEGATIVE, "1",
                                            "coefficient of additional friction; default: 0"));
    laws.push_back({"adhesive",
                    ADHESIVE,
                    "bodies that touch resist separation and sliding",
                    {number(normal_strength, "sn", NOT_NEGATIVE, "pressure", "normal strength"),
                     number(shear_strength, "ss", NOT_NEGATIVE, "pressure", "shear strength"),
                     number(release_work, "work", NOT_NEGATIVE, "pressure*distance",
                            "work to separate the bodies, per area"),
                     additional}});
    laws.push_back(
        {"cohesive",
         COHESIVE,
         "bodies that touch at the start are bonded, until the bond has broken",
         {numbers(cohesion.strengths, 2, "sn ss", POSITIVE, "pressure",
                  "strengths in tension and in shear"),
          numbers(cohesion.energies, 2, "GI GII", POSITIVE, "pressure*distance",
                  "energies of separation in tension (mode I) and in shear (mode II), per area"),
          additional}});
  }
  o.add("law", {word(law, laws)}).standard("frictionless");
}

OptionRule MPMContactLaw::coefficients() const
{
  return {law == COULOMB && friction.still >= 0.0 && friction.still < friction.kinetic, "law",
          "coulomb: the coefficient of static friction must not be below that of friction: {law}"};
}

void MPMContactLaw::complete()
{
  if (friction.still < 0.0 || law == ADHESIVE || law == COHESIVE) friction.still = friction.kinetic;
}

bool MPMContactLaw::operator==(const MPMContactLaw &other) const
{
  return law == other.law && friction.kinetic == other.friction.kinetic &&
      friction.still == other.friction.still && normal_strength == other.normal_strength &&
      shear_strength == other.shear_strength && release_work == other.release_work &&
      cohesion == other.cohesion;
}

double MPMContactLaw::adhesion_at(double opening) const
{
  return std::max(0.0, 1.0 - opening * normal_strength / (2.0 * release_work));
}

bool MPMNodeWalls::moves_with_mirrors(const double *record) const
{
  bool moves = false;
  for (int d = 0; d < 3; d++) moves = moves || (mirrored >> d & 1 && mass[d] > record[3]);
  return moves;
}

double MPMNodeWalls::velocity_of(const double *record, int d) const
{
  if (held >> d & 1) return velocity[d];
  if (mirrored >> d & 1) return velocity[d] + (record[d] - start[d]) * record[3] / mass[d];
  return record[d];
}

void MPMNodeContact::begin(const MPMNodeWalls &of_a, const MPMNodeWalls &of_b)
{
  walls_a = of_a;
  walls_b = of_b;
  alike = of_a.held == of_b.held && of_a.mirrored == of_b.mirrored;
  left = alike ? 0 : (char) ((of_a.outside & of_b.outside) | (of_a.held & of_b.held));
  normal = tangential[0] = tangential[1] = tangential[2] = 0.0;
}

void MPMNodeContact::push(int dim) const
{
  for (int d = 0; d < dim; d++) {
    ra[d] -= impulse(d) / ra[3];
    rb[d] += impulse(d) / rb[3];
  }
}

/** Finds the velocity u of a relative to b, and un along the normal. Returns the mass that yields
 *  to an impulse.
 *
 *  A body that a wall holds does not yield: the wall takes the impulse of contact. If it were
 *  treated as free, the other body would move on into it, a little in each step.
 *
 *  At a mirror, a node moves with its mirror node, and both have the mass of both; contact pushes
 *  on each. Components that are mirrored in both bodies are the same at both nodes: contact at the
 *  node inside determines them. */
double MPMNodeContact::approach(int dim, int neighbors, double *u, double &un) const
{
  un = u[0] = u[1] = u[2] = 0.0;
  if (alike) {
    for (int d = 0; d < dim; d++) {
      u[d] = ra[d] - rb[d];
      un += u[d] * n[d];
    }
    return ra[3] * rb[3] / (ra[3] + rb[3]) / neighbors;
  }
  double inverse = 0.0, square = 0.0;
  const int away = walls_a.outside & walls_b.outside;
  for (int k = 0; k < 2; k++) {
    const MPMNodeWalls &walls = k ? walls_b : walls_a;
    const double *const r = k ? rb : ra;
    for (int d = 0; d < dim; d++) {
      if (left >> d & 1) continue;
      const double v = walls.velocity_of(r, d);
      u[d] += k ? -v : v;
      if (walls.held >> d & 1) continue;
      inverse += n[d] * n[d] / (walls.mirrored >> d & 1 ? walls.mass[d] : r[3]);
    }
  }
  for (int d = 0; d < dim; d++) {
    un += u[d] * n[d];
    if (!(away >> d & 1)) square += n[d] * n[d];
  }
  return inverse * std::max(ra[3], rb[3]) > 1.0e-6 ? square / inverse / neighbors : 0.0;
}

/** Limits the normal impulse by the law, and sets the state. length: size of the tangential impulse
 *  that would stop sliding. Returns the share of this impulse that remains. */
double MPMNodeContact::limit(const MPMContactLaw &law, double mass, int dim, double length,
                             double dt, double &J)
{
  const double unit = law.pressure_unit * area * adhesion * dt;
  const double by_water = std::max(water, 0.0);
  double speeds[2] = {0.0, 0.0};
  for (int d = 0; d < dim; d++) {
    speeds[0] += ra[d] * ra[d];
    speeds[1] += rb[d] * rb[d];
  }
  const double round_off = APPROACH * mass * (sqrt(speeds[0]) + sqrt(speeds[1]));
  const bool parts = J < -round_off;
  J = std::max(J,
               by_water - (law.law == MPMContactLaw::ADHESIVE ? law.normal_strength * unit : 0.0));
  if (std::fabs(J - by_water) <= round_off) J = by_water;
  const double grains = J > by_water ? J - water : 0.0;
  const double keep = law.law == MPMContactLaw::STICK
      ? (grains > 0.0 ? 1.0 : 0.0)
      : law.friction.share(length, grains, law.shear_strength * unit);
  const bool open = law.keeps_rest ? parts : J == 0.0 && keep == 0.0;
  state = open ? OPEN : keep == 1.0 ? STUCK : SLIDING;
  return keep;
}

/** From the impulses that would make bodies stick, finds those of the bond, of contact where it is
 *  closed, and of friction. */
void MPMNodeContact::hold_together(const MPMContactLaw &law, double mass, int dim, double dt,
                                   double &J, double *t)
{
  state = STUCK;
  if (!(mass > 0.0)) return;
  const double unit = law.pressure_unit * area * dt, c = unit * dt / mass;
  double along = 0.0, aside[3] = {0.0, 0.0, 0.0}, spring[3] = {0.0, 0.0, 0.0}, square = 0.0;
  for (int d = 0; d < dim; d++) along += bond->opening[d] * n[d];
  along = std::max(along, 0.0);
  for (int d = 0; d < dim; d++) {
    aside[d] = bond->opening[d] - along * n[d];
    square += aside[d] * aside[d];
  }
  const double share = MPMCohesiveLaw::share_of_shear(along, sqrt(square)),
               f = law.cohesion.compliance(bond->reached, share) * (1.0 - bond->reached) /
      (1.0 - bond->damage),
               part = std::isfinite(f) ? c / (f + c) : 0.0;
  const auto pull = [&](double opening, double stick) {
    return std::isfinite(f) && unit > 0.0 ? (part * c * stick - unit * opening) / (f + part * c)
                                          : 0.0;
  };
  double normal_pull = pull(along, J), shear = 0.0;
  for (int d = 0; d < dim; d++) {
    spring[d] = pull(aside[d], t[d]);
    shear += spring[d] * spring[d];
  }
  shear = sqrt(shear);
  const double tension = std::max(-normal_pull, 0.0), all = sqrt(tension * tension + shear * shear),
               most = unit * (1.0 - bond->damage) *
      law.cohesion.strength(MPMCohesiveLaw::share_of_shear(tension, shear)),
               keep = all > most ? most / all : 1.0;
  if (normal_pull < 0.0) normal_pull *= keep;

  const double closing = J - mass * along / dt;
  J = std::max(normal_pull, closing);
  double rest[3] = {0.0, 0.0, 0.0}, length = 0.0;
  for (int d = 0; d < dim; d++) {
    rest[d] = t[d] - keep * spring[d];
    length += rest[d] * rest[d];
  }
  const double rub = J > 0.0 && length > 0.0 ? law.friction.share(sqrt(length), bond->damage * J)
                                             : 0.0;
  for (int d = 0; d < dim; d++) t[d] = keep * spring[d] + rub * rest[d];
  if (keep < 1.0 || bond->damage > 0.0) state = SLIDING;
}

double MPMNodeContact::iterate(const MPMContactLaw &law, int dim, int neighbors, double dt,
                               bool decided)
{
  double u[3], un, t[3] = {0.0, 0.0, 0.0}, length = 0.0;
  const double m = approach(dim, neighbors, u, un);
  double J = normal + m * un;
  for (int d = 0; d < dim; d++) {
    t[d] = tangential[d] + m * (u[d] - un * n[d]);
    length += t[d] * t[d];
  }
  length = sqrt(length);
  if (decided && state == OPEN) J = 0.0;
  double keep = 1.0;
  if (bond)
    hold_together(law, m, dim, dt, J, t);
  else
    keep = decided ? (state == STUCK ? 1.0 : 0.0) : limit(law, m, dim, length, dt, J);

  double change = fabs(J - normal), rounding = 0.0;
  normal = J;
  for (int d = 0; d < dim; d++) {
    change += fabs(keep * t[d] - tangential[d]);
    tangential[d] = keep * t[d];
    rounding += law.rounded * m * (fabs(ra[d]) + fabs(rb[d]));
  }
  return change / (fabs(J) + length + rounding + 1.0e-300);
}

double MPMContactReport::Entry::add(const MPMNodeContact &pair, int dim)
{
  double friction = 0.0;
  count += 1.0;
  for (int d = 0; d < dim; d++) {
    impulse[d] += pair.impulse(d);
    friction += (pair.bond ? pair.impulse(d) : pair.tangential[d]) * (pair.rb[d] - pair.ra[d]);
  }
  return friction;
}

void MPMContactReport::set_bodies(int n)
{
  nbodies = n;
  entries.assign(n * (n - 1) / 2, {});
}

void MPMContactReport::begin_step(double dt)
{
  dt_last = dt;
  for (auto &entry : entries) entry = {{0.0, 0.0, 0.0}, 0.0, entry.work};
}

double MPMContactReport::work()
{
  double mine = 0.0, all;
  for (const auto &entry : entries) mine += entry.work;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all * force->mvv2e;
}

double MPMContactReport::at(int row, int column)
{
  if (sums_step != update->ntimestep) {
    sums_step = update->ntimestep;
    std::vector<double> mine;
    for (const auto &[impulse, count, work] : entries) {
      for (const double J : impulse)
        mine.push_back(dt_last > 0.0 ? J / (dt_last * force->ftm2v) : 0.0);
      mine.push_back(count);
      mine.push_back(work * force->mvv2e);
    }
    sums.resize(mine.size());
    MPI_Allreduce(mine.data(), sums.data(), (int) mine.size(), MPI_DOUBLE, MPI_SUM, world);
  }
  return sums[COLUMNS * row + column];
}
