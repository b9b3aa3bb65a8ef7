// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 3
// timeout: 300

// compute mpm/fragment

#include "mpm_lammps.h"

using namespace MPM_TEST;

static const std::string BRITTLE = "density 1 eos linear 8 strength elastic 4 damage rankine 1000";

/** A number from 0 to 1 for each tag and purpose. */
static double noise(tagint tag, int purpose)
{
  uint64_t k =
      (uint64_t) tag * UINT64_C(0x9E3779B97F4A7C15) + purpose * UINT64_C(0xD1B54A32D192ED03);
  k = (k ^ (k >> 29)) * UINT64_C(0xBF58476D1CE4E5B9);
  return (double) ((k ^ (k >> 32)) >> 11) / (double) (UINT64_C(1) << 53);
}

static void set_damage(Scene &run, const std::function<double(int)> &of_point)
{
  auto *m = run.material();
  for (int i = 0; i < run.n(); i++) m->history[i][m->damage] = of_point(i);
}

struct Labelled {
  double tag, piece;
};
/** Of all ranks, by tag. */
static std::vector<Labelled> labels(Scene &run)
{
  const double *const piece = run.per_atom("f")->vector_atom;
  std::vector<Labelled> mine;
  for (int i = 0; i < run.n(); i++) mine.push_back({(double) run.lmp->atom->tag[i], piece[i]});
  return all_by_tag(mine, run.lmp->world);
}
static int count(Scene &run)
{
  run.per_atom("f");    // points may have changed since the last call
  return (int) run.compute_scalar("f");
}

// ---------------------------------------------------------------------- resolution

/** Two blocks next to each other, of which the second one is then moved away by gap; all turned. */
static std::string two_blocks(double gap, double angle, const std::string &more = "",
                              const std::string &lattice = "1.0")
{
  return plane("lj", "f f", "-40 40 -40 40", 2) + "fix grid all mpm " + lattice + R"(
region a block -5 0 -2 2 INF INF
region b block 0 5 -2 2 INF INF
create_points 1 region a ppc 2
create_points 2 region b ppc 2
group a type 1
group b type 2
)" +
      strprintf("displace_atoms b move %g 0 0\ndisplace_atoms all move 0.3 0.2 0\n"
                "displace_atoms all rotate 0 0 0 0 0 1 %g\n",
                gap, angle) +
      "fix m all mpm/material " + BRITTLE + "\n" + more +
      "compute f all mpm/fragment\ntimestep 0.001\nrun 0\n";
}

// Points of a size of half a cell reach .9 cells: gaps of more than .4 cells are seen at any angle
TEST(Gaps, AreSeen)
{
  for (const double angle : {0.0, 22.5, 45.0})
    for (const double gap : {0.0, 0.3, 0.5, 1.0, 2.0}) {
      Scene run(two_blocks(gap, angle));
      EXPECT_EQ(count(run), gap > 0.4 ? 2 : 1) << gap << " " << angle;
    }
}

// A band of damaged points, at any angle to the lattice and to the rows of points, is dust, and
// what is on both sides of it are pieces. The ID of a piece is the smallest in it
TEST(Bands, SeparatePieces)
{
  for (const double turn : {0.0, 30.0})
    for (const double angle : {0.0, 11.25, 22.5, 45.0})
      for (const double width : {1.0, 2.0}) {
        Scene run(two_blocks(0.0, turn));
        const double c = std::cos((angle + turn) * PI / 180),
                     s = std::sin((angle + turn) * PI / 180);
        std::map<int, double> least;
        const auto side = [&](const double *x) {
          const double at = c * x[0] + s * x[1] - (angle == 0.0 ? 0.55 : 0.51);
          return std::fabs(at) < 0.25 * width ? 0 : (at > 0.0 ? 1 : -1);
        };
        set_damage(run, [&](int i) {
          return side(run.x()[i]) == 0 ? 0.99 : 0.98;
        });
        EXPECT_EQ(count(run), 2) << turn << " " << angle << " " << width;
        const auto found = labels(run);
        const auto states = run.gather();
        for (std::size_t k = 0; k < found.size(); k++) {
          const int where = side(states[k].x);
          if (where != 0 && !least.count(where)) least[where] = found[k].tag;
          EXPECT_EQ(found[k].piece, where == 0 ? 0.0 : least[where]);
        }
        run.commands("uncompute f\ncompute f all mpm/fragment separable 0.995\n");
        EXPECT_EQ(count(run), 1);
      }
}

