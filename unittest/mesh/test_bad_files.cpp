// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit input
// timeout: 300

// Files of bodies that are cut, changed, or nonsense, in all formats: each is read, or is an error
// that begins with the name of the file; nothing crashes or takes long.

#include "bad_input_testing.h"
#include "image/image_testing.h"
#include "mesh_testing.h"
#include "stl_testing.h"

#include "image/image.h"
#include "mesh/mesh_file.h"
#include "mesh/surface_mesh.h"
#include "table/table.h"

#include <limits>
#include <new>

using namespace MPM_TEST;

using Reader = std::function<void(const std::string &file)>;

struct Format {
  std::string name, good;
  Reader read;
  friend void PrintTo(const Format &format, std::ostream *out) { *out << format.name; }
};

void read_mesh(const std::string &file)
{
  MPM_NS::read_mesh(file);
}
void read_image(const std::string &file)
{
  MPM_NS::read_image(file);
}
void read_raw(const std::string &file)
{
  MPM_NS::RawLayout layout;
  layout.n[0] = 5;
  layout.n[1] = 4;
  layout.n[2] = 3;
  layout.kind = MPM_NS::ImageKind::FLOAT;
  MPM_NS::read_image(file, layout);
}
void read_table(const std::string &file)
{
  MPM_NS::read_table(file, "");
}
template <bool LEAKY> void read_surface(const std::string &file)
{
  MPM_NS::SurfaceOptions options;
  options.leaky = LEAKY;
  MPM_NS::SurfaceMesh(file_text(file), file, 1.0, {0.0, 0.0, 0.0}, options);
}

std::string obj()
{
  std::string text = "# a tetrahedron\no t\n";
  for (const char *corner : {"0 0 0", "1 0 0", "0 1 0", "0 0 1"})
    text += std::string("v ") + corner + "\nvn 0 0 1\n";
  return text + "f 1//1 3//1 2//1\nf 1 2 4\nf -4 -1 -2\nf 2 3 4\n";
}

std::string vtp()
{
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"2\">\n<PointData>\n"
         "<DataArray type=\"Float32\" Name=\"velocity\" NumberOfComponents=\"3\" "
         "format=\"ascii\">1 2 3 4 5 6</DataArray>\n<DataArray type=\"Float64\" Name=\"volume0\" "
         "format=\"appended\" offset=\"0\"/>\n</PointData>\n<Points>\n<DataArray type=\"Float64\" "
         "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 1 1</DataArray>\n</Points>\n</Piece>\n"
         "</PolyData>\n<AppendedData encoding=\"raw\">\n_" +
      bytes_of((int64_t) 16) + bytes_of(1.0) + bytes_of(2.0) + "\n</AppendedData>\n</VTKFile>\n";
}

