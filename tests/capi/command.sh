#!/bin/bash
# The command, one case a run: command.sh PATH-OF-BREVE CASE [PLUGINS]. Each case works in an empty directory of its own.
set -u
breve=$(realpath "$1")
case=$2
plugins=${3-}  # directory of the sample plugins
. "$(dirname "$0")/../case.sh"

# expect STATUS ARGS...: run breve; its output is in out and err.
expect() {
  local wanted=$1 status
  shift
  "$breve" "$@" >out 2>err
  status=$?
  [ $status = "$wanted" ] || fail "status $status and not $wanted of: breve $*"
}

# program NAME INIT ITERATE: a controller with these statements.
program() {
  cat >"$1" <<END
@use Control.
@use Mobile.
Controller Main.
Control : Main {
  + variables:
    turns (int).
    bug (object).
  + to init:
    bug = 0.
    $2
  + to iterate:
    turns += 1.
    $3
    super iterate.
}
END
}

case $case in
help)
  expect 0 help && has out "run" && has out "check"
  expect 0 --help && has out "run"
  expect 0 run --help && has out "--iterations" && has out "Exit status"
  expect 0 help run && has out "--iterations" && has out "Exit status"
  expect 2 help fly && has err "fly"
  expect 0 --version && same "$(cut -d. -f1 out)" "breve 0"
  ;;
wrong_usage)
  program a.tz "" ""
  for arguments in "" "fly" "run" "check" "run a.tz --what" "run a.tz --iterations many" "run a.tz --iterations -3" \
    "run a.tz --iterations 1.5" "run a.tz --seconds inf" "run a.tz --seconds nan" "run a.tz --seconds x" "run a.tz --seconds -1" "run a.tz --seed x" \
    "run a.tz --iterations 1 --seconds 1" "run a.tz --path" "run --iterations 3"; do
    expect 2 $arguments
    same "$(cat out)" ""
    [ -s err ] || fail "something is said about: breve $arguments"
  done
  ;;
missing_file)
  expect 2 run nowhere.tz && has err "nowhere.tz"
  expect 2 run . && has err "directory"
  program a.tz "" ""
  expect 2 check a.tz nowhere.tz && has err "nowhere.tz"
  ;;
run_to_end)
  program a.tz 'print "begun".' 'if turns == 5: { print "five". self end-simulation. }'
  expect 0 run a.tz --quiet
  same "$(cat out)" "$(printf 'begun\nfive')"
  same "$(cat err)" ""
  expect 0 run a.tz --iterations 3 --quiet
  same "$(cat out)" "begun"
  expect 0 run a.tz --iterations 0 --quiet
  same "$(cat out)" "begun"
  ;;
seconds)
  program a.tz "" 'print turns.'
  expect 0 run a.tz --seconds 0.6 --quiet
  same "$(tail -n 1 out)" 10
  expect 0 run a.tz --seconds 0.61 --quiet
  same "$(tail -n 1 out)" 11
  ;;
errors_exit_1)
  program a.tz 'nowhere = 3.' ''
  expect 1 run a.tz --iterations 1 && has err '^a.tz:10:' && has err '\^' && same "$(cat out)" ""
  program a.tz '' 'if turns == 3: die "third".'
  expect 1 run a.tz --iterations 9 --stats && has err 'a.tz:13' && has err third
  tail -n 1 err | python3 -c 'import json,sys; assert json.loads(sys.stdin.read())["iterations"] == 2'  || fail "stats are last"
  program a.tz 'die "at once".' ''
  expect 1 run a.tz --iterations 1 && has err 'at once'
  head -c 2000 /dev/urandom >noise.tz
  expect 1 run noise.tz --iterations 1
  ;;
limits_exit_3)
  program a.tz 'self iterate.' 'self iterate.'
  expect 3 run a.tz --iterations 1 && [ -s err ]
  ;;
args)
  program a.tz 'print (self get-argument-count). print (self get-argument at-index 0). if (self get-argument-count) > 1: print (self get-argument at-index 1).' ''
  expect 0 run a.tz --iterations 1 --quiet && same "$(cat out)" "$(printf '1\na.tz')"
  expect 0 run a.tz one two --iterations 1 --quiet && same "$(cat out)" "$(printf '3\na.tz\none')"
  expect 0 run a.tz --iterations 1 --quiet -- --seed check && same "$(cat out)" "$(printf '3\na.tz\n--seed')"
  expect 0 run --iterations 1 --quiet a.tz run && same "$(cat out)" "$(printf '2\na.tz\nrun')"
  ;;
