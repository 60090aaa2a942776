#!/bin/sh
# other_systems.sh: the shared library for Windows and macOS, whose archives cannot be localised: cargo links it, and exports the
# interface only. That of Windows is tested by Wine, in C and in Fortran, and packed into target/; that of macOS is linked by Zig,
# and not run.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
. tools/checks.sh
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml)
abi=$(sed -n 's/^#define MSLIP_ABI_VERSION //p' include/microslip.h)
zig=target/tools/zig
mingw=x86_64-w64-mingw32-
windows=x86_64-pc-windows-gnu
unpacked=$work/microslip-$version-windows-x86_64
WINEPREFIX=$work/wine WINEDEBUG=-all
export WINEPREFIX WINEDEBUG

# library TRIPLE [OPTION...]: the shared library, in target/TRIPLE/release.
library() {
    triple=$1
    shift
    { [ -d "$(rustc --print sysroot)/lib/rustlib/$triple" ] || rustup target add "$triple"; } &&
        "$CARGO" rustc --release --locked --package microslip --lib --crate-type cdylib --target "$triple" -- -C strip=symbols "$@"
}
declared() {
    sed 's,//.*,,' include/microslip.h | tr '\n' ' ' | grep -o 'mslip_[a-z0-9_]* *(' | tr -d ' (' | sort
}

# --- Windows ---

pack() {
    mkdir -p "$unpacked" && cp target/$windows/release/microslip.dll target/$windows/release/libmicroslip.dll.a \
        include/microslip.h include/microslip.f90 LICENSE-MIT LICENSE-APACHE packaging/THIRD-PARTY.md "$unpacked" &&
        (cd "$work" && python3 -m zipfile -c "$unpacked.zip" "${unpacked##*/}") && cp "$unpacked.zip" target/
}
windows_exports() {
    declared > "$work/declared" && ${mingw}objdump -p "$unpacked/microslip.dll" |
        sed -n '/Ordinal\/Name Pointer/,/^$/s/.*\] *//p' | grep -v Table | sort | diff "$work/declared" -
}
# Wine 8 has no library of random numbers, which Rust's own library names, and this one does not call.
wine_has_libraries() {
    echo '__declspec(dllexport) int ProcessPrng(void) { return 0; }' > "$work/random.c" &&
        ${mingw}gcc -shared "$work/random.c" -o "$unpacked/bcryptprimitives.dll" && wine wineboot -i
}
# windows_program COMPILER ARGUMENT...: it is built, run, and reports no failed check.
windows_program() {
    "$@" "$unpacked/libmicroslip.dll.a" -o "$unpacked/program.exe" || return
    wine "$unpacked/program.exe" | tr -d '\r' | tail -n 5 > "$work/report"
    cat "$work/report"
    tail -n 1 "$work/report" | grep -qx '[1-9][0-9]* passed, 0 failed'
}
windows() {
    check 'Windows: the exported functions are those of the header' windows_exports
    check 'Windows: Wine' wine_has_libraries
    # The other one needs calls of Unix.
    for driver in layout tables; do
        check "Windows: $driver.c" windows_program ${mingw}gcc -std=c99 -O1 -Wall -Wextra -Wpedantic -Werror -Iinclude \
            c_tests/$driver.c
    done
    check 'Windows: Fortran' windows_program ${mingw}gfortran -J "$work" -static include/microslip.f90 tests/fortran/checks.f90 \
        tests/fortran/test_microslip.f90
}

# --- macOS ---

# Zig has the declarations of the system's libraries, but for one that the library does not call.
linker() {
    { $zig/bin/python -c 'import ziglang' 2> /dev/null || { python3 -m venv $zig && $zig/bin/pip install --quiet ziglang; }; } &&
        for processor in aarch64 x86_64; do
            cat > "$work/link_$processor" << END
#!/bin/sh
for option; do
    shift
    [ "\$option" = -liconv ] || set -- "\$@" "\$option"
done
exec '$PWD/$zig/bin/python' -m ziglang cc -target $processor-macos "\$@"
END
            chmod +x "$work/link_$processor" || return
        done
}
macos_exports() {
    declared | sed 's/^/_/' > "$work/declared" && llvm-nm --extern-only --defined-only "target/$1/release/libmicroslip.dylib" |
        awk '{ print $3 }' | sort | comm -23 "$work/declared" - > "$work/missing" && [ ! -s "$work/missing" ] &&
        llvm-objdump --macho --dylibs-used "target/$1/release/libmicroslip.dylib" > "$work/used" &&
        grep -q "@rpath/libmicroslip.$abi.dylib" "$work/used" && ! grep -vE "dylib:$|libmicroslip|/usr/lib/libSystem" "$work/used"
}

check 'Windows: shared library' library $windows
check 'Windows: package' pack
[ "$failed" -gt 0 ] || windows
check 'macOS: linker' linker
for processor in aarch64 x86_64; do
    triple=$processor-apple-darwin
    linker_variable=CARGO_TARGET_$(echo $triple | tr 'a-z-' 'A-Z_')_LINKER
    export "$linker_variable=$work/link_$processor"
    check "macOS, $processor: shared library" library $triple -C "link-arg=-Wl,-install_name,@rpath/libmicroslip.$abi.dylib"
    check "macOS, $processor: functions and libraries" macos_exports $triple
done
counts
