// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Sets of things that belong together.

#include "math/sets.h"

#include "gtest/gtest.h"

#include <set>

using namespace MPM_NS;

// numbers that differ by a multiple of 7 are joined by steps of 14 and 21, in both directions
TEST(Sets, AreThoseOfJoinedThings)
{
  constexpr int n = 1000, modulus = 7;
  Sets sets(n);
  for (int i = n - 1; i >= 14; i--) sets.join(i, i - 14);
  for (int i = 21; i < n; i++) sets.join(i - 21, i);
  std::set<int> roots;
  for (int i = 0; i < n; i++) {
    EXPECT_EQ(sets.root(i), sets.root(i % modulus));
    EXPECT_EQ(sets.root(i) % modulus, i % modulus);
    roots.insert(sets.root(i));
  }
  EXPECT_EQ((int) roots.size(), modulus);
}

TEST(Sets, BeginAgain)
{
  Sets sets(3);
  sets.join(0, 2);
  EXPECT_EQ(sets.root(0), sets.root(2));
  sets.begin(5);
  EXPECT_EQ(sets.size(), 5u);
  for (int i = 0; i < 5; i++) EXPECT_EQ(sets.root(i), i);
}