// A body that is stretched, compressed, sheared by much, or turned is one piece. A gap that is
// stretched with it is not seen better or worse
TEST(Deformed, StaysWhole)
{
  struct Deformation {
    double F[4];
    bool shows_gap;
  };
  for (const auto &[F, shows_gap] : {Deformation{{2, 0, 0, 1}, true},
                                     {{2, 0, 0, 0.5}, true},
                                     {{0.5, 0, 0, 1}, false},
                                     {{1, 3, 0, 1}, false},
                                     {{1.4, 1.4, -0.7, 0.7}, true}})
    for (const double gap : {0.0, 0.5}) {
      Scene run(two_blocks(gap, 0.0));
      for (int i = 0; i < run.n(); i++) {
        double *const x = run.x()[i], *const row = run.points().F[i], was[2] = {x[0], x[1]};
        for (int d = 0; d < 2; d++) {
          x[d] = F[2 * d] * was[0] + F[2 * d + 1] * was[1];
          std::copy_n(F + 2 * d, 2, row + 3 * d);
        }
      }
      if (gap == 0.0 || shows_gap) {
        EXPECT_EQ(count(run), gap > 0.0 ? 2 : 1) << F[0] << " " << F[1];
      }
    }
}

// A point that is stretched reaches one that is not two cells away, on either side of it
TEST(Deformed, ReachesBothWays)
{
  for (const int side : {0, 1, 2}) {
    Scene run(replaced(two_blocks(1.2, 0.0), "all move 0.3", "all move 1.2"));
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->type[i] == side) run.points().F[i][0] = 2.0;
    EXPECT_EQ(count(run), side == 0 ? 2 : 1) << side;
  }
}

// In the total frame, what is next to a point at the start is so for ever, also after an update of
// the reference, and what is not never
TEST(TotalFrame, KnowsTheStart)
{
  for (const std::string reference : {"", " reference update 1.5"})
    for (const double gap : {0.0, 0.5}) {
      Scene run(two_blocks(gap, 0.0, "", "1.0 frame total" + reference));
      for (int i = 0; i < run.n(); i++) {
        run.x()[i][0] *= 3.0;
        run.points().F[i][0] = 3.0;
      }
      const int pieces = gap > 0.0 ? 2 : 1;
      EXPECT_EQ(count(run), pieces);
      run.commands("run 10\n");
      EXPECT_EQ(count(run), pieces) << reference;
      if (gap > 0.0) continue;
      set_damage(run, [&](int i) {
        return std::fabs(run.x()[i][0] / 3.0 - 0.55) < 0.25;
      });
      EXPECT_EQ(count(run), 2);
    }
}

// ---------------------------------------------------------------------- by the definition

struct Known {
  double tag, x[3], F[9], size, damage, counts;
};

/** Pieces as the page defines them, over all pairs. */
static std::vector<double> by_definition(const std::vector<Known> &p, int dim, const double *period)
{
  const double reach = 1.8, most = 2.0;
  const auto way = [&](const Known &a, const Known &b, double *d) {
    double r2 = 0.0;
    for (int k = 0; k < 3; k++) {
      d[k] = b.x[k] - a.x[k];
      if (period[k] > 0.0) d[k] -= period[k] * std::round(d[k] / period[k]);
      r2 += d[k] * d[k];
    }
    return std::sqrt(r2);
  };
  const auto reaches = [&](const Known &a, const double *d, double r) {
    double F[3][3], inverse[3][3], J = 1.0, back = 0.0;
    for (int k = 0; k < 9; k++) F[k / 3][k % 3] = a.F[k];
    J = F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) -
        F[0][1] * (F[1][0] * F[2][2] - F[1][2] * F[2][0]) +
        F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        const int a1 = (j + 1) % 3, a2 = (j + 2) % 3, b1 = (i + 1) % 3, b2 = (i + 2) % 3;
        inverse[i][j] = (F[a1][b1] * F[a2][b2] - F[a1][b2] * F[a2][b1]) / J;
      }
    for (int i = 0; i < 3; i++) {
      const double u = inverse[i][0] * d[0] + inverse[i][1] * d[1] + inverse[i][2] * d[2];
      back += u * u;
    }
    return r < most &&
        (std::sqrt(back) < reach * a.size || r < reach * a.size * std::pow(J, 1.0 / dim));
  };
  std::vector<int> parent(p.size());
  for (std::size_t k = 0; k < p.size(); k++) parent[k] = (int) k;
  const std::function<int(int)> root = [&](int k) {
    return parent[k] == k ? k : parent[k] = root(parent[k]);
  };
  const auto is_in = [&](const Known &a) {
    return a.counts > 0.0 && a.damage < 0.99;
  };
  for (std::size_t i = 0; i < p.size(); i++)
    for (std::size_t j = 0; j < i; j++) {
      double d[3], back[3], unused[3];
      if (!is_in(p[i]) || !is_in(p[j])) continue;
      const double r = way(p[i], p[j], d);
      for (int k = 0; k < 3; k++) back[k] = -d[k];
      if (!reaches(p[i], d, r) && !reaches(p[j], back, r)) continue;
      const bool apart = std::any_of(p.begin(), p.end(), [&](const Known &k) {
        return k.counts > 0.0 && k.damage >= 0.99 && way(p[i], k, unused) < r &&
            way(p[j], k, unused) < r;
      });
      if (!apart) parent[std::max(root(i), root(j))] = std::min(root(i), root(j));
    }
  std::vector<double> piece;
  for (std::size_t k = 0; k < p.size(); k++) piece.push_back(is_in(p[k]) ? p[root(k)].tag : 0.0);
  return piece;
}

