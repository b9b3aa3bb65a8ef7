# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: input
"""Neighbor lists of points and grains: warnings for the settings that make them slow, and none for
those that do not."""

import shutil
import tempfile

import mpm_testing as mt

PAIRS = "pairs of material points of type 1 are in the neighbor lists"
MULTI = "are many times faster with neighbor ... multi and comm_modify mode multi"

SCENE = """
units           lj
boundary        p p f
atom_style      hybrid sphere mpm
neighbor        0.3 %(style)s
comm_modify     vel yes
region          box block 0 9 0 9 0 12
create_box      2 box
fix             grid all mpm 1.0
region          body block INF INF INF INF 0 %(deep)s
create_points   1 region body ppc 2 diameter 0.5
create_atoms    2 single 4.1 4.2 9.5
set             type 2 diameter %(grain)s density 2.0
group           body type 1
group           some id 1
group           grains type 2
fix             soft body mpm/material density 1.0 neohookean 20.0 0.3
fix             floor all mpm/boundary zlo stick
fix             move grains nve/sphere
pair_style      granular
pair_coeff      * * hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4
%(exclude)s
timestep        0.02
run             0
"""

TYPE, BODY, SOME = ("neigh_modify exclude " + what for what in ("type 1 1", "group body body", "group some some"))


def test_warnings():
    folder = tempfile.mkdtemp(prefix="mpm_neighbor_")
    try:
        for style, exclude, grain, deep, expected in (
                ("multi\ncomm_modify mode multi", TYPE, 2.0, 4, ()),
                ("multi\ncomm_modify mode multi", BODY, 2.0, 4, ()),
                ("multi\ncomm_modify mode multi", "", 2.0, 4, (PAIRS,)),
                ("multi\ncomm_modify mode multi", SOME, 2.0, 4, (PAIRS,)),
                ("bin", TYPE, 2.0, 4, (MULTI,)),
                ("bin", "", 2.0, 4, (PAIRS, MULTI)),
                ("bin", TYPE, 0.8, 4, ()),      # grains are not much larger
                ("bin", "", 2.0, 1, ())):       # few points: 324
            text = SCENE % {"style": style, "exclude": exclude, "grain": grain, "deep": deep}
            result = mt.lammps(folder, text)
            assert result.code == 0, result.tail()
            for warning in (PAIRS, MULTI):
                found = result.output.count(warning)
                assert found == (warning in expected), "%s %s %s: %s" % (style, exclude, grain, warning)
    finally:
        shutil.rmtree(folder)


mt.main(globals())
