/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_ISA_H
#define MPM_TRANSFER_KERNELS_ISA_H

// Selects the combination of constants that kernels are compiled for from the choice of a user, for
// all files of kernels, plain and fast.

#include "transfer/isa.h"
#include "transfer/kernels.h"

#include <type_traits>

#if !defined(MPM_ISA)    // the plain loops
#define MPM_ISA base
#endif

// The vector extensions of transfer/vector.h: without them the plain loops serve, and the other
// files are empty.
#if defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define MPM_HAVE_VECTORS
#endif
#endif

namespace MPM_NS {

/** The requested kernels, see MPMKernels::transfer. */
struct KernelChoice {
  int dim;
  Shape shape;
  Transfer transfer;
  bool split, total;
};

const MPMKernels *mpm_kernels_reference();
const MPMKernels *MPM_OF_ISA(mpm_kernels)(const char *isa);

// files that are compiled side by side, one for each shape: transfers of a shape share kernels
TransferKernels MPM_OF_ISA(mpm_kernels_linear)(const KernelChoice &);
TransferKernels MPM_OF_ISA(mpm_kernels_quadratic)(const KernelChoice &);
TransferKernels MPM_OF_ISA(mpm_kernels_cubic)(const KernelChoice &);
TransferKernels MPM_OF_ISA(mpm_kernels_gimp)(const KernelChoice &);
TransferKernels MPM_OF_ISA(mpm_kernels_bernstein)(const KernelChoice &);
TransferKernels MPM_OF_ISA(mpm_kernels_cpdi)(const KernelChoice &);
TransferKernels MPM_OF_ISA(mpm_kernels_cpdi2)(const KernelChoice &);
PolyKernels MPM_OF_ISA(mpm_kernels_poly)(int dim, Shape, int nreal);

}    // namespace MPM_NS

namespace {    // not shared between instruction sets

using namespace MPM_NS;

/** Calls use(constant) with that one of VALUES that equals the given value. */
template <class T, T FIRST, T... OTHERS, class Use> auto with(T value, Use use)
{
  if constexpr (sizeof...(OTHERS) > 0)
    if (value != FIRST) return with<T, OTHERS...>(value, use);
  return use(std::integral_constant<T, FIRST>());
}

/** A combination of constants that kernels are compiled for. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, bool TOTAL> struct Combination {
  static constexpr int dim = DIM;
  static constexpr Shape shape = SHAPE;
  static constexpr Transfer transfer = TRANSFER;
  static constexpr int nreal = NREAL;
  static constexpr bool total = TOTAL;

  /** Are there fast kernels? */
  static constexpr bool fast()
  {
    return !TOTAL || !(TRANSFER == AFLIP || has_size(SHAPE) || has_domain(SHAPE));
  }
};

/** Nodes of a tile from one to the next along an axis. */
template <int DIM, Shape SHAPE> constexpr int stride(int axis)
{
  constexpr int order = stencil_order(SHAPE);
  if (axis == 2) return DIM == 3;
  if (has_domain(SHAPE)) return axis ? domain_stride_y(DIM) : domain_stride_x(DIM);
  return axis ? tile_stride_y(DIM, order) : tile_stride_x(DIM, order);
}
/** Nodes of a tile in front of its block. */
template <int DIM, Shape SHAPE> constexpr int margin()
{
  return has_domain(SHAPE) ? block_side(DIM) : 1;
}

/** Quantities that P2G transfers. */
enum Parts { MOMENTUM = 1, FORCE = 2, ALL = 3 };

/** The table of a combination without its functions. */
template <class C> TransferKernels table_of()
{
  TransferKernels k = {};
  k.nreal = C::nreal;
  k.margin = margin<C::dim, C::shape>();
  k.affine = is_affine(C::transfer);
  k.gradient_in_C = is_gradient(C::shape, C::transfer);
  return k;
}

/** make(Combination) of a choice. */
template <class Make> TransferKernels choose(KernelChoice c, Make make)
{
  // with these the affine matrix is the gradient in any case
  if (c.shape == CPGIMP) c.shape = GIMP;
  if (c.shape == LINEAR && c.transfer == TPIC) c.transfer = APIC;
  if (c.shape == GIMP && c.transfer == APIC) c.transfer = TPIC;
  if (c.shape == BERNSTEIN) c.total = true;

  return with<int, 2, 3>(c.dim, [&](auto dim) {
    constexpr int DIM = decltype(dim)::value;
    return with<Shape, LINEAR, QUADRATIC, CUBIC, GIMP, CPDI, CPDI2, BERNSTEIN>(
        c.shape, [&](auto s) {
          constexpr Shape SHAPE = decltype(s)::value;
          return with<Transfer, PIC, FLIP, APIC, AFLIP, TPIC>(c.transfer, [&](auto t) {
            constexpr Transfer TRANSFER = decltype(t)::value;
            constexpr bool replaced = (SHAPE == LINEAR && TRANSFER == TPIC) ||
                (SHAPE == GIMP && TRANSFER == APIC);    // see above
            constexpr int MERGED = is_affine(TRANSFER) && !adds_change(TRANSFER) ? 4 : 8;
            return with<bool, false, true>(c.total, [&](auto total) {
              constexpr bool TOTAL = decltype(total)::value;
              if constexpr (replaced || (SHAPE == BERNSTEIN && !TOTAL))
                return TransferKernels();
              else if (c.split)
                return make(Combination<DIM, SHAPE, TRANSFER, 8, TOTAL>());
              else
                return make(Combination<DIM, SHAPE, TRANSFER, MERGED, TOTAL>());
            });
          });
        });
  });
}

/** make(Combination) for polypic. */
template <class Make> PolyKernels choose_poly(int dim, Shape shape, int nreal, Make make)
{
  return with<int, 2, 3>(dim, [&](auto d) {
    constexpr int DIM = decltype(d)::value;
    return with<Shape, QUADRATIC, CUBIC>(shape, [&](auto s) {
      constexpr Shape SHAPE = decltype(s)::value;
      return nreal == 4 ? make(Combination<DIM, SHAPE, APIC, 4, false>())
                        : make(Combination<DIM, SHAPE, APIC, 8, false>());
    });
  });
}

}    // namespace
#endif
