/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_vtk.h"

#include "fmt/format.h"
#include "input.h"
#include "lammps.h"
#include "platform.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

using namespace MPM_NS;
using namespace LAMMPS_NS;

static constexpr int64_t CHUNK = 65536;    // values converted at a time

template <typename T> static void convert(const double *from, int64_t n, char *to)
{
  for (int64_t k = 0; k < n; k++) {
    const T value = static_cast<T>(from[k]);
    memcpy(to + k * sizeof(T), &value, sizeof(T));
  }
}

// in the order of VTKFile::Type
static const struct {
  const char *name;
  int bytes;
  void (*convert)(const double *, int64_t, char *);
} types[] = {{"Int64", 8, convert<int64_t>},
             {"UInt8", 1, convert<uint8_t>},
             {"Float64", 8, convert<double>},
             {"Float32", 4, convert<float>}};

static const char *byte_order()
{
  const uint16_t one = 1;
  return *reinterpret_cast<const char *>(&one) ? "LittleEndian" : "BigEndian";
}

/* ---------------------------------------------------------------------- */

std::string VTKFile::name_error(const std::string &name, const std::string &extension, bool series)
{
  const std::string end = "." + extension;
  if (name.size() <= end.size() || name.compare(name.size() - end.size(), end.size(), end) != 0)
    return fmt::format("file name must end in {}: {}", end, name);
  if (name.find('%') != std::string::npos)
    return fmt::format("writes one file for all processes: remove % from file name {}", name);
  const auto star = name.find('*');
  if (star == std::string::npos) {
    if (series)
      return fmt::format("writes one file per snapshot: put a * into the file name, e.g. {}.*{}",
                         name.substr(0, name.size() - end.size()), end);
  } else if (name.find('/', star) != std::string::npos) {
    return fmt::format("file name must have its * after the last /: {}", name);
  }
  return "";
}

/* ---------------------------------------------------------------------- */

int VTKFile::add(const std::string &section, const std::string &name, Type type, int ncomponent,
                 int64_t ntuple)
{
  Array a = {section, name, type, ncomponent, 0, ntuple * ncomponent * types[type].bytes};
  if (!arrays.empty())
    a.offset = arrays.back().offset + (int64_t) sizeof(uint64_t) + arrays.back().bytes;
  arrays.push_back(a);
  return (int) arrays.size() - 1;
}

/* ---------------------------------------------------------------------- */

void VTKFile::begin(FILE *fp_in, const std::string &piece, const std::string &units, double time,
                    int64_t step)
{
  fp = fp_in;
  std::string codes;    // of characters, and the zero at the end
  for (const char c : units) codes += fmt::format("{} ", (int) c);
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"{1}\" header_type=\"UInt64\">\n"
      "<{0}>\n"
      "<FieldData>\n"
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
      "{2:.17g}</DataArray>\n"
      "<DataArray type=\"Int64\" Name=\"TimeStep\" NumberOfTuples=\"1\" format=\"ascii\">"
      "{3}</DataArray>\n"
      "<Array type=\"String\" Name=\"Units\" NumberOfTuples=\"1\" format=\"ascii\">{4}0</Array>\n"
      "</FieldData>\n"
      "<Piece {5}>\n",
      kind, byte_order(), time, step, codes, piece);

  std::string section;
  for (const auto &a : arrays) {
    if (a.section != section) {
      if (!section.empty()) text += fmt::format("</{}>\n", section);
      section = a.section;
      text += fmt::format("<{}>\n", section);
    }
    text += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
                        "format=\"appended\" offset=\"{}\"/>\n",
                        types[a.type].name, a.name, a.ncomponent, a.offset);
  }
  if (!section.empty()) text += fmt::format("</{}>\n", section);
  text += fmt::format("</Piece>\n</{}>\n<AppendedData encoding=\"raw\">\n_", kind);
  fwrite(text.data(), 1, text.size(), fp);
  start = (int64_t) text.size();

  // lengths of the arrays, and the end of the file

  int64_t end = 0;
  for (const auto &a : arrays) {
    const uint64_t bytes = a.bytes;
    platform::fseek(fp, start + a.offset);
    fwrite(&bytes, sizeof(bytes), 1, fp);
    end = a.offset + (int64_t) sizeof(bytes) + a.bytes;
  }
  platform::fseek(fp, start + end);
  fputs("\n</AppendedData>\n</VTKFile>\n", fp);
}

