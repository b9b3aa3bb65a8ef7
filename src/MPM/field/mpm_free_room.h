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

#include <array>
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
  double inside[FUNCTIONS][PARTS + 1] = {};           // as upto of a cell that no face limits
  std::vector<MPMBarrier *> at_rest, moving, near;    // near: those that count for this block
  using Shares = std::vector<double>;                 // of the nodes of a block; empty: all 1
  std::unordered_map<uint64_t, Shares> of_block;      // regions at rest alone
  // integrals of the functions of the nodes that reach a cell over its closed part; cells that are
  // wholly closed and away from faces share theirs
  static constexpr int OPEN = -1;
  using Integrals = std::array<double, FUNCTIONS * FUNCTIONS * FUNCTIONS>;
  std::vector<Integrals> in_cells;
  std::unordered_map<uint64_t, int> of_cell;    // index in in_cells; OPEN: nothing is closed
  int closed_cell = OPEN;

  struct Cell {
    explicit Cell(const int *index) : index(index) {}

    const int *index = nullptr;
    double low[3] = {};    // corner
    bool is_smooth = false;
    double middle = 0.0, slope[3] = {};    // distance, if is_smooth
    bool is_cut[3] = {};                   // by faces of the box
    double *closed = nullptr;              // in in_cells
    // integrals of the functions of nodes from minus infinity to the planes between its parts,
    // within the box
    double upto[3][FUNCTIONS][PARTS + 1] = {};
  };

  void list_barriers();
  double gap(const double *x, double far) const;
  bool is_near(const MPM_NS::Grid::Block &, const MPMBarrier &) const;
  bool is_cut_by_box(int axis, int cell) const;
  double in_box(int axis, int node, double t) const;
  Shares shares(const MPM_NS::Grid::Block &, int parts);
  void forget_cells();
  const double *closed_in(const int *cell, int parts);
  void find_slope(Cell &) const;
  void add_closed(Cell &, const int *part, int size, int least) const;
};

}    // namespace LAMMPS_NS
#endif
