# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Dam break: a column of water, a = 57.15 mm wide and 2 a high, collapses between walls without friction.

Reference: interFoam with a/80, in reference.txt (run.py --reference makes it anew).  The experiment of J. C. Martin and
W. J. Moyce, Phil. Trans. R. Soc. Lond. A 244, 312 (1952) had a gate that had to open, which all of these leave out.
Errors, as root mean squares over time:
  front    place of the outermost water over a, T = t sqrt(2 g/a) from 0.3 to 3.3
  height   highest water over 2 a, T from 0.3 to 2.8
  mean     twice the mean height of the water at x < a/4, over 2 a, T from 0.3 to 2.8
"""
import glob
import os
import re
import shutil

import numpy as np

from common import Case, Found, here, lammps, rms, steps_and_atoms, table

A, G = 0.05715, 9.81
REFERENCE = here(__file__, "reference.txt")


def errors(T, Z, H, M):
    """in percent of a or 2 a; rows of a run against those of the reference"""
    R = table(REFERENCE).T
    at = np.linspace(0.3, 3.3, 61)
    high = at[at < 2.8]
    return {"front": 100 * rms(np.interp(at, T, Z) - np.interp(at, R[0], R[1])),
            "height": 100 * rms(np.interp(high, T, H) - np.interp(high, R[0], R[2])),
            "mean height": 100 * rms(np.interp(high, T, M) - np.interp(high, R[0], R[3]))}


def particles(folder, output):
    rows = table(os.path.join(folder, "trace.txt")).T
    steps, atoms = steps_and_atoms(output)
    return Found(errors(*rows[1:5]), atoms, steps)


# ---------------------------------------------------------------- interFoam

def water(path, nx, ny):
    """volume fractions as rows of y"""
    with open(path) as file:
        text = file.read()
    inside = text[text.index("internalField"):]
    numbers = re.search(r"\(([^()]*)\)", inside).group(1).split()
    return np.array([float(w) for w in numbers]).reshape(ny, nx)


def beyond(values, h):
    """where the last crossing of one half is, or zero"""
    wet = np.nonzero(values > 0.5)[0]
    if not len(wet):
        return 0.0
    k = wet[-1]
    if k + 1 == len(values):
        return (k + 1) * h
    return (k + 0.5 + (values[k] - 0.5) / (values[k] - values[k + 1])) * h


def interfoam_trace(folder, n):
    nx, ny, h = 6 * n, 3 * n, A / n
    y = (np.arange(ny) + 0.5) * h
    rows = []
    for path in glob.glob(os.path.join(folder, "0.*", "alpha.water")):
        w = water(path, nx, ny)
        near = w[:, :max(1, n // 4)]
        Z = max(beyond(row, h) for row in w[:n])
        H = max(beyond(column, h) for column in w.T[:n])
        M = 2 * (near.sum(axis=1) * y).sum() / near.sum()
        t = float(os.path.basename(os.path.dirname(path)))
        rows.append((t * np.sqrt(2 * G / A), Z / A, H / (2 * A), M / (2 * A)))
    return np.array(sorted(rows))


def interfoam_prepare(n):
    def prepare(folder):
        shutil.copytree(here(__file__, "interfoam"), folder, dirs_exist_ok=True)
        with open(os.path.join(folder, "system", "cells"), "w") as file:
            file.write("nx %d;\nny %d;\n" % (6 * n, 3 * n))
    return prepare


def interfoam(n):
    def measure(folder, output):
        steps = len(re.findall(r"^Time = ", output, re.M))
        return Found(errors(*interfoam_trace(folder, n).T), 18 * n * n, steps)
    return Case("interFoam", "a/%d" % n, [["blockMesh"], ["setFields"], ["interFoam"]], measure, interfoam_prepare(n),
                n >= 40)


def write_reference(folder, n):
    """reference.txt from a run of interfoam(n)"""
    with open(REFERENCE, "w") as file:
        file.write("# interFoam with a/%d: T = t sqrt(2 g/a), front/a, height/2a, mean height/2a (see cases.py)\n" % n)
        for row in interfoam_trace(folder, n):
            file.write("%.4f %.5f %.5f %.5f\n" % tuple(row))


def reference():
    return interfoam(80), lambda folder: write_reference(folder, 80)


def cases():
    for n, fraction in (10, 0.4), (20, 0.4), (20, 0.1), (40, 0.4):
        yield Case("MPM incompressible", "a/%d, dt fraction %g" % (n, fraction),
                   [lammps("MPM", here(__file__, "in.mpm"), n=n, dtfrac=fraction)], particles)
    for n, options in ((20, ""), (20, "transfer aflip 1.0")):
        yield Case("MPM compressible", ("a/%d %s" % (n, options)).strip(),
                   [lammps("MPM", here(__file__, "in.mpm"), kind="compressible", n=n, options=options, trace=10)],
                   particles)
    for n in 10, 20, 40:
        yield interfoam(n)
    for n in 20, 40:
        yield Case("SPH", "a/%d" % n, [lammps("PEERS", here(__file__, "in.sph"), n=n)], particles)
    for n in 10, 20:
        yield Case("RHEO", "a/%d" % n, [lammps("PEERS", here(__file__, "in.rheo"), n=n)], particles, long=n > 10)
