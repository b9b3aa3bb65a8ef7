// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart ranks
// mpi: 2
// timeout: 300

// Choices of all kinds: options of fix mpm, walls, bodies, laws, and commands between two runs.
// Each pair of them is refused with what to do instead, or is in a scene with some others that has
// the same result on one rank and on two, and after a restart file in the middle of the run.

#include "mesh/stl_testing.h"

#include "gtest/gtest.h"

#include <cmath>
#include <cstdlib>
#include <fstream>

using namespace MPM_TEST;

/** Where lines of a choice go: before the box; options of fix mpm; the law; fixes, which are
 *  defined again after a restart file; commands between two runs. */
enum Place { HEAD, OPTION, LAW, FIX, BETWEEN };

struct Choice {
  const char *name;
  const char *kind;    // of two choices of one kind, there is no pair
  Place place;
  const char *text;
  const char *needs_kind = "",
             *needs = "";    // option that it cannot be without, unless the other gives it
};

const Choice choices[] = {
    {"linear", "shape", OPTION, "shape linear"},
    {"cubic", "shape", OPTION, "shape cubic"},
    {"gimp", "shape", OPTION, "shape gimp"},
    {"cpgimp", "shape", OPTION, "shape cpgimp"},
    {"cpdi", "shape", OPTION, "shape cpdi"},
    {"cpdi2", "shape", OPTION, "shape cpdi2"},
    {"bernstein", "shape", OPTION, "shape bernstein", "frame", "frame total"},
    {"pic", "transfer", OPTION, "transfer pic"},
    {"flip", "transfer", OPTION, "transfer flip 0.99"},
    {"aflip", "transfer", OPTION, "transfer aflip 0.99"},
    {"tpic", "transfer", OPTION, "transfer tpic"},
    {"polypic", "transfer", OPTION, "transfer polypic"},
    {"xpic", "transfer", OPTION, "transfer xpic 2"},
    {"fmpm", "transfer", OPTION, "transfer fmpm 2"},
    {"usf", "scheme", OPTION, "scheme usf"},
    {"musl", "scheme", OPTION, "scheme musl"},
    {"usavg", "scheme", OPTION, "scheme usavg"},
    {"total", "frame", OPTION, "frame total"},
    {"update", "frame", OPTION, "frame total reference update 1.03"},
    {"gradient", "stress", OPTION, "stress gradient"},
    {"fbar", "locking", OPTION, "locking fbar"},
    {"both", "locking", OPTION, "locking both"},
    {"light", "light", OPTION, "light 0.5", "shape", "shape linear"},
    {"edges", "edges", OPTION, "edges modified", "transfer", "transfer flip 0.99"},
    {"every", "every", OPTION, "every 3"},
    {"axis", "axis", OPTION, "axisymmetric yes"},
    {"delete", "delete", OPTION, "bad delete failed delete"},
    {"damage", "law", LAW, "eos linear 20.0 strength elastic 8.0 damage rankine 1.0"},
    {"plastic", "law", LAW, "eos linear 20.0 strength j2 8.0 0.5 hardening linear 1.0"},
    {"fields", "bodies", FIX, ""},
    {"contact", "bodies", FIX, "fix touch all mpm/contact grid other\n"},
    {"elements", "elements", FIX, ""},
    {"grain", "grain", FIX, ""},
    {"map", "map", HEAD, "atom_modify map hash\ncomm_modify cutoff 1.5\n"},
    {"rigid", "rigid", FIX,
     "region tool mpm/mesh STL 1.0 2.0 3.7 2.0\nfix tool all mpm/rigid tool density 2.0 separate "
     "friction 0.2 velocity 0 -0.4 0.1 omega 0.1 0.2 0.1\n"},
    {"driven", "wall", FIX,
     "variable push equal 0.3*sin(0.2*step)\n"
     "fix w2 all mpm/boundary ylo slip velocity 0 v_push 0\n"},
    {"region", "wall", FIX,
     "variable down equal -0.02*step\n"
     "region die block INF INF 3.1 9 INF INF move NULL v_down NULL\n"
     "fix w2 all mpm/boundary ylo slip\nfix die all mpm/boundary region die slip\n"},
    {"friction", "wall", FIX, "fix w2 all mpm/boundary ylo separate friction 0.3\n"},
    {"ledger", "ledger", FIX, "compute e all mpm/energy\nthermo_style custom step c_e\n"},
    {"dt", "dt", FIX, "fix dt all mpm/dt 0.1 every 2\n"},
    {"balance", "comm", FIX, "comm_style tiled\nfix lb all balance 5 1.0 rcb\n"},
    {"delay", "neigh", FIX, "neigh_modify every 5 delay 5 check no\n"},
    {"deposit", "deposit", FIX,
     "region sky block 6 7.5 4 7.5 0.1 0.4\nfix rain all deposit 3 3 4 4711 region sky near 0.1\n"},
    {"create", "between", BETWEEN,
     "region more block 0 2 4 6 INF INF\n"
     "create_points 2 region more ppc 2\ngroup two type 2\ngroup bodies type 1 2\n"},
    {"remove", "between", BETWEEN,
     "region cut block 3 4 2 3 INF INF\ndelete_atoms region cut compress no\n"},
    {"box", "between", BETWEEN, "change_box all x final 0 10 y final 0 12\n"},
    {"runs", "between", BETWEEN, "run 2\nrun 0\nrun 1\n"},
    {"velocity", "between", BETWEEN, "velocity all ramp vx 0.0 0.4 y 0 3 sum yes units box\n"},
    {"displace", "between", BETWEEN, "displace_atoms all move 0 0.3 0\n"},
};

