#!/bin/bash
# Programs whose natives could work for minutes: under a budget and a memory limit each ends at once with a status.
# unbounded.sh PATH-OF-BREVE CASE. A test's time limit is that of its registration.
set -u
breve=$(realpath "$1")
case=$2
. "$(dirname "$0")/../case.sh"

# ends STATUS CLASSES INIT: a controller with these statements; STATUS 3: a limit is hit.
ends() {
  local wanted=$1 classes=$2 status
  {
    echo "@use PhysicalControl."
    for name in $classes; do echo "@use $name."; done
    cat <<END
Controller Main.
PhysicalControl : Main {
  + variables:
    text (string).
    items (list).
    one, other (object).
    i, n (int).
    x (float).
  + to init:
    $3
}
END
  } >a.tz
  "$breve" run a.tz --iterations 3 --seed 1 --budget 1000000 --memory 256 --quiet >out 2>err
  status=$?
  [ $status = "$wanted" ] || fail "status $status and not $wanted"
}

case $case in
matrix_product)
  ends 3 Matrix "one = (new Matrix2D init-with x-size 3000 y-size 3000). other = (new Matrix2D init-with x-size 3000 y-size 3000).
    one transform with-matrix other with-result other."
  ;;
matrix_printed) ends 3 Matrix "(new Matrix2D init-with x-size 5000 y-size 5000) print-matlab-style." ;;
image_deflated) ends 3 Image "n = ((new Image init-with width 5500 height 5500) get-compression-size)." ;;
image_written) ends 3 Image "(new Image init-with width 5500 height 5500) write to \"a.png\"." ;;
list_copied) ends 3 "" "for i = 0, i < 100000, i++: push i onto items. for i = 0, i < 100000, i++: n = |copylist items|." ;;
list_inserted_into)
  ends 3 "" "for i = 0, i < 400000, i++: push i onto items. for i = 0, i < 300000, i++: insert 5 at items{200000}."
  ;;
list_taken_from)
  ends 3 "" "for i = 0, i < 400000, i++: push i onto items. for i = 0, i < 200000, i++: n = remove items{100000}."
  ;;
deviation) ends 3 "" "for i = 0, i < 300000, i++: push 1.5 onto items. for i = 0, i < 100000, i++: x = stddev(items)." ;;
string_doubled) ends 3 "" "text = \"0123456789abcdef\". for i = 0, i < 40, i++: text = text + text." ;;
string_interpolated)
  ends 3 "" "text = \"0123456789abcdef\". for i = 0, i < 22, i++: text = text + text.
    text = \"\$text\$text\$text\$text\$text\$text\$text\$text\"."
  ;;
string_changed)
  ends 3 "" "text = \"x\". for i = 0, i < 24, i++: text = text + text. for i = 0, i < 100000, i++: text{3} = \"y\"."
  ;;
cells_counted)
  ends 3 PatchGrid "one = new PatchGrid. one init-with x-count 500 y-count 500 z-count 500. one randomize-states with-density 0.5."
  ;;
terrain_grown) ends 3 Terrain "one = new Terrain. for i = 0, i < 8, i++: one generate." ;;
archive_parsed)
  ends 3 "" "text = \"<a><a><a><a>\". for i = 0, i < 20, i++: text = text + text. self parse-xml-network-request from-string text."
  ;;
sub_steps)
  ends 3 Mobile "self set-integration-step to 0.000001. self set-iteration-step to 0.9. for i = 0, i < 300, i++: new Mobile."
  ;;
physics_steps)
  ends 0 Mobile "one = new Mobile. one enable-physics. self set-accuracy to \"precise\".
    self set-accuracy-setting named \"step\" to 1.0e-11."
  ;;
physics_stiff)
  ends 0 "Mobile Shape Spring" "self set-accuracy to \"reference\".
    for i = 0, i < 40, i++: {
      other = new Mobile. other set-shape to (new Cube init-with size (1, 1, 1)). other move to (i * 2, 0, 0). other enable-physics.
      if one: (new Spring) connect from one to other with-length 1.0 with-strength 1.0e12 with-damping 0.0.
      one = other.
    }"
  ;;
