/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_halo.h"

#include "comm.h"
#include "memory.h"

#include <algorithm>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int RVOUS = 1;    // 0 for irregular, 1 for all2all
static constexpr int HALO_TAG = 4711;

namespace {
/** To the rendezvous: this rank has these nodes of this block. Back: this other rank has them,
 *  too. */
struct Sharer {
  uint64_t key;
  uint64_t nodes, reached;    // bits of those that it has, and that its points can reach
  int rank;
};
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

void MPMHalo::setup(Grid &grid, const std::function<bool(const Grid::Block &)> &whole)
{
  std::vector<uint64_t> wanted;
  for (const auto &block : grid.blocks)
    wanted.push_back(whole(block) ? ~uint64_t(0) : block.reached);
  setup(grid, wanted);
}

void MPMHalo::setup(Grid &grid, const std::vector<uint64_t> &wanted,
                    const std::function<int(int)> &prefers)
{
  peers.clear();
  several.clear();
  first.assign(1, 0);
  contributions.clear();
  if (comm->nprocs == 1) return;

  // all canonical blocks go to the rank that their key hashes to
  const int nblocks = grid.blocks.size();
  std::vector<uint64_t> had(nblocks, 0);
  std::vector<Sharer> mine;
  std::vector<int> procs;
  for (int s = 0; s < nblocks; s++) {
    const auto &block = grid.blocks[s];
    had[s] = wanted[s] & ~block.alias;
    if (!had[s]) continue;
    const uint64_t key = Grid::block_key(block);
    mine.push_back({key, had[s], block.reached, comm->me});
    procs.push_back((int) ((key * UINT64_C(0x9E3779B97F4A7C15) >> 33) % comm->nprocs));
  }
  char *outbuf = nullptr;
  const int n = comm->rendezvous(RVOUS, mine.size(), (char *) mine.data(), sizeof(Sharer), 0,
                                 procs.data(), match_keys, 0, outbuf, sizeof(Sharer), memory, 0);
  auto *sharer = (Sharer *) outbuf;

  // nodes in order of (rank, key, number): both sides of a pair list them alike
  std::sort(sharer, sharer + n, [](const Sharer &a, const Sharer &b) {
    return a.rank < b.rank || (a.rank == b.rank && a.key < b.key);
  });
  std::vector<std::vector<int>> of_slot(nblocks);    // the other sharers
  std::vector<int> first_place(n);
  for (int i = 0; i < n; i++) {
    const int slot = grid.find(sharer[i].key);
    of_slot[slot].push_back(i);
    sharer[i].nodes &= had[slot];
    if (!sharer[i].nodes) continue;
    if (peers.empty() || peers.back().rank != sharer[i].rank)
      peers.push_back({sharer[i].rank, {}, {}, {}, {}});
    auto &nodes = peers.back().nodes;
    first_place[i] = nodes.size();
    for (uint64_t left = sharer[i].nodes; left; left &= left - 1)
      nodes.push_back(slot * NODES_PER_BLOCK + __builtin_ctzll(left));
  }

  for (int s = 0; s < nblocks; s++) {
    auto &block = grid.blocks[s];
    if (of_slot[s].empty()) continue;

    // a node is counted by the lowest rank that reaches it, one that nobody reaches by the lowest
    // sharer
    uint64_t by_lower = 0, by_others = 0;
    bool lowest = true;
    for (const int i : of_slot[s]) {
      by_others |= sharer[i].reached;
      if (sharer[i].rank > comm->me) continue;
      by_lower |= sharer[i].reached;
      lowest = false;
    }
    const uint64_t by_nobody = lowest ? ~(by_others | block.reached) : 0;
    uint64_t by_me = (block.reached & ~by_lower) | by_nobody;
    for (uint64_t left = prefers ? block.reached & by_others & ~block.alias : 0; left;
         left &= left - 1) {
      const int node = __builtin_ctzll(left), rank = prefers(s * NODES_PER_BLOCK + node);
      const uint64_t bit = left & -left;
      if (rank == comm->me) by_me |= bit;
      for (const int i : of_slot[s])
        if (sharer[i].rank == rank && sharer[i].reached & bit) by_me &= ~bit;
    }
    block.owned &= by_me;

    // who adds to a node, in the order of ranks
    uint64_t once = 0, more = 0;
    for (const int i : of_slot[s]) {
      more |= once & sharer[i].nodes;
      once |= sharer[i].nodes;
    }
    const auto place_of = [&](int i, int node) {
      const uint64_t before = (uint64_t(1) << node) - 1;
      return first_place[i] + __builtin_popcountll(sharer[i].nodes & before);
    };
    const auto peer_of = [&](int i) {
      return std::lower_bound(peers.begin(), peers.end(), sharer[i].rank,
                              [](const Peer &peer, int rank) {
                                return peer.rank < rank;
                              });
    };
    for (const int i : of_slot[s])
      for (uint64_t left = sharer[i].nodes & ~more; left; left &= left - 1)
        peer_of(i)->places.push_back(place_of(i, __builtin_ctzll(left)));
    for (uint64_t left = more; left; left &= left - 1) {
      const int node = __builtin_ctzll(left);
      bool mine_is_in = false;
      const auto add_mine = [&]() {
        if (!mine_is_in) contributions.push_back({-1, 0});
        mine_is_in = true;
      };
      for (const int i : of_slot[s]) {    // ascending by rank
        if (!(sharer[i].nodes >> node & 1)) continue;
        if (sharer[i].rank > comm->me) add_mine();
        contributions.push_back({(int) (peer_of(i) - peers.begin()), place_of(i, node)});
      }
      add_mine();
      several.push_back(s * NODES_PER_BLOCK + node);
      first.push_back(contributions.size());
    }
  }
  memory->sfree(outbuf);
  requests.resize(2 * peers.size());
}

/** Calls f(width), width() being nlane, which the compiler knows for the records of the step. */
template <class F> static void with_width(int nlane, const F &f)
{
  if (nlane == 4)
    f(std::integral_constant<int, 4>());
  else if (nlane == 8)
    f(std::integral_constant<int, 8>());
  else
    f([nlane]() {
      return nlane;
    });
}

void MPMHalo::sum(double *nodes, int nreal, int lane, int nlane)
{
  const int npeers = peers.size();
  for (int p = 0; p < npeers; p++) {
    auto &peer = peers[p];
    peer.recv.resize(peer.nodes.size() * nlane);
    MPI_Irecv(peer.recv.data(), (int) peer.recv.size(), MPI_DOUBLE, peer.rank, HALO_TAG, world,
              &requests[p]);
  }
  for (int p = 0; p < npeers; p++) {
    auto &peer = peers[p];
    peer.send.resize(peer.recv.size());
    with_width(nlane, [&](auto width) {
      double *buf = peer.send.data();
      for (const int node : peer.nodes) {
        const double *record = nodes + (int64_t) node * nreal + lane;
        for (int l = 0; l < width(); l++) *buf++ = record[l];
      }
    });
    MPI_Isend(peer.send.data(), (int) peer.send.size(), MPI_DOUBLE, peer.rank, HALO_TAG, world,
              &requests[npeers + p]);
    bytes_sent += (bigint) peer.send.size() * sizeof(double);
    messages_sent++;
  }
  MPI_Waitall(npeers, requests.data(), MPI_STATUSES_IGNORE);

  with_width(nlane, [&](auto width) {
    for (const auto &peer : peers)    // the order of two does not matter
      for (const int place : peer.places) {
        double *record = nodes + (int64_t) peer.nodes[place] * nreal + lane;
        const double *const theirs = peer.recv.data() + (int64_t) place * width();
        for (int l = 0; l < width(); l++) record[l] += theirs[l];
      }
  });
  for (std::size_t k = 0; k < several.size(); k++) {
    double *record = nodes + (int64_t) several[k] * nreal + lane;
    for (int l = 0; l < nlane; l++) {
      double sum = 0.0;
      for (int c = first[k]; c < first[k + 1]; c++) {
        const auto [from, place] = contributions[c];
        sum += from < 0 ? record[l] : peers[from].recv[(int64_t) place * nlane + l];
      }
      record[l] = sum;
    }
  }
  MPI_Waitall(npeers, requests.data() + npeers, MPI_STATUSES_IGNORE);
}

double MPMHalo::memory_usage() const
{
  double bytes = (several.capacity() + first.capacity()) * sizeof(int) +
      contributions.capacity() * sizeof(Contribution);
  for (const auto &peer : peers)
    bytes += (peer.nodes.capacity() + peer.places.capacity()) * sizeof(int) +
        (peer.send.capacity() + peer.recv.capacity()) * sizeof(double);
  return bytes;
}
