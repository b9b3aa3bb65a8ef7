# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Energy, linear and angular momentum of a small free body over 10^6 steps.

A bar of 4 x 1 cells (16 points in 2d), neo-Hookean, bends and flies and turns slowly through a
periodic box, with the time step at half of h/c. Momentum: largest change in parts of m v. Angular
momentum: the last value of that of the velocities of the points in parts of the first one; with an
affine transfer the matrices have the rest of what is conserved. Energy: the largest and the last value of kinetic and stored
energy, in parts of the initial one; grown: the step after which it was ever more than 1.1 (looked
at every 10^4 steps).
"""
import trial
from combos import combos

STEPS = 1000000

SCENE = """units lj
dimension 2
boundary p p p
atom_style mpm
neighbor 0.4 bin
neigh_modify every 10
region box block 0 8 0 8 -0.5 0.5
create_box 1 box
fix grid all mpm 1.0 {words}
region body block 2 6 3 4 -0.5 0.5
create_points 1 region body ppc 2
fix m all mpm/material density 1.0 neohookean 0.742857142857 0.3
variable vx atom 0.01
variable vy atom 0.005+0.002*(x-4)+0.02*cos(2*PI*(x-4)/4)
velocity all set v_vx v_vy NULL
timestep 0.5
compute e all mpm/energy
variable mech equal c_e[1]+c_e[2]
variable px equal "mass(all)*vcm(all,x)"
variable py equal "mass(all)*vcm(all,y)"
variable lz equal angmom(all,z)
thermo 10000
thermo_style custom step c_e[1] c_e[2] v_px v_py v_lz
thermo_modify format float %.15g
run {steps}
"""


# in order of interest: 20 s each on an idle core
FIRST = [("quadratic", "flip 1.0", "musl"), ("quadratic", "apic", "usl"),
         ("quadratic", "flip 1.0", "usl"), ("quadratic", "flip 0.99", "musl"), ("linear", "flip 1.0", "musl"),
         ("quadratic total", "flip 1.0", "musl"), ("quadratic", "flip 1.0", "usavg"),
         ("quadratic", "flip 1.0", "usf"), ("cpgimp", "flip 1.0", "musl"),
         ("linear light", "apic", "usl"), ("cubic", "flip 1.0", "musl"), ("cubic", "apic", "usl"),
         ("quadratic", "apic", "musl"), ("quadratic", "aflip 1.0", "usl"),
         ("quadratic", "tpic", "usl"), ("quadratic", "xpic 2", "usl"), ("quadratic", "fmpm 2", "usl"),
         ("linear total", "flip 1.0", "musl"), ("quadratic total", "apic", "usl"),
         ("quadratic", "pic", "usl")]


def chosen():
    words = dict(combos())
    words["quadratic", "flip 0.99", "musl"] = "shape quadratic transfer flip 0.99 scheme musl"
    rest = [key for key in words if key not in FIRST and key[1] in ("flip 1.0", "apic")]
    return [(key, words[key]) for key in FIRST + rest if key in words]


def measure():
    table = trial.Table("drift", ["shape", "transfer", "scheme"],
                        ["energy_most", "energy_last", "grown", "momentum", "angular", "outcome"])
    work = chosen()
    for n, (key, words) in enumerate(work):
        if table.has(*key):
            continue
        trial.progress(n, len(work), "10^6 steps: " + " ".join(key))
        kind, out = trial.run(SCENE.format(words=words, steps=STEPS))
        rows = [[float(w) for w in line.split()] for line in out.splitlines()
                if len(line.split()) == 6 and line.split()[0].isdigit()]
        start = rows[0][1] + rows[0][2]
        energy = [(r[1] + r[2]) / start for r in rows]
        scale = 4.0 * 0.02
        momentum = max(max(abs(r[3] - rows[0][3]), abs(r[4] - rows[0][4])) for r in rows) / scale
        grown = [int(r[0]) for r, e in zip(rows, energy) if e > 1.1]
        table.add(shape=key[0], transfer=key[1], scheme=key[2], energy_most="%.4g" % max(energy),
                  energy_last="%.4g" % energy[-1],
                  grown=grown[0] if grown else "", momentum="%.2g" % momentum,
                  angular="%.4g" % (rows[-1][5] / rows[0][5]), outcome=kind)
