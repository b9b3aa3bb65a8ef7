// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// The readers of image files, and the share of a body with a surface between pixels.

#include "image/image_testing.h"

#include "image/body.h"
#include "image/image.h"
#include "image/level_set.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

using namespace MPM_NS;
using namespace MPM_TEST;
using ::testing::HasSubstr;

struct File {
  const std::string name;
  File(const std::string &base, const std::string &text) : name("test_image." + base)
  {
    FILE *fp = fopen(name.c_str(), "wb");
    fwrite(text.data(), 1, text.size(), fp);
    fclose(fp);
  }
  ~File() { remove(name.c_str()); }
};

static Image read(const std::string &text, const RawLayout &raw = {})
{
  File file("in", text);
  return read_image(file.name, raw);
}

template <class... Args> static std::string failure_of(const Args &...args)
{
  try {
    read_image(args...);
  } catch (const std::runtime_error &e) {
    return e.what();
  }
  return "";
}
static std::string failure(const std::string &text, const RawLayout &raw = {})
{
  const File file("in", text);
  return failure_of(file.name, raw);
}

// values that tell columns, rows, and slices apart; 13 columns are no whole bytes of bits
static int odd(int i, int j, int k)
{
  return (17 * i + 31 * j + 57 * k + i * j) % 251;
}
const Pixels picture(13, 7, 1, odd), stack(5, 4, 3, odd);

static void expect_values(const Image &image, const Pixels &p, const std::string &what,
                          int factor = 1, int offset = 0)
{
  ASSERT_EQ(image.n[0], p.nx) << what;
  ASSERT_EQ(image.n[1], p.ny) << what;
  ASSERT_EQ(image.n[2], p.nz) << what;
  for (std::size_t k = 0; k < p.values.size(); k++)
    ASSERT_EQ(image.gray(k), factor * p.values[k] + offset) << what << ", pixel " << k;
}

static RawLayout raw_layout(const Pixels &p, ImageKind kind, bool big = false, int skip = 0)
{
  RawLayout layout;
  layout.n[0] = p.nx, layout.n[1] = p.ny, layout.n[2] = p.nz;
  layout.kind = kind;
  layout.big_endian = big;
  layout.skip = skip;
  return layout;
}

TEST(Reader, GrayValues)
{
  expect_values(read(pgm(picture)), picture, "P5");
  expect_values(read(pgm(picture, true)), picture, "P2");
  const Pixels deep(13, 7, 1, [](int i, int j, int k) {
    return 261 * odd(i, j, k);
  });
  const Image p5 = read(pgm(deep, false, 65535));
  expect_values(p5, deep, "P5, 16 bits");
  EXPECT_EQ(p5.largest, 65535);
  EXPECT_EQ(p5.bytes(), 2u * 13 * 7);
  expect_values(read(pgm(deep, true, 65535)), deep, "P2, 16 bits");
  EXPECT_EQ(read(pgm(picture, false, 251)).largest, 251);
  if (!png_available()) return;
  expect_values(read(png(picture)), picture, "PNG");
  expect_values(read(png(deep, 16)), deep, "PNG, 16 bits");
  expect_values(read(png(picture, 8, 4)), picture, "PNG with alpha");
  EXPECT_EQ(read(png(deep, 16)).largest, 65535);
}

TEST(Reader, BitsAndFewBits)
{
  const Pixels bits(13, 7, 1, [](int i, int j, int k) {
    return odd(i, j, k) % 2;
  });
  for (const bool text : {true, false}) {
    const Image image = read(pbm(bits, text));
    expect_values(image, bits, text ? "P1" : "P4");
    EXPECT_EQ(image.largest, 1);
  }
  if (!png_available()) return;
  for (const int n : {1, 2, 4}) {
    const Pixels few(13, 7, 1, [=](int i, int j, int k) {
      return odd(i, j, k) % (1 << n);
    });
    const Image image = read(png(few, n));
    expect_values(image, few, std::to_string(n) + " bits");
    EXPECT_EQ(image.largest, (1 << n) - 1);
  }
}

