// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: input

// What an input may say, but hardly means: one warning in any number of runs, and none in a scene
// where the same numbers are right, and none with other units of the same scene.

#include "mesh/stl_testing.h"
#include "mpm_lammps.h"

using namespace MPM_TEST;

const std::string START = plane("si", "f f", "0 1 0 1", 2, 0.01) +
    "region b block 0.2 0.8 0 0.4 INF INF\n",
                  GRID = "fix grid all mpm 0.05\ncreate_points 1 region b ppc 2\n",
                  CONDUCTS = "fix m all mpm/material density 1000 neohookean 1e6 0.3 thermal "
                             "conducting 500 293 50\n",
                  STEP = "fix dt all mpm/dt 0.5\n", RUNS = "run 2\nrun 2\n";

static int told(const std::string &scene, const std::string &words)
{
  return times_said(scene + RUNS, words);
}

SERIAL_TEST(Doubts, HeatWhereNothingIs)
{
  const auto scene = START + GRID + CONDUCTS + STEP;
  const std::string alone = "has a condition, and the nearest material";
  EXPECT_EQ(told(scene + "fix heat all mpm/heat xlo temperature 400\n", alone), 1);
  EXPECT_EQ(told(scene + "fix heat all mpm/heat xhi flux 10\n", alone), 1);
  EXPECT_EQ(told(scene + "fix heat all mpm/heat ylo temperature 400\n", alone), 0);
  EXPECT_EQ(told(scene + "fix heat all mpm/heat xlo insulated\n", alone), 0);
  const std::string inside = "the inside of a region is a wall for heat",
                    hot = "fix heat all mpm/heat region hot temperature 400\n";
  EXPECT_EQ(told(scene + "region hot block 0 0.5 0.2 1 INF INF\n" + hot, inside), 1);
  EXPECT_EQ(told(scene + "region hot block 0 1 0.4 1 INF INF\n" + hot, inside), 0);
  EXPECT_EQ(told(scene + "region hot block 0.2 0.8 0 0.4 INF INF side out\n" + hot, inside), 0);
  const std::string far = "no material that conducts is within 1.5 node spacings";
  EXPECT_EQ(told(scene + "region hot block 0.9 1 0.1 0.3 INF INF\n" + hot, far), 1);
  EXPECT_EQ(told(scene + "region hot block 0.8 1 0.1 0.3 INF INF\n" + hot, far), 0);
  EXPECT_EQ(told(scene + "region hot block 0.2 0.8 0 0.4 INF INF side out\n" + hot, far), 0);
  EXPECT_EQ(told(scene +
                     "variable x equal -time\nregion hot block 0.9 1 0.1 0.3 INF INF move v_x "
                     "NULL NULL\n" +
                     hot,
                 far),
            0);
}

SERIAL_TEST(Doubts, WaterAndSoil)
{
  const auto scene = [](double scale, double density, double bulk, double permeability,
                        const std::string &more = "") {
    return START + GRID +
        strprintf("fix soil all mpm/material density %g linear %g 0.3\n", density, 1e7 * scale) +
        strprintf("fix w all mpm/pore %g 1000 %g soil soil 0.4 constant %g\n", bulk * scale,
                  9810 * scale, permeability) +
        more + STEP;
  };
  const std::string soft = "is its bulk modulus in the units of pressure",
                    light = "grains would have a mass below zero", heavy = "units of density",
                    still = "nothing flows";
  const std::vector<std::string> all = {soft, light, heavy, still};
  const auto only = [&](const std::string &text, const std::string &expected) {
    for (const auto &words : all) EXPECT_EQ(told(text, words), words == expected) << text << words;
  };
  for (const double scale : {1.0, 1e-3}) {    // pressures in Pa and in kPa
    only(scene(scale, 2000, 2.2e9, 1e-4), "");
    only(scene(scale, 2000, 2.2, 1e-4), soft);
    only(scene(scale, 300, 2.2e9, 1e-4), light);
    only(scene(scale, 2000, 2.2e9, 1e-25), still);
  }
  only(scene(1.0, 1.0, 2.2e9, 1e-4), "");    // light soil, without inertia on purpose
  only(scene(1.0, 2e6, 2.2e9, 1e-4), heavy);
  EXPECT_EQ(told(scene(1.0, 300, 2.2e9, 1e-4, "fix g all gravity 9.81 vector 0 -1 0\n"),
                 "must be that of saturated soil"),
            2);    // with a weight, in each run
}

