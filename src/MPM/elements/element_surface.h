/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_ELEMENT_SURFACE_H
#define LMP_ELEMENT_SURFACE_H

#include "mesh/element_body.h"
#include "mesh/gmsh.h"
#include "pointers.h"

namespace LAMMPS_NS {

/** Interface for the pressure on one side of a surface of elements. */
class MPMElementsPressure {
 public:
  /** Pressure for the enclosed volume (0: not closed) and the area of the surface. Collective, in
   *  each step. starting: at the setup of a run. */
  virtual double on_surface(double volume, double area, bool starting) = 0;
  /** Is the pressure independent of volume and area? */
  virtual bool is_given() const = 0;
  /** Decrease of the pressure with the volume, -dp/dV, at this volume. */
  virtual double stiffness(double volume) const = 0;

 protected:
  ~MPMElementsPressure() = default;    // not deleted through this interface
};

/** The surface that the elements of a body form, and the pressure on one side of it. Positions of
 *  nodes are the present ones, without jumps at periodic faces. */
class ElementSurface : protected Pointers {
 public:
  ElementSurface(LAMMPS *, const MPM_NS::ElementBody &, const MPM_NS::SurfaceKind &);

  const MPM_NS::SurfaceKind kind;
  MPMElementsPressure *pressure = nullptr;    ///< null: none
  /** Work that the pressure in a closed surface has done so far. */
  double work = 0.0;

  /** Sets the pressure. Stops with an error of the fix with this ID if the surface has no sides, or
   *  if it must enclose a volume and does not. */
  void set_pressure(MPMElementsPressure *, bool closed, const std::string &id);

  /** Largest distance of a place on the surface or line from the nodes around it, over all ranks.
   *  Collective. */
  double widest_gap() const;

  /** Adds the forces of the pressure to the last three of the sums [local and ghost][width] of
   *  nodes. Collective. */
  void add_pressure(bool starting, double *sums, int width);
  /** Adds, times a sign, the pressure of this step on the surface after the displacements motion
   *  [local and ghost][3] (null: none) to forces of nodes [local and ghost][3]. */
  void add_pressure_after(const double *motion, double sign, double *to) const;
  /** Adds the derivative of the pressure on each element [maxnode dim][maxnode dim] after a motion.
   *  size_of_element: length of the smallest one. */
  void differentiate_pressure(const double *motion, double size_of_element, double *tangents) const;

  /** Has it a gas in it, which resists changes of volume? */
  bool has_gas() const { return pressure && kind.closed && !pressure->is_given(); }
  /** Enclosed volume, of the faces of this rank, and its gradient, which is added to that of nodes
   *  [local and ghost][3]. */
  double volume_gradient(double *gradient) const;
  /** Frequency of the gas with these, of points of the group. The pressure of this step may not be
   *  known yet. Collective. */
  double gas_frequency(double volume, const double *gradient, int groupbit) const;

 private:
  const int dim;
  const MPM_NS::ElementBody &body;
  /** 1: the pressure pushes toward the side from which elements go around counterclockwise; -1:
   *  away from it; 0: unknown. */
  double side = 0.0;
  double volume_before = 0.0, pressure_before = 0.0;    // of a closed surface

  template <class Visit> void for_faces(Visit) const;
  template <class Visit> void for_moved_faces(const double *motion, const Visit &visit) const;
};

}    // namespace LAMMPS_NS
#endif
