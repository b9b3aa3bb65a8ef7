/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MOMENT_H
#define LMP_MPM_MOMENT_H

#include "field/mpm_interfaces.h"

#include "pointers.h"

#include <functional>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Moment M on the points of a surface with weights w (areas), applied by forces that are linear in
 *  the positions r relative to the center:
 *      f = w omega x r,   T omega = M,   T = sum w (r.r 1 - r r),   sum w r = 0
 *  The sum of the forces is zero and their moment is M, wherever the points have moved. On the end
 *  of a beam, they are the stress of bending, and follow the beam. Forces are in units of force. */
class MPMMoment : protected Pointers, public MPMTrialForces {
 public:
  /** weight(i): weight of point i of this rank, 0: none. name: of the caller, for errors. */
  MPMMoment(class LAMMPS *lmp, std::string name, std::function<double(int)> weight);

  /** Sets the moment, on the points at their present positions. Collective. */
  void set(const double *moment);
  /** Force on point i per unit of weight, at its position when the moment was set. */
  void load(int i, double *force) const { present.load(place(i, nullptr).data(), force); }

  bool forces_after(const double *u, double *force, double &carried) override;
  double differentiate(const double *u) override;
  void add_change(const double *du, double *dforce) override;
  /** Adds nothing: the share of a single point is negligible. */
  void add_blocks(double *) override {}
  const double *forces() const override;
  double asymmetry() const override { return present.size > 0.0 ? 1.0 : 0.0; }

 private:
  struct Spin {
    double center[3], omega[3], inverse[3][3];    // omega, and the inverse of T
    double size = 0.0;                            // magnitude of omega
    void load(const double *x, double *force) const;
  };
  std::string name;
  std::function<double(int)> weight;
  double moment[3] = {0.0, 0.0, 0.0};
  Spin present, trial;
  std::vector<double> places;    // positions in trial
  mutable std::vector<double> at_start;

  struct Place {
    double x[3];
    const double *data() const { return x; }
  };
  Place place(int i, const double *u) const;
  bool find(const double *u, Spin &) const;
};

}    // namespace LAMMPS_NS
#endif