/* ---------------------------------------------------------------------- */

void VTKFile::write(int array, int64_t first, int64_t n, const double *values)
{
  const Array &a = arrays[array];
  const int bytes = types[a.type].bytes;
  platform::fseek(fp, start + a.offset + (int64_t) sizeof(uint64_t) + first * a.ncomponent * bytes);

  const int64_t total = n * a.ncomponent;
  buffer.resize(std::min(total, CHUNK) * bytes);
  for (int64_t done = 0; done < total; done += CHUNK) {
    const int64_t count = std::min(total - done, CHUNK);
    types[a.type].convert(values + done, count, buffer.data());
    fwrite(buffer.data(), bytes, count, fp);
  }
}

/* ---------------------------------------------------------------------- */

std::string VTKCollection::list_name(const std::string &pattern, const std::string &fallback,
                                     const std::string &suffix)
{
  const auto slash = pattern.find_last_of("/\\");
  const std::string dir = slash == std::string::npos ? "" : pattern.substr(0, slash + 1);
  std::string name = pattern.substr(dir.size());
  name.resize(name.rfind('.'));
  const auto star = name.find('*');
  std::string head = name.substr(0, star), tail = name.substr(star + 1);
  while (!head.empty() && strchr("._-", head.back())) head.pop_back();
  if (head.empty())
    while (!tail.empty() && strchr("._-", tail.front())) tail.erase(0, 1);
  name = head + tail;
  return dir + (name.empty() ? fallback : name) + suffix + ".pvd";
}

/** Entries of the list as it is; a file that cannot be read or is no list is ignored. */
void VTKCollection::read()
{
  FILE *fp = fopen(list.c_str(), "r");
  if (!fp) return;
  char line[4096], file[4096];
  double time;
  while (fgets(line, sizeof(line), fp))
    if (sscanf(line, " <DataSet timestep=\"%lg\" file=\"%4095[^\"]\"/>", &time, file) == 2)
      entries.push_back({file, time});
  fclose(fp);
}

std::string VTKCollection::add(const std::string &path, double time, int keep, bool append)
{
  if (append && !is_read) read();
  is_read = true;
  const std::string file = platform::path_basename(path);
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [&](const Entry &e) {
                                 return e.file == file;
                               }),
                entries.end());
  entries.push_back({file, time});
  if (keep > 0 && (int) entries.size() > keep) entries.erase(entries.begin(), entries.end() - keep);

  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
                                 "version=\"0.1\" byte_order=\"{}\">\n<Collection>\n",
                                 byte_order());
  for (const auto &e : entries)
    text += fmt::format("<DataSet timestep=\"{:.17g}\" file=\"{}\"/>\n", e.time, e.file);
  text += "</Collection>\n</VTKFile>\n";

  // write aside and rename, so that there is a complete list at any time

  const std::string aside = list + ".new";
  FILE *fp = fopen(aside.c_str(), "w");
  bool ok = fp && fwrite(text.data(), 1, text.size(), fp) == text.size();
  if (fp) ok = fclose(fp) == 0 && ok;
  ok = ok && rename(aside.c_str(), list.c_str()) == 0;
  return ok ? "" : fmt::format("cannot write the list of files {}: {}", list, strerror(errno));
}

/* ---------------------------------------------------------------------- */

ErrorWords::ErrorWords(LAMMPS *lmp, int narg, char **arg) :
    input(lmp->input), narg_before(input->narg), arg_before(input->arg), words(arg, arg + narg)
{
  words.push_back(nullptr);    // as in the list of the input
  input->narg = narg;
  input->arg = words.data();
}

ErrorWords::~ErrorWords()
{
  input->narg = narg_before;
  input->arg = arg_before;
}
