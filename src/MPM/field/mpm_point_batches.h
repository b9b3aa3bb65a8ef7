/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_BATCHES_H
#define LMP_MPM_POINT_BATCHES_H

#include <functional>

namespace MPM_NS {
struct Batch;
}

namespace LAMMPS_NS {
class FixMPMMaterial;
class MPMField;

/** Loads the present state of the n <= BATCH points in list, all of one material, into a batch. It
 *  serves for wave speed and stored energy. */
void load_state(MPMField &, MPM_NS::Batch &, const int *list, int n, const FixMPMMaterial *);

/** Function that processes a batch of points. Arguments: state of the points, their local indices,
 *  and their material. */
using BatchVisitor =
    std::function<void(const MPM_NS::Batch &, const int *, const FixMPMMaterial &)>;

/** A fix other than fix mpm that has material points. */
class MPMPointOwner {
 public:
  /** Visits the present state of its points in a group, see visit_point_batches(). Also valid
   *  between runs. */
  virtual void visit_batches(int groupbit, const BatchVisitor &) = 0;

 protected:
  ~MPMPointOwner() = default;    // owned and deleted as a Fix
};

/** Calls a visitor with the present state of all material points of a group that belong to a fix
 *  mpm or another MPMPointOwner. Each batch has points of one of these and of one material. For
 *  output, also between runs: it does not change the points. Points without material are an
 *  error. */
void visit_point_batches(class LAMMPS *, int groupbit, const BatchVisitor &);

}    // namespace LAMMPS_NS
#endif
