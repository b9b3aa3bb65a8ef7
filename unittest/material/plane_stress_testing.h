// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_PLANE_STRESS_TESTING_H
#define MPM_PLANE_STRESS_TESTING_H

#include "material/material_testing.h"
#include "material/plane_stress.h"

namespace material_testing {

using MPM_NS::BATCH;
using MPM_NS::dot;
using MPM_NS::PlaneStress;

/** A point of a body that has no thickness: a surface (along = 2) or a line (1). */
struct Surface {
  std::unique_ptr<Material> material;
  PlaneStress state;
  Batch batch = {};
  std::vector<double> history;
  PlaneStress::Point point;
  double old[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  int dim, along;

  /** a and b: directions in it, and of axes of the law. */
  Surface(const std::string &text, int dim, int along, bool compression, bool axes = false,
          const double (&a)[3] = {1.0, 0.0, 0.0}, const double (&b)[3] = {0.3, 1.0, 0.0}) :
      material(make(text)),
      state(*material, dim, along, compression, axes), dim(dim), along(along)
  {
    state.make_frame(a, b, point.frame);
    history.resize(std::max<std::size_t>(1, material->history().size()) * BATCH);
    batch.n = 1;
    batch.dt = batch.h = batch.vol0[0] = 1.0;
    batch.history = reinterpret_cast<double(*)[BATCH]>(history.data());
    point.old = old;
  }

  /** Stress after a motion with the F of the whole space; what is along the body counts. */
  Matrix go(const Matrix &F)
  {
    std::fill_n(point.along, 9, 0.0);
    for (int k = 0; k < along; k++)
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
          point.along[3 * i + j] += dot(&F[3 * i], point.frame[k]) * point.frame[k][j];
    int calls = 0;
    EXPECT_EQ(state.update(batch, &point,
                           [&](Batch &b) {
                             material->update(b);
                             calls++;
                           }),
              -1);
    EXPECT_EQ(calls, 1);
    for (int c = 0; c < 9; c++) old[c] = batch.F[c][0];
    static constexpr int voigt[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
    Matrix s;
    for (int c = 0; c < 9; c++) s[c] = batch.stress[voigt[c]][0];
    return s;
  }

  double energy()
  {
    double w[BATCH];
    material->stored_energy(batch, w);
    return w[0];
  }
};

}    // namespace material_testing

#endif
