# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Options of the stock LAMMPS that tools/build.sh builds once per machine
# (cmake -C lammps_stock.cmake).  A change here gives a new cached build.

foreach(pkg PLUGIN GRANULAR RIGID MOLECULE KSPACE MANYBODY GRAPHICS)
  set(PKG_${pkg} ON CACHE BOOL "")
endforeach()
set(BUILD_MPI ON CACHE BOOL "")
set(BUILD_OMP OFF CACHE BOOL "")
set(BUILD_SHARED_LIBS OFF CACHE BOOL "")
set(BUILD_TOOLS OFF CACHE BOOL "")
set(CMAKE_POSITION_INDEPENDENT_CODE ON CACHE BOOL "")
set(WITH_PNG ON CACHE BOOL "")
set(WITH_JPEG OFF CACHE BOOL "")
set(WITH_CURL OFF CACHE BOOL "")
set(WITH_FFMPEG OFF CACHE BOOL "")
set(DOWNLOAD_POTENTIALS OFF CACHE BOOL "")
set(FFT FFTW3 CACHE STRING "")
set(FFT_FFTW_THREADS OFF CACHE BOOL "")
set(CMAKE_BUILD_TYPE Release CACHE STRING "")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "")
