#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""What walls add to a step: the layer of in.walls on a face, on regions, and on surfaces of triangles.

usage: run_walls.py LMP [LMP ...] [--cases NAME ...]     builds to compare
       ROUNDS=3                                          number of rounds
       RANKS=1                                           number of processes

A time is the difference of two run lengths in processor time of all ranks, so that set-up cancels. The table has, for
each build, the medians over the rounds of the ns per point-step, of what the wall adds in units of the step without a
wall in the same round, and of what the first steps add (distances that are found once), in steps.
"""
import math
import os
import re
import statistics
import struct
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROUNDS = int(os.environ.get("ROUNDS", 3))
RANKS = int(os.environ.get("RANKS", 1))
SHORT, LONG = 100, 250    # steps
TRIANGLES = {"mesh_12": None, "mesh_3528": 42, "mesh_100352": 224}
CASES = [(wall, moves) for wall in ["face", "block", "cylinder", "hole"] + list(TRIANGLES)
         for moves in ("no", "yes") if moves == "no" or wall not in ("face", "hole")]


def height(x, y):
    return 6.5 + 1.5 * math.sin(x / 6.0) * math.cos(y / 7.0)


def write_stl(path, triangles):
    with open(path, "wb") as out:
        out.write(b"\0" * 80 + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            out.write(struct.pack("<12fH", 0, 0, 0, *(c for corner in triangle for c in corner), 0))


def write_terrain(path, cells):
    """An open surface over the box."""
    at = [-8.0 + 48.0 * i / cells for i in range(cells + 1)]
    grid = [[(x, y, height(x, y)) for y in at] for x in at]
    write_stl(path, [t for i in range(cells) for j in range(cells)
                     for t in ((grid[i][j], grid[i + 1][j], grid[i + 1][j + 1]),
                               (grid[i][j], grid[i + 1][j + 1], grid[i][j + 1]))])


def write_plate(path):
    """A block of 12 triangles."""
    lo, hi = (-100.0, -100.0, -8.0), (100.0, 100.0, 6.5)
    corner = [tuple((hi if k >> d & 1 else lo)[d] for d in range(3)) for k in range(8)]
    faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    write_stl(path, [tuple(corner[k] for k in t) for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])


def seconds(lmp, wall, moves, steps, folder):
    """Processor time of a run, and the number of points."""
    file = os.path.join(folder, wall + ".stl")
    command = (["mpirun", "-np", str(RANKS)] if RANKS > 1 else []) + [
        lmp, "-in", os.path.join(HERE, "in.walls"), "-log", "none", "-nocite"]
    for key, value in (("wall", "mesh" if wall in TRIANGLES else wall), ("moves", moves), ("steps", steps),
                       ("file", file), ("open", "closed" if wall == "mesh_12" else "open")):
        command += ["-var", key, str(value)]
    done = subprocess.run(command, env=dict(os.environ, OMP_NUM_THREADS="1"), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    loop = re.search(r"^Loop time of (\S+) on .* with (\d+) atoms", done.stdout, re.M)
    use = re.search(r"([0-9.]+)% CPU use", done.stdout)
    if done.returncode or not loop or not use:
        sys.exit(done.stdout[-2000:])
    return RANKS * float(loop.group(1)) * float(use.group(1)) / 100.0, int(loop.group(2))


def main():
    arguments = sys.argv[1:]
    cases = CASES
    if "--cases" in arguments:
        at = arguments.index("--cases")
        cases = [case for case in CASES if "_".join(case) in arguments[at + 1:] or case[0] in arguments[at + 1:]]
        arguments = arguments[:at]
    if not arguments:
        sys.exit(__doc__)
    builds = [os.path.abspath(path) for path in arguments]
    steps, adds, first = {}, {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for wall, cells in TRIANGLES.items():
            path = os.path.join(folder, wall + ".stl")
            write_terrain(path, cells) if cells else write_plate(path)
        for k in range(ROUNDS):
            for lmp in builds if k % 2 == 0 else builds[::-1]:
                without = 0.0
                for wall, moves in [("none", "no")] + cases:
                    short, points = seconds(lmp, wall, moves, SHORT, folder)
                    step = (seconds(lmp, wall, moves, LONG, folder)[0] - short) / (LONG - SHORT) / points * 1.0e9
                    key = (lmp, wall, moves)
                    without = without or step
                    steps.setdefault(key, []).append(step)
                    adds.setdefault(key, []).append(step / without - 1.0)
                    first.setdefault(key, []).append((short / points * 1.0e9 - SHORT * step) / without)
    print("%-40s %-12s %-6s %9s %8s %12s" % ("build", "wall", "moves", "step ns", "adds", "first steps"))
    for (lmp, wall, moves), times in steps.items():
        key = (lmp, wall, moves)
        print("%-40s %-12s %-6s %9.1f %8.2f %12.0f" % (lmp[-40:], wall, moves, statistics.median(times),
                                                      statistics.median(adds[key]), statistics.median(first[key])))


if __name__ == "__main__":
    main()
