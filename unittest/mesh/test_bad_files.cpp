// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: unit input
// timeout: 240

// Files of bodies that are cut, changed, or nonsense, in all formats: each is read, or is an error that begins with the
// name of the file; nothing crashes or takes long. Builds with MPM_SANITIZE see each access beyond the end.

#include "bad_input_testing.h"
#include "image/image_testing.h"
#include "mesh_testing.h"
#include "stl_testing.h"

#include "image/image.h"
#include "mesh/mesh_file.h"
#include "mesh/surface_mesh.h"
#include "table/table.h"

#include <new>

using namespace MPM_TEST;

namespace {

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
         "header_type=\"UInt64\">\n"
         "<PolyData>\n<Piece NumberOfPoints=\"2\">\n<PointData>\n"
         "<DataArray type=\"Float32\" Name=\"velocity\" NumberOfComponents=\"3\" "
         "format=\"ascii\">1 2 3 4 5 6</DataArray>\n"
         "<DataArray type=\"Float64\" Name=\"volume0\" format=\"appended\" "
         "offset=\"0\"/>\n</PointData>\n<Points>\n"
         "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 1 "
         "1</DataArray>\n</Points>\n"
         "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" +
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

/** What a reader says to a file, empty: it reads it. Any other exception or a signal ends the test. */
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

}    // namespace
