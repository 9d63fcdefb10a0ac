#!/usr/bin/env bash
# Compares the hashes of what the program gives in several builds: five cages drawn and exported by
# the default scheme, every scheme on a closed cage that it takes, displaced, animated, with adaptive
# factors, by the Direct3D 10 path and compared with the limit surface; and a sweep's table.
#   determinism.sh            builds with g++ and clang at -O0 and -O2; the five cages with -j 1, 2, 3,
#                             8, each with lanes 4, 8, 16, the rest with three pairs of both
#   determinism.sh FOLDER...  these builds as they are, everything with the three pairs; of a build
#                             with one width of lanes only that
# Exit 1 if any differ or a run gives none. Blending, stencil and stream output are in a hash that
# the test Determinism.R1SamplesBlendingAndStreamOutputHaveOneHash compares in every preset.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
install_packages
models=(jug spindle saddle_star golem)
polygons=build/determinism/polygons.obj
mkdir -p build/determinism
# A cage with n-gons: a pentagonal prism.
cat >"$polygons" <<'OBJ'
v 1 0 0
v 0.309 0.951 0
v -0.809 0.588 0
v -0.809 -0.588 0
v 0.309 -0.951 0
v 1 0 1
v 0.309 0.951 1
v -0.809 0.588 1
v -0.809 -0.588 1
v 0.309 -0.951 1
f 5 4 3 2 1
f 6 7 8 9 10
f 1 2 7 6
f 2 3 8 7
f 3 4 9 8
f 4 5 10 9
f 5 1 6 10
OBJ
models+=("$polygons")

hash_of() { sed -n 's/^  "hash": "\(.*\)",$/\1/p'; }
declare -A expected
failures=0
runs=0
check() { # key, hash, what
    runs=$((runs + 1))
    if [ -z "$2" ]; then
        echo "FAILS: $1 with $3"
        failures=$((failures + 1))
    elif [ -z "${expected[$1]:-}" ]; then
        expected[$1]=$2
    elif [ "${expected[$1]}" != "$2" ]; then
        echo "DIFFERS: $1 with $3: $2 instead of ${expected[$1]}"
        failures=$((failures + 1))
    fi
}

lanes_of() { # folder: the widths that its program holds
    local lanes
    for lanes in 4 8 16; do
        "$1/tessemu" draw jug --size 16x16 --lanes "$lanes" --json - >/dev/null 2>&1 && echo "$lanes"
    done
    return 0
}

run_cages() { # folder, threads, lanes
    local folder=$1 what="$1 -j $2 --lanes $3"
    local options="--tess 5.3 -j $2 --lanes $3 --json -"
    for model in "${models[@]}"; do
        for contraction in none all mixed:7; do
            check "draw $model $contraction" "$("$folder/tessemu" draw "$model" \
                --size 200x150 --contraction $contraction $options 2>/dev/null | hash_of)" "$what"
        done
        check "draw $model 4 samples, wire" "$("$folder/tessemu" draw "$model" \
            --size 200x150 --samples 4 --view wire $options 2>/dev/null | hash_of)" "$what"
        check "export $model" "$("$folder/tessemu" export "$model" $options \
            -o "$folder/mesh.ply" 2>/dev/null | hash_of)" "$what"
        for steps in "--levels 3" "--levels 2 --set sort=valence --contraction mixed:7"; do
            check "subdivide $model $steps" "$("$folder/tessemu" subdivide "$model" $steps \
                -j $2 --lanes $3 --json - 2>/dev/null | hash_of)" "$what"
        done
    done
}

