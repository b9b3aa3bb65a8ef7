/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_BODIES_H
#define LMP_MPM_FLOW_BODIES_H

#include "mpm_flow_lattice.h"

#include <array>
#include <vector>

namespace LAMMPS_NS {
class FixMPMRigid;
class MPMFlowPressure;
class MPMFlowRegions;

/** Rigid bodies (fix mpm/rigid) in a flow, whose motion is found together with the pressure: what the pressure changes of the
 *  velocities of a body, and what flows through its surface with it, is part of the equation for the pressure (C. Batty,
 *  F. Bertails, R. Bridson, ACM Trans. Graph. 26 (2007) 100). So bodies that are lighter than what they displace are as stable as
 *  heavy ones.
 *
 *  A body b with the velocities U (of its center, and angular ones) gives a cell c the outflow w_c.U, where w_c are sums over the
 *  faces of the cell: closed share of the face times the velocity of the wall in its middle. Potentials psi = dt p/density of cells
 *  give it the impulse density h^(dim-1) sum w_c psi_c.
 *
 *  The pressure in the middle of a cell is not that at the wall, which for a flat one is the same error in all of its cells: half
 *  a spacing of water at the most. What the weight g of the water makes of this is known, dt g.r with r from the middle of the cell
 *  to the wall, and is part of the loads. */
class MPMFlowBodies {
 public:
  MPMFlowBodies(class LAMMPS *lmp, const MPMFlowLattice &cells, MPMFlowRegions &regions,
                double density) :
      lmp(lmp),
      cells(cells), regions(regions), density(density)
  {
  }

  /** Finds the bodies of a run, after MPMFlowRegions::init(). */
  void init();
  bool any() const { return !bodies.empty(); }

  /** Velocities of bodies after the forces of a duration, but without pressure, which walls have then; wet cells are known.
   *  gravity: acceleration of the water by its weight. */
  void begin(double duration, const double *gravity, const MPMFlowPressure &);
  /** y += what potentials x of all cells change of the outflow by the motion of bodies, over h; in owned cells. */
  void add(const double *x, double *y) const;
  /** What potentials change of the velocities of bodies, which walls have then. */
  void end(const double *psi);
  /** Bodies go on, with the velocities that they have now, to the end of the step. */
  void move(double dt);

 private:
  using Six = std::array<double, 6>;
  struct Row {
    int cell;
    double to_wall[3];    // from the middle of the cell
    Six w;
  };
  struct Body {
    FixMPMRigid *fix;
    int wall;
    std::vector<Row> rows;    // of wet cells that this rank owns
    double u[6], inverse[36];
    Six impulse;    // of this step
  };
  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  MPMFlowRegions &regions;
  const double density;
  std::vector<Body> bodies;
  mutable std::vector<double> of_ranks;

  template <class Value> Six sum(const Body &, const Value &) const;
  void push(Body &, const Six &impulse) const;
  void find_rows(Body &, const MPMFlowPressure &) const;
};

}    // namespace LAMMPS_NS
#endif
