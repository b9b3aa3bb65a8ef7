# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: unit output
"""Files of dump mpm/vtk and dump mpm/grid/vtk, as VTK itself reads them (skipped without python3-vtk9)."""

import os
import tempfile

import mpm_testing as mt

SCENE = """
units           lj
boundary        p f f
atom_style      mpm
neighbor        0.3 bin
region          box block 0 8 0 8 0 8
create_box      1 box
fix             grid all mpm 1.0
region          body block 2.5 5.5 2 5 1.5 4.5
create_points   1 region body ppc 2
fix             m all mpm/material density 1.0 neohookean 50.0 0.3
velocity        all set 0.7 0.1 -1.5
timestep        0.01
dump            points all mpm/vtk 20 s.*.vtp stress F velocity vonmises energy
dump_modify     points sort id
dump            nodes all mpm/grid/vtk 20 s.*.vtu grid mass velocity
dump            text all custom 20 s.*.txt id x y z vx
dump_modify     text sort id format float %.17g
run             20
"""


def read(reader, path):
    """data set, its point data, and its time"""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    points = data.GetPointData()
    arrays = {points.GetArrayName(k): vtk_to_numpy(points.GetArray(k)) for k in range(points.GetNumberOfArrays())}
    return data, arrays, data.GetFieldData().GetArray("TimeValue").GetTuple1(0)


def test_vtk_reads_the_files():
    try:
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
    except ImportError:
        raise mt.Skip("no python3-vtk9")

    with tempfile.TemporaryDirectory() as folder:
        mt.ok(mt.lammps(folder, SCENE, environment={"LD_LIBRARY_PATH": ""}))    # VTK may have its own
        with open(os.path.join(folder, "s.20.txt")) as file:
            rows = [[float(word) for word in line.split()] for line in file.readlines()[9:]]

        data, arrays, time = read(vtkXMLPolyDataReader(), os.path.join(folder, "s.20.vtp"))
        assert abs(time - 0.2) < 1e-15
        assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == len(rows) == 216
        assert {key: value.shape[1:] for key, value in arrays.items()} == {
            "id": (), "type": (), "stress": (9,), "F": (9,), "velocity": (3,), "vonmises": (), "energy": ()}
        for k, (tag, x, y, z, vx) in enumerate(rows):
            assert arrays["id"][k] == tag
            assert data.GetPoint(k) == (x, y, z)
            assert arrays["velocity"][k][0] == vx

        data, arrays, time = read(vtkXMLUnstructuredGridReader(), os.path.join(folder, "s.20.vtu"))
        assert abs(arrays["mass"].sum() - 27.0) < 1e-12
        assert data.GetNumberOfCells() > 27
        assert all(data.GetCellType(k) == 12 for k in range(data.GetNumberOfCells()))


mt.main(globals())
