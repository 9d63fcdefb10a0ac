#!/usr/bin/env bash
# 1,000 random control meshes (or MESHES of them) by schemes, partitionings and factors through the
# crack checker, with and without a planted mistake. Exit status 1 for a false alarm or a miss.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
install_packages
cmake --preset release >/dev/null
cmake --build --preset release --target at_scale
build/release/tests/at_scale "${MESHES:-1000}"