// the divisor of hydraulic conductivities against density times gravity, and flow without drag
SERIAL_TEST(Doubts, WeightOfWaterAndItsFlow)
{
  const auto scene = [](double weight, double permeability, double g, const std::string &more = "",
                        double scale = 1.0) {
    return START + GRID +
        strprintf("fix soil all mpm/material density %g linear %g 0.3\n", 2000 * scale,
                  1e7 * scale) +
        strprintf("fix w all mpm/pore %g %g %g soil soil 0.4 constant %g %s\n", 2.2e9 * scale,
                  1000 * scale, weight, permeability, more.c_str()) +
        strprintf("fix g all gravity %g vector 0 -1 0\n", g) + STEP;
  };
  const std::string divisor = "it is the divisor of hydraulic conductivities",
                    fast = "drag hardly couples them", still = "nothing flows";
  const auto only = [&](const std::string &text, const std::string &expected) {
    for (const auto &words : {divisor, fast, still})
      EXPECT_EQ(told(text, words), words == expected) << text << words;
  };
  only(scene(9810, 1e-4, 9.81), "");
  only(scene(9.81, 1e-4, 9.81), divisor);    // kN, or gravity
  only(scene(1000, 1e-4, 9.81), divisor);    // the density
  only(scene(9.81e6, 1e-4, 9.81), divisor);
  only(scene(10000, 1e-4, 9.81), "");    // rounded, and brine
  only(scene(9810, 1e-4, 98.1), "");     // in a centrifuge
  only(scene(1e-3, 1e-11, 9.81), "");    // a viscosity
  only(scene(9.81, 1e-4, 0.0), "");
  only(scene(9.81, 1e-4, 9.81, "", 1e-3), "");    // in kN, kPa, and t
  only(scene(9810, 0.1, 9.81), "");               // gravel
  only(scene(9810, 86.4, 9.81), fast);            // a meter in a day, as 24*3.6
  only(scene(9810, 1e-25, 9.81), still);
  const std::string dries = "retention vangenuchten 1e-4 2";
  only(scene(9810, 1e-4, 9.81, dries), "");
  only(scene(9810, 1e-25, 9.81, dries), still);
  // a run of so many steps ends before them
  EXPECT_EQ(told(scene(9810, 1e-8, 9.81), still), 0);
  EXPECT_EQ(times_said(replaced(scene(9810, 1e-11, 9.81), "mpm/dt 0.5", "mpm/dt 0.5 until 1e-4") +
                           "run 1000000\n",
                       still),
            1);
}

// the weight of a column of 0.4 m is 3.9 kPa, and the modulus of its lateral confinement 1.35 E
SERIAL_TEST(Doubts, SolidsSofterThanTheirWeight)
{
  const auto scene = [](double E, const std::string &more) {
    return START + GRID + strprintf("fix m all mpm/material density 1000 neohookean %g 0.3\n", E) +
        more + replaced(STEP, "0.5", "0.5 max 0.001");
  };
  const std::string words = "it is pressed flat where it stands",
                    weight = "fix g all gravity 9.81 vector 0 -1 0\n";
  EXPECT_EQ(told(scene(1e3, weight), words), 1);
  EXPECT_EQ(told(scene(1e5, weight), words), 0);
  EXPECT_EQ(told(scene(1e3, ""), words), 0);
  EXPECT_EQ(told(scene(1e3, replaced(weight, "9.81", "0.0981")), words), 0);
}

// bulk moduli of liquids against a weight of 3.9 kPa, whatever their equation of state
SERIAL_TEST(Doubts, LiquidsSofterThanTheirWeight)
{
  const auto scene = [](const std::string &law, const std::string &more) {
    return START + GRID + "fix m all mpm/material density 1000 " + law + "\n" + more +
        replaced(STEP, "0.5", "0.2 max 1e-6");
  };
  const std::string words = "it is pressed flat where it stands",
                    weight = "fix g all gravity 9.81 vector 0 -1 0\n";
  for (const char *law : {"eos tait %g 7", "eos linear %g"}) {
    EXPECT_EQ(told(scene(strprintf(law, 2.2), weight), words), 1) << law;
    EXPECT_EQ(told(scene(strprintf(law, 2.2e5), weight), words), 0) << law;
    EXPECT_EQ(told(scene(strprintf(law, 2.2), ""), words), 0) << law;
  }
  EXPECT_EQ(told(scene("eos shock 0.05 1.9 0.3", weight), words), 1);    // K = 2.5 Pa
  EXPECT_EQ(told(scene("eos shock 50 1.9 0.3", weight), words), 0);
  EXPECT_EQ(told(scene("eos ideal/gas 1.4 pressure 10", weight), words),
            0);    // a tall one is dense below
}

SERIAL_TEST(Doubts, NobodyHasSetTheTimeStep)
{
  const std::string words = "is the default of units si, which no command has changed";
  const auto implicit = START + replaced(GRID, "mpm 0.05", "mpm 0.05 frame total") +
      "fix m all mpm/material density 1000 neohookean 1e6 0.3\nfix w all mpm/boundary ylo stick\n"
      "fix g all gravity 9.81 vector 0 -1 0\n";
  EXPECT_EQ(told(implicit + "fix s all mpm/implicit euler\n", words), 1);
  EXPECT_EQ(told(implicit + "fix s all mpm/implicit static\n", words), 0);
  EXPECT_EQ(told(implicit + "fix s all mpm/implicit euler\ntimestep 1e-3\n", words), 0);
  const auto flow = START +
      "create_points 1 region b spacing 0.025\nfix w all mpm/incompressible 0.05 1000\n"
      "fix g all gravity 9.81 vector 0 -1 0\n";
  EXPECT_EQ(told(flow, words), 1);
  EXPECT_EQ(told(flow + "timestep 1e-3\n", words), 0);
  EXPECT_EQ(told(flow + replaced(STEP, "0.5", "0.5 max 0.01"), words), 0);
}

// a region that cuts a body loads a section of it
SERIAL_TEST(Doubts, LoadInsideOfABody)
{
  const auto scene = START + GRID + CONDUCTS + STEP;
  const std::string words = "goes through the inside of a body";
  const auto load = [](const std::string &block) {
    return "region lid " + block + "\nfix t all mpm/traction region lid traction 0 -1e4 0\n";
  };
  EXPECT_EQ(told(scene + load("block 0.2 0.8 0.3 0.5 INF INF"), words), 1);
  EXPECT_EQ(told(scene + load("block INF INF INF 0.3 INF INF"), words), 1);
  EXPECT_EQ(told(scene + load("block INF INF INF 0.4 INF INF"), words), 0);
  EXPECT_EQ(told(scene + load("block 0.2 0.8 0 0.4 INF INF"), words), 0);
  EXPECT_EQ(told(scene + load("plane 0 0.3 0 0 -1 0"), words), 1);
}

