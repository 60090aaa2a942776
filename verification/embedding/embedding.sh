#!/bin/sh
# guest.sh PREFIX [GROUP...]: is the installed archive a clean guest in every host? A line for each check, the counts in
# the last. The programs are in verification/embedding/; each control shows that a check can fail.
#
#   arithmetic  complex, wide and quadruple arithmetic of a C and a Fortran host are its own, to the last bit
#   compilers   every standard of C and C++, warnings as errors; every driver with the other compiler
#   links       static, position independent, in shared objects, with every linker, beside another Rust archive
#   sanitizers  what an archive built for AddressSanitizer reads and writes
#   valgrind    the same and uninitialised numbers, in the archive as it is installed
#   threads     the bits of one thread on 1 to 8; no race by ThreadSanitizer, helgrind and drd
#   process     signals, locale, rounding, traps, files of the host; without environment and output
#   stack       the deepest stack of every call, and calls on small stacks
# shellcheck disable=SC2086  # flags are lists, split on purpose
set -eu

[ $# -gt 0 ] || { echo "usage: $0 PREFIX [GROUP...]" >&2; exit 2; }
prefix=$(cd "$1" && pwd)
shift
cd "$(dirname "$0")/../.."
: "${CARGO:=cargo}" "${CC:=gcc}" "${CXX:=g++}" "${FC:=gfortran}" "${VALGRIND:=valgrind}" "${NM:=nm}"
. tools/checks.sh
archive=$prefix/lib/libmicroslip.a
unprocessed=target/release/libmicroslip.a
here=verification/embedding

# Products and sums of the host stay apart, so that all compilers make the same inputs.
strict='-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -ffp-contract=off'
include="-I$prefix/include -I$here"
installed="$archive -lm -lpthread"
mistakes="$include $here/mistakes.c $here/use.c"
# What Rust's own library needs, where the archive is not the installed one.
system='-lpthread -ldl -lm'

# The answers of the library in the plainest host; every other has to get the same.
build_host() {
    $CC -std=c99 $strict -O1 $include $here/use.c $here/host.c "$@" -o "$work/plain" && "$work/plain" > "$work/answers"
}

answers() {
    "$@" > "$work/other" && cmp "$work/answers" "$work/other"
}

# built PROGRAM COMPILER-AND-FLAGS...
built() {
    program=$work/$1
    shift
    rm -f "$program" && "$@" -o "$program"
}

# built_answers COMPILER-AND-FLAGS...: a host built so gets the same answers.
built_answers() {
    built host "$@" && answers "$work/host"
}

# --- arithmetic ---

# runtime PROGRAM: which functions of the compiler's runtime are in it, or wanted from its shared form, and by the map of the
# link, from where.
runtime() {
    $NM "$1" | awk 'NR == FNR { known[$3]; next } { sub(/@.*/, "") } $NF in known { print $(NF - 1), $NF }' \
        "$work/runtime" - | sort && sed -n 's/.*\(libgcc[a-z_]*\.a([^)]*)\).*/\1/p' "$1.map" | sort -u
}

# like_alone ARCHIVE-AND-LIBRARIES COMPILER-AND-FLAGS...: the host with its guest computes what it computes alone, by the
# same functions.
like_alone() {
    with_guest "$@" && cmp "$work/alone.out" "$work/guest.out" && diff "$work/alone.runtime" "$work/guest.runtime"
}

# with_guest ARCHIVE-AND-LIBRARIES COMPILER-AND-FLAGS...
with_guest() {
    libraries=$1
    shift
    built guest "$@" $libraries -Wl,-Map,"$work/guest.map" && "$work/guest" > "$work/guest.out" &&
        runtime "$work/guest" > "$work/guest.runtime"
}

# alone COMPILER-AND-FLAGS...: what is compared must be there.
alone() {
    built alone "$@" -lm -Wl,-Map,"$work/alone.map" && "$work/alone" > "$work/alone.out" &&
        runtime "$work/alone" > "$work/alone.runtime" &&
        grep -q '__divtf3$' "$work/alone.runtime"
}

other_functions() {
    with_guest "$@" && ! diff "$work/alone.runtime" "$work/guest.runtime"
}

other_bits() {
    ! cmp "$work/alone.out" "$work/guest.out"
}

arithmetic() {
    $NM --defined-only --extern-only "$($CC -print-libgcc-file-name)" 2> "$work/log" > "$work/runtime"
    for compiler in "$CC" clang; do
        host="$compiler -O1 $include $here/arithmetic.c"
        check "arithmetic: $compiler alone" alone $host
        for object in arithmetic use; do
            $compiler -O1 -DGUEST $include -c "$here/$object.c" -o "$work/$object.o"
        done
        objects="$work/arithmetic.o $work/use.o"
        check "arithmetic: $compiler with the library" like_alone "$archive -lm" $compiler $objects
        check "arithmetic: $compiler, the library first" \
            like_alone -lm $compiler -Wl,-u,mslip_version "$archive" $objects
        check "arithmetic: $compiler, all of the library" \
            like_alone "-Wl,--whole-archive $archive -Wl,--no-whole-archive -lm" $compiler $objects
        check "control: $compiler, cargo's archive brings other functions" \
            other_functions "$unprocessed $system" $compiler $objects
        check "control: $compiler, and they compute other bits" other_bits
    done
    module="-J $work $prefix/include/microslip.f90"
    check 'arithmetic: Fortran alone' alone $FC -O1 -cpp $here/quadruple.f90
    check 'arithmetic: Fortran with the library' \
        like_alone "$archive -lm" $FC -O1 -cpp -DGUEST $module $here/quadruple.f90
    check 'arithmetic: Fortran, the library first' \
        like_alone -lm $FC -O1 -cpp -DGUEST -Wl,-u,mslip_version "$archive" $module $here/quadruple.f90
    check "control: Fortran, cargo's archive brings other functions" \
        other_functions "$unprocessed $system" $FC -O1 -cpp -DGUEST $module $here/quadruple.f90
}

# --- compilers ---

# The host of these tests calls all there is.
calls_everything() {
    $CC -O1 $include -c $here/use.c -o "$work/use.o" &&
        $NM -u "$work/use.o" | sed -n 's/.* \(mslip_[a-z0-9_]*\)$/\1/p' | sort > "$work/called" &&
        $NM --defined-only --extern-only "$archive" | sed -n 's/.* \(mslip_[a-z0-9_]*\)$/\1/p' | sort > "$work/exported" &&
        diff "$work/called" "$work/exported"
}

driver() {
    "$@" "$archive" -lm -o "$work/driver" && "$work/driver"
}

compilers() {
    check 'the host calls every function of the interface' calls_everything
    sources="$include $here/use.c $here/host.c -x none $archive -lm"
    for standard in c99 c11 c17; do
        for compiler in "$CC" clang; do
            check "$compiler -std=$standard" built_answers $compiler -std=$standard $strict -O0 -x c $sources
        done
    done
    for standard in c++11 c++14 c++17 c++20; do
        for compiler in "$CXX" clang++; do
            check "$compiler -std=$standard" built_answers $compiler -std=$standard $strict -O0 -x c++ $sources
        done
    done
    for compiler in "$CC" clang; do
        check "$compiler -std=c99 -O3" built_answers $compiler -std=c99 $strict -O3 -x c $sources
    done
    for source in c_tests/*.c; do
        check "clang -O3: $source" driver clang -std=c99 -Wall -Wextra -Wpedantic -Werror -O3 $include "$source"
        check "$CC -O0: $source" driver $CC -std=c99 -O0 $include "$source"
    done
}

# --- links ---

shared_object() {
    $CC -shared -fPIC -Wl,--fatal-warnings -Wl,-z,text -Wl,-z,defs $include $here/use.c "$archive" -lm -o "$work/$1.so"
}

# Two copies of the library in one process.
loaded() {
    shared_object first && shared_object second && $CC -rdynamic $here/load.c -ldl -o "$work/load" &&
        cat "$work/answers" "$work/answers" > "$work/twice" &&
        "$work/load" "$work/first.so" "$work/second.so" > "$work/other" && cmp "$work/twice" "$work/other"
}

whole_shared_library() {
    $CC -shared -Wl,--fatal-warnings -Wl,-z,text,-z,defs -Wl,--whole-archive "$archive" -Wl,--no-whole-archive -lm \
        -o "$work/libclient.so" &&
        built_answers $CC $include $here/use.c $here/host.c "$work/libclient.so" -Wl,-rpath,"$work" -lm
}

# Another Rust archive has its own copy of Rust's runtime.
other_archive() {
    cat > "$work/other.rs" << 'END_OF_RUST'
#[unsafe(no_mangle)]
pub extern "C" fn other(n: usize) -> usize {
    (0..n).map(|i| format!("{i}").len()).sum()
}
END_OF_RUST
    cat > "$work/both.c" << 'END_OF_C'
#include "use.h"
size_t other(size_t n);
int main(void)
{
    return visit_all() != visit_all() || other(12) != 14;
}
END_OF_C
    rustc --edition 2024 --crate-type staticlib -O "$work/other.rs" -o "$work/libother.a"
}

beside() {
    $CC $include "$work/both.c" $here/use.c "$@" $system -o "$work/both" && "$work/both"
}

links() {
    for object in use host; do
        $CC -O1 -ffp-contract=off $include -c "$here/$object.c" -o "$work/$object.o"
    done
    objects="$work/use.o $work/host.o $archive -lm -Wl,--fatal-warnings"
    for flags in -static -static-pie -no-pie -pie -Wl,-z,now -Wl,-z,lazy -Wl,--gc-sections -Wl,-z,noexecstack \
        -ffast-math '-Wl,--gc-sections -Wl,-O1 -Wl,--icf=all -fuse-ld=lld' -fuse-ld=bfd -fuse-ld=gold -fuse-ld=lld -fuse-ld=mold; do
        # Since binutils 2.44 gold is a package of its own, and no longer kept up.
        [ "$flags" != -fuse-ld=gold ] || command -v ld.gold > /dev/null || continue
        check "linked with $flags" built_answers $CC $flags $objects
    done
    for compiler in "$CC" clang; do
        flags='-flto -O2 -ffp-contract=off'
        [ "$compiler" = "$CC" ] || flags="$flags -fuse-ld=lld"
        check "host compiled by $compiler $flags" \
            built_answers $compiler $flags $include $here/use.c $here/host.c "$archive" -lm
        check "linked by $compiler -static" built_answers $compiler -static $objects
    done
    check 'in two shared objects, loaded one after the other' loaded
    check 'the whole of it in a shared library' whole_shared_library
    check 'another Rust archive' other_archive
    check 'before another Rust archive' beside "$archive" "$work/libother.a"
    check 'after another Rust archive' beside "$work/libother.a" "$archive"
}

# --- sanitizers and valgrind ---

# instrumented SANITIZER: an archive that is watched from within, in $instrumented. The switch is not yet stable.
instrumented() {
    triple=$(rustc -vV | sed -n 's/^host: //p')
    instrumented=target/$1/$triple/release/libmicroslip.a
    # Compiled parts of Rust's library are not watched; they are told to fit.
    RUSTC_BOOTSTRAP=1 RUSTFLAGS="-Zsanitizer=$1 -Cunsafe-allow-abi-mismatch=sanitizer" \
        $CARGO build --quiet --release --locked --package microslip --target "$triple" --target-dir "target/$1"
}

watched() {
    built watched "$@" && "$work/watched"
}

# reports MISTAKE SENTENCE COMMAND...: the tool stops the program with such a report, and saw it inside the library.
reports() {
    mistake=$1
    sentence_of_tool=$2
    shift 2
    ! "$@" "$mistake" > "$work/report" 2>&1 && cat "$work/report" &&
        grep -q "$sentence_of_tool" "$work/report" && grep -q 'mslip_\|microslip' "$work/report"
}

sanitizers() {
    check 'an archive built for AddressSanitizer' instrumented address
    flags='-std=c99 -g -O1 -fsanitize=address,undefined -fno-sanitize-recover=all -ffp-contract=off'
    check 'control: programs with mistakes' built mistakes clang $flags $mistakes $instrumented $system
    check 'control: AddressSanitizer sees an array read beyond its end' reports overrun heap-buffer-overflow "$work/mistakes"
    check 'control: AddressSanitizer sees an array written beyond its end' reports overflow heap-buffer-overflow "$work/mistakes"
    for compiler in "$CC" clang; do
        check "$compiler, AddressSanitizer in the host: all calls" \
            built_answers $compiler $flags $include $here/use.c $here/host.c "$archive" -lm
    done
    # Cargo's archives compute roots and the like by functions of their own: last digits are others.
    check "the plainest host with cargo's archive" build_host $unprocessed $system
    for compiler in "$CC" clang; do
        check "$compiler, AddressSanitizer in host and library: all calls" \
            built_answers $compiler $flags $include $here/use.c $here/host.c $instrumented $system
    done
    for source in c_tests/*.c; do
        check "clang, AddressSanitizer in host and library: $source" watched clang $flags $include "$source" $instrumented $system
        check "$CC, AddressSanitizer in the host: $source" watched $CC $flags $include "$source" "$archive" -lm
    done
}

under_valgrind() {
    $CC -std=c99 -g -O1 $include "$1" "$archive" -lm -o "$work/watched" &&
        $VALGRIND --quiet --error-exitcode=9 --leak-check=full "$work/watched"
}

valgrind_checks() {
    memcheck="$VALGRIND --quiet --error-exitcode=9"
    check 'control: programs with mistakes' built mistakes $CC -g -O1 $mistakes $installed
    check 'control: valgrind sees an array read beyond its end' reports overrun 'Invalid read' $memcheck "$work/mistakes"
    check 'control: valgrind sees an array written beyond its end' reports overflow 'Invalid write' $memcheck "$work/mistakes"
    check 'control: valgrind sees uninitialised numbers' reports uninitialised uninitialised $memcheck "$work/mistakes"
    check 'valgrind: all calls' answers $memcheck --leak-check=full "$work/plain"
    for source in c_tests/*.c; do
        case $source in
            # It changes every bit of memory before pages that must not be touched: here in minutes, and it sees for itself.
            c_tests/bad_memory.c) continue ;;
            # valgrind keeps no flags of exceptions.
            c_tests/environment.c) continue ;;
        esac
        check "valgrind: $source" under_valgrind "$source"
    done
}

# --- threads ---

threads() {
    sources="$include $here/threads.c $here/use.c"
    module="-J $work $prefix/include/microslip.f90"
    optimised='-g -O1 -ffp-contract=off'
    check 'POSIX threads, 1 to 8' watched $CC $optimised $sources "$archive" -lm -lpthread
    check 'OpenMP, 1 to 8 threads' watched $CC $optimised -fopenmp $sources "$archive" -lm
    check 'OpenMP of clang, 1 to 8 threads' watched clang $optimised -fopenmp $sources "$archive" -lm
    check 'OpenMP in Fortran, 1 to 8 threads' watched $FC $optimised -fopenmp $module $here/threads.f90 "$archive" -lm

    check 'a host of POSIX threads' built threads $CC $optimised $sources $installed
    check 'control: programs with mistakes' built mistakes $CC -g -O1 $mistakes $installed
    # They take the atomic variable that tells the processor's vectors for a plain one, so it is set before there are threads.
    for tool in helgrind drd; do
        watch="$VALGRIND --quiet --error-exitcode=9 --tool=$tool"
        check "control: $tool sees a race" reports race 'data race\|Conflicting' $watch "$work/mistakes"
        check "$tool: no race" $watch "$work/threads" asked
    done

    thread_sanitizer
}

# race_watched COMPILER SOURCE...: a host and the library under ThreadSanitizer, linked with the runtime that the
# library was compiled for. Archer, which tells it of OpenMP's own synchronisation, finds that runtime in the program.
race_watched() {
    compiler=$1
    shift
    rm -f "$work"/race_*.o
    modules=
    [ "${compiler#"$FC"}" = "$compiler" ] || modules="-J $work"
    for source in "$@"; do
        object=$work/race_$(basename "$source").o
        $compiler -g -O1 -fsanitize=thread -I"$prefix/include" -I$here $modules -c "$source" -o "$object" || return 1
    done
    clang -rdynamic -fopenmp "$work"/race_*.o $instrumented -Wl,--whole-archive "$runtime" -Wl,--no-whole-archive \
        -L"$(dirname "$($FC -print-file-name=libgfortran.so)")" -Wl,--as-needed -lgfortran $system -lrt -o "$work/watched"
}

race_free() {
    race_watched "$@" && "$work/watched"
}

race_seen() {
    race_watched "$@" && reports race 'data race' "$work/watched"
}

thread_sanitizer() {
    check 'an archive built for ThreadSanitizer' instrumented thread
    runtime=$(ls "$(rustc --print sysroot)"/lib/rustlib/*/lib/librustc*_rt.tsan.a)
    # Of OpenMP's own library archer tells what is to be known.
    export TSAN_OPTIONS=ignore_noninstrumented_modules=1
    for openmp in '' -fopenmp; do
        compiler="clang $openmp"
        check "control: ThreadSanitizer sees a race, $compiler" race_seen "$compiler" $here/mistakes.c $here/use.c
        check "ThreadSanitizer: no race, $compiler" race_free "$compiler" $here/threads.c $here/use.c
    done
    check "ThreadSanitizer: no race, $FC -fopenmp" \
        race_free "$FC -fopenmp" "$prefix/include/microslip.f90" $here/threads.f90
}

