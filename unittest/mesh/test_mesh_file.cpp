// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit ranks
// mpi: 1 3

// One mesh in the files of several programs: the same points, and what the file says of them.

#include "mesh/element.h"
#include "mesh/mesh_file.h"
#include "mesh_testing.h"

using namespace MPM_TEST;

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

/** A cube whose top is turned by an angle about its center and shrunk. */
std::string turned_cube(double angle, double top)
{
  std::string text =
      "# vtk DataFile Version 3.0\ncube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
  for (int n = 0; n < 8; n++) {
    double x = nodes[n % 4][0] - 0.5, y = nodes[n % 4][1] - 0.5;
    if (n > 3) {
      const double c = top * std::cos(angle), s = top * std::sin(angle), was = x;
      x = c * was - s * y;
      y = s * was + c * y;
    }
    text += strprintf("%.17g %.17g %d\n", x, y, n / 4);
  }
  return text + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n";
}

// sides that are no planes: the integral of the sections
TEST(MeshFile, VolumesOfTwistedElements)
{
  const double pi = 3.14159265358979323846;
  // section at z: the corner goes along a line, distance squared (1-z)^2 + 2 z (1-z) s c + z^2 s^2
  const auto exact = [](double angle, double s) {
    return (1.0 + s * std::cos(angle) + s * s) / 3.0;
  };
  EXPECT_NEAR(exact(pi / 4, 1.0), 0.9023689271, 1e-10);
  EXPECT_NEAR(exact(0.0, 0.5), 0.5833333, 1e-7);
  for (const auto &[angle, top] : {std::pair<double, double>{pi / 4, 1.0}, {0.0, 0.5}, {0.3, 0.7}})
    for (const std::string style : {"mesh", "elements"}) {
      const ScratchFile file("cube.vtk", turned_cube(angle, top));
      Scene run(space_2 + make(file.name, style));
      double volume = 0.0;
      for (const auto &p : run.gather()) volume += p.vol;
      EXPECT_NEAR(volume, exact(angle, top), 1e-12) << style << " " << angle << " " << top;
    }
}

// gradients of nodes that are a turned frame, each axis of another length
TEST(ElementRule, LargestEigenvalue)
{
  const double c = std::cos(0.7), s = std::sin(0.7), C = std::cos(0.4), S = std::sin(0.4);
  const double axis[3][3] = {{c * C, s * C, S}, {-s, c, 0.0}, {-c * S, -s * S, C}};
  for (const auto &squares :
       {std::array{1.0, 2.0, 5.0}, std::array{5.0, 2.0, 1.0}, std::array{4.0, 4.0, 1.0},
        std::array{1.0, 4.0, 4.0}, std::array{3.0, 1e-3, 1e-3}, std::array{2.0, 2.0, 2.0}}) {
    double g[4][3] = {{0.0}};
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < 3; d++) g[k][d] = std::sqrt(squares[k]) * axis[k][d];
    const auto &rule = MPM_NS::ElementRule::of(MPM_NS::ElementType::TETRAHEDRON);
    EXPECT_NEAR(rule.largest_eigenvalue(g) / *std::max_element(squares.begin(), squares.end()), 1.0,
                1e-7);
  }
}

TEST(MeshFile, AllFormatsGiveTheSamePoints)
{
  const std::vector<std::string> texts = {gmsh(true, MeshOutput::TEXT),
                                          gmsh(true, MeshOutput::LITTLE),
                                          gmsh(true, MeshOutput::BIG),
                                          gmsh(false, MeshOutput::TEXT),
                                          gmsh(false, MeshOutput::LITTLE),
                                          gmsh(false, MeshOutput::BIG),
                                          vtk(true, MeshOutput::TEXT),
                                          vtk(true, MeshOutput::BIG),
                                          vtk(false, MeshOutput::TEXT),
                                          vtk(false, MeshOutput::BIG),
                                          vtu("ascii"),
                                          vtu("binary"),
                                          vtu("base64"),
                                          vtu("raw"),
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
    const ScratchFile file("groups.mesh", inp ? abaqus() : gmsh(true, MeshOutput::LITTLE));
    Scene run(space_2 + make(file.name, "elements", "groups physical"));
    EXPECT_EQ(run.evaluate("count(core)"), 1.0);
    EXPECT_EQ(run.evaluate(inp ? "count(side)" : "count(side_part)"), 1.0);
    if (inp) EXPECT_EQ(run.evaluate("count(All)"), 2.0);
    Scene part(space_2 + make(file.name, "elements", inp ? "part All" : "part core"));
    EXPECT_EQ(part.lmp->atom->natoms, inp ? 2 : 1);
  }
  const ScratchFile file("types.mesh", gmsh(false, MeshOutput::TEXT)), two("two.mesh", abaqus());
  Scene run(space_2 + make(file.name, "elements", "types physical"));
  const auto points = run.gather();
  EXPECT_EQ(points[0].type, 1.0);
  EXPECT_EQ(points[1].type, 2.0);
  expect_error(space_2 + make(file.name, "mesh", "types physical"), "would have two types");
  expect_error(space_2 + make(two.name, "elements", "types physical"), "in the sets core and All");
}

