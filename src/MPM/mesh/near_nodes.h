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

/** Which nodes of a surface or a line are near each other along it, however it is folded: those that a path along edges joins which is
 *  shorter than a given length. Nothing here knows about LAMMPS. */
class NearNodes {
 public:
  struct Edge {
    int64_t a, b;     ///< nodes, from 0 on
    double length;    ///< without deformation
  };

  NearNodes(int64_t nnodes, const std::vector<Edge> &, double length);

  /** Is b near a? A node is near itself. */
  bool near(int64_t a, int64_t b) const;

  /** In bytes. */
  double memory() const;

 private:
  std::vector<int64_t> start;    // in list, of a node
  std::vector<int64_t> list;     // nodes near it, in order
};

}    // namespace MPM_NS
#endif
