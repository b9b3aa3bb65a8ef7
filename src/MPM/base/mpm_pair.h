/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PAIR_H
#define LMP_MPM_PAIR_H

#include "atom.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "error.h"
#include "memory.h"
#include "pair.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/** A pair style with coefficients of two types, which it reads, keeps, and writes to restart files
 *  as they are. Coeff has declare(), and set, which pair_coeff sets to 1. It outputs the number of
 *  contacts and the power that they dissipate. */
template <class Coeff> class MPMPair : public Pair {
 public:
  MPMPair(LAMMPS *lmp, const char *style) : Pair(lmp), style(style)
  {
    single_enable = 0;
    nextra = 2;
    pvector = new double[nextra]();
  }
  ~MPMPair() override
  {
    if (copymode) return;
    delete[] pvector;
    if (allocated) {
      memory->destroy(setflag);
      memory->destroy(cutsq);
    }
  }
  void coeff(int narg, char **arg) override;
  void write_restart(FILE *) override;
  void read_restart(FILE *) override;
  double memory_usage() override
  {
    return Pair::memory_usage() + (double) pairs.capacity() * sizeof(pairs[0]);
  }

 protected:
  const std::string style;
  std::vector<Coeff> coeffs;                 // [ntypes+1][ntypes+1]
  std::vector<std::pair<int, int>> pairs;    // that can touch, from the present neighbor list

  Coeff &coeff_of(int i, int j)
  {
    return coeffs[std::min(i, j) * (atom->ntypes + 1) + std::max(i, j)];
  }
  /** Must the input give coefficients of a type with itself? */
  virtual bool needs_own_type() const { return true; }

 private:
  void allocate();
};

template <class Coeff> void MPMPair<Coeff>::allocate()
{
  allocated = 1;
  const int n = atom->ntypes + 1;
  memory->create(setflag, n, n, "pair:setflag");
  memory->create(cutsq, n, n, "pair:cutsq");
  memset(&setflag[0][0], 0, n * n * sizeof(int));
  memset(&cutsq[0][0], 0, n * n * sizeof(double));
  coeffs.assign(n * n, Coeff());
  for (int i = 1; i < n && !needs_own_type(); i++) setflag[i][i] = 1;
}

template <class Coeff> void MPMPair<Coeff>::coeff(int narg, char **arg)
{
  if (!allocated) allocate();
  int ilo, ihi, jlo, jhi;
  utils::bounds(FLERR, arg[0], 1, atom->ntypes, ilo, ihi, error);
  utils::bounds(FLERR, arg[1], 1, atom->ntypes, jlo, jhi, error);
  Coeff c;
  MPM_NS::Options options = c.declare();
  read_options(lmp, options, narg, arg, 2);
  c.set = 1;

  int count = 0;
  for (int i = ilo; i <= ihi; i++)
    for (int j = std::max(jlo, i); j <= jhi; j++) {
      coeff_of(i, j) = c;
      setflag[i][j] = 1;
      count++;
    }
  if (count == 0) error->all(FLERR, "Incorrect args for pair_coeff {}: no types I <= J", style);
}

template <class Coeff> void MPMPair<Coeff>::write_restart(FILE *fp)
{
  write_restart_settings(fp);
  fwrite(coeffs.data(), sizeof(Coeff), coeffs.size(), fp);
}

template <class Coeff> void MPMPair<Coeff>::read_restart(FILE *fp)
{
  read_restart_settings(fp);
  allocate();
  if (comm->me == 0)
    utils::sfread(FLERR, coeffs.data(), sizeof(Coeff), coeffs.size(), fp, nullptr, error);
  MPI_Bcast(coeffs.data(), (int) (coeffs.size() * sizeof(Coeff)), MPI_BYTE, 0, world);
  for (int i = 1; i <= atom->ntypes; i++)
    for (int j = i; j <= atom->ntypes; j++)
      if (coeff_of(i, j).set) setflag[i][j] = 1;
}

}    // namespace LAMMPS_NS
#endif
