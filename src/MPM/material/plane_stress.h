/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_PLANE_STRESS_H
#define MPM_MATERIAL_PLANE_STRESS_H

#include "material/material.h"

#include <array>
#include <functional>

namespace MPM_NS {

/** Surfaces in space (membranes) and lines in the plane or in space (strips, cables): what they do is that of a material, in a
 *  state in which no stress acts across them. Only the motion along them is known; the stretch across is found by
 *  iteration on the update of the material, for surfaces one, for lines in space the same along both axes.
 *
 *  Without compression, this is tension-field theory: a surface under tension along one axis only wrinkles across it, and is in the
 *  state of uniaxial tension whose width is not less than that of the surface (A.C. Pipkin, IMA J. Appl. Math. 36 (1986)
 *  85); what is shortened along all axes is slack, and free of stress.
 *
 *  The material must be isotropic; without compression also elastic, without history variables, and free of stress when
 *  undeformed. Surfaces that resist compression can also be of a material with axes: of its own axes x y z, the first two are then those
 *  of Point::frame along the surface, whose plane must be one of its planes of symmetry. */
class PlaneStress {
 public:
  struct Point {
    double frame
        [3]
        [3];    ///< orthonormal, in the reference configuration: axes along, then those across; in 2d z is last
    double along
        [9];    ///< deformation gradient of the motion along: F frame[i] of axes along, no others
    const double
        *old;    ///< [9] deformation gradient at the start of the step, as this class has found it
  };

  /** dim: of space; along: of the body; axes: has the material the axes of the frame? Throws std::runtime_error when the
   *  material is none of those above. */
  PlaneStress(const Material &, int dim, int along, bool compression, bool axes = false);

  /** The step of a batch, with n, dt, h, time, vol0, and history and stress of the start of the step, and A, F, and J that
   *  are zero where the law does not use them. Sets A, F, J, Jold, and leaves the rest to last, which is called once, in the
   *  state that was found. Returns the index of a point for which none was found, or -1. */
  int update(Batch &, const Point *, const std::function<void(Batch &)> &last);

  /** Young's modulus and Poisson's ratio at rest. Throws std::runtime_error when the material is not elastic, see above. */
  std::array<double, 2> elastic_constants() const;

  /** F [9], row-major, of a motion from the axes of the frame, as a material with axes sees it; others leave it as it is. */
  void turn_to_material(const Point &, double *F) const;

  /** Orthonormal axes for Point::frame from gradients along the body: directions a and, for surfaces, b. */
  void make_frame(const double *a, const double *b, double (*frame)[3]) const;

 private:
  const Material &material;
  const int dim, along;
  const bool compression, axes;

  /** F = fixed + stretch * across. */
  struct State {
    double fixed[9], across[9], stretch;
    double lambda[2], n[3][3], N[3][3];    // principal stretches along, axes as in Point::frame
    int first;                             // of the axes that have the stretch
    bool done;
  };
  State state[BATCH];
  double start[6][BATCH];
  std::vector<double> history;
  double stiffness = 0.0;    // of the material in small compression

  int last_axis() const { return dim == 2 ? 2 : 3; }
  void find_axes(const Point &, State &) const;
  void divide(State &, int first) const;
  void keep(const Batch &);
  void move(Batch &, const Point *);
  void stress_across(Batch &, const Point *, double *s);
  int iterate(Batch &, const Point *);
  int solve(Batch &, const Point *);
  void check_symmetry();
  void check_elasticity() const;
};

}    // namespace MPM_NS
#endif
