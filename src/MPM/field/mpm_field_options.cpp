/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_field_options.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

Options MPMFieldOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm");

  o.add("shape",
        {word(shape,
              {{"linear", LINEAR},
               {"quadratic", QUADRATIC},
               {"cubic", CUBIC, "shape functions are B-splines of this order"},
               {"gimp", GIMP, "linear functions, averaged over the fixed size of a point"},
               {"cpgimp", CPGIMP, "as *gimp*, with sizes that follow the deformation"},
               {"cpdi", CPDI,
                "linear functions at the corners of a domain that follows the deformation"},
               {"cpdi2", CPDI2, "as *cpdi*, with corners that move freely"},
               {"bernstein", BERNSTEIN, "quadratic Bernstein polynomials (with *frame total*)"}})})
      .keep();
  o.add("aspect",
        {axes(aspect, dim, "ax ay az", POSITIVE, "",
              "ratio of the edges of undeformed points (for *gimp*, *cpgimp*, *cpdi*, *cpdi2*)")})
      .then([=] {
        double product = 1.0;
        for (int d = 0; d < dim; d++) product *= aspect[d];
        for (int d = 0; d < dim; d++) aspect[d] /= pow(product, 1.0 / dim);
      });

  enum { XPIC_WORD = 5, FMPM_WORD, POLYPIC_WORD };    // after those of enum Transfer
  const auto share = number(flip, "share", FRACTION, "", "FLIP share of the velocity update");
  const auto terms = integer(order, "order", {1, 100, true},
                             "number of terms in the series for the inverse of the mass matrix");
  o.add("transfer",
        {word(
            [this] {
              return polypic ? POLYPIC_WORD
                             : (series == LUMPED ? (int) transfer : XPIC_WORD + series - XPIC);
            },
            [this](int word) {
              polypic = word == POLYPIC_WORD;
              series = word == XPIC_WORD ? XPIC : (word == FMPM_WORD ? FMPM : LUMPED);
              transfer = polypic ? APIC : (series == LUMPED ? (Transfer) word : FLIP);
              flip = series == XPIC ? 1.0 : 0.0;
              order = 1;
            },
            {{"pic", PIC},
             {"flip", FLIP, "", {share}},
             {"apic", APIC},
             {"aflip", AFLIP, "", {share}},
             {"tpic", TPIC},
             {"xpic", XPIC_WORD, "", {terms}},
             {"fmpm", FMPM_WORD, "", {terms}},
             {"polypic", POLYPIC_WORD}})},
        "how velocities are transferred between points and nodes")
      .keep();
  o.add("stress",
        {word(
            [this] {
              const bool mls = is_mls(shape, transfer) && !strains_by_gradient();
              return mls ? MLS_STRESS : GRADIENT_STRESS;
            },
            [this](int word) {
              stress = (Stress) word;
            },
            {{"mls", MLS_STRESS}, {"gradient", GRADIENT_STRESS}})},
        "form of the internal force and of the velocity gradient")
      .standard(
          "mls if *shape* and *transfer* allow it; gradient in the updated frame, and if stress "
          "depends on temperatures, with fix mpm/relax, and with fix mpm/implicit static "
          "and euler, without fix mpm/contact and fix mpm/pore")
      .keep([this] {    // the fixes that it depends on come after the file has been read
        return stress != DEFAULT_STRESS || !strains_by_gradient();
      });
  o.add("scheme", {word(scheme, {{"usl", USL}, {"usf", USF}, {"musl", MUSL}, {"usavg", USAVG}})},
        "when stress is updated in a step")
      .keep();
  o.add("frame", {word(total, {{"updated", false}, {"total", true}})},
        "configuration in which the lattice is defined")
      .keep();
  o.add(
       "reference",
       {word(
           [this] {
             return most_distorted > 0.0;
           },
           [this](int) {
             most_distorted = 0.0;
           },
           {{"fixed", false},
            {"update",
             true,
             "",
             {number(most_distorted, "S", {1.0, UNBOUNDED, false}, "",
                     "ratio of the stretches of a point above which the reference is renewed")}}})},
       "with frame total: reference configuration, which can be renewed where points are distorted")
      .keep();
  o.add("axisymmetric", {yes_no(axisymmetric)},
        "2d: x is the distance from an axis of symmetry, and points are rings")
      .keep();
  o.add(
       "locking",
       {word(locking, {{"none", NO_CURE}, {"fbar", FBAR}, {"pressure", PRESSURE}, {"both", BOTH}})},
       "quantity that is averaged over neighboring points to prevent volumetric locking")
      .keep();
  o.add("smooth",
        {number(smooth, "share", FRACTION, "",
                "share of the roughness in the volumes of points of a fluid that is removed in the "
                "time in which sound crosses a cell")});
  o.add(
      "drift",
      {number(drift, "rate", {0.0, UNBOUNDED, true}, "1/strain",
              "rate at which the volumes of points of liquids follow the room that they fill, per "
              "unit of strain; 0: they do not")});
  o.add("heat", {yes_no(heat)},
        "convert kinetic energy that is lost in transfers into heat of the points");
  o.add("light",
        {number(
            light, "share", FRACTION, "",
            "share of a full cell below which a node has a reduced weight in velocity gradients")});
  o.add("origin",
        {axes(origin, dim, "x y z", ANY_NUMBER, "distance", "position of one node of the lattice")})
      .standard("lower corner of the simulation box");
  o.add("bad", {word(bad, {{"error", ERROR}, {"warn", WARN}, {"delete", DELETE}})},
        "what to do with a point that is inverted, has values that are not finite, or has left the "
        "box");
  const auto gained = number(most_gain, "share", POSITIVE, "",
                             "largest gain of energy, as a share of the energy in play");
  o.add("gain",
        {word(gain,
              {{"error", GAIN_ERROR, "", {gained}},
               {"warn", GAIN_WARN, "", {gained}},
               {"ignore", GAIN_IGNORE}})},
        "what to do when numerical errors have added more than this energy");
  o.add("apart", {word(apart, {{"warn", true}, {"ignore", false}})},
        "what to do when points of a stretched solid are so far apart that the solid breaks "
        "numerically");
  o.add("failed", {word(delete_failed, {{"keep", false}, {"delete", true}})},
        "what to do with a point whose damage is 1");
  o.add("edges", {word(modified_edges, {{"plain", false}, {"modified", true}})},
        "shape functions next to fixed faces of the box");
  o.add("every",
        {integer(every, "K", POSITIVE, "number of steps of the run for each step of the points")})
      .keep();
  o.add("dtcheck", {yes_no(dt_check)}, "stop with an error when the time step is above the limit");
  o.add("plan", {yes_no(plan)},
        "print the stages of the step and, at the end of the run, the cost of each stage");

  o.add(
      "kernels",
      {word(kernels, {{"auto", 0}, {"reference", 1}, {"baseline", 2}, {"avx2", 3}, {"avx512", 4}})},
      "instruction set of the transfers and the materials");

  // what does not go together
  const auto amplifies = [this] {
    return changes_cells() && shape == LINEAR && (scheme == USL || is_affine(transfer));
  };
  const auto fits = [this] {    // affine matrices are least squares with one moment for all points
    return shape == QUADRATIC || shape == CUBIC;
  };
  o.refuse([=] {
    return OptionRules{
        {axisymmetric && dim != 2, "axisymmetric", "needs dimension 2"},
        {most_distorted > 0.0 && !total, "reference",
         "update is for frame total: in the updated frame, the reference is the present "
         "configuration in each step"},
        {!has_size(), "aspect",
         "is for points of finite size: use shape gimp, cpgimp, cpdi or cpdi2"},
        {total && (has_size() || transfer == AFLIP || transfer == TPIC), "frame",
         "total cannot be used with shape gimp, cpgimp, cpdi and cpdi2, which points that cross no "
         "cells do not need, and transfer aflip and tpic: use B-splines with transfer apic or "
         "flip"},
        {polypic && (total || !is_mls(shape, transfer)), "transfer",
         "polypic needs shape quadratic or cubic and frame updated"},
        {stress == MLS_STRESS && !is_mls(shape, transfer), "stress",
         "mls needs shape quadratic or cubic with transfer apic or aflip: other ones have the "
         "gradients of the shape functions"},
        {modified_edges &&
             ((shape != QUADRATIC && shape != CUBIC) || series != LUMPED || is_affine(transfer)),
         "edges",
         "modified is for shape quadratic and cubic with transfer pic and flip: use edges plain"},
        {shape == BERNSTEIN && !total, "shape",
         "bernstein has gradients that jump where points cross cells: it needs frame total, where "
         "they do not, or use shape quadratic"},
        {series == FMPM && scheme != USL, "transfer",
         "fmpm moves points with refined velocities, which the gradients of scheme usf, musl and "
         "usavg do not follow: use scheme usl, or transfer xpic"},
        {smooth > 0.0 && total, "smooth",
         "is for fluids, which frame total is not: use frame updated"},
        {smooth > 0.0 && averages_strain(), "smooth",
         "cannot be used with locking fbar and both, which keep volumes of their own: give fluids, "
         "which do not lock, a fix mpm without locking"},
        {smooth > 0.0 && modified_edges, "smooth",
         "needs the same functions everywhere: use edges plain"},
        {heat &&
             (polypic || series != LUMPED || (transfer != PIC && !(transfer == APIC && fits()))),
         "heat",
         "needs transfer pic, or apic with shape quadratic or cubic: what other transfers do to "
         "the energy of a point can have either sign"},
        {heat && stress_before(), "heat",
         "needs scheme usl or musl, where stress is updated after the velocities"},
        {light > 0.0 && !amplifies(), "light",
         "is of no use with this shape, transfer, scheme and frame: remove light, which is for "
         "shape linear with scheme usl or transfer apic, aflip, tpic, where points change cells"},
        {light > 0.0 && locking != NO_CURE && scheme == USL && is_affine(transfer), "light",
         "and locking together are unstable with scheme usl and transfer apic, aflip, tpic: use "
         "scheme musl, or transfer flip"},
        {light > 0.0 && axisymmetric && scheme == USF, "light",
         "and axisymmetric together are unstable with scheme usf: use scheme usl or musl"}};
  });

  // what is likely to be a mistake
  o.warn([=] {
    return OptionRules{
        {series == XPIC && order > 1 && scheme != USL, "transfer",
         "xpic with scheme usf, musl and usavg: a body that turns loses its spin: use scheme usl, "
         "or transfer flip or apic"},
        {scheme == USF && !total, "scheme",
         "usf: points move with other velocities than they strain with, and bodies under tension "
         "deform too much or make noise: use scheme usl or musl, or frame total"},
        {light == 0.0 && amplifies(), "shape",
         "linear with scheme usl or transfer apic: linear functions amplify round-off at nodes of "
         "tiny mass: use transfer flip with scheme musl, quadratic functions, or light 0.5"},
        {shape == BERNSTEIN && changes_cells() && (scheme == USL || is_affine(transfer)), "shape",
         "bernstein with reference update and scheme usl or transfer apic: these functions amplify "
         "round-off at nodes of tiny mass: use transfer flip with scheme musl, quadratic "
         "functions, or reference fixed"}};
  });
  return o;
}
