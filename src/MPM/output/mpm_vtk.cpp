/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/mpm_vtk.h"

#include "fmt/format.h"
#include "input.h"
#include "lammps.h"
#include "platform.h"

#include <algorithm>
#include <cerrno>
#include <new>

#ifdef MPM_ZLIB
#include <zlib.h>
#endif

using namespace MPM_NS;
using namespace LAMMPS_NS;

static constexpr int64_t CHUNK = 65536;             // values converted at a time
static constexpr std::size_t BLOCK = 256 * 1024;    // bytes compressed at a time

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

std::string VTKFile::without_percent(const std::string &name)
{
  const auto at = name.find('%');
  if (at == std::string::npos) return name;
  const auto extension = name.rfind('.');    // its dot stays
  const auto separates = [&](std::size_t k) {
    return k < name.size() && k != extension && strchr("._-", name[k]);
  };
  if (at > 0 && separates(at - 1)) return name.substr(0, at - 1) + name.substr(at + 1);
  return name.substr(0, at) + name.substr(at + (separates(at + 1) ? 2 : 1));
}

std::string VTKFile::name_error(const std::string &name, const std::string &extension, bool series,
                                bool pieces)
{
  const std::string end = "." + extension;
  if (name.size() <= end.size() || name.compare(name.size() - end.size(), end.size(), end) != 0)
    return fmt::format("file name must end in {}: {}", end, name);
  const auto percent = name.find('%');
  if (percent != std::string::npos) {
    if (!pieces)
      return fmt::format("writes one file for all processes: remove % from file name {}", name);
    if (name.find('/', percent) != std::string::npos)
      return fmt::format("file name must have its % after the last /: {}", name);
    if (platform::path_basename(without_percent(name)) == end)
      return fmt::format("file name must have more than % before {}: {}", end, name);
  }
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

int LAMMPS_NS::read_compress(LAMMPS *lmp, int narg, char **arg, bool &compress)
{
  Options o("dump_modify");
  o.add("compress", {option::yes_no(compress)});
  if (!o.has(arg[0])) return 0;
  read_options(lmp, o, std::min(narg, 2), arg, 0);
  if (compress && !VTKFile::can_compress())
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "Files of a dump cannot be compressed: this LAMMPS was compiled without zlib");
  return 2;
}

int VTKFile::add(const std::string &section, const std::string &name, Type type, int ncomponent,
                 int64_t ntuple)
{
  arrays.push_back({section, name, type, ncomponent, 0, ntuple * ncomponent * types[type].bytes});
  return (int) arrays.size() - 1;
}

void VTKFile::begin(FILE *fp_in, const std::string &piece, const std::string &units, double time,
                    int64_t step)
{
  fp = fp_in;
  std::string codes;    // of characters, and the zero at the end
  for (const char c : units) codes += fmt::format("{} ", (int) c);
  head = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"{1}\" header_type=\"UInt64\"{6}>\n"
      "<{0}>\n"
      "<FieldData>\n"
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
      "{2:.17g}</DataArray>\n"
      "<DataArray type=\"Int64\" Name=\"TimeStep\" NumberOfTuples=\"1\" format=\"ascii\">"
      "{3}</DataArray>\n"
      "<Array type=\"String\" Name=\"Units\" NumberOfTuples=\"1\" format=\"ascii\">{4}0</Array>\n"
      "</FieldData>\n"
      "<Piece {5}>\n",
      kind, byte_order(), time, step, codes, piece,
      compressed ? " compressor=\"vtkZLibDataCompressor\"" : "");
  if (compressed) return;

  int64_t offset = 0;
  for (auto &a : arrays) {
    a.offset = offset;
    offset += (int64_t) sizeof(uint64_t) + a.bytes;
  }
  write_header();

  // lengths of the arrays, and the end of the file

  for (const auto &a : arrays) {
    const uint64_t bytes = a.bytes;
    platform::fseek(fp, start + a.offset);
    fwrite(&bytes, sizeof(bytes), 1, fp);
  }
  platform::fseek(fp, start + offset);
  fputs("\n</AppendedData>\n</VTKFile>\n", fp);
}

