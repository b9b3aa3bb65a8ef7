/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_OPTIONS_H
#define LMP_MPM_OPTIONS_H

// Declared options (declare/option.h) in LAMMPS: numbers are read as everywhere in its input, and a
// mistake is an error of LAMMPS that points to the argument.

#include "declare/option.h"

namespace LAMMPS_NS {
class Fix;
class LAMMPS;
class MPMField;

/** Reads the arguments from iarg on as declared, up to the end or the word last, whose index it
 *  returns. */
int read_options(LAMMPS *, MPM_NS::Options &, int narg, char **arg, int iarg,
                 const std::string &last = "");

/** Reads precision single|double of dump_modify and returns 2, or 0 for any other keyword. */
int read_precision(LAMMPS *, int narg, char **arg, bool &single);

/** Stops with an error when a field (fix mpm) breaks one of the rules of a fix: their keyword is what
 *  of the field cannot be used, their text says why, and the remedy. */
void refuse_field(LAMMPS *, const Fix &user, const MPMField &field, const MPM_NS::OptionRules &);
/** The same for a command. */
void refuse_field(LAMMPS *, const std::string &user, const MPMField &field,
                  const MPM_NS::OptionRules &);

/** Finds the variable, if it is one, and stops with an error if it does not exist or is not
 *  equal-style; user: who needs it, for example fix mpm/rigid force. */
void find_variable(LAMMPS *, MPM_NS::NumberOrVariable &, const std::string &user);

/** The number, or the present value of the variable. */
double evaluate(LAMMPS *, const MPM_NS::NumberOrVariable &);

/** Calls f(), which evaluates variables if any are set, and asks for these in the next step of the
 *  cycle, or of the run if there is no field. */
void evaluate_in_step(LAMMPS *, bool any, const std::function<void()> &f);

}    // namespace LAMMPS_NS
#endif
