/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STAGE_DATA_H
#define LMP_MPM_STAGE_DATA_H

#include <initializer_list>
#include <string>

namespace LAMMPS_NS {

/** Data that a stage of the step reads, or writes. plan yes prints them, and test_plan checks that
 *  a stage writes nothing else. */
class MPMStageData {
 public:
  enum Datum {
    POSITION,       ///< of points (atom->x)
    VELOCITY,       ///< of points (atom->v)
    AFFINE,         ///< matrices of points that go to the nodes with the velocity
    DEFORMATION,    ///< gradient F of points
    STRESS,         ///< tau of points
    HISTORY,        ///< variables of the laws of points
    MASS,           ///< of points
    FORCE,          ///< on points and other atoms (atom->f, atom->torque)
    NODES,          ///< records of the lattice: mass, momentum or velocity, force
    BLOCKS,         ///< active blocks, and the points in each
    OWN,    ///< what the owner of the stage keeps itself, such as energies or its own node fields
    NDATA
  };

  MPMStageData(std::initializer_list<Datum> data)
  {
    for (const auto datum : data) bits |= 1u << datum;
  }
  MPMStageData operator+(const MPMStageData &other) const
  {
    MPMStageData sum = *this;
    sum.bits |= other.bits;
    return sum;
  }
  bool has(Datum datum) const { return bits >> datum & 1u; }
  bool empty() const { return bits == 0; }
  /** Names, as in plan yes. */
  std::string text() const
  {
    static const char *const names[NDATA] = {"x",    "v", "C",     "F",      "tau", "history",
                                             "mass", "f", "nodes", "blocks", "own"};
    std::string list;
    for (int k = 0; k < NDATA; k++)
      if (has((Datum) k)) list += (list.empty() ? "" : " ") + std::string(names[k]);
    return list;
  }

 private:
  unsigned bits = 0;
};

}    // namespace LAMMPS_NS
#endif
