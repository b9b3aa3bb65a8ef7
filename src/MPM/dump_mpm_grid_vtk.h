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

#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
class VTKCollection;
}

namespace LAMMPS_NS {
class MPMField;

/** Node fields of one fix mpm at the nodes, as a VTK UnstructuredGrid of the cells in use.
 *
 *  The lattice is block-sparse: a node is written when it has mass, a cell when all its nodes
 *  are. Every node comes from the one process that owns it, in order of its indices, so that the
 *  file does not depend on the number of processes.
 */
class DumpMPMGridVTK : public Dump {
 public:
  DumpMPMGridVTK(class LAMMPS *, int, char **);
  ~DumpMPMGridVTK() override;

 protected:
  void init_style() override;
  int modify_param(int, char **) override;
  int count() override;
  void pack(tagint *) override;
  void write_header(bigint) override;
  void write_data(int, double *) override;
  void write_footer() override;

 private:
  enum Column { INDEX = 0, VELOCITY = 3, MASS = 6, NCOLUMN };    // of the rows that are gathered
  enum Field { NODE_MASS, NODE_VELOCITY, NODE_MOMENTUM, NODE_INDEX };

  std::string fix_id;
  MPMField *field;
  std::vector<Field> fields;
  bool single;
  std::unique_ptr<MPM_NS::VTKCollection> collection;
  std::vector<double> rows;    // of the present file

  template <typename Visitor> void visit_nodes(Visitor) const;
  MPMField *find_field() const;
};

}    // namespace LAMMPS_NS
#endif
#endif
