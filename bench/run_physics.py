#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""What other physics adds to a step: heat and pore water on the block of in.physics.

usage: run_physics.py LMP [LMP ...]     builds to compare
       ROUNDS=5                         number of rounds
       POINTS=405k                      or 46k

Cases and builds run in turn. A time is the difference of two run lengths in processor time. The table has, for
each build, the medians over the rounds of the ns per point-step of the step without physics and of what each physics
adds, and of the ratio of the two in the same round, which is the number to go by where the machine has other work.
"""
import os
import re
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROUNDS = int(os.environ.get("ROUNDS", 5))
SIZES = {"405k": (37, 41, 405224, 40), "46k": (18, 22, 46656, 300)}
# name: (case, what it is compared with), both as (physics, thermal, more keywords)
CASES = {"heat": (("heat", "yes", "every 1"), ("none", "yes", " ")),
         "heat_every_auto": (("heat", "yes", "every auto"), ("none", "yes", " ")),
         "heat_every_5": (("heat", "yes", "every 5"), ("none", "yes", " ")),
         "heat_every_10": (("heat", "yes", "every 10"), ("none", "yes", " ")),
         "heat_idle": (("heat_idle", "no", " "), ("none", "no", " ")),
         "pore": (("pore", "no", "every 1"), ("none", "no", " ")),
         "pore_default": (("pore", "no", " "), ("none", "no", " ")),
         "pore_every_3": (("pore", "no", "every 3"), ("none", "no", " ")),
         "pore_every_5": (("pore", "no", "every 5"), ("none", "no", " ")),
         "pore_every_auto": (("pore", "no", "every auto"), ("none", "no", " ")),
         "pore_idle": (("pore_idle", "no", " "), ("none", "no", " "))}
SHORT = 10    # steps of the shorter run


def seconds(lmp, physics, thermal, more, n, box, steps):
    """processor time of a run"""
    command = [lmp, "-in", os.path.join(HERE, "in.physics"), "-log", "none", "-nocite"]
    for key, value in (("physics", physics), ("thermal", thermal), ("n", n), ("box", box), ("steps", steps),
                       ("more", more)):
        command += ["-var", key, str(value)]
    done = subprocess.run(command, env=dict(os.environ, OMP_NUM_THREADS="1"), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    loop = re.search(r"^Loop time of (\S+) on", done.stdout, re.M)
    use = re.search(r"([0-9.]+)% CPU use", done.stdout)
    if done.returncode or not loop or not use:
        sys.exit(done.stdout[-2000:])
    return float(loop.group(1)) * float(use.group(1)) / 100.0


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    builds = [os.path.abspath(path) for path in sys.argv[1:]]
    n, box, points, steps = SIZES[os.environ.get("POINTS", "405k")]
    wanted = sorted({case for pair in CASES.values() for case in pair})
    rounds = {lmp: [] for lmp in builds}
    for k in range(ROUNDS):
        times = {lmp: {} for lmp in builds}
        for case in wanted:
            for lmp in builds if k % 2 == 0 else builds[::-1]:
                short, long = (seconds(lmp, *case, n, box, length) for length in (SHORT, SHORT + steps))
                times[lmp][case] = (long - short) / steps / points * 1.0e9
        for lmp in builds:
            rounds[lmp].append(times[lmp])
    print("%-40s %-15s %9s %9s %8s" % ("build", "physics", "step ns", "adds ns", "ratio"))
    for lmp in builds:
        for name, (case, without) in CASES.items():
            step = statistics.median(r[without] for r in rounds[lmp])
            adds = statistics.median(r[case] - r[without] for r in rounds[lmp])
            ratio = statistics.median(r[case] / r[without] - 1.0 for r in rounds[lmp])
            print("%-40s %-15s %9.2f %9.2f %8.3f" % (lmp[-40:], name, step, adds, ratio), flush=True)


if __name__ == "__main__":
    main()
