/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GEOSTATIC_H
#define LMP_MPM_GEOSTATIC_H

#include "pointers.h"

#include <functional>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class FixMPMMixture;
class MPMField;

/** Stress of level ground at rest under its weight, in equilibrium at the nodes of a field. See
 *  mpm_geostatic.cpp. */
class MPMGeostatic : protected Pointers {
 public:
  /** Position of the ground. Up is the direction against gravity. */
  struct Ground {
    int axis;         ///< axis of gravity
    double up;        ///< 1 or -1: sign of the upward direction along this axis
    double weight;    ///< force per mass, positive
    double floor;     ///< height of the face of the box on which the ground stands [distance]
    double top;       ///< height of the surface of the ground [distance]
  };

  /** gravity: force per mass, along an axis of the box. who: first words of error messages, which
   *  say what to do if there is no level ground on a face of the box. Collective. */
  MPMGeostatic(class LAMMPS *, MPMField &, const double *gravity, const std::string &who);

  /** Height of a point, measured against gravity. */
  double height(int i) const;

  /** Sets the effective stress of all points of the field, with a horizontal stress of K0 times the
   *  vertical one. pressure(i): part of the pressure in internal forces of point i [pressure].
   *  carried: weight that something else carries, for each function of the height (see
   *  function_of()) [pressure*volume], or empty. Material laws must keep a stress that points have
   *  initially, or the elastic strain. Collective. */
  void set_stress(double K0, const std::function<double(int)> &pressure,
                  const std::vector<double> &carried = {});

  const Ground &ground() const { return where; }

  /** A function of the height at a point: its number, value, and slope per node spacing. */
  struct Part {
    int k;
    double value, slope;
  };
  static constexpr int BAND = 4;

  /** Shape functions of the planes of nodes at point i of this field, or of another field on the
   *  same lattice. Planes are numbered from the lowest one that reaches the ground. Returns the
   *  number of planes. */
  int planes(const MPMField &, int i, Part list[BAND]) const;
  /** The function of the height that describes the velocity of a plane of nodes, and its value
   *  there. */
  int function_of(int plane, double &value) const;

  MPMField &field;
  const std::string who;
  Ground where;
  double floor;      // height in node spacings from the origin, upwards
  int first;         // lowest plane of nodes that reaches the ground
  int nfunctions;    // number of functions of the height

  bool is_ground(int i) const;
  int parts(int i, Part list[BAND]) const;
  void find_ground(const double *gravity);
  void check_level();
  void warn_of_gap() const;
  std::vector<double> solve(std::vector<double> &matrix, std::vector<double> right) const;
  void load(const std::vector<int> &list, const FixMPMMaterial *) const;
  void strain(const std::vector<int> &list, const FixMPMMaterial *, int first) const;
  void check_laws();
};

/** Water at rest in level ground and above it, where the water is a separate field (fix
 *  mpm/mixture). See mpm_geostatic_command.cpp. */
class MPMGeostaticWater : protected Pointers {
 public:
  /** ground: the soil of the mixture. who: first words of error messages. */
  MPMGeostaticWater(class LAMMPS *, const MPMGeostatic &ground, const FixMPMMixture &,
                    const std::string &who);

  /** Sets the pressure of all points of the water by changing their volume. Returns the weight of
   *  the soil that the water carries, for each function of the height (MPMGeostatic::set_stress()).
   *  Collective. */
  std::vector<double> set_pressure();

 private:
  const MPMGeostatic &ground;
  const FixMPMMixture &mixture;
  MPMField &soil, &water;
  const std::string who;
  double surface, density;
  int nplanes = 0;

  void find_water();
  void find_volumes(std::vector<double> &volumes) const;
  double strain(const std::vector<double> &pressure) const;
  /** Stops with an error if the water does not come to rest. differs: from the pressure of its law;
   *  left: share of its weight that is not carried. */
  void check_rest(const std::vector<double> &pressure, double differs, double left) const;
};

}    // namespace LAMMPS_NS
#endif
