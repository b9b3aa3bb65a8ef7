# shellcheck shell=bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Shell functions shared by tools/*.sh: distribution packages, the LAMMPS
# sources, and the stock LAMMPS that is built once per machine into a cache.

repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cache=${MPM_CACHE:-$HOME/.cache/lammps-mpm}
build=${MPM_BUILD_DIR:-$repo/build}
sizes=${MPM_SIZES:-SMALLBIG}
# nproc would take OMP_NUM_THREADS for the number of cores
jobs=${MPM_JOBS:-$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc)}

say() { printf '== %s\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# one set-up at a time; a lock ends with the process or with the next lock
lock() {
  exec 9>"$1"
  flock -n 9 || { say "another build is running (${1##*/}), waiting for it"; flock 9; }
}
unlock() { exec 9>&-; }

# ---------------------------------------------------------------- packages

# packages_needed [all]: one line per need, what it is for, then the Debian packages; all: for the tests,
# benchmarks, and the manual, too
packages_needed() {
  cat <<'LIST'
compiling: build-essential cmake
parallel runs: libopenmpi-dev openmpi-bin
small matrices: libeigen3-dev
Fourier transforms: libfftw3-dev
pictures and compressed files: libpng-dev zlib1g-dev
unpacking LAMMPS: xz-utils dpkg-dev
tables: python3 python3-numpy
LIST
  [ "${1:-}" = all ] && cat <<'LIST'
tests and benchmarks: libgtest-dev libgmock-dev libbenchmark-dev
plots: python3-matplotlib
manual: python3-sphinx python3-sphinx-rtd-theme libjs-mathjax
format of the sources: clang-format
faster compilation: ccache
LIST
  return 0
}

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}\n' "$1" 2>/dev/null | head -1)" = installed ]
}

# install_packages [all]
install_packages() {
  command -v dpkg-query >/dev/null || { say "not a Debian system: assuming the tools are installed"; return 0; }
  local line pkg need=() missing=()
  while IFS= read -r line; do
    need=()
    for pkg in ${line#*: }; do is_installed "$pkg" || need+=("$pkg"); done
    [ ${#need[@]} -eq 0 ] && continue
    say "missing for ${line%%:*}: ${need[*]}"
    missing+=("${need[@]}")
  done < <(packages_needed "$@")
  [ ${#missing[@]} -eq 0 ] && return 0

  local root=() opts=(-y -q --no-install-recommends)
  if [ "$(id -u)" -ne 0 ]; then
    if sudo -n true 2>/dev/null; then
      root=(sudo -n)
    else
      say "neither root nor passwordless sudo; please run this once, then start again:"
      echo "sudo apt-get update && sudo apt-get install ${opts[*]} ${missing[*]}"
      exit 1
    fi
  fi
  say "installing ${missing[*]}"
  local get=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get)
  "${get[@]}" install "${opts[@]}" "${missing[@]}" >/dev/null 2>&1 ||
    { "${get[@]}" update -q >/dev/null && "${get[@]}" install "${opts[@]}" "${missing[@]}" >/dev/null; } ||
    die "could not install: ${missing[*]}"
}

# ---------------------------------------------------------------- sources

# version -> file, sha256 and size of Debian's source archive, upstream tag
lammps_archive() {
  case $1 in
    20260704) echo lammps_20260704+dfsg.orig.tar.gz \
                   cddbc45a047416bd48a4a0b87f24a5b61b3446982b74d18cafe619c22b17eb62 4Jul2026 ;;
    20250204) echo lammps_20250204+dfsg.1.orig.tar.xz \
                   3671165bd52fad36734e0a9136c5bc5ecb225e03988f8c89aa13366a8b53b1c7 4Feb2025 ;;
    *) die "MPM_LAMMPS=$1 is not known; use 20260704 or 20250204" ;;
  esac
}

# the system's main Debian archive as "[options] uri", from either format of apt sources
debian_archive() {
  local f
  for f in /etc/apt/sources.list.d/*.sources; do
    [ -e "$f" ] && awk -v RS= '
      { types = uris = key = suites = comps = ""
        n = split($0, line, "\n")
        for (i = 1; i <= n; i++) {
          field = line[i]; value = line[i]
          sub(/:.*/, "", field); sub(/^[^:]*:[ \t]*/, "", value); field = tolower(field)
          if (field == "types") types = value
          if (field == "uris") { split(value, u, /[ \t]+/); uris = u[1] }
          if (field == "suites") suites = value
          if (field == "components") comps = value
          if (field == "signed-by") key = value
          if (field == "enabled" && tolower(value) == "no") types = ""
        }
        if (types ~ /deb/ && comps ~ /main/ && uris ~ /debian/ && suites !~ /security/ && uris !~ /security/)
          print (key ~ /^\// ? "[signed-by=" key "] " : "") uris }' "$f"
  done
  for f in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ -e "$f" ] && awk '
      $1 == "deb" || $1 == "deb-src" {
        opt = ""; i = 2
        if ($2 ~ /^\[/) { for (; i <= NF; i++) { opt = opt $i " "; if ($i ~ /\]$/) { i++; break } } }
        if ($i ~ /debian/ && $i !~ /security/ && $(i + 1) !~ /security/ && $0 ~ / main/) print opt $i }' "$f"
  done
}

