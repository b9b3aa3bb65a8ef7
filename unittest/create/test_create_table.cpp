// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit input physics restart
// mpi: 1 4
// timeout: 240

// create_points TYPE table FILE: points with their state from text and from files of dump mpm/vtk.

#include "bad_input_testing.h"
#include "mpm_lammps.h"

#include "table/table.h"

#include "group.h"

using namespace MPM_TEST;

/** What a scene is before its points, with the step and time at which it begins. */
static std::string bodies_of(int dim, const std::string &transfer, const std::string &start)
{
  return box(dim, "si", "p f f", "0 1 0 1 -0.5 0.5", 2) +
      "fix prop all property/atom d_k i_n d2_a 2 writedata no\nfix grid all mpm 0.1 transfer " +
      transfer +
      "\nfix m all mpm/material density 1000 eos linear 1e6 strength j2 4e5 5e3 hardening linear "
      "1e4\n" +
      start + "fix step all mpm/dt 0.3\nfix low all mpm/boundary ylo slip\n";
}

const std::string two_bodies_of_table =
    "region b sphere 0.25 0.5 0.0 0.23\nregion c block 0.5 0.9 0 0.5 -0.3 0.2\n"
    "create_points 1 region b ppc 2\ncreate_points 2 region c ppc 2\n"
    "group one type 1\nvelocity one set 4 -2 NULL\n"
    "set type 1 d_k 3.5 i_n -7\nset type 2 d2_a[2] 0.125\n";

const std::string all_state =
    "velocity stress F mass volume0 eplastic image d_k i_n d2_a[*] vonmises density volume";

/** A run that is dumped at half, one that goes on from this file, and the difference at the end. */
static double difference_after_dump(const std::string &transfer, int dim,
                                    const std::string &modify = "",
                                    const std::string &name = "state.vtp",
                                    const std::string &more = "")
{
  const ScratchFile file(name);
  std::string dump = file.name;
  if (name.find("pvtp") != std::string::npos) dump = replaced(file.name, ".pvtp", ".%.vtp");
  Scene whole(bodies_of(dim, transfer, "") + two_bodies_of_table + "run 40\n");
  // the third axis has slabs: ranks and their number of points differ
  whole.commands("write_dump all mpm/vtk " + dump + " " + all_state + " modify " +
                 (modify.empty() ? "sort id" : modify) + "\n");
  const double time = whole.lmp->update->atime +
      (whole.lmp->update->ntimestep - whole.lmp->update->atimestep) * whole.lmp->update->dt;
  Scene again(bodies_of(dim, transfer, strprintf("reset_timestep 40 time %.17g\n", time)) +
              "create_points 1 table " + file.name + " " + more + "\n");
  whole.commands("run 40\n");
  again.commands("run 40\n");
  const double d = difference(whole.gather(), again.gather(), 1e3);
  if (name.find("pvtp") != std::string::npos)
    for (int p = 0; p < nranks(); p++)
      remove(replaced(file.name, ".pvtp", strprintf(".%d.vtp", p)).c_str());
  return d;
}

// the stress becomes that of Cauchy and back again: round-off
TEST(Dump, GoesOnAsIfNothingHadBeen)
{
  EXPECT_LT(measured("2d", difference_after_dump("flip 1.0", 2)), 1e-11);
  EXPECT_LT(measured("3d", difference_after_dump("flip 1.0", 3)), 1e-11);
}

TEST(Dump, CompressedAndInPieces)
{
  EXPECT_LT(difference_after_dump("flip 1.0", 2, "sort id compress yes"), 1e-11);
  EXPECT_LT(
      difference_after_dump("flip 1.0", 2, nranks() > 1 ? "nfile 2" : "sort id", "state.pvtp"),
      1e-11);
}

