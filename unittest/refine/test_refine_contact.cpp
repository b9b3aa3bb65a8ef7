// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Bodies that have lattices of several spacings (fix mpm/refine): a fix mpm/contact for each.

#include "mpm_lammps.h"

using namespace MPM_TEST;

struct Part {    // what a body has on the lattice of a level: spacing 1, 1/2, ...
  char body;
  int level;
  std::string region;    // empty: no points
};

/** Fields A0, A1, B0, ... and groups of these names, united in bodies; points after all fixes. */
std::string fields(int dim, const std::vector<Part> &parts, const std::string &options)
{
  std::string head, points;
  std::map<char, std::string> bodies;
  for (const auto &part : parts) {
    const std::string name = part.body + std::to_string(part.level);
    const int type = (int) (&part - parts.data()) + 1;
    double origin = 0.0;
    for (int k = 0; k < part.level; k++) origin += 0.25 / (1 << k);
    const std::string group = strprintf("group %s type %d\n", name.c_str(), type);
    head += group +
        strprintf("fix %s %s mpm %.17g %s origin %.17g %.17g", name.c_str(), name.c_str(),
                  1.0 / (1 << part.level), options.c_str(), origin, origin) +
        (dim == 3 ? strprintf(" %.17g\n", origin) : "\n");
    bodies[part.body] += " " + name;
    if (part.region.empty()) continue;
    points += "region " + name + " block " + part.region + (dim == 2 ? " INF INF\n" : "\n") +
        strprintf("create_points %d region %s ppc 2 fix %s\n", type, name.c_str(), name.c_str()) +
        group;
  }
  for (const auto &[body, names] : bodies)
    if (std::count(names.begin(), names.end(), ' ') > 1)
      head += std::string("fix body") + body + " all mpm/refine" + names + "\n";
  return head + points;
}

/** Contact on the lattices that two bodies have in common: fixes c0, c1, ... */
std::string contacts(const std::vector<Part> &parts, const std::string &options)
{
  std::string text;
  for (const auto &a : parts)
    for (const auto &b : parts)
      if (a.body == 'A' && b.body == 'B' && a.level == b.level)
        text += strprintf("fix c%d all mpm/contact A%d B%d ", a.level, a.level, a.level) + options +
            "\n";
  return text;
}

/** Force on B of all lattices, in the last step. */
double force(Scene &run, int d)
{
  double sum = 0.0;
  for (int level = 0; level < 3; level++)
    if (auto *fix = run.lmp->modify->get_fix_by_id(strprintf("c%d", level)))
      sum += fix->compute_array(0, d);
  return sum;
}

/** Two blocks of 6 x 8 side by side, A below x = 6. */
std::vector<Part> blocks(const std::string &kind)
{
  if (kind == "coarse") return {{'A', 0, "0 6 0 8"}, {'B', 0, "6 12 0 8"}};
  if (kind == "fine") return {{'A', 1, "0 6 0 8"}, {'B', 1, "6 12 0 8"}};
  if (kind == "jump of both")    // across the interface
    return {{'A', 0, "0 6 0 4"}, {'A', 1, "0 6 4 8"}, {'B', 0, "6 12 0 4"}, {'B', 1, "6 12 4 8"}};
  if (kind == "jumps apart")
    return {{'A', 0, "0 6 0 3"}, {'A', 1, "0 6 3 8"}, {'B', 0, "6 12 0 5"}, {'B', 1, "6 12 5 8"}};
  if (kind == "jump near the interface")    // below it
    return {{'A', 0, "0 4 0 8"}, {'A', 1, "4 6 0 8"}, {'B', 0, ""}, {'B', 1, "6 12 0 8"}};
  if (kind == "jump at the interface")
    return {{'A', 0, "0 6 0 8"}, {'A', 1, ""}, {'B', 0, ""}, {'B', 1, "6 12 0 8"}};
  if (kind == "a body of the coarse lattice")
    return {{'A', 0, "0 6 0 4"}, {'A', 1, "0 6 4 8"}, {'B', 0, "6 12 0 8"}};
  if (kind == "a body of the fine lattice")
    return {{'A', 0, "0 6 0 4"}, {'A', 1, "0 6 4 8"}, {'B', 0, ""}, {'B', 1, "6 12 0 8"}};
  // three lattices
  return {{'A', 0, "0 6 0 3"},  {'A', 1, "0 6 3 6"},  {'A', 2, "0 6 6 8"},
          {'B', 0, "6 12 0 3"}, {'B', 1, "6 12 3 6"}, {'B', 2, "6 12 6 8"}};
}

