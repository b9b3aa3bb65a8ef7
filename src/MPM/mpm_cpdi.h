/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CPDI_H
#define LMP_MPM_CPDI_H

#include "mpm_state.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Domains of the points (shapes cpdi and cpdi2), see transfer/cpdi.h. */
class MPMCpdi : protected Pointers {
 public:
  double *
      *corners;    ///< cpdi2: [n][2^dim][dim] from the point, in the order of transfer/cpdi.h, NAN
                   ///< before the first step; null: cpdi
  std::vector<double> corners_late;    ///< the same at the end of the step, when points move late

  MPMCpdi(class LAMMPS *, MPMField &, MPMPointState &);

  /** Reals that describe a domain. */
  int size() const;
  /** Domains of all points, as kernels read them. */
  const double *rows() const { return corners ? &corners[0][0] : edges.data(); }
  /** Where G2P puts corners that have moved; null: domains have no corners of their own. */
  double *moved(bool late);
  /** Points [first,last) have moved late. */
  void take_late(int first, int last);

  /** The domains of this step; blocks are to be found anew if corners are beyond those in reach. */
  void update();
  /** cpdi2: points whose domain is inverted are bad; with policy warn it becomes that of F. */
  void check_corners();

  /** Corners of the domain relative to the point, their weights and, if asked for, the gradients of
   *  these; returns the size. */
  double corners_of(int i, double *x, double *w, double *g = nullptr) const;
  /** How far a domain reaches from its point along each axis, in node spacings. */
  void reach(int i, double low[3], double high[3]) const;
  /** Half edges of the box that an undeformed point is, after the deformation F. */
  void box(int i, double *edge) const;

  double memory_usage() const;
  double bytes_per_point() const;

 private:
  MPMField &field;
  std::vector<double> edges;    // cpdi: half edges of the domains, [n][dim][dim]

  bool follows_F() const { return !corners; }
  void reset_corners(int i);
  void limit(int i);
};

}    // namespace LAMMPS_NS
#endif
