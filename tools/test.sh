#!/bin/sh
# test.sh: the daily tests, in Rust, and in C, C++ and Fortran against an installed copy. `make check` has the others.
set -eu
cd "$(dirname "$0")/.."
. tools/steps.sh

verification="--quiet --release --locked --manifest-path verification/Cargo.toml --target-dir target/verification"
strict='-Wall -Wextra -Wpedantic -Werror -O1'

# A program of a document prints its result in the document.
snippet() {
    case $1 in
        *.c) build "$CC -std=c99 $strict" "$1" "$work/snippet" ;;
        *.f90) build "$FC -J $work $prefix/include/microslip.f90" "$1" "$work/snippet" ;;
    esac && "$work/snippet" > "$work/snippet.txt" && diff "${1%.*}.txt" "$work/snippet.txt"
}

library() {
    step 'library: tests in Rust, C, C++ and Fortran' env MICROSLIP_PREFIX="$prefix" "$CARGO" test --release --locked --no-fail-fast
    step 'archive: symbols and sections' tools/symbols.sh "$prefix"
    step 'Fortran examples, short' make -C fortran_examples short PREFIX="$prefix"
    step 'documents: links' tools/links.sh
    for document in README.md docs/*.md; do
        name=$(basename "$document" .md)
        tools/snippets.sh "$document" "$work/snippets/$name"
        for file in "$work/snippets/$name"/*.c "$work/snippets/$name"/*.f90; do
            [ ! -e "$file" ] || step "$name: $(basename "$file")" snippet "$file"
        done
    done
}

# shellcheck disable=SC2086  # flags are a list
others() {
    step 'reference against the tables' "$CARGO" test $verification --workspace
    step 'accuracy: short' "$CARGO" run $verification --package accuracy -- --check
    step 'stress: short' "$CARGO" run $verification --package stress -- --scale 0.003
    step 'paper: figures and claims' "$CARGO" run $verification --package paper -- --check
    step 'validation: boundary elements, measurements' "$CARGO" run $verification --package validation -- --check
    step 'command line' env CARGO_PROFILE_DEV_DEBUG=0 "$CARGO" test --locked --package microslip-cli
    step 'identification of measured loops' "$CARGO" test --release --locked --package microslip-fit
    step 'Python: wheel, interface and reference tables' tools/python.sh
    step 'C header and Fortran module: generated from the source' "$CARGO" run --quiet --locked --package xtask -- header --check
}

step 'packages' tools/dependencies.sh test
step 'library: build, install, move' install_and_move
together library others
summary
