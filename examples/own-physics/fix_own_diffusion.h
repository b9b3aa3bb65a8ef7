/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_FIX_OWN_DIFFUSION_H
#define LMP_FIX_OWN_DIFFUSION_H

#include "base/mpm_state.h"
#include "field/mpm_nodes.h"
#include "field/mpm_physics.h"

#include <map>

namespace LAMMPS_NS {

/** A passive scalar c (for instance a concentration) that diffuses in material points:
 *
 *    rho dc/dt = div (rho D grad c)
 *
 *  Points carry c and its gradient, so that little is lost on the way to the nodes and back.
 *
 *  fix ID group own/diffusion D c0 keyword value ...
 *    D = diffusivity (distance^2/time), c0 = value of points at the start
 *    keyword = xlo, xhi, ylo, yhi, zlo, zhi: value of c at this face of the box
 */
class FixOwnDiffusion : public FixMPMState, public MPMPhysics {
 public:
  FixOwnDiffusion(class LAMMPS *, int, char **);
  int setmask() override;
  void grow_arrays(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  double stable_dt(const MPMField &, tagint &) const override;
  std::vector<Account> accounts() const override;
  void account(double *values) const override;

 private:
  enum { VALUE, CHANGE, WIDTH };    // reals of a node

  double D, c0;
  double held[6];    // values at faces of the box, NAN: none
  double **c;        // [n][4] the scalar of the points, and its gradient [1/distance]
  double inflow;     // of mass * c through faces so far, this rank's share
  std::map<const MPMField *, MPM_NS::NodeField *> nodes;

  void scalar_to_nodes(MPMField &);
  void scalar_to_points(MPMField &);
  void hold(MPMField &);
};

}    // namespace LAMMPS_NS
#endif
