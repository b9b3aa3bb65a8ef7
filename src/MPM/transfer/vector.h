/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_VECTOR_H
#define MPM_TRANSFER_VECTOR_H

// Short vectors of reals on the vector extensions of GCC and Clang, for files that are compiled once
// for each instruction set. All names are local to the including file, and every function is
// inlined: no code made for one CPU can serve another. The reals are doubles, or floats in a file
// that defines MPM_MIXED_PRECISION before; both kinds of vectors exist everywhere.
//
// A vector that is wider than the registers is two halves. (GCC can split wide vectors itself, but
// its shuffles of them are slower than scalar code.)

#if defined(__AVX__)
#include <immintrin.h>
#endif
#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__)
#define MPM_VECTOR_512
#endif

#define MPM_INLINE inline __attribute__((always_inline))
#if defined(__clang__)
#define MPM_UNROLL _Pragma("unroll")
#else
#define MPM_UNROLL _Pragma("GCC unroll 8")
#endif

namespace {

#if defined(MPM_MIXED_PRECISION)
using Real = float;
#else
using Real = double;
#endif

/** Bytes of a vector register, and its reals. */
#if defined(MPM_VECTOR_512)
constexpr int REGISTER_BYTES = 64;
#elif defined(__AVX__)
constexpr int REGISTER_BYTES = 32;
#else
constexpr int REGISTER_BYTES = 16;
#endif
constexpr int REGISTER = REGISTER_BYTES / sizeof(Real);

template <int N, class T> constexpr bool fits()
{
  return N * sizeof(T) <= REGISTER_BYTES;
}

template <int N, class T> struct Raw;
template <> struct Raw<2, double> {
  typedef double Reals __attribute__((vector_size(16)));
  typedef int Ints __attribute__((vector_size(8)));
};
template <> struct Raw<4, double> {
  typedef double Reals __attribute__((vector_size(32)));
  typedef int Ints __attribute__((vector_size(16)));
};
template <> struct Raw<8, double> {
  typedef double Reals __attribute__((vector_size(64)));
  typedef int Ints __attribute__((vector_size(32)));
};
template <> struct Raw<4, float> {
  typedef float Reals __attribute__((vector_size(16)));
};
template <> struct Raw<8, float> {
  typedef float Reals __attribute__((vector_size(32)));
};
template <> struct Raw<16, float> {
  typedef float Reals __attribute__((vector_size(64)));
};

template <int N, class T = Real, bool FITS = fits<N, T>()> struct Vec;

/** N reals in one register. */
template <int N, class T> struct Vec<N, T, true> {
  using Reals = typename Raw<N, T>::Reals;
  Reals r;

  static MPM_INLINE Vec load(const T *p)
  {
    Vec a;
    __builtin_memcpy(&a.r, p, sizeof(Reals));
    return a;
  }
  MPM_INLINE void store(T *p) const { __builtin_memcpy(p, &r, sizeof(Reals)); }
  static MPM_INLINE Vec all(T s)
  {
    if constexpr (N == 2)
      return {Reals{s, s}};
    else if constexpr (N == 4)
      return {Reals{s, s, s, s}};
    else if constexpr (N == 8)
      return {Reals{s, s, s, s, s, s, s, s}};
    else
      return {Reals{s, s, s, s, s, s, s, s, s, s, s, s, s, s, s, s}};
  }
  MPM_INLINE T lane(int i) const { return r[i]; }
};

/** N reals as two halves. */
template <int N, class T> struct Vec<N, T, false> {
  Vec<N / 2, T> lo, hi;

  static MPM_INLINE Vec load(const T *p)
  {
    return {Vec<N / 2, T>::load(p), Vec<N / 2, T>::load(p + N / 2)};
  }
  MPM_INLINE void store(T *p) const
  {
    lo.store(p);
    hi.store(p + N / 2);
  }
  static MPM_INLINE Vec all(T s)
  {
    const Vec<N / 2, T> half = Vec<N / 2, T>::all(s);
    return {half, half};
  }
  MPM_INLINE T lane(int i) const { return i < N / 2 ? lo.lane(i) : hi.lane(i - N / 2); }
};

template <int N, class T> MPM_INLINE Vec<N, T> operator+(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (fits<N, T>())
    return {a.r + b.r};
  else
    return {a.lo + b.lo, a.hi + b.hi};
}
template <int N, class T> MPM_INLINE Vec<N, T> operator-(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (fits<N, T>())
    return {a.r - b.r};
  else
    return {a.lo - b.lo, a.hi - b.hi};
}
template <int N, class T> MPM_INLINE Vec<N, T> operator-(Vec<N, T> a)
{
  if constexpr (fits<N, T>())
    return {-a.r};
  else
    return {-a.lo, -a.hi};
}
template <int N, class T> MPM_INLINE Vec<N, T> operator*(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (fits<N, T>())
    return {a.r * b.r};
  else
    return {a.lo * b.lo, a.hi * b.hi};
}
template <int N, class T> MPM_INLINE Vec<N, T> operator/(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (fits<N, T>())
    return {a.r / b.r};
  else
    return {a.lo / b.lo, a.hi / b.hi};
}
template <int N, class T> MPM_INLINE Vec<N, T> operator+(double s, Vec<N, T> a)
{
  return Vec<N, T>::all(static_cast<T>(s)) + a;
}
template <int N, class T> MPM_INLINE Vec<N, T> operator-(double s, Vec<N, T> a)
{
  return Vec<N, T>::all(static_cast<T>(s)) - a;
}
template <int N, class T> MPM_INLINE Vec<N, T> operator*(double s, Vec<N, T> a)
{
  return Vec<N, T>::all(static_cast<T>(s)) * a;
}
template <int N, class T> MPM_INLINE Vec<N, T> operator+(Vec<N, T> a, double s)
{
  return a + Vec<N, T>::all(static_cast<T>(s));
}
template <int N, class T> MPM_INLINE Vec<N, T> operator-(Vec<N, T> a, double s)
{
  return a - Vec<N, T>::all(static_cast<T>(s));
}
template <int N, class T> MPM_INLINE Vec<N, T> operator*(Vec<N, T> a, double s)
{
  return a * Vec<N, T>::all(static_cast<T>(s));
}
template <int N, class T> MPM_INLINE void operator+=(Vec<N, T> &a, Vec<N, T> b)
{
  a = a + b;
}
template <int N, class T> MPM_INLINE void operator-=(Vec<N, T> &a, Vec<N, T> b)
{
  a = a - b;
}

template <int N, class T> MPM_INLINE Vec<N, T> min(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (fits<N, T>())
    return {a.r < b.r ? a.r : b.r};
  else
    return {min(a.lo, b.lo), min(a.hi, b.hi)};
}
template <int N, class T> MPM_INLINE Vec<N, T> max(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (fits<N, T>())
    return {a.r > b.r ? a.r : b.r};
  else
    return {max(a.lo, b.lo), max(a.hi, b.hi)};
}

/** flag, with 1 where a is not in [0,limit); not a number is never inside. */
template <int N, class T>
MPM_INLINE Vec<N, T> flag_outside(Vec<N, T> flag, Vec<N, T> a, double limit)
{
  if constexpr (fits<N, T>())
    return {((a.r >= T(0.0)) & (a.r < T(limit))) ? flag.r : Vec<N, T>::all(T(1.0)).r};
  else
    return {flag_outside(flag.lo, a.lo, limit), flag_outside(flag.hi, a.hi, limit)};
}

/** Cuts off the fraction; the whole numbers also go to index[N]. */
template <int N, class T> MPM_INLINE Vec<N, T> truncate(Vec<N, T> a, int *index)
{
  if constexpr (fits<N, T>()) {
    const auto whole = __builtin_convertvector(a.r, typename Raw<N, T>::Ints);
    __builtin_memcpy(index, &whole, sizeof(whole));
    return {__builtin_convertvector(whole, typename Raw<N, T>::Reals)};
  } else {
    return {truncate(a.lo, index), truncate(a.hi, index + N / 2)};
  }
}

/** Concatenation. */
template <int N, class T> MPM_INLINE Vec<2 * N, T> join(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (!fits<2 * N, T>())
    return {a, b};
  else if constexpr (N == 2)
    return {__builtin_shufflevector(a.r, b.r, 0, 1, 2, 3)};
  else if constexpr (N == 4)
    return {__builtin_shufflevector(a.r, b.r, 0, 1, 2, 3, 4, 5, 6, 7)};
  else
    return {
        __builtin_shufflevector(a.r, b.r, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)};
}

/** The same four reals in each group of four. */
template <int N, class T> MPM_INLINE Vec<N, T> repeat(Vec<4, T> four)
{
  if constexpr (N == 4) return four;
#if defined(MPM_VECTOR_512)
  else if constexpr (N == 16 && fits<N, T>())
    return {_mm512_maskz_broadcast_f32x4(0xffff,
                                         four.r)};    // GCC takes three instructions for a shuffle
#endif
  else
    return join(repeat<N / 2>(four), repeat<N / 2>(four));
}
template <int N> MPM_INLINE Vec<N> repeat(double a, double b, double c, double d)
{
  const Real four[4] = {static_cast<Real>(a), static_cast<Real>(b), static_cast<Real>(c),
                        static_cast<Real>(d)};
  return repeat<N>(Vec<4>::load(four));
}

/** First (H = 0) or second (H = 1) half. */
template <int H, int N, class T> MPM_INLINE Vec<N / 2, T> half(Vec<N, T> a)
{
  if constexpr (!fits<N, T>())
    return H ? a.hi : a.lo;
  else if constexpr (N == 4)
    return {__builtin_shufflevector(a.r, a.r, 2 * H, 2 * H + 1)};
  else if constexpr (N == 8)
    return {__builtin_shufflevector(a.r, a.r, 4 * H, 4 * H + 1, 4 * H + 2, 4 * H + 3)};
  else
    return {__builtin_shufflevector(a.r, a.r, 8 * H, 8 * H + 1, 8 * H + 2, 8 * H + 3, 8 * H + 4,
                                    8 * H + 5, 8 * H + 6, 8 * H + 7)};
}

/** Lanes I and J of the eight lanes of a and b. */
template <int I, int J, class T> MPM_INLINE Vec<2, T> pick(Vec<4, T> a, Vec<4, T> b)
{
  const Vec<2, T> u = half<(I >> 1) & 1>(I < 4 ? a : b);
  const Vec<2, T> w = half<(J >> 1) & 1>(J < 4 ? a : b);
  return {__builtin_shufflevector(u.r, w.r, I & 1, 2 + (J & 1))};
}

/** In each group of four lanes: lanes I, J, K, L of the eight lanes of a (0-3) and b (4-7). */
template <int I, int J, int K, int L, int N, class T>
MPM_INLINE Vec<N, T> shuffle(Vec<N, T> a, Vec<N, T> b)
{
  if constexpr (!fits<N, T>() && N > 4) {
    return {shuffle<I, J, K, L>(a.lo, b.lo), shuffle<I, J, K, L>(a.hi, b.hi)};
  } else if constexpr (!fits<N, T>()) {
    return {pick<I, J>(a, b), pick<K, L>(a, b)};
  } else if constexpr (N == 4) {
    return {__builtin_shufflevector(a.r, b.r, I, J, K, L)};
  } else {
    // b starts at lane N
    constexpr int i = I < 4 ? I : I + N - 4, j = J < 4 ? J : J + N - 4;
    constexpr int k = K < 4 ? K : K + N - 4, l = L < 4 ? L : L + N - 4;
    if constexpr (N == 8)
      return {__builtin_shufflevector(a.r, b.r, i, j, k, l, i + 4, j + 4, k + 4, l + 4)};
    else
      return {__builtin_shufflevector(a.r, b.r, i, j, k, l, i + 4, j + 4, k + 4, l + 4, i + 8,
                                      j + 8, k + 8, l + 8, i + 12, j + 12, k + 12, l + 12)};
  }
}

/** Lane I of each group of four in all lanes of the group. */
template <int I, int N, class T> MPM_INLINE Vec<N, T> broadcast(Vec<N, T> a)
{
  return shuffle<I, I, I, I>(a, a);
}

/** The first K lanes of each group of four from a, the others from b. */
template <int K, int N, class T> MPM_INLINE Vec<N, T> blend(Vec<N, T> a, Vec<N, T> b)
{
  return shuffle<0, 1, (K > 2 ? 2 : 6), 7>(a, b);
}

/** Stores the first K lanes. GCC 12 miscompiles stores of single lanes of a long vector in a row
 *  (SLP vectoriser), so pairs of lanes go out as vectors. */
template <int K, class T> MPM_INLINE void store_lanes(T *p, Vec<4, T> a)
{
  half<0>(a).store(p);
  if constexpr (K > 2) p[2] = a.lane(2);
}

/** Group G of a in all groups. */
template <int G, class T> MPM_INLINE Vec<16, T> repeat_group(Vec<16, T> a)
{
  constexpr int i = 4 * G, j = i + 1, k = i + 2, l = i + 3;
  if constexpr (fits<16, T>())
    return {__builtin_shufflevector(a.r, a.r, i, j, k, l, i, j, k, l, i, j, k, l, i, j, k, l)};
  else
    return repeat<16>(half<(G & 1)>(half<(G >> 1)>(a)));
}

/** Lane i (0 to 3) of group G in all lanes of group i. */
template <int G, class T> MPM_INLINE Vec<16, T> spread_group(Vec<16, T> a)
{
  constexpr int i = 4 * G, j = i + 1, k = i + 2, l = i + 3;
  if constexpr (fits<16, T>()) {
    return {__builtin_shufflevector(a.r, a.r, i, i, i, i, j, j, j, j, k, k, k, k, l, l, l, l)};
  } else {
    const Vec<4, T> four = half<(G & 1)>(half<(G >> 1)>(a));
    return join(join(broadcast<0>(four), broadcast<1>(four)),
                join(broadcast<2>(four), broadcast<3>(four)));
  }
}

/** Lane i (0 to 3) of four in all lanes of group i. */
template <int N, class T> MPM_INLINE Vec<N, T> spread(Vec<4, T> four)
{
  static_assert(N == 8 || N == 16);
#if defined(MPM_VECTOR_512)
  if constexpr (N == 16 && fits<16, T>())
    return spread_group<0>(Vec<16, T>{_mm512_castps128_ps512(four.r)});
#endif
  const Vec<8, T> low = join(broadcast<0>(four), broadcast<1>(four));
  if constexpr (N == 8)
    return low;
  else
    return join(low, join(broadcast<2>(four), broadcast<3>(four)));
}

/** The same numbers in the other precision. */
template <class U, int N, class T> MPM_INLINE Vec<N, U> convert(Vec<N, T> a)
{
  if constexpr (sizeof(U) == sizeof(T)) {
    return a;
#if defined(__AVX__)    // GCC converts floats two by two
  } else if constexpr (N == 4 && sizeof(T) == 4) {
    return {_mm256_cvtps_pd(a.r)};
#endif
#if defined(MPM_VECTOR_512)
  } else if constexpr (N == 8 && sizeof(T) == 4) {
    return {_mm512_maskz_cvtps_pd(0xff, a.r)};
#endif
  } else if constexpr (fits<N, U>() && fits<N, T>()) {
    return {__builtin_convertvector(a.r, typename Raw<N, U>::Reals)};
  } else if constexpr (N > 4) {
    return join(convert<U>(half<0>(a)), convert<U>(half<1>(a)));
  } else {
    U four[4];
    for (int i = 0; i < 4; i++) four[i] = static_cast<U>(a.lane(i));
    return Vec<4, U>::load(four);
  }
}

}    // namespace
#endif