# download_debian VERSION DIR: the original source archive of Debian's lammps package
download_debian() {
  local version=$1 dir=$2 file sha tag entry suite suites tmp opts pkg
  read -r file sha tag < <(lammps_archive "$version")
  command -v apt-get >/dev/null || return 1
  entry=$(debian_archive | head -1)
  [ -n "$entry" ] || { say "no Debian archive found in apt's sources"; return 1; }
  suites="sid forky"; [ "$version" = 20250204 ] && suites=trixie
  mkdir -p "$dir"
  for suite in $suites; do
    tmp=$(mktemp -d)
    mkdir -p "$tmp"/lists/partial "$tmp"/cache/archives/partial
    echo "deb-src $entry $suite main" > "$tmp/sources.list"
    opts=(-q -o Dir::Etc::SourceList="$tmp/sources.list" -o Dir::Etc::SourceParts=-
          -o Dir::State::Lists="$tmp/lists" -o Dir::Cache="$tmp/cache" -o Acquire::Retries=2
          -o APT::Get::List-Cleanup=0 -o Acquire::Languages=none)
    [ "$(id -u)" -eq 0 ] && opts+=(-o APT::Sandbox::User=root)
    say "asking the Debian archive ($suite) for $file"
    apt-get "${opts[@]}" update >"$tmp/log" 2>&1
    pkg=$(apt-cache "${opts[@]}" showsrc lammps 2>/dev/null |
          sed -n 's/^Version: //p' | grep "^$version" | head -1)
    if [ -n "$pkg" ]; then
      (cd "$dir" && apt-get "${opts[@]}" source --download-only --tar-only "lammps=$pkg") >>"$tmp/log" 2>&1
    fi
    if [ -f "$dir/$file" ] && echo "$sha  $dir/$file" | sha256sum -c --quiet - 2>/dev/null; then
      rm -rf "$tmp"
      return 0
    fi
    tail -2 "$tmp/log" | sed 's/^/   /'
    rm -rf "$tmp" "${dir:?}/$file"
  done
  return 1
}

# get_sources VERSION: unpack into $cache/VERSION/src, sets LAMMPS_SOURCE_DIR
get_sources() {
  local version=$1 dest=$cache/$1/src new=$cache/$1/src.new top file sha tag
  read -r file sha tag < <(lammps_archive "$version")
  LAMMPS_SOURCE_DIR=$dest
  [ -e "$dest/.complete" ] && return 0
  mkdir -p "$cache"
  lock "$cache/$version.lock"
  [ -e "$dest/.complete" ] && return 0
  rm -rf "$new" "$dest"
  mkdir -p "$new"
  if [ -n "${MPM_LAMMPS_GIT:-}" ] &&
     timeout 120 git clone -q --depth 1 --branch "patch_$tag" "$MPM_LAMMPS_GIT" "$new" 2>/dev/null; then
    say "cloned LAMMPS patch_$tag"
  elif rm -rf "$new" && mkdir "$new" && download_debian "$version" "$cache/download"; then
    say "unpacking $file"
    tar -C "$new" --exclude=examples --exclude=bench -xf "$cache/download/$file" || return 1
    rm -f "$cache/download/$file"
  else
    rm -rf "$new"
    return 1
  fi
  # the archive has one folder at the top or none
  top=$(find "$new" -maxdepth 3 -path '*/src/version.h' | head -1)
  [ -n "$top" ] || { say "no src/version.h in the LAMMPS sources"; return 1; }
  top=${top%/src/version.h}
  touch "$top/.complete"
  mv "$top" "$dest"
  rm -rf "$new"
}

# ---------------------------------------------------------------- stock LAMMPS

