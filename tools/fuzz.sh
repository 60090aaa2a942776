#!/bin/sh
# fuzz.sh [--check | --seeds] [TARGET...]: coverage-guided fuzzing of the library (libFuzzer, AddressSanitizer) on stable Rust.
#
#   calls     calls of the C interface, with invalid arguments and corrupted memory
#
# TIME seconds for each target (60), JOBS processes (1), MICROSLIP_SEED (new each time). New inputs are kept in
# verification/fuzz/corpus/, failing ones in verification/fuzz/artifacts/.
#
# --check runs the committed seeds and a search of RUNS inputs from them, and keeps nothing; each target counts as a test.
# --seeds replaces the seeds by the smallest set of kept inputs with the same coverage.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}" "${TIME:=60}" "${RUNS:=4000}" "${JOBS:=1}" "${MICROSLIP_SEED:=$(date +%s)}"
mode=
case ${1:-} in
    --check) mode=check TIME=600 JOBS=1 && shift ;;
    --seeds) mode=seeds && shift ;;
esac
[ $# -gt 0 ] || set -- calls

# The instrumentation of cargo-fuzz, without that of comparisons. --target keeps the flags from build scripts.
host=$(rustc -vV | sed -n 's/^host: //p')
export RUSTC_BOOTSTRAP=1 # AddressSanitizer is part of stable Rust, its option is not yet stable
RUSTFLAGS='--cfg fuzzing -Zsanitizer=address -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
    -Cllvm-args=-simplifycfg-branch-fold-threshold=0' \
    $CARGO build --quiet --profile fuzz --locked --package microslip-fuzz --target "$host"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The library does not allocate: there are no leaks, and little freed memory to watch.
export ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=16
passed=0
failed=0
for target; do
    program=target/$host/fuzz/$target
    archive=verification/fuzz/seeds/$target.tar.gz
    corpus=verification/fuzz/corpus/$target
    seeds=$work/$target
    mkdir -p "$seeds" "verification/fuzz/artifacts/$target"
    if [ "$mode" = seeds ]; then
        "$program" -set_cover_merge=1 -use_counters=0 -max_len=1024 "$seeds" "$corpus"
        tar --create --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --directory "$seeds" . |
            gzip --no-name --best > "$archive"
        continue
    fi
    tar --extract --gzip --file "$archive" --directory "$seeds"
    [ "$mode" = check ] && corpus=$work/new || RUNS=-1
    mkdir -p "$corpus"
    echo "$target: $RUNS inputs or $TIME s, seed $MICROSLIP_SEED"
    set -- -seed="$MICROSLIP_SEED" -runs="$RUNS" -max_total_time="$TIME" -max_len=2048 -len_control=0 -timeout=60 \
        -print_final_stats=1 -artifact_prefix="verification/fuzz/artifacts/$target/"
    [ "$JOBS" -eq 1 ] || set -- "$@" -fork="$JOBS"
    if "$program" "$@" "$corpus" "$seeds" > "$work/log" 2>&1; then
        passed=$((passed + 1))
        grep -E 'INITED|DONE|number_of_executed_units' "$work/log" || true
    else
        failed=$((failed + 1))
        grep -E -A 3 'panicked|ERROR|SUMMARY|Test unit' "$work/log"
        echo "$target failed. RUST_LIBFUZZER_DEBUG_PATH=/dev/stdout $program FILE prints and repeats the input FILE named above."
    fi
done
[ "$mode" = seeds ] || echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
