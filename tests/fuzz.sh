#!/usr/bin/env bash
# Builds the fuzzer of the core under AddressSanitizer and UndefinedBehaviorSanitizer and runs it:
# random planes, cameras, transforms and lights through the core's public door, for as many seconds
# as told (60). Its cases follow from the seed, the second argument.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
cmake --preset asan
cmake --build --preset asan --target fuzz_core
exec build/asan/bin/fuzz_core --seconds "${1:-60}" --seed "${2:-1}"
