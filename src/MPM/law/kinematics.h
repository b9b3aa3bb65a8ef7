/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_KINEMATICS_H
#define MPM_LAW_KINEMATICS_H

// Strain increment and rotation of a step, and small tensor functions that the laws share.
// Formulas are written out by component, because the compiler then vectorizes them over the batch.

#include "law/math.h"

namespace MPM_NS::law {
namespace {

  /** Symmetric tensor; strains have tensor components (xy is half the engineering shear strain). */
  struct Sym {
    double xx, yy, zz, xy, xz, yz;
  };

  MPM_INLINE Sym operator+(const Sym &a, const Sym &b)
  {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }

  MPM_INLINE Sym operator*(double s, const Sym &a)
  {
    return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
  }

  MPM_INLINE double trace(const Sym &a)
  {
    return a.xx + a.yy + a.zz;
  }

  /** a + d I */
  MPM_INLINE Sym add_diagonal(const Sym &a, double d)
  {
    return {a.xx + d, a.yy + d, a.zz + d, a.xy, a.xz, a.yz};
  }

  /** a - tr(a)/3 I */
  MPM_INLINE Sym deviator(const Sym &a)
  {
    return add_diagonal(a, -(1.0 / 3.0) * trace(a));
  }

  /** a:a */
  MPM_INLINE double norm2(const Sym &a)
  {
    return a.xx * a.xx + a.yy * a.yy + a.zz * a.zz +
        2.0 * (a.xy * a.xy + a.xz * a.xz + a.yz * a.yz);
  }

  /** a:b */
  MPM_INLINE double contract(const Sym &a, const Sym &b)
  {
    return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz +
        2.0 * (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
  }

  /** Von Mises equivalent sqrt(3/2 s:s) of a deviator. */
  MPM_INLINE double equivalent(const Sym &s)
  {
    return std::sqrt(1.5 * norm2(s));
  }

  /** Second invariant: sum of the principal minors. */
  MPM_INLINE double minors(const Sym &a)
  {
    return (a.xx * a.yy - a.xy * a.xy) + (a.xx * a.zz - a.xz * a.xz) + (a.yy * a.zz - a.yz * a.yz);
  }

  MPM_INLINE double determinant(const Sym &a)
  {
    return a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.xz) +
        a.xz * (a.xy * a.yz - a.yy * a.xz);
  }

  /** Tensor of point i from six rows [component][point]. */
  MPM_INLINE Sym load_rows(const double (*rows)[BATCH], int i)
  {
    return {rows[0][i], rows[1][i], rows[2][i], rows[3][i], rows[4][i], rows[5][i]};
  }

  /** Stores the tensor of point i in six rows [component][point]. */
  MPM_INLINE void store_rows(History rows, int i, const Sym &s)
  {
    rows[0][i] = s.xx;
    rows[1][i] = s.yy;
    rows[2][i] = s.zz;
    rows[3][i] = s.xy;
    rows[4][i] = s.xz;
    rows[5][i] = s.yz;
  }

  MPM_INLINE Sym load_stress(const Batch &b, int i)
  {
    return load_rows(b.stress, i);
  }

  MPM_INLINE void store_stress(Batch &b, int i, const Sym &s)
  {
    store_rows(b.stress, i, s);
  }

  /** Subtracts a pressure, positive in compression, from the stress of point i. */
  MPM_INLINE void subtract_pressure(Batch &b, int i, double p)
  {
    b.stress[0][i] -= p;
    b.stress[1][i] -= p;
    b.stress[2][i] -= p;
  }

  /** Bulk and shear modulus of a law whose first two parameters are Young's modulus and Poisson's
   *  ratio. */
  struct BulkAndShear {
    double K, G;
    explicit BulkAndShear(const LawParameters &p) :
        K(p.value[0] / (3.0 * (1.0 - 2.0 * p.value[1]))), G(p.value[0] / (2.0 * (1.0 + p.value[1])))
    {
    }
  };
  /** Lame constants of a law whose first two parameters are Young's modulus and Poisson's ratio. */
  struct LameModuli {
    double mu, lambda;
    explicit LameModuli(const LawParameters &p) :
        mu(p.value[0] / (2.0 * (1.0 + p.value[1]))),
        lambda(p.value[0] * p.value[1] / ((1.0 + p.value[1]) * (1.0 - 2.0 * p.value[1])))
    {
    }
  };

  /** Motion at the middle of the step: G = dt * velocity gradient with respect to the configuration
   *  half-way. */
  struct Increment {
    Sym strain;           ///< symmetric part of G
    double wx, wy, wz;    ///< axial vector of the skew part of G
  };

