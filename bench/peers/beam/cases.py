# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Cantilever, 20 times as long as deep, in plane strain: static, bent by half of its length.

Error: of the deflection of the end, against CalculiX with elements of order 2 that are half as large as the smallest in
the table (all with St. Venant-Kirchhoff material).  The elastica (thin beam) has 0.49346 (K. Mattiasson, Int. J. Numer.
Methods Eng. 17, 145 (1981)).
"""
import os
import re

from common import Case, Found, here, lammps, result, steps_and_atoms

L, T, E = 1.0, 0.05, 1e8
REFERENCE = {"deflection": 0.494594, "shortening": 0.161350}    # 8 elements CPE8 in the depth: 0.4945938, 0.1613501


def write_ccx(path, n, kind):
    """input of CalculiX with n elements in the depth"""
    P = 2 * E * T**3 / 12 / L**2
    m = 2 if kind.startswith("CPE8") else 1
    NX, NY = m * n * 20, m * n

    def node(i, j):
        return 1 + i * (NY + 1) + j

    def numbers(values):
        return "\n".join(",".join(str(v) for v in values[k:k + 10]) for k in range(0, len(values), 10)) + "\n"

    with open(path, "w") as f:
        f.write("*NODE,NSET=ALL\n")
        for i in range(NX + 1):
            for j in range(NY + 1):
                if m == 1 or i % 2 == 0 or j % 2 == 0:
                    f.write("%d,%.12g,%.12g,0\n" % (node(i, j), L * i / NX, T * (j / NY - 0.5)))
        f.write("*ELEMENT,TYPE=%s,ELSET=EALL\n" % kind)
        count = 0
        for a in range(0, NX, m):
            for b in range(0, NY, m):
                nodes = [node(a, b), node(a + m, b), node(a + m, b + m), node(a, b + m)]
                if m == 2:
                    nodes += [node(a + 1, b), node(a + 2, b + 1), node(a + 1, b + 2), node(a, b + 1)]
                count += 1
                f.write("%d,%s\n" % (count, ",".join(map(str, nodes))))
        f.write("*NSET,NSET=CLAMP\n" + numbers([node(0, j) for j in range(NY + 1)]))
        f.write("*NSET,NSET=TIP\n%d\n" % node(NX, NY // 2))
        f.write("*MATERIAL,NAME=M\n*ELASTIC\n%g,0\n*SOLID SECTION,ELSET=EALL,MATERIAL=M\n1.0\n" % E)
        f.write("*BOUNDARY\nCLAMP,1,2\n*STEP,NLGEOM,INC=100\n*STATIC\n1.0,1.0\n*CLOAD\n")
        # a uniform traction: by Simpson's rule along an edge of order 2
        share = ([(1 if k in (0, NY) else 4 if k % 2 else 2) / (3.0 * NY) for k in range(NY + 1)] if m == 2 else
                 [(0.5 if k in (0, NY) else 1.0) / NY for k in range(NY + 1)])
        for k, s in enumerate(share):
            f.write("%d,2,%.14g\n" % (node(NX, k), -P * s))
        f.write("*NODE PRINT,NSET=TIP,FREQUENCY=99\nU\n*END STEP\n")


def errors(across, along):
    return {"deflection": 100 * abs(across / REFERENCE["deflection"] - 1),
            "shortening": 100 * abs(along / REFERENCE["shortening"] - 1)}


def calculix(n, kind):
    def prepare(folder):
        write_ccx(os.path.join(folder, "beam.inp"), n, kind)

    def measure(folder, output):
        with open(os.path.join(folder, "beam.dat")) as file:
            numbers = [[float(w) for w in line.split()] for line in file
                       if re.match(r"^ +\d+ +\S+ +\S+ +\S+\s*$", line)]
        along, across = -numbers[-1][1], -numbers[-1][2]
        return Found(errors(across, along), 20 * n * n, note="%.7f, %.7f" % (across, along))
    return Case("CalculiX", "%d %s in the depth" % (n, kind), [["ccx", "-i", "beam"]], measure, prepare)


def mpm(n, ppc):
    def measure(folder, output):
        r = result(output)
        return Found(errors(r["across"], r["along"]), steps_and_atoms(output)[1],
                     note="%.7f, %.7f" % (r["across"], r["along"]))
    return Case("MPM", "%d cells in the depth, ppc %d" % (n, ppc),
                [lammps("MPM", here(__file__, "in.mpm"), n=n, ppc=ppc)], measure)


def cases():
    yield mpm(4, 2)
    yield mpm(4, 4)
    yield mpm(8, 2)
    yield mpm(16, 2)
    yield calculix(8, "CPE4")
    yield calculix(16, "CPE4")
    yield calculix(1, "CPE8")
    yield calculix(2, "CPE8")
    yield calculix(4, "CPE8")
