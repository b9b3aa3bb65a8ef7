/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_DECLARE_RANGE_H
#define MPM_DECLARE_RANGE_H

// Ranges of the numbers that laws and styles declare. Nothing here knows about LAMMPS.

#include <limits>

namespace MPM_NS {

/** Values that a number may have: low < value < high, or low <= value <= high if closed. */
struct Range {
  double low, high;
  bool closed;
  bool closed_above = closed;    ///< is it closed at high? By default as at low

  bool contains(double value) const
  {
    return (closed ? value >= low : value > low) && (closed_above ? value <= high : value < high);
  }
};
constexpr double UNBOUNDED = std::numeric_limits<double>::infinity();
constexpr Range ANY_NUMBER{-UNBOUNDED, UNBOUNDED, false};
constexpr Range POSITIVE{0.0, UNBOUNDED, false};
constexpr Range NOT_NEGATIVE{0.0, UNBOUNDED, true};
constexpr Range AT_LEAST_ONE{1.0, UNBOUNDED, true};
constexpr Range FRACTION{0.0, 1.0, true};
constexpr Range POISSON_RATIO{-1.0, 0.5, false};

}    // namespace MPM_NS
#endif
