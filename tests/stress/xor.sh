#!/usr/bin/env bash
# The xor sample from five seeds: within 60 generations of 50 networks, the four answers are on the right side of 0.5.
# Usage: xor.sh BREVE XOR
set -euo pipefail

for seed in 1 2 3 4 5; do
  # 50 tests of 0.01 s take 9 iterations of 0.06 s.
  answers=$("$1" run "$2" --seed "$seed" --quiet --iterations 540 | tail -1)
  echo "seed $seed: $answers"
  awk '{ exit !($4 < 0.5 && $8 > 0.5 && $12 > 0.5 && $16 < 0.5 && $1 == "0") }' <<<"$answers"
done
