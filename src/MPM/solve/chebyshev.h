/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_CHEBYSHEV_H
#define MPM_SOLVE_CHEBYSHEV_H

// Chebyshev polynomials as smoothers of multigrid (M. Adams, M. Brezina, J. Hu, R. Tuminaro, J.
// Comput. Phys. 188 (2003) 593). They need only products, so that they are the same for any order
// of unknowns and any number of ranks.

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace MPM_NS {

/** Degree of the polynomial, and number of products for the estimate of the largest eigenvalue. The
 *  polynomial acts on the upper part of the spectrum, from CHEBYSHEV_PART times the largest
 *  eigenvalue on. */
constexpr int CHEBYSHEV_DEGREE = 2, LANCZOS_PRODUCTS = 10;
constexpr double CHEBYSHEV_PART = 0.15;

/** z += p(B A) B (r - A z) with a Chebyshev polynomial p for the upper part of the spectrum, which
 *  ends at largest. apply(z, y): y = A z. precondition(r, y): y = B r. from_zero: z is 0 at the
 *  start. work: three vectors. */
template <class Apply, class Precondition>
void chebyshev(int64_t n, double largest, const double *r, double *z, bool from_zero,
               std::vector<double> *work, const Apply &apply, const Precondition &precondition)
{
  auto &rest = work[0], &update = work[1], &direction = work[2];
  for (int k = 0; k < 3; k++) work[k].resize(n);
  const double middle = 0.5 * (1.0 + CHEBYSHEV_PART) * largest,
               half = 0.5 * (1.0 - CHEBYSHEV_PART) * largest;
  double rho = half / middle;
  for (int k = 0; k < CHEBYSHEV_DEGREE; k++) {
    if (from_zero && k == 0)
      std::copy_n(r, n, rest.data());
    else {
      apply(z, rest.data());
      for (int64_t i = 0; i < n; i++) rest[i] = r[i] - rest[i];
    }
    precondition(rest.data(), update.data());
    const double next = 1.0 / (2.0 * middle / half - rho);
    const double by_old = k ? next * rho : 0.0, by_new = k ? 2.0 * next / half : 1.0 / middle;
    if (k == 0)
      std::fill(direction.begin(), direction.end(), 0.0);
    else
      rho = next;
    for (int64_t i = 0; i < n; i++) {
      direction[i] = by_old * direction[i] + by_new * update[i];
      z[i] += direction[i];
    }
  }
}

/** Estimates the largest eigenvalue of B A, increased by 10 percent, with the Lanczos method in the
 *  form of conjugate gradients for the right side A B p. product(a, b): a . b. */
template <class Apply, class Precondition, class Product>
double largest_eigenvalue_of(int64_t n, std::vector<double> p, const Apply &apply,
                             const Precondition &precondition, const Product &product)
{
  std::vector<double> r(n), z(n), Ap(n);
  precondition(p.data(), z.data());
  apply(z.data(), r.data());
  precondition(r.data(), z.data());
  p = z;
  double rz = product(r.data(), z.data()), alpha_before = 0.0, beta = 0.0;
  Eigen::VectorXd diagonal(LANCZOS_PRODUCTS), below(LANCZOS_PRODUCTS);
  int k = 0;
  while (k < LANCZOS_PRODUCTS && rz > 0.0) {
    apply(p.data(), Ap.data());
    const double curvature = product(p.data(), Ap.data());
    if (!(curvature > 0.0)) break;
    const double alpha = rz / curvature;
    diagonal[k] = 1.0 / alpha + (k ? beta / alpha_before : 0.0);
    for (int64_t i = 0; i < n; i++) r[i] -= alpha * Ap[i];
    precondition(r.data(), z.data());
    const double next = product(r.data(), z.data());
    beta = next / rz;
    below[k] = std::sqrt(std::max(beta, 0.0)) / alpha;
    for (int64_t i = 0; i < n; i++) p[i] = z[i] + beta * p[i];
    rz = next;
    alpha_before = alpha;
    k++;
    if (!(beta > 1.0e-20)) break;
  }
  if (k == 0) return 1.0;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> values;
  values.computeFromTridiagonal(diagonal.head(k), below.head(k - 1), Eigen::EigenvaluesOnly);
  return 1.1 * values.eigenvalues().maxCoeff();
}

}    // namespace MPM_NS
#endif
