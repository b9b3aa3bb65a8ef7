// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit input physics
// mpi: 1 4
// timeout: 300

// create_points TYPE image FILE: sites in the bodies of a picture or of a stack of pictures.

#include "bad_input_testing.h"
#include "heat/heat_testing.h"
#include "image/image_testing.h"

#include "image/image.h"

using namespace MPM_TEST;

static std::vector<Scene::State> made_by(const std::string &input)
{
  Scene scene(input);
  return scene.gather();
}

static double total(const std::vector<Scene::State> &points)
{
  double sum = 0.0;
  for (const auto &p : points) sum += p.vol;
  return sum;
}

static std::vector<std::size_t> of_types(const std::vector<Scene::State> &points, int ntypes)
{
  std::vector<std::size_t> n(ntypes, 0);
  for (const auto &p : points) n[(int) p.type - 1]++;
  return n;
}

const std::string flat = plane("si", "f f", "0 1 0 1", 3),
                  deep = space("si", "f f f", "0 1 0 1 0 1", 3);

/** The points of type 1 that a picture gives. */
static std::vector<Scene::State> points_of(const ScratchFile &file, const std::string &options,
                                           const std::string &scene = flat)
{
  return made_by(scene + "create_points 1 image " + file.name + " " + options + "\n");
}

static int disk(int i, int j, int r)
{
  return i * i + j * j <= r * r ? 200 : 10;
}

TEST(Counts, Disks)
{
  const std::map<int, std::size_t> exact = {{10, 317}, {20, 1257}, {50, 7845}, {100, 31417}};
  for (const auto &[r, count] : exact) {
    const int n = 2 * r + 1, R = r;
    const ScratchFile file("disk.pgm", pgm(Pixels(n, n, 1, [=](int i, int j, int) {
                             return disk(i - R, j - R, R);
                           })));
    const std::string pixel = strprintf("pixel %.17g ", 1.0 / n);
    EXPECT_EQ(points_of(file, pixel + "sites pixels").size(), count) << r;
    // sites in the middle of pixels, four in each of them, and one on the border of each two
    const std::string lattice = flat + strprintf("fix grid all mpm %.17g\n", 2.0 / n);
    EXPECT_EQ(points_of(file, pixel, lattice).size(), count);
    EXPECT_EQ(points_of(file, pixel + "ppc 4", lattice).size(), 4 * count);
    EXPECT_EQ(points_of(file, pixel + "sites pixels invert yes").size(), n * n - count);
  }
}

TEST(Counts, Spheres)
{
  const std::map<int, std::size_t> exact = {{10, 4169}, {20, 33401}};
  for (const auto &[r, count] : exact) {
    const int n = 2 * r + 1, R = r;
    const Pixels ball(n, n, n, [=](int i, int j, int k) {
      return (i - R) * (i - R) + (j - R) * (j - R) + (k - R) * (k - R) <= R * R;
    });
    const ScratchFile file("ball.raw", raw<uint8_t>(ball));
    EXPECT_EQ(points_of(file,
                        strprintf("raw %d %d %d uint8 pixel %.17g threshold 1 sites pixels", n, n,
                                  n, 1.0 / n),
                        deep)
                  .size(),
              count);
  }
}

// surfaces of Schwarz and Schoen in a periodic cell, by values that are reals
TEST(Counts, PeriodicStacks)
{
  for (const auto &[n, schwarz, gyroid] :
       std::vector<std::array<int, 3>>{{16, 1496, 1424}, {32, 11600, 11040}, {64, 93952, 88848}}) {
    std::string values[2];
    const auto c = [N = n](int i) {
      return std::cos(2.0 * PI * (i + 0.5) / N);
    };
    const auto s = [N = n](int i) {
      return std::sin(2.0 * PI * (i + 0.5) / N);
    };
    Pixels(n, n, n, [&](int i, int j, int k) {
      values[0] += bytes_of((float) (c(i) + c(j) + c(k)), true);
      values[1] += bytes_of(s(i) * c(j) + s(j) * c(k) + s(k) * c(i));
      return 0;
    });
    const std::string sizes =
        strprintf("NRRD0005\ndimension: 3\nsizes: %d %d %d\nspacings: %.17g %.17g %.17g\n", n, n, n,
                  1.0 / n, 1.0 / n, 1.0 / n);
    const ScratchFile one("schwarz.nrrd",
                          sizes + "type: float\nendian: big\nencoding: raw\n\n" + values[0]),
        other("gyroid.nrrd", sizes + "type: double\nendian: little\nencoding: raw\n\n" + values[1]);
    const auto count = [&](const ScratchFile &file, const std::string &options) {
      return points_of(file, "sites pixels " + options, space("si", "p p p", "0 1 0 1 0 1")).size();
    };
    EXPECT_EQ(count(one, "invert yes threshold -0.5"), schwarz);
    EXPECT_EQ(count(other, "invert yes threshold -0.5"), gyroid);
    // no pixel is at zero, and half of them are on either side
    const std::size_t half = n * n * n / 2;
    EXPECT_EQ(count(one, "invert yes threshold -1e-6"), half);
    EXPECT_EQ(count(one, "threshold 1e-6"), half);
  }
}

