#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Order of convergence of every shape, transfer, and frame with manufactured solutions.

   python3 bench/convergence.py LMP          runs what convergence.csv does not have yet
   python3 bench/convergence.py              only writes the tables of the manual from convergence.csv

Scenes: displacement along the axis of a bar between walls (M. Steffen et al., CMES 31 (2008) 107) with
small and with large amplitude, and the generalized vortex (K. Kamojjala et al., Eng. Comput. 31
(2015) 269). A new variant is one more line below; delete lines of convergence.csv to have them measured
again.
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
}
TRANSFERS = ["pic", "flip 1.0", "apic", "aflip 1.0", "tpic", "xpic 2", "fmpm 2"]
FRAMES = ["updated", "total"]


def scheme(shape, transfer, frame):
    """Linear functions of the updated frame are not sound with USL, fmpm knows USL only."""
    if shape == "linear" and frame == "updated" and not transfer.startswith("fmpm"):
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
region box block 0 1 0 $(v_h:%.17g) -0.5 0.5
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
variable k1 atom (3*v_s1+v_R*v_s2)/2.6
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
timestep $(0.2*v_h/1.6:%.17g)
thermo $(ceil(0.025/dt))
thermo_style custom step c_e
run $(round(1/dt))
print "ERROR_NORM {n} $(c_e[4])"
"""

# input, amplitude, numbers of cells for all, further ones for flip and apic
SCENES = {
    "bar-small": (BAR, 1e-4, (8, 16, 32), (64,)),
    "bar-large": (BAR, 0.05, (8, 16, 32), (64,)),
    "vortex": (VORTEX, 0.1, (5, 10), (20,)),
}


def measure(lmp, scene, shape, transfer, frame):
    """Errors by number of cells; none if the combination is refused."""
    template, G, few, more = SCENES[scene]
    numbers = few + (more if transfer in ("flip 1.0", "apic") else ())
    options = "%s transfer %s scheme %s frame %s" % (
        SHAPES[shape].replace("ASPECT", "aspect 1 2" if template is BAR else ""), transfer,
        scheme(shape, transfer, frame), frame)
    options += " dtcheck no bad warn"
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "in.sweep"), "w") as file:
            file.write("".join(template.format(n=n, G=G, options=options) for n in numbers))
        result = subprocess.run([lmp, "-in", "in.sweep", "-log", "none"], cwd=folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    errors = {int(n): float(e) for n, e in re.findall(r"^ERROR_NORM (\d+) (\S+)", result.stdout, re.M)}
    refused = re.search(r"^ERROR.*", result.stdout, re.M)
    if not errors and not (refused and ("use " in refused[0] or "frame total" in refused[0])):
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
    with open(TABLE, "w") as file:
        file.write("scene,shape,transfer,frame,cells,error\n")
        for key, errors in rows.items():
            for n, e in sorted(errors.items()):
                file.write("%s,%d,%.4g\n" % (",".join(key), n, e))
            if not errors:
                file.write("%s,,\n" % ",".join(key))


def order(errors):
    """Slope of the finest pair."""
    (a, ea), (b, eb) = sorted(errors.items())[-2:]
    return math.log(ea / eb) / math.log(b / a)


def cell(errors):
    if not errors:
        return "-"
    if len(errors) < 2 or not all(math.isfinite(e) for e in errors.values()):
        return "breaks"
    return "%.1e, %.1f" % (sorted(errors.items())[-1][1], order(errors))


def manual(rows):
    text = ".. written by bench/convergence.py from bench/convergence.csv\n"
    titles = {"bar-small": "Bar, amplitude 0.0001: no point leaves its cell",
              "bar-large": "Bar, amplitude 0.05: points cross cells",
              "vortex": "Generalized vortex, largest angle 0.1"}
    for scene, title in titles.items():
        text += "\n**%s.**\n\n.. list-table::\n   :header-rows: 1\n\n   * - shape, frame\n" % title
        text += "".join("     - *%s*\n" % t for t in TRANSFERS)
        for frame in FRAMES:
            for shape in SHAPES:
                cells = [cell(rows.get((scene, shape, t, frame))) for t in TRANSFERS]
                if set(cells) == {"-"}:
                    continue
                text += "   * - *%s*, %s\n" % (shape, frame) + "".join("     - %s\n" % c for c in cells)
    with open(MANUAL, "w") as file:
        file.write(text)


def main(lmp=None):
    rows = read()
    if lmp:
        keys = [(s, shape, t, f) for s in SCENES for f in FRAMES for shape in SHAPES for t in TRANSFERS]
        for k, key in enumerate(keys):
            if key not in rows:
                rows[key] = measure(os.path.abspath(lmp), *key)
                print("%d/%d" % (k + 1, len(keys)), *key, rows[key], flush=True)
                write(rows)
    manual(rows)


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
