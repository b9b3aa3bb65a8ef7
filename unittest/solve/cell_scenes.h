// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_TEST_CELL_SCENES_H
#define MPM_TEST_CELL_SCENES_H

// Systems of equations for the pressures of the cells in the wet parts of a box.

#include "solve/cell_multigrid.h"
#include "solve/krylov.h"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace MPM_NS {

/** Cells of [0,1]^dim: which are wet, and coefficients of faces between them. The box is closed. */
struct CellScene {
  int dim, n;    ///< cells along an axis
  std::function<bool(const double *)> wet = [](const double *) {
    return true;
  };    ///< whether a cell with this center is wet
  std::function<double(const int *, int)> open = [](const int *, int) {
    return 1.0;
  };    ///< coefficient of the upper face of a cell along an axis: open(index, axis)
  bool periodic[3] = {false, false, false};
  int shift[3] = {0, 0, 0};    ///< index of the first cell

  bool is_wet(const int *index) const
  {
    double x[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) {
      int i = index[d] - shift[d];
      if (periodic[d]) i = ((i % n) + n) % n;
      if (i < 0 || i >= n) return false;
      x[d] = (i + 0.5) / n;
    }
    return wet(x);
  }
  bool in_box(const int *index) const
  {
    for (int d = 0; d < dim; d++)
      if (!periodic[d] && (index[d] < shift[d] || index[d] >= shift[d] + n)) return false;
    return true;
  }
  Lattice lattice() const
  {
    return {dim, 1.0 / n, {0.0, 0.0, 0.0}, {periodic[0], periodic[1], periodic[2]}, {n, n, n}};
  }
  /** Calls f(index) for all cells of the box. */
  template <class F> void each(const F &f) const
  {
    int i[3];
    for (i[0] = shift[0]; i[0] < shift[0] + n; i[0]++)
      for (i[1] = shift[1]; i[1] < shift[1] + n; i[1]++)
        for (i[2] = shift[2]; i[2] < shift[2] + (dim == 3 ? n : 1); i[2]++) f(i);
  }
  /** Coefficient of the upper face of a cell along axis d. It is 0 between two dry cells and at
   *  faces of the box. Periodic images have the coefficients of the canonical cells. */
  double face(const int *index, int d) const
  {
    int upper[3] = {index[0], index[1], index[2]}, canonical[3];
    upper[d]++;
    if (!in_box(index) || !in_box(upper) || !(is_wet(index) || is_wet(upper))) return 0.0;
    for (int e = 0; e < 3; e++)
      canonical[e] = periodic[e] ? (((index[e] - shift[e]) % n) + n) % n + shift[e] : index[e];
    return open(canonical, d);
  }
  /** Gives A all coefficients of a node, also of a periodic image. */
  void give(CellOperator &A, int64_t node) const
  {
    int index[3];
    A.grid.node_index(node, index);
    if (!is_wet(index)) return;
    for (int d = 0; d < dim; d++) {
      int lower[3] = {index[0], index[1], index[2]}, upper[3] = {index[0], index[1], index[2]};
      lower[d]--;
      upper[d]++;
      if (is_wet(upper)) {
        if (A.grid.locate(upper) >= 0) A.face[node * dim + d] = face(index, d);
      } else
        A.outside[node] += face(index, d);
      if (!is_wet(lower)) A.outside[node] += face(lower, d);
    }
  }
};

/** The system of a scene on one rank. */
class CellSystem : public LinearSystem {
 public:
  enum Preconditioner { DIAGONAL, MULTIGRID };
  const CellScene scene;
  Grid grid;
  OneRank ranks;
  CellOperator A;
  CellMultigrid multigrid;
  Preconditioner preconditioner = MULTIGRID;

  explicit CellSystem(const CellScene &scene) :
      scene(scene), grid(scene.lattice()), ranks(grid), A(grid, ranks)
  {
    scene.each([&](const int *i) {
      for (int d = -1; d < 2 * scene.dim; d++) {
        int at[3] = {i[0], i[1], i[2]}, b[3];
        if (d >= 0) at[d / 2] += 2 * (d % 2) - 1;
        for (int e = 0; e < 3; e++) b[e] = e < scene.dim ? at[e] >> grid.shift_bits : 0;
        if (scene.is_wet(i) && scene.in_box(at)) grid.activate(b);
      }
    });
    grid.close_periodic();
    grid.finish();
    A.clear();
    for (int64_t node = 0; node < grid.nnodes(); node++) scene.give(A, node);
    A.share();
    A.finish();
    multigrid.setup(A);
  }
  int64_t size() const override { return grid.nnodes(); }
  void apply(const double *x, double *y) override { A.apply(x, y); }
  void precondition(const double *r, double *z) override
  {
    if (preconditioner == MULTIGRID)
      multigrid.precondition(r, z);
    else
      A.scale(r, z);
  }
  void products(int m, const double *const *a, const double *const *b, double *value) override
  {
    for (int k = 0; k < m; k++) {
      value[k] = 0.0;
      for (int64_t i = 0; i < size(); i++)
        if (grid.owns(i)) value[k] += a[k][i] * b[k][i];
    }
  }
  std::vector<double> zeros() const { return std::vector<double>(grid.nnodes(), 0.0); }
  /** Values of(index) at the nodes of the box and their periodic images; 0 elsewhere. */
  std::vector<double> values(const std::function<double(const int *)> &of) const
  {
    auto all = zeros();
    for (int64_t node = 0; node < grid.nnodes(); node++) {
      int index[3];
      grid.node_index(node, index);
      for (int d = 0; d < scene.dim; d++) index[d] = grid.lattice.wrap(d, index[d]);
      if (scene.in_box(index)) all[node] = of(index);
    }
    return all;
  }
  /** Random numbers at wet cells, which depend on the index and the seed only. */
  std::vector<double> noise(unsigned seed = 1) const
  {
    return values([&](const int *i) {
      return scene.is_wet(i) ? noise_at(i, seed) : 0.0;
    });
  }
  static double noise_at(const int *i, unsigned seed)
  {
    std::minstd_rand random(seed + 7 * (i[0] + 1000) + 7919 * (i[1] + 1000) +
                            104729 * (i[2] + 1000));
    random.discard(5);
    return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
  }
  SolveReport solve(const std::vector<double> &b, std::vector<double> &x,
                    const SolveGoal &goal = {1e-8, 0.0, 500})
  {
    return ConjugateGradients().solve(*this, b.data(), x.data(), goal);
  }
  /** Iterations for a random right-hand side; 100000 if the solution does not converge. */
  int iterations()
  {
    auto b = noise(), x = zeros();
    multigrid.project(b.data());
    const auto report = solve(b, x);
    return report.converged() ? report.iterations : 100000;
  }
};

/** Shapes of benchmark O7: a tank with a sloping surface, a disk, a tank with 40 disks (drops). */
inline bool sloping(const double *x)
{
  return x[1] < 0.5 + 0.2 * (x[0] - 0.5);
}
inline bool disk(const double *x)
{
  return std::hypot(x[0] - 0.5, x[1] - 0.5) < 0.3;
}
inline std::function<bool(const double *)> splash()
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> c(80);
  for (auto &value : c) value = uniform(random);
  return [c](const double *x) {
    bool wet = x[1] < 0.4;
    for (int k = 0; k < 40; k++)
      wet = wet || std::hypot(x[0] - c[2 * k], x[1] - 0.4 - 0.6 * c[2 * k + 1]) < 0.03;
    return wet;
  };
}

}    // namespace MPM_NS
#endif
