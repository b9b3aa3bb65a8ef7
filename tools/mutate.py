#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Which mistakes in the source do the tests see?

usage: mutate.py [options] [PATTERN ...]   of names or files of mutants, default: all

Each mutant of the list is a small mistake: it is compiled in a copy of src/MPM, linked to the test
programs that ought to see it, and killed when one of these fails.  Only what depends on its file
is compiled; the build tree itself (MPM_BUILD_DIR, default ./build) is only brought up to date, by
tools/build.sh.  Kernels and laws are compiled and run for the baseline instruction set alone.

  --list FILE    mutants (default: tools/mutants.txt, which tells its format)
  --random N     instead of those of the list: N mistakes anywhere in src/MPM, all of them compiled once in a copy of the
                 source tree, where each is a choice that is made while the program runs (mutants_random.py).  One run of
                 the suite of tools/test.sh tells which cases reach which mistake; these are tried, the short ones
                 first, until one fails.  Those in mutants_equivalent.txt, which change nothing that one can see, are named
  --tree FOLDER  the copy of --random (default: BUILD/random)
  --jobs N       mutants at a time (default: MPM_JOBS, or all cores)
  --sample N     only so many of them, drawn at random
  --seed N       for another draw, of --sample and --random (default: 0)
  --check        only look whether the list fits the source and the tests, without a build tree
  --no-build     the test programs are up to date; with --random also what is known of their cases
  --keep         leave what was compiled in BUILD/mutants

