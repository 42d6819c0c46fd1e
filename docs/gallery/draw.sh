#!/usr/bin/env bash
# Draws every sample world for docs/gallery.md.
# Usage: docs/gallery/draw.sh BREVE DIRECTORY
# To make the gallery anew: docs/gallery/draw.sh build/release/bin/breve docs/gallery
set -euo pipefail
breve=$(realpath "$1")
mkdir -p "$2"
out=$(realpath "$2")
worlds=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../samples/worlds")
# Simulated seconds, where eight are not the moment that shows most.
declare -A seconds=([aggregation.tz]=600 [ants.tz]=60 [beam.tz]=200 [bounce.tz]=2.3 [car.tz]=3 [dilemma.tz]=60 [dominoes.lua]=6
  [echo.tz]=400 [gray_scott.tz]=400 [highland.tz]=12 [life.tz]=20 [life_3d.tz]=12 [peaks.tz]=60 [plants.tz]=20 [ragdoll.tz]=1.5 [random_walk.tz]=60
  [stack.tz]=4 [termites.tz]=600 [terrain.tz]=12 [tierra.tz]=600 [wolf_sheep.tz]=40 [xor.tz]=60)
scratch=$(mktemp -d)  # for files that programs write
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
# The picture at the top of README.md.
"$breve" run "$worlds/dominoes.lua" --seconds 6 --seed 1 --quiet --size 720x300 --snapshot "$out/cover.png" >/dev/null
for file in "$worlds"/*.tz "$worlds"/*.lua; do
  name=$(basename "$file")
  options=()
  [[ $name != served.tz ]] || options=(--allow-network)
  "$breve" run "$file" --seconds "${seconds[$name]-8}" --seed 1 --quiet --size 240x150 "${options[@]}" \
    --snapshot "$out/${name/./_}.png" >/dev/null
done