  /** G = A (I + A/2)^-1. With B = A/2, (I + B)^-1 B = [(1 + tr B) B - B^2 + det B I] / det(I + B)
   *  (theorem of Cayley and Hamilton), which keeps full relative precision for small A. */
  MPM_INLINE Increment increment(const Batch &b, int i)
  {
    const double a = 0.5 * b.A[0][i], c = 0.5 * b.A[1][i], d = 0.5 * b.A[2][i];
    const double e = 0.5 * b.A[3][i], f = 0.5 * b.A[4][i], g = 0.5 * b.A[5][i];
    const double h = 0.5 * b.A[6][i], k = 0.5 * b.A[7][i], l = 0.5 * b.A[8][i];
    const double tr = a + f + l;
    const double det = a * (f * l - g * k) - c * (e * l - g * h) + d * (e * k - f * h);
    const double minors = (a * f - c * e) + (a * l - d * h) + (f * l - g * k);
    const double q = 1.0 / (1.0 + tr + minors + det);
    const double t = 1.0 + tr;
    // rows of (1 + tr B) B - B^2
    const double xx = t * a - (a * a + c * e + d * h), xy = t * c - (a * c + c * f + d * k);
    const double xz = t * d - (a * d + c * g + d * l), yx = t * e - (e * a + f * e + g * h);
    const double yy = t * f - (e * c + f * f + g * k), yz = t * g - (e * d + f * g + g * l);
    const double zx = t * h - (h * a + k * e + l * h), zy = t * k - (h * c + k * f + l * k);
    const double zz = t * l - (h * d + k * g + l * l);
    return {{2.0 * q * (xx + det), 2.0 * q * (yy + det), 2.0 * q * (zz + det), q * (xy + yx),
             q * (xz + zx), q * (yz + zy)},
            q * (zy - yz),
            q * (xz - zx),
            q * (yx - xy)};
  }

  /** Displacement gradient H. */
  struct Displacement {
    double xx, xy, xz, yx, yy, yz, zx, zy, zz;

    MPM_INLINE double minors() const
    {
      return (xx * yy - xy * yx) + (xx * zz - xz * zx) + (yy * zz - yz * zy);
    }
    MPM_INLINE double determinant() const
    {
      return xx * (yy * zz - yz * zy) - xy * (yx * zz - yz * zx) + xz * (yx * zy - yy * zx);
    }
  };

  /** H = F - I of a point. */
  MPM_INLINE Displacement displacement(const Batch &b, int i)
  {
    return {b.F[0][i] - 1.0, b.F[1][i], b.F[2][i], b.F[3][i],      b.F[4][i] - 1.0,
            b.F[5][i],       b.F[6][i], b.F[7][i], b.F[8][i] - 1.0};
  }

  MPM_INLINE Displacement step_displacement(const Batch &b, int i)
  {
    return {b.A[0][i], b.A[1][i], b.A[2][i], b.A[3][i], b.A[4][i],
            b.A[5][i], b.A[6][i], b.A[7][i], b.A[8][i]};
  }

  /** b - I = H + H^T + H H^T, which keeps full relative precision for small strains. */
  MPM_INLINE Sym left_strain(const Displacement &H)
  {
    return {2.0 * H.xx + H.xx * H.xx + H.xy * H.xy + H.xz * H.xz,
            2.0 * H.yy + H.yx * H.yx + H.yy * H.yy + H.yz * H.yz,
            2.0 * H.zz + H.zx * H.zx + H.zy * H.zy + H.zz * H.zz,
            H.xy + H.yx + H.xx * H.yx + H.xy * H.yy + H.xz * H.yz,
            H.xz + H.zx + H.xx * H.zx + H.xy * H.zy + H.xz * H.zz,
            H.yz + H.zy + H.yx * H.zx + H.yy * H.zy + H.yz * H.zz};
  }

  MPM_INLINE Sym green_lagrange(const Displacement &H)
  {
    return 0.5 * left_strain({H.xx, H.yx, H.zx, H.xy, H.yy, H.zy, H.xz, H.yz, H.zz});
  }

  /** ln J, computed from J - 1 = tr H + minors + det H to keep precision near J = 1. */
  MPM_INLINE double log_volume(const Displacement &H)
  {
    return log1p(H.xx + H.yy + H.zz + (H.minors() + H.determinant()));
  }

  /** M s M^T with a row-major matrix M. */
  MPM_INLINE Sym congruence(const double *M, const Sym &s)
  {
    const double txx = M[0] * s.xx + M[1] * s.xy + M[2] * s.xz;
    const double txy = M[0] * s.xy + M[1] * s.yy + M[2] * s.yz;
    const double txz = M[0] * s.xz + M[1] * s.yz + M[2] * s.zz;
    const double tyx = M[3] * s.xx + M[4] * s.xy + M[5] * s.xz;
    const double tyy = M[3] * s.xy + M[4] * s.yy + M[5] * s.yz;
    const double tyz = M[3] * s.xz + M[4] * s.yz + M[5] * s.zz;
    const double tzx = M[6] * s.xx + M[7] * s.xy + M[8] * s.xz;
    const double tzy = M[6] * s.xy + M[7] * s.yy + M[8] * s.yz;
    const double tzz = M[6] * s.xz + M[7] * s.yz + M[8] * s.zz;
    return {txx * M[0] + txy * M[1] + txz * M[2], tyx * M[3] + tyy * M[4] + tyz * M[5],
            tzx * M[6] + tzy * M[7] + tzz * M[8], txx * M[3] + txy * M[4] + txz * M[5],
            txx * M[6] + txy * M[7] + txz * M[8], tyx * M[6] + tyy * M[7] + tyz * M[8]};
  }

