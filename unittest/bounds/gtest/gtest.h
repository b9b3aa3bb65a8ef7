// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_BOUNDS_GTEST_H
#define MPM_BOUNDS_GTEST_H

// In front of GoogleTest's own header with the option MPM_BOUNDS: checks record how near to its
// bound each result is. At its end, a process appends what it recorded to a file of its own in the
// folder that the environment variable MPM_BOUNDS names, where tools/bounds.py reads it.

#include_next <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>
#include <type_traits>

namespace MPM_BOUNDS {

/** The result of a check that was nearest to its bound, of all in one test. */
struct Nearest {
  double error = 0.0, bound = 0.0, ratio = -1.0, scale = 0.0;
  const char *text = "";
  long times = 0;
};

class Record {
  std::map<std::tuple<std::string, int, std::string>, Nearest> checks;

 public:
  void add(const char *file, int line, double error, double bound, double scale, const char *text)
  {
    const auto *test = ::testing::UnitTest::GetInstance()->current_test_info();
    Nearest &nearest =
        checks[{file, line, test ? std::string(test->test_suite_name()) + "." + test->name() : ""}];
    nearest.times++;
    nearest.text = text;
    nearest.scale = std::max(nearest.scale, scale);
    const double ratio = bound > 0.0 ? error / bound : 1.0;
    if (ratio <= nearest.ratio) return;
    nearest.ratio = ratio;
    nearest.error = error;
    nearest.bound = bound;
  }

  ~Record()
  {
    const char *folder = std::getenv("MPM_BOUNDS");
    if (!folder || checks.empty()) return;
    const std::string name = std::string(folder) + "/" + std::to_string(getpid()) + ".txt";
    FILE *out = std::fopen(name.c_str(), "a");
    if (!out) return;
    for (const auto &[at, nearest] : checks) {
      const auto &[file, line, test] = at;
      std::fprintf(out, "%s\t%d\t%s\t%.17g\t%.17g\t%.17g\t%ld\t%s\n", file.c_str(), line,
                   test.c_str(), nearest.error, nearest.bound, nearest.scale, nearest.times,
                   nearest.text);
    }
    std::fclose(out);
  }
};

inline Record &record()
{
  static Record one;
  return one;
}

class Check {
 protected:
  const char *file;
  int line;

 public:
  Check(const char *file, int line) : file(file), line(line) {}
};

struct Near : Check {
  using Check::Check;
  ::testing::AssertionResult operator()(const char *a, const char *b, const char *text, double x,
                                        double y, double bound) const
  {
    record().add(file, line, std::fabs(x - y), bound, std::max(std::fabs(x), std::fabs(y)), text);
    return ::testing::internal::DoubleNearPredFormat(a, b, text, x, y, bound);
  }
};

/** For LT and LE: whole numbers have no error, and what may be negative is none. */
template <bool EQUAL> struct Below : Check {
  using Check::Check;
  template <typename A, typename B>
  ::testing::AssertionResult operator()(const char *a, const char *text, const A &x,
                                        const B &bound) const
  {
    if constexpr (std::is_floating_point_v<A> && std::is_floating_point_v<B>)
      if (x >= 0.0) record().add(file, line, x, bound, 0.0, text);
    if constexpr (EQUAL)
      return ::testing::internal::CmpHelperLE(a, text, x, bound);
    else
      return ::testing::internal::CmpHelperLT(a, text, x, bound);
  }
};

}    // namespace MPM_BOUNDS

#undef EXPECT_NEAR
#undef ASSERT_NEAR
#undef EXPECT_LT
#undef ASSERT_LT
#undef EXPECT_LE
#undef ASSERT_LE
#define EXPECT_NEAR(x, y, bound) \
  EXPECT_PRED_FORMAT3(::MPM_BOUNDS::Near(__FILE__, __LINE__), x, y, bound)
#define ASSERT_NEAR(x, y, bound) \
  ASSERT_PRED_FORMAT3(::MPM_BOUNDS::Near(__FILE__, __LINE__), x, y, bound)
#define EXPECT_LT(x, bound) \
  EXPECT_PRED_FORMAT2(::MPM_BOUNDS::Below<false>(__FILE__, __LINE__), x, bound)
#define ASSERT_LT(x, bound) \
  ASSERT_PRED_FORMAT2(::MPM_BOUNDS::Below<false>(__FILE__, __LINE__), x, bound)
#define EXPECT_LE(x, bound) \
  EXPECT_PRED_FORMAT2(::MPM_BOUNDS::Below<true>(__FILE__, __LINE__), x, bound)
#define ASSERT_LE(x, bound) \
  ASSERT_PRED_FORMAT2(::MPM_BOUNDS::Below<true>(__FILE__, __LINE__), x, bound)

#endif
