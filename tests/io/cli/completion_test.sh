#!/usr/bin/env bash
# The completion scripts of `isorim help --completion` do what they should: bash's is run, zsh's at least read.
#
#   tests/io/cli/completion_test.sh PROGRAM
set -euo pipefail

program=$(realpath "$1")
place=$(mktemp --directory)
trap 'rm -rf "$place"' EXIT
"$program" help --completion bash >"$place/isorim.bash"
"$program" help --completion zsh >"$place/_isorim"
failures=0

# shellcheck disable=SC1091  # Made just now.
source "$place/isorim.bash"
# Outside of a completion compopt only complains.
compopt() { :; }
mkdir -p "$place/here/cases"
: >"$place/here/a case.toml"
cd "$place/here"

# expect WANTED WORD...: completing the last word gives WANTED, sorted and joined by "|".
expect() {
  local wanted=$1 found
  shift
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _isorim
  found=$(printf '%s\n' "${COMPREPLY[@]}" | sort | paste --serial --delimiters='|')
  if [[ $found != "$wanted" ]]; then
    printf '%s\n  found:  %s\n  wanted: %s\n' "$*" "$found" "$wanted"
    failures=$((failures + 1))
  fi
}

expect 'run' isorim ru
expect '--help|--version' isorim --
expect '--output' isorim run --o
expect 'a case.toml' isorim run a
expect 'cases' isorim run case.toml -o ''
expect '' isorim run case.toml -j ''
expect 'sphere' isorim help case sph
expect 'case|check|convert' isorim help c

# Every command and every option stands in zsh's script.
for word in $("$program" help --completion bash | grep --only-matching --extended-regexp -- ' --[a-z]+' | sort --unique); do
  grep --quiet -- "$word" "$place/_isorim" || { printf 'zsh: no %s\n' "$word"; failures=$((failures + 1)); }
done
if command -v zsh >/dev/null; then zsh -n "$place/_isorim"; fi
((failures == 0))