// Random places, deformations, and damage, also across periodic faces, in a box of few cells, with
// points that are out of the box, and with any number of ranks
TEST(Random, AreThoseOfTheDefinition)
{
  for (const int dim : {2, 3})
    for (const std::string &faces : {"f f f", "p p p", "p f f"})
      for (const double change : {0.1, 1.0}) {
        const bool flat = dim == 2;
        const double length = flat ? 15.0 : 5.0, width = flat ? 9.0 : 3.0;
        Scene run(replaced(box(dim, "lj", faces, strprintf("0 %g 0 %g 0 4", length, width)),
                           "atom_style", "atom_modify map array\natom_style") +
                  body("box", BRITTLE) +
                  "group some id <> 20 100000\ncompute f some mpm/fragment\nrun 0\n");
        auto *atom = run.lmp->atom;
        for (int i = 0; i < run.n(); i++) {
          const tagint tag = atom->tag[i];
          for (int d = 0; d < dim; d++) {
            run.x()[i][d] += 0.6 * (noise(tag, d) - 0.5);
            for (int e = 0; e < dim && noise(tag, 40) < 0.3; e++)
              run.points().F[i][3 * d + e] += change * (noise(tag, 10 + 3 * d + e) - 0.5);
          }
        }
        set_damage(run, [&](int i) {
          const tagint tag = atom->tag[i];
          return noise(tag, 30) < (flat ? 0.45 : 0.7) ? 0.99 + 0.01 * noise(tag, 31) : 0.98;
        });
        std::vector<Known> mine;
        for (int i = 0; i < run.n(); i++) {
          Known k = {};
          k.tag = atom->tag[i];
          std::copy_n(run.x()[i], 3, k.x);
          std::copy_n(run.points().F[i], 9, k.F);
          k.size = std::pow(atom->vfrac[i], 1.0 / dim);
          k.damage = run.material()->history[i][run.material()->damage];
          k.counts = k.tag >= 20;
          mine.push_back(k);
        }
        const double period[3] = {faces[0] == 'p' ? length : 0.0, faces[2] == 'p' ? width : 0.0,
                                  faces[4] == 'p' && !flat ? 4.0 : 0.0};
        const auto wanted = by_definition(all_by_tag(mine, run.lmp->world), dim, period);
        const auto found = labels(run);
        ASSERT_EQ(found.size(), wanted.size());
        int different = 0;
        for (std::size_t k = 0; k < found.size(); k++) different += found[k].piece != wanted[k];
        EXPECT_EQ(different, 0) << dim << "d " << faces << " " << change;
        std::set<double> pieces(wanted.begin(), wanted.end());
        EXPECT_EQ(count(run), (int) pieces.size() - 1);
        EXPECT_GT(measured("pieces", (double) pieces.size() - 1), 3);
      }
}

// ---------------------------------------------------------------------- bodies