seed)
  program a.tz 'print random[1.0].' ''
  expect 0 run a.tz --iterations 1 --seed 5 && cp out five && same "$(cat err)" ""
  expect 0 run a.tz --iterations 1 --seed 5 && cmp -s out five || fail "the same seed gives the same numbers"
  expect 0 run a.tz --iterations 1 && has err '^breve: seed [0-9]*$' && cp out drawn
  expect 0 run a.tz --iterations 1 --seed "$(sed 's/.*seed //' err)" && cmp -s out drawn || fail "the drawn seed is shown"
  expect 0 run a.tz --iterations 1 --quiet && same "$(cat err)" ""
  ;;
stats)
  program a.tz 'bug = new Mobile.' 'print turns.'
  expect 0 run a.tz --iterations 7 --seed 3 --stats
  tail -n 1 err | python3 -c '
import json, sys
s = json.loads(sys.stdin.read())
assert list(s) == ["iterations", "sim_seconds", "wall_seconds", "cpu_seconds", "objects", "seed", "hash", "guard"], s
assert s["guard"] == {"reported": 0, "refined": 0, "put to rest": 0}, s
assert s["iterations"] == 7 and abs(s["sim_seconds"] - 0.42) < 1e-12 and s["seed"] == 3 and s["objects"] > 1, s
assert s["wall_seconds"] > 0 and s["cpu_seconds"] >= 0 and s["hash"].startswith("0x"), s' || fail "the statistics"
  ;;
guard)
  cat >a.tz <<END
@use PhysicalControl.
@use Shape.
Controller A.
PhysicalControl : A {
  + to init:
    spinner (object).
    spinner = new Mobile.
    spinner set-shape to (new Cube init-with size (1, 2, 3)).
    spinner enable-physics.
    spinner set-rotational-velocity to (1, 4000, 2).
    self set-accuracy to "fast".
}
END
  expect 0 run a.tz --iterations 3 --seed 1 --stats
  has err '^breve: the guard acted [1-9][0-9]* times$'
  has err ' times: Mobile, refined: .* (first at 0 s, largest value '
  ! grep -q '^breve: guard:' err || fail "each is told with --verbose alone"
  tail -n 1 err | python3 -c '
import json, sys
s = json.loads(sys.stdin.read())["guard"]
assert s["refined"] > 0, s' || fail "the counts"
  expect 0 run a.tz --iterations 3 --seed 1 --verbose
  has err '^breve: guard: 0 s: Mobile, refined: '
  acted=$(sed -n 's/^breve: the guard acted \([0-9]*\) times$/\1/p' err)
  same "$(grep -c '^breve: guard:' err)" "$acted"
  expect 0 run a.tz --iterations 3 --seed 1 --verbose --quiet && same "$(cat err)" ""
  program b.tz '' ''
  expect 0 run b.tz --iterations 3 --seed 1 --verbose && same "$(cat err)" ""
  ;;
hash)
  program a.tz 'bug = new Mobile.' 'bug set-velocity to random[(1, 1, 1)].'
  expect 0 run a.tz --iterations 9 --seed 3 --hash && cp out first
  tail -n 1 out | grep -q -E '^hash 0x[0-9a-f]{16}$' || fail "the last line is the hash"
  expect 0 run a.tz --iterations 9 --seed 3 --hash && cmp -s out first || fail "equal runs, equal hashes"
  expect 0 run a.tz --iterations 9 --seed 4 --hash && ! cmp -s out first || fail "unequal runs, unequal hashes"
  ;;
effects)
  program a.tz 'bug = new Mobile. bug set-velocity to (1, 0, 0).' ''
  expect 0 run a.tz --iterations 3 --quiet --effects
  has out '^effect .*why$' && has out '^motion *yes .*Mobile'
  ;;
