/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTACT_SEARCH_H
#define LMP_MPM_CONTACT_SEARCH_H

#include "contact/mpm_contact_bodies.h"
#include "contact/mpm_contact_checks.h"
#include "contact/mpm_node_contact.h"
#include "pointers.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {

/** Nodes where bodies are in contact. */
struct MPMContacts {
  struct Node {
    int first, last;    ///< range in pairs
    bool owned;
    double *record[MPMContactBodies::MOST];    ///< null: the body has no mass here

    /** Number of bodies, of n, that have mass here. */
    int count_bodies(int n) const;
  };
  std::vector<Node> nodes;
  std::vector<MPMNodeContact> pairs;

  void clear();
  /** Keeps the pairs for which keep(pair) is true; it is called once for each, in their order. */
  void keep(const std::function<bool(MPMNodeContact &)> &keep);
  /** For the nodes of body k: the index here, also of periodic images; -1: none. */
  std::vector<int> index_of_nodes(MPMContactBodies &, int k) const;
  /** Sums rows of width reals, one row for each pair, over ranks. Collective. */
  void sum(MPMContactBodies &, int width, std::vector<double> &rows) const;
};

/** Finds where bodies are in contact, and the normals of their interfaces. */
class MPMContactSearch : protected Pointers {
 public:
  MPMContactSearch(class LAMMPS *lmp, const Fix &fix, const MPMContactSearchOptions &options,
                   const MPMContactLaw &law, MPMContactBodies &bodies) :
      Pointers(lmp),
      fix(fix), options(options), law(law), bodies(bodies), checks(lmp, fix, options, bodies)
  {
  }

  void begin_run();
  /** Finds what bodies have at the nodes that they share. In the first step of a run, looks for
   *  bodies that cannot be right. Returns whether bodies may touch. Collective. */
  bool begin_step();
  /** Finds contacts at nodes, for a step of this length. */
  void find(double dt, MPMContacts &);
  /** Finds all nodes with an interface, whatever the gap is, for a solver. */
  void find_interfaces(MPMContacts &);
  /** Finds the area vector of the interface of two bodies at the node with this index; zero unless
   *  both have the node. */
  void interface_at(int a, int b, const int *index, double *area) const;
  /** Warns once if part of the force of the water is at nodes where bodies are not in contact,
   *  though they nearly fill them. Collective, where bodies have water. */
  void report_missed_water();

 private:
  const Fix &fix;
  const MPMContactSearchOptions &options;
  const MPMContactLaw &law;
  MPMContactBodies &bodies;
  MPMContactChecks checks;
  bool is_first_step = true;
  // impulse of water at nodes in contact, and at nodes nearly in contact
  double water_sums[2] = {0.0, 0.0};
  bool warned_of_water = false;

  template <class Make> void visit_nodes(MPMContacts &, const Make &make);
  bool find_normal(const MPMSharedBlock &, int n, MPMNodeContact &) const;
  bool is_in_contact(const MPMSharedBlock &, int n, double dt, MPMNodeContact &);
  double water_between(const MPMNodeContact &) const;
  void separate_points(MPMContacts &) const;
};

}    // namespace LAMMPS_NS
#endif
