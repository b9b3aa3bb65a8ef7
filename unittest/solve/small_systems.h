// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_TEST_SMALL_SYSTEMS_H
#define MPM_TEST_SMALL_SYSTEMS_H

// Small systems of equations for tests of solvers.

#include "solve/linear_system.h"

#include <functional>
#include <utility>

namespace MPM_NS {

/** A system on one rank with the operator A and the preconditioner M, which are functions. */
class System : public LinearSystem {
 public:
  using Operator = std::function<void(const double *, double *)>;
  System(int n, Operator A, Operator M = nullptr) : n(n), A(std::move(A)), M(std::move(M)) {}
  int64_t size() const override { return n; }
  void apply(const double *x, double *y) override { A(x, y); }
  void precondition(const double *r, double *z) override
  {
    if (M)
      M(r, z);
    else
      LinearSystem::precondition(r, z);
  }
  void products(int m, const double *const *a, const double *const *b, double *value) override
  {
    for (int k = 0; k < m; k++) {
      value[k] = 0.0;
      for (int i = 0; i < n; i++) value[k] += a[k][i] * b[k][i];
    }
  }

 private:
  int n;
  Operator A, M;
};

/** Operator of a rod: n unknowns joined by unit springs, with both ends fixed (held) or free. */
inline System::Operator rod(int n, bool held)
{
  return [=](const double *x, double *y) {
    for (int i = 0; i < n; i++) {
      const double left = i ? x[i - 1] : (held ? 0.0 : x[i]),
                   right = i < n - 1 ? x[i + 1] : (held ? 0.0 : x[i]);
      y[i] = 2.0 * x[i] - left - right;
    }
  };
}

}    // namespace MPM_NS
#endif
