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
#include "field/mpm_ledger.h"
#include "watch/mpm_point_summary.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Energy ledger of all material points.
 *
 *  The balance is (kinetic + stored + plastic + viscous + fracture) - (the same at the start) =
 *  external + boundary + contact + transfer + integration + deleted + residual. The accounts of
 *  other physics (MPMPhysics) add to the left side (stored) and to the right side (received).
 *  Internal work is the energy that internal forces take from the kinetic energy. The part of it
 *  that the law neither stores nor dissipates is the error of time integration. The residual
 *  closes the balance of the stages of fix mpm and must be round-off.
 */
class ComputeMPMEnergy : public Compute, public MPMEnergyStart {
 public:
  ComputeMPMEnergy(class LAMMPS *, int, char **);
  void init() override;
  void setup() override { begin(); }
  double compute_scalar() override;
  void compute_vector() override;

  const std::vector<double> &start_sums() const override { return start; }

 private:
  enum Entry {
    KINETIC,        // of the points
    STORED,         // sum over points of V0 times stored energy density
    PLASTIC,        // plastic work
    VISCOUS,        // viscous work, also of artificial viscosity
    HEAT,           // part of the plastic and viscous work that became heat
    EXTERNAL,       // work of atom->f
    BOUNDARY,       // work of boundaries
    CONTACT,        // work of contact between fields
    TRANSFER,       // kinetic energy gained by transfers
    INTEGRATION,    // energy gained by time integration of the laws
    RESIDUAL,       // error of the balance
    FRACTURE,       // work spent on damage
    DELETED,        // minus the energy of deleted points
    LAWS,           // part of INTEGRATION: energy of the laws beyond the work of their stress
    NENTRY          // entries of other physics follow
  };

  /** Sums over all ranks from which the entries follow; accounts of other physics come after it. */
  struct Sums : MPMPointEnergies {
    double external, boundary, contact, transfer, internal, stress_work;
    double deleted_kinetic, deleted_stored;
  };

  static constexpr std::size_t NSUMS = sizeof(Sums) / sizeof(double);

  std::vector<double> entries;
  std::vector<double> start;        // Sums and accounts; empty: the ledger has not started
  std::vector<int> contributors;    // instance numbers of the fixes that keep a part of the sums
  std::vector<std::string> accounts;    // of other physics, when this was defined

  std::vector<double> evaluate() const;
  std::vector<std::string> find_accounts() const;
  void begin();
  void forget_lost_parts();
};

}    // namespace LAMMPS_NS
#endif
#endif
