/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_flow_spread.h"

#include "lammps.h"
#include "mpm_node_system.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int SPREAD_TAG = 4712;
// what ranks tell each other of a cell
static constexpr char MINE = 1, WANTED = 2;

void MPMFlowSpread::begin(const double *of)
{
  inverse_root = of;
  sides = 2 * cells.lattice.dim;
  number.clear();
  near.clear();
  weight.clear();
  load.clear();
}

void MPMFlowSpread::add(const Row &row)
{
  const double mine = inverse_root[row.number];
  number.push_back(row.number);
  load.push_back(mine * row.right_side);
  for (int s = 0; s < sides; s++) {
    near.push_back(row.near[s]);
    weight.push_back(row.near[s] < 0 ? 0.0 : mine * row.weight[s] * inverse_root[row.near[s]]);
  }
}

/** Of two neighbors one is KEPT, at least: where a period has an odd number of cells, its last one is. */
int MPMFlowSpread::half_of(const int index[3]) const
{
  const auto &lattice = cells.lattice;
  for (int d = 0; d < lattice.dim; d++)
    if (lattice.periodic[d] && lattice.ncell[d] % 2 && index[d] == lattice.ncell[d] - 1)
      return KEPT;
  return (index[0] + index[1] + index[2]) & 1 ? KNOWN : KEPT;
}

/* ----------------------------------------------------------------------
   values: KEPT and KNOWN cells of this rank, those of other ranks that are next to them, and a zero
------------------------------------------------------------------------- */

void MPMFlowSpread::arrange()
{
  const int n = number.size();
  place_of.assign(cells.size(), -1);
  for (int i = 0; i < n; i++) place_of[number[i]] = i;    // there are such rows
  std::vector<int> outer[2];
  for (auto &half : halves) half.row.clear();
  for (int i = 0; i < n; i++) {
    int index[3];
    cells.grid.node_index((int64_t) number[i], index);
    const int which = half_of(index);
    const int *const mine = near.data() + (std::size_t) i * sides;
    const bool inner = std::all_of(mine, mine + sides, [this](int other) {
      return other < 0 || place_of[other] >= 0;
    });
    (inner ? halves[which].row : outer[which]).push_back(i);
  }
  int place = 0;
  for (int which = 0; which < 2; which++) {
    auto &half = halves[which];
    half.first = place;
    half.inner = half.row.size();
    half.row.insert(half.row.end(), outer[which].begin(), outer[which].end());
    for (const int i : half.row) place_of[number[i]] = place++;
  }
  find_peers();
  const int zero = values.size() - 1;
  places.resize((std::size_t) n * sides);
  factors.resize((std::size_t) n * sides);
  std::size_t to = 0;
  for (const auto &half : halves)
    for (const int i : half.row)
      for (int s = 0; s < sides; s++, to++) {
        const int other = near[(std::size_t) i * sides + s];
        places[to] = other < 0 ? zero : place_of[other];
        factors[to] = weight[(std::size_t) i * sides + s];
      }
}

/** Both of two ranks list the cells that they share in the same order, and know after one message which of them the other needs. */
void MPMFlowSpread::find_peers()
{
  const auto &halo = cells.halo_of_cells();
  const int n = number.size(), npeers = halo.sharers();
  std::vector<char> wanted(npeers ? cells.size() : 0, 0);
  if (npeers)
    for (const int other : near)
      if (other >= 0 && place_of[other] < 0) wanted[other] = 1;
  peers.resize(npeers);
  requests.resize(2 * (std::size_t) npeers);
  std::size_t all = 0;
  for (int p = 0; p < npeers; p++) all += halo.shared_with(p).size();
  flags_out.clear();
  flags_in.resize(all);
  for (int p = 0; p < npeers; p++)
    for (const int cell : halo.shared_with(p))
      flags_out.push_back(place_of[cell] >= 0 ? MINE : wanted[cell] ? WANTED : 0);
  std::size_t at = 0;
  for (int p = 0; p < npeers; p++) {
    const int many = halo.shared_with(p).size();
    peers[p].rank = halo.rank_of(p);
    MPI_Irecv(flags_in.data() + at, many, MPI_CHAR, peers[p].rank, SPREAD_TAG, lmp->world,
              &requests[p]);
    MPI_Isend(flags_out.data() + at, many, MPI_CHAR, peers[p].rank, SPREAD_TAG, lmp->world,
              &requests[npeers + p]);
    at += many;
  }
  if (npeers) MPI_Waitall(2 * npeers, requests.data(), MPI_STATUSES_IGNORE);

  std::vector<int> got[2];
  at = 0;
  for (auto &peer : peers) {
    const auto &shared = halo.shared_with(&peer - peers.data());
    for (auto &list : peer.give) list.clear();
    for (int which = 0; which < 2; which++) peer.first[which] = got[which].size();
    for (const int cell : shared) {
      const char mine = flags_out[at], theirs = flags_in[at];
      at++;
      if (!(mine == MINE && theirs == WANTED) && !(mine == WANTED && theirs == MINE)) continue;
      int index[3];
      cells.grid.node_index((int64_t) cell, index);
      const int which = half_of(index);
      if (mine == MINE)
        peer.give[which].push_back(place_of[cell]);
      else
        got[which].push_back(cell);
    }
    for (int which = 0; which < 2; which++)
      peer.many[which] = (int) got[which].size() - peer.first[which];
  }
  int place = n;
  for (int which = 0; which < 2; which++) {
    for (auto &peer : peers) peer.first[which] += place;
    for (const int cell : got[which]) place_of[cell] = place++;
  }
  values.assign(place + 1, 0.0);
}

