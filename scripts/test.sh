#!/usr/bin/env bash
# Installs what is missing, builds and runs every test; the last line counts them.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
build release all
log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
ctest --preset release -j "$(nproc)" | tee "$log" || status=$?
passed=$(grep -cE ' Passed +[0-9.]+ sec' "$log" || true)
skipped=$(grep -cE '\*\*\*Skipped' "$log" || true)
failed=$(grep -cE '\*\*\*(Failed|Exception|Timeout|Not Run)' "$log" || true)
echo "$passed passed, $failed failed, $skipped skipped"
exit $status