  /** Incremental rotation Q = (I - W/2)^-1 (I + W/2), row-major
   *  (T.J.R. Hughes, J. Winget, Int. J. Numer. Meth. Eng. 15 (1980) 1862). */
  struct Rotation {
    double Q[9];

    MPM_INLINE explicit Rotation(const Increment &inc)
    {
      const double x = inc.wx, y = inc.wy, z = inc.wz;
      const double w2 = x * x + y * y + z * z;
      const double c = 1.0 / (1.0 + 0.25 * w2), h = 0.5 * c, d = 1.0 - h * w2;
      Q[0] = d + h * x * x;
      Q[1] = h * x * y - c * z;
      Q[2] = h * x * z + c * y;
      Q[3] = h * x * y + c * z;
      Q[4] = d + h * y * y;
      Q[5] = h * y * z - c * x;
      Q[6] = h * x * z - c * y;
      Q[7] = h * y * z + c * x;
      Q[8] = d + h * z * z;
    }
  };

  /** Q s Q^T with the incremental rotation Q. */
  MPM_INLINE Sym rotate(const Increment &inc, const Sym &s)
  {
    return congruence(Rotation(inc).Q, s);
  }

  /** Jaumann rate over one step: Q (old + rate/2) Q^T + rate/2, where rate is the increment in the
   *  axes of the middle of the step. The result is exact for pure rotation and of second order in
   *  general. The form Q old Q^T + rate of Hughes and Winget is only of first order when strain and
   *  rotation occur together. */
  MPM_INLINE Sym jaumann(const Increment &inc, const Sym &old, const Sym &rate)
  {
    const Sym half = 0.5 * rate;
    return rotate(inc, old + half) + half;
  }

  MPM_INLINE Sym left_cauchy_green(const Batch &b, int i)
  {
    const double xx = b.F[0][i], xy = b.F[1][i], xz = b.F[2][i];
    const double yx = b.F[3][i], yy = b.F[4][i], yz = b.F[5][i];
    const double zx = b.F[6][i], zy = b.F[7][i], zz = b.F[8][i];
    return {xx * xx + xy * xy + xz * xz, yx * yx + yy * yy + yz * yz, zx * zx + zy * zy + zz * zz,
            xx * yx + xy * yy + xz * yz, xx * zx + xy * zy + xz * zz, yx * zx + yy * zy + yz * zz};
  }

  MPM_INLINE Sym square(const Sym &a)
  {
    return {a.xx * a.xx + a.xy * a.xy + a.xz * a.xz, a.xy * a.xy + a.yy * a.yy + a.yz * a.yz,
            a.xz * a.xz + a.yz * a.yz + a.zz * a.zz, a.xx * a.xy + a.xy * a.yy + a.xz * a.yz,
            a.xx * a.xz + a.xy * a.yz + a.xz * a.zz, a.xy * a.xz + a.yy * a.yz + a.yz * a.zz};
  }

  /** Eigenvalues of a deviator: the one of largest magnitude (first) and half the difference of the
   *  two others (half). They are exact to round-off, half to 1e-8 of the norm where it vanishes.
   *  With r = sqrt(d:d/6), the scaled eigenvalues solve t^3 - 3 t - 2 c = 0 with c = det(d)/(2
   *  r^3). The root of largest magnitude comes from Newton steps; the others follow from a
   *  quadratic equation. */
  struct DeviatorRoots {
    double first, half;

    MPM_INLINE explicit DeviatorRoots(const Sym &d)
    {
      const double r = std::sqrt((1.0 / 6.0) * norm2(d)), r3 = r * r * r;
      const double det = determinant(d);
      const double c = max(-1.0, min(1.0, r3 > 0.0 ? 0.5 * det / r3 : 0.0));
      const double a = c < 0.0 ? -c : c;
      double t = std::sqrt(3.0 + a);
      for (int it = 0; it < 3; it++) t -= (t * (t * t - 3.0) - 2.0 * a) / (3.0 * (t * t - 1.0));
      first = c < 0.0 ? -r * t : r * t;
      half = 0.5 * r * std::sqrt(max(12.0 - 3.0 * t * t, 0.0));
    }
  };

  MPM_INLINE double largest_eigenvalue(const Sym &d)
  {
    const DeviatorRoots root(d);
    return root.first < 0.0 ? root.half - 0.5 * root.first : root.first;
  }

  MPM_INLINE double largest_principal(const Sym &a)
  {
    return (1.0 / 3.0) * trace(a) + largest_eigenvalue(deviator(a));
  }

  /** Lower limit of density_0 (wave speed)^2, relative to its value at rest. Far from rest,
   *  tangents may be zero or negative (there are no waves then), but the time step must stay
   *  finite. */
  constexpr double LEAST_MODULUS = 0.01;

  /** Upper bound of the largest eigenvalue of a deviator; exact if the other two are equal. */
  MPM_INLINE double eigenvalue_bound(const Sym &dev)
  {
    return std::sqrt((2.0 / 3.0) * norm2(dev));
  }

}    // namespace
}    // namespace MPM_NS::law
#endif
