#!/usr/bin/env bash
# The project beside its peers, one after the other in the same run, in ROUNDS rounds (default 3); prints one table of medians
# and ratios. Peers come from Debian: Mesa's llvmpipe, Embree, OpenSubdiv; the hand-written kernel that bounds evaluation comes
# from the shared folder, where it is there. Scene: bench/scene.h, 1024x1024, nothing culled, counting on.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
install_packages scripts/peer_packages.txt
cmake --preset release -DTESSEMU_BUILD_BENCH=ON -DTESSEMU_BUILD_PEERS=ON >/dev/null
cmake --build --preset release --target bench_draw bench_domain_shader bench_tessellator bench_memory \
    bench_schemes bench_subdivision bench_sweep peer_llvmpipe peer_embree peer_opensubdiv peer_opensubdiv_subdivision >/dev/null
bin=build/release/bench
log=$(mktemp)
trap 'rm -f "$log"' EXIT

bound=
if [ -d ../shared/peers ]; then
    bound=bound_v3_nofma
    grep -q avx512f /proc/cpuinfo && bound=bound_v4_nofma
    make -s -C ../shared/peers BUILD="$PWD/build/peers" "$PWD/build/peers/$bound"
fi
# Draws of one factor beside llvmpipe's, taking turns: where other programs use the machine too, what is
# compared must be a second apart, not a minute.
draws() {
    ours_at() {
        "$bin/bench_draw" --benchmark_filter="$1" --benchmark_min_time=0.3 2>/dev/null | awk '
            /^whole_frame/ { split($1, a, "[:/]"); print "our frame", a[3], a[5], $2 }
            /^geometry_only/ { split($1, a, "/"); print "our geometry", a[2], 1, $2 }'
    }
    for factor in 3 10 17 25 64; do
        ours_at "whole_frame/tess:$factor/threads:2"
        LP_NUM_THREADS=2 "$bin/peer_llvmpipe" "$factor" | sed -n 's/^frame/llvmpipe2 frame/p'
        ours_at "whole_frame/tess:$factor/|geometry_only/$factor/"
        LP_NUM_THREADS=0 "$bin/peer_llvmpipe" "$factor" | sed 's/^/llvmpipe1 /'
        ours_at "whole_frame/tess:$factor/threads:1|geometry_only/$factor/"
    done
}
# Google Benchmark's lines as "OUR KIND ARGUMENT THREADS VALUE".
ours() {
    "$bin/bench_domain_shader" --benchmark_filter='gregory_quad_(un)?counted/' --benchmark_min_time=0.3 2>/dev/null |
        awk '/^gregory_quad/ { split($1, a, "/"); for (i = 2; i <= NF; ++i) if ($i ~ /^Meval/) { split($i, v, "="); print "our", a[1], a[2], 1, rate(v[2]) } }
             function rate(s) { sub("/s", "", s); if (s ~ /k$/) { sub("k", "", s); return s * 1000 } return s + 0 }'
    "$bin/bench_subdivision" --benchmark_filter=threads:1/ --benchmark_min_time=0.3 2>/dev/null |
        awk '/^subdivision/ { split($1, a, "[:/]"); print "our subdivision", a[3], a[5], $2 }'
    "$bin/bench_schemes" --benchmark_min_time=0.3 2>/dev/null |
        awk '/Mpoint/ { for (i = 2; i <= NF; ++i) if ($i ~ /^Mpoint/) { split($i, v, "="); print "our scheme", $1, 1, rate(v[2]) } }
             function rate(s) { sub("/s", "", s); if (s ~ /m$/) { sub("m", "", s); return s / 1000 } if (s ~ /k$/) { sub("k", "", s); return s * 1000 } return s + 0 }'
    "$bin/bench_sweep" --benchmark_min_time=0.1 2>/dev/null |
        awk '/^(draws_alone|sweep_run)/ { split($1, a, "/"); print "our sweep", a[1], 1, $2 }'
    "$bin/bench_tessellator" --benchmark_min_time=0.3 2>/dev/null |
        awk '{ for (i = 2; i <= NF; ++i) if ($i ~ /^Mpoint/) { split($i, v, "="); sub("/s", "", v[2]); print "our tessellator", $1, 1, v[2] } }'
}
rounds=${ROUNDS:-3}
for round in $(seq "$rounds"); do
    echo "round $round of $rounds" >&2
    draws >>"$log"
    ours >>"$log"
    "$bin/peer_embree" | sed 's/^/embree /' >>"$log"
    "$bin/peer_opensubdiv" | sed 's/^/opensubdiv /' >>"$log"
    "$bin/peer_opensubdiv_subdivision" | sed 's/^/opensubdiv /' >>"$log"
    if [ -n "$bound" ]; then
        "build/peers/$bound" ../shared/models/bigguy.obj 9 17,64 | awk '/fly +cached/ { n = $1; sub("N=", "", n); print "bound", n, $4, $7 }' >>"$log"
    fi
