// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// mpi: 1 2

// Fix mpm/surface: which points carry a contact radius, and what grains feel of it.

#include "error.h"
#include "mpm_lammps.h"
#include "neigh_list.h"
#include "pair.h"

#include <regex>

using namespace LAMMPS_NS;
using namespace MPM_TEST;

static const std::string head = "units lj\nboundary p p f\natom_style hybrid sphere mpm\n"
                                "neighbor 0.3 multi\ncomm_modify vel yes mode multi\n"
                                "region box block 0 12 0 12 -1 12\ncreate_box 2 box\n";

static const std::string contact =
    "pair_style granular\n"
    "pair_coeff * * hooke 100.0 0.5 tangential linear_nohistory 0.5 0.4\n"
    "neigh_modify exclude type 1 1\n";

/** A slab of 12 layers of 24 x 24 points. */
static std::string slab(const std::string &options, const std::string &more = "",
                        const std::string &law = "neohookean 10.0 0.3")
{
  return "fix grid all mpm 1.0 " + options +
      "\nregion slab block INF INF INF INF 1 7\ncreate_points 1 region slab ppc 2\n"
      "group slab type 1\nfix m slab mpm/material density 1.0 " +
      law + "\n" + more + "\n" + contact + "timestep 0.01\n";
}
static const std::string brittle = "eos linear 10.0 strength elastic 5.0 damage rankine 100.0";

static double surface_points(Scene &run)
{
  double n = -1.0;
  run.each_step([&](double **) {
    n = run.fix("surf")->compute_scalar();
  });
  run.commands("run 0 post no\n");
  return n;
}

// A slab of 12 layers of 24 x 24 points anywhere on the lattice: the first and the last layer.
PARAMETER_TEST(Surface, IsTheOutermostLayer, const char *,
               Values("", "shape linear transfer flip 1.0 scheme musl", "shape cubic",
                      "shape cpgimp", "frame total"))
{
  for (const char *shift : {"0 0 0", "0.13 0.31 0.47", "0.5 0.25 0.7", "5.1 0 0"}) {
    Scene run(head +
              slab(GetParam(),
                   std::string("displace_atoms all move ") + shift +
                       " units box\nfix surf slab mpm/surface"));
    EXPECT_EQ(surface_points(run), 2 * 24 * 24) << shift;
  }
}

// On a fixed face of the box nothing can be between it and the body, but a gap has a surface.
TEST(Surface, IsNotOnAFixedFace)
{
  const auto box = replaced(replaced(head, "p p f", "f p f"), "-1 12", "0 12");
  struct {
    const char *options, *gap;
    int expected;
  } const cases[] = {{"", "0 0 0", 24 * 24},    // the top; 24 x 24 x 12 points
                     {"shape linear transfer flip 1.0 scheme musl", "0 0 0", 24 * 24},
                     {"shape cubic", "0 0 0", 24 * 24},
                     {"", "0 0 0.5", 2 * 24 * 24},
                     {"frame total", "0 0 0",
                      2 * 24 * 24 + (2 * 10 + 4) * 24}};    // may move away; next to the edges
  for (const auto &c : cases) {
    Scene run(box +
              replaced(slab(c.options,
                            std::string("displace_atoms all move ") + c.gap +
                                " units box\nfix surf slab mpm/surface"),
                       "1 7", "0 6"));
    EXPECT_EQ(measured("points", surface_points(run)), c.expected) << c.options << " " << c.gap;
  }

  // nor is anything next to it nearer to the surface, whichever node is the first one
  for (const char *origin : {"0 0 0", "6 6 -1"}) {
    Scene run(replaced(replaced(head, "-1 12", "0 12") +
                           slab(std::string("origin ") + origin,
                                "displace_atoms all move 6.3 6.3 0 units box\n"
                                "fix surf slab mpm/surface depth 2"),
                       "1 7", "0 6"));
    EXPECT_EQ(surface_points(run), 4 * 24 * 24) << origin;
  }
}

