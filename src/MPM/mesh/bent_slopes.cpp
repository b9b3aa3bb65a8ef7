/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Slopes across the edges of a triangle, and the curvature that follows from them; what resists
// short waves; how the curvature changes within a triangle.

#include "math/matrix.h"
#include "mesh/bending.h"
#include "mesh/vector3.h"

#include <algorithm>
#include <cmath>
#include <iterator>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

namespace {

// error of slopes that needs no correction; eigenvalue below which nodes do not
// tell surfaces apart
constexpr double EXACT = 1.0e-6, DEGENERATE = 0.005;

struct Place {
  double x, y;
};

double length(const Place &a, const Place &b)
{
  return std::hypot(b.x - a.x, b.y - a.y);
}

/** Gradients of the linear functions of a triangle in the plane, in the direction m. */
void slopes_of(const Place *p, const Place &m, double *slope)
{
  const double twice =
      (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  for (int k = 0; k < 3; k++) {
    const Place &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
    slope[k] = (m.x * (a.y - b.y) + m.y * (b.x - a.x)) / twice;
  }
}

/** Unit normal of a triangle. */
void normal_of(const double *a, const double *b, const double *c, double *n)
{
  double u[3], v[3];
  difference(b, a, u);
  difference(c, a, v);
  cross(u, v, n);
  const double size = norm(n);
  for (int d = 0; d < 3; d++) n[d] /= size;
}

/** Eigenvalues w and vectors v[.][k] of a symmetric matrix (Jacobi's rotations). */
void eigenvectors(double (*a)[3], double *w, double (*v)[3])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) v[i][j] = i == j;
  for (int sweep = 0; sweep < 20; sweep++)
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (a[p][q] == 0.0) continue;
        const double angle = 0.5 * std::atan2(2.0 * a[p][q], a[q][q] - a[p][p]),
                     c = std::cos(angle), s = std::sin(angle);
        const auto turn = [&](double &first, double &second) {
          const double old = first;
          first = c * old - s * second;
          second = s * old + c * second;
        };
        for (int k = 0; k < 3; k++) turn(a[k][p], a[k][q]);
        for (int k = 0; k < 3; k++) turn(a[p][k], a[q][k]);
        for (int k = 0; k < 3; k++) turn(v[k][p], v[k][q]);
        a[p][q] = a[q][p] = 0.0;
      }
  for (int k = 0; k < 3; k++) w[k] = a[k][k];
}

/** Nodes of a patch in the plane of its triangle. */
struct Unfolded {
  Place p[PATCH_NODES] = {};
  bool has[PATCH_NODES], smooth[PATCH_NODES] = {true, true, true};
  const double (*X)[3];

  Unfolded(const double (*X)[3], const bool *neighbors);

 private:
  void unfold(int a, int b, int c, const double *n, double *normal);
};

/** Node c of a triangle beyond the edge from a to b, which has the rest on its left, with the
 *  normal n. */
void Unfolded::unfold(int a, int b, int c, const double *n, double *normal)
{
  double edge[3], other[3];
  difference(X[b], X[a], edge);
  difference(X[c], X[a], other);
  const double l = norm(edge), along = dot(other, edge) / l,
               away = std::sqrt(std::max(0.0, dot(other, other) - along * along)),
               x = (p[b].x - p[a].x) / l, y = (p[b].y - p[a].y) / l;
  p[c] = {p[a].x + along * x + away * y, p[a].y + along * y - away * x};
  normal_of(X[b], X[a], X[c], normal);
  smooth[c] = is_smooth(n, normal);
}

Unfolded::Unfolded(const double (*places)[3], const bool *neighbors) : X(places)
{
  double n[3], first[3], second[3], edge[3], across[3];
  for (int k = 0; k < PATCH_NODES; k++) has[k] = k < 3 || neighbors[k - 3];
  normal_of(X[0], X[1], X[2], n);
  difference(X[1], X[0], edge);
  const double l = norm(edge);
  cross(n, edge, across);
  for (int k = 1; k < 3; k++) {
    double from[3];
    difference(X[k], X[0], from);
    p[k] = {dot(from, edge) / l, dot(from, across) / l};
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3, beyond[2] = {6 + 2 * i, 7 + 2 * i};
    if (!has[3 + i]) continue;
    unfold(j, k, 3 + i, n, first);
    if (has[beyond[0]]) unfold(j, 3 + i, beyond[0], first, second);
    if (has[beyond[1]]) unfold(3 + i, k, beyond[1], first, second);
    for (const int b : beyond) smooth[b] = smooth[b] && smooth[3 + i];
  }
}

