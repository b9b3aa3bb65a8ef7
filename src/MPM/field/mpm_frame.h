/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FRAME_H
#define LMP_MPM_FRAME_H

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "math/matrix.h"

#include <algorithm>

namespace LAMMPS_NS {

/** The configuration that the nodes belong to, and the strain of points in it. This class is the
 *  updated Lagrangian frame, in which nodes are places in space. Other frames derive from it; the
 *  frame of an axis of symmetry wraps another frame.
 *
 *  Functions with a range of points are called once for each batch. */
class MPMFrame : protected Pointers {
 public:
  MPMFrame(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}
  virtual ~MPMFrame() = default;
  /** The frame that the options of a field ask for. */
  static std::unique_ptr<MPMFrame> create(class LAMMPS *, MPMField &, MPMPointState &);

  /** Start of a run: stops with an error if the box or other fixes do not suit the frame. */
  virtual void check() const {}
  /** Start of a run, before points are sorted. */
  virtual void setup() {}
  /** Called after points were exchanged between ranks. Returns true if all places are new. */
  virtual bool renew_places() { return false; }
  /** End of a step. */
  virtual void end_of_step() {}

  /** Are nodes places of a reference configuration, in which points do not move? */
  virtual bool is_total() const { return false; }
  /** Positions of points on the lattice, [n][3]. */
  virtual MPMRows places() const { return {atom->x[0], 3}; }
  /** Kernels of a transfer in this frame. split: keep force and old velocity apart (FLIP, energy
   *  ledger). */
  MPM_NS::TransferKernels kernels(MPM_NS::Transfer, bool split) const;

  // Transfer from points to nodes: rows for the forces of a batch, used if changes_forces()

  struct ForceRows {
    double P[9 * MPM_NS::BATCH + 8], f[3 * MPM_NS::BATCH + 8];
  };
  virtual bool changes_forces() const { return false; }
  /** Sets the forces of n points from first on. The row pointers are shifted to the first of these
   *  points. */
  virtual void forces(MPM_NS::PointRows &, int /*first*/, int /*n*/, ForceRows &) const {}

  // strain in a step. L: velocity gradients of the points with respect to the places of the
  // lattice, [n][dim*dim], column-major

  /** Allocates room for all points, before the first of them is strained. */
  virtual void begin_strain();
  /** Called before and after points [first,last) move. */
  virtual void before_motion(int /*first*/, int /*last*/) {}
  virtual void after_motion(const MPM_NS::PointRows &, int /*first*/, int /*last*/) {}
  /** Strain that is interpolated from the nodes before points move. base: base node of the tile. */
  virtual void strain_of_nodes(const MPM_NS::PointRows &, int /*first*/, int /*last*/,
                               const int * /*base*/, double /*dt*/, double /*shift*/)
  {
  }
  /** Converts gradients of another time within the step to those at its start, see
   *  mpm_frame.cpp. */
  virtual void shift_gradients(int n, double shift, double *L) const;
  /** [9], row-major: rate of a deformation gradient that all points have in addition to what the
   *  nodes give; null: none. Set in init_physics() of the fix that prescribes it (fix mpm/deform);
   *  only in a total frame. */
  const double *mean_rate = nullptr;
  /** Is this mean rate nonzero in this step? */
  bool strains_on_average() const
  {
    return mean_rate && std::any_of(mean_rate, mean_rate + 9, [](double r) {
             return r != 0.0;
           });
  }
  /** Must L go through refer_gradients() before material laws can use it? */
  virtual bool refers() const { return false; }
  virtual void refer_gradients(int /*first*/, int /*n*/, double * /*L*/) const {}
  /** Loads the kinematics of n points from first on into a batch. F, tau: rows of the first of
   *  these points. */
  void load(MPM_NS::Batch &, int first, int n, double dt, const double *L, const double *F,
            const double *tau, const double *vol0) const;

