#!/bin/bash
# What compiling and reporting could do for minutes, or print without end.
# unbounded.sh PATH-OF-BREVE CASE. A test's time limit is that of its registration.
set -u
breve=$(realpath "$1")
case=$2
. "$(dirname "$0")/../case.sh"

case $case in
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
