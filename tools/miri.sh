#!/bin/sh
# miri.sh: tests/ffi.rs under Miri, with stacked borrows and the baseline processor, and with tree borrows and AVX2. Needs the
# nightly toolchain with Miri, which it installs by rustup; exit status 77 if that is not possible.
set -eu

cd "$(dirname "$0")/.."
if ! rustup run nightly cargo miri --version > /dev/null 2>&1 &&
    ! rustup toolchain install nightly --profile minimal --component miri,rust-src; then
    echo 'Miri cannot be installed (rustup toolchain install nightly --component miri,rust-src)'
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Otherwise Miri varies the last digits of the mathematical functions.
strict='-Zmiri-strict-provenance -Zmiri-symbolic-alignment-check -Zmiri-deterministic-floats'

# miri NAME FLAGS
miri() {
    MIRIFLAGS="$strict $2" CARGO_TARGET_DIR=target/miri-$1 \
        rustup run nightly cargo miri test --test ffi --quiet --locked --package microslip > "$work/$1" 2>&1
}

rustup run nightly cargo miri setup --quiet
RUSTFLAGS=-Ctarget-feature=+avx2 miri avx2 -Zmiri-tree-borrows &
status=0
miri baseline '' || status=1
wait $! || status=1
cat "$work/baseline" "$work/avx2"
# A run that aborts has no result.
awk '/^test result: / { passed += $4; failed += $6; ++results }
     END { print passed + 0 " passed, " failed + 2 - results " failed" }' "$work/baseline" "$work/avx2"
exit "$status"
