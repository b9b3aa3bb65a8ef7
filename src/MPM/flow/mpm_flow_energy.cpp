/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_energy.h"

#include "flow/mpm_flow_parts.h"

#include "math_extra.h"

#include <algorithm>

using namespace LAMMPS_NS;

void MPMFlowEnergy::begin()
{
  *this = MPMFlowEnergy();
}

void MPMFlowEnergy::look(double all_kinetic, double all_work, double all_in_play, bigint n)
{
  const double now = all_kinetic - all_work;
  if (npoints < 0)
    least = now;
  else if (n != npoints || !counts)
    least += now - last;
  npoints = n;
  last = now;
  least = std::min(least, now);
  most = std::max({most, all_kinetic, all_in_play});
  largest = std::max(largest, gain());
}

std::array<double, 2> MPMFlowEnergy::largest_gain()
{
  const double found = largest;
  largest = 0.0;
  return {found, most};
}

std::array<double, MPMFlowEnergy::NREAL> MPMFlowEnergy::state(double all_kinetic, double all_work,
                                                              double all_in_play) const
{
  return {all_kinetic, all_work, last, least, most, (double) npoints, all_in_play, (double) counts};
}

void MPMFlowEnergy::set_state(const double *from, bool is_first)
{
  kinetic = is_first ? from[0] : 0.0;
  work = is_first ? from[1] : 0.0;
  last = from[2];
  least = from[3];
  most = from[4];
  npoints = (bigint) from[5];
  in_play = is_first ? from[6] : 0.0;
  counts = from[7] > 0.0;
}

bool LAMMPS_NS::only_forces_work(const MPMFlowParts &parts, const MPMIncompressibleOptions &options)
{
  if (parts.gas || parts.bodies || parts.tension || parts.grains || parts.inflow ||
      (parts.regions && parts.regions->largest_speed() > 0.0))
    return false;
  for (const auto &axis_walls : options.walls)
    for (const auto &face : axis_walls)
      if (face.sticks && MathExtra::lensq3(face.v) > 0.0) return false;
  return true;
}
