/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FACE_H
#define LMP_MPM_FACE_H

#include "declare/option.h"
#include "pointers.h"

#include <functional>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class Region;

/** The points below the surface of a region, and the share of its area that each of them stands
 *  for.
 *
 *  A force per area on the surface must be applied to points below it, as nodes above these points
 *  may have next to no mass. Nodes should get the value N(0) of their functions at the surface.
 *  Points at the depth d, in units of the distance of layers, give the share k(d) N + W(d) dN/dn, a
 *  force and a stress along the normal, with
 *
 *    k = 2 hat(d - 1) - hat(d - 2),   W(d) = 1 - int_0^d k,   hat(d) = max(0, 1 - |d|)
 *
 *  The sum of k over layers is one wherever the layers are, and the sum of d k is zero: resultant
 *  and moment are those of the force on the surface. The sum of W is zero, too, for layers at 1/2,
 *  3/2, ..., where W = 3/4, -5/8, -1/8. The node forces of quadratic functions then balance a
 *  uniform stress in the points, without a layer of different stress at the surface. Other
 *  functions differ a little: linear ones by 1/8 of the force, on the node below the surface.
 *
 *  This needs layers of whole points. Where points at the surface are the parts of cells that are
 *  inside of the body (cut yes of create_points, smooth of images), their volumes fill the body up
 *  to the surface, and only the sum of volumes is known exactly. With f(a) = clamp(a + 1 - d, 0,
 *  1), whose sum over a column of whole points and one part of a point is its length a + 1/2, the
 *  sum of k = 19/11 f(1) - 7/11 f(2) is one wherever the surface is, and the sum of d k is less
 *  than 0.1.
 */
class MPMFace : protected Pointers {
 public:
  /** Adds the keywords spacing and area to the options of a style that has a load on a surface; 0:
   *  not given. */
  static void declare(MPM_NS::Options &, double &spacing, double &area);

  /** spacing: distance of the layers; 0: the cube root (2d: square root) of the volume of each
   *  point. */
  MPMFace(class LAMMPS *, Region *, double spacing);

  /** k and W of a layer at this depth, in units of the distance of layers. */
  static double force_share(double depth);
  static double stress_share(double depth);
  /** The same where points at the surface are parts of cells. */
  static double force_share_cut(double depth);
  static double stress_share_cut(double depth);

  /** The share of the surface that a point stands for. */
  struct Share {
    /** k times volume over distance of layers; 2d: for a thickness of 1; around an axis of
     *  symmetry: of a ring. */
    double area;
    double stress;       ///< W
    double normal[3];    ///< unit normal, out of the region
    double depth;        ///< of the point below the surface [distance]
    double layer;        ///< depth in units of the distance of layers
    /** An area that is never negative, of points of the first two layers; its sum is the area of
     *  the surface. */
    double covered;
  };
  /** Calls f(i, share) for all points of the field and group that have one. */
  void find(const MPMField &, int groupbit, const std::function<void(int, const Share &)> &f);

  /** Are the points that were found on all ranks in layers at the expected distance? */
  struct Judgement {
    bool flat;         ///< is the surface a plane?
    double depth;      ///< of the force below the surface, in units of the distance of layers
    double unequal;    ///< relative difference of the areas that the hats around 1 and 2 find
  };
  /** Collective. Below a plane, depth and unequal are zero where there are at least three layers at
   *  that distance; below a surface of radius R the depth is 11/3 s/R, as deeper layers of a ball
   *  are smaller. */
  Judgement judge() const;
  /** Stops with an error if there are no points at all, and with an error or a warning if layers
   *  are not at the expected distance. known_area: area to which shares are scaled, so that their
   *  sum matters less; 0: none. user: name for messages, for example "Fix mpm/traction load";
   *  igroup: group of the points. Collective. */
  void check(const std::string &user, int igroup, double known_area) const;

  /** Adds to the Kirchhoff stress tau [6] of a point the stress part of a traction T on a surface
   *  with the unit normal n. share: W, times the conversion from units of T to those of tau, times
   *  J, times the area to which T refers over the present area of the surface. */
  static void add_stress(const double *T, const double *n, double share, double *tau);

  /** At the start and end of runs: warns if points of the surface have been deleted since the last
   *  call. here: their number on this rank; known: their number on all ranks at the last call,
   *  becomes the present number. Collective. */
  static void note_lost(LAMMPS *, const std::string &user, int here, double &known);

 private:
  Region *const region;
  const double spacing;
  // area; area times depth; volume; volume times normal [3]; areas of two layers [2]; area. Around
  // an axis of symmetry, all except the first one and the volumes are for rings of the length that
  // they have at the surface
  double sums[9] = {};

  bool is_inside(const double *x) const;
  void tell_of_cut(const std::string &user, int igroup, double area) const;
  double spacing_of_parts(const MPMField &, int groupbit, const class MPMRegionSurface &) const;
};

/** Growth of the area of a surface, from the displacements of the points below it.
 *
 *  In the updated frame the deformation gradients of single points at a free surface do not measure
 *  this growth. Where the lattice of points cuts a curved surface, points that stick out are
 *  stretched less than the body, and gaps open between them, which a mean over points leaves out.
 *  The places of points include the gaps. So in each layer of points below the surface, an affine
 *  motion is fitted to the displacements of the points around each one, by least squares with the
 *  shape functions of nodes as weights. It gives the ratio of the areas.
 */
class MPMFaceGrowth {
 public:
  /** A point that may be below the surface. */
  struct Member {
    int layer;    ///< number of its layer, from 0 on; negative: the point is not below the surface
    const double *moved;     ///< displacement since the surface was found [3, distance]
    const double *normal;    ///< unit normal at that time [3]
  };
  static constexpr int LAYERS = 3;

  /** Calls use(i, growth) for the points i for which member(i) has a layer and that have enough
   *  other points around them. growth: present area over the area before the displacements. The
   *  nodes in reach of the points must be known. Collective. */
  void find(MPMField &, const std::function<Member(int i)> &member,
            const std::function<void(int i, double growth)> &use);
  double memory_usage() const { return sums.capacity() * sizeof(double); }

 private:
  std::vector<double> sums;    // of nodes
};

}    // namespace LAMMPS_NS
#endif
