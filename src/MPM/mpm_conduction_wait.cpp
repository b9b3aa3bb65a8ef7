/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Heat that friction gives to nodes in a step without conduction goes to points at once, as nodes are others in the next step:

     Q_p = sum_i Q_i m_p N_ip/m_i,

   of which the sum over points is sum_i Q_i. With one capacity for each mass this is the change of the temperature of nodes, Q_i/C_i,
   at the point, as after conduction. Only points next to nodes that got heat are visited.
------------------------------------------------------------------------- */

#include "atom.h"
#include "fix_mpm_material.h"
#include "mpm_conduction.h"
#include "mpm_field.h"
#include "mpm_stencil.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

double MPMConduction::keep_given()
{
  static constexpr int MASS = 3;    // of a node, in its record
  Grid &grid = field.grid;
  given.resize(grid.nnodes(), 0.0);
  for (std::size_t k = 0; k < given.size(); k++)
    if (given[k] != 0.0) given[k] /= grid.nodes()[grid.nreal * k + MASS];
  field.nodes.complete(given.data(), 1, 1);
  warmed.assign(grid.blocks.size(), 0);
  for (std::size_t k = 0; k < given.size(); k++)
    if (given[k] != 0.0) warmed[k / NODES_PER_BLOCK] = 1;

  const MPMStencil stencil(field);
  Conduction room;
  double got = 0.0;
  for (const auto &run : field.map->runs) {
    const auto &block = grid.blocks[run.slot];
    const Thermal *const t = thermal(run.material);
    if (!t || std::none_of(std::begin(block.slot), std::end(block.slot), [&](int slot) {
          return slot >= 0 && warmed[slot];
        }))
      continue;
    for (int i = run.first; i < run.last; i++) {
      double heat = 0.0;
      stencil.visit(block, i, [&](const MPMStencil::Node &node) {
        heat += node.weight * given[node.number];
      });
      if (heat == 0.0) continue;
      got += atom->rmass[i] * heat;
      double *const history = t->fix->history[i];
      const Conduction &c = t->at(i, room);
      if (c.by_enthalpy) {
        t->fix->material->warm(history, heat);
      } else {
        history[t->temperature] += heat / c.capacity;
        if (t->molten >= 0) c.melting.settle(history[t->temperature], history[t->molten]);
      }
    }
  }
  given.clear();
  return got;
}
