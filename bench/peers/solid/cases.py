# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""A block of rubber, 2 m x 1 m x 1 m, clamped at one end, bends under its weight in 3d: static, neo-Hookean.

Error: of the sag, the mean displacement of the body along its weight (twice the work of the weight over the weight),
against CalculiX with C3D20R, extrapolated from 4, 8, and 16 elements in 1 m.  Edges of the clamp are singular, for all
methods.
"""
import os
import re

from common import Case, Found, here, lammps, result, steps_and_atoms

E, NU, RHO, G = 1e6, 0.3, 1000.0, 8.0
REFERENCE = 0.10522    # C3D20R, 2 to 16 elements in 1 m: 0.102244, 0.104165 (4), 0.104820, 0.104993, 0.105068

# nodes of a cube of side 2 in the order of CalculiX, corners first, and their shares of its volume
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
EDGES = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
         (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]


def mesh(n, quadratic):
    """places of nodes by their number, elements, and weights of nodes in a mean over the volume"""
    places, elements, weights = {}, [], {}
    local = CORNERS + (EDGES if quadratic else [])
    share = [-0.125] * 8 + [1.0 / 6.0] * 12 if quadratic else [0.125] * 8
    top = 2 * n + 1
    for i in range(2 * n):
        for j in range(n):
            for k in range(n):
                nodes = []
                for (a, b, c), s in zip(local, share):
                    x, y, z = 2 * i + a, 2 * j + b, 2 * k + c
                    number = 1 + (x * top + y) * top + z
                    places[number] = (x, y, z)
                    weights[number] = weights.get(number, 0.0) + s / (2 * n**3)
                    nodes.append(number)
                elements.append(nodes)
    return places, elements, weights


def write_ccx(path, n, kind):
    places, elements, _ = mesh(n, kind.startswith("C3D20"))
    shear, bulk = E / (2 * (1 + NU)), E / (3 * (1 - 2 * NU))
    with open(path, "w") as f:
        f.write("*NODE,NSET=ALL\n")
        for number, (x, y, z) in sorted(places.items()):
            f.write("%d,%.12g,%.12g,%.12g\n" % (number, x / (2 * n), y / (2 * n), z / (2 * n)))
        f.write("*ELEMENT,TYPE=%s,ELSET=EALL\n" % kind)
        for count, nodes in enumerate(elements, 1):
            words = [str(w) for w in [count] + nodes]
            f.write(",".join(words[:11]) + (",\n" + ",".join(words[11:]) if len(words) > 11 else "") + "\n")
        f.write("*NSET,NSET=CLAMP\n%s\n" % "\n".join(str(k) for k, p in sorted(places.items()) if p[0] == 0))
        f.write("*MATERIAL,NAME=M\n*HYPERELASTIC,NEO HOOKE\n%.10g,%.10g\n*DENSITY\n%g\n" % (shear / 2, 2 / bulk, RHO))
        f.write("*SOLID SECTION,ELSET=EALL,MATERIAL=M\n*BOUNDARY\nCLAMP,1,3\n")
        f.write("*STEP,NLGEOM,INC=100\n*STATIC\n1.0,1.0\n*DLOAD\nEALL,GRAV,%g,0,0,-1\n" % G)
        f.write("*NODE PRINT,NSET=ALL,FREQUENCY=99\nU\n*END STEP\n")


def found(sag, size):
    return Found({"sag": 100 * abs(sag / REFERENCE - 1)}, size, note="sag %.6f" % sag)


def calculix(n, kind, long=False):
    def prepare(folder):
        write_ccx(os.path.join(folder, "solid.inp"), n, kind)

    def measure(folder, output):
        _, elements, weights = mesh(n, kind.startswith("C3D20"))
        sag = 0.0
        with open(os.path.join(folder, "solid.dat")) as file:
            for line in file:
                if re.match(r"^ +\d+ +\S+ +\S+ +\S+\s*$", line):
                    words = line.split()
                    sag -= weights[int(words[0])] * float(words[3])
        return found(sag, len(elements))
    return Case("CalculiX", "%d %s in 1 m" % (n, kind), [["ccx", "-i", "solid"]], measure, prepare, long)


def mpm(n, ppc, long=False):
    def measure(folder, output):
        return found(result(output)["sag"], steps_and_atoms(output)[1])
    return Case("MPM", "%d cells in 1 m, ppc %d" % (n, ppc),
                [lammps("MPM", here(__file__, "in.mpm"), n=n, ppc=ppc)], measure, long=long)


def cases():
    for n in 4, 6, 8, 12:
        yield mpm(n, 2)
    for n, kind in ((4, "C3D8"), (8, "C3D8"), (4, "C3D8I"), (8, "C3D8I"), (2, "C3D20R"), (4, "C3D20R")):
        yield calculix(n, kind)
    yield calculix(8, "C3D20R", True)
