# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""A step of the method of Runge and Kutta of fourth order, for theories that scenes are compared with."""


def runge_kutta(slope, y, dx):
    """y after dx, with dy/dx = slope(y)."""
    a = slope(y)
    b = slope(y + 0.5 * dx * a)
    c = slope(y + 0.5 * dx * b)
    d = slope(y + dx * c)
    return y + dx / 6.0 * (a + 2.0 * b + 2.0 * c + d)
