#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Model of weak and strong scaling: tables and the figure of doc/src/Howto_mpm_scaling.rst.

usage: scaling_model.py                  the tables, as csv
       scaling_model.py figure FILE.png  the figure (needs matplotlib)
       scaling_model.py check LMP        messages and bytes of the model and of runs on 1 to 27 ranks

A cube of points is divided into p x p x p equal cubes. Each rank reaches all nodes of its cube of
m cells and some beyond, m + LAYERS along each axis, of which it shares LAYERS with a neighbor across
a face. Between two ranks there is one message per step with the nodes that both reach. MEASURED are
numbers of this package, ASSUMED those of a cluster; nothing of that size has been run.
"""
import re
import subprocess
import sys

MEASURED = {
    "point": 33e-9,        # s per point and step, 3d, quadratic, APIC (bench/README.md)
    "ppc": 8,              # points per cell
    "record": 32,          # bytes of a node in a message
    "layers": 3.5,         # nodes that two ranks share across a face: 3, and what points may drift
    "node": 7e-9,          # s to put a node into a message, and to add it: 5.2 to 7.7 ns
    "p2g": 0.42,           # share of a step of points to nodes
    "collectives": 1,      # sums over all ranks in a step: LAMMPS's check of distances
}
ASSUMED = {
    "cores": 64,           # of a node: ranks are placed as 4 x 4 x 4
    "network": 25e9,       # bytes/s of a node
    "memory": 200e9,       # bytes/s of a node; what stays in it is written and read once
    "message": 2e-6,       # s for each message, and for each stage of a sum over ranks
    "topology": 100,       # steps between new lists of blocks
    "exchange": 0.5e-6,    # s per rank for each of the 2 exchanges of all with all of new lists
}
SIZES = (4000, 50000, 200000, 400000)
RANKS = (1, 2, 4, 8, 12, 16, 22)    # along each axis
ACROSS_NODE = 4                     # ranks along each side of a node


def shared(cells, layers, p):
    """Nodes that a rank sends in a step, and messages: means of p x p x p ranks."""
    reach = cells + layers
    sums = (p * reach + 2 * (p - 1) * layers) / p
    return sums**3 - reach**3, ((3 * p - 2) / p)**3 - 1


def leaving(cells, layers, p):
    """The same of what leaves a node of 4 x 4 x 4 ranks."""
    inside = min(p, ACROSS_NODE)
    all_nodes, all_messages = shared(cells, layers, p)
    own_nodes, own_messages = shared(cells, layers, inside)
    return all_nodes - own_nodes, all_messages - own_messages


def step(points, p, m=MEASURED, a=ASSUMED):
    """Seconds of a step by part, with so many points on each of p x p x p ranks, and bytes sent."""
    cells = (points / m["ppc"])**(1 / 3)
    nodes, messages = shared(cells, m["layers"], p)
    out, _ = leaving(cells, m["layers"], p)
    ranks, used = p**3, min(p**3, a["cores"])
    stages = max(0, (ranks - 1).bit_length())
    parts = {
        "points": points * m["point"],
        "packing": nodes * m["node"],
        "network": out * m["record"] * used / a["network"],
        "memory": (nodes - out) * m["record"] * 2 * used / a["memory"],
        "latency": messages * a["message"],
        "sums": m["collectives"] * stages * a["message"],
        "lists": 2 * a["exchange"] * (ranks - 1) / a["topology"],
    }
    return parts, nodes * m["record"]


def efficiency(points, p, **change):
    parts, _ = step(points, p, dict(MEASURED, **change))
    return parts["points"] / sum(parts.values())


def hidden(points, p):
    """Share of a step that would be saved if the network worked while points of inner blocks go to the
    nodes: those of blocks without shared nodes, of 4 cells along each side."""
    parts, _ = step(points, p)
    blocks = (points / MEASURED["ppc"])**(1 / 3) / 4
    inner = max(0.0, 1 - 2 / blocks)**3
    wait = parts["network"] + parts["latency"]
    return min(wait, inner * MEASURED["p2g"] * parts["points"]) / sum(parts.values())


def tables():
    p = RANKS[-1]
    names = list(step(SIZES[0], p)[0])
    print("points per rank,MB sent,messages," + ",".join(name + " ms" for name in names) +
          ",efficiency %,saved by overlap %")
    for points in SIZES:
        parts, sent = step(points, p)
        messages = shared((points / MEASURED["ppc"])**(1 / 3), MEASURED["layers"], p)[1]
        print("%d,%.2f,%.0f,%s,%.0f,%.0f" %
              (points, 1e-6 * sent, messages, ",".join("%.3f" % (1e3 * t) for t in parts.values()),
               100 * efficiency(points, p), 100 * hidden(points, p)))
    print("\nweak scaling: efficiency %% by ranks\npoints per rank,%s" %
          ",".join(str(q**3) for q in RANKS))
    for points in SIZES:
        print("%d,%s" % (points, ",".join("%.0f" % (100 * efficiency(points, q)) for q in RANKS)))
    print("\nstrong scaling: steps per second, and efficiency %% by ranks\npoints,%s" %
          ",".join(str(q**3) for q in RANKS))
    for total in (1e6, 1e8, 1e9):
        row = []
        for q in RANKS:
            time = sum(step(total / q**3, q)[0].values())
            row.append("%.3g (%.0f)" % (1 / time, 100 * efficiency(total / q**3, q)))
        print("%.0e,%s" % (total, ",".join(row)))


def figure(path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams["svg.hashsalt"] = "mpm"
    fig, axes = plt.subplots(1, 2, figsize=(9, 3.6))
    counts = range(1, RANKS[-1] + 1)
    for points in SIZES:
        axes[0].semilogx([q**3 for q in counts], [100 * efficiency(points, q) for q in counts],
                         label="%s points per rank" % format(points, ","))
    axes[0].set(xlabel="ranks", ylabel="efficiency [%]", ylim=(0, 102), title="weak scaling")
    for total in (1e6, 1e8, 1e9):
        rate = [1 / sum(step(total / q**3, q)[0].values()) for q in counts]
        axes[1].loglog([q**3 for q in counts], rate,
                       label="$10^%d$ points" % (len("%d" % total) - 1))
        axes[1].loglog([q**3 for q in counts],
                       [q**3 / total / MEASURED["point"] for q in counts], "k:", linewidth=0.7)
    axes[1].set(xlabel="ranks", ylabel="steps per second",
                title="strong scaling (dotted: ideal)")
    for ax in axes:
        ax.legend(fontsize=8)
        ax.grid(alpha=0.3)
    fig.tight_layout()
    fig.savefig(path, dpi=100, metadata={"Software": None})


BLOCK = """
units lj
processors {p[0]} {p[1]} {p[2]}
boundary f f f
atom_style mpm
neighbor 0.5 bin
region box block 0 {n[0]} 0 {n[1]} 0 {n[2]}
create_box 1 box
fix grid all mpm 1.0 plan yes
create_points 1 region box ppc 2
fix rubber all mpm/material density 1.0 neohookean 100.0 0.3
timestep 0.02
run 3
"""


def check(lmp):
    """At rest, points next to a border of ranks share three layers of nodes, and the outer ones end alike."""
    print("ranks,cells per rank,messages: model,run,bytes: model,run")
    wrong = 0
    for m in (4, 8, 12):
        for p in (2, 1, 1), (2, 2, 1), (2, 2, 2), (3, 3, 3):
            ranks = p[0] * p[1] * p[2]
            sums = own = 1
            for q in p:
                sums *= q * (m + 3) + 2 * (q - 1) * 3
                own *= q * (m + 3)
            neighbors = 1
            for q in p:
                neighbors *= 3 * q - 2
            model = neighbors - ranks, MEASURED["record"] * (sums - own)
            done = subprocess.run(["mpirun", "-np", str(ranks), "--oversubscribe", lmp, "-log", "none"],
                                  input=BLOCK.format(p=p, n=[m * q for q in p]), text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            found = re.search(r"(\d+) halo bytes per step in (\d+) messages", done.stdout)
            if not found:
                sys.exit(done.stdout[-2000:])
            run = int(found.group(2)), int(found.group(1))
            print("%d,%d,%d,%d,%d,%d" % (ranks, m, model[0], run[0], model[1], run[1]), flush=True)
            wrong += model != run
    if wrong:
        sys.exit("%d of these differ" % wrong)


if __name__ == "__main__":
    if sys.argv[1:2] == ["figure"] and len(sys.argv) == 3:
        figure(sys.argv[2])
    elif sys.argv[1:2] == ["check"] and len(sys.argv) == 3:
        check(sys.argv[2])
    elif len(sys.argv) == 1:
        tables()
    else:
        sys.exit(__doc__)
