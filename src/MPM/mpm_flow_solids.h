/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_SOLIDS_H
#define LMP_MPM_FLOW_SOLIDS_H

#include "atom.h"
#include "mpm_flow_lattice.h"
#include "mpm_rows.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class FixMPMMaterial;

/** Elastic solids in an incompressible flow: points whose velocity is that of the flow, and whose law adds a stress to it.
 *
 *  The pressure of the flow keeps their volume, so that their law gives a deviator only. Its forces act on the faces of the
 *  staggered lattice, and the strain follows from the same gradients of the velocity. These are constant in boxes of one
 *  spacing, and points have a width, so that there is no jump where they pass from one to the next (S.G. Bardenhagen, E.M.
 *  Kober, Comput. Model. Eng. Sci. 5 (2004) 477). */
class MPMFlowSolids : protected Pointers {
 public:
  /** bits: groups of their points */
  MPMFlowSolids(class LAMMPS *, const MPMFlowLattice &, int bits);
  ~MPMFlowSolids() override;

  /** Finds the laws. who: the fix, for errors. */
  void init(const std::string &who);
  /** All points of the groups must have a law that gives an elastic solid. */
  void check_points() const;
  bool holds(int i) const { return (atom->mask[i] & bits) && atom->vfrac[i] > 0.0; }
  double density_of(int i) const;

  /** forces: [cell][dim] force units at faces, of the present stress. */
  void give_forces(std::vector<double> &forces);
  /** Deformation and stress of the points at the end of a step of duration dt with these velocities, before they move. */
  void deform(const double *velocity, double dt, double viscosity);
  /** The stress of a law with the pressure of the flow instead of its own. In 2d, where the solid is held at constant
   *  thickness, the pressure of the flow is the mean of the two stresses in the plane. */
  void set_pressure(double *stress, double p) const
  {
    const int dim = cells.lattice.dim;
    double mean = 0.0;
    for (int d = 0; d < dim; d++) mean += stress[d] / dim;
    for (int d = 0; d < 3; d++) stress[d] -= mean + p;
  }

  /** Largest stable step of waves of shear, in which nodes next to each other move against each other, over sqrt(2): that leaves
   *  room for a viscosity. tag: of the point. */
  double stable_dt(tagint &tag);

  /** Hands over the present state of the points of a group, see visit_point_batches(). */
  void visit_batches(
      int groupbit,
      const std::function<void(const MPM_NS::Batch &, const int *, const FixMPMMaterial &)> &);

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
  std::vector<double> shares;         // [cell][kind of box][2] volume of solids and of all points
  std::vector<double> solid_share;    // [cell]

  int material_of(int i) const;
  template <int dim> void give(std::vector<double> &forces);
  template <int dim> void strain(const double *velocity, double dt, double viscosity);
  template <int dim> void find_shares();
  /** What a point sees of fluid: the share in boxes of each kind and the largest, and the normal of the solid. */
  struct Interface {
    double fluid[4], most, n[3];
  };
  template <int dim>
  bool find_interface(const MPM_NS::Grid::Block &, const double *t, double width,
                      Interface &) const;
  template <int dim>
  void leave_to_fluid(int i, const Interface &, double stiffness, double viscosity, double dt,
                      double A[3][3]) const;
  /** Share of solid of boxes of gradients along d of velocities along c. */
  template <int dim> auto weight_of(int c, int d) const
  {
    return [this, kind = c == d ? 0 : c + d](int64_t number) {
      constexpr int KINDS = dim == 2 ? 2 : 4;
      const double *const s = shares.data() + 2 * KINDS * number + 2 * kind;
      return s[1] > 0.0 ? s[0] / s[1] : 0.0;
    };
  }
  void load(int material, double dt);
  void update_points(int material, double dt);
  void probe(int material);
  double stiffness_at_rest(int material, double dt);
};

}    // namespace LAMMPS_NS
#endif
