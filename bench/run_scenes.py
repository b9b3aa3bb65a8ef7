#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Where the time of the scenes in examples goes: ns of processor time per step and material point, by parts of a step.

  run_scenes.py LMP [--repeat N] [--steps N] [--write] [scene ...]      default: all scenes, 3 rounds, at most 2000 steps

Scenes run in turn on one process each, with `plan yes` in their fixes mpm; each number is the median over the
rounds. The first scenes are the blocks of this folder, which the others are compared with: `times` is the time of a
scene over that of the block of its dimension in the same round. Files in scenes.csv, which --write replaces, are the
last table that was recorded; `before` is its `times`. A machine that is busy (less than 90 % use of the processor in
any run) is named at the end.

The parts: law: nodes to points with the laws of materials; p2g: points to nodes; nodes: momentum equation with
walls and contact; ledger: energies of nodes for compute mpm/energy; topology, sort, halo: of blocks, points, messages;
physics: heat, pore water, implicit steps; rest: other stages; lammps: all else in the loop: forces, neighbor lists, other fixes,
computes, output, and all of the time of scenes without a fix mpm (fix mpm/incompressible).
"""

import argparse
import csv
import glob
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
TABLE = os.path.join(HERE, "scenes.csv")
SKIPPED = ("own-material", "own-physics", "python", "point")    # need a build of their own, or have no lattice
BLOCKS = {"block": ("in.block", {"n": "20", "box": "24", "steps": "200"}),
          "block2d": ("in.block2d", {"n": "100", "box": "110", "steps": "400"})}
PARTS = ("law", "p2g", "nodes", "ledger", "topology", "sort", "halo", "physics", "rest", "lammps")
STAGES = (("nodes to points", "law"), ("gradients", "law"), ("averaged", "law"), ("motion of points", "law"),
          ("points to nodes", "p2g"), ("velocities back", "p2g"), ("momentum equation", "nodes"), ("node actions", "nodes"), ("FMPM", "nodes"),
          ("XPIC", "nodes"), ("light nodes", "nodes"), ("energy of nodes", "ledger"), ("topology", "topology"),
          ("sort", "sort"), ("sum over ranks", "halo"), ("conduction of heat", "physics"), ("pore pressure", "physics"),
          ("flow of pore water", "physics"), ("inertia of pore water", "physics"), ("pressure of the mixture", "physics"),
          ("volume of the mixture", "physics"), ("work in the mixture", "physics"), ("implicit step", "physics"))
COLUMNS = ("scene", "dimension", "points", "steps", "total") + PARTS + ("times",)


def inputs(names):
    """name -> input file"""
    found = dict((name, os.path.join(HERE, file)) for name, (file, _) in BLOCKS.items())
    for path in sorted(glob.glob(os.path.join(ROOT, "examples", "*", "in.*"))):
        name = os.path.basename(path)[3:]
        if name not in SKIPPED and (not names or name in names):
            found[name] = path
    unknown = set(names) - set(found)
    if unknown:
        sys.exit("no scene has the name " + ", ".join(sorted(unknown)))
    return found


def with_plan(text, steps):
    """the input with the times of all stages, and with no more than so many steps in its last run"""
    text = re.sub(r"&[ \t]*\n", " ", text)
    text = re.sub(r"^(fix\s+\S+\s+\S+\s+mpm\s+\S+)", r"\1 plan yes", text, flags=re.M)
    runs = list(re.finditer(r"^run\s+(\d+)", text, re.M))
    if runs and int(runs[-1].group(1)) > steps:
        text = text[:runs[-1].start(1)] + str(steps) + text[runs[-1].end(1):]
    return text


def measure(lmp, name, path, steps):
    """parts in ns, and what else the table has, of the last run of an input"""
    variables = BLOCKS[name][1] if name in BLOCKS else {}
    with tempfile.TemporaryDirectory() as folder:
        for file in glob.glob(os.path.join(os.path.dirname(path), "*")) if not variables else ():
            if os.path.isfile(file) and not re.search(r"\.png$|/log\.[^/]*$", file):
                shutil.copy(file, folder)
        with open(path) as file:
            text = with_plan(file.read(), steps)
        with open(os.path.join(folder, "in.run"), "w") as file:
            file.write(text)
        command = [lmp, "-in", "in.run", "-log", "none", "-nocite"]
        for key, value in variables.items():
            command += ["-var", key, value]
        done = subprocess.run(command, cwd=folder, env=dict(os.environ, OMP_NUM_THREADS="1"), stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    loops = [loop for loop in re.finditer(r"^Loop time of (\S+) on 1 procs for (\d+) steps", done.stdout, re.M)
             if int(loop.group(2))]
    if done.returncode or not loops:
        sys.exit("%s failed:\n%s" % (name, done.stdout[-2000:]))
    loop = max(loops, key=lambda found: float(found.group(1)))    # the long one
    told = re.match(r"(?:(?!^Loop time)[^%])*?([0-9.]+)% CPU use", done.stdout[loop.end():], re.M)
    use = float(told.group(1)) / 100.0 if told else 1.0    # not after `post no`
    report = done.stdout[:loop.start()]
    report = report[report.rfind("MPM plan of a step"):]
    fields = re.findall(r"^MPM \S+: (\d+) points, .*? kernels, .*\n  plan of the step:\n((?:    .*\n)+)", report, re.M)
    row = dict.fromkeys(PARTS, 0.0)
    points = sum(int(n) for n, _ in fields) or int(re.search(r"with (\d+) atoms", done.stdout[loop.start():]).group(1))
    for n, stages in fields:
        for line in stages.splitlines():
            stage, ns = line.rsplit(None, 1)
            part = next((part for begin, part in STAGES if stage.strip().startswith(begin)), "rest")
            row[part] += use * float(ns) * int(n) / points    # stages have wall times
    row["total"] = 1.0e9 * float(loop.group(1)) * use / (int(loop.group(2)) * points)
    row["lammps"] = row["total"] - sum(row[part] for part in PARTS)
    row.update(scene=name, dimension=2 if re.search(r"^dimension\s+2", text, re.M) else 3, points=points,
               steps=int(loop.group(2)))
    return row, use


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lmp")
    parser.add_argument("scene", nargs="*")
    parser.add_argument("--repeat", type=int, default=3, help="rounds")
    parser.add_argument("--steps", type=int, default=2000, help="most steps of a run")
    parser.add_argument("--write", action="store_true", help="replace scenes.csv")
    args = parser.parse_intermixed_args()
    found = inputs(args.scene)
    rounds, least = {name: [] for name in found}, 1.0
    for _ in range(args.repeat):
        blocks = {}
        for name, path in found.items():
            row, use = measure(os.path.abspath(args.lmp), name, path, args.steps)
            print("%-22s %7.1f" % (name, row["total"]), file=sys.stderr, flush=True)
            least = min(least, use)
            if name in BLOCKS:
                blocks[row["dimension"]] = row["total"]
            row["times"] = row["total"] / blocks[row["dimension"]]
            rounds[name].append(row)
    last = {}    # a table from before has no column for a part that is new
    if os.path.exists(TABLE):
        with open(TABLE) as file:
            last = {row["scene"]: row for row in csv.DictReader(file)}
    table = [{key: rows[0][key] if key in COLUMNS[:4] else statistics.median(row[key] for row in rows) for key in COLUMNS}
             for rows in rounds.values()]
    print("%-22s %8s %7s" % ("scene", "points", "total") + "".join("%9s" % part for part in PARTS) + "  times before")
    for row in table:
        before = last.get(row["scene"])
        print("%-22s %8d %7.1f" % (row["scene"], row["points"], row["total"]) +
              "".join("%9.1f" % row[part] for part in PARTS) + "%7.2f" % row["times"] +
              ("%7.2f" % float(before["times"]) if before else ""))
    if least < 0.9:
        print("the machine was busy: a run had %.0f %% CPU use" % (100.0 * least))
    if args.write:
        with open(TABLE, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            for row in table:
                writer.writerow({key: "%.4g" % value if isinstance(value, float) else value for key, value in row.items()})


main()