/** Which pairs are refused, and with which words. */
const struct {
  const char *some, *others, *words;
} refusals[] = {
    {"linear gimp cpgimp cpdi cpdi2 bernstein total update light", "polypic",
     "needs shape quadratic or cubic and frame updated"},
    {"gimp cpgimp cpdi cpdi2", "total update", "use B-splines with transfer apic or flip"},
    {"aflip tpic", "bernstein total update", "use B-splines with transfer apic or flip"},
    {"linear gimp cpgimp cpdi cpdi2 bernstein aflip tpic polypic xpic fmpm light", "edges",
     "use edges plain"},
    {"cubic gimp cpgimp cpdi cpdi2 bernstein total", "light", "remove light"},
    {"fbar both", "light", "use scheme musl"},
    {"fmpm", "usf musl usavg", "use scheme usl, or transfer xpic"},
    {"bernstein total update", "contact", "let bodies meet through a pair style"},
    {"bernstein total update", "region", "use stick velocity with variables"},
    {"bernstein total update", "friction", "use fix wall/gran or a pair style"},
    {"bernstein total update", "rigid", "use frame updated"},
    {"usf usavg", "contact friction rigid", "use usl or musl"},
    {"update", "driven", "use reference fixed"},
    {"fbar both", "elements", "use fix mpm/elements el locking fbar"},
    {"delete", "elements", "a fix mpm of their own"},
    {"every", "elements", "use every 1"},
    {"axis", "elements", "use create_points elements or region"},
    {"remove", "elements", "unfix it before"},
    {"axis", "grain", "let bodies meet through fix mpm/contact"},
    {"create", "grain", "define the fix after them"},
};

