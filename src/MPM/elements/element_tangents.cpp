/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/element_forces.h"
#include "elements/element_surface.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double DIFFERENCE = 1.0e-5;    // relative to the shortest element

double ElementTangents::find(const double *motion)
{
  const int dim = body.dim;
  size = body.maxnode * dim;
  tangents.assign(body.size() * size * size, 0.0);
  const double step = DIFFERENCE * forces.shortest;
  double sum = 0.0;
  for (int column = 0; column < size; column++)
    for (const double sign : {-1.0, 1.0}) {
      ElementForces::Trial trial{motion};
      trial.shifted_node = column / dim;
      trial.shift[column % dim] = sign * step;
      forces.try_motion(trial, [&](std::size_t e, int nnode, const double(*on)[3]) {
        double *const K = &tangents[e * size * size + (std::size_t) size * column];
        for (int m = 0; m < nnode; m++)
          for (int d = 0; d < dim; d++) K[dim * m + d] += sign * on[m][d] / (2.0 * step);
      });
    }
  if (surface.pressure) surface.differentiate_pressure(motion, forces.shortest, tangents.data());
  for (std::size_t e = 0; e < body.size(); e++) {
    double most = 0.0;
    for (int k = 0; k < size * size; k++)
      most = std::max(most, std::fabs(tangents[e * size * size + k]));
    sum += most * forces.shortest;
  }
  return sum;
}

void ElementTangents::add_change(const double *motion, double *to) const
{
  const int dim = body.dim;
  for (std::size_t e = 0; e < body.size(); e++) {
    const double *K = &tangents[e * size * size];
    const int nnode = body.nodes_of(body.row(e));
    for (int a = 0; a < nnode; a++)
      for (int b = 0; b < dim; b++, K += size) {
        const double moved = motion[3 * (std::size_t) body.nodes[e][a] + b];
        for (int m = 0; m < nnode; m++)
          for (int d = 0; d < dim; d++)
            to[3 * (std::size_t) body.nodes[e][m] + d] += K[dim * m + d] * moved;
      }
  }
}

void ElementTangents::add_stiffness(int b, double *to) const
{
  const int dim = body.dim;
  for (std::size_t e = 0; e < body.size(); e++)
    for (int m = 0; m < body.nodes_of(body.row(e)); m++)
      for (int d = 0; d < dim; d++)
        to[3 * (std::size_t) body.nodes[e][m] + d] -=
            tangents[e * size * size + (std::size_t) size * (dim * m + b) + dim * m + d];
}

double ElementTangents::asymmetry() const
{
  double most = 0.0, largest = 0.0;
  for (std::size_t e = 0; e < body.size(); e++)
    for (int k = 0; k < size; k++)
      for (int l = 0; l < size; l++) {
        const double *const K = &tangents[e * size * size];
        most = std::max(most, std::fabs(K[size * k + l] - K[size * l + k]));
        largest = std::max(largest, std::fabs(K[size * k + l]));
      }
  return largest > 0.0 ? most / largest : 0.0;
}
