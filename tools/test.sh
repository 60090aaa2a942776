#!/bin/sh
# test.sh: the daily tests, in Rust, and in C, C++ and Fortran against an installed copy. `make check` has the others.
set -eu
cd "$(dirname "$0")/.."
. tools/steps.sh

strict='-Wall -Wextra -Wpedantic -Werror -O1'
step 'packages' tools/dependencies.sh test

verification="--quiet --release --locked --manifest-path verification/Cargo.toml --target-dir target/verification"

# shellcheck disable=SC2086  # flags are a list
rust() {
    step 'Rust: tests' "$CARGO" test --release --workspace --locked --no-fail-fast
    step 'multi-precision reference against the tables' "$CARGO" test $verification --workspace
    step 'accuracy: short' "$CARGO" run $verification --package accuracy -- --check
    step 'stress: short' "$CARGO" run $verification --package stress -- --scale 0.003
    step 'paper: figures and claims' "$CARGO" run $verification --package paper -- --check
}

c_driver() {
    build "$CC -std=c99 $strict" "c_tests/$1.c" "$work/$1" && "$work/$1"
}

cxx_driver() {
    build "$CXX -std=c++11 -pthread $strict" "c_tests/$1.cpp" "$work/$1" && "$work/$1"
}

fortran_program() {
    mkdir -p "$work/$1" && build "$FC -ffpe-trap=invalid,zero,overflow -J $work/$1 $prefix/include/microslip.f90 tests/fortran/checks.f90" \
        "tests/fortran/$1.f90" "$work/$1/test" && "$work/$1/test"
}

snippet() {
    case $1 in
        *.c) build "$CC -std=c99 $strict" "$1" "$work/snippet" ;;
        *.f90) build "$FC -J $work $prefix/include/microslip.f90" "$1" "$work/snippet" ;;
    esac && (cd "$work" && ./snippet)
}

installed() {
    step 'archive: symbols and sections' tools/symbols.sh "$prefix"
    for source in c_tests/*.c; do
        driver=$(basename "$source" .c)
        step "C: $driver" c_driver "$driver"
        step "C: $driver, floating-point traps" "$work/$driver" --trap
    done
    for source in c_tests/*.cpp; do
        step "C++: $(basename "$source" .cpp)" cxx_driver "$(basename "$source" .cpp)"
    done
    for program in test_microslip bad_input; do
        step "Fortran: $program, floating-point traps" fortran_program "$program"
    done
    step 'Fortran examples, short' make -C fortran_examples short PREFIX="$prefix"
    for document in README.md docs/*.md; do
        name=$(basename "$document" .md)
        tools/snippets.sh "$document" "$work/snippets/$name"
        for file in "$work/snippets/$name"/*; do
            [ ! -e "$file" ] || step "$name: $(basename "$file")" snippet "$file"
        done
    done
}

step 'library: build, install, move' install_and_move
together rust installed
step 'Fortran examples against the balance in Rust' env MICROSLIP_PREFIX="$prefix" "$CARGO" test --release --locked --test harmonic_balance
summary
