// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// Declared options: reading, messages, refusals, comparison with a restart file, manual.

#include "declare/option_manual.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

#include <cstdlib>
#include <sstream>

using namespace MPM_NS;
using namespace MPM_NS::option;
using ::testing::HasSubstr;

enum Color { RED, GREEN, BLUE };

struct Paint {
  double size = 1.5, shares[3] = {0.1, 0.2, 0.3}, gloss = 0.5;
  int coats = 2, cells[2] = {4, 4};
  bool wet = true, sides[3] = {false, false, false};
  Color color = GREEN;
  std::string name;
  NumberOrVariable speed[2];
  std::vector<int> layers;
  int layer = 0;

  Options declare()
  {
    Options o("fix paint");
    o.argument(number(size, "size", {0.0, 2.0, false, true}));
    o.add("color",
          {word(color,
                {{"red", RED},
                 {"green", GREEN, "plain colors"},
                 {"blue",
                  BLUE,
                  "the sky",
                  {optional(number(gloss, "gloss", FRACTION, "1", "shine"))}}})})
        .keep();
    o.add("coats", {integer(coats, "N", POSITIVE, "number of coats")}).keep();
    o.add("shares", {axes(shares, 3, "a b c", POSITIVE)}, "of each pigment");
    o.add("cells",
          {one_or_axes(cells, 2, "n nx ny nz", {1, 9, true}, "", "cells", "cells along x, y, z")});
    o.add("wet", {yes_no(wet)});
    o.add("name", {text(name, "ID")}).once().standard("none");
    o.add("speed", {variables(speed, 2, "u v", "velocity", "of the brush", true)});
    o.add("layer", {integer(layer, "k", {0, 5, true})}).then([this] {
      layers.push_back(layer);
    });
    o.add("sides", {any_of(sides, {"top", "side", "back"})});
    o.refuse([=] {
      return OptionRules{{coats > 2 && wet, "coats", "{coats} would run: use wet no"},
                         {gloss == 0.0, "", "needs some gloss"}};
    });
    o.warn([=] {
      return OptionRules{{size > 1.9, "size", "is large"}};
    });
    return o;
  }

  /** Reads words; returns what is wrong with the number of the argument in front. */
  std::string read(const std::string &words, const std::string &last = "")
  {
    std::vector<std::string> list;
    std::istringstream stream(words);
    for (std::string w; stream >> w;) list.push_back(w);
    std::vector<const char *> arg;
    for (const auto &w : list) arg.push_back(w.c_str());
    const OptionInput input{(int) arg.size(), arg.data(),
                            [&](int i) {
                              return atof(arg[i]);
                            },
                            [&](int i) {
                              return (int64_t) atoll(arg[i]);
                            },
                            [&](int i) {
                              return list[i] == "yes";
                            }};
    try {
      end = declare().read(input, 0, last);
    } catch (const OptionError &e) {
      return (e.missing ? "missing: " : std::to_string(e.iarg) + ": ") + e.text;
    }
    return "";
  }
  int end = 0;
};

static std::string answer(const std::string &words)
{
  return Paint().read(words);
}

TEST(Option, AllKindsAreRead)
{
  Paint p;
  EXPECT_EQ(p.read("2 color blue 0.25 coats 7 shares 1 2 3 cells 5 wet no name x speed v_f NULL "
                   "layer 1 layer 3 sides back top material red",
                   "material"),
            "");
  EXPECT_EQ(p.end, 26);
  EXPECT_EQ(p.color, BLUE);
  EXPECT_EQ(p.gloss, 0.25);
  EXPECT_EQ(p.coats, 7);
  EXPECT_EQ(p.shares[2], 3.0);
  EXPECT_EQ(p.cells[1], 5);
  EXPECT_FALSE(p.wet);
  EXPECT_EQ(p.speed[0].variable, "f");
  EXPECT_FALSE(p.speed[1].given);
  EXPECT_EQ(p.layers, (std::vector<int>{1, 3}));
  EXPECT_TRUE(p.sides[0] && p.sides[2] && !p.sides[1]);
  EXPECT_EQ(p.declare().text(),
            "color blue 0.25 coats 7 shares 1 2 3 cells 5 5 wet no name x speed v_f NULL layer 3 "
            "sides top back");
  Paint q;    // the optional number is not there
  EXPECT_EQ(q.read("1 color blue cells 1 2"), "");
  EXPECT_EQ(q.gloss, 0.5);
  EXPECT_EQ(q.cells[1], 2);
}

