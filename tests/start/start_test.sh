#!/usr/bin/env bash
# Tests the start script `isorim` and .ci/install-packages on a small tree with a program that prints its arguments.
set -euo pipefail
export LC_ALL=C.UTF-8

source_tree=$(cd "${BASH_SOURCE[0]%/*}/../.." && pwd)
tree=$(mktemp --directory)
trap 'rm -rf "$tree"' EXIT
failures=0

# expect NAME FOUND WANTED: the two strings are the same.
expect() {
  if [[ $2 != "$3" ]]; then
    printf '%s\n  found:  %s\n  wanted: %s\n' "$1" "$2" "$3"
    failures=$((failures + 1))
  fi
}

# expect_in NAME TEXT PART
expect_in() {
  if [[ $2 != *"$3"* ]]; then
    printf '%s\n  found:  %s\n  wanted in it: %s\n' "$1" "$2" "$3"
    failures=$((failures + 1))
  fi
}

# Runs a command; its output (both streams) is then in $output, its exit status in $status.
run() {
  status=0
  output=$("$@" 2>&1 </dev/null) || status=$?
}

# Tells one build of the program from another: each is a new file.
program_id() { stat --format=%i,%Y "$tree/build/isorim"; }

lay_tree() {
  mkdir -p "$tree"/{geometry,quadrature,solver,io/cli,.ci,.cmake,elsewhere}
  cp "$source_tree"/{isorim,CMakePresets.json} "$tree/"
  cp "$source_tree/.ci/install-packages" "$tree/.ci/"
  # Nothing is to be installed here.
  printf 'build  bash\n' >"$tree/.ci/packages"
  cat >"$tree/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(start LANGUAGES CXX)
enable_testing()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
add_executable(isorim io/cli/main.cpp)
add_test(NAME passes COMMAND isorim)
add_test(NAME fails COMMAND isorim fail)
CMAKE
  write_program one
}

# A program that prints its name $1, the working directory and its arguments, and exits 3 if there are any.
write_program() {
  cat >"$tree/io/cli/main.cpp" <<CPP
#include <cstdio>
#include <filesystem>
int main(int count, char** arguments) {
  std::printf("$1 in %s:", std::filesystem::current_path().filename().c_str());
  for (int i = 1; i < count; ++i) std::printf(" [%s]", arguments[i]);
  return count > 1 ? 3 : 0;
}
CPP
}

lay_tree
cd "$tree/elsewhere"

run ../isorim run 'a case.toml' ''
expect_in 'builds, and hands over arguments and directory' "$output" 'one in elsewhere: [run] [a case.toml] []'
expect 'hands over the exit status' "$status" 3

first=$(program_id)
run ../isorim
expect 'is silent when nothing changed' "$output" 'one in elsewhere:'
expect 'does not build when nothing changed' "$(program_id)" "$first"

write_program two
run ../isorim
expect_in 'builds when a source changed' "$output" 'two in elsewhere:'

printf 'int x = ;\n' >>"$tree/io/cli/main.cpp"
run ../isorim
expect_in 'says that the build failed' "$output" 'isorim: the build failed; its log is'
expect_in 'says what is wrong' "$output" "main.cpp:8:9: error: expected"
expect 'exits 2 when the build failed' "$status" 2
run ../isorim
expect 'does not run a program older than the sources' "$status" 2

write_program three
rm -r "$tree/build"
for i in 1 2 3; do ../isorim >"$tree/elsewhere/$i" 2>/dev/null & done
wait
expect 'several at once, from nothing, build in turn' "$(cat 1 2 3)" 'three in elsewhere:three in elsewhere:three in elsewhere:'

run ../isorim test -R passes
expect 'passes when the tests pass' "$status" 0
expect_in 'ends with the line of ctest' "$output" '100% tests passed, 0 tests failed out of 1'
run ../isorim test
expect 'fails when a test fails' "$status" 1
expect_in 'says that tests failed' "$output" 'isorim: tests failed'
run ../isorim test -R nothing
expect 'fails when no test was run' "$status" 1

mv "$tree" "$tree.moved"
tree=$tree.moved
cd "$tree/elsewhere"
write_program four
run ../isorim
expect_in 'builds in a tree that was moved' "$output" 'four in elsewhere:'

# Packages: no rights, and nobody to ask.
mkdir "$tree/bin"
printf '#!/bin/sh\nexit 1\n' >"$tree/bin/sudo"
chmod +x "$tree/bin/sudo"
chmod 755 "$tree"
printf 'build  bash\nbuild  no-such-package\ncheck  no-such-checker\n' >"$tree/.ci/packages"
without_rights=()
if ((EUID == 0)); then without_rights=(setpriv --reuid=65534 --clear-groups); fi
if command -v dpkg-query >/dev/null; then
  run "${without_rights[@]}" env PATH="$tree/bin:$PATH" "$tree/.ci/install-packages" build
  expect_in 'prints the one command' "$output" \
    "  sudo sh -c 'apt-get update && apt-get install --no-install-recommends no-such-package'"
  expect 'exits 2 when packages are missing' "$status" 2
fi

printf 'start script: %d failed\n' "$failures"
((failures == 0))
