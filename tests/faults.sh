#!/usr/bin/env bash
# Runs the fault suite and prints a table: what the client saw, how long it took to be answered
# again, frames that were lost under the policy ALL; then how much slower others made a session.
# Argument: the folder of the build, build/ci by default.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
build=${1:-build/ci}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
code=0
HOLDFAST_FAULT_TABLE=1 "$build/bin/faults_test" >"$log" 2>&1 || code=$?
printf '%-75s %-68s %9s %5s\n' fault 'what the client saw' recovery lost
sed -n 's/^FAULT|//p' "$log" | awk -F'|' '{ printf "%-75s %-68s %9s %5s\n", $1, $2, $3, $4 }'
printf '\n%-75s %s\n' 'beside' "ratios of a session's median, 90th and 99th percentile"
sed -n 's/^FAIR|//p' "$log" | awk -F'|' '{ printf "%-75s %5s %5s %5s\n", $1, $2, $3, $4 }'
tail -n 1 "$log"
((code == 0)) || grep -E '^\[  FAILED|Failure' "$log" >&2
exit "$code"
