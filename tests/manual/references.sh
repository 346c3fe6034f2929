#!/usr/bin/env bash
# Checks what the pages (*.md) point at; prints one line for each thing that is not there and exits 1 if there is one.
#
#   tests/manual/references.sh [ROOT]
#
# - `room/file` and `room/folder/` in backquotes, of the rooms and of cases/ and tests/, exist.
# - `Suite.Test` in backquotes is a test below tests/.
# - Links and pictures that are no addresses lead to files, from the page's own folder.
set -euo pipefail

cd "${1:-${BASH_SOURCE[0]%/*}/../..}"

pages() { find . -name '*.md' -not -path './build*' -not -path './out/*' -not -path './.*/*' -print | sort; }

# Everything between single backquotes outside of indented and fenced blocks, as "page:line<tab>text".
quoted() {
  pages | while IFS= read -r page; do
    awk -v page="${page#./}" '
      /^```/ { fenced = !fenced }
      fenced || /^    / { next }
      { line = $0; while (match(line, /`[^`]+`/)) {
          printf "%s:%d\t%s\n", page, FNR, substr(line, RSTART + 1, RLENGTH - 2)
          line = substr(line, RSTART + RLENGTH) } }' "$page"
  done
}

# "page:line<tab>target" of links and pictures.
linked() {
  pages | while IFS= read -r page; do
    awk -v page="${page#./}" '
      /^```/ { fenced = !fenced }
      fenced || /^    / { next }
      { line = $0; while (match(line, /\]\([^)]+\)/)) {
          printf "%s:%d\t%s\n", page, FNR, substr(line, RSTART + 2, RLENGTH - 3)
          line = substr(line, RSTART + RLENGTH) } }' "$page"
  done
}

check_quoted() {
  local place text base
  while IFS=$'\t' read -r place text; do
    # Rooms' own pages may name files from the room.
    base=${place%:*}
    base=${base%"${base##*/}"}
    if [[ $text =~ ^(geometry|quadrature|solver|io|cases|tests)/[A-Za-z0-9_./*-]*$ ]]; then
      compgen -G "$text" >/dev/null || compgen -G "$base$text" >/dev/null ||
        printf '%s: there is no %s\n' "$place" "$text"
    elif [[ $text =~ ^([A-Z][A-Za-z0-9]*)\.([A-Z][A-Za-z0-9]*)$ ]]; then
      grep --recursive --quiet --extended-regexp "TEST(_[FP])?\(${BASH_REMATCH[1]}, ${BASH_REMATCH[2]}\)" tests ||
        printf '%s: there is no test %s\n' "$place" "$text"
    fi
  done < <(quoted)
}

check_linked() {
  local place target base
  while IFS=$'\t' read -r place target; do
    [[ $target =~ ^([a-z]+:|#) ]] && continue
    base=${place%:*}
    base=${base%"${base##*/}"}
    [[ -e $base${target%%#*} ]] || printf '%s: the link to %s leads nowhere\n' "$place" "$target"
  done < <(linked)
}

breaches=$(check_quoted; check_linked)
if [[ -n $breaches ]]; then
  printf '%s\n' "$breaches"
  exit 1
fi
