/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_REGIONS_H
#define LMP_MPM_FLOW_REGIONS_H

#include "flow/mpm_flow_lattice.h"
#include "walls/mpm_region_surface.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMRigid;
class Region;

/** Regions whose inside is solid for a flow: fixed, with a rigid motion of their own, or with the
 *  motion of a fix mpm/rigid. Cells are cut: fluid flows through the open share of a face, and the
 *  rest moves with the wall (Y.T. Ng, C. Min, F. Gibou, J. Comput. Phys. 228 (2009) 8807). Shares
 *  follow from linear functions of the distances at the corners of a cell, which is exact for
 *  planes.
 *
 *  Faces, cells, and forces are for the place of regions at the start of a step, to which the
 *  places of points belong. Velocities are means over the step, and points are kept out of the
 *  place of regions at its end. */
class MPMFlowRegions : protected Pointers {
 public:
  /** ids: of the regions. */
  MPMFlowRegions(class LAMMPS *, const MPMFlowLattice &, const std::vector<std::string> &ids);

  /** Finds the regions of a run. Stops with an error, whose text begins with name, if one does not
   *  exist or cannot be used: with open faces, a shape that changes, or a union or intersection
   *  that moves. */
  void init(const std::string &name);
  /** Notes the state of regions at the start of a run. */
  void start_run();
  /** Finds the motion of regions in this step, and apertures at its start. duration 0: no
   *  motion. */
  void find(double duration);
  int n() const { return walls.size(); }    ///< number of regions
  bool any_move() const { return any_moves; }

  /** The rigid body whose shape is this region; null: none. */
  FixMPMRigid *body(int wall) const { return walls[wall].body; }
  /** Share of the lower face of a cell along an axis that a body closes. arm: [3] from the center
   *  of the body to the middle of the face. */
  double closed_by(int wall, int64_t cell, int axis, double *arm) const;
  /** way: [3] vector from the middle of a cell to the surface of a wall. */
  void find_wall(int wall, const MPMFlowLattice::Cell &, double *way) const;
  /** Sets the present velocity and angular velocity u[6] of a body. */
  void set_velocity(int wall, const double *u);

  /** Open share of the lower face of a cell along an axis, 0 to 1. */
  double aperture(int64_t cell, int axis) const { return apertures[cell * dim + axis]; }
  /** Open share of the hat function of a cell. */
  double volume_fraction(int64_t cell) const { return volume_fractions[cell]; }
  /** Are all faces of a cell closed? */
  bool is_closed(int64_t cell) const { return closed[cell]; }
  /** Flux of the walls through the lower face of a cell, per area [velocity]: closed share times
   *  velocity of the wall. */
  double flux(int64_t cell, int axis) const
  {
    return fluxes.empty() ? 0.0 : fluxes[cell * dim + axis];
  }

  /** Converts shares of whole cells that points fill to shares of their open parts; of all cells
   *  before and afterwards. Where next to nothing of a cell is open, the cells around count, too.
   *  Collective. */
  void normalize(std::vector<double> &share) const;
  /** Distance of the middle of the lower face of a cell from walls, positive in the flow, at most
   *  far. velocity: component along the axis of the velocity of the nearest wall, extended rigidly
   *  to the face. */
  double level_of_face(int64_t cell, int axis, double far, double &velocity) const;
  /** Distance of a place in a cell from walls, positive in the flow, at most far. offset: [3] from
   *  the lower corner, in spacings. wall: the nearest one. normal: [3] unit vector out of it, not
   *  set beyond far. */
  double plane_at(int64_t cell, const double *offset, double far, double *normal, int &wall) const;
  /** Component of the velocity of a wall along the axis of the lower face of a cell, extended
   *  rigidly to its middle. */
  double velocity_at_face(int wall, int64_t cell, int axis) const;
  /** Distance of the middle of a cell from walls, positive in the flow, at most a few spacings. */
  double level(int64_t cell) const { return levels[cell]; }
  /** Depth of the middle of a cell in a region; out: [3] unit vector out of it. */
  double find_way_out(const MPMFlowLattice::Cell &cell, double *out) const;

  /** Gives velocities [cell][dim] of closed faces near walls the normal component of the wall
   *  (moving), or none; of all cells before and afterwards. Collective. */
  void hold(std::vector<double> &velocity, bool moving = true) const;
  /** Moves a point that is in a wall out of it, and removes its velocity into the wall. Returns its
   *  distance from walls before, at most a few spacings. */
  double keep_outside(double *x, double *v) const;
  /** Depth of a place in a wall, positive inside, between -far and far. */
  double depth(const double *x, double far) const;

