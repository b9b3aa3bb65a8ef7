// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit input smoke ranks
// mpi: 1 2 4
// timeout: 900

// Atom style mpm (what LAMMPS does to atoms keeps what points carry), and create_points.

#include "mpm_lammps.h"

#include "atom_vec.h"

using namespace MPM_TEST;
using ::testing::AllOf;

// everything an atom carries, bit by bit
struct Point {
  double tag, type, mask, x[3], v[3], mass, volume0, volume, radius, F[9], stress[6];

  static constexpr int REALS = 28;
  const double *reals() const { return &tag; }
  bool operator==(const Point &other) const
  {
    return std::equal(reals(), reals() + REALS, other.reals());
  }
};
static_assert(sizeof(Point) == Point::REALS * sizeof(double), "");

/** All atoms of all ranks in order of their IDs. */
static std::vector<Point> atoms(Scene &scene)
{
  auto *atom = scene.lmp->atom;
  std::vector<Point> mine(atom->nlocal);
  for (int i = 0; i < atom->nlocal; i++) {
    Point &p = mine[i];
    p.tag = atom->tag[i];
    p.type = atom->type[i];
    p.mask = atom->mask[i];
    p.mass = atom->rmass[i];
    p.volume0 = atom->vfrac[i];
    p.volume = p.volume0 * scene.points().jacobian(i);
    p.radius = atom->radius_flag ? atom->radius[i] : 0.0;
    std::copy_n(atom->x[i], 3, p.x);
    std::copy_n(atom->v[i], 3, p.v);
    std::copy_n(scene.points().F[i], 9, p.F);
    std::copy_n(scene.points().tau[i], 6, p.stress);
  }
  return all_by_tag(mine, scene.lmp->world);
}

/** Odd values, a function of the ID, in all that atom style mpm owns. */
static void fill(Scene &scene)
{
  auto *atom = scene.lmp->atom;
  for (int i = 0; i < atom->nlocal; i++) {
    const double s = 1.0 / (3.0 + atom->tag[i]);
    atom->rmass[i] = 1.0 + s;
    atom->vfrac[i] = 2.0 + s * s;
    for (int c = 0; c < 9; c++) scene.points().F[i][c] = (c % 4 == 0) + s * (c + 1) / 7.0;
    for (int c = 0; c < 6; c++) scene.points().tau[i][c] = -1.0e9 * s * (c + 1);
  }
}

static double total_volume(const std::vector<Point> &points)
{
  double sum = 0.0;
  for (const auto &p : points) sum += p.volume0;
  return sum;
}

static void expect_undeformed(const Point &p)
{
  for (int c = 0; c < 9; c++) EXPECT_EQ(p.F[c], c % 4 == 0 ? 1.0 : 0.0);
}

static std::set<std::array<double, 3>> places(const std::vector<Point> &points)
{
  std::set<std::array<double, 3>> all;
  for (const auto &p : points) all.insert({p.x[0], p.x[1], p.x[2]});
  return all;
}

// a box and the lattice of a fix mpm; tests that run something remove this, as it needs a material
static const std::string box3d = space("si", "f f f", "0 1 0 1 0 1", 3) + "fix grid all mpm 0.1\n";

static const std::string box2d = plane("si", "f f", "0 1 0 1", 3);

TEST(CreatePoints, BlockOfCells)
{
  Scene scene(box3d + "region r block 0.2 0.8 0.2 0.5 0 0.1\ncreate_points 2 region r ppc 2");
  auto points = atoms(scene);
  ASSERT_EQ(points.size(), 12 * 6 * 2);
  EXPECT_EQ(scene.lmp->atom->natoms, 144);
  EXPECT_NEAR(total_volume(points), 0.6 * 0.3 * 0.1, 1.0e-15);
  for (std::size_t k = 0; k < points.size(); k++) {
    const auto &p = points[k];

    // IDs count along x, then y, then z
    EXPECT_EQ(p.tag, k + 1);
    EXPECT_NEAR(p.x[0], 0.225 + 0.05 * (k % 12), 1.0e-15);
    EXPECT_NEAR(p.x[1], 0.225 + 0.05 * (k / 12 % 6), 1.0e-15);
    EXPECT_NEAR(p.x[2], 0.025 + 0.05 * (k / 72), 1.0e-15);

    EXPECT_EQ(p.type, 2);
    EXPECT_EQ(p.mask, 1);
    EXPECT_DOUBLE_EQ(p.volume0, 1.25e-4);
    EXPECT_EQ(p.volume, p.volume0);
    EXPECT_EQ(p.mass, 0.0);
    expect_undeformed(p);
    for (double s : p.stress) EXPECT_EQ(s, 0.0);
    for (double v : p.v) EXPECT_EQ(v, 0.0);
  }
}

TEST(CreatePoints, PointsPerCell)
{
  Scene scene(box3d + "create_points 1 box ppc 1 2 3");
  auto points = atoms(scene);
  ASSERT_EQ(points.size(), 10 * 20 * 30);
  EXPECT_NEAR(total_volume(points), 1.0, 1.0e-12);
  EXPECT_NEAR(points[0].x[0], 0.05, 1.0e-15);
  EXPECT_NEAR(points[0].x[1], 0.025, 1.0e-15);
  EXPECT_NEAR(points[0].x[2], 0.1 / 6.0, 1.0e-15);

  Scene implied(box3d + "create_points 1 box");
  EXPECT_EQ(atoms(implied).size(), 8000u);    // 2 along each axis
}

TEST(CreatePoints, ExplicitSpacing)
{
  Scene scene(box3d +
              "unfix grid\nregion r block 0.25 0.75 0.2 0.7 0.25 0.75\n"
              "create_points 1 region r spacing 0.05 0.1 0.25");
  auto points = atoms(scene);
  ASSERT_EQ(points.size(), 10 * 5 * 2);
  for (const auto &p : points) EXPECT_DOUBLE_EQ(p.volume0, 0.05 * 0.1 * 0.25);

  // with a fix mpm, from its origin
  Scene shifted(box3d +
                "unfix grid\nfix grid all mpm 0.1 origin 0.03 0 0\n"
                "region r block 0.2 0.8 0.2 0.3 0.2 0.3\ncreate_points 1 region r spacing 0.1");
  points = atoms(shifted);
  ASSERT_EQ(points.size(), 6u);
  EXPECT_NEAR(points[0].x[0], 0.28, 1.0e-15);
}