# configure_stock: LAMMPS without our package, sets LAMMPS_BUILD_DIR and holds its lock; false when it is built already
configure_stock() {
  local key name log
  key=$(cat "$repo"/cmake/lammps_stock.cmake "$repo"/cmake/lammps_export.cmake \
            <(c++ -dumpfullversion -dumpmachine; echo "$LAMMPS_SOURCE_DIR") | sha256sum | cut -c1-8)
  name=$(lammps_version | tr -d ' ')
  LAMMPS_BUILD_DIR=$cache/build-$name-$sizes-$key
  [ -e "$LAMMPS_BUILD_DIR/.complete" ] && return 1

  lock "$LAMMPS_BUILD_DIR.lock"
  [ -e "$LAMMPS_BUILD_DIR/.complete" ] && return 1
  mkdir -p "$LAMMPS_BUILD_DIR"
  cp "$repo"/cmake/lammps_stock.cmake "$repo"/cmake/lammps_export.cmake "$LAMMPS_BUILD_DIR"
  log=$LAMMPS_BUILD_DIR/build.log
  (cd "$LAMMPS_BUILD_DIR" &&
   cmake -S "$LAMMPS_SOURCE_DIR/cmake" -B . -G "Unix Makefiles" -C lammps_stock.cmake \
         -D LAMMPS_SIZES="${sizes,,}" \
         -D CMAKE_PROJECT_lammps_INCLUDE="$LAMMPS_BUILD_DIR/lammps_export.cmake") >"$log" 2>&1 ||
    { tail -20 "$log"; die "configuring LAMMPS failed, see $log"; }
}

# build_stock: the whole of it, once per machine
build_stock() {
  configure_stock || return 0
  say "building stock LAMMPS $(lammps_version) ($sizes) once for this machine; takes a few minutes"
  make_progress "$LAMMPS_BUILD_DIR" lmp || die "building LAMMPS failed, see $LAMMPS_BUILD_DIR/build.log"
  touch "$LAMMPS_BUILD_DIR/.complete"
}

# build_stock_objects FILE: the object files of this list
build_stock_objects() {
  local log=$LAMMPS_BUILD_DIR/build.log
  make -C "$LAMMPS_BUILD_DIR" gitversion >>"$log" 2>&1 || die "building LAMMPS failed, see $log"
  # shellcheck disable=SC2046
  make -C "$LAMMPS_BUILD_DIR" -j "$jobs" -f CMakeFiles/lammps.dir/build.make $(cat "$1") 2>&1 |
    tee -a "$log" | show_progress "$(wc -l <"$1")"
  [ "${PIPESTATUS[0]}" -eq 0 ] || die "building LAMMPS failed, see $log"
}

# make_progress DIR TARGET...: build; all output to DIR/build.log
make_progress() {
  local dir=$1 log=$1/build.log
  shift
  cmake --build "$dir" -j "$jobs" --target "$@" 2>&1 | tee -a "$log" | show_progress
  return "${PIPESTATUS[0]}"
}

# show_progress [FILES]: output of make -> its errors, and percentages with the time that is left; with a
# number of files, of these files
show_progress() {
  local line p=0 last=0 shown=0 files=0 start=$SECONDS left
  while IFS= read -r line; do
    [[ $line == *"CMake Error"* ]] && shown=8
    if [ "$shown" -gt 0 ]; then shown=$((shown - 1)); echo "$line"; continue; fi
    if [[ $line =~ (warning:|error:|\*\*\*|undefined reference|multiple definition) ]]; then
      echo "$line"
      continue
    fi
    if [ -n "${1:-}" ]; then
      [[ $line == *"Building CXX"* ]] && files=$((files + 1))
      p=$((100 * files / ($1 + 1)))
    elif [[ $line =~ ^\[\ *([0-9]+)%\] ]]; then
      p=${BASH_REMATCH[1]}
    fi
    [ "$p" -ge $((last + 10)) ] || continue
    last=$p
    left=
    if [ $((SECONDS - start)) -ge 5 ] && [ "$p" -lt 100 ]; then
      left=$(((SECONDS - start) * (100 - p) / p))
      left=$(printf ', about %d:%02d minutes left' $((left / 60)) $((left % 60)))
    fi
    printf '   %3d %%%s\n' "$p" "$left"
  done
}

# setup [all]: what all scripts begin with: packages, sources, stock LAMMPS
setup() {
  install_packages "$@"
  find_sources
  build_stock
  unlock
}

find_sources() {
  mkdir -p "$cache"
  if [ -n "${LAMMPS_SOURCE_DIR:-}" ]; then
    LAMMPS_SOURCE_DIR=$(cd "$LAMMPS_SOURCE_DIR" && pwd) || exit 1
    [ "${LAMMPS_SOURCE_DIR##*/}" = src ] && [ -e "$LAMMPS_SOURCE_DIR/version.h" ] &&
      LAMMPS_SOURCE_DIR=${LAMMPS_SOURCE_DIR%/src}
    [ -e "$LAMMPS_SOURCE_DIR/src/version.h" ] || die "$LAMMPS_SOURCE_DIR is not a LAMMPS source tree"
  elif [ -n "${MPM_LAMMPS:-}" ]; then
    get_sources "$MPM_LAMMPS" || die "could not get LAMMPS $MPM_LAMMPS; set LAMMPS_SOURCE_DIR"
  elif ! get_sources 20260704; then
    say "LAMMPS 4 Jul 2026 cannot be had here, falling back to 4 Feb 2025"
    get_sources 20250204 || die "could not get the LAMMPS sources; set LAMMPS_SOURCE_DIR"
  fi
}

