/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_implicit_options.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   fix ID all mpm/implicit static|euler|newmark|midpoint|alpha|hht keyword value ...
------------------------------------------------------------------------- */

Options MPMImplicitOptions::declare()
{
  using namespace option;
  Options options("fix mpm/implicit");
  options.argument(word(
      time.kind,
      {{"static", MPMTimeMethod::STATIC, "without inertia: each step ends in equilibrium"},
       {"euler", MPMTimeMethod::EULER, "backward Euler: first order in time, damps fast motion"},
       {"newmark", MPMTimeMethod::NEWMARK,
        "Newmark's method: second order and without damping for gamma = 1/2"},
       {"midpoint", MPMTimeMethod::MIDPOINT,
        "mid-point rule: second order, without damping, keeps angular momentum"},
       {"alpha", MPMTimeMethod::ALPHA,
        "generalized alpha method: second order, damps high frequencies only"},
       {"hht", MPMTimeMethod::HHT,
        "method of Hilber, Hughes, and Taylor: as alpha, with more damping of medium "
        "frequencies"}}));
  options.add("gamma",
              {number(time.gamma, "G", {0.5, 1.0, true, true}, "",
                      "parameter gamma of Newmark's method; values above 1/2 damp, with "
                      "first-order accuracy")});
  options.add("rho",
              {number(time.rho, "R", {0.0, 1.0, true, true}, "",
                      "parameter rho of alpha and hht: the share of the highest frequencies that "
                      "is left after a step")});
  options.add("tolerance",
              {number(tolerance, "R", {0.0, 1.0, false, false}, "",
                      "forces are balanced when the residual is below this share of all forces")});
  options
      .add("absolute",
           {number(absolute, "F", NOT_NEGATIVE, "force",
                   "forces are also balanced when the sum of the residual is below this force")})
      .standard("0 (not used)");
  options.add(
      "iterations",
      {integer(most_iterations, "N", POSITIVE, "largest number of Newton iterations in a step")});
  options.add(
      "parts",
      {integer(most_parts, "N", POSITIVE,
               "a step that does not converge is divided into parts, down to 1/N of the step")});
  options.add("linear",
              {integer(most_linear, "N", POSITIVE,
                       "largest number of iterations of the linear solver in a Newton iteration")});
  options.add("accuracy",
              {number(least_accuracy, "R", {0.0, 1.0, false, false}, "",
                      "largest relative residual of the linear solutions")});
  options.add(
      "solver",
      {word(
          preconditioner,
          {{"blocks", BLOCKS,
            "conjugate gradients, preconditioned with the stiffness of each node by itself"},
           {"multigrid", MULTIGRID,
            "the same on a sequence of lattices, each with twice the spacing: for many cells"}})});
  options
      .add("slip",
           {number(slip, "D", POSITIVE, "distance",
                   "walls reach full Coulomb friction where surfaces slip by much more than this "
                   "in a step")})
      .standard("1e-5 node spacings");
  options
      .add("stabilize",
           {number(stabilize, "C", NOT_NEGATIVE, "",
                   "stiffness of nodes that points barely reach, relative to the modulus of these "
                   "points")})
      .then([this] {
        stabilize_is_given = true;
      })
      .standard("0 until a step does not converge, then 1");
  options.add("report", {yes_no(report)},
              "print the forces before each Newton iteration to the screen and the log file");
  options.refuse([=] {
    return OptionRules{
        {time.kind != MPMTimeMethod::NEWMARK, "gamma",
         "is of Newmark's method: use newmark, or remove it"},
        {stabilize > 0.0 && time.moves_by_mean(), "stabilize",
         "is for static and euler: remove it"},
        {!time.keeps_acceleration(), "rho",
         "is of the methods with a damping of high frequencies: use alpha or hht, or remove it"},
        {time.kind == MPMTimeMethod::HHT && time.rho < 0.5, "rho",
         "is at least 0.5 in the method of Hilber, Hughes, and Taylor: use alpha for {rho}"}};
  });
  return options;
}
