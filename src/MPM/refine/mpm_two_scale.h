/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TWO_SCALE_H
#define LMP_MPM_TWO_SCALE_H

#include "field/mpm_field.h"
#include "pointers.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace LAMMPS_NS {

/** Two fields whose points form one body: the lattice of one has half the node spacing of the
 *  other.
 *
 *  A B-spline is a sum of B-splines of half the width. A node of the fine lattice is tied if its
 *  function reaches a cell with points of the coarse field. Its velocity is the value that this sum
 *  gives it from its parents, the coarse nodes that contribute to it. It has neither mass nor
 *  momentum of its own: its parents get these with the same weights. All other fine nodes are free.
 *  The functions of free nodes vanish where coarse points are, so that velocities are continuous.
 *  The functions are a partition of unity and reproduce linear velocities everywhere: they are
 *  truncated hierarchical B-splines (C. Giannelli, B. Juettler, H. Speleers, Comput. Aided Geom.
 *  Des. 29 (2012) 485). Points choose the cells, in each step in which they move on the lattice. */
class MPMTwoScale : protected Pointers {
 public:
  /** before: the pair whose fine field is the coarse field of this one, or null. */
  MPMTwoScale(class LAMMPS *, MPMField &coarse, MPMField &fine, const MPMTwoScale *before);

  MPMField &coarse, &fine;

  /** Are the nodes of the fine lattice where the shape needs them? Their offset from coarse nodes
   *  must be an odd multiple of a quarter of the coarse spacing for quadratic functions, and an
   *  even one for others. */
  static bool fits(const MPMField &coarse, const MPMField &fine);
  /** An origin along one axis that the fine lattice of a coarse field can have. */
  static double fine_origin(const MPMField &coarse, int axis);

  /** Adds another body on the lattice of the coarse field, which may touch this one. Fine nodes are
   *  also tied where it has points, so that both bodies have the same functions. */
  void add_neighbor(MPMField &);

  /** Activates the blocks of the coarse grid that the nodes of a finer field need. This is the fine
   *  field of this pair, or of one of the next pairs. levels: how many levels it is finer than the
   *  coarse field. */
  void extend_coarse(const MPMField &finer, int levels) const;
  /** Lists of nodes are not valid any more. */
  void topology_changed() { lists_valid = false; }
  /** Finds the tied nodes from the present positions of points. Collective. */
  void find_tied();

  /** Passes the sums of this rank's points at tied nodes to their parents, with the affine part.
   *  after: the pair whose coarse field is the fine field of this one, or null; its to_parents()
   *  must have been called. */
  void to_parents(const MPMTwoScale *after);
  /** Sets the velocities of tied nodes, also the old ones. */
  void from_parents();

  /** As to_parents() for other sums at the nodes, [node][width]: those of this rank's points at
   *  tied nodes. */
  void sums_to_parents(std::vector<double> &of_fine, std::vector<double> &of_coarse,
                       int width = 1) const;
  /** As to_parents() for sums that points gave to nodes with their gradients g_p, N_ip w_p [u_p +
   *  g_p . (x_i
   *  - x_p)]. Parents get what these points would have given to them. weight(i): w_p of a point;
   *    slopes:
   *  [n][dim], or null if there are none. after: as in to_parents(). */
  void moments_to_parents(const std::function<double(int)> &weight, const MPMRows &slopes,
                          const MPMTwoScale *after, std::vector<double> &of_fine,
                          std::vector<double> &of_coarse);
  /** Sets the values of tied nodes from those of their parents. */
  void values_from_parents(const std::vector<double> &of_coarse,
                           std::vector<double> &of_fine) const;
  /** Sets the values of tied nodes to the greatest value of their parents. */
  void greatest_from_parents(const std::vector<double> &of_coarse,
                             std::vector<double> &of_fine) const;
  /** Is a node of the fine grid tied? */
  bool is_tied(int64_t fine_node) const { return tied_of[fine_node] >= 0; }

  /** Number of tied and of free nodes, of those that this rank counts. */
  struct Count {
    bigint tied = 0, free = 0;
  } count;
  /** Share of the surface of the fine points behind which coarse points begin in the next cell,
   *  counted by the coarse cells that fine points fill. The functions at this part of the surface
   *  are those of tied nodes and of nodes outside of the body. body: its fields. Collective. */
  double share_of_thin(const std::vector<MPMField *> &body) const;
  double memory_usage() const;

 private:
  struct Tied {
    int64_t node;       // of the fine grid
    int first, last;    // range of its parents
  };
  struct Parent {
    int64_t node;    // of the coarse grid, canonical
    double weight;
    double r[3];    // from the fine node to it [distance]
  };

  struct Marks {    // coarse cells with points of a field, at their lower node or in their middle
    MPMField &field;
    MPM_NS::NodeField &cells;
  };

  const MPMTwoScale *const before;
  std::vector<Marks> marks;    // of the coarse field, and of its neighbors
  int offset[3];               // of fine nodes from coarse ones, in quarters of the coarse spacing
  bool lists_valid = false;
  std::vector<Tied> tied;
  std::vector<Parent> parents;
  std::vector<int> tied_of;           // [fine node] its index in tied, or -1
  std::vector<char> block_is_tied;    // [fine block] does it have tied nodes?
  struct Share {                      // share of a point in a tied node
    int tied, point;
    double weight;
  };
  std::vector<Share> shares;
  std::vector<double> affine;     // [tied][dim*dim] sums of N m C over points
  std::vector<double> moments;    // [tied][dim] the same sums of w g, see moments_to_parents()

  bool is_marked(const int cell[3]) const;
  static void mark_points(const Marks &);
  void mark_cells();
  void find_shares();
  static int64_t canonical_node(const MPM_NS::Grid &, const int index[3]);
  void sum_affine(const MPMTwoScale *after);
  template <class Weight>
  void sum_at_tied(const Weight &, const MPMRows &rows, int width, std::vector<double> &sums,
                   const MPMTwoScale *after, const std::vector<double> *of_after) const;
};

}    // namespace LAMMPS_NS
#endif