const std::vector<std::string> KINDS = {"jump of both",
                                        "jumps apart",
                                        "jump near the interface",
                                        "jump at the interface",
                                        "a body of the coarse lattice",
                                        "a body of the fine lattice",
                                        "three lattices"};

struct Motion {
  double p, angular,
      energy;    // momentum, angular momentum about z with that of affine parts, kinetic energy
};

/** Of B, or of all. */
Motion motion(Scene &run, const std::vector<Part> &parts, bool all)
{
  Motion sum = {};
  for (int i = 0; i < run.n(); i++) {
    const Part &part = parts[run.lmp->atom->type[i] - 1];
    if (!all && part.body != 'B') continue;
    const double m = run.mass()[i],
                 h = std::pow(0.5, part.level), *const x = run.x()[i], *const v = run.v()[i],
                 *const C = run.affine(part.body + std::to_string(part.level))[i];
    sum.p += m * v[0];
    sum.angular += m * (x[0] * v[1] - x[1] * v[0] + 0.25 * h * h * (C[1] - C[2]));
    sum.energy += 0.5 * m * (v[0] * v[0] + v[1] * v[1]);
  }
  return sum;
}

const char *const HEAD_ON = "variable v atom 0.5*(x<6)-0.3*(x>6)\nvelocity all set v_v 0 0\n";

// Two blocks collide, with the jump of the spacing in one or both of them: momentum is kept to
// round-off, and the other body gets what it does on one lattice, between what it gets on the
// coarse and on the fine one (which lose energy where they meet, by their spacing)
SERIAL_TEST(Collision, IsThatOnOneLattice)
{
  for (const std::string &options : first_of<std::string>(1, {"", "scheme musl"})) {
    std::map<std::string, Motion> found;
    auto kinds = KINDS;
    kinds.insert(kinds.begin(), {"coarse", "fine"});
    for (const auto &kind : kinds) {
      const auto parts = blocks(kind);
      Scene run(plane("lj", "f f", "-4 20 -4 12", (int) parts.size(), 0.3) +
                fields(2, parts, options) + contacts(parts, "") +
                "fix m all mpm/material density 1 neohookean 100 0.3\n"
                "compute e all mpm/energy\nthermo_style custom step c_e\n" +
                HEAD_ON + "timestep 0.01\nrun 0\n");
      const auto before = motion(run, parts, true);
      run.commands("run 250\n");
      const auto after = motion(run, parts, true), one = motion(run, parts, false);
      const std::string name = kind + " " + options;
      EXPECT_NEAR(measured(name + ": momentum", after.p / before.p), 1.0, 1e-12);
      // a fine point between tied nodes has an affine part of these: not to round-off
      EXPECT_NEAR(measured("  angular momentum", after.angular / before.angular), 1.0, 0.01)
          << name;
      measured("  kinetic energy", after.energy / before.energy);
      found[kind] = {one.p, 0.0, after.energy / before.energy};
      EXPECT_LT(std::fabs(run.compute_vector()[10] / before.energy), 1e-12) << name;
      if (kind == "coarse" || kind == "fine") continue;
      EXPECT_GT(measured("  momentum of B", one.p), 0.995 * found["coarse"].p) << name;
      EXPECT_LT(one.p, 1.005 * found["fine"].p) << name;
      EXPECT_GT(found[kind].energy, 0.98 * found["coarse"].energy) << name;
      EXPECT_LT(found[kind].energy, 1.005 * found["fine"].energy) << name;
    }
  }
}

