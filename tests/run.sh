#!/usr/bin/env bash
# Builds everything with warnings as errors and runs the whole test suite; ends with ctest's summary
# and its exit code. Extra arguments go to ctest, for example: tests/run.sh -R ShadowVector
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
deploy/install.sh --tests
cmake --preset ci
cmake --build --preset ci
exec ctest --preset ci --parallel "$(nproc)" "$@"
