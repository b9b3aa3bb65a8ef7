#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Stability at the extremes: measures and writes results/*.csv.

usage: run.py LMP [part ...]     parts: dt sweep scenes drift (default: all of them, in this order)
What is in a file of results already is not measured again: remove lines to repeat them. The tables
of the manual are made from these files by tables.py.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import trial
import drift
import dt_limit
import scenes
import sweep

PARTS = {"dt": dt_limit.measure, "sweep": sweep.measure, "scenes": scenes.measure,
         "drift": drift.measure}


def main():
    if len(sys.argv) < 2 or any(part not in PARTS for part in sys.argv[2:]):
        sys.exit(__doc__)
    trial.LMP = os.path.abspath(sys.argv[1])
    os.makedirs(trial.RESULTS, exist_ok=True)
    for part in sys.argv[2:] or PARTS:
        PARTS[part]()


if __name__ == "__main__":
    main()
