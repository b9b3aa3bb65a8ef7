#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""A cantilever that swings by half of its length, in explicit and in implicit steps: time to the same answer.

   python3 bench/run_implicit.py LMP [cells...]      default: 8 16, cells in the depth of the beam

Prints, for steps in which a wave crosses 20, 50, and 200 cells, the steps, iterations and factors of fix mpm/implicit, the
processor time of the steps (that of a run less that of one without steps), how many times shorter than that of explicit steps it is, and how much the largest deflection
differs from theirs. Kinds of runs take turns, and of each the median of REPEAT (default 3) is taken, as other work on the
machine changes the processor time, too.
"""
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
METHODS = ("newmark solver multigrid", "newmark solver multigrid tolerance 1e-4 accuracy 0.05")
CFL = (20, 50, 200)


def largest(rows):
    """largest deflection, by a parabola through three times"""
    k = min(range(1, len(rows) - 1), key=lambda i: rows[i][1])
    (t0, a), (t1, b), (t2, c) = rows[k - 1:k + 2]
    slope, curve = (c - a) / (t2 - t0), (a - 2.0 * b + c) / (t1 - t0)**2
    return b - 0.5 * slope**2 / curve if curve > 0.0 else b


def run(lmp, cells, kind, solve, cfl, *more):
    """seconds of processor time, output, largest deflection"""
    with tempfile.TemporaryDirectory() as folder:
        command = [lmp, "-nocite", "-log", "none", "-in", os.path.join(HERE, "implicit", "in.cantilever"),
                   "-v", "cells", str(cells), "-v", "kind", kind, "-v", "cfl", str(cfl)]
        command += ["-v", "solve", solve] if solve else []
        command += more
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=dict(os.environ, OMP_NUM_THREADS="1"))
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        output = done.stdout.decode(errors="replace")
        if done.returncode:
            sys.exit(output[-2000:])
        rows = [[float(x) for x in line.split()[1:]] for line in open(os.path.join(folder, "trace.txt"))
                if line.startswith("TIP")]
    return seconds, output, largest(rows) if len(rows) > 2 else 0.0


def main():
    lmp = os.path.abspath(sys.argv[1])
    repeat = int(os.environ.get("REPEAT", "3"))
    for cells in sys.argv[2:] or ("8", "16"):
        kinds = [("explicit", "", 1)] + [("implicit", m, c) for m in METHODS for c in CFL]
        times = {kind: [] for kind in kinds}
        said = {}
        for _ in range(repeat):
            for kind in kinds:
                seconds, output, tip = run(lmp, cells, *kind)
                times[kind].append(seconds - run(lmp, cells, *kind, "-v", "steps", "0")[0])
                said[kind] = output, tip
        exact = said[kinds[0]][1]
        base = statistics.median(times[kinds[0]])
        for kind in kinds:
            output, tip = said[kind]
            median = statistics.median(times[kind])
            steps = re.findall(r"for (\d+) steps", output)[-1]
            line = re.search(r"^Fix mpm/implicit \S+: (.*)$", output, re.M)
            print("%s cells, %s %s CFL %s: %s steps, %.3f s, %.1f times faster, deflection %.5f (%+.2f %%)%s" % (
                cells, kind[0], kind[1], kind[2], steps, median, base / median, tip, 100.0 * (tip / exact - 1.0),
                "; " + line.group(1) if line else ""), flush=True)


if __name__ == "__main__":
    main()