// They touch when their surfaces do, to a hundredth of a cell, though functions change before
SERIAL_TEST(Collision, BeginsWhereTheyTouch)
{
  for (const std::string kind : {"jump of both", "jumps apart", "jump at the interface"}) {
    auto parts = blocks(kind);
    for (auto &part : parts)    // a gap of 1
      if (part.body == 'B') part.region = replaced(part.region, "6 12", "7 13");
    Scene run(plane("lj", "f p", "-8 24 0 8", (int) parts.size(), 0.3) + fields(2, parts, "") +
              contacts(parts, "") +
              "fix m all mpm/material density 1 neohookean 100 0.3\n"
              "variable v atom 1.0*(x<6)\nvelocity all set v_v 0 0\ntimestep 0.005\nrun 197\n");
    EXPECT_LT(std::fabs(measured(kind + ": momentum of B before", motion(run, parts, false).p)),
              1e-12);
    run.commands("run 263\n");
    // 43.73 on the coarse lattice, 45.63 on the fine one
    EXPECT_NEAR(measured("after", motion(run, parts, false).p), 44.7, 1.2);
    EXPECT_NEAR(motion(run, parts, true).p, 48.0, 1e-11);
  }
}

// The same in 3d, and in the opposite order of the fields
SERIAL_TEST(Collision, In3d)
{
  LONG_CASE();
  double last = 0.0;
  for (const bool reversed : {false, true}) {
    std::vector<Part> parts = {{'A', 0, "0 4 0 4 0 4"},
                               {'A', 1, "0 4 4 7 0 4"},
                               {'B', 0, "4 7 0 4 0 4"},
                               {'B', 1, "4 7 4 7 0 4"}};
    auto text = fields(3, parts, "") + contacts(parts, "law coulomb 0.3");
    if (reversed)
      text = replaced(replaced(text, "mpm/contact A0 B0", "mpm/contact B0 A0"), "mpm/contact A1 B1",
                      "mpm/contact B1 A1");
    Scene run(space("lj", "f f f", "-4 12 -4 12 -4 8", (int) parts.size(), 0.3) + text +
              "fix m all mpm/material density 1 neohookean 100 0.3\n" +
              replaced(replaced(HEAD_ON, "<6", "<4"), ">6", ">4") + "timestep 0.01\nrun 0\n");
    const auto before = motion(run, parts, true);
    run.commands("run 60\n");
    const auto after = motion(run, parts, true), one = motion(run, parts, false);
    EXPECT_NEAR(measured("momentum", after.p / before.p), 1.0, 1e-12);
    EXPECT_GT(measured("momentum of B", one.p), 0.0);    // was negative
    if (reversed) EXPECT_NEAR(one.p / last, 1.0, 1e-10);
    last = one.p;
  }
}

/** A below B, along x, with periodic sides: at rest under their weight. */
std::string pile(const std::vector<Part> &parts, const std::string &options,
                 const std::string &law = "")
{
  return plane("lj", "f p", "0 16 0 8", (int) parts.size(), 0.3) + fields(2, parts, options) +
      contacts(parts, law) +
      "fix m all mpm/material density 1 linear 1000 0.3\nfix floor all mpm/boundary xlo slip\n"
      "fix g all gravity 1 vector -1 0 0\nfix dt all mpm/dt 0.4\n";
}

// A block rests on another one: they press on each other with its weight, and the stress is that of
// the weight above. With affine terms, forces at the rim are not those of the functions
SERIAL_TEST(Rest, OnEachOther)
{
  LONG_CASE();
  for (const std::string options : {"stress gradient", ""}) {
    double coarse = 0.0;
    auto kinds = KINDS;
    kinds.insert(kinds.begin(), {"coarse", "fine"});
    if (options.empty()) kinds = {"coarse", "jump of both", "jump near the interface"};
    for (const auto &kind : kinds) {
      const auto parts = blocks(kind);
      Scene run(pile(parts, options));
      run.set_reference();
      run.commands("fix rest all mpm/relax 1e-5\nrun 20000\n");
      const std::string name = kind + " " + options;
      EXPECT_LE(run.fix("rest")->compute_scalar(), 1e-5) << name;
      EXPECT_NEAR(measured(name + ": force over weight", force(run, 0) / 48.0), 1.0, 1e-3);
      double square = 0.0, all = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const auto sigma = run.cauchy(i);
        const double weight = 12.0 - run.reference(i)[0], m = run.mass()[i];
        square += m * pow(sigma[0] + weight, 2);
        all += m * weight * weight;
      }
      const double error = measured("  error of the stress", sqrt(square / all));
      if (kind == "coarse") coarse = error;
      EXPECT_LT(error, options.empty() ? 0.04 : 1.1 * coarse) << name;
    }
  }
}

