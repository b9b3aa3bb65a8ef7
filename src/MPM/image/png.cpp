/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// PNG by libpng: gray, colors, palettes, up to 16 bits; transparency is left out.

#include "image/file.h"

#ifdef MPM_PNG
#include <png.h>

#include <csetjmp>
#include <cstring>
#endif

using namespace MPM_NS;

#ifndef MPM_PNG

bool MPM_NS::png_available()
{
  return false;
}

Image MPM_NS::read_png(ImageFile &in)
{
  in.fail("PNG files can be read only if the package was built with libpng: install it "
          "(libpng-dev) and build again, "
          "or convert the file to PGM or PPM");
}

#else

bool MPM_NS::png_available()
{
  return true;
}

namespace {

constexpr double MOST_PACKED = 1100.0;    // deflate packs 1032 bytes into one at the most

struct Failure {
  char text[256] = "";
};

void fail(png_structp png, png_const_charp text)
{
  strncpy(static_cast<Failure *>(png_get_error_ptr(png))->text, text, sizeof(Failure::text) - 1);
  longjmp(png_jmpbuf(png), 1);
}

void warn(png_structp, png_const_charp) {}

// An error in libpng jumps out of these functions, which must have nothing to be destroyed.

bool read_header(png_structp png, png_infop info, FILE *fp, ImageLayout &layout)
{
  if (setjmp(png_jmpbuf(png))) return false;
  png_init_io(png, fp);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
  png_read_info(png, info);
  layout.n[0] = png_get_image_width(png, info);
  layout.n[1] = png_get_image_height(png, info);
  layout.n[2] = 1;
  return true;
}

/** Asks for gray values or colors without transparency; libpng makes room for rows. */
bool choose_values(png_structp png, png_infop info, ImageLayout &layout)
{
  if (setjmp(png_jmpbuf(png))) return false;
  const int color = png_get_color_type(png, info);
  int bits = png_get_bit_depth(png, info);
  if (color == PNG_COLOR_TYPE_PALETTE) {
    png_set_palette_to_rgb(png);
    bits = 8;
  }
  if (bits < 8) png_set_packing(png);
  if (color & PNG_COLOR_MASK_ALPHA || png_get_valid(png, info, PNG_INFO_tRNS))
    png_set_strip_alpha(png);
  const uint16_t one = 1;
  if (bits == 16 && *reinterpret_cast<const unsigned char *>(&one) == 1) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  layout.channels = png_get_channels(png, info);
  layout.kind = bits == 16 ? ImageKind::UINT16 : ImageKind::UINT8;
  layout.largest = (1 << bits) - 1;
  return true;
}

bool read_rows(png_structp png, png_bytepp rows)
{
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

struct Reader {
  Failure failure;
  png_structp png;
  png_infop info;
  Reader()
  {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, fail, warn);
    info = png ? png_create_info_struct(png) : nullptr;
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

}    // namespace

Image MPM_NS::read_png(ImageFile &in)
{
  Reader reader;
  Image image;
  if (!reader.info) in.fail("libpng could not be started");
  const auto refuse = [&] {
    in.fail(std::string("libpng says: ") + reader.failure.text);
  };
  if (!read_header(reader.png, reader.info, in.fp, image)) refuse();
  const int64_t place =
      in.here();    // some of what is compressed may have been read with the header
  in.go_to(0);
  in.check_size(image, 1.0 / MOST_PACKED);
  in.go_to(place);
  if (!choose_values(reader.png, reader.info, image)) refuse();
  if (image.channels != 1 && image.channels != 3)
    in.fail("has " + std::to_string(image.channels) +
            " channels, which are neither gray nor red, green, and blue");
  image.data.resize(image.bytes());

  const std::size_t row = image.bytes() / image.n[1];
  std::vector<png_bytep> rows;
  for (int64_t k = 0; k < image.n[1]; k++) rows.push_back(image.data.data() + k * row);
  if (png_get_rowbytes(reader.png, reader.info) != row)
    in.fail("has rows that libpng did not convert");
  if (!read_rows(reader.png, rows.data())) refuse();
  return image;
}

#endif