// Points that have failed are no longer inside of anything, and their neighbors have a surface.
TEST(Surface, OpensWherePointsHaveFailed)
{
  Scene run(head + slab("", "fix surf slab mpm/surface", brittle) + "run 0 post no\n");
  auto *material = run.material();
  ASSERT_GE(material->damage, 0);
  for (int i = 0; i < run.n(); i++)    // two layers in the middle
    if (std::abs(run.lmp->atom->x[i][2] - 4.0) < 0.5) material->history[i][material->damage] = 1.0;
  EXPECT_EQ(surface_points(run), 6 * 24 * 24);
}

TEST(Surface, FailedPointsHaveARadius)
{
  Scene run(head + slab("", "fix surf slab mpm/surface depth 0.3", brittle) + "run 0 post no\n");
  double n = -1.0;
  run.each_step([&](double **) {
    n = run.fix("surf")->compute_scalar();
  });
  run.commands("run 0 post no\n");
  const double before = n;
  auto *material = run.material();
  double deep = 0.0;
  for (int i = 0; i < run.n(); i++) {    // one point inside
    if (run.lmp->atom->tag[i] != 12 * 24 * 12 + 6 * 24 + 6) continue;
    material->history[i][material->damage] = 1.0;
    deep = std::min(7.0 - run.x()[i][2], run.x()[i][2] - 1.0);
  }
  EXPECT_GT(over_ranks(deep), 1.0);
  run.commands("run 0 post no\n");
  EXPECT_EQ(n, before + 1.0);
}

TEST(Surface, RadiusFollowsTheVolume)
{
  Scene run(head + slab("", "fix surf slab mpm/surface scale 1.1 grow 1.03") + "run 0 post no\n");
  double mine = 0.0, expected = 1.0;
  int n = 0;
  run.each_step([&](double **) {
    for (int i = 0; i < run.n(); i++) {
      const double r = run.lmp->atom->radius[i];
      if (r == 0.0) continue;
      mine = std::max(mine, std::abs(r / expected - 1.0));
      n++;
    }
  });
  for (const double J :
       {0.8, 1.05, 1.15}) {    // the last: at the most 1.03 times that without deformation
    for (int i = 0; i < run.n(); i++) {
      for (int c = 0; c < 9; c++) run.points().F[i][c] = c % 4 == 0;
      run.points().F[i][0] = J;
    }
    expected = 0.5 * 1.1 * std::min(0.5 * std::cbrt(J), 0.5 * 1.03);
    mine = n = 0;
    run.commands("run 0 post no\n");
    EXPECT_GT(n, 0);
    EXPECT_LT(over_ranks(mine, MPI_MAX), 1.0e-12) << J;
  }
}

// Grains on the surface feel the same with and without the points inside; lists are shorter.
static const std::string grains =
    "fix grid all mpm 1.0\nregion block block INF INF INF INF INF 5\n"
    "create_points 1 region block ppc 2\ngroup block type 1\n"
    "create_atoms 2 single 3.1 3.2 5.95\ncreate_atoms 2 single 8.9 3.7 6.1\n"
    "create_atoms 2 single 6.4 9.2 5.9\ngroup grains type 2\n"
    "set type 2 diameter 2.0 density 2.0\nvelocity grains set 0.3 0.2 -0.5\n";
static const std::string fixes =
    "group block type 1\ngroup grains type 2\n"
    "fix soft block mpm/material density 1.0 neohookean 50.0 0.3\n"
    "fix floor all mpm/boundary zlo stick\nfix move grains nve/sphere\n";

// They come from create_points or set, and are not those of a restart file.
TEST(Surface, WarnsOfDiametersThatItReplaces)
{
  for (const char *before : {"", "set type 1 diameter 0.7\n"})
    for (const char *options : {"", " scale 1.4"}) {
      Scene run(head + grains + fixes + before);
      const auto warnings = [&]() {
        return over_ranks(run.lmp->error->get_numwarn());
      };
      const double start = warnings();
      run.commands(std::string("fix surf block mpm/surface") + options + "\n");
      EXPECT_EQ(warnings() - start, *before && !*options) << before << options;
      run.commands(contact + "timestep 0.01\nrun 20\nfix surf block mpm/surface\n");
      EXPECT_EQ(warnings() - start, *before || *options) << before << options;
    }
}

