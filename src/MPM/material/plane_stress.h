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

/** Plane stress for surfaces in space (membranes), and its equivalent for lines in the plane or in
 *  space (strips, cables): a material in a state in which no stress acts across the body. Only the
 *  motion along the body is known. The stretch across it is found by iteration on the update of the
 *  material. A surface has one such stretch; a line in space has the same stretch along both axes
 *  across it.
 *
 *  Without resistance to compression, this is tension-field theory: a surface under tension along
 *  one axis only wrinkles across that axis, and is in the state of uniaxial tension, whose width is
 *  not less than that of the surface (A.C. Pipkin, IMA J. Appl. Math. 36 (1986) 85). A body that is
 *  shortened along all axes is slack and free of stress.
 *
 *  The material must be isotropic. Without resistance to compression it must also be elastic, have
 *  no history variables, and be free of stress when undeformed. Surfaces in 3d that resist
 *  compression can also use an anisotropic material with axes x y z: x and y are then the two axes
 *  of Point::frame along the surface, and the plane of the surface must be a plane of symmetry of
 *  the material. */
class PlaneStress {
 public:
  struct Point {
    /** Orthonormal axes in the reference configuration: first those along the body, then those
     *  across it; in 2d, z is last. */
    double frame[3][3];
    /** Deformation gradient of the motion along the body: F frame[i] for the axes along it, zero
     *  for the others. */
    double along[9];
    /** [9] deformation gradient at the start of the step, as found by this class. */
    const double *old;
  };

  /** dim: dimension of space; along: dimension of the body; compression: does the body resist
   *  compression? axes: does the material have the axes of the frame? Throws std::runtime_error if
   *  the material is not as described above. */
  PlaneStress(const Material &, int dim, int along, bool compression, bool axes = false);

  /** One step of a batch. On input it has n, dt, h, time, vol0, the history and stress at the start
   *  of the step, and A, F, and J that are zero in unused places. Sets A, F, J, and Jold to the
   *  state found, and then calls last once to do the update. Returns -1, or the index of a point
   *  for which no state was found. */
  int update(Batch &, const Point *, const std::function<void(Batch &)> &last);

  /** c[n]: speed of the fastest wave along the body in the present state, increased for viscosity
   *  as by Material::wave_speed(). Batch: as there. motion[n][9]: Point::along of the state.
   *  Elastic materials have their own tangent, where they have one; the speed of others, whose
   *  elastic strains are small, is that in the material times the ratio of the two at rest. */
  void wave_speed(const Batch &, const double *const *motion, double *c) const;

  /** Young's modulus and Poisson's ratio at rest. Throws std::runtime_error if the material is not
   *  isotropic and elastic. */
  std::array<double, 2> elastic_constants() const;

  /** Turns F[9] (row-major) from the reference configuration to the axes of the frame, as seen by a
   *  material with axes. Does nothing for other materials. */
  void turn_to_material(const Point &, double *F) const;

  /** Makes orthonormal axes for Point::frame from the directions a and, for surfaces, b along the
   *  body. */
  void make_frame(const double *a, const double *b, double (*frame)[3]) const;

 private:
  const Material &material;
  const int dim, along;
  const bool compression, axes;

  /** F = fixed + stretch * across. */
  struct State {
    double fixed[9], across[9], stretch;
    double lambda[2], n[3][3],
        N[3][3];    // principal stretches along the body; axes now and at first
    int first;      // first of the axes with the unknown stretch
    bool done;
  };
  State state[BATCH];
  double start[6][BATCH];
  std::vector<double> history;
  double stiffness = 0.0;        // stiffness of the material in small compression
  double share_at_rest = 1.0;    // modulus of waves along the body over that in the material
  bool springs_back = false;     // is it elastic in large strains?

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
  void find_speed();
  void find_directions(const double *motion, double (*axis)[3]) const;
  double largest_share(const Tangent &, const Batch &, int p, const double *motion) const;
};

}    // namespace MPM_NS
#endif
