#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Table of the cost of all laws for README.md, from one run of bench_materials:

   bench_materials --benchmark_format=json --benchmark_min_time=0.05 > laws.json
   python3 bench/law_table.py laws.json

Writes the table between the marks in README.md: ns per point of update, wave speed, and stored
energy on batches in the cache. Repetitions: the fastest counts.
"""
import json
import os
import sys

README = os.path.join(os.path.dirname(os.path.abspath(__file__)), "README.md")
MARKS = "<!-- laws: begin -->\n", "<!-- laws: end -->\n"
COLUMNS = [("avx512", "update"), ("avx2", "update"), ("baseline", "update"),
           ("avx512", "wave_speed"), ("avx512", "stored_energy")]


def number(ns):
    return "" if ns is None else f"{ns:.1f}" if ns < 10 else f"{ns:.0f}"


def main(path):
    times, names = {}, []
    with open(path) as file:
        for run in json.load(file)["benchmarks"]:
            isa, task, name = run["name"].split("/")[:3]
            ns = run["per_point"] * 1e9
            key = isa, task, name
            times[key] = min(ns, times.get(key, ns))
            if name not in names:
                names.append(name)
    lines = ["| material | update, AVX-512 | AVX2 | baseline | wave speed, AVX-512 | energy, AVX-512 |",
             "|---|---|---|---|---|---|"]
    for name in names:
        cells = [number(times.get((isa, task, name))) for isa, task in COLUMNS]
        lines.append("| " + " | ".join([name] + cells) + " |")
    with open(README) as file:
        text = file.read()
    before, rest = text.split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    with open(README, "w") as file:
        file.write(before + MARKS[0] + "\n".join(lines) + "\n" + MARKS[1] + after)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