TEST(Counts, ThresholdsOf8And16Bits)
{
  const Pixels ramp(256, 1, 1,
                    [](int i, int, int) {
                      return i;
                    }),
      deep_ramp(256, 1, 1, [](int i, int, int) {
        return 257 * i;
      });
  const ScratchFile one("ramp.pgm", pgm(ramp)), other("deep.pgm", pgm(deep_ramp, false, 65535));
  const auto count = [](const ScratchFile &file, const std::string &options) {
    return of_types(
        points_of(file, "pixel 1 sites pixels " + options, plane("si", "f f", "0 256 0 1", 3)), 3);
  };
  using Counts = std::vector<std::size_t>;
  EXPECT_EQ(count(one, ""), Counts({128, 0, 0}));
  EXPECT_EQ(count(other, ""), Counts({128, 0, 0}));
  EXPECT_EQ(count(one, "threshold 100"), Counts({156, 0, 0}));
  EXPECT_EQ(count(other, "threshold 25700"), Counts({156, 0, 0}));
  EXPECT_EQ(count(other, "threshold 25700.5"), Counts({155, 0, 0}));
  EXPECT_EQ(count(one, "threshold 100 invert yes"), Counts({100, 0, 0}));
  EXPECT_EQ(count(one, "threshold 10 from 50 3 from 60 NULL from 200 2"), Counts({40, 56, 10}));
}

// an L: a bar on the left, its foot to the right; the picture has its first row at the top
static int letter(int i, int j, int)
{
  return i < 2 || j >= 4 ? 255 : 0;    // 4 columns, 6 rows
}
const Pixels L(4, 6, 1, letter);

/** Is there a point at x, y of pixels of length 0.1, from the origin of the image? */
static bool is_at(const std::vector<Scene::State> &points, double x, double y, double z = 0.0)
{
  for (const auto &p : points)
    if (std::fabs(p.x[0] - x) + std::fabs(p.x[1] - y) + std::fabs(p.x[2] - z) < 1e-9) return true;
  return false;
}

TEST(Place, LetterIsUpright)
{
  const ScratchFile file("L.pgm", pgm(L));
  const std::string options = "pixel 0.1 sites pixels origin 0.2 0.3 ";
  auto points = points_of(file, options);
  ASSERT_EQ(points.size(), 16u);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 6; j++)
      EXPECT_EQ(is_at(points, 0.25 + 0.1 * i, 0.85 - 0.1 * j), letter(i, j, 0) > 0) << i << j;
  EXPECT_TRUE(is_at({points[0]}, 0.25, 0.35)) << "the first ID is at the lower left";

  points = points_of(file, options + "axes x y");    // upside down
  EXPECT_TRUE(is_at(points, 0.55, 0.85) && !is_at(points, 0.55, 0.35));
  points = points_of(file, options + "axes -y x");    // rows to the right, columns downwards
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 6; j++)
      EXPECT_EQ(is_at(points, 0.25 + 0.1 * j, 0.65 - 0.1 * i), letter(i, j, 0) > 0) << i << j;
}

