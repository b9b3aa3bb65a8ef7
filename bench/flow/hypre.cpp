/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   What HYPRE takes for the pressure of a column of water in the corner of a tank: N/2 by N by 3N/4
   cells, with walls on four sides and free surfaces on the two others, by conjugate gradients with
   BoomerAMG (HMIS, extended interpolation of up to 4 entries, aggressive coarsening on the first
   level) to 1e-9, from a matrix that is there. Compare with a step of fix mpm/incompressible in the
   same scene.

     mpicxx -O2 bench/flow/hypre.cpp -o hypre -I/usr/include/hypre -lHYPRE && ./hypre 64
------------------------------------------------------------------------- */

#include <HYPRE.h>
#include <HYPRE_parcsr_ls.h>
#include <mpi.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

struct Tank {
  int n[3];
  HYPRE_BigInt cells() const { return (HYPRE_BigInt) n[0] * n[1] * n[2]; }
  HYPRE_BigInt index(int i, int j, int k) const { return i + n[0] * (j + (HYPRE_BigInt) n[1] * k); }
};

/** Seven entries in a row; a free surface is half a cell away, a wall closes a face. */
HYPRE_IJMatrix poisson(const Tank &tank)
{
  HYPRE_IJMatrix A;
  const HYPRE_BigInt cells = tank.cells();
  HYPRE_IJMatrixCreate(MPI_COMM_WORLD, 0, cells - 1, 0, cells - 1, &A);
  HYPRE_IJMatrixSetObjectType(A, HYPRE_PARCSR);
  HYPRE_IJMatrixSetRowSizes(A, std::vector<HYPRE_Int>(cells, 7).data());
  HYPRE_IJMatrixInitialize(A);
  for (int k = 0; k < tank.n[2]; k++)
    for (int j = 0; j < tank.n[1]; j++)
      for (int i = 0; i < tank.n[0]; i++) {
        const std::array<int, 3> cell = {i, j, k};
        HYPRE_BigInt row = tank.index(i, j, k), columns[7] = {row};
        double values[7] = {0.0};
        HYPRE_Int entries = 1;
        for (int face = 0; face < 6; face++) {
          const int d = face / 2;
          auto next = cell;
          next[d] += face % 2 ? 1 : -1;
          if (next[d] < 0 || (d == 1 && next[d] >= tank.n[d])) continue;
          const bool free = next[d] >= tank.n[d];
          values[0] += free ? 2.0 : 1.0;
          if (free) continue;
          columns[entries] = tank.index(next[0], next[1], next[2]);
          values[entries++] = -1.0;
        }
        HYPRE_IJMatrixSetValues(A, 1, &entries, &row, columns, values);
      }
  HYPRE_IJMatrixAssemble(A);
  return A;
}

HYPRE_IJVector vector(const std::vector<double> &values)
{
  HYPRE_IJVector v;
  const auto n = (HYPRE_BigInt) values.size();
  HYPRE_IJVectorCreate(MPI_COMM_WORLD, 0, n - 1, &v);
  HYPRE_IJVectorSetObjectType(v, HYPRE_PARCSR);
  HYPRE_IJVectorInitialize(v);
  HYPRE_IJVectorSetValues(v, (HYPRE_Int) n, nullptr, values.data());
  HYPRE_IJVectorAssemble(v);
  return v;
}

}    // namespace

int main(int narg, char **arg)
{
  MPI_Init(&narg, &arg);
  HYPRE_Init();
  const int N = narg > 1 ? std::atoi(arg[1]) : 64;
  const Tank tank{{N / 2, N, 3 * N / 4}};

  double t[4] = {MPI_Wtime()};
  HYPRE_IJMatrix A = poisson(tank);
  std::mt19937 random(1);
  std::vector<double> divergence(tank.cells());
  for (double &value : divergence) value = std::uniform_real_distribution<>(-1.0, 1.0)(random);
  HYPRE_IJVector b = vector(divergence), p = vector(std::vector<double>(divergence.size(), 0.0));
  HYPRE_ParCSRMatrix matrix;
  HYPRE_ParVector right, solution;
  HYPRE_IJMatrixGetObject(A, (void **) &matrix);
  HYPRE_IJVectorGetObject(b, (void **) &right);
  HYPRE_IJVectorGetObject(p, (void **) &solution);

  HYPRE_Solver gradients, levels;
  HYPRE_ParCSRPCGCreate(MPI_COMM_WORLD, &gradients);
  HYPRE_PCGSetMaxIter(gradients, 200);
  HYPRE_PCGSetTol(gradients, 1e-9);
  HYPRE_PCGSetTwoNorm(gradients, 1);
  HYPRE_BoomerAMGCreate(&levels);
  HYPRE_BoomerAMGSetCoarsenType(levels, 10);
  HYPRE_BoomerAMGSetInterpType(levels, 6);
  HYPRE_BoomerAMGSetRelaxType(levels, 6);
  HYPRE_BoomerAMGSetNumSweeps(levels, 1);
  HYPRE_BoomerAMGSetStrongThreshold(levels, 0.5);
  HYPRE_BoomerAMGSetPMaxElmts(levels, 4);
  HYPRE_BoomerAMGSetAggNumLevels(levels, 1);
  HYPRE_BoomerAMGSetTol(levels, 0.0);
  HYPRE_BoomerAMGSetMaxIter(levels, 1);
  HYPRE_PCGSetPrecond(gradients, (HYPRE_PtrToSolverFcn) HYPRE_BoomerAMGSolve,
                      (HYPRE_PtrToSolverFcn) HYPRE_BoomerAMGSetup, levels);
  t[1] = MPI_Wtime();
  HYPRE_ParCSRPCGSetup(gradients, matrix, right, solution);
  t[2] = MPI_Wtime();
  HYPRE_ParCSRPCGSolve(gradients, matrix, right, solution);
  t[3] = MPI_Wtime();
  HYPRE_Int iterations;
  HYPRE_PCGGetNumIterations(gradients, &iterations);
  std::printf("%lld cells: matrix %.3f s, levels %.3f s, %d iterations %.3f s\n",
              (long long) tank.cells(), t[1] - t[0], t[2] - t[1], (int) iterations, t[3] - t[2]);

  HYPRE_BoomerAMGDestroy(levels);
  HYPRE_ParCSRPCGDestroy(gradients);
  HYPRE_IJMatrixDestroy(A);
  HYPRE_IJVectorDestroy(b);
  HYPRE_IJVectorDestroy(p);
  HYPRE_Finalize();
  MPI_Finalize();
}
