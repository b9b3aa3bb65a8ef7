/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* With the opening d, the strength s, the energy G, the stiffness k, and d_0 = s/k, the traction at
   openings that are the largest so far is s (1 - D),

     linear        D = (d - d_0)/(d_1 - d_0),       d_1 = 2 G/s
     exponential   D = 1 - exp(-(d - d_0)/d_1),     d_1 = G/s - d_0/2

   and at smaller ones in proportion to the opening. The area below the curve is G. */

#include "contact/mpm_cohesive_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// exponential: damage from which on nothing holds, so that surfaces part for good; G lacks as much
static constexpr double BROKEN = 1.0 - 1.0e-4;

void MPMCohesiveLaw::declare_keywords(Options &o, std::string &bonded)
{
  using namespace option;
  o.add("softening",
        {word(softening,
              {{"linear", LINEAR, "traction falls in proportion to the opening"},
               {"exponential", EXPONENTIAL, "it falls as an exponential function"}})});
  o.add("stiffness",
        {number(stiffness, "K", POSITIVE, "pressure/distance",
                "traction by the opening of a bond without damage")})
      .standard("rigid up to the strength");
  o.add("mixing",
        {number(mixing, "eta", POSITIVE, "",
                "exponent of the share of shear in strength and energy")});
  o.add("bonded", {text(bonded, "region-ID", "where bodies are bonded, if they touch there")})
      .standard("wherever bodies touch");
}

bool MPMCohesiveLaw::operator==(const MPMCohesiveLaw &other) const
{
  return std::equal(strengths, strengths + 2, other.strengths) &&
      std::equal(energies, energies + 2, other.energies) && mixing == other.mixing &&
      stiffness == other.stiffness && softening == other.softening;
}

double MPMCohesiveLaw::share_of_shear(double normal, double shear)
{
  const double tension = std::max(normal, 0.0), all = tension * tension + shear * shear;
  return all > 0.0 ? shear * shear / all : 0.0;
}

double MPMCohesiveLaw::blend(const double *of_modes, double share, double power) const
{
  if (of_modes[0] == of_modes[1]) return of_modes[0];
  const double first = std::pow(of_modes[0], power), second = std::pow(of_modes[1], power);
  return std::pow(first + (second - first) * std::pow(share, mixing), 1.0 / power);
}

double MPMCohesiveLaw::strength(double share) const
{
  return blend(strengths, share, 2.0);
}

double MPMCohesiveLaw::energy(double share) const
{
  return blend(energies, share, 1.0);
}

double MPMCohesiveLaw::opening(double damage, double share) const
{
  const double s = strength(share), G = energy(share), first = stiffness > 0.0 ? s / stiffness : 0;
  if (softening == LINEAR) return first + damage * (2.0 * G / s - first);
  return damage < BROKEN ? first - std::log1p(-damage) * (G / s - 0.5 * first)
                         : std::numeric_limits<double>::infinity();
}

double MPMCohesiveLaw::damage(double opening, double share) const
{
  const double s = strength(share), G = energy(share), first = stiffness > 0.0 ? s / stiffness : 0;
  const double beyond = std::max(opening - first, 0.0);
  if (softening == LINEAR) return std::min(1.0, beyond / (2.0 * G / s - first));
  const double damage = -std::expm1(-beyond / (G / s - 0.5 * first));
  return damage < BROKEN ? damage : 1.0;
}

double MPMCohesiveLaw::compliance(double damage, double share) const
{
  return opening(damage, share) / (strength(share) * (1.0 - damage));
}

double MPMCohesiveLaw::last_opening() const
{
  double last = 0.0;
  for (const double share : {0.0, 1.0})
    last = std::max(last, opening(softening == LINEAR ? 1.0 : 0.99, share));
  return last;
}
