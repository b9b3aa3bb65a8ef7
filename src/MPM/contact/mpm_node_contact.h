/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_CONTACT_H
#define LMP_MPM_NODE_CONTACT_H

#include "contact/mpm_cohesive_law.h"
#include "declare/option.h"
#include "math/coulomb.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/** Law of contact between two bodies, and its keywords. */
struct MPMContactLaw {
  enum Law { FRICTIONLESS, COULOMB, STICK, ADHESIVE, COHESIVE };

  Law law = FRICTIONLESS;
  MPM_NS::CoulombFriction friction = {0.0, -1.0};    ///< still < 0: equal to kinetic
  double normal_strength = 0.0, shear_strength = 0.0, release_work = 0.0;
  MPMCohesiveLaw cohesion;

  double pressure_unit = 1.0;    ///< impulse by a unit of pressure, area, and time
  /** Bodies whose approach is zero up to round-off are in contact (with law stick, they are
   *  not). */
  bool keeps_rest = false;
  /** Impulses below this part of the momentum do not count as changes in iterations. */
  double rounded = 1.0e-2;

  /** Declares the keyword law; bonds: are there the laws adhesive and cohesive? */
  void declare_law(MPM_NS::Options &, bool bonds);
  /** The rule for coefficients of friction. */
  MPM_NS::OptionRule coefficients() const;
  /** Sets the coefficient of static friction if the input does not. */
  void complete();
  bool operator==(const MPMContactLaw &) const;
  /** Share of the adhesive strength that remains when the bodies are apart by this distance. */
  double adhesion_at(double opening) const;
};

/** What a law of cohesion needs of the bond of two bodies at a node. */
struct MPMNodeBond {
  double
      opening[3];    ///< of the part that holds, from the first body to the second one [distance]
  double damage;     ///< mean, 0 to 1
  double reached;    ///< damage of the part that holds
  double weight;     ///< of the points that have it
};

/** What walls will do to a body at a node after contact. */
struct MPMNodeWalls {
  char held = 0;         ///< bits: components to which walls give their velocity
  char mirrored = 0;     ///< bits: components that move with those of the mirror nodes
  char outside = 0;      ///< bits: mirrored components of a node outside of the mirror
  double velocity[3];    ///< velocity that walls will give to these components
  double mass[3];        ///< of the node and its mirror nodes
  double start[3];       ///< present velocity of the node

  /** Does the node with this record move with mirror nodes that have mass? */
  bool moves_with_mirrors(const double *record) const;
  /** Component d of the velocity of this record, or the velocity that walls will give to it. */
  double velocity_of(const double *record, int d) const;
};

/** Contact of two bodies at one node. Records of nodes are velocity [3] and mass. */
struct MPMNodeContact {
  enum State : char { OPEN, SLIDING, STUCK };

  int a, b;                             ///< indices of the bodies
  double *ra, *rb;                      ///< records of the node in both bodies
  double n[3];                          ///< unit normal from a to b
  double area;                          ///< of the interface at the node
  double adhesion;                      ///< share of the adhesive strength that remains at this gap
  double water;                         ///< part of the impulse on b along n that pore water takes
  bool touches;                         ///< are the bodies as near as in contact, by their volumes?
  const MPMNodeBond *bond = nullptr;    ///< null: not bonded, nor were they
  MPMNodeWalls walls_a, walls_b;
  bool alike = true;    ///< walls act on the same components of both bodies
  char left = 0;        ///< bits: components left to the walls, or to contact at the mirror node
  State state;
  double normal, tangential[3];    ///< impulses on b so far, along n and in the tangential plane

  /** Component d of the impulse on b. */
  double impulse(int d) const { return left >> d & 1 ? 0.0 : normal * n[d] + tangential[d]; }
  /** Begins with no impulse, and this action of walls. */
  void begin(const MPMNodeWalls &of_a, const MPMNodeWalls &of_b);
  /** Adds the impulses to the velocities of the bodies. */
  void push(int dim) const;
  /** One iteration: the impulse for the present velocities, within the limits of the law.
   *  neighbors: number of bodies that one body may meet here, by which the mass is divided.
   *  decided: the state stays (MUSL, second field of velocities). Returns the change of the
   *  impulse, relative to it. */
  double iterate(const MPMContactLaw &, int dim, int neighbors, double dt, bool decided);

 private:
  double approach(int dim, int neighbors, double *u, double &un) const;
  double limit(const MPMContactLaw &, double mass, int dim, double length, double dt,
               double &normal);
  void hold_together(const MPMContactLaw &, double mass, int dim, double dt, double &normal,
                     double *tangential);
};

/** What each two of several bodies do to each other: the output of a fix with an array of 5 columns
 *  and a scalar. The rows are the pairs (0,1), (0,2), ..., (1,2), ... */
class MPMContactReport : protected Pointers {
 public:
  static constexpr int COLUMNS = 5;
  struct Entry {                            // this rank's share
    double impulse[3] = {0.0, 0.0, 0.0};    ///< on the second body in the last step
    double count = 0.0;                     ///< nodes in contact
    double work = 0.0;    ///< of friction and bonds so far, without the unit of energy

    /** Counts a contact, but not the work of its friction and bonds with the velocities that its
     *  records have now, which it returns. */
    double add(const MPMNodeContact &, int dim);
  };

  explicit MPMContactReport(class LAMMPS *lmp) : Pointers(lmp) {}
  void set_bodies(int nbodies);

  std::vector<Entry> entries;

  Entry &of(int a, int b) { return entries[a * nbodies - a * (a + 1) / 2 + b - a - 1]; }
  void begin_step(double dt);
  /** Work of friction so far [energy]. Collective. */
  double work();
  /** Force on the second body in the last step [3], nodes in contact, work of friction so far.
   *  Collective. */
  double at(int row, int column);

 private:
  int nbodies = 0;
  double dt_last = 0.0;
  std::vector<double> sums;
  bigint sums_step = -1;    // of sums
};

}    // namespace LAMMPS_NS
#endif
