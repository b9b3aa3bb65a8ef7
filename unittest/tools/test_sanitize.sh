#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# test_sanitize.sh FOLDER PART: what runs with the address and undefined behaviour
# sanitizers in minutes (the rest: tools/sanitize.sh); they stop at the first wrong access.
#   units    unit tests that need no LAMMPS, with one instruction set, the best up to AVX2
#   lammps   all fixes, create_points, the halo, and what else looks up memory in the part
#            that knows LAMMPS: they take the place of their objects in lmp, which runs the
#            examples of the manual, and random scenes on two processes and through restarts
# Objects stay in FOLDER and are compiled again when a source has changed.
# CXX, MPM_EIGEN: compiler, folder of Eigen
# MPM_LMP, MPM_LAMMPS_FLAGS, MPM_PYTHON: executable in its build tree, flags for headers of LAMMPS,
# a Python with numpy

set -u
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
src=$root/src/MPM
folder=${1:?usage: test_sanitize.sh FOLDER PART}
part=${2:?}
cxx=${CXX:-c++}
mkdir -p "$folder/$part" && folder=$(cd "$folder/$part" && pwd) && cd "$folder" || exit 1

flags=(-std=c++17 -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all
       -DMPM_SANITIZED -fno-omit-frame-pointer -fopenmp-simd -ffp-contract=fast
       -fno-math-errno -fno-trapping-math
       -Wall -Wextra -I"$src" -I"$root/unittest" -isystem "${MPM_EIGEN:-/usr/include/eigen3}" -fPIC
       -D_GLIBCXX_ASSERTIONS -fsanitize=float-cast-overflow)

echo 'int main() { return 0; }' >probe.cpp
if ! "$cxx" "${flags[@]}" probe.cpp -o probe 2>/dev/null || ! ./probe; then
  echo "the compiler has no sanitizers here: skipped"
  exit 77
fi

# what is the baseline here has the vectors of AVX2, if compiler and processor have it
march=()
v3=(-march=x86-64-v3)
if "$cxx" "${v3[@]}" -x c++ -c - -o /dev/null </dev/null 2>/dev/null &&
   grep -qw avx2 /proc/cpuinfo 2>/dev/null; then
  march=("${v3[@]}")
fi

# compile SOURCE OBJECT FLAGS...: when the object is missing or older than any source or header
newest=$(ls -t "$src"/*/*.h "$src"/*/*.cpp "$root"/unittest/*/*_testing.h "${BASH_SOURCE[0]}" | head -1)
compile() {
  local source=$1 object=$2
  shift 2
  objects+=("$folder/$object")
  [ -e "$object" ] && [ "$object" -nt "$newest" ] && [ "$object" -nt "$source" ] && return 0
  "$cxx" "${flags[@]}" "$@" -c "$source" -o "$object" ||
    { rm -f "$object"; echo "cannot compile $source"; exit 1; }
}

failed=0
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
unset GTEST_OUTPUT MPM_ISA

unit_tests() {
  flags+=(-include "$root/cmake/sanitize.h")
  # kernels of Bernstein polynomials and of polypic take long to compile; no test here calls them
  cat >others.cpp <<'CODE'
#include "transfer/kernels_isa.h"
#include <cstdlib>
using namespace MPM_NS;
TransferKernels MPM_NS::MPM_OF_ISA(mpm_kernels_bernstein)(const KernelChoice &) { return {}; }
PolyKernels MPM_NS::MPM_OF_ISA(mpm_kernels_poly)(int, Shape, int) { abort(); }
CODE

  # FOLDER_FILE.o: files of the same name are in several folders
  object_of() {
    local folder=$(dirname "$1")
    echo "$(basename "$folder")_$(basename "$1" .cpp).o"
  }

  objects=()
  for source in "$src"/{declare,image,lattice,law,material,mesh,table,transfer}/*.cpp; do
    case $source in *_isa.cpp) continue ;; esac
    compile "$source" "$(object_of "$source")"
  done
  march+=(-DMPM_ISA=base)
  compile "$src/material/batch_kernels_isa.cpp" batch_isa.o "${march[@]}"
  compile "$src/law/laws_isa.cpp" laws_isa.o "${march[@]}" -g0
  for family in $(grep '^ *X(' "$src/law/list.h" | grep -o '[a-z]*'); do
    laws=laws_$family.cpp
    [ -e "$laws" ] || printf '#include "law/list.h"\nMPM_LAW_FAMILY(%s)\n' "$family" >"$laws"
    compile "$laws" "laws_$family.o" "${march[@]}" -g0
  done
  compile others.cpp others_isa.o "${march[@]}"
  # the optimizer needs minutes for these with sanitizers
  for kernels in "$src"/transfer/*_isa.cpp; do
    name=$(basename "$kernels" .cpp)
    case $name in polypic_*) continue ;; esac
    compile "$kernels" "$name.o" "${march[@]}" -O0 -g0
  done
  # as in cmake/mpm_sources.cmake
  for name in linear quadratic cubic gimp cpdi cpdi2; do
    kernels=kernels_$name.cpp
    case $name in cpdi*) header=cpdi macro=MPM_DOMAIN_KERNELS_OF_SHAPE ;; *) header=fast macro=MPM_KERNELS_OF_SHAPE ;; esac
    [ -e "$kernels" ] || cat >"$kernels" <<CODE
#include "transfer/kernels_isa.h"
#ifdef MPM_HAVE_VECTORS
#include "transfer/kernels_$header.h"
$macro($name, ${name^^})
#endif
CODE
    compile "$kernels" "${name}_isa.o" "${march[@]}" -O0 -g0
  done

  compile "$root/unittest/patterns.cpp" patterns.o -O0
  library=("${objects[@]}")
  for test in declare/test_option transfer/test_shape lattice/test_grid image/test_image mesh/test_gmsh transfer/test_kernels transfer/test_scalar \
    transfer/test_cpdi_kernels material/test_materials material/test_tangent; do
    name=${test##*/test_}
    objects=()
    # to optimize these takes longer than they run; kernels and tangents compute much in the test itself
    case $name in kernels | cpdi_kernels | scalar | tangent) level=-O1 ;; *) level=-O0 ;; esac
    compile "$root/unittest/$test.cpp" "test_$name.o" "$level" -DMPM_SOURCE_DIR="\"$root\""
    "$cxx" "${flags[@]}" "test_$name.o" "${library[@]}" -lgmock -lgtest_main -lgtest -lpthread \
      -o "test_$name" || { echo "cannot link test_$name"; exit 1; }
    echo "== test_$name"
    "./test_$name" --gtest_brief=1 --gtest_filter=-*avx512* || failed=1
  done
}

