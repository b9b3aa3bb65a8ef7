/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_VECTOR_H
#define MPM_TRANSFER_VECTOR_H

// Short vectors of doubles on the vector extensions of GCC and Clang, for files that are compiled
// once for each instruction set. All names are local to the including file, and every function is
// inlined: no code made for one CPU can serve another.
//
// A vector that is wider than the registers is two halves. (GCC can split wide vectors itself, but
// its shuffles of them are slower than scalar code.)

#define MPM_INLINE inline __attribute__((always_inline))
#if defined(__clang__)
#define MPM_UNROLL _Pragma("unroll")
#else
#define MPM_UNROLL _Pragma("GCC unroll 8")
#endif

namespace {

/** Doubles of a vector register. */
#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__)
constexpr int REGISTER = 8;
#elif defined(__AVX__)
constexpr int REGISTER = 4;
#else
constexpr int REGISTER = 2;
#endif

template <int N> constexpr bool fits = N <= REGISTER;

template <int N> struct Raw {
  typedef double Reals __attribute__((vector_size(8 * N)));
  typedef int Ints __attribute__((vector_size(4 * N)));
  typedef float Floats __attribute__((vector_size(4 * N)));
};

template <int N, bool FITS = fits<N>> struct Vec;

/** N reals in one register. */
template <int N> struct Vec<N, true> {
  using Reals = typename Raw<N>::Reals;
  Reals r;

  static MPM_INLINE Vec load(const double *p)
  {
    Vec a;
    __builtin_memcpy(&a.r, p, sizeof(Reals));
    return a;
  }
  static MPM_INLINE Vec load(const float *p)
  {
    typename Raw<N>::Floats a;
    __builtin_memcpy(&a, p, sizeof(a));
    return {__builtin_convertvector(a, Reals)};
  }
  MPM_INLINE void store(double *p) const { __builtin_memcpy(p, &r, sizeof(Reals)); }
  static MPM_INLINE Vec all(double s)
  {
    if constexpr (N == 2)
      return {Reals{s, s}};
    else if constexpr (N == 4)
      return {Reals{s, s, s, s}};
    else
      return {Reals{s, s, s, s, s, s, s, s}};
  }
  MPM_INLINE double lane(int i) const { return r[i]; }
};

/** N reals as two halves. */
template <int N> struct Vec<N, false> {
  Vec<N / 2> lo, hi;

  static MPM_INLINE Vec load(const double *p)
  {
    return {Vec<N / 2>::load(p), Vec<N / 2>::load(p + N / 2)};
  }
  static MPM_INLINE Vec load(const float *p)
  {
    return {Vec<N / 2>::load(p), Vec<N / 2>::load(p + N / 2)};
  }
  MPM_INLINE void store(double *p) const
  {
    lo.store(p);
    hi.store(p + N / 2);
  }
  static MPM_INLINE Vec all(double s)
  {
    const Vec<N / 2> half = Vec<N / 2>::all(s);
    return {half, half};
  }
  MPM_INLINE double lane(int i) const { return i < N / 2 ? lo.lane(i) : hi.lane(i - N / 2); }
};

/** An operator lane by lane, for two vectors or a vector and a number. */
#define MPM_LANEWISE(op)                                               \
  template <int N> MPM_INLINE Vec<N> operator op(Vec<N> a, Vec<N> b)   \
  {                                                                    \
    if constexpr (fits<N>)                                             \
      return {a.r op b.r};                                             \
    else                                                               \
      return {a.lo op b.lo, a.hi op b.hi};                             \
  }                                                                    \
  template <int N> MPM_INLINE Vec<N> operator op(double s, Vec<N> a)   \
  {                                                                    \
    return Vec<N>::all(s) op a;                                        \
  }                                                                    \
  template <int N> MPM_INLINE Vec<N> operator op(Vec<N> a, double s)   \
  {                                                                    \
    return a op Vec<N>::all(s);                                        \
  }                                                                    \
  template <int N> MPM_INLINE void operator op##=(Vec<N> &a, Vec<N> b) \
  {                                                                    \
    a = a op b;                                                        \
  }
MPM_LANEWISE(+)
MPM_LANEWISE(-)
MPM_LANEWISE(*)
MPM_LANEWISE(/)
#undef MPM_LANEWISE

template <int N> MPM_INLINE Vec<N> operator-(Vec<N> a)
{
  if constexpr (fits<N>)
    return {-a.r};
  else
    return {-a.lo, -a.hi};
}
template <int N> MPM_INLINE Vec<N> min(Vec<N> a, Vec<N> b)
{
  if constexpr (fits<N>)
    return {a.r < b.r ? a.r : b.r};
  else
    return {min(a.lo, b.lo), min(a.hi, b.hi)};
}
template <int N> MPM_INLINE Vec<N> max(Vec<N> a, Vec<N> b)
{
  if constexpr (fits<N>)
    return {a.r > b.r ? a.r : b.r};
  else
    return {max(a.lo, b.lo), max(a.hi, b.hi)};
}

/** flag, with 1 where a is not in [0,limit); not a number is never inside. */
template <int N> MPM_INLINE Vec<N> flag_outside(Vec<N> flag, Vec<N> a, double limit)
{
  if constexpr (fits<N>)
    return {((a.r >= 0.0) & (a.r < limit)) ? flag.r : Vec<N>::all(1.0).r};
  else
    return {flag_outside(flag.lo, a.lo, limit), flag_outside(flag.hi, a.hi, limit)};
}

/** Cuts off the fraction; the whole numbers also go to index[N]. */
template <int N> MPM_INLINE Vec<N> truncate(Vec<N> a, int *index)
{
  if constexpr (fits<N>) {
    const auto whole = __builtin_convertvector(a.r, typename Raw<N>::Ints);
    __builtin_memcpy(index, &whole, sizeof(whole));
    return {__builtin_convertvector(whole, typename Raw<N>::Reals)};
  } else {
    return {truncate(a.lo, index), truncate(a.hi, index + N / 2)};
  }
}

/** Concatenation. */
template <int N> MPM_INLINE Vec<2 * N> join(Vec<N> a, Vec<N> b)
{
  if constexpr (!fits<2 * N>)
    return {a, b};
  else if constexpr (N == 2)
    return {__builtin_shufflevector(a.r, b.r, 0, 1, 2, 3)};
  else
    return {__builtin_shufflevector(a.r, b.r, 0, 1, 2, 3, 4, 5, 6, 7)};
}

/** Four reals in a vector. */
MPM_INLINE Vec<4> quad(double a, double b, double c, double d)
{
  return join(Vec<2>{Raw<2>::Reals{a, b}}, Vec<2>{Raw<2>::Reals{c, d}});
}

/** The same four reals in each group of four. */
template <int N> MPM_INLINE Vec<N> repeat(Vec<4> four)
{
  if constexpr (N == 4)
    return four;
  else
    return join(repeat<N / 2>(four), repeat<N / 2>(four));
}

/** First (H = 0) or second (H = 1) half. */
template <int H, int N> MPM_INLINE Vec<N / 2> half(Vec<N> a)
{
  if constexpr (!fits<N>)
    return H ? a.hi : a.lo;
  else if constexpr (N == 4)
    return {__builtin_shufflevector(a.r, a.r, 2 * H, 2 * H + 1)};
  else
    return {__builtin_shufflevector(a.r, a.r, 4 * H, 4 * H + 1, 4 * H + 2, 4 * H + 3)};
}

/** Lanes I and J of the eight lanes of a and b. */
template <int I, int J> MPM_INLINE Vec<2> pick(Vec<4> a, Vec<4> b)
{
  const Vec<2> u = half<(I >> 1) & 1>(I < 4 ? a : b);
  const Vec<2> w = half<(J >> 1) & 1>(J < 4 ? a : b);
  return {__builtin_shufflevector(u.r, w.r, I & 1, 2 + (J & 1))};
}

/** In each group of four lanes: lanes I, J, K, L of the eight lanes of a (0-3) and b (4-7). */
template <int I, int J, int K, int L, int N> MPM_INLINE Vec<N> shuffle(Vec<N> a, Vec<N> b)
{
  if constexpr (!fits<N> && N > 4) {
    return {shuffle<I, J, K, L>(a.lo, b.lo), shuffle<I, J, K, L>(a.hi, b.hi)};
  } else if constexpr (!fits<N>) {
    return {pick<I, J>(a, b), pick<K, L>(a, b)};
  } else if constexpr (N == 4) {
    return {__builtin_shufflevector(a.r, b.r, I, J, K, L)};
  } else {
    // b starts at lane N
    constexpr int i = I < 4 ? I : I + N - 4, j = J < 4 ? J : J + N - 4;
    constexpr int k = K < 4 ? K : K + N - 4, l = L < 4 ? L : L + N - 4;
    return {__builtin_shufflevector(a.r, b.r, i, j, k, l, i + 4, j + 4, k + 4, l + 4)};
  }
}

/** Lane I of each group of four in all lanes of the group. */
template <int I, int N> MPM_INLINE Vec<N> broadcast(Vec<N> a)
{
  return shuffle<I, I, I, I>(a, a);
}

/** The first K lanes of each group of four from a, the others from b. */
template <int K, int N> MPM_INLINE Vec<N> blend(Vec<N> a, Vec<N> b)
{
  return shuffle<0, 1, (K > 2 ? 2 : 6), 7>(a, b);
}

/** Transposes the 4x4 lanes of each group of four lanes. */
template <int N> MPM_INLINE void transpose(Vec<N> *a)
{
  const Vec<N> ab0 = shuffle<0, 4, 2, 6>(a[0], a[1]), ab1 = shuffle<1, 5, 3, 7>(a[0], a[1]);
  const Vec<N> cd0 = shuffle<0, 4, 2, 6>(a[2], a[3]), cd1 = shuffle<1, 5, 3, 7>(a[2], a[3]);
  a[0] = shuffle<0, 1, 4, 5>(ab0, cd0);
  a[1] = shuffle<0, 1, 4, 5>(ab1, cd1);
  a[2] = shuffle<2, 3, 6, 7>(ab0, cd0);
  a[3] = shuffle<2, 3, 6, 7>(ab1, cd1);
}

/** Stores four numbers of each of the points side by side as rows of four. */
template <int N> MPM_INLINE void store_as_rows(const Vec<N> (&numbers)[4], double *rows)
{
  if constexpr (N == 2) {
    for (int l = 0; l < 2; l++)
      quad(numbers[0].lane(l), numbers[1].lane(l), numbers[2].lane(l), numbers[3].lane(l))
          .store(rows + 4 * l);
  } else {
    Vec<N> row[4] = {numbers[0], numbers[1], numbers[2], numbers[3]};
    transpose(row);
    MPM_UNROLL
    for (int l = 0; l < 4; l++) {
      if constexpr (N == 4) {
        row[l].store(rows + 4 * l);
      } else {
        half<0>(row[l]).store(rows + 4 * l);
        half<1>(row[l]).store(rows + 4 * (l + 4));
      }
    }
  }
}

/** Stores the first K lanes. GCC 12 miscompiles stores of single lanes of a long vector in a row
 *  (SLP vectorizer), so pairs of lanes go out as vectors. */
template <int K> MPM_INLINE void store_lanes(double *p, Vec<4> a)
{
  half<0>(a).store(p);
  if constexpr (K > 2) p[2] = a.lane(2);
}

}    // namespace
#endif
