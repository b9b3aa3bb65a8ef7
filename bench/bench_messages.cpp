// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// What messages between two ranks take: latency and bandwidth of a ping-pong, a sum over ranks, and
// what a node costs to be put into a message and to be added. The lowest of many, since others may
// use the machine.
//
//   mpirun -np 2 bench_messages
//
// Prints one line for each quantity: name, value, unit. bench/scaling_model.py reads them.

#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <vector>

static double lowest(int repeat, const std::function<void()> &f)
{
  double best = 1.0e300;
  for (int k = 0; k < repeat; k++) {
    const double start = MPI_Wtime();
    f();
    best = std::min(best, MPI_Wtime() - start);
  }
  return best;
}

int main(int narg, char **arg)
{
  MPI_Init(&narg, &arg);
  int me, nranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  MPI_Comm_size(MPI_COMM_WORLD, &nranks);
  if (nranks != 2) {
    if (me == 0) fprintf(stderr, "bench_messages needs 2 ranks\n");
    MPI_Abort(MPI_COMM_WORLD, 1);
  }

  constexpr int MOST = 1 << 20;
  std::vector<char> out(MOST, 1), in(MOST, 2);
  const auto one_way = [&](int bytes) {
    return 0.5 * lowest(2000, [&]() {
             for (int turn = 0; turn < 2; turn++) {
               if (turn == me)
                 MPI_Send(out.data(), bytes, MPI_CHAR, 1 - me, 0, MPI_COMM_WORLD);
               else
                 MPI_Recv(in.data(), bytes, MPI_CHAR, 1 - me, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
             }
           });
  };
  const double latency = one_way(8), large = one_way(MOST), middle = one_way(MOST / 16);
  const double all = lowest(2000, [&]() {
    int mine = me, most;
    MPI_Allreduce(&mine, &most, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  });

  // rows of three nodes in blocks that are anywhere in 64 MB, as in a face between ranks

  constexpr int NODES = 9000, WIDTH = 4, BLOCKS = 32768;
  std::vector<double> nodes((std::size_t) BLOCKS * 64 * WIDTH, 1.0), message(NODES * WIDTH, 1.0);
  std::vector<int> list;
  for (unsigned block = 1; (int) list.size() < NODES; block = block * 1664525u + 1013904223u)
    for (int row = 0; row < 16; row++)
      for (int k = 0; k < 3; k++) list.push_back((int) (block >> 8) % BLOCKS * 64 + 4 * row + k);
  list.resize(NODES);
  const auto flush = [&]() {    // out of the caches of the core
    std::vector<double> other(4 << 20, 1.0);
    return other[me];
  };
  double pack = 1.0e300, add = 1.0e300;
  for (int k = 0; k < 30; k++) {
    flush();
    pack = std::min(pack, lowest(1, [&]() {
                      double *to = message.data();
                      for (const int node : list)
                        for (int l = 0; l < WIDTH; l++)
                          *to++ = nodes[(std::size_t) node * WIDTH + l];
                    }));
    add = std::min(add, lowest(1, [&]() {
                     const double *from = message.data();
                     for (const int node : list)
                       for (int l = 0; l < WIDTH; l++)
                         nodes[(std::size_t) node * WIDTH + l] += *from++;
                   }));
  }

  if (me == 0) {
    printf("latency %.3f us\n", 1.0e6 * latency);
    printf("bandwidth_64kB %.2f GB/s\n", 1.0e-9 * (MOST / 16) / middle);
    printf("bandwidth_1MB %.2f GB/s\n", 1.0e-9 * MOST / large);
    printf("allreduce_2 %.3f us\n", 1.0e6 * all);
    printf("pack %.2f ns/node\n", 1.0e9 * pack / NODES);
    printf("add %.2f ns/node\n", 1.0e9 * add / NODES);
  }
  MPI_Finalize();
}
