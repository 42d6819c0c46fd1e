#!/usr/bin/env bash
# `breve doc`, one case a call. Usage: doc.sh BREVE SOURCE_DIR CASE
set -euo pipefail
breve=$1 source=$2 work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAIL: $*" >&2; exit 1; }
has() { grep -qF -- "$2" "$1" || { cat "$1"; fail "$1 lacks: $2"; }; }
lacks() { ! grep -qF -- "$2" "$1" || fail "$1 has: $2"; }

# A program with everything that a page shows, and signs that Markdown and HTML take for markup.
program() {
  cat >"$work/birds.tz" <<'TZ'
@use Control.
Mobile : Bird (aka Birds) {
  % A bird. It is *light* & <small>, see `a|b`.
  %
  % A second paragraph.
  + variables:
    heading (vector). # where it flies

  + to fly to place (vector) with-note note = "<a|b>" (string):
    % Fly there.
    return self.

  - to rest:
    % Not for others.
    print 1.
}
Bird : Gull {
  + to fly to place (vector) with-note note = "" (string):
    return self.
}
TZ
}

case $3 in
  library_is_up_to_date)
    "$breve" doc --library --format markdown --out "$work/out" >/dev/null
    diff -r "$source/docs/reference" "$work/out" ||
      fail "docs/reference is not what the class library says: breve doc --library --format markdown --out docs/reference" ;;
  markdown)
    program
    "$breve" doc "$work/birds.tz" --format markdown --out "$work/out" >"$work/said"
    has "$work/said" "3 pages written"
    has "$work/out/README.md" "- [Bird](Bird.md): A bird."
    has "$work/out/README.md" "  - [Gull](Gull.md)"
    has "$work/out/Bird.md" "Object > Real > Mobile > **Bird**, also called \`Birds\`"
    has "$work/out/Bird.md" 'A bird. It is \*light\* & \<small\>, see `a|b`.'
    has "$work/out/Bird.md" "### fly to with-note"
    has "$work/out/Bird.md" '| `with-note` | `note` | string | `"<a\|b>"` |'
    has "$work/out/Bird.md" '| `heading` | vector | where it flies |'
    has "$work/out/Bird.md" "## Further methods"
    has "$work/out/Bird.md" "## Inherited from Mobile"
    has "$work/out/Gull.md" "[rest](Bird.md#rest)"
    lacks "$work/out/Gull.md" "[fly to with-note](Bird.md"
    [[ ! -e $work/out/Bird.html && ! -e $work/out/Mobile.md ]] || fail "pages that nobody asked for" ;;
  html)
    program
    "$breve" doc "$work/birds.tz" --format html --out "$work/out" >/dev/null
    has "$work/out/index.html" '<a href="Bird.html">Bird</a>: A bird.'
    has "$work/out/Bird.html" 'A bird. It is *light* &amp; &lt;small&gt;, see <code>a|b</code>.'
    has "$work/out/Bird.html" '<p>A second paragraph.</p>'
    has "$work/out/Bird.html" '<h3 id="fly-to-with-note">fly to with-note</h3>'
    has "$work/out/Bird.html" '<code>&quot;&lt;a|b&gt;&quot;</code>'
    has "$work/out/Gull.html" '<a href="Bird.html#rest">rest</a>'
    lacks "$work/out/Bird.html" "http"
    [[ ! -e $work/out/Bird.md ]] || fail "pages that nobody asked for" ;;
  links_lead_somewhere)
    # In the reference of the class library every link has its page and its heading.
    "$breve" doc --library --format html --out "$work/out" >/dev/null
    cd "$work/out"
    grep -oh 'href="[^"]*"' ./*.html | sort -u | sed 's/href="//;s/"$//' >links
    [[ $(wc -l <links) -gt 100 ]] || fail "hardly any links"
    while IFS='#' read -r page anchor; do
      [[ -f $page ]] || fail "no page $page"
      [[ -z $anchor ]] || grep -qF "id=\"$anchor\"" "$page" || fail "no heading $page#$anchor"
    done <links ;;
  with_library)
    program
    "$breve" doc --library "$work/birds.tz" --format markdown --out "$work/out" >/dev/null
    has "$work/out/Bird.md" "[Mobile](Mobile.md) > **Bird**"
    has "$work/out/Mobile.md" "Children: [Bird](Bird.md)" ;;
  errors)
    program
    status=0; "$breve" doc "$work/nowhere.tz" --out "$work/out" 2>"$work/said" || status=$?
    [[ $status == 2 ]] || fail "a missing file: status $status"
    has "$work/said" "there is no file"
    status=0; "$breve" doc 2>"$work/said" || status=$?
    [[ $status == 2 ]] || fail "no file: status $status"
    status=0; "$breve" doc "$work/birds.tz" --format pdf 2>"$work/said" || status=$?
    [[ $status == 2 ]] || fail "no such format: status $status"
    echo "Object : A { + to x: y = . }" >"$work/broken.tz"
    status=0; "$breve" doc "$work/broken.tz" --out "$work/out" >/dev/null 2>"$work/said" || status=$?
    [[ $status == 1 ]] || fail "an error in the program: status $status"
    [[ -f $work/out/A.md ]] || fail "what can be read is not documented"
    echo x >"$work/file"
    status=0; "$breve" doc "$work/birds.tz" --out "$work/file" >/dev/null 2>"$work/said" || status=$?
    [[ $status == 1 ]] || fail "pages that cannot be written: status $status"
    has "$work/said" "cannot write" ;;
  *) fail "no case $3" ;;
esac
