/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_CUT_H
#define LMP_MPM_REGION_CUT_H

// The part of each cell of a lattice that is inside of a region, for points that have the volume of it.

#include "lmptype.h"
#include "pointers.h"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace MPM_NS {
class CellVolumes;
}

namespace LAMMPS_NS {

/** Cells of sites at origin + (s + 1/2) spacing, and what of them is in a region.
 *
 *  In a region mpm/mesh at rest whose parts do not overlap it is exact (mesh/cell_volumes.h). Of any other region only is known
 *  whether a place is inside: a cell whose corners and center all are is taken to be inside as a whole, one of which none is
 *  to be outside, and in any other one places are tried on a lattice of rank one (the additive recurrence of the generalized golden
 *  ratio), which is displaced by a function of the site. So the error of one cell is about 0.01 of its volume, and errors of many cells
 *  cancel, wherever faces are. */
class MPMRegionCut : protected Pointers {
 public:
  struct Part {
    double share = 0.0;    ///< of the volume of the cell
    double x[3];           ///< center of the part
  };
  using Sites = std::function<bool(const bigint *s)>;

  /** Parts of less than this share go to a neighbor. */
  static constexpr double LIGHT = 0.1;

  /** axis: what is at negative x is left out. first, last [3]: sites that are asked for. */
  MPMRegionCut(LAMMPS *, class Region *, const double *origin, const double *spacing, bool axis,
               const bigint *first, const bigint *last);
  ~MPMRegionCut() override;

  /** What is in the cell. */
  Part inside(const bigint *s);

  /** What the point of a cell has: the part of the cell, and light ones of its neighbors. A light part goes to
   *  the largest one across a face that is not light, too, and among the sites, else across an edge, else across a corner:
   *  volume and center of all do not change. Where there is none it stays. */
  Part point(const bigint *s, const Sites &);

 private:
  class Region *region;
  double origin[3], spacing[3];
  bool axis;
  std::unique_ptr<MPM_NS::CellVolumes> volumes;    // null: places are tried
  using Index = std::array<bigint, 3>;
  std::map<Index, Part> tried;
  std::vector<std::array<int, 3>> neighbors;

  Part whole(const bigint *s) const;
  Part exact(const bigint *s) const;
  Part try_places(const bigint *s) const;
  bool match(const double *x) const;
  bool may_be_light(const bigint *s) const;
  Index receiver(const bigint *s, const Sites &);
};

}    // namespace LAMMPS_NS
#endif