done
awk '
    function median(key,   n, i, j, t, v) {
        n = split(values[key], v, " ")
        for (i = 2; i <= n; ++i) for (j = i; j > 1 && v[j] + 0 < v[j - 1] + 0; --j) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
        return n ? v[int((n + 1) / 2)] : 0
    }
    # Of the rounds: the peer by the two runs of ours around it.
    function turns(what, ours, peer,   n, i, a, b) {
        split(values[ours], a, " ")
        n = split(values[peer], b, " ")
        for (i = 1; i <= n; ++i) values["turns " what] = values["turns " what] " " 2 * b[i] / (a[2 * i - 1] + a[2 * i])
        if (n) printf "%-52s %10.2f %10.2f %-9s %7.2f\n", what, median(ours), median(peer), "ms", median("turns " what)
    }
    function row(what, a, b, unit, higher,   r) {
        if (a == 0 || b == 0) return
        r = higher ? a / b : b / a
        printf "%-52s %10.2f %10.2f %-9s %7.2f\n", what, a, b, unit, r
    }
    $2 == "scheme" && !($3 in known) { known[$3]; schemes[++all] = $3 }
    $1 == "our" { values["our " $2 " " $3 " " $4] = values["our " $2 " " $3 " " $4] " " $5; next }
    $1 == "bound" { values["bound " $2 " " $3] = values["bound " $2 " " $3] " " $4; next }
    { values[$1 " " $2 " " $3] = values[$1 " " $2 " " $3] " " $4 }
    END {
        printf "%-52s %10s %10s %-9s %7s\n", "medians", "tessemu", "peer", "", "ratio"
        n = split("3 10 17 25 64", f, " ")
        for (i = 1; i <= n; ++i)
            turns("frame, factor " f[i] ", 2 threads : llvmpipe", "our frame " f[i] " 2", "llvmpipe2 frame " f[i])
        for (i = 1; i <= n; ++i)
            turns("frame, factor " f[i] ", 1 thread : llvmpipe", "our frame " f[i] " 1", "llvmpipe1 frame " f[i])
        for (i = 1; i <= n; ++i)
            turns("geometry, factor " f[i] ", 1 thread : llvmpipe", "our geometry " f[i] " 1", "llvmpipe1 geometry " f[i])
        for (i = 1; i <= n; ++i)
            row("frame, factor " f[i] ", 2 threads : 1 thread", median("our frame " f[i] " 2"), median("our frame " f[i] " 1"), "ms", 0)
        row("bound kernel, N=17, 2 threads : 1 thread", median("bound 17 2"), median("bound 17 1"), "Meval/s", 1)
        for (i = 3; i <= 5; i += 2) {
            row("evaluation, N=" f[i] " : bound kernel", median("our gregory_quad_uncounted " f[i] " 1"), median("bound " f[i] " 1"), "Meval/s", 1)
            row("evaluation counted, N=" f[i] " : uncounted", median("our gregory_quad_counted " f[i] " 1"), median("our gregory_quad_uncounted " f[i] " 1"), "Meval/s", 1)
        }
        row("evaluation, N=17 : OpenSubdiv CpuEvaluator", median("our gregory_quad_uncounted 17 1"), median("opensubdiv evaluation 10"), "Meval/s", 1)
        for (i = 1; i <= 3; ++i) {
            row("subdivision to level " i " : OpenSubdiv stencils", median("our subdivision " i " 1"), median("opensubdiv stencils " i), "ms", 0)
            row("subdivision to level " i " : OpenSubdiv refinement", median("our subdivision " i " 1"), median("opensubdiv refinement " i), "ms", 0)
            row("subdivision to level " i " : its points alone", median("our subdivision " i " 1"), median("opensubdiv points " i), "ms", 0)
        }
        row("evaluation, N=17 : Embree rtcInterpolateN", median("our gregory_quad_uncounted 17 1"), median("embree evaluation 10"), "Meval/s", 1)
        for (i = 1; i <= all; ++i) {
            key = "our scheme " schemes[i] " 1"
            row(schemes[i] ", points with normals : OpenSubdiv CpuEvaluator", median(key), median("opensubdiv evaluation 10"), "Mpoint/s", 1)
            row(schemes[i] ", points with normals : Embree rtcInterpolateN", median(key), median("embree evaluation 10"), "Mpoint/s", 1)
        }
        row("1,000 cases of geometry, 1 thread : their draws alone", median("our sweep sweep_run 1"), median("our sweep draws_alone 1"), "ms", 0)
        for (key in values) if (key ~ /our tessellator/) { split(key, k, " "); printf "%-52s %10.2f %10s Mpoint/s\n", "tessellator " k[3], median(key), "" }
    }' "$log"
"$bin/bench_memory" || true
