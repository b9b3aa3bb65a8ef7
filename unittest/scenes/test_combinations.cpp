// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics input
// timeout: 600

// What goes with what: each pair of the things below, in a scene of a few steps. It runs, with
// finite numbers and a ledger of energy that closes, or it is refused with a reason. The result is
// a table of the manual, in doc/src/combinations; tools/tables.sh writes it.

#include "declare/table_testing.h"
#include "mesh/stl_testing.h"

#include "gtest/gtest.h"

#include <cmath>
#include <regex>

using namespace MPM_TEST;

namespace {

/** A scene: ground of type 1, 8 x 3 cells, and what choices add to it and change of it. */
struct Parts {
  int dim = 2;
  double least_width = 12.0;
  std::string faces = "f f p", style = "mpm", law = "linear 100.0 0.3", more_law,
              step = "timestep 0.005";
  std::string weight = "fix g all gravity 0.2 vector 0 -1 0\n";
  std::string head, before, define, fill, fixes, walls = "xlo ylo slip", between;
  std::string motion = "mpm 1.0";    // style of the fix that moves the ground
  std::map<std::string, std::string> options;
  std::map<int, std::string> bodies = {{1, "grid1"}};    // types of points, and what moves them
  std::vector<std::pair<std::string, std::string>> pairs;
  bool is_field = true, ledger = true;

  /** Text that is another one in 3d. */
  std::string per_dim(const char *flat, const char *solid) const { return dim == 2 ? flat : solid; }
  void block(int type, const std::string &corners, const std::string &sites = "ppc 2 fix grid1")
  {
    fill += strprintf("region r%d block %s INF INF\ncreate_points %d region r%d %s\n", type,
                      corners.c_str(), type, type, sites.c_str());
  }
  /** A body on the ground, in a field of its own. */
  void second_field()
  {
    if (bodies.count(2)) return;
    bodies[2] = "grid2";
    block(2, "2 5 3 5");
  }
  std::string all_options() const
  {
    std::string text;
    for (const auto &[key, value] : options) text += " " + key + " " + value;
    return text;
  }
  void grains(const std::string &pair, const std::string &coefficients)
  {
    style = "hybrid sphere mpm";
    head += "neighbor 0.5 multi\ncomm_modify vel yes mode multi\n";
    pairs.emplace_back(pair, coefficients);
    fixes += per_dim("fix move grains nve/sphere disc\n", "fix move grains nve/sphere\n");
  }

