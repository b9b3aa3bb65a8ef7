/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_node_action.h"
#include "field/mpm_plan.h"
#include "field/mpm_trial_contact.h"
#include "implicit/mpm_constraints.h"
#include "math/sets.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"

#include <algorithm>
#include <cmath>
#include <map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double PROJECTED = 1.0e-12;    // entries of projections that are not round-off
static constexpr int MOST_TIED = 48;            // nodes of a cluster that have each a unit vector
static constexpr int APART = 7;    // in larger clusters, spacings of nodes that share a unit vector

namespace {

using Tie = NodeTie;

class TiedNodes {
 public:
  TiedNodes(MPMSolvedNodes &nodes, MPMConstraints &constraints, LatticeRanks &ranks) :
      nodes(nodes), constraints(constraints), ranks(ranks), width(nodes.width)
  {
  }

  /** False, on all ranks, if there are none. */
  bool find_clusters();
  void choose_unit_vectors();
  void list_pairs();
  void find_projections();
  std::vector<Tie> nontrivial_pairs() const;

 private:
  MPMSolvedNodes &nodes;
  MPMConstraints &constraints;
  LatticeRanks &ranks;
  const int width;

  LatticeNodes tied;                         // of all ranks
  std::vector<std::vector<int>> clusters;    // of tied nodes
  std::vector<int> cluster_of;
  std::vector<int> vector_of;    // number of the unit vector of each of these nodes
  int nvectors = 0;

  /** A tied node of this rank, and its pairs with nodes of its cluster. */
  struct Row {
    int64_t node;
    int number;
    std::vector<int> others;
    std::vector<Tie> ties;
  };
  std::vector<Row> rows;