/** The smallest change of the sum of values at nodes that makes the slope along y at 0 exact for
 *  all surfaces of second order, and stays exact for planes. Returns the error that is left. */
double correct(const Place *at, const int *node, int n, double *c)
{
  double size[2] = {0.0, 0.0};
  for (int k = 0; k < n; k++) {
    size[0] += at[k].x * at[k].x / n;
    size[1] += at[k].y * at[k].y / n;
  }
  for (double &s : size) s = std::sqrt(s);

  // values of 1 x y, made orthogonal, and of xx xy yy, without their parts of these
  double P[6][PATCH_NODES], error[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < n; k++) {
    const double x = at[k].x / size[0], y = at[k].y / size[1];
    const double values[6] = {1.0, x, y, x * x, x * y, y * y};
    for (int f = 0; f < 6; f++) P[f][k] = values[f];
    for (int f = 0; f < 3; f++) error[f] -= size[1] * c[node[k]] * P[3 + f][k];
  }
  const auto largest = [&] {
    return std::max({std::fabs(error[0]), std::fabs(error[1]), std::fabs(error[2])});
  };
  if (largest() < EXACT || n < 6) return largest() < EXACT ? 0.0 : largest();
  const auto product = [&](const double *a, const double *b) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) sum += a[k] * b[k];
    return sum;
  };
  for (int f = 0; f < 6; f++) {
    for (int again = 0; again < 2; again++)
      for (int g = 0; g < std::min(f, 3); g++) {
        const double part = product(P[f], P[g]);
        for (int k = 0; k < n; k++) P[f][k] -= part * P[g][k];
      }
    const double inverse = f < 3 ? 1.0 / std::sqrt(product(P[f], P[f])) : 1.0;
    for (int k = 0; k < n; k++) P[f][k] *= inverse;
  }

  double G[3][3], w[3], v[3][3];
  for (int f = 0; f < 3; f++)
    for (int g = 0; g < 3; g++) G[f][g] = product(P[3 + f], P[3 + g]);
  eigenvectors(G, w, v);
  double left = 0.0;
  for (int e = 0; e < 3; e++) {
    const double part = v[0][e] * error[0] + v[1][e] * error[1] + v[2][e] * error[2];
    if (w[e] < DEGENERATE) {
      left = std::max(left, std::fabs(part));
      continue;
    }
    for (int k = 0; k < n; k++)
      for (int f = 0; f < 3; f++) c[node[k]] += part / (w[e] * size[1]) * v[f][e] * P[3 + f][k];
  }
  return left < EXACT ? 0.0 : left;
}

// of a polynomial that is left without those before, below which it is one of these; square of what
// is left of a node
constexpr double SAME = 1.0e-6, NONE = 0.01;

/** Take the parts along unit vectors off, twice for round-off; returns the length that is left. */
double reduce(const double (*unit)[PATCH_NODES], int nunit, int n, double *v)
{
  for (int again = 0; again < 2; again++)
    for (int u = 0; u < nunit; u++) {
      double part = 0.0;
      for (int k = 0; k < n; k++) part += unit[u][k] * v[k];
      for (int k = 0; k < n; k++) v[k] -= part * unit[u][k];
    }
  double square = 0.0;
  for (int k = 0; k < n; k++) square += v[k] * v[k];
  return std::sqrt(square);
}

/** Finds vectors s[.][k] for n nodes that are normal to all polynomials of an order (2 or 3), no
 *  more than most of them. Returns their number. */
