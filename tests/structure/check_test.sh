#!/usr/bin/env bash
# Tests check.sh: in a small sound tree it finds nothing; with one breach planted it finds that one.
set -euo pipefail

check=$(cd "${BASH_SOURCE[0]%/*}" && pwd)/check.sh
tree=$(mktemp --directory)
trap 'rm -rf "$tree"' EXIT
failures=0

fresh_tree() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{geometry/nurbs,quadrature,solver,io/cli,cases,tests}
  printf '#include <vector>\n#include <Eigen/Core>\n' >"$tree/geometry/nurbs/curve.h"
  printf '#include <Eigen/SVD>\n#include <fmt/core.h>\n#include "geometry/nurbs/curve.h"\n' >"$tree/geometry/fit.cpp"
  printf '#include <omp.h>\n#include "geometry/nurbs/curve.h"\n' >"$tree/quadrature/rim.cpp"
  printf '#include "quadrature/rim.h"  // and no more\n' >"$tree/solver/properties.h"
  printf '#include <hdf5.h>\n#include <vtkCell.h>\n#include "solver/properties.h"\n' >"$tree/io/write.cpp"
  printf '#include <CLI/CLI.hpp>\n#include "io/write.h"\n' >"$tree/io/cli/main.cpp"
  touch "$tree/CMakeLists.txt" "$tree/README.md" "$tree/isorim"
}

# The tree as it stands must be reported with exactly the one line that contains $1; with no $1, not at all.
expect() {
  local found status=0
  found=$(bash "$check" "$tree") || status=$?
  if [[ -z $1 && $status == 0 && -z $found ]]; then return; fi
  if [[ -n $1 && $status == 1 && $found == *"$1"* && $found != *$'\n'* ]]; then return; fi
  printf 'expected: %s\nfound (status %d): %s\n\n' "${1:-nothing}" "$status" "$found"
  failures=$((failures + 1))
}

# Writes the line $2 into the file $1 of a fresh tree and expects the report $3.
plant() {
  fresh_tree
  mkdir -p "$tree/${1%/*}"
  printf '#pragma once\n%s\n' "$2" >"$tree/$1"
  expect "$1:2: includes $3"
}

fresh_tree
expect ''
plant geometry/a.cpp '#include "quadrature/rim.h"' '"quadrature/rim.h"; geometry stands below quadrature'
plant quadrature/a.h '  # include "solver/b.h"' '"solver/b.h"; quadrature stands below solver'
plant solver/deep/a.h '#include "io/b.h" // why' '"io/b.h"; solver stands below io'
plant io/a.cpp '#include "io/cli/b.h"' '"io/cli/b.h"; io stands below io/cli'
plant io/a.cpp '#include "write.h"' '"write.h"; quoted includes are our own headers'
plant geometry/a.h '#include <Eigen/Dense>' '<Eigen/Dense>; headers include of Eigen <Eigen/Core> alone'
plant solver/a.h '#include <Eigen/SVD>' '<Eigen/SVD>; headers include of Eigen <Eigen/Core> alone'
for header in vtkCell.h hdf5.h H5Cpp.h toml++/toml.h nlohmann/json.hpp CLI/CLI.hpp muParser.h; do
  plant solver/a.cpp "#include <$header>" "<$header>; outside io/ only the standard library, Eigen and fmt"
done
plant geometry/a.cpp '#include <omp.h>' '<omp.h>; geometry knows no files, threads or printing'
plant geometry/a.cpp '#include <fstream>' '<fstream>; geometry knows no files, threads or printing'

fresh_tree
mkdir "$tree/src"
expect 'src: does not belong at the top level'

printf 'check.sh: %d failed\n' "$failures"
((failures == 0))
