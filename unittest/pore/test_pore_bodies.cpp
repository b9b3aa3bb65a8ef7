// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 300

// Soil with pore water in contact with bodies (fix mpm/contact), with rigid ones (fix mpm/rigid),
// which bear the total stress, and soil whose pores shut.

#include "pore/pore_testing.h"

#include "error.h"
#include "field/mpm_forces.h"
#include "mesh/stl_testing.h"

using namespace MPM_TEST;

constexpr double SUBMERGED = 990.0 / 1990.0;    // weight in water over that of soil and water

/** A layer of saturated soil, 1 m high with 10 cells, periodic along x, in a box from y = -0.4 on;
 *  water has the pressure of rest across the layer, and seeps along it. slope: tangent of the angle
 *  of gravity; offset: of y = 0 from nodes, in cells; dim: 2, or 3, where y is up, too. */
std::string layer(double slope, double offset, int dim)
{
  const double cosine = 1.0 / std::sqrt(1.0 + slope * slope);
  return (dim == 2 ? plane("si", "p f", "0 0.4 -0.4 1", 2, 0.03)
                   : space("si", "p f p", "0 0.4 -0.4 1 0 0.4", 2, 0.03)) +
      "region soil block INF INF 0 1 INF INF\nregion base block INF INF -0.4 0 INF INF\n"
      "group soil empty\ngroup base empty\n" +
      strprintf("fix grid soil mpm 0.1 origin 0 %.17g%s\n", 0.1 * offset, dim == 2 ? "" : " 0") +
      "create_points 1 region soil spacing 0.05 fix grid group soil\n"
      "fix m soil mpm/material density 1990 linear 1e7 0.3\n" +
      strprintf("fix g all gravity 9.81 vector %.17g -1 0\nvariable p atom 9810*%.17g*(1-y)\n",
                slope, cosine) +
      "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-2 yhi pressure 0 initial "
      "v_p\n";
}

/** The same on a body that is held, in a field of its own. */
std::string on_body(const std::string &law, double slope, double offset, int dim = 2,
                    const char *order = "grid lower")
{
  return layer(slope, offset, dim) +
      strprintf("fix lower base mpm 0.1 origin 0 %.17g%s\n", 0.1 * offset, dim == 2 ? "" : " 0") +
      "create_points 2 region base spacing 0.05 fix lower group base\n"
      "fix b base mpm/material density 2500 linear 1e8 0.3\n"
      "fix hold all mpm/boundary ylo stick\nfix touch all mpm/contact " +
      order + " law " + law + "\n";
}

struct Motion {
  double v[2] = {0.0, 0.0}, lowest = 1e300, highest = -1e300;
};
/** Mean of the points of the soil. */
Motion of_soil(Scene &run)
{
  Motion m;
  double n = 0.0;
  for (int i = 0; i < run.n(); i++) {
    if (run.lmp->atom->type[i] != 1) continue;
    for (int d = 0; d < 2; d++) m.v[d] += run.v()[i][d];
    m.lowest = std::min(m.lowest, run.x()[i][1]);
    m.highest = std::max(m.highest, run.x()[i][1]);
    n++;
  }
  for (double &v : m.v) v /= n;
  return m;
}

/** Friction of the layer when it has come to rest on what is below, over that of its grains: what
 *  its weight is above the pressure of the water at its lower side, which may be a part of a cell
 *  off the surface of the other body. The pressure is zero at the upper end of the soil, which may
 *  be as much below the face of the box. */
double friction(Scene &run, double slope, double coefficient)
{
  run_until(run, 0.6);
  const auto before = of_soil(run);
  run_until(run, 0.7);
  const double cosine = 1.0 / std::sqrt(1.0 + slope * slope), low = before.lowest - 0.025,
               high = before.highest + 0.025;
  EXPECT_LT(std::fabs(low), 0.03);
  EXPECT_LT(std::fabs(high - 1.0), 0.03);
  const double held = 9.81 * cosine * slope - (of_soil(run).v[0] - before.v[0]) / 0.1;
  return held / (9.81 * cosine * coefficient * (1990.0 - 1000.0 * (high - low)) / 1990.0);
}

