# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Two elastic disks collide and part (D. Sulsky, Z. Chen, H. L. Schreyer, Comput. Methods Appl. Mech. Eng. 118, 179
(1994), section 7.3).

Error: of the velocity at which the centers of mass part, over that at which they met.  There is no exact value; the
reference is what three transfers of fix mpm have with 0.00625 m (0.894, 0.896, 0.897).  A negative value is that of
disks that have passed through each other.
"""
from common import Case, Found, here, lammps, result, steps_and_atoms

REFERENCE = 0.895


def measure(folder, output):
    r = result(output)
    steps, atoms = steps_and_atoms(output)
    return Found({"restitution": 100 * abs(r["part"] / REFERENCE - 1)}, atoms, steps,
                 "restitution %.3f, kinetic energy kept %.3f" % (r["part"], r["kept"]) +
                 ("; went through each other" if r["part"] < 0 else ""))


def cases():
    for h in 0.05, 0.025:
        for transfer in "aflip 1.0", "apic":
            yield Case("MPM", "h = %g, %s" % (h, transfer),
                       [lammps("MPM", here(__file__, "in.mpm"), h=h, transfer=transfer)], measure)
    # the manual of smd/hertz advises about half of Young's modulus, 500
    for d, contact, cfl in ((0.025, "500", 0.2), (0.025, "1e5", 0.2), (0.025, "1e5", 0.05), (0.0125, "4e5", 0.1)):
        yield Case("MACHDYN TLSPH", "d = %g, contact %s, CFL %g" % (d, contact, cfl),
                   [lammps("PEERS", here(__file__, "in.tlsph"), d=d, contact=contact, cfl=cfl)], measure)