// points that have left the box since the last neighbor list keep their places without periods
TEST(Dump, PointsOnTheirWayThroughAPeriodicFace)
{
  const ScratchFile file("state.vtp");
  const std::string scene = plane("si", "p f", "0 1 0 1") + "neighbor 0.5 bin\n" +
      "fix grid all mpm 0.1 transfer flip 1.0\n"
      "fix m all mpm/material density 1000 neohookean 1e6 0.3\ntimestep 1e-3\n";
  Scene whole(scene +
              "region b block 0.6 0.9 0.3 0.6 -0.3 0.2\ncreate_points 1 region b ppc 2\n"
              "velocity all set 4 0 NULL\nrun 60\nwrite_dump all mpm/vtk " +
              file.name + " velocity stress F mass volume0 image\n");
  double outside = 0.0;
  for (int i = 0; i < whole.lmp->atom->nlocal; i++) outside += whole.lmp->atom->x[i][0] >= 1.0;
  EXPECT_GT(over_ranks(outside), 0.0);
  Scene again(scene + "reset_timestep 60 time 0.06\ncreate_points 1 table " + file.name + "\n");
  EXPECT_LT(difference(whole.gather(), again.gather(), 1e3), 1e-13);
  whole.commands("run 20\n");
  again.commands("run 20\n");
  EXPECT_LT(difference(whole.gather(), again.gather(), 1e3), 1e-11);
}

// in single precision the state is that of six digits
TEST(Dump, SinglePrecision)
{
  const double d = difference_after_dump("flip 1.0", 2, "sort id precision single");
  EXPECT_GT(d, 1e-9);
  EXPECT_LT(d, 1e-5);
}

TEST(Dump, OtherPropertiesAndTypes)
{
  const ScratchFile file("state.vtp");
  Scene whole(bodies_of(2, "flip 1.0", "") + two_bodies_of_table +
              "run 20\nwrite_dump all mpm/vtk " + file.name + " " + all_state + "\n");
  Scene again(bodies_of(2, "flip 1.0", "") + "create_points 1 table " + file.name +
              " part 2 group gold\ncreate_points 1 table " + file.name + " part 1\n");
  auto *atom = again.lmp->atom;
  int flag, cols;
  const double *k = atom->dvector[atom->find_custom("k", flag, cols)];
  const int *n = atom->ivector[atom->find_custom("n", flag, cols)];
  double **a = atom->darray[atom->find_custom("a", flag, cols)];
  const int gold = again.lmp->group->bitmask[again.lmp->group->find("gold")];
  double wrong = 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    const bool first = atom->type[i] == 1;
    wrong += k[i] != (first ? 3.5 : 0.0);
    wrong += n[i] != (first ? -7 : 0);
    wrong += a[i][0] != 0.0 || a[i][1] != (first ? 0.0 : 0.125);
    wrong += (bool) (atom->mask[i] & gold) == first;
  }
  EXPECT_EQ(over_ranks(wrong), 0.0);
  EXPECT_EQ(difference(whole.gather(), again.gather(), 1e3) < 1e-13, true);
}

// the matrix C of apic is in no dump, and a warning says so
TEST(Dump, WhatIsMissingIsSaid)
{
  const ScratchFile file("state.vtp");
  Scene whole(bodies_of(2, "apic", "") + two_bodies_of_table + "run 5\nwrite_dump all mpm/vtk " +
              file.name + " stress F mass volume0\n");
  const auto warnings = lines_that_say(
      bodies_of(2, "apic", "") + "create_points 1 table " + file.name + "\n", "WARNING");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], "velocity, mpm:C 4 of fix grid, .*eplastic.* of fix m"))
      << warnings[0];
}

const std::string flat = plane("si", "f f", "0 1 0 1", 3) + "fix grid all mpm 0.1\n";

struct Made {
  double tag, type, x[3], v[3], volume, mass, stress, shear;
};

