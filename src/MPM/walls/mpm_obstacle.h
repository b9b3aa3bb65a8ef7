/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_OBSTACLE_H
#define LMP_MPM_OBSTACLE_H

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class Domain;
class FixMPMBoundary;
class MPMWall;

/** A surface that rigid bodies can meet, at the start of a step. */
class MPMObstacle {
 public:
  std::string name;            ///< for messages
  double friction = 0.0;       ///< see friction_at()
  double restitution = 1.0;    ///< largest ratio of the speeds after and before a collision

  virtual ~MPMObstacle() = default;
  /** Signed distance of x, negative inside. May return far if it is larger, and -far if it is less
   *  than that. */
  virtual double distance(const double *x, double far) const = 0;
  /** Unit normal out of the obstacle at x; zero: not known. */
  virtual void normal(const double *x, double *n) const = 0;
  /** Coefficient at x; HUGE_VAL: nothing slides on it. */
  virtual double friction_at(const double * /*x*/) const { return friction; }
  /** Velocity in this step of the surface with the normal n at x. */
  virtual void velocity(const double *x, const double *n, double *v) const = 0;
  /** Is the boundary a plane everywhere, so that only corners can meet it? */
  virtual bool is_plane() const { return false; }
  /** Takes up an impulse at x. Called on all ranks with the same values. */
  virtual void push(const double * /*x*/, const double * /*impulse*/) {}
};

/** A face of the box, or the region, of a fix mpm/boundary as an obstacle. */
class MPMWallObstacle : public MPMObstacle {
 public:
  /** face: index of the face; -1: the region. spacing: of the nodes. The motion of the wall in
   *  this step of duration dt must be known. */
  MPMWallObstacle(FixMPMBoundary &fix, const MPMWall &wall, const Domain &box, int face,
                  double spacing, double dt);
  double distance(const double *x, double far) const override;
  void normal(const double *x, double *n) const override;
  void velocity(const double *x, const double *n, double *v) const override;
  double friction_at(const double *x) const override;
  bool is_plane() const override { return plane; }
  void push(const double *x, const double *impulse) override;

 private:
  FixMPMBoundary &fix;
  const MPMWall &wall;
  const Domain &box;
  const int face;
  const bool plane;
  const double spacing, dt;

  void place(const double *x, double *y) const;
};

}    // namespace LAMMPS_NS
#endif
