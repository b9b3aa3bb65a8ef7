/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_JACOBIANS_H
#define LMP_MPM_JACOBIANS_H

#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class MPMField;

/** J = det F of the points of a field, for physics that needs nothing else of F in a step. Reading
 *  all of F again, which is no longer in the cache, takes as long as a transfer; so J is stored
 *  when stress is updated and F is in the cache.
 *
 *  If J is not known, it is computed from F by the same function. So it need not migrate with
 *  points, nor be in restart files. */
class MPMJacobians {
 public:
  /** Start of a run: J is not requested yet, and not known. */
  void init() { wanted = known = false; }
  /** Requests J in this run; called by physics with points in this field. */
  void ask() { wanted = true; }

  /** Stores J of the points from first on, whose F is in the batch; the other points of the field
   *  follow. nmax: room for atoms. */
  void note(const MPM_NS::BatchKernels &kernels, const MPM_NS::Batch &batch, int first, int nmax)
  {
    if (wanted) keep(kernels, batch, first, nmax);
  }
  /** Discards J: called if points have another order or another F. */
  void forget() { known = false; }

  /** Returns J [n] of n <= BATCH points from first on. room: [n], used if J is not stored. */
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
