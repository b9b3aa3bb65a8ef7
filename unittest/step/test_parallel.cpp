// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: mpi physics ranks
// mpi: 1 2 3 4
// timeout: 900

// Any number of ranks and any decomposition gives the result of one rank to round-off.

#include "mpm_lammps.h"

using namespace MPM_TEST;

static const std::string scene2d = plane("lj", "p f", "0 15 0 11", 2) + R"(
fix grid all mpm 0.5 MPM_OPTIONS
)" +
    bodies({{"one", "cylinder z 3.0 4.0 1.9 INF INF"}, {"two", "block 7.0 12.0 2.0 6.0 INF INF"}}) +
    R"(
fix m1 one mpm/material density 1.0 neohookean 10.0 0.3
fix m2 two mpm/material density 2.0 linear 20.0 0.2
fix floor all mpm/boundary ylo slip
fix g all gravity 0.05 vector 0 -1 0
velocity one set 0.6 -0.3 0
velocity two set -0.5 -0.1 0
timestep 0.03
)";

class Ranks : public ::testing::TestWithParam<std::string> {
 protected:
  void compare(const std::string &scene, const std::string &layout,
               const std::string &steps = "run 200\n")
  {
    OnRanks run(scene, steps, layout);
    const auto a = run.serial.gather();
    EXPECT_GT(a.size(), 100u);
    EXPECT_LT(measured("other ranks", run.difference()), 1.0e-12);

    // the scene does move and deform: the comparison means something
    double strain = 0.0;
    for (auto &s : a) grow(strain, s.F[0] - 1.0);
    EXPECT_GT(strain, 0.01);
  }
};

TEST_P(Ranks, Brick3d)
{
  compare(replaced(two_bodies, "MPM_OPTIONS", GetParam()), "");
}

TEST_P(Ranks, Rcb3d)
{
  compare(replaced(two_bodies, "MPM_OPTIONS", GetParam()),
          "comm_style tiled\nbalance 1.0 rcb\nfix lb all balance 20 1.0 rcb\n");
}

TEST_P(Ranks, ShiftedBrick2d)
{
  compare(replaced(scene2d, "MPM_OPTIONS", GetParam()),
          "fix lb all balance 20 1.0 shift xy 10 1.05\n");
}

INSTANTIATE_TEST_SUITE_P(Options, Ranks,
                         ::testing::Values("transfer apic",
                                           "shape linear transfer flip 0.99 scheme musl",
                                           "shape cubic transfer flip 1.0 scheme usf",
                                           "shape quadratic transfer apic scheme musl",
                                           "locking fbar",
                                           "transfer flip 1.0 scheme usavg locking fbar",
                                           "shape cubic locking pressure"));

// rings: two bodies that meet on an axis
class AxisymmetricRanks : public Ranks {};

TEST_P(AxisymmetricRanks, ShiftedBrick)
{
  auto scene = replaced(replaced(replaced(scene2d, "MPM_OPTIONS", "axisymmetric yes " + GetParam()),
                                 "boundary p f p", "boundary f f p"),
                        "velocity one set 0.6 -0.3 0\nvelocity two set -0.5 -0.1 0",
                        "velocity one set 0.2 0.7 0\nvelocity two set 0 -0.5 0");
  scene = replaced(scene, "region two block 7.0 12.0 2.0 6.0", "region two block 0.0 4.0 6.5 10.0");
  compare(scene + "fix axis all mpm/boundary xlo slip\n",
          "fix lb all balance 20 1.0 shift xy 10 1.05\n");
}

INSTANTIATE_TEST_SUITE_P(Options, AxisymmetricRanks,
                         ::testing::Values("transfer apic",
                                           "shape cpgimp transfer flip 0.99 scheme musl",
                                           "shape cubic transfer apic scheme usf", "locking both",
                                           "frame total locking fbar"));

// in the total frame, the two bodies are one, and neighbors on the lattice come to be far apart
class TotalRanks : public Ranks {};

TEST_P(TotalRanks, Bricks)
{
  compare(replaced(two_bodies, "MPM_OPTIONS", GetParam()), "", "timestep 0.02\nrun 300\n");
}

TEST_P(TotalRanks, Rcb)
{
  compare(replaced(two_bodies, "MPM_OPTIONS", GetParam()),
          "comm_style tiled\nbalance 1.0 rcb\nfix lb all balance 20 1.0 rcb\n",
          "timestep 0.02\nrun 300\n");
}

INSTANTIATE_TEST_SUITE_P(Options, TotalRanks,
                         ::testing::Values("frame total transfer apic",
                                           "frame total shape linear transfer flip 1.0 scheme musl",
                                           "frame total shape cubic transfer flip 0.9 scheme usf",
                                           "frame total locking both"));