// All lattices of a body have one form of stress by default, also where one alone is in touch
SERIAL_TEST(Rest, OneFormOfTheStress)
{
  const auto lines = [](const std::string &scene) {
    return times_said(scene, ": stress gradient, the default");
  };
  const auto parts = blocks("a body of the coarse lattice");
  const std::string scene = pile(parts, ""), rest = "fix rest all mpm/relax 1e-5\nrun 1\n";
  EXPECT_EQ(lines(scene + rest), 0);
  EXPECT_EQ(lines(scene + "unfix c0\n" + rest), 3);
  // a line tells what has ended it
  EXPECT_EQ(times_said(scene + "unfix c0\n" + rest + "fix c0 all mpm/contact A0 B0\nrun 1\n",
                       "stress mls again, the default with fix mpm/contact"),
            3);
}

// It slides on the other one: the force is the coefficient of friction times its weight
SERIAL_TEST(Slide, HasTheFrictionOfTheWeight)
{
  LONG_CASE();
  auto kinds = KINDS;
  kinds.insert(kinds.begin(), {"coarse", "fine"});
  for (const auto &kind : kinds) {
    const auto parts = blocks(kind);
    Scene run(pile(parts, "", "law coulomb 0.3"));
    run.commands("fix rest all mpm/relax 1e-5\nrun 20000\nunfix rest\n");
    std::string group = "group block type";
    for (std::size_t k = 0; k < parts.size(); k++)
      if (parts[k].body == 'B') group += " " + std::to_string(k + 1);
    const double start = run.time();
    run.commands(group + "\nvelocity block set NULL 2.0 NULL\ntimestep 0.004\nunfix dt\nrun 500\n");
    EXPECT_NEAR(run.time() - start, 2.0, 1e-10);
    double p[2] = {0.0, 0.0};
    for (const auto &point : run.gather())
      p[parts[(int) point.type - 1].body == 'B'] += point.mass * point.v[1];
    EXPECT_NEAR(measured(kind + ": velocity lost over that by friction", (2.0 - p[1] / 48.0) / 0.6),
                1.0, 0.003);
    EXPECT_NEAR((p[0] + p[1]) / 96.0, 1.0, 1e-12) << kind;
  }
}

// Three bodies, the thin middle one in contact with both others by fixes of its own: nodes of one
// that reach cells of the last one are tied, too, as they are in the middle one
SERIAL_TEST(Chain, OfThreeBodies)
{
  const std::vector<Part> parts = {{'A', 0, "0 4 0 4"}, {'A', 1, "0 4 4 8"}, {'B', 0, ""},
                                   {'B', 1, "4 5 0 8"}, {'C', 0, "5 9 4 8"}, {'C', 1, "5 9 0 4"}};
  double tied[2];
  for (const bool chain : {false, true}) {
    Scene run(
        plane("lj", "f f", "-4 20 -4 12", (int) parts.size(), 0.3) + fields(2, parts, "") +
        contacts(parts, "") +
        (chain ? "fix d0 all mpm/contact B0 C0\nfix d1 all mpm/contact B1 C1\n" : "") +
        "fix m all mpm/material density 1 neohookean 100 0.3\n"
        "variable v atom 0.5*(x<4)-0.5*(x>5)\nvelocity all set v_v 0 0\ntimestep 0.01\nrun 0\n");
    run.commands("run 1\n");
    tied[chain] = run.fix("bodyA")->compute_vector(0);
    if (!chain) continue;
    run.commands("run 299\n");
    std::map<char, double> p;
    for (const auto &point : run.gather())
      p[parts[(int) point.type - 1].body] += point.mass * point.v[0];
    EXPECT_NEAR(p['A'] + p['B'] + p['C'], 0.0, 1e-12);
    EXPECT_LT(measured("momentum of A", p['A'] / 16.0), -0.3);
    EXPECT_NEAR(measured("of C", p['C'] / 16.0), -p['A'] / 16.0, 1e-11);
  }
  EXPECT_GT(measured("tied nodes", tied[1]), tied[0]);
}

