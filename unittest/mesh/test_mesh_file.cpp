// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: unit
// mpi: 1 3

// One mesh in the files of several programs: the same points, and what the file says of them.

#include "mesh/mesh_file.h"
#include "mpm_lammps.h"

#include <sstream>

using namespace MPM_TEST;

namespace {

// a cube with a corner pulled out, V = 1.25, and a tetrahedron on its side, V = 1/6
const double nodes[9][3] = {{0, 0, 0}, {1, 0, 0},       {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
                            {1, 0, 1}, {1.5, 1.3, 1.2}, {0, 1, 1}, {-1, 0, 0}};
const int cube[8] = {0, 1, 2, 3, 4, 5, 6, 7}, tet[4] = {0, 3, 4, 8};
constexpr double VOLUME = 1.25 + 1.0 / 6.0;

/** Numbers as words, or as bytes in one of the two orders. */
struct Output {
  enum Kind { TEXT, LITTLE, BIG } kind;
  std::string all;
  template <class T> void put(T value)
  {
    if (kind == TEXT) {
      std::ostringstream word;
      word.precision(17);
      word << value << " ";
      all += word.str();
      return;
    }
    char raw[sizeof(T)];
    memcpy(raw, &value, sizeof(T));
    if (kind == BIG) std::reverse(raw, raw + sizeof(T));
    all.append(raw, sizeof(T));
  }
  void i(int value) { put((int32_t) value); }
  void l(int64_t value) { put(value); }
  void x(const double *p)
  {
    for (int d = 0; d < 3; d++) put(p[d]);
  }
};

std::string gmsh(bool old, Output::Kind kind)
{
  Output o{kind, strprintf("$MeshFormat\n%s %d 8\n", old ? "2.2" : "4.1", kind != Output::TEXT)};
  if (kind != Output::TEXT) {
    o.i(1);
    o.all += "\n";
  }
  o.all +=
      "$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"core\"\n3 2 \"side part\"\n$EndPhysicalNames\n";
  if (old) {
    o.all += "$Nodes\n9\n";
    for (int n = 0; n < 9; n++) {
      o.i(n + 1);
      o.x(nodes[n]);
    }
    o.all += "\n$EndNodes\n$Elements\n2\n";
    for (const bool first : {true, false}) {
      const int number = first ? 1 : 2, type = first ? 5 : 4;
      if (kind == Output::TEXT)
        for (const int v : {number, type, 2}) o.i(v);
      else
        for (const int v : {type, 1, 2, number}) o.i(v);
      o.i(number);
      o.i(number);
      for (int k = 0; k < (first ? 8 : 4); k++) o.i((first ? cube : tet)[k] + 1);
    }
  } else {
    o.all += "$Entities\n";
    for (const int n : {0, 0, 0, 2}) o.l(n);
    for (const int n : {1, 2}) {
      o.i(n);
      o.x(nodes[0]);
      o.x(nodes[6]);
      o.l(1);
      o.i(n);
      o.l(0);
    }
    o.all += "\n$EndEntities\n$Nodes\n";
    for (const int n : {1, 9, 1, 9}) o.l(n);
    for (const int n : {3, 1, 0}) o.i(n);
    o.l(9);
    for (int n = 0; n < 9; n++) o.l(n + 1);
    for (const auto &x : nodes) o.x(x);
    o.all += "\n$EndNodes\n$Elements\n";
    for (const int n : {2, 2, 1, 2}) o.l(n);
    for (const bool first : {true, false}) {
      for (const int n : {3, first ? 1 : 2, first ? 5 : 4}) o.i(n);
      o.l(1);
      o.l(first ? 1 : 2);
      for (int k = 0; k < (first ? 8 : 4); k++) o.l((first ? cube : tet)[k] + 1);
    }
  }
  return o.all + "\n$EndElements\n";
}

std::string vtk(bool old, Output::Kind kind)
{
  Output o{kind, old ? "# vtk DataFile Version 3.0\n" : "# vtk DataFile Version 5.1\n"};
  o.all += std::string("title\n") + (kind == Output::TEXT ? "ASCII" : "BINARY") +
      "\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n";
  for (const auto &x : nodes) o.x(x);
  if (old) {
    o.all += "\nCELLS 2 14\n";
    o.i(8);
    for (const int n : cube) o.i(n);
    o.i(4);
    for (const int n : tet) o.i(n);
  } else {
    o.all += "\nCELLS 3 12\nOFFSETS vtktypeint64\n";
    for (const int n : {0, 8, 12}) o.l(n);
    o.all += "\nCONNECTIVITY vtktypeint64\n";
    for (const int n : cube) o.l(n);
    for (const int n : tet) o.l(n);
  }
  o.all += "\nCELL_TYPES 2\n";
  o.i(12);
  o.i(10);
  o.all += "\nPOINT_DATA 9\nSCALARS number float 1\nLOOKUP_TABLE default\n";
  for (int n = 0; n < 9; n++) o.put((float) n);
  o.all += "\nCELL_DATA 2\nVECTORS speed double\n";
  for (const double v : {1.0, 2.0, 3.0, -4.0, -5.0, -6.0}) o.put(v);
  o.all += "\nFIELD more 1\nlabel 1 2 int\n";
  o.i(7);
  o.i(9);
  return o.all + "\n";
}

std::string abaqus()
{
  std::string s = "** a comment\n*Heading\n text, 1, 2\n*Node\n";
  for (int n = 0; n < 9; n++)
    s += strprintf("%d, %.17g, %.17g, %.17g\n", n + 1, nodes[n][0], nodes[n][1], nodes[n][2]);
  return s +
      "*ELSET, elset=All, generate\n1, 2, 1\n"
      "*Element, type=C3D8R, elset=core\n1, 1, 2, 3, 4,\n 5, 6, 7, 8\n"
      "*Element, type=C3D4\n2, 1, 4, 5, 9\n*Elset, elset=side\n2,\n"
      "*Material, name=m\n*Elastic\n1.0, 0.3\n";
}

const std::string space_2 = space("lj", "f f f", "-2 4 -2 4 -2 4", 2);

std::string make(const std::string &file, const std::string &style, const std::string &more = "")
{
  return "create_points 1 " + style + " " + file + " " + more + "\nset group all mass 1.0\nrun 0\n";
}

std::string failure(const std::string &text)
{
  const ScratchFile file("bad.mesh", text);
  try {
    MPM_NS::read_mesh(file.name);
  } catch (const std::runtime_error &e) {
    return e.what();
  }
  return "";
}

TEST(MeshFile, AllFormatsGiveTheSamePoints)
{
  const std::vector<std::string> texts = {gmsh(true, Output::TEXT),
                                          gmsh(true, Output::LITTLE),
                                          gmsh(true, Output::BIG),
                                          gmsh(false, Output::TEXT),
                                          gmsh(false, Output::LITTLE),
                                          gmsh(false, Output::BIG),
                                          vtk(true, Output::TEXT),
                                          vtk(true, Output::BIG),
                                          vtk(false, Output::TEXT),
                                          vtk(false, Output::BIG),
                                          abaqus()};
  for (const std::string style : {"mesh", "elements"}) {
    std::vector<Scene::State> first;
    for (std::size_t k = 0; k < texts.size(); k++) {
      const ScratchFile file("one.mesh", texts[k]);
      Scene run(space_2 + make(file.name, style));
      const auto points = run.gather();
      if (k == 0) first = points;
      EXPECT_TRUE(identical(points, first)) << style << " " << k;
      double volume = 0.0;
      for (const auto &p : points) volume += p.vol;
      EXPECT_NEAR(volume, VOLUME, 1.0e-12 * VOLUME);
    }
    EXPECT_EQ(first.size(), style == "mesh" ? 9u : 2u);
  }
}

TEST(MeshFile, TypesAndGroups)
{
  for (const bool inp : {false, true}) {
    const ScratchFile file("groups.mesh", inp ? abaqus() : gmsh(true, Output::LITTLE));
    Scene run(space_2 + make(file.name, "elements", "groups physical"));
    EXPECT_EQ(run.evaluate("count(core)"), 1.0);
    EXPECT_EQ(run.evaluate(inp ? "count(side)" : "count(side_part)"), 1.0);
    if (inp) EXPECT_EQ(run.evaluate("count(All)"), 2.0);
    Scene part(space_2 + make(file.name, "elements", inp ? "part All" : "part core"));
    EXPECT_EQ(part.lmp->atom->natoms, inp ? 2 : 1);
  }
  const ScratchFile file("types.mesh", gmsh(false, Output::TEXT)), two("two.mesh", abaqus());
  Scene run(space_2 + make(file.name, "elements", "types physical"));
  const auto points = run.gather();
  EXPECT_EQ(points[0].type, 1.0);
  EXPECT_EQ(points[1].type, 2.0);
  expect_error(space_2 + make(file.name, "mesh", "types physical"), "would have two types");
  expect_error(space_2 + make(two.name, "elements", "types physical"), "in the sets");
}

TEST(MeshFile, DataBecomeFields)
{
  for (const auto kind : {Output::TEXT, Output::BIG}) {
    const ScratchFile file("data.mesh", vtk(kind == Output::TEXT, kind));
    Scene run(space_2 + "fix p all property/atom d_n i_l\n" +
              make(file.name, "elements", "data speed velocity data label i_l"));
    const auto points = run.gather();
    for (int d = 0; d < 3; d++) {
      EXPECT_EQ(points[0].v[d], 1.0 + d);
      EXPECT_EQ(points[1].v[d], -4.0 - d);
    }
    run.commands("compute q all property/atom i_l\ncompute s all reduce sum c_q\nthermo_style "
                 "custom step c_s\nrun 0\n");
    EXPECT_EQ(run.evaluate("c_s"), 16.0);
    Scene at_nodes(space_2 + "fix p all property/atom d_n\n" +
                   make(file.name, "mesh", "data number d_n"));
    at_nodes.commands("compute q all property/atom d_n\ncompute s all reduce sumsq "
                      "c_q\nthermo_style custom step c_s\nrun 0\n");
    EXPECT_EQ(at_nodes.evaluate("c_s"), 204.0);
    for (const Mistake &m :
         std::vector<Mistake>{{"data none velocity", "no data none"},
                              {"data number velocity", "data of this name for nodes"},
                              {"data speed d_n", "d_n"},
                              {"data label velocity", "components"}})
      expect_error(space_2 + make(file.name, "elements", m.lines), m.message);
  }
}

SERIAL_TEST(MeshFile, RefusesMistakes)
{
  for (const bool old : {true, false}) {
    const std::string whole = gmsh(old, Output::LITTLE);
    EXPECT_THAT(failure(whole.substr(0, whole.size() - 40)), HasSubstr("ends too early"));
    std::string no_order = whole;
    no_order[no_order.find('\n', 13) + 1] = 5;
    EXPECT_THAT(failure(no_order), HasSubstr("order of bytes"));
  }
  const std::string bytes = vtk(true, Output::BIG), head = bytes.substr(0, 40);
  EXPECT_THAT(failure(bytes.substr(0, 200)), HasSubstr("ends too early"));
  const std::string text = vtk(true, Output::TEXT);
  EXPECT_THAT(failure(replaced(text, "1.5", "nan")), HasSubstr("not finite"));
  EXPECT_THAT(failure(replaced(text, "UNSTRUCTURED_GRID", "POLYDATA")), HasSubstr("UNSTRUCTURED"));
  EXPECT_THAT(failure(replaced(text, "12 10", "13 10")), HasSubstr("VTK's type 13"));
  EXPECT_THAT(failure(replaced(text, "0 3 4 8", "0 3 4 9")), HasSubstr("has the point 9"));
  EXPECT_THAT(failure(replaced(text, "POINTS 9", "POINTS 99999999999")), HasSubstr("not a count"));
  EXPECT_THAT(failure("<VTKFile>\n"), HasSubstr("legacy file"));
  const std::string inp = abaqus();
  EXPECT_THAT(failure(replaced(inp, "C3D8R", "C3D20")), HasSubstr("'C3D20' are not supported"));
  EXPECT_THAT(failure(replaced(inp, "1, 4, 5, 9", "1, 4, 5, 99")), HasSubstr("node 99"));
  EXPECT_THAT(failure(replaced(inp, " 5, 6, 7, 8", " 5, 6, 7")), HasSubstr("too few nodes"));
  EXPECT_THAT(failure(replaced(inp, "*Heading", "*Include, input=x")), HasSubstr("*INCLUDE"));
  EXPECT_THAT(failure(replaced(inp, "1.5", "1.5e999")), HasSubstr("is not a coordinate"));
  EXPECT_THAT(failure(""), HasSubstr("not a mesh file of Gmsh"));
}

}    // namespace
