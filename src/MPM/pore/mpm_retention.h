/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_RETENTION_H
#define LMP_MPM_RETENTION_H

namespace LAMMPS_NS {

/** How much water the pores of a soil keep, and let flow, when its pressure p is below that of the
 *  air. With the effective saturation S_e = (S - S_r)/(S_s - S_r), which is one for p >= 0,
 *
 *    S_e = (1 + (-alpha p)^n)^-m, m = 1 - 1/n   (M.T. van Genuchten, Soil Sci. Soc. Am. J. 44 (1980) 892)
 *    S_e = exp(alpha p)                         (W.R. Gardner, Soil Sci. 85 (1958) 228)
 *
 *  and the permeability is that of full pores times
 *
 *    k_r = S_e^1/2 (1 - (1 - S_e^(1/m))^m)^2    (Y. Mualem, Water Resour. Res. 12 (1976) 513; van Genuchten)
 *    k_r = S_e^e */
struct MPMRetention {
  enum Law { FULL, VAN_GENUCHTEN, GARDNER };
  enum Flow { OF_LAW, MUALEM, POWER };

  Law law = FULL;                   ///< FULL: pores keep all water
  double alpha = 0.0;               ///< [1/pressure]
  double n = 0.0;                   ///< of van Genuchten
  double least = 0.0;               ///< residual saturation S_r
  double most = 1.0;                ///< saturation S_s for p >= 0
  Flow flow = OF_LAW;               ///< OF_LAW: Mualem for van Genuchten, the power 1 for Gardner
  double power = 1.0;               ///< e
  bool bishop_effective = false;    ///< Bishop's coefficient is S_e, not S

  /** Can pores lose water, so that they are not always full? */
  bool can_dry() const { return law != FULL; }

  /** State at a pressure p below that of the air. */
  struct State {
    double effective, saturation;
    double slope;       ///< dS/dp [1/pressure]
    double relative;    ///< k_r
    double bishop;      ///< chi, share of the pressure in the effective stress (Bishop)
  };
  State at(double p) const;
  /** Derivative of the pressure in the effective stress with respect to the pressure of the water,
   *  d(chi p)/dp. With full pores it is chi, which is S_s if Bishop's coefficient is the
   *  saturation. */
  double borne(double p) const
  {
    if (!can_dry()) return 1.0;
    const State now = at(p);
    if (p >= 0.0) return now.bishop;
    return now.bishop + p * now.slope / (bishop_effective ? most - least : 1.0);
  }
};

}    // namespace LAMMPS_NS
#endif