TEST(Reader, Colors)
{
  const Palette color = [](int v, int c) {
    return c == 0 ? v : c == 1 ? 255 - v : v / 2;
  };
  std::map<std::string, std::string> files = {{"P6", ppm(picture, color)},
                                              {"P3", ppm(picture, color, true)}};
  if (png_available()) {
    files["PNG"] = png(picture, 8, 2, color);
    files["palette"] = png(picture, 8, 3, color);
  }
  std::string header =
      nrrd_header(picture, "uchar", "encoding: raw\nkinds: RGB-color domain domain\n\n");
  header.replace(header.find("sizes: 13 7 1"), 13, "sizes: 3 13 7");
  files["NRRD"] = header + ppm(picture, color).substr(ppm(picture, color).find("255\n") + 4);
  for (const auto &[name, text] : files) {
    const Image image = read(text);
    ASSERT_EQ(image.channels, 3) << name;
    ASSERT_EQ(image.n[0], 13) << name;
    for (std::size_t k = 0; k < picture.values.size(); k++) {
      const int v = picture.values[k];
      for (int c = 0; c < 3; c++) ASSERT_EQ(image.number(k, c), color(v, c)) << name;
      ASSERT_NEAR(image.gray(k), 0.299 * v + 0.587 * (255 - v) + 0.114 * (v / 2), 1e-12) << name;
    }
  }
}

template <class T>
static void expect_kind(const std::string &type, ImageKind kind, int factor, int offset)
{
  const Pixels values(stack.nx, stack.ny, stack.nz, [=](int i, int j, int k) {
    return factor * odd(i, j, k) + offset;
  });
  for (const bool big : {false, true}) {
    const std::string endian = big ? "endian: big\n" : "endian: little\n";
    const std::string what = type + (big ? ", big" : ", little"), bytes = raw<T>(values, big);
    expect_values(read("head" + bytes, raw_layout(stack, kind, big, 4)), values, "raw " + what);
    const Image image = read(nrrd_header(stack, type, "encoding: raw\n" + endian + "\n") + bytes);
    expect_values(image, values, "NRRD " + what);
    EXPECT_EQ(image.spacing[2], 0.1);
    expect_values(read(nrrd_header(stack, type,
                                   "encoding: raw\nbyte skip: 2\nline skip: 1\n" + endian + "\n") +
                       "l\nxx" + bytes),
                  values, "NRRD with skips " + what);
    expect_values(read(nrrd_header(stack, type, "encoding: raw\nbyte skip: -1\n" + endian + "\n") +
                       "any" + bytes),
                  values, "NRRD from the end " + what);
    File data("values", bytes);
    expect_values(
        read(nrrd_header(stack, type, "encoding: raw\ndata file: " + data.name + "\n" + endian)),
        values, "NRRD, detached, " + what);
  }
}

TEST(Reader, NumbersOfAllKinds)
{
  expect_kind<uint8_t>("uchar", ImageKind::UINT8, 1, 0);
  expect_kind<int8_t>("signed char", ImageKind::INT8, 1, -125);
  expect_kind<uint16_t>("ushort", ImageKind::UINT16, 261, 0);
  expect_kind<int16_t>("short", ImageKind::INT16, -130, 10);
  expect_kind<uint32_t>("uint", ImageKind::UINT32, 1000000, 7);
  expect_kind<int32_t>("int", ImageKind::INT32, -1000000, 7);
  expect_kind<float>("float", ImageKind::FLOAT, -3, 1);
  expect_kind<double>("double", ImageKind::DOUBLE, 5, -2);
}