static std::vector<Made> made_of(const std::string &text, const std::string &keywords,
                                 const std::string &scene = flat)
{
  const ScratchFile file("points", text);
  Scene run(scene + "create_points 2 table " + file.name + " " + keywords + "\n");
  auto *atom = run.lmp->atom;
  auto *points = LAMMPS_NS::MPMPoints::get(atom);
  std::vector<Made> mine(atom->nlocal);
  for (int i = 0; i < atom->nlocal; i++) {
    auto &p = mine[i];
    p = {(double) atom->tag[i], (double) atom->type[i], {}, {}, atom->vfrac[i], atom->rmass[i],
         points->tau[i][3],     points->F[i][1]};
    std::copy_n(atom->x[i], 3, p.x);
    std::copy_n(atom->v[i], 3, p.v);
  }
  return all_by_tag(mine, run.lmp->world);
}

// the same points in all the ways to write them
TEST(Text, ManyWays)
{
  const std::vector<std::array<std::string, 2>> ways = {
      {"x,y,vx,vy,volume0\n0.25,0.5,1,2,0.01\n0.75,0.5,3,-4e0,0.02\n", ""},
      {"# x y vx vy volume0\n 0.25 0.5  1 2 0.01\n\n0.75\t0.5 3 -4 0.02\n# end\n", ""},
      {"\"x\";\"y\";\"velocity:0\";\"velocity:1\";\"volume\"\r\n0.25;0.5;1;2;0.01\r\n0.75;0.5;3;-4;"
       "0.02",
       ""},
      {"0.25 0.5 1 2 0.01\n0.75 0.5 3 -4 0.02\n", "columns x,y,vx,vy,volume0"},
      {"X,Y,U,vy,volume0,what\n250,500,10,2,1e4,8\n750,500,30,-4,2e4,9\n",
       "data X x data Y y data U vx data what NULL factor U 0.1 scale 1e-3"},
      {"2\nProperties=species:S:1:pos:R:3:velo:R:3:volume:R:1 Time=0\n2 0.25 0.5 0 1 2 0 0.01\n2 "
       "0.75 0.5 0 3 -4 0 0.02\n",
       ""},
      {"\xef\xbb\xbf\"x\",\"y\",\"vx\",\"vy\",\"volume0\",\"a, "
       "b\"\r\n0.25,0.5,1,2,0.01,7\r\n0.75,0.5,3,-4,0.02,8\r\n",
       "data \"a, b\" NULL"},
      {"2\ncomment\n2 0.25 0.5 0 1 2 0.01\n2 0.75 0.5 0 3 -4 0.02\n",
       "columns type,x,y,z,vx,vy,volume0"},
      {"x,y,vx,vy,mass,density\n0.25,0.5,1,2,10,1000\n0.75,0.5,3,-4,20,1000\n", "data mass mass"},
  };
  for (const auto &[text, keywords] : ways) {
    const auto points = made_of(text, keywords);
    ASSERT_EQ(points.size(), 2u) << text;
    for (int k = 0; k < 2; k++) {
      const auto &p = points[k];
      EXPECT_EQ(p.tag, k + 1);
      EXPECT_EQ(p.type, 2);
      EXPECT_NEAR(p.x[0], 0.25 + 0.5 * k, 1e-15);
      EXPECT_EQ(p.v[0], 1 + 2 * k);
      EXPECT_EQ(p.v[1], 2 - 6 * k);
      EXPECT_NEAR(p.volume, 0.01 * (k + 1), 1e-16) << text;
    }
  }
}

// Cauchy stress and J: what points keep is that of Kirchhoff; the volume of a table is that of now
TEST(Text, StateOfADeformedPoint)
{
  const auto points = made_of("x,y,volume,F/xx,F/xy,F/xz,F/yx,F/yy,F/yz,F/zx,F/zy,F/zz,stress/"
                              "xx,stress/yy,stress/zz,stress/xy,stress/xz,stress/yz\n"
                              "0.5,0.5,0.03,2,0.5,0,0,1.5,0,0,0,1,1,2,3,7,0,0\n",
                              "");
  EXPECT_NEAR(points[0].volume, 0.01, 1e-17);
  EXPECT_NEAR(points[0].stress, 21.0, 1e-14);
  EXPECT_EQ(points[0].shear, 0.5);
}