TEST(SurfaceContact, IsThatOfAllPoints)
{
  double force[2][3] = {{0.0}}, pairs[2] = {0.0, 0.0};
  for (int all = 0; all < 2; all++) {
    Scene run(replaced(head, "neighbor 0.3", "neighbor 0.8") + grains + fixes +
              (all ? "set type 1 diameter 0.5\n" : "fix surf block mpm/surface grow 1.0\n") +
              contact + "timestep 0.01\n");
    std::vector<double> mine(4);
    bool first = true;
    run.each_step([&](double **) {    // then radii follow the volume
      auto *atom = run.lmp->atom;
      for (int i = 0; i < run.n() && first; i++)
        if (atom->type[i] == 2)
          for (int d = 0; d < 3; d++) mine[d] += std::abs(atom->f[i][d]);
      first = false;
    });
    run.commands("run 1 post no\n");
    const auto *list = run.lmp->force->pair->list;
    for (int k = 0; k < list->inum; k++) mine[3] += list->numneigh[list->ilist[k]];
    const auto sum = over_ranks(mine);
    for (int d = 0; d < 3; d++) force[all][d] = sum[d];
    pairs[all] = sum[3];
  }
  EXPECT_GT(force[0][2], 1.0);
  for (int d = 0; d < 3; d++) EXPECT_NEAR(force[0][d], force[1][d], 1.0e-12 * force[1][2]);
  EXPECT_LT(pairs[0], pairs[1]);
}

// At set-up all points have the largest radius, and then those at the surface that of their volume:
// ghosts, too. With plain bins a pair is found with the lower of the two as the owner, which is the
// grain below the slab: on a corner of the periodic box it touches ghosts.
TEST(SurfaceContact, IsTheSameAcrossPeriodicFacesFromSetUpOn)
{
  std::vector<double> force[2];
  for (const int corner : {0, 1}) {
    Scene run(replaced(replaced(head, "0.3 multi", "0.3 bin"), "mode multi", "mode single") +
              "fix grid all mpm 1.0\nregion slab block INF INF INF INF 1 7\n"
              "create_points 1 region slab ppc 2\ncreate_atoms 2 single " +
              (corner ? "0.1 0.2 0.1\n" : "6.1 6.2 0.1\n") +
              "group slab type 1\ngroup grains type 2\n"
              "set type 2 diameter 2.0 density 2.0\nfix m slab mpm/material density 1.0 "
              "neohookean 10.0 0.3\n"
              "fix move grains nve/sphere\nfix surf slab mpm/surface\n" +
              contact + "timestep 0.01\n");
    std::vector<double> mine(3);
    run.each_step([&](double **) {
      auto *atom = run.lmp->atom;
      for (int i = 0; i < run.n(); i++)
        if (atom->type[i] == 2) mine.assign(atom->f[i], atom->f[i] + 3);
    });
    run.commands("run 0 post no\n");
    force[corner] = over_ranks(mine);
  }
  EXPECT_LT(force[0][2], -1.0);
  for (int d = 0; d < 3; d++) EXPECT_NEAR(force[1][d], force[0][d], 1.0e-12 * -force[0][2]);
}

// A group of grains and surface alone can be in neighbor lists and be ghosts of other ranks.
static const char *const set_by_hand = "neighbor 0.3 multi\ncomm_modify vel yes mode multi\n";
static const std::string plain = "fix surf block mpm/surface\n";
static const std::string skin = "group skin union grains block\natom_modify first skin\n"
                                "fix surf block mpm/surface group skin\n"
                                "neigh_modify include skin\ncomm_modify group skin\n";
// the same in one keyword, without the lines of head and contact
static const std::string listed = "fix surf block mpm/surface lists grains\n";
static const std::string bare_head = replaced(head, set_by_hand, "neighbor 0.3 bin\n");
static const std::string bare_contact = replaced(contact, "neigh_modify exclude type 1 1\n", "");
static const std::string rest = contact + "fix g all gravity 1.0 vector 0 0 -1\ntimestep 0.01\n";