// a thick L whose foot is in the first slice alone
TEST(Place, SlicesAndAxes)
{
  const Pixels solid(4, 6, 3, [](int i, int j, int k) {
    return i < 2 || (j >= 4 && k == 0) ? 255 : 0;
  });
  std::vector<std::unique_ptr<ScratchFile>> slices;
  for (int k = 0; k < 3; k++)
    slices.push_back(std::make_unique<ScratchFile>(strprintf("s%02d.pgm", k + 7),
                                                   pgm(Pixels(4, 6, 1, [&](int i, int j, int) {
                                                     return solid.at(i, j, k);
                                                   }))));
  std::string pattern = slices[0]->name;
  pattern.replace(pattern.find("s07"), 3, "s%02d");
  const std::string command =
      "create_points 1 image " + pattern + " slices 7 9 pixel 0.1 sites pixels ";
  auto points = made_by(deep + command + "\n");
  ASSERT_EQ(points.size(), 12u * 3 + 4);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 6; j++)
      for (int k = 0; k < 3; k++)
        EXPECT_EQ(is_at(points, 0.05 + 0.1 * i, 0.55 - 0.1 * j, 0.05 + 0.1 * k),
                  solid.at(i, j, k) > 0);
  points = made_by(deep + command + "axes z -x y\n");
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 6; j++)
      for (int k = 0; k < 3; k++)
        EXPECT_EQ(is_at(points, 0.55 - 0.1 * j, 0.05 + 0.1 * k, 0.05 + 0.1 * i),
                  solid.at(i, j, k) > 0);

  // the same as values without a header, which count rows upwards
  const ScratchFile file("solid.raw", "12" + raw<int16_t>(solid, true));
  EXPECT_TRUE(
      identical(made_by(deep + command + "\n"),
                points_of(file,
                          "raw 4 6 3 int16 endian big skip 2 threshold 127.5 pixel 0.1 sites "
                          "pixels axes x -y z",
                          deep)));
  // a picture is a plate as thick as a pixel
  points = points_of(*slices[0], "pixel 0.1 0.1 0.4 sites pixels", deep);
  ASSERT_EQ(points.size(), 16u);
  EXPECT_NEAR(points[0].vol, 0.004, 1e-15);
  EXPECT_NEAR(points[0].x[2], 0.2, 1e-12);
}

TEST(Place, PixelsOfTwoLengthsAndARegion)
{
  const ScratchFile file("L.pgm", pgm(L));
  const std::string grid = "fix grid all mpm 0.05\nregion r block 0.1 0.3 0 1 INF INF\n";
  const auto points =
      made_by(flat + grid + "create_points 2 image " + file.name + " pixel 0.2 0.1 ppc 1 in r\n");
  // the bar from 0.1 on, and the foot to 0.3
  EXPECT_EQ(points.size(), (4u * 12));
  for (const auto &p : points) EXPECT_EQ(p.type, 2);
}

// what is around the bodies is not sent, and changes nothing
TEST(Place, EmptyMargins)
{
  const Pixels wide(20, 19, 1, [](int i, int j, int) {
    return i >= 9 && i < 13 && j >= 3 && j < 9 ? letter(i - 9, j - 3, 0) : 0;
  });
  const ScratchFile one("L.pgm", pgm(L)), other("wide.pgm", pgm(wide));
  const std::string scene = flat + "fix grid all mpm 0.03\n";
  EXPECT_TRUE(identical(points_of(one, "pixel 0.1 origin 0.11 0.07", scene),
                        points_of(other, "pixel 0.1 origin -0.79 -0.93", scene)));
}

TEST(Formats, AllGiveTheSamePoints)
{
  const Pixels p(11, 9, 1,
                 [](int i, int j, int) {
                   return (i * 37 + j * 59) % 256;
                 }),
      p16(11, 9, 1, [](int i, int j, int) {
        return (i * 37 + j * 59) % 256 * 257;
      });
  std::vector<std::pair<std::string, std::string>> files = {{pgm(p), ""},
                                                            {pgm(p, true), ""},
                                                            {pgm(p16, false, 65535), ""},
                                                            {ppm(p), ""},
                                                            {ppm(p, as_gray, true), ""}};
  files.push_back({nrrd_header(p, "uchar", "encoding: raw\n\n") + raw<uint8_t>(p), "axes x -y"});
  files.push_back({raw<float>(p), "raw 11 9 1 float threshold 127.5 axes x -y"});
  files.push_back({raw<uint16_t>(p16, true), "raw 11 9 1 uint16 endian big axes x -y"});
  if (MPM_NS::png_available())
    for (const auto &text : {png(p), png(p16, 16), png(p, 8, 2), png(p, 8, 3), png(p, 8, 4)})
      files.push_back({text, ""});
  std::vector<Scene::State> first;
  for (const auto &[text, options] : files) {
    const ScratchFile file("image", text);
    const auto points = points_of(file, "pixel 0.09 origin 0.003 0.004 " + options,
                                  flat + "fix grid all mpm 0.04\n");
    if (first.empty()) first = points;
    EXPECT_GT(points.size(), 500u);
    EXPECT_TRUE(identical(points, first)) << options;
  }
}

