# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: plugin smoke
# sanitize: no
# timeout: 300
"""mpmplugin.so in a stock LAMMPS does what the package does when it is compiled in."""

import glob
import os
import tempfile

import mpm_testing as mt

PLUGIN = os.environ.get("MPM_PLUGIN", "")
STOCK = os.environ.get("MPM_STOCK_LMP", "")

# two bodies collide, twice in a replicated box; the run goes on after clear from a restart file
SCENE = """
units           lj
boundary        p p f
atom_style      {style}
neighbor        0.3 bin
region          box block 0 8 0 8 0 8
create_box      2 box
fix             grid all mpm 1.0
region          one sphere 2.6 3.0 3.2 1.9
region          two block 4.8 7.3 2.0 5.0 2.5 5.5
create_points   1 region one ppc 2
create_points   2 region two ppc 2
unfix           grid
replicate       2 1 1
{fixes}
velocity        one set 0.6 0.35 -0.4
velocity        two set -1.5 0.1 -0.3
{output}
dump            vtk all mpm/vtk 50 points.*.vtp pressure eplastic
run             100
write_restart   scene.restart
clear
read_restart    scene.restart
neighbor        0.3 bin
{fixes}
{output}
run             100
"""
FIXES = """group           one type 1
group           two type 2
fix             grid all mpm 1.0
fix             soft one mpm/material density 1.0 neohookean 10.0 0.3
fix             metal two mpm/material density 2.0 eos linear 20.0 strength j2 5.0 0.05
fix             floor all mpm/boundary zlo slip
fix             step all mpm/dt 0.3
"""
OUTPUT = """compute         e all mpm/energy
compute         p all mpm/atom eplastic vonmises
compute         m all reduce max c_p[*]
thermo          10
thermo_style    custom step time dt atoms ke c_e c_e[2] c_e[3] c_m[*] f_floor[3]
thermo_modify   format float %20.15g
"""


def scene(style="mpm"):
    return SCENE.format(style=style, output=OUTPUT, fixes=FIXES)


def need(*files):
    for file in files:
        if not os.path.exists(file):
            raise mt.Skip("not built: '%s'" % file)


def same_thermo(text, in_tree_text, environment):
    expected = mt.ok(mt.lammps_once(in_tree_text))
    found = mt.ok(mt.lammps_once(text, executable=STOCK, environment=environment))
    a, b = mt.thermo(expected.output), mt.thermo(found.output)
    assert len(a) == 2, expected.tail(200)
    assert a == b, "%s\n\n%s" % (a, b)
    for names, rows in a:
        assert len(rows) == 11, rows
        assert len(names) >= 10
    return found


def test_stock_lammps_has_no_mpm():
    need(STOCK)
    found = mt.lammps_once("atom_style mpm\n", executable=STOCK)
    assert found.code != 0 and "Unrecognized atom style 'mpm'" in found.output, found.tail()


def test_plugin_path_survives_clear():
    need(PLUGIN, STOCK)
    path = {"LAMMPS_PLUGIN_PATH": os.path.dirname(PLUGIN)}
    same_thermo(scene(), scene(), path)
    same_thermo(scene("hybrid sphere mpm"), scene("hybrid sphere mpm"), path)


def test_plugin_load_command():
    need(PLUGIN, STOCK)
    load = "plugin load %s\n" % PLUGIN
    text = load + scene().replace("clear\n", "clear\n" + load)
    found = same_thermo(text, scene(), {"LAMMPS_PLUGIN_PATH": ""})
    assert "WARNING: Overriding" not in found.output, found.output


def test_dumps_are_those_of_the_package():
    need(PLUGIN, STOCK)

    files = []
    for executable, path in ((mt.LMP, ""), (STOCK, os.path.dirname(PLUGIN))):
        with tempfile.TemporaryDirectory() as folder:
            mt.ok(mt.lammps(folder, scene(), executable=executable, environment={"LAMMPS_PLUGIN_PATH": path}))
            names = sorted(glob.glob(os.path.join(folder, "points.*.vtp")))
            assert len(names) == 3, names
            files.append([open(name, "rb").read() for name in names])
    assert files[0] == files[1]


def test_unload_while_in_use():
    need(PLUGIN, STOCK)
    text = "plugin load %s\n" % PLUGIN + scene().split("write_restart")[0]
    text += "plugin unload fix mpm\nplugin clear\nprint 'still here'\n"
    found = mt.lammps_once(text, executable=STOCK)
    assert found.code == 0 and "still here" in found.output, found.tail()


def test_another_version_is_refused():
    need(PLUGIN, STOCK)
    own = os.path.dirname(os.path.realpath(STOCK))
    others = [lmp for lmp in glob.glob(os.path.join(os.path.dirname(own), "build-*", "lmp"))
              if version_of(lmp) != version_of(STOCK)]
    if not others:
        raise mt.Skip("no stock LAMMPS of another version in " + os.path.dirname(own))
    for lmp in others:
        text = "plugin load %s\nprint 'loaded'\n" % PLUGIN + scene()
        found = mt.lammps_once(text, executable=lmp)
        assert found.code is not None and found.code > 0, "%s\n%s" % (found.code, found.tail())
        assert "mpmplugin was compiled for LAMMPS" in found.output or \
            "Open of file %s failed" % PLUGIN in found.output, found.tail()


def version_of(lmp):
    words = mt.run([lmp, "-h"]).output.split("- ", 1)[-1].split("\n")[0]
    return words


mt.main(globals())
