/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/traction,FixMPMTraction);
// clang-format on
#else

#ifndef LMP_FIX_MPM_TRACTION_H
#define LMP_FIX_MPM_TRACTION_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_physics.h"
#include "loads/mpm_face.h"
#include "loads/mpm_moment.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

struct MPMTractionOptions {
  enum Surface { REGION, POINTS, FREE };

  Surface surface = REGION;
  std::string region;
  double points_area = 0.0, points_normal[3] = {0.0, 0.0, 0.0};
  MPM_NS::NumberOrVariable traction[3];    ///< dead load per area before deformation
  MPM_NS::NumberOrVariable pressure;       ///< follows the surface; positive: against the body
  MPM_NS::NumberOrVariable moment[3];      ///< on the surface as a whole
  bool has_traction = false, has_pressure = false, has_moment = false;
  double spacing = 0.0, area = 0.0;    ///< 0: not given

  /** The declaration of the options; it refers to this object. */
  MPM_NS::Options declare(int dimension);
};

/** Forces per area on the surface of bodies: dead loads, which keep their direction and total,
 *  pressure, which stays normal to the surface and acts on its present area, and the forces of a
 *  moment (MPMMoment). They are applied as forces on points (atom->f). A pressure on all of the
 *  surface of a body is a part of the internal forces instead. */
class FixMPMTraction :
    public FixMPMState,
    public MPMPhysics,
    public MPMAddedStress,
    public MPMLoad,
    public MPMRegionUser,
    private MPMTractionOptions {
 public:
  FixMPMTraction(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::POST_FORCE; }
  void init() override;
  void setup(int) override;
  void post_force(int) override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  bool uses_region(const std::string &name) const override
  {
    return surface == REGION && name == region;
  }

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool looks_beyond_points() const override { return false; }
  bool adds_stress(const MPMField &, int first, int last) const override;
  void add_stress(const MPMField &, int first, int n, double *tau) const override;
  bool follows(const MPMField &, int first, int last) const override;
  void follow(const MPMField &, int first, int n, const double *F, double *force,
              double *tau) const override;
  MPMTrialForces *trial_forces(const MPMField &) override { return turn.get(); }
  std::vector<Account> accounts() const override;
  void account(double *values) const override
  {
    if (surface != POINTS) values[0] += work[1];
  }

  /** load: [3] force per area before deformation on the surface at point i, by the loads of this
   *  step, with the deformation gradient F [9, row-major]. For searches for equilibrium; its node
   *  forces are those of atom->f and add_stress(). */
  void load_on(int i, const double *F, double *load) const;

 private:
  // Of a point. Before deformation: area, share of the stress (MPMFace), and normal [3]; area times
  // cof(F) times normal is the area vector of the present surface. In the last step: force over
  // this area [3], place [3], J over the present area, and pressure
  MPMRows rows;
  enum {
    AREA,
    STRESS,
    NORMAL,
    LOAD = NORMAL + 3,
    PLACE = LOAD + 3,
    HEIGHT = PLACE + 3,
    PRESSED,
    WIDTH
  };
  // Of a point with pressure, in the updated frame: present area over the norm of cof(F) times
  // normal, which is the growth that the F of the point gives; layer (0: none, layers count from
  // 1); displacement since the surface was found [3], and normal at that time [3]
  MPMRows growth;
  enum { RATIO, LAYER, MOVED, FACING = MOVED + 3, GROWTH_WIDTH = FACING + 3 };
  bool grows = false;    // are these kept?
  MPMFaceGrowth face_growth;
  // of a point, with pressure on all of the surface, in the last step: pressure, volume, force of
  // the gradient of the pressure [3], place [3]
  MPMRows inside;
  enum { PRESSURE, VOLUME, PUSH, AT = PUSH + 3, INSIDE_WIDTH = AT + 3 };
  bool defined = false;    // have the points of the surface been found?
  double known = 0.0;      // number of these points on all ranks
  std::vector<MPMField *> fields;
  static constexpr int NSUM = 7;                  // force [3], present area, torque [3]
  double sums[NSUM] = {}, all_sums[NSUM] = {};    // for compute_vector(): of this rank, of all
  bool sums_known = true;
  bool warned_of_nodes = false;    // warned of nodes of finite elements
  // so far, by forces on points and by stress, this rank's share [energy]
  double work[2] = {0.0, 0.0};

  // a load in this step [force/area]
  struct Load {
    double value = 0.0;
    std::vector<double> of_points;    // [n] values of an atom-style variable, else empty
    double at(int i) const { return of_points.empty() ? value : of_points[i]; }
  };
  static constexpr int NLOAD = 7;    // traction, pressure, moment
  Load now[NLOAD];
  std::unique_ptr<MPMMoment> turn;    // null: there is no moment

  bool belongs(const MPMField &, int i) const;
  void present_area(int i, const double *F, double *area) const;
  void find_growth(MPMField &);
  void add_stress_of_load(int i, const double *F, const double *load, double *tau) const;
  MPM_NS::NumberOrVariable &load(int k)
  {
    return k < 3 ? traction[k] : k == 3 ? pressure : moment[k - 4];
  }
  void find_load(int k);
  void evaluate_loads();
  void note_nodes();
  void note_lost();
  double evenness_at_start = 1.0;
  double evenness() const;
  void look_for_curls();
  bool warned_of_stretch = false;
  double mean_stretch() const;
  void look_for_stretch();
  void define();
  void add_forces();
  void find_gradient(std::vector<double> &gradient);
  void press();
};

}    // namespace LAMMPS_NS
#endif
#endif
