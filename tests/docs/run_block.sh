#!/usr/bin/env bash
# Runs one steve block of the documentation and compares what it prints with what the page says.
# Usage: run_block.sh BREVE KIND FILE, KIND being steve, steve-fragment or steve-error.
set -uo pipefail

breve=$(realpath "$1") kind=$2 file=$(realpath "$3")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1

"$breve" run "$file" --iterations 10 --seed 1 >out 2>err </dev/null
status=$?

fail() {
  echo "$file: $1"
  echo "--- stdout"
  cat out
  echo "--- stderr"
  cat err
  exit 1
}

if [[ $kind == steve-error ]]; then
  ((status == 1)) || fail "exit status $status; the page shows an error, which is 1"
  while IFS= read -r wanted; do
    grep -aqF -- "$wanted" err || fail "not in the message: $wanted"
  done < <(sed -n 's/.*# expect error: //p' "$file")
  exit 0
fi

((status == 0)) || fail "exit status $status"
[[ ! -s err ]] || fail "warnings or errors, though the page shows none"
sed -n 's/.*# expect: //p' "$file" >wanted
if [[ -s wanted ]]; then
  sed 's/ *$//' out | diff wanted - >difference || fail "the page says otherwise:
$(cat difference)"
fi