int above_polynomials(int order, const Place *at, int n, int most, double (*s)[4])
{
  Place center = {0.0, 0.0};
  double size = 0.0, unit[12][PATCH_NODES];
  for (int k = 0; k < n; k++) center = {center.x + at[k].x / n, center.y + at[k].y / n};
  for (int k = 0; k < n; k++)
    size += (std::pow(at[k].x - center.x, 2) + std::pow(at[k].y - center.y, 2)) / n;
  size = std::sqrt(size);
  int nunit = 0, found = 0;
  for (int degree = 0; degree <= order; degree++)
    for (int b = 0; b <= degree; b++) {
      double *const v = unit[nunit], square = 0.0;
      for (int k = 0; k < n; k++) {
        v[k] = std::pow((at[k].x - center.x) / size, degree - b) *
            std::pow((at[k].y - center.y) / size, b);
        square += v[k] * v[k];
      }
      const double left = reduce(unit, nunit, n, v);
      if (left <= SAME * std::sqrt(square)) continue;
      for (int k = 0; k < n; k++) v[k] /= left;
      nunit++;
    }

  // the node of which most is left, again and again
  for (; found < most; found++) {
    double largest = NONE;
    int best = -1;
    for (int k = 0; k < n; k++) {
      double left = 1.0;
      for (int u = 0; u < nunit; u++) left -= unit[u][k] * unit[u][k];
      if (left <= largest) continue;
      largest = left;
      best = k;
    }
    if (best < 0) break;
    double *const v = unit[nunit];
    for (int k = 0; k < n; k++) v[k] = k == best;
    const double left = reduce(unit, nunit, n, v);
    for (int k = 0; k < n; k++) s[k][found] = v[k] /= left;
    nunit++;
  }
  return found;
}

// pivot, in parts of the diagonal, below which nodes do not tell a surface of second order
constexpr double SINGULAR = 1.0e-4;
// weight of a node at the distance r, in mean lengths of the edges at the corner: (NEAR + r^2)^-4
constexpr double NEAR = 0.3;

/** Cholesky's factors of a symmetric matrix, of which the lower half is given, in its place. False:
 *  it is singular. */
bool factorize(double (*A)[5])
{
  for (int i = 0; i < 5; i++) {
    const double diagonal = A[i][i];
    for (int j = 0; j <= i; j++) {
      for (int k = 0; k < j; k++) A[i][j] -= A[i][k] * A[j][k];
      if (j < i)
        A[i][j] /= A[j][j];
      else if (A[i][i] <= SINGULAR * diagonal)
        return false;
      else
        A[i][i] = std::sqrt(A[i][i]);
    }
  }
  return true;
}

void solve(const double (*A)[5], double *v)
{
  for (int i = 0; i < 5; i++) {
    for (int k = 0; k < i; k++) v[i] -= A[i][k] * v[k];
    v[i] /= A[i][i];
  }
  for (int i = 4; i >= 0; i--) {
    for (int k = i + 1; k < 5; k++) v[i] -= A[k][i] * v[k];
    v[i] /= A[i][i];
  }
}

/** Slopes along x and y at a corner, as sums over the values at nodes: those of the surface of
 *  second order through the corner that is nearest to the other nodes, the more so the closer they
 *  are. False: the nodes do not tell such a surface. */
bool find_slopes(const Place *at, int n, int corner, double (*slope)[PATCH_NODES])
{
  double P[PATCH_NODES][5], weight[PATCH_NODES], A[5][5] = {{0.0}}, size = 0.0;
  for (int k = 0; k < 3; k++) size += 0.5 * length(at[corner], at[k]);
  for (int a = 0; a < n; a++) {
    const double x = (at[a].x - at[corner].x) / size, y = (at[a].y - at[corner].y) / size,
                 values[5] = {x, y, 0.5 * x * x, 0.5 * y * y, x * y};
    weight[a] = a == corner ? 0.0 : std::pow(NEAR + x * x + y * y, -4);
    for (int i = 0; i < 5; i++) {
      P[a][i] = values[i];
      for (int j = 0; j <= i; j++) A[i][j] += weight[a] * values[i] * values[j];
    }
  }
  if (!factorize(A)) return false;
  for (int d = 0; d < 2; d++) {
    double v[5] = {0.0};
    v[d] = 1.0;
    solve(A, v);
    slope[d][corner] = 0.0;
    for (int a = 0; a < n; a++) {
      if (a == corner) continue;
      double sum = 0.0;
      for (int i = 0; i < 5; i++) sum += v[i] * P[a][i];
      slope[d][a] = weight[a] * sum / size;
      slope[d][corner] -= slope[d][a];
    }
  }
  return true;
}