bool is_one_of(const char *name, const char *names)
{
  return (" " + std::string(names) + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

/** Words of the refusal of a pair, null: it is fine. */
const char *refusal(const Choice &a, const Choice &b)
{
  for (const auto &r : refusals)
    if ((is_one_of(a.name, r.some) && is_one_of(b.name, r.others)) ||
        (is_one_of(b.name, r.some) && is_one_of(a.name, r.others)))
      return r.words;
  return nullptr;
}

using Chosen = std::vector<const Choice *>;

bool has_kind(const Chosen &chosen, const char *kind)
{
  return std::any_of(chosen.begin(), chosen.end(), [&](const Choice *c) {
    return !strcmp(c->kind, kind);
  });
}

bool has(const Chosen &chosen, const char *name)
{
  return std::any_of(chosen.begin(), chosen.end(), [&](const Choice *c) {
    return !strcmp(c->name, name);
  });
}

std::string names(const Chosen &chosen)
{
  std::string text;
  for (const auto *c : chosen) text += (text.empty() ? "" : " + ") + std::string(c->name);
  return text;
}

std::string lines(const Chosen &chosen, Place place)
{
  std::string text;
  for (const auto *c : chosen)
    if (c->place == place) text += std::string(c->text) + (place == OPTION ? " " : "");
  return text;
}

/** A scene with choices: what comes before the first run, after a restart, and between two runs. */
struct Combination {
  std::string scene, again, between;

  Combination(int dim, const Chosen &chosen, const std::string &mesh, const std::string &stl)
  {
    std::string options = lines(chosen, OPTION), law = lines(chosen, LAW);
    for (const auto *c : chosen)
      if (*c->needs && !has_kind(chosen, c->needs_kind)) options += std::string(c->needs) + " ";
    if (law.empty()) law = "neohookean 10.0 0.3";
    const bool two = has_kind(chosen, "bodies"), grain = has(chosen, "grain");
    const bool meshed = has(chosen, "elements");

    scene = strprintf("units lj\ndimension %d\nboundary f f p\natom_style %s\n"
                      "region box block 0 8 0 8 %s\n%screate_box 3 box\nneighbor 0.3 bin\n"
                      "fix lattice all mpm 1.0 %s\n",
                      dim, grain ? "hybrid sphere mpm" : "mpm", dim == 3 ? "0 4" : "-0.5 0.5",
                      lines(chosen, HEAD).c_str(), options.c_str());
    scene += meshed ? "create_points 1 mesh " + mesh + "\n"
                    : "region one block 0 4 0 3 INF INF\ncreate_points 1 region one ppc 2\n";
    if (two) scene += "region two block 4 6 0 3 INF INF\ncreate_points 2 region two ppc 2\n";
    if (grain)
      scene += strprintf("create_atoms 3 single 2.2 4.1 %d\nset type 3 diameter 2 density 1\n"
                         "group grains type 3\n",
                         dim == 3 ? 2 : 0);
    scene += "unfix lattice\ngroup one type 1\ngroup two type 2\ngroup bodies type 1 2\n"
             "velocity bodies ramp vx 0.0 0.6 x 0 4 units box\n"
             "velocity bodies ramp vy 0.2 -0.5 y 0 3 sum yes units box\n"
             "velocity bodies ramp vy 0.0 0.2 x 0 4 sum yes units box\n";
    if (two) scene += "velocity two set -0.3 0 0 sum yes units box\n";

    again = "fix grid " + std::string(two ? "one" : "bodies") + " mpm 1.0 " + options + "\n";
    if (two) again += "fix other two mpm 1.0 " + options + "\n";
    again +=
        "fix m bodies mpm/material density 1.0 " + law + "\nfix w1 all mpm/boundary xlo slip\n";
    if (!has_kind(chosen, "wall")) again += "fix w2 all mpm/boundary ylo slip\n";
    if (meshed) again += "fix el one mpm/elements " + mesh + "\n";
    if (grain)
      again += strprintf("comm_modify vel yes\npair_style granular\n"
                         "pair_coeff * * hertz 20.0 0.1 tangential linear_nohistory 5.0 0.5\n"
                         "fix move grains nve/sphere %s\n"
                         "neigh_modify exclude type 1 1 exclude type 1 2 exclude type 2 2\n"
                         "fix skin bodies mpm/surface\n",
                         dim == 2 ? "disc" : "");
    again += lines(chosen, FIX) + "timestep 0.02\nthermo 1000\n";
    again = replaced(again, "STL", stl);
    scene += again;
    again = "neighbor 0.3 bin\n" + again;
    between = lines(chosen, BETWEEN);
    if (!between.empty())
      between = "run 0\n" + between;    // some must not follow read_restart at once
  }
};

/** Sets of choices, none of which is refused, with all pairs that are not. */
std::vector<Chosen> covering(const std::vector<const Choice *> &all)
{
  constexpr std::size_t MOST = 9;
  std::vector<std::pair<const Choice *, const Choice *>> left;
  for (const auto *a : all)
    for (const auto *b : all)
      if (a < b && strcmp(a->kind, b->kind) != 0 && !refusal(*a, *b)) left.emplace_back(a, b);
  std::vector<Chosen> sets;
  while (!left.empty()) {
    Chosen set = {left.front().first, left.front().second};
    for (;;) {
      const Choice *best = nullptr;
      int most = 0;
      for (const auto *c : all) {
        if (has_kind(set, c->kind)) continue;
        bool fits = true;
        for (const auto *d : set) fits = fits && !refusal(*c, *d);
        Chosen with = set;
        with.push_back(c);
        // of no use with flip and musl together
        if (has(with, "light") && has_kind(with, "transfer") && has_kind(with, "scheme"))
          fits = false;
        if (has(with, "light") && has(with, "axis") && has(with, "usf")) fits = false;
        if (!fits) continue;
        int gain = 0;
        for (const auto &p : left)
          for (const auto *d : set)
            gain += (p.first == c && p.second == d) || (p.first == d && p.second == c);
        if (gain > most) {
          most = gain;
          best = c;
        }
      }
      if (!best || set.size() == MOST) break;
      set.push_back(best);
    }
    left.erase(std::remove_if(left.begin(), left.end(),
                              [&](const auto &p) {
                                return has(set, p.first->name) && has(set, p.second->name);
                              }),
               left.end());
    sets.push_back(set);
  }
  return sets;
}

/** 4 x 3 (x 4) cells as elements. */
std::string box_mesh(int dim)
{
  const int nx = 4, ny = 3, nz = dim == 3 ? 4 : 0, sy = nx + 1, sz = sy * (ny + 1);
  std::string nodes, elements;
  int nnode = 0, nelement = 0;
  for (int k = 0; k <= nz; k++)
    for (int j = 0; j <= ny; j++)
      for (int i = 0; i <= nx; i++)    // inside the box and off its rank boundaries
        nodes += strprintf("%d %.3f %.3f %.3f\n", ++nnode, 0.05 + 0.98 * i, 0.05 + 0.98 * j,
                           dim == 3 ? 0.1 + 0.9 * k : 0.0);
  for (int k = 0; k < std::max(1, nz); k++)
    for (int j = 0; j < ny; j++)
      for (int i = 0; i < nx; i++) {
        const int c = 1 + i + j * sy + k * sz;
        elements += strprintf("%d %d 2 1 1 %d %d %d %d", ++nelement, dim == 2 ? 3 : 5, c, c + 1,
                              c + 1 + sy, c + sy);
        if (dim == 3)
          elements += strprintf(" %d %d %d %d", c + sz, c + 1 + sz, c + 1 + sy + sz, c + sy + sz);
        elements += "\n";
      }
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(nnode) + "\n" + nodes +
      "$EndNodes\n$Elements\n" + std::to_string(nelement) + "\n" + elements + "$EndElements\n";
}

/** Write scene k as an input for bench/same_bits.py: the whole run, and again from its middle. */
void write_scene(const std::string &folder, int dim, int k, const Chosen &chosen)
{
  const std::string mesh = strprintf("box%d.msh", dim), stl = "box.stl";
  const Combination c(dim, chosen, mesh, stl);
  const std::string rest = c.between + "run 12\nstate_hash\n";
  const auto write = [&](const std::string &name, const std::string &text) {
    std::ofstream(folder + "/" + name, std::ios::binary) << text;
  };
  write(mesh, box_mesh(dim));
  write(stl, binary_of(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})));
  write(strprintf("pairs-%dd-%03d.in", dim, k),
        "# " + names(chosen) + "\n" + c.scene + "run 8\nwrite_restart middle\n" + rest +
            "clear\nread_restart middle\n" + c.again + rest);
}

