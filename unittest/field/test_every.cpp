// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// mpi: 1 2

// Keyword every of fix mpm: K steps of the run under one of the points.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** Where points are on the lattice, in order of tags; the last three: velocity. */
static std::vector<std::array<double, 7>> places(Scene &run)
{
  struct Row {
    double tag, x[6];
  };
  std::vector<Row> mine;
  for (const auto &field : run.fields())
    for (int i = 0; i < run.n(); i++) {
      if (!run.is_point(i, field)) continue;
      Row row{(double) run.lmp->atom->tag[i], {0.0}};
      double x[3];
      run.lmp->domain->unmap(run.x()[i], run.lmp->atom->image[i], x);
      for (int d = 0; d < 3; d++) {
        row.x[d] = x[d] - run.waiting(i, d, field);
        row.x[3 + d] = run.v()[i][d];
      }
      mine.push_back(row);
    }
  std::vector<std::array<double, 7>> rows;
  for (const auto &row : all_by_tag(mine, run.lmp->world))
    rows.push_back({row.tag, row.x[0], row.x[1], row.x[2], row.x[3], row.x[4], row.x[5]});
  return rows;
}

static double largest_difference(const std::vector<std::array<double, 7>> &a,
                                 const std::vector<std::array<double, 7>> &b)
{
  EXPECT_EQ(a.size(), b.size());
  double worst = a.size() == b.size() ? 0.0 : INFINITY;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); k++)
    for (int c = 0; c < 7; c++) worst = std::max(worst, std::abs(a[k][c] - b[k][c]));
  return measured("difference", worst);
}

// What does not ask when a step of the run is: K steps are a larger one, to round-off. Bodies at
// rest at the start, whose place in the middle of the steps is that at their start.
static const std::string head = space("lj", "p p f", "0 8 0 8 0 12", 2);
static const std::string block = "region b block 2 6 2 6 0 4\ncreate_points 1 region b ppc 2\n";
static const std::string rubber = "fix m all mpm/material density 1.0 neohookean 40.0 0.3\nfix g "
                                  "all gravity 0.5 vector 0.6 0 -1\n";
static const std::string floors = "fix floor all mpm/boundary zlo stick\n";

struct Feature {
  const char *name;
  std::string text;
  friend void PrintTo(const Feature &feature, std::ostream *out) { *out << feature.name; }
};

static const Feature features[] = {
    {"Apic", "fix grid all mpm 1.0 EVERY\n" + block + rubber + floors},
    {"FlipMusl",
     "fix grid all mpm 1.0 transfer flip 0.99 scheme musl EVERY\n" + block + rubber + floors},
    {"Usavg", "fix grid all mpm 1.0 shape cubic scheme usavg EVERY\n" + block + rubber + floors},
    {"Total", "fix grid all mpm 1.0 frame total EVERY\n" + block + rubber + floors},
    {"Cpdi2", "fix grid all mpm 1.0 shape cpdi2 EVERY\n" + block + rubber + floors},
    {"MovingFace",
     "variable v equal 0.3*sin(3*time)\nfix grid all mpm 1.0 EVERY\n" + block + rubber +
         "fix floor all mpm/boundary zlo stick velocity v_v 0 0\n"},
    {"MovingRegion",
     "variable up equal 0.1*time^2\nregion plate block INF INF INF INF -2 0.3 move NULL NULL v_up\n"
     "fix grid all mpm 1.0 EVERY\nregion b block 2 6 2 6 0.5 4\ncreate_points 1 region b ppc 2\n" +
         rubber + "fix push all mpm/boundary region plate separate friction 0.2\n"},
    {"Contact",
     "region b block 2 6 2 6 0 3\nregion c block 3 5 2.5 4.5 3 5\n"
     "create_points 1 region b spacing 0.5\ncreate_points 2 region c spacing 0.5\n"
     "group low type 1\ngroup high type 2\n"
     "fix low low mpm 1.0 EVERY\nfix high high mpm 1.0 EVERY\n" +
         rubber + floors + "fix c all mpm/contact low high law coulomb 0.2\n"},
};

