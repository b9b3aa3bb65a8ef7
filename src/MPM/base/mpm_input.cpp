/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "base/mpm_input.h"

#include "base/mpm_options.h"
#include "law/plugin.h"
#include "table/regular_file.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "lammps.h"
#include "platform.h"
#include "update.h"
#include "utils.h"

#include "fmt/format.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>

#ifndef _WIN32
#include <dlfcn.h>
#endif

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Folders of the package's material files: share/lammps-mpm/potentials in a folder above the
 *  plugin, library, or executable that has this code in it. A build tree has this folder as an
 *  installation has. */
static std::vector<std::filesystem::path> own_potentials()
{
  std::vector<std::filesystem::path> folders;
#ifndef _WIN32
  std::vector<std::filesystem::path> files;
  Dl_info info;
  if (dladdr((const void *) &own_potentials, &info) && info.dli_fname)
    files.push_back(info.dli_fname);
  files.push_back(
      "/proc/self/exe");    // the name above is that of the command line for an executable
  for (const auto &file : files) {
    std::error_code none;
    const auto path = std::filesystem::canonical(file, none);
    if (none) continue;
    for (auto above = path.parent_path(); above != above.root_path(); above = above.parent_path())
      folders.push_back(above / "share" / "lammps-mpm" / "potentials");
  }
#endif
  return folders;
}

/** LAMMPS's search, and then in the folders of this package, for a name without a folder; empty:
 *  nowhere */
static std::string find_file(const std::string &name)
{
  const std::string path = utils::get_potential_file_path(name);
  if (!path.empty() || name.find('/') != std::string::npos) return path;
  for (const auto &folder : own_potentials()) {
    const std::string file = (folder / name).string();
    if (platform::file_is_readable(file)) return file;
  }
  return "";
}

/** Words of a file after its header, and the line of each; returns what is wrong, or nothing. */
static std::string read_words(LAMMPS *lmp, const std::string &name, std::string &text,
                              std::vector<int> &lines)
{
  const std::string path = find_file(name);
  if (path.empty())
    return fmt::format("cannot read file {}: it is not here, nor in a folder of the environment "
                       "variable LAMMPS_POTENTIALS, nor among the files of this package",
                       name);
  if (is_no_file(path)) return fmt::format("cannot read {}, which is no file", path);
  const std::string units = utils::get_potential_units(path, "material");
  const std::string ours = lmp->update->unit_style;
  if (units.empty())
    return fmt::format("the first line of file {} must give its units, such as 'UNITS: si'", name);
  if (units != ours)
    return fmt::format(
        "file {} is in {} units but the input uses {} units: convert the file or use units {}",
        name, units, ours, units);
  utils::logmesg(lmp, "Reading material file {} with DATE: {}\n", name,
                 utils::get_potential_date(path, "material"));

  std::ifstream in(path);
  if (!in) return fmt::format("cannot read file {}: {}", path, utils::getsyserror());
  std::string content;
  for (int line = 1; std::getline(in, content); line++) {
    if (line == 1) continue;
    for (const auto &word : utils::split_words(utils::trim_comment(content))) {
      text += word + " ";
      lines.push_back(line);
    }
  }
  if (in.bad()) return fmt::format("cannot read file {} to its end", path);
  return "";
}

/** Definition in a file with the header of a LAMMPS potential file: rank 0 reads words and their
 *  line numbers, all ranks parse. What follows the file name in the input continues the definition:
 *  more parts, or options of the last part in the file. */
