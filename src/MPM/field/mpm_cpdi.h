/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CPDI_H
#define LMP_MPM_CPDI_H

#include "base/mpm_rows.h"
#include "field/mpm_field.h"

namespace LAMMPS_NS {

/** Half of the edge of a cube (2d: square) with the initial volume of point i, in node spacings. */
double half_size(const MPMField &, int i);

/** Sizes of points that are boxes along the axes: GIMP, with fixed sizes or those of deformed
 *  points. */
class MPMBoxes : protected Pointers {
 public:
  std::vector<double> sizes;    ///< half sizes in node spacings, [n][3]

  MPMBoxes(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Find the sizes for this step. */
  void update();
  /** Present half sizes of point i, in node spacings. */
  void size_of(int i, double size[3]) const;
  /** Is an undeformed point larger than a cell? */
  bool is_too_large(int i) const;
  /** Smallest half size of the undeformed points of this rank, in node spacings, at most that of a
   *  cell. */
  double smallest() const;

 private:
  MPMField &field;

  double inside(int i, int d) const;
};

/** Domains of the points (shapes cpdi and cpdi2), see transfer/cpdi.h. */
class MPMCpdi : protected Pointers {
 public:
  /** cpdi2: [n][2^dim][dim] corners relative to the point, in the order of transfer/cpdi.h, NAN
   *  before the first step; null: cpdi. */
  MPMRows corners;
  std::vector<double> corners_late;    ///< the same at the end of the step, if points move late

  MPMCpdi(class LAMMPS *, MPMField &, MPMPointState &);

  /** Number of reals that describe a domain. */
  int size() const
  {
    const int dim = field.lattice.dim;
    return field.options.shape == MPM_NS::CPDI2 ? dim << dim : dim * dim;
  }
  /** Domains of all points, as kernels read them. */
  const double *rows() const { return corners ? &corners[0][0] : edges.data(); }
  /** The array where G2P puts corners that have moved; null: domains have no corners of their
   *  own. */
  double *moved(bool late);
  /** Points [first,last) have moved late: they take the corners of the end of the step. */
  void take_late(int first, int last);

  /** Find the domains for this step. Asks for new blocks if corners are beyond those in reach. */
  void update();
  /** cpdi2: treat points with an inverted domain as bad; with policy warn they get the domain of
   *  F. */
  void check_corners();

  /** Corners x of the domain relative to the point, their weights w and, if g is not null, the
   *  gradients of the weights; returns the size. */
  double corners_of(int i, double *x, double *w, double *g = nullptr) const;
  /** How far a domain reaches from its point along each axis, in node spacings. */
  void reach(int i, double low[3], double high[3]) const;
  /** Corners of the box of the undeformed point, deformed by F. */
  void corners_of_box(int i, double *x) const;

  double memory_usage() const
  {
    return (edges.capacity() + corners_late.capacity()) * sizeof(double);
  }
  /** Memory for each point, without the arrays that are declared in the state. */
  double bytes_per_point() const { return corners ? 0.0 : size() * sizeof(double); }

 private:
  MPMField &field;
  std::vector<double> edges;    // cpdi: half edges of the domains, [n][dim][dim]
  bool warned = false;          // has been said which points have no corners at the start

  bool follows_F() const { return !corners; }
  double *row(int i) { return corners ? corners[i] : &edges[size() * (std::size_t) i]; }
  const double *row(int i) const { return const_cast<MPMCpdi *>(this)->row(i); }
  void box(int i, double *edge) const;
  void limit(int i);
  double make_undeformed(int i);
  void tell_of_boxes(bigint nboxes, bigint ndeformed);
};

}    // namespace LAMMPS_NS
#endif
