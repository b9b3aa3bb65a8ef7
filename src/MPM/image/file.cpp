/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Access to the bytes of image files, and which reader is for a file; values without a header, and
// numbered files.

#include "image/file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <sys/stat.h>

using namespace MPM_NS;

static constexpr int64_t MAX_LINE = 100000;    // bytes; else it is no header

ImageFile::ImageFile(const std::string &name) : name(name), size(0), fp(nullptr)
{
  struct stat info;
  if (stat(name.c_str(), &info) != 0) fail(std::string("cannot be read: ") + strerror(errno));
  if (!S_ISREG(info.st_mode)) fail("is no file");
  size = info.st_size;
  if (size == 0) fail("is empty");
  fp = fopen(name.c_str(), "rb");
  if (!fp) fail(std::string("cannot be read: ") + strerror(errno));
}

ImageFile::~ImageFile()
{
  if (fp) fclose(fp);
}

void ImageFile::fail(const std::string &what) const
{
  throw std::runtime_error("image " + name + ": " + what);
}

int64_t ImageFile::here() const
{
  return ftello(fp);
}

void ImageFile::go_to(int64_t place)
{
  if (place < 0) place += size;
  if (place < 0 || place > size || fseeko(fp, place, SEEK_SET) != 0)
    fail("has only " + std::to_string(size) + " bytes, less than the header says");
}

void ImageFile::read(void *to, std::size_t n)
{
  if (fread(to, 1, n, fp) != n) fail("ends too early, it was cut");
}

bool ImageFile::line(std::string &text)
{
  text.clear();
  int c;
  while ((c = get()) != EOF && c != '\n') {
    text += (char) c;
    if ((int64_t) text.size() > MAX_LINE) fail("has a header that does not end");
  }
  if (!text.empty() && text.back() == '\r') text.pop_back();
  return c != EOF || !text.empty();
}

std::string ImageFile::magic()
{
  char bytes[8];
  const std::size_t n = fread(bytes, 1, sizeof(bytes), fp);
  go_to(0);
  return std::string(bytes, n);
}

void ImageFile::check_size(const ImageLayout &image, double least_bits)
{
  double pixels = 1.0;    // a product of large numbers does not overflow as a real
  std::string sizes;
  for (const int64_t n : image.n) {
    sizes += (sizes.empty() ? "" : " x ") + std::to_string(n);
    pixels *= n;
  }
  for (const int64_t n : image.n)
    if (n <= 0) fail("has the size " + sizes + ", which must be positive");
  const double least = pixels * image.channels * least_bits / 8.0;
  if (least > (double) (size - here()))
    fail("has the size " + sizes + " by its header or the input, which needs " +
         std::to_string((int64_t) std::min(least, 9.0e18)) + " bytes at least, but only " +
         std::to_string(size - here()) + " are there: the file was cut, or the size is wrong");
}

void ImageFile::make_room(Image &image, double least_bits)
{
  check_size(image, least_bits);
  image.data.resize(image.bytes());
}

void ImageFile::read_values(Image &image, bool big_endian)
{
  const std::size_t each = image_bytes(image.kind);
  make_room(image, 8.0 * each);
  read(image.data.data(), image.data.size());
  const uint16_t one = 1;
  const bool big_machine = *reinterpret_cast<const unsigned char *>(&one) == 0;
  if (each > 1 && big_endian != big_machine)
    for (std::size_t k = 0; k < image.data.size(); k += each)
      std::reverse(image.data.begin() + k, image.data.begin() + k + each);
}

static Image read_raw(ImageFile &in, const RawLayout &raw)
{
  Image image;
  for (int d = 0; d < 3; d++) image.n[d] = raw.n[d];
  image.kind = raw.kind;
  image.picture = false;
  if (raw.kind == ImageKind::UINT8) image.largest = 255;
  if (raw.kind == ImageKind::UINT16) image.largest = 65535;
  in.go_to(raw.skip);
  image.data.clear();
  in.read_values(image, raw.big_endian);
  if (in.here() != in.size)
    in.fail("has " + std::to_string(in.size - in.here()) +
            " bytes more than its values take: its size or the kind of its values is another one, "
            "or it has a header "
            "(keyword skip)");
  return image;
}

