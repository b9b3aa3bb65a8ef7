/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SUPER_STEP_H
#define LMP_MPM_SUPER_STEP_H

#include <functional>
#include <list>
#include <vector>

namespace LAMMPS_NS {

/** Explicit steps of diffusion equations, dy/dt = rate(y), that are longer than the limit of one
 *  explicit step. They consist of stages: RKL2 (C.D. Meyer, D.S. Balsara, T.D. Aslam, J. Comput.
 *  Phys. 257 (2014) 594) is of second order in time, and stable up to (s^2 + s - 2)/4 explicit
 *  limits with s stages. A step with one stage uses Euler's method.
 *
 *  All lists of values that are added take part in each stage, so that a rate may depend on the
 *  values of all of them. A sum of values that the rates conserve is conserved to round-off. The
 *  time integral of a power can be a list of values, too. */
class MPMSuperStep {
 public:
  /** Add a list of values and their rates. Both must have the same length whenever advance() is
   *  called. */
  void add(std::vector<double> &value, const std::vector<double> &rate);
  void clear() { lists.clear(); }

  /** Make one step. find_rates sets all rates from the present values; it is called once per
   *  stage. */
  void advance(int stages, double dt, const std::function<void()> &find_rates);

  /** The limit of a step with one stage, with a margin. greatest: bound of the eigenvalues of minus
   *  the rates [1/time]. */
  static double explicit_limit(double greatest);
  /** The longest step with at most this number of stages, in explicit limits. */
  static double reach(int most_stages);
  /** Number of stages of a step, or most_stages + 1 if most_stages do not suffice. */
  static int count(double dt, double limit, int most_stages);

  double memory_usage() const;

 private:
  struct Values {
    std::vector<double> &y;
    const std::vector<double> &rate;
    std::vector<double> first, first_rate, last;    // of stages
  };
  std::list<Values> lists;
};

}    // namespace LAMMPS_NS
#endif
