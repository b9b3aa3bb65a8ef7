/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_LINEAR_SYSTEM_H
#define MPM_SOLVE_LINEAR_SYSTEM_H

#include <algorithm>
#include <cstdint>

namespace MPM_NS {

/** A system of linear equations A x = b, as methods of solution see it: they know nothing of lattices, physics, and ranks.
 *
 *  Vectors are plain arrays of size() reals. Reals of nodes that several ranks have are in the arrays of all of them, and
 *  hold the same values there, bit by bit: apply() and precondition() must give such vectors if they get such ones.
 *  Constraints (walls, prescribed values) are in the operator: with the projection P on what is free, A is P K P, where K is
 *  the operator without them, and right sides, solutions, and what precondition() gives are in the range of P. */
class LinearSystem {
 public:
  virtual ~LinearSystem() = default;

  /** Reals of a vector on this rank. */
  virtual int64_t size() const = 0;

  /** y = A x. Collective. */
  virtual void apply(const double *x, double *y) = 0;

  /** z = an approximation of A^-1 r; symmetric and positive definite for methods that are for symmetric systems. The
   *  one here does nothing. Collective. */
  virtual void precondition(const double *r, double *z) { std::copy_n(r, size(), z); }

  /** value[k] = a[k] . b[k] for n pairs of vectors, each real of a node that several ranks have counted once, with the sums
   *  of the ranks added in the order of ranks. Collective. */
  virtual void products(int n, const double *const *a, const double *const *b, double *value) = 0;

  double product(const double *a, const double *b)
  {
    double value;
    products(1, &a, &b, &value);
    return value;
  }
};

}    // namespace MPM_NS
#endif
