/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_INFLOW_H
#define LMP_MPM_FLOW_INFLOW_H

#include "mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {
class FixMPMEmit;
class MPMFlowRegions;

/** Fluid that comes into an incompressible flow through the mouths of fix mpm/emit, along an axis of the lattice.
 *
 *  Faces across a mouth, from its upstream to its downstream end, carry what flows through the share of them that is in its section:
 *  they have this velocity, and no pressure changes it. The cell upstream of the first of them has a source of as much, so that it does not
 *  matter what is behind the mouth: a wall, air, or water. Points in the mouth move with the velocity of the flow as they are. So the volume
 *  that comes is that of the points, whatever the section is to the cells. */
class MPMFlowInflow : protected Pointers {
 public:
  /** The mouths of points that belong to this flow. */
  MPMFlowInflow(class LAMMPS *, const MPMFlowLattice &, const class Fix &flow);
  /** In a viscous flow faces along mouths are held, too: stress must not bend or turn what is in a mouth. Its section is one of whole cells there, but with regions:
   *  a part of a cell that is slower than the others would hold these back. */
  bool clamps = false;
  bool any() const { return !mouths.empty(); }
  /** Velocities of this step, and the faces that there are; collective. regions: that cut these, null: none. */
  void find(const MPMFlowRegions *regions);
  /** Velocities [cell][dim] of faces in mouths, and where those are not solved for, factor 0 of the gradient of the pressure, null: only
   *  velocities. */
  void hold(std::vector<double> &velocity, std::vector<double> *mobility) const;
  /** [cell] rate of its volume that comes, of all cells. */
  const std::vector<double> &sources() const { return source; }
  /** Moves a point that is in a mouth, by a step; returns false where it is in none. */
  bool carry(double *x, double *v, double dt) const;

  double memory_usage() const;

 private:
  struct Section {
    int index[2];    // of cells across the flow
    double share;    // of their faces
  };
  struct Mouth {
    FixMPMEmit *fix;
    int axis, side;     // the flow is towards this side: 1: upwards
    int first, last;    // faces across it, first <= last
    std::vector<Section> section;
    double velocity[3];
  };
  struct Held {
    int64_t face;
    double velocity;
  };
  const MPMFlowLattice &cells;
  std::vector<Mouth> mouths;
  bool found = false;    // sections
  std::vector<Held> held;
  std::vector<double> source;

  void find_section(Mouth &) const;
  void round_off(Mouth &) const;
  void clamp(const Mouth &, int at, const Section &);
};

}    // namespace LAMMPS_NS
#endif
