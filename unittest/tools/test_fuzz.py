# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: input fuzz
# timeout: 2000
"""A short run of tools/fuzz.py, and inputs that a long one has found to fail."""

import os
import re
import subprocess
import sys
import tempfile

import mpm_testing as mt

FUZZ = os.path.join(mt.ROOT, "tools", "fuzz.py")

SCENE = """
units lj
boundary p f f
atom_style mpm
neighbor 0.5 bin
region box block 0 8 0 8 0 8
create_box 2 box
fix grid all mpm 1.0
region body block 2 5 2 5 1 4
create_points 1 region body ppc 2
fix soft all mpm/material density 1.0 neohookean 50.0 0.3
timestep 0.01
"""


def fuzz(inputs, scenes, seed):
    with tempfile.TemporaryDirectory() as folder:
        result = mt.run([sys.executable, FUZZ, "--inputs", str(inputs), "--scenes", str(scenes), "--seed", str(seed),
                         "--jobs", "1", "--out", folder], timeout=1800)
    mt.ok(result)
    assert re.search(r"^%d inputs: " % inputs, result.output, re.M), result.output
    assert re.search(r"^%d scenes: %d ran" % (scenes, scenes), result.output, re.M), result.output


def test_inputs_with_mistakes_and_scenes():
    fuzz(12, 1, 1)


def test_many_inputs_with_mistakes_and_scenes():
    mt.long_case()
    fuzz(500, 40, 4)


def test_compositions():
    # few of them: another 5000 take hours
    with tempfile.TemporaryDirectory() as folder:
        result = mt.run([sys.executable, FUZZ, "--inputs", "0", "--scenes", "0", "--compositions", "6", "--seed", "1",
                         "--jobs", "1", "--out", folder], timeout=1800)
    mt.ok(result)
    assert re.search(r"^6 compositions: ", result.output, re.M), result.output


def write_program(path, command):
    with open(path, "w", encoding="ascii") as file:
        file.write("#!/bin/sh\n%s\n" % command)
    os.chmod(path, 0o755)


def test_mistakes_are_found():
    # a program that ends without a message, and numbers that are none: the tool must see both
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "lmp")
        for command, verdict in (("kill -SEGV $$", "crash"), ("exit 3", "crash"), ("echo 1 nan 2", "nan"),
                                 ("while :; do :; done", "hang"), ("echo 'ERROR: no'; exit 1", "error"),
                                 ("echo 1 nan 2; echo 'WARNING: 1 point is not finite'", "ran"),
                                 ("echo 'FUZZ: 7 points are too many'", "large"),
                                 ("echo 'FUZZ: 7 points are too many'; kill -SEGV $$", "crash")):
            write_program(program, command)
            result = mt.run([sys.executable, FUZZ, "--inputs", "1", "--scenes", "0", "--lmp", program, "--limit", "1",
                             "--out", os.path.join(folder, "out")], timeout=500)
            assert re.search(r"^1 inputs: 1 %s$" % verdict, result.output, re.M), command + "\n" + result.output
            assert (result.code != 0) == (verdict not in ("ran", "error", "large")), result.output


def test_a_run_that_is_stopped_goes_on():
    # the program waits for ever in its fourth run, until it is told not to
    with tempfile.TemporaryDirectory() as folder:
        program, calls, out = (os.path.join(folder, name) for name in ("lmp", "calls", "out"))
        command = [sys.executable, FUZZ, "--inputs", "6", "--scenes", "0", "--jobs", "1", "--lmp", program, "--limit",
                   "100", "--every", "0", "--seed", "5", "--out", out]
        ends = "echo 'ERROR: no'; exit 1"
        write_program(program, 'echo >> "%s"; if [ ! -e "%s.free" ] && [ $(wc -l < "%s") -gt 3 ]; then\n'
                      "  echo waits; sleep 1000\nfi\n%s" % (calls, calls, calls, ends))
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
            shown = [process.stdout.readline() for _ in range(3)]
            process.terminate()
            rest = process.stdout.read()
        assert re.match("3 of 6 inputs done, 3 ended in an error, 0 failures", shown[2]), shown + [rest]
        assert "3 inputs: 3 error\n3 were not run" in rest and process.returncode == 0, rest

        with open(calls + ".free", "w", encoding="ascii"):
            pass
        result = mt.run(command + ["--go-on"], timeout=100)
        assert result.code == 0 and "\n6 inputs: 6 error\n0 failures" in result.output, result.output
        with open(calls, encoding="ascii") as file:
            assert 6 <= len(file.readlines()) <= 7    # a fourth run may have begun before the signal

        write_program(program, "echo another; " + ends)
        result = mt.run(command + ["--go-on"], timeout=100)
        assert result.code != 0 and "another executable" in result.output, result.output


def test_inputs_with_many_points_are_stopped():
    with tempfile.TemporaryDirectory() as folder:
        result = mt.run([sys.executable, FUZZ, "--inputs", "12", "--scenes", "0", "--points", "1", "--jobs", "1",
                         "--limit", "100", "--out", folder], timeout=500)
    mt.ok(result)
    assert re.search(r"^12 inputs: .*[1-9]\d* large", result.output, re.M), result.output


def error_of(text):
    result = mt.lammps_once(SCENE + text)
    assert result.code == 1 and "ERROR" in result.output, result.tail()
    return result.output


def test_errors_of_dumps_point_to_a_word_of_their_own():
    # LAMMPS looked for the word beyond the end of the command of the input, which has fewer
    output = error_of("dump d all mpm/vtk 5 points.*.vtp stress F c_gone[*]\n")
    assert "Invalid attribute c_gone[*]" in output, output
    for command, wrong in (("write_dump all mpm/vtk p.vtp velocity stress F element", "element"),
                           ("write_dump all mpm/grid/vtk n.vtu grid mass velocity foo", "foo")):
        lines = error_of(command + "\n").splitlines()
        pointer = next((k for k, line in enumerate(lines) if re.match(r"^ +\^+ *$", line)), None)
        if pointer:    # of LAMMPS that has one
            shown = lines[pointer - 1][lines[pointer].index("^"):]
            assert shown.split()[0] == wrong, "\n".join(lines[-4:])


mt.main(globals())
