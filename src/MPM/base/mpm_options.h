/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_OPTIONS_H
#define LMP_MPM_OPTIONS_H

#include "declare/option.h"

#include <initializer_list>
#include <string>

// Declared options (declare/option.h) in LAMMPS: numbers are read as everywhere in its input, and a
// mistake is an error of LAMMPS that points to the argument.

namespace LAMMPS_NS {
class Fix;
class LAMMPS;

/** Reads the arguments from iarg on as declared, up to the end or to the word last. Returns the
 *  index of this word, or of the end. */
int read_options(LAMMPS *, MPM_NS::Options &, int narg, char **arg, int iarg,
                 const std::string &last = "");

/** Stops with an error if the command ends before all of these arguments, the first of which has
 *  the index first, and says which are missing. */
void require_arguments(LAMMPS *, const std::string &command, int narg, int first,
                       std::initializer_list<const char *> names);

/** Reads precision single|double of dump_modify and returns 2, or 0 for any other keyword. */
int read_precision(LAMMPS *, int narg, char **arg, bool &single);

/** Called in init(): stops with an error if there is no fix mpm that a fix can act on. */
void require_field(LAMMPS *, const Fix &user);
/** Stops with an error if there is another fix of this style. remedy: what one of them does, or
 *  what to do. */
void refuse_second(LAMMPS *, const Fix &user, const std::string &remedy = "remove one");

/** Finds the variable, if the value is one, and stops with an error if it does not exist or is not
 *  equal-style. user: who needs it, for example fix mpm/rigid force. */
void find_variable(LAMMPS *, MPM_NS::NumberOrVariable &, const std::string &user);

/** Returns the number, or the present value of the variable. */
double evaluate(LAMMPS *, const MPM_NS::NumberOrVariable &);

/** Calls f(), which evaluates variables. any: are there variables? If so, their computes are
 *  requested for the next step of the cycle, or of the run if there is no field. */
void evaluate_in_step(LAMMPS *, bool any, const std::function<void()> &f);

/** Value of a keyword every: a number of steps, or the word auto, which is stored as 0. */
inline MPM_NS::OptionValue steps_or_auto(int &to, const std::string &of_number,
                                         const std::string &of_auto)
{
  MPM_NS::OptionValue value = MPM_NS::option::integer(to, "N", MPM_NS::POSITIVE, of_number);
  const auto read = value.read;
  const auto text = value.text;
  value.usage = "N or *auto*";
  value.notes.push_back({"*auto*", of_auto});
  value.read = [&to, read](MPM_NS::OptionReader &r) {
    if (r.iarg < r.input.narg && std::string(r.input.arg[r.iarg]) == "auto") {
      r.next();
      to = 0;
    } else {
      read(r);
    }
  };
  value.text = [&to, text] {
    return to ? text() : std::string("auto");
  };
  return value;
}

}    // namespace LAMMPS_NS
#endif
