#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Final shape of the copper Taylor bar against experiment, and the cost of the run.

usage: taylor_table.py DIR   with final.dump and log.lammps of examples/taylor-bar

A point stands for a piece of material of initial size h/2; its deformed half width F e h/4 is
added at the surface. The width at 0.2 L0 is that of the circle of equal area: volume of the
points per height there.
Experiment: Johnson and Holmquist 1988, as used by Sulsky, Zhou and Schreyer 1995.
"""
import os
import re
import sys

import numpy as np

EXPERIMENT = {"length": 16.2, "diameter": 13.5, "width": 10.1}    # mm
L0 = 25.4e-3


def read_dump(path):
    with open(path) as f:
        lines = f.read().split("\n")
    start = next(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    names = lines[start].split()[2:]
    values = np.array([[float(w) for w in line.split()] for line in lines[start + 1:] if line])
    return {name: values[:, k] for k, name in enumerate(names)}


def measure(point, h):
    """Length, largest diameter and width at 0.2 L0, in mm."""
    x, y, z = point["x"], point["y"], point["z"]
    F = np.array([point["c_F[%d]" % (k + 2)] for k in range(9)]).reshape(3, 3, -1)
    length = np.max(z + np.linalg.norm(F[2], axis=0) * h / 4)

    r = np.hypot(x, y)
    radial = np.array([x, y, 0 * x]) / np.maximum(r, 1e-12)
    stretch = np.linalg.norm(np.einsum("ia,ija->ja", radial, F), axis=0)
    # mean over the points around the rim: a lattice in a circle has corners
    outer = r + stretch * h / 4
    sector = np.floor((np.arctan2(y, x) + np.pi) / (2 * np.pi) * 48).astype(int)
    rim = [outer[sector == k].max() for k in range(48)]
    diameter = 2 * np.mean(rim)

    # smooth window of width 4 h: layers of points must not count more or less by where they are
    distance = np.minimum(np.abs(z - 0.2 * L0) / (2 * h), 1.0)
    window = 0.5 * (1 + np.cos(np.pi * distance)) / (2 * h)
    area = (point["c_F[1]"] * window).sum()
    width = np.sqrt(4 * area / np.pi)
    return {"length": 1e3 * length, "diameter": 1e3 * diameter, "width": 1e3 * width}


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "."
    with open(os.path.join(folder, "log.lammps")) as f:
        log = f.read()
    h = 2 * float(re.search(r"^ *spacing = ([0-9.eE+-]+)", log, re.M).group(1))    # ppc 2
    found = measure(read_dump(os.path.join(folder, "final.dump")), h)

    print("Taylor bar, OFHC copper, 190 m/s, 80 microseconds, node spacing %.3g mm" % (1e3 * h))
    print("%-34s %9s %11s %7s" % ("", "computed", "experiment", "error"))
    errors = []
    for key, text in (("length", "final length [mm]"), ("diameter", "mushroom diameter [mm]"),
                      ("width", "width at 0.2 initial length [mm]")):
        error = found[key] / EXPERIMENT[key] - 1
        errors.append(abs(error))
        print("%-34s %9.2f %11.1f %6.1f%%" % (text, found[key], EXPERIMENT[key], 100 * error))
    print("%-34s %28.1f%%" % ("mean of the three errors", 100 * np.mean(errors)))
    ns = re.findall(r"([0-9.]+) ns per point-step and core", log)
    size = re.findall(r"([0-9]+) bytes per point", log)
    kernels = re.findall(r"points, (\S+) kernels", log)
    if ns:
        print("%-34s %9s  (%s kernels)" % ("ns per point-step", ns[0], kernels[0]))
        print("%-34s %9s" % ("bytes per point", size[0]))


if __name__ == "__main__":
    main()
