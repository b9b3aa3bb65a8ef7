#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Speed of two builds on the reference work (in.block), 46,656 and 405,224 points.

usage: compare_speed.py OLD_LMP NEW_LMP [case ...]     cases of run_block.py, default: those two
       PAIRS=10                                        number of pairs

The builds run in turn, A B B A ..., so that what else the machine does hits both. A time is the difference of
two run lengths in processor time, in ns per point-step. The median of the ratios within pairs is the number to
go by where the machine has other work.
"""
import os
import statistics
import sys

import run_block

PAIRS = int(os.environ.get("PAIRS", 10))


def cost(lmp, case):
    _, _, points, _, steps = run_block.CASES[case]
    short, long = (run_block.run(lmp, case, n) for n in (10, 10 + steps))
    return (long[0] - short[0]) / steps / points * 1.0e9


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    builds = [os.path.abspath(path) for path in sys.argv[1:3]]
    print("%-30s %9s %9s %10s %16s" % ("case", "old ns", "new ns", "new / old", "median of pairs"))
    for case in sys.argv[3:] or ["quadratic-apic-46k", "quadratic-apic-405k"]:
        times = [], []
        for pair in range(PAIRS):
            for k in (0, 1) if pair % 2 == 0 else (1, 0):
                times[k].append(cost(builds[k], case))
        old, new = map(statistics.median, times)
        ratio = statistics.median(b / a for a, b in zip(*times))
        print("%-30s %9.2f %9.2f %10.4f %16.4f" % (case, old, new, new / old, ratio), flush=True)


if __name__ == "__main__":
    main()
