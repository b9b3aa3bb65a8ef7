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
class MPMField;

/** The stress of level ground at rest under its weight, in equilibrium on the nodes of a field. See
 *  mpm_geostatic.cpp. */
class MPMGeostatic : protected Pointers {
 public:
  /** Where the ground is: up is the direction against gravity. */
  struct Ground {
    int axis;         ///< of gravity
    double up;        ///< 1 or -1: direction of up along this axis
    double weight;    ///< force per mass, positive
    double floor;     ///< height of the face of the box on which it stands [distance]
    double top;       ///< height of its surface [distance]
  };

  /** gravity: force per mass, along an axis of the box; errors begin with the given words, and say what to do
   *  when there is no level ground on a face of the box. Collective. */
  MPMGeostatic(class LAMMPS *, MPMField &, const double *gravity, const std::string &who);

  /** Height of a point, against gravity. */
  double height(int i) const;

  /** Gives all points of the field their effective stress, horizontal stress K0 times the vertical one; the
   *  part of the pressure in internal forces of point i is pressure(i) [pressure]. carried: what else bears the weight,
   *  for each function of the height (see function_of()) [pressure*volume], or empty. Laws must keep a stress that
   *  points have at first, or the elastic strain. Collective. */
  void set_stress(double K0, const std::function<double(int)> &pressure,
                  const std::vector<double> &carried = {});

  const Ground &ground() const { return where; }

  /** A function of the height: its number, value, slope in node spacings. */
  struct Part {
    int k;
    double value, slope;
  };
  static constexpr int BAND = 4;

  /** Those of the planes of nodes, from the lowest one that reaches the ground on, at point i of this field, or of another
   *  one on the same lattice. */
  int planes(const MPMField &, int i, Part list[BAND]) const;
  /** The function of the height that the velocity of a plane of nodes belongs to, and its value there. */
  int function_of(int plane, double &value) const;

  MPMField &field;
  const std::string who;
  Ground where;
  double floor;      // in node spacings from the origin, upwards
  int first;         // lowest plane of nodes that reaches the ground
  int nfunctions;    // functions of the height

  int parts(int i, Part list[BAND]) const;
  void find_ground(const double *gravity);
  void check_level();
  void warn_of_gap() const;
  std::vector<double> solve(std::vector<double> &matrix, std::vector<double> right) const;
  void load(const std::vector<int> &list, const FixMPMMaterial *) const;
  void strain(const std::vector<int> &list, const FixMPMMaterial *, int first) const;
  void check_laws();
};

}    // namespace LAMMPS_NS
#endif
