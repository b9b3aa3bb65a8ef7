/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_flow_air.h"

using namespace LAMMPS_NS;

void MPMFlowAir::extend(int layers, std::vector<double> &velocity, std::vector<double> &known)
{
  const int dim = cells.lattice.dim;
  for (int layer = 0; layer <= layers; layer++) {
    all_velocity = velocity;
    all_known = known;
    cells.publish(all_velocity.data(), dim);
    cells.publish(all_known.data(), dim);
    if (layer == layers) break;
    for (const auto &cell : cells.cells)
      for (int c = 0; c < dim; c++) {
        const int64_t face = (int64_t) cell.number * dim + c;
        if (known[face] > 0.0) continue;
        double sum = 0.0, n = 0.0;
        for (int s = 0; s < 2 * dim; s++) {
          if (cell.walls >> s & 1)
            continue;    // nothing beyond, and not the face in the wall itself
          const int64_t other = (int64_t) cell.near[s] * dim + c;
          sum += all_known[other] * all_velocity[other];
          n += all_known[other];
        }
        if (n == 0.0) continue;
        velocity[face] = sum / n;
        known[face] = 1.0;
      }
  }
  velocity.swap(all_velocity);
  known.swap(all_known);
}
