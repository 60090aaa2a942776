#!/bin/sh
# localise.sh FROM.a TO.a: make an archive that exports the functions of the interface and nothing else.
#
# Cargo's archive carries the runtime of the Rust compiler. Its symbols are hidden, but they still bind in a static
# link: the host's complex division or quadruple precision would come from it. So everything that the interface does
# not reach is dropped, and what it does reach becomes local to one object.
set -eu

from=$1
to=$2
: "${AR:=ar}" "${LD:=ld}" "${NM:=nm}" "${OBJCOPY:=objcopy}" "${READELF:=readelf}"
for tool in "$AR" "$LD" "$NM" "$OBJCOPY" "$READELF"; do
    command -v "${tool%% *}" > /dev/null || { echo "$0: ${tool%% *} is missing: install GNU binutils" >&2; exit 1; }
done
# LD may be a compiler or another linker, which cannot link into one object (-r).
for linker in "$LD" ld.bfd ld.lld; do
    ! $linker -v 2> /dev/null | grep -qE '^GNU ld|LLD [0-9]' || break
    linker=
done
[ -n "$linker" ] || { echo "$0: $LD is neither GNU ld nor LLD: install GNU binutils, or set LD" >&2; exit 1; }
export LC_ALL=C

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

$NM --defined-only --extern-only "$from" 2>/dev/null | awk '$3 ~ /^mslip_/ { print $3 }' | sort -u > "$work/keep"
if [ ! -s "$work/keep" ]; then
    echo "$0: $from exports no function of microslip" >&2
    exit 1
fi

# Rust's runtime also has a few functions of the mathematical library. The host's are the faster ones, and have no
# variables, so calls of these names are kept from binding here.
for name in cbrt ceil fdim floor fma fmax fmin fmod rint round roundeven sqrt trunc; do
    echo "--wrap=$name" >> "$work/wrap"
    echo "__wrap_$name $name" >> "$work/unwrap"
done

# link ARGUMENTS...: what the interface reaches, as one object. The names hold no blanks, so they may be split.
entry=$(head -n 1 "$work/keep")
link() {
    # shellcheck disable=SC2046
    $linker -r --gc-sections -e "$entry" $(sed 's/^/-u /' "$work/keep") "$@"
}

# shellcheck disable=SC2046
link $(cat "$work/wrap") -o "$work/all.o" "$from"
# Linking once more drops what only Rust's start-up code reaches, which a linker always keeps. Rust's own library also
# brings its intermediate code along, which the plugins of other compilers choke on.
$OBJCOPY --strip-debug --remove-section='.init_array*' --remove-section=.llvmbc --remove-section=.llvmcmd \
    --redefine-syms="$work/unwrap" "$work/all.o" "$work/some.o"
link -o "$work/reached.o" "$work/some.o"
$OBJCOPY --keep-global-symbols="$work/keep" "$work/reached.o" "$work/local.o"
# Names of sections are mangled names of up to 150 letters, whose symbols are gone: numbers do.
$READELF -SW "$work/local.o" | grep -oE '\.(text|rodata)\.[^ ]*_[ZR][^ ]*' | sort -u |
    awk '{ name = $1; sub(/_[ZR].*/, NR, name); print "--rename-section=" $1 "=" name }' > "$work/rename"
$OBJCOPY --strip-unneeded "@$work/rename" "$work/local.o" "$work/microslip.o"

if $NM --undefined-only "$work/microslip.o" | grep -q _Unwind_; then
    echo "$0: $from can panic, so it was not built with the settings of tools/archive.sh" >&2
    exit 1
fi

mkdir -p "$(dirname "$to")"
rm -f "$to"
(cd "$work" && $AR rcsD libmicroslip.a microslip.o)
mv "$work/libmicroslip.a" "$to"
