#!/bin/sh
# embedding.sh PREFIX [GROUP...]: the installed archive as an embedded library in calling applications.
#
#   compilers   standards of C and C++, with warnings as errors
#   links       static, position independent, LTO, each linker, shared objects, together with another Rust archive
#   valgrind    the installed archive: accesses outside of arrays, uninitialised values
# shellcheck disable=SC2086  # flags are lists
set -eu

[ $# -gt 0 ] || { echo "usage: $0 PREFIX [GROUP...]" >&2; exit 2; }
prefix=$(cd "$1" && pwd)
shift
cd "$(dirname "$0")/../.."
: "${CC:=gcc}" "${CXX:=g++}" "${VALGRIND:=valgrind}"
. tools/checks.sh
here=verification/embedding
archive=$prefix/lib/libmicroslip.a
# What Rust's own library needs in archives other than the installed one.
system='-lpthread -ldl -lm'

# Without contraction of products and sums all compilers compute the same inputs.
strict='-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -ffp-contract=off'
include="-I$prefix/include -I$here"
calls="$include $here/calls.c"
application="-O1 -ffp-contract=off $calls $here/application.c"

# build PROGRAM COMPILER-AND-FLAGS...
build() {
    program=$work/$1
    shift
    rm -f "$program" && "$@" -o "$program"
}

# The hash of a program is that of the first application.
same_hash() {
    "$@" > "$work/other" && cmp "$work/hash" "$work/other"
}

# same_application COMPILER-AND-FLAGS...: an application built in this way gets the same results.
same_application() {
    build application "$@" && same_hash "$work/application"
}

first_application() {
    build first $CC -std=c99 $strict $application "$@" && "$work/first" > "$work/hash"
}

# --- compilers ---

compilers() {
    for dialect in "$CC -std=c99 -x c" "$CC -std=c2x -x c" 'clang -std=c99 -x c' 'clang -std=c2x -x c' \
        "$CXX -std=c++11 -x c++" "$CXX -std=c++20 -x c++" 'clang++ -std=c++11 -x c++' 'clang++ -std=c++20 -x c++'; do
        check "$dialect" same_application $dialect $strict $application -x none "$archive" -lm
    done
}

# --- links ---

# A shared object with a copy of the library exports the library's functions, unless it is linked with --exclude-libs.
exclude_libs() {
    for flags in '' -Wl,--exclude-libs,libmicroslip.a; do
        $CC -O1 -shared -fPIC $calls "$archive" -lm $flags -o "$work/exporting.so" || return 1
        nm -D --defined-only "$work/exporting.so" | grep -c ' mslip_'
    done > "$work/exported" || true
    [ "$(head -n 1 "$work/exported")" -gt 0 ] && [ "$(tail -n 1 "$work/exported")" = 0 ]
}

shared_library() {
    $CC -shared -Wl,--fatal-warnings -Wl,-z,text,-z,defs -Wl,--whole-archive "$archive" -Wl,--no-whole-archive -lm \
        -o "$work/libapplication.so" && same_application $CC $application "$work/libapplication.so" -Wl,-rpath,"$work" -lm
}

# Another Rust archive has its own copy of Rust's runtime.
other_rust_archive() {
    cat > "$work/other.rs" << 'END_OF_RUST'
#[unsafe(no_mangle)]
pub extern "C" fn other(n: usize) -> usize {
    (0..n).map(|i| format!("{i}").len()).sum()
}
END_OF_RUST
    cat > "$work/both.c" << 'END_OF_C'
#include "calls.h"
size_t other(size_t n);
int main(void)
{
    return hash_of_all(0) != hash_of_all(0) || other(12) != 14;
}
END_OF_C
    rustc --edition 2024 --crate-type staticlib -O "$work/other.rs" -o "$work/libother.a" &&
        for archives in "$archive $work/libother.a" "$work/libother.a $archive"; do
            build both $CC $calls "$work/both.c" $archives $system && "$work/both" || return 1
        done
}

links() {
    for flags in -static -static-pie -no-pie -ffast-math -fuse-ld=bfd -fuse-ld=gold -fuse-ld=mold \
        '-fuse-ld=lld -Wl,--gc-sections,-O1,--icf=all' -flto; do
        # Since binutils 2.44 gold is a package of its own.
        [ "$flags" != -fuse-ld=gold ] || command -v ld.gold > /dev/null || continue
        # -ffast-math is meant for the linker only: it flushes subnormal numbers.
        $CC -O1 -ffp-contract=off $include -c $here/calls.c -o "$work/calls.o"
        $CC -O1 $include -c $here/application.c -o "$work/application.o"
        objects="$work/calls.o $work/application.o"
        [ "$flags" != -flto ] || objects=$application
        check "link: $CC $flags" same_application $CC $flags $objects "$archive" -lm -Wl,--fatal-warnings
    done
    check 'link: clang -flto -static' same_application clang -flto -fuse-ld=lld -static $application "$archive" -lm
    check 'a shared library of the whole archive' shared_library
    check 'a shared object that hides the functions by --exclude-libs' exclude_libs
    check 'before and after another Rust archive' other_rust_archive
}

# --- valgrind ---

valgrind_checks() {
    memcheck="$VALGRIND --quiet --error-exitcode=9"
    check 'valgrind: all calls' same_hash $memcheck --leak-check=full "$work/first"
}

check 'an application in C99' first_application "$archive" -lm
[ $# -gt 0 ] || set -- compilers links valgrind
for group; do
    case $group in
        compilers | links) "$group" ;;
        valgrind) valgrind_checks ;;
        *) echo "$0: no group $group" >&2; exit 2 ;;
    esac
done
counts
