#!/usr/bin/env bash
# The sample hosts in C and in C++ step the same flock: both must run, and end with one hash.
# Usage: hosts_agree.sh FLOCK_C FLOCK_CPP FLOCK.tz
set -euo pipefail

one=$("$1" "$3" 120 | grep '^hash ')
other=$("$2" "$3" 120 | grep '^hash ')
echo "C: $one, C++: $other"
[[ $one == "$other" ]]
