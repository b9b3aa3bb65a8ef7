/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SMOOTHING_H
#define LMP_MPM_SMOOTHING_H

#include "field/mpm_field.h"
#include "field/mpm_point_map.h"
#include "transfer/smoothing.h"

#include <array>

namespace LAMMPS_NS {

/** Removes from the volumes of points of fluids, and so from their pressures, the part that the
 *  nodes do not see. */
class MPMSmoothing : protected Pointers {
 public:
  MPMSmoothing(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run. Stops with an error if there is no fluid. */
  void init();
  /** After node actions, before points move. Smooths each fluid once in the time in which sound
   *  crosses one or two cells. */
  void smooth();
  /** In this step, contact binds this node of the field to another body. */
  void bind(int64_t node) { contacts.push_back(node); }

  /** Energy that volumes got so far in this run, where fits reach bound nodes [energy], this rank's
   *  share: there, and nowhere else, smoothing can add some. */
  double energy_given() const { return given; }

  double memory_usage() const
  {
    return (sums.capacity() + 2 * q.capacity() + bound.capacity() + weights.capacity()) *
        sizeof(double) +
        contacts.capacity() * sizeof(int64_t);
  }

 private:
  MPMField &field;
  MPM_NS::SmoothingKernels kernels = {};
  std::vector<double> sums;       // [node][fit_width()]
  std::vector<double> q, mean;    // of points: J - 1, and its mean from the fits around their nodes
  std::vector<int64_t> contacts;    // nodes that contact binds in this step
  std::vector<double> bound;        // [node] positive: moves with a body that is no liquid
  double given = 0.0;
  std::vector<double> weights;              // [n] volumes that count in the fits
  bool meets_bodies = false;                // can there be bound nodes?
  std::vector<double> tile, fits;           // of a run of points: sums, and fits
  std::vector<std::array<int, 6>> boxes;    // of runs of points, in their tiles

  double time_to_cross(const FixMPMMaterial &) const;
  void find_bound_nodes();
  const double *weigh_points(const FixMPMMaterial *);
  template <int DIM> void smooth(const FixMPMMaterial *, double share);
  template <int DIM> void add_points(const FixMPMMaterial *);
  template <int DIM> void fit_nodes();
  template <int DIM> void evaluate_fits(const MPMPointMap::Run &, const int *box);
  template <int DIM> void change_volumes(const MPMPointMap::Run &, double share);
};

}    // namespace LAMMPS_NS
#endif
