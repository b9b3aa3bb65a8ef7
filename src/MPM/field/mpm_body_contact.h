/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BODY_CONTACT_H
#define LMP_MPM_BODY_CONTACT_H

#include "field/mpm_trial_contact.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace LAMMPS_NS {

/** Contact between bodies that are fields of their own, for a solver that has the nodes of all
 *  bodies in its vectors [node][dim]. Contacts are rows of constraints, C v = g. The solver makes
 *  an orthogonal projection of them, together with walls; acts in the stage TRIAL do nothing. A row
 *  is known on all ranks whose points reach one of its nodes, and counts in sums on one of them
 *  (its owner). */
class MPMBodyContact : public MPMTrialContact {
 public:
  /** Sets the place of the first node of each body in vectors. To be called before
   *  begin_trials(). */
  virtual void place_bodies(const std::function<int64_t(const MPMField &)> &first) = 0;
  /** Number of rows that this rank knows. */
  virtual std::size_t nrows() const = 0;
  /** Number of rows in a group; the rows of a group are on the same nodes. */
  virtual int rows_of_group() const = 0;
  /** Identifies a group, with the same value on all ranks. */
  using Key = std::array<int, 7>;
  virtual Key key_of(std::size_t group) const = 0;
  /** Does a group count in sums on this rank? */
  virtual bool owns(std::size_t group) const = 0;
  /** Is this row active now? */
  virtual bool holds(std::size_t row) const = 0;
  /** Calls use(k, c) for the entries c of C in a row, k: place in vectors; also for rows that are
   *  not active. */
  virtual void visit_row(std::size_t row,
                         const std::function<void(int64_t k, double c)> &use) const = 0;
  /** Does anything touch, on this rank? */
  virtual bool touches() const = 0;
  /** rows: [row] C v, or C v - g with_gaps if gaps are closed; zero for rows that are not
   *  active. */
  virtual void find_approach(const double *v, bool with_gaps, double *rows) const = 0;
  /** Sums over the rows r that this rank owns: sums[0]: r . D^-1 r with the diagonal D of C P_w
   *  M^-1 C^T; sums[1]: the same with speeds in place of r, those of v at the nodes of the row (v
   *  null: none), and of the closing of gaps. */
  virtual void add_squares(const double *rows, const double *v, double *sums) const = 0;
  /** The symmetric part of add_friction_change(): the direction of friction changes, normal forces
   *  do not. */
  virtual void add_friction_turn(const double *du, double *dforce) = 0;
  /** Adds factor times the impulses of rows to their sums, see MPMTrialContact. */
  virtual void push(double factor, const double *rows) = 0;

 protected:
  ~MPMBodyContact() = default;
};

}    // namespace LAMMPS_NS
#endif
