#!/bin/bash
# A public header as it was before each struct with struct_size got its last field, or as it may be when each has got one
# more: header.sh older|newer breve/breve.h HEADER
set -eu
awk -v how="$1" '
function end_of_struct(    i) {
  if (how == "newer") {
    for (i = 1; i <= count; ++i) print body[i]
    print "  double of_a_later_header[2];"
  } else {
    for (i = 1; i < last; ++i) print body[i]
  }
}
/^typedef struct breve_[a-z_]+ \{/ { inside = 1; sized = 0; count = last = 0; print; next }
inside && /^\} breve_[a-z_]+;/ {
  if (sized) {
    end_of_struct()
    if (how == "older") gone[name] = 1
  } else {
    for (i = 1; i <= count; ++i) print body[i]
  }
  inside = 0
  print
  next
}
inside {
  body[++count] = $0
  if ($0 ~ /^  size_t struct_size;/) sized = 1
  # A field begins a line; what its comment goes on with is indented further.
  if ($0 ~ /^  [a-z][A-Za-z0-9_* ]*[ *][a-z_0-9]+(\[[0-9]+\])?;/) {
    last = count
    name = $0
    sub(/(\[[0-9]+\])?;.*/, "", name)
    sub(/.*[ *]/, "", name)
  } else if (match($0, /^  [a-z][A-Za-z0-9_* ]* \(\*[a-z_]+\)\(/)) {  # a function
    last = count
    name = substr($0, 1, RLENGTH - 2)
    sub(/.*\*/, "", name)
  }
  next
}
{
  # Initialisers do not know a field that is gone.
  if (match($0, /^  [a-z]+\.[a-z_]+ = /)) {
    field = $0
    sub(/^  [a-z]+\./, "", field)
    sub(/ = .*/, "", field)
    if (field in gone) next
  }
  print
}' "$2" >"$3"