std::vector<Format> formats()
{
  const Pixels pixels(5, 4, 3, [](int i, int j, int k) {
    return 40 * i + 10 * j + k;
  });
  const Pixels flat(5, 4, 1, [](int i, int j, int) {
    return 40 * i + 10 * j;
  });
  const auto ball = box({0, 0, 0}, {1, 2, 3});
  return {
      {"StlText", text_of(ball), read_surface<false>},
      {"StlBinary", binary_of(ball), read_surface<false>},
      {"StlLeaky", text_of(ball), read_surface<true>},
      {"Obj", obj(), read_surface<false>},
      {"ObjLeaky", obj(), read_surface<true>},
      {"Gmsh2", gmsh(true, MeshOutput::TEXT), read_mesh},
      {"Gmsh2Binary", gmsh(true, MeshOutput::LITTLE), read_mesh},
      {"Gmsh4", gmsh(false, MeshOutput::TEXT), read_mesh},
      {"Gmsh4Binary", gmsh(false, MeshOutput::LITTLE), read_mesh},
      {"Vtk3", vtk(true, MeshOutput::TEXT), read_mesh},
      {"Vtk3Binary", vtk(true, MeshOutput::BIG), read_mesh},
      {"Vtk5", vtk(false, MeshOutput::TEXT), read_mesh},
      {"Vtk5Binary", vtk(false, MeshOutput::BIG), read_mesh},
      {"VtuText", vtu("ascii"), read_mesh},
      {"VtuBase64", vtu("binary"), read_mesh},
      {"VtuRaw", vtu("raw"), read_mesh},
      {"Abaqus", abaqus(), read_mesh},
      {"PgmText", pgm(flat, true), read_image},
      {"Pgm", pgm(flat), read_image},
      {"Ppm", ppm(flat), read_image},
      {"Pbm", pbm(flat, false), read_image},
      {"Png", png(flat), read_image},
      {"Nrrd", nrrd_header(pixels, "uint8", "encoding: raw\n\n") + raw<uint8_t>(pixels),
       read_image},
      {"Raw", raw<float>(pixels), read_raw},
      {"Csv", "x,y,volume0,type\n0.25,0.5,0.01,Fe\n0.75,0.5,0.02,2\n", read_table},
      {"Xyz", "2\nProperties=species:S:1:pos:R:3 Time=0\nFe 0 0 0\nAl 1 1 1\n", read_table},
      {"Vtp", vtp(), read_table},
  };
}

class BadFiles : public ::testing::TestWithParam<Format> {};
INSTANTIATE_TEST_SUITE_P(All, BadFiles, ::testing::ValuesIn(formats()), [](const auto &info) {
  return info.param.name;
});

/** What a reader says to a file; empty: it reads it. Other exceptions end the test. */
std::string said(const Format &format, const std::string &text)
{
  const ScratchFile file(format.name.find("Obj") == 0 ? "bad.obj" : "bad", text);
  try {
    format.read(file.name);
  } catch (const std::runtime_error &e) {
    const std::string what = e.what();
    EXPECT_NE(what.find(file.name), std::string::npos) << "which file: " << what;
    EXPECT_LT(what.size(), 1000u) << what;
    return what;
  } catch (const std::bad_alloc &) {
    ADD_FAILURE() << "asks for more memory than there is";
  }
  return "";
}

TEST_P(BadFiles, GoodOneIsRead)
{
  EXPECT_EQ(said(GetParam(), GetParam().good), "");
}

// whatever is cut away, but a line end or a comment
TEST_P(BadFiles, Cut)
{
  const auto &good = GetParam().good;
  EXPECT_NE(said(GetParam(), ""), "");
  int accepted = 0, tried = 0;
  const std::size_t step = std::max<std::size_t>(1, good.size() / 200);
  for (std::size_t n = 1; n < good.size(); n += step, tried++)
    accepted += said(GetParam(), good.substr(0, n)).empty();
  EXPECT_LT(accepted, 0.6 * tried);    // of Abaqus and VTK the rest is not about the mesh
}

// bytes at random, numbers that are huge, negative, or none, and parts that are there twice
TEST_P(BadFiles, Changed)
{
  allow_seconds(200);
  const auto &good = GetParam().good;
  uint64_t dice = 4711;
  const auto random = [&](uint64_t n) {
    dice = dice * 6364136223846793005u + 1442695040888963407u;
    return (dice >> 24) % n;
  };
  const std::vector<std::string> words = {
      "-1", "0", "nan", "inf", "1e400", "4294967295", "9223372036854775807", "-9e18", "x", ""};
  for (int k = 0; k < 1500; k++) {
    std::string bad = good;
    const int kind = (int) random(3);
    if (kind == 0)
      for (uint64_t j = 0; j <= random(4); j++) bad[random(bad.size())] = (char) random(256);
    else if (kind == 1) {
      const auto at = bad.find_first_of("0123456789", random(bad.size()));
      if (at == std::string::npos) continue;
      const auto end = std::min(bad.find_first_not_of("0123456789.eE+-", at), bad.size());
      bad.replace(at, end - at, words[random(words.size())]);
    } else {
      const auto from = random(bad.size()), n = random(60);
      bad.insert(random(bad.size()), bad.substr(from, n));
    }
    said(GetParam(), bad);
  }
  allow_seconds(0);
}

