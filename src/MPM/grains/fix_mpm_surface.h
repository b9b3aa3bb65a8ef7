/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/surface,FixMPMSurface);
// clang-format on
#else

#ifndef LMP_FIX_MPM_SURFACE_H
#define LMP_FIX_MPM_SURFACE_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_interfaces.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

struct MPMSurfaceOptions {
  double scale = 1.0;    ///< diameter over the edge of a cube (2d: square) of the volume
  double grow = 1.2;     ///< largest diameter over that of an undeformed point
  double depth = 0.5;    ///< depth below the surface of points with a radius [h]
  /** Groups: of the points with a radius, and of the grains that they meet; empty: not given. */
  std::string group_id, grains_id;

  /** The declaration of the options; it refers to this object. */
  MPM_NS::Options declare();
};

/** Gives a contact radius to the material points at the surface of bodies and to those that have
 *  failed, and a radius of zero to all others, so that the pair styles of grains do not see points
 *  inside of bodies. The radius is that of the present volume of the point. */
class FixMPMSurface : public FixMPMState, public MPMListedPoints, private MPMSurfaceOptions {
 public:
  FixMPMSurface(class LAMMPS *, int, char **);
  ~FixMPMSurface() override;
  int setmask() override
  {
    return FixConst::PRE_EXCHANGE | FixConst::PRE_FORCE | FixConst::POST_RUN;
  }
  void init() override;
  void setup_pre_exchange() override;
  void setup_pre_force(int flag) override { pre_force(flag); }
  void pre_exchange() override;
  void pre_force(int) override;
  void post_run() override { give_largest(); }    // the next run takes its cutoffs from the radii
  double compute_scalar() override;

  /** Does this fix decide which points are in this group (those with a radius)? */
  bool keeps_group(int group) const override;

  double memory_usage() override
  {
    return FixMPMState::memory_usage() + share.capacity() * sizeof(double);
  }
  void grow_arrays(int) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;

 private:
  int surface_group = -1;       // group of the points with a radius in this run; -1: none
  bigint natoms = 0;            // atoms when grains were last put into the group
  bool known = false;           // false: all points have their largest radius
  double *at_surface;           // [n] 1: the point has a radius, 0: it has none
  std::vector<double> share;    // share of space that is filled, at the points of a field
  struct MPMPoints *points;

  bool has_radius(int i) const;
  double radius_of(double volume, double growth) const;
  double present_radius(int i) const;
  void find_group(int iarg);
  void set_lists(int iarg);
  std::vector<int> types_of_points(int iarg) const;
  bool moves_atoms() const;
  void warn_of_diameters() const;
  void give_radius(int i, bool at_surface, double radius);
  void give_all(double growth);
  void give_largest() { give_all(grow); }
  void find_surface();
  bool take_grains();
  void keep_first();
};

}    // namespace LAMMPS_NS
#endif
#endif