TEST(Ranks, PointsAreThoseOfOne)
{
  const Pixels wild(20, 15, 10, [](int i, int j, int k) {
    return (int) (127.0 + 60.0 * (std::sin(i) + std::cos(0.8 * j) + std::sin(1.4 * k + 1.0)));
  });
  const ScratchFile file("wild.raw", raw<int16_t>(wild));
  const std::string text =
      "fix grid all mpm 0.07\nfix value all property/atom d_v\ncreate_points 1 image " + file.name +
      " raw 20 15 10 int16 pixel 0.048 0.06 0.08 origin 0.01 0.02 0.03 ";
  for (const std::string options :
       {"threshold 100 from 150 2 from 200 3 jitter 0.3 4711 field d_v 0.5 -3",
        "threshold 120 smooth 1 ppc 3"}) {
    Scene serial(deep + text + options + "\n", MPI_COMM_SELF);
    for (const char *layout : {"", "processors 1 1 *\n", "comm_style tiled\n"}) {
      Scene parallel(layout + deep + text + options + "\n");
      EXPECT_TRUE(identical(serial.gather(), parallel.gather())) << options << layout;
    }
  }
}

TEST(Values, ColorsToTypes)
{
  const Pixels p(6, 5, 1, [](int i, int j, int) {
    return (i + 2 * j) % 4;
  });
  const Palette color = [](int v, int c) {
    return v == 3 ? 250 : v == c ? 255 : 0;    // red, green, blue, nearly white
  };
  const ScratchFile file("colors.ppm", ppm(p, color));
  std::size_t n[4] = {0, 0, 0, 0};
  for (const int v : p.values) n[v]++;
  const auto count = [&](const std::string &options) {
    return of_types(points_of(file, "pixel 0.1 sites pixels " + options), 3);
  };
  using Counts = std::vector<std::size_t>;
  EXPECT_EQ(count("color 255 0 0 2 color 0 0 255 3"), Counts({0, n[0], n[2]}));
  EXPECT_EQ(count("color 255 0 0 2 threshold 200"), Counts({n[3], n[0], 0}));
  EXPECT_EQ(count("color 0 255 0 NULL threshold 0"), Counts({n[0] + n[2] + n[3], 0, 0}));
  EXPECT_EQ(count(""), Counts({n[3] + n[1], 0, 0}));    // by brightness: green has 0.587 of white
}

TEST(Values, Fields)
{
  const ScratchFile file("ramp.pgm", pgm(Pixels(10, 10, 1, [](int i, int j, int) {
                           return 10 * i + j + 100;
                         })));
  Scene scene(
      flat +
      "fix p all property/atom d_a d_b i_c\nregion r block 0 0.1 0 0.1 -1 1\n"
      "create_points 2 region r spacing 0.05\nset type 2 d_a 7\n"
      "create_points 1 image " +
      file.name +
      " pixel 0.08 origin 0.12 0.15 sites pixels threshold 0 field d_b 2 -5 field d_a 1 0\n");
  int flag, columns;
  auto *atom = scene.lmp->atom;
  const double *a = atom->dvector[atom->find_custom("a", flag, columns)],
               *b = atom->dvector[atom->find_custom("b", flag, columns)];
  int n = 0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (atom->type[i] == 2) {
      EXPECT_EQ(a[i], 7.0);
      EXPECT_EQ(b[i], 0.0);
      continue;
    }
    const int column = (int) std::floor((atom->x[i][0] - 0.12) / 0.08),
              row = 9 - (int) std::floor((atom->x[i][1] - 0.15) / 0.08);
    EXPECT_EQ(a[i], 10 * column + row + 100);
    EXPECT_EQ(b[i], 2 * a[i] - 5);
    n++;
  }
  EXPECT_EQ(over_ranks(n), 100);
}

