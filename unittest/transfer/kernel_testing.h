/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_KERNEL_TESTING_H
#define MPM_KERNEL_TESTING_H

// Random numbers, comparisons, and all combinations for tests of the kernels.

#include "transfer/kernels.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace MPM_TEST {

using Reals = std::vector<double>;

inline std::mt19937 generator(20260704);

inline double uniform(double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(generator);
}
inline void fill(Reals &a, double size = 1.0)
{
  for (double &x : a) x = uniform(-size, size);
}

/** Largest difference, relative to the largest value. */
inline double difference(const Reals &a, const Reals &b)
{
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double diff = 0.0, scale = std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < a.size(); i++) {
    if (!(std::abs(a[i] - b[i]) <= diff)) diff = std::abs(a[i] - b[i]);
    scale = std::max(scale, std::abs(b[i]));
  }
  return diff / scale;
}

inline MPM_NS::TransferStep random_step()
{
  MPM_NS::TransferStep step;
  step.h = uniform(0.1, 2.0);
  step.inv_h = 1.0 / step.h;
  step.dt = uniform(0.01, 0.1) * step.h;
  step.flip = uniform(0.0, 1.0);
  step.force_scale = uniform(0.5, 2.0);
  step.stress_scale = uniform(0.5, 2.0);
  for (double &o : step.origin) o = uniform(-5.0, 5.0);
  return step;
}

/** As P2G wants it before the first call. */
struct Box {
  int b[6] = {1000, 1000, 1000, -1000, -1000, -1000};
};

/** A combination of kernels. */
struct Case {
  const char *isa;
  int dim;
  MPM_NS::Shape shape;
  MPM_NS::Transfer transfer;
  bool split;
};

/** Merged records suffice. */
inline bool may_be_merged(MPM_NS::Transfer transfer)
{
  return transfer == MPM_NS::APIC || transfer == MPM_NS::TPIC;
}

/** Those of all instruction sets with the given shapes. */
inline std::vector<Case> all_cases(const std::vector<MPM_NS::Shape> &shapes)
{
  using namespace MPM_NS;
  std::vector<Case> cases;
  for (const char *isa : {"reference", "baseline", "avx2", "avx512"})
    for (int dim : {2, 3})
      for (Shape shape : shapes)
        for (Transfer transfer : {PIC, FLIP, APIC, AFLIP, TPIC})
          for (bool split : {true, false})
            if (split || may_be_merged(transfer))
              cases.push_back({isa, dim, shape, transfer, split});
  return cases;
}

inline std::string case_name(const ::testing::TestParamInfo<Case> &info)
{
  static const char *const shapes[] = {"",     "linear", "quadratic", "cubic",
                                       "gimp", "cpdi",   "cpdi2",     "bernstein"};
  static const char *const transfers[] = {"pic", "flip", "apic", "aflip", "tpic"};
  const Case &c = info.param;
  return std::string(c.isa) + "_" + std::to_string(c.dim) + "d_" + shapes[c.shape] + "_" +
      transfers[c.transfer] + (may_be_merged(c.transfer) ? (c.split ? "_split" : "_merged") : "");
}

/** The kernels of a case, and the plain ones. */
class KernelTest : public ::testing::TestWithParam<Case> {
 protected:
  int dim = 0, nreal = 0;
  const MPM_NS::MPMKernels *table;
  MPM_NS::TransferKernels kernels, reference;

  void SetUp() override
  {
    using MPM_NS::MPMKernels;
    const Case &c = GetParam();
    table = MPMKernels::select(c.isa);
    if (!table) GTEST_SKIP() << "the CPU does not have it, or the compiler does not know it";
    dim = c.dim;
    kernels = table->transfer(dim, c.shape, c.transfer, c.split);
    reference = MPMKernels::select("reference")->transfer(dim, c.shape, c.transfer, c.split);
    nreal = kernels.nreal;
    generator.seed(1);
  }
};

}    // namespace MPM_TEST
#endif
