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

/** Generalized winding number of a surface: the solid angle of its triangles as seen from a place,
 *  over 4 pi. It is 1 inside of a closed surface with outward normals, 0 outside, and something in
 *  between for a surface with holes (A. Jacobson, L. Kavan, O. Sorkine-Hornung, ACM Trans. Graph.
 *  32 (2013) 33). Triangles far from the place are combined as a dipole with its first moments in a
 *  tree of boxes (G. Barill, N.G. Dickson, R. Schmidt, D.I.W. Levin, A. Jacobson, ACM Trans. Graph.
 *  37 (2018) 43). The cost grows with the logarithm of their number, and the error is less than
 *  0.01. */
class WindingNumber {
 public:
  using Point = std::array<double, 3>;

  /** Corners of triangles. */
  explicit WindingNumber(std::vector<std::array<Point, 3>> triangles);

  /** The winding number around x. */
  double operator()(const Point &x) const;

 private:
  struct Node {
    Point center;           // centroid of the area
    double square;          // square of the largest distance of a corner from the center
    Point area;             // area vector
    double moment[3][3];    // first moments of the area vector about the center
    int first, last;        // triangles of a leaf; otherwise last < 0 and the children are used
    int child[2];
  };
  std::vector<std::array<Point, 3>> triangles;
  std::vector<Node> tree;

  int build(int first, int last);
};

}    // namespace MPM_NS
#endif