TEST(Option, MistakesAreExplained)
{
  EXPECT_EQ(answer(""), "-1: Illegal fix paint command: missing argument(s), needs size");
  EXPECT_EQ(answer("color red"),
            "0: Fix paint size is missing: expected floating point parameter instead of 'color'");
  EXPECT_EQ(answer("2.1"), "0: Fix paint size must be above 0 and at most 2: 2.1");
  EXPECT_EQ(answer("1 colour red"), "1: Unknown fix paint keyword: colour");
  EXPECT_EQ(answer("1 speed 1 2 3"),
            "4: Unknown fix paint keyword: 3; the values of speed are u v");
  EXPECT_EQ(
      answer("1 color"),
      "-1: Illegal fix paint color command: missing argument(s), needs one of red green blue");
  EXPECT_EQ(answer("1 color pink"),
            "2: Unknown fix paint color pink: must be one of red green blue");
  EXPECT_EQ(answer("1 color blue 2"), "3: Fix paint color blue gloss must be within 0 and 1: 2");
  EXPECT_EQ(answer("1 coats 0"), "2: Fix paint coats must be positive: 0");
  EXPECT_EQ(answer("1 coats 3000000000"), "2: Fix paint coats is too large: 3000000000");
  EXPECT_EQ(answer("1 shares 1 0 1"), "3: Fix paint shares must be positive: 0");
  EXPECT_EQ(answer("1 shares 1 1 1e999"), "4: Fix paint shares must be positive: 1e999");
  EXPECT_EQ(answer("1 shares 1 1"),
            "-1: Illegal fix paint shares command: missing argument(s), needs a b c (in 2d: a b)");
  EXPECT_EQ(answer("1 cells 1 2 3"),
            "1: Fix paint cells expects 1 or 2 numbers in a 2d simulation, not 3");
  EXPECT_EQ(answer("1 cells 10"), "2: Fix paint cells must be within 1 and 9: 10");
  EXPECT_EQ(answer("1 name a name b"), "3: Fix paint name is given twice");
  EXPECT_EQ(answer("1 sides left"), "1: Fix paint sides needs one or more of top side back");
  EXPECT_EQ(answer("1 coats 3"), "1: Fix paint coats 3 would run: use wet no");
  EXPECT_EQ(answer("1 color blue 0"), "-1: Fix paint needs some gloss");
}

TEST(Option, RestartKeepsFirstWords)
{
  Paint then, now;
  then.read("1 color blue 0.5 coats 2");
  now.read("1 color blue 0.7 coats 2");
  EXPECT_EQ(now.declare().differences(then.declare().kept()), "");
  now.read("1 color red coats 1");
  EXPECT_EQ(now.declare().differences(then.declare().kept()),
            "color blue (now red), coats 2 (now 1)");
}

TEST(Option, ManualAndWarnings)
{
  Paint p;
  const std::string table = MPM_TEST::table(p.declare());
  EXPECT_THAT(table, HasSubstr("* keyword = *color* or *coats* or "));
  EXPECT_THAT(table,
              HasSubstr("       *color* value = *red* or *green* or *blue* [gloss]\n"
                        "         *red*, *green* = plain colors\n"
                        "         *blue* = the sky\n"
                        "           gloss = shine (unitless, 0 to 1)\n"));
  EXPECT_THAT(table, HasSubstr("*shares* values = a b c (in 2d: a b)\n         of each pigment\n"));
  EXPECT_THAT(table, HasSubstr("u,v = of the brush (velocity units)\n"));
  EXPECT_THAT(MPM_TEST::defaults(p.declare()), HasSubstr("*name* = none"));
  p.size = 2.0;
  EXPECT_EQ(p.declare().warnings(), (std::vector<std::string>{"Fix paint size is large"}));
}
