// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// The impulse between two bodies at one node, and Coulomb's law, without a lattice.

#include "contact/mpm_node_contact.h"

#include "gtest/gtest.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

struct Node {
  double a[4] = {0.0, 0.0, 0.0, 2.0}, b[4] = {0.0, 0.0, 0.0, 6.0};    // velocity and mass
  MPMNodeContact contact = {};
  MPMContactLaw law;
  double dt = 0.1;

  Node(MPMContactLaw::Law kind, double vx, double vy)
  {
    law.law = kind;
    a[0] = vx;
    a[1] = vy;
    contact.ra = a;
    contact.rb = b;
    contact.n[0] = 1.0;
    contact.area = 0.5;
    contact.begin({}, {});
  }
  /** One iteration of two bodies that meet no others; returns the relative velocity after it. */
  std::array<double, 2> solve(bool decided = false)
  {
    contact.iterate(law, 2, 1, dt, decided);
    contact.push(2);
    return {a[0] - b[0], a[1] - b[1]};
  }
  double momentum(int d) const { return 2.0 * a[d] + 6.0 * b[d]; }
};

constexpr double MASS = 1.5;    // 2 * 6/(2 + 6)

TEST(Coulomb, ReturnsToTheCone)
{
  const CoulombFriction friction{0.3, 0.5};
  EXPECT_FALSE(friction.slides(0.5, 1.0));
  EXPECT_EQ(friction.share(0.5, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(friction.share(2.0, 1.0) * 2.0, 0.3);
  EXPECT_DOUBLE_EQ(friction.share(2.0, 1.0, 0.4) * 2.0, 0.7);
  EXPECT_EQ(friction.share(0.0, 0.0), 0.0);
  EXPECT_EQ(CoulombFriction().share(0.0, 1.0), 0.0);
  EXPECT_DOUBLE_EQ(friction.excess(1.0, 2.0), 0.4);
  EXPECT_DOUBLE_EQ(friction.excess(1.0, -2.0), 1.0);
  EXPECT_DOUBLE_EQ(friction.drag(2.0, 1.0, 0.1) * 2.0, 0.3);
  EXPECT_DOUBLE_EQ(friction.drag(0.01, 1.0, 0.1), 3.0);
}

TEST(NodeContact, TakesTheApproachAndKeepsMomentum)
{
  Node node(MPMContactLaw::FRICTIONLESS, 1.0, 0.4);
  const auto u = node.solve();
  EXPECT_NEAR(u[0], 0.0, 1e-15);
  EXPECT_NEAR(u[1], 0.4, 1e-15);
  EXPECT_NEAR(node.contact.normal, MASS, 1e-15);
  EXPECT_NEAR(node.momentum(0), 2.0, 1e-15);
  EXPECT_EQ(node.contact.state, MPMNodeContact::SLIDING);
}

TEST(NodeContact, DoesNotPull)
{
  for (const auto kind :
       {MPMContactLaw::FRICTIONLESS, MPMContactLaw::COULOMB, MPMContactLaw::STICK}) {
    Node node(kind, -1.0, 0.4);
    node.law.friction = {0.3, 0.3};
    const auto u = node.solve();
    EXPECT_EQ(u[0], -1.0);
    EXPECT_EQ(u[1], 0.4);
    EXPECT_EQ(node.contact.state, MPMNodeContact::OPEN);
  }
}

// the second part of a step of musl would make the velocities across the same
TEST(NodeContact, DoesNotTouchByRoundOff)
{
  for (const auto kind :
       {MPMContactLaw::FRICTIONLESS, MPMContactLaw::COULOMB, MPMContactLaw::STICK})
    for (const double sign : {1.0, -1.0}) {
      Node node(kind, sign * 1e-16, 0.4);
      node.law.friction = {0.3, 0.3};
      node.solve();
      EXPECT_EQ(node.contact.state, MPMNodeContact::OPEN);
    }
}

TEST(NodeContact, SticksBelowStaticFrictionAndSlidesAbove)
{
  Node below(MPMContactLaw::COULOMB, 1.0, 0.49), above(MPMContactLaw::COULOMB, 1.0, 0.51);
  below.law.friction = above.law.friction = {0.3, 0.5};
  EXPECT_NEAR(below.solve()[1], 0.0, 1e-15);
  EXPECT_EQ(below.contact.state, MPMNodeContact::STUCK);
  EXPECT_NEAR(above.solve()[1], 0.51 - 0.3, 1e-15);
  EXPECT_EQ(above.contact.state, MPMNodeContact::SLIDING);
  EXPECT_NEAR(above.contact.tangential[1], 0.3 * MASS, 1e-15);
}

TEST(NodeContact, AdheresUpToItsStrength)
{
  Node node(MPMContactLaw::ADHESIVE, -10.0, 0.0);
  node.law.normal_strength = 8.0;
  node.law.shear_strength = 4.0;
  node.law.release_work = 1.0;
  node.contact.adhesion = node.law.adhesion_at(0.1);
  EXPECT_DOUBLE_EQ(node.contact.adhesion, 0.6);
  EXPECT_EQ(node.law.adhesion_at(0.3), 0.0);
  node.solve();
  EXPECT_NEAR(node.contact.normal, -8.0 * 0.5 * 0.6 * 0.1, 1e-15);
  Node weak(MPMContactLaw::ADHESIVE, -0.01, 0.0);
  weak.law = node.law;
  weak.contact.adhesion = 0.6;
  EXPECT_NEAR(weak.solve()[0], 0.0, 1e-15);
}

TEST(NodeContact, WaterHasNoFriction)
{
  Node node(MPMContactLaw::COULOMB, 1.0, 1.0);
  node.law.friction = {0.3, 0.3};
  node.contact.water = 0.6 * MASS;
  node.solve();
  EXPECT_NEAR(node.contact.normal, MASS, 1e-15);
  EXPECT_NEAR(node.contact.tangential[1], 0.3 * 0.4 * MASS, 1e-15);
  Node apart(MPMContactLaw::COULOMB, -1.0, 1.0);    // the water alone pushes
  apart.contact.water = 0.6;
  apart.solve();
  EXPECT_NEAR(apart.contact.normal, 0.6, 1e-15);
  EXPECT_EQ(apart.contact.tangential[1], 0.0);
}

TEST(NodeContact, StateStaysWhereItIsDecided)
{
  Node node(MPMContactLaw::COULOMB, -1.0, 1.0);
  node.contact.state = MPMNodeContact::STUCK;
  const auto u = node.solve(true);    // no limit to a pull
  EXPECT_NEAR(u[0], 0.0, 1e-15);
  EXPECT_NEAR(u[1], 0.0, 1e-15);
  Node open(MPMContactLaw::COULOMB, 1.0, 1.0);
  open.contact.state = MPMNodeContact::OPEN;
  EXPECT_EQ(open.solve(true)[0], 1.0);
}

TEST(NodeContact, HeldBodyDoesNotYield)
{
  Node node(MPMContactLaw::FRICTIONLESS, 1.0, 0.0);
  MPMNodeWalls wall = {};
  wall.held = 1;    // b at rest along x
  node.contact.begin({}, wall);
  node.contact.iterate(node.law, 2, 1, node.dt, false);
  EXPECT_NEAR(node.contact.normal, 2.0, 1e-15);
  // a moves with a mirror node of the same mass
  MPMNodeWalls mirror = {};
  mirror.mirrored = 1;
  mirror.mass[0] = 4.0;
  mirror.velocity[0] = 0.5;
  mirror.start[0] = 1.0;
  node.contact.begin(mirror, wall);
  EXPECT_TRUE(mirror.moves_with_mirrors(node.a));
  node.contact.iterate(node.law, 2, 1, node.dt, false);
  EXPECT_NEAR(node.contact.normal, 4.0 * 0.5, 1e-15);
}
