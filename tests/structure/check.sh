#!/usr/bin/env bash
# Checks how the source tree hangs together; prints one line for each breach and exits 1 if there is one.
#
#   tests/structure/check.sh [ROOT]
#
# - A room includes only itself and the rooms that it stands on: geometry <- quadrature <- solver <- io <- io/cli,
#   by their path from the root.
# - Outside io/ only the standard library, Eigen, fmt and, above geometry/, OpenMP and intrinsics are named.
# - geometry/ knows no files, threads or printing.
# - Public headers outside io/ include of Eigen <Eigen/Core> alone.
# - The top level holds only the names that users know.
set -euo pipefail

cd "${1:-${BASH_SOURCE[0]%/*}/../..}"

# "path:line: message" for each #include that breaks a rule.
check_includes() {
  # shellcheck disable=SC2016  # The dollars are awk's.
  find geometry quadrature solver io \( -name '*.h' -o -name '*.cpp' \) -print0 | sort --zero-terminated |
    xargs --null --no-run-if-empty awk '
      BEGIN {
        split("geometry quadrature solver io io/cli", order, " ")
        for (i in order) level[order[i]] = i
      }
      function room_of(path) {
        if (path ~ /^io\/cli\//) return "io/cli"
        sub(/\/.*/, "", path)
        return path
      }
      function breach(message) { printf "%s:%d: includes %s; %s\n", FILENAME, FNR, $0, message }

      FNR == 1 { room = room_of(FILENAME); header = FILENAME ~ /\.h$/ }
      !/^[ \t]*#[ \t]*include/ { next }
      { sub(/^[ \t]*#[ \t]*include[ \t]*/, ""); sub(/[ \t\r]*(\/\/.*)?$/, "") }

      /^"/ {
        from = room_of(substr($0, 2))
        if (!(from in level)) breach("quoted includes are our own headers, by their path from the root")
        else if (level[from] > level[room]) breach(room " stands below " from)
        next
      }
      room ~ /^io/ { next }
      header && /^<Eigen\// && $0 != "<Eigen/Core>" { breach("headers include of Eigen <Eigen/Core> alone"); next }
      room == "geometry" && /^<(iostream|fstream|filesystem|cstdio|thread|omp\.h)>$/ {
        breach("geometry knows no files, threads or printing"); next
      }
      /^<[a-z_]+>$/ || /^<(Eigen|fmt)\// { next }
      room != "geometry" && /^<(omp|immintrin)\.h>$/ { next }
      { breach("outside io/ only the standard library, Eigen and fmt are named") }'
}

# What stands at the top: what git tracks, or everything in a tree without git.
top_level() {
  if [[ -e .git ]]; then git -c safe.directory='*' ls-files | sed 's,/.*,,' | sort --unique; else ls; fi
}

check_top_level() {
  local name
  while IFS= read -r name; do
    case $name in
      geometry | quadrature | solver | io | cases | tests | isorim | README.md | CHANGELOG.md | CMakeLists.txt | CMakePresets.json) ;;
      .* | build | build-* | out | CMakeUserPresets.json) ;;
      *) printf '%s: does not belong at the top level\n' "$name" ;;
    esac
  done < <(top_level)
}

breaches=$(check_includes; check_top_level)
if [[ -n $breaches ]]; then
  printf '%s\n' "$breaches"
  exit 1
fi
