#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Atlas of heat and pore water: cost and error of the transfers of fix mpm/heat, and of the formulations of
soil with water (u-p, u-v-p, two sets of points).

usage: physics.py LMP [--out FOLDER] [--again] [--rounds N] [--points 8k|46k|405k]     measure
       physics.py --page [--data FOLDER] [--check]                                     make the page

Measuring runs what is missing in FOLDER (default: the folder of this file), with --again all of it:
  physics_runs.csv   error of each method in each scene against the exact solution, steps, points
  physics_cost.csv   time of a step with each method over that of the same scene without, the median of
                     rounds in which all methods run in turn
A method is one line in METHODS. The page is doc/src/Howto_mpm_atlas.rst, with its picture; --check tells
whether it is what the tables give.
"""
import argparse
import csv
import os
import re
import statistics
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.dirname(HERE)]
import results as rs    # noqa: E402
import run_physics as rp    # noqa: E402
from atlas_page import DOC, table    # noqa: E402

# method: (variables of the scenes, physics of in.physics, its keyword more)
METHODS = {
    "heat": {name: ({"transfer": name}, "heat", "transfer " + name)
             for name in ("relax 1", "relax 0.3", "relax 0", "affine", "xpic 2", "pic")},
    "water": {"u-p": ({"formulation": "u-p"}, "pore", " "),
              "u-p every 1": ({"formulation": "u-p every 1"}, "pore", "every 1"),
              "u-v-p": ({"formulation": "u-v-p"}, "pore", "formulation u-v-p"),
              "two sets": ({"sets": "yes"}, "sets", " ")},
}
# scene: (input, its variables, spacings, what it is)
SCENES = {
    "heat": {
        "source": ("heat", {"problem": "source"}, ("0.05", "0.025"), "smooth source in an insulated bar"),
        "short": ("heat", {"problem": "source", "share": "0.03"}, ("0.05", "0.025"), "the same, steps of 1/33"),
        "end": ("heat", {"problem": "end"}, ("0.05", "0.025"), "bar whose end is heated suddenly"),
        "end short": ("heat", {"problem": "end", "share": "0.03"}, ("0.05", "0.025"), "the same, steps of 1/33"),
        "slab": ("heat", {"problem": "convection"}, ("0.05", "0.025"), "slab cooled by convection, Bi = 1, Fo = 0.5"),
    },
    "water": {
        "consolidation": ("consolidation", {}, ("0.1", "0.05"), "consolidation at a time factor of 0.2"),
        "wave 1e-2": ("column", {"k": "1e-2", "transfer": "aflip 1.0"}, ("0.05", "0.025"),
                      "fast wave, conductivity 1e-2 m/s"),
        "wave 1e-3": ("column", {"k": "1e-3", "transfer": "aflip 1.0"}, ("0.05", "0.025"), "the same, 1e-3 m/s"),
        "wave 1e-5": ("column", {"k": "1e-5", "transfer": "aflip 1.0"}, ("0.05", "0.025"), "the same, 1e-5 m/s"),
    },
}
RUNS = ("physics", "method", "scene", "h", "error", "steps", "points")
COST = ("physics", "method", "ratio", "least", "most", "rounds", "size")


def exact_heat(problem, x):
    """Temperatures at the end of a scene of in.heat."""
    if problem == "source":
        return np.cos(np.pi * x) * (1 - np.exp(-0.1 * np.pi**2))
    if problem == "end":
        k = np.arange(1, 400)[:, None] * np.pi
        return 1 - x - np.sum(2 / k * np.sin(k * x) * np.exp(-0.1 * k**2), axis=0)
    low, high = np.arange(50) * np.pi, (np.arange(50) + 0.5) * np.pi
    for _ in range(100):    # roots of b tan(b) = 1
        b = 0.5 * (low + high)
        above = b * np.tan(b) > 1
        low, high = np.where(above, low, b), np.where(above, b, high)
    b = b[:, None]
    return np.sum(4 * np.sin(b) / (2 * b + np.sin(2 * b)) * np.exp(-0.5 * b**2) * np.cos(b * x), axis=0)


def error_heat(variables, file):
    x, T = points(file).T
    return np.sqrt(np.mean((T - exact_heat(variables["problem"], x))**2))


def points(file):
    """Rows behind the header of a dump."""
    return np.loadtxt(file, skiprows=9)


class Soil:
    """Column of saturated soil, 1 m high, by the equations of both velocities (u-v-p) for its modes with the wave number k:
    velocity v of the soil, flow w of the water, stress s (tension), and pressure p of the mode,

      rho v' + rhof w' = k (p - s) + f,  rhof v' + rhof/n w' = k p - G/conductivity w,
      s' = M k v,  p' = - K/n k (v + w),

    with a force f on the soil alone. They tend to Terzaghi's where everything is slow."""
    n, rhof, K, M, G = 0.4, 1000.0, 2.2e8, 1e7 * 0.7 / (1.3 * 0.4), 9810.0

    def __init__(self, rho, conductivity, k):
        inertia = np.linalg.inv(np.array([[rho, self.rhof], [self.rhof, self.rhof / self.n]]))
        rate = np.zeros((4, 4))
        rate[:2] = inertia @ np.array([[0, 0, -k, k], [0, -self.G / conductivity, 0, k]])
        rate[2, 0] = self.M * k
        rate[3, :2] = -self.K / self.n * k
        self.s, self.modes = np.linalg.eig(rate)
        self.force = np.append(inertia[:, 0], [0, 0])

    def free(self, t):
        """[4][t] from v = 1 on."""
        start = np.linalg.solve(self.modes, np.array([1, 0, 0, 0]))
        return (self.modes @ (start[:, None] * np.exp(np.outer(self.s, t)))).real

    def loaded(self, t, ramp):
        """[4] by a force that grows as (1 - cos(pi t/ramp))/2 up to one."""
        s, grown = self.s, 0.5 * (np.exp(self.s * t) - np.exp(self.s * (t - ramp))) / self.s
        for w in (1j * np.pi / ramp, -1j * np.pi / ramp):
            grown = grown - 0.25 * (np.exp((w - s) * ramp) - 1) * np.exp(s * t) / (w - s)
        response = grown + (np.exp(s * (t - ramp)) - 1) / s
        return (self.modes @ (np.linalg.solve(self.modes, self.force) * response)).real


