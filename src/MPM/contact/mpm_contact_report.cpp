/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/mpm_contact_report.h"

#include "contact/mpm_node_contact.h"
#include "force.h"
#include "update.h"

#include <mpi.h>

using namespace LAMMPS_NS;

double MPMContactReport::Entry::add(const MPMNodeContact &pair, int dim)
{
  double friction = 0.0;
  count += 1.0;
  for (int d = 0; d < dim; d++) {
    impulse[d] += pair.impulse(d);
    friction += pair.tangential[d] * (pair.rb[d] - pair.ra[d]);
  }
  return friction;
}

void MPMContactReport::set_bodies(int n)
{
  nbodies = n;
  entries.assign(n * (n - 1) / 2, {});
}

void MPMContactReport::begin_step(double dt)
{
  dt_last = dt;
  for (auto &entry : entries) entry = {{0.0, 0.0, 0.0}, 0.0, entry.work};
}

double MPMContactReport::work()
{
  double mine = 0.0, all;
  for (const auto &entry : entries) mine += entry.work;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all * force->mvv2e;
}

double MPMContactReport::at(int row, int column)
{
  if (sums_step != update->ntimestep) {
    sums_step = update->ntimestep;
    std::vector<double> mine;
    for (const auto &[impulse, count, work] : entries) {
      for (const double J : impulse)
        mine.push_back(dt_last > 0.0 ? J / (dt_last * force->ftm2v) : 0.0);
      mine.push_back(count);
      mine.push_back(work * force->mvv2e);
    }
    sums.resize(mine.size());
    MPI_Allreduce(mine.data(), sums.data(), (int) mine.size(), MPI_DOUBLE, MPI_SUM, world);
  }
  return sums[COLUMNS * row + column];
}
