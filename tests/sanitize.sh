#!/usr/bin/env bash
# Builds and runs the whole test suite under AddressSanitizer with UndefinedBehaviorSanitizer, then
# under ThreadSanitizer. Name presets to run only those: tests/sanitize.sh tsan
# Arguments after -- go to ctest: tests/sanitize.sh asan -- -R ShadowVector
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
root=$PWD

presets=()
while (($#)) && [[ $1 != -- ]]; do
  case $1 in
    asan | tsan) presets+=("$1") ;;
    *)
      echo "sanitize.sh: unknown preset $1, expected asan or tsan" >&2
      exit 2
      ;;
  esac
  shift
done
(($# == 0)) || shift
((${#presets[@]})) || presets=(asan tsan)

export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$root/tests/tsan.supp:halt_on_error=1:second_deadlock_stack=1:ignore_noninstrumented_modules=1:history_size=7:die_after_fork=0

deploy/install.sh
failed=()
for preset in "${presets[@]}"; do
  echo "sanitize.sh: $preset"
  cmake --preset "$preset"
  cmake --build --preset "$preset"
  ctest --preset "$preset" --parallel "$(nproc)" "$@" || failed+=("$preset")
done
if ((${#failed[@]})); then
  echo "sanitize.sh: failed under ${failed[*]}" >&2
  exit 1
fi
echo "sanitize.sh: clean under ${presets[*]}"