def error_consolidation(variables, file):
    """Of the pressure, over the load."""
    y, p = points(file).T
    exact, ramp = np.zeros_like(p), 0.05
    end = 0.2 / (1e-3 / Soil.G / (1 / Soil.M + Soil.n / Soil.K)) + 0.5 * ramp
    for m in range(200):
        k = (m + 0.5) * np.pi
        exact -= 2 * (-1)**m * Soil(2002.0, 1e-3, k).loaded(end, ramp)[3] * np.cos(k * y)
    return np.sqrt(np.mean((p / 1e4 - exact)**2))


def error_column(variables, file):
    """Of the momentum of the mode, over its root mean square."""
    t, y = np.loadtxt(file, skiprows=1).T
    v, w, _, _ = Soil(1990.0, float(variables["k"]), np.pi).free(t)
    # points of the soil have the mass of both; two sets have the flow of the water in their momentum
    exact = v + (Soil.rhof / 1990.0 * w if "sets" in variables else 0)
    return np.sqrt(np.mean((y - exact)**2) / np.mean(exact**2))


ERRORS = {"heat": error_heat, "consolidation": error_consolidation, "column": error_column}


def measure(lmp, physics, method, scene, h):
    """Row of physics_runs.csv."""
    name, variables, _, _ = SCENES[physics][scene]
    variables = dict(variables, h=h, **METHODS[physics][method][0])
    command = [lmp, "-nocite", "-log", "none", "-in", os.path.join(HERE, "in." + name)]
    for key, value in variables.items():
        command += ["-v", key, value]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(command + ["-v", "file", "result.txt"], cwd=folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              env=dict(os.environ, OMP_NUM_THREADS="1"))
        loop = re.search(r"^Loop time of \S+ on 1 procs for (\d+) steps with (\d+) atoms", done.stdout, re.M)
        if done.returncode or not loop:
            sys.exit("%s: %s" % (" ".join(command), done.stdout[-1500:]))
        error = ERRORS[name](variables, os.path.join(folder, "result.txt"))
    return dict(physics=physics, method=method, scene=scene, h=h, error="%.3g" % error, steps=loop.group(1),
                points=loop.group(2))


def costs(lmp, physics, methods, rounds, size):
    """Rows of physics_cost.csv: a step of each method over one without the physics, in the same round."""
    n, box, number, steps = dict(rp.SIZES, **{"8k": (10, 14, 8000, 500)})[size]
    ratios = {method: [] for method in methods}

    def step(kind, more):
        thermal = "yes" if physics == "heat" else "no"
        short, long = (rp.seconds(lmp, kind, thermal, more, n, box, length) for length in (5, 5 + steps))
        return (long - short) / steps

    for _ in range(rounds):
        for method in methods:
            without = step("none", " ")
            ratios[method].append(step(*METHODS[physics][method][1:]) / without)
    return [dict(physics=physics, method=method, ratio="%.2f" % statistics.median(r), least="%.2f" % min(r),
                 most="%.2f" % max(r), rounds=str(rounds), size=str(number)) for method, r in ratios.items()]


