#!/usr/bin/env bash
# `./run` on a machine that lacks everything and has no apt-get: it names what is missing for what it was asked to do, and
# nothing else, exits 1 and builds nothing; a word it does not know is wrong usage. Usage: run_script.sh REPOSITORY
set -uo pipefail

repository=$(realpath "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp "$repository/run" "$scratch/run"
mkdir "$scratch/path"
for tool in cat dirname; do ln -s "$(command -v "$tool")" "$scratch/path/$tool"; done
printf '#!/bin/sh\nexit 1\n' >"$scratch/path/dpkg-query"
chmod +x "$scratch/path/dpkg-query"

fail() {
  echo "$1"
  cat "$scratch/said"
  exit 1
}

run() { env -i PATH="$scratch/path" "$(command -v bash)" "$scratch/run" "$@" >"$scratch/said" 2>&1; }

# lacks WORD PACKAGE… [-- PACKAGE…]: ./run WORD names the first packages as missing, and not those behind the --.
lacks() {
  local word=$1 package wanted=yes
  shift
  run "$word"
  (($? == 1)) || fail "./run $word: exit status is not 1"
  for package in "$@"; do
    if [[ $package == -- ]]; then
      wanted=no
    elif [[ $wanted == yes ]]; then
      grep -q "missing.* $package\( \|$\)" "$scratch/said" || fail "./run $word does not name $package"
    else
      ! grep -q " $package\( \|$\)" "$scratch/said" || fail "./run $word names $package"
    fi
  done
  [[ ! -e $scratch/build ]] || fail "./run $word: built all the same"
}

lacks build g++ libstb-dev libcli11-dev -- libbullet-dev libgtest-dev clang lua5.4 clang-format
lacks demo g++ libstb-dev -- libgtest-dev clang lua5.4 clang-format
lacks bench g++ libgtest-dev lua5.4 libode-dev libbullet-dev -- clang libonig-dev clang-format
lacks format clang-format -- g++ libgtest-dev
lacks lint g++ clang-tidy -- libgtest-dev lua5.4
lacks tests g++ libstb-dev libgtest-dev clang clang-tidy clang-format

for words in no-such-word "tests --some" "tests 60" "tests --all 0" "tests --all ten" "tests --all 60 60" "fuzz walk" "fuzz run 0"; do
  # shellcheck disable=SC2086  # words, as they say
  run $words
  (($? == 2)) || fail "./run $words: exit status of wrong usage is not 2"
done