TEST(Reader, SpaceDirections)
{
  const auto with_directions = [](const std::string &directions) {
    std::string text = nrrd_header(stack, "uchar", "encoding: raw\n\n");
    text.replace(text.find("spacings: 0.1 0.1 0.1"), 21, "space directions: " + directions);
    return read(text + raw<uint8_t>(stack));
  };
  const Image image = with_directions("(0.3,0.4,0) (0,-2,0) (0,0,1e-3)");
  EXPECT_NEAR(image.spacing[0], 0.5, 1e-15);
  EXPECT_EQ(image.spacing[1], 2.0);
  EXPECT_EQ(image.spacing[2], 1e-3);
  EXPECT_TRUE(image.turned);
  for (const auto &[directions, turned] :
       {std::pair("(0.3,0,0) (0,2,0) (0,0,1e-3)", false),
        std::pair("(0.3,0,0) (0,-2,0) (0,0,1)", true), std::pair("(0,1,0) (2,0,0) (0,0,1)", true)})
    EXPECT_EQ(with_directions(directions).turned, turned) << directions;
}

TEST(Reader, NumberedFiles)
{
  std::vector<std::unique_ptr<File>> files;
  for (int k = 0; k < 3; k++) {
    const Pixels slice(5, 4, 1, [=](int i, int j, int) {
      return odd(i, j, k);
    });
    const char *const names[] = {"0008.pgm", "0009.pgm", "0010.pgm"};
    files.push_back(std::make_unique<File>(names[k], pgm(slice)));
  }
  const File other("0011.pgm", pgm(picture));
  expect_values(read_image("test_image.%04d.pgm", {}, {8, 10}), stack, "stack");
  const Pixels second(5, 4, 1, [](int i, int j, int) {
    return odd(i, j, 1);
  });
  expect_values(read_image("test_image.%04d.pgm", {}, {9, 9}), second, "a stack of one slice");
  const auto failure_of_slices = [](const std::string &name, int first, int last) {
    return failure_of(name, RawLayout(), SliceRange{first, last});
  };
  EXPECT_THAT(failure_of_slices("test_image.%04d.pgm", 7, 10),
              HasSubstr("test_image.0007.pgm: cannot be read: No such file"));
  EXPECT_THAT(failure_of_slices("test_image.%04d.pgm", 8, 11),
              HasSubstr("0011.pgm: its size of 13 x 7"));
  for (const char *name : {"test_image.0008.pgm", "test_image.%s.pgm", "a%d%d", "a%", "a%000009d"})
    EXPECT_THAT(failure_of_slices(name, 8, 10), HasSubstr("needs one %d")) << name;
  expect_values(read_image("test_image.0008.pgm"), Pixels(5, 4, 1, odd), "one");
}