/** Share of a pixel, cut into 16 x 16, that is in a disk, in 255 levels. */
static Pixels smooth_disk(double R, double x0, double y0, int n)
{
  return Pixels(n, n, 1, [=](int i, int j, int) {
    int in = 0;
    for (int k = 0; k < 256; k++) {
      const double x = i + (k % 16 + 0.5) / 16 - x0, y = j + (k / 16 + 0.5) / 16 - y0;
      in += x * x + y * y < R * R;
    }
    return (int) std::lround(255.0 * in / 256);
  });
}

TEST(Surface, VolumeOfADiskIsOfSecondOrder)
{
  for (const double cells : {1.0, 1.7, 2.0}) {    // a cell has so many pixels
    std::vector<double> errors;
    for (const int R : {5, 10, 20, 40, 80}) {
      const int n = 5 * R / 2 + 4;
      const ScratchFile file("disk.pgm", pgm(smooth_disk(R, 0.5 * n + 0.137, 0.5 * n - 0.211, n)));
      const auto points =
          points_of(file, strprintf("pixel %.17g origin 0.013 0.021 smooth 1", 0.3 / R),
                    flat + strprintf("fix grid all mpm %.17g\n", 0.3 / R * cells));
      errors.push_back(measured(strprintf("%g pixels per cell, R = %d pixels", cells, R),
                                total(points) / (PI * 0.09)) -
                       1.0);
      EXPECT_LT(errors.back(), 0.0) << "smoothing takes from what is convex";
      // values with a variance V across the surface have it at V / 2R inside: W^2, 1/12 of the mean
      // over a pixel, and 1/6 of straight lines between pixels
      EXPECT_NEAR(errors.back() * R * R, -(1.0 + 1.0 / 12.0 + 1.0 / 6.0), 0.15);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[4]) / 4.0, 2.0, 0.15);
  }
}

TEST(Surface, VolumeOfABallIsOfSecondOrder)
{
  double errors[2];
  for (const int R : {6, 12}) {
    const int n = 2 * R + 10;
    const double middle = 0.5 * n + 0.17;
    const Pixels ball(n, n, n, [&](int i, int j, int k) {
      int in = 0;
      for (int q = 0; q < 512; q++) {
        const double x = i + (q % 8 + 0.5) / 8 - middle, y = j + (q / 8 % 8 + 0.5) / 8 - middle,
                     z = k + (q / 64 + 0.5) / 8 - middle;
        in += x * x + y * y + z * z < R * R;
      }
      return in;
    });
    const ScratchFile file("ball.raw", raw<uint16_t>(ball));
    const auto points = points_of(file,
                                  strprintf("raw %d %d %d uint16 threshold 256 pixel %.17g smooth "
                                            "0.7 sites pixels",
                                            n, n, n, 0.25 / R),
                                  deep);
    errors[R == 12] = measured(strprintf("R = %d pixels", R),
                               total(points) / (4.0 / 3.0 * PI * std::pow(0.25, 3))) -
        1.0;
    EXPECT_NEAR(errors[R == 12] * R * R, -3.0 * (0.49 + 1.0 / 12.0 + 1.0 / 6.0), 0.15);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.02);
}

// slivers go to neighbors: no volume is lost, no point is small, at any distance of points
TEST(Surface, NothingIsLost)
{
  const int n = 40;
  const ScratchFile file("disk.pgm", pgm(smooth_disk(14.3, 19.9, 20.2, n)));
  double volume[4];
  for (const int every : {1, 2, 4}) {
    const auto points =
        points_of(file, strprintf("pixel 0.025 smooth 1.5 spacing %.17g", 0.025 / every));
    volume[every - 1] = total(points);
    const double site = 0.025 * 0.025 / (every * every);
    for (const auto &p : points) {
      EXPECT_GE(p.vol, 0.1 * site * (1.0 - 1e-9));
      EXPECT_LE(p.vol, 1.4 * site);
    }
  }
  EXPECT_NEAR(volume[0] / volume[3], 1.0, 1e-5);
  EXPECT_NEAR(volume[1] / volume[3], 1.0, 1e-5);
}

