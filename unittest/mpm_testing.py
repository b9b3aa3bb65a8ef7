# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Tests in Python: running LAMMPS, reading its thermo output, and a report like GoogleTest's.

A test file defines functions test_*() and ends with mpm_testing.main(globals()).
"""

import ast
import atexit
import json
import os
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback

ROOT = os.environ.get("MPM_ROOT", os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LMP = os.environ.get("MPM_LMP", os.path.join(ROOT, "build", "lmp"))


# of a file with a line "# parts:", each part is a test of ctest: --part=K, 0 for all of them
PART = int(([word[7:] for word in sys.argv[1:] if word.startswith("--part=")] or [0])[0])


class Skip(Exception):
    """Raised by a test that cannot run here."""


QUICK = "MPM_QUICK" in os.environ    # tools/test.sh without arguments leaves out what takes long


def long_case():
    """Begins a test that takes long."""
    if QUICK:
        raise Skip("a long one: tools/test.sh all")


class Result:
    """Exit code (negative: killed by a signal), output and time of a command."""

    def __init__(self, code, output, seconds):
        self.code, self.output, self.seconds = code, output, seconds

    def tail(self, lines=25):
        return "\n".join(self.output.splitlines()[-lines:])


def run(command, folder=".", timeout=100, environment=None):
    """timeout: seconds of processor time of each process, so that a busy machine changes nothing; the code is None
    after that"""
    env = dict(os.environ)
    env.update(environment or {})
    timeout *= int(env.get("MPM_SLOWER", 1))
    start = time.time()

    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (timeout, resource.getrlimit(resource.RLIMIT_CPU)[1]))

    process = subprocess.Popen(command, cwd=folder, env=env, stdin=subprocess.DEVNULL, preexec_fn=limit,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        output, _ = process.communicate(timeout=30 * timeout)    # for what sleeps for ever
        code = process.returncode if process.returncode != -signal.SIGXCPU else None
    except subprocess.TimeoutExpired:
        process.kill()
        output, _ = process.communicate()
        code = None
    return Result(code, output.decode(errors="replace"), time.time() - start)


def lammps(folder, text=None, file="in.test", arguments=(), processes=0, executable=LMP, **options):
    """Run an input, given as text or as a file in folder; processes 0: without mpirun."""
    if text is not None:
        with open(os.path.join(folder, file), "w") as out:
            out.write(text)
    command = [executable, "-in", file, "-log", "log.lammps", "-nocite"] + list(arguments)
    if processes:
        mpiexec = shlex.split(os.environ.get("MPM_MPIEXEC", "mpirun -np"))
        command = mpiexec + [str(processes)] + command
    return run(command, folder, **options)


def ok(result):
    """The result of a command that has gone well."""
    assert result.code == 0, result.tail()
    return result


def lammps_once(text, **options):
    """Run an input in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        return lammps(folder, text, **options)


def scratch_folder():
    """A folder that is there until the tests of the file have ended."""
    folder = tempfile.mkdtemp(prefix="mpm_test_")
    atexit.register(shutil.rmtree, folder)
    return folder


def build_example(name, folder, *settings):
    """A copy of an example that must be built first, built without warnings."""
    source = os.path.join(ROOT, "examples", name)
    for file in os.listdir(source):
        if os.path.isfile(os.path.join(source, file)):
            shutil.copy(os.path.join(source, file), folder)
    settings += ("MPM_DIR=" + os.path.join(ROOT, "src", "MPM"),)
    ok(run(["cmake", "-S", ".", "-B", "build"] + [word for s in settings for word in ("-D", s)], folder))
    result = run(["cmake", "--build", "build"], folder)
    assert result.code == 0 and "warning" not in result.output, result.output


