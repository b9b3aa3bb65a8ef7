/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONDUCTION_H
#define LMP_MPM_CONDUCTION_H

#include "fix_mpm_material.h"
#include "material/material.h"
#include "mpm_cut_rooms.h"
#include "mpm_diffusion_solver.h"
#include "mpm_heat_faces.h"
#include "mpm_layer_mean.h"
#include "mpm_node_scalar.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** How temperatures go from nodes to points. */
struct MPMHeatTransfer {
  enum Kind { RELAX, PIC, AFFINE, XPIC };

  Kind kind = RELAX;
  int order = 1;    ///< terms of the inverse of the matrix of capacities, of XPIC
  double relax =
      1.0;    ///< how fast points take that of the nodes, in units of conduction over a cell

  /** Do points keep gradients of the temperature? */
  bool has_slopes() const { return kind == RELAX || kind == AFFINE; }
};

/** Conduction of heat between the points of one field: temperatures of the nodes, and their rates. The temperatures
 *  of all fields advance together (MPMSuperStep), as bodies may exchange heat. */
class MPMConduction : protected Pointers {
 public:
  using Heats = MPMHeatFaces::Heats;
  static constexpr int SOURCES = MPMHeatFaces::NFACE;    ///< place in Heats

  MPMField &field;
  MPMHeatFaces faces;
  MPMNodeScalar scalar;    ///< the temperature
  /** [nnodes] heat that nodes get from elsewhere in this step [energy], the same on all ranks that have the
   *  node; empty: none. */
  std::vector<double> given;
  double duration = 0.0;    ///< of the coming conduction [time]

  MPMConduction(class LAMMPS *, MPMField &, const MPMHeatTransfer &, const MPMHeatCondition *);

  /** Start of a run. surfaces: heat comes through surfaces other than faces of the box, too. told_of_layers: has a warning told of
   *  interfaces that have no means? */
  void init(double sigma, bool surfaces, bool &told_of_layers);

  /** A step, first part: temperatures of nodes. gradients: [n][dim] temperature gradients of points, null with
   *  the transfers pic and xpic. starts: the first call of find_rates() will be for these temperatures, but for those that faces hold.
   *  Returns the bound of the rates of conduction of this rank [1/time]. */
  double points_to_nodes(const MPMRows &gradients, bool starts);
  /** The same of a field of a body on several lattices (MPMHeatLevels), in parts: sums of this rank's points; when tied nodes have given
   *  theirs away, temperatures, and when tied nodes have theirs again, the bound. */
  void add_points(const MPMRows &gradients, bool starts);
  void sum_nodes() { scalar.sum_nodes(); }
  double end_nodes();
  /** Functions that points alone do not bound (shape linear): rows of the matrix of rates, in the place of rates, and what follows from
   *  them when they are those of all lattices: the bound. usual: that of nodes inside of a body. Collective. */
  bool is_bounded_by_rows() const;
  enum Left { ALL, AS_SHARES };    // of conductivities
  void add_rows(Left left = ALL);
  double most_of_rows() { return scalar.greatest_row(); }
  double bound_by_rows(double greatest_of_rank);
  /** The bound of the rates of conduction on all ranks. */
  void keep_rate(double conduction) { conducted = conduction; }
  double bound_of_rates() const { return conducted; }
  /** What surfaces at edges may have at the most: that bound, without what nodes with little capacity add to it where these get no
   *  heat through surfaces. */
  double rate_at_edges() const { return has_idle() ? std::min(conducted, usual_rate) : conducted; }
  /** Rates of the temperatures of the nodes by conduction and sources. source: [n] power per volume, or null.
   *  Adds the power of sources. Then add_given(). */
  void find_rates(const double *source, Heats &power);
  /** Heat from elsewhere. */
  void add_given();
  /** The same for small changes of the temperatures, by conduction alone: the changes of the rates. */
  void find_changes();
  /** What each point of this rank adds to the matrix of conduction, see MPMDiffusion::Term. */
  void each_term(const MPMDiffusion::Term &) const;
  /** Last part: temperatures of points; returns the heat that they have got. */
  double nodes_to_points(const MPMRows &gradients);
  /** Of points, each the greatest: what tells for how long conduction may wait. */
  struct Motion {
    static constexpr double NONE = -std::numeric_limits<double>::max();
    double speed = 0.0, change = 0.0;      ///< change: of the temperature in the last conduction
    double highest = NONE, less = NONE;    ///< temperature, and minus the temperature
  };
  /** Adds what points of this rank have. */
  void add_motion(Motion &) const;

  /** In a step without conduction: heat that nodes were given goes to points; returns what this rank's have got. Collective. */
  double keep_given();

  /** Adds heat of points of this rank, [n] of energy, to that of their nodes, by the weights of the shape functions.
   *  Collective; before points_to_nodes(). */
  void give(std::vector<double> &energy);

  const std::vector<double> &node_capacity() const { return scalar.capacity; }
  const std::vector<double> &node_volume() const { return scalar.volume; }
  /** Of nodes, see MPMSuperStep. */
  std::vector<double> &temperature = scalar.value, &rate = scalar.rate;

  /** Bernstein polynomials: the room of a point can be in a cell that the point is not in. */
  bool looks_beyond_points() const;
  void extend_topology();
  /** Bernstein polynomials: nodes with so little capacity that nothing flows there, and no heat may come in. */
  bool has_idle() const { return !idle.empty(); }
  bool is_idle(int64_t node) const { return has_idle() && idle[node]; }
  /** Capacities of nodes for heat through faces: none of these. */
  const std::vector<double> &face_capacity();
  /** Of nodes next to faces, with Bernstein polynomials: sums of V grad N over parts of rooms, which are integrals; around an axis of
   *  symmetry for each unit of length around it. Empty with other functions. */
  const std::vector<double> &face_gradient() const { return ends; }

