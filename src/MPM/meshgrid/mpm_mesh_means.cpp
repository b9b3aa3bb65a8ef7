/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/mpm_mesh_means.h"

#include "meshgrid/mpm_mesh_ranks.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMMeshMeans::clear(int ngroup, int nvalue)
{
  groups = ngroup;
  width = 1 + nvalue;
  sums.resize(row(groups, 0));
  for (int group = 0; group < groups; group++)
    for (const int node : ranks.nodes) std::fill_n(&sums[row(group, node)], width, 0.0);
}

void MPMMeshMeans::add(int group, const BackgroundMesh::Place &place, double weight,
                       const double *values)
{
  const auto &cell = mesh.cells[place.cell];
  for (int k = 0; k < cell.nnode; k++) {
    double *const to = &sums[row(group, cell.node[k])];
    const double w = weight * place.N[k];
    to[0] += w;
    for (int j = 1; j < width; j++) to[j] += w * values[j - 1];
  }
}

void MPMMeshMeans::sum()
{
  for (int group = 0; group < groups; group++) ranks.sum(&sums[row(group, 0)], width);
}

double MPMMeshMeans::mean(int group, const BackgroundMesh::Place &place, int k) const
{
  const auto &cell = mesh.cells[place.cell];
  double all = 0.0;
  for (int j = 0; j < cell.nnode; j++) {
    const double *const from = &sums[row(group, cell.node[j])];
    if (from[0] > 0.0) all += place.N[j] * from[1 + k] / from[0];
  }
  return all;
}
