# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The edge of a body moves through a cell in steps of 1/50 of it.

For each position: the largest stable time step of the bar of dt_limit.py, of which the smallest is
kept; and what a release of pressure does to the points at the edge. For the latter a slab of 10
cells, periodic across, with the uniform pressure 0.01 K is let go: the exact answer is a wave behind
which points have the speed p/(rho c). Linear acoustics has no limit to the acceleration of the edge;
on a lattice it is of the order of p/(rho h).
"""
import math

import trial
from combos import combos
from dt_limit import dt_table, find_limit, first_guess, stable

POSITIONS = 50
TINY = 1e-6      # cells beyond the regular positions, where points touch a node with next to no mass
STEPS = 40
SAFE = 0.2       # fraction of h/c

# bulk modulus, density and h are 1, hence also c
SCENE = """units lj
dimension 2
boundary f p p
atom_style mpm
neighbor 0.5 bin
region box block 0 16 0 2 -0.5 0.5
create_box 1 box
fix grid all mpm 1.0 {words}
region body block 3 13 0 2 -0.5 0.5
create_points 1 region body ppc 2
displace_atoms all move {shift:.10g} 0 0
fix m all mpm/material density 1.0 eos stiffened/gas 2.0 0.49 pressure 0.01
timestep {dt}
variable v atom abs(vx)
compute v all reduce max v_v
thermo 1
thermo_style custom step c_v
thermo_modify format float %.8g
run {steps}
"""


def kick(words, shift):
    """Largest velocity of a point in p/(rho c), largest acceleration of the first step in
    p/(rho h); nan where the run stops with an error."""
    kind, out = trial.run(SCENE.format(words=words, shift=shift, dt=SAFE, steps=STEPS))
    if kind != "ok":
        return float("nan"), float("nan")
    v = [float(line.split()[1]) / 0.01 for line in out.splitlines()
         if len(line.split()) == 2 and line.split()[0].isdigit()]
    return max(v), v[1] / SAFE


def shifts():
    """Positions from 0 to 1, each also 1e-6 cells to both sides of where points meet faces."""
    regular = [k / POSITIONS for k in range(POSITIONS)]
    special = [p + side for p in (0.0, 0.25, 0.5, 0.75) for side in (-TINY, 0.0, TINY)]
    return sorted(s for s in set(regular + special) if s >= 0)


def work():
    """In the total frame the edge stays where it is on the lattice; edges: it meets no fixed face. Transfers
    that stand for others come first."""
    turn = ["flip 1.0", "apic", "aflip 1.0", "tpic", "polypic", "pic", "fmpm 2", "flip 0.99", "xpic 2", "xpic 5"]
    return sorted(((key, words) for key, words in combos()
                   if "total" not in key[0] and "edges" not in key[0]),
                  key=lambda item: turn.index(item[0][1]))


def measure():
    table = trial.Table("sweep", ["shape", "transfer", "scheme"],
                        ["limit", "limit_at", "velocity", "velocity_at", "acceleration",
                         "acceleration_at"])
    limits = dt_table()
    todo = work()
    for n, (key, words) in enumerate(todo):
        if table.has(*key):
            continue
        trial.progress(n, len(todo), "sweep of the edge: " + " ".join(key))
        lowest, at, guess = None, 0.0, first_guess(limits, "empty", key)
        for s in shifts():
            def ok(f):
                return stable(words, "bar", f, shift=s)
            if lowest is None or (lowest and not ok(lowest)):
                lowest, at = find_limit(ok, guess), s
                guess = lowest
        kicks = [(s,) + kick(words, s) for s in shifts()]

        def worst(k):
            # an error counts as the largest value
            return max(kicks, key=lambda row: math.inf if math.isnan(row[k]) else row[k])
        table.add(shape=key[0], transfer=key[1], scheme=key[2], limit="%.4g" % lowest,
                  limit_at="%.7g" % at, velocity="%.4g" % worst(1)[1],
                  velocity_at="%.7g" % worst(1)[0], acceleration="%.4g" % worst(2)[2],
                  acceleration_at="%.7g" % worst(2)[0])
