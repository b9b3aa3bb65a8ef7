/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REFINED_BODY_H
#define LMP_MPM_REFINED_BODY_H

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** One body whose points are in several fields, each with half the node spacing of the previous
 *  one. Implemented by a fix. Fields are named by the IDs of their fixes mpm. */
class MPMRefinedBody {
 public:
  /** Is the field part of the body? */
  virtual bool has(const std::string &name) const = 0;
  /** Fields of this body that are finer than this one; empty if that is not part of the body. */
  virtual std::vector<MPMField *> finer_than(const std::string &name) const = 0;
  /** Activates the blocks of this field that the finer fields of the body need; also called before
   *  others use its blocks. */
  virtual void extend_for_finer(const MPMField &) const = 0;

 protected:
  ~MPMRefinedBody() = default;    // owned and deleted as a Fix
};

}    // namespace LAMMPS_NS
#endif
