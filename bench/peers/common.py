# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""What the problems share: a case, and how to read what LAMMPS writes."""
import os
import re
from dataclasses import dataclass, field
from typing import Callable

import numpy as np


@dataclass
class Case:
    code: str                       # name of the method, as the table shows it
    setting: str                    # resolution and options
    commands: list                  # lists of words; MPM and PEERS stand for the two builds of LAMMPS
    measure: Callable               # (folder, output) -> Found
    prepare: Callable = None        # (folder): writes what the commands need
    long: bool = False              # more than some 10 s: never repeated
    ranks: int = 1


@dataclass
class Found:
    errors: dict = field(default_factory=dict)    # quantity: error in percent; the first one counts most
    size: int = 0                                 # points, cells, or elements
    steps: int = 0                                # 0: the cost of a point-step means nothing
    note: str = ""


def lammps(build, script, **variables):
    """words of a run of LAMMPS"""
    words = [build, "-nocite", "-log", "log.lammps", "-in", script, "-v", "here", os.path.dirname(script)]
    for name, value in variables.items():
        words += ["-v", name, str(value)]
    return words


def steps_and_atoms(output):
    """of the longest run in the output of LAMMPS"""
    runs = [(int(s), int(n)) for s, n in re.findall(r"for (\d+) steps with (\d+) atoms", output)]
    return max(runs)


def result(output):
    """the numbers of the last line RESULT name value name value ... of the output"""
    words = re.findall(r"^RESULT (.*)$", output, re.M)[-1].split()
    return {name: float(value) for name, value in zip(words[::2], words[1::2])}


def table(path):
    """the rows of a file of fix ave/time or fix print"""
    with open(path) as file:
        return np.array([[float(w) for w in line.split()] for line in file if line.strip() and line[0] != "#"])


def dump(path):
    """the last frame of a dump: name -> values"""
    with open(path) as file:
        lines = file.read().split("\n")
    start = max(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    names = lines[start].split()[2:]
    rows = np.array([[float(w) for w in line.split()] for line in lines[start + 1:] if line])
    return {name: rows[:, k] for k, name in enumerate(names)}


def frames(path):
    """all frames of a dump with *time yes*: (time, {name: values})"""
    found, time, names, rows = [], 0.0, None, None
    with open(path) as file:
        lines = file.read().split("\n")
    k = 0
    while k < len(lines) and lines[k]:
        if lines[k].startswith("ITEM: TIME") and not lines[k].startswith("ITEM: TIMESTEP"):
            time = float(lines[k + 1])
            k += 2
        elif lines[k].startswith("ITEM: NUMBER"):
            count = int(lines[k + 1])
            k += 2
        elif lines[k].startswith("ITEM: ATOMS"):
            names = lines[k].split()[2:]
            rows = np.array([[float(w) for w in line.split()] for line in lines[k + 1:k + 1 + count]])
            found.append((time, {name: rows[:, j] for j, name in enumerate(names)}))
            k += 1 + count
        else:
            k += 1
    return found


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def here(file, *names):
    return os.path.join(os.path.dirname(os.path.abspath(file)), *names)
