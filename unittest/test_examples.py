# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: examples
# timeout: 2400
"""Every example runs to its end without a warning, makes its pictures, and gives the numbers of
its reference log (log.*.g++.1) where there is one; two processes give the numbers of one."""

import glob
import math
import os
import re
import shutil
import struct
import tempfile
import zlib

import mpm_testing as mt

EXAMPLES = os.path.join(mt.ROOT, "examples")
SECONDS = 400    # for one run, on a busy machine

# node spacing times this, where the default one is for a nicer picture or takes too long
COARSER = {"taylor-bar": 2.0, "spall": 2.0, "cook-membrane": 2.0, "hypervelocity": 2.0, "ring-collision": 2.0, "spinning-disk": 2.0,
           "taylor-bar-total": 1.6, "taylor-bar-axisymmetric": 2.0, "ball-in-sand": 1.6}

# steps, where a part of the run will do
FEWER_STEPS = {"grains-on-block": 1000, "impact-on-crystal": 1000, "vortex": 110, "ring-on-block": 1200, "hopper": 1500,
               "boulders-in-debris": 600, "tyre-on-gravel": 500,
               "elastic-gate": 3000, "elastic-plate": 3000, "settling": 600}

# have tests of their own, as they must be built first
BUILT_FIRST = ["own-material", "own-physics"]

# what LAMMPS says of every hybrid style, and of what is set here before each run
ALLOWED = ["Per-atom field rmass is used in multiple sub-styles", "previous thermo_modify settings will be lost"]

# of the range of a column
REFERENCE_TOLERANCE = 0.02     # another machine, compiler or version
PROCESSES_TOLERANCE = 1.0e-5   # collisions amplify round-off, 1e-7 in hot crystals: a decision that hangs on it shows

UNIMPORTANT = ["CPU", "S/CPU", "CPULeft", "Part"]


def inputs():
    return sorted(path for path in glob.glob(os.path.join(EXAMPLES, "*", "in.*"))
                  if os.path.basename(os.path.dirname(path)) not in BUILT_FIRST)


def read(path):
    with open(path, errors="replace") as file:
        return re.sub(r"&[ \t]*\n", " ", file.read())


def coarse_arguments(path):
    name = os.path.basename(os.path.dirname(path))
    factor = COARSER.get(name, 1.0)
    h = re.search(r"^variable\s+h\s+index\s+(\S+)", read(path), re.M)
    if factor == 1.0 or not h:
        return []
    return ["-v", "h", "%g" % (float(h.group(1)) * factor)]


class Example:
    """One input, run in a temporary copy of its folder."""

    def __init__(self, path, processes=0):
        self.path, self.text = path, read(path)
        source = os.path.dirname(path)
        self.folder = tempfile.mkdtemp(prefix="mpm_example_")
        for name in os.listdir(source):
            if not re.search(r"\.(png|vt[pu]|pvd)$|^log\.", name):
                shutil.copy(os.path.join(source, name), self.folder)
        steps = FEWER_STEPS.get(os.path.basename(source))
        text = re.sub(r"^run\s.*", "run %d" % steps, self.text, flags=re.M) if steps else self.text
        with open(os.path.join(self.folder, os.path.basename(path)), "w") as file:
            file.write(re.sub(r"^run\s", "thermo_modify format float %.15g\nrun ", text, flags=re.M))
        arguments = coarse_arguments(path)
        self.result = mt.lammps(self.folder, file=os.path.basename(path), arguments=arguments,
                                processes=processes, timeout=SECONDS)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder)

    def files(self, pattern):
        pattern = pattern.replace("${outdir}", ".")
        return sorted(glob.glob(os.path.join(self.folder, pattern)))


