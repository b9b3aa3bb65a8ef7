#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Find the cheapest settings of fix mpm for an input: short trials, error by Richardson extrapolation.

usage: mpm_choose.py LMP in.SCENE -q NAME (--error E | --time SECONDS)
                     [--relative] [--levels N] [--try "SHAPE TRANSFER SCHEME FRAME" ...] [--json FILE] [-v NAME VALUE ...]

What the input must be like (see doc/src/Howto_mpm_choose.rst):
  variable h index H             spacing of the lattice; H is the coarsest that makes sense
  variable NAME index VALUE      for each of shape, transfer, scheme, frame, ppc, dtfrac that may be changed
  variable Q equal ...           the quantity of interest, valid after the last command of the input
"""
import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "bench", "atlas"))
from results import loop_seconds    # noqa: E402
SETTINGS = ("shape", "transfer", "scheme", "frame")
DEFAULT = ("quadratic", "apic", "usl", "updated")
TRIALS = 10                  # kinds of settings that are tried
PROMISING = 4                # of these, what goes on to the finest trials
ORDERS = 0.5, 2.0            # of convergence that are believed
FINEST = 32                  # times finer than the spacing of the input: no further
REPEATS = 3                  # of trials, for the median of their times,
ENOUGH = 3.0                 # unless they have taken so many seconds together


def environment():
    return dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


class Trial:
    """One run: value of the quantity of interest, points, steps, and seconds of processor time."""

    def __init__(self, q, points, steps, seconds):
        self.q, self.points, self.steps, self.seconds = q, points, steps, seconds


class Scene:
    """An input and how to run it."""

    def __init__(self, lmp, path, quantity, variables):
        self.lmp, self.path, self.quantity = os.path.abspath(lmp), os.path.abspath(path), quantity
        self.variables = variables
        with open(path) as file:
            text = re.sub(r"&[ \t]*\n", " ", file.read())
        self.names = re.findall(r"^\s*variable\s+(\w+)\s+index\s", text, re.M)
        spacing = re.search(r"^\s*variable\s+h\s+index\s+(\S+)", text, re.M)
        if "h" in variables:
            self.h = float(variables["h"])
        elif spacing:
            self.h = float(spacing.group(1))
        else:
            sys.exit("%s: no line 'variable h index H' for the spacing of the lattice" % path)
        if not re.search(r"^\s*variable\s+%s\s+equal\s" % re.escape(quantity), text, re.M):
            sys.exit("%s: no equal-style variable %s" % (path, quantity))

    def can(self, kind):
        """Whether the input lets these settings be chosen: what it has no variable for stays as it is."""
        return all(name in self.names or value == default
                   for name, value, default in zip(SETTINGS, kind, DEFAULT))

    def arguments(self, kind, h):
        values = dict(self.variables, h="%.12g" % h)
        values.update((name, value) for name, value in zip(SETTINGS, kind) if name in self.names)
        return [word for name in values for word in ("-v", name, values[name])]

    def run(self, kind, h):
        """Output of the input with these settings."""
        with tempfile.TemporaryDirectory() as folder:
            script = os.path.join(folder, "in.trial")
            with open(script, "w") as file:
                file.write('include "%s"\nprint "QUANTITY $(v_%s:%%.15g)"\n' % (self.path, self.quantity))
            command = [self.lmp, "-in", script, "-nocite", "-log", "none", "-v", "outdir", folder]
            done = subprocess.run(command + self.arguments(kind, h), cwd=os.path.dirname(self.path), env=environment(),
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.stdout.decode(errors="replace")

    def trial(self, kind, h):
        """Trial, or None if the run fails or its quantity is not finite."""
        output = self.run(kind, h)
        found = re.search(r"^QUANTITY (\S+)", output, re.M)
        loops = re.findall(r"^Loop time of \S+ on \d+ procs for (\d+) steps with (\d+) atoms", output, re.M)
        steps = sum(int(n) for n, _ in loops)
        if not found or not steps or not math.isfinite(float(found.group(1))):
            return None
        return Trial(float(found.group(1)), int(loops[0][1]), steps, max(loop_seconds(output), 1e-4))


# takes about a tenth of a second
REFERENCE = """
units lj
dimension 2
boundary p p p
atom_style mpm
neighbor 0.5 bin
region box block 0 64 0 64 -0.5 0.5
create_box 1 box
fix grid all mpm 1.0
create_points 1 box ppc 2
fix m all mpm/material density 1 neohookean 1 0.3
velocity all ramp vx 0 0.1 x 0 64
timestep 0.1
run 100
"""


def reference_seconds(lmp):
    """Processor time of a work that is always the same: the speed that the machine has just now."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "in.reference")
        with open(path, "w") as file:
            file.write(REFERENCE)
        done = subprocess.run([lmp, "-in", path, "-nocite", "-log", "none"], env=environment(), stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return loop_seconds(done.stdout.decode(errors="replace"))


class Pace:
    """Speed of the machine, which other work changes from second to second: a reference runs before and after each
    trial. What is known of a trial is the ratio of its time to those two; seconds are those at the median of all."""

    def __init__(self, scene):
        self.scene, self.all = scene, [reference_seconds(scene.lmp)]

    def timed(self, kind, h):
        """Trial with its time relative to that of the reference: the median of some."""
        ratios, spent = [], 0.0
        while len(ratios) < REPEATS and spent < ENOUGH:
            trial = self.scene.trial(kind, h)
            if not trial:
                return None
            self.all.append(reference_seconds(self.scene.lmp))
            ratios.append(trial.seconds / statistics.mean(self.all[-2:]))
            spent += trial.seconds
        trial.seconds = statistics.median(ratios)
        return trial

    def seconds(self):
        return statistics.median(self.all)


def kinds_of_the_atlas(scene):
    """Settings that the atlas found worth trying: from its Pareto fronts near the goals, those of most scenes first."""
    import results as rs
    import scenes as sc
    folder = os.path.join(ROOT, "bench", "atlas")
    data = rs.Results(rs.read(os.path.join(folder, "runs.csv")), rs.read(os.path.join(folder, "cost.csv")),
                      rs.read(os.path.join(folder, "gains.csv")))
    votes = {}
    for name in sc.SCENES:
        for kind in data.candidates(name):
            votes[kind] = votes.get(kind, 0) + 1
    found = [DEFAULT] + [k for k in sorted(votes, key=lambda k: (-votes[k], k)) if k != DEFAULT]
    return [k for k in found if scene.can(k)][:TRIALS]


def order_of(values, ratio):
    """Order of convergence from three values on spacings that shrink by ratio; None: not monotonic."""
    a, b = values[-3] - values[-2], values[-2] - values[-1]
    if b == 0 or a / b <= 1:
        return None
    return math.log(a / b) / math.log(ratio)


def limit(values, ratio, common):
    """(extrapolated value, how far that is from the last) of one kind; common: order where its own is unknown"""
    order = order_of(values, ratio) if len(values) > 2 else None
    order = min(max(order, ORDERS[0]), ORDERS[1]) if order is not None else common
    step = (values[-1] - values[-2]) / (ratio**order - 1)
    return values[-1] + step, abs(step)


class Choice:
    """Fit of one kind: error and time at any spacing."""

    def __init__(self, kind, trials, ratio, h, exact):
        # trials from coarse to fine; errors do not grow when the spacing shrinks
        self.kind, self.h, self.last = kind, h, trials[-1]
        errors = [abs(t.q - exact) for t in trials]
        for k in range(len(errors) - 2, -1, -1):
            errors[k] = max(errors[k], errors[k + 1])
        floor = 1e-12 * (abs(exact) + abs(trials[-1].q)) + 1e-300
        order = math.log(max(errors[-2], floor) / max(errors[-1], floor)) / math.log(ratio)
        self.order = min(max(order, ORDERS[0]), ORDERS[1])
        # an error that vanishes by its sign counts as one that is second order from the spacing before
        self.error_last = max(errors[-1], errors[-2] / ratio**ORDERS[1], floor)
        a, b = trials[-2], trials[-1]
        self.dimension = max(1.0, round(math.log(b.points / a.points) / math.log(ratio)))
        # more steps with finer spacing: 1/h, 1/h^2 where viscosity limits the time step
        self.growth = math.log(b.steps / a.steps) / math.log(ratio)
        # time = steps (overhead + per_point points)
        ta, tb = a.seconds / a.steps, b.seconds / b.steps
        self.per_point = (tb - ta) / (b.points - a.points)
        if not 0.5 * tb / b.points < self.per_point <= tb / b.points:
            self.per_point = tb / b.points
        self.overhead = tb - self.per_point * b.points

    def error(self, h):
        return self.error_last * (h / self.h)**self.order

    def time(self, h):
        fine = self.h / h
        return self.last.steps * fine**self.growth * (self.overhead + self.per_point * self.last.points * fine**self.dimension)

    def spacing(self, start, fits):
        """Coarsest spacing start/n for which fits(self, spacing); None: there is none."""
        for n in range(1, FINEST + 1):
            if fits(start / n):
                return start / n
        return None


def explore(scene, kinds, levels, report):
    """{kind: trials}, exact value and its uncertainty, spacing of the finest trials, reference of the times"""
    trials, pace = {}, Pace(scene)

    def go_on(kind, level):
        found = pace.timed(kind, scene.h / 2**level)
        if found:
            trials.setdefault(kind, []).append(found)
            report("%-40s h %-10.4g q %-14.8g %8.2f s" %
                   (" ".join(kind), scene.h / 2**level, found.q, found.seconds * pace.seconds()))
        else:
            trials.pop(kind, None)
            report("%-40s h %-10.4g fails" % (" ".join(kind), scene.h / 2**level))

    for kind in kinds:
        for level in (0, 1):
            if level == 0 or kind in trials:
                go_on(kind, level)
    if not trials:
        sys.exit("all trials failed, the first of them with\n" + scene.run(kinds[0], scene.h)[-1500:])
    # the others may be right with two trials, but only these are followed
    exact = best_limit(trials)[0]
    ranked = sorted(trials, key=lambda k: Choice(k, trials[k], 2.0, scene.h / 2, exact).error_last**1.5 *
                    trials[k][-1].seconds)
    chosen = ranked[:PROMISING]
    for level in range(2, levels):
        for kind in list(chosen):
            go_on(kind, level)
            if kind not in trials:
                chosen.remove(kind)
    if not chosen:
        sys.exit("all finer trials failed")
    trials = {k: trials[k] for k in chosen}
    for found in trials.values():
        for trial in found:
            trial.seconds *= pace.seconds()
    return (trials,) + best_limit(trials) + (scene.h / 2**(max(levels, 2) - 1), pace)


def best_limit(trials):
    """(value, uncertainty) at zero spacing: median of the extrapolated values, weighted by how near the last trials
    are, and their median distance from it.  Kinds that do not show their order of convergence are given the one with
    which all kinds agree best, as they tend to the same value."""
    best = None
    for common in (1.0, 1.5, 2.0):
        limits = [limit([t.q for t in found], 2.0, common) for found in trials.values()]
        weights = [1 / (step + 1e-12 * abs(value) + 1e-300) for value, step in limits]
        half, total = 0.5 * sum(weights), 0.0
        for k in sorted(range(len(limits)), key=lambda k: limits[k][0]):
            total += weights[k]
            if total >= half:
                break
        value = limits[k][0]
        spread = statistics.median(abs(v - value) for v, _ in limits)
        if best is None or spread < best[1]:
            best = value, spread
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lmp")
    parser.add_argument("input")
    parser.add_argument("-q", "--quantity", required=True)
    goal = parser.add_mutually_exclusive_group(required=True)
    goal.add_argument("--error", type=float, help="largest error, in units of the quantity")
    goal.add_argument("--time", type=float, help="seconds of processor time of the run")
    parser.add_argument("--relative", action="store_true", help="error relative to the quantity")
    parser.add_argument("--levels", type=int, default=3, choices=(2, 3, 4), help="spacings of trials: h, h/2, ...")
    parser.add_argument("--try", dest="kinds", action="append", default=[], metavar="KIND")
    parser.add_argument("--json")
    parser.add_argument("-v", dest="variables", nargs=2, action="append", default=[])
    options = parser.parse_args()

    scene = Scene(options.lmp, options.input, options.quantity, dict(options.variables))
    kinds = [tuple(re.match(r"(\S+) (.+) (\S+) (\S+)$", k).groups()) for k in options.kinds]
    kinds = kinds or kinds_of_the_atlas(scene)
    wrong = [k for k in kinds if not scene.can(k)]
    if wrong:
        sys.exit("the input has no variables for: " + "; ".join(" ".join(k) for k in wrong))
    trials, exact, uncertain, h, pace = explore(scene, kinds, options.levels, lambda text: print(text, flush=True))
    choices = [Choice(kind, found, 2.0, h, exact) for kind, found in trials.items()]

    tolerance = options.error * abs(exact) if options.error and options.relative else options.error
    rows = []
    for c in choices:
        if tolerance:
            spacing = c.spacing(scene.h, lambda x: c.error(x) <= tolerance)
        else:    # the finest within the time
            fit = [scene.h / n for n in range(1, FINEST + 1) if c.time(scene.h / n) <= options.time]
            spacing = fit[-1] if fit else None
        if spacing:
            rows.append((c.time(spacing), c.error(spacing), spacing, c))
    print("\n%s for zero spacing: %.8g, uncertain by %.2g" % (options.quantity, exact, uncertain))
    if not rows:
        sys.exit("none of the trials reaches this: more time, a larger error, or a finer h in the input")
    rows.sort(key=lambda r: r[0] if tolerance else r[1])
    print("%10s %10s %10s %7s  settings" % ("time (s)", "error", "h", "order"))
    for time, error, spacing, c in rows:
        print("%10.3g %10.2g %10.4g %7.2f  %s" % (time, error, spacing, c.order, " ".join(c.kind)))
    time, error, spacing, c = rows[0]
    arguments = scene.arguments(c.kind, spacing)
    print("\n%s -in %s %s\npredicted: error %.2g, %.3g s of processor time" %
          (options.lmp, options.input, " ".join('"%s"' % a if " " in a else a for a in arguments), error, time))
    if tolerance and uncertain > tolerance:
        print("the value for zero spacing is less certain than that: use --levels %d" % (options.levels + 1))
    if options.json:
        with open(options.json, "w") as file:
            json.dump({"kind": c.kind, "h": spacing, "error": error, "time": time, "exact": exact,
                       "uncertain": uncertain, "arguments": arguments,
                       "reference": pace.seconds()}, file, indent=1)


if __name__ == "__main__":
    main()
