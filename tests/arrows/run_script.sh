#!/usr/bin/env bash
# `./run` on a machine that lacks everything and has no apt-get: it names what is missing, exits 1 and builds nothing;
# a word it does not know is wrong usage. Usage: run_script.sh REPOSITORY
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

env -i PATH="$scratch/path" "$(command -v bash)" "$scratch/run" tests >"$scratch/said" 2>&1
(($? == 1)) || fail "exit status is not 1"
grep -q 'missing.*g++.*libbullet-dev' "$scratch/said" || fail "does not name what is missing"
[[ ! -e $scratch/build ]] || fail "built all the same"

env -i PATH="$scratch/path" "$(command -v bash)" "$scratch/run" no-such-word >"$scratch/said" 2>&1
(($? == 2)) || fail "exit status of wrong usage is not 2"