def write(path, columns, rows):
    with open(path + ".new", "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    os.replace(path + ".new", path)


def campaign(lmp, out, again, rounds, size):
    """Measure what is missing."""
    runs_path, cost_path = os.path.join(out, "physics_runs.csv"), os.path.join(out, "physics_cost.csv")
    os.makedirs(out, exist_ok=True)
    runs, cost = ([], []) if again else (rs.read(runs_path), rs.read(cost_path))
    for physics, methods in METHODS.items():
        for method in methods:
            for scene, (_, _, spacings, _) in SCENES[physics].items():
                for h in spacings:
                    if not find(runs, physics=physics, method=method, scene=scene, h=h):
                        runs.append(measure(lmp, physics, method, scene, h))
                        print("%(physics)-6s %(method)-10s %(scene)-14s h %(h)-6s error %(error)s" % runs[-1], flush=True)
                        write(runs_path, RUNS, runs)
        missing = [m for m in methods if not find(cost, physics=physics, method=m)]
        for row in costs(lmp, physics, missing, rounds, size):
            cost.append(row)
            print("%(physics)-6s %(method)-10s times a step without: %(ratio)s (%(least)s to %(most)s)" % row, flush=True)
        write(cost_path, COST, cost)


def find(rows, **wanted):
    """The row with these values, or None."""
    for row in rows:
        if all(row[key] == value for key, value in wanted.items()):
            return row
    return None


def percent(error):
    return "%.2g %%" % (100 * float(error))


def tables(data):
    """Text of the page for each physics."""
    runs, cost = (rs.read(os.path.join(data, name)) for name in ("physics_runs.csv", "physics_cost.csv"))
    text = {}
    for physics, methods in METHODS.items():
        rows = [["a step, over one without"] + ["%s" % find(cost, physics=physics, method=m)["ratio"] for m in methods]]
        for scene, (_, _, spacings, title) in SCENES[physics].items():
            cells = []
            for m in methods:
                errors = [percent(find(runs, physics=physics, method=m, scene=scene, h=h)["error"]) for h in spacings]
                cells.append("; ".join(errors))
            rows.append([title + ", %d and %d cells" % tuple(round(1 / float(h)) for h in spacings)] + cells)
        text[physics] = table([""] + ["*%s*" % m if physics == "heat" else m for m in methods], rows,
                              [30] + [70 // len(methods)] * len(methods))
    used = find(cost, physics="water", method="u-p")
    text["rounds"], text["points"] = used["rounds"], used["size"]
    text["sets"] = find(cost, physics="water", method="two sets")["ratio"]
    text["spread"] = "%.0f" % max(100 * (float(r["most"]) - float(r["least"])) / float(r["ratio"]) for r in cost)
    return text


def page(data):
    with open(os.path.join(HERE, "physics.rst.in")) as file:
        text = file.read()
    for key, value in tables(data).items():
        text = text.replace("@%s@" % key.upper(), value)
    return text


def figure(data):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    runs, cost = (rs.read(os.path.join(data, name)) for name in ("physics_runs.csv", "physics_cost.csv"))
    fig, axes = plt.subplots(1, 2, figsize=(10.5, 5.2), dpi=100)
    for ax, (physics, methods) in zip(axes, METHODS.items()):
        for k, method in enumerate(methods):
            for j, (scene, (_, _, spacings, title)) in enumerate(SCENES[physics].items()):
                # flow through a free surface does not wait
                as_found = "u-p every 1" if (scene, method) == ("consolidation", "u-p") else method
                ratio = float(find(cost, physics=physics, method=as_found)["ratio"])
                rows = [find(runs, physics=physics, method=method, scene=scene, h=h) for h in spacings]
                # points without the physics: those of the soil alone
                work = [ratio * int(r["steps"]) * int(r["points"]) / (2 if method == "two sets" else 1) / 1e6 for r in rows]
                ax.plot(work, [100 * float(r["error"]) for r in rows], "-" + "osD^v"[j], color="C%d" % k, ms=5, lw=1,
                        mfc="C%d" % k if j % 2 == 0 else "none")
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlabel("work: million point-steps without the physics")
        ax.set_ylabel("error (%)")
        ax.grid(True, lw=0.4, alpha=0.5)
        handles = [plt.Line2D([], [], color="k", ls="", marker="osD^v"[j], ms=5, mfc="k" if j % 2 == 0 else "none",
                              label=scene[3]) for j, scene in enumerate(SCENES[physics].values())]
        ax.legend(handles=handles, fontsize=7, loc="upper left", bbox_to_anchor=(0, -0.14), frameon=False, ncol=2)
        fig.legend(handles=[plt.Line2D([], [], color="C%d" % k, lw=2, label=m) for k, m in enumerate(methods)],
                  fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 1.1), ncol=len(methods), frameon=False,
                   columnspacing=1.0, handlelength=1.2, bbox_transform=ax.transAxes)
    fig.tight_layout(rect=(0, 0, 1, 0.95))
    fig.savefig(os.path.join(DOC, "img", "atlas_physics.png"), metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lmp", nargs="?")
    parser.add_argument("--out", default=HERE)
    parser.add_argument("--data", default=HERE)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--points", default="46k")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if options.lmp:
        campaign(os.path.abspath(options.lmp), options.out, options.again, options.rounds, options.points)
    elif options.page or options.check:
        path = os.path.join(DOC, "Howto_mpm_atlas.rst")
        if options.check:
            with open(path) as file:
                sys.exit(0 if file.read() == page(options.data) else "%s is not what the tables give" % path)
        with open(path, "w") as file:
            file.write(page(options.data))
        figure(options.data)
    else:
        parser.error("LMP or --page")


if __name__ == "__main__":
    main()
