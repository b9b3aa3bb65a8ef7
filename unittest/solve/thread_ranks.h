// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_TEST_THREAD_RANKS_H
#define MPM_TEST_THREAD_RANKS_H

#include "solve/lattice_ranks.h"

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace MPM_NS {

/** Threads that act as the ranks of a LAMMPS instance, and the bytes that each of them gives. */
struct Threads {
  std::mutex mutex;
  std::condition_variable all_have_come;
  std::vector<std::string> given;
  int count = 0, turn = 0;
  explicit Threads(int n) : given(n) {}

  /** Waits until all threads have called this. */
  void meet()
  {
    std::unique_lock<std::mutex> lock(mutex);
    const int now = turn;
    if (++count == (int) given.size()) {
      count = 0;
      turn++;
      all_have_come.notify_all();
    } else
      all_have_come.wait(lock, [&] {
        return turn != now;
      });
  }
};

/** One of these ranks. Bytes are concatenated in order of ranks; sum() does nothing. */
struct ThreadRank : LatticeRanks {
  Threads &team;
  const int mine;
  std::vector<char> all;
  ThreadRank(Threads &team, int mine) : team(team), mine(mine) {}
  int number() const override { return team.given.size(); }
  int me() const override { return mine; }
  void sum(double *, int) override {}
  const std::vector<char> &gather_bytes(const void *of, std::size_t bytes) override
  {
    team.given[mine].assign(static_cast<const char *>(of), bytes);
    team.meet();
    all.clear();
    for (const auto &text : team.given) all.insert(all.end(), text.begin(), text.end());
    team.meet();
    return all;
  }
};

/** Calls f(rank) for each of n ranks at once. */
template <class F> void on_ranks(int n, const F &f)
{
  Threads team(n);
  std::vector<std::thread> threads;
  for (int me = 0; me < n; me++)
    threads.emplace_back([&, me] {
      ThreadRank rank(team, me);
      f(rank);
    });
  for (auto &thread : threads) thread.join();
}

}    // namespace MPM_NS
#endif
