/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/fix_mpm_cells.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "grid2d.h"
#include "grid3d.h"
#include "memory.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// sums over the points of a cell, and the averages that are made of them

enum { MASS, MOMENTUM, VOLUME = MOMENTUM + 3, STRESS, NSUM = STRESS + 6 };
enum { DENSITY, VELOCITY, CAUCHY, PRESSURE, FILLED, NAVERAGE };

static const struct {
  const char *name;
  int ncolumn;    // 0: scalar
} fields[NAVERAGE] = {
    {"density", 0}, {"velocity", 3}, {"stress", 6}, {"pressure", 0}, {"fraction", 0}};

/** fix ID group mpm/cells FIXID */
FixMPMCells::FixMPMCells(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  require_arguments(lmp, "fix mpm/cells", narg, 3, {"fix-ID"});
  if (narg > 4) error->all(FLERR, 4, "Unknown fix mpm/cells argument: {}", arg[4]);

  pergrid_flag = 1;
  pergrid_freq = 1;
  dim = domain->dimension;
  field_id = arg[3];
  set_size();
  FixMPMCells::reset_grid();
}

/** The number of cells that come closest to those of the lattice. */
void FixMPMCells::set_size()
{
  const auto *field = MPMField::find(lmp, field_id);
  if (!field)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix {} (style mpm/cells) needs a fix mpm, and {} is none: average columns of compute "
        "mpm/atom by fix ave/grid",
        id, field_id);
  for (int d = 0; d < 3; d++)
    ncell[d] = d < dim ? std::max(1, (int) std::lround(domain->prd[d] / field->lattice.h)) : 1;
}

void FixMPMCells::init()
{
  const int old[3] = {ncell[0], ncell[1], ncell[2]};
  set_size();
  if (!std::equal(old, old + 3, ncell) || skin != neighbor->skin) reset_grid();
  filled = -1;
}

/** The partition has changed; points may not have migrated yet. */
void FixMPMCells::reset_grid()
{
  deallocate();
  skin = neighbor->skin;
  owned = all = {{0, 0, 0}, {0, 0, 0}};
  int nbuf1, nbuf2;
  if (dim == 2) {
    grid2d = new Grid2d(lmp, world, ncell[0], ncell[1]);
    grid2d->set_distance(0.5 * skin);
    grid2d->setup_grid(owned.lo[0], owned.hi[0], owned.lo[1], owned.hi[1], all.lo[0], all.hi[0],
                       all.lo[1], all.hi[1]);
    grid2d->setup_comm(nbuf1, nbuf2);
  } else {
    grid3d = new Grid3d(lmp, world, ncell[0], ncell[1], ncell[2]);
    grid3d->set_distance(0.5 * skin);
    grid3d->setup_grid(owned.lo[0], owned.hi[0], owned.lo[1], owned.hi[1], owned.lo[2], owned.hi[2],
                       all.lo[0], all.hi[0], all.lo[1], all.hi[1], all.lo[2], all.hi[2]);
    grid3d->setup_comm(nbuf1, nbuf2);
  }
  buf1.resize(nbuf1 * NSUM);
  buf2.resize(nbuf2 * NSUM);

  averages.assign(NAVERAGE, {nullptr, nullptr});
  for (int k = 0; k < NAVERAGE; k++) {
    const int n = fields[k].ncolumn, *lo = owned.lo, *hi = owned.hi;
    const char *name = "mpm/cells:average";
    auto &a = averages[k];
    if (n == 0)
      memory->create3d_offset(a.scalar, lo[2], hi[2], lo[1], hi[1], lo[0], hi[0], name);
    else
      memory->create4d_offset_last(a.vector, lo[2], hi[2], lo[1], hi[1], lo[0], hi[0], n, name);
  }
  filled = -1;
}

void FixMPMCells::deallocate()
{
  delete grid2d;
  delete grid3d;
  grid2d = nullptr;
  grid3d = nullptr;
  const int *lo = owned.lo;
  for (auto &a : averages) {
    memory->destroy3d_offset(a.scalar, lo[2], lo[1], lo[0]);
    memory->destroy4d_offset_last(a.vector, lo[2], lo[1], lo[0]);
  }
  averages.clear();
}

/** Values of average k in a cell. */
double *FixMPMCells::value(int k, int x, int y, int z)
{
  const auto &a = averages[k];
  return a.scalar ? &a.scalar[z][y][x] : a.vector[z][y][x];
}