// a plane at 1/3 of a pixel, by the brightness of what it cuts; and what is dark
TEST(Surface, PlaneAndItsComplement)
{
  const ScratchFile file("plane.pgm", pgm(Pixels(10, 4, 1, [](int i, int, int) {
                           return i < 4 ? 240 : i == 4 ? 160 : 0;    // 2/3 of this one
                         })));
  const std::string options = "pixel 0.1 0.25 sites pixels smooth 0 threshold 120";
  const double a = total(points_of(file, options)),
               b = total(points_of(file, options + " invert yes"));
  EXPECT_NEAR(a + b, 1.0, 1e-12);
  EXPECT_NEAR(a, 0.475, 1e-12);    // 160 to 0 is linear: 120 is at a quarter of a pixel
}

// a cell that is repeated: its surface goes on across the faces
TEST(Surface, GoesOnAcrossPeriodicFaces)
{
  const int n = 24;
  std::string values[2];
  for (int shift : {0, 1})
    Pixels(n, n, 1, [&](int i, int j, int) {
      const auto c = [&](int k) {
        return std::cos(2.0 * PI * (k + 0.5 + 6 * shift) / n);
      };
      values[shift] += bytes_of((float) (c(i) + c(j)));
      return 0;
    });
  double volume[2];
  for (int shift : {0, 1}) {
    const ScratchFile file("cell.raw", values[shift]);
    volume[shift] = total(
        points_of(file,
                  strprintf("raw %d %d 1 float pixel %.17g smooth 2 threshold 0.5 sites pixels", n,
                            n, 1.0 / n),
                  plane("si", "p p", "0 1 0 1")));
  }
  EXPECT_NEAR(volume[0], volume[1], 1e-12);
}

// gray values as the temperature at the start, and as the factor of a yield stress
TEST(Values, HistoryAndParameters)
{
  const ScratchFile file("ramp.pgm", pgm(Pixels(8, 8, 1, [](int i, int j, int) {
                           return 20 * ((i + 3 * j) % 8) + 50;
                         })));
  Scene scene(plane("si", "p p", "0 1 0 1") +
              "fix grid all mpm 0.125\n"
              "fix m all mpm/material density 1000 eos linear 1e6 strength j2 4e5 5e3 thermal "
              "adiabatic 4e5 298 &\n"
              "  random SIGMAY lognormal 0.1 0.5 4711\n"
              "create_points 1 image " +
              file.name +
              " pixel 0.125 threshold 0 field random/SIGMAY 0.01 0.5 field temperature 2 -50\n"
              "compute c all mpm/atom random/SIGMAY temperature vonmises eplastic\n"
              "variable v atom 3*sin(2*PI*y)\nvelocity all set v_v 0 NULL\nfix step all mpm/dt "
              "0.3\nrun 0\n");
  auto *c = scene.lmp->modify->get_compute_by_id("c");
  c->compute_peratom();
  for (int i = 0; i < scene.n(); i++) {
    const double gray = (c->array_atom[i][1] + 50.0) / 2.0;
    EXPECT_NEAR(c->array_atom[i][0], 0.01 * gray + 0.5, 1e-13);
    const double *x = scene.lmp->atom->x[i];
    const int column = (int) std::floor(x[0] / 0.125), row = 7 - (int) std::floor(x[1] / 0.125);
    EXPECT_NEAR(gray, 20 * ((column + 3 * row) % 8) + 50, 1e-12);
  }
  scene.commands("run 10\n");
  c->compute_peratom();
  double most = 0.0, yields = 0.0;
  for (int i = 0; i < scene.n(); i++) {
    const double share = c->array_atom[i][2] / (5e3 * c->array_atom[i][0]);
    most = std::max(most, share);
    yields += share > 0.999 && c->array_atom[i][3] > 0.0;
  }
  EXPECT_LT(over_ranks(most, MPI_MAX), 1.0 + 1e-9);
  EXPECT_GT(over_ranks(yields), 100.0);
}

