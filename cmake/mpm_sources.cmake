# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# The package's sources and how they are compiled, used by every way to build:
# overlay on a cached LAMMPS, LAMMPS's own build (mpm_inject.cmake), plugin.

include(${CMAKE_CURRENT_LIST_DIR}/mpm_sanitize.cmake)
get_filename_component(MPM_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
set(MPM_DIR ${MPM_ROOT}/src/MPM)

# A room is a folder of src/MPM, see its README.md.  These need no LAMMPS, all others do.
set(MPM_CORE_ROOMS declare image lattice law material math mesh solve table transfer)
set(MPM_SOURCES)
set(MPM_CORE_SOURCES)
set(MPM_ISA_SOURCES)
set(MPM_PLUGIN_SOURCES)
file(GLOB sources CONFIGURE_DEPENDS ${MPM_DIR}/*/*.cpp)
foreach(source ${sources})
  get_filename_component(room ${source} DIRECTORY)
  get_filename_component(room ${room} NAME)
  if(source MATCHES "_isa\\.cpp$")
    list(APPEND MPM_ISA_SOURCES ${source})
  elseif(room STREQUAL plugin)
    list(APPEND MPM_PLUGIN_SOURCES ${source})
  elseif(room IN_LIST MPM_CORE_ROOMS)
    list(APPEND MPM_CORE_SOURCES ${source})
  else()
    list(APPEND MPM_SOURCES ${source})
  endif()
endforeach()
# those that know which instruction sets there are, see transfer/isa.h
set(MPM_SELECT_SOURCES ${MPM_DIR}/transfer/isa.cpp ${MPM_DIR}/law/registry.cpp ${MPM_DIR}/material/batch_kernels.cpp
    ${MPM_DIR}/solve/block_kernels.cpp)
list(REMOVE_ITEM MPM_CORE_SOURCES ${MPM_SELECT_SOURCES})
file(GLOB MPM_HEADERS CONFIGURE_DEPENDS ${MPM_DIR}/*/*.h)

# Style headers by kind, as in LAMMPS's StyleHeaderUtils.cmake:
# MPM_STYLE_KINDS names LAMMPS's style_KIND.h, MPM_STYLE_<KIND> our headers, MPM_STYLE_ROOMS the folders
# that these are in: LAMMPS's own build includes styles by the name of the file alone.
set(MPM_STYLE_ROOMS)
set(MPM_STYLE_KINDS atom command compute dump fix pair region)
foreach(kind ${MPM_STYLE_KINDS})
  set(MPM_STYLE_${kind})
  string(TOUPPER ${kind} class)
  foreach(header ${MPM_HEADERS})
    file(STRINGS ${header} is_style LIMIT_COUNT 1 REGEX "^#if.*[ (]${class}_CLASS")
    if(is_style)
      list(APPEND MPM_STYLE_${kind} ${header})
      get_filename_component(room ${header} DIRECTORY)
      list(APPEND MPM_STYLE_ROOMS ${room})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES MPM_STYLE_ROOMS)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${MPM_HEADERS})

# text with one #include per header of a kind
function(mpm_style_includes kind out)
  set(text)
  foreach(header ${MPM_STYLE_${kind}})
    file(RELATIVE_PATH name ${MPM_DIR} ${header})
    string(APPEND text "#include \"${name}\"\n")
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# write only when different, so that nothing is recompiled without need
function(mpm_write file text)
  if(EXISTS ${file})
    file(READ ${file} old)
    if("${old}" STREQUAL "${text}")
      return()
    endif()
  endif()
  file(WRITE ${file} "${text}")
endfunction()

# The laws of a family are compiled on their own: a file of a few lines for each one of law/list.h.
file(STRINGS ${MPM_DIR}/law/list.h families REGEX "^ +X\\(")
string(REGEX MATCHALL "[a-z]+" families "${families}")
foreach(family ${families})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/mpm_laws/laws_${family}_isa.cpp)
  mpm_write(${source} "#define MPM_ONE_FAMILY\n#define MPM_LAWS_${family}\n#include \"law/list.h\"\nMPM_LAW_FAMILY(${family})\n")
  list(APPEND MPM_ISA_SOURCES ${source})
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${MPM_DIR}/law/list.h)

