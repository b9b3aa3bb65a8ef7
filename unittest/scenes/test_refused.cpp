// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: input

// Combinations of styles and options that their pages say are refused, and that no test of a room
// has: docs/test_refusals.py compares all pages with the tests.

#include "bad_input_testing.h"

using namespace MPM_TEST;

const std::string START = plane("si", "f f", "0 1 0 1", 2, 0.01) + R"(
group one empty
group two empty
region a block 0.2 0.5 0.2 0.5 INF INF
region b block 0.5 0.8 0.2 0.5 INF INF
)",
                  RUN = "timestep 1e-6\nrun 1\n",
                  SOIL = "fix m all mpm/material density 2000 linear 1e6 0.3\n",
                  WATER = "fix m all mpm/material density 1000 eos tait 1e6 7\n",
                  AXIS = "fix axis all mpm/boundary xlo slip\n";

/** One body in region a. */
static std::string one(const std::string &options, const std::string &material = SOIL)
{
  return START + "fix F all mpm 0.05 " + options + "\ncreate_points 1 region a ppc 2\n" + material;
}

/** Two bodies in fields of their own. */
static std::string two(const std::string &first, const std::string &second,
                       const std::string &material = SOIL)
{
  return START + "fix F one mpm " + first + "\nfix G two mpm " + second +
      "\ncreate_points 1 region a ppc 2 fix F group one\n"
      "create_points 2 region b ppc 2 fix G group two\n" +
      material;
}

/** Soil and the water in its pores, both with these options. */
static std::string mixture(const std::string &options)
{
  return START + "fix F one mpm 0.05 " + options + "\nfix G two mpm 0.05 " + options + R"(
create_points 1 region a ppc 2 fix F group one
create_points 2 region a ppc 2 fix G group two share 0.4
fix m one mpm/material density 1600 linear 1e6 0.3
fix n two mpm/material density 1000 eos tait 1e6 7
fix mix all mpm/mixture F G 2650 1e-3 drag darcy 1e-6
)";
}

const std::string EMIT = "region in block 0.6 0.7 0.6 0.9 INF INF\n"
                         "fix in all mpm/emit 1 region in velocity 1 0 0\n",
                  PORE = "fix p all mpm/pore 2.2e9 1000 9810 soil m 0.4 constant 1e-4 ",
                  REFINE = "fix r all mpm/refine F G\n",
                  PENALTY = "pair_style mpm/penalty\npair_coeff * * 1e6\n";

/** A scene that is refused, and words of the message. */
struct Refusal {
  const char *name;
  std::string scene, words;
  friend void PrintTo(const Refusal &r, std::ostream *out) { *out << r.name; }
};

class Refused : public ::testing::TestWithParam<Refusal> {};

TEST_P(Refused, AsThePageSays)
{
  const auto &[name, scene, words] = GetParam();
  expect_error(scene + RUN, words);
}

INSTANTIATE_TEST_SUITE_P(
    All, Refused,
    Values(Refusal{"EmitPore", one("") + EMIT + PORE + "\n",
                   "mpm/emit in cannot be used with fix p (style mpm/pore)"},
           Refusal{"EmitImplicit", one("") + EMIT + "fix i all mpm/implicit static\n",
                   "mpm/emit in cannot be used with fix i (style mpm/implicit)"},
           Refusal{"ColumnImplicit",
                   one("") + "fix i all mpm/implicit static\nfix c all mpm/column F y\n",
                   "mpm/implicit"},
           Refusal{"HeatEdges",
                   one("edges modified transfer flip 0.99",
                       "fix m all mpm/material density 2000 linear 1e6 0.3 thermal conducting 500 "
                       "293 50\n") +
                       "fix h all mpm/heat\n",
                   "Fix mpm/heat h cannot be used with edges modified"},
           Refusal{"PoreAxis", one("axisymmetric yes") + AXIS + PORE + "\n", "axisymmetric"},
           Refusal{"PoreTransfer", one("transfer fmpm 2") + PORE + "formulation u-v-p\n",
                   "cannot be used with transfer xpic and fmpm"},
           Refusal{"MixtureAxis", mixture("axisymmetric yes") + AXIS, "axisymmetric"},
           Refusal{"MixtureLight", mixture("shape linear light 0.5"),
                   "Fix mpm/mixture mix cannot be used with"},
           Refusal{"RefineEdges",
                   two("0.05 edges modified transfer flip 1.0",
                       "0.025 edges modified transfer flip 1.0") +
                       REFINE,
                   "Fix mpm/refine r cannot be used with this transfer"},
           Refusal{"RefineSmooth", two("0.05 smooth 0.5", "0.025 smooth 0.5", WATER) + REFINE,
                   "Fix mpm/refine r cannot be used with smooth"},
           Refusal{"RefineLight",
                   two("0.05 shape linear light 0.5", "0.025 shape linear light 0.5") + REFINE,
                   "Fix mpm/refine r cannot be used with light"},
           Refusal{"PenaltyGroups",
                   two("0.05", "0.05") + PENALTY +
                       "compute g one group/group two\nthermo_style custom step c_g\n",
                   "does not support compute group/group"},
           Refusal{"PenaltyWrite",
                   two("0.05", "0.05") + PENALTY + "pair_write 1 2 10 r 0.1 1 none.table t\n",
                   "mpm/penalty does not support pair_write"},
           Refusal{"GridSort",
                   one("") + "dump d all mpm/grid/vtk 1 none.*.vtu F mass\ndump_modify d sort id\n",
                   "sorts nodes by index: remove dump_modify sort"}),
    [](const auto &info) {
      return std::string(info.param.name);
    });
