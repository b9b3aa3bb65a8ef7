/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "base/mpm_options.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_step_limit.h"
#include "error.h"
#include "fix.h"
#include "input.h"
#include "modify.h"
#include "update.h"
#include "utils.h"
#include "variable.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

int LAMMPS_NS::read_options(LAMMPS *lmp, Options &options, int narg, char **arg, int iarg,
                            const std::string &last)
{
  const auto number = [=](int i) {
    return utils::numeric(FLERR, arg[i], false, lmp);
  };
  const auto integer = [=](int i) {
    return utils::bnumeric(FLERR, arg[i], false, lmp);
  };
  const auto yes = [=](int i) {
    return utils::logical(FLERR, arg[i], false, lmp) != 0;
  };
  const OptionInput input{narg, arg, number, integer, yes};
  try {
    return options.read(input, iarg, last);
  } catch (const OptionError &e) {
    if (e.missing) utils::missing_cmd_args(FLERR, e.text, lmp->error);
    // the place of the word in the line of the input, of which arg may be the end (dump_modify)
    char **const line = lmp->input->arg, **const end = line + lmp->input->narg;
    char **const word = e.iarg < 0 ? end : std::find(line, end, arg[e.iarg]);
    lmp->error->all(FLERR, word < end ? (int) (word - line) : Error::NOPOINTER, e.text);
  }
  return iarg;
}

void LAMMPS_NS::require_arguments(LAMMPS *lmp, const std::string &command, int narg, int first,
                                  std::initializer_list<const char *> names)
{
  std::string missing;
  int place = first;
  for (const char *name : names)
    if (place++ >= narg) missing += std::string(" ") + name;
  if (!missing.empty())
    lmp->error->all(FLERR, Error::NOPOINTER, "Illegal {} command: missing argument(s), needs{}",
                    command, missing);
}

int LAMMPS_NS::read_precision(LAMMPS *lmp, int narg, char **arg, bool &single)
{
  Options o("dump_modify");
  o.add("precision", {option::word(single, {{"single", true}, {"double", false}})});
  if (!o.has(arg[0])) return 0;
  read_options(lmp, o, std::min(narg, 2), arg, 0);
  return 2;
}

void LAMMPS_NS::require_field(LAMMPS *lmp, const Fix &user)
{
  if (!lmp->modify->get_fix_by_style("^mpm$").empty()) return;
  const auto others = find_fixes(lmp, {"^mpm/incompressible$", "^mpm/mesh$"});
  if (others.empty())
    lmp->error->all(FLERR, Error::NOLASTLINE, "Fix {} needs a fix mpm for the points: define one",
                    user.style);
  lmp->error->all(
      FLERR, Error::NOLASTLINE,
      "Fix {} acts on points of a fix mpm, and those of fix {} (style {}) have neither "
      "its nodes nor its materials: give the points a fix mpm, a fluid with eos tait, or "
      "remove fix {}",
      user.style, others[0]->id, others[0]->style, user.id);
}

void LAMMPS_NS::refuse_second(LAMMPS *lmp, const Fix &user, const std::string &remedy)
{
  if (lmp->modify->get_fix_by_style(fmt::format("^{}$", user.style)).size() > 1)
    lmp->error->all(FLERR, Error::NOLASTLINE, "There is more than one fix {}: {}", user.style,
                    remedy);
}

void LAMMPS_NS::find_variable(LAMMPS *lmp, NumberOrVariable &v, const std::string &user)
{
  if (v.variable.empty()) return;
  v.index = lmp->input->variable->find(v.variable.c_str());
  if (v.index < 0 || !lmp->input->variable->equalstyle(v.index))
    lmp->error->all(FLERR, Error::NOLASTLINE, "Variable {} for {} {}", v.variable, user,
                    v.index < 0 ? "does not exist" : "is not equal-style");
}

double LAMMPS_NS::evaluate(LAMMPS *lmp, const NumberOrVariable &v)
{
  if (v.variable.empty()) return v.value;
  const double value = lmp->input->variable->compute_equal(v.index);
  if (!std::isfinite(value))
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "Variable {} is {} at step {}: it must be a finite number", v.variable, value,
                    lmp->update->ntimestep);
  return value;
}

void LAMMPS_NS::evaluate_in_step(LAMMPS *lmp, bool any, const std::function<void()> &f)
{
  if (any) lmp->modify->clearstep_compute();
  f();
  if (!any) return;
  const auto cycles = find_fixes<MPMCycle>(lmp);
  const int steps = cycles.empty() ? 1 : cycles[0]->steps_to_next();
  lmp->modify->addstep_compute(lmp->update->ntimestep + steps);
}
