// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

/* ----------------------------------------------------------------------
   main() of all tests, with one or more MPI processes.  Process 0 reports;
   the others report failures only.  Any failure makes all processes fail.
   -v: show the output of LAMMPS
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

// an error of LAMMPS on one process only leaves the others waiting for it: end them all
class EndAllProcesses : public ::testing::EmptyTestEventListener {
  void OnTestPartResult(const ::testing::TestPartResult &result) override
  {
    if (!result.failed() ||
        !strstr(result.message(), "C++ exception with description \"ERROR on proc"))
      return;
    fprintf(stderr, "%s\n", result.message());
    fflush(nullptr);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
};

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

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);

  ::testing::InitGoogleMock(&argc, argv);
  for (int i = 1; i < argc; i++)
    if (strcmp(argv[i], "-v") == 0) verbose = true;

  int nprocs;
  MPI_Comm_size(MPI_COMM_WORLD, &nprocs);
  if (nprocs > 1) ::testing::UnitTest::GetInstance()->listeners().Append(new EndAllProcesses);
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