# add "MPM" to the packages that 'lmp -h' lists as installed
function(mpm_installed_packages lammps_styles dir)
  file(READ ${lammps_styles}/lmpinstalledpkgs.h text)
  string(REPLACE "  NULL\n" "  \"MPM\",\n  NULL\n" text "${text}")
  mpm_write(${dir}/lmpinstalledpkgs.h "${text}")
endfunction()

# Eigen is header-only
find_path(EIGEN3_INCLUDE_DIR Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)

# FFTW, for random fields of parameters and solver fourier of fix mpm/incompressible; without it they are refused
find_path(FFTW3_INCLUDE_DIR fftw3.h)
find_library(FFTW3_LIBRARY fftw3)
set(MPM_LIBRARIES ${CMAKE_DL_LIBS})
set(MPM_FEATURES)
if(FFTW3_INCLUDE_DIR AND FFTW3_LIBRARY)
  list(APPEND MPM_LIBRARIES ${FFTW3_LIBRARY})
  set(MPM_FEATURES MPM_FFTW)
endif()

# zlib, for compressed files of dump mpm/vtk; without it they are refused
find_path(ZLIB_INCLUDE_DIR zlib.h)
find_library(ZLIB_LIBRARY z)
if(ZLIB_INCLUDE_DIR AND ZLIB_LIBRARY)
  list(APPEND MPM_LIBRARIES ${ZLIB_LIBRARY})
endif()

# libpng, for pictures that create_points reads; without it PNG files are refused
find_package(PNG QUIET)
if(PNG_FOUND)
  list(APPEND MPM_LIBRARIES ${PNG_LIBRARIES})
endif()

# Instruction sets for the hot kernels *_isa.cpp: compiled once per set with
# MPM_ISA = base, v3, v4; MPM_HAVE_V3, MPM_HAVE_V4 tell the dispatcher which exist.
# Functions there must be in namespaces named by MPM_ISA or have internal linkage:
# a shared inline function compiled for v4 could end up in the baseline's place.
include(CheckCXXCompilerFlag)
set(MPM_ISA_FLAGS_base)
set(MPM_ISA_FLAGS_v3 -march=x86-64-v3)
set(MPM_ISA_FLAGS_v4 -march=x86-64-v4 -mprefer-vector-width=512)
set(MPM_ISA_SETS base)
set(MPM_ISA_DEFINITIONS)
foreach(isa v3 v4)
  string(TOUPPER ${isa} ISA)
  string(REPLACE ";" " " flags "${MPM_ISA_FLAGS_${isa}}")
  set(CMAKE_REQUIRED_QUIET ON)
  check_cxx_compiler_flag("${flags}" MPM_COMPILER_HAS_${ISA})
  if(MPM_COMPILER_HAS_${ISA})
    list(APPEND MPM_ISA_SETS ${isa})
    list(APPEND MPM_ISA_DEFINITIONS MPM_HAVE_${ISA})
  endif()
endforeach()

# The best set of this machine
set(MPM_ISA_BEST base)
if(EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo flags LIMIT_COUNT 1 REGEX "^flags")
  if("v3" IN_LIST MPM_ISA_SETS AND "${flags} " MATCHES " avx2 " AND "${flags} " MATCHES " fma " AND "${flags} " MATCHES " bmi2 ")
    set(MPM_ISA_BEST v3)
    if("v4" IN_LIST MPM_ISA_SETS AND "${flags} " MATCHES " avx512f " AND "${flags} " MATCHES " avx512vl " AND
       "${flags} " MATCHES " avx512dq " AND "${flags} " MATCHES " avx512bw " AND "${flags} " MATCHES " avx512cd ")
      set(MPM_ISA_BEST v4)
    endif()
  endif()
endif()

