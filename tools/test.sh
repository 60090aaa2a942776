#!/bin/sh
# test.sh: the regular tests, in Rust, and in C and Fortran against an installed copy. `make check` has the others.
# shellcheck disable=SC2086  # lists
set -eu
cd "$(dirname "$0")/.."
. tools/steps.sh

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
    step 'accuracy and histories: short, and the worst cases' target/debug/verify --points 1e4 --replay verification/accuracy.csv
    step 'paper: figures and claims' target/debug/paper --check
    step 'validation: boundary elements, measurements' target/debug/validation --check
    step 'C header and Fortran module: generated from the source' target/debug/xtask header --check
    step 'Fortran examples, short' make -C fortran_examples short PREFIX="$prefix"
    step 'Python: interface and reference tables' tools/python.sh
    step 'documents: links' tools/links.sh
    FC="$FC -std=f2008"
    programs_of_documents c f90
}

tools/dependencies.sh --install test
together installed compiled
together rust programs
summary
