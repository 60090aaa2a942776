#!/bin/sh
# linux.sh PREFIX PROCESSOR [CPU]: the package of the compiled library for Linux, target/microslip-VERSION-linux-PROCESSOR.tar.gz, with
# the shared library linked by Zig for glibc 2.17. PROCESSOR is x86_64, with CPU=x86-64 or x86-64-v3, or aarch64, run by QEMU. What it
# contains is tested: symbols, the commands of docs/without-rust.md, clients of the shared library, drivers in C and Fortran, and the
# bits of the library that is installed at PREFIX for this machine. QEMU takes thirty times as long as this machine, so it runs what
# depends on the processor: layouts, reference tables, exceptions, the stack of the deepest calls, joins of formulas. Rejected
# arguments and the properties of histories follow from the equal bits.
set -eu

prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
. tools/checks.sh
processor=$2
cpu=${3:-}
triple=$processor-unknown-linux-gnu
cross=$processor-linux-gnu-
package=microslip-$version-linux-$processor${cpu#x86-64}
installed=$work/$package
[ "$processor" = "$(uname -m)" ] || emulator="qemu-$processor -L /usr/$processor-linux-gnu"
cc=${cross}gcc
fc=${cross}gfortran

build() {
    pypi zig ziglang && make install TARGET="$triple" CPU="$cpu" SHARED=1 PREFIX="$installed" \
        CC="$PWD/target/tools/zig/bin/python -m ziglang cc -target $processor-linux-gnu.2.17" && pack "$package"
}
# Products and sums are fused where that computes a rounding error, by name, and nowhere else.
fused() {
    [ "$("${cross}objdump" -d --no-show-raw-insn "$installed/lib/libmicroslip.a" | grep -cE '\<fn?m(add|sub|la|ls)\>')" -eq \
        "$(grep -rho '[.]mul_add(' src | wc -l)" ]
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
    wrapped=$(grep -o '__wrap_[a-z0-9]*' verification/mathematics/src/lib.rs | sed 's/__wrap_/-Wl,--wrap=/')
    # shellcheck disable=SC2086  # lists
    "$CARGO" build --quiet --release --locked --package mathematics &&
        "$CARGO" build --quiet --release --locked --package mathematics --target "$triple" &&
        application "$CC" "$prefix" native $wrapped target/release/libmathematics.a -lpthread -ldl &&
        application "$cc" "$installed" emulated $wrapped "target/$triple/release/libmathematics.a" -lpthread -ldl &&
        "$work/native" > "$work/native.hash" && $emulator "$work/emulated" > "$work/emulated.hash" &&
        cat "$work/native.hash" "$work/emulated.hash" && cmp "$work/native.hash" "$work/emulated.hash"
}
check 'library: build, install, pack' build
[ "$failed" -eq 0 ] || { counts; exit; }
check 'docs/without-rust.md: programs and commands' page Linux "target/$package.tar.gz"
check 'symbols and sections' env NM="${cross}nm" OBJDUMP="${cross}objdump" tools/symbols.sh "$installed"
check 'the shared library needs glibc 2.17 at most' glibc "$installed/lib/libmicroslip.so.$abi"
check 'shared library: clients' clients "$installed" "libmicroslip.so.$abi"
check 'with the same mathematical functions: the bits of this machine' same_bits
check 'drivers in C and Fortran, with the reference tables' drivers "$installed/lib/libmicroslip.a" \
    layout.c tables.c stack.c test_microslip.f90
[ -z "$emulator" ] || {
    check 'multiplication and addition are fused by name only' fused
    check 'unit tests' env "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=$cc" "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER=$emulator" \
        "$CARGO" test --locked --package microslip --target "$triple" --lib
}
counts
