#!/usr/bin/env bash
# Checks the format of every C++ file against .clang-format; --fix rewrites those that differ.
# Folders named `generated` hold what programs wrote and are left alone.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
case ${1:-} in
  "") action=(--dry-run -Werror) ;;
  --fix) action=(-i) ;;
  *)
    echo "usage: tests/format.sh [--fix]" >&2
    exit 2
    ;;
esac

mapfile -t files < <(find core proto server client tests -path '*/generated' -prune -o \
  \( -name '*.h' -o -name '*.cpp' \) -print | sort)
((${#files[@]})) || { echo "format.sh: found no C++ files" >&2; exit 1; }
clang-format "${action[@]}" "${files[@]}"
echo "format.sh: ${#files[@]} files $([[ ${1:-} == --fix ]] && echo formatted || echo agree)"
