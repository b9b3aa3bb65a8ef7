/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/mpm_mesh_ranks.h"

#include "base/mpm_lists.h"
#include "comm.h"

#include <algorithm>

using namespace LAMMPS_NS;

/** All ranks tell each other what they have, one bit for each node. */
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

/** Values of the ranks that share nodes with this one go to in. */
void MPMMeshRanks::exchange(const double *values, int width, const int *row)
{
  constexpr int TAG = 7;
  std::vector<MPI_Request> requests;
  for (auto &n : neighbors) {
    std::size_t rows = n.nodes.size();
    if (row)
      rows = std::count_if(n.nodes.begin(), n.nodes.end(), [row](int node) {
        return row[node] >= 0;
      });
    n.in.resize(width * rows);
    if (n.in.empty()) continue;    // the other rank knows that, too
    MPI_Irecv(n.in.data(), (int) n.in.size(), MPI_DOUBLE, n.rank, TAG, world,
              &requests.emplace_back());
  }
  for (auto &n : neighbors) {
    n.out.clear();
    for (const int node : n.nodes) {
      const int at = row ? row[node] : node;
      if (at >= 0)
        n.out.insert(n.out.end(), values + (std::size_t) width * at,
                     values + (std::size_t) width * (at + 1));
    }
    if (!n.out.empty()) MPI_Send(n.out.data(), (int) n.out.size(), MPI_DOUBLE, n.rank, TAG, world);
  }
  MPI_Waitall((int) requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}

/** In the order of ranks. */
void MPMMeshRanks::sum(double *values, int width, const int *row)
{
  if (neighbors.empty()) return;
  exchange(values, width, row);
  own.clear();
  for (const int node : shared) {
    const int at = row ? row[node] : node;
    if (at < 0) continue;
    double *const first = values + (std::size_t) width * at;
    own.insert(own.end(), first, first + width);
    std::fill_n(first, width, 0.0);
  }
  const auto add = [&](const std::vector<int> &list, const double *from) {
    for (const int node : list) {
      const int at = row ? row[node] : node;
      for (int c = 0; c < width && at >= 0; c++) values[(std::size_t) width * at + c] += *from++;
    }
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

void MPMMeshRanks::largest(double *values, int width, int parts, const int *row)
{
  if (neighbors.empty()) return;
  exchange(values, width * parts, row);
  for (const auto &n : neighbors) {
    const double *from = n.in.data();
    for (const int node : n.nodes) {
      const int at = row ? row[node] : node;
      for (int p = 0; p < parts && at >= 0; p++, from += width) {
        double *const to = values + (std::size_t) width * (parts * at + p);
        if (std::lexicographical_compare(to, to + width, from, from + width))
          std::copy_n(from, width, to);
      }
    }
  }
}

double MPMMeshRanks::memory_usage() const
{
  double bytes = bytes_of(nodes, own);
  for (const auto &n : neighbors) bytes += bytes_of(n.nodes, n.in, n.out);
  return bytes;
}
