/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_ROWS_H
#define LMP_MPM_FLOW_ROWS_H

#include "flow/mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {

/** Cells with equations in a list without gaps, for solves: those of this rank, and their neighbors
 *  on other ranks. Vectors on the lattice have all cells of its blocks, some of them on several
 *  ranks. Here each rank has its own cells, and gets only the values of others that it needs.
 *
 *  A list has two halves, cells with an even sum of indices (EVEN), whose neighbors have an odd one
 *  (ODD). If a period has an odd number of cells, the last ones are EVEN, and some of their
 *  neighbors are EVEN, too. ODD cells never have ODD neighbors. */
class MPMFlowRows {
 public:
  enum Half { EVEN, ODD };

  /** Values at places: EVEN cells of this rank, ODD ones, those of other ranks, and a zero. */
  std::vector<double> values;

  MPMFlowRows(class LAMMPS *lmp, const MPMFlowLattice &cells) : lmp(lmp), cells(cells) {}

  void begin();    ///< removes all cells
  /** Adds a cell that this rank owns; near: [2 dim] numbers of neighbors with equations, -1:
   *  none. */
  void add(int number, const int *near);
  /** Puts the cells in order when all have been added. Collective. */
  void arrange();

  int size() const { return (int) row.size(); }    ///< number of cells of this rank
  int size_of(Half half) const { return half == EVEN ? neven : size() - neven; }
  int first_of(Half half) const { return half == EVEN ? 0 : neven; }
  /** Number of the cell at a place, and its place in the order of add(). */
  int cell_at(int place) const { return number[row[place]]; }
  int row_at(int place) const { return row[place]; }
  int sides() const { return nsides; }    ///< number of neighbors of a cell, 2 dim
  /** Place of a neighbor of a cell at a place. */
  int near(int place, int side) const { return places[(std::size_t) place * nsides + side]; }

  /** Get values of a half from other ranks: fetch() begins this, wait() waits until all that has
   *  begun is complete. */
  void fetch(Half half);
  void wait();
  /** sum: [place in the half] sums of factor [place][side] times values of neighbors. Values of the
   *  other half are fetched from other ranks; values of the same half, which count at odd periods,
   *  must be present. Collective. */
  void sum(Half half, const std::vector<double> &factor, double *sum);
  /** The same sums for all cells; all values of other ranks are fetched. Collective. */
  void sum_all(const std::vector<double> &factor, double *sum);

  double memory_usage() const;

 private:
  struct Peer {
    int rank;
    std::vector<int> give[2];    // places of values that it gets, by half
    int first[2], many[2];       // first place and number of values that it gives, by half
    std::vector<double> send[2];
  };

  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  int nsides = 0, neven = 0;
  int inner[2] = {0, 0};               // number of cells of a half without neighbors on other ranks
  std::vector<int> number, next_to;    // [row], [row][sides]
  std::vector<int> row;                // [place]
  std::vector<int> place_of;           // [cell], -1: none
  std::vector<int> places;             // [place][sides]
  std::vector<Peer> peers;
  std::vector<MPI_Request> requests;
  int nrequests = 0;
  std::vector<char> flags_out, flags_in, wanted;

  Half half_of(int64_t cell) const;
  void find_peers();
  void sum_some(int first, int last, const std::vector<double> &factor, double *sum) const;
};

}    // namespace LAMMPS_NS
#endif
