/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Pictures of the Netpbm programs: PBM (bits), PGM (gray), and PPM (colors), as text (P1, P2, P3)
// and as bytes (P4, P5, P6); https://netpbm.sourceforge.net/doc/#formats

#include "image/file.h"

#include <cctype>

using namespace MPM_NS;

/** The next character that is not in a comment. */
static int next(ImageFile &in)
{
  int c = in.get();
  if (c == '#')
    while (c != EOF && c != '\n') c = in.get();
  return c;
}

/** The next number of a header, or of values as text; takes the one white space after it. */
static int64_t next_number(ImageFile &in)
{
  int c = next(in);
  while (isspace(c)) c = next(in);
  if (c == EOF) in.fail("ends too early, it was cut");
  if (!isdigit(c)) in.fail(std::string("has '") + (char) c + "' where a number should be");
  int64_t value = 0;
  for (; isdigit(c); c = in.get()) {
    value = 10 * value + (c - '0');
    if (value > 1000000000000) in.fail("has a number that is too large");
  }
  if (c != EOF && !isspace(c) && c != '#')
    in.fail(std::string("has '") + (char) c + "' where a number should end");
  if (c == '#')
    while (c != EOF && c != '\n') c = in.get();
  return value;
}

/** A bit of P1, which need not be apart from the next one: 1 is black. */
static int next_bit(ImageFile &in)
{
  int c = next(in);
  while (isspace(c)) c = next(in);
  if (c == EOF) in.fail("ends too early, it was cut");
  if (c != '0' && c != '1') in.fail("has other values than 0 and 1");
  return c - '0';
}

Image MPM_NS::read_netpbm(ImageFile &in)
{
  in.get();
  const int type = in.get() - '0';    // 1 to 6
  const bool text = type <= 3, bits = type == 1 || type == 4;
  Image image;
  image.channels = type == 3 || type == 6 ? 3 : 1;
  image.n[0] = next_number(in);
  image.n[1] = next_number(in);
  image.n[2] = 1;
  const int64_t largest = bits ? 1 : next_number(in);
  if (largest < 1 || largest > 65535)
    in.fail("has the largest value " + std::to_string(largest) + ", which must be 1 to 65535");
  image.largest = largest;
  if (largest > 255) image.kind = ImageKind::UINT16;

  if (!text && !bits) {
    in.read_values(image, true);
  } else {
    in.make_room(image, type == 4 ? 1.0 : 8.0);
    auto *to = image.data.data();
    for (int64_t row = 0; row < image.n[1]; row++) {
      int byte = 0;
      for (int64_t k = 0; k < image.n[0] * image.channels; k++, to += image_bytes(image.kind)) {
        if (type == 4) {
          if (k % 8 == 0 && (byte = in.get()) == EOF) in.fail("ends too early, it was cut");
          *to = !(byte >> (7 - k % 8) & 1);
        } else if (type == 1) {
          *to = !next_bit(in);
        } else {
          const int64_t value = next_number(in);
          if (value > largest)
            in.fail("has the value " + std::to_string(value) + ", but the largest is to be " +
                    std::to_string(largest));
          if (image.kind == ImageKind::UINT16)
            *reinterpret_cast<uint16_t *>(to) = value;
          else
            *to = value;
        }
      }
    }
  }
  if (!text)
    for (int64_t k = 0; k < image.pixels() * image.channels; k++) {
      const double value = image.number(k / image.channels, k % image.channels);
      if (value > image.largest)
        in.fail("has the value " + std::to_string((int64_t) value) + ", but the largest is to be " +
                std::to_string(largest));
    }
  return image;
}
