#!/usr/bin/env bash
# Builds Holdfast and runs its demonstration: renders small scenes, denoises them through a server,
# compares with converged references and writes a report. Extra arguments go to `holdfast demo`.
set -euo pipefail

usage() {
  cat <<'USAGE'
usage: deploy/demo.sh [-o DIR] [arguments of `holdfast demo`]

  -o DIR, --output DIR  where the results go (default: holdfast-demo in the current folder)

Installs missing packages, builds the release preset, then runs `holdfast demo`.
USAGE
}

repository=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
output=holdfast-demo
arguments=()
while (($#)); do
  case $1 in
    -h | --help)
      usage
      exit 0
      ;;
    -o | --output)
      if (($# < 2)); then
        echo "demo.sh: $1 needs a folder" >&2
        exit 2
      fi
      output=$2
      shift
      ;;
    --output=*) output=${1#*=} ;;
    *) arguments+=("$1") ;;
  esac
  shift
done

echo "demo.sh: 1 of 3, packages"
"$repository/deploy/install.sh"

echo "demo.sh: 2 of 3, build (the first one takes some minutes)"
(
  cd "$repository"
  cmake --preset release
  cmake --build --preset release --target holdfast holdfast-server
)

echo "demo.sh: 3 of 3, demonstration"
"$repository/build/release/bin/holdfast" demo -o "$output" "${arguments[@]}"

if [[ ! -f $output/report.html ]]; then
  echo "demo.sh: holdfast demo ended well but wrote no $output/report.html" >&2
  exit 1
fi
echo "demo.sh: the report is $(cd -- "$output" && pwd)/report.html"
