// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_TEST_SOLID_SCENES_H
#define MPM_TEST_SOLID_SCENES_H

// Linear elasticity of points with B-splines on a lattice: systems for displacements of nodes.

#include "solve/krylov.h"
#include "solve/spline_multigrid.h"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace MPM_NS {

/** Points, 2 per node spacing along each axis, their stiffnesses, and the constraints of nodes. */
struct SolidScene {
  int dim;
  double h;                  ///< spacing of nodes
  double low[3], high[3];    ///< box of the points
  std::function<bool(const double *)> inside = [](const double *) {
    return true;
  };
  std::function<double(const double *)> young = [](const double *) {
    return 1.0;
  };
  /** Sets the projection P [3][3] of a node at x, which is the unit matrix before the call. */
  std::function<void(const double *, double (*)[3])> hold = [](const double *, double (*)[3]) {
  };
  double poisson = 0.3;
  double density = 0.0;    ///< times the factor that makes it a stiffness
  int order = 2;           ///< of the splines, 1 to 3
  double offset = 0.0;     ///< shift of all points from their regular places [h/2]
  bool periodic[3] = {false, false, false};
  int few = 0;    ///< largest number of unknowns of a level that is factorized
  int all = 0;    ///< largest number of unknowns of a system that is factorized as a whole
};

/** The system of a scene. Its operator is applied by loops over the points, without a matrix. */
class SolidSystem : public LinearSystem {
 public:
  enum Preconditioner { NOTHING, BLOCKS, MULTIGRID };
  const SolidScene scene;
  const int dim;
  Grid grid;
  std::unique_ptr<LatticeRanks> ranks;
  std::vector<double> projection, blocks, mass;
  std::unique_ptr<SplineMultigrid> multigrid;
  Preconditioner preconditioner = MULTIGRID;
  int64_t napply = 0;

  /** mine(x): is a point on this rank? ranks_of: makes the ranks once the blocks are known. */
  explicit SolidSystem(
      const SolidScene &scene,
      const std::function<bool(const double *)> &mine =
          [](const double *) {
            return true;
          },
      const std::function<LatticeRanks *(Grid &)> &ranks_of =
          [](Grid &grid) {
            return new OneRank(grid);
          }) :
      scene(scene),
      dim(scene.dim), grid(lattice(scene))
  {
    make_points(mine);
    grid.close_periodic();
    grid.finish();
    ranks.reset(ranks_of(grid));
    multigrid.reset(new SplineMultigrid(grid, *ranks, dim, scene.order, scene.few, scene.all));
    find_stencils();
    hold_nodes();
    find_blocks();
  }

  static Lattice lattice(const SolidScene &scene)
  {
    Lattice all{scene.dim, scene.h, {0.0, 0.0, 0.0}, {false, false, false}, {0, 0, 0}};
    for (int d = 0; d < scene.dim; d++) {
      all.periodic[d] = scene.periodic[d];
      all.ncell[d] = (int) std::lround((scene.high[d] - scene.low[d]) / scene.h);
    }
    return all;
  }

  void setup()
  {
    multigrid->begin(projection.data(), blocks.data());
    std::vector<double> C(dim * dim * dim * dim);
    for (std::size_t p = 0; p < points.size(); p++) {
      stiffness(points[p], C.data());
      multigrid->add_point(nnodes, nodes.data() + p * nnodes, dim,
                           gradients.data() + p * nnodes * dim, C.data());
    }
    multigrid->finish(*this, scene.density > 0.0 ? mass.data() : nullptr);
  }