positions)
  program a.tz 'bug = new Mobile. bug move to (1.5, 0.1, -3).' ''
  expect 0 run a.tz --iterations 1 --quiet --positions p.csv
  same "$(head -n 1 p.csv)" "class,x,y,z,qw,qx,qy,qz"
  same "$(tail -n +2 p.csv)" "Mobile,1.5,0.10000000000000001,-3,1,0,0,0"
  expect 1 run a.tz --iterations 1 --quiet --positions nowhere/p.csv && has err "nowhere/p.csv"
  ;;
quiet)
  program a.tz 'bug = new Mobile. self schedule method-call "go" at-time -1.' ''
  expect 0 run a.tz --iterations 1 --seed 1 && [ -s err ] || fail "a warning is shown"
  expect 0 run a.tz --iterations 1 --seed 1 --quiet && same "$(cat err)" ""
  ;;
accuracy)
  cat >a.tz <<END
@use PhysicalControl.
Controller Main.
PhysicalControl : Main {
  + to iterate:
    super iterate.
    print (self get-accuracy).
}
END
  expect 0 run a.tz --iterations 1 --seed 1 --quiet && same "$(cat out)" balanced
  expect 0 run a.tz --iterations 1 --seed 1 --quiet --accuracy precise && same "$(cat out)" precise
  expect 2 run a.tz --iterations 1 --accuracy sloppy && has err "balanced"
  # The rung holds from the start of init, and settings that init makes stay.
  cat >b.tz <<END
@use PhysicalControl.
Controller Main.
PhysicalControl : Main {
  + to init:
    print (self get-accuracy).
    self set-accuracy-setting named "impacts" to 7.
  + to iterate:
    super iterate.
    print (self get-accuracy), (self get-accuracy-setting named "impacts").
}
END
  expect 0 run b.tz --iterations 1 --seed 1 --accuracy precise
  same "$(cat out)" "$(printf 'precise\nprecise 7.000000')" && same "$(cat err)" ""
  # If init chooses another rung, the one that was asked for holds, and the loss of settings is said once.
  sed 's/    self set-accuracy-setting/    self set-accuracy to "fast".\n&/' b.tz >c.tz
  expect 0 run c.tz --iterations 1 --seed 1 --accuracy precise
  same "$(cat out)" "$(printf 'precise\nprecise 100.000000')"
  has err "precise.*replaces 'fast'" && same "$(grep -c replaces err)" 1
  sed '/set-accuracy-setting/d' c.tz >d.tz
  expect 0 run d.tz --iterations 1 --seed 1 --accuracy precise && same "$(cat err)" ""
  ;;
coarse-random)
  program a.tz 'print ((random[1.0] * 32767.0 + 0.0000005) % 1.0 < 0.000001).' ''
  expect 0 run a.tz --iterations 1 --seed 1 --quiet --coarse-random && same "$(cat out)" 1
  expect 0 run a.tz --iterations 1 --seed 1 --quiet && same "$(cat out)" 0
  ;;
strict)
  program a.tz 'turns = (self nothing).' ''
  sed -i 's/^}$/  + to nothing: return.\n}/' a.tz
  expect 0 run a.tz --iterations 1
  expect 1 run a.tz --iterations 1 --strict
  ;;
strict_warnings)
  program a.tz 'print "ready".' ''
  sed -i 's/bug (object)\./spare, bug (object)./' a.tz
  expect 0 run a.tz --iterations 1 --seed 1 && has err "warning: .*spare"
  expect 1 run a.tz --iterations 1 --strict && has err "error: .*spare" && same "$(cat out)" ""
  expect 1 run a.tz --iterations 1 --strict --quiet && has err "spare"
  expect 0 check a.tz && expect 1 check a.tz --strict && has err "error: .*spare" && has out "1 error, 0 warnings"
  expect 0 check a.tz --strict --allow lint-unused-variable
  ;;
set)
  program a.tz 'print turns, (self get-random-seed).' ''
  expect 0 run a.tz --iterations 1 --quiet --seed 42 --set turns=5 && same "$(cat out)" "5 42"
  expect 0 run a.tz --iterations 1 --quiet --seed 42 --set turns=5 --set turns=6 && same "$(cat out)" "6 42"
  expect 2 run a.tz --iterations 1 --set turns && has err "NAME=VALUE"
  expect 1 run a.tz --iterations 1 --set trns=5 && has err "turns"
  expect 1 run a.tz --iterations 1 --set turns=many && has err "int"
  ;;