# ---------------------------------------------------------------- this package

lammps_version() { sed -n 's/.*"\(.*\)".*/\1/p' "$LAMMPS_SOURCE_DIR/src/version.h"; }

# compiler_cache: objects of earlier builds, also of other clones, are taken again where nothing has changed.
# Sets the variables of ccache, and launcher, an option for cmake
compiler_cache() {
  command -v ccache >/dev/null || return 0
  export CCACHE_DIR=$cache/ccache CCACHE_BASEDIR=$repo CCACHE_NOHASHDIR=1 CCACHE_MAXSIZE=5G
  # precompiled headers need these; to trust the times of headers, too, would store one that was edited meanwhile
  export CCACHE_SLOPPINESS=pch_defines,time_macros
  launcher="-D CMAKE_CXX_COMPILER_LAUNCHER=ccache"
}

# configure_project [OPTION...]: when needed; holds the lock of the build tree
configure_project() {
  local tests=off launcher= args
  compiler_cache
  is_installed libgtest-dev && tests=on
  command -v dpkg-query >/dev/null || tests=on
  mkdir -p "$build"
  build=$(cd "$build" && pwd)
  lock "$build/.lock"
  args="-D LAMMPS_BUILD_DIR=$LAMMPS_BUILD_DIR -D MPM_DEMO=off -D MPM_TEST=$tests $launcher $* ${MPM_CMAKE:-}"
  : >"$build/build.log"
  [ -e "$build/Makefile" ] && [ "$(cat "$build/.args" 2>/dev/null)" = "$args" ] && return 0
  say "configuring in $build"
  # shellcheck disable=SC2086
  cmake -S "$repo" -B "$build" -G "Unix Makefiles" $args >>"$build/build.log" 2>&1 ||
    { grep -A8 'CMake Error' "$build/build.log"; die "configuring failed, see $build/build.log"; }
  echo "$args" >"$build/.args"
}

# build_project [TARGET...]: configure when needed, compile our package
build_project() {
  [ $# -gt 0 ] || set -- all
  configure_project
  say "compiling: $*"
  make_progress "$build" cmake_check_build_system || die "configuring failed, see $build/build.log"
  make_progress "$build" "$@" || die "build failed, see $build/build.log"
  unlock
}

# build_demo: an lmp for the demonstration, in less than half of the time where LAMMPS has not been compiled yet;
# false when it has only what the demonstration needs
build_demo() {
  if ! configure_stock; then
    build_project lmp
    return 0
  fi
  configure_project -D MPM_DEMO=on
  lock "$LAMMPS_BUILD_DIR.lock"
  say "compiling the part of LAMMPS that the demonstration needs: $(wc -l <"$build/demo_objects.txt") files"
  build_stock_objects "$build/demo_objects.txt"
  lock "$build/.lock"
  say "compiling the MPM package"
  make_progress "$build" lmp || die "build failed, see $build/build.log"
  unlock
  return 1
}

# ---------------------------------------------------------------- runs

# run_tests [ctest arguments]: results go to $build/results
run_tests() {
  say "testing with LAMMPS $(lammps_version)"
  rm -rf "$build/results"
  mkdir -p "$build/results"
  (cd "$build" && ctest -j "$jobs" --output-on-failure --output-junit results/ctest.xml "$@")
}

# several processes on few cores, also for root (containers)
mpi_environment() {
  export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
  [ "$(id -u)" -eq 0 ] && export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  return 0
}

# a Python that has numpy (the first python3 in the path may be a bare one)
python_with_numpy() {
  local python
  for python in python3 /usr/bin/python3; do
    "$python" -c 'import numpy' 2>/dev/null && { command -v "$python"; return 0; }
  done
  echo python3
}

# output of lmp -echo screen -> steps done, in percent of each run
run_progress() {
  awk '
    /^(ERROR|WARNING)/ { print; fflush() }
    /^run +[0-9]+/ { total = $2; first = ""; last = -5 }
    /^ *Step / { table = 1; next }
    /^Loop time/ { table = 0 }
    table && total > 0 && $1 ~ /^[0-9]+$/ {
      if (first == "") first = $1
      p = int(100 * ($1 - first) / total)
      if (p >= last + 5 || p == 100) {
        printf "   step %d of %d, %d %%\n", $1 - first, total, p; fflush(); last = p } }'
}

# list_files EXTENSION...: number, first and last path of the files made here
list_files() {
  local ext files
  for ext in "$@"; do
    files=$(find "$PWD" -name "*.$ext" | sort -V)
    [ -z "$files" ] && continue
    echo "   $ext ($(echo "$files" | wc -l) files):"
    echo "$files" | sed -n '1s/^/     /p;${1!s/^/ ... /p}'
  done
}