TEST(CreatePoints, WhichLattice)
{
  Scene scene(box3d + "fix fine all mpm 0.05\nregion r block 0.2 0.3 0.2 0.3 0.2 0.3");
  expect_error(scene, "create_points 1 region r ppc 1",
               "Fixes mpm grid and fine have different lattices");
  scene.commands("create_points 1 region r ppc 1 fix fine");
  EXPECT_EQ(atoms(scene).size(), 8u);

  for (const char *origin : {"0.05 0 0", "0 0.05 0", "0 0 0.05"})
    expect_error(box3d + "fix fine all mpm 0.1 origin " + origin +
                     "\nregion r block 0.2 0.3 0.2 0.3 0.2 0.3\ncreate_points 1 region r ppc 1",
                 "Fixes mpm grid and fine have different lattices");

  Scene same(box3d +
             "fix second all mpm 0.1\nregion r block 0.2 0.3 0.2 0.3 0.2 0.3\n"
             "create_points 1 region r ppc 1");
  EXPECT_EQ(atoms(same).size(), 1u);
}

// numbers of points and error of the area from benchmark L1: +3.45 %, +0.97 %, +0.34 %
TEST(CreatePoints, Disk2d)
{
  const double h[] = {0.05, 0.025, 0.0125}, excess[] = {0.0345, 0.0097, 0.0034};
  const unsigned count[] = {208, 812, 3228};
  for (int k = 0; k < 3; k++) {
    Scene scene(box2d +
                fmt::format("fix grid all mpm {}\nregion r cylinder z 0.5 0.5 0.2 INF INF\n"
                            "create_points 1 region r ppc 2",
                            h[k]));
    auto points = atoms(scene);
    EXPECT_EQ(points.size(), count[k]);
    EXPECT_NEAR(total_volume(points) / (M_PI * 0.04) - 1.0, excess[k], 1.0e-4);
    double centroid[2] = {0.0, 0.0};
    for (const auto &p : points) {
      EXPECT_EQ(p.x[2], 0.0);
      EXPECT_DOUBLE_EQ(p.volume0, h[k] * h[k] / 4.0);    // per unit thickness
      for (int d = 0; d < 2; d++) centroid[d] += p.x[d] / points.size();
    }
    EXPECT_NEAR(centroid[0], 0.5, 1.0e-14);
    EXPECT_NEAR(centroid[1], 0.5, 1.0e-14);
  }

  Scene scene(box2d +
              "fix grid all mpm 0.1\nregion r block 0 1 0 0.5 INF INF\n"
              "create_points 1 region r ppc 3 2");
  EXPECT_EQ(atoms(scene).size(), 30 * 10);
}

// error of the volume is of first order in h or better: at most one half of a layer of points
TEST(CreatePoints, CurvedBodies)
{
  struct {
    const char *region;
    double volume, surface;
  } bodies[] = {
      {"region r sphere 0.5 0.5 0.5 0.4", 4.0 / 3.0 * M_PI * 0.064, 4.0 * M_PI * 0.16},
      {"region r cylinder x 0.51 0.48 0.31 0.1 0.9", M_PI * 0.31 * 0.31 * 0.8, 2.0 * M_PI * 0.31},
      {"region b block 0.1 0.9 0.1 0.9 0.1 0.9\nregion c cylinder z 0.9 0.9 0.5 INF INF side out\n"
       "region r intersect 2 b c",
       0.512 - M_PI * 0.25 * 0.25 * 0.8, 4.0},
  };
  for (const auto &body : bodies)
    for (double h : {0.1, 0.05, 0.025}) {
      Scene scene(box3d + "unfix grid\nfix grid all mpm " + std::to_string(h) + "\n" + body.region +
                  "\ncreate_points 1 region r ppc 2");
      double volume = 0.0;
      for (int i = 0; i < scene.n(); i++) volume += scene.lmp->atom->vfrac[i];
      EXPECT_NEAR(over_ranks(volume), body.volume, body.surface * h * h) << body.region;
    }
}

TEST(CreatePoints, ReportsWhatItMade)
{
  Scene scene(box2d + "fix grid all mpm 0.05\nregion r cylinder z 0.5 0.5 0.2 INF INF");
  const ScratchFile log("log");
  scene.commands("log " + log.name + "\ncreate_points 2 region r ppc 2\nlog none");
  if (rank() == 0) {
    const auto text = file_text(log.name);
    EXPECT_THAT(text, HasSubstr("Created 208 material points of type 2\n"));
    EXPECT_THAT(text, HasSubstr("spacing = 0.025 0.025\n"));
    EXPECT_THAT(text, HasSubstr("volume = 0.000625 per point, 0.13 in total (per unit thickness)"));
    EXPECT_THAT(text, HasSubstr("create_points CPU = "));
  }
}

// two far spheres in one bounding box of more sites than a rank looks at in one go, with jitter
static const char *const far_spheres =
    "unfix grid\nfix grid all mpm 0.02\nregion one sphere 0.13 0.13 0.13 0.1\nregion two sphere "
    "0.87 0.87 0.8 0.07\n"
    "region r union 2 one two\ncreate_points 1 region r ppc 3 jitter 0.4 98765\n";

TEST(CreatePoints, AnyNumberOfRanks)
{
  Scene serial(box3d + far_spheres, MPI_COMM_SELF);
  const auto expected = atoms(serial);
  EXPECT_NEAR(expected.size(), 4.0 / 3.0 * M_PI * (1.0e-3 + 3.43e-4) / 8.0e-6 * 27.0, 300);

  for (const char *layout :
       {"", "processors 1 1 *", "processors 1 * 1", "processors * 1 1", "comm_style tiled"}) {
    Scene parallel(layout + ("\n" + box3d) + far_spheres);
    const auto points = atoms(parallel);
    ASSERT_EQ(points.size(), expected.size()) << layout;
    EXPECT_TRUE(points == expected) << layout;

    // every rank has what is in its part of the box, bounds included once
    const auto *domain = parallel.lmp->domain;
    for (int i = 0; i < parallel.lmp->atom->nlocal; i++)
      for (int d = 0; d < 3; d++) {
        EXPECT_GE(parallel.lmp->atom->x[i][d], domain->sublo[d]);
        EXPECT_LT(parallel.lmp->atom->x[i][d], domain->subhi[d]);
      }
  }
}

