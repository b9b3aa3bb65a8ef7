/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/dump_mpm_grid_vtk.h"

#include "base/mpm_options.h"
#include "field/mpm_field.h"
#include "fix.h"
#include "modify.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

const std::vector<DumpMPMGridVTK::Quantity> DumpMPMGridVTK::known = {
    {"mass", MASS, 1}, {"velocity", VELOCITY, 3}, {"momentum", VELOCITY, 3}, {"index", INDEX, 3}};

/** dump ID all mpm/grid/vtk N file.*.vtu FIXID field ... */
DumpMPMGridVTK::DumpMPMGridVTK(LAMMPS *lmp, int narg, char **arg) : DumpVTKSeries(lmp, narg, arg)
{
  const ErrorWords these(lmp, narg, arg);
  require_arguments(lmp, "dump mpm/grid/vtk", narg, 3, {"N", "file", "fix-ID", "field"});
  if (igroup != 0)
    error->all(FLERR, 1, "Dump mpm/grid/vtk requires group all: the fix mpm selects the nodes");
  if (utils::inumeric(FLERR, arg[3], false, lmp) <= 0)
    error->all(FLERR, 3, "Illegal dump mpm/grid/vtk command: output frequency must be > 0");

  const auto wrong = VTKFile::name_error(filename, "vtu", strcmp(id, "WRITE_DUMP") != 0);
  if (!wrong.empty()) error->all(FLERR, 4, "Dump mpm/grid/vtk {}", wrong);
  begin_series(".grid");

  fix_id = arg[5];
  find_field();

  for (int iarg = 6; iarg < narg; iarg++) {
    const auto is_named = [&](const Quantity &each) {
      return each.name == arg[iarg];
    };
    const auto found = std::find_if(known.begin(), known.end(), is_named);
    if (found == known.end())
      error->all(FLERR, iarg,
                 "Unknown dump mpm/grid/vtk field {}: must be one of mass velocity "
                 "momentum index",
                 arg[iarg]);
    if (std::none_of(fields.begin(), fields.end(), is_named)) fields.push_back(*found);
  }
  size_one = NCOLUMN;
}

MPMField *DumpMPMGridVTK::find_field() const
{
  auto *fix = modify->get_fix_by_id(fix_id);
  if (!fix)
    error->all(FLERR, Error::NOLASTLINE, "Dump mpm/grid/vtk {} fix ID {} does not exist", id,
               fix_id);
  auto *found = MPMField::find(lmp, fix_id);
  if (!found)
    error->all(FLERR, Error::NOLASTLINE, "Dump mpm/grid/vtk {} fix {} is of style {}, not mpm", id,
               fix_id, fix->style);
  return found;
}

void DumpMPMGridVTK::init_style()
{
  field = find_field();
  if (sort_flag)
    error->all(FLERR, Error::NOLASTLINE,
               "Dump mpm/grid/vtk {} sorts nodes by index: remove dump_modify sort", id);
  write_header_flag = 1;
  if (multifile == 0) openfile();
}

/** Rows of all nodes with mass that this process owns. */
int DumpMPMGridVTK::count()
{
  rows.clear();
  auto &grid = field->grid;
  for (int64_t n = 0; n < grid.nnodes() && grid.nreal; n++) {
    const double *record = grid.record(n);
    if (!grid.owns(n) || !(record[3] > 0.0)) continue;
    int index[3];
    grid.node_index(n, index);
    rows.insert(rows.end(), index, index + 3);
    rows.insert(rows.end(), record, record + 4);
  }
  return (int) (rows.size() / NCOLUMN);
}

void DumpMPMGridVTK::pack(tagint *)
{
  std::copy(rows.begin(), rows.end(), buf);
}

/** The process that writes collects all rows, since cells need the nodes of all processes. */
void DumpMPMGridVTK::write_header(bigint nnode)
{
  rows.clear();
  rows.reserve(nnode * NCOLUMN);
}

void DumpMPMGridVTK::write_data(int n, double *more)
{
  rows.insert(rows.end(), more, more + (bigint) n * NCOLUMN);
}

void DumpMPMGridVTK::write_footer()
{
  const int dim = field->lattice.dim;
  const bigint nnode = (bigint) rows.size() / NCOLUMN;
  auto before = [](const double *a, const double *b) {
    return std::lexicographical_compare(a, a + 3, b, b + 3);
  };

  std::vector<const double *> node(nnode);
  for (bigint i = 0; i < nnode; i++) node[i] = &rows[i * NCOLUMN];
  std::sort(node.begin(), node.end(), before);

  // cells: a node and those one step up in all directions, in the order of VTK

  static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const int ncorner = dim == 3 ? 8 : 4;
  std::vector<double> connectivity, offsets;
  for (bigint i = 0; i < nnode; i++) {
    double cell[8];
    int k = 0;
    for (; k < ncorner; k++) {
      const double index[3] = {node[i][0] + corner[k][0], node[i][1] + corner[k][1],
                               node[i][2] + corner[k][2]};
      const auto found = std::lower_bound(node.begin() + i, node.end(), index, before);
      if (found == node.end() || before(index, *found)) break;
      cell[k] = (double) (found - node.begin());
    }
    if (k < ncorner) continue;
    connectivity.insert(connectivity.end(), cell, cell + ncorner);
    offsets.push_back((double) connectivity.size());
  }
  const bigint ncell = (bigint) offsets.size();

  const auto real = single ? VTKFile::FLOAT32 : VTKFile::FLOAT64;
  VTKFile vtk("UnstructuredGrid", compress);
  for (const auto &f : fields)
    vtk.add("PointData", f.name, f.column == INDEX ? VTKFile::INT64 : real, f.ncomponent, nnode);
  const int points = vtk.add("Points", "Points", real, 3, nnode);
  const int cells = vtk.add("Cells", "connectivity", VTKFile::INT64, 1, ncell * ncorner);
  vtk.add("Cells", "offsets", VTKFile::INT64, 1, ncell);
  vtk.add("Cells", "types", VTKFile::UINT8, 1, ncell);
  vtk.begin(fp, fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", nnode, ncell),
            update->unit_style, compute_time(), update->ntimestep);

  std::vector<double> values;
  for (std::size_t k = 0; k < fields.size(); k++) {
    const bool momentum = fields[k].name == "momentum";
    values.clear();
    for (const double *n : node)
      for (int d = 0; d < fields[k].ncomponent; d++)
        values.push_back((momentum ? n[MASS] : 1.0) * n[fields[k].column + d]);
    vtk.write((int) k, 0, nnode, values.data());
  }

  values.clear();
  for (const double *n : node) {
    const int index[3] = {(int) n[0], (int) n[1], (int) n[2]};
    double x[3];
    field->lattice.node_position(index, x);
    values.insert(values.end(), x, x + 3);
  }
  vtk.write(points, 0, nnode, values.data());

  static constexpr double VTK_QUAD = 9, VTK_HEXAHEDRON = 12;
  vtk.write(cells, 0, ncell * ncorner, connectivity.data());
  vtk.write(cells + 1, 0, ncell, offsets.data());
  values.assign(ncell, dim == 3 ? VTK_HEXAHEDRON : VTK_QUAD);
  vtk.write(cells + 2, 0, ncell, values.data());
  vtk.end();
  DumpVTKSeries::write_footer();
}
