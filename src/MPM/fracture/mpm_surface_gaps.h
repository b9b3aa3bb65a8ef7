/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SURFACE_GAPS_H
#define LMP_MPM_SURFACE_GAPS_H

#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_point_map.h"
#include "pointers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace LAMMPS_NS {

/** Nodes of one field that two surfaces of it face: there is a gap or a crack between them.
 *
 *  Points on surfaces have a vector towards the gap: the normal of the surface, if it is known,
 *  else the gradient of s, which is 1 on surfaces and 0 away from them, found through the nodes.
 *  Where the vectors of the points in reach of a node are against each other, and the points of
 *  either side lie where the vectors of the other side point, the node is between two surfaces.
 *  After M. Homel, E. Herbold, Int. J. Numer. Methods Eng. 109 (2017) 1013, who compare gradients
 *  with the largest one at the node. */
class MPMSurfaceGaps : protected Pointers {
 public:
  /** What is known of the points. */
  struct Surface {
    std::vector<double> value;    ///< [n] s
    std::vector<double>
        normal;               ///< [n][3] out of the body, where it is known, or 0; may be empty
    const double *opening;    ///< of the gap, known by the points on surfaces [distance]
    double separable;         ///< points are on a surface where s is at least this
    double apart;             ///< opening of surfaces that have been apart [distance]
  };

  struct Node {
    int64_t number;      ///< slot*64 + n
    double normal[3];    ///< unit vector from the first side to the second one
    double push[3];      ///< unit vector along which sides push, about the normal
    double middle[3];    ///< from the node to halfway between the surfaces [node spacings]
    double weight;       ///< volume of the points on the surface of the smaller side
    bool against;        ///< are the vectors of both sides against each other?
    bool owned;
    double opening;    ///< mean of the points on both surfaces [distance]
    double filled;     ///< volume of both sides at the node over that of a cell
    double change;     ///< of the opening in this step
    bool held;         ///< do both sides touch in this step?
  };

  MPMSurfaceGaps(class LAMMPS *, MPMField &);

  std::vector<Node> list;
  std::vector<int> at;    ///< [node] index in the list, or -1

  /** Finds the nodes. The surface must stay valid until the next call. Collective. */
  void find(const Surface &);
  /** Side (0 or 1) of point i at a node. r: from the node to the point [node spacings]. */
  int side_of(const Node &, int i, const double *r) const;
  bool is_on_surface(int i) const { return surface->value[i] >= surface->separable; }
  double volume(int i) const;
  /** Sets sums [node][width] to zero where each_point_near() may add something. */
  void clear(std::vector<double> &sums, int width) const;
  /** Sums of all ranks. Collective. */
  void sum(std::vector<double> &sums, int width) const;
  /** Calls f(active, run, i) for the points that reach nodes in the list, and for few others. */
  template <class F> void each_point_near(const F &f) const;
  double memory_usage() const;

 private:
  struct Point {
    int i, slot;
  };
  using Axes = std::array<std::array<double, 3>, 3>;    // of two kinds, and a place

  MPMField &field;
  const int dim;
  Surface const *surface = nullptr;
  std::vector<Point> on_surface;
  bool has_gradients = false;      // are there points on surfaces whose normal is not known?
  std::vector<double> gradient;    // [n][3] of s
  std::vector<int> wanted;         // [node] index of nodes that may be split; -1: not in it
  std::vector<int> region;         // slots of the blocks that are looked at
  std::vector<char> close;         // [node] does a point in the cell above it reach marked nodes?
  std::vector<char> has_close;     // [slot]
  std::vector<double> sums;        // [node][...]

  double direction(int i, double *u) const;
  void look_at(std::vector<char> &near);
  template <class F> void each_node(const F &f) const;
  void find_gradients();
  bool find_seeds();
  std::vector<Axes> find_candidates();
  void find_sides(const std::vector<Axes> &);
  bool face_each_other(const double *a, const double *b, Node &) const;
  void add(int64_t n, Node &);
  bool extend();
  void smooth_normals();
  void find_push();
  void mark(const std::vector<int> &which);
};

template <class F> void MPMSurfaceGaps::each_point_near(const F &f) const
{
  const auto &map = *field.map;
  const auto &lattice = field.lattice;
  const MPMRows places = field.frame->places();
  for (const auto &a : map.active) {
    const auto &block = field.grid.blocks[a.slot];
    if (std::none_of(block.slot, block.slot + 27, [&](int slot) {
          return slot >= 0 && has_close[slot];
        }))
      continue;
    for (int k = a.first_run; k < a.last_run; k++)
      for (int i = map.runs[k].first; i < map.runs[k].last; i++) {
        int cell[3] = {0, 0, 0};
        for (int d = 0; d < dim; d++)
          cell[d] = (int) std::floor((places[i][d] - lattice.origin[d]) / lattice.h);
        const int64_t node = field.grid.locate_near(block, cell);
        if (node >= 0 && close[node]) f(a, k, i);
      }
  }
}

}    // namespace LAMMPS_NS
#endif
