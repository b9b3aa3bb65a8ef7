/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FRAME_H
#define LMP_MPM_FRAME_H

#include "atom.h"
#include "math/matrix.h"
#include "mpm_field.h"
#include "mpm_rows.h"

#include <algorithm>

namespace LAMMPS_NS {

/** The configuration that the nodes belong to, and how points strain in it. This class is the updated
 *  Lagrangian frame: nodes are places in space. Others derive from it; an axis of symmetry is a frame
 *  around one of these, see mpm_frame_axisymmetric.cpp.
 *
 *  Functions with a range of points are called once for each batch. */
class MPMFrame : protected Pointers {
 public:
  MPMFrame(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}
  virtual ~MPMFrame() = default;
  /** The frame that the options of a field ask for. */
  static std::unique_ptr<MPMFrame> create(class LAMMPS *, MPMField &, MPMPointState &);

  /** Stop where the box or other fixes do not suit the frame; start of a run. */
  virtual void check() const {}
  /** Start of a run, before points are sorted. */
  virtual void setup() {}
  /** Points were just exchanged between ranks; true when all places are new. */
  virtual bool renew_places() { return false; }
  /** End of a step. */
  virtual void end_of_step() {}

  /** Nodes are places of a reference configuration, which points do not leave. */
  virtual bool is_total() const { return false; }
  /** Where points are on the lattice, [n][3]. */
  virtual MPMRows places() const { return {atom->x[0], 3}; }
  MPM_NS::TransferKernels kernels(MPM_NS::Transfer, bool split) const;

  // points to nodes: does a batch need rows of its own for its forces, with room for them

  struct ForceRows {
    double P[9 * MPM_NS::BATCH + 8], f[3 * MPM_NS::BATCH + 8];
  };
  virtual bool changes_forces() const { return false; }
  /** rows: of the n points from first on, as if they were all. */
  virtual void forces(MPM_NS::PointRows &, int /*first*/, int /*n*/, ForceRows &) const {}

  // strain in a step; L: velocity gradients of the points with respect to the places of the lattice,
  // [n][dim*dim], column-major

  /** Room for all points, before the first of them. */
  virtual void begin_strain();
  /** Before and after points [first,last) move. */
  virtual void before_motion(int /*first*/, int /*last*/) {}
  virtual void after_motion(const MPM_NS::PointRows &, int /*first*/, int /*last*/) {}
  /** Strain that has to be interpolated from the nodes, where points do not move. base: of the tile. */
  virtual void strain_of_nodes(const MPM_NS::PointRows &, int /*first*/, int /*last*/,
                               const int * /*base*/, double /*dt*/, double /*shift*/)
  {
  }
  /** Gradients at the start of a step from those of another time in it, see mpm_frame.cpp. */
  virtual void shift_gradients(int n, double shift, double *L) const;
  /** [9], row-major: rate of a deformation gradient that all points have besides what they get of the nodes; null: there is none.
   *  Set by the init_physics() of who gives it (fix mpm/deform), of a total frame alone. */
  const double *mean_rate = nullptr;
  /** Does it strain them in this step? */
  bool strains_on_average() const
  {
    return mean_rate && std::any_of(mean_rate, mean_rate + 9, [](double r) {
             return r != 0.0;
           });
  }
  /** L is not yet what the laws need: gradients must go through refer_gradients(). */
  virtual bool refers() const { return false; }
  virtual void refer_gradients(int /*first*/, int /*n*/, double * /*L*/) const {}
  /** Kinematics of n points from first on; F, tau: rows of the first. */
  void load(MPM_NS::Batch &, int first, int n, double dt, const double *L, const double *F,
            const double *tau, const double *vol0) const;

  /** det(I + dt L) - 1 for a gradient L [DIM*DIM]: the relative change of a volume that moves with it. */
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
  /** Stretch the motion of a point in the step by the factor 1 + more, in all directions that are not
   *  held. */
  virtual void stretch(int i, double more, double dt, double *L);
  /** Is the third direction held, in plane strain? */
  bool is_plane() const { return field.lattice.dim == 2 && !field.options.changes_thickness(); }

  /** Deformation gradient with respect to the places of the lattice. */
  virtual void lattice_F(int i, double F[3][3]) const;
  /** Ratio of the volume at the places of the lattice to the initial volume. */
  virtual double lattice_jacobian(int i) const;

  /** Speed that must not cross a cell in a step, of a point with the wave speed c, which may rise. Where it is not above
   *  a known one, it may be too high, but not above that. */
  virtual double speed(int i, double &c, double known) const;

  /** Distance of a point from the axis of symmetry; x: its first coordinate at the start of the step. */
  virtual double radius(int /*i*/, double x) const { return x; }
  /** Length of the circle with radius r around the axis of symmetry; 1 without one. */
  virtual double circle(double /*r*/) const { return 1.0; }
  /** The same of a node: at the axis and beyond that of a quarter of a cell from it. */
  virtual double node_circle(int /*slot*/, int /*node*/) const { return 1.0; }
  /** Volume of a point before deformation for each unit of length around the axis. */
  virtual double section(int i) const { return atom->vfrac[i]; }

  /** Start of a run, and what there is to tell about it at its end: lines, or nothing. */
  virtual void start_counting() {}
  virtual std::string report() const { return ""; }
  virtual double memory_usage() const { return across.capacity() * sizeof(double); }
  virtual double bytes_per_point() const { return 0.0; }

 protected:
  MPMField &field;

  /** Strain A_zz of this step in 2d, of the points from first on; null: there is none. Around an axis
   *  of symmetry, or else what stretch() makes of plane strain. */
  virtual const double *hoop_strain(int first) const
  {
    return across.empty() ? nullptr : &across[first];
  }

 private:
  std::vector<double> across;    // [n] A_zz of stretch()
};

}    // namespace LAMMPS_NS
#endif
