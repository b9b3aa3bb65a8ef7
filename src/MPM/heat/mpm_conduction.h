/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONDUCTION_H
#define LMP_MPM_CONDUCTION_H

#include "diffusion/mpm_cut_domains.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "diffusion/mpm_layer_mean.h"
#include "diffusion/mpm_node_scalar.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_friction_heat.h"
#include "heat/mpm_heat_faces.h"
#include "material/material.h"
#include "solve/node_matrix.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** How points get temperatures from nodes. */
struct MPMHeatTransfer {
  enum Kind { RELAX, PIC, AFFINE, XPIC };

  Kind kind = RELAX;
  int order = 1;    ///< XPIC: terms of the series for the inverse of the capacity matrix
  /** RELAX: rate at which points take the temperature of nodes, in units of
   *  MPMConduction::crossing_rate(). */
  double relax = 1.0;

  /** Do points keep gradients of the temperature? */
  bool has_slopes() const { return kind == RELAX || kind == AFFINE; }
};

/** Conduction of heat between the points of one field: temperatures of the nodes and their rates.
 *  The temperatures of all fields advance together (MPMSuperStep), as bodies may exchange heat.
 *  Equations, transfers, and stability: see the top of mpm_conduction.cpp. */
class MPMConduction : protected Pointers {
 public:
  using Heats = MPMHeatFaces::Heats;
  static constexpr int SOURCES = MPMHeatFaces::NFACE;    ///< place of the sources in Heats

  MPMField &field;
  MPMHeatFaces faces;
  MPMNodeScalar scalar;    ///< the temperature
  /** [nnodes] heat that nodes get from other physics in this step [energy], the same on all ranks
   *  that have the node; empty: none. */
  std::vector<double> given;
  double duration = 0.0;    ///< of the coming conduction step [time]

  MPMConduction(class LAMMPS *, MPMField &, const MPMHeatTransfer &, const MPMHeatCondition *);

  /** Start of a run. surfaces: heat also comes through surfaces other than faces of the box.
   *  warned_of_layers: set once a warning about interfaces without mean conductivities has been
   *  printed. */
  void init(double sigma, bool surfaces, bool &warned_of_layers);

  /** First part of a step: temperatures of nodes. gradients: [n][dim] temperature gradients of
   *  points, null with the transfers pic and xpic. starts: the first call of find_rates() will be
   *  for these temperatures, except those that faces prescribe. Returns the bound of the rates of
   *  conduction of this rank [1/time]. */
  double points_to_nodes(const MPMRows &gradients, bool starts);
  /** points_to_nodes() in parts, for a body on several lattices (MPMHeatLevels). add_points(): sums
   *  over the points of this rank. sum_nodes(): temperatures, after tied nodes have given their
   *  sums to their parents. end_nodes(): the bound, after tied nodes have got their
   *  temperatures. */
  void add_points(const MPMRows &gradients, bool starts);
  void sum_nodes() { scalar.sum_nodes(); }
  double end_nodes();
  /** Shape functions for which points alone give no bound (shapes linear and bernstein): rate gets
   *  the sums of absolute values of the rows of the matrix of rates, and when these have the
   *  contributions of all lattices, bound_by_rows() returns the bound that follows [1/time]. Points
   *  conduct less where nodes with little capacity would exceed four times the bound of nodes
   *  inside of a body. Collective. */
  bool is_bounded_by_rows() const { return !field.boxes && !field.domains && steepest == 0.0; }
  enum Left { ALL, AS_SHARES };    // part of the conductivities that counts
  void add_rows(Left left = ALL);
  double most_of_rows() { return scalar.greatest_row(); }
  double bound_by_rows(double greatest_of_rank);
  /** The bound of the rates of conduction on all ranks [1/time]. */
  void keep_rate(double conduction) { conducted = conduction; }
  double bound_of_rates() const { return conducted; }
  /** Largest rate that surfaces at edges may have: the bound of rates; if nodes with little
   *  capacity get no heat through surfaces, without their contribution to it. */
  double rate_at_edges() const { return has_idle() ? std::min(conducted, usual_rate) : conducted; }
  /** Rates of the temperatures of the nodes, or of small changes of these, by conduction and
   *  sources. source: [n] power per volume, or null; the first call in a step is for temperatures.
   *  Adds the power of sources to power. To be followed by add_given(). */
  void find_rates(const double *source, Heats &power);
  /** How often find_rates() will be called in this step. If it is often, rates come from the matrix
   *  of conduction, except with domains and on several lattices. */
  void expect_rates(int number);
  /** Adds the rates by heat from other physics (given). */
  void add_given();
  /** Calls the argument with the contribution of each point of this rank to the matrix of
   *  conduction, see MPMDiffusion::Term. */
  void each_term(const MPMDiffusion::Term &) const;
  /** The matrix of this rank's points, if rates come from it; otherwise null. */
  const MPM_NS::NodeMatrix *kept_matrix() const { return made ? &matrix : nullptr; }
  /** Transfer relax, before nodes_to_points(): what points of some materials keep decays faster
   *  than what all of them do. Do the materials of the field differ so? The same on all ranks. */
  bool has_faster() const;
  /** Leaves in rate what the heat that these points give to their nodes changes the temperatures
   *  there by; on the lattice of a level the sums over the points of this rank. Collective. */
  void find_faster();
  /** Last part of a step: temperatures of points; returns the heat that they have got [energy]. */
  double nodes_to_points(const MPMRows &gradients);
  /** Largest values of points, which determine for how long conduction may wait. */
  struct Motion {
    static constexpr double NONE = -std::numeric_limits<double>::max();
    double speed = 0.0, change = 0.0;    ///< change: of the temperature in the last conduction step
    double highest = NONE, less = NONE;    ///< temperature, and minus the temperature
  };
  /** Includes the points of this rank in these maxima. */
  void add_motion(Motion &) const;