run_schemes() { # folder, threads, lanes
    local folder=$1 what="$1 -j $2 --lanes $3"
    # The golem is quads with texture coordinates, the spindle triangles without: no image can
    # displace it, and the error view has no quads to compare. Tables that another build left in the
    # cache would be compared with themselves.
    for scheme in gregory-stencil gregory-two-stage acc pm qas pn-triangles phong flat tables-catmull-clark \
        tables-loop tables-butterfly stam biseptic bolz; do
        local cage=golem options="--scheme $scheme -j $2 --lanes $3 --table-cache none --json -"
        local variants=("--contraction none" "--contraction mixed:5" "--view zebra"
            "--displace studs --animate sway --phase 0.3 --contraction mixed:5")
        case $scheme in
        qas | pn-triangles | phong | flat | tables-loop | tables-butterfly) cage=spindle ;;
        *) variants+=("--displace docs/images/roofline.png --contraction all" "--view error --level 3") ;;
        esac
        case $scheme in
        bolz) variants+=("--set adapt=1e-3 --contraction mixed:5" "--set order=table"
            "--set rules=biermann" "--set tables=unenforced") ;;
        *) variants+=("--tess-edge pixels=6" "--direct3d 10") ;;
        esac
        case $scheme in
        stam | biseptic) variants+=("--view curvature" "--set edges=shared --contraction mixed:5"
            "--set edges=shared --set regular=bspline --view curvature") ;;
        esac
        for variant in "${variants[@]}"; do
            check "draw $cage $scheme $variant" "$("$folder/tessemu" draw $cage $options \
                --size 200x150 --tess 5.3 $variant 2>/dev/null | hash_of)" "$what"
        done
        check "compare $cage $scheme" "$("$folder/tessemu" compare $cage $options \
            --level 3 2>/dev/null | hash_of)" "$what"
    done
}

run_sweep() { # folder, threads, lanes: the merged table, byte by byte
    local sweep=build/determinism/sweep
    rm -rf "$sweep"
    cat >"$sweep.json" <<'JSON'
{"verb": "draw", "models": ["golem", "polygons.obj"], "schemes": ["gregory-stencil", "stam", "pm"],
 "tess": [1, 5.3], "size": "64x64", "contraction": ["none", "mixed:7"]}
JSON
    "$1/tessemu" sweep plan "$sweep.json" -o "$sweep" >/dev/null
    "$1/tessemu" sweep run "$sweep" -j "$2" --lanes "$3" >/dev/null 2>&1 || true # pm takes no polygon
    check "sweep" "$("$1/tessemu" sweep merge "$sweep" -o "$sweep.csv" >/dev/null 2>&1 &&
        sha256sum <"$sweep.csv")" "$1 -j $2 --lanes $3"
}

compare_build() { # folder, whether the five cages run with every pair
    local widths run threads lanes
    widths=$(lanes_of "$1")
    if [ -z "$widths" ]; then
        echo "FAILS: $1 holds no program that draws"
        failures=$((failures + 1))
        return 0
    fi
    for run in "1 4" "3 8" "8 16"; do
        read -r threads lanes <<<"$run"
        grep -qx "$lanes" <<<"$widths" || continue
        run_schemes "$1" "$threads" "$lanes"
        run_sweep "$1" "$threads" "$lanes"
        [ "$2" = all ] || run_cages "$1" "$threads" "$lanes"
    done
    [ "$2" = all ] || return 0
    for threads in 1 2 3 8; do
        for lanes in $widths; do
            run_cages "$1" "$threads" "$lanes"
        done
    done
}

if [ $# -gt 0 ]; then
    for folder in "$@"; do
        compare_build "$folder" pairs
    done
else
    for compiler in g++ clang++; do
        for level in O0 O2; do
            folder=build/determinism/$compiler-$level
            cmake -S . -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER=$compiler -DCMAKE_BUILD_TYPE= \
                -DCMAKE_CXX_FLAGS="-$level -march=native" -DTESSEMU_ALL_LANES=ON \
                -DTESSEMU_BUILD_TESTS=OFF -DTESSEMU_BUILD_BENCH=OFF >/dev/null
            cmake --build "$folder" --target tessemu_program
            compare_build "$folder" all
        done
    done
fi
for key in "${!expected[@]}"; do echo "${expected[$key]:0:16}  $key"; done | sort -k2
echo "$runs runs, $failures differ or fail"
[ "$failures" -eq 0 ]
