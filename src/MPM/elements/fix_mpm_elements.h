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

#include "base/mpm_state.h"
#include "declare/option.h"
#include "elements/mpm_thin_body.h"
#include "field/mpm_internal_force.h"
#include "material/plane_stress.h"
#include "mesh/bending.h"
#include "mesh/gmsh.h"
#include "mesh/near_nodes.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
struct ElementRule;
}    // namespace MPM_NS

namespace LAMMPS_NS {

/** Keywords of fix mpm/elements. */
struct MPMElementsOptions {
  std::string file, part;     ///< part: physical group of the mesh; empty: all of it
  bool fbar = false;          ///< average the volume over an element
  MPMThinBody thin;           ///< surfaces or lines
  bool compression = true;    ///< do surfaces and lines resist compression? else they wrinkle
  enum Bending { NONE, CONSTANT, LINEAR };
  Bending bending =
      NONE;    ///< resistance to bending: none, or by constant or linear curvatures in triangles
  bool curved = false;      ///< is a closed surface curved between its nodes?
  bool has_axes = false;    ///< are axes of the material given?
  double axes[6] = {};      ///< in surfaces: axis 1, and a vector on the side of axis 2

  MPM_NS::Options declare(int dim);
};

/** Interface for the pressure on one side of a surface of elements. */
class MPMElementsPressure {
 public:
  /** Pressure for the enclosed volume (0: not closed) and the area of the surface. Collective, in each
   *  step. starting: at the setup of a run. */
  virtual double on_surface(double volume, double area, bool starting) = 0;
  /** Is the pressure independent of volume and area? */
  virtual bool is_given() const = 0;
  /** Decrease of the pressure with the volume, -dp/dV, at this volume. */
  virtual double stiffness(double volume) const = 0;

 protected:
  ~MPMElementsPressure() = default;    // not deleted through this interface
};

/** Finite elements whose nodes are material points. The points have no stress of their own: the
 *  internal force is integrated over the elements (total Lagrangian) and added to atom->f. The
 *  points are moved by fix mpm or, without a lattice, by fix nve. This is the generalized particle
 *  in cell method of V.P. Nguyen, A. de Vaucorbeil, C. Nguyen-Thanh, T.K. Mandal, Comput. Methods
 *  Appl. Mech. Eng. 371 (2020) 113308.
 *
 *  An element belongs to one of its nodes and migrates with it; the others may be ghosts.
 */
class FixMPMElements : public FixMPMState, public MPMInternalForce, private MPMElementsOptions {
 public:
  FixMPMElements(class LAMMPS *, int, char **);
  ~FixMPMElements() override;
  int setmask() override { return FixConst::POST_NEIGHBOR | FixConst::POST_FORCE; }
  void init() override;
  void setup_post_neighbor() override { find_nodes(); }
  void setup(int) override
  {
    compute(true);
    if (!has_lattice) check_free_dt();
  }
  void post_neighbor() override
  {
    find_nodes();
    if (!has_lattice) check_free_dt();    // with a lattice, fix mpm checks the time step
  }
  void post_force(int) override { compute(false); }
  double compute_scalar() override { return (double) nelements; }
  double compute_vector(int) override;
  double memory_usage() override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  void unpack_restart(int, int) override;
  int size_restart(int i) override { return 2 + (int) count[i] * stride; }
  int maxsize_restart() override { return 2 + max_of_node * stride; }
  void write_restart(FILE *) override;
  void restart(char *) override;
  int pack_reverse_comm(int, int, double *) override;
  void unpack_reverse_comm(int, int *, double *) override;

  int group_of_points() const override { return groupbit; }
  bool on_lattice() const override { return has_lattice; }

  /** Sets the pressure, which pushes a closed surface outward, and an open one toward the side from which its elements
   *  go around counterclockwise (in 2d: to the right of lines). Valid until the next init(). closed: an error if the
   *  surface encloses no volume. */
  void set_pressure(MPMElementsPressure *, bool closed);

  /** Energy stored by the elements of this rank [pressure * volume]; on the first rank, minus the work done so far by
   *  the pressure in a closed surface. */
  double stored_energy() const override;