// slabs along one axis: with 4 ranks some have no points at all
TEST(RanksWithoutPoints, Slabs)
{
  const std::string scene = space("lj", "f f f", "0 40 0 8 0 8") +
      body("block 1 6 2 6 2 6", "density 1.0 neohookean 10.0 0.3") +
      "velocity all set 1.0 0.0 0.0\nvelocity all ramp vy -0.8 0.8 x 1 6 sum yes\ntimestep 0.05\n";
  OnRanks run(scene, "run 400\n", "processors " + std::to_string(nranks()) + " 1 1\n");
  EXPECT_LT(measured("other ranks", run.difference()), 1.0e-12);
}

// walls of all kinds, plasticity, variable steps, energies: sums must not depend on ranks
static const std::string walls = space("lj", "f f f", "0 12 0 8 0 8") +
    body("block 1 11 1 7 0 4",
         "density 1.0 eos linear 20.0 strength j2 10.0 0.3 hardening linear 1.0 viscosity "
         "artificial 1.5 0.06",
         "1.0 MPM_OPTIONS") +
    R"(
fix floor all mpm/boundary zlo stick
fix side all mpm/boundary xlo xhi slip friction 0.3
region ball sphere 5.7 4.2 6.5 2.0
fix push all mpm/boundary region ball separate friction 0.2 velocity 0.2 0.1 -0.6
fix g all gravity 0.05 vector 0.3 0 -1
fix step all mpm/dt 0.3
velocity all set 0.1 -0.05 -0.2
compute e all mpm/energy
compute p all mpm/atom eplastic
compute yield all reduce sum c_p
thermo 50
thermo_style custom step dt c_yield c_e
)";

PARAMETER_TEST(Walls, ReactionsAndEnergiesAgree, std::string,
               Values("transfer apic", "transfer flip 0.98",
                      "transfer apic scheme musl shape cubic", "transfer apic scheme usf"))
{
  LONG_AFTER(3);
  std::string scene = replaced(walls, "MPM_OPTIONS", GetParam());
  if (GetParam().find("usf") != std::string::npos)    // which refuses these
    scene = replaced(replaced(scene, "slip friction 0.3", "slip"), "separate friction 0.2", "slip");
  for (const char *layout :
       first_of(2, {"comm_style tiled\nbalance 1.0 rcb\n", "processors 1 * 1\n", ""})) {
    OnRanks run(scene, "run 200\n", layout);
    auto &serial = run.serial, &parallel = run.parallel;
    EXPECT_LT(measured("other ranks", run.difference()), 1.0e-12);
    EXPECT_NEAR(parallel.time(), serial.time(), 1.0e-12 * serial.time());
    EXPECT_GT(serial.evaluate("c_yield"), 0.1);
    EXPECT_NEAR(parallel.evaluate("c_yield"), serial.evaluate("c_yield"), 1.0e-11);

    // work of each wall and reactions, in units of the largest
    std::vector<double> a, b;
    for (const char *wall : {"floor", "side", "push"})
      for (int d = -1; d < 3; d++) {
        auto *s = serial.fix(wall);
        auto *p = parallel.fix(wall);
        a.push_back(d < 0 ? s->compute_scalar() : s->compute_vector(d));
        b.push_back(d < 0 ? p->compute_scalar() : p->compute_vector(d));
      }
    double scale = 0.0;
    for (double value : a) grow(scale, value);
    EXPECT_GT(scale, 1.0);
    for (std::size_t k = 0; k < a.size(); k++) EXPECT_NEAR(a[k], b[k], 1.0e-11 * scale) << k;

    // ledger
    const double total = serial.evaluate("c_e");
    EXPECT_GT(total, 0.1);
    for (int k = 1; k <= 10; k++) {
      const std::string entry = "c_e[" + std::to_string(k) + "]";
      EXPECT_NEAR(parallel.evaluate(entry), serial.evaluate(entry), 1.0e-11 * total) << entry;
    }
  }
}

