/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_traffic.h"

#include "atom.h"
#include "atom_vec.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_guard.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_point_map.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "math/matrix.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMTraffic::add(const MPMTraffic &other)
{
  for (int k = 0; k < NREAL; k++) reals()[k] += other.reals()[k];
}

MPMField *LAMMPS_NS::field_of(LAMMPS *lmp, int i)
{
  for (auto *field : MPMField::all(lmp))
    if (field->is_point(i)) return field;
  return nullptr;
}

MPMTraffic LAMMPS_NS::traffic_of(LAMMPS *lmp, MPMField *field, int i)
{
  const Atom *const atom = lmp->atom;
  const double *const v = atom->v[i], m = atom->rmass[i];
  MPMTraffic one;
  one.points = 1.0;
  one.mass = m;
  for (int d = 0; d < 3; d++) one.momentum[d] = m * v[d];
  one.kinetic = 0.5 * lmp->force->mvv2e * m * dot(v, v);
  const FixMPMMaterial *const material = field ? field->material_of(i) : nullptr;
  if (!material) return one;
  double w[BATCH] = {0.0};
  load_state(*field, *field->batch, &i, 1, material);
  material->material->stored_energy(*field->batch, w);
  one.stored = atom->vfrac[i] * w[0] / lmp->force->nktv2p;
  return one;
}

/** As at the beginning of Comm::exchange(). */
void LAMMPS_NS::begin_traffic(LAMMPS *lmp)
{
  Atom *const atom = lmp->atom;
  if (atom->map_style != Atom::MAP_NONE) atom->map_clear();
  atom->nghost = 0;
  atom->avec->clear_bonus();
}

void LAMMPS_NS::end_traffic(LAMMPS *lmp)
{
  Atom *const atom = lmp->atom;
  if (atom->map_style != Atom::MAP_NONE) {
    atom->map_init();
    atom->map_set();
  }
  for (auto *field : MPMField::all(lmp)) field->map->valid = false;
}

MPMTraffic LAMMPS_NS::remove_points(LAMMPS *lmp, const std::function<bool(int i)> &leaves,
                                    bool meant)
{
  Atom *const atom = lmp->atom;
  MPMTraffic mine, all;
  std::vector<int> list;
  for (int i = atom->nlocal - 1; i >= 0; i--)
    if (leaves(i)) list.push_back(i);
  const bigint n = (bigint) list.size();
  bigint nall;
  MPI_Allreduce(&n, &nall, 1, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  if (nall == 0) return all;

  begin_traffic(lmp);
  for (const int i : list) {
    MPMField *const field = field_of(lmp, i);
    const MPMTraffic one = traffic_of(lmp, field, i);
    mine.add(one);
    if (field) field->ledger.remove(one.kinetic, one.stored);
    atom->avec->copy(atom->nlocal - 1, i, 1);
    atom->nlocal--;
  }
  MPI_Allreduce(mine.reals(), all.reals(), MPMTraffic::NREAL, MPI_DOUBLE, MPI_SUM, lmp->world);
  atom->natoms -= nall;
  end_traffic(lmp);
  // the sum over all fields counts, see MPMEnergyWatch
  if (meant && !MPMField::all(lmp).empty()) MPMField::all(lmp)[0]->guard->brought -= all.points;
  return all;
}
