/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "image/file.h"

#include <algorithm>
#include <cerrno>
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
