/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Time per point of the transfer kernels: blocks in the order of a simulation, points sorted by
// block and cell, 8 per cell in 3d and 4 in 2d. Counter ns/point; names are
//
//   what/instruction set/dimension/shape/transfer/points
//
// with what = p2g (points to tiles), g2p (tiles to points, in batches as for the constitutive law),
// io (flush and load of all tiles), step (p2g, flush, solve_nodes, load, g2p).
// cpdi and cpdi2 are domains of the size of the points, a little distorted.
// Example: bench_kernels --benchmark_filter='step/AVX-512/3d/quadratic/apic/'

#include "transfer/cpdi.h"
#include "transfer/kernels.h"

#include "benchmark/benchmark.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

using namespace MPM_NS;

namespace {

constexpr double H = 0.01;

/** Points of one block: rows and node blocks around it. */
struct Block {
  int first, last;
  int base[3];
  int slot[27];
};

/** A square or cube of jittered points, sorted, with its blocks. */
struct Scene {
  int dim, n, nblocks;
  std::vector<double> x, v, f, C, F, tau, vol0, mass, domain;
  std::vector<Block> blocks;

  Scene(int dim, Shape shape, int margin, int wanted) : dim(dim)
  {
    const int order = stencil_order(shape);
    const int ppc = 2;    // per axis
    const int cells = dim == 3 ? std::lround(std::cbrt(wanted / 8.0))
                               : std::lround(std::sqrt(wanted / 4.0));
    const int side = block_side(dim);
    const int nside = cells / side + 4;    // blocks along an axis
    std::mt19937 random(1);
    std::uniform_real_distribution<double> jitter(-0.15, 0.15);

    // position from the first block's first node, in units of h, and sort key
    struct Point {
      long key;
      double t[3];
    };
    std::vector<Point> points;
    const int m = ppc * cells;
    for (int i = 0; i < m; i++)
      for (int j = 0; j < m; j++)
        for (int k = 0; k < (dim == 3 ? m : 1); k++) {
          const int ijk[3] = {i, j, k};
          Point p;
          long block = 0, cell = 0;
          for (int a = 0; a < 3; a++) {
            p.t[a] = a < dim ? 1.5 * side + (ijk[a] + 0.5) / ppc + jitter(random) : 0.0;
            if (a == dim) continue;
            const int base = std::floor(p.t[a] - 0.5 * (order - 1));
            block = block * nside + base / side;
            cell = cell * side + base % side;
          }
          p.key = 64 * block + cell;
          points.push_back(p);
        }
    std::stable_sort(points.begin(), points.end(), [](const Point &a, const Point &b) {
      return a.key < b.key;
    });

    n = points.size();
    nblocks = dim == 3 ? nside * nside * nside : nside * nside;
    x.resize(3 * n), v.resize(3 * n), f.resize(3 * n), C.resize(dim * dim * n), F.resize(9 * n);
    tau.resize(6 * n);
    vol0.assign(n, std::pow(H / ppc, dim));
    mass.assign(n, 1.0);
    for (int p = 0; p < n; p++)
      for (int a = 0; a < 3; a++) x[3 * p + a] = H * points[p].t[a];
    for (auto *a : {&v, &f, &C, &tau})
      for (double &b : *a) b = 1e-6 * jitter(random);
    if (has_domain(shape)) {
      const int row = shape == CPDI ? dim * dim : dim << dim;
      domain.resize(row * n);
      for (int i = 0; i < row * n; i++) {
        const int k = i % row / dim, d = i % row % dim;    // edge or corner, axis
        const double sign = shape == CPDI ? k == d : PointDomain<3>::sign(k, d);
        domain[i] = 0.5 * H / ppc * (sign + jitter(random));
      }
    }

    for (int p = 0; p < n;) {
      Block b;
      b.first = p;
      long number = points[p].key / 64;
      while (p < n && points[p].key / 64 == number) p++;
      b.last = p;
      int at[3] = {0, 0, 0};
      for (int a = dim - 1; a >= 0; a--) {
        at[a] = number % nside;
        b.base[a] = at[a] * side - margin;
        number /= nside;
      }
      for (int s = 0; s < 27; s++) {
        const int d[3] = {s / 9 - 1, s / 3 % 3 - 1, s % 3 - 1};
        b.slot[s] = dim == 3 ? ((at[0] + d[0]) * nside + at[1] + d[1]) * nside + at[2] + d[2]
                             : (at[0] + d[0]) * nside + at[1] + d[1];
      }
      blocks.push_back(b);
    }
  }

