/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_RANDOM_FIELD_H
#define MPM_MATERIAL_RANDOM_FIELD_H

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <vector>

namespace MPM_NS {

/** Gaussian random field with mean 0, variance 1, and correlation exp(-r^2/length^2).
 *
 *  White noise on the nodes of a lattice that covers all space is smoothed with the square root of
 *  the spectrum of the correlation (E. Vanmarcke, Random Fields, 1983, ch. 3; M. Shinozuka, C.-M.
 *  Jan, J. Sound Vib. 25 (1972) 111), by Fourier transforms of one tile of the lattice at a time,
 *  and interpolated by cubic B-splines whose own spectrum is divided out. The noise of a node is a
 *  function of its indices and the seed, and tiles have fixed places: a value depends on the
 *  position, the length, and the seed alone, bit by bit, whoever asks and in whatever order.
 */
class RandomField {
 public:
  /** Can fields be made? They need FFTW, which the build may lack. */
  static bool available();

  RandomField(double length, uint64_t seed);
  ~RandomField();
  RandomField(const RandomField &) = delete;
  RandomField &operator=(const RandomField &) = delete;

  /** Value at x[3]; throws std::runtime_error where the length is too short: nearly each value needs
   *  a tile of its own, or x is not known that well. */
  double value(const double *x) const;

  /** Frees the tiles, which are made again when needed. */
  void release() const { tiles.clear(); }

 private:
  static constexpr int PER_LENGTH = 4;    ///< nodes per length
  static constexpr int TILE = 48;         ///< cells along the side of a tile
  /** Nodes around it whose noise matters: beyond these four lengths, less than 1e-8 of it. */
  static constexpr int MARGIN = 16;
  static constexpr int WINDOW = TILE + 2 * MARGIN;
  static constexpr int KEPT = TILE + 3;            ///< nodes with a spline in the tile
  static constexpr std::size_t MAX_TILES = 128;    ///< in memory: 1 MB each
  /** A tile takes as long as 10^5 values: after some, each must have served several. */
  static constexpr int64_t TILES_TO_TRY = 32, LEAST_VALUES = 2;

  using Index = std::array<int64_t, 3>;
  struct Transforms;

  double spacing;
  uint64_t seed;
  std::unique_ptr<Transforms> transforms;
  mutable std::map<Index, std::vector<double>> tiles;    ///< coefficients of the splines
  mutable int64_t ntiles = 0, nvalues = 0;               ///< made so far, asked for so far

  void noise(int64_t i, int64_t j, int64_t k, double *pair) const;
  std::vector<double> make_tile(const Index &) const;
};

}    // namespace MPM_NS
#endif