  /** In a step without conduction: moves the heat in given to the points; returns the heat that the
   *  points of this rank have got [energy]. Collective. */
  double keep_given();

  /** Adds heat of the points of this rank, [n] energy, to given at their nodes, by the weights of
   *  the shape functions. To be called before points_to_nodes(). Collective. */
  void give(std::vector<double> &energy);

  /** [nnodes] capacities [energy/temperature] and volumes of nodes. */
  const std::vector<double> &node_capacity() const { return scalar.capacity; }
  const std::vector<double> &node_volume() const { return scalar.volume; }
  /** [nnodes] temperatures of nodes and their rates, for MPMSuperStep. */
  std::vector<double> &temperature = scalar.value, &rate = scalar.rate;

  /** Bernstein polynomials: the box of a point (MPMCutDomains) can reach into a cell that the point
   *  is not in. */
  bool looks_beyond_points() const { return field.options.shape == MPM_NS::BERNSTEIN; }
  void extend_topology();
  /** Bernstein polynomials: idle nodes have so little capacity that nothing is conducted there, and
   *  no heat may come in. */
  bool has_idle() const { return !idle.empty(); }
  bool is_idle(int64_t node) const { return has_idle() && idle[node]; }
  /** Capacities of nodes for heat through faces: zero at idle nodes. */
  const std::vector<double> &face_capacity();
  /** [nnodes][3] with Bernstein polynomials, of nodes next to faces: sums of V grad N over the
   *  parts of boxes of points, which are integrals; around an axis of symmetry per unit of length
   *  around it. Empty with other functions. */
  const std::vector<double> &face_gradient() const { return ends; }

  /** Capacity of point i [energy/temperature], the weight of its temperature gradient; 0: it does
   *  not conduct. */
  double capacity_of(int i) const;
  /** Has the field a material that melts? The same on all ranks. */
  bool melts() const;
  /** Are points of this rank partly molten, so that a melting front is moving? */
  bool has_front() const;
  /** Sum of capacity times absolute temperature over all points of this rank [energy]. */
  double heat_of_points() const;
  /** Rate at which heat crosses a cell in the material that conducts least [1/time]. */
  double crossing_rate() const { return slowest / (field.lattice.h * field.lattice.h); }
  double slowest_crossing = 0.0;    ///< lowest rate of the lattices of a body; 0: own
  /** Share of its own rate at which a material relaxes where capacities have this ratio. */
  static double share_of_own_rate(double ratio);
  double widest_cell = 0.0;    ///< largest node spacing of the lattices of a body; 0: own

  double least_capacity = 0.0;    ///< per volume, of the materials that conduct; 0: there are none
  /** Bound of the rates of conduction for this rank's points [1/time]; tag: the point that limits
   *  it. Collective. */
  double greatest_rate_of_points(tagint &tag) const;
  /** To be called when the points are known. If no point on any rank conducts and may_rest, the
   *  field becomes inactive. Collective. */
  void find_points(bool may_rest);
  /** Is there a material that conducts, whether or not the field has points of it now? */
  bool has_materials() const { return !thermals.empty(); }
  /** Is there anything to conduct, see find_points()? */
  bool conducts() const { return active; }
  /** Has the field, on any rank, points of materials that conduct and of materials that do not? */
  bool conducts_in_part() const;
  double memory_usage() const;

