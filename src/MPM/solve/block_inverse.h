/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_BLOCK_INVERSE_H
#define MPM_SOLVE_BLOCK_INVERSE_H

#include "solve/lattice_key.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cstdint>

namespace MPM_NS {

/** A number at random that depends on the place alone. */
inline double place_noise(const LatticeIndex &index, int a)
{
  uint64_t seed = lattice_key(index) + 77 * a;
  for (int k = 0; k < 3; k++) {
    seed ^= seed >> 29;
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  }
  return (double) (seed >> 33) / (1u << 30) - 1.0;
}

/** A block of a node. */
using NodeBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;

/** Inverse of a symmetric matrix; directions without stiffness have a little. */
inline NodeBlock inverse_of(const NodeBlock &A)
{
  const double scale = A.trace() / A.rows();
  Eigen::SelfAdjointEigenSolver<NodeBlock> modes(A);
  Eigen::VectorXd values = modes.eigenvalues();
  for (int a = 0; a < values.size(); a++) values[a] = 1.0 / std::max(values[a], 1.0e-6 * scale);
  return modes.eigenvectors() * values.asDiagonal() * modes.eigenvectors().transpose();
}

}    // namespace MPM_NS
#endif
