#!/usr/bin/env bash
# The binary interface that breve.h, with its parts, sound.h, analysis.h, view.h and breve_lua.h declare is the one that is
# described in breve.abi: functions, the sizes and fields of structs, the numbers of enumerators. The description is of a
# library of empty functions, made from the headers alone; hosts that link the real ones see that these have them all.
# Usage: check.sh [--renew]     --renew writes breve.abi anew
set -euo pipefail

for tool in abidw abidiff gcc; do
  command -v "$tool" >/dev/null || { echo "check.sh: not found: $tool (Debian: abigail-tools, gcc)" >&2; exit 2; }
done
[[ $(uname -m) == x86_64 ]] || { echo "check.sh: the description is of x86-64: nothing is compared"; exit 0; }
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
include=$(realpath "$here/../../hostapi/include")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

{
  echo '#include "breve/analysis.h"'
  echo '#include "breve/view.h"'
  echo '#include "breve/sound.h"'
  echo '#include "breve/breve_lua.h"'
  cat "$include"/breve/{breve,batch,debug_draw,events,plugin,record,sound,space,step,analysis,view,breve_lua}.h |
    awk '/^BREVE_API / { on = 1 } on { print } /;/ { on = 0 }' | sed -e 's@/\*.*\*/@@' -e 's/^BREVE_API //' -e 's/;.*/ { __builtin_trap(); }/'
} >"$work/functions.c"
(cd "$work" && gcc -std=c11 -g -O0 -fPIC -shared -w -I "$include" functions.c -o libbreve.so)
functions=$(grep -c '__builtin_trap' "$work/functions.c")
((functions >= 150)) || { echo "check.sh: found $functions functions in the headers: the pattern is out of date" >&2; exit 2; }
abidw --headers-dir "$include" --no-corpus-path --no-comp-dir-path --no-show-locs --no-parameter-names \
  --no-write-default-sizes --type-id-style hash   --out-file "$work/breve.abi" "$work/libbreve.so"

if [[ ${1-} == --renew ]]; then
  cp "$work/breve.abi" "$here/breve.abi"
  exit
fi
abidiff --no-show-locs "$here/breve.abi" "$work/breve.abi" && exit
cat <<'TEXT'

The binary interface is not the one that is described in tests/abi/breve.abi. If that is as it should be, write the
description anew and commit it with the change:
  tests/abi/check.sh --renew
A struct with struct_size that got fields at its end, and a new function, leave BREVE_ABI as it is. Whatever else breaks
hosts that are not compiled again: BREVE_ABI in breve.h rises, and CHANGES.md says how to move over.
TEXT
exit 1
