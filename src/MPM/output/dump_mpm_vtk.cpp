/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/dump_mpm_vtk.h"

#include "base/mpm_options.h"
#include "compute.h"
#include "memory.h"
#include "modify.h"
#include "output/compute_mpm_atom.h"
#include "tokenizer.h"

#include <algorithm>
#include <map>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// fields with several components: as attributes of dump custom or names of compute mpm/atom

static const std::map<std::string, std::vector<std::string>> composed = {
    {"velocity", {"vx", "vy", "vz"}},
    {"force", {"fx", "fy", "fz"}},
    {"omega", {"omegax", "omegay", "omegaz"}},
    {"torque", {"tqx", "tqy", "tqz"}},
    {"image", {"ix", "iy", "iz"}},
    {"stress",
     {"stress/xx", "stress/xy", "stress/xz", "stress/xy", "stress/yy", "stress/yz", "stress/xz",
      "stress/yz", "stress/zz"}},
    {"F", {"F/xx", "F/xy", "F/xz", "F/yx", "F/yy", "F/yz", "F/zx", "F/zy", "F/zz"}},
    {"principal", {"principal/1", "principal/2", "principal/3"}},
};

// numbers that dump custom knows and compute mpm/atom does not

static const std::set<std::string> attributes = {
    "mol",    "proc",   "procp1",  "x",       "y",       "z",      "xs",       "ys",
    "zs",     "xu",     "yu",      "zu",      "xsu",     "ysu",    "zsu",      "ix",
    "iy",     "iz",     "vx",      "vy",      "vz",      "fx",     "fy",       "fz",
    "q",      "mux",    "muy",     "muz",     "mu",      "radius", "diameter", "omegax",
    "omegay", "omegaz", "angmomx", "angmomy", "angmomz", "tqx",    "tqy",      "tqz"};

static const std::set<std::string> integers = {"id",     "type", "mol", "proc",
                                               "procp1", "ix",   "iy",  "iz"};

static const char PREFIX[] = "quantity:";    // marks a name of compute mpm/atom

DumpMPMVTK::Request::Request(LAMMPS *lmp_in, int narg, char **arg) : lmp(lmp_in)
{
  auto *error = lmp->error;
  shown = std::make_unique<ErrorWords>(lmp, narg, arg);
  require_arguments(lmp, "dump mpm/vtk", narg, 3, {"N", "file"});

  const auto wrong = VTKFile::name_error(arg[4], "vtp", strcmp(arg[0], "WRITE_DUMP") != 0, true);
  if (!wrong.empty()) error->all(FLERR, 4, "Dump mpm/vtk {}", wrong);

  for (int iarg = 0; iarg < 5; iarg++) words.emplace_back(arg[iarg]);
  fields.push_back({"id", {column("id")}, true});
  fields.push_back({"type", {column("type")}, true});
  position = {"Points", {column("x"), column("y"), column("z")}, false};

  for (int iarg = 5; iarg < narg; iarg++) {
    const std::string name = arg[iarg];
    if (utils::strmatch(name, "^[cfvid]2?_")) {

      // as in dump custom; a wildcard makes one field with many components

      char **expanded;
      const int n = utils::expand_args(FLERR, 1, &arg[iarg], 1, expanded, lmp);
      Field field = {name.substr(0, name.find("[*]")), {}, utils::strmatch(name, "^i2?_")};
      for (int k = 0; k < n; k++) field.columns.push_back(column(expanded[k]));
      if (expanded != &arg[iarg]) {
        for (int k = 0; k < n; k++) delete[] expanded[k];
        lmp->memory->sfree(expanded);
      }
      fields.push_back(field);
    } else {
      for (const auto &word : ComputeMPMAtom::expand(name)) add_field(word, iarg);
    }
  }

  // the names of compute mpm/atom become columns of an internal compute

  std::string names;
  std::vector<std::string *> quantities;
  for (auto &word : words)
    if (utils::strmatch(word, "^quantity:")) {
      names += " " + word.substr(strlen(PREFIX));
      quantities.push_back(&word);
    }
  if (!quantities.empty()) {
    int n = 1;
    while (lmp->modify->get_compute_by_id(fmt::format("MPM_VTK_{}", n))) n++;
    compute = fmt::format("MPM_VTK_{}", n);
    const std::string command = fmt::format("{} {} mpm/atom{}", compute, arg[1], names);
    auto parts = Tokenizer(command).as_vector();
    std::vector<char *> pointers;
    for (auto &part : parts) pointers.push_back(part.data());
    const ErrorWords own(lmp, (int) pointers.size(), pointers.data());
    auto *made = lmp->modify->add_compute((int) pointers.size(), pointers.data());
    if (auto *quantity = dynamic_cast<ComputeMPMAtom *>(made))
      quantity->owner = fmt::format("dump {} of style mpm/vtk", arg[0]);
    int k = 0;
    for (auto *word : quantities)
      *word = quantities.size() == 1 ? "c_" + compute : fmt::format("c_{}[{}]", compute, ++k);
  }

  for (auto &word : words) args.push_back(const_cast<char *>(word.c_str()));
  shown.reset();
  shown = std::make_unique<ErrorWords>(lmp, (int) args.size(), args.data());
}

DumpMPMVTK::Request::~Request()
{
  auto *modify = lmp->modify;
  if (modify && modify->get_compute_by_id(compute)) modify->delete_compute(compute);
}

/** Number of the column of an attribute, made when there is none. */
int DumpMPMVTK::Request::column(const std::string &word)
{
  for (std::size_t k = 5; k < words.size(); k++)
    if (words[k] == word) return (int) k - 5;
  words.push_back(word);
  return (int) words.size() - 6;
}