// ---------------------------------------------------------------- errors of LAMMPS

/** A file with one defect, the command that reads it (FILE is its name), and what LAMMPS says. */
struct Defect {
  std::string name, file, text, command, error;
  friend void PrintTo(const Defect &defect, std::ostream *out) { *out << defect.name; }
};

const std::string surface = "region r mpm/mesh FILE 1.0 0 0 0", leaky = surface + " surface leaky",
                  elements = "create_points 1 elements FILE",
                  rows = "create_points 1 table FILE volume 1",
                  pixels = "create_points 1 image FILE pixel 0.1 threshold 100";

std::string with(std::string text, const std::string &from, const std::string &to)
{
  const auto at = text.find(from);
  return at == std::string::npos ? "no '" + from + "'" : text.replace(at, from.size(), to);
}

/** Bytes of this number are those of another one. */
std::string with_bytes(const std::string &text, double from, double to, bool big = false)
{
  return with(text, bytes_of(from, big), bytes_of(to, big));
}

std::vector<Defect> defects()
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto cube = box({0, 0, 0}, {1, 1, 1});
  const Soup wing = {{{{0, 0, 0}, {0, 0, 1}, {0.5, -1, 0.5}}}};
  Soup open = cube;
  open.pop_back();
  const std::string stl = text_of(cube), bytes = binary_of(cube),
                    two = gmsh(true, MeshOutput::TEXT), four = gmsh(false, MeshOutput::TEXT),
                    old = vtk(true, MeshOutput::TEXT), inp = abaqus();
  const std::string two_binary = gmsh(true, MeshOutput::LITTLE),
                    four_binary = gmsh(false, MeshOutput::LITTLE),
                    vtk_binary = vtk(true, MeshOutput::BIG);
  const Pixels flat(5, 4, 1, [](int i, int j, int) {
    return 40 * i + 10 * j;
  });
  const Pixels empty(0, 0, 1, [](int, int, int) {
    return 0;
  });
  std::string many = bytes, bytes_nan = bytes;
  many.replace(80, 4, bytes_of(4294967295u));
  bytes_nan.replace(84 + 12, 4, bytes_of((float) nan));
  const std::string nrrd = nrrd_header(flat, "float", "endian: little\nencoding: raw\n\n");
  std::string half(20 * sizeof(float), '\0');
  half.replace(8, 4, bytes_of((float) nan));
  const std::string png_head = "\x89PNG\r\n\x1a\n",
                    png_size = bytes_of(2000000000u, true) + bytes_of(2000000000u, true) + "\x08";
  return {
      // empty
      {"StlEmpty", "a.stl", "", surface, "is empty"},
      {"StlNoTriangles", "a.stl", text_of({}), surface, "no triangles"},
      {"StlBinaryNoTriangles", "a.stl", binary_of({}), surface, "no triangles"},
      {"ObjEmpty", "a.obj", "", surface, "is empty"},
      {"ObjNoFaces", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", surface, "no triangles"},
      {"GmshEmpty", "a.msh", "", elements, "not a mesh file of Gmsh"},
      {"GmshNothing", "a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", elements,
       "no nodes or no elements"},
      {"VtkNoCells", "a.vtk", old.substr(0, old.find("CELLS")), elements, "no points or no cells"},
      {"AbaqusNoElements", "a.inp", inp.substr(0, inp.find("*ELSET")), elements,
       "no nodes or no elements"},
      {"CsvEmpty", "a.csv", "", rows, "is empty"},
      {"CsvNoRows", "a.csv", "x,y,z\n", rows, "but no points"},
      {"XyzNoRows", "a.xyz", "0\nProperties=pos:R:3\n", rows, "has no points"},
      {"PgmEmpty", "a.pgm", "", pixels, "is empty"},
      {"PgmNoPixels", "a.pgm", pgm(empty), pixels, "must be positive"},
      {"NrrdEmpty", "a.nrrd", "NRRD0004\n", pixels, "has no field .type."},
      // cut
      {"StlCut", "a.stl", stl.substr(0, stl.size() - 15), surface, "endsolid"},
      {"StlBinaryCut", "a.stl", bytes.substr(0, bytes.size() - 7), surface,
       "for the 12 triangles|no STL file"},
      {"ObjCut", "a.obj", obj().substr(0, obj().size() - 8), surface, "not closed"},
      {"Gmsh2Cut", "a.msh", two.substr(0, two.size() - 40), elements, "ends too early"},
      {"Gmsh4Cut", "a.msh", four.substr(0, four.size() - 40), elements, "ends too early"},
      {"Gmsh2BinaryCut", "a.msh", two_binary.substr(0, two_binary.size() - 40), elements,
       "ends too early"},
      {"Gmsh4BinaryCut", "a.msh", four_binary.substr(0, four_binary.size() - 40), elements,
       "ends too early"},
      {"VtkCut", "a.vtk", old.substr(0, old.find("CELL_TYPES") - 4), elements,
       "ends too early|many"},
      {"VtkBinaryCut", "a.vtk", vtk_binary.substr(0, vtk_binary.find("CELL_TYPES") - 9), elements,
       "ends too early"},
      {"AbaqusCut", "a.inp", inp.substr(0, inp.find(" 5, 6, 7, 8")), elements, "too few nodes"},
      {"CsvCut", "a.csv", "x,y,z\n1,1,1\n0.5,", rows, "2 values, but there are 3 columns"},
      {"XyzCut", "a.xyz", "3\nProperties=pos:R:3\n0 0 0\n1 1 1\n", rows, "it was cut"},
      {"VtpCut", "a.vtp", vtp().substr(0, vtp().find("</AppendedData>") - 9), rows, "a.vtp"},
      {"PgmCut", "a.pgm", pgm(flat).substr(0, pgm(flat).size() - 1), pixels,
       "but only 19 are there"},
      {"PngCut", "a.png", png(flat).substr(0, 60), pixels, "libpng"},
      {"NrrdCut", "a.nrrd", nrrd + half.substr(0, 20), pixels, "but only 20 are there"},
      // huge
      {"StlBinaryHuge", "a.stl", many, surface, "for the 4294967295 triangles"},
      {"ObjHuge", "a.obj", with(obj(), "f 1 2 4", "f 1 2 99999999999999"), surface,
       "there is no vertex 99999999999999"},
      {"StlFar", "a.stl", with(stl, "vertex 1 ", "vertex 1e300 "), surface, "slivers"},
      {"Gmsh2Huge", "a.msh", with(two, "$Nodes\n9", "$Nodes\n999999999999999"), elements,
       "out of range"},
      {"Gmsh2More", "a.msh", with(two, "$Elements\n2", "$Elements\n2000000000"), elements,
       "not an integer|ends too early"},
      {"Gmsh4Huge", "a.msh", with(four, "$Nodes\n1 9 ", "$Nodes\n1 9000000000000000000 "), elements,
       "out of range|ends too early"},
      {"VtkHuge", "a.vtk", with(old, "POINTS 9", "POINTS 2000000000"), elements,
       "is not a number|ends too early"},
      {"VtkManyCells", "a.vtk", with(old, "CELLS 2 14", "CELLS 99999999999 14"), elements,
       "not a count"},
      {"AbaqusFar", "a.inp", with(inp, "1.5", "1e999"), elements, "is not a coordinate"},
      {"XyzHuge", "a.xyz", "999999999999999999\nProperties=pos:R:3\n0 0 0\n", rows, "it was cut"},
      {"VtpHuge", "a.vtp",
       with(vtp(), "NumberOfPoints=\"2\"", "NumberOfPoints=\"999999999999999999\""), rows, "a.vtp"},
      {"PgmHuge", "a.pgm", "P5\n2000000000 2000000000\n255\nabc", pixels, "bytes at least"},
      {"PngHuge", "a.png",
       png_head + png_chunk("IHDR", png_size + std::string(4, '\0')) +
           png_chunk("IDAT", zlib_stored("abc")) + png_chunk("IEND", ""),
       pixels, "bytes at least|libpng"},
      {"NrrdHuge", "a.nrrd", with(nrrd, "sizes: 5 4", "sizes: 3000000000 3000000000"), pixels,
       "bytes|too large"},
      // numbers that are none
      {"StlNan", "a.stl", with(stl, "vertex 1 ", "vertex nan "), surface, "no three coordinates"},
      {"StlBinaryNan", "a.stl", bytes_nan, surface, "not finite"},
      {"StlLeakyNan", "a.stl", bytes_nan, leaky, "not finite"},
      {"ObjNan", "a.obj", with(obj(), "v 1 0 0", "v nan 0 0"), surface, "three finite coordinates"},
      {"Gmsh2Nan", "a.msh", with(two, "1.5", "nan"), elements, "'nan' is not a number"},
      {"Gmsh4Inf", "a.msh", with(four, "1.3", "inf"), elements, "'inf' is not a number"},
      {"Gmsh2BinaryNan", "a.msh", with_bytes(two_binary, 1.5, nan), elements, "is not finite"},
      {"VtkNan", "a.vtk", with(old, "1.5", "nan"), elements, "is not finite"},
      {"VtkBinaryNan", "a.vtk", with_bytes(vtk_binary, 1.5, nan, true), elements, "is not finite"},
      {"AbaqusNan", "a.inp", with(inp, "1.5", "nan"), elements, "is not a coordinate"},
      {"CsvNan", "a.csv", "x,y,z\n1,1,1\n0.5,nan,0\n", rows, "line 3: column y is nan"},
      {"XyzNan", "a.xyz", "2\nProperties=pos:R:3\n0 0 0\n1 inf 1\n", rows,
       "line 4: column .* is inf"},
      {"VtpNan", "a.vtp", with_bytes(vtp(), 2.0, nan), "create_points 1 table FILE", "nan|finite"},
      {"PgmNan", "a.pgm", "P2\n2 1\n255\n1 nan\n", pixels, "'n' where a number should be"},
      {"NrrdNan", "a.nrrd", nrrd + half, pixels, "column 2, row 0, slice 0 is -?nan"},
      // bodies that are none: open, with a fin, inside out, without volume, twice at one place
      {"StlOpen", "a.stl", text_of(open), surface, "not closed"},
      {"StlFin", "a.stl", text_of(both(cube, wing)), surface, "not closed"},
      {"StlFlat", "a.stl", text_of({cube[0], cube[1]}), leaky, "no volume"},
      {"StlInsideOut", "a.stl", text_of(both(cube, inverted(box({2, 0, 0}, {2.5, 1, 1})))), surface,
       "looks inward"},
      {"ObjOpen", "a.obj", with(obj(), "f 1 2 4\n", ""), surface, "not closed"},
      {"ObjTwice", "a.obj", obj() + "f 1 2 4\n", surface, "not closed"},
      {"GmshTwice", "a.msh",
       with(with(two, "$Elements\n2", "$Elements\n3"), "$EndElements",
            "3 4 2 2 2 1 4 5 9\n$EndElements"),
       elements, "elements 2 and 3"},
      {"GmshFlat", "a.msh", with(two, "-1 0 0", "0 0.5 0.5"), elements,
       "element 2 .*volume|flat|inverted"},
      {"VtuType", "a.vtu", with(vtu("ascii"), "UnstructuredGrid", "ImageData"), elements,
       "expected UnstructuredGrid"},
      {"VtuCut", "a.vtu", vtu("raw").substr(0, vtu("raw").find("</AppendedData>") - 9), elements,
       "it was cut"},
      {"VtuBase64", "a.vtu", with(vtu("binary"), "AAAA", "A*AA"), elements, "not in base64"},
      {"VtuBase64Cut", "a.vtu", with(vtu("binary"), "AAAA", "</"), elements, "it was cut"},
      {"VtuOffsets", "a.vtu", with(vtu("ascii"), ">8 12 <", ">8 <"), elements, "the offsets"},
      {"VtuNode", "a.vtu", with(vtu("ascii"), "0 3 4 8 ", "0 3 4 98 "), elements,
       "which the file does not have"},
      {"VtuHuge", "a.vtu",
       with(vtu("ascii"), "NumberOfCells=\"2\"", "NumberOfCells=\"99999999999\""), elements,
       "it was cut"},
      {"VtuPieces", "a.vtu", with(vtu("ascii"), "</Piece>", "</Piece><Piece NumberOfPoints=\"0\">"),
       elements, "several pieces"},
      {"VtkTwice", "a.vtk",
       with(with(with(old, "CELLS 2 14", "CELLS 3 19"), "4 0 3 4 8", "4 0 3 4 8 4 0 3 4 8"),
            "CELL_TYPES 2\n12 10", "CELL_TYPES 3\n12 10 10"),
       elements, "elements 2 and 3|not for all|cells"},
      {"AbaqusTwice", "a.inp", with(inp, "2, 1, 4, 5, 9\n", "2, 1, 4, 5, 9\n3, 1, 4, 5, 9\n"),
       elements, "elements 2 and 3"},
      {"CsvTwice", "a.csv", "x,y,z\n1,1,1\n1,1,1\n", rows, "at the same place"},
  };
}

