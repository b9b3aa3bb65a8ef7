/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TIES_H
#define LMP_MPM_TIES_H

#include "pointers.h"
#include "solve/envelope_factors.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMBodyContact;

/** What bodies that touch each other (MPMBodyContact) need so that C v = g: v <- v - Z S^-1 (C v - g), with Z = P_w M^-1 C^T and S = C Z. Columns of Z are those of
 *  M^-1 C^T but for rows that have nodes on which walls act, of which each is found by letting walls act on it, once in a step. All ranks have the factors of
 *  the S of all rows. */
class MPMTies : protected Pointers {
 public:
  explicit MPMTies(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Rows of a step, and their columns. mass [node], vectors are [node][width]; walls(v): v <- P_w v, and acts how often walls do for that. Without walls, P_w is
   *  the unit matrix. Collective. */
  void begin(MPMBodyContact &, const std::vector<double> &mass, int width, int acts, bool has_walls,
             const std::function<void(double *)> &walls);
  /** Have columns been found in this step, with walls that act so often? */
  bool known_for(int acts) const { return contact && with_acts == acts; }
  /** Factors of S of what holds now. Collective. */
  void factorize();
  /** Velocities on which walls have acted become those with which nothing that touches approaches each other, by impulses that contact knows of. Collective. */
  void close(double *v);

 private:
  struct Entry {
    int64_t k;    // in vectors
    double value;
  };
  MPMBodyContact *contact = nullptr;
  int with_acts = 0;
  int all = 0;                                // rows on all ranks
  std::vector<int> global;                    // [row] number on all ranks, -1: none
  std::vector<std::vector<Entry>> columns;    // [number] of Z, on this rank
  std::vector<Eigen::Triplet<double>> S;      // of all rows
  std::vector<int> place;                     // [number] in the factors, -1: it does not hold
  MPM_NS::EnvelopeFactors factors;
  std::vector<double> rows, mine, of_ranks, sums, impulse;

  void number_rows(std::vector<char> &walled, const std::vector<char> &is_free);
  void find_products();
};

}    // namespace LAMMPS_NS
#endif
