/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_COHESIVE_LAW_H
#define LMP_MPM_COHESIVE_LAW_H

#include "declare/option.h"

namespace LAMMPS_NS {

/** Traction between two surfaces that are bonded, as a function of their opening: it grows in
 *  proportion to the opening up to a strength, and falls to zero with the damage, which grows from
 *  0 to 1. Where the opening is less than it was, the traction goes straight back to zero with it.
 *  Strength and energy depend on the share of shear in the opening (M.L. Benzeggagh, M. Kenane,
 *  Compos. Sci. Technol. 56 (1996) 439; for the strength: A. Turon et al., Mech. Mater. 38 (2006)
 *  1072). */
struct MPMCohesiveLaw {
  enum Softening { LINEAR, EXPONENTIAL };

  double strengths[2] = {0.0, 0.0};    ///< of tension and shear [pressure]
  double energies[2] = {0.0, 0.0};     ///< of modes I and II, per area [pressure distance]
  double mixing = 1.0;                 ///< exponent of the share of shear
  double stiffness = 0.0;              ///< [pressure/distance]; 0: rigid up to the strength
  Softening softening = LINEAR;

  /** The keywords that belong to the law; bonded: ID of a region. */
  void declare_keywords(MPM_NS::Options &, std::string &bonded);
  bool operator==(const MPMCohesiveLaw &) const;

  /** Share of shear in an opening, or in a traction, with these components: 0 to 1. */
  static double share_of_shear(double normal, double shear);
  /** Strength with this share of shear [pressure]. */
  double strength(double share) const;
  /** Energy that separates the surfaces, per area [pressure distance]. */
  double energy(double share) const;
  /** Largest opening so far where there is this damage [distance]. */
  double opening(double damage, double share) const;
  /** Damage where this is the largest opening so far. */
  double damage(double opening, double share) const;
  /** Opening by a unit of traction, up to the largest opening so far [distance/pressure]. */
  double compliance(double damage, double share) const;
  /** Opening without traction [distance]. */
  double last_opening() const;

 private:
  double blend(const double *of_modes, double share, double power) const;
};

}    // namespace LAMMPS_NS
#endif
