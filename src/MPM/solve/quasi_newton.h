/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_QUASI_NEWTON_H
#define MPM_SOLVE_QUASI_NEWTON_H

#include "solve/block_kernels.h"
#include "solve/bytes_of.h"

#include <cstdint>
#include <vector>

namespace MPM_NS {

/** Quasi-Newton (BFGS) corrections of the inverse H0 of a matrix that has changed since. They come
 *  from pairs of a motion s and the change of forces -y that it caused. The last MOST pairs are
 *  used, in the compact form of R.H. Byrd, J. Nocedal, R.B. Schnabel, Math. Program. 63 (1994) 129,
 *  eq. 2.6:
 *
 *      H = H0 + [S  H0 Y] [ R^-T (D + Y^T H0 Y) R^-1   -R^-T ] [ S^T    ]
 *                         [ -R^-1                         0   ] [ Y^T H0 ]
 *
 *  with the upper triangle R of S^T Y and its diagonal D. The correction needs products of S and Y
 *  with the forces f and with H0 f anyway, and the differences of these from one iteration to the
 *  next are the new entries of R and Y^T H0 Y. So a pair costs little more than its memory. Vectors
 *  stand side by side in blocks, as the kernels of the factors require. */
class QuasiNewton {
 public:
  static constexpr int MOST = 2 * FACTOR_BLOCK;    ///< largest number of pairs

  QuasiNewton() : kernels(BlockKernels::select()) {}

  /** Drops all pairs. Vectors have n entries from now on. */
  void start(std::size_t n);
  /** The correction d = H f for the remaining forces f, with z = H0 f. A motion since the last
   *  correction first becomes a pair. */
  void correct(const double *f, const double *z, double *d);
  /** Notes that the motion s was made since correct(). */
  void moved(const double *s) { last_motion.assign(s, s + n); }
  /** Has a motion been noted that is not yet a pair? */
  bool has_moved() const { return !last_motion.empty(); }
  /** Makes a pair of the noted motion, the remaining forces f, and z = H0 f, without a
   *  correction. */
  void settle(const double *f, const double *z) { look(f, z); }
  int pairs() const { return (int) order.size(); }
  double memory_usage() const;

 private:
  static constexpr int B = FACTOR_BLOCK, BLOCKS = MOST / B;

  BlockKernels kernels;
  std::size_t n = 0, padded = 0;
  std::vector<double> S[BLOCKS], Y[BLOCKS], Z[BLOCKS];    // [entry][B], Z = H0 Y
  double SY[MOST][MOST], YZ[MOST][MOST];                  // indexed by the places of pairs
  std::vector<int> order;                                 // places of pairs, oldest first
  std::vector<double> last_motion, last_f, last_z;        // at the last correction
  double last_s_f[MOST], last_y_z[MOST];                  // products of S with f, and of Y with z
  double s_f[MOST], y_z[MOST];
  std::vector<double> of_f, of_z, sum;

  void look(const double *f, const double *z);
  void learn();
};

}    // namespace MPM_NS
#endif
