/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TWO_SCALE_H
#define LMP_MPM_TWO_SCALE_H

#include "mpm_field.h"
#include "pointers.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace LAMMPS_NS {

/** Two fields whose points are one body: the lattice of one has half the node spacing of the other.
 *
 *  A B-spline is a sum of B-splines of half the width. A node of the fine lattice whose function reaches a cell with points of
 *  the coarse field is tied: its velocity is what that sum gives it of its parents, the coarse nodes with a part in it; it
 *  has neither mass nor momentum of its own, but its parents have these with the same weights. All other fine nodes are free.
 *  The functions of free nodes vanish where coarse points are, so that velocities are continuous, and functions are a
 *  partition of unity and reproduce linear velocities everywhere: these are truncated hierarchical B-splines (C. Giannelli, B.
 *  Juettler, H. Speleers, Comput. Aided Geom. Des. 29 (2012) 485), with cells that points choose, in each step where they
 *  move on the lattice. */
class MPMTwoScale : protected Pointers {
 public:
  /** before: the pair whose fine field is this coarse one, or null. */
  MPMTwoScale(class LAMMPS *, MPMField &coarse, MPMField &fine, const MPMTwoScale *before);

  MPMField &coarse, &fine;

  /** Nodes of the fine lattice in coarse node spacings from one of the coarse lattice, of the kind that the shape asks for? */
  static bool fits(const MPMField &coarse, const MPMField &fine);
  /** Where the fine lattice of a coarse one can have its origin, on one axis. */
  static double fine_origin(const MPMField &coarse, int axis);

  /** Another body on the lattice of the coarse field that may touch this one: where it has points, fine nodes are tied, too, so that
   *  both have the same functions. */
  void add_neighbor(MPMField &);

  /** Activate blocks of the coarse grid with all that nodes of a finer one (this pair's, or of the next ones) have to do with. */
  void extend_coarse(const MPMField &finer, int levels) const;
  void topology_changed() { lists_valid = false; }
  /** Which fine nodes are tied, by where points are now. Collective. */
  void find_tied();

  /** What this rank's points gave to tied nodes goes to their parents, with the affine part of it. after: the pair whose coarse
   *  field is this fine one, for which that has been done, or null. */
  void to_parents(const MPMTwoScale *after);
  /** Velocities of tied nodes, also the old ones. */
  void from_parents();

  /** The same for numbers that others have at the nodes, [node][width]: what this rank's points gave to tied nodes. */
  void sums_to_parents(std::vector<double> &of_fine, std::vector<double> &of_coarse,
                       int width = 1) const;
  /** Sums that points gave to nodes with their gradients g_p, N_ip w_p [u_p + g_p . (x_i - x_p)], go to parents with what they would have
   *  given there. weight(i): w_p of a point; slopes: [n][dim], or null: there are none. after: as in to_parents(). */
  void moments_to_parents(const std::function<double(int)> &weight, const MPMRows &slopes,
                          const MPMTwoScale *after, std::vector<double> &of_fine,
                          std::vector<double> &of_coarse);
  /** Values of tied nodes, by those of their parents. */
  void values_from_parents(const std::vector<double> &of_coarse,
                           std::vector<double> &of_fine) const;
  /** The greatest value of their parents. */
  void greatest_from_parents(const std::vector<double> &of_coarse,
                             std::vector<double> &of_fine) const;
  bool is_tied(int64_t fine_node) const { return tied_of[fine_node] >= 0; }

  /** Nodes that are tied and free, of those that this rank counts. */
  struct Count {
    bigint tied = 0, free = 0;
  } count;
  /** Share of the surface of the fine points, by the coarse cells that they fill, below which coarse points begin in the next cell:
   *  functions at this surface are those of nodes that are tied and of nodes outside of the body. body: its fields. Collective. */
  double share_of_thin(const std::vector<MPMField *> &body) const;
  double memory_usage() const;

 private:
  struct Tied {
    int64_t node;       // of the fine grid
    int first, last;    // its parents
  };
  struct Parent {
    int64_t node;    // of the coarse grid, canonical
    double weight;
    double r[3];    // from the fine node to it [distance]
  };

  struct
      Marks {    // of coarse cells with points of a field, at their lower node or in the middle of them
    MPMField &field;
    MPM_NS::NodeField &cells;
  };

  const MPMTwoScale *const before;
  std::vector<Marks> marks;    // of the coarse field, and of its neighbors
  int offset[3];               // of fine nodes from coarse ones, in quarters of the coarse spacing
  bool lists_valid = false;
  std::vector<Tied> tied;
  std::vector<Parent> parents;
  std::vector<int> tied_of;           // [fine node] its place in tied, or -1
  std::vector<char> block_is_tied;    // [fine block] has it tied nodes?
  struct Share {                      // of a point in a tied node
    int tied, point;
    double weight;
  };
  std::vector<Share> shares;
  std::vector<double> affine;     // [tied][dim*dim] sums of N m C over points
  std::vector<double> moments;    // [tied][dim] the same of w g, see moments_to_parents()

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
