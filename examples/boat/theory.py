# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Heave and roll of the boat by linear theory: a potential flow with small waves, on the cells of a lattice

Generalized velocities are those of the columns of the surface, of the boat upwards, and its rotation. The kinetic energy of the water for
given normal velocities at its boundary follows from Laplace's equation; the potential energy is that of the surface and the boat. All modes
together give the motion after a push.
"""
import numpy as np

RHO, G = 1000.0, 9.81
LENGTH, DEPTH = 2.0, 0.4
LEFT, RIGHT, BOTTOM, TOP = 0.8, 1.2, 0.3, 0.5
DENSITY = 500.0


def motion(h, velocity, omega, t):
    """heave and roll at times t after the push"""
    nx, ny = round(LENGTH / h), round(DEPTH / h)
    left, right, bottom = round(LEFT / h), round(RIGHT / h), round(BOTTOM / h)
    fluid = np.ones((nx, ny), bool)
    fluid[left:right, bottom:] = False
    number = -np.ones((nx, ny), int)
    number[fluid] = np.arange(fluid.sum())
    columns = [i for i in range(nx) if fluid[i, ny - 1]]
    n, nq = fluid.sum(), len(columns) + 2
    heave, roll = nq - 2, nq - 1
    middle_x, middle_y = 0.5 * (LEFT + RIGHT), 0.5 * (BOTTOM + TOP)

    K = np.zeros((n, n))    # of Laplace's equation
    for a, b in ((number[1:], number[:-1]), (number[:, 1:], number[:, :-1])):
        both = (a >= 0) & (b >= 0)
        for i, j in zip(a[both], b[both]):
            K[i, i] += 1.0
            K[j, j] += 1.0
            K[i, j] -= 1.0
            K[j, i] -= 1.0

    B = np.zeros((n, nq))    # what leaves cells by unit velocities
    M = np.zeros((nq, nq))   # of the half cells at the boundary

    def boundary(cell, rates):
        row = np.zeros(nq)
        for q, rate in rates:
            row[q] = rate
        B[cell] += h * row
        M[:] += 0.5 * h * h * np.outer(row, row)

    for q, i in enumerate(columns):
        boundary(number[i, ny - 1], [(q, 1.0)])
    for i in range(left, right):
        boundary(number[i, bottom - 1], [(heave, 1.0), (roll, (i + 0.5) * h - middle_x)])
    for j in range(bottom, ny):
        arm = (j + 0.5) * h - middle_y
        boundary(number[left - 1, j], [(roll, -arm)])
        boundary(number[right, j], [(roll, arm)])

    # volume stays: one column of the surface follows from the others
    total = B.sum(axis=0)
    C = np.zeros((nq, nq - 1))
    C[1:] = np.eye(nq - 1)
    C[0] = -total[1:] / total[0]
    phi = np.linalg.solve(K + 1.0 / n, B @ C)
    M = RHO * (C.T @ M @ C + (B @ C).T @ phi)
    width, height, draft = RIGHT - LEFT, TOP - BOTTOM, DEPTH - BOTTOM
    mass = DENSITY * width * height
    M[-2, -2] += mass
    M[-1, -1] += mass * (width**2 + height**2) / 12.0
    stiff = np.full(nq, RHO * G * h)
    stiff[heave] = RHO * G * width
    stiff[roll] = mass * G * (width**2 / (12.0 * draft) + 0.5 * draft - 0.5 * height)
    S = C.T @ (stiff[:, None] * C)

    # modes, and their share of the push
    push = np.zeros(nq - 1)
    push[-2] = mass * velocity
    push[-1] = mass * (width**2 + height**2) / 12.0 * omega
    L = np.linalg.cholesky(M)
    square, modes = np.linalg.eigh(np.linalg.solve(L, np.linalg.solve(L, S).T))
    modes = np.linalg.solve(L.T, modes)
    frequency = np.sqrt(np.maximum(square, 0.0))
    amplitude = modes.T @ push
    wave = np.where(frequency[:, None] > 0.0, np.sin(np.outer(frequency, t)) / np.maximum(frequency, 1e-30)[:, None], t)
    y = modes @ (amplitude[:, None] * wave)
    return y[-2], y[-1]
