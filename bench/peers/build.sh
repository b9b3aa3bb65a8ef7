#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# What the comparison needs: OpenFOAM and CalculiX from Debian, and a second
# LAMMPS with the other particle methods, from the sources that tools/build.sh
# has in its cache.  The last line printed is the path of that lmp.
# Environment: MPM_CACHE, MPM_JOBS, MPM_LAMMPS, MPM_LAMMPS_GIT, and
# LAMMPS_SOURCE_DIR, see tools/build.sh.

set -u
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/../../tools/lib.sh"

eval "own_$(declare -f packages_needed)"
packages_needed() {
  own_packages_needed
  cat <<'LIST'
finite volumes: openfoam
finite elements: calculix-ccx
RHEO: libgsl-dev liblapack-dev
LIST
}

# configure_peers: sets peers, holds the lock of the folder; false when it is built already
configure_peers() {
  local key launcher=
  key=$(cat "$here/lammps_peers.cmake" "$repo/cmake/lammps_export.cmake" \
            <(c++ -dumpfullversion -dumpmachine; echo "$LAMMPS_SOURCE_DIR") | sha256sum | cut -c1-8)
  peers=$cache/peers-$(lammps_version | tr -d ' ')-$key
  [ -e "$peers/.complete" ] && return 1
  lock "$peers.lock"
  [ -e "$peers/.complete" ] && return 1
  mkdir -p "$peers"
  compiler_cache
  # the first include gives precompiled headers, without which this takes three times as long
  # shellcheck disable=SC2086
  cmake -S "$LAMMPS_SOURCE_DIR/cmake" -B "$peers" -G "Unix Makefiles" -C "$here/lammps_peers.cmake" $launcher \
        -D CMAKE_PROJECT_lammps_INCLUDE="$repo/cmake/lammps_export.cmake" >"$peers/build.log" 2>&1 ||
    { tail -20 "$peers/build.log"; die "configuring LAMMPS failed, see $peers/build.log"; }
}

install_packages
find_sources
if configure_peers; then
  say "building LAMMPS $(lammps_version) with the other methods, once for this machine; takes a few minutes"
  make_progress "$peers" lmp || die "building LAMMPS failed, see $peers/build.log"
  touch "$peers/.complete"
fi
unlock
echo "$peers/lmp"
