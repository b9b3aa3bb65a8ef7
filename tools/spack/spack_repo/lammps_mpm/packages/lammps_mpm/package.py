# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Spack recipe of LAMMPS with the MPM package, from the clone that this file is in:

    spack repo add <clone>/tools/spack/spack_repo/lammps_mpm
    spack install lammps-mpm
"""

import os

from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *

CLONE = os.path.abspath(os.path.join(os.path.dirname(__file__), *[os.pardir] * 6))


class LammpsMpm(CMakePackage):
    """LAMMPS with the material point method: solids and fluids at large deformation, together with
    grains and atoms in one run."""

    homepage = "https://www.lammps.org"
    git = "file://" + CLONE
    license("GPL-2.0-only")

    version("develop", branch="main")

    variant("plugin", default=True, description="Build mpmplugin.so for other builds of the same version of LAMMPS")

    resource(name="lammps", git="https://github.com/lammps/lammps.git", tag="patch_4Jul2026", placement="lammps")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.20:", type="build")
    depends_on("mpi")
    depends_on("eigen@3.4:")
    depends_on("fftw@3:")
    depends_on("libpng")
    depends_on("zlib-api")
    depends_on("python@3.8:", type="run")
    depends_on("py-numpy", type="run")

    def cmake_args(self):
        return [
            self.define("LAMMPS_SOURCE_DIR", os.path.join(self.stage.source_path, "lammps")),
            self.define_from_variant("MPM_PLUGIN", "plugin"),
            self.define("MPM_TEST", False),
        ]
