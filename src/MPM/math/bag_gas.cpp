/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "math/bag_gas.h"

using namespace MPM_NS;

double BagGas::flow(double p, double q, double RT, double gamma)
{
  if (!(p > q)) return 0.0;
  const double r = q / p;
  if (gamma == 1.0) {    // limit of the expressions below
    const double least = std::exp(-0.5);
    return p / std::sqrt(RT) * (r <= least ? least : r * std::sqrt(-2.0 * std::log(r)));
  }
  const double least = std::pow(2.0 / (gamma + 1.0), gamma / (gamma - 1.0));
  if (r <= least)
    return p * std::sqrt(gamma / RT) *
        std::pow(2.0 / (gamma + 1.0), 0.5 * (gamma + 1.0) / (gamma - 1.0));
  return p * std::sqrt(2.0 * gamma / ((gamma - 1.0) * RT)) * std::pow(r, 1.0 / gamma) *
      std::sqrt(1.0 - std::pow(r, (gamma - 1.0) / gamma));
}