// regions have no periodic images; a region that is one is the remedy
SERIAL_TEST(Doubts, RegionsAcrossPeriodicFaces)
{
  const auto scene = replaced(START, "boundary f f p", "boundary p f p") + GRID + CONDUCTS + STEP;
  const std::string words = "reaches across the periodic face";
  const auto wall = [](const std::string &region) {
    return region + "\nfix w all mpm/boundary region w slip\n";
  };
  EXPECT_EQ(told(scene + wall("region w cylinder z 0.05 0.7 0.1 INF INF"), words), 1);
  EXPECT_EQ(told(scene + wall("region w block 0.9 1.1 0.5 0.8 INF INF"), words), 1);
  EXPECT_EQ(told(scene + wall("region w cylinder z 0.5 0.7 0.1 INF INF"), words), 0);
  EXPECT_EQ(told(scene + wall("region w block -1 2 0.5 0.8 INF INF"), words), 0);
  EXPECT_EQ(told(scene + wall("region w block INF 0.3 0.5 0.8 INF INF"), words), 0);
  EXPECT_EQ(told(scene + wall("region w block 0.1 0.3 -0.5 -0.1 INF INF"), words), 0);
  EXPECT_EQ(told(scene +
                     wall("region one cylinder z 0.05 0.7 0.1 INF INF\n"
                          "region two cylinder z 1.05 0.7 0.1 INF INF\n"
                          "region w union 2 one two"),
                 words),
            0);
  // one that moves there, in the second run, and its image
  const std::string moves = " INF INF move v_u NULL NULL units box\n",
                    go = "variable u equal 0.1*(step>10)\n";
  const auto moving =
      go + "region w block 0.8 0.95 0.5 0.8" + moves + "fix w all mpm/boundary region w slip\n";
  EXPECT_EQ(told(scene + moving, words), 0);
  EXPECT_EQ(told(scene + moving + "run 20\n", words), 1);
  EXPECT_EQ(told(scene + moving + "region v block -0.2 -0.05 0.5 0.8" + moves +
                     "fix v all mpm/boundary region v slip\nrun 20\n",
                 words),
            0);
  // inlets and outlets go on there
  const auto flows = scene + "region r block 0.9 1.1 0.6 0.8 INF INF\n";
  EXPECT_EQ(told(flows + "fix in all mpm/emit 1 region r velocity 0 1 0\n", words), 0);
  EXPECT_EQ(told(flows + "fix out all mpm/absorb region r\n", words), 0);
}

// regions that nothing uses, or that only make points and groups
SERIAL_TEST(Doubts, RegionsThatNothingUses)
{
  const auto scene = replaced(START, "boundary f f p", "boundary p f p") + GRID + CONDUCTS + STEP +
      "region far cylinder z 0.05 0.7 0.1 INF INF\n";
  const std::string words = "Region far reaches across the periodic face",
                    near = "region hot block 0.3 0.6 0.4 0.6 INF INF\n",
                    heat = near + "fix h all mpm/heat region hot temperature 400\n";
  EXPECT_EQ(told(scene + heat, words), 0);
  EXPECT_EQ(told(scene + "group mine region far\n", words), 0);
  EXPECT_EQ(told(scene + "create_points 1 region far ppc 2 outside ignore\n", words), 0);
  // and what uses it, alone or as a part
  const auto with = [&](const std::string &use) {
    return told(scene + near + use + "\n", words);
  };
  EXPECT_EQ(with("fix w all mpm/boundary region far slip"), 1);
  EXPECT_EQ(with("fix w all mpm/boundary ylo slip friction 0.1 patch far 0.2"), 1);
  EXPECT_EQ(with("fix h all mpm/heat region far temperature 400"), 1);
  EXPECT_EQ(with("region two union 2 far hot\nfix w all mpm/boundary region two slip"), 1);
  // an image that nothing uses is none
  EXPECT_EQ(with("region image cylinder z 1.05 0.7 0.1 INF INF\n"
                 "fix w all mpm/boundary region far slip"),
            1);
  EXPECT_EQ(with("region image cylinder z 1.05 0.7 0.1 INF INF\n"
                 "fix w all mpm/boundary region far slip\n"
                 "fix v all mpm/boundary region image slip"),
            0);
}

// a load on regions with open faces across a periodic face: the remedy that is named has all of it
SERIAL_TEST(Doubts, OpenRegionsAcrossPeriodicFaces)
{
  const std::string open = " open 1 open 2 open 3\n",
                    lid = "region lid block 0.7 1.3 INF 0.4 INF INF" + open,
                    image = "region image block -0.3 0.3 INF 0.4 INF INF" + open;
  const auto scene = replaced(START,
                              {{"boundary f f p", "boundary p f p"},
                               {"region b block 0.2 0.8 0 0.4 INF INF\n",
                                "region low block 0 0.2 0 0.4 INF INF\n"
                                "region high block 0.8 1 0 0.4 INF INF\n"
                                "region b union 2 low high\n"}}) +
      GRID + CONDUCTS + STEP + lid;
  const std::string load = " mpm/traction region ", down = " traction 0 -100 0\n",
                    words = "reaches across the periodic face";
  const auto one = lines_that_say(scene + "fix t all" + load + "lid" + down + RUNS, words);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_THAT(one[0], HasSubstr("add the same fix with a region that is shifted by -1 along x"));
  const auto both =
      scene + image + "fix t all" + load + "lid" + down + "fix s all" + load + "image" + down;
  EXPECT_EQ(told(both, words), 0);
  Scene run(both + "run 2\n");
  EXPECT_NEAR(run.evaluate("f_t[2]+f_s[2]"), -100.0 * 0.4, 1e-9);
  expect_error(scene + image + "region all union 2 lid image\nfix t all" + load + "all" + down +
                   "run 1\n",
               "use a fix of this style for each of them");
}