# --- process ---

process() {
    check 'a host that looks at its process' \
        built process $CC -std=c99 $strict -O1 $include $here/process.c $here/use.c $installed
    check 'what belongs to the process is as before' "$work/process"
    grep '^CHANGED' "$work/log" || true
    check 'without environment' answers env -i "$work/plain"
    check 'without input and output' without_output "$work/process"
    size "$archive" | sed 's/^/    /'
}

without_output() {
    "$@" <&- >&- 2>&-
}

# --- stack ---

on_small_stack() {
    # shellcheck disable=SC3045  # kB; dash has it too
    (ulimit -s 64 && exec env -i "$@")
}

stack() {
    check 'a host that paints its stack' \
        built stack $CC -std=c99 $strict -O1 $include $here/stack.c $here/use.c $installed
    check 'the calls take no more stack than documented' "$work/stack"
    sed 's/^/    /' "$work/log"
    check 'all calls on a stack of 64 kB' answers on_small_stack "$work/plain"
    check 'a Fortran host' \
        built fortran $FC -O1 -fopenmp -J "$work" "$prefix/include/microslip.f90" $here/threads.f90 $installed
    check 'OpenMP in Fortran on stacks of 64 kB' env OMP_STACKSIZE=64k "$work/fortran"
}

check 'the plainest host' build_host "$archive" -lm
[ $# -gt 0 ] || set -- arithmetic compilers links sanitizers valgrind threads process stack
for group in "$@"; do
    case $group in
        arithmetic | compilers | links | sanitizers | threads | process | stack) "$group" ;;
        valgrind) valgrind_checks ;;
        *) echo "$0: no group $group" >&2; exit 2 ;;
    esac
done

counts
