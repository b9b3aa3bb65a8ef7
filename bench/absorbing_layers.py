# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""What comes back from dashpots, absorbing layers, and perfectly matched layers, against the angle

Plane waves of one frequency in an elastic body (Poisson number 1/4) come to a plane at an angle.  Behind it are

* dashpots (Lysmer and Kuhlemeyer 1969), as fix mpm/dashpot has them;
* a layer of N cells with a damping -a(x) v per mass that grows with the square of the depth, and dashpots behind it;
* a perfectly matched layer of N cells (Basu and Chopra, Comput. Methods Appl. Mech. Eng. 192 (2003) 1337), s = 1 + i b(x)/omega with
  b(x) growing in the same way for an echo of 1e-4 (--reflection) at normal incidence, and a wall behind it, as fix mpm/pml has them.

With the wave number along the plane given, what is left is a problem in one dimension, solved here with quadratic elements of one cell, 20 cells
in a pressure wave (--cells).  Amplitudes of the echoes, as pressure and shear waves, and their share of the energy that came.

  python3 absorbing_layers.py [--cells N] [--reflection R]
"""

import argparse

import numpy as np

CP, CS = 1.0, 1.0 / np.sqrt(3.0)    # density 1
MU = CS**2
LAMBDA = CP**2 - 2.0 * MU


def wave(shear, theta, sign):
    """Direction of motion and wave vector of a plane wave that goes along sign*x, and the speed."""
    c, d = (CS if shear else CP), np.array([sign * np.cos(theta), np.sin(theta)])
    return (np.array([-d[1], d[0]]) if shear else d), d, c


def stress(a, k):
    """Stress xx and xy of the motion a exp(i k x)."""
    return 1j * np.array([(LAMBDA + 2 * MU) * a[0] * k[0] + LAMBDA * a[1] * k[1], MU * (a[0] * k[1] + a[1] * k[0])])


def echoes(shear, degrees, depth, damping, stretch, omega=1.0, cells=20, wall=False):
    """Amplitudes of the pressure and the shear wave that come back, for one of 1, and the energy.

    depth: cells of the layer; damping, stretch: a and b at its end, in units of the velocity over its depth; wall: at its
    end, in place of dashpots."""
    theta = np.radians(degrees)
    a_in, d_in, c_in = wave(shear, theta, 1.0)
    ky = omega / c_in * d_in[1]
    h = 2.0 * np.pi * CP / omega / cells
    # waves that come back, with the same ky; their kx has the sign of waves that go or decay to the left
    back = []
    for c, is_shear in ((CP, False), (CS, True)):
        kx = -np.sqrt((omega / c)**2 - ky**2 + 0j)
        if kx.imag > 0:
            kx = -kx
        k = np.array([kx, ky])
        a = np.array([-ky, kx]) if is_shear else k
        back.append((a * c / omega, k, c))
    # unknowns: displacements at nodes (two for each cell), then the two amplitudes; the plane is at x = 0
    n = 2 * depth + 1
    L = depth * h
    K = np.zeros((2 * n + 2, 2 * n + 2), complex)
    F = np.zeros(2 * n + 2, complex)
    gauss, weight = np.polynomial.legendre.leggauss(4)
    for cell in range(depth):
        for g, w in zip(gauss, weight):
            x, J = (cell + 0.5 * (g + 1.0)) * h, 0.5 * h
            N = np.array([0.5 * g * (g - 1), 1 - g * g, 0.5 * g * (g + 1)])
            dN = np.array([g - 0.5, -2.0 * g, g + 0.5]) / J
            s = 1.0 + 1j * stretch * CP / L * (x / L)**2 / omega
            m = 1.0 + 1j * damping * CP / L * (x / L)**2 / omega
            B = np.zeros((3, 6), complex)    # strains xx, yy, xy of displacements with exp(i ky y)
            B[0, 0::2] = dN / s
            B[1, 1::2] = 1j * ky * N
            B[2, 0::2], B[2, 1::2] = 1j * ky * N, dN / s
            # the test functions have exp(-i ky y)
            Bt = B.copy()
            Bt[1, 1::2] *= -1
            Bt[2, 0::2] *= -1
            C = np.array([[LAMBDA + 2 * MU, LAMBDA, 0], [LAMBDA, LAMBDA + 2 * MU, 0], [0, 0, MU]])
            e = np.zeros((6, 6), complex)
            e += Bt.T @ C @ B
            for d in range(2):
                e[d::2, d::2] -= m * omega**2 * np.outer(N, N)
            at = 4 * cell + np.arange(6)
            K[np.ix_(at, at)] += w * J * s * e
    # dashpots at the end: traction -Z v on the body, v = -i omega u
    for d, c in enumerate((CP, CS)):
        K[2 * (n - 1) + d, 2 * (n - 1) + d] += -1j * omega * c
        if wall:
            K[2 * (n - 1) + d] = 0.0
            K[2 * (n - 1) + d, 2 * (n - 1) + d] = 1.0
    # at the plane: traction of the waves in front is what the layer gets (-t on its face to the left), and the same motion
    t_in = stress(a_in, omega / c_in * d_in)
    for d in range(2):
        F[d] -= t_in[d]
        F[2 * n + d] = a_in[d]
        K[2 * n + d, d] = 1.0
        for j, (a, k, _) in enumerate(back):
            K[d, 2 * n + j] += stress(a, k)[d]
            K[2 * n + d, 2 * n + j] = -a[d]
    result = np.linalg.solve(K, F)[-2:]
    flux = [abs(amplitude)**2 * c * abs(k[0].real) * c / omega for amplitude, (_, k, c) in zip(result, back)]
    return np.append(abs(result), sum(flux) / (c_in * d_in[0]))


def dashpots(shear, degrees):
    """The same for dashpots at the plane itself: the layer is thin."""
    return echoes(shear, degrees, 1, 0.0, 0.0, cells=100000)


def far_side(name, depth, shear, degrees, cells=20, reflection=1e-4):
    """The same for one of the cases above, with a layer of some cells."""
    if name == "dashpots":
        return dashpots(shear, degrees)
    # of b: exp(-2/3 b) at normal incidence, there and back; a: more is better
    # along the normal, less at large angles
    if name == "matched":
        return echoes(shear, degrees, depth, 0.0, -1.5 * np.log(reflection), cells=cells, wall=True)
    return echoes(shear, degrees, depth, 6.0, 0.0, cells=cells)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=20, help="in a pressure wave")
    parser.add_argument("--reflection", type=float, default=1e-4, help="of matched layers")
    cells, reflection = parser.parse_args().cells, parser.parse_args().reflection
    waves = [(False, angle) for angle in (0, 30, 45, 60, 70, 80)] + [(True, angle) for angle in (0, 20, 30)]
    print("".ljust(22) + "".join("%9s" % ("PS"[shear] + " %d" % angle) for shear, angle in waves))
    for name, depth in (("dashpots", 0), ("damping", 10), ("damping", 20), ("damping", 40), ("matched", 5),
                        ("matched", 10), ("matched", 20)):
        rows = np.array([far_side(name, depth, shear, angle, cells, reflection) for shear, angle in waves])
        print(("%s, %d cells" % (name, depth)).ljust(22) + "".join("%9.4f" % max(row[:2]) for row in rows))
        print("  energy".ljust(22) + "".join("%9.4f" % row[2] for row in rows))


if __name__ == "__main__":
    main()
