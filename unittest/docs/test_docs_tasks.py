# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs examples
# timeout: 300
"""The tutorial and the pages of tasks: their inputs run as they are printed, without warnings, their Python scripts run
with what these have written, and the numbers that the pages speak of agree with theory."""

import math
import os
import re
import shlex
import shutil
import sys

import docs_scenes
import mpm_testing as mt

sys.path.insert(0, os.path.join(mt.ROOT, "bench"))
import absorbing_layers
import scaling_model


def files(page):
    """(language, text) of the inputs and scripts of a page, in their order, as they are printed"""
    lines = mt.read(os.path.join(docs_scenes.PAGES, page + ".rst")).splitlines()
    found = []
    for k, line in enumerate(lines):
        start = re.match(r"\.\. code-block:: (LAMMPS|python)$", line)
        if not start:
            continue
        text = []
        for row in lines[k + 1:]:
            if row and not row.startswith("   "):
                break
            text.append(row[3:])
        found.append((start.group(1), "\n".join(text).strip() + "\n"))
    return found


def run_page(page, folder, processes=0):
    """Run all inputs and scripts of a page in one folder, in their order; the outputs of LAMMPS."""
    outputs = []
    for language, text in files(page):
        if language == "python":
            script = os.path.join(folder, "script.py")
            with open(script, "w", encoding="ascii") as file:
                file.write(text)
            mt.ok(mt.run(["/usr/bin/python3" if os.path.exists("/usr/bin/python3") else "python3", script], folder))
        elif re.search(r"^(run|write_restart|mpm_point)\b", text, re.M):    # not single lines
            result = mt.ok(mt.lammps(folder, text, processes=processes))
            # LAMMPS says this of each run with *hybrid sphere mpm*; the page tells
            wrong = [line for line in mt.warnings(result.output) if "field rmass is used in multiple" not in line]
            assert not wrong, page + "\n" + "\n".join(wrong)
            outputs.append(result.output)
    return outputs


def run_movies(page, folder, made):
    """The commands of a page that make pictures and movies of what its inputs wrote, as they are printed, but for movies
    of points, which have two frames here."""
    python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else "python3"
    text = mt.read(os.path.join(docs_scenes.PAGES, page + ".rst"))
    for line in re.findall(r"^   ((?:ffmpeg|python3 tools/picture.py) .*)$", text, re.M):
        words = shlex.split(line)
        if not shutil.which("ffmpeg") and (words[0] == "ffmpeg" or line.endswith(".mp4")):
            continue
        if words[0] == "ffmpeg":    # the shell leaves the quoted pattern to ffmpeg
            words[1:1] = ["-y", "-loglevel", "error"]
        else:
            words[:2] = [python, os.path.join(mt.ROOT, words[1])]
        mt.ok(mt.run(words + (["--times", "0", "0.1"] if line.endswith(".mp4") and words[0] == python else []), folder))
        assert os.path.getsize(os.path.join(folder, words[-1])) > 5000, line
        made.remove(words[-1])
    left = [name for name in made if shutil.which("ffmpeg") or not name.endswith(".mp4")]
    assert not left, left


def columns(path):
    """Columns of a file of fix ave/time."""
    rows = [line.split() for line in mt.read(path).splitlines() if line and not line.startswith("#")]
    return list(zip(*[[float(word) for word in row] for row in rows]))


def near(value, expected, share):
    assert abs(value - expected) <= share * abs(expected), "%g instead of %g" % (value, expected)


def test_tutorial():
    folder = mt.scratch_folder()
    run_page("Howto_mpm_tutorial", folder)
    run_movies("Howto_mpm_tutorial", folder, ["ball.mp4", "stress.mp4"])
    for name in ("force.png", "ball.gif", "ball.0025.png", "ball.pvd"):
        assert os.path.getsize(os.path.join(folder, name)) > 1000, name
    _, t, v, force = columns(os.path.join(folder, "force.txt"))
    touch = [k for k in range(len(t)) if force[k] != 0.0]

    # the fall, exact but for half a millimeter, 0.05 of a point spacing, and one time step
    near(t[touch[0]], math.sqrt(2 * 0.05 / 9.81), 0.01)
    near(v[touch[0] - 1], -math.sqrt(2 * 9.81 * 0.05), 0.01)
    # impulse of floor and gravity
    mass = 1000 * 8.0e-6 / 8 * 4224
    impulse = sum(-force[k] * (t[k] - t[k - 1]) for k in range(1, len(t)))
    near(impulse - mass * 9.81 * t[-1], mass * (v[-1] - v[0]), 1e-5)
    # Hertz, a ball of 10 cm at 0.99 m/s: a compression of a tenth of the radius, and ten cells in it
    stiffness = 1.0e6 / (1 - 0.4**2)
    depth = (15 * mass * 0.99**2 / (16 * stiffness * math.sqrt(0.1))) ** 0.4
    near(t[touch[-1]] - t[touch[0]], 2.94 * depth / 0.99, 0.25)
    assert 0 < v[touch[-1] + 1] < 0.99


