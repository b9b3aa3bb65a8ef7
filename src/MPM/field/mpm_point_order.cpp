/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_point_order.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "group.h"
#include "lammps.h"

#include <algorithm>

using namespace LAMMPS_NS;

void LAMMPS_NS::put_in_order(LAMMPS *lmp, std::vector<int> &key, int nkeys)
{
  Atom *const atom = lmp->atom;
  Comm *const comm = lmp->comm;
  const int nlocal = atom->nlocal;
  const int firstbit = atom->firstgroupname ? lmp->group->bitmask[atom->firstgroup] : 0;
  const int others = firstbit ? nkeys + 1 : 0;
  const int all_keys = others + nkeys + 1;
  std::vector<int> start_of_key(all_keys + 1, 0);
  for (int i = 0; i < nlocal; i++) {
    if (key[i] < 0) key[i] = nkeys;
    if (!(atom->mask[i] & firstbit)) key[i] += others;
    start_of_key[key[i] + 1]++;
  }
  for (int k = 0; k < all_keys; k++) start_of_key[k + 1] += start_of_key[k];
  std::vector<int> permute(nlocal), next(start_of_key.begin(), start_of_key.end() - 1);
  for (int i = 0; i < nlocal; i++) permute[next[key[i]]++] = i;
  const tagint *tag = atom->tag;
  for (int k = 0; k < all_keys; k++)
    if (k != nkeys && k != others + nkeys && start_of_key[k + 1] - start_of_key[k] > 1)
      std::sort(permute.begin() + start_of_key[k], permute.begin() + start_of_key[k + 1],
                [tag](int i, int j) {
                  return tag[i] < tag[j];
                });

  // ghosts refer to the old order, and the first of them is in the free place that is used below:
  // the map must forget them before

  const bool mapped = atom->map_style != Atom::MAP_NONE;
  const bool moves = !std::is_sorted(permute.begin(), permute.end());
  bigint renew = atom->nghost + (moves && mapped), renew_all;
  MPI_Allreduce(&renew, &renew_all, 1, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  if (renew_all) {
    if (mapped) atom->map_clear();    // as in exchange(), for borders()
    atom->nghost = 0;                 // else borders() appends to them
    atom->avec->clear_bonus();
  }

  // move the atoms, cycle by cycle, through the free place at the end

  if (nlocal == atom->nmax) atom->avec->grow(0);
  std::vector<int> &current = key;
  for (int i = 0; i < nlocal; i++) current[i] = i;
  for (int i = 0; i < nlocal; i++) {
    if (current[i] == permute[i]) continue;
    atom->avec->copy(i, nlocal, 0);
    int empty = i;
    while (permute[empty] != i) {
      atom->avec->copy(permute[empty], empty, 0);
      empty = current[empty] = permute[empty];
    }
    atom->avec->copy(nlocal, empty, 0);
    current[empty] = permute[empty];
  }

  if (renew_all) comm->borders();
}