rings_held)
  ends 0 "Link Joint" "self set-accuracy to \"precise\".
    for i = 0, i < 300, i++: {
      push (new Link) onto items. items{i} move to (i * 3, 0, 0).
      if i > 0: (new BallJoint) link parent items{i - 1} to-child items{i} with-parent-point (1.5, 0, 0) with-child-point (-1.5, 0, 0).
    }
    for i = 0, i < 298, i++: (new BallJoint) link parent items{i} to-child items{i + 2} with-parent-point (3, 0, 0) with-child-point (-3, 0, 0)."
  ;;
bodies_asked)
  ends 3 "Mobile Shape" "one = (new Cube init-with size (1, 1, 1)).
    for i = 0, i < 3000, i++: { other = new Mobile. other set-shape to one. other enable-physics. }
    for i = 0, i < 1000, i++: items = (other get-colliding-objects)."
  ;;
classes_in_a_chain)
  {
    printf '@use Control.\nController Main.\nControl : Main {}\nObject : C0 {}\n'
    for ((i = 1; i < 3000; ++i)); do printf 'C%d : C%d {}\n' $((i - 1)) "$i"; done
  } >a.tz
  "$breve" run a.tz --iterations 1 >out 2>err
  same "$?" 1
  has err "class C256 has more than 256 ancestors"
  same "$(grep -c 'ancestors' err)" 11
  ;;
errors_in_a_long_text)
  {
    printf '@use Control.\nController Main.\nControl : Main {\n  + variables:\n    other (object).\n    i (int).\n'
    printf '  + to fly:\n    other land.\n  + to init:\n    for i = 0, i < 2000, i++: callMethodNamed(self, "fly", {}).\n'
    sum=$(printf '1 + %.0s' {1..200})
    for ((i = 0; i < 1500; ++i)); do printf '  + to pad%d:\n    return %s1.\n' "$i" "$sum"; done
    printf '}\n'
  } >a.tz
  "$breve" run a.tz --iterations 1 --seed 1 >out 2>err
  same "$?" 0
  has err "assign an object before this line"
  ;;
print_bounded)
  printf '@use Control.\nController Main.\nControl : Main {\n  + variables:\n    text (string).\n    i (int).\n' >a.tz
  printf '  + to init:\n    text = "0123456789abcdef".\n    for i = 0, i < 16, i++: text = text + text.\n' >>a.tz
  printf '    for i = 0, i < 100, i++: print text.\n}\n' >>a.tz
  "$breve" run a.tz --iterations 1 --seed 1 >out 2>err
  same "$?" 1
  has err "more than 64 MB are printed in one iteration"
  same "$(wc -l <out)" 63
  rm out
  ;;
reports_bounded)
  printf '@use Control.\nController Main.\nControl : Main {\n  + variables:\n    i (int).\n' >a.tz
  printf '  + to iterate:\n    super iterate.\n    for i = 0, i < 5000, i++: callMethodNamed(self, "fly", {}).\n}\n' >>a.tz
  "$breve" run a.tz --iterations 2 --seed 1 --stats >out 2>err
  same "$?" 0
  same "$(grep -c 'warning: class Main has no method .fly. with 0 parameters' err)" 2000
  same "$(grep -c 'further ones are counted, but not shown' err)" 2
  ;;
program_bounded)
  printf '@use Control.\n' >a.tz
  for part in 1 2 3; do
    printf '@include "part%d.tz".\n' $part >>a.tz
    {
      printf 'Object : P%d {\n  + variables:\n    x (int).\n' $part
      for ((i = 0; i < 125; ++i)); do
        printf '  + to m%d:\n' $i
        printf '    x = x + %d * 3.\n' {1..800}
      done
      printf '}\n'
    } >part$part.tz
  done
  printf 'Controller Main.\nControl : Main {\n  + to init:\n    print 1.\n}\n' >>a.tz
  "$breve" check a.tz >out 2>err
  same "$?" 1
  has err "part3.tz:1:1: error: the files of the program have more than 2000000 tokens together"
  {
    printf '@use Control.\nController Main.\nControl : Main {\n  + to init:\n'
    printf '    y%d = 1.\n' {1..5000}
    printf '}\n'
  } >b.tz
  "$breve" check b.tz >out 2>err
  same "$?" 1
  same "$(grep -c 'error: more errors follow' err)" 1
  same "$(grep -c 'error: ' err)" 1001
  ;;
*) fail "there is no case $case" ;;
esac
