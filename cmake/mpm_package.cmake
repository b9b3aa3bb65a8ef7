# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Debian package of what is installed, by cpack -G DEB; see tools/package_deb.sh.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lammps-mpm)
set(CPACK_PACKAGE_VENDOR "the authors of the MPM package for LAMMPS")
set(CPACK_PACKAGE_CONTACT "${CPACK_PACKAGE_VENDOR}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "LAMMPS with the material point method")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "The simulator LAMMPS with the MPM package, which simulates solids and
fluids at large deformation with the material point method, together with
grains and atoms in one run: executable, plugin for other builds of the same
version of LAMMPS, material files, examples, and Python module.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "openmpi-bin, python3-numpy, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_CONFLICTS lammps)    # has /usr/bin/lmp, too
include(CPack)
