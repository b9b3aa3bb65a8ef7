# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: physics examples
# sanitize: no
# timeout: 300
"""The tension test of examples/necking against Considere's construction and finite elements."""

import os
import re
import tempfile

import numpy as np

import mpm_testing as mt

BAR = os.path.join(mt.ROOT, "examples", "necking", "in.necking")

# d(A + B e^n)/de = A + B e^n at e = 0.09444 for A = 499, B = 382 MPa, n = 0.458: true stress
# 628.6 MPa, engineering strain 0.1023 with the elastic part, and that stress / (1 + strain)
STRENGTH, STRAIN = 570.3, 0.1023


def pull(*changes):
    """Strain, force at the grip, and force in the middle (MPa of the initial section)."""
    text = "\n".join(line for line in mt.read(BAR).split("\n")    # without pictures
                     if not re.match(r"(dump|dump_modify) +pic|  +(box no|amap)", line))
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    with tempfile.TemporaryDirectory() as folder:
        mt.ok(mt.lammps(folder, text, timeout=200))
        rows = np.loadtxt(os.path.join(folder, "curve.txt"))
    return rows[:, 1], rows[:, 2], rows[:, 3]


def smoothed(grip, middle):
    return np.convolve(0.5 * (grip + middle), np.full(9, 1.0 / 9.0), "same")[4:-4]


def test_strength_and_necking():
    changes = [("> 0.22", "> 0.14")] if mt.QUICK else []    # the neck takes long
    strain, grip, middle = pull(*changes)
    smooth = smoothed(grip, middle)
    k = smooth.argmax()
    strength, at = smooth[k], strain[4 + k]
    print("tensile strength %.1f MPa at %.4f; by Considere %.1f MPa at %.4f" %
          (strength, at, STRENGTH, STRAIN))
    assert abs(strength / STRENGTH - 1) < 0.015
    assert abs(at - STRAIN) < 0.02

    # grip and middle carry the same force: slow enough
    plastic = strain > 0.02
    difference = np.abs(grip - middle)[plastic].max() / STRENGTH
    print("largest difference of the forces %.1f %%" % (100 * difference))
    assert difference < 0.02

    # the bar hardens as in uniaxial tension before the neck: s = (A + B e^n)/(1 + strain)
    for x in (0.04, 0.06, 0.08):
        e = np.log(1 + x) - 0.003
        expected = (499 + 382 * e**0.458) / (1 + x)
        found = np.interp(x, strain[4:-4], smooth)
        print("strain %.2f: %.1f MPa, uniaxial %.1f MPa" % (x, found, expected))
        assert abs(found / expected - 1) < 0.015

    if mt.QUICK:
        return
    # after it the force falls, between square and round bars of finite elements (501 and 560 MPa)
    late = np.interp(0.16, strain[4:-4], smooth)
    print("strain 0.16: %.1f MPa" % late)
    assert 500.9 < late < 559.7


def test_failure():
    """With Johnson-Cook failure the bar breaks: the force has dropped by half at a strain of 0.192 in
    finite elements of a square bar (0.248 for a round one)."""
    mt.long_case()
    strain, grip, middle = pull(
        ("hardening power 382e6 0.458",
         "hardening power 382e6 0.458 damage johnson/cook 0.636 1.936 -2.969 soften from 0.3"),
        ("> 0.22", "> 0.25"), ("run             15000", "run             20000"))
    smooth, strain = smoothed(grip, middle), strain[4:-4]
    k = smooth.argmax()
    half = strain[k:][smooth[k:] < 0.5 * smooth[k]]
    assert len(half), "the bar does not break"
    print("strength %.1f MPa, half of it is left at strain %.4f; at the end %.1f MPa" %
          (smooth[k], half[0], smooth[-1]))
    assert abs(smooth[k] / STRENGTH - 1) < 0.015
    assert abs(half[0] / 0.192 - 1) < 0.15
    assert abs(smooth[-1]) < 0.05 * STRENGTH


mt.main(globals())
