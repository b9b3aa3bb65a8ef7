#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Pictures and movies of points, with title, color bar, times, and one or several views.

usage: picture.py [options] SERIES -o FILE

SERIES: a list of dump mpm/vtk (.pvd), one of its snapshots (.vtp, .pvtp), or a file of dump custom with the columns x y z.
FILE: a picture (.png, .pdf, .svg), or a movie of all times (.gif, .mp4; the latter needs ffmpeg).

  --color FIELD      a field or formula of fields, such as eplastic, pressure/1e6, sqrt(vx**2+vz**2); of a
                     vector its components are velocity_x ..., of a tensor stress_xx ...; default: type; gray where
                     it is nan, as in "where(type == 2, nan, pressure)"
  --label TEXT       of the color bar, with the unit; default: the formula
  --unit-length mm, --unit-time us, for axes and times, where the units of the run are known (always with dump mpm/vtk,
                     with dump_modify units yes for dump custom)
  --range MIN MAX    of the colors; default: that of the times that are drawn
  --times T ...      of the snapshots (the nearest are taken), default: the first, middle, and last one
  --view xz ...      axes of the views, one row each: two of x y z; default xy in 2d, and xz
  --cut FORMULA      draws only points for which it is true, such as "y > 0"
  --diameter D       of points, a number or a formula of fields such as "where(type == 2, 0.01, 0.002)"; default: 1.4 times the
                     usual distance of neighbors in the first snapshot
  --deformed         draws points as the ellipses that the disks have become: needs the field F in the dump
  --title TEXT, --colors NAME (a color map of matplotlib), --width INCHES, --dpi N, --fps N

