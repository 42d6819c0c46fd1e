#!/usr/bin/env bash
# The walker sample from five seeds: after 200 tries the median walks further than 6 body lengths in 20 s, and every seed
# at least twice as far as the best of its first round. It can be saved and resumed. Usage: walker.sh BREVE WALKER [RUNG]
set -euo pipefail

breve=$(realpath "$1") walker=$(realpath "$2") rung=${3:-balanced}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() {
  echo "$1"
  exit 1
}

for seed in 1 2 3 4 5; do
  "$breve" run "$walker" --seed "$seed" --accuracy "$rung" --quiet -- "$seed.pool" >"$seed.out"
  read -r first best < <(sed -n 's/^from \([0-9.]*\) to \([0-9.]*\) body lengths$/\1 \2/p' "$seed.out") || fail "seed $seed: no end"
  echo "seed $seed: from $first to $best body lengths"
  awk -v first="$first" -v best="$best" 'BEGIN { exit !(first > 0 && best >= 2 * first) }' || fail "seed $seed has not doubled"
  echo "$best" >>bests
done
median=$(sort -n bests | sed -n 3p)
awk -v median="$median" 'BEGIN { exit !(median > 6) }' || fail "the median is $median body lengths"

# It goes on where it stopped.
"$breve" run "$walker" --seed 9 --accuracy "$rung" --quiet --iterations 1 -- 1.pool resume >resumed
grep -q '^going on after 200 tries' resumed || fail "it does not resume"
