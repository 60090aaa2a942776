#!/bin/sh
# fuzz.sh [--check | --seeds] [TARGET...]: coverage-guided fuzzing of the C interface (libFuzzer), on stable Rust.
#
#   calls     sequences of calls, memory that is spoiled among them
#   physics   what must hold for every contact and every history
#
# TIME seconds for each target (60), JOBS processes (1), SEED (new each time), SANITIZER=address or none. Inputs that reach
# something new are kept in verification/fuzz/corpus/; they start from verification/fuzz/seeds/. What fails is written to verification/fuzz/artifacts/.
#
# --check is bounded: from the seeds alone, with one SEED, and nothing is kept; it counts each target as a test.
# --seeds makes the seeds: the fewest of the inputs that were kept which reach all that these reach.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}" "${TIME:=60}" "${JOBS:=1}" "${SEED:=$(date +%s)}" "${SANITIZER:=address}"
mode=
case ${1:-} in
    --check) mode=check TIME=20 JOBS=1 SEED=1 && shift ;;
    --seeds) mode=seeds && shift ;;
esac
[ $# -gt 0 ] || set -- calls physics

host=$(rustc -vV | sed -n 's/^host: //p')
# Those of cargo-fuzz, but for the comparisons of integers: there is nothing to be guessed.
flags='--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4'
flags="$flags -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table"
flags="$flags -Cllvm-args=-simplifycfg-branch-fold-threshold=0"
case $SANITIZER in
    address)
        # Stable Rust has AddressSanitizer, and only the option is not yet stable.
        export RUSTC_BOOTSTRAP=1
        flags="$flags -Zsanitizer=address"
        features=
        ;;
    none) features=guards ;;
    *)
        echo "$0: SANITIZER is address or none" >&2
        exit 2
        ;;
esac
built=verification/fuzz/target/$SANITIZER
# --target keeps the flags from build scripts.
RUSTFLAGS=$flags $CARGO build --quiet --release --locked --manifest-path verification/fuzz/Cargo.toml --target "$host" \
    --target-dir "$built" --features "$features"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
failed=0
# The library has no heap: there is nothing to leak, and little to keep from being used again.
export ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=16 MICROSLIP_FUZZ_CALLS="$work/count"

# job TARGET NUMBER: one process; its output is in a file.
job() {
    "$built/$host/release/$1" "$corpus" "$work/seeds" -seed=$((SEED + $2)) -max_total_time="$TIME" -max_len=1024 \
        -len_control=0 -timeout=60 -artifact_prefix="verification/fuzz/artifacts/$1/" > "$work/$2.log" 2>&1
}

for target; do
    corpus=verification/fuzz/corpus/$target
    rm -rf "$work/seeds"
    mkdir "$work/seeds"
    if [ "$mode" = seeds ]; then
        "$built/$host/release/$target" -set_cover_merge=1 -use_counters=0 -max_len=512 "$work/seeds" "$corpus"
        tar --create --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --directory "$work/seeds" . |
            gzip --no-name --best > "verification/fuzz/seeds/$target.tar.gz"
        continue
    fi
    tar --extract --gzip --file "verification/fuzz/seeds/$target.tar.gz" --directory "$work/seeds"
    [ -z "$mode" ] || corpus=$work/$target
    mkdir -p "$corpus" "verification/fuzz/artifacts/$target"
    : > "$work/count"
    echo "$target: $TIME s, $JOBS at once, seed $SEED"
    pids=
    for number in $(seq "$JOBS"); do
        : > "$work/$number.log"
        job "$target" "$number" &
        pids="$pids $!"
    done
    # The progress of the first.
    tail -f -n +1 --pid="${pids##* }" "$work/1.log" | grep --line-buffered -E 'INITED|pulse|DONE|calls' || true
    bad=
    number=0
    for pid in $pids; do
        number=$((number + 1))
        wait "$pid" || bad="$bad $number"
    done
    for number in $bad; do
        grep -vE 'INITED|NEW|REDUCE|RELOAD|pulse' "$work/$number.log"
    done
    awk -v target="$target" '{ calls += $1 } END { printf "%s: %.0f calls of the interface\n", target, calls }' "$work/count"
    if [ -z "$bad" ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "$target failed. To repeat it, and to see each call:"
        echo "    MICROSLIP_FUZZ_TELL=1 $built/$host/release/$target FILE"
        echo "with the file that is named above, in verification/fuzz/artifacts/$target/."
    fi
done
[ "$mode" = seeds ] || echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
