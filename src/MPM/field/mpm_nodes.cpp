/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_nodes.h"

#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_halo.h"

#include <cmath>

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

// B-splines that are modified next to fixed faces (keyword edges of fix mpm), so that the nodes
// inside of the box and on its faces alone reproduce linear fields (M. Steffen, R.M. Kirby, M.
// Berzins, Int. J. Numer. Meth. Eng. 76 (2008) 922): a node outside has the value f_-1 = 2 f_0 -
// f_1. In terms of functions, N_0 + 2 N_-1 and N_1 - N_-1 take the place of N_0, N_1, and N_-1.

void MPMEdges::check() const
{
  for (int a = 0; a < field.lattice.dim; a++)
    for (int side = 0, plane; side < 2 && !field.lattice.periodic[a]; side++)
      if (!face_on_nodes(a, side, plane))
        error->all(FLERR,
                   "Fix mpm {} edges modified: the fixed face {}{} must be in a plane of nodes: "
                   "change spacing or origin",
                   field.id(), "xyz"[a], side ? "hi" : "lo");
}

void MPMEdges::find(bool without_outside)
{
  const Grid &grid = field.grid;
  for (int a = 0; a < grid.lattice.dim; a++) {
    lists[a].clear();
    if (grid.lattice.periodic[a]) continue;
    for (int side = 0; side < 2; side++) {
      int plane;
      if (!face_on_nodes(a, side, plane)) continue;
      const int out = side ? 1 : -1;
      for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
        const auto &block = grid.blocks[slot];
        const int n = plane - block.b[a] * grid.side;
        if (n < 0 || n >= grid.side) continue;
        for (int k = 0; k < NODES_PER_BLOCK; k++) {
          int index[3];
          grid.node_index(block, k, index);
          if (index[a] != plane) continue;
          Nodes e;
          e.face = (int64_t) slot * NODES_PER_BLOCK + k;
          index[a] = plane + out;
          e.outside = grid.locate(index);
          index[a] = plane - out;
          e.inside = grid.locate(index);
          // points that reach the node outside reach the others, so that it has nothing without
          // them
          if (e.inside >= 0 && (e.outside >= 0 || without_outside)) lists[a].push_back(e);
        }
      }
    }
  }
}

/** Index along axis a of the plane of nodes in a fixed face of the box; false: there is none. */
bool MPMEdges::face_on_nodes(int a, int side, int &plane) const
{
  constexpr double ON_NODE = 1.0e-6;
  const auto &lattice = field.lattice;
  const double at = ((side ? domain->boxhi[a] : domain->boxlo[a]) - lattice.origin[a]) / lattice.h;
  plane = (int) std::lround(at);
  return std::fabs(at - plane) <= ON_NODE;
}

void MPMEdges::fold(double *nodes, int nreal, int lane, int nlane) const
{
  for (int a = field.lattice.dim - 1; a >= 0; a--)
    for (const auto &e : lists[a]) {
      double *out = nodes + e.outside * nreal + lane;
      double *face = nodes + e.face * nreal + lane, *in = nodes + e.inside * nreal + lane;
      for (int i = 0; i < nlane; i++) {
        face[i] += 2.0 * out[i];
        in[i] -= out[i];
        out[i] = 0.0;
      }
    }
}

void MPMEdges::extend(double *nodes, int nreal, int lane, int nlane) const
{
  for (int a = 0; a < field.lattice.dim; a++)
    for (const auto &e : lists[a])
      for (int i = lane; i < lane + nlane; i++)
        nodes[e.outside * nreal + i] =
            2.0 * nodes[e.face * nreal + i] - nodes[e.inside * nreal + i];
}

double MPMEdges::memory_usage() const
{
  double bytes = 0.0;
  for (const auto &list : lists) bytes += list.capacity() * sizeof(Nodes);
  return bytes;
}