TEST(Bodies, OfOtherFixesAreOthers)
{
  const std::vector<Body> two = {{"a", "block 1 5 1 4 INF INF"}, {"b", "block 5 9 1 4 INF INF"}};
  const std::string end = "fix m all mpm/material " + BRITTLE +
      "\ncompute f all mpm/fragment\ncompute b b mpm/fragment\ntimestep 0.001\n";
  Scene apart(plane("lj", "f f", "0 10 0 5", 2) + fields(two) + end + "run 0\n");
  EXPECT_EQ(count(apart), 2);
  apart.per_atom("b");
  EXPECT_EQ((int) apart.compute_scalar("b"), 1);

  // one body on two lattices
  const std::vector<Body> parts = {{"a", two[0].region, "1.0"},
                                   {"b", two[1].region, "0.5 origin 0.25 0.25"}};
  Scene refined(plane("lj", "f f", "0 10 0 5", 2) + fields(parts) + end +
                "fix both all mpm/refine F1 F2\nrun 0\n");
  EXPECT_EQ(count(refined), 1);
}

// Surfaces that bodies have at the start are surfaces when these meet, and where they touch from
// the start on; those of one body are not
TEST(Surfaces, OfBodiesThatTouch)
{
  const std::string yes = "fix cracks all mpm/fracture surface yes\n",
                    group = "fix cracks all mpm/fracture surface group a\n";
  for (const double angle : {0.0, 30.0}) {
    Scene touch(two_blocks(0.0, angle, group)), whole(two_blocks(0.0, angle, yes));
    EXPECT_EQ(count(touch), 2);
    EXPECT_EQ(count(whole), 1);
    // they are half a cell apart at the start, and then not
    Scene meet(two_blocks(0.5, angle, yes));
    const double c = std::cos(angle * PI / 180), s = std::sin(angle * PI / 180);
    for (int i = 0; i < meet.n(); i++)
      if (meet.lmp->atom->type[i] == 2) {
        meet.x()[i][0] -= 0.52 * c - 0.2 * s;
        meet.x()[i][1] -= 0.52 * s + 0.2 * c;
      }
    EXPECT_EQ(count(meet), 2);
    meet.commands("unfix cracks\n");
    EXPECT_EQ(count(meet), 1);
  }
  // a plate of two rows, and a corner that goes into the body
  for (const char *shape : {"region body block 0 8 0 1 INF INF",
                            "region i block 0 6 0 2 INF INF\nregion j block 0 2 0 6 INF "
                            "INF\nregion body union 2 i j"}) {
    Scene one(plane("lj", "f f", "-4 10 -4 10") + "fix grid all mpm 1.0\n" + shape +
              "\ncreate_points 1 region body ppc 2\nfix m all mpm/material " + BRITTLE + "\n" +
              yes + "compute f all mpm/fragment\ntimestep 0.001\nrun 0\n");
    EXPECT_EQ(count(one), 1) << shape;
  }
}

// ---------------------------------------------------------------------- in a run

/** A ring that expands and breaks: in 12 pieces from the time 2 on. */
static const std::string RING = plane("lj", "f f", "-12 12 -12 12", 1, 0.5) + R"(
region out cylinder z 0 0 6 INF INF
region in cylinder z 0 0 4 INF INF side out
region ring intersect 2 out in
fix grid all mpm 0.5 apart ignore
create_points 1 region ring ppc 2
fix m all mpm/material density 1 eos linear 80 strength elastic 40 )" +
    R"(damage rankine 4 soften energy 0.3 weibull 20 0.25 77
variable vx atom 1.5*x/6
variable vy atom 1.5*y/6
velocity all set v_vx v_vy 0
timestep 0.018
)";
/** Sums over pieces. What is of none is a chunk with the ID 0. */
static const std::string PIECES = R"(
compute f all mpm/fragment
compute c all chunk/atom c_f nchunk every ids every compress yes
compute n all property/chunk c count id
variable m atom mass
compute mass all reduce/chunk c sum v_m
compute v all vcm/chunk c
compute x all com/chunk c
variable out vector (c_x[1]*c_v[1]+c_x[2]*c_v[2])/sqrt(c_x[1]^2+c_x[2]^2)
variable px vector c_mass*c_v[1]
variable py vector c_mass*c_v[2]
variable count vector c_n[1]
variable ids vector c_n[2]
variable dust atom c_f==0
compute dust all reduce sum v_dust
thermo_style custom step c_f c_dust
)";

