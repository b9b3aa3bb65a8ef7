# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# LAMMPS with our package in its style lists, from a stock LAMMPS that is built
# already (LAMMPS_BUILD_DIR, made by tools/build.sh).  Only the few LAMMPS files
# that include a style list are compiled again, with our headers added to it;
# linked before liblammps.a they take the place of the stock ones.

include(${LAMMPS_BUILD_DIR}/mpm_lammps.cmake)
list(REMOVE_DUPLICATES LAMMPS_INCLUDE_DIRS)
list(REMOVE_ITEM LAMMPS_INCLUDE_DIRS /usr/include)
set(MPM_LAMMPS_DEFINITIONS ${LAMMPS_DEFINITIONS})
set(MPM_LAMMPS_INCLUDES ${LAMMPS_INCLUDE_DIRS})
include(GNUInstallDirs)
set(MPM_STYLES_DIR ${CMAKE_BINARY_DIR}/styles)

mpm_add_objects()
get_property(MPM_OBJECTS GLOBAL PROPERTY MPM_OBJECTS)

option(MPM_DEMO "Only what the demonstration needs, see mpm_demo.cmake" OFF)
if(MPM_DEMO)
  include(${CMAKE_CURRENT_LIST_DIR}/mpm_demo.cmake)
elseif(EXISTS ${CMAKE_BINARY_DIR}/demo_objects.txt)
  file(REMOVE_RECURSE ${MPM_STYLES_DIR} ${CMAKE_BINARY_DIR}/demo_objects.txt)
endif()

# style lists: the stock list and ours
set(lists)
foreach(kind ${MPM_STYLE_KINDS})
  if(MPM_STYLE_${kind})
    if(MPM_DEMO)
      mpm_demo_list(${kind} stock)
    else()
      file(READ ${LAMMPS_BUILD_DIR}/styles/style_${kind}.h stock)
    endif()
    mpm_style_includes(${kind} ours)
    mpm_write(${MPM_STYLES_DIR}/style_${kind}.h "${stock}${ours}")
    list(APPEND lists ${kind})
  endif()
endforeach()
mpm_installed_packages(${LAMMPS_BUILD_DIR}/styles ${MPM_STYLES_DIR})

# the LAMMPS files that include one of these lists
string(REPLACE ";" "|" lists "${lists}")
file(GLOB sources ${LAMMPS_DIR}/src/*.cpp)
set(LAMMPS_STYLE_SOURCES)
foreach(source ${sources})
  file(STRINGS ${source} hit LIMIT_COUNT 1 REGEX "^#include \"(lmpinstalledpkgs|style_(${lists}))\\.h\"")
  if(hit)
    list(APPEND LAMMPS_STYLE_SOURCES ${source})
  endif()
endforeach()
add_library(lammps_styles OBJECT ${LAMMPS_STYLE_SOURCES})
target_include_directories(lammps_styles BEFORE PRIVATE ${MPM_STYLES_DIR} ${MPM_DIR})
target_include_directories(lammps_styles SYSTEM PRIVATE ${LAMMPS_INCLUDE_DIRS})
target_compile_definitions(lammps_styles PRIVATE ${LAMMPS_DEFINITIONS})
set_target_properties(lammps_styles PROPERTIES POSITION_INDEPENDENT_CODE ON)

# the libraries that the stock lmp is linked with
file(STRINGS ${LAMMPS_BUILD_DIR}/CMakeFiles/lmp.dir/link.txt link LIMIT_COUNT 1)
string(REGEX REPLACE ".*[ /]liblammps\\.a" "" link "${link}")
separate_arguments(link)

# the rest of LAMMPS
set(LAMMPS_OBJECTS ${LAMMPS_BUILD_DIR}/liblammps.a)
if(MPM_DEMO)
  mpm_demo_objects("${LAMMPS_STYLE_SOURCES}" LAMMPS_OBJECTS)
endif()

# everything but main(): for lmp, tests and benchmarks
add_library(lammps_mpm INTERFACE)
target_sources(lammps_mpm INTERFACE $<TARGET_OBJECTS:lammps_styles> ${MPM_OBJECTS})
mpm_depends_on_core(lammps_mpm)
target_link_libraries(lammps_mpm INTERFACE ${LAMMPS_OBJECTS} ${link}
  ${MPM_LIBRARIES})
target_link_options(lammps_mpm INTERFACE ${MPM_SANITIZERS})

add_executable(lmp ${LAMMPS_DIR}/src/main.cpp)
target_link_libraries(lmp PRIVATE lammps_mpm)
target_include_directories(lmp SYSTEM PRIVATE ${LAMMPS_INCLUDE_DIRS})
target_compile_definitions(lmp PRIVATE ${LAMMPS_DEFINITIONS})
set_target_properties(lmp PROPERTIES ENABLE_EXPORTS ON RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
install(TARGETS lmp RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

if(NOT MPM_DEMO AND NOT MPM_SANITIZE AND CMAKE_SYSTEM_NAME STREQUAL Linux)
  include(${CMAKE_CURRENT_LIST_DIR}/mpm_python.cmake)
endif()