// with every, torques and forces of the steps between are those of several neighbor lists
static const std::string every3 = replaced(grains, "mpm 1.0\n", "mpm 1.0 every 3\n");

/** What follows after a restart file of a scene is read. */
static std::string next_of(const std::string &start, const std::string &surface,
                           const std::string &last)
{
  return set_by_hand + start.substr(0, start.find('\n') + 1) + fixes + surface + last;
}

// LAMMPS has another cutoff for each mode, and forgets it when the mode changes
SERIAL_TEST(SurfaceContact, ListsKeepTheCutoff)
{
  const auto ghosts = [](const std::string &given) {
    Scene run(bare_head + given + grains + fixes + listed + bare_contact + "run 0\n");
    return run.lmp->atom->nghost;
  };
  Scene run(bare_head + "comm_modify cutoff 4.5\n" + grains + fixes + listed);
  EXPECT_EQ(run.lmp->comm->cutghostuser, 4.5);
  EXPECT_GT(ghosts("comm_modify cutoff 4.5\n"), 1.5 * ghosts(""));
}

TEST(SurfaceContact, IsTheSameOnAnyNumberOfRanks)
{
  for (const auto &start : {grains, every3})
    for (const auto &surface : {plain, skin}) {
      OnRanks run(head + start + fixes + surface + rest, "run 150\n");
      EXPECT_LT(measured("difference", run.difference()), 1.0e-10);
    }
}

TEST(SurfaceContact, DoesNotNeedPointsInside)
{
  for (const auto &start : {grains, every3}) {
    Scene all, some;
    all.commands(head + start + fixes + plain + rest + "run 150\n");
    some.commands(head + start + fixes + skin + rest);
    int inside = 0;    // of the atoms with neighbor lists
    double torque = 0.0;
    some.each_step([&](double **) {
      inside = some.n() - some.lmp->atom->nfirst;
      for (int i = some.lmp->atom->nfirst; i < some.n(); i++)
        for (int d = 0; d < 3; d++)
          torque = std::max(torque, std::abs(some.lmp->atom->torque[i][d]));
    });
    some.commands("run 150 post no\n");
    EXPECT_LT(measured("difference", difference(all.gather(), some.gather())), 1.0e-10);
    EXPECT_GE(inside, some.n() / 2);
    EXPECT_EQ(torque, 0.0);
  }
}

// Grains that come during a run or between two are in the lists as soon as they are in their group,
// whichever of the two fixes is first. Lists are made, and radii found, in all steps.
PARAMETER_TEST(LaterGrains, AreInTheLists, std::string,
               Values("deposited before", "deposited after", "created"))
{
  const auto scene = [&](const std::string &start, const std::string &surface) {
    const std::string deposit = "region source block 2.4 2.6 7.4 7.6 5.8 5.9\n"
                                "fix more grains deposit 1 2 10 4711 region source vz -1 -1\n";
    const bool before = GetParam() == "deposited before", after = GetParam() == "deposited after";
    return start + grains + fixes + (before ? deposit : "") + surface + (after ? deposit : "") +
        "neigh_modify every 1 delay 0 check no\nfix g all gravity 1.0 vector 0 0 -1\n"
        "timestep 0.01\nrun 30\n" +
        (before || after ? "" : "create_atoms 2 single 2.5 7.5 5.3\ngroup grains type 2\n") +
        "run 70\n";
  };
  Scene all(scene(head, plain + contact)), some(scene(bare_head, listed + bare_contact));
  double v = 0.0;
  for (int i = 0; i < all.n(); i++)
    if (all.lmp->atom->tag[i] == 6916) v = all.v()[i][2];
  EXPECT_GT(measured("velocity", over_ranks(v)), -0.6);    // at least -0.7 in free fall
  EXPECT_LT(measured("difference", difference(all.gather(), some.gather())), 1.0e-10);
}