// two conductivities in a picture: layers along and across the heat, and a checkerboard, which
// conducts as the root of the product (J. B. Keller, J. Math. Phys. 5 (1964) 548)
static double conductivity(const std::string &file, int n, const std::string &shape = "quadratic")
{
  Scene run(plane("lj", "f f", "0 1 0 1", 2, 0.1 / n) +
            strprintf("fix grid all mpm %.17g shape %s\n", 1.0 / n, shape.c_str()) +
            strprintf("create_points 1 image %s pixel %.17g threshold 0 from 128 2\n", file.c_str(),
                      1.0 / n) +
            "group one type 1\ngroup two type 2\n"
            "fix m one mpm/material density 1.0 eos linear 1e-6 thermal conducting 1.0 0.5 1.0\n"
            "fix n two mpm/material density 1.0 eos linear 1e-6 thermal conducting 1.0 0.5 10.0\n"
            "fix heat all mpm/heat xlo temperature 1.0 xhi temperature 0.0 stages 100\n");
  run_to(run, 1.5, 10.0 / (n * n));
  const double *const flows = run.fix_vector("heat", 9);
  EXPECT_NEAR(flows[0] / flows[1], -1.0, 1e-6);
  return flows[0];
}

// functions that end at faces of cells know the layers on both sides apart, and are exact; wider
// ones have the mean of both in the cells at the interface, which is an error of first order
SERIAL_TEST(Conduction, Laminates)
{
  double error[2];
  for (const int n : {16, 32}) {
    const ScratchFile across("across.pgm",
                             pgm(Pixels(n, n, 1,
                                        [=](int i, int, int) {
                                          return i < n / 2 ? 0 : 255;
                                        }))),
        along("along.pgm", pgm(Pixels(n, n, 1, [=](int, int j, int) {
                return j < n / 2 ? 0 : 255;
              })));
    EXPECT_NEAR(measured(strprintf("along, %d: error", n), conductivity(along.name, n) / 5.5 - 1.0),
                0.0, 1e-6);
    for (const char *shape : {"linear", "gimp", "cpdi"}) {
      if (n > 16 && shape[0] != 'l') continue;    // dear
      EXPECT_NEAR(measured(strprintf("across, %d, %s: error", n, shape),
                           conductivity(across.name, n, shape) * 0.55 - 1.0),
                  0.0, 1e-6);
    }
    error[n == 32] =
        measured(strprintf("across, %d: error", n), conductivity(across.name, n) * 0.55 - 1.0);
  }
  EXPECT_LT(std::fabs(error[0]), 0.01);
  EXPECT_GT(std::log2(std::fabs(error[0] / error[1])), 0.9);
}

SERIAL_TEST(Conduction, Checkerboard)
{
  double error[2];
  for (const int n : {16, 32}) {    // pixels of a tile; the faces go through the middle of tiles
    const ScratchFile file("board.pgm", pgm(Pixels(n, n, 1, [=](int i, int j, int) {
                             return (i < n / 2) == (j < n / 2) ? 255 : 0;
                           })));
    error[n == 32] =
        measured(strprintf("%d pixels", n), conductivity(file.name, n) / std::sqrt(10.0)) - 1.0;
  }
  EXPECT_LT(std::fabs(error[0]), 0.08);
  EXPECT_GT(std::log2(std::fabs(error[0] / error[1])), 0.6);
  EXPECT_GT(error[0] * error[1], 0.0) << "from one side";
}

static const char *const good_line = "create_points 1 image GRAY pixel 0.1\n";

