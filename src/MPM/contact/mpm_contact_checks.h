/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTACT_CHECKS_H
#define LMP_MPM_CONTACT_CHECKS_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class Fix;
class MPMContactBodies;
struct MPMContactBody;

/** Keywords of fix mpm/contact that say where bodies touch. */
struct MPMContactSearchOptions {
  enum Normal { MASS, VOLUME, COLINEAR, LOGISTIC };

  Normal normal_by = COLINEAR;
  bool gap = true;
  double full = 1.0;    ///< with gap: filled fraction of the volume of a node at which bodies touch
};

/** Warnings of bodies that contact cannot hold apart, in the first step of a run. */
class MPMContactChecks : protected Pointers {
 public:
  // fraction of the volume of a node from which on bodies overlap, by half a cell to a cell,
  // depending on their position in the cell; points at the ends of regions that are no multiple of
  // their spacing reach 1.37. EACH: least fraction of each body there
  static constexpr double OVERLAP = 1.4, OVERLAP_EACH = 0.25;

  MPMContactChecks(class LAMMPS *lmp, const Fix &fix, const MPMContactSearchOptions &options,
                   MPMContactBodies &bodies) :
      Pointers(lmp),
      fix(fix), options(options), bodies(bodies)
  {
  }

  /** Warns of bodies that share space. Contact removes their approach, but does not part them.
   *  Collective. */
  void warn_overlap();
  /** Warns of bodies that consist of surfaces or lines of fix mpm/elements. Collective. */
  void warn_thin();

 private:
  const Fix &fix;
  const MPMContactSearchOptions &options;
  MPMContactBodies &bodies;

  tagint nearest_point(int body, const double *place) const;
  void warn_of_thin_body(int thin, int other);
  void warn_of_thin_pair(const std::vector<int> &thin);
  double most_filled(MPMContactBody &);
};

}    // namespace LAMMPS_NS
#endif
