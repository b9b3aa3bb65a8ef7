#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Builds as tools/build.sh does, runs the Taylor bar (a copper cylinder that hits
# a rigid wall) and compares its final shape with the experiment.
# Environment: see tools/build.sh; MPM_NP: number of processes (default 1)

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

setup
build_project lmp
example=$repo/examples/taylor-bar
run=$build/demo
[ -e "$example/in.taylor-bar" ] || die "no $example/in.taylor-bar"
rm -rf "$run"
mkdir -p "$run"
cp -r "$example"/. "$run"
cd "$run" || exit 1

lmp=("$build/lmp")
np=${MPM_NP:-1}
if [ "$np" -gt 1 ]; then
  mpi_environment
  lmp=(mpirun -np "$np" "$build/lmp")
fi

say "running the Taylor bar in $run with $np process(es)"
start=$SECONDS
"${lmp[@]}" -in in.taylor-bar -log log.lammps -echo screen 2>&1 | run_progress
[ "${PIPESTATUS[0]}" -eq 0 ] || { tail -20 log.lammps; die "the run failed, see $run/log.lammps"; }
say "finished in $((SECONDS - start)) s"

"$(python_with_numpy)" "$repo/tools/taylor_table.py" "$run" || die "no table from tools/taylor_table.py"

say "pictures and data (VTK files: open with ParaView)"
list_files png vtp vtu vtk pvd
