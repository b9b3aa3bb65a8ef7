/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_IMAGE_IMAGE_H
#define MPM_IMAGE_IMAGE_H

// Pictures and stacks of pictures: gray values or colors of pixels. Nothing here knows about
// LAMMPS. (mpm_image.h is about periodic images.)

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace MPM_NS {

enum class ImageKind : int { UINT8, INT8, UINT16, INT16, UINT32, INT32, FLOAT, DOUBLE };

std::size_t image_bytes(ImageKind);

/** Description of an image without its values; plain data, so that it can be sent as bytes. */
struct ImageLayout {
  int64_t n[3] = {0, 0, 0};    ///< columns, rows, slices, in the order of the file, columns fastest
  int channels = 1;            ///< 1: gray, 3: red, green, blue
  ImageKind kind = ImageKind::UINT8;
  double largest = 0.0;    ///< value of white; 0: not defined by the format
  /** Spacing of columns, rows, slices as given in the file; 0: not given. */
  double spacing[3] = {0.0, 0.0, 0.0};
  bool picture = true;    ///< rows are counted from the top, as in pictures
  bool turned = false;    ///< the file says that its axes are not x, y, z; this is ignored

  int64_t pixels() const { return n[0] * n[1] * n[2]; }
  std::size_t bytes() const { return pixels() * channels * image_bytes(kind); }
};

struct Image : ImageLayout {
  std::vector<unsigned char> data;    ///< the numbers, in the byte order of this machine

  /** Value of a channel of a pixel; pixel = column + n[0]*(row + n[1]*slice). */
  double number(int64_t pixel, int channel) const;
  /** Gray value of a pixel: its value, or the brightness 0.299 R + 0.587 G + 0.114 B of a color
   *  (ITU-R BT.601). */
  double gray(int64_t pixel) const;

  /** Keeps columns, rows, slices first[d] to first[d] + count[d] - 1. */
  void crop(const int64_t *first, const int64_t *count);
};

/** Layout of files without a header, from the input. */
struct RawLayout {
  int64_t n[3] = {0, 0, 0};    ///< 0: the file has a header
  ImageKind kind = ImageKind::UINT8;
  bool big_endian = false;
  int64_t skip = 0;    ///< bytes in front of the values
};

/** Numbers of a series of files. Their name has %d in place of the number, or %04d for at least
 *  four digits. */
struct SliceRange {
  int64_t first = 0, last = -1;    ///< last < first: a single file
};

/** Reads an image or a stack of images. The format is found from the first bytes of the file: PBM,
 *  PGM, PPM (P1 to P6), PNG, or NRRD; or the file has values without a header. On errors, also if a
 *  value is not finite, throws std::runtime_error that begins with the name of the file. */
Image read_image(const std::string &file, const RawLayout &raw = {}, const SliceRange &slices = {});

bool png_available();

}    // namespace MPM_NS
#endif
