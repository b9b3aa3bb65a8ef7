/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTACT_SOLVER_H
#define LMP_MPM_CONTACT_SOLVER_H

#include "base/mpm_first_note.h"
#include "contact/mpm_contact_bodies.h"
#include "contact/mpm_contact_search.h"
#include "contact/mpm_node_contact.h"
#include "math/aitken.h"
#include "math/sets.h"
#include "pointers.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {

/** Impulses between bodies at the nodes where they are in contact, in an explicit step. */
class MPMContactSolver : protected Pointers {
 public:
  using Velocities = MPMContactBodies::Velocities;
  /** What to count of a node and its velocities before contact. */
  using Count = std::function<void(const MPMContacts::Node &, const Velocities &start)>;

  MPMContactSolver(class LAMMPS *lmp, const MPMContactLaw &law, MPMContactBodies &bodies) :
      Pointers(lmp), law(law), bodies(bodies)
  {
  }

  void begin_run() { unsolved.begin(); }
  /** Changes the velocities of the nodes. decided: the states of contacts stay (MUSL, second field
   *  of velocities); otherwise count is called for each node. */
  void solve(MPMContacts &, double dt, bool decided, const Count &count);
  /** Collective: one warning of nodes where iterations have not converged, the same for any number
   *  of ranks. */
  void report_unsolved(const char *id);

 private:
  struct Problem {    // a node in contact
    MPMContacts::Node *node;
    Velocities start;    // before contact
    int group;           // number of its group of nodes that depend on each other
  };

  const MPMContactLaw &law;
  MPMContactBodies &bodies;
  MPMContacts *contacts = nullptr;
  double dt = 0.0;
  bool decided = false;

  // nodes that are solved together
  std::vector<Problem>
      coupled;    // where walls move one body with its mirror nodes, but not another
  std::vector<double> impulses;
  std::vector<char> states;
  MPM_NS::Aitken series;
  MPM_NS::Sets dependent;
  std::vector<int> first_with_mirror;
  MPMFirstNote<4> unsolved;    // step and place

  bool begin(const MPMContacts::Node &, Velocities &start);
  void set_velocities(const Problem &);
  double iterate(const Problem &);
  void solve_group(const Problem *first, const Problem *last, bool mirrored);
  void note_unsolved(const Problem *first, const Problem *last);
  void find_groups();
};

}    // namespace LAMMPS_NS
#endif