/** For n nodes, the first three of which are the corners: coefficients of the values at the nodes
 *  that give the deviations from the mean curvature (xx yy xy and xx yy xy) along two linear
 *  functions whose mean square is one, times the square root of LINEAR_PART. They vanish for
 *  surfaces of second order. Returns false if the nodes do not determine the slopes at the
 *  corners. */
bool linear_curvatures(const Place *at, int n, double (*rows)[6])
{
  // at corners, and at the middles of the edges across from these, where the slope across is the
  // mean of those at the ends, and that along the edge is that of a cubic
  double slope[6][2][PATCH_NODES], g[3][2];
  for (int k = 0; k < 3; k++)
    if (!find_slopes(at, n, k, slope[k])) return false;
  const double twice =
      (at[1].x - at[0].x) * (at[2].y - at[0].y) - (at[2].x - at[0].x) * (at[1].y - at[0].y);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double l = length(at[j], at[k]),
                 u[2] = {(at[k].x - at[j].x) / l, (at[k].y - at[j].y) / l};
    g[i][0] = (at[j].y - at[k].y) / twice;
    g[i][1] = (at[k].x - at[j].x) / twice;
    for (int a = 0; a < n; a++) {
      const double mean[2] = {0.5 * (slope[j][0][a] + slope[k][0][a]),
                              0.5 * (slope[j][1][a] + slope[k][1][a])},
                   chord = ((a == k) - (a == j)) / l,
                   more = 1.5 * (chord - mean[0] * u[0] - mean[1] * u[1]);
      for (int d = 0; d < 2; d++) slope[3 + i][d][a] = mean[d] + more * u[d];
    }
  }

  // curvatures at corners, of slopes that are of second order in the triangle
  const double scale = std::sqrt(LINEAR_PART / 12.0);
  for (int a = 0; a < n; a++) {
    double c[3][3];
    for (int i = 0; i < 3; i++) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      double b[2][2];
      for (int d = 0; d < 2; d++)
        for (int e = 0; e < 2; e++)
          b[d][e] = 3.0 * g[i][e] * slope[i][d][a] - g[j][e] * slope[j][d][a] -
              g[k][e] * slope[k][d][a] + 4.0 * g[j][e] * slope[3 + k][d][a] +
              4.0 * g[k][e] * slope[3 + j][d][a];
      c[i][0] = b[0][0];
      c[i][1] = b[1][1];
      c[i][2] = 0.5 * (b[0][1] + b[1][0]);
    }
    for (int m = 0; m < 3; m++) {
      rows[a][m] = scale * (c[0][m] - c[1][m]) / std::sqrt(2.0);
      rows[a][3 + m] = scale * (c[0][m] + c[1][m] - 2.0 * c[2][m]) / std::sqrt(6.0);
    }
  }
  return true;
}

/** Append what resists short waves, or linear curvatures, to the coefficients of a patch without
 *  creases that is not at a rim; returns the number of rows. Of a node that is there twice, only
 *  the first one is known. */
int add_above(const Unfolded &all, const bool *again, double area, bool linear,
              double (*coefficients)[BentTriangle::MOST])
{
  Place at[PATCH_NODES];
  double s[PATCH_NODES][4], changes[PATCH_NODES][6];
  int node[PATCH_NODES], n = 0;
  for (int a = 0; a < PATCH_NODES; a++) {
    if (!all.has[a] || !all.smooth[a]) return 0;
    if (again[a]) continue;
    at[n] = all.p[a];
    node[n++] = a;
  }
  const bool few = n <= FEW_NODES;
  if (linear && !few) {
    if (!linear_curvatures(at, n, changes)) return 0;
    for (int k = 0; k < n; k++) std::copy_n(changes[k], 6, coefficients[node[k]] + 3);
    return 6;
  }
  const int found = above_polynomials(few ? 2 : 3, at, n, few ? 4 : 2, s);
  const double l = std::max({length(all.p[0], all.p[1]), length(all.p[1], all.p[2]),
                             length(all.p[2], all.p[0])}),
               narrow = std::min(1.0, 4.0 * area / (l * l)),
               scale = std::sqrt(few ? ABOVE_SECOND : ABOVE_THIRD) * narrow * narrow / area;
  for (int k = 0; k < n; k++)
    for (int c = 0; c < found; c++) coefficients[node[k]][3 + c] = scale * s[k][c];
  return found;
}

}    // namespace

