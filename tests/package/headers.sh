#!/usr/bin/env bash
# breve.h and analysis.h as C11 and C++11, breve.hpp as C++17, by gcc and clang with all warnings as errors.
# Usage: headers.sh REPOSITORY
set -uo pipefail

include=$1/hostapi/include
failed=0
tried=0
# try COMPILER LANGUAGE STANDARD HEADER
try() {
  command -v "$1" >/dev/null || return
  ((++tried))
  "$1" -x "$2" -std="$3" -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$include" - <<<"#include <breve/$4>" || failed=1
}

for header in "$include"/breve/*.h; do
  for compiler in gcc clang; do try "$compiler" c c11 "$(basename "$header")"; done
  for compiler in g++ clang++; do try "$compiler" c++ c++11 "$(basename "$header")"; done
done
for compiler in g++ clang++; do try "$compiler" c++ c++17 breve.hpp; done
((tried >= 5)) || { echo "no compiler was found"; exit 1; }
exit $failed
