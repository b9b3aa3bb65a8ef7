/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_REGIONS_H
#define LMP_MPM_FLOW_REGIONS_H

#include "mpm_flow_lattice.h"
#include "mpm_region_surface.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMRigid;
class Region;

/** Regions whose inside is solid to a flow, fixed, with a rigid motion of their own, or with that of a fix mpm/rigid. Cells are cut: a face lets through what its
 *  open share is, and through the rest goes the wall (Y.T. Ng, C. Min, F. Gibou, J. Comput. Phys. 228 (2009) 8807). Shares are
 *  those of the linear functions of the distances at the corners of a cell, exact for planes.
 *
 *  Faces, cells, and forces are for the place that regions have at the start of a step, to which the places of points belong;
 *  velocities are the mean ones of the step, and points are kept out of where regions are at its end. */
class MPMFlowRegions : protected Pointers {
 public:
  MPMFlowRegions(class LAMMPS *, const MPMFlowLattice &, const std::vector<std::string> &ids);

  /** Finds the regions of a run. Errors, in words that begin with name, where there is none of these, or one that is not for flows. */
  void init(const std::string &name);
  /** State at the start of a run. */
  void start_run();
  /** Motion in this step, and what is open where it begins. duration 0: without motion. */
  void find(double duration);
  int n() const { return walls.size(); }
  bool any_move() const { return any_moves; }

  /** The rigid body that has this region; null: none. */
  FixMPMRigid *body(int wall) const { return walls[wall].body; }
  /** Share of the lower face of a cell along an axis that is closed by a body, and its middle from the center of that body. */
  double closed_by(int wall, int64_t cell, int axis, double *arm) const;
  /** From the middle of a cell to the surface of a wall. */
  void find_wall(int wall, const MPMFlowLattice::Cell &, double *way) const;
  /** A body has this velocity and angular velocity now. */
  void set_velocity(int wall, const double *u);

  /** Open share of the lower face of a cell along an axis, 0 to 1. */
  double open(int64_t cell, int axis) const { return shares[cell * dim + axis]; }
  /** Open share of the hat in the middle of a cell. */
  double room(int64_t cell) const { return rooms[cell]; }
  /** Is none of the faces of a cell open? */
  bool is_closed(int64_t cell) const { return closed[cell]; }
  /** What the walls carry through a face, per area [velocity]: the closed share times their velocity. */
  double flux(int64_t cell, int axis) const
  {
    return fluxes.empty() ? 0.0 : fluxes[cell * dim + axis];
  }

  /** Shares that points fill of what is open, from those of whole cells; complete before and afterwards. Where next to nothing is open,
   *  the cells around count. */
  void normalize(std::vector<double> &share) const;
  /** Distance of the middle of the lower face of a cell from walls, positive in the flow, at most far; velocity: component along
   *  the axis of the nearest wall, as if it went on to there. */
  double level_of_face(int64_t cell, int axis, double far, double &velocity) const;
  /** Distance of the middle of a cell from walls, positive in the flow, as far as it is looked at. */
  double level(int64_t cell) const { return levels[cell]; }
  /** Depth of the middle of a cell in a region; out: the direction out of it. */
  double find_way_out(const MPMFlowLattice::Cell &cell, double *out) const;
  /** Share of a cell that is open, by its faces. */
  double room_in(const MPMFlowLattice::Cell &) const;

  /** Velocities [cell][dim] of closed faces near walls get the normal component of the wall, or none. Complete. */
  void hold(std::vector<double> &velocity, bool moving = true) const;
  /** Takes a point that is in a wall out of it, with the velocity into the wall. */
  void keep_outside(double *x, double *v) const;
  /** Depth of a place in a wall, at most far. */
  double depth(const double *x, double far) const;

