#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# From a fresh clone to a working LAMMPS with this package:
#   tools/build.sh [target...]       default: lmp and mpmplugin.so
# The last line printed is the path of the lmp executable.
#
# Environment (all optional):
#   LAMMPS_SOURCE_DIR   use this LAMMPS source tree
#   MPM_LAMMPS          20260704 (preferred) or 20250204
#   MPM_SIZES           SMALLBIG (default) or BIGBIG
#   MPM_BUILD_DIR       build tree, default ./build
#   MPM_CACHE           sources and stock LAMMPS, default ~/.cache/lammps-mpm
#   MPM_LAMMPS_GIT      address of a LAMMPS git repository to clone from
#   MPM_CMAKE           more arguments for cmake, e.g. "-D MPM_BENCH=on"
#   MPM_JOBS            number of parallel compilations, default: all cores

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# tests and benchmarks need more packages
case "$* ${MPM_CMAKE:-}" in
  *test*|*bench*|*BENCH*) setup all ;;
  *) setup ;;
esac
build_project "$@"
say "built with LAMMPS $(lammps_version) ($sizes) in $build"
echo "$build/lmp"
