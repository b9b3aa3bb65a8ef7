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

/** An XML file of VTK with one piece. Its arrays are text, base64, or in an appended section of raw
 *  bytes or base64, with or without zlib compression. All errors are std::runtime_error that begin
 *  with the name of the file. */
class VtkXml {
 public:
  /** text: the whole file; name: its name. Both must outlive this object. */
  VtkXml(const std::string &text, const std::string &name);

  /** Type of the file: PolyData, UnstructuredGrid, ... */
  const std::string &type() const { return kind_of_file; }

  /** Position of a tag, <...>, in the text. */
  struct Tag {
    std::size_t begin, end;
    bool is_there() const { return begin != std::string::npos; }
  };
  /** The next tag between from and until that begins with head, if there is one; see
   *  Tag::is_there(). */
  Tag find_tag(const std::string &head, std::size_t from, std::size_t until) const;
  /** The next tag after from in the XML part that begins with head; it is an error if there is
   *  none. */
  Tag element(const std::string &head, std::size_t from) const;
  /** Value of an attribute of a tag; empty if there is none. */
  std::string attribute(const Tag &, const std::string &key) const;
  std::size_t end() const;

  /** To be called before arrays are read: checks byte order and compression, and finds the start of
   *  appended data. Returns the only piece. */
  Tag open();
  /** Number of points, cells, ... of the piece: the value of its attribute key. */
  uint64_t count(const Tag &piece, const std::string &key) const;

  struct Array {
    std::string name;
    int width;    ///< components of a tuple
    std::vector<double> values;
  };
  static constexpr uint64_t ANY = UINT64_MAX;
  /** Reads the arrays of a section of the piece, each with the given number of tuples (ANY: as many
   *  as there are). Returns none if there is no such section. */
  std::vector<Array> section(const std::string &name, uint64_t tuples) const;

  /** Throws std::runtime_error with the name of the file and this text. */
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
