#!/bin/bash
# Makes a locale that writes 1,5 and runs a program with its name: locale.sh PROGRAM. 77: it cannot be made here.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/source" <<'END'
comment_char %
escape_char /
LC_NUMERIC
decimal_point ","
thousands_sep "."
grouping 3;3
END LC_NUMERIC
END
# It warns of all that the source leaves out, and writes it all the same.
localedef -c -i "$folder/source" -f ANSI_X3.4-1968 "$folder/comma" >"$folder/said" 2>&1
[ -e "$folder/comma/LC_NUMERIC" ] || { cat "$folder/said"; exit 77; }
LOCPATH=$folder "$1" comma
