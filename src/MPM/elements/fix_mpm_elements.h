/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/elements,FixMPMElements);
// clang-format on
#else

#ifndef LMP_FIX_MPM_ELEMENTS_H
#define LMP_FIX_MPM_ELEMENTS_H

#include "base/mpm_integrator.h"
#include "base/mpm_state.h"
#include "elements/element_forces.h"
#include "elements/element_nodes.h"
#include "elements/element_surface.h"
#include "elements/mpm_elements_options.h"
#include "field/mpm_coupling.h"
#include "field/mpm_interfaces.h"
#include "mesh/element_body.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Finite elements whose nodes are material points. The points have no stress of their own: the
 *  internal force is integrated over the elements (total Lagrangian) and added to atom->f. The
 *  points are moved by fix mpm or, without a lattice, by fix nve. This is the generalized particle
 *  in cell method of V.P. Nguyen, A. de Vaucorbeil, C. Nguyen-Thanh, T.K. Mandal, Comput. Methods
 *  Appl. Mech. Eng. 371 (2020) 113308.
 *
 *  An element belongs to one of its nodes and migrates with it; the others may be ghosts. */
class FixMPMElements : public FixMPMState, public MPMInternalForce, private MPMElementsOptions {
 public:
  FixMPMElements(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::POST_NEIGHBOR | FixConst::POST_FORCE; }
  void init() override;
  void setup_post_neighbor() override { find_nodes(); }
  void setup(int) override
  {
    compute(true);
    if (has_lattice)
      look_for_gaps(true);
    else
      check_free_dt();
  }
  void post_neighbor() override
  {
    find_nodes();
    if (has_lattice)    // fix mpm checks the time step
      look_for_gaps(false);
    else
      check_free_dt();
  }
  void post_force(int) override
  {
    set_up.check(lmp, "Fix mpm/elements");
    uncoupled.look();
    compute(false);
  }
  double compute_scalar() override { return (double) nelements; }
  double compute_vector(int) override;
  double memory_usage() override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  void unpack_restart(int, int) override;
  int size_restart(int i) override { return 2 + (int) count[i] * body->stride; }
  int maxsize_restart() override { return 2 + max_of_node * body->stride; }
  void write_restart(FILE *) override;
  void restart(char *) override;
  int pack_reverse_comm(int, int, double *) override;
  void unpack_reverse_comm(int, int *, double *) override;

  int group_of_points() const override { return groupbit; }
  bool on_lattice() const override { return has_lattice; }

  /** Sets the pressure, which pushes a closed surface outward, and an open one toward the side from
   *  which its elements go around counterclockwise (in 2d: to the right of lines). Valid until the
   *  next init(). closed: an error if the surface encloses no volume. */
  void set_pressure(MPMElementsPressure *who, bool closed)
  {
    surface->set_pressure(who, closed, id);
    comm_reverse = width = 21 + body->nhistory;    // before LAMMPS makes room for messages
  }

  /** Energy stored by the elements of this rank [pressure * volume]; on the first rank, minus the
   *  work done so far by the pressure in a closed surface. */
  double stored_energy() const override;

  /** Forces of the elements and of the pressure on the points of this rank, [nlocal][3], as added
   *  to atom->f. */
  const double *forces() const override { return force_on.data(); }

  /** From 2/omega with a bound of the highest frequency omega; speed is 0 if the gas in a closed
   *  surface contributes more than waves. */
  double stable_dt(tagint &tag, double &speed) const override;
  void check_dt() const override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  bool forces_after(const double *u, double *force, double &carried) override;
  double differentiate(const double *u) override;
  void add_change(const double *du, double *dforce) override;
  void add_blocks(double *blocks) override;
  double asymmetry() const override { return tangents->asymmetry(); }

  /** Message on a feature that trial motions do not support, with advice; null: all is
   *  supported. */
  const char *beyond_trials() const
  {
    return bending ? "bending: use explicit steps"
        : surface->pressure && curved
        ? "the pressure inside of a surface that is curved: use curved no, or explicit steps"
        : surface->pressure && !surface->pressure->is_given()
        ? "how the pressure of the gas in it changes: use fix mpm/airbag pressure, or explicit "
          "steps"
        : nullptr;
  }

  /** Are the elements a surface or a line? */
  bool is_thin() const { return (bool) thin; }

  /** ID of a fix mpm that moves nodes, or null. Collective. */
  const char *field_of_nodes() const { return nodes.field(); }

  /** Smallest ID and number of the nodes; their IDs are consecutive. */
  tagint first_node() const { return nodes.ids.low; }
  bigint number_of_nodes() const { return nodes.ids.n; }

  /** Undeformed edges of all elements and diagonals of quadrangles, on all ranks. Nodes are
   *  numbered from the first one on. An edge is listed once for each of its elements.
   *  Collective. */
  std::vector<MPM_NS::NearNodes::Edge> edges() const;

  /** Largest distance of a place on the present surface or line from the nodes around it, over all
   *  ranks. An object that keeps only a smaller distance from nodes can pass through there.
   *  Collective. */
  double widest_gap() const { return surface->widest_gap(); }

  /** What is up to this distance from an element will need all nodes of it as ghosts in the next
   *  run. For init_style() of a pair style, which does not know its cutoffs yet. */
  void will_be_reached_from(double distance) { reached_from = distance; }

  /** Faces of the elements of this rank, where these form a surface. */
  std::vector<MPM_NS::ElementBody::Face> faces() const { return body->faces(); }
  /** Faces of all ranks, on all ranks. Collective. */
  std::vector<MPM_NS::ElementBody::NumberedFace> all_faces() const;

 private:
  MPMSetUp set_up;
  int dim;                // of space
  int max_of_node = 0;    // largest number of elements that belong to one node
  bigint nelements;       // of the mesh
  ElementNodes nodes;
  bool has_lattice = true;      // does a fix mpm move the nodes?
  MPMUncoupled uncoupled;       // other matter, if none does
  double reached_from = 0.0;    // see will_be_reached_from()
  bool warned_slack = false;    // in this run
  bool may_leak = false;        // is other matter on the lattice of a surface, without a warning?
  double spacing_of_field = 0.0;
  double spent = 0.0;    // plastic and other dissipated work without a lattice, this rank's share
  class FixMPMMaterial *material;    // found again at the start of each run
  std::string variables;             // names of its history variables, in the order of the pool
  struct MPMPoints *points;
  std::unique_ptr<MPM_NS::ElementBody> body;    // the elements of this rank
  std::unique_ptr<ElementForces> internal;      // strain, stress, and forces of these
  std::unique_ptr<ElementSurface> surface;      // that they form, and the pressure on it

  double *first, *count;       // [n] range of the elements of an atom in the rows of the body
  int width;                   // of rows of sums
  std::vector<double> sums;    // forces and averages of nodes
  std::vector<double> force_on;
  std::unique_ptr<ElementTangents> tangents;    // after a trial motion
  std::vector<double> motion, sent;    // [local and ghost][3] trial displacements; for messages

  std::string names_of_history() const;
  double largest_extent() const;
  void make_elements(const MPM_NS::Mesh &);
  /** Puts rows in the order of the atoms that own them, without those that none owns. */
  void sort_rows();
  int find_image(int i, int j) const;
  void find_nodes();
  void compute(bool starting);
  void give_means_to_nodes();
  void check_free_dt();
  void look_for_gaps(bool starting);
  void keep_spent(const std::function<void()> &strain);
  void take_motion(const double *u);
  template <class Add> void add_over_ranks(double *to, const Add &add);
  double gas_frequency() const;
};

}    // namespace LAMMPS_NS
#endif
#endif
