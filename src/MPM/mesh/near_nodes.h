/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_NEAR_NODES_H
#define MPM_MESH_NEAR_NODES_H

#include <cstdint>
#include <vector>

namespace MPM_NS {

/** Tells which nodes of a surface or a line are near each other along it, however it is folded: two
 *  nodes are near if a path along edges shorter than a given length connects them. Nothing here
 *  knows about LAMMPS. */
class NearNodes {
 public:
  struct Edge {
    int64_t a, b;     ///< nodes, numbered from 0
    double length;    ///< length without deformation
  };

  NearNodes(int64_t nnodes, const std::vector<Edge> &, double length);

  /** Is b near a? Each node is near itself. */
  bool near(int64_t a, int64_t b) const;

  /** Memory in bytes. */
  double memory() const;

 private:
  std::vector<int64_t> start;    // first entry of each node in list
  std::vector<int64_t> list;     // near nodes of each node, sorted
};

}    // namespace MPM_NS
#endif