  int64_t size() const override { return grid.nnodes() * dim; }
  void apply(const double *x, double *y) override
  {
    napply++;
    std::vector<double> &u = moved;
    u.resize(size());
    project(x, u.data());
    std::fill_n(y, size(), 0.0);
    for (std::size_t p = 0; p < points.size(); p++) {
      const int64_t *const node = nodes.data() + p * nnodes;
      const double *const g = gradients.data() + p * nnodes * dim;
      double H[3][3] = {}, S[3][3] = {};
      for (int i = 0; i < nnodes; i++)
        for (int a = 0; a < dim; a++)
          for (int l = 0; l < dim; l++) H[a][l] += u[node[i] * dim + a] * g[i * dim + l];
      double trace = 0.0;
      for (int a = 0; a < dim; a++) trace += H[a][a];
      const auto &point = points[p];
      for (int a = 0; a < dim; a++)
        for (int l = 0; l < dim; l++)
          S[a][l] = point.mu * (H[a][l] + H[l][a]) + (a == l ? point.lambda * trace : 0.0);
      for (int i = 0; i < nnodes; i++)
        for (int a = 0; a < dim; a++)
          for (int l = 0; l < dim; l++) y[node[i] * dim + a] += S[a][l] * g[i * dim + l];
    }
    ranks->sum(y, dim);
    for (int64_t k = 0; k < size(); k++) y[k] += scene.density > 0.0 ? mass[k / dim] * u[k] : 0.0;
    project(y, y);
  }
  void precondition(const double *r, double *z) override
  {
    if (preconditioner == NOTHING)
      LinearSystem::precondition(r, z);
    else if (preconditioner == MULTIGRID)
      multigrid->precondition(r, z);
    else {
      for (int64_t n = 0; n < grid.nnodes(); n++)
        for (int a = 0; a < dim; a++) {
          const double diagonal = blocks[(n * dim + a) * dim + a];
          z[n * dim + a] = diagonal > 0.0 ? r[n * dim + a] / diagonal : 0.0;
        }
      project(z, z);
    }
  }
  void products(int m, const double *const *a, const double *const *b, double *value) override
  {
    std::vector<double> mine(m, 0.0);
    for (int k = 0; k < m; k++)
      for (int64_t n = 0; n < grid.nnodes(); n++)
        if (grid.owns(n))
          for (int i = 0; i < dim; i++) mine[k] += a[k][n * dim + i] * b[k][n * dim + i];
    const auto all = ranks->gather(mine);
    std::fill_n(value, m, 0.0);
    for (std::size_t k = 0; k < all.size(); k++) value[k % m] += all[k];
  }
  /** y = P x with the projection P of each node, which is symmetric. y may be x. */
  void project(const double *x, double *y) const
  {
    for (int64_t n = 0; n < grid.nnodes(); n++) {
      double sum[3] = {};
      for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++)
          sum[a] += projection[(n * dim + a) * dim + b] * x[n * dim + b];
      std::copy_n(sum, dim, y + n * dim);
    }
  }
  /** Forces on the nodes, projected, from a force body(x, axis) per volume. */
  std::vector<double> forces(const std::function<double(const double *, int)> &body) const
  {
    std::vector<double> f(size(), 0.0);
    for (std::size_t p = 0; p < points.size(); p++)
      for (int i = 0; i < nnodes; i++)
        for (int a = 0; a < dim; a++)
          f[nodes[p * nnodes + i] * dim + a] +=
              weights[p * nnodes + i] * points[p].volume * body(points[p].x, a);
    ranks->sum(f.data(), dim);
    project(f.data(), f.data());
    return f;
  }
  std::vector<double> zeros() const { return std::vector<double>(size(), 0.0); }
  SolveReport solve(const std::vector<double> &b, std::vector<double> &x, const SolveGoal &goal)
  {
    return ConjugateGradients().solve(*this, b.data(), x.data(), goal);
  }
  std::size_t npoints() const { return points.size(); }

  struct Point {
    double x[3], volume, lambda, mu;    ///< lambda and mu are times the volume
  };
  std::vector<Point> points;
  int nnodes;    ///< nodes that a point reaches
  std::vector<int64_t> nodes;
  std::vector<double> weights, gradients;

 private:
  std::vector<double> moved;

  /** C [dim*dim][dim*dim]: volume times dS/dH, the derivative of the stress by the displacement
   *  gradient. Component [a][l] of either has the index l*dim + a. */
  void stiffness(const Point &point, double *C) const
  {
    const int m = dim * dim;
    for (int a = 0; a < dim; a++)
      for (int l = 0; l < dim; l++)
        for (int b = 0; b < dim; b++)
          for (int k = 0; k < dim; k++)
            C[(l * dim + a) * m + k * dim + b] =
                point.mu * ((a == b && l == k) + (a == k && l == b)) +
                (a == l && b == k ? point.lambda : 0.0);
  }
  /** Weights w and derivatives g (per spacing) along an axis. Returns the first node of a point. */
  int along(double x, double *w, double *g) const
  {
    const double s = x / scene.h;
    if (scene.order == 1) {
      const int base = (int) std::floor(s);
      const double t = s - base;
      w[0] = 1.0 - t;
      w[1] = t;
      g[0] = -1.0;
      g[1] = 1.0;
      return base;
    }
    if (scene.order == 2) {
      const int base = (int) std::floor(s + 0.5) - 1;
      const double t = s - base - 1.0;
      w[0] = 0.5 * (0.5 - t) * (0.5 - t);
      w[1] = 0.75 - t * t;
      w[2] = 0.5 * (0.5 + t) * (0.5 + t);
      g[0] = t - 0.5;
      g[1] = -2.0 * t;
      g[2] = t + 0.5;
      return base;
    }
    const int base = (int) std::floor(s) - 1;
    const double t = s - base - 1.0, u = 1.0 - t;
    w[0] = u * u * u / 6.0;
    w[1] = (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
    w[2] = (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0;
    w[3] = t * t * t / 6.0;
    g[0] = -0.5 * u * u;
    g[1] = 0.5 * (3.0 * t * t - 4.0 * t);
    g[2] = -0.5 * (3.0 * u * u - 4.0 * u);
    g[3] = 0.5 * t * t;
    return base;
  }
  /** Calls f(index, weight, gradient) for all nodes that a point reaches. */
  template <class F> void each_node(const Point &point, const F &f) const
  {
    double w[3][4] = {{1.0}, {1.0}, {1.0}}, g[3][4] = {};
    int base[3] = {0, 0, 0}, n[3] = {1, 1, 1};
    for (int d = 0; d < dim; d++) {
      base[d] = along(point.x[d], w[d], g[d]);
      n[d] = scene.order + 1;
    }
    for (int i = 0; i < n[0]; i++)
      for (int j = 0; j < n[1]; j++)
        for (int k = 0; k < n[2]; k++) {
          const int index[3] = {base[0] + i, base[1] + j, base[2] + k};
          const double gradient[3] = {g[0][i] * w[1][j] * w[2][k] / scene.h,
                                      w[0][i] * g[1][j] * w[2][k] / scene.h,
                                      w[0][i] * w[1][j] * g[2][k] / scene.h};
          f(index, w[0][i] * w[1][j] * w[2][k], gradient);
        }
  }
  void make_points(const std::function<bool(const double *)> &mine)
  {
    const double step = 0.5 * scene.h;
    int n[3] = {1, 1, 1};
    for (int d = 0; d < dim; d++)
      n[d] = (int) std::floor((scene.high[d] - scene.low[d]) / step + 0.5);
    // the 2^dim points of a cell are successive
    const auto at = [&](int d, int i) {
      return d < dim ? scene.low[d] + (i + 0.5 + scene.offset) * step : 0.0;
    };
    const int pair[3] = {2, 2, dim == 3 ? 2 : 1};
    for (int i = 0; i < n[0]; i += 2)
      for (int j = 0; j < n[1]; j += 2)
        for (int k = 0; k < n[2]; k += 2)
          for (int c = 0; c < 8; c++) {
            const int di = c >> 2, dj = c >> 1 & 1, dk = c & 1;
            if (dk >= pair[2] || i + di >= n[0] || j + dj >= n[1] || k + dk >= n[2]) continue;
            Point point{{at(0, i + di), at(1, j + dj), at(2, k + dk)}, 1.0, 0.0, 0.0};
            if (!scene.inside(point.x) || !mine(point.x)) continue;
            for (int d = 0; d < dim; d++) point.volume *= step;
            const double E = scene.young(point.x), nu = scene.poisson;
            point.mu = 0.5 * E / (1.0 + nu) * point.volume;
            point.lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)) * point.volume;
            points.push_back(point);
            each_node(point, [&](const int *index, double, const double *) {
              int b[3];
              for (int d = 0; d < 3; d++) b[d] = d < dim ? index[d] >> grid.shift_bits : 0;
              auto &block = grid.blocks[grid.activate(b)];
              block.reached |= uint64_t(1) << grid.number(index);
            });
          }
  }
  void find_stencils()
  {
    nnodes = 1;
    for (int d = 0; d < dim; d++) nnodes *= scene.order + 1;
    for (const auto &point : points)
      each_node(point, [&](const int *index, double weight, const double *gradient) {
        nodes.push_back(grid.locate(index));
        weights.push_back(weight);
        gradients.insert(gradients.end(), gradient, gradient + dim);
      });
  }
  /** Finds the projections of all nodes. */
  void hold_nodes()
  {
    const auto canonical = grid.canonical();
    projection.assign(grid.nnodes() * dim * dim, 0.0);
    for (int64_t n = 0; n < grid.nnodes(); n++) {
      double x[3], P[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
      grid.node_position(canonical[n], x);
      scene.hold(x, P);
      for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) projection[(n * dim + a) * dim + b] = P[a][b];
    }
  }
  /** Finds the diagonal blocks [dim][dim] of the operator, and the masses of the nodes. */
  void find_blocks()
  {
    blocks.assign(grid.nnodes() * dim * dim, 0.0);
    mass.assign(grid.nnodes(), 0.0);
    for (std::size_t p = 0; p < points.size(); p++)
      for (int i = 0; i < nnodes; i++) {
        const double *const g = gradients.data() + (p * nnodes + i) * dim;
        const int64_t node = nodes[p * nnodes + i];
        double gg = 0.0;
        for (int l = 0; l < dim; l++) gg += g[l] * g[l];
        for (int a = 0; a < dim; a++)
          for (int b = 0; b < dim; b++)
            blocks[(node * dim + a) * dim + b] += (points[p].lambda + points[p].mu) * g[a] * g[b] +
                (a == b ? points[p].mu * gg : 0.0);
        mass[node] += scene.density * points[p].volume * weights[p * nnodes + i];
      }
    ranks->sum(blocks.data(), dim * dim);
    ranks->sum(mass.data(), 1);
    for (int64_t n = 0; n < grid.nnodes(); n++)
      for (int a = 0; a < dim; a++) blocks[(n * dim + a) * dim + a] += mass[n];
  }
};

}    // namespace MPM_NS
#endif