// an infinite slope with seepage: friction is that of the submerged weight, not half of the total
SERIAL_TEST(Contact, FrictionIsThatOfGrains)
{
  for (const double offset : first_of(1, {0.3, 0.0})) {
    Scene run(on_body("coulomb 0.5", 0.35, offset));
    EXPECT_NEAR(measured(strprintf("offset %g, friction", offset), friction(run, 0.35, 0.5)), 1.0,
                0.005);
  }
  Scene other(on_body("coulomb 0.5", 0.35, 0.5, 2, "lower grid"));
  EXPECT_NEAR(measured("soil is the second body", friction(other, 0.35, 0.5)), 1.0, 0.005);
  if (is_quick()) return;    // the others take long
  // a stiff one, which the layer does not press into
  Scene stiff(replaced(on_body("coulomb 0.5", 0.35, 0.0), "linear 1e8", "linear 1e9"));
  EXPECT_NEAR(measured("stiff, friction", friction(stiff, 0.35, 0.5)), 1.0, 0.005);
  Scene run(on_body("coulomb 0.5", 0.35, 0.2, 3));
  EXPECT_NEAR(measured("3d", friction(run, 0.35, 0.5)), 1.0, 8e-4);
}

// the layer is held below the angle with tan = friction times the share of submerged weight
SERIAL_TEST(Contact, SlopeHolds)
{
  Scene run(on_body("coulomb 0.5", 0.9 * 0.5 * SUBMERGED, 0.0));
  run_until(run, 0.7);
  EXPECT_NEAR(measured("velocity over that of sliding freely",
                       of_soil(run).v[0] / (9.81 * 0.45 * SUBMERGED * 0.7)),
              0.0, 8e-4);
}

// where water presses with more than the weight of the layer, grains leave and do not hold it back
SERIAL_TEST(Contact, WaterPartsBodies)
{
  for (const double offset : {0.0, 0.3})
    for (const auto &[law, order] :
         {std::pair{"coulomb 0.5", "grid lower"}, {"frictionless", "lower grid"}}) {
      Scene run(
          replaced(replaced(on_body(law, 0.0, offset, 2, order), "constant 1e-2", "constant 1e-9"),
                   "atom 9810", "atom 2.2*9810"));
      const double low = of_soil(run).lowest - 0.025;
      run.commands("timestep 1e-6\nrun 1\n");
      const double push = std::fabs(run.fix("touch")->compute_array(0, 1));
      EXPECT_NEAR(measured(strprintf("offset %g, force", offset),
                           push / (2.2 * 9810.0 * (1.0 - low) * 0.4)),
                  1.0, 1e-11);
    }
}

// two layers with water of different pressure: between them is the mean of both, and no node bears
// less. Below the interface nodes have an eighth of its area
SERIAL_TEST(Contact, OfTwoSoils)
{
  Scene run(replaced(replaced(on_body("coulomb 0.5", 0.0, 0.0), "density 2500", "density 1990"),
                     "fix hold",
                     "unfix water\nvariable p atom 9810*(1-y)*(2.2*(y>0)+1.2*(y<0))\n"
                     "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-9 soil b 0.4 "
                     "constant 1e-9 yhi pressure 0 initial v_p\nfix hold") +
            "timestep 1e-6\nrun 1\n");
  const double mean = 0.5 * (2.2 + 1.2);
  const double force =
      measured("force over that of the mean",
               std::fabs(run.fix("touch")->compute_array(0, 1)) / (mean * 9810.0 * 0.4));
  EXPECT_GT(force, 0.999);
  EXPECT_LT(force, 1.0 + 0.125 * (2.2 - mean) / mean);
}

// water at nodes that are not in contact: the left half of the lower body is off by h/14
SERIAL_TEST(Contact, MissedWaterIsTold)
{
  for (const bool off : {false, true})
    EXPECT_EQ(times_said(
                  on_body("coulomb 0.5", 0.0, 0.0) +
                      (off ? "region left block 0 0.2 INF INF INF INF\ngroup left region left\n"
                             "group part intersect left base\ndisplace_atoms part move 0 -0.007 0\n"
                           : "") +
                      "timestep 1e-6\nrun 60\n",
                  "counts as one of grains"),
              off ? 1 : 0);
}

TEST(Ranks, Agree)
{
  OnRanks run(on_body("coulomb 0.5", 0.35, 0.3) + "velocity soil set 0.1 0 0\ntimestep 1e-4\n",
              "run 100\n");
  EXPECT_LT(run.difference(), 1e-11);
}