limits_given)
  program a.tz "" 'while 1: turns += 1.'
  expect 3 run a.tz --iterations 1 --budget 1000 && has err "budget"
  printf '@use PhysicalControl.\n@use Mobile.\nController Main.\nPhysicalControl : Main {\n  + to init:\n' >a.tz
  printf '    (new Mobile) enable-physics.\n    self set-accuracy-setting named "step" to 0.00001.\n}\n' >>a.tz
  expect 0 run a.tz --iterations 1 && ! grep -q "finished coarsely" err
  expect 0 run a.tz --iterations 1 --physics-budget 1000 && has err "finished coarsely"
  program a.tz "" 'self down.'
  sed -i 's/^}$/  + to down: self down.\n}/' a.tz
  expect 3 run a.tz --iterations 1 --depth 100 && has err "100"
  program a.tz "" 'while 1: push 1 onto bugs.'
  sed -i 's/turns (int)\./turns (int). bugs (list)./' a.tz
  expect 3 run a.tz --iterations 1 --memory 20
  ;;
near_option)
  program a.tz "" ""
  expect 2 run a.tz --iteration 3 && has err "Did you mean --iterations?"
  expect 2 run a.tz --iterations 1 --sede 3 && has err "Did you mean --seed?"
  expect 2 rnu a.tz && has err "Did you mean run?"
  expect 2 --budget 3 a.tz && has err "options come after a command, as in: breve run --budget"
  expect 2 a.tz && has err "To run a program: breve run a.tz"
  expect 2 run a.tz --zzz && has err "breve help run"
  ;;
includes)
  mkdir -p sub/deep elsewhere
  echo 'Object : Part { + to get: return 42. }' >sub/deep/part.tz
  printf '@use Object.\n@include "deep/part.tz".\n@include "./deep/../deep/part.tz".\n' >sub/parts.tz
  program sub/a.tz 'print ((new Part) get).' ''
  sed -i '1i @include "parts.tz".' sub/a.tz
  expect 0 run sub/a.tz --iterations 1 --quiet && same "$(cat out)" 42 # next to the program, not the launch directory
  cd elsewhere || exit 1
  expect 0 run ../sub/a.tz --iterations 1 --quiet && same "$(cat out)" 42
  ;;
paths)
  mkdir -p one two here there
  echo 'Object : Part { + to get: return "environment". }' >one/Part.tz
  echo 'Object : Part { + to get: return "option". }' >two/Part.tz
  echo 'Object : Part { + to get: return "home". }' >home/Part.tz
  program here/a.tz 'print ((new Part) get).' ''
  sed -i '2i @use Part.' here/a.tz
  expect 0 run here/a.tz --iterations 1 --quiet && same "$(cat out)" home
  BREVE_CLASS_PATH=nowhere:$PWD/one expect 0 run here/a.tz --iterations 1 --quiet && same "$(cat out)" environment
  BREVE_CLASS_PATH=$PWD/one expect 0 run here/a.tz --path there --path two --iterations 1 --quiet && same "$(cat out)" option
  mkdir -p lib/classes
  echo 'Object : Part { + to get: return "launch". }' >lib/classes/Part.tz
  expect 0 run here/a.tz --path two --iterations 1 --quiet && same "$(cat out)" launch
  rm -r lib home/Part.tz
  sed -i '2i @path "two".' here/a.tz
  expect 0 run here/a.tz --iterations 1 --quiet && same "$(cat out)" option
  ;;
compressed)
  program a.tz 'print "unpacked".' ''
  gzip -c a.tz >b.tz
  expect 0 run b.tz --iterations 1 --quiet && same "$(cat out)" unpacked
  head -c 60 b.tz >c.tz
  expect 2 run c.tz --iterations 1 && has err c.tz
  ;;
data_files)
  mkdir sub
  echo picture >sub/data.txt
  program sub/a.tz 'print findFile("data.txt"). print findFile("nothing.txt").' ''
  expect 0 run sub/a.tz --iterations 1 --quiet && same "$(cat out)" "sub/data.txt"
  ;;
files_written_here)
  mkdir sub
  program sub/a.tz 'bug = (new File) open-for-writing with-file "made.txt". bug write text "content". bug close.' ''
  sed -i '2i @use File.' sub/a.tz
  expect 0 run sub/a.tz --iterations 1 --quiet && same "$(cat made.txt)" content
  ;;
