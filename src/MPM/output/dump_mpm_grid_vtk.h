/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef DUMP_CLASS
// clang-format off
DumpStyle(mpm/grid/vtk,DumpMPMGridVTK);
// clang-format on
#else

#ifndef LMP_DUMP_MPM_GRID_VTK_H
#define LMP_DUMP_MPM_GRID_VTK_H

#include "dump.h"
#include "output/mpm_vtk.h"

namespace LAMMPS_NS {
class MPMField;

/** Node fields of one fix mpm, as a VTK UnstructuredGrid of the cells in use.
 *
 *  The lattice is block-sparse: a node is written if it has mass, and a cell if all its nodes are
 *  written. Each node comes from the process that owns it, in the order of indices, so that the
 *  file does not depend on the number of processes.
 */
class DumpMPMGridVTK : public DumpVTKSeries<Dump> {
 public:
  DumpMPMGridVTK(class LAMMPS *, int, char **);

 protected:
  void init_style() override;
  int count() override;
  void pack(tagint *) override;
  void write_header(bigint) override;
  void write_data(int, double *) override;
  void write_footer() override;

 private:
  enum Column { INDEX = 0, VELOCITY = 3, MASS = 6, NCOLUMN };    // of the row of a node

  struct Quantity {
    std::string name;
    int column, ncomponent;    // in the rows
  };

  std::string fix_id;
  MPMField *field = nullptr;
  static const std::vector<Quantity> known;
  std::vector<Quantity> fields;
  std::vector<double> rows;    // of this process, then of the whole file

  MPMField *find_field() const;
};

}    // namespace LAMMPS_NS
#endif
#endif