with_lammps() {
  # half of the time would be that for headers; compiled ones must be the first that are included
  read -ra lammps <<<"$MPM_LAMMPS_FLAGS"
  echo "#include \"$root/cmake/sanitize.h\"" >lammps.h
  cat >>lammps.h <<'CODE'
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>
#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "memory.h"
#include "modify.h"
#include "update.h"
CODE
  lammps+=(-O0)
  [ lammps.h.gch -nt lammps.h ] || "$cxx" "${flags[@]}" "${lammps[@]}" -x c++-header lammps.h -o lammps.h.gch
  build=$(dirname "$MPM_LMP")
  link=$(<"$build/CMakeFiles/lmp.dir/link.txt")
  for source in "$src"/*/{fix_,pair_,compute_,region_}*.cpp \
    "$src"/create/{create_points,create_points_image,create_points_table,mpm_point_columns}.cpp \
    "$src"/base/mpm_state.cpp "$src"/field/mpm_{halo,nodes,point_map,every,affine,cpdi}.cpp; do
    name=$(basename "$source")
    objects=()
    compile "$source" "${name%.cpp}.o" -include lammps.h "${lammps[@]}"
    room=$(basename "$(dirname "$source")")
    link=${link//CMakeFiles\/mpm_objects.dir\/src\/MPM\/$room\/$name.o/$folder\/${name%.cpp}.o}
  done
  case $link in *"$folder/fix_mpm.o"*) ;; *) echo "lmp is linked in another way"; exit 1 ;; esac
  (cd "$build" && eval "${link/ -o lmp / -fsanitize=address,undefined -o $folder/lmp }") ||
    { echo "cannot link lmp"; exit 1; }

  # LAMMPS and MPI leave memory behind; an error of LAMMPS must not look like one of these
  export MPM_LMP=$folder/lmp ASAN_OPTIONS=$ASAN_OPTIONS:abort_on_error=1:detect_leaks=0 \
    UBSAN_OPTIONS=$UBSAN_OPTIONS:abort_on_error=1
  "$MPM_PYTHON" "$root/unittest/docs/test_docs_examples.py" || failed=1
  "$MPM_PYTHON" "$root/tools/fuzz.py" --inputs 20 --scenes 4 --seed 300 --jobs 1 --out "$folder/fuzz" || failed=1
}

case $part in
  units) unit_tests ;;
  lammps) with_lammps ;;
  *) echo "no part $part"; exit 1 ;;
esac
exit $failed