// columns and computes of LAMMPS that see a part of points only
SERIAL_TEST(Doubts, PressureOfAtoms)
{
  const auto scene = START + GRID + CONDUCTS + STEP;
  const std::string words = "not the temperature or stress of points",
                    of_compute = "not their stress";
  EXPECT_EQ(told(scene + "thermo_style custom step press\n", "WARNING: Fix mpm: columns"), 1);
  EXPECT_EQ(told(scene, words), 1);    // the default style; no warning
  EXPECT_EQ(told(scene, "WARNING: Fix mpm: columns"), 0);
  EXPECT_EQ(told(scene + "thermo_style custom step time\n", words), 0);
  EXPECT_EQ(told(scene + "compute s all stress/atom NULL\n", of_compute), 1);
  EXPECT_EQ(told(scene + "compute p all pressure NULL virial\n", of_compute), 1);
  EXPECT_EQ(told(scene + "group none type 2\ncompute s none stress/atom NULL\n", of_compute), 0);
}

SERIAL_TEST(Doubts, EnergyOfAtoms)
{
  const auto scene = START + GRID + CONDUCTS + STEP;
  const std::string words = "not that of the stress of material points",
                    of_compute = "sees the energy of pairs, not that of their stress",
                    warning = "WARNING: Fix mpm: columns of the log (";
  const auto style = [](const std::string &columns) {
    return "thermo_style custom step " + columns + "\n";
  };
  EXPECT_EQ(told(scene, words), 1);    // the default style; no warning
  EXPECT_EQ(told(scene, warning), 0);
  EXPECT_EQ(told(scene + style("pe"), warning + "PotEng)"), 1);
  EXPECT_EQ(told(scene + style("etotal epair"), warning + "TotEng E_pair)"), 1);
  EXPECT_EQ(told(scene + style("ke"), words), 0);    // velocities it does see
  EXPECT_EQ(told(scene + "compute e all pe/atom\n", of_compute), 1);
  EXPECT_EQ(told(scene + "compute e all pe\n", of_compute), 1);
  EXPECT_EQ(told(scene + "group none type 2\ncompute e none pe/atom\n", of_compute), 0);
  // pairs have an energy to see, but the total is still not all
  const auto pairs = scene + "pair_style lj/cut 0.01\npair_coeff * * 0 0.01\n";
  EXPECT_EQ(told(pairs + style("pe epair"), words), 0);
  EXPECT_EQ(told(pairs + style("pe etotal"), warning + "TotEng)"), 1);
  EXPECT_EQ(told(pairs + "compute e all pe/atom\n", of_compute), 0);
}

// what a message asks for is the mistake itself
SERIAL_TEST(Doubts, MistakesAreNamed)
{
  const auto two = START +
      "create_points 1 region b spacing 0.025\nfix grid all mpm 0.05\n"
      "fix w all mpm/incompressible 0.05 1000\n" +
      STEP;
  expect_error(two + "run 1\n", "give the fixes disjoint groups");
  expect_error(START + "fix w all mpm/incompressible 0.05 viscosity 0.001\n",
               "density is missing: expected floating point parameter instead of 'viscosity'");
  const auto scene = START + GRID + CONDUCTS + STEP;
  expect_error(scene + "fix heat all mpm/heat xlo convection 50\n", "needs H Tout");
  expect_error(scene + "fix t all mpm/traction region b traction 0 -1e4\n", "needs tx ty tz");
  const auto flow = START +
      "create_points 1 region b spacing 0.025\n"
      "fix w all mpm/incompressible 0.05 1000\n";
  expect_error(flow + "fix heat all mpm/heat\nrun 1\n",
               "those of fix w (style mpm/incompressible) have neither");
}

// a command that ends too soon: the message has the names of all arguments that are missing
SERIAL_TEST(Doubts, MissingArgumentsAreNamed)
{
  const auto missing = [](const std::string &command, const std::string &names) {
    expect_error(START + GRID + command + "\n", "missing argument(s), needs " + names + " (");
  };
  missing("fix x all mpm", "h");
  missing("fix x all mpm/boundary", "region or one or more of xlo xhi ylo yhi zlo zhi");
  missing("fix x all mpm/boundary region", "region-ID");
  missing("fix x all mpm/boundary xlo", "one of stick slip separate");
  missing("fix x all mpm/boundary region b", "one of stick slip separate");
  missing("fix x all mpm/material", "density or file");
  missing("fix x all mpm/material file", "filename");
  missing("fix x all mpm/incompressible", "h density");
  missing("fix x all mpm/incompressible 0.02", "density");
  missing("fix x all mpm/emit", "TYPE");
  missing("fix x all mpm/refine", "coarse-ID fine-ID");
  missing("fix x all mpm/refine grid", "fine-ID");
  missing("fix x all mpm/cells", "fix-ID");
  missing("compute x all mpm/atom", "name");
  missing("compute x all mpm/error", "value exact");
  missing("compute x all mpm/error x", "exact");
  missing("region x mpm/mesh", "file scale x y z");
  missing("region x mpm/mesh a.stl 1 0", "y z");
  missing("dump x all mpm/grid/vtk 10 a.*.vtu", "fix-ID field");
  missing("create_points", "type one of region box image mesh elements table");
  missing("create_points 1", "one of region box image mesh elements table");
  missing("create_points 1 region", "region-ID");
  for (const char *style : {"mesh", "elements", "table", "image"})
    missing(std::string("create_points 1 ") + style, "file");
  missing("pair_style mpm/penalty\npair_coeff 1 1", "modulus");
}

