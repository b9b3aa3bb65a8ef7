# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: physics
# timeout: 600
"""tools/mpm_from_md.py: parameters of the Lennard-Jones solid and fluid against known values, and
material points that take the files it writes."""

import os
import re
import sys
import tempfile

import mpm_testing as mt

TOOL = os.path.join(mt.ROOT, "tools", "mpm_from_md.py")
POTENTIAL = "mass 1 1.0\npair_style lj/cut 2.5\npair_coeff 1 1 1.0 1.0\n"

POINT = """
units           lj
atom_style      mpm
boundary        p p p
region          box block 0 4 0 4 0 4
create_box      1 box
fix             grid all mpm 1.0
create_points   1 box ppc 2
fix             m all mpm/material file made.mpm
timestep        0.001
compute         p all mpm/atom pressure
compute         mean all reduce ave c_p
thermo_style    custom step c_mean
thermo_modify   format float %20.14g
run             1
"""


def make(folder, *arguments):
    with open(os.path.join(folder, "lj.pot"), "w") as out:
        out.write(POTENTIAL)
    made = mt.run([sys.executable, TOOL, arguments[0], "lj.pot"] + list(arguments[1:]) +
                  ["-o", "made.mpm", "--units", "lj", "--cells", "4", "--lmp", mt.LMP],
                  folder, timeout=500)
    print(made.output)
    assert made.code == 0
    with open(os.path.join(folder, "made.mpm")) as text:
        return text.read()


def numbers(text, pattern):
    found = re.search(pattern.replace("#", r"(-?[\d.]+(?:e[-+]?\d+)?)"), text)
    assert found, pattern
    return [float(word) for word in found.groups()]


def near(value, exact, share):
    assert abs(value - exact) <= share * abs(exact), "%g instead of %g" % (value, exact)


def usable(folder):
    done = mt.lammps(folder, POINT)
    assert done.code == 0, done.tail()
    near(1.0 + float(mt.thermo(done.output)[-1][1][-1][1]), 1.0, 1.0e-10)


def test_solid():
    with tempfile.TemporaryDirectory() as folder:
        text = make(folder, "solid", "--constant", "1.6", "--temperature", "0.1", "--steps", "400",
                    "--compressions", "0.95", "0.9", "0.85")
        # lattice sums of the cut potential at rest
        a, energy = numbers(text, "lattice constant #, energy per atom #")
        near(a, 1.549603, 1.0e-6)
        near(energy, -8.099621, 1.0e-6)
        c11, c12, c44 = numbers(text, r"C11 #  C12 #  C44 #")
        near(c11, 97.7121, 1.0e-4)
        near(c12, 55.6266, 1.0e-4)
        near(c44, 55.6266, 1.0e-4)
        # Dulong and Petit; Hugoniot begins with the sound speed
        near(numbers(text, r"thermal     adiabatic #")[0], 3.0, 0.15)
        sound = numbers(text, r"its sound speed #")[0]
        near(numbers(text, r"eos         shock #")[0], sound, 0.12)
        # a [100](010) shear of fcc softens: the largest stress is less than C44 gamma
        assert 0.05 < numbers(text, r"\[100\] #")[0] / c44 < 0.3
        usable(folder)


def test_fluid():
    with tempfile.TemporaryDirectory() as folder:
        text = make(folder, "fluid", "--density", "0.8442", "--temperature", "0.722",
                    "--steps", "1000", "--compressions", "0.9", "0.8")
        # near the triple point: K. Meier, A. Laesecke, S. Kabelac, J. Chem. Phys. 121 (2004) 3671
        near(numbers(text, "viscosity   newtonian #")[0], 3.26, 0.15)
        near(numbers(text, r"eos         shock #")[0], numbers(text, "its sound speed #")[0], 0.25)
        usable(folder)


def test_bad_input():
    with tempfile.TemporaryDirectory() as folder:
        for wrong, words in [(["solid"], "--constant"), (["fluid"], "--density"),
                             (["fluid", "--density", "1", "--si"], "--si")]:
            with open(os.path.join(folder, "lj.pot"), "w") as out:
                out.write(POTENTIAL)
            done = mt.run([sys.executable, TOOL] + wrong +
                          ["lj.pot", "-o", "made.mpm", "--units", "lj", "--temperature", "1"], folder)
            assert done.code and words in done.output, done.output


mt.main(globals())