  std::vector<LatticeIndex> gather_groups(const std::vector<int64_t> &groups);
  bool is_large(const std::vector<int> &cluster) const { return (int) cluster.size() > MOST_TIED; }
};

/** Groups of all ranks: each begins with an index whose first entry is the number of indices that
 *  follow. */
std::vector<LatticeIndex> TiedNodes::gather_groups(const std::vector<int64_t> &groups)
{
  std::vector<LatticeIndex> mine;
  for (std::size_t k = 0; k < groups.size();) {
    const int64_t number = groups[k++];
    const std::size_t head = mine.size();
    mine.push_back({0, 0, 0});
    for (int64_t i = 0; i < number; i++, k++)
      if (const int64_t node = groups[k]; node >= 0 && nodes.mass[node] > 0.0)
        mine.push_back(nodes.index_of(node));
    mine[head][0] = (int) (mine.size() - head) - 1;
  }
  return ranks.gather(mine);
}

/** Joins groups that have nodes in common. */
bool TiedNodes::find_clusters()
{
  std::vector<int64_t> groups[2];
  for (auto *action : nodes.field.plan->actions)
    if (const auto *const holds = dynamic_cast<const MPMLineTies *>(action))
      holds->list_ties(nodes.field, groups[0], groups[1]);
  const auto ties = gather_groups(groups[0]), others = gather_groups(groups[1]);

  std::vector<std::pair<int, int>> joined;
  const auto join = [&](const LatticeIndex *list, int number) {
    int before = -1;
    for (int i = 0; i < number; i++) {
      const int at = tied.add(list[i]);
      if (before >= 0) joined.push_back({at, before});
      before = at;
    }
  };
  for (std::size_t k = 0; k < ties.size(); k += ties[k][0] + 1)
    if (ties[k][0] > 1) join(&ties[k + 1], ties[k][0]);
  if (tied.index.empty()) return false;
  for (bool more = true; more;) {
    const std::size_t before = tied.index.size();
    for (std::size_t k = 0; k < others.size(); k += others[k][0] + 1) {
      const LatticeIndex *const list = &others[k + 1];
      if (std::any_of(list, list + others[k][0], [&](const LatticeIndex &index) {
            return tied.find(index) >= 0;
          }))
        join(list, others[k][0]);
    }
    more = tied.index.size() > before;
  }
  Sets sets(tied.index.size());
  for (const auto &[a, b] : joined) sets.join(a, b);
  clusters.resize(tied.index.size());
  cluster_of.resize(tied.index.size());
  for (int k = 0; k < (int) tied.index.size(); k++) {
    cluster_of[k] = sets.root(k);
    clusters[cluster_of[k]].push_back(k);
  }
  return true;
}

void TiedNodes::choose_unit_vectors()
{
  vector_of.assign(tied.index.size(), -1);
  std::map<LatticeIndex, int> colors;
  for (const auto &cluster : clusters)
    for (int k = 0; k < (int) cluster.size(); k++) {
      int &of = vector_of[cluster[k]];
      of = k;
      if (is_large(cluster)) {
        LatticeIndex color{0, 0, 0};
        for (int d = 0; d < 3; d++) color[d] = (tied.index[cluster[k]][d] % APART + APART) % APART;
        of = colors.emplace(color, (int) colors.size()).first->second;
      }
      nvectors = std::max(nvectors, of + 1);
    }
}

void TiedNodes::list_pairs()
{
  for (int64_t n = 0; n < nodes.nnodes(); n++) {
    if (!(nodes.mass[n] > 0.0)) continue;
    const int number = tied.find(nodes.index_of(n));
    if (number < 0) continue;
    Row row{n, number, {}, {}};
    const LatticeIndex &at = tied.index[number];
    const auto &cluster = clusters[cluster_of[number]];
    const auto add = [&](int other) {
      row.ties.push_back({n, tied.index[other], {}});
      row.others.push_back(other);
    };
    if (!is_large(cluster))
      for (const int other : cluster) add(other);
    for (int k = 0; is_large(cluster) && k < APART * APART * APART; k++) {
      const LatticeIndex index{at[0] + k % APART - APART / 2, at[1] + k / APART % APART - APART / 2,
                               at[2] + k / (APART * APART) - APART / 2};
      const int other = tied.find(index);
      if (other >= 0 && cluster_of[other] == cluster_of[number]) add(other);
    }
    rows.push_back(std::move(row));
  }
}

/** The part of P between the nodes of a cluster. */
void TiedNodes::find_projections()
{
  std::vector<double> unit(nodes.nreals());
  for (int k = 0; k < nvectors; k++)
    for (int column = 0; column < width; column++) {
      std::fill(unit.begin(), unit.end(), 0.0);
      for (const auto &row : rows)
        if (vector_of[row.number] == k) unit[width * row.node + column] = 1.0;
      constraints.project(unit.data());
      for (auto &row : rows)
        for (std::size_t j = 0; j < row.ties.size(); j++)
          for (int a = 0; a < width && vector_of[row.others[j]] == k; a++)
            row.ties[j].P[width * a + column] = unit[width * row.node + a];
    }
}

/** Most pairs of nodes have no part of P: they would only cost time in levels and their factors. */
std::vector<Tie> TiedNodes::nontrivial_pairs() const
{
  std::vector<Tie> list;
  for (const auto &row : rows) {
    std::vector<Tie> kept;
    bool held = false;
    for (std::size_t k = 0; k < row.ties.size(); k++) {
      const bool own = row.others[k] == row.number;
      double change = 0.0;
      for (int ab = 0; ab < width * width; ab++) {
        const double of_unity = own && ab % (width + 1) == 0;
        change = std::max(change, std::fabs(row.ties[k].P[ab] - of_unity));
      }
      held = held || change > PROJECTED;
      if (own || change > PROJECTED) kept.push_back(row.ties[k]);
    }
    if (held) list.insert(list.end(), kept.begin(), kept.end());
  }
  return list;
}

}    // namespace

std::vector<Tie> LAMMPS_NS::find_tied_nodes(MPMSolvedNodes &nodes, MPMConstraints &constraints,
                                            LatticeRanks &ranks)
{
  TiedNodes tied(nodes, constraints, ranks);
  if (!tied.find_clusters()) return {};
  tied.choose_unit_vectors();
  tied.list_pairs();
  tied.find_projections();
  return tied.nontrivial_pairs();
}