record)
  program a.tz 'print random[1000].' 'print random[1000]. print getRealTime().'
  expect 0 run a.tz --iterations 20 --seed 7 --quiet --record a.log --hash && cp out recorded
  expect 0 replay a.log --quiet --hash
  # The times are those of the recorded run; what `init` prints comes from making the world, with the same seed.
  same "$(cat out)" "$(cat recorded)"
  expect 0 replay a.log && has err '20 iterations replayed, each as it was recorded'
  head -c $(($(stat -c %s a.log) - 100)) a.log >cut.log
  expect 0 replay cut.log && has err 'the log has no end'
  echo '# changed' >>a.tz
  expect 1 replay a.log && has err 'has a.tz changed since?'
  expect 1 replay a.tz && has err 'is not a log of `breve run --record`'
  expect 1 replay missing.log && has err "cannot read 'missing.log'"
  rm a.tz
  expect 2 replay a.log && has err "there is no file 'a.tz' here; the log was recorded in $PWD"
  expect 2 run a.tz --record b.log --watch && has err 'record'
  ;;
plugins)
  program a.tz 'print smoothNoise(0.25, 3).' ''
  sed -i '2i @plugin "noise.so"(noise).' a.tz
  expect 1 run a.tz --iterations 1 --quiet && has err "a.tz:2:1: error: cannot load plugin 'noise.so': the host does not allow plugins"
  expect 0 run a.tz --iterations 1 --quiet --allow-plugins "$plugins" && same "$(cat out)" 0.481039
  expect 0 check a.tz --allow-plugins "$plugins"
  sed -i '2s/.*/@plugin "..\/noise.so"(noise)./' a.tz
  expect 1 check a.tz --allow-plugins "$plugins" && has err 'its name must be a path below a directory of --allow-plugins'
  sed -i '2s/.*/@plugin "none.so"(noise)./' a.tz
  expect 1 check a.tz --allow-plugins "$plugins" && has err "there is no such file in $plugins"
  sed -i '2s/.*/@plugin "noise.so"(nothing)./' a.tz
  expect 1 check a.tz --allow-plugins "$plugins" && has err "has no entry 'nothing'"
  echo text >bad.so
  sed -i '2s/.*/@plugin "bad.so"(noise)./' a.tz
  expect 1 check a.tz --allow-plugins . && has err "cannot load plugin 'bad.so'"
  expect 2 run a.tz --allow-plugins nowhere && has err nowhere
  ;;
system)
  program a.tz 'print "before". print system("echo inside").' ''
  expect 0 run a.tz --iterations 1 --quiet --allow-system && has out inside && same "$(head -n 1 out)" before
  expect 1 run a.tz --iterations 1 --quiet && has err 'does not allow scripts to run commands' && has err allow-system
  ;;
access)
  mkdir program data
  echo secret >data/a.txt
  echo own >program/own.txt
  cat >program/a.tz <<END
@use Control.
Controller Main.
Control : Main {
  + to look at s (string):
    f (pointer).
    f = openFileForReading(s).
    if f: print readLine(f). else print "none".
  + to put into s (string):
    f (pointer).
    f = openFileForWriting(s).
    if f: writeString(f, "made"). else print "not written".
  + to init:
    self look at "own.txt".
    self look at "a.txt".
    self look at "program/../data/a.txt".
    self look at "$PWD/data/a.txt".
    self look at "/etc/passwd".
    self put into "here.txt".
    self put into "/tmp/breve-not-here.txt".
}
END
  expect 0 run program/a.tz --iterations 1
  same "$(cat out)" "$(printf 'own\nnone\nsecret\nsecret\nnone\nnot written')"
  has err "none of the directories that the program may use; --allow-read DIR adds one"
  same "$(cat here.txt)" made
  mkdir other && cd other
  expect 0 run ../program/a.tz --iterations 1 --quiet && same "$(cat out)" "$(printf 'own\nnone\nnone\nnone\nnone\nnot written')"
  expect 0 run ../program/a.tz --iterations 1 --quiet --allow-read ../data
  same "$(cat out)" "$(printf 'own\nsecret\nnone\nsecret\nnone\nnot written')"
  rm here.txt
  expect 0 run ../program/a.tz --iterations 1 --quiet --no-files
  same "$(cat out)" "$(printf 'none\nnone\nnone\nnone\nnone\nnot written\nnot written')"
  [ ! -e here.txt ] || fail "written in spite of --no-files"
  expect 2 run ../program/a.tz --allow-read nowhere && has err nowhere
  expect 2 run ../program/a.tz --no-files --allow-read . && has err no-files
  ;;