  std::string scene() const
  {
    const double width = bodies.count(5) ? 12.0 : bodies.count(4) ? least_width + 2.0 : least_width;
    std::string text = strprintf("units lj\ndimension %d\nboundary %s\natom_style %s\n", dim,
                                 faces.c_str(), style.c_str()) +
        strprintf("neighbor 0.5 bin\nregion box block 0 %g 0 10 %s\n", width,
                  dim == 2 ? "-0.5 0.5" : "0 4") +
        head + "create_box 10 box\n" + before;
    // groups of points that are there before the fixes are used, and are made again with them
    std::string groups = "group grains type 8 9\ngroup atoms type 10\ngroup main type";
    for (const auto &[type, field] : bodies)
      if (field == "grid1") groups += strprintf(" %d", type);
    for (const auto &[type, field] : bodies)
      groups += strprintf("\ngroup body%d type %d", type, type);
    groups += "\ngroup points type";
    for (const auto &[type, field] : bodies) groups += strprintf(" %d", type);
    groups += "\n";
    const int others = std::count_if(bodies.begin(), bodies.end(), [](const auto &body) {
      return body.second != "grid1";
    });    // points that come later are in the group all, and one more
    const std::string group = others == 0   ? "all "
        : (int) bodies.size() == others + 1 ? "body1 "
                                            : "main ";
    text += groups + "fix grid1 " + group + motion + (is_field ? all_options() : "") + "\n";
    for (const auto &[type, field] : bodies)
      if (field == "grid2" || field == "water" || field == "far")
        text += strprintf("fix %s body%d mpm 1.0", field.c_str(), type) + all_options() + "\n";
    text += define + "region r1 block 0 8 0 3 INF INF\n" +
        (is_field ? "create_points 1 region r1 ppc 2 fix grid1\n"
                  : "create_points 1 region r1 spacing 0.5\n") +
        fill + groups;
    const bool is_flow = motion.find("incompressible") != std::string::npos;    // without laws
    for (const auto &[type, field] : bodies)
      text += is_flow && field == "grid1"
          ? ""
          : strprintf("fix law%d body%d mpm/material density %g ", type, type,
                      type == 1 && bodies.count(3) ? 1.5 : 1.0) +
              (type == 3                    ? "eos tait 100.0 7"
                   : type == 6 || type == 7 ? "linear 100.0 0.3"
                                            : law) +
              (type == 3 ? "" : more_law) + "\n";
    text += "velocity main ramp vx 0.0 0.4 y 0 3 units box\nvelocity main ramp vy 0.0 -0.3 y 0 3 "
            "units box\n";
    for (const auto &[type, field] : bodies)
      if (type != 1) text += strprintf("velocity body%d set -0.3 -0.9 0 units box\n", type);
    if (!walls.empty()) text += "fix walls all mpm/boundary " + walls + "\n";
    if (pairs.size() == 1)
      text += "pair_style " + pairs[0].first + "\n" + pairs[0].second;
    else if (pairs.size() > 1) {
      text += "pair_style hybrid/overlay";
      for (const auto &[pair, coefficients] : pairs) text += " " + pair;
      text += "\n";
      for (const auto &[pair, coefficients] : pairs)
        text += std::regex_replace(coefficients, std::regex("(pair_coeff \\S+ \\S+)"),
                                   "$1 " + pair.substr(0, pair.find(' ')));
    }
    text += weight + fixes + step + "\n";
    if (ledger) text += "compute e all mpm/energy\nthermo_style custom step c_e\n";
    return text + "thermo 1000\nrun 3\n" + between + "run 4\n";
  }
};

/** Gmsh's file of nx x ny (x nz) cells of this size, with a bottom and a left side. */
std::string block_mesh(int dim, int nx, int ny, int nz, double h)
{
  const int sy = nx + 1, sz = sy * (ny + 1);
  std::string nodes, elements;
  int nnode = 0, nelement = 0;
  if (dim == 2) nz = 0;
  for (int k = 0; k <= nz; k++)
    for (int j = 0; j <= ny; j++)
      for (int i = 0; i <= nx; i++)
        nodes += strprintf("%d %g %g %g\n", ++nnode, h * i, h * j, h * k);
  for (int k = 0; k < std::max(1, nz); k++)
    for (int j = 0; j < ny; j++)
      for (int i = 0; i < nx; i++) {
        const int c = 1 + i + j * sy + k * sz;
        const auto add = [&](int kind2, int kind3, int tag, std::vector<int> flat,
                             std::vector<int> rest) {
          elements += strprintf("%d %d 2 %d 1", ++nelement, dim == 2 ? kind2 : kind3, tag);
          if (dim == 3) flat.insert(flat.end(), rest.begin(), rest.end());
          for (const int n : flat) elements += strprintf(" %d", n);
          elements += "\n";
        };
        add(3, 5, 1, {c, c + 1, c + sy + 1, c + sy},
            {c + sz, c + sz + 1, c + sz + sy + 1, c + sz + sy});
        if (j == 0) add(1, 3, 2, {c, c + 1}, {c + sz + 1, c + sz});
        if (i == 0) add(1, 3, 3, {c, c + sy}, {c + sz + sy, c + sz});
      }
  return strprintf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n%d 1 \"cells\"\n"
                   "%d 2 \"bottom\"\n%d 3 \"left\"\n$EndPhysicalNames\n$Nodes\n%d\n",
                   dim, dim - 1, dim - 1, nnode) +
      nodes + strprintf("$EndNodes\n$Elements\n%d\n", nelement) + elements + "$EndElements\n";
}