PARAMETER_TEST(LargerStep, IsTheSame, Feature, ValuesIn(features))
{
  const auto scene = [](int every) {
    return head +
        replaced(GetParam().text, "EVERY", every == 1 ? "" : strprintf("every %d", every)) +
        strprintf("timestep %.17g\n", 0.04 / every);
  };
  Scene one(scene(1) + "run 60\n");
  const auto expected = places(one);
  for (const int every : {2, 5}) {
    Scene many(scene(every) + strprintf("run %d\n", 23 * every + 1) +
               strprintf("run %d\n", 37 * every - 1));
    EXPECT_NEAR(many.time(), one.time(), 1.0e-12);
    EXPECT_LT(largest_difference(places(many), expected), 1.0e-11) << every;
  }
  double moved = 0.0;
  for (const auto &row : expected)
    for (int c = 4; c < 7; c++) moved = std::max(moved, std::abs(row[c]));
  EXPECT_GT(moved, 0.05);
}

// A restart file that is written between two steps of the points: bitwise as without
TEST(LargerStep, GoesOnFromARestartFile)
{
  for (const auto &feature : features) {
    if (std::string(feature.name) != "MovingFace" && std::string(feature.name) != "MovingRegion")
      continue;
    const auto scene = head + replaced(feature.text, "EVERY", "every 5") + "timestep 0.008\n";
    Continued run(scene, 53, "neighbor 0.3 bin\n" + lines_again(scene), 49);
    EXPECT_TRUE(identical(run.whole.gather(), run.again.gather())) << feature.name;
  }
}

// Points that fail are deleted in the same steps of the cycle.
TEST(LargerStep, DeletesTheSamePoints)
{
  const auto scene = [](int every) {
    return plane("lj", "f f", "-2 30 -2 8") + "region bar block 0 20 1 5 INF INF\n" +
        strprintf("fix grid all mpm 1.0 failed delete every %d\n", every) +
        "create_points 1 region bar ppc 2\n"
        "fix m all mpm/material density 1.0 eos linear 100.0 strength elastic 60.0 damage rankine "
        "3.0 "
        "after none\nregion left block INF 1 INF INF INF INF\nregion right block 19 INF INF INF "
        "INF INF\n"
        "fix l all mpm/boundary region left stick\n"
        "fix r all mpm/boundary region right stick velocity 0.5 0 0\n" +
        strprintf("timestep %.17g\n", 0.02 / every);
  };
  Scene one(scene(1) + "run 250\n"), many(scene(5) + "run 1250\n");
  const double *a = one.fix_vector("grid", 11), *b = many.fix_vector("grid", 11);
  EXPECT_GT(a[6], 3.0);
  EXPECT_EQ(a[6], b[6]);
  for (int k = 7; k < 11; k++) EXPECT_NEAR(a[k], b[k], 1e-11);
  EXPECT_LT(largest_difference(places(many), places(one)), 1e-10);
}

// What grains see: points that move without a jump at the start of a run, and are, with a constant
// force, where and as fast as they should be in each step of the cycle
static std::string free_block(int every, double modulus)
{
  return replaced(head, "p p f", "p p p") +
      body("block 2 6 2 6 3 7", strprintf("density 1.0 neohookean %g 0.3", modulus),
           strprintf("1.0 every %d", every));
}

SERIAL_TEST(Seen, MotionIsThatOfTheTime)
{
  const double dt = 0.01, v0 = 0.4, a = -0.25;
  for (const int every : {1, 2, 5, 20}) {
    Scene run(free_block(every, 10.0) +
              strprintf("velocity all set %g 0 0\ntimestep %g\n", v0, dt));
    const double start = run.evaluate("xcm(all,x)"), height = run.evaluate("xcm(all,z)");
    double worst = 0.0;
    bool first = true;
    run.each_step([&](double **force) {    // all points have the same motion
      for (int i = 0; i < run.n(); i++) force[i][2] = a * run.mass()[i];
      const double t = run.time();
      for (int i = 0; i < run.n() && !first; i++) {
        double x[3];
        run.lmp->domain->unmap(run.x()[i], run.lmp->atom->image[i], x);
        worst = std::max(worst, std::abs(x[0] - run.reference(i)[0] - v0 * t));
      }
      if (first) run.set_reference();
      first = false;
    });
    run.commands(strprintf("run %d post no\n", 200 / every * every));
    const double t = run.time();
    EXPECT_LT(measured("uniform motion", worst), 1.0e-12);
    EXPECT_NEAR(run.evaluate("xcm(all,x)"), start + v0 * t, 1.0e-12);
    EXPECT_NEAR(run.evaluate("vcm(all,z)"), a * t, 1.0e-12);
    // the velocity at the end of the last step is taken for its whole length
    EXPECT_NEAR(run.evaluate("xcm(all,z)") - height, 0.5 * a * t * (t + dt), 1.0e-12);
  }
}

