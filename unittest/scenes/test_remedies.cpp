// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: input
// timeout: 300

// What a message names to do works. Each scene gives an error or a warning; with the edit that this
// names, it runs without any message of the package.

#include "elements/thin_testing.h"
#include "mesh/stl_testing.h"
#include "meshgrid/mesh_grid_testing.h"

using namespace MPM_TEST;

namespace {

using Edit = std::vector<std::pair<std::string, std::string>>;

struct Remedy {
  const char *name;
  std::string scene, words;    ///< words of its error or warning
  Edit edit;                   ///< new text of these words; of none: more lines at the end
  friend void PrintTo(const Remedy &r, std::ostream *out) { *out << r.name; }
};

// ---------------------------------------------------------------------- scenes

const std::string START =
    plane("lj", "f f", "0 12 0 10", 4, 0.5) + "group one empty\ngroup two empty\n";
const std::string WEIGHT = "fix g all gravity 0.2 vector 0 -1 0\n", STEP = "timestep 0.005\n";
const std::string ELASTIC = "linear 100.0 0.3", WATER = "eos tait 100.0 7",
                  WARM = "linear 100.0 0.3 thermal conducting 1.0 300 0.5";

/** A body of type 1 in group one, of fix mpm A with these options. */
std::string body_one(const std::string &options, const std::string &law,
                     const std::string &density = "1.0")
{
  return "fix A one mpm 1.0" + options +
      "\nregion r1 block 2 8 0 3 INF INF\ncreate_points 1 region r1 ppc 2 fix A group one\n"
      "fix m one mpm/material density " +
      density + " " + law + "\n";
}
/** A body of type 2 in group two on top of it, of fix mpm B. */
std::string body_two(const std::string &options, const std::string &law,
                     const std::string &place = "3 6 3 5", const std::string &spacing = "1.0")
{
  return "fix B two mpm " + spacing + options + "\nregion r2 block " + place +
      " INF INF\ncreate_points 2 region r2 ppc 2 fix B group two\n"
      "fix n two mpm/material density 1.0 " +
      law + "\n";
}
const std::string FLOOR = "fix floor all mpm/boundary ylo slip\n";

std::string one(const std::string &options, const std::string &more = "",
                const std::string &law = ELASTIC)
{
  return START + body_one(options, law) + FLOOR + WEIGHT + STEP + more;
}
std::string two(const std::string &options, const std::string &more = "",
                const std::string &law = ELASTIC)
{
  return START + body_one(options, law) + body_two(options, law) + FLOOR + WEIGHT + STEP + more;
}
/** Coarse and fine points of one body. */
std::string refined(const std::string &options, const std::string &more = "",
                    const std::string &origin = " origin 0.25 0.25",
                    const std::string &spacing = "0.5", const std::string &law = ELASTIC)
{
  return START + body_one(options, law) + body_two(options + origin, law, "8 10 0 3", spacing) +
      FLOOR + WEIGHT + STEP + "fix r all mpm/refine A B\n" + more;
}
/** Soil and water in the same place. */
std::string mixture(const std::string &options, const std::string &more = "",
                    const std::string &drag = "0.01 drag darcy 0.01",
                    const std::string &share = "0.5")
{
  return START + body_one(options, ELASTIC, "1.25") + "fix B two mpm 1.0" +
      (options.find("transfer") == std::string::npos ? " transfer aflip 1.0" : "") + options +
      "\ncreate_points 2 region r1 ppc 2 fix B group two share " + share +
      "\nfix n two mpm/material density 1.0 " + WATER + "\n" + FLOOR + WEIGHT + STEP +
      "fix mix all mpm/mixture A B 2.5 " + drag + "\n" + more;
}
/** Points that no fix moves yet. */
std::string points(const std::string &group = "one", const std::string &place = "2 8 0 3")
{
  return replaced("region G block PLACE INF INF\ncreate_points 1 region G spacing 0.5 group G\n",
                  {{"G", group}, {"PLACE", place}});
}
std::string flow(const std::string &options, const std::string &more = "")
{
  return START + points() + more + "fix w one mpm/incompressible 1.0 1.0" + options + "\n" +
      WEIGHT + STEP;
}
const std::string SOIL = "fix p all mpm/pore 1000.0 0.5 1.0 soil m 0.4 constant 0.01 ",
                  CONTACT = "fix c all mpm/contact A B\n",
                  TOUCH = "fix c all mpm/contact A B law coulomb 0.3\n",
                  PENALTY = "pair_style mpm/penalty\npair_coeff * * 50.0\n",
                  STATIC = "fix s all mpm/implicit static\n",
                  EULER = "fix s all mpm/implicit euler\n",
                  LINE = "create_points 2 mesh LINE thickness 0.1 group two\n"
                         "fix n two mpm/material density 1.0 linear 100.0 0.3\n"
                         "fix e two mpm/elements LINE thickness 0.1\n",
                  NVE = "fix nve two nve\n";
/** Ground on a mesh. */
std::string meshed(const std::string &options, const std::string &more = "",
                   const std::string &law = ELASTIC)
{
  return START + points() + "fix M one mpm/mesh QUADS slip ylo " + options +
      "\nfix m one mpm/material density 1.0 " + law + "\n" + WEIGHT + STEP + more;
}

Edit add(const std::string &lines)
{
  return {{"", lines + "\n"}};
}

// ---------------------------------------------------------------------- messages and remedies

const Remedy contacts[] = {
    {"ContactScheme",
     two(" scheme usf", CONTACT),
     "use usl or musl",
     {{"scheme usf", "scheme usl"}}},
    {"ContactSchemeMusl",
     two(" scheme usavg", CONTACT),
     "use usl or musl",
     {{"scheme usavg", "scheme musl"}}},
    {"ContactTotal",
     two(" frame total", CONTACT),
     "let bodies meet through a pair style",
     {{CONTACT, PENALTY}}},
    {"ContactAdhesiveGap",
     two("", replaced(CONTACT, "A B", "A B law adhesive 1 1 0.1 gap no")),
     "drop gap no",
     {{" gap no", ""}}},
    {"ContactAdhesiveNormal",
     two("", replaced(CONTACT, "A B", "A B law adhesive 1 1 0.1 normal mass")),
     "use normal volume or colinear",
     {{"normal mass", "normal volume"}}},
    {"ContactAdhesiveReach",
     two("", replaced(CONTACT, "A B", "A B law adhesive 0.1 1 0.1")),
     "raise the strength or the node spacing",
     {{"adhesive 0.1 1", "adhesive 1 1"}}},
    {"ContactCohesiveGap",
     two("", replaced(CONTACT, "A B", "A B law cohesive 1 1 0.1 0.1 gap no")),
     "drop gap no",
     {{" gap no", " gap yes 0.75"}}},
    {"ContactCohesiveNothing",
     two("", replaced(CONTACT, "A B", "A B law cohesive 1 1 0.1 0.1")),
     "use a smaller share of gap yes",
     {{"0.1 0.1", "0.1 0.1 gap yes 0.75"}}},
    {"ContactCohesiveNormal",
     two("", replaced(CONTACT, "A B", "A B law cohesive 1 1 0.1 0.1 normal mass gap yes 0.75")),
     "use normal volume or colinear",
     {{"normal mass", "normal volume"}}},
    {"ContactCohesiveReach",
     two("", replaced(CONTACT, "A B", "A B law cohesive 0.1 1 0.1 0.1 gap yes 0.75")),
     "raise the strength or the node spacing",
     {{"cohesive 0.1 1", "cohesive 1 1"}}},
    {"ContactCohesiveScheme",
     two(" scheme musl", replaced(CONTACT, "A B", "A B law cohesive 1 1 0.1 0.1 gap yes 0.75")),
     "needs scheme usl",
     {{"scheme musl", "scheme usl"}}},
    {"ContactCohesiveStiffness",
     two("", replaced(CONTACT, "A B", "A B law cohesive 1 1 0.1 0.1 stiffness 1 gap yes 0.75")),
     "use one above strength^2",
     {{"stiffness 1 ", "stiffness 100 "}}},
    {"ContactCohesiveOnly",
     two("", replaced(CONTACT, "A B", "A B mixing 2")),
     "belongs to law cohesive: drop it",
     {{" mixing 2", ""}}},
    {"ContactHeatLaw",
     two("", replaced(CONTACT, "A B", "A B heat yes") + "fix h all mpm/heat\n", WARM),
     "use law coulomb or adhesive",
     {{"A B heat", "A B law coulomb 0.3 heat"}}},
    {"ContactHeatNobody",
     two("", replaced(TOUCH, "0.3", "0.3 heat yes")),
     "define a fix mpm/heat, or drop the keyword",
     {{" heat yes", ""}}},
    {"ContactHeatMusl",
     two(" scheme musl", replaced(TOUCH, "0.3", "0.3 heat yes") + "fix h all mpm/heat\n", WARM),
     "use scheme usl",
     {{"scheme musl", "scheme usl"}}},
    {"ContactHeatLost",
     two("", TOUCH + "fix h all mpm/heat\n", WARM),
     "give it heat yes, or heat no",
     {{"coulomb 0.3", "coulomb 0.3 heat yes"}}},
    {"ContactImplicit", two("", EULER), "name all of them in one fix mpm/contact", add(CONTACT)},
    {"ContactImplicitShare",
     two("", EULER),
     "let bodies share a fix mpm",
     {{"fix B two mpm 1.0\n", ""},
      {"fix A one", "fix A all"},
      {"fix B group two", "fix A group two"}}},
    {"ContactImplicitHht",
     two("", CONTACT + "fix s all mpm/implicit hht\n"),
     "use newmark or midpoint",
     {{"implicit hht", "implicit midpoint"}, {"mpm 1.0", "mpm 1.0 transfer flip 1.0"}}},
    {"ContactImplicitMultigrid",
     two("", CONTACT + "fix s all mpm/implicit euler solver multigrid\n"),
     "use solver blocks",
     {{"solver multigrid", "solver blocks"}}},
    {"ContactImplicitWall",
     replaced(two("", CONTACT + EULER), "ylo slip", "ylo separate"),
     "use stick or slip at faces",
     {{"ylo separate", "ylo slip"}}},
    {"FieldsMeet", two(""), "use fix mpm/contact with A and B", add(CONTACT)},
    {"FieldsMeetAsOne",
     two(""),
     "or one fix mpm for both",
     {{"fix B two mpm 1.0\n", ""},
      {"fix A one", "fix A all"},
      {"fix B group two", "fix A group two"}}},
    {"FieldsMeetTotal", two(" frame total"), "use pair_style mpm/penalty", add(PENALTY)},
    {"FieldsMeetRefine", replaced(refined(""), "fix r all mpm/refine A B\n", ""),
     "or fix mpm/refine with A and B", add("fix r all mpm/refine A B")},
    {"PenaltyOneField",
     one("", PENALTY),
     "give each body a fix mpm",
     {{STEP, body_two("", ELASTIC) + STEP}}},
    {"PenaltyVelocities", two("", replaced(PENALTY, "50.0", "50.0 friction 0.3 0.01")),
     "use comm_modify vel yes", add("comm_modify vel yes")},
    {"PenaltyHeatLost",
     two("",
         "comm_modify vel yes\nfix h all mpm/heat\n" +
             replaced(PENALTY, "50.0", "50.0 friction 0.3 0.01"),
         WARM),
     "give that penalty yes, or penalty no",
     {{"mpm/heat", "mpm/heat penalty yes"}}},
    {"PenaltyTypes",
     two("", "pair_style mpm/penalty\npair_coeff 1 1 0.0\npair_coeff 2*4 2*4 0.0\n"),
     "give one, with modulus 0 if they shall not touch", add("pair_coeff 1 2 50.0")},
};

const Remedy walls[] = {
    {"WallBeginsInside",
     one("",
         "region low block INF INF INF 1.5 INF INF\nfix w all mpm/boundary region low separate\n"),
     "create points outside of it only",
     {{"region r1 block 2 8 0 3 INF INF\n",
       "region r0 block 2 8 0 3 INF INF\nregion above block INF INF INF 1.5 INF INF side out\n"
       "region r1 intersect 2 r0 above\n"}}},
    {"WallBeginsInsideHeld",
     one("",
         "region low block INF INF INF 1.5 INF INF\nfix w all mpm/boundary region low separate\n"),
     "use stick to hold them",
     {{"low separate", "low stick"}}},
    {"GasInVacuum", one("", "", "eos ideal/gas 1.4 pressure 10.0"), "with free pressure",
     add("fix air all mpm/traction free pressure 10.0")},
    {"WallTotalMoves",
     one(" frame total",
         "variable d equal -0.05*step*dt\nregion w block INF INF 3 4 INF INF move NULL v_d NULL\n"
         "fix w all mpm/boundary region w stick\n"),
     "use stick velocity with variables",
     {{" move NULL v_d NULL", ""}, {"region w stick", "region w stick velocity 0 -0.05 0"}}},
    {"WallTotalMovesBy",
     one(" frame total",
         "variable d equal -0.05*step*dt\nregion w block INF INF 3 4 INF INF move NULL v_d NULL\n"
         "fix w all mpm/boundary region w stick\n"),
     "displacement, or rotate",
     {{" move NULL v_d NULL", ""}, {"region w stick", "region w stick displacement 0 v_d 0"}}},
    {"WallTotalSeparate",
     replaced(one(" frame total"),
              {{"ylo slip", "ylo separate"}, {"atom_style mpm", "atom_style hybrid sphere mpm"}}),
     "use fix wall/gran or a pair style",
     {{"fix floor all mpm/boundary ylo separate\n",
       "fix skin all mpm/surface\nfix floor all wall/gran hooke 50.0 NULL 1.0 NULL 0.3 1 yplane "
       "0.0 NULL\n"}}},
    {"WallTotalTurns",
     one(" frame total",
         "region w sphere 5 3 0 0.9\nfix w all mpm/boundary region w slip rotate 5 3 0 0 0 1 "
         "0.1\n"),
     "use stick",
     {{"region w slip", "region w stick"}}},
    {"WallFriction",
     replaced(one(" scheme usf"), "ylo slip", "ylo separate friction 0.3"),
     "use usl or musl",
     {{"scheme usf", "scheme musl"}}},
    {"WallReference",
     one(" frame total reference update 1.2",
         "fix w all mpm/boundary yhi stick velocity 0 0.1 0\n"),
     "use reference fixed",
     {{"reference update 1.2", "reference fixed"}}},
    {"WallTwice", one("", "fix w all mpm/boundary ylo stick\n"), "remove one", {{FLOOR, ""}}},
    {"WallTwiceFields",
     two("", CONTACT + "fix w all mpm/boundary ylo stick field B\n"),
     "or give them different fields",
     {{"ylo slip", "ylo slip field A"}}},
    {"WallPeriodic",
     replaced(one(""), "boundary f f p", "boundary f p p"),
     "use boundary f there",
     {{"boundary f p p", "boundary f f p"}}},
    {"WallNear",
     replaced(one("", "fix w all mpm/boundary xhi slip\nfix v all mpm/boundary xlo slip\n"),
              {{"0 12 0 10", "2 4 0 10"}, {"2 8 0 3", "2 4 0 3"}}),
     "they must be in the same fix mpm/boundary",
     {{"fix v all mpm/boundary xlo slip\n", ""}, {"boundary xhi slip", "boundary xlo xhi slip"}}},
    {"WallGap",
     one("",
         "variable d equal -0.0075*step\nregion w block INF INF 3.5 6 INF INF move NULL v_d NULL "
         "units box\nfix w all mpm/boundary region w slip\n" +
             EULER),
     "Use separate",
     {{"region w slip", "region w separate"}}},
    {"WallGapStart",
     one("",
         "variable d equal -0.0075*step\nregion w block INF INF 3.5 6 INF INF move NULL v_d NULL "
         "units box\nfix w all mpm/boundary region w slip\n" +
             EULER),
     "start with the region at the surface",
     {{"3.5 6", "3.0 6"}}},
    {"WallUnionMoves",
     one("",
         "variable d equal -0.1*step*dt\nregion u block 1 4 3 6 INF INF move NULL v_d NULL\n"
         "region v block 6 9 3 6 INF INF move NULL v_d NULL\n"
         "region w union 2 u v\nfix w all mpm/boundary region w separate\n"),
     "use one fix mpm/boundary for each member",
     {{"region w union 2 u v\n", ""},
      {"fix w all mpm/boundary region w separate\n",
       "fix u all mpm/boundary region u separate\nfix v all mpm/boundary region v separate\n"}}},
    {"WallThin",
     one("",
         "region w block INF INF 2.5 3.2 INF INF side in\nfix w all mpm/boundary region w slip\n"),
     "Make it thicker there",
     {{"2.5 3.2", "3.0 6"}}},
    {"WallEdges",
     one(" edges modified transfer flip 0.99 origin 0.5 0.5"),
     "change spacing or origin",
     {{" origin 0.5 0.5", ""}}},
    {"WallImage",
     replaced(one("", "region w block 10 14 0 6 INF INF\nfix w all mpm/boundary region w slip\n"),
              "boundary f f p", "boundary p f p"),
     "use a union of it and a region that is shifted by -12 along x",
     {{"region w block 10 14 0 6 INF INF",
       "region u block 10 14 0 6 INF INF\nregion v block -2 2 0 6 INF INF\nregion w union 2 u v"}}},
    {"WallFieldsLeft", replaced(one("", "velocity one set 0 -30 0\n"), FLOOR, ""),
     "put a fix mpm/boundary there", add(FLOOR)},
};

const Remedy heats[] = {
    {"HeatNothingConducts",
     one("", "fix h all mpm/heat\n"),
     "'thermal conducting'",
     {{ELASTIC, WARM}}},
    {"HeatUnused", one("", "", WARM), "there is no fix mpm/heat", add("fix h all mpm/heat")},
    {"HeatUnusedAdiabatic",
     one("", "", WARM),
     "or use thermal adiabatic",
     {{"thermal conducting 1.0 300 0.5", "thermal adiabatic 1.0 300"}}},
    {"HeatPeriodic",
     replaced(one("", "fix h all mpm/heat xlo temperature 350\n", WARM), "boundary f f",
              "boundary p f"),
     "use boundary f there",
     {{"boundary p f", "boundary f f"}, {"region r1 block 2", "region r1 block 0"}}},
    {"HeatStep",
     one("", "fix h all mpm/heat stages 1\n", replaced(WARM, "0.5", "200.0")),
     "use timestep, fix mpm/dt",
     {{STEP, "fix step all mpm/dt 0.5\n"}}},
    {"HeatStepImplicit",
     one("", "fix h all mpm/heat stages 1\n", replaced(WARM, "0.5", "200.0")),
     "or its keyword time sdirk2",
     {{"stages 1", "time sdirk2"}}},
    {"HeatStepStages",
     one("", "fix h all mpm/heat stages 1\n", replaced(WARM, "0.5", "200.0")),
     "more of its stages",
     {{"stages 1", "stages 10"}}},
    {"PoreStep",
     one("", replaced(SOIL, "0.01", "1.0") + "stages 1\n"),
     "or more of its stages",
     {{"stages 1", "stages 40"}}},
    {"HeatStages",
     one("", "fix h all mpm/heat stages 8 time euler\n", WARM),
     "remove it, or use time explicit",
     {{"stages 8 ", ""}}},
    {"HeatTolerance",
     one("", "fix h all mpm/heat tolerance 1e-8\n", WARM),
     "use time euler or sdirk2",
     {{"tolerance 1e-8", "tolerance 1e-8 time euler"}}},
    {"HeatKelvin",
     one("", "fix h all mpm/heat surface radiation 0.9 300\n", WARM),
     "use units si",
     {{"units lj", "units si"}}},
    {"HeatTotalContact",
     replaced(
         two(" frame total", "fix h all mpm/heat contact A B conductance 1.0\n" + PENALTY, WARM),
         {{"2 8 0 3", "2 8 0 4"}, {"3 6 3 5", "2 8 4 8"}}),
     "use frame updated",
     {{" frame total", ""}, {PENALTY, CONTACT}}},
    {"HeatContact",
     replaced(two("", "fix h all mpm/heat contact A B conductance 1.0\n", WARM),
              {{"2 8 0 3", "2 8 0 4"}, {"3 6 3 5", "2 8 4 8"}}),
     "define a fix mpm/contact A B", add(CONTACT)},
    {"HeatRefine",
     refined("", "fix h all mpm/heat surface convection 0.5 280\n", " origin 0.25 0.25", "0.5",
             WARM),
     "use conditions on faces of the box",
     {{"surface convection", "ylo convection"}}},
    {"HeatRefineTransfer",
     refined("", "fix h all mpm/heat transfer xpic 2\n", " origin 0.25 0.25", "0.5", WARM),
     "use relax, affine, or pic",
     {{"xpic 2", "affine"}}},
    {"HeatEdges",
     one(" edges modified transfer flip 0.99", "fix h all mpm/heat\n", WARM),
     "use edges plain",
     {{"edges modified", "edges plain"}}},
    {"HeatOfTransfers",
     one(" heat yes scheme usf", "", WARM),
     "needs scheme usl or musl",
     {{"scheme usf", "scheme usl"}, {"", "fix h all mpm/heat\n"}}},
};

const Remedy pores[] = {
    {"PoreWeight",
     one("", replaced(SOIL, "0.5 1.0 soil", "0.5 0.2 soil") + "\n"),
     "density times gravity",
     {{"0.5 0.2 soil", "0.5 0.1 soil"}}},
    {"PoreFreeFlow",
     one("", replaced(SOIL, "constant 0.01", "constant 100.0") + "\n"),
     "is the coefficient a hydraulic conductivity",
     {{"constant 100.0", "constant 0.01"}}},
    {"PoreShape",
     one(" shape gimp", SOIL + "\n"),
     "use shape quadratic or cubic",
     {{"shape gimp", "shape cubic"}}},
    {"PoreScheme",
     one(" scheme musl", SOIL + "\n"),
     "use scheme usl",
     {{"scheme musl", "scheme usl"}}},
    {"PoreTotal",
     one(" frame total", SOIL + "\n"),
     "use frame updated",
     {{"frame total", "frame updated"}}},
    {"PoreLocking",
     one(" locking pressure", SOIL + "\n"),
     "use locking none",
     {{"locking pressure", "locking none"}}},
    {"PoreTransfer",
     one(" transfer xpic 2", SOIL + "formulation u-v-p\n"),
     "use apic, aflip, or flip",
     {{"xpic 2", "aflip 0.99"}}},
    {"PoreStages",
     one("", SOIL + "formulation u-v-p stages 4\n"),
     "with u-v-p waves alone limit the time step",
     {{" stages 4", ""}}},
    {"PoreImplicitForm",
     one("", SOIL + "formulation u-v-p\n" + EULER),
     "use formulation u-p",
     {{"u-v-p", "u-p"}}},
    {"PoreImplicitRelax", one("", SOIL + "relax 0.5\n" + EULER), "remove it", {{"relax 0.5", ""}}},
    {"PoreImplicitMethod",
     one(" transfer flip 1.0", SOIL + "\n" + replaced(EULER, "euler", "newmark")),
     "use static or euler",
     {{"implicit newmark", "implicit euler"}}},
    {"PoreImplicitStabilize",
     one("", SOIL + "\n" + replaced(EULER, "euler", "euler stabilize 1")),
     "remove it",
     {{" stabilize 1", ""}}},
    {"PoreRelax",
     one("", SOIL + "formulation u-v-p\nfix rest all mpm/relax 1e-6 stop no\n"),
     "use formulation u-p",
     {{"u-v-p", "u-p"}}},
    {"PoreGeostatic",
     replaced(one("", SOIL + "\nmpm_geostatic A 0.5\n"), "boundary ylo", "boundary xlo xhi ylo"),
     "use keyword geostatic of fix mpm/pore",
     {{"\nmpm_geostatic A 0.5", " geostatic 0.5 0.0"}}},
    {"PoreEmit",
     one("",
         SOIL +
             "\nregion in block 9 11 6 8 INF INF\nfix in one mpm/emit 1 region in velocity 5 0 "
             "0\n"),
     "cannot be used with fix p",
     {{"fix in one mpm/emit 1 region in velocity 5 0 0\n", ""}}},
    {"GeostaticLocking",
     replaced(one(" locking fbar", "mpm_geostatic A 0.5\n"), "boundary ylo",
              "boundary xlo xhi ylo"),
     "use locking none",
     {{" locking fbar", ""}, {"block 2 8", "block 0 12"}}},
    {"GeostaticLaw",
     replaced(one("", "mpm_geostatic A 0.5\n", "neohookean 100 0.3"),
              {{"boundary ylo", "boundary xlo xhi ylo"}, {"block 2 8", "block 0 12"}}),
     "linear or a law for soils",
     {{"neohookean", "linear"}}},
    {"MixtureShape",
     mixture(" shape gimp"),
     "use shape quadratic or cubic",
     {{"shape gimp", "shape cubic"}}},
    {"MixtureScheme",
     mixture(" scheme usavg"),
     "use usl or musl",
     {{"scheme usavg", "scheme musl"}}},
    {"MixtureTransfer",
     mixture(" transfer fmpm 2"),
     "use apic, aflip, or flip",
     {{"transfer fmpm 2", "transfer aflip 1.0"}}},
    {"MixtureSlow",
     mixture(" transfer apic"),
     "give the water transfer aflip 1.0",
     {{"two mpm 1.0 transfer apic", "two mpm 1.0 transfer aflip 1.0"}}},
    {"MixtureLocking",
     mixture(" locking both"),
     "use smooth",
     {{"fix A one mpm 1.0 locking both", "fix A one mpm 1.0"}, {" locking both", " smooth 0.4"}}},
    {"MixtureWater",
     replaced(mixture(""), WATER, "linear 100 0.3"),
     "use eos tait or linear",
     {{"density 1.0 linear 100 0.3", "density 1.0 eos linear 100"}}},
    {"MixtureDrag",
     mixture("", "", "0 drag darcy 0.01"),
     "use drag none without",
     {{"drag darcy 0.01", "drag none"}}},
    {"MixtureShare",
     mixture("", "", "0.01 drag darcy 0.01", "0.9"),
     "the share 0.5 in create_points",
     {{"share 0.9", "share 0.5"}}},
    {"MixtureOverlap",
     replaced(mixture(""), " share 0.5", ""),
     "and the water with keyword share",
     {{"ppc 2 fix B group two", "ppc 2 fix B group two share 0.5"}}},
    {"MixtureContact",
     mixture("", CONTACT),
     "leave one of these fields out there",
     {{CONTACT, ""}}},
    {"MixturePore",
     mixture("", SOIL + "\n"),
     "or drop fix mpm/mixture",
     {{"fix mix all mpm/mixture A B 2.5 0.01 drag darcy 0.01\n", ""},
      {"fix B two mpm 1.0 transfer aflip 1.0\n", ""},
      {"create_points 2 region r1 ppc 2 fix B group two share 0.5\n", ""},
      {"fix n two mpm/material density 1.0 " + WATER + "\n", ""}}},
};

const Remedy flows[] = {
    {"FlowRegionViscosity",
     flow(" viscosity 0.1 region rock", "region rock sphere 10 1 0 1.6\n"),
     "use the keyword stick",
     {{"region rock\n", "stick rock implicit yes\n"}}},
    {"FlowRegionNoViscosity",
     flow(" viscosity 0.1 region rock", "region rock sphere 10 1 0 1.6\n"),
     "or leave viscosity out",
     {{" viscosity 0.1", ""}}},
    {"FlowStick",
     flow(" stick rock", "region rock sphere 10 1 0 1.6\n"),
     "add the keywords viscosity and implicit yes",
     {{"stick rock", "stick rock viscosity 0.1 implicit yes"}}},
    {"FlowStickRegion",
     flow(" stick rock", "region rock sphere 10 1 0 1.6\n"),
     "or use the keyword region instead",
     {{"stick rock", "region rock"}}},
    {"FlowTensionRegion",
     flow(" tension 0.1 region rock", "region rock sphere 10 1 0 1.6\n"),
     "use the keyword stick with implicit viscosity",
     {{"tension 0.1 region rock", "tension 0.1 stick rock viscosity 0.1 implicit yes"}}},
    {"FlowTensionWalls",
     flow(" tension 0.1 region rock", "region rock sphere 10 1 0 1.6\n"),
     "or walls of the box",
     {{" region rock\n", "\n"}}},
    {"FlowTensionLiquid",
     flow(" tension 0.1 liquid two 0.8", points("two", "2 8 3 4")),
     "leave one of them out",
     {{" tension 0.1", ""}, {"fix w one", "fix w all"}}},
    {"FlowSolidImplicit",
     flow(" viscosity 3.0 implicit yes solid two",
          points("two", "2 8 3 4") + "fix m two mpm/material density 1.0 neohookean 100.0 0.3\n"),
     "use explicit viscosity",
     {{" implicit yes", ""}, {"fix w one", "fix w all"}}},
    {"FlowSolidNothing",
     replaced(flow(" viscosity 3.0 solid two", points("two", "2 8 3 4")), "fix w one", "fix w all"),
     "give them a fix mpm/material",
     {{"fix w all", "fix m two mpm/material density 1.0 neohookean 100.0 0.3\nfix w all"}}},
    {"FlowSolidLaw",
     replaced(
         flow(" viscosity 3.0 solid two",
              points("two", "2 8 3 4") + "fix m two mpm/material density 1.0 linear 100.0 0.3\n"),
         "fix w one", "fix w all"),
     "use one such as neohookean",
     {{"linear 100.0", "neohookean 100.0"}}},
    {"FlowGasRegion",
     flow(" gas 1.0 1.4 implicit yes viscosity 0.1"),
     "use explicit viscosity, or leave gas out",
     {{" implicit yes", ""}}},
    {"FlowGasOpen",
     flow(" open yhi"),
     "add the keyword gas",
     {{"open yhi", "open yhi gas 1.0 1.4"}}},
    {"FlowAngle",
     flow(" angle 60"),
     "add the keyword tension",
     {{"angle 60", "angle 60 tension 0.1"}}},
    {"FlowSpacing",
     replaced(flow(""), "incompressible 1.0", "incompressible 1.3"),
     "the nearest valid spacing is",
     {{"incompressible 1.3", "incompressible 1.3333333333333333"}, {"0 10", "0 12"}}},
    {"FlowWallPeriodic",
     replaced(flow(" wall xlo stick viscosity 0.1"), "boundary f f", "boundary p f"),
     "use boundary f for a wall",
     {{"boundary p f", "boundary f f"}}},
    {"FlowStep",
     replaced(flow(""), STEP, "timestep 2.0\nvelocity all set 0 -3 0\n"),
     "reduce it, or let fix mpm/dt set it",
     {{"timestep 2.0", "fix step all mpm/dt 0.4"}}},
    {"FlowLarge",
     replaced(flow(""), "spacing 0.5", "spacing 2.0"),
     "use points with a spacing of at most",
     {{"spacing 2.0", "spacing 0.5"}}},
    {"FlowViscousStep",
     flow(" viscosity 500.0"),
     "is too large for the viscosity",
     {{STEP, "fix step all mpm/dt 0.4\n"}}},
    {"FlowTwo",
     flow("", points("two", "2 8 3 4") + "fix v two mpm/incompressible 1.0 0.8\n"),
     "give their points to one of these fixes",
     {{"fix v two mpm/incompressible 1.0 0.8\n", ""},
      {"fix w one mpm/incompressible 1.0 1.0",
       "fix w all mpm/incompressible 1.0 1.0 liquid two 0.8"}}},
    {"FlowAndField",
     replaced(flow("",
                   "fix B two mpm 1.0\n" + points("two", "2 8 3 4") +
                       "fix m two mpm/material density 1.0 neohookean 100.0 0.3\n"),
              STEP, STEP),
     "and to its keyword solid",
     {{"fix B two mpm 1.0\n", ""},
      {"fix w one mpm/incompressible 1.0 1.0",
       "fix w all mpm/incompressible 1.0 1.0 viscosity 3.0 solid two"}}},
    {"FlowAndFieldTait",
     replaced(flow("",
                   "fix B two mpm 1.0\n" + points("two", "2 8 3 4") +
                       "fix m two mpm/material density 1.0 neohookean 100.0 0.3\n"),
              STEP, STEP),
     "and fix mpm/contact",
     {{"fix w one mpm/incompressible 1.0 1.0",
       "fix A one mpm 1.0 smooth 0.4\nfix n one mpm/material density 1.0 eos tait 100.0 7\nfix c "
       "all mpm/contact A B"}}},
    {"FlowWall",
     flow("", "fix floor all mpm/boundary ylo slip\n"),
     "or remove fix floor",
     {{FLOOR, ""}}},
    {"FlowBodyWeight",
     flow(" region ball",
          "region ball sphere 10 1 0 0.9\nfix b all mpm/rigid ball density 2.0 slip\n"),
     "use its keyword gravity",
     {{"density 2.0 slip", "density 2.0 slip gravity 0 -0.2 0"}}},
    {"FlowBodyFriction",
     flow(" region ball",
          "region ball sphere 10 1 0 0.9\nfix b all mpm/rigid ball density 2.0 separate gravity 0 "
          "0 0\n"),
     "use slip",
     {{"density 2.0 separate", "density 2.0 slip"}}},
};

const Remedy implicits[] = {
    {"ImplicitDt",
     replaced(one("", EULER), STEP, "fix step all mpm/dt 0.5\n"),
     "remove it, and use timestep",
     {{"fix step all mpm/dt 0.5\n", STEP}}},
    {"ImplicitFlip",
     replaced(one(" transfer flip 0.99", STATIC), "ylo slip", "ylo stick"),
     "use transfer pic",
     {{"flip 0.99", "pic"}}},
    {"ImplicitXpic",
     one(" transfer xpic 2", EULER),
     "use transfer apic or flip",
     {{"xpic 2", "flip 0.99"}}},
    {"ImplicitScheme",
     one(" scheme musl", EULER),
     "use scheme usl",
     {{"scheme musl", "scheme usl"}}},
    {"ImplicitLocking",
     one(" locking fbar", EULER, "neohookean 100.0 0.495"),
     "use locking pressure",
     {{"locking fbar", "locking pressure"}}},
    {"ImplicitMidpoint",
     one(" transfer aflip 0.9", replaced(EULER, "euler", "midpoint")),
     "use transfer flip 1.0",
     {{"transfer aflip 0.9", "transfer flip 1.0"}}},
    {"ImplicitMidpointMls",
     one(" transfer aflip 0.9", replaced(EULER, "euler", "midpoint")),
     "transfer apic with shape quadratic",
     {{"transfer aflip 0.9", "transfer apic shape quadratic stress mls"}}},
    {"ImplicitEvery", one(" every 2", EULER), "use every 1", {{"every 2", "every 1"}}},
    {"ImplicitLight",
     one(" shape linear light 0.5", EULER),
     "remove it",
     {{"shape linear light 0.5", ""}}},
    {"ImplicitLinear",
     one(" shape linear", EULER),
     "use shape quadratic",
     {{"shape linear", "shape quadratic"}}},
    {"ImplicitLinearTotal",
     one(" shape linear", EULER),
     "or frame total",
     {{"shape linear", "shape linear frame total"}}},
    {"ImplicitSmooth",
     one(" smooth 0.4", EULER, WATER),
     "it is for fluids in explicit steps",
     {{" smooth 0.4", ""}}},
    {"ImplicitSlip",
     one("", replaced(EULER, "euler", "euler slip 0.1")),
     "and there are none: remove it",
     {{" slip 0.1", ""}}},
    {"ImplicitFree", replaced(one("", STATIC), FLOOR, ""), "hold bodies that can move freely",
     add("fix floor all mpm/boundary ylo stick")},
    {"ImplicitPml",
     one("", EULER + "fix layer all mpm/pml ylo 2\n"),
     "remove one of them",
     {{"fix layer all mpm/pml ylo 2\n", ""}}},
    {"ImplicitGamma",
     one("", replaced(EULER, "euler", "euler gamma 0.6")),
     "use newmark, or remove it",
     {{" gamma 0.6", ""}}},
    {"DeformFrame",
     replaced(
         one("", "fix cell all mpm/deform x erate 0.05\n"),
         {{"boundary f f", "boundary p p"}, {FLOOR, ""}, {WEIGHT, ""}, {"2 8 0 3", "0 12 0 10"}}),
     "use frame total",
     {{"mpm 1.0", "mpm 1.0 frame total"}}},
};

const Remedy meshes[] = {
    {"MeshPeriodic",
     replaced(meshed("frame total"), "boundary f f", "boundary f p"),
     "use boundary f, s, or m along y",
     {{"boundary f p", "boundary f f"}}},
    {"MeshAndField",
     meshed("frame total", body_two("", ELASTIC)),
     "give all bodies meshes, or all of them lattices",
     {{"fix M one mpm/mesh QUADS slip ylo frame total", "fix M one mpm 1.0"},
      {STEP, FLOOR + STEP + "fix c all mpm/contact M B\n"}}},
    {"MeshHeat",
     meshed("frame total", "fix h all mpm/heat\n", WARM),
     "use fix mpm/mesh/heat",
     {{"mpm/heat\n", "mpm/mesh/heat M\n"}}},
    {"MeshTraction",
     meshed("frame total",
            "region lid plane 0 3 0 0 -1 0\nfix t one mpm/traction region lid pressure 0.5\n"),
     "use its keywords pressure and traction",
     {{"fix t one mpm/traction region lid pressure 0.5\n", ""},
      {"frame total", "frame total pressure yhi 0.5"}}},
    {"MeshGain",
     meshed("transfer apic"),
     "use transfer flip",
     {{"transfer apic", "transfer flip 1.0"}}},
    {"MeshGainTotal",
     meshed("transfer apic"),
     "or frame total",
     {{"transfer apic", "transfer apic frame total"}}},
    {"MeshHeatFrame",
     meshed("", "fix h all mpm/mesh/heat M\n", WARM),
     "use frame total",
     {{"slip ylo ", "slip ylo frame total "}}},
    {"MeshLocking",
     replaced(meshed("frame total", "", "linear 100.0 0.495"), "spacing 0.5", "spacing 0.25"),
     "use locking fbar",
     {{"frame total", "frame total locking fbar"}}},
    {"MeshLockingPoints",
     replaced(meshed("frame total", "", "linear 100.0 0.495"), "spacing 0.5", "spacing 0.25"),
     "or quadrangles or hexahedra with one point each",
     {{"spacing 0.25", "spacing 0.5"}}},
    {"MeshConducts", meshed("frame total", "", WARM), "there is no fix mpm/mesh/heat",
     add("fix h all mpm/mesh/heat M")},
    {"MeshStep",
     replaced(meshed("frame total"), STEP, "timestep 0.5\n"),
     "use timestep, fix mpm/dt",
     {{"timestep 0.5", "fix step all mpm/dt 0.5"}}},
    {"MeshAndFlow",
     meshed("frame total", points("two", "3 6 3 5") + "fix w two mpm/incompressible 1.0 1.0\n"),
     "and to its keyword solid",
     {{"fix M one mpm/mesh QUADS slip ylo frame total\n", ""},
      {"linear 100.0", "neohookean 100.0"},
      {"fix w two mpm/incompressible 1.0 1.0",
       "fix w all mpm/incompressible 1.0 1.0 viscosity 3.0 solid one"}}},
};

const Remedy elements[] = {
    {"ElementsField",
     one("", LINE + NVE),
     "use a fix mpm on the same lattice for the nodes of e in place of the fix that moves them",
     {{NVE, "fix B two mpm 1.0\nfix c all mpm/contact A B gap no normal volume\n"}}},
    {"ElementsContact",
     one("", "fix B two mpm 1.0\n" + LINE + CONTACT),
     "use gap no normal volume",
     {{"contact A B", "contact A B gap no normal volume"}}},
    {"ElementsLocking",
     START + replaced(body_one(" locking fbar", ELASTIC), "fix A one", "fix A all") + FLOOR + STEP +
         LINE,
     "use fix mpm/elements e locking fbar",
     {{" locking fbar", ""}}},
    {"ElementsLockingSolid",
     START +
         "fix A one mpm 1.0 locking fbar\ncreate_points 1 mesh CELLS move 3 0 group one\nfix m one "
         "mpm/material density 1.0 linear 100.0 0.3\n"
         "fix e one mpm/elements CELLS\n" +
         FLOOR + WEIGHT + STEP,
     "use fix mpm/elements e locking fbar",
     {{" locking fbar", ""}, {"mpm/elements CELLS", "mpm/elements CELLS locking fbar"}}},
    {"ElementsEvery",
     START +
         "fix A one mpm 1.0 every 2\ncreate_points 1 mesh CELLS move 3 0 group one\nfix m one "
         "mpm/material density 1.0 linear 100.0 0.3\n"
         "fix e one mpm/elements CELLS\n" +
         FLOOR + WEIGHT + STEP,
     "use every 1",
     {{"every 2", "every 1"}}},
    {"ElementsDelete",
     START + body_one(" bad delete", ELASTIC) + FLOOR + STEP +
         replaced(LINE, "group two\n", "group two\ngroup one union one two\n"),
     "give them a fix mpm of their own",
     {{"group one union one two\n",
       "fix B two mpm 1.0\nfix c all mpm/contact A B gap no normal volume\n"}}},
    {"ElementsMaterial",
     START + replaced(LINE, "fix n two mpm/material density 1.0 linear 100.0 0.3\n", "") + NVE +
         STEP,
     "define a fix mpm/material for them before",
     {{"fix e two", "fix n two mpm/material density 1.0 linear 100.0 0.3\nfix e two"}}},
    {"ElementsBending",
     START +
         replaced(LINE, "elements LINE thickness 0.1",
                  "elements LINE thickness 0.1 bending yes compression no") +
         NVE + STEP,
     "what wrinkles does not resist bending",
     {{" compression no", ""}}},
    {"ElementsAirbag",
     START + LINE + NVE + STEP + "fix bag all mpm/airbag e gas 1.0 1.4\n",
     "or fix mpm/airbag pressure",
     {{"gas 1.0 1.4", "pressure 0.1"}}},
    {"ElementsAirbagOutside",
     START + LINE + NVE + STEP + "fix bag all mpm/airbag e pressure 0.1 outside 1.0\n",
     "are for gas",
     {{" outside 1.0", ""}}},
    {"ElementsCurved",
     START +
         replaced(LINE, "elements LINE thickness 0.1", "elements LINE thickness 0.1 curved yes") +
         NVE + STEP,
     "use curved no",
     {{"curved yes", "curved no"}}},
    {"ElementsStep",
     replaced(START + LINE + NVE + STEP, STEP, "timestep 0.5\n"),
     "use timestep, fix mpm/dt",
     {{"timestep 0.5", "fix step all mpm/dt 0.25"}}},
    {"SheetField",
     START + "fix B two mpm 1.0\n" + LINE + STEP +
         "pair_style mpm/sheet 0.8\npair_coeff * * 40.0\n",
     "move them with fix nve",
     {{"fix B two mpm 1.0\n", NVE}}},
    {"SheetVelocities",
     START + LINE + NVE + STEP + "pair_style mpm/sheet 0.8\npair_coeff * * 40.0 damping 0.1\n",
     "use comm_modify vel yes", add("comm_modify vel yes")},
    {"SheetNothing",
     one("", "pair_style mpm/sheet 0.8\npair_coeff * * 40.0\n"),
     "needs a fix mpm/elements with thickness or section",
     {{"pair_style mpm/sheet", LINE + NVE + "pair_style mpm/sheet"},
      {"LINE thickness 0.1 group", "LINE thickness 0.1 move 0 2 group"}}},
};

const Remedy refines[] = {
    {"RefineRatio",
     refined("", "", " origin 0.25 0.25", "0.4"),
     "use 0.5 for B",
     {{"mpm 0.4", "mpm 0.5"}}},
    {"RefineShape",
     refined(" shape gimp", "", ""),
     "use shape linear, quadratic, or cubic",
     {{"shape gimp", "shape cubic"}}},
    {"RefineTransfer",
     refined(" transfer flip 0.99"),
     "use transfer apic, aflip, or tpic",
     {{"flip 0.99", "aflip 0.99"}}},
    {"RefineScheme", refined(" scheme usf"), "use usl or musl", {{"scheme usf", "scheme musl"}}},
    {"RefinePenalty", refined("", PENALTY), "give their types a pair_coeff with modulus 0",
     add("pair_coeff 1 2 0.0")},
    {"RefineContact", refined("", CONTACT), "leave one of them out there", {{CONTACT, ""}}},
    {"RefineSmooth",
     refined(" smooth 0.4", "", " origin 0.25 0.25", "0.5", WATER),
     "leave it out",
     {{" smooth 0.4", ""}}},
    {"RefineUpdate",
     refined(" frame total reference update 1.2"),
     "use frame total without",
     {{" reference update 1.2", ""}}},
    {"RefineGeostatic",
     replaced(refined("", "mpm_geostatic A 0.5\n"), "boundary ylo", "boundary xlo xhi ylo"),
     "let the ground come to rest under its weight with fix mpm/relax",
     {{"mpm_geostatic A 0.5", "fix rest all mpm/relax 1e-6 stop no"}}},
};

const Remedy creates[] = {
    {"CreatePpc",
     START + "region r1 block 2 8 0 3 INF INF\ncreate_points 1 region r1 ppc 2\n" +
         replaced(body_one("", ELASTIC),
                  {{"region r1 block 2 8 0 3 INF INF\n", ""},
                   {"create_points 1 region r1 ppc 2 fix A group one\n", ""}}) +
         STEP,
     "define fix mpm first",
     {{"create_points 1 region r1 ppc 2\n",
       "fix A one mpm 1.0\ncreate_points 1 region r1 ppc 2 group one\n"},
      {"fix A one mpm 1.0\nfix m", "fix m"}}},
    {"CreatePpcSpacing",
     START + "region r1 block 2 8 0 3 INF INF\ncreate_points 1 region r1 ppc 2 group one\n" +
         replaced(body_one("", ELASTIC),
                  {{"region r1 block 2 8 0 3 INF INF\n", ""},
                   {"create_points 1 region r1 ppc 2 fix A group one\n", ""}}) +
         STEP,
     "or use create_points spacing",
     {{"ppc 2", "spacing 0.5"}}},
    {"CreateOverlap",
     one("", "create_points 1 region r1 ppc 2 group one\n"),
     "or use create_points keyword overlap yes",
     {{"r1 ppc 2 group", "r1 ppc 2 overlap yes group"}}},
    {"CreateOutside",
     replaced(one(""), "block 2 8 0 3", "block 2 8 -1 3"),
     "keyword outside ignore",
     {{"ppc 2 fix", "ppc 2 outside ignore fix"}}},
    {"CreateOutsideBox",
     replaced(one(""), "block 2 8 0 3", "block 2 8 -1 3"),
     "enlarge the box",
     {{"0 12 0 10", "0 12 -1 10"}}},
    {"CreateNothing",
     replaced(one(""), "block 2 8 0 3", "block 2 8 0 0.1"),
     "use a finer spacing",
     {{"r1 ppc 2", "r1 ppc 20"}}},
    {"CreateForgotten",
     replaced(one(""), "ppc 2 fix A group one", "ppc 2 fix A"),
     "with create_points and its keyword group",
     {{"ppc 2 fix A", "ppc 2 fix A group one"}}},
    {"CreateForgottenGroup",
     replaced(one("", "create_points 1 region r2 ppc 2\n"), "fix m one",
              "region r2 block 3 6 3 5 INF INF\nfix m all"),
     "or with the group command after it",
     {{"r2 ppc 2\n", "r2 ppc 2\ngroup one type 1\n"}}},
    {"CreateFlow",
     replaced(flow(""),
              {{points(), ""},
               {"fix w one mpm/incompressible 1.0 1.0\n",
                "fix w one mpm/incompressible 1.0 1.0\nregion one block 2 8 0 3 INF "
                "INF\ncreate_points 1 region one ppc 2 group one fix w\n"}}),
     "use the keyword spacing instead",
     {{"ppc 2 group one fix w", "spacing 0.5 group one"}}},
    {"CreateRings",
     START + points() +
         "fix A one mpm 1.0 axisymmetric yes\nfix m one mpm/material density 1.0 linear 100.0 0.3\n"
         "fix axis all mpm/boundary xlo ylo slip\n" +
         STEP,
     "use create_points after the fix",
     {{"create_points 1 region one spacing 0.5 group one\n", ""},
      {"fix m", "create_points 1 region one ppc 2 group one\nfix m"}}},
    {"CreateFlowPpc",
     START +
         "fix w one mpm/incompressible 1.0 1.0\nregion r1 block 2 8 0 3 INF INF\ncreate_points 1 "
         "region r1 ppc 2 group one\n" +
         STEP,
     "use create_points spacing 0.5",
     {{"ppc 2", "spacing 0.5"}}},
    {"CreateLatticeUnits",
     replaced(one(""), "fix A one", "lattice sq 100.0\nfix A one"),
     "give it the keyword units box",
     {{"INF INF\ncreate", "INF INF units box\ncreate"}}},
    {"CreateMaterial",
     replaced(one(""), "fix m one mpm/material", "fix m two mpm/material"),
     "define a fix mpm/material for their group",
     {{"fix m two", "fix m one"}}},
    {"CreateTwoMaterials",
     one("", "fix n all mpm/material density 1.0 linear 50.0 0.3\n"),
     "must be disjoint",
     {{"fix n all", "fix n two"}}},
    {"CreateRelaxLinear",
     one(" shape linear transfer flip 0.99 scheme musl",
         "region b sphere 5 6 0 1.7\ncreate_points 1 region b ppc 2 relax 20 group one\n"),
     "keyword cut in place of relax",
     {{"relax 20", "cut yes"}}},
    {"CreateRelaxQuadratic",
     one(" shape linear transfer flip 0.99 scheme musl",
         "region b sphere 5 6 0 1.7\ncreate_points 1 region b ppc 2 relax 20 group one\n"),
     "use shape quadratic",
     {{"shape linear", "shape quadratic"}}},
};

const Remedy loads[] = {
    {"TractionFree",
     one("", "fix t one mpm/traction free traction 0 -0.1 0\n"),
     "use region or points",
     {{"free traction", "region lid traction"},
      {"fix t one", "region lid plane 0 3 0 0 -1 0\nfix t one"}}},
    {"TractionNothing",
     one("", "region lid plane 0 3 0 0 -1 0\nfix t one mpm/traction region lid\n"),
     "use traction, pressure, or moment",
     {{"traction region lid", "traction region lid pressure 0.1"}}},
    {"TractionCut",
     one("", "region lid plane 0 2 0 0 -1 0\nfix t one mpm/traction region lid pressure 0.1\n"),
     "use a region that contains the body",
     {{"plane 0 2 0", "plane 0 3 0"}}},
    {"TractionLayers",
     replaced(
         one("", "region lid plane 0 3 0 0 -1 0\nfix t one mpm/traction region lid pressure 0.1\n"),
         "ppc 2", "ppc 2 jitter 0.4 4711"),
     "use the keywords spacing or area",
     {{"pressure 0.1", "pressure 0.1 area 6"}}},
    {"EmitTotal",
     one(" frame total",
         "region in block 9 11 6 8 INF INF\nfix in one mpm/emit 1 region in velocity 5 0 0\n"),
     "use frame updated",
     {{"frame total", "frame updated"}}},
    {"EmitEvery",
     one(" every 2",
         "region in block 9 11 6 8 INF INF\nfix in one mpm/emit 1 region in velocity 5 0 0\n"),
     "use every 1",
     {{"every 2", "every 1"}}},
    {"EmitNormal",
     one("",
         "variable v equal 5*step*dt\nregion in block 9 11 6 8 INF INF\nfix in one mpm/emit 1 "
         "region in velocity v_v 0 0\n"),
     "use the keyword normal",
     {{"velocity v_v 0 0", "velocity v_v 0 0 normal 1 0 0"}}},
    {"EmitShort",
     one("", "region in block 9 9.4 6 8 INF INF\nfix in one mpm/emit 1 region in velocity 5 0 0\n"),
     "make region in longer",
     {{"9 9.4", "9 11"}}},
    {"EmitFilled",
     one("", "region in block 2 4 1 3 INF INF\nfix in one mpm/emit 1 region in velocity 5 0 0\n"),
     "leave region in out when points are made",
     {{"region r1 block 2 8", "region r1 block 4.5 8"}}},
    {"EmitNobody",
     one("", "region in block 9 11 6 8 INF INF\nfix in two mpm/emit 1 region in velocity 5 0 0\n"),
     "give it and one of these the same group",
     {{"fix in two", "fix in one"}}},
    {"EmitOpen",
     one("", "region in plane 9 6 0 1 0 0\nfix in one mpm/emit 1 region in velocity 5 0 0\n"),
     "use block, cylinder, or intersect",
     {{"plane 9 6 0 1 0 0", "block 9 11 6 8 INF INF"}}},
    {"AbsorbEvery",
     one(" every 2", "region out block 7 9 0 3 INF INF\nfix out one mpm/absorb region out\n"),
     "use every 1",
     {{"every 2", "every 1"}}},
    {"DashpotPore",
     one("", SOIL + "\nregion lid plane 0 3 0 0 -1 0\nfix d one mpm/dashpot region lid 11 6\n"),
     "or soil without water",
     {{SOIL, ""}}},
    {"DashpotTransfer",
     one(" transfer fmpm 2",
         "region lid plane 0 3 0 0 -1 0\nfix d one mpm/dashpot region lid 11 6\n"),
     "use another transfer",
     {{"fmpm 2", "apic"}}},
    {"DashpotMls",
     one(" scheme musl", "region lid plane 0 3 0 0 -1 0\nfix d one mpm/dashpot region lid 11 6\n"),
     "or stress gradient",
     {{"scheme musl", "scheme musl stress gradient"}}},
    {"DashpotTwice",
     one("",
         "region lid plane 0 3 0 0 -1 0\nfix d one mpm/dashpot region lid 11 6\nfix e one "
         "mpm/dashpot region lid 11 6\n"),
     "give the two different regions or groups",
     {{"fix e one mpm/dashpot region lid",
       "region side plane 8 0 0 -1 0 0\nfix e one mpm/dashpot region side"}}},
    {"PmlScheme",
     replaced(one(" scheme usf", "fix l all mpm/pml xhi 2\n"), "2 8 0 3", "2 12 0 3"),
     "use scheme usl or musl",
     {{"scheme usf", "scheme musl"}}},
    {"PmlTransfer",
     replaced(one(" transfer flip 0.99", "fix l all mpm/pml xhi 2\n"), "2 8 0 3", "2 12 0 3"),
     "use transfer apic, which is the default",
     {{" transfer flip 0.99", ""}}},
    {"PmlLocking",
     replaced(one(" locking fbar", "fix l all mpm/pml xhi 2\n"), "2 8 0 3", "2 12 0 3"),
     "is not averaged: remove it",
     {{" locking fbar", ""}}},
    {"ColumnEdges",
     START + body_one(" edges modified transfer flip 0.99", ELASTIC) +
         body_two(" edges modified transfer flip 0.99", ELASTIC, "10 11 0 3") + FLOOR + WEIGHT +
         STEP + "fix side all mpm/column B y\n",
     "use edges plain, the default",
     {{"edges modified", "edges plain"}}},
    {"RecordName",
     one("", "fix past all mpm/record\n"),
     "needs the name of a file",
     {{"mpm/record", "mpm/record HISTORY"}}},
};

const std::string
    GRAIN =
        "create_atoms 4 single 5 3.7 0\nset type 4 diameter 1.5 density 1\ngroup grains type 4\n"
        "fix move grains nve/sphere disc\npair_style granular\n"
        "pair_coeff * * hertz 20.0 0.1 tangential linear_nohistory 5.0 0.5\n",
    DROP = "create_atoms 4 single 5 1.6 0\nset type 4 diameter 0.2 density 2\ngroup grains type 4\n"
           "fix move grains nve/sphere disc\n";
std::string spheres(const std::string &scene)
{
  return replaced(scene,
                  {{"atom_style mpm", "atom_style hybrid sphere mpm"},
                   {"neighbor 0.5 bin\n", "neighbor 0.5 multi\ncomm_modify vel yes mode multi\n"}});
}

const Remedy grains[] = {
    {"GrainsRadius",
     spheres(one("",
                 GRAIN +
                     "set group one diameter 0.0\n"
                     "neigh_modify exclude group one one\n")),
     "use fix mpm/surface", add("fix skin one mpm/surface")},
    {"GrainsDiameter",
     spheres(one("",
                 GRAIN +
                     "set group one diameter 0.0\n"
                     "neigh_modify exclude group one one\n")),
     "or set ... diameter", add("set group one diameter 0.5")},
    {"GrainsStyle",
     one("", "fix skin one mpm/surface\n"),
     "use atom_style hybrid sphere mpm",
     {{"atom_style mpm", "atom_style hybrid sphere mpm"}}},
    {"GrainsLate",
     spheres(one("",
                 GRAIN +
                     "neigh_modify exclude group one one\nfix skin one mpm/surface\nset group one "
                     "diameter 0.5\n")),
     "define the fix after them",
     {{"fix skin one mpm/surface\n", ""}, {"", "fix skin one mpm/surface\n"}}},
    {"GrainsTwice",
     spheres(one("",
                 GRAIN +
                     "neigh_modify exclude group one one\nfix skin one mpm/surface\nfix skin2 all "
                     "mpm/surface\n")),
     "give them disjoint groups",
     {{"fix skin2 all mpm/surface\n", ""}}},
    {"GrainsPairs",
     spheres(one("", GRAIN + "fix skin one mpm/surface\n")),
     "keyword lists of fix mpm/surface",
     {{"mpm/surface", "mpm/surface lists grains"}}},
    {"ImmersedStyle",
     one("", "group grains empty\nfix drag grains mpm/immersed A 1.0 0.01 gravity 0 -0.2 0\n"),
     "use atom_style hybrid sphere mpm",
     {{"group grains empty\n", DROP},
      {"atom_style mpm", "atom_style hybrid sphere mpm"},
      {"fix drag",
       "pair_style zero 0.5\npair_coeff * *\nneigh_modify exclude group all all\nfix drag"}}},
    {"ImmersedTotal",
     spheres(
         one(" frame total", DROP + "fix drag grains mpm/immersed A 1.0 0.01 gravity 0 -0.2 0\n")),
     "use frame updated",
     {{"frame total", "frame updated"}}},
    {"ImmersedDrag",
     spheres(one("", DROP + "fix drag grains mpm/immersed A 1.0 0 gravity 0 -0.2 0\n")),
     "use drag none without",
     {{"A 1.0 0 gravity", "A 1.0 0 drag none gravity"}}},
    {"ImmersedDisplace",
     spheres(
         one("", DROP + "fix drag grains mpm/immersed A 1.0 0.01 displace yes gravity 0 -0.2 0\n")),
     "leave it out",
     {{" displace yes", ""}}},
    {"ImmersedGroup",
     spheres(one("", DROP + "fix drag all mpm/immersed A 1.0 0.01 gravity 0 -0.2 0\n")),
     "use a group of grains",
     {{"fix drag all", "fix drag grains"}}},
    {"ImmersedFlowGroup",
     spheres(replaced(flow(""), "fix w one", "fix w all") + DROP +
             "fix drag grains mpm/immersed w 1.0 0.01\n"),
     "give it the same",
     {{"w 1.0 0.01", "w 1.0 0.01 gravity 0 -0.2 0"}}},
};

const Remedy rigids[] = {
    {"Rigid2d",
     one("", "region tool block 9 12 0 10 INF INF\nfix tool all mpm/rigid tool density 2.0 slip\n"),
     "move a region with fix mpm/boundary",
     {{"region tool block 9 12 0 10 INF INF\nfix tool all mpm/rigid tool density 2.0 slip",
       "variable d equal -0.1*step*dt\nregion tool block 9 12 0 10 INF INF move v_d NULL NULL\nfix "
       "tool all mpm/boundary region tool slip"}}},
};

const Remedy outputs[] = {
    {"EnergyGroup",
     one("", "compute e one mpm/energy\n"),
     "requires group all",
     {{"compute e one", "compute e all"}}},
    {"EnergyOrder",
     one("", "compute e all mpm/energy\nthermo_style custom step c_e\nfix h all mpm/heat\n", WARM),
     "define it after the fixes",
     {{"compute e all mpm/energy\nthermo_style custom step c_e\n", ""},
      {"", "compute e all mpm/energy\nthermo_style custom step c_e\n"}}},
    {"CellsFlow",
     flow("", "") + "fix c all mpm/cells w\ndump d all grid 10 MAP f_c:cell:density\n",
     "average columns of compute mpm/atom by fix ave/grid",
     {{"fix c all mpm/cells w\n",
       "compute a all mpm/atom pressure\nfix c all ave/grid 1 1 10 6 5 1 c_a\n"},
      {"f_c:cell:density", "f_c:grid:data"}}},
    {"StressOfAtoms",
     one("", "compute s all stress/atom NULL\n"),
     "use the pressure or the stress of compute mpm/atom",
     {{"compute s all stress/atom NULL", "compute s all mpm/atom pressure"}}},
    {"ColumnPress",
     one("", "thermo_style custom step press\n"),
     "use compute mpm/atom, and compute reduce ... ave",
     {{"thermo_style custom step press",
       "compute a all mpm/atom pressure\ncompute r all reduce ave c_a\nthermo_style custom step "
       "c_r"}}},
    {"FixSetforce",
     one("", "fix f one setforce 0 0 0\n"),
     "use fix mpm/boundary",
     {{"fix f one setforce 0 0 0\n", ""}}},
    {"Step",
     replaced(one(""), STEP, "timestep 0.5\n"),
     "use timestep, fix mpm/dt",
     {{"timestep 0.5", "fix step all mpm/dt 0.5"}}},
    {"Skin",
     replaced(one(""), "neighbor 0.5 bin", "neighbor 0.01 bin"),
     "use neighbor 0.5 bin",
     {{"neighbor 0.01 bin", "neighbor 0.5 bin"}}},
    {"Locking",
     one("", "", "neohookean 100 0.499"),
     "use locking fbar or pressure",
     {{"mpm 1.0", "mpm 1.0 locking pressure"}}},
    {"LockingNeedless",
     one(" locking fbar", "", "neohookean 100 0.1"),
     "remove locking",
     {{" locking fbar", ""}}},
    {"Scheme",
     one(" shape linear"),
     "use transfer flip with scheme musl",
     {{"shape linear", "shape linear transfer flip 1.0 scheme musl"}}},
    {"SchemeLight",
     one(" shape linear"),
     "or light 0.5",
     {{"shape linear", "shape linear light 0.5"}}},
    {"SmoothNothing", one(" smooth 0.4"), "or use a material with eos tait", {{ELASTIC, WATER}}},
    {"SmoothLocking",
     one(" smooth 0.4 locking fbar", "", WATER),
     "give fluids, which do not lock, a fix mpm without locking",
     {{" locking fbar", ""}}},
    {"SoftSolid",
     one("", "", "linear 0.1 0.3"),
     "are modulus, density, and gravity in the units of the input?",
     {{"linear 0.1", "linear 100.0"}}},
    {"GravityAcross",
     replaced(one(""), "vector 0 -1 0", "vector 0 0 -1"),
     "in 2d one along x or y",
     {{"vector 0 0 -1", "vector 0 -1 0"}}},
    {"GravityAcrossFlow",
     replaced(flow(""), "vector 0 -1 0", "vector 0 0 -1"),
     "in 2d one along x or y",
     {{"vector 0 0 -1", "vector 0 -1 0"}}},
    {"IntegratedTwice",
     one("", "fix B one mpm 1.0\n"),
     "give the fixes disjoint groups",
     {{"fix B one mpm 1.0\n", ""}}},
    {"AxisBelow",
     replaced(one(" axisymmetric yes"), "0 12 0 10", "-1 12 0 10"),
     "the box must not reach below x = 0",
     {{"-1 12 0 10", "0 12 0 10"}, {"boundary ylo", "boundary xlo ylo"}}},
    {"AxisWall",
     one(" axisymmetric yes"),
     "use fix mpm/boundary xlo slip",
     {{"boundary ylo", "boundary xlo ylo"}}},
};

// a run without set-up knows only what was there at the last one
const char *const ANEW = "use run without pre no";
const Edit SET_UP = {{"run 2 pre no", "run 2"}};
const std::string FEWER = "run 1\nregion few block 2 8 2.5 3 INF INF\ngroup few region few\n"
                          "delete_atoms group few\nrun 2 pre no\n";
const Remedy runs[] = {
    {"AnewField", one("", "run 1\nfix A one mpm 1.0 shape cubic\nrun 2 pre no\n"), ANEW, SET_UP},
    {"AnewWall",
     one("", "run 1\nunfix floor\nfix floor all mpm/boundary ylo stick\nrun 2 pre no\n"), ANEW,
     SET_UP},
    {"AnewLoad",
     one("",
         "run 1\nregion top plane 0 3 0 0 -1 0\n"
         "fix l all mpm/traction region top pressure 0.1\nrun 2 pre no\n"),
     ANEW, SET_UP},
    {"MorePoints",
     one("",
         "run 1\nregion more block 8 9 8 9 INF INF\n"
         "create_points 1 region more ppc 2 fix A group one\nrun 2 pre no\n"),
     ANEW, SET_UP},
    {"FewerPoints", one("", FEWER), ANEW, SET_UP},
    {"FewerPointsOfTwo", two("", CONTACT + FEWER), ANEW, SET_UP},
    {"FewerPointsInAFlow", flow("") + FEWER, ANEW, SET_UP},
    {"FewerPointsOnAMesh", meshed("frame total", FEWER), ANEW, SET_UP},
    {"AnewFlow", flow("") + "run 1\nfix w one mpm/incompressible 1.0 1.0\nrun 2 pre no\n", ANEW,
     SET_UP},
    {"AnewMesh", meshed("", "run 1\nfix M one mpm/mesh QUADS slip ylo frame total\nrun 2 pre no\n"),
     ANEW, SET_UP},
    {"AnewElements",
     START + LINE + NVE + STEP + "run 1\nfix e two mpm/elements LINE thickness 0.1\nrun 2 pre no\n",
     ANEW, SET_UP},
};

const std::string CRACKS = "fix cracks all mpm/fracture surface yes\n";

const Remedy fractures[] = {
    {"FractureScheme",
     one(" scheme musl", CRACKS),
     "use scheme usl",
     {{"scheme musl", "scheme usl"}}},
    {"FractureTotal",
     one(" frame total", CRACKS),
     "use frame updated",
     {{"frame total", "frame updated"}}},
    {"FractureShape",
     one(" shape cpdi transfer flip 0.99", CRACKS),
     "use shape quadratic",
     {{"shape cpdi", "shape quadratic"}}},
    {"FractureTransfer",
     one(" transfer xpic 2", CRACKS),
     "use transfer apic",
     {{"transfer xpic 2", "transfer apic"}}},
    {"FractureLocking",
     one(" locking fbar", CRACKS),
     "use locking none",
     {{"locking fbar", "locking none"}}},
    {"FractureEdges",
     one(" transfer flip 0.99 edges modified", CRACKS),
     "use edges plain",
     {{"edges modified", "edges plain"}}},
    {"FractureImplicit", one("", CRACKS + EULER), "remove one of them", {{CRACKS, ""}}},
    {"FractureRefine", refined("", CRACKS), "use one fix mpm", {{CRACKS, ""}}},
    {"FractureMixture", mixture("", CRACKS), "remove it, and give pieces", {{CRACKS, ""}}},
};

const std::string BREAKS = "eos linear 100.0 strength elastic 40.0 damage phasefield ",
                  FIELD = "fix crack all mpm/phasefield\n";

const Remedy phase_fields[] = {
    {"PhaseFieldMissing",
     one("", "", BREAKS + "0.1 2.0 model at1"),
     "define one, or use damage rankine",
     {{FLOOR, FLOOR + FIELD}}},
    {"PhaseFieldIdle",
     one("", FIELD),
     "give it to what may break",
     {{ELASTIC, BREAKS + "0.1 2.0 model at1"}}},
    {"PhaseFieldShort",
     one("", FIELD, BREAKS + "0.1 0.5 model at1"),
     "use a length of at least that",
     {{"0.1 0.5", "0.1 2.0"}}},
    {"PhaseFieldLong",
     one("", FIELD, BREAKS + "0.1 2.0 model cohesive 5.0"),
     "is too large for a cohesive crack",
     {{"0.1 2.0", "5.0 2.0"}}},
    {"PhaseFieldVaries",
     one("", FIELD, BREAKS + "0.1 2.0 model at1 random L lognormal 0.1 4.0 1"),
     "leave 'random L'",
     {{" random L lognormal 0.1 4.0 1", ""}}},
    {"PhaseFieldImplicit",
     one("", FIELD + EULER, BREAKS + "0.1 2.0 model at1"),
     "remove one of them",
     {{EULER, ""}}},
    {"PhaseFieldRefine",
     refined("", FIELD, " origin 0.25 0.25", "0.5", BREAKS + "0.1 2.0 model at1"),
     "use one fix mpm",
     {{FIELD, ""}, {"phasefield 0.1 2.0 model at1", "rankine 5.0"}}},
};

std::vector<Remedy> all_remedies()
{
  std::vector<Remedy> all;
  const auto append = [&](const auto &rows) {
    all.insert(all.end(), std::begin(rows), std::end(rows));
  };
  append(contacts);
  append(fractures);
  append(phase_fields);
  append(walls);
  append(heats);
  append(pores);
  append(flows);
  append(implicits);
  append(meshes);
  append(elements);
  append(refines);
  append(creates);
  append(loads);
  append(grains);
  append(rigids);
  append(outputs);
  append(runs);
  return all;
}

// ---------------------------------------------------------------------- the test

class Remedies : public ::testing::TestWithParam<Remedy> {
 protected:
  void SetUp() override
  {
    if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  }

