/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CROSSING_H
#define LMP_MPM_CROSSING_H

#include "field/node_line.h"
#include "walls/mpm_wall_contact.h"

#include <cstdint>

namespace LAMMPS_NS {

/** A line of nodes from the inside of a region through its surface to the outside. */
struct MPMCrossing : NodeLine {
  /** SOUND: always acts; THIN_PLACE (another face is near): acts unless the material is behind;
   *  NEAR_OTHERS (nodes of the line are nearer to another face, or beyond it): acts only if the
   *  material is in front. */
  enum Front { SOUND, THIN_PLACE, NEAR_OTHERS };

  int64_t base;        ///< node of the line from which the line was found
  int64_t behind;      ///< next node in the region, which only material inside reaches
  double surface;      ///< position of the surface on the axis
  double normal[3];    ///< of the surface at the crossing
  int contact;         ///< index of MPMCrossingLines::contact()
  int inside;          ///< number of nodes behind the surface, which come first
  int place;           ///< coordinate of the first node on the line, growing outward
  double depth;        ///< depth of the first node behind the surface [node spacings]
  MPMContactState state = MPMContactState::OPEN;
  bool touched = true;    ///< the surface of the material touches it in this step
  Front front = SOUND;
  bool acts = true;
  bool in_plate = false;    ///< in a plate thinner than what nodes resolve
  bool alone = false;       ///< grips: shares no node with another line
  bool coupled = false;     ///< acts together with others, see MPMCoupledLines

  // where is the material, judged by the masses of nodes?

  /** Is it in front of the surface alone? */
  bool is_in_front(MPM_NS::Grid &) const;
  /** Is the mass of nodes in front at most this share of that of nodes behind? */
  bool is_behind(MPM_NS::Grid &, double share) const;
  /** Is there material in the region, about a spacing below the surface or deeper? */
  bool has_material_inside(MPM_NS::Grid &) const;
  /** Is there material on both sides of the surface, and can the line hold it? */
  bool goes_through(MPM_NS::Grid &) const;
};

}    // namespace LAMMPS_NS

#endif
