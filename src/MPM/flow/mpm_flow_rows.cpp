/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_rows.h"

#include "lammps.h"

#include <algorithm>

using namespace LAMMPS_NS;

static constexpr int ROWS_TAG = 4712;    // and the next one, for both halves
// flags that ranks send each other for a cell
static constexpr char MINE = 1, WANTED = 2;

void MPMFlowRows::begin()
{
  nsides = 2 * cells.lattice.dim;
  number.clear();
  next_to.clear();
}

void MPMFlowRows::add(int cell, const int *near)
{
  number.push_back(cell);
  next_to.insert(next_to.end(), near, near + nsides);
}

MPMFlowRows::Half MPMFlowRows::half_of(int64_t cell) const
{
  int index[3];
  cells.grid.node_index(cell, index);
  const auto &lattice = cells.lattice;
  for (int d = 0; d < lattice.dim; d++)
    if (lattice.periodic[d] && lattice.ncell[d] % 2 && index[d] == lattice.ncell[d] - 1)
      return EVEN;
  return (index[0] + index[1] + index[2]) & 1 ? ODD : EVEN;
}

void MPMFlowRows::arrange()
{
  const int n = number.size();
  place_of.assign(cells.size(), -1);
  for (int i = 0; i < n; i++) place_of[number[i]] = i;    // there are such cells
  std::vector<int> lists[2][2];                           // of halves: inner ones, and others
  for (int i = 0; i < n; i++) {
    const int *const mine = next_to.data() + (std::size_t) i * nsides;
    const bool has_others = std::any_of(mine, mine + nsides, [this](int other) {
      return other >= 0 && place_of[other] < 0;
    });
    lists[half_of(number[i])][has_others].push_back(i);
  }
  row.clear();
  for (int half = 0; half < 2; half++) {
    inner[half] = lists[half][0].size();
    for (const auto &list : lists[half]) row.insert(row.end(), list.begin(), list.end());
    if (half == EVEN) neven = row.size();
  }
  for (int place = 0; place < n; place++) place_of[cell_at(place)] = place;
  find_peers();
  const int zero = values.size() - 1;
  places.resize((std::size_t) n * nsides);
  for (int place = 0; place < n; place++)
    for (int s = 0; s < nsides; s++) {
      const int other = next_to[(std::size_t) row[place] * nsides + s];
      places[(std::size_t) place * nsides + s] = other < 0 ? zero : place_of[other];
    }
}

/** Two ranks list the cells that they share in the same order. After one message, both know which
 *  of these cells the other one needs. */
void MPMFlowRows::find_peers()
{
  const auto &halo = cells.halo_of_cells();
  const int n = size(), npeers = halo.sharers();
  peers.resize(npeers);
  requests.resize(4 * (std::size_t) npeers);
  nrequests = 0;
  wanted.assign(npeers ? cells.size() : 0, 0);
  std::size_t all = 0;
  for (int p = 0; p < npeers; p++) all += halo.shared_with(p).size();
  for (std::size_t k = 0; npeers && k < next_to.size(); k++)
    if (next_to[k] >= 0 && place_of[next_to[k]] < 0) wanted[next_to[k]] = WANTED;
  flags_out.clear();
  flags_in.resize(all);
  for (int p = 0; p < npeers; p++)
    for (const int cell : halo.shared_with(p))
      flags_out.push_back(place_of[cell] >= 0 ? MINE : wanted[cell]);
  std::size_t at = 0;
  for (int p = 0; p < npeers; p++) {
    const int many = halo.shared_with(p).size();
    peers[p].rank = halo.rank_of(p);
    MPI_Irecv(flags_in.data() + at, many, MPI_CHAR, peers[p].rank, ROWS_TAG, lmp->world,
              &requests[nrequests++]);
    MPI_Isend(flags_out.data() + at, many, MPI_CHAR, peers[p].rank, ROWS_TAG, lmp->world,
              &requests[nrequests++]);
    at += many;
  }
  wait();

  std::vector<int> got[2];
  at = 0;
  for (int p = 0; p < npeers; p++) {
    auto &peer = peers[p];
    for (auto &list : peer.give) list.clear();
    for (int half = 0; half < 2; half++) peer.first[half] = got[half].size();
    for (const int cell : halo.shared_with(p)) {
      const char mine = flags_out[at], theirs = flags_in[at];
      at++;
      if (mine == MINE && theirs == WANTED)
        peer.give[half_of(cell)].push_back(place_of[cell]);
      else if (mine == WANTED && theirs == MINE)
        got[half_of(cell)].push_back(cell);
    }
    for (int half = 0; half < 2; half++)
      peer.many[half] = (int) got[half].size() - peer.first[half];
  }
  int place = n;
  for (int half = 0; half < 2; half++) {
    for (auto &peer : peers) peer.first[half] += place;
    for (const int cell : got[half]) place_of[cell] = place++;
  }
  values.assign(place + 1, 0.0);
}

