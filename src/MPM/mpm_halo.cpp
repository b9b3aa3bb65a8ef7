/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_halo.h"

#include "comm.h"
#include "lattice/grid.h"
#include "memory.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int RVOUS = 1;    // 0 for irregular, 1 for all2all
static constexpr int HALO_TAG = 4711;

namespace {
/** To the rendezvous: this rank has this block active. Back: this other rank has the block, too. */
struct Sharer {
  uint64_t key;
  int rank;
  int added;    // by a node action, out of reach of the rank's points
};

/** Blocks that points of this rank reach, or of which they reach an image. */
std::vector<char> reached(const Grid &grid, int nreached)
{
  std::vector<char> yes(grid.blocks.size(), 0);
  for (int s = 0; s < nreached; s++) {
    yes[s] = 1;
    const auto &block = grid.blocks[s];
    for (int n = 0; n < NODES_PER_BLOCK && block.alias; n++) {
      if (!(block.alias >> n & 1)) continue;
      int index[3];
      grid.node_index(block, n, index);
      for (int d = 0; d < grid.lattice.dim; d++) index[d] = grid.lattice.wrap(d, index[d]);
      yes[grid.locate(index) / NODES_PER_BLOCK] = 1;
    }
  }
  return yes;
}
}    // namespace

/** At the rendezvous rank of a set of keys: tell each sharer of a block about all others. */
static int match_keys(int n, char *inbuf, int &flag, int *&proclist, char *&outbuf, void *ptr)
{
  auto *memory = (Memory *) ptr;
  auto *in = (Sharer *) inbuf;
  std::sort(in, in + n, [](const Sharer &a, const Sharer &b) {
    return a.key < b.key || (a.key == b.key && a.rank < b.rank);
  });

  int nout = 0;
  for (int i = 0, j; i < n; i = j) {
    for (j = i; j < n && in[j].key == in[i].key;) j++;
    nout += (j - i) * (j - i - 1);
  }
  memory->create(proclist, nout, "mpm/halo:proclist");
  auto *out = (Sharer *) memory->smalloc((bigint) nout * sizeof(Sharer), "mpm/halo:out");
  nout = 0;
  for (int i = 0, j; i < n; i = j) {
    for (j = i; j < n && in[j].key == in[i].key;) j++;
    for (int to = i; to < j; to++)
      for (int other = i; other < j; other++) {
        if (to == other) continue;
        proclist[nout] = in[to].rank;
        out[nout++] = in[other];
      }
  }
  outbuf = (char *) out;
  flag = 2;    // output lists are new
  return nout;
}

/* ---------------------------------------------------------------------- */

void MPMHalo::setup(Grid &grid)
{
  ranks.clear();
  slots.clear();
  shared.clear();
  first.assign(1, 0);
  contributions.clear();
  if (comm->nprocs == 1) return;

  // all canonical blocks go to the rank that their key hashes to

  const int nblocks = grid.blocks.size();
  const std::vector<char> mine_reached = reached(grid, nreached);
  std::vector<Sharer> mine;
  std::vector<int> procs;
  for (int s = 0; s < nblocks; s++) {
    const auto &block = grid.blocks[s];
    if (block.alias == ~uint64_t(0)) continue;
    const uint64_t key = Grid::block_key(block);
    mine.push_back({key, comm->me, !mine_reached[s]});
    procs.push_back((int) ((key * UINT64_C(0x9E3779B97F4A7C15) >> 33) % comm->nprocs));
  }
  char *outbuf = nullptr;
  const int n = comm->rendezvous(RVOUS, mine.size(), (char *) mine.data(), sizeof(Sharer), 0,
                                 procs.data(), match_keys, 0, outbuf, sizeof(Sharer), memory, 0);
  auto *sharer = (Sharer *) outbuf;

  // blocks in order of (rank, key): both sides of a pair list them alike

  std::sort(sharer, sharer + n, [](const Sharer &a, const Sharer &b) {
    return a.rank < b.rank || (a.rank == b.rank && a.key < b.key);
  });
  std::vector<std::vector<Contribution>> of_slot(nblocks);
  std::vector<char> mine_to_count(nblocks, 1);
  for (int i = 0; i < n; i++) {
    if (ranks.empty() || ranks.back() != sharer[i].rank) {
      ranks.push_back(sharer[i].rank);
      slots.emplace_back();
    }
    const int slot = grid.find(sharer[i].key);
    // the lowest rank counts its nodes, of those whose points reach the block if there are any
    const int added = !mine_reached[slot];
    if (sharer[i].added < added || (sharer[i].added == added && sharer[i].rank < comm->me))
      mine_to_count[slot] = 0;
    of_slot[slot].push_back({(int) ranks.size() - 1, (int) slots.back().size()});
    slots.back().push_back(slot);
  }
  memory->sfree(outbuf);

  for (int s = 0; s < nblocks; s++) {
    if (of_slot[s].empty()) continue;
    shared.push_back(s);
    auto &list = of_slot[s];    // ascending by rank
    const auto next = std::find_if(list.begin(), list.end(), [&](const Contribution &c) {
      return ranks[c.from] > comm->me;
    });
    if (!mine_to_count[s]) grid.blocks[s].owned = 0;
    list.insert(next, {-1, 0});
    contributions.insert(contributions.end(), list.begin(), list.end());
    first.push_back(contributions.size());
  }
  send.resize(ranks.size());
  recv.resize(ranks.size());
  requests.resize(2 * ranks.size());
}

