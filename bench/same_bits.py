#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Do two builds give the same bits? A hash of the state of all atoms at the end of many small scenes.

  same_bits.py --write-scenes FOLDER [--test TEST_PAIRS]     write the scenes, once
  same_bits.py LMP --scenes FOLDER --out FILE.json [--quick] [--only PATTERN] [--isa avx2,...]
               [--ranks 1,2,4] [--lammps MPM_LAMMPS.CMAKE]   run them
  same_bits.py --compare OLD.json NEW.json                   list what differs; status 1 if any does

The scenes are the inputs *.in of a folder, so that both builds run the same ones: all of
unittest/scenes/test_pairs.cpp, each with a restart in its middle, which its executable writes (--test, default:
build/unittest/test_pairs); shapes, transfers, schemes and frames on bench/in.block and in.block2d; all
laws of bench/bench_materials.cpp; the coupling of bench/in.*; and the examples, coarse and short.

Each scene is run with all instruction sets that the processor has (MPM_ISA) and on 1, 2 and 4 ranks; with
--quick only with the best one and on 1 and 2. PATTERN is a regular expression that is searched in the name of
the scene. The command state_hash is a plugin, compiled here from same_bits.cpp for the stock build of LAMMPS
that --lammps describes (default: the one of the same version under ~/.cache/lammps-mpm). Where hashes differ,
--compare shows the largest relative difference of the sums of |x|, |v| and the rest, so that round-off can be told
from more. Scenes with fix balance on more than two ranks may differ by round-off.
"""
import argparse
import concurrent.futures
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
SECONDS = 300    # for one run
# of the sums, for scenes with fix balance on more than two ranks: LAMMPS takes messages in any order there
LOOSE = 1.0e-12
SETS = ["avx512", "avx2", "baseline"]    # best one first

# examples: node spacing times this, steps of each run, and those that are left out
COARSER = {"taylor-bar": 2.0, "spall": 2.0, "cook-membrane": 2.0, "hypervelocity": 2.0, "ring-collision": 2.0,
           "spinning-disk": 2.0, "taylor-bar-total": 2.0, "taylor-bar-axisymmetric": 2.0, "ball-in-sand": 2.0}
STEPS = 100
LEFT_OUT = ["own-material", "own-physics", "point"]    # need a plugin of their own; has no atoms
DATA = (".stl", ".msh", ".obj", ".nrrd", ".pgm")

# options of fix mpm on in.block and in.block2d, those of a group in one input
BLOCKS = {
    "linear": ["shape linear transfer " + t for t in (
        "pic", "flip 0.99", "apic", "tpic", "aflip 0.99", "xpic 2", "flip 0.99 scheme musl")],
    "quadratic": ["shape quadratic transfer " + t for t in (
        "pic", "flip 0.99", "apic", "tpic", "aflip 0.99", "polypic", "xpic 2", "fmpm 2", "apic scheme usf",
        "apic scheme musl", "apic scheme usavg", "apic stress gradient", "apic locking fbar")],
    "cubic": ["shape cubic transfer " + t for t in (
        "pic", "flip 0.99", "apic", "tpic", "aflip 0.99", "polypic", "xpic 2", "fmpm 2")],
    "domains": ["shape %s transfer %s" % (s, t) for s in ("gimp", "cpgimp", "cpdi", "cpdi2")
                for t in ("flip 0.99", "apic")],
    "total": ["frame total shape %s transfer %s" % (s, t) for s in ("linear", "quadratic", "cubic", "bernstein")
              for t in ("flip 0.99", "apic")],
}

# input, steps, and variables of the coupling
COUPLING = {
    "grains": ("in.grains", 40, {"mode": "skin", "n": 12, "speed": 5.0}),
    "grains-every2": ("in.grains", 40, {"mode": "both", "n": 12, "speed": 5.0, "every": 2}),
    "immersed": ("in.immersed", 20, {"n": 10}),
    "immersed-dilute": ("in.immersed", 20, {"n": 10, "variant": "dilute"}),
    "bodies": ("in.bodies", 40, {"n": 8}),
}


def read(*path):
    with open(os.path.join(*path)) as file:
        return file.read()


def block_scene(text, options, n):
    """One body after the other, in a motion that is not uniform."""
    text = re.sub(r"^(variable\s+(n|box|steps)\s+index).*", "", text, flags=re.M)
    text = text.replace("timestep", "velocity all ramp vx 0 0.5 y 0 %d units box\ntimestep" % n)
    head = "variable n index %d\nvariable box index %d\nvariable steps index 20\n" % (n, n + 4)
    return head + "clear\n".join(re.sub(r"^variable\s+opts.*", "", text.replace("${opts}", one), flags=re.M) +
                                 "state_hash\n" for one in options)


def law_scene(laws):
    """A body of two cells for each law, all in the same fast motion; a compressed and sheared one."""
    text = "units si\nboundary f f f\natom_style mpm\nneighbor 5.0e-4 bin\n" \
        "region box block 0 %g 0 6.0e-3 0 6.0e-3\ncreate_box %d box\nfix grid all mpm 1.0e-3\n" \
        % (6.0e-3 * len(laws), len(laws))
    for k, law in enumerate(laws, 1):
        lo = 6.0e-3 * (k - 1) + 2.0e-3
        text += "region r%d block %g %g 2.0e-3 4.0e-3 2.0e-3 4.0e-3\ncreate_points %d region r%d ppc 2\n" \
            "group g%d type %d\nfix m%d g%d mpm/material %s\n" % (k, lo, lo + 2.0e-3, k, k, k, k, k, k, law)
        for c, speed in ("vx", -200), ("vy", 100):
            text += "velocity g%d ramp %s 0 %d x %g %g sum yes units box\n" % (k, c, speed, lo, lo + 2.0e-3)
    return text + "timestep 2.0e-8\nthermo 1000\nrun 40\nstate_hash\n"


def example_scene(name, text):
    text = re.sub(r"&[ \t]*\n", " ", text)
    text = re.sub(r"^(dump|dump_modify|write_dump)\s.*\n", "", text, flags=re.M)
    text = re.sub(r"^run\s+(?!0\b|\s).*", "run %d" % STEPS, text, flags=re.M)
    h = re.search(r"^variable\s+h\s+index\s+(\S+)", text, re.M)
    if h and name in COARSER:
        text = "variable h index %g\n" % (float(h.group(1)) * COARSER[name]) + text
    return text + "\nstate_hash\n"


def write_scenes(folder, test):
    folder = os.path.abspath(folder)
    os.makedirs(folder, exist_ok=True)
    subprocess.run([os.path.abspath(test), "--gtest_filter=*Agree*"], check=True, stdout=subprocess.DEVNULL,
                   env=dict(os.environ, MPM_WRITE_SCENES=folder), cwd=folder)
    scenes = {}
    for name, options in BLOCKS.items():
        scenes["block-3d-" + name] = block_scene(read(HERE, "in.block"), options, 5)
        scenes["block-2d-" + name] = block_scene(read(HERE, "in.block2d"), options, 12)
    laws = ["".join(re.findall(r'"([^"]*)"', text)) for text in
            re.findall(r'^    \{"(?!woven)\w+",((?:\s*"[^"]*")+)\},', read(HERE, "bench_materials.cpp"), re.M)]    # woven: for sheets
    for k in range(0, len(laws), 8):
        scenes["laws-%d" % (k // 8 + 1)] = law_scene(laws[k:k + 8])
    for name, (file, steps, variables) in COUPLING.items():
        head = ["variable %s index %s\n" % pair for pair in list(variables.items()) + [("steps", steps)]]
        scenes["coupling-" + name] = "".join(head) + read(HERE, file) + "state_hash\n"
    for path in sorted(glob.glob(os.path.join(ROOT, "examples", "*", "in.*"))):
        name = os.path.basename(os.path.dirname(path))
        if name in LEFT_OUT:
            continue
        scenes["example-" + os.path.basename(path)[3:]] = example_scene(name, read(path))
        for data in glob.glob(os.path.join(os.path.dirname(path), "*")):
            if data.endswith(DATA):
                shutil.copy(data, folder)
    for name, text in scenes.items():
        with open(os.path.join(folder, name + ".in"), "w") as file:
            file.write(text)
    print("%d scenes in %s" % (len(glob.glob(os.path.join(folder, "*.in"))), folder))


def build_plugin(description, folder):
    values = dict(re.findall(r'set\((\w+) "([^"]*)"\)', read(description)))
    command = [os.environ.get("CXX", "c++"), "-std=c++17", "-O2", "-shared", "-fPIC"]
    command += ["-D" + d for d in values["LAMMPS_DEFINITIONS"].split(";")]
    command += ["-I" + d for d in values["LAMMPS_INCLUDE_DIRS"].split(";") if d != "/usr/include"]
    if sys.platform == "darwin":
        command += ["-undefined", "dynamic_lookup"]
    # LAMMPS loads all *plugin.so of LAMMPS_PLUGIN_PATH by itself
    subprocess.run(command + [os.path.join(HERE, "same_bits.cpp"), "-o", os.path.join(folder, "hashplugin.so")],
                   check=True)


def stock_build(lmp):
    """Description of the stock build of LAMMPS that an executable is of; None if there is none."""
    text = subprocess.run([lmp, "-h"], stdout=subprocess.PIPE, check=True).stdout.decode()
    version = re.search(r"Simulator - (\d+ \w+ \d+)", text).group(1).replace(" ", "")
    found = glob.glob(os.path.expanduser("~/.cache/lammps-mpm/build-%s-*/mpm_lammps.cmake" % version))
    return max(found, key=os.path.getmtime, default=None)


def run(lmp, plugins, scenes, name, isa, ranks):
    """Lines of state_hash as lists, and the end of the output if it failed."""
    env = dict(os.environ, MPM_ISA=isa, LAMMPS_PLUGIN_PATH=plugins, OMP_NUM_THREADS="1",
               LAMMPS_POTENTIALS=os.path.join(ROOT, "potentials"), OMPI_ALLOW_RUN_AS_ROOT="1",
               OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1",
               OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_hwloc_base_binding_policy="none",
               OMPI_MCA_btl_vader_single_copy_mechanism="none")
    command = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    with tempfile.TemporaryDirectory(prefix="mpm_bits_") as folder:
        for path in glob.glob(os.path.join(scenes, "*")):
            if not path.endswith(".in"):
                os.symlink(path, os.path.join(folder, os.path.basename(path)))
        command += [lmp, "-in", os.path.join(scenes, name + ".in"), "-log", "none", "-nocite"]
        try:
            done = subprocess.run(command, cwd=folder, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=SECONDS)
            output, code = done.stdout.decode(errors="replace"), done.returncode
        except subprocess.TimeoutExpired as late:
            output, code = (late.stdout or b"").decode(errors="replace") + "\nmore than %d s" % SECONDS, 1
    result = {"states": [line.split()[1:] for line in output.splitlines() if line.startswith("state_hash: ")]}
    if code or not result["states"]:
        result["error"] = "\n".join(output.splitlines()[-8:])
    return result


def run_all(args):
    lmp, scenes = os.path.abspath(args.lmp), os.path.abspath(args.scenes)
    names = sorted(os.path.basename(path)[:-3] for path in glob.glob(os.path.join(scenes, "*.in")))
    names = [name for name in names if re.search(args.only, name)]
    start, results, failed = time.time(), {}, 0
    with tempfile.TemporaryDirectory() as plugins:
        build_plugin(args.lammps, plugins)
        sets = args.isa.split(",") if args.isa else [
            isa for isa in SETS if "error" not in run(lmp, plugins, scenes, "block-2d-cubic", isa, 1)]
        ranks = args.ranks or ("1,2" if args.quick else "1,2,4")
        for n in map(int, ranks.split(",")):
            with concurrent.futures.ThreadPoolExecutor(2 if n == 1 else 1) as pool:
                jobs = {(name, isa, n): pool.submit(run, lmp, plugins, scenes, name, isa, n)
                        for isa in (sets[:1] if args.quick else sets) for name in names}
                for (name, isa, _), job in jobs.items():
                    result = results["%s %s %d" % (name, isa, n)] = job.result()
                    result["loose"] = n > 2 and "balance" in read(scenes, name + ".in")
                    text = " ".join(state[1] for state in result["states"])
                    if "error" in result:
                        failed += 1
                        text += " FAILED:\n" + result["error"]
                    print("%-36s %-8s %d  %s" % (name, isa, n, text), flush=True)
    with open(args.out, "w") as file:
        json.dump(results, file, indent=0, sort_keys=True)
    print("%d runs, %d failed, %.0f s" % (len(results), failed, time.time() - start))


def difference(a, b):
    """Largest relative difference of the sums; infinite where one has failed or numbers of atoms differ."""
    counts = [[state[0] for state in result["states"]] + ["error" in result] for result in (a, b)]
    if counts[0] != counts[1]:
        return float("inf")
    pairs = [(float(x), float(y)) for p, q in zip(a["states"], b["states"]) for x, y in zip(p[2:], q[2:])]
    return max((abs(x - y) / max(abs(x), abs(y), 1.0e-300) for x, y in pairs), default=0.0)


def compare(old, new):
    a, b = json.loads(read(old)), json.loads(read(new))
    same = differ = 0
    for key in sorted(set(a) & set(b)):
        hashes = [[state[:2] for state in result["states"]] + ["error" in result] for result in (a[key], b[key])]
        size = difference(a[key], b[key])
        if hashes[0] == hashes[1] or (a[key].get("loose") and size < LOOSE):
            same += 1
        else:
            differ += 1
            print("%-48s %.1e%s" % (key, size, " (one failed, or other numbers of atoms)" * (size > 1.0)))
    print("%d the same, %d differ, %d in one file only" % (same, differ, len(set(a) ^ set(b))))
    return 1 if differ or not same else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lmp", nargs="?")
    parser.add_argument("--write-scenes")
    parser.add_argument("--test", default=os.path.join(ROOT, "build", "unittest", "test_pairs"))
    parser.add_argument("--scenes")
    parser.add_argument("--out")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--isa")
    parser.add_argument("--ranks")
    parser.add_argument("--lammps")
    parser.add_argument("--compare", nargs=2)
    args = parser.parse_args()
    if args.compare:
        sys.exit(compare(*args.compare))
    if args.write_scenes:
        return write_scenes(args.write_scenes, args.test)
    if not (args.lmp and args.scenes and args.out):
        parser.error("give LMP, --scenes, and --out")
    args.lammps = args.lammps or stock_build(args.lmp)
    if not args.lammps:
        parser.error("give --lammps: there is no stock build of the same version in the usual place")
    return run_all(args)


if __name__ == "__main__":
    main()