// the limit falls between two looks of fix mpm/dt: what its message names runs
SERIAL_TEST(Doubts, RemedyOfTheTimeStep)
{
  const auto scene = [](const std::string &more) {
    return plane("si", "f f", "0 1 0 1", 1, 0.02) + "fix grid all mpm 0.04\n" +
        "region w block 0.3 0.6 0.3 0.6 INF INF\ncreate_points 1 region w ppc 2\n"
        "fix m all mpm/material density 1 eos tait 1.0e3 7\n"
        "fix walls all mpm/boundary xlo xhi ylo yhi slip\nvelocity all set -10 -10 0\n"
        "fix step all mpm/dt 0.4 until 0.1 " +
        more + "\nrun 100000\n";
  };
  expect_error(scene(""), "give fix mpm/dt step the keyword every 1, strain 0.05");
  for (const char *remedy : {"every 1", "strain 0.05"}) EXPECT_EQ(error_of(scene(remedy)), "");
}

// temperatures against those of the strength: in degrees Celsius and kelvins, molten, hot walls
SERIAL_TEST(Doubts, TemperaturesOfStrength)
{
  const auto scene = [](double initial, double melting, double reference, double exponent = 1.1,
                        const std::string &more = "") {
    return START + GRID +
        strprintf("fix m all mpm/material density 7830 eos linear 172e9 strength johnson/cook "
                  "79.6e9 806e6 614e6 0.168 0.0089 1 %g %g %g thermal conducting 460 %g 50\n",
                  exponent, melting, reference, initial) +
        more + STEP;
  };
  const std::string cold = "is far below the reference temperature", molten = "their strength ends",
                    wall = "a wall has the temperature 2000";
  EXPECT_EQ(told(scene(293, 1793, 293), cold), 0);
  EXPECT_EQ(told(scene(77, 1793, 293), cold), 0);    // liquid nitrogen
  EXPECT_EQ(told(scene(20, 1793, 293), cold), 1);
  EXPECT_EQ(told(scene(20, 1520, 20), cold), 0);
  EXPECT_EQ(told(scene(20, 1793, 293, 0.0), cold), 0);    // it does not soften
  EXPECT_EQ(told(scene(293, 1793, 293), molten), 0);
  EXPECT_EQ(told(scene(1800, 1793, 293), molten), 1);
  const auto heated = [&](double temperature, double exponent = 1.1) {
    return scene(293, 1793, 293, exponent,
                 strprintf("fix heat all mpm/heat ylo temperature %g\n", temperature));
  };
  EXPECT_EQ(told(heated(2000), wall), 1);
  EXPECT_EQ(told(heated(2000, 0.0), wall), 0);
  EXPECT_EQ(told(heated(1700), "a wall has the temperature"), 0);
}

// points in a wall, or in a rigid body, stay where they are: neither pushes them out
SERIAL_TEST(Doubts, PointsThatBeginInWalls)
{
  const std::string words = "more than half a node spacing deep",
                    law = "fix m all mpm/material density 1000 neohookean 1e6 0.3\n";
  const auto scene = [&](const std::string &block, const std::string &wall,
                         const std::string &kind) {
    return START + "fix grid all mpm 0.05\nregion body block " + block +
        " INF INF\ncreate_points 1 region body ppc 2\n" + law + "region w " + wall +
        "\nfix w all mpm/boundary region w " + kind + "\n" + STEP;
  };
  const std::string high = "0.2 0.8 0.1 0.4", floor = "block INF INF INF 0.2 INF INF";
  EXPECT_EQ(told(scene(high, floor, "separate"), words), 1);
  EXPECT_EQ(told(scene(high, floor, "separate friction 0.3"), words), 1);
  EXPECT_EQ(told(scene(high, "cylinder z 0.5 0.25 0.1 INF INF", "separate"), words), 1);
  EXPECT_EQ(told(scene(high, floor + " move NULL NULL NULL", "separate"), words), 1);
  const std::string parts = "region one block INF 0.5 INF 0.2 INF INF\n"
                            "region two block 0.4 INF INF 0.2 INF INF\n";
  EXPECT_EQ(told(replaced(scene(high, "union 2 one two", "separate"), "\nregion w ",
                          "\n" + parts + "region w "),
                 words),
            1);
  // at the surface, within half a spacing of it, and what holds it
  EXPECT_EQ(told(scene("0.2 0.8 0.2 0.4", floor, "separate"), words), 0);
  EXPECT_EQ(told(scene("0.2 0.8 0.175 0.4", floor, "separate"), words), 0);
  EXPECT_EQ(told(replaced(scene("0.2 0.8 0.175 0.4", "union 2 one two", "separate"), "\nregion w ",
                          "\n" + parts + "region w "),
                 words),
            0);
  for (const char *kind : {"stick", "slip"}) EXPECT_EQ(told(scene(high, floor, kind), words), 0);
  // the remedy, and a wall that comes later, or that material has reached
  EXPECT_EQ(told(replaced(scene("0.2 0.8 0.1 0.4", "block INF INF INF 0.2 INF INF", "separate"),
                          "region body block 0.2 0.8 0.1 0.4 INF INF\n",
                          "region all block 0.2 0.8 0.1 0.4 INF INF\n"
                          "region above block INF INF INF 0.2 INF INF side out\n"
                          "region body intersect 2 all above\n"),
                 words),
            0);
  const auto open = scene("0.2 0.8 0.2 0.4", floor, "separate");
  EXPECT_EQ(told(open +
                     "region late block 0.5 0.7 0.2 0.4 INF INF\nrun 2\n"
                     "fix late all mpm/boundary region late separate\n",
                 words),
            1);
  EXPECT_EQ(told(open + "run 2\ndisplace_atoms all move 0 -0.1 0 units box\n", words), 0);
}

