/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/fracture,FixMPMFracture);
// clang-format on
#else

#ifndef LMP_FIX_MPM_FRACTURE_H
#define LMP_FIX_MPM_FRACTURE_H

#include "base/mpm_state.h"
#include "contact/mpm_contact_bodies.h"
#include "contact/mpm_node_contact.h"
#include "declare/option.h"
#include "field/mpm_forces.h"
#include "field/mpm_physics.h"
#include "fracture/mpm_split_nodes.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/fracture. */
struct MPMFractureOptions : MPMContactLaw {
  double separable = 0.99;    ///< damage from which on the sides of a crack are apart
  /** Points on surfaces that are not damaged, as bodies are in the first run. */
  enum Surface { NONE, FREE_ONES, OF_GROUP };
  Surface surface = NONE;
  std::string surface_group;

  MPM_NS::Options declare();
};

/** Surfaces inside of a field: nodes between two of them have two velocities, so that pieces of one
 *  field part freely and meet as bodies do. Surfaces are where points are damaged, and where bodies
 *  had theirs at the start. */
class FixMPMFracture :
    public FixMPMState,
    public MPMPhysics,
    public MPMStretch,
    private MPMFractureOptions {
 public:
  FixMPMFracture(class LAMMPS *, int, char **);
  int setmask() override { return 0; }
  void init() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void init_physics(MPMPlan &) override;
  void setup_points() override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool stretches(int first, int n) const override;
  void stretch_gradients(MPMField &, int first, int n, double dt, double *L) override;
  std::vector<std::string> quantities() const override { return {"surface", "opening"}; }
  double quantity(int k, int i) const override;
  /** Sets the unit vector out of the body of a point that is on a surface since the start; of other
   *  points 0. */
  void find_normal(const MPMField &, int i, double *n) const;

 private:
  // of points on surfaces at the start, as F was the unit matrix: unit vectors out of the body, 0
  // elsewhere; of points on cracks: how far these are open [distance]
  MPMRows normals;
  double *openings;
  struct Body {
    MPMField *field;
    MPMSplitNodes split;
    MPMSurfaceGaps::Surface surface;
    MPMInsideFraction inside;
    bool is_split = false;    // in this step, on this rank
    double lost = 0.0;        // to contact in this step, of this rank
    std::vector<char> held;
  };
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<class FixMPMBoundary *> walls;
  double lost = 0.0;    // energy that contact has taken so far, of this rank

  bool is_marked(int i) const;
  double surface_of(const class FixMPMMaterial *, int i) const;
  void mark_surfaces(MPMField &);
  void split(Body &);
  void touch(Body &);
  void follow(Body &);
  void account_for_sides(Body &) const;
};

}    // namespace LAMMPS_NS
#endif
#endif
