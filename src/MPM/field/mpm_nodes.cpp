/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_nodes.h"

#include "field/mpm_edges.h"
#include "field/mpm_field.h"
#include "field/mpm_halo.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMNodes::MPMNodes(LAMMPS *lmp, const MPMField &field, Grid &grid) :
    Pointers(lmp), halo(new MPMHalo(lmp)),
    edges(field.options.modified_edges ? new MPMEdges(lmp, field) : nullptr), grid(grid)
{
}

MPMNodes::~MPMNodes() = default;

NodeField &MPMNodes::add_field(const std::string &name, int width)
{
  fields.push_back({name, width, {}});
  return fields.back();
}

void MPMNodes::allocate(int nreal)
{
  grid.allocate(nreal);
  for (auto &nodes : fields) nodes.values.assign(grid.nnodes() * nodes.width, 0.0);
}

void MPMNodes::sum(double *values, int nreal, int lane, int nlane) const
{
  if (edges) edges->fold(values, nreal, lane, nlane);
  grid.fold_aliases(values, nreal, lane, nlane);
  halo->sum(values, nreal, lane, nlane);
}

void MPMNodes::complete(double *values, int nreal, int nlane) const
{
  grid.copy_aliases(values, nreal);
  if (edges) edges->extend(values, nreal, 0, nlane);
}

void MPMNodes::complete_velocities()
{
  complete(grid.nodes(), grid.nreal, 3);
  if (edges && grid.nreal == 8) edges->extend(grid.nodes(), grid.nreal, 4, 3);
}

double MPMNodes::memory_usage() const
{
  double bytes = grid.memory_usage() + halo->memory_usage();
  if (edges) bytes += edges->memory_usage();
  for (const auto &nodes : fields) bytes += nodes.values.capacity() * sizeof(double);
  return bytes;
}