def lammps_sources():
    """The source trees of the LAMMPS that is tested, mostly one."""
    cache, trees = os.path.join(os.path.dirname(LMP), "CMakeCache.txt"), []
    for key in ("LAMMPS_BUILD_DIR", "LAMMPS_SOURCE_DIR"):
        found = os.path.exists(cache) and re.search(r"^%s:\w+=(\S+)" % key, read(cache), re.M)
        if found:
            export = os.path.join(found.group(1), "mpm_lammps.cmake")
            trees.append(re.search(r'set\(LAMMPS_DIR "(.*?)"\)', read(export)).group(1)
                         if os.path.exists(export) else found.group(1))
    return trees


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def table(path):
    """Rows of a table of numbers with the names of its columns in the first line."""
    lines = [line.split() for line in read(path).splitlines() if not line.startswith("#")]
    return [dict(zip(lines[0], map(float, line))) for line in lines[1:]]


def thermo(output):
    """Tables of thermo output, one for each run: list of (column names, rows of text)."""
    tables, rows, names = [], None, []
    for line in output.splitlines():
        words = line.split()
        if words[:1] == ["Step"] or (words and "Step" in words and rows is None):
            names, rows = words, []
            tables.append((names, rows))
        elif line.startswith("Loop time"):
            rows = None
        elif (rows is not None and len(words) == len(names) and
              all(re.match(r"[-+]?(\d|nan|inf)", word) for word in words)):
            rows.append(words)
    return tables


def warnings(output):
    return [line for line in output.splitlines() if line.startswith("WARNING")]


def processor_time():
    """of this process and those that it has run"""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


BOUNDS = os.environ.get("MPM_BOUNDS")    # folder of what tools/bounds.py reads


def below(line, text, value, bound, equal):
    """value < bound, or <=, recorded as *bounds/gtest/gtest.h* does for tests in C++."""
    if all(isinstance(x, float) for x in (value, bound)) and value >= 0:
        with open(os.path.join(BOUNDS, "%d.txt" % os.getpid()), "a") as out:
            print(os.path.abspath(sys.argv[0]), line, "", value, bound, 0, 1, text, sep="\t", file=out)
    return value <= bound if equal else value < bound


class Recorder(ast.NodeTransformer):
    """Calls below() for comparisons."""

    def visit_Compare(self, node):
        if len(node.ops) > 1 or not isinstance(node.ops[0], (ast.Lt, ast.LtE)):
            return node
        bound = node.comparators[0]
        facts = [node.lineno, ast.unparse(bound)]
        equal = ast.Constant(isinstance(node.ops[0], ast.LtE))
        call = ast.Call(ast.Name("_below", ast.Load()), [*map(ast.Constant, facts), node.left, bound, equal], [])
        return ast.fix_missing_locations(ast.copy_location(call, node))


def record_bounds(scope):
    """The tests again, with recorded assertions."""
    with open(sys.argv[0]) as source:
        tree = ast.parse(source.read())
    for node in ast.walk(tree):
        if isinstance(node, ast.Assert):
            node.test = Recorder().visit(node.test)
    exec(compile(tree, sys.argv[0], "exec"), dict(scope, _below=below))


def main(scope):
    """Run the tests in order of definition, or those named on the command line."""
    if BOUNDS and "_below" not in scope:
        record_bounds(scope)
    tests = [(name, f) for name, f in scope.items() if name.startswith("test_") and callable(f)]
    chosen = [word for word in sys.argv[1:] if not word.startswith("--")]
    if chosen:
        tests = [(name, f) for name, f in tests if name in chosen]
    cases, failed = [], 0
    for name, function in tests:
        case = {"name": name, "status": "RUN", "result": "COMPLETED"}
        print("[ RUN      ]", name, flush=True)
        start, used = time.time(), processor_time()
        try:
            function()
            word = "      OK"
        except Skip as reason:
            print(reason)
            case["result"] = "SKIPPED"
            word = " SKIPPED"
        except Exception:
            text = traceback.format_exc()
            print(text)
            case["failures"] = [{"failure": text}]
            failed += 1
            word = " FAILED "
        print("[ %s ] %s (%.1f s)" % (word, name, time.time() - start), flush=True)
        case["seconds"] = processor_time() - used
        cases.append(case)
    where = os.environ.get("GTEST_OUTPUT", "")
    if where.startswith("json:"):
        with open(where[5:], "w") as out:
            json.dump({"testsuites": [{"name": sys.argv[0], "testsuite": cases}]}, out)
    if not cases:
        print("no tests")
    sys.exit(1 if failed or not cases else 0)
