# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: input
"""Neighbor lists of points and grains: warnings for the settings that make them slow, and none for
those that do not."""

import mpm_testing as mt

PAIRS = "pairs of material points of type %d are in the neighbor lists"
MULTI = "neighbor lists of points and of grains %s times as large are many times faster with neighbor ... multi and " \
        "comm_modify mode multi"
ALL = [PAIRS % 1, PAIRS % 3, "are many times faster"]

SCENE = """
units           lj
boundary        p p f
processors      * 1 1
atom_style      hybrid sphere mpm
neighbor        0.3 %(lists)s
comm_modify     vel yes mode %(ghosts)s
region          box block 0 9 0 9 0 12
create_box      3 box
%(grid)s
region          body block INF INF INF INF 0 %(deep)s
create_points   1 region body ppc 2 diameter 0.5
create_atoms    2 single 6.6 4.2 9.5
set             type 2 diameter %(grain)s density 2.0
group           body type 1
group           some id 1
region          low block INF 4.5 INF INF INF INF
group           low region low
group           grains type 2
%(more)s
fix             soft %(points)s mpm/material density 1.0 neohookean 20.0 0.3
fix             move grains nve/sphere
%(pair)s
%(exclude)s
timestep        0.02
run             0
"""

GRID = "fix grid all mpm 1.0"
GRANULAR = "granular hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4"
COEFF = GRANULAR.replace("granular ", "")
DEFAULT = {"lists": "multi", "grid": GRID, "deep": 4, "grain": 2.0, "more": "", "points": "body",
           "pair": "pair_style granular\npair_coeff * * " + COEFF, "exclude": "exclude type 1 1"}

# a second body, with a type of its own
OTHER = {"points": "points", "more": """
region          other block INF INF INF INF 5 6
create_points   3 region other ppc 2 diameter %s
group           other type 3
group           points type 1 3"""}

# a grain of the type of the points, and group body is theirs alone
SAME_TYPE = {"more": "set type 2 type 1", "exclude": "exclude group body body"}

# two fields that touch by their own pair style
FIELDS = {"points": "points", "grid": """
group           body type 1
group           other type 3
fix             grid body mpm 1.0
fix             grid2 other mpm 1.0""", "more": OTHER["more"].replace("region other ppc 2", "region other ppc 2 fix grid2"),
          "pair": "pair_style hybrid/overlay granular mpm/penalty\npair_coeff * * " + GRANULAR +
          "\npair_coeff 1 3 mpm/penalty 10.0"}


def check(expected, processes=0, **settings):
    """Exactly these warnings, in this scene."""
    values = dict(DEFAULT)
    values.update(settings)
    values["more"] = values["more"].replace("%s", str(settings.get("other", 0.5)))
    values["ghosts"] = "multi" if values["lists"] == "multi" else "single"
    values["exclude"] = "\n".join("neigh_modify " + line for line in values["exclude"].split("\n") if line)
    result = mt.ok(mt.lammps_once(SCENE % values, processes=processes))
    for warning in expected:
        assert result.output.count(warning) == 1, "%s: %s" % (settings, warning)
    for warning in ALL:
        wanted = sum(warning in text for text in expected)
        assert result.output.count(warning) == wanted, "%s: %s" % (settings, warning)


def test_pairs_of_points():
    one = [PAIRS % 1]
    check([])
    check(one, exclude="")
    check([], exclude="exclude type 1 1\nexclude type 1 2")
    check(one, exclude="exclude type 1 2")
    check([], exclude="exclude group body body")
    check([], exclude="exclude group body body\nexclude group some some")
    check(one, exclude="exclude group some some")
    check(one, exclude="exclude group body grains")
    check(one, exclude="exclude group grains body")
    check([], **SAME_TYPE)
    check(one, exclude="exclude group low low", processes=2)     # the points of one of the ranks


def test_several_types_of_points():
    check([PAIRS % 3], **OTHER)
    check([PAIRS % 1], **dict(OTHER, exclude="exclude group other other"))
    check([], **dict(OTHER, exclude="exclude group points points"))


def test_pairs_that_are_wanted_or_not_there():
    check([], exclude="", **FIELDS)
    check([], exclude="", pair="pair_style hybrid granular\npair_coeff * * %s\npair_coeff 1 1 none" % GRANULAR)


def test_grains_much_larger_than_points():
    check([MULTI % "4.0"], lists="bin")
    check([PAIRS % 1, MULTI % "4.0"], lists="bin", exclude="")
    check([], lists="bin", grain=0.8)
    check([], lists="bin", exclude="exclude group points points", **dict(OTHER, grain=0.8, other=0.3))
    check([MULTI % "4.0"], lists="bin", processes=2)     # one of them has no grain


def test_few_points():
    check([], lists="bin", exclude="", deep=1)     # 324
    check([PAIRS % 1], exclude="", deep=2, processes=2)     # 1296, less on each of the ranks


mt.main(globals())
