// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_IMAGE_TESTING_H
#define MPM_IMAGE_TESTING_H

// Image files for tests, made byte by byte, independently of the code that reads them.

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace MPM_TEST {

/** Values of a picture; the index i along x runs fastest. */
struct Pixels {
  int nx, ny, nz;
  std::vector<int> values;

  Pixels(int nx, int ny, int nz, const std::function<int(int, int, int)> &f) :
      nx(nx), ny(ny), nz(nz)
  {
    for (int k = 0; k < nz; k++)
      for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) values.push_back(f(i, j, k));
  }
  int at(int i, int j, int k = 0) const { return values[i + nx * (j + ny * k)]; }
};

/** The bytes of a number. big: most significant byte first. */
template <class T> std::string bytes_of(T value, bool big = false)
{
  char raw[sizeof(T)];
  memcpy(raw, &value, sizeof(T));
  std::string text(raw, sizeof(T));    // the tests assume a little-endian machine
  return big ? std::string(text.rbegin(), text.rend()) : text;
}

/** The bytes of all values. */
template <class T> std::string raw(const Pixels &p, bool big = false)
{
  std::string text;
  for (const int v : p.values) text += bytes_of((T) v, big);
  return text;
}

inline std::string sizes(const Pixels &p)
{
  return std::to_string(p.nx) + " " + std::to_string(p.ny);
}

/** A PGM file: gray values as text, or as bytes, two of them per value if largest is above 255. */
inline std::string pgm(const Pixels &p, bool text = false, int largest = 255)
{
  std::string file =
      (text ? "P2\n# a comment\n" : "P5\n") + sizes(p) + "\n" + std::to_string(largest) + "\n";
  if (!text) return file + (largest > 255 ? raw<uint16_t>(p, true) : raw<uint8_t>(p));
  for (const int v : p.values) file += std::to_string(v) + (v % 2 ? "\n" : "  ");
  return file;
}

/** Color of a value: its red (channel 0), green (1), and blue (2). */
using Palette = std::function<int(int value, int channel)>;
inline int as_gray(int value, int)
{
  return value;
}

/** A PPM file of colors, as text or bytes. */
inline std::string ppm(const Pixels &p, const Palette &color = as_gray, bool text = false)
{
  std::string file = (text ? "P3\n" : "P6\n") + sizes(p) + " 255\n";
  for (const int v : p.values)
    for (int c = 0; c < 3; c++)
      file += text ? std::to_string(color(v, c)) + "\n" : std::string(1, (char) color(v, c));
  return file;
}

/** A PBM file: one bit per pixel, 1 (black) where the value is 0. */
inline std::string pbm(const Pixels &p, bool text)
{
  std::string file = (text ? "P1\n" : "P4\n") + sizes(p) + "\n";
  for (int j = 0; j < p.ny; j++) {
    std::string row;
    for (int i = 0; i < p.nx; i++) {
      const bool black = p.at(i, j) == 0;
      if (text) {
        row += black ? '1' : '0';
      } else {
        if (i % 8 == 0) row += '\0';
        if (black) row.back() |= 1 << (7 - i % 8);
      }
    }
    file += row + (text ? "\n" : "");
  }
  return file;
}

// PNG files (ISO/IEC 15948) whose data are not compressed

inline std::string png_chunk(const std::string &type, const std::string &data)
{
  uint32_t crc = 0xffffffff;
  for (const char c : type + data) {
    crc ^= (unsigned char) c;
    for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320 ^ (crc >> 1) : crc >> 1;
  }
  return bytes_of((uint32_t) data.size(), true) + type + data + bytes_of(~crc, true);
}

/** A zlib stream of stored (not compressed) blocks. */
inline std::string zlib_stored(const std::string &data)
{
  std::string out = "\x78\x01";
  for (std::size_t at = 0; at < data.size(); at += 65535) {
    const std::string part = data.substr(at, 65535);
    out += at + 65535 >= data.size() ? '\1' : '\0';
    out += bytes_of((uint16_t) part.size()) + bytes_of((uint16_t) ~part.size()) + part;
  }
  uint32_t a = 1, b = 0;
  for (const char c : data) {
    a = (a + (unsigned char) c) % 65521;
    b = (b + a) % 65521;
  }
  return out + bytes_of(b << 16 | a, true);
}

/** A PNG file. bits: per number; color: 0 gray, 2 colors, 3 palette, 4 gray with alpha. */
inline std::string png(const Pixels &p, int bits = 8, int color = 0, const Palette &of = as_gray)
{
  std::string rows, header = bytes_of((uint32_t) p.nx, true) + bytes_of((uint32_t) p.ny, true);
  header += {(char) bits, (char) color, 0, 0, 0};
  for (int j = 0; j < p.ny; j++) {
    rows += '\0';    // no filter
    int filled = 0;
    for (int i = 0; i < p.nx; i++) {
      const int v = p.at(i, j);
      if (color == 2) {
        for (int c = 0; c < 3; c++) rows += (char) of(v, c);
      } else if (bits == 16) {
        rows += bytes_of((uint16_t) v, true);
      } else if (bits == 8) {
        rows += (char) v;
      } else {
        if (filled % 8 == 0) rows += '\0';
        rows.back() |= v << (8 - bits - filled % 8);
        filled += bits;
      }
      if (color == 4) rows += (char) (i % 256);    // transparency
    }
  }
  std::string palette;
  for (int v = 0; v < 256 && color == 3; v++)
    for (int c = 0; c < 3; c++) palette += (char) of(v, c);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) +
      (palette.empty() ? "" : png_chunk("PLTE", palette)) + png_chunk("IDAT", zlib_stored(rows)) +
      png_chunk("IEND", "");
}

inline std::string nrrd_header(const Pixels &p, const std::string &type, const std::string &more)
{
  return "NRRD0004\n# a comment\ntype: " + type + "\ndimension: 3\nsizes: " + sizes(p) + " " +
      std::to_string(p.nz) + "\nkey:=value\nspacings: 0.1 0.1 0.1\n" + more;
}

}    // namespace MPM_TEST
#endif
