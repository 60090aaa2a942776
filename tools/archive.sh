#!/bin/sh
# archive.sh TO.a [DIRECTORY [TRIPLE]]: build the library by cargo in DIRECTORY (target), for the Linux of TRIPLE (that of
# CARGO_BUILD_TARGET, or else of this machine), and localise it. Run in the source directory. Whatever cargo's configuration and
# environment say, the archive is the same, or one sentence says why there is none.
#
# CPU: the oldest processor on which it runs, as rustc names it (rustc --print target-cpus). On x86-64 the default is x86-64-v3, which
# has AVX2, if this machine has it, else the oldest one. Results have the same bits.
set -eu

[ $# -gt 0 ] || { echo "usage: $0 TO.a [DIRECTORY [TRIPLE]]" >&2; exit 2; }
to=$1
directory=${2:-target}
: "${CARGO:=cargo}"
fail() {
    echo "$0: $*" >&2
    exit 1
}

tools/dependencies.sh rust
host=$("$CARGO" -vV | sed -n 's/^host: //p')
triple=${3:-${CARGO_BUILD_TARGET:-$host}}
case $triple in *-linux-*) ;; *) fail "the archive is for Linux, not for $triple: packaging/RELEASE.md has other systems" ;; esac
[ "$triple" = "$host" ] || [ -d "$(rustc --print target-libdir --target "$triple")" ] ||
    fail "Rust has no standard library for $triple: install it by 'rustup target add $triple'"
mkdir -p "$directory" "$(dirname "$to")"

has() {
    grep -qw "$1" /proc/cpuinfo
}
if [ -z "${CPU:-}" ] && [ "$triple" = "$host" ] && [ "${host%%-*}" = x86_64 ] && has avx2 && has bmi2 && has fma; then
    CPU=x86-64-v3
fi
known() {
    rustc --print target-cpus --target "$triple" | awk -v cpu="$CPU" '$1 == cpu { found = 1 } END { exit !found }'
}
[ -z "${CPU:-}" ] || known || fail "Rust knows no processor $CPU for $triple: rustc --print target-cpus"

# Flags of the user may add code that panics, or make object files that only Rust's linker reads.
CARGO_ENCODED_RUSTFLAGS="${CPU:+-Ctarget-cpu=$CPU}" CARGO_INCREMENTAL=0 \
    "$CARGO" build --config tools/archive.toml --release --locked --package microslip --target-dir "$directory" --target "$triple"
tools/localise.sh "$directory/$triple/release/libmicroslip.a" "$to"