constexpr double AREA = 0.16;

/** A column of saturated soil of 1 m and 10 cells, 4 cells wide and periodic, on a smooth floor
 *  below a plate whose lower side is at its top. offset: of the top from nodes, in cells. */
std::string under_plate(const std::string &file, const std::string &water, const std::string &tool,
                        double offset)
{
  const double top = 1.0 + 0.1 * offset;
  return space("si", "p p f", "0 0.4 0 0.4 0 1.6", 1, 0.03) +
      strprintf("region soil block INF INF INF INF 0 %.17g\n", top) + "fix grid all mpm 0.1\n" +
      strprintf("create_points 1 region soil spacing 0.05 0.05 %.17g\n", 0.05 * top) +
      "fix m all mpm/material density 1990 linear 1e7 0.3\nfix floor all mpm/boundary zlo slip\n" +
      strprintf("region shape mpm/mesh %s 1.0 -0.8 -0.8 %.17g\n", file.c_str(), top) +
      "variable q equal 0.5*(1-cos(PI*((time<0.05)*time/0.05+(time>=0.05))))\n"
      "fix water all mpm/pore " +
      water + "\nfix tool all mpm/rigid shape mass 10 " + tool + "\n";
}
Soup plate()
{
  return box({0.0, 0.0, 0.0}, {2.0, 2.0, 1.0});
}
/** Pressure that this load on undrained soil has, over the load. */
double share_of_water(double K)
{
  return K / 0.4 / (MODULUS + K / 0.4);
}

// undrained compression: the body bears the load; water has its part of the stiffness
SERIAL_TEST(Plate, BearsTheTotalStress)
{
  const ScratchFile file("plate.stl", text_of(plate()));
  for (const char *kind : first_of(2, {"slip", "separate friction 0.3", "separate", "stick"}))
    for (const double offset : {0.0, 0.4}) {
      if (offset > 0.0 && kind[1] == 't') continue;
      Scene run(under_plate(file.name, "2.2e8 1000 9810 soil m 0.4 constant 1e-9",
                            std::string(kind) + " force 0 0 v_f hold x y rx ry rz", offset) +
                strprintf("variable f equal -%g*v_q\n", 1e4 * AREA));
      Water water(run);
      double force = 0.0, pressure = 0.0, stress = 0.0, n = 0.0;
      run.each_step([&](double **) {
        if (run.time() < 0.06) return;
        force += run.fix("tool")->compute_vector(11);
        const double *const p = water.pressures();
        double sums[3] = {0.0, 0.0, 0.0}, sigma[6];    // four cells in the middle
        for (int i = 0; i < run.n(); i++) {
          if (run.x()[i][2] < 0.2 || run.x()[i][2] > 0.6) continue;
          run.points().cauchy(i, sigma);
          sums[0] += p[i];
          sums[1] += sigma[2];
          sums[2]++;
        }
        pressure += sums[0] / sums[2];
        stress += sums[1] / sums[2];
        n++;
      });
      run_until(run, 0.1);
      const std::string name = strprintf("%s, offset %g: ", kind, offset);
      EXPECT_NEAR(measured(name + "force over load", force / n / (1e4 * AREA)), 1.0, 3e-4);
      // points off the middle of cells have means that are not quite integrals
      const double near = offset > 0.0 ? 5e-3 : 1e-3;
      EXPECT_NEAR(measured(name + "total stress", (pressure - stress) / n / 1e4), 1.0, near);
      EXPECT_NEAR(measured(name + "pressure", pressure / n / (1e4 * share_of_water(2.2e8))), 1.0,
                  near);
    }
}

/** Friction over that of the whole load, of a plate that slides on the column from 60 ms on. */
double friction(const std::string &water, double offset)
{
  const ScratchFile file("plate.stl", text_of(plate()));
  Scene run(replaced(under_plate(file.name, water,
                                 "slip friction 0.3 velocity 4 0 0 force 0 0 v_f hold y rx ry rz",
                                 offset),
                     "zlo slip", "zlo stick") +
            strprintf("variable f equal -%g*v_q\n", 1e4 * AREA));
  double along = 0.0, down = 0.0;
  run.each_step([&](double **) {
    if (run.time() < 0.06) return;
    along -= run.fix("tool")->compute_vector(9);
    down += run.fix("tool")->compute_vector(11);
  });
  run_until(run, 0.08);
  return along / down / 0.3;
}

