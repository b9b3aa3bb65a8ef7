# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: examples
# parts: 1 1 2
# timeout: 1200
"""Every example runs to its end without a warning, makes its pictures, and gives the numbers of
its reference log (log.*.g++.1) where there is one; two processes give the numbers of one.

Parts 1 and 2 are the runs of half of the examples each, part 3 the runs with two processes, of which
half of the steps will do."""

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
    """One input, run in a temporary copy of its folder; steps: instead of those in its only command run."""

    def __init__(self, path, processes=0, steps=None):
        self.path, self.text = path, read(path)
        source = os.path.dirname(path)
        self.folder = tempfile.mkdtemp(prefix="mpm_example_")
        for name in os.listdir(source):
            if not re.search(r"\.(png|vt[pu]|pvd)$|^log\.", name):
                shutil.copy(os.path.join(source, name), self.folder)
        steps = steps or FEWER_STEPS.get(os.path.basename(source))
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
    mt.ok(result)
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


def compare(found, expected, tolerance, what, which="last"):
    """The last rows of all tables, all rows, or those until the found run ends ("first"), of which there is one after
    its start; each column relative to its range of values. Returns the largest difference."""
    a, b = mt.thermo(found), mt.thermo(expected)
    most = 0.0
    assert len(a) == len(b), "%s: %d runs, not %d" % (what, len(a), len(b))
    for (names, rows), (other_names, other_rows) in zip(a, b):
        assert names == other_names, "%s: columns %s, not %s" % (what, names, other_names)
        pairs = [(rows[-1], other_rows[-1])]
        if which != "last":
            step = names.index("Step")
            others = {row[step]: row for row in other_rows}
            pairs = [(row, others[row[step]]) for row in rows if row[step] in others]
            wanted = 2 if which == "first" else len(other_rows)
            assert len(pairs) == len(rows) >= wanted, \
                "%s: %d rows, %d in the other run, %d of the same steps" % (what, len(rows), len(other_rows), len(pairs))
        for k, name in enumerate(names):
            if name in UNIMPORTANT or name in ("Step", "Time", "Dt"):
                continue
            values = [float(row[k]) for row in other_rows]
            largest = max(map(abs, values))
            if largest < 1.0e-14:    # nothing but rounding errors
                continue
            scale = max(max(values) - min(values), 1.0e-3 * largest)
            for row, other in pairs:
                difference = abs(float(row[k]) - float(other[k])) / scale
                assert difference <= tolerance, "%s: at step %s, %s is %s, not %s: %.2g of its range" % (
                    what, row[names.index("Step")], name, row[k], other[k], difference)
                most = max(most, difference)
    return most


def reference(path):
    logs = sorted(glob.glob(os.path.join(os.path.dirname(path), "log.*.g++.1")))
    return logs[-1] if logs else None


def points_made(output):
    return re.findall(r"Created (\d+) (?:material points|atoms)", output)


def half_of_the_steps(path, output):
    """For a run with two processes: those of the first row after half of the steps that one process took, so that
    the end is compared; None where that is not clear."""
    if len(re.findall(r"^run\s", read(path), re.M)) != 1:
        return None
    names, rows = mt.thermo(output)[-1]
    steps = [int(row[names.index("Step")]) for row in rows]
    return next(step for step in steps if 2 * step >= steps[-1])


def output_of(path):
    """Where the output with one process is kept for part 3, in the folder of the build."""
    return "example-%s.out" % os.path.basename(path)[3:]


def with_one_process(path):
    """That output, from part 1 or 2, or from a run now where it is older than what it comes from."""
    kept = output_of(path)
    if not os.path.exists(kept) or any(os.path.getmtime(kept) < os.path.getmtime(x) for x in (path, mt.LMP, __file__)):
        with Example(path) as example:
            check_run(example)
            return example.result.output
    with open(kept) as file:
        return file.read()


def make_tests(path, part):
    name = os.path.basename(path)[3:].replace("-", "_")

    def one_process():
        if os.path.exists(output_of(path)):
            os.remove(output_of(path))
        with Example(path) as example:
            check_run(example)
            check_files(example)
            log = reference(path)
            shortened = os.path.basename(os.path.dirname(path)) in FEWER_STEPS
            output = example.result.output
            if log and not shortened and points_made(read(log)) == points_made(output):
                compare(output, read(log), REFERENCE_TOLERANCE, log)
            with open(output_of(path), "w") as file:
                file.write(output)

    def two_processes():
        expected = with_one_process(path)
        steps = half_of_the_steps(path, expected)
        with Example(path, processes=2, steps=steps) as example:
            check_run(example)
            most = compare(example.result.output, expected, PROCESSES_TOLERANCE, name, "first" if steps else "all")
            print("largest difference: %.1e of the range of a column" % most)

    for which, suffix, test in ((part, "", one_process), (3, "_with_two_processes", two_processes)):
        if mt.PART in (0, which):
            yield "test_" + name + suffix, test


def test_there_are_examples():
    assert len(inputs()) >= 5, inputs()


def test_logs_name_no_folders_of_a_machine():
    wrong = [path + ": " + line
             for path in glob.glob(os.path.join(EXAMPLES, "*", "log.*"))
             for line in read(path).splitlines() if re.search(r"(?<![\w.*/-])/\w+/\w", line)]
    assert not wrong, "\n".join(wrong)


for _k, _path in enumerate(inputs()):
    globals().update(make_tests(_path, 1 + _k % 2))

mt.main(globals())