order_of_output)
  program a.tz 'print "one". print "two". die "three".' ''
  "$breve" run a.tz --iterations 1 --seed 1 >all 2>&1
  same "$(head -n 2 all)" "$(printf 'one\ntwo')"
  grep -q three all || fail "the error follows the output"
  ;;
closed_output)
  program a.tz '' 'print "and again: $turns".'
  (
    "$breve" run a.tz --seed 1 2>err
    echo $? >status
  ) | head -n 2 >out
  same "$(cat status)" 0
  same "$(cat err)" ""
  same "$(wc -l <out)" 2
  ;;
movies)
  program a.tz 'bug = new Mobile. bug set-velocity to (9, 0, 0).' ''
  for kind in mp4 mkv webm avi gif; do
    expect 0 run a.tz --iterations 10 --quiet --size 63x41 --fps 20 --movie "a.$kind"
    [ -s "a.$kind" ] || fail "a.$kind is empty"
  done
  # 0 to 0.6 s in steps of 0.06 s, at 20 frames a second: 13 frames of even sides.
  python3 - a.mp4 <<'END' || fail "what a.mp4 holds"
import struct, sys
data = open(sys.argv[1], "rb").read()
def boxes(begin, end):
    while begin < end:
        size, kind = struct.unpack(">I4s", data[begin:begin + 8])
        yield kind, begin + 8, begin + size
        begin += size
def find(path, begin=0, end=len(data)):
    for kind, first, last in boxes(begin, end):
        if kind == path[0]:
            return (first, last) if len(path) == 1 else find(path[1:], first, last)
table = find([b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsz"])[0]
assert struct.unpack(">I", data[table + 8:table + 12])[0] == 13
header = find([b"moov", b"trak", b"tkhd"])[1]
assert struct.unpack(">II", data[header - 8:header]) == (62 << 16, 40 << 16)
assert find([b"moov"])[0] < find([b"mdat"])[0], "players begin before they have all of it"
END
  expect 1 run a.tz --iterations 1 --quiet --movie a.xyz && has err 'there is no movie format of that name; .mp4'
  expect 1 run a.tz --iterations 1 --quiet --movie nowhere/a.mp4 && has err 'cannot write nowhere/a.mp4: No such file'
  for file in full.mp4 full.gif; do
    ln -s /dev/full "$file"
    expect 1 run a.tz --iterations 1 --quiet --movie "$file" && has err "cannot write $file: No space left on device"
  done
  ln -s /dev/full full.png
  expect 1 run a.tz --iterations 1 --quiet --snapshot full.png && has err 'cannot write full.png: No space left on device'
  # The world goes on where scripts find no space.
  program b.tz '' 'self save-snapshot to "none/b.png".'
  expect 0 run b.tz --iterations 2 --hash && has err "none/b.png' not written" && has out hash
  ;;
movies_without_ffmpeg)
  program a.tz 'bug = new Mobile. bug set-velocity to (9, 0, 0).' ''
  # A library of ffmpeg that cannot be loaded is one that is not there.
  mkdir hidden
  for library in avutil avcodec avformat swscale; do
    for file in /usr/lib/*/lib$library.so.*; do : >"hidden/$(basename "$file" | sed 's/\(so\.[0-9]*\).*/\1/')"; done
  done
  LD_LIBRARY_PATH=$PWD/hidden expect 0 run a.tz --iterations 10 --quiet --size 64x48 --fps 20 --movie none.mp4
  has err 'libav[a-z]*.so.[0-9]* is not installed, so the frames go to none.mp4.frames as numbered pictures' && [ ! -e none.mp4 ]
  [ "$(ls none.mp4.frames | wc -l)" = 13 ] || fail "numbered pictures in place of none.mp4"
  LD_LIBRARY_PATH=$PWD/hidden expect 0 run a.tz --iterations 2 --quiet --size 64x48 --movie none.gif && [ -s none.gif ]
  # The same for the class Movie.
  program m.tz 'bug = new Movie. bug record to "walk.mpeg".' ''
  sed -i '2i @use Movie.' m.tz
  mkdir packed numbered
  cd packed
  expect 0 run ../m.tz --iterations 3 --quiet && [ -s walk.mpeg ] && [ ! -e walk_00000.png ] || fail "a Movie is not packed"
  cd ../numbered
  LD_LIBRARY_PATH=$PWD/../hidden expect 0 run ../m.tz --iterations 3
  has err "is not installed, so 'walk.mpeg' becomes numbered pictures"
  [ -s walk_00002.png ] && [ ! -e walk.mpeg ] || fail "no numbered pictures"
  cd ..
  ;;
plot_png)
  program a.tz '' ''
  expect 0 run a.tz --iterations 20 --quiet --plot turns --plot-to a.png && has a.csv '^time,turns'
  # 900 x 520 pixels, white paper, and a line of the first ink from the lower left to the upper right.
  python3 - <<'END' || fail "what a.png shows"