def test_changes_that_the_tutorial_proposes():
    text = files("Howto_mpm_tutorial")[0][1]
    text = re.sub(r"(?m)^dump.*?[^&]\n", "", text.replace("&\n", "")).replace("until 0.25", "until 0.15")
    for old, new in (("separate", "stick"), ("separate", "separate friction 0.3\nvelocity all set 0.2 0 0"),
                     ("density 1000 neohookean 1.0e6 0.4", "density 1000 eos linear 1.67e6 strength j2 0.36e6 2.0e4")):
        assert old in text
        result = mt.ok(mt.lammps_once(text.replace(old, new)))
        assert not mt.warnings(result.output), "\n".join(mt.warnings(result.output))



def test_tensile():
    folder = mt.scratch_folder()
    run_page("Howto_mpm_tensile", folder)
    assert os.path.getsize(os.path.join(folder, "curve.png")) > 1000
    bulk, shear, yield_stress, hardening = 68.6e3, 26.3e3, 200.0, 500.0
    young, poisson = 9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)
    modulus = young / (1 - poisson**2)                      # plane strain
    for _, strain, stress in zip(*columns(os.path.join(folder, "curve.txt"))):
        if strain < 1e-3:
            continue    # the speed of the grips still rises
        plastic = 2 / math.sqrt(3) * yield_stress
        plastic += 4 / 3 * hardening * (math.log(1 + strain) - plastic / modulus)
        # the grips are effective up to half a cell from their surface: one cell in 40
        near(stress, min(modulus * strain, plastic / (1 + strain)), 0.025)


def test_two_bodies():
    folder = mt.scratch_folder()
    run_page("Howto_mpm_two_bodies", folder)
    _, t, fx, fy, pl, pr, ql, qr, dx, dy, spin = columns(os.path.join(folder, "contact.txt"))
    assert len(t) > 500 and max(abs(a + b) for a, b in zip(pl + ql, pr + qr)) < 1e-9 * pl[0]
    across = along = gain_x = gain_y = 0.0
    touch = [k for k in range(len(t)) if fx[k] != 0.0]
    for k in range(1, len(t)):
        step, distance = t[k] - t[k - 1], math.hypot(dx[k], dy[k])
        gain_x, gain_y = gain_x + step * fx[k], gain_y + step * fy[k]
        across += step * (fx[k] * dx[k] + fy[k] * dy[k]) / distance
        along += step * (fy[k] * dx[k] - fx[k] * dy[k]) / distance
    near(gain_x, pr[-1] - pr[0], 1e-5)    # six digits are in the file
    near(gain_y, qr[-1] - qr[0], 1e-5)
    # a tenth of the distance of the points
    near(math.hypot(dx[touch[0]], dy[touch[0]]), 0.30, 0.005)
    # friction, sliding all the time; the normal of a round surface of 15 cells in the radius is known to 0.01
    assert abs(along / across + 0.1) < 0.01, along / across
    near(spin[-1], -2 * along / (0.15 * pl[0]), 0.05)
    assert pl[-1] < 0 < pr[-1]


