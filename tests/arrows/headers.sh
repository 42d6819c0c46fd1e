#!/usr/bin/env bash
# Each header of ours compiles by itself, as the first of a source would need it.
# Usage: headers.sh REPOSITORY COMPILER [FLAG…]
set -uo pipefail

repository=$(realpath "$1")
shift
export repository
cd "$repository" || exit 2
find runtime steve hostapi/src hostapi/command -name '*.hpp' -print0 | sort -z |
  xargs -0 -P "$(nproc)" -I '{}' bash -c 'header=$1; shift
    said=$("$@" -std=c++20 -fsyntax-only -I "$repository" -I "$repository/hostapi/include" -include "$header" -x c++ /dev/null 2>&1) ||
      { printf "%s does not compile alone\n%s\n" "$header" "${said:0:2000}"; exit 1; }' - '{}' "$@"
