#!/usr/bin/env bash
# The highland sample from five seeds: birds touch the ground, and none gets deeper into a hill than the 0.28 that it
# flies in one step.
# Usage: highland.sh BREVE HIGHLAND
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
touches=0
for seed in 1 2 3 4 5; do
  "$1" run "$2" --seed "$seed" --quiet --iterations 500 --plot get-touches --plot get-lowest --log "$folder/log.csv"
  awk -F, -v seed="$seed" 'NR == 2 || $3 < least { least = $3 } { touches = $2 }
                           END { print "seed " seed ": " touches " touches, lowest " least
                                 exit !(NR > 500 && least > -0.28) }' "$folder/log.csv"
  touches=$((touches + $(tail -n 1 "$folder/log.csv" | cut -d, -f2)))
done
((touches > 0))
