/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BODY_CONTACT_H
#define LMP_MPM_BODY_CONTACT_H

#include "mpm_trial_contact.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace LAMMPS_NS {

/** Contact between bodies that are fields of their own, for a solver that has the nodes of all of them in its vectors [node][dim]. What touches
 *  is a set of rows, C v = g, of which the solver makes an orthogonal projection together with walls; acts in the stage TRIAL do nothing. A row is known on
 *  all ranks whose points reach one of its nodes, and counts in sums on one of them. */
class MPMBodyContact : public MPMTrialContact {
 public:
  /** The number of the first node of each body in vectors. Before begin_trials(). */
  virtual void place_bodies(const std::function<int64_t(const MPMField &)> &first) = 0;
  virtual std::size_t nrows() const = 0;
  /** Rows come in groups of this number, on the same nodes. */
  virtual int rows_of_group() const = 0;
  /** By what groups are told from each other on all ranks. */
  using Key = std::array<int, 7>;
  virtual Key key_of(std::size_t group) const = 0;
  virtual bool owns(std::size_t group) const = 0;
  /** Does this row hold now? */
  virtual bool holds(std::size_t row) const = 0;
  /** use(k, c) for the entries c of C in a row, whether it holds or not. */
  virtual void visit_row(std::size_t row,
                         const std::function<void(int64_t k, double c)> &use) const = 0;
  /** Does anything touch, on this rank? */
  virtual bool touches() const = 0;
  /** [row] C v, and less g if gaps are closed; zero where bodies do not touch. */
  virtual void find_approach(const double *v, bool with_gaps, double *rows) const = 0;
  /** Of rows r that count on this rank: sums[0] r . D^-1 r, with D the diagonal of C P_w M^-1 C^T, and, with v, sums[1] the same of the speeds
   *  at their nodes. */
  virtual void add_squares(const double *rows, const double *v, double *sums) const = 0;
  /** The part of add_friction_change() that is symmetric: friction turns, and the forces that press stay as they are. */
  virtual void add_friction_turn(const double *du, double *dforce) = 0;
  /** Impulses of rows, which are summed up, see MPMTrialContact. */
  virtual void push(double factor, const double *rows) = 0;

 protected:
  ~MPMBodyContact() = default;
};

}    // namespace LAMMPS_NS
#endif
