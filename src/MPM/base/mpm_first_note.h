/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FIRST_NOTE_H
#define LMP_MPM_FIRST_NOTE_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <mpi.h>

namespace LAMMPS_NS {

/** The first of the events that ranks have seen, for a warning that is printed once, with the same
 *  text for any number of ranks. A note of an event consists of N numbers, by which notes are
 *  ordered: first the step, then numbers that distinguish events of the same step, such as the
 *  place. */
template <std::size_t N> class MPMFirstNote {
 public:
  using Numbers = std::array<double, N>;

  /** Start of a run: forgets notes that have not been reported. */
  void begin() { mine = nothing(); }

  /** Has a note been reported? The same on all ranks. */
  bool is_reported() const { return reported; }

  /** Has a note been reported, or has this rank a note of an earlier step? Then there is no need to
   *  look for events. */
  bool knows(double step) const { return reported || mine[0] < step; }

  /** Takes a note of this rank; the least one is kept. */
  void take(const Numbers &numbers) { mine = std::min(mine, numbers); }

  /** Returns true once, when a rank has a note. Then first is the least note of all ranks.
   *  Collective. */
  bool report(MPI_Comm world, Numbers &first)
  {
    if (reported) return false;
    bool candidate = true;
    first = nothing();
    for (std::size_t k = 0; k < N; k++) {
      const double number = candidate ? mine[k] : NONE;
      MPI_Allreduce(&number, &first[k], 1, MPI_DOUBLE, MPI_MIN, world);
      if (first[0] == NONE) return false;
      candidate = candidate && mine[k] == first[k];
    }
    return reported = true;
  }

 private:
  static constexpr double NONE = 1.0e300;
  static Numbers nothing()
  {
    Numbers numbers = {};
    numbers[0] = NONE;
    return numbers;
  }

  Numbers mine = nothing();
  bool reported = false;
};

}    // namespace LAMMPS_NS
#endif
