#!/usr/bin/env bash
# A sweep on a real Slurm: submitted, a task killed while it runs, submitted again, merged by the last
# job; the table has the bytes of one process that ran all.
#   test_cluster.sh [FOLDER]   of a build, by default build/release
# Brings up one node on this machine as root (scripts/slurm_node.sh), and stops what it started by its
# process numbers.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
install_packages scripts/cluster_packages.txt
source scripts/slurm_node.sh
program=$PWD/${1:-build/release}/tessemu
folder=$(mktemp -d)
finish() {
    slurm_stop "$folder/slurm"
    rm -rf "$folder"
}
trap finish EXIT
fail() {
    echo "test_cluster.sh: $1" >&2
    exit 1
}

# Some 20 s for one core: tasks must be there long enough to be killed.
cat >"$folder/sweep.json" <<'JSON'
{"verb": "draw", "models": ["jug", "golem"], "schemes": ["gregory-stencil", "stam"],
 "tess": [1, 2, 3.5, 5, 7, 11, 16, 23, 32, 45, 64], "size": ["512x512", "1024x1024"],
 "partitioning": ["fractional_odd", "integer"]}
JSON
"$program" sweep plan "$folder/sweep.json" -o "$folder/alone"
cp -r "$folder/alone" "$folder/shared"
"$program" sweep run "$folder/alone"
"$program" sweep merge "$folder/alone" -o "$folder/alone.csv"

mkdir "$folder/slurm"
slurm_start "$folder/slurm" 4
waits_for() { # a job's end, at most 300 s
    local left i
    for ((i = 0; i < 3000; ++i)); do
        left=$(squeue -h -j "$1" 2>&1) || left= # gone from the queue's memory
        [ -z "$left" ] && return
        sleep 0.1
    done
    fail "job $1 does not end: $left"
}
submit() { "$program" sweep submit "$folder/shared" --tasks 3 "$@"; }
job_of() { sed -n "$1s/^job \([0-9]*\):.*/\1/p"; }

"$program" sweep submit "$folder/shared" --dry-run --merge "$folder/dry.csv"
[ ! -e "$folder/shared/slurm" ] || fail "--dry-run has written something"
first=$(submit | job_of 1)
victim=
for ((i = 0; i < 300 && ${victim:-0} == 0; ++i)); do # a task that has a case's result
    sleep 0.1
    ls "$folder"/shared/results/*.jsonl >/dev/null 2>&1 || continue
    victim=$(ls "$folder"/shared/results/*.jsonl | head -n 1 | sed 's/.*-\([0-9]*\)\.jsonl/\1/')
done
[ "${victim:-0}" != 0 ] || fail "no task has begun"
kill -KILL "$victim"
echo "killed process $victim of job $first"
scancel "$first" # the others too: what is left is the next job's
waits_for "$first"
"$program" sweep status "$folder/shared" | tee "$folder/status"
grep -q ' 0 not yet' "$folder/status" && fail "the first job was not interrupted"

submit --merge "$folder/shared.csv" | tee "$folder/submitted"
waits_for "$(job_of 1 <"$folder/submitted")"
waits_for "$(job_of 2 <"$folder/submitted")"
cat "$folder"/shared/slurm/merge_*.log
"$program" sweep status "$folder/shared" | grep ' 0 failed, 0 not yet' || fail "cases are missing"
cmp "$folder/alone.csv" "$folder/shared.csv" || fail "the cluster's table is another one"
ids=$(cut -c 1-73 "$folder"/shared/results/*.jsonl | sort | uniq -d | wc -l)
[ "$ids" -eq 0 ] || fail "$ids cases were computed twice"
echo "one table, byte by byte: $(wc -l <"$folder/shared.csv") lines"
