#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Cost of coupling: points alone, grains alone, both; contact on and off; grains in a fluid on and off.

  run_coupling.py LMP [group ...]      groups: see GROUPS below, default: all
  REPEAT=3 SCALE=1                     rounds, and factor on the numbers of steps

Variants of a group run in turn, so that what else the machine does hits all of them. The time of a step
is processor time in LAMMPS's loop (loop time times its share of a processor). A ratio is the median over
the rounds of the ratio within a round. The tables go between the marks in README.md.
"""

import os
import re
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
README = os.path.join(HERE, "README.md")
MARKS = "<!-- %s: begin -->\n", "<!-- %s: end -->\n"
REPEAT, SCALE = int(os.environ.get("REPEAT", "3")), float(os.environ.get("SCALE", "1"))

# group: input, steps, {variant: (what it is, variables)}, variants that a ratio is over
GROUPS = {
    "grains": ("in.grains", 400, {
        "points": ("points alone", {"mode": "points"}),
        "grains": ("grains alone", {"mode": "grains"}),
        "both": ("both, fix mpm/surface", {"mode": "both"}),
        "skin": ("both, fix mpm/surface with group", {"mode": "skin"}),
        "away": ("the same, grains out of reach", {"mode": "skin", "gap": "4.0"}),
    }, ("points", "grains")),
    "fast": ("in.grains", 400, {
        "points": ("points alone", {"mode": "points"}),
        "grains": ("grains alone", {"mode": "grains", "speed": "5.0"}),
        "both": ("both, fix mpm/surface", {"mode": "both", "speed": "5.0"}),
        "skin": ("both, fix mpm/surface with group", {"mode": "skin", "speed": "5.0"}),
    }, ("points", "grains")),
    "every": ("in.grains", 400, {
        "skin": ("a step of the points in each step", {"mode": "skin"}),
        "every2": ("in every 2nd step", {"mode": "skin", "every": "2"}),
        "every5": ("in every 5th step", {"mode": "skin", "every": "5"}),
    }, ("skin",)),
    "contact": ("in.bodies", 300, {
        "one": ("one field", {"mode": "one"}),
        "two": ("two fields, no contact", {"mode": "two"}),
        "apart": ("fix mpm/contact, bodies apart", {"mode": "apart"}),
        "touch": ("fix mpm/contact, one body on the other", {"mode": "touch"}),
    }, ("one",)),
    "immersed": ("in.immersed", 200, {
        "points": ("no grains", {"variant": "points"}),
        "off": ("grains that feel nothing", {"variant": "off"}),
        "on": ("fix mpm/immersed", {"variant": "on"}),
        "dilute": ("law of drag without porosity", {"variant": "dilute"}),
    }, ("points",)),
}


def run(lmp, script, steps, variables):
    """Milliseconds per step, and atoms, of the last run of an input."""
    command = lmp.split() + ["-in", script, "-log", "none", "-nocite", "-var", "steps", str(steps)]
    for name, value in variables.items():
        command += ["-var", name, value]
    done = subprocess.run(command, cwd=HERE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    found = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", done.stdout)
    if done.returncode or not found:
        sys.exit("%s failed:\n%s" % (" ".join(command), done.stdout[-2000:]))
    wall, steps, atoms = found[-1]
    share = float(re.findall(r"([0-9.]+)% CPU use", done.stdout)[-1]) / 100.0
    lists = re.findall(r"Neighbor list builds = (\d+)", done.stdout)
    return 1.0e3 * share * float(wall) / int(steps), int(atoms), int(lists[-1])


def measure(lmp, group):
    script, steps, variants, base = GROUPS[group]
    steps = max(20, int(SCALE * steps))
    times, atoms, lists = {name: [] for name in variants}, {}, {}
    for _ in range(REPEAT):
        for name, (_, variables) in variants.items():
            ms, atoms[name], lists[name] = run(lmp, script, steps, variables)
            times[name].append(ms)
            print("%-9s %-8s %8d atoms  %8.3f ms per step" % (group, name, atoms[name], ms), flush=True)
    rows = ["| | atoms | new lists in %d steps | ms per step | ratio |" % steps, "|---|---|---|---|---|"]
    for name, (what, _) in variants.items():
        ratios = [t / sum(times[b][k] for b in base) for k, t in enumerate(times[name])]
        rows.append("| %s | %s | %d | %.2f | %s |" % (
            what, "{:,}".format(atoms[name]), lists[name], statistics.median(times[name]),
            "%.2f" % statistics.median(ratios) if name not in base or len(base) == 1 else ""))
    return "\n".join(rows) + "\n"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for group in sys.argv[2:] or GROUPS:
        table = measure(os.path.abspath(sys.argv[1]), group)
        print("\n" + table, flush=True)
        with open(README) as file:
            text = file.read()
        begin, end = (mark % group for mark in MARKS)
        before, rest = text.split(begin)
        with open(README, "w") as file:
            file.write(before + begin + table + end + rest.split(end)[1])


main()
