/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_AITKEN_H
#define MPM_MATH_AITKEN_H

#include <cstddef>
#include <vector>

namespace MPM_NS {

/** Accelerates iterations x -> f(x) that converge slowly. The changes of x are then nearly a
 *  geometric series, c' = s c, whose factor s follows from two changes in a row. The rest of the
 *  series, c' (s + s^2 + ...), is added at once (Aitken's method for vectors). The limit of the
 *  iterations does not change. */
class Aitken {
 public:
  /** To be called before the first iteration. */
  void begin(const std::vector<double> &x)
  {
    last = x;
    change.assign(x.size(), 0.0);
    knows_change = jumped = false;
    failed = 0;
  }

  /** To be called after each iteration. error: the error that the iterations reduce; smooth: f is
   *  the same function as in the iteration before. Returns true if x was changed. */
  bool advance(std::vector<double> &x, double error, bool smooth)
  {
    constexpr double SLOW = 0.2, NO_END = 1.0 - 1.0e-9;
    constexpr int MOST = 3;    // steps that may increase the error before it gives up
    if (jumped && error > error_before) failed++;
    jumped = false;
    if (failed == MOST) return false;
    double product = 0.0, square = 0.0;
    for (std::size_t i = 0; i < x.size(); i++) {
      const double now = x[i] - last[i];
      product += now * change[i];
      square += change[i] * change[i];
      change[i] = now;
      last[i] = x[i];
    }
    const bool knew = knows_change;
    knows_change = smooth;
    const double s = product / square;
    if (!smooth || !knew || !(s > SLOW && s < NO_END)) return false;
    for (std::size_t i = 0; i < x.size(); i++) last[i] = x[i] += s / (1.0 - s) * change[i];
    knows_change = false;
    jumped = true;
    error_before = error;
    return true;
  }

 private:
  std::vector<double> last, change;
  bool knows_change = false, jumped = false;
  int failed = 0;
  double error_before = 0.0;
};

}    // namespace MPM_NS
#endif
