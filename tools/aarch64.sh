#!/bin/sh
# aarch64.sh PREFIX: the library for Linux on aarch64, built by cross compilers and run by QEMU: symbols, clients of archive
# and shared library, drivers in C and Fortran, the unit tests, and the wheel. Its results are compared with those of the library
# that is installed at PREFIX for this machine. QEMU takes thirty times as long as this machine, so it runs what depends on the
# processor: layouts, reference tables, exceptions and stack in a tenth of the random calls, joins of formulas. Rejected arguments
# and the properties of histories follow from the equal bits.
set -eu

prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
: "${CARGO:=cargo}" "${CC:=gcc}"
unset MAKEFLAGS MFLAGS MAKELEVEL # not those of a make that runs this script
. tools/checks.sh
abi=$(sed -n 's/^#define MSLIP_ABI_VERSION //p' include/microslip.h)
triple=aarch64-unknown-linux-gnu
cross=aarch64-linux-gnu-
emulator="qemu-aarch64 -L /usr/aarch64-linux-gnu"
installed=$work/installed
CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=${cross}gcc
CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER=$emulator
export CARGO CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER

# Of the toolchain that this directory uses.
standard_library() {
    [ -d "$(rustc --print sysroot)/lib/rustlib/$triple" ] || rustup target add $triple
}
# Products and sums are fused where that computes a rounding error, by name, and nowhere else.
fused() {
    [ "$(${cross}objdump -d --no-show-raw-insn "$installed/lib/libmicroslip.a" | grep -cE '\<fn?m(add|sub|la|ls)\>')" -eq \
        "$(grep -rho '[.]mul_add(' src | wc -l)" ]
}
# clients [SHARED-LIBRARY]: in C and in Fortran, with the flags of pkg-config.
# shellcheck disable=SC2046  # flags are a list
clients() {
    export PKG_CONFIG_PATH="$installed/lib/pkgconfig" && for language in c f90; do
        source=packaging/clients/client.$language
        case $language in
            c) ${cross}gcc $source -o "$work/client" $(pkg-config --cflags --libs --static microslip) ;;
            f90)
                ${cross}gfortran -J "$work" "$installed/include/microslip.f90" $source -o "$work/client" \
                    $(pkg-config --libs --static microslip)
                ;;
        esac && [ "$(readelf -d "$work/client" | sed -n 's/.*(NEEDED).*\[\(libmicroslip.*\)\]/\1/p')" = "${1:-}" ] &&
            $emulator -E LD_LIBRARY_PATH="$installed/lib" "$work/client" || return
    done
}
# shellcheck disable=SC2086  # a program and its arguments
drivers() {
    for driver in layout.c tables.c stack.c test_microslip.f90; do
        case $driver in
            *.c) ${cross}gcc -O1 -I"$installed/include" c_tests/$driver "$installed/lib/libmicroslip.a" -lm -o "$work/driver" ;;
            *) ${cross}gfortran -J "$work" "$installed/include/microslip.f90" tests/fortran/checks.f90 tests/fortran/$driver \
                "$installed/lib/libmicroslip.a" -lm -o "$work/driver" ;;
        esac && $emulator "$work/driver" --trap || return
    done
}

# application COMPILER PREFIX PROGRAM FLAG...: the program that makes all calls.
application() {
    compiler=$1 library=$2 program=$3
    shift 3
    "$compiler" -O1 -ffp-contract=off -I"$library/include" -Iverification/embedding verification/embedding/calls.c \
        verification/embedding/application.c "$library/lib/libmicroslip.a" "$@" -lm -o "$work/$program"
}
# With the same mathematical functions for both the results are the same.
same_bits() {
    wrapped=$(grep -o '__wrap_[a-z0-9]*' verification/mathematics/src/lib.rs | sed 's/__wrap_//')
    # shellcheck disable=SC2086,SC2046  # lists
    "$CARGO" build --quiet --release --locked --package mathematics &&
        "$CARGO" build --quiet --release --locked --package mathematics --target $triple &&
        application "$CC" "$prefix" native $(printf -- '-Wl,--wrap=%s ' $wrapped) target/release/libmathematics.a -lpthread -ldl &&
        application ${cross}gcc "$installed" emulated $(printf -- '-Wl,--wrap=%s ' $wrapped) \
            target/$triple/release/libmathematics.a -lpthread -ldl &&
        "$work/native" > "$work/native.hash" && $emulator "$work/emulated" > "$work/emulated.hash" &&
        cat "$work/native.hash" "$work/emulated.hash" && cmp "$work/native.hash" "$work/emulated.hash"
}
check 'Rust for aarch64' standard_library
check 'library: build, install' make install TARGET=$triple SHARED=1 PREFIX="$installed"
[ "$failed" -eq 0 ] || { counts; exit; }
check 'archive: symbols and sections' env CC=${cross}gcc NM=${cross}nm OBJDUMP=${cross}objdump tools/symbols.sh "$installed"
check 'archive: multiplication and addition are fused by name only' fused
check 'shared library: clients' clients "libmicroslip.so.$abi"
rm "$installed"/lib/libmicroslip.so*
check 'archive: clients' clients
check 'with the same mathematical functions: the bits of this machine' same_bits
check 'drivers in C and Fortran, with the reference tables' drivers
check 'unit tests' "$CARGO" test --locked --package microslip --target $triple --lib
# Zig links it.
check 'wheel' env -u CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER TARGET=$triple tools/python.sh
counts
