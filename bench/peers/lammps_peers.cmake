# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Options of the LAMMPS that bench/peers/build.sh builds: the other particle
# methods, compiled for the machine at hand, as a careful user would do.

foreach(pkg MACHDYN SPH RHEO BPM PERI GRANULAR MOLECULE)
  set(PKG_${pkg} ON CACHE BOOL "")
endforeach()
set(BUILD_MPI ON CACHE BOOL "")
set(BUILD_OMP OFF CACHE BOOL "")
set(BUILD_SHARED_LIBS OFF CACHE BOOL "")
set(BUILD_TOOLS OFF CACHE BOOL "")
set(DOWNLOAD_EIGEN3 OFF CACHE BOOL "")
set(WITH_PNG OFF CACHE BOOL "")
set(WITH_JPEG OFF CACHE BOOL "")
set(WITH_CURL OFF CACHE BOOL "")
set(WITH_FFMPEG OFF CACHE BOOL "")
set(WITH_GZIP OFF CACHE BOOL "")
set(DOWNLOAD_POTENTIALS OFF CACHE BOOL "")
set(LAMMPS_SIZES "smallbig" CACHE STRING "")
set(CMAKE_BUILD_TYPE Release CACHE STRING "")
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -march=native -DNDEBUG" CACHE STRING "")
# RHEO calls LAPACK, but only other packages link it
set(CMAKE_CXX_STANDARD_LIBRARIES "-llapack -lblas" CACHE STRING "")
