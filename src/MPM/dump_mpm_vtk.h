/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef DUMP_CLASS
// clang-format off
DumpStyle(mpm/vtk,DumpMPMVTK);
// clang-format on
#else

#ifndef LMP_DUMP_MPM_VTK_H
#define LMP_DUMP_MPM_VTK_H

#include "dump_custom.h"

#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
class VTKCollection;
class VTKFile;
}    // namespace MPM_NS

namespace LAMMPS_NS {

/** Points as VTK PolyData for ParaView, one file per snapshot and a list with the times.
 *
 *  A dump custom with fields of more than one component. Names of compute mpm/atom become columns
 *  of an internal compute, so that selection of atoms, sorting, and communication are those of
 *  dump custom.
 */
class DumpMPMVTK : public DumpCustom {
 public:
  DumpMPMVTK(class LAMMPS *, int, char **);
  ~DumpMPMVTK() override;

 protected:
  void init_style() override;
  int modify_param(int, char **) override;
  void write_header(bigint) override;
  void write_data(int, double *) override;
  void write_footer() override;

 private:
  /** An array of the file: columns of dump custom that are its components. */
  struct Field {
    std::string name;
    std::vector<int> columns;
    bool integer;
  };

  /** A dump custom command that delivers the fields. */
  struct Request {
    LAMMPS *lmp;
    std::vector<std::string> words;
    std::vector<char *> args;
    std::vector<Field> fields;
    Field position;
    std::string compute;    // ID of the internal compute mpm/atom, empty: none

    Request(LAMMPS *, int, char **);
    ~Request();    // deletes the compute when it still has its ID
    Request(const Request &) = delete;
    Request &operator=(const Request &) = delete;
    int column(const std::string &);
    void add_field(const std::string &, int iarg);
  };

  std::vector<Field> fields;
  Field position;
  std::string compute_id;
  bool single;                             // precision of reals
  std::unique_ptr<MPM_NS::VTKFile> vtk;    // arrays: fields, position, connectivity, offsets
  std::unique_ptr<MPM_NS::VTKCollection> collection;
  bigint nwritten;    // points of the present file
  std::vector<double> values;

  void write_field(const Field &, int array, int n, const double *rows);

  DumpMPMVTK(LAMMPS *, Request &&);
};

}    // namespace LAMMPS_NS
#endif
#endif
