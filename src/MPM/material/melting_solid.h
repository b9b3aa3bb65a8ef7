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

/** The solid part of points that melt and solidify. It fills the fraction s of their volume and
 *  bears the whole deviator S = s S_s of their stress, where S_s is the deviator in the solid.
 *  Melting removes the elastic shear of the molten part and leaves S_s unchanged. Newly formed
 *  solid is free of shear, which leaves S unchanged. The history of solid that melts is lost; newly
 *  formed solid has a new history, and the point keeps the mean over its solid.
 */
class MeltingSolid {
 public:
  double share[BATCH];     ///< volume fraction of the solid now
  bool changes = false;    ///< does the fraction of any point change in this step?
  bool complete = true;    ///< are all points completely solid, before and now?
  double before[BATCH];    ///< volume fraction of the solid at the start of the step

  /** was: row with the solid fraction to which the stress belongs; molten: row with the molten
   *  fraction. */
  MeltingSolid(const Batch &b, const double *was, const double *molten)
  {
    for (int i = 0; i < b.n; i++) {
      before[i] = was[i];
      share[i] = std::max(1.0 - molten[i], 0.0);
      changes = changes || share[i] != before[i];
      complete = complete && share[i] == 1.0 && before[i] == 1.0;
    }
  }

  /** Factor from the stress deviator of the point at the start of the step to that of its solid
   *  now; 0 if the point is completely molten. */
  double to_solid(int i) const
  {
    return share[i] > 0.0 ? 1.0 / std::max(share[i], before[i]) : 0.0;
  }
  /** Fraction of its history that the solid keeps. */
  double kept(int i) const
  {
    return share[i] > before[i] ? before[i] / share[i] : share[i] > 0.0 ? 1.0 : 0.0;
  }
};

/** While this object exists, the laws count their work only for a fraction of the volume of each
 *  point. */
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
