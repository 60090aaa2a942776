#!/bin/sh
# test.sh: every test, in Rust and against an installed copy in C, C++ and Fortran. A step that fails is named and the
# rest still runs; the last line has the counts of all of them.
# shellcheck disable=SC2046,SC2086  # flags are lists, split on purpose
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}" "${CC:=gcc}" "${CXX:=g++}" "${FC:=gfortran}"
export CARGO CC CXX FC
unset MAKEFLAGS MFLAGS MAKELEVEL # the make that started this is not the parent of those below

tools/dependencies.sh test

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/moved
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig"
passed=0
failed=0

# step NAME COMMAND...: one step, counted by what it prints, or else as one test; an exit status of 77 says that what it
# needs is not there, and counts nothing. The steps below are functions, in
# which a failure does not end the shell: they join their commands by &&.
step() {
    name=$1
    shift
    printf '%-68s' "$name"
    status=0
    begun=$(date +%s)
    "$@" > "$work/log" 2>&1 || status=$?
    seconds=$(($(date +%s) - begun))
    if [ "$status" -eq 77 ]; then
        echo "SKIPPED: $(tail -n 1 "$work/log")"
        return
    fi
    # Cargo shows what failing tests print, the count of a driver among it: that is no count of cargo's.
    awk '/^test result: /                 { tests += $4; failures += $6; ++results }
         /^[0-9]+ passed, [0-9]+ failed$/ { passed += $1; failed += $3; ++counts }
         END {
             if (results) print tests, failures, results
             else print passed + 0, failed + 0, counts + 0
         }' "$work/log" > "$work/counts"
    read -r good bad counts < "$work/counts"
    if [ "$counts" -eq 0 ] && [ "$status" -eq 0 ]; then
        good=1
    elif [ "$bad" -eq 0 ] && { [ "$status" -ne 0 ] || [ "$good" -eq 0 ]; }; then
        bad=1 # it broke off, or counted nothing
    fi
    passed=$((passed + good))
    failed=$((failed + bad))
    if [ "$bad" -eq 0 ]; then
        echo "$good passed, $seconds s"
    else
        echo "FAILED ($good passed, $bad failed)"
        sed 's/^/    /' "$work/log"
    fi
}

# What a client passes to its compiler.
flags() {
    pkg-config --cflags --libs --static microslip
}

# Staged elsewhere and moved: nothing that is installed may know its place.
install_and_move() {
    make install PREFIX=/opt/microslip DESTDIR="$work/stage" && mv "$work/stage/opt/microslip" "$prefix"
}

uninstall() {
    cp -R "$prefix" "$work/leave" && make uninstall PREFIX="$work/leave" &&
        [ -z "$(find "$work/leave" -type f)" ]
}

# build COMPILER-AND-FLAGS SOURCE PROGRAM
build() {
    $1 "$2" -o "$3" $(flags)
}

strict='-Wall -Wextra -Wpedantic -Werror -O1'

c_driver() {
    build "$CC -std=c99 $strict" "c_tests/$1.c" "$work/$1" && "$work/$1"
}

cxx_driver() {
    build "$CXX -std=c++17 -pthread $strict" "c_tests/$1.cpp" "$work/$1" && "$work/$1"
}

cmake_client() {
    cmake -S c_tests/cmake -B "$work/cmake" -DCMAKE_PREFIX_PATH="$prefix" -DWANTED_VERSION=0.1 &&
        cmake --build "$work/cmake" && (cd "$work/cmake" && ctest --output-on-failure)
}

cmake_refuses_other_version() {
    ! cmake -S c_tests/cmake -B "$work/cmake-other" -DCMAKE_PREFIX_PATH="$prefix" -DWANTED_VERSION=99
}

fortran_module() {
    mkdir -p "$work/module" && $FC $1 -c "$prefix/include/microslip.f90" -J "$work/module" -o "$work/module/microslip.o"
}

# fortran_tests FLAGS PROGRAM
fortran_tests() {
    rm -rf "$work/fortran" && mkdir "$work/fortran" &&
        build "$FC $1 -J $work/fortran $prefix/include/microslip.f90 tests/fortran/checks.f90" "tests/fortran/$2.f90" \
            "$work/fortran/test" && "$work/fortran/test"
}

snippet() {
    case $1 in
        *.c) build "$CC -std=c99 $strict" "$1" "$work/snippet" ;;
        *.f90) build "$FC -J $work $prefix/include/microslip.f90" "$1" "$work/snippet" ;;
    esac && (cd "$work" && ./snippet)
}