/** How often this is said of a cube of 0.3 in or over a bed. */
static int told_of_stone(const std::string &bed, const std::string &stone, const std::string &words,
                         const std::string &more = "")
{
  const ScratchFile file("stone.stl", text_of(box({0.0, 0.0, 0.0}, {0.3, 0.3, 0.3})));
  return told(space("si", "f f f", "0 1 0 1 0 1", 1, 0.03) + "fix grid all mpm 0.1\n" + bed +
                  "\ncreate_points 1 region bed ppc 2\n"
                  "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
                  "fix w all mpm/boundary xlo xhi ylo yhi zlo slip\nregion stone mpm/mesh " +
                  file.name + " 1.0 0.35 0.35 0.4\nfix stone all mpm/rigid stone density 2600 " +
                  stone + "\n" + more + STEP,
              words);
}

SERIAL_TEST(Doubts, PointsThatBeginInRigidBodies)
{
  const std::string words = "begin in the body, more than half a node spacing deep",
                    low = "region bed block INF INF INF INF INF 0.4",
                    high = "region bed block INF INF INF INF INF 0.6",
                    cut = "region upper block INF INF INF INF INF 0.6\nregion dry block 0.35 0.65 "
                          "0.35 0.65 0.4 0.7 side out\nregion bed intersect 2 upper dry";
  for (const char *kind : {"slip", "separate", "separate friction 0.3"}) {
    EXPECT_EQ(told_of_stone(high, kind, words), 1) << kind;
    EXPECT_EQ(told_of_stone(low, kind, words), 0) << kind;
    EXPECT_EQ(told_of_stone(cut, kind, words), 0) << kind;
  }
  EXPECT_EQ(told_of_stone(high, "stick", words), 0);
}

SERIAL_TEST(Doubts, RigidBodiesWithoutWeight)
{
  const std::string words = "does not act on the body",
                    g = "fix g all gravity 9.81 vector 0 0 -1\n",
                    low = "region bed block INF INF INF INF INF 0.4";
  EXPECT_EQ(told_of_stone(low, "separate", words, g), 1);
  EXPECT_EQ(told_of_stone(low, "separate", words), 0);
  EXPECT_EQ(told_of_stone(low, "separate", words, replaced(g, "9.81", "0")), 0);
  for (const char *meant : {"gravity 0 0 -9.81", "gravity 0 0 0", "force 0 0 -100", "hold z"})
    EXPECT_EQ(told_of_stone(low, std::string("separate ") + meant, words, g), 0) << meant;
  EXPECT_EQ(told_of_stone(low, "separate hold x y", words, g), 1);
}

// gas that nothing surrounds, unless it flies apart in any case
SERIAL_TEST(Doubts, GasInVacuum)
{
  const std::string words = "as into vacuum";
  const auto scene = [](const std::string &gas, const std::string &more = "") {
    return START + "fix grid all mpm 0.05\nregion gas block " + gas +
        " INF INF\ncreate_points 1 region gas ppc 2\n"
        "fix m all mpm/material density 1.2 eos ideal/gas 1.4 pressure 1e5\n"
        "fix w all mpm/boundary xlo xhi ylo yhi slip\n" +
        more + STEP;
  };
  EXPECT_EQ(told(scene("0 1 0 0.5"), words), 1);
  EXPECT_EQ(told(scene("0.3 0.7 0.3 0.7"), words), 1);
  EXPECT_EQ(told(scene("0 1 0 1"), words), 0);
  EXPECT_EQ(told(scene("0 1 0 0.95"), words), 0);
  EXPECT_EQ(told(replaced(scene("0 1 0 0.5"), "pressure 1e5", "pressure 1e-3") +
                     "velocity all set -1 0 0\n",
                 words),
            0);
  // the remedies, a piston, and another body
  EXPECT_EQ(told(scene("0 1 0 0.5", "fix air all mpm/traction free pressure 1e5\n"), words), 0);
  EXPECT_EQ(told(scene("0 1 0 0.5",
                       "region lid block INF INF 0.5 INF INF INF\n"
                       "fix lid all mpm/boundary region lid slip\n"),
                 words),
            0);
  EXPECT_EQ(
      told(
          replaced(scene("0 1 0 0.5", "fix lid lid mpm/material density 1000 neohookean 1e6 0.3\n"),
                   "fix m all",
                   "region lid block INF INF 0.5 0.7 INF INF\ncreate_points 2 region lid ppc "
                   "2\ngroup lid type 2\ngroup gas type 1\nfix m gas"),
          words),
      0);
  const auto periodic = [&](const std::string &gas) {
    return replaced(replaced(scene(gas), "boundary f f p", "boundary p f p"), "xlo xhi ", "");
  };
  EXPECT_EQ(told(periodic("0 1 0 1"), words), 0);
  EXPECT_EQ(told(periodic("0 0.8 0 1"), words), 1);
}

