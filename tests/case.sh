# What the shell tests of the command share, to be sourced: an empty folder for each case, and how a claim fails.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export HOME="$work/home" BREVE_CLASS_PATH=
mkdir "$HOME"

fail() {
  echo "not so: $*"
  for file in out err; do [ -f $file ] && { echo "--- $file"; cat $file; }; done
  exit 1
}
same() { [ "$1" = "$2" ] || fail "'$1' is '$2'"; }
has() { grep -q -e "$2" "$1" || fail "$1 has '$2'"; }
lacks() { ! grep -q -e "$2" "$1" || fail "$1 lacks '$2'"; }
