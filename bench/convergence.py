#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Order of convergence of every shape, transfer, and frame with manufactured solutions.

   python3 bench/convergence.py LMP [SCENE ...]    runs what convergence.csv does not have yet
   python3 bench/convergence.py                    only writes the tables of the manual from convergence.csv
   python3 bench/convergence.py --check            only looks whether they are what convergence.csv gives

Scenes: displacement along the axis of a bar between walls (M. Steffen et al., CMES 31 (2008) 107) with
small and with large amplitude, and the generalized vortex (K. Kamojjala et al., Eng. Comput. 31
(2015) 269) with a small angle and the large one of the literature. A new variant is one more line below;
delete lines of convergence.csv to have them measured again. Orders that are not those of theory need a
reason in DEPARTURES, or the tables are not written.
"""
import csv
import math
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(HERE, "convergence.csv")
MANUAL = os.path.join(HERE, "..", "doc", "src", "convergence.inc")

# name: options; those of bars have points of half a cell by a whole cell

SHAPES = {
    "linear": "shape linear",
    "quadratic": "shape quadratic",
    "cubic": "shape cubic",
    "gimp": "shape gimp ASPECT",
    "cpgimp": "shape cpgimp ASPECT",
    "cpdi": "shape cpdi ASPECT",
    "cpdi2": "shape cpdi2 ASPECT",
    "bernstein": "shape bernstein",
    "linear mixed": "shape linear precision mixed",
    "quadratic mixed": "shape quadratic precision mixed",
    "cubic mixed": "shape cubic precision mixed",
    "quadratic modified": "shape quadratic edges modified",
    "cubic modified": "shape cubic edges modified",
}
TRANSFERS = ["pic", "flip 1.0", "apic", "aflip 1.0", "tpic", "polypic", "xpic 2", "fmpm 2"]
FRAMES = {
    "updated": "frame updated",
    "total": "frame total",
    "update": "frame total reference update RATIO",
}


def scheme(shape, transfer, frame):
    """Linear functions of the updated frame are not sound with USL, fmpm knows USL only."""
    if shape.startswith("linear") and frame == "updated" and not transfer.startswith("fmpm"):
        return "musl"
    return "usl"


BAR = """
clear
units si
dimension 2
boundary f p p
atom_style mpm
neighbor $(0.4/{n}) bin
variable h equal 1.0/{n}
region box block 0 1 0 $({rows}*v_h:%.17g) -0.5 0.5
create_box 1 box
fix grid all mpm $(v_h:%.17g) {options}
create_points 1 box ppc 2 1
fix m all mpm/material density 1000 neohookean 1.0e7 0.0
fix sides all mpm/boundary xlo xhi slip
variable v0 atom {G}*PI*100*sin(PI*x)
velocity all set v_v0 0 0
compute d all displace/atom
variable X atom x-c_d[1]
variable g equal {G}*sin(100*PI*time)
variable u atom v_g*sin(PI*v_X)
variable F atom 1+v_g*PI*cos(PI*v_X)
variable f atom mass*PI^2*v_u/1000*(0.5e7*(1+1/v_F^2)-1e7)
fix body all addforce v_f 0 0
variable ex atom v_X+v_u
compute e all mpm/error x v_ex
timestep $(0.002*v_h:%.17g)
thermo $(ceil(0.0005/dt))
thermo_style custom step c_e
thermo_modify lost ignore
run $(round(0.02/dt))
print "ERROR_NORM {n} $(c_e[4])"
"""

# the motion of examples/vortex; what depends on the reference position only is stored
VORTEX = """
clear
units si
dimension 2
boundary f f p
atom_style mpm
neighbor $(0.2/{n}) bin
variable h equal 0.5/{n}
region box block $(-1.5-v_h) $(1.5+v_h) $(-1.5-v_h) $(1.5+v_h) -0.1 0.1
create_box 1 box
region outer cylinder z 0 0 1.25 INF INF
region hole cylinder z 0 0 0.75 INF INF side out
region ring intersect 2 outer hole
fix grid all mpm $(v_h:%.17g) {options}
create_points 1 region ring ppc 2
fix soft all mpm/material density 1000 neohookean 1000 0.3
variable R atom sqrt(x*x+y*y)
variable q atom 2*(v_R-1)
variable s atom 1-8*v_q^2+16*v_q^4
variable s1 atom 2*(-16*v_q+64*v_q^3)
variable s2 atom 4*(-16+192*v_q^2)
variable k0 atom (3*v_s1+v_R*v_s2)/2.6
# the force that balances stress has no torque in the ring; on an array of points, with steps at the rims, it would
# turn all of it
variable t1 atom v_R*v_k0
variable t2 atom v_R^2
compute t all reduce sum v_t1 v_t2
thermo_style custom step c_t[1] c_t[2]
run 0 post no
variable t equal $(c_t[1]/c_t[2]:%.17g)
variable k1 atom v_k0-v_t*v_R
variable k2 atom v_R*v_s
variable k3 atom v_R*v_s1^2/2.6
variable k4 atom v_R*v_s^2
variable cx atom x/v_R
variable cy atom y/v_R
fix X all store/state 0 v_R v_s v_k1 v_k2 v_k3 v_k4 v_cx v_cy
variable g equal 0.5*{G}*(1-cos(2*PI*time))
variable g1 equal {G}*PI*sin(2*PI*time)
variable g2 equal 2*{G}*PI^2*cos(2*PI*time)
variable a atom v_g*f_X[2]
variable A atom v_g*f_X[3]-v_g2*f_X[4]
variable B atom v_g*v_g*f_X[5]-v_g1*v_g1*f_X[6]
variable bR atom v_A*sin(v_a)+v_B*cos(v_a)
variable bT atom v_B*sin(v_a)-v_A*cos(v_a)
variable fx atom mass*(v_bR*f_X[7]-v_bT*f_X[8])
variable fy atom mass*(v_bR*f_X[8]+v_bT*f_X[7])
fix body all addforce v_fx v_fy 0
variable ex atom f_X[1]*(f_X[7]*cos(v_a)-f_X[8]*sin(v_a))
variable ey atom f_X[1]*(f_X[8]*cos(v_a)+f_X[7]*sin(v_a))
compute e all mpm/error x v_ex y v_ey
timestep $(0.2*v_h/{speed}:%.17g)
# velocities are those at -dt/2, when the ring is not at rest
variable w0 equal -{G}*PI*sin(PI*dt)
variable v0x atom -v_w0*v_s*y
variable v0y atom v_w0*v_s*x
velocity all set v_v0x v_v0y 0
thermo $(ceil(0.025/dt))
thermo_style custom step c_e
run $(round(1/dt))
print "ERROR_NORM {n} $(c_e[4])"
"""

MAIN = ("flip 1.0", "apic")    # transfers that are run where all differ little, or fail


class Scene:
    """Input, numbers of cells, how many of the finest the order is the slope of (with the steps of the array of points at
    curved rims, the slope of two scatters), the ratio of stretches at which reference update makes a new one. TEARS: the
    strain breaks bodies in the updated frame, and few transfers are enough to show it."""

    def __init__(self, title, template, cells, span, ratio, tears=False, **values):
        self.title, self.template, self.cells, self.span = title, template, cells, span
        self.ratio, self.tears, self.values = ratio, tears, values

    def has(self, shape, transfer, frame):
        """Whether the combination says something here: walls for modified edges, strain for reference updates. The
        vortex takes longer and has fewer of those that differ little in the bar."""
        if frame == "update" and (self.ratio is None or shape not in ("linear", "quadratic", "cubic", "bernstein")):
            return False
        if self.template is BAR:
            return True
        if "modified" in shape or shape == "linear mixed" or self.tears and "mixed" in shape:
            return False
        if frame == "update" and shape == "bernstein":
            return False
        few = frame == "update" or "mixed" in shape or shape == "cpdi2" or self.tears and (frame, shape) != (
            "total", "quadratic")
        return transfer in MAIN or not few

    def numbers(self, shape, transfer, frame):
        """Numbers of cells."""
        if self.tears and frame == "updated" and not shape.startswith("cpdi"):
            return self.cells[:2]    # bodies have come apart already
        return self.cells


SCENES = {
    "bar-small": Scene("Bar, amplitude 0.0001: no point leaves its cell", BAR, (8, 16, 32, 64, 128), 2, None,
                       G=1e-4),
    "bar-large": Scene("Bar, amplitude 0.05: points cross cells", BAR, (8, 16, 32, 64, 128), 2, 1.05, G=0.05),
    "vortex": Scene("Generalized vortex, largest angle 0.1", VORTEX, (5, 10, 20), 3, 1.2, G=0.1, speed=1.6),
    "vortex-large": Scene("Generalized vortex, largest angle 1", VORTEX, (5, 10, 20), 3, 1.5, tears=True, G=1.0,
                          speed=5.06),
}


def measure(lmp, scene, shape, transfer, frame, numbers):
    """Errors by number of cells; None: the combination is refused, NaN: the run fails, and those behind it are not done."""
    s = SCENES[scene]
    options = "%s transfer %s scheme %s %s dtcheck no bad warn" % (
        SHAPES[shape].replace("ASPECT", "aspect 1 2" if s.template is BAR else ""), transfer,
        scheme(shape, transfer, frame), FRAMES[frame].replace("RATIO", str(s.ratio)))
    rows = 2 if shape == "bernstein" else 1    # of nodes across the bar; its cells have two
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "in.sweep"), "w") as file:
            file.write("".join(s.template.format(n=n, options=options, rows=rows, **s.values) for n in numbers))
        result = subprocess.run([lmp, "-in", "in.sweep", "-log", "none", "-nocite"], cwd=folder, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    errors = {int(n): float(e) for n, e in re.findall(r"^ERROR_NORM (\d+) (\S+)", result.stdout, re.M)}
    error = re.search(r"^ERROR\b.*", result.stdout, re.M)
    if error:
        first = next(n for n in numbers if n not in errors)
        if re.search("inverted|left the box|not finite|turned inside out", error[0]):
            errors[first] = math.nan
        elif not errors and re.search("^ERROR: Fix mpm .*(needs|is for|cannot be used|use scheme)", error[0]):
            return None
        else:
            sys.exit("%s: %s\n%s" % (scene, options, result.stdout[-2000:]))
    return errors


def read():
    rows = {}
    if os.path.exists(TABLE):
        with open(TABLE) as file:
            for row in csv.DictReader(file):
                key = row["scene"], row["shape"], row["transfer"], row["frame"]
                rows.setdefault(key, {})
                if row["cells"]:
                    rows[key][int(row["cells"])] = float(row["error"])
    return rows


def write(rows):
    with open(TABLE + ".new", "w") as file:
        file.write("scene,shape,transfer,frame,cells,error\n")
        for key in all_keys():
            for n, e in sorted(rows.get(key, {}).items()):
                file.write("%s,%d,%.4g\n" % (",".join(key), n, e))
            if key in rows and not rows[key]:
                file.write("%s,,\n" % ",".join(key))
    os.replace(TABLE + ".new", TABLE)


def all_keys():
    return [(s, shape, t, f) for s in SCENES for f in FRAMES for shape in SHAPES for t in TRANSFERS
            if SCENES[s].has(shape, t, f)]


def order(errors, span):
    """Slope of the finest errors, by least squares; None: there is none, or a run has failed."""
    known = sorted(errors.items())[-span:]
    if len(known) < 2 or not all(math.isfinite(e) for e in errors.values()):
        return None
    x, y = [math.log(n) for n, _ in known], [-math.log(e) for _, e in known]
    center = sum(x) / len(x)
    return sum((a - center) * b for a, b in zip(x, y)) / sum((a - center)**2 for a in x)


NONE, BREAKS = "none", "breaks"    # what theory and literature say where there is no order


def expected(scene, shape, transfer, frame):
    """Order for h -> 0. The solution of all these is of second order (linear fields are exact, mass is lumped, and the
    time step, in which the scheme is of second order, is proportional to h); pic takes h^2/dt of it, and what
    linear fields miss where points cross cells does not become smaller (Steffen 2008, de Vaucorbeil 2020)."""
    s = SCENES[scene]
    crosses = frame != "total" and scene != "bar-small"
    if s.tears and frame != "total" and not shape.startswith("cpdi"):
        return BREAKS
    if crosses and (shape.startswith("linear") or shape == "bernstein"):
        return NONE
    if transfer == "pic":
        return 1
    # two points per cell: sums over points are not exact when they are unevenly spaced, or leave gaps
    if scene == "bar-large" and frame == "updated" and (shape == "gimp" or shape.startswith("quadratic")):
        return NONE
    return 2


def agrees(found, theory):
    if theory == BREAKS:
        return found is None
    if theory == NONE:
        return found is None or found <= 0.2
    return found is not None and abs(found - theory) <= 0.2


# why a measured order is not that of theory: text, and whether it is the reason of a combination
DEPARTURES = [
    ("The error that does not become smaller is still hidden by damping, which does.",
     lambda key, found, errors: found > 0.2 and expected(*key) == NONE),
    ("The damping of *fmpm* 2 is of third order, :math:`(D k^2)^2` in each of :math:`1/h` steps; it is still "
     "larger than the errors of second order.",
     lambda key, found, errors: key[2] == "fmpm 2" and found > 2.2),
    ("Masses and forces of the nodes count points, which do not get closer within a cell when it is compressed: an error "
     "proportional to :math:`G^2` remains although no point leaves its cell.  Another code with *flip* has 2.8e-8 with 256 "
     "cells, too.",
     lambda key, found, errors: key[0] == "bar-small" and key[1].startswith("linear") and key[3] == "updated"),
    ("Waves of this length are damped to next to nothing with these spacings, so that the error is the motion itself: see "
     "the formula above.",
     lambda key, found, errors: key[0].startswith("vortex") and key[2] == "pic" and found < 0.8),
    ("5 cells are few: the slope still rises, and is 1.7 to 2.3 for the two finest spacings.",
     lambda key, found, errors: key[0].startswith("vortex") and found < 1.8 and order(errors, 2) >= 1.7),
    ("Cells of *bernstein* are two spacings wide, so that there are 10 across the ring at most; in the bar its order comes "
     "near 2 with more than 32 spacings.",
     lambda key, found, errors: key[0].startswith("vortex") and key[1] == "bernstein" and 1.4 < found < 1.8),
    ("The shear varies from 0 to 6 within a few cells: another code with linear functions has 1.3 between 5 and 20 cells, "
     "and 1.6 between 20 and 40.",
     lambda key, found, errors: key == ("vortex-large", "linear", key[2], "total") and found < 1.8),
    ("Two points per cell, not evenly spaced after points have moved, or with gaps: the sum over points is off by a small "
     "amount, at which the error will stall.",
     lambda key, found, errors: found < 1.8 and key[3] != "total" and key[0] != "bar-small" and
     (key[1].startswith("quadratic") or key[1] == "gimp" or key[0] == "bar-large" and key[2] == "fmpm 2")),
]


def cell(key, errors, notes):
    """Text of one combination: error, order, order of theory, numbers of the notes on departures."""
    if not errors:
        return "-" if errors is not None else ""
    theory = expected(*key)
    found = order(errors, 2 if theory == NONE else SCENES[key[0]].span)
    text = BREAKS if found is None else "%.1e, %.1f" % (sorted(errors.items())[-1][1], found)
    text += "" if found is None and theory == BREAKS else " (%s)" % theory
    if agrees(found, theory):
        return text
    reasons = [k for k, (_, fits) in enumerate(DEPARTURES) if fits(key, math.nan if found is None else found, errors)]
    if not reasons:
        sys.exit("no reason is known for %s: %s" % (" ".join(key), text))
    if reasons[0] not in notes:
        notes.append(reasons[0])
    return "%s [%d]" % (text, notes.index(reasons[0]) + 1)


def manual(rows):
    """Tables for the manual."""
    text, notes = ".. written by bench/convergence.py from bench/convergence.csv\n", []
    for scene, s in SCENES.items():
        text += "\n**%s.**\n\n.. list-table::\n   :header-rows: 1\n\n   * - shape, frame\n" % s.title
        text += "".join("     - *%s*\n" % t for t in TRANSFERS)
        for frame in FRAMES:
            for shape in SHAPES:
                keys = [(scene, shape, t, frame) for t in TRANSFERS]
                cells = [cell(key, rows.get(key), notes) for key in keys]
                if set(cells) - {"-", ""}:
                    text += "   * - *%s*, %s\n" % (shape, frame) + "".join("     - %s\n" % c for c in cells)
    text += "\nOrders that differ by more than 0.2 from those of theory:\n\n"
    text += "".join("[%d] %s\n\n" % (k + 1, DEPARTURES[note][0]) for k, note in enumerate(notes))
    return text.replace("     - \n", "     -\n").rstrip("\n") + "\n"


def main(lmp=None, *scenes):
    rows = read()
    if lmp:
        lmp = os.path.abspath(lmp)
        keys = [k for k in all_keys() if not scenes or k[0] in scenes]
        for k, key in enumerate(keys):
            while rows.get(key) != {}:
                todo = [n for n in SCENES[key[0]].numbers(*key[1:]) if n not in rows.get(key, {})]
                if not todo:
                    break
                errors = measure(lmp, *key, todo)
                rows.setdefault(key, {}).update(errors or {})
                print("%d/%d" % (k + 1, len(keys)), *key, "refused" if errors is None else errors, flush=True)
                write(rows)
    with open(MANUAL, "w") as file:
        file.write(manual(rows))


def check():
    """Exit code 1 if runs are missing, or the tables are not what convergence.csv gives."""
    rows = read()
    missing = [key for key in all_keys() if key not in rows]
    with open(MANUAL) as file:
        same = file.read() == manual(rows)
    if missing or not same:
        sys.exit("missing: %s, tables %s" % (missing, "are right" if same else "are not those of convergence.csv"))


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        check()
    elif any(name not in SCENES for name in sys.argv[2:]):
        sys.exit(__doc__)
    else:
        main(*sys.argv[1:])
