#!/bin/sh
# test.sh: the regular tests, in Rust, and in C and Fortran against an installed copy. `make check` has the others.
# shellcheck disable=SC2086  # lists
set -eu
cd "$(dirname "$0")/.."
. tools/steps.sh

strict='-Wall -Wextra -Wpedantic -Werror -O1'

# A program of a document prints its result in the document.
snippet() {
    case $1 in
        *.c) build "$CC -std=c99 $strict" "$1" "$work/snippet" ;;
        *.f90) build "$FC -J $work $prefix/include/microslip.f90" "$1" "$work/snippet" ;;
    esac && "$work/snippet" > "$work/snippet.txt" && diff "${1%.*}.txt" "$work/snippet.txt"
}

installed() {
    step 'library: build, install, move' install_and_move
}

# By one command: the test of the library is compiled beside the library.
compiled() {
    step 'tools and tests: compiled' "$CARGO" build $workspace --bins --tests
}

rust() {
    step 'tests in Rust; drivers in C and Fortran' env MICROSLIP_PREFIX="$prefix" "$CARGO" test $workspace --no-fail-fast
}

programs() {
    step 'archive: symbols and sections' tools/symbols.sh "$prefix"
    step 'accuracy and histories: short, and the worst cases' target/debug/verify --points 1e4 --replay docs/accuracy.csv
    step 'paper: figures and claims' target/debug/paper --check
    step 'validation: boundary elements, measurements' target/debug/validation --check
    step 'C header and Fortran module: generated from the source' target/debug/xtask header --check
    step 'Fortran examples, short' make -C fortran_examples short PREFIX="$prefix"
    step 'Python: interface and reference tables' tools/python.sh
    step 'documents: links' tools/links.sh
    for document in README.md docs/*.md; do
        name=$(basename "$document" .md)
        tools/snippets.sh "$document" "$work/snippets/$name"
        for file in "$work/snippets/$name"/*.c "$work/snippets/$name"/*.f90; do
            [ ! -e "$file" ] || step "$name: $(basename "$file")" snippet "$file"
        done
    done
}

tools/dependencies.sh --install test
together installed compiled
together rust programs
summary
