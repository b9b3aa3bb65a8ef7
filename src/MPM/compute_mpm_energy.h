/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(mpm/energy,ComputeMPMEnergy);
// clang-format on
#else

#ifndef LMP_COMPUTE_MPM_ENERGY_H
#define LMP_COMPUTE_MPM_ENERGY_H

#include "compute.h"
#include "mpm_point_energies.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Energy ledger of all material points.
 *
 *  The balance is (kinetic + stored + plastic + viscous + fracture) - (the same at the start) =
 *  external + boundary + contact + transfer + integration + deleted + residual. What other physics
 *  (MPMPhysics) store and get adds to the two sides. Internal work is what the
 *  internal forces take from the kinetic energy; what of it is neither stored nor dissipated by
 *  the law is the error of time integration. The residual closes the balance of the stages of
 *  fix mpm and must be round-off.
 */
class ComputeMPMEnergy : public Compute {
 public:
  ComputeMPMEnergy(class LAMMPS *, int, char **);
  void init() override;
  void setup() override { begin(); }
  double compute_scalar() override;
  void compute_vector() override;

  /** What the ledger started from, for restart files; empty before it has started. */
  const std::vector<double> &start_sums() const { return start; }

 private:
  enum Entry {
    KINETIC,        // of the points
    STORED,         // sum of V0 times stored energy
    PLASTIC,        // plastic work
    VISCOUS,        // viscous work, also of artificial viscosity
    HEAT,           // part of plastic and viscous work that became heat
    EXTERNAL,       // work of atom->f
    BOUNDARY,       // work of boundaries
    CONTACT,        // work between fields
    TRANSFER,       // kinetic energy gained by transfers
    INTEGRATION,    // energy gained by time integration of the laws
    RESIDUAL,       // what the balance misses
    FRACTURE,       // work spent on damage
    DELETED,        // energy of points that were deleted, negative
    NENTRY          // those of other physics follow
  };

  /** What the entries are computed from, summed over ranks; the accounts of other physics follow. */
  struct Sums : MPMPointEnergies {
    double external, boundary, contact, transfer, internal;
    double deleted_kinetic, deleted_stored;
  };

  static constexpr std::size_t NSUMS = sizeof(Sums) / sizeof(double);

  std::vector<double> entries;
  std::vector<double> start;            // Sums and accounts; empty: the ledger has not started
  std::vector<int> contributors;        // fixes that keep a part of these, by their instance
  std::vector<std::string> accounts;    // of other physics, when this was defined

  std::vector<double> evaluate() const;
  std::vector<std::string> find_accounts() const;
  void begin();
  void forget_lost_parts();
};

}    // namespace LAMMPS_NS
#endif
#endif