import struct, zlib
data, at, pixels = open("a.png", "rb").read(), 8, b""
while at < len(data):
    size, kind = struct.unpack(">I4s", data[at:at + 8])
    if kind == b"IHDR": width, height = struct.unpack(">II", data[at + 8:at + 16])
    if kind == b"IDAT": pixels += data[at + 8:at + 8 + size]
    at += 12 + size
assert (width, height) == (900, 520)
raw, rows, before = zlib.decompress(pixels), [], bytearray(4 * width)
for y in range(height):
    filter, row = raw[y * (4 * width + 1)], bytearray(raw[y * (4 * width + 1) + 1:(y + 1) * (4 * width + 1)])
    for x in range(len(row)):
        a, b, c = (row[x - 4] if x > 3 else 0), before[x], (before[x - 4] if x > 3 else 0)
        p = a + b - c
        nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        row[x] = (row[x] + (0, a, b, (a + b) // 2, nearest)[filter]) & 255
    rows.append(row); before = row
ink = [(x, y) for y in range(70, 450) for x in range(92, 876) if abs(rows[y][4 * x] - 0) < 30 and abs(rows[y][4 * x + 2] - 178) < 30]
assert rows[5][:4] == bytes([255] * 4) and len(ink) > 500
low, high = min(ink), max(ink)
assert low[0] < 110 and low[1] > 430 and high[0] > 860 and high[1] < 80
END
  ln -s /dev/full full.png
  expect 1 run a.tz --iterations 2 --quiet --plot turns --plot-to full.png && has err 'No space left on device'
  (ulimit -f 1; trap '' XFSZ; "$breve" run a.tz --iterations 20 --quiet --plot turns --plot-to large.png 2>err)
  [ $? = 1 ] && [ ! -e large.png ] || fail "half a plot is left"
  expect 1 run a.tz --iterations 2 --quiet --plot turns && has err 'add --plot-to OUT.svg, --log OUT.csv or --live'
  expect 1 run a.tz --iterations 2 --quiet --snapshot a.jpg && has err "name it 'a.png' instead of 'a.jpg'"
  [ ! -e a.jpg ] || fail "a PNG is called JPEG"
  ;;
damaged_pictures)
  python3 - <<'END'
import struct, zlib
def chunk(kind, data): return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
def png(width, height, pixels): return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
                                        chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))
whole = png(8, 8, b"".join(b"\0" + bytes(32) for _ in range(8)))
files = {"cut": whole[:60], "short": png(8, 8, b"\0" * 40), "huge": png(100000, 100000, b"\0" * 40), "wide": png(30000, 30000, b"\0" * 40),
         "none": b"", "text": b"not a picture", "zero": png(0, 8, b""), "jpeg": b"\xff\xd8\xff\xe0" + bytes(40),
         "tga": bytes([0, 0, 2]) + bytes(9) + b"\xff\xff\xff\xff\x20\0"}
