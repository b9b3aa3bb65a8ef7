/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_DOUBTS_H
#define LMP_MPM_DOUBTS_H

#include "pointers.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace MPM_NS {
class Material;
}

namespace LAMMPS_NS {

/** What an input may say, but hardly means. All such doubts are in one table: each is a ratio of
 *  two numbers of the input, with the range that is doubtful, as ranges of single numbers depend on
 *  units and scales. A fix that has the numbers has an object of this class, and gives a warning of
 *  each kind once. */
class MPMDoubts : protected Pointers {
 public:
  enum Kind {
    SOFT_WATER,       ///< bulk modulus of pore water over the stiffness of the skeleton
    LIGHT_SOIL,       ///< density of a saturated soil over that of the water in it
    HEAVY_GRAINS,     ///< density of grains over that of water
    NO_FLOW,          ///< way of pore water in the run over the node spacing, squared
    TIME_STEP,        ///< the time step over the default one of the units
    FACE_ALONE,       ///< least distance of material from a face with a condition, in node spacings
    INSIDE_REGION,    ///< material that is deep in a region with a condition, in points
    COLD,             ///< temperature of a body that radiates over that of ice that melts
    COLD_METAL,       ///< temperature over the reference temperature of a strength
    MOLTEN,           ///< temperature over the melting temperature of a strength
    MOLTEN_WALL,      ///< temperature of a wall over this melting temperature
    SOFT_BODY,        ///< modulus of a solid or liquid at rest over the pressure of its own weight
    REGION_ALONE,     ///< 1: no material is near the surface of a region with a condition
    BEGINS_INSIDE,    ///< depth of points in a wall or rigid body at the start, in node spacings
    WEIGHTLESS,       ///< 1: there is a weight, but a rigid body has none
    WATER_WEIGHT,     ///< 1: the weight of pore water is its density, gravity, or 1000 times wrong
    FREE_FLOW,        ///< time in which pore water follows its soil over that of waves across it
    GAS_ALONE         ///< 1: nothing is there that could hold a gas
  };

  explicit MPMDoubts(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Warns, unless it has before, if this ratio is doubtful. who: the start of the message; what:
   *  the two numbers. The same on all ranks. */
  void check(Kind, double ratio, const std::string &who, const std::string &what);
  /** Warns of a time step that no command has set, of a solver that has no explicit limit with
   *  which it could be compared. */
  void check_time_step(const std::string &who);
  /** Warns of regions across periodic faces that fixes of this package use: they have no images, so
   *  that walls, surfaces, and bodies that they describe end there. A region that is the image of
   *  another one is the remedy. */
  void check_regions();
  /** Once in each step: the same for regions that move, from time to time. */
  void look_at_regions();
  /** Warns of points that are as warm as the melting temperature of their strength when they are
   *  new, or far below its reference temperature. Collective. */
  void check_temperatures(const class MPMField &);
  /** Warns of solids and liquids that their own weight presses to nothing. Collective. */
  void check_weight(const class MPMField &);
  /** Warns of gas that nothing can hold at an end of it: the box is empty there, and no fix is
   *  there that could press on it. Collective. */
  void check_gas(const std::vector<class MPMField *> &);
  /** Warns of points that are in something that keeps points out: which. distance: of x from its
   *  surface, negative inside, far or -far if it is greater or not known. Collective. */
  void check_inside(const std::string &who, const std::string &which,
                    const std::vector<class MPMField *> &,
                    const std::function<double(const double *x, double far)> &distance);

 private:
  static constexpr int STEPS = 16;    // from one look to the next
  int countdown = 0;
  unsigned warned = 0;                // bits of kinds
  std::set<std::string> warned_of;    // IDs of regions
};

/** Is it a gas whose pressure is absolute, eos ideal/gas? */
bool is_ideal_gas(const MPM_NS::Material &);

/** Moduli of a solid at rest, by its tangent along x and y [pressure]; zero for fluids, and if the
 *  law has no tangent of its own. */
struct MPMRestModuli {
  double compression = 0.0;    ///< along one axis, without strain across
  double lambda = 0.0, shear = 0.0;

  explicit MPMRestModuli(const MPM_NS::Material &);
  double poisson_ratio() const
  {
    return lambda > 0.0 && shear > 0.0 ? 0.5 * lambda / (lambda + shear) : 0.0;
  }
};

}    // namespace LAMMPS_NS
#endif
