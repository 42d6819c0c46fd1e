#!/usr/bin/env bash
# The Push sample from ten seeds: at least seven find the polynomial. Usage: push_seeds.sh BREVE PUSH_REGRESSION
set -euo pipefail

breve=$(realpath "$1") program=$(realpath "$2")
found=0
for seed in 1 2 3 4 5 6 7 8 9 10; do
  # 2,000 programs, 100 of them an iteration, for at most 300 generations.
  points=$("$breve" run "$program" --seed "$seed" --iterations 6100 --quiet | sed -n 's/^found \([0-9]*\) points.*/\1/p')
  echo "seed $seed: ${points:-nothing}"
  if [[ -n $points ]]; then found=$((found + 1)); fi
done
echo "$found of 10 found a solution"
((found >= 7))