/** Gmsh's file of a closed surface of radius 1: a polygon, in 3d an octahedron. */
std::string skin_mesh(int dim)
{
  std::string nodes, elements;
  const int n = dim == 2 ? 16 : 6, elements_of = dim == 2 ? n : 8;
  if (dim == 2)
    for (int k = 0; k < n; k++) {
      nodes += strprintf("%d %.9g %.9g 0\n", k + 1, cos(2 * PI * k / n), sin(2 * PI * k / n));
      elements += strprintf("%d 1 2 1 1 %d %d\n", k + 1, k + 1, (k + 1) % n + 1);
    }
  else {
    nodes = "1 1 0 0\n2 -1 0 0\n3 0 1 0\n4 0 -1 0\n5 0 0 1\n6 0 0 -1\n";
    const int sides[8][3] = {{1, 3, 5}, {3, 2, 5}, {2, 4, 5}, {4, 1, 5},
                             {3, 1, 6}, {2, 3, 6}, {4, 2, 6}, {1, 4, 6}};
    for (int k = 0; k < 8; k++)
      elements += strprintf("%d 2 2 1 1 %d %d %d\n", k + 1, sides[k][0], sides[k][1], sides[k][2]);
  }
  return strprintf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", n) + nodes +
      strprintf("$EndNodes\n$Elements\n%d\n", elements_of) + elements + "$EndElements\n";
}

void add_skin(Parts &p, bool lattice)
{
  p.bodies[6] = lattice && p.is_field ? "grid1" : "";
  p.fill += "create_points 6 mesh SKIN thickness 0.05 move 6.5 7" + p.per_dim("", " 2") + "\n";
  p.fixes += "fix skin body6 mpm/elements SKIN thickness 0.05\n";
  if (!lattice || !p.is_field) p.fixes += "fix nve6 body6 nve\n";
}

void use_mesh(Parts &p, bool total)
{
  p.motion = "mpm/mesh GROUND part cells slip bottom slip left frame " +
      std::string(total ? "total" : "updated");
  p.is_field = p.ledger = false;
  p.walls = "";
}

/** One of the things that are combined. Of two things of one kind there can be only one. */
struct Choice {
  const char *name, *kind;
  void (*add)(Parts &);
};

#define OPTION(key, value)  \
  [](Parts &p) {            \
    p.options[key] = value; \
  }

