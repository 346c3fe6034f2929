#!/usr/bin/env bash
# references.sh finds what is not there, and nothing else.
set -euo pipefail

check=$(cd "${BASH_SOURCE[0]%/*}" && pwd)/references.sh
tree=$(mktemp --directory)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{solver/bem,tests}
: >"$tree/solver/bem/kernels.h"
printf 'TEST(Kernels, AreThere) {\n' >"$tree/tests/kernels_test.cpp"
cat >"$tree/solver/README.md" <<'PAGE'
Good: `solver/bem/kernels.h`, `solver/bem/*.h`, `Kernels.AreThere`, [here](bem/kernels.h), `not.h`,
[there](https://example.org).

    `solver/in_a_block.h`
PAGE

status=0
output=$("$check" "$tree") || status=$?
if ((status != 0)) || [[ -n $output ]]; then
  printf 'complains of a good page:\n%s\n' "$output"
  exit 1
fi

# shellcheck disable=SC2016  # The backquotes are the page's.
printf '\nBad: `solver/absent.h`, `Kernels.AreAbsent`, ![picture](absent.png)\n' >>"$tree/solver/README.md"
status=0
output=$("$check" "$tree") || status=$?
wanted='solver/README.md:6: there is no solver/absent.h
solver/README.md:6: there is no test Kernels.AreAbsent
solver/README.md:6: the link to absent.png leads nowhere'
if ((status != 1)) || [[ $output != "$wanted" ]]; then
  printf 'found:\n%s\nwanted:\n%s\n' "$output" "$wanted"
  exit 1
fi
