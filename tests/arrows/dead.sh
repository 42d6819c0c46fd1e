#!/usr/bin/env bash
# Functions that nothing leads to from breve.h and the command, by the linker: it is told to keep those only, and to name
# what it drops. house.cpp finds most of them by their names alone; this finds those that share a name with another.
# Usage: dead.sh BUILD-FOLDER, of the preset dead: unoptimised, so that each call is one, with a section for each function.
set -euo pipefail

build=$1
here=$(dirname "${BASH_SOURCE[0]}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

printf '{ global: breve_*; main; local: *; };\n' >"$work/roots"
mapfile -t objects < <(find "$build/hostapi" "$build/runtime" "$build/steve" -name '*.o' | sort)
((${#objects[@]})) || { echo "dead.sh: no objects in $build" >&2; exit 2; }
clang++ -shared -o "$work/all.so" "${objects[@]}" -Wl,--gc-sections -Wl,--print-gc-sections \
  -Wl,--version-script="$work/roots" 2>"$work/dropped"

# Sections of functions, by their names: of ours, neither written by the compiler nor called through an operator. Names with
# a group behind them are copies of inline functions.
sed -n "s/.*removing unused section '\.text\.\([^'[]*\)'.*/\1/p" "$work/dropped" | sort -u | c++filt |
  grep -E '^breve::' | grep -vE '\{lambda|::~|operator|::\(anonymous namespace\)::.*<' >"$work/functions" || true

# Constructors and assignments belong to their class; what only tests call has its reason.
found=0
while IFS= read -r function; do
  name=${function%%(*}
  name=${name%%<*}
  short=${name##*::}
  owner=${name%::*}
  [[ $short != "${owner##*::}" ]] || continue
  # By its name, or by that and its class.
  ! grep -qE "^($short|${owner##*::}::$short) " "$here/for_tests.txt" || continue
  echo "nothing calls $function"
  found=1
done <"$work/functions"
exit $found