class BadFilesInLammps : public ::testing::TestWithParam<Defect> {};
INSTANTIATE_TEST_SUITE_P(All, BadFilesInLammps, ::testing::ValuesIn(defects()),
                         [](const auto &info) {
                           return info.param.name;
                         });

// the error has the name of the file, and what is wrong with it
TEST_P(BadFilesInLammps, AreExplained)
{
  const auto &defect = GetParam();
  const ScratchFile file(defect.file, defect.text);
  const std::string scene = defect.command == pixels ? plane("lj", "f f", "-3 3 -3 3")
                                                     : space("lj", "f f f", "-3 3 -3 3 -3 3");
  const std::string text =
      answer(scene + "fix grid all mpm 0.5\n" + with(defect.command, "FILE", file.name) + "\n");
  EXPECT_TRUE(contains(text, defect.error)) << "expected: " << defect.error << "\nfound: " << text;
  EXPECT_TRUE(contains(text, file.name)) << "which file: " << text;
}

// a device gives bytes without end
TEST(BadFilesInLammps, DevicesAreNoFiles)
{
  for (const std::string &command :
       {surface, elements, rows, std::string("fix m all mpm/material file FILE")}) {
    const std::string text =
        answer(space("lj", "f f f", "-3 3 -3 3 -3 3") + "fix grid all mpm 0.5\n" +
               with(command, "FILE", "/dev/zero") + "\n");
    EXPECT_TRUE(contains(text, "is no file|cannot open the mesh file")) << text;
  }
}

TEST(BadFilesInLammps, ManyColumns)
{
  std::string names = "x,y,z", values = "0,0,0";
  for (int k = 0; k < 100000; k++) {
    names += ",c" + std::to_string(k);
    values += ",1";
  }
  const ScratchFile file("a.csv", names + ",x\n" + values + ",1\n");
  EXPECT_TRUE(contains(answer(space("lj", "f f f", "-3 3 -3 3 -3 3") + "fix grid all mpm 0.5\n" +
                              with(rows, "FILE", file.name) + "\n"),
                       "two columns have the name x"));
}
