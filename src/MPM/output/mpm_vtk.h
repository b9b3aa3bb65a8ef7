/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_VTK_H
#define LMP_MPM_VTK_H

// VTK XML files for the dump styles. This code does not depend on points or grids.

#include "base/mpm_options.h"
#include "error.h"
#include "update.h"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class Input;
}

namespace MPM_NS {

/** One VTK XML file whose data are bytes in an appended section. The positions of the data are
 *  known when the header is written, so that the values may come in any order and in pieces.
 *  Compressed data have no such positions: each array must come in order, blocks are compressed as
 *  they come, and are kept in memory until the end. */
class VTKFile {
 public:
  enum Type { INT64, UINT8, FLOAT64, FLOAT32 };

  /** kind: type of the data set, PolyData or UnstructuredGrid. */
  explicit VTKFile(const std::string &kind, bool compressed = false) :
      kind(kind), compressed(compressed)
  {
  }

  static bool can_compress();

  /** Describes what is wrong with the name of a dump file and how to correct it; empty if nothing
   *  is wrong. series: one file per snapshot, with a * for the time step; pieces: a % for the
   *  number of a piece is allowed. */
  static std::string name_error(const std::string &name, const std::string &extension, bool series,
                                bool pieces = false);

  /** The name without the % for the number of a piece, and without the dot or other separator
   *  before it. */
  static std::string without_percent(const std::string &name);

  /** Adds an array of ntuple tuples to a section (PointData, Points, Verts, Cells), and returns its
   *  number. */
  int add(const std::string &section, const std::string &name, Type type, int ncomponent,
          int64_t ntuple);

  /** Writes everything except for the values. piece: attributes of the piece, such as
   *  NumberOfPoints="8"; units: name of the units of all values. */
  void begin(FILE *fp, const std::string &piece, const std::string &units, double time,
             int64_t step);

  /** Writes n tuples of an array from tuple first on, converted to the type of the array. */
  void write(int array, int64_t first, int64_t n, const double *values);

  void end();

  /** Text of the file that lists pieces with these arrays; names: files of the pieces. */
  std::string list_of_pieces(const std::vector<std::string> &names) const;

 private:
  struct Array {
    std::string section, name;
    Type type;
    int ncomponent;
    int64_t offset;    // offset in the appended data of the lengths that precede the values
    int64_t bytes;     // of the values
    std::vector<char> pending = {};             // less than a block, not yet compressed
    std::vector<char> packed = {};              // compressed blocks
    std::vector<uint64_t> packed_sizes = {};    // of each
  };
  std::string kind;
  bool compressed;
  std::vector<Array> arrays;
  std::string head;    // up to the arrays
  FILE *fp = nullptr;
  int64_t start = 0;    // of the appended data in the file
  std::vector<char> buffer;

  void write_header();
  void pack(Array &);
};

/** ParaView's list of the files of a series with their times (.pvd). The list is valid after each
 *  step. */
class VTKCollection {
 public:
  /** Name of the list for files name.*.ext: name.pvd, or fallback.pvd if no name is left. suffix:
   *  goes before .pvd, for lists of different files with the same name. */
  static std::string list_name(const std::string &pattern, const std::string &fallback,
                               const std::string &suffix = "");

  explicit VTKCollection(const std::string &list) : list(list) {}

  /** Adds a file (path as opened, in the directory of the list) and writes the list. Only the last
   *  keep entries stay (0 or less: all). A file that is already listed gets the new time. append:
   *  continue a list that exists before the first call. Returns the text of an error, or an empty
   *  text. */
  std::string add(const std::string &file, double time, int keep, bool append);

 private:
  struct Entry {
    std::string file;
    double time;
  };
  std::string list;
  std::vector<Entry> entries;
  bool is_read = false;

  void read();
};

/** While this object exists, errors of LAMMPS that point to a word of the command point to a word
 *  of this command, and not of the one in the input. LAMMPS takes the word from the input without
 *  checking the number of words, and write_dump, an internal compute, and an internal list of
 *  columns have more words than that. */
class ErrorWords {
 public:
  /** arg: the narg words of this command. */
  ErrorWords(LAMMPS_NS::LAMMPS *, int narg, char **arg);
  ~ErrorWords();
  ErrorWords(const ErrorWords &) = delete;
  ErrorWords &operator=(const ErrorWords &) = delete;

 private:
  LAMMPS_NS::Input *input;
  int narg_before;
  char **arg_before;
  std::vector<char *> words;
};

}    // namespace MPM_NS

namespace LAMMPS_NS {

/** Reads compress yes|no of dump_modify. Returns 2, or 0 for any other keyword. */
int read_compress(LAMMPS *, int narg, char **arg, bool &compress);

/** Common part of the dump styles that write VTK files, whichever dump of LAMMPS they derive
 *  from. */
template <class Base> class DumpVTKSeries : public Base {
 protected:
  bool single = false;      // precision of reals
  bool compress = false;    // by zlib
  std::unique_ptr<MPM_NS::VTKCollection> collection;

  using Base::Base;

  /** Call at the end of the constructor. The dump gathers rows of numbers, not text, and adds its
   *  files to a list. */
  void begin_series(const std::string &suffix = "")
  {
    this->buffer_allow = this->buffer_flag = 0;
    this->binary = 1;
    if (strcmp(this->id, "WRITE_DUMP") == 0) return;
    const auto list = MPM_NS::VTKCollection::list_name(this->filename, this->id, suffix);
    collection = std::make_unique<MPM_NS::VTKCollection>(list);
  }

  int modify_param(int narg, char **arg) override
  {
    int n = read_precision(this->lmp, narg, arg, single);
    if (n == 0) n = read_compress(this->lmp, narg, arg, compress);
    return n > 0 ? n : Base::modify_param(narg, arg);
  }

  /** The file of this snapshot that goes to the list. */
  virtual std::string listed_file()
  {
    return utils::star_subst(this->filename, this->update->ntimestep, this->padflag);
  }

  void write_footer() override
  {
    fflush(this->fp);
    if (!collection || this->me != 0) return;
    const auto wrong =
        collection->add(listed_file(), this->compute_time(), this->maxfiles, this->append_flag);
    if (!wrong.empty()) this->error->one(FLERR, Error::NOLASTLINE, "Dump {} {}", this->id, wrong);
  }
};

}    // namespace LAMMPS_NS
#endif
