#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Makes the tables of doc/src/Howto_mpm_stability.rst from results/*.csv.

usage: tables.py [check]     check: only tell, by the exit status, whether they are up to date
"""
import csv
import io
import os
import sys

import combos

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.path.join(HERE, "..", "..", "doc", "src", "stability")
SHAPES = [name for name, words in combos.SHAPES]
CASES = {"bar": "bar of 10 x 3 cells, 2 x 2 points per cell, at 1/4 and 3/4 of the cells",
         "faces": "the same, points 0.001 h before faces or middles of cells",
         "empty": "the same, one layer of points 1e-6 h inside cells that are empty otherwise",
         "ppc1": "1 point per cell", "ppc16": "4 x 4 points per cell",
         "ppc64": "8 x 8 points per cell", "3d": "3d: 6 x 2 x 2 cells, 2 x 2 x 2 points per cell",
         "3d empty": "the same, layers of points 1e-6 h inside cells that are empty otherwise"}


def read(name):
    path = os.path.join(HERE, "results", name + ".csv")
    if not os.path.exists(path):
        return []
    with open(path) as f:
        return list(csv.DictReader(f))


def table(head, rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([head] + rows)
    return (".. csv-table::\n   :header-rows: 1\n   :widths: auto\n\n" +
            "".join("   %s\n" % line for line in text.getvalue().splitlines()))


def shown(limit):
    """A limit of the time step; where the smallest that was tried is unstable, there is none."""
    if float(limit) == 0.0:
        return "none"
    return ("> " if float(limit) >= 8.0 else "") + "%.2f" % float(limit)


def ordered(values, wanted):
    return [v for v in wanted if v in values] + sorted(set(values) - set(wanted))


def unique(rows, *columns):
    seen = []
    for r in rows:
        key = tuple(r[c] for c in columns)
        if key not in seen:
            seen.append(key)
    return seen


def matrix(rows, value):
    """One row for a transfer and scheme, one column for a shape."""
    shapes = ordered({r["shape"] for r in rows}, SHAPES)
    cell = {(r["transfer"], r["scheme"], r["shape"]): value(r) for r in rows}
    lines = [[t, s] + [cell.get((t, s, shape), "") for shape in shapes]
             for t in ordered({r["transfer"] for r in rows}, combos.TRANSFERS) for s in combos.SCHEMES
             if any(key[:2] == (t, s) for key in cell)]
    return table(["transfer", "scheme"] + shapes, lines) + "\n"


def title(text):
    return "**%s**\n\n" % (text[0].upper() + text[1:])


def smallest_limits():
    """{(shape, transfer, scheme): smallest limit of the time step over all cases}"""
    least = {}
    for r in read("dt"):
        key = (r["shape"], r["transfer"], r["scheme"])
        least[key] = min(float(r["limit"]), least.get(key, 8.0))
    return least


def smallest_table():
    return matrix([dict(zip(("shape", "transfer", "scheme"), key), limit=limit)
                   for key, limit in smallest_limits().items()], lambda r: shown(r["limit"]))


def dt_table():
    rows = read("dt")
    return "".join(title(CASES[case]) + matrix([r for r in rows if r["case"] == case],
                                               lambda r: shown(r["limit"]))
                   for case in CASES)


def beyond_table():
    """How runs with 1.25 times the limit end, with the check of the time step."""
    rows = [r for r in read("dt") if r["beyond"]]
    kinds = {}
    for r in rows:
        kinds.setdefault(r["beyond"], []).append(r)
    means = {"time step": "error: time step above h/(c+\\|v\\|)", "inverted point": "error: point with J <= 0",
             "ok": "goes on, with kinetic energy that stays below twice its initial value",
             "lost point": "error: point out of reach", "left the box": "error: point left the box"}
    lines = [[means.get(k, k), len(v),
              "; ".join(sorted({"%s %s" % (r["shape"], r["scheme"]) for r in v}))
              if len(v) <= 12 else "%.2f to %.2f" % (min(float(r["limit"]) for r in v),
                                                     max(float(r["limit"]) for r in v))]
             for k, v in sorted(kinds.items(), key=lambda kv: -len(kv[1]))]
    return table(["how it ends", "combinations", "their limits (or what they are)"], lines)


def sweep_table():
    rows = read("sweep")

    def of_kick(name):
        return lambda r: "error" if r[name] == "nan" else "%.2f" % float(r[name])
    return (title("smallest limit of the time step") + matrix(rows, lambda r: shown(r["limit"])) +
            title("largest speed") + matrix(rows, of_kick("velocity")) +
            title("largest acceleration") + matrix(rows, of_kick("acceleration")))


def verdict(r):
    try:
        value = float(r["value"])
    except ValueError:
        return "error: " + r["value"], "stops"
    good = float(r["low"]) <= value <= float(r["high"])
    return "%.4g" % value, "yes" if good else "**no**"


def scenes_table():
    out = ""
    rows = read("scenes")
    for scene, quantity, low, high in unique(rows, "scene", "quantity", "low", "high"):
        mine = [r for r in rows if (r["scene"], r["quantity"]) == (scene, quantity)]
        out += "**%s**: %s, from %s to %s\n\n" % (scene[0].upper() + scene[1:], quantity, low, high)
        out += table(["options", "measured", "within"],
                     [[r["options"]] + list(verdict(r)) for r in mine]) + "\n"
    return out


def drift_table():
    rows = read("drift")
    lines = [[r["shape"], r["transfer"], r["scheme"], r["energy_most"], r["energy_last"],
              r["grown"], r["momentum"], r["angular_change"], r["angular_last"],
              "yes" if r["outcome"] == "ok" else "error: " + r["outcome"]]
             for shape in ordered({r["shape"] for r in rows}, SHAPES)
             for t in ordered({r["transfer"] for r in rows}, combos.TRANSFERS) for s in combos.SCHEMES
             for r in rows if (r["shape"], r["transfer"], r["scheme"]) == (shape, t, s)]
    return table(["shape", "transfer", "scheme", "energy, most", "energy, last", "+10 % after",
                  "momentum, change", "angular momentum, change", "last", "10^6 steps done"], lines)


def main():
    stale = []
    for name, make in (("smallest", smallest_table), ("dt", dt_table), ("beyond", beyond_table), ("sweep", sweep_table),
                       ("scenes", scenes_table), ("drift", drift_table)):
        path = os.path.join(FOLDER, name + ".inc")
        text = ".. made from bench/extremes/results by bench/extremes/tables.py\n\n" + make()
        if sys.argv[1:] == ["check"]:
            if not os.path.exists(path) or open(path).read() != text:
                stale.append(os.path.basename(path))
        else:
            os.makedirs(FOLDER, exist_ok=True)
            with open(path, "w") as f:
                f.write(text)
    if stale:
        sys.exit("out of date: " + " ".join(stale) + ": run bench/extremes/tables.py")


if __name__ == "__main__":
    main()