/* ---------------------------------------------------------------------- */

void MPMHalo::sum(double *nodes, int nreal, int lane, int nlane)
{
  if (ranks.empty()) return;

  const int block_reals = NODES_PER_BLOCK * nlane;
  const bool whole = nlane == nreal;
  const int nranks = ranks.size();
  for (int r = 0; r < nranks; r++) {
    const int count = slots[r].size() * block_reals;
    recv[r].resize(count);
    send[r].resize(count);
    MPI_Irecv(recv[r].data(), count, MPI_DOUBLE, ranks[r], HALO_TAG, world, &requests[r]);
  }
  for (int r = 0; r < nranks; r++) {
    double *buf = send[r].data();
    for (int slot : slots[r]) {
      const double *record = nodes + (int64_t) slot * NODES_PER_BLOCK * nreal + lane;
      if (whole)
        memcpy(buf, record, block_reals * sizeof(double));
      else
        for (int k = 0; k < NODES_PER_BLOCK; k++, record += nreal)
          for (int l = 0; l < nlane; l++) buf[k * nlane + l] = record[l];
      buf += block_reals;
    }
    MPI_Isend(send[r].data(), (int) send[r].size(), MPI_DOUBLE, ranks[r], HALO_TAG, world,
              &requests[nranks + r]);
    bytes_sent += (bigint) send[r].size() * sizeof(double);
  }
  MPI_Waitall(nranks, requests.data(), MPI_STATUSES_IGNORE);

  for (std::size_t is = 0; is < shared.size(); is++) {
    double *record = nodes + (int64_t) shared[is] * NODES_PER_BLOCK * nreal + lane;
    const Contribution *begin = &contributions[first[is]];
    const Contribution *end = begin + (first[is + 1] - first[is]);
    if (whole && end - begin == 2) {    // most blocks; the order of two does not matter
      const Contribution &other = begin[begin->from < 0];
      const double *const theirs = recv[other.from].data() + (int64_t) other.offset * block_reals;
      for (int k = 0; k < block_reals; k++) record[k] += theirs[k];
      continue;
    }
    for (int k = 0; k < NODES_PER_BLOCK; k++, record += nreal)
      for (int l = 0; l < nlane; l++) {
        double sum = 0.0;
        for (const Contribution *c = begin; c != end; c++)
          sum += c->from < 0 ? record[l]
                             : recv[c->from][(int64_t) c->offset * block_reals + k * nlane + l];
        record[l] = sum;
      }
  }
  MPI_Waitall(nranks, requests.data() + nranks, MPI_STATUSES_IGNORE);
}

/* ---------------------------------------------------------------------- */

double MPMHalo::memory_usage() const
{
  double bytes = (shared.capacity() + first.capacity()) * sizeof(int) +
      contributions.capacity() * sizeof(Contribution);
  for (const auto &list : slots) bytes += list.capacity() * sizeof(int);
  for (const auto *buffers : {&send, &recv})
    for (const auto &buffer : *buffers) bytes += buffer.capacity() * sizeof(double);
  return bytes;
}
