/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_SINK_H
#define LMP_MPM_HEAT_SINK_H

#include <cstddef>

namespace LAMMPS_NS {
class MPMField;

/** Takes up heat that is made at nodes and conducts it into the material. Implemented by a fix. */
class MPMHeatSink {
 public:
  /** Does any material of this field conduct heat? */
  virtual bool conducts(const MPMField &) const = 0;
  /** Adds heat of friction [energy] at a node of a field that conducts. counts: it counts on this
   *  rank; all ranks that have the node add the same heat. */
  virtual void give(const MPMField &, std::size_t node, double heat, bool counts) = 0;

 protected:
  ~MPMHeatSink() = default;    // owned and deleted as a Fix
};

}    // namespace LAMMPS_NS
#endif