  /** det(I + dt L) - 1 for a gradient L [DIM*DIM]: the relative change of a volume that moves with
   *  it. */
  template <int DIM> static double growth(const double *L, double dt)
  {
    double A[DIM * DIM];
    for (int c = 0; c < DIM * DIM; c++) A[c] = dt * L[c];
    if constexpr (DIM == 2) {
      return A[0] + A[3] + (A[0] * A[3] - A[1] * A[2]);
    } else {
      const double minors =
          A[0] * A[4] - A[1] * A[3] + A[0] * A[8] - A[2] * A[6] + A[4] * A[8] - A[5] * A[7];
      return A[0] + A[4] + A[8] + minors + MPM_NS::determinant(A);
    }
  }
  /** Relative change of the volume of a point in a step. */
  virtual double volume_change(int i, const double *L, double dt) const;
  /** Multiplies the stretch of a point in the step by the factor 1 + more, in all directions that
   *  are not held. */
  virtual void stretch(int i, double more, double dt, double *L);
  /** Is the third direction held (plane strain)? */
  bool is_plane() const { return field.lattice.dim == 2 && !field.options.changes_thickness(); }

  /** Deformation gradient with respect to the places of the lattice. */
  virtual void lattice_F(int i, double F[3][3]) const;
  /** Ratio of the volume at the places of the lattice to the initial volume. */
  virtual double lattice_jacobian(int i) const { return field.points->jacobian(i); }

  /** Speed that a point with the wave speed c has with respect to the stability limit (it must not
   *  cross a cell in a step). c may be raised. If the speed does not exceed a known one, the result
   *  may be too high, but not above the known one. */
  virtual double speed(int i, double &c, double known) const;

  /** Distance of a point from the axis of symmetry. x: its first coordinate at the start of the
   *  step. */
  virtual double radius(int /*i*/, double x) const { return x; }
  /** Length of the circle with radius r around the axis of symmetry; 1 without an axis. */
  virtual double circle(double /*r*/) const { return 1.0; }
  /** The same for a node. At the axis and beyond it, the length at a quarter of a cell from the
   *  axis. */
  virtual double node_circle(int /*slot*/, int /*node*/) const { return 1.0; }
  /** Initial volume of a point per unit of length around the axis. */
  virtual double section(int i) const { return atom->vfrac[i]; }

  /** Counters start at the start of a run; report() returns lines for the log at its end, or
   *  nothing. */
  virtual void start_counting() {}
  virtual std::string report() const { return ""; }
  virtual double memory_usage() const { return across.capacity() * sizeof(double); }
  virtual double bytes_per_point() const { return 0.0; }

 protected:
  MPMField &field;

  /** Strain A_zz of this step in 2d, of the points from first on; null: none. It is the hoop strain
   *  around an axis of symmetry, or else what stretch() makes of plane strain. */
  virtual const double *hoop_strain(int first) const
  {
    return across.empty() ? nullptr : &across[first];
  }

 private:
  std::vector<double> across;    // [n] A_zz from stretch()
};

/** Total Lagrangian frame: nodes are places of a reference configuration, which may be updated. */
class MPMFrameTotal : public MPMFrame {
 public:
  MPMRows X;    ///< [n][3] reference position, NAN before it is known
  /** [n][9] F at the last update of the reference, row-major; null: no updates. */
  MPMRows R;

  MPMFrameTotal(class LAMMPS *, MPMField &, MPMPointState &);

  void setup() override;
  bool renew_places() override;
  void end_of_step() override;
  bool is_total() const override { return true; }
  MPMRows places() const override { return X; }
  bool changes_forces() const override { return true; }
  void forces(MPM_NS::PointRows &, int first, int n, ForceRows &) const override;
  void shift_gradients(int, double, double *) const override {}
  bool refers() const override { return R || mean_rate; }
  void refer_gradients(int first, int n, double *L) const override;
  double volume_change(int i, const double *L, double dt) const override;
  void lattice_F(int i, double F[3][3]) const override;
  double lattice_jacobian(int i) const override { return R ? MPMPoints::det(R[i]) : 1.0; }
  double speed(int i, double &c, double known) const override;
  double radius(int i, double x) const override;
  void start_counting() override { nupdate = 0; }
  std::string report() const override;

 private:
  bigint nupdate = 0;         // updates of the reference in this run
  bool refer_anew = false;    // the present configuration is to become the reference

  void stretches(int i, double &smallest, double &largest) const;
};

}    // namespace LAMMPS_NS
#endif
