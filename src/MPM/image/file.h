/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_IMAGE_FILE_H
#define MPM_IMAGE_FILE_H

// Common parts of the readers of image files: access to bytes, and checks of sizes against the
// length of the file.

#include "image/image.h"

#include <cstdio>
#include <string>

namespace MPM_NS {

/** A binary file; all functions throw std::runtime_error, with the name of the file, on errors. */
class ImageFile {
 public:
  explicit ImageFile(const std::string &name);
  ~ImageFile();
  ImageFile(const ImageFile &) = delete;
  ImageFile &operator=(const ImageFile &) = delete;

  const std::string name;
  int64_t size;    ///< bytes
  FILE *fp;

  /** Throws std::runtime_error with the name of the file and this text. */
  [[noreturn]] void fail(const std::string &what) const;

  int64_t here() const;                  ///< position in bytes from the start of the file
  void go_to(int64_t place);             ///< position from the start; negative: from the end
  int get() { return getc(fp); }         ///< next byte, or EOF
  void read(void *to, std::size_t n);    ///< n bytes
  /** Reads a line, without its end; false at the end of the file. */
  bool line(std::string &);

  /** The first 8 bytes (or fewer, if the file is shorter) as a string; goes back to the start of
   *  the file. */
  std::string magic();

  /** Checks that the numbers of columns, rows, and slices are positive, and that the rest of the
   *  file can hold the values, with at least least_bits bits for each. */
  void check_size(const ImageLayout &, double least_bits);
  /** Does check_size(), and then allocates memory for the values. */
  void make_room(Image &, double least_bits);
  /** Does make_room(), and then reads all values in the order of the file, as numbers of this
   *  machine. */
  void read_values(Image &, bool big_endian);
};

// readers by format; the file must be at its start
Image read_netpbm(ImageFile &);
Image read_png(ImageFile &);
Image read_nrrd(ImageFile &);

}    // namespace MPM_NS
#endif
