/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/shared_nodes.h"

#include <algorithm>
#include <cstring>

using namespace MPM_NS;

void SharedNodes::clear()
{
  nodes = {};
  place.clear();
  all_places.clear();
}

bool SharedNodes::find(const std::vector<LatticeIndex> &mine, std::vector<int> &to) const
{
  to.clear();
  for (const auto &index : mine) {
    to.push_back(nodes.find(index));
    if (to.back() < 0) return false;
  }
  return true;
}

void SharedNodes::take(std::vector<int> &found, std::size_t owned)
{
  place.swap(found);
  const std::vector<int> mine(place.begin(), place.begin() + owned);
  all_places = ranks.gather(mine);
  counts = ranks.gather(std::vector<int>(1, (int) owned));
}

void SharedNodes::number(const std::vector<LatticeIndex> &mine, std::size_t owned)
{
  nodes = {};
  const std::vector<LatticeIndex> own(mine.begin(), mine.begin() + owned);
  for (const auto &index : ranks.gather(own)) nodes.add(index);
  std::vector<int> found;
  find(mine, found);
  take(found, owned);
}

bool SharedNodes::renumber(const std::vector<LatticeIndex> &mine, std::size_t owned)
{
  struct Owned {
    int same, owned;
  };
  std::vector<int> found;
  const bool same = find(mine, found);
  bool all_same = true;
  std::size_t count = 0;
  for (const auto &rank : ranks.gather(std::vector<Owned>(1, {same, (int) owned}))) {
    all_same = all_same && rank.same;
    count += rank.owned;
  }
  // each node has one owner: as many as there were, all of which are known, are all of them
  if (!all_same || count != size()) return false;
  take(found, owned);
  return true;
}

void SharedNodes::gather(const std::vector<double> &owned_values, int width,
                         std::vector<double> &all)
{
  sizes.resize(counts.size());
  for (std::size_t rank = 0; rank < counts.size(); rank++)
    sizes[rank] = (int) sizeof(double) * counts[rank] * width;
  const auto &bytes = ranks.gather_sizes(owned_values.data(), sizes);
  all.resize(size() * width);
  const char *from = bytes.data();
  for (const int to : all_places) {
    std::memcpy(&all[(std::size_t) to * width], from, width * sizeof(double));
    from += width * sizeof(double);
  }
}