// parts of Abaqus are where instances put them; sets of parts: of all, of the assembly: of one
TEST(MeshFile, PartsOfAbaqus)
{
  const std::string cube = "*PART, NAME=Cube\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,2\n"
                           "6,1,0,2\n7,1,1,2\n8,0,1,2\n*ELEMENT, TYPE=C3D8, ELSET=all\n"
                           "1, 1,2,3,4,5,6,7,8\n*END PART\n",
                    tet = "*Part, name=Tet\n*Node\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n"
                          "*Element, type=C3D4, elset=all\n1, 1,2,3,4\n*End Part\n",
                    assembly = "*Assembly, name=a\n*Instance, name=c-1, part=Cube\n*End Instance\n"
                               "*Instance, name=c-2, part=CUBE\n0, 0, 3\n0, 0, 3, 1, 0, 3, 90\n"
                               "*End Instance\n*Instance, name=t-1, part=tet\n5, 0, 0\n"
                               "*End Instance\n*Node\n1, 9, 9, 9\n*Elset, elset=one, instance=c-2\n"
                               "1\n*Elset, elset=two\none, t-1\n*End Assembly\n";
  const std::string space = box(3, "si", "f f f", "-4 7 -4 7 -4 7", 1, 0.2);
  const auto scene = [&](const std::string &text) {
    const ScratchFile file("parts.inp", text);
    return std::make_unique<Scene>(space + make(file.name, "elements", "groups physical"));
  };
  const auto run = scene(cube + tet + assembly);
  const auto points = run->gather();
  ASSERT_EQ(points.size(), 3u);
  // the second one is moved to z from 3 to 5, and lies then along -y
  const double centres[3][3] = {{0.5, 0.5, 1.0}, {0.5, -1.0, 3.5}, {5.25, 0.25, 0.25}};
  const double volumes[3] = {2.0, 2.0, 1.0 / 6.0};
  for (int k = 0; k < 3; k++) {
    EXPECT_NEAR(points[k].vol, volumes[k], 1e-14);
    for (int d = 0; d < 3; d++) EXPECT_NEAR(points[k].x[d], centres[k][d], 1e-14) << k << d;
  }
  for (const auto &[group, count] :
       {std::pair("all", 3.0), std::pair("c-2", 1.0), std::pair("one", 1.0), std::pair("two", 2.0)})
    EXPECT_EQ(run->evaluate(strprintf("count(%s)", group)), count) << group;
  EXPECT_EQ(scene(cube + tet)->gather().size(), 2u) << "each part once";

  const auto failure = [&](const std::string &text) {
    const ScratchFile file("bad.inp", text);
    Scene bad;
    return bad.error(space + make(file.name, "elements"));
  };
  const std::string good = cube + tet + assembly;
  EXPECT_THAT(failure(replaced(good, "part=tet", "part=ball")), HasSubstr("no part ball"));
  EXPECT_THAT(failure(replaced(good, "instance=c-2", "instance=d")), HasSubstr("no instance d"));
  EXPECT_THAT(failure(replaced(good, "one, t-1", "1")),
              HasSubstr("of an instance it does not name"));
  EXPECT_THAT(failure(replaced(good, "one, t-1", "none")), HasSubstr("'none', which is not"));
  EXPECT_THAT(failure(replaced(good, "1, 0, 3, 90", "1, 0, 3")), HasSubstr("seven of a rotation"));
  EXPECT_THAT(failure(replaced(good, "1, 0, 3, 90", "0, 0, 3, 90")), HasSubstr("no direction"));
  EXPECT_THAT(failure(replaced(good, "5, 0, 0", "x, 0, 0")), HasSubstr("'x' is not a number"));
  EXPECT_THAT(failure(cube + cube), HasSubstr("defined twice"));
}