// A fix that comes after this one inserts them when their group is known already
TEST(LaterGrains, AreInTheListsOneStepLate)
{
  Scene run(bare_head + grains + fixes + listed + bare_contact +
            "region source block 2.4 2.6 7.4 7.6 9.8 9.9\n"
            "fix more grains deposit 1 2 10 4711 region source vz -1 -1\ntimestep 1e-4\n");
  double steps = 0.0, out = 0.0;    // steps with the grain, and with the grain out of the lists
  run.each_step([&](double **) {
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->tag[i] == 6916) {
        steps++;
        out += i >= run.lmp->atom->nfirst;
      }
  });
  run.commands("run 20 post no\n");
  EXPECT_GT(over_ranks(steps), 5.0);
  EXPECT_EQ(over_ranks(out), 1.0);
}

/** Largest difference of the radius of a point from this one. */
static double radius_error(Scene &run, double radius)
{
  double most = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (run.lmp->atom->type[i] == 1) grow(most, run.lmp->atom->radius[i] - radius);
  return measured("difference of radii", over_ranks(most, MPI_MAX));
}

// LAMMPS's write_data begins as a run does, and does not end so
TEST(Surface, StaysAsItIsWhenDataAreWritten)
{
  const ScratchFile file("written.data");
  for (const auto &surface : {plain, skin}) {
    const std::string start = head + grains + fixes + surface + rest, end = "run 20\n";
    Scene whole(start + end + end), written(start + end + "write_data " + file.name + "\n");
    EXPECT_LT(radius_error(written, 0.5 * 1.2 * 0.5), 1.0e-14);
    written.commands(end);
    EXPECT_LT(measured("difference", difference(whole.gather(), written.gather())), 1.0e-12);
  }
  Scene before(head + grains + fixes + plain + rest + "write_data " + file.name + "\nrun 1\n");
}

// Without the fix, points are as create_points makes them, times the scale
TEST(Surface, LeavesPlainDiameters)
{
  for (const auto &surface : {plain, skin}) {
    Scene run(head + grains + fixes + replaced(surface, "surface", "surface grow 2 scale 1.1") +
              rest + "run 5\nunfix surf\n");
    EXPECT_LT(radius_error(run, 0.5 * 1.1 * 0.5), 1.0e-14);
    if (surface == plain) run.commands("run 5\n");    // a group of lists needs the fix
  }
}

