/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMMAND_CLASS
// clang-format off
CommandStyle(mpm_point,MPMPoint);
// clang-format on
#else

#ifndef LMP_MPM_POINT_H
#define LMP_MPM_POINT_H

#include "command.h"
#include "declare/option.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

namespace MPM_NS {
class Material;
class MaterialPoint;
struct MixedControl;
}    // namespace MPM_NS

namespace LAMMPS_NS {

struct MPMPointOptions {
  /** Control of one component of the motion, which replaces the control by the path. */
  struct Component {
    enum Kind { AS_PATH, RATE, STRESS } kind = AS_PATH;
    MPM_NS::NumberOrVariable value;
  };
  enum Path {
    UNIAXIAL_STRESS,
    UNIAXIAL_STRAIN,
    SHEAR,
    BIAXIAL,
    TRIAXIAL,
    VOLUMETRIC,
    SHOCK,
    MIXED
  };
  static constexpr double NOT_GIVEN = -1.0;

  Path path = MIXED;
  double rate = 0.0, pressure = 0.0;    ///< parameters of the path

  double duration = NOT_GIVEN, strain = NOT_GIVEN, amplitude = NOT_GIVEN, cycles = 0.0;
  int64_t nsteps = 1000, every = 0;
  double axis[3] = {0.0, 0.0, 0.0}, turns = 0.0;    ///< of the superposed rotation
  std::string clock;    ///< internal-style variable that is set to the time
  Component component[6];
  MPM_NS::NumberOrVariable spin[3];
  double temperature = NAN, length = 1.0;

  MPM_NS::Options declare();
};

/** Command mpm_point: drives one material point along a path of strain or stress, and writes a
 *  table. */
class MPMPoint : public Command, private MPMPointOptions {
 public:
  MPMPoint(class LAMMPS *);
  ~MPMPoint() override;
  void command(int, char **) override;

 private:
  std::string file;

  std::unique_ptr<MPM_NS::Material> material;
  std::vector<bool> range_left;
  FILE *fp = nullptr;
  bigint iterations = 0;
  double initial_pressure = 0.0;    // along the normal of a shock, ahead of it

  void parse(int, char **);
  double value_at(const MPM_NS::NumberOrVariable &, double time);
  double path_strain(double time) const;
  MPM_NS::MixedControl control(double t0, double t1, bool started, double share);
  void run_path(MPM_NS::MaterialPoint &);
  void run_shock(MPM_NS::MaterialPoint &);
  void set_temperature(MPM_NS::MaterialPoint &);
  void check(const MPM_NS::MaterialPoint &, bigint step);
  std::vector<std::pair<std::string, double>> row(const MPM_NS::MaterialPoint &, bigint step);
  void write(const MPM_NS::MaterialPoint &, bigint step);
};

}    // namespace LAMMPS_NS
#endif
#endif
