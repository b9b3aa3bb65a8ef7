#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""How much faster two processes are than one: laws, heat, pore water, contact, incompressible flow.

usage: run_ranks.py LMP [case ...]      default: all cases
       ROUNDS=5                         number of rounds

All cases run in turn, with one process and with two, each on a core of its own; both halves of the points are equal.
The time is the wall time of the loop that LAMMPS prints, so the machine must have two idle cores. The table has the
medians over the rounds: ns per point and step with one process, and the ratio of times in the same round.
"""
import os
import re
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROUNDS = int(os.environ.get("ROUNDS", 5))
CASES = {
    "block": ("in.block", {"n": 26, "box": 30}),
    "Johnson and Cook": ("in.block", {"n": 26, "box": 30, "law": "eos linear 80.0 strength johnson/cook 40.0 0.01 0.01 0.26 0.014 1.0"}),
    "sand": ("in.block", {"n": 26, "box": 30, "law": "drucker/prager 100.0 0.3 35.0"}),
    "heat in each step": ("in.physics", {"n": 26, "box": 30, "physics": "heat", "thermal": "yes", "more": "every 1"}),
    "pore water in each step": ("in.physics", {"n": 26, "box": 30, "physics": "pore", "more": "every 1"}),
    "contact": ("in.bodies", {"steps": 100}),
    "incompressible flow": ("flow/in.cube", {"n": 28, "steps": 30}),
}


def nanoseconds(lmp, ranks, file, variables):
    """wall time per point and step"""
    command = ["mpirun", "--oversubscribe", "--bind-to", "core", "-np", str(ranks), lmp, "-nocite", "-log", "none",
               "-in", os.path.join(HERE, file)]
    for name, value in variables.items():
        command += ["-v", name, str(value)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          env=dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"), text=True)
    found = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", done.stdout)
    if done.returncode or not found:
        sys.exit(done.stdout[-2000:])
    time, steps, points = (float(x) for x in found[-1])
    return 1e9 * time / steps / points


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    lmp, names = os.path.abspath(sys.argv[1]), sys.argv[2:] or list(CASES)
    unknown = set(names) - set(CASES)
    if unknown:
        sys.exit("no such case: " + ", ".join(sorted(unknown)))
    alone = {name: [] for name in names}
    ratio = {name: [] for name in names}
    for _ in range(ROUNDS):
        for name in names:
            one, two = (nanoseconds(lmp, ranks, *CASES[name]) for ranks in (1, 2))
            alone[name].append(one)
            ratio[name].append(one / two)
    print(f"{'case':26s}{'ns, one process':>18s}{'times faster':>16s}{'lowest, highest':>20s}")
    for name in names:
        print(f"{name:26s}{statistics.median(alone[name]):18.0f}{statistics.median(ratio[name]):16.2f}"
              f"{min(ratio[name]):12.2f}, {max(ratio[name]):.2f}")


if __name__ == "__main__":
    main()