  /** Forces of the elements and of the pressure on the points of this rank, [nlocal][3], as added to atom->f. */
  const double *forces() const override { return force_on.data(); }

  /** From 2/omega with a bound of the highest frequency omega; speed is 0 if the gas in a closed surface contributes
   *  more than waves. */
  double stable_dt(tagint &tag, double &speed) const override;
  void check_dt() const override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  bool forces_after(const double *u, double *force, double &carried) override;
  double differentiate(const double *u) override;
  void add_change(const double *du, double *dforce) override;
  void add_blocks(double *blocks) override;
  double asymmetry() const override;

  /** Message on a feature that trial motions do not support, with advice; null: all is supported. */
  const char *beyond_trials() const
  {
    return bending ? "bending: use explicit steps"
        : pressure && curved
        ? "the pressure inside of a surface that is curved: use curved no, or explicit steps"
        : pressure && !pressure->is_given()
        ? "how the pressure of the gas in it changes: use fix mpm/airbag pressure, or explicit "
          "steps"
        : nullptr;
  }

  /** Are the elements a surface or a line? */
  bool is_thin() const { return (bool) thin; }

  /** ID of a fix mpm that moves nodes, or null. Collective. */
  const char *field_of_nodes() const;

  /** Smallest ID and number of the nodes; their IDs are consecutive. */
  tagint first_node() const { return ids.low; }
  bigint number_of_nodes() const { return ids.n; }

  /** Undeformed edges of all elements and diagonals of quadrangles, on all ranks. Nodes are numbered from the first one
   *  on. An edge is listed once for each of its elements. Collective. */
  std::vector<MPM_NS::NearNodes::Edge> edges() const;

  /** Largest distance of a place on the present surface or line from the nodes around it, over all ranks. An object
   *  that keeps only a smaller distance from nodes can pass through there. Collective. */
  double widest_gap() const;

  /** Largest distance between two nodes of an element on all ranks, with room for further deformation. Collective. */
  double largest_extent() const;

  /** Face of a surface (in 2d: a line): an element or half of a quadrangle. */
  struct Face {
    bigint element;    ///< its label
    int part;          ///< 0 or 1: half of a quadrangle
    int node[3];       ///< local indices, in the order of the element
  };
  /** Faces of the elements of this rank. */
  std::vector<Face> faces() const;

  /** Face with nodes numbered from the first one on. */
  struct NumberedFace {
    bigint element, part;
    int64_t node[3];
  };
  /** Faces of all ranks, on all ranks. Collective. */
  std::vector<NumberedFace> all_faces() const;

 private:
  struct Work;
  struct IDs {    // number and range of the IDs of nodes
    bigint n;
    tagint low, high;
  };

  int dim, along;     // dimensions of space and of elements
  int maxnode = 0;    // of the largest element of the mesh
  int nhistory, stride;
  int max_of_node = 0;    // largest number of elements that belong to one node
  bigint nelements;       // of the mesh
  MPM_NS::SurfaceKind kind = {};
  MPMElementsPressure *pressure = nullptr;
  double side =
      0.0;    // 1: the pressure pushes toward the side from which elements go around counterclockwise; -1: away from it; 0: unknown
  IDs ids;
  bool has_lattice = true;      // does a fix mpm move the nodes?
  bool warned_slack = false;    // in this run
  double spent = 0.0;    // plastic and other dissipated work without a lattice, this rank's share
  double pressure_work = 0.0, volume_before = 0.0, pressure_before = 0.0;    // of a closed surface
  double stiffness = 0.0, nu = 0.0, bending_frequency = 0.0;                 // of bending
  double shortest = 0.0;             // length of the smallest element, for artificial viscosity
  class FixMPMMaterial *material;    // found again at the start of each run
  std::string variables;             // names of its history variables, in the order of the pool
  struct MPMPoints *points;
  std::unique_ptr<Work> work;
  std::unique_ptr<MPM_NS::PlaneStress> plane_stress;    // of surfaces and lines