/* ---------------------------------------------------------------------- */

template <int width> void MPMFlowSpread::sum_some(int first, int last, double *sum) const
{
  const int *at = places.data() + (std::size_t) first * width;
  const double *factor = factors.data() + (std::size_t) first * width;
  const double *const from = values.data();
  for (int i = first; i < last; i++, at += width, factor += width) {
    double all = 0.0;
    for (int s = 0; s < width; s++) all += factor[s] * from[at[s]];
    *sum++ = all;
  }
}

/** sum: for the cells of a half, what values of their neighbors add; those of the other half come from other ranks meanwhile. */
void MPMFlowSpread::sum_neighbors(int which, double *sum)
{
  const int other = 1 - which;
  const auto &half = halves[which];
  int n = 0;
  for (auto &peer : peers)
    if (peer.many[other])
      MPI_Irecv(values.data() + peer.first[other], peer.many[other], MPI_DOUBLE, peer.rank,
                SPREAD_TAG, lmp->world, &requests[n++]);
  for (auto &peer : peers) {
    if (peer.give[other].empty()) continue;
    peer.send.clear();
    for (const int place : peer.give[other]) peer.send.push_back(values[place]);
    MPI_Isend(peer.send.data(), (int) peer.send.size(), MPI_DOUBLE, peer.rank, SPREAD_TAG,
              lmp->world, &requests[n++]);
  }
  const auto rows = [&](int first, int last) {
    double *const to = sum + first;
    if (sides == 4)
      sum_some<4>(half.first + first, half.first + last, to);
    else
      sum_some<6>(half.first + first, half.first + last, to);
  };
  rows(0, half.inner);
  if (n) MPI_Waitall(n, requests.data(), MPI_STATUSES_IGNORE);
  rows(half.inner, half.size());
}

/* ----------------------------------------------------------------------
   with a diagonal of one: u_known = f_known + C u_kept, and (1 - C C) u_kept = f_kept + C f_known
------------------------------------------------------------------------- */

SolveReport MPMFlowSpread::solve(double *x, const SolveGoal &goal)
{
  arrange();
  SolveReport report;
  const int n = halves[KEPT].size(), nknown = halves[KNOWN].size();
  double *const r = values.data(), *const known = values.data() + n;
  right_side.resize(n + (std::size_t) nknown);
  std::size_t to = 0;
  double mine[3] = {0.0, 0.0, 0.0}, all[3];
  for (const auto &half : halves)
    for (const int i : half.row) {
      right_side[to++] = load[i];
      mine[2] += load[i] * load[i];
    }
  for (auto *vector : {&solution, &direction, &changes}) vector->assign(n, 0.0);
  product.resize(std::max(n, nknown));

  std::copy_n(right_side.data() + n, nknown, known);
  sum_neighbors(KEPT, product.data());
  for (int i = 0; i < n; i++) r[i] = right_side[i] + product[i];
  for (int i = 0; i < n; i++) mine[0] += r[i] * r[i];

  double rr_before = 0.0, alpha = 0.0, enough = 0.0;
  while (true) {
    sum_neighbors(KNOWN, known);
    sum_neighbors(KEPT, product.data());
    mine[1] = 0.0;
    for (int i = 0; i < n; i++) {
      product[i] = r[i] - product[i];
      mine[1] += r[i] * product[i];
    }
    sum_in_order(lmp, report.iterations ? 2 : 3, mine, sums, all);
    if (report.iterations == 0) {
      report.right_side = std::sqrt(all[2]);
      enough = goal.enough(report.right_side);
    }
    const double rr = all[0], beta = report.iterations ? rr / rr_before : 0.0;
    report.residuals.push_back(std::sqrt(rr));
    if (!std::isfinite(rr) || !std::isfinite(all[1]))
      report.outcome = SolveReport::NOT_FINITE;
    else if (std::sqrt(rr) <= enough)
      break;
    else if (report.iterations == goal.most_iterations)
      report.outcome = SolveReport::TOO_MANY;
    if (!report.converged()) return report;

    const double curvature = report.iterations ? all[1] - beta * rr / alpha : all[1];
    if (!(curvature > 0.0)) {
      report.outcome = std::isfinite(curvature) ? SolveReport::INDEFINITE : SolveReport::NOT_FINITE;
      return report;
    }
    alpha = rr / curvature;
    rr_before = rr;
    mine[0] = 0.0;
    for (int i = 0; i < n; i++) {
      direction[i] = r[i] + beta * direction[i];
      changes[i] = product[i] + beta * changes[i];
      solution[i] += alpha * direction[i];
      r[i] -= alpha * changes[i];
      mine[0] += r[i] * r[i];
    }
    report.iterations++;
  }

  std::copy_n(solution.data(), n, r);
  sum_neighbors(KNOWN, known);
  for (int i = 0; i < nknown; i++) known[i] += right_side[n + i];
  to = 0;
  for (const auto &half : halves)
    for (const int i : half.row) x[number[i]] = inverse_root[number[i]] * values[to++];
  return report;
}

double MPMFlowSpread::memory_usage() const
{
  double ints = number.capacity() + near.capacity() + place_of.capacity() + places.capacity();
  double reals = weight.capacity() + load.capacity() + factors.capacity();
  for (const auto &half : halves) ints += half.row.capacity();
  for (const auto *list : {&values, &right_side, &solution, &direction, &changes, &product, &sums})
    reals += list->capacity();
  for (const auto &peer : peers) {
    ints += peer.give[0].capacity() + peer.give[1].capacity();
    reals += peer.send.capacity();
  }
  return ints * sizeof(int) + reals * sizeof(double) + flags_out.capacity() + flags_in.capacity();
}
