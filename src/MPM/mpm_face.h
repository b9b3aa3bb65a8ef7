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

namespace LAMMPS_NS {
class MPMField;
class Region;

/** The points below the surface of a region, and how much of its area each of them stands for.
 *
 *  A force per area on the surface must come to points below it, as nodes above these may have next to no mass. What nodes
 *  ought to get is the value N(0) of their functions at the surface. Points at the depth d, in units of the distance of
 *  layers, give the share k(d) N + W(d) dN/dn, a force and a stress along the normal, with
 *
 *    k = 2 hat(d - 1) - hat(d - 2),   W(d) = 1 - int_0^d k,   hat(d) = max(0, 1 - |d|)
 *
 *  The sum of k over layers is one wherever these are, and that of d k is zero: resultant and moment are those of
 *  the force on the surface. That of W is zero, too, for layers at 1/2, 3/2, ..., where W = 3/4, -5/8, -1/8: the node forces
 *  of quadratic functions are then those of a uniform stress in the points, which such a force leaves in
 *  equilibrium, without a layer of another stress at the surface. Others differ a little, linear functions by 1/8 of the
 *  force on the node below the surface.
 *
 *  This needs layers of whole points. Where those at the surface are the parts of cells that are inside of the body (cut yes of
 *  create_points, smooth of images), their volumes fill the body up to the surface, and the sum of volumes is what is known
 *  exactly: with f(a) = clamp(a + 1 - d, 0, 1), whose sum over a column of whole points and one part of a point is its length
 *  a + 1/2, k = 19/11 f(1) - 7/11 f(2) has the sum one wherever the surface is, and that of d k is less than 0.1.
 */
class MPMFace : protected Pointers {
 public:
  /** Adds the keywords spacing and area to the options of a style that has a load on a surface; 0: not given. */
  static void declare(MPM_NS::Options &, double &spacing, double &area);

  /** spacing: of the layers; 0: that of points in a cube, the cube root of their volume. */
  MPMFace(class LAMMPS *, Region *, double spacing);

  /** k and W of a layer at this depth, in units of the distance of layers. */
  static double force_share(double depth);
  static double stress_share(double depth);
  /** The same where points at the surface are parts of cells. */
  static double force_share_cut(double depth);
  static double stress_share_cut(double depth);

  /** What a point stands for. */
  struct Share {
    double
        area;    ///< k times volume over distance of layers; 2d: for a thickness of 1; of a ring around an axis
    double stress;       ///< W
    double normal[3];    ///< out of the region
    double depth;        ///< of the point below the surface [distance]
    double layer;        ///< the same in units of the distance of layers
    /** The area as two layers have it, which is never negative; its sum is that of the surface. */
    double covered;
  };
  /** Calls f(i, share) for all points of the field and group that have one. */
  void find(const MPMField &, int groupbit, const std::function<void(int, const Share &)> &f);

  /** Of the points that were found on all ranks, whether they are in layers at the expected distance. */
  struct Judgement {
    bool flat;         ///< the surface is a plane
    double depth;      ///< of the force below the surface, in units of the distance of layers
    double unequal;    ///< by how much the areas that the hats around 1 and 2 find differ
  };
  /** Collective. Below a plane, depth and unequal are zero where there are at least three layers at that distance; below a surface of
   *  radius R the depth is 11/3 s/R, as deeper layers of a ball are smaller. */
  Judgement judge() const;
  /** Collective. Stops with an error where there are no points at all, and with one or a warning where layers are not what they
   *  should be; known_area: 0, or the area, to which shares are scaled, so that their sum matters less. user: what looks for the surface, for example fix mpm/traction load,
   *  in which group. */
  void check(const std::string &user, int igroup, double known_area) const;

  /** Add to the Kirchhoff stress tau [6] of a point what a traction T on a surface with the unit normal n has besides forces:
   *  share is W, in units of the stress, times J over the present area of the surface for that of T. */
  static void add_stress(const double *T, const double *n, double share, double *tau);

  /** Collective, at the start and end of runs: warns when points of the surface have been deleted since the last look. here: of
   *  this rank; known: of all ranks at the last look, which becomes the present number. */
  static void note_lost(LAMMPS *, const std::string &user, int here, double &known);

 private:
  Region *const region;
  const double spacing;
  // area; area times depth; volume; volume times normal [3]; areas of two layers; area. All but the first, and volumes, with rings
  // around an axis of symmetry of the length that they have at the surface
  double sums[9] = {};

  bool is_inside(const double *x) const;
  double of_parts(const MPMField &, int groupbit, const class MPMRegionSurface &) const;
};

}    // namespace LAMMPS_NS
#endif