// A body on a linear spring: the mean force of K steps is that at the place on the lattice, as if
// the step were a larger one. Leapfrog keeps v^2 + omega^2 x (x + dt v) to round-off, and its phase
// is theta in each step with cos(theta) = 1 - (omega dt)^2/2.
SERIAL_TEST(Seen, SpringIsNotDamped)
{
  const double omega = 1.0, step = 0.5;
  for (const int every : {1, 2, 5, 10}) {
    Scene run(free_block(every, 1.0) +
              strprintf("velocity all set 0.3 0 0\ntimestep %.17g\n", step / every));
    run.set_reference();
    const auto seen = [&](int i) {
      double x[3];
      run.lmp->domain->unmap(run.x()[i], run.lmp->atom->image[i], x);
      return x[0] - run.reference(i)[0];
    };
    run.each_step([&](double **force) {
      for (int i = 0; i < run.n(); i++) force[i][0] = -omega * omega * run.mass()[i] * seen(i);
    });
    double least = 1.0e300, most = 0.0;
    int turns = 0;
    double last = 1.0;
    const int cycles = 500;
    for (int k = 0; k < cycles; k++) {
      run.commands(strprintf("run %d pre no post no\n", every));
      const double x = seen(0) - run.waiting(0, 0), v = run.v()[0][0];
      const double energy = v * v + omega * omega * x * (x - step * v);    // x: after this v
      least = std::min(least, energy);
      most = std::max(most, energy);
      turns += v * last < 0.0;
      last = v;
    }
    EXPECT_LT(measured("spread of the energy", (most - least) / most), 1e-11) << every;
    const double theta = std::acos(1.0 - 0.5 * omega * omega * step * step);
    EXPECT_NEAR(turns, cycles * theta / M_PI, 1.0) << every;
  }
}

// Time steps change between two steps of the points: each force acts as long as its step lasts.
TEST(Seen, ImpulseIsThatOfAllSteps)
{
  const double a = -0.25;
  Scene run(free_block(5, 10.0) + "timestep 0.001\n");
  run.each_step([&](double **force) {
    for (int i = 0; i < run.n(); i++) force[i][2] = a * run.mass()[i];
  });
  run.commands("run 53\ntimestep 0.003\nrun 47\n");
  EXPECT_NEAR(run.evaluate("vcm(all,z)") / (a * run.time()), 1.0, 1.0e-12);
}

static const std::string with_grain =
    replaced(space("lj", "f f f", "-4 14 -4 14 -4 14", 2), "style mpm", "style hybrid sphere mpm") +
    "comm_modify vel yes\n";
static const std::string touch =
    "pair_style granular\npair_coeff * * hooke 60.0 2.0 tangential linear_nohistory 1.0 0.5\n"
    "neigh_modify exclude type 1 1\ntimestep 0.01\n";

// A grain that grazes a free block: friction acts on the surface of a point, and its torque belongs
// to the angular momentum. What is lost of the sum is a small part of these torques.
SERIAL_TEST(Seen, TorquesAreThoseOfAllSteps)
{
  for (const int every : {1, 3}) {
    Scene run(
        with_grain + strprintf("fix grid all mpm 1.0 every %d\n", every) +
        "region b block 2 7 2 7 2 6\ncreate_points 1 region b ppc 2 diameter 0.5\n"
        "create_atoms 2 single 3.6 4.1 7.1\nset type 2 diameter 2.0 density 2.0\n"
        "group block type 1\ngroup grain type 2\nvelocity grain set 1.0 0 -0.3\n"
        "fix m block mpm/material density 1.0 neohookean 60.0 0.3\nfix move grain nve/sphere\n" +
        touch);
    double torque = 0.0;
    run.each_step([&](double **) {
      for (int i = 0; i < run.n(); i++)
        if (run.lmp->atom->type[i] == 1) torque += 0.01 * run.lmp->atom->torque[i][1];
    });
    run.commands("run 0\n");
    const auto start = run.sums();
    run.commands("run 300\n");
    const auto end = run.sums();
    const double lost = std::abs(end.L[1] - start.L[1]);
    measured("lost", lost);
    measured("torques", torque);
    EXPECT_GT(std::abs(torque), 0.005);
    EXPECT_LT(lost, (every == 1 ? 1.0e-9 : 0.002) * std::abs(torque)) << every;
  }
}