// What chunks of pieces give adds up; pieces fly away from the center; and the ring is whole before
// it breaks
TEST(Ring, BreaksIntoPieces)
{
  Scene run(RING + PIECES + "run 0\n");
  const double n = run.evaluate("count(all)"), p = run.evaluate("1.5/6*mass(all)*xcm(all,x)");
  EXPECT_EQ(run.evaluate("c_f"), 1.0);
  EXPECT_EQ(run.evaluate("max(v_count)"), n);
  EXPECT_EQ(run.evaluate("min(v_ids)"), 1.0);
  run.commands("run 110\n");
  const double pieces = measured("pieces", run.evaluate("c_f"));
  EXPECT_GT(pieces, 8.0);
  EXPECT_LT(pieces, 20.0);
  EXPECT_EQ(run.evaluate("min(v_ids)"), 0.0);
  EXPECT_EQ(run.evaluate("v_count[1]"), measured("dust", run.evaluate("c_dust")));
  EXPECT_EQ(run.evaluate("sum(v_count)"), n);
  EXPECT_NEAR(run.evaluate("sum(c_mass)"), run.evaluate("mass(all)"), 1e-12 * n);
  EXPECT_NEAR(run.evaluate("sum(v_px)"), p, 1e-11);
  EXPECT_NEAR(run.evaluate("sum(v_py)"), 0.0, 1e-11);
  for (int k = 2; k <= (int) pieces + 1; k++)
    EXPECT_GT(run.evaluate(strprintf("v_out[%d]", k)), 0.5) << k;
}

// The pieces are functions of the state: a restart file has all that they need
TEST(Ring, GoesOnAfterARestart)
{
  const ScratchFile file("restart");
  const std::string pieces = "compute f all mpm/fragment\n";
  Scene run(RING + pieces + "run 60\nwrite_restart " + file.name + "\n");
  Scene again("read_restart " + file.name + "\n" + lines_again(RING + pieces) + "run 0\n");
  const auto before = labels(run), after = labels(again);
  ASSERT_EQ(before.size(), after.size());
  EXPECT_GT(count(run), 1);
  for (std::size_t k = 0; k < before.size(); k++) EXPECT_EQ(before[k].piece, after[k].piece);
}

/** State after a run, of this rank; more: commands between the start and the run. */
static std::vector<double> state_after(const std::string &more)
{
  Scene run(RING + "fix even all balance 20 1.0 shift x 10 1.0\n" + more + "run 60\n");
  std::vector<double> all;
  for (int i = 0; i < run.n(); i++) {
    all.push_back((double) run.lmp->atom->tag[i]);
    all.insert(all.end(), run.x()[i], run.x()[i] + 3);
    all.insert(all.end(), run.v()[i], run.v()[i] + 3);
    all.insert(all.end(), run.points().F[i], run.points().F[i] + 9);
  }
  return all;
}

// No bit of a run depends on whether pieces are looked for
TEST(Ring, IsTheSameWithoutTheCompute)
{
  EXPECT_EQ(state_after("thermo 1\n"),
            state_after("thermo 1\ncompute f all mpm/fragment\nthermo_style custom step c_f\n"));
}

TEST(BadInput, IsRefused)
{
  const std::string scene = plane("lj", "f f", "0 8 0 8") + body("block 1 3 1 3 INF INF", BRITTLE);
  expect_refused(
      scene,
      {
          {"compute f all mpm/fragment 0.9", "Unknown compute mpm/fragment keyword"},
          {"compute f all mpm/fragment damage 0.9", "Unknown compute mpm/fragment keyword"},
          {"compute f all mpm/fragment separable", "separable"},
          {"compute f all mpm/fragment separable 0", "separable"},
          {"compute f all mpm/fragment separable -0.5", "separable"},
          {"compute f all mpm/fragment separable 1.01", "separable"},
          {"compute f all mpm/fragment separable nan", "separable"},
          {"compute f all mpm/fragment separable most", "separable"},
          {"compute f all mpm/fragment separable 0.9 separable", "separable"},
          {"compute f nobody mpm/fragment", "does not exist"},
          {"compute f all mpm/fragment\nunfix m\nunfix grid\nrun 0", "looks at points of fix mpm"},
      });
  expect_error("atom_style atomic\nregion box block 0 1 0 1 0 1\ncreate_box 1 box\n"
               "compute f all mpm/fragment\n",
               "use atom_style mpm");
}