step 'Rust: formatting' "$CARGO" fmt --all --check
step 'Rust: formatting of the fuzz targets' "$CARGO" fmt --manifest-path verification/fuzz/Cargo.toml --check
step 'Rust: lints' "$CARGO" clippy --workspace --all-targets --locked -- -D warnings
step 'Rust: documentation' env RUSTDOCFLAGS='-D warnings' "$CARGO" doc --no-deps --locked --package microslip
step 'shell: lints' sh -c 'find . -name target -prune -o -name "*.sh" -print | xargs shellcheck .ci/run'
step 'Rust: tests' "$CARGO" test --release --workspace --locked --no-fail-fast
step 'C header and Fortran module: generated from the source' "$CARGO" run --quiet --release --package xtask -- header --check

step 'stress: adversarial histories, short' "$CARGO" run --quiet --release --locked --manifest-path verification/Cargo.toml --target-dir target/verification --package stress -- --scale 0.003

step 'paper: its figures and its claims' "$CARGO" run --quiet --release --locked --manifest-path verification/Cargo.toml --target-dir target/verification --package paper -- --check

# cargo COMMAND of the comparison with multi-precision.
accuracy() {
    command=$1
    shift
    "$CARGO" "$command" --quiet --release --locked --manifest-path verification/Cargo.toml --target-dir target/verification --package accuracy -- "$@"
}

step 'accuracy: formatting' "$CARGO" fmt --manifest-path verification/Cargo.toml --all --check
step 'reference: tables of 25 digits' "$CARGO" test --quiet --release --locked --manifest-path verification/Cargo.toml --target-dir target/verification --workspace
step 'accuracy: short' accuracy run --check

step 'install, then move' install_and_move
if [ ! -e "$prefix/lib/libmicroslip.a" ]; then
    echo 'Nothing is installed, so the clients cannot be tested.'
    echo "$passed passed, $failed failed"
    exit 1
fi
step 'archive: symbols and sections' tools/symbols.sh "$prefix"
for group in arithmetic compilers links sanitizers valgrind threads process stack; do
    step "archive in every host: $group" verification/embedding/embedding.sh "$prefix" "$group"
done
step 'archive: instructions' benches/instruction_counts/run.sh "$prefix"

for source in c_tests/*.c; do
    driver=$(basename "$source" .c)
    step "C: $driver" c_driver "$driver"
    step "C: $driver, floating-point traps" "$work/$driver" --trap
done
for source in c_tests/*.cpp; do
    driver=$(basename "$source" .cpp)
    step "C++: $driver" cxx_driver "$driver"
    step "C++: $driver, floating-point traps" "$work/$driver" --trap
done
step 'CMake: find_package' cmake_client
step 'CMake: another version is refused' cmake_refuses_other_version
step 'packages: source tarball, clients by each tool, shared library' tools/packages.sh
step 'packages: fpm' tools/fpm.sh "$prefix"

wide='-fdefault-real-8 -fdefault-integer-8'
traps='-ffpe-trap=invalid,zero,overflow'
for standard in f2008 f2018; do
    for kinds in '' "$wide" -fno-automatic; do
        step "Fortran module: $standard $kinds" fortran_module "-std=$standard -Wall -Wextra -pedantic -Werror $kinds"
    done
done
for kinds in '' "$wide" -fno-automatic; do
    for program in test_microslip bad_input; do
        step "Fortran: $program $kinds" fortran_tests "$kinds" "$program"
        step "Fortran: $program, floating-point traps $kinds" fortran_tests "$traps $kinds" "$program"
    done
done
step 'C interface: fuzzing, bounded' tools/fuzz.sh --check
step 'benchmark: its own check' benches/check.sh "$prefix"
calculix_results() {
    mkdir -p "$work/calculix" &&
        $FC -J "$work/calculix" "$prefix/include/microslip.f90" examples/calculix/compare.f90 $(flags) -llapack -lblas \
            -o "$work/calculix/compare" &&
        "$work/calculix/compare" examples/calculix/results
}
calculix_is_current() {
    (cd examples/calculix && sha256sum --check --quiet results/made.sha256)
}
step 'CalculiX: what it found is what the library finds' calculix_results
step 'CalculiX: found with this element and these models' calculix_is_current
step 'Fortran examples, short' make -C fortran_examples short PREFIX="$prefix"
step 'Fortran on threads and ranks' make -C fortran_examples parallel PREFIX="$prefix"

fortran_against_rust() {
    MICROSLIP_PREFIX="$prefix" $CARGO test --release --locked --test harmonic_balance
}
step 'Fortran examples against the balance in Rust' fortran_against_rust

for document in README.md docs/*.md; do
    name=$(basename "$document" .md)
    step "$name: extraction of its programs" tools/snippets.sh "$document" "$work/snippets/$name"
    for file in "$work/snippets/$name"/*; do
        [ -e "$file" ] || break
        step "$name: $(basename "$file")" snippet "$file"
    done
done
for extension in c f90; do
    step "README: has a whole program in $extension" test -n "$(find "$work/snippets/README" -name "*.$extension")"
done
step 'uninstall leaves no file' uninstall

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
