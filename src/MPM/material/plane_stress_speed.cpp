/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/plane_stress.h"

#include "math/matrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

using namespace MPM_NS;

namespace {

constexpr int DIRECTIONS = 32;    // of waves along a surface; misses at most 2 % of the modulus
constexpr int VOIGT[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};

/** n_1^2, n_1 n_2, n_2^2 of all directions. */
std::array<std::array<double, 3>, DIRECTIONS> directions()
{
  std::array<std::array<double, 3>, DIRECTIONS> list;
  for (int k = 0; k < DIRECTIONS; k++) {
    const double c = cos(M_PI * k / DIRECTIONS), s = sin(M_PI * k / DIRECTIONS);
    list[k] = {c * c, c * s, s * s};
  }
  return list;
}

/** Elasticity of a body in its plane, and of the material across it. The work of a small
 *  l = dF F^-1 on top of the present state is (dP F^T):l/2 with dP F^T = T:l - tau l^T. */
struct Elasticity {
  // of l = e_a e_b for the axes 11 12 21 22 along the body, and last of the stretch across it
  double M[5][5], tau[2][2];
  double across;    ///< rho_0 c^2 of a wave across the body

  Elasticity(const Tangent &t, const Batch &b, int p, const double (*axis)[3], int along, int last)
  {
    double T[9][9], stress[9], l[5][9] = {};
    for (int k = 0; k < 9; k++) {
      stress[k] = b.J[p] * b.stress[VOIGT[k]][p];
      for (int c = 0; c < 9; c++) T[k][c] = t.stress[VOIGT[k]][c][p];
    }
    for (int k = 0; k < 9; k++) {
      for (int m = 0; m < 4; m++)
        if (m == 0 || along == 2) l[m][k] = axis[m / 2][k / 3] * axis[m % 2][k % 3];
      for (int a = along; a < last; a++) l[4][k] += axis[a][k / 3] * axis[a][k % 3];
    }
    for (int n = 0; n < 5; n++) {
      double change[9] = {};
      for (int k = 0; k < 9; k++)
        for (int c = 0; c < 9; c++) change[k] += T[k][c] * l[n][c];
      for (int m = 0; m < 5; m++) {
        M[m][n] = 0.0;
        for (int k = 0; k < 9; k++) M[m][n] += l[m][k] * change[k];
      }
    }
    for (int m = 0; m < 4; m++) {
      tau[m / 2][m % 2] = 0.0;
      for (int k = 0; k < 9; k++) tau[m / 2][m % 2] += l[m][k] * stress[k];
    }
    across = 0.0;
    const double *const n = axis[along];
    for (int k = 0; k < 9; k++) {
      double change = -stress[k];
      for (int c = 0; c < 9; c++) change += T[k][c] * n[c / 3] * n[c % 3];
      across += n[k / 3] * n[k % 3] * change;
    }
  }

  /** Lets the body stretch across so that no stress acts there. */
  void release()
  {
    double most = 0.0;
    for (const auto &row : M)
      for (const double value : row) most = std::max(most, std::fabs(value));
    if (!(M[4][4] > 1.0e-12 * most)) return;    // what bears nothing across
    for (int m = 0; m < 4; m++)
      for (int n = 0; n < 4; n++) M[m][n] -= M[m][4] * M[4][n] / M[4][4];
  }

  /** rho_0 c^2 of waves along n = (n_1, n_2) that move points along axes a and b: a form of n_1^2,
   *  n_1 n_2, n_2^2 for ab = 11 22 12. */
  void waves(double (*form)[3]) const
  {
    const auto entry = [this](int a, int i, int b, int j) {
      return M[2 * a + i][2 * b + j] - (i == b ? tau[a][j] : 0.0);
    };
    for (int k = 0; k < 3; k++) {
      const int a = k == 1, b = k > 0;
      form[k][0] = 0.5 * (entry(a, 0, b, 0) + entry(b, 0, a, 0));
      form[k][1] =
          0.5 * (entry(a, 0, b, 1) + entry(a, 1, b, 0) + entry(b, 0, a, 1) + entry(b, 1, a, 0));
      form[k][2] = 0.5 * (entry(a, 1, b, 1) + entry(b, 1, a, 1));
    }
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
  double axis[3][3];
  find_directions(motion, axis);
  const Elasticity bulk(t, b, p, axis, along, last_axis());
  Elasticity body = bulk;
  body.release();

  static const auto list = directions();
  double in_bulk[3][3], in_body[3][3], of_bulk = bulk.across, of_body = 0.0;
  bulk.waves(in_bulk);
  body.waves(in_body);
  const double tau[3] = {bulk.tau[0][0], 2.0 * bulk.tau[0][1], bulk.tau[1][1]};
  for (int k = 0; k < (along == 1 ? 1 : DIRECTIONS); k++) {
    const double *const n = list[k].data();
    of_bulk = std::max(of_bulk,
                       n[0] * dot(in_bulk[0], n) + n[2] * dot(in_bulk[1], n) +
                           2.0 * n[1] * dot(in_bulk[2], n));
    const double one = dot(in_body[0], n), other = dot(in_body[1], n), both = dot(in_body[2], n),
                 apart = 0.5 * (one - other);
    // or its tension, as of a string
    of_body =
        std::max({of_body, 0.5 * (one + other) + sqrt(apart * apart + both * both), dot(tau, n)});
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