/** Does the map from IDs find all atoms, and nothing twice? (Chains of copies must end.) */
void check_map(Scene &run)
{
  auto *atom = run.lmp->atom;
  if (atom->map_style == Atom::MAP_NONE) return;
  const int n = atom->nlocal + atom->nghost;
  for (int i = 0; i < atom->nlocal; i++) {
    int j = atom->map(atom->tag[i]), count = 0;
    bool found = false;
    for (; j >= 0 && count <= n; j = atom->sametag[j], count++) {
      found = found || j == i;
      ASSERT_EQ(atom->tag[j], atom->tag[i]);
    }
    ASSERT_TRUE(found && count <= n);
  }
  for (tagint tag = 1; tag <= atom->map_tag_max; tag++) {    // and none that are gone
    const int j = atom->map(tag);
    ASSERT_TRUE(j < 0 || (j < n && atom->tag[j] == tag)) << tag;
  }
}

class Pairs : public ::testing::TestWithParam<int> {
 protected:
  std::vector<const Choice *> all() const
  {
    std::vector<const Choice *> list;
    for (const auto &c : choices)
      if (strcmp(c.name, GetParam() == 3 ? "axis" : "rigid") != 0) list.push_back(&c);
    return list;
  }
  Chosen named(const char *names) const
  {
    Chosen chosen;
    for (const auto *c : all())
      if (is_one_of(c->name, names)) chosen.push_back(c);
    return chosen;
  }
  const ScratchFile mesh{"box.msh", box_mesh(GetParam())};
  const ScratchFile stl{"box.stl", binary_of(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}))};
};

