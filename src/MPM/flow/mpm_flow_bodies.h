/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_BODIES_H
#define LMP_MPM_FLOW_BODIES_H

#include "flow/mpm_flow_lattice.h"

#include <array>
#include <vector>

namespace LAMMPS_NS {
class FixMPMRigid;
class MPMFlowPressure;
class MPMFlowRegions;

/** Rigid bodies (fix mpm/rigid) in a flow, whose motion is found together with the pressure. The
 *  change of the velocities of a body by the pressure, and the flux that moves with its surface,
 *  are part of the equation for the pressure (C. Batty, F. Bertails, R. Bridson, ACM Trans. Graph.
 *  26 (2007) 100). So bodies that are lighter than the water that they displace are as stable as
 *  heavy ones.
 *
 *  A body b with the velocities U (of its center, and angular ones) gives a cell c the outflow
 *  w_c.U, where w_c are sums over the faces of the cell: closed share of the face times the
 *  velocity of the wall in its middle for unit velocities. Potentials psi = dt p/density of cells
 *  give the body the impulse density h^(dim-1) sum w_c psi_c.
 *
 *  The pressure in the middle of a cell differs from the pressure at the wall; for a flat wall the
 *  error is the same in all of its cells, at most the weight of half a spacing of water. The part
 *  of the error by the acceleration g of the water is known, dt g.r with r from the middle of the
 *  cell to the wall, and is included in the loads. With several liquids, it is that of the density
 *  of the cell. */
class MPMFlowBodies {
 public:
  MPMFlowBodies(class LAMMPS *lmp, const MPMFlowLattice &cells, MPMFlowRegions &regions,
                double density) :
      lmp(lmp),
      cells(cells), regions(regions), density(density)
  {
  }

  /** Finds the bodies of a run; to be called after MPMFlowRegions::init(). */
  void init();
  bool any() const { return !bodies.empty(); }

  /** Start of a step, when wet cells are known: finds the velocities of bodies after a duration
   *  with all forces except the pressure, and gives them to the walls. gravity: [3] acceleration of
   *  the water by its weight. */
  void begin(double duration, const double *gravity, const MPMFlowPressure &);
  /** Adds to y, in owned cells, the change of the outflow over h by the motion of bodies that
   *  potentials x of all cells cause. Collective. */
  void add(const double *x, double *y) const;
  /** Adds the effect of the potentials to the velocities of bodies and walls. Collective. */
  void end(const double *psi);
  /** Gives bodies the impulse of a duration of zero, by which the flow starts. */
  void strike();
  /** Moves bodies, with their present velocities, to the end of a step of duration dt in which
   *  forces have acted for a duration kick. half_kick_share: share of the change of velocities that
   *  they get once more at the end. */
  void move(double dt, double kick, double half_kick_share);
  /** Has any body not been moved by a flow in the step before? */
  bool any_new() const;
  /** Velocities of bodies are those of now, and not of the end of the last step. */
  void forget();

 private:
  using Six = std::array<double, 6>;
  struct Row {
    int cell;
    double to_wall[3];    // from the middle of the cell
    double heavy;         // density of the cell over that in psi
    Six w;                // outflow of the cell for unit velocities of the body
  };
  struct Body {
    FixMPMRigid *fix;
    int wall;
    std::vector<Row> rows;       // of wet cells that this rank owns
    double u[6], inverse[36];    // velocities; inverse matrix of masses
    Six impulse;                 // of this step
    Six struck;                  // impulse at its start
  };
  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  MPMFlowRegions &regions;
  const double density;
  std::vector<Body> bodies;
  mutable std::vector<double> rank_sums;

  template <class Value> Six sum(const Body &, const Value &) const;
  void push(Body &, const Six &impulse) const;
  void find_rows(Body &, const MPMFlowPressure &) const;
};

}    // namespace LAMMPS_NS
#endif
