/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FORCES_H
#define LMP_MPM_FORCES_H

#include <cstdint>
#include <functional>
#include <vector>

// What physics adds to the forces and to the strain of points. A fix derives from those of these
// classes that it needs, in addition to MPMPhysics; fix mpm finds it at the start of each run.

namespace MPM_NS {
struct PointRows;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class MPMField;
class MPMNodePressure;
class MPMTrialForces;

/** Stress in addition to that of points, as a load on them: its work counts as external. */
class MPMAddedStress {
 public:
  /** Has any of the points [first,last) such a stress? */
  virtual bool adds_stress(const MPMField &, int first, int last) const = 0;
  /** Adds the Kirchhoff stress of n points from first on, tau: [n][6], xx yy zz xy xz yz. */
  virtual void add_stress(const MPMField &, int first, int n, double *tau) const = 0;

 protected:
  ~MPMAddedStress() = default;    // owned and deleted as a Fix
};

/** Physics that only applies loads to points, by forces (atom->f), by MPMAddedStress, and, where
 *  loads depend on the deformation, by the functions below. It can be used with steps of any
 *  kind. */
class MPMLoad {
 public:
  /** Loads that depend on the deformation of a point, for a solver that looks for the state at the
   *  end of a step. follows(): has any of the points [first,last) such a load? follow(): for n
   *  points from first on with the deformation gradients F [n][9], row-major, add the change of
   *  their forces relative to those in atom->f, force: [n][3], and of the stress of add_stress(),
   *  tau: [n][6]. */
  virtual bool follows(const MPMField &, int /*first*/, int /*last*/) const { return false; }
  virtual void follow(const MPMField &, int /*first*/, int /*n*/, const double * /*F*/,
                      double * /*force*/, double * /*tau*/) const
  {
  }

  /** Loads that depend on the positions of all points of a surface, and are in atom->f, too; null
   *  where a field has none. */
  virtual MPMTrialForces *trial_forces(const MPMField &) { return nullptr; }

 protected:
  ~MPMLoad() = default;    // owned and deleted as a Fix
};

/** Pressure of the water in pores. The stress that points keep is then the effective stress. An
 *  implicit step solves for this pressure together with the motion, which is all that this physics
 *  does in such steps. */
class MPMPorePressure {
 public:
  /** [n] J times the pressure, which acts in the internal forces in addition to the stress of the
   *  points; null: the field has no water. */
  virtual const double *pressure_in_forces(const MPMField &) const = 0;
  /** The pressure at nodes for an implicit step; null: the field has no water. */
  virtual MPMNodePressure *node_pressure(const MPMField &) = 0;

  /** The part of the forces on walls that the contact of points does not bear: force[node][3] is
   *  the integral of N p n over the surface of the body [mass acceleration], with n outward. It is
   *  found at the nodes of the blocks marked in near (and may be found at others). Returns false,
   *  and leaves force unchanged, if the field has no water. Collective; call after the momentum
   *  equation. */
  virtual bool surface_force(MPMField &, const std::vector<char> &near,
                             std::vector<double> &force) const = 0;
  /** Forces on nodes [node][3] in the layer below a surface: those of the water, and all. near: as
   *  in surface_force(). */
  virtual void find_forces_below_surface(const MPMField &, const std::vector<char> &near,
                                         std::vector<double> &of_water,
                                         std::vector<double> &of_all) const = 0;

 protected:
  ~MPMPorePressure() = default;    // owned and deleted as a Fix
};

/** Points whose strain rate differs from the motion of the nodes around them. Its init_physics()
 *  adds it to MPMField::stretching. */
class MPMStretch {
 public:
  /** Has any of n points from first on a rate of its own? */
  virtual bool stretches(int first, int n) const = 0;
  /** Changes the velocity gradients L of these points in a step of duration dt, [n][dim*dim],
   *  column-major. */
  virtual void stretch_gradients(MPMField &, int first, int n, double dt, double *L) = 0;

 protected:
  ~MPMStretch() = default;    // owned and deleted as a Fix
};

/** J times the pressure of the water of a field, for each point, or null. */
const double *pore_pressure(const MPMField &);
/** Does any physics add a stress to the points [first,last)? */
bool has_added_stress(const MPMField &, int first, int last);
/** Adds the stress of all physics, see MPMAddedStress. */
void add_stress(const MPMField &, int first, int n, double *tau);
/** See MPMPorePressure::surface_force(); false: the field has no water. */
bool pore_surface_force(MPMField &, const std::vector<char> &near, std::vector<double> &force);
/** Subtracts a pressure from the stress of n <= BATCH rows from point first on; work: space of
 *  [6*n]. */
void subtract_pressure(const double *pressure, MPM_NS::PointRows &, int first, int n, double *work);

/** Pressure of nodes, such as that of pore water, which an implicit step finds together with the
 *  motion. Forces contain its value at the end of the step, and what fills the volume of points is
 *  tied to their volume at that time. With the values p [node],
 *      C (p - p_start) = - sum_p a_p dV_p N_ip + dt (what flows to the node with p)
 *  where dV_p is the change of the volume of a point in the step, and a_p the share of the pressure
 *  that enters its forces. All terms are volumes. Vectors [node] are the same on all ranks that
 *  have a node, and at periodic images. */
class MPMNodePressure {
 public:
  /** Adds a term to a matrix of these equations, see MPMDiffusion::Term. */
  using Term = std::function<void(int n, const int64_t *nodes, int ngrad, const double *gradient,
                                  const double *stiffness)>;

  /** Begins an implicit step, with the positions of points and the values p_start of its start.
   *  inertial: the motion has inertia. Collective. */
  virtual void begin_solve(double dt, bool inertial) = 0;
  /** [node] p_start. */
  virtual const std::vector<double> &values_at_start() const = 0;
  /** [node] C; nodes with C = 0 have no pressure. */
  virtual const std::vector<double> &capacities() const = 0;
  /** Sets of_points [n] to a_p times the pressure at each point; 0 for points without pressure.
   *  Collective. */
  virtual void to_points(const std::vector<double> &p, double *of_points) = 0;
  /** Finds the residual r: right minus left side with the changes of volume dV [n]. Returns the sum
   *  of the magnitudes of all volumes in it on this rank. Collective. */
  virtual double find_residual(const std::vector<double> &p, const double *dV, double *r) = 0;
  /** Size of the residual on this rank for nodal pressures that vary at random by one unit. */
  virtual double response() const = 0;
  /** Finds y: left minus right side for small changes of the pressure and, unless null, of volumes,
   *  around the values of the last residual. Collective. */
  virtual void find_changes(const double *p, const double *dV, double *y) = 0;
  /** For a preconditioner: the volume dV [n] by which a point of soil with these moduli [n]
   *  (pressure) changes per unit of the pressure in its forces, if it cannot widen; 0 for points
   *  without pressure. */
  virtual void find_softness(const std::vector<double> &moduli, std::vector<double> &softness) = 0;
  /** For a preconditioner, too: symmetric terms of the matrix of find_changes() without C, with the
   *  changes of volume of find_softness(). */
  virtual void each_term(const std::vector<double> &softness, const Term &) = 0;
  /** Ends the step with the values p at its end. */
  virtual void end_solve(const std::vector<double> &p) = 0;

 protected:
  ~MPMNodePressure() = default;    // owned and deleted as something else
};

}    // namespace LAMMPS_NS
#endif