 private:
  void find_ends();
  /** A material that conducts, and where its points keep their temperature. */
  struct Thermal {
    const FixMPMMaterial *fix;
    int temperature, molten;    // columns of history
    bool varies;                // from point to point
    bool jumps;                 // its conductivity depends on the temperature, and it melts
    MPM_NS::Conduction all;     // of all points; if it varies, the mean
    double diffusivity;         // of the mean, along the axis that conducts least
    /** Values of point i. buffer: memory for these if they vary. */
    const MPM_NS::Conduction &at(int i, MPM_NS::Conduction &buffer) const
    {
      if (!varies) return all;
      return buffer = fix->material->conduction(fix->history[i]);
    }
  };

  const MPMHeatTransfer &transfer;
  std::vector<Thermal> thermals;
  bool wants_volumes = false;
  // smallest diffusivity of a material, times the ratio of the least and the greatest capacity
  double slowest = 0.0;
  double own_share = 1.0;    // of its own rate that a material has, see share_of_own_rate()
  // largest sum of (dN/dx)^2/N of B-splines, see the top of mpm_conduction.cpp [1/area]; 0: no
  // bound by points alone
  double steepest = 0.0;
  double conducted = 0.0;    // bound of rates in the last step [1/time]
  double change = 0.0;    // largest change of a temperature of points in the last conduction step
  bool total = false, active = false;

  std::vector<double> volumes;    // [n] of points in this step
  std::vector<char> warmed;       // [blocks] were nodes of the block given heat?
  std::vector<double> at_rest;    // [n][3] zero velocities of points that give heat
  // [n] temperatures of nodes at the points at the start of the step, if the first rates are found
  // for these temperatures; otherwise nodes keep them
  std::vector<double> seen;
  enum { OF_NODES, TO_BE_SEEN, SEEN } at_start = OF_NODES;
  // mean conductivities next to interfaces of materials that conduct differently; null: points have
  // their own
  std::unique_ptr<MPMLayerMean> layers;
  double greatest = 0.0;    // largest of all conductivities, with layers
  // has a warning been printed about interfaces without means? In the fix, as this object is made
  // anew for each run
  bool *warned = nullptr;
  double fastest_point = 0.0;    // largest rate in this step, without the factor of the functions
  // do rates of points follow from capacities and volumes alone; do nodes keep their temperatures
  // of the start of the step?
  bool simple = false, keeps = false;
  // see expect_rates(); is it wanted, and is it that of this step? Rates by sources in this step
  MPM_NS::NodeMatrix matrix;
  bool wanted = false, made = false;
  std::vector<double> rate_by_sources;
  double power_of_sources = 0.0;
  struct Range {
    double low, high;
  };
  // [n] in a step: range of the temperatures of nodes within a quarter of a node spacing of points
  // of materials whose conductivity jumps; empty: there are none
  std::vector<Range> ranges;
  // [n] share of their conductivity that is left to points, see bound_by_rows(), zero for points in
  // parts; empty: all
  std::vector<double> shares;
  MPMCutDomains cuts;
  std::vector<double> ends;    // [nodes][3], see face_gradient()
  std::vector<char> idle;      // [nodes] is the node idle? Empty: none is
  double usual_rate = 0.0;     // bound of the rates of nodes inside of a body [1/time]
  std::vector<double> capacity_at_faces;

  std::vector<signed char> present;    // [materials of the field] has it points on any rank?
  const Thermal *thermal(const FixMPMMaterial *) const;
  std::size_t index_of(const FixMPMMaterial *fix) const
  {
    return std::find(field.materials.begin(), field.materials.end(), fix) - field.materials.begin();
  }
  bool is_present(const Thermal &t) const { return present[index_of(t.fix)]; }
  void keep_present(const std::vector<signed char> &all);
  double crossings() const;
  double crossings_of(const Thermal &) const;
  double volume_of(int i) const;
  const MPM_NS::Conduction &conduction_of(const Thermal &, int i, MPM_NS::Conduction &buffer) const;
  void find_ranges();
  void tensor(const Thermal &, int i, double k[3][3]) const;
  void make_matrix(const double *source);
  bool is_plain() const;
  double conducting_volume(int i, Left left) const
  {
    return shares.empty() || left == ALL ? volumes[i] : volumes[i] * shares[i];
  }
  void conduct(const Thermal &, int first, int n, MPMNodeScalar::Rows q,
               Left left = AS_SHARES) const;
  void conduct_parts();
  double greatest_possible() const;
  double bound(const Thermal &, int i, double volume) const;
  double steepness(int i) const;
  void init_layers();
  void find_unseen();
};

}    // namespace LAMMPS_NS
#endif
