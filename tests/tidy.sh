#!/usr/bin/env bash
# Runs clang-tidy with the checks of .clang-tidy over the sources; findings are errors.
# Arguments are regular expressions of paths: tests/tidy.sh core/frame client/cli. Default: all.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
deploy/install.sh --tools

# Without ccache, whose command line clang-tidy would not understand; generated protocol headers
# must exist before anything that includes them can be parsed.
cmake --preset dev -DHOLDFAST_CCACHE= >/dev/null
if cmake --build --preset dev --target help | grep -q '^holdfast_proto:'; then
  cmake --build --preset dev --target holdfast_proto
fi

patterns=("$@")
((${#patterns[@]})) || patterns=("$PWD/(core|server|client|tests)/")
run-clang-tidy -quiet -p build/dev -j "$(nproc)" "${patterns[@]}"