// A bar across ranks, at rest. Points next to a border x = 8k reach the nodes 8k-1, 8k, 8k+1 of
// both ranks, and in the plane of the border 7x7 nodes. Blocks next to a wall are sent as a whole
TEST(Halo, SendsNodesThatPointsOfBothRanksReach)
{
  const std::string n = std::to_string(nranks());
  const auto scene = [&](const std::string &wall) {
    return "processors " + n + " 1 1\n" +
        space("lj", "f f f", "0 " + std::to_string(8 * nranks()) + " 0 8 -8 8", 1, 0.2) +
        body("block INF INF 2 6 -2 2", "density 1.0 neohookean 10.0 0.3") + wall +
        "timestep 0.01\nrun 2\n";
  };
  const double record = 4 * sizeof(double), borders = 2.0 * (nranks() - 1);
  Scene plain(scene("")), near(scene("fix w all mpm/boundary xlo stick\n"));
  EXPECT_EQ(plain.fix_vector("grid", 6)[5], borders * record * 3 * 7 * 7);
  EXPECT_EQ(near.fix_vector("grid", 6)[5], plain.fix_vector("grid", 6)[5]);

  for (const char *wall : {"", "fix w all mpm/boundary zhi xlo slip\n",
                           "region r block INF INF INF INF INF -1.5\n"
                           "fix w all mpm/boundary region r separate\n"}) {
    SCOPED_TRACE(wall);
    Scene run(scene(wall));
    double counted[2] = {0.0, 0.0};
    run.each_node([&](const Scene::Node &node) {
      if (!node.owned) return;
      counted[0] += node.mass;
      counted[1] += node.mass > 0.0;
    });
    MPI_Allreduce(MPI_IN_PLACE, counted, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_NEAR(counted[0], 8.0 * nranks() * 16.0, 1.0e-10);
    EXPECT_EQ(counted[1], (8.0 * nranks() + 3) * 7 * 7);
  }
}

// A wall pairs nodes on its two sides, and a cut cell those of several planes: with a border of
// ranks two cells above it a rank needs nodes that only the other's points reach
PARAMETER_TEST(HaloWalls, BelowABorder, std::string,
               Values("slip", "stick", "slip friction 0.3", "separate"))
{
  for (const char *origin : {"0.0", "0.4"}) {
    SCOPED_TRACE(origin);
    const std::string n = std::to_string(nranks()), top = std::to_string(2 * std::max(2, nranks()));
    OnRanks run(space("lj", "p p f", "0 8 0 8 0 " + top, 1, 0.2) +
                    body("block INF INF INF INF 0 4", "density 1.0 neohookean 20.0 0.3",
                         std::string("1.0 origin 0 0 ") + origin) +
                    "fix w all mpm/boundary zlo " + GetParam() +
                    "\nfix g all gravity 0.1 vector 0.3 0 -1\nvelocity all ramp vx -0.4 0.4 z 0 4\n"
                    "velocity all ramp vz 0 -0.4 x 0 8\ntimestep 0.03\n",
                "run 100\n", "processors 1 1 " + n + "\n");
    EXPECT_LT(measured("other ranks", run.difference()), 1.0e-12);
  }
}

// ranks that share a node add in the same order, so that they take the same decisions on it
TEST(Halo, SharersHaveTheSameBits)
{
  Scene run(replaced(two_bodies, "MPM_OPTIONS", "transfer apic") + "run 60\n");
  struct Value {
    int tag;    // a number of the node
    double record[4];
  };
  std::vector<Value> mine;
  auto &grid = run.grid();
  for (std::size_t s = 0; s < grid.blocks.size(); s++)
    for (int n = 0; n < MPM_NS::NODES_PER_BLOCK; n++) {
      const auto &block = grid.blocks[s];
      if (!((block.reached & ~block.alias) >> n & 1)) continue;
      int index[3];
      grid.node_index(block, n, index);
      Value value = {(index[0] * 64 + index[1]) * 64 + index[2], {}};
      std::copy_n(grid.record((int) s, n), 4, value.record);
      mine.push_back(value);
    }
  const auto all = all_by_tag(mine, MPI_COMM_WORLD);
  int several = 0;
  for (std::size_t k = 1, sharers = 1; k < all.size(); k++) {
    sharers = all[k].tag == all[k - 1].tag ? sharers + 1 : 1;
    if (sharers > 2 && all[k].record[3] > 0.0) several++;
    if (sharers > 1) EXPECT_FALSE(memcmp(all[k].record, all[k - 1].record, sizeof(all[k].record)));
  }
  if (nranks() > 2) EXPECT_GT(several, 20);
}

// two fields with lattices of their own, which know nothing of each other but use the same halo
TEST(TwoFields, DifferentLattices)
{
  const std::string scene = space("lj", "p p f", "0 12 0 8 0 8", 2, 0.2) + R"(
fix all_points all mpm 1.0
region one block 1 5 1 5 1 4
region two sphere 8.5 5 4 2.4
create_points 1 region one ppc 2
create_points 2 region two spacing 0.3
unfix all_points
group one type 1
group two type 2
fix coarse one mpm 1.0
fix fine two mpm 0.5 transfer flip 0.99 shape cubic origin 0.1 0.2 0.0
fix m1 one mpm/material density 1.0 neohookean 10.0 0.3
fix m2 two mpm/material density 2.0 eos linear 20.0 strength j2 5.0 0.05
fix floor all mpm/boundary zlo stick field coarse
fix ground all mpm/boundary zlo slip field fine
fix step all mpm/dt 0.3
velocity one set 0.6 0.35 -0.4
velocity two set -0.5 -0.4 -1.5
)";
  for (const char *layout :
       first_of(1, {"comm_style tiled\nfix lb all balance 20 1.0 rcb\n", ""})) {
    OnRanks run(scene, "run 200\n", layout);
    EXPECT_LT(measured("other ranks", run.difference()), 1.0e-12);
    for (const char *wall : {"floor", "ground"}) {
      const double reaction = run.serial.fix_vector(wall, 3)[2];
      EXPECT_GT(std::abs(reaction), 1.0e-3) << wall;
      EXPECT_NEAR(run.parallel.fix_vector(wall, 3)[2], reaction, 1.0e-10);
    }
  }
}