// a box cut in unequal parts by balancing what is there already
TEST(CreatePoints, BalancedBox)
{
  auto build = [](Scene &scene, const std::string &balance) {
    scene.commands((balance.find("rcb") != std::string::npos ? "comm_style tiled\n" : "") + box3d +
                   "region c block 0 0.3 0 0.2 0 0.1\ncreate_points 1 region c ppc 2\n"
                   "region r block 0.1 1 0.2 1 0 1\nunfix grid\n" +
                   balance + "\nfix grid all mpm 0.1\ncreate_points 2 region r ppc 2");
    return atoms(scene);
  };
  Scene serial(MPI_COMM_SELF), rcb, shift;
  const auto expected = build(serial, "");
  ASSERT_EQ(expected.size(), 48u + 18 * 16 * 20);
  EXPECT_EQ(expected.back().tag, 48 + 18 * 16 * 20);
  EXPECT_TRUE(build(rcb, "balance 1.0 rcb") == expected);
  EXPECT_TRUE(build(shift, "balance 1.0 shift xyz 20 1.01") == expected);
}

// sites on the faces between ranks and on the faces of the box
TEST(CreatePoints, SitesOnFaces)
{
  for (const char *boundary : {"f f f", "p p p"}) {
    Scene scene(space("si", boundary, "0 1 0 1 0 1") +
                "fix grid all mpm 0.125 origin 0.0625 -0.0625 0.0625\n"
                "create_points 1 box ppc 1\nunfix grid");
    auto points = atoms(scene);
    ASSERT_EQ(points.size(), 512u) << boundary;
    EXPECT_EQ(total_volume(points), 1.0);
    EXPECT_EQ(places(points).size(), 512u);
    for (const auto &p : points)
      for (double x : p.x) EXPECT_EQ(8.0 * x, std::floor(8.0 * x));

    // nothing is lost when LAMMPS sends atoms to their ranks
    scene.commands("set type 1 mass 1.0\nfix n all nve\nrun 2");
    EXPECT_EQ(atoms(scene).size(), 512u);
  }

  // the upper faces of a fixed box are outside
  expect_error(box3d +
                   "unfix grid\nfix grid all mpm 0.125 origin 0.0625 0.0625 0.0625\n"
                   "region r block 0 1 0 1 0 1\ncreate_points 1 region r ppc 1",
               std::to_string(9 * 9 * 9 - 512) + " points would be outside");
}

// origins that put sites on a periodic face up to rounding: one of the two images, always
TEST(CreatePoints, PeriodicFaceRounding)
{
  for (double origin : {-0.05, 0.05, 0.15, 0.35, 1.0 / 3.0, 0.45 + 1.0e-17, -7.65}) {
    const auto fill_box = fmt::format("region box block 0 1.3 0 0.7 0 0.1\ncreate_box 1 box\n"
                                      "fix grid all mpm 0.1 origin {0:.17g} {0:.17g} {0:.17g}\n"
                                      "create_points 1 box ppc 1",
                                      origin);
    Scene scene("units si\natom_style mpm\n" + fill_box);
    auto points = atoms(scene);
    EXPECT_EQ(points.size(), 13u * 7u) << origin;
    for (std::size_t i = 0; i < points.size(); i++) {
      for (int d = 0; d < 3; d++) {
        EXPECT_GE(points[i].x[d], 0.0);
        EXPECT_LT(points[i].x[d], scene.lmp->domain->boxhi[d]);
      }
      for (std::size_t j = 0; j < i; j++) {
        double r2 = 0.0;
        for (int d = 0; d < 3; d++) {
          const double length = scene.lmp->domain->prd[d];
          const double dx = points[i].x[d] - points[j].x[d];
          r2 += std::pow(dx - length * std::round(dx / length), 2);
        }
        EXPECT_GT(r2, 0.0099);
      }
    }

    // in a fixed box a site is in or out, and all that are in are made
    Scene fixed("units si\nboundary f f f\natom_style mpm\n" + fill_box);
    points = atoms(fixed);
    std::size_t expected = 1;
    for (int d = 0; d < 3; d++) {
      const double length = fixed.lmp->domain->boxhi[d];
      std::size_t n = 0;
      for (int s = -100; s < 200; s++) {
        const double x = origin + (s + 0.5) * 0.1;
        n += x >= 0.0 && x < length;
      }
      expected *= n;
      for (const auto &p : points) EXPECT_TRUE(p.x[d] >= 0.0 && p.x[d] < length) << p.x[d];
    }
    EXPECT_EQ(points.size(), expected) << origin;
  }

  // a spacing that divides the box up to 5e-7
  Scene scene("units si\natom_style mpm\nregion box block 0 1.0000005 0 1.0000005 0 1.0000005\n"
              "create_box 1 box\nfix grid all mpm 0.10000005 origin 0.05 0.05 0.05\n"
              "create_points 1 box spacing 0.1");
  EXPECT_EQ(atoms(scene).size(), 1000u);
}

static std::vector<Point> jittered(const std::string &options, MPI_Comm comm = MPI_COMM_WORLD)
{
  Scene scene(box3d + "create_points 1 box ppc 2 " + options, comm);
  return atoms(scene);
}

TEST(CreatePoints, Jitter)
{
  const auto regular = jittered("");
  for (double fraction : {0.1, 0.5}) {
    const auto option = fmt::format("jitter {} ", fraction);
    const auto points = jittered(option + "4711");
    ASSERT_EQ(points.size(), regular.size());
    EXPECT_TRUE(points == jittered(option + "4711"));
    EXPECT_TRUE(points == jittered(option + "4711", MPI_COMM_SELF));
    EXPECT_FALSE(points == jittered(option + "4712"));

    double mean[3] = {0, 0, 0}, square[3] = {0, 0, 0}, mixed = 0.0;
    const double reach = fraction * 0.05;
    for (std::size_t k = 0; k < points.size(); k++) {
      double u[3];
      EXPECT_EQ(points[k].volume0, regular[k].volume0);
      for (int d = 0; d < 3; d++) {
        u[d] = (points[k].x[d] - regular[k].x[d]) / reach;
        ASSERT_LE(fabs(u[d]), 1.0 + 1.0e-12);
        ASSERT_GE(points[k].x[d], 0.0);
        ASSERT_LT(points[k].x[d], 1.0);
        mean[d] += u[d] / points.size();
        square[d] += u[d] * u[d] / points.size();
      }
      mixed += u[0] * u[1] / points.size();
    }

    // uniform in [-1,1]: mean 0, variance 1/3, axes independent (5 sigma of 8000 points)
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR(mean[d], 0.0, 5.0 * std::sqrt(1.0 / 3.0 / 8000));
      EXPECT_NEAR(square[d], 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / 8000));
    }
    EXPECT_NEAR(mixed, 0.0, 5.0 / 3.0 / std::sqrt(8000.0));
  }
  EXPECT_TRUE(jittered("jitter 0 1") == regular);
}

