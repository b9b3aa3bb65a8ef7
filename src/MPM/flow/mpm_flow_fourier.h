/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_FOURIER_H
#define LMP_MPM_FLOW_FOURIER_H

#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMFlowLattice;

/** Solves Poisson's equation with the same weight at all faces in the box around the wet cells, by
 *  Fourier transforms, as a preconditioner of the equations of the pressure (MPMFlowPoisson).
 *
 *  A periodic axis has all of its period. At an end of another axis, no water flows if most of the
 *  outermost wet cells have a wall there. Otherwise psi is zero half a cell beyond them: most of
 *  the water is then next to air. The functions of an axis are those sines and cosines that fit its
 *  two ends (S.A. Martucci, IEEE Trans. Signal Process. 42 (1994) 1038; types II and IV). Where
 *  water fills the box, the solution is exact. Elsewhere it ignores that dry cells of the box have
 *  no water, and the number of iterations grows about as the square root of the number of cells
 *  along an axis.
 *
 *  A rank has layers of the box across its last axis for the transforms along the other ones, and
 *  lines for those along the last one. Transforms are those of FFTW. */
class MPMFlowFourier {
 public:
  MPMFlowFourier(class LAMMPS *, const MPMFlowLattice &);
  ~MPMFlowFourier();

  /** Was this program built with FFTW? All others are only for programs that were. */
  static bool is_there();

  void begin();    ///< removes all cells
  /** Adds a wet cell of this rank. index: [dim] of the cell; closed: bit 2 d + s: the side s along
   *  the axis d is closed; is_wanted: have residuals and solutions a value for it? */
  void add(const int *index, int closed, bool is_wanted);
  /** Prepares the transforms when all cells are there. weight: of the faces. Collective. */
  void arrange(double weight);
  /** Replaces right sides by solutions. values: [wanted cell], in the order of add().
   *  Collective. */
  void solve(std::vector<double> &values);

  double memory_usage() const;

 private:
  enum End { PERIODIC, CLOSED, OPEN };
  struct Axis {
    int first, n;    // first cell, number of cells
    End end[2];
    std::vector<double> eigenvalue;    // of the second difference, [mode]
    void find_eigenvalues();
    bool same_transform(const Axis &) const;
  };
  /** The share of the ranks of something that is in order. */
  struct Shares {
    std::vector<int> first;    // [rank], and the end
    void divide(int n, int nranks);
    int count(int rank) const { return first[rank + 1] - first[rank]; }
    int has(int k) const;    // rank
  };
  struct Transforms;    // arrays and plans
  struct Cell {
    int index[3];
    int closed;
  };
  struct Exchange {
    std::vector<int> send, receive;          // [rank] number of values
    std::vector<int> send_at, receive_at;    // [rank] where they begin
    void begin(int nranks);
    void find_places();
    int all_sent() const { return send_at.back() + send.back(); }
    int all_received() const { return receive_at.back() + receive.back(); }
  };

  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  std::vector<Cell> wet;
  std::vector<int> wanted;    // of the cells
  Axis axis[3];
  double inverse = 0.0;            // 1/(weight, normalization)
  double mean_eigenvalue = 0.0;    // eigenvalue that the mean gets where it has none
  int ncolumns = 0;                // cells in a layer
  Shares layers, columns;
  std::unique_ptr<Transforms> on;
  Exchange cell_exchange, column_exchange;
  std::vector<int> sorted, place;            // [value that is sent], [value that is received]
  std::vector<double> outgoing, incoming;    // values of messages

  bool find_box();
  void find_plans();
  void find_exchange();
  void swap(const Exchange &, bool back);
  void to_lines(bool back);
  void divide_modes();
};

}    // namespace LAMMPS_NS
#endif