static std::unique_ptr<Material> read_file(LAMMPS *lmp, const std::string &caller, int first,
                                           int narg, char **arg)
{
  const int iarg = first + 1;
  Error *const error = lmp->error;
  require_arguments(lmp, utils::lowercase(caller) + " file", narg, iarg, {"filename"});
  const std::string name = arg[iarg];

  std::string text, problem;
  std::vector<int> lines;
  if (lmp->comm->me == 0) problem = read_words(lmp, name, text, lines);

  broadcast(problem, lmp->world);
  if (!problem.empty()) error->all(FLERR, iarg, "{}: {}", caller, problem);
  broadcast(text, lmp->world);
  broadcast(lines, lmp->world);
  const int nwords = lines.size();

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

std::unique_ptr<Material> LAMMPS_NS::read_material(LAMMPS *lmp, const std::string &caller,
                                                   int first, int narg, char **arg)
{
  if (first < narg && strcmp(arg[first], "file") == 0)
    return read_file(lmp, caller, first, narg, arg);

  for (int iarg = first; iarg < narg; iarg++)
    if (strcmp(arg[iarg], "file") == 0)
      lmp->error->all(
          FLERR, iarg,
          "{}: the 'file' of a material must come first; what follows its name can add to it",
          caller);
  try {
    return Material::create(std::vector<std::string>(arg + first, arg + narg));
  } catch (const MaterialError &e) {
    lmp->error->all(FLERR, std::min(e.word + first, narg - 1), "{}: {}", caller, e.what());
  }
}

/** Sets, groups, and data of a mesh, with their names. */
static void broadcast_named(Mesh &mesh, MPI_Comm world)
{
  std::vector<int> counts = {(int) mesh.sets.size(), (int) mesh.data.size()};
  broadcast(counts, world);
  mesh.sets.resize(counts[0]);
  for (auto &set : mesh.sets) {
    broadcast(set.name, world);
    broadcast(set.elements, world);
  }
  mesh.data.resize(counts[1]);
  std::vector<int> keys;    // dimension, tag
  for (const auto &[key, name] : mesh.groups) {
    keys.push_back(key.first);
    keys.push_back(key.second);
  }
  broadcast(keys, world);
  for (std::size_t k = 0; k < keys.size(); k += 2)
    broadcast(mesh.groups[{keys[k], keys[k + 1]}], world);
  for (auto &data : mesh.data) {
    std::vector<int> about = {data.at_nodes, data.width};
    broadcast(about, world);
    data.at_nodes = about[0];
    data.width = about[1];
    broadcast(data.name, world);
    broadcast(data.values, world);
  }
}

/** What prepare() makes of the mesh in a file, on all ranks. */
static Mesh read_on_all(LAMMPS *lmp, const std::string &file, const std::string &user, int iarg,
                        const std::function<void(Mesh &)> &prepare)
{
  Mesh mesh;
  std::string message;
  if (lmp->comm->me == 0) {
    try {
      mesh = read_mesh(file);
      prepare(mesh);
    } catch (const std::runtime_error &e) {
      message = e.what();
    }
  }
  broadcast(message, lmp->world);
  if (!message.empty()) lmp->error->all(FLERR, iarg, "{}: {}", user, message);
  broadcast(mesh.nodes, lmp->world);
  broadcast(mesh.elements, lmp->world);
  broadcast_named(mesh, lmp->world);
  return mesh;
}

Mesh LAMMPS_NS::read_body(LAMMPS *lmp, const std::string &file, const std::string &part,
                          int dimension, const std::string &user, int iarg)
{
  return read_on_all(lmp, file, user, iarg, [&](Mesh &mesh) {
    mesh.keep(dimension, part);
    if (dimension == lmp->domain->dimension) mesh.orient(dimension);
  });
}

Mesh LAMMPS_NS::read_whole_mesh(LAMMPS *lmp, const std::string &file, const std::string &user,
                                int iarg)
{
  return read_on_all(lmp, file, user, iarg, [&](Mesh &mesh) {
    mesh.orient(lmp->domain->dimension);
  });
}

void MPM_NS::register_laws(void *ptr, const LawVersion &version, const PluginLaw *laws, int n)
{
  auto *lmp = static_cast<LAMMPS *>(ptr);
  const std::string problem = add_laws(version, laws, n);
  if (!problem.empty()) lmp->error->all(FLERR, "Plugin with laws for the MPM package: {}", problem);
  for (int k = 0; k < n && lmp->comm->me == 0; k++)
    utils::logmesg(lmp, "Law for fix mpm/material: {}, {}\n", laws[k].info.name,
                   laws[k].info.meaning);
}
