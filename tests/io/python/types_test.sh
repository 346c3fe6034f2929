#!/usr/bin/env bash
# Holds the type stubs of the package in PYTHONPATH against the package itself, and scripts against the stubs. Exit
# status 77, which ctest takes as skipped, where mypy is missing.
#
#   tests/io/python/types_test.sh PYTHON FOLDER...
set -euo pipefail

python=$1
shift
if ! "$python" -c 'import mypy' 2>/dev/null; then
  echo 'skipped: no mypy here (Debian: mypy)'
  exit 77
fi
place=$(mktemp --directory)
trap 'rm -rf "$place"' EXIT
scripts=()
for folder in "$@"; do scripts+=("$(realpath "$folder")"/*.py); done

cd "$place"
# _isorim is compiled, and private.
"$python" -m mypy.stubtest isorim --ignore-missing-stub
for script in "${scripts[@]}"; do
  MYPYPATH=$PYTHONPATH "$python" -m mypy --cache-dir "$place" --check-untyped-defs "$script"
done

# A wrong argument is found, so that silence means something.
printf 'import isorim\nisorim.load({}).integrate("x", over="volume")\n' >wrong.py
if MYPYPATH=$PYTHONPATH "$python" -m mypy --cache-dir "$place" wrong.py >wrong.log; then
  echo 'mypy finds nothing wrong with over="volume"'
  exit 1
fi
grep --quiet 'arg-type' wrong.log
