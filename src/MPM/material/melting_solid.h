/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_MELTING_SOLID_H
#define MPM_MATERIAL_MELTING_SOLID_H

#include "material/material.h"

#include <algorithm>
#include <cstring>

namespace MPM_NS {

/** The solid part of points that melt and solidify. It has the share s of their volume, and bears the deviator
 *  S = s S_s of their stress, with the deviator S_s in the solid. What melts takes its elastic shear with it, S_s
 *  stays; what solidifies is free of shear, S stays. All history of the solid that is not solid any more is
 *  forgotten; what solidifies is new, and the history of the solid is its mean.
 */
class MeltingSolid {
 public:
  double share[BATCH];     ///< of the solid, now
  bool changes = false;    ///< does it change in this step?
  bool complete = true;    ///< are all points solid, now and before?
  double before[BATCH];    ///< share at the start of the step

  /** was: row with the share to which the stress belongs; molten: row of the molten fraction. */
  MeltingSolid(const Batch &b, const double *was, const double *molten)
  {
    for (int i = 0; i < b.n; i++) {
      before[i] = was[i];
      share[i] = std::max(1.0 - molten[i], 0.0);
      changes = changes || share[i] != before[i];
      complete = complete && share[i] == 1.0 && before[i] == 1.0;
    }
  }

  /** From the stress of the points before to that of their solid now, of which they have nothing that is left of
   *  a complete melt. */
  double to_solid(int i) const
  {
    return share[i] > 0.0 ? 1.0 / std::max(share[i], before[i]) : 0.0;
  }
  /** What the solid keeps of its history. */
  double kept(int i) const
  {
    return share[i] > before[i] ? before[i] / share[i] : share[i] > 0.0 ? 1.0 : 0.0;
  }
};

/** Lets the laws count their work for a share of the volume of each point, for as long as it lives. */
class ShareOfVolume {
 public:
  ShareOfVolume(Batch &batch, const double *share) : b(batch)
  {
    memcpy(vol0, b.vol0, sizeof(vol0));
    for (int i = 0; i < b.n; i++) b.vol0[i] = share[i] * vol0[i];
  }
  ~ShareOfVolume() { memcpy(b.vol0, vol0, sizeof(vol0)); }
  ShareOfVolume(const ShareOfVolume &) = delete;
  ShareOfVolume &operator=(const ShareOfVolume &) = delete;

 private:
  Batch &b;
  double vol0[BATCH];
};

}    // namespace MPM_NS
#endif