// sites near the faces of a fixed box whose cells stick out of it
TEST(CreatePoints, JitterStaysInBox)
{
  Scene scene(box3d +
              "unfix grid\nfix grid all mpm 0.1 origin 0.045 0.05 -0.03\n"
              "create_points 1 box ppc 1 jitter 0.5 3");
  auto points = atoms(scene);
  EXPECT_EQ(points.size(), 1000u);
  for (const auto &p : points)
    for (double x : p.x) EXPECT_TRUE(x >= 0.0 && x < 1.0) << x;
}

TEST(CreatePoints, AbuttingRegions)
{
  Scene scene(box3d +
              "region a block 0.1 0.5 0.1 0.6 0.1 0.4\nregion b block 0.5 0.9 0.1 0.6 0.1 0.4\n"
              "create_points 1 region a jitter 0.5 1\ncreate_points 2 region b jitter 0.5 1");
  auto two = atoms(scene);
  EXPECT_EQ(two.size(), 16u * 10 * 6);

  // the same points as of one body
  Scene whole(box3d +
              "region ab block 0.1 0.9 0.1 0.6 0.1 0.4\n"
              "create_points 1 region ab jitter 0.5 1");
  EXPECT_TRUE(places(two) == places(atoms(whole)));
}

TEST(CreatePoints, Overlap)
{
  Scene scene(box3d +
              "region a block 0 0.5 0 0.1 0 0.1\nregion b block 0.3 0.8 0 0.1 0 0.1\n"
              "create_points 1 region a ppc 2");
  EXPECT_THAT(scene.error("create_points 2 region b ppc 2"),
              AllOf(HasSubstr("16 existing material points are (the first has ID 7)"),
                    HasSubstr("overlap yes")));
  EXPECT_EQ(atoms(scene).size(), 40u);

  // sites on a face that the regions share stay with the body that was there
  Scene touching(box3d +
                 "region a block 0 0.5 0 0.1 0 0.1\nregion c block 0.475 0.6 0 0.1 0 0.1\n"
                 "create_points 1 region a ppc 2\ncreate_points 2 region c ppc 2");
  EXPECT_EQ(atoms(touching).size(), 48u);

  // at another spacing, finer and coarser
  expect_error(scene, "create_points 2 region b ppc 3", "existing");
  expect_error(scene, "create_points 2 region b ppc 1", "16 existing");

  scene.commands("create_points 2 region b ppc 2 overlap yes");
  EXPECT_EQ(atoms(scene).size(), 80u);
}

TEST(CreatePoints, OverlapAcrossPeriodicFaceAndRanks)
{
  // sites on the faces of the box, and sites whose cells are cut by them
  for (double origin : {0.0625, -0.08, 0.08}) {
    Scene scene("units si\natom_style mpm\nregion box block 0 1 0 1 0 1\ncreate_box 2 box\n" +
                fmt::format("fix grid all mpm 0.125 origin {0} {0} {0}\n"
                            "create_points 1 box ppc 1\ndisplace_atoms all move -0.06 0.06 0.06",
                            origin));
    EXPECT_THAT(scene.error("create_points 2 box ppc 1"), HasSubstr("512 existing")) << origin;
  }

  // atoms that are no material points are not in the way
  Scene mixed(box3d + "create_atoms 1 single 0.525 0.525 0.525 units box\ncreate_points 2 box");
  EXPECT_EQ(atoms(mixed).size(), 8001u);
  EXPECT_EQ(atoms(mixed)[0].volume0, 0.0);
}

// a group that is there, and one that is not; fixes and points that follow know it
TEST(CreatePoints, Group)
{
  Scene run(space("lj", "p p p", "0 8 0 8 0 8") +
            "group one empty\nfix a one mpm 1.0\nfix b all property/atom d_mark\n"
            "region one block 0 4 0 8 0 8\nregion two block 4 8 0 8 0 8\n"
            "create_points 1 region one ppc 2 group one\n"
            "create_points 1 region two ppc 1 fix a group two\n"
            "variable one equal count(one)\nvariable two equal count(two)\n"
            "variable all equal count(all)\n");
  EXPECT_EQ(run.evaluate("v_one"), 2048.0);
  EXPECT_EQ(run.evaluate("v_two"), 256.0);
  EXPECT_EQ(run.evaluate("v_all"), 2304.0);
  run.commands(
      "group now region one\ngroup rest subtract now one\nvariable rest equal count(rest)\n");
  EXPECT_EQ(run.evaluate("v_rest"), 0.0);
  expect_error(space("lj", "p p p", "0 8 0 8 0 8") +
                   "group d dynamic all every 5\ncreate_points 1 box spacing 1 group d\n",
               "Create_points group d is dynamic");
}

TEST(CreatePoints, OutsideTheBox)
{
  Scene scene(box3d +
              "region r block 0.5 1.25 -0.1 0.1 0 0.1\nregion in block INF INF 0.5 0.6 0.5 0.6\n"
              "region far sphere 5 5 5 1\nregion huge block 0 1e9 0 1e9 0 1e9\n"
              "region near block 0 1.01 0.2 0.3 0.2 0.3");
  EXPECT_THAT(scene.error("create_points 1 region r ppc 2"),
              AllOf(HasSubstr("region r reaches beyond the simulation box"),
                    HasSubstr("80 points would be outside"), HasSubstr("outside ignore")));
  expect_error(scene, "create_points 1 region far ppc 1", "would be outside");
  expect_error(scene, "create_points 1 region huge ppc 1",
               "an unknown number of points would be outside");
  EXPECT_EQ(atoms(scene).size(), 0u);

  scene.commands("create_points 1 region r ppc 2 outside ignore");
  EXPECT_EQ(atoms(scene).size(), 40u);
  expect_error(scene, "create_points 1 region far ppc 1 outside ignore", "made no points");

  // INF is no mistake, nor is a region that is too large by less than half a spacing
  scene.commands("create_points 1 region in ppc 1");
  EXPECT_EQ(atoms(scene).size(), 50u);
  scene.commands("create_points 1 region near ppc 1");
  EXPECT_EQ(atoms(scene).size(), 60u);
}

