#!/bin/sh
# other_systems.sh PREFIX: packages of the compiled library for Windows and macOS, in target/, with the other files of the installation
# at PREFIX. Archives of these systems cannot be localised, so the library is shared: a linker exports the interface only, and Rust's
# runtime stays within. That of Windows is tested by Wine, in C and in Fortran; that of macOS is linked by LLD with the declarations
# that Zig has of the system's library, and not run.
set -eu

prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
. tools/checks.sh
mingw=x86_64-w64-mingw32-
cc=${mingw}gcc
fc=${mingw}gfortran
emulator=wine
WINEPREFIX=$work/wine WINEDEBUG=-all
export WINEPREFIX WINEDEBUG

# library KIND TRIPLE SYSTEM [OPTION...]: what cargo builds is in $built, the installation without its library in $work/$package.
library() {
    kind=$1
    built=target/$2/release
    package=microslip-$version-$3
    "$CARGO" rustc --config tools/archive.toml --release --locked --package microslip --lib --crate-type "$kind" --target "$2" -- \
        -C link-arg=-s && cp -R "$prefix" "$work/$package" && rm -r "$work/$package"/lib/libmicroslip* "$work/$package/lib/cmake"
}

# --- Windows ---

windows() {
    library cdylib x86_64-pc-windows-gnu windows-x86_64 && cp "$built/microslip.dll" "$built/libmicroslip.dll.a" "$work/$package/lib" && cp "$built/microslip.dll" "$work" &&
        (cd "$work" && python3 -m zipfile -c "$package.zip" "$package") && cp "$work/$package.zip" target
}
# Wine 8 has no library of random numbers, which Rust's own library names, and this one does not call.
wine_has_libraries() {
    wine wineboot -i && echo '__declspec(dllexport) int ProcessPrng(void) { return 0; }' > "$work/random.c" &&
        $cc -shared "$work/random.c" -o "$WINEPREFIX/drive_c/windows/system32/bcryptprimitives.dll"
}

# --- macOS ---

# macos PROCESSOR ARCHITECTURE. LLVM 14 does not know the newest processors.
macos() {
    pypi zig ziglang && library staticlib "$1-apple-darwin" "macos-$1" &&
        sed 's/arm64e\.x1/arm64/g' target/tools/zig/lib/python3*/site-packages/ziglang/lib/libc/darwin/libSystem.tbd > "$work/libSystem.tbd" &&
        declared include/microslip.h | sed 's/^/_/' > "$work/exports" &&
        lld -flavor darwin -dylib -arch "$2" -platform_version macos 11.0 11.0 -adhoc_codesign -dead_strip \
            -exported_symbols_list "$work/exports" -install_name "@rpath/libmicroslip.$abi.dylib" \
            -o "$work/$package/lib/libmicroslip.$abi.dylib" -all_load "$built/libmicroslip.a" "$work/libSystem.tbd" &&
        ln -s "libmicroslip.$abi.dylib" "$work/$package/lib/libmicroslip.dylib" && pack "$package"
}

check 'Windows: package' windows
[ "$failed" -gt 0 ] || {
    check 'Windows: symbols' env OBJDUMP=${mingw}objdump tools/symbols.sh "$work/$package"
    check 'Windows: Wine' wine_has_libraries
    check 'Windows: docs/without-rust.md' page Windows "target/$package.zip"
    # The other driver in C needs calls of Unix.
    check 'Windows: drivers in C and Fortran, with the reference tables' drivers "$work/$package/lib/libmicroslip.dll.a" \
        layout.c tables.c test_microslip.f90
}
for processor in aarch64:arm64 x86_64:x86_64; do
    check "macOS, ${processor%:*}: package" macos "${processor%:*}" "${processor#*:}"
    check "macOS, ${processor%:*}: symbols" tools/symbols.sh "$work/$package"
done
counts
