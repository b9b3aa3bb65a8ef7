/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/plane_stress.h"

#include "math/matrix.h"

#include <algorithm>
#include <cmath>
#include <memory>

using namespace MPM_NS;

namespace {

constexpr int DIRECTIONS = 32;    // of waves along a surface; misses at most 2 % of the modulus
constexpr int VOIGT[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};

/** Elasticity of a point in its present state: the work of a small l = dF F^-1 on top of it is
 *  (dP F^T):l/2 with dP F^T = T:l - tau l^T. */
struct Elasticity {
  double T[9][9], tau[9];

  Elasticity(const Tangent &t, const Batch &b, int p)
  {
    for (int k = 0; k < 9; k++) {
      tau[k] = b.J[p] * b.stress[VOIGT[k]][p];
      for (int l = 0; l < 9; l++) T[k][l] = t.stress[VOIGT[k]][l][p];
    }
  }

  /** Leaves out the stretch l = X that keeps T:X free of stress. */
  void release(const double *X)
  {
    double of_X[9] = {}, on_X[9] = {}, both = 0.0, most = 0.0;
    for (int k = 0; k < 9; k++)
      for (int l = 0; l < 9; l++) {
        of_X[k] += T[k][l] * X[l];
        on_X[l] += X[k] * T[k][l];
        both += X[k] * T[k][l] * X[l];
        most = std::max(most, std::fabs(T[k][l]));
      }
    if (!(both > 1.0e-12 * most)) return;    // what bears nothing across
    for (int k = 0; k < 9; k++)
      for (int l = 0; l < 9; l++) T[k][l] -= of_X[k] * on_X[l] / both;
  }

  /** rho_0 c^2 of a wave along n that moves points along m, as a bilinear form in m. */
  double modulus(const double *n, const double *m, const double *other) const
  {
    double sum = 0.0, along = 0.0;
    for (int k = 0; k < 9; k++) {
      double stress = 0.0;
      for (int l = 0; l < 9; l++) stress += T[k][l] * other[l / 3] * n[l % 3];
      sum += m[k / 3] * n[k % 3] * stress;
      along += m[k / 3] * tau[k] * n[k % 3];
    }
    return sum - along * dot(n, other);
  }
};

}    // namespace

/** Orthonormal axes in space: those along the body first, then those across it. */
void PlaneStress::find_directions(const double *motion, double (*axis)[3]) const
{
  // what moves along a line, or the normal of a surface, is any column of a matrix of rank one
  const double cofactors[9] = MPM_COFACTORS(motion);
  const double *const m = along == 1 ? motion : cofactors;
  double only[3], longest = -1.0;
  for (int c = 0; c < 3; c++) {
    const double column[3] = {m[c], m[3 + c], m[6 + c]}, square = dot(column, column);
    if (square <= longest) continue;
    longest = square;
    std::copy_n(column, 3, only);
  }
  if (along == 1) return make_frame(only, nullptr, axis);
  int least = 0;
  for (int d = 1; d < 3; d++)
    if (std::fabs(only[d]) < std::fabs(only[least])) least = d;
  double any[3] = {}, first[3], second[3];
  any[least] = 1.0;
  cross(only, any, first);
  cross(only, first, second);
  make_frame(first, second, axis);
}

double PlaneStress::largest_share(const Tangent &t, const Batch &b, int p,
                                  const double *motion) const
{
  double axis[3][3], X[9] = {};
  find_directions(motion, axis);
  for (int a = along; a < last_axis(); a++)
    for (int k = 0; k < 9; k++) X[k] += axis[a][k / 3] * axis[a][k % 3];
  Elasticity bulk(t, b, p), body = bulk;
  body.release(X);

  double of_bulk = 0.0, of_body = 0.0;
  for (int a = along; a < last_axis(); a++)
    of_bulk = std::max(of_bulk, bulk.modulus(axis[a], axis[a], axis[a]));
  const int directions = along == 1 ? 1 : DIRECTIONS;
  for (int k = 0; k < directions; k++) {
    const double c = cos(M_PI * k / directions), s = sin(M_PI * k / directions);
    double n[3], side[3];
    for (int d = 0; d < 3; d++) {
      n[d] = c * axis[0][d] + s * axis[1][d];
      side[d] = c * axis[1][d] - s * axis[0][d];
    }
    of_bulk = std::max(of_bulk, bulk.modulus(n, n, n));
    double largest = body.modulus(n, n, n);
    if (along == 2) {
      const double other = body.modulus(n, side, side), both = body.modulus(n, n, side);
      largest = 0.5 * (largest + other) + hypot(0.5 * (largest - other), both);
    }
    double pull = 0.0;    // as of a string
    for (int i = 0; i < 9; i++) pull += n[i / 3] * bulk.tau[i] * n[i % 3];
    of_body = std::max(of_body, std::max(largest, pull));
  }
  return of_bulk > 0.0 ? std::min(1.0, of_body / of_bulk) : 1.0;
}

void PlaneStress::wave_speed(const Batch &b, const double *const *motion, double *c) const
{
  material.elastic_speed(b, c);
  if (!springs_back) {
    for (int p = 0; p < b.n; p++) c[p] *= sqrt(share_at_rest);
  } else if (material.has_tangent()) {
    auto now = std::make_unique<Batch>(b);
    auto tangent = std::make_unique<Tangent>();
    std::vector<double> kept(material.history().size() * BATCH);
    for (std::size_t k = 0; k < kept.size(); k++) kept[k] = b.history[k / BATCH][k % BATCH];
    now->history = reinterpret_cast<double(*)[BATCH]>(kept.data());
    now->dt = 0.0;
    for (auto &component : now->A) std::fill_n(component, b.n, 0.0);
    std::fill_n(now->heat, b.n, 0.0);
    std::copy_n(b.J, b.n, now->Jold);
    material.update_with_tangent(*now, *tangent);
    for (int p = 0; p < b.n; p++) {
      const double share = largest_share(*tangent, *now, p, motion[p]);
      if (share > 0.0) c[p] *= sqrt(share);    // a body without a direction is left as it is
    }
  }
  material.raise_speed(b, c);
}
