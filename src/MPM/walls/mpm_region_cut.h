/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_CUT_H
#define LMP_MPM_REGION_CUT_H

#include "lmptype.h"
#include "pointers.h"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <vector>

// The part of each cell of a lattice that lies inside a region, for points that get its volume.

namespace MPM_NS {
class CellVolumes;
}

namespace LAMMPS_NS {
class Region;

/** Cells of sites at origin + (s + 1/2) spacing, and the part of each cell that lies in a region.
 *
 *  The part is exact for a region mpm/mesh in 3d at rest whose parts do not overlap
 *  (mesh/cell_volumes.h). For others, the region is only asked whether a place is inside. A cell
 *  whose corners and center are all inside counts as wholly inside, and a cell with none of them
 *  inside as outside. In any other cell, places are tried on a lattice of rank one (the additive
 *  recurrence of the generalized golden ratio), which is displaced by a function of the site. The
 *  error of one cell is therefore about 0.01 of its volume, and the errors of many cells cancel,
 *  wherever faces are. */
class MPMRegionCut : protected Pointers {
 public:
  struct Part {
    double share = 0.0;    ///< fraction of the volume of the cell
    double x[3];           ///< center of the part
  };
  using Sites = std::function<bool(const bigint *s)>;

  /** Parts with a share less than this go to a neighbor. */
  static constexpr double LIGHT = 0.1;

  /** axis: leave out the space at negative x. first, last [3]: range of the sites. */
  MPMRegionCut(LAMMPS *, class Region *, const double *origin, const double *spacing, bool axis,
               const bigint *first, const bigint *last);
  ~MPMRegionCut() override;

  /** The part of the cell that is inside the region. */
  Part inside(const bigint *s);

  /** The part that the point of a cell gets: the part of its own cell, and light parts of
   *  neighbors. A light part goes to the largest part that is not light and belongs to the sites:
   *  across a face, else across an edge, else across a corner. Total volume and center do not
   *  change. A light part without such a neighbor stays. */
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

/** The inside of a region as a body of density 1. In 2d the volume is an area, and the inertia is
 *  that about the z axis only. */
struct MPMRegionBody {
  double volume = 0.0;
  double center[3] = {};
  double inertia[3][3] = {};    ///< about the center
  double lo[3] = {}, hi[3] = {};

  /** Integrates by samples in the box around the region, with an error of some 1e-4; blocks are
   *  exact. The region must have such a box, see is_bounded(), and be at rest. */
  MPMRegionBody(Region &region, int dim);

  /** Is there a box around the region with finite edges, as the constructor needs it? */
  static bool is_bounded(const Region &region, int dim);
};

}    // namespace LAMMPS_NS
#endif