TEST(CreatePoints, BadInput)
{
  struct {
    const char *line, *message;
  } inputs[] = {
      {"create_points", "create_points"},
      {"create_points 1", "create_points"},
      {"create_points 0 box", "Invalid atom type 0"},
      {"create_points 4 box", "Invalid atom type 4"},
      {"create_points one box", "one"},
      {"create_points 1 sphere", "Unknown create_points option sphere"},
      {"create_points 1 region", "create_points region"},
      {"create_points 1 region nowhere", "region nowhere does not exist"},
      {"create_points 1 region r ppc", "create_points ppc"},
      {"create_points 1 region r ppc x", "expects 1 or 3 numbers"},
      {"create_points 1 region r ppc 2 2", "expects 1 or 3 numbers in a 3d simulation, not 2"},
      {"create_points 1 region r ppc 2 2 2 2", "expects 1 or 3 numbers in a 3d simulation, not 4"},
      {"create_points 1 region r ppc 0", "ppc must be within 1 and 1000: 0"},
      {"create_points 1 region r ppc 2 -2 2", "ppc must be within 1 and 1000: -2"},
      {"create_points 1 region r ppc 2.5", "2.5"},
      {"create_points 1 region r ppc 1001", "ppc must be within 1 and 1000: 1001"},
      {"create_points 1 region r spacing", "create_points spacing"},
      {"create_points 1 region r spacing 0", "spacing must be positive: 0"},
      {"create_points 1 region r spacing 0.1 0.1 -0.1", "spacing must be positive: -0.1"},
      {"create_points 1 region r spacing 1e-17", "spacing 1e-17 is too fine"},
      {"create_points 1 region r spacing 1e-200", "Create_points spacing"},
      {"create_points 1 box spacing 1e-10", "would have to look at 1e+30 sites"},
      {"create_points 1 box spacing 1e-4", "would have to look at 1e+12 sites"},
      {"create_points 1 region r spacing 0.1 ppc 2", "spacing and ppc cannot be given together"},
      {"create_points 1 region r fix", "create_points fix"},
      {"create_points 1 region r fix nofix", "fix nofix does not exist"},
      {"create_points 1 region r fix n", "fix n is a fix nve, not a fix mpm"},
      {"create_points 1 region r jitter 0.1", "create_points jitter"},
      {"create_points 1 region r jitter 0.6 1", "jitter fraction must be within 0 and 0.5: 0.6"},
      {"create_points 1 region r jitter -0.1 1", "jitter fraction must be"},
      {"create_points 1 region r jitter 0.1 0", "jitter seed must be positive: 0"},
      {"create_points 1 region r overlap", "create_points overlap"},
      {"create_points 1 region r overlap maybe", "maybe"},
      {"create_points 1 region r outside", "create_points outside"},
      {"create_points 1 region r outside in", "Unknown create_points outside in"},
      {"create_points 1 region r diameter 0.1", "diameter needs atom_style hybrid sphere mpm"},
      {"create_points 1 region r pcc 2", "Unknown create_points keyword: pcc"},
      {"create_points 1 region slit ppc 1", "made no points"},
  };
  Scene scene(box3d +
              "fix n all nve\nregion r block 0.2 0.3 0.2 0.3 0.2 0.3\n"
              "region slit block 0.41 0.42 0 1 0 1");
  for (const auto &input : inputs) {
    const auto message = scene.error(input.line);
    EXPECT_THAT(message, AllOf(HasSubstr("ERROR"), HasSubstr(input.message))) << input.line;
    EXPECT_EQ(scene.lmp->atom->natoms, 0) << input.line;
  }

  // and the instance is still usable
  scene.commands("create_points 1 region r");
  EXPECT_EQ(atoms(scene).size(), 8u);
}

TEST(CreatePoints, BadSetting)
{
  const std::string unit = "region box block 0 1 0 1 0 1\ncreate_box 1 box\ncreate_points 1 box";
  expect_error("atom_style mpm\ncreate_points 1 box", "before the simulation box is defined");
  EXPECT_THAT(error_of("atom_style mpm\natom_style atomic\n" + unit),
              AllOf(HasSubstr("needs atom_style mpm"), HasSubstr("atom style is atomic")));
  expect_error("atom_style mpm\nregion box prism 0 1 0 1 0 1 0.1 0 0\n"
               "create_box 1 box\ncreate_points 1 box spacing 0.1",
               "orthogonal");
  EXPECT_THAT(error_of("atom_style mpm\n" + unit + " ppc 2"),
              AllOf(HasSubstr("define fix mpm first"), HasSubstr("create_points spacing")));
  expect_error(box2d + "fix grid all mpm 0.1\ncreate_points 1 box ppc 2 2 2",
               "expects 1 or 2 numbers in a 2d simulation, not 3");
}

TEST(AtomStyle, BadInput)
{
  Scene scene;
  expect_error(scene, "atom_style mpm 3", "Atom style mpm takes no arguments");
  expect_error(scene, "atom_style hybrid mpm sphere", "Atom style mpm must come after sphere");
  expect_error(scene, "atom_style hybrid ellipsoid mpm",
               "cannot be combined with atom style ellipsoid");
  expect_error(scene, "atom_style hybrid mpm line", "cannot be combined with atom style line");
  expect_error(scene, "atom_style hybrid mpm unknown", "unknown");
  scene.commands("atom_style mpm\natom_style hybrid sphere mpm\natom_style mpm");
}

static std::string moving_points(const std::string &style)
{
  return "units lj\natom_style " + style + R"(
atom_modify map array sort 3 1.0
region box block 0 4 0 4 0 4
create_box 2 box
region r block 0 4 0 2 0 2.5
create_points 1 region r spacing 0.5
set type 1 mass 1.0
)";
}
static const std::string moving = moving_points("mpm");
static const char *const styles[] = {"mpm", "hybrid sphere mpm", "hybrid atomic mpm"};

/** With an atom, and with velocities. */
static void with_an_atom(Scene &scene, const std::string &style)
{
  scene.commands("lattice none 1.0\n" + moving_points(style));
  if (scene.lmp->atom->mass) scene.commands("mass * 1.0");
  scene.commands("create_atoms 2 single 3.3 3.3 3.3 units box\n"
                 "velocity all create 20.0 4711 loop all");
}

