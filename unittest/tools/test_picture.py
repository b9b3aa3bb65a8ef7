# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: output
# sanitize: no
"""tools/picture.py: files of dump mpm/vtk against dump custom, pictures against what is drawn, mistakes."""

import os
import shutil

import mpm_testing as mt

TOOL = os.path.join(mt.ROOT, "tools", "picture.py")

SCENE = """units micro
dimension 2
boundary f f p
atom_style mpm
neighbor 0.5 bin
region box block 0 8 0 8 -0.5 0.5
create_box 1 box
fix grid all mpm 1.0
region body block 2 6 3 5 INF INF
create_points 1 region body ppc 2
fix m all mpm/material density 1 neohookean 100 0.3
velocity all set 0.3 0 0
dump vtk all mpm/vtk 5 s.*.vtp velocity stress J
dump_modify vtk sort id
dump one all mpm/vtk 10 single.*.vtp velocity
dump_modify one sort id precision single
dump packed all mpm/vtk 5 packed.*.vtp velocity stress J F
dump_modify packed sort id compress yes
variable twice equal 2*step
fix curve all ave/time 1 1 5 v_twice v_twice file curve.txt
dump text all custom 5 s.dump id x y z vx
dump_modify text sort id time yes units yes format float %.17g
timestep 0.01
run 10
"""

CHECKS = """import sys
sys.path.insert(0, %r)
import numpy as np
import picture

vtk, text, single, packed = (picture.read_series(name) for name in ("s.pvd", "s.dump", "single.pvd", "packed.pvd"))
for a, b in zip(vtk, packed):
    assert a.time == b.time and a.x.tobytes() == b.x.tobytes()
    assert all(a.fields[name].tobytes() == b.fields[name].tobytes() for name in a.fields)
for s in vtk + text + single:
    assert s.length.of("x") == "x ($\\mu$m)" and s.show_in("mm", "ns").length.of("x") == "x (mm)"
    assert abs(s.length.factor - 1e-3) < 1e-15 and abs(s.clock.factor - 1e3) < 1e-9
assert vtk[1].when() == "t = 50 ns", vtk[1].when()
assert picture.read_table("curve.txt")["v_twice"].tolist() == [0, 10, 20]

# a square that is sheared by 0.6 in its plane and stretched by 2 across it
F = dict(zip(("F_" + ab for ab in picture.TENSOR), np.array([1, 0.6, 0, 0, 1, 0, 0, 0, 2.0])[:, None]))
long, short, angle = (v[0] for v in picture.ellipses(picture.Snapshot(0, None, F), 0, 1))
turn = np.array([[np.cos(np.radians(angle)), -np.sin(np.radians(angle))], [np.sin(np.radians(angle)), np.cos(np.radians(angle))]])
A = np.array([[1, 0.6], [0, 1.0]])
assert np.allclose(turn @ np.diag([long**2, short**2]) @ turn.T, A @ A.T, atol=1e-14) and abs(long * short - 1) < 1e-14
assert np.allclose(picture.ellipses(picture.Snapshot(0, None, F), 0, 2)[0], 2)
assert [s.time for s in vtk] == [s.time for s in text] == [0.0, 0.05, 0.1]
for a, b in zip(vtk, text):
    assert np.array_equal(a.x, b.x) and np.array_equal(a.fields["velocity_x"], b.fields["vx"])
    assert len(a.fields["stress_xz"]) == 32 and a.values("type").min() == 1
    assert np.allclose(a.values("2*velocity_x+x"), 2 * b.fields["vx"] + b.x[:, 0], rtol=0, atol=1e-15)
assert np.allclose(single[1].x, vtk[2].x, atol=1e-6) and not np.array_equal(single[1].x, vtk[2].x)
assert [s.time for s in picture.read_series("s.pvd", [0.06, 9.0])] == [0.05, 0.1]
assert abs(picture.usual_distance(vtk[0].x) - 0.5) < 1e-12
assert len(picture.cut(vtk[0], "x < 4").x) == 16
# what has no value at first does not count
assert picture.limits_of(vtk, "where(x > 5.77, x, nan)") == (vtk[2].x[:, 0].max(),) * 2
""" % os.path.dirname(TOOL)

