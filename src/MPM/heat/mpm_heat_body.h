/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_BODY_H
#define LMP_MPM_HEAT_BODY_H

#include "diffusion/mpm_diffusion_solver.h"
#include "diffusion/mpm_node_profile.h"
#include "field/node_line.h"
#include "pointers.h"

#include <array>
#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMConduction;
class MPMField;

/** Activates the blocks of a field around this one. */
void activate_blocks_around(MPMField &, const int *block);

/** Surface of a field as seen from its nodes, and the heat that comes in through it. */
class MPMHeatBody : protected Pointers {
 public:
  /** Nodes along an axis around a place on the surface; weights have the sum one. */
  struct Line : NodeLine {
    double area;        ///< area of the surface that belongs to the line, projected along the axis
    double place;       ///< position of the surface on the line, in node spacings
    double response;    ///< response of the temperature there to heat: sum of weight^2/capacity
    double conducting;    ///< share of the line with material that conducts
    double part;          ///< part of the line that the body fills

    /** Passes the term of an exchange with this stiffness to a solver; nothing if the stiffness is not
     *  positive. */
    void add_term(double stiffness, const MPMDiffusion::Term &) const;
  };

  MPMField &field;
  MPMConduction *const conduction;    ///< null: no material of the field conducts
  const MPMNodeProfile profile;

  MPMHeatBody(class LAMMPS *, MPMField &, MPMConduction *);

  /** Activates the blocks around this one: ranks need the nodes around those that their points reach. */
  void activate_around(const int *block) { activate_blocks_around(field, block); }
  /** The blocks of the field are new. */
  void topology_changed() { listed = false; }

  /** [slot] blocks in which the surface is wanted. want_all() marks all blocks. */
  std::vector<char> near;
  /** Start of a step: no block is wanted yet. */
  void begin_step();
  void want_all() { near.assign(near.size(), 1); }
  /** Finds the surface by sums over points in these blocks. Collective. */
  void find_surface();
  /** Of nodes: volume in units of cells, and the sum of V grad N, which points out of the body. Around an axis
   *  of symmetry, both are per unit of length around it. Total frame: in the reference configuration. */
  std::vector<double> share, gradient;

  /** Finds the line of nodes along an axis through the place at (in node spacings). base: a node of the line;
   *  into: the unit normal into the body. Returns false if there is no surface, or if this rank does not have
   *  all nodes. */
  bool make_line(int axis, const int *base, double at, const double *into, Line &) const;
  /** Bernstein polynomials have two kinds of nodes. The place, area, and normal of a surface are then known
   *  from lines of quadratic B-splines on the same nodes, and spread() distributes the share of such a line
   *  over the lines of the field around it. */
  bool spreads() const;
  struct Part {
    Line line;
    double area, share;    ///< area and share, relative to those of the whole line
  };
  bool spread(const int *base, double at, const double *into, const Line &whole,
              std::vector<Part> &) const;
  /** Finds the response of a line and sets the weights of nodes that do not conduct to zero, once capacities
   *  are known. Returns false if no node conducts. */
  bool find_response(Line &) const;
  /** Factor of the weight of a node according to the conducting material there: 1 down to half of the volume of
   *  the node, and in proportion below, so that no node gets heat that it has no capacity for. */
  double conducting(int64_t node) const;
  /** Share of the heat that passes a gap (in node spacings). */
  double touches(double gap) const;
  /** Temperature of the surface at a line. */
  double temperature(const Line &) const;
  /** Rate of this temperature due to all other heat. */
  double drift(const Line &) const;

  /** Finds edges, where lines of surfaces with different normals have nodes in common. All lines are noted,
   *  each with the share of the surface that it represents; lines of faces of the box are noted separately.
   *  end_edges() sums over ranks (collective). */
  void begin_edges();
  void note(const Line &, const double *into, double part);
  void note_face(int64_t node, int axis, double sign);
  void end_edges();
  /** Does the node belong to lines of surfaces, and is it at an edge? */
  bool is_edge(int64_t node) const;
  bool is_edge(const Line &) const;

  /** One stage: give() collects heat at lines, and end_stage() adds it to the rates of nodes. */
  void begin_stage();
  void give(const Line &, double power);
  void end_stage();

  /** Length of the circle around the axis of symmetry on which the surface lies. The place at (in node
   *  spacings) is on the line of nodes along an axis through the node index. 1 without an axis of symmetry. */
  double circle(int axis, const int *index, double at) const;

  /** Share of the function of a node along an axis that lies inside of fixed faces of the box. */
  double room(int axis, int index) const;

  /** Does a missing block mean that no rank has points there? True on a single rank. */
  bool knows_all() const;

  double memory_usage() const;

 private:
  bool listed = false;
  std::vector<std::array<int, 2>> images;    // a block with images, and a block with their nodes
  // volume of nodes if spreads(): share is then that of other functions
  std::vector<double> held;
  std::vector<double> heat;
  std::vector<double> noted;    // [nnodes][NOTED] sums for edges
  enum { NORMAL, PARTS = 3, OF_SURFACES, NOTED };

  void list_images();
  double node_circle(int64_t node) const;
  double volume_of(int64_t node) const { return spreads() ? held[node] : share[node]; }
  bool weigh_by_functions(int first, double at, double part, double into, const double *w,
                          Line &) const;
};

/* ---------------------------------------------------------------------- */

/** Divides the work on lines that several ranks know into equal parts, so that together the ranks do it once.
 *  Keys are node * dim + axis of the body. Collective. */
class MPMHeatShares {
 public:
  /** Resets the counts. */
  void begin(const MPMHeatBody &body);
  /** This rank knows the line. */
  void count(int64_t key) { counts[key] = 1.0; }
  /** Sums the counts over ranks. Collective. */
  void sum(const MPMHeatBody &body);
  /** Share of this rank in the work on a line. */
  double of(int64_t key) const { return 1.0 / counts[key]; }

 private:
  std::vector<double> counts;
};

/** Share of the flow through a surface with this normal that the lines along an axis carry. The sum of the
 *  shares is one; lines that graze the surface have none. */
double heat_share_of_axis(const double *normal, int dim, int axis);

}    // namespace LAMMPS_NS
#endif