TEST(AtomStyle, NewAtoms)
{
  Scene scene("units lj\natom_style mpm\nlattice sc 1.0\nregion box block 0 3 0 3 0 3\n"
              "create_box 2 box\ncreate_atoms 1 box\nvelocity all create 1.0 87287 loop geom");
  auto made = atoms(scene);
  ASSERT_EQ(made.size(), 27u);
  for (const auto &p : made) {
    EXPECT_EQ(p.mass, 1.0);
    EXPECT_EQ(p.volume0, 0.0);
    EXPECT_EQ(p.volume, 0.0);
    EXPECT_TRUE(std::isfinite(p.v[0]));
    expect_undeformed(p);
  }

  // atoms become material points when they are given a volume
  scene.commands("region left block 0 1.5 0 3 0 3 units box\ngroup left region left\n"
                 "set group left type 2\nset type 2 volume 0.25\nset type 2 mass 3.0");
  for (const auto &p : atoms(scene)) {
    EXPECT_EQ(p.volume0, p.x[0] < 1.5 ? 0.25 : 0.0);
    EXPECT_EQ(p.mass, p.x[0] < 1.5 ? 3.0 : 1.0);
  }
  expect_error(scene, "set type 1 volume -1", "volume");
}

TEST(AtomStyle, MemoryPerPoint)
{
  Scene scene(moving, MPI_COMM_SELF);

  // LAMMPS: 8 + ID + image flags + 3*24; ours: 2*8 + 72 + 48; a pointer for each row of x, v, f
  EXPECT_LE(scene.lmp->atom->avec->memory_usage() / scene.lmp->atom->nmax,
            216.0 + sizeof(tagint) + sizeof(imageint) + 24.0);
  EXPECT_EQ(scene.lmp->atom->avec->comm_x_only, 1);
  EXPECT_EQ(scene.lmp->atom->avec->comm_f_only, 1);
}

// points fly through all ranks and are sorted again and again
TEST(AtomStyle, MigrationAndSorting)
{
  for (const char *style : {"mpm", "hybrid sphere mpm"}) {
    Scene scene(moving_points(style) +
                "velocity all create 20.0 4711 loop all\nset type 1 image 0 0 0");
    fill(scene);
    const auto before = atoms(scene);
    ASSERT_EQ(before.size(), 8u * 4 * 5);

    scene.commands("fix n all nve\ntimestep 0.01\nneighbor 0.2 bin\ncomm_modify cutoff 0.5\n"
                   "thermo 100\nrun 300");
    const auto after = atoms(scene);
    ASSERT_EQ(after.size(), before.size());
    int travelled = 0;
    for (std::size_t k = 0; k < after.size(); k++) {
      Point p = after[k];
      for (int d = 0; d < 3; d++) {
        const double x = before[k].x[d] + 3.0 * before[k].v[d];
        EXPECT_NEAR(std::remainder(p.x[d] - x, 4.0), 0.0, 1.0e-10);
        travelled += fabs(x - before[k].x[d]) > 4.0;
        p.x[d] = before[k].x[d];
      }
      ASSERT_TRUE(p == before[k]) << k;
    }
    EXPECT_GT(travelled, 300);    // otherwise this does not test much
  }
}

TEST(AtomStyle, Restart)
{
  for (const char *style : styles) {
    Scene scene;
    with_an_atom(scene, style);
    fill(scene);
    const auto before = atoms(scene);
    const ScratchFile file("restart");
    scene.commands("write_restart " + file.name + " noinit\nclear");

    Scene again("read_restart " + file.name);
    EXPECT_TRUE(atoms(again) == before) << style;

    // a serial run reads it as well
    Scene serial("read_restart " + file.name, MPI_COMM_SELF);
    EXPECT_TRUE(atoms(serial) == before) << style;

    // more points can be made
    again.commands("region s block 0 4 2 4 0 1\ncreate_points 1 region s spacing 0.5");
    EXPECT_EQ(atoms(again).size(), before.size() + 8 * 4 * 2);
    EXPECT_TRUE(atoms(again)[0] == before[0]);
  }
}

TEST(AtomStyle, Replicate)
{
  Scene scene(moving);
  fill(scene);
  const auto before = atoms(scene);
  scene.commands("replicate 2 1 3");
  const auto after = atoms(scene);
  ASSERT_EQ(after.size(), 6 * before.size());
  for (const auto &p : after) {
    const auto &q = before[((int) p.tag - 1) % before.size()];
    EXPECT_EQ(p.mass, q.mass);
    EXPECT_EQ(p.volume0, q.volume0);
    EXPECT_EQ(p.volume, q.volume);
    for (int c = 0; c < 9; c++) EXPECT_EQ(p.F[c], q.F[c]);
    for (int c = 0; c < 6; c++) EXPECT_EQ(p.stress[c], q.stress[c]);
    for (int d = 0; d < 3; d++) EXPECT_NEAR(std::remainder(p.x[d] - q.x[d], 4.0), 0.0, 1.0e-12);
  }

  // the new instance of Atom takes more points
  scene.commands("region s block 0 8 2 4 0 1\ncreate_points 2 region s spacing 0.5");
  EXPECT_EQ(atoms(scene).size(), after.size() + 16 * 4 * 2);
}

// The command makes another Atom object, and fix mpm goes on with the points of that one. Periodic
// copies move as the original does. (pic, no history: LAMMPS refuses arrays of a fix.)
TEST(AtomStyle, ReplicateBetweenRuns)
{
  const std::string scene = space("lj", "p p p", "0 8 0 6 0 5") +
      "fix grid all mpm 1.0 transfer pic\nregion body block 1 4 1 4 1 3\ncreate_points 1 region "
      "body ppc 2\n"
      "fix rubber all mpm/material density 1.0 neohookean 20.0 0.3\n"
      "velocity all ramp vx 0.1 0.5 y 1 4 units box\nvelocity all set NULL 0.1 0.3\ntimestep "
      "0.02\nrun 20\n";
  Scene once(scene + "run 20\n"), copies(scene + "replicate 2 1 2\nrun 20\n");
  const auto one = once.gather(), many = copies.gather();
  ASSERT_EQ(many.size(), 4 * one.size());
  for (const auto &p : many) {
    const auto &q = one[((int) p.tag - 1) % one.size()];
    for (int d = 0; d < 3; d++) EXPECT_NEAR(p.v[d], q.v[d], 1e-13);
    for (int c = 0; c < 9; c++) EXPECT_NEAR(p.F[c], q.F[c], 1e-13);
    for (int c = 0; c < 6; c++) EXPECT_NEAR(p.stress[c], q.stress[c], 1e-12);
  }
  EXPECT_GT(std::fabs(one[0].stress[0]), 1e-6);
}

