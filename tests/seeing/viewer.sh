#!/usr/bin/env bash
# The window of `breve view` on a screen in memory, with input from a file.
# Usage: viewer.sh XVFB_RUN BREVE DIRECTORY
set -euo pipefail
xvfb=$1 breve=$(realpath "$2") directory=$3
if [[ $xvfb != inside ]]; then
  rm -rf "$directory"
  mkdir -p "$directory"
  # xvfb-run also fails if it cannot tidy up after itself: the file that is made at the end counts.
  "$xvfb" -a -s '-screen 0 1280x800x24' bash "$0" inside "$breve" "$directory" || true
  [[ -e $directory/passed ]]
  exit
fi
cd "$directory"
fail() {
  echo "viewer.sh: $1" >&2
  cat output.txt >&2
  exit 1
}
# show STATUS ARGUMENTS…: breve view; what it says is in output.txt.
show() {
  local wanted=$1 status=0
  shift
  SDL_RENDER_DRIVER=software "$breve" view "$@" --size 480x320 >output.txt 2>&1 || status=$?
  [[ $status == "$wanted" ]] || fail "status $status and not $wanted of: breve view $*"
}
has() { grep -q -- "$1" output.txt || fail "'$1' is not in what it says"; }

cat >toy.tz <<'END'
@use Control.
@use Mobile.
@use Shape.
Controller Toy.
Control : Toy {
  + variables:
    ball (object).
  + to init:
    self point-camera at (0, 0, 0) from (0, 4, 20).
    ball = new Ball.
    ball add-menu named "Paint it" for-method "paint".
  + to catch-key-a-down: print "key a".
  + to catch-key-up-down: print "key up".
  + to click on thing (object):
    if thing: print "click on a", (thing get-type).
    else print "click on nothing".
    super click on thing.
}
Mobile : Ball {
  + variables:
    mood (string).
  + to init:
    mood = "calm".
    self set-shape to ((new Sphere) init-with radius 2).
    self set-color to (1, .5, .1).
  + to paint:
    print "painted". self set-color to (0, 0, 1).
}
END
cat >play.txt <<'END'
0 shot first.png
2 say begin
3 key F5
5 say paused
6 key F6
7 say stepped
8 key F5
9 click 240 160
9 key a
9 key Up
13 shot selected.png
14 key F3
# The seventh row of the menu is a line, and the ball's own entry is below it.
16 click 60 168
20 shot painted.png
21 drag 240 160 300 190 left
22 wheel 4
23 drag 240 160 260 200 right
25 shot moved.png
26 key Home
28 shot home.png
29 click 470 310
30 key F1
30 key F2
32 shot panels.png
33 key F1
34 key F9
35 key F10
36 key F8
60 key F10
62 say end
63 quit
END
show 0 toy.tz --seed 1 --play play.txt
[[ $(sed -n 's/^paused: \(.*\) s  iteration.*/\1/p' output.txt) == "$(sed -n 's/^begin: \(.*\) s  iteration.*/\1/p' output.txt)" ]] ||
  fail "time passes while it is paused"
grep -q '^stepped: .*\[paused\]' output.txt || fail "a step does not leave it paused"
[[ $(sed -n 's/^stepped: .*iteration \([0-9]*\) .*/\1/p' output.txt) == \
  $(($(sed -n 's/^paused: .*iteration \([0-9]*\) .*/\1/p' output.txt) + 1)) ]] || fail "a step is not one iteration"
