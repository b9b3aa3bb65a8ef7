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
#include "output/mpm_vtk.h"

#include <utility>

namespace LAMMPS_NS {

/** Points as VTK PolyData for ParaView: one file per snapshot, or several pieces with a list of
 *  them, and a list of all snapshots with their times.
 *
 *  A dump custom whose fields may have several components. Names of compute mpm/atom become columns
 *  of an internal compute, so that dump custom selects, sorts, and communicates the atoms.
 */
class DumpMPMVTK : public DumpVTKSeries<DumpCustom> {
 public:
  DumpMPMVTK(class LAMMPS *, int, char **);

 protected:
  void init_style() override;
  void write_header(bigint) override;
  void write_data(int, double *) override;
  void write_footer() override;
  std::string listed_file() override;

 private:
  /** An array of the file; its components are columns of dump custom. */
  struct Field {
    std::string name;
    std::vector<int> columns;
    bool integer;
  };

  /** The dump custom command that delivers the fields. */
  struct Request {
    LAMMPS *lmp;
    std::vector<std::string> words;
    std::vector<char *> args;
    std::vector<Field> fields;
    Field position;
    std::string compute;    // ID of the internal compute mpm/atom; empty: none
    std::unique_ptr<MPM_NS::ErrorWords> shown;    // until dump custom is made

    Request(LAMMPS *, int, char **);
    ~Request();
    Request(const Request &) = delete;
    Request &operator=(const Request &) = delete;
    int column(const std::string &);
    void add_field(const std::string &, int iarg);
  };

  const std::unique_ptr<Request> request;
  MPM_NS::VTKFile vtk{"PolyData"};    // arrays: fields, position, connectivity, offsets
  bigint nwritten = 0;                // points of the present file
  std::vector<double> values;
  int npiece = 1;    // files per snapshot, with a % in the name
  /** Lists of pieces, which are deleted together with the pieces, and the first piece of each. */
  std::vector<std::pair<std::string, std::string>> listed;

  void list_pieces();
  void write_field(const Field &, int array, int n, const double *rows);

  DumpMPMVTK(LAMMPS *, std::unique_ptr<Request>);
};

}    // namespace LAMMPS_NS
#endif
#endif
