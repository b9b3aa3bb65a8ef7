// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// Products with the stiffness that conjugate gradients with SplineMultigrid need for two decades of
// the residual, from those to 1e-8.
//
//    bench_solids [largest number of points, 300000]
//
// Scenes are those of the page of the developers: points 2^dim per cell of a square or cube that is
// held at one side, patches with stiffnesses in a ratio, and thin bodies, under their weight.

#include "../unittest/solve/solid_scenes.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace MPM_NS;

namespace {

void measure(const std::string &name, const SolidScene &scene, double most)
{
  double cells = 1.0;
  for (int d = 0; d < scene.dim; d++) cells *= 2.0 * (scene.high[d] - scene.low[d]) / scene.h;
  if (cells > 1.05 * most) return;
  SolidSystem system(scene);
  const auto start = std::chrono::steady_clock::now();
  system.setup();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const auto b = system.forces([](const double *, int a) {
    return a == 1 ? -1.0 : 0.0;
  });
  auto x = system.zeros();
  system.napply = 0;
  const auto report = system.solve(b, x, {1e-8, 0.0, 1000});
  printf("%-36s %9.0f points %4d iterations %6.1f products for two decades, set-up %.1f s, %s\n",
         name.c_str(), cells, report.iterations, system.napply / 4.0, seconds.count(),
         report.converged() ? "" : report.describe().c_str());
  fflush(stdout);
}

SolidScene block(int dim, int n, double length = 1.0, double depth = 1.0)
{
  SolidScene scene{dim, 1.0 / n, {0.0, 0.0, 0.0}, {length, depth, dim == 3 ? 1.0 : 0.0}};
  scene.hold = [](const double *x, double(*P)[3]) {
    for (int a = 0; x[0] < 1e-9 && a < 3; a++) P[a][a] = 0.0;
  };
  return scene;
}

/** Patches of four to the side, of which every other one is this many times as stiff. */
SolidScene patches(SolidScene scene, double ratio)
{
  scene.young = [ratio](const double *x) {
    return ((int) (4.0 * x[0]) + (int) (4.0 * x[1]) + (int) (4.0 * x[2])) % 2 ? ratio : 1.0;
  };
  return scene;
}

}    // namespace

int main(int narg, char **arg)
{
  const double most = narg > 1 ? atof(arg[1]) : 3.0e5;
  for (const int n : {50, 100, 200, 400, 866}) {
    measure("square", block(2, n), most);
    for (const double ratio : {1.0e2, 1.0e4}) {
      char name[64];
      snprintf(name, sizeof(name), "patches, ratio %g", ratio);
      measure(name, patches(block(2, n), ratio), most);
    }
  }
  for (const int n : {1250, 10000, 40000, 375000})
    measure("strip of two cells", block(2, 1, n, 2.0), most);
  for (const int n : {11, 22, 37, 72}) {
    measure("cube", block(3, n), most);
    measure("cube of patches, ratio 10000", patches(block(3, n), 1.0e4), most);
  }
  for (const int n : {25, 50, 100, 200}) {
    SolidScene plate{3, 1.0, {0.0, 0.0, 0.0}, {(double) n, 2.0, (double) n}};
    plate.hold = block(3, 1).hold;
    measure("plate of two cells", plate, most);
  }
}
