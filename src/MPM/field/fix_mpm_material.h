/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/material,FixMPMMaterial);
// clang-format on
#else

#ifndef LMP_FIX_MPM_MATERIAL_H
#define LMP_FIX_MPM_MATERIAL_H

#include "base/mpm_state.h"

#include <memory>

namespace MPM_NS {
class Material;
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {

/** Gives the points of a group a constitutive model, their mass, and their history variables. */
class FixMPMMaterial : public FixMPMState {
 public:
  FixMPMMaterial(class LAMMPS *, int, char **);
  ~FixMPMMaterial() override;
  int setmask() override { return watching ? FixConst::PRE_NEIGHBOR : 0; }
  void init() override;
  void pre_neighbor() override { report_exits(); }
  void post_run() override { report_exits(); }
  void write_restart(FILE *) override;
  void restart(char *) override;
  void unpack_restart(int, int) override;

  std::unique_ptr<MPM_NS::Material> material;
  int nhistory;       ///< number of columns of history
  MPMRows history;    ///< [n][nhistory]; null if the law has none
  /** Rate of ln V of liquids that ties volumes to places, see MPMVolumeDrift [n, 1/time]; null for
   *  other materials. */
  double *volume_rate = nullptr;
  int damage;    ///< column of the damage, which is 1 in failed points; -1: none
  int crack;     ///< column of what is 1 in a crack: the phase field, else the damage; -1: none
  double work[8] = {};         ///< energy of each MPM_NS::Work kind so far, this rank's share
  double stress_work = 0.0;    ///< work of the stress so far, with a compute mpm/energy only

  /** Updates stress and history of a batch to the end of the step and adds to work. heat: [n] heat
   *  from other sources per reference volume, or null. */
  void update_batch(MPM_NS::Batch &, const MPM_NS::BatchKernels &, const double *heat = nullptr);

  /** Sets mass = density * initial volume for the points of the group that have no mass yet. */
  void assign_mass();

  /** Index of a history variable; -1 if the law has none of this name. */
  int find_history(const std::string &) const;
  /** Index of the temperature among the history variables, and of the molten share; -1: there is
   *  none. */
  int temperature() const { return find_history("temperature"); }
  int molten() const { return find_history("molten"); }

  bool mass_varies = false;    ///< the mass of points changes with the water in their pores
  bool watching;               ///< is there a range of validity whose exit was not reported yet?

  /** Checks whether points of an updated batch have left a range of validity. first: local index of
   *  its first point. */
  void watch_ranges(const MPM_NS::Batch &, int first);

  double density(int) const;    ///< reference density of a point

 private:
  /** The first point that left a range; of several points in the same step, that with the smallest
   *  ID. */
  struct Exit {
    bool reported;
    bigint step;    ///< MAXBIGINT: not yet
    tagint tag;
    double value;
  };
  bool counts_stress = false;    // is there a compute mpm/energy?
  std::vector<Exit> exits;       ///< for each range of the material
  void report_exits();
  bool has_begun = false;      // was there a run of this fix?
  bool is_restored = false;    // have points of this rank their state from a restart file?
  void check_surfaces() const;
  void check_history() const;
  std::string names() const;
};

}    // namespace LAMMPS_NS
#endif
#endif
