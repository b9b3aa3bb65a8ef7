#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# test_sanitize.sh FOLDER: the unit tests that need no LAMMPS, compiled with the
# address and undefined behaviour sanitizers, which stop at the first wrong access.
# Objects stay in FOLDER and are compiled again when a source has changed.
# CXX, MPM_EIGEN: compiler, folder of Eigen

set -u
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
src=$root/src/MPM
folder=${1:?usage: test_sanitize.sh FOLDER}
cxx=${CXX:-c++}
mkdir -p "$folder" && cd "$folder" || exit 1

# functions that are inlined by force are compiled once instead of at each call, which saves minutes
flags=(-std=c++17 -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all
       -DMPM_SANITIZED -Dalways_inline=unused -fno-omit-frame-pointer -fopenmp-simd -ffp-contract=fast
       -fno-math-errno -fno-trapping-math
       -Wall -Wextra -I"$src" -I"$root/unittest" -isystem "${MPM_EIGEN:-/usr/include/eigen3}")

echo 'int main() { return 0; }' >probe.cpp
if ! "$cxx" "${flags[@]}" probe.cpp -o probe 2>/dev/null || ! ./probe; then
  echo "the compiler has no sanitizers here: skipped"
  exit 77
fi

# instruction sets that compiler and processor have; avx512 takes too long to compile
sets=(base)
definitions=()
v3=(-march=x86-64-v3)
if "$cxx" "${v3[@]}" -x c++ -c - -o /dev/null </dev/null 2>/dev/null &&
   grep -qw avx2 /proc/cpuinfo 2>/dev/null; then
  sets+=(v3)
  definitions=(-DMPM_HAVE_V3)
fi

# compile SOURCE OBJECT FLAGS...: when the object is missing or older than any source or header
newest=$(ls -t "$src"/*/*.h "$src"/*/*.cpp "$root"/unittest/*/*_testing.h "${BASH_SOURCE[0]}" | head -1)
compile() {
  local source=$1 object=$2
  shift 2
  objects+=("$folder/$object")
  [ -e "$object" ] && [ "$object" -nt "$newest" ] && [ "$object" -nt "$source" ] && return 0
  "$cxx" "${flags[@]}" "${definitions[@]}" "$@" -c "$source" -o "$object" ||
    { rm -f "$object"; echo "cannot compile $source"; exit 1; }
}

# kernels of Bernstein polynomials and of polypic take long to compile; no test here calls them
cat >others.cpp <<'CODE'
#include "transfer/kernels_isa.h"
#include <cstdlib>
using namespace MPM_NS;
TransferKernels MPM_NS::MPM_OF_ISA(mpm_kernels_bernstein)(const KernelChoice &) { return {}; }
PolyKernels MPM_NS::MPM_OF_ISA(mpm_kernels_poly)(int, Shape, int) { abort(); }
CODE

# FOLDER_FILE_ISA.o: files of the same name are in several folders
object_of() {
  local folder=$(dirname "$1")
  echo "$(basename "$folder")_$(basename "$1" .cpp)_$2.o"
}

objects=()
for source in "$src"/{declare,lattice,law,material,mesh,transfer}/*.cpp; do
  case $source in *_isa.cpp) continue ;; esac
  compile "$source" "$(object_of "$source" base)"
done
for isa in "${sets[@]}"; do
  march=()
  [ "$isa" = v3 ] && march=("${v3[@]}")
  compile "$src/material/batch_isa.cpp" "batch_$isa.o" -DMPM_ISA="$isa" "${march[@]}"
  compile "$src/law/laws_isa.cpp" "laws_$isa.o" -DMPM_ISA="$isa" "${march[@]}" -g0
  for family in $(grep '^  X(' "$src/law/list.h" | grep -o '[a-z]*'); do
    laws=laws_$family.cpp
    [ -e "$laws" ] || printf '#include "law/list.h"\nMPM_LAW_FAMILY(%s)\n' "$family" >"$laws"
    compile "$laws" "laws_${family}_$isa.o" -DMPM_ISA="$isa" "${march[@]}" -g0
  done
  compile others.cpp "others_$isa.o" -DMPM_ISA="$isa"
  # the optimizer needs minutes for these with sanitizers
  for kernels in "$src"/transfer/*_isa.cpp; do
    name=$(basename "$kernels" .cpp)
    case $name in polypic_*) continue ;; esac
    compile "$kernels" "${name}_$isa.o" -DMPM_ISA="$isa" "${march[@]}" -O0 -g0
  done
  # as in cmake/mpm_sources.cmake
  for name in aflip_tpic gimp; do
    kernels=kernels_$name.cpp
    [ -e "$kernels" ] || cat >"$kernels" <<CODE
#include "transfer/kernels_isa.h"
#ifdef MPM_HAVE_VECTORS
#include "transfer/kernels_fast.h"
MPM_KERNELS_OF_FILE($name, ${name^^}_FILE)
#endif
CODE
    compile "$kernels" "${name}_isa_$isa.o" -DMPM_ISA="$isa" "${march[@]}" -O0 -g0
  done
done

library=("${objects[@]}")
failed=0
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
unset GTEST_OUTPUT
for test in declare/test_option transfer/test_shape lattice/test_grid mesh/test_gmsh transfer/test_kernels \
  transfer/test_cpdi_kernels material/test_materials; do
  name=${test##*/test_}
  objects=()
  compile "$root/unittest/$test.cpp" "test_$name.o" -DMPM_SOURCE_DIR="\"$root\""
  "$cxx" "${flags[@]}" "test_$name.o" "${library[@]}" -lgmock -lgtest_main -lgtest -lpthread \
    -o "test_$name" || { echo "cannot link test_$name"; exit 1; }
  echo "== test_$name"
  "./test_$name" --gtest_brief=1 --gtest_filter=-*avx512* || failed=1
done
exit $failed