const Choice choices[] = {
    {"fix mpm shape linear", "shape", OPTION("shape", "linear")},
    {"fix mpm shape gimp", "shape", OPTION("shape", "gimp")},
    {"fix mpm shape cpdi", "shape", OPTION("shape", "cpdi")},
    {"fix mpm transfer flip", "transfer", OPTION("transfer", "flip 0.99")},
    {"fix mpm transfer xpic", "transfer", OPTION("transfer", "xpic 2")},
    {"fix mpm transfer fmpm", "transfer", OPTION("transfer", "fmpm 2")},
    {"fix mpm transfer polypic", "transfer", OPTION("transfer", "polypic")},
    {"fix mpm scheme musl", "scheme", OPTION("scheme", "musl")},
    {"fix mpm scheme usf", "scheme", OPTION("scheme", "usf")},
    {"fix mpm stress gradient", "stress", OPTION("stress", "gradient")},
    {"fix mpm frame total", "frame", OPTION("frame", "total")},
    {"fix mpm reference update", "frame",
     [](Parts &p) {
       p.options["frame"] = "total";
       p.options["reference"] = "update 1.01";
     }},
    {"fix mpm axisymmetric", "axis", OPTION("axisymmetric", "yes")},
    {"fix mpm locking fbar", "locking", OPTION("locking", "fbar")},
    {"fix mpm locking pressure", "locking", OPTION("locking", "pressure")},
    {"fix mpm locking both", "locking", OPTION("locking", "both")},
    {"fix mpm heat", "loss", OPTION("heat", "yes")},
    {"fix mpm edges modified", "edges",
     [](Parts &p) {
       p.options["edges"] = "modified";
       p.options.insert({"transfer", "flip 0.99"});
     }},
    {"fix mpm every", "every", OPTION("every", "2")},
    {"a liquid", "law",
     [](Parts &p) {
       p.law = "eos tait 100.0 7";
     }},
    {"fix mpm smooth", "law",
     [](Parts &p) {
       p.law = "eos tait 100.0 7";
       p.options["smooth"] = "0.5";
     }},
    {"damage", "law",
     [](Parts &p) {
       p.law = "eos linear 100.0 strength elastic 40.0 damage rankine 0.5";
     }},
    {"fix mpm/mesh", "motion",
     [](Parts &p) {
       use_mesh(p, false);
     }},
    {"fix mpm/mesh/contact", "motion",
     [](Parts &p) {
       use_mesh(p, false);
       p.bodies[2] = "grid1";
       p.fill += "region half block 4 INF INF INF INF INF\nset region half type 2\n";
       p.fixes += "fix between all mpm/mesh/contact grid1 body1 body2\n";
     }},
    {"fix mpm/mesh/heat", "motion",
     [](Parts &p) {
       use_mesh(p, true);
       p.more_law = " thermal conducting 1.0 300 0.5 expansion 1e-4";
       p.fixes += "fix warm all mpm/mesh/heat grid1 temperature bottom 350\n";
     }},
    {"fix mpm/incompressible", "motion",
     [](Parts &p) {
       p.motion = "mpm/incompressible 1.0 1.0 viscosity 0.1";
       p.is_field = p.ledger = false;
       p.walls = "";
     }},
    {"fix mpm/implicit", "implicit",
     [](Parts &p) {
       p.fixes += "fix solve all mpm/implicit euler\n";
     }},
    {"fix mpm/implicit static", "implicit",
     [](Parts &p) {
       p.fixes += "fix solve all mpm/implicit static stabilize 1e-3\n";
     }},
    {"fix mpm/relax", "relax",
     [](Parts &p) {
       p.fixes += "fix rest all mpm/relax 1e-6 stop no every 5\n";
     }},
    {"fix mpm/contact", "contact",
     [](Parts &p) {
       p.second_field();
       p.fixes += "fix touch all mpm/contact grid1 grid2 law coulomb 0.3\n";
     }},
    {"pair mpm/penalty", "penalty",
     [](Parts &p) {
       p.second_field();
       p.head += "comm_modify vel yes\n";
       p.pairs.emplace_back("mpm/penalty",
                            "pair_coeff * * 0.0\npair_coeff 1 2 50.0 friction 0.3 0.01\n");
     }},
    {"fix mpm/mixture", "mixture",
     [](Parts &p) {
       p.bodies[3] = "water";
       p.block(3, "0 8 0 3", "ppc 2 share 0.5 fix water");
       p.fixes += "fix mix all mpm/mixture grid1 water 2.5 0.01 drag darcy 0.01\n";
     }},
    {"fix mpm/refine", "refine",
     [](Parts &p) {
       p.bodies[4] = "fine";
       p.options.insert({"scheme", "musl"});
       p.define += "fix fine body4 mpm 0.5" + p.all_options() + " origin" +
           std::string(p.options.count("shape") ? " 0 0 0" : " 0.25 0.25 0.25")
               .substr(0, p.options.count("shape") ? 2 * p.dim : 5 * p.dim) +
           "\nfix one all mpm/refine grid1 fine\n";
       p.block(4, "8 10 0 3", "ppc 2 fix fine");
     }},
    {"fix mpm/column", "column",
     [](Parts &p) {
       p.bodies[5] = "far";
       p.block(5, "10 11 0 3", "ppc 2 fix far");
       p.fixes += "fix side all mpm/column far y\nregion east plane 8 0 0 -1 0 0\n"
                  "fix east body1 mpm/dashpot region east 11 6 column side\n";
     }},
    {"fix mpm/rigid", "rigid",
     [](Parts &p) {
       p.fixes += p.dim == 3 ? "region tool mpm/mesh CUBE 1.0 4.0 4.0 2.0\n"
                             : "region tool block 3 5 3 5 INF INF\n";
       p.fixes +=
           "fix tool all mpm/rigid tool density 2.0 separate friction 0.2 velocity 0.1 -0.4 0.0\n";
       if (p.motion.find("incompressible") != std::string::npos) p.motion += " region tool";
     }},
    {"fix mpm/elements, a solid", "elements",
     [](Parts &p) {
       p.bodies[7] = p.is_field ? "grid1" : "";
       p.fill += "create_points 7 mesh BAR part cells move 5.5 3.1" + p.per_dim("", " 1") + "\n";
       p.fixes += "fix bar body7 mpm/elements BAR part cells\n";
       if (!p.is_field) p.fixes += "fix nve7 body7 nve\n";
     }},
    {"fix mpm/elements, a surface", "skin",
     [](Parts &p) {
       add_skin(p, true);
     }},
    {"fix mpm/airbag", "skin",
     [](Parts &p) {
       add_skin(p, true);
       p.fixes += "fix bag all mpm/airbag skin gas 1.0 1.4 outside 0.9\n";
     }},
    {"pair mpm/sheet", "skin",
     [](Parts &p) {
       add_skin(p, false);
       p.pairs.emplace_back("mpm/sheet 0.8", "pair_coeff * * 40.0\n");
     }},
    {"grains, fix mpm/surface", "grains",
     [](Parts &p) {
       p.grains("granular", "pair_coeff * * hertz 20.0 0.1 tangential linear_nohistory 5.0 0.5\n");
       p.fill += "create_atoms 9 single 6.5 3.6 " + p.per_dim("0", "2") +
           "\nset type 9 diameter 1.5 density 1\nvelocity grains set 0 -0.4 0 units box\n";
       p.fixes += "neigh_modify exclude group points points\nfix outer points mpm/surface\n";
     }},
    {"fix mpm/immersed", "immersed",
     [](Parts &p) {
       p.grains("zero 0.5", "pair_coeff * *\n");
       p.fill += "create_atoms 8 single 2.3 1.6 " + p.per_dim("0", "2") +
           "\nset type 8 diameter 0.2 density 2\n";
       p.fixes += "neigh_modify exclude group all all\n"
                  "fix drag grains mpm/immersed grid1 1.0 0.01 drag gidaspow\n";
     }},
    {"fix mpm/handshake", "handshake",
     [](Parts &p) {
       p.options.insert({"transfer", "flip 1.0"});
       p.pairs.emplace_back("lj/cut 2.0", "pair_coeff * * 0.0 1.0\npair_coeff 10 10 1.0 0.9\n");
       p.fill += "lattice " + p.per_dim("sq", "sc") +
           " 1.0\nregion far block 4 11 0.4 3 INF INF\ncreate_atoms 10 region far\n"
           "set type 10 mass 1.0\n";
       p.fixes += "fix nve10 atoms nve\nneigh_modify exclude group points all\n"
                  "fix bridge atoms mpm/handshake grid1 zone x 8.1 6\n";
     }},
    {"fix mpm/fracture", "fracture",
     [](Parts &p) {
       p.fixes += "fix cracks all mpm/fracture surface yes law coulomb 0.3\n";
     }},
    {"fix mpm/phasefield", "law",
     [](Parts &p) {
       p.law =
           "eos linear 100.0 strength elastic 40.0 damage phasefield 0.1 2.0 model cohesive 0.5";
       p.fixes += "fix crack all mpm/phasefield every 2\n";
     }},
    {"fix mpm/heat", "heat",
     [](Parts &p) {
       p.more_law = " thermal conducting 1.0 300 0.5 expansion 1e-4";
       p.fixes += "fix heat all mpm/heat xlo temperature 350 surface convection 0.5 280\n";
     }},
    {"fix mpm/pore", "pore",
     [](Parts &p) {
       p.fixes +=
           "fix pore all mpm/pore 1000.0 0.5 1.0 soil law1 0.4 constant 0.01 free pressure 0\n";
     }},
    {"fix mpm/pore u-v-p", "pore",
     [](Parts &p) {
       p.fixes +=
           "fix pore all mpm/pore 1000.0 0.5 1.0 soil law1 0.4 constant 0.01 formulation u-v-p\n";
     }},
    {"mpm_geostatic", "geostatic",
     [](Parts &p) {
       p.least_width = 8.0;
       if (!p.walls.empty()) p.walls = "xlo xhi ylo slip";
       p.fixes += "mpm_geostatic grid1 0.5\n";
     }},
    {"fix mpm/boundary region", "region",
     [](Parts &p) {
       p.fixes += "variable down equal -0.05*step\n"
                  "region die block INF 2 2.8 INF INF INF move NULL v_down NULL\n"
                  "fix die all mpm/boundary region die slip friction 0.2\n";
     }},
    {"fix mpm/boundary separate", "wall",
     [](Parts &p) {
       if (!p.walls.empty()) p.walls = "xlo slip";
       p.fixes += "fix floor all mpm/boundary ylo separate friction 0.3\n";
     }},
    {"fix mpm/traction region", "traction",
     [](Parts &p) {
       p.fixes +=
           "region lid plane 0 3 0 0 -1 0\nfix load body1 mpm/traction region lid pressure 0.5\n";
     }},
    {"fix mpm/traction free", "traction",
     [](Parts &p) {
       p.fixes += "fix load body1 mpm/traction free pressure 0.5\n";
     }},
    {"fix mpm/dashpot", "dashpot",
     [](Parts &p) {
       p.fixes +=
           "region upper plane 0 3 0 0 -1 0\nfix upper body1 mpm/dashpot region upper 11 6\n";
     }},
    {"fix mpm/pml", "pml",
     [](Parts &p) {
       p.fixes += "fix layer all mpm/pml ylo 2\n";
     }},
    {"fix mpm/emit", "emit",
     [](Parts &p) {
       p.before += "region inlet block 1 2 6 8 " + p.per_dim("INF INF", "0 4") + "\n";
       p.fixes += "fix in body1 mpm/emit 1 region inlet velocity 5.0 0 0\n";
     }},
    {"fix mpm/absorb", "absorb",
     [](Parts &p) {
       p.before += "region drain block 3 5 2.5 INF INF INF\n";
       p.fixes += "fix out body1 mpm/absorb region drain every 3\n";
     }},
    {"fix mpm/deform", "deform",
     [](Parts &p) {
       p.faces = "p p p";
       p.walls = p.weight = "";
       p.options["frame"] = "total";
       p.fixes += "fix cell all mpm/deform x erate 0.05\n";
     }},
    {"fix mpm/record", "record",
     [](Parts &p) {
       p.fixes += "fix past all mpm/record HISTORY\nvariable past equal f_past\n"
                  "region side plane 8 0 0 -1 0 0\nfix push body1 mpm/traction region side "
                  "pressure v_past\n";
     }},
    {"fix mpm/cells", "cells",
     [](Parts &p) {
       p.fixes += "fix cells all mpm/cells grid1\ndump map all grid 2 MAP f_cells:cell:density\n";
     }},
    {"fix mpm/dt", "dt",
     [](Parts &p) {
       p.step = "fix dt all mpm/dt 0.3";
     }},
    {"fix balance", "balance",
     [](Parts &p) {
       p.head += "comm_style tiled\n", p.fixes += "fix even all balance 2 1.0 rcb\n";
     }},
    {"periodic box", "faces",
     [](Parts &p) {
       p.faces = "p f p";
       if (!p.walls.empty()) p.walls = "ylo slip";
     }},
};

