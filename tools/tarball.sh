#!/bin/sh
# tarball.sh TO.tar.gz: the source of the library as an archive that builds without a network: what `make install` and the
# build of another project use, the documents, and the crates that the library depends on. Tests and tools stay in the
# repository, for their crates are many. The same source makes the same bytes.
set -eu

if [ $# -ne 1 ]; then
    echo "usage: $0 TO.tar.gz" >&2
    exit 2
fi
mkdir -p "$(dirname "$1")"
to=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
name=$(basename "$to" .tar.gz)
tree=$work/$name
mkdir -p "$tree/tools" "$tree/.cargo"

cp -R src include packaging docs Cargo.lock Makefile CMakeLists.txt meson.build meson_options.txt fpm.toml \
    README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE-MIT LICENSE-APACHE "$tree"
cp tools/localise.sh tools/shared.sh "$tree/tools"

# Without the members of the workspace and what only tests use; cargo then takes these out of Cargo.lock and leaves the
# versions of the others as they are.
sed -e '/^members = /d' -e '/^\[dev-dependencies\]$/,/^$/d' Cargo.toml > "$tree/Cargo.toml"
(cd "$tree" && "$CARGO" vendor --quiet vendor)
cat > "$tree/.cargo/config.toml" << 'END'
[source.crates-io]
replace-with = "vendored-sources"

[source.vendored-sources]
directory = "vendor"
END

: "${SOURCE_DATE_EPOCH:=$(git log -1 --format=%ct 2> /dev/null || echo 0)}"
tar --create --directory "$work" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner \
    --mode=u+rw,go=rX "$name" | gzip -9n > "$to"
