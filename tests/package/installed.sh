#!/usr/bin/env bash
# breve as an installed package: what a build installs, and programs outside the tree that are built against it.
# Usage: installed.sh REPOSITORY BUILD CXX-COMPILER CASE
# Cases static and bullet use BUILD as it is; the others build in a folder of their own and take long.
set -euo pipefail

repository=$(realpath "$1")
build=$2
cxx=$3
case=$4
cc=${cxx/clang++/clang}
cc=${cc/g++/gcc}
cc=${cc/%c++/cc}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
: >"$scratch/said"

fail() {
  echo "$1"
  tail -n 40 "$scratch/said"
  exit 1
}

quietly() { "$@" >"$scratch/said" 2>&1 || fail "failed: $*"; }

stepped() { [[ $("$@" 2>&1) == stepped ]] || fail "does not step: $*"; }

# by_cmake PREFIX KIND: C and C++ by find_package; KIND: shared, static or nothing.
by_cmake() {
  rm -rf "$scratch/games"
  quietly cmake -S "$repository/tests/package/hosts/installed" -B "$scratch/games" -G Ninja -DKIND="$2" \
    -DCMAKE_PREFIX_PATH="$1" -DCMAKE_CXX_COMPILER="$cxx"
  quietly cmake --build "$scratch/games"
  stepped "$scratch/games/game_c"
  stepped "$scratch/games/game_cpp"
  [[ -z $(find "$1" -name libbreve_lua.a) ]] || stepped "$scratch/games/game_lua"
}

# by_pkg_config PREFIX LIBDIR [--static]
by_pkg_config() {
  local flags
  export PKG_CONFIG_PATH=$2/pkgconfig
  pkg-config --exists breve || fail "pkg-config does not find breve"
  [[ $(pkg-config --modversion breve) == "$(cmake_version)" ]] || fail "pkg-config has another version"
  [[ $(realpath "$(pkg-config --variable=includedir breve)") == "$(realpath "$1/include")" ]] || fail "breve.pc looks elsewhere"
  read -ra flags <<<"$(pkg-config --cflags --libs "${@:3}" breve)"
  quietly "$cc" -std=c11 -Wall -Wextra -Wpedantic -Werror "$repository/tests/package/hosts/game.c" "${flags[@]}" -o "$scratch/game_c"
  quietly "$cxx" -std=c++17 -Wall -Wextra -Wpedantic -Werror "$repository/tests/package/hosts/game.cpp" "${flags[@]}" -o "$scratch/game_cpp"
  LD_LIBRARY_PATH=$2 stepped "$scratch/game_c"
  LD_LIBRARY_PATH=$2 stepped "$scratch/game_cpp"
  # Agents in Lua, with the build of Lua for C.
  [[ -n $(find "$1" -name libbreve_lua.a) ]] || return 0
  [[ $(pkg-config --modversion breve-lua) == "$(cmake_version)" ]] || fail "pkg-config has another version of breve-lua"
  read -ra flags <<<"$(pkg-config --cflags --libs "${@:3}" breve-lua lua5.4)"
  quietly "$cc" -std=c11 -Wall -Wextra -Wpedantic -Werror "$repository/tests/package/hosts/game_lua.c" "${flags[@]}" -o "$scratch/game_lua"
  LD_LIBRARY_PATH=$2 stepped "$scratch/game_lua"
}

cmake_version() { sed -n 's/^project(breve VERSION \([0-9.]*\).*/\1/p' "$repository/CMakeLists.txt"; }
abi() { sed -n 's/^#define BREVE_ABI \([0-9]*\)$/\1/p' "$repository/hostapi/include/breve/breve.h"; }

# build_shared [OPTION…]: in $scratch/build
build_shared() {
  quietly cmake -S "$repository" -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON \
    -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_INSTALL_PREFIX=/usr -DBREVE_QUICK_BUILD=ON -DBREVE_BUILD_TESTS=OFF \
    -DBREVE_BUILD_BENCHMARKS=OFF -DBREVE_BUILD_SAMPLES=OFF "$@"
  quietly cmake --build "$scratch/build"
}

# only_breve LIBRARY: what it shows of itself begins with breve_
only_breve() {
  nm -D --defined-only "$1" | awk '{print $3}' | sed 's/@.*//' >"$scratch/symbols"
  [[ $(grep -c '^breve_' "$scratch/symbols") -gt 100 ]] || fail "shows hardly any function"
  ! grep -v '^breve_' "$scratch/symbols" >"$scratch/said" || fail "shows more than breve_*"
  # Each function of the headers is there.
  # breve_lua.h is of the static library breve_lua.
  find "$repository/hostapi/include/breve" -name '*.h' ! -name breve_lua.h -exec cat {} + | grep -o '^BREVE_API [^(]*' | grep -o 'breve_[a-z0-9_]*$' | sort -u >"$scratch/declared"
  sort -u "$scratch/symbols" | comm -23 "$scratch/declared" - >"$scratch/said"
  [[ ! -s $scratch/said ]] || fail "does not show all functions of the headers"
}

