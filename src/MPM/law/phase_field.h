/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_PHASE_FIELD_H
#define MPM_LAW_PHASE_FIELD_H

#include "law/damage.h"

namespace MPM_NS::law {
namespace {

  /** Functions of a phase field d, which is 0 in sound material and 1 in a crack (J.-Y. Wu, J.
   *  Mech. Phys. Solids 103 (2017) 72). Cracks have the energy
   *
   *    GC/c0 integral of w(d)/l + l |grad d|^2,   w = xi d + (1 - xi) d^2,
   *
   *  and what is left of the stress is
   *
   *    g = (1 - d)^2 / [(1 - d)^2 + a d (1 - d/2)]
   *
   *  AT2 has xi = 0, AT1 xi = 1, both with a = 2, so that g = (1 - d)^2. Cohesive cracks have xi =
   *  2: the stress of a bar begins to drop at the strength, and drops linearly with the opening,
   *  whatever l is. */
  struct PhaseField {
    double xi, c0;

    static PhaseField at1() { return {1.0, 8.0 / 3.0}; }
    static PhaseField at2() { return {0.0, 2.0}; }
    static PhaseField cohesive() { return {2.0, 3.14159265358979323846}; }

    static constexpr double SQUARE = 2.0;    ///< a with which g = (1 - d)^2
    static constexpr double LEAST = 1.5;     ///< a from which on the stress only drops

    /** GC/(c0 l) of a lattice with spacing h. The energy of a crack has one part more, as all of a
     *  cell is broken: h w(1)/(c0 l) of GC. */
    MPM_INLINE double toughness(double GC, double l, double h) const { return GC / (c0 * l + h); }
    MPM_INLINE double slope(double d) const { return xi + 2.0 * (1.0 - xi) * d; }    ///< dw/dd
    MPM_INLINE double curvature() const { return 2.0 * (1.0 - xi); }
  };

  /** g with its derivatives. */
  struct Degradation {
    double value, slope, curvature;

    MPM_INLINE Degradation(double d, double a)
    {
      const double k = 1.0 - d, top = k * k, below = top + a * d * (1.0 - 0.5 * d);
      const double below1 = (a - 2.0) * k, inv = 1.0 / below;
      value = top * inv;
      slope = -(2.0 * k + value * below1) * inv;
      curvature = (2.0 - value * (2.0 - a) - 2.0 * slope * below1) * inv;
    }
  };

  /** Cracks by a phase field d, which fix mpm/phasefield finds. What drives it is the energy w per
   *  volume that damage may release (see ScalarDamage), as far as tension does.
   *
   *  For cohesive cracks, w_1 is w when the largest principal stress reaches the strength, and
   *  a = xi GC/(c0 l w_1): so d begins to grow at the strength in any state of stress, and the
   *  energy is GC. Both follow with the stress until d grows, and a does not fall then: a crack may
   *  come to a point while that is compressed, which knows nothing of its strength in tension. The
   *  driving energy is w, but not more than w_1 (sigma_1/strength)^2: what is stored in compression
   *  breaks nothing. With AT1 and AT2, it is w times the share of tension in the stress. */
  struct DamagePhaseField : ScalarDamage<DamagePhaseField> {
    static constexpr const char *name = "phasefield";
    static constexpr const char *meaning = "cracks by a phase field, with fix mpm/phasefield";
    enum { GC, LENGTH, STRENGTH_, IS_AT1, IS_AT2, AFTER };
    static constexpr Parameter parameters[] = {
        {"", "GC", "pressure*length", POSITIVE, REQUIRED, "fracture energy per area"},
        {"", "L", "length", POSITIVE, REQUIRED, "length of the phase field"},
        {"model cohesive", "SIGMA", "pressure", POSITIVE, 0.0, "tensile strength"},
        {"model at1", "AT1", FLAG, FRACTION, 0.0, "energy linear in the phase field"},
        {"model at2", "AT2", FLAG, FRACTION, 0.0, "energy quadratic in the phase field"},
        MPM_AFTER_PARAMETERS};
    static constexpr HistoryDeclaration history[] = {
        MPM_DAMAGE_HISTORY,
        {"phase", ZERO, "1", "phase field, 1: broken"},
        {"driving", ZERO, "pressure", "energy per volume that cracks may release"},
        {"toughness", ZERO, "pressure", "fracture energy per volume, GC/(c0 L)"},
        {"shape", ZERO, "1", "a of the share of stress that is left, of cohesive cracks"}};
    enum { PHASE = NDAMAGE, DRIVING, TOUGHNESS, SHAPE, NPHASE };
    static constexpr int nhistory(const LawParameters &p)
    {
      return p.value[STRENGTH_] > 0.0 ? NPHASE : SHAPE;
    }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[STRENGTH_] + p.value[IS_AT1] + p.value[IS_AT2] > 0.0
          ? nullptr
          : "it needs a model: add 'model cohesive SIGMA' with the tensile strength, 'model at1', "
            "or 'model at2'";
    }
    static PhaseField field(const LawParameters &p)
    {
      return p.value[IS_AT1] > 0.0 ? PhaseField::at1()
          : p.value[IS_AT2] > 0.0  ? PhaseField::at2()
                                   : PhaseField::cohesive();
    }

    /** (sigma_1/strength)^2 below which stress says nothing of a. */
    static constexpr double SMALL = 0.01;
    double inv_strength, toughness, twice;
    bool cohesive;

    DamagePhaseField(const LawParameters &p, const Batch &b) :
        toughness(field(p).toughness(p.value[GC], p.value[LENGTH], b.h)),
        cohesive(p.value[STRENGTH_] > 0.0)
    {
      inv_strength = cohesive ? 1.0 / p.value[STRENGTH_] : 0.0;
      twice = PhaseField::cohesive().xi * toughness;
    }

    /** Sum of the squares of principal stresses that are tension, over that of all. */
    static MPM_INLINE double share_of_tension(const Intact &intact)
    {
      const double first = largest_eigenvalue(intact.s);
      const double last = -largest_eigenvalue(-1.0 * intact.s);
      const double stress[3] = {intact.mean + first, intact.mean - first - last,
                                intact.mean + last};
      double tension = 0.0, all = 1e-300;
      for (const double one : stress) {
        tension += max(one, 0.0) * max(one, 0.0);
        all += one * one;
      }
      return tension / all;
    }

    MPM_INLINE double grow(const Batch &b, History history, int i, const Intact &intact) const
    {
      const double tension = max(b.volume_energy[i] - history[REST_ENERGY][i], 0.0);
      const double w = b.shear_energy[i] + (intact.mean > 0.0 ? tension : 0.0);
      const double largest = max(principal(intact), 0.0), d = history[PHASE][i];
      history[TOUGHNESS][i] = toughness;
      if (!cohesive) {
        history[DRIVING][i] = w * share_of_tension(intact);
        return 1.0 - Degradation(d, PhaseField::SQUARE).value;
      }
      const double r2 = largest * inv_strength * largest * inv_strength;
      const double old = max(history[SHAPE][i], PhaseField::LEAST);
      const double now = twice * r2 / max(w, 1e-300);
      const double a = r2 > SMALL && (now > old || !(d > 0.0)) ? max(now, PhaseField::LEAST) : old;
      history[SHAPE][i] = a;
      history[DRIVING][i] = min(w, twice * r2 / a);
      return 1.0 - Degradation(d, a).value;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
