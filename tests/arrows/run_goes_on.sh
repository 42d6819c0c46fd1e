#!/usr/bin/env bash
# `./run tests --all`, with tools that only note how they were called: one that is run again repeats what failed, and
# not what has passed; sources that differ have passed nothing. Usage: run_goes_on.sh REPOSITORY
set -uo pipefail

repository=$(realpath "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
house=$scratch/house
mkdir -p "$scratch/tools" "$house"/{hostapi,runtime,samples,steve,tests/{abi,arrows,stress},build/fuzz/tests/fuzz}

# tool FILE [LINE]: a program that notes its call, and then does what the line says.
tool() {
  printf '#!/bin/sh\necho "%s $*" >>%s/calls\n%s\n' "${1##*/}" "$scratch" "${2-}" >"$1"
  chmod +x "$1"
}
for name in cmake clang-format clang-tidy; do tool "$scratch/tools/$name"; done
tool "$scratch/tools/dpkg-query" 'echo installed'
tool "$scratch/tools/ctest" "case \"\$*\" in
  *-L\ long*)
    printf '1/2 Test  #22: limits.Two ....   Passed    1.0 sec\n'
    if test -e $scratch/broken; then printf '2/2 Test #1: fuzz.One ....***Failed    1.0 sec\n'; exit 8; fi
    printf '2/2 Test #1: fuzz.One ....   Passed    1.0 sec\n' ;;
  *threads*) test ! -e $scratch/broken ;;
esac"
for script in abi/check arrows/dead stress/same_hash; do tool "$house/tests/$script.sh"; done
for name in call compile feed image run select; do tool "$house/build/fuzz/tests/fuzz/fuzz_$name"; done
cp "$repository/run" "$house/run"
echo /build/ >"$house/.gitignore"

commit() {
  git -C "$house" add -A
  git -C "$house" -c user.name=test -c user.email=test@localhost commit -qm "$1"
}

fail() {
  printf '%s\n' "$1"
  cat "$scratch/said" "$scratch/calls"
  exit 1
}

# all STATUS: runs it, which ends with that status.
all() {
  : >"$scratch/calls"
  PATH=$scratch/tools:$PATH "$house/run" tests --all 1 >"$scratch/said" 2>&1
  (($? == $1)) || fail "the exit status is not $1"
}

# calls COUNT PATTERN: so many calls match.
calls() {
  local found
  found=$(grep -c -- "$2" "$scratch/calls")
  ((found == $1)) || fail "$found calls match \"$2\", not $1"
}

# every COUNT: each kind of stage was taken so many times, but those that fail.
every() {
  local pattern
  for pattern in 'clang-format .*--dry-run' 'ctest .*release.*-LE long' '^clang-tidy' check.sh 'ctest .*asan' 'ctest .*debug' \
    same_hash.sh ^fuzz_select 'cmake --build --preset asan'; do
    calls "$1" "$pattern"
  done
}

git -C "$house" init -q
commit first
touch "$scratch/broken"
all 1
every 1
calls 1 threads
calls 1 '-L long -E ^(none)'
grep -q 'tsan: tests -L threads *FAILED' "$scratch/said" || fail "the summary does not say what failed"

rm "$scratch/broken"
all 0
every 0
calls 1 threads
calls 1 '-L long -E ^(limits\\.Two)'
grep -q 'asan: tests .* earlier' "$scratch/said" || fail "the summary does not say what passed earlier"

all 0
calls 0 ctest

echo more >"$house/more"
all 0
every 1
calls 1 threads
commit second
all 0
every 1
calls 1 threads