// A torque on a point that leaves the group of the neighbor lists before it is time for the cycle,
// here one inside that counts as failed during the first step only.
SERIAL_TEST(Seen, TorqueIsNotLostWithTheGroup)
{
  const double dt = 0.01, T = 0.3;
  Scene run(
      with_grain +
      "neigh_modify every 1 delay 0 check no\nfix grid all mpm 1.0 every 3\n"
      "region b block 2 8 2 8 2 8\ncreate_points 1 region b ppc 2\ngroup block type 1\n"
      "create_atoms 2 single 5 5 10\nset type 2 diameter 1.0 density 1.0\ngroup skin type 2\n"
      "atom_modify first skin\nneigh_modify include skin\ncomm_modify group skin\n"
      "fix surf block mpm/surface group skin\n"
      "fix m block mpm/material density 1.0 eos linear 10.0 strength elastic 5.0 damage rankine "
      "100.0\n" +
      touch + "run 0\n");
  const auto *material = run.material();
  const auto inside = [&] {
    int i = 0;
    while (run.lmp->atom->tag[i] != 6 * 144 + 6 * 12 + 6) i++;
    return i;
  };
  material->history[inside()][material->damage] = 1.0;
  bool first = true, in_lists[2] = {false, true};
  run.each_step([&](double **) {
    const int i = inside();
    in_lists[!first] = i < run.lmp->atom->nfirst;
    if (first) run.lmp->atom->torque[i][1] = T;
    first = false;
    material->history[i][material->damage] = 0.0;
  });
  run.commands("run 3 post no\n");
  EXPECT_TRUE(in_lists[0]);
  EXPECT_FALSE(in_lists[1]);
  EXPECT_NEAR(run.sums().L[1], T * dt, 1.0e-14);
}

static const std::string two_fields = space("lj", "p p p", "0 8 0 8 0 8", 2) +
    fields({{"one", "block 1 3 2 5 2 5"}, {"two", "block 5 7 2 5 2 5"}}, "1.0 every 3") +
    "fix m all mpm/material density 1.0 neohookean 10.0 0.3\nvelocity all set 0.1 0 0\n"
    "timestep 0.01\n";

// a field that begins in the middle of the cycle of another one would never step together with it
TEST(Phase, IsThatOfAllFields)
{
  const std::string first = "fix F1 one mpm 1.0 every 3\n", second = "fix F2 two mpm 1.0 every 3\n";
  const std::string steps = "must be at the same step of every";
  expect_refused(two_fields,
                 {{"run 2\nunfix F1\n" + first, steps},
                  {"run 2\nunfix F2\n" + second, steps},
                  {"unfix F2\nrun 2\n" + second, steps},
                  {"run 4\nunfix F2\n" + second, steps},
                  {"unfix F2\nfix F2 two mpm 1.0 every 2\n", "must have the same every"}},
                 "run 4\n");
  for (const char *lines : {"run 3\nunfix F2\n", "run 2\nunfix F2\nunfix F1\n"}) {
    Scene run(two_fields + lines + (strstr(lines, "F1") ? first : "") + second);
    EXPECT_EQ(run.error("run 4\n"), "") << lines;
  }
}

TEST(Phase, IsThatOfTheRestartFile)
{
  const ScratchFile file("phase.bin");
  Scene run(two_fields + "run 2\nwrite_restart " + file.name + "\n");
  const std::string next = "read_restart " + file.name + "\nfix F1 one mpm 1.0 every 3\n",
                    material = "fix m all mpm/material density 1.0 neohookean 10.0 0.3\n";
  expect_error(next + "fix G2 two mpm 1.0 every 3\n" + material + "run 4\n",
               "must be at the same step of every");
  for (const char *every : {"every 2", "every 4", ""})
    expect_error(replaced(next, "every 3", every), "every 3 (now ");
}

// points go on from where an error has left them, with a step as long as any other
SERIAL_TEST(Phase, BeginsAnewAfterAnError)
{
  Scene run(replaced(two_fields, "every 3", "every 3 dtcheck no"));
  run.commands("velocity all ramp vx 5 -5 x 1 3\ntimestep 0.5\n");
  expect_error(run, "run 3\n", "determinant");
  run.commands("velocity all set 0.1 0 0\ntimestep 0.01\n");
  const auto before = run.gather();
  run.commands("run 3\n");
  const auto after = run.gather();
  ASSERT_EQ(after.size(), before.size());
  double most = 0.0;
  for (std::size_t k = 0; k < after.size(); k++)
    most = std::max(most, std::abs(after[k].x[0] - before[k].x[0]));
  EXPECT_LT(measured("way of points", most), 0.1);
}