// what a data file loses, where there is something to lose
SERIAL_TEST(Doubts, DataFilesOfDeformedPoints)
{
  const ScratchFile file("points.data");
  const auto scene =
      START + GRID + CONDUCTS + STEP + "velocity all ramp vx 0 1 y 0 0.4 units box\n";
  const std::string words = "A data file has no deformation",
                    write = "write_data " + file.name + "\n";
  EXPECT_EQ(told(scene + write, words), 0);
  EXPECT_EQ(told(scene + "run 2\n" + write, words), 1);
  const ScratchFile restart("points.restart");
  EXPECT_EQ(told(scene + "run 2\nwrite_restart " + restart.name + "\n", words), 0);
}

// points of an inlet may be of a type that no points had when the pair style looked
SERIAL_TEST(Doubts, InletsOfNewTypes)
{
  for (const char *type : {"1", "3"}) {
    Scene run(plane("lj", "f f", "0 10 0 10", 3, 0.3) +
              "region one block 0 3 0 3 INF INF\nregion two block 4 7 0 3 INF INF\n"
              "region inlet block 1 2 6 8 INF INF\nfix a all mpm 1.0\n"
              "create_points 1 region one ppc 2\ncreate_points 2 region two ppc 2\nunfix a\n"
              "group one type 1\ngroup two type 2\nfix a one mpm 1.0\nfix b two mpm 1.0\n"
              "fix m all mpm/material density 1 linear 100 0.3\npair_style mpm/penalty\n"
              "pair_coeff * * 50.0\ntimestep 0.01\n"
              "fix in one mpm/emit " +
              std::string(type) + " region inlet velocity 5 0 0\n");
    const auto before = run.lmp->atom->natoms;
    EXPECT_EQ(run.error("run 30\n"), "");
    EXPECT_GT(run.lmp->atom->natoms, before + 8) << type;
  }
}

// commands between runs that strain bodies without their points knowing, and those that do not
SERIAL_TEST(Doubts, PointsMovedBetweenRuns)
{
  const auto scene = START + GRID + "region c block 0.4 0.6 0.6 0.8 INF INF\n" +
      "create_points 2 region c ppc 2\ngroup upper type 2\ngroup lower type 1\n" + CONDUCTS +
      "fix g all gravity 1 vector 0 -1 0\n" + STEP + "thermo 1000\nrun 2\n";
  const std::string words = "points relative to each other since the last run";
  const auto moved = [&](const std::string &command) {
    return told(scene + command, words);
  };
  EXPECT_EQ(moved("displace_atoms all ramp x 0 0.01 y 0 0.4 units box\n"), 1);
  EXPECT_EQ(moved("displace_atoms all ramp x 0 0.01 x 0.2 0.8 units box\n"), 1);
  EXPECT_EQ(moved("displace_atoms upper random 0.001 0.001 0 4711 units box\n"), 1);
  EXPECT_EQ(moved("change_box all y final 0 0.99 remap units box\n"), 1);
  // bodies as a whole, and points that come, go, or change their group
  EXPECT_EQ(moved(""), 0);
  EXPECT_EQ(moved("displace_atoms upper move 0.01 0.05 0 units box\n"), 0);
  EXPECT_EQ(moved("displace_atoms upper rotate 0.5 0.7 0 0 0 1 30 units box\n"), 0);
  EXPECT_EQ(moved("change_box all y final 0 1.1 units box\n"), 0);
  EXPECT_EQ(moved("delete_atoms group upper\n"), 0);
  EXPECT_EQ(moved("region d block 0.1 0.2 0.8 0.9 INF INF\ncreate_points 2 region d ppc 2\n"), 0);
  EXPECT_EQ(moved("group left region b\ndisplace_atoms left move 0 0.01 0 units box\n"), 0);
  EXPECT_EQ(moved("velocity upper set 0 -1 0\nrun 2 post no\nrun 2 pre no\n"), 0);
  // turns leave strain and stress as they were, also those after which a square looks the same
  const std::string turns = "a command has turned",
                    strain = "velocity upper ramp vx -0.1 0.1 x 0.4 0.6 units box\nrun 2\n";
  for (const char *angle : {"0.01", "45", "90", "180"}) {
    const auto rotate = strprintf("displace_atoms upper rotate 0.5 0.7 0 0 0 1 %s\n", angle);
    EXPECT_EQ(told(scene + strain + rotate, turns), 1) << angle;
    EXPECT_EQ(told(scene + strain + rotate, words), 0) << angle;
    EXPECT_EQ(told(scene + rotate, turns), 0) << angle;
    EXPECT_EQ(told(replaced(scene, "mpm 0.05\n", "mpm 0.05 frame total\n") + rotate, turns), 1);
  }
  for (const char *command :
       {"displace_atoms upper move 0.01 0.05 0 units box\n",
        "displace_atoms upper rotate 0.5 0.7 0 0 0 1 360\n",
        "group upper clear\ngroup other type 2\n", "reset_atoms id sort yes\n"})
    EXPECT_EQ(told(scene + strain + command, turns), 0) << command;
  // before the first run, and across a periodic face
  EXPECT_EQ(told(START + GRID + CONDUCTS + STEP +
                     "displace_atoms all random 0.001 0.001 0 4711 units box\n",
                 words),
            0);
  EXPECT_EQ(told(replaced(scene, "boundary f f p", "boundary p f p") +
                     "displace_atoms all move 0.7 0 0 units box\n",
                 words),
            0);
}