def picture_colors(path):
    """Number of different pixels of a PNG, or why it is none."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        return "no PNG"
    at, packed, width, height, channels = 8, b"", 0, 0, 0
    while at + 8 <= len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", chunk[:10])
            channels = {0: 1, 2: 3, 6: 4}.get(color, 0)
        elif kind == b"IDAT":
            packed += chunk
        at += 12 + size
    if not channels or not packed:
        return "no image data"
    rows = zlib.decompress(packed)
    stride = width * channels + 1
    if len(rows) < height * stride:
        return "truncated"
    # the filtered bytes of a uniform picture are zero but for its first pixel
    return len(set(rows[k * stride + 1:(k + 1) * stride] for k in range(height)))


def check_run(example):
    result = example.result
    assert result.code is not None, "more than %d s: make it coarser in COARSER" % SECONDS
    assert result.code == 0, result.tail()
    unexpected = [line for line in mt.warnings(result.output)
                  if not any(text in line for text in ALLOWED)]
    assert not unexpected, "\n".join(unexpected)
    tables = mt.thermo(result.output)
    assert tables, result.tail()
    for names, rows in tables:
        for row in rows:
            for name, value in zip(names, row):
                assert math.isfinite(float(value)), "%s = %s" % (name, value)


def check_files(example):
    tables = re.findall(r"^mpm_point\s+(\S+)", example.text, re.M)
    for name in tables:
        assert example.files(name), name
    if tables:
        return
    pictures = re.findall(r"^dump\s+\S+\s+\S+\s+image\s+(?:\d+|\$\(.*?\))\s+(\S+)", example.text, re.M)
    assert pictures, "no dump image in " + example.path
    for pattern in pictures:
        files = example.files(pattern)
        assert len(files) >= 2, "%s: %s" % (pattern, files)
        for name in files:
            colors = picture_colors(name)
            assert isinstance(colors, int) and colors > 10, "%s: %s" % (name, colors)
    for pattern in re.findall(r"^dump\s+\S+\s+\S+\s+mpm/\S+\s+\d+\s+(\S+)", example.text, re.M):
        assert len(example.files(pattern)) >= 2, pattern
    for pattern in re.findall(r"^write_dump\s+\S+\s+\S+\s+(\S+)", example.text, re.M):
        assert example.files(pattern), pattern


def compare(found, expected, tolerance, what, all_rows=False):
    """Last or all rows of all tables, each column relative to its range of values; returns the largest difference."""
    a, b = mt.thermo(found), mt.thermo(expected)
    most = 0.0
    assert len(a) == len(b), "%s: %d runs, not %d" % (what, len(a), len(b))
    for (names, rows), (other_names, other_rows) in zip(a, b):
        assert names == other_names, "%s: columns %s, not %s" % (what, names, other_names)
        assert not all_rows or len(rows) == len(other_rows), "%s: %d rows, not %d" % (what, len(rows), len(other_rows))
        for k, name in enumerate(names):
            if name in UNIMPORTANT or name in ("Step", "Time", "Dt"):
                continue
            values = [float(row[k]) for row in other_rows]
            largest = max(map(abs, values))
            if largest < 1.0e-14:    # nothing but rounding errors
                continue
            scale = max(max(values) - min(values), 1.0e-3 * largest)
            for row, value in zip(rows if all_rows else rows[-1:], values if all_rows else values[-1:]):
                difference = abs(float(row[k]) - value) / scale
                assert difference <= tolerance, "%s: at step %s, %s is %s, not %.15g: %.2g of its range" % (
                    what, row[names.index("Step")], name, row[k], value, difference)
                most = max(most, difference)
    return most


def reference(path):
    logs = sorted(glob.glob(os.path.join(os.path.dirname(path), "log.*.g++.1")))
    return logs[-1] if logs else None


def points_made(output):
    return re.findall(r"Created (\d+) (?:material points|atoms)", output)


def make_test(path):
    name = os.path.basename(path)[3:].replace("-", "_")

    def one_process():
        with Example(path) as example:
            check_run(example)
            check_files(example)
            log = reference(path)
            shortened = os.path.basename(os.path.dirname(path)) in FEWER_STEPS
            output = example.result.output
            if log and not shortened and points_made(read(log)) == points_made(output):
                compare(output, read(log), REFERENCE_TOLERANCE, log)
            outputs[path] = example.result

    def two_processes():
        if path not in outputs:
            raise mt.Skip("failed with one process")
        with Example(path, processes=2) as example:
            check_run(example)
            most = compare(example.result.output, outputs[path].output, PROCESSES_TOLERANCE, name, all_rows=True)
            print("largest difference: %.1e of the range of a column" % most)

    return {"test_" + name: one_process, "test_" + name + "_with_two_processes": two_processes}


outputs = {}


def test_there_are_examples():
    assert len(inputs()) >= 5, inputs()


def test_logs_name_no_folders_of_a_machine():
    wrong = [path + ": " + line
             for path in glob.glob(os.path.join(EXAMPLES, "*", "log.*"))
             for line in read(path).splitlines() if re.search(r"(?<![\w.*/-])/\w+/\w", line)]
    assert not wrong, "\n".join(wrong)


for _path in inputs():
    globals().update(make_test(_path))

mt.main(globals())
