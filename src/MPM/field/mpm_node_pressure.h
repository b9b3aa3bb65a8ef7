/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_PRESSURE_H
#define LMP_MPM_NODE_PRESSURE_H

#include <cstdint>
#include <functional>
#include <vector>

namespace LAMMPS_NS {

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