  /** Adds the force of potentials psi of owned cells, those that wet(number) is true of, to force[3 n()]. Along a wall psi differs from
   *  that in the middle of a cell by its slope, which is known there: push(cell, slope) is the velocity that forces give the water around a cell, and the
   *  pressure takes what is not the change of the velocity of the wall, or a share of that. */
  template <class Wet, class Push>
  void add_forces(const double *psi, const Wet &wet, const Push &push, double share,
                  double *force) const
  {
    for (const auto &cut : cuts) {
      const auto &cell = cells.cells[cut.cell];
      if (!wet(cell.number)) continue;
      double slope[3];
      push(cell, slope);
      for (int d = 0; d < dim; d++) slope[d] -= share * cut.change[d];
      for (int d = 0; d < dim; d++) {
        double sum = psi[cell.number] * cut.area[d];
        for (int e = 0; e < dim; e++) sum += slope[e] * cut.moment[d][e];
        force[3 * cut.wall + d] += sum;
      }
    }
  }
  /** Velocities of the walls in the last step, which their changes in the next one belong to, for restart files. */
  std::vector<double> motion() const;
  void set_motion(const std::vector<double> &);
  /** Psi in closed cells that points near walls reach, linearly from the wet cells around; psi is complete, and zero there. */
  void extrapolate(std::vector<double> &psi, const std::vector<double> &wet) const;

  double largest_speed() const { return speed; }
  double memory_usage() const;

 private:
  struct Wall {
    std::string id;
    Region *region = nullptr;
    std::unique_ptr<MPMRegionSurface> surface;
    FixMPMRigid *body = nullptr;    // that the region is the shape of; null: none
    bool moves = false;
    double before[4];    // shift and angle at the start of the step
    double shift[3] = {}, spin[3] = {},
           center[3] = {};                 // velocity, angular velocity about a place
    double last[9] = {}, older[9] = {};    // these, of the last step, and of the one before it
    bool has_last = false;
  };
  struct Cut {    // owned cell with a part of a wall
    int cell, wall;
    double area[3];    // of the wall, into it
    double moment
        [3][3];    // integrals over it: component of the normal, place from the middle of the cell
    double change[3];    // of its velocity since the last step
  };
  struct Held {    // closed face near a wall
    int cell, axis, wall;
    double x[3], normal[3], velocity[3];
  };

  const MPMFlowLattice &cells;
  const int dim;
  const std::vector<std::string> ids;
  std::vector<Wall> walls;
  std::vector<double> shares, rooms, fluxes;
  std::vector<char> closed;
  std::vector<int>
      body_faces;    // [cell][dim] wall of the body that closes a face, or -1; with bodies
  std::vector<Cut> cuts;
  std::vector<Held> helds;
  bigint nbuild = -1;
  bool any_moves = false, any_bodies = false, known = false, told_of_thin = false;
  std::vector<int>
      met;    // [wall][7] has a body been seen in another region, or in one of the walls of the box?
  double speed = 0.0, duration_of_motion = 0.0;
  std::vector<double> levels;    // distances in the middle of cells, at most far
  mutable std::vector<double> changed, slopes, values;

  double distance(const double *x, double far, int &nearest) const;
  double distance_from(const Wall &, const double *x, double far) const;
  void face_middle(int64_t cell, int axis, double *x) const;
  void normal_at(int wall, const double *x, double *n) const;
  void velocity_at(int wall, const double *x, double *v) const;
  void place(const int *index, const double *offset, double *x) const;
  void continue_surface(std::vector<double> &share) const;
  void find_shares();
  void find_cuts();
  void find_moments(Cut &) const;
  void find_change(Cut &, const double *x) const;
  bool is_thin(const MPMFlowLattice::Cell &) const;
  bool is_corner(const MPMFlowLattice::Cell &, int axis) const;
  void warn_of_thin(int nthin);
  enum Meets { AWAY, INSIDE, COMES };
  Meets meets(int wall, const double *x) const;
  void warn_of_bodies();
};

}    // namespace LAMMPS_NS
#endif