def test_grains():
    mt.long_case()
    folder = mt.scratch_folder()
    run_page("Howto_mpm_grains", folder)
    _, t, momentum, floor, z = columns(os.path.join(folder, "grains.txt"))
    weight = 9.81 * (0.08 * 0.08 * 0.032 * 1000 + 4 * 2500 * 4 / 3 * math.pi * 0.01**3)
    impulse = sum(-floor[k] * (t[k] - t[k - 1]) for k in range(1, len(t)))
    # velocities of grains and points are half a step apart
    missing = abs(impulse - weight * t[-1] - (momentum[-1] - momentum[0]))
    assert missing < 0.5e-4 * max(abs(f) for f in floor), missing
    assert 0.2 < t[-1] + 1e-9 and 0.032 < min(z) < 0.045 < max(z[len(z) // 2:])    # they bounce, and do not sink

    # beads in water: weight, Archimedes, and Schiller and Naumann for a single bead: 50 of them hinder each other, with a
    # share of the volume of 0.002 (law of suspensions: 1 %) that is not everywhere the same
    _, t, z, v, floor, drag, lift = columns(os.path.join(folder, "beads.txt"))
    water, bead = 1000 * 0.08**2 * 0.06 * 9.81, math.pi / 6 * 0.003**3 * 9.81
    near(-floor[0], water, 0.002)
    late = [k for k in range(len(t)) if 0.45 < t[k] < 0.55]    # all in water, none at the floor
    near(sum(lift[k] for k in late) / len(late), 50 * 1000 * bead, 0.01)
    near(sum(drag[k] for k in late) / len(late), 50 * 200 * bead, 0.02)
    # the floor bears them, too; the column swings by half of that, eight times in this while
    near(-sum(floor[k] for k in late) / len(late) - water, 50 * 1200 * bead, 0.05)
    fall = 0.1
    for _ in range(100):
        reynolds = 1000 * fall * 0.003 / 0.001
        fall = (fall + 200 * bead / (3 * math.pi * 0.001 * 0.003 * (1 + 0.15 * reynolds**0.687))) / 2
    near(-sum(v[k] for k in late) / len(late), fall, 0.03)
    assert 0.00145 < z[-1] < 0.0016, z[-1]    # on the floor


def test_restart():
    folder = mt.scratch_folder()
    first, second = (mt.thermo(output)[0][1] for output in run_page("Howto_mpm_restart", folder, processes=2))
    assert len(second) == 4 and second == first[3:], "%s\n%s" % (first, second)
    # on one process, all but the last digits
    other = mt.thermo(mt.ok(mt.lammps(folder, files("Howto_mpm_restart")[1][1])).output)[0][1]
    for here, there in zip(other, second):
        near(float(here[2]), float(there[2]), 1e-9)


def test_loads():
    folder = mt.scratch_folder()
    run_page("Howto_mpm_loads", folder)
    _, t, load, sag, clamp = columns(os.path.join(folder, "load.txt"))
    late = [k for k in range(len(t)) if t[k] > 1.08]    # the last period
    modulus, shear, arm, height = 2.0e7 / (1 - 0.3**2), 2.0e7 / 2.6, 0.9875, 0.1
    beam = 100 * arm**3 / (3 * modulus * height**3 / 12) + 1.2 * 100 * arm / (shear * height)
    # four cells across; the theory of beams leaves out terms of the square of 0.1, height by length
    near(sum(sag[k] for k in late) / len(late), beam, 0.02)
    near(-sum(clamp[k] for k in late) / len(late), 100, 0.01)
    assert all(load[k] == 100 for k in late)


def test_loop():
    folder = mt.scratch_folder()
    run_page("Howto_mpm_loop", folder)
    rows = [[float(word) for word in line.split()] for line in mt.read(os.path.join(folder, "slope.txt")).splitlines()]
    assert [row[0] for row in rows] == [0.1, 0.2, 0.3]
    for friction, acceleration, printed in rows:
        near(printed, 9.81 * (math.sin(math.pi / 6) - friction * math.cos(math.pi / 6)), 1e-12)
        near(acceleration, printed, 0.01)


def test_until():
    folder = mt.scratch_folder()
    output = run_page("Howto_mpm_until", folder)[0]
    period = 4 / math.sqrt(1.0e6 * 0.75 / (1.25 * 0.5) / 1000)
    amplitude = period / (2 * math.pi)
    assert len(mt.thermo(output)) == 3
    for (names, rows), part, where, off in zip(mt.thermo(output), (0.25, 0.5, 1.0), (1.0, 0.0, 0.0), (0.01, 0.05, 0.01)):
        near(float(rows[-1][names.index("Time")]), part * period, 1e-7)    # exactly, in eight digits
        assert abs(float(rows[-1][names.index("v_u")]) - where * amplitude) < off * amplitude, rows[-1]
        assert float(rows[-1][names.index("f_step[4]")]) == 1.0
    times = [float(time) for time in re.findall(r'timestep="(\S+?)"', mt.read(os.path.join(folder, "bar.pvd")))]
    assert len(times) == 21
    for k, time in enumerate(times):
        assert -1e-9 < time - k * period / 20 < 3.0e-4, times    # a time step later at most


def test_pictures():
    mt.long_case()
    folder = mt.scratch_folder()
    output = run_page("Howto_mpm_pictures", folder)[0]
    names = os.listdir(folder)
    for begin, end in (("side", "png"), ("front", "png"), ("dam", "vtp")):
        assert len([name for name in names if name.startswith(begin + ".") and name.endswith("." + end)]) == 31, begin
    assert os.path.getsize(os.path.join(folder, "side.gif")) > 10000
    run_movies("Howto_mpm_pictures", folder, ["side.mp4", "speed.png", "pressure.mp4"])
    head, rows = mt.thermo(output)[0]
    front = float(rows[-1][head.index("c_front")])
    assert 0.2 + 0.5 * 2.8 * 0.3 < front < 0.2 + 2.8 * 0.3, front


def test_points():
    folder = mt.scratch_folder()
    torus, plate = run_page("Howto_mpm_points", folder)
    exact = 2 * math.pi**2 * 0.05 * 0.02**2
    near(float(re.search(r"triangles, volume (\S+),", torus).group(1)), exact, 0.01)    # of 60 x 30 corners: 0.9 % less
    near(float(mt.thermo(torus)[0][1][0][2]), exact, 0.02)                               # of points, 8 across the ring
    assert 0 < float(mt.thermo(torus)[0][1][-1][3]) < 1
    strain, stress = (float(word) for word in mt.thermo(plate)[0][1][-1][2:4])
    near(strain, 0.01 / 0.95, 1e-3)
    # Hashin and Shtrikman from below, equal strain from above
    matrix, inclusions = (int(n) for n in re.search(r"points of types 1 \((\d+)\), 2 \((\d+)\)", plate).groups())
    assert matrix + inclusions == 2500, (matrix, inclusions)
    share = inclusions / 2500
    shear, bulk = 1.0e6 / 2.6, 1.0e6 / 2.6 + 1.0e6 * 0.3 / (1.3 * 0.4)
    low = bulk + share / (1 / (9 * bulk) + (1 - share) / (bulk + shear))
    low += shear + share / (1 / (9 * shear) + (1 - share) * (bulk + 2 * shear) / (2 * shear * (bulk + shear)))
    assert low < stress / strain < (bulk + shear) * (1 + 9 * share), (low, stress / strain)
    assert os.path.getsize(os.path.join(folder, "plate.png")) > 1000


def test_scaling():
    text = files("Howto_mpm_scaling")[0][1]
    two, four = (mt.ok(mt.lammps_once(text, processes=n)).output for n in (2, 4))
    # three layers of 18 x 18 nodes with 4 numbers, in both directions
    assert float(mt.thermo(two)[0][1][1][4]) == 2 * 3 * 18**2 * 32, mt.thermo(two)[0][1]    # the last step sums volumes, too
    assert "initial/final imbalance factor  = 4 1" in four
    # the table of the page
    page = mt.read(os.path.join(docs_scenes.PAGES, "Howto_mpm_scaling.rst"))
    rows = re.findall(r"\* - ([\d,]+)" + 9 * r"\n     - (\S+)(?: %)?", page)
    assert len(rows) == 4
    for row in rows:
        points, sent, *times, efficiency = (float(word.replace(",", "")) for word in row)
        parts, sent_by_model = scaling_model.step(points, 22)
        assert abs(sent - 1e-6 * sent_by_model) < 0.006, row
        for value, theory in zip(times, parts.values()):
            assert abs(value - 1e3 * theory) < 0.006, (row, parts)
        assert abs(efficiency - 100 * scaling_model.efficiency(points, 22)) < 0.6, row


def test_absorbing_layers():
    # dashpots: pressure and shear wave, and energy (benchmark S3)
    for shear, angle, p, s, energy in ((False, 30, .01604, .00895, .0003), (False, 45, .01384, .07090, .0039),
                                       (False, 60, .13397, .13397, .0359), (False, 80, .56165, .10486, .3455),
                                       (True, 20, .02122, .08757, .0083), (True, 30, .13397, .13397, .0359)):
        found = absorbing_layers.dashpots(shear, angle)
        assert max(abs(found - (p, s, energy))) < 6e-5, (shear, angle, found)
    page = mt.read(os.path.join(docs_scenes.PAGES, "fix_mpm_dashpot.rst"))
    rows = re.findall(r"\* - (dashpots|damping|matched)\n     - (\d+)" + 8 * r"\n     - (\.\d+)", page)
    assert len(rows) == 5
    waves = [(False, angle) for angle in (0, 30, 45, 60, 70, 80)] + [(True, 20), (True, 30)]
    for name, cells, *echoes in rows:
        for (shear, angle), echo in zip(waves, echoes):
            found = max(absorbing_layers.far_side(name, int(cells), shear, angle)[:2])
            assert abs(found - float(echo)) < 6e-4, (name, cells, shear, angle, found)


mt.main(globals())