static Image read_one(const std::string &name, const RawLayout &raw)
{
  ImageFile in(name);
  if (raw.n[0] > 0) return read_raw(in, raw);
  const std::string magic = in.magic();
  if (magic.size() > 2 && magic[0] == 'P' && magic[1] >= '1' && magic[1] <= '6' &&
      (isspace((unsigned char) magic[2]) || magic[2] == '#'))
    return read_netpbm(in);
  if (magic == "\x89PNG\r\n\x1a\n") return read_png(in);
  if (magic.substr(0, 4) == "NRRD") return read_nrrd(in);
  in.fail("is neither PBM, PGM, PPM, PNG, nor NRRD by its first bytes: convert it, or give its "
          "size with keyword raw "
          "if it has values only");
}

static void check_values(const std::string &name, const Image &image)
{
  if (image.kind != ImageKind::FLOAT && image.kind != ImageKind::DOUBLE) return;
  for (int64_t k = 0; k < image.pixels(); k++) {
    const double value = image.number(k, 0);
    if (std::isfinite(value)) continue;
    throw std::runtime_error("image " + name + ": the value at column " +
                             std::to_string(k % image.n[0]) + ", row " +
                             std::to_string(k / image.n[0] % image.n[1]) + ", slice " +
                             std::to_string(k / image.n[0] / image.n[1]) + " is " +
                             std::to_string(value) + ": is the order of bytes right?");
  }
}

/** The name of a slice: its number in the place of %d or %0<width>d. */
static std::string slice_name(const std::string &pattern, int64_t number)
{
  const auto wrong = [&](const std::string &what) {
    throw std::runtime_error("image " + pattern + ": " + what);
  };
  const auto place = pattern.find('%');
  auto end = place == std::string::npos ? place : place + 1;
  while (end < pattern.size() && isdigit((unsigned char) pattern[end])) end++;
  if (end >= pattern.size() || pattern[end] != 'd' || pattern.find('%', end) != std::string::npos ||
      end - place > 4)
    wrong("the name of numbered files needs one %d, or %04d for four digits, where the number is");
  std::string digits = std::to_string(number);
  const std::string width = pattern.substr(place + 1, end - place - 1);
  if (!width.empty() && width[0] != '0')
    wrong("numbers with blanks in front: write %0" + width + "d");
  const std::size_t least = width.empty() ? 1 : std::stoul(width);
  if (digits.size() < least) digits.insert(0, least - digits.size(), '0');
  return pattern.substr(0, place) + digits + pattern.substr(end + 1);
}

Image MPM_NS::read_image(const std::string &file, const RawLayout &raw, const SliceRange &slices)
{
  if (slices.last < slices.first) {
    Image image = read_one(file, raw);
    check_values(file, image);
    return image;
  }

  Image stack;
  for (int64_t k = slices.first; k <= slices.last; k++) {
    const std::string name = slice_name(file, k);
    Image slice = read_one(name, raw);
    check_values(name, slice);
    if (slice.n[2] != 1)
      throw std::runtime_error("image " + name + ": is a stack of " + std::to_string(slice.n[2]) +
                               " slices and not one of them");
    if (k == slices.first) {
      stack = std::move(slice);
      continue;
    }
    if (slice.n[0] != stack.n[0] || slice.n[1] != stack.n[1] || slice.kind != stack.kind ||
        slice.channels != stack.channels || slice.largest != stack.largest)
      throw std::runtime_error("image " + name + ": its size of " + std::to_string(slice.n[0]) +
                               " x " + std::to_string(slice.n[1]) +
                               " or the kind of its values is not that of the first slice with " +
                               std::to_string(stack.n[0]) + " x " + std::to_string(stack.n[1]));
    stack.data.insert(stack.data.end(), slice.data.begin(), slice.data.end());
    stack.n[2]++;
  }
  return stack;
}
