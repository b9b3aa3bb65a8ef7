# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: build smoke
# sanitize: no
# timeout: 120
"""Material files are found from any folder and without an environment variable: by the lmp of the build tree, by an
installed one, wherever its folders have been moved to, and by the plugin. What is installed is complete."""

import glob
import os
import re
import shutil
import tempfile

import mpm_testing as mt

BUILD = os.path.dirname(mt.LMP)
STOCK = os.environ.get("MPM_STOCK_LMP", "")
SCENE = """
units           si
atom_style      mpm
region          box block 0 2 0 2 0 2
create_box      1 box
fix             grid all mpm 1.0
create_points   1 region box ppc 1
fix             m all mpm/material file %s
run             0
"""
MATERIAL = "# DATE: 2026-01-01 UNITS: si\ndensity 1234.0 neohookean 1.0e6 0.3\n"
NO_VARIABLES = {"LAMMPS_POTENTIALS": "", "LAMMPS_PLUGIN_PATH": ""}


def run(name, folder=None, begin="", executable=mt.LMP, **variables):
    """the scene with a material file, in a folder that has nothing else in it when none is given"""
    environment = dict(NO_VARIABLES, **variables)
    if folder:
        return mt.lammps(folder, begin + SCENE % name, executable=executable, environment=environment)
    return mt.lammps_once(begin + SCENE % name, executable=executable, environment=environment)


def installed(prefix):
    """an installation in this folder"""
    if not os.path.exists(os.path.join(BUILD, "cmake_install.cmake")):
        raise mt.Skip("no build tree of CMake beside lmp")
    mt.ok(mt.run(["cmake", "--install", BUILD, "--prefix", prefix, "--strip"]))
    return prefix


def files(folder, pattern):
    found = (os.path.relpath(path, folder) for path in glob.glob(os.path.join(folder, pattern), recursive=True))
    return sorted(path for path in found if not path.endswith("README"))


def test_build_tree():
    found = mt.ok(run("Water_Tait.mpm"))
    assert "Reading material file Water_Tait.mpm with DATE" in found.output, found.tail()


def test_a_file_here_and_those_of_the_variable_come_first():
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as other:
        with open(os.path.join(folder, "Water_Tait.mpm"), "w") as file:
            file.write(MATERIAL)
        assert "neohookean" in mt.ok(run("Water_Tait.mpm", folder)).output
        assert "neohookean" in mt.ok(run("Water_Tait.mpm", other, LAMMPS_POTENTIALS=folder)).output
        assert "neohookean" not in mt.ok(run("Water_Tait.mpm", other)).output


def test_a_name_with_a_folder_is_not_another_file():
    found = run("mine/Water_Tait.mpm")
    assert found.code and "cannot read file mine/Water_Tait.mpm: it is not here" in found.output, found.tail()


def test_one_version():
    version = re.search(r'MPM_VERSION "(\d+\.\d+\.\d+)"', mt.read(os.path.join(mt.ROOT, "src", "MPM", "base", "mpm_version.h"))).group(1)
    assert "\nversion: %s\n" % version in mt.read(os.path.join(mt.ROOT, "CITATION.cff"))
    headings = re.findall(r"^## (.*)", mt.read(os.path.join(mt.ROOT, "CHANGELOG.md")), re.M)
    assert re.match(r"Unreleased: %s$|%s - \d{4}-\d\d-\d\d$" % ((re.escape(version),) * 2), headings[0]), headings
    assert "MPM package %s: spacing 1" % version in mt.ok(run("Water_Tait.mpm")).output


def test_plugin():
    if not os.path.exists(os.environ.get("MPM_PLUGIN", "")) or not os.path.exists(STOCK):
        raise mt.Skip("no plugin or no LAMMPS without the package")
    mt.ok(run("Water_Tait.mpm", executable=STOCK, begin="plugin load %s\n" % os.environ["MPM_PLUGIN"]))


def test_installation():
    with tempfile.TemporaryDirectory() as top:
        prefix = os.path.join(top, "moved")
        os.rename(installed(os.path.join(top, "prefix")), prefix)
        share = os.path.join(prefix, "share", "lammps-mpm")
        lmp, plugin = os.path.join(prefix, "bin", "lmp"), glob.glob(os.path.join(prefix, "lib*", "**", "mpmplugin.so"),
                                                                    recursive=True)

        # all that the source tree has
        assert files(share, "potentials/*") == files(mt.ROOT, "potentials/*.mpm")
        for pattern in ("examples/*/in.*", "examples/*/*.png", "examples/*/*.md", "src/MPM/**/*.h"):
            assert files(share, pattern) == files(mt.ROOT, pattern), pattern
        assert not files(prefix, "**/build") and not files(prefix, "**/__pycache__")

        # what READMEs of scenes name is there
        for path in glob.glob(os.path.join(share, "examples", "*", "README.md")):
            for name in re.findall(r"\.\./\.\./\S+\.py", mt.read(path)):
                assert os.access(os.path.join(os.path.dirname(path), name), os.R_OK), (path, name)

        # by its path, through a link, and by its name alone
        mt.ok(run("Water_Tait.mpm", executable=lmp))
        link = os.path.join(top, "lmp")
        os.symlink(lmp, link)
        mt.ok(run("Water_Tait.mpm", executable=link))
        mt.ok(run("Water_Tait.mpm", executable="lmp", PATH=os.path.dirname(lmp) + ":" + os.environ["PATH"]))
        if os.path.exists(STOCK) and plugin:
            mt.ok(run("Water_Tait.mpm", executable=STOCK, begin="plugin load %s\n" % plugin[0]))

        # and it is these files that are read
        shutil.rmtree(os.path.join(share, "potentials"))
        found = run("Water_Tait.mpm", executable=lmp)
        assert found.code and "nor among the files of this package" in found.output, found.tail()


mt.main(globals())
