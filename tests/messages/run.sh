#!/bin/sh
# Golden tests of messages: what `breve` says about each program here, byte for byte.
#   run.sh BREVE FOLDER [PART-OF-PATH]            compare with NAME.expected beside each NAME.tz
#   run.sh --accept BREVE FOLDER [PART-OF-PATH]   write NAME.expected anew: read the difference before you keep it
# A program is given to `breve check`, unless its first line says otherwise: "# command: run --iterations 3 --seed 1".
# A file in a folder named "parts" is loaded by others. Standard output and standard error are taken in one. The numbers
# of objects (0x...) are left out: they depend on what the class library makes.
accept=
if [ "$1" = --accept ]; then
  accept=yes
  shift
fi
breve=$(realpath "$1")
cd "$2" || exit 2
failed=0
count=0
actual=$(mktemp)
trap 'rm -f "$actual"' EXIT
for program in $(find . -name '*.tz' ! -path '*/parts/*' -path "*$3*" | sort); do
  count=$((count + 1))
  command=$(sed -n '1s/^# command: //p' "$program")
  set -- ${command:-check}
  word=$1
  shift
  {
    (cd "$(dirname "$program")" && "$breve" "$word" "$(basename "$program")" "$@") 2>&1 </dev/null
    echo "exit status $?"
  } | sed 's/0x[0-9a-f][0-9a-f]*/0x#/g' >"$actual"
  expected=${program%.tz}.expected
  if [ -n "$accept" ]; then
    cmp -s "$actual" "$expected" || { cat "$actual" >"$expected" && echo "wrote $expected"; }
  elif ! cmp -s "$actual" "$expected"; then
    failed=$((failed + 1))
    echo "FAILED $program"
    diff -u "$expected" "$actual" | sed 1,2d
  fi
done
[ "$count" -gt 0 ] || { echo "no programs found"; exit 2; }
echo "$((count - failed)) passed, $failed failed"
[ "$failed" -eq 0 ]