TEST(Reader, BadFiles)
{
  const std::string good = pgm(picture);
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"", "is empty"},
      {"GIF89a", "is neither PBM"},
      {"P5", "is neither PBM"},
      {good.substr(0, good.size() - 1), "but only 90 are there"},
      {"P5\n13", "ends too early"},
      {"P5\n13 -7\n255\n", "'-' where a number should be"},
      {"P5\n0 7\n255\n", "must be positive"},
      {"P5\n13 7\n0\n", "the largest value 0"},
      {"P5\n13 7\n70000\n", "the largest value 70000"},
      {"P5\n2000000000 2000000000\n255\nabc", "4000000000000000000 bytes at least"},
      {"P5\n99999999999999999999 7\n255\n", "too large"},
      {"P2\n2 2\n255\n1 2 3", "ends too early|but only"},
      {"P2\n2 2\n255\n1 2 3 256", "has the value 256"},
      {"P2\n2 2\n255\n1 2 3 x4", "'x' where a number should be"},
      {"P5\n2 2\n100\nabcz", "has the value 122, but the largest is to be 100"},
      {"P1\n2 2\n1 0 2 1", "other values than 0 and 1"},
      {"P4\n900 90\nab", "bytes at least"},
      {nrrd_header(stack, "uchar", "encoding: gzip\n\n"), "encoding 'gzip', of which only raw"},
      {nrrd_header(stack, "block", "encoding: raw\n\n"), "type 'block'"},
      {nrrd_header(stack, "short", "encoding: raw\n\n"), "needs a field 'endian'"},
      {nrrd_header(stack, "uchar", "encoding: raw\n\n") + "abc", "but only 3 are there"},
      {nrrd_header(stack, "uchar", "encoding: raw\ndata file: no.such\n\n"),
       "no.such: cannot be read"},
      {nrrd_header(stack, "uchar", "encoding: raw\ndata file: LIST\na\nb\n"), "in several files"},
      {nrrd_header(stack, "uchar", "nonsense\n"), "'nonsense' in its header"},
      {nrrd_header(Pixels(0, 4, 1, odd), "uchar", "encoding: raw\n\n"), "must be positive"},
      {"NRRD0004\ntype: uchar\nencoding: raw\ndimension: 2\nsizes: 4 5 6\n\n", "but 3 sizes"},
      {"NRRD0004\ntype: uchar\nencoding: raw\ndimension: 1\nsizes: 4\n\nabcd", "has 1 axes"},
      {"NRRD0004\ntype: uchar\nencoding: raw\ndimension: 2\nsizes: 4 x\n\nabcd",
       "'x' where an integer"},
      {"NRRD0004\ntype: uchar\nencoding: raw\ndimension: 2\nsizes: -4 -4\n\n", "must be positive"}};
  for (const auto &[text, error] : rows)
    EXPECT_THAT(failure(text), ::testing::ContainsRegex(error)) << text.substr(0, 60);

  const Pixels one(2, 1, 1, odd);
  std::string values = bytes_of(1.0f) + bytes_of(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(failure(values, raw_layout(one, ImageKind::FLOAT)),
              HasSubstr("column 1, row 0, slice 0 is nan"));
  values = bytes_of(std::numeric_limits<double>::infinity()) + bytes_of(1.0);
  EXPECT_THAT(failure(values, raw_layout(one, ImageKind::DOUBLE)), HasSubstr("is inf"));
  EXPECT_THAT(failure("abc", raw_layout(one, ImageKind::UINT8)), HasSubstr("1 bytes more"));
  EXPECT_THAT(failure("abc", raw_layout(one, ImageKind::UINT16)), HasSubstr("needs 4 bytes"));
  EXPECT_THAT(failure("abc", raw_layout(one, ImageKind::UINT8, false, 9)),
              HasSubstr("has only 3 bytes"));
  EXPECT_THAT(failure_of("no.such.file"), HasSubstr("No such file"));
  EXPECT_THAT(failure_of("."), HasSubstr("is no file"));
}

TEST(Reader, BadPngFiles)
{
  const std::string good = png(picture);
  if (!png_available()) {
    EXPECT_THAT(failure(good), HasSubstr("libpng-dev"));
    return;
  }
  EXPECT_THAT(failure(good.substr(0, 60)), HasSubstr("libpng says"));
  std::string wrong = good;
  wrong[20] ^= 1;    // of the size, which its check sum does not fit any more
  EXPECT_THAT(failure(wrong), HasSubstr("libpng says"));
  wrong = good;
  wrong[60] ^= 1;
  EXPECT_THAT(failure(wrong), HasSubstr("libpng says"));
  const std::string header =
      bytes_of(2000000000u, true) + bytes_of(2000000000u, true) + std::string("\x08\0\0\0\0", 5);
  EXPECT_THAT(failure("\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) +
                      png_chunk("IDAT", zlib_stored("abc")) + png_chunk("IEND", "")),
              HasSubstr("bytes at least"));
}

