/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_air.h"

using namespace LAMMPS_NS;

/* ----------------------------------------------------------------------
   Velocities and flags go in one message, [cell][velocity, known]. A layer is added to the faces
   that are still unknown, which are few, once all of it is found.
------------------------------------------------------------------------- */

void MPMFlowAir::extend(std::vector<double> &velocity, std::vector<double> &known)
{
  const int dim = cells.lattice.dim, width = 2 * dim;
  unknown.clear();
  for (int k = 0; k < (int) cells.cells.size(); k++)
    for (int c = 0; c < dim; c++)
      if (!(known[(int64_t) cells.cells[k].number * dim + c] > 0.0)) unknown.push_back({k, c});
  all.resize(velocity.size() * 2);
  for (int64_t k = 0; k < cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      all[k * width + c] = velocity[k * dim + c];
      all[k * width + dim + c] = known[k * dim + c];
    }
  cells.publish(all.data(), width);
  for (int layer = 0; layer < LAYERS; layer++) {
    found.clear();
    std::size_t left = 0;
    for (const auto &face : unknown) {
      const auto &cell = cells.cells[face.cell];
      double sum = 0.0, n = 0.0;
      for (int s = 0; s < 2 * dim; s++) {
        if (cell.walls >> s & 1)
          continue;    // nothing is beyond, and the face in the wall itself does not count
        const double *const other = &all[(int64_t) cell.near[s] * width + face.axis];
        sum += other[dim] * other[0];
        n += other[dim];
      }
      if (n == 0.0)
        unknown[left++] = face;
      else
        found.push_back({(int64_t) cell.number * width + face.axis, sum / n});
    }
    unknown.resize(left);
    for (const auto &[place, value] : found) {
      all[place] = value;
      all[place + dim] = 1.0;
    }
    cells.renew(all.data(), width);
  }
  for (int64_t k = 0; k < cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      velocity[k * dim + c] = all[k * width + c];
      known[k * dim + c] = all[k * width + dim + c];
    }
}
