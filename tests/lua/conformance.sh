#!/usr/bin/env bash
# A program in steve and the same in Lua: they print the same, and leave every object at the same place, bit for bit.
# (The hash of a world covers the variables of its objects, which are the languages' own; so places are compared.)
# Usage: conformance.sh BREVE NAME
set -uo pipefail

breve=$(realpath "$1") program=$(realpath "$(dirname "${BASH_SOURCE[0]}")")/conformance/$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1

for language in tz lua; do
  "$breve" run "$program.$language" --iterations 20 --seed 3 --positions "$language.csv" >"$language.out" 2>"$language.err" || {
    cat "$language.out" "$language.err"
    exit 1
  }
  [[ ! -s $language.err ]] || { cat "$language.err"; exit 1; }
done
[[ $(wc -l <tz.csv) -gt 1 ]] || { echo "nothing has a place"; exit 1; }
grep -qv ',0,0,0,1,0,0,0$' tz.csv || { echo "nothing has moved"; exit 1; }
diff tz.out lua.out && diff tz.csv lua.csv
