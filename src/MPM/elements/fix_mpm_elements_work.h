/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_FIX_MPM_ELEMENTS_WORK_H
#define LMP_FIX_MPM_ELEMENTS_WORK_H

#include "elements/fix_mpm_elements.h"
#include "material/batch_kernels.h"
#include "material/plane_stress.h"
#include "math/matrix.h"
#include "mesh/element.h"

namespace LAMMPS_NS {

/** Triangles of a quadrangle, each with the weight 1/2; the first one also stands for a
 *  triangle. */
static constexpr int SPLIT[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};

/** Normal of a triangle (in 2d: a line) whose magnitude is its area (length). at: [dim] corners. */
inline void area_vector(int dim, const double *const at[3], double *normal)
{
  double a[3], b[3];
  for (int d = 0; d < 3; d++) a[d] = at[1][d] - at[0][d];
  if (dim == 2) {
    normal[0] = a[1];
    normal[1] = -a[0];
    normal[2] = 0.0;
  } else {
    for (int d = 0; d < 3; d++) b[d] = at[2][d] - at[0][d];
    MPM_NS::cross(a, b, normal);
    for (int d = 0; d < 3; d++) normal[d] *= 0.5;
  }
}

/** A batch of integration points, and their elements. */
struct FixMPMElements::Work {
  struct Element {
    std::size_t number;
    double *row;
    const MPM_NS::ElementRule &rule;
    int start;    // first point of the element in the batch
  };
  std::vector<Element> elements;
  int n;                                                    // number of points in the batch
  double *state[MPM_NS::BATCH];                             // F, tau, history
  double g[MPM_NS::BATCH][MPM_NS::MAX_ELEMENT_NODES][3];    // gradients of the functions in space
  double volume[MPM_NS::BATCH];                             // reference volume
  double J[MPM_NS::BATCH];                                  // determinant of F without F-bar
  MPM_NS::Batch batch = {};             // must start from zero, see material/batch_kernels.h
  std::vector<double> history, mean;    // history of the batch; means over an element
  std::vector<MPM_NS::PlaneStress::Point> thin;    // [BATCH], for surfaces and lines
};

}    // namespace LAMMPS_NS
#endif