  /** The error and the warnings of a scene, and whether its points are at finite places. */
  std::string said(std::string text, bool &finite) const
  {
    static const int n[] = {2, 2};
    static const double size[] = {2.0, 2.0};
    const ScratchFile line_file("line.msh", line(6, {3.0, 3.5, 0.0}, {6.0, 3.5, 0.0}).text(),
                                MPI_COMM_SELF),
        cells("cells.msh", box_mesh(2, n, size, false, 0.0), MPI_COMM_SELF),
        quads("quads.msh",
              gmsh(QUADS, {12, 6, 1},
                   [](double x, double y, double) {
                     return std::array<double, 3>{2.0 + 6.0 * x, 3.0 * y, 0.0};
                   }),
              MPI_COMM_SELF),
        history("history.txt", "0 0\n1 1\n", MPI_COMM_SELF), map("map.txt", "", MPI_COMM_SELF),
        log("log", MPI_COMM_SELF);
    text = replaced(text,
                    {{"LINE", line_file.name},
                     {"CELLS", cells.name},
                     {"QUADS", quads.name},
                     {"HISTORY", history.name},
                     {"MAP", map.name}});
    Scene run(MPI_COMM_SELF);
    std::string found = run.error("log " + log.name + "\n" + text + "thermo 1000\nrun 20\n");
    run.error("log none\n");
    finite = true;
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < 3; d++) finite = finite && std::isfinite(run.x()[i][d]);
    std::istringstream lines(file_text(log.name));
    for (std::string warning; std::getline(lines, warning);)
      if (warning.rfind("WARNING: ", 0) == 0 &&
          warning.find("multiple sub-styles") == std::string::npos)
        found += warning + "\n";
    return found;
  }
};

TEST_P(Remedies, Works)
{
  const auto &[name, scene, words, edit] = GetParam();
  bool finite;
  EXPECT_THAT(said(scene, finite), HasSubstr(words)) << scene;
  std::string mended = scene;
  for (const auto &[from, to] : edit) {
    if (from.empty()) {
      mended += to;
      continue;
    }
    ASSERT_THAT(mended, HasSubstr(from));
    mended = replaced(mended, from, to);
  }
  EXPECT_EQ(said(mended, finite), "") << mended;
  EXPECT_TRUE(finite);
}

INSTANTIATE_TEST_SUITE_P(All, Remedies, ValuesIn(all_remedies()), [](const auto &info) {
  return std::string(info.param.name);
});

}    // namespace
