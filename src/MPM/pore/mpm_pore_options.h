/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_OPTIONS_H
#define LMP_MPM_PORE_OPTIONS_H

#include "declare/option.h"
#include "field/mpm_doubts.h"
#include "pointers.h"
#include "pore/mpm_pore_soil.h"
#include "pore/mpm_pore_surface.h"

#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {
class Fix;
class MPMField;

/** Keywords of fix mpm/pore. */
struct MPMPoreOptions {
  enum Formulation { U_P, U_V_P };

  Formulation formulation = U_P;
  MPMPoreWater water;
  std::vector<MPMPoreSoil> soils;
  MPMPoreSurface::Conditions conditions;
  bool seals = false;              ///< do bodies seal free surfaces that they touch?
  std::string initial = "0.0";     ///< initial pressure of points, a number or v_name
  bool geostatic = false;          ///< initially at rest under the weight
  double K0 = 0.0, table = 0.0;    ///< geostatic: ratio of stresses, and height of the water table
  double most_suction = -1.0;      ///< largest initial suction, positive; negative: no limit
  double relax = 0.4;
  int most_stages = 64;
  static constexpr int AUTO = 0, NOT_GIVEN = -1;
  int every = NOT_GIVEN;    ///< most steps per flow of water, or AUTO

  bool sets_relax = false, sets_stages = false, sets_every = false;    ///< keywords that were given

  /** Names of the parts of the surface, in the order of MPMPoreSurface. */
  static const char *const PART_NAME[];

  MPM_NS::Options declare(int dimension);
  /** May water flow in only one of several steps? */
  bool waits() const { return every != 1; }
  /** Could the flow wait for several steps with this formulation and these soils? */
  bool can_wait() const { return formulation == U_P && !can_dry(); }
  /** Can pores of any soil become empty? */
  bool can_dry() const;
  /** Does any soil expand when it becomes warm? */
  bool warms() const;
  /** Is there water in the pores of this material (ID of a fix mpm/material)? */
  bool has(const std::string &material) const;

 private:
  // values that are being read
  MPMPoreSoil next;
  std::pair<double, double> biot = {0.0, 0.0}, growth = {0.0, 0.0};
  bool biot_alone = false, forchheimer_alone = false, growth_alone = false;
  enum Forchheimer { NUMBER, ERGUN } forchheimer = NUMBER;
  double forchheimer_value = 0.0;
  MPMRetention retention;
  std::string without_soil, without_retention;    // keywords that were given too early
};

/** Checks of soils with pore water at the start of a run. Each stops with an error, or warns. */
class MPMPoreChecks : protected Pointers {
 public:
  /** id: of the fix, for messages. */
  MPMPoreChecks(class LAMMPS *lmp, const MPMPoreOptions &options, const std::string &id) :
      Pointers(lmp), options(options), id(id), doubts(lmp)
  {
  }

  /** Where points are; less than nothing: nowhere. */
  struct Extent {
    double lo[3], hi[3];
    Extent();
    void take(const double *x);
    double largest(int dim) const;
  };
  /** Numbers of the run with which those of soils are compared. */
  struct Scene {
    double h;           ///< least node spacing
    double duration;    ///< of the run; 0: not known
    double gravity[3];
  };

  /** Checks materials and variables of soils. */
  void check_soils() const;
  /** Checks soils with grains that are not rigid, once. */
  void check_grains();
  /** Warns of soils without points, as with the ID of another material, where the ground stays dry,
   *  and of soils that are lighter than their water, whose grains have a negative weight; without
   *  gravity, much lighter soil is a way to leave out inertia. Also of numbers that hardly fit
   *  together. extents: of the points of each soil on this rank; has_weight: there is gravity.
   *  Collective. */
  void warn_of_soils(const std::vector<Extent> &extents, bool has_weight, const Scene &);
  /** Checks options that implicit steps cannot have: their equations are linear in the pressure of
   *  nodes. */
  void check_implicit() const;
  /** Checks that the mass that moves by itself is less than all mass, and that nodes have
   *  accelerations. */
  void check_motion(const Fix &, MPMField &) const;

 private:
  const MPMPoreOptions &options;
  const std::string id;
  bool grains_known = false;    // was check_grains() done?
  MPMDoubts doubts;

  void compare_soil(const MPMPoreSoil &, const MPM_NS::Material &, bool has_weight, double size,
                    const Scene &);
  void compare_flow(const MPMPoreSoil &, const MPM_NS::Material &, double size, const Scene &);
  void compare_weight(const double *gravity);
};

}    // namespace LAMMPS_NS
#endif
