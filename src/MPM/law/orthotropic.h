/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_ORTHOTROPIC_H
#define MPM_LAW_ORTHOTROPIC_H

#include "law/axes.h"
#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Elastic constants of a material with three orthogonal planes of symmetry. */
  struct Orthotropic {
    double E1, E2, E3, nu12, nu13, nu23, G12, G13, G23;

    /** Is the energy positive for any strain? (B.M. Lempriere, AIAA J. 6 (1968) 2226) */
    bool admissible() const
    {
      const double r12 = nu12 * nu12 * E2 / E1, r13 = nu13 * nu13 * E3 / E1;
      const double r23 = nu23 * nu23 * E3 / E2;
      return r12 < 1.0 && r13 < 1.0 && r23 < 1.0 &&
          1.0 - r12 - r13 - r23 - 2.0 * nu12 * nu13 * nu23 * E3 / E1 > 0.0;
    }
  };

  /** Axes of a material, [axis][component]. */
  struct MaterialAxes {
    double axis[3][3];
  };

  /** Anisotropic solid whose second Piola-Kirchhoff stress is linear in the Green-Lagrange strain
   *  (St. Venant-Kirchhoff):
   *
   *    w = E:C:E/2,  J sigma = F (C:E) F^T
   *
   *  The axes of the material, given in the reference configuration, rotate and stretch with it; a
   *  superposed rotation only rotates the stress. */
  struct AnisotropicKirchhoff {
    double C11, C22, C33, C12, C13, C23, G12, G13, G23;
    double to_axes[9], from_axes[9];    ///< row-major rotations of tensors into the axes and back

    /** axes: orthonormal. */
    AnisotropicKirchhoff(const Orthotropic &c, const MaterialAxes &axes) :
        G12(c.G12), G13(c.G13), G23(c.G23)
    {
      // inverse of the compliance
      const double s11 = 1.0 / c.E1, s22 = 1.0 / c.E2, s33 = 1.0 / c.E3;
      const double s12 = -c.nu12 * s11, s13 = -c.nu13 * s11, s23 = -c.nu23 * s22;
      const double det = s11 * (s22 * s33 - s23 * s23) - s12 * (s12 * s33 - s23 * s13) +
          s13 * (s12 * s23 - s22 * s13);
      C11 = (s22 * s33 - s23 * s23) / det;
      C22 = (s11 * s33 - s13 * s13) / det;
      C33 = (s11 * s22 - s12 * s12) / det;
      C12 = (s13 * s23 - s12 * s33) / det;
      C13 = (s12 * s23 - s13 * s22) / det;
      C23 = (s12 * s13 - s23 * s11) / det;
      for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++) from_axes[3 * k + a] = to_axes[3 * a + k] = axes.axis[a][k];
    }

    /** Second Piola-Kirchhoff stress in the axes of the material. */
    MPM_INLINE Sym stress(const Sym &e) const
    {
      return {C11 * e.xx + C12 * e.yy + C13 * e.zz,
              C12 * e.xx + C22 * e.yy + C23 * e.zz,
              C13 * e.xx + C23 * e.yy + C33 * e.zz,
              2.0 * G12 * e.xy,
              2.0 * G13 * e.xz,
              2.0 * G23 * e.yz};
    }

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const double F[9] = {b.F[0][i], b.F[1][i], b.F[2][i], b.F[3][i], b.F[4][i],
                           b.F[5][i], b.F[6][i], b.F[7][i], b.F[8][i]};
      const Sym e = congruence(to_axes, green_lagrange(displacement(b, i)));
      return congruence(F, congruence(from_axes, stress(e)));
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Sym e = congruence(to_axes, green_lagrange(displacement(b, i))), s = stress(e);
      return 0.5 * (s.xx * e.xx + s.yy * e.yy + s.zz * e.zz) + s.xy * e.xy + s.xz * e.xz +
          s.yz * e.yz;
    }

    /** Largest density_0 c^2 of small waves in the unstrained material, or a slightly larger value:
     *  exact if it belongs to a wave along an axis or if the material is isotropic. Derived as in
     *  largest_modulus(). */
    double stiffest() const
    {
      const double a = max(C11, max(C22, C33));
      const double b = max(G12 + std::fabs(C12 + G12),
                           max(G13 + std::fabs(C13 + G13), G23 + std::fabs(C23 + G23)));
      return max(a, b);
    }

    /** l tau + tau l^T + F (C : F^T l F) F^T. The last term has the form of a law in principal
     *  axes, with the axes of the material as deformed by F in their place. */
    static void add_tangent(const AnisotropicKirchhoff &law, const Batch &b, Tangent &t)
    {
      alignas(64) double tau[6][BATCH], axes[3][3][BATCH];
      FrameModuli moduli;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        store_rows(tau, i, b.J[i] * load_stress(b, i));
        moduli.A[0][i] = law.C11;
        moduli.A[1][i] = law.C22;
        moduli.A[2][i] = law.C33;
        moduli.A[3][i] = law.C12;
        moduli.A[4][i] = law.C13;
        moduli.A[5][i] = law.C23;
        moduli.m[0][i] = law.G12;
        moduli.m[1][i] = law.G13;
        moduli.m[2][i] = law.G23;
      }
      for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) {
          const double x = law.to_axes[3 * a], y = law.to_axes[3 * a + 1],
                       z = law.to_axes[3 * a + 2];
          MPM_SIMD
          for (int i = 0; i < b.n; i++)
            axes[k][a][i] = b.F[3 * k][i] * x + b.F[3 * k + 1][i] * y + b.F[3 * k + 2][i] * z;
        }
      add_convected(b.n, tau, t);
      add_frame_tangent(b.n, axes, moduli, t);
    }

    /** Bound of the modulus: with N = F^T n and M = F^T m for a wave with normal n and polarization
     *  m, J density c^2 = (M N):C:(M N) + n.tau.n. */
    static MPM_INLINE void bound(const AnisotropicKirchhoff &law, const Batch &b, double *k)
    {
      const double stiff = law.stiffest();
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double longest = largest_principal(left_cauchy_green(b, i));
        const double tension = largest_principal(b.J[i] * load_stress(b, i));
        k[i] += stiff * longest * longest + max(tension, 0.0);
      }
    }
  };

  /** Kernels of an anisotropic solid. Law provides:
   *    constants(parameters), its elastic constants
   *    axes(parameters), its axes
   */
  template <class Law> struct AnisotropicSolid : Hyperelastic<Law>, AnisotropicKirchhoff {
    explicit AnisotropicSolid(const LawParameters &p) :
        AnisotropicKirchhoff(Law::constants(p), Law::axes(p))
    {
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      bound(Law(p), b, k);
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      Law::update(p, b, history);
      add_tangent(Law(p), b, t);
    }
  };

  /** Orthotropic law with nine engineering constants. */
  struct LawOrthotropic : AnisotropicSolid<LawOrthotropic> {
    static constexpr const char *name = "orthotropic";
    static constexpr const char *meaning = "orthotropic elastic, linear in Green-Lagrange strain";
    static constexpr Parameter parameters[] = {
        {"", "E1", "pressure", POSITIVE, REQUIRED, "Young's modulus along axis 1"},
        {"", "E2", "pressure", POSITIVE, REQUIRED, "Young's modulus along axis 2"},
        {"", "E3", "pressure", POSITIVE, REQUIRED, "Young's modulus along axis 3"},
        {"", "NU12", "1", ANY_NUMBER, REQUIRED, "contraction along 2 under stress along 1"},
        {"", "NU13", "1", ANY_NUMBER, REQUIRED, "contraction along 3 under stress along 1"},
        {"", "NU23", "1", ANY_NUMBER, REQUIRED, "contraction along 3 under stress along 2"},
        {"", "G12", "pressure", POSITIVE, REQUIRED, "shear modulus in the plane 12"},
        {"", "G13", "pressure", POSITIVE, REQUIRED, "shear modulus in the plane 13"},
        {"", "G23", "pressure", POSITIVE, REQUIRED, "shear modulus in the plane 23"},
        MPM_AXES_PARAMETERS};

    using AnisotropicSolid::AnisotropicSolid;

    static MaterialAxes axes(const LawParameters &p)
    {
      MaterialAxes axes;
      orthonormal_axes(p.value + 9, p.value + 12, p.value[15], axes.axis);
      return axes;
    }

    static Orthotropic constants(const LawParameters &p)
    {
      const double *const v = p.value;
      return {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]};
    }

    static const char *check(const LawParameters &p)
    {
      if (const char *wrong = check_axes(p.value + 9, p.value + 12)) return wrong;
      if (!constants(p).admissible())
        return "the energy is not positive for all strains: check E1, E2, E3 and NU12, NU13, NU23";
      return nullptr;
    }
  };

  /** Law with the five constants of a material that has an axis of symmetry, such as the direction
   *  of fibers. */
  struct LawTransverselyIsotropic : AnisotropicSolid<LawTransverselyIsotropic> {
    static constexpr const char *name = "transversely/isotropic";
    static constexpr const char *meaning = "elastic with one axis, linear in Green-Lagrange strain";
    enum { EA, ET, NUA, NUT, GA, AXIS };
    static constexpr Parameter parameters[] = {
        {"", "EA", "pressure", POSITIVE, REQUIRED, "Young's modulus along the axis"},
        {"", "ET", "pressure", POSITIVE, REQUIRED, "Young's modulus across the axis"},
        {"", "NUA", "1", ANY_NUMBER, REQUIRED, "contraction across under stress along the axis"},
        {"", "NUT", "1", {-1.0, 1.0, false}, REQUIRED, "contraction across under stress across"},
        {"", "GA", "pressure", POSITIVE, REQUIRED, "shear modulus in planes through the axis"},
        {"axis", "AX", "1", ANY_NUMBER, 1.0, "axis, of any length"},
        {"axis", "AY", "1", ANY_NUMBER, 0.0, "axis"},
        {"axis", "AZ", "1", ANY_NUMBER, 0.0, "axis"}};

    using AnisotropicSolid::AnisotropicSolid;

    /** Axis 1 is the axis of symmetry; two further ones, from the coordinate axis that is most
     *  nearly normal to it. */
    static MaterialAxes axes(const LawParameters &p)
    {
      MaterialAxes axes;
      auto &axis = axes.axis;
      const double *const a = p.value + AXIS;
      const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
      for (int k = 0; k < 3; k++) axis[0][k] = a[k] / length;
      int far = 0;
      for (int k = 1; k < 3; k++)
        if (std::fabs(axis[0][k]) < std::fabs(axis[0][far])) far = k;
      const double along = axis[0][far], rest = std::sqrt(1.0 - along * along);
      for (int k = 0; k < 3; k++) axis[1][k] = ((k == far) - along * axis[0][k]) / rest;
      for (int k = 0; k < 3; k++) {
        const int m = (k + 1) % 3, n = (k + 2) % 3;
        axis[2][k] = axis[0][m] * axis[1][n] - axis[0][n] * axis[1][m];
      }
      return axes;
    }

    static Orthotropic constants(const LawParameters &p)
    {
      const double *const v = p.value;
      const double GT = v[ET] / (2.0 * (1.0 + v[NUT]));
      return {v[EA], v[ET], v[ET], v[NUA], v[NUA], v[NUT], v[GA], v[GA], GT};
    }

    static const char *check(const LawParameters &p)
    {
      const double *const a = p.value + AXIS;
      if (!(a[0] * a[0] + a[1] * a[1] + a[2] * a[2] > 0.0)) return "axis must not be zero";
      if (!constants(p).admissible())
        return "the energy is not positive for all strains: 1 - NUT must be above 2 NUA^2 ET/EA";
      return nullptr;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
