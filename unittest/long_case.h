// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_LONG_CASE_H
#define MPM_LONG_CASE_H

// What takes long is left out by tools/test.sh without arguments, which sets MPM_QUICK.

#include "gtest/gtest.h"

#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

namespace MPM_TEST {

/** Is what takes long left out? */
inline bool is_quick()
{
  return getenv("MPM_QUICK");
}

}    // namespace MPM_TEST

/** A case that takes long begins with this. */
#define LONG_CASE() \
  if (MPM_TEST::is_quick()) GTEST_SKIP() << "a long one: tools/test.sh all"

/** So does a PARAMETER_TEST of which the first n parameters are enough to see most mistakes. */
#define LONG_AFTER(n) \
  if (MPM_TEST::parameter_number() >= n) LONG_CASE()

namespace MPM_TEST {

/** Which of its parameters a test has now: the number at the end of its name. */
inline int parameter_number()
{
  const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  return std::stoi(name.substr(name.rfind('/') + 1));
}

/** These values, or the first few of them where what takes long is left out. */
template <class T> std::vector<T> first_of(std::size_t few, std::initializer_list<T> values)
{
  std::vector<T> list(values);
  if (is_quick() && few < list.size()) list.erase(list.begin() + few, list.end());
  return list;
}

}    // namespace MPM_TEST
#endif
