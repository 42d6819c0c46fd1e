#!/bin/bash
# `breve repl` through pipes and `breve run --watch`, one case a run: live.sh PATH-OF-BREVE CASE.
set -u
breve=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
case=$2
. "$here/../case.sh"
watched=
trap '[ -z "$watched" ] || kill "$watched" 2>/dev/null; rm -rf "$work"' EXIT

# repl ARGS...: type standard input.
repl() { "$breve" repl "$@" >out 2>err || fail "status $? of: breve repl $*"; }
# soon FILE TEXT: FILE has TEXT before long.
soon() {
  for _ in $(seq 600); do
    grep -q -e "$2" "$1" && return
    sleep 0.05
  done
  fail "$1 has '$2' soon"
}

# program NAME ITERATE [METHOD]: a controller that iterates slowly.
program() {
  cat >"$1" <<END
@use Control.
@use Mobile.
Controller Main.
Control : Main {
  + variables:
    turns (int).
    bugs (list).
  + to init:
    bugs = 3 new Bug.
  + to iterate:
    turns += 1.
    $2
    super iterate.
  + to greet who w (string):
    return "hello \$w".
  ${3:-}
}
Mobile : Bug (aka Bugs) {
  + variables:
    speed (float).
  + to init:
    speed = 1.5.
    self set-velocity to (1, 0, 0).
}
END
}
watch() {
  "$breve" run "$1" --seed 1 --watch >out 2>err &
  watched=$!
}

case $case in
repl_values)
  program a.tz ''
  repl a.tz <<'END'
2 + 3
1.5 * 2
"a\n" + "\"b\""
turns + 1.
self greet who "you"
{ 1, "two", (1, 2, 3) }
print "no value".
x = 5
x * 2
foreach e in { 1, 2 }: print "e$e".
e
END
  same "$(cat out)" "$(printf '%s\n' 5 3.000000 '"a\n\"b\""' 1 '"hello you"' '{ 1, two, (1.00000, 2.00000, 3.00000) }' 'no value' 5 10 e1 e2 2)"
  same "$(cat err)" ""
  ;;
repl_goes_on_after_errors)
  program a.tz ''
  repl a.tz <<'END'
nowhere
self gret who "x".
die "ouch".
)
:foo
:step many
turns + 7
END
  same "$(cat out)" 7
  has err "input:1:1: error: unknown variable 'nowhere'" && has err "gret" && has err "ouch" && has err ":foo" && has err "iterations"
  ;;
repl_lines_that_go_on)
  program a.tz ''
  printf 'if 1: {\n  print "one".\n\n  print "two".\n}\nx = {\n1,\n2 }\n|x|\nx = 1 +\n' | "$breve" repl a.tz >out 2>err || fail status
  same "$(cat out)" "$(printf 'one\ntwo\n{ 1, 2 }\n2')"
  has err "input:1" # the end of the text ends the last entry
  ;;
repl_commands)
  program a.tz ''
  repl a.tz <<'END'
:time
:step
:step 2
:run 0.3
turns
:objects
:objects Bug
:describe bugs{0}
:describe 5
:effects
:help
:quit
print "not reached".
END
  has out '^0 s, iteration 0, one is 0.06 s$' && has out '^0.06 s, iteration 1,' && has out '^0.18 s, iteration 3,' && has out '^0.48 s, iteration 8,'
  has out '^8$' && has out '^ *3 Bug$' && has out '^Bug (0x[0-9a-f]*) at (0.48, 0, 0)$' && has out '^    speed = 1.500000$' && has out '^  Real$'
  has out '^int: 5$' && has out '^motion *yes' && has out ':describe EXPR' && lacks out reached
  same "$(cat err)" ""
  ;;
