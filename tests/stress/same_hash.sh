#!/usr/bin/env bash
# Same seed, same run: each program of a folder is run by two breve commands (or twice by one); output and hash must
# be equal, and another seed must give another hash. Usage: same_hash.sh FOLDER BREVE [OTHER-BREVE]
set -euo pipefail

folder=$(realpath "$1") first=$(realpath "$2") second=$(realpath "${3:-$2}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
failed=0

# run BREVE FILE SEED OUT: what the program prints, then its hash.
run() { "$1" run "$2" --iterations "${ITERATIONS:-200}" --seed "$3" --quiet --hash >"$4" 2>&1; }

shopt -s nullglob
programs=("$folder"/*.tz)
((${#programs[@]})) || { echo "no programs in $folder"; exit 1; }
for program in "${programs[@]}"; do
  name=${program##*/}
  if ! run "$first" "$program" 1 a || ! run "$second" "$program" 1 b || ! run "$first" "$program" 2 c; then
    echo "$name: did not run"
    cat a
    failed=1
  elif ! cmp -s a b; then
    echo "$name: two runs with one seed differ"
    diff a b | head -20 || true
    failed=1
  elif cmp -s a c; then
    echo "$name: two seeds give one run: is there a hash in the output?"
    failed=1
  else
    echo "$name: $(tail -n 1 a)"
  fi
done
exit "$failed"
