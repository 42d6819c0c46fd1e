#!/usr/bin/env bash
# The manual page and the completions of the command name what `breve help` names, and nothing else.
# Usage: words.sh REPOSITORY BREVE
set -uo pipefail

folder=$1/hostapi/command
breve=$2
failed=0
fail() { echo "$1"; failed=1; }

page=$(sed 's/\\-/-/g' "$folder/breve.1")
commands=$("$breve" help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[[ $(wc -w <<<"$commands") -ge 6 ]] || fail "breve help lists only: $commands"
known=()
# What bash offers where these words stand before.
offered() {
  bash -c 'file=$1; shift; source "$file"; COMP_WORDS=(breve "$@"); COMP_CWORD=$#; _breve; printf "%s\n" "${COMPREPLY[@]}"' \
    - "$folder/completion/breve.bash" "$@" | sort
}
for command in $commands; do
  grep -q "^\.B $command\$" <<<"$page" || fail "breve.1 does not describe $command"
  grep -q "'$command:" "$folder/completion/_breve" || fail "_breve does not know $command"
  offered "" | grep -qx "$command" || fail "breve.bash does not know $command"
  [[ $command != help ]] || continue
  offered=$(offered "$command" --)
  options=$("$breve" help "$command" | grep -oE '^  (-h,)?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sed 's/-$//' | sort -u)
  known+=("$options")
  [[ $offered == "$options" ]] || fail "breve.bash offers for $command other options than there are: $(diff <(echo "$offered") <(echo "$options"))"
  for option in $options; do
    grep -qE -- "$option\b" <<<"$page" || fail "breve.1 does not describe $option of $command"
    grep -qE -- "$option(\[|=|')" "$folder/completion/_breve" || [[ $option == --help ]] || fail "_breve does not know $option of $command"
  done
done
for option in $(grep -oE -- '--[a-z-]+' <<<"$page" | sort -u); do
  [[ $option == --version ]] || grep -qx -- "$option" <<<"$(printf '%s\n' "${known[@]}")" || fail "breve.1 describes $option, which there is not"
done
if command -v man >/dev/null; then
  warned=$(LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -l "$folder/breve.1" 2>&1 >/dev/null)
  [[ -z $warned ]] || fail "man warns: $warned"
fi
if command -v zsh >/dev/null; then zsh -n "$folder/completion/_breve" || fail "_breve is no zsh"; fi
exit $failed
