# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: physics examples
# sanitize: no
# timeout: 300
"""The copper Taylor bar of the demonstration against experiment and finite elements."""

import os
import re
import sys
import tempfile

import mpm_testing as mt

BAR = os.path.join(mt.ROOT, "examples", "taylor-bar", "in.taylor-bar")

# own axisymmetric finite elements, frictionless wall, 80 microseconds; percent allowed
FINITE_ELEMENTS = {"length": (16.27, 1.5), "diameter": (13.48, 4.0), "width": (10.16, 3.0)}


def measure(h, demo=False):
    """Length, diameter, width in mm, and the output of tools/taylor_table.py."""
    with tempfile.TemporaryDirectory() as folder:
        text = mt.read(BAR)
        if not demo:    # pictures take time
            text = "\n".join(line for line in text.split("\n")
                             if not re.match(r"(dump|dump_modify) +(pic|vtk)|  +(box no|amap)", line))
        mt.ok(mt.lammps(folder, text, arguments=["-v", "h", str(h)], timeout=200))
        table = mt.ok(mt.run([sys.executable, os.path.join(mt.ROOT, "tools", "taylor_table.py"), folder]))
    values = [float(v) for v in re.findall(r"\[mm\] +([0-9.]+)", table.output)]
    assert len(values) == 3, table.output
    return dict(zip(("length", "diameter", "width"), values)), table.output


def test_demonstration_meets_the_experiment():
    mt.long_case()
    found, table = measure(0.0005, demo=True)
    print(table)
    mean = float(re.search(r"mean of the three errors +([0-9.]+)%", table).group(1))
    assert mean < 4.0, table
    for key, (value, percent) in FINITE_ELEMENTS.items():
        error = 100 * (found[key] / value - 1)
        print("%s: %.2f mm, finite elements %.2f mm, %+.1f %%" % (key, found[key], value, error))
        assert abs(error) < percent, (key, found[key])
    assert "ns per point-step" in table and "bytes per point" in table


def test_refinement_comes_closer_to_finite_elements():
    mt.long_case()

    def distance(h):
        found, _ = measure(h)
        return sum(abs(found[k] / v - 1) for k, (v, _) in FINITE_ELEMENTS.items()) / 3

    coarse, fine = distance(0.00095), distance(0.0005)
    print("mean distance from finite elements: %.2f %% and %.2f %%" % (100 * coarse, 100 * fine))
    assert fine < coarse


def test_body_of_revolution():
    """The axisymmetric bar at twice the resolution, about as many points as 3d has at a third of it."""
    scene = os.path.join(mt.ROOT, "examples", "taylor-bar-axisymmetric")
    with tempfile.TemporaryDirectory() as folder:
        text = mt.read(os.path.join(scene, "in.taylor-bar-axisymmetric"))
        text = re.sub(r"\ndump .*?cf .*?\n", "\n", text, flags=re.S)    # no pictures
        mt.ok(mt.lammps(folder, text, arguments=["-v", "h", "0.00038"], timeout=200))
        table = mt.ok(mt.run([sys.executable, os.path.join(scene, "plot.py"), folder]))
    print(table.output)
    values = [float(v) for v in re.findall(r" ([0-9.]+)(?: mm|$)", table.output.strip())]
    for (key, (value, _)), found, percent in zip(FINITE_ELEMENTS.items(), values, (0.5, 3.0, 0.5)):
        assert abs(found / value - 1) < percent / 100, (key, found)
    assert abs(values[3] / 1.63 - 1) < 0.03, values    # largest plastic strain


mt.main(globals())