TEST(Text, IdsTypesAndPeriodicPlaces)
{
  const std::string scene =
      plane("si", "p f", "0 1 0 1", 3) + "fix grid all mpm 0.1\nlabelmap atom 1 Fe 2 Al 3 Cu\n";
  const auto points =
      made_of("id,type,x,y\n30,3,1.25,0.5\n10,Fe,-0.25,0.5\n", "volume 0.01", scene);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].tag, 10);
  EXPECT_EQ(points[0].type, 1);
  EXPECT_EQ(points[0].x[0], 0.75);
  EXPECT_EQ(points[1].tag, 30);
  EXPECT_EQ(points[1].x[0], 0.25);
  const auto fresh =
      made_of("id,type,x,y\n30,3,1.25,0.5\n10,Fe,-0.25,0.5\n", "volume 0.01 ids new", scene);
  EXPECT_EQ(fresh[0].type, 3);
  EXPECT_EQ(fresh[1].tag, 2);
}

// many rows, in more than one message, on any number of ranks
TEST(Text, ManyRows)
{
  std::string text = "x,y\n";
  for (int k = 0; k < 20000; k++)
    text += strprintf("%.17g,%.17g\n", (k % 200 + 0.5) / 200, (k / 200 + 0.5) / 100);
  const auto points = made_of(text, "volume 5e-5");
  ASSERT_EQ(points.size(), 20000u);
  double wrong = 0.0;
  for (int k = 0; k < 20000; k++)
    wrong += points[k].tag != k + 1 || points[k].x[0] != (k % 200 + 0.5) / 200;
  EXPECT_EQ(wrong, 0.0);
}

// a material that is defined before: its history
TEST(Text, History)
{
  const ScratchFile file("points", "x,y,volume0,eplastic,temperature\n0.5,0.5,0.01,0.25,400\n");
  Scene run(flat +
            "fix m all mpm/material density 1000 eos linear 1e6 strength j2 4e5 5e3 thermal "
            "adiabatic 477 298\n"
            "compute p all mpm/atom eplastic temperature mass\n"
            "create_points 1 table " +
            file.name +
            "\nrun 0\ncompute s all reduce sum c_p[1] c_p[2] c_p[3]\n"
            "thermo_style custom step c_s[1] c_s[2] c_s[3]\nrun 0\n");
  EXPECT_EQ(run.evaluate("c_s[1]"), 0.25);
  EXPECT_EQ(run.evaluate("c_s[2]"), 400.0);
  EXPECT_EQ(run.evaluate("c_s[3]"), 10.0);
}

// Gas that is hotter than that of its material has the pressure and the energy of this temperature,
// and the first step knows its speed of sound
TEST(Text, HotGas)
{
  const ScratchFile file("points", "x,y,volume0,temperature\n0.5,0.5,0.01,3000\n");
  double speed[2], pressure[2];
  for (const bool by_table : {true, false}) {
    Scene run(flat + "fix m all mpm/material density 1.2 eos ideal/gas 1.4 pressure " +
              (by_table ? "1e5" : "1e6") + " thermal conducting 694.444444444444 " +
              (by_table ? "300" : "3000") + " 0.02\nfix h all mpm/heat\n" +
              "create_points 1 table " + file.name +
              "\ncompute p all mpm/atom pressure wavespeed\n"
              "compute s all reduce sum c_p[1] c_p[2]\nthermo_style custom step c_s[1] c_s[2]\n"
              "run 0\n");
    pressure[by_table] = run.evaluate("c_s[1]");
    speed[by_table] = run.evaluate("c_s[2]");
  }
  EXPECT_NEAR(pressure[1], pressure[0], 1e-9 * pressure[0]);
  EXPECT_NEAR(speed[1], speed[0], 1e-9 * speed[0]);
}

