# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Energy, linear and angular momentum of a small free body over 10^6 steps.

A bar of 4 x 1 cells (16 points in 2d), neo-Hookean, bends and flies and turns slowly through a
periodic box, with the time step at half of h/c. Momentum: largest change in parts of m v. Angular
momentum: largest change, and last value, in parts of the first one, of velocities and affine matrices
of the points, about the center of mass. Energy: the largest and the last value of kinetic and stored
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
region box block 0 32 0 32 -0.5 0.5
create_box 1 box
fix grid all mpm 1.0 {words}
region body block 2 6 3 4 -0.5 0.5
create_points 1 region body ppc 2
fix m all mpm/material density 1.0 neohookean 0.742857142857 0.3
variable vx atom 0.01
variable vy atom 0.005+0.002*(x-4)+0.02*cos(2*PI*(x-4)/4)
velocity all set v_vx v_vy NULL
timestep 0.5
compute w all mpm/atom energy angmom/z
compute sums all reduce sum c_w[1] c_w[2]
compute k all ke
variable mech equal c_k+c_sums[1]
variable px equal "mass(all)*vcm(all,x)"
variable py equal "mass(all)*vcm(all,y)"
variable lz equal angmom(all,z)+c_sums[2]
thermo 10000
thermo_style custom step v_mech v_px v_py v_lz
thermo_modify format float %.15g
run {steps}
"""

SHAPES = ("quadratic", "quadratic total", "cubic", "cpgimp", "linear light", "linear total", "gimp",
          "cubic total", "linear")


def work():
    """Most interesting ones first: all transfers with quadratic functions, then by transfer."""
    turn = {"apic": 0, "polypic": 1, "aflip": 2, "tpic": 3, "flip": 4, "pic": 5, "fmpm": 6, "xpic": 7}
    return sorted(((key, words) for shape in SHAPES for key, words in combos() if key[0] == shape),
                  key=lambda item: (item[0][0] != "quadratic", turn[item[0][1].split()[0]]))


def measure():
    table = trial.Table("drift", ["shape", "transfer", "scheme"],
                        ["energy_most", "energy_last", "grown", "momentum", "angular_change",
                         "angular_last", "outcome"])
    todo = work()
    for n, (key, words) in enumerate(todo):
        if table.has(*key):
            continue
        trial.progress(n, len(todo), "10^6 steps: " + " ".join(key))
        kind, out = trial.run(SCENE.format(words=words, steps=STEPS))
        rows = [[float(w) for w in line.split()] for line in out.splitlines()
                if len(line.split()) == 5 and line.split()[0].isdigit()]
        if not rows:
            raise RuntimeError(out)
        energy = [r[1] / rows[0][1] for r in rows]
        scale = 4.0 * 0.02
        momentum = max(max(abs(r[2] - rows[0][2]), abs(r[3] - rows[0][3])) for r in rows) / scale
        grown = [int(r[0]) for r, e in zip(rows, energy) if e > 1.1]
        table.add(shape=key[0], transfer=key[1], scheme=key[2], energy_most="%.4g" % max(energy),
                  energy_last="%.4g" % energy[-1],
                  grown=grown[0] if grown else "", momentum="%.2g" % momentum,
                  angular_change="%.2g" % max(abs(r[4] / rows[0][4] - 1.0) for r in rows),
                  angular_last="%.4g" % (rows[-1][4] / rows[0][4]), outcome=kind)