TEST(RefineContact, RanksAndRestart)
{
  const std::vector<Part> in_3d = {{'A', 0, "0 4 0 4 0 4"},
                                   {'A', 1, "0 4 4 7 0 4"},
                                   {'B', 0, "4 7 0 4 0 4"},
                                   {'B', 1, "4 7 4 7 0 4"}};
  for (const std::string kind : {"3d", "jumps apart", "a body of the fine lattice",
                                 "three lattices", "a body of the coarse lattice"}) {
    const bool solid = kind == "3d";
    const auto parts = solid ? in_3d : blocks(kind);
    const std::string head = box(solid ? 3 : 2, "lj", solid ? "p f f" : "f p f",
                                 solid ? "-2 10 -4 10 -4 8" : "-4 20 0 8 0 1", (int) parts.size(),
                                 0.3),
                      all = fields(solid ? 3 : 2, parts, solid ? "scheme musl" : "") +
        contacts(parts, "law coulomb 0.2");
    const std::string fixes =
        "fix m all mpm/material density 1 neohookean 100 0.3\ntimestep 0.01\n";
    const std::string start = "variable vx atom 0.5*(x<5)-0.3*(x>5)\nvariable vy atom 0.1*(x>5)\n"
                              "velocity all set v_vx v_vy 0\n";
    const std::string run = solid ? "run 20\n" : "run 60\n";
    OnRanks ranks(head + all + fixes + start, run);
    EXPECT_LT(measured(kind + ": difference to one rank", ranks.difference()), 1e-9);
    OnRanks even(head + all + fixes + start, run,
                 "comm_style tiled\nfix even all balance 4 1.0 rcb\n");
    EXPECT_LT(measured("  balanced", even.difference()), 1e-9);
    std::string again;    // without what creates points
    for (std::size_t at = 0, end; at < all.size(); at = end + 1) {
      end = all.find('\n', at);
      const std::string line = all.substr(at, end - at);
      if (line.find("fix ") == 0) again += line + "\n";
    }
    Continued restart(head + all + fixes + start, 10, "neighbor 0.3 bin\n" + again + fixes, 10);
    EXPECT_TRUE(identical(restart.whole.gather(), restart.again.gather())) << kind;
  }
}

SERIAL_TEST(BadInput, IsRefused)
{
  const auto parts = blocks("jump of both");
  const std::string scene = plane("lj", "f f", "-4 20 -4 12", (int) parts.size(), 0.3) +
      fields(2, parts, "") + "fix m all mpm/material density 1 neohookean 100 0.3\n";
  const std::string run = "\nrun 0\n", c0 = "fix c0 all mpm/contact A0 B0 ",
                    c1 = "fix c1 all mpm/contact A1 B1 ";
  expect_refused(
      scene,
      {{c0 + run, "add fix mpm/contact"},
       {c1 + run, "add fix mpm/contact"},
       {c0 + "law stick\n" + c1 + run, "the same law"},
       {c0 + "gap no\n" + c1 + run, "the same law"},
       {c0 + "normal logistic\n" + c1 + "normal logistic" + run, "use colinear"},
       {c0 + "law adhesive 1 1 0.1\n" + c1 + "law adhesive 1 1 0.1" + run, "use another law"},
       {"fix c all mpm/contact A0 A1" + run, "leave one of them out"}});
  // without contact, all fields need points
  const auto empty = blocks("jump near the interface");
  expect_error(plane("lj", "f f", "-4 20 -4 12", (int) empty.size(), 0.3) + fields(2, empty, "") +
                   "fix m all mpm/material density 1 neohookean 100 0.3\nrun 0\n",
               "no material points");
  // a body on the fine lattice alone does not feel the coarse part; one on the coarse feels all
  const auto words = [&](const std::vector<Part> &some) {
    const std::string fixes = some[2].level == 1 ? c1 : c0;
    return lines_that_say(
        plane("lj", "f f", "-4 20 -4 12", (int) some.size(), 0.3) + fields(2, some, "") + fixes +
            "\nfix m all mpm/material density 1 neohookean 100 0.3\ntimestep 0.01\nrun 2\n",
        "WARNING");
  };
  const auto lines = words({{'A', 0, "0 6 0 4"}, {'A', 1, "0 6 4 8"}, {'B', 1, "6 12 5 8"}});
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], HasSubstr("does not see it where it meets points of A0"));
  EXPECT_EQ(words(blocks("a body of the coarse lattice")).size(), 0);
}
