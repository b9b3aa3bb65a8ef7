#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Water as an incompressible and as a weakly compressible fluid: steps, processor time, and error on three scenes.

   python3 bench/run_flow.py LMP            runs what flow.csv does not have yet, and writes the tables of the manual
   python3 bench/run_flow.py                only writes the tables of the manual from flow.csv
   python3 bench/run_flow.py --check        only looks whether they are what flow.csv gives

Scenes are those of the folder flow: a standing wave against linear theory (root mean square of the difference of both swings
over five periods), a dam break (place of the front), and a tank at rest (root mean square error of the pressure). Time is the
processor time of one process, the lower one of two runs. Delete lines of flow.csv to have them measured again.
"""
import csv
import math
import os
import re
import resource
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(HERE, "flow.csv")
MANUAL = os.path.join(HERE, "..", "doc", "src", "flow.inc")
COLUMNS = ("scene", "kind", "h", "dtfrac", "steps", "seconds", "value")
KINDS = ("incompressible", "compressible")

# the front of the dam break is that of two settings of fix mpm with 64 cells in the width of the column, see atlas/runs.csv
FRONT = 0.5 * (2.155536556 + 2.158036331)

SCENES = {
    "sloshing": ("standing wave", ("0.1", "0.05", "0.025", "0.0125"), ("0.8", "0.4", "0.2")),
    "dam": ("dam break", ("0.0142875", "0.00714375", "0.003571875", "0.0017859375"), ("0.8", "0.4", "0.2")),
    "tank": ("tank at rest", ("0.05", "0.025"), ("0.8",)),
}
CELLS = {"sloshing": 1.0, "dam": 0.05715, "tank": 1.0}    # what h is a part of


def error_of(row):
    value = float(row["value"])
    return abs(value / FRONT - 1.0) if row["scene"] == "dam" else value


def run(lmp, scene, kind, h, dtfrac):
    """steps, seconds of processor time, value"""
    with tempfile.TemporaryDirectory() as folder:
        command = [lmp, "-nocite", "-log", "none", "-in", os.path.join(HERE, "flow", "in." + scene),
                   "-v", "kind", kind, "-v", "h", h, "-v", "dtfrac", dtfrac]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=dict(os.environ, OMP_NUM_THREADS="1"))
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        output = done.stdout.decode(errors="replace")
        if done.returncode:
            sys.exit(output[-2000:])
        steps = re.findall(r"for (\d+) steps", output)[-1]
        trace = os.path.join(folder, "trace.txt")
        if os.path.exists(trace):
            rows = [[float(x) for x in line.split()] for line in open(trace) if line[0] != "#"]
            # over time, as steps differ
            total = sum((b[1] - a[1]) * ((b[2] - b[3])**2 + (a[2] - a[3])**2) / 2 for a, b in zip(rows, rows[1:]))
            value = math.sqrt(total / (rows[-1][1] - rows[0][1]))
        else:
            value = float(re.search(r"^RESULT (\S+)", output, re.M).group(1))
    return steps, "%.3g" % seconds, "%.6g" % value


def measure(lmp, rows):
    known = {tuple(r[c] for c in COLUMNS[:4]) for r in rows}
    for scene, (_, levels, fractions) in SCENES.items():
        for kind in KINDS:
            for h in levels:
                for dtfrac in fractions if kind == "incompressible" else fractions[:1]:
                    if (scene, kind, h, dtfrac) in known:
                        continue
                    runs = [run(lmp, scene, kind, h, dtfrac) for _ in range(2)]
                    best = min(runs, key=lambda r: float(r[1]))
                    rows.append(dict(zip(COLUMNS, (scene, kind, h, dtfrac) + best)))
                    print(rows[-1], flush=True)
                    with open(TABLE, "w", newline="") as file:
                        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
                        writer.writeheader()
                        writer.writerows(rows)


def tables(rows):
    """text of the manual"""
    lines = [".. made from bench/flow.csv by bench/run_flow.py", "", ".. list-table::", "   :header-rows: 1", ""]

    def line(*cells):
        for k, cell in enumerate(cells):
            lines.append(("   * - " if k == 0 else "     - ") + cell)
    line("scene", "cells", "fluid", "*fraction*", "steps", "seconds", "error, %")
    for scene, (title, levels, fractions) in SCENES.items():
        for h in levels:
            for kind in KINDS:
                for row in rows:
                    if (row["scene"], row["kind"], row["h"]) == (scene, kind, h):
                        error = 100.0 * error_of(row)
                        line(title, "%d" % round(CELLS[scene] / float(h)), kind, row["dtfrac"], row["steps"],
                             row["seconds"], "%.2g" % error if error > 1e-3 else "%.0e" % error)
    return "\n".join(lines) + "\n"


def main():
    rows = []
    if os.path.exists(TABLE):
        with open(TABLE, newline="") as file:
            rows = list(csv.DictReader(file))
    check = "--check" in sys.argv[1:]
    if len(sys.argv) > 1 and not check:
        measure(os.path.abspath(sys.argv[1]), rows)
    text = tables(rows)
    if check:
        with open(MANUAL) as file:
            if file.read() != text:
                sys.exit("doc/src/flow.inc is not what bench/flow.csv gives: run bench/run_flow.py")
        return
    with open(MANUAL, "w") as file:
        file.write(text)


if __name__ == "__main__":
    main()
