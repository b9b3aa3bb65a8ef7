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

/** A system of linear equations A x = b as iterative methods see it. These methods are independent
 *  of lattices, physics, and ranks.
 *
 *  Vectors are plain arrays of size() reals. Reals of nodes that several ranks have are in the
 *  arrays of all of them, with the same values, bit by bit. If the arguments of apply() and
 *  precondition() have this property, their results must have it, too. Constraints (walls,
 *  prescribed values) are part of the operator: with the projection P on free motions, A is P K P,
 *  where K is the operator without constraints. Right sides, solutions, and results of
 *  precondition() are in the range of P. */
class LinearSystem {
 public:
  virtual ~LinearSystem() = default;

  /** Number of reals of a vector on this rank. */
  virtual int64_t size() const = 0;

  /** y = A x. Collective. */
  virtual void apply(const double *x, double *y) = 0;

  /** z = an approximation of A^-1 r, which must be symmetric and positive definite for methods for
   *  symmetric systems. The default is z = r. Collective. */
  virtual void precondition(const double *r, double *z) { std::copy_n(r, size(), z); }

  /** value[k] = a[k] . b[k] for n pairs of vectors. Each real of a node that several ranks have
   *  counts once, and the sums of the ranks are added in the order of ranks. Collective. */
  virtual void products(int n, const double *const *a, const double *const *b, double *value) = 0;

  /** a . b for one pair of vectors. Collective. */
  double product(const double *a, const double *b)
  {
    double value;
    products(1, &a, &b, &value);
    return value;
  }
};

}    // namespace MPM_NS
#endif
