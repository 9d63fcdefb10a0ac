#!/usr/bin/env bash
# Fuzzes the OBJ reader for N seconds (60 if not given), from the built-in cages.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
build sanitize fuzz_obj_reader
corpus=build/sanitize/corpus
mkdir -p "$corpus"
build/sanitize/fuzz/fuzz_obj_reader -max_total_time="${1:-60}" -max_len=4096 -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 "$corpus" models
