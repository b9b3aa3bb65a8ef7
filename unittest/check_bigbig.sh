#!/bin/sh
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# check_bigbig.sh COMPILER FOLDER FLAGS...: reads the sources that know LAMMPS with the
# flags of a LAMMPS of another kind (64-bit IDs and image flags); fails at an error,
# and at formats of printf and MPI types that only fit the other kind.

compiler=$1
folder=$2
shift 2
failed=0
for source in "$folder"/*.cpp "$folder"/*/*.cpp; do
  case $source in *_isa.cpp | */plugin/*) continue ;; esac
  grep -q LAMMPS_NS "$source" || continue
  "$compiler" -std=c++17 -fsyntax-only -Wall -Wextra -Werror=format -Werror=narrowing \
    -I"$folder" "$@" "$source" || { echo "not with these flags: $source"; failed=1; }
done
types='MPI_INT[^0-9_].*(tag|image)|(tagint|imageint|bigint).*MPI_INT[^0-9_]'
if grep -nE "$types" "$folder"/*.cpp; then
  echo "IDs, image flags and counts of atoms have other MPI types: MPI_LMP_TAGINT, ..."
  failed=1
fi
exit $failed