As a module: read_series() gives snapshots, row() draws some of them side by side, draw() puts one into axes of
matplotlib; read_table() reads curves that fix ave/time wrote."""
import argparse
import copy
import os
import re
import zlib

import numpy as np

TYPES = {"Float64": "f8", "Float32": "f4", "Int64": "i8", "UInt8": "u1"}
TENSOR = [a + b for a in "xyz" for b in "xyz"]

# of length and time in LAMMPS's units
UNITS = {"si": ("m", "s"), "cgs": ("cm", "s"), "metal": ("A", "ps"), "real": ("A", "fs"), "micro": ("um", "us"),
         "nano": ("nm", "ns"), "electron": ("Bohr", "fs")}
SIZES = {"km": 1e3, "m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "A": 1e-10, "Bohr": 5.29177e-11,
         "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "ps": 1e-12, "fs": 1e-15}


class Unit:
    """Its name, none if it is not known, and how many of it the unit of the run has."""

    def __init__(self, name="", factor=1.0):
        self.name, self.factor = name, factor

    def named(self, name):
        if name not in SIZES or self.name not in SIZES or (name[-1] == "s") != (self.name[-1] == "s"):
            raise SystemExit("unit %s: that of the run is %s" % (name, self.name or "not known"))
        return Unit(name, self.factor * SIZES[self.name] / SIZES[name])

    def __str__(self):
        return self.name.replace("um", "$\\mu$m").replace("us", "$\\mu$s").replace("A", "$\\AA$")

    def of(self, text):
        return "%s (%s)" % (text, self) if self.name else text


class Snapshot:
    """Positions x [n][3] and fields by name, [n] each, at a time (None: not known), all in the units of the run.
    length, clock: units in which positions and the time are shown."""

    def __init__(self, time, x, fields, units=""):
        self.time, self.x, self.fields = time, x, fields
        self.length, self.clock = (Unit(name) for name in UNITS.get(units, ("", "")))

    def show_in(self, length=None, time=None):
        self.length = self.length.named(length) if length else self.length
        self.clock = self.clock.named(time) if time else self.clock
        return self

    def when(self):
        """The time as text."""
        return "" if self.time is None else ("t = %.4g %s" % (self.clock.factor * self.time, self.clock)).strip()

    def values(self, formula):
        """Of a field, or of a formula of fields and of x, y, z."""
        if formula in self.fields:
            return self.fields[formula]
        names = dict(self.fields)
        names.update({name: getattr(np, name) for name in ("sqrt", "exp", "log", "log10", "abs", "sin", "cos", "round", "where")})
        names.update(zip("xyz", self.x.T), nan=np.nan)
        try:
            return eval(formula, {"__builtins__": {}}, names) + np.zeros(len(self.x))
        except NameError as error:
            raise SystemExit("%s: %s; there are %s" % (formula, error, " ".join(sorted(self.fields))))


def read_vtp(path):
    """A file of dump mpm/vtk, or a list of its pieces."""
    if path.endswith(".pvtp"):
        with open(path) as file:
            found = re.findall(r'<Piece Source="([^"]*)"', file.read())
        pieces = [read_vtp(os.path.join(os.path.dirname(path), name)) for name in found]
        first = pieces[0]
        first.x = np.concatenate([piece.x for piece in pieces])
        first.fields = {name: np.concatenate([piece.fields[name] for piece in pieces]) for name in first.fields}
        return first
    with open(path, "rb") as file:
        data = file.read()
    mark = b'<AppendedData encoding="raw">\n_'
    if mark not in data:
        raise SystemExit("%s: no file of dump mpm/vtk" % path)
    header = data[:data.index(mark)].decode()
    start = data.index(mark) + len(mark)
    order = "<" if 'byte_order="LittleEndian"' in header else ">"
    compressed = 'compressor="' in header
    arrays = {}
    for tag in re.findall(r"<DataArray ([^>]*offset=[^>]*)/>", header):
        word = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        at = start + int(word["offset"])
        size = int(np.frombuffer(data, order + "u8", 1, at)[0])
        kind = np.dtype(order + TYPES[word["type"]])
        if compressed:    # the number of blocks, two sizes of them, and the compressed sizes of all
            sizes = np.frombuffer(data, order + "u8", size, at + 24).astype(int)
            ends = at + 24 + 8 * size + np.cumsum(sizes)
            array = np.frombuffer(b"".join(zlib.decompress(data[b - n:b]) for b, n in zip(ends, sizes)), kind)
        else:
            array = np.frombuffer(data, kind, size // kind.itemsize, at + 8)
        arrays[word["Name"]] = array.reshape(-1, int(word["NumberOfComponents"])).astype(float)
    x = arrays.pop("Points")
    fields = {}
    for name, array in arrays.items():
        if name in ("connectivity", "offsets"):
            continue
        n = array.shape[1]
        parts = {1: [""], 3: ["_x", "_y", "_z"], 9: ["_" + ab for ab in TENSOR]}.get(n, ["_%d" % k for k in range(1, n + 1)])
        fields.update({name + part: array[:, k] for k, part in enumerate(parts)})
    time = re.search(r'Name="TimeValue"[^>]*>([^<]*)<', header)
    units = re.search(r'Name="Units"[^>]*>([^<]*) 0<', header)
    return Snapshot(float(time.group(1)) if time else None, x, fields,
                    "".join(chr(int(code)) for code in units.group(1).split()) if units else "")


def read_dump(path):
    """All snapshots of a file of dump custom."""
    snapshots = []
    with open(path) as file:
        lines = iter(file.read().splitlines())
    time, n, units = None, 0, ""
    for line in lines:
        if line == "ITEM: TIME":
            time = float(next(lines))
        elif line == "ITEM: UNITS":
            units = next(lines).strip()
        elif line == "ITEM: NUMBER OF ATOMS":
            n = int(next(lines))
        elif line.startswith("ITEM: ATOMS"):
            names = line.split()[2:]
            if not {"x", "y", "z"} <= set(names):
                raise SystemExit("%s: needs columns x y z, and has %s" % (path, " ".join(names)))
            table = np.array([next(lines).split() for _ in range(n)], float).reshape(n, len(names))
            column = dict(zip(names, table.T))
            snapshots.append(Snapshot(time, np.stack([column[a] for a in "xyz"], 1), column, units))
            time = None
    if not snapshots:
        raise SystemExit("%s: no file of dump custom" % path)
    return snapshots


def read_series(path, times=None):
    """Snapshots of a list, of a snapshot, or of a dump: all, or those nearest to the times."""
    if path.endswith(".pvd"):
        with open(path) as file:
            found = re.findall(r'<DataSet timestep="([^"]*)" file="([^"]*)"', file.read())
        if not found:
            raise SystemExit("%s: no snapshots" % path)
        known = np.array([float(time) for time, _ in found])
        chosen = nearest(known, times)
        return [read_vtp(os.path.join(os.path.dirname(path), found[k][1])) for k in chosen]
    snapshots = [read_vtp(path)] if path.endswith((".vtp", ".pvtp")) else read_dump(path)
    if times is None:
        return snapshots
    if any(snapshot.time is None for snapshot in snapshots):
        raise SystemExit("%s: no times (dump_modify time yes)" % path)
    return [snapshots[k] for k in nearest(np.array([s.time for s in snapshots]), times)]


def read_table(path):
    """Columns of a file of fix ave/time by their names."""
    with open(path) as file:
        names = [line for line in file if line.startswith("#")][-1][1:].split()
    return dict(zip(names, np.loadtxt(path, ndmin=2).T))


def nearest(known, times):
    return range(len(known)) if times is None else [int(np.argmin(abs(known - time))) for time in times]


def usual_distance(x, sample=200):
    """Median distance of a point from its nearest neighbor."""
    if len(x) < 2:
        raise SystemExit("%d points: say with --diameter how large they are" % len(x))
    found = []
    for k in np.linspace(0, len(x) - 1, min(sample, len(x))).astype(int):
        squares = np.sum((x - x[k])**2, axis=1)
        squares[k] = np.inf
        found.append(np.sqrt(squares.min()))
    return float(np.median(found))


def ellipses(snapshot, right, up):
    """Two diameters and the angle (degrees) of what a sphere of diameter 1 at each point has become, seen along the
    third axis: the shadow of the ellipsoid with the tensor F F^T."""
    if "F_xx" not in snapshot.fields:
        raise SystemExit("deformed points need the field F in the dump mpm/vtk")
    F = np.stack([snapshot.fields["F_" + ab] for ab in TENSOR], 1).reshape(-1, 3, 3)
    B = np.einsum("nik,njk->nij", F, F)
    a, b, c = B[:, right, right], B[:, up, up], B[:, right, up]
    middle, radius = 0.5 * (a + b), np.hypot(0.5 * (a - b), c)
    return np.sqrt(middle + radius), np.sqrt(np.maximum(middle - radius, 0.0)), np.degrees(0.5 * np.arctan2(2 * c, a - b))


def draw(axes, snapshot, values, diameter, view="xz", cmap="viridis", limits=None, deformed=False):
    """Disks of this diameter (units of the run, a number, an array, or a formula) at the points, colored by values, the farther ones behind the nearer;
    what is to be given to a color bar. view: axes to the right and up; one looks along the third, against it for xz."""
    import matplotlib.pyplot as plt
    from matplotlib.collections import EllipseCollection
    right, up = ("xyz".index(a) for a in view)
    depth = 3 - right - up
    towards = 1.0 if (right, up) in ((0, 1), (1, 2), (2, 0)) else -1.0
    order = np.argsort(towards * snapshot.x[:, depth], kind="stable")
    scale = snapshot.length.factor
    one = np.ones(len(order))
    if isinstance(diameter, str):
        diameter = snapshot.values(diameter)
    long, short, angle = ellipses(snapshot, right, up) if deformed else (one, one, 0.0 * one)
    size = scale * np.asarray(diameter) * one
    disks = EllipseCollection((size * long)[order], (size * short)[order], angle[order], units="x",
                              offsets=scale * snapshot.x[order][:, [right, up]], transOffset=axes.transData,
                              cmap=copy.copy(plt.get_cmap(cmap)))
    values = np.asarray(values, float)[order]
    if np.isnan(values).any():
        disks.set(edgecolor="black", linewidths=np.where(np.isnan(values), 0.5, 0.0))
        disks.cmap.set_bad("silver")
    else:
        disks.set_linewidth(0.0)
    disks.set_array(np.ma.masked_invalid(values))
    if limits is not None:
        disks.set_clim(*limits)
    axes.add_collection(disks)
    axes.set_aspect("equal")
    return disks


def bounds(snapshots, view, margin):
    """Limits of the axes of a view that hold all snapshots."""
    if isinstance(margin, str):
        margin = max(snapshot.values(margin).max() for snapshot in snapshots)
    columns = ["xyz".index(a) for a in view]
    low = np.min([s.x[:, columns].min(axis=0) for s in snapshots], axis=0) - margin
    high = np.max([s.x[:, columns].max(axis=0) for s in snapshots], axis=0) + margin
    return snapshots[0].length.factor * low, snapshots[0].length.factor * high


def require_points(snapshots):
    if not all(len(snapshot.x) for snapshot in snapshots):
        raise SystemExit("no points are left to be drawn: see --cut")


def limits_of(snapshots, color):
    """The least and the largest finite value in all of them."""
    values = np.concatenate([snapshot.values(color) for snapshot in snapshots])
    values = values[np.isfinite(values)]
    if not len(values):
        raise SystemExit("%s: not a finite number at any point" % color)
    return values.min(), values.max()


def row(line, snapshots, color, diameter, view="xz", cmap="viridis", limits=None, deformed=False, box=None):
    """Snapshots side by side in a line of axes with their times above, all with the same limits: box, (low, high) of
    both axes as shown, by default that of all of them. What is to be given to a color bar."""
    require_points(snapshots)
    low, high = bounds(snapshots, view, diameter) if box is None else box
    limits = limits or limits_of(snapshots, color)
    disks = None
    for axes, snapshot in zip(line, snapshots):
        disks = draw(axes, snapshot, snapshot.values(color), diameter, view, cmap, limits, deformed)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel=snapshot.length.of(view[0]), title=snapshot.when())
        axes.ticklabel_format(scilimits=(-3, 4))
    line[0].set_ylabel(snapshots[0].length.of(view[1]))
    return disks


def cut(snapshot, formula):
    if not formula:
        return snapshot
    chosen = snapshot.values(formula).astype(bool)
    part = Snapshot(snapshot.time, snapshot.x[chosen], {name: value[chosen] for name, value in snapshot.fields.items()})
    part.length, part.clock = snapshot.length, snapshot.clock
    return part


def panels(plt, snapshots, args, seen=None):
    """A figure with a column for each snapshot and a row for each view, in which all that are seen have place."""
    boxes = [bounds(seen or snapshots, view, args.diameter) for view in args.view]
    heights = [(high[1] - low[1]) / (high[0] - low[0]) for low, high in boxes]
    width = args.width or (4.0 * len(snapshots) + 1.0 if len(snapshots) > 1 else 7.0)
    height = (width - 1.0 - 0.7 * len(snapshots)) / len(snapshots) * sum(heights) + 0.8 * len(heights) + (0.4 if args.title else 0.0)
    figure, grid = plt.subplots(len(args.view), len(snapshots), squeeze=False, layout="constrained",
                                gridspec_kw={"height_ratios": heights}, figsize=(width, height))
    disks = None
    for line, view, box in zip(grid, args.view, boxes):
        disks = row(line, snapshots, args.color, args.diameter, view, args.colors, args.range, args.deformed, box)
        for axes in line if view is not args.view[0] else []:
            axes.set_title("")
    figure.colorbar(disks, ax=grid, label=args.label or args.color, pad=0.01)
    if args.title:
        figure.suptitle(args.title)
    return figure


def movie(plt, snapshots, args):
    from matplotlib.animation import FFMpegWriter, PillowWriter
    writer = PillowWriter if args.output.endswith(".gif") else FFMpegWriter
    if not writer.isAvailable():
        raise SystemExit("%s: no ffmpeg here; a movie with the name .gif does without" % args.output)
    frame = panels(plt, snapshots[:1], args, snapshots)
    grid = frame.axes[:len(args.view)]
    boxes = [bounds(snapshots, view, args.diameter) for view in args.view]
    writer = writer(fps=args.fps)
    with writer.saving(frame, args.output, args.dpi):
        for snapshot in snapshots:
            for axes, view, box in zip(grid, args.view, boxes):
                for old in list(axes.collections):
                    old.remove()
                row([axes], [snapshot], args.color, args.diameter, view, args.colors, args.range, args.deformed, box)
                if axes is not grid[0]:
                    axes.set_title("")
            writer.grab_frame()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("series")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--color", default="type")
    parser.add_argument("--label")
    parser.add_argument("--unit-length")
    parser.add_argument("--unit-time")
    parser.add_argument("--range", nargs=2, type=float)
    parser.add_argument("--times", nargs="+", type=float)
    parser.add_argument("--view", nargs="+")
    parser.add_argument("--cut")
    parser.add_argument("--diameter")
    parser.add_argument("--deformed", action="store_true")
    parser.add_argument("--title")
    parser.add_argument("--colors", default="viridis")
    parser.add_argument("--width", type=float)
    parser.add_argument("--dpi", type=int, default=100)
    parser.add_argument("--fps", type=float, default=15.0)
    args = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    moves = args.output.endswith((".gif", ".mp4"))
    snapshots = read_series(args.series, args.times)
    if not moves and args.times is None and len(snapshots) > 3:
        snapshots = [snapshots[k] for k in (0, len(snapshots) // 2, -1)]
    if args.diameter is None:
        args.diameter = 1.4 * usual_distance(snapshots[0].x)
    if args.view is None:
        args.view = ["xy" if np.ptp(snapshots[0].x[:, 2]) == 0.0 else "xz"]
    for view in args.view:
        if len(view) != 2 or not set(view) <= set("xyz") or view[0] == view[1]:
            raise SystemExit("view %s: two of x, y, z are needed, such as xz" % view)
    snapshots = [cut(snapshot.show_in(args.unit_length, args.unit_time), args.cut) for snapshot in snapshots]
    require_points(snapshots)
    args.range = args.range or limits_of(snapshots, args.color)
    if moves:
        movie(plt, snapshots, args)
    else:
        panels(plt, snapshots, args).savefig(args.output, dpi=args.dpi)
    print(args.output)


if __name__ == "__main__":
    main()