TEST(AtomStyle, DeleteAtoms)
{
  Scene scene(moving);
  fill(scene);
  const auto before = atoms(scene);
  scene.commands("region cut sphere 2 1 1 0.9\ngroup cut region cut\n"
                 "delete_atoms group cut compress no");
  const auto after = atoms(scene);
  std::vector<Point> expected;
  for (const auto &p : before)
    if (std::hypot(p.x[0] - 2, std::hypot(p.x[1] - 1, p.x[2] - 1)) > 0.9) expected.push_back(p);
  EXPECT_LT(after.size(), before.size());
  EXPECT_TRUE(after == expected);

  // new IDs follow the largest one
  scene.commands("create_points 2 region cut spacing 0.5");
  EXPECT_EQ(atoms(scene).size(), before.size());
  EXPECT_EQ(atoms(scene).back().tag, before.size() + before.size() - after.size());
}

TEST(AtomStyle, Clear)
{
  Scene scene(moving);
  fill(scene);
  scene.commands("clear");
  scene.commands(moving);
  const auto points = atoms(scene);
  EXPECT_EQ(points.size(), 160u);
  for (const auto &p : points) {
    EXPECT_EQ(p.volume, 0.125);
    EXPECT_EQ(p.F[1], 0.0);
    EXPECT_EQ(p.F[8], 1.0);
  }
}

// fixes and computes are told about new points
TEST(AtomStyle, NewPointsInComputes)
{
  Scene scene(moving +
              "compute moved all displace/atom\ncompute far all reduce max c_moved[4]\n"
              "region s block 0 4 2 4 0 1\ncreate_points 2 region s spacing 0.5\n"
              "set type 2 mass 1.0\nfix n all nve\nthermo_style custom step c_far\nrun 0");
  EXPECT_EQ(scene.evaluate("c_far"), 0.0);
}

TEST(AtomStyle, PropertyAtom)
{
  Scene scene("lattice none 1.0\n" + moving);
  fill(scene);
  scene.commands("create_atoms 2 single 3.3 3.3 3.3 units box\n"
                 "compute p all property/atom mpm_volume0 mpm_volume mpm_J mpm_density mpm_F12 "
                 "mpm_F31 mpm_F33 mpm_stress11 mpm_stress22 mpm_stress33 mpm_stress12 "
                 "mpm_stress13 mpm_stress23 mpm_stress32\nfix n all nve\nrun 0");
  auto *compute = scene.lmp->modify->get_compute_by_id("p");
  compute->compute_peratom();
  for (int i = 0; i < scene.lmp->atom->nlocal; i++) {
    const double *a = compute->array_atom[i];
    if (scene.lmp->atom->type[i] == 2) {
      for (int c = 0; c < 14; c++) EXPECT_EQ(a[c], 0.0);
      continue;
    }
    const double *F = scene.points().F[i], *tau = scene.points().tau[i];
    EXPECT_EQ(a[0], scene.lmp->atom->vfrac[i]);
    const double J = F[0] * F[4] * F[8] + F[1] * F[5] * F[6] + F[2] * F[3] * F[7] -
        F[2] * F[4] * F[6] - F[1] * F[3] * F[8] - F[0] * F[5] * F[7];
    EXPECT_NEAR(a[2], J, 1.0e-14);
    EXPECT_DOUBLE_EQ(a[1], scene.lmp->atom->vfrac[i] * a[2]);
    EXPECT_DOUBLE_EQ(a[3], scene.lmp->atom->rmass[i] / a[1]);
    EXPECT_EQ(a[4], F[1]);
    EXPECT_EQ(a[5], F[6]);
    EXPECT_EQ(a[6], F[8]);
    for (int c = 0; c < 6; c++) EXPECT_NEAR(a[7 + c], tau[c] / J, 1.0e-14 * fabs(a[7 + c]));
    EXPECT_EQ(a[13], a[12]);
  }
  expect_error(scene, "compute q all property/atom mpm_F14", "mpm_F14");
}

static const char *const header = R"(LAMMPS data file

4 atoms
2 atom types

0 1 xlo xhi
0 1 ylo yhi
0 1 zlo zhi

)";

static void expect_close(double value, double expected)
{
  EXPECT_NEAR(value, expected, 4.0e-15 * fabs(expected));
}

static void round_trip(Scene &scene)
{
  const auto before = atoms(scene);
  const ScratchFile file("data");
  scene.commands("write_data " + file.name + " noinit\n");
  const char *style = styles[scene.lmp->atom->radius_flag ? 1 : scene.lmp->atom->mass ? 2 : 0];
  Scene again(std::string("units si\natom_style ") + style + "\nread_data " + file.name);
  const auto after = atoms(again);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t k = 0; k < after.size(); k++) {
    EXPECT_EQ(after[k].tag, before[k].tag);
    EXPECT_EQ(after[k].type, before[k].type);
    EXPECT_EQ(after[k].volume, after[k].volume0);
    expect_close(after[k].mass, before[k].mass);
    expect_close(after[k].volume0, before[k].volume0);
    expect_close(after[k].radius, before[k].radius);
    for (int d = 0; d < 3; d++) EXPECT_EQ(after[k].x[d], before[k].x[d]);
    for (int d = 0; d < 3; d++) EXPECT_EQ(after[k].v[d], before[k].v[d]);
    expect_undeformed(after[k]);
    for (double s : after[k].stress) EXPECT_EQ(s, 0.0);
  }

  // writing has not changed anything
  EXPECT_TRUE(atoms(scene) == before);
}

// FNV-1a hashes of 64 bits that its authors publish, with the lowest 11 of the bits folded into the
// others, as a real has 53 of them
TEST(Checksum, IsThatOfItsAuthors)
{
  const std::pair<std::string, uint64_t> known[] = {
      {"", 0xcbf29ce484222325}, {"a", 0xaf63dc4c8601ec8c}, {"foobar", 0x85944171f73967e8}};
  for (const auto &[text, hash] : known)
    EXPECT_EQ(checksum(text.data(), text.size()), (double) (hash >> 11 ^ (hash & 0x7ff))) << text;
}

