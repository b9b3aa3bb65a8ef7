// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_MESH_TESTING_H
#define MPM_MESH_TESTING_H

// One mesh in the file formats of several programs.

#include "mpm_lammps.h"

#include <sstream>

namespace MPM_TEST {

// a cube with one corner pulled out, V = 1.25, and a tetrahedron on one of its sides, V = 1/6
const double nodes[9][3] = {{0, 0, 0}, {1, 0, 0},       {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
                            {1, 0, 1}, {1.5, 1.3, 1.2}, {0, 1, 1}, {-1, 0, 0}};
const int cube[8] = {0, 1, 2, 3, 4, 5, 6, 7}, tet[4] = {0, 3, 4, 8};
constexpr double VOLUME = 1.25 + 1.0 / 6.0;

/** A file of numbers as text, or as bytes, the least (LITTLE) or most significant (BIG) first. */
struct MeshOutput {
  enum Kind { TEXT, LITTLE, BIG } kind;
  std::string all;
  template <class T> void put(T value)
  {
    if (kind == TEXT) {
      std::ostringstream word;
      word.precision(17);
      word << value << " ";
      all += word.str();
      return;
    }
    char raw[sizeof(T)];
    memcpy(raw, &value, sizeof(T));
    if (kind == BIG) std::reverse(raw, raw + sizeof(T));
    all.append(raw, sizeof(T));
  }
  void i(int value) { put((int32_t) value); }
  void l(int64_t value) { put(value); }
  void x(const double *p)
  {
    for (int d = 0; d < 3; d++) put(p[d]);
  }
};

/** The mesh as a file of Gmsh, of format 2.2 (old) or 4.1. */
inline std::string gmsh(bool old, MeshOutput::Kind kind)
{
  MeshOutput o{kind,
               strprintf("$MeshFormat\n%s %d 8\n", old ? "2.2" : "4.1", kind != MeshOutput::TEXT)};
  if (kind != MeshOutput::TEXT) {
    o.i(1);
    o.all += "\n";
  }
  o.all +=
      "$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"core\"\n3 2 \"side part\"\n$EndPhysicalNames\n";
  if (old) {
    o.all += "$Nodes\n9\n";
    for (int n = 0; n < 9; n++) {
      o.i(n + 1);
      o.x(nodes[n]);
    }
    o.all += "\n$EndNodes\n$Elements\n2\n";
    for (const bool first : {true, false}) {
      const int number = first ? 1 : 2, type = first ? 5 : 4;
      if (kind == MeshOutput::TEXT)
        for (const int v : {number, type, 2}) o.i(v);
      else
        for (const int v : {type, 1, 2, number}) o.i(v);
      o.i(number);
      o.i(number);
      for (int k = 0; k < (first ? 8 : 4); k++) o.i((first ? cube : tet)[k] + 1);
    }
  } else {
    o.all += "$Entities\n";
    for (const int n : {0, 0, 0, 2}) o.l(n);
    for (const int n : {1, 2}) {
      o.i(n);
      o.x(nodes[0]);
      o.x(nodes[6]);
      o.l(1);
      o.i(n);
      o.l(0);
    }
    o.all += "\n$EndEntities\n$Nodes\n";
    for (const int n : {1, 9, 1, 9}) o.l(n);
    for (const int n : {3, 1, 0}) o.i(n);
    o.l(9);
    for (int n = 0; n < 9; n++) o.l(n + 1);
    for (const auto &x : nodes) o.x(x);
    o.all += "\n$EndNodes\n$Elements\n";
    for (const int n : {2, 2, 1, 2}) o.l(n);
    for (const bool first : {true, false}) {
      for (const int n : {3, first ? 1 : 2, first ? 5 : 4}) o.i(n);
      o.l(1);
      o.l(first ? 1 : 2);
      for (int k = 0; k < (first ? 8 : 4); k++) o.l((first ? cube : tet)[k] + 1);
    }
  }
  return o.all + "\n$EndElements\n";
}

/** The mesh as a legacy VTK file, of version 3.0 (old) or 5.1, with data at points and in cells. */
inline std::string vtk(bool old, MeshOutput::Kind kind)
{
  MeshOutput o{kind, old ? "# vtk DataFile Version 3.0\n" : "# vtk DataFile Version 5.1\n"};
  o.all += std::string("title\n") + (kind == MeshOutput::TEXT ? "ASCII" : "BINARY") +
      "\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n";
  for (const auto &x : nodes) o.x(x);
  if (old) {
    o.all += "\nCELLS 2 14\n";
    o.i(8);
    for (const int n : cube) o.i(n);
    o.i(4);
    for (const int n : tet) o.i(n);
  } else {
    o.all += "\nCELLS 3 12\nOFFSETS vtktypeint64\n";
    for (const int n : {0, 8, 12}) o.l(n);
    o.all += "\nCONNECTIVITY vtktypeint64\n";
    for (const int n : cube) o.l(n);
    for (const int n : tet) o.l(n);
  }
  o.all += "\nCELL_TYPES 2\n";
  o.i(12);
  o.i(10);
  o.all += "\nPOINT_DATA 9\nSCALARS number float 1\nLOOKUP_TABLE default\n";
  for (int n = 0; n < 9; n++) o.put((float) n);
  o.all += "\nCELL_DATA 2\nVECTORS speed double\n";
  for (const double v : {1.0, 2.0, 3.0, -4.0, -5.0, -6.0}) o.put(v);
  o.all += "\nFIELD more 1\nlabel 1 2 int\n";
  o.i(7);
  o.i(9);
  return o.all + "\n";
}

/** Bytes in base64 encoding, padded to groups of four characters. */
inline std::string base64(const std::string &bytes)
{
  static const char *const digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    uint32_t all = 0;
    for (int j = 0; j < 3; j++)
      all = all << 8 | (k + j < bytes.size() ? (unsigned char) bytes[k + j] : 0u);
    for (int j = 0; j < 4; j++)
      text += k + j > bytes.size() ? '=' : digits[all >> (18 - 6 * j) & 63];
  }
  return text;
}

/** The mesh as an XML file of VTK, little-endian. format: "ascii" (numbers as text), "binary"
 *  (base64 inside of the tags), or "base64" or "raw" (data after the tags). */
inline std::string vtu(const std::string &format)
{
  const bool ascii = format == "ascii", inside = ascii || format == "binary";
  std::string behind;
  const auto array = [&](const std::string &type, const std::string &name, int width,
                         const std::vector<double> &values) {
    MeshOutput o{ascii ? MeshOutput::TEXT : MeshOutput::LITTLE, ""};
    for (const double v : values) {
      if (ascii || type == "Float64") o.put(v);
      if (ascii) continue;
      if (type == "Float32") o.put((float) v);
      if (type == "Int64") o.l((int64_t) v);
      if (type == "Int32") o.i((int) v);
      if (type == "UInt8") o.put((uint8_t) v);
    }
    const std::string head =
        strprintf("<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"%s\"",
                  type.c_str(), name.c_str(), width, inside ? format.c_str() : "appended");
    MeshOutput length{MeshOutput::LITTLE, ""};
    length.i((int) o.all.size());
    if (ascii) return head + ">" + o.all + "</DataArray>\n";
    if (inside) return head + ">\n " + base64(length.all + o.all) + "\n</DataArray>\n";
    const std::string place = strprintf(" offset=\"%d\"/>\n", (int) behind.size());
    behind += format == "raw" ? length.all + o.all : base64(length.all + o.all);
    return head + place;
  };
  std::vector<double> x, number, joined;
  for (int n = 0; n < 9; n++) {
    x.insert(x.end(), nodes[n], nodes[n] + 3);
    number.push_back(n);
  }
  joined.insert(joined.end(), cube, cube + 8);
  joined.insert(joined.end(), tet, tet + 4);
  const std::string body = "<PointData>\n" + array("Float32", "number", 1, number) +
      "</PointData>\n<CellData>\n" + array("Float64", "speed", 3, {1, 2, 3, -4, -5, -6}) +
      array("Int32", "label", 1, {7, 9}) + "</CellData>\n<Points>\n" +
      array("Float64", "Points", 3, x) + "</Points>\n<Cells>\n" +
      array("Int64", "connectivity", 1, joined) + array("Int64", "offsets", 1, {8, 12}) +
      array("UInt8", "types", 1, {12, 10}) + "</Cells>\n";
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"9\" "
         "NumberOfCells=\"2\">\n" +
      body + "</Piece>\n</UnstructuredGrid>\n" +
      (inside ? ""
              : "<AppendedData encoding=\"" + format + "\">\n_" + behind + "\n</AppendedData>\n") +
      "</VTKFile>\n";
}

/** The mesh as an input file of Abaqus. */
inline std::string abaqus()
{
  std::string s = "** a comment\n*Heading\n text, 1, 2\n*Node\n";
  for (int n = 0; n < 9; n++)
    s += strprintf("%d, %.17g, %.17g, %.17g\n", n + 1, nodes[n][0], nodes[n][1], nodes[n][2]);
  return s +
      "*ELSET, elset=All, generate\n1, 2, 1\n*Element, type=C3D8R, elset=core\n1, 1, 2, 3, 4,\n"
      " 5, 6, 7, 8\n*Element, type=C3D4\n2, 1, 4, 5, 9\n*Elset, elset=side\n2,\n*Material, name=m\n"
      "*Elastic\n1.0, 0.3\n";
}

}    // namespace MPM_TEST
#endif
