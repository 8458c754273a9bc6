#!/usr/bin/env bash
# Runs clang-tidy with the checks of .clang-tidy over the sources; findings are errors.
# Arguments are regular expressions of paths: tests/tidy.sh core/frame client/cli. Default: all.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
deploy/install.sh --tools

# A build folder of its own: clang-tidy does not understand a command line that starts with ccache.
cmake --preset dev -B build/tidy -DHOLDFAST_CCACHE= >/dev/null
# Generated protocol headers must exist before anything that includes them can be parsed.
if cmake --build build/tidy --target help | grep -q '^holdfast_proto:'; then
  cmake --build build/tidy --target holdfast_proto
fi

patterns=("$@")
((${#patterns[@]})) || patterns=("$PWD/(core|proto|server|client|tests)/")
run-clang-tidy -quiet -p build/tidy -j "$(nproc)" "${patterns[@]}"