# To test a change soon, half of the time of the compiler is left out: of the instruction sets there are the baseline and the
# best one of this machine, all is optimized less, and headers that nearly all include are compiled once.
option(MPM_QUICK "Compile the package in less time, for tests" OFF)
set(MPM_LEVEL -O3)
if(MPM_QUICK)
  set(MPM_LEVEL -O1)
endif()

# For the demonstration, which is to show its first picture soon: of the sets only that.  All that it
# compiles has the flags of the whole package, which has only the rest to compile then.
set(MPM_ISA_HERE)
if(MPM_DEMO AND EXISTS /proc/cpuinfo)
  set(MPM_ISA_HERE ${MPM_ISA_BEST})
endif()

# So are the transfers of each shape.  In the demonstration there are no fast ones but those of its scene: the file of
# another shape is an empty one, which the whole package has compiled again as it has another content.
foreach(shape linear quadratic cubic gimp bernstein cpdi cpdi2)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/mpm_kernels/${shape}_isa.cpp)
  string(TOUPPER ${shape} upper)
  set(text "#include \"transfer/kernels_isa.h\"\n#ifdef MPM_HAVE_VECTORS\n")
  if(MPM_ISA_HERE AND NOT shape STREQUAL quadratic)
    set(text "#include \"transfer/kernels_isa.h\"\nusing namespace MPM_NS;\n#ifdef MPM_HAVE_VECTORS\n")
    string(APPEND text "TransferKernels MPM_NS::MPM_OF_ISA(mpm_kernels_${shape})(const KernelChoice &) { return {}; }\n#endif\n")
    mpm_write(${source} "${text}")
    list(APPEND MPM_ISA_SOURCES ${source})
    continue()
  endif()
  if(shape MATCHES "cpdi")
    string(APPEND text "#include \"transfer/kernels_cpdi.h\"\nMPM_DOMAIN_KERNELS_OF_SHAPE")
  else()
    string(APPEND text "#include \"transfer/kernels_fast.h\"\nMPM_KERNELS_OF_SHAPE")
  endif()
  mpm_write(${source} "${text}(${shape}, ${upper})\n#endif\n")
  list(APPEND MPM_ISA_SOURCES ${source})
endforeach()

# Products of functions along axes gain nothing by -O3.  With -O1 a step is a tenth slower: for the baseline, where there is a
# better set for all processors but old ones.  Else laws and domains need -O3.  (bench_kernels, bench_materials)
set(base "$<STREQUAL:$<TARGET_PROPERTY:NAME>,mpm_isa_base>")
if(MPM_QUICK)
  set(base 1)
elseif(NOT "v3" IN_LIST MPM_ISA_SETS)
  set(base 0)
endif()
foreach(source ${MPM_ISA_SOURCES})
  set(level -O3)
  if(source MATCHES "/mpm_kernels/" AND NOT source MATCHES "cpdi")
    set(level -O2)
  endif()
  set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "$<IF:${base},-O1,${level}>")
endforeach()

if(MPM_ISA_HERE OR MPM_QUICK)
  set(MPM_ISA_SETS ${MPM_ISA_BEST})
  set(MPM_ISA_DEFINITIONS)
  if(NOT MPM_ISA_BEST STREQUAL base)
    string(TOUPPER ${MPM_ISA_BEST} ISA)
    set(MPM_ISA_DEFINITIONS MPM_HAVE_${ISA})
    if(MPM_ISA_HERE)
      list(APPEND MPM_ISA_DEFINITIONS MPM_HAVE_NO_BASE)
    else()
      list(PREPEND MPM_ISA_SETS base)
    endif()
  endif()
endif()
set(MPM_ISA_OPTIONS -O3 -ffp-contract=fast -fno-math-errno -fno-trapping-math -fopenmp-simd)

