/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONDUCTION_H
#define LMP_MPM_CONDUCTION_H

#include "fix_mpm_material.h"
#include "material/material.h"
#include "mpm_heat_faces.h"
#include "mpm_point_map.h"
#include "transfer/kernels.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {

/** How temperatures go from nodes to points. */
struct MPMHeatTransfer {
  enum Kind { RELAX, PIC, AFFINE };

  Kind kind = RELAX;
  double relax =
      1.0;    ///< how fast points take that of the nodes, in units of conduction over a cell
};

/** Conduction of heat between the points of one field: temperatures of the nodes, their rates, and time
 *  steps. */
class MPMConduction : protected Pointers {
 public:
  using Heats = MPMHeatFaces::Heats;
  static constexpr int SOURCES = MPMHeatFaces::NFACE;    ///< place in Heats

  MPMField &field;
  MPMHeatFaces faces;
  /** [nnodes] heat that nodes get from elsewhere in this step [energy], the same on all ranks that have the
   *  node; empty: none. */
  std::vector<double> given;

  MPMConduction(class LAMMPS *, MPMField &, const MPMHeatTransfer &, int most_stages,
                const MPMHeatCondition *);

  /** Start of a run. */
  void init(double sigma);
  /** A step. gradients: [n][dim] temperature gradients of points, null with the transfer pic.
   *  source: [n] power per volume, or null. came: adds the heat of this step; returns what points have got. */
  double step(const MPMRows &gradients, const double *source, Heats &came);
  /** Largest time step of this rank's points with all stages. */
  double stable_dt(tagint &tag) const;
  /** A material of the field conducts. */
  bool conducts() const { return !thermals.empty(); }
  /** In the last step. */
  int stages() const { return nstage; }
  double memory_usage() const;

 private:
  /** A material that conducts, and where its points have their temperature. */
  struct Thermal {
    const FixMPMMaterial *fix;
    int temperature, molten;    // columns of history
    bool varies;
    MPM_NS::Conduction all;    // or the mean
    MPM_NS::Conduction at(int i) const
    {
      return varies ? fix->material->conduction(fix->history[i]) : all;
    }
  };
  struct Room;    // for a batch of points

  const MPMHeatTransfer &transfer;
  const int most_stages;
  std::vector<Thermal> thermals;
  MPM_NS::TransferKernels pic, with;    // plain sums; transfer of the temperature
  double slowest = 0.0;                 // smallest diffusivity of a material
  double steepest =
      0.0;                 // of the shape functions: greatest sum of N'^2/N along an axis, in cells
  double fastest = 0.0;    // rate of exchange through faces in the last step
  int nstage = 0;

  std::vector<double> volumes;    // [n] of points in this step

  // nodes: records of 8 reals for transfers, and one real for each node

  std::vector<double> records, capacity, volume, before, temperature, rate;
  std::vector<double> first, first_rate, last;    // of stages

  const Thermal *thermal(const FixMPMMaterial *) const;
  double volume_of(int i) const;
  template <class F> void visit(const MPMPointMap::Run &, const F &) const;
  double points_to_nodes(const MPMRows &gradients);
  void find_rates(const double *source, Heats &power);
  int count_stages(double dt, double limit) const;
  void one_step(double dt, const double *source, Heats &came);
  void many_stages(int n, double dt, const double *source, Heats &came);
  double nodes_to_points(const MPMRows &gradients);
  MPM_NS::PointRows rows(int first, Room &) const;
};

}    // namespace LAMMPS_NS
#endif