#undef OPTION

constexpr int N = sizeof(choices) / sizeof(choices[0]);

/** Does it make no sense to choose both? Options of fix mpm are none of those in place of it. */
bool exclude(const Choice &a, const Choice &b)
{
  const auto is_option = [](const Choice &c) {
    return strncmp(c.name, "fix mpm ", 8) == 0;
  };
  return strcmp(a.kind, b.kind) == 0 || (is_option(a) && strcmp(b.kind, "motion") == 0) ||
      (is_option(b) && strcmp(a.kind, "motion") == 0);
}

/** What became of a scene. */
struct Outcome {
  std::string error, wrong;
  std::set<std::string> warnings;
  std::vector<Scene::State> state;
};

class Combinations : public ::testing::Test {
 protected:
  const ScratchFile ground2{"ground2.msh", block_mesh(2, 8, 5, 1, 1.0)},
      ground3{"ground3.msh", block_mesh(3, 8, 5, 4, 1.0)},
      bar2{"bar2.msh", block_mesh(2, 2, 2, 1, 1.0)}, bar3{"bar3.msh", block_mesh(3, 2, 2, 2, 1.0)},
      skin2{"skin2.msh", skin_mesh(2)}, skin3{"skin3.msh", skin_mesh(3)},
      cube{"cube.stl", binary_of(MPM_TEST::box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}))},
      history{"history.txt", "0 0\n0.02 1\n0.1 0\n"}, map{"map.txt", ""};

  std::string text(const std::vector<int> &chosen) const
  {
    Parts p;
    for (const int k : chosen)
      if (!strcmp(choices[k].kind, "rigid")) p.dim = 3;
    for (const int k : chosen) choices[k].add(p);
    std::string scene = p.scene();
    for (const auto &[word, file] :
         std::map<std::string, std::string>{{"GROUND", p.dim == 2 ? ground2.name : ground3.name},
                                            {"BAR", p.dim == 2 ? bar2.name : bar3.name},
                                            {"SKIN", p.dim == 2 ? skin2.name : skin3.name},
                                            {"CUBE", cube.name},
                                            {"HISTORY", history.name},
                                            {"MAP", map.name}})
      scene = replaced(scene, word, file);
    return scene;
  }

  Outcome outcome(const std::vector<int> &chosen) const
  {
    Outcome found;
    Scene run(MPI_COMM_SELF);
    const ScratchFile log("combination.log", MPI_COMM_SELF);
    const std::string input = text(chosen);
    found.error = run.error("log " + log.name + "\n" + input);
    if (found.error.empty()) {
      run.commands("log none\n");
      found.state = run.gather();
      for (const auto &s : found.state)
        for (const double *x = &s.tag; x <= &s.mass; x++)
          if (!std::isfinite(*x)) found.wrong = "a value is not finite";
      if (input.find("compute e") != std::string::npos &&
          input.find("mpm/implicit") == std::string::npos) {
        const double *e = run.compute_vector();
        double scale = 0.0;
        for (int k = 0; k < 12; k++) scale += k == 10 ? 0.0 : std::abs(e[k]);
        if (!(std::abs(e[10]) <= 1.0e-10 * scale))
          found.wrong = strprintf("residual %g of %g", e[10], scale);
      }
    }
    std::istringstream lines(file_text(log.name));
    for (std::string line; std::getline(lines, line);)
      if (line.rfind("WARNING: ", 0) == 0) found.warnings.insert(plain(line.substr(9)));
    found.error = plain(found.error);
    return found;
  }

  /** A message without numbers and without the line of the source. */
  static std::string plain(std::string message)
  {
    message = std::regex_replace(
        message,
        std::regex("ERROR( on proc \\d+)?: | \\(src/.*| \\([^ ]*/[^ ]*\\.cpp:\\d+\\).*|\n[^]*"),
        "");
    message =
        std::regex_replace(message, std::regex("test_combinations\\.\\S*\\.(\\w+\\.\\w+)"), "$1");
    message =
        std::regex_replace(message, std::regex("(ix mpm )(grid1|grid2|water|fine|far)\\b"), "$1ID");
    message = std::regex_replace(message, std::regex("(law|body)[1-9]"), "$1");
    return std::regex_replace(message, std::regex("-?\\b\\d+\\.?\\d*(e[-+]?\\d+)?\\b"), "N");
  }
};

