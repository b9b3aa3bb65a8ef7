/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/near_nodes.h"

#include <algorithm>
#include <map>
#include <queue>

using namespace MPM_NS;

NearNodes::NearNodes(int64_t nnodes, const std::vector<Edge> &edges, double length)
{
  struct Way {
    double length;
    int64_t to;
    bool operator>(const Way &other) const { return length > other.length; }
  };
  std::vector<std::vector<Way>> ways(nnodes);
  for (const auto &e : edges) {
    ways[e.a].push_back({e.length, e.b});
    ways[e.b].push_back({e.length, e.a});
  }

  // shortest paths from each node (E.W. Dijkstra, Numer. Math. 1 (1959) 269), as far as they matter
  start.push_back(0);
  for (int64_t i = 0; i < nnodes; i++) {
    std::map<int64_t, double> found;
    std::priority_queue<Way, std::vector<Way>, std::greater<>> next;
    next.push({0.0, i});
    while (!next.empty()) {
      const Way way = next.top();
      next.pop();
      if (!found.emplace(way.to, way.length).second) continue;
      for (const auto &further : ways[way.to])
        if (way.length + further.length < length && !found.count(further.to))
          next.push({way.length + further.length, further.to});
    }
    for (const auto &one : found) list.push_back(one.first);
    start.push_back((int64_t) list.size());
  }
}

bool NearNodes::near(int64_t a, int64_t b) const
{
  return std::binary_search(list.begin() + start[a], list.begin() + start[a + 1], b);
}

double NearNodes::memory() const
{
  return (double) (start.capacity() + list.capacity()) * sizeof(int64_t);
}