// grains of pair style granular that fall on a soft block. LAMMPS sums pair forces in the order of
// its neighbor lists, and a contact that closes a rounding error earlier is amplified: looser.
static const char *const grains = R"(
units lj
boundary p p f
atom_style hybrid sphere mpm
neighbor 0.3 multi
comm_modify vel yes mode multi
region box block 0 12 0 12 0 12
create_box 2 box
fix grid all mpm 1.0
region body block INF INF INF INF 0 4
create_points 1 region body ppc 2 diameter 0.5
group body type 1
fix soft body mpm/material density 1.0 neohookean 20.0 0.3
fix floor all mpm/boundary zlo stick
MPM_GRAINS
group grains type 2
set type 2 diameter 1.8 density 2.0
velocity grains set 0.2 0.1 -1.0
pair_style granular
pair_coeff * * hertz/material 50.0 0.5 0.3 tangential mindlin NULL 0.5 0.4
neigh_modify exclude type 1 1
fix move grains nve/sphere
fix g all gravity 0.5 vector 0 0 -1
timestep 0.02
thermo 50
)";

TEST(Grains, OnABlock)
{
  // one by one: IDs that create_atoms gives to many depend on the number of ranks
  std::string rain;
  for (int k = 0; k < 48; k++)
    rain += strprintf("create_atoms 2 single %.3f %.3f %.3f\n", 1.5 + 2.9 * (k % 4) + 0.2 * sin(k),
                      1.5 + 2.9 * (k / 4 % 4) + 0.2 * sin(3 * k),
                      5.4 + 2.4 * (k / 16) + 0.2 * sin(5 * k));
  const std::string scene = replaced(grains, "MPM_GRAINS\n", rain);
  for (const char *layout : first_of(1, {"fix lb all balance 50 1.0 shift xyz 5 1.05\n", ""})) {
    OnRanks run(scene, "run 200\n", layout);
    EXPECT_LT(measured("grains on other ranks", run.difference()), 1.0e-11);

    // grains and points have met: a block that is left alone stays at rest sideways
    double speed = 0.0, ngrains = 0.0;
    for (const auto &s : run.serial.gather()) {
      if (s.type == 1.0) grow(speed, s.v[0]);
      if (s.type == 2.0) ngrains++;
    }
    EXPECT_EQ(ngrains, 48.0);
    EXPECT_GT(speed, 0.01);
  }
}

// shifting everything by a fraction of h changes nothing in a periodic box with its lattice
TEST(Translation, LatticeAndBodyTogether)
{
  // points of create_points follow the lattice, so that both bodies are the same set of points
  const auto scene = [](double s) {
    return space("lj", "p p p", "0 8 0 8 0 8") +
        strprintf("fix grid all mpm 1.0 origin %g %g %g\nregion one sphere %g %g %g 1.9\n"
                  "create_points 1 region one ppc 2\n"
                  "fix m1 all mpm/material density 1.0 neohookean 10.0 0.3\n"
                  "velocity all set 0.6 0.35 -0.4\nvelocity all ramp vx -0.5 0.5 y %g %g sum yes\n"
                  "timestep 0.05\nrun 200\n",
                  s, s, s, 4 + s, 4 + s, 4 + s, 2 + s, 6 + s);
  };
  Scene a(scene(0.0)), b(scene(0.375));
  auto sa = a.gather(), sb = b.gather();
  ASSERT_EQ(sa.size(), sb.size());
  for (auto &s : sb)
    for (double &x : s.x) x -= 0.375;
  // tags follow positions in both
  EXPECT_LT(difference(sa, sb), 1.0e-11);
}
