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
template <class Data> void broadcast(Data &data, MPI_Comm world)
{
  bigint n = data.size();
  MPI_Bcast(&n, 1, MPI_LMP_BIGINT, 0, world);
  data.resize(n);
  constexpr bigint SIZE = sizeof(typename Data::value_type), PIECE = (1 << 30) / SIZE;
  for (bigint k = 0; k < n; k += PIECE)
    MPI_Bcast(data.data() + k, (int) (std::min(PIECE, n - k) * SIZE), MPI_BYTE, 0, world);
}

}    // namespace

Mesh LAMMPS_NS::read_body(LAMMPS *lmp, const std::string &file, const std::string &part,
                          const std::string &user, int iarg)
{
  Mesh mesh;
  std::string message;
  if (lmp->comm->me == 0) {
    try {
      mesh = read_gmsh(file);
      mesh.keep(lmp->domain->dimension, part);
      mesh.orient();
    } catch (const std::runtime_error &e) {
      message = e.what();
    }
  }
  broadcast(message, lmp->world);
  if (!message.empty()) lmp->error->all(FLERR, iarg, "{}: {}", user, message);
  broadcast(mesh.nodes, lmp->world);
  broadcast(mesh.elements, lmp->world);
  return mesh;
}
