#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Builds as tools/build.sh does, and makes a Debian package of it in the build tree:
# lmp, mpmplugin.so, Python module, material files, examples, and the manual where
# Sphinx is installed.  The last line printed is its path.
# It depends on the libraries of the release that it is made on.
# Environment: see tools/build.sh

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

command -v dpkg-shlibdeps >/dev/null || command -v dpkg-query >/dev/null ||
  die "Debian packages can be made on Debian and its relatives only"
setup
targets=(all mpm_python)
/usr/bin/python3 -c 'import sphinx' 2>/dev/null && targets+=(mpm_manual)
build_project "${targets[@]}"
say "packing"
rm -f "$build"/packages/*.deb
(cd "$build" && cpack -G DEB -B packages) >"$build/packages.log" 2>&1 ||
  { tail -20 "$build/packages.log"; die "packing failed, see $build/packages.log"; }
rm -rf "$build/packages/_CPack_Packages"
echo "$build"/packages/*.deb
