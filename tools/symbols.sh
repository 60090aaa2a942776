#!/bin/sh
# symbols.sh PREFIX: every library in PREFIX/lib exports the functions of the header and nothing else. The archive also depends on the
# mathematical library only, and has no state; a shared library loads libraries of the system only. NM and OBJDUMP are those of the
# processor; LLVM's read libraries for macOS.
set -eu

prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
: "${NM:=nm}" "${OBJDUMP:=objdump}"
. tools/checks.sh
declared "$prefix/include/microslip.h" > "$work/declared"

empty() {
    [ ! -s "$1" ] || { cat "$1"; false; }
}

# exports EXPRESSION: the names in $work/defined are those of the header, changed by an expression of sed.
exports() {
    sed "$1" "$work/declared" > "$work/expected" && [ -s "$work/expected" ] && sort "$work/defined" | diff "$work/expected" -
}

# loads EXPRESSION: the libraries in $work/needed match an expression of grep.
loads() {
    [ -s "$work/needed" ] && ! grep -viE "^($1)" "$work/needed"
}

# --- Archive ---

# A reachable panic adds an unwinder, an allocator and files to the archive: lists its callers.
only_mathematics() {
    empty "$work/foreign" || {
        $OBJDUMP -dr "$library" | awk '
            /^[0-9a-f]+ <.*>:$/ { caller = $2 }
            caller ~ /microslip|mslip/ && /panic|unwrap_failed|expect_failed|slice_index|len_mismatch/ && / R_/ {
                print "panic: " caller, $3
            }' | sort -u
        false
    }
}

# Functions of the mathematical library, and those to which any compiler adds calls.
allowed='log log1p log2 log10 exp expm1 exp2 sin cos tan sincos asin acos atan atan2 sqrt cbrt pow hypot
sinh cosh tanh asinh acosh atanh fma floor ceil trunc round rint fabs fmin fmax fmod
memcpy memset memmove memcmp _GLOBAL_OFFSET_TABLE_'

archive() {
    $NM --extern-only "$library" > "$work/nm"
    awk 'NF == 3 { print $3 }' "$work/nm" > "$work/defined"
    # shellcheck disable=SC2086
    printf '%s\n' $allowed > "$work/allowed"
    awk '$1 == "U" { print $2 }' "$work/nm" | grep -vxFf "$work/allowed" > "$work/foreign" || true

    # Hidden symbols still bind in a static link.
    $OBJDUMP -t "$library" | awk '$2 != "l" && /\.(hidden|internal|protected) /' > "$work/hidden"
    $OBJDUMP -h "$library" > "$work/sections"
    awk '$2 ~ /^\.(data|bss|tdata|tbss|init_array|ctors)/ && $2 !~ /^\.data\.rel\.ro/ && $3 !~ /^0+$/' \
        "$work/sections" > "$work/writable"
    # valgrind does not implement the store form of vmovq between registers.
    $OBJDUMP -d "$library" | grep -E 'c[45]( [0-9a-f]{2}){1,2} d6 [c-f][0-9a-f][[:space:]]+vmovq ' > "$work/unsupported" || true
    # LLVM's loop that probes a large stack frame overwrites r11, which may be in use if the frame is not allocated at the entry.
    $OBJDUMP -d --no-show-raw-insn "$library" | awk '
        />:$/ { function_name = $2; jumped = 0 }
        $2 ~ /^j/ { jumped = 1 }
        /mov +%rsp, *%r11/ && jumped { print function_name, $0 }' > "$work/late_frames"

    check 'the archive exports the functions of the header' exports ''
    check 'the archive depends on the mathematical library only' only_mathematics
    check 'no hidden symbols' empty "$work/hidden"
    check 'no variables' empty "$work/writable"
    check 'no instructions that valgrind does not support' empty "$work/unsupported"
    check 'large stack frames are allocated at the entry of functions' empty "$work/late_frames"
    check 'no executable stack' grep -q '\.note\.GNU-stack' "$work/sections"
}

# --- Shared libraries ---

linux() {
    $NM -D --defined-only "$library" | awk '$2 != "A" { print $3 }' > "$work/defined"
    readelf -d "$library" > "$work/dynamic"
    sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' "$work/dynamic" > "$work/needed"
    check 'the shared library exports the functions of the header, with the ABI version' exports "s/\$/@@MSLIP_$abi/"
    check 'it loads only the C and the mathematical library' loads '(libm|libc|ld-linux.*)\.so\.'
    check 'its soname has the ABI version' grep -q "SONAME.*\[libmicroslip.so.$abi\]" "$work/dynamic"
}

windows() {
    $OBJDUMP -p "$library" > "$work/headers"
    sed -n '/Ordinal\/Name Pointer/,/^$/s/.*\] *//p' "$work/headers" | grep -v Table > "$work/defined"
    sed -n 's/.*DLL Name: //p' "$work/headers" > "$work/needed"
    check 'the DLL exports the functions of the header' exports ''
    check 'it loads only libraries of Windows' loads 'kernel32|msvcrt|ntdll|userenv|ws2_32|bcryptprimitives|api-ms-win-core-'
}

macos() {
    llvm-nm --extern-only --defined-only "$library" | awk '{ print $3 }' > "$work/defined"
    llvm-objdump --macho --dylibs-used --private-headers "$library" > "$work/headers"
    sed -n 's/^\t\(.*\.dylib\) (comp.*/\1/p' "$work/headers" > "$work/needed"
    check 'the dylib exports the functions of the header' exports 's/^/_/'
    check 'it loads only the library of the system, and its name has the ABI version' \
        loads "/usr/lib/libSystem.B.dylib|@rpath/libmicroslip.$abi.dylib"
    check 'it is for macOS 11, and signed' sh -c "grep -q 'minos 11.0' $work/headers && grep -q LC_CODE_SIGNATURE $work/headers"
}

for library in "$prefix"/lib/*microslip*; do
    case $library in
        *libmicroslip.a) archive ;;
        *.so."$abi") linux ;;
        *.dll) windows ;;
        *."$abi".dylib) macos ;;
    esac
done
counts
