#!/bin/sh
# symbols.sh PREFIX: does the installed archive export exactly the interface, and need only the mathematical library?
set -eu

prefix=$1
archive=$prefix/lib/libmicroslip.a
: "${CC:=cc}" "${NM:=nm}" "${OBJDUMP:=objdump}" "${CARGO:=cargo}"
. "$(dirname "$0")/checks.sh"

none() {
    [ ! -s "$1" ] || { cat "$1"; false; }
}

# A reachable panic brings an unwinder, an allocator and files along: say who calls it.
only_mathematics() {
    none "$work/foreign" || {
        echo 'calls of a panic:'
        $OBJDUMP -dr "$archive" | awk '
            /^[0-9a-f]+ <.*>:$/ { caller = $2 }
            caller ~ /microslip|mslip/ && /panic|unwrap_failed|expect_failed|slice_index|len_mismatch/ && / R_/ {
                print "  " caller, $3
            }' | sort -u
        false
    }
}

# What a mathematical library has, and the four functions that a compiler may call by itself.
allowed='log log1p log2 log10 exp expm1 exp2 sin cos tan sincos asin acos atan atan2 sqrt cbrt pow hypot
sinh cosh tanh asinh acosh atanh fma floor ceil trunc round rint fabs fmin fmax fmod
memcpy memset memmove memcmp _GLOBAL_OFFSET_TABLE_'

$NM --extern-only "$archive" > "$work/nm"
awk 'NF == 3 { print $3 }' "$work/nm" | sort > "$work/defined"
awk '$1 == "U" { print $2 }' "$work/nm" | sort > "$work/undefined"
# shellcheck disable=SC2086
printf '%s\n' $allowed | sort > "$work/allowed"
comm -23 "$work/undefined" "$work/allowed" > "$work/foreign"

printf '#include <microslip.h>\n' | $CC -E -P -I"$prefix/include" - |
    tr '\n' ' ' | grep -o 'mslip_[a-z0-9_]* *(' | tr -d ' (' | sort > "$work/declared"
$CARGO run --quiet --release --package xtask -- symbols | sort > "$work/source"

$OBJDUMP -t "$archive" > "$work/table"
awk '$2 != "l" && /\.(hidden|internal|protected) /' "$work/table" > "$work/hidden"
$OBJDUMP -h "$archive" > "$work/sections"
# Rust keeps what the processor can do, asked once, in a variable of its own; there is no other.
awk '$2 ~ /^\.(data|bss|tdata|tbss|init_array|ctors)/ && $2 !~ /^\.data\.rel\.ro/ && $2 !~ /std_detect.*CACHE$/ && $3 !~ /^0+$/' \
    "$work/sections" > "$work/writable"
# valgrind knows no copy between registers in this form, the one of a store, and stops a program that executes it.
$OBJDUMP -d "$archive" | grep -E 'c[45]( [0-9a-f]{2}){1,2} d6 [c-f][0-9a-f][[:space:]]+vmovq ' > "$work/unknown" || true
# Where a large frame is not made at a function's entry, the loop that probes the stack may overwrite a register in use: LLVM
# takes r11 for it without looking.
$OBJDUMP -d --no-show-raw-insn "$archive" | awk '
    />:$/ { function_name = $2; jumped = 0 }
    $2 ~ /^j/ { jumped = 1 }
    /mov +%rsp, *%r11/ && jumped { print function_name, $0 }' > "$work/late_frames"

check 'the archive exports something' test -s "$work/defined"
check 'the archive exports exactly what the header declares' diff "$work/declared" "$work/defined"
check 'the header declares exactly what the source exports' diff "$work/source" "$work/declared"
check 'the archive needs only the mathematical library' only_mathematics
check 'no symbol is hidden: such ones still bind in a static link' none "$work/hidden"
check 'the library has no variables' none "$work/writable"
check 'valgrind knows every instruction' none "$work/unknown"
check 'large frames are made at the entry of their functions' none "$work/late_frames"
check 'the object asks for no executable stack' grep -q '\.note\.GNU-stack' "$work/sections"

# The constants of the Fortran module are those of the header.
sed -n 's/^#define \(MSLIP_[A-Z_]*\) \([0-9][0-9]*\)$/\1 \2/p' "$prefix/include/microslip.h" |
    grep -v '^MSLIP_VERSION_' | sed 's/^MSLIP_ABI_VERSION/MSLIP_MODULE_ABI_VERSION/' | sort > "$work/c_constants"
sed -n 's/.*parameter.*:: *\(MSLIP_[A-Z_]*\) *= *\([0-9][0-9]*\).*/\1 \2/p' "$prefix/include/microslip.f90" |
    sort > "$work/fortran_constants"
check 'the Fortran module has the constants of the header' diff "$work/c_constants" "$work/fortran_constants"

counts
