/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_material_input.h"

#include "law/plugin.h"

#include "comm.h"
#include "error.h"
#include "lammps.h"
#include "update.h"
#include "utils.h"

#include "fmt/format.h"

#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   words of a file after its header, and the line of each; returns what is wrong, or nothing
------------------------------------------------------------------------- */

static std::string read_words(LAMMPS *lmp, const std::string &name, std::string &text,
                              std::vector<int> &lines)
{
  const std::string path = utils::get_potential_file_path(name);
  if (path.empty())
    return fmt::format("cannot read file {}: it is neither here nor in a folder of the environment "
                       "variable LAMMPS_POTENTIALS",
                       name);
  const std::string units = utils::get_potential_units(path, "material");
  const std::string ours = lmp->update->unit_style;
  if (units.empty())
    return fmt::format("the first line of file {} must give its units, such as 'UNITS: si'", name);
  if (units != ours)
    return fmt::format(
        "file {} is in {} units but the input uses {} units: convert the file or use "
        "units {}",
        name, units, ours, units);
  utils::logmesg(lmp, "Reading material file {} with DATE: {}\n", name,
                 utils::get_potential_date(path, "material"));

  FILE *fp = fopen(path.c_str(), "r");
  if (!fp) return fmt::format("cannot read file {}: {}", path, utils::getsyserror());
  char buffer[1024];
  for (int line = 1; utils::fgets_trunc(buffer, sizeof(buffer), fp); line++) {
    if (line == 1) continue;
    for (const auto &word : utils::split_words(utils::trim_comment(buffer))) {
      text += word + " ";
      lines.push_back(line);
    }
  }
  fclose(fp);
  return "";
}

/* ----------------------------------------------------------------------
   definition in a file with the header of a LAMMPS potential file:
   rank 0 reads words and their line numbers, all ranks parse. What follows the file name in the
   input continues the definition: more parts, or options of the last part in the file.
------------------------------------------------------------------------- */

static std::unique_ptr<Material> read_file(LAMMPS *lmp, const std::string &caller, int first,
                                           int narg, char **arg)
{
  const int iarg = first + 1;
  Error *const error = lmp->error;
  if (iarg >= narg) utils::missing_cmd_args(FLERR, utils::lowercase(caller) + " file", error);
  const std::string name = arg[iarg];

  std::string text, problem;
  std::vector<int> lines;
  if (lmp->comm->me == 0) problem = read_words(lmp, name, text, lines);

  const auto broadcast = [lmp](std::string &s) {
    int size = s.size();
    MPI_Bcast(&size, 1, MPI_INT, 0, lmp->world);
    s.resize(size);
    if (size) MPI_Bcast(&s[0], size, MPI_CHAR, 0, lmp->world);
  };
  broadcast(problem);
  if (!problem.empty()) error->all(FLERR, iarg, "{}: {}", caller, problem);
  broadcast(text);
  int nwords = lines.size();
  MPI_Bcast(&nwords, 1, MPI_INT, 0, lmp->world);
  lines.resize(nwords);
  MPI_Bcast(lines.data(), nwords, MPI_INT, 0, lmp->world);

  std::vector<std::string> words = utils::split_words(text);
  words.insert(words.end(), arg + iarg + 1, arg + narg);
  try {
    return Material::create(words);
  } catch (const MaterialError &e) {
    if (e.word >= nwords && iarg + 1 < narg)
      error->all(FLERR, std::min(iarg + 1 + e.word - nwords, narg - 1), "{}: after file {}: {}",
                 caller, name, e.what());
    const int line = lines.empty() ? 1 : lines[std::min(e.word, nwords - 1)];
    error->all(FLERR, iarg, "{}: file {} line {}: {}", caller, name, line, e.what());
  }
}

/* ---------------------------------------------------------------------- */

std::unique_ptr<Material> MPM_NS::read_material(LAMMPS *lmp, const std::string &caller, int first,
                                                int narg, char **arg)
{
  if (first < narg && strcmp(arg[first], "file") == 0)
    return read_file(lmp, caller, first, narg, arg);

  for (int iarg = first; iarg < narg; iarg++)
    if (strcmp(arg[iarg], "file") == 0)
      lmp->error->all(FLERR, iarg,
                      "{}: the 'file' of a material must come first; what follows its name can add "
                      "to it",
                      caller);
  try {
    return Material::create(std::vector<std::string>(arg + first, arg + narg));
  } catch (const MaterialError &e) {
    lmp->error->all(FLERR, std::min(e.word + first, narg - 1), "{}: {}", caller, e.what());
  }
}

/* ---------------------------------------------------------------------- */

void MPM_NS::register_laws(void *ptr, const LawVersion &version, const PluginLaw *laws, int n)
{
  auto *lmp = static_cast<LAMMPS *>(ptr);
  const std::string problem = add_laws(version, laws, n);
  if (!problem.empty()) lmp->error->all(FLERR, "Plugin with laws for the MPM package: {}", problem);
  for (int k = 0; k < n && lmp->comm->me == 0; k++)
    utils::logmesg(lmp, "Law for fix mpm/material: {}, {}\n", laws[k].info.name,
                   laws[k].info.meaning);
}
