# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: plugin examples physics long
# sanitize: no
# timeout: 400
"""Physics from outside: examples/own-physics is built as a plugin, and its scalar diffuses as the exact
solution says, is balanced in the ledger, and is the same on 1 and 4 processes, with load balancing, and
through a restart. Nothing of the package was edited for it."""

import math
import os
import re

import mpm_testing as mt

folder = mt.scratch_folder()
OWN = os.path.join(folder, "build", "ownplugin.so")


def run(text, processes=0):
    return mt.ok(mt.lammps(folder, "plugin load %s\n" % OWN + text, processes=processes))


def rows(name):
    """Numbers of a dump file in order of the IDs in its first column."""
    lines = mt.read(os.path.join(folder, name)).splitlines()
    start = max(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS")) + 1
    return sorted([float(word) for word in line.split()] for line in lines[start:])


def difference(a, b):
    assert len(a) == len(b) and a
    return max(abs(x - y) for one, other in zip(a, b) for x, y in zip(one, other))


def test_builds():
    sources = mt.lammps_sources()
    if not sources:
        raise mt.Skip("no sources of LAMMPS")
    mt.build_example("own-physics", folder, "LAMMPS_SOURCE_DIR=" + sources[0])


def profile_error(h):
    """Largest difference from erfc(x / sqrt(4 D t)) in the example with this node spacing."""
    result = mt.ok(mt.lammps(folder, file="in.own-physics", arguments=["-v", "h", str(h)]))
    assert not mt.warnings(result.output), result.output
    (names, table), = mt.thermo(result.output)
    time = float(table[-1][names.index("Time")])
    ledger = [float(word) for word in table[-1][names.index("c_e[1]"):]]
    content = float(table[-1][names.index("c_e[15]")])
    assert content > 0.0
    assert abs(ledger[10]) < 1e-9 * content, "residual %g of %g" % (ledger[10], content)
    assert abs(content - ledger[15]) < 1e-9 * content, "content is not what came through the wall"
    for stage in ("scalar to nodes", "scalar to points"):
        assert re.search(r"^ *%s +[0-9.]+$" % stage, result.output, re.M), result.tail(40)
    return max(abs(c - math.erfc(x / math.sqrt(4.0 * time))) for _, x, _, c in rows("own-physics.last"))


def test_diffuses_as_the_exact_solution():
    coarse, fine = profile_error(1.0), profile_error(0.5)
    print("largest errors:", coarse, fine)
    assert fine < 0.012 and fine < 0.5 * coarse, (coarse, fine)    # of first order


HEAD = """
units lj
dimension 2
boundary f p p
atom_style mpm
neighbor 0.3 bin
"""
BOX = """
region box block 0 12 0 8 -0.5 0.5
create_box 1 box
fix grid all mpm 1.0 MPM_OPTIONS
region body block 0 7 1 6 -0.5 0.5
create_points 1 region body ppc 2
"""
FIXES = """
fix m all mpm/material density 1.5 neohookean 20.0 0.3
fix w all mpm/boundary xlo slip
fix s all own/diffusion 0.8 0.1 xlo 1.0
"""
RUN = """
compute e all mpm/energy
thermo 5
thermo_style custom step c_e[15] c_e[16] c_e[11]
thermo_modify format float %.15g
timestep 0.05
"""
MOVE = "variable vy atom 0.6+0.3*x\nvelocity all set 0.1 v_vy 0\n"
LAST = "write_dump all custom MPM_LAST id x y vx vy f_s[1] modify format float %.17g\n"


def state(text, processes=0):
    run(text.replace("MPM_LAST", "last.dump"), processes)
    return rows("last.dump")


def scene(options, layout=""):
    return (HEAD + BOX + FIXES + layout).replace("MPM_OPTIONS", options) + MOVE + RUN


def test_is_the_same_on_four_processes_and_with_balancing():
    for options in ("", "shape cpdi transfer flip 1.0 scheme musl", "shape gimp scheme usavg transfer flip 0.99"):
        one = state(scene(options) + "run 40\n" + LAST)
        assert max(row[5] for row in one) > 0.3
        for layout in ("", "comm_style tiled\nfix lb all balance 5 1.0 rcb\n"):
            assert difference(state(scene(options, layout) + "run 40\n" + LAST, 4), one) < 1e-11, options


def test_restarts_bit_by_bit():
    again = HEAD.replace("boundary f p p\n", "").replace("units lj\ndimension 2\natom_style mpm\n", "")
    grid = "fix grid all mpm 1.0\n"
    whole = state(scene("") + "run 20\nwrite_restart own.restart\nrun 20\n" + LAST)
    parts = state("read_restart own.restart\n" + again + grid + FIXES + RUN + "run 20\n" + LAST)
    assert parts == whole
    ledger = mt.thermo(run("read_restart own.restart\n" + again + grid + FIXES + RUN + "run 0\n").output)
    assert float(ledger[-1][1][0][2]) > 0.0, "what came through the wall is forgotten"


def refused(text, words):
    found = mt.lammps(folder, "plugin load %s\n" % OWN + text)
    assert found.code != 0 and words in found.output, found.tail()


def test_limits_the_time_step():
    refused(scene("") + "timestep 0.6\nrun 1\n", "Time step 0.6 is above the limit")


def test_its_ledger_must_be_defined_after_it():
    text = scene("").replace("fix s all", "compute before all mpm/energy\nfix s all")
    refused(text + "run 0\n", "define it after the fixes")


mt.main(globals())
