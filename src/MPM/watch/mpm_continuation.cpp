/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_continuation.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_physics.h"
#include "force.h"
#include "material/material.h"
#include "modify.h"
#include "neighbor.h"
#include "tokenizer.h"

#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>

using namespace LAMMPS_NS;

void MPMContinuation::sums(double &mass, double &motion) const
{
  double mine[2] = {0.0, 0.0}, all[2];
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const double *const v = atom->v[i];
    mine[0] += atom->rmass[i];
    mine[1] += atom->rmass[i] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  mass = all[0];
  motion = all[1];
}

static int exclusions(const Neighbor &neighbor)
{
  return neighbor.nex_type + neighbor.nex_group + neighbor.nex_mol;
}

static double value(const std::string &lines, const char *name)
{
  const auto at = ("\n" + lines).find(fmt::format("\n{} ", name));
  // std::stod refuses numbers below 2.2e-308, which squares of small velocities can be
  return at == std::string::npos ? 0.0
                                 : std::strtod(lines.c_str() + at + strlen(name) + 1, nullptr);
}

/** One line for each: a name and a value, or a fix with its style. */
std::string MPMContinuation::state() const
{
  double mass, motion;
  sums(mass, motion);
  std::string text = fmt::format("mass {:.17g}\nmotion {:.17g}\nexclusions {}\ninclude {}\n", mass,
                                 motion, exclusions(*neighbor), neighbor->includegroup ? 1 : 0);
  const auto &lattice = field.lattice;
  text += fmt::format("spacing {:.17g}\n", lattice.h);
  for (int d = 0; d < 3; d++)
    text += fmt::format("origin{} {:.17g}\n", d, d < lattice.dim ? lattice.origin[d] : 0.0);
  for (const auto *material : find_fixes<FixMPMMaterial>(lmp))
    text += fmt::format("material:{} {}\n", material->id, material->material->describe());
  for (const auto *fix : modify->get_fix_list())
    // of those of this package that have a state the atom style tells
    if (acts_on_atoms(*fix) && !(fix->restart_global && utils::strmatch(fix->style, "^mpm")))
      text += fmt::format("fix:{} {}\n", fix->id, fix->style);
  return text;
}

std::string MPMContinuation::other_lattice() const
{
  constexpr double ROUND_OFF = 1.0e-9;
  if (expected.empty()) return "";
  const auto &lattice = field.lattice;
  const double h = value(expected, "spacing");
  if (std::fabs(h - lattice.h) > ROUND_OFF * h)
    return fmt::format("spacing {:.9g} (now {:.9g})", h, lattice.h);
  for (int d = 0; d < lattice.dim; d++) {
    const double origin = value(expected, fmt::format("origin{}", d).c_str());
    const double cells = (origin - lattice.origin[d]) / h;
    if (std::fabs(cells - std::round(cells)) > ROUND_OFF * (1.0 + std::fabs(cells)))
      return fmt::format("origin {:.9g} along {} (now {:.9g})", origin, (char) ('x' + d),
                         lattice.origin[d]);
  }
  return "";
}

/** A fix without a state may have another ID. */
std::string MPMContinuation::missing_fixes() const
{
  std::map<std::string, int> found;
  for (const auto *fix : modify->get_fix_list()) found[fix->style]++;
  std::string text;
  for (const auto &line : Tokenizer(expected, "\n").as_vector()) {
    const auto words = Tokenizer(line, " ").as_vector();
    if (words.size() != 2 || words[0].compare(0, 4, "fix:") != 0) continue;
    if (found[words[1]]-- > 0) continue;
    text +=
        fmt::format("{}fix {} (style {})", text.empty() ? "" : ", ", words[0].substr(4), words[1]);
  }
  return text;
}

void MPMContinuation::check_points() const
{
  constexpr double ROUND_OFF = 1.0e-9;
  double mass, motion;
  sums(mass, motion);
  const double mass_then = value(expected, "mass"), motion_then = value(expected, "motion");
  const auto differ = [](double a, double b) {
    return std::fabs(a - b) > ROUND_OFF * std::max(a, b) + DBL_MIN;
  };
  if (comm->me) return;
  if (differ(mass, mass_then))
    error->warning(FLERR,
                   "Fix mpm {}: its points have the mass {:.6g} in the restart file and {:.6g} "
                   "now: the file has the points, so that commands such as create_points, set, and "
                   "delete_atoms must not be repeated, and groups not be defined anew",
                   field.id(), mass_then, mass);
  else if (differ(motion, motion_then))
    error->warning(FLERR,
                   "Fix mpm {}: velocities of points are not those of the restart file: commands "
                   "such as velocity and set must not be repeated after read_restart",
                   field.id());
}

void MPMContinuation::check_materials() const
{
  std::map<std::string, std::string> now;
  for (const auto *material : find_fixes<FixMPMMaterial>(lmp))
    now[fmt::format("material:{}", material->id)] = material->material->describe();
  for (const auto &line : Tokenizer(expected, "\n").as_vector()) {
    const auto end = line.find(' ');
    const auto found = now.find(line.substr(0, end));
    if (found == now.end() || found->second == line.substr(end + 1)) continue;
    error->warning(FLERR,
                   "Material {} is {} now, but was {} in the run that wrote the restart file: "
                   "points have the stress of that",
                   line.substr(9, end - 9), found->second, line.substr(end + 1));
  }
}

void MPMContinuation::check(bool first)
{
  if (expected.empty()) return;
  check_points();
  if (first && comm->me == 0) {
    check_materials();
    const std::string missing = missing_fixes();
    if (!missing.empty())
      error->warning(FLERR,
                     "The run that wrote the restart file had {}, which this one has not: restart "
                     "files have no commands, repeat all that shall go on to act",
                     missing);
    const int then = (int) value(expected, "exclusions"), now = exclusions(*neighbor);
    const bool include = value(expected, "include") != 0.0;
    if (force->pair && (then != now || include != (neighbor->includegroup != 0)))
      error->warning(FLERR,
                     "Neighbor lists had {} exclusions{} in the run that wrote the restart file, "
                     "and have {}{} now, so that other pairs exert forces: give neigh_modify "
                     "exclude and include, or fix mpm/surface lists, as in that run",
                     then, include ? " and an included group" : "", now,
                     neighbor->includegroup ? " and an included group" : "");
  }
  expected.clear();
}
