# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Results of the atlas: reading the tables, errors, times, and Pareto fronts."""
import csv
import os
import re
import statistics

import scenes as sc

RUNS = ("scene",) + sc.SETTINGS + ("status", "q", "lost", "steps", "points", "campaign")
COST = ("scene", "shape", "transfer", "scheme", "frame", "ppc", "h", "ns", "reference_ns", "bytes", "pairs", "campaign")    # pairs: of runs, in turn with the reference, that ns is the median of
GAINS = ("scene", "variant", "shape", "transfer", "scheme", "frame", "h", "status", "rise", "campaign")
CAMPAIGN = ("campaign", "date", "machine", "compiler", "lammps", "package")
NEAR = 4.0    # times the goal
DEFAULT = ("quadratic", "apic", "usl", "updated")
REFERENCE = ("bar", ("quadratic", "apic", "usl", "updated", "2", "0.4", "0.015625"))


def read(path):
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def loop_seconds(output):
    """Processor time of all loops of a run, without set-up."""
    total = 0.0
    for loop in re.split(r"^Loop time of ", output, flags=re.M)[1:]:
        share = re.search(r"^([\d.]+)% CPU use", loop, re.M)
        total += float(loop.split()[0]) * (float(share.group(1)) / 100 if share else 1.0)
    return total


def rise(output):
    """The largest rise of the last column of output in the first run of an input, which is the energy that the
    method has gained so far."""
    lowest, most = 0.0, 0.0
    for line in re.search(r"^ *Step .*\n((?: *\d.*\n)*)", output, re.M).group(1).splitlines() if "Step" in output else ():
        value = float(line.split()[-1])
        lowest, most = min(lowest, value), max(most, value - lowest)
    return most


def key(row):
    return tuple(row[s] for s in sc.SETTINGS)


def cost_key(row):
    return tuple(row[s] for s in ("shape", "transfer", "scheme", "frame", "ppc"))


def cost_of(costs, scene, c):
    """ns per point-step as measured, of a combination or, with other points per cell, of its like."""
    want = cost_key(dict(zip(sc.SETTINGS, c)))
    near = None
    for r in costs:
        if r["scene"] == scene and r["ns"]:
            have = cost_key(r)
            if have == want:
                return float(r["ns"])
            if have[:4] == want[:4]:
                near = float(r["ns"])
    return near


def kinds(rows):
    """The (shape, transfer, scheme, frame) of rows, without repetition."""
    found = []
    for r in rows:
        kind = tuple(r[s] for s in sc.SETTINGS[:4])
        if kind not in found:
            found.append(kind)
    return found


