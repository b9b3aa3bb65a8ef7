#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Atlas of the variants of fix mpm: what each costs, and how accurate it is, on seven scenes.

usage: atlas.py LMP [--out FOLDER] [--scene NAME ...] [--limit N] [--again]

Runs what is missing in FOLDER (default: the folder of this file) and goes on where it stopped:
  runs.csv       one line for each combination of settings, from one run: quantity of interest,
                 energy gained by the method, steps
  cost.csv       one line for each combination but for dtfrac: ns of processor time per point-step
                 without ledger and exact solution, from the median ratio to a reference combination
                 that runs in turn with it; bytes per point
  gains.csv      one line for each variant of a scene of flows and setting: the energy that the method
                 has created since its lowest value, over that in play
  campaigns.csv  date, machine, compiler, and versions that the lines refer to

Order: reference runs, full factorial of shape, transfer, scheme and frame at two spacings, other
settings one at a time, costs, then finer spacings, other points per cell and time steps for what is
on the Pareto front.  atlas_page.py makes the page of the manual from these files.
"""
import argparse
import csv
import datetime
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes as sc    # noqa: E402
import results as rs    # noqa: E402
import atlas_page    # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
TIMEOUT = 300              # seconds for one run
SLOW = 2.5                 # seconds: runs beside the factorial that would take longer are left out
COST_WORK = 2.0e6          # point-steps of a run that measures cost
PAIRS = 5                  # of runs of a combination and of the reference in turn
CHEAPEST = 16              # settings of a scene whose variants are run
PASSES = 1                 # of refinements around the front


def lammps(lmp, scene, settings, more):
    """Run one scene; return (values printed at its end or None, seconds of processor time, output)."""
    command = [lmp, "-nocite", "-log", "none", "-in", "in.run"]
    values = dict(zip(sc.SETTINGS, settings))
    for name in sc.SETTINGS:
        command += ["-v", name, values[name]]
    for name, value in more.items():
        command += ["-v", name, value]
    env = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
               OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "in.run"), "w") as file:
            file.write('include "%s"\n' % os.path.join(HERE, "in." + scene) +
                       'print "RESULT $(v_q:%.10g) $(v_lost:%.6g) $(step) $(atoms)"\n')
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            done = subprocess.run(command, cwd=folder, env=env, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TIMEOUT)
            output = done.stdout.decode(errors="replace")
        except subprocess.TimeoutExpired:
            output = "ERROR: timeout"
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    found = re.search(r"^RESULT (\S+) (\S+) (\S+) (\S+)$", output, re.M)
    return found.groups() if found else None, seconds, output


def why(output):
    """A word for why a run has failed."""
    error = re.search(r"^ERROR.*", output, re.M)
    text = error.group(0) if error else output[-200:]
    for word, pattern in (("left", "has left the box"), ("inverted", "nverted|not positive|not finite|J ="),
                          ("dt", "[Tt]ime ?step"), ("timeout", "timeout"), ("left", "Lost atoms")):
        if re.search(pattern, text):
            return word
    raise SystemExit("this failed for a reason that is none of the method:\n" + output[-1500:])


class Atlas:
    def __init__(self, lmp, out, limit):
        self.lmp, self.out, self.limit, self.count, self.start = lmp, out, limit, 0, time.time()
        self.runs = rs.read(os.path.join(out, "runs.csv"))
        self.costs = rs.read(os.path.join(out, "cost.csv"))
        self.gains = rs.read(os.path.join(out, "gains.csv"))
        self.campaign = self.new_campaign()
        self.reference = None    # scene, settings, number of points

    def new_campaign(self):
        """Line of campaigns.csv for this machine, day, and program."""
        text = subprocess.run([self.lmp, "-h"], stdout=subprocess.PIPE,
                              stdin=subprocess.DEVNULL).stdout.decode(errors="replace")
        version = re.search(r"Simulator - (.+)", text).group(1).strip()
        compiler = re.search(r"Compiler: (.+?)(?: with .*)?$", text, re.M).group(1)
        model = "unknown"
        if os.path.exists("/proc/cpuinfo"):
            with open("/proc/cpuinfo") as file:
                found = re.search(r"model name\s*: (.*)", file.read())
                model = found.group(1).strip() if found else model
        package = subprocess.run(["git", "-C", HERE, "rev-parse", "--short", "HEAD"],
                                 stdout=subprocess.PIPE).stdout.decode().strip()
        row = {"date": datetime.date.today().isoformat(), "machine": "%s, %d cores" % (model, os.cpu_count()),
               "compiler": compiler, "lammps": version, "package": package}
        path = os.path.join(self.out, "campaigns.csv")
        known = rs.read(path)
        for other in known:
            if all(other[k] == row[k] for k in row):
                return other["campaign"]
        row["campaign"] = str(len(known) + 1)
        self.append("campaigns.csv", rs.CAMPAIGN, row)
        return row["campaign"]

    def append(self, name, columns, row):
        path = os.path.join(self.out, name)
        new = not os.path.exists(path)
        with open(path, "a", newline="") as file:
            writer = csv.DictWriter(file, columns, lineterminator="\n", extrasaction="ignore")
            if new:
                writer.writeheader()
            writer.writerow(row)

    def rewrite(self, name, columns, rows):
        path = os.path.join(self.out, name)
        with open(path + ".new", "w", newline="") as file:
            writer = csv.DictWriter(file, columns, lineterminator="\n", extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)
        os.replace(path + ".new", path)

    def progress(self, text):
        self.count += 1
        print("%5d %6.0f s  %s" % (self.count, time.time() - self.start, text), flush=True)
        if self.limit and self.count >= self.limit:
            sys.exit("stopped after %d runs as asked" % self.limit)

    def accuracy(self, scene, combinations, most=1e9):
        known = {(r["scene"],) + rs.key(r) for r in self.runs}
        for c in combinations:
            if (scene,) + c in known or self.predicted(scene, c) > most:
                continue
            known.add((scene,) + c)
            values, seconds, output = lammps(self.lmp, scene, c, {"ledger": "yes"})
            row = dict(zip(sc.SETTINGS, c), scene=scene, campaign=self.campaign)
            if values and all(abs(float(v)) < 1e30 for v in values):
                row.update(status="ok", q=values[0], lost=values[1], steps=values[2], points=values[3])
            else:
                row.update(status="inverted" if values else why(output))
            self.runs.append(row)
            self.append("runs.csv", rs.RUNS, row)
            self.progress("%-10s %-60s %-8s q %-13s %.2f s" % (scene, " ".join(c), row["status"],
                                                            row.get("q", ""), seconds))

    def gain(self, scene, kinds):
        """Energy that settings create in the variants of a scene."""
        known = {(r["scene"], r["variant"], r["h"]) + tuple(r[s] for s in sc.SETTINGS[:4]) for r in self.gains}
        for kind in kinds:
            for level, h in enumerate(sc.SCENES[scene]["levels"][:2]):
                for variant in sc.VARIANTS[scene]:
                    if level and variant.get("aspect") == "8":    # many points
                        continue
                    name = " ".join("%s=%s" % item for item in variant.items())
                    if (scene, name, h) + kind in known:
                        continue
                    values, seconds, output = lammps(self.lmp, scene, kind + sc.MIDDLE + (h,),
                                                     dict(variant, ledger="yes", every="20"))
                    row = dict(zip(sc.SETTINGS[:4], kind), scene=scene, variant=name, h=h, campaign=self.campaign)
                    rise = rs.rise(output)
                    row.update(dict(status="ok", rise="%.4g" % rise) if values and rise < 1e30 else
                               dict(status=why(output) if not values else "inverted"))
                    self.gains.append(row)
                    self.append("gains.csv", rs.GAINS, row)
                    self.progress("%-5s %-40s %-50s %-8s %s %.2f s" % (scene, name, " ".join(kind + (h,)), row["status"],
                                                                     row.get("rise", ""), seconds))

    def predicted(self, scene, c):
        """Seconds that a combination will take, from a coarser run of its kind; 0: nothing known."""
        ns = (rs.cost_of(self.costs, scene, c) or 100.0) + sc.SCENES[scene].get("extra", 0.0)
        dim, best = sc.SCENES[scene]["dimension"], 0.0
        for r in self.runs:
            if r["scene"] == scene and r["status"] == "ok" and r["frame"] == c[3]:
                ratio = float(r["h"]) / float(c[6])
                points = int(r["points"]) * (ratio * int(c[4]) / int(r["ppc"]))**dim
                steps = int(r["steps"]) * ratio * float(r["dtfrac"]) / float(c[5])
                best = max(best, 0) or points * steps * ns * 1e-9
        return best

    def points(self, scene, c):
        """Number of points of a scene; None: it does not run."""
        output = lammps(self.lmp, scene, c, {"ledger": "no", "body": "no", "steps": "10"})[2]
        found = re.search(r"MPM grid: (\d+) points", output)
        return int(found.group(1)) if found else None

    def point_step(self, scene, c, points):
        """ns of processor time per point-step, and output."""
        steps = 10 * max(20, int(0.1 * COST_WORK / points))
        values, _, output = lammps(self.lmp, scene, c, {"ledger": "no", "body": "no", "steps": str(steps)})
        if not values:
            return None, output
        return rs.loop_seconds(output) / int(values[2]) / points * 1e9, output

    def cost_row(self, scene, c):
        """Row of cost.csv. The speed of the machine changes from second to second: what counts is the ratio of a
        run to one of the reference right after it, the median of several such pairs."""
        row = dict(zip(sc.SETTINGS, c), scene=scene, campaign=self.campaign, ns="", bytes="", pairs="0")
        del row["dtfrac"]
        if not self.reference:
            self.reference = rs.REFERENCE + (self.points(*rs.REFERENCE),)
        points, ratios, references = self.points(scene, c), [], []
        while len(references) < PAIRS:
            references.append(self.point_step(*self.reference)[0])
            ns, output = self.point_step(scene, c, points) if points else (None, "")
            if not ns:
                break
            ratios.append(ns / references[-1])
        row["reference_ns"] = "%.2f" % statistics.median(references)
        if ratios:
            row.update(ns="%.2f" % (statistics.median(ratios) * statistics.median(references)),
                       pairs=str(len(ratios)), bytes=re.search(r"(\d+) bytes per point", output).group(1))
        return row

    def cost(self, scene, combinations):
        """Cost of all but dtfrac and h, at one spacing of the scene."""
        known = {(r["scene"],) + rs.cost_key(r) for r in self.costs}
        for c in combinations:
            c = c[:5] + ("0.4", sc.cost_spacing(scene))
            key = (scene,) + rs.cost_key(dict(zip(sc.SETTINGS, c)))
            if key in known:
                continue
            known.add(key)
            row = self.cost_row(scene, c)
            self.costs.append(row)
            self.append("cost.csv", rs.COST, row)
            self.progress("%-10s %-60s cost %s ns" % (scene, " ".join(c), row["ns"]))

    def cost_again(self, scene):
        """Costs that were measured by fewer pairs of runs, those of the front first."""
        front = {rs.cost_key(r) for r in rs.Results(self.runs, self.costs).front(scene)}
        few = [r for r in self.costs if r["scene"] == scene and r["ns"] and int(r["pairs"]) < PAIRS]
        for r in sorted(few, key=lambda r: rs.cost_key(r) not in front):
            row = self.cost_row(scene, tuple(dict(r, dtfrac=sc.MIDDLE[1])[s] for s in sc.SETTINGS))
            if row["ns"]:
                self.progress("%-10s %-60s cost %s ns, was %.2f" % (scene, " ".join(rs.cost_key(r)), row["ns"], float(
                    r["ns"]) * float(row["reference_ns"]) / float(r["reference_ns"])))
                r.update(row)
                self.rewrite("cost.csv", rs.COST, self.costs)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lmp")
    parser.add_argument("--out", default=HERE)
    parser.add_argument("--scene", nargs="*", default=list(sc.SCENES))
    parser.add_argument("--limit", type=int, default=0)
    parser.add_argument("--again", action="store_true",
                        help="measure costs again that are from fewer pairs of runs than now")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    atlas = Atlas(os.path.abspath(options.lmp), options.out, options.limit)
    for scene in options.scene:
        if options.again:
            atlas.cost_again(scene)
            continue
        atlas.accuracy(scene, sc.factorial(scene))
        atlas.accuracy(scene, sc.one_at_a_time(scene), SLOW)
        atlas.cost(scene, sc.costed(scene))
        atlas.cost(scene, sc.one_at_a_time(scene))
        atlas.accuracy(scene, sc.reference_runs(scene))
        for _ in range(PASSES):    # later ones next to what the first has found
            front = rs.Results(atlas.runs, atlas.costs).candidates(scene)
            atlas.cost(scene, (kind + sc.MIDDLE + (sc.cost_spacing(scene),) for kind in front))
            front = rs.Results(atlas.runs, atlas.costs).candidates(scene)
            atlas.cost(scene, sc.refinement(scene, front))
            atlas.accuracy(scene, sc.refinement(scene, front), SLOW)
        if scene in sc.VARIANTS:
            data = rs.Results(atlas.runs, atlas.costs)
            cheap = [kind for _, kind in atlas_page.ranking(data, scene) if kind[2] in ("usl", "musl")]    # for friction
            atlas.gain(scene, cheap[:CHEAPEST] + [rs.DEFAULT] * (rs.DEFAULT not in cheap[:CHEAPEST]))


if __name__ == "__main__":
    main()
