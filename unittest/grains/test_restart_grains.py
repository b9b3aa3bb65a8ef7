# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: restart mpi
"""Grains on a block go on from a restart file as if there had been no break, with the history of
their contacts.  Each run is a process of its own: in the ID of the fix with that history LAMMPS
counts the pair styles of the process, so that a second instance does not find its history."""

import tempfile

import mpm_testing as mt

HEAD = """
units           lj
boundary        p p f
atom_style      hybrid sphere mpm
neighbor        0.3 multi
comm_modify     vel yes mode multi
region          box block 0 9 0 9 0 8
create_box      2 box
fix             grid all mpm 1.0
region          body block INF INF INF INF 0 4
create_points   1 region body ppc 2 diameter 0.5
%s
set             type 2 diameter 1.8 density 2.0
group           grains type 2
velocity        grains set 0.5 0.2 -1.0
""" % "\n".join("create_atoms 2 single %d.1 %d.2 4.9" % (1 + 3 * (k % 3), 1 + 3 * (k // 3))
                for k in range(9))

REST = """
group           body type 1
group           grains type 2
fix             soft body mpm/material density 1.0 neohookean 20.0 0.3
fix             floor all mpm/boundary zlo stick
fix             move grains nve/sphere
pair_style      granular
pair_coeff      * * hertz/material 50.0 0.5 0.3 tangential mindlin NULL 0.5 0.4
neigh_modify    exclude type 1 1
timestep        0.02
compute         kg grains ke
compute         kb body ke
compute         r grains erotate/sphere
compute         s body mpm/atom vonmises
compute         m body reduce ave c_s
thermo          10
thermo_style    custom step c_kg c_kb c_r c_m
thermo_modify   format float %24.17g norm no
"""

AGAIN = """
read_restart    grains.restart
neighbor        0.3 multi
comm_modify     vel yes mode multi
fix             grid all mpm 1.0
""" + REST + "run 60\n"


def last_table(folder, text, processes):
    result = mt.ok(mt.lammps(folder, text, processes=processes))
    names, rows = mt.thermo(result.output)[-1]
    assert len(names) == 5 and len(rows) == 7, rows
    return [[float(word) for word in row] for row in rows], result


def difference(a, b):
    return max(abs(x - y) / max(abs(x), abs(y), 1e-300) for row, other in zip(a, b) for x, y in zip(row, other))


def check(processes, readers):
    with tempfile.TemporaryDirectory() as folder:
        text = HEAD + REST + "run 60\nwrite_restart grains.restart\nrun 60\n"
        whole, _ = last_table(folder, text, processes)
        assert abs(whole[0][1] - whole[-1][1]) > 0.01 * whole[0][1], whole
        assert whole[0][3] > 1.0e-6, "no rotation: no friction"
        for number in readers:
            again, result = last_table(folder, AGAIN, number)
            found = "All restart file peratom fix info was re-assigned" in result.output
            assert found, result.output
            most = difference(whole, again)
            print("%d processes, then %d: %.1e" % (processes, number, most))
            assert most <= (0.0 if number == processes else 1.0e-12), (number, most)


def test_file_of_one_process():
    check(1, (1, 2))


def test_file_of_two_processes():
    check(2, (2, 1, 3))


mt.main(globals())
