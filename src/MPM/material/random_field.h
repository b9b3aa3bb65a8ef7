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
 *  and interpolated by cubic B-splines, whose own spectrum is divided out. The noise of a node is a
 *  function of its indices and the seed, and tiles have fixed places. A value thus depends only on
 *  the position, the length, and the seed, bit for bit, and not on the rank or the order of calls.
 */
class RandomField {
 public:
  /** Was this built with FFTW, without which fields cannot be made? */
  static bool available();

  /** length: correlation length. Throws std::runtime_error without FFTW. */
  RandomField(double length, uint64_t seed);
  ~RandomField();
  RandomField(const RandomField &) = delete;
  RandomField &operator=(const RandomField &) = delete;

  /** Value at x[3]. Throws std::runtime_error if the length is too short: if nearly every value
   *  needs a tile of its own, or if x is too large for its round-off to be small. */
  double value(const double *x) const;

  /** Frees the tiles; they are made again when needed. */
  void release() const { tiles.clear(); }

 private:
  static constexpr int PER_LENGTH = 4;    ///< nodes per length
  static constexpr int TILE = 48;         ///< cells along the side of a tile
  /** Nodes around a tile whose noise is included: four lengths, beyond which less than 1e-8 of it
   *  matters. */
  static constexpr int MARGIN = 16;
  static constexpr int WINDOW = TILE + 2 * MARGIN;
  static constexpr int KEPT = TILE + 3;    ///< nodes along a side whose splines reach the tile
  static constexpr std::size_t MAX_TILES = 128;    ///< tiles in memory, 1 MB each
  /** A tile takes as long as 10^5 values: after TILES_TO_TRY tiles, there must have been
   *  LEAST_VALUES values per tile. */
  static constexpr int64_t TILES_TO_TRY = 32, LEAST_VALUES = 2;

  using Index = std::array<int64_t, 3>;
  struct Transforms;

  double spacing;
  uint64_t seed;
  std::unique_ptr<Transforms> transforms;
  mutable std::map<Index, std::vector<double>>
      tiles;                                  ///< coefficients of the splines of each tile
  mutable int64_t ntiles = 0, nvalues = 0;    ///< tiles made and values computed so far

  void noise(int64_t i, int64_t j, int64_t k, double *pair) const;
  std::vector<double> make_tile(const Index &) const;
};

}    // namespace MPM_NS
#endif
