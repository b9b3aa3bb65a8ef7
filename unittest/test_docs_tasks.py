# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs examples
# timeout: 300
"""The tutorial and the pages of tasks: their inputs run as they are printed, without warnings, their Python scripts run
with what these have written, and the numbers that the pages speak of agree with theory."""

import math
import os
import re

import docs_scenes
import mpm_testing as mt


def files(page):
    """(language, text) of the inputs and scripts of a page, in their order, as they are printed"""
    lines = mt.read(os.path.join(docs_scenes.PAGES, page + ".rst")).splitlines()
    found = []
    for k, line in enumerate(lines):
        start = re.match(r"\.\. code-block:: (LAMMPS|python)$", line)
        if not start:
            continue
        text = []
        for row in lines[k + 1:]:
            if row and not row.startswith("   "):
                break
            text.append(row[3:])
        found.append((start.group(1), "\n".join(text).strip() + "\n"))
    return found


def run_page(page, folder, processes=0):
    """Run all inputs and scripts of a page in one folder, in their order; the outputs of LAMMPS."""
    outputs = []
    for language, text in files(page):
        if language == "python":
            script = os.path.join(folder, "script.py")
            with open(script, "w", encoding="ascii") as file:
                file.write(text)
            mt.ok(mt.run(["/usr/bin/python3" if os.path.exists("/usr/bin/python3") else "python3", script], folder))
        elif re.search(r"^(run|write_restart|mpm_point)\b", text, re.M):    # not single lines
            result = mt.ok(mt.lammps(folder, text, processes=processes))
            assert not mt.warnings(result.output), page + "\n" + "\n".join(mt.warnings(result.output))
            outputs.append(result.output)
    return outputs


def columns(path):
    """Columns of a file of fix ave/time."""
    rows = [line.split() for line in mt.read(path).splitlines() if line and not line.startswith("#")]
    return list(zip(*[[float(word) for word in row] for row in rows]))


def near(value, expected, share):
    assert abs(value - expected) <= share * abs(expected), "%g instead of %g" % (value, expected)


def test_tutorial():
    folder = mt.scratch_folder()
    run_page("Howto_mpm_tutorial", folder)
    for name in ("force.png", "ball.gif", "ball.0025.png", "ball.pvd"):
        assert os.path.getsize(os.path.join(folder, name)) > 1000, name
    _, t, v, force = columns(os.path.join(folder, "force.txt"))
    touch = [k for k in range(len(t)) if force[k] != 0.0]

    # the fall, exact but for half a millimeter, 0.05 of a point spacing, and one time step
    near(t[touch[0]], math.sqrt(2 * 0.05 / 9.81), 0.01)
    near(v[touch[0] - 1], -math.sqrt(2 * 9.81 * 0.05), 0.01)
    # impulse of floor and gravity
    mass = 1000 * 8.0e-6 / 8 * 4224
    impulse = sum(-force[k] * (t[k] - t[k - 1]) for k in range(1, len(t)))
    near(impulse - mass * 9.81 * t[-1], mass * (v[-1] - v[0]), 1e-5)
    # Hertz, a ball of 10 cm at 0.99 m/s: a compression of a tenth of the radius, and ten cells in it
    stiffness = 1.0e6 / (1 - 0.4**2)
    depth = (15 * mass * 0.99**2 / (16 * stiffness * math.sqrt(0.1))) ** 0.4
    near(t[touch[-1]] - t[touch[0]], 2.94 * depth / 0.99, 0.25)
    assert 0 < v[touch[-1] + 1] < 0.99


def test_changes_that_the_tutorial_proposes():
    text = files("Howto_mpm_tutorial")[0][1]
    text = re.sub(r"(?m)^dump.*?[^&]\n", "", text.replace("&\n", "")).replace("until 0.25", "until 0.15")
    for old, new in (("separate", "stick"), ("separate", "separate friction 0.3\nvelocity all set 0.2 0 0"),
                     ("density 1000 neohookean 1.0e6 0.4", "density 1000 eos linear 1.67e6 strength j2 0.36e6 2.0e4")):
        assert old in text
        result = mt.ok(mt.lammps_once(text.replace(old, new)))
        assert not mt.warnings(result.output), "\n".join(mt.warnings(result.output))


mt.main(globals())
