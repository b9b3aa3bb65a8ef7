/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TABLE_VTK_XML_H
#define MPM_TABLE_VTK_XML_H

// Arrays of numbers in XML files of VTK. Nothing here knows about LAMMPS.

#include <cstdint>
#include <string>
#include <vector>

namespace MPM_NS {

/** An XML file of VTK with one piece. Its arrays are text, base64, or an appended section of bytes or base64, compressed by zlib or not.
 *  All errors are std::runtime_error that begin with the name of the file. */
class VtkXml {
 public:
  /** Of the whole file, which must live as long. */
  VtkXml(const std::string &text, const std::string &name);

  /** PolyData, UnstructuredGrid, ... */
  const std::string &type() const { return kind_of_file; }

  /** Of the text of a tag, <...>. */
  struct Tag {
    std::size_t begin, end;
    bool is_there() const { return begin != std::string::npos; }
  };
  /** The next tag that begins like this; there may be none. */
  Tag find_tag(const std::string &head, std::size_t from, std::size_t until) const;
  /** In what is XML; it must be there. */
  Tag element(const std::string &head, std::size_t from) const;
  /** Empty: there is none. */
  std::string attribute(const Tag &, const std::string &key) const;
  /** End of what is XML. */
  std::size_t end() const;

  /** Before arrays are read: order of bytes, compression, where bytes begin. Returns the only piece. */
  Tag open();
  /** A number of points or cells of the piece. */
  uint64_t count(const Tag &piece, const std::string &key) const;

  struct Array {
    std::string name;
    int width;    ///< components
    std::vector<double> values;
  };
  static constexpr uint64_t ANY = UINT64_MAX;
  /** The arrays of a section of the piece, of so many tuples each; ANY: however many there are. None if there is no such section. */
  std::vector<Array> section(const std::string &name, uint64_t tuples) const;

  [[noreturn]] void fail(const std::string &what) const;

 private:
  const std::string &text, &name;
  Tag root;
  std::string kind_of_file;
  bool wide = false, compressed = false, in_base64 = false;
  std::size_t appended_tag = std::string::npos, appended = std::string::npos;

  class Bytes;
  void find_appended();
  std::vector<double> read_array(const Tag &, const std::string &what, uint64_t numbers) const;
  std::vector<double> read_text(const Tag &, const std::string &what, uint64_t numbers) const;
  std::string read_bytes(Bytes &, const std::string &what) const;
  std::string uncompressed(Bytes &, const std::string &what) const;
};

}    // namespace MPM_NS
#endif
