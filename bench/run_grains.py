#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Cost of grains on material points: points alone, grains alone, both, and both with neighbor lists
for the surface of the points only (in.grains).

  run_grains.py LMP [n [steps]]     REPEAT=3: runs of each, in turn; medians are printed
"""

import os
import re
import statistics
import subprocess
import sys

MODES = ("mpm", "dem", "both", "skin")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    lmp, n, steps = (sys.argv[1:] + ["40", "300"][len(sys.argv) - 2:])[:3]
    folder = os.path.dirname(os.path.abspath(__file__))
    times = {mode: [] for mode in MODES}
    for _ in range(int(os.environ.get("REPEAT", "3"))):
        for mode in MODES:
            done = subprocess.run(lmp.split() + ["-in", "in.grains", "-log", "none", "-nocite", "-var",
                                                 "mode", mode, "-var", "n", n, "-var", "steps", steps],
                                  cwd=folder, stdout=subprocess.PIPE, text=True, check=True)
            found = re.search(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms",
                              done.stdout)
            times[mode].append(1.0e3 * float(found.group(1)) / int(found.group(2)))
            print("%-5s %8s atoms  %8.3f ms per step" % (mode, found.group(3), times[mode][-1]),
                  flush=True)
    median = {mode: statistics.median(times[mode]) for mode in MODES}
    alone = median["mpm"] + median["dem"]
    print("\n| | ms per step | over points alone plus grains alone |\n|---|---|---|")
    for mode in MODES:
        print("| %s | %.2f | %s |" % (mode, median[mode], "%.2f" % (median[mode] / alone)
                                     if mode in ("both", "skin") else ""))


main()
