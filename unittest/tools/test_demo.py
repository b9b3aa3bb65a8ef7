# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: build
# sanitize: no
# timeout: 120
"""The lmp of tools/demo.sh has a part of LAMMPS only: enough to be linked, and all that the scene names. And what
the shell functions of the tools print."""

import glob
import os
import re
import subprocess
import tempfile

import mpm_testing as mt

BUILD = os.path.dirname(mt.LMP)
STOCK = os.path.dirname(os.environ.get("MPM_STOCK_LMP", ""))
LIBRARY = os.path.join(STOCK, "liblammps.a")
SCENE = os.path.join(mt.ROOT, "examples", "taylor-bar", "in.taylor-bar")


def symbols(files):
    """symbols that are used and that are defined, as {file or member: set} each"""
    used, defined, name = {}, {}, files[0]
    output = mt.ok(mt.run(["nm", "-P", "-g"] + files)).output
    for line in output.splitlines():
        head = re.match(r"(?:\S*\[)?(\S+?\.o)\]?:$", line)
        words = line.split()
        if head:
            name = os.path.basename(head.group(1))
        elif len(words) >= 2:
            (used if words[1] in "Uwv" else defined).setdefault(name, set()).add(words[0])
    return used, defined


def objects_of(target):
    """paths of the object files of a target of this build"""
    top = os.path.join(BUILD, "CMakeFiles", target + ".dir")
    return [os.path.join(folder, name) for folder, _, names in os.walk(top) for name in names if name.endswith(".o")]


def whole(text):
    """flags of a target, without the folders of its build tree"""
    return re.sub(r"\S*/CMakeFiles/|(?<=Custom options: )\S*?(?=CMakeFiles)", "CMakeFiles/", text)


def demo_tree(folder):
    settings = ["LAMMPS_BUILD_DIR=" + STOCK, "MPM_TEST=off", "MPM_PLUGIN=off", "MPM_DEMO=on"]
    settings += [line for line in mt.read(os.path.join(BUILD, "CMakeCache.txt")).splitlines()
                 if line.startswith(("CMAKE_BUILD_TYPE:", "CMAKE_CXX_FLAGS", "MPM_QUICK:"))]
    mt.ok(mt.run(["cmake", "-S", mt.ROOT, "-B", folder] + [word for s in settings for word in ("-D", s)]))


def test_what_is_left_out_is_not_needed():
    if not os.path.exists(LIBRARY):
        raise mt.Skip("no LAMMPS that has been compiled before")
    with tempfile.TemporaryDirectory() as folder:
        demo_tree(folder)
        kept = {os.path.basename(path) for path in mt.read(os.path.join(folder, "demo_objects.txt")).split()}
        flags = {os.path.basename(os.path.dirname(path))[:-4]: mt.read(path)
                 for target in ("mpm_objects", "mpm_core", "mpm_isa_*")
                 for path in glob.glob(os.path.join(folder, "CMakeFiles", target + ".dir", "flags.make"))}
        sets = [target for target in flags if target.startswith("mpm_isa_")]
        styles = {path: mt.read(path) for path in glob.glob(os.path.join(folder, "styles", "style_*.h"))}
    members = set(mt.ok(mt.run(["ar", "t", LIBRARY])).output.split())
    here = {os.path.basename(path) for path in objects_of("lammps_styles")}
    assert kept < members and len(here) > 3 and not here & kept, (kept - members, here)
    assert len(kept) < 0.5 * len(members), (len(kept), len(members))

    used, defined = symbols([LIBRARY])
    objects = objects_of("mpm_objects")
    used_here, defined_here = symbols(objects)
    # a quick build compiles several sources as one: few objects, all styles
    assert any("PairMPMPenalty" in symbol for names in defined_here.values() for symbol in names), objects
    need = set().union(*used_here.values(), *(used.get(name, set()) for name in kept))
    have = set().union(*(defined.get(name, set()) for name in kept | here))
    left_out = {symbol: name for name in members - kept - here for symbol in defined.get(name, ())}
    missing = sorted((left_out[symbol], symbol) for symbol in need - have if symbol in left_out)
    assert not missing, missing

    # what is in the lists of styles, too; pair hybrid and its like ask for the others when they run
    for path, text in styles.items():
        for name in re.findall(r'include "(\w+)\.h"', text):
            own = os.path.exists(os.path.join(mt.ROOT, "src", "MPM", name + ".cpp"))
            assert own or name + ".cpp.o" in kept | here, (path, name)

    # one set of kernels, that of this machine; and the flags of the whole, so that nothing is compiled twice
    assert len(sets) == 1 or not os.path.exists("/proc/cpuinfo"), sets
    assert "mpm_objects" in flags and "mpm_core" in flags and len(flags) >= 3, flags
    for target, text in flags.items():
        here = os.path.join(BUILD, "CMakeFiles", target + ".dir", "flags.make")
        if not os.path.exists(here):
            raise mt.Skip("this build takes its core from another one")
        assert whole(mt.read(here)) == whole(text), (target, mt.read(here), text)

    # and the styles of the scene
    text = re.sub(r"&[ \t]*\n", " ", mt.read(SCENE))
    for kind, style in re.findall(r"^(fix|compute|dump)\s+\S+\s+\S+\s+(\S+)", text, re.M):
        lists = styles[[path for path in styles if path.endswith("style_%s.h" % kind)][0]]
        assert re.search(r'["/]%s_%s\.h"' % (kind, style.replace("/", "_")), lists), (kind, style)


def shell(text):
    command = '. "%s/tools/lib.sh"; %s' % (mt.ROOT, text)
    return subprocess.run(["bash", "-c", command], capture_output=True, text=True).stdout


def test_the_demonstration_needs_no_packages_of_the_tests():
    few, all_of_them = shell("packages_needed"), shell("packages_needed all")
    assert all_of_them.startswith(few) and "cmake" in few, few
    for package in ("sphinx", "gtest", "benchmark", "matplotlib", "clang-format"):
        assert package not in few and package in all_of_them, package


def test_progress():
    shown = shell("{ echo '[  9%] Building'; sleep 5; echo '[ 20%] Building'; echo 'a.cpp:3: error: no'; echo '[100%] Built'; } | "
                  "show_progress").splitlines()
    assert len(shown) == 3 and re.match(r"    20 %, about \d+:[0-5]\d minutes left$", shown[0]), shown
    assert shown[1:] == ["a.cpp:3: error: no", "   100 %"], shown
    files = shell("for k in 1 2 3; do echo 'Building CXX object a.cpp.o'; done | show_progress 9").split()
    assert files == ["10", "%", "20", "%", "30", "%"], files


mt.main(globals())
