/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_SOLIDS_H
#define LMP_MPM_FLOW_SOLIDS_H

#include "atom.h"
#include "base/mpm_rows.h"
#include "flow/mpm_flow_lattice.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class FixMPMMaterial;

/** Elastic solids in an incompressible flow: points that move with the velocity of the flow, and
 *  whose law adds a stress.
 *
 *  The pressure of the flow keeps their volume, so that their law only gives a deviator. Its forces
 *  act on the faces of the staggered lattice, and the strain follows from the same gradients of the
 *  velocity. These are constant in boxes of one spacing. Points have a width, so that nothing jumps
 *  when they pass from one box to the next (S.G. Bardenhagen, E.M. Kober, Comput. Model. Eng. Sci.
 *  5 (2004) 477). */
class MPMFlowSolids : protected Pointers {
 public:
  /** bits: of the groups of their points. */
  MPMFlowSolids(class LAMMPS *, const MPMFlowLattice &, int bits);
  ~MPMFlowSolids() override;

  /** Start of a run: finds the laws. who: name of the fix, for errors. */
  void init(const std::string &who);
  /** Stops with an error if a point of the groups has no law of an elastic solid. */
  void check_points() const;
  /** Is atom i a point of a solid? */
  bool holds(int i) const { return (atom->mask[i] & bits) && atom->vfrac[i] > 0.0; }
  /** Density of the law of point i. */
  double density_of(int i) const;

  /** Forces of the present stress at faces: [cell][dim] in force units. */
  void give_forces(std::vector<double> &forces);
  /** Volume of the points in the box of one spacing around the lower face of a cell along c. */
  double volume_around(int64_t number, int c) const
  {
    const int dim = cells.lattice.dim;
    return faces[2 * dim * number + dim + c];
  }
  /** How much of the surroundings of this face is filled: 1 where solids can give it all of their
   *  force. */
  double support_of(int64_t number, int c) const;
  /** Updates deformation and stress of the points to the end of a step of duration dt with these
   *  velocities [cell][dim]; to be called before the points move. Stops with an error if a point is
   *  turned inside out. */
  void deform(const double *velocity, double dt, double viscosity);
  /** Replaces the pressure in the stress [6] of a law by the pressure p of the flow. In 2d, where
   *  the solid is held at constant thickness, the pressure of the flow is minus the mean of the two
   *  normal stresses in the plane. */
  void set_pressure(double *stress, double p) const
  {
    const int dim = cells.lattice.dim;
    double mean = 0.0;
    for (int d = 0; d < dim; d++) mean += stress[d] / dim;
    for (int d = 0; d < 3; d++) stress[d] -= mean + p;
  }

  /** Largest stable time step for shear waves of the shortest wave length, in which neighboring
   *  nodes move against each other, over sqrt(2), to leave room for a viscosity. tag: of the point
   *  that limits it on this rank. */
  double stable_dt(tagint &tag);

  /** Calls the function with the present state of the points of a group, see
   *  visit_point_batches(). */
  void visit_batches(
      int groupbit,
      const std::function<void(const MPM_NS::Batch &, const int *, const FixMPMMaterial &)> &);

  /** Work of the deviators of stresses on the points of this rank since the last call (energy). */
  double take_work() { return std::exchange(strain_work, 0.0); }

  double memory_usage() const;

 private:
  struct Pending;

  const MPMFlowLattice &cells;
  const int bits;
  std::string who;
  std::vector<FixMPMMaterial *> materials;
  std::vector<std::unique_ptr<Pending>> pending;    // points of each material
  const MPM_NS::BatchKernels *kernels;
  std::vector<double> history;
  double strain_work = 0.0;
  std::vector<double> shares;         // [cell][kind of box][2] volume of solids and of all points
  std::vector<double> solid_share;    // [cell]
  std::vector<double> faces;          // [cell][2 dim] zeros, and volumes around faces

  int material_of(int i) const;
  template <class F> void add(int material, int i, const F &);
  template <class F> void finish(const F &);
  template <int dim> void give(std::vector<double> &forces);
  template <int dim> void strain(const double *velocity, double dt, double viscosity);
  template <int dim> void find_shares();
  /** Fluid around a point: its share in boxes of each kind, the largest of these shares, and the
   *  normal n of the solid. */
  struct Interface {
    double fluid[4], most, n[3];
  };
  template <int dim>
  bool find_interface(const MPM_NS::Grid::Block &, const double *t, double width,
                      Interface &) const;
  template <int dim>
  void leave_to_fluid(int i, const Interface &, double stiffness, double viscosity, double dt,
                      double A[3][3]) const;
  /** Air next to a point: what its boxes lack, their weight, and the share of its stress that it
   *  can hold. */
  struct Air {
    bool is_near = false;
    double missing[3][3], all[3][3], hold;
  };
  template <int dim> Air find_air(const MPM_NS::Grid::Block &, const double *t, double width) const;
  template <int dim, class F>
  void visit_gradients_in_air(const MPM_NS::Grid::Block &, const double *t, double width,
                              const Air &, int c, int d, const F &) const;
  double support_of_box(int64_t low, int64_t high, int c) const
  {
    return std::min(support_of(low, c), support_of(high, c));
  }
  /** Function of the cells of two faces: share of solid in the box of gradients along d of
   *  velocities along c between them, where these are supported. */
  template <int dim> auto weight_of(int c, int d) const
  {
    return [this, c, d](int64_t low, int64_t high) {
      constexpr int KINDS = dim == 2 ? 2 : 4;
      const int kind = c == d ? 0 : c + d;
      const double *const s = shares.data() + 2 * KINDS * (c == d ? low : high) + 2 * kind;
      return s[1] > 0.0 ? s[0] / s[1] * support_of_box(low, high, c) : 0.0;
    };
  }
  void load(int material, double dt);
  void add_half_of_work(const Pending &, double dt);
  void update_points(int material, double dt);
  void probe(int material);
  double stiffness_at_rest(int material, double dt);
};

}    // namespace LAMMPS_NS
#endif
