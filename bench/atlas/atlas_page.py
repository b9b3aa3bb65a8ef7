#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Page of the manual from the results of the atlas.

usage: atlas_page.py [--data FOLDER] [--check]

Writes doc/src/Howto_mpm_choose.rst and the figures doc/src/img/atlas_*.png from runs.csv, cost.csv,
and campaigns.csv.  With --check nothing is written, and the exit code is 1 if the page is not what
the tables give.
"""
import argparse
import math
import os
import statistics
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes as sc    # noqa: E402
import results as rs    # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
DOC = os.path.join(HERE, "..", "..", "doc", "src")
PAGE = os.path.join(DOC, "Howto_mpm_choose.rst")
BASE = rs.DEFAULT + sc.MIDDLE
FAR = 10           # times the goal: errors that are not worth showing
CHANCE = 1.15      # times the error or the time: no difference


def number(x, digits=2):
    """x with some significant digits, without exponent where that is readable."""
    if x is None or x != x:
        return "-"
    if x == 0:
        return "0"
    exponent = math.floor(math.log10(abs(x)))
    if exponent < -4 or exponent > 5:
        return "%.*e" % (digits - 1, x)
    return "%.*f" % (max(0, digits - 1 - exponent), x)


def percent(x, digits=2):
    return "-" if x is None else number(100 * x, digits) + " %"


def table(head, rows, widths=None):
    """List table of reStructuredText."""
    lines = [".. list-table::", "   :header-rows: 1"]
    if widths:
        lines.append("   :widths: " + " ".join(str(w) for w in widths))
    lines.append("")
    for row in [head] + rows:
        for k, cell in enumerate(row):
            lines.append(("   * - %s" if k == 0 else "     - %s") % cell)
    return "\n".join(line.rstrip() for line in lines) + "\n"


def options(c):
    """Settings as in an input, defaults left out."""
    words = []
    for name, value, default in zip(sc.SETTINGS, c, BASE):
        if name in ("shape", "transfer") or (name in ("scheme", "frame") and value != default):
            words.append("%s %s" % (name, value))
    return "*" + " ".join(words) + "*"


def times_to_goal(data, scene):
    """{(shape, transfer, scheme, frame): seconds of processor time to the goal of the scene} of runs that
    reach it, or by interpolation between spacings or extrapolation to at most half of the finest; what does not
    reach it, or creates energy, is not there.  All with the points per cell and time step of the factorial, so that
    what has been tried in more ways has no advantage; where much is stretched, with more points, too."""
    if scene in data.goals:
        return data.goals[scene]
    ladders, best = {}, {}
    ppc = (sc.MIDDLE[0], "3") if sc.SCENES[scene].get("stretch") else sc.MIDDLE[:1]
    for r in data.rows[scene]:
        if r["time"] and r["ppc"] in ppc and r["dtfrac"] == sc.MIDDLE[1] and not data.creates_energy(scene, rs.key(r)[:4]):
            ladders.setdefault(rs.key(r)[:-1], []).append(r)
    goal = sc.SCENES[scene]["goal"]
    for setting, rungs in ladders.items():
        rungs.sort(key=lambda r: -float(r["h"]))
        for r in rungs:
            if r["credited"] <= goal:
                best[setting[:4]] = min(best.get(setting[:4], r["time"]), r["time"])
        for a, b in zip(rungs, rungs[1:]):
            if a["credited"] <= b["credited"]:
                continue
            ratio = math.log(float(a["h"]) / float(b["h"]))
            order = math.log(a["credited"] / b["credited"]) / ratio
            work = math.log(b["time"] / a["time"]) / ratio
            h = float(b["h"]) * (goal / b["credited"])**(1 / order)
            finest = 0.5 * float(b["h"]) if b is rungs[-1] else float(b["h"])
            if finest <= h <= float(a["h"]):
                time = b["time"] * (float(b["h"]) / h)**work
                best[setting[:4]] = min(best.get(setting[:4], time), time)
    data.goals[scene] = best
    return best


def ranking(data, scene):
    """[(seconds to the goal, kind)] from the cheapest"""
    return sorted((time, kind) for kind, time in times_to_goal(data, scene).items())


def find(data, scene, c):
    """The row of a combination, None if it did not work or was not run."""
    return data.index.get((scene,) + c)


def scene_section(data, scene):
    s = sc.SCENES[scene]
    value, spread = data.reference[scene]
    out = ["%s\n%s\n" % (s["title"], "^" * len(s["title"]))]
    reference = "reference: %s" % s["source"]
    if s["reference"] != 0:
        reference += " (%s" % number(value, 4)
        reference += ", uncertain by %s" % number(spread, 1) if spread else ""
        reference += ")"
    out.append("Input: *bench/atlas/in.%s*. Error: %s; %s.\n" % (scene, s["quantity"], reference))
    out.append(".. image:: img/atlas_%s.png\n   :width: 640\n" % scene)
    rows = []
    for r in data.front(scene):
        if r["credited"] > FAR * s["goal"]:
            continue
        rows.append([number(r["time"]), percent(r["credited"]), percent(r["lost"]), number(r["ns"]),
                     str(r["bytes"]), r["points"], "%.3g" % float(r["h"]), options(rs.key(r)), r["ppc"], r["dtfrac"]])
    out.append("Pareto front: no other run was both faster and more accurate than these.\n")
    out.append(table(["time (s)", "error", "energy", "ns", "bytes", "points", "h", "settings", "ppc", "dt"], rows,
                     [8, 8, 8, 6, 6, 8, 8, 36, 6, 6]))
    best = ranking(data, scene)
    rows = [[options(kind), number(t), "%.1f" % (t / best[0][0])] for t, kind in best[:6]]
    base = [t for t, kind in best if kind == BASE[:4]]
    rows.append(["the default", number(base[0]) if base else "not reached",
                 "%.1f" % (base[0] / best[0][0]) if base else "-"])
    out.append("Cheapest ways to an error of %s:\n" % percent(s["goal"], 1))
    out.append(table(["settings", "time (s)", "ratio"], rows, [60, 20, 20]))
    return "\n".join(out)


def cost_tables(data):
    """ns per point-step of shapes and transfers, and the factors of schemes, from all scenes."""
    def ns(scene, kind):
        found = data.cost.get((scene,) + kind + ("2",))
        return found[0] if found else None

    def ratio(kinds, scenes):
        """Median over scenes of the cost relative to the base."""
        values = [ns(s, kinds) / ns(s, BASE[:4]) for s in scenes if ns(s, kinds) and ns(s, BASE[:4])]
        return statistics.median(values) if values else None

    out = []
    for dimension in (2, 3):
        scenes = [s for s in sc.SCENES if sc.SCENES[s]["dimension"] == dimension and ns(s, BASE[:4])]
        rows = []
        for frame in ("updated", "total"):
            for shape in sc.SHAPES:
                cells = [ratio((shape, t, "usl", frame), scenes) for t in sc.TRANSFERS]
                if any(c is not None for c in cells):
                    rows.append([shape + (", total" if frame == "total" else "")] + [number(c) for c in cells])
        if not rows:
            continue
        base = "; ".join("%s %s" % (s, number(ns(s, BASE[:4]), 2)) for s in scenes)
        out.append("%dd, relative to *quadratic*, *apic*, *usl* (ns per point-step: %s):\n" % (dimension, base))
        out.append(table(["shape"] + list(sc.TRANSFERS), rows))
    factors = {}
    for (scene, shape, transfer, scheme, frame, ppc), (value, _) in data.cost.items():
        usl = data.cost.get((scene, shape, transfer, "usl", frame, ppc))
        if usl and scheme != "usl":
            factors.setdefault(scheme, []).append(value / usl[0])
    out.append("Schemes cost, relative to *usl* (median of all combinations and scenes): " + ", ".join(
        "*%s* %s" % (s, number(statistics.median(factors[s]))) for s in sc.SCHEMES if s in factors) + ".\n")
    return "\n".join(out)


def change_table(data):
    """Error and time when one setting is changed, at the second spacing of each scene."""
    changes = []
    for shape in sc.SHAPES:
        changes.append(("shape " + shape, {0: shape}))
    for transfer in ("pic", "flip 1.0", "flip 0.99", "flip 0.95", "tpic", "aflip 1.0", "aflip 0.99", "polypic", "xpic 2",
                     "xpic 5", "fmpm 2", "fmpm 5"):
        changes.append(("transfer " + transfer, {1: transfer}))
    for scheme in ("usf", "musl", "usavg"):
        changes.append(("scheme " + scheme, {2: scheme}))
    changes.append(("frame total", {3: "total"}))
    for ppc in ("1", "3", "4"):
        changes.append(("ppc " + ppc, {4: ppc}))
    for dt in ("0.1", "0.2", "0.6", "0.8", "1.0"):
        changes.append(("dt fraction " + dt, {5: dt}))
    rows = []
    for name, change in changes:
        if name in ("shape quadratic", "shape bernstein"):    # the base, and what needs the total frame
            continue
        cells = ["*%s*" % name]
        for scene in sc.SCENES:
            h = sc.SCENES[scene]["levels"][1]
            base = find(data, scene, BASE + (h,))
            c = list(BASE + (h,))
            for k, v in change.items():
                c[k] = v
            r = find(data, scene, tuple(c))
            if (scene,) + tuple(c) in data.failed:
                cells.append("fails")
            elif r and base and r["time"] and base["time"]:
                cells.append("%s / %s" % (number(r["error"] / base["error"]), number(r["time"] / base["time"])))
            else:
                cells.append("-")
        rows.append(cells)
    base = [percent(find(data, s, BASE + (sc.SCENES[s]["levels"][1],))["error"])
            if find(data, s, BASE + (sc.SCENES[s]["levels"][1],)) else "-" for s in sc.SCENES]
    return table(["change"] + list(sc.SCENES), [["base: error"] + base] + rows, [22] + [13] * len(sc.SCENES))


def energy_table(data):
    """Energy gained by the method for each transfer, quadratic functions, second spacing."""
    rows = []
    for transfer in sc.TRANSFERS:
        for scheme in ("usl", "musl", "usavg"):
            if transfer.startswith("fmpm") and scheme != "usl":
                continue
            cells = ["*%s*, *%s*" % (transfer, scheme)]
            for scene in sc.SCENES:
                c = ("quadratic", transfer, scheme, "updated") + sc.MIDDLE + (sc.SCENES[scene]["levels"][1],)
                r = find(data, scene, c)
                cells.append(percent(r["lost"]) if r else "fails" if (scene,) + c in data.failed else "-")
            if set(cells[1:]) != {"-"}:
                rows.append(cells)
    return table(["transfer, scheme"] + list(sc.SCENES), rows, [22] + [13] * len(sc.SCENES))


def gain_rules(data):
    """What is never recommended, and the largest gains in the variants of the scenes of flows."""
    lines = []
    for scene in sc.SCENES:
        bad = sorted(((data.most[(scene,) + kind], kind) for kind in rs.kinds(data.rows[scene])
                      if data.creates_energy(scene, kind)), reverse=True)
        if bad:
            lines.append("* %s: %s." % (scene, ", ".join("%s %s" % (
                options(kind), "fails" if gain == float("inf") else "over 100 %" if gain > 1 else percent(gain))
                                                         for gain, kind in bad)))
    return "\n".join(lines) + "\n"


def gain_table(data):
    """The largest gain over all variants for each shape and transfer, scheme usl and musl."""
    out = []
    for scene in sc.VARIANTS:
        rows = []
        for kind in dict.fromkeys(tuple(r[s] for s in sc.SETTINGS[:4]) for r in data.gains if r["scene"] == scene):
            runs = [r for r in data.gains if r["scene"] == scene and tuple(r[s] for s in sc.SETTINGS[:4]) == kind]
            good = [r for r in runs if r["status"] == "ok"]
            worst = max(good, key=lambda r: float(r["rise"]))
            rows.append((float(worst["rise"]), [options(kind), percent(float(worst["rise"])), worst["variant"], "%.3g" % float(
                worst["h"]), "%d of %d" % (len(runs) - len(good), len(runs))]))
        rows.sort(key=lambda r: r[0])
        out.append("%s:\n" % sc.SCENES[scene]["title"])
        out.append(table(["settings", "largest gain", "in the variant", "h", "runs that failed"], [r[1] for r in rows],
                         [36, 12, 36, 8, 8]))
    return "\n".join(out)


def failures(data):
    """[(share of runs of the factorial that fail, runs, what)] by shape and transfer, updated frame"""
    found = []
    for shape in sc.SHAPES:
        for transfer in sc.TRANSFERS:
            runs = [r for r in data.runs if r["shape"] == shape and r["transfer"] == transfer and
                    r["frame"] == "updated" and (r["ppc"], r["dtfrac"]) == ("2", "0.4")]
            bad = [r for r in runs if r["status"] != "ok"]
            if runs:
                found.append((len(bad) / len(runs), len(runs), shape, transfer))
    return sorted(found, key=lambda f: -f[0])


def geometric(values):
    return math.exp(statistics.mean(math.log(v) for v in values)) if values else None


def compare(data, scenes, position, value, against):
    """Median over scenes and all other settings of (time to goal with value) / (with against)."""
    ratios, only, never = [], 0, 0
    for scene in scenes:
        times = times_to_goal(data, scene)
        for kind in rs.kinds(data.rows[scene]):
            if kind[position] != value:
                continue
            t = times.get(kind)
            other = kind[:position] + (against,) + kind[position + 1:]
            u = times.get(other)
            if t and u:
                ratios.append(t / u)
            elif t:
                only += 1
            elif u:
                never += 1
    return (statistics.median(ratios) if ratios else None), len(ratios), only, never


def rule(data, scenes, position, value, against, name):
    ratio, pairs, only, never = compare(data, scenes, position, value, against)
    if ratio is None or pairs < 3:
        return None
    if ratio < 1 / CHANCE:
        what = "reaches the goal in %s of the time of *%s*" % (number(ratio), against)
    elif ratio > CHANCE:
        what = "needs %s times the time of *%s* for the goal" % (number(ratio), against)
    else:
        what = "takes as long as *%s* to the goal (%s)" % (against, number(ratio))
    more = ["median of %d pairs" % pairs]
    if only:
        more.append("%d reach it only with *%s*" % (only, value))
    if never:
        more.append("%d only with *%s*" % (never, against))
    return "* *%s* %s %s; %s." % (value, name, what, ", ".join(more))


def all_round(data, scenes):
    """[(geometric mean over scenes of the time to the goal over that of the best, number of goals missed, kind)]
    of the kinds that miss the fewest goals"""
    times = {s: times_to_goal(data, s) for s in scenes}
    found = []
    for kind in {k for s in scenes for k in rs.kinds(data.rows[s])}:
        ratios = [times[s][kind] / min(times[s].values()) for s in scenes if kind in times[s]]
        if ratios:
            found.append((len(scenes) - len(ratios), geometric(ratios), kind))
    least = min(f[0] for f in found)
    return sorted((ratio, missed, kind) for missed, ratio, kind in found if missed == least)


def rules(data):
    solids = [s for s in sc.SCENES if s not in sc.FLOWS]
    flows = list(sc.FLOWS)
    out = []
    lines = []
    for scene in sc.SCENES:
        best = ranking(data, scene)
        if best:
            t, kind = best[0]
            base = [u for u, k in best if k == BASE[:4]]
            rest = ("this is the default" if kind == BASE[:4] else
                    "the default needs %s times as long" % number(base[0] / t) if base else
                    "the default does not reach it")
            lines.append("* %s, to %s: %s; %s." % (sc.SCENES[scene]["title"].lower(),
                                                  percent(sc.SCENES[scene]["goal"], 1), options(kind), rest))
    out.append("**The cheapest setting** for the goal of each scene:\n\n" + "\n".join(lines) + "\n")
    lines = []
    for name, scenes in (("all scenes", list(sc.SCENES)), ("solids", solids), ("flows", flows)):
        scenes = [s for s in scenes if times_to_goal(data, s)]
        if not scenes:
            continue
        best = all_round(data, scenes)
        missed = " (missing %d of %d goals, as all do)" % (best[0][1], len(scenes)) if best[0][1] else ""
        lines.append("* %s%s: %s." % (name, missed, ", ".join("%s %s" % (options(kind), number(ratio))
                                                             for ratio, _, kind in best[:5])))
    out.append("**All-round settings**: time to the goal relative to the cheapest setting of each scene, geometric mean "
               "over\n\n" + "\n".join(lines) + "\n")
    for name, scenes in (("solids", solids), ("flows", flows)):
        lines = []
        for shape in sc.SHAPES:
            if shape != "quadratic":
                lines.append(rule(data, scenes, 0, shape, "quadratic", "with the same transfer and scheme"))
        for transfer in sc.TRANSFERS:
            if transfer != "apic":
                lines.append(rule(data, scenes, 1, transfer, "apic", "with the same shape and scheme"))
        for scheme in ("usf", "musl", "usavg"):
            lines.append(rule(data, scenes, 2, scheme, "usl", "with the same shape and transfer"))
        if name == "solids":
            lines.append(rule(data, scenes, 3, "total", "updated", "with the same of all else"))
        lines = [line for line in lines if line]
        if lines:
            out.append("**In %s** (%s):\n\n" % (name, ", ".join(scenes)) + "\n".join(lines) + "\n")
    worst = [f for f in failures(data) if f[0] >= 0.1]
    if worst:
        out.append("**What breaks.** Of the runs in the updated frame these end with an inverted point or one that "
                   "has left the box: " + ", ".join("*%s* with *%s* %s of %d" % (shape, transfer, percent(share), n)
                                                    for share, n, shape, transfer in worst) +
                   ".  All other pairs of shape and transfer fail in less than a tenth of their runs.  Linear functions were run "
                   "without the *light* keyword of :doc:`fix mpm <fix_mpm>`; *fmpm* needs smaller time steps than the "
                   "others.\n")
    return "\n".join(out)


def page(data, campaigns):
    used = {r["campaign"] for r in data.runs} | {r["campaign"] for r in data.costs}
    machines = "; ".join(dict.fromkeys("%s: %s, %s, LAMMPS %s" % (c["date"], c["machine"], c["compiler"], c["lammps"])
                                       for c in campaigns if c["campaign"] in used))
    with open(os.path.join(HERE, "page.rst.in")) as file:
        text = file.read()
    parts = {
        "RUNS": "%d" % len(data.runs),
        "FAILED": "%d" % sum(r["status"] != "ok" for r in data.runs),
        "COSTS": "%d" % len(data.costs),
        "MEDIANS": "%d" % sum(int(r["pairs"]) > 1 for r in data.costs),
        "MACHINES": machines,
        "RULES": rules(data),
        "SCENES": "\n".join(scene_section(data, scene) for scene in sc.SCENES if data.front(scene)),
        "CHANGES": change_table(data),
        "ENERGY": energy_table(data),
        "MOST": percent(sc.MOST_GAIN, 1),
        "GAINRUNS": "%d" % len(data.gains),
        "NEVER": gain_rules(data),
        "GAINS": gain_table(data),
        "COST": cost_tables(data),
    }
    for name, value in parts.items():
        text = text.replace("@%s@" % name, value.rstrip("\n"))
    return text


COLORS = {"linear": "tab:blue", "quadratic": "tab:orange", "cubic": "tab:green", "gimp": "tab:red",
          "cpgimp": "tab:purple", "cpdi": "tab:brown", "cpdi2": "tab:cyan", "bernstein": "tab:olive"}
MARKERS = {"pic": "x", "flip": "o", "apic": "s", "tpic": "D", "aflip": "^", "polypic": "*", "xpic": "v", "fmpm": "P"}


def figures(data, folder):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.lines import Line2D
    os.makedirs(folder, exist_ok=True)
    for scene in sc.SCENES:
        front = data.front(scene)
        if not front:
            continue
        fig, ax = plt.subplots(figsize=(8, 5), dpi=100)
        for r in data.rows[scene]:
            if not r["time"]:
                continue
            color, marker = COLORS[r["shape"]], MARKERS[r["transfer"].split()[0]]
            face = color if r["frame"] == "updated" or marker == "x" else "none"
            ax.scatter(r["time"], 100 * r["credited"], s=26, marker=marker, edgecolors=None if marker == "x" else color,
                       facecolors=face, linewidths=0.9, alpha=0.55)
        ax.plot([r["time"] for r in front], [100 * r["credited"] for r in front], "k-", lw=1.2, drawstyle="steps-post",
                zorder=3)
        ax.axhline(100 * sc.SCENES[scene]["goal"], color="gray", lw=0.8, ls=":")
        ax.set_xscale("log")
        ax.set_yscale("log")
        worst = max(r["credited"] for r in data.rows[scene])
        ax.set_ylim(70 * front[-1]["credited"], 130 * min(1.0, worst))
        ax.set_xlabel("processor time (s)")
        ax.set_ylabel("error (%)")
        ax.set_title(sc.SCENES[scene]["title"], fontsize=11)
        ax.grid(True, which="major", lw=0.4, alpha=0.5)
        shapes = [Line2D([], [], color=COLORS[s], marker="o", ls="", label=s) for s in sc.SHAPES]
        transfers = [Line2D([], [], color="k", marker=m, ls="", mfc="k", label=t) for t, m in MARKERS.items()]
        frames = [Line2D([], [], color="k", marker="o", ls="", mfc="none", label="frame total"),
                  Line2D([], [], color="k", lw=1.2, label="Pareto front"),
                  Line2D([], [], color="gray", lw=0.8, ls=":", label="goal")]
        ax.legend(handles=shapes + transfers + frames, fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5),
                  frameon=False)
        fig.tight_layout()
        fig.savefig(os.path.join(folder, "atlas_%s.png" % scene), metadata={"Software": None})
        plt.close(fig)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", default=HERE)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    data = rs.Results(rs.read(os.path.join(arguments.data, "runs.csv")),
                      rs.read(os.path.join(arguments.data, "cost.csv")),
                      rs.read(os.path.join(arguments.data, "gains.csv")))
    text = page(data, rs.read(os.path.join(arguments.data, "campaigns.csv")))
    if arguments.check:
        with open(PAGE) as file:
            same = file.read() == text
        print("the page is %s" % ("what the tables give" if same else "not what the tables give: run atlas_page.py"))
        sys.exit(0 if same else 1)
    with open(PAGE, "w") as file:
        file.write(text)
    figures(data, os.path.join(DOC, "img"))


if __name__ == "__main__":
    main()
