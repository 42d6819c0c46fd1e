#!/usr/bin/env bash
# Feeds one hostile input to the breve command. It passes if the command ends in time, by itself, with an exit status
# that says what was wrong, and says something about it. Usage: hostile.sh BREVE CASE   (hostile.sh --list)
set -uo pipefail

# The cases, each with the exit statuses it may end with: 1 error in the program, 2 wrong usage or a program file that
# cannot be read, 3 a limit was hit.
declare -A expected=(
  [deep_parentheses]=1 [deep_unary]="0 1" [deep_lists]=1 [deep_blocks]=1 [deep_if_else]="0 1" [deep_bars]=1
  [long_line]=1 [long_name]=1 [long_string]=0 [unclosed_string]=1 [unclosed_comment]=1 [unclosed_block]=1
  [random_bytes]=1 [more_random_bytes]=1 [zero_bytes]=1 [broken_gzip]=2 [empty_file]=1 [only_comment]=1
  [many_errors]=1 [list_of_a_million]="0 1" [many_classes]=0 [infinite_recursion]="1 3" [mutual_recursion]="1 3"
  [recursion_in_init]="1 3" [nested_lists]="0 1" [self_including]=1 [inheritance_of_itself]=1
  [missing_file]=2 [missing_include]=1 [directory]=2 [no_controller]=1 [unknown_option]=2 [no_file]=2
)

if [[ ${1-} == --list ]]; then
  printf '%s\n' "${!expected[@]}" | sort
  exit 0