# the share of the picture that has a color
LOOK = """import matplotlib.image, numpy as np
picture = matplotlib.image.imread("p.png")[:, :, :3]
drawn = (abs(picture - picture.mean(axis=2, keepdims=True)).max(axis=2) > 0.1)
assert drawn.mean() > 0.1, drawn.mean()
"""


def python():
    for name in ("python3", "/usr/bin/python3"):
        if mt.run([name, "-c", "import matplotlib, PIL"]).code == 0:
            return name
    raise mt.Skip("matplotlib is not installed")


folder = mt.scratch_folder()


def test_reads_what_lammps_writes():
    name = python()
    mt.ok(mt.lammps(folder, SCENE))
    mt.ok(mt.run([name, "-c", CHECKS], folder))


def test_draws():
    name = python()
    mt.ok(mt.run([name, TOOL, "s.pvd", "--color", "sqrt(velocity_x**2)", "--view", "xy", "yx", "--cut", "x < 5",
                  "--title", "a block", "--label", "speed", "-o", "p.png"], folder))
    mt.ok(mt.run([name, "-c", LOOK], folder))
    mt.ok(mt.run([name, TOOL, "s.dump", "--color", "vx", "--times", "0.05", "-o", "one.png"], folder))
    mt.ok(mt.run([name, TOOL, "s.pvd", "--color", "J", "-o", "m.gif"], folder))
    mt.ok(mt.run([name, "-c", "from PIL import Image; assert Image.open('m.gif').n_frames == 3"], folder))
    mt.ok(mt.run([name, TOOL, "packed.pvd", "--color", "where(id > 28, nan, J)", "--deformed", "--diameter", "0.5+0.2*(id > 20)", "--unit-length", "nm", "-o", "p.png"], folder))
    mt.ok(mt.run([name, "-c", LOOK], folder))


def test_movie_with_ffmpeg():
    if not shutil.which("ffmpeg"):
        raise mt.Skip("ffmpeg is not installed")
    name = python()
    mt.ok(mt.run([name, TOOL, "s.pvd", "--color", "J", "--view", "xy", "yx", "-o", "m.mp4"], folder))
    probe = mt.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames,pix_fmt",
                    "-of", "csv=p=0", "m.mp4"], folder)
    mt.ok(probe)
    assert probe.output.strip() == "yuv420p,3", probe.output


# what the words of a command end with, all in one process as starting matplotlib takes longest
MISTAKES = """import os, sys
sys.path.insert(0, %r)
import matplotlib, picture
matplotlib.rcParams["animation.ffmpeg_path"] = "no_such_program"
with open("log.lammps.vtp", "w") as file:
    file.write("nothing")
for words, text in ((["s.pvd", "--color", "nothing"], "there are J id"), (["s.pvd", "--view", "xx"], "such as xz"),
                    (["s.pvd", "--cut", "x > 99"], "no points are left"), (["s.pvd", "--color", "nan*x"], "finite"), (["log.lammps"], "no file of dump custom"),
                    (["log.lammps.vtp"], "no file of dump mpm/vtk"), (["s.pvd", "--deformed"], "need the field F"),
                    (["s.pvd", "--unit-time", "mm"], "unit mm: that of the run is us"),
                    (["s.pvd", "-o", "q.mp4"], "a movie with the name .gif does without")):
    sys.argv = ["picture.py", "-o", "q.png"] + words
    try:
        picture.main()
        raise Exception(words)
    except SystemExit as error:
        assert text in str(error), error
""" % os.path.dirname(TOOL)


def test_mistakes_are_told():
    mt.ok(mt.run([python(), "-c", MISTAKES], folder))


mt.main(globals())