// id type density volume x y z; without volume: mass in place of density
TEST(DataFile, Columns)
{
  const auto atoms_section = std::string(header) +
      "Atoms # mpm\n\n1 1 8960 1e-6 .1 .1 .1\n"
      "2 1 0 1e-6 .2 .1 .1\n3 2 0.5 0 .9 .9 .9\n4 2 2 3 .5 .9 .4";
  const ScratchFile bad("bad", atoms_section + " 0 1 0\n"), in("good", atoms_section + "\n");
  Scene scene("units si\natom_style mpm");
  expect_error(scene, "read_data " + bad.name, "Incorrect format");
  Scene good("units si\natom_style mpm\nread_data " + in.name);
  auto p = atoms(good);
  ASSERT_EQ(p.size(), 4u);
  EXPECT_DOUBLE_EQ(p[0].mass, 8.96e-3);
  EXPECT_EQ(p[0].volume0, 1.0e-6);
  EXPECT_EQ(p[0].volume, 1.0e-6);
  EXPECT_EQ(p[1].mass, 0.0);
  EXPECT_EQ(p[2].mass, 0.5);
  EXPECT_EQ(p[2].volume, 0.0);
  EXPECT_EQ(p[3].mass, 6.0);
  for (const auto &point : p) expect_undeformed(point);
  round_trip(good);
}

// id type x y z diameter density volume
TEST(DataFile, ColumnsWithSpheres)
{
  const ScratchFile in(
      "in",
      std::string(header) +
          "Atoms # hybrid\n\n1 1 .1 .1 .1 0.02 8960 1e-6\n"
          "2 1 .2 .1 .1 0 100 1e-6\n3 2 .9 .9 .9 0.2 2500 0\n4 2 .5 .9 .4 0 2 0\n");
  Scene scene("units si\natom_style hybrid sphere mpm\nread_data " + in.name);
  auto p = atoms(scene);
  ASSERT_EQ(p.size(), 4u);
  EXPECT_DOUBLE_EQ(p[0].mass, 8.96e-3);
  EXPECT_EQ(p[0].radius, 0.01);
  EXPECT_DOUBLE_EQ(p[1].mass, 1.0e-4);
  EXPECT_DOUBLE_EQ(p[2].mass, 2500 * 4.0 / 3.0 * M_PI * 1.0e-3);
  EXPECT_EQ(p[2].volume0, 0.0);
  EXPECT_EQ(p[3].mass, 2.0);
  round_trip(scene);
}

TEST(DataFile, RoundTrip)
{
  for (const char *style : styles) {
    Scene scene;
    with_an_atom(scene, style);
    if (scene.lmp->atom->radius_flag) scene.commands("set type 2 diameter 0.3");
    fill(scene);
    for (int i = 0; i < scene.lmp->atom->nlocal; i++)
      if (scene.lmp->atom->type[i] == 2) scene.lmp->atom->vfrac[i] = 0.0;
    round_trip(scene);
  }
}

// points without mass yet: can be stored by atom style mpm alone
TEST(DataFile, PointsWithoutMass)
{
  Scene scene(box3d +
              "region r block 0.2 0.8 0.2 0.8 0.2 0.8\ncreate_points 2 region r jitter 0.3 5");
  round_trip(scene);
}

// errors on the rank that owns the atom: in serial
TEST(DataFile, BadInput)
{
  struct {
    const char *style, *atom, *message;
  } inputs[] = {
      {"mpm", "1 1 1000 -1e-6 .1 .1 .1", "Invalid volume -1e-06 of atom 1"},
      {"mpm", "1 1 -1000 1e-6 .1 .1 .1", "Invalid density -1000 of atom 1"},
      {"mpm", "1 1 0 0 .1 .1 .1", "Invalid mass 0 of atom 1"},
      {"mpm", "1 1 -2 0 .1 .1 .1", "Invalid mass -2 of atom 1"},
      {"mpm", "1 1 1000 nan .1 .1 .1", "nan"},
      {"mpm", "1 1 1000 .1 .1 .1", "Incorrect format"},
      {"hybrid sphere mpm", "1 1 .1 .1 .1 0.1 1000 -1", "Invalid volume -1 of atom 1"},
      {"hybrid sphere mpm", "1 1 .1 .1 .1 0.1 -1000 1", "Invalid density"},
      {"hybrid sphere mpm", "1 1 .1 .1 .1 0.1 0 1", "Invalid density"},
  };
  const auto name = "bad" + std::to_string(rank());
  for (const auto &input : inputs) {
    const ScratchFile file(name,
                           replaced(header, "4 atoms", "1 atoms") + "Atoms\n\n" + input.atom + "\n",
                           MPI_COMM_SELF);
    Scene scene(MPI_COMM_SELF);
    EXPECT_THAT(scene.error(std::string("units si\natom_style ") + input.style + "\nread_data " +
                            file.name),
                HasSubstr(input.message))
        << input.atom;
  }

  // atom style sphere would refuse to read this file
  Scene scene(MPI_COMM_SELF);
  scene.commands(replaced(box3d, "atom_style mpm", "atom_style hybrid sphere mpm") +
                 "region r block 0.2 0.8 0.2 0.8 0.2 0.8\ncreate_points 2 region r diameter 0.02");
  for (const auto &p : atoms(scene)) EXPECT_EQ(p.radius, 0.01);
  const ScratchFile file(name, MPI_COMM_SELF);
  expect_error(scene, "write_data " + file.name + " noinit", "has no mass yet");
}

TEST(AtomStyle, GrainsNextToPoints)
{
  Scene scene("lattice none 1.0\n" + moving_points("hybrid sphere mpm") +
              "create_atoms 2 single 3.3 3.3 3.3 units box");
  for (const auto &p : atoms(scene))
    if (p.type == 2) EXPECT_DOUBLE_EQ(p.mass, M_PI / 6.0);    // of atom style sphere
  scene.commands("set type 2 diameter 0.4\nset type 2 density 2.0");
  for (const auto &p : atoms(scene)) {
    if (p.type == 2) {
      EXPECT_EQ(p.volume0, 0.0);
      EXPECT_EQ(p.radius, 0.2);
      EXPECT_DOUBLE_EQ(p.mass, 2.0 * 4.0 / 3.0 * M_PI * 0.008);
    } else {
      EXPECT_EQ(p.volume0, 0.125);
      EXPECT_DOUBLE_EQ(p.radius, 0.25);    // of a sphere as wide as the point
    }
  }
}