Ends with a table and the share of mutants that were killed; the exit status is 1 unless it is all.
"""

import argparse
import concurrent.futures
import fnmatch
import json
import math
import os
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import mutants_random

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SOURCES = os.path.join(ROOT, "src", "MPM")
BUILD = os.path.abspath(os.environ.get("MPM_BUILD_DIR") or
                        os.path.join(ROOT, "build"))
LIBRARY = os.path.join(BUILD, "python", "lammps", "liblammps.so")    # target mpm_python
EQUIVALENTS = os.path.join(ROOT, "tools", "mutants_equivalent.txt")
KILLED, SURVIVED, BROKEN, STALE, EQUIVALENT = "killed", "survived", "does not compile", "stale", "equivalent"


class Mutant:
    """name, file in src/MPM, old and new text, and the tests that ought to see it: (test, filter)"""

    def __init__(self, name):
        self.name, self.file, self.old, self.new, self.tests, self.told = name, "", [], [], [], ""

    def source(self):
        """the mutated file, or None when the old text is not there exactly once"""
        with open(os.path.join(SOURCES, self.file)) as file:
            text = file.read()
        words = r"\s+".join(re.escape(word) for word in " ".join(self.old).split())
        found = list(re.finditer(words, text))
        if len(found) != 1:
            return None
        return text[:found[0].start()] + "\n".join(self.new) + text[found[0].end():]


def read_list(path):
    mutants = []
    with open(path) as file:
        for number, line in enumerate(file, 1):
            key, _, value = line.rstrip("\n").partition(" ")
            if key == "mutant":
                mutants.append(Mutant(value.strip()))
            elif not key or key.startswith("#"):
                continue
            elif not mutants or key not in ("in", "-", "+", "test"):
                sys.exit("%s:%d: not understood: %s" % (path, number, line.rstrip()))
            elif key == "in":
                mutants[-1].file = value.strip()
            elif key == "test":
                test, _, names = value.strip().partition(" ")
                mutants[-1].tests.append((test, names.strip() or "*"))
            else:
                (mutants[-1].old if key == "-" else mutants[-1].new).append(value.strip())
    names = [mutant.name for mutant in mutants]
    for mutant in mutants:
        if not (mutant.file and mutant.old and mutant.tests) or names.count(mutant.name) > 1:
            sys.exit("%s: mutant %s is incomplete, or there twice" % (path, mutant.name))
    return mutants


def program(test):
    """test_contact.np3 -> test_contact"""
    return test.partition(".")[0]


def not_in_test(test, names):
    """words of a filter that the source of the test does not have, or the name of that source"""
    path = [os.path.join(folder, program(test) + ".cpp") for folder, _, files in os.walk(os.path.join(ROOT, "unittest"))
            if program(test) + ".cpp" in files]
    if not path:
        return [program(test) + ".cpp"]
    with open(path[0]) as file:
        text = file.read()
    processes = re.search(r"^// mpi: (.*)", text, re.M)
    known = [program(test) + (".np" + n if n != "0" else "") for n in (processes.group(1).split() if processes else ["0"])]
    if test not in known:
        return [test]
    return [word for word in re.findall(r"[A-Za-z]\w{3,}", names) if word not in text]


# ---------------------------------------------------------------- how things are compiled and run

def tests_of(build):
    """by name what ctest knows of them"""
    shown = quiet(["ctest", "--show-only=json-v1"], cwd=build)
    return {test["name"]: test for test in json.loads(shown)["tests"]}


def property_of(test, name):
    return next((entry["value"] for entry in test["properties"] if entry["name"] == name), [])


class BuildTree:
    """commands of the build tree: objects, test programs, tests"""

    def __init__(self, programs, build):
        if build:
            quiet([os.path.join(ROOT, "tools", "build.sh")] + programs)
        database = os.path.join(BUILD, "compile_commands.json")
        if not os.path.exists(database):
            quiet(["cmake", "-D", "CMAKE_EXPORT_COMPILE_COMMANDS=on", BUILD])
        with open(database) as file:
            entries = json.load(file)
        self.compile, self.needs = {}, {}    # by object: words and folder; files of src/MPM
        for entry in entries:
            words = shlex.split(entry["command"])
            name = os.path.normpath(os.path.join(entry["directory"], words[words.index("-o") + 1]))
            self.compile[name] = (words, entry["directory"])
        self.link = {name: self.read_link("unittest", name) for name in programs}
        # most programs have the package in a shared library, which is linked again instead of them
        library = os.path.join(BUILD, "CMakeFiles", "mpm_python.dir", "link.txt")
        self.library = self.read_link("", "mpm_python") if os.path.exists(library) else []
        self.tests = tests_of(BUILD)

    @staticmethod
    def read_link(folder, name):
        """command of a link, with the paths of objects and libraries of the build tree in full"""
        folder = os.path.join(BUILD, folder)
        with open(os.path.join(folder, "CMakeFiles", name + ".dir", "link.txt")) as file:
            words = shlex.split(file.readline())
        return [os.path.normpath(os.path.join(folder, word)) if re.search(r"\.(o|so|a)$", word) and word[0] != "-" else word
                for word in words]

    def parts(self, name):
        """objects that a program is made of"""
        words = self.link[name] + (self.library if LIBRARY in self.link[name] else [])
        return [word for word in words if word.endswith(".o")]

    def depends(self, name, file):
        """does this object contain the file? Of the instruction sets the baseline is enough"""
        words, folder = self.compile.get(name, ((), ""))
        if not words or any("MPM_ISA=v" in word for word in words):
            return False
        if name not in self.needs:    # the compiler's list: paths may be relative
            with open(name + ".d") as rules:
                self.needs[name] = {os.path.normpath(os.path.join(folder, word))
                                    for word in rules.read().split() if "MPM" in word}
        return os.path.join(SOURCES, file) in self.needs[name]


def quiet(command, **options):
    """output of a command, shown only when it fails"""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, **options)
    if done.returncode:
        sys.exit(done.stdout + "\nfailed: " + " ".join(command))
    return done.stdout


def compile_object(tree, name, sources, out):
    """one object, with the sources of a folder in place of src/MPM"""
    words, folder = tree.compile[name]
    command, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-MT", "-MF"):
            skip = True
        elif word != "-MD":
            command.append(word.replace(SOURCES, sources))
    return subprocess.run(command + ["-g0", "-w", "-o", out], cwd=folder, check=False,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def link(words, objects, out):
    command, after_o = [], False
    for word in words:
        command.append(out if after_o else objects.get(word, word))
        after_o = word == "-o"
    if shutil.which("ld.lld"):
        command.insert(1, "-fuse-ld=lld")
    return subprocess.run(command, cwd=BUILD, check=False,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def link_program(tree, name, objects, folder):
    """a program, and the library when the program has it and it has changed; what is linked goes to a folder"""
    changed = dict(objects)
    words = list(tree.link[name])
    if LIBRARY in words:
        mine = os.path.join(folder, os.path.basename(LIBRARY))
        if not set(tree.library).isdisjoint(objects):
            if not os.path.exists(mine) and not link(tree.library, objects, mine):
                return False
            changed[LIBRARY] = mine
            words = [word.replace(os.path.dirname(LIBRARY), folder) if "-rpath" in word else word for word in words]
    return link(words, changed, os.path.join(folder, name))


def run_test(tree, test, names, executable, folder, limit):
    """exit status, None when it took too long, and output"""
    known = tree.tests[test]
    command = [executable if os.path.basename(word) == program(test) else word
               for word in known["command"]]
    return run_command(known, command + cases_of_program(test, names), folder, limit)


def cases_of_program(test, names):
    """arguments for these cases only"""
    # with several processes the others would wait for one that fails
    return ["--gtest_filter=" + names] + ([] if ".np" in test and not test.endswith(".np1") else ["--gtest_fail_fast"])


def run_command(known, command, folder, limit, **variables):
    """exit status, None when it took too long, and output; the limit is one of processor time for each
    process, so that a busy machine changes nothing, and thirty times as long for what sleeps"""
    environment = dict(os.environ, MPM_ISA="baseline")
    environment.update(word.split("=", 1) for word in property_of(known, "ENVIRONMENT"))
    environment.pop("GTEST_OUTPUT", None)
    environment.update(variables)
    seconds = max(1, math.ceil(limit))
    process = subprocess.Popen(["sh", "-c", 'ulimit -t %d; exec "$@"' % seconds, "sh"] + command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               start_new_session=True)
    try:
        output, _ = process.communicate(timeout=30 * seconds)
        if process.returncode in (-signal.SIGXCPU, 128 + signal.SIGXCPU):
            return None, ""
        return process.returncode, output.decode(errors="replace")
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return None, ""


# ---------------------------------------------------------------- mutants

def check_tests(tree, wanted, folder, pool):
    """time that each test takes on the source as it is, where it must pass; kept until the program changes"""
    path = os.path.join(folder, "passed.json")
    passed = {}
    if os.path.exists(path):
        with open(path) as file:
            passed = json.load(file)

    def check(key):
        test, names = key
        executable = os.path.join(BUILD, "unittest", program(test))
        if os.path.exists(executable):
            before = passed.get(" ".join(key))
            if before and before[1] == os.stat(executable).st_mtime_ns:
                return before[0], ""
        if test not in tree.tests:
            return 0.0, "there is no test " + test
        if "\n  " not in quiet([executable, "--gtest_list_tests", "--gtest_filter=" + names]):
            return 0.0, "%s has no case %s" % key
        start = time.time()
        with tempfile.TemporaryDirectory(dir=folder) as own:    # some cases write files
            status, output = run_test(tree, test, names, executable, own, 600)
        if status != 0 or not re.search(r"\[  PASSED  \] [1-9]", output):
            return 0.0, output + "\n%s %s fails or is skipped without any mutant" % key
        passed[" ".join(key)] = time.time() - start, os.stat(executable).st_mtime_ns
        return time.time() - start, ""

    found = list(pool.map(check, wanted))
    with open(path, "w") as file:
        json.dump(passed, file, indent=1)
    wrong = [text for _, text in found if text]
    if wrong:
        sys.exit("\n".join(wrong))
    return {key: seconds for key, (seconds, _) in zip(wanted, found)}


def try_mutant(tree, mutant, times, keep):
    """verdict, the test that has killed it, time"""
    start = time.time()
    folder = os.path.join(BUILD, "mutants", mutant.name)
    shutil.rmtree(folder, ignore_errors=True)

    def verdict(what, by=""):
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
        return what, by, time.time() - start

    text = mutant.source()
    if text is None:
        return verdict(STALE)
    sources = os.path.join(folder, "MPM")
    shutil.copytree(SOURCES, sources)
    with open(os.path.join(sources, mutant.file), "w") as file:
        file.write(text)

    objects, built = {}, set()
    for test, names in mutant.tests:
        name = program(test)
        if name not in built:
            for path in tree.parts(name):
                if path in objects or not tree.depends(path, mutant.file):
                    continue
                objects[path] = os.path.join(folder, "%d.o" % len(objects))
                if not compile_object(tree, path, sources, objects[path]):
                    return verdict(BROKEN)
            if not link_program(tree, name, objects, folder):
                return verdict(BROKEN)
            built.add(name)
        status, _ = run_test(tree, test, names, os.path.join(folder, name), folder,
                             30 + 10 * times[test, names])
        if status != 0:
            return verdict(KILLED, "%s %s%s" % (test, names, "" if status else " (time)"))
    return verdict(SURVIVED if objects else STALE)


def chosen(mutants, patterns):
    return [mutant for mutant in mutants if not patterns or any(
        fnmatch.fnmatch(mutant.name, pattern) or fnmatch.fnmatch(mutant.file, pattern)
        for pattern in patterns)]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        usage=argparse.SUPPRESS)
    parser.add_argument("patterns", nargs="*", metavar="PATTERN")
    parser.add_argument("--list", default=os.path.join(ROOT, "tools", "mutants.txt"))
    parser.add_argument("--jobs", type=int,
                        default=int(os.environ.get("MPM_JOBS") or os.cpu_count()))
    parser.add_argument("--random", type=int)
    parser.add_argument("--tree")
    parser.add_argument("--sample", type=int)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--no-build", action="store_true")
    parser.add_argument("--keep", action="store_true")
    options = parser.parse_args()

    if options.random:
        return run_random(options)
    mutants = chosen(read_list(options.list), options.patterns)
    if options.sample is not None and options.sample < len(mutants):
        mutants = random.Random(options.seed).sample(mutants, options.sample)
    stale = [mutant for mutant in mutants if mutant.source() is None]
    for mutant in stale:
        print("%s: the text is not exactly once in %s" % (mutant.name, mutant.file))
    if options.check or not mutants:
        for file, change in sorted(set(read_equivalents()) - mutants_random.changes(SOURCES)):
            stale.append(change)
            print("mutants_equivalent.txt: %s has no %s" % (file, change))
        lost = [(mutant, test) for mutant in mutants for test in mutant.tests if not_in_test(*test)]
        for mutant, test in lost:
            print("%s: no %s in the source of %s" % (mutant.name, ", ".join(not_in_test(*test)), test[0]))
        print("%d mutants, %d stale, %d tests that are not there" % (len(mutants), len(stale), len(lost)))
        return 1 if stale or lost or not mutants else 0

    return run(mutants, options, sorted({program(test) for mutant in mutants for test, _ in mutant.tests}))


def run(mutants, options, programs):
    tree = BuildTree(programs, not options.no_build)
    wanted = sorted({test for mutant in mutants for test in mutant.tests})
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        folder = os.path.join(BUILD, "mutants")
        os.makedirs(folder, exist_ok=True)
        times = check_tests(tree, wanted, folder, pool)
        print("%d tests pass without mutants, in %.0f s" % (len(times), sum(times.values())), flush=True)
        return report(mutants, pool.map(lambda mutant: try_mutant(tree, mutant, times, options.keep), mutants))


def report(mutants, tried):
    """the table, and the exit status"""
    wide = max(len(mutant.name) for mutant in mutants)
    results = []
    for mutant, (what, by, seconds) in zip(mutants, tried):
        results.append(what)
        print("%-*s  %-16s %5.0f s  %s" % (wide, mutant.name, what, seconds, by), flush=True)
        if what == SURVIVED and mutant.told:
            print("    " + mutant.told, flush=True)
    count = results.count(KILLED) + results.count(SURVIVED)
    print("%d of %d mutants killed (%.0f %%), %d survived, %d do not compile, %d stale" % (
        results.count(KILLED), count, 100.0 * results.count(KILLED) / max(count, 1),
        results.count(SURVIVED), results.count(BROKEN), results.count(STALE)) +
          (", %d equivalent" % results.count(EQUIVALENT) if EQUIVALENT in results else ""))
    return 0 if results.count(KILLED) + results.count(EQUIVALENT) == len(results) else 1


# ---------------------------------------------------------------- mutants at random places

NOT_OF_THE_PROGRAM = {"build", "plugin", "fuzz", "sanitize"}    # labels of tests that compile, or cannot fail by a mutant
LONGEST = 100    # seconds that the cases take that a mutant is tried with


class Case:
    """a case of a test of ctest: its seconds, and the numbers of the mutants that it reaches"""

    def __init__(self, test, name, seconds, reached):
        self.test, self.name, self.seconds, self.reached = test, name, seconds, set(reached)


def read_equivalents(path=EQUIVALENTS):
    """(file, what is changed) -> reason"""
    with open(path, encoding="utf-8") as file:
        lines = [line.rstrip("\n").split("\t") for line in file if line.strip() and not line.startswith("#")]
    for line in lines:
        if len(line) != 3:
            sys.exit("%s: not a file, a change, and a reason: %s" % (path, " ".join(line)))
    return {(file, change): reason for file, change, reason in lines}


def copy_tree(tree, changed):
    """the source tree with some other texts; a file that is as it was keeps its time"""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, stdout=subprocess.PIPE, text=True,
                            check=True).stdout.split("\n")
    for path in sorted(set(filter(None, listed)) | set(changed)):
        old, new = os.path.join(ROOT, path), os.path.join(tree, path)
        if path in changed:
            text = changed[path].encode()
        elif os.path.exists(old):
            with open(old, "rb") as file:
                text = file.read()
        else:
            continue
        if os.path.exists(new):
            with open(new, "rb") as file:
                if file.read() == text:
                    continue
        os.makedirs(os.path.dirname(new), exist_ok=True)
        with open(new, "wb") as file:
            file.write(text)
        if path not in changed:
            shutil.copymode(old, new)


def build_random(tree, options):
    """(mutants in a copy of the source tree, how many places were drawn for them)"""
    build = os.path.join(tree, "build", "quick")
    kept = os.path.join(build, "random.json")
    if options.no_build:    # the sources may be others by now
        with open(kept) as file:
            mutants = [mutants_random.RandomMutant(*entry) for entry in json.load(file)]
        return mutants, mutants[-1].number
    size = 2 * options.random
    mutants = []
    for mutant in mutants_random.draw(SOURCES, options.seed):
        if len(mutants) >= 1.1 * options.random or mutant.number >= size:
            break
        if mutant.edits and not any(
                other.file == mutant.file and other.lines[0] <= mutant.lines[1] and mutant.lines[0] <= other.lines[1]
                for other in mutants):
            mutants.append(mutant)
    environment = dict(os.environ, MPM_BUILD_DIR=build, MPM_CMAKE="-D MPM_QUICK=on", MAKEFLAGS="-k", MPM_JOBS=str(options.jobs))
    while True:
        copy_tree(tree, mutants_random.files(ROOT, mutants, size))
        done = subprocess.run([os.path.join(tree, "tools", "build.sh"), "unittests"], env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode == 0:
            break
        with open(os.path.join(build, "build.log")) as file:
            log = file.read()
        wrong = mutants_in(mutants, log)
        if not wrong:
            sys.exit(done.stdout)
        for mutant in wrong:
            print("not to be chosen while the program runs: " + mutant.told, flush=True)
        mutants = [mutant for mutant in mutants if mutant not in wrong]
    mutants = mutants[:options.random]
    with open(kept, "w") as file:
        json.dump([(mutant.name, mutant.number, mutant.file, mutant.told) for mutant in mutants], file)
    return mutants, mutants[-1].number


def mutants_in(mutants, log):
    """those that the errors of a compiler are about"""
    # what it says first is the reason of what it says then
    first = [part.partition(" error: ")[0].rpartition("\n")[2] for part in log.split("***") if " error: " in part]
    for text in ("\n".join(first), log):
        lines = {(file, int(line) - 1) for file, line in re.findall(r"src/MPM/([\w/.]+):(\d+)", text)}
        found = [mutant for mutant in mutants if any(
            file == mutant.file and mutant.lines[0] <= line <= mutant.lines[1] for file, line in lines)]
        if found:
            break
    return found


def words_of_cases(known, test, names):
    """the command for these cases of a test, by GoogleTest or in Python"""
    if any(word.endswith(".py") for word in known["command"]):
        return known["command"] + names
    return known["command"] + cases_of_program(test, ":".join(names))


def cases_of(tests, test, folder, known):
    """all cases of a test that pass without mutants; known: as an earlier call has found"""
    results, bits = os.path.join(folder, test + ".json"), os.path.join(folder, test + ".bits")
    if not (known and os.path.exists(results)):
        with open(bits, "wb") as file:
            file.write(bytes(100000))
        with tempfile.TemporaryDirectory(dir=folder) as own:
            run_command(tests[test], tests[test]["command"], own, 1200, GTEST_OUTPUT="json:" + results, MPM_REACHED=bits)
    if not os.path.exists(results):
        return []
    with open(results) as file:
        suites = json.load(file)["testsuites"]
    python = any(word.endswith(".py") for word in tests[test]["command"])
    return [Case(test, case["name"] if python else suite["name"] + "." + case["name"], float(case.get("seconds", 0.0)),
                 [int(word) for word in case.get("reached", "").split()])
            for suite in suites for case in suite["testsuite"]
            if case["result"] == "COMPLETED" and not case.get("failures")]


def try_random(tests, mutant, cases, folder, equivalents):
    """verdict, the cases that have killed it, time"""
    start = time.time()
    if mutant.place in equivalents:
        return EQUIVALENT, equivalents[mutant.place], 0.0
    cases = sorted((case for case in cases if mutant.number in case.reached), key=lambda case: case.seconds)
    seconds, tried, most = 0.0, 0, 1.0
    while tried < len(cases) and seconds < LONGEST:
        batch = {}    # of one test each, as many as take twice as long as those before, and fit into a command
        once, end = 0.0, tried + 300
        while tried < min(end, len(cases)) and (not batch or once + cases[tried].seconds < most):
            batch.setdefault(cases[tried].test, []).append(cases[tried])
            once += cases[tried].seconds
            tried += 1
        seconds, most = seconds + once, 2.0 * most
        for test, some in batch.items():
            def run(number):
                with tempfile.TemporaryDirectory(dir=folder) as own:
                    return run_command(tests[test], words_of_cases(tests[test], test, [case.name for case in some]), own,
                                       30 + 10 * sum(case.seconds for case in some), MPM_MUTANT=str(number))[0]

            status = run(mutant.number)
            # it must be the mutant, and not the order of cases, or the machine
            if status != 0 and run(0) == 0 and run(mutant.number) != 0:
                return KILLED, test + ("" if status else " (time)"), time.time() - start
    return SURVIVED, "tried %d of %d cases that reach it" % (tried, len(cases)), time.time() - start


def run_random(options):
    os.environ["MPM_QUICK"] = "1"    # as in tools/test.sh
    equivalents = read_equivalents()
    tree = os.path.abspath(options.tree or os.path.join(BUILD, "random"))
    mutants, drawn = build_random(tree, options)
    print("%d mutants of %d places are choices in one program" % (len(mutants), drawn), flush=True)
    build = os.path.join(tree, "build", "quick")
    tests = tests_of(build)
    folder = os.path.join(build, "mutants")
    os.makedirs(folder, exist_ok=True)
    wanted = []
    for name, test in tests.items():
        labels = set(property_of(test, "LABELS"))
        if "long" not in labels and not labels & NOT_OF_THE_PROGRAM and not ("docs" in labels and "examples" not in labels):
            wanted.append(name)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        cases = sum(pool.map(lambda test: cases_of(tests, test, folder, options.no_build), wanted), [])
        print("%d cases pass without mutants, in %.0f s" % (len(cases), sum(case.seconds for case in cases)), flush=True)
        mutants = chosen(mutants, options.patterns)
        return report(mutants, pool.map(lambda mutant: try_random(tests, mutant, cases, folder, equivalents), mutants))


if __name__ == "__main__":
    sys.exit(main())
