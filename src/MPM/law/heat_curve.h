/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_HEAT_CURVE_H
#define MPM_LAW_HEAT_CURVE_H

// Enthalpy of a material whose specific heat depends on temperature or that melts over a range of
// temperatures.

#include "law/law.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace MPM_NS::law {
namespace {

  /** Enthalpy per mass as a function H(T) of temperature. Between knots the specific heat is linear
   *  in T; it is constant before the first and after the last knot. (A specific heat given by a
   *  formula jumps at knots so that the heat from each knot to the next is exact.) The knots are
   *  the terms {T, specific heat, its slope, H} of the parameters of a thermal part. Where melting
   *  occurs at one temperature, a knot with zero specific heat marks the end of the solid, and the
   *  next knot, at the same temperature, the beginning of the melt.
   *
   *  A point has a temperature and a molten fraction f. Heat changes H, and both follow from H: no
   *  heat is lost, however long the step. */
  struct HeatCurve {
    enum { TEMPERATURE, CAPACITY, SLOPE, ENTHALPY };

    const LawParameters &p;
    double melt, latent, over;

    /** Creates the knots of a specific heat c(T) that is constant outside the temperatures T.
     *  Between two of them it is replaced by a straight line that starts at begin(T1, T2) and rises
     *  as much as c does. melt, latent, over: melting temperature, heat of fusion (0: none), and
     *  range of melting (0: one temperature). */
    template <class Capacity, class Begin>
    static void make(LawParameters &p, std::vector<double> T, const Capacity &c, const Begin &begin,
                     double melt, double latent, double over)
    {
      if (latent > 0.0) {
        T.push_back(melt);
        if (over > 0.0) T.push_back(melt + over);
      }
      std::sort(T.begin(), T.end());
      T.erase(std::unique(T.begin(), T.end()), T.end());
      p.curved = true;
      p.nterms = 0;
      double H = 0.0;
      const auto add = [&](double t, double capacity, double slope) {
        double *const knot = p.term[p.nterms++];
        knot[TEMPERATURE] = t;
        knot[CAPACITY] = capacity;
        knot[SLOPE] = slope;
        knot[ENTHALPY] = H;
      };
      const double before = T.front() - 1.0;
      add(before, c(before), 0.0);
      H += c(before);
      for (std::size_t k = 0; k < T.size(); k++) {
        if (latent > 0.0 && over == 0.0 && T[k] == melt) {
          add(melt, 0.0, 0.0);
          H += latent;
        }
        const bool last = k + 1 == T.size();
        const double width = last ? 1.0 : T[k + 1] - T[k];
        const double slope = last ? 0.0 : (c(T[k + 1]) - c(T[k])) / width;
        const bool melting = over > 0.0 && T[k] >= melt && T[k] < melt + over;
        const double first = last ? c(T[k]) : begin(T[k], T[k + 1]);
        const double capacity = first + (latent > 0.0 && melting ? latent / over : 0.0);
        add(T[k], capacity, slope);
        H += width * (capacity + 0.5 * slope * width);
      }
    }
    /** Largest number of knots that make() adds to those of a table. */
    static constexpr int MORE = 4;

    /** The last knot at or below a temperature, or the first one. */
    MPM_INLINE const double *below(double T) const
    {
      int k = 0;
      while (k + 1 < p.nterms && T >= p.term[k + 1][TEMPERATURE]) k++;
      return p.term[k];
    }
    /** Molten fraction in equilibrium; 1 at the melting temperature if there is no range of
     *  melting. */
    MPM_INLINE double molten_at(double T) const
    {
      if (!(latent > 0.0)) return 0.0;
      if (over == 0.0) return T < melt ? 0.0 : 1.0;
      const double f = (T - melt) / over;
      return f < 0.0 ? 0.0 : (f > 1.0 ? 1.0 : f);
    }
    MPM_INLINE double enthalpy(double T, double molten) const
    {
      const double *const k = below(T), d = T - k[TEMPERATURE];
      const double slope = d < 0.0 ? 0.0 : k[SLOPE];
      return k[ENTHALPY] + d * (k[CAPACITY] + 0.5 * slope * d) + latent * (molten - molten_at(T));
    }
    /** Specific heat without the heat of fusion. If that were included, points that begin to melt
     *  within a step would take heat from the nodes too late, and the error of a melting front
     *  would be eight times as large. */
    MPM_INLINE double capacity(double T) const
    {
      const double *const k = below(T), d = T - k[TEMPERATURE];
      const bool melting = over > 0.0 && T >= melt && T < melt + over;
      return k[CAPACITY] + (d < 0.0 ? 0.0 : k[SLOPE] * d) - (melting ? latent / over : 0.0);
    }
    /** Adds heat per mass to a point: updates its temperature T and its molten fraction (null if
     *  the material does not melt). */
    MPM_INLINE void warm(double heat, double &T, double *molten) const
    {
      const double H = enthalpy(T, molten ? *molten : 0.0) + heat;
      int n = 0;
      while (n + 1 < p.nterms && H >= p.term[n + 1][ENTHALPY]) n++;
      const double *const k = p.term[n], rest = H - k[ENTHALPY];
      if (k[CAPACITY] == 0.0) {
        T = k[TEMPERATURE];
        *molten = rest / latent;
        return;
      }
      const double slope = rest < 0.0 ? 0.0 : k[SLOPE];
      T = k[TEMPERATURE] +
          2.0 * rest / (k[CAPACITY] + std::sqrt(k[CAPACITY] * k[CAPACITY] + 2.0 * slope * rest));
      // round-off may bring a solid to the melting temperature
      if (molten) *molten = over > 0.0 ? molten_at(T) : (melt <= k[TEMPERATURE] ? 1.0 : 0.0);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
