#!/usr/bin/env bash
# Runs a target of fuzz_replay on many seeds, in pieces: it may be ended at any time, and goes on where it was.
#   campaign.sh REPLAY FOLDER TARGET FIRST COUNT [PIECE]
#   campaign.sh --sum FOLDER          what all campaigns in FOLDER have done
# FOLDER/TARGET.done has a line for each piece: its first seed, how many seeds, and how many calls of breve.h, programs
# or other inputs.
# A seed that finds something is left with its word in FOLDER/TARGET.SEED, and the campaign goes on behind it.
set -euo pipefail

if [ "${1:-}" = --sum ]; then
  for done in "$2"/*.done; do
    target=$(basename "$done" .done)
    findings=$(find "$2" -name "$target.[0-9]*" | wc -l)
    awk -v target="$target" -v findings="$findings" \
      '{ seeds += $2; inputs += $3 } END { printf "%s: %d seeds, %d inputs, %d findings\n", target, seeds, inputs, findings }' \
      "$done"
  done
  exit 0
fi
[ $# -ge 5 ] || { sed -n '2,7s/^# //p' "$0" >&2; exit 2; }
replay=$1 folder=$2 target=$3 first=$4 end=$(($4 + $5)) piece=${6:-100}
mkdir -p "$folder"
log=$folder/$target.log
touch "$folder/$target.done"
seed=$(awk -v seed="$first" -v end="$end" '$1 >= seed && $1 < end { seed = $1 + $2 } END { print seed }' \
  "$folder/$target.done")
while [ "$seed" -lt "$end" ]; do
  count=$((end - seed < piece ? end - seed : piece))
  if "$replay" "$target" --seeds "$seed" "$count" >"$log" 2>&1; then
    inputs=$(awk '$2 == "calls" || $2 == "programs" { print $1 }' "$log")
    echo "$seed $count ${inputs:-$count}" >>"$folder/$target.done"
  else
    found=$(awk '$1 == "seed" { seed = $2 } END { print seed }' "$log")
    [ -n "$found" ] || { cat "$log" >&2; exit 1; }
    cp "$log" "$folder/$target.$found"
    echo "$seed $((found - seed + 1)) 0" >>"$folder/$target.done"
    count=$((found - seed + 1))
  fi
  seed=$((seed + count))
done
