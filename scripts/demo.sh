#!/usr/bin/env bash
# Installs what is missing, builds, draws the built-in jug to out/demo.png and prints the counters by stage.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
build release tessemu_program
mkdir -p out
build/release/tessemu draw jug --tess 16 -o out/demo.png
build/release/tessemu draw jug --tess 16 --view patches -o out/demo_patches.png >/dev/null
echo "drawn: out/demo.png, and its patches: out/demo_patches.png"
