#!/bin/sh
# symbols.sh PREFIX: the installed archive exports the interface only, depends on the mathematical library only, and has no state.
set -eu

prefix=$1
archive=$prefix/lib/libmicroslip.a
: "${CC:=cc}" "${NM:=nm}" "${OBJDUMP:=objdump}"
. "$(dirname "$0")/checks.sh"

empty() {
    [ ! -s "$1" ] || { cat "$1"; false; }
}

exports_interface() {
    [ -s "$work/defined" ] && diff "$work/declared" "$work/defined"
}

# A reachable panic adds an unwinder, an allocator and files to the archive: lists its callers.
only_mathematics() {
    empty "$work/foreign" || {
        $OBJDUMP -dr "$archive" | awk '
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

$NM --extern-only "$archive" > "$work/nm"
awk 'NF == 3 { print $3 }' "$work/nm" | sort > "$work/defined"
# shellcheck disable=SC2086
printf '%s\n' $allowed > "$work/allowed"
awk '$1 == "U" { print $2 }' "$work/nm" | grep -vxFf "$work/allowed" > "$work/foreign" || true
printf '#include <microslip.h>\n' | $CC -E -P -I"$prefix/include" - |
    tr '\n' ' ' | grep -o 'mslip_[a-z0-9_]* *(' | tr -d ' (' | sort > "$work/declared"

# Hidden symbols still bind in a static link.
$OBJDUMP -t "$archive" | awk '$2 != "l" && /\.(hidden|internal|protected) /' > "$work/hidden"
$OBJDUMP -h "$archive" > "$work/sections"
awk '$2 ~ /^\.(data|bss|tdata|tbss|init_array|ctors)/ && $2 !~ /^\.data\.rel\.ro/ && $3 !~ /^0+$/' \
    "$work/sections" > "$work/writable"
# valgrind does not implement the store form of vmovq between registers.
$OBJDUMP -d "$archive" | grep -E 'c[45]( [0-9a-f]{2}){1,2} d6 [c-f][0-9a-f][[:space:]]+vmovq ' > "$work/unsupported" || true
# LLVM's loop that probes a large stack frame overwrites r11, which may be in use if the frame is not allocated at the entry.
$OBJDUMP -d --no-show-raw-insn "$archive" | awk '
    />:$/ { function_name = $2; jumped = 0 }
    $2 ~ /^j/ { jumped = 1 }
    /mov +%rsp, *%r11/ && jumped { print function_name, $0 }' > "$work/late_frames"

check 'the archive exports the functions of the header' exports_interface
check 'the archive depends on the mathematical library only' only_mathematics
check 'no hidden symbols' empty "$work/hidden"
check 'no variables' empty "$work/writable"
check 'no instructions that valgrind does not support' empty "$work/unsupported"
check 'large stack frames are allocated at the entry of functions' empty "$work/late_frames"
check 'no executable stack' grep -q '\.note\.GNU-stack' "$work/sections"
counts