case $case in
  static)
    quietly cmake --install "$build" --prefix "$scratch/usr" --component development
    libdir=$(dirname "$(find "$scratch/usr" -name libbreve.a)")
    by_cmake "$scratch/usr" ""
    by_cmake "$scratch/usr" static
    by_pkg_config "$scratch/usr" "$libdir" --static
    # An interpreter finds the module below the same prefix.
    module=$(find "$build/lua" -name breve.so 2>/dev/null | head -1)
    if [[ $module ]] && command -v lua5.4 >/dev/null; then
      quietly cmake --install "$build" --prefix "$scratch/usr" --component command
      LUA_CPATH="$libdir/lua/5.4/?.so" quietly lua5.4 "$repository/tests/lua/module.lua"
    fi
    # It works wherever it is moved to.
    mv "$scratch/usr" "$scratch/moved"
    by_cmake "$scratch/moved" static
    rm "$scratch/games/CMakeCache.txt"
    ! cmake -S "$repository/tests/package/hosts/installed" -B "$scratch/games" -G Ninja -DKIND=shared \
      -DCMAKE_PREFIX_PATH="$scratch/moved" >"$scratch/said" 2>&1 || fail "finds a shared library that is not there"
    tr -s ' \n' ' ' <"$scratch/said" | grep -qF 'breve is not installed as a shared library' || fail "does not say what is missing"
    ;;
  bullet)
    quietly cmake --install "$build" --prefix "$scratch/usr" --component development
    libdir=$(dirname "$(find "$scratch/usr" -name libbreve.a)")
    read -ra flags <<<"$(PKG_CONFIG_PATH=$libdir/pkgconfig pkg-config --cflags --libs --static breve bullet)"
    quietly "$cxx" -std=c++17 "$repository/tests/package/hosts/bullet.cpp" "${flags[@]}" -o "$scratch/host"
    program=$repository/tests/package/hosts/towers.tz
    alone=$("$scratch/host" "$program") || fail "does not run alone"
    beside=$("$scratch/host" "$program" bullet) || fail "does not run beside Bullet"
    [[ -n $alone && $alone == "$beside" ]] || fail "hash $alone alone, $beside beside Bullet"
    ;;
  shared)
    build_shared -DBREVE_WITH_COMMAND=OFF
    only_breve "$scratch/build/hostapi/libbreve.so"
    quietly cmake --install "$scratch/build" --prefix "$scratch/usr"
    libdir=$(dirname "$(find "$scratch/usr" -name 'libbreve.so')")
    by_cmake "$scratch/usr" ""
    by_cmake "$scratch/usr" shared
    by_pkg_config "$scratch/usr" "$libdir"
    ;;
  debian)
    build_shared
    (cd "$scratch/build" && quietly cpack -G DEB)
    packages=("$scratch/build"/*.deb)
    ((${#packages[@]} == 3)) || fail "makes ${#packages[@]} packages"
    for name in "libbreve$(abi)" libbreve-dev breve; do
      ls "$scratch/build/${name}_"*.deb >/dev/null 2>&1 || fail "makes no package $name"
    done
    depends() { dpkg-deb -f "$scratch/build/$1_"*.deb Depends; }
    for library in libc6 libfmt libbox2d libassimp libpugixml libexpat1 libtbb zlib1g; do
      [[ $(depends "libbreve$(abi)") == *$library* ]] || fail "the library does not depend on $library"
    done
    [[ $(dpkg-deb -f "$scratch/build/libbreve$(abi)_"*.deb Recommends) == *libosmesa6* ]] || fail "views have no OSMesa"
    [[ $(depends "libbreve$(abi)") != *bullet* ]] || fail "the library depends on Bullet"
    for name in breve libbreve-dev; do
      [[ $(depends $name) == *"libbreve$(abi) (= $(cmake_version))"* ]] || fail "$name depends on another library"
    done
    # Dependencies can be had; then the files where they belong, in a folder in place of the root.
    quietly apt-get -s -o Dir::State::Lists=/var/lib/apt/lists install "${packages[@]}"
    for package in "${packages[@]}"; do quietly dpkg-deb -x "$package" "$scratch/root"; done
    libdir=$(dirname "$(find "$scratch/root" -name 'libbreve.so')")
    by_cmake "$scratch/root/usr" shared
    by_pkg_config "$scratch/root/usr" "$libdir"
    for file in bin/breve share/man/man1/breve.1* share/bash-completion/completions/breve share/zsh/vendor-completions/_breve 'lib/*/lua/5.4/breve.so'; do
      compgen -G "$scratch/root/usr/$file" >/dev/null || fail "$file is not in the packages"
    done
    [[ $(LD_LIBRARY_PATH=$libdir "$scratch/root/usr/bin/breve" --version) == *"$(cmake_version)"* ]] || fail "the command does not run"
    ;;
  without_parts)
    build_shared -DBREVE_WITH_COMMAND=OFF -DBREVE_WITH_PLANAR=OFF -DBREVE_WITH_MESHES=OFF -DBREVE_WITH_MOVIES=OFF \
      -DCMAKE_DISABLE_FIND_PACKAGE_box2d=ON -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON
    ! ldd "$scratch/build/hostapi/libbreve.so" | grep -E 'box2d|assimp' >"$scratch/said" || fail "links what was left out"
    quietly cmake --install "$scratch/build" --prefix "$scratch/usr"
    libdir=$(dirname "$(find "$scratch/usr" -name 'libbreve.so')")
    by_cmake "$scratch/usr" shared
    quietly "$cc" -std=c11 -I"$scratch/usr/include" "$repository/tests/package/hosts/left_out.c" -L"$libdir" -lbreve -o "$scratch/left_out"
    LD_LIBRARY_PATH=$libdir quietly "$scratch/left_out"
    ;;
  *) fail "no case $case" ;;
esac
