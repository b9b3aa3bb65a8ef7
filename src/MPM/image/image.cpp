/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "image/image.h"

#include <cstring>
#include <utility>

using namespace MPM_NS;

std::size_t MPM_NS::image_bytes(ImageKind kind)
{
  switch (kind) {
    case ImageKind::UINT8:
    case ImageKind::INT8:
      return 1;
    case ImageKind::UINT16:
    case ImageKind::INT16:
      return 2;
    case ImageKind::DOUBLE:
      return 8;
    default:
      return 4;
  }
}

template <class T> static double as(const unsigned char *from)
{
  T value;
  memcpy(&value, from, sizeof(T));
  return value;
}

double Image::number(int64_t pixel, int channel) const
{
  const unsigned char *from = data.data() + image_bytes(kind) * (pixel * channels + channel);
  switch (kind) {
    case ImageKind::UINT8:
      return *from;
    case ImageKind::INT8:
      return as<int8_t>(from);
    case ImageKind::UINT16:
      return as<uint16_t>(from);
    case ImageKind::INT16:
      return as<int16_t>(from);
    case ImageKind::UINT32:
      return as<uint32_t>(from);
    case ImageKind::INT32:
      return as<int32_t>(from);
    case ImageKind::FLOAT:
      return as<float>(from);
    default:
      return as<double>(from);
  }
}

double Image::gray(int64_t pixel) const
{
  if (channels == 1) return number(pixel, 0);
  const double r = number(pixel, 0), g = number(pixel, 1), b = number(pixel, 2);
  return r == g && g == b ? r : 0.299 * r + 0.587 * g + 0.114 * b;
}

void Image::crop(const int64_t *first, const int64_t *count)
{
  const std::size_t each = channels * image_bytes(kind), row = count[0] * each;
  std::vector<unsigned char> kept(row * count[1] * count[2]);
  auto *to = kept.data();
  for (int64_t k = 0; k < count[2]; k++)
    for (int64_t j = 0; j < count[1]; j++, to += row)
      memcpy(to, data.data() + each * (first[0] + n[0] * (first[1] + j + n[1] * (first[2] + k))),
             row);
  data = std::move(kept);
  for (int d = 0; d < 3; d++) n[d] = count[d];
}
