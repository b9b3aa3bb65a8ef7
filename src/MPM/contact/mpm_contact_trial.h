/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTACT_TRIAL_H
#define LMP_MPM_CONTACT_TRIAL_H

#include "contact/mpm_contact_bodies.h"
#include "contact/mpm_contact_lines.h"
#include "contact/mpm_contact_report.h"
#include "contact/mpm_contact_search.h"
#include "field/mpm_trial_contact.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class Fix;

/** Contact between bodies in steps of a solver. */
class MPMContactTrial : public MPMBodyContact, protected Pointers {
 public:
  MPMContactTrial(class LAMMPS *, const Fix &, const MPMContactSearchOptions &,
                  const MPMContactLaw &, MPMContactBodies &, MPMContactSearch &, MPMContacts &);
  ~MPMContactTrial() = default;

  /** Prepares a run. */
  void begin_run();
  /** Adds the forces of contact to the nodes, which have all other forces except those of walls;
   *  walls act after this. */
  void act(MPMContactReport &);

  // MPMBodyContact
  void place_bodies(const std::function<int64_t(const MPMField &)> &first) override
  {
    place_of = first;
  }
  std::size_t nrows() const override { return ties.size() * rows_of_tie(); }
  int rows_of_group() const override { return rows_of_tie(); }
  Key key_of(std::size_t group) const override { return ties[group].key; }
  bool owns(std::size_t group) const override { return ties[group].owned; }
  bool holds(std::size_t row) const override
  {
    return acts(ties[row / rows_of_tie()], (int) (row % rows_of_tie()));
  }
  void visit_row(std::size_t row,
                 const std::function<void(int64_t k, double c)> &use) const override;
  bool touches() const override;
  void find_approach(const double *v, bool with_gaps, double *rows) const override;
  void add_squares(const double *rows, const double *v, double *sums) const override;
  void add_friction_turn(const double *du, double *dforce) override;
  void push(double factor, const double *rows) override;

  // MPMTrialContact
  void begin_trials(MPMField &, double dt, double slip_time, double eps, bool rests) override;
  bool find_carried(MPMField &, std::vector<double> &) override { return false; }
  void constrain_carried(MPMField &, double *) override {}
  bool close_gaps(bool yes) override;
  void check_arrival() override {}
  bool has_friction() const override
  {
    return law.law == MPMContactLaw::COULOMB && law.friction.kinetic > 0.0;
  }
  bool is_regularised() const override { return false; }
  bool rubs() const override;
  void clear_impulses() override;
  void take_base() override;
  void take_forces(double scale) override;
  void add_friction(const double *u, double *force) override;
  void add_friction_change(const double *du, double scale, double *dforce) override;
  void add_friction_blocks(double *blocks) override;
  void add_friction_stiffness(double *) override {}    // levels are of one field
  void correct(const double *du) override;
  bool decide(const double *u, double unbalanced) override;
  void soften(double) override {}
  void take_stop() override;
  void predict_velocities(const double *, double share) override { force_share = share; }

 private:
  struct Link {             // a node of a tie
    int64_t a, b;           // indices of the node of each body in vectors of the solver
    double *ra, *rb;        // node records
    double weight, n[3];    // share of the interface, and its normal at the node
  };
  /** Two bodies at a line of nodes through their interface, with joined lines: a constraint along
   *  the normals and, where they stick, along the interface. Its rows are in this order. */
  struct Tie {
    int first, last;            // range in links
    int a, b;                   // indices of bodies
    bool owned;                 // does this rank count the tie in sums?
    Key key;                    // the same on all ranks
    bool active;                // do the bodies touch?
    bool sticks;                // by friction or law stick
    int releases;               // number of releases in the step; with law stick: while it stuck
    int changes;                // number of changes between sliding and sticking in the step
    double n[3];                // mean normal from a to b
    double along[2][3];         // unit vectors along the interface, or zero
    double gap;                 // gap that is to be closed [distance]
    double diagonal[3];         // [row] of C P_w M^-1 C^T
    double push[3], base[3];    // [row] impulse so far; impulse by the motion of walls alone
    double force[3];            // [row] force of a on b
    double stop[3];             // [row] impulse at the end of the step
    // sliding ties: slip of a on b in the step, its direction in the previous iteration, friction
    // force on a
    double slip[3], direction[3], friction[3];
    double inertia;    // weight d of the previous direction [distance], see find_direction()

    bool can_slide() const
    {
      return along[0][0] != 0.0 || along[0][1] != 0.0 || along[0][2] != 0.0;
    }
  };

  const Fix &fix;
  const MPMContactSearchOptions &options;
  const MPMContactLaw &law;
  MPMContactBodies &bodies;
  MPMContactSearch &search;
  MPMContacts &contacts;
  MPMContactLines lines;

  std::vector<Tie> ties;
  std::vector<Link> links;
  std::vector<char> owned_pairs;    // [pair] does this rank count the node?
  std::function<int64_t(const MPMField &)> place_of;
  double trial_dt = 0.0;
  double force_share = 1.0;    // share of the impulse of forces that changes the momentum in a step
  bool closes = false;
  int rounds = 0;    // rounds of decisions in this step
  bool warned_of_released = false, is_first_step = true;
  double filled_at_start = 0.0;    // most of the volume of a node that two bodies fill together

  int rows_of_tie() const;
  /** Does this row constrain the motion? */
  bool acts(const Tie &tie, int row) const
  {
    return tie.active && tie.diagonal[row] > 0.0 && (row == 0 || tie.sticks);
  }
  bool slides(const Tie &tie) const
  {
    return has_friction() && tie.active && !tie.sticks && tie.can_slide();
  }
  static const double *row_direction(const Tie &tie, const Link &link, int row)
  {
    return row == 0 ? link.n : tie.along[row - 1];
  }
  void find_ties();
  void add_tie(const std::vector<int> &parts);
  void add_links(Tie &, const std::vector<int> &pairs, double area);
  bool knows_ends(const Tie &, const std::vector<int> &parts) const;
  void find_tangents(Tie &, int held) const;
  void check_overlap();
  bool is_released(const Tie &) const;
  void warn_of_released();
  double friction_of(const Tie &) const;
  void find_slip(const Tie &, const double *u, double *slip) const;
  double find_direction(const Tie &, double *direction) const;
  void direction_change(const Tie &, const double *slip, double *direction, double *change) const;
  double friction_error(const Tie &, double largest) const;
  void switch_friction(Tie &) const;
  void activate(Tie &, const double *u, double approach) const;
  void add_pair_force(const Tie &, const double *on_a, double *force) const;
  void add_row_forces(const Tie &, const Link &, const double *rows, double *force) const;
  double find_errors(const double *u, std::vector<double> &wrong,
                     std::vector<char> &by_friction) const;
};

}    // namespace LAMMPS_NS
#endif