/** A field by its name; a name that nothing else knows may be a history variable, which the
 *  internal compute finds out when all materials are known. */
void DumpMPMVTK::Request::add_field(const std::string &name, int iarg)
{
  for (const auto &field : fields)
    if (field.name == name) return;
  if (name == "element" || name == "typelabel")
    lmp->error->all(FLERR, iarg, "Dump mpm/vtk writes numbers only: use type instead of {}", name);

  const auto found = composed.find(name);
  const auto parts = found == composed.end() ? std::vector<std::string>{name} : found->second;
  Field field = {name, {}, integers.count(parts[0]) > 0};
  for (const auto &part : parts)
    field.columns.push_back(column(attributes.count(part) ? part : PREFIX + part));
  fields.push_back(field);
}

DumpMPMVTK::DumpMPMVTK(LAMMPS *lmp, int narg, char **arg) :
    DumpMPMVTK(lmp, std::make_unique<Request>(lmp, narg, arg))
{
}

DumpMPMVTK::DumpMPMVTK(LAMMPS *lmp, std::unique_ptr<Request> custom) :
    DumpVTKSeries(lmp, (int) custom->args.size(), custom->args.data()), request(std::move(custom))
{
  request->shown.reset();
  begin_series();
}

void DumpMPMVTK::init_style()
{
  // a dump that is made between runs may use the internal compute at once

  if (update->first_update) {
    auto *quantities = modify->get_compute_by_id(request->compute);
    if (quantities && !quantities->is_initialized()) {
      quantities->init();
      quantities->init_flags();
    }
  }

  int one = filewriter;
  MPI_Allreduce(&one, &npiece, 1, MPI_INT, MPI_SUM, world);

  write_header_flag = 1;
  DumpCustom::init_style();
}

/** Only called by the process that writes. */
void DumpMPMVTK::write_header(bigint npoint)
{
  vtk = VTKFile("PolyData", compress);
  const auto real = single ? VTKFile::FLOAT32 : VTKFile::FLOAT64;
  for (const auto &field : request->fields)
    vtk.add("PointData", field.name, field.integer ? VTKFile::INT64 : real,
            (int) field.columns.size(), npoint);
  vtk.add("Points", request->position.name, real, 3, npoint);
  vtk.add("Verts", "connectivity", VTKFile::INT64, 1, npoint);
  vtk.add("Verts", "offsets", VTKFile::INT64, 1, npoint);
  vtk.begin(fp,
            fmt::format("NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" "
                        "NumberOfStrips=\"0\" NumberOfPolys=\"0\"",
                        npoint),
            update->unit_style, compute_time(), update->ntimestep);
  nwritten = 0;
}

void DumpMPMVTK::write_field(const Field &field, int array, int n, const double *rows)
{
  const int ncomponent = (int) field.columns.size();
  values.resize((std::size_t) n * ncomponent);
  double *value = values.data();
  for (int i = 0; i < n; i++)
    for (int column : field.columns) *value++ = rows[(bigint) i * size_one + column];
  vtk.write(array, nwritten, n, values.data());
}

/** Rows of the next process. */
void DumpMPMVTK::write_data(int n, double *rows)
{
  int array = 0;
  for (const auto &field : request->fields) write_field(field, array++, n, rows);
  write_field(request->position, array++, n, rows);

  // every point is a cell of one vertex: its number, and the end of its list of vertices

  values.resize(n);
  for (int i = 0; i < n; i++) values[i] = (double) (nwritten + i);
  vtk.write(array++, nwritten, n, values.data());
  for (int i = 0; i < n; i++) values[i] += 1.0;
  vtk.write(array, nwritten, n, values.data());

  nwritten += n;
}

void DumpMPMVTK::write_footer()
{
  vtk.end();
  if (multiproc && me == 0) list_pieces();
  DumpVTKSeries::write_footer();
}

/** File with the names of the pieces of this snapshot. */
void DumpMPMVTK::list_pieces()
{
  const std::string name = platform::path_basename(filename);
  const auto percent = name.find('%');
  std::vector<std::string> names;
  for (int k = 0; k < npiece; k++)
    names.push_back(
        utils::star_subst(name.substr(0, percent) + std::to_string(k) + name.substr(percent + 1),
                          update->ntimestep, padflag));
  const auto text = vtk.list_of_pieces(names);
  const auto file = listed_file();
  FILE *out = fopen(file.c_str(), "w");
  bool ok = out && fwrite(text.data(), 1, text.size(), out) == text.size();
  if (out) ok = fclose(out) == 0 && ok;
  if (!ok)
    error->one(FLERR, Error::NOLASTLINE, "Dump {} cannot write the list of pieces {}: {}", id, file,
               utils::getsyserror());

  // Dump deletes the pieces of former snapshots: their lists go with the piece of this process

  const auto gone = [](const std::pair<std::string, std::string> &former) {
    if (platform::file_is_readable(former.second)) return false;
    remove(former.first.c_str());
    return true;
  };
  listed.erase(std::remove_if(listed.begin(), listed.end(), gone), listed.end());
  if (maxfiles > 0)
    listed.emplace_back(file, platform::path_join(platform::path_dirname(filename), names[0]));
}

std::string DumpMPMVTK::listed_file()
{
  if (!multiproc) return DumpVTKSeries::listed_file();
  std::string name = VTKFile::without_percent(filename);
  name.insert(name.size() - 3, "p");
  return utils::star_subst(name, update->ntimestep, padflag);
}
