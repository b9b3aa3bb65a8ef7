# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: unit output mpi
"""Files of dump mpm/vtk and dump mpm/grid/vtk, as VTK itself reads them (skipped without python3-vtk9), and compressed
ones as Python's zlib does: the same bytes as without compression."""

import os
import sys
import tempfile

import mpm_testing as mt

sys.path.insert(0, os.path.join(mt.ROOT, "tools"))

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
dump            packed all mpm/vtk 20 p.*.vtp stress F velocity vonmises energy
dump_modify     packed sort id compress yes
dump            packed_nodes all mpm/grid/vtk 20 p.*.vtu grid mass velocity
dump_modify     packed_nodes compress yes
dump            text all custom 20 s.*.txt id x y z vx
dump_modify     text sort id format float %.17g
run             20
"""


def arrays_of(reader, path):
    """point data by their names, and positions with an empty one"""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    points = data.GetPointData()
    arrays = {points.GetArrayName(k): vtk_to_numpy(points.GetArray(k)) for k in range(points.GetNumberOfArrays())}
    arrays[""] = vtk_to_numpy(data.GetPoints().GetData())
    return arrays


def read(reader, path):
    """data set, its point data, and its time"""
    arrays = arrays_of(reader, path)
    data = reader.GetOutput()
    assert data.GetFieldData().GetAbstractArray("Units").GetValue(0) in ("lj", "micro")
    return data, arrays, data.GetFieldData().GetArray("TimeValue").GetTuple1(0)


def same(a, b):
    assert a.keys() == b.keys()
    for name in a:
        assert a[name].dtype == b[name].dtype and a[name].tobytes() == b[name].tobytes(), name


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
            "": (3,), "id": (), "type": (), "stress": (9,), "F": (9,), "velocity": (3,), "vonmises": (), "energy": ()}
        for k, (tag, x, y, z, vx) in enumerate(rows):
            assert arrays["id"][k] == tag
            assert data.GetPoint(k) == (x, y, z)
            assert arrays["velocity"][k][0] == vx
        same(arrays, read(vtkXMLPolyDataReader(), os.path.join(folder, "p.20.vtp"))[1])

        data, arrays, time = read(vtkXMLUnstructuredGridReader(), os.path.join(folder, "s.20.vtu"))
        assert abs(arrays["mass"].sum() - 27.0) < 1e-12
        assert data.GetNumberOfCells() > 27
        assert all(data.GetCellType(k) == 12 for k in range(data.GetNumberOfCells()))
        same(arrays, read(vtkXMLUnstructuredGridReader(), os.path.join(folder, "p.20.vtu"))[1])


# 6400 points, so that an array has more than one block of 256 KiB, and points that move between processes
PLANE = """
units           micro
dimension       2
boundary        f f p
atom_style      mpm
neighbor        0.3 bin
region          box block 0 48 0 48 -0.5 0.5
create_box      1 box
fix             grid all mpm 1.0
region          body block 2 42 2 42 INF INF
create_points   1 region body ppc 2
fix             m all mpm/material density 1.0 neohookean 50.0 0.3
velocity        all ramp vx 1 3 y 0 48
timestep        0.02
group           none empty
run             20
"""
WRITE = "write_dump %s mpm/vtk %s.vtp F velocity modify sort id precision %s compress %s\n"
NODES = """dump %s all mpm/grid/vtk 5 %s.*.vtu grid mass velocity momentum index
dump_modify %s precision single compress %s
"""


def check_compressed(processes):
    import picture
    with tempfile.TemporaryDirectory() as folder:
        text = PLANE
        for precision in ("single", "double"):
            text += WRITE % ("all", precision, precision, "no") + WRITE % ("all", precision + "_packed", precision, "yes")
        text += WRITE % ("none", "none", "double", "yes") + NODES % ("n", "n", "n", "no") + NODES % ("m", "m", "m", "yes")
        mt.ok(mt.lammps(folder, text + "run 5\n", processes=processes))

        def snapshot(name):
            found = picture.read_vtp(os.path.join(folder, name))
            return dict(found.fields, x=found.x, time=found.time, unit=found.length.name)

        for name, packed in (("single.vtp", "single_packed.vtp"), ("double.vtp", "double_packed.vtp"), ("n.25.vtu", "m.25.vtu")):
            a, b = snapshot(name), snapshot(packed)
            assert a.keys() == b.keys() and len(a) > 6
            for key in a:
                assert a[key] == b[key] if key in ("time", "unit") else a[key].tobytes() == b[key].tobytes(), key
            assert a["unit"] == "um" and a["time"] == (0.5 if "vtu" in name else 0.4)
            sizes = [os.path.getsize(os.path.join(folder, each)) for each in (name, packed)]
            assert sizes[1] < 0.6 * sizes[0], sizes
        assert len(a["x"]) > 1000 and len(snapshot("double_packed.vtp")["x"]) == 6400
        assert len(snapshot("none.vtp")["x"]) == 0


PIECES = """dump %s all mpm/vtk 5 %s F velocity
dump_modify %s %s
"""


def by_id(arrays):
    import numpy
    order = numpy.argsort(arrays["id"])
    return {name: array[order] for name, array in arrays.items()}


def test_pieces_of_three_processes():
    import picture
    with tempfile.TemporaryDirectory() as folder:
        text = PLANE + "write_dump all mpm/vtk end.%.vtp F velocity modify sort id\n" + WRITE % ("all", "end", "double", "no")
        text += PIECES % ("one", "one.*.vtp", "one", "sort id") + PIECES % ("each", "each.%.*.vtp", "each", "sort id maxfiles 1 compress yes")
        text += "write_dump all mpm/vtk last%.vtp F velocity modify sort id\n" + PIECES % ("star", "star.*%.vtp", "star", "pad 4")
        text += PIECES % ("two", "two.*.%.vtp", "two", "nfile 2 pad 4") + PIECES % ("none", "none.%.*.vtp", "none", "thresh x > 99 sort id")
        mt.ok(mt.lammps(folder, text + "run 5\n", processes=3))
        names = set(os.listdir(folder))
        assert {name for name in names if name.startswith("each")} == {
            "each.pvd", "each.25.pvtp", "each.0.25.vtp", "each.1.25.vtp", "each.2.25.vtp"}
        assert {"last.pvtp", "last0.vtp", "star.pvd", "star.0025.pvtp", "star.00252.vtp"} < names, names
        assert {name for name in names if name.startswith("two")} == {
            "two.pvd", "two.0020.pvtp", "two.0020.0.vtp", "two.0020.1.vtp", "two.0025.pvtp", "two.0025.0.vtp", "two.0025.1.vtp"}
        one = picture.read_series(os.path.join(folder, "one.pvd"))
        for a, b in ((one[1], picture.read_series(os.path.join(folder, "each.pvd"))[0]),
                     (one[1], picture.read_series(os.path.join(folder, "two.pvd"))[1]),
                     (picture.read_vtp(os.path.join(folder, "end.vtp")), picture.read_vtp(os.path.join(folder, "end.pvtp")))):
            assert a.time == b.time and a.length.name == b.length.name == "um" and len(a.x) == 6400
            same(dict(a.fields, x=a.x), by_id(dict(b.fields, x=b.x)))
        assert len(picture.read_series(os.path.join(folder, "none.pvd"))[0].x) == 0
        try:
            from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPPolyDataReader
        except ImportError:
            return
        for a, b in (("one.25.vtp", "each.25.pvtp"), ("one.25.vtp", "two.0025.pvtp")):
            a, b = read(vtkXMLPolyDataReader(), os.path.join(folder, a))[1], arrays_of(vtkXMLPPolyDataReader(), os.path.join(folder, b))
            same(a, by_id(b))


def test_lists_go_with_their_pieces():
    # a dump that is told anew how many files to keep leaves those that are there
    with tempfile.TemporaryDirectory() as folder:
        text = PLANE + PIECES % ("d", "d.%.*.vtp", "d", "maxfiles 2") + "run 15\ndump_modify d maxfiles 1\nrun 15\n"
        mt.ok(mt.lammps(folder, text, processes=2))
        assert set(os.listdir(folder)) >= {"d.pvd"}
        kept = sorted(name for name in os.listdir(folder) if name.startswith("d.") and name != "d.pvd")
        assert kept == sorted(form % step for step in (30, 35, 50) for form in ("d.%d.pvtp", "d.0.%d.vtp", "d.1.%d.vtp")), kept


def test_compressed_files():
    check_compressed(0)


def test_compressed_files_of_two_processes():
    check_compressed(2)


mt.main(globals())