for name, data in files.items(): open(name + ".png", "wb").write(data)
END
  program a.tz '' 'print "on".'
  sed -i 's/^  + to iterate:/  + to try file name (string):\n    if ((new Image) load from name): print "loaded", name.\n&/; 2i @use Image.' a.tz
  for name in cut short huge none text zero jpeg; do
    sed "s/bug = 0\./self try file \"$name.png\"./" a.tz >b.tz
    expect 0 run b.tz --iterations 1 --seed 1 --memory 200 && has err "$name.png' not loaded: cannot read image file" && same "$(cat out)" on
  done
  for name in wide tga; do # 3.6 and 17 GB of pixels
    sed "s/bug = 0\./self try file \"$name.png\"./" a.tz >b.tz
    "$breve" run b.tz --iterations 1 --seed 1 --memory 200 >out 2>err
    [ $? -le 3 ] && [ -s err ] || fail "$name.png is refused with a message"
    ! grep -q loaded out || fail "$name.png is loaded"
  done
  ;;
live)
  # `script` runs it on a terminal; what that shows is in out.
  program a.tz 'bug = new Mobile. bug set-color to (1, 0, 0). self point-camera at (0, 0, 0) from (0, 5, 9).' 'print "step $turns".'
  COLORTERM=truecolor script -qec "'$breve' run a.tz --iterations 20 --seed 1 --live --plot turns" /dev/null >out </dev/null 2>err ||
    fail "--live on a terminal"
  has out '▀' && has out '38;2;' && has out 'iteration 20' && has out 'turns 20' && has out '█' && has out 'step 20'
  # Red in the middle: the body, seen from above.
  python3 - out <<'END' || fail "the body is not seen"
import re, sys
text = open(sys.argv[1], encoding="utf-8").read()
assert any(int(r) > 150 and int(g) < 90 for r, g in re.findall(r"[34]8;2;(\d+);(\d+);\d+", text))
END
  COLORTERM='' script -qec "'$breve' run a.tz --iterations 2 --seed 1 --live" /dev/null >out </dev/null 2>err
  has out '38;5;'
  expect 0 run a.tz --iterations 2 --seed 1 --live && has err '--live needs a terminal'
  ;;
picture_sizes)
  program a.tz '' ''
  for size in 0x10 10x0 1000000x10 10x1000000; do
    expect 1 run a.tz --iterations 1 --quiet --size $size --snapshot a.png && has err 'each side must be from 1 to 16384'
  done
  for size in x 10 10x 10x-3 9999999999x2; do
    expect 1 run a.tz --iterations 1 --quiet --size $size --snapshot a.png && has err "'$size' is not a WIDTHxHEIGHT"
  done
  [ ! -e a.png ] || fail "a picture of no size"
  expect 0 run a.tz --iterations 1 --quiet --size 1x1 --snapshot a.png --movie a.gif && [ -s a.gif ]
  ;;
interrupt)
  program a.tz 'print "begun".' ''
  "$breve" run a.tz --seed 1 --stats >out 2>err &
  runner=$!
  for _ in $(seq 100); do
    grep -q begun out && break
    sleep 0.1
  done
  kill -INT $runner
  wait $runner
  same $? 0
  tail -n 1 err | python3 -c 'import json,sys; assert json.loads(sys.stdin.read())["iterations"] >= 0' || fail "statistics"
  ;;
progress)
  # On a terminal of 60 columns, which `script` makes. The run goes on until it is interrupted.
  program a.tz '' 'turns = turns + 1.'
  script -qc "stty cols 60; timeout -s INT 4 '$breve' run a.tz --seed 1 --seconds 1000000000" typescript >/dev/null </dev/null
  tr '\r' '\n' <typescript | sed 's/\x1b\[K//' | grep ^iteration >out
  has out '^iteration [0-9]*, 0 % of 1000000000 s, [0-9]* h [0-9]* min to go$'
  lacks out '.\{60\}'
  script -qc "stty cols 200; timeout -s INT 4 '$breve' run a.tz --seed 1 --iterations 1000000000" typescript >/dev/null </dev/null
  tr '\r' '\n' <typescript | sed 's/\x1b\[K//' >out
  has out '^iteration [0-9]* of 1000000000, .* to go, .* x real time, .* s simulated, .* iterations/s$'
  ;;
check)
  program good.tz '' ''
  program bad.tz 'nowhere = 3. nothing = 4.' ''
  expect 0 check good.tz && has out '^1 file: 0 errors'
  expect 1 check good.tz bad.tz && has out '^2 files: 2 errors' && has err '^bad.tz:10:5' && lacks err 'good.tz:.*error'
  ;;
*) fail "there is a case '$case'" ;;
esac
