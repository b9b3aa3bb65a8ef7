/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_BODY_H
#define LMP_MPM_HEAT_BODY_H

#include "mpm_diffusion_solver.h"
#include "mpm_node_profile.h"
#include "pointers.h"

#include <array>
#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMConduction;
class MPMField;

/** Activates the blocks around this one. */
void activate_blocks_around(MPMField &, const int *block);

/** Where the surface of a field is at its nodes, and heat that comes in through it there. */
class MPMHeatBody : protected Pointers {
 public:
  static constexpr int MOST = 4;

  /** Nodes along an axis around a place where the surface is. */
  struct Line {
    int axis, n;
    int64_t node[MOST];
    double weight[MOST];    ///< of sum one
    double area;            ///< of the surface that belongs to the line, as seen along the axis
    double place;           ///< of that surface on the line, in node spacings
    double response;        ///< of the temperature there to heat: sum of weight^2/capacity
    double conducting;      ///< share of it where there is material that conducts
    double part;            ///< of the line that the body fills

    /** What an exchange with this stiffness is for a solver; none without stiffness. */
    void add_term(double stiffness, const MPMDiffusion::Term &) const;
  };

  MPMField &field;
  MPMConduction *const conduction;    ///< null: no material of the field conducts
  const MPMNodeProfile profile;

  MPMHeatBody(class LAMMPS *, MPMField &, MPMConduction *);

  /** Ranks need the nodes around those that their points reach: activates the blocks around this one. */
  void activate_around(const int *block) { activate_blocks_around(field, block); }
  void topology_changed() { listed = false; }

  /** Blocks in which the surface is wanted: [slot], and all of them. */
  std::vector<char> near;
  void begin_step();
  void want_all() { near.assign(near.size(), 1); }
  /** Sums over points in these blocks. Collective. */
  void find_surface();
  /** Of nodes: volume in cells, and sum of V grad N, which points out of the body; around an axis of symmetry for each unit of
   *  length around it. Total frame: of the reference configuration. */
  std::vector<double> share, gradient;

  /** The line along an axis through a place on it (in node spacings), base: a node of it; into: the unit normal
   *  into the body. False if there is no surface, or this rank does not have all nodes. */
  bool make_line(int axis, const int *base, double at, const double *into, Line &) const;
  /** Bernstein polynomials have two kinds of nodes: where a surface is, how large, and its normal are known of lines of quadratic
   *  B-splines on the same nodes, and spread() gives what belongs to such a line to those of the field around it. */
  bool spreads() const;
  struct Part {
    Line line;
    double area, share;    ///< of those of the whole line
  };
  bool spread(const int *base, double at, const double *into, const Line &whole,
              std::vector<Part> &) const;
  /** Its response, and weights without nodes that do not conduct, when capacities are known. False if none conducts. */
  bool find_response(Line &) const;
  /** What the weight of a node counts, as material there conducts: 1 down to half of its volume, and in proportion below, so
   *  that no node gets heat that it has no capacity for. */
  double conducting(int64_t node) const;
  /** Share of the heat that goes through a gap (in node spacings). */
  double touches(double gap) const;
  double temperature(const Line &) const;
  /** Rate of this temperature by all other heat. */
  double drift(const Line &) const;

  /** Edges: where lines of surfaces with different normals have nodes in common. All lines are noted, with the share of the surface that they
   *  stand for, those of faces of the box apart; then ranks are summed (collective). */
  void begin_edges();
  void note(const Line &, const double *into, double part);
  void note_face(int64_t node, int axis, double sign);
  void end_edges();
  /** Has a node lines of surfaces, and is it at an edge? */
  bool is_edge(int64_t node) const;
  bool is_edge(const Line &) const;

  /** A stage: heat that was given to lines goes to the rates of nodes. */
  void begin_stage();
  void give(const Line &, double power);
  void end_stage();

  /** Length around an axis of symmetry of the surface at a place on the line of nodes along an axis through a node (in node
   *  spacings); 1 without one. */
  double circle(int axis, const int *index, double at) const;

  /** Share of the function of a node along an axis that is inside of fixed faces of the box. */
  double room(int axis, int index) const;

  /** Has a node without a block no points on any rank? */
  bool knows_all() const;

  double memory_usage() const;

 private:
  bool listed = false;
  std::vector<std::array<int, 2>>
      images;                  // a block with images, and one with nodes of which they are
  std::vector<double> held;    // volume of nodes where share is that of other functions, spreads()
  std::vector<double> heat;
  std::vector<double> noted;    // [nnodes][NOTED] of edges
  enum { NORMAL, PARTS = 3, OF_SURFACES, NOTED };

  void list_images();
  double node_circle(int64_t node) const;
  double volume_of(int64_t node) const { return spreads() ? held[node] : share[node]; }
  bool weigh_by_functions(int first, double at, double part, double into, const double *w,
                          Line &) const;
};

/* ---------------------------------------------------------------------- */

/** Lines that several ranks know: each does an equal part of the work, so that together they do it once. Keys are
 *  node * dim + axis of the body. Collective. */
class MPMHeatShares {
 public:
  void begin(const MPMHeatBody &body);
  void count(int64_t key) { counts[key] = 1.0; }
  void sum(const MPMHeatBody &body);
  double of(int64_t key) const { return 1.0 / counts[key]; }

 private:
  std::vector<double> counts;
};

/** Of what goes through a surface with this normal, the part of the lines along an axis: these parts have the sum one, and
 *  lines that graze the surface have none. */
double heat_share_of_axis(const double *normal, int dim, int axis);

}    // namespace LAMMPS_NS
#endif