/** All before the appended data, when the places of the arrays are known. */
void VTKFile::write_header()
{
  std::string text = head, section;
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
}

void VTKFile::write(int array, int64_t first, int64_t n, const double *values)
{
  Array &a = arrays[array];
  const int bytes = types[a.type].bytes;
  if (!compressed)
    platform::fseek(fp,
                    start + a.offset + (int64_t) sizeof(uint64_t) + first * a.ncomponent * bytes);

  const int64_t total = n * a.ncomponent;
  buffer.resize(std::min(total, CHUNK) * bytes);
  for (int64_t done = 0; done < total; done += CHUNK) {
    const int64_t count = std::min(total - done, CHUNK);
    types[a.type].convert(values + done, count, buffer.data());
    if (!compressed) {
      fwrite(buffer.data(), bytes, count, fp);
      continue;
    }
    for (std::size_t at = 0, end = count * bytes; at < end;) {
      const auto part = std::min(end - at, BLOCK - a.pending.size());
      a.pending.insert(a.pending.end(), &buffer[at], &buffer[at] + part);
      if (a.pending.size() == BLOCK) pack(a);
      at += part;
    }
  }
}

#ifdef MPM_ZLIB

bool VTKFile::can_compress()
{
  return true;
}

/** Compresses a block. Higher levels than the fastest need two to six times its time, and do not
 *  make the files smaller: what helps is mostly that the upper bytes of numbers are equal. */
void VTKFile::pack(Array &a)
{
  uLongf size = compressBound(a.pending.size());
  const auto before = a.packed.size();
  a.packed.resize(before + size);
  if (compress2((Bytef *) &a.packed[before], &size, (const Bytef *) a.pending.data(),
                a.pending.size(), Z_BEST_SPEED) != Z_OK)
    throw std::bad_alloc();
  a.packed.resize(before + size);
  a.packed_sizes.push_back(size);
  a.pending.clear();
}

#else

bool VTKFile::can_compress()
{
  return false;
}

void VTKFile::pack(Array &) {}

#endif

/** Before the blocks of an array: their number, the size of all but the last and that of the
 *  last if it is smaller (or 0), not compressed, and the size of each, compressed. */
void VTKFile::end()
{
  if (!compressed) return;
  int64_t offset = 0;
  for (auto &a : arrays) {
    if (!a.pending.empty()) pack(a);
    a.offset = offset;
    offset += (int64_t) (sizeof(uint64_t) * (3 + a.packed_sizes.size()) + a.packed.size());
  }
  write_header();
  for (auto &a : arrays) {
    const uint64_t lengths[] = {a.packed_sizes.size(), BLOCK, a.bytes % BLOCK};
    fwrite(lengths, sizeof(uint64_t), 3, fp);
    if (a.packed.empty()) continue;
    fwrite(a.packed_sizes.data(), sizeof(uint64_t), a.packed_sizes.size(), fp);
    fwrite(a.packed.data(), 1, a.packed.size(), fp);
  }
  fputs("\n</AppendedData>\n</VTKFile>\n", fp);
  for (auto &a : arrays) {    // memory of the size of the file
    a.packed = std::vector<char>();
    a.pending = std::vector<char>();
  }
}

std::string VTKFile::list_of_pieces(const std::vector<std::string> &names) const
{
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n"
                                 "<VTKFile type=\"P{0}\" version=\"1.0\" byte_order=\"{1}\" "
                                 "header_type=\"UInt64\">\n<P{0} GhostLevel=\"0\">\n",
                                 kind, byte_order());
  for (const std::string section : {"PointData", "Points"}) {
    text += fmt::format("<P{}>\n", section);
    for (const auto &a : arrays)
      if (a.section == section)
        text += fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n",
                            types[a.type].name, a.name, a.ncomponent);
    text += fmt::format("</P{}>\n", section);
  }
  for (const auto &name : names) text += fmt::format("<Piece Source=\"{}\"/>\n", name);
  return text + fmt::format("</P{}>\n</VTKFile>\n", kind);
}

std::string VTKCollection::list_name(const std::string &pattern_with_percent,
                                     const std::string &fallback, const std::string &suffix)
{
  const auto pattern = VTKFile::without_percent(pattern_with_percent);
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
