// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

/* ----------------------------------------------------------------------
   main() of all tests, with one or more MPI processes.  Process 0 reports;
   the others report failures only.  Any failure makes all processes fail.
   -v: show the output of LAMMPS
   --file=NAME: only the tests of this source, where the program has those of several
------------------------------------------------------------------------- */

#include <mpi.h>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>

// used by LAMMPS's test fixture
bool verbose = false;

class ReportFailures : public ::testing::EmptyTestEventListener {
  int rank;

  void OnTestPartResult(const ::testing::TestPartResult &result) override
  {
    if (!result.failed()) return;
    fprintf(stderr, "process %d: %s:%d: %s\n", rank, result.file_name() ? result.file_name() : "?",
            result.line_number(), result.message());
    fflush(stderr);
  }

 public:
  explicit ReportFailures(int rank) : rank(rank) {}
};

/** Reports the processor time of each case, for tools/count_tests.py. */
class ReportSeconds : public ::testing::EmptyTestEventListener {
  std::clock_t start = 0;

  void OnTestStart(const ::testing::TestInfo &) override { start = std::clock(); }
  void OnTestEnd(const ::testing::TestInfo &) override
  {
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    ::testing::Test::RecordProperty("seconds", std::to_string(seconds));
  }
};

/** A filter with all tests of the source with this name. */
static std::string tests_of(const char *source)
{
  std::string filter;
  const ::testing::UnitTest &all = *::testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); i++) {
    const ::testing::TestSuite &suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); k++) {
      const ::testing::TestInfo &test = *suite.GetTestInfo(k);
      const char *slash = strrchr(test.file(), '/');
      if (strcmp(slash ? slash + 1 : test.file(), source) == 0)
        filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);

  ::testing::InitGoogleMock(&argc, argv);
  for (int i = 1; i < argc; i++)
    if (strcmp(argv[i], "-v") == 0)
      verbose = true;
    else if (strncmp(argv[i], "--file=", 7) == 0 && ::testing::GTEST_FLAG(filter) == "*")
      ::testing::GTEST_FLAG(filter) = tests_of(argv[i] + 7);

  if (rank > 0) {
    auto &listeners = ::testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    delete listeners.Release(listeners.default_xml_generator());    // one process writes the file
    listeners.Append(new ReportFailures(rank));
  }

  ::testing::UnitTest::GetInstance()->listeners().Append(new ReportSeconds);

  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return failed;
}
