#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# From a fresh clone to a picture: builds an lmp, runs the Taylor bar (a copper cylinder
# that hits a rigid wall), and compares its final shape with the experiment.  Where LAMMPS has
# not been compiled yet, it compiles what the demonstration needs first, and the rest of it
# after the run.
# Environment: see tools/build.sh; MPM_NP: number of processes (default 1);
# MPM_REST=off: the rest is left to tools/build.sh

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

install_packages
find_sources
build_demo
complete=$?
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

if [ $complete -ne 0 ]; then
  say "this lmp has only what the demonstration needs; tools/build.sh makes the whole of LAMMPS"
  if [ "${MPM_REST:-on}" != off ]; then
    say "doing that now (it can be interrupted, and goes on with the next tools/build.sh)"
    build_stock
    build_project lmp
    say "$build/lmp is complete"
  fi
fi