  /** A gradient of the temperature of a point counts with this [energy/temperature]: 0 where it does not conduct. */
  double capacity_of(int i) const;
  /** Has it a material that melts? The same on all ranks. */
  bool melts() const;
  /** Points of this rank are partly molten: a front is on its way. */
  bool has_front() const;
  /** Capacity times temperature of all points of this rank [energy]. */
  double heat_of_points() const;
  /** The slowest at which heat crosses a cell [1/time]; that of all fields of a body, if it is one. */
  double crossing_rate() const;
  double slowest_crossing = 0.0;    ///< 0: its own

  double least_capacity = 0.0;    ///< per volume, of the materials that conduct; 0: there are none
  /** Bound of the rates of conduction for this rank's points [1/time]; tag: the point that limits it. Collective. */
  double greatest_rate_of_points(tagint &tag) const;
  /** The points are known. Without any that conduct, on any rank, there is nothing to do if it may rest. Collective. */
  void find_points(bool may_rest);
  /** Is there a material that conducts, whether or not the field has points of it now? */
  bool has_materials() const { return !thermals.empty(); }
  /** A material of the field conducts. */
  bool conducts() const { return active; }
  /** Points of the field, on any rank, are of a material that conducts, and others of one that does not. */
  bool conducts_in_part() const;
  double memory_usage() const;

 private:
  void find_ends();
  /** A material that conducts, and where its points have their temperature. */
  struct Thermal {
    const FixMPMMaterial *fix;
    int temperature, molten;    // columns of history
    bool varies;
    bool jumps;                // its conductivity depends on the temperature, and it melts
    MPM_NS::Conduction all;    // or the mean
    /** Of a point, which may be in the room. */
    const MPM_NS::Conduction &at(int i, MPM_NS::Conduction &room) const
    {
      if (!varies) return all;
      return room = fix->material->conduction(fix->history[i]);
    }
  };

  const MPMHeatTransfer &transfer;
  std::vector<Thermal> thermals;
  bool wants_volumes = false;
  double slowest = 0.0;    // smallest diffusivity of a material, by the ratio of capacities
  double steepest =
      0.0;    // of B-splines, see the top of mpm_conduction.cpp [1/area]; 0: not bounded by points alone
  double conducted = 0.0;    // limit of the last step
  double change = 0.0;       // of a temperature of points in the last conduction, the greatest
  bool total = false, active = false;

  std::vector<double> volumes;    // [n] of points in this step
  std::vector<char> warmed;       // [blocks] nodes of it were given heat
  std::vector<double> at_rest;    // [n][3] velocities of points that give heat, zero
  // [n] their temperatures by the nodes at its start, if the first rates are those of these temperatures; otherwise nodes keep them
  std::vector<double> seen;
  enum { OF_NODES, TO_BE_SEEN, SEEN } at_start = OF_NODES;
  std::unique_ptr<MPMLayerMean>
      layers;               // of materials that conduct differently; null: points have their own
  double greatest = 0.0;    // of all conductivities, with layers
  bool *told =
      nullptr;    // of interfaces without means: of the fix, as this is made anew for each run
  double fastest_point =
      0.0;    // of this step: the greatest rate, but for the factor of the functions
  bool simple = false,
       keeps = false;    // are rates those of capacities and volumes; before = value
  struct Range {
    double low, high;
  };
  // [n] temperatures of a node spacing around points of materials whose conductivity jumps, from the nodes' in a step to the
  // points'; empty: there are none
  std::vector<Range> ranges;
  std::vector<double>
      shares;    // [n] of their conductivity that is left, see row_bound(); empty: all. None of points in parts
  MPMCutRooms cuts;
  std::vector<double> ends;    // [nodes][3], see face_gradient()
  std::vector<char> idle;      // [nodes], empty: none
  double usual_rate = 0.0;     // bound of the rates of nodes inside of a body
  std::vector<double> capacity_at_faces;

  std::vector<signed char> present;    // [materials of the field]: has points here, on any rank
  const Thermal *thermal(const FixMPMMaterial *) const;
  std::size_t index_of(const FixMPMMaterial *) const;
  bool is_present(const Thermal &) const;
  void keep_present(const std::vector<signed char> &mine);
  double volume_of(int i) const;
  const MPM_NS::Conduction &conduction_of(const Thermal &, int i, MPM_NS::Conduction &room) const;
  void find_ranges();
  void tensor(const Thermal &, int i, double k[3][3]) const;
  bool is_plain() const;
  void conduct(const Thermal &, int first, int n, MPMNodeScalar::Rows q,
               Left left = AS_SHARES) const;
  void conduct_parts();
  void conduct_plainly(const Thermal &, int first, int n, double *factors) const;
  double greatest_possible() const;
  double bound(const Thermal &, int i, double volume) const;
  double steepness(int i) const;
  void init_layers();
  void find_unseen();
};

/** Conductivities of a material along the axes of a point with the deformation gradient F, which are the rows of n, unit
 *  vectors in space; all the same if the material is isotropic. */
void principal_conductivities(const MPM_NS::Conduction &, const double *F, double k[3],
                              double n[3][3]);

}    // namespace LAMMPS_NS
#endif
