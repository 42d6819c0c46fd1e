#!/usr/bin/env bash
# The game, played by its robot on a screen in memory: it walks, plants, saves, loads and leaves pictures.
# Usage: game.sh XVFB_RUN GAME DIRECTORY
set -euo pipefail
xvfb=$1 game=$2 directory=$3
rm -rf "$directory"
mkdir -p "$directory"
fail() {
  echo "game.sh: $1" >&2
  cat "$directory/output.txt" >&2
  exit 1
}
"$xvfb" -a -s '-screen 0 1280x800x24' "$game" --robot "$directory" >"$directory/output.txt" 2>&1 || fail "does not run"

# What it reports of a frame: "time 6.60 honey 4 bees 14 ... keeper 3.06 9.49".
frame() { sed -n "s/^frame $1: //p" "$directory/output.txt"; }
number() { frame "$1" | sed -E "s/.*$2 (-?[0-9.]+).*/\1/"; }
[[ -s $directory/meadow.save ]] || fail "saves nothing"
[[ -n $(frame 420) && $(frame 600) == "$(frame 420)" ]] || fail "goes on differently from what was saved"
[[ $(frame 599) != "$(frame 420)" ]] || fail "nothing happens between saving and loading"
awk -v t="$(number 900 time)" 'BEGIN { exit !(t > 11 && t < 12) }' || fail "time does not pass as it should"
# The keeper began at 0, -4 and walked right, up and left; honey was gathered, and seeds were planted.
awk -v x="$(number 419 keeper)" 'BEGIN { exit !(x > 1) }' || fail "keys do not move the keeper"
(($(number 419 honey) > 0)) || fail "bees gather no honey"
(($(number 900 flowers) > 28)) || fail "no flower was planted"
grep -q 'not written' "$directory/output.txt" && fail "writes no picture"
for picture in debug meadow; do
  colors=$(sed -n "s/^$picture.png: written, 1200 x 720, \([0-9]*\) colours$/\1/p" "$directory/output.txt")
  ((${colors:-0} > 500)) || fail "$picture.png has ${colors:-no} colours: it is not the meadow"
  [[ $(head -c 8 "$directory/$picture.png" | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] || fail "$picture.png is not a PNG file"
done
cmp -s "$directory/debug.png" "$directory/meadow.png" && fail "both pictures are the same"
exit 0
