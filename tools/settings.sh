#!/bin/sh
# settings.sh PREFIX: under the settings of a distribution, a user or a machine the build gives an archive with the symbols of the
# one in PREFIX, or it stops with one sentence and leaves no archive.
set -eu

prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
: "${NM:=nm}"
. tools/checks.sh

# A configuration in a folder above the source.
config='
[build]
target = "wasm32-unknown-unknown"
target-dir = "/nonexistent/target"
rustflags = ["-Coverflow-checks=on"]
[target.x86_64-unknown-linux-gnu]
rustflags = ["-Clinker-plugin-lto"]
[profile.release]
lto = "fat"
panic = "unwind"
codegen-units = 16
strip = "symbols"
[profile.release.package.microslip]
opt-level = 0
overflow-checks = true
'
printf '#!/bin/sh\necho cargo 1.80.0\n' > "$work/old_cargo" && chmod +x "$work/old_cargo"

# The settings, of one word each, and a part of the expected error message: nothing if there is an archive.
table="
RUSTFLAGS=-Coverflow-checks=on RUSTC_WRAPPER=                                      :
CARGO_ENCODED_RUSTFLAGS=-Clinker-plugin-lto                                        :
CARGO_BUILD_RUSTFLAGS=-Ctarget-cpu=native                                          :
CARGO_PROFILE_RELEASE_LTO=fat CARGO_PROFILE_RELEASE_PANIC=unwind                   :
CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS=true CARGO_PROFILE_RELEASE_OPT_LEVEL=0       :
CARGO_PROFILE_RELEASE_STRIP=symbols CARGO_PROFILE_RELEASE_DEBUG=2                  :
CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 CARGO_PROFILE_RELEASE_SPLIT_DEBUGINFO=packed :
CARGO_INCREMENTAL=1 CARGO_PROFILE_RELEASE_INCREMENTAL=true                         :
CARGO_TARGET_DIR=/nonexistent/target CARGO_BUILD_TARGET_DIR=/nonexistent/other     :
CARGO_NET_OFFLINE=true CARGO_TERM_VERBOSE=true CARGO_TERM_COLOR=always             :
POSIXLY_CORRECT=1 LC_ALL=tr_TR.UTF-8 CDPATH=/ GREP_OPTIONS=--color=always          :
CC=clang CFLAGS=-flto LDFLAGS=-flto LD=gcc                                         :
SOURCE_DATE_EPOCH=0 MAKEFLAGS=-j2                                                  :
CPU=x86                                                                            : knows no processor
CARGO=/nonexistent/cargo                                                           : Rust
CARGO=$work/old_cargo                                                              : Rust
CARGO_BUILD_TARGET=wasm32-unknown-unknown                                          : is for Linux
CARGO_BUILD_TARGET=riscv64gc-unknown-linux-gnu                                     : rustup target add
RUSTC_WRAPPER=/nonexistent/sccache                                                 : could not execute process
CARGO_BUILD_JOBS=0                                                                 : jobs may not be 0
NM=/nonexistent/nm                                                                 : binutils
OBJCOPY=/nonexistent/objcopy                                                       : binutils
TMPDIR=/nonexistent                                                                : failed to create directory
"

symbols() {
    $NM --extern-only "$1" | awk 'NF > 1 { print $(NF - 1), $NF }' | sort
}
same_symbols() {
    symbols "$prefix/lib/libmicroslip.a" > "$work/expected" && symbols "$1" | diff "$work/expected" -
}

# setting SENTENCE ASSIGNMENT...
setting() {
    sentence=$1
    shift
    rm -f "$work/archive.a"
    if [ -z "$sentence" ]; then
        env -u CI "$@" tools/archive.sh "$work/archive.a" && same_symbols "$work/archive.a"
    else
        ! env -u CI "$@" tools/archive.sh "$work/archive.a" 2> "$work/errors" && [ ! -e "$work/archive.a" ] &&
            grep "$sentence" "$work/errors"
    fi
}

tools/archive.sh "$work/first.a"
echo "$table" | sed '/^$/d' > "$work/table"
while IFS=: read -r settings sentence; do
    # shellcheck disable=SC2086  # lists
    check "$settings" setting "${sentence# }" $settings
done < "$work/table"

# A folder with blanks, below a configuration; directories of other names, of one user only; no repository.
folder="$work/a folder/microslip"
mkdir -p "$folder" "$folder/../.cargo" target
echo "$config" > "$folder/../.cargo/config.toml"
git archive HEAD | tar -x -C "$folder"
ln -s "$PWD/target" "$folder/target"
elsewhere() {
    (umask 077 && cd "$folder" && TARGET=release SHARED=yes make -j2 -k -r install PREFIX='a prefix' DESTDIR='../a stage/') &&
        same_symbols "$folder/../a stage/a prefix/lib/libmicroslip.a" && [ ! -e "$folder/../a stage/a prefix/lib/libmicroslip.so" ] &&
        [ -z "$(find "$folder/../a stage/a prefix" ! -perm -044)" ]
}
check 'a folder with blanks, umask 077, make -j -k -r, another configuration' elsewhere
nothing() {
    ! make -C "$folder" install CARGO=/nonexistent/cargo PREFIX="$work/nothing" -B -j2 -k 2> "$work/errors" && [ ! -e "$work/nothing" ]
}
check 'nothing is installed without an archive' nothing
dry_run() {
    make -C "$folder" -n install PREFIX="$work/nothing" && [ ! -e "$work/nothing" ]
}
check 'make -n' dry_run

# program NAME ARGUMENT...: a program in C with the archive.
program() {
    output=$1
    shift
    cc -O1 -I"$prefix/include" "$@" "$work/archive.a" -lm -lpthread -o "$work/$output"
}
# For every processor a sum of the bits of what all calls give; and no exceptions, which depend on what the compiler combines in
# vectors.
processors() {
    for cpu in native x86-64-v3 x86-64; do
        CPU=$cpu tools/archive.sh "$work/archive.a" &&
            program application -Iverification/embedding verification/embedding/calls.c verification/embedding/application.c &&
            "$work/application" 2000 > "$work/$cpu" && cmp "$work/native" "$work/$cpu" || return
    done
}
[ "$(uname -m)" != x86_64 ] || ! grep -qw avx2 /proc/cpuinfo || check 'every processor: the same bits, and no exceptions' processors
counts
