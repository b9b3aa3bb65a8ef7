/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_QUASI_NEWTON_H
#define MPM_SOLVE_QUASI_NEWTON_H

#include "solve/block_kernels.h"

#include <cstdint>
#include <vector>

namespace MPM_NS {

/** Corrections of the inverse H0 of a matrix that has changed, by what is seen of it: pairs of a motion s and the change of forces -y that it made
 *  (BFGS).  Of the last MOST of them, in the compact form of R.H. Byrd, J. Nocedal, R.B. Schnabel, Math. Program. 63 (1994) 129, eq. 2.6:

      H = H0 + [S  H0 Y] [ R^-T (D + Y^T H0 Y) R^-1   -R^-T ] [ S^T    ]
                         [ -R^-1                         0   ] [ Y^T H0 ]

   with R the upper triangle of S^T Y and D its diagonal.  Products of S and Y with forces and their H0 are needed for the correction anyway,
   and differences of these from one iteration to the next are what a new pair adds to R and Y^T H0 Y, so that a pair costs little more than
   the room that it takes.  Vectors stand side by side in blocks, for the kernels of factors. */
class QuasiNewton {
 public:
  static constexpr int MOST = 2 * FACTOR_BLOCK;    ///< pairs

  QuasiNewton() : kernels(BlockKernels::select()) {}

  /** No pairs; vectors have n entries from now on. */
  void start(std::size_t n);
  /** The correction d = H f by the forces f that are left, with z = H0 f.  If there was a motion since the last one, it becomes a pair first. */
  void correct(const double *f, const double *z, double *d);
  /** The motion s was made since correct(). */
  void moved(const double *s) { last_motion.assign(s, s + n); }
  bool has_moved() const { return !last_motion.empty(); }
  /** A motion becomes a pair with the forces f that it has left, z = H0 f, and no correction is wanted. */
  void settle(const double *f, const double *z);
  int pairs() const { return (int) order.size(); }
  double memory_usage() const;

 private:
  static constexpr int B = FACTOR_BLOCK, BLOCKS = MOST / B;

  BlockKernels kernels;
  std::size_t n = 0, padded = 0;
  std::vector<double> S[BLOCKS], Y[BLOCKS], Z[BLOCKS];    // [entry][B], Z = H0 Y
  double SY[MOST][MOST], YZ[MOST][MOST];                  // by the places of pairs
  std::vector<int> order;                                 // places, the oldest one first
  std::vector<double> last_motion, last_f, last_z;        // of the last correction
  double last_s_f[MOST], last_y_z[MOST];                  // products of S with f, and of Y with z
  double s_f[MOST], y_z[MOST];
  std::vector<double> of_f, of_z, sum;

  void look(const double *f, const double *z);
  void learn();
};

}    // namespace MPM_NS
#endif
