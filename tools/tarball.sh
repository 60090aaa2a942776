#!/bin/sh
# tarball.sh TO.tar.gz: the committed source with the crates that it depends on: the README's commands need no
# registry of crates. The same commit makes the same bytes.
set -eu

if [ $# -ne 1 ]; then
    echo "usage: $0 TO.tar.gz" >&2
    exit 2
fi
mkdir -p "$(dirname "$1")"
to=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
commit_time=$(git log -1 --format=%ct) || { echo "$0: a tarball is made of a commit: this is no git repository" >&2; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
name=$(basename "$to" .tar.gz)
git archive --prefix="$name/" HEAD | tar -x -C "$work"
cd "$work/$name"
mkdir .cargo
"$CARGO" vendor --locked vendor 2> "$work/log" > .cargo/config.toml || { cat "$work/log" >&2; exit 1; }
# Of crates that are compiled for other systems only, cargo reads no more than the manifest: their sources are half of the bytes.
for crate in vendor/windows* vendor/web-sys* vendor/js-sys* vendor/wasm* vendor/winapi*; do
    [ -d "$crate" ] || continue
    find "$crate" -name '*.rs' -exec truncate --size 0 {} +
    find "$crate" -type f ! -name '*.rs' ! -name Cargo.toml ! -name .cargo-checksum.json -delete
    sed -i 's/"files":{[^}]*}/"files":{}/' "$crate/.cargo-checksum.json"
done
tar --create --directory "$work" --sort=name --mtime="@$commit_time" --owner=0 --group=0 --numeric-owner \
    --mode=u+rw,go=rX "$name" | gzip -9n > "$to"