has 'click on a Ball'
has 'click on nothing'
has '^key a'
has '^key up'
has '^painted'
has '^end: .*speed 2'
for picture in first selected painted moved home panels breve-0001; do
  [[ $(head -c 8 "$picture.png" | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] || fail "$picture.png is not a PNG file"
done
for pair in first:selected selected:painted painted:moved moved:home home:panels; do
  cmp -s "${pair%:*}.png" "${pair#*:}.png" && fail "the pictures $pair are the same"
done
[[ -s breve-0001.mp4 || -d breve-0001.mp4.frames ]] || fail "no movie was recorded"

# The mouse moves the camera, keys open panels, and the panels say what they are for.
cat >drop.tz <<'END'
@use PhysicalControl.
@use Mobile.
@use Shape.
@use Stationary.
Controller Drop.
PhysicalControl : Drop {
  + variables:
    ball, floor (object).
    count (int).
  + to init:
    self point-camera at (0, 0, 0) from (0, 4, 20).
    floor = new Floor.
    ball = new Ball.
    ball move to (0, 3, 0).
    ball enable-physics.
    self add-menu named "Count" for-method "count-up".
  + to count-up: count += 1. print "counted $count".
}
Mobile : Ball {
  + variables:
    mood (string).
    wishes (list).
  + to init:
    mood = "calm". wishes = { 1, 2 }.
    self set-shape to ((new Sphere) init-with radius 2).
}
END
cat >play.txt <<'END'
2 read
3 drag 240 160 300 160 left
5 read
6 drag 240 160 240 190 right
8 read
9 wheel 4
11 read
12 wheel -4
14 read
15 key Home
17 read
18 key F5
19 click 240 130
21 read
22 key F2
22 key F1
24 read
25 key F1
25 key F3
# The sixth row of the menu is a line, and what the program added is below it.
27 read
28 key F11
30 read
31 shot arrows.png
32 key F11
34 shot forces.png
35 resize 600 400
40 shot resized.png
41 key F7
42 key F7
44 say slow
45 quit
END
show 0 drop.tz --seed 1 --play play.txt
mapfile -t cameras < <(grep '^camera: ' output.txt)
at() { sed 's/camera: \(.*\) from .*/\1/' <<<"${cameras[$1]}"; }
away() { sed 's/.* from (\(.*\), \(.*\), \(.*\))/\1 \2 \3/' <<<"${cameras[$1]}" | awk '{ printf "%.2f", sqrt($1*$1 + $2*$2 + $3*$3) }'; }
[[ $(at 0) == "$(at 1)" && ${cameras[0]} != "${cameras[1]}" && $(away 0) == "$(away 1)" ]] || fail "orbit: ${cameras[0]} to ${cameras[1]}"
[[ $(at 1) != "$(at 2)" && $(away 1) == "$(away 2)" ]] || fail "pan: ${cameras[1]} to ${cameras[2]}"
[[ $(at 2) == "$(at 3)" && $(awk "BEGIN { print $(away 3) < .7 * $(away 2) }") == 1 ]] || fail "zoom: ${cameras[2]} to ${cameras[3]}"
[[ $(away 4) == "$(away 2)" ]] || fail "zoom back: ${cameras[4]}"
[[ ${cameras[5]} == "${cameras[0]}" ]] || fail "Home: ${cameras[5]}"
for text in 'Ball' 'at (0.000, ' 'mood = calm' 'wishes = { 1, 2 }' 'iteration' 'frames/s' 'x real time' 'F5  pause, go on' 'contact: ' \
  'effects together: .* us an iteration' 'picture: .* draw calls.*drawn by this machine' 'Count' 'arrows: contacts'; do
  grep -q "^window: .*$text" output.txt || fail "the window does not show '$text'"
done
cmp -s arrows.png forces.png && fail "arrows of contacts and of forces are the same"
[[ $(od -An -tx1 -j16 -N8 resized.png | tr -d ' \n') == 0000025800000190 ]] || fail "the window is not resized"
has '^slow: .*speed 0.25'

# What the guard did, and the error of a handler with its line, are in the window.
sed 's/    ball enable-physics./&\n    ball set-shape to ((new Cube) init-with size (1, 2, 3)). ball set-rotational-velocity to (1, 4000, 2). self set-accuracy to "fast"./; s/  + to count-up:/  + to catch-key-x-down: die "no such key".\n&/' drop.tz >wild.tz
printf '1 key F2\n20 read\n21 key x\n25 read\n26 quit\n' >play.txt
show 0 wild.tz --seed 1 --play play.txt  # an error of a handler ends no run
grep -q '^window: .*refined' output.txt || fail "the window does not show what the guard did"
grep -q '^window: .*no such key' output.txt && grep -q '^window: .*wild.tz:[0-9]*' output.txt || fail "the window does not show the error and its line"

# An error shows its line, and the window stays; with --watch the program goes on once it is mended.
sed 's/mood = "calm"/mood = "calm". self schedule method-call "burst" at-time .3/; s/^  + to paint:/  + to burst: die "burst".\n&/' toy.tz >bad.tz
printf '30 shot error.png\n30 say failed\n40 quit\n' >play.txt
show 1 bad.tz --play play.txt
has 'bad.tz:[0-9]*:[0-9]*: error: burst'
has '^failed: .*stopped by an error'
cp bad.tz mended.tz
rm output.txt
printf '30 say failed\n400 say mended\n401 quit\n' >play.txt
(
  until grep -q '^failed' output.txt 2>/dev/null; do sleep 0.1; done
  sed -i 's/die "burst"/print "mended"/' mended.tz
) &
show 0 mended.tz --watch --play play.txt
wait
has 'mended.tz reloaded'
grep -q '^mended: .*stopped' output.txt && fail "does not go on after an edit"

# Without OpenGL of the machine, or without its use, pictures are drawn in main memory.
printf '2 key F2\n4 read\n5 shot software.png\n6 quit\n' >play.txt
show 0 drop.tz --software --play play.txt
has '^window: picture: .*drawn in main memory'
SDL_OPENGL_LIBRARY=nowhere.so show 0 drop.tz --play play.txt
has '^window: picture: .*drawn in main memory'

# Without drawing of every frame most frames show the picture of the one before.
sed 's/    ball add-menu/    ball set-velocity to (4, 0, 0). self set-iteration-step to .02. self set-integration-step to .02.\n&/' toy.tz >on.tz
sed 's/    ball add-menu/    self disable-draw-every-frame.\n&/' on.tz >off.tz
printf '1 key F4\n20 shot 0.png\n21 shot 1.png\n22 shot 2.png\n23 shot 3.png\n24 quit\n' >play.txt
equal_frames() {
  show 0 "$1" --play play.txt
  local count=0 i
  for i in 0 1 2; do cmp -s "$i.png" "$((i + 1)).png" && count=$((count + 1)); done
  echo "$count"
}
[[ $(equal_frames on.tz) == 0 ]] || fail "a frame is left out"
[[ $(equal_frames off.tz) -ge 2 ]] || fail "no frame is left out"

printf '3 fly away\n' >play.txt
show 1 toy.tz --play play.txt
has "play.txt:1: '3 fly away' is not an action of --play"
show 2 nowhere.tz
has nowhere.tz
status=0
env -u DISPLAY SDL_VIDEODRIVER=x11 "$breve" view toy.tz >output.txt 2>&1 || status=$?
[[ $status == 1 ]] || fail "without a screen the status is $status"
has 'cannot open a window'
touch passed
