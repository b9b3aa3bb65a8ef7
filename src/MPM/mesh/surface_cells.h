/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_SURFACE_CELLS_H
#define MPM_MESH_SURFACE_CELLS_H

#include "mesh/surface_mesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>

namespace MPM_NS {

/** Distances from a surface near to it, without a search where the surface is smooth.
 *
 *  At the corners x_k of cubic cells, the distance d_k and its gradient g_k are found once. In a
 *  cell, with the weights w_k of linear interpolation,
 *
 *    d(x) = sum_k w_k (d_k + g_k (x - x_k)/2),
 *
 *  which is exact for quadratic functions, as errors of interpolation and extrapolation have
 *  opposite signs. A cell is used if its gradients have about the same direction and its center has
 *  the right distance. Values do not depend on earlier calls. */
class SurfaceCells {
 public:
  /** Largest error of a distance, in cells, as found at the center. */
  static constexpr double TOLERANCE = 0.01;

  /** Signed distance of x, and its gradient (if not null), a unit vector, or zero where it is not
   *  known. The result may be any number beyond the limit if the distance is. */
  using Distance = std::function<double(const SurfaceMesh::Point &x, double limit,
                                        SurfaceMesh::Point *gradient)>;

  /** origin: a corner of cells; size: of cells; flat: distances along z do not count, and all
   *  places have the same z. */
  SurfaceCells(Distance, const SurfaceMesh::Point &origin, double size, bool flat);
  SurfaceCells(const SurfaceMesh &, double size, bool flat);

  /** Farthest places from the surface for which there are cells, in cells. */
  static constexpr double FARTHEST = 12.0;

  /** KNOWN: distance of x, negative inside, and its gradient (if not null), a unit vector. FAR: x
   *  is at least at this distance, and there is no gradient. UNKNOWN: the surface is not smooth. */
  enum Answer : char { UNKNOWN, KNOWN, FAR };
  Answer find(const SurfaceMesh::Point &x, double &distance, SurfaceMesh::Point *gradient);

 private:
  static constexpr int SIDE = 8, CORNERS = SIDE + 1;    // of bricks
  enum Kind : char { NEW, SMOOTH, ROUGH, FAR_IN_FRONT, FAR_BEHIND };
  /** Distance in cells, infinite if it is greater than FARTHEST, and its gradient: in single
   *  precision, as most of the time goes into reading them. */
  using Corner = std::array<float, 4>;
  struct Brick {
    std::array<Corner, CORNERS * CORNERS * CORNERS> corners;
    std::array<char, CORNERS * CORNERS * CORNERS> known;
    std::array<Kind, SIDE * SIDE * SIDE> kinds;
  };

  const Distance exact;
  const SurfaceMesh::Point origin;
  const double size, per_size;
  const bool flat;
  std::unordered_map<uint64_t, std::unique_ptr<Brick>> bricks;
  double height = 0.0;    // z of all places, if flat
  uint64_t last_key = 0;
  Brick *last_brick = nullptr;

  Brick *brick_at(const int64_t *brick);
  Kind judge(Brick &, const int64_t *brick, const int *cell);
  const Corner &corner(Brick &, const int64_t *brick, const int *at);
  std::array<double, 4> blend(const Brick &, const int *cell, const double *t) const;
};

}    // namespace MPM_NS
#endif
