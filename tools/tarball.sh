#!/bin/sh
# tarball.sh TO.tar.gz: the committed source with the crates that it depends on: the README's commands need no
# registry of crates. The same commit makes the same bytes.
set -eu

mkdir -p "$(dirname "$1")"
to=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
cd "$(dirname "$0")/.."
. tools/checks.sh
git rev-parse HEAD > /dev/null || { echo "$0: a tarball is made of a commit: this is no git repository" >&2; exit 1; }

name=$(basename "$to" .tar.gz)
git archive --prefix="$name/" HEAD | tar -x -C "$work"
mkdir "$work/$name/.cargo"
(cd "$work/$name" && "$CARGO" vendor --locked vendor) 2> "$work/log" > "$work/$name/.cargo/config.toml" || { cat "$work/log" >&2; exit 1; }
# Of crates that are compiled for other systems only, cargo reads no more than the manifest: their sources are half of the bytes.
find "$work/$name/vendor" -maxdepth 1 -type d | grep -E '/(windows|web-sys|js-sys|wasm|winapi)' | while read -r crate; do
    find "$crate" -name '*.rs' -exec truncate --size 0 {} +
    find "$crate" -type f ! -name '*.rs' ! -name Cargo.toml ! -name .cargo-checksum.json -delete
    sed -i 's/"files":{[^}]*}/"files":{}/' "$crate/.cargo-checksum.json"
done
pack "$name" "$to"
