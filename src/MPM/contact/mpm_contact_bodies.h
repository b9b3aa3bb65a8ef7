/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTACT_BODIES_H
#define LMP_MPM_CONTACT_BODIES_H

#include "contact/mpm_inside_fraction.h"
#include "contact/mpm_node_contact.h"
#include "field/mpm_reach.h"
#include "pointers.h"
#include "walls/mpm_mirror_nodes.h"

#include <array>
#include <cstdint>
#include <vector>

namespace MPM_NS {
class Grid;
}

namespace LAMMPS_NS {
class MPMRefinedBody;
class MPMField;

/** A body in contact with others, and what it has at nodes. */
struct MPMContactBody {
  MPMField *field;
  MPMReach reach = {};
  std::vector<int> images = {};    ///< blocks with periodic images
  MPMRefinedBody *refined =
      nullptr;    ///< body on several lattices to which this field belongs, or null
  std::vector<MPMField *> finer = {};    ///< parts of that body on finer lattices
  std::vector<char> near = {};           ///< [slot] do bodies share nodes of this block?
  std::vector<double> gradient = {};     ///< [node][3] of the volume (or mass)
  std::vector<double> fraction = {};     ///< [node] volume over that of the node
  std::vector<double> water = {};    ///< [node][3] of MPMPorePressure::surface_force(); empty: none
  std::vector<char> held = {};       ///< bits, FixMPMBoundary::mark_prescribed()
  MPMPredictedVelocities predicted = {};

  /** Index of the node with this record. */
  int64_t node_of(const double *record) const;
  const double *gradient_at(const double *record) const { return &gradient[3 * node_of(record)]; }
  double fraction_at(const double *record) const { return fraction[node_of(record)]; }
  /** Node with this index, also beyond periodic faces; -1: the body has none there. */
  int64_t node_at(const int *index) const;
  /** Does this rank know what the body has at the node with this index? */
  bool knows(const int *index) const;
  /** What walls will do to a node, after predict_walls(). */
  MPMNodeWalls walls_at(const double *record) const;
  /** Updates what walls will give to the mirror nodes of a node, whose velocity has changed. */
  void move_mirrors(const double *record, const std::array<double, 3> &before);
  /** Marks a block whose nodes are needed, and those that hold periodic images of its nodes. */
  void mark_near(int slot);
};

/** A block of nodes that several bodies have. */
struct MPMSharedBlock {
  static constexpr int MOST = 32;    ///< number of bodies: each has a group, of which LAMMPS has 32

  int slot[MOST];    ///< of the block in each field; -1: none
  uint64_t canonical, owned;
};

/** Bodies, each a field, on the nodes that they share on one lattice. */
class MPMContactBodies : protected Pointers {
 public:
  static constexpr int MOST = MPMSharedBlock::MOST;

  /** Of all bodies at a node. */
  using Velocities = std::array<std::array<double, 3>, MOST>;

  explicit MPMContactBodies(class LAMMPS *lmp) : Pointers(lmp) {}

  std::vector<MPMContactBody> list;
  std::vector<MPMSharedBlock> shared;
  MPMInsideFraction inside;
  bool on_several_lattices = false;    ///< is a body on several lattices?
  bool all_near = false;               ///< contact reaches beyond nodes that bodies share
  bool by_mass = false;                ///< gradients are those of the mass

  int size() const { return (int) list.size(); }
  int dim() const;
  double spacing() const;
  MPMContactBody &operator[](int k) { return list[k]; }
  const MPMContactBody &operator[](int k) const { return list[k]; }

  /** Prepares a run. */
  void begin_run();
  // see MPMNodeAction
  void couple_topology();
  void blocks_found();
  void extend_topology(MPMField &);

  /** Finds the blocks that bodies share, if they are new. Returns whether there are any.
   *  Collective. */
  bool find_shared();
  /** Finds gradients, with_volumes also volume fractions, pore water, and walls, at nodes that
   *  bodies share. Returns false if no node has mass of two bodies. Collective. */
  bool map(bool with_volumes);
  /** Finds gradients, and with_volumes volume fractions, of a body in blocks that are near. */
  void map_content(MPMContactBody &, bool with_volumes);
  /** Finds the effect of walls on the present velocities of the nodes, which a stage may have
   *  changed since the last call. */
  void predict_walls(MPMContactBody &);

  /** Finds the records of the bodies at node n of a block; null: no mass there. Returns how many
   *  bodies have mass. */
  int records(const MPMSharedBlock &, int n, double *record[MOST]);
  /** Fraction of the volume of node n, as far as it is inside the box, that all bodies fill. */
  double filled(const MPMSharedBlock &, int n) const;
  /** The same for one body, by the index of the node. */
  double fraction(const MPMContactBody &, const int *index) const;
  /** Gradient of a body and its mirror images at node n of a block. A body that reaches a fixed
   *  face has no surface there that others could touch: it continues as its mirror image. Without
   *  that, its normal would be inclined towards the face, and bodies that lie on each other would
   *  be pushed along the face. */
  void gradient_with_mirrors(const MPMContactBody &, int slot, int n, double *g) const;

  /** Counts in the ledgers what has changed since start in the velocities of bodies at a node. */
  void book(double *const *record, const Velocities &start);
  double memory_usage() const;

 private:
  bool lists_valid = false, may_touch = false;

  bool is_stale() const;
};

}    // namespace LAMMPS_NS
#endif
