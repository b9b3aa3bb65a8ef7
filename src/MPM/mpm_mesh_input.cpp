/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_mesh_input.h"

#include "comm.h"
#include "domain.h"
#include "error.h"

#include <algorithm>
#include <stdexcept>

using namespace LAMMPS_NS;
using namespace MPM_NS;

namespace {

/** Send plain data of rank 0 to all. */
template <class T> void broadcast(std::vector<T> &data, MPI_Comm world)
{
  bigint n = data.size();
  MPI_Bcast(&n, 1, MPI_LMP_BIGINT, 0, world);
  data.resize(n);
  constexpr bigint PIECE = (1 << 30) / sizeof(T);
  for (bigint k = 0; k < n; k += PIECE)
    MPI_Bcast(data.data() + k, (int) (std::min(PIECE, n - k) * sizeof(T)), MPI_BYTE, 0, world);
}

}    // namespace

Mesh LAMMPS_NS::read_body(LAMMPS *lmp, const std::string &file, const std::string &part,
                          const std::string &user, int iarg)
{
  Mesh mesh;
  std::vector<char> message;
  if (lmp->comm->me == 0) {
    try {
      mesh = read_gmsh(file);
      mesh.keep(lmp->domain->dimension, part);
      mesh.orient();
    } catch (const std::runtime_error &e) {
      const std::string what = e.what();
      message.assign(what.begin(), what.end());
    }
  }
  broadcast(message, lmp->world);
  if (!message.empty())
    lmp->error->all(FLERR, iarg, "{}: {}", user, std::string(message.begin(), message.end()));
  broadcast(mesh.nodes, lmp->world);
  broadcast(mesh.elements, lmp->world);
  return mesh;
}
