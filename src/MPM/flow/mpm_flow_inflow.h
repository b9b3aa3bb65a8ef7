/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_INFLOW_H
#define LMP_MPM_FLOW_INFLOW_H

#include "flow/mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {
class FixMPMEmit;
class MPMFlowRegions;

/** Fluid that enters an incompressible flow through the inlets of fix mpm/emit, along an axis of
 *  the lattice.
 *
 *  Faces across an inlet, from its upstream to its downstream end, have the velocity of the inlet
 *  times the share of the face that is in its section, and the pressure does not change it. The
 *  cell upstream of the first of these faces has a source of the same flux, so that it does not
 *  matter what is behind the inlet: a wall, air, or water. Points in the inlet move rigidly with
 *  the velocity of the inlet. So the volume that enters is that of the points, wherever the section
 *  is relative to the cells. */
class MPMFlowInflow : protected Pointers {
 public:
  /** Takes the inlets of points that belong to the flow of this group. */
  MPMFlowInflow(class LAMMPS *, const MPMFlowLattice &, int groupbit);
  /** For viscous flows: faces along inlets are held, too, as stress must not bend or turn the fluid
   *  in an inlet. Without regions, the section then consists of whole cells: a partly filled cell
   *  would be slower and hold the others back. */
  bool clamps = false;
  bool any() const { return !inlets.empty(); }
  /** Finds the velocities of this step and the faces that are held. regions: those that cut faces;
   *  null: none. Stops with an error if points do not come along an axis, or if the inlet ends in
   *  the first cell at a wall. */
  void find(const MPMFlowRegions *regions);
  /** Sets velocities [cell][dim] of faces in inlets, and their mobility to 0, so that they are not
   *  solved for; mobility null: only velocities. */
  void hold(std::vector<double> &velocity, std::vector<double> *mobility) const;
  /** [cell] volume that enters a cell per time, over its volume [1/time]; of all cells. */
  const std::vector<double> &sources() const { return source; }
  /** Moves a point in an inlet by a step, and sets its velocity to that of the end of the step,
   *  which is more by half_kick[3] than that in the step; returns false if it is in none. */
  bool carry(double *x, double *v, double *half_kick, double dt) const;

  double memory_usage() const { return MPM_NS::bytes_of(held, source); }

 private:
  struct Section {
    int index[2];    // of cells across the flow
    double share;    // of their faces
  };
  struct Inlet {
    FixMPMEmit *fix;
    int axis, side;     // side to which the flow goes; 1: towards larger coordinates
    int first, last;    // faces across the inlet, first <= last
    std::vector<Section> section;
    double velocity[3];
  };
  struct Held {
    int64_t face;
    double velocity;
  };
  const MPMFlowLattice &cells;
  std::vector<Inlet> inlets;
  bool found = false;    // are sections known?
  std::vector<Held> held;
  std::vector<double> source;

  void find_section(Inlet &) const;
  void round_off(Inlet &) const;
  void find_index(const Inlet &, int at, const Section &, int *index) const;
  void clamp(const Inlet &, int at, const Section &);
};

}    // namespace LAMMPS_NS
#endif