fi
if (($# != 2)) || [[ -z ${expected[$2]+known} ]]; then
  echo "usage: $0 BREVE CASE; $0 --list" >&2
  exit 2
fi
breve=$1 name=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
input=$scratch/$name.tz
arguments=(run "$input" --iterations 3 --seed 1 --quiet)

# --- making the inputs ------------------------------------------------------------------------------------------------

# repeat TEXT COUNT: TEXT so many times, on one line.
repeat() { awk -v text="$1" -v count="$2" 'BEGIN { for (i = 0; i < count; i++) printf "%s", text }'; }

# Everything from stdin becomes the body of the controller's init.
in_init() {
  printf '@use Control.\nController Hostile.\nControl : Hostile {\n+ to init:\n%s\n' "${1-}"
  cat
  printf '\n}\n'
}

# Pseudo-random bytes that are the same each time.
noise() {
  # shellcheck disable=SC2059  # the format is the bytes
  printf "$(awk -v seed="$1" -v count="$2" 'BEGIN {
    for (i = 0; i < count; i++) { seed = (seed * 16807) % 2147483647; printf "\\%03o", int(seed / 65536) % 256 }
  }')"
}

make_input() {
  local depth=100000
  case $name in
    deep_parentheses) { printf 'n = '; repeat '(' $depth; printf 1; repeat ')' $depth; echo .; } | in_init 'n (int).' ;;
    deep_unary) { printf 'n = '; repeat '!' $depth; echo '1.'; } | in_init 'n (int).' ;;
    deep_lists) { printf 'k = '; repeat '{ ' $depth; printf 1; repeat ' }' $depth; echo .; } | in_init 'k (list).' ;;
    deep_blocks) { repeat '{ ' $depth; printf 'print 1. '; repeat ' }' $depth; } | in_init ;;
    deep_if_else) { repeat 'if 0: print 1. else ' $depth; echo 'print 2.'; } | in_init ;;
    deep_bars) { printf 'n = '; repeat '| ' $depth; printf 1; repeat ' |' $depth; echo .; } | in_init 'n (int).' ;;
    long_line) { repeat 'n = n + 1 ' 1000000; echo .; } | in_init 'n (int).' ;;
    long_name) { repeat abcdefghij 1000000; echo ' = 1.'; } | in_init ;;
    long_string) { printf 's = "'; repeat abcdefghij 1000000; echo '". if |s| != 10000000: die "short".'; } | in_init 's (string).' ;;
    unclosed_string) echo 'print "and so it went on' | in_init ;;
    unclosed_comment) echo 'print 1. #! and so it went on' | in_init ;;
    unclosed_block) { repeat '{ ' 1000; echo 'print 1.'; } | in_init ;;
    random_bytes) noise 7 100000 ;;
    more_random_bytes) { printf '@use Control.\n'; noise 8 100000; } ;;
    zero_bytes) head -c 100000 /dev/zero ;;
    broken_gzip) { printf '\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03'; noise 9 1000; } ;;
    empty_file) : ;;
    only_comment) echo '# nothing here' ;;
    many_errors) repeat 'unknown-name = 1. ' 100000 | in_init ;;
    list_of_a_million) { printf 'k = { 0'; repeat ', 1' 999999; echo ' }. if |k| != 1000000: die "short".'; } | in_init 'k (list).' ;;
    many_classes)
      printf '@use Control.\nController Hostile.\nControl : Hostile {\n}\n'
      awk 'BEGIN { for (i = 0; i < 5000; i++) printf "Object : Kind%d {\n+ to tell:\nprint %d.\n}\n", i, i }' ;;
    infinite_recursion)
      printf '@use Control.\nController Hostile.\nControl : Hostile {\n+ to iterate:\nself fall.\n+ to fall:\nself fall.\n}\n' ;;
    mutual_recursion)
      printf '@use Control.\nController Hostile.\nControl : Hostile {\n+ to iterate:\nself ping with 1.\n'
      printf '+ to ping with n (int):\nreturn 1 + (self pong with n + 1).\n+ to pong with n (int):\nreturn 1 + (self ping with n + 1).\n}\n' ;;
    recursion_in_init)
      printf '@use Control.\nController Hostile.\nObject : Egg {\n+ to init:\nnew Egg.\n}\nControl : Hostile {\n+ to init:\nnew Egg.\n}\n' ;;
    nested_lists)
      printf "for n = 0, n < 100000, n++: k = { k }.\nm = copylist k.\nprint m == k.\nprint k.\n" |
        in_init $'k, m (list).\nn (int).' ;;
    self_including) printf '@include "%s.tz"\n@include "%s.tz"\n' "$name" "$name" ;;
    inheritance_of_itself) printf '@use Control.\nController Hostile.\nHostile : Hostile {\n}\n' ;;
    missing_include) { printf '@include "there-is-no-such-file.tz"\n'; echo 'print 1.' | in_init; } ;;
    no_controller) printf '@use Control.\nControl : Nobody {\n}\n' ;;
    *) echo 'print 1.' | in_init ;;
  esac
}

make_input >"$input"
case $name in
  missing_file) rm "$input" ;;
  directory) rm "$input" && mkdir "$input" ;;
  unknown_option) arguments+=(--no-such-option) ;;
  no_file) arguments=(run) ;;
esac

# --- running ----------------------------------------------------------------------------------------------------------

cd "$scratch" || exit 1
timeout --signal=KILL "${HOSTILE_SECONDS:-60}" "$breve" "${arguments[@]}" >"$scratch/out" 2>"$scratch/err" </dev/null
status=$?

problem=
if ((status == 137)); then
  problem="did not end in time"
elif [[ " ${expected[$name]} " != *" $status "* ]]; then
  problem="exit status $status, expected ${expected[$name]}"
elif ((status == 0)) && [[ -s $scratch/err ]]; then
  problem="said something on stderr, though nothing was wrong"
elif ((status != 0)) && [[ ! -s $scratch/err ]]; then
  problem="failed without a word"
elif (($(wc -c <"$scratch/err") > 1000000)); then
  problem="more than a megabyte of messages"
elif ((status == 1)) && ! grep -aq "$name" "$scratch/err"; then
  problem="the message does not name the file"
fi
if [[ $problem ]]; then
  echo "$name: $problem"
  echo "--- stderr:"
  head -c 2000 "$scratch/err"
  exit 1
fi
echo "$name: as it should; exit status $status"