TEST(Mistakes, InText)
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const std::vector<std::array<std::string, 3>> cases = {
      {"", "", "is empty"},
      {" \n\n", "", "is empty"},
      {"# nothing\n", "", "no lines but comments"},
      {"x,y,volume\n", "", "names of columns, but no points"},
      {"0.5,0.5\n", "volume 1", "does not name its columns"},
      {"x,y\n0.5,0.5\n", "columns x,y volume 1", "names its columns itself"},
      {"x,y\n0.5\n", "volume 1", "line 2: has 1 values, but there are 2 columns"},
      {"x,y\n0.5,a\n", "volume 1", "line 2: 'a' in column y is no number"},
      {"x,y\n0.5,nan\n", "volume 1", "line 2: column y is nan"},
      {"x,y\n1e999,0.5\n", "volume 1", "line 2: column x is 1e999"},
      {"x,x\n0.5,0.5\n", "volume 1", "two columns have the name x"},
      {"x,,y\n0.5,1,0.5\n", "volume 1", "column 2 has no name"},
      {"x,velocity:0,volume0\n0.5,1,0.1\n", "", "no column y"},
      {"x,y\n0.5,0.5\n", "", "has no volumes"},
      {"x,y,volume0\n0.5,0.5,1\n", "volume 1", "volumes of its own"},
      {"x,y,volume0\n0.5,0.5,-1\n", "", "row 1 has volume0 = -1, which must be positive"},
      {"x,y,mass\n0.5,0.5,1\n", "", "has no volumes"},
      {"x,y,mass,density\n0.5,0.5,1,0\n", "", "density = 0, which must be positive"},
      {"x,y,eplastic\n0.5,0.5,1\n", "volume 1",
       "column eplastic is nothing that points have: define the fix"},
      {"x,y,vx,velocity:0\n0.5,0.5,1,1\n", "volume 1", "vx and velocity:0 are the same quantity"},
      {"x,y,z\n0.5,0.5,1\n", "volume 1", "z = 1, which must be 0 in a 2d"},
      {"x,y,F/xx\n0.5,0.5,1\n", "volume 1", "1 columns of F, which has 9"},
      {"x,y,F:0,F:1,F:2,F:3,F:4,F:5,F:6,F:7,F:8\n0.5,0.5,1,0,0.5,0,1,0,0,0,1\n", "volume 1",
       "F:2 = 0.5, which must be 0 in a 2d"},
      {"x,y,stress/xx\n0.5,0.5,1\n", "volume 1", "1 columns of stress, which has 6"},
      {"x,y,type\n0.5,0.5,4\n", "volume 1", "row 1 has type 4, but types are 1 to 3"},
      {"x,y,type\n0.5,0.5,1.5\n", "volume 1", "must be an integer|has type 1.5"},
      {"x,y,type\n0.5,0.5,Fe\n", "volume 1", "type Fe, but types are 1 to 3, or labels"},
      {"x,y,type\n0.5,0.5,-1\n", "volume 1", "column type is -1"},
      {"x,y,type\n0.5,0.5,1\n", "volume 1 part 2", "no points of type 2"},
      {"x,y\n0.5,0.5\n", "volume 1 part 2", "no column type, which keyword part"},
      {"x,y,id\n0.5,0.5,0\n", "volume 1", "must be positive and at most"},
      {"x,y,id\n0.5,0.5,7\n0.6,0.5,7\n", "volume 1", "two points have the ID 7"},
      {"x,y\n0.5,0.5\n0.5,0.5\n", "volume 1", "two points are at the same place"},
      {"x,y\n5,0.5\n0.5,0.5\n", "volume 1", "1 of 2 points are outside of the simulation box"},
      {"x,y\n0.5,0.5\n", "volume 1 data u vx",
       "no column u, which keyword data has; there are x y"},
      {"x,y\n0.5,0.5\n", "volume 1 factor u 2", "no column u, which keyword factor"},
      {"x,y\n0.5,0.5\n", "volume 0", "volume must be positive"},
      {"x,y,d_k\n0.5,0.5,1\n", "volume 1", "column d_k is nothing that points have"},
      {"3\nc\n1 0.5 0.5 0\n", "volume 1", "has 1 points of 3, it was cut"},
      {"1\nc\n1 0.5 0.5 0\n1\nc\n", "volume 1", "more than the 1 points"},
      {"1\nProperties=pos:R\n1 0.5\n", "volume 1", "not triples"},
      {"5\n", "volume 1", "ends after its first line"},
      {std::string("a\0b", 3), "volume 1", "is no text"},
      {"# vtk DataFile Version 3.0\n", "volume 1", "legacy file of VTK"},
      {"<?xml version=\"1.0\"?>\n", "volume 1", "has no <VTKFile"},
      {"<VTKFile type=\"ImageData\">\n", "volume 1", "type 'ImageData', expected points"},
  };
  for (const auto &[text, keywords, expected] : cases) {
    const ScratchFile file("points", text);
    const auto said = answer(flat + "create_points 2 table " + file.name + " " + keywords + "\n");
    EXPECT_TRUE(contains(said, expected)) << text << "\n" << keywords << "\n" << said;
  }
  EXPECT_TRUE(
      contains(answer(flat + "create_points 2 table no.such\n"), "no.such: cannot be read"));
  EXPECT_TRUE(contains(answer(flat + "create_points 2 table\n"), "missing argument"));
  const ScratchFile file("points", "id,x,y\n1,0.5,0.5\n");
  const std::string once = "create_points 2 table " + file.name + " volume 1\n";
  EXPECT_TRUE(contains(answer(flat + once + once), "1 points have IDs that atoms have already"));
  // the same point with other digits, but not a neighbor
  for (const auto &[text, n] : {std::pair{"x,y\n0.5,0.5\n0.6,0.5\n0.5,0.50000001\n", 1},
                                std::pair{"x,y\n0.5,0.5\n0.6,0.5\n0.5,0.501\n", 0}}) {
    const ScratchFile near("points", text);
    EXPECT_EQ(lines_that_say(flat + "create_points 2 table " + near.name + " volume 0.01\n",
                             "1 points are within 0.0001 edges of others")
                  .size(),
              n);
  }
}