TEST_F(Combinations, Alone)
{
  for (int k = 0; k < N; k++) {
    const Outcome found = outcome({k});
    EXPECT_EQ(found.error + found.wrong, "") << choices[k].name << "\n" << text({k});
  }
}

/** What the manual says of pairs: symbols by row and column, and messages with their pairs. */
struct Table {
  std::vector<std::string> rows = std::vector<std::string>(N);
  std::map<std::string, std::map<int, std::vector<int>>> refused, warned;

  /** + runs, w runs with a warning that neither has alone, = one changes nothing, x is refused. */
  char symbol(int a, int b, const Outcome &both, const std::vector<Outcome> &alone,
              const Outcome &none)
  {
    if (!both.error.empty()) {
      refused[both.error][a].push_back(b);
      return 'x';
    }
    char found = '+';
    for (const auto &words : both.warnings)
      if (!alone[a].warnings.count(words) && !alone[b].warnings.count(words)) {
        warned[words][a].push_back(b);
        found = 'w';
      }
    for (const int k : {a, b})
      if (identical(both.state, alone[k].state) && !identical(alone[a + b - k].state, none.state) &&
          found == '+')
        found = '=';
    return found;
  }

  std::string matrix() const
  {
    std::string tens, ones, text = ".. made by test_combinations\n\n.. code-block:: none\n\n";
    for (int k = 1; k <= N; k++) {
      tens += k < 10 ? ' ' : (char) ('0' + k / 10);
      ones += (char) ('0' + k % 10);
    }
    text += strprintf("   %32s%s\n   %32s%s\n", "", tens.c_str(), "", ones.c_str());
    for (int k = 0; k < N; k++)
      text += strprintf("   %2d %-28s %s\\\n", k + 1, choices[k].name, rows[k].c_str());
    return text;
  }

