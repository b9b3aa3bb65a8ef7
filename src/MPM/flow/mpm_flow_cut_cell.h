/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_CUT_CELL_H
#define LMP_MPM_FLOW_CUT_CELL_H

namespace LAMMPS_NS {

/** Where linear functions are positive in segments, triangles, and squares: open parts of the faces
 *  of a cell that a wall cuts, with the distance from the wall as the function. */
namespace MPMFlowCutCell {

  /** Share of a segment in which a linear function with these values at its ends is positive. */
  double positive(double a, double b);
  /** The same for a triangle with these values at its corners. */
  double positive(double a, double b, double c);
  /** The same for a square with these corners in order: the mean over both ways to divide it into
   *  triangles. */
  double positive(double a, double b, double c, double d);
  /** Share of the surroundings of the middle of a cell, weighted with the hat functions of the
   *  cell, in which a linear function is positive. middle: its value in the middle; slope: [dim]
   *  its differences per spacing. */
  double positive_in_hat(int dim, double middle, const double *slope);
  /** Share of the surroundings of the middle of a cell that water below a plane fills, given the
   *  share that it fills of what is open of them, as if all of them were open. middle, slope: of
   *  the wall, as in positive_in_hat(); down: [dim] unit vector into the water. */
  double share_without_wall(int dim, double middle, const double *slope, const double *down,
                            double share);
  /** Adds to sum[2] the length, and its moment about the middle, of the part of a segment of length
   *  one in which a linear function is positive. */
  void add_positive(double a, double b, double *sum);
  /** Adds to sum[3] the area, and its moments about the middle, of the part of a square of area one
   *  with these corners in order in which a function is positive that is linear in triangles. */
  void add_positive(double a, double b, double c, double d, double *sum);

}    // namespace MPMFlowCutCell
}    // namespace LAMMPS_NS
#endif
