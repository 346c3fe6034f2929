#!/usr/bin/env bash
# Runs the command lines of the pages (*.md) with the program as it was built; prints those that fail, and exits 1.
#
#   tests/manual/commands.sh PROGRAM [PAGE...]
#
# A command line is an indented line that starts with ./isorim (a "$ " before it counts as a prompt) and names no
# placeholders, which are in capitals. `./isorim test` is left out: it is what runs this. The lines of a page run one
# after the other in a folder of their own that shows the tree's cases, so what one writes the next may read.
set -euo pipefail

program=$(realpath "$1")
root=$(cd "${BASH_SOURCE[0]%/*}/../.." && pwd)
shift
place=$(mktemp --directory)
trap 'rm -rf "$place"' EXIT

pages() {
  (cd "$root" && find . -name '*.md' -not -path './build*' -not -path './out/*' -not -path './.*/*' | sort | cut -c3-)
}

# The command lines of a page, without prompt and what stands two blanks behind them.
commands() {
  sed --quiet --regexp-extended 's/^    (\$ )?(\.\/isorim .*)$/\2/p' "$root/$1" |
    sed --regexp-extended 's/ {2,}.*$//; s/ +#.*$//' |
    grep --invert-match --extended-regexp '^\./isorim test|(^|[[ =])[A-Z]+([] .]|$)' || true
}

count=0
failures=0
run_page() {
  local page=$1 command status output
  mkdir -p "$place/$page"
  cd "$place/$page"
  ln -s "$root/cases" cases
  ln -s "$program" isorim
  while IFS= read -r command; do
    status=0
    output=$(bash -c "$command" 2>&1 </dev/null) || status=$?
    count=$((count + 1))
    if ((status != 0)); then
      printf '%s: %s: exit status %d\n%s\n' "$page" "$command" "$status" "$(tail -n 5 <<<"$output")"
      failures=$((failures + 1))
    fi
  done < <(commands "$page")
  rm -rf "${place:?}/$page"
}

if (($#)); then chosen=("$@"); else mapfile -t chosen < <(pages); fi
for page in "${chosen[@]}"; do run_page "$page"; done
if ((count == 0)); then
  echo 'found no command lines'
  exit 1
fi
printf '%d command lines, %d failures\n' "$count" "$failures"
((failures == 0))