  /** A list of messages and their pairs. */
  static std::string list(const std::map<std::string, std::map<int, std::vector<int>>> &messages)
  {
    std::string text = ".. made by test_combinations\n\n";
    for (const auto &[message, pairs] : messages) {
      std::string item = "* ``" + message + "``", line;
      for (const auto &[a, others] : pairs) {
        item += strprintf("%s %d with", &pairs.at(a) == &pairs.begin()->second ? ":" : ";", a + 1);
        for (const int b : others) item += strprintf("%s %d", b == others[0] ? "" : ",", b + 1);
      }
      std::istringstream words(item);
      for (std::string word; words >> word;) {
        if (line.size() + word.size() > 98) {
          text += line + "\n";
          line = " ";
        }
        line += (line.empty() ? "" : " ") + word;
      }
      text += line + "\n";
    }
    return text;
  }
};

/** All pairs in the manual, or, where what takes long is left out, each seventh. */
TEST_F(Combinations, UpToDate)
{
  const bool some = is_quick() && !getenv("MPM_WRITE");
  const std::string known = text_of_file(MPM_SOURCE_DIR "/doc/src/combinations/matrix.inc");
  const Outcome none = outcome({});
  std::vector<Outcome> alone;
  for (int k = 0; k < N; k++) alone.push_back(outcome({k}));
  Table table;
  int left_out = 0;
  for (int a = 0; a < N; a++)
    for (int b = 0; b < a; b++) {
      if (exclude(choices[a], choices[b])) {
        table.rows[a] += '.';
        continue;
      }
      if (some && ++left_out % 7) {
        table.rows[a] += '?';
        continue;
      }
      SCOPED_TRACE(strprintf("%s + %s", choices[a].name, choices[b].name));
      const Outcome both = outcome({b, a});
      EXPECT_EQ(both.wrong, "") << text({b, a});
      table.rows[a] += table.symbol(a, b, both, alone, none);
    }
  if (!some) {
    expect_up_to_date("combinations",
                      {{"matrix.inc", table.matrix()},
                       {"refused.inc", Table::list(table.refused)},
                       {"warned.inc", Table::list(table.warned)}});
    return;
  }
  const std::string found = table.matrix();
  ASSERT_EQ(found.size(), known.size());
  for (std::size_t k = 0; k < found.size(); k++)
    EXPECT_TRUE(found[k] == known[k] || found[k] == '?')
        << found.substr(0, k).substr(found.rfind('\n', k)) << " " << found[k] << ", not "
        << known[k];
}

}    // namespace