TEST_P(Pairs, Agree)
{
  if (const char *folder = getenv("MPM_WRITE_SCENES")) {    // instead of the test
    int k = 0;
    for (const auto &chosen : covering(all())) write_scene(folder, GetParam(), ++k, chosen);
    return;
  }
  double deleted = 0.0, deleted_with_map = 0.0;
  auto sets = covering(all());
  // the first ones have most of the pairs
  if (GetParam() == 3 && is_quick()) sets.resize(sets.size() / 2);
  sets.push_back(named("delete damage map"));    // whatever else is with these, points must go
  for (const auto &chosen : sets) {
    SCOPED_TRACE(names(chosen));
    const Combination c(GetParam(), chosen, mesh.name, stl.name);
    const std::string rest = c.between + "run 12\n";
    Scene serial(MPI_COMM_SELF);
    const auto found = serial.error(c.scene + "run 8\n" + rest);
    ASSERT_EQ(found, "");
    const ScratchFile file("restart");
    Scene whole, again;
    whole.commands(c.scene + "run 8\nwrite_restart " + file.name + "\n" + rest);
    again.commands("read_restart " + file.name + "\n" + c.again + rest);

    const auto expected = whole.gather();
    // failed material has no stress but round-off, which is compared with its strength
    const double strength = has(chosen, "damage") ? 1.0 : 1.0e-300;
    const double ranks = has(chosen, "grain") ? 1.0e-9 : 1.0e-11;
    EXPECT_LT(difference(serial.gather(), expected, strength), ranks);
    // LAMMPS does not keep the borders of ranks that fix balance has moved
    if (has(chosen, "balance"))
      EXPECT_LT(difference(again.gather(), expected, strength), ranks);
    else
      EXPECT_TRUE(identical(again.gather(), expected)) << difference(again.gather(), expected);
    check_map(whole);
    if (has(chosen, "delete")) {
      const double n = whole.fix_vector("grid", 7)[6];
      deleted += n;
      if (has(chosen, "map")) deleted_with_map += n;
    }
    double strain = 0.0;
    for (const auto &s : expected) strain = std::max(strain, std::abs(s.F[0] - 1.0));
    EXPECT_GT(strain, 1.0e-3);
  }
  EXPECT_GT(deleted, 0.0);
  EXPECT_GT(deleted_with_map, 0.0);
}

TEST_P(Pairs, AreRefused)
{
  const auto list = all();
  for (const auto *a : list)
    for (const auto *b : list) {
      const char *words = a < b && strcmp(a->kind, b->kind) != 0 ? refusal(*a, *b) : nullptr;
      if (!words) continue;
      const Combination c(GetParam(), {a, b}, mesh.name, stl.name);
      Scene serial(MPI_COMM_SELF);
      EXPECT_THAT(serial.error(c.scene + "run 0\n" + c.between + "run 0\n"),
                  ::testing::HasSubstr(words))
          << a->name << " + " << b->name;
    }
}

INSTANTIATE_TEST_SUITE_P(Dimension, Pairs, ::testing::Values(2, 3));
