/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_IMAGE_FILE_H
#define MPM_IMAGE_FILE_H

// What the readers of image files share: bytes of a file, and sizes that fit what is there.

#include "image/image.h"

#include <cstdio>
#include <string>

namespace MPM_NS {

/** A file of bytes, whose mistakes are std::runtime_error. */
class ImageFile {
 public:
  explicit ImageFile(const std::string &name);
  ~ImageFile();
  ImageFile(const ImageFile &) = delete;
  ImageFile &operator=(const ImageFile &) = delete;

  const std::string name;
  int64_t size;    ///< bytes
  FILE *fp;

  [[noreturn]] void fail(const std::string &what) const;

  int64_t here() const;         ///< bytes before the place where one reads
  void go_to(int64_t place);    ///< counted from the begin, negative: from the end
  int get() { return getc(fp); }
  void read(void *to, std::size_t n);
  /** A line without its end; false: there is no more. */
  bool line(std::string &);

  /** The first bytes, as a string. */
  std::string magic();

  /** Checks columns, rows, and slices of a header: positive, and not more values than can be in the rest of the file
   *  with so many bits for each at the least. */
  void check_size(const ImageLayout &, double least_bits);
  /** The same, and then makes room for the values. */
  void make_room(Image &, double least_bits);
  /** Reads all values, as they stand in the file. */
  void read_values(Image &, bool big_endian);
};

// by format; the file is at its begin
Image read_netpbm(ImageFile &);
Image read_png(ImageFile &);
Image read_nrrd(ImageFile &);
Image read_raw(ImageFile &, const RawLayout &);

}    // namespace MPM_NS
#endif
