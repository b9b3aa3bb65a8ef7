/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FREE_ROOM_H
#define LMP_MPM_FREE_ROOM_H

#include "field/mpm_interfaces.h"
#include "lattice/grid.h"
#include "pointers.h"
#include "transfer/shape.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Integral of the function of a node from minus infinity to t, in node spacings from the node. */
double integral_of_function(MPM_NS::Shape, double t);

/** The room of nodes that regions leave to the material of a field: the part of the integral of the
 *  function of a node over the box that is outside of all regions that keep material out. */
class MPMFreeRoom : protected Pointers {
 public:
  MPMFreeRoom(class LAMMPS *lmp, const MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run: nothing is known. */
  void init();
  /** Are there such regions? Only during a run. */
  bool is_cut();
  /** Finds the shares of nodes, [node], as the regions are at the start of this step: of blocks
   *  with mass, others have 1. nodes: records of nodes with nreal reals, of which the fourth one is
   *  positive where points are. */
  void find(const double *nodes, int nreal, std::vector<double> &share);

  double memory_usage() const;

 private:
  static constexpr int PARTS = 8;        // of a cell along each axis, for regions at rest
  static constexpr int FUNCTIONS = 4;    // of nodes that reach a cell, along each axis

  const MPMField &field;
  bool known = false;
  std::vector<MPMBarrier *> at_rest, moving, near;    // near: those that count for this block
  using Shares = std::vector<double>;                 // of the nodes of a block; empty: all 1
  std::unordered_map<uint64_t, Shares> of_block;      // regions at rest alone
  // sums over the closed part of a cell, for the nodes that reach it; empty: nothing is closed
  std::unordered_map<uint64_t, std::vector<double>> of_cell;

  struct Cell {
    const int *index;
    double low[3];                 // corner
    std::vector<double> closed;    // as in of_cell
    // integrals of the functions of nodes from minus infinity to the planes between its parts,
    // within the box; valid unless closed is empty
    double upto[3][FUNCTIONS][PARTS + 1];
  };

  void list_barriers();
  double gap(const double *x, double far) const;
  bool is_near(const MPM_NS::Grid::Block &, const MPMBarrier &) const;
  double in_box(int axis, int node, double t) const;
  Shares shares(const MPM_NS::Grid::Block &, int parts);
  const std::vector<double> &closed_in(const int *cell, int parts);
  void add_closed(Cell &, const int *part, int size, int least) const;
};

}    // namespace LAMMPS_NS
#endif