  /** Adds the force of potentials psi of owned cells for which wet(number) is true to force[3 n()].
   *  Along a wall, psi differs from psi in the middle of a cell by its known slope: push(cell,
   *  slope) gives the velocity that forces give to the water around a cell, and returns the density
   *  of the cell over that in psi. The pressure balances it, less share times the change of the
   *  velocity of the wall. */
  template <class Wet, class Push>
  void add_forces(const double *psi, const Wet &wet, const Push &push, double share,
                  double *force) const
  {
    for (const auto &cut : cuts) {
      const auto &cell = cells.cells[cut.cell];
      if (!wet(cell.number)) continue;
      double slope[3];
      const double heavy = push(cell, slope);
      for (int d = 0; d < dim; d++) slope[d] = heavy * (slope[d] - share * cut.change[d]);
      for (int d = 0; d < dim; d++) {
        double sum = psi[cell.number] * cut.area[d];
        for (int e = 0; e < dim; e++) sum += slope[e] * cut.moment[d][e];
        force[3 * cut.wall + d] += sum;
      }
    }
  }
  /** Velocities of the walls in the last step, relative to which changes in the next step are
   *  found; for restart files. */
  std::vector<double> motion() const;
  void set_motion(const std::vector<double> &);
  /** Extrapolates psi linearly from wet cells to closed cells that points near walls reach. psi: of
   *  all cells, zero in these before. Collective. */
  void extrapolate(std::vector<double> &psi, const std::vector<double> &wet) const;

  /** Largest flux() of the walls on this rank. */
  double largest_speed() const { return speed; }
  double memory_usage() const
  {
    return MPM_NS::bytes_of(cuts, helds, closed, body_faces, apertures, volume_fractions, fluxes,
                            levels);
  }

 private:
  static constexpr double FAR = 4.0;    // distance up to which a wall is looked at, in spacings
  // the middle of a cell from its lower corner, in spacings
  static constexpr double MIDDLE[3] = {0.5, 0.5, 0.5};

  struct Wall {
    std::string id;
    Region *region = nullptr;
    std::unique_ptr<MPMRegionSurface> surface;
    FixMPMRigid *body = nullptr;    // body whose shape is the region; null: none
    bool moves = false;
    double before[4];    // shift and angle at the start of the step
    // velocity, and angular velocity about center
    double shift[3] = {}, spin[3] = {}, center[3] = {};
    // shift, spin, and center of this step, and of the one before it
    double last[9] = {}, older[9] = {};
    bool has_last = false;
  };
  struct Cut {    // owned cell with a part of a wall
    int cell, wall;
    double area[3];    // area vector of the wall, into it
    // integrals over it of a component of the normal times the place from the middle of the cell
    double moment[3][3];
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
  std::vector<double> apertures, volume_fractions, fluxes;
  std::vector<char> closed;
  std::vector<int> body_faces;    // [cell][dim] wall of the body that closes a face, or -1
  std::vector<Cut> cuts;
  std::vector<Held> helds;
  bigint nbuild = -1;
  bool any_moves = false, any_bodies = false, known = false, warned_of_thin = false;
  // [wall][7] has a body been seen in another region, or in one of the 6 walls of the box?
  std::vector<int> met;
  double speed = 0.0, duration_of_motion = 0.0;
  std::vector<double> levels;    // distances of the middle of cells, at most FAR spacings
  mutable std::vector<double> changed, slopes, values;

  double distance(const double *x, double far, int &nearest) const;
  double distance_from(const Wall &, const double *x, double far) const;
  void face_middle(int64_t cell, int axis, double *x) const;
  void normal_at(int wall, const double *x, double *n) const;
  void velocity_at(int wall, const double *x, double *v) const;
  void place(const int *index, const double *offset, double *x) const;
  void corner_levels(const int *index, double *level) const;
  void continue_surface(std::vector<double> &share) const;
  template <class F> void visit_around(std::size_t k, double open, const F &) const;
  bool find_surface(std::size_t k, const std::vector<double> &share, double open, double *down,
                    double *normal) const;
  void find_apertures();
  void find_cuts();
  void find_moments(Cut &) const;
  void find_change(Cut &, const double *x) const;
  bool is_thin(const MPMFlowLattice::Cell &) const;
  bool is_corner(const MPMFlowLattice::Cell &, int axis) const;
  bool is_gap(const MPMFlowLattice::Cell &) const;
  void warn_of_thin(int nthin, int ngaps);
  enum Meets { AWAY, INSIDE, COMES };
  Meets meets(int wall, const double *x) const;
  void warn_of_bodies();
};

}    // namespace LAMMPS_NS
#endif