TEST(MeshFile, DataBecomeFields)
{
  for (const std::string &text : {vtk(true, MeshOutput::TEXT), vtk(false, MeshOutput::BIG),
                                  vtu("ascii"), vtu("binary"), vtu("raw")}) {
    const ScratchFile file("data.mesh", text);
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

// $ElementData and $NodeData of Gmsh, in all its formats
TEST(MeshFile, DataOfGmsh)
{
  const auto section = [](const std::string &kind, const std::string &name, int width,
                          const std::vector<int> &labels, MeshOutput::Kind output) {
    MeshOutput o{output,
                 strprintf("$%s\n1\n\"%s\"\n1\n0.5\n3\n7\n%d\n%d\n", kind.c_str(), name.c_str(),
                           width, (int) labels.size())};
    for (const int label : labels) {
      o.i(label);
      for (int k = 0; k < width; k++) o.put((label + 0.25 * k) * (k % 2 ? -1.0 : 1.0));
    }
    return o.all + "\n$End" + kind + "\n";
  };
  for (const bool old : {true, false})
    for (const auto kind : {MeshOutput::TEXT, MeshOutput::LITTLE, MeshOutput::BIG}) {
      // an order of its own, and numbers of elements that are left out
      const std::string speed = section("ElementData", "the speed", 3, {2, 77, 1}, kind),
                        number =
                            section("NodeData", "number", 1, {9, 1, 2, 3, 4, 5, 6, 7, 8}, kind),
                        part = section("ElementData", "part", 1, {2}, kind);
      const ScratchFile file("data.mesh", gmsh(old, kind) + number + speed + part);
      Scene run(space_2 + make(file.name, "elements", "data 'the speed' velocity"));
      const auto points = run.gather();
      for (int p = 0; p < 2; p++) {
        EXPECT_EQ(points[p].v[0], p + 1.0);
        EXPECT_EQ(points[p].v[1], -p - 1.25);
        EXPECT_EQ(points[p].v[2], p + 1.5);
      }
      Scene at_nodes(space_2 + "fix p all property/atom d_n\n" +
                     make(file.name, "mesh", "data number d_n factor number 2") +
                     "\nvariable w atom id*d_n\ncompute s all reduce sum v_w\n"
                     "thermo_style custom step c_s\nrun 0\n");
      EXPECT_EQ(at_nodes.evaluate("c_s"), 2.0 * 285.0);
      const std::string scene = space_2 + "fix p all property/atom d_n\n";
      expect_error(scene + make(file.name, "elements", "data part d_n"), "missing");
      const ScratchFile twice("twice.mesh", gmsh(old, kind) + part + number + part);
      expect_error(scene + make(twice.name, "elements", "data part d_n"), "of several steps");
      Scene not_used(space_2 + make(twice.name, "elements"));
      EXPECT_EQ(not_used.lmp->atom->natoms, 2);
    }
  const std::string mesh = gmsh(true, MeshOutput::TEXT);
  for (const Mistake &m : std::vector<Mistake>{
           {"$NodeData\n1\n\"n\"\n0\n2\n0\n1\n", "three integers"},
           {"$NodeData\n1\n\"n\"\n0\n3\n0\n10\n9\n", "out of range"},
           {"$NodeData\n1\n\"n\"\n0\n3\n0\n1\n2000000000\n1 2.0\n", "is not an integer"},
           {"$NodeData\n1\n\"n\"\n0\n3\n0\n1\n2\n1 2.0\n2 x\n$EndNodeData\n", "is not a number"},
           {"$ElementData\n1\n\"n\"\n0\n3\n0\n1\n1\n1 2.0\n", "ends too early"}})
    EXPECT_THAT(
        failure(mesh + m.lines + (m.message == "is not an integer" ? "$EndNodeData\n" : "")),
        HasSubstr(m.message));
}

// a cell of a mesh has what a row of a table has, and all ranks know it
TEST(MeshFile, DataAreThoseOfTables)
{
  const std::string cells =
      "# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n"
      "0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0\nCELLS 2 10\n4 0 1 4 3\n4 1 2 5 4\nCELL_TYPES 2\n9\n9\n"
      "CELL_DATA 2\nFIELD all 7\nJ 9 2 double\n1.25 0.5 0 0 1 0 0 0 1 2 0 0 0 1 0 0 0 1\n"
      "sigma 6 2 double\n1 2 3 4 0 0 -1 -2 -3 -4 0 0\ntensor 9 2 double\n"
      "1 4 0 4 2 0 0 0 3 -1 -4 0 -4 -2 0 0 0 -3\nep 1 2 double\n0.125 0.5\nu 2 2 double\n1 2 3 4\n"
      "w 3 2 double\n1 2 3 4 5 6\nm 1 2 double\n3 5\n";
  const std::string table =
      "x,y,volume,F:0,F:1,F:2,F:3,F:4,F:5,F:6,F:7,F:8,stress/xx,stress/yy,stress/zz,stress/xy,"
      "stress/xz,stress/yz,eplastic,vx,vy,d2_w:0,d2_w:1,d2_w:2,mass\n"
      "0.5,0.5,1,1.25,0.5,0,0,1,0,0,0,1,1,2,3,4,0,0,0.125,2,4,1,2,3,3\n"
      "1.5,0.5,1,2,0,0,0,1,0,0,0,1,-1,-2,-3,-4,0,0,0.5,6,8,4,5,6,5\n";
  const ScratchFile file("cells.vtk", cells), rows("cells.csv", table);
  const std::string scene = plane("si", "f f", "-1 3 -1 2", 1, 0.1) +
      "fix grid all mpm 0.5\nfix m all mpm/material density 1 eos linear 1e6 strength j2 4e5 5e3\n"
      "fix p all property/atom d2_w 3\n";
  const std::string sums = R"(
compute w all property/atom d2_w[1] d2_w[2] d2_w[3]
compute e all mpm/atom eplastic
variable ew atom c_e*(c_w[1]+10*c_w[2]+100*c_w[3])
compute s all reduce sum v_ew
thermo_style custom step c_s
run 0
)";
  Scene from_table(scene + "create_points 1 table " + rows.name + sums);
  for (const std::string stress : {"sigma", "tensor"}) {
    Scene from_mesh(scene + "create_points 1 elements " + file.name +
                    " data J F data ep eplastic data u velocity factor u 2 data w d2_w data m mass"
                    " data " +
                    stress + " stress" + sums);
    EXPECT_TRUE(identical(from_mesh.gather(), from_table.gather())) << stress;
    EXPECT_EQ(from_mesh.evaluate("c_s"), 0.125 * 321 + 0.5 * 654);
  }
  for (const Mistake &m : std::vector<Mistake>{{"data ep strain", "cannot be strain"},
                                               {"data ep volume", "cannot be volume"},
                                               {"data ep velocity", "have 1 components"},
                                               {"data u stress", "cannot be stress"},
                                               {"data u d2_w", "cannot be d2_w"},
                                               {"data w d2_w data w d2_w", "given twice"},
                                               {"data w velocity", "must be 0 in a 2d simulation"},
                                               {"data ep mass factor ep -1", "must be positive"},
                                               {"data w d2_w factor ep 2", "no keyword data takes"},
                                               {"data tensor F factor tensor -1", "determinant"},
                                               {"data tensor F factor tensor 0", "determinant"}})
    expect_error(scene + "create_points 1 elements " + file.name + " " + m.lines, m.message);
  const ScratchFile nan("nan.vtk", replaced(cells, "0.125 0.5", "nan 0.5"));
  expect_error(scene + "create_points 1 elements " + nan.name + " data ep eplastic", "finite");
}

SERIAL_TEST(MeshFile, RefusesMistakes)
{
  for (const bool old : {true, false}) {
    const std::string whole = gmsh(old, MeshOutput::LITTLE);
    EXPECT_THAT(failure(whole.substr(0, whole.size() - 40)), HasSubstr("ends too early"));
    std::string no_order = whole;
    no_order[no_order.find('\n', 13) + 1] = 5;
    EXPECT_THAT(failure(no_order), HasSubstr("order of bytes"));
  }
  const std::string bytes = vtk(true, MeshOutput::BIG), head = bytes.substr(0, 40);
  EXPECT_THAT(failure(bytes.substr(0, 200)), HasSubstr("ends too early"));
  const std::string text = vtk(true, MeshOutput::TEXT);
  EXPECT_THAT(failure(replaced(text, "1.5", "nan")), HasSubstr("not finite"));
  EXPECT_THAT(failure(replaced(text, "UNSTRUCTURED_GRID", "POLYDATA")), HasSubstr("UNSTRUCTURED"));
  EXPECT_THAT(failure(replaced(text, "12 10", "13 10")), HasSubstr("VTK's type 13"));
  EXPECT_THAT(failure(replaced(text, "0 3 4 8", "0 3 4 9")), HasSubstr("has the point 9"));
  EXPECT_THAT(failure(replaced(text, "POINTS 9", "POINTS 99999999999")), HasSubstr("not a count"));
  EXPECT_THAT(failure("<VTKFile>\n"), HasSubstr("expected UnstructuredGrid"));
  const std::string inp = abaqus();
  EXPECT_THAT(failure(replaced(inp, "C3D8R", "C3D20")), HasSubstr("'C3D20' are not supported"));
  EXPECT_THAT(failure(replaced(inp, "1, 4, 5, 9", "1, 4, 5, 99")), HasSubstr("node 99"));
  EXPECT_THAT(failure(replaced(inp, " 5, 6, 7, 8", " 5, 6, 7")), HasSubstr("too few nodes"));
  EXPECT_THAT(failure(replaced(inp, "*Heading", "*Include, input=x")), HasSubstr("*INCLUDE"));
  EXPECT_THAT(failure(replaced(inp, "1.5", "1.5e999")), HasSubstr("is not a coordinate"));
  EXPECT_THAT(failure(""), HasSubstr("not a mesh file of Gmsh"));
}