namespace {    // MPM_TEST has a Mistake, too
PARAMETER_TEST(
    Mistake, IsExplained, Change,
    ValuesIn(mistakes_in(
        good_line, "create_points",
        {{"NoFile", "1 image", "Illegal create_points image command: missing argument"},
         {"NoSuchFile", "1 image no.such pixel 0.1", "no.such: cannot be read"},
         {"NoPixel", "1 image GRAY", "does not say how long pixels are along x"},
         {"PixelZero", "1 image GRAY pixel 0", "pixel must be positive: 0"},
         {"PixelThree", "1 image GRAY pixel 1 1 1", "expects 1 or 2 numbers"},
         {"Axes", "1 image GRAY pixel 0.1 axes x z", "axes z: expected x and y"},
         {"AxesTwice", "1 image GRAY pixel 0.1 axes x -x", "each axis once"},
         {"Type", "1 image GRAY pixel 0.1 from 200 9", "Invalid atom type 9 after from"},
         {"Order", "1 image GRAY pixel 0.1 threshold 100 from 50 2", "ascending order"},
         {"Color", "1 image GRAY pixel 0.1 color 1 2 3 1", "this one has gray values"},
         {"Invert", "1 image GRAY pixel 0.1 invert yes from 250 2", "single threshold"},
         {"SmoothTypes", "1 image GRAY pixel 0.1 smooth 1 from 250 2", "surface of one body"},
         {"Smooth", "1 image GRAY pixel 0.1 smooth -1", "smooth must be within 0 and 100"},
         {"Endian", "1 image GRAY pixel 0.1 endian big", "give keyword raw, too"},
         {"Slices", "1 image GRAY pixel 0.1 slices 5 3", "ends before it begins"},
         {"SlicesName", "1 image GRAY pixel 0.1 slices 1 3", "needs one %d"},
         {"Raw", "1 image GRAY pixel 0.1 raw 3 3 1 uint8", "bytes more than"},
         {"RawSize", "1 image GRAY pixel 0.1 raw 300 3000 1 uint8", "but only"},
         {"RawHuge", "1 image GRAY pixel 0.1 raw 3000000000 3000000000 3000000000 double",
          "bytes at least"},
         {"RawKind", "1 image GRAY pixel 0.1 raw 3 3 1 bits", "uint8"},
         {"Stack", "1 image GRAY pixel 0.1 raw 2 2 2 uint8 skip 94",
          "2 slices, but the simulation is 2d"},
         {"NoThreshold", "1 image GRAY pixel 0.1 raw 8 1 1 int8 skip 94",
          "needs keyword threshold"},
         {"Empty", "1 image GRAY pixel 0.1 threshold 1000",
          "no pixel is of a body: gray values are .* to .*at least 1000: use another threshold"},
         {"EmptyInverted", "1 image GRAY pixel 0.1 threshold 0 invert yes",
          "no pixel is of a body: gray values are .* the body has less than 0: use another"},
         {"Outside", "1 image GRAY pixel 0.2", "image reaches beyond the simulation box"},
         {"TinyPixel", "1 image GRAY pixel 1e-30 origin 1 1", "cannot be told apart"},
         {"Region", "1 image GRAY pixel 0.1 in nowhere", "region nowhere does not exist"},
         {"Field", "1 image GRAY pixel 0.1 field d_none 1 0", "d_none must be a vector of reals"},
         {"FieldKind", "1 image GRAY pixel 0.1 field i_n 1 0", "i_n must be a vector of reals"},
         {"PixelsAndPpc", "1 image GRAY pixel 0.1 sites pixels ppc 2", "leave out sites pixels"},
         {"PixelsAndSpacing", "1 image GRAY pixel 0.1 sites pixels spacing 1",
          "leave out sites pixels"},
         {"Unknown", "1 image GRAY pixel 0.1 blur 1", "blur"},
         {"Style", "1 picture GRAY", "expected region, box, image, mesh, elements, or table"}})))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const ScratchFile file("gray.pgm", pgm(Pixels(10, 9, 1, [](int i, int j, int) {
                           return 10 * i + 12 * j;
                         })));
  Change mistake = GetParam();
  const std::string scene =
      flat + "fix i all property/atom i_n\nfix grid all mpm 0.1\n" + good_line;
  mistake.to = replaced(mistake.to, "GRAY", file.name);
  expect_explained(scene, mistake);
}
}    // namespace

// longer than a periodic box
TEST(Mistakes, AcrossItself)
{
  const ScratchFile file("L.pgm", pgm(L));
  for (const auto &[range, origin] : {std::pair("0 1 0 1", "0 0"), std::pair("4 5 -3 -2", "4 -3")})
    expect_error(plane("si", "p p", range) + "create_points 1 image " + file.name +
                     " pixel 0.2 sites pixels origin " + origin + "\n",
                 "is 1.2 long along y, longer than the periodic box");
}

TEST(Mistakes, Overlap)
{
  const ScratchFile file("L.pgm", pgm(L));
  const std::string command = "create_points 1 image " + file.name + " pixel 0.1 sites pixels\n";
  expect_error(flat + command + command, "refuses overlapping bodies: 16 existing");
  // phases of one file beside each other do not
  EXPECT_EQ(made_by(flat + command + replaced(command, "sites", "invert yes sites")).size(), 24u);
}
