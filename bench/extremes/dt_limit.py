# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Largest stable time step, as a fraction of h/c, of a free bar of 10 x 3 (3d: 6 x 2 x 2) cells.

The bar has random velocities of 1e-4 c and no stress. All of its energy is kinetic then, so that it
is unstable if the kinetic energy is ever more than twice what it was at the start. With functions that
are modified next to fixed faces (edges) it lies in the corner of the box, where it touches these.
"""
import trial
from combos import combos, AFFINE

STEPS = 1200
XPIC_STEPS = 500     # which take long
LOWEST, HIGHEST = 0.02, 8.0
ACCURACY = 0.01

# name: (dim, points per cell and axis, displacement of the body in cells)
CASES = {
    "bar": (2, 2, 0.0),           # points at 1/4 and 3/4 of the cells
    "faces": (2, 2, 0.249),       # points 1e-3 h before a face or the middle of a cell
    "empty": (2, 2, 0.250001),    # one layer of points 1e-6 h inside otherwise empty cells
    "ppc1": (2, 1, 0.0),
    "ppc16": (2, 4, 0.0),
    "ppc64": (2, 8, 0.0),
    "3d": (3, 2, 0.0),
    "3d empty": (3, 2, 0.250001),
}

# E for a longitudinal wave speed of 1 with Poisson's ratio 0.3 and density 1
SCENE = """units lj
dimension {dim}
boundary f f {zbound}
atom_style mpm
neighbor 0.5 bin
region box block 0 16 0 9 {zbox}
create_box 1 box
fix grid all mpm 1.0 {words} dtcheck {check}
region body block {body}
create_points 1 region body ppc {ppc}
displace_atoms all move {shift} {shift} {zshift}
fix m all mpm/material density 1.0 neohookean 0.742857142857 0.3
variable vx atom random(-1e-4,1e-4,4711)
variable vy atom random(-1e-4,1e-4,815)
variable vz atom random(-1e-4,1e-4,1234)
velocity all set v_vx v_vy {vz}
timestep {dt:.10g}
thermo_modify warn reset
compute k all ke
run 0
variable start equal $(c_k)
variable growth equal c_k/v_start
{halt}
thermo 1000
thermo_style custom step c_k
run {steps}
print "growth = $(v_growth)"
"""


def scene(words, case, dt, steps=None, check=False, halt=True, shift=None):
    steps = steps if steps is not None else XPIC_STEPS if "xpic" in words else STEPS
    dim, ppc, standard = CASES[case]
    shift = standard if shift is None else shift
    small = ppc > 4
    size = {2: (4, 2) if small else (10, 3), 3: (6, 2, 2)}[dim]
    corner = 0 if "edges" in words else 3
    body = " ".join("%d %d" % (corner, corner + n) for n in size) + ("" if dim == 3 else " -0.5 0.5")
    return SCENE.format(
        dim=dim, words=words, ppc=ppc, body=body, shift=shift, zshift=shift if dim == 3 else 0,
        zbound="p" if dim == 2 else "f", zbox="-0.5 0.5" if dim == 2 else "0 9",
        vz="NULL" if dim == 2 else "v_vz", dt=dt, steps=steps,
        check="yes" if check else "no",
        halt="fix stop all halt 4 v_growth > 2.0 error soft message no" if halt else "")


def outcome(words, case, dt, **more):
    """What becomes of the run: "ok", "growth", or the error that a user would see."""
    kind, out = trial.run(scene(words, case, dt, **more))
    if kind == "ok" and not trial.value(out, "growth") <= 2.0:
        kind = "growth"
    return kind


def stable(words, case, dt, **more):
    """With bad warn, as an error would end a process that takes longer to start than the trial."""
    kind, out = trial.run(scene(words + " bad warn", case, dt, **more))
    return kind == "ok" and "WARNING: Material point" not in out and trial.value(out, "growth") <= 2.0


def find_limit(stable, guess):
    """Largest f with stable(f), stable(0.7 f) and stable(0.4 f), to ACCURACY.
    0: not even LOWEST, HIGHEST: no limit below."""
    known = {}

    def ok(f):
        f = round(f, 6)
        if f not in known:
            known[f] = stable(f)
        return known[f]

    low, high, step = None, None, 1.03
    f = guess
    while low is None or high is None:
        f = min(max(f, LOWEST), HIGHEST)
        if ok(f):
            low = f
            if f == HIGHEST:
                return HIGHEST
            f *= step
        else:
            high = f
            if f == LOWEST:
                return 0.0
            f /= step
        step *= step
    while high / low > 1.0 + ACCURACY:
        middle = (low * high) ** 0.5
        if ok(middle):
            low = middle
        else:
            high = middle
    for part in (0.7, 0.4):
        if part * low > LOWEST and not ok(part * low):
            return find_limit(stable, 0.9 * part * low)
    return low


def first_guess(table, case, key):
    """The limit of the nearest combination that is known: limits differ little within a family."""
    shape, transfer, scheme = key
    base = "apic" if transfer.split()[0] in AFFINE else "flip 1.0"
    for known in ((case,) + key, (case, shape, base, scheme), (case, shape.split()[0], transfer, scheme),
                  (case, shape.split()[0], base, scheme), ("bar",) + key):
        row = table.get(*known)
        if row and float(row["limit"]) > 0:
            return float(row["limit"])
    return 1.0


def dt_table():
    return trial.Table("dt", ["case", "shape", "transfer", "scheme"], ["limit", "beyond"])


def measure(cases=tuple(CASES)):
    table = dt_table()
    work = sorted(((case, key, words) for case in cases for key, words in combos()),
                  key=lambda item: "xpic" in item[1][1])
    for n, (case, key, words) in enumerate(work):
        if table.has(case, *key):
            continue
        trial.progress(n, len(work), "time step: %s, %s" % (case, " ".join(key)))
        limit = find_limit(lambda f: stable(words, case, f), first_guess(table, case, key))
        # what a user sees who takes 1.25 times as much, with the check of the time step
        beyond = ""
        if limit < HIGHEST and case in ("bar", "empty"):
            beyond = outcome(words, case, 1.25 * max(limit, LOWEST), steps=10000, check=True,
                             halt=False)
        table.add(case=case, shape=key[0], transfer=key[1], scheme=key[2], limit="%.4g" % limit,
                  beyond=beyond)