// round bodies that roll where friction acts turn too slowly: as polygons, if they are of whole
// points, and by the place of the normal force, if friction times radius is less than 1.5 spacings
SERIAL_TEST(Doubts, RoundBodiesThatRoll)
{
  const auto messages = [](const std::string &points, const std::string &wall, double spin,
                           const std::string &shape = "cylinder z 0.5 0.25 0.25 INF INF") {
    const auto scene = plane("si", "f f", "0 1 0 1", 1, 0.025) +
        "fix grid all mpm 0.05\nregion d " + shape + "\ncreate_points 1 region d ppc 2 " + points +
        "\nfix m all mpm/material density 1000 neohookean 1e6 0.3\n" + wall +
        strprintf("\nvariable u atom %g*(0.25-y)\nvariable v atom %g*(x-0.5)\n", spin, spin) +
        "velocity all set v_u v_v 0\nfix dt all mpm/dt 0.5 until 0.1\nthermo 10000\n"
        "run 100000\nrun 1\n";
    return std::make_pair(told(scene, "rolls and slips as a polygon"),
                          told(scene, "the normal force is up to"));
  };
  const auto polygon = std::make_pair(1, 0), small = std::make_pair(0, 1),
             silent = std::make_pair(0, 0);
  const std::string wall = "fix w all mpm/boundary ylo separate", rough = wall + " friction 0.35",
                    smoother = wall + " friction 0.25";
  EXPECT_EQ(messages("", rough, 5.0), polygon);
  EXPECT_EQ(messages("", wall + " friction 1e-6", 31.4), polygon);    // half a turn
  EXPECT_EQ(messages("", rough, 0.5), silent);
  EXPECT_EQ(messages("", wall, 5.0), silent);
  for (const char *points : {"cut yes", "relax 20"}) {
    EXPECT_EQ(messages(points, smoother, 5.0), small);
    EXPECT_EQ(messages(points, rough, 5.0), silent);
    EXPECT_EQ(messages(points, wall, 5.0), silent);
  }
  EXPECT_EQ(messages("", rough, 5.0, "block 0.3 0.7 0.1 0.3 INF INF"), silent);
}

// fluid is one of the flow, whatever law there is for it; solids in it have theirs
SERIAL_TEST(Doubts, LawsOfFluid)
{
  const auto scene = START + "create_points 1 region b spacing 0.025\n" +
      "region c block 0.4 0.6 0.1 0.3 INF INF\ngroup solid region c\n"
      "group fluid subtract all solid\nfix g all gravity 9.81 vector 0 -1 0\n" +
      replaced(STEP, "0.5", "0.5 max 0.001");
  const std::string flow = "fix w all mpm/incompressible 0.05 1000 viscosity 10 solid solid\n",
                    words = "does not act on ";
  const auto law = [](const std::string &group) {
    return "fix m " + group + " mpm/material density 1000 neohookean 1e3 0.3\n";
  };
  EXPECT_EQ(told(scene + law("solid") + flow, words), 0);
  EXPECT_EQ(told(scene + law("all") + flow, words), 1);
  const auto fluid = scene + replaced(flow, " solid solid", "");
  EXPECT_EQ(told(fluid, words), 0);
  EXPECT_EQ(told(fluid + law("all"), words), 1);
}

// loads act on points of fix mpm, which may be next to a flow
SERIAL_TEST(Doubts, LoadsOnAFlow)
{
  const auto scene = replaced(START, "atom_style mpm", "atom_style hybrid sphere mpm") +
      "create_points 1 region b spacing 0.025\n" +
      "region c block 0.4 0.6 0.6 0.8 INF INF\ncreate_points 2 region c spacing 0.025\n"
      "group fluid type 1\ngroup block type 2\nfix grid block mpm 0.05\n"
      "fix m block mpm/material density 1000 neohookean 1e5 0.3\n"
      "fix w fluid mpm/incompressible 0.05 1000\nfix g all gravity 9.81 vector 0 -1 0\n" +
      replaced(STEP, "0.5", "0.5 max 0.001");
  const std::string words = "points of its group are in the flow";
  for (const std::string group : {"fluid", "block", "all"})
    for (const std::string load : {" mpm/traction free pressure 100", " mpm/surface"})
      EXPECT_EQ(told(scene + "fix load " + group + load + "\n", words), group == "fluid")
          << group << load;
}

// grains in the group of a flow are moved by their fix only, which LAMMPS does not know
SERIAL_TEST(Doubts, GroupsOfIntegrators)
{
  const std::string words = "time integrated more than once";
  const auto scene = replaced(START, "atom_style mpm", "atom_style hybrid sphere mpm") +
      "create_points 1 region b spacing 0.025\ncreate_atoms 2 single 0.5 0.2 0\n"
      "set type 2 diameter 0.01 density 2000\ngroup grains type 2\n"
      "fix w all mpm/incompressible 0.05 1000\nfix g all gravity 9.81 vector 0 -1 0\n"
      "fix nve grains nve/sphere disc\nfix i grains mpm/immersed w 1000 0.001 gravity 0 -9.81 0\n" +
      replaced(STEP, "0.5", "0.5 max 0.001");
  EXPECT_EQ(told(scene, words), 0);
  EXPECT_EQ(told(scene + "fix twice grains nve\n", words), 2);
  expect_error(replaced(scene, "nve grains", "nve all") + "run 1\n",
               "give the fixes disjoint groups");
}
