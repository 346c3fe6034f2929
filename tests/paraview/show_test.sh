#!/usr/bin/env bash
# Opens what the program writes in ParaView by io/paraview/show.py, without a display: pictures that differ from view to
# view, a state file that holds every file, and messages for what is not there. Exit status 77, which ctest takes as
# skipped, where ParaView is missing.
#
#   tests/paraview/show_test.sh PROGRAM
set -euo pipefail

program=$(realpath "$1")
root=$(realpath "${BASH_SOURCE[0]%/*}/../..")
if ! command -v pvpython >/dev/null; then
  echo 'skipped: no pvpython here (Debian: paraview, python3-paraview, xvfb; they exclude libvtk9-dev)'
  exit 77
fi
work=$(mktemp --directory)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1

show() { # ARGUMENTS...
  local -a display=()
  command -v xvfb-run >/dev/null && display=(xvfb-run --auto-servernum)
  "${display[@]}" pvpython --force-offscreen-rendering "$root/io/paraview/show.py" "$@"
}
fail() { printf '%s\n' "$*"; exit 1; }

# check NAME FILE... -- ARGUMENTS...: of the case in out/NAME.
check() {
  local out=$work/$1 file view
  local -a files=()
  shift
  while [[ $1 != -- ]]; do files+=("$1"); shift; done
  shift
  show "$out" "$@" || fail "show.py fails on $out"
  for view in iso front top left; do
    [[ $(head --bytes=4 "$out/view_$view.png" | tail --bytes=3) == PNG ]] || fail "no picture view_$view.png in $out"
  done
  # A picture of nothing is one of a few hundred bytes, and the same from everywhere.
  (($(stat --format=%s "$out/view_iso.png") > 10000)) || fail "view_iso.png of $out is empty"
  cmp --silent "$out/view_iso.png" "$out/view_top.png" && fail "view_iso.png and view_top.png of $out are the same"
  for file in "${files[@]}"; do
    grep --quiet --fixed-strings "$file" "$out/state.pvsm" || fail "state.pvsm of $out does not hold $file"
  done
}

"$program" run "$root/cases/verification/flywheel.toml" -o "$work/flywheel" --quiet
check flywheel boundary.vtu --
"$program" run "$root/cases/verification/bem/kirsch.toml" -o "$work/kirsch" --quiet
check kirsch fields.vtu boundary.vtu -- --field stress --component xx
if show "$work/kirsch" --field nothing 2>"$work/messages"; then fail 'a field that is not there is shown'; fi
grep --quiet "found no field 'nothing'; expected one of .*stress" "$work/messages" || fail "$(cat "$work/messages")"
echo 'ParaView shows what the program writes'
