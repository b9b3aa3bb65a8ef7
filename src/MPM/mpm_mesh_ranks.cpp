/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_mesh_ranks.h"

#include "comm.h"

#include <algorithm>

using namespace LAMMPS_NS;

/* ----------------------------------------------------------------------
   all ranks tell each other what they have, one bit for each node
------------------------------------------------------------------------- */

void MPMMeshRanks::find(const std::vector<char> &mine)
{
  const std::size_t n = mine.size(), nbyte = (n + 7) / 8;
  std::vector<unsigned char> bits(nbyte, 0), all(nbyte * comm->nprocs);
  for (std::size_t i = 0; i < n; i++)
    if (mine[i]) bits[i / 8] |= 1u << (i % 8);
  MPI_Allgather(bits.data(), (int) nbyte, MPI_BYTE, all.data(), (int) nbyte, MPI_BYTE, world);
  const auto has = [&](int rank, std::size_t i) {
    return (all[rank * nbyte + i / 8] >> (i % 8)) & 1u;
  };

  nodes.clear();
  shared.clear();
  neighbors.clear();
  first.assign(n, 0);
  for (std::size_t i = 0; i < n; i++) {
    if (!mine[i]) continue;
    nodes.push_back((int) i);
    first[i] = 1;
  }
  std::vector<char> is_shared(n, 0);
  for (int rank = 0; rank < comm->nprocs; rank++) {
    if (rank == comm->me) continue;
    Neighbor other = {rank, {}, {}, {}};
    for (const int i : nodes) {
      if (!has(rank, i)) continue;
      other.nodes.push_back(i);
      is_shared[i] = 1;
      if (rank < comm->me) first[i] = 0;
    }
    if (!other.nodes.empty()) neighbors.push_back(std::move(other));
  }
  for (const int i : nodes)
    if (is_shared[i]) shared.push_back(i);
}

/* ---------------------------------------------------------------------- */

void MPMMeshRanks::sum(double *values, int width)
{
  if (neighbors.empty()) return;
  constexpr int TAG = 7;
  std::vector<MPI_Request> requests(neighbors.size());
  for (std::size_t k = 0; k < neighbors.size(); k++) {
    auto &n = neighbors[k];
    n.in.resize(width * n.nodes.size());
    MPI_Irecv(n.in.data(), (int) n.in.size(), MPI_DOUBLE, n.rank, TAG, world, &requests[k]);
  }
  for (auto &n : neighbors) {
    n.out.resize(width * n.nodes.size());
    for (std::size_t i = 0; i < n.nodes.size(); i++)
      std::copy_n(values + (std::size_t) width * n.nodes[i], width, &n.out[width * i]);
    MPI_Send(n.out.data(), (int) n.out.size(), MPI_DOUBLE, n.rank, TAG, world);
  }
  own.resize(width * shared.size());
  for (std::size_t i = 0; i < shared.size(); i++) {
    double *const row = values + (std::size_t) width * shared[i];
    std::copy_n(row, width, &own[width * i]);
    std::fill_n(row, width, 0.0);
  }
  MPI_Waitall((int) requests.size(), requests.data(), MPI_STATUSES_IGNORE);

  // in the order of ranks

  const auto add = [&](const std::vector<int> &list, const double *from) {
    for (const int i : list)
      for (int c = 0; c < width; c++) values[(std::size_t) width * i + c] += *from++;
  };
  bool added = false;
  for (const auto &n : neighbors) {
    if (!added && n.rank > comm->me) {
      add(shared, own.data());
      added = true;
    }
    add(n.nodes, n.in.data());
  }
  if (!added) add(shared, own.data());
}

double MPMMeshRanks::memory_usage() const
{
  double bytes = (double) nodes.capacity() * sizeof(int) + (double) own.capacity() * sizeof(double);
  for (const auto &n : neighbors)
    bytes += (double) n.nodes.capacity() * sizeof(int) +
        (double) (n.in.capacity() + n.out.capacity()) * sizeof(double);
  return bytes;
}