/* ---------------------------------------------------------------------- */

void MPMFlowRows::fetch(Half half)
{
  for (auto &peer : peers)
    if (peer.many[half])
      MPI_Irecv(values.data() + peer.first[half], peer.many[half], MPI_DOUBLE, peer.rank,
                ROWS_TAG + half, lmp->world, &requests[nrequests++]);
  for (auto &peer : peers) {
    if (peer.give[half].empty()) continue;
    auto &send = peer.send[half];
    send.clear();
    for (const int place : peer.give[half]) send.push_back(values[place]);
    MPI_Isend(send.data(), (int) send.size(), MPI_DOUBLE, peer.rank, ROWS_TAG + half, lmp->world,
              &requests[nrequests++]);
  }
}

void MPMFlowRows::wait()
{
  if (nrequests) MPI_Waitall(nrequests, requests.data(), MPI_STATUSES_IGNORE);
  nrequests = 0;
}

template <int sides>
static void sum_of(int first, int last, const int *at, const double *factor, const double *from,
                   double *sum)
{
  at += (std::size_t) first * sides;
  factor += (std::size_t) first * sides;
  for (int i = first; i < last; i++, at += sides, factor += sides) {
    double all = 0.0;
    for (int s = 0; s < sides; s++) all += factor[s] * from[at[s]];
    *sum++ = all;
  }
}

void MPMFlowRows::sum_some(int first, int last, const std::vector<double> &factor,
                           double *sum) const
{
  if (nsides == 4)
    sum_of<4>(first, last, places.data(), factor.data(), values.data(), sum);
  else
    sum_of<6>(first, last, places.data(), factor.data(), values.data(), sum);
}

void MPMFlowRows::sum(Half half, const std::vector<double> &factor, double *sum)
{
  const int first = first_of(half), last = first + size_of(half), middle = first + inner[half];
  fetch(half == EVEN ? ODD : EVEN);
  sum_some(first, middle, factor, sum);
  wait();
  sum_some(middle, last, factor, sum + inner[half]);
}

void MPMFlowRows::sum_all(const std::vector<double> &factor, double *sum)
{
  fetch(EVEN);
  fetch(ODD);
  sum_some(0, inner[EVEN], factor, sum);
  sum_some(neven, neven + inner[ODD], factor, sum + neven);
  wait();
  sum_some(inner[EVEN], neven, factor, sum + inner[EVEN]);
  sum_some(neven + inner[ODD], size(), factor, sum + neven + inner[ODD]);
}

double MPMFlowRows::memory_usage() const
{
  double bytes =
      MPM_NS::bytes_of(place_of, number, next_to, row, places, values, flags_out, flags_in, wanted);
  for (const auto &peer : peers)
    bytes += MPM_NS::bytes_of(peer.give[0], peer.give[1], peer.send[0], peer.send[1]);
  return bytes;
}
