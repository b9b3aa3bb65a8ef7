# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: build long
# sanitize: no
# timeout: 120
"""The Debian package that tools/package_deb.sh makes: what is in it, what it depends on, and that its lmp runs the
first input of the README where it has been unpacked. The recipes for Docker and Spack cannot be run here."""

import glob
import os
import re
import shutil
import tempfile

import mpm_testing as mt

BUILD = os.path.dirname(mt.LMP)


def first_input():
    text = mt.read(os.path.join(mt.ROOT, "README.md")).split("## A first input", 1)[1]
    return re.search(r"```\n(.*?)```", text, re.S).group(1)


def test_debian_package():
    for tool in ("cpack", "dpkg-deb", "dpkg-shlibdeps"):
        if not shutil.which(tool):
            raise mt.Skip("no " + tool)
    if not os.path.exists(os.path.join(BUILD, "CPackConfig.cmake")):
        raise mt.Skip("no build tree of CMake beside lmp")
    with tempfile.TemporaryDirectory() as top:
        # gzip takes seconds, the default takes a minute
        mt.ok(mt.run(["cpack", "-G", "DEB", "--config", os.path.join(BUILD, "CPackConfig.cmake"), "-B", top,
                      "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip"]))
        packages = glob.glob(os.path.join(top, "*.deb"))
        version = re.search(r'MPM_VERSION "(.*)"', mt.read(os.path.join(mt.ROOT, "src", "MPM", "base", "mpm_version.h"))).group(1)
        assert len(packages) == 1 and os.path.basename(packages[0]).startswith("lammps-mpm_%s_" % version), packages

        fields = mt.ok(mt.run(["dpkg-deb", "-f", packages[0]])).output
        assert re.search(r"^Depends: .*libc6 \(>= .*libopenmpi", fields, re.M), fields
        assert "\nConflicts: lammps\n" in fields, fields
        files = mt.ok(mt.run(["dpkg-deb", "-c", packages[0]])).output
        for name in ("bin/lmp", "share/lammps-mpm/potentials/Water_Tait.mpm", "share/lammps-mpm/examples/beam/in.beam",
                     "share/doc/lammps-mpm/README.md"):
            assert re.search(r" root/root .* \./usr/%s\n" % re.escape(name), files), name
        assert BUILD not in files and mt.ROOT not in files

        unpacked = os.path.join(top, "unpacked")
        mt.ok(mt.run(["dpkg-deb", "-x", packages[0], unpacked]))
        lmp, folder = os.path.join(unpacked, "usr", "bin", "lmp"), os.path.join(top, "first")
        os.mkdir(folder)
        found = mt.ok(mt.lammps(folder, first_input(), executable=lmp, environment={"LAMMPS_POTENTIALS": ""}))
        # height of the bar, with the experiment (16.2 mm) as the README has it
        names, rows = mt.thermo(found.output)[0]
        assert abs(float(rows[-1][names.index("c_top")]) - 16.2e-3) < 0.5e-3, rows[-1]
        assert glob.glob(os.path.join(folder, "bar.*.png")) and os.path.exists(os.path.join(folder, "bar.pvd"))


def test_recipes_name_what_there_is():
    cmake = mt.read(os.path.join(mt.ROOT, "CMakeLists.txt"))
    path = os.path.join(mt.ROOT, "tools", "spack", "spack_repo", "lammps_mpm", "packages", "lammps_mpm", "package.py")
    recipe = mt.read(path)
    compile(recipe, path, "exec")
    up = int(re.search(r"\[os\.pardir\] \* (\d+)", recipe).group(1))
    assert os.path.samefile(os.path.join(os.path.dirname(path), *[os.pardir] * up), mt.ROOT)
    options = re.findall(r'self\.define\w*\("(\w+)"', recipe)
    assert len(options) == 3 and all("(%s " % option in cmake for option in options), options

    docker = mt.read(os.path.join(mt.ROOT, "Dockerfile"))
    scripts = re.findall(r"tools/\S+\.sh", docker)
    assert scripts and all(os.access(os.path.join(mt.ROOT, name), os.X_OK) for name in scripts), scripts
    ignored = mt.read(os.path.join(mt.ROOT, ".dockerignore")).split()
    assert "build*" in ignored and "cmake" not in ignored, ignored


mt.main(globals())
