#!/usr/bin/env bash
# Gregory evaluation beside its limit, one after the other in the same run: a hand-written kernel with contraction off for the
# same instruction set. Needs the shared folder beside the project.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
build release bench_domain_shader
peers=../shared/peers
[ -d "$peers" ] || { echo "needs $peers, which is not there"; exit 0; }
bound=bound_v3_nofma
grep -q avx512f /proc/cpuinfo && bound=bound_v4_nofma
make -s -C "$peers" BUILD="$PWD/build/peers" "$PWD/build/peers/$bound"
for round in 1 2 3; do
    build/release/bench/bench_domain_shader --benchmark_filter='gregory_quad' --benchmark_min_time=0.5 2>/dev/null
    "build/peers/$bound" ../shared/models/bigguy.obj 9 17,64 | grep -E 'fly +cached 1 thr'
done