  // A row of the pool: label and type of an element, tags of its nodes [maxnode], their reference
  // positions relative to the first one [maxnode][dim], and for each integration point F [9],
  // tau [6], history, and, for surfaces and lines, the gradient of the motion along them [9]. Parts that
  // bend have rows of their own, with the square of their extent and a BentTriangle, BentLine, or SharedStrain in
  // place of positions and integration points.

  double *first, *count;    // [n] range of the elements of an atom in the pool
  std::vector<double> pool;
  std::vector<std::array<int, MPM_NS::PATCH_NODES>> nodes;    // local indices, after find_nodes()
  int width;                                                  // of rows of sums
  std::vector<double> sums;                                   // forces and averages of nodes
  std::vector<double> force_on;
  // trial motions: [local and ghost][3] displacements; values to send to other ranks;
  // [element][maxnode dim][maxnode dim] forces by a motion of each component of each node
  std::vector<double> motion, sent, tangents;
  int shifted_node = -1;                // node of each element that is shifted; -1: none
  double shift[3] = {0.0, 0.0, 0.0};    // its shift
  bool *trying = nullptr;               // set to whether all is finite; null: no trial

  double *row(std::size_t e) const { return const_cast<double *>(pool.data()) + e * stride; }
  double *state_of(double *row, int q) const
  {
    return row + 2 + maxnode * (1 + dim) + q * point_size();
  }
  double &extent_of(double *row) const { return row[2 + maxnode]; }
  double *bent_of(const double *row) const { return const_cast<double *>(row) + 3 + maxnode; }
  int point_size() const { return 15 + nhistory + (thin ? 9 : 0); }
  /** Area of the curved surface divided by that of the flat element. */
  double swell_of(const double *row) const { return curved ? row[stride - 1] : 1.0; }
  double *motion_of(double *state) const { return state + 15 + nhistory; }    // of surfaces, lines
  FixMPMMaterial *find_material() const;
  std::string names_of_history() const;
  bool has_points_of(int other_groupbit) const;
  void check_nodes() const;
  void check_fields() const;
  void make_elements(const MPM_NS::Mesh &);
  IDs count_nodes() const;
  template <class T> std::vector<T> gather(const std::vector<T> &mine) const;
  void find_nodes();
  void compute(bool starting);
  void load(Work &, std::size_t e, bool moved) const;
  double gradients(const MPM_NS::ElementRule &, int q, const double (*x)[3], double (*g)[3]) const;
  void check_frame(const double (*frame)[3], bigint label) const;
  void find_frame(const double (*g)[3], double (*frame)[3]) const;
  void load_thin(MPM_NS::PlaneStress::Point &, const double (*x)[3], const double (*g)[3],
                 int nnode, const double *state) const;
  void find_motion(const double (*x)[3], const double (*g)[3], int nnode, double *to) const;
  void map_gradients(Work &);
  void find_stretches(Work &);
  void define_plane_stress();
  template <class Visit> void for_batches(bool moved, Visit) const;
  void material_update(Work &, bool starting);
  void check_free_dt();
  void keep_spent(const std::function<void()> &strain);
  void find_forces(const Work &, int start, const MPM_NS::ElementRule &, double (*f)[3]) const;
  void for_trial_batches(const std::function<void(Work &)> &) const;
  int nodes_of(const double *row) const;
  void take_motion(const double *u);
  void bring_home(double *to);
  void find_moved(std::size_t e, bool moved, double (*x)[3]) const;
  void add_pressure_after(bool moved, double sign);
  void differentiate_pressure();
  template <class Use> bool try_elements(const Use &use);
  void add_sums(Work &);
  void add_pressure(bool starting);
  template <class Visit> void for_faces(Visit) const;
  template <class Visit> void for_curved_edges(Visit) const;
  void define_bending(double *row, const double (*X)[3], bool inside, bigint &rough) const;
  template <class Visit> void for_bending(Visit) const;
  double bend(const double *row, const double (*x)[3], double (*f)[3]) const;
  void add_bending();
  MPM_NS::BentTriangle bent_triangle(const double *row) const;
  double largest_bending_frequency() const;
  double gas_frequency() const;
};

}    // namespace LAMMPS_NS
#endif
#endif
