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

#include <memory>

namespace MPM_NS {
class Material;
class MaterialPoint;
struct MixedControl;
}    // namespace MPM_NS

namespace LAMMPS_NS {

/** Drives one material point along a path of strain or stress and writes a table. */
class MPMPoint : public Command {
 public:
  MPMPoint(class LAMMPS *);
  ~MPMPoint() override;
  void command(int, char **) override;

 private:
  /** A number, or an equal-style variable. */
  struct Value {
    double number;
    std::string variable;
  };
  /** Control of a component of the motion, which takes the place of what the path says. */
  struct Component {
    enum { AS_PATH, RATE, STRESS } kind;
    Value value;
  };

  enum Path {
    UNIAXIAL_STRESS,
    UNIAXIAL_STRAIN,
    SHEAR,
    BIAXIAL,
    TRIAXIAL,
    VOLUMETRIC,
    SHOCK,
    MIXED,
    NPATHS
  };
  Path path;
  double rate, pressure;    // of the path
  double duration, strain, amplitude, cycles, temperature, length;
  bigint nsteps, every;
  double axis[3], turns;    // of the superposed rotation
  std::string clock;        // internal-style variable that gets the time
  Component component[6];
  Value spin[3];
  std::string file;

  std::unique_ptr<MPM_NS::Material> material;
  std::vector<bool> range_left;
  FILE *fp;
  bigint iterations;

  void parse(int, char **);
  int parse_path(int, char **);
  Value parse_value(int, char **);
  double evaluate(const Value &, double time);
  double path_strain(double time) const;
  MPM_NS::MixedControl control(double t0, double t1, bool started, double share);
  void run_path(MPM_NS::MaterialPoint &);
  void run_shock(MPM_NS::MaterialPoint &);
  void set_temperature(MPM_NS::MaterialPoint &);
  void check(const MPM_NS::MaterialPoint &, bigint step);
  void open_table();
  std::vector<std::pair<std::string, double>> row(const MPM_NS::MaterialPoint &, bigint step);
  void write(const MPM_NS::MaterialPoint &, bigint step);
};

}    // namespace LAMMPS_NS
#endif
#endif
