#!/usr/bin/env bash
# The echo sample from five seeds: within 100 epochs the network repeats what it has never heard, two steps later.
# Usage: echo.sh BREVE ECHO
set -euo pipefail

for seed in 1 2 3 4 5; do
  said=$("$1" run "$2" --seed "$seed" --quiet --iterations 10 | sed -n 's/^hears \(.*\), says \(.*\)$/\1 \2/p')
  echo "seed $seed:" $said
  awk '{ expected = NR > 2 ? heard[NR - 2] : 0; heard[NR] = $1; wrong += ($2 - expected) ^ 2 > 0.04 }
       END { exit !(NR == 12 && wrong == 0) }' <<<"$said"
done
