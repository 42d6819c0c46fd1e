#!/usr/bin/env bash
# breve as a part of another project: configures a host of hosts/ and looks at what came of it.
# Usage: host.sh REPOSITORY CXX-COMPILER CASE
set -uo pipefail

repository=$(realpath "$1")
compiler=$2
case=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

: >"$scratch/said"
fail() {
  echo "$1"
  tail -n 40 "$scratch/said"
  exit 1
}

# configure HOST [OPTION…]
configure() {
  local host=$1
  shift
  rm -rf "$scratch/build"
  env -u CFLAGS -u CXXFLAGS cmake -S "$repository/tests/package/hosts/$host" -B "$scratch/build" -G Ninja \
    -DBREVE_SOURCE="$repository" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "$@" \
    >"$scratch/said" 2>&1
}

configures() { configure "$@" || fail "host $1 does not configure"; }
refused() { ! configure "$@" || fail "host $1 configures and should not"; }

# CMake breaks its messages into lines.
says() { tr -s ' \n' ' ' <"$scratch/said" | grep -F -- "$1" >/dev/null || fail "does not say: $1"; }

# commands [-v] TEXT: the commands that compile breve's runtime have it, or with -v do not. What draws is a library of its
# own and links none of the optional parts.
commands() {
  local want=1
  [[ $1 != -v ]] || { want=0; shift; }
  grep -F '"command"' "$scratch/build/compile_commands.json" | grep -F -- "$repository/runtime/" |
    grep -vF -- "$repository/runtime/render/" >"$scratch/commands"
  [[ -s $scratch/commands ]] || fail "compiles nothing of breve"
  local with all
  with=$(grep -cE -- "$1" "$scratch/commands")
  all=$(wc -l <"$scratch/commands")
  ((with == want * all)) || fail "of $all commands $with have $1"
}

# To the end of the list: who stops to listen breaks the pipe.
has_target() { ninja -C "$scratch/build" -t targets all | grep "^$1: " >/dev/null; }

# As though only what the library needs were installed.
bare=()
for package in CLI11 nlohmann_json GTest; do bare+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"); done

case $case in
  added | fetched)
    host=subproject
    [[ $case == added ]] || host=fetched
    configures "$host" "${bare[@]}"
    commands -v '-Werror|-Wall'
    commands ' -O2 '
    ! has_target breve_command || fail "builds the command"
    ! has_target flock_c || fail "builds samples"
    ;;
  optimised_as_the_host_says)
    configures subproject -DCMAKE_BUILD_TYPE=Debug
    commands -v ' -O'
    configures subproject -DCMAKE_CXX_FLAGS=-O1
    commands ' -O1 '
    commands -v ' -O2 '
    ;;
  command_if_asked_for)
    configures subproject -DBREVE_WITH_COMMAND=ON
    has_target breve_command || fail "does not build the command"
    ;;
  lua_if_asked_for)
    configures subproject
    ! has_target game_lua || fail "builds what runs agents in Lua"
    configures subproject -DBREVE_WITH_LUA=ON
    has_target game_lua || fail "has no breve::lua"
    ;;
  only_c)
    refused only_c
    says 'project(game LANGUAGES C CXX)'
    ;;
  other_box2d)
    refused other_box2d
    says 'has a target box2d::box2d that find_package(box2d) did not make'
    says 'BREVE_HOST_TARGETS'
    configures other_box2d -DACCEPT=ON
    commands 'MY_BOX2D'
    ;;
  late_box2d)
    configures late_box2d
    ! grep -q libmy_box2d "$scratch/build/build.ninja" || fail "links the Box2D of the host"
    ;;
  same_packages)
    configures same_packages
    ! grep -q 'libBulletCollision-float64' "$scratch/build/build.ninja" || fail "links Bullet with doubles"
    grep -q 'libBulletCollision\.so' "$scratch/build/build.ninja" || fail "does not link the host's Bullet"
    ;;
  without_parts)
    configures subproject -DBREVE_WITH_PLANAR=OFF -DBREVE_WITH_MESHES=OFF -DCMAKE_DISABLE_FIND_PACKAGE_box2d=ON
    commands -v 'B2_SHARED'
    commands 'BREVE_WITHOUT_PLANAR'
    ! grep -qE 'libbox2d|libassimp' "$scratch/build/build.ninja" || fail "links what was left out"
    ;;
  minimum_is_what_presets_need)
    # The first release of CMake that reads each version of CMakePresets.json.
    declare -A first=([3]=3.21 [4]=3.23 [5]=3.24 [6]=3.25 [7]=3.27)
    version=$(sed -n 's/.*"version": *\([0-9]*\).*/\1/p' "$repository/CMakePresets.json" | head -1)
    minimum=$(sed -n 's/^cmake_minimum_required(VERSION \([0-9.]*\)).*/\1/p' "$repository/CMakeLists.txt")
    [[ $minimum == "${first[$version]}" ]] || fail "presets of version $version need ${first[$version]}, not $minimum"
    ;;
  built)
    configures subproject -DBREVE_WITH_LUA=ON
    cmake --build "$scratch/build" --target game game_lua >"$scratch/said" 2>&1 || fail "does not build"
    [[ $("$scratch/build/game") == stepped ]] || fail "does not step"
    [[ $("$scratch/build/game_lua") == stepped ]] || fail "does not step with agents in Lua"
    ;;
  *) fail "no case $case" ;;
esac
