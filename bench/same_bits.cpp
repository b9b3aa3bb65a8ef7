/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Plugin with the command state_hash for bench/same_bits.py, which compiles it against LAMMPS's own
// headers alone, so that it works with any version of the package. It prints the number of atoms, a
// hash of all that a restart file has of each atom, and sums of |x|, |v| and of the rest.
//
// The hash is a sum over all numbers of all atoms: it does not depend on the order of the atoms, on
// the ranks that have them, nor on the order of the numbers of an atom. Zeros do not count, nor do
// the lengths of an atom's row and of each fix's part of it. A part with a NaN in it counts as one
// NaN: fix mpm marks so what it does not know of an atom, such as one that is no point of it, and
// the rest of the part may be anything then.

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "command.h"
#include "fix.h"
#include "lammpsplugin.h"
#include "modify.h"
#include "utils.h"
#include "version.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

using namespace LAMMPS_NS;

namespace {

uint64_t splitmix64(uint64_t z)
{
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

class StateHash : public Command {
  uint64_t hash = 0;
  double sums[3] = {0.0, 0.0, 0.0};    // of |x|, |v|, and of the rest

  void add(double value, uint64_t salt, double &sum)
  {
    if (value == 0.0) return;
    uint64_t bits = 0x7ff8000000000000u;    // any number that is none
    if (value == value) memcpy(&bits, &value, sizeof(bits));
    hash += splitmix64(bits ^ salt);
    if (std::isfinite(value)) sum += std::fabs(value);
  }

 public:
  explicit StateHash(LAMMPS *lmp) : Command(lmp) {}

  void command(int, char **) override
  {
    std::vector<double> row(atom->avec->size_restart() + 1);    // for all atoms: enough for one
    for (int i = 0; i < atom->nlocal; i++) {
      const uint64_t salt = splitmix64(atom->tag[i]);
      auto size = [&](int k) {    // of the part of a fix
        return modify->fix[atom->extra_restart[k]]->size_restart(i);
      };
      int end = atom->avec->pack_restart(i, row.data());    // of what is not from fixes
      for (int k = 0; k < atom->nextra_restart; k++) end -= size(k);
      for (int m = 1; m < end; m++)    // 1-3: x, 4-7: tag, type, mask, image, 8-10: v
        add(row[m], salt, sums[m < 4 ? 0 : (m > 7 && m < 11 ? 1 : 2)]);
      for (int k = 0, start = end; k < atom->nextra_restart; k++, start = end) {
        end += size(k);
        row[start] = 0.0;    // the length
        const bool known = std::none_of(&row[start], &row[end], [](double r) {
          return r != r;
        });
        for (int m = start; m < end && known; m++) add(row[m], salt, sums[2]);
        if (!known) add(NAN, salt, sums[2]);
      }
    }

    uint64_t all = 0;
    double all_sums[3];
    MPI_Allreduce(&hash, &all, 1, MPI_UINT64_T, MPI_SUM, world);
    MPI_Allreduce(sums, all_sums, 3, MPI_DOUBLE, MPI_SUM, world);
    if (comm->me == 0)
      utils::logmesg(lmp, "state_hash: {} {:016x} {:.17g} {:.17g} {:.17g}\n", atom->natoms, all,
                     all_sums[0], all_sums[1], all_sums[2]);
  }
};

Command *create(LAMMPS *lmp)
{
  return new StateHash(lmp);
}

}    // namespace

extern "C" void lammpsplugin_init(void *lmp, void *handle, void *regfunc)
{
  lammpsplugin_t plugin;
  plugin.version = LAMMPS_VERSION;
  plugin.style = "command";
  plugin.name = "state_hash";
  plugin.info = "hash of the state of all atoms";
  plugin.author = "MPM package";
  plugin.creator.v1 = (lammpsplugin_factory1 *) &create;
  plugin.handle = handle;
  (*(lammpsplugin_regfunc) regfunc)(&plugin, lmp);
}