class Results:
    """Rows of runs.csv, those that worked with error, ns (at the median speed of the machine), and time."""

    def __init__(self, runs, costs, gains=()):
        self.runs, self.costs, self.gains = runs, costs, gains
        pace = [float(r["reference_ns"]) for r in costs]
        self.pace = statistics.median(pace) if pace else 1.0
        self.cost = {}
        for r in costs:
            if r["ns"]:
                self.cost[(r["scene"],) + cost_key(r)] = (float(r["ns"]) * self.pace / float(r["reference_ns"]),
                                                          int(r["bytes"]))
        self.reference = {scene: self.make_reference(scene) for scene in sc.SCENES}
        self.rows = {scene: [] for scene in sc.SCENES}
        for r in runs:
            made = self.make_row(r)
            if made:
                self.rows[r["scene"]].append(made)
        for scene, rows in self.rows.items():
            self.credit(rows, (self.reference[scene][1] or 0.0) / sc.SCENES[scene]["scale"])
        self.index = {(scene,) + key(r): r for scene, rows in self.rows.items() for r in rows}
        self.failed = {(r["scene"],) + key(r) for r in runs if r["status"] != "ok"}
        self.most = self.most_gains()
        self.goals = {}    # times to the goal, by scene, once they are known

    def most_gains(self):
        """{(scene, shape, transfer, scheme, frame): largest energy that the method has created in a run with the
        points per cell and time step of the factorial, over that in play}: until the end in the runs of the scene,
        from the lowest value in its variants"""
        most = {}
        for scene, rows in self.rows.items():
            for r in rows:
                if (r["ppc"], r["dtfrac"]) == sc.MIDDLE:
                    kind = (scene,) + key(r)[:4]
                    most[kind] = max(most.get(kind, 0.0), r["lost"])
        for r in self.gains:
            kind = (r["scene"],) + tuple(r[s] for s in sc.SETTINGS[:4])
            most[kind] = max(most.get(kind, 0.0), float(r["rise"]) if r["status"] == "ok" else float("inf"))
        return most

    def creates_energy(self, scene, kind):
        """More than is allowed in one of the runs of the scene or of its variants."""
        return self.most.get((scene,) + tuple(kind), 0.0) > sc.MOST_GAIN

    @staticmethod
    def credit(rows, uncertainty):
        """The error that a run is credited with: not less than at the next finer spacing, at most second
        order from the next coarser one, as a single error may be small by chance of its sign, and not less
        than what the reference is uncertain by."""
        ladder = {}
        for r in rows:
            ladder.setdefault(key(r)[:-1], []).append(r)
        for rungs in ladder.values():
            rungs.sort(key=lambda r: -float(r["h"]))
            for k, r in enumerate(rungs):
                r["credited"] = max(r["error"], uncertainty)
                if k > 0:
                    ratio = float(r["h"]) / float(rungs[k - 1]["h"])
                    r["credited"] = max(r["credited"], rungs[k - 1]["error"] * ratio**2)
                if k + 1 < len(rungs):
                    r["credited"] = max(r["credited"], rungs[k + 1]["error"])

    def make_reference(self, scene):
        """(value, uncertainty) of the quantity of interest; (None, None): not yet known"""
        s = sc.SCENES[scene]
        if not isinstance(s["reference"], tuple):
            return s["reference"], 0.0
        values = {key(r): float(r["q"]) for r in self.runs if r["scene"] == scene and r["status"] == "ok"}
        coarse, fine = [[values.get(base + sc.MIDDLE + (h,)) for base in s["reference"]]
                        for h in s["reference_levels"]]
        if None in coarse + fine:
            return None, None
        return statistics.mean(fine), 0.5 * (max(coarse + fine) - min(coarse + fine))

    def make_row(self, r):
        reference = self.reference[r["scene"]][0]
        if r["status"] != "ok" or reference is None:
            return None
        row = dict(r)
        row["error"] = abs(float(r["q"]) - reference) / sc.SCENES[r["scene"]]["scale"]
        row["lost"] = float(r["lost"])
        ns, size, row["measured"] = self.cost_of(r["scene"], cost_key(r))
        row["ns"], row["bytes"] = ns, size
        row["time"] = ns * 1e-9 * int(r["points"]) * int(r["steps"]) if ns else None
        return row

    def cost_of(self, scene, c):
        """(ns, bytes, True) as measured in this scene; if it was not, (ns, bytes, False) from usl or the
        default in this scene and the ratio to it in the scene where all are measured; points per cell do
        not matter for the cost of a point; (None, None, False) if all that is not known"""
        if (scene,) + c in self.cost:
            return self.cost[(scene,) + c] + (True,)
        if c[4] != "2":
            return self.cost_of(scene, c[:4] + ("2",) + c[5:])[:2] + (False,)
        other = sc.COST_SCENE[sc.SCENES[scene]["dimension"]]
        usl, default = c[:2] + ("usl",) + c[3:], DEFAULT + c[4:]
        for near, shape in ((usl, c[0]), (usl, "quadratic"), (default, c[0])):
            here = self.cost.get((scene,) + near)
            # the factor of a scheme may come from quadratic functions, too
            want, base = (other, shape) + c[1:], (other, shape if near == usl else near[0]) + near[1:]
            if here and want in self.cost and base in self.cost:
                return here[0] * self.cost[want][0] / self.cost[base][0], here[1], False
        return None, None, False

    def front(self, scene, rows=None):
        """Rows of settings that create no energy that no other one beats in both time and credited error, from fast to exact; less than a tenth
        of the error is no gain."""
        rows = [r for r in (self.rows[scene] if rows is None else rows)
                if r["time"] and not self.creates_energy(scene, key(r)[:4])]
        best, found = float("inf"), []
        for r in sorted(rows, key=lambda r: (r["time"], r["credited"])):
            if r["credited"] < 0.9 * best:
                best = r["credited"]
                found.append(r)
        return found

    def candidates(self, scene):
        """The kinds of settings on the front that come near to the goal of the scene."""
        near = NEAR * sc.SCENES[scene]["goal"]
        return kinds(r for r in self.front(scene) if r["credited"] < near)
