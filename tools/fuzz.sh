#!/bin/sh
# fuzz.sh [--check | --seeds]: coverage-guided fuzzing of the library (libFuzzer, AddressSanitizer) on stable
# Rust: calls of the C interface with invalid arguments and corrupted memory.
#
# TIME seconds (60), JOBS processes (1), MICROSLIP_SEED (new each time). New inputs are kept in
# verification/fuzz/corpus/, failing ones in verification/fuzz/artifacts/.
#
# --check runs the committed seeds and a search of RUNS inputs from them, and keeps nothing.
# --seeds replaces the seeds by the smallest set of kept inputs with the same coverage.
set -eu

cd "$(dirname "$0")/.."
. tools/checks.sh
: "${TIME:=60}" "${RUNS:=4000}" "${JOBS:=1}" "${MICROSLIP_SEED:=$(date +%s)}"
mode=
case ${1:-} in
    --check) mode=check TIME=600 JOBS=1 ;;
    --seeds) mode=seeds ;;
esac

# The instrumentation of cargo-fuzz, without that of comparisons. --target keeps the flags from build scripts. AddressSanitizer is
# part of stable Rust, its option is not yet stable.
host=$(rustc -vV | sed -n 's/^host: //p')
RUSTC_BOOTSTRAP=1 RUSTFLAGS='-Zsanitizer=address -Cunsafe-allow-abi-mismatch=sanitizer -Cpasses=sancov-module
    -Cllvm-args=-sanitizer-coverage-level=4 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters
    -Cllvm-args=-sanitizer-coverage-pc-table -Cllvm-args=-simplifycfg-branch-fold-threshold=0' \
    $CARGO build --package microslip-fuzz --quiet --profile fuzz --locked --target "$host"

# The library does not allocate: there are no leaks, and little freed memory to watch.
export ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=16
program=target/$host/fuzz/calls
archive=verification/fuzz/seeds/calls.tar.gz
corpus=verification/fuzz/corpus/calls
seeds=$work/seeds
mkdir -p "$seeds" verification/fuzz/artifacts/calls
if [ "$mode" = seeds ]; then
    "$program" -set_cover_merge=1 -use_counters=0 -max_len=1024 "$seeds" "$corpus"
    tar --create --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --directory "$seeds" . |
        gzip --no-name --best > "$archive"
    exit
fi
tar --extract --gzip --file "$archive" --directory "$seeds"
[ "$mode" = check ] && corpus=$work/new || RUNS=-1
mkdir -p "$corpus"
echo "$RUNS inputs or $TIME s, seed $MICROSLIP_SEED"
set -- -seed="$MICROSLIP_SEED" -runs="$RUNS" -max_total_time="$TIME" -max_len=2048 -len_control=0 -timeout=60 \
    -print_final_stats=1 -artifact_prefix=verification/fuzz/artifacts/calls/
[ "$JOBS" -eq 1 ] || set -- "$@" -fork="$JOBS"
if "$program" "$@" "$corpus" "$seeds" > "$work/log" 2>&1; then
    grep -E 'INITED|DONE|number_of_executed_units' "$work/log" || true
    echo '1 passed, 0 failed'
else
    grep -E -A 3 'panicked|ERROR|SUMMARY|Test unit' "$work/log"
    echo "RUST_LIBFUZZER_DEBUG_PATH=/dev/stdout $program FILE prints and repeats the input FILE named above."
    echo '0 passed, 1 failed'
    exit 1
fi
