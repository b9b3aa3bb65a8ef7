/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/mesh/heat,FixMPMMeshHeat);
// clang-format on
#else

#ifndef LMP_FIX_MPM_MESH_HEAT_H
#define LMP_FIX_MPM_MESH_HEAT_H

#include "base/mpm_state.h"
#include "heat/mpm_heat_faces.h"
#include "law/batch.h"
#include "mesh/background_mesh.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class MPMMeshBody;
struct MPMPoints;

/** Thermal condition at the nodes of a physical group of a mesh: prescribed temperature of its
 *  nodes, or heat through its sides. */
struct MPMMeshHeatCondition : MPMHeatCondition {
  std::string group;
};

/** Keywords of fix mpm/mesh/heat. */
struct MPMMeshHeatOptions {
  std::vector<MPMMeshHeatCondition> conditions;

  MPM_NS::Options declare();

 private:
  MPMMeshHeatCondition next;    // being read
};

/** Conduction of heat between points on a mesh (fix mpm/mesh, frame total), with conditions at its
 *  physical groups. */
class FixMPMMeshHeat : public FixMPMState, private MPMMeshHeatOptions {
 public:
  FixMPMMeshHeat(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm/mesh
  void init() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  /** ID of its fix mpm/mesh. */
  const std::string &mesh_fix() const { return mesh_id; }
  /** Prepares a run. Throws std::runtime_error if the mesh lacks a group of a condition. */
  void begin_run(const MPM_NS::BackgroundMesh &);
  /** Conducts heat for a time step. Collective. */
  void conduct(MPMMeshBody &, double dt);

 private:
  /** A conducting material, with the history columns of its points. */
  struct Thermal {
    const FixMPMMaterial *fix;
    int temperature, molten;    // columns of history
    bool varies;
    bool jumps;                // its conductivity depends on the temperature, and it melts
    MPM_NS::Conduction all;    // conduction of all points, or its mean
    double diffusivity;        // with which its points relax to what nodes have
  };
  struct Point {
    int i;
    const Thermal *thermal;
    double capacity;
    // conductivity for gradients in the reference configuration, times the volume, row-major
    double k[9];
  };
  /** A condition at a node, with its area. */
  struct NodeCondition {
    int node, condition;
    double area;
  };
  /** Means of the conductivities in a cell that an interface of materials cuts. */
  struct Cut {
    double across, along;
    double normal[3];    // of the interface, in the reference configuration, of any length
  };

  std::string mesh_id;
  MPMRows gradients;    // [n][3] of the temperature at points, in the reference configuration
  MPMPoints *points = nullptr;
  std::vector<Thermal> thermals;
  std::vector<NodeCondition> conditions_at_nodes;
  double largest = 0.0;    // largest height of a cell
  double relaxed = 0.0;    // diffusivity with which all points relax to what nodes have
  std::vector<Point> conducting;
  std::vector<double> capacity, value, before, rate, sums;    // of nodes
  std::vector<char> held;       // [node] is the temperature prescribed?
  double got = 0.0;             // heat that points have taken so far, this rank's share
  std::vector<double> heat;     // [condition] heat through it so far, this rank's share
  std::vector<double> power;    // [condition] power in the last step

  std::vector<Cut> cuts;
  std::vector<int> cut_of;          // [cell] index in cuts; -1: none
  bool layers_known = false;        // were the cuts found in this run?
  bool warned_of_layers = false;    // was a warning printed about interfaces without means?

  const Thermal *thermal(int i) const;
  void find_layers(MPMMeshBody &);
  static void set_layers(const Cut &, const double *cofactors, double J, double V, double *k);
  MPM_NS::Conduction conduction_of(MPMMeshBody &, const Thermal &, int i, bool nodes_known) const;
  void find_points(MPMMeshBody &, bool nodes_known);
  double fill_nodes(MPMMeshBody &);
  void hold(MPMMeshBody &);
  void advance(MPMMeshBody &, double dt);
  void let_faster_points_go(MPMMeshBody &, double dt);
  double kept(double diffusivity, double dt) const;
  void take(MPMMeshBody &, double dt);
};

}    // namespace LAMMPS_NS
#endif
#endif
