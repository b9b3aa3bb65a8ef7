/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef PAIR_CLASS
// clang-format off
PairStyle(mpm/penalty,PairMPMPenalty);
// clang-format on
#else

#ifndef LMP_PAIR_MPM_PENALTY_H
#define LMP_PAIR_MPM_PENALTY_H

#include "base/mpm_pair.h"
#include "declare/option.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
struct MPMPoints;

/** Settings of pair_style mpm/penalty. */
struct MPMPenaltyOptions {
  double growth = 1.2;    ///< largest ratio of a radius to its initial value

  MPM_NS::Options declare();
};

/** Settings of pair_coeff for mpm/penalty, as in restart files. */
struct MPMPenaltyCoeff {
  double modulus = 0.0;     ///< pressure units
  double friction = 0.0;    ///< Coulomb coefficient
  double slip = 0.0;        ///< sliding velocity above which friction is full
  double damping = 0.0;     ///< fraction of critical damping of a contact
  int64_t set = 0;          ///< given by pair_coeff

  MPM_NS::Options declare();
};

/** Contact between points of different fields (fix mpm), whatever their lattices.
 *
 *  Points are spheres (2d: disks) whose diameter is the spacing of points according to their
 *  present volume. Two spheres that overlap by delta repel each other along the line of their
 *  centers with F = E A delta/(r_i
 *  + r_j), where A is the face of the smaller one. Aligned faces feel the pressure E delta/spacing,
 *  as if a
 *  layer of material of modulus E were between the outermost points. With an axis of symmetry, all
 *  of this is along the circle that is midway between the two. */
class PairMPMPenalty : public MPMPair<MPMPenaltyCoeff>, private MPMPenaltyOptions {
 public:
  PairMPMPenalty(class LAMMPS *lmp) : MPMPair(lmp, "mpm/penalty") {}
  void compute(int, int) override;
  void settings(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;
  void write_restart_settings(FILE *) override;
  void read_restart_settings(FILE *) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  int pack_reverse_comm(int, int, double *) override;
  void unpack_reverse_comm(int, int *, double *) override;
  double memory_usage() override;

  /** Is there friction between any types? */
  bool has_friction() const
  {
    return std::any_of(coeffs.begin(), coeffs.end(), [](const auto &c) {
      return c.friction > 0.0;
    });
  }
  /** Does contact dissipate energy between any types, by friction or damping? */
  bool takes_energy() const
  {
    return has_friction() || std::any_of(coeffs.begin(), coeffs.end(), [](const auto &c) {
             return c.damping > 0.0;
           });
  }
  /** Do points of the fields with these IDs repel each other? Call at init(), after that of this
   *  style. */
  bool couples(const std::string &, const std::string &);
  /** Call at init(), after that of this style: the dissipated energy becomes heat of the points,
   *  for fix mpm/heat. */
  void make_heat() { heats = true; }
  /** Power of this heat for a point of this rank, from the forces of the step. */
  double heating(int i) const { return i < (int) heat.size() ? heat[i] : 0.0; }

 private:
  using Coeff = MPMPenaltyCoeff;

  MPMPoints *points = nullptr;
  std::vector<MPMField *> fields;
  std::vector<char> coupled;          // [field][field] same field, or contact by fix mpm/contact
  std::vector<char> present;          // [field][type]
  std::vector<double> largest;        // [type] initial radius of the largest point
  std::vector<double> most_volume;    // [type] largest volume of a point before deformation
  bool rings = false;                 // axisymmetric: x is the distance from the axis
  bool damped = false;                // do some coefficients need masses?
  bool look = true;                   // must the content of the neighbor list be checked?
  bool warned = false;                // of points that outgrow their limit
  bool warned_deep = false;           // of bodies that penetrate each other

  bool heats = false;    // does dissipated energy become heat of the points?

  std::vector<double> radius, mass;        // current, [nmax]; mass with damping only
  std::vector<double> effusivity, heat;    // [nmax] with heat only; 0: does not conduct; power
  std::vector<int> near;                   // local points in these pairs

  void find_pairs();
  void warn_about_list(double same, double all);
  int field_of(int i) const;
  double initial_radius(int i) const;
  double current_radius(int i);
  double effusivity_of(int i) const;
  // points of one body do not interact, so that these need not be given: init_one() knows better
  bool needs_own_type() const override { return false; }
};

}    // namespace LAMMPS_NS
#endif
#endif