# Object libraries: what needs no LAMMPS, and with the headers of one
function(mpm_core_library name)
  add_library(${name} OBJECT ${ARGN})
  target_compile_features(${name} PRIVATE cxx_std_17)
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
  target_compile_options(${name} PRIVATE $<$<NOT:$<CONFIG:Debug>>:${MPM_LEVEL}> -Wall -Wextra)
  target_include_directories(${name} PRIVATE ${MPM_DIR})
  target_include_directories(${name} SYSTEM PRIVATE ${EIGEN3_INCLUDE_DIR})
  if(MPM_FEATURES)
    target_include_directories(${name} SYSTEM PRIVATE
      "$<FILTER:${FFTW3_INCLUDE_DIR},EXCLUDE,^/usr/include$>")
  endif()
endfunction()

function(mpm_object_library name)
  mpm_core_library(${name} ${ARGN})
  target_include_directories(${name} SYSTEM PRIVATE "$<FILTER:${MPM_LAMMPS_INCLUDES},EXCLUDE,^/usr/include$>")
  target_compile_definitions(${name} PRIVATE ${MPM_LAMMPS_DEFINITIONS})
endfunction()

# The core is what needs no LAMMPS, kernels and laws among it: two thirds of the work.  Other builds of these
# sources, for another LAMMPS, can take it from this one.
set(MPM_CORE_DIR "" CACHE PATH "Build tree of these sources whose core is taken, instead of compiling it again")
string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
set(MPM_CORE_FLAGS "${CMAKE_CXX_COMPILER} ${CMAKE_CXX_COMPILER_VERSION} ${config} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}}")
string(APPEND MPM_CORE_FLAGS " ${MPM_SANITIZERS} ${MPM_FEATURES} ${EIGEN3_INCLUDE_DIR} ${PNG_LIBRARIES} ${ZLIB_LIBRARY}")

