/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_JACOBIANS_H
#define LMP_MPM_JACOBIANS_H

#include <cstddef>
#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class MPMField;

/** J = det F of the points of a field, for physics that needs no more of F in a step: to read all of F again, which is not
 *  in the cache any more, takes as long as a transfer. Where stress is updated, F is in the cache, and J is kept.
 *
 *  J is found from F, by the same function, whenever it is not known: it need not migrate, nor be in restart files. */
class MPMJacobians {
 public:
  /** Start of a run: nobody has asked yet, and nothing is known. */
  void init() { wanted = known = false; }
  /** They are wanted in this run, by who has points in this field. */
  void ask() { wanted = true; }

  /** Points from first on have the F of the batch now, and all others of the field are next. nmax: room for atoms. */
  void note(const MPM_NS::BatchKernels &kernels, const MPM_NS::Batch &batch, int first, int nmax)
  {
    if (wanted) keep(kernels, batch, first, nmax);
  }
  /** Points are in another order, or have another F. */
  void forget() { known = false; }

  /** [n] of n <= BATCH points from first on; room: [n]. */
  const double *get(const MPMField &field, int first, int n, double *room) const
  {
    if (known) return J.data() + first;
    find(field, first, n, room);
    return room;
  }

  double memory_usage() const { return J.capacity() * sizeof(double); }

 private:
  std::vector<double> J;
  bool wanted = false, known = false;

  void keep(const MPM_NS::BatchKernels &, const MPM_NS::Batch &, int first, int nmax);
  static void find(const MPMField &, int first, int n, double *J);
};

}    // namespace LAMMPS_NS
#endif
