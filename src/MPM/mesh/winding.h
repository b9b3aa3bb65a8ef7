/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_WINDING_H
#define MPM_MESH_WINDING_H

// How often a surface of triangles winds around a place. Nothing here knows about LAMMPS.

#include <array>
#include <vector>

namespace MPM_NS {

/** Generalized winding number of a surface: the solid angle under which its triangles are seen from a place, over
 *  4 pi, 1 inside of a closed surface that looks outward and 0 outside, and something in between for one with
 *  holes (A. Jacobson, L. Kavan, O. Sorkine-Hornung, ACM Trans. Graph. 32 (2013) 33). Triangles far from the
 *  place are taken together, as a dipole and its first moments in a tree of boxes (G. Barill, N.G. Dickson, R. Schmidt, D.I.W. Levin,
 *  A. Jacobson, ACM Trans. Graph. 37 (2018) 43): the cost grows with the logarithm of their number, and the error
 *  is less than 0.01. */
class WindingNumber {
 public:
  using Point = std::array<double, 3>;

  /** triangles: numbers of corners. */
  WindingNumber(const std::vector<Point> &corners,
                const std::vector<std::array<int, 3>> &triangles);

  double operator()(const Point &x) const;

 private:
  struct Node {
    Point center;           // of the area
    double square;          // of the largest distance of a corner from there
    Point area;             // times the normal
    double moment[3][3];    // area, by places relative to the center
    int first, last;        // triangles of a leaf; else last < 0 and the children are
    int child[2];
  };
  std::vector<std::array<Point, 3>> triangles;
  std::vector<Node> tree;

  int build(int first, int last);
};

}    // namespace MPM_NS
#endif