// no cut and no changed byte of a dump does harm: the file is read, or it is said what is wrong
TEST(Mistakes, InADump)
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const ScratchFile file("state.vtp"), packed("packed.vtp");
  const std::string scene = flat +
      "region b block 0.2 0.6 0.3 0.5 INF INF\ncreate_points 1 region b ppc 1\n"
      "fix m all mpm/material density 1000 eos linear 1e6\nfix step all mpm/dt 0.3\nrun 0\n";
  Scene run(scene + "write_dump all mpm/vtk " + file.name +
            " stress F volume0\nwrite_dump all mpm/vtk " + packed.name +
            " stress F volume0 modify compress yes\n");
  for (const auto &name : {file.name, packed.name}) {
    const std::string good = file_text(name);
    ASSERT_NO_THROW(MPM_NS::read_vtk_points(good, "f"));
    const auto tail = good.rfind("</AppendedData>");
    int refused = 0, tried = 0;
    for (std::size_t cut = 0; cut < tail - 1; cut += 7, tried++) try {
        MPM_NS::read_vtk_points(good.substr(0, cut), "f");
      } catch (const std::runtime_error &) {
        refused++;
      }
    EXPECT_GT(refused, 0.75 * tried) << "vertices come last, and are not read";
    uint64_t dice = 12345;
    for (int k = 0; k < 3000; k++) {
      std::string bad = good;
      for (int j = 0; j < 3; j++) {
        dice = dice * 6364136223846793005u + 1442695040888963407u;
        bad[(dice >> 20) % bad.size()] = (char) (dice >> 50);
      }
      try {
        MPM_NS::read_vtk_points(bad, "f");
      } catch (const std::runtime_error &) {
      }
    }
  }
  // units of another simulation
  EXPECT_TRUE(contains(
      answer(replaced(flat, "units si", "units cgs") + "create_points 1 table " + file.name + "\n"),
      "has units si, but this simulation has units cgs"));
}
