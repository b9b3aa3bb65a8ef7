#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Forces, width of the groove and hardness over friction, tool and resolution: study.py lmp [folder]

Runs that are there already in the folder (default: the present one) are not repeated.  The table of README.md."""

import os
import subprocess
import sys

import numpy as np

BETA = np.radians(19.7)    # cone: between side and surface
RADIUS = 5.0               # sphere, in depths
BEHIND = 4.5               # in.scratch: where the tool comes down, in depths from the face
SPACING = 0.1              # mm
DENSITY = 7830.0
CASES = [(tool, mu, depth) for tool, mu in (("cone", 0.0), ("cone", 0.1), ("cone", 0.3), ("sphere", 0.0)) for depth in (0.2, 0.3)]
CASES += [("mesh", 0.3, 0.2)]    # the cone as triangles


def nominal_radius(tool):
    """Radius of the tool at the old surface, in depths."""
    return np.sqrt(2.0 * RADIUS - 1.0) if tool == "sphere" else 1.0 / np.tan(BETA)


def profile(tool, y):
    """Height of the tool over its lowest point, in depths."""
    return RADIUS - np.sqrt(RADIUS**2 - np.minimum(y, RADIUS)**2) if tool == "sphere" else np.tan(BETA) * y


def ploughing(tool, mu, radius):
    """Tangential over normal force when the pressure is the same on the whole front half of a contact of this radius (in
    depths), and friction is against the way."""
    phi = np.pi * ((np.arange(200) + 0.5) / 200 - 0.5)
    r = radius * np.sqrt((np.arange(200)[:, None] + 0.5) / 200)    # equal parts of the area from above
    beta = np.arcsin(r / RADIUS) if tool == "sphere" else np.full_like(r, BETA)
    along = np.sin(beta) * np.cos(phi)
    across = np.sqrt(1.0 - along**2)
    return ((along + mu * across) / np.cos(beta)).mean() / (1.0 - mu * along / across).mean()


def columns_of(name, *wanted):
    """Columns of a dump of one time."""
    with open(name) as file:
        rows = file.read().splitlines()
    start = next(k for k, row in enumerate(rows) if row.startswith("ITEM: ATOMS"))
    names = rows[start].split()[2:]
    table = np.array([row.split() for row in rows[start + 1:]], float)
    return [table[:, names.index(one)] for one in wanted]


def half_width(folder, tool, depth, way):
    """Where the steel leaves the shape of the tool, in depths from the middle, from the lowest point to 1 depth behind it.

    Heights are volumes over columns, whose sums do not depend on where in a cell the points are.  The area between
    tool and steel grows from there with the square of the distance."""
    x, y, mass = columns_of(os.path.join(folder, "points.txt"), "x", "y", "mass")
    h = SPACING / depth
    x, y = 1e3 * x / depth, 1e3 * y / depth
    volume = 1e9 * mass / DENSITY / depth**3
    tip = round(BEHIND / h) * h + way
    share = np.clip((x - tip + 1.0) / h + 0.5, 0, 1) * np.clip((tip - x) / h + 0.5, 0, 1)
    columns = int(round(y.max() / h + 0.25))
    place = y / h - 0.5
    left = np.floor(place).astype(int)
    height = np.zeros(columns + 2)
    np.add.at(height, left + 1, share * volume * (1.0 - place + left))
    np.add.at(height, left + 2, share * volume * (place - left))
    height[1] += height[0]
    height[-2] += height[-1]
    height = height[1:-1] / h
    middle = (np.arange(columns) + 0.5) * h
    gap = profile(tool, middle) - height
    a = nominal_radius(tool)
    gap -= gap[(middle > 0.25 * a) & (middle < 0.75 * a)].mean()
    gap[middle < 0.75 * a] = 0.0
    root = np.sqrt(np.maximum(np.cumsum(gap) * h, 0.0))
    y1, y2 = (np.interp(level, root, middle + 0.5 * h) for level in (0.3, 0.6))
    return 2.0 * y1 - y2


def measure(folder, mu):
    """Way, and mean normal and tangential force (N) over its last third; by how much the first grows there."""
    path, normal, tangential = np.loadtxt(os.path.join(folder, "forces.%g.txt" % mu), usecols=(1, 2, 3)).T
    last = path > path[-1] * 2.0 / 3.0
    growth = np.polyfit(path[last], normal[last], 1)[0] * path[-1] / 3.0
    return path[-1], normal[last].mean(), tangential[last].mean(), growth / normal[last].mean()


def write_cone(name, sides=64, top=8.0):
    """Tip at the origin, lengths in depths."""
    angle = 2.0 * np.pi * np.arange(sides + 1) / sides
    rim = np.column_stack([top / np.tan(BETA) * np.cos(angle), top / np.tan(BETA) * np.sin(angle), np.full(sides + 1, top)])
    rim[-1] = rim[0]
    with open(name, "w") as file:
        file.write("solid cone\n")
        for k in range(sides):
            for corners in ([(0, 0, 0), rim[k + 1], rim[k]], [(0, 0, top), rim[k], rim[k + 1]]):
                file.write("facet normal 0 0 0\nouter loop\n")
                for corner in corners:
                    file.write("vertex %.9g %.9g %.9g\n" % tuple(corner))
                file.write("endloop\nendfacet\n")
        file.write("endsolid cone\n")


def main():
    lmp, folder = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "."
    print("tool      mu   cells   Fn/N   Ft/N  grows  Ft/Fn  formula  nominal/GPa  width/d  hardness/GPa")
    for tool, mu, depth in CASES:
        out = os.path.join(folder, "study.%s.%g.%g" % (tool, mu, depth))
        if not os.path.exists(os.path.join(out, "done")):
            os.makedirs(out, exist_ok=True)
            here = os.path.dirname(os.path.abspath(__file__))
            write_cone(os.path.join(out, "cone.stl"))
            with open(os.path.join(out, "screen"), "w") as screen:
                subprocess.run([lmp, "-in", os.path.join(here, "in.scratch"), "-log", os.path.join(out, "log"), "-v", "mu",
                                "%g" % mu, "-v", "d", str(depth), "-v", "h", str(SPACING), "-v", "outdir", out,
                                "-v", "tool", tool, "-v", "file", os.path.join(out, "cone.stl")], stdout=screen, check=True)
            open(os.path.join(out, "done"), "w").close()
        way, fn, ft, growth = measure(out, mu)
        width = half_width(out, tool, depth, way)
        area = 0.5 * np.pi * depth**2    # mm^2: a half circle of a radius of one depth
        print("%-8s %.1f %6.1f %7.0f %6.0f %6.3f %6.3f %7.3f %9.2f %10.2f %9.2f" % (
            tool, mu, depth / SPACING, fn, ft, growth, ft / fn, ploughing(tool, mu, width), 1e-3 * fn / (area * nominal_radius(tool)**2), width,
            1e-3 * fn / (area * width**2)))


main()
