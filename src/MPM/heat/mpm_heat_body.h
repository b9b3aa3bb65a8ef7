/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_BODY_H
#define LMP_MPM_HEAT_BODY_H

#include "base/mpm_first_note.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "diffusion/mpm_node_profile.h"
#include "field/mpm_field.h"
#include "field/node_line.h"
#include "pointers.h"

#include <array>
#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMConduction;

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

    /** Passes the term of an exchange with this stiffness to a solver; nothing if the stiffness is
     *  not positive. */
    void add_term(double stiffness, const MPMDiffusion::Term &) const;
  };

  MPMField &field;
  MPMConduction *const conduction;    ///< null: no material of the field conducts
  const MPMNodeProfile profile;

  MPMHeatBody(class LAMMPS *, MPMField &, MPMConduction *);

  /** The blocks of the field are new. */
  void topology_changed() { listed = false; }

  /** [slot] blocks in which the surface is wanted. want_all() marks all blocks. */
  std::vector<char> near;
  /** Start of a step: no block is wanted yet. */
  void begin_step();
  void want_all() { near.assign(near.size(), 1); }
  /** Finds the surface by sums over points in these blocks. Collective. */
  void find_surface();
  /** Of nodes: volume in units of cells, and the sum of V grad N, which points out of the body.
   *  Around an axis of symmetry, both are per unit of length around it. Total frame: in the
   *  reference configuration. */
  std::vector<double> share, gradient;

  /** Finds the line of nodes along an axis through the place at (in node spacings). base: a node of
   *  the line; into: the unit normal into the body. Returns false if there is no surface, or if
   *  this rank does not have all nodes. */
  bool make_line(int axis, const int *base, double at, const double *into, Line &) const;
  /** Bernstein polynomials have two kinds of nodes. The place, area, and normal of a surface are
   *  then known from lines of quadratic B-splines on the same nodes, and spread() distributes the
   *  share of such a line over the lines of the field around it. */
  bool spreads() const { return field.options.shape == MPM_NS::BERNSTEIN; }
  struct Part {
    Line line;
    double area, share;    ///< area and share, relative to those of the whole line
  };
  bool spread(const int *base, double at, const double *into, const Line &whole,
              std::vector<Part> &) const;
  /** Finds the response of a line and sets the weights of nodes that do not conduct to zero, once
   *  capacities are known. Returns false if no node conducts. */
  bool find_response(Line &) const;
  /** Factor of the weight of a node according to the conducting material there: 1 down to half of
   *  the volume of the node, and in proportion below, so that no node gets heat that it has no
   *  capacity for. */
  double conducting(int64_t node) const;
  /** Share of the heat that passes a gap (in node spacings). */
  double touches(double gap) const;
  /** Temperature of the surface at a line. */
  double temperature(const Line &) const;
  /** Rate of this temperature due to all other heat. */
  double drift(const Line &) const;

  /** Finds edges, where lines of surfaces with different normals have nodes in common. All lines
   *  are noted, each with the share of the surface that it represents; lines of faces of the box
   *  are noted separately. end_edges() sums over ranks (collective). */
  void begin_edges() { noted.assign(NOTED * field.grid.nnodes(), 0.0); }
  void note(const Line &, const double *into, double part);
  void note_face(int64_t node, int axis, double sign);
  void end_edges() { field.nodes.sum(noted.data(), NOTED, 0, NOTED); }
  /** Weights, and shares of a volume, that a node may have or not where a surface is in a plane of
   *  nodes, as round-off decides. */
  static constexpr double ROUND_OFF = 1.0e-9;
  /** Does a node with this weight in a line belong to lines of surfaces, and is it at an edge? */
  bool is_edge(int64_t node, double weight) const;
  bool is_edge(const Line &) const;

  /** One stage: give() collects heat at lines, and end_stage() adds it to the rates of nodes. */
  void begin_stage() { heat.assign(field.grid.nnodes(), 0.0); }
  void give(const Line &line, double power) { line.spread(power, heat.data()); }
  void end_stage();

  /** Length of the circle around the axis of symmetry on which the surface lies. The place at (in
   *  node spacings) is on the line of nodes along an axis through the node index. 1 without an axis
   *  of symmetry. */
  double circle(int axis, const int *index, double at) const;

  /** Share of the function of a node along an axis that lies inside of fixed faces of the box. */
  double fraction_in_box(int axis, int index) const;

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

/** Divides the work on lines that several ranks know into equal parts, so that together the ranks
 *  do it once: each of the places gets its part of area and share. Their keys are node * dim + axis
 *  of the body. counts: memory. Collective. */
template <class Place>
void divide_among_ranks(const MPMHeatBody &body, Place *begin, Place *end,
                        std::vector<double> &counts)
{
  if (body.knows_all()) return;
  const int dim = body.field.lattice.dim;
  counts.assign(body.field.grid.nnodes() * dim, 0.0);
  for (auto *place = begin; place < end; place++) counts[place->key] = 1.0;
  body.field.nodes.sum(counts.data(), dim, 0, dim);
  for (auto *place = begin; place < end; place++) {
    place->share *= 1.0 / counts[place->key];
    place->area *= 1.0 / counts[place->key];
  }
}

/** Share of the area of a line by the share of its volume that is full. Sums over points are not
 *  exactly integrals: a line counts as full from 0.95 on, with a transition from 0.8. */
double heat_area_share(double part);

/** Share of the flow through a surface with this normal that the lines along an axis carry. The sum
 *  of the shares is one; lines that graze the surface have none. */
double heat_share_of_axis(const double *normal, int dim, int axis);

/** Detects bodies so thin that nodes see both of their surfaces; the heat through one of these is
 *  then lost.
 *
 *  Entries are conditions and contacts, in any order. All ranks must make the same calls with the
 *  same entries. */
class MPMHeatThin {
 public:
  struct Found {
    int entry;
    double x[3];    ///< the first place in space
  };

  /** Begins a step. Returns true if bodies are checked in this step. */
  bool looks(int nentries);
  /** Adds a place with this area of surface, by part of a node spacing along an axis behind a node.
   *  into: unit normal into the body. */
  void take(int entry, const MPMHeatBody &, const int *node, int axis, double part,
            const double *into, double area);
  /** Called after a check: returns true once, if thin bodies make up much of the area of an entry.
   *  Collective. */
  bool report(MPI_Comm, Found &);

 private:
  int steps = 0;
  bool warned = false;
  std::vector<std::array<double, 2>> areas;    // [entry] area of thin bodies, and of all bodies
  std::vector<MPMFirstNote<4>> notes;          // [entry] a constant number, and the place
};

}    // namespace LAMMPS_NS
#endif
