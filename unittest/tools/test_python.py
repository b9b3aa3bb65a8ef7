# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: examples build
# sanitize: no
# timeout: 60
"""The package in LAMMPS's Python module: examples/python, errors, and what is installed."""

import json
import os
import shutil
import tempfile

import mpm_testing as mt

BUILD = os.path.dirname(mt.LMP)
MODULE = os.path.join(BUILD, "python")
SCRIPT = os.path.join(mt.ROOT, "examples", "python", "python.py")
SHOW = """
import json
print("JSON", json.dumps([list(time), list(centre), list(force), float(m.sum()), most[0], most[1].tolist(), most[2].tolist()]))
"""


def python(text, module=MODULE, path=None):
    """output of a script, in a folder of its own, and the files that it has made"""
    if not os.path.exists(os.path.join(module, "lammps", "liblammps.so")):
        raise mt.Skip("not built: target mpm_python")
    for name in ("python3", "/usr/bin/python3"):
        if mt.run([name, "-c", "import numpy, matplotlib"]).code == 0:
            break
    else:
        raise mt.Skip("no Python with numpy and Matplotlib")
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "script.py"), "w") as file:
            file.write(text)
        shutil.copy(os.path.join(os.path.dirname(SCRIPT), "in.python"), folder)
        result = mt.run([name, "script.py"], folder, environment={"PYTHONPATH": module, "LAMMPS_POTENTIALS": ""})
        return result, sorted(os.listdir(folder))


def test_example():
    found, files = python(mt.read(SCRIPT) + SHOW)
    mt.ok(found)
    assert "python.png" in files, files
    data = [line for line in found.output.splitlines() if line.startswith("JSON")][0]
    time, centre, force, mass, lowest, x, stress = json.loads(data[4:])

    # area of the disk, by points of a quarter of a cell: 1 %
    assert abs(mass / (1000.0 * 3.14159265 * 0.2**2) - 1.0) < 0.01, mass
    # steps that begin with the velocity fall by g t dt/2 too far; dt becomes smaller as the disk becomes faster
    first = time[0] / 10
    for k, (t, y) in enumerate(zip(time, centre)):
        fall = 0.5 - 0.5 * 9.81 * t * t
        if fall > 0.2 + 0.04:
            last = (t - time[k - 1]) / 10 if k else first
            assert 0.999 * last < (fall - y) / (0.5 * 9.81 * t) < 1.001 * first, (t, y, fall)
            assert force[k] == 0.0, (t, force[k])
    assert min(centre) == lowest < 0.2 and max(centre[centre.index(lowest):]) > 0.25
    # the arrays are those of this moment: the centre of the copy, and points above the floor
    assert abs(sum(p[1] for p in x) / len(x) - lowest) < 1e-12 and len(stress) == len(x)
    assert min(p[1] for p in x) > -0.01 and max(stress) > 1.0e4


def test_errors_are_exceptions_and_materials_are_found():
    found, _ = python("""
from lammps import lammps
lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
lmp.commands_string('''units si
atom_style mpm
region box block 0 1 0 1 0 1
create_box 1 box
fix grid all mpm 0.5
create_points 1 box ppc 1
fix water all mpm/material file Water_Tait.mpm''')
print("points", lmp.get_natoms())
try:
    lmp.command("fix grid all mpm -1.0")
except Exception as error:
    print("refused:", error)
""")
    mt.ok(found)
    assert "points 8" in found.output, found.output
    assert "refused:" in found.output and "spacing must be positive" in found.output, found.output


def test_installed_module():
    with tempfile.TemporaryDirectory() as folder:
        if os.path.exists(os.path.join(MODULE, "lammps", "liblammps.so")):
            mt.ok(mt.run(["cmake", "--install", BUILD, "--prefix", folder]))
        modules = [path for path, _, names in os.walk(folder) if "liblammps.so" in names]
        found, _ = python("from lammps import lammps\n"
                          "print('fix mpm:', lammps(cmdargs=['-screen', 'none', '-log', 'none']).has_style('fix', 'mpm'))\n",
                          os.path.dirname(modules[0]) if modules else folder)
        assert "fix mpm: True" in mt.ok(found).output, found.output


mt.main(globals())
