# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: input mpi
# timeout: 300
"""An error on any of several ranks ends the whole run: message, exit code, no waiting."""

import re

import mpm_testing as mt

SCENE = """
units lj
boundary f f f
atom_style mpm
neighbor 0.3 bin
processors * 1 1
region box block 0 12 0 8 0 8
create_box 2 box
fix grid all mpm 1.0
region body block {body}
create_points 1 region body ppc 2
fix soft all mpm/material density 1.0 neohookean 10.0 0.3
velocity all set 0.1 0 0
timestep 0.01
thermo 5
{lines}
run 200
"""


def result_of(lines, body="2 10 2 6 2 6", processes=2):
    return mt.lammps_once(SCENE.format(lines=lines, body=body), processes=processes, timeout=60)


def error_of(*args, **options):
    result = result_of(*args, **options)
    assert result.code is not None, "hangs:\n" + result.tail()
    assert result.code != 0, "exit code 0:\n" + result.tail()
    return result.output


def expect(pattern, *args, **options):
    output = error_of(*args, **options)
    assert re.search(pattern, output), "expected: %s\nfound:\n%s" % (pattern, output[-2000:])


def test_good_scene_runs():
    mt.ok(result_of(""))


def test_point_leaves_on_one_rank():
    for processes in (2, 3):
        expect(r"Material point \d+ at 12\S* .*with velocity 5 .* has left the box through a "
               r"fixed face; enlarge the box", "velocity all set 5 0 0", processes=processes)


def test_point_leaves_with_ranks_without_points():
    expect(r"has left the box", "velocity all set -5 0 0", body="1 3 2 4 2 4", processes=3)


def test_point_inverts_on_one_rank():
    expect(r"Material point \d+ at .*determinant -.*: try a smaller time step",
           "fix grid all mpm 1.0 dtcheck no\nregion right block 8 INF INF INF INF INF\n"
           "group right region right\nvelocity right ramp vx 5 -5 x 8 10\ntimestep 0.5")


def test_time_step_too_large_on_one_rank():
    expect(r"Time step 0\.2 is above the limit .* at step 0: Material point 128 at",
           "set atom 128 vx 20.0\ntimestep 0.2")


def test_point_outside_at_the_start():
    expect(r"Material point 128 at 30 .* has left the box", "set atom 128 x 30.0")


def test_state_not_finite_on_one_rank():
    expect(r"1 material points have .* not finite .* for instance point 128",
           "group one id 128\nvariable big atom 1e308*10\nvelocity one set v_big 0 0")


def test_force_becomes_infinite_on_one_rank():
    expect(r"Material point \d+ at ", "group one id 128\nvariable big equal 1e308*10\n"
           "fix kick one addforce v_big 0 0")


def test_material_missing_for_points_of_one_rank():
    expect(r"points have no material, for instance point \d+: define a fix mpm/material",
           "unfix soft\nregion left block INF 5 INF INF INF INF\ngroup left region left\n"
           "fix soft left mpm/material density 1.0 linear 10.0 0.3")


def test_material_file_that_no_rank_can_read():
    expect(r"cannot read file nothing\.mpm",
           "unfix soft\nfix soft all mpm/material file nothing.mpm")


mt.main(globals())
