# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: examples
# sanitize: no
"""Flow curves of examples/point against the formula of Johnson and Cook, and tools/plot_point.py."""

import os
import shutil

import mpm_testing as mt

EXAMPLE = os.path.join(mt.ROOT, "examples", "point")
TOOL = os.path.join(mt.ROOT, "tools", "plot_point.py")
PYTHONS = ("python3", "/usr/bin/python3")

folder = mt.scratch_folder()


def test_runs():
    potential = os.path.join(mt.ROOT, "potentials", "Cu_OFHC_JC.mpm")
    shutil.copy(os.path.join(EXAMPLE, "in.point"), folder)
    mt.ok(mt.lammps(folder, file="in.point", arguments=["-v", "copper", potential]))


def test_flow_curves():
    import math
    for name, rate, start in (("rate1", 1.0, 298), ("rate1e3", 1.0e3, 298), ("rate1e5", 1.0e5, 298),
                              ("hot500", 1.0e3, 500), ("hot800", 1.0e3, 800)):
        rows = mt.table(os.path.join(folder, name + ".table"))
        assert len(rows) == 501 and rows[0]["temperature"] == start
        assert abs(rows[-1]["exx"] - 0.5) < 1e-12
        for old, row in zip(rows[10:], rows[11:]):
            speed = max(1.0, (row["eplastic"] - old["eplastic"]) / (row["time"] - old["time"]))
            hot = ((row["temperature"] - 298) / 1058) ** 1.09
            flow = (90e6 + 292e6 * row["eplastic"] ** 0.31) * (1 + 0.025 * math.log(speed)) * (1 - hot)
            assert abs(row["sxx"] - flow) < 1e-8 * flow, (name, row["exx"], row["sxx"], flow)
            assert abs(row["syy"]) < 1e-6 * flow and abs(row["szz"]) < 1e-6 * flow
            assert 0.97 * rate < (row["eplastic"] - old["eplastic"]) / (row["time"] - old["time"]) < rate
        # the plastic work, but for CHI, is the heat
        warm = 8960 * 383 * (rows[-1]["temperature"] - start)
        assert abs(warm - 0.9 * rows[-1]["plastic"]) < 1e-8 * warm


def test_plot():
    for python in PYTHONS:
        if mt.run([python, "-c", "import matplotlib"]).code == 0:
            break
    else:
        raise mt.Skip("matplotlib is not installed")
    picture = os.path.join(folder, "out.png")
    mt.ok(mt.run([python, TOOL, "-y", "vonmises/1e6", "-o", picture, "rate1.table", "cycle.table"], folder))
    assert os.path.getsize(picture) > 10000
    result = mt.run([python, TOOL, "-y", "nonsense", "-o", picture, "rate1.table"], folder)
    assert result.code != 0 and "columns are step, time" in result.output, result.output


mt.main(globals())