double BentTriangle::define(const double (*X)[3], const bool *neighbors, bool away, bool linear,
                            int *slots)
{
  const Unfolded all(X, neighbors);
  const Place *const p = all.p;
  double coefficients[PATCH_NODES][MOST] = {{0.0}}, worst = 0.0;
  area = 0.5 * (p[1].x * p[2].y - p[2].x * p[1].y);
  nfree = 0;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double l = length(p[j], p[k]);
    const Place u = {(p[k].x - p[j].x) / l, (p[k].y - p[j].y) / l}, normal = {u.y, -u.x};
    double own[3], c[PATCH_NODES] = {0.0};
    slopes_of(p, normal, own);
    const bool inside = all.has[3 + i];
    for (int a = 0; a < 3; a++) c[a] = (inside ? 0.5 : 1.0) * own[a];
    if (inside) {
      const int corners[3] = {k, j, 3 + i};
      const Place other[3] = {p[k], p[j], p[3 + i]};
      double slope[3];
      slopes_of(other, normal, slope);
      for (int a = 0; a < 3; a++) c[corners[a]] += 0.5 * slope[a];
    }

    // the nodes of triangles at both sides of the edge and of their neighbors, and at a rim of
    // those beyond, without creases
    int node[PATCH_NODES], nnode = 0;
    Place at[PATCH_NODES];
    const auto use = [&](int a) {
      if (!all.has[a] || !all.smooth[a]) return;
      const double x = p[a].x - 0.5 * (p[j].x + p[k].x), y = p[a].y - 0.5 * (p[j].y + p[k].y);
      at[nnode] = {x * u.x + y * u.y, x * normal.x + y * normal.y};
      node[nnode++] = a;
    };
    for (int a = 0; a < 6; a++) use(a);
    for (int a = 6; a < PATCH_NODES; a++)
      if (!inside || (a - 6) / 2 == i) use(a);
    if (!inside || all.smooth[3 + i]) {
      const double error = correct(at, node, nnode, c);
      if (inside)
        worst = std::max(worst, error);
      else if (error > 0.0) {
        if (nfree < 2) {
          m[nfree][0] = normal.x;
          m[nfree++][1] = normal.y;
        }
        continue;
      }
    }
    for (int a = 0; a < 3; a++) c[a] -= own[a];
    for (int a = 0; a < PATCH_NODES; a++) {
      coefficients[a][0] += l / area * normal.x * normal.x * c[a];
      coefficients[a][1] += l / area * normal.y * normal.y * c[a];
      coefficients[a][2] += l / area * normal.x * normal.y * c[a];
    }
  }

  // a node that the neighbors of two neighbors share is one
  bool again[PATCH_NODES] = {false};
  for (int a = 3; a < PATCH_NODES; a++)
    for (int b = 0; b < a && !again[a]; b++) {
      if (!all.has[a] || !all.has[b] || !std::equal(X[a], X[a] + 3, X[b])) continue;
      again[a] = true;
      for (int c = 0; c < 3; c++) {
        coefficients[b][c] += coefficients[a][c];
        coefficients[a][c] = 0.0;
      }
    }
  nrow = 3;
  if (away && nfree == 0) nrow += add_above(all, again, area, linear, coefficients);
  ncurvature = nrow == MOST ? MOST : 3;
  n = 0;
  for (int a = 0; a < PATCH_NODES; a++) {
    const double *const from = coefficients[a];
    if (a < 3 || std::any_of(from, from + nrow, [](double c) {
          return c != 0.0;
        }))
      slots[n++] = a;
  }
  std::fill(std::begin(h), std::end(h), 0.0);
  for (int c = 0; c < nrow; c++)
    for (int k = 0; k < n; k++) h[c * n + k] = coefficients[slots[k]][c];
  double normal[3];
  normal_of(X[0], X[1], X[2], normal);
  for (int c = 0; c < MOST; c++) {
    rest[c] = 0.0;
    for (int k = 0; k < n && c < nrow; k++) rest[c] += h[c * n + k] * dot(X[slots[k]], normal);
  }
  return worst;
}