// integral of the same by points
TEST(LevelSet, ShareOfACube)
{
  const double cases[][4] = {{0.0, 1.0, 0.0, 0.0},   {0.1, 1.0, 0.5, 0.2},
                             {-0.3, 0.2, -0.7, 0.4}, {0.05, 0.3, 1e-6, 0.3},
                             {0.6, 0.5, 0.5, 0.3},   {-0.2, 1e-5, 1e-5, 1.0},
                             {0.7, 0.4, 0.4, 0.4},   {0.02, -0.3, -0.01, 2.0}};
  for (const int dim : {2, 3})
    for (const auto &c : cases) {
      constexpr int N = 100;
      double sum = 0.0;
      for (int i = 0; i < N * N * (dim == 3 ? N : 1); i++) {
        const double x = (i % N + 0.5) / N - 0.5, y = (i / N % N + 0.5) / N - 0.5,
                     z = dim == 3 ? (i / N / N + 0.5) / N - 0.5 : 0.0;
        sum += c[0] + c[1] * x + c[2] * y + (dim == 3 ? c[3] * z : 0.0) > 0.0;
      }
      sum /= N * N * (dim == 3 ? N : 1);
      EXPECT_NEAR(share_above(c[0], c + 1, dim), sum, 0.005) << c[0] << " " << c[1] << " " << dim;
      const double opposite[3] = {-c[1], -c[2], -c[3]};
      EXPECT_NEAR(share_above(c[0], c + 1, dim) + share_above(-c[0], opposite, dim), 1.0, 1e-12);
    }
  const double flat[3] = {0.0, 0.0, 0.0};
  EXPECT_EQ(share_above(1.0, flat, 3), 1.0);
  EXPECT_EQ(share_above(-1.0, flat, 3), 0.0);
}

// a plane through an image is where it is, for boxes of any size and place
TEST(LevelSet, PlanesAreExact)
{
  const int64_t n[3] = {9, 8, 7};
  const bool open[3] = {false, false, false};
  const auto plane = [&](double x, double y, double z) {
    return 0.7 * (x - 4.0) + 0.2 * (y - 4.0) - 0.4 * (z - 3.5);
  };
  const LevelSet set(n, 3, open, 0.0, [&](int64_t k) {
    return plane(k % 9 + 0.5, k / 9 % 8 + 0.5, k / 72 + 0.5);
  });
  const double x[3] = {3.3, 4.9, 2.2};
  EXPECT_NEAR(set.at(x), plane(x[0], x[1], x[2]), 2e-7);
  const double lo[3] = {2.2, 2.9, 1.7}, hi[3] = {5.8, 5.1, 5.3};    // symmetric about the middle
  EXPECT_NEAR(set.volume(lo, hi), 0.5 * 3.6 * 2.2 * 3.6, 1e-8);
}

// planes in parts of half a pixel and of a sixteenth have the same volume behind a curved surface:
// values are linear along each axis, and those of a circle have no term in x y, so that they are
// those of a plane in each part
TEST(LevelSet, CurvedSurface)
{
  const int64_t n[3] = {20, 20, 1};
  const bool open[3] = {false, false, false};
  for (const double R : {4.1, 6.3, 8.2}) {
    const LevelSet set(n, 2, open, 0.0, [&](int64_t k) {
      const double x = k % 20 + 0.5 - 9.83, y = k / 20 + 0.5 - 10.21;
      return R * R - x * x - y * y;
    });
    double fine = 0.0;
    const double zero[2] = {0.0, 0.0}, all[2] = {20.0, 20.0};
    for (int k = 0; k < 320 * 320; k++) {
      const double lo[2] = {k % 320 / 16.0, k / 320 / 16.0},
                   hi[2] = {lo[0] + 0.0625, lo[1] + 0.0625};
      fine += set.volume(lo, hi);
    }
    EXPECT_NEAR(set.volume(zero, all), fine, 1e-7) << R;
  }
}

TEST(LevelSet, SmoothedValuesGoAroundAnImage)
{
  const int64_t n[3] = {16, 1, 1};
  const auto first = [](int64_t k) {
    return k == 0 ? 1.0 : 0.0;
  };
  for (const bool wraps : {true, false}) {
    const bool wrap[3] = {wraps, false, false};
    const LevelSet set(n, 2, wrap, 1.0, first);
    const double last[3] = {15.5, 0.5, 0.0}, second[3] = {1.5, 0.5, 0.0};
    if (wraps) {
      EXPECT_NEAR(set.at(last), set.at(second), 1e-7);
    } else {
      EXPECT_LT(set.at(last), 1e-7);
    }
  }
}