# objects of the core in another build tree, which is brought up to date first
function(mpm_core_elsewhere out)
  if(NOT EXISTS ${MPM_CORE_DIR}/mpm_core.cmake)
    message(FATAL_ERROR "MPM_CORE_DIR=${MPM_CORE_DIR} is no build tree of the MPM package")
  endif()
  include(${MPM_CORE_DIR}/mpm_core.cmake)
  set(same "${MPM_ROOT}; ${MPM_CORE_FLAGS}; ${MPM_ISA_SETS}")
  if(NOT OTHER_CORE STREQUAL same)
    message(FATAL_ERROR "The core in MPM_CORE_DIR=${MPM_CORE_DIR} is another one:\n${OTHER_CORE}\ninstead of\n${same}")
  endif()
  set(command ${CMAKE_COMMAND} --build ${MPM_CORE_DIR} --target)
  if(CMAKE_GENERATOR MATCHES "Makefiles" AND OTHER_GENERATOR MATCHES "Makefiles")
    set(command "$(MAKE)" -C ${MPM_CORE_DIR})
  endif()
  add_custom_target(mpm_core_elsewhere COMMAND ${command} ${OTHER_TARGETS} BYPRODUCTS ${OTHER_OBJECTS} VERBATIM
    COMMENT "Core of the package in ${MPM_CORE_DIR}")
  set_source_files_properties(${OTHER_OBJECTS} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set(${out} ${OTHER_OBJECTS} PARENT_SCOPE)
endfunction()

# for all that takes MPM_OBJECTS as sources
function(mpm_depends_on_core target)
  if(TARGET mpm_core_elsewhere)
    add_dependencies(${target} mpm_core_elsewhere)
  endif()
endfunction()

function(mpm_core out)
  if(MPM_CORE_DIR)
    mpm_core_elsewhere(objects)
    set(${out} ${objects} PARENT_SCOPE)
    return()
  endif()
  mpm_core_library(mpm_core ${MPM_CORE_SOURCES})
  target_compile_definitions(mpm_core PRIVATE ${MPM_FEATURES})
  if(PNG_FOUND)
    set_property(SOURCE ${MPM_DIR}/image/png.cpp APPEND PROPERTY COMPILE_DEFINITIONS MPM_PNG)
    target_include_directories(mpm_core SYSTEM PRIVATE "$<FILTER:${PNG_INCLUDE_DIRS},EXCLUDE,^/usr/include$>")
  endif()
  if(ZLIB_INCLUDE_DIR AND ZLIB_LIBRARY)
    set_property(SOURCE ${MPM_DIR}/table/vtk_xml.cpp APPEND PROPERTY COMPILE_DEFINITIONS MPM_ZLIB)
    target_include_directories(mpm_core SYSTEM PRIVATE "$<FILTER:${ZLIB_INCLUDE_DIR},EXCLUDE,^/usr/include$>")
  endif()
  mpm_sanitize(mpm_core)
  # on their own, as the demonstration has other sets
  mpm_core_library(mpm_select ${MPM_SELECT_SOURCES})
  target_compile_definitions(mpm_select PRIVATE ${MPM_ISA_DEFINITIONS})
  mpm_sanitize(mpm_select)
  # a statement of what transfers do, and the measure in tests, but not what runs
  set_property(SOURCE ${MPM_DIR}/transfer/kernels_reference.cpp APPEND PROPERTY COMPILE_OPTIONS -O1)
  set(targets mpm_core mpm_select)
  set(objects $<TARGET_OBJECTS:mpm_core> $<TARGET_OBJECTS:mpm_select>)
  foreach(isa ${MPM_ISA_SETS})
    mpm_core_library(mpm_isa_${isa} ${MPM_ISA_SOURCES})
    target_compile_definitions(mpm_isa_${isa} PRIVATE MPM_ISA=${isa})
    target_compile_options(mpm_isa_${isa} PRIVATE ${MPM_ISA_OPTIONS} ${MPM_ISA_FLAGS_${isa}})
    list(APPEND targets mpm_isa_${isa})
    list(APPEND objects $<TARGET_OBJECTS:mpm_isa_${isa}>)
  endforeach()
  # read by mpm_core_elsewhere
  file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/mpm_core.cmake CONTENT
"set(OTHER_CORE \"${MPM_ROOT}; ${MPM_CORE_FLAGS}; ${MPM_ISA_SETS}\")
set(OTHER_GENERATOR \"${CMAKE_GENERATOR}\")
set(OTHER_TARGETS ${targets})
set(OTHER_OBJECTS \"${objects}\")
")
  set(${out} ${objects} PARENT_SCOPE)
endfunction()

# Object libraries for the whole package; the global property MPM_OBJECTS lists
# them for use as sources.  Before: MPM_LAMMPS_INCLUDES, MPM_LAMMPS_DEFINITIONS
# = how LAMMPS is compiled.
function(mpm_add_objects)
  mpm_core(core)
  mpm_object_library(mpm_objects ${MPM_SOURCES})
  target_compile_definitions(mpm_objects PRIVATE ${MPM_FEATURES})
  if(ZLIB_INCLUDE_DIR AND ZLIB_LIBRARY)
    set_property(SOURCE ${MPM_DIR}/output/mpm_vtk.cpp APPEND PROPERTY COMPILE_DEFINITIONS MPM_ZLIB)
    target_include_directories(mpm_objects SYSTEM PRIVATE "$<FILTER:${ZLIB_INCLUDE_DIR},EXCLUDE,^/usr/include$>")
  endif()
  mpm_sanitize(mpm_objects)
  # headers are half of the work; none of the package itself, so that a change of one is one of those who include it
  target_precompile_headers(mpm_objects PRIVATE <algorithm> <array> <cmath> <cstring> <functional> <limits> <list>
    <map> <memory> <string> <unordered_map> <vector> [["atom.h"]] [["comm.h"]] [["compute.h"]]
    [["error.h"]] [["fix.h"]] [["force.h"]] [["group.h"]] [["math_extra.h"]] [["memory.h"]] [["modify.h"]]
    [["neighbor.h"]] [["pointers.h"]] [["update.h"]] [["utils.h"]])
  if(MPM_QUICK)
    target_precompile_headers(mpm_objects PRIVATE [["base/mpm_input.h"]] [["base/mpm_options.h"]] [["field/mpm_field.h"]]
      [["field/mpm_plan.h"]])
  endif()
  set_property(GLOBAL PROPERTY MPM_OBJECTS $<TARGET_OBJECTS:mpm_objects> ${core})
endfunction()