repl_reload)
  program a.tz ''
  mkfifo in
  "$breve" repl a.tz <in >out 2>err &
  watched=$!
  exec 3>in
  printf 'turns = 40. x = 1.\n:step\n' >&3
  soon out 'iteration 1,'
  sed 's/turns += 1/turns += 100/; s/hello/good day/' a.tz >b.tz
  mv b.tz a.tz
  printf ':reload\n:step\nturns + x\nself greet who "you".\n' >&3
  soon out 'good day'
  echo 'turns' >>a.tz
  printf ':reload\n:step\nturns\n' >&3
  exec 3>&-
  wait "$watched"
  same $? 0
  watched=
  has err 'a.tz reloaded' && has err 'a.tz is not reloaded'
  has out '^142$' && has out '^"good day you"$' && has out '^241$'
  ;;
repl_reloads_samples_unchanged)
  samples=$(cd "$here/../../samples/worlds" && pwd)
  for world in flock gas aggregation random_walk; do
    tell='foreach one in (all Real): print (one get-location), (one get-rotation).'
    printf ':step 20\n:reload\n:step 20\n:reload\n:step\n%s\n' "$tell" | "$breve" repl --quiet "$samples/$world.tz" >all 2>err || fail status
    has err reloaded && grep -v iteration all >reloaded
    printf ':step 41\n%s\n' "$tell" | "$breve" repl --quiet "$samples/$world.tz" >all 2>err || fail status
    grep -v iteration all >straight
    [ -s straight ] && cmp -s straight reloaded || fail "$world goes on as though nothing had happened"
  done
  ;;
repl_without_file)
  repl <<'END'
b = (new Mobile)
b move to (1, 2, 3).
b get-location
:objects Mobile
:reload
END
  has out '^(1.00000, 2.00000, 3.00000)$' && has out '^Mobile (0x[0-9a-f]*) at (1, 2, 3)$' && has err 'no file'
  ;;
repl_refuses)
  "$breve" repl nowhere.tz </dev/null >out 2>err
  same $? 2 && has err nowhere.tz
  echo 'Controller' >a.tz
  "$breve" repl a.tz </dev/null >out 2>err
  same $? 1 && has err 'a.tz:'
  ;;
watch_reloads)
  program a.tz 'print "one". sleep(0.01).'
  watch a.tz
  soon out one
  program a.tz 'print "two $turns". sleep(0.01).'
  soon err 'a.tz reloaded'
  soon out 'two [1-9]' # variables are kept
  program b.tz 'print "three". sleep(0.01).'
  mv b.tz a.tz # as editors do
  soon out three
  ;;
watch_reports_errors_and_goes_on)
  program a.tz 'print "one $turns". sleep(0.01).'
  watch a.tz
  soon out one
  program a.tz 'print "two". nowhere = 1.'
  soon err 'a.tz is not reloaded'
  has err 'nowhere' && lacks out two
  before=$(wc -l <out)
  for _ in $(seq 100); do [ "$(wc -l <out)" -gt "$before" ] && break; sleep 0.05; done
  [ "$(wc -l <out)" -gt "$before" ] || fail "the old program goes on"
  sed 's/Mobile : Bug/Stationary : Bug/; s/@use Mobile/@use Stationary/; s/self set-velocity.*//; s/ nowhere = 1[.]//' a.tz >b.tz
  mv b.tz a.tz
  soon err 'Stationary'
  program a.tz 'print "three". sleep(0.01).'
  soon out three
  ;;
watch_modules)
  program a.tz 'print (self word). sleep(0.01).' '+ to word: return ((new Part) get).'
  sed -i '1i @include "part.tz".' a.tz
  echo 'Object : Part { + to get: return "old". }' >part.tz
  sed -i '1i @use Object.' part.tz
  watch a.tz
  soon out old
  sed -i 's/old/new/' part.tz
  soon out new
  has err '2 files'
  ;;
watch_waits_for_mending)
  program a.tz 'if turns > 3: die "broken". sleep(0.01).'
  watch a.tz
  soon err 'broken'
  soon err 'waiting'
  program a.tz 'print "mended". sleep(0.01).'
  soon out mended
  kill -INT "$watched"
  wait "$watched"
  same $? 0
  watched=
  ;;
*)
  fail "there is no case $case"
  ;;
esac
exit 0
