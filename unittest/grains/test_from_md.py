# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: physics long
# sanitize: no
# timeout: 600
"""tools/mpm_from_md.py: parameters of the Lennard-Jones solid and fluid against known values, and
material points that take the files it writes."""

import os
import re
import sys
import tempfile

import numpy as np

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
    print(mt.ok(made).output)
    return mt.read(os.path.join(folder, "made.mpm"))


def numbers(text, pattern):
    found = re.search(pattern.replace("#", r"(-?[\d.]+(?:e[-+]?\d+)?)"), text)
    assert found, pattern
    return [float(word) for word in found.groups()]


def near(value, exact, share):
    assert np.all(abs(value - exact) <= share * abs(exact)), "%s instead of %s" % (value, exact)


def within(values, exact, share=0.0):
    """The value with its standard error is off by at most three of these, or a share of it."""
    value, error = values
    print("%g +- %g, theory %g" % (value, error, exact))
    assert abs(value - exact) <= 3.0 * error + share * abs(exact), \
        "%g +- %g instead of %g" % (value, error, exact)


class Quasiharmonic:
    """The crystal of lj/cut 2.5 in the classical quasi-harmonic approximation: energy and pressure per
    atom are those of the static lattice, and 3 T and 3 T gamma/V with the mean Grueneisen parameter of
    all modes of a cube of cells (M. Born, K. Huang, Dynamical Theory of Crystal Lattices (1954))."""

    def __init__(self, cells):
        grid = np.array([(i, j, k) for i in range(-6, 7) for j in range(-6, 7) for k in range(-6, 7)
                         if (i + j + k) % 2 == 0 and (i, j, k) != (0, 0, 0)]) / 2.0
        self.grid = grid[np.sqrt((grid**2).sum(1)) < 2.5]
        # wave vectors in units of 2 pi/(cells a): reciprocal vectors are cells (1,1,1), cells (2,0,0)
        def first(k):
            return min(tuple(np.mod(np.add(k, cells * s), 2 * cells)) for s in (0, 1))
        modes = {first((i, j, k)) for i in range(2 * cells) for j in range(2 * cells)
                 for k in range(2 * cells)} - {(0, 0, 0)}
        assert len(modes) == 4 * cells**3 - 1
        self.waves = np.array(sorted(modes)) * 2.0 * np.pi / cells

    def pairs(self, V):
        """Vectors to neighbors, distances, first and second derivative of the potential, energy."""
        x = (4.0 * V) ** (1.0 / 3.0) * self.grid
        r = np.sqrt((x**2).sum(1))
        x, r = x[r < 2.5], r[r < 2.5]
        return (x, r, 24.0 * (r**-7 - 2.0 * r**-13), 24.0 * (26.0 * r**-14 - 7.0 * r**-8),
                4.0 * (r**-12 - r**-6))

    def cold(self, V):
        x, r, slope, _, energy = self.pairs(V)
        return 0.5 * energy.sum(), -(slope * r).sum() / (6.0 * V)

    def log_squares(self, V):
        """Mean logarithm of the squared frequencies."""
        x, r, slope, curve, _ = self.pairs(V)
        n = x / r[:, None]
        K = np.einsum("p,pi,pj->pij", curve - slope / r, n, n) + \
            np.einsum("p,ij->pij", slope / r, np.eye(3))
        phases = self.waves / (4.0 * V) ** (1.0 / 3.0) @ x.T
        D = np.einsum("kp,pij->kij", 1.0 - np.cos(phases), K)
        return np.log(np.linalg.det(D)).mean() / 3.0

    def gamma(self, V, e=1.0e-3):
        return (self.log_squares(V * (1.0 - e)) - self.log_squares(V * (1.0 + e))) / (4.0 * e)

    def pressure(self, V, T):
        return self.cold(V)[1] + 3.0 * self.gamma(V) * T / V

    def adiabatic_modulus(self, V, T, e=1.0e-3):
        isothermal = (self.pressure(V * (1.0 - e), T) - self.pressure(V * (1.0 + e), T)) / (2.0 * e)
        return isothermal + 3.0 * T * self.gamma(V)**2 / V

    def shocked(self, V0, T0, ratio):
        """(up, Us, P, T) on the Hugoniot from rest at V0, T0."""
        V, P0 = ratio * V0, self.pressure(V0, T0)

        def mismatch(T):
            return self.cold(V)[0] - self.cold(V0)[0] + 3.0 * (T - T0) - \
                0.5 * (self.pressure(V, T) + P0) * (V0 - V)
        T = root(mismatch, 0.0, 10.0)
        P = self.pressure(V, T)
        return np.sqrt((P - P0) * (V0 - V)), V0 * np.sqrt((P - P0) / (V0 - V)), P, T


def root(f, low, high):
    sign = f(low)
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) * sign > 0.0 else (low, middle)
    return 0.5 * (low + high)


def usable(folder):
    done = mt.ok(mt.lammps(folder, POINT))
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
        # at temperature 0.1 the quasi-harmonic theory; what it leaves out is in the shares
        theory, error = Quasiharmonic(4), r" # \+- #"
        V = root(lambda V: theory.pressure(V, 0.1), 0.9, 1.0)
        within(numbers(text, "Density at rest" + error), 1.0 / V, 0.003)
        within(numbers(text, "GAMMA0" + error), theory.gamma(V), 0.03)
        within(numbers(text, "Specific heat at constant volume" + error), 3.0, 0.03)
        within(numbers(text, "adiabatic" + error), theory.adiabatic_modulus(V, 0.1), 0.03)
        table = text.split("temperature on the Hugoniot:\n")[1].split("\n\n")[0]
        table = np.array([line[1:].split() for line in table.splitlines()], float)
        states = np.array([theory.shocked(V, 0.1, ratio) for ratio in (0.95, 0.9, 0.85)])
        print(table, states)
        for column, (k, share) in enumerate(((0, 0.01), (1, 0.01), (2, 0.02), (4, 0.08))):
            near(table[:, k] / states[:, column], np.ones(3), share)
        s, c0 = np.polyfit(states[:, 0], states[:, 1], 1)
        within(numbers(text, "C0" + error), c0, 0.01)
        within(numbers(text, ", S" + error), s, 0.05)
        # a [100](010) shear of fcc softens: the largest stress is less than C44 gamma
        assert 0.05 < numbers(text, r"\[100\] #")[0] / c44 < 0.3
        usable(folder)


def test_fluid():
    with tempfile.TemporaryDirectory() as folder:
        text = make(folder, "fluid", "--density", "0.8442", "--temperature", "0.722",
                    "--steps", "1000", "--compressions", "0.9", "0.8")
        # near the triple point: K. Meier, A. Laesecke, S. Kabelac, J. Chem. Phys. 121 (2004) 3671
        within(numbers(text, r"Viscosity # \+- #"), 3.26)
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