  PointRows rows()
  {
    PointRows r = {x.data(),    v.data(),    f.data(), C.data(), tau.data(),
                   vol0.data(), mass.data(), x.data(), F.data(), n - 1};
    r.domain = domain.data();
    return r;
  }
};

/** The scene; only the last one is kept, to save memory. */
Scene &scene(int dim, Shape shape, int margin, int n)
{
  using Key = std::tuple<int, Shape, int>;
  static Key kept;
  static std::unique_ptr<Scene> scene;
  if (!scene || kept != Key(dim, shape, n)) {
    scene.reset();
    scene = std::make_unique<Scene>(dim, shape, margin, n);
    kept = Key(dim, shape, n);
  }
  return *scene;
}

enum What { P2G_ONLY, G2P_ONLY, IO, STEP };

void run(benchmark::State &state, What what, const MPMKernels *table, int dim, Shape shape,
         Transfer transfer, bool split, int wanted)
{
  const TransferKernels k = table->transfer(dim, shape, transfer, split);
  Scene &s = scene(dim, shape, k.margin, wanted);
  // small displacements: points stay in their tiles however often the benchmark repeats
  const TransferStep step = {H, 1.0 / H, {0.0, 0.0, 0.0}, 1e-9, 0.99};
  const PointRows rows = s.rows();
  std::vector<double> nodes(64 * static_cast<size_t>(k.nreal) * s.nblocks, 0.0);
  constexpr int most = std::max(MAX_TILE_NODES, domain_tile_nodes(3));
  alignas(64) static double to_nodes[8 * most], to_points[8 * most];
  double L[9 * BATCH];
  std::vector<int> boxes(6 * s.blocks.size());
  std::fill(std::begin(to_nodes), std::end(to_nodes), 0.0);
  std::fill(std::begin(to_points), std::end(to_points), 0.0);

  auto p2g = [&](const Block &b, int *box) {
    for (int a = 0; a < 3; a++) box[a] = 1000, box[3 + a] = -1000;
    k.p2g(rows, step, b.first, b.last, b.base, to_nodes, box);
  };
  auto g2p = [&](const Block &b) {
    for (int p = b.first; p < b.last; p += BATCH)
      if (k.g2p(rows, step, p, std::min(p + BATCH, b.last), b.base, to_points,
                k.gradient_in_C ? nullptr : L))
        abort();
    benchmark::DoNotOptimize(L);
  };

  // boxes for IO
  for (size_t i = 0; i < s.blocks.size(); i++) {
    p2g(s.blocks[i], &boxes[6 * i]);
    k.flush(to_nodes, nodes.data(), s.blocks[i].slot, &boxes[6 * i]);
  }

  for (auto _ : state) {
    if (what == P2G_ONLY) {
      for (size_t i = 0; i < s.blocks.size(); i++) p2g(s.blocks[i], &boxes[6 * i]);
    } else if (what == G2P_ONLY) {
      for (const Block &b : s.blocks) g2p(b);
    } else if (what == IO) {
      for (size_t i = 0; i < s.blocks.size(); i++) {
        k.flush(to_nodes, nodes.data(), s.blocks[i].slot, &boxes[6 * i]);
        k.load(to_points, nodes.data(), s.blocks[i].slot, &boxes[6 * i]);
      }
    } else {
      std::fill(nodes.begin(), nodes.end(), 0.0);
      for (size_t i = 0; i < s.blocks.size(); i++) {
        p2g(s.blocks[i], &boxes[6 * i]);
        k.flush(to_nodes, nodes.data(), s.blocks[i].slot, &boxes[6 * i]);
      }
      table->solve_nodes(nodes.data(), 64 * s.nblocks, k.nreal, step.dt, MPM_NS::LEAST_MASS);
      for (size_t i = 0; i < s.blocks.size(); i++) {
        k.load(to_points, nodes.data(), s.blocks[i].slot, &boxes[6 * i]);
        g2p(s.blocks[i]);
      }
    }
    benchmark::ClobberMemory();
  }
  using benchmark::Counter;
  state.counters["ns/point"] =
      Counter(1e-9 * s.n, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

}    // namespace

int main(int argc, char **argv)
{
  static const char *const shapes[] = {"", "linear", "quadratic", "cubic", "gimp", "cpdi", "cpdi2"};
  static const char *const transfers[] = {"pic", "flip", "apic"};
  static const char *const whats[] = {"p2g", "g2p", "io", "step"};

  for (int wanted : {50000, 400000})
    for (int dim : {3, 2})
      for (Shape shape : {LINEAR, QUADRATIC, CUBIC, CPDI, CPDI2})
        for (const char *isa : {"reference", "baseline", "avx2", "avx512"}) {
          const MPMKernels *table = MPMKernels::select(isa);
          if (!table) continue;
          for (Transfer transfer : {PIC, FLIP, APIC})
            for (bool split : {false, true}) {
              if (transfer != APIC && !split) continue;
              for (What what : {P2G_ONLY, G2P_ONLY, IO, STEP}) {
                const std::string name = std::string(whats[what]) + "/" + table->isa + "/" +
                    std::to_string(dim) + "d/" + shapes[shape] + "/" + transfers[transfer] +
                    (transfer == APIC && split ? "-split" : "") + "/" +
                    std::to_string(wanted / 1000) + "k";
                benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State &state) {
                  run(state, what, table, dim, shape, transfer, split, wanted);
                })->Unit(benchmark::kMillisecond);
              }
            }
        }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
