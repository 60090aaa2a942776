#!/bin/sh
# miri.sh: tests/ffi.rs under Miri, with stacked borrows. Needs the nightly toolchain with Miri, which it installs by rustup; exit
# status 77 if that is not possible.
set -eu

cd "$(dirname "$0")/.."
if ! rustup run nightly cargo miri --version > /dev/null 2>&1 &&
    ! rustup toolchain install nightly --profile minimal --component miri,rust-src; then
    echo 'Miri cannot be installed (rustup toolchain install nightly --component miri,rust-src)'
    exit 77
fi
rustup run nightly cargo miri setup --quiet
# Otherwise Miri varies the last digits of the mathematical functions.
export MIRIFLAGS='-Zmiri-strict-provenance -Zmiri-symbolic-alignment-check -Zmiri-deterministic-floats'
CARGO_TARGET_DIR=target/miri \
    rustup run nightly cargo miri test --test ffi --quiet --locked --package microslip
