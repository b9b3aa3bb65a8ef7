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

/** Impulses between bodies that touch each other (MPMBodyContact), so that C v = g:
 *
 *    v <- v - Z S^-1 (C v - g), with Z = P_w M^-1 C^T and S = C Z.
 *
 *  Columns of Z are those of M^-1 C^T, except for rows that have nodes on which walls act. The
 *  column of each of these is found by letting the walls act on it, once in a step. All ranks have
 *  the factors of S for all rows. */
class MPMTies : protected Pointers {
 public:
  explicit MPMTies(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Finds the rows of a step, and their columns. mass: [node]; vectors are [node][width]; acts:
   *  number of acts that walls(v): v <- P_w v, repeats. Without walls, P_w is the unit matrix.
   *  Collective. */
  void begin(MPMBodyContact &, const std::vector<double> &mass, int width, int acts, bool has_walls,
             const std::function<void(double *)> &walls);
  /** Have columns been found in this step, with walls that repeat this number of acts? */
  bool known_for(int acts) const { return contact && with_acts == acts; }
  /** Factorizes S of the rows that hold now. Collective. */
  void factorize();
  /** Changes velocities on which walls have acted so that no bodies that touch approach each other,
   *  and passes the impulses to the contact. Collective. */
  void close(double *v);

 private:
  struct Entry {
    int64_t k;    // index in vectors
    double value;
  };
  MPMBodyContact *contact = nullptr;
  int with_acts = 0;
  int all = 0;                                // rows on all ranks
  std::vector<int> global;                    // [row] its number on all ranks, -1: none
  std::vector<std::vector<Entry>> columns;    // [number] of Z, entries on this rank
  std::vector<Eigen::Triplet<double>> S;      // of all rows
  std::vector<int> place;    // [number] its position in the factors, -1: the row does not hold
  MPM_NS::EnvelopeFactors factors;
  std::vector<double> rows, mine, gathered, sums, impulse;

  void number_rows(std::vector<char> &walled, const std::vector<char> &is_free);
  void find_products();
};

}    // namespace LAMMPS_NS
#endif
