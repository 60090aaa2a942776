#!/bin/sh
# miri.sh: the C interface under Miri, by both models of what references may do to each other: stacked borrows on the
# vectors of every processor, tree borrows on AVX2. Addresses know what they were made from, and an alignment
# counts only where it is no accident.
#
# Needs Rust's nightly toolchain with Miri, and installs it by rustup. Where that cannot be, a sentence says so, and nothing is counted.
set -eu

cd "$(dirname "$0")/.."
toolchain=nightly

if ! rustup run "$toolchain" cargo miri --version > /dev/null 2>&1 &&
    ! rustup toolchain install "$toolchain" --profile minimal --component miri,rust-src; then
    echo "Miri is not there and cannot be installed here (rustup toolchain install $toolchain --component miri,rust-src)"
    exit 0
fi

# Miri draws the last digits of the mathematical functions by lot; here they are no question.
export MIRIFLAGS='-Zmiri-strict-provenance -Zmiri-symbolic-alignment-check -Zmiri-deterministic-floats'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

miri() {
    # Without checks of overflow, which are tested elsewhere and cost time; no optimisation is meant.
    rustup run "$toolchain" cargo miri "$@" --quiet --locked --release --package microslip
}

rustup run "$toolchain" cargo miri setup --quiet
(MIRIFLAGS="$MIRIFLAGS -Zmiri-tree-borrows" RUSTFLAGS='-Ctarget-feature=+avx2' CARGO_TARGET_DIR=target/miri-avx2 \
    miri test --test ffi > "$work/avx2" 2>&1) &
other=$!
status=0
CARGO_TARGET_DIR=target/miri miri test --test ffi > "$work/least" 2>&1 || status=1
wait "$other" || status=1
cat "$work/least" "$work/avx2"
# Both have to come to an end: one that breaks off has no result.
awk '/^test result: / { passed += $4; failed += $6; ++results }
     END { print passed + 0 " passed, " failed + 2 - results " failed"; exit results != 2 || failed > 0 }' \
    "$work/least" "$work/avx2" || status=1
exit "$status"