TEST(SurfaceContact, SetsListsUp)
{
  const std::string more = bare_contact + "fix g all gravity 1.0 vector 0 0 -1\ntimestep 0.01\n";
  for (const auto &start : {grains, every3}) {
    Scene by_hand(head + start + fixes + skin + rest + "run 150\n"),
        by_keyword(bare_head + start + fixes + listed + more + "run 150\n");
    EXPECT_TRUE(identical(by_hand.gather(), by_keyword.gather()));
  }
  Continued run(bare_head + grains + fixes + listed + more, 60,
                "neighbor 0.3 bin\nfix grid all mpm 1.0\n" + fixes + listed + more, 80);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

TEST(SurfaceContact, GoesOnFromARestartFile)
{
  for (const auto &start : {grains, every3})    // there, in the middle of a step of the points
    for (const auto &surface : {plain, skin}) {
      Continued run(head + start + fixes + surface + rest, start == grains ? 60 : 61,
                    next_of(start, surface, rest), 80);
      EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
    }
}

// The surface, and lists, are those of the step in which the file was written, in both runs.
// (Without damping: LAMMPS takes velocities of the middle of a step, at set-up of its end.)
TEST(SurfaceContact, GoesOnFromAFileOfTheRestartCommand)
{
  const std::string elastic = replaced(rest, "hooke 100.0 0.5 tangential linear_nohistory 0.5 0.4",
                                       "hooke 100.0 0.0 tangential linear_nohistory 0.0 0.0");
  for (const auto &start : {grains, every3})
    for (const auto &surface : {plain, skin}) {
      const ScratchFile file("later.50");
      Scene whole(head + start + fixes + surface + elastic + "restart 50 " +
                  replaced(file.name, ".50", "") + "\nrun 90\n");
      Scene again("read_restart " + file.name + "\n" + next_of(start, surface, elastic) +
                  "run 40\n");
      EXPECT_TRUE(identical(whole.gather(), again.gather()));
    }
}

// Clumps of spheres that LAMMPS moves as rigid bodies: what they lose of momentum, the block has.
// When forces are known, velocities of grains and points are those of half steps.
PARAMETER_TEST(Clump, PushesWithConstantMomentum, const char *,
               Values("fix move grains rigid single",
                      "fix body all property/atom i_body ghost yes\n"
                      "set type 2 i_body 1\nset type 1 i_body 0\n"
                      "fix move grains rigid/small custom i_body"))
{
  Scene run(replaced(head, "neighbor 0.3", "atom_modify map array\nneighbor 0.3") +
            replaced(grains,
                     "create_atoms 2 single 3.1 3.2 5.95\ncreate_atoms 2 single 8.9 "
                     "3.7 6.1\ncreate_atoms 2 single 6.4 9.2 5.9\n",
                     "create_atoms 2 single 5.0 5.5 6.2\ncreate_atoms 2 single 6.2 5.5 6.0\n"
                     "create_atoms 2 single 5.6 6.6 6.6\n") +
            replaced(replaced(fixes, "fix floor all mpm/boundary zlo stick\n", ""),
                     "fix move grains nve/sphere\n",
                     GetParam() + std::string("\nneigh_modify exclude type 2 2\n")) +
            plain + contact + "timestep 0.005\n");
  auto *atom = run.lmp->atom;
  std::vector<double> start;    // the last: of the points along z
  double pushed = 0.0, worst = 0.0;
  bool first = true;
  run.each_step([&](double **) {
    std::vector<double> mine(4);
    for (int i = 0; i < atom->nlocal; i++) {
      for (int d = 0; d < 3; d++) mine[d] += atom->rmass[i] * atom->v[i][d];
      if (atom->type[i] == 1) mine[3] += atom->rmass[i] * atom->v[i][2];
    }
    const auto now = over_ranks(mine);
    if (first) start = now;
    first = false;
    for (int d = 0; d < 3; d++) worst = std::max(worst, fabs(now[d] - start[d]));
    pushed = std::min(pushed, now[3]);
  });
  run.commands("run 400\n");
  EXPECT_LT(measured("momentum", worst / fabs(start[2])), 1.0e-12);
  EXPECT_LT(pushed, 0.5 * start[2]);    // it did hit the block
}

// LAMMPS tells of lost atoms only with thermodynamic output, and not which; on 2 ranks of either
TEST(SurfaceContact, TellsWhichGrainIsLost)
{
  const ScratchFile log("lost.log");
  const std::string fast = head +
      replaced(grains, "velocity grains set 0.3 0.2 -0.5\n",
               "velocity grains set 0 0 -0.5\ngroup one id 6913\n"
               "velocity one set 0 0 20\n") +
      fixes + plain + rest;
  for (const bool ignores : {false, true}) {
    Scene run("log " + log.name + "\n" + fast +
              (ignores ? "thermo_modify lost ignore\n" : "thermo_modify lost warn\n") +
              "run 40\nlog none\n");
    EXPECT_EQ(run.lmp->atom->natoms, 6912 + 2);
    MPI_Barrier(MPI_COMM_WORLD);    // the first rank writes the file
    const auto text = file_text(log.name);
    const std::regex message("1 atoms that are no material points have left .*atom 6913 at "
                             "3\\.[0-9]+ 3\\.[0-9]+ 12\\.[0-9]+ with velocity");
    const bool told = std::regex_search(text, message);
    EXPECT_EQ(told, !ignores) << text;
    MPI_Barrier(MPI_COMM_WORLD);
  }
}

TEST(Surface, RefusesMistakes)
{
  expect_refused(head + grains + fixes + contact,
                 {{"fix surf block mpm/surface width 3", "Unknown fix mpm/surface keyword: width"},
                  {"fix surf block mpm/surface grow 0.5", "grow must be at least 1: 0.5"},
                  {"fix surf block mpm/surface scale -1", "scale must be positive: -1"},
                  {"fix surf block mpm/surface depth", "depth"},
                  {"fix surf block mpm/surface group none", "static group"},
                  {"group g union block grains\nfix surf block mpm/surface group g\nrun 0\n"
                   "group g delete\ngroup h id 1",
                   "g, which does not exist"},
                  {"group g empty\natom_modify first g\nneigh_modify include g\n",
                   "use fix mpm/surface with keyword group g"},
                  {"fix surf block mpm/surface lists none", "group none does not exist"},
                  {"group low region block\nfix surf block mpm/surface lists grains\n"
                   "fix more low mpm/surface lists grains",
                   "fix surf has set the lists; use one fix mpm/surface"},
                  {"group few union grains\nfix surf block mpm/surface lists few\ngroup few delete",
                   "group few does not exist any more"},
                  {"set group grains type 1\nfix surf block mpm/surface lists grains",
                   "and other atoms have the type 1: give them different ones"},
                  {"fix surf block mpm/surface\nset type 1 diameter 0.1", "define the fix after"}},
                 "timestep 0.01\nrun 0\n");
  expect_error(head + grains + fixes +
                   "pair_style mpm/penalty\n"
                   "fix surf block mpm/surface lists grains\n",
               "leaves out pairs of points, which pair style mpm/penalty needs");
  expect_error(head + grains + fixes + skin +
                   "pair_style granular\n"
                   "pair_coeff * * hertz/material 50.0 0.5 0.3 tangential mindlin NULL 0.5 0.4\n"
                   "run 0\n",
               "must be defined before fix surf mpm/surface");
  expect_error("units lj\natom_style mpm\nregion box block 0 4 0 4 0 4\ncreate_box 1 box\n"
               "fix grid all mpm 1.0\nfix surf all mpm/surface\n",
               "use atom_style hybrid sphere mpm");
}

// Points of a body touch each other: a pair style of grains that acts between them, too, is told
SERIAL_TEST(Surface, WarnsOfPointsThatTouchAsGrains)
{
  const std::string
      head = "units lj\natom_style hybrid sphere mpm\nboundary f f f\nregion box block 0 8 0 8 0 "
             "8\ncreate_box 2 box\n"
             "neighbor 0.3 bin\ncomm_modify vel yes\npair_style granular\n",
      rest = "fix m all mpm/material density 1 neohookean 10 0.3\n"
             "pair_coeff * * hooke 50.0 0.5 tangential linear_nohistory 0 0\ntimestep 0.001\n",
      exclude = "neigh_modify exclude type 1 1\n", said = "touch as grains";
  const std::string block =
      "fix grid all mpm 1.0\nregion b block 3 5 3 5 3 5\nregion upper block 3 5 3 5 4 5\n"
      "create_points 1 region b ppc 2\n" +
      rest;
  const auto lines = lines_that_say(head + block + "run 1\n", said);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], testing::HasSubstr("Fix mpm grid: at least 144 pairs"));
  // the last: two bodies of a type each, which are to touch
  for (const auto &more : {exclude, std::string("set group all diameter 0.4\n"),
                           exclude + "neigh_modify exclude type 2 2\nset region upper type 2\n"})
    EXPECT_EQ(lines_that_say(head + block + more + "run 1\n", said).size(), 0u) << more;

  const ScratchFile file(
      "rope.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 3 4 4\n2 4 4 4\n3 5 4 4\n$EndNodes\n"
      "$Elements\n2\n1 1 0 1 2\n2 1 0 2 3\n$EndElements\n");
  const std::string rope = "create_points 1 mesh " + file.name + " section 1 diameter 1.1\n" +
      rest + "fix e all mpm/elements " + file.name + " section 1\nfix move all nve\n";
  const auto free = lines_that_say(head + rope + "run 1\n", said);
  ASSERT_EQ(free.size(), 1u);
  EXPECT_THAT(free[0], testing::HasSubstr("Fix mpm/elements e: at least 2 pairs"));
  EXPECT_EQ(lines_that_say(head + rope + exclude + "run 1\n", said).size(), 0u);
}