void FixMPMCells::sum_points()
{
  sums.assign(all.size() * NSUM, 0.0);
  const auto *points = MPMPoints::get(atom);
  int outside = 0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || !(atom->vfrac[i] > 0.0)) continue;
    int cell[3] = {0, 0, 0};
    bool inside = true;
    for (int d = 0; d < dim; d++) {
      cell[d] = (int) std::floor((atom->x[i][d] - domain->boxlo[d]) / domain->prd[d] * ncell[d]);
      if (!domain->periodicity[d]) cell[d] = std::clamp(cell[d], 0, ncell[d] - 1);
      inside = inside && cell[d] >= all.lo[d] && cell[d] <= all.hi[d];
    }
    if (!inside) {
      outside++;
      continue;
    }
    double *sum = &sums[all.index(cell[0], cell[1], cell[2]) * NSUM];
    const double mass = atom->rmass[i], vol0 = atom->vfrac[i];
    sum[MASS] += mass;
    for (int d = 0; d < 3; d++) sum[MOMENTUM + d] += mass * atom->v[i][d];
    sum[VOLUME] += vol0 * points->jacobian(i);
    for (int c = 0; c < 6; c++) sum[STRESS + c] += vol0 * points->tau[i][c];
  }
  if (outside)
    error->one(FLERR, Error::NOLASTLINE,
               "Fix {} (style mpm/cells): {} points are more than half the neighbor skin away from "
               "the part of their process: use a larger neighbor skin or neigh_modify every 1 "
               "delay 0 check yes",
               id, outside);

  if (dim == 2)
    grid2d->reverse_comm(Grid2d::FIX, this, 0, NSUM, sizeof(double), buf1.data(), buf2.data(),
                         MPI_DOUBLE);
  else
    grid3d->reverse_comm(Grid3d::FIX, this, 0, NSUM, sizeof(double), buf1.data(), buf2.data(),
                         MPI_DOUBLE);
}

void FixMPMCells::pack_reverse_grid(int, void *vbuf, int nlist, int *list)
{
  auto *buf = static_cast<double *>(vbuf);
  for (int i = 0; i < nlist; i++, buf += NSUM)
    std::copy_n(&sums[(bigint) list[i] * NSUM], NSUM, buf);
}

void FixMPMCells::unpack_reverse_grid(int, void *vbuf, int nlist, int *list)
{
  const auto *buf = static_cast<const double *>(vbuf);
  for (int i = 0; i < nlist; i++)
    for (int k = 0; k < NSUM; k++) sums[(bigint) list[i] * NSUM + k] += *buf++;
}

void FixMPMCells::average()
{
  double area = 1.0;
  for (int d = 0; d < dim; d++) area *= domain->prd[d] / ncell[d];
  const auto *field = MPMField::find(lmp, field_id);

  for (int z = owned.lo[2]; z <= owned.hi[2]; z++)
    for (int y = owned.lo[1]; y <= owned.hi[1]; y++)
      for (int x = owned.lo[0]; x <= owned.hi[0]; x++) {
        const double *sum = &sums[all.index(x, y, z) * NSUM];
        const double radius = domain->boxlo[0] + (x + 0.5) * domain->prd[0] / ncell[0];
        const double cell_volume = area * (field ? field->frame->circle(radius) : 1.0);
        const double per_mass = sum[MASS] > 0.0 ? 1.0 / sum[MASS] : 0.0;
        const double per_volume = sum[VOLUME] > 0.0 ? 1.0 / sum[VOLUME] : 0.0;
        *value(DENSITY, x, y, z) = sum[MASS] / cell_volume;
        *value(FILLED, x, y, z) = sum[VOLUME] / cell_volume;
        for (int d = 0; d < 3; d++) value(VELOCITY, x, y, z)[d] = per_mass * sum[MOMENTUM + d];
        for (int c = 0; c < 6; c++) value(CAUCHY, x, y, z)[c] = per_volume * sum[STRESS + c];
        *value(PRESSURE, x, y, z) =
            -per_volume * (sum[STRESS] + sum[STRESS + 1] + sum[STRESS + 2]) / 3.0;
      }
}

// what dump grid and fix ave/grid ask for

int FixMPMCells::get_grid_by_name(const std::string &name, int &dimension)
{
  if (name != "cell") return -1;
  dimension = dim;
  return 0;
}

void *FixMPMCells::get_grid_by_index(int index)
{
  if (index != 0) return nullptr;
  return dim == 2 ? (void *) grid2d : (void *) grid3d;
}

int FixMPMCells::get_griddata_by_name(int index, const std::string &name, int &ncolumn)
{
  if (index != 0) return -1;
  for (int k = 0; k < NAVERAGE; k++)
    if (name == fields[k].name) {
      ncolumn = fields[k].ncolumn;
      return k;
    }
  return -1;
}

/** All processes ask at the same time, so that the data can be made here. */
void *FixMPMCells::get_griddata_by_index(int index)
{
  if (index < 0 || index >= NAVERAGE) return nullptr;
  if (filled != update->ntimestep) {
    filled = update->ntimestep;
    sum_points();
    average();
  }
  const auto &a = averages[index];    // both null on a process without cells
  if (dim == 3) return a.scalar ? (void *) a.scalar : (void *) a.vector;
  if (a.scalar) return a.scalar[0];
  return a.vector ? a.vector[0] : nullptr;
}

double FixMPMCells::memory_usage()
{
  return (double) sums.capacity() * sizeof(double) + (double) owned.size() * 12 * sizeof(double);
}