// friction of grains: by effective stress where the surface is closed, by all where it is open
SERIAL_TEST(Plate, FrictionIsThatOfGrains)
{
  for (const double K : {2.2e7, 2.2e8})
    for (const double offset : {0.0, 0.25, 0.6})
      EXPECT_NEAR(measured(strprintf("K %g, offset %g, friction", K, offset),
                           friction(strprintf("%g 1000 9810 soil m 0.4 constant 1e-9", K), offset)),
                  1.0 - share_of_water(K), 0.1);
  EXPECT_NEAR(measured("drained",
                       friction("2.2e7 1000 9810 soil m 0.4 constant 1e-9 free pressure 0", 0.25)),
              1.0, 1e-10);
}

// the forces from which a body takes the share of water in what presses it have, with the places of
// nodes, the moments of all components of the stress of points
SERIAL_TEST(Plate, ForcesBelowItAreOfTheWholeStress)
{
  const double p = 50.0, stress[6] = {11.0, -7.0, 5.0, 3.0, -13.0, 17.0};
  const int axes[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  Scene run(space("si", "f f f", "0 1 0 1 0 1", 1, 0.03) +
            "region body block 0.2 0.7 0.3 0.7 0.3 0.8\nfix grid all mpm 0.1\n"
            "create_points 1 region body spacing 0.05\n"
            "fix m all mpm/material density 1990 linear 1e7 0.3\n" +
            strprintf("variable p atom %g\n", p) +
            "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-9 initial v_p\n"
            "timestep 1e-9\nrun 1\n");
  for (int i = 0; i < run.n(); i++) std::copy_n(stress, 6, run.points().tau[i]);
  MPMField *const field = MPMField::all(run.lmp)[0];
  const std::vector<char> near(field->grid.blocks.size(), 1);
  std::vector<double> of[2];
  dynamic_cast<MPMPorePressure *>(run.fix("water"))
      ->find_forces_below_surface(*field, near, of[0], of[1]);
  for (const bool all : {false, true})
    for (int c = 0; c < 6; c++)
      for (const bool turned : {false, true}) {
        const int d = axes[c][turned], e = axes[c][!turned];
        double moment = 0.0;
        for (int64_t node = 0; node < field->grid.nnodes(); node++) {
          double x[3];
          field->grid.node_position(node, x);
          moment -= of[all][3 * node + d] * x[e];
        }
        EXPECT_NEAR(moment / (0.5 * 0.4 * 0.5), (all ? stress[c] : 0.0) - (c < 3 ? p : 0.0), 1e-9)
            << all << c;
      }
}

// consolidation under a plate that lets water through, or one that does not, on a floor that does
SERIAL_TEST(Plate, ConsolidatesTheSoil)
{
  const ScratchFile file("plate.stl", text_of(plate()));
  const double K = 2.2e7, c = 2e-3 / 9810.0 / (1.0 / MODULUS + 0.4 / K), ramp = 0.02, h = 0.1;
  for (const char *surface : {"free pressure 0", "free pressure 0 bodies closed zlo pressure 0"}) {
    Scene run(
        space("si", "p p f", strprintf("0 %g 0 %g 0 1.6", 2 * h, 2 * h), 1, 0.3 * h) +
        "region soil block INF INF INF INF 0 1\n" +
        strprintf("fix grid all mpm %g\ncreate_points 1 region soil spacing %g\n", h, 0.5 * h) +
        "fix m all mpm/material density 200 linear 1e7 0.3\n"
        "fix floor all mpm/boundary zlo slip\nregion shape mpm/mesh " +
        file.name + " 1.0 -0.8 -0.8 1.0\n" +
        strprintf("variable q equal 0.5*(1-cos(PI*((time<%g)*time/%g+(time>=%g))))\n", ramp, ramp,
                  ramp) +
        strprintf("variable f equal -%g*v_q\n", 1e4 * 4 * h * h) +
        strprintf("fix water all mpm/pore %g 100 9810 soil m 0.4 constant 2e-3 %s\n", K, surface) +
        strprintf("fix tool all mpm/rigid shape mass %g separate force 0 0 v_f hold x y rx ry rz\n",
                  4 * h * h));
    Water water(run);
    for (const double T : {0.1, 0.5}) {
      run_until(run, T / c + 0.5 * ramp);
      double left = 0.0, exact = 1.0;
      for (int i = 0; i < run.n(); i++) left += water.pressures()[i] / run.n();
      for (int m = 0; m < 200; m++) {
        const double M = (2 * m + 1) * PI2;
        exact -= 2.0 / (M * M) * std::exp(-M * M * T);
      }
      EXPECT_NEAR(
          measured(strprintf("%s, T %g, U", surface, T), 1.0 - left / (1e4 * share_of_water(K))),
          exact, T < 0.2 ? 0.02 : 0.005);
    }
  }
}

// no water leaves a column that a plate closes, though its free surface would be open
SERIAL_TEST(Plate, ClosesTheSurface)
{
  const ScratchFile file("plate.stl", text_of(plate()));
  for (const char *bodies : {"open", "closed"}) {
    Scene run(under_plate(file.name,
                          std::string("2.2e7 1000 9810 soil m 0.4 constant 1e-3 free pressure 0 "
                                      "bodies ") +
                              bodies,
                          "separate force 0 0 v_f hold x y rx ry rz", 0.3) +
              strprintf("variable f equal -%g*v_q\n", 1e4 * AREA));
    run_until(run, 0.06);
    const double came = measured(bodies, run.fix("water")->compute_scalar());
    if (bodies[0] == 'o')
      EXPECT_LT(came, -1e-6);
    else
      EXPECT_EQ(came, 0.0);
  }
  Scene other(under_plate(file.name,
                          "2.2e7 1000 9810 soil m 0.4 constant 1e-3 free pressure 0 bodies closed",
                          "separate", 0.0));
  other.commands("unfix tool\n");
  expect_error(other, "timestep 1e-6\nrun 0\n", "there is no fix mpm/rigid");
}

// the same under a region of fix mpm/boundary that moves
TEST(Wall, ClosesTheSurface)
{
  for (const char *bodies : {"open", "closed"}) {
    Scene run(plane("si", "p f", "0 0.4 0 1.6", 1, 0.03) +
              "region soil block INF INF INF 1.03 INF INF\nfix grid all mpm 0.1\n"
              "create_points 1 region soil spacing 0.05 0.0515\n"
              "fix m all mpm/material density 2000 linear 1e7 0.3\n"
              "fix floor all mpm/boundary ylo slip\nvariable d equal -0.02*time\n"
              "region plate block INF INF 1.03 1.4 INF INF move NULL v_d NULL\n"
              "fix plate all mpm/boundary region plate slip\n"
              "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-3 free pressure 0 "
              "bodies " +
              bodies + "\n");
    run_until(run, 0.02);
    const double came = measured(bodies, run.fix("water")->compute_scalar());
    if (bodies[0] == 'o')
      EXPECT_LT(came, -1e-6);
    else
      EXPECT_EQ(came, 0.0);
  }
}

// pair styles do not know what water bears, which is told where they have friction
SERIAL_TEST(Pairs, HaveFrictionOfTheTotalStress)
{
  for (const char *friction : {"", " friction 0.3 0.01"})
    EXPECT_EQ(
        times_said(
            plane("si", "p f", "0 0.4 -0.4 1", 2, 0.03) +
                "region soil block INF INF 0 1 INF INF\nregion base block INF INF -0.4 0 INF INF\n"
                "group soil empty\ngroup base empty\nfix grid soil mpm 0.1\nfix lower base mpm "
                "0.1\n"
                "create_points 1 region soil spacing 0.05 fix grid group soil\n"
                "create_points 2 region base spacing 0.05 fix lower group base\n"
                "fix m all mpm/material density 1990 linear 1e7 0.3\n"
                "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-9\n"
                "comm_modify vel yes\npair_style mpm/penalty\npair_coeff * * 1e6" +
                friction + "\ntimestep 1e-6\nrun 0\n",
            "that of the total stress"),
        friction[0] ? 1 : 0);
}

// a ball that slides and turns on wet soil, on ranks and after a restart
TEST(Ball, IsTheSameOnRanksAndAfterARestart)
{
  const ScratchFile file("ball.stl", text_of(ball(0.3, 2)));
  const std::string head = space("si", "p p f", "0 0.8 0 0.8 0 1.2", 1, 0.03) +
      "region soil block INF INF INF INF 0 0.5\nfix grid all mpm 0.1\n"
      "create_points 1 region soil spacing 0.05\n",
                    fixes = "fix m all mpm/material density 1990 linear 1e6 0.3\n"
                            "fix floor all mpm/boundary zlo slip\nregion shape mpm/mesh " +
      file.name +
      " 1.0 0.75 0.4 0.77\nfix water all mpm/pore 2.2e6 1000 9810 soil m 0.4 constant 1e-3 free "
      "pressure 0 bodies closed\nfix tool all mpm/rigid shape density 3000 separate friction 0.4 "
      "velocity 1 0.5 -2 omega 1 2 3\ntimestep 1e-4\n";
  Twins run(head + fixes, 80, "fix grid all mpm 0.1\n" + fixes, 70, 1.0e-9);
  const double *a = run.serial.fix_vector("tool", 24), *b = run.whole.fix_vector("tool", 24);
  EXPECT_GT(std::fabs(measured("force", a[11])), 1.0);
  for (int k = 0; k < 9; k++) EXPECT_NEAR(a[k], b[k], 1e-11);
  for (int k = 9; k < 15; k++) EXPECT_NEAR(a[k], b[k], 1e-11 * 1e4);
}

/** A block, 0.6 of it grains, between a floor and a lid that comes down with this speed. */
std::string pressed(const std::string &law, double speed)
{
  return plane("si", "p f", "0 0.4 0 1", 1, 0.03) + "create_points 1 box spacing 0.05\n" +
      "fix grid all mpm 0.1\nfix m all mpm/material density 2002 neohookean 1e7 0.3\n" +
      "fix ends all mpm/boundary ylo slip\n" +
      strprintf("fix lid all mpm/boundary yhi slip velocity 0 %g 0\n", -speed) +
      "fix water all mpm/pore 2.2e6 1000 9810 soil m 0.4 " + law + "\nfix dt all mpm/dt 0.3\n";
}

// one warning tells of it; nothing negative and no NaN comes out, and water is kept
TEST(Shut, IsTold)
{
  for (const char *law :
       {"kozeny 1e-2 ylo pressure 0", "squared 1e-2 ylo pressure 0",
        "kozeny 1e-2 ylo pressure 0 every 3", "kozeny 1e-2 ylo pressure 0 formulation u-v-p",
        "kozeny 1e-2 ylo pressure 0 forchheimer ergun 1e-3"}) {
    // that u-p leaves out the inertia of water that flows at two meters in a second is told first
    const double fast = std::string(law).find("u-v-p") == std::string::npos;
    Scene run(pressed(law, 2.0));
    Water water(run);
    run.commands("compute n all mpm/atom porosity\nfix dt all mpm/dt 0.3 until 0.05\nrun 100000\n");
    EXPECT_EQ(over_ranks(run.lmp->error->get_numwarn(), MPI_SUM), fast) << law;
    const double before = water.mass(), came = run.fix("water")->compute_scalar();
    run.commands("fix dt all mpm/dt 0.3 until 0.225\nrun 100000\n");
    EXPECT_EQ(over_ranks(run.lmp->error->get_numwarn(), MPI_SUM), fast + 1.0) << law;
    auto *compute = run.per_atom("n");
    const double *const p = water.pressures();
    double least = 1.0, lowest = 1.0;
    for (int i = 0; i < run.n(); i++) {
      lowest = std::min(lowest, run.points().jacobian(i));
      least = std::min(least, compute->vector_atom[i]);
      EXPECT_TRUE(std::isfinite(p[i])) << law;
      EXPECT_TRUE(std::isfinite(run.v()[i][1])) << law;
    }
    EXPECT_LT(over_ranks(lowest, MPI_MIN), 0.6) << law;
    EXPECT_EQ(over_ranks(least, MPI_MIN), 0.0) << law;
    const double now = run.fix("water")->compute_scalar();
    EXPECT_NEAR((water.mass() - before - 1000.0 * (now - came)) / before, 0.0, 1e-12) << law;
  }
}
