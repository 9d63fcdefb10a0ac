#!/usr/bin/env bash
# Runs the commands of docs/sweeps.md in the page's order, in a copy of examples/sweep in an empty
# folder, and compares what the plots are drawn from with tests/golden/sweep.
#   sweeps_test.sh PROGRAM FOLDER    of the project, 77: skipped
# A block of the page that runs has a comment above it:
#   <!-- run -->                       as it stands
#   <!-- killed, then run -->          killed once amid its work (SIGKILL), then as it stands
#   <!-- run where there is parallel -->
set -euo pipefail
program=$(realpath "$1")
source=$(realpath "$2")
for tool in sqlite3 gnuplot; do
    if ! command -v "$tool" >/dev/null; then
        echo "skipped: $tool is not installed (scripts/packages.txt)"
        exit 77
    fi
done
fail() {
    echo "FAILED: $*"
    exit 1
}

work=$(mktemp -d)
running=
trap '[[ -z $running ]] || kill -KILL "$running" 2>/dev/null || true; rm -rf "$work"' EXIT
mkdir "$work/blocks" "$work/bin" "$work/sweep"
ln -s "$program" "$work/bin/tessemu"
export PATH=$work/bin:$PATH XDG_CACHE_HOME=$work/cache PARALLEL_HOME=$work/parallel
cp "$source"/examples/sweep/* "$work/sweep/"
cd "$work/sweep"

# blocks/01.run, blocks/02.killed, ...
awk -v folder="$work/blocks" '
    /^<!-- run -->$/ { kind = "run"; next }
    /^<!-- killed, then run -->$/ { kind = "killed"; next }
    /^<!-- run where there is parallel -->$/ { kind = "parallel"; next }
    /^```$/ && file { close(file); file = kind = ""; next }
    /^```sh$/ && kind { file = sprintf("%s/%02d.%s", folder, ++count, kind); next }
    file { print >file }' "$source/docs/sweeps.md"

lines_of_results() {
    cat cost/results/*.jsonl 2>/dev/null | wc -l
}
# Starts the block's one command, kills it once it has found something, and looks at what is left.
kill_amid() {
    [[ $(wc -l <"$1") == 1 ]] || fail "one command to kill: $(cat "$1")"
    read -ra command <"$1"
    "${command[@]}" >"$work/killed.txt" 2>&1 &
    running=$!
    while (($(lines_of_results) < 20)); do
        kill -0 "$running" 2>/dev/null || fail "it ended before it was killed: $(cat "$work/killed.txt")"
        sleep 0.02
    done
    kill -KILL "$running"
    wait "$running" 2>/dev/null && fail "it was done before it was killed"
    running=
    local status
    status=$(tessemu sweep status cost)
    echo "killed: $status"
    [[ $status =~ \ ([0-9]+)\ done,\ 0\ failed,\ ([0-9]+)\ not\ yet ]] || fail "status: $status"
    ((BASH_REMATCH[1] >= 20 && BASH_REMATCH[2] > 0)) || fail "nothing was left to do: $status"
    [[ -n $(ls cost/claims) ]] || fail "the killed run has left no claim"
}

count=0 kills=0
for block in "$work"/blocks/*; do
    if [[ $block == *.parallel ]] && ! command -v parallel >/dev/null; then
        echo "not run, GNU parallel is not installed: $(cat "$block")"
        continue
    fi
    if [[ $block == *.killed ]]; then
        kill_amid "$block"
        kills=$((kills + 1))
    fi
    sed 's/^/$ /' "$block"
    bash -euo pipefail "$block" || fail "exit status $?"
    count=$((count + 1))
done
((count >= 6 && kills == 1)) || fail "$count blocks were found, $kills of them to kill"

# What the page says of files: two runs, one of them killed.
[[ $(find cost -type f | wc -l) == 4 ]] || fail "files: $(find cost -type f)"
[[ -z $(ls cost/claims) ]] || fail "claims are left: $(ls cost/claims)"
if [[ -e error4.sqlite ]]; then
    cmp error.sqlite error4.sqlite || fail "shards make another table than one run"
fi
for picture in sweep_error sweep_fps sweep_bytes; do
    [[ -s $picture.png ]] || fail "no $picture.png"
done
for table in error fps bytes; do
    diff "$source/tests/golden/sweep/$table.csv" "$table.csv" || fail "$table.csv is not the stored one"
done
echo "$count blocks ran, the plots' data are the stored ones"
