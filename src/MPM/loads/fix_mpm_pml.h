/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/pml,FixMPMPML);
// clang-format on
#else

#ifndef LMP_FIX_MPM_PML_H
#define LMP_FIX_MPM_PML_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_forces.h"
#include "field/mpm_nodes.h"
#include "field/mpm_physics.h"

#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/pml. */
struct MPMPMLOptions {
  static constexpr int NFACE = 6;

  int cells[NFACE] = {0, 0, 0, 0, 0, 0};    ///< of the layer at each face of the box, xlo ... zhi
  double reflection = 1.0e-4;    ///< reflected share of the amplitude of a wave along the normal
  double exponent = 2.0;         ///< exponent of the depth in the profile of damping
  double speed = 0.0;            ///< wave speed; 0: of the fastest wave in the layers
  double mix = 0.0;              ///< share of the damping of an axis that is added to other axes

  MPM_NS::Options declare(int dimension);
};

/** Perfectly matched layers next to faces of the box (unsplit, after Basu and Chopra). Points there
 *  see stretched coordinates in which waves decay, and incoming waves are not reflected, at any
 *  angle. The initial stress of the layers is kept. */
class FixMPMPML : public FixMPMState, public MPMPhysics, public MPMStretch, private MPMPMLOptions {
 public:
  FixMPMPML(class LAMMPS *, int, char **);
  int setmask() override { return 0; }
  void init() override;
  void setup(int) override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int k) override { return k == 0 ? known : largest; }
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  void topology_changed(MPMField &) override;
  bool looks_beyond_points() const override { return false; }
  double wave_speed(const MPMField &, int i, double c) const override;
  bool stretches(int first, int n) const override;
  void stretch_gradients(MPMField &, int first, int n, double dt, double *L) override;
  std::vector<Account> accounts() const override { return {{"matched layers", false}}; }
  void account(double *values) const override { values[0] += work_of_nodes + work_of_strain; }

 private:
  // for each point; all are zero outside of the layers
  MPMRows rows;
  enum {
    DAMPING,              // along each axis [1/time]
    TAU = DAMPING + 3,    // Kirchhoff stress at the start
    START = TAU + 6,      // position at the start, without periodic images
    G = START + 3,        // displacement gradient in stretched coordinates, like velocity gradients
    SUM = G + 9,          // integral of the change of stress over time, half a step ago
    WIDTH_2D = SUM + 6,
    SUM_OF_SUM = WIDTH_2D,    // integral of SUM over time
    WAY = SUM_OF_SUM + 6,     // integral of the displacement, half a step ago
    WIDTH_3D = WAY + 3
  };

  struct Body {
    MPMField *field;
    // [node] force, later impulse [3]; damping of its mass [mass/time]
    MPM_NS::NodeField *pushes;
    struct Point {
      int i, slot;
    };
    std::vector<Point> points;
  };
  std::vector<Body> bodies;
  // [n] valid until the topology is renewed, when points move in memory
  std::vector<char> is_inside;
  bool defined = false;
  double known = 0.0;                                  // number of points in the layers
  double largest = 0.0;                                // largest damping along one axis
  double work_of_nodes = 0.0, work_of_strain = 0.0;    // this rank's shares [energy]
  bool warned = false;

  double thickness(const MPMField &, int face) const;
  double depth(const MPMField &, int face, const double *x) const;
  void define();
  void find_forces(Body &);
  void apply(Body &);
  void count_work(Body &);
};

}    // namespace LAMMPS_NS
#endif
#endif
