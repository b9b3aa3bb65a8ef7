/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PHASE_FIELD_H
#define LMP_MPM_PHASE_FIELD_H

#include "diffusion/mpm_node_scalar.h"
#include "field/mpm_node_system.h"
#include "material/phase_field.h"
#include "solve/krylov.h"

#include <map>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class FixMPMMaterial;

/** The phase field of cracks in one field, see law/phase_field.h. It has values at nodes, d = sum_i
 *  N_i(x) d_i, which are found anew from points in each solution: they minimize
 *
 *    sum_p V_p [g(d) w_p + GC/(c0 l) (w(d) + l^2 |grad d|^2) + B/2 max(d_p - d, 0)^2]
 *
 *  V_p: reference volumes. The last term keeps cracks from healing: d must not be below its value
 *  d_p of before. It is a condition at points, so that d_p is never a mean over points, and no
 *  crack becomes wider by transfers; its residue is of the order 1/B. A largest energy w of the
 *  past in place of it, as C. Miehe et al., Comput. Methods Appl. Mech. Eng. 199 (2010) 2765 have
 *  it, keeps what the whole body had stored at its peak, and widens cracks. */
class MPMPhaseField : private MPMNodeSystem {
 public:
  MPMPhaseField(class LAMMPS *, MPMField &);

  struct Goal {
    double tolerance = 1.0e-3;    ///< of changes of d
    int most = 3;                 ///< Newton steps of a solution
  };
  /** Material with phase field cracks; before the first solve(). */
  void add(const FixMPMMaterial *, const MPM_NS::PhaseFieldCracks &);
  bool empty() const { return cracks_of.empty(); }
  /** Finds d and sets it in the history of the points. Blocks must be those of the points, and
   *  driving energies those of the last stress. Returns what has failed, or nothing. Collective. */
  std::string solve(const Goal &);

  struct {
    double share = 0.0;    ///< of the points with a phase field, that took part
    int newton = 0, products = 0;
  } report;    ///< of the last solution
  double memory_usage() const;

 private:
  using Cracks = MPM_NS::PhaseFieldCracks;
  using Run = MPMPointMap::Run;

  MPMField &field;
  std::map<const FixMPMMaterial *, Cracks> cracks_of;
  MPMNodeScalar scalar;
  MPM_NS::ConjugateGradients conjugate;
  std::vector<char> near;                     // [slot] do its points take part?
  std::vector<double> d, change, residual;    // of nodes
  std::vector<double> diagonal;               // of the linear equations
  std::vector<double> value, stiffness;       // [n] d of points; second derivative times volume
  int products = 0;
  // of the shape: sum of N^2, and of |grad N|^2 h^2, over those of N
  double of_values, of_gradients;

  const Cracks *cracks(const Run &run) const
  {
    const auto found = cracks_of.find(run.material);
    return found == cracks_of.end() ? nullptr : &found->second;
  }
  bool is_active(const Cracks &, const double *history) const;
  bool find_region();
  double find_residual(bool first);
  void find_diagonal();
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  void set_points();
};

}    // namespace LAMMPS_NS
#endif
